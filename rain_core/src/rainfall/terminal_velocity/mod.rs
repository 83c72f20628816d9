//! Terminal speed of raindrops: the fast default, the measurements, Beard 1976 for any air, and the sources' own fits.
//!
//! # Accuracy
//! A drop at its terminal speed in still, dry air. Turbulence, wakes of other drops and oscillation move single drops
//! by a few percent.

mod air;
mod beard;
mod fall_law;
pub mod fits;
mod gunn_kinzer;
mod speed_table;

pub use air::{
    StandardAtmosphere, air_density_kg_m3, air_viscosity_pa_s, water_density_kg_m3, water_surface_tension_n_m,
};
pub use beard::{BeardAir, MAX_BEARD_DIAMETER_MM};
pub use fall_law::{FallLaw, UnknownFallLaw};
pub use gunn_kinzer::{GUNN_KINZER, gunn_kinzer};
pub use speed_table::SpeedTable;

use crate::constants::AIR_DENSITY;
use crate::error::{clamped, clamped_or};

/// Coefficients of the least-squares fit to Gunn & Kinzer 1949 in t = D/3 − 1, D in mm, v in m/s.
pub(super) const FIT: [f64; 9] = [
    2.689_075,
    -1.586_889,
    0.307_166,
    0.304_105_2,
    0.708_781_5,
    -2.311_28,
    0.222_606_9,
    3.065_767,
    -1.875_321,
];

/// Largest diameter of the measured table; larger drops fall at its speed. Units: mm.
pub const MAX_FITTED_DIAMETER_MM: f64 = 5.8;

/// The fit inside its range; `d` in [0, 5.8] mm.
pub(super) const fn fitted(d: f64) -> f64 {
    let t = d / 3.0 - 1.0;
    let (mut sum, mut i) = (0.0, FIT.len());
    while i > 0 {
        i -= 1;
        sum = sum * t + FIT[i];
    }
    d * sum
}

/// Terminal velocity in still air at 20 °C and 101325 Pa.
///
/// `diameter_mm`: drop diameter, mm, domain [0, ∞), clamped to 5.8. Returns m/s, in [0, 9.18], monotone. A negative or
/// NaN diameter returns 0. No branches: loops over drops are vectorised. Least-squares fit to Gunn & Kinzer 1949.
///
/// Error: 0.045 m/s at most against the monotone cubic through the measurements; model error ≤ 2.3 % for D ≥ 0.2 mm
/// and ≤ 1.3 % for D ≥ 0.5 mm, too fast below 0.2 mm (+16 % at 0.1 mm): use [`BeardAir`] for drizzle and mist.
#[must_use]
pub fn terminal_velocity(diameter_mm: f64) -> f64 {
    // Written so that NaN counts as 0.
    let d = if diameter_mm > 0.0 { diameter_mm } else { 0.0 };
    fitted(if d < MAX_FITTED_DIAMETER_MM {
        d
    } else {
        MAX_FITTED_DIAMETER_MM
    })
}

/// [`terminal_velocity`] in single precision: the same domain and clamps, without branches.
///
/// Error: 3.5e-6 m/s against double precision.
#[must_use]
pub fn terminal_velocity_f32(diameter_mm: f32) -> f32 {
    const MAX: f32 = MAX_FITTED_DIAMETER_MM as f32;
    let d = if diameter_mm > 0.0 { diameter_mm } else { 0.0 };
    let d = if d < MAX { d } else { MAX };
    let t = d / 3.0 - 1.0;
    let mut sum = 0.0;
    for c in FIT.iter().rev() {
        sum = sum * t + *c as f32;
    }
    d * sum
}

/// Factor on the sea-level terminal velocity for air of another density, (ρ₀/ρ)^(0.375 + 0.025 D).
///
/// `diameter_mm` in mm, domain [0, 7], held there; `air_density` in kg/m³, domain [0.3, 2], held there; NaN counts as 0
/// and as the standard density. Source: Beard 1985.
///
/// Error: 1e-15 relative against the formula. Against Beard 1976 for D ≥ 1 mm in the standard atmosphere up to 600 hPa:
/// ≤ 1.2 % relative to its foot at 15 °C, ≤ 1.6 % relative to 20 °C. It has no viscosity: −3 % at 0 °C and 0.3 mm.
/// [`BeardAir::velocity_factor`] is better.
#[must_use]
pub fn density_factor(diameter_mm: f64, air_density: f64) -> f64 {
    let d = clamped(diameter_mm, 0.0, MAX_BEARD_DIAMETER_MM);
    let ratio = AIR_DENSITY / clamped_or(air_density, 0.3, 2.0, AIR_DENSITY);
    crate::ops::pow(ratio, 0.375 + 0.025 * d)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fit_matches_its_check_values() {
        let table = [
            (0.1, 0.3139),
            (0.2, 0.7082),
            (0.5, 2.0511),
            (1.0, 4.0047),
            (1.4, 5.1645),
            (2.0, 6.5156),
            (3.0, 8.0672),
            (4.0, 8.8247),
            (5.0, 9.0961),
            (5.8, 9.1781),
            (50.0, 9.1781),
        ];
        for (d, v) in table {
            assert!(
                (terminal_velocity(d) - v).abs() < 6e-5,
                "D = {d}: {}",
                terminal_velocity(d)
            );
        }
    }

    #[test]
    fn fit_stays_near_the_measurements() {
        // Gunn & Kinzer 1949, D in mm, v in m/s.
        let measured = [
            (0.5, 2.06),
            (0.8, 3.27),
            (1.0, 4.03),
            (1.6, 5.65),
            (2.0, 6.49),
            (2.6, 7.57),
            (3.2, 8.26),
            (4.0, 8.83),
            (5.0, 9.09),
            (5.8, 9.17),
        ];
        for (d, v) in measured {
            assert!((terminal_velocity(d) / v - 1.0).abs() < 0.013, "D = {d}");
        }
    }

    #[test]
    fn monotone_bounded_and_safe_at_the_edges() {
        let mut last = 0.0;
        for i in 0..=5800 {
            let v = terminal_velocity(f64::from(i) * 1e-3);
            assert!(v >= last, "at {} mm", f64::from(i) * 1e-3);
            last = v;
        }
        for d in [f64::NAN, -1.0, f64::NEG_INFINITY, 0.0] {
            assert_eq!(terminal_velocity(d), 0.0);
        }
        assert!(terminal_velocity(f64::INFINITY) < 9.2);
    }

    #[test]
    fn thinner_air_is_faster() {
        assert!((density_factor(2.0, crate::constants::AIR_DENSITY) - 1.0).abs() < 1e-12);
        // ISA 2000 m, 1.0065 kg/m³: Beard 1976 gives 7.0944 m/s for 2 mm against 6.509 at sea level.
        assert!((density_factor(2.0, 1.0065) - 7.0944 / 6.50877).abs() < 0.012);
    }
}
