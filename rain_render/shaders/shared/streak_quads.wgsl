// Quads of projected streaks, over the bindings `view` and `streaks` of a pass.

// Widths between which streaks take on their pattern, px.
const PATTERN_FROM: f32 = 1.5;
const PATTERN_WHOLE: f32 = 4.0;

struct StreakVertex {
    @builtin(position) position: vec4<f32>,
    // Across and along the streak, px.
    @location(0) local: vec2<f32>,
    // Width and length, px.
    @location(1) @interpolate(flat) size: vec2<f32>,
    // Radiance and opacity.
    @location(2) @interpolate(flat) light: vec4<f32>,
    @location(3) @interpolate(flat) coverage: f32,
}

// A corner of no quad: all lie in one place. (Outside the picture they would have to be clipped.)
fn no_corner() -> StreakVertex {
    var out: StreakVertex;
    out.position = vec4<f32>(0.0, 0.0, 0.0, 1.0);
    return out;
}

// Whether a streak of this half width is drawn with its pattern.
fn has_pattern(half: f32) -> bool {
    return view.patterned != 0u && 2.0 * half > PATTERN_FROM;
}

// Where a place in the picture of this view is drawn.
fn ndc_of(pixel: vec2<f32>) -> vec2<f32> {
    return (pixel / view.viewport.zw - 0.5) * vec2<f32>(2.0, -2.0) * view.guard_share;
}

// A corner of the quad of a streak, `reach` times as wide as it is and as much longer.
fn streak_corner(streak: Streak, half: f32, reach: f32, vertex_index: u32) -> StreakVertex {
    var out: StreakVertex;
    let quad = rain_streak_corner(streak.ends, reach * half, rain_shared_corner(vertex_index));
    out.position = vec4<f32>(ndc_of(quad.pixel), mix(streak.shape.x, streak.shape.y, quad.along), 1.0);
    out.local = quad.local;
    out.size = quad.size;
    let shares = unpack2x16float(streak.shares);
    out.light = vec4<f32>(streak.light, shares.x);
    out.coverage = shares.y;
    return out;
}
