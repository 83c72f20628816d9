// A streak on texels, as rain_core::rainfall::StreakTexture draws it. All lengths in texels.

// Area of a disc of diameter `d` to the left of a line `x` from its centre. Error: 1e-6 of the disc.
fn rain_disc_left_of(x: f32, d: f32) -> f32 {
    let t = clamp(2.0 * x / d, -1.0, 1.0);
    let root = sqrt((1.0 - t) * (1.0 + t));
    return 0.25 * d * d * (t * root + atan2(t, root) + 1.5707963);
}

// Integral of a ramp from 0 to 1 over [-d/2, d/2].
fn rain_ramp_up_to(y: f32, d: f32) -> f32 {
    let inside = (y + 0.5 * d) * (y + 0.5 * d) / (2.0 * d);
    return select(select(inside, y, y >= 0.5 * d), 0.0, y <= -0.5 * d);
}

// -ln(1 - opacity) without cancellation, for opacities up to 0.999. Error: 1e-6 relative.
fn rain_depth_of(opacity: f32) -> f32 {
    let small = opacity * (1.0 + opacity * (0.5 + opacity * (0.33333333 + opacity * 0.25)));
    return select(-log(1.0 - opacity), small, opacity < 0.02);
}

// 1 - exp(-depth) without cancellation. Error: 1e-6 relative.
fn rain_obscured(depth: f32) -> f32 {
    let small = depth * (1.0 - depth * (0.5 - depth * (0.16666667 - depth * 0.041666667)));
    return select(1.0 - exp(-depth), small, depth < 0.05);
}

// Mean opacity of a streak over the texel whose corner lies `corner` from where it begins.
// Error: 1e-5 of its largest.
fn rain_texel_opacity(corner: vec2<f32>, d: f32, share: f32, path: f32) -> f32 {
    let across = rain_disc_left_of(corner.x + 1.0, d) - rain_disc_left_of(corner.x, d);
    let along = (rain_ramp_up_to(corner.y + 1.0, d) - rain_ramp_up_to(corner.y, d))
        - (rain_ramp_up_to(corner.y + 1.0 - path, d) - rain_ramp_up_to(corner.y - path, d));
    return clamp(share * across * along / path, 0.0, 0.999);
}

// The nearest half float of a number in [0, 65504], ties to even: the same on every device. Error: half a step, 4.9e-4.
fn rain_half(x: f32) -> u32 {
    let bits = bitcast<u32>(x);
    let rounded = ((bits + 0xFFFu + ((bits >> 13u) & 1u)) >> 13u) - 114688u;
    // Below 2^-14 halves are multiples of 2^-24, which a sum with one half is rounded to.
    let small = bitcast<u32>(x + 0.5) - 0x3F000000u;
    return select(rounded, small, x < 6.1035156e-5);
}
