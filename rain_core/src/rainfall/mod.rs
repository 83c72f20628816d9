//! Falling rain: size spectrum, fall speed, the frozen drop field and the container that follows a view.

mod classes;
mod column;
mod container;
mod fall;
mod field;
mod oscillation;
mod shape;
mod spectrum;
mod streak;
mod terminal_velocity;
mod wind_response;

pub use classes::{CLASS_CELL_M, CLASS_COUNT, CLASS_EDGES_MM, CLASS_SPEEDS_M_S, SizeClass, visible_range_m};
pub use column::{ColumnDrop, column_drop, fract};
pub use container::{
    ClassPlacement, Container, DrawRange, DropRecord, FADE_END, LEAD_CAP_M, LEAD_TIME_S, RANGE_CAP_M, RainViewVolume,
    expected_drops, quality_for_budget,
};
pub use fall::{
    Fall, FallState, MAX_FALL_HEIGHT_M, MAX_FALL_TIME_S, drag_stiffness, fall_f32, quadratic_speed_after_f32,
};
pub use field::{Drop, FieldMotion, LatticeEye, SOFT_EDGE, Threshold, cell_key, drop_marks, drop_place, for_each_drop};
pub use oscillation::{
    Oscillation, mode_decay_s, mode_frequency_hz, oscillating_radius_f32, phase_turns, sustained_amplitude,
};
pub use shape::{
    DropOutline, MAX_AXIS_RATIO_DIAMETER_MM, MAX_OUTLINE_DIAMETER_MM, OUTLINE_TERMS, Spheroid, axis_ratio,
    axis_ratio_f32, drop_mass_kg, drop_volume_mm3,
};
pub use spectrum::{Distribution, MAX_INTENSITY_MM_H, Spectrum};
pub use streak::{
    ScreenStreak, circle_of_confusion_px, clip_to_near, contrast_gain, lamp_falloff_per_m2, streak_length_m,
    streak_opacity, streak_opacity_f32, streak_path_m, streak_peak_opacity,
};
pub use terminal_velocity::{MAX_FITTED_DIAMETER_MM, density_factor, terminal_velocity};
pub use wind_response::{WindResponse, gust_gain, relax_f32, response_time_s, slant_rad};
