//! Rain in physical units, as pure functions and plain state: no ECS, no GPU, no clock.
//!
//! One module per phenomenon. State and ledgers are `f64`, per drop and per texel values `f32`;
//! SI units unless a name carries another one (`intensity_mm_h`, `diameter_mm`).
//! Transcendental functions go through [`ops`], so the same input gives the same bits on every platform.

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with std"))]

pub mod canopy;
pub mod constants;
pub mod cover;
pub mod error;
pub mod hash;
pub mod haze;
pub mod ops;
pub mod optics;
pub mod quadrature;
pub mod rainfall;
pub mod splash;
pub mod surface;
pub mod waves;
pub mod weather;
pub mod wheels;
