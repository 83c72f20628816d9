// Mirrored rays of a slope map, thrown onto its own tile at four ways from the water.

@group(0) @binding(0) var<uniform> params: CausticParams;
@group(0) @binding(1) var slopes: texture_2d<f32>;
@group(0) @binding(2) var tiling: sampler;
// Light in 1/256 of a ray, four ways a texel.
@group(0) @binding(3) var<storage, read_write> thrown: array<atomic<u32>>;
@group(0) @binding(4) var map: texture_storage_2d<rgba16float, write>;

fn slot(texel: vec2<i32>, way: u32) -> u32 {
    let wrapped = vec2<u32>(texel & vec2<i32>(i32(RAIN_CAUSTIC_TEXELS) - 1));
    return 4u * (wrapped.y * RAIN_CAUSTIC_TEXELS + wrapped.x) + way;
}

@compute @workgroup_size(8, 8)
fn send(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= vec2<u32>(RAIN_CAUSTIC_RAYS))) {
        return;
    }
    let at = (vec2<f32>(id.xy) + 0.5) / f32(RAIN_CAUSTIC_RAYS);
    let slope = params.strength * textureSampleLevel(slopes, tiling, at, 0.0).xy;
    let shift = rain_caustic_shift(params.towards.xyz, slope) * params.per_side;
    for (var way = 0u; way < 4u; way++) {
        let place = (at + shift * RAIN_CAUSTIC_FIRST_M * f32(1u << way)) * f32(RAIN_CAUSTIC_TEXELS) - 0.5;
        let corner = floor(place);
        let part = place - corner;
        let texel = vec2<i32>(corner);
        let near = (1.0 - part.x) * (1.0 - part.y);
        let right = part.x * (1.0 - part.y);
        let below = (1.0 - part.x) * part.y;
        let weights = vec3<u32>(256.0 * vec3<f32>(right, below, part.x * part.y) + 0.5);
        atomicAdd(&thrown[slot(texel, way)], 256u - min(weights.x + weights.y + weights.z, 256u));
        atomicAdd(&thrown[slot(texel + vec2<i32>(1, 0), way)], weights.x);
        atomicAdd(&thrown[slot(texel + vec2<i32>(0, 1), way)], weights.y);
        atomicAdd(&thrown[slot(texel + vec2<i32>(1, 1), way)], weights.z);
    }
}

@compute @workgroup_size(8, 8)
fn gather(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= vec2<u32>(RAIN_CAUSTIC_TEXELS))) {
        return;
    }
    let texel = vec2<i32>(id.xy);
    var light = vec4<f32>(0.0);
    for (var way = 0u; way < 4u; way++) {
        // The sun's disc.
        let radius = params.blur * RAIN_CAUSTIC_FIRST_M * f32(1u << way);
        let reach = i32(min(radius + 0.5, 8.0));
        var sum = 0.0;
        var whole = 0.0;
        for (var z = -reach; z <= reach; z++) {
            for (var x = -reach; x <= reach; x++) {
                let weight = clamp(radius + 0.5 - length(vec2<f32>(f32(x), f32(z))), 0.0, 1.0);
                whole += weight;
                if (weight > 0.0) {
                    sum += weight * f32(atomicLoad(&thrown[slot(texel + vec2<i32>(x, z), way)]));
                }
            }
        }
        light[way] = sum / whole;
    }
    let ray = 256.0 * f32(RAIN_CAUSTIC_RAYS * RAIN_CAUSTIC_RAYS) / f32(RAIN_CAUSTIC_TEXELS * RAIN_CAUSTIC_TEXELS);
    textureStore(map, texel, light / ray);
}
