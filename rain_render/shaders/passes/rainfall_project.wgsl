// One invocation a drop: place, cover, projection, opacity and light.

@group(0) @binding(0) var<uniform> view: RainfallView;
@group(0) @binding(1) var<storage, read> records: array<DropRecord>;
@group(0) @binding(2) var<storage, read_write> streaks: array<Streak>;
@group(0) @binding(3) var cover_map: texture_depth_2d;
@group(0) @binding(4) var environment: texture_cube<f32>;
@group(0) @binding(5) var environment_sampler: sampler;
// The first word: how many drops there are.
@group(0) @binding(6) var<storage, read> arguments: array<u32>;
@group(0) @binding(7) var scene_depth: texture_depth_2d;

// Drops are tested against the cover map: 0 not at all, 1 where all fall straight down, 2 else.
override COVER: u32 = 2u;
// Whether there are an environment map, lamps, things that are transparent, and a fade before the scene.
override ENVIRONMENT: bool = true;
override LAMPS: bool = true;
override PANES: bool = true;
override SOFT: bool = true;

// Gaps before the scene are kept between these: behind it nothing is told apart, and far from it halves are exact enough.
const BEHIND: f32 = -1.0;
const CLEAR: f32 = 1e4;

// Whether a drop is under a roof or has met one in the exposure.
fn sheltered(p: vec3<f32>, before: vec3<f32>, inverse_speed: f32) -> bool {
    if (COVER == 0u) {
        return false;
    }
    if (COVER == 1u) {
        // What `rain_covered` comes to where its rays are upright: it has been right above the drop all the time.
        return rain_cover_height(cover_map, view.cover, p.xz) > p.y + 0.02;
    }
    return rain_inside_building(cover_map, view.cover, p)
        || rain_covered(cover_map, view.cover, p, inverse_speed)
        || rain_covered(cover_map, view.cover, before, inverse_speed);
}

fn drop_radiance(place: vec3<f32>) -> vec3<f32> {
    let from_eye = normalize(place + view.rays.xyz);
    var light: vec3<f32>;
    if (!ENVIRONMENT) {
        light = rain_drop_shine_evenly(view.ambient, view.sun_direction.xyz, view.sun.rgb, from_eye);
    } else {
        light = rain_drop_shine(
            environment,
            environment_sampler,
            view.environment,
            view.ambient,
            view.sun_direction.xyz,
            view.sun.rgb,
            from_eye,
        );
    }
    if (LAMPS) {
        for (var i = 0u; i < view.lamps; i++) {
            light += rain_lamp_radiance_along(view.lamp[i], place, from_eye);
        }
    }
    return light;
}

fn behind_glass(place: vec3<f32>) -> bool {
    if (!PANES) {
        return false;
    }
    for (var i = 0u; i < view.panes; i++) {
        if (rain_behind_pane(view.pane[i], place)) {
            return true;
        }
    }
    return false;
}

// Distance from an end, in px, to the scene behind it.
fn gap_at(end: vec2<f32>, depth: f32) -> f32 {
    let inside = clamp(end, vec2<f32>(0.0), view.viewport.zw - 1.0);
    return clamp(gap_before_scene(inside + view.viewport.xy, depth), BEHIND, CLEAR);
}

// The streak of a drop, without size where none is drawn.
fn streak_of(record: DropRecord) -> Streak {
    let presence = f32(record.drop >> 16u) / 65535.0;
    let k = view.classes[record.drop & 15u];
    let drop = rain_field_drop(record, k);
    let diameter_mm = drop.diameter;
    let p = drop.place;

    var out = Streak(vec4<f32>(0.0), vec3<f32>(0.0), 0u, vec3<f32>(0.0), 0u);

    let parallel = view.rays.w > 0.0;
    let reach = rain_drawn(view.kappa, diameter_mm, view.focal, view.exposure, parallel);
    // A drop that the eye has nearly met in the exposure would be a panel across the picture.
    let eye_path = view.lead.xyz * (-view.exposure / RAIN_LEAD_TIME_S);
    let weight = presence
        * select(rain_ramp(0.1, 0.2, rain_to_segment(p, eye_path)), 1.0, parallel)
        * (1.0 - rain_ramp(0.8 * reach, RAIN_FADE_END * reach, rain_to_segment(p, view.lead.xyz)));
    let before = p - k.velocity.xyz * view.exposure;
    var head = view.clip_from_eye * vec4<f32>(p, 1.0);
    var tail = view.clip_from_eye_before * vec4<f32>(before, 1.0);
    let near = max(view.near, 0.02);
    if (weight <= 0.0 || (head.w < near && tail.w < near)
        || sheltered(p, before, k.velocity.w)) {
        return out;
    }
    // Cut at the near plane before dividing.
    if (head.w < near) {
        head = mix(head, tail, (near - head.w) / (tail.w - head.w));
    } else if (tail.w < near) {
        tail = mix(tail, head, (near - tail.w) / (head.w - tail.w));
    }
    let distance = select(max(0.5 * (head.w + tail.w), near), RAIN_RANGE_CAP_M, parallel);
    let d = min(length(p) * view.size.w, 1.0);
    let larger = view.size.x + d * (view.size.y + d * view.size.z);
    let size = larger * diameter_mm * 1e-3 * view.focal / distance;
    let a = rain_pixel(head, view.viewport.zw);
    let b = rain_pixel(tail, view.viewport.zw);
    let width = max(1.0, size);
    let span = max(1.0, length(b - a) + size);
    // Off the axis a flat picture draws a sphere out to an ellipse.
    let secant = select(clamp(length(0.5 * (p + before)) / distance, 1.0, 4.0), 1.0, parallel);
    let opacity = min(1.0, 0.7853982 * size * size * secant / (width * span));
    let middle = 0.5 * (p + before);
    out.ends = vec4<f32>(a, b);
    let depths = vec2<f32>(head.z / head.w, tail.z / tail.w);
    out.shape = vec3<f32>(depths, select(0.5, -0.5, behind_glass(middle)) * width);
    out.shares = pack2x16float(weight * vec2<f32>(rain_contrast(opacity, view.contrast), min(1.0, size / width)));
    out.light = drop_radiance(middle);
    if (SOFT) {
        out.gaps = pack2x16float(vec2<f32>(gap_at(a, depths.x), gap_at(b, depths.y)));
    }
    return out;
}

// Error: 0.02 px in place; 5 % of the optical depth of all drops together.
@compute @workgroup_size(64)
fn project(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x < arguments[0]) {
        streaks[id.x] = streak_of(records[id.x]);
    }
}
