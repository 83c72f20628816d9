//! What rain sounds like: the sound that drops make where they land, and what of it reaches a listener.
//!
//! A share of the drops' kinetic energy becomes sound, by what they land on. Levels are in dB re 20 µPa, which is
//! 10⁻¹² W/m² in air.
//!
//! # Accuracy
//! The shares are choices, right to perhaps 5 dB: sheet metal from the sound of roofs in the standard heavy rain (ISO
//! 10140-5: 65 to 70 dB), hard ground from 55 to 60 dB in heavy rain, soft ground below it. Nothing is said of the
//! spectrum. Rain on water is loud under water (Nystuen 1986) but not above it.

use core::f64::consts::PI;

use crate::rainfall::measured_energy_j_m2_mm;
use crate::weather::SurfaceClass;
use crate::{error::clamped, ops};

/// Intensity that levels refer to. Units: W/m².
const REFERENCE_W_M2: f64 = 1e-12;
/// Share of the energy that becomes sound on standing water. Units: none.
pub const WATER_SOUND_SHARE: f64 = 3e-7;
/// Rings around a listener that are heard: middle radius and area. Units: m, m².
pub const SOUND_RINGS: [[f64; 2]; 5] = [
    [0.7, PI],
    [1.5, 3.0 * PI],
    [3.0, 12.0 * PI],
    [6.0, 48.0 * PI],
    [12.0, 192.0 * PI],
];
/// Places on each ring.
pub const SOUND_PLACES: usize = 6;

/// Share of a drop's kinetic energy that becomes sound on a dry or wet surface of a class. Units: none.
///
/// Error: exact, a choice of 5 dB.
#[must_use]
pub fn sound_share(class: SurfaceClass) -> f64 {
    match class {
        SurfaceClass::Roof => 2e-5,
        SurfaceClass::Asphalt | SurfaceClass::Concrete | SurfaceClass::Stone => 1e-6,
        SurfaceClass::Gravel => 6e-7,
        SurfaceClass::Soil => 2e-7,
        SurfaceClass::Grass => 3e-7,
    }
}

/// Sound that rain makes on a square metre: its energy flux E(R) R times the share. Units: W/m².
///
/// `intensity_mm_h`: mm/h, held in [0, 500]; `share`: none, held in [0, 1]; NaN counts as 0. E after van Dijk et al. 2002.
///
/// Error: 1e-14 relative; energies of rains differ by 10 to 20 %, 1 dB.
#[must_use]
pub fn rain_sound_w_m2(intensity_mm_h: f64, share: f64) -> f64 {
    let rate = clamped(intensity_mm_h, 0.0, 500.0);
    clamped(share, 0.0, 1.0) * measured_energy_j_m2_mm(rate) * rate / 3600.0
}

/// Share of the sound of an area on the ground that arrives at a listener: it spreads over half a sphere, A/(2π d²).
/// Units: none, as W/m² of W/m².
///
/// `area_m2` ≥ 0, `distance_m` held at 0.5 m below; NaN gives 0.
///
/// Error: 1e-15 relative; ground and walls send back as much again in a street.
#[must_use]
pub fn heard_share(area_m2: f64, distance_m: f64) -> f64 {
    let distance = clamped(distance_m, 0.5, 1e9);
    clamped(area_m2, 0.0, 1e9) / (core::f64::consts::TAU * distance * distance)
}

/// Level of an intensity (W/m²), dB re 20 µPa; 0 at the threshold of hearing and below.
///
/// Error: 1e-13 dB.
#[must_use]
pub fn sound_level_db(intensity_w_m2: f64) -> f64 {
    if intensity_w_m2 > REFERENCE_W_M2 {
        10.0 / core::f64::consts::LN_10 * ops::ln(intensity_w_m2.min(1e12) / REFERENCE_W_M2)
    } else {
        0.0
    }
}
