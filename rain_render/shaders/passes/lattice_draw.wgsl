// Cards of the lattice, six vertices each, from far to near.

@group(0) @binding(0) var<uniform> view: LatticeParams;
@group(0) @binding(1) var<storage, read> cards: array<Card>;
// Opacity of a texel of value 1, of each layer.
@group(0) @binding(2) var<storage, read> units: array<f32>;
@group(0) @binding(3) var streaks: texture_2d_array<f32>;
@group(0) @binding(4) var streak_sampler: sampler;
@group(0) @binding(5) var scene_depth: texture_depth_2d;
@group(0) @binding(6) var cover_map: texture_depth_2d;
@group(0) @binding(7) var environment: texture_cube<f32>;
@group(0) @binding(8) var environment_sampler: sampler;

// Drops that a lamp makes no brighter than this, exposed, are not asked about it.
const LEAST_LIGHT: f32 = 0.000244;

struct CardVertex {
    @builtin(position) position: vec4<f32>,
    @location(0) point: vec3<f32>,
    @location(1) place: vec2<f32>,
    @location(2) @interpolate(flat) card: u32,
    // Radiance without lamps.
    @location(3) @interpolate(flat) light: vec3<f32>,
    // Distance along the view's axis, m.
    @location(4) axial: f32,
    // A bit for each lamp that may show on it.
    @location(5) @interpolate(flat) lamps: vec2<u32>,
}

fn surroundings(direction: vec3<f32>, blur: f32) -> vec3<f32> {
    // Cube maps are left-handed.
    let d = vec3<f32>(direction.x, direction.y, -direction.z);
    let level = blur * view.environment.w;
    return textureSampleLevel(environment, environment_sampler, d, level).rgb * view.environment.rgb + view.ambient.rgb;
}

// A bit for each lamp whose light somewhere in the card's cell may be seen.
fn lamps_on(card: Card) -> vec2<u32> {
    var found = vec2<u32>(0u);
    for (var i = 0u; i < view.lamps; i++) {
        if (rain_lamp_bound(view.lamp[i], card.centre.xyz, 1.7320508 * card.centre.w) > LEAST_LIGHT) {
            found[i >> 5u] |= 1u << (i & 31u);
        }
    }
    return found;
}

// Light of the lamps whose bits are set, the first of which is that of lamp `first`.
fn light_of(bits: u32, first: u32, point: vec3<f32>) -> vec3<f32> {
    var light = vec3<f32>(0.0);
    for (var left = bits; left != 0u; left &= left - 1u) {
        light += rain_lamp_radiance(view.lamp[first + firstTrailingBit(left)], point);
    }
    return light;
}

fn behind_glass(place: vec3<f32>) -> bool {
    for (var i = 0u; i < view.panes; i++) {
        if (rain_behind_pane(view.pane[i], place)) {
            return true;
        }
    }
    return false;
}

@vertex
fn vertex(@builtin(vertex_index) vertex_index: u32) -> CardVertex {
    return corner_of(vertex_index, false);
}

// Those behind what is transparent.
@vertex
fn vertex_behind(@builtin(vertex_index) vertex_index: u32) -> CardVertex {
    return corner_of(vertex_index, true);
}

// A corner of a card; nothing of one that is not `hidden` behind glass, or is while it should not.
fn corner_of(vertex_index: u32, hidden: bool) -> CardVertex {
    let index = vertex_index / 6u;
    let card = cards[index];
    if (behind_glass(card.centre.xyz) != hidden) {
        var nothing: CardVertex;
        nothing.position = vec4<f32>(0.0, 0.0, -1.0, 1.0);
        return nothing;
    }
    let corner = rain_quad_corner(vertex_index);
    let right = vec3<f32>(card.facing.y, 0.0, -card.facing.x);
    let point = card.centre.xyz + (right * corner.x + vec3<f32>(0.0, corner.y, 0.0)) * card.centre.w;
    let sight = normalize(card.centre.xyz);
    let behind = vec3<f32>(-sight.x, max(0.2, -sight.y), -sight.z);
    let theta = acos(clamp(dot(sight, view.sun_direction.xyz), -1.0, 1.0));
    var out: CardVertex;
    out.position = view.clip_from_eye * vec4<f32>(point, 1.0);
    out.axial = out.position.w;
    if (view.soft > 0.5) {
        // Tested where its cell begins: what the scene hides of it as a whole is not drawn.
        out.position.z *= out.axial / max(out.axial - card.centre.w, view.near);
    }
    out.point = point;
    out.place = rain_card_place(card, point);
    out.card = index;
    out.lamps = lamps_on(card);
    out.light = rain_drop_radiance(surroundings(sight, 0.55), surroundings(behind, 0.9), view.sun.rgb, theta);
    return out;
}

// A pixel of a card.
struct Seen {
    // Share of the cell's depth that lies before the scene.
    share: f32,
    // Middle of that part.
    middle: vec3<f32>,
}

fn before_scene(in: CardVertex, half: f32) -> Seen {
    if (view.soft < 0.5) {
        return Seen(1.0, in.point);
    }
    // Infinite reverse-Z: distance along the axis = near / depth; both grow alike along the ray.
    let scene = view.near / max(textureLoad(scene_depth, vec2<i32>(in.position.xy), 0), 1e-7);
    let way = length(in.point);
    let behind = clamp((scene / in.axial - 1.0) * way, -half, half);
    return Seen(0.5 * behind / half + 0.5, in.point * (1.0 + 0.5 * (behind - half) / way));
}

// What a card's pictures take out of the light, by layer weights: 1 - ∏(1 - o).
fn laid_over(in: CardVertex, card: Card, lighter: f32, heavier: f32, dx: vec2<f32>, dy: vec2<f32>) -> f32 {
    var through = 1.0;
    for (var i = 0u; i < card.layers.z; i++) {
        let at = in.place + rain_card_offset(card.layers, i);
        // Most cards show one of the two.
        var opacity = 0.0;
        if (lighter > 0.0) {
            opacity = textureSampleGrad(streaks, streak_sampler, at, card.layers.x, dx, dy).r * lighter;
        }
        if (heavier > 0.0) {
            opacity += textureSampleGrad(streaks, streak_sampler, at, card.layers.y, dx, dy).r * heavier;
        }
        through *= 1.0 - clamp(opacity, 0.0, 1.0);
    }
    return 1.0 - through;
}

@fragment
fn colour(in: CardVertex) -> @location(0) vec4<f32> {
    let dx = dpdx(in.place);
    let dy = dpdy(in.place);
    let card = cards[in.card];
    let gain = card.facing.z * rain_card_slant(card.facing.xy, normalize(in.point));
    let heavier = card.place.z;
    let seen = before_scene(in, card.centre.w);
    if (seen.share <= 0.0) {
        return vec4<f32>(0.0);
    }
    let opacity = seen.share
        * laid_over(in, card, gain * (1.0 - heavier) * units[card.layers.x], gain * heavier * units[card.layers.y], dx, dy);
    if (opacity < 1e-6 || rain_patch_covered(cover_map, view.cover, seen.middle, card.facing.w)) {
        return vec4<f32>(0.0);
    }
    let light = in.light + light_of(in.lamps.x, 0u, in.point) + light_of(in.lamps.y, 32u, in.point);
    let shown = rain_contrast(opacity, view.contrast);
    return vec4<f32>(mix(view.fog.rgb, light, card.place.w) * shown, shown);
}

// The share of a pixel that swept drops cover, without the share of the exposure.
@fragment
fn coverage(in: CardVertex) -> @location(0) vec4<f32> {
    let dx = dpdx(in.place);
    let dy = dpdy(in.place);
    let card = cards[in.card];
    let gain = min(card.facing.z, 1.0) * rain_card_slant(card.facing.xy, normalize(in.point));
    let heavier = card.place.z;
    let seen = before_scene(in, card.centre.w);
    if (seen.share <= 0.0) {
        return vec4<f32>(0.0);
    }
    let covered = seen.share
        * laid_over(in, card, gain * (1.0 - heavier), gain * heavier, dx, dy);
    if (covered < 1e-6 || rain_patch_covered(cover_map, view.cover, seen.middle, card.facing.w)) {
        return vec4<f32>(0.0);
    }
    return vec4<f32>(covered, 0.0, 0.0, covered);
}
