//! Extinction, visibility and fog of rain: one optical depth, shared between drawn drops and haze.

mod airlight;
mod artist;
mod bloom;
mod extinction;
mod mist;
mod profile;
mod rates;
mod sharing;
mod visibility;

pub use airlight::{LEAST_LAMP_M, cone_span_m, drop_phase_integral, drop_phase_per_sr, lamp_glow_per_m};
pub use artist::{FogFade, LUMA_GAMMA, LUMA_LINEAR, ToyShopGlow, artist_fog_amount, desaturated, fog_density};
pub use bloom::bloom_in_rain;
pub use extinction::{
    EXTINCTION_EFFICIENCY, extinction_per_m, inscattered, inscattered_f32, obscured, obscured_f32, transmittance,
    transmittance_f32,
};
pub use mist::{DRY_EXTINCTION_PER_M, HYGROSCOPICITY, MAX_MIST_HUMIDITY, mist_extinction_per_m};
pub use profile::{HeightHaze, mean_decay, mean_decay_f32};
pub use rates::{FIRST_RATE_MM_H, RATE_KNOTS, RateExtinction};
pub use sharing::{
    DrawnClass, FOG_TABLE_END_M, FOG_TABLE_KNOTS, FogTable, HazeSharing, card_coverage, card_weight, mid_depth_m,
    mid_start_m, mid_weight, near_depth_m, near_weight, ramp, ramp_integral_m, single_range_fog_depth,
};
pub use visibility::{
    KOSCHMIEDER_CONTRAST, MAX_VISIBILITY_M, METEOROLOGICAL_CONTRAST, contrast_at, extinction_for_visibility_per_m,
    visibility_m,
};
