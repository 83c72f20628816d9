//! The host's side of the tile of puddles around the view.

use rain_core::constants::WATER_DENSITY;
use rain_core::error::{ConfigError, in_range};
use rain_core::waves::Push;

use super::calm::CalmBound;
use super::frame::{MAX_STEPS, Plan, WaveFrame, Way};
use super::params::{Disturbance, MAX_DISTURBANCES, Rules, WaveTileSettings};
use super::place::Place;

/// Longest time that one call of [`WaveTile::advance`] makes up for. Units: ns.
pub(super) const MAX_ADVANCE_NS: u64 = 1_000_000_000;

/// Waves lower than this are calm. Units: m.
pub(super) const CALM_M: f64 = 5e-5;

/// What a source's norms may exceed those of the Gaussian by: cells instead of an integral.
const MARGIN: f64 = 1.05;

/// A shore cuts a force and its sum is taken back, which leaves no more than this many times the norm of the whole: 1,
/// and 1.6 for the part taken back, proportional to the weight.
const CUT: f64 = 2.6;

/// Place, depths, clock and disturbances of a tile of water. Everything but the heights, which live on the GPU.
///
/// Construction allocates one number a cell; frames allocate until their lists have grown.
#[derive(Debug, Clone)]
pub struct WaveTile {
    pub(super) settings: WaveTileSettings,
    pub(super) rules: Rules,
    pub(super) place: Place,
    /// Relative depths, as they are stored.
    pub(super) depths: Vec<f32>,
    pub(super) wet: usize,
    pub(super) left_ns: u64,
    pub(super) bound: CalmBound,
    plan: Plan,
    /// Moves since the last frame was taken.
    pub(super) moved: [i64; 2],
    pub(super) depths_changed: bool,
    /// All water has to be stilled, and the map drawn once more.
    pub(super) still: bool,
    pub(super) asleep: bool,
    /// Heights that were put back, until they are handed over.
    pub(super) heights: Option<[Vec<f32>; 2]>,
}

impl WaveTile {
    /// A tile that stands nowhere yet, and is dry.
    ///
    /// # Errors
    /// [`ConfigError::OutOfRange`] for a setting outside its domain.
    pub fn new(settings: &WaveTileSettings) -> Result<Self, ConfigError> {
        let rules = settings.rules()?;
        Ok(Self {
            settings: *settings,
            rules,
            place: Place::new(settings.snap_cells),
            depths: vec![0.0; (settings.cells * settings.cells) as usize],
            wet: 0,
            left_ns: 0,
            bound: CalmBound::default(),
            plan: Plan::default(),
            moved: [0; 2],
            depths_changed: true,
            still: false,
            asleep: true,
            heights: None,
        })
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &WaveTileSettings {
        &self.settings
    }

    /// The sub-step. Units: ns.
    #[must_use]
    pub fn step_ns(&self) -> u64 {
        self.rules.step_ns
    }

    /// World position (x, z) of the tile's lower corner, where texture coordinates are 0. Units: m.
    #[must_use]
    pub fn corner_m(&self) -> [f64; 2] {
        self.place
            .corner
            .unwrap_or_default()
            .map(|cell| cell as f64 * self.rules.cell_m)
    }

    /// Side of the tile. Units: m.
    #[must_use]
    pub fn side_m(&self) -> f64 {
        f64::from(self.rules.cells) * self.rules.cell_m
    }

    /// Index of cell (i, j) in the GPU's buffers.
    #[must_use]
    pub fn stored(&self, i: u32, j: u32) -> usize {
        let n = self.rules.cells;
        let offset = self.place.offset(n);
        (((j + offset[1]) % n) * n + (i + offset[0]) % n) as usize
    }

    /// Moves the tile so that `view_m` (world x, z) is near its middle, by whole steps of `snap_cells`. Waves stay where
    /// they are in the world; cells that come in are calm, and `depth_m` is asked for the depth at their middles (world
    /// x, z in m; in m, 0 is dry; what is not a number or negative is dry, see [`super::water_depth_m`]). Returns
    /// whether it moved. A place that is not finite moves nothing, and nothing moves while steps wait to be taken.
    pub fn follow(&mut self, view_m: [f64; 2], depth_m: impl FnMut(f64, f64) -> f32) -> bool {
        let Some(corner) = self.place.wanted(&self.rules, view_m) else {
            return false;
        };
        if !self.plan.steps.is_empty() {
            return false;
        }
        let old = self.place.corner.replace(corner);
        if let Some(old) = old {
            for axis in 0..2 {
                self.moved[axis] = self.moved[axis].saturating_add(corner[axis].saturating_sub(old[axis]));
            }
        }
        self.fill(old, depth_m);
        true
    }

    /// Asks for all depths anew: levels or ground have changed. Waves stay where there still is water.
    pub fn refill(&mut self, depth_m: impl FnMut(f64, f64) -> f32) {
        self.fill(None, depth_m);
    }

    /// Asks for the depth of all cells that were not in the tile at `old`.
    fn fill(&mut self, old: Option<[i64; 2]>, mut depth_m: impl FnMut(f64, f64) -> f32) {
        let n = i64::from(self.rules.cells);
        let corner = self.place.corner.unwrap_or_default();
        let deepest = self.rules.deepest_m();
        let had = |cell: [i64; 2]| old.is_some_and(|old| (0..2).all(|axis| (0..n).contains(&(cell[axis] - old[axis]))));
        for z in corner[1]..corner[1] + n {
            for x in corner[0]..corner[0] + n {
                if had([x, z]) {
                    continue;
                }
                let [at_x, at_z] = [x, z].map(|cell| (cell as f64 + 0.5) * self.rules.cell_m);
                let depth = f64::from(depth_m(at_x, at_z));
                let relative = if depth > 0.0 { depth.min(deepest) / deepest } else { 0.0 };
                self.depths[(z.rem_euclid(n) * n + x.rem_euclid(n)) as usize] = relative as f32;
            }
        }
        self.wet = self.depths.iter().filter(|depth| **depth > 0.0).count();
        self.depths_changed = true;
        if self.wet == 0 {
            self.reset();
        }
    }

    /// Whether any cell is wet.
    #[must_use]
    pub fn has_water(&self) -> bool {
        self.wet > 0
    }

    /// Stills everything at once, as a cut of the camera does.
    pub fn reset(&mut self) {
        self.plan.clear();
        self.heights = None;
        self.bound = CalmBound::default();
        self.still |= !self.asleep;
        self.asleep = true;
    }

    /// Lets time pass. The disturbances of that time are cut into as many parts as there are steps, each added before
    /// its own, so that the water does not depend on the frame rate; without a step in this time they are added at once.
    /// Returns the number of steps. Of more than a second, and of more than 32 steps not yet taken, the rest is dropped.
    ///
    /// Free while nothing moves and no disturbance reaches the tile.
    ///
    /// # Errors
    /// [`ConfigError::OutOfRange`] for a disturbance with a number outside its domain or not finite, and for more than
    /// [`MAX_DISTURBANCES`]; then nothing has changed.
    pub fn advance(&mut self, elapsed_ns: u64, disturbances: &[Disturbance]) -> Result<u32, ConfigError> {
        let most = MAX_DISTURBANCES as f64;
        in_range("disturbances", disturbances.len() as f64, 0.0, most, "at most 64")?;
        for disturbance in disturbances {
            disturbance.check()?;
        }
        let total = self.left_ns + elapsed_ns.min(MAX_ADVANCE_NS);
        self.left_ns = total % self.rules.step_ns;
        if !self.has_water() || self.place.corner.is_none() || (self.asleep && disturbances.is_empty()) {
            return Ok(0);
        }
        let woken = self.asleep;
        let room = MAX_STEPS - self.plan.steps.len();
        let steps = ((total / self.rules.step_ns) as usize).min(room);
        if steps == 0 && !disturbances.is_empty() && room > 0 {
            self.push(disturbances, 0, 1);
            self.plan.finish(&self.rules, false);
        }
        for step in 0..steps {
            self.push(disturbances, step, steps);
            self.plan.finish(&self.rules, true);
            self.bound.step(self.rules.courant, self.rules.keep);
        }
        if self.bound.ever_m(self.rules.courant, self.rules.keep) < CALM_M {
            // What was too weak to wake the tile has not been drawn.
            self.asleep = woken;
            self.reset();
            return Ok(0);
        }
        Ok(steps as u32)
    }

    /// Adds part `index` of `parts` of all disturbances that reach the tile.
    fn push(&mut self, disturbances: &[Disturbance], index: usize, parts: usize) {
        let rules = self.rules;
        let corner = self.place.corner.unwrap_or_default();
        let share = 1.0 / parts as f64;
        for disturbance in disturbances {
            // From the corner, in double precision.
            let cell = |at: [f64; 2]| [0, 1].map(|axis| at[axis] / rules.cell_m - corner[axis] as f64);
            let (from, to) = (cell(disturbance.from_m), cell(disturbance.to_m));
            let at = |t: f64| [0, 1].map(|axis| from[axis] + t * (to[axis] - from[axis]));
            let width = (disturbance.width_m / rules.cell_m).max(2.0);
            let scale = rules.courant / width;
            let norm = width * core::f64::consts::PI.sqrt();
            let bent = width * core::f64::consts::TAU.sqrt() * CUT;
            let (height, back, lifted) = match disturbance.push {
                Push::Height(height) => {
                    let height = share * f64::from(height);
                    let back = 0.5 * scale * scale * height;
                    (height, back, height.abs() * scale * norm)
                }
                Push::Impulse(impulse) => {
                    let s2 = (width * rules.cell_m) * (width * rules.cell_m);
                    let force = rules.deepest_m() * share * f64::from(impulse)
                        / (WATER_DENSITY * core::f64::consts::TAU * s2 * s2);
                    (0.0, -(1.0 + rules.half_damping) * rules.step_s() * force, 0.0)
                }
            };
            let way = Way {
                start: at(index as f64 * share),
                end: at((index + 1) as f64 * share),
                width,
                height,
                back,
            };
            if self.plan.push(&rules, &way) {
                self.bound
                    .add(MARGIN * height.abs() * norm, MARGIN * (lifted + back.abs() * bent));
                self.asleep = false;
            }
        }
    }

    /// Whether nothing moves that can be seen, now or later without a new disturbance.
    #[must_use]
    pub fn is_calm(&self) -> bool {
        self.asleep
    }

    /// The bound by which the tile falls asleep; no height exceeds [`CalmBound::height_m`].
    #[must_use]
    pub fn bound(&self) -> CalmBound {
        self.bound
    }

    /// Whether there is anything to record: water moves, or a map that showed waves has to become flat.
    #[must_use]
    pub fn wants_pass(&self) -> bool {
        !self.asleep || self.still
    }

    /// Hands the work since the last call over. Whatever `frame` held is gone.
    pub fn take(&mut self, frame: &mut WaveFrame) {
        let n = i64::from(self.rules.cells);
        let mut params = self.rules.params();
        params.offset = self.place.offset(self.rules.cells);
        params.moved = self.moved.map(|cells| cells.clamp(-n, n) as i32);
        if self.still {
            params.moved = [n as i32; 2];
        }
        params.blend = self.left_ns as f32 / self.rules.step_ns as f32;
        frame.params = Some(params);
        frame.settle = self.still || self.depths_changed || self.moved != [0; 2];
        frame.balance = true;
        frame.heights = self.heights.take();
        frame.depths.clear();
        if self.depths_changed {
            frame.depths.extend_from_slice(&self.depths);
        }
        frame.plan.clear();
        core::mem::swap(&mut frame.plan, &mut self.plan);
        self.moved = [0; 2];
        self.depths_changed = false;
        self.still = false;
    }
}
