// Where water stands, and where the picture of its bottom and of its surroundings is found.

// Depth of the standing water above `p`, m; negative where the water table lies below it or there is none.
//
// Levels belong to whole cells and reach one cell beyond their pool, so the shoreline is where the ground itself
// meets the level. What lies deeper than RAIN_DEEPEST_PUDDLE_M under it is another floor.
fn rain_standing_water(map: texture_2d<f32>, levels: LevelMapParams, p: vec3<f32>) -> f32 {
    let cell = floor((p.xz - levels.corner) * levels.inverse_cell);
    if (levels.present < 0.5 || any(cell < vec2<f32>(0.0)) || any(cell >= levels.cells)) {
        return -1.0;
    }
    let depth = levels.base + textureLoad(map, vec2<i32>(cell), 0).x - p.y;
    return select(-1.0, depth, depth <= RAIN_DEEPEST_PUDDLE_M);
}

// Where on the level bottom the view ray ends that, unbent, would end at a point under `depth` of water, relative to
// that point (x, z), m. `to_eye` is the unit vector towards the eye. Snell's law with n = 1.333.
fn rain_refraction_shift(to_eye: vec3<f32>, depth: f32) -> vec2<f32> {
    let up = max(to_eye.y, 0.05);
    // Horizontal run of a metre of depth, in air and in water.
    let air = to_eye.xz / up;
    let water = to_eye.xz / sqrt(max(1.776889 - dot(to_eye.xz, to_eye.xz), 0.1));
    return max(depth, 0.0) * (air - water);
}

// Weights of two texture gradients that move by `shift` on the ground: shift = a.x ddx + a.y ddy, limited to `most`
// pixels where the ground is seen at a grazing angle.
fn rain_shift_in_pixels(shift: vec2<f32>, ddx: vec2<f32>, ddy: vec2<f32>, most: f32) -> vec2<f32> {
    let determinant = ddx.x * ddy.y - ddx.y * ddy.x;
    if (abs(determinant) < 1e-12) {
        return vec2<f32>(0.0);
    }
    let a = vec2<f32>(shift.x * ddy.y - shift.y * ddy.x, ddx.x * shift.y - ddx.y * shift.x) / determinant;
    return a * min(1.0, most / max(length(a), 1e-6));
}

// Reflectance of still water (n = 1.333) for unpolarised light at this cosine.
fn rain_water_fresnel(cos_incidence: f32) -> f32 {
    let c = clamp(cos_incidence, 0.0, 1.0);
    let t = sqrt(1.776889 - 1.0 + c * c);
    let s = (c - t) / (c + t);
    let p = (1.776889 * c - t) / (1.776889 * c + t);
    return 0.5 * (s * s + p * p);
}

// How bright muddy water is along a ray under water, against its mean: the twin of rain_core::surface::mud_phase.
// Error: 1e-6.
fn rain_mud_phase(cos_refracted: f32) -> f32 {
    let mu = clamp(cos_refracted, 0.0, 1.0);
    let spread = 1.853776 + 1.848 * mu;
    return 11.45785 / (spread * sqrt(spread) * (1.0 + mu));
}

// Albedo of ground of dry albedo `dry` under `depth` m of water, seen or lit at this cosine in the air, without the
// mirror on top: the twin of rain_core::surface::under_water. Error: 1e-5.
fn rain_under_water(dry: vec3<f32>, look: WaterLook, depth: f32, cos_incidence: f32) -> vec3<f32> {
    let c = clamp(cos_incidence, 0.0, 1.0);
    let refracted = sqrt(1.0 - (1.0 - c * c) / 1.776889);
    let turbidity = look.mud.w;
    let loss = look.absorption.xyz + turbidity;
    let enters = 1.0 - rain_water_fresnel(c);
    // Lekner & Dorf 1988, as in rain_wet_albedo; the ways up and round are means over directions.
    let gain = (1.0 - 0.0375281) / (1.0 - 0.0990658);
    let rho = clamp(dry, vec3<f32>(0.0), vec3<f32>(1.0));
    let body = rho * (2.0 - gain + (gain - 1.0) * rho);
    let escape = (1.0 - 0.474591) * body / (1.0 - 0.474591 * exp(-loss * 4.6 * depth) * body);
    let ground = enters * exp(-loss * depth / refracted) * exp(-loss * 1.19 * depth) * escape;
    let met = 1.0 - exp(-loss * depth * (1.0 / refracted + 1.19));
    let mud = min(look.mud.xyz * rain_mud_phase(refracted), vec3<f32>(1.0));
    return ground + enters * mud * met * turbidity / max(loss, vec3<f32>(1e-9));
}

// What lies aslant (x, z) in a texel of a normal map whose picture's right is x and down is z.
fn rain_normal_aslant(texel: vec2<f32>) -> vec2<f32> {
    return (texel * 2.0 - 1.0) * vec2<f32>(1.0, -1.0);
}

// Slopes of a surface with a detail normal added: r = normalize(n1.xy + n2.xy, n1.z) (UDN), n1 of the slopes, n2 aslant by
// `detail`.
fn rain_udn(slope: vec2<f32>, detail: vec2<f32>) -> vec2<f32> {
    return slope - detail * sqrt(1.0 + dot(slope, slope));
}
