// Far rain: particles of many drops, and what haze leaves to them, as rain_core::rainfall has it.

// Share of the rain at a distance on the ground that may be far rain. Error: 1e-6.
fn rain_far_begin(distance: f32) -> f32 {
    return rain_ramp(RAIN_FAR_BEGIN_M, RAIN_FAR_WHOLE_M, distance);
}

// Share of it by the sine of a line's elevation. Error: 1e-6.
fn rain_far_pitch_weight(sine: f32) -> f32 {
    return rain_ramp(RAIN_FAR_LOW_FROM, RAIN_FAR_LOW_TO, sine) * (1.0 - rain_ramp(RAIN_FAR_HIGH_FROM, RAIN_FAR_HIGH_TO, sine));
}

// Opacity at (across, along), each -1 to 1, over that in the middle of a particle without stripes. Error: 1e-4.
fn rain_far_profile(place: vec2<f32>, phase: f32) -> f32 {
    let half_turn = 3.1415927;
    let soft = 0.5 + 0.5 * cos(half_turn * clamp(place, vec2<f32>(-1.0), vec2<f32>(1.0)));
    let stripes = 1.0 + 0.6 * cos(2.0 * half_turn * (1.5 * place.x + phase))
        + 0.35 * cos(2.0 * half_turn * (3.7 * place.x - 3.0 * phase));
    return soft.x * soft.y * stripes;
}

// Light of a particle over that of its curtain. Error: 1e-5.
fn rain_far_shade(phase: f32) -> f32 {
    return 1.0 + RAIN_FAR_SHADE * (2.0 * fract(7.0 * phase) - 1.0);
}
