//! ∫ e^(−ΛD) D³ v(D) dD over all diameters with the fall-speed fit, in closed form.

use super::terminal_velocity::{FIT, MAX_FITTED_DIAMETER_MM, fitted};
use crate::ops;

/// Terms of v as a polynomial in s = D/5.8 mm, from s to s⁹.
const TERMS: usize = FIT.len();

/// v(s) = Σ SPEED[j] s^(j+1), m/s.
const SPEED: [f64; TERMS] = speed();

/// Highest power in the integrand: D³ times the last term.
const HIGHEST: usize = 3 + TERMS;

/// Up to this ΛD₁ the powers go down from a series, beyond it up from the exponential: each where it does not cancel.
const UPWARD: f64 = 12.0;

/// Terms of the series: at ΛD₁ = 12 the last is below 1e-16 of the sum.
const SERIES: usize = 64;

/// The fit's polynomial in t = D/3 − 1, written out in powers of s by Horner's rule.
const fn speed() -> [f64; TERMS] {
    // t = a s − 1.
    let a = MAX_FITTED_DIAMETER_MM / 3.0;
    let mut sum = [0.0; TERMS];
    let mut i = TERMS;
    while i > 0 {
        i -= 1;
        let mut next = [0.0; TERMS];
        let mut k = 0;
        while k < TERMS {
            next[k] -= sum[k];
            if k + 1 < TERMS {
                next[k + 1] += a * sum[k];
            }
            k += 1;
        }
        next[0] += FIT[i];
        sum = next;
    }
    // v = D · sum.
    let mut k = 0;
    while k < TERMS {
        sum[k] *= MAX_FITTED_DIAMETER_MM;
        k += 1;
    }
    sum
}

/// 1/i.
const RECIPROCAL: [f64; HIGHEST + SERIES + 2] = {
    let mut table = [0.0; HIGHEST + SERIES + 2];
    let mut i = 1;
    while i < table.len() {
        table[i] = 1.0 / i as f64;
        i += 1;
    }
    table
};

/// y_k = ∫₀¹ e^(−xs) sᵏ ds for k = 0 … 12, `decay` = e^(−x), x > 0.
fn power_integrals(x: f64, decay: f64) -> [f64; HIGHEST + 1] {
    let mut y = [0.0; HIGHEST + 1];
    if x > UPWARD {
        y[0] = (1.0 - decay) / x;
        let inverse = 1.0 / x;
        for k in 1..=HIGHEST {
            y[k] = (k as f64 * y[k - 1] - decay) * inverse;
        }
    } else {
        let (mut term, mut sum) = (RECIPROCAL[HIGHEST + 1], RECIPROCAL[HIGHEST + 1]);
        for reciprocal in &RECIPROCAL[HIGHEST + 2..] {
            term *= x * reciprocal;
            sum += term;
            if term < 1e-17 * sum {
                break;
            }
        }
        y[HIGHEST] = decay * sum;
        for k in (1..=HIGHEST).rev() {
            y[k - 1] = (x * y[k] + decay) * RECIPROCAL[k];
        }
    }
    y
}

/// ∫₀^∞ e^(−ΛD) D³ v(D) dD with [`super::terminal_velocity`], mm and m/s; `slope` in mm⁻¹, above 0.
///
/// Error: 1e-12 relative against quadrature for slopes from 0.3 to 100.
pub(super) fn fit_flux(slope: f64) -> f64 {
    let end = MAX_FITTED_DIAMETER_MM;
    let x = slope * end;
    let decay = ops::exp(-x);
    let y = power_integrals(x, decay);
    let below: f64 = SPEED.iter().zip(&y[4..]).map(|(speed, y)| speed * y).sum();
    // Beyond the fit's end the speed is constant: e^(−x) (x³ + 3x² + 6x + 6)/Λ⁴.
    let square = slope * slope;
    let above = fitted(end) * decay * (6.0 + x * (6.0 + x * (3.0 + x))) / (square * square);
    end * end * end * end * below + above
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quadrature::GaussLegendre;
    use crate::rainfall::terminal_velocity;

    #[test]
    fn the_closed_form_is_the_quadrature() {
        let mut compared = 0;
        for i in 0..=400 {
            let slope = 0.3 * (100.0_f64 / 0.3).powf(f64::from(i) / 400.0);
            let integrand = |d: f64| (-slope * d).exp() * d * d * d * terminal_velocity(d);
            let rule = GaussLegendre::<32>::RULE;
            let end = MAX_FITTED_DIAMETER_MM;
            let sum = rule.integrate_panels(0.0, end, 40, integrand)
                + rule.integrate_panels(end, end + 60.0 / slope, 40, integrand);
            let error = (fit_flux(slope) / sum - 1.0).abs();
            assert!(error < 1e-12, "slope {slope}: {error:e}");
            compared += 1;
        }
        assert_eq!(compared, 401);
    }
}
