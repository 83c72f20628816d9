//! A drop that falls into the water.

use super::field::WaveField;
use crate::constants::WATER_DENSITY;
use crate::error::{ConfigError, in_range};
use crate::ops;
use crate::splash::{crater_radius_m, impact_momentum_kg_m_s};

/// Largest |Δu_t| over the wave speed for which linear theory is used.
const LINEAR_LIMIT: f64 = 0.3;

/// A drop's impact on still water.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DropImpact {
    /// Where, along a row. Units: m from the field's corner.
    pub x_m: f64,
    /// Where, from row to row. Units: m from the field's corner.
    pub z_m: f64,
    /// Diameter of the drop. Units: mm. Domain: [0, 10].
    pub diameter_mm: f64,
    /// Speed downwards. Units: m/s. Domain: [0, 30].
    pub speed_m_s: f64,
}

impl DropImpact {
    /// # Errors
    /// [`ConfigError::OutOfRange`] for a field outside its domain or not finite.
    pub(super) fn check(&self) -> Result<(), ConfigError> {
        let far = "-1e6 to 1e6 m";
        in_range("x_m", self.x_m, -1e6, 1e6, far)?;
        in_range("z_m", self.z_m, -1e6, 1e6, far)?;
        in_range("diameter_mm", self.diameter_mm, 0.0, 10.0, "0 to 10 mm")?;
        in_range("speed_m_s", self.speed_m_s, 0.0, 30.0, "0 to 30 m/s").map(|_| ())
    }

    /// Volume of the drop. Units: m³. Error: relative 1e-15.
    #[must_use]
    pub fn volume_m3(&self) -> f64 {
        let d = self.diameter_mm * 1e-3;
        core::f64::consts::FRAC_PI_6 * d * d * d
    }

    /// Momentum m v. Units: kg m/s. Error: relative 1e-15.
    #[must_use]
    pub fn momentum(&self) -> f64 {
        impact_momentum_kg_m_s(self.diameter_mm, self.speed_m_s)
    }

    /// Largest change of the surface's velocity, at the middle of the impact: (h/ρ) m v/(π s⁴). Units: m/s; depth and
    /// width s in m.
    ///
    /// Error: relative 1e-8 against differences of J.
    #[must_use]
    pub fn peak_velocity(&self, depth_m: f64, width_m: f64) -> f64 {
        let s2 = width_m * width_m;
        depth_m * self.momentum() / (WATER_DENSITY * core::f64::consts::PI * s2 * s2)
    }

    /// Standard deviation s of the source: half the crater, no less than two cells, and wide enough that the surface
    /// moves at no more than 0.3 of the wave speed. Units: m; cell and depth in m.
    ///
    /// Error: relative 1e-6 against halving and a crater summed by slices; that a crater makes the ring is a choice.
    #[must_use]
    pub fn width_m(&self, cell_m: f64, depth_m: f64) -> f64 {
        let crater = 0.5 * crater_radius_m(self.diameter_mm, self.speed_m_s, 1.0);
        let limit = LINEAR_LIMIT * super::shallow_speed(depth_m);
        let linear = if limit > 0.0 {
            ops::sqrt(ops::sqrt(self.peak_velocity(depth_m, 1.0) / limit))
        } else {
            0.0
        };
        crater.max(2.0 * cell_m).max(linear)
    }
}

impl WaveField {
    /// Drops fall one by one: a pressure impulse J = m v e^(−r²/2s²)/(2πs²) changes the surface's velocity by
    /// (h/ρ)∇²J and moves no water in sum; the drop's own volume raises it by V e^(−r²/2s²)/(2πs²).
    ///
    /// Returns whether the drop met water: not outside the field, on a dry cell or on a fixed border. What of the shape
    /// falls on such cells goes to the others. Both sums are met to rounding: the discrete Laplacian's own sum is
    /// taken out, in proportion to the Gaussian, and volume over the cell's area is the discrete sum of the bump.
    ///
    /// Error: volume 1e-6 in the heights, 1e-9 in [`WaveField::volume_m3`]; second order in the cell.
    ///
    /// # Errors
    /// [`ConfigError::OutOfRange`] for a field of `impact` outside its domain or not finite; then nothing has changed.
    pub fn add_drop(&mut self, impact: &DropImpact) -> Result<bool, ConfigError> {
        impact.check()?;
        let Some(middle) = self.cell_of(impact.x_m, impact.z_m) else {
            return Ok(false);
        };
        let deepest = self.deepest_m();
        let cell = self.settings.cell_m;
        let s = impact.width_m(cell, deepest * f64::from(self.relative_depth(middle)));
        let at = [impact.x_m, impact.z_m];
        let spans = self.reach(at, at, s);
        let per_s = 1.0 / s;
        let mut shapes = [core::mem::take(&mut self.shape_x), core::mem::take(&mut self.shape_z)];
        // Distances over s; the Gaussian is a product of one factor for each axis.
        let distance = |axis: usize, k: usize| {
            let centre = ((spans[axis].start + k as i64) as f64 + 0.5) * cell;
            (centre - at[axis]) * per_s
        };
        for (axis, shape) in shapes.iter_mut().enumerate() {
            for (k, value) in shape.iter_mut().take(spans[axis].len).enumerate() {
                let d = distance(axis, k);
                *value = ops::exp(-0.5 * d * d);
            }
        }
        let shape = |k: usize, l: usize| {
            let gauss = shapes[0][k] * shapes[1][l];
            let (x, z) = (distance(0, k), distance(1, l));
            (gauss, (x * x + z * z - 2.0) * gauss)
        };
        let cells = || (0..spans[1].len).flat_map(|l| (0..spans[0].len).map(move |k| (k, l)));
        // Σ of the Gaussian and of h ∇² of it, h relative.
        let (mut gauss_sum, mut force_sum) = (0.0, 0.0);
        for (k, l) in cells() {
            if let Some(index) = self.reached(spans, k, l) {
                let (gauss, laplacian) = shape(k, l);
                gauss_sum += gauss;
                force_sum += f64::from(self.relative_depth(index)) * laplacian;
            }
        }
        let balance = force_sum / gauss_sum;
        let bump = impact.volume_m3() / (self.cell_area_m2() * gauss_sum);
        // (h/ρ) m v/(2πs²) · 1/s², of which `laplacian` is the shape.
        let force = 0.5 * impact.peak_velocity(deepest, s);
        // The bump's own first step back, ½C²L of it, has the same shape.
        let courant = self.courant() * cell * per_s;
        let back = 0.5 * courant * courant * bump - (1.0 + self.half_damping()) * self.step_s() * force;
        for (k, l) in cells() {
            if let Some(index) = self.reached(spans, k, l) {
                let (gauss, laplacian) = shape(k, l);
                let zero_sum = f64::from(self.relative_depth(index)) * laplacian - balance * gauss;
                self.now[index] += (bump * gauss) as f32;
                self.before[index] += (bump * gauss + back * zero_sum) as f32;
            }
        }
        let [x, z] = shapes;
        (self.shape_x, self.shape_z) = (x, z);
        let raised = impact.volume_m3() / self.cell_area_m2();
        self.sum_now += raised;
        self.sum_before += raised;
        self.still = false;
        Ok(true)
    }
}
