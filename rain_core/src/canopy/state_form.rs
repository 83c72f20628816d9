//! The storage equation under constant rain and evaporation, solved exactly.
//!
//! With the stored depth C, the capacity S and y = √(1 − C/S): q = 1 − y of the intercepted rain R leaves the crown,
//! dC/dt = R y − E, so that dy/dt = −(R y − E)/(2 S y). In y_e = E/R, a = y₀ − y_e, k = R/(2S):
//!
//! - E = 0: y = max(0, y₀ − k t);
//! - E > 0: y = y_e + a e^(−r) with G(r) = a (1 − e^(−r)) + y_e r = k t.
//!
//! r ≥ 0 counts e-foldings towards the equilibrium, so no exponential grows, and the change y₀ − y = a (1 − e^(−r))
//! comes without cancellation. G is monotone and either concave (filling) or convex (drying): Newton's iteration cannot
//! miss, Halley's gets there in two or three steps.

use crate::ops;

/// Below this E/R evaporation no longer moves y by an amount that a double shows (its water is still counted).
const NEGLIGIBLE_EQUILIBRIUM: f64 = 1e-14;

/// The course of y from one moment on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Course {
    /// y at the start, in [0, 1].
    start: f64,
    /// 1 − y at the start, without cancellation.
    start_share: f64,
    /// k = R/(2S), 1/s.
    speed: f64,
    /// y_e = E/R.
    equilibrium: f64,
}

impl Course {
    /// `deficit` = S − C, `stored` = C and `capacity` = S in mm, `rain` > 0 and `evaporation` ≥ 0 in mm/s.
    pub(super) fn new(capacity: f64, stored: f64, deficit: f64, rain: f64, evaporation: f64) -> Self {
        let start = ops::sqrt(deficit.max(0.0) / capacity).min(1.0);
        Self {
            start,
            start_share: (stored / capacity / (1.0 + start)).clamp(0.0, 1.0),
            speed: rain / (2.0 * capacity),
            equilibrium: evaporation / rain,
        }
    }

    /// q = 1 − y at the start.
    pub(super) fn start_share(&self) -> f64 {
        self.start_share
    }

    /// y₀² − y² = (C − C₀)/S after a drop of y by `fall`.
    pub(super) fn gain(&self, fall: f64) -> f64 {
        fall * (2.0 * self.start - fall)
    }

    /// Whether evaporation is too small to matter to y.
    fn is_linear(&self) -> bool {
        self.equilibrium < NEGLIGIBLE_EQUILIBRIUM
    }

    /// a = y₀ − y_e.
    fn distance(&self) -> f64 {
        self.start - self.equilibrium
    }

    /// y₀ − y after `time` s: above 0 while the crown fills, below while it dries.
    pub(super) fn fall_after(&self, time: f64) -> f64 {
        if self.is_linear() {
            return (self.speed * time).min(self.start);
        }
        let a = self.distance();
        if a == 0.0 {
            return 0.0;
        }
        -a * ops::exp_m1(-self.foldings(self.speed * time))
    }

    /// Time until y has fallen by `fall`, s; infinite where it never does.
    pub(super) fn time_to_fall(&self, fall: f64) -> f64 {
        if fall == 0.0 {
            return 0.0;
        }
        if self.is_linear() {
            return if fall > 0.0 { fall / self.speed } else { f64::INFINITY };
        }
        let share = fall / self.distance();
        // The equilibrium itself is never reached, and what lies behind it or behind the start neither.
        if share > 0.0 && share < 1.0 {
            self.way(-ops::ln_1p(-share)) / self.speed
        } else {
            f64::INFINITY
        }
    }

    /// Time until the crown is empty, s; infinite where it never is.
    pub(super) fn time_to_empty(&self) -> f64 {
        if self.equilibrium < 1.0 {
            f64::INFINITY
        } else {
            self.time_to_fall(-self.start_share)
        }
    }

    /// G(r), as a sum of terms of one sign.
    fn way(&self, r: f64) -> f64 {
        self.way_with(r, ops::exp_m1(-r))
    }

    /// G(r) where e^(−r) − 1 is known.
    fn way_with(&self, r: f64, decay: f64) -> f64 {
        let a = self.distance();
        if a > 0.0 {
            self.equilibrium * r - a * decay
        } else {
            self.start * r - a * excess(r, decay)
        }
    }

    /// The r with G(r) = `way`.
    fn foldings(&self, way: f64) -> f64 {
        if way <= 0.0 {
            return 0.0;
        }
        let a = self.distance();
        let mut r = if a > 0.0 {
            self.filling_guess(way)
        } else {
            self.drying_guess(way)
        };
        // Halley's step triples the digits; where it would leave the curve's side, Newton's, which cannot miss.
        for _ in 0..60 {
            let decay = ops::exp_m1(-r);
            let bend = a * (1.0 + decay);
            let slope = self.equilibrium + bend;
            let newton = (way - self.way_with(r, decay)) / slope;
            let halley = 1.0 - 0.5 * newton * bend / slope;
            let step = if halley > 0.3 { newton / halley } else { newton };
            if !step.is_finite() {
                break;
            }
            r = (r + step).max(0.0);
            if step.abs() <= 1e-6 * r {
                break;
            }
        }
        r
    }

    /// Close to the root of a concave G: with x = a e^(−r)/y_e, x + ln x is known.
    fn filling_guess(&self, way: f64) -> f64 {
        let a = self.distance();
        let x0 = a / self.equilibrium;
        let level = x0 + ops::ln(x0) - way / self.equilibrium;
        let ln_x = if level > 1.0 {
            ops::ln(level - ops::ln(level))
        } else {
            level - ops::ln_1p(ops::exp(level))
        };
        (ops::ln(x0) - ln_x).max(way / self.start)
    }

    /// Not below the root of a convex G: G(r) ≥ y₀ r + |a| r²/(2 + r), solved for r.
    fn drying_guess(&self, way: f64) -> f64 {
        let b = 2.0 * self.start - way;
        let root = ops::sqrt(b * b + 8.0 * self.equilibrium * way);
        if b > 0.0 {
            4.0 * way / (b + root)
        } else {
            (root - b) / (2.0 * self.equilibrium)
        }
    }
}

/// r − 1 + e^(−r), r ≥ 0, without cancellation; `decay` = e^(−r) − 1.
fn excess(r: f64, decay: f64) -> f64 {
    if r > 0.3 {
        return r + decay;
    }
    // r²/2 − r³/6 + r⁴/24 …: the last term is below 1e-17 of the first.
    let mut sum = 0.0;
    for n in (2..=13).rev() {
        sum = 1.0 - sum * r / f64::from(n + 1);
    }
    0.5 * r * r * sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn excess_has_no_seam_and_no_noise() {
        for r in [1e-12, 1e-6, 1e-3, 0.1, 0.299_999_9, 0.300_000_1, 1.0, 5.0] {
            // The series in full.
            let mut term = -r;
            let mut exact = 0.0;
            for n in 2..200 {
                term *= -r / f64::from(n);
                exact += term;
            }
            assert!(
                (excess(r, ops::exp_m1(-r)) / exact - 1.0).abs() < 3e-15 * (1.0 + r * r * r),
                "{r}: {} {exact}",
                excess(r, ops::exp_m1(-r))
            );
        }
    }

    #[test]
    fn time_and_fall_are_inverse() {
        for (stored, evaporation) in [(0.0, 0.0), (0.0, 0.1), (0.5, 0.3), (0.6, 0.3), (0.3, 2.0), (0.6, 1e-9)] {
            let course = Course::new(0.6, stored, 0.6 - stored, 1.0, evaporation);
            for time in [1e-6, 1e-3, 0.1, 0.5] {
                let fall = course.fall_after(time);
                let back = course.time_to_fall(fall);
                // At rest: full, empty, or at the equilibrium.
                let stuck = fall == 0.0 || fall == course.start || (fall - course.distance()).abs() < 1e-12;
                assert!(
                    stuck || (back / time - 1.0).abs() < 1e-9,
                    "{stored} {evaporation} {time}: {back}"
                );
            }
        }
    }

    #[test]
    fn newtons_iteration_always_arrives() {
        for i in 0..=40 {
            let equilibrium = 10_f64.powf(-13.5 + 0.6 * f64::from(i));
            for start in [0.0, 1e-12, 1e-6, 0.01, 0.3, 0.9, 0.999_999, 1.0] {
                let course = Course {
                    start,
                    start_share: 1.0 - start,
                    speed: 1.0,
                    equilibrium,
                };
                for j in 0..=60 {
                    let way = 10_f64.powf(-12.0 + 0.3 * f64::from(j));
                    if course.distance() == 0.0 {
                        continue;
                    }
                    let back = course.way(course.foldings(way));
                    assert!(
                        (back / way - 1.0).abs() < 1e-14,
                        "{equilibrium:e} {start} {way:e}: {back:e}"
                    );
                }
            }
        }
    }
}
