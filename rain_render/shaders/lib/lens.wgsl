// Drops on glass: what they show, and when wipers passed.

// Lean of a cap at its rim: sin 45 degrees.
const RAIN_CAP_LEAN: f32 = 0.70710678;

// What a drop shows at a share of its radius: tangent of the deviation towards its axis, share of the light.
fn rain_cap_view(share: f32) -> vec2<f32> {
    let s = clamp(share, 0.0, 1.0) * RAIN_CAP_LEAN;
    let n = 1.333;
    let t = n * s;
    let c = sqrt(1.0 - s * s);
    let e = sqrt(max(1.0 - t * t, 0.0));
    // Angle between the two by their sines and cosines.
    let turn = vec2<f32>(t * c - s * e, c * e + s * t);
    // Fresnel from water to air.
    let across = (n * c - e) / (n * c + e);
    let along = (c - n * e) / (c + n * e);
    return vec2<f32>(turn.x / turn.y, 1.0 - 0.5 * (across * across + along * along));
}

// How long ago a blade of one arm passed a place, s; below 0: never. `arm`: pivot, begin and end of the blade; `turn`: angle
// at rest, at the far end; `cycle`: period, moving part, time in the cycle, time since the start.
fn rain_wiped_since(arm: vec4<f32>, turn: vec2<f32>, cycle: vec4<f32>, place: vec2<f32>) -> f32 {
    let p = place - arm.xy;
    let way = length(p);
    let turned = atan2(p.y, p.x) - turn.x;
    let share = (turned - 6.2831853 * round(turned / 6.2831853)) / (turn.y - turn.x);
    if way < arm.z || way > arm.w || share < 0.0 || share > 1.0 {
        return -1.0;
    }
    let out = cycle.y * acos(1.0 - 2.0 * share) / 6.2831853;
    let passes = vec2<f32>(out, cycle.y - out);
    let since = cycle.z - passes + select(vec2<f32>(0.0), vec2<f32>(cycle.x), passes > vec2<f32>(cycle.z));
    let latest = min(since.x, since.y);
    return select(-1.0, latest, latest <= cycle.w);
}

// Share of the glass that the mist covers at a place.
fn rain_lens_mist(view: LensView, place: vec2<f32>) -> f32 {
    var mist = view.mist;
    for (var i = 0u; i < 2u; i += 1u) {
        let turn = view.turns[i];
        if turn.z > 0.0 && view.wiping > 0.0 {
            let since = rain_wiped_since(view.arms[i], turn.xy, view.cycle, place);
            if since >= 0.0 {
                mist = min(mist, 1.0 - exp(-view.mist_per_s * since));
            }
        }
    }
    return mist;
}

// Share of a drop's disc that is seen at `away` radii from its middle through an aperture `soft` radii wide.
fn rain_drop_cover(away: f32, soft: f32) -> f32 {
    let edge = clamp(0.5 + 0.5 * (1.0 - away) / max(soft, 1e-4), 0.0, 1.0);
    return edge * edge * (3.0 - 2.0 * edge) * min(1.0, 1.0 / max(soft * soft, 1e-8));
}

// Share of a place that a blade hides: a strip 16 mm wide.
fn rain_blade_cover(arm: vec4<f32>, angle: f32, soft: f32, place: vec2<f32>) -> f32 {
    let p = place - arm.xy;
    let axis = vec2<f32>(cos(angle), sin(angle));
    let along = dot(p, axis);
    let beside = abs(p.y * axis.x - p.x * axis.y);
    let inside = vec2<f32>(0.008 - beside, min(along - arm.z, arm.w - along));
    let cover = clamp(0.5 + inside / max(soft, 1e-5), vec2<f32>(0.0), vec2<f32>(1.0));
    return cover.x * cover.y;
}
