// One level of the mirrored view from the level above it: 4 × 4 tent.

@group(0) @binding(0) var source: texture_2d<f32>;
@group(0) @binding(1) var level: texture_storage_2d<rgba16float, write>;

@compute @workgroup_size(8, 8)
fn reduce(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(level);
    if (any(id.xy >= size)) {
        return;
    }
    let last = vec2<i32>(textureDimensions(source)) - 1;
    let first = vec2<i32>(id.xy) * 2 - 1;
    var weights = array<f32, 4>(0.125, 0.375, 0.375, 0.125);
    var sum = vec4<f32>(0.0);
    for (var y = 0; y < 4; y++) {
        for (var x = 0; x < 4; x++) {
            let at = clamp(first + vec2<i32>(x, y), vec2<i32>(0), last);
            // A lamp's filament must not outshine half-precision.
            sum += weights[x] * weights[y] * min(textureLoad(source, at, 0), vec4<f32>(3e4));
        }
    }
    textureStore(level, vec2<i32>(id.xy), sum);
}
