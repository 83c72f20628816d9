//! Water that a wheel meets: how it is split, and what it leaves.

use super::spray::SprayMechanism;
use super::tyre::Tyre;
use crate::constants::WATER_DENSITY;
use crate::error::clamped;

/// Fastest wheel that counts. Units: m/s.
const FASTEST_M_S: f64 = 200.0;
/// Deepest film that counts. Units: mm.
const DEEPEST_MM: f64 = 1000.0;

/// Water that a wheel meets in a second, and the mechanism that takes it. Units: kg/s.
///
/// M_w = ρ b v W on a film W. Capillary adhesion ρ b v (1 − K_t) min(W, h_ca), tread pickup ρ b v K_t min(W, h_tp), bow
/// and side waves the rest: taken in this order, so that the sum is always M_w. Backwards is as forwards.
/// Source: Weir, Strange & Heffley 1978, in Flintsch et al. 2014.
///
/// Error: every part 1e-15 of M_w, their sum = M_w to 1e-15; the split is geometry, measured spray scatters by a factor
/// of two.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct WheelWater {
    /// All water met, M_w.
    pub intercepted_kg_s: f64,
    /// Clings to the rubber.
    pub adhesion_kg_s: f64,
    /// Carried in the grooves.
    pub tread_kg_s: f64,
    /// Pushed ahead.
    pub bow_kg_s: f64,
    /// Pushed to both sides.
    pub side_kg_s: f64,
}

impl WheelWater {
    /// For a valid tyre at `speed_m_s` (either way, held at 200) on a film of `film_mm` (held in [0, 1000]). What is
    /// not a number counts as 0.
    #[must_use]
    pub fn new(tyre: &Tyre, speed_m_s: f64, film_mm: f64) -> Self {
        let film = clamped(film_mm, 0.0, DEEPEST_MM);
        let per_mm = per_mm(tyre, speed_m_s);
        let intercepted = per_mm * film;
        let adhesion = per_mm * (1.0 - tyre.groove_share) * film.min(tyre.adhesion_mm);
        let tread = per_mm * tyre.groove_share * film.min(tyre.carried_mm());
        let rest = (intercepted - adhesion - tread).max(0.0);
        let bow = rest * tyre.bow_share;
        Self {
            intercepted_kg_s: intercepted,
            adhesion_kg_s: adhesion,
            tread_kg_s: tread,
            bow_kg_s: bow,
            side_kg_s: rest - bow,
        }
    }

    /// The part of one mechanism. Units: kg/s.
    #[must_use]
    pub fn of(&self, mechanism: SprayMechanism) -> f64 {
        match mechanism {
            SprayMechanism::Adhesion => self.adhesion_kg_s,
            SprayMechanism::Tread => self.tread_kg_s,
            SprayMechanism::Bow => self.bow_kg_s,
            SprayMechanism::Side => self.side_kg_s,
        }
    }
}

/// Mass of a film of 1 mm that a wheel passes in a second. Units: kg/(s mm).
fn per_mm(tyre: &Tyre, speed_m_s: f64) -> f64 {
    let speed = clamped(speed_m_s.abs(), 0.0, FASTEST_M_S);
    WATER_DENSITY * tyre.width_m * speed * 1e-3
}

/// What becomes of the water met.
///
/// What clings and what the grooves carry flies off above the speeds of [`SprayMechanism::onset_m_s`] and is laid down
/// again below; what is pushed ahead and aside leaves the track at any speed, and flies above its own onset. So
/// met = thrown + pushed aside + left. Source: Flintsch et al. 2014; onsets a choice about the 48 to 64 km/h at which
/// spray was first measured (Pilkington 1990).
///
/// Error: the sum and the film left to 1e-15; the onsets are choices.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct WheelTrail {
    /// Thrown into the air, by mechanism; `intercepted_kg_s` is the sum. Units: kg/s.
    pub thrown: WheelWater,
    /// Laid beside the track. Units: kg/s.
    pub aside_kg_s: f64,
    /// Left in the track. Units: kg/s.
    pub left_kg_s: f64,
    /// Film in the track behind the wheel, W less what was taken. Units: mm.
    pub film_after_mm: f64,
}

impl WheelTrail {
    /// Of a wheel at `speed_m_s` on a film of `film_mm`; domains as [`WheelWater::new`]. A wheel at rest leaves the
    /// film.
    #[must_use]
    pub fn new(tyre: &Tyre, speed_m_s: f64, film_mm: f64) -> Self {
        let water = WheelWater::new(tyre, speed_m_s, film_mm);
        let share = |mechanism: SprayMechanism| mechanism.airborne_share(speed_m_s);
        let mut thrown = WheelWater {
            intercepted_kg_s: 0.0,
            adhesion_kg_s: water.adhesion_kg_s * share(SprayMechanism::Adhesion),
            tread_kg_s: water.tread_kg_s * share(SprayMechanism::Tread),
            bow_kg_s: water.bow_kg_s * share(SprayMechanism::Bow),
            side_kg_s: water.side_kg_s * share(SprayMechanism::Side),
        };
        thrown.intercepted_kg_s = thrown.adhesion_kg_s + thrown.tread_kg_s + thrown.bow_kg_s + thrown.side_kg_s;
        let left = (water.adhesion_kg_s - thrown.adhesion_kg_s) + (water.tread_kg_s - thrown.tread_kg_s);
        let per_mm = per_mm(tyre, speed_m_s);
        Self {
            thrown,
            aside_kg_s: (water.bow_kg_s - thrown.bow_kg_s) + (water.side_kg_s - thrown.side_kg_s),
            left_kg_s: left,
            film_after_mm: if per_mm > 0.0 {
                left / per_mm
            } else {
                clamped(film_mm, 0.0, DEEPEST_MM)
            },
        }
    }
}
