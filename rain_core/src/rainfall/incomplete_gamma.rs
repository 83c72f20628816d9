//! The incomplete gamma function, for moments of gamma distributions.

use crate::ops;

/// Shares (P, Q) of ∫ tˢ⁻¹ e⁻ᵗ dt below and above `x`, P + Q = 1, the smaller one without cancellation.
///
/// `s` in (0, 60], `x` in [0, ∞]. Series below x = s + 1, continued fraction (Lentz) above: Abramowitz & Stegun 1964,
/// 6.5.29 and 6.5.31. Relative error below 1e-12.
pub(super) fn shares(s: f64, x: f64) -> (f64, f64) {
    if x <= 0.0 {
        return (0.0, 1.0);
    }
    if x == f64::INFINITY {
        return (1.0, 0.0);
    }
    let front = ops::exp(s * ops::ln(x) - x - ops::ln_gamma(s));
    if x < s + 1.0 {
        let mut term = 1.0 / s;
        let mut sum = term;
        let mut k = s;
        while term > 1e-17 * sum {
            k += 1.0;
            term *= x / k;
            sum += term;
        }
        let below = front * sum;
        return (below, 1.0 - below);
    }
    let mut b = x + 1.0 - s;
    let mut c = 1e300;
    let mut d = 1.0 / b;
    let mut fraction = d;
    for i in 1..500 {
        let i = f64::from(i);
        let a = -i * (i - s);
        b += 2.0;
        d = 1.0 / (a * d + b);
        c = b + a / c;
        let step = d * c;
        fraction *= step;
        if (step - 1.0).abs() < 1e-16 {
            break;
        }
    }
    let above = front * fraction;
    (1.0 - above, above)
}
