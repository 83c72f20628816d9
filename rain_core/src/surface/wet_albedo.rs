//! How much darker a soaked body is: light that the water's surface throws back is absorbed in the body once more.
//!
//! A rough body of albedo ρ under water of index n (Ångström 1925): of the light that enters, 1 − F₀, the body absorbs
//! a at each meeting and the surface returns p = 1 − (1 − R̄(n))/n² of what leaves, so
//! ρ_wet = (1 − F₀) [1 − a/(1 − p (1 − a))]. Lekner & Dorf 1988 let a, too, change with the index around the grains:
//! a = a_d [(1 − a_d)(1 − R̄(n_r/n))/(1 − R̄(n_r)) + a_d], a_d = 1 − ρ. With g = (1 − R̄(n_r/n))/(1 − R̄(n_r)) this is
//! 1 − a = ρ (2 − g + (g − 1) ρ), which does not cancel for dark bodies. For each colour channel.
//!
//! This is the body alone; the water's own reflection is added by its lobe. F₀ belongs to light from above; under a
//! uniform sky it is R̄ ([`WetBody::UNDER_SKY`]).
//!
//! # Accuracy
//! At normal incidence and averaged over exit directions the formula is exact for a Lambertian body under smooth water
//! (1e-8 against Fresnel's equations integrated). n_r from 1.5 to 1.6 moves the ratio by less than 0.001. Media whose
//! pores fill also scatter more forward and darken further (Twomey et al. 1986): real soils by up to 20 % more. The
//! constant factor 0.3 of the source systems is off by up to 0.68 in albedo (light bodies).

use crate::constants::WATER_IOR;
use crate::error::{clamped, clamped_f32};
use crate::optics::fresnel;

/// R̄(1.333), mean of Fresnel's reflectance over a hemisphere of uniform light. Units: none.
const WATER_MEAN_REFLECTANCE: f64 = 0.066_405_77;
/// R̄(1.55): the grains of a dry body.
const DRY_GRAIN_REFLECTANCE: f64 = 0.099_065_8;
/// R̄(1.55/1.333): the grains in water.
const WET_GRAIN_REFLECTANCE: f64 = 0.037_528_1;

/// F₀ of water in air.
const F0: f64 = (WATER_IOR - 1.0) * (WATER_IOR - 1.0) / ((WATER_IOR + 1.0) * (WATER_IOR + 1.0));

/// How water and grains meet the light: one set of coefficients for all albedos.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WetBody {
    /// g, how much more absorption the grains show in water than in air. Units: none. 1: unchanged.
    pub index_gain: f64,
    /// p, share of the light from the body that the water's surface returns. Units: none.
    pub internal_reflectance: f64,
    /// Share of the incoming light that never enters. Units: none.
    pub entry_reflectance: f64,
}

impl WetBody {
    /// Lekner & Dorf 1988, light from straight above: n = 1.333, n_r = 1.55. The default.
    pub const LEKNER_DORF: Self = Self {
        index_gain: (1.0 - WET_GRAIN_REFLECTANCE) / (1.0 - DRY_GRAIN_REFLECTANCE),
        internal_reflectance: 1.0 - (1.0 - WATER_MEAN_REFLECTANCE) / (WATER_IOR * WATER_IOR),
        entry_reflectance: F0,
    };

    /// Without the change of the grains' index (Ångström 1925): 4–7 % lighter.
    pub const ANGSTROM: Self = Self {
        index_gain: 1.0,
        ..Self::LEKNER_DORF
    };

    /// Lekner & Dorf under a uniform sky: R̄ of the light never enters (4.7 % less than from straight above).
    pub const UNDER_SKY: Self = Self {
        entry_reflectance: WATER_MEAN_REFLECTANCE,
        ..Self::LEKNER_DORF
    };

    /// Albedo of the soaked body. Units: none. `dry` is clamped to [0, 1], NaN counts as 0.
    /// Error: 5e-9 against the printed formula with R̄ by quadrature.
    #[must_use]
    pub fn albedo(&self, dry: f64) -> f64 {
        let b = self.body(unit(dry));
        (1.0 - self.entry_reflectance) * self.escape(b, 1.0)
    }

    /// [`Self::albedo`] in single precision. Error: 3e-7.
    #[must_use]
    #[inline]
    pub fn albedo_f32(&self, dry: f32) -> f32 {
        let (g, p) = (self.index_gain as f32, self.internal_reflectance as f32);
        let outer = ((1.0 - self.entry_reflectance) * (1.0 - self.internal_reflectance)) as f32;
        let rho = unit_f32(dry);
        let b = rho * (2.0 - g + (g - 1.0) * rho);
        outer * b / (1.0 - p * b)
    }

    /// Albedo of the body for light that comes at an angle, averaged over exit directions: the share 1 − F enters.
    /// With the mirror's F it never exceeds 1 (white furnace). `cos_incidence` is clamped to [0, 1], NaN counts as 0.
    /// Error: 2e-15 against the formula, 1e-8 against Fresnel's equations integrated, bounce by bounce.
    #[must_use]
    pub fn albedo_at(&self, dry: f64, cos_incidence: f64) -> f64 {
        let b = self.body(unit(dry));
        (1.0 - fresnel(unit(cos_incidence), WATER_IOR)) * self.escape(b, 1.0)
    }

    /// The body under water that lets only `down` of the light through on its way in, `up` on its way out and `round`
    /// on a way from the body to the surface and back (see [`super::under_water`]).
    pub(super) fn albedo_under(&self, dry: f64, down: f64, up: f64, round: f64) -> f64 {
        let b = self.body(unit(dry));
        (1.0 - self.entry_reflectance) * down * up * self.escape(b, round)
    }

    /// 1 − a: what the body in water throws back at each meeting.
    fn body(&self, dry: f64) -> f64 {
        dry * (2.0 - self.index_gain + (self.index_gain - 1.0) * dry)
    }

    /// Share of the light in the water that leaves at last.
    fn escape(&self, b: f64, round: f64) -> f64 {
        (1.0 - self.internal_reflectance) * b / (1.0 - self.internal_reflectance * round * b)
    }
}

/// `x` in [0, 1], NaN gives 0. Without a branch, so that loops over texels are vectorised.
fn unit(x: f64) -> f64 {
    clamped(x, 0.0, 1.0)
}

/// [`unit`] in single precision.
fn unit_f32(x: f32) -> f32 {
    clamped_f32(x, 0.0, 1.0)
}

/// Albedo of a body soaked with water, by Lekner & Dorf: [`WetBody::albedo`] of [`WetBody::LEKNER_DORF`]. Units: none.
/// `dry` is clamped to [0, 1], NaN counts as 0. Error: 5e-9 against the printed formula with R̄ by quadrature.
#[must_use]
pub fn wet_albedo(dry: f64) -> f64 {
    WetBody::LEKNER_DORF.albedo(dry)
}

/// [`wet_albedo`] in single precision. Error: 3e-7.
#[must_use]
#[inline]
pub fn wet_albedo_f32(dry: f32) -> f32 {
    WetBody::LEKNER_DORF.albedo_f32(dry)
}

/// [`wet_albedo_f32`] of each channel (linear, not sRGB): wetting also makes colours more saturated. Error: 3e-7.
#[must_use]
#[inline]
pub fn wet_albedo_rgb(dry: [f32; 3]) -> [f32; 3] {
    dry.map(wet_albedo_f32)
}

/// Albedo at a pore saturation: from dry to soaked along a straight line. `saturation` is clamped to [0, 1], NaN
/// counts as 0. Error: 2e-15 against the formula; the straight line is a choice.
#[must_use]
pub fn saturated_albedo(dry: f64, saturation: f64) -> f64 {
    let (dry, w) = (unit(dry), unit(saturation));
    dry + (wet_albedo(dry) - dry) * w
}

/// [`saturated_albedo`] in single precision. Error: 3e-7.
#[must_use]
#[inline]
pub fn saturated_albedo_f32(dry: f32, saturation: f32) -> f32 {
    let (dry, w) = (unit_f32(dry), unit_f32(saturation));
    dry + (wet_albedo_f32(dry) - dry) * w
}
