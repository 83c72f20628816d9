// Quads of projected streaks, over the bindings `view`, `streaks` and `scene_depth` of a pass.

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

// A corner of no quad.
fn no_corner() -> StreakVertex {
    var out: StreakVertex;
    out.position = vec4<f32>(0.0, 0.0, -1.0, 1.0);
    return out;
}

// Whether a streak of this half width is drawn with its pattern.
fn has_pattern(half: f32) -> bool {
    return view.patterned != 0u && 2.0 * half > PATTERN_FROM;
}

// Where a place in the picture of this view is drawn.
fn ndc_of(pixel: vec2<f32>) -> vec2<f32> {
    return (pixel / view.viewport.zw - 0.5) * vec2<f32>(2.0, -2.0);
}

// A corner of the quad of a streak, `reach` times as wide as it is and as much longer.
fn streak_corner(streak: Streak, half: f32, reach: f32, vertex_index: u32) -> StreakVertex {
    var out: StreakVertex;
    let quad = rain_streak_corner(streak.ends, reach * half, rain_shared_corner(vertex_index));
    out.position = vec4<f32>(ndc_of(quad.pixel), mix(streak.shape.x, streak.shape.y, quad.along), 1.0);
    out.local = quad.local;
    out.size = quad.size;
    out.light = vec4<f32>(streak.light.rgb, streak.shape.w);
    out.coverage = streak.light.w;
    return out;
}

// Distance from what is drawn at a place of the target to the scene behind it, in lengths of the fade.
fn gap_before_scene(place: vec2<f32>, depth: f32) -> f32 {
    // Infinite reverse-Z: distance = near / depth.
    let scene = view.near / max(textureLoad(scene_depth, vec2<i32>(place), 0), 1e-7);
    let own = view.near / max(depth, 1e-7);
    return (scene - own) / view.soft;
}

// How much of what is drawn here is left before the scene.
fn before_scene(position: vec4<f32>) -> f32 {
    if (view.soft <= 0.0) {
        return 1.0;
    }
    return clamp(gap_before_scene(position.xy, position.z), 0.0, 1.0);
}

fn presence(in: StreakVertex) -> f32 {
    return rain_strip(in.local.x, in.size.x) * rain_strip(in.local.y, in.size.y) * before_scene(in.position);
}
