// The scene through a glass in the rain: shrunk copy, film with blades, drops.

@group(0) @binding(0) var<uniform> view: LensView;
@group(0) @binding(1) var<storage, read> drops: array<LensDrop>;
@group(0) @binding(2) var scene: texture_2d<f32>;
@group(0) @binding(3) var small: texture_2d<f32>;
@group(0) @binding(4) var smooth_sampler: sampler;

@vertex
fn cover_all(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(f32(vertex & 1u), f32(vertex >> 1u));
    return vec4<f32>(4.0 * corner - 1.0, 0.0, 1.0);
}

// The mean of 8 x 8 pixels of the view: sixteen reads between four pixels each.
@fragment
fn shrink(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let low = view.viewport.xy + 0.5;
    let high = view.viewport.xy + view.viewport.zw - 0.5;
    let first = view.viewport.xy + 8.0 * floor(at.xy);
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < 16u; i += 1u) {
        let pixel = first + 1.0 + 2.0 * vec2<f32>(f32(i & 3u), f32(i >> 2u));
        let uv = clamp(pixel, low, high) / view.size;
        // No single firefly may fill a drop.
        sum += min(textureSampleLevel(scene, smooth_sampler, uv, 0.0).rgb, vec3<f32>(6.0e4));
    }
    return vec4<f32>(sum / 16.0, 1.0);
}

// Place on the glass of a pixel, m.
fn place_of(pixel: vec2<f32>) -> vec2<f32> {
    let share = (pixel - view.viewport.xy) / view.viewport.zw * 2.0 - 1.0;
    return vec2<f32>(share.x, -share.y) * view.half_tan * view.distance;
}

// The scene in a direction (tangents, x right, y up), from the shrunk copy.
fn seen(direction: vec2<f32>) -> vec3<f32> {
    let share = direction / view.half_tan;
    let uv = vec2<f32>(0.5 + 0.5 * share.x, 0.5 - 0.5 * share.y);
    // The last texels may reach beyond the view.
    let filled = view.viewport.zw / (8.0 * ceil(view.viewport.zw / 8.0));
    return textureSampleLevel(small, smooth_sampler, clamp(uv, vec2<f32>(0.0), vec2<f32>(1.0)) * filled, 0.0).rgb;
}

@fragment
fn film(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let here = textureLoad(scene, vec2<i32>(at.xy), 0);
    let inside = at.xy - view.viewport.xy;
    if any(inside < vec2<f32>(0.0)) || any(inside > view.viewport.zw) {
        return here;
    }
    let place = place_of(at.xy);
    let mist = rain_lens_mist(view, place);
    var colour = here.rgb;
    if mist > 0.0 {
        let direction = place / view.distance;
        // What fine drops show is spread over some degrees.
        var spread = vec3<f32>(0.0);
        for (var i = 0u; i < 5u; i += 1u) {
            let turn = 1.2566371 * f32(i);
            spread += seen(direction + 0.03 * vec2<f32>(cos(turn), sin(turn)));
        }
        colour = mix(colour, 0.2 * spread, mist);
    }
    for (var i = 0u; i < 2u; i += 1u) {
        let turn = view.turns[i];
        if turn.z > 0.0 {
            colour *= 1.0 - 0.96 * rain_blade_cover(view.arms[i], turn.w, view.aperture, place);
        }
    }
    return vec4<f32>(colour, here.a);
}

struct DropVertex {
    @builtin(position) position: vec4<f32>,
    // From the drop's middle, along and across it, m.
    @location(0) local: vec2<f32>,
    @location(1) @interpolate(flat) drop: u32,
}

@vertex
fn drop_vertex(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> DropVertex {
    let drop = drops[instance];
    let local = rain_quad_corner(vertex) * (vec2<f32>(drop.stretch, 1.0) * 1.2 * drop.radius + 0.5 * view.aperture);
    let across = vec2<f32>(-drop.along.y, drop.along.x);
    let place = drop.place + drop.along * local.x + across * local.y;
    let clip = place / (view.distance * view.half_tan);
    return DropVertex(vec4<f32>(clip, 0.0, 1.0), local, instance);
}

@fragment
fn drop_colour(in: DropVertex) -> @location(0) vec4<f32> {
    let drop = drops[in.drop];
    let across = vec2<f32>(-drop.along.y, drop.along.x);
    let scaled = in.local / (drop.radius * vec2<f32>(drop.stretch, 1.0));
    // No drop on glass is a circle.
    let turn = atan2(scaled.y, scaled.x);
    let key = 6.2831853 * vec2<f32>(rain_unit(rain_pcg(drop.key)), rain_unit(rain_pcg(drop.key ^ 77u)));
    let outline = 1.0 + 0.09 * sin(2.0 * turn + key.x) + 0.05 * sin(3.0 * turn + key.y);
    let away = length(scaled) / outline;
    let pixel = 2.0 * view.distance * view.half_tan.y / view.viewport.w;
    let alpha = rain_drop_cover(away, max(0.5 * view.aperture, 0.7 * pixel) / drop.radius);
    let optics = rain_cap_view(away);
    let from_middle = drop.along * in.local.x + across * in.local.y;
    let outward = from_middle / max(length(from_middle), 1e-7);
    let place = drop.place + from_middle;
    let colour = seen(place / view.distance - outward * optics.x) * optics.y;
    return vec4<f32>(colour * alpha, alpha);
}
