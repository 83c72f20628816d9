// What the ground remembers of the rain, for surfaces that lie on it.

// The cell of `map` at `p`: share under a film, saturation, the ground's height above the levels' base; w: 0 off the map.
fn rain_film_texel(map: texture_2d<f32>, filtering: sampler, levels: LevelMapParams, p: vec3<f32>) -> vec4<f32> {
    let cell = (p.xz - levels.corner) * levels.inverse_cell;
    if (levels.films < 0.5 || any(cell < vec2<f32>(0.5)) || any(cell > levels.cells - 0.5)) {
        return vec4<f32>(0.0);
    }
    return textureSampleLevel(map, filtering, cell / vec2<f32>(textureDimensions(map)), 0.0);
}

// Pore saturation, share under a film, and how far both hold for `p`: it is within a step of the ground.
fn rain_memory_of(levels: LevelMapParams, p: vec3<f32>, texel: vec4<f32>) -> vec3<f32> {
    let above = abs(p.y - levels.base - texel.z);
    return vec3<f32>(texel.y, texel.x, texel.w * (1.0 - smoothstep(0.2, 0.35, above)));
}

// How far the ground's memory rules a surface whose normal's y is `up`: walls at its edge have none.
fn rain_memory_share(near: f32, up: f32) -> f32 {
    return near * smoothstep(0.5, 0.8, up);
}

// Share of the ground that a puddle of this depth, m, covers: its rim turns from film into water over 3 mm.
fn rain_puddle_rim(depth: f32) -> f32 {
    return smoothstep(-0.0015, 0.003, depth);
}
