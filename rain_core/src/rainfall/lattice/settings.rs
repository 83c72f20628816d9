//! How far cards reach, how large their cells are, and which are left out.

use serde::{Deserialize, Serialize};

use crate::error::{ConfigError, in_range};

/// Most pictures that one card may lay over each other.
pub const MAX_CARD_SAMPLES: u32 = 4;

/// Nearest start of cards. Units: cells of the first level. 3.2 m for 2 m, as [`crate::haze::mid_start_m`] has it.
const NEAREST_CELLS: f64 = 1.6;

/// Cells of one size.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LatticeLevel {
    /// Edge of a cell. Units: m. Domain: [0.5, 8].
    pub cell_m: f64,
    /// Where the next level takes over, between this and 1.25 times it; of the last level it does not count. Units: m.
    /// Domain: (0, 1000].
    pub to_m: f64,
}

/// Cells, range and skips.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LatticeSettings {
    /// Sizes of cells from near to far, one to four; both columns rise. Default: 2 m up to 12 m, then 4 m.
    pub levels: Vec<LatticeLevel>,
    /// Where the last cards have faded out; they begin to at two thirds of it. Units: m. Domain: [5, 100]. Default: 36.
    pub far_m: f64,
    /// Cards whose light can nowhere add more than this to the picture are left out. Units: exposed radiance, 1 = white.
    /// Domain: [0, 1]. Default: 0, none are: unlit rain still takes light from what is behind it.
    pub min_light: f64,
    /// Most pictures that a card lays over each other, one for each cube of depth: cells deeper than this many show fewer,
    /// stronger streaks. Domain: [1, 4]. Default: 1, since each is paid for in every pixel.
    pub samples: u32,
    /// Beyond the first level two neighbouring classes share a card, with the pictures and the speed of the one that takes
    /// out more light at the middle rate. Default: true.
    pub pairs: bool,
    /// No more cards than this; the farthest are left out. Domain: [0, 262 144]. Default: 16 384.
    pub max_cards: u32,
}

impl Default for LatticeSettings {
    fn default() -> Self {
        let level = |cell_m, to_m| LatticeLevel { cell_m, to_m };
        Self {
            levels: vec![level(2.0, 12.0), level(4.0, 36.0)],
            far_m: 36.0,
            min_light: 0.0,
            samples: 1,
            pairs: true,
            max_cards: 16_384,
        }
    }
}

impl LatticeSettings {
    /// The source's lattice: cells of 1 m in a region of 5 m, cards without light left out.
    #[must_use]
    pub fn yoshida() -> Self {
        Self {
            levels: vec![LatticeLevel { cell_m: 1.0, to_m: 5.0 }],
            far_m: 5.0,
            min_light: 1e-4,
            ..Self::default()
        }
    }

    /// The settings, when every value is inside its domain.
    ///
    /// # Errors
    /// When a value is outside its domain, or levels do not rise.
    pub fn checked(self) -> Result<Self, ConfigError> {
        if self.levels.is_empty() {
            return Err(ConfigError::Empty { field: "levels" });
        }
        in_range("levels", self.levels.len() as f64, 1.0, 4.0, "1 to 4 levels")?;
        for (index, level) in self.levels.iter().enumerate() {
            in_range("levels.cell_m", level.cell_m, 0.5, 8.0, "0.5 to 8 m")?;
            in_range("levels.to_m", level.to_m, 1e-3, 1e3, "above 0, to 1000 m")?;
            if index == 0 {
                continue;
            }
            let before = self.levels[index - 1];
            for (field, value, previous) in [
                ("levels.cell_m", level.cell_m, before.cell_m),
                ("levels.to_m", level.to_m, before.to_m),
            ] {
                if value <= previous {
                    return Err(ConfigError::NotIncreasing {
                        field,
                        index,
                        value,
                        previous,
                    });
                }
            }
        }
        in_range("far_m", self.far_m, 5.0, 100.0, "5 to 100 m")?;
        in_range("min_light", self.min_light, 0.0, 1.0, "0 to 1")?;
        in_range(
            "samples",
            f64::from(self.samples),
            1.0,
            f64::from(MAX_CARD_SAMPLES),
            "1 to 4",
        )?;
        in_range("max_cards", f64::from(self.max_cards), 0.0, 262_144.0, "0 to 262144")?;
        Ok(self)
    }

    /// Ramp in which the last cards end. Units: m.
    pub(super) fn end_ramp_m(&self) -> [f64; 2] {
        [self.far_m / 1.5, self.far_m]
    }

    /// Ramp in which a level begins, for drops that are drawn singly up to `range_m`: the first where those end, but no
    /// nearer than 1.6 of its cells, since closer cards swim and clip; the others at their border; one past the last where
    /// all cards end.
    pub(super) fn ramp_m(&self, level: usize, range_m: f64) -> [f64; 2] {
        let [end_from, end_to] = self.end_ramp_m();
        let nearest = NEAREST_CELLS * self.levels[0].cell_m;
        // Also where the range is not a number.
        let start = if 0.8 * range_m > nearest {
            0.8 * range_m
        } else {
            nearest
        };
        let border = match level {
            0 => 0.0,
            l if l < self.levels.len() => self.levels[l - 1].to_m,
            _ => return [end_from, end_to],
        };
        [
            start.max(border).min(end_from),
            (1.5 * start).max(1.25 * border).min(end_to),
        ]
    }
}
