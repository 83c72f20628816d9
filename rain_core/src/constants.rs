//! Physical constants: the only place where a number of nature is born.

/// Standard gravity. Units: m/s².
pub const GRAVITY: f64 = 9.806_65;
/// Density of water at 20 °C. Units: kg/m³. Source: Kell 1975.
pub const WATER_DENSITY: f64 = 998.2;
/// Density of dry air at 20 °C and 101325 Pa. Units: kg/m³.
pub const AIR_DENSITY: f64 = 1.2041;
/// Sea-level pressure. Units: Pa.
pub const SEA_LEVEL_PRESSURE_PA: f64 = 101_325.0;
/// Refractive index of water at 589 nm. Units: none.
pub const WATER_IOR: f64 = 1.333;
/// 1 mm/h in m/s.
pub const M_S_PER_MM_H: f64 = 1.0 / 3.6e6;
/// Gas constant of dry air. Units: J/(kg K).
pub const DRY_AIR_GAS_CONSTANT: f64 = 287.05;
/// 0 °C. Units: K.
pub const ZERO_CELSIUS_K: f64 = 273.15;
/// Temperature at which [`AIR_DENSITY`] holds and Gunn & Kinzer measured. Units: °C.
pub const STANDARD_TEMPERATURE_C: f64 = 20.0;
/// Surface tension of water against air at 20 °C, as drops, waves and splashes use it. Units: N/m. Source: Pruppacher &
/// Klett 1997, rounded.
pub const WATER_SURFACE_TENSION: f64 = 0.0728;
/// Dynamic viscosity of water at 20 °C. Units: Pa s. Source: Pruppacher & Klett 1997.
pub const WATER_VISCOSITY: f64 = 1.002e-3;
/// Von Kármán's constant κ of turbulent boundary layers. Units: none. Source: Stull 1988.
pub const VON_KARMAN: f64 = 0.4;
/// Kinematic viscosity of water at 20 °C. Units: m²/s. Source: Pruppacher & Klett 1997.
pub const WATER_KINEMATIC_VISCOSITY: f64 = 1.004e-6;
