// From weather state and exposure to the wetness of a surface point.

// Pore saturation 0..1 of a point that lets `exposure` of the rain in.
fn rain_point_wetness(state: vec4<f32>, exposure: f32) -> f32 {
    return clamp(state.x * exposure, 0.0, 1.0);
}

// Share of a surface of this texture depth under a closed film, both in mm: the twin of
// rain_core::surface::closed_film_share. Error: 1e-5.
fn rain_closed_film(film: f32, texture: f32) -> f32 {
    let t = clamp(film / max(texture, 1e-3) - 0.5, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// Perceptual roughness of ground of which `share` lies under a closed film: one lobe as high as those of both parts. The
// twin of rain_core::surface::film_roughness, whose roughness is the square of this one. Error: 1e-5.
fn rain_film_roughness(dry: f32, water: f32, share: f32) -> f32 {
    let a = dry * dry;
    let b = water * water;
    return sqrt(a * b / sqrt(max((1.0 - share) * b * b + share * a * a, 1e-12)));
}

// The share of a point whose film lets `exposure` of the rain in.
fn rain_point_film(state: vec4<f32>, exposure: f32) -> f32 {
    return rain_closed_film(state.y * exposure, state.z);
}

// Share of vertical faces' wetting: by the angle between the surface and the rain, walls in the lee stay dry.
// `up` is the normal's y, `facing` the cosine between the normal and the direction the rain comes from.
fn rain_catch(up: f32, facing: f32) -> f32 {
    return clamp(smoothstep(-0.05, 0.35, facing), 0.0, 1.0) * clamp(0.4 + 0.6 * smoothstep(0.0, 0.5, up), 0.0, 1.0);
}

// Albedo of a wet porous surface: Lekner & Dorf 1988 with n = 1.333 over n = 1.55. Error: 2e-5.
fn rain_wet_albedo(dry: vec3<f32>) -> vec3<f32> {
    let absorbed = 1.0 - clamp(dry, vec3<f32>(0.0), vec3<f32>(1.0));
    let inside = absorbed * ((1.0 - absorbed) * ((1.0 - 0.0375281) / (1.0 - 0.0990658)) + absorbed);
    return 0.979627 * (1.0 - inside / (1.0 - 0.474591 * (1.0 - inside)));
}
