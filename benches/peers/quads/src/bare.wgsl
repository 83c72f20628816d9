// The same quads as the streaks', one colour, nothing else.

struct Streak {
    ends: vec4<f32>,
    shape: vec4<f32>,
    light: vec4<f32>,
}

@group(0) @binding(0) var<storage, read> streaks: array<Streak>;

const VIEWPORT = vec2<f32>(1280.0, 720.0);

@vertex
fn vertex(@builtin(vertex_index) vertex_index: u32) -> @builtin(position) vec4<f32> {
    let streak = streaks[vertex_index / 6u];
    let half = streak.shape.z;
    if (half <= 0.0) {
        return vec4<f32>(0.0, 0.0, -1.0, 1.0);
    }
    let i = vertex_index % 6u;
    let k = select(i, select(5u - i, 3u, i == 5u), i > 2u);
    let corner = vec2<f32>(f32(k & 1u), f32(k >> 1u)) * 2.0 - 1.0;
    let path = streak.ends.zw - streak.ends.xy;
    let travelled = length(path);
    let along = select(vec2<f32>(0.0, 1.0), path / max(travelled, 1e-6), travelled > 1e-4);
    let width = 2.0 * half;
    let span = max(1.0, travelled + width * f32(width > 1.0));
    let local = corner * (0.5 * vec2<f32>(width, span) + 0.5);
    let pixel = 0.5 * (streak.ends.xy + streak.ends.zw) + vec2<f32>(-along.y, along.x) * local.x + along * local.y;
    let ndc = (pixel / VIEWPORT - 0.5) * vec2<f32>(2.0, -2.0);
    return vec4<f32>(ndc, streak.shape.x, 1.0);
}

@fragment
fn colour() -> @location(0) vec4<f32> {
    return vec4<f32>(0.05, 0.05, 0.05, 0.1);
}
