// Streaks as screen-space quads, six vertices each, pulled from the projected list: all but those with a pattern.

@group(0) @binding(0) var<uniform> view: RainfallView;
@group(0) @binding(1) var<storage, read> streaks: array<Streak>;
@group(0) @binding(2) var scene_depth: texture_depth_2d;

// A corner of a streak of this half width; nothing of one that has none, or a pattern.
fn corner(streak: Streak, half: f32, vertex_index: u32) -> StreakVertex {
    if (half <= 0.0 || has_pattern(half)) {
        return no_corner();
    }
    return streak_corner(streak, half, 1.0, vertex_index);
}

@vertex
fn vertex(@builtin(vertex_index) vertex_index: u32) -> StreakVertex {
    let streak = streaks[vertex_index / 6u];
    return corner(streak, streak.shape.z, vertex_index);
}

// Those behind what is transparent.
@vertex
fn vertex_behind(@builtin(vertex_index) vertex_index: u32) -> StreakVertex {
    let streak = streaks[vertex_index / 6u];
    return corner(streak, -streak.shape.z, vertex_index);
}

@fragment
fn colour(in: StreakVertex) -> @location(0) vec4<f32> {
    let opacity = in.light.a * presence(in);
    return vec4<f32>(in.light.rgb * opacity, opacity);
}
