//! The source systems' own rules for wet looks, by their names: Lagarde 2013 (E) and Nguyenova 2021 (C).
//!
//! Kept for comparison and for looks that are authored by hand. The library's own way is [`super::wet_albedo`] and
//! [`super::film_roughness`]. All values are in [0, 1] and linear; every input is clamped there, NaN counts as 0.
//!
//! # Accuracy
//! Looks, chosen by eye: a constant factor 0.3 darkens light materials two to three times too much, and the factor 2.5
//! on gloss makes every gloss of 0.4 and more a perfect mirror (both sources' errata). The bounds below are those of the
//! arithmetic against the listings; nothing of nature is claimed.

use serde::{Deserialize, Serialize};

use crate::error::clamped;

/// Darkest factor on the albedo of a wet surface (both sources).
const WET_ALBEDO: f64 = 0.3;
/// Largest factor on the gloss of a wet surface (both sources).
const WET_GLOSS: f64 = 2.5;
/// Darkest factor on the albedo of the most porous surface (Lagarde 2013, part 3b).
const POROUS_ALBEDO: f64 = 0.2;
/// Factor on the albedo under a puddle (Nguyenova 2021, listing).
const PUDDLE_ALBEDO: f64 = 0.8;
/// Depth of a full puddle (Nguyenova 2021). Units: mm.
const PUDDLE_DEPTH_MM: f64 = 10.0;
/// F₀ of water as Lagarde rounds it.
const LAGARDE_F0: f64 = 0.02;

fn unit(x: f64) -> f64 {
    clamped(x, 0.0, 1.0)
}

fn lerp(a: f64, b: f64, t: f64) -> f64 {
    a * (1.0 - t) + b * t
}

/// What the rules change of a material. Gloss 1 is a mirror.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArtistLook {
    /// Diffuse albedo of one channel. Domain: [0, 1].
    pub albedo: f64,
    /// Gloss (smoothness). Domain: [0, 1].
    pub gloss: f64,
    /// Reflectance at normal incidence. Domain: [0, 1].
    pub f0: f64,
}

impl ArtistLook {
    fn clamped(self) -> Self {
        Self {
            albedo: unit(self.albedo),
            gloss: unit(self.gloss),
            f0: unit(self.f0),
        }
    }

    /// Under accumulated water A: gloss towards 1, F₀ towards 0.02 (E6, E7; Lagarde 2013, equation 3). The normal goes
    /// to the water's by the same weight.
    /// Error: 5e-16 against the listing; a look.
    #[must_use]
    pub fn flooded(self, accumulated: f64) -> Self {
        let (look, a) = (self.clamped(), unit(accumulated));
        Self {
            gloss: lerp(look.gloss, 1.0, a),
            f0: lerp(look.f0, LAGARDE_F0, a),
            ..look
        }
    }
}

/// `DoWetProcess` of Lagarde 2013, equations 1 and 2 (E3), and listing L1 of Nguyenova 2021 (C24, C25):
/// albedo × lerp(1, 0.3, w), gloss × lerp(1, 2.5, w) up to 1.
/// Error: 5e-16 against the listing; a look, off by up to 0.68 in albedo from [`super::wet_albedo`].
#[must_use]
pub fn lagarde_wet(look: ArtistLook, wetness: f64) -> ArtistLook {
    let (look, w) = (look.clamped(), unit(wetness));
    ArtistLook {
        albedo: look.albedo * lerp(1.0, WET_ALBEDO, w),
        gloss: (look.gloss * lerp(1.0, WET_GLOSS, w)).min(1.0),
        ..look
    }
}

/// Porosity guessed from gloss: saturate(((1 − gloss) − 0.5)/0.4) (Lagarde 2013, part 3b). Metals have none.
/// Error: 4e-16 against the listing; a guess.
#[must_use]
pub fn lagarde_porosity(gloss: f64, metalness: f64) -> f64 {
    unit((0.5 - unit(gloss)) / 0.4) * (1.0 - unit(metalness))
}

/// `DoWetProcess` with porosity (Lagarde 2013, part 3b): factor = lerp(1, 0.2, porosity); albedo × lerp(1, factor, w);
/// gloss = lerp(1, gloss, lerp(1, factor, w/2)). What is not porous keeps both.
/// Error: 5e-16 against the listing; a look.
#[must_use]
pub fn lagarde_porous_wet(look: ArtistLook, porosity: f64, wetness: f64) -> ArtistLook {
    let (look, w) = (look.clamped(), unit(wetness));
    let factor = lerp(1.0, POROUS_ALBEDO, unit(porosity));
    ArtistLook {
        albedo: look.albedo * lerp(1.0, factor, w),
        gloss: lerp(1.0, look.gloss, lerp(1.0, factor, 0.5 * w)),
        ..look
    }
}

/// Water in cracks and holes of a height map: min(flood level, 1 − height) (E20; Lagarde 2013, equation 4). White
/// (height 1) never floods (E17).
/// Error: 4e-16 against the listing; a look, no water balance.
#[must_use]
pub fn crack_water(flood_level: f64, height: f64) -> f64 {
    unit(flood_level).min(1.0 - unit(height))
}

/// Water in painted puddles: saturate((flood level − depth)/margin) (E15; Lagarde 2013, equation 5, margin 0.4 there).
/// Depth 0 floods first, 1 never. A margin below 1e-4 or NaN counts as 1e-4.
/// Error: 3e-16 over the margin against the listing; a look, no water balance.
#[must_use]
pub fn painted_puddle_water(flood_level: f64, depth: f64, margin: f64) -> f64 {
    unit((unit(flood_level) - unit(depth)) / margin.max(1e-4))
}

/// The larger of both waters (E23; Lagarde 2013, equation 6).
/// Error: 4e-16 against the listing; a look, no water balance.
#[must_use]
pub fn accumulated_water(cracks: f64, puddles: f64) -> f64 {
    unit(cracks).max(unit(puddles))
}

/// Wetness that shades: saturate(wet level · mask + accumulated water) (E9, E40; Lagarde 2013, equation 7 with the
/// mask on the rain's part alone, so that a sheltered place is dry but what is flooded is wet).
/// Error: 4e-16 against the listing; a look.
#[must_use]
pub fn effective_wetness(wet_level: f64, mask: f64, accumulated: f64) -> f64 {
    unit(unit(wet_level) * unit(mask) + unit(accumulated))
}

/// Puddle map over height map: 1 − (1 − a)(1 − b) (C41).
/// Error: 4e-16 against a + b − a b; a look.
#[must_use]
pub fn screen_blend(puddle_map: f64, height_map: f64) -> f64 {
    1.0 - (1.0 - unit(puddle_map)) * (1.0 - unit(height_map))
}

/// Puddle amount: water level above the blended map (C42; Nguyenova 2021, listing L2).
/// Error: 4e-16 against the listing; a look, no water balance.
#[must_use]
pub fn nguyenova_puddle_amount(water_level: f64, blended: f64) -> f64 {
    (unit(water_level) - unit(blended)).max(0.0)
}

/// Share under a film of the drenched ground around a puddle (C36, C217; Nakamae et al. 1990: between wet and puddle, by
/// height): smoothstep(−width, 0, level − blended), less where the level is below the width, so that it starts from
/// nothing. A width of 0 (or NaN) has no such ground: wet passes straight into puddle (C37).
/// Error: 1e-15 over the width against the form above; a look, no water balance.
#[must_use]
pub fn drenched_share(water_level: f64, blended: f64, width: f64) -> f64 {
    let (level, width) = (unit(water_level), unit(width));
    if width <= 0.0 {
        return 0.0;
    }
    let t = unit((level - unit(blended) + width) / width);
    t * t * (3.0 - 2.0 * t) * unit(level / width)
}

/// Depth of a puddle amount, at most 10 mm (C48). Units: mm.
/// Error: 2e-16 relative; a look, no water balance.
#[must_use]
pub fn nguyenova_puddle_depth_mm(amount: f64) -> f64 {
    PUDDLE_DEPTH_MM * unit(amount)
}

/// A wet look under a puddle amount p: albedo × lerp(1, 0.8, p), gloss to 1 (C43; Nguyenova 2021, listing L2).
/// Error: 5e-16 against the listing; a look.
#[must_use]
pub fn nguyenova_puddle(look: ArtistLook, amount: f64) -> ArtistLook {
    let (look, p) = (look.clamped(), unit(amount));
    ArtistLook {
        albedo: look.albedo * lerp(1.0, PUDDLE_ALBEDO, p),
        gloss: lerp(look.gloss, 1.0, p),
        ..look
    }
}

/// Whose rules a wet surface follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ArtistRules {
    /// [`lagarde_wet`], water on top by [`ArtistLook::flooded`] (E3, E6, E7).
    #[default]
    Lagarde,
    /// [`lagarde_porous_wet`], water on top by [`ArtistLook::flooded`].
    LagardePorous,
    /// [`lagarde_wet`], water on top by [`nguyenova_puddle`] (C24, C25, C43).
    Nguyenova,
}

/// A surface of a wet level under accumulated water, by one source's rules: the four types dry, wet, drenched and
/// puddle are (0, 0), (w, 0), (w, 0 < A < 1) and (any, 1) (E1, E8; Nakamae et al. 1990).
///
/// Wetness is the wet level and the water (E9; with Nguyenova the wet level alone). Albedo is that of the dielectric
/// part: metals keep theirs. `porosity` counts with [`ArtistRules::LagardePorous`] alone ([`lagarde_porosity`] guesses
/// it). Error: 9e-16 against the listings one after the other; a look.
#[must_use]
pub fn artist_surface(
    rules: ArtistRules,
    look: ArtistLook,
    porosity: f64,
    metalness: f64,
    wet_level: f64,
    water: f64,
) -> ArtistLook {
    let (look, metal, a) = (look.clamped(), unit(metalness), unit(water));
    let wetness = effective_wetness(wet_level, 1.0, a);
    let wet = match rules {
        ArtistRules::Lagarde => lagarde_wet(look, wetness).flooded(a),
        ArtistRules::LagardePorous => lagarde_porous_wet(look, porosity, wetness).flooded(a),
        ArtistRules::Nguyenova => nguyenova_puddle(lagarde_wet(look, wet_level), a),
    };
    ArtistLook {
        albedo: lerp(wet.albedo, look.albedo, metal),
        ..wet
    }
}
