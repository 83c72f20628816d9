// The water map around the view, and where it gives way to what lies beyond.

// One level over what is known otherwise; it fades towards the distance from its centre to which it holds.
fn rain_water_map_level(map: texture_2d_array<f32>, repeat: sampler, place: vec4<f32>, centre: vec2<f32>, level: i32,
                        p: vec2<f32>, other: vec4<f32>) -> vec4<f32> {
    let far = max(abs(p.x - centre.x), abs(p.y - centre.y));
    if (far >= place.w) {
        return other;
    }
    let texel = textureSampleLevel(map, repeat, p * place.z + place.xy, level, 0.0);
    return mix(other, texel, texel.w * (1.0 - smoothstep(0.75 * place.w, place.w, far)));
}

// Water at `p` (x, z from the eye): share under a film, pore saturation, height of its ground, 1. `other` is what holds
// beyond the map.
fn rain_water_map(map: texture_2d_array<f32>, repeat: sampler, places: WaterMapPlaces, p: vec2<f32>,
                  other: vec4<f32>) -> vec4<f32> {
    let coarse = rain_water_map_level(map, repeat, places.coarse, places.coarse_centre, 2, p, other);
    let middle = rain_water_map_level(map, repeat, places.middle, places.middle_centre, 1, p, coarse);
    return rain_water_map_level(map, repeat, places.fine, places.fine_centre, 0, p, middle);
}
