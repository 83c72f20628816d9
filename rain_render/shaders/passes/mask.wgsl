// Wetness, distance and standing water of each pixel, from the view's depth.

@group(0) @binding(0) var<uniform> view: MaskView;
@group(0) @binding(1) var scene_depth: texture_depth_2d;
@group(0) @binding(2) var cover_map: texture_depth_2d;
@group(0) @binding(3) var film_map: texture_2d<f32>;
@group(0) @binding(4) var film_sampler: sampler;
@group(0) @binding(5) var level_map: texture_2d<f32>;
@group(0) @binding(6) var near_map: texture_2d_array<f32>;
@group(0) @binding(7) var known_map: texture_2d<f32>;

struct Masks {
    @location(0) wet: vec4<f32>,
    @location(1) depth: vec4<f32>,
    @location(2) water: vec4<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}

fn from_eye(pixel: vec2<f32>, depth: f32) -> vec3<f32> {
    let ndc = ((pixel - view.corner.xy) / view.screen.yz - 0.5) * vec2<f32>(2.0, -2.0);
    let p = view.eye_from_clip * vec4<f32>(ndc, depth, 1.0);
    return p.xyz / p.w;
}

@fragment
fn fragment(@builtin(position) position: vec4<f32>) -> Masks {
    var out: Masks;
    let texel = vec2<i32>(position.xy);
    let depth = textureLoad(scene_depth, texel, 0);
    let first = vec2<i32>(view.corner.xy);
    let last = first + vec2<i32>(view.screen.yz) - 1;
    if (depth <= 0.0 || any(texel < first) || any(texel > last)) {
        out.wet = vec4<f32>(0.0);
        out.depth = vec4<f32>(1e9, 0.0, 0.0, 0.0);
        out.water = vec4<f32>(0.0);
        return out;
    }
    let p = from_eye(position.xy, depth);
    // Face normal from the neighbours on the same surface: the nearer of both sides.
    let left = from_eye(position.xy - vec2<f32>(1.0, 0.0), textureLoad(scene_depth, max(texel - vec2<i32>(1, 0), first), 0));
    let right = from_eye(position.xy + vec2<f32>(1.0, 0.0), textureLoad(scene_depth, min(texel + vec2<i32>(1, 0), last), 0));
    let up = from_eye(position.xy - vec2<f32>(0.0, 1.0), textureLoad(scene_depth, max(texel - vec2<i32>(0, 1), first), 0));
    let down = from_eye(position.xy + vec2<f32>(0.0, 1.0), textureLoad(scene_depth, min(texel + vec2<i32>(0, 1), last), 0));
    // At the picture's rim there is one side alone.
    let nearer = vec2<bool>(length(right - p) < length(p - left), length(down - p) < length(p - up));
    let further = (nearer | (texel == first)) & (texel != last);
    let dx = select(p - left, right - p, further.x);
    let dy = select(p - up, down - p, further.y);
    var normal = normalize(cross(dy, dx));
    normal = select(normal, -normal, dot(normal, p) > 0.0);

    let cover = view.surface.cover;
    let to_rain = normalize(vec3<f32>(-cover.wind.x * cover.inverse_speed, 1.0, -cover.wind.y * cover.inverse_speed));
    let exposure = rain_exposure(cover_map, cover, p + 0.03 * normal, rain_exposure_bias(cover, normal))
        * rain_catch(normal.y, dot(normal, to_rain));
    // As a wet material would show it: the weather's wetness where the rain reaches, what the ground remembers on it, and
    // all soaked under a puddle.
    let films = rain_film_texel(film_map, film_sampler, view.surface.levels, p);
    var ground = vec3<f32>(0.0);
    if (films.w > 0.0) {
        let near = rain_water_map(near_map, film_sampler, view.surface.map, p.xz, films);
        ground = rain_memory_of(view.surface.levels, p, near);
    }
    let wet = mix(rain_point_wetness(view.surface.state, exposure), ground.x, rain_memory_share(ground.z, normal.y));
    let depth_of_water = rain_standing_water(level_map, view.surface.levels, p);
    let puddle = rain_puddle_rim(depth_of_water) * smoothstep(0.85, 0.95, normal.y);
    out.wet = vec4<f32>(max(wet, smoothstep(0.0, 0.5, puddle)), 0.0, 0.0, 0.0);
    out.water = vec4<f32>(select(0.0, max(depth_of_water, 0.0), puddle > 0.0), 0.0, 0.0, 0.0);
    if (view.screen.w > 0.5) {
        // Wet materials know better: what artists placed, their own strength, a wetness of their own.
        let known = rain_mask_of(textureLoad(known_map, texel - first, 0));
        out.wet.x = select(out.wet.x, known.x, known.z > 0.5);
        out.water.x = select(out.water.x, known.y, known.z > 0.5);
    }
    out.depth = vec4<f32>(length(p), 0.0, 0.0, 0.0);
    return out;
}
