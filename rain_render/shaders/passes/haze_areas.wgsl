// Extinction of the rain's areas along the ground, as a grid of azimuths and distances: its integral from the eye on, and after
// it that of what may be drawn as far rain.

@group(0) @binding(0) var<uniform> view: HazeView;
// A row of numbers (areas, share outside, the weather's rate), then the areas as rain_core packs them about the eye.
@group(0) @binding(1) var<storage, read> areas: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read_write> grid: array<f32>;

// Where the far rain's part of the grid begins.
const FAR_GRID: u32 = RAIN_HAZE_AZIMUTHS * (RAIN_HAZE_INTERVALS + 1u);

// Rate at a place (x, z), mm/h, and how far around it that does not change, m.
fn rate_about(place: vec2<f32>) -> vec2<f32> {
    let head = areas[0];
    var found = vec2<f32>(head.y * head.z, 1.0);
    var even = 1e30;
    var row = 1u;
    for (var i = 0u; i < u32(head.x); i += 1u) {
        let area = packed_area(row, place);
        // What is painted changes from place to place inside.
        even = min(even, select(abs(area.distance), area.distance, area.painted) - 0.5 * area.transition);
        found = rain_area_joined(found, area.rain, rain_area_weight(area.distance, area.transition) * area.density, head.z);
        row = area.next;
    }
    return vec2<f32>(clamp(found.x * found.y, 0.0, 500.0), even);
}

fn extinction_of(rate: f32) -> f32 {
    if (rate <= 0.0) {
        return 0.0;
    }
    let place = max(log(rate / RAIN_FIRST_RATE_MM_H) * view.grid.w, 0.0);
    let index = min(u32(place), RAIN_RATE_KNOTS - 2u);
    let a = view.rates[index / 4u][index % 4u];
    let b = view.rates[(index + 1u) / 4u][(index + 1u) % 4u];
    return exp(mix(a, b, place - f32(index))) * min(rate / RAIN_FIRST_RATE_MM_H, 1.0);
}

const PIECES: u32 = 16u;

// The integral over one interval of one azimuth: at once where the rain is even, else in 16 pieces.
@compute @workgroup_size(64)
fn spread(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= RAIN_HAZE_INTERVALS || id.y >= RAIN_HAZE_AZIMUTHS) {
        return;
    }
    let azimuth = view.grid.x + f32(id.y) * view.grid.y;
    let direction = vec2<f32>(cos(azimuth), sin(azimuth));
    let low = rain_haze_knot(f32(id.x), view.grid.z);
    let high = rain_haze_knot(f32(id.x) + 1.0, view.grid.z);
    let length = high - low;
    let middle = rate_about(direction * (0.5 * (low + high)));
    var mean = extinction_of(middle.x);
    var excess = max(mean - view.far.y, 0.0);
    if (middle.y < 0.5 * length) {
        mean = 0.0;
        excess = 0.0;
        for (var i = 0u; i < PIECES; i += 1u) {
            let at = low + length * (f32(i) + 0.5) / f32(PIECES);
            let own = extinction_of(rate_about(direction * at).x);
            mean += own / f32(PIECES);
            excess += max(own - view.far.y, 0.0) / f32(PIECES);
        }
    }
    let place = id.y * (RAIN_HAZE_INTERVALS + 1u) + id.x + 1u;
    grid[place] = mean * length;
    grid[FAR_GRID + place] = excess * length * rain_far_begin(0.5 * (low + high));
}

// Sums up along each azimuth.
@compute @workgroup_size(64)
fn add(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= RAIN_HAZE_AZIMUTHS) {
        return;
    }
    let first = id.x * (RAIN_HAZE_INTERVALS + 1u);
    var sum = 0.0;
    var far = 0.0;
    grid[first] = 0.0;
    grid[FAR_GRID + first] = 0.0;
    for (var i = 1u; i <= RAIN_HAZE_INTERVALS; i += 1u) {
        let own = grid[first + i];
        // Far rain is where it is seen: the mean of what gets through to the interval.
        far += grid[FAR_GRID + first + i] * exp(-sum) * rain_haze_share(own) / max(own, 1e-20);
        sum += own;
        grid[first + i] = sum;
        grid[FAR_GRID + first + i] = far;
    }
}
