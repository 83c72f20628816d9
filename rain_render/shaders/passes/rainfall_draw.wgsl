// Streaks as screen-space quads, six vertices each, pulled from the projected list.

@group(0) @binding(0) var<uniform> view: RainfallView;
@group(0) @binding(1) var<storage, read> streaks: array<Streak>;
@group(0) @binding(2) var scene_depth: texture_depth_2d;

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

// A corner of a streak of this half width; nothing of one that has none.
fn corner(streak: Streak, half: f32, vertex_index: u32) -> StreakVertex {
    var out: StreakVertex;
    if (half <= 0.0) {
        out.position = vec4<f32>(0.0, 0.0, -1.0, 1.0);
        return out;
    }
    let quad = rain_streak_corner(streak.ends, half, rain_quad_corner(vertex_index));
    let ndc = (quad.pixel / view.viewport - 0.5) * vec2<f32>(2.0, -2.0);
    out.position = vec4<f32>(ndc, mix(streak.shape.x, streak.shape.y, quad.along), 1.0);
    out.local = quad.local;
    out.size = quad.size;
    out.light = vec4<f32>(streak.light.rgb, streak.shape.w);
    out.coverage = streak.light.w;
    return out;
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

fn presence(in: StreakVertex) -> f32 {
    var shape = rain_strip(in.local.x, in.size.x) * rain_strip(in.local.y, in.size.y);
    if (view.soft > 0.0) {
        // Infinite reverse-Z: distance = near / depth.
        let scene = view.near / max(textureLoad(scene_depth, vec2<i32>(in.position.xy), 0), 1e-7);
        let own = view.near / max(in.position.z, 1e-7);
        shape *= clamp((scene - own) / view.soft, 0.0, 1.0);
    }
    return shape;
}

@fragment
fn colour(in: StreakVertex) -> @location(0) vec4<f32> {
    let opacity = in.light.a * presence(in);
    return vec4<f32>(in.light.rgb * opacity, opacity);
}

@fragment
fn coverage(in: StreakVertex) -> @location(0) vec4<f32> {
    let c = in.coverage * presence(in);
    return vec4<f32>(c, 0.0, 0.0, c);
}
