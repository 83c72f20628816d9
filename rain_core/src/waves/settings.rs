//! What a field of waves is made from.

use super::border::Border;
use super::stencil::{Stencil, sub_steps};
use crate::error::{ConfigError, in_range};

/// Settings of a [`super::WaveField`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WaveSettings {
    /// Cells in a row, along x. Domain: [4, 16384]. Default: 256.
    pub cells_x: u32,
    /// Rows, along z. Domain: [4, 16384]. Default: 256.
    pub cells_z: u32,
    /// Edge of a cell. Units: m. Domain: [1e-4, 100]. Default: 2/256, a tile of 2 m.
    pub cell_m: f64,
    /// Speed of the fastest wave in the field, √(g h) of its deepest water. Units: m/s. Domain: [1e-3, 100].
    /// Default: 0.22143, that of 5 mm.
    pub speed_m_s: f64,
    /// Damping k_d of the velocity, twice the decay rate of the amplitude. Units: 1/s. Domain: [0, 1e4]. Default: 0.6,
    /// a choice near the bulk and bottom friction of waves of 2–5 cm on 5 mm of water.
    pub damping_per_s: f64,
    /// Sum over the neighbours. Default: five points.
    pub stencil: Stencil,
    /// The edge of the field. Default: walls.
    pub border: Border,
    /// The interval that is cut into sub-steps. Units: ns. Domain: [1, 1e9]. Default: 1/60 s.
    pub tick_ns: u64,
    /// A sub-step of one's own, instead of the longest that divides the tick. Units: ns. Domain: positive, and
    /// c dt/dx no more than [`Stencil::max_courant`]. Default: none.
    pub step_ns: Option<u64>,
}

impl Default for WaveSettings {
    fn default() -> Self {
        Self {
            cells_x: 256,
            cells_z: 256,
            cell_m: 2.0 / 256.0,
            speed_m_s: super::shallow_speed(0.005),
            damping_per_s: 0.6,
            stencil: Stencil::FivePoint,
            border: Border::Wall,
            tick_ns: 16_666_667,
            step_ns: None,
        }
    }
}

impl WaveSettings {
    /// The sub-step that a field with these settings takes. Units: ns.
    ///
    /// # Errors
    /// [`ConfigError::OutOfRange`] for the first value outside its domain; a step too long is reported as `courant`.
    pub fn checked_step_ns(&self) -> Result<u64, ConfigError> {
        let cells = "4 to 16384 cells";
        in_range("cells_x", f64::from(self.cells_x), 4.0, 16_384.0, cells)?;
        in_range("cells_z", f64::from(self.cells_z), 4.0, 16_384.0, cells)?;
        in_range("cell_m", self.cell_m, 1e-4, 100.0, "1e-4 to 100 m")?;
        in_range("speed_m_s", self.speed_m_s, 1e-3, 100.0, "1e-3 to 100 m/s")?;
        in_range("damping_per_s", self.damping_per_s, 0.0, 1e4, "0 to 1e4 1/s")?;
        in_range("tick_ns", self.tick_ns as f64, 1.0, 1e9, "1 to 1e9 ns")?;
        let half = f64::from(self.cells_x.min(self.cells_z)) / 2.0 - 1.0;
        in_range(
            "sponge_cells",
            self.border.sponge_cells() as f64,
            0.0,
            half.min(64.0),
            "0 to 64 cells, less than half the field",
        )?;
        let step = self.step_ns.unwrap_or_else(|| {
            let interval = self.tick_ns as f64 * 1e-9;
            // Rounded down, so the bound holds; at least a nanosecond, which the domains above make safe.
            (self.tick_ns / u64::from(sub_steps(self.stencil, self.speed_m_s, interval, self.cell_m))).max(1)
        });
        self.stencil.check_courant(self.courant(step))?;
        Ok(step)
    }

    /// C = c dt/dx of a step.
    pub(super) fn courant(&self, step_ns: u64) -> f64 {
        self.speed_m_s * step_ns as f64 * 1e-9 / self.cell_m
    }
}
