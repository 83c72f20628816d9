//! The work of a frame on its way to the GPU.

use std::ops::Range;

use super::params::Rules;
use crate::gpu_types::{WaveBin, WaveParams, WaveSource};

/// How far a Gaussian source reaches, in standard deviations, as on the CPU.
const REACH: f64 = 5.0;

/// Cells of a bin along each axis.
const BIN: u32 = 8;

/// Most steps in a frame; time beyond is dropped.
pub(super) const MAX_STEPS: usize = 32;

/// The sources before a step, and whether there is one.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Step {
    pub sources: Range<u32>,
    pub bins: Range<u32>,
    pub steps: bool,
}

/// What the GPU has to do for a tile. Made empty, filled by [`super::WaveTile::take`] or [`super::RippleTile::take`],
/// read by [`super::WaveTileGpu::prepare`]; its lists keep their capacity when it is used again.
#[derive(Debug, Clone, Default)]
pub struct WaveFrame {
    pub(super) params: Option<WaveParams>,
    pub(super) plan: Plan,
    /// Relative depths as they are stored, when they have changed.
    pub(super) depths: Vec<f32>,
    /// Heights now and a step before, to begin with, as they are stored: a saved state was put back.
    pub(super) heights: Option<[Vec<f32>; 2]>,
    /// Cells that are new or dry have to be stilled first.
    pub(super) settle: bool,
    /// Forces have to be balanced over the water that they reach.
    pub(super) balance: bool,
}

impl WaveFrame {
    /// Number of steps.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.plan.steps.iter().filter(|step| step.steps).count()
    }

    /// Number of sources, each share of a disturbance counted.
    #[must_use]
    pub fn sources(&self) -> usize {
        self.plan.sources.len()
    }
}

/// Steps and their sources, sorted into bins.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Plan {
    pub steps: Vec<Step>,
    pub sources: Vec<WaveSource>,
    pub bins: Vec<WaveBin>,
    pub entries: Vec<u32>,
    /// Entries of each bin of the tile, while a step is being sorted.
    counts: Vec<u32>,
}

/// A run of cells along an axis.
struct Span {
    low: i64,
    count: i64,
}

impl Span {
    /// The cells whose middles lie within [low, high], in cells from the corner of the tile.
    fn new(low: f64, high: f64, cells: i64, periodic: bool) -> Self {
        let mut start = (low - 0.5).ceil() as i64;
        let mut end = ((high - 0.5).floor() as i64).saturating_add(1);
        if periodic {
            let excess = (end - start - cells).max(0);
            start += excess / 2;
            end -= excess - excess / 2;
        } else {
            start = start.max(0);
            end = end.min(cells);
        }
        Self {
            low: start,
            count: (end - start).max(0),
        }
    }
}

/// A source with its way in cells from the corner of the tile.
pub(super) struct Way {
    pub start: [f64; 2],
    pub end: [f64; 2],
    pub width: f64,
    pub height: f64,
    pub back: f64,
}

impl Plan {
    pub fn clear(&mut self) {
        self.steps.clear();
        self.sources.clear();
        self.bins.clear();
        self.entries.clear();
    }

    /// Adds a source to the step that is being filled. Returns whether it reaches the tile.
    pub fn push(&mut self, rules: &Rules, way: &Way) -> bool {
        let span = |axis: usize| {
            let (a, b) = (way.start[axis], way.end[axis]);
            let reach = REACH * way.width;
            Span::new(
                a.min(b) - reach,
                a.max(b) + reach,
                i64::from(rules.cells),
                rules.periodic,
            )
        };
        let spans = [span(0), span(1)];
        if spans.iter().any(|span| span.count == 0) {
            return false;
        }
        let low = [spans[0].low, spans[1].low];
        let part = [way.end[0] - way.start[0], way.end[1] - way.start[1]];
        let length = (part[0] * part[0] + part[1] * part[1]).sqrt();
        let along = if length > 0.0 {
            part.map(|x| (x / length) as f32)
        } else {
            [1.0, 0.0]
        };
        self.sources.push(WaveSource {
            low: low.map(|low| low as i32),
            count: [spans[0].count as u32, spans[1].count as u32],
            start: [0, 1].map(|axis| (way.start[axis] - low[axis] as f64) as f32),
            along,
            length: (length / way.width) as f32,
            per_width: (1.0 / way.width) as f32,
            height: way.height as f32,
            back: way.back as f32,
        });
        true
    }

    /// Ends the step: all sources since the last one are sorted into bins, each bin's in their order.
    pub fn finish(&mut self, rules: &Rules, steps: bool) {
        let side = rules.cells / BIN;
        let first_source = self.steps.last().map_or(0, |step| step.sources.end);
        let first_bin = self.bins.len() as u32;
        let sources = first_source..self.sources.len() as u32;
        if !sources.is_empty() {
            self.counts.clear();
            self.counts.resize((side * side) as usize, 0);
            for source in &self.sources[first_source as usize..] {
                for_each_bin(source, side, |bin| self.counts[bin as usize] += 1);
            }
            let mut first = self.entries.len() as u32;
            self.entries
                .resize(self.entries.len() + self.counts.iter().sum::<u32>() as usize, 0);
            for (bin, count) in (0_u32..).zip(&mut self.counts) {
                if *count > 0 {
                    self.bins.push(WaveBin {
                        place: (bin % side) | ((bin / side) << 16),
                        first,
                        count: *count,
                        pad: 0,
                    });
                }
                // From here on where the bin's next entry goes.
                first += core::mem::replace(count, first);
            }
            for (index, source) in (first_source..).zip(&self.sources[first_source as usize..]) {
                for_each_bin(source, side, |bin| {
                    let next = &mut self.counts[bin as usize];
                    self.entries[*next as usize] = index;
                    *next += 1;
                });
            }
        }
        self.steps.push(Step {
            sources,
            bins: first_bin..self.bins.len() as u32,
            steps,
        });
    }
}

/// The bins that a source's box touches, each once.
fn for_each_bin(source: &WaveSource, side: u32, mut visit: impl FnMut(u32)) {
    let range = |axis: usize| {
        let low = source.low[axis].div_euclid(BIN as i32);
        let last = (source.low[axis] + source.count[axis] as i32 - 1).div_euclid(BIN as i32);
        // A box around the whole tile may start and end in the same bin.
        low..=last.min(low + side as i32 - 1)
    };
    for z in range(1) {
        for x in range(0) {
            let [x, z] = [x, z].map(|at| at.rem_euclid(side as i32) as u32);
            visit(z * side + x);
        }
    }
}
