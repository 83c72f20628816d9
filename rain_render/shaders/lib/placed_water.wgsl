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
//
// The place is given by a block of 256 m and the metres from its corner, so that it is as exact anywhere in the world;
// the lattice has `scale` points to a metre and is shifted by `shift` of them. It repeats after 4096 points.
fn rain_value_noise(block: vec2<f32>, p: vec2<f32>, scale: vec2<f32>, shift: f32, seed: u32) -> f32 {
    // Of a power of two the product is exact, and so are its whole and its broken part.
    let points = 256.0 * scale;
    let whole = floor(points);
    let place = block * (points - whole) + p * scale + shift;
    let corner = floor(place);
    let f = place - corner;
    let t = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let cell = vec2<i32>(block) * vec2<i32>(whole) + vec2<i32>(corner);
    let near = bitcast<vec2<u32>>(cell) & vec2<u32>(4095u);
    let far = (near + 1u) & vec2<u32>(4095u);
    let a = rain_unit(rain_pcg3d(vec3<u32>(near, seed)).x);
    let b = rain_unit(rain_pcg3d(vec3<u32>(far.x, near.y, seed)).x);
    let c = rain_unit(rain_pcg3d(vec3<u32>(near.x, far.y, seed)).x);
    let d = rain_unit(rain_pcg3d(vec3<u32>(far, seed)).x);
    return mix(mix(a, b, t.x), mix(c, d, t.x), t.y);
}

// Map of where puddles lie, 0 deepest .. 1 never: three octaves, spread over the whole range. `p` is relative to the eye
// at world (x, z) `eye`, m; `scale` is 1 / size, 1/m. Repeats after 4096 sizes.
fn rain_puddle_noise(eye: vec2<f32>, p: vec2<f32>, scale: vec2<f32>, seed: u32) -> f32 {
    let block = floor(eye / 256.0);
    let q = (eye - 256.0 * block) + p;
    let sum = rain_value_noise(block, q, scale, 0.0, seed) + 0.5 * rain_value_noise(block, q, 2.0 * scale, 7.31, seed + 1u)
        + 0.25 * rain_value_noise(block, q, 4.0 * scale, -3.77, seed + 2u);
    return smoothstep(0.25, 0.75, sum / 1.75);
}
