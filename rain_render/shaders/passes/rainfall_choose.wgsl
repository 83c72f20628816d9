// Which drops a view draws singly: those in the cells of all lattices about it are counted, then listed in the order of the
// cells, so that the list is the same each time.

@group(0) @binding(0) var<uniform> view: RainfallView;
@group(0) @binding(1) var<uniform> choice: RainfallChoice;
// Drops of each run of cells in the lower half of a word, how many of them may have a pattern in the upper.
@group(0) @binding(2) var<storage, read_write> counts: array<u32>;
// Those of each group of runs, then those of all groups before.
@group(0) @binding(3) var<storage, read_write> sums: array<vec2<u32>>;
// See `RainfallArguments` in rain_render.
@group(0) @binding(4) var<storage, read_write> arguments: array<u32>;
// The drops that runs have, as many as there is room for: of all runs of a class the first, then the second.
@group(0) @binding(9) var<storage, read_write> staged: array<u32>;
@group(0) @binding(5) var<storage, read_write> records: array<DropRecord>;
@group(0) @binding(6) var<storage, read_write> listed: array<u32>;
// Rain areas about the eye. Row 0: how many, share outside, the weather's rate. Then each as rain_core packs it.
@group(0) @binding(7) var<storage, read> areas: array<vec4<f32>>;
// ln of the threshold at a diameter of 0, and its slope, by class and rate.
@group(0) @binding(8) var<storage, read> ladder: array<vec2<f32>>;

// Whether the rain is uneven, and whether a container or a law of detail leaves drops out.
override UNEVEN: bool = true;
override THINNED: bool = true;
// Quads of one draw.
override QUADS_OF_A_DRAW: u32 = 16384u;

// Invocations of a workgroup, and runs of a group: few, for what stands before a run is summed up run by run.
const WORKGROUP: u32 = 64u;
const GROUP: u32 = 16u;
// Share over which a drop fades that a law is about to leave out, of the law's number.
const FADE: f32 = 0.1;
// Workgroups are counted in rows of this many.
const ROW: u32 = 32768u;

// Presence of a drop of class `k`. Error: 1e-3 on its soft edge; 1e-2 where the rain is uneven.
fn presence_of(k: u32, rank: f32, diameter_mm: f32, place: vec3<f32>) -> f32 {
    var limit: f32;
    if (!UNEVEN) {
        let ranks = choice.classes[k].ranks;
        limit = ranks.z * exp(ranks.w * diameter_mm);
    } else {
        let rate = packed_rate(place.xz);
        if (rate <= 0.0) {
            return 0.0;
        }
        let along = (log(rate) - choice.ladder.x) * choice.ladder.y;
        let knots = u32(choice.ladder.z);
        let knot = min(u32(max(along, 0.0)), knots - 2u);
        let line = mix(
            ladder[k * knots + knot],
            ladder[k * knots + knot + 1u],
            clamp(along - f32(knot), 0.0, 1.0),
        );
        // Below the first knot the number goes with the rate, the slope stays.
        limit = exp(line.x + min(along, 0.0) / choice.ladder.y + line.y * diameter_mm);
    }
    if (limit <= 0.0) {
        return 0.0;
    }
    return rain_soft_presence(rank, limit);
}

// How much of a drop is inside the container that follows the view.
fn region_weight(place: vec3<f32>) -> f32 {
    let kind = choice.region.w;
    if (kind < 0.5) {
        return 1.0;
    }
    let p = place - choice.region_place.xyz;
    let turn = choice.region_turn.xy;
    let slack = choice.region_place.w;
    let rim = choice.region_turn.z;
    let ahead = turn.x * p.x - turn.y * p.z;
    let across = turn.y * p.x + turn.x * p.z;
    if (-ahead - slack > 0.0) {
        return 0.0;
    }
    let high = rain_area_weight(abs(p.y) - choice.region.y + 0.5 * rim, rim);
    if (kind < 1.5) {
        let round = rain_ellipse_distance(vec2<f32>(across, max(ahead, 0.0)), choice.region.xz);
        return high * rain_area_weight(round + 0.5 * rim, rim);
    }
    return high
        * rain_area_weight(abs(across) - choice.region.x + 0.5 * rim, rim)
        * rain_area_weight(ahead + slack - choice.region.z + 0.5 * rim, rim);
}

// Presence of a drop with this mark under the law of detail, at a distance.
fn detail_weight(distance: f32, mark: f32) -> f32 {
    let d = min(distance / RAIN_RANGE_CAP_M, 1.0);
    var share = 1.0;
    switch choice.detail {
        case 1u: {
            share = 1.0 / ((1.0 + d) * (1.0 + d));
        }
        case 2u: {
            share = 1.0 - d;
        }
        case 3u: {
            share = exp(-4.5 * d * d);
        }
        default: {
            return 1.0;
        }
    }
    if (share <= 0.0) {
        return 0.0;
    }
    return clamp((share * (1.0 + 0.5 * FADE) - mark) / (share * FADE), 0.0, 1.0);
}

// What all drops are held against, read once.
struct Bounds {
    // The side planes, (normal, offset), m.
    a: vec4<f32>,
    b: vec4<f32>,
    c: vec4<f32>,
    d: vec4<f32>,
    // From the eye to the lead, m, and that over its square.
    lead: vec3<f32>,
    along: vec3<f32>,
}

fn bounds_of_view() -> Bounds {
    let planes = choice.planes;
    return Bounds(planes[0], planes[1], planes[2], planes[3], choice.lead.xyz, choice.along.xyz);
}

// Least distance of a place from the side planes, above 0 inside.
fn depth_inside(bounds: Bounds, place: vec3<f32>) -> f32 {
    return min(
        min(dot(bounds.a.xyz, place) + bounds.a.w, dot(bounds.b.xyz, place) + bounds.b.w),
        min(dot(bounds.c.xyz, place) + bounds.c.w, dot(bounds.d.xyz, place) + bounds.d.w),
    );
}

// Distance by which a cube reaches over a plane.
fn over(plane: vec4<f32>, centre: vec3<f32>, half: f32) -> f32 {
    return dot(plane.xyz, centre) + plane.w + half * dot(abs(plane.xyz), vec3<f32>(1.0));
}

// Whether anything of a cube lies inside, with room for what reaches in from a margin.
fn touches(bounds: Bounds, centre: vec3<f32>, half: f32, margin: f32) -> bool {
    let depth = min(
        min(over(bounds.a, centre, half), over(bounds.b, centre, half)),
        min(over(bounds.c, centre, half), over(bounds.d, centre, half)),
    );
    return depth >= -margin - 0.01;
}

// Square of the distance from a place to the segment from the eye to the lead.
fn from_lead_squared(bounds: Bounds, place: vec3<f32>) -> f32 {
    let off = place - bounds.lead * clamp(dot(place, bounds.along), 0.0, 1.0);
    return dot(off, off);
}

// Neighbouring cells of a row that are looked through together.
struct Run {
    k: u32,
    // Its number in its class.
    of_class: u32,
    // Its first cell, and how many there are.
    place: vec3<i32>,
    cells: u32,
}

fn run_at(index: u32) -> Run {
    var k = 0u;
    for (var i = 1u; i < 12u; i += 1u) {
        k = select(k, i, index >= choice.classes[i].runs.x);
    }
    let side = choice.classes[k].side;
    let of_class = index - choice.classes[k].runs.x;
    let of_row = (side.x + side.w - 1u) / side.w;
    let row = of_class / of_row;
    let first = (of_class - row * of_row) * side.w;
    let place = vec3<u32>(first, row % side.y, row / side.y);
    return Run(k, of_class, choice.classes[k].low.xyz + vec3<i32>(place), min(side.w, side.x - first));
}

// Lists a drop, if it is not beyond the limit. `word`: its cell in the run, then as in `DropRecord::drop`.
fn enlist(run: Run, word: u32, patterned: bool, at: vec2<u32>) {
    let drawn = at.x < choice.most;
    if (drawn) {
        let biased = vec3<u32>(run.place + 512) + vec3<u32>(word & 15u, 0u, 0u);
        records[at.x] = DropRecord(biased.x | (biased.y << 10u) | (biased.z << 20u), (word & ~15u) | run.k);
    }
    if (patterned && at.y < choice.most) {
        listed[at.y] = select(RAIN_NO_DROP, at.x, drawn);
    }
}

// Finds the drops of a run that the view draws, and how many of them may have a pattern: all or none. They are staged, or
// with `enlisting` listed from `start` on.
fn find(run: Run, enlisting: bool, start: vec2<u32>) -> vec2<u32> {
    let bounds = bounds_of_view();
    let own = choice.classes[run.k];
    let placed = view.classes[run.k];
    let edge = placed.fraction.w;
    let half = 0.5 * edge;
    let first = (vec3<f32>(run.place) - placed.fraction.xyz) * edge;
    let last = first + edge * vec3<f32>(f32(run.cells), 1.0, 1.0);
    let patterned = length(clamp(vec3<f32>(0.0), first, last)) < own.reach.w;
    let margin = own.reach.z;
    let furthest = own.reach.x * own.reach.x;
    let whole = own.reach.y * own.reach.y;
    var found = 0u;
    for (var c = 0u; c < run.cells; c += 1u) {
        let corner = first + vec3<f32>(edge * f32(c), 0.0, 0.0);
        let centre = corner + half;
        let from_eye = length(clamp(vec3<f32>(0.0), corner, corner + edge));
        let nearest = select(from_eye, sqrt(from_lead_squared(bounds, centre)) - half * sqrt(3.0), choice.along.w > 0.0);
        if (nearest > own.reach.x || !touches(bounds, centre, half, margin)) {
            continue;
        }
        let key = rain_cell_key(placed.stream.xyz, placed.cell.xyz + run.place + vec3<i32>(i32(c), 0, 0));
        var rank = 0.0;
        for (var i = 0u; i < 4096u; i += 1u) {
            let marks = rain_drop_marks(key, i);
            rank -= log(rain_open_unit(marks.x));
            if (rank >= own.ranks.x) {
                break;
            }
            let place = corner + rain_drop_place(key, i) * edge;
            let square = from_lead_squared(bounds, place);
            if (square > furthest || depth_inside(bounds, place) < -(margin + 0.01)) {
                continue;
            }
            var presence = 1.0;
            if (square > whole || rank > own.ranks.y) {
                let diameter_mm = rain_diameter_mm(placed.diameter.x, placed.diameter.y, rain_unit(marks.y));
                let range = rain_visible_range(diameter_mm, choice.focal, choice.exposure);
                let reach = RAIN_FADE_END * min(choice.kappa * range, RAIN_RANGE_CAP_M);
                presence = select(0.0, presence_of(run.k, rank, diameter_mm, place), square <= reach * reach);
            }
            if (THINNED) {
                presence *= region_weight(place) * detail_weight(length(place), rain_unit(marks.z));
            }
            if (presence <= 0.0) {
                continue;
            }
            let word = c | (i << 4u) | (u32(presence * 65535.0 + 0.5) << 16u);
            if (enlisting) {
                enlist(run, word, patterned, start + found);
            } else if (found < own.runs.z) {
                staged[own.runs.w + found * own.runs.y + run.of_class] = word;
            }
            found += 1u;
        }
    }
    return vec2<u32>(found, select(0u, found, patterned));
}

fn numbered(group: vec3<u32>, local: u32) -> u32 {
    return (group.y * ROW + group.x) * WORKGROUP + local;
}

fn count_of(index: u32) -> vec2<u32> {
    return vec2<u32>(counts[index] & 0xFFFFu, counts[index] >> 16u);
}

@compute @workgroup_size(64)
fn count(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let index = numbered(group, local);
    if (index < choice.runs) {
        let found = find(run_at(index), false, vec2<u32>(0u));
        counts[index] = found.x | (found.y << 16u);
    }
}

@compute @workgroup_size(64)
fn sum(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let g = numbered(group, local);
    if (g >= choice.groups) {
        return;
    }
    var all = vec2<u32>(0u);
    for (var index = g * GROUP; index < min((g + 1u) * GROUP, choice.runs); index += 1u) {
        all += count_of(index);
    }
    sums[g] = all;
}

var<workgroup> parts: array<vec2<u32>, 256>;

// How many drops there are before each group, and what is dispatched and drawn for all of them.
@compute @workgroup_size(256)
fn scan(@builtin(local_invocation_index) local: u32) {
    let each = (choice.groups + 255u) / 256u;
    let low = min(local * each, choice.groups);
    let high = min(low + each, choice.groups);
    var part = vec2<u32>(0u);
    for (var g = low; g < high; g += 1u) {
        part += sums[g];
    }
    parts[local] = part;
    workgroupBarrier();
    var before = vec2<u32>(0u);
    for (var i = 0u; i < local; i += 1u) {
        before += parts[i];
    }
    for (var g = low; g < high; g += 1u) {
        let own = sums[g];
        sums[g] = before;
        before += own;
    }
    if (local < 255u) {
        return;
    }
    let drops = min(before.x, choice.most);
    let near = min(before.y, choice.most);
    arguments[0] = drops;
    arguments[1] = near;
    arguments[2] = before.x;
    arguments[3] = 0u;
    arguments[4] = (drops + 63u) / 64u;
    arguments[5] = 1u;
    arguments[6] = 1u;
    arguments[7] = 0u;
    for (var i = 0u; i < 2u * choice.draws; i += 1u) {
        let of_near = i >= choice.draws;
        let first = QUADS_OF_A_DRAW * (i - select(0u, choice.draws, of_near));
        let all = select(drops, near, of_near);
        let at = 8u + 5u * i;
        arguments[at] = 6u * min(all - min(first, all), QUADS_OF_A_DRAW);
        arguments[at + 1u] = 1u;
        arguments[at + 2u] = 0u;
        arguments[at + 3u] = 4u * first;
        arguments[at + 4u] = 0u;
    }
}

@compute @workgroup_size(64)
fn list(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let index = numbered(group, local);
    if (index >= choice.runs || counts[index] == 0u) {
        return;
    }
    var start = sums[index / GROUP];
    for (var before = index - index % GROUP; before < index; before += 1u) {
        start += count_of(before);
    }
    let found = count_of(index);
    let run = run_at(index);
    let stage = choice.classes[run.k].runs;
    if (found.x > stage.z) {
        // More than are staged.
        _ = find(run, true, start);
        return;
    }
    for (var i = 0u; i < found.x; i += 1u) {
        enlist(run, staged[stage.w + i * stage.y + run.of_class], found.y > 0u, start + i);
    }
}
