//! The film under constant supply and drain, for any time at once: dw/dt = s − κ w^(5/3).
//!
//! With w = e u³, e = (|s|/κ)^(3/5) and T = |s| t/e the film runs along F(u) = ∫ 3u²/(1 − u⁵) du: F(u) = F(u₀) + T
//! under supply (s > 0), and along −F(−u) downwards to 0 under loss (s < 0). Partial fractions over the fifth roots of
//! one give F in logarithms and arc tangents; below |u| = 1/4 its series does not cancel.

use crate::ops;

/// cos and sin of 72° and 144°.
const ROOTS: [(f64, f64); 2] = [
    (0.309_016_994_374_947_45, 0.951_056_516_295_153_5),
    (-0.809_016_994_374_947_5, 0.587_785_252_292_473_1),
];

/// F(u), with ln|1 − u| given: close to 1 only the caller still has it.
fn course(u: f64, ln_gap: f64) -> f64 {
    if u.abs() < 0.25 {
        let fifth = u * u * u * u * u;
        let mut term = 3.0 * u * u * u;
        let (mut sum, mut n) = (0.0_f64, 3.0);
        while term.abs() > 1e-18 * sum.abs() {
            sum += term / n;
            term *= fifth;
            n += 5.0;
        }
        return sum;
    }
    let mut sum = -0.6 * ln_gap;
    for (cos, sin) in ROOTS {
        let (cos2, sin2) = (cos * cos - sin * sin, 2.0 * sin * cos);
        let ln = 0.5 * ops::ln(1.0 - 2.0 * u * cos + u * u);
        let angle = ops::atan2(u * sin, 1.0 - u * cos);
        sum -= 1.2 * (cos2 * ln + sin2 * angle);
    }
    sum
}

/// u after T under supply, from u₀ ≠ 1. Error: 1e-9 relative against a sum.
///
/// v = −ln|1 − u| runs to infinity as u goes to 1 from either side, and F over v is convex with a slope of at most 0.6:
/// from the second step on Newton falls to the root.
pub(super) fn towards_equilibrium(u0: f64, time: f64) -> f64 {
    let (sign, v0) = if u0 < 1.0 {
        (-1.0, -ops::ln_1p(-u0))
    } else {
        (1.0, -ops::ln(u0 - 1.0))
    };
    let at = |v: f64| {
        if sign < 0.0 {
            -ops::exp_m1(-v)
        } else {
            1.0 + ops::exp(-v)
        }
    };
    let goal = course(u0, -v0) + time;
    // Without drain the film would be higher.
    let above = ops::cbrt(u0 * u0 * u0 + time);
    let mut v = if sign < 0.0 && above < 0.9 {
        -ops::ln_1p(-above)
    } else {
        v0.max(goal / 0.6).max(1.0)
    };
    for _ in 0..40 {
        let u = at(v);
        let slope = 3.0 * u * u / (1.0 + u * (1.0 + u * (1.0 + u * (1.0 + u))));
        let step = (course(u, -v) - goal) / slope;
        v -= step;
        if step.abs() <= 2e-16 * v.abs() {
            break;
        }
    }
    at(v)
}

/// u after T under loss, or the T at which the film is gone. Error: 1e-9 relative against a sum.
pub(super) fn towards_nothing(u0: f64, time: f64) -> Result<f64, f64> {
    let fall = |u: f64| -course(-u, ops::ln_1p(u));
    let whole = fall(u0);
    let goal = whole - time;
    if goal <= 0.0 {
        return Err(whole);
    }
    // The fall is at most u³.
    let (mut low, mut high) = (ops::cbrt(goal).min(u0), u0);
    let mut u = low;
    for _ in 0..100 {
        let off = fall(u) - goal;
        if off > 0.0 {
            high = u
        } else {
            low = u
        }
        let fifth = u * u * u * u * u;
        let next = u - off * (1.0 + fifth) / (3.0 * u * u);
        let next = if next >= low && next <= high {
            next
        } else {
            0.5 * (low + high)
        };
        let done = (next - u).abs() <= 2e-16 * u;
        u = next;
        if done {
            break;
        }
    }
    Ok(u)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// T from u to w by Simpson's rule.
    fn time(from: f64, to: f64, sign: f64) -> f64 {
        let n = 20_000;
        let h = (to - from) / f64::from(2 * n);
        let f = |u: f64| 3.0 * u * u / (1.0 + sign * u.powi(5));
        let inner: f64 = (1..2 * n)
            .map(|i| f(from + h * f64::from(i)) * if i % 2 == 1 { 4.0 } else { 2.0 })
            .sum();
        (f(from) + f(to) + inner) * h / 3.0
    }

    #[test]
    fn the_course_is_its_integral() {
        for (from, to) in [
            (0.0, 0.1),
            (0.0, 0.24),
            (0.1, 0.9),
            (0.9, 0.99),
            (9.0, 1.5),
            (1.5, 1.01),
            (60.0, 2.0),
        ] {
            let t = time(from, to, -1.0);
            let u = towards_equilibrium(from, t);
            assert!((u - to).abs() < 1e-9 * to, "{from} {to}: {u}");
        }
        for (from, to) in [(0.2, 0.1), (0.9, 0.01), (5.0, 0.5), (60.0, 30.0)] {
            let u = towards_nothing(from, time(to, from, 1.0)).expect("not yet gone");
            assert!((u - to).abs() < 1e-9 * to, "{from} {to}: {u}");
        }
        let gone = towards_nothing(2.0, 9.0).expect_err("gone");
        assert!((gone - time(0.0, 2.0, 1.0)).abs() < 1e-11);
        assert!(towards_equilibrium(0.3, 1e9) == 1.0 && towards_equilibrium(30.0, 1e9) == 1.0);
    }
}
