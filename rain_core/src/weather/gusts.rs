//! Gusts: how the wind swings about its mean, as a closed form of the time.
//!
//! Along and across the mean wind the air's speed is a sum of sinusoids whose frequencies share Kaimal's spectrum evenly,
//! so speed, path and the lagging answer of falling drops are sums of sines too, at any time and without state.
//!
//! # Accuracy
//! Uniform in space: all drops sway together. No up- and downdraughts. 24 sinusoids an axis repeat after years, but a
//! spectrum of them has gaps.

use core::f64::consts::TAU;

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

use crate::error::{ConfigError, in_range};
use crate::hash::pcg3d;
use crate::ops;
use crate::rainfall::response_time_s;

/// Sinusoids of an axis.
const WAVES: usize = 24;
/// Part of Kaimal's spectrum that they stand for, and whose variance they carry: slower eddies are changes of the weather's
/// mean (over ten minutes by default), faster ones move no drop.
const COVERED: [f64; 2] = [0.1, 0.98];
/// Keeps gusts apart from the drops of the same seed.
const SALT: u32 = 0x4755_5354;

/// How strongly and how quickly the wind swings.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct GustSettings {
    /// Standard deviation along the mean wind over its speed. Units: none. Domain: [0, 0.5]. Default: 0.2; 0.18 over open
    /// country, 0.3 and more in towns (EN 1991-1-4).
    pub intensity: f64,
    /// The same across it, as a share of that along it. Units: none. Domain: [0, 1]. Default: 0.75.
    pub lateral: f64,
    /// Length of the eddies over the mean wind's speed. Units: s. Domain: [1, 120]. Default: 10: 80 m at 8 m/s.
    pub time_scale_s: f64,
}

impl Default for GustSettings {
    fn default() -> Self {
        Self {
            intensity: 0.2,
            lateral: 0.75,
            time_scale_s: 10.0,
        }
    }
}

impl GustSettings {
    /// These settings, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not finite or outside its domain.
    pub fn validated(self) -> Result<Self, ConfigError> {
        in_range("intensity", self.intensity, 0.0, 0.5, "0 to 0.5")?;
        in_range("lateral", self.lateral, 0.0, 1.0, "0 to 1")?;
        in_range("time_scale_s", self.time_scale_s, 1.0, 120.0, "1 to 120 s")?;
        Ok(self)
    }
}

/// Share of Kaimal's spectrum n S/σ² = 6.8 f/(1 + 10.2 f)^(5/3) below a reduced frequency f = n L/U:
/// 1 − (1 + 10.2 f)^(−2/3). Units: none.
///
/// `reduced_frequency`: none, held at 0 below; NaN counts as 0. Source: Kaimal et al. 1972, as in EN 1991-1-4.
///
/// Error: 1e-14 against the formula, 1e-6 against the spectrum integrated.
#[must_use]
pub fn kaimal_share(reduced_frequency: f64) -> f64 {
    let f = reduced_frequency.max(0.0);
    1.0 - ops::pow(1.0 + 10.2 * f, -2.0 / 3.0)
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Wave {
    /// Units: rad/s.
    omega: f64,
    /// Units: rad.
    phase: f64,
}

/// Gusts of a seed. Speeds are shares of the mean wind's: x along it, y across it, to the right of who looks along it from
/// above (from +X towards +Z).
///
/// Error: means 1e-6 against fine sums, of drops 1e-9 against the integrated law of
/// [`WindResponse`](crate::rainfall::WindResponse).
#[derive(Debug, Clone, PartialEq)]
pub struct GustModel {
    waves: [[Wave; WAVES]; 2],
    amplitudes: [f64; 2],
}

impl GustModel {
    /// Gusts of a seed.
    ///
    /// # Errors
    /// As [`GustSettings::validated`].
    pub fn new(settings: &GustSettings, seed: u64) -> Result<Self, ConfigError> {
        let settings = settings.validated()?;
        let key = pcg3d([seed as u32 ^ SALT, (seed >> 32) as u32, 0]);
        let waves = core::array::from_fn(|axis| {
            core::array::from_fn(|index| {
                let hash = pcg3d([key[0] ^ index as u32, key[1].wrapping_add(axis as u32), key[2]]);
                let unit = |h: u32| (f64::from(h) + 0.5) / 4_294_967_296.0;
                // An even share of the spectrum each, at a random place in it.
                let share = COVERED[0] + (COVERED[1] - COVERED[0]) * (index as f64 + unit(hash[0])) / WAVES as f64;
                let frequency = (ops::pow(1.0 - share, -1.5) - 1.0) / 10.2;
                Wave {
                    omega: TAU * frequency / settings.time_scale_s,
                    phase: TAU * unit(hash[1]),
                }
            })
        });
        let amplitude = settings.intensity * ops::sqrt(2.0 / WAVES as f64);
        Ok(Self {
            waves,
            amplitudes: [amplitude, settings.lateral * amplitude],
        })
    }

    /// The air's speed at a time, as shares of the mean wind's. `time_s`: s, finite.
    #[must_use]
    pub fn at(&self, time_s: f64) -> DVec2 {
        self.sum(|wave| ops::cos(wave.omega * time_s + wave.phase))
    }

    /// Mean over [from_s, to_s] of what a drop of this terminal speed (m/s; 0: the air itself) has of the gusts, as shares
    /// of the mean wind's: what the wind blows it along over that time. For an empty interval the speed at its start.
    #[must_use]
    pub fn mean(&self, from_s: f64, to_s: f64, terminal_m_s: f64) -> DVec2 {
        let lag = response_time_s(terminal_m_s);
        let middle = 0.5 * (from_s + to_s);
        let half = 0.5 * (to_s - from_s);
        self.sum(|wave| {
            let x = wave.omega * lag;
            let swing = wave.omega * half;
            // sin x / x of the interval: its mean, without cancellation.
            let kept = if swing.abs() < 1e-4 {
                1.0 - swing * swing / 6.0
            } else {
                ops::sin(swing) / swing
            };
            let phase = wave.omega * middle + wave.phase - ops::atan2(x, 1.0);
            kept * ops::cos(phase) / ops::sqrt(1.0 + x * x)
        })
    }

    /// A mean wind (m/s) with gusts, shares as [`GustModel::mean`] gives them, added to it.
    #[must_use]
    pub fn gusty(mean_wind_m_s: DVec3, share: DVec2) -> DVec3 {
        let across = DVec3::new(-mean_wind_m_s.z, 0.0, mean_wind_m_s.x);
        mean_wind_m_s + share.x * mean_wind_m_s.with_y(0.0) + share.y * across
    }

    fn sum(&self, of: impl Fn(&Wave) -> f64) -> DVec2 {
        let axis = |i: usize| self.amplitudes[i] * self.waves[i].iter().map(&of).sum::<f64>();
        DVec2::new(axis(0), axis(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_field_of_gusts_is_checked_and_named() {
        type Set = fn(&mut GustSettings, f64);
        let fields: [(&str, Set, f64, f64); 3] = [
            ("intensity", |s, v| s.intensity = v, 0.0, 0.5),
            ("lateral", |s, v| s.lateral = v, 0.0, 1.0),
            ("time_scale_s", |s, v| s.time_scale_s = v, 1.0, 120.0),
        ];
        for (name, set, min, max) in fields {
            for good in [min, max] {
                let mut settings = GustSettings::default();
                set(&mut settings, good);
                assert!(GustModel::new(&settings, 1).is_ok(), "{name} = {good}");
            }
            for bad in [min - 1e-6, max + 1e-6, f64::NAN, f64::INFINITY] {
                let mut settings = GustSettings::default();
                set(&mut settings, bad);
                let message = GustModel::new(&settings, 1).expect_err("out of the domain").to_string();
                assert!(message.starts_with(name), "{message}");
            }
        }
    }

    #[test]
    fn gusts_blow_along_and_across_the_wind() {
        let wind = DVec3::new(3.0, 0.5, 4.0);
        assert_eq!(GustModel::gusty(wind, DVec2::ZERO), wind);
        let along = GustModel::gusty(wind, DVec2::X) - wind;
        let across = GustModel::gusty(wind, DVec2::Y) - wind;
        assert_eq!((along, across), (DVec3::new(3.0, 0.0, 4.0), DVec3::new(-4.0, 0.0, 3.0)));
        assert_eq!(GustModel::gusty(DVec3::ZERO, DVec2::ONE), DVec3::ZERO);
    }
}
