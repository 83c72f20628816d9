//! Splash or not.

use super::numbers::{FASTEST_M_S, ImpactNumbers, LARGEST_MM, splash_k_f32};
use crate::error::{clamped, clamped_f32};
use crate::ops;
use crate::rainfall::terminal_velocity;

/// K above which a drop splashes on a dry smooth wall. Source: Mundo et al. 1995.
const DRY_K: f64 = 57.7;
/// Thinnest and thickest film over diameter of Cossali's measurements.
const FILM_RANGE: (f64, f64) = (0.08, 1.2);

/// We Oh^(−0.4) at the threshold, for a film of `film_share` drop diameters.
fn threshold(film_share: f64) -> f64 {
    // K^1.6 = We^0.8 Re^0.4 is We Oh^(−0.4): the dry wall's threshold in the same measure.
    let dry = ops::pow(DRY_K, 1.6);
    let cossali = |delta: f64| 2100.0 + 5880.0 * ops::pow(delta, 1.44);
    let (thin, thick) = FILM_RANGE;
    if film_share < thin {
        // Between the dry wall and the thinnest film measured: linear, a choice.
        dry + (cossali(thin) - dry) * (film_share / thin)
    } else {
        cossali(film_share.min(thick))
    }
}

/// Film over diameter, held in [0, ∞).
fn film_share(diameter_mm: f64, film_mm: f64) -> f64 {
    let d = clamped(diameter_mm, 0.0, LARGEST_MM);
    let film = clamped(film_mm, 0.0, 1e6);
    if film == 0.0 { 0.0 } else { film / d.max(1e-12) }
}

/// K = We^½ Re^¼ above which a drop of `diameter_mm` splashes on a film of `film_mm`. Units: none.
///
/// Dry: 57.7 (Mundo et al. 1995). Film of δ = 0.08 to 1.2 diameters: (2100 + 5880 δ^1.44)^(5/8) (Cossali et al. 1997);
/// thinner films linear between both in K^1.6, deeper water as δ = 1.2 (choices). `diameter_mm` held in [0, 100],
/// `film_mm` in [0, 1e6]; what is not a number counts as 0.
///
/// Error: 1e-15 relative; smooth walls, rough ground splashes earlier.
#[must_use]
pub fn splash_threshold_k(diameter_mm: f64, film_mm: f64) -> f64 {
    // x^(5/8) by roots: a tenth of a power's cost.
    let root = ops::sqrt(threshold(film_share(diameter_mm, film_mm)));
    root * ops::sqrt(ops::sqrt(root))
}

/// K of an impact over the K at which a drop of its size splashes: a splash where it is above 1. Units: none.
///
/// Arguments and sources as [`splash_threshold_k`] and [`ImpactNumbers`]; `speed_m_s` along the ground's normal.
/// Error: 2e-15 relative.
#[must_use]
pub fn splash_excess(diameter_mm: f64, speed_m_s: f64, film_mm: f64) -> f64 {
    ImpactNumbers::new(diameter_mm, speed_m_s).k / splash_threshold_k(diameter_mm, film_mm)
}

/// [`splash_excess`] in single precision, for one drop among many.
///
/// Error: 2e-6 relative.
#[must_use]
pub fn splash_excess_f32(diameter_mm: f32, speed_m_s: f32, film_mm: f32) -> f32 {
    // 57.7^1.6, and the threshold at the thinnest film measured.
    const DRY: f32 = 657.478_1;
    const THIN: f32 = 2_254.819_9;
    let d = clamped_f32(diameter_mm, 0.0, LARGEST_MM as f32);
    let film = clamped_f32(film_mm, 0.0, 1e6);
    let delta = if film == 0.0 { 0.0 } else { film / d.max(1e-12) };
    let (thin, thick) = (FILM_RANGE.0 as f32, FILM_RANGE.1 as f32);
    let threshold = if delta < thin {
        DRY + (THIN - DRY) * (delta / thin)
    } else {
        2100.0 + 5880.0 * ops::expf(1.44 * ops::lnf(delta.min(thick)))
    };
    let root = threshold.sqrt();
    splash_k_f32(d, speed_m_s) / (root * root.sqrt().sqrt())
}

/// The smallest drop that splashes when it falls at its terminal speed on a film of `film_mm`. Units: mm.
///
/// `film_mm` held in [0, 1e6], what is not a number counts as 0. Source: as [`splash_threshold_k`] with
/// [`terminal_velocity()`].
///
/// Error: 1e-12 mm; the fall speed's fit moves it by up to 0.01 mm.
#[must_use]
pub fn splash_threshold_diameter_mm(film_mm: f64) -> f64 {
    // Both the drop's K and film over diameter speak for larger drops: one crossing.
    let (mut low, mut high) = (0.1, 10.0);
    while high - low > 1e-12 {
        let mid = 0.5 * (low + high);
        if mid <= low || mid >= high {
            break;
        }
        if splash_excess(mid, terminal_velocity(mid).min(FASTEST_M_S), film_mm) < 1.0 {
            low = mid;
        } else {
            high = mid;
        }
    }
    0.5 * (low + high)
}
