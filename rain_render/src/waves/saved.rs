//! A tile of water as plain data: saved and put back.

use thiserror::Error;

use super::calm::CalmBound;
use super::tile::WaveTile;

/// No wave of a puddle is so high. Units: m.
const HIGHEST_M: f32 = 1e3;

/// State of a [`WaveTile`] and the heights of its water. Put back into a tile of the same settings, the water goes on bit
/// for bit on the same device.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SavedWaves {
    /// Cells on a side.
    pub cells: u32,
    /// World cell of the tile's cell (0, 0), once known.
    pub corner: Option<[i64; 2]>,
    /// Time since the last sub-step. Units: ns.
    pub left_ns: u64,
    /// Bounds on what moves: of the heights and of the motion. Units: m.
    pub bound_m: [f64; 2],
    /// Which of the cells are wet, 32 in a word, in the order in which they are stored.
    pub wet: Vec<u32>,
    /// Depth of each wet cell, relative to the deepest, in (0, 1].
    pub depths: Vec<f32>,
    /// Heights of the wet cells now and a step before. Units: m. Empty: the water is calm.
    pub heights_m: [Vec<f32>; 2],
}

/// Why [`WaveTile::restore`] refuses what was saved. The tile is as it was.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SavedWavesError {
    /// Saved from a tile of another size.
    #[error("waves of {found} cells a side, here are {here}")]
    Cells {
        /// What was saved.
        found: u32,
        /// The tile's.
        here: u32,
    },
    /// Lists of lengths that do not belong together.
    #[error("waves: {found} {what}, expected {expected}")]
    Length {
        /// Which list.
        what: &'static str,
        /// Its length.
        found: usize,
        /// What the others make it.
        expected: usize,
    },
    /// A number that nothing can have written.
    #[error("waves: {what} is {value}")]
    Number {
        /// Which number.
        what: &'static str,
        /// What it is.
        value: f64,
    },
}

impl WaveTile {
    /// Saves the tile. `levels` are the heights of [`super::WaveTileGpu::levels`] as they are stored, of a tile whose
    /// work has all been taken and done; they are not looked at while the water is calm.
    ///
    /// # Errors
    /// [`SavedWavesError::Length`]: a level without as many heights as the tile has cells.
    pub fn save(&self, levels: [&[f32]; 2]) -> Result<SavedWaves, SavedWavesError> {
        let mut saved = SavedWaves {
            cells: self.settings.cells,
            corner: self.place.corner,
            left_ns: self.left_ns,
            bound_m: self.bound.parts(),
            wet: vec![0; self.depths.len().div_ceil(32)],
            ..SavedWaves::default()
        };
        for (cell, depth) in self.depths.iter().enumerate().filter(|(_, depth)| **depth > 0.0) {
            saved.wet[cell / 32] |= 1 << (cell % 32);
            saved.depths.push(*depth);
        }
        if self.asleep {
            return Ok(saved);
        }
        for (level, kept) in levels.into_iter().zip(&mut saved.heights_m) {
            of_length("heights", level.len(), self.depths.len())?;
            kept.extend(
                level
                    .iter()
                    .zip(&self.depths)
                    .filter(|(_, depth)| **depth > 0.0)
                    .map(|(height, _)| *height),
            );
        }
        Ok(saved)
    }

    /// Puts a saved state back; the next [`WaveTile::take`] hands its heights over.
    ///
    /// # Errors
    /// When it was saved from a tile of another size, or nothing can have written it. Then nothing changes.
    pub fn restore(&mut self, saved: &SavedWaves) -> Result<(), SavedWavesError> {
        let cells = self.depths.len();
        if saved.cells != self.settings.cells {
            return Err(SavedWavesError::Cells {
                found: saved.cells,
                here: self.settings.cells,
            });
        }
        of_length("words of wet cells", saved.wet.len(), cells.div_ceil(32))?;
        let wet = saved.wet.iter().map(|word| word.count_ones() as usize).sum();
        of_length("depths", saved.depths.len(), wet)?;
        let awake = saved.heights_m.iter().any(|level| !level.is_empty());
        for level in &saved.heights_m {
            of_length("heights", level.len(), if awake { wet } else { 0 })?;
            all("a height", level, |height| height.abs() < HIGHEST_M)?;
        }
        all("a depth", &saved.depths, |depth| depth > 0.0 && depth <= 1.0)?;
        for bound in saved.bound_m {
            if !(bound >= 0.0 && bound.is_finite()) {
                return Err(SavedWavesError::Number {
                    what: "a bound",
                    value: bound,
                });
            }
        }
        if saved.left_ns >= self.rules.step_ns {
            return Err(SavedWavesError::Number {
                what: "the time since the last step",
                value: saved.left_ns as f64,
            });
        }
        self.reset();
        self.place.corner = saved.corner;
        self.moved = [0; 2];
        self.left_ns = saved.left_ns;
        self.bound = CalmBound::of_parts(saved.bound_m);
        self.wet = wet;
        self.depths_changed = true;
        self.depths = spread(&saved.wet, &saved.depths, cells);
        if awake {
            self.asleep = false;
            self.still = false;
            self.heights = Some(saved.heights_m.each_ref().map(|level| spread(&saved.wet, level, cells)));
        }
        Ok(())
    }
}

/// A number for each cell from those of the wet ones; 0 elsewhere.
fn spread(wet: &[u32], values: &[f32], cells: usize) -> Vec<f32> {
    let mut values = values.iter();
    (0..cells)
        .map(|cell| match wet[cell / 32] >> (cell % 32) & 1 {
            1 => values.next().copied().unwrap_or_default(),
            _ => 0.0,
        })
        .collect()
}

fn of_length(what: &'static str, found: usize, expected: usize) -> Result<(), SavedWavesError> {
    if found == expected {
        Ok(())
    } else {
        Err(SavedWavesError::Length { what, found, expected })
    }
}

fn all(what: &'static str, values: &[f32], holds: impl Fn(f32) -> bool) -> Result<(), SavedWavesError> {
    match values.iter().find(|value| !holds(**value)) {
        Some(value) => Err(SavedWavesError::Number {
            what,
            value: f64::from(*value),
        }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use rain_core::waves::Push;

    use super::*;
    use crate::waves::{Disturbance, WaveFrame, WaveTileSettings};

    /// A tile half of which is wet, with a wave in it.
    fn tile() -> WaveTile {
        let mut tile = WaveTile::new(&WaveTileSettings {
            cells: 64,
            ..Default::default()
        })
        .expect("valid");
        tile.follow([0.0, 0.0], |x, _| if x > 0.0 { 0.02 } else { 0.0 });
        let foot = Disturbance {
            from_m: [0.2, 0.0],
            to_m: [0.2, 0.0],
            width_m: 0.1,
            push: Push::Height(0.01),
        };
        tile.advance(40_000_000, &[foot]).expect("valid");
        tile.take(&mut WaveFrame::default());
        tile
    }

    #[test]
    fn what_is_put_back_is_what_was_saved() {
        let first = tile();
        assert!(!first.is_calm() && first.has_water());
        let heights: Vec<f32> = first
            .depths
            .iter()
            .enumerate()
            .map(|(i, d)| if *d > 0.0 { i as f32 * 1e-6 } else { 0.0 })
            .collect();
        let before: Vec<f32> = heights.iter().map(|h| 0.5 * h).collect();
        let saved = first.save([&heights, &before]).expect("as many heights as cells");
        assert_eq!(saved.depths.len(), 2048);
        let mut second = WaveTile::new(first.settings()).expect("valid");
        second.restore(&saved).expect("fits");
        assert_eq!(
            second.heights.as_ref().map(|h| (&h[0], &h[1])),
            Some((&heights, &before))
        );
        assert_eq!((second.corner_m(), second.bound()), (first.corner_m(), first.bound()));
        let mut frame = WaveFrame::default();
        second.take(&mut frame);
        assert_eq!(frame.heights.as_ref().map(|h| h[0].len()), Some(4096));
        assert!(second.heights.is_none(), "handed over once");
        assert_eq!(second.save([&heights, &before]).expect("again"), saved);
    }

    #[test]
    fn calm_water_is_saved_without_heights_and_stills_what_moved() {
        let mut calm = tile();
        calm.reset();
        let saved = calm.save([&[], &[]]).expect("not looked at");
        assert!(saved.heights_m.iter().all(Vec::is_empty));
        let mut moved = tile();
        moved.restore(&saved).expect("fits");
        assert!(moved.is_calm() && moved.wants_pass(), "the map has to become flat");
    }

    #[test]
    fn what_nothing_can_have_written_is_refused_and_changes_nothing() {
        let mut here = tile();
        let zeros = vec![0.0; 4096];
        let good = here.save([&zeros, &zeros]).expect("as many heights as cells");
        type Edit = fn(&mut SavedWaves);
        let edits: [(Edit, &str); 10] = [
            (|s| s.cells = 128, "128 cells"),
            (|s| s.wet.truncate(3), "words of wet cells"),
            (|s| s.wet[0] ^= 1, "depths"),
            (|s| s.depths[4] = 0.0, "a depth"),
            (|s| s.depths[4] = f32::NAN, "a depth"),
            (|s| s.heights_m[1][7] = f32::INFINITY, "a height"),
            (|s| s.heights_m[0].truncate(3), "heights"),
            (|s| s.heights_m[1].clear(), "heights"),
            (|s| s.bound_m[1] = -1.0, "a bound"),
            (|s| s.left_ns = u64::MAX, "the time"),
        ];
        for (edit, name) in edits {
            let mut bad = good.clone();
            edit(&mut bad);
            let message = here.restore(&bad).expect_err(name).to_string();
            assert!(message.contains(name), "{message} for {name}");
            assert_eq!(here.save([&zeros, &zeros]).expect("as before"), good);
        }
        assert!(matches!(
            here.save([&zeros[1..], &zeros]),
            Err(SavedWavesError::Length { .. })
        ));
    }
}
