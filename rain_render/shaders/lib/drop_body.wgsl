// Rays through a falling drop, two half spheroids on one widest circle, as rain_core::optics::DropBody has them.
// `heights` are those of the halves over and under that circle, in its radii; the vertical axis is y.

const RAIN_WATER_INDEX: f32 = 1.333;

// Reflectances (s, p) from a medium into one of relative index `n`.
fn rain_fresnel_polarised(cosine: f32, n: f32) -> vec2<f32> {
    let square = (n - 1.0) * (n + 1.0) + cosine * cosine;
    if (square <= 0.0) {
        return vec2<f32>(1.0);
    }
    let gamma = sqrt(square);
    let across = (gamma - cosine) / (gamma + cosine);
    let ratio = (cosine * (gamma + cosine) - 1.0) / (cosine * (gamma - cosine) + 1.0);
    return across * across * vec2<f32>(1.0, ratio * ratio);
}

// What stretches the half above or below to a sphere.
fn rain_body_stretch(heights: vec2<f32>, y: f32) -> vec3<f32> {
    return vec3<f32>(1.0, 1.0 / select(heights.x, heights.y, y < 0.0), 1.0);
}

// Outward normal where a line of sight through `through`, from the middle of the widest circle in its radii, enters; beside
// the body that of the rim. Error: 1e-5 against the CPU's, more than 0.1 (cosine of incidence) from the rim.
fn rain_body_enter(heights: vec2<f32>, through: vec3<f32>, view: vec3<f32>) -> vec3<f32> {
    var half = 1.0;
    var rim = vec3<f32>(0.0, 1.0, 0.0);
    for (var i = 0; i < 2; i++) {
        let stretch = rain_body_stretch(heights, half);
        let along = normalize(view * stretch);
        let point = through * stretch;
        let nearest = point - along * dot(point, along);
        let square = 1.0 - dot(nearest, nearest);
        let entry = nearest - along * sqrt(max(square, 0.0));
        if (square >= 0.0 && entry.y * half >= 0.0) {
            return normalize(entry * stretch);
        }
        if (nearest.y * half >= 0.0) {
            rim = normalize(nearest * stretch);
        }
        half = -half;
    }
    return rim;
}

// Where the chord from `point` of the surface along `inside` ends.
fn rain_body_far_end(heights: vec2<f32>, point: vec3<f32>, inside: vec3<f32>) -> vec3<f32> {
    let stretch = rain_body_stretch(heights, point.y);
    let chord = inside * stretch;
    let end = point - inside * (2.0 * dot(point * stretch, chord) / dot(chord, chord));
    if (end.y * point.y >= 0.0) {
        return end;
    }
    // It ends in the other half, to which `point` does not belong.
    let other = rain_body_stretch(heights, end.y);
    let along = normalize(inside * other);
    let start = point * other;
    let nearest = start - along * dot(start, along);
    return (nearest + along * sqrt(max(1.0 - dot(nearest, nearest), 0.0))) / other;
}

// Where what a drop shows at a point comes from (unit vectors from the drop outward) and its share (w).
struct BodyRays {
    // Reflected outside.
    outside: vec4<f32>,
    straight: vec4<f32>,
    // After one inner reflection.
    inner: vec4<f32>,
}

// A ray that leaves: its direction and share, with what stays inside.
struct BodyExit {
    ray: vec4<f32>,
    inside: vec3<f32>,
    left: vec2<f32>,
}

fn rain_body_leave(heights: vec2<f32>, point: vec3<f32>, inside: vec3<f32>, carried: vec2<f32>) -> BodyExit {
    let n = RAIN_WATER_INDEX;
    let stretch = rain_body_stretch(heights, point.y);
    let outward = normalize(point * stretch * stretch);
    let cosine = clamp(dot(inside, outward), 0.0, 1.0);
    let kept = rain_fresnel_polarised(cosine, 1.0 / n);
    let beyond = sqrt(max(1.0 - n * n * (1.0 - cosine) * (1.0 + cosine), 0.0));
    let leaving = normalize(n * inside + (beyond - n * cosine) * outward);
    let share = 0.5 * dot(carried, 1.0 - kept);
    return BodyExit(vec4<f32>(leaving, share), normalize(inside - 2.0 * cosine * outward), carried * kept);
}

// The first three rays where a line of sight meets the drop at a place of this outward normal. Error: directions 1e-4 and
// shares 1e-4 against the CPU's, off the angle of total reflection.
fn rain_body_rays(heights: vec2<f32>, view: vec3<f32>, normal: vec3<f32>) -> BodyRays {
    let n = RAIN_WATER_INDEX;
    let cosine = clamp(-dot(view, normal), 0.0, 1.0);
    let first = rain_fresnel_polarised(cosine, n);
    let outside = vec4<f32>(normalize(view + 2.0 * cosine * normal), 0.5 * (first.x + first.y));
    let beyond = sqrt((n - 1.0) * (n + 1.0) + cosine * cosine);
    let inside = normalize((view + (cosine - beyond) * normal) / n);
    let stretch = rain_body_stretch(heights, normal.y);
    let entry = normalize(normal / stretch) / stretch;
    let end = rain_body_far_end(heights, entry, inside);
    let straight = rain_body_leave(heights, end, inside, 1.0 - first);
    let next = rain_body_far_end(heights, end, straight.inside);
    let inner = rain_body_leave(heights, next, straight.inside, straight.left);
    return BodyRays(outside, straight.ray, inner.ray);
}
