//! All areas at one time, and the rain rate at a point.

use glam::DVec2;

use super::density::DensityMap;
use super::motion::AreaFade;
use super::settings::{AreaRain, AreaSettings};
use super::shape::Outline;
use crate::error::{clamped, clamped_f32};
use crate::rainfall::spectrum::MAX_INTENSITY_MM_H;

/// How much of an area's rain falls at a signed distance from its outline (m, negative inside): 1 inside, 0 outside,
/// t²(3 − 2t) over `transition_m` with its half on the outline. A sharp edge (0) counts the outline itself as outside.
/// What is not a number is outside. Units: none.
///
/// Error: 1e-15.
#[must_use]
pub fn border_weight(distance_m: f64, transition_m: f64) -> f64 {
    if transition_m > 0.0 {
        let t = clamped(0.5 - distance_m / transition_m, 0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    } else {
        f64::from(u8::from(distance_m < 0.0))
    }
}

/// [`border_weight`] in single precision, as the shader has it.
///
/// Error: 4e-7.
#[must_use]
pub fn border_weight_f32(distance_m: f32, transition_m: f32) -> f32 {
    if transition_m > 0.0 {
        let t = clamped_f32(0.5 - distance_m / transition_m, 0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    } else {
        f32::from(u8::from(distance_m < 0.0))
    }
}

/// An area at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct PlacedArea {
    /// Units: m (x, z).
    pub centre_m: DVec2,
    /// What it does to the rain.
    pub rain: AreaRain,
    /// Width of the soft edge. Units: m.
    pub transition_m: f64,
    /// How much of it is there. Units: none. Domain: (0, 1].
    pub strength: f64,
    /// What is painted in it.
    pub density: Option<DensityMap>,
    pub(super) outline: Outline,
}

impl PlacedArea {
    /// Signed distance of a point (x, z) from the outline: negative inside, −∞ where it is unbounded. Units: m.
    #[must_use]
    pub fn distance_m(&self, place_m: DVec2) -> f64 {
        self.outline.distance(place_m - self.centre_m, f64::INFINITY)
    }

    /// Weight at a point (x, z). Units: none. In [0, 1].
    #[must_use]
    pub fn weight_at(&self, place_m: DVec2) -> f64 {
        self.weights_within(place_m, 0.0)[0]
    }

    /// Least and greatest weight within `radius_m` of a point.
    fn weights_within(&self, place_m: DVec2, radius_m: f64) -> [f64; 2] {
        let enough = 0.5 * self.transition_m + radius_m;
        let distance = self.outline.distance(place_m - self.centre_m, enough);
        let painted = self.painted_within(place_m, radius_m);
        let borders = [distance + radius_m, distance - radius_m];
        [0, 1].map(|i| self.strength * border_weight(borders[i], self.transition_m) * painted[i])
    }

    /// Least and greatest painted share within `radius_m` of a point, infinite for everywhere.
    fn painted_within(&self, place_m: DVec2, radius_m: f64) -> [f64; 2] {
        match &self.density {
            None => [1.0; 2],
            Some(map) if radius_m == f64::INFINITY => map.extremes(),
            Some(map) => map.within(place_m - self.centre_m, radius_m),
        }
    }

    /// ∇w. Units: 1/m.
    fn slope_at(&self, place_m: DVec2) -> DVec2 {
        let border = self.border_slope_at(place_m);
        match &self.density {
            None => border,
            Some(map) => {
                let local = place_m - self.centre_m;
                let distance = self.outline.distance(local, 0.5 * self.transition_m);
                let weight = self.strength * border_weight(distance, self.transition_m);
                border * map.at(local) + map.slope_at(local) * weight
            }
        }
    }

    /// ∇w of the border alone. Units: 1/m.
    fn border_slope_at(&self, place_m: DVec2) -> DVec2 {
        if self.transition_m == 0.0 {
            return DVec2::ZERO;
        }
        let local = place_m - self.centre_m;
        let half = 0.5 * self.transition_m;
        let distance = self.outline.distance(local, half);
        let t = 0.5 - distance / self.transition_m;
        if !(t > 0.0 && t < 1.0) {
            return DVec2::ZERO;
        }
        // Away from the nearest point; on the outline itself both sides meet, and the way there is lost to rounding.
        let away = (local - self.outline.nearest(local))
            .try_normalize()
            .unwrap_or_default()
            * distance.signum();
        away * (-6.0 * t * (1.0 - t) / self.transition_m * self.strength)
    }
}

/// All areas at one time. Areas without strength are left out.
#[derive(Debug, Clone, PartialEq)]
pub struct AreaField {
    areas: Vec<PlacedArea>,
    outside: f64,
}

impl Default for AreaField {
    /// No areas: the weather's rain everywhere.
    fn default() -> Self {
        Self::new(1.0)
    }
}

impl AreaField {
    /// No areas; `outside` is the share of the weather's rain that falls where no area is (none, held in [0, 1]).
    #[must_use]
    pub fn new(outside: f64) -> Self {
        Self {
            areas: Vec::new(),
            outside: clamped(outside, 0.0, 1.0),
        }
    }

    /// Forgets all areas; the memory stays.
    pub fn clear(&mut self, outside: f64) {
        self.areas.clear();
        self.outside = clamped(outside, 0.0, 1.0);
    }

    /// Adds an area as it is at `time_s` (units: s, on the rain clock), its centre moved by `offset_m` besides. What has
    /// not passed [`AreaSettings::check`] gives no panic and no promise.
    pub fn push(&mut self, settings: &AreaSettings, offset_m: DVec2, time_s: f64) {
        let fade: &AreaFade = &settings.fade;
        let strength = fade.strength(time_s);
        if strength > 0.0 {
            self.areas.push(PlacedArea {
                centre_m: settings.centre_at(time_s) + offset_m,
                rain: settings.rain,
                transition_m: settings.transition_m,
                strength,
                density: settings.density.clone(),
                outline: Outline::of(&settings.shape),
            });
        }
    }

    /// The areas that are there.
    #[must_use]
    pub fn areas(&self) -> &[PlacedArea] {
        &self.areas
    }

    /// Share of the weather's rain that falls where no area is. Units: none. Domain: [0, 1].
    #[must_use]
    pub fn outside(&self) -> f64 {
        self.outside
    }

    /// Whether the weather's rain falls everywhere as it is.
    #[must_use]
    pub fn is_uniform(&self) -> bool {
        self.areas.is_empty() && self.outside == 1.0
    }

    /// Rain rate at a point (x, z) under the weather's rate. Units: mm/h. In [0, 500].
    ///
    /// `weather_mm_h` held in [0, 500]; a place or a rate that is not a number is dry. Allocates nothing.
    ///
    /// Error: 1e-12 of the largest authored rate where edges are sharp, and of it times distance over transition.
    #[must_use]
    pub fn rate_at(&self, place_m: DVec2, weather_mm_h: f64) -> f64 {
        if place_m.is_nan() {
            return 0.0;
        }
        self.combined(weather_mm_h, |area| area.weight_at(place_m))
    }

    fn combined(&self, weather_mm_h: f64, weight: impl Fn(&PlacedArea) -> f64) -> f64 {
        let weather = clamped(weather_mm_h, 0.0, MAX_INTENSITY_MM_H);
        let (mut rate, mut factor) = (self.outside * weather, 1.0);
        for area in &self.areas {
            let weight = weight(area);
            match area.rain {
                AreaRain::Rate(own) => rate = rate.max(weight * own),
                AreaRain::OfWeather(share) => rate = rate.max(weight * share * weather),
                AreaRain::Scale(scale) => factor *= 1.0 - weight * (1.0 - scale),
            }
        }
        clamped(rate * factor, 0.0, MAX_INTENSITY_MM_H)
    }

    /// Rates that occur within `radius_m` of a point: none is below the first or above the second. Equal where the rain
    /// is even. Units: mm/h. Arguments as [`AreaField::rate_at`]; the radius from 0 on, infinite for everywhere.
    ///
    /// Error: the bounds hold; they are reached where one area alone has an edge there.
    #[must_use]
    pub fn rates_within(&self, place_m: DVec2, radius_m: f64, weather_mm_h: f64) -> [f64; 2] {
        if place_m.is_nan() || radius_m.is_nan() {
            return [0.0; 2];
        }
        let radius = radius_m.max(0.0);
        let of = |high: bool| {
            self.combined(weather_mm_h, |area| {
                let [least, most] = if radius == f64::INFINITY {
                    let whole = matches!(area.outline, Outline::Unbounded);
                    let painted = area.painted_within(place_m, radius);
                    [
                        if whole { area.strength * painted[0] } else { 0.0 },
                        area.strength * painted[1],
                    ]
                } else {
                    area.weights_within(place_m, radius)
                };
                // A factor below 1 gives most where its weight is least.
                let falls = matches!(area.rain, AreaRain::Scale(scale) if scale < 1.0);
                if high == falls { least } else { most }
            })
        };
        [of(false), of(true)]
    }

    /// No rate anywhere is above this. Units: mm/h.
    ///
    /// Error: none: a bound, reached unless a factor above 1 misses the heaviest rain.
    #[must_use]
    pub fn highest_mm_h(&self, weather_mm_h: f64) -> f64 {
        self.rates_within(DVec2::ZERO, f64::INFINITY, weather_mm_h)[1]
    }

    /// ∂rate/∂(x, z) at a point: of one side where two rules meet, 0 across a sharp edge. Units: mm/h per m.
    ///
    /// Error: 1e-6 of the rate over the transition, against differences.
    #[must_use]
    pub fn gradient_at(&self, place_m: DVec2, weather_mm_h: f64) -> DVec2 {
        if place_m.is_nan() {
            return DVec2::ZERO;
        }
        let weather = clamped(weather_mm_h, 0.0, MAX_INTENSITY_MM_H);
        let (mut rate, mut slope) = (self.outside * weather, DVec2::ZERO);
        let (mut factor, mut factor_slope) = (1.0, DVec2::ZERO);
        for area in &self.areas {
            let (weight, rises) = (area.weight_at(place_m), area.slope_at(place_m));
            match area.rain {
                AreaRain::Rate(own) if weight * own > rate => (rate, slope) = (weight * own, rises * own),
                AreaRain::OfWeather(share) if weight * share * weather > rate => {
                    (rate, slope) = (weight * share * weather, rises * (share * weather));
                }
                AreaRain::Scale(scale) => {
                    let own = 1.0 - weight * (1.0 - scale);
                    factor_slope = factor_slope * own - rises * ((1.0 - scale) * factor);
                    factor *= own;
                }
                AreaRain::Rate(_) | AreaRain::OfWeather(_) => {}
            }
        }
        if rate * factor >= MAX_INTENSITY_MM_H {
            DVec2::ZERO
        } else {
            slope * factor + factor_slope * rate
        }
    }
}
