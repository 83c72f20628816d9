//! What clear and muddy water leave of the light: Beer–Lambert along the ways in, out and round.
//!
//! # Accuracy
//! Ways are lengths of single representative rays: straight down along the refracted ray, up at 1.19 depths (mean over
//! the cone that escapes), round at 4.6 depths (mean over what the surface returns, most of it at slant angles).
//! Against the integral over all directions the albedo is off by at most 0.013. The mud's own light is single
//! scattering of light from straight above, forwards as in turbid harbour water ([`mud_phase`]): off by at most 0.045 of
//! its mean against the integral over an even sky. How bright thick mud is in the mean is its albedo, a choice: light
//! that is scattered more than once is in it.

use super::wet_albedo::WetBody;
use crate::constants::WATER_IOR;
use crate::error::{ConfigError, clamped, in_range};
use crate::ops;
use crate::optics::fresnel;

/// Mean way up per depth of light that leaves the water. Units: none.
const UP: f64 = 1.19;
/// Mean way per depth of light that the surface returned, up and down again. Units: none.
const ROUND: f64 = 4.6;

/// Mean cosine of the angle by which mud turns light: turbid harbour water (Petzold 1972).
const MUD_COSINE: f64 = 0.924;
/// Makes the mean of [`mud_phase`] over an even sky 1.
const MUD_SCALE: f64 = 11.457_85;

/// What water does to light on its way, per colour channel (R, G, B).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Water {
    /// Absorption. Units: 1/m. Domain: [0, 1e4].
    pub absorption_per_m: [f64; 3],
    /// Light lost to scattering by mud. Units: 1/m. Domain: [0, 1e4]. 0: clear.
    pub turbidity_per_m: f64,
    /// Albedo of mud too thick to see through. Units: none. Domain: [0, 1].
    pub mud_albedo: [f64; 3],
}

impl Water {
    /// Pure water: 0.34, 0.06, 0.01 per metre in R, G, B.
    pub const CLEAR: Self = Self {
        absorption_per_m: [0.34, 0.06, 0.01],
        turbidity_per_m: 0.0,
        mud_albedo: [0.0; 3],
    };

    /// A puddle of a street: clear but for a little loam.
    pub const STREET: Self = Self {
        turbidity_per_m: 5.0,
        mud_albedo: [0.30, 0.22, 0.13],
        ..Self::CLEAR
    };

    /// Water of a muddy road: the ground disappears within a few centimetres. Chosen by eye (E89, C49).
    pub const MUDDY: Self = Self {
        absorption_per_m: [3.0, 6.0, 12.0],
        turbidity_per_m: 40.0,
        mud_albedo: [0.16, 0.11, 0.07],
    };

    /// This water, if every number lies in its domain.
    ///
    /// # Errors
    /// Names the first that does not.
    pub fn validated(self) -> Result<Self, ConfigError> {
        for channel in 0..3 {
            in_range(
                "absorption_per_m",
                self.absorption_per_m[channel],
                0.0,
                1e4,
                "0 to 10000 per metre",
            )?;
            in_range("mud_albedo", self.mud_albedo[channel], 0.0, 1.0, "0 to 1")?;
        }
        in_range(
            "turbidity_per_m",
            self.turbidity_per_m,
            0.0,
            1e4,
            "0 to 10000 per metre",
        )?;
        Ok(self)
    }

    /// Share of the light that passes `way_m` of water, per channel: e^(−(absorption + turbidity) way).
    /// Negative ways and NaN count as 0. Error: 1e-15.
    #[must_use]
    pub fn transmittance(&self, way_m: f64) -> [f64; 3] {
        let way = clamped(way_m, 0.0, 1e9);
        self.absorption_per_m
            .map(|absorption| ops::exp(-(absorption + self.turbidity_per_m) * way))
    }
}

/// Albedo, per channel, of ground of dry albedo `dry` under `depth_m` of water, for light at `cos_incidence` in the
/// air, averaged over exit directions and without the mirror on top.
///
/// At depth 0 this is the soaked body ([`super::wet_albedo`]). Ground and depth are clamped to [0, 1] and [0, 1e9],
/// cosines to [0, 1]; NaN counts as 0. Error: 0.013 against the integral over all directions (absorbing water); mud 0.045 of
/// its albedo against single scattering ([`mud_phase`]).
#[must_use]
pub fn under_water(dry: [f64; 3], water: &Water, depth_m: f64, cos_incidence: f64) -> [f64; 3] {
    let depth = clamped(depth_m, 0.0, 1e9);
    let c = clamped(cos_incidence, 0.0, 1.0);
    let refracted = ops::sqrt(1.0 - (1.0 - c) * (1.0 + c) / (WATER_IOR * WATER_IOR));
    let body = WetBody {
        entry_reflectance: fresnel(c, WATER_IOR),
        ..WetBody::LEKNER_DORF
    };
    let down = water.transmittance(depth / refracted);
    let up = water.transmittance(UP * depth);
    let round = water.transmittance(ROUND * depth);
    core::array::from_fn(|i| {
        let ground = body.albedo_under(dry[i], down[i], up[i], round[i]);
        let loss = water.absorption_per_m[i] + water.turbidity_per_m;
        let met = 1.0 - ops::exp(-loss * depth * (1.0 / refracted + UP));
        let mud = (clamped(water.mud_albedo[i], 0.0, 1.0) * mud_phase(refracted)).min(1.0);
        let scattered = scattered_share(water.absorption_per_m[i], water.turbidity_per_m);
        ground + (1.0 - body.entry_reflectance) * mud * met * scattered
    })
}

/// How bright muddy water is along a ray under water, against its mean over all directions in the air: p(−μ)/(1 + μ)
/// over the mean, with p of Henyey & Greenstein 1941 and light from straight above. Units: none; μ in [0.66, 1] is
/// reached from the air.
///
/// Mud scatters forwards, so it is brighter where light has to turn less: 0.80 seen from above, 1.28 at a grazing angle.
/// μ is held in [0, 1]; what is not a number counts as 0. Error: 0.045 against single scattering integrated over an even
/// sky.
#[must_use]
pub fn mud_phase(cos_refracted: f64) -> f64 {
    let mu = clamped(cos_refracted, 0.0, 1.0);
    let spread = 1.0 + MUD_COSINE * MUD_COSINE + 2.0 * MUD_COSINE * mu;
    MUD_SCALE / (spread * ops::sqrt(spread) * (1.0 + mu))
}

/// Share of the mud's light that the water's own absorption leaves: scattering against all losses.
fn scattered_share(absorption: f64, turbidity: f64) -> f64 {
    if turbidity > 0.0 {
        turbidity / (turbidity + absorption)
    } else {
        0.0
    }
}
