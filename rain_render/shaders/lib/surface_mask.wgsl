// What a wet material knows of its pixel, as a view of masks keeps it.

// Exposure below which a view draws masks: no picture is taken that dark.
const RAIN_MASK_EXPOSURE: f32 = 1e-15;

// Wetness 0..1 and depth of standing water, m, as half floats: the wetness in two parts. The negative alpha tells the
// material from all others, which write 0 to 1.
fn rain_mask_texel(wetness: f32, water: f32) -> vec4<f32> {
    let coarse = round(wetness * 1024.0) / 1024.0;
    return vec4<f32>(coarse, water, wetness - coarse, -1.0);
}

// x: wetness, y: depth of standing water, m, z: 1 where a wet material has written the texel.
fn rain_mask_of(texel: vec4<f32>) -> vec3<f32> {
    return vec3<f32>(clamp(texel.x + texel.z, 0.0, 1.0), texel.y, f32(texel.w < 0.0));
}
