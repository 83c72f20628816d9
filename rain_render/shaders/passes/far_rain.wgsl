// Far rain over a finished scene: particles that face the eye, six vertices each, premultiplied.

@group(0) @binding(0) var<uniform> view: FarRainParams;
@group(0) @binding(1) var<storage, read> particles: array<FarParticle>;
@group(0) @binding(2) var environment: texture_cube<f32>;
@group(0) @binding(3) var environment_sampler: sampler;

struct FarVertex {
    @builtin(position) position: vec4<f32>,
    @location(0) point: vec3<f32>,
    // Across and along, -1 to 1.
    @location(1) place: vec2<f32>,
    @location(2) @interpolate(flat) light: vec3<f32>,
    // Opacity in the middle; where its stripes lie.
    @location(3) @interpolate(flat) shape: vec2<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) vertex_index: u32) -> FarVertex {
    let particle = particles[vertex_index / 6u];
    let corner = rain_quad_corner(vertex_index);
    let axis = view.axis.xyz;
    let right = normalize(cross(particle.centre, axis));
    let point = particle.centre + particle.half_width * (right * corner.x + axis * (corner.y * RAIN_FAR_HEIGHT));
    var out: FarVertex;
    out.position = view.clip_from_eye * vec4<f32>(point, 1.0);
    out.point = point;
    out.place = corner;
    // What a drop keeps by inner reflections leaves it all the same, as in the haze that it stands in.
    out.light = rain_drop_shine(
        environment,
        environment_sampler,
        view.environment,
        view.ambient,
        view.sun_direction.xyz,
        view.sun.rgb,
        normalize(particle.centre),
    ) * rain_far_shade(particle.phase) / (RAIN_DROP_TRANSMITTED + RAIN_DROP_REFLECTED);
    out.shape = vec2<f32>(RAIN_FAR_OPACITY * particle.presence, particle.phase);
    return out;
}

fn opacity(in: FarVertex) -> f32 {
    let towards = normalize(in.point);
    // A line that runs along the rain is in it for longer.
    let sine = max(length(cross(towards, view.axis.xyz)), 0.3);
    let under = rain_cloud_share(in.point.y, view.cloud, view.thin);
    let whole = in.shape.x * under * rain_far_pitch_weight(towards.y) / sine;
    return clamp(whole * rain_far_profile(in.place, in.shape.y), 0.0, 0.99);
}

@fragment
fn colour(in: FarVertex) -> @location(0) vec4<f32> {
    let taken = opacity(in);
    return vec4<f32>(in.light * taken, taken);
}

@fragment
fn coverage(in: FarVertex) -> @location(0) vec4<f32> {
    let taken = opacity(in);
    return vec4<f32>(taken, 0.0, 0.0, taken);
}
