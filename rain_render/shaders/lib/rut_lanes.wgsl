// Wheel ruts of lanes side by side; see RutLanes in rain_core.

// A place across and along the lanes; `turn`: cosine and sine of their direction from z towards x. Error: 1e-6 relative.
fn rain_across_and_along(p: vec2<f32>, turn: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(turn.x * p.x - turn.y * p.y, turn.y * p.x + turn.x * p.y);
}

// Height over the bottoms of the ruts, 0..depth, `across` m from the middle of a lane. `shape`: width of a lane, half
// the distance of its ruts and standard deviation of a rut, m. Error: 1e-5.
fn rain_rut_height(across: f32, shape: vec3<f32>, depth: f32) -> f32 {
    let within = across - shape.x * round(across / shape.x);
    let d = (abs(within) - shape.y) / shape.z;
    return depth * (1.0 - exp(-0.5 * d * d));
}
