// Drops on paint and glass: the twins of rain_core::surface::beads. x, y: slope along the face's two directions, z: cover.

// Slope of a cap at a share of its base's radius, down from the middle. Error: 2e-6.
fn rain_bead_slope(share: f32) -> f32 {
    let x = clamp(share, 0.0, 1.0);
    // 1/sin² of the contact angle, 70°.
    return min(x / sqrt(1.1324746 - x * x), 1.6);
}

fn rain_bead_growth(wetness: f32, chance: f32) -> f32 {
    return clamp((clamp(wetness, 0.0, 1.0) - 0.7 * clamp(chance, 0.0, 1.0)) / 0.3, 0.0, 1.0);
}

// The drop of a lattice at a place, m. `radii`: least and greatest radius as shares of a cell; `turn`: cosine and sine of the
// lattice's turn.
fn rain_bead_of(place: vec2<f32>, cell: f32, radii: vec2<f32>, turn: vec2<f32>, seed: u32, wetness: f32) -> vec3<f32> {
    let turned = vec2<f32>(turn.x * place.x - turn.y * place.y, turn.y * place.x + turn.x * place.y) / cell;
    let row = bitcast<u32>(i32(floor(turned.y)));
    let cells = turned + vec2<f32>(rain_unit(rain_pcg3d(vec3<u32>(row, seed, 0x726F77u)).x), 0.0);
    let id = floor(cells);
    let hash = rain_pcg3d(vec3<u32>(bitcast<vec2<u32>>(vec2<i32>(id)), seed));
    let chance = rain_unit((hash.x << 20u) | (hash.y & 0xFFFFFu));
    let radius = mix(radii.x, radii.y, rain_unit(hash.z) * rain_unit(hash.z)) * rain_bead_growth(wetness, chance);
    let middle = radius + (1.0 - 2.0 * radius) * vec2<f32>(rain_unit(hash.x), rain_unit(hash.y));
    let off = cells - id - middle;
    let distance = length(off);
    if (distance >= radius) {
        return vec3<f32>(0.0);
    }
    let down = -off * (rain_bead_slope(distance / radius) / max(distance, 1e-6));
    return vec3<f32>(turn.x * down.x + turn.y * down.y, turn.x * down.y - turn.y * down.x, 1.0);
}

// The coarse lattice (0) or the fine one (1).
fn rain_bead_at(place: vec2<f32>, lattice: u32, seed: u32, wetness: f32) -> vec3<f32> {
    if (lattice == 0u) {
        return rain_bead_of(place, 0.005, vec2<f32>(0.12, 0.48), vec2<f32>(0.8, 0.6), seed, wetness);
    }
    return rain_bead_of(place, 0.0025, vec2<f32>(0.1, 0.46), vec2<f32>(0.3846154, -0.9230769), seed, wetness);
}

// Drops that run down a steep face; `place` is (across, down), m, `time` in s from 0 to 4096.
fn rain_trickle_at(place: vec2<f32>, time: f32, seed: u32, wetness: f32) -> vec3<f32> {
    let column = floor(place.x / 0.02);
    let id = bitcast<u32>(i32(column));
    let phase = rain_unit(rain_pcg3d(vec3<u32>(id, seed, 0x74726963u)).x);
    let along = (place.y - time * 0.0625) / 0.8 - phase;
    let number = floor(along);
    let turn = i32(number) % 320;
    let hash = rain_pcg3d(vec3<u32>(id, u32(select(turn, turn + 320, turn < 0)), seed));
    let a = rain_unit(hash.x);
    let growth = rain_bead_growth(wetness, a / 0.35);
    if (a >= 0.35 || growth <= 0.0) {
        return vec3<f32>(0.0);
    }
    let behind = (0.9 - (along - number)) * 0.8;
    let bend = 0.12 * sin(6.2831853 * fract(place.y / 0.13 + rain_unit(hash.z)));
    let aside = place.x - (column + 0.35 + 0.3 * rain_unit(hash.y) + bend) * 0.02;
    let head = 0.0022 * growth;
    let distance = length(vec2<f32>(aside, behind));
    if (distance < head) {
        return vec3<f32>(vec2<f32>(-aside, behind) * (rain_bead_slope(distance / head) / max(distance, 1e-6)), 1.0);
    }
    let left = clamp(1.0 - behind / (0.3 * growth), 0.0, 1.0);
    if (behind <= 0.0 || left <= 0.0) {
        return vec3<f32>(0.0);
    }
    let width = 0.0009 * sqrt(left);
    if (abs(aside) >= width) {
        return vec3<f32>(0.0, 0.0, select(0.0, left, abs(aside) < 0.0022));
    }
    return vec3<f32>(-aside * (0.5 * rain_bead_slope(abs(aside) / width) / max(abs(aside), 1e-6)), 0.0, 1.0);
}

// All drops on a face: both lattices, and what runs where the face is `steep` (0..1). A pixel `footprint` m wide shows
// drops that are wider than two of it; w: the cover of those it does not show.
fn rain_beads(place: vec2<f32>, footprint: f32, time: f32, seed: u32, wetness: f32, steep: f32) -> vec4<f32> {
    let shown = 1.0 - smoothstep(vec2<f32>(0.25), vec2<f32>(0.6), footprint / vec2<f32>(0.003, 0.0013));
    let whole = vec2<f32>(0.2171, 0.1882) * clamp(wetness, 0.0, 1.0);
    var hidden = 1.0 - (1.0 - whole.x * (1.0 - shown.x)) * (1.0 - whole.y * (1.0 - shown.y));
    if (shown.x <= 0.0) {
        return vec4<f32>(0.0, 0.0, 0.0, hidden);
    }
    var run = vec3<f32>(0.0);
    if (steep > 0.0) {
        run = rain_trickle_at(place, time, seed ^ 0x5bd1e995u, wetness * steep) * shown.x;
    }
    var found = rain_bead_at(place, 0u, seed, wetness) * shown.x;
    if (found.z <= 0.0 && shown.y > 0.0) {
        found = rain_bead_at(place, 1u, seed + 1u, wetness) * shown.y;
    }
    // Drops that run take those on their way with them.
    let slope = mix(found.xy, run.xy, run.z);
    return vec4<f32>(slope, max(found.z * (1.0 - run.z), run.z * step(0.0001, length(run.xy))), hidden * (1.0 - run.z));
}
