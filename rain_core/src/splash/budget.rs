//! How many splashes a view draws: shares of each size class, so that small ones give way first and none of the light is
//! lost.

use super::crown::{crown_height_m, crown_life_s, crown_radius_m};
use super::field::{LARGEST_MEAN, SPLASH_CELL_M, SPLASH_SLOT_S};
use super::impacts::ImpactFlux;
use super::threshold::splash_excess;
use crate::error::clamped;
use crate::ops;
use crate::rainfall::{CLASS_COUNT, SizeClass, Spectrum, terminal_velocity};

/// How long a secondary drop is bright enough to be drawn, about, at the default contrast. Units: s.
const SHOWN_S: f64 = 0.02;

/// The ground that a view draws splashes on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SplashExtent {
    /// Crowns are drawn to here. Units: m. Domain: [0, 100].
    pub reach_m: f64,
    /// Secondary drops are drawn to here. Units: m. Domain: [0, 100].
    pub near_m: f64,
    /// Sideways angle of the view. Units: rad. Domain: [0, 2π].
    pub angle_rad: f64,
    /// Shutter time. Units: s. Domain: [0, 1].
    pub exposure_s: f64,
    /// Thinnest film on the ground. Units: mm. Domain: [0, 1e6].
    pub film_mm: f64,
}

/// Impacts by size class, and the shares of them that are drawn.
///
/// A budget is spent on the classes with the largest crowns: the share of a class is min(1, s · area of its crowns), s
/// from the budget. What is drawn of a class stands for the rest of it: each of its splashes weighs 1 over its share,
/// in opacity up to 1 and in size beyond, so that the light of all together is the same under any budget.
///
/// Error: flux 1e-6 relative; the expected parts give the budget back to 1e-6 relative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SplashShares {
    flux: [f64; CLASS_COUNT],
    shares: [f64; CLASS_COUNT],
}

impl SplashShares {
    /// Every impact of every class, splashing or not.
    #[must_use]
    pub fn all(spectrum: &Spectrum) -> Self {
        let flux = SizeClass::all().map(|class| {
            let flux = ImpactFlux::level(spectrum, class.min_mm, class.max_mm).number_per_m2_s;
            clamped(flux, 0.0, f64::MAX)
        });
        let most = LARGEST_MEAN / (SPLASH_CELL_M * SPLASH_CELL_M * SPLASH_SLOT_S);
        let share = (most / flux.iter().sum::<f64>().max(1e-300)).min(1.0);
        Self {
            flux,
            shares: [share; CLASS_COUNT],
        }
    }

    /// Those that are drawn for `budget` crowns and drops in a view of `extent`; a budget that is not above 0 draws none.
    ///
    /// Classes of which no drop splashes on the film are left out.
    #[must_use]
    pub fn for_budget(spectrum: &Spectrum, extent: &SplashExtent, budget: f64) -> Self {
        let mut shares = Self::all(spectrum);
        let most = shares.shares[0];
        let area = SizeClass::all().map(|class| crown_area(&class, extent.film_mm));
        let largest = area.into_iter().fold(f64::MIN_POSITIVE, f64::max);
        let parts = parts_of_classes(extent);
        let mut set = |scale: f64| -> f64 {
            let classes = shares.shares.iter_mut().zip(area).zip(parts.iter().zip(shares.flux));
            classes
                .map(|((share, area), (parts, flux))| {
                    *share = (scale * area / largest).min(most);
                    flux * *share * parts
                })
                .sum()
        };
        // The smallest class that splashes has a thousandth of the largest crowns: above this all are drawn.
        let (mut low, mut high) = (1e-12, 1e6);
        if budget.is_nan() || budget <= 0.0 {
            set(0.0);
            return shares;
        }
        if set(high) <= budget {
            return shares;
        }
        for _ in 0..80 {
            let mid = ops::sqrt(low * high);
            if set(mid) < budget {
                low = mid;
            } else {
                high = mid;
            }
        }
        shares
    }

    /// Impacts of class `k` below 12. Units: 1/(m² s).
    #[must_use]
    pub fn flux(&self, k: usize) -> f64 {
        self.flux[k]
    }

    /// Share of class `k` below 12 that is drawn. Units: none, [0, 1].
    #[must_use]
    pub fn share(&self, k: usize) -> f64 {
        self.shares[k]
    }

    /// Crowns and drops that a view of `extent` shows at a time where every impact splashes. Units: none.
    #[must_use]
    pub fn expected_parts(&self, extent: &SplashExtent) -> f64 {
        let parts = parts_of_classes(extent);
        (0..CLASS_COUNT).map(|k| self.flux[k] * self.shares[k] * parts[k]).sum()
    }
}

/// Crowns and drops that a view shows of a class, for each impact on a square metre and second. Units: m² s.
fn parts_of_classes(extent: &SplashExtent) -> [f64; CLASS_COUNT] {
    let angle = clamped(extent.angle_rad, 0.0, core::f64::consts::TAU);
    let sector = |reach: f64| 0.5 * angle * ops::pow(clamped(reach, 0.0, 100.0), 2.0);
    let exposure = clamped(extent.exposure_s, 0.0, 1.0);
    SizeClass::all().map(|class| {
        let d = 0.5 * (class.min_mm + class.max_mm);
        let crowns = sector(extent.reach_m) * (crown_life_s(d) + exposure);
        let grown = ((splash_excess(d, terminal_velocity(d), 0.0) - 1.0) / 18.0).clamp(0.0, 1.0);
        crowns + sector(extent.near_m) * SHOWN_S * (5.0 + 25.0 * grown)
    })
}

/// Area of a crown of the class's largest drop from the side, times how long it stands; 0 where none splashes.
fn crown_area(class: &SizeClass, film_mm: f64) -> f64 {
    let d = class.max_mm;
    let speed = terminal_velocity(d);
    if splash_excess(d, speed, film_mm) <= 1.0 {
        return 0.0;
    }
    let life = crown_life_s(d);
    // Just above the threshold: low, but not nothing.
    let height = crown_height_m(d, speed, film_mm, 0.5 * life).max(0.05e-3 * d);
    crown_radius_m(d, speed, film_mm, life) * height * life
}
