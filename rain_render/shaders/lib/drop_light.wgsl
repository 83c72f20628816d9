// What a drop shows: its surroundings, refracted and reflected.

// Share of the light on a drop that leaves per steradian at angle `theta` from forward, refraction only.
// Fitted to the geometric share of the disc that leaves within 10..60 degrees; error below 8 %.
fn rain_drop_phase(theta: f32) -> f32 {
    return min(1.2, exp(0.745 - 3.44 * theta));
}

// Mean over the disc of the light that goes straight through, and of the light reflected outside (n = 1.333).
const RAIN_DROP_TRANSMITTED: f32 = 0.884;
const RAIN_DROP_REFLECTED: f32 = 0.066;
