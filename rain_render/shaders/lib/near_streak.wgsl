// A near drop drawn out to its streak, as rain_core::optics::near_streak has it. Points and paths across the line of sight
// have x level and y up, from the middle of the drop's widest circle, in its radii.

// Heights of a drop's halves over and under its widest circle, deflected by `deflection` (in radii) in its slowest mode.
// Error: 1e-5 against the CPU's.
fn rain_swinging_body(diameter_mm: f32, deflection: f32) -> vec2<f32> {
    let d = clamp(diameter_mm, 0.0, 6.0);
    let rest = vec2<f32>(
        1.0 + d * d * (-8.12422e-3 + d * (6.07622e-5 + d * 3.62174e-5)),
        1.0 + d * d * (-2.969648e-2 + d * (-2.21578e-3 + d * (1.73151e-3 - d * 1.5221e-4))),
    );
    let delta = clamp(deflection, -0.4, 0.4);
    return rest * ((1.0 + delta) / (1.0 - 0.5 * delta));
}

// Deflection of a drop at a height, in radii: it turns over its phase as it falls. Error: 1e-3 turns against the CPU's up to
// a hundred metres over 0.
fn rain_swing(diameter_mm: f32, start: f32, height_m: f32, fall: f32) -> f32 {
    let amplitude = min(0.0375 * max(diameter_mm - 1.0, 0.0), 0.15);
    // (1/2 pi) sqrt(8 sigma / (rho a3)) of the radius in m.
    let radius = 0.5e-3 * max(diameter_mm, 0.05);
    let frequency = 0.12156877 / sqrt(1e3 * radius * radius * radius);
    return amplitude * sin(6.2831853 * fract(start - frequency * height_m / max(fall, 0.5)));
}

// Heights of the outline over and under the middle, seen along a line that rises by `sine`. Error: 1e-6.
fn rain_outline_heights(heights: vec2<f32>, sine: f32) -> vec2<f32> {
    let s = sine * sine;
    return sqrt(heights * heights * (1.0 - s) + s);
}

// Radius of the widest circle over that of the disc of the outline's area. Error: 1e-6.
fn rain_outline_radius(outline: vec2<f32>) -> f32 {
    return sqrt(2.0 / (outline.x + outline.y));
}

// From when to when a point lies within an outline that is at `time * path`; the first above the second where it never does.
// Error: 1e-4 radii.
fn rain_time_inside(point: vec2<f32>, path: vec2<f32>, outline: vec2<f32>) -> vec2<f32> {
    var found = vec2<f32>(1e9, -1e9);
    for (var i = 0; i < 2; i++) {
        let half = 1.0 - 2.0 * f32(i);
        let scale = vec2<f32>(1.0, 1.0 / select(outline.y, outline.x, i == 0));
        let p = point * scale;
        let w = path * scale;
        let square = max(dot(w, w), 1e-12);
        let middle = dot(p, w) / square;
        let nearest = p - middle * w;
        let root = 1.0 - dot(nearest, nearest);
        if (root <= 0.0) {
            continue;
        }
        let reach = sqrt(root / square);
        var first = middle - reach;
        var last = middle + reach;
        // The half alone: (point.y - t path.y) half >= 0.
        let level = point.y * half;
        let sink = path.y * half;
        if (abs(sink) < 1e-6) {
            if (level < 0.0) {
                continue;
            }
        } else if (sink > 0.0) {
            last = min(last, level / sink);
        } else {
            first = max(first, level / sink);
        }
        if (first < last) {
            found = vec2<f32>(min(found.x, first), max(found.y, last));
        }
    }
    return found;
}

// Share per steradian of a light spread about a direction whose angle has this cosine; `sharpness` is one over the square of
// the spread. Error: 1e-5 relative.
fn rain_lobe(cosine: f32, sharpness: f32) -> f32 {
    return sharpness / (6.2831853 * (1.0 - exp(-2.0 * sharpness))) * exp(sharpness * (cosine - 1.0));
}

// What inner orders beyond those drawn would add is in the mean of far streaks: both show as much of an even light.
// Error: 1 % of the light.
const RAIN_NEAR_SHARE: f32 = 0.962;

// Radiance of a light of irradiance 1 from `light` by way of rays through a drop. Error: 1e-3 of the greatest.
fn rain_glint(rays: BodyRays, light: vec3<f32>, sharpness: f32) -> f32 {
    let wide = 0.25 * sharpness;
    return rays.straight.w * rain_lobe(dot(rays.straight.xyz, light), sharpness)
        + rays.outside.w * rain_lobe(dot(rays.outside.xyz, light), wide)
        + rays.inner.w * rain_lobe(dot(rays.inner.xyz, light), wide);
}
