// What surrounds a drop: the host's environment map and an even light.

// Radiance from `direction`, blurred from 0 to 1 of the map's levels. `environment` is the map's scale, w: its highest
// level; `ambient` is added.
fn rain_surroundings(
    map: texture_cube<f32>,
    filtering: sampler,
    environment: vec4<f32>,
    ambient: vec4<f32>,
    direction: vec3<f32>,
    blur: f32,
) -> vec3<f32> {
    // Cube maps are left-handed.
    let d = vec3<f32>(direction.x, direction.y, -direction.z);
    return textureSampleLevel(map, filtering, d, blur * environment.w).rgb * environment.rgb + ambient.rgb;
}

// Angle of the sun from a line of sight; both unit vectors.
fn rain_sun_angle(sun_direction: vec3<f32>, from_eye: vec3<f32>) -> f32 {
    return acos(clamp(dot(from_eye, sun_direction), -1.0, 1.0));
}

// Radiance of a drop that is seen along `from_eye`, a unit vector.
fn rain_drop_shine(
    map: texture_cube<f32>,
    filtering: sampler,
    environment: vec4<f32>,
    ambient: vec4<f32>,
    sun_direction: vec3<f32>,
    sun: vec3<f32>,
    from_eye: vec3<f32>,
) -> vec3<f32> {
    let refracted = rain_surroundings(map, filtering, environment, ambient, from_eye, 0.55);
    let above = vec3<f32>(-from_eye.x, max(0.2, -from_eye.y), -from_eye.z);
    let reflected = rain_surroundings(map, filtering, environment, ambient, above, 0.9);
    return rain_drop_radiance(refracted, reflected, sun, rain_sun_angle(sun_direction, from_eye));
}

// The same where the surroundings are even.
fn rain_drop_shine_evenly(ambient: vec4<f32>, sun_direction: vec3<f32>, sun: vec3<f32>, from_eye: vec3<f32>) -> vec3<f32> {
    return rain_drop_radiance(ambient.rgb, ambient.rgb, sun, rain_sun_angle(sun_direction, from_eye));
}
