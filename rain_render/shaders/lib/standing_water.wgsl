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

// Slopes (dh/dx, dh/dz) of wind waves at `p` (any origin that stays), `time` in s: five deep-water wave trains within
// 40 degrees of the wind, each half as long and a third as steep as the one before it.
fn rain_wind_slopes(look: WaterLook, p: vec2<f32>, time: f32) -> vec2<f32> {
    let speed = length(look.ambient.zw);
    if (look.ambient.x <= 0.0 || speed <= 0.0) {
        return vec2<f32>(0.0);
    }
    let along = look.ambient.zw / speed;
    var angles = array<f32, 5>(0.1, -0.52, 0.44, -0.23, 0.68);
    var slopes = vec2<f32>(0.0);
    var number = 6.2831853 * look.ambient.y;
    // Mean squares 1, 1/1.7, ... of each train sum up to look.ambient.x.
    var square = look.ambient.x * 0.4428;
    for (var i = 0; i < 5; i++) {
        let c = cos(angles[i]);
        let s = sin(angles[i]);
        let direction = vec2<f32>(c * along.x - s * along.y, s * along.x + c * along.y);
        let phase = number * (dot(direction, p) - speed * time) + 1.7 * f32(i);
        slopes += direction * (sqrt(2.0 * square) * cos(phase));
        number *= 2.13;
        square /= 1.7;
    }
    return slopes;
}
