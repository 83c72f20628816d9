// Procedural rings; the twins of rain_core::waves::ring_layers.

// A texel of the circle texture: nearness to the middle of its circle, outward direction, offset of its clock.
struct RainCirclePoint {
    outward: vec2<f32>,
    nearness: f32,
    offset: u32,
}

fn rain_circle_point(texel: vec2<u32>) -> RainCirclePoint {
    let halves = vec2<i32>(bitcast<i32>(texel.y << 16u) >> 16u, bitcast<i32>(texel.y) >> 16u);
    return RainCirclePoint(
        vec2<f32>(halves) * (1.0 / 32767.0),
        f32(texel.x & 0xffffu) * (1.0 / 65535.0),
        texel.x >> 16u,
    );
}

// Slope of a ring outwards, over the steepness.
fn rain_ring_profile(nearness: f32, phase: f32, weight: f32) -> f32 {
    let fade = clamp(0.2 + 0.8 * weight - phase, 0.0, 1.0);
    let along = clamp(9.0 * (phase - 1.0 + nearness), 0.0, 3.0);
    return fade * nearness * sin(3.14159265 * along);
}

// Strength of the ring of a circle whose chance is `chance` when its layer has the weight `weight`.
fn rain_ring_presence(chance: f32, weight: f32) -> f32 {
    return clamp((weight * (1.0 + RAIN_RING_FADE) - chance) * (1.0 / RAIN_RING_FADE), 0.0, 1.0);
}

// Texel of the circle texture below the middle of a cell, before it is moved; beyond the sides it repeats.
fn rain_ring_texel(params: RingLayerParams, cell: vec2<u32>) -> vec2<u32> {
    return (2u * cell + 1u) * params.repeats * params.texels / (2u * params.cells);
}

// Slope of a layer outwards, over the steepness.
fn rain_ring_layer(params: RingLayerParams, point: RainCirclePoint, layer: u32) -> f32 {
    let turns = f32(point.offset) * (1.0 / 65536.0) + params.parts[layer];
    let begun = floor(turns);
    let phase = turns - begun;
    let weight = params.weights[layer];
    if (params.by_number == 0u) {
        return weight * rain_ring_profile(point.nearness, phase, weight);
    }
    let cycle = (params.wholes[layer] + u32(begun)) % params.cycles[layer];
    let chance = rain_unit(rain_pcg3d(vec3<u32>(point.offset, layer, cycle)).x);
    return rain_ring_presence(chance, weight) * rain_ring_profile(point.nearness, phase, 1.0);
}
