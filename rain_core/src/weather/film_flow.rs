//! The film above the texture: dw/dt = supply − infiltration(t) − κ w^(5/3).
//!
//! # Method and error
//! Dormand & Prince 1980, orders 5(4) with the error of the lower order held below [`TOLERANCE`]·max(w, 1e-3 mm) per
//! step; the higher order is kept. The right side falls with w (its slope is −5/3 κ w^(2/3) ≤ 0), so two solutions
//! never move apart: local errors add at most, and the error after n steps is below n·tolerance. Steps shrink by
//! themselves at w → 0, where w^(5/3) is not smooth. Over long times without soil the closed form of `film_course` is
//! taken. Pure drain is exact, w = (w₀^(−2/3) + ⅔ κ t)^(−3/2). Close to equilibrium the deviation δ decays as e^(−λt);
//! δ ≤ 6e-7 w there, and what is left out is of the order (δ/w)².

use super::film_course::{towards_equilibrium, towards_nothing};
use super::horton::HortonCurve;
use crate::ops;

/// Error allowed per step, relative to max(w, 1e-3 mm).
const TOLERANCE: f64 = 1e-11;
/// Below this film the tolerance no longer shrinks. Units: mm.
const TOLERANCE_FLOOR_MM: f64 = 1e-3;

/// Decay times beyond which the closed form is cheaper than steps.
const LONG: f64 = 0.3;

/// Supply and drain that differ by less than this share are close to equilibrium.
const NEAR_EQUILIBRIUM: f64 = 1e-6;

/// A film under constant supply. Depths in mm, rates in mm/s.
#[derive(Debug, Clone, Copy)]
pub(super) struct FilmFlow {
    /// Rain less evaporation.
    pub supply: f64,
    /// κ of the drain.
    pub drain: f64,
    /// Infiltration, and τ at the start.
    pub soil: Option<(HortonCurve, f64)>,
}

/// Where a film came to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FilmStep {
    /// Time used, s: all that was asked for, or less when the film ran out.
    pub time: f64,
    /// Film at the end, mm; 0 when it ran out.
    pub film: f64,
}

impl FilmFlow {
    /// Runs from film `w` ≥ 0 for `duration` > 0, or until the film is gone. Error: 1e-9 (or of 1e-12 mm) between any
    /// two cuts; where no closed form serves, at most 1e-11 a step (of at least 1e-3 mm).
    pub(super) fn run(&self, w: f64, duration: f64) -> FilmStep {
        if let Some(film) = self.exact(w, duration, 0.0) {
            return FilmStep { time: duration, film };
        }
        let mut t = 0.0;
        let mut w = w;
        // The first step is a guess: a twentieth of the time scale that the film will have.
        let ahead = w + self.supply.max(0.0) * duration;
        let stiffness = 5.0 / 3.0 * self.drain * cbrt_square(ahead);
        if stiffness * duration > LONG
            && let Some(step) = self.course(w, duration)
        {
            return step;
        }
        let mut step = duration.min(if stiffness > 0.0 { 0.05 / stiffness } else { duration });
        loop {
            let left = duration - t;
            let last = step >= left;
            let h = if last { left } else { step };
            let (next, error) = self.stage(t, w, h);
            let allowed = TOLERANCE * w.max(next).max(TOLERANCE_FLOOR_MM);
            // !(a <= b) rather than a > b, so that an overflow is retried with a smaller step too.
            #[allow(clippy::neg_cmp_op_on_partial_ord, reason = "NaN must count as too large")]
            if !(error <= allowed) && h > 1e-9 * duration {
                step = h * (0.9 * ops::pow(allowed / error, 0.2)).clamp(0.1, 0.9);
                continue;
            }
            if next <= 0.0 && self.rate(t + h, 0.0) < 0.0 {
                let used = self.time_to_empty(t, w, h);
                return FilmStep {
                    time: (t + used).min(duration),
                    film: 0.0,
                };
            }
            w = next.max(0.0);
            t += h;
            if last {
                return FilmStep {
                    time: duration,
                    film: w,
                };
            }
            if let Some(film) = self.exact(w, duration - t, t) {
                return FilmStep { time: duration, film };
            }
            let growth = if error > 0.0 {
                0.9 * ops::pow(allowed / error, 0.2)
            } else {
                5.0
            };
            step = h * growth.clamp(0.2, 5.0);
        }
    }

    /// The film after `left`, where a closed form is at hand.
    fn exact(&self, w: f64, left: f64, t: f64) -> Option<f64> {
        let net = match self.soil {
            None => self.supply,
            Some((curve, tau)) => {
                let capacity = curve.capacity(tau + t);
                if capacity - curve.floor > 1e-15 * capacity {
                    return None;
                }
                self.supply - curve.floor
            }
        };
        if self.drain == 0.0 && net >= 0.0 {
            return Some(w + net * left);
        }
        if net == 0.0 {
            if w == 0.0 {
                return Some(0.0);
            }
            let c = ops::cbrt(w);
            let x = 1.0 / (c * c) + 2.0 / 3.0 * self.drain * left;
            return Some(1.0 / (x * ops::sqrt(x)));
        }
        let residual = net - self.drain * w * cbrt_square(w);
        if net <= 0.0 || residual.abs() > NEAR_EQUILIBRIUM * net {
            return None;
        }
        let equilibrium = ops::pow(net / self.drain, 0.6);
        let decay = 5.0 / 3.0 * net / equilibrium;
        Some(equilibrium + (w - equilibrium) * ops::exp(-decay * left))
    }

    /// The closed form for constant supply; dear, but as much for any time.
    fn course(&self, w: f64, duration: f64) -> Option<FilmStep> {
        if self.soil.is_some() || self.supply == 0.0 || self.drain == 0.0 {
            return None;
        }
        let scale = ops::pow(self.supply.abs() / self.drain, 0.6);
        let (u, time) = (ops::cbrt(w / scale), self.supply.abs() * duration / scale);
        // Far above the scale the course is nearly a pure drain, and the closed form cancels.
        if u.is_nan() || u >= 50.0 || u == 1.0 {
            return None;
        }
        let end = if self.supply > 0.0 {
            towards_equilibrium(u, time)
        } else {
            match towards_nothing(u, time) {
                Ok(end) => end,
                Err(gone) => {
                    return Some(FilmStep {
                        time: (gone * scale / -self.supply).min(duration),
                        film: 0.0,
                    });
                }
            }
        };
        Some(FilmStep {
            time: duration,
            film: scale * end * end * end,
        })
    }

    fn rate(&self, t: f64, w: f64) -> f64 {
        let soaked = self.soil.map_or(0.0, |(curve, tau)| curve.capacity(tau + t));
        let w = w.max(0.0);
        self.supply - soaked - self.drain * w * cbrt_square(w)
    }

    /// One Dormand–Prince step; the film after it (maybe negative) and the error estimate.
    fn stage(&self, t: f64, w: f64, h: f64) -> (f64, f64) {
        let k1 = self.rate(t, w);
        let k2 = self.rate(t + h / 5.0, w + h * (k1 / 5.0));
        let k3 = self.rate(t + h * 0.3, w + h * (3.0 / 40.0 * k1 + 9.0 / 40.0 * k2));
        let k4 = self.rate(
            t + h * 0.8,
            w + h * (44.0 / 45.0 * k1 - 56.0 / 15.0 * k2 + 32.0 / 9.0 * k3),
        );
        let k5 = self.rate(
            t + h * (8.0 / 9.0),
            w + h * (19372.0 / 6561.0 * k1 - 25360.0 / 2187.0 * k2 + 64448.0 / 6561.0 * k3 - 212.0 / 729.0 * k4),
        );
        let k6 = self.rate(
            t + h,
            w + h
                * (9017.0 / 3168.0 * k1 - 355.0 / 33.0 * k2 + 46732.0 / 5247.0 * k3 + 49.0 / 176.0 * k4
                    - 5103.0 / 18656.0 * k5),
        );
        let next = w + h
            * (35.0 / 384.0 * k1 + 500.0 / 1113.0 * k3 + 125.0 / 192.0 * k4 - 2187.0 / 6784.0 * k5 + 11.0 / 84.0 * k6);
        let k7 = self.rate(t + h, next);
        let error = h
            * (71.0 / 57600.0 * k1 - 71.0 / 16695.0 * k3 + 71.0 / 1920.0 * k4 - 17253.0 / 339_200.0 * k5
                + 22.0 / 525.0 * k6
                - 1.0 / 40.0 * k7);
        (next, error.abs())
    }

    /// The part of the step `h` after which the film is gone: regula falsi (Illinois) on the length of one step.
    fn time_to_empty(&self, t: f64, w: f64, h: f64) -> f64 {
        let (mut low, mut film_low) = (0.0, w);
        let (mut high, mut film_high) = (h, self.stage(t, w, h).0);
        let mut kept_low = None;
        for _ in 0..80 {
            if high - low <= 1e-15 * h || film_low <= 0.0 || film_high >= 0.0 {
                break;
            }
            let middle = low + (high - low) * film_low / (film_low - film_high);
            let (film, _) = self.stage(t, w, middle);
            if film > 0.0 {
                (low, film_low) = (middle, film);
                if kept_low == Some(false) {
                    film_high *= 0.5;
                }
                kept_low = Some(false);
            } else {
                (high, film_high) = (middle, film);
                if kept_low == Some(true) {
                    film_low *= 0.5;
                }
                kept_low = Some(true);
            }
        }
        high
    }
}

/// w^(2/3) for w ≥ 0.
fn cbrt_square(w: f64) -> f64 {
    let c = ops::cbrt(w);
    c * c
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flow(supply: f64, k_si: f64) -> FilmFlow {
        FilmFlow {
            supply,
            drain: k_si / 100.0,
            soil: None,
        }
    }

    #[test]
    fn pure_drain_check_values() {
        assert!((flow(0.0, 1.0).run(1.0, 10.0).film - 0.907_730_5).abs() < 5e-8);
        assert!((flow(0.0, 0.5).run(2.0, 60.0).film - 1.322_555_3).abs() < 5e-8);
        assert_eq!(flow(0.0, 1.0).run(0.0, 10.0).film, 0.0);
    }

    #[test]
    fn rising_film_check_value() {
        // P = 1e-5 m/s, k = 1.8856: exact film after 60 s, and the equilibrium.
        let f = flow(1e-2, 1.8856);
        assert!(
            (f.run(0.0, 60.0).film - 0.462_084_741_8).abs() < 1e-9,
            "{}",
            f.run(0.0, 60.0).film
        );
        assert!((f.run(0.0, 1e5).film - 0.683_487_0).abs() < 5e-8);
        assert!(
            (f.run(5.0, 1e8).film - 0.683_487_0).abs() < 5e-8,
            "a long time costs no more"
        );
    }

    #[test]
    fn a_split_interval_ends_where_the_whole_one_does() {
        let curve = super::super::SurfaceClass::Grass.properties().infiltration.curve();
        for (start, supply, soil) in [
            (0.0, 0.0139, false),
            (2.0, -1e-3, false),
            (0.5, 0.03, true),
            (3.0, 1e-3, true),
        ] {
            let at = |t: f64| FilmFlow {
                supply,
                drain: 0.0188,
                soil: soil.then_some((curve, 1000.0 + t)),
            };
            let whole = at(0.0).run(start, 40.0);
            let mut w = start;
            let n = 40_000;
            for i in 0..n {
                w = at(f64::from(i) * 1e-3).run(w, 1e-3).film;
            }
            assert!((w - whole.film).abs() < 1e-9 * whole.film.max(1e-3), "{w} {whole:?}");
        }
    }

    #[test]
    fn errors_of_steps_add_at_most() {
        // A soil keeps the closed forms away; each call is one step of its own.
        let curve = super::super::SurfaceClass::Grass.properties().infiltration.curve();
        let (dt, supply, drain) = (0.02, 0.03, 0.0188);
        let rate = |t: f64, w: f64| supply - curve.capacity(1000.0 + t) - drain * w * cbrt_square(w);
        for start in [0.02, 0.5, 4.0] {
            let (mut w, mut fine) = (start, start);
            for n in 0..1000_u32 {
                let t = f64::from(n) * dt;
                let flow = FilmFlow {
                    supply,
                    drain,
                    soil: Some((curve, 1000.0 + t)),
                };
                w = flow.run(w, dt).film;
                // The classical rule of order 4, in steps twenty times as short: far below what is allowed.
                let h = dt / 20.0;
                for i in 0..20 {
                    let t = t + f64::from(i) * h;
                    let a = rate(t, fine);
                    let b = rate(t + 0.5 * h, fine + 0.5 * h * a);
                    let c = rate(t + 0.5 * h, fine + 0.5 * h * b);
                    let d = rate(t + h, fine + h * c);
                    fine += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
                }
                let allowed = 1e-11 * f64::from(n + 1);
                assert!((w - fine).abs() <= allowed * w.max(1e-3), "{start}, {n}: {w} {fine}");
            }
            // A rate 1e-6 off is told apart.
            let off = (fine - start).abs() * 1e-6;
            assert!(off > 1e-11 * 1000.0 * fine.max(1e-3), "{off}");
        }
    }

    #[test]
    fn the_film_runs_out_when_it_must() {
        // Without drain: w/(−supply) exactly.
        let f = FilmFlow {
            supply: -1e-3,
            drain: 0.0,
            soil: None,
        };
        let out = f.run(0.25, 1e3);
        assert!((out.time - 250.0).abs() < 1e-9 && out.film == 0.0, "{out:?}");
        // With drain: sooner, and what is left just before is small and positive.
        let f = flow(-1e-3, 1.8856);
        let out = f.run(0.25, 1e3);
        assert!(out.time < 250.0 && out.film == 0.0);
        let before = f.run(0.25, out.time - 1.0).film;
        assert!((before - 1e-3).abs() < 2e-5, "{before}");
    }
}
