// Which drops a view draws singly: runs of cells about it that reach into the view are noted, their drops counted, then listed
// in the order of the cells, so that the list is the same each time.

@group(0) @binding(0) var<uniform> view: RainfallView;
@group(0) @binding(1) var<uniform> choice: RainfallChoice;
// Drops of each run of cells in the lower half of a word; above: MAY_HAVE_PATTERN, NOT_STAGED.
@group(0) @binding(2) var<storage, read_write> counts: array<u32>;
// Those of each group of runs, and how many of them may have a pattern; then those of all groups before.
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
// Runs that reach into the view, from word 4 on, in any order. Before: how many, and what is dispatched for them.
@group(0) @binding(10) var<storage, read_write> noting: array<atomic<u32>>;
@group(0) @binding(11) var<storage, read> noted: array<u32>;

// Whether the rain is uneven, whether a container or a law of detail leaves drops out, and whether near drops have patterns.
override UNEVEN: bool = true;
override THINNED: bool = true;
override PATTERNED: bool = true;
// Quads of one draw.
override QUADS_OF_A_DRAW: u32 = 16384u;

// Invocations of a workgroup, and runs of a group: few, for what stands before a run is summed up run by run.
const WORKGROUP: u32 = 64u;
const GROUP: u32 = 16u;
// Share over which a drop fades that a law is about to leave out, of the law's number.
const FADE: f32 = 0.1;
// Any drop of the run may have a pattern.
const MAY_HAVE_PATTERN: u32 = 0x10000u;
// There are more drops than there is room for on the stage. The same of a group of runs.
const NOT_STAGED: u32 = 0x20000u;
const GROUP_NOT_STAGED: u32 = 0x80000000u;
// Where the list of noted runs begins.
const NOTED: u32 = 4u;
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

// What the drops of a class are held against, read once.
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

fn bounds_of(out: vec4<f32>) -> Bounds {
    return Bounds(
        vec4<f32>(choice.planes[0].xyz, out.x),
        vec4<f32>(choice.planes[1].xyz, out.y),
        vec4<f32>(choice.planes[2].xyz, out.z),
        vec4<f32>(choice.planes[3].xyz, out.w),
        choice.lead.xyz,
        choice.along.xyz,
    );
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

// Whether anything of a cube lies inside.
fn touches(bounds: Bounds, centre: vec3<f32>, half: f32) -> bool {
    let depth = min(
        min(over(bounds.a, centre, half), over(bounds.b, centre, half)),
        min(over(bounds.c, centre, half), over(bounds.d, centre, half)),
    );
    return depth >= 0.0;
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

// Whether anything of a cube with this corner reaches into the view; `reach`: how far from the lead.
fn shows(bounds: Bounds, corner: vec3<f32>, edge: f32, reach: f32) -> bool {
    let half = 0.5 * edge;
    let centre = corner + half;
    let from_eye = length(clamp(vec3<f32>(0.0), corner, corner + edge));
    let nearest = select(from_eye, sqrt(from_lead_squared(bounds, centre)) - half * sqrt(3.0), choice.along.w > 0.0);
    return nearest <= reach && touches(bounds, centre, half);
}

// Lists a drop, if it is not beyond the limit. `word`: its cell in the run, then as in `DropRecord::drop`.
fn enlist(run: Run, word: u32, patterned: bool, at: vec2<u32>) {
    let drawn = at.x < choice.most;
    if (drawn) {
        let biased = vec3<u32>(run.place + 512) + vec3<u32>(word & 15u, 0u, 0u);
        records[at.x] = DropRecord(biased.x | (biased.y << 10u) | (biased.z << 20u), (word & ~15u) | run.k);
    }
    if (PATTERNED && patterned && at.y < choice.most) {
        listed[at.y] = select(RAIN_NO_DROP, at.x, drawn);
    }
}

// Finds the drops of a run that the view draws, as a word of `counts`. They are staged, or with `enlisting` listed from
// `start` on.
fn find(run: Run, enlisting: bool, start: vec2<u32>) -> u32 {
    let own = choice.classes[run.k];
    let bounds = bounds_of(own.out);
    let placed = view.classes[run.k];
    let edge = placed.fraction.w;
    let first = (vec3<f32>(run.place) - placed.fraction.xyz) * edge;
    let last = first + edge * vec3<f32>(f32(run.cells), 1.0, 1.0);
    let patterned = PATTERNED && length(clamp(vec3<f32>(0.0), first, last)) < own.reach.z;
    let furthest = own.reach.x * own.reach.x;
    let whole = own.reach.y * own.reach.y;
    var found = 0u;
    for (var c = 0u; c < run.cells; c += 1u) {
        let corner = first + vec3<f32>(edge * f32(c), 0.0, 0.0);
        if (run.cells > 1u && !shows(bounds, corner, edge, own.reach.x)) {
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
            if (square > furthest || depth_inside(bounds, place) < 0.0) {
                continue;
            }
            var presence = 1.0;
            if (square > whole || rank > own.ranks.y) {
                let diameter_mm = rain_diameter_mm(placed.diameter.x, placed.diameter.y, rain_unit(marks.y));
                let reach = RAIN_FADE_END
                    * rain_drawn(choice.kappa, diameter_mm, choice.focal, choice.exposure, choice.parallel != 0u);
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
    let more = select(0u, NOT_STAGED, found > own.runs.z);
    return select(0u, found | select(0u, MAY_HAVE_PATTERN, patterned) | more, found > 0u);
}

fn numbered(group: vec3<u32>, local: u32) -> u32 {
    return (group.y * ROW + group.x) * WORKGROUP + local;
}

// Drops of a run, and how many of them may have a pattern: all or none.
fn count_of(word: u32) -> vec2<u32> {
    let drops = word & 0xFFFFu;
    return vec2<u32>(drops, select(0u, drops, (word & MAY_HAVE_PATTERN) != 0u));
}

@compute @workgroup_size(1)
fn begin() {
    atomicStore(&noting[0], 0u);
    atomicStore(&noting[1], 0u);
    atomicStore(&noting[2], 1u);
    atomicStore(&noting[3], 1u);
}

// Six out of ten runs have no cell in the view: counting goes through the others only. One invocation a row of cells.
@compute @workgroup_size(64)
fn note(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let row = numbered(group, local);
    if (row >= choice.rows) {
        return;
    }
    var k = 0u;
    for (var i = 1u; i < 12u; i += 1u) {
        k = select(k, i, row >= u32(choice.classes[i].low.w));
    }
    let own = choice.classes[k];
    let bounds = bounds_of(own.out);
    let placed = view.classes[k];
    let edge = placed.fraction.w;
    let of_class = row - u32(own.low.w);
    let place = own.low.xyz + vec3<i32>(0, i32(of_class % own.side.y), i32(of_class / own.side.y));
    let first = (vec3<f32>(place) - placed.fraction.xyz) * edge;
    let runs = (own.side.x + own.side.w - 1u) / own.side.w;
    let index = own.runs.x + of_class * runs;
    for (var run = 0u; run < runs; run += 1u) {
        var any = false;
        for (var c = run * own.side.w; c < min((run + 1u) * own.side.w, own.side.x); c += 1u) {
            any = any || shows(bounds, first + vec3<f32>(edge * f32(c), 0.0, 0.0), edge, own.reach.x);
        }
        if (any) {
            let slot = atomicAdd(&noting[0], 1u);
            atomicMax(&noting[1], slot / WORKGROUP + 1u);
            atomicStore(&noting[NOTED + slot], index + run);
        } else {
            counts[index + run] = 0u;
        }
    }
}

@compute @workgroup_size(64)
fn count(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x < noted[0]) {
        let index = noted[NOTED + id.x];
        counts[index] = find(run_at(index), false, vec2<u32>(0u));
    }
}

@compute @workgroup_size(64)
fn sum(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let g = numbered(group, local);
    if (g >= choice.groups) {
        return;
    }
    var all = vec2<u32>(0u);
    var words = 0u;
    for (var index = g * GROUP; index < min((g + 1u) * GROUP, choice.runs); index += 1u) {
        all += count_of(counts[index]);
        words |= counts[index];
    }
    sums[g] = vec2<u32>(all.x, all.y | select(0u, GROUP_NOT_STAGED, (words & NOT_STAGED) != 0u));
}

var<workgroup> parts: array<vec2<u32>, WORKGROUP>;
var<workgroup> not_staged: atomic<u32>;

// How many drops there are before each group, and what is dispatched and drawn for all of them.
@compute @workgroup_size(64)
fn scan(@builtin(local_invocation_index) local: u32) {
    let each = (choice.groups + WORKGROUP - 1u) / WORKGROUP;
    let low = min(local * each, choice.groups);
    let high = min(low + each, choice.groups);
    var part = vec2<u32>(0u);
    var words = 0u;
    for (var g = low; g < high; g += 1u) {
        part += vec2<u32>(sums[g].x, sums[g].y & ~GROUP_NOT_STAGED);
        words |= sums[g].y;
    }
    parts[local] = part;
    atomicOr(&not_staged, words & GROUP_NOT_STAGED);
    workgroupBarrier();
    var before = vec2<u32>(0u);
    for (var i = 0u; i < local; i += 1u) {
        before += parts[i];
    }
    for (var g = low; g < high; g += 1u) {
        let own = vec2<u32>(sums[g].x, sums[g].y & ~GROUP_NOT_STAGED);
        sums[g] = before;
        before += own;
    }
    if (local < WORKGROUP - 1u) {
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
    let again = select(0u, (choice.runs + WORKGROUP - 1u) / WORKGROUP, atomicLoad(&not_staged) != 0u);
    arguments[8] = min(again, ROW);
    arguments[9] = (again + ROW - 1u) / ROW;
    arguments[10] = 1u;
    arguments[11] = 0u;
    for (var i = 0u; i < 2u * choice.draws; i += 1u) {
        let of_near = i >= choice.draws;
        let first = QUADS_OF_A_DRAW * (i - select(0u, choice.draws, of_near));
        let all = select(drops, near, of_near);
        let at = 12u + 5u * i;
        arguments[at] = 6u * min(all - min(first, all), QUADS_OF_A_DRAW);
        arguments[at + 1u] = 1u;
        arguments[at + 2u] = 0u;
        arguments[at + 3u] = 4u * first;
        arguments[at + 4u] = 0u;
    }
}

// Where the drops of a run begin in the list.
fn start_of(index: u32) -> vec2<u32> {
    var start = sums[index / GROUP];
    for (var before = index - index % GROUP; before < index; before += 1u) {
        start += count_of(counts[before]);
    }
    return start;
}

@compute @workgroup_size(64)
fn list(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= noted[0]) {
        return;
    }
    let index = noted[NOTED + id.x];
    if (counts[index] == 0u || (counts[index] & NOT_STAGED) != 0u) {
        return;
    }
    let start = start_of(index);
    let found = count_of(counts[index]);
    let run = run_at(index);
    let stage = choice.classes[run.k].runs;
    for (var i = 0u; i < found.x; i += 1u) {
        enlist(run, staged[stage.w + i * stage.y + run.of_class], found.y > 0u, start + i);
    }
}

// Looks through the runs again that have more drops than were staged.
@compute @workgroup_size(64)
fn list_again(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let index = numbered(group, local);
    if (index < choice.runs && (counts[index] & NOT_STAGED) != 0u) {
        _ = find(run_at(index), true, start_of(index));
    }
}
