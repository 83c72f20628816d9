// Films and pores of the ground on square levels that follow the view.

@group(0) @binding(0) var<uniform> params: WaterMapParams;
// Pores mm, film mm, soil clock s of each texel, level after level.
@group(0) @binding(1) var<storage, read_write> water: array<f32>;
// Height of each ground cell over the base, m (below -1e8: no ground); class in bits 0..7, exposure in bits 8..15.
@group(0) @binding(2) var<storage, read> ground: array<vec2<u32>>;
// Water of the ground cells that new texels start from; w unused.
@group(0) @binding(3) var<storage, read> seeds: array<vec4<f32>>;
// Film that each stamp has pressed and places beside it, in 1/4096 mm and texels.
@group(0) @binding(4) var<storage, read_write> sums: array<atomic<u32>>;
@group(0) @binding(5) var cover_map: texture_depth_2d;
@group(0) @binding(6) var level_map: texture_2d<f32>;
@group(0) @binding(7) var drawn: texture_storage_2d_array<rgba16float, write>;
// Rain areas. Row 0: how many, share of the weather's rain where none is, the weather's rate, the rate that params.rain
// stands for (mm/h; 0: it falls everywhere). Then each area as rain_core packs it.
@group(0) @binding(8) var<storage, read> areas: array<vec4<f32>>;
@group(1) @binding(0) var<uniform> stamp: WaterStamp;

// Height of what is no ground, as in the map of films.
const NO_GROUND_M: f32 = -3e4;

// A texel's ground.
struct Ground {
    // Its cell; -1 where there is none.
    cell: i32,
    height: f32,
    normal: vec3<f32>,
    rules: ColumnRules,
    exposure: f32,
    pool: bool,
}

fn cell_height(cell: vec2<i32>, own: f32) -> f32 {
    let inside = clamp(cell, vec2<i32>(0), params.ground_cells - 1);
    let height = bitcast<f32>(ground[inside.y * params.ground_cells.x + inside.x].x);
    // A kerb or a hole is no slope.
    return select(own, height, abs(height - own) < 0.1);
}

fn ground_under(texel: vec2<i32>) -> Ground {
    var out: Ground;
    let place = params.ground_corner + (vec2<f32>(texel) + 0.5) * params.ground_step;
    let cell = vec2<i32>(floor(place));
    out.cell = -1;
    if (any(cell < vec2<i32>(0)) || any(cell >= params.ground_cells)) {
        return out;
    }
    let index = cell.y * params.ground_cells.x + cell.x;
    let packed = ground[index];
    let own = bitcast<f32>(packed.x);
    if (own < -1e8) {
        return out;
    }
    out.cell = index;
    // Between the middles of the cells.
    let corner = floor(place - 0.5);
    let f = place - 0.5 - corner;
    let a = vec2<i32>(corner);
    let h = vec4<f32>(
        cell_height(a, own), cell_height(a + vec2<i32>(1, 0), own),
        cell_height(a + vec2<i32>(0, 1), own), cell_height(a + vec2<i32>(1, 1), own),
    );
    out.height = mix(mix(h.x, h.y, f.x), mix(h.z, h.w, f.x), f.y);
    let slope = vec2<f32>(mix(h.y - h.x, h.w - h.z, f.y), mix(h.z - h.x, h.w - h.y, f.x)) * params.per_ground_cell;
    out.normal = normalize(vec3<f32>(-slope.x, 1.0, -slope.y));
    out.rules = params.rules[min(packed.y & 255u, 6u)];
    out.exposure = f32((packed.y >> 8u) & 255u) / 255.0;
    out.pool = params.pools > 0.5 && textureLoad(level_map, cell, 0).x > own;
    return out;
}

// Share of the rain that reaches a texel: by the map of what covers now, beyond it by the ground's own.
fn exposure_of(texel: vec2<i32>, at: Ground) -> f32 {
    let place = params.corner + (vec2<f32>(texel) + 0.5) * params.cell;
    let p = vec3<f32>(place.x, params.base + at.height, place.y);
    let uv = (rain_cover_project(params.cover, p) - params.cover.centre) * params.cover.inverse_extent;
    if (params.cover.present < 0.5 || any(abs(uv) > vec2<f32>(0.48))) {
        return at.exposure;
    }
    return rain_exposure(cover_map, params.cover, p + 0.03 * at.normal, rain_exposure_bias(params.cover, at.normal));
}

// Share of the pass's rain that falls at a place (x, z) from the origin of the cover map's positions.
fn local_share(place: vec2<f32>) -> f32 {
    let head = areas[0];
    if (head.w <= 0.0) {
        return 1.0;
    }
    return min(packed_rate(place) / head.w, 1.0);
}

fn stored(texel: vec2<i32>) -> vec2<u32> {
    return (vec2<u32>(texel) + params.offset) & vec2<u32>(params.texels - 1u);
}

fn index_of(at: vec2<u32>) -> u32 {
    return 3u * ((params.level * params.texels + at.y) * params.texels + at.x);
}

fn load(index: u32) -> vec3<f32> {
    return vec3<f32>(water[index], water[index + 1u], water[index + 2u]);
}

fn keep(at: vec2<u32>, column: vec3<f32>, under: Ground) {
    let index = index_of(at);
    water[index] = column.x;
    water[index + 1u] = column.y;
    water[index + 2u] = column.z;
    var texel = vec4<f32>(0.0, 0.0, NO_GROUND_M, 0.0);
    if (under.cell >= 0) {
        let film = rain_closed_film(column.y, under.rules.texture);
        texel = vec4<f32>(film, clamp(column.x / under.rules.capacity, 0.0, 1.0), under.height, 1.0);
    }
    textureStore(drawn, at, params.level, texel);
}

// What the ground's own cell holds.
fn seed_of(cell: i32) -> vec3<f32> {
    let place = vec2<i32>(cell % params.ground_cells.x, cell / params.ground_cells.x) - params.seed_low;
    if (any(place < vec2<i32>(0)) || any(place >= params.seed_cells)) {
        return vec3<f32>(0.0);
    }
    return seeds[place.y * params.seed_cells.x + place.x].xyz;
}

@compute @workgroup_size(8, 8)
fn advance(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= vec2<u32>(params.texels))) {
        return;
    }
    let texel = vec2<i32>(id.xy);
    let at = stored(texel);
    let under = ground_under(texel);
    var column = vec3<f32>(0.0);
    if (under.cell >= 0) {
        let before = texel - params.kept;
        if (all(before >= vec2<i32>(0)) && all(before < vec2<i32>(i32(params.texels)))) {
            column = load(index_of(at));
        } else {
            column = seed_of(under.cell);
        }
        if (under.pool) {
            column = vec3<f32>(under.rules.capacity, 0.0, column.z);
        } else if (params.time > 0.0) {
            var rain = params.rain;
            if (rain > 0.0) {
                rain *= local_share(params.corner + (vec2<f32>(texel) + 0.5) * params.cell);
            }
            if (rain > 0.0) {
                rain *= exposure_of(texel, under);
            }
            column = rain_column(column, under.rules, rain, params.evaporation, params.time);
        }
    }
    keep(at, column, under);
}

// Place along and across a stamp's way, m.
fn on_way(texel: vec2<i32>) -> vec2<f32> {
    let d = (vec2<f32>(texel) + 0.5) * params.cell - stamp.start;
    return vec2<f32>(dot(d, stamp.along), stamp.along.x * d.y - stamp.along.y * d.x);
}

fn part_within(middle: f32, low: f32, high: f32) -> f32 {
    let half = 0.5 * params.cell;
    return clamp((min(middle + half, high) - max(middle - half, low)) / params.cell, 0.0, 1.0);
}

fn is_beside(way: vec2<f32>) -> bool {
    let off = abs(way.y) - stamp.half;
    let half = 0.5 * params.cell;
    return way.x > -half && way.x < stamp.length + half && off >= half && off < half + stamp.band;
}

// Presses the film under a stamp.
@compute @workgroup_size(8, 8)
fn press(@builtin(global_invocation_id) id: vec3<u32>) {
    let texel = stamp.low + vec2<i32>(id.xy);
    if (any(vec2<i32>(id.xy) >= stamp.count)) {
        return;
    }
    let under = ground_under(texel);
    if (under.cell < 0) {
        return;
    }
    let way = on_way(texel);
    if (is_beside(way)) {
        atomicAdd(&sums[2u * stamp.slot + 1u], 1u);
    }
    let at = stored(texel);
    var column = load(index_of(at));
    let share = part_within(way.x, 0.0, stamp.length) * part_within(way.y, -stamp.half, stamp.half) * stamp.share;
    if (under.pool || column.y <= 0.0 || share <= 0.0) {
        return;
    }
    let taken = column.y * share;
    column.y -= taken;
    atomicAdd(&sums[2u * stamp.slot], u32(min(taken, 50.0) * 4096.0 + 0.5));
    keep(at, column, under);
}

// Lays beside it what it has pressed.
@compute @workgroup_size(8, 8)
fn lay(@builtin(global_invocation_id) id: vec3<u32>) {
    let texel = stamp.low + vec2<i32>(id.xy);
    if (any(vec2<i32>(id.xy) >= stamp.count)) {
        return;
    }
    let taken = f32(atomicLoad(&sums[2u * stamp.slot])) / 4096.0;
    if (taken <= 0.0 || !is_beside(on_way(texel))) {
        return;
    }
    let under = ground_under(texel);
    if (under.cell < 0 || under.pool) {
        return;
    }
    let at = stored(texel);
    var column = load(index_of(at));
    column.y += taken * stamp.aside / f32(max(atomicLoad(&sums[2u * stamp.slot + 1u]), 1u));
    keep(at, column, under);
}
