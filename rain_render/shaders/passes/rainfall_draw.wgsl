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

@vertex
fn vertex(@builtin(vertex_index) vertex_index: u32) -> StreakVertex {
    var out: StreakVertex;
    let streak = streaks[vertex_index / 6u];
    if (streak.shape.z <= 0.0) {
        out.position = vec4<f32>(0.0, 0.0, -1.0, 1.0);
        return out;
    }
    // Two triangles: 0 1 2, 2 1 3.
    let i = vertex_index % 6u;
    let corner = select(i, select(5u - i, 3u, i == 5u), i > 2u);
    let side = f32(corner & 1u) * 2.0 - 1.0;
    let end = f32(corner >> 1u) * 2.0 - 1.0;

    let a = streak.ends.xy;
    let b = streak.ends.zw;
    let path = b - a;
    let travelled = length(path);
    let along = select(vec2<f32>(0.0, 1.0), path / max(travelled, 1e-6), travelled > 1e-4);
    let across = vec2<f32>(-along.y, along.x);
    let width = 2.0 * streak.shape.z;
    let span = max(1.0, travelled + width * f32(width > 1.0));
    // Half a pixel more on each side: the pixel's own footprint.
    let local = vec2<f32>(side * (0.5 * width + 0.5), end * (0.5 * span + 0.5));
    let pixel = 0.5 * (a + b) + across * local.x + along * local.y;
    let t = clamp(0.5 + local.y / span, 0.0, 1.0);
    let ndc = (pixel / view.viewport - 0.5) * vec2<f32>(2.0, -2.0);
    out.position = vec4<f32>(ndc, mix(streak.shape.x, streak.shape.y, t), 1.0);
    out.local = local;
    out.size = vec2<f32>(width, span);
    out.light = vec4<f32>(streak.light.rgb, streak.shape.w);
    out.coverage = streak.light.w;
    return out;
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
