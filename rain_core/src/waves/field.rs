//! The field of waves: two levels of heights and their fixed steps.

use super::bands::{self, FUSED};
use super::bed::Bed;
use super::border::{Border, sponge_profile};
use super::rows::Rules;
use super::settings::WaveSettings;
use super::stencil::Stencil;
use crate::constants::GRAVITY;
use crate::error::{ConfigError, in_range};

/// Longest time that one call of [`WaveField::advance`] makes up for. Units: ns.
const MAX_ADVANCE_NS: u64 = 1_000_000_000;

/// Steps after which the mean level is set right.
const DRIFT_STEPS: u32 = 256;

/// Heights of a water surface above its level, under u_tt + k_d u_t = ∇·(c²∇u) + s.
///
/// Single precision, row-major, cell (i, j) at `j · cells_x + i`. Leap-frog in fixed sub-steps: the result after a time
/// does not depend on how that time was cut into frames, and not on the number of threads, bit for bit. Fields of 512²
/// cells and more use all threads of the current rayon pool.
///
/// Construction allocates two heights a cell, three more numbers a cell once [`WaveField::set_depths`] is called, and
/// one line along each axis. Steps and sources allocate nothing; [`WaveField::set_step_ns`] under an open border makes
/// its sponge anew. (Stepped by all threads from a thread outside the pool, rayon's queue takes a block of 1.5 KiB every
/// 63 passes.)
///
/// Stable for every damping and every depth up to that of `speed_m_s`, since C² λ_max < 4; without damping the energy
/// ½Σ(u⁺−u)² − ½C²Σu⁺Lu is conserved.
///
/// Error: ≤ 1e-5 of the amplitude against the exact solution of the scheme after 500 steps; second order in the cell
/// against the wave equation: at C = 0.7 waves of 8 cells are 1.3 % too slow along the axes and exact on the diagonal.
#[derive(Debug, Clone)]
pub struct WaveField {
    pub(super) settings: WaveSettings,
    pub(super) rules: Rules,
    step_ns: u64,
    pub(super) now: Vec<f32>,
    pub(super) before: Vec<f32>,
    /// Time not yet stepped.
    left_ns: u64,
    /// What Σu of `now` and of `before` should be, by the sources and the damping alone.
    pub(super) sum_now: f64,
    pub(super) sum_before: f64,
    unchecked_steps: u32,
    /// All heights are exactly 0: steps change nothing.
    pub(super) still: bool,
    /// Shape of a source along x and z.
    pub(super) shape_x: Vec<f64>,
    pub(super) shape_z: Vec<f64>,
}

impl WaveField {
    /// Still water.
    ///
    /// Error: see the type; an open border sends back 0.2 % at normal incidence, (1 − cos θ)/(1 + cos θ) at θ.
    ///
    /// # Errors
    /// [`ConfigError::OutOfRange`] for a setting outside its domain, among them a step above the stability bound.
    pub fn new(settings: &WaveSettings) -> Result<Self, ConfigError> {
        let step_ns = settings.checked_step_ns()?;
        let (nx, nz) = (settings.cells_x as usize, settings.cells_z as usize);
        let mut field = Self {
            settings: *settings,
            rules: Rules {
                nx,
                nz,
                stencil: settings.stencil,
                border: settings.border,
                c2: 0.0,
                g: 1.0,
                sponge_x: Vec::new(),
                sponge_z: Vec::new(),
                bed: None,
            },
            step_ns,
            now: vec![0.0; nx * nz],
            before: vec![0.0; nx * nz],
            left_ns: 0,
            sum_now: 0.0,
            sum_before: 0.0,
            unchecked_steps: 0,
            still: true,
            shape_x: vec![0.0; nx],
            shape_z: vec![0.0; nz],
        };
        field.tune();
        Ok(field)
    }

    /// Sets the factors of a step from speed, damping and step.
    fn tune(&mut self) {
        let courant = self.courant();
        let a = self.half_damping();
        let g = (1.0 - a) / (1.0 + a);
        self.rules.c2 = (courant * courant) as f32;
        self.rules.g = g as f32;
        let sponge = self.settings.border.sponge_cells();
        if sponge > 0 {
            self.rules.sponge_x = sponge_profile(self.rules.nx, sponge, courant, 1.0);
            self.rules.sponge_z = sponge_profile(self.rules.nz, sponge, courant, g);
        }
    }

    /// a = k_d dt/2.
    pub(super) fn half_damping(&self) -> f64 {
        0.5 * self.settings.damping_per_s * self.step_s()
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &WaveSettings {
        &self.settings
    }

    /// The sub-step. Units: s.
    #[must_use]
    pub fn step_s(&self) -> f64 {
        self.step_ns as f64 * 1e-9
    }

    /// The Courant number of the fastest wave, c dt/dx.
    #[must_use]
    pub fn courant(&self) -> f64 {
        self.settings.courant(self.step_ns)
    }

    /// Heights above the level, row-major. Units: m.
    #[must_use]
    pub fn heights(&self) -> &[f32] {
        &self.now
    }

    /// Depth of the water in cell `index` relative to that of the fastest wave; 0 is dry.
    pub(super) fn relative_depth(&self, index: usize) -> f32 {
        self.rules.bed.as_ref().map_or(1.0, |bed| bed.depth[index])
    }

    /// Depth of the fastest wave, c²/g. Units: m.
    pub(super) fn deepest_m(&self) -> f64 {
        self.settings.speed_m_s * self.settings.speed_m_s / GRAVITY
    }

    /// Number of cells that are not dry.
    pub(super) fn wet_cells(&self) -> usize {
        self.rules.bed.as_ref().map_or(self.now.len(), |bed| bed.wet)
    }

    /// Sets the depth of every cell: m, row-major, 0 for shores and obstacles. Waves then run with √(g h) of the face
    /// between two cells and come back from dry ones; the water between dry cells is conserved.
    ///
    /// Heights stay where both old and new bed are wet. What stood on cells that fall dry leaves the field; its volume
    /// in m³ is returned. Allocates when called first.
    ///
    /// Error: water is kept to 1e-9 of its volume (or of 1 m³).
    ///
    /// # Errors
    /// [`ConfigError::OutOfRange`] for a length that is not that of the field (`depths`), for a depth that is not in
    /// [0, c²/g] (`depth_m`), and for a nine-point field, which has no flux form (`stencil_points`); then nothing has
    /// changed.
    pub fn set_depths(&mut self, depth_m: &[f32]) -> Result<f64, ConfigError> {
        self.check_length("depths", depth_m.len())?;
        if self.rules.stencil == Stencil::NinePoint {
            let allowed = "5 where depths differ";
            in_range("stencil_points", 9.0, 5.0, 5.0, allowed)?;
        }
        // Half a per mille for the rounding of a speed given with four digits; C² is bounded by a per cent more.
        let deepest = self.deepest_m() * 1.000_5;
        for depth in depth_m {
            let allowed = "0 to c²/g m, c the field's fastest wave";
            in_range("depth_m", f64::from(*depth), 0.0, deepest, allowed)?;
        }
        let per_depth = 1.0 / self.deepest_m();
        let wraps = self.settings.border == Border::Periodic;
        let cells = self.now.len();
        let bed = self.rules.bed.get_or_insert_with(|| Bed::dry(cells));
        bed.set(self.rules.nx, wraps, |index| {
            (f64::from(depth_m[index]) * per_depth) as f32
        });
        let mut lost = [0.0; 2];
        for index in 0..cells {
            // Not the depth itself: a denormal one is none over the deepest.
            if self.relative_depth(index) == 0.0 {
                lost[0] += f64::from(core::mem::take(&mut self.now[index]));
                lost[1] += f64::from(core::mem::take(&mut self.before[index]));
            }
        }
        self.sum_now -= lost[0];
        self.sum_before -= lost[1];
        Ok(lost[0] * self.cell_area_m2())
    }

    pub(super) fn cell_area_m2(&self) -> f64 {
        self.settings.cell_m * self.settings.cell_m
    }

    fn check_length(&self, field: &'static str, length: usize) -> Result<(), ConfigError> {
        let cells = self.now.len() as f64;
        in_range(field, length as f64, cells, cells, "one for each cell").map(|_| ())
    }

    /// Sets heights in m and velocities in m/s, row-major; nothing of what was before stays. An empty slice is 0
    /// everywhere. Dry cells, and the border of a [`Border::Fixed`] field, stay at 0.
    ///
    /// The first step is the second-order start u¹ = u⁰ + ½C²Lu⁰ + dt (1 − a) u_t.
    ///
    /// # Errors
    /// [`ConfigError::OutOfRange`] for a slice of another length (`heights`, `velocities`) and for a value that is not
    /// finite or above 1e6 (`height_m`, `velocity_m_s`); then nothing has changed.
    pub fn set_state(&mut self, height_m: &[f32], velocity_m_s: &[f32]) -> Result<(), ConfigError> {
        for (what, name, values) in [
            ("heights", "height_m", height_m),
            ("velocities", "velocity_m_s", velocity_m_s),
        ] {
            if values.is_empty() {
                continue;
            }
            self.check_length(what, values.len())?;
            for value in values {
                in_range(name, f64::from(*value), -1e6, 1e6, "-1e6 to 1e6, finite")?;
            }
        }
        for index in 0..self.now.len() {
            let there = self.accepts(index % self.rules.nx, index / self.rules.nx);
            let height = height_m.get(index).copied().unwrap_or(0.0);
            self.now[index] = if there { height } else { 0.0 };
        }
        self.start_from_rest();
        let scale = ((1.0 + self.half_damping()) * self.step_s()) as f32;
        let mut kick = 0.0;
        for (index, velocity) in velocity_m_s.iter().enumerate() {
            if self.accepts(index % self.rules.nx, index / self.rules.nx) {
                self.before[index] -= scale * velocity;
                kick += f64::from(scale * velocity);
            }
        }
        // L moves no water, so both levels have one sum but for the velocities. The border lets water through
        // otherwise.
        self.sum_now = super::energy::sum(&self.now);
        self.sum_before = self.sum_now - kick;
        self.still = false;
        Ok(())
    }

    /// Whether a source may change cell (i, j): wet, and not on a fixed border.
    pub(super) fn accepts(&self, i: usize, j: usize) -> bool {
        let rules = &self.rules;
        let edge = i == 0 || j == 0 || i == rules.nx - 1 || j == rules.nz - 1;
        !(edge && rules.border == Border::Fixed) && self.relative_depth(j * rules.nx + i) > 0.0
    }

    /// u⁻ = u + ½C²Lu: the level before, had the water been at rest now.
    fn start_from_rest(&mut self) {
        // A step with g = 0 over a copy of u is just that.
        let border = self.rules.border;
        if matches!(border, Border::Open { .. }) {
            self.rules.border = Border::Wall;
        }
        let g = core::mem::replace(&mut self.rules.g, 0.0);
        let sponge_x = core::mem::take(&mut self.rules.sponge_x);
        self.before.copy_from_slice(&self.now);
        bands::run(&self.rules, &mut self.before, &mut self.now, 1);
        self.rules.sponge_x = sponge_x;
        self.rules.g = g;
        self.rules.border = border;
    }

    /// Lets time pass; whole sub-steps are done, the rest is kept for the next call. Returns the number of steps.
    ///
    /// `elapsed_ns`: ns, 0 is nothing. Of more than a second, the rest is dropped: a game that stood still does not
    /// have to be caught up with.
    pub fn advance(&mut self, elapsed_ns: u64) -> u32 {
        self.left_ns += elapsed_ns.min(MAX_ADVANCE_NS);
        let steps = self.left_ns / self.step_ns;
        self.left_ns %= self.step_ns;
        let steps = u32::try_from(steps).unwrap_or(u32::MAX);
        self.step(steps);
        steps
    }

    /// Does `steps` sub-steps, whatever the time.
    pub fn step(&mut self, steps: u32) {
        if self.still {
            return;
        }
        let mut left = steps;
        while left > 0 {
            let block = left.min(FUSED as u32).min(DRIFT_STEPS - self.unchecked_steps);
            bands::run(&self.rules, &mut self.before, &mut self.now, block as usize);
            if block % 2 == 1 {
                core::mem::swap(&mut self.before, &mut self.now);
            }
            for _ in 0..block {
                let next = self.sum_now + f64::from(self.rules.g) * (self.sum_now - self.sum_before);
                self.sum_before = core::mem::replace(&mut self.sum_now, next);
            }
            left -= block;
            self.unchecked_steps += block;
            if self.unchecked_steps == DRIFT_STEPS {
                self.unchecked_steps = 0;
                self.remove_drift();
            }
        }
    }

    /// Changes the sub-step. Units: ns. The velocity is kept: u⁻ ← u − (u − u⁻)·dt_new/dt_old.
    ///
    /// # Errors
    /// [`ConfigError::OutOfRange`] (`courant`) above the stability bound; then nothing has changed.
    pub fn set_step_ns(&mut self, step_ns: u64) -> Result<(), ConfigError> {
        let settings = WaveSettings {
            step_ns: Some(step_ns),
            ..self.settings
        };
        settings.checked_step_ns()?;
        let ratio = step_ns as f64 / self.step_ns as f64;
        for (before, now) in self.before.iter_mut().zip(&self.now) {
            *before = now - (now - *before) * ratio as f32;
        }
        self.sum_before = self.sum_now - (self.sum_now - self.sum_before) * ratio;
        self.settings = settings;
        self.step_ns = step_ns;
        self.tune();
        Ok(())
    }
}
