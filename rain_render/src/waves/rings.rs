//! The host's side of the tile of rain's rings.

use rain_core::error::ConfigError;
use rain_core::hash;
use rain_core::ops;
use rain_core::rainfall::{DiameterTable, DropSizes, terminal_velocity};
use rain_core::splash::for_each_impact;
use rain_core::waves::{DropImpact, rain_slope_variance};

use super::calm::CalmBound;
use super::frame::{MAX_STEPS, Plan, WaveFrame, Way};
use super::params::{RippleSettings, Rules};
use super::tile::{CALM_M, MAX_ADVANCE_NS};

/// Largest drop: larger ones break up as they fall. Units: mm.
const LARGEST_MM: f64 = 8.0;

/// What the norms of a ring on cells may exceed those of the water by; at two cells' width they are 6 % apart.
const MARGIN: f64 = 1.2;

/// Rain on still water: each drop of the size distribution presses its ring into a tile that repeats.
///
/// Impacts are Poisson, hashed by seed and step: the same seed, rain and number of steps make the same water, bit for
/// bit on one device. Wind does not change them: on level water as many drops fall as fast downwards.
#[derive(Debug, Clone)]
pub struct RippleTile {
    settings: RippleSettings,
    rules: Rules,
    /// The rain, its drops on a square metre in a second, and their diameters.
    sizes: Option<DropSizes>,
    drops_per_m2_s: f64,
    diameters: Option<DiameterTable<128>>,
    /// Variance of the slopes of rings too fine for the cells: where the rain leads to, and where it is.
    hidden_target: f64,
    hidden_variance: f64,
    left_ns: u64,
    steps: u32,
    bound: CalmBound,
    plan: Plan,
    depths_changed: bool,
    still: bool,
    asleep: bool,
}

impl RippleTile {
    /// Still water without rain.
    ///
    /// # Errors
    /// [`ConfigError::OutOfRange`] for a setting outside its domain.
    pub fn new(settings: &RippleSettings) -> Result<Self, ConfigError> {
        Ok(Self {
            settings: *settings,
            rules: settings.rules()?,
            sizes: None,
            drops_per_m2_s: 0.0,
            diameters: None,
            hidden_target: 0.0,
            hidden_variance: 0.0,
            left_ns: 0,
            steps: 0,
            bound: CalmBound::default(),
            plan: Plan::default(),
            depths_changed: true,
            still: false,
            asleep: true,
        })
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &RippleSettings {
        &self.settings
    }

    /// The sub-step. Units: ns.
    #[must_use]
    pub fn step_ns(&self) -> u64 {
        self.rules.step_ns
    }

    /// Drops above the least diameter that fall. Units: 1/(m² s).
    #[must_use]
    pub fn drops_per_m2_s(&self) -> f64 {
        self.drops_per_m2_s
    }

    /// What falls from now on; nothing where no drop is large enough. Takes about a tenth of a millisecond when it has changed.
    pub fn set_rain(&mut self, sizes: &DropSizes) {
        if self.sizes == Some(*sizes) {
            return;
        }
        self.sizes = Some(*sizes);
        let least = self.settings.least_drop_mm;
        let flux = sizes.flux_moment(0, least, LARGEST_MM, terminal_velocity);
        let table = DiameterTable::on_ground(sizes, least, LARGEST_MM, terminal_velocity);
        // Without drops there is no table.
        self.diameters = table.ok().filter(|_| flux > 0.0);
        self.drops_per_m2_s = if self.diameters.is_some() { flux } else { 0.0 };
        let variance = |cell_m| rain_slope_variance(sizes, self.settings.depth_m, self.variance_decay_per_s(), cell_m);
        self.hidden_target = (variance(0.0) - variance(self.settings.cell_m())).max(0.0);
    }

    /// Rate at which the square of waves decays: k_d of the field without a decay of its own. Units: 1/s.
    fn variance_decay_per_s(&self) -> f64 {
        2.0 * self.rules.decay_per_s
    }

    /// Variance of the slopes of rings too fine for the cells, which the map holds as such. Units: none.
    #[must_use]
    pub fn hidden_variance(&self) -> f64 {
        self.hidden_variance
    }

    /// Stills everything at once.
    pub fn reset(&mut self) {
        self.plan.clear();
        self.hidden_variance = 0.0;
        self.bound = CalmBound::default();
        self.still |= !self.asleep;
        self.asleep = true;
    }

    /// Lets time pass under the rain. Returns the number of steps. Of more than a second, and of more than 32 steps not
    /// yet taken, the rest is dropped. Free while it does not rain and nothing moves.
    pub fn advance(&mut self, elapsed_ns: u64) -> u32 {
        let total = self.left_ns + elapsed_ns.min(MAX_ADVANCE_NS);
        self.left_ns = total % self.rules.step_ns;
        if self.asleep && self.diameters.is_none() {
            return 0;
        }
        let room = MAX_STEPS - self.plan.steps.len();
        let steps = ((total / self.rules.step_ns) as usize).min(room);
        // The source of variance is constant, and it decays as the waves do.
        let left = ops::exp(-self.variance_decay_per_s() * f64::from(steps as u32) * self.rules.step_s());
        self.hidden_variance = self.hidden_target + (self.hidden_variance - self.hidden_target) * left;
        for _ in 0..steps {
            self.rain();
            self.plan.finish(&self.rules, true);
            self.bound.step(self.rules.courant, self.rules.keep);
        }
        if self.diameters.is_none() && self.bound.ever_m(self.rules.courant, self.rules.keep) < CALM_M {
            self.reset();
            return 0;
        }
        steps as u32
    }

    /// The drops of the step with this number under the present rain, in the order in which they are added.
    pub fn for_each_drop(&self, step: u32, mut visit: impl FnMut(DropImpact)) {
        let Some(diameters) = &self.diameters else { return };
        let side_m = self.settings.side_m;
        let mean = self.drops_per_m2_s * side_m * side_m * self.rules.step_s();
        for_each_impact(self.settings.seed, [0, 0], step, mean, |event| {
            let [u, _, _] = hash::pcg3d([event.key[1], event.key[2], event.key[0]]);
            let diameter_mm = f64::from(diameters.diameter_mm(hash::unit_f32(u)));
            let [x_m, z_m] = event.place.map(|place| f64::from(place) * side_m);
            visit(DropImpact {
                x_m,
                z_m,
                diameter_mm,
                speed_m_s: terminal_velocity(diameter_mm),
            });
        });
    }

    /// Adds the drops of one step.
    fn rain(&mut self) {
        let rules = self.rules;
        let (mut plan, mut bound) = (core::mem::take(&mut self.plan), self.bound);
        self.for_each_drop(self.steps, |impact| {
            let way = drop_way(&rules, &impact);
            let norm = way.width * core::f64::consts::PI.sqrt();
            // A Laplacian of the factor F makes waves of F s²k/c: the norm of a gradient. What the bump adds to `back`
            // is its start from rest and does not raise it.
            let width_m = way.width * rules.cell_m;
            let push = 0.5 * impact.peak_velocity(rules.deepest_m(), width_m);
            bound.add(MARGIN * norm * (way.height + push * width_m / rules.speed_m_s), 0.0);
            plan.push(&rules, &way);
        });
        (self.plan, self.bound) = (plan, bound);
        self.asleep &= self.diameters.is_none();
        self.steps = self.steps.wrapping_add(1);
    }

    /// Number of steps done so far, which is that of the next step.
    #[must_use]
    pub fn steps(&self) -> u32 {
        self.steps
    }

    /// Whether nothing moves that can be seen, and it does not rain.
    #[must_use]
    pub fn is_calm(&self) -> bool {
        self.asleep && self.diameters.is_none()
    }

    /// The bound by which the tile falls asleep; no height exceeds [`CalmBound::height_m`].
    #[must_use]
    pub fn bound(&self) -> CalmBound {
        self.bound
    }

    /// Whether there is anything to record.
    #[must_use]
    pub fn wants_pass(&self) -> bool {
        !self.asleep || self.still
    }

    /// Hands the work since the last call over. Whatever `frame` held is gone.
    pub fn take(&mut self, frame: &mut WaveFrame) {
        let mut params = self.rules.params();
        if self.still {
            params.moved = [self.rules.cells as i32; 2];
        }
        params.blend = self.left_ns as f32 / self.rules.step_ns as f32;
        params.hidden_variance = self.hidden_variance as f32;
        frame.params = Some(params);
        frame.settle = self.still;
        frame.balance = false;
        frame.depths.clear();
        if self.depths_changed {
            let cells = self.rules.cells as usize;
            frame.depths.resize(cells * cells, 1.0);
        }
        frame.plan.clear();
        core::mem::swap(&mut frame.plan, &mut self.plan);
        self.depths_changed = false;
        self.still = false;
    }
}

/// A drop as a source that does not move: its own water, and its momentum.
fn drop_way(rules: &Rules, impact: &DropImpact) -> Way {
    let deepest = rules.deepest_m();
    let width_m = impact.width_m(rules.cell_m, deepest);
    let width = width_m / rules.cell_m;
    let scale = rules.courant / width;
    let bump = impact.volume_m3() / (core::f64::consts::TAU * width_m * width_m);
    let force = 0.5 * impact.peak_velocity(deepest, width_m);
    let at = [impact.x_m / rules.cell_m, impact.z_m / rules.cell_m];
    Way {
        start: at,
        end: at,
        width,
        height: bump,
        back: 0.5 * scale * scale * bump - (1.0 + rules.half_damping) * rules.step_s() * force,
    }
}
