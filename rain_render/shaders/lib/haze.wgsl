// Haze of rain: what light it takes out and what it sends, as rain_core::haze has it in double precision.

// Light that does not get through an optical depth, 1 - exp(-depth). Error: 3e-7, and 1e-6 of a small one.
fn rain_haze_share(depth: f32) -> f32 {
    let x = clamp(depth, 0.0, 80.0);
    let small = x * (1.0 - x * (0.5 - x * (0.16666667 - x * 0.041666667)));
    return select(1.0 - exp(-x), small, x < 0.03);
}

// Place of a distance on the table of what is drawn, in entries.
fn rain_drawn_place(way: f32) -> f32 {
    return sqrt(clamp(way / RAIN_FOG_END_M, 0.0, 1.0)) * (RAIN_FOG_KNOTS - 1.0);
}

// Distance on the ground of a knot of the areas' grid and back: `scale` is ln(1 + limit / 4 m) over the intervals.
fn rain_haze_knot(knot: f32, scale: f32) -> f32 {
    return RAIN_HAZE_FIRST_M * (exp(knot * scale) - 1.0);
}

fn rain_haze_place(distance: f32, scale: f32) -> f32 {
    return log(1.0 + max(distance, 0.0) / RAIN_HAZE_FIRST_M) / scale;
}

// The way under the cloud's base along a line of sight that ends after `way`: from and to, m. `cloud` is the base over the
// eye, `rise` the line's y.
fn rain_under_cloud(cloud: f32, rise: f32, way: f32) -> vec2<f32> {
    let out = cloud / select(rise, 1e-6, abs(rise) < 1e-6);
    if (cloud >= 0.0) {
        return vec2<f32>(0.0, select(way, min(way, out), rise > 0.0));
    }
    if (rise >= 0.0) {
        return vec2<f32>(0.0);
    }
    return vec2<f32>(min(out, way), way);
}

// Share of the rain at a height over the eye, m: all of it up to `thin` below the cloud's base, none above. Error: 1e-6.
fn rain_cloud_share(height: f32, cloud: f32, thin: f32) -> f32 {
    if (thin > 0.0) {
        return clamp((cloud - height) / thin, 0.0, 1.0);
    }
    return select(0.0, 1.0, height < cloud);
}

// Integral of what a drop's disc sends per steradian, from straight on to an angle: refraction and outer reflection.
// Error: 1e-6.
fn rain_phase_integral(theta: f32) -> f32 {
    let tail = max(theta - 0.1635694, 0.0);
    let refracted = 1.2 * min(theta, 0.1635694) + (1.2 / 3.44) * (1.0 - exp(-3.44 * tail));
    return RAIN_DROP_TRANSMITTED * refracted + RAIN_DROP_REFLECTED * 0.0795775 * theta;
}

// Glow of a lamp of 1 cd at `lamp` along the unit line `towards` from `from` to `to`, 1/m; `radius` is the lamp's,
// `extinction` what the light loses on its way, 1/m. Error: 1e-3 of
// rain_core::haze::lamp_glow_per_m.
fn rain_lamp_glow(lamp: vec3<f32>, towards: vec3<f32>, start: f32, end: f32, radius: f32, extinction: f32) -> f32 {
    if (end <= start) {
        return 0.0;
    }
    let nearest = dot(lamp, towards);
    let h = max(length(cross(lamp, towards)), radius);
    let a = atan2(h, nearest - start);
    let b = atan2(h, nearest - end);
    var borders = array<f32, 5>(0.0, 0.15, 0.4, 0.7, 1.0);
    var light = 0.0;
    var low = a;
    var before = rain_phase_integral(a);
    for (var i = 1u; i < 5u; i += 1u) {
        let high = mix(a, b, borders[i]);
        let way = nearest + h * tan(0.25 * (low + high));
        let after = rain_phase_integral(high);
        light += (after - before) * exp(-clamp(extinction * way, 0.0, 80.0));
        low = high;
        before = after;
    }
    return light / h;
}

// The part of a line of sight from the eye that a cone lights, from and to; empty where it misses.
fn rain_cone_span(apex: vec3<f32>, axis: vec3<f32>, cosine: f32, towards: vec3<f32>) -> vec2<f32> {
    let along = dot(axis, towards);
    let start = -dot(axis, apex);
    let square = cosine * cosine;
    let a = along * along - square;
    let b = along * start + square * dot(apex, towards);
    let k = start * start - square * dot(apex, apex);
    let under = b * b - a * k;
    if (under <= 0.0 || a == 0.0) {
        return vec2<f32>(0.0);
    }
    let root = sqrt(under);
    let first = (-b - root) / a;
    let second = (-b + root) / a;
    let low = min(first, second);
    let high = max(first, second);
    if (a < 0.0) {
        if (start + along * 0.5 * (low + high) <= 0.0) {
            return vec2<f32>(0.0);
        }
        return vec2<f32>(max(low, 0.0), high);
    }
    if (along > 0.0) {
        return vec2<f32>(max(high, 0.0), 1e9);
    }
    return vec2<f32>(0.0, low);
}

// A colour drawn towards its own luminance.
fn rain_desaturated(colour: vec3<f32>, weight: f32) -> vec3<f32> {
    return mix(colour, vec3<f32>(dot(colour, vec3<f32>(0.2126, 0.7152, 0.0722))), weight);
}
