// Light that ruffled water throws onto walls; the twins of rain_core::waves::caustics.

// How far a slope moves a mirrored ray for each metre of its way, as seen on level water. `towards`: the light.
// Error: 1e-6 of the slope, over the elevation's sine.
fn rain_caustic_shift(towards: vec3<f32>, slope: vec2<f32>) -> vec2<f32> {
    let up = max(towards.y, RAIN_LEAST_ELEVATION);
    return -2.0 * (up * slope + towards.xz * (dot(towards.xz, slope) / up));
}

// Light at a way from the maps' values at RAIN_CAUSTIC_FIRST_M and twice, four and eight times that. Error: 1e-6.
fn rain_caustic_at(values: vec4<f32>, way: f32) -> f32 {
    let octaves = log2(max(way, 1e-6) / RAIN_CAUSTIC_FIRST_M);
    if (octaves < 0.0) {
        return 1.0 + (values.x - 1.0) * max(way, 0.0) / RAIN_CAUSTIC_FIRST_M;
    }
    if (octaves >= 3.0) {
        let left = max(RAIN_CAUSTIC_END_M - way, 0.0) / (RAIN_CAUSTIC_END_M - 8.0 * RAIN_CAUSTIC_FIRST_M);
        return 1.0 + (values.w - 1.0) * left * left;
    }
    let weights = max(1.0 - abs(vec4<f32>(octaves) - vec4<f32>(0.0, 1.0, 2.0, 3.0)), vec4<f32>(0.0));
    return dot(weights, values);
}
