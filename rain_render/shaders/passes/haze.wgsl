// Haze over a finished scene: one triangle over the view, premultiplied.

@group(0) @binding(0) var<uniform> view: HazeView;
@group(0) @binding(1) var<storage, read> grid: array<f32>;
@group(0) @binding(2) var scene_depth: texture_depth_2d;
@group(0) @binding(3) var environment: texture_cube<f32>;
@group(0) @binding(4) var environment_sampler: sampler;
// Light of the rainbow by angle, of that on the drops, 1/sr.
@group(0) @binding(5) var<uniform> bow: array<vec4<f32>, RAIN_BOW_KNOTS>;
// What rain hits; read where there is mist of splashes.
@group(0) @binding(6) var cover_map: texture_depth_2d;

// Whether there may be mist of splashes: what it takes would slow down all haze where branches are not skipped.
override SPLASH_MIST: bool = true;

struct HazeVertex {
    @builtin(position) position: vec4<f32>,
    @location(0) ndc: vec2<f32>,
    // How much of each lamp the eye sees.
    @location(1) @interpolate(flat) seen_a: vec4<f32>,
    @location(2) @interpolate(flat) seen_b: vec4<f32>,
    @location(3) @interpolate(flat) seen_c: vec4<f32>,
    @location(4) @interpolate(flat) seen_d: vec4<f32>,
    // Height of the ground about the eye, m from it; 1e9: not known.
    @location(5) @interpolate(flat) floor_height: f32,
}

// Distance along the unit line `towards` of what has this depth; far where nothing is drawn.
fn distance_of(depth: f32, towards: vec3<f32>) -> f32 {
    let slope = depth * dot(towards, view.forward.xyz) - dot(towards, view.depth_row.xyz);
    return view.depth_row.w / max(slope, view.depth_row.w * 1e-9);
}

// How far before a lamp its own housing may be, m.
const HOUSING_M: f32 = 0.6;

// Share of a lamp that the scene does not hide from the eye, by 16 pixels about it. Beyond the picture's border the border
// answers; behind the eye nothing hides it.
fn lamp_seen(index: u32) -> f32 {
    if (index >= view.lamps) {
        return 0.0;
    }
    let place = view.lamp[index].place;
    let clip = view.clip_from_eye * vec4<f32>(place.xyz, 1.0);
    let ahead = dot(place.xyz, view.forward.xyz);
    if (ahead < 0.1) {
        return 1.0;
    }
    let middle = (clip.xy / clip.w * vec2<f32>(0.5, -0.5) + 0.5) * view.viewport.zw;
    let focal = 0.5 * view.viewport.w * length(vec3<f32>(
        view.clip_from_eye[0].y, view.clip_from_eye[1].y, view.clip_from_eye[2].y));
    let radius = max(2.0, focal * max(place.w, 0.15) / ahead);
    let distance = length(place.xyz);
    var seen = 0.0;
    for (var i = 0u; i < 16u; i += 1u) {
        // Golden angle: evenly over the disc.
        let turn = 2.3999632 * f32(i);
        let off = radius * sqrt((f32(i) + 0.5) / 16.0) * vec2<f32>(cos(turn), sin(turn));
        let pixel = clamp(middle + off, vec2<f32>(0.0), view.viewport.zw - 1.0) + view.viewport.xy;
        let found = distance_of(textureLoad(scene_depth, vec2<i32>(pixel), 0), place.xyz / distance);
        seen += select(1.0, 0.0, found < distance - HOUSING_M) / 16.0;
    }
    return seen;
}

@vertex
fn vertex(@builtin(vertex_index) vertex_index: u32) -> HazeVertex {
    var out: HazeVertex;
    out.ndc = vec2<f32>(f32(vertex_index & 1u), f32(vertex_index >> 1u)) * 4.0 - 1.0;
    out.position = vec4<f32>(out.ndc, 0.0, 1.0);
    out.seen_a = vec4<f32>(lamp_seen(0u), lamp_seen(1u), lamp_seen(2u), lamp_seen(3u));
    out.seen_b = vec4<f32>(lamp_seen(4u), lamp_seen(5u), lamp_seen(6u), lamp_seen(7u));
    out.seen_c = vec4<f32>(lamp_seen(8u), lamp_seen(9u), lamp_seen(10u), lamp_seen(11u));
    out.seen_d = vec4<f32>(lamp_seen(12u), lamp_seen(13u), lamp_seen(14u), lamp_seen(15u));
    out.floor_height = 1e9;
    if (SPLASH_MIST && view.splash.z > 0.0) {
        out.floor_height = rain_mist_floor(cover_map, view.cover, view.splash.w);
    }
    return out;
}

// Metres of rain that what is drawn stands for up to a distance.
fn drawn_metres(way: f32) -> f32 {
    let place = rain_drawn_place(way);
    let index = min(u32(place), u32(RAIN_FOG_KNOTS) - 2u);
    let last = RAIN_FOG_KNOTS - 1.0;
    let low = f32(index) / last;
    let high = f32(index + 1u) / last;
    // Straight in the distance between two entries, as FogTable has it.
    let t = clamp((way / RAIN_FOG_END_M - low * low) / (high * high - low * low), 0.0, 1.0);
    return mix(view.drawn[index / 4u][index % 4u], view.drawn[(index + 1u) / 4u][(index + 1u) % 4u], t);
}

// A direction on the ground as a place among the grid's azimuths.
fn azimuth_place(towards: vec3<f32>) -> f32 {
    let turn = 6.2831853;
    let angle = atan2(towards.z, towards.x) - view.grid.x;
    let held = angle - turn * floor(angle / turn);
    return clamp(held / view.grid.y, 0.0, f32(RAIN_HAZE_AZIMUTHS) - 1.001);
}

// Optical depth along the ground at an azimuth up to a distance. Error: 0.01 of it as a mean over pixels; for one 0.027
// of the extinction times the distance to the last rain.
fn ground_depth(azimuth: f32, distance: f32) -> f32 {
    return grid_depth(0u, azimuth, distance);
}

// Where the far rain's part of the grid begins, over its share.
const FAR_GRID: u32 = RAIN_HAZE_AZIMUTHS * (RAIN_HAZE_INTERVALS + 1u);

fn grid_depth(first: u32, azimuth: f32, distance: f32) -> f32 {
    let knot = clamp(rain_haze_place(distance, view.grid.z), 0.0, f32(RAIN_HAZE_INTERVALS) - 0.001);
    let i = u32(knot);
    let low = rain_haze_knot(f32(i), view.grid.z);
    let high = rain_haze_knot(f32(i) + 1.0, view.grid.z);
    let t = clamp((distance - low) / (high - low), 0.0, 1.0);
    let row = first + u32(azimuth) * (RAIN_HAZE_INTERVALS + 1u) + i;
    let next = row + RAIN_HAZE_INTERVALS + 1u;
    return mix(mix(grid[row], grid[row + 1u], t), mix(grid[next], grid[next + 1u], t), fract(azimuth));
}

// Pieces of the way through the rain that thins out below the cloud.
const THIN_PIECES: u32 = 4u;

// Where a line of sight enters the rain that thins out, m: no more than where it ends.
fn thin_from(towards: vec3<f32>, end: f32) -> f32 {
    if (view.far.z <= 0.0 || towards.y <= 0.0 || view.cloud <= 0.0) {
        return end;
    }
    return min(end, (view.cloud - view.far.z) / towards.y);
}

// Optical depth on the ground's grid that begins at `first` from `start` to `end`, m along the line of sight, as much as there is
// under the cloud. Error: 0.01 of it as a mean over pixels, 0.03 of the far rain's.
fn depth_under_cloud(first: u32, azimuth: f32, flat: f32, towards: vec3<f32>, start: f32, end: f32) -> f32 {
    let whole = max(thin_from(towards, end), start);
    var before = grid_depth(first, azimuth, flat * whole);
    var sum = before - grid_depth(first, azimuth, flat * start);
    if (whole < end) {
        let step = (end - whole) / f32(THIN_PIECES);
        for (var i = 0u; i < THIN_PIECES; i += 1u) {
            let after = grid_depth(first, azimuth, flat * (whole + step * f32(i + 1u)));
            let height = towards.y * (whole + step * (f32(i) + 0.5));
            sum += (after - before) * rain_cloud_share(height, view.cloud, view.far.z);
            before = after;
        }
    }
    return sum / flat;
}

// Intervals in which what is drawn is taken off the areas' rain.
const DRAWN_INTERVALS: u32 = 6u;

// Optical depth of the whole rain and of what is not drawn, along a line of sight from `ends.x` to `ends.y`. Error: 0.02 m
// times the geometric extinction.
fn depths(towards: vec3<f32>, ends: vec2<f32>) -> vec2<f32> {
    let way = ends.y - ends.x;
    let flat = length(towards.xz);
    let mist = view.air.x * way;
    if (view.uneven < 0.5 || flat < 1e-3) {
        let drawn = drawn_metres(ends.y) - drawn_metres(ends.x);
        let thin = ends.y - thin_from(towards, ends.y);
        let all = way - 0.5 * thin * thin * max(towards.y, 0.0) / max(view.far.z, 1e-6);
        return view.extinction * vec2<f32>(all, max(all - drawn, 0.0)) + mist;
    }
    let azimuth = azimuth_place(towards);
    let total = depth_under_cloud(0u, azimuth, flat, towards, ends.x, ends.y);
    var drawn = 0.0;
    var before = ends.x;
    var before_depth = ground_depth(azimuth, flat * ends.x);
    var before_drawn = drawn_metres(ends.x);
    for (var i = 1u; i <= DRAWN_INTERVALS; i += 1u) {
        let t = f32(i) / f32(DRAWN_INTERVALS);
        let at = clamp(RAIN_FOG_END_M * t * t, ends.x, ends.y);
        if (at - before > 1e-4) {
            let depth = ground_depth(azimuth, flat * at);
            let metres = drawn_metres(at);
            drawn += (depth - before_depth) / (flat * (at - before)) * (metres - before_drawn);
            before = at;
            before_depth = depth;
            before_drawn = metres;
        }
    }
    if (view.far.x > 0.0) {
        let share = view.far.x * rain_far_pitch_weight(towards.y);
        drawn += share * depth_under_cloud(FAR_GRID, azimuth, flat, towards, ends.x, ends.y);
    }
    return vec2<f32>(total, max(total - drawn, 0.0)) + mist;
}

// Exposed radiance that nobody sees.
const LEAST_GLOW: f32 = 1e-4;

// Light of the lamps that all drops between `ends` send to the eye.
fn glow(towards: vec3<f32>, ends: vec2<f32>, in: HazeVertex) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    var seen = array<vec4<f32>, 4>(in.seen_a, in.seen_b, in.seen_c, in.seen_d);
    for (var i = 0u; i < view.lamps; i += 1u) {
        let lamp = view.lamp[i];
        let share = seen[i / 4u][i % 4u];
        if (share <= 0.0) {
            continue;
        }
        var extinction = view.extinction + view.air.x;
        if (view.uneven > 0.5) {
            // The rain between the eye and the lamp, or the scene before it.
            let flat = max(length(lamp.place.xz), 0.5);
            let azimuth = azimuth_place(lamp.place.xyz);
            extinction = ground_depth(azimuth, flat) / flat + view.air.x;
        }
        // No line of sight gets more than half of I σ / h; less than a third of the darkest 8-bit step is left out.
        let beside = max(length(cross(lamp.place.xyz, towards)), lamp.place.w);
        let most = max(lamp.light.r, max(lamp.light.g, lamp.light.b));
        if (0.5 * share * most * extinction < LEAST_GLOW * view.efficiency * beside) {
            continue;
        }
        var light = 0.0;
        if (lamp.light.w < -0.99) {
            light = rain_lamp_glow(lamp.place.xyz, towards, ends.x, ends.y, lamp.place.w, extinction);
        } else {
            // A soft edge is the mean of cones between the inner and the outer one.
            for (var k = 0u; k < 3u; k += 1u) {
                let cosine = max(mix(lamp.light.w, lamp.axis.w, (f32(k) + 0.5) / 3.0), 0.01);
                let cone = rain_cone_span(lamp.place.xyz, lamp.axis.xyz, cosine, towards);
                let from_m = max(cone.x, ends.x);
                let to_m = min(cone.y, ends.y);
                light += rain_lamp_glow(lamp.place.xyz, towards, from_m, to_m, lamp.place.w, extinction) / 3.0;
            }
        }
        sum += lamp.light.rgb * (share * light * extinction / view.efficiency);
    }
    return sum;
}

// Pixels looked at below a pixel for something that mist stands on.
const HALO_TAPS: u32 = 8u;
// Mist is looked for up to this height over it, in heights of the layer.
const HALO_HEIGHT: f32 = 5.0;
// Nothing nearer has a halo, and none is wider, m and px.
const HALO_NEAREST_M: f32 = 1.0;
const HALO_WIDEST_PX: f32 = 96.0;

// Unit line of sight and distance of what is drawn at a pixel of the target.
fn seen_at(pixel: vec2<f32>, which: u32) -> vec4<f32> {
    let ndc = ((pixel - view.viewport.xy) / view.viewport.zw - 0.5) * vec2<f32>(2.0, -2.0);
    let ahead = view.eye_from_clip * vec4<f32>(ndc, 1.0, 1.0);
    let towards = normalize(ahead.xyz / ahead.w);
    let depth = textureLoad(scene_depth, vec2<i32>(pixel), i32(which));
    return vec4<f32>(towards, distance_of(depth, towards));
}

// How level what is drawn at the end of a line of sight is, by its neighbours above and below: 0 wall to 1 ground.
fn levelness(pixel: vec2<f32>, which: u32, at: vec3<f32>) -> f32 {
    var nearest = vec3<f32>(0.0, 1e9, 0.0);
    for (var i = -1; i <= 1; i += 2) {
        let row = pixel + vec2<f32>(0.0, f32(i));
        if (row.y < view.viewport.y || row.y >= view.viewport.y + view.viewport.w) {
            continue;
        }
        let seen = seen_at(row, which);
        let off = seen.xyz * seen.w - at;
        if (dot(off, off) < dot(nearest, nearest)) {
            nearest = off;
        }
    }
    return smoothstep(0.3, 0.8, length(nearest.xz) / max(length(nearest), 1e-6));
}

// Distance of the nearest thing under a line of sight that is seen less than a few heights of the layer below it, and nearer
// than `before`; 0: none.
fn edge_below(pixel: vec2<f32>, which: u32, towards: vec3<f32>, before: f32) -> f32 {
    // Pixels of a metre up, a metre away.
    let here = view.clip_from_eye * vec4<f32>(towards, 1.0);
    let over = view.clip_from_eye * vec4<f32>(towards + vec3<f32>(0.0, 0.01, 0.0), 1.0);
    let up = (over.xy / over.w - here.xy / here.w) * vec2<f32>(50.0, -50.0) * view.viewport.zw;
    let scale = length(up);
    let furthest = min(HALO_HEIGHT * view.splash.y * scale / HALO_NEAREST_M, HALO_WIDEST_PX);
    if (furthest < 1.0) {
        return 0.0;
    }
    var nearer = 0.0;
    for (var i = 0u; i < HALO_TAPS; i += 1u) {
        let off = pow(furthest, f32(i) / f32(HALO_TAPS - 1u));
        let place = pixel - up / scale * off;
        if (any(place < view.viewport.xy) || any(place >= view.viewport.xy + view.viewport.zw)) {
            break;
        }
        let distance = seen_at(place, which).w;
        // The edge lies between the pixel before and this one.
        if (distance < before - 0.05 && nearer * distance < HALO_HEIGHT * view.splash.y * scale) {
            return distance;
        }
        nearer = off;
    }
    return 0.0;
}

// Light of the lamps that mist of an optical depth at a place sends to the eye.
fn mist_glow(at: vec3<f32>, towards: vec3<f32>, depth: f32, in: HazeVertex) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    if (depth < 1e-3) {
        return sum;
    }
    var seen = array<vec4<f32>, 4>(in.seen_a, in.seen_b, in.seen_c, in.seen_d);
    for (var i = 0u; i < view.lamps; i += 1u) {
        let lamp = view.lamp[i];
        let way = at - lamp.place.xyz;
        let squared = max(dot(way, way), max(lamp.place.w * lamp.place.w, 0.01));
        let ray = way * inverseSqrt(squared);
        var share = seen[i / 4u][i % 4u];
        if (lamp.light.w > -0.99) {
            let inner = max(lamp.axis.w, lamp.light.w + 1e-4);
            share *= smoothstep(lamp.light.w, inner, dot(ray, lamp.axis.xyz));
        }
        let turned = acos(clamp(-dot(ray, towards), -1.0, 1.0));
        let phase = RAIN_DROP_TRANSMITTED * rain_drop_phase(turned) + RAIN_DROP_REFLECTED * 0.0795775;
        sum += lamp.light.rgb * (share * phase / squared);
    }
    return sum * rain_haze_share(depth) / view.efficiency;
}

// Mist of splashes on a line of sight: what stands before what is seen, what stands on the edge below and how far away that
// is, what the wind has carried up.
fn splash_mist(in: HazeVertex, pixel: vec2<f32>, which: u32, towards: vec3<f32>, way: f32, ends: vec2<f32>) -> vec4<f32> {
    let thrown = view.splash.x;
    let height = view.splash.y;
    var out = vec4<f32>(0.0);
    if (thrown > 0.0) {
        // The sky ends no layer.
        let ground = way < view.limit && ends.y >= way;
        var free = ends.y;
        if (ground) {
            let at = towards * way;
            let mapped = rain_mist_mapped(view.cover, at);
            if (mapped > 0.0) {
                let share = rain_mist_at(cover_map, view.cover, at, height);
                if (share > RAIN_MIST_LEAST) {
                    out.x = mapped
                        * rain_mist_before(cover_map, view.cover, towards, way, height, ends.x, share);
                    free = max(way - rain_mist_reach(towards.y, height), ends.x);
                }
            }
            if (mapped < 1.0 && towards.y < 0.0) {
                out.x += (1.0 - mapped) * levelness(pixel, which, at)
                    * rain_mist_on_level(towards.y, way - ends.x, height);
            }
        }
        let edge = edge_below(pixel, which, towards, free);
        if (edge > ends.x) {
            let mapped = rain_mist_mapped(view.cover, towards * edge);
            out.y = mapped * rain_mist_over(cover_map, view.cover, towards, edge, ends.x, free, height);
            out.z = edge;
        }
    }
    if (view.splash.z > 0.0 && in.floor_height < 1e8) {
        out.w = view.splash.z * rain_mist_over_floor(in.floor_height, towards.y, ends.x, ends.y, view.splash.w);
    }
    return out * vec4<f32>(thrown, thrown, 1.0, 1.0);
}

// Light of the rainbow at an angle from the point opposite the sun, of that on the drops, 1/sr. Error: 2e-4 per sr.
fn rainbow(angle: f32) -> vec3<f32> {
    let place = rain_bow_place(angle);
    let index = min(u32(place), RAIN_BOW_KNOTS - 2u);
    return mix(bow[index].rgb, bow[index + 1u].rgb, place - f32(index));
}

struct Haze {
    light: vec3<f32>,
    obscured: f32,
}

fn haze(in: HazeVertex, pixel: vec2<f32>, which: u32) -> Haze {
    let ahead = view.eye_from_clip * vec4<f32>(in.ndc, 1.0, 1.0);
    let towards = normalize(ahead.xyz / ahead.w);
    let depth = textureLoad(scene_depth, vec2<i32>(pixel), i32(which));
    let way = min(distance_of(depth, towards), view.limit);
    var ends = rain_under_cloud(view.cloud, towards.y, way);
    if (view.air.y > 0.0) {
        // What lies before the mirror is no part of its picture: the view itself has it.
        ends.x = min(max(ends.x, view.air.y / max(towards.y, 1e-6)), ends.y);
    }
    var through = depths(towards, ends);
    var mist = vec4<f32>(0.0);
    if (SPLASH_MIST && view.splash.x + view.splash.z > 0.0) {
        mist = splash_mist(in, pixel, which, towards, way, ends);
        through.y += mist.x + mist.y + mist.w;
    }
    var out: Haze;
    // What a drop keeps by inner reflections leaves it all the same: in even light haze shows that light.
    out.light = rain_drop_shine(
        environment,
        environment_sampler,
        view.environment,
        view.ambient,
        view.sun_direction.xyz,
        view.sun.rgb * view.air.w,
        towards,
    ) / (RAIN_DROP_TRANSMITTED + RAIN_DROP_REFLECTED);
    out.obscured = rain_haze_share(through.y);
    var light = out.light * out.obscured;
    let share = view.sun_direction.w;
    if (share > 0.0) {
        let luminance = dot(out.light, vec3<f32>(0.2126, 0.7152, 0.0722));
        let own = rain_desaturated(mix(out.light, luminance * view.fog.rgb, view.coloured), view.fog.w);
        let obscured = rain_haze_share(view.artist * (ends.y - ends.x));
        light = mix(light, own * obscured, share);
        out.obscured = mix(out.obscured, obscured, share);
    }
    out.light = light + glow(towards, ends, in);
    if (SPLASH_MIST && mist.x + mist.y > 0.0) {
        out.light += mist_glow(towards * way, towards, mist.x, in) + mist_glow(towards * mist.z, towards, mist.y, in);
    }
    if (view.air.z > 0.0) {
        let rain = max(through.x - view.air.x * (ends.y - ends.x), 0.0) / view.efficiency;
        let light = rainbow(rain_bow_angle(towards, view.sun_direction.xyz)) * rain_bow_share(rain);
        out.light += view.air.z * view.sun.rgb * light;
    }
    return out;
}

@fragment
fn colour(in: HazeVertex) -> @location(0) vec4<f32> {
    let which = 0u;
    let found = haze(in, in.position.xy, which);
    return vec4<f32>(found.light, found.obscured);
}

@fragment
fn coverage(in: HazeVertex) -> @location(0) vec4<f32> {
    let found = haze(in, in.position.xy, 0u);
    return vec4<f32>(found.obscured, 0.0, 0.0, found.obscured);
}
