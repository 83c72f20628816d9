// Streak textures: streaks are added to a layer, and its levels are made and packed.

@group(0) @binding(0) var<uniform> tile: StreakTile;
@group(0) @binding(1) var<uniform> level: StreakLevel;
@group(0) @binding(2) var<storage, read> drops: array<TileDrop>;
// Sum of -ln(1 - opacity) in whole steps: the order of streaks does not matter.
@group(0) @binding(3) var<storage, read_write> overlap: array<atomic<u32>>;
// Opacity over unit, level after level.
@group(0) @binding(4) var<storage, read_write> levels: array<f32>;
// Two half floats a word, rows as a texture takes them.
@group(0) @binding(5) var<storage, read_write> packed: array<u32>;

// One workgroup a drop: its texels in turn.
@compute @workgroup_size(64)
fn add(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = group.x + group.y * 32768u;
    if (index >= tile.drops) {
        return;
    }
    let drop = drops[tile.first + index];
    let radius = 0.5 * drop.diameter;
    let low = vec2<i32>(floor(vec2<f32>(drop.x, drop.y) - radius));
    let high = vec2<i32>(floor(vec2<f32>(drop.x + radius, drop.y + tile.path + radius)));
    let size = vec2<u32>(high - low + 1);
    let side = i32(tile.texels);
    for (var i = lane; i < size.x * size.y; i += 64u) {
        let at = low + vec2<i32>(i32(i % size.x), i32(i / size.x));
        let corner = vec2<f32>(at) - vec2<f32>(drop.x, drop.y);
        let opacity = rain_texel_opacity(corner, drop.diameter, drop.share, tile.path);
        let steps = u32(rain_depth_of(opacity) / tile.unit * tile.steps + 0.5);
        // Sides are powers of two: the remainder of a negative number too.
        let wrapped = vec2<u32>(at & vec2<i32>(side - 1));
        atomicAdd(&overlap[wrapped.y * tile.texels + wrapped.x], steps);
    }
}

@compute @workgroup_size(64)
fn resolve(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let i = (group.x + group.y * 32768u) * 64u + lane;
    if (i >= level.side * level.side) {
        return;
    }
    let depth = f32(atomicLoad(&overlap[i])) / tile.steps * tile.unit;
    levels[level.first + i] = rain_obscured(depth) / tile.unit;
}

@compute @workgroup_size(64)
fn halve(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let i = (group.x + group.y * 32768u) * 64u + lane;
    if (i >= level.side * level.side) {
        return;
    }
    let wide = 2u * level.side;
    let at = level.above + 2u * (i / level.side) * wide + 2u * (i % level.side);
    levels[level.first + i] = 0.25 * (levels[at] + levels[at + 1u] + levels[at + wide] + levels[at + wide + 1u]);
}

@compute @workgroup_size(64)
fn pack(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let words = max(level.side / 2u, 1u);
    let i = (group.x + group.y * 32768u) * 64u + lane;
    if (i >= words * level.side) {
        return;
    }
    let row = i / words;
    let word = i % words;
    let at = level.first + row * level.side + 2u * word;
    let right = select(0.0, levels[at + 1u], level.side > 1u);
    packed[level.words + row * level.row + word] = rain_half(levels[at]) | (rain_half(right) << 16u);
}
