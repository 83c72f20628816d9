// Integer hashes, bit-equal to rain_core::hash.

fn rain_pcg3d(key: vec3<u32>) -> vec3<u32> {
    var v = key * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> vec3<u32>(16u);
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

fn rain_pcg(key: u32) -> u32 {
    let s = key * 747796405u + 2891336453u;
    let w = ((s >> ((s >> 28u) + 4u)) ^ s) * 277803737u;
    return (w >> 22u) ^ w;
}

fn rain_unit(h: u32) -> f32 {
    return f32(h >> 8u) * (1.0 / 16777216.0);
}

// In (0, 1), both ends excluded.
fn rain_open_unit(h: u32) -> f32 {
    return (f32(h >> 9u) + 0.5) * (1.0 / 8388608.0);
}
