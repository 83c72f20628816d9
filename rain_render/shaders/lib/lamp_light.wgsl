// Point and spot lights on drops, as rain_core::rainfall::Lamp has them. Positions are relative to the eye, in metres.

// Irradiance at a point from a lamp of intensity 1 along its beam. Error: 1e-5 relative.
fn rain_lamp_falloff(lamp: LampParams, point: vec3<f32>) -> f32 {
    let way = point - lamp.place.xyz;
    let square = dot(way, way);
    let towards = way * inverseSqrt(max(square, 1e-12));
    let cone = clamp(
        (dot(towards, lamp.direction.xyz) - lamp.direction.w) / max(lamp.intensity.w - lamp.direction.w, 1e-4),
        0.0,
        1.0,
    );
    if (cone <= 0.0 || square * lamp.limits.x >= 1.0) {
        return 0.0;
    }
    let reach = square * lamp.limits.x;
    let left = clamp(1.0 - reach * reach, 0.0, 1.0);
    let falloff = left * left / (square + lamp.place.w * lamp.place.w);
    return falloff * cone * cone;
}

// Radiance that a drop at a point sends to the eye from a lamp. Error: 1e-3 relative to the CPU's, whose arc cosine
// is exact.
fn rain_lamp_radiance(lamp: LampParams, point: vec3<f32>) -> vec3<f32> {
    return rain_lamp_radiance_along(lamp, point, normalize(point));
}

// The same where it is seen along another direction, unit.
fn rain_lamp_radiance_along(lamp: LampParams, point: vec3<f32>, seen: vec3<f32>) -> vec3<f32> {
    let falloff = rain_lamp_falloff(lamp, point);
    if (falloff <= 0.0) {
        return vec3<f32>(0.0);
    }
    let way = point - lamp.place.xyz;
    let towards = way * inverseSqrt(max(dot(way, way), 1e-12));
    let theta = acos(clamp(-dot(towards, seen), -1.0, 1.0));
    let shares = RAIN_DROP_TRANSMITTED * rain_drop_phase(theta) + RAIN_DROP_REFLECTED * 0.0795775;
    return lamp.intensity.rgb * (falloff * shares);
}

// A bound on the greatest component of `rain_lamp_radiance` within `reach` of a point. Error: never below it but for
// rounding.
fn rain_lamp_bound(lamp: LampParams, point: vec3<f32>, reach: f32) -> f32 {
    let way = point - lamp.place.xyz;
    let distance = length(way);
    let nearest = max(distance - reach, 0.0);
    if (nearest * nearest * lamp.limits.x >= 1.0) {
        return 0.0;
    }
    if (nearest > 0.0 && lamp.direction.w > -1.0) {
        // The ball seen from the lamp is a cone.
        let half = asin(min(reach / distance, 1.0));
        let off = acos(clamp(dot(way, lamp.direction.xyz) / distance, -1.0, 1.0));
        if (off - half > acos(lamp.direction.w)) {
            return 0.0;
        }
    }
    let intensity = max(lamp.intensity.r, max(lamp.intensity.g, lamp.intensity.b));
    return 1.07 * intensity / (nearest * nearest + lamp.place.w * lamp.place.w);
}
