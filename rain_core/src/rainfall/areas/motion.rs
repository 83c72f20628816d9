//! Where an area is and how strong, as closed forms of the time.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::settings::AreaError;
use crate::error::{ConfigError, in_range};
use crate::haze::ramp;

/// Most keys of a path.
const MAX_KEYS: usize = 100_000;
const MOVED: &str = "-1e7 to 1e7 m";
const TIME: &str = "-1e9 to 1e9 s";

/// A place on a path.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AreaKey {
    /// Units: s, on the rain clock. Domain: ±1e9.
    pub time_s: f64,
    /// How far the centre has moved (x, z). Units: m. Domain: each within ±1e7.
    pub moved_m: DVec2,
}

/// How an area moves.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum AreaMotion {
    /// It stays.
    #[default]
    Still,
    /// It drifts evenly; before `start_s` by the same law.
    Drift {
        /// Units: m/s (x, z). Domain: length ≤ 200.
        velocity_m_s: DVec2,
        /// When it is where its centre says. Units: s, on the rain clock. Domain: ±1e9. Default: 0.
        #[serde(default)]
        start_s: f64,
    },
    /// From key to key in straight lines; it stands before the first and after the last.
    Path {
        /// Times rise strictly. 1 to 100 000 keys.
        keys: Vec<AreaKey>,
    },
}

impl AreaMotion {
    pub(super) fn check(&self) -> Result<(), AreaError> {
        match self {
            Self::Still => {}
            Self::Drift { velocity_m_s, start_s } => {
                in_range(
                    "velocity_m_s",
                    velocity_m_s.length(),
                    0.0,
                    200.0,
                    "a length up to 200 m/s",
                )?;
                in_range("start_s", *start_s, -1e9, 1e9, TIME)?;
            }
            Self::Path { keys } => {
                if keys.is_empty() {
                    return Err(ConfigError::Empty { field: "keys" }.into());
                }
                in_range("number of keys", keys.len() as f64, 1.0, MAX_KEYS as f64, "1 to 100000")?;
                let mut before = f64::NEG_INFINITY;
                for (index, key) in keys.iter().enumerate() {
                    in_range("time_s", key.time_s, -1e9, 1e9, TIME)?;
                    for moved in key.moved_m.to_array() {
                        in_range("moved_m", moved, -1e7, 1e7, MOVED)?;
                    }
                    if key.time_s <= before {
                        return Err(ConfigError::NotIncreasing {
                            field: "time_s",
                            index,
                            value: key.time_s,
                            previous: before,
                        }
                        .into());
                    }
                    before = key.time_s;
                }
            }
        }
        Ok(())
    }

    /// How far the centre has moved at `time_s` (units: s, on the rain clock). Units: m.
    ///
    /// Error: one rounding of each product; a time that is not a number counts as 0.
    #[must_use]
    pub fn moved_m(&self, time_s: f64) -> DVec2 {
        let time_s = if time_s.is_nan() { 0.0 } else { time_s };
        match self {
            Self::Still => DVec2::ZERO,
            Self::Drift { velocity_m_s, start_s } => *velocity_m_s * (time_s - start_s),
            Self::Path { keys } => {
                let next = keys.partition_point(|key| key.time_s <= time_s);
                match (next.checked_sub(1).and_then(|i| keys.get(i)), keys.get(next)) {
                    (Some(a), Some(b)) => {
                        let t = (time_s - a.time_s) / (b.time_s - a.time_s);
                        a.moved_m + (b.moved_m - a.moved_m) * t
                    }
                    (Some(only), None) | (None, Some(only)) => only.moved_m,
                    (None, None) => DVec2::ZERO,
                }
            }
        }
    }

    /// Where it goes at `time_s`. Units: m/s. At a key the way after it.
    #[must_use]
    pub fn velocity_m_s(&self, time_s: f64) -> DVec2 {
        match self {
            Self::Still => DVec2::ZERO,
            Self::Drift { velocity_m_s, .. } => *velocity_m_s,
            Self::Path { keys } => {
                let next = keys.partition_point(|key| key.time_s <= time_s);
                match (next.checked_sub(1).and_then(|i| keys.get(i)), keys.get(next)) {
                    (Some(a), Some(b)) => (b.moved_m - a.moved_m) / (b.time_s - a.time_s),
                    _ => DVec2::ZERO,
                }
            }
        }
    }
}

/// When an area's rain comes and goes: smooth ramps t²(3 − 2t), so that half of each carries half of its time's water.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct AreaFade {
    /// Its rain begins; none: it has always been there. Units: s, on the rain clock. Domain: ±1e9.
    pub start_s: Option<f64>,
    /// It is at full strength so long after that. Units: s. Domain: [0, 1e9].
    pub fade_in_s: f64,
    /// Its rain has ended; none: it stays. Units: s. Domain: ±1e9.
    pub end_s: Option<f64>,
    /// It begins to weaken so long before that. Units: s. Domain: [0, 1e9].
    pub fade_out_s: f64,
}

impl AreaFade {
    pub(super) fn check(&self) -> Result<(), AreaError> {
        for (field, value) in [("start_s", self.start_s), ("end_s", self.end_s)] {
            in_range(field, value.unwrap_or(0.0), -1e9, 1e9, TIME)?;
        }
        in_range("fade_in_s", self.fade_in_s, 0.0, 1e9, "0 to 1e9 s")?;
        in_range("fade_out_s", self.fade_out_s, 0.0, 1e9, "0 to 1e9 s")?;
        Ok(())
    }

    /// Strength at `time_s` (units: s, on the rain clock). Units: none. In [0, 1]. The ramps multiply where they overlap.
    ///
    /// Error: 1e-15.
    #[must_use]
    pub fn strength(&self, time_s: f64) -> f64 {
        let step = |from: f64, over: f64| {
            if over > 0.0 {
                ramp(time_s, from, from + over)
            } else {
                f64::from(u8::from(time_s >= from))
            }
        };
        let come = self.start_s.map_or(1.0, |start| step(start, self.fade_in_s));
        let gone = self
            .end_s
            .map_or(0.0, |end| step(end - self.fade_out_s, self.fade_out_s));
        come * (1.0 - gone)
    }
}
