//! Rain in physical units, as pure functions and plain state: no ECS, no GPU, no clock.
//!
//! One module per phenomenon. State and ledgers are `f64`, per drop and per texel values `f32`;
//! SI units unless a name carries another one (`intensity_mm_h`, `diameter_mm`).
//! Transcendental functions go through [`ops`], so the same input gives the same bits on every platform.
//!
//! ```
//! use rain_core::rainfall::{Distribution, Spectrum, terminal_velocity};
//! use rain_core::surface::basins::{BakeOptions, BasinForcing, BasinRun, Basins, Grid};
//!
//! let rain = Spectrum::new(Distribution::MarshallPalmer, 25.0)?;
//! assert!((1e3 * rain.extinction_per_m(0.0, f64::INFINITY) - 1.22).abs() < 0.01); // 1/km
//! assert!((terminal_velocity(2.0) - 6.516).abs() < 1e-3); // m/s
//!
//! let heights = [1.0, 1.0, 1.0, 1.0, 0.9, 1.0, 1.0, 1.0, 1.0];
//! let basins = Basins::bake(&Grid::new(3, 3, 1.0, &heights), &BakeOptions::default())?;
//! let mut water = BasinRun::new(basins.into());
//! water.advance(&BasinForcing::rain(25.0 / 3.6e6), 3600.0)?; // 25 mm/h for an hour
//! assert!(water.volume_m3(0) > 0.025 && water.volume_m3(0) <= 0.1); // m³
//! assert!(water.ledger().residual_relative < 1e-12);
//! # Ok::<(), rain_core::error::ConfigError>(())
//! ```

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with std"))]

pub mod canopy;
pub mod constants;
pub mod cover;
pub mod error;
pub mod hash;
pub mod haze;
pub mod lens;
pub mod lightning;
pub mod ops;
pub mod optics;
pub mod quadrature;
pub mod rainfall;
pub mod sound;
pub mod splash;
pub mod spout;
pub mod surface;
mod table_lines;
pub mod waves;
pub mod weather;
pub mod wheels;
