// What a drop shows: its surroundings, refracted and reflected.

// Share of the light on a drop that leaves per steradian at angle `theta` from forward, refraction only.
// Fitted to the geometric share of the disc that leaves within 10..60 degrees. Error: 8 % of it.
fn rain_drop_phase(theta: f32) -> f32 {
    return min(1.2, exp(0.745 - 3.44 * theta));
}

// Mean over the disc of the light that goes straight through, and of the light reflected outside (n = 1.333).
const RAIN_DROP_TRANSMITTED: f32 = 0.884;
const RAIN_DROP_REFLECTED: f32 = 0.066;

// Radiance of a drop between what lies ahead and what lies behind the eye, with a sun of irradiance `sun` at angle
// `theta` from the line of sight. What a sphere reflects outside goes evenly in all directions. Error: 1e-4 of the two
// shares that a sphere sends on and back.
fn rain_drop_radiance(ahead: vec3<f32>, behind: vec3<f32>, sun: vec3<f32>, theta: f32) -> vec3<f32> {
    let from_sun = sun * (RAIN_DROP_TRANSMITTED * rain_drop_phase(theta) + RAIN_DROP_REFLECTED * 0.0795775);
    return RAIN_DROP_TRANSMITTED * ahead + RAIN_DROP_REFLECTED * behind + from_sun;
}
