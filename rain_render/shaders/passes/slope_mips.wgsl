// Four levels of a slope map from the level above them, through workgroup memory in full precision.

@group(0) @binding(0) var source: texture_2d<f32>;
@group(0) @binding(1) var level_1: texture_storage_2d<rgba16float, write>;
@group(0) @binding(2) var level_2: texture_storage_2d<rgba16float, write>;
@group(0) @binding(3) var level_3: texture_storage_2d<rgba16float, write>;
@group(0) @binding(4) var level_4: texture_storage_2d<rgba16float, write>;

var<workgroup> tile: array<array<vec4<f32>, 8>, 8>;

// The mean of four texels of the level in `tile`, which lie `1 << shift` apart.
fn reduced(local: vec2<u32>, shift: u32) -> vec4<f32> {
    let at = local << vec2<u32>(shift + 1u);
    let next = at + (1u << shift);
    return rain_slope_mip(tile[at.y][at.x], tile[at.y][next.x], tile[next.y][at.x], tile[next.y][next.x]);
}

@compute @workgroup_size(8, 8)
fn reduce(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) thread: vec3<u32>) {
    let local = thread.xy;
    let at = vec2<i32>(group.xy * 8u + local);
    let first = at * 2;
    var texel = rain_slope_mip(
        textureLoad(source, first, 0),
        textureLoad(source, first + vec2<i32>(1, 0), 0),
        textureLoad(source, first + vec2<i32>(0, 1), 0),
        textureLoad(source, first + vec2<i32>(1, 1), 0),
    );
    textureStore(level_1, at, texel);
    tile[local.y][local.x] = texel;
    for (var shift = 0u; shift < 3u; shift++) {
        workgroupBarrier();
        let side = 4u >> shift;
        let inside = all(local < vec2<u32>(side));
        if (inside) {
            texel = reduced(local, shift);
            let to = vec2<i32>(group.xy * side + local);
            if (shift == 0u) {
                textureStore(level_2, to, texel);
            } else if (shift == 1u) {
                textureStore(level_3, to, texel);
            } else {
                textureStore(level_4, to, texel);
            }
        }
        workgroupBarrier();
        if (inside) {
            let place = local << vec2<u32>(shift + 1u);
            tile[place.y][place.x] = texel;
        }
    }
}
