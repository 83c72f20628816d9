//! The water of one crown.

use core::ops::AddAssign;

use super::properties::{CanopyProperties, saturation_time_s};
use super::state_form::Course;
use crate::error::{ConfigError, clamped, in_range};
use crate::ops;
use crate::rainfall::MAX_INTENSITY_MM_H;

/// Longest interval of one advance; longer ones are cut to it. Units: s.
const MAX_INTERVAL_S: f64 = 1e9;

/// Largest evaporation of one advance; more is cut to it. Units: mm/h.
const MAX_EVAPORATION_MM_H: f64 = 1e4;

/// Intercepted rain below this falls through: less than a hundredth of a millimetre in a thousand years. Units: mm/h.
pub(super) const LEAST_RAIN_MM_H: f64 = 1e-9;

/// Largest capacity accepted. Units: mm.
const MAX_CAPACITY_MM: f64 = 100.0;

/// Smallest capacity that stores; below it everything falls through. Units: mm.
const LEAST_CAPACITY_MM: f64 = 1e-9;

/// Share of the capacity below which a drying crown is dry; the rest evaporates at once.
const DRY_SHARE: f64 = 1e-12;

/// Where the water of an interval went: depths over the crown's projection. Units: mm.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct CanopyFluxes {
    /// Rain above the crown.
    pub rain_mm: f64,
    /// Through gaps, untouched.
    pub free_throughfall_mm: f64,
    /// Dripped from leaves.
    pub drip_mm: f64,
    /// Down branches and trunk.
    pub stemflow_mm: f64,
    /// From wet leaves into the air.
    pub evaporated_mm: f64,
    /// Storage at the end less storage at the start.
    pub storage_change_mm: f64,
}

impl CanopyFluxes {
    /// What falls under the crown: free throughfall and drip. Units: mm.
    ///
    /// Error: exact, one sum.
    #[must_use]
    pub fn throughfall_mm(&self) -> f64 {
        self.free_throughfall_mm + self.drip_mm
    }

    /// Rain less everything it became; 0 up to rounding. Units: mm.
    ///
    /// Error: 1e-14 of rain + S for one advance, 1e-12 of the rain for a day of 0.25 s.
    #[must_use]
    pub fn residual_mm(&self) -> f64 {
        self.rain_mm - (self.throughfall_mm() + self.stemflow_mm + self.evaporated_mm + self.storage_change_mm)
    }

    /// Volume of the drip under a crown of `area_m2`. Units: m³. An area that is not above 0 has none.
    ///
    /// Error: exact, two products.
    #[must_use]
    pub fn drip_m3(&self, area_m2: f64) -> f64 {
        1e-3 * self.drip_mm * area_m2.max(0.0)
    }
}

impl AddAssign for CanopyFluxes {
    fn add_assign(&mut self, other: Self) {
        self.rain_mm += other.rain_mm;
        self.free_throughfall_mm += other.free_throughfall_mm;
        self.drip_mm += other.drip_mm;
        self.stemflow_mm += other.stemflow_mm;
        self.evaporated_mm += other.evaporated_mm;
        self.storage_change_mm += other.storage_change_mm;
    }
}

/// Water stored by one crown, advanced in closed form over intervals of constant rain and evaporation.
///
/// State form of Weber et al. 2016, eqs. 1 to 3: with C the stored depth, S the capacity and R the intercepted rain,
/// q = 1 − √(1 − C/S), dC/dt = R (1 − q) − E, drip = R min(q, q_max), stemflow = R (q − min(q, q_max)). It equals the
/// source for constant rain and stays right when rain varies. An empty crown evaporates no more than it intercepts.
/// Without rain it dries by Rutter et al. 1971, C e^(−E t/S).
///
/// Depths are over the crown's projection. The stored depth is kept as a pair of doubles, so that a day of small steps
/// loses nothing. Allocates nothing.
///
/// Error: |C − C_ref| ≤ 1e-11 S and every flux ≤ 1e-11 (S + rain) against the separated equation, 1e-9 against
/// Runge–Kutta steps through every event; the budget of an
/// advance closes to 1e-14 of rain + S; cutting an interval changes the state by less than 1e-12 S; q within 1e-10 of
/// the root of C/S. Model: the ramp is a regression, S of real crowns differs by a factor of two.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CanopyStore {
    capacity_mm: f64,
    intercepted_share: f64,
    max_drip_fraction: f64,
    /// Stored depth, high part.
    stored: f64,
    /// What `stored` rounds away.
    carry: f64,
}

impl CanopyStore {
    /// A dry crown.
    ///
    /// # Errors
    /// When a property is outside its domain.
    pub fn new(properties: CanopyProperties) -> Result<Self, ConfigError> {
        let properties = properties.validated()?;
        Ok(Self {
            capacity_mm: properties.capacity_mm(),
            intercepted_share: properties.intercepted_share(),
            max_drip_fraction: properties.max_drip_fraction,
            stored: 0.0,
            carry: 0.0,
        })
    }

    /// A dry crown from measured numbers: `capacity_mm` in [0, 100] mm, the shares `intercepted_share` and
    /// `max_drip_fraction` in [0, 1].
    ///
    /// # Errors
    /// When one of them is outside its domain.
    pub fn from_measured(
        capacity_mm: f64,
        intercepted_share: f64,
        max_drip_fraction: f64,
    ) -> Result<Self, ConfigError> {
        Ok(Self {
            capacity_mm: in_range("capacity_mm", capacity_mm, 0.0, MAX_CAPACITY_MM, "0 to 100 mm")?,
            intercepted_share: in_range("intercepted_share", intercepted_share, 0.0, 1.0, "0 to 1")?,
            max_drip_fraction: in_range("max_drip_fraction", max_drip_fraction, 0.0, 1.0, "0 to 1")?,
            stored: 0.0,
            carry: 0.0,
        })
    }

    /// The same crown holding `stored_mm`. Domain: [0, capacity] mm.
    ///
    /// # Errors
    /// When `stored_mm` is outside.
    pub fn with_stored(self, stored_mm: f64) -> Result<Self, ConfigError> {
        let stored = in_range("stored_mm", stored_mm, 0.0, self.capacity_mm, "0 to the capacity in mm")?;
        Ok(Self {
            stored,
            carry: 0.0,
            ..self
        })
    }

    /// Storage capacity S. Units: mm.
    #[must_use]
    pub fn capacity_mm(&self) -> f64 {
        self.capacity_mm
    }

    /// Stored depth C, [0, S]. Units: mm.
    #[must_use]
    pub fn stored_mm(&self) -> f64 {
        self.stored
    }

    /// Both halves of the stored depth, for hashes and snapshots. Units: mm.
    #[must_use]
    pub fn stored_parts(&self) -> [f64; 2] {
        [self.stored, self.carry]
    }

    /// q = 1 − √(1 − C/S): share of the intercepted rain that leaves the crown. Units: none, [0, 1]; 1 without
    /// capacity.
    #[must_use]
    pub fn drained_fraction(&self) -> f64 {
        if self.capacity_mm < LEAST_CAPACITY_MM {
            return 1.0;
        }
        let root = ops::sqrt(self.deficit().max(0.0) / self.capacity_mm);
        (self.stored / self.capacity_mm / (1.0 + root)).clamp(0.0, 1.0)
    }

    /// min(q, q_max): share of the intercepted rain that drips. Units: none, [0, 1].
    #[must_use]
    pub fn drip_fraction(&self) -> f64 {
        self.drained_fraction().min(self.max_drip_fraction)
    }

    /// Advances by `dt_s` seconds under constant open-field rain and potential evaporation, and says where the water
    /// went.
    ///
    /// `rain_mm_h` in mm/h, held in [0, 500]; `evaporation_mm_h` in mm/h, held in [0, 1e4] (dew wets no leaf); `dt_s`
    /// in s, held in [0, 1e9]. What is not a number counts as 0. Intercepted rain below 1e-9 mm/h falls through.
    pub fn advance(&mut self, rain_mm_h: f64, evaporation_mm_h: f64, dt_s: f64) -> CanopyFluxes {
        let rain = clamped(rain_mm_h, 0.0, MAX_INTENSITY_MM_H) / 3600.0;
        let evaporation = clamped(evaporation_mm_h, 0.0, MAX_EVAPORATION_MM_H) / 3600.0;
        let dt = clamped(dt_s, 0.0, MAX_INTERVAL_S);
        let mut fluxes = CanopyFluxes {
            rain_mm: rain * dt,
            ..CanopyFluxes::default()
        };
        let intercepted = rain * self.intercepted_share;
        if dt == 0.0 {
            return fluxes;
        }
        if self.capacity_mm < LEAST_CAPACITY_MM {
            fluxes.free_throughfall_mm = fluxes.rain_mm;
        } else if intercepted * 3600.0 < LEAST_RAIN_MM_H {
            fluxes.free_throughfall_mm = fluxes.rain_mm;
            self.dry(evaporation, dt, &mut fluxes);
        } else {
            fluxes.free_throughfall_mm = (rain - intercepted) * dt;
            self.wet(intercepted, evaporation, dt, &mut fluxes);
        }
        fluxes
    }

    /// Drying without rain: C e^(−E t/S).
    fn dry(&mut self, evaporation: f64, dt: f64, fluxes: &mut CanopyFluxes) {
        let share = -ops::exp_m1(-evaporation * dt / self.capacity_mm);
        if self.stored * (1.0 - share) < DRY_SHARE * self.capacity_mm && share > 0.0 {
            self.empty(fluxes);
        } else {
            self.store(-self.stored * share, fluxes);
        }
        fluxes.evaporated_mm = -fluxes.storage_change_mm;
    }

    /// Rain on leaves, mm/s.
    fn wet(&mut self, rain: f64, evaporation: f64, dt: f64, fluxes: &mut CanopyFluxes) {
        let course = Course::new(self.capacity_mm, self.stored, self.deficit(), rain, evaporation);
        let share = course.start_share();
        let wet_time = course.time_to_empty().min(dt);
        let fall = if wet_time < dt { -share } else { course.fall_after(dt) };
        let gained = |fall: f64| self.capacity_mm * course.gain(fall);
        let drained_by = |fall: f64, time: f64| ((rain - evaporation) * time - gained(fall)).max(0.0);
        let drained = drained_by(fall, wet_time);
        // Where q passes q_max: beyond it the drip is the cap's.
        let cap = self.max_drip_fraction;
        let end_share = share + fall;
        let drip = if share.max(end_share) <= cap {
            drained
        } else if share.min(end_share) >= cap {
            cap * rain * wet_time
        } else {
            let crossing = course.time_to_fall(cap - share).min(wet_time);
            let before = drained_by(cap - share, crossing);
            if share < cap {
                before + cap * rain * (wet_time - crossing)
            } else {
                cap * rain * crossing + (drained - before)
            }
        };
        let stemflow = (drained - drip).max(0.0);
        let gain = gained(fall);
        if wet_time < dt {
            self.empty(fluxes);
        } else if gain >= self.deficit() {
            let rest = self.deficit();
            self.store(rest, fluxes);
        } else {
            self.store(gain, fluxes);
        }
        fluxes.drip_mm = drained - stemflow;
        fluxes.stemflow_mm = stemflow;
        fluxes.evaporated_mm = evaporation * wet_time + rain * (dt - wet_time);
    }

    /// S − C, mm.
    fn deficit(&self) -> f64 {
        (self.capacity_mm - self.stored) - self.carry
    }

    /// Gives all water back.
    fn empty(&mut self, fluxes: &mut CanopyFluxes) {
        fluxes.storage_change_mm = -(self.stored + self.carry);
        self.stored = 0.0;
        self.carry = 0.0;
    }

    /// Adds `change` mm. Two-sum of Knuth 1969, then renormalised.
    fn store(&mut self, change: f64, fluxes: &mut CanopyFluxes) {
        let sum = self.stored + change;
        let part = sum - self.stored;
        let low = self.carry + ((self.stored - (sum - part)) + (change - part));
        self.stored = sum + low;
        self.carry = low - (self.stored - sum);
        fluxes.storage_change_mm = change;
    }
}

/// What a shower on a dry crown leaves behind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CanopyShower {
    /// Storage capacity. Units: mm.
    pub capacity_mm: f64,
    /// 7200 S/R with the open field's rain; none without rain. Units: s.
    pub saturation_time_s: Option<f64>,
    /// Where the water went. Units: mm.
    pub fluxes: CanopyFluxes,
    /// Stored at the end. Units: mm.
    pub storage_mm: f64,
    /// Share of the intercepted rain that drips at the end, at most q_max. Units: none.
    pub drip_fraction: f64,
}

impl CanopyShower {
    /// Throughfall, stemflow, storage and evaporation together: all the rain that fell. Units: mm.
    ///
    /// Error: 1e-14 of rain + S.
    #[must_use]
    pub fn fallen_mm(&self) -> f64 {
        self.fluxes.throughfall_mm() + self.fluxes.stemflow_mm + self.storage_mm + self.fluxes.evaporated_mm
    }
}

/// A dry crown under `duration_s` seconds of open-field rain of `intensity_mm_h` with potential evaporation
/// `evaporation_mm_h`: everything about it at the end. The calculator behind `rain model canopy`.
///
/// Error: that of [`CanopyStore`], the same bits.
///
/// # Errors
/// When a property, `intensity_mm_h` in [0, 500], `duration_s` in [0, 1e9] or `evaporation_mm_h` in [0, 1e4] is
/// outside its domain or not finite.
pub fn canopy_shower(
    properties: CanopyProperties,
    intensity_mm_h: f64,
    duration_s: f64,
    evaporation_mm_h: f64,
) -> Result<CanopyShower, ConfigError> {
    let mut store = CanopyStore::new(properties)?;
    let rain = in_range(
        "intensity_mm_h",
        intensity_mm_h,
        0.0,
        MAX_INTENSITY_MM_H,
        "0 to 500 mm/h",
    )?;
    let duration = in_range("duration_s", duration_s, 0.0, MAX_INTERVAL_S, "0 to 1e9 s")?;
    let evaporation = in_range(
        "evaporation_mm_h",
        evaporation_mm_h,
        0.0,
        MAX_EVAPORATION_MM_H,
        "0 to 10000 mm/h",
    )?;
    let fluxes = store.advance(rain, evaporation, duration);
    Ok(CanopyShower {
        capacity_mm: store.capacity_mm(),
        saturation_time_s: saturation_time_s(store.capacity_mm(), rain),
        fluxes,
        storage_mm: store.stored_mm(),
        drip_fraction: store.drip_fraction(),
    })
}
