//! Extinction, visibility and fog of rain: one optical depth, shared between drawn drops and haze.

mod artist;
mod extinction;
mod profile;
mod sharing;
mod visibility;

pub use artist::{FogFade, LUMA_GAMMA, LUMA_LINEAR, ToyShopGlow, artist_fog_amount, desaturated, fog_density};
pub use extinction::{
    EXTINCTION_EFFICIENCY, extinction_per_m, inscattered, inscattered_f32, obscured, obscured_f32, transmittance,
    transmittance_f32,
};
pub use profile::{HeightHaze, mean_decay, mean_decay_f32};
pub use sharing::{
    DrawnClass, FogTable, HazeSharing, card_coverage, card_weight, mid_depth_m, mid_start_m, mid_weight, near_depth_m,
    near_weight, ramp, ramp_integral_m, single_range_fog_depth,
};
pub use visibility::{
    KOSCHMIEDER_CONTRAST, MAX_VISIBILITY_M, METEOROLOGICAL_CONTRAST, contrast_at, extinction_for_visibility_per_m,
    visibility_m,
};
