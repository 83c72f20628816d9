//! The twelve size classes of the drop field: all drops of a class move rigidly at one speed.

use super::terminal_velocity::{density_factor, terminal_velocity};
use crate::error::{clamped, clamped_f32};

/// Number of size classes.
pub const CLASS_COUNT: usize = 12;

/// Class borders, logarithmic from 0.5 to 6 mm (ratio 12^(1/12)). Units: mm.
pub const CLASS_EDGES_MM: [f64; CLASS_COUNT + 1] = [
    0.5,
    0.615_037_8,
    0.756_542_9,
    0.930_604_9,
    1.144_714_2,
    1.408_085_0,
    1.732_050_8,
    2.130_553_3,
    2.620_741_4,
    3.223_709_8,
    3.965_406_5,
    4.877_749_4,
    6.0,
];

/// Speed of each class: ∫N v dD / ∫N dD at 25 mm/h, the same for every rain rate, so that changing the
/// rain moves no drop. Units: m/s at sea level.
pub const CLASS_SPEEDS_M_S: [f64; CLASS_COUNT] =
    [2.29, 2.80, 3.42, 4.12, 4.81, 5.53, 6.30, 7.14, 7.89, 8.51, 8.93, 9.12];

/// Edge of the lattice cells of each class; never from the rain rate or the quality. Units: m.
pub const CLASS_CELL_M: [f64; CLASS_COUNT] = [0.25, 0.25, 0.25, 0.5, 0.5, 0.5, 1.0, 1.0, 1.0, 1.0, 2.0, 2.0];

/// Decay of the reference spectrum n_ref = N_REF e^(−2D) that places diameters inside a class. Units: mm⁻¹.
pub const REFERENCE_SLOPE_PER_MM: f64 = 2.0;

/// Amplitude of the reference spectrum. Units: m⁻³ mm⁻¹.
pub const REFERENCE_N0_PER_M3_MM: f64 = 8000.0;

/// One size class with what the drop field needs of it.
///
/// Error: diameters 1e-6 relative, counts 1e-11 relative, speeds in other air 1e-15 relative; all drops of a
/// class share one speed, 4 to 5 % rms from their own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SizeClass {
    /// Smallest diameter. Units: mm.
    pub min_mm: f64,
    /// Largest diameter. Units: mm.
    pub max_mm: f64,
    /// Sea-level speed. Units: m/s.
    pub speed_m_s: f64,
    /// Lattice cell edge. Units: m.
    pub cell_m: f64,
    /// e^(−2·min): start of the reference distribution's inverse.
    pub exp_min: f64,
    /// e^(−2·min) − e^(−2·max): its span.
    pub exp_span: f64,
    /// Expected drops of the reference spectrum in one cell, m_k. Units: none.
    pub reference_count: f64,
}

impl SizeClass {
    /// Class `index` in 0..[`CLASS_COUNT`].
    ///
    /// # Panics
    /// When `index` is not below [`CLASS_COUNT`].
    #[must_use]
    pub fn new(index: usize) -> Self {
        let (min_mm, max_mm) = (CLASS_EDGES_MM[index], CLASS_EDGES_MM[index + 1]);
        let cell_m = CLASS_CELL_M[index];
        let exp_min = crate::ops::exp(-REFERENCE_SLOPE_PER_MM * min_mm);
        let exp_span = exp_min - crate::ops::exp(-REFERENCE_SLOPE_PER_MM * max_mm);
        Self {
            min_mm,
            max_mm,
            speed_m_s: CLASS_SPEEDS_M_S[index],
            cell_m,
            exp_min,
            exp_span,
            reference_count: cell_m * cell_m * cell_m * REFERENCE_N0_PER_M3_MM / REFERENCE_SLOPE_PER_MM * exp_span,
        }
    }

    /// All classes, small to large.
    #[must_use]
    pub fn all() -> [Self; CLASS_COUNT] {
        core::array::from_fn(Self::new)
    }

    /// Diameter for a uniform `u` in [0, 1): inverse of the reference distribution inside the class. Units: mm.
    ///
    /// `u` held in [0, 1]; what is not a number counts as 0.
    #[must_use]
    pub fn diameter_mm(&self, u: f32) -> f32 {
        let e = self.exp_min as f32 - clamped_f32(u, 0.0, 1.0) * self.exp_span as f32;
        -0.5 * crate::ops::lnf(e)
    }

    /// Fall speed in air of another density, class speed × factor of the class's middle diameter. Units: m/s.
    ///
    /// `air_density`: kg/m³, domain [0.3, 2], held there; what is not a number counts as the standard density.
    #[must_use]
    pub fn speed_in(&self, air_density: f64) -> f64 {
        self.speed_m_s * density_factor(0.5 * (self.min_mm + self.max_mm), air_density)
    }
}

/// Range beyond which a drop's streak stays below one 8-bit step of contrast, z₁ = 255·(π/4)·D²f/(vT).
///
/// `diameter_mm` in mm, `focal_px` in pixels, `exposure_s` in s, each held in [0, 1e6]; NaN counts as 0. Units: m, in
/// [0, 1e9]: 0 without a drop or a picture, 1e9 without an exposure.
///
/// Error: 1e-13 relative above 0.1 mm with the same fit of the fall speed, which is off by up to 1.3 % from 0.5 mm on.
#[must_use]
pub fn visible_range_m(diameter_mm: f64, focal_px: f64, exposure_s: f64) -> f64 {
    let [diameter_mm, focal_px, exposure_s] = [diameter_mm, focal_px, exposure_s].map(|x| clamped(x, 0.0, 1e6));
    let d = diameter_mm * 1e-3;
    let numerator = 255.0 * core::f64::consts::FRAC_PI_4 * d * d * focal_px;
    let range = numerator / (terminal_velocity(diameter_mm) * exposure_s);
    if numerator > 0.0 { range.min(1e9) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rainfall::{Distribution, Spectrum};

    #[test]
    fn edges_are_logarithmic() {
        for (i, edge) in CLASS_EDGES_MM.iter().enumerate() {
            let exact = 0.5 * 12.0_f64.powf(i as f64 / 12.0);
            assert!((edge - exact).abs() < 1e-6, "{i}: {edge} {exact}");
        }
    }

    #[test]
    fn class_speeds_are_the_number_means_at_25_mm_h() {
        let s = Spectrum::new(Distribution::MarshallPalmer, 25.0).unwrap();
        for class in SizeClass::all() {
            let mean = s.flux_moment(0, class.min_mm, class.max_mm) / s.moment(0, class.min_mm, class.max_mm);
            // The speeds come from the measured table, whose fit errs by up to 1.3 %.
            assert!(
                (mean / class.speed_m_s - 1.0).abs() < 0.013,
                "{mean} {}",
                class.speed_m_s
            );
        }
    }

    #[test]
    fn diameters_fill_their_class() {
        for class in SizeClass::all() {
            assert!((f64::from(class.diameter_mm(0.0)) - class.min_mm).abs() < 1e-5);
            assert!((f64::from(class.diameter_mm(0.999_999_9)) - class.max_mm).abs() < 1e-3);
            let (a, b) = (class.diameter_mm(0.3), class.diameter_mm(0.6));
            assert!(a < b);
        }
    }

    #[test]
    fn visible_range_matches_the_published_table() {
        for (d, z) in [(0.5, 0.91), (1.0, 1.86), (2.0, 4.62), (4.0, 13.6), (6.0, 29.4)] {
            let ours = visible_range_m(d, 623.5, 1.0 / 60.0);
            assert!((ours / z - 1.0).abs() < 0.01, "{d}: {ours}");
        }
    }
}
