//! Settings of the tiles, disturbances, and what a step needs of them.

use rain_core::constants::GRAVITY;
use rain_core::error::{ConfigError, in_range};
use rain_core::ops;
use rain_core::waves::{Border, Push, Stencil, WaveSettings, shallow_speed};

use crate::gpu_types::WaveParams;

/// Most disturbances that one call of [`super::WaveTile::advance`] takes.
pub const MAX_DISTURBANCES: usize = 64;

/// Water shallower than this is dry to waves: a film on the road carries none. Units: m.
const LEAST_DEPTH_M: f64 = 5e-4;

/// Strength of the absorbing rim: what crosses it and comes back is e^(−strength/3) of the wave, and stronger would
/// reflect at its rise. Chosen by trial.
const RIM_STRENGTH: f64 = 10.0;

/// Settings of a [`super::WaveTile`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WaveTileSettings {
    /// Cells on a side. Domain: a power of two in [32, 1024]. Default: 256.
    pub cells: u32,
    /// Edge of a cell. Units: m. Domain: [1e-3, 1]. Default: 0.025, a tile of 6.4 m: of waves of 0.3 m the speed is
    /// within 1 %, a ring come back from an upright round shore within 10 % (L2).
    pub cell_m: f64,
    /// Depth at which waves are fastest; deeper water counts as that. Units: m. Domain: [1e-3, 10]. Default: 0.1.
    pub deepest_m: f64,
    /// Damping k_d of the velocity, as in the CPU's field. Units: 1/s. Domain: [0, 1e4]. Default: 0, since `decay_per_s`
    /// damps all waves alike.
    pub damping_per_s: f64,
    /// Decay of all heights, the mean level included: the level belongs to the puddle. Units: 1/s. Domain: [0, 100]; with
    /// 0 a tile never falls asleep. Default: 0.3, that of waves of 2–5 cm on 5 mm of water (half of a k_d of 0.6); a
    /// tile is then calm about a minute after a wheel.
    pub decay_per_s: f64,
    /// Width of a rim that takes up waves, so that they do not come back from the edge of the tile; the map fades there.
    /// 0: a wall. Units: cells. Domain: [0, cells/4]. Default: 16.
    pub rim_cells: u32,
    /// The tile moves by this much at once. Units: cells. Domain: a power of two in [1, cells/4]. Default: 16.
    pub snap_cells: u32,
    /// The interval that is cut into sub-steps. Units: ns. Domain: [1, 1e9]. Default: 1/60 s.
    pub tick_ns: u64,
}

impl Default for WaveTileSettings {
    fn default() -> Self {
        Self {
            cells: 256,
            cell_m: 0.025,
            deepest_m: 0.1,
            damping_per_s: 0.0,
            decay_per_s: 0.3,
            rim_cells: 16,
            snap_cells: 16,
            tick_ns: 16_666_667,
        }
    }
}

impl WaveTileSettings {
    /// The field of the CPU that makes the same waves, but for decay and rim.
    #[must_use]
    pub fn twin(&self) -> WaveSettings {
        WaveSettings {
            cells_x: self.cells,
            cells_z: self.cells,
            cell_m: self.cell_m,
            speed_m_s: shallow_speed(self.deepest_m),
            damping_per_s: self.damping_per_s,
            stencil: Stencil::FivePoint,
            border: Border::Wall,
            tick_ns: self.tick_ns,
            step_ns: None,
        }
    }

    /// The map's texture, for the host to make.
    #[must_use]
    pub fn map_texture(&self) -> wgpu::TextureDescriptor<'static> {
        crate::slope_mips::slope_texture("rain waves", self.cells, self.cells)
    }

    /// # Errors
    /// For the first value outside its domain.
    pub(super) fn rules(&self) -> Result<Rules, ConfigError> {
        power_of_two("cells", self.cells, 32, 1024, "a power of two in 32 to 1024")?;
        in_range("cell_m", self.cell_m, 1e-3, 1.0, "0.001 to 1 m")?;
        in_range("deepest_m", self.deepest_m, 1e-3, 10.0, "0.001 to 10 m")?;
        let rim_allowed = "0 to a quarter of the cells";
        let quarter = self.cells / 4;
        in_range(
            "rim_cells",
            f64::from(self.rim_cells),
            0.0,
            f64::from(quarter),
            rim_allowed,
        )?;
        let snap_allowed = "a power of two, up to a quarter of the cells";
        power_of_two("snap_cells", self.snap_cells, 1, quarter, snap_allowed)?;
        Rules::new(&self.twin(), self.decay_per_s, self.rim_cells)
    }
}

/// Settings of a [`super::RippleTile`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RippleSettings {
    /// Cells on a side. Domain: a power of two in [32, 1024]. Default: 256.
    pub cells: u32,
    /// Side of the tile, after which it repeats. Units: m. Domain: [0.1, 20]. Default: 1.
    ///
    /// A drop's footprint is two cells at least, and slopes fall with its cube: cells of 7.8 mm show a root mean square
    /// of 0.0045 at 25 mm/h, cells of 3.9 mm (the default) 0.025, of 2 mm 0.055; no cells, 0.07
    /// (see [`rain_core::waves::rain_slope_variance`]). The map holds what the cells do not show as variance.
    pub side_m: f64,
    /// Depth of the water. Units: m. Domain: [1e-3, 1]. Default: 0.005.
    pub depth_m: f64,
    /// Decay of all heights, as in [`WaveTileSettings`]. Units: 1/s. Domain: [0, 100]. Default: 0.3.
    pub decay_per_s: f64,
    /// Smaller drops make no rings. Units: mm. Domain: [0.1, 5]. Default: 0.5: from 1 mm/h on less than 1 % of the rms
    /// slope is theirs.
    pub least_drop_mm: f64,
    /// Which drops fall when and where.
    pub seed: u32,
    /// The interval that is cut into sub-steps. Units: ns. Domain: [1, 1e9]. Default: 1/60 s.
    pub tick_ns: u64,
}

impl Default for RippleSettings {
    fn default() -> Self {
        Self {
            cells: 256,
            side_m: 1.0,
            depth_m: 0.005,
            decay_per_s: 0.3,
            least_drop_mm: 0.5,
            seed: 0,
            tick_ns: 16_666_667,
        }
    }
}

impl RippleSettings {
    /// Edge of a cell. Units: m.
    #[must_use]
    pub fn cell_m(&self) -> f64 {
        self.side_m / f64::from(self.cells)
    }

    /// The field of the CPU that makes the same waves, but for the decay.
    #[must_use]
    pub fn twin(&self) -> WaveSettings {
        WaveSettings {
            cells_x: self.cells,
            cells_z: self.cells,
            cell_m: self.cell_m(),
            speed_m_s: shallow_speed(self.depth_m),
            damping_per_s: 0.0,
            stencil: Stencil::FivePoint,
            border: Border::Periodic,
            tick_ns: self.tick_ns,
            step_ns: None,
        }
    }

    /// The map's texture, for the host to make. It is sampled with repeat.
    #[must_use]
    pub fn map_texture(&self) -> wgpu::TextureDescriptor<'static> {
        crate::slope_mips::slope_texture("rain ripple tile", self.cells, self.cells)
    }

    /// # Errors
    /// For the first value outside its domain.
    pub(super) fn rules(&self) -> Result<Rules, ConfigError> {
        power_of_two("cells", self.cells, 32, 1024, "a power of two in 32 to 1024")?;
        in_range("side_m", self.side_m, 0.1, 20.0, "0.1 to 20 m")?;
        in_range("depth_m", self.depth_m, 1e-3, 1.0, "0.001 to 1 m")?;
        in_range("least_drop_mm", self.least_drop_mm, 0.1, 5.0, "0.1 to 5 mm")?;
        Rules::new(&self.twin(), self.decay_per_s, 0)
    }
}

fn power_of_two(
    field: &'static str,
    value: u32,
    low: u32,
    high: u32,
    allowed: &'static str,
) -> Result<(), ConfigError> {
    let fits = value.is_power_of_two() && (low..=high).contains(&value);
    let error = ConfigError::OutOfRange {
        field,
        value: f64::from(value),
        allowed,
    };
    fits.then_some(()).ok_or(error)
}

/// Factors of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rules {
    pub cells: u32,
    pub cell_m: f64,
    pub periodic: bool,
    pub step_ns: u64,
    pub courant: f64,
    pub speed_m_s: f64,
    /// a = k_d dt/2.
    pub half_damping: f64,
    /// Share of all heights that a step leaves.
    pub keep: f64,
    pub decay_per_s: f64,
    pub rim_cells: u32,
}

impl Rules {
    fn new(twin: &WaveSettings, decay_per_s: f64, rim_cells: u32) -> Result<Self, ConfigError> {
        in_range("decay_per_s", decay_per_s, 0.0, 100.0, "0 to 100 1/s")?;
        let step_ns = twin.checked_step_ns()?;
        let step_s = step_ns as f64 * 1e-9;
        Ok(Self {
            cells: twin.cells_x,
            cell_m: twin.cell_m,
            periodic: twin.border == Border::Periodic,
            step_ns,
            courant: twin.speed_m_s * step_s / twin.cell_m,
            speed_m_s: twin.speed_m_s,
            half_damping: 0.5 * twin.damping_per_s * step_s,
            keep: ops::exp(-decay_per_s * step_s),
            decay_per_s,
            rim_cells,
        })
    }

    pub fn step_s(&self) -> f64 {
        self.step_ns as f64 * 1e-9
    }

    /// Depth of the fastest wave. Units: m.
    pub fn deepest_m(&self) -> f64 {
        self.speed_m_s * self.speed_m_s / GRAVITY
    }

    /// The parameters, but for what changes from frame to frame.
    pub fn params(&self) -> WaveParams {
        let rim = f64::from(self.rim_cells);
        WaveParams {
            cells: self.cells,
            periodic: self.periodic.into(),
            offset: [0; 2],
            moved: [0; 2],
            first_source: 0,
            first_bin: 0,
            courant_squared: (self.courant * self.courant) as f32,
            g: ((1.0 - self.half_damping) / (1.0 + self.half_damping)) as f32,
            keep: self.keep as f32,
            inverse_keep: (1.0 / self.keep) as f32,
            blend: 1.0,
            per_cell: (1.0 / self.cell_m) as f32,
            rim: rim as f32,
            rim_damping: (0.5 * RIM_STRENGTH * self.courant / rim.max(1.0)) as f32,
            hidden_variance: 0.0,
            pad_a: 0,
            pad_b: 0,
            pad_c: 0,
        }
    }
}

/// Something that moves the water on its straight way through a frame: a [`rain_core::waves::SweptSource`] in the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disturbance {
    /// Where it was, world (x, z). Units: m. Domain: [−1e9, 1e9].
    pub from_m: [f64; 2],
    /// Where it is. Units: m.
    pub to_m: [f64; 2],
    /// Standard deviation of its footprint; a tyre of width b has b/√12. Units: m. Domain: [1e-4, 100]; widened to two
    /// cells.
    pub width_m: f64,
    /// How it acts, in sum over its way.
    pub push: Push,
}

impl Disturbance {
    pub(super) fn check(&self) -> Result<(), ConfigError> {
        for (name, point) in [("from_m", self.from_m), ("to_m", self.to_m)] {
            for at in point {
                in_range(name, at, -1e9, 1e9, "-1e9 to 1e9 m")?;
            }
        }
        in_range("width_m", self.width_m, 1e-4, 100.0, "1e-4 to 100 m")?;
        let (name, value) = match self.push {
            Push::Height(height) => ("height_m", height),
            Push::Impulse(impulse) => ("impulse_n_s", impulse),
        };
        in_range(name, f64::from(value), -1e6, 1e6, "-1e6 to 1e6").map(|_| ())
    }
}

/// Depth of the water of a level over the ground, as [`super::WaveTile::follow`] wants it. Units: m.
///
/// Both heights in m. Less than half a millimetre is dry, and so is where either is not a number or there is no level
/// (−1e9).
#[must_use]
pub fn water_depth_m(level_m: f64, ground_m: f64) -> f32 {
    let depth = level_m - ground_m;
    if depth >= LEAST_DEPTH_M && depth.is_finite() {
        depth as f32
    } else {
        0.0
    }
}
