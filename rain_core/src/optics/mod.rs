//! Light at a water surface and in a drop: Fresnel, refraction, energy split, radiance.

mod drop_body;
mod drop_radiance;
mod energy;
mod fresnel;
mod refraction;

pub use drop_body::{DropBody, DropRay};
pub use drop_radiance::{CHEAP_REFLECTED, CHEAP_REFRACTED, DropLight, DropRays, drop_light, drop_rays_f32};
pub use energy::{EnergySplit, energy_split, retro_reflection, sphere_order_share};
pub use fresnel::{
    Polarised, brewster_rad, critical_angle_rad, fresnel, fresnel_f32, fresnel_from_inside, fresnel_polarised,
    hemispherical_mean, hemispherical_mean_inside, normal_reflectance, schlick, schlick_f32,
};
pub use refraction::{
    Bow, deviation_rad, deviation_sin_cos_f32, disc_share_within, field_of_view_rad, impact_of_deviation, rainbow,
};
