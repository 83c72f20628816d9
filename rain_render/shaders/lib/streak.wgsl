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

// How far a diameter is drawn at a quality, m; without perspective wholly or not at all. Error: 3e-3 relative to the CPU's.
fn rain_drawn(kappa: f32, diameter_mm: f32, focal: f32, exposure: f32, parallel: bool) -> f32 {
    let range = min(kappa * rain_visible_range(diameter_mm, focal, exposure), RAIN_RANGE_CAP_M);
    let kept = clamp(10.0 * range / RAIN_RANGE_CAP_M - 9.0, 0.0, 1.0);
    return select(range, RAIN_RANGE_CAP_M * kept, parallel);
}

// Distance from p to the segment from the origin to `lead`.
fn rain_to_segment(p: vec3<f32>, lead: vec3<f32>) -> f32 {
    let square = dot(lead, lead);
    let t = select(0.0, clamp(dot(p, lead) / max(square, 1e-12), 0.0, 1.0), square > 0.0);
    return length(p - lead * t);
}

// Where a place is in the picture, px from the upper left corner. Error: 0.01 px.
fn rain_pixel(clip: vec4<f32>, viewport: vec2<f32>) -> vec2<f32> {
    return (clip.xy / clip.w * vec2<f32>(0.5, -0.5) + 0.5) * viewport;
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

// Corner of a quad of two triangles (0 1 2, 2 1 3) that a vertex is: -1 or 1 along both axes.
fn rain_quad_corner(vertex: u32) -> vec2<f32> {
    let i = vertex % 6u;
    let corner = select(i, select(5u - i, 3u, i == 5u), i > 2u);
    return vec2<f32>(f32(corner & 1u), f32(corner >> 1u)) * 2.0 - 1.0;
}

// The same of a quad whose two triangles share vertices: the first four numbers are its corners.
fn rain_shared_corner(vertex: u32) -> vec2<f32> {
    return vec2<f32>(f32(vertex & 1u), f32(vertex >> 1u & 1u)) * 2.0 - 1.0;
}

// A corner of the quad that shows a streak, px.
struct StreakCorner {
    pixel: vec2<f32>,
    // Across and along the streak, from its middle.
    local: vec2<f32>,
    // Width and length of what is shown.
    size: vec2<f32>,
    // Share of the way from head to tail.
    along: f32,
}

// The quad of a streak from `ends.xy` to `ends.zw`, half a pixel larger on each side: the pixel's own footprint.
fn rain_streak_corner(ends: vec4<f32>, half_width: f32, corner: vec2<f32>) -> StreakCorner {
    let path = ends.zw - ends.xy;
    let travelled = length(path);
    let along = select(vec2<f32>(0.0, 1.0), path / max(travelled, 1e-6), travelled > 1e-4);
    let width = 2.0 * half_width;
    let span = max(1.0, travelled + width * f32(width > 1.0));
    let local = corner * (0.5 * vec2<f32>(width, span) + 0.5);
    let pixel = 0.5 * (ends.xy + ends.zw) + vec2<f32>(-along.y, along.x) * local.x + along * local.y;
    return StreakCorner(pixel, local, vec2<f32>(width, span), clamp(0.5 + local.y / span, 0.0, 1.0));
}
