// Procedural rings: four layers of one circle texture into the slope map that the material reads.

@group(0) @binding(0) var<uniform> params: RingLayerParams;
@group(0) @binding(1) var<storage, read> circles: array<vec2<u32>>;
@group(0) @binding(2) var map: texture_storage_2d<rgba16float, write>;

// The finest level of the slope map; see slopes.wgsl. Rings have no height.
@compute @workgroup_size(8, 8)
fn compose(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= vec2<u32>(params.cells))) {
        return;
    }
    let below = rain_ring_texel(params, id.xy);
    var sum = vec2<f32>(0.0);
    for (var layer = 0u; layer < 4u; layer++) {
        if (params.weights[layer] <= 0.0) {
            continue;
        }
        let moved = vec2<u32>(params.offset_x[layer], params.offset_z[layer]);
        let at = (below + moved) & vec2<u32>(params.texels - 1u);
        let point = rain_circle_point(circles[at.y * params.texels + at.x]);
        if (point.nearness > 0.0) {
            sum += rain_ring_layer(params, point, layer) * point.outward;
        }
    }
    textureStore(map, vec2<i32>(id.xy), vec4<f32>(-params.steepness * sum, params.hidden_variance, 0.0));
}
