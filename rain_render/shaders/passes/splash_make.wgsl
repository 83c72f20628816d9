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
@group(0) @binding(9) var<storage, read> mouths: array<SpoutMouth>;

// Crowns are gone after this, s.
const CROWN_END: f32 = 0.02;
// What adds less than this to a pixel is not drawn.
const LEAST_OPACITY: f32 = 0.002;
// The same for thrown drops, of which there are many.
const LEAST_DROP_OPACITY: f32 = 0.01;

// Along which a place is seen, unit.
fn seen(p: vec3<f32>) -> vec3<f32> {
    let from_eye = p + view.rays.xyz;
    return from_eye / max(length(from_eye), 1e-3);
}

// How far a place is before the eye, m; without perspective all are as far that nothing is special about them.
fn before_eye(p: vec3<f32>) -> f32 {
    return select(length(p), 1.0, view.rays.w > 0.0);
}

fn shine(p: vec3<f32>) -> vec3<f32> {
    var light = rain_drop_shine(
        environment,
        environment_sampler,
        view.environment,
        view.ambient,
        view.sun_direction.xyz,
        view.sun.rgb,
        seen(p),
    );
    for (var i = 0u; i < view.lamps; i++) {
        light += rain_lamp_radiance_along(view.lamp[i], p, seen(p));
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
    // Speed against the surface that it falls on.
    toward: f32,
    excess: f32,
    age: f32,
    life: f32,
    weight: f32,
    key: vec3<u32>,
    marks: vec3<u32>,
}

// The crown of a splash that is seen to `reach`, or nothing (shape.w = 0).
fn crown(found: Found, reach: f32) -> SplashPart {
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
    return standing_sheet(found.place, found.normal, radius, height, opacity, view.shares.x * reach_fade(found.place, reach), rain_unit(found.key.x));
}

// Fades what is right before the eye.
fn near_fade(p: vec3<f32>) -> f32 {
    return rain_ramp(0.1, 0.25, before_eye(p));
}

// The same, and towards the end of the reach.
fn reach_fade(p: vec3<f32>, reach: f32) -> f32 {
    return near_fade(p) * (1.0 - rain_ramp(0.7 * reach, reach, length(p)));
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
    let from_eye = seen(place);
    let clip = view.clip_from_eye * vec4<f32>(place, 1.0);
    // Drawn before what it stands on: its foot reaches into the ground's pixels.
    let front = view.clip_from_eye * vec4<f32>(place - from_eye * min(2.0 * radius, 0.5 * before_eye(place)), 1.0);
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

// Thrown drop `index` of a splash whose drops are seen to `reach`, or nothing.
fn thrown(found: Found, count: u32, index: u32, reach: f32) -> SplashPart {
    var part: SplashPart;
    // At rest, seen from where the splash is, it would cover this much.
    let most = found.diameter * 1e-3 * rain_thrown_share(found.key, index) * view.focal / max(before_eye(found.place) - select(0.5, 0.0, view.rays.w > 0.0), 0.05);
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
    let fade = view.shares.y * reach_fade(p, reach) * (1.0 - rain_ramp(0.7 * found.life, found.life, found.age));
    // Young drops have flown for a part of the exposure.
    let weight = found.weight * min(found.age / view.exposure, 1.0);
    return flying(p, found.place + before, drop.w, weight, fade);
}

// A drop on its way through the exposure, lit, or nothing (shape.w = 0).
fn flying(p: vec3<f32>, before: vec3<f32>, diameter_mm: f32, weight: f32, fade: f32) -> SplashPart {
    var part = streak_of(p, before, diameter_mm, weight, fade);
    if (part.shape.w > 0.0) {
        part.light = vec4<f32>(shine(p), part.light.w);
    }
    return part;
}

// The same without its light.
fn streak_of(p: vec3<f32>, before: vec3<f32>, diameter_mm: f32, weight: f32, fade: f32) -> SplashPart {
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
    part.light = vec4<f32>(0.0, 0.0, 0.0, fade * opacity);
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

// Notes the parts of a splash where it has met the water or the ground; their number. Those before it have `number`.
fn note_splash(splash: Found, id: u32, number: u32, reach: f32, near_reach: f32) -> u32 {
    var found = splash;
    var parts_found = 0u;
    let water = rain_standing_water(level_map, view.levels, found.place);
    if (water > 0.0) {
        found.film = max(1e3 * water, found.film);
        found.place.y += water;
        found.normal = vec3<f32>(0.0, 1.0, 0.0);
    }
    found.excess = rain_splash_excess(found.diameter, found.toward, found.film);
    if (found.excess <= 1.0) {
        return 0u;
    }
    let sheet = crown(found, reach);
    if (sheet.shape.w > 0.0) {
        note(sheet, id, number);
        parts_found++;
    }
    if (length(found.place) > near_reach) {
        return parts_found;
    }
    let drops = rain_thrown_count(found.excess, found.key);
    for (var i = 0u; i < drops; i++) {
        let drop = thrown(found, drops, i, near_reach);
        if (drop.shape.w > 0.0) {
            note(drop, id, number + parts_found);
            parts_found++;
        }
    }
    return parts_found;
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
        found.film = view.film;
        found.toward = toward;
        parts_found += note_splash(found, id, parts_found, view.reach, view.near_reach);
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
    let fade = reach_fade(place, FOOT_REACH);
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

// Parcels of a mouth that are looked for in the air, and splashes of those that have landed last.
const MOUTH_PARCELS: u32 = 48u;
const MOUTH_SPLASHES: u32 = 10u;
// How far drops that its splashes throw are seen, m.
const MOUTH_DROPS_REACH: f32 = 6.0;
// As many drops as one splash shows at most, and splashes that a parcel makes at most.
const MOUTH_WEIGHT: f32 = 5.0;
const MOUTH_COPIES: u32 = 4u;
// Largest drop that a jet which lands whole splashes like, mm.
const MOUTH_DROP_MM: f32 = 12.0;
// Film that stands where water pours, mm.
const MOUTH_FILM_MM: f32 = 0.5;

// Where a mouth's water lands.
struct MouthEnd {
    age: f32,
    normal: vec3<f32>,
}

fn mouth_way(mouth: SpoutMouth, age: f32) -> vec3<f32> {
    return rain_spout_place(mouth.velocity.xyz, mouth.velocity.w, view.wind.xyz, age);
}

// Diameter of a jet, which thins as it falls, m.
fn jet_width(mouth: SpoutMouth, age: f32) -> f32 {
    let down = rain_spout_speed(mouth.velocity.xyz, mouth.velocity.w, age);
    let now = length(vec2<f32>(down, length(mouth.velocity.xz)));
    return mouth.form.x * sqrt(length(mouth.velocity.xyz) / max(now, 1e-3));
}

// The ground below. The map's texels under an eave hold the roof: it is looked for a little further out, too.
fn mouth_end(mouth: SpoutMouth) -> MouthEnd {
    for (var out = 0; out < 3; out++) {
        var age = mouth.state.y;
        var normal = vec3<f32>(0.0, 1.0, 0.0);
        var found = false;
        for (var again = 0; again < 2; again++) {
            let at = mouth.place.xyz + mouth_way(mouth, age);
            let landing = rain_landing(cover_map, view.cover, at.xz + 0.2 * f32(out) * mouth.state.zw);
            found = landing.found > 0.5 && landing.height < mouth.place.y - 0.1;
            if (!found) {
                break;
            }
            age = rain_spout_time(mouth.velocity.xyz, mouth.velocity.w, mouth.place.y - landing.height);
            normal = landing.normal;
        }
        if (found) {
            return MouthEnd(age, normal);
        }
    }
    return MouthEnd(mouth.state.y, vec3<f32>(0.0));
}

// A piece of a jet between two places, `diameter` m thick, or nothing (shape.w = 0).
fn jet_piece(a: vec3<f32>, b: vec3<f32>, diameter: f32, fade: f32) -> SplashPart {
    var part: SplashPart;
    let head = view.clip_from_eye * vec4<f32>(a, 1.0);
    let tail = view.clip_from_eye * vec4<f32>(b, 1.0);
    if (min(head.w, tail.w) < max(view.near, 0.05)) {
        return part;
    }
    let size = diameter * view.focal / (0.5 * (head.w + tail.w));
    let width = max(1.0, size);
    let opacity = min(1.0, size / width);
    let shown = fade * rain_contrast(opacity, view.contrast);
    if (shown < LEAST_OPACITY) {
        return part;
    }
    part.ends = vec4<f32>(to_pixels(head), to_pixels(tail));
    part.shape = vec4<f32>(head.z / head.w, tail.z / tail.w, 0.5 * width, shown);
    part.light = vec4<f32>(0.0, 0.0, 0.0, fade * opacity);
    part.form = vec4<f32>(0.0, 0.0, 0.0, 0.01 * side_of_glass(a));
    return part;
}

// The water of a mouth: its jet, its drops in the air, the splashes of those that have landed. The number of parts.
fn parts_of_mouth(id: u32, index: u32) -> u32 {
    let mouth = mouths[index];
    let place = mouth.place.xyz;
    let far = 1.0 - rain_ramp(0.7 * view.mouth_reach, view.mouth_reach, length(place));
    if (far <= 0.0 || beside(place, place + mouth_way(mouth, mouth.state.y), 0.5)) {
        return 0u;
    }
    let end = mouth_end(mouth);
    let low = place + mouth_way(mouth, end.age);
    let above = shine(place);
    let below = shine(low);
    let period = mouth.place.w;
    let gathered = mouth.state.x;
    let jets = mouth.form.y > 0.0;
    let diameter = mouth.form.z;
    var parts_found = 0u;
    if (!jets) {
        // What hangs there and grows.
        let drop = flying(place, place, diameter * pow(gathered, 1.0 / 3.0), 1.0, far * near_fade(place));
        if (drop.shape.w > 0.0) {
            note(drop, id, 0u);
            parts_found++;
        }
    }
    for (var k = 0u; k <= MOUTH_PARCELS; k++) {
        let oldest = (gathered + f32(k)) * period;
        let youngest = max(oldest - period, 0.0);
        if (youngest >= end.age) {
            break;
        }
        let marks = rain_pcg3d(vec3<u32>(mouth.key.xy, mouth.key.z - k));
        let breaks = mouth.form.y * (0.85 + 0.3 * rain_unit(marks.x));
        // Parcels differ: they go down with the water.
        let glint = 0.75 + 0.5 * rain_unit(marks.y);
        var part: SplashPart;
        var age = oldest;
        if (youngest < breaks) {
            let until = min(oldest, min(breaks, end.age));
            age = 0.5 * (youngest + until);
            // It swells and shrinks before it breaks.
            let thin = jet_width(mouth, age);
            let swell = 1.0 + 0.7 * clamp(age / breaks, 0.0, 1.0) * (rain_unit(marks.z) - 0.5);
            let upper = place + mouth_way(mouth, youngest);
            part = jet_piece(upper, place + mouth_way(mouth, until), thin * swell, far * near_fade(upper));
        } else {
            if (jets) {
                age = oldest - 0.5 * period;
            }
            if (age > end.age) {
                break;
            }
            // Drops part sideways a little.
            let aside = 0.03 * (vec2<f32>(rain_unit(marks.y), rain_unit(marks.z)) - 0.5);
            let astray = vec3<f32>(aside.x, 0.0, aside.y);
            let earlier = max(age - view.exposure, 0.0);
            let now = place + mouth_way(mouth, age) + age * astray;
            let before = place + mouth_way(mouth, earlier) + earlier * astray;
            part = streak_of(now, before, diameter, mouth.form.w, far * near_fade(now));
        }
        if (part.shape.w > 0.0) {
            part.light = vec4<f32>(glint * mix(above, below, clamp(age / end.age, 0.0, 1.0)), part.light.w);
            note(part, id, parts_found);
            parts_found++;
        }
    }
    // Nothing is known of the ground: it falls out of sight.
    if (dot(end.normal, end.normal) < 0.5) {
        return parts_found;
    }
    let first = u32(max(ceil(end.age / period - gathered), 0.0));
    let shown = f32(MOUTH_SPLASHES) * period;
    let copies = clamp(u32(mouth.form.w / MOUTH_WEIGHT), 1u, MOUTH_COPIES);
    // Drops part as they fall; a jet comes down over its own width.
    let spread = select(0.03 * end.age, 0.03 + 3.0 * mouth.form.x, jets);
    var found: Found;
    found.normal = end.normal;
    found.velocity = (low - place - mouth_way(mouth, max(end.age - 0.01, 0.0))) / min(0.01, max(end.age, 1e-3));
    found.toward = -dot(found.velocity, found.normal);
    found.diameter = diameter;
    if (mouth.form.y > end.age) {
        // It lands whole: as drops of its own width.
        found.diameter = clamp(1e3 * jet_width(mouth, end.age), diameter, MOUTH_DROP_MM);
    }
    found.film = max(view.film, MOUTH_FILM_MM);
    found.weight = min(mouth.form.w / f32(copies), MOUTH_WEIGHT);
    for (var i = 0u; i < MOUTH_SPLASHES * copies; i++) {
        let k = first + i / copies;
        let copy = i % copies;
        let marks = rain_pcg3d(vec3<u32>(mouth.key.x, mouth.key.y ^ (copy << 28u), mouth.key.z - k));
        // What stands for several lands in the time of all.
        found.age = (gathered + f32(k) - f32(copy) / f32(copies)) * period - end.age;
        found.life = min(0.1 + 0.2 * rain_unit(marks.z), shown);
        if (found.age < 0.0 || found.age > found.life) {
            continue;
        }
        let aside = spread * (vec2<f32>(rain_unit(marks.x), rain_unit(marks.y)) - 0.5);
        found.place = low + vec3<f32>(aside.x, 0.0, aside.y);
        found.key = rain_pcg3d(marks);
        found.marks = rain_pcg3d(found.key.yzx);
        parts_found += note_splash(found, id, parts_found, view.mouth_reach, MOUTH_DROPS_REACH);
    }
    return parts_found;
}

fn cells_and_slots() -> u32 {
    let side = 2u * view.span + 1u;
    return side * side * u32(RAIN_SPLASH_SLOTS);
}

fn invocations() -> u32 {
    return cells_and_slots() + view.feet * FOOT_PARTS + view.mouths;
}

// Error: places 1e-4 m, and as the functions say.
@compute @workgroup_size(64)
fn find(@builtin(global_invocation_id) id: vec3<u32>) {
    let cells = cells_and_slots();
    if (id.x < cells) {
        places[id.x] = cell_and_slot(id.x);
    } else if (id.x < cells + view.feet * FOOT_PARTS) {
        places[id.x] = part_of_step(id.x, id.x - cells);
    } else if (id.x < invocations()) {
        places[id.x] = parts_of_mouth(id.x, id.x - cells - view.feet * FOOT_PARTS);
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
