//! Air and the water in it: densities, viscosity, surface tension, the standard atmosphere.
//!
//! # Accuracy
//! Ideal gas with a constant gas constant (within 0.1 % in the lower atmosphere); viscosity within 1 % of the measured
//! values from −60 to 60 °C, and independent of pressure.

use crate::constants::{DRY_AIR_GAS_CONSTANT, SEA_LEVEL_PRESSURE_PA, STANDARD_TEMPERATURE_C, ZERO_CELSIUS_K};
use crate::error::{clamped, clamped_or};
use crate::ops;
use crate::weather::saturation_vapour_pressure_pa;

/// Density of moist air, ρ = (p − 0.378 e)/(287.05 T). Units: kg/m³.
///
/// `pressure_pa` in Pa, held in [1000, 120 000]; `temperature_c` in °C, held in [−90, 60]; `relative_humidity` in
/// [0, 1], held there. NaN counts as 101 325 Pa, 20 °C, 0. Source: ideal gas, Bolton 1980 for the vapour.
///
/// Error: 1e-15 against the formula; 0.1 % against nature.
#[must_use]
pub fn air_density_kg_m3(pressure_pa: f64, temperature_c: f64, relative_humidity: f64) -> f64 {
    let p = clamped_or(pressure_pa, 1000.0, 120_000.0, SEA_LEVEL_PRESSURE_PA);
    let t = clamped_or(temperature_c, -90.0, 60.0, STANDARD_TEMPERATURE_C);
    let vapour = clamped(relative_humidity, 0.0, 1.0) * saturation_vapour_pressure_pa(t.max(-60.0));
    // No more vapour than air: at 1000 Pa a warm saturated volume would be steam.
    (p - 0.378 * vapour.min(p)) / (DRY_AIR_GAS_CONSTANT * (t + ZERO_CELSIUS_K))
}

/// Dynamic viscosity of air, (1.718 + 0.0049 T)·10⁻⁵, less 1.2·10⁻¹⁰ T² below 0 °C. Units: Pa s.
///
/// `temperature_c` in °C, held in [−90, 60]; NaN counts as 20. Source: Pruppacher & Klett 1997.
///
/// Error: 1e-15 against the formula; 1 % against nature.
#[must_use]
pub fn air_viscosity_pa_s(temperature_c: f64) -> f64 {
    let t = clamped_or(temperature_c, -90.0, 60.0, STANDARD_TEMPERATURE_C);
    let cold = t.min(0.0);
    (1.718 + 0.0049 * t - 1.2e-5 * cold * cold) * 1e-5
}

/// Density of water at 1 atm, a ratio of polynomials. Units: kg/m³.
///
/// `temperature_c` in °C, held in [−30, 100]: supercooled drops are included, the ratio is singular near −59 °C. NaN
/// counts as 20. Source: Kell 1975.
///
/// Error: 1e-15 against the formula; 1e-5 against nature from 0 to 100 °C, 1e-3 at −30 °C.
#[must_use]
pub fn water_density_kg_m3(temperature_c: f64) -> f64 {
    const ABOVE: [f64; 6] = [
        999.839_52,
        16.945_176,
        -7.987_040_1e-3,
        -46.170_461e-6,
        105.563_02e-9,
        -280.542_53e-12,
    ];
    let t = clamped_or(temperature_c, -30.0, 100.0, STANDARD_TEMPERATURE_C);
    ABOVE.iter().rev().fold(0.0, |sum, c| sum * t + c) / (1.0 + 16.879_850e-3 * t)
}

/// Surface tension of water against air, 0.0761 − 1.55·10⁻⁴ T. Units: N/m.
///
/// `temperature_c` in °C, held in [−60, 60]; NaN counts as 20. Source: Pruppacher & Klett 1997.
///
/// Error: 1e-15 against the formula; 0.5 % against nature from 0 to 40 °C.
#[must_use]
pub fn water_surface_tension_n_m(temperature_c: f64) -> f64 {
    0.0761 - 1.55e-4 * clamped_or(temperature_c, -60.0, 60.0, STANDARD_TEMPERATURE_C)
}

/// Pressure and temperature of the standard atmosphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StandardAtmosphere {
    /// Units: Pa.
    pub pressure_pa: f64,
    /// Units: °C.
    pub temperature_c: f64,
}

impl StandardAtmosphere {
    /// At `height_m` above the sea, p = 101325 (1 − 0.0065 h/288.15)^5.25588, T = 15 − 0.0065 h °C.
    ///
    /// `height_m` in m, held in [−500, 11 000]; NaN counts as 0. Source: ISO 2533:1975.
    ///
    /// Error: 2e-15 against the formula; weather moves pressure by 5 % and temperature by tens of degrees.
    #[must_use]
    pub fn at(height_m: f64) -> Self {
        let h = clamped_or(height_m, -500.0, 11_000.0, 0.0);
        Self {
            pressure_pa: SEA_LEVEL_PRESSURE_PA * ops::pow(1.0 - 0.0065 * h / 288.15, 5.255_88),
            temperature_c: 15.0 - 0.0065 * h,
        }
    }
}
