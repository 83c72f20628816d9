// Water on a square tile: sources, steps, and the slope map that the material reads.

@group(0) @binding(0) var<uniform> params: WaveParams;
// The level of heights that is shown and the one before, which a step overwrites. Units: m.
@group(0) @binding(1) var<storage, read_write> now: array<f32>;
@group(0) @binding(2) var<storage, read_write> before: array<f32>;
// Depth over that of the fastest wave; 0 is dry.
@group(0) @binding(3) var<storage, read> depth: array<f32>;
@group(0) @binding(4) var<storage, read> sources: array<WaveSource>;
@group(0) @binding(5) var<storage, read> bins: array<WaveBin>;
@group(0) @binding(6) var<storage, read> entries: array<u32>;
// Of each source: Σ weight, Σ depth · Laplacian, number of cells.
@group(0) @binding(7) var<storage, read_write> sums: array<vec4<f32>>;

@group(1) @binding(0) var map: texture_storage_2d<rgba16float, write>;

// Below this share of its weight, what a force moves in sum is taken back evenly.
const SMALL_BALANCE: f32 = 1e-3;

// Where a cell is stored.
fn stored(cell: vec2<u32>) -> u32 {
    let at = (cell + params.offset) & vec2<u32>(params.cells - 1u);
    return at.y * params.cells + at.x;
}

fn inside(cell: vec2<u32>) -> bool {
    return all(cell < vec2<u32>(params.cells));
}

// Stills cells that are new to the tile, and dry ones.
@compute @workgroup_size(8, 8)
fn settle(@builtin(global_invocation_id) id: vec3<u32>) {
    if (!inside(id.xy)) {
        return;
    }
    let at = stored(id.xy);
    let was = vec2<i32>(id.xy) + params.moved;
    let side = vec2<i32>(i32(params.cells));
    if (any(was < vec2<i32>(0)) || any(was >= side) || !(depth[at] > 0.0)) {
        now[at] = 0.0;
        before[at] = 0.0;
    }
}

// Weight and Laplacian of a source in the k-th column and l-th row of its box.
fn shape(source: WaveSource, k: vec2<u32>) -> vec2<f32> {
    let place = (vec2<f32>(k) + 0.5 - source.start) * source.per_width;
    let along = dot(place, source.along);
    let across = place.x * source.along.y - place.y * source.along.x;
    return rain_swept(along - 0.5 * source.length, across, source.length);
}

var<workgroup> parts: array<vec3<f32>, 64>;

// Sums of a source over the water that it reaches; one workgroup each.
@compute @workgroup_size(64)
fn gather(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) thread: u32) {
    let index = params.first_source + group.x;
    let source = sources[index];
    var part = vec3<f32>(0.0);
    for (var n = thread; n < source.count.x * source.count.y; n += 64u) {
        let k = vec2<u32>(n % source.count.x, n / source.count.x);
        let relative = depth[stored(vec2<u32>(source.low) + k)];
        if (relative > 0.0) {
            let weight = shape(source, k);
            part += vec3<f32>(weight.x, relative * weight.y, 1.0);
        }
    }
    parts[thread] = part;
    for (var half = 32u; half > 0u; half >>= 1u) {
        workgroupBarrier();
        if (thread < half) {
            parts[thread] += parts[thread + half];
        }
    }
    if (thread == 0u) {
        sums[index] = vec4<f32>(parts[0], 0.0);
    }
}

// Adds the sources that reach a bin, in their order.
@compute @workgroup_size(8, 8)
fn add(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) thread: vec3<u32>) {
    let bin = bins[params.first_bin + group.x];
    let cell = 8u * vec2<u32>(bin.place & 0xffffu, bin.place >> 16u) + thread.xy;
    let at = stored(cell);
    let relative = depth[at];
    if (!(relative > 0.0)) {
        return;
    }
    var raised = 0.0;
    var back = 0.0;
    for (var n = 0u; n < bin.count; n++) {
        let index = entries[bin.first + n];
        let source = sources[index];
        let k = (cell - vec2<u32>(source.low)) & vec2<u32>(params.cells - 1u);
        if (any(k >= source.count)) {
            continue;
        }
        let weight = shape(source, k);
        raised += source.height * weight.x;
        var force = relative * weight.y;
        let sum = sums[index];
        // A force moves no water in sum: what it would is taken back, evenly or where much of it, after the weight.
        if (sum.x > 0.0) {
            let balance = sum.y / sum.x;
            force -= select(balance * weight.x, sum.y / sum.z, abs(balance) < SMALL_BALANCE);
        }
        back += source.back * force;
    }
    now[at] += raised;
    before[at] += params.inverse_keep * (raised + back);
}

// One step: the next level over the one before.
@compute @workgroup_size(8, 8)
fn step_levels(@builtin(global_invocation_id) id: vec3<u32>) {
    let cell = id.xy;
    if (!inside(cell)) {
        return;
    }
    let at = stored(cell);
    let here = depth[at];
    if (!(here > 0.0)) {
        return;
    }
    let west = stored(cell - vec2<u32>(1u, 0u));
    let east = stored(cell + vec2<u32>(1u, 0u));
    let north = stored(cell - vec2<u32>(0u, 1u));
    let south = stored(cell + vec2<u32>(0u, 1u));
    var faces = vec4<f32>(
        rain_wave_face(here, depth[west]),
        rain_wave_face(here, depth[east]),
        rain_wave_face(here, depth[north]),
        rain_wave_face(here, depth[south]),
    );
    let last = params.cells - 1u;
    if (params.periodic == 0u) {
        faces = select(faces, vec4<f32>(0.0), vec4<bool>(cell.x == 0u, cell.x == last, cell.y == 0u, cell.y == last));
    }
    let u = now[at];
    let along = faces.y * (now[east] - u) - faces.x * (u - now[west]);
    let across = faces.w * (now[south] - u) - faces.z * (u - now[north]);
    var g = params.g;
    if (params.rim > 0.0) {
        let distance = vec2<f32>(min(cell, vec2<u32>(last) - cell)) + 0.5;
        g *= rain_wave_rim(distance.x, params.rim, params.rim_damping)
            * rain_wave_rim(distance.y, params.rim, params.rim_damping);
    }
    before[at] = rain_wave_next(u, before[at], along + across, g, params.courant_squared, params.keep);
}

// Height as it is shown, and whether there is water (1) in a cell next to `cell`.
fn shown(cell: vec2<i32>) -> vec2<f32> {
    let beyond = any(cell < vec2<i32>(0)) || any(cell >= vec2<i32>(i32(params.cells)));
    if (beyond && params.periodic == 0u) {
        return vec2<f32>(0.0);
    }
    let at = stored(vec2<u32>(cell));
    let last = before[at];
    return vec2<f32>(last + (now[at] - last) * params.blend, select(0.0, 1.0, depth[at] > 0.0));
}

// Difference over a cell: of fourth order, where there is less water of second, one-sided at shores and edges.
fn difference(cell: vec2<i32>, here: f32, way: vec2<i32>) -> f32 {
    let low = shown(cell - way);
    let high = shown(cell + way);
    if (low.y + high.y < 2.0) {
        return select(0.0, high.x - here, high.y > 0.0) + select(0.0, here - low.x, low.y > 0.0);
    }
    let lower = shown(cell - 2 * way);
    let higher = shown(cell + 2 * way);
    if (lower.y + higher.y < 2.0) {
        return 0.5 * (high.x - low.x);
    }
    return (8.0 * (high.x - low.x) - (higher.x - lower.x)) * (1.0 / 12.0);
}

// The finest level of the slope map; see slopes.wgsl.
@compute @workgroup_size(8, 8)
fn slopes(@builtin(global_invocation_id) id: vec3<u32>) {
    if (!inside(id.xy)) {
        return;
    }
    let cell = vec2<i32>(id.xy);
    let here = shown(cell);
    if (here.y == 0.0) {
        textureStore(map, cell, vec4<f32>(0.0));
        return;
    }
    let slope = vec2<f32>(difference(cell, here.x, vec2<i32>(1, 0)), difference(cell, here.x, vec2<i32>(0, 1)));
    var fade = 1.0;
    if (params.rim > 0.0) {
        let edge = min(id.xy, vec2<u32>(params.cells - 1u) - id.xy);
        let near = smoothstep(vec2<f32>(0.0), vec2<f32>(params.rim), vec2<f32>(edge));
        fade = near.x * near.y;
    }
    textureStore(map, cell, vec4<f32>(fade * params.per_cell * slope, params.hidden_variance, fade * 1e3 * here.x));
}
