//! The only caller of transcendental functions: `libm`, so that results are equal bit for bit on every platform.

/// e^x.
#[must_use]
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}
/// e^x − 1 without cancellation.
#[must_use]
pub fn exp_m1(x: f64) -> f64 {
    libm::expm1(x)
}
/// Natural logarithm.
#[must_use]
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}
/// ln(1 + x) without cancellation.
#[must_use]
pub fn ln_1p(x: f64) -> f64 {
    libm::log1p(x)
}
/// x^y.
#[must_use]
pub fn pow(x: f64, y: f64) -> f64 {
    libm::pow(x, y)
}
/// Cube root.
#[must_use]
pub fn cbrt(x: f64) -> f64 {
    libm::cbrt(x)
}
/// Sine, x in radians.
#[must_use]
pub fn sin(x: f64) -> f64 {
    libm::sin(x)
}
/// Cosine, x in radians.
#[must_use]
pub fn cos(x: f64) -> f64 {
    libm::cos(x)
}
/// Tangent, x in radians.
#[must_use]
pub fn tan(x: f64) -> f64 {
    libm::tan(x)
}
/// Angle of (x, y), radians in (−π, π].
#[must_use]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}
/// Square root (IEEE exact, so `std`'s is the same everywhere).
#[must_use]
pub fn sqrt(x: f64) -> f64 {
    x.sqrt()
}
/// e^x in single precision.
#[must_use]
pub fn expf(x: f32) -> f32 {
    libm::expf(x)
}
/// Natural logarithm in single precision.
#[must_use]
pub fn lnf(x: f32) -> f32 {
    libm::logf(x)
}
/// Angle in [−π/2, π/2] whose sine is x.
#[must_use]
pub fn asin(x: f64) -> f64 {
    libm::asin(x)
}
/// Angle in [0, π] whose cosine is x.
#[must_use]
pub fn acos(x: f64) -> f64 {
    libm::acos(x)
}
/// Arc sine in single precision, radians.
#[must_use]
pub fn asinf(x: f32) -> f32 {
    libm::asinf(x)
}
/// Arc cosine in single precision, radians.
#[must_use]
pub fn acosf(x: f32) -> f32 {
    libm::acosf(x)
}
/// Hyperbolic tangent; ±1 for large arguments.
#[must_use]
pub fn tanh(x: f64) -> f64 {
    libm::tanh(x)
}
/// Hyperbolic tangent in single precision; ±1 for large arguments.
#[must_use]
pub fn tanhf(x: f32) -> f32 {
    libm::tanhf(x)
}
/// e^x − 1 without cancellation, in single precision.
#[must_use]
pub fn exp_m1f(x: f32) -> f32 {
    libm::expm1f(x)
}
/// ln(1 + x) without cancellation, in single precision.
#[must_use]
pub fn ln_1pf(x: f32) -> f32 {
    libm::log1pf(x)
}
/// Cube root in single precision.
#[must_use]
pub fn cbrtf(x: f32) -> f32 {
    libm::cbrtf(x)
}
/// Natural logarithm of |Γ(x)|.
#[must_use]
pub fn ln_gamma(x: f64) -> f64 {
    libm::lgamma(x)
}
/// Error function.
#[must_use]
pub fn erf(x: f64) -> f64 {
    libm::erf(x)
}
