//! A texel of a wet material: what the wet materials' shader makes of it on level ground seen from above, for textures that
//! are baked ahead (Lagarde 2013: with the weather known, all that changes with it can be dropped).
//!
//! # Accuracy
//! The same functions as in the shader, at one angle: muddy water, whose colour changes with the angle, looks as from
//! straight above. What needs the scene (cover, rings, waves, mirrored views) is not in a texture.

use super::artist_look::{ArtistLook, ArtistRules, artist_surface, crack_water, lagarde_porosity};
use super::surface_state::smoothstep;
use super::water_colour::{Water, under_water};
use super::wet_albedo::wet_albedo;
use super::wet_roughness::one_lobe;
use crate::error::{ConfigError, clamped, in_range};
use crate::ops;

/// Perceptual roughness of still water.
const WATER_ROUGHNESS: f64 = 0.045;
/// Perceptual roughness of a closed film on a rough road, chosen by eye.
const FILM_ROUGHNESS: f64 = 0.22;
/// Perceptual roughness that damp pores tend to, and how far.
const DAMP: [f64; 2] = [0.45, 0.75];
/// Least perceptual roughness of the physical look.
const LEAST_ROUGHNESS: f64 = 0.03;
/// Reflectance of water in the terms of [`MaterialTexel::reflectance`].
const WATER_REFLECTANCE: f64 = 0.357;
/// F₀ over the square of the reflectance.
const F0_PER_SQUARE: f64 = 0.16;
/// Perceptual roughnesses between which dielectrics are taken for smooth and for porous.
const POROUS: [f64; 2] = [0.35, 0.75];

/// A texel of a metallic–roughness material. Units: none. Domain: each [0, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MaterialTexel {
    /// Base colour, linear.
    pub base_colour: [f64; 3],
    /// Perceptual roughness: the root of α.
    pub roughness: f64,
    /// Metalness.
    pub metallic: f64,
    /// Reflectance of the dielectric part: F₀ = 0.16 reflectance².
    pub reflectance: f64,
}

impl MaterialTexel {
    fn held(self) -> Self {
        let unit = |x: f64| clamped(x, 0.0, 1.0);
        Self {
            base_colour: self.base_colour.map(unit),
            roughness: unit(self.roughness),
            metallic: unit(self.metallic),
            reflectance: unit(self.reflectance),
        }
    }
}

/// The weather that a texel is wetted for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FixedWetness {
    /// Saturation of the pores; with a source's rules its wet level. Domain: [0, 1].
    pub wetness: f64,
    /// Share of the surface under a film. Domain: [0, 1].
    pub film: f64,
    /// Share that stands under water everywhere. Domain: [0, 1].
    pub water: f64,
    /// Level up to which holes of a height map are under water. Domain: [0, 1].
    pub flood: f64,
    /// Depth of water whose share is 1. Units: m. Domain: [0, 1].
    pub depth_m: f64,
    /// Share of the body that darkens when soaked. Domain: [0, 1]. `None`: by roughness and metalness.
    pub porosity: Option<f64>,
    /// Whose rules it looks by. `None`: physics.
    pub rules: Option<ArtistRules>,
    /// The water.
    pub colour: Water,
}

impl Default for FixedWetness {
    /// Soaked without a film; the water of a street.
    fn default() -> Self {
        Self {
            wetness: 1.0,
            film: 0.0,
            water: 0.0,
            flood: 0.0,
            depth_m: 0.01,
            porosity: None,
            rules: None,
            colour: Water::STREET,
        }
    }
}

impl FixedWetness {
    /// This weather, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not finite or outside its domain.
    pub fn validated(self) -> Result<Self, ConfigError> {
        for (name, value) in [
            ("wetness", self.wetness),
            ("film", self.film),
            ("water", self.water),
            ("flood", self.flood),
            ("porosity", self.porosity.unwrap_or(0.0)),
        ] {
            in_range(name, value, 0.0, 1.0, "0 to 1")?;
        }
        in_range("depth_m", self.depth_m, 0.0, 1.0, "0 to 1 m")?;
        self.colour.validated()?;
        Ok(self)
    }
}

/// A texel as wet as this weather makes it; `height` of the material's relief there, 1 at its top and 0 in its deepest holes
/// (1 without a height map). Everything is clamped to its domain, NaN counts as 0.
/// Error: 1e-12 against its formulas one after the other; that of the functions it is made of.
#[must_use]
pub fn wet_texel(dry: &MaterialTexel, weather: &FixedWetness, height: f64) -> MaterialTexel {
    let unit = |x: f64| clamped(x, 0.0, 1.0);
    let dry = dry.held();
    let water = unit(weather.water).max(crack_water(weather.flood, height));
    match weather.rules {
        None => physical(&dry, weather, water),
        Some(rules) => by_rules(&dry, weather, water, rules),
    }
}

fn mix(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}

fn physical(dry: &MaterialTexel, weather: &FixedWetness, water: f64) -> MaterialTexel {
    let wetness = clamped(weather.wetness, 0.0, 1.0).max(smoothstep(0.0, 0.5, water));
    let film = clamped(weather.film, 0.0, 1.0).max(water);
    let guessed = smoothstep(POROUS[0], POROUS[1], dry.roughness) * (1.0 - dry.metallic);
    let soaking = clamped(weather.porosity.unwrap_or(guessed), 0.0, 1.0) * (1.0 - dry.metallic) * wetness;
    let under = under_water(dry.base_colour, &weather.colour, weather.depth_m * water, 1.0);
    let damp = mix(dry.roughness, DAMP[0], DAMP[1] * wetness);
    let bare = dry.roughness.min(damp);
    let rough = ops::sqrt(one_lobe(bare * bare, FILM_ROUGHNESS * FILM_ROUGHNESS, film)).min(dry.roughness);
    MaterialTexel {
        base_colour: core::array::from_fn(|i| {
            let body = mix(dry.base_colour[i], wet_albedo(dry.base_colour[i]), soaking);
            mix(body, under[i], water)
        }),
        roughness: mix(rough, WATER_ROUGHNESS, water).clamp(LEAST_ROUGHNESS, 1.0),
        metallic: dry.metallic * (1.0 - water),
        reflectance: mix(dry.reflectance, WATER_REFLECTANCE, film),
    }
}

fn by_rules(dry: &MaterialTexel, weather: &FixedWetness, water: f64, rules: ArtistRules) -> MaterialTexel {
    let gloss = 1.0 - dry.roughness;
    let porosity = weather
        .porosity
        .unwrap_or_else(|| lagarde_porosity(gloss, dry.metallic));
    let looks = dry.base_colour.map(|albedo| {
        let look = ArtistLook {
            albedo,
            gloss,
            f0: F0_PER_SQUARE * dry.reflectance * dry.reflectance,
        };
        artist_surface(rules, look, porosity, dry.metallic, weather.wetness, water)
    });
    let polished = (1.0 - looks[0].gloss).max(water * WATER_ROUGHNESS);
    MaterialTexel {
        base_colour: looks.map(|look| look.albedo),
        roughness: polished.clamp(WATER_ROUGHNESS, 1.0),
        metallic: dry.metallic * (1.0 - water),
        reflectance: ops::sqrt(looks[0].f0 / F0_PER_SQUARE),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STONE: MaterialTexel = MaterialTexel {
        base_colour: [0.4, 0.3, 0.2],
        roughness: 0.9,
        metallic: 0.0,
        reflectance: 0.5,
    };

    const METAL: MaterialTexel = MaterialTexel {
        metallic: 1.0,
        roughness: 0.3,
        ..STONE
    };

    const RULES: [Option<ArtistRules>; 4] = [
        None,
        Some(ArtistRules::Lagarde),
        Some(ArtistRules::LagardePorous),
        Some(ArtistRules::Nguyenova),
    ];

    fn weather(wetness: f64, water: f64, rules: Option<ArtistRules>) -> FixedWetness {
        FixedWetness {
            wetness,
            water,
            rules,
            ..FixedWetness::default()
        }
    }

    #[test]
    fn dry_weather_changes_nothing() {
        for rules in RULES {
            for texel in [STONE, METAL] {
                let found = wet_texel(&texel, &weather(0.0, 0.0, rules), 1.0);
                let apart = found.base_colour.iter().zip(texel.base_colour);
                let apart = apart.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                let others = (found.roughness - texel.roughness).abs() + (found.reflectance - texel.reflectance).abs();
                assert!(
                    apart.max(others) < 1e-12 && found.metallic == texel.metallic,
                    "{rules:?} {found:?}"
                );
            }
        }
    }

    #[test]
    fn wet_texels_have_the_values_of_their_formulas() {
        let wet = wet_texel(&STONE, &weather(1.0, 0.0, None), 1.0);
        for (found, dry) in wet.base_colour.iter().zip(STONE.base_colour) {
            assert!((found - wet_albedo(dry)).abs() < 1e-12);
        }
        // 0.9 → 0.45 by three quarters.
        assert!((wet.roughness - 0.5625).abs() < 1e-12 && wet.reflectance == 0.5);
        let half = wet_texel(&STONE, &weather(0.5, 0.0, None), 1.0);
        assert!((half.base_colour[0] - 0.5 * (0.4 + wet_albedo(0.4))).abs() < 1e-12);
        let pond = wet_texel(&METAL, &weather(0.0, 1.0, None), 1.0);
        let bottom = under_water(METAL.base_colour, &Water::STREET, 0.01, 1.0);
        assert!(pond.base_colour.iter().zip(bottom).all(|(a, b)| (a - b).abs() < 1e-12));
        assert!((pond.roughness - 0.045).abs() < 1e-12 && pond.metallic == 0.0 && pond.reflectance == 0.357);
        // Metals take the film alone.
        let rained = FixedWetness {
            film: 1.0,
            ..FixedWetness::default()
        };
        let metal = wet_texel(&METAL, &rained, 1.0);
        assert!(metal.base_colour == METAL.base_colour && (metal.roughness - 0.22).abs() < 1e-12);
        // Lagarde: 0.3 of the albedo, 2.5 times the gloss.
        let lagarde = wet_texel(&STONE, &weather(1.0, 0.0, Some(ArtistRules::Lagarde)), 1.0);
        assert!((lagarde.base_colour[1] - 0.09).abs() < 1e-12 && (lagarde.roughness - 0.75).abs() < 1e-12);
        let flooded = wet_texel(&STONE, &weather(1.0, 1.0, Some(ArtistRules::Lagarde)), 1.0);
        assert!((flooded.roughness - 0.045).abs() < 1e-12 && (flooded.reflectance - 0.125_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn holes_flood_by_their_height_and_odd_numbers_are_held() {
        let flood = FixedWetness {
            flood: 0.4,
            ..FixedWetness::default()
        };
        let by_height = |height: f64| wet_texel(&STONE, &flood, height).roughness;
        // Under 0.6 the water is 0.4 everywhere; on top none.
        assert!(by_height(1.0) == wet_texel(&STONE, &FixedWetness::default(), 0.0).roughness);
        assert!(by_height(0.0) == by_height(0.6) && by_height(0.8) > by_height(0.7) && by_height(0.7) > by_height(0.5));
        let odd = MaterialTexel {
            base_colour: [f64::NAN, -1.0, 7.0],
            roughness: f64::NAN,
            metallic: 3.0,
            reflectance: f64::INFINITY,
        };
        for rules in RULES {
            let storm = FixedWetness {
                wetness: f64::NAN,
                film: 9.0,
                water: -1.0,
                flood: f64::INFINITY,
                depth_m: f64::NAN,
                porosity: Some(f64::NAN),
                ..weather(0.0, 0.0, rules)
            };
            let found = wet_texel(&odd, &storm, f64::NAN);
            let all = [found.roughness, found.metallic, found.reflectance];
            let held = all.iter().chain(&found.base_colour).all(|v| (0.0..=1.0).contains(v));
            assert!(held, "{rules:?} {found:?}");
        }
    }

    #[test]
    fn each_field_is_checked_and_named() {
        assert!(FixedWetness::default().validated().is_ok());
        for bad in [f64::NAN, -0.1, 1.1] {
            let base = FixedWetness::default();
            let all = [
                ("wetness", FixedWetness { wetness: bad, ..base }),
                ("film", FixedWetness { film: bad, ..base }),
                ("water", FixedWetness { water: bad, ..base }),
                ("flood", FixedWetness { flood: bad, ..base }),
                ("depth_m", FixedWetness { depth_m: bad, ..base }),
                (
                    "porosity",
                    FixedWetness {
                        porosity: Some(bad),
                        ..base
                    },
                ),
            ];
            for (name, weather) in all {
                let message = weather.validated().expect_err("invalid").to_string();
                assert!(message.starts_with(name), "{message}");
            }
        }
    }
}
