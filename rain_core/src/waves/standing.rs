//! A standing wave in a square basin, stepped, in the scheme's closed form, and in nature's.

use super::double::{DoubleField, standing};
use super::stencil::Stencil;
use crate::error::{ConfigError, in_range};
use crate::ops;

/// Most work that one run may take. Units: cell steps.
const MAX_WORK: f64 = 2e10;

/// A mode of a square basin with walls, released from rest with amplitude 1: double precision, five points, no damping.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StandingWave {
    /// Cells along each side. Domain: [2, 4096].
    pub cells: u32,
    /// Half waves along x. Domain: [0, cells).
    pub mode_x: u32,
    /// Half waves along y. Domain: [0, cells).
    pub mode_y: u32,
    /// How long. Units: s. Domain: [0, 1e6]; rounded to whole steps.
    pub time_s: f64,
    /// C = c dt/dx. Domain: (0, 0.70]. Default: 0.7.
    pub courant: f64,
    /// Wave speed c. Units: m/s. Domain: [1e-6, 1e3]. Default: 0.2214, that of 5 mm of water.
    pub speed_m_s: f64,
    /// Side of the basin. Units: m. Domain: [1e-6, 1e6]. Default: 1.
    pub length_m: f64,
}

/// What became of a [`StandingWave`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StandingWaveResult {
    /// Steps done: round(time · speed/(courant · dx)).
    pub steps: u64,
    /// Amplitude of the mode in the field after them.
    pub amplitude: f64,
    /// What the scheme must give: cos(steps · φ), sin(φ/2) = C√λ/2.
    pub discrete_amplitude: f64,
    /// What the wave equation gives at the time of the last step: cos(πc√(m² + n²) t/length).
    pub exact_amplitude: f64,
    /// |E/E₀ − 1| of the scheme's energy between the first step and the last; 0 without a wave.
    pub energy_drift: f64,
}

impl StandingWave {
    /// The mode (m, n) on `cells`² cells for `time_s`, with the defaults of the other fields.
    #[must_use]
    pub fn new(cells: u32, mode_x: u32, mode_y: u32, time_s: f64) -> Self {
        Self {
            cells,
            mode_x,
            mode_y,
            time_s,
            courant: 0.7,
            speed_m_s: 0.2214,
            length_m: 1.0,
        }
    }

    /// Runs it. Allocates two heights a cell.
    ///
    /// Error: |amplitude − discrete_amplitude| ≤ 1e-11 and energy drift ≤ 1e-12 after 500 steps.
    ///
    /// # Errors
    /// [`ConfigError::OutOfRange`] for a field outside its domain, and for more than 2e10 cell steps (`time_s`).
    pub fn run(&self) -> Result<StandingWaveResult, ConfigError> {
        in_range("cells", f64::from(self.cells), 2.0, 4096.0, "2 to 4096 cells")?;
        let below = f64::from(self.cells) - 1.0;
        in_range("mode_x", f64::from(self.mode_x), 0.0, below, "0 to cells - 1")?;
        in_range("mode_y", f64::from(self.mode_y), 0.0, below, "0 to cells - 1")?;
        in_range("time_s", self.time_s, 0.0, 1e6, "0 to 1e6 s")?;
        Stencil::FivePoint.check_courant(self.courant)?;
        in_range("speed_m_s", self.speed_m_s, 1e-6, 1e3, "1e-6 to 1000 m/s")?;
        in_range("length_m", self.length_m, 1e-6, 1e6, "1e-6 to 1e6 m")?;
        let cells = self.cells as usize;
        let dx = self.length_m / f64::from(self.cells);
        let steps = (self.time_s * self.speed_m_s / (self.courant * dx)).round();
        in_range(
            "time_s",
            if steps * (cells * cells) as f64 <= MAX_WORK {
                0.0
            } else {
                self.time_s
            },
            0.0,
            0.0,
            "at most 2e10 cell steps: fewer cells or less time",
        )?;
        let (m, n) = (self.mode_x as usize, self.mode_y as usize);
        let mut field = DoubleField::new(cells, Stencil::FivePoint, self.courant, 0.0, |i, j| {
            standing(cells, m, i) * standing(cells, n, j)
        })?;
        let start = field.energy();
        field.step(steps as u64);
        let end = field.energy();
        let half = |mode: usize| ops::sin(core::f64::consts::PI * mode as f64 / (2 * cells) as f64);
        // C√λ/2 with λ = 4 (sin² + sin²).
        let sine = self.courant * ops::sqrt(half(m) * half(m) + half(n) * half(n));
        let phase = 2.0 * ops::atan2(sine, ops::sqrt((1.0 - sine) * (1.0 + sine)));
        // Half waves run past a wall: c t/length = steps · C/cells.
        let way = steps * self.courant / f64::from(self.cells);
        let number = ops::sqrt((m * m + n * n) as f64);
        Ok(StandingWaveResult {
            steps: steps as u64,
            amplitude: field.amplitude(m, n),
            discrete_amplitude: ops::cos(steps * phase),
            exact_amplitude: ops::cos(core::f64::consts::PI * number * way),
            energy_drift: if m + n == 0 { 0.0 } else { (end / start - 1.0).abs() },
        })
    }
}
