// Crowns and thrown drops as screen-space quads, six vertices each, pulled from the list.

@group(0) @binding(0) var<uniform> view: SplashView;
@group(0) @binding(1) var<storage, read> parts: array<SplashPart>;
@group(0) @binding(2) var scene_depth: texture_depth_2d;

struct SplashVertex {
    @builtin(position) position: vec4<f32>,
    // Drops: across and along, crowns: sideways and up from the foot. px.
    @location(0) local: vec2<f32>,
    // Drops: width and length, crowns: radius and height, px.
    @location(1) @interpolate(flat) size: vec2<f32>,
    // Radiance and opacity.
    @location(2) @interpolate(flat) light: vec4<f32>,
    @location(3) @interpolate(flat) form: vec4<f32>,
    @location(4) @interpolate(flat) coverage: f32,
}

@vertex
fn vertex(@builtin(vertex_index) vertex_index: u32) -> SplashVertex {
    return corner_of(vertex_index, false);
}

// Those behind what is transparent.
@vertex
fn vertex_behind(@builtin(vertex_index) vertex_index: u32) -> SplashVertex {
    return corner_of(vertex_index, true);
}

// A corner of a part; nothing of one that is not `behind` glass, or is while it should not.
fn corner_of(vertex_index: u32, behind: bool) -> SplashVertex {
    var out: SplashVertex;
    let part = parts[vertex_index / 6u];
    if ((part.form.w < 0.0) != behind) {
        out.position = vec4<f32>(0.0, 0.0, -1.0, 1.0);
        return out;
    }
    let corner = rain_quad_corner(vertex_index);
    var pixel: vec2<f32>;
    var depth = part.shape.x;
    if (part.form.x < 0.5) {
        let quad = rain_streak_corner(part.ends, part.shape.z, corner);
        pixel = quad.pixel;
        out.local = quad.local;
        out.size = quad.size;
        depth = mix(part.shape.x, part.shape.y, quad.along);
    } else {
        let up = part.ends.zw;
        let across = vec2<f32>(-up.y, up.x);
        let radius = part.shape.y;
        let minor = part.form.y;
        let top = max(RAIN_CROWN_JETS * part.shape.z + minor, 0.5) + 0.5;
        let foot = -max(minor, 0.5) - 0.5;
        out.local = vec2<f32>(corner.x * (radius + 0.5), select(foot, top, corner.y > 0.0));
        out.size = vec2<f32>(radius, part.shape.z);
        pixel = part.ends.xy + across * out.local.x + up * out.local.y;
    }
    let ndc = (pixel / view.viewport - 0.5) * vec2<f32>(2.0, -2.0);
    out.position = vec4<f32>(ndc, depth, 1.0);
    out.light = vec4<f32>(part.light.rgb, part.shape.w);
    out.coverage = part.light.w;
    out.form = vec4<f32>(part.form.xyz, abs(part.form.w));
    return out;
}

fn presence(in: SplashVertex) -> f32 {
    var shape: f32;
    if (in.form.x < 0.5) {
        shape = rain_strip(in.local.x, in.size.x) * rain_strip(in.local.y, in.size.y);
    } else {
        // Small ones are specks: what a sheet covers on the whole.
        let tall = max(in.size.y + 1.6 * in.form.y, 1.0);
        let speck = 0.6 * rain_strip(in.local.x, 2.0 * in.size.x) * rain_strip(in.local.y - 0.5 * in.size.y, tall);
        let sheet = rain_crown_sheet(in.local, in.size.x, in.size.y, in.form.y, in.form.z);
        shape = mix(speck, sheet, rain_ramp(1.5, 3.0, in.size.x));
    }
    if (view.soft > 0.0) {
        // Infinite reverse-Z: distance = near / depth.
        let scene = view.near / max(textureLoad(scene_depth, vec2<i32>(in.position.xy), 0), 1e-7);
        let own = view.near / max(in.position.z, 1e-7);
        shape *= clamp((scene - own) / min(view.soft, in.form.w), 0.0, 1.0);
    }
    return shape;
}

@fragment
fn colour(in: SplashVertex) -> @location(0) vec4<f32> {
    let opacity = in.light.a * presence(in);
    return vec4<f32>(in.light.rgb * opacity, opacity);
}

@fragment
fn coverage(in: SplashVertex) -> @location(0) vec4<f32> {
    let c = in.coverage * presence(in);
    return vec4<f32>(c, 0.0, 0.0, c);
}
