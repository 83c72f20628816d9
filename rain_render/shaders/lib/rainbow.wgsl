// Rainbows, as rain_core::optics has them in double precision.

// Angle of a unit line of sight from the point opposite the sun, which stands in the unit direction `sun`. Error: 3e-7 rad.
fn rain_bow_angle(towards: vec3<f32>, sun: vec3<f32>) -> f32 {
    // By both sides of the triangle: an arc cosine alone would lose the angle about 0.
    return atan2(length(cross(towards, sun)), -dot(towards, sun));
}

// Place of an angle among the entries of the bow's table. Error: 1e-3.
fn rain_bow_place(angle: f32) -> f32 {
    let degrees = clamp(angle * 57.29578, 0.0, 180.0);
    let close = (clamp(degrees, RAIN_BOW_LOW, RAIN_BOW_HIGH) - RAIN_BOW_LOW) / RAIN_BOW_WITHIN;
    return min(degrees, RAIN_BOW_LOW) / RAIN_BOW_BELOW + close + max(degrees - RAIN_BOW_HIGH, 0.0) / RAIN_BOW_ABOVE;
}

// Share of the sun's light at the eye that rain of a geometric optical depth meets and lets through to the eye, when light
// and sight take much the same way: (1 - exp(-2 depth)) / 2. Error: 1e-6 of it.
fn rain_bow_share(depth: f32) -> f32 {
    return 0.5 * rain_haze_share(2.0 * depth);
}
