// Streaks as screen-space quads of four corners, or as triangles, pulled from the projected list: all but those with a pattern. Few
// numbers go from corners to fragments: thin streaks spend most of their time on them.

@group(0) @binding(0) var<uniform> view: RainfallView;
@group(0) @binding(1) var<storage, read> streaks: array<Streak>;

// Whether streaks fade where they meet the scene.
override SOFT: bool = true;
// Whether coverage is drawn instead of light.
override COVERAGE: bool = false;

// What lies before an end by this many lengths of the fade or more is something else than what the streak meets: the
// depth test leaves out what it hides, and the rest fades as the other end does.
const MEETS: f32 = 1.0;
// Streaks shorter than this are one triangle on a software device, whose time goes by triangles and by blocks of 4 x 4 pixels: both
// triangles of a thin strip touch nearly all of its blocks. Units: px.
const SHORT: f32 = 36.0;

struct EvenVertex {
    @builtin(position) position: vec4<f32>,
    // Across and along the streak, px; distance to the scene behind in lengths of the fade.
    @location(0) @interpolate(linear) strip: vec3<f32>,
    // Light and opacity, or coverage, in its middle, as halves; half its width and length and half a pixel, px.
    @location(1) @interpolate(flat) whole: vec4<u32>,
}

// A corner of a streak of this half width; nothing of one that has none, or a pattern.
fn corner(streak: Streak, half: f32, vertex_index: u32) -> EvenVertex {
    if (half <= 0.0 || has_pattern(half)) {
        return EvenVertex(no_corner().position, vec3<f32>(0.0), vec4<u32>(0u));
    }
    var at = rain_shared_corner(vertex_index);
    let path = streak.ends.zw - streak.ends.xy;
    // A band around the view is what software devices have. The triangle holds the strip: three times as wide at its head, it ends
    // half its length behind its tail, where the quad's other triangle has no area. It must not end where all of the draw is clipped.
    let short = select(0.0, SHORT, view.guard_share < 1.0);
    let beyond = 1.5 * streak.shape.y - 0.5 * streak.shape.x;
    if (dot(path, path) < short * short && beyond >= 0.0 && beyond <= 1.0) {
        at = select(vec2<f32>(3.0 * at.x, -1.0), vec2<f32>(0.0, 2.0), at.y > 0.0);
    }
    let quad = rain_streak_corner(streak.ends, half, at);
    var gap = 1.0;
    if (SOFT) {
        // Between both ends it goes on a straight line, as it does before planes.
        let gaps = unpack2x16float(streak.gaps);
        let meets = select(gaps, max(gaps, gaps.yx), gaps <= vec2<f32>(-MEETS));
        gap = mix(meets.x, meets.y, 0.5 + 0.5 * at.y);
    }
    // Halves end at 65504.
    let shares = unpack2x16float(streak.shares);
    let light = vec4<f32>(min(streak.light, vec3<f32>(65000.0)), 1.0) * shares.x;
    let whole = select(light, vec4<f32>(shares.y, 0.0, 0.0, shares.y), COVERAGE);
    return EvenVertex(
        vec4<f32>(ndc_of(quad.pixel), mix(streak.shape.x, streak.shape.y, 0.5 + 0.5 * at.y), 1.0),
        vec3<f32>(quad.local, gap),
        vec4<u32>(pack2x16float(whole.rg), pack2x16float(whole.ba), bitcast<vec2<u32>>(0.5 + 0.5 * quad.size)),
    );
}

@vertex
fn vertex(@builtin(vertex_index) vertex_index: u32) -> EvenVertex {
    let streak = streaks[vertex_index / 4u];
    return corner(streak, streak.shape.z, vertex_index);
}

// Those behind what is transparent.
@vertex
fn vertex_behind(@builtin(vertex_index) vertex_index: u32) -> EvenVertex {
    let streak = streaks[vertex_index / 4u];
    return corner(streak, -streak.shape.z, vertex_index);
}

// As rain_strip has it, along both axes.
fn shown(in: EvenVertex) -> vec4<f32> {
    let inside = clamp(bitcast<vec2<f32>>(in.whole.zw) - abs(in.strip.xy), vec2<f32>(0.0), vec2<f32>(1.0));
    var presence = inside.x * inside.y;
    if (SOFT) {
        presence *= clamp(in.strip.z, 0.0, 1.0);
    }
    return vec4<f32>(unpack2x16float(in.whole.x), unpack2x16float(in.whole.y)) * presence;
}

@fragment
fn colour(in: EvenVertex) -> @location(0) vec4<f32> {
    return shown(in);
}

@fragment
fn coverage(in: EvenVertex) -> @location(0) vec4<f32> {
    return shown(in);
}
