// Splashes as rain_core::splash computes them: thresholds, crowns and the drops that are thrown.

// K of an impact over the K at which a drop splashes; film in mm. Error: 1e-4 relative to the CPU's.
fn rain_splash_excess(diameter_mm: f32, speed: f32, film_mm: f32) -> f32 {
    let d = max(diameter_mm, 1e-6) * 1e-3;
    let weber = 998.2 * speed * speed * d / 0.0728;
    let reynolds = 998.2 * speed * d / 1.002e-3;
    let k = sqrt(weber) * sqrt(sqrt(reynolds));
    let delta = film_mm / max(diameter_mm, 1e-6);
    var threshold = 657.4781 + (2254.8199 - 657.4781) * (delta / 0.08);
    if (delta >= 0.08) {
        threshold = 2100.0 + 5880.0 * pow(min(delta, 1.2), 1.44);
    }
    let root = sqrt(threshold);
    return k / (root * sqrt(sqrt(root)));
}

// How long a crown stands, s. Error: 1e-5 relative to the CPU's.
fn rain_crown_life(diameter_mm: f32) -> f32 {
    let d = diameter_mm * 1e-3;
    return clamp(sqrt(998.2 * d * d * d / 0.0728), 0.01, 0.02);
}

// Radius of a crown `time` s after the impact, m. Error: 1e-5 relative to the CPU's.
fn rain_crown_radius(diameter_mm: f32, speed: f32, film_mm: f32, time: f32) -> f32 {
    let d = diameter_mm * 1e-3;
    let delta = clamp(film_mm / max(diameter_mm, 1e-6), 0.02, 2.0);
    return min(sqrt(sqrt(2.0 / (3.0 * delta))) * sqrt(d * speed * max(time, 0.0)), 4.0 * d);
}

// Height of its rim, m, from the excess. Error: 1e-5 of the diameter against the CPU's.
fn rain_crown_height(diameter_mm: f32, excess: f32, time: f32) -> f32 {
    let peak = diameter_mm * 1e-3 * min(2.5, 0.6 * sqrt(max(excess - 1.0, 0.0)));
    let t = time / rain_crown_life(diameter_mm);
    return peak * max(4.0 * t * (1.0 - t), 0.0);
}

// Seconds that a crown has been seen since its impact.
fn rain_crown_seen_since(life: f32, time: f32) -> f32 {
    let half = 0.5 * life;
    let t = max(time, 0.0);
    let fading = clamp(t / half - 1.0, 0.0, 1.0);
    return min(t, half) + half * fading * (1.0 - fading * fading * (1.0 - 0.5 * fading));
}

// Seconds that it was seen during the exposure that ends `age` s after the impact. Error: 1e-7 s against the CPU's.
fn rain_crown_seen(diameter_mm: f32, age: f32, exposure: f32) -> f32 {
    let life = rain_crown_life(diameter_mm);
    return rain_crown_seen_since(life, age) - rain_crown_seen_since(life, age - exposure);
}

// How many drops a splash throws: 5 to 30. Error: the CPU's, save within 1e-4 of where the number changes.
fn rain_thrown_count(excess: f32, key: vec3<u32>) -> u32 {
    let mean = 5.0 + 25.0 * clamp((excess - 1.0) / 18.0, 0.0, 1.0);
    return min(u32(mean + rain_unit(rain_pcg3d(key).x)), 30u);
}

// Diameter of thrown drop `index` in diameters of the drop that fell.
fn rain_thrown_share(key: vec3<u32>, index: u32) -> f32 {
    let u = rain_unit(rain_pcg3d(vec3<u32>(key.x ^ rain_pcg(index), key.y, key.z + index)).x);
    return 0.05 + 0.25 * u * u;
}

// Velocity, m/s, and diameter (w, mm) of thrown drop `index` of `count`. Error: diameter 1e-6 relative, velocity 1e-5 of the impact's, against the CPU's.
fn rain_thrown_drop(
    diameter_mm: f32,
    velocity: vec3<f32>,
    normal: vec3<f32>,
    key: vec3<u32>,
    count: u32,
    index: u32,
) -> vec4<f32> {
    let marks = rain_pcg3d(vec3<u32>(key.x ^ rain_pcg(index), key.y, key.z + index));
    let u = rain_unit(marks.x);
    let share = 0.05 + 0.25 * u * u;
    let toward = max(-dot(velocity, normal), 0.0);
    let small = (0.3 - share) / 0.25;
    let speed = toward * (0.1 + 0.2 * (rain_unit(marks.y) + small));
    let angle = 0.6981317 + 0.5235988 * rain_unit(marks.z);
    let spin = rain_unit(rain_pcg3d(vec3<u32>(key.z, key.x, key.y ^ 0x73706c61u)).x);
    let sector = f32(index) + rain_unit((marks.y << 13u) | (marks.y >> 19u));
    let around = 6.2831853 * (sector / f32(max(count, 1u)) + spin);
    // As glam's any_orthonormal_pair.
    let side = select(-1.0, 1.0, normal.z >= 0.0);
    let a = -1.0 / (side + normal.z);
    let b = normal.x * normal.y * a;
    let tangent = vec3<f32>(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x);
    let bitangent = vec3<f32>(b, side + normal.y * normal.y * a, -normal.y);
    let along = velocity - normal * dot(velocity, normal);
    var thrown = speed * (normal * sin(angle) + (tangent * cos(around) + bitangent * sin(around)) * cos(angle)) + 0.3 * along;
    thrown *= min(1.0, 0.5 * length(velocity) / max(length(thrown), 1e-9));
    return vec4<f32>(thrown, share * diameter_mm);
}

// Where a thrown drop is after `age` s, from the impact, m. Error: 1e-5 m against the CPU's.
fn rain_thrown_place(velocity: vec3<f32>, diameter_mm: f32, age: f32) -> vec3<f32> {
    let fall = rain_terminal_velocity(diameter_mm);
    let time = max(fall / 9.80665, 1e-3);
    let sink = vec3<f32>(0.0, -fall, 0.0);
    return sink * age + (velocity - sink) * (time * (1.0 - exp(-age / time)));
}

// How many drops a step throws. Error: the CPU's, save where rounding meets a whole number.
fn rain_foot_drop_count(strength: f32) -> u32 {
    return select(0u, u32(8.0 + 55.0 * min(strength, 1.0)), strength > 0.0);
}

// A drop that a step throws: velocity, m/s, diameter (w, mm), and the direction in which it leaves the sole.
struct RainFootDrop {
    drop: vec4<f32>,
    outward: vec3<f32>,
}

// Half the width of a sole, m.
const RAIN_SOLE_M: f32 = 0.05;

// Drop `index` of a step. Error: diameter 1e-6 relative, velocity 1e-5 m/s against the CPU's.
fn rain_foot_drop(strength: f32, key: vec3<u32>, index: u32) -> RainFootDrop {
    let count = max(rain_foot_drop_count(strength), 1u);
    let marks = rain_pcg3d(vec3<u32>(key.x ^ rain_pcg(index), key.y, key.z + index));
    let u = rain_unit(marks.x);
    let speed = sqrt(min(strength, 1.0)) * (0.8 + 1.7 * rain_unit(marks.y));
    let angle = 0.43633232 + 0.6981317 * rain_unit(marks.z);
    let sector = f32(index) + rain_unit((marks.y << 13u) | (marks.y >> 19u));
    let around = 6.2831853 * (sector / f32(count));
    let outward = vec3<f32>(cos(around), 0.0, sin(around));
    let velocity = speed * (outward * cos(angle) + vec3<f32>(0.0, sin(angle), 0.0));
    return RainFootDrop(vec4<f32>(velocity, 1.5 + 5.0 * u * u), outward);
}

// The sheet that a sole presses out: radius and height, m, and opacity. Error: 1e-5 relative to the CPU's.
fn rain_foot_sheet(strength: f32, age: f32) -> vec3<f32> {
    let t = age / 0.12;
    if (t < 0.0 || t >= 1.0 || strength <= 0.0) {
        return vec3<f32>(0.0);
    }
    let root = sqrt(min(strength, 1.0));
    return vec3<f32>(RAIN_SOLE_M + 0.15 * root * t, 0.04 * root * 4.0 * t * (1.0 - t), 0.25 * min(2.0 - 2.0 * t, 1.0));
}

// Opacity of a crown's sheet, seen square on. Chosen by eye.
const RAIN_CROWN_OPACITY: f32 = 0.5;

// How far its jets rise over the height of the sheet. Chosen by eye.
const RAIN_CROWN_JETS: f32 = 2.2;

// How much of a pixel a crown covers, 0..1: its front and its back wall as seen from an eye that looks down on it. `at` is
// the pixel from the middle of the foot, px, y along the normal; `radius`, `height` and `minor` (half the depth of the
// foot's ellipse) in px; `seed` 0..1 gives the jets.
fn rain_crown_sheet(at: vec2<f32>, radius: f32, height: f32, minor: f32, seed: f32) -> f32 {
    let s = at.x / max(radius, 1e-3);
    let q = sqrt(max(1.0 - s * s, 0.0));
    let edge = clamp(radius + 0.5 - abs(at.x), 0.0, 1.0);
    let jets = 4.0 + floor(4.0 * seed);
    let angle = 1.5707963 * s;
    // A wall that is seen along is thicker.
    let thick = min(1.0 / (q + 0.25), 2.0);
    var clear = 1.0;
    for (var wall = 0; wall < 2; wall++) {
        let foot = select(minor, -minor, wall == 0) * q;
        let turn = select(3.1415927 - angle, angle, wall == 0);
        let jet = pow(max(cos(jets * turn + 6.2831853 * seed), 0.0), 6.0);
        let rim = height * mix(0.55, RAIN_CROWN_JETS, jet);
        let inside = clamp(at.y - foot + 0.5, 0.0, 1.0) * clamp(foot + rim - at.y + 0.5, 0.0, 1.0);
        clear *= 1.0 - min(0.6 * thick, 1.0) * inside;
    }
    return edge * (1.0 - clear);
}
