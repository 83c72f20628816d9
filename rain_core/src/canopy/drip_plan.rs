//! Drip places that share one crown's water: which drops each lets go, how often, and when.

use super::drip_places::{radial_class, radial_shares};
use super::drip_rate::drop_volume_m3;
use super::drip_sizes::DripSizes;
use crate::error::{ConfigError, clamped, in_range};
use crate::hash;

/// Number of radial classes.
const CLASSES: usize = 4;

/// The drip places of one crown, each with one drop diameter and a share of the water.
///
/// Every place draws its diameter once, by number, and all places of a radial class drip at one frequency: that which
/// carries the class's share of the water, Σ f π D³/6 = q_s Q. Classes without a place hand theirs to the others. So
/// the places carry exactly Q between them, however few they are. Source: Weber et al. 2016, eqs. 11 to 13, where the
/// period of a whole tree stands for that of a leaf (corrected).
///
/// Allocates two tables of one entry a place at construction, nothing afterwards.
///
/// Error: Σ f V = Q to 1e-12.
#[derive(Debug, Clone, PartialEq)]
pub struct DripPlan {
    seed: u32,
    diameters_mm: Vec<f32>,
    classes: Vec<u8>,
    /// Drops per second of a place for a flow of 1 m³/s, by class.
    per_flow: [f64; CLASSES],
}

impl DripPlan {
    /// Places at `radii_m` from the trunk, under a crown of `crown_radius_m` and `thickness_m`.
    ///
    /// # Errors
    /// When there is no place, a radius is negative or not finite, the crown's radius is outside [0.01, 1000] m or its
    /// thickness outside [0, 1000] m.
    pub fn new(
        seed: u32,
        sizes: &DripSizes,
        radii_m: &[f64],
        crown_radius_m: f64,
        thickness_m: f64,
    ) -> Result<Self, ConfigError> {
        if radii_m.is_empty() {
            return Err(ConfigError::Empty { field: "radii_m" });
        }
        let crown = in_range("crown_radius_m", crown_radius_m, 0.01, 1000.0, "0.01 to 1000 m")?;
        let thickness = in_range("thickness_m", thickness_m, 0.0, 1000.0, "0 to 1000 m")?;
        let mut diameters_mm = Vec::with_capacity(radii_m.len());
        let mut classes = Vec::with_capacity(radii_m.len());
        let mut volume = [0.0; CLASSES];
        for (place, &radius) in (0_u32..).zip(radii_m) {
            let radius = in_range("radii_m", radius, 0.0, f64::MAX, "0 m or more")?;
            let class = radial_class(radius, crown);
            let diameter = sizes.drawn_mm(seed, place, 0);
            volume[class] += drop_volume_m3(f64::from(diameter));
            classes.push(class as u8);
            diameters_mm.push(diameter);
        }
        let shares = radial_shares(thickness);
        let used: f64 = (0..CLASSES)
            .filter(|&class| volume[class] > 0.0)
            .map(|class| shares[class])
            .sum();
        let rate = |class: usize| {
            if volume[class] > 0.0 {
                shares[class] / used / volume[class]
            } else {
                0.0
            }
        };
        Ok(Self {
            seed,
            diameters_mm,
            classes,
            per_flow: core::array::from_fn(rate),
        })
    }

    /// Number of places.
    #[must_use]
    pub fn len(&self) -> usize {
        self.diameters_mm.len()
    }

    /// Never: a plan has at least one place.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.diameters_mm.is_empty()
    }

    /// Diameter of every drop of a place. Units: mm. 0 for a place that is not there.
    #[must_use]
    pub fn diameter_mm(&self, place: usize) -> f32 {
        self.diameters_mm.get(place).copied().unwrap_or_default()
    }

    /// Drops per second of a place when the crown drips `flow_m3_s`. Units: 1/s. 0 for a flow that is not above 0.
    #[must_use]
    pub fn frequency_hz(&self, place: usize, flow_m3_s: f64) -> f64 {
        self.per_flow(place) * clamped(flow_m3_s, 0.0, 1e6)
    }

    /// Drops of a place per m³ of drip. Units: 1/m³.
    fn per_flow(&self, place: usize) -> f64 {
        self.classes
            .get(place)
            .map_or(0.0, |&class| self.per_flow[usize::from(class)])
    }

    /// Fixed phase of a place, so that leaves do not let go together. Units: none, [0, 1).
    #[must_use]
    pub fn phase(&self, place: usize) -> f64 {
        let [_, bits, _] = hash::pcg3d([place as u32, 0x7068_6173, self.seed]);
        f64::from(hash::unit_f32(bits))
    }
}

/// How much has dripped since the start, for one crown: counts every place's drops.
///
/// Counts follow the water, not the time: the same water gives the same drops at any step, and phases do not jump when
/// the rain changes.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct DripClock {
    /// Drip since the start. Units: m³.
    dripped_m3: f64,
}

impl DripClock {
    /// Adds the drip of an interval. Units: m³. What is not above 0 adds nothing.
    pub fn advance(&mut self, drip_m3: f64) {
        self.dripped_m3 += clamped(drip_m3, 0.0, 1e9);
    }

    /// Drip since the start. Units: m³.
    ///
    /// Error: 1e-13 relative over 1000 intervals.
    #[must_use]
    pub fn dripped_m3(&self) -> f64 {
        self.dripped_m3
    }

    /// Drops that a place has let go since the start: whole, and the fraction of the next, in [0, 1).
    ///
    /// Error: 1e-15 of the count, less than a millionth of a drop after a year of rain on one place.
    #[must_use]
    pub fn released(&self, plan: &DripPlan, place: usize) -> (u64, f64) {
        let drops = self.dripped_m3 * plan.per_flow(place) + plan.phase(place);
        let whole = drops.floor();
        (whole as u64, (drops - whole).min(1.0 - f64::EPSILON))
    }
}
