// Streak geometry and opacity.

// Smoothstep from a to b.
fn rain_ramp(a: f32, b: f32, x: f32) -> f32 {
    let t = clamp((x - a) / (b - a), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// Range at which a streak is one 8-bit step of contrast, m. Error: 3e-4 relative to the CPU's.
fn rain_visible_range(diameter_mm: f32, focal: f32, exposure: f32) -> f32 {
    let d = diameter_mm * 1e-3;
    return 255.0 * 0.7853982 * d * d * focal / (rain_terminal_velocity(diameter_mm) * exposure);
}

// Distance from p to the segment from the origin to `lead`.
fn rain_to_segment(p: vec3<f32>, lead: vec3<f32>) -> f32 {
    let square = dot(lead, lead);
    let t = select(0.0, clamp(dot(p, lead) / max(square, 1e-12), 0.0, 1.0), square > 0.0);
    return length(p - lead * t);
}

// Contrast gain on an opacity; 1 is physical. Error: 2e-6.
fn rain_contrast(opacity: f32, gain: f32) -> f32 {
    return 1.0 - pow(max(1.0 - min(opacity, 1.0), 0.0), gain);
}

// Coverage of a pixel `d` px from the axis of a strip `width` px wide (at least 1), pixel footprint included.
// Error: 1e-5 of a pixel in the sum across the strip.
fn rain_strip(d: f32, width: f32) -> f32 {
    return clamp(0.5 + 0.5 * width - abs(d), 0.0, 1.0);
}
