//! How fast waves run and how fast they die, by wavelength and depth.
//!
//! ω² = (g k + σk³/ρ) tanh(k h) for small waves on still water of constant depth (Lamb 1932, §§ 228, 266, 348), with
//! water at 20 °C. Wave number k in rad/m, domain [0, 1e7]; depth h in m, domain [0, 1e4]. Whatever lies outside is
//! clamped, NaN counts as 0.
//!
//! # Accuracy
//! Clean water: films of oil or soap multiply the damping of short waves. Linear: steep waves run faster by (k a)²/2.

use crate::constants::{GRAVITY, WATER_DENSITY, WATER_KINEMATIC_VISCOSITY, WATER_SURFACE_TENSION};
use crate::error::{clamped, clamped_f32};
use crate::ops;

/// Largest wave number. Units: rad/m.
const MAX_WAVE_NUMBER: f64 = 1e7;
/// Largest depth. Units: m.
const MAX_DEPTH_M: f64 = 1e4;
/// σ/ρ. Units: m³/s².
const TENSION: f64 = WATER_SURFACE_TENSION / WATER_DENSITY;

/// x/sinh x for x ≥ 0: 1 at 0, 0 beyond the range of e^(−x).
fn over_sinh(x: f64) -> f64 {
    if x < 1e-4 {
        1.0 - x * x / 6.0
    } else {
        2.0 * x * ops::exp(-x) / -ops::exp_m1(-2.0 * x)
    }
}

/// [`over_sinh`] in single precision.
fn over_sinh_f32(x: f32) -> f32 {
    if x < 1e-2 {
        1.0 - x * x / 6.0
    } else {
        2.0 * x * ops::expf(-x) / -ops::exp_m1f(-2.0 * x)
    }
}

/// tanh(x)/x for x ≥ 0.
fn tanh_over(x: f64) -> f64 {
    if x < 1e-4 { 1.0 - x * x / 3.0 } else { ops::tanh(x) / x }
}

/// [`tanh_over`] in single precision.
fn tanh_over_f32(x: f32) -> f32 {
    if x < 1e-2 { 1.0 - x * x / 3.0 } else { ops::tanhf(x) / x }
}

/// Speed of long waves, √(g h). Units: m/s. `depth_m` clamped to [0, 1e4] m.
///
/// Error: relative 3e-16; model: see [`phase_speed`].
#[must_use]
pub fn shallow_speed(depth_m: f64) -> f64 {
    ops::sqrt(GRAVITY * clamped(depth_m, 0.0, MAX_DEPTH_M))
}

/// [`shallow_speed`] in single precision. Error: relative 3e-7.
#[must_use]
pub fn shallow_speed_f32(depth_m: f32) -> f32 {
    (GRAVITY as f32 * clamped_f32(depth_m, 0.0, MAX_DEPTH_M as f32)).sqrt()
}

/// Phase speed c = ω/k = √((g + σk²/ρ) tanh(k h)/k). Units: m/s; k in rad/m, h in m, both clamped (see the module).
///
/// k → 0 gives √(g h). Error: relative 1e-14; model: linear waves on clean water.
#[must_use]
pub fn phase_speed(wave_number: f64, depth_m: f64) -> f64 {
    let (k, h) = (
        clamped(wave_number, 0.0, MAX_WAVE_NUMBER),
        clamped(depth_m, 0.0, MAX_DEPTH_M),
    );
    ops::sqrt((GRAVITY + TENSION * k * k) * h * tanh_over(k * h))
}

/// [`phase_speed`] in single precision. Error: relative 1e-6.
#[must_use]
pub fn phase_speed_f32(wave_number: f32, depth_m: f32) -> f32 {
    let k = clamped_f32(wave_number, 0.0, MAX_WAVE_NUMBER as f32);
    let h = clamped_f32(depth_m, 0.0, MAX_DEPTH_M as f32);
    ((GRAVITY as f32 + TENSION as f32 * k * k) * h * tanh_over_f32(k * h)).sqrt()
}

/// Angular frequency ω = k c. Units: rad/s; k in rad/m, h in m, both clamped.
///
/// Error: relative 1e-14.
#[must_use]
pub fn wave_frequency(wave_number: f64, depth_m: f64) -> f64 {
    clamped(wave_number, 0.0, MAX_WAVE_NUMBER) * phase_speed(wave_number, depth_m)
}

/// [`wave_frequency`] in single precision. Error: relative 1e-6.
#[must_use]
pub fn wave_frequency_f32(wave_number: f32, depth_m: f32) -> f32 {
    clamped_f32(wave_number, 0.0, MAX_WAVE_NUMBER as f32) * phase_speed_f32(wave_number, depth_m)
}

/// Group speed dω/dk = ½ c [(1 + 3B)/(1 + B) + 2kh/sinh 2kh], B = σk²/(ρg). Units: m/s; k in rad/m, h in m, both
/// clamped.
///
/// Error: relative 1e-8 against differences of ω.
#[must_use]
pub fn group_speed(wave_number: f64, depth_m: f64) -> f64 {
    let (k, h) = (
        clamped(wave_number, 0.0, MAX_WAVE_NUMBER),
        clamped(depth_m, 0.0, MAX_DEPTH_M),
    );
    let bond = TENSION / GRAVITY * k * k;
    0.5 * phase_speed(k, h) * ((1.0 + 3.0 * bond) / (1.0 + bond) + over_sinh(2.0 * k * h))
}

/// [`group_speed`] in single precision. Error: relative 2e-6.
#[must_use]
pub fn group_speed_f32(wave_number: f32, depth_m: f32) -> f32 {
    let k = clamped_f32(wave_number, 0.0, MAX_WAVE_NUMBER as f32);
    let h = clamped_f32(depth_m, 0.0, MAX_DEPTH_M as f32);
    let bond = (TENSION / GRAVITY) as f32 * k * k;
    0.5 * phase_speed_f32(k, h) * ((1.0 + 3.0 * bond) / (1.0 + bond) + over_sinh_f32(2.0 * k * h))
}

/// The slowest wave on deep water: (phase speed in m/s, wavelength in m) = ((4gσ/ρ)^¼, 2π√(σ/(ρg))).
///
/// Error: relative 1e-14 against halving; model: deep, clean water at 20 °C.
#[must_use]
pub fn minimum_phase_speed() -> (f64, f64) {
    (
        ops::sqrt(ops::sqrt(4.0 * GRAVITY * TENSION)),
        core::f64::consts::TAU * ops::sqrt(TENSION / GRAVITY),
    )
}

/// Decay rate of the amplitude by viscosity in the bulk, 2νk² (Lamb 1932, § 348). Units: 1/s; k in rad/m, clamped.
///
/// Twice this is the energy's rate and the `damping_per_s` of the wave equation.
///
/// Error: relative 1e-15; model: clean surface, waves much longer than √(ν/ω).
#[must_use]
pub fn bulk_damping(wave_number: f64) -> f64 {
    let k = clamped(wave_number, 0.0, MAX_WAVE_NUMBER);
    2.0 * WATER_KINEMATIC_VISCOSITY * k * k
}

/// [`bulk_damping`] in single precision. Error: relative 4e-7.
#[must_use]
pub fn bulk_damping_f32(wave_number: f32) -> f32 {
    let k = clamped_f32(wave_number, 0.0, MAX_WAVE_NUMBER as f32);
    2.0 * WATER_KINEMATIC_VISCOSITY as f32 * k * k
}

/// Decay rate of the amplitude by friction on a smooth bottom, √(νω/2) k/sinh 2kh. Units: 1/s; k in rad/m, h in m, both
/// clamped, h to no less than 1e-5 m.
///
/// Error: relative 1e-13; model: laminar boundary layer, thin against the depth.
#[must_use]
pub fn bottom_damping(wave_number: f64, depth_m: f64) -> f64 {
    let k = clamped(wave_number, 0.0, MAX_WAVE_NUMBER);
    let h = clamped(depth_m, 0.0, MAX_DEPTH_M).max(1e-5);
    let layer = ops::sqrt(0.5 * WATER_KINEMATIC_VISCOSITY * wave_frequency(k, h));
    layer * over_sinh(2.0 * k * h) / (2.0 * h)
}

/// [`bottom_damping`] in single precision. Error: relative 2e-6, absolute 2e-9 1/s below 1e-3 1/s.
#[must_use]
pub fn bottom_damping_f32(wave_number: f32, depth_m: f32) -> f32 {
    let k = clamped_f32(wave_number, 0.0, MAX_WAVE_NUMBER as f32);
    let h = clamped_f32(depth_m, 0.0, MAX_DEPTH_M as f32).max(1e-5);
    let layer = (0.5 * WATER_KINEMATIC_VISCOSITY as f32 * wave_frequency_f32(k, h)).sqrt();
    layer * over_sinh_f32(2.0 * k * h) / (2.0 * h)
}
