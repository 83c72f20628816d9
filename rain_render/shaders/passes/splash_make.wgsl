// Splashes of a view from hashes: crowns and thrown drops as they are found, the sums of their numbers, and then the same in
// the order of cells and slots, which does not change from run to run.

@group(0) @binding(0) var<uniform> view: SplashView;
@group(0) @binding(1) var<storage, read_write> places: array<u32>;
@group(0) @binding(2) var<storage, read_write> parts: array<SplashPart>;
@group(0) @binding(3) var<storage, read_write> draw: SplashDraw;
@group(0) @binding(4) var cover_map: texture_depth_2d;
@group(0) @binding(5) var environment: texture_cube<f32>;
@group(0) @binding(6) var environment_sampler: sampler;
@group(0) @binding(7) var level_map: texture_2d<f32>;
@group(0) @binding(8) var<storage, read_write> finds: array<SplashFind>;

// Crowns are gone after this, s.
const CROWN_END: f32 = 0.02;
// What adds less than this to a pixel is not drawn.
const LEAST_OPACITY: f32 = 0.002;
// The same for thrown drops, of which there are many.
const LEAST_DROP_OPACITY: f32 = 0.01;

fn shine(p: vec3<f32>) -> vec3<f32> {
    var light = rain_drop_shine(
        environment,
        environment_sampler,
        view.environment,
        view.ambient,
        view.sun_direction.xyz,
        view.sun.rgb,
        normalize(p),
    );
    for (var i = 0u; i < view.lamps; i++) {
        light += rain_lamp_radiance(view.lamp[i], p);
    }
    return light;
}

// 1, or -1 behind what is transparent.
fn side_of_glass(p: vec3<f32>) -> f32 {
    for (var i = 0u; i < view.panes; i++) {
        if (rain_behind_pane(view.pane[i], p)) {
            return -1.0;
        }
    }
    return 1.0;
}

fn to_pixels(clip: vec4<f32>) -> vec2<f32> {
    return (clip.xy / clip.w * vec2<f32>(0.5, -0.5) + 0.5) * view.viewport;
}

// Whether both ends of a segment lie beyond one side of the view by more than `margin`.
fn beside(a: vec3<f32>, b: vec3<f32>, margin: f32) -> bool {
    for (var i = 0; i < 4; i++) {
        let plane = view.planes[i];
        if (max(dot(plane.xyz, a), dot(plane.xyz, b)) + plane.w < -margin) {
            return true;
        }
    }
    return false;
}

fn impacts(word: u32) -> u32 {
    for (var i = 0u; i < 32u; i++) {
        let limits = view.counts[i];
        let below = vec4<u32>(limits <= vec4<u32>(word));
        if (below.w == 0u) {
            return 4u * i + below.x + below.y + below.z;
        }
    }
    return 128u;
}

fn size_class(word: u32) -> u32 {
    var class_index = 0u;
    for (var i = 0u; i < 11u; i++) {
        class_index += u32(view.limits[i >> 2u][i & 3u] <= word);
    }
    return class_index;
}

// A splash of the view.
struct Found {
    place: vec3<f32>,
    normal: vec3<f32>,
    velocity: vec3<f32>,
    diameter: f32,
    film: f32,
    excess: f32,
    age: f32,
    life: f32,
    weight: f32,
    key: vec3<u32>,
    marks: vec3<u32>,
}

// The crown of a splash, or nothing (shape.w = 0).
fn crown(found: Found) -> SplashPart {
    var part: SplashPart;
    let speed = -dot(found.velocity, found.normal);
    let life = rain_crown_life(found.diameter);
    let start = found.age - view.exposure;
    if (found.age < 0.0 || start >= life) {
        return part;
    }
    let time = 0.5 * (max(start, 0.0) + min(found.age, life));
    let vary = vec2<f32>(rain_unit(found.marks.y), rain_unit(found.marks.z));
    // Dry ground throws drops from the foot of the impact; a sheet stands on a film.
    let sheet = mix(0.35, 1.0, clamp(found.film / (0.08 * found.diameter), 0.0, 1.0));
    var opacity = RAIN_CROWN_OPACITY * sheet * (0.7 + 0.6 * vary.y)
        * found.weight * rain_crown_seen(found.diameter, found.age, view.exposure) / view.exposure;
    // What one splash cannot show of those that it stands for, it shows by its size.
    let grown = (0.8 + 0.4 * vary.x) * sqrt(max(opacity, 1.0));
    opacity = min(opacity, 1.0);
    let radius = grown * rain_crown_radius(found.diameter, speed, found.film, time);
    let height = grown * rain_crown_height(found.diameter, found.excess, time);
    return standing_sheet(found.place, found.normal, radius, height, opacity, reach_fade(length(found.place), view.reach), rain_unit(found.key.x));
}

// Fades what is right before the eye, and towards the end of the reach.
fn reach_fade(distance: f32, reach: f32) -> f32 {
    return rain_ramp(0.1, 0.25, distance) * (1.0 - rain_ramp(0.7 * reach, reach, distance));
}

// A sheet of water that stands in a ring, radius and height in m, or nothing (shape.w = 0).
fn standing_sheet(
    place: vec3<f32>,
    normal: vec3<f32>,
    radius: f32,
    height: f32,
    opacity: f32,
    fade: f32,
    jets: f32,
) -> SplashPart {
    var part: SplashPart;
    let from_eye = place / max(length(place), 1e-3);
    let clip = view.clip_from_eye * vec4<f32>(place, 1.0);
    // Drawn before what it stands on: its foot reaches into the ground's pixels.
    let front = view.clip_from_eye * vec4<f32>(place - from_eye * min(2.0 * radius, 0.5 * length(place)), 1.0);
    let above = view.clip_from_eye * vec4<f32>(place + 0.01 * normal, 1.0);
    if (clip.w < max(view.near, 0.05) || front.w < view.near || above.w < view.near || fade <= 0.0) {
        return part;
    }
    let scale = view.focal / clip.w;
    let foot = to_pixels(clip);
    let rise = to_pixels(above) - foot;
    let up = select(vec2<f32>(0.0, -1.0), rise / max(length(rise), 1e-6), length(rise) > 1e-4);
    let down = clamp(-dot(from_eye, normal), 0.0, 1.0);
    let half = radius * scale;
    let tall = height * sqrt(1.0 - down * down) * scale;
    let minor = half * down;
    // Below a pixel its opacity shrinks instead.
    let area = (2.0 * half) * (tall + 1.6 * minor);
    let width = max(2.0 * half, 1.0);
    let depth = max(tall + 1.6 * minor, 1.0);
    let share = fade * area / (width * depth);
    let shown = fade * rain_contrast(opacity * area / (width * depth), view.contrast);
    if (shown < LEAST_OPACITY) {
        return part;
    }
    part.ends = vec4<f32>(foot, up);
    part.shape = vec4<f32>(front.z / front.w, 0.5 * width, tall, shown);
    part.light = vec4<f32>(shine(place), opacity * share);
    part.form = vec4<f32>(1.0, minor, jets, max(radius, 0.002) * side_of_glass(place));
    return part;
}

// Thrown drop `index`, or nothing.
fn thrown(found: Found, count: u32, index: u32) -> SplashPart {
    var part: SplashPart;
    // At rest, seen from where the splash is, it would cover this much.
    let most = found.diameter * 1e-3 * rain_thrown_share(found.key, index) * view.focal / max(length(found.place) - 0.5, 0.05);
    if (view.contrast * found.weight * most * most < LEAST_DROP_OPACITY) {
        return part;
    }
    let drop = rain_thrown_drop(found.diameter, found.velocity, found.normal, found.key, count, index);
    let now = rain_thrown_place(drop.xyz, drop.w, found.age);
    let before = rain_thrown_place(drop.xyz, drop.w, max(found.age - view.exposure, 0.0));
    // Landed.
    if (dot(now, found.normal) <= 0.0) {
        return part;
    }
    let p = found.place + now;
    let fade = reach_fade(length(p), view.near_reach) * (1.0 - rain_ramp(0.7 * found.life, found.life, found.age));
    // Young drops have flown for a part of the exposure.
    let weight = found.weight * min(found.age / view.exposure, 1.0);
    return flying(p, found.place + before, drop.w, weight, fade);
}

// A drop on its way through the exposure, or nothing (shape.w = 0).
fn flying(p: vec3<f32>, before: vec3<f32>, diameter_mm: f32, weight: f32, fade: f32) -> SplashPart {
    var part: SplashPart;
    let head = view.clip_from_eye * vec4<f32>(p, 1.0);
    let tail = view.clip_from_eye_before * vec4<f32>(before, 1.0);
    if (min(head.w, tail.w) < max(view.near, 0.05) || fade <= 0.0) {
        return part;
    }
    let size = diameter_mm * 1e-3 * view.focal / (0.5 * (head.w + tail.w));
    let a = to_pixels(head);
    let b = to_pixels(tail);
    let width = max(1.0, size);
    let span = max(1.0, length(b - a) + size);
    let opacity = min(1.0, weight * 0.7853982 * size * size / (width * span));
    let shown = fade * rain_contrast(opacity, view.contrast);
    if (shown < LEAST_DROP_OPACITY) {
        return part;
    }
    part.ends = vec4<f32>(a, b);
    part.shape = vec4<f32>(head.z / head.w, tail.z / tail.w, 0.5 * width, shown);
    part.light = vec4<f32>(shine(p), fade * opacity);
    part.form = vec4<f32>(0.0, 0.0, 0.0, 0.01 * side_of_glass(p));
    return part;
}

// Notes part `number` of a cell and slot.
fn note(part: SplashPart, id: u32, number: u32) {
    let at = atomicAdd(&draw.noted, 1u);
    if (at < view.capacity) {
        finds[at] = SplashFind(part, id, number, 0u, 0u);
    }
}

// Finds the splashes of one cell and slot; the number of their parts.
fn cell_and_slot(id: u32) -> u32 {
    let side = 2u * view.span + 1u;
    let back = id % u32(RAIN_SPLASH_SLOTS);
    let column = id / u32(RAIN_SPLASH_SLOTS);
    let cell = vec2<i32>(i32(column % side), i32(column / side)) - i32(view.span);
    let corner = (vec2<f32>(cell) - view.fraction) * RAIN_SPLASH_CELL_M;
    let middle = corner + 0.5 * RAIN_SPLASH_CELL_M;
    // The nearest and the youngest that this cell can hold.
    let nearest = max(length(middle) - RAIN_SPLASH_CELL_M, 0.0);
    let youngest = view.since + (f32(back) - 1.0) * RAIN_SPLASH_SLOT_S;
    if (nearest > view.reach || (nearest > view.near_reach && youngest > CROWN_END + view.exposure)) {
        return 0u;
    }
    let low = vec3<f32>(middle.x, view.cover.top - view.cover.range, middle.y);
    let high = vec3<f32>(middle.x, view.cover.highest, middle.y);
    if (beside(low, high, 0.5)) {
        return 0u;
    }
    let absolute = view.cell + cell;
    let key = rain_pcg3d(view.stream.xyz ^ vec3<u32>(bitcast<vec2<u32>>(absolute), view.stream.w - back));
    let count = impacts(key.x);
    var parts_found = 0u;
    for (var index = 0u; index < count; index++) {
        let place = rain_drop_place(key, index);
        let age = view.since + (f32(back) - place.y) * RAIN_SPLASH_SLOT_S;
        let marks = rain_drop_marks(key, index);
        var found: Found;
        found.age = age;
        found.life = 0.1 + 0.2 * rain_unit(marks.z);
        if (age < 0.0 || age > found.life) {
            continue;
        }
        let at = corner + vec2<f32>(place.x, place.z) * RAIN_SPLASH_CELL_M;
        let far = length(at) > view.near_reach;
        if (far && age > CROWN_END + view.exposure) {
            continue;
        }
        let form = view.classes[size_class(marks.x)];
        found.diameter = form.x - log(1.0 - rain_unit(marks.y) * form.y) / form.z;
        found.weight = form.w;
        let landing = rain_landing(cover_map, view.cover, at);
        if (landing.found < 0.5) {
            continue;
        }
        found.place = vec3<f32>(at.x, landing.height, at.y);
        found.normal = landing.normal;
        let distance = length(found.place);
        if (distance > view.reach || beside(found.place, found.place, 0.3)) {
            continue;
        }
        let fall = rain_terminal_velocity(found.diameter);
        found.velocity = view.wind.xyz - vec3<f32>(0.0, fall, 0.0);
        found.key = rain_pcg3d(marks);
        found.marks = rain_pcg3d(found.key.yzx);
        let toward = -dot(found.velocity, found.normal);
        // Slopes in the lee are hit less often than level ground.
        if (toward <= rain_unit(found.marks.x) * fall * found.normal.y
            || rain_covered(cover_map, view.cover, found.place, 1.0 / fall)) {
            continue;
        }
        let water = rain_standing_water(level_map, view.levels, found.place);
        found.film = view.film;
        if (water > 0.0) {
            found.film = max(1e3 * water, view.film);
            found.place.y += water;
            found.normal = vec3<f32>(0.0, 1.0, 0.0);
        }
        found.excess = rain_splash_excess(found.diameter, toward, found.film);
        if (found.excess <= 1.0) {
            continue;
        }
        let sheet = crown(found);
        if (sheet.shape.w > 0.0) {
            note(sheet, id, parts_found);
            parts_found++;
        }
        if (distance > view.near_reach) {
            continue;
        }
        let drops = rain_thrown_count(found.excess, found.key);
        for (var i = 0u; i < drops; i++) {
            let drop = thrown(found, drops, i);
            if (drop.shape.w > 0.0) {
                note(drop, id, parts_found);
                parts_found++;
            }
        }
    }
    return parts_found;
}

// How far steps are seen, m.
const FOOT_REACH: f32 = 25.0;
// Its sheet sheds many fine jets: 16 to 19.
const FOOT_JETS: f32 = 3.0;
// A sheet and at most 63 drops.
const FOOT_PARTS: u32 = 64u;

// Part `index` of the steps: the sheet of each, then its drops. The number of parts.
fn part_of_step(id: u32, index: u32) -> u32 {
    let foot = view.foot[index / FOOT_PARTS];
    let number = index % FOOT_PARTS;
    let place = foot.place.xyz;
    let age = foot.place.w;
    let strength = bitcast<f32>(foot.key.w);
    let fade = reach_fade(length(place), FOOT_REACH);
    if (fade <= 0.0 || beside(place, place, 1.0)) {
        return 0u;
    }
    var part: SplashPart;
    if (number == 0u) {
        let form = rain_foot_sheet(strength, age);
        part = standing_sheet(place, vec3<f32>(0.0, 1.0, 0.0), form.x, form.y, form.z, fade, FOOT_JETS + rain_unit(foot.key.x));
    } else if (number <= rain_foot_drop_count(strength)) {
        let drop = rain_foot_drop(strength, foot.key.xyz, number - 1u);
        let edge = place + RAIN_SOLE_M * drop.outward;
        let now = rain_thrown_place(drop.drop.xyz, drop.drop.w, age);
        // It ends where it falls back to the water's level.
        if (age >= 0.0 && now.y >= 0.0) {
            let before = rain_thrown_place(drop.drop.xyz, drop.drop.w, max(age - view.exposure, 0.0));
            part = flying(edge + now, edge + before, drop.drop.w, min(age / view.exposure, 1.0), fade);
        }
    }
    if (part.shape.w > 0.0) {
        note(part, id, 0u);
        return 1u;
    }
    return 0u;
}

fn cells_and_slots() -> u32 {
    let side = 2u * view.span + 1u;
    return side * side * u32(RAIN_SPLASH_SLOTS);
}

fn invocations() -> u32 {
    return cells_and_slots() + view.feet * FOOT_PARTS;
}

// Error: places 1e-4 m, and as the functions say.
@compute @workgroup_size(64)
fn find(@builtin(global_invocation_id) id: vec3<u32>) {
    let cells = cells_and_slots();
    if (id.x < cells) {
        places[id.x] = cell_and_slot(id.x);
    } else if (id.x < invocations()) {
        places[id.x] = part_of_step(id.x, id.x - cells);
    }
}

var<workgroup> sums: array<u32, 256>;

@compute @workgroup_size(256)
fn add(@builtin(local_invocation_index) lane: u32) {
    let all = invocations();
    let run = (all + 255u) / 256u;
    let start = min(lane * run, all);
    let end = min(start + run, all);
    var sum = 0u;
    for (var i = start; i < end; i++) {
        sum += places[i];
    }
    sums[lane] = sum;
    workgroupBarrier();
    var before = 0u;
    for (var i = 0u; i < lane; i++) {
        before += sums[i];
    }
    for (var i = start; i < end; i++) {
        let own = places[i];
        places[i] = before;
        before += own;
    }
    if (lane == 255u) {
        draw.found = before;
        atomicStore(&draw.noted, 0u);
        draw.vertices = 6u * min(before, view.capacity);
        draw.instances = 1u;
        draw.first_vertex = 0u;
        draw.first_instance = 0u;
    }
}

// Where there is no room for all, those that were found first are kept as they are.
@compute @workgroup_size(64)
fn sort(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x < min(draw.found, view.capacity)) {
        let find = finds[id.x];
        let place = select(id.x, places[find.id] + find.number, draw.found <= view.capacity);
        parts[place] = find.part;
    }
}
