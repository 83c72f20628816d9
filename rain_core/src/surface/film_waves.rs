//! Wavelets on a film that runs down sloping ground: how fast they move, how steep they are, and a pattern that is carried
//! along without a seam in time or space.
//!
//! A disturbance of a film that follows q = √S/n h^(5/3) moves as a kinematic wave, at dq/dh = 5/3 of the mean speed
//! (Lighthill & Whitham 1955). The pattern is noise moved by the flow in two phases that take turns, each faded out when
//! it starts anew (Vlachos 2010), with the noise drawn out across the flow: crests of roll waves lie across it.
//!
//! # Accuracy
//! The speed is that of Manning's law for the film's depth above the texture. The steepness and the lengths (some 0.06 and
//! 0.25 m) are a look: roll waves grow from a Froude number of 1.5 on (Manning), and drops disturb slower films too, so the
//! steepness rises smoothly up to there. The flow is taken as even over the way of one period.

use crate::constants::GRAVITY;
use crate::error::clamped;
use crate::hash::{pcg3d, unit_f32};
use crate::ops;

/// Time after which a phase starts anew. Units: s; a whole part of the period of the shaders' clock.
pub const FLOW_PERIOD_S: f64 = 2.0;
/// Cycles after which the patterns repeat; a power of two.
const CYCLES: u64 = 2048;
/// Points of the noise's lattices. Units: 1/m, powers of two.
const POINTS_PER_M: [f64; 2] = [8.0, 32.0];
/// Their shares of the variance.
const SHARES: [f64; 2] = [0.6, 0.4];
/// The lattices repeat after so many points.
const PERIOD: i64 = 4096;
/// Root mean square of the sum of the noise's slopes along the flow at three places a point apart across it. Units: 1/point.
pub const FLOW_NOISE: f64 = 0.81;
/// Root mean square slope of fully grown wavelets. Chosen.
const STEEPEST: f64 = 0.05;
/// Froude number from which roll waves grow on a film after Manning's law.
const ROLL_WAVE_FROUDE: f64 = 1.5;
/// Film above the texture on which wavelets have their full steepness. Chosen. Units: mm.
const FULL_FILM_MM: f64 = 0.2;

/// Speed of wavelets on a film of 1 mm above the texture down a vertical face, 5/3 · 0.001^(2/3)/n: what shaders multiply by
/// h^(2/3) √S, h in mm. Units: m/s. n is held in [0.001, 10] s/m^(1/3).
/// Error: 1e-12 relative; that of Manning's law.
#[must_use]
pub fn film_wave_speed_of_mm(manning_n: f64) -> f64 {
    5.0 / 3.0 * 0.01 / clamped(manning_n, 1e-3, 10.0)
}

/// Velocity along x and z of wavelets on a film of `film_mm` above the texture that runs down a face with this normal (unit,
/// y up): 5/3 of Manning's mean speed h^(2/3) √S/n with S the sine of the slope, down the fall line, seen from above.
/// Units: m/s. 0 on level ground, on faces that look down, without a film and for what is not finite; films above 1000 mm
/// count as that, n is held in [0.001, 10] s/m^(1/3).
/// Error: 1e-12 relative; that of Manning's law.
#[must_use]
pub fn film_wave_velocity(normal: [f64; 3], film_mm: f64, manning_n: f64) -> [f64; 2] {
    let [x, y, z] = normal;
    let sine = ops::sqrt(x * x + z * z);
    let film = clamped(film_mm, 0.0, 1e3);
    // NaN fails all of these.
    if !(sine > 0.0 && y > 0.0 && film > 0.0 && sine.is_finite() && y.is_finite()) {
        return [0.0; 2];
    }
    let root = ops::cbrt(film);
    let speed = film_wave_speed_of_mm(manning_n) * root * root * ops::sqrt(sine);
    [x, z].map(|part| part / sine * speed * y)
}

/// Root mean square slope of the wavelets on a film that moves them with `wave_speed_m_s`: grows with the Froude number
/// of the flow, up to 0.05 at 1.5, and with the film up to 0.2 mm. Units: none. What is not a number counts as 0.
/// Error: 1e-12; a look.
#[must_use]
pub fn film_wave_slope(film_mm: f64, wave_speed_m_s: f64) -> f64 {
    let film = clamped(film_mm, 0.0, 1e3);
    if film <= 0.0 {
        return 0.0;
    }
    let froude = 0.6 * clamped(wave_speed_m_s, 0.0, 1e3) / ops::sqrt(1e-3 * GRAVITY * film);
    let t = (froude / ROLL_WAVE_FROUDE).min(1.0);
    STEEPEST * t * t * (3.0 - 2.0 * t) * (film / FULL_FILM_MM).min(1.0)
}

/// Slopes along x and z of wavelets of unit root mean square slope that this velocity (m/s) carries along. `footprint_m`:
/// width of what is to be resolved; shorter waves are left out. No waves at rest. The pattern repeats after 4096 s and in
/// 128 m. Places beyond ±1e6 m and what is not finite have none.
/// Error: 4 % in the root mean square slope; a look.
#[must_use]
pub fn film_wavelets(place_m: [f64; 2], time_s: f64, velocity_m_s: [f64; 2], footprint_m: f64) -> [f64; 2] {
    let speed = ops::sqrt(velocity_m_s[0] * velocity_m_s[0] + velocity_m_s[1] * velocity_m_s[1]);
    let near = place_m.iter().all(|p| p.abs() <= 1e6);
    if !(near && (0.0..=1e9).contains(&time_s) && speed > 0.0 && speed <= 1e3) {
        return [0.0; 2];
    }
    let along = velocity_m_s.map(|v| v / speed);
    let (mut sum, mut squares) = (0.0, 0.0);
    for phase in 0..2_u32 {
        let turns = time_s / FLOW_PERIOD_S + 0.5 * f64::from(phase);
        let part = turns.fract();
        let cycle = (turns as u64 % CYCLES) as u32;
        let weight = 1.0 - (2.0 * part - 1.0).abs();
        let time = (part - 0.5) * FLOW_PERIOD_S;
        let from = [0, 1].map(|i| place_m[i] - time * velocity_m_s[i]);
        sum += weight * crests(from, along, 2 * cycle + phase, footprint_m);
        squares += weight * weight;
    }
    along.map(|a| a * sum / ops::sqrt(squares))
}

/// Share of the octaves' slopes that can be told apart at this footprint.
fn resolved(points_per_m: f64, footprint_m: f64) -> f64 {
    let t = ((clamped(footprint_m, 0.0, 1e9) * points_per_m - 0.5) / 1.5).clamp(0.0, 1.0);
    1.0 - t * t * (3.0 - 2.0 * t)
}

/// Slope along the flow of both octaves.
fn crests(place: [f64; 2], along: [f64; 2], seed: u32, footprint_m: f64) -> f64 {
    let across = [-along[1], along[0]];
    let octaves = POINTS_PER_M.iter().zip(SHARES).zip([0, 4096]);
    let slopes = octaves.map(|((points, share), other)| {
        let at = |side: f64| [0, 1].map(|i| place[i] * points + side * across[i]);
        let samples = [-1.0, 0.0, 1.0].map(|side| {
            let [x, z] = noise_slope(at(side), seed + other);
            x * along[0] + z * along[1]
        });
        ops::sqrt(share) * resolved(*points, footprint_m) * samples.iter().sum::<f64>() / FLOW_NOISE
    });
    slopes.sum()
}

/// Slopes of value noise over the lattice of whole numbers.
fn noise_slope([x, z]: [f64; 2], seed: u32) -> [f64; 2] {
    let corner = |x: f64, z: f64| {
        let cell = [x, z].map(|at| (at as i64).rem_euclid(PERIOD) as u32);
        f64::from(unit_f32(pcg3d([cell[0], cell[1], seed])[0]))
    };
    let (x0, z0) = (x.floor(), z.floor());
    let fade = |f: f64| f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let slope = |f: f64| 30.0 * f * f * (f - 1.0) * (f - 1.0);
    let (fx, fz) = (x - x0, z - z0);
    let (a, b) = (corner(x0, z0), corner(x0 + 1.0, z0));
    let (c, d) = (corner(x0, z0 + 1.0), corner(x0 + 1.0, z0 + 1.0));
    let mix = |a: f64, b: f64, t: f64| a + t * (b - a);
    [
        slope(fx) * mix(b - a, d - c, fade(fz)),
        slope(fz) * mix(c - a, d - b, fade(fx)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    const N: f64 = 0.0125;

    /// Unit normal of ground that falls by this sine towards an angle from x to z.
    fn normal(sine: f64, angle: f64) -> [f64; 3] {
        [
            sine * ops::cos(angle),
            ops::sqrt(1.0 - sine * sine),
            sine * ops::sin(angle),
        ]
    }

    #[test]
    fn wavelets_run_down_the_fall_line_at_five_thirds_of_mannings_speed() {
        for (sine, film) in [(0.005, 0.2), (0.02, 0.5), (0.1, 1.0), (0.5, 3.0)] {
            for angle in [0.0, 1.0, 3.0, -2.0] {
                let found = film_wave_velocity(normal(sine, angle), film, N);
                let mean = ops::pow(1e-3 * film, 2.0 / 3.0) * ops::sqrt(sine) / N;
                let speed = 5.0 / 3.0 * mean * ops::sqrt(1.0 - sine * sine);
                let wanted = [speed * ops::cos(angle), speed * ops::sin(angle)];
                for (f, w) in found.iter().zip(wanted) {
                    assert!(
                        (f - w).abs() < 1e-12 * speed,
                        "{sine} {film} {angle}: {found:?}, not {wanted:?}"
                    );
                }
            }
        }
        // 2 % and half a millimetre: 0.119 m/s.
        assert!((film_wave_velocity(normal(0.02, 0.0), 0.5, N)[0] - 0.1188).abs() < 1e-3);
        let nan = f64::NAN;
        for (n, film) in [
            ([0.0, 1.0, 0.0], 1.0),
            (normal(0.1, 0.0), 0.0),
            (normal(0.1, 0.0), nan),
            ([0.5, -0.8, 0.0], 1.0),
            ([nan, 1.0, 0.0], 1.0),
            ([f64::INFINITY, 1.0, 0.0], 1.0),
        ] {
            assert_eq!(film_wave_velocity(n, film, N), [0.0; 2], "{n:?} {film}");
        }
    }

    #[test]
    fn wavelets_are_steeper_on_faster_films_and_none_stand_on_still_ones() {
        let at = |film: f64, froude: f64| film_wave_slope(film, froude * ops::sqrt(9.80665e-3 * film) / 0.6);
        assert!((at(0.5, 0.75) - 0.025).abs() < 1e-12, "{}", at(0.5, 0.75));
        assert!((at(0.1, 1.5) - 0.025).abs() < 1e-12 && (at(0.5, 9.0) - 0.05).abs() < 1e-12);
        assert_eq!((film_wave_slope(0.5, 0.0), film_wave_slope(0.0, 1.0)), (0.0, 0.0));
        assert_eq!(
            (film_wave_slope(f64::NAN, 1.0), film_wave_slope(0.5, f64::NAN)),
            (0.0, 0.0)
        );
        assert!((0..100).all(|i| at(0.4, f64::from(i) * 0.02) <= at(0.4, f64::from(i + 1) * 0.02)));
    }

    /// Root mean square of the slopes along a flow, and those across it.
    fn roughness(velocity: [f64; 2], time: f64, footprint: f64) -> [f64; 2] {
        let along = velocity.map(|v| v / ops::sqrt(velocity[0] * velocity[0] + velocity[1] * velocity[1]));
        let mut squares = [0.0; 2];
        for i in 0..20_000_u32 {
            let place = [f64::from(i % 200) * 0.171 - 20.0, f64::from(i / 200) * 0.1933 + 7.0];
            let s = film_wavelets(place, time, velocity, footprint);
            squares[0] += (s[0] * along[0] + s[1] * along[1]).powi(2) / 20_000.0;
            squares[1] += (s[1] * along[0] - s[0] * along[1]).powi(2) / 20_000.0;
        }
        squares.map(ops::sqrt)
    }

    #[test]
    fn wavelets_have_unit_slope_at_all_times_and_fade_with_the_footprint() {
        for (velocity, time) in [
            ([0.1, 0.0], 0.0),
            ([0.03, 0.07], 0.37),
            ([-0.2, 0.1], 0.5),
            ([0.0, -0.1], 4095.9),
        ] {
            let [along, across] = roughness(velocity, time, 0.0);
            assert!(
                (along - 1.0).abs() < 0.04 && across < 1e-9,
                "{velocity:?} {time}: {along} {across}"
            );
        }
        let shares = [0.0, 0.03, 0.1, 0.3].map(|footprint| roughness([0.1, 0.0], 0.3, footprint)[0]);
        assert!(shares.windows(2).all(|w| w[1] < w[0]) && shares[3] < 1e-9, "{shares:?}");
        for velocity in [[0.0; 2], [f64::NAN, 0.1], [1e4, 0.0]] {
            assert_eq!(film_wavelets([1.0, 2.0], 3.0, velocity, 0.0), [0.0; 2]);
        }
    }

    #[test]
    fn wavelets_move_with_the_flow_and_nothing_jumps() {
        let velocity = [0.08, -0.06];
        let row = |time: f64, shift: f64| -> Vec<f64> {
            (0..4000_u16)
                .map(|i| {
                    let along = f64::from(i) * 0.011 + shift;
                    film_wavelets([0.8 * along, 3.0 - 0.6 * along], time, velocity, 0.0)[0]
                })
                .collect()
        };
        let correlation = |a: &[f64], b: &[f64]| {
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            dot(a, b) / ops::sqrt(dot(a, a) * dot(b, b))
        };
        for time in [0.3, 1.1, 1.9, 4095.8] {
            // What is here now is 0.1 m/s · 0.2 s further on later.
            let (now, then) = (row(time, 0.0), row((time + 0.2) % 4096.0, 0.02));
            assert!(correlation(&now, &then) > 0.9, "{time}: {}", correlation(&now, &then));
            for wrong in [0.0, 0.04, -0.02] {
                let other = correlation(&now, &row((time + 0.2) % 4096.0, wrong));
                assert!(other < correlation(&now, &then) - 0.05, "{time} {wrong}: {other}");
            }
        }
        // A phase starts anew at whole seconds, where it has no weight; the clock's end is its start.
        for time in [1.0, 2.0, 3.0, 4096.0] {
            let (before, after) = (row(time - 1e-6, 0.0), row((time + 1e-6) % 4096.0, 0.0));
            let jump = before
                .iter()
                .zip(&after)
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f64::max);
            assert!(jump < 1e-4, "{time}: {jump}");
        }
    }
}
