// Lightning: its channel, and the glow of the cloud that it is in.

#import bevy_pbr::{
    forward_io::VertexOutput,
    mesh_view_bindings::view,
}

struct Lightning {
    light: vec4<f32>,
    glow: vec4<f32>,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<uniform> lightning: Lightning;

// A half-precision target holds no more.
const BRIGHTEST: f32 = 60000.0;

fn hash(p: vec2<f32>) -> f32 {
    let q = vec2<u32>(bitcast<u32>(i32(p.x)), bitcast<u32>(i32(p.y)));
    var h = q.x * 0x9E3779B9u ^ (q.y * 0x85EBCA6Bu + 0x68BC21EBu);
    h = (h ^ (h >> 15u)) * 0x2C1B3C6Du;
    h = (h ^ (h >> 12u)) * 0x297A2D39u;
    return f32((h ^ (h >> 15u)) >> 8u) / 16777216.0;
}

fn noise(p: vec2<f32>) -> f32 {
    let cell = floor(p);
    let t = p - cell;
    let s = t * t * (3.0 - 2.0 * t);
    let low = mix(hash(cell), hash(cell + vec2(1.0, 0.0)), s.x);
    let high = mix(hash(cell + vec2(0.0, 1.0)), hash(cell + vec2(1.0, 1.0)), s.x);
    return mix(low, high, s.y);
}

// How much of the glow comes through the cloud: billows of some hundred metres, of mean 1.
fn billows(p: vec2<f32>) -> f32 {
    let sum = 0.55 * noise(p) + 0.3 * noise(2.1 * p + 17.0) + 0.15 * noise(4.3 * p + 5.0);
    return 0.3 + 1.4 * smoothstep(0.2, 0.8, sum);
}

@fragment
fn fragment(in: VertexOutput) -> @location(0) vec4<f32> {
    var share = 1.0;
    var hides = 1.0;
#ifdef VERTEX_UVS_A
    if (lightning.glow.x > 0.5) {
        let off = dot(in.uv, in.uv);
        // To nothing at the square's edge.
        share = exp(-0.5 * off) * smoothstep(12.25, 9.0, off);
        share *= billows(in.world_position.xz / 700.0 + lightning.glow.y);
        hides = 0.0;
    }
#endif
    let way = distance(in.world_position.xyz, view.world_position);
    let seen = lightning.light.rgb * (share * exp(-min(lightning.light.w * way, 80.0)) * view.exposure);
    return vec4<f32>(min(seen, vec3<f32>(BRIGHTEST)), hides);
}
