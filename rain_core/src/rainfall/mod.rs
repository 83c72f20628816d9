//! Falling rain: size spectrum, fall speed and fall from rest, shape of a drop, streaks, the frozen drop field and the
//! container that follows a view.

pub mod areas;
mod bulk;
mod choice;
mod class_scheme;
mod class_weights;
mod classes;
mod column;
mod container;
mod detail;
mod drop_sizes;
mod fall;
mod far_rain;
mod field;
mod fit_flux;
mod follow;
mod frame_budget;
mod gamma;
mod impacts;
mod incomplete_gamma;
mod lattice;
mod lead;
mod local;
mod oscillation;
mod renormalise;
mod sampling;
mod shape;
pub mod source_forms;
mod spectrum;
mod streak;
mod streak_texture;
pub mod terminal_velocity;
mod view_cells;
mod wind_response;

pub use choice::{DropChoice, UnevenRain};
pub use class_scheme::{ClassErrors, ClassScheme};
pub use class_weights::ClassWeights;
pub use classes::{CLASS_CELL_M, CLASS_COUNT, CLASS_EDGES_MM, CLASS_SPEEDS_M_S, SizeClass, visible_range_m};
pub use column::{ColumnDrop, column_drop, fract};
pub use container::{
    ClassPlacement, Container, DrawRange, DropRecord, FADE_END, LEAD_CAP_M, LEAD_TIME_S, ParallelView, RANGE_CAP_M,
    RainViewVolume, TURN_CAP_RAD, Thinning, expected_drops, quality_for_budget,
};
pub use detail::DetailLaw;
pub use drop_sizes::{DropSizes, MAX_BLEND, RainKind, SizeLaw, UnknownRainKind};
pub use fall::{
    Fall, FallState, MAX_FALL_HEIGHT_M, MAX_FALL_TIME_S, drag_stiffness, fall_f32, quadratic_fall_time_f32,
    quadratic_speed_after_f32,
};
pub use far_rain::{
    FAR_BEGIN_M, FAR_HEIGHT, FAR_OPACITY, FAR_PITCH, FAR_SHADE, FarAccount, FarEye, FarParticle, FarRain,
    FarRainSettings, FarRainView, MAX_FAR_PARTICLES, cloud_share, far_begin, far_pitch_weight, far_presence,
    far_profile,
};
pub use field::{Drop, FieldMotion, LatticeEye, SOFT_EDGE, Threshold, cell_key, drop_marks, drop_place, for_each_drop};
pub use follow::{Follow, FollowSettings, FollowShape, heading_margin_rad};
pub use frame_budget::{FrameBudget, FrameBudgetSettings};
pub use gamma::{DEFAULT_GAMMA_SHAPE, GammaClimate, GammaSpectrum};
pub use impacts::measured_energy_j_m2_mm;
pub(crate) use impacts::turning;
pub use lattice::{
    Card, CardCounts, CardHit, Lamp, LatticeLevel, LatticePlan, LatticeRates, LatticeSettings, LatticeSharing,
    LatticeView, MAX_CARD_SAMPLES, MAX_LAMPS, pitch_weight,
};
pub use local::{LocalRain, RateLadder};
pub use oscillation::{
    Oscillation, mode_decay_s, mode_frequency_hz, oscillating_radius_f32, phase_turns, sustained_amplitude,
};
pub use sampling::{AirSampler, DiameterTable};
pub use shape::{
    DropOutline, MAX_AXIS_RATIO_DIAMETER_MM, MAX_OUTLINE_DIAMETER_MM, OUTLINE_TERMS, Spheroid, axis_ratio,
    axis_ratio_f32, drop_mass_kg, drop_volume_mm3,
};
pub use spectrum::{Distribution, MAX_INTENSITY_MM_H, Spectrum};
pub use streak::{
    ScreenStreak, circle_of_confusion_px, clip_to_near, contrast_gain, lamp_falloff_per_m2, streak_length_m,
    streak_opacity, streak_opacity_f32, streak_path_m, streak_peak_opacity,
};
pub use streak_texture::{
    CacheOutcome, CachedStreaks, MAX_STREAK_LAYERS, OVERLAP_STEPS, PackedStreaks, STREAK_TEXTURE_VERSION, StreakCache,
    StreakFileError, StreakLayer, StreakTexture, StreakTextureSettings, StreakTextures, TileDrop,
};
pub use terminal_velocity::{
    BeardAir, FallLaw, MAX_FITTED_DIAMETER_MM, StandardAtmosphere, density_factor, gunn_kinzer, terminal_velocity,
    terminal_velocity_f32,
};
pub use view_cells::{ClassCells, ViewCells};
pub use wind_response::{WindResponse, gust_gain, relax_f32, response_time_s, slant_rad};
