// Puddles placed by artists: painted channels (Lagarde 2013), noise over a height map (Nguyenova 2021).

// saturate((flood - depth) / margin): depth 0 floods first, 1 never.
fn rain_painted_puddle_water(flood: f32, depth: f32, margin: f32) -> f32 {
    return clamp((clamp(flood, 0.0, 1.0) - clamp(depth, 0.0, 1.0)) / max(margin, 1e-4), 0.0, 1.0);
}

// min(flood, 1 - height): holes of a height map.
fn rain_crack_water(flood: f32, height: f32) -> f32 {
    return min(clamp(flood, 0.0, 1.0), 1.0 - clamp(height, 0.0, 1.0));
}

// A puddle of noise over a height map: x: amount max(0, level - blended), y: water 0..1, z: film of the drenched ground
// around it, `drenched` wide in height.
fn rain_noise_puddle(level: f32, map: f32, height: f32, drenched: f32) -> vec3<f32> {
    let over = level - (1.0 - (1.0 - map) * (1.0 - height));
    let amount = max(over, 0.0);
    var film = 0.0;
    if (drenched > 0.0) {
        film = smoothstep(-drenched, 0.0, over) * clamp(level / drenched, 0.0, 1.0);
    }
    return vec3<f32>(amount, smoothstep(0.0, 0.08, amount), film);
}

// Value noise of one octave over the lattice of whole numbers, smooth to the second derivative, 0..1.
fn rain_value_noise(p: vec2<f32>, seed: u32) -> f32 {
    let corner = floor(p);
    let f = p - corner;
    let t = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let cell = vec2<u32>(bitcast<u32>(i32(corner.x)), bitcast<u32>(i32(corner.y)));
    let a = rain_unit(rain_pcg3d(vec3<u32>(cell, seed)).x);
    let b = rain_unit(rain_pcg3d(vec3<u32>(cell.x + 1u, cell.y, seed)).x);
    let c = rain_unit(rain_pcg3d(vec3<u32>(cell.x, cell.y + 1u, seed)).x);
    let d = rain_unit(rain_pcg3d(vec3<u32>(cell.x + 1u, cell.y + 1u, seed)).x);
    return mix(mix(a, b, t.x), mix(c, d, t.x), t.y);
}

// Map of where puddles lie, 0 deepest .. 1 never: three octaves, spread over the whole range.
fn rain_puddle_noise(p: vec2<f32>, seed: u32) -> f32 {
    let sum = rain_value_noise(p, seed) + 0.5 * rain_value_noise(2.03 * p + 7.31, seed + 1u)
        + 0.25 * rain_value_noise(4.11 * p - 3.77, seed + 2u);
    return smoothstep(0.25, 0.75, sum / 1.75);
}
