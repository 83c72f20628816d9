//! Wipers: arms that swing about pivots, and when they last passed a place.

use core::f64::consts::{PI, TAU};

use serde::{Deserialize, Serialize};

use crate::error::{ConfigError, clamped, in_range};
use crate::ops;

/// Most arms of a glass.
pub const MAX_WIPER_ARMS: usize = 2;

/// How often the wipers go.
///
/// Slow and fast keep the rules for cars (at least 45 and 10 to 55 cycles a minute, at least 15 apart; FMVSS 104).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum WiperMode {
    /// At rest.
    #[default]
    Off,
    /// One cycle of 1.4 s every 5 s.
    Interval,
    /// 45 cycles a minute.
    Slow,
    /// 65 cycles a minute.
    Fast,
}

impl WiperMode {
    /// Time from one cycle's start to the next, and the part of it in which the arms move. Units: s. `None` at rest.
    ///
    /// Error: exact, the numbers above.
    #[must_use]
    pub fn cycle_s(self) -> Option<[f64; 2]> {
        match self {
            Self::Off => None,
            Self::Interval => Some([5.0, 1.4]),
            Self::Slow => Some([60.0 / 45.0; 2]),
            Self::Fast => Some([60.0 / 65.0; 2]),
        }
    }
}

/// An arm: a blade that swings about a pivot. Places on the glass as everywhere in [`super`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WiperArm {
    /// The pivot, which may lie beside the glass. Units: m. Domain: each within ±10.
    pub pivot_m: [f64; 2],
    /// Where the blade begins and ends, from the pivot. Units: m. Domain: 0 ≤ begin < end ≤ 10.
    pub blade_m: [f64; 2],
    /// Its angle at rest and at the far end, from x to y. Units: rad. Domain: each within ±π, not equal.
    pub turn_rad: [f64; 2],
}

impl WiperArm {
    /// This arm, if every number lies in its domain.
    ///
    /// # Errors
    /// Names the first that does not.
    pub fn validated(self) -> Result<Self, ConfigError> {
        for value in self.pivot_m {
            in_range("pivot_m", value, -10.0, 10.0, "-10 to 10 m")?;
        }
        let [begin, end] = self.blade_m;
        in_range("blade_m", begin, 0.0, 10.0, "0 to 10 m")?;
        in_range("blade_m", end, begin + 1e-3, 10.0, "beyond its begin, to 10 m")?;
        for value in self.turn_rad {
            in_range("turn_rad", value, -PI, PI, "-pi to pi")?;
        }
        if (self.turn_rad[0] - self.turn_rad[1]).abs() < 1e-3 {
            return Err(ConfigError::OutOfRange {
                field: "turn_rad",
                value: self.turn_rad[1],
                allowed: "not the angle at rest",
            });
        }
        Ok(self)
    }
}

/// Wipers in motion: arms, mode, and how long they have been going.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Wipers {
    /// The arms.
    pub arms: [Option<WiperArm>; MAX_WIPER_ARMS],
    /// How often they go.
    pub mode: WiperMode,
    /// Since the mode was switched on. Units: s ≥ 0.
    pub time_s: f64,
}

impl Wipers {
    /// Where the arms are on their way: 0 at rest, 1 at the far end, (1 − cos 2πt/T)/2 in between. Units: none.
    ///
    /// Error: 1e-12 against the formula; real linkages are a few percent faster half-way.
    #[must_use]
    pub fn swing(&self) -> f64 {
        match self.mode.cycle_s() {
            Some([period, moving]) => {
                let at = clamped(self.time_s, 0.0, 1e9) % period;
                if at < moving {
                    0.5 - 0.5 * ops::cos(TAU * at / moving)
                } else {
                    0.0
                }
            }
            None => 0.0,
        }
    }

    /// Whether the arms are at rest.
    #[must_use]
    pub fn rests(&self) -> bool {
        self.swing() == 0.0
    }

    /// How long ago a blade passed a place; `None` where none has. Units: s.
    ///
    /// `place_m`: on the glass, m. A place is passed when the swing reaches its own angle, twice in each cycle.
    ///
    /// Error: 1e-9 s against a search in small steps, beyond 0.01 of the ends of the swing.
    #[must_use]
    pub fn since_s(&self, place_m: [f64; 2]) -> Option<f64> {
        let [period, moving] = self.mode.cycle_s()?;
        let time = clamped(self.time_s, 0.0, 1e9);
        let at = time % period;
        let mut latest: Option<f64> = None;
        for arm in self.arms.iter().flatten() {
            let Some(share) = share_of_swing(arm, place_m) else {
                continue;
            };
            let out = moving * ops::acos(1.0 - 2.0 * share) / TAU;
            for pass in [out, moving - out] {
                let since = if pass <= at { at - pass } else { at + period - pass };
                if since <= time {
                    latest = Some(latest.map_or(since, |known| known.min(since)));
                }
            }
        }
        latest
    }
}

/// The swing at which the blade lies over a place; `None` where it never does. Units: none.
fn share_of_swing(arm: &WiperArm, place_m: [f64; 2]) -> Option<f64> {
    let (x, y) = (place_m[0] - arm.pivot_m[0], place_m[1] - arm.pivot_m[1]);
    let [begin, end] = arm.blade_m;
    let square = x * x + y * y;
    if !(square >= begin * begin && square <= end * end) {
        return None;
    }
    let [rest, far] = arm.turn_rad;
    let turned = ops::atan2(y, x) - rest;
    let share = (turned - TAU * (turned / TAU).round()) / (far - rest);
    (0.0..=1.0).contains(&share).then_some(share)
}
