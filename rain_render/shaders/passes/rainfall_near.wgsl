// Near streaks: the picture in their drop, drawn out along its path. After the others, of which they leave nothing out.

@group(0) @binding(0) var<uniform> view: RainfallView;
@group(0) @binding(1) var<storage, read> streaks: array<Streak>;
@group(0) @binding(2) var scene_depth: texture_depth_2d;
@group(0) @binding(3) var<storage, read> records: array<DropRecord>;
@group(0) @binding(4) var environment: texture_cube<f32>;
@group(0) @binding(5) var environment_sampler: sampler;
// Which streaks are looked at.
@group(0) @binding(6) var<storage, read> listed: array<u32>;

// The outline of the most deflected drop lies within this many radii of an even drop's.
const OUTLINE_REACH: f32 = 1.45;
// Places along a pixel's way through a drop, on each of two lines that take turns.
const PLACES: i32 = 4;

struct NearVertex {
    @builtin(position) position: vec4<f32>,
    // Those of the even streak.
    @location(0) local: vec2<f32>,
    @location(1) @interpolate(flat) size: vec2<f32>,
    @location(2) @interpolate(flat) light: vec4<f32>,
    @location(3) @interpolate(flat) coverage: f32,
    @location(4) @interpolate(flat) which: u32,
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

// A corner of a streak of this half width; nothing of one that has no pattern.
fn corner(which: u32, half: f32, vertex_index: u32) -> NearVertex {
    var quad = no_corner();
    if (which != RAIN_NO_DROP && half > 0.0 && has_pattern(half)) {
        quad = streak_corner(streaks[which], half, OUTLINE_REACH, vertex_index);
        quad.size -= (OUTLINE_REACH - 1.0) * 2.0 * half;
    }
    return NearVertex(quad.position, quad.local, quad.size, quad.light, quad.coverage, which);
}

@vertex
fn vertex(@builtin(vertex_index) vertex_index: u32) -> NearVertex {
    let which = listed[vertex_index / 4u];
    return corner(which, streaks[which].shape.z, vertex_index);
}

// Those behind what is transparent.
@vertex
fn vertex_behind(@builtin(vertex_index) vertex_index: u32) -> NearVertex {
    let which = listed[vertex_index / 4u];
    return corner(which, -streaks[which].shape.z, vertex_index);
}

// What a drop is lit by beside its surroundings.
struct DropLights {
    // Direction towards the lamp that matters most and its irradiance.
    lamp: vec3<f32>,
    irradiance: vec3<f32>,
    // Radiance that the other lamps give all of the drop.
    others: vec3<f32>,
}

fn lights_on(place: vec3<f32>) -> DropLights {
    var out = DropLights(vec3<f32>(0.0, 1.0, 0.0), vec3<f32>(0.0), vec3<f32>(0.0));
    var greatest = 0.0;
    var kept = vec3<f32>(0.0);
    for (var i = 0u; i < view.lamps; i++) {
        let radiance = rain_lamp_radiance(view.lamp[i], place);
        let strength = max(radiance.r, max(radiance.g, radiance.b));
        out.others += radiance;
        if (strength > greatest) {
            greatest = strength;
            kept = radiance;
            out.lamp = normalize(view.lamp[i].place.xyz - place);
            out.irradiance = view.lamp[i].intensity.rgb * rain_lamp_falloff(view.lamp[i], place);
        }
    }
    out.others -= kept;
    return out;
}

// Radiance of a place in a drop; `spread` is the angle that it stands for.
fn shown(heights: vec2<f32>, through: vec3<f32>, from_eye: vec3<f32>, spread: f32, lights: DropLights) -> vec3<f32> {
    let rays = rain_body_rays(heights, from_eye, rain_body_enter(heights, through, from_eye));
    let blur = clamp(sqrt(0.5 * spread), 0.1, 0.55);
    var light = rays.straight.w
        * rain_surroundings(environment, environment_sampler, view.environment, view.ambient, rays.straight.xyz, blur);
    // Turned twice as far from place to place.
    light += rays.outside.w
        * rain_surroundings(environment, environment_sampler, view.environment, view.ambient, rays.outside.xyz, 0.6);
    light += rays.inner.w
        * rain_surroundings(environment, environment_sampler, view.environment, view.ambient, rays.inner.xyz, 0.6);
    let sigma = clamp(0.6 * spread, 0.1, 0.6);
    let sharpness = 1.0 / (sigma * sigma);
    light += view.sun.rgb * rain_glint(rays, view.sun_direction.xyz, sharpness);
    light += lights.irradiance * rain_glint(rays, lights.lamp, sharpness);
    return RAIN_NEAR_SHARE * light + lights.others;
}

// Radiance of a near streak at a place across and along it, and the share of the exposure for which its drop is there.
// Error: the drop's size and the light on it are those of the middle of its way.
fn pattern(which: u32, local: vec2<f32>) -> vec4<f32> {
    let streak = streaks[which];
    let record = records[which];
    let k = view.classes[record.drop & 15u];
    let drop = rain_field_drop(record, k);
    let before = drop.place - k.velocity.xyz * view.exposure;
    let middle = 0.5 * (drop.place + before);
    let from_eye = normalize(middle);
    // Level and upward across the line of sight, in space and in the picture.
    let sideways = vec3<f32>(-from_eye.z, 0.0, from_eye.x);
    let right = select(vec3<f32>(1.0, 0.0, 0.0), sideways * inverseSqrt(max(dot(sideways, sideways), 1e-12)),
        dot(sideways, sideways) > 1e-6);
    let up = cross(right, from_eye);
    var clip = view.clip_from_eye * vec4<f32>(middle, 1.0);
    let deep = max(clip.w, max(view.near, 0.02));
    let at = rain_pixel(vec4<f32>(clip.xyz, deep), view.viewport.zw);
    let aside = rain_pixel(vec4<f32>((clip + view.clip_from_eye * vec4<f32>(0.01 * right, 0.0)).xyz, deep), view.viewport.zw);
    let above = rain_pixel(vec4<f32>((clip + view.clip_from_eye * vec4<f32>(0.01 * up, 0.0)).xyz, deep), view.viewport.zw);
    let axes = mat2x2<f32>(normalize(aside - at), normalize(above - at));

    let path = streak.ends.zw - streak.ends.xy;
    let travelled = length(path);
    let along = select(vec2<f32>(0.0, 1.0), path / max(travelled, 1e-6), travelled > 1e-4);
    let share = clamp(0.5 + local.y / max(travelled, 1.0), 0.0, 1.0);
    let height = mix(drop.place.y, before.y, share) + view.lead.w;
    let heights = rain_swinging_body(drop.diameter, rain_swing(drop.diameter, drop.chance, height, -k.velocity.y));
    let outline = rain_outline_heights(heights, from_eye.y);
    // Radius of the widest circle, px.
    let radius = abs(streak.shape.z) * rain_outline_radius(outline);

    let across = (vec2<f32>(-along.y, along.x) * axes) / radius;
    let onward = (along * axes) / radius;
    let span = max(travelled, 1.0);
    let lights = lights_on(middle);
    var light = vec3<f32>(0.0);
    var inside = 0.0;
    // Two places across a pixel.
    for (var i = 0; i < 2; i++) {
        let point = across * (local.x + 0.5 * f32(i) - 0.25) + onward * local.y;
        let times = rain_time_inside(point, onward, outline);
        let enters = max(times.x, -0.5 * span);
        let stays = min(times.y, 0.5 * span) - enters;
        if (stays <= 0.0) {
            continue;
        }
        inside += stays;
        let spread = max(0.5 * stays * length(onward) / f32(PLACES), 0.5 / radius);
        for (var j = 0; j < PLACES; j++) {
            let when = enters + stays * (f32(j) + 0.25 + 0.5 * f32(i)) / f32(PLACES);
            let q = point - when * onward;
            light += stays / f32(PLACES) * shown(heights, right * q.x + up * q.y, from_eye, spread, lights);
        }
    }
    let secant = clamp(length(middle) / deep, 1.0, 4.0);
    return vec4<f32>(light / max(inside, 1e-9), min(0.5 * inside / span * secant, 1.0));
}

@fragment
fn colour(in: NearVertex) -> @location(0) vec4<f32> {
    let strip = StreakVertex(in.position, in.local, in.size, in.light, in.coverage);
    let opacity = in.light.a * presence(strip);
    let drawn = pattern(in.which, in.local);
    // The coverage of a streak wider than a pixel is its weight.
    let clear = in.coverage * rain_contrast(drawn.a, view.contrast) * before_scene(in.position);
    return mix(
        vec4<f32>(in.light.rgb * opacity, opacity),
        vec4<f32>(drawn.rgb * clear, clear),
        rain_ramp(PATTERN_FROM, PATTERN_WHOLE, in.size.x),
    );
}

// That of the even streak.
@fragment
fn coverage(in: StreakVertex) -> @location(0) vec4<f32> {
    let c = in.coverage * presence(in);
    return vec4<f32>(c, 0.0, 0.0, c);
}
