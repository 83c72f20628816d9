//! Falling rain: size spectrum, fall speed, the frozen drop field and the container that follows a view.

mod bulk;
mod class_scheme;
mod class_weights;
mod classes;
mod container;
mod drop_sizes;
mod field;
mod gamma;
mod impacts;
mod incomplete_gamma;
mod renormalise;
mod sampling;
pub mod source_forms;
mod spectrum;
pub mod terminal_velocity;

pub use class_scheme::{ClassErrors, ClassScheme};
pub use class_weights::ClassWeights;
pub use classes::{CLASS_CELL_M, CLASS_COUNT, CLASS_EDGES_MM, CLASS_SPEEDS_M_S, SizeClass, visible_range_m};
pub use container::{
    ClassPlacement, Container, DrawRange, DropRecord, FADE_END, LEAD_CAP_M, LEAD_TIME_S, RANGE_CAP_M, RainViewVolume,
    expected_drops, quality_for_budget,
};
pub use drop_sizes::{DropSizes, MAX_BLEND, RainKind, SizeLaw, UnknownRainKind};
pub use field::{Drop, FieldMotion, LatticeEye, SOFT_EDGE, Threshold, cell_key, drop_marks, drop_place, for_each_drop};
pub use gamma::{DEFAULT_GAMMA_SHAPE, GammaClimate, GammaSpectrum};
pub use impacts::measured_energy_j_m2_mm;
pub use sampling::{AirSampler, DiameterTable};
pub use spectrum::{Distribution, MAX_INTENSITY_MM_H, Spectrum};
pub use terminal_velocity::{
    BeardAir, FallLaw, MAX_FITTED_DIAMETER_MM, StandardAtmosphere, density_factor, gunn_kinzer, terminal_velocity,
    terminal_velocity_f32,
};
