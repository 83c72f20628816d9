//! Light at a water surface and in a drop: Fresnel, refraction, energy split, radiance, rainbows.
//!
//! # Accuracy of what a drop shows
//! Against rays traced through the outline of Beard & Chuang with all inner reflections, relative L1 of the radiance
//! over the disc of drops of 1, 2, 4 mm, looking level or half a radian up:
//!
//! | | one radiance all around | overcast sky over dark ground | lamp of 0.15 rad |
//! |---|---|---|---|
//! | [`CHEAP_REFRACTED`], [`CHEAP_REFLECTED`] | 0.06 | 0.75 | 1.75 |
//! | [`drop_light`], disc stretched to the drop | 0.06 | 0.07, 0.07, 0.28 | 0.07, 0.27, 0.8 |
//! | [`drop_rays_f32`], the outline's normals | 0.06, 0.06, 0.07 | 0.07, 0.06, 0.16 | 0.05, 0.17, 0.6 |
//! | [`DropBody::rays`], 2 rays | 0.06, 0.06, 0.08 | 0.06, 0.05, 0.06 | 0.02, 0.08, 0.1 |
//! | the same, 3 rays | 0.012, 0.012, 0.02 | 0.02, 0.03, 0.06 | 0.02, 0.08, 0.1 |
//!
//! Looking half a radian down at dark ground, a quarter of what small drops show is sky by one inner reflection: two
//! rays miss 0.26, 0.28, 0.75 under the overcast sky, three 0.04, 0.07, 0.3. The cheap tier's mean over
//! the disc (for drops smaller than a pixel) is within 0.08 looking level or up, and up to 0.57 too dark looking down.

mod cloud;
mod drop_body;
mod drop_radiance;
mod energy;
mod fresnel;
mod near_streak;
mod rainbow;
mod refraction;

pub use cloud::{
    CLOUD_ASYMMETRY, CLOUD_DROP_RADIUS_M, RAIN_COLUMN_M, cloud_optical_depth, cloud_transmittance, cloud_water_kg_m2,
};
pub use drop_body::{DropBody, DropRay};
pub use drop_radiance::{CHEAP_REFLECTED, CHEAP_REFRACTED, DropLight, DropRays, drop_light, drop_rays_f32};
pub use energy::{EnergySplit, energy_split, retro_reflection, sphere_order_share};
pub use fresnel::{
    Polarised, brewster_rad, critical_angle_rad, fresnel, fresnel_f32, fresnel_from_inside, fresnel_polarised,
    hemispherical_mean, hemispherical_mean_inside, normal_reflectance, schlick, schlick_f32,
};
pub use near_streak::{
    StreakAngles, WATER_INDEX, drop_glint, light_lobe, outline_heights, outline_radius, streak_pattern, swing_at,
    swinging_body, time_inside,
};
pub use rainbow::{
    BOW_KNOTS, BOW_SPAN_DEG, BOW_STEP_DEG, BowRays, RainbowPhase, RainbowTables, bow_place, water_index,
};
pub use refraction::{
    Bow, deviation_rad, deviation_sin_cos_f32, disc_share_within, field_of_view_rad, impact_of_deviation, rainbow,
};
