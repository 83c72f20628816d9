// Streaks as screen-space quads, six vertices each, pulled from the projected list: all but those with a pattern. Few numbers
// go from vertices to fragments: thin streaks spend most of their time on them.

@group(0) @binding(0) var<uniform> view: RainfallView;
@group(0) @binding(1) var<storage, read> streaks: array<Streak>;
@group(0) @binding(2) var scene_depth: texture_depth_2d;

// Whether streaks fade where they meet the scene.
override SOFT: bool = true;
// Whether coverage is drawn instead of light.
override COVERAGE: bool = false;

struct EvenVertex {
    @builtin(position) position: vec4<f32>,
    // Across and along the streak; half its width and length and half a pixel, px.
    @location(0) strip: vec4<f32>,
    // Light and opacity, or coverage, in its middle.
    @location(1) @interpolate(flat) whole: vec4<f32>,
}

// A corner of a streak of this half width; nothing of one that has none, or a pattern.
fn corner(streak: Streak, half: f32, vertex_index: u32) -> EvenVertex {
    if (half <= 0.0 || has_pattern(half)) {
        return EvenVertex(no_corner().position, vec4<f32>(0.0), vec4<f32>(0.0));
    }
    let quad = streak_corner(streak, half, 1.0, vertex_index);
    let light = vec4<f32>(quad.light.rgb * quad.light.a, quad.light.a);
    let whole = select(light, vec4<f32>(quad.coverage, 0.0, 0.0, quad.coverage), COVERAGE);
    return EvenVertex(quad.position, vec4<f32>(quad.local, 0.5 + 0.5 * quad.size), whole);
}

@vertex
fn vertex(@builtin(vertex_index) vertex_index: u32) -> EvenVertex {
    let streak = streaks[vertex_index / 6u];
    return corner(streak, streak.shape.z, vertex_index);
}

// Those behind what is transparent.
@vertex
fn vertex_behind(@builtin(vertex_index) vertex_index: u32) -> EvenVertex {
    let streak = streaks[vertex_index / 6u];
    return corner(streak, -streak.shape.z, vertex_index);
}

// As rain_strip has it, along both axes.
fn shown(in: EvenVertex) -> vec4<f32> {
    let inside = clamp(in.strip.zw - abs(in.strip.xy), vec2<f32>(0.0), vec2<f32>(1.0));
    var presence = inside.x * inside.y;
    if (SOFT) {
        presence *= before_scene(in.position);
    }
    return in.whole * presence;
}

@fragment
fn colour(in: EvenVertex) -> @location(0) vec4<f32> {
    return shown(in);
}

@fragment
fn coverage(in: EvenVertex) -> @location(0) vec4<f32> {
    return shown(in);
}
