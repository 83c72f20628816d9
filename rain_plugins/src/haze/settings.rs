//! What users set.

use bevy::prelude::*;
use rain_core::error::{ConfigError, in_range};
use rain_core::haze::{DRY_EXTINCTION_PER_M, HYGROSCOPICITY};
use rain_core::rainfall::FarRainSettings;
use rain_core::splash::MistGround;
use rain_render::haze::MAX_HAZE_LAMPS;

/// Longest accepted way through the rain. Units: m.
pub const MAX_HAZE_LIMIT_M: f32 = 1e5;

/// How a view shows the haze of rain. On a camera with [`crate::rainfall::RainView`]; each gets the defaults.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default)]
pub struct HazeSettings {
    /// Draws haze. Views whose `RainView` is off draw none in any case.
    pub enabled: bool,
    /// Extinction over cross-section Q. Units: none. Domain: [1, 4]. Default: 2, that of
    /// [`RainQueries::visibility_m`](rain_ecs::prelude::RainQueries::visibility_m); a camera loses between 1 and 2.
    pub efficiency: f32,
    /// Height (world Y) that rain falls from; there is no haze above. Units: m. Domain: ±10⁵. Default: 1000.
    pub cloud_base_m: f32,
    /// Rain thins out below that height, over this share of what the base is over the eye: bases hang down in showers, and a
    /// curtain seen from afar has no edge. Units: none. Domain: [0, 1]. Default: 0.4, by eye; 0: a level base.
    pub cloud_softness: f32,
    /// Longest way through the rain; sky and what lies further away get the haze of this. Units: m. Domain: [10, 10⁵].
    /// Default: 20 000.
    pub limit_m: f32,
    /// Lamps (point and spot lights) that glow, those with the most light at the eye first; 0: none. Domain: 0 to 16.
    /// Default: 16.
    pub lamps: u32,
    /// Gain on the glow of lamps. Units: none. Domain: [0, 100]. Default: 1, physical: rain alone glows faintly, what one
    /// remembers as a halo is mostly mist and the lens.
    pub glow: f32,
    /// Fog as an artist sets it, in place of the rain's. Default: none.
    pub artist: Option<ArtistFog>,
    /// How much of it is drawn as far rain where [`RainView::far_rain`](crate::rainfall::RainView::far_rain) is on.
    #[reflect(ignore)]
    pub far_rain: FarRainSettings,
    /// Haze of the air itself, which grows into mist and fog with the weather's humidity, with or without rain. Default:
    /// none.
    pub mist: Option<Mist>,
    /// Mist that splashes throw up over what rain hits, and that strong wind carries up. Default: none.
    pub splash_mist: Option<SplashMist>,
}

/// The finest drops of splashes (`rain_core::splash::MistLayers`): a white fringe a hand's breadth high over ground, roofs and
/// whatever else rain hits, seen at a flat angle and over edges; above some 10 m/s of wind a spray to the height of the eye.
/// Needs [`CoverPlugin`](crate::cover::CoverPlugin): without its map what rain hits is not known, and there is none.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Default)]
pub struct SplashMist {
    /// Gain on its extinction. Units: none. Domain: [0, 100]. Default: 1, the model's, which is sure to a factor of a few.
    pub gain: f32,
    /// Roughness length of the ground about the view. Units: m. Domain: [10⁻⁴, 2]. Default: 0.03, short grass or a wide
    /// road; a town has 1.
    pub roughness_m: f32,
    /// Length of ground in the rain upwind: mist is carried the higher the longer it is, 5.5 m by default. Units: m. Domain:
    /// [1, 10⁴]. Default: 200.
    pub fetch_m: f32,
}

impl Default for SplashMist {
    fn default() -> Self {
        let ground = MistGround::default();
        Self {
            gain: 1.0,
            roughness_m: ground.roughness_m as f32,
            fetch_m: ground.fetch_m as f32,
        }
    }
}

/// Particles in the air that take up water (Petters & Kreidenweis 2007): haze in dry air, mist near saturation, fog at it.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Default)]
pub struct Mist {
    /// Extinction of the dry particles. Units: 1/m. Domain: [0, 1]. Default: 0.0001, clean country air.
    pub dry_per_m: f32,
    /// Hygroscopicity κ. Units: none. Domain: [0, 2]. Default: 0.3, mixed particles over land; sea salt has 1.2.
    pub hygroscopicity: f32,
}

impl Default for Mist {
    fn default() -> Self {
        Self {
            dry_per_m: DRY_EXTINCTION_PER_M as f32,
            hygroscopicity: HYGROSCOPICITY as f32,
        }
    }
}

/// The open sky that lights a view's haze, where the camera's [`EnvironmentMapLight`](bevy::light::EnvironmentMapLight)
/// holds what stands about it: rain far away stands under the sky, not among the houses near the eye. Without it haze takes
/// the camera's map.
#[derive(Component, Reflect, Clone, Debug)]
#[reflect(Component)]
pub struct HazeSky {
    /// Prefiltered cube map, as of an `EnvironmentMapLight`.
    pub specular_map: Handle<Image>,
    /// Its scale to luminance. Units: cd/m².
    pub intensity: f32,
}

/// Fog the artists' way (Lagarde 2013): denser in heavier rain, losing its colour as the rain sets in. Nothing physical.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Default)]
pub struct ArtistFog {
    /// Density without rain. Units: 1/m. Domain: [0, 10]. Default: 0.001.
    pub density_per_m: f32,
    /// The density in the heaviest rain is 1 + gain times that. Units: none. Domain: [0, 1000]. Default: 4.
    pub gain: f32,
    /// Linear colour; its luminance is that of the view's surroundings times its own. Default: none, what surrounds the view.
    pub colour: Option<LinearRgba>,
    /// How much of its colour it loses in rain. Units: none. Domain: [0, 1]. Default: 0.8.
    pub desaturation: f32,
    /// How long it takes to lose it. Units: s. Domain: [0, 10⁶]. Default: 20.
    pub transition_s: f32,
}

impl Default for ArtistFog {
    fn default() -> Self {
        Self {
            density_per_m: 0.001,
            gain: 4.0,
            colour: None,
            desaturation: 0.8,
            transition_s: 20.0,
        }
    }
}

impl Default for HazeSettings {
    fn default() -> Self {
        Self {
            enabled: true,
            efficiency: 2.0,
            cloud_base_m: 1000.0,
            cloud_softness: 0.4,
            limit_m: 20_000.0,
            lamps: MAX_HAZE_LAMPS as u32,
            glow: 1.0,
            artist: None,
            far_rain: FarRainSettings::default(),
            mist: None,
            splash_mist: None,
        }
    }
}

impl HazeSettings {
    /// These settings, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not finite or outside its domain.
    pub fn validated(self) -> Result<Self, ConfigError> {
        in_range("efficiency", self.efficiency.into(), 1.0, 4.0, "1 to 4")?;
        in_range("cloud_base_m", self.cloud_base_m.into(), -1e5, 1e5, "-1e5 to 1e5 m")?;
        in_range("cloud_softness", self.cloud_softness.into(), 0.0, 1.0, "0 to 1")?;
        let furthest = f64::from(MAX_HAZE_LIMIT_M);
        in_range("limit_m", self.limit_m.into(), 10.0, furthest, "10 to 1e5 m")?;
        in_range("lamps", self.lamps.into(), 0.0, MAX_HAZE_LAMPS as f64, "0 to 16")?;
        in_range("glow", self.glow.into(), 0.0, 100.0, "0 to 100")?;
        self.far_rain.validated()?;
        if let Some(fog) = self.artist {
            fog.validated()?;
        }
        if let Some(mist) = self.mist {
            in_range("dry_per_m", mist.dry_per_m.into(), 0.0, 1.0, "0 to 1 per m")?;
            in_range("hygroscopicity", mist.hygroscopicity.into(), 0.0, 2.0, "0 to 2")?;
        }
        if let Some(mist) = self.splash_mist {
            in_range("gain", mist.gain.into(), 0.0, 100.0, "0 to 100")?;
            // Single precision rounds the least down.
            in_range("roughness_m", mist.roughness_m.into(), 0.999e-4, 2.0, "1e-4 to 2 m")?;
            in_range("fetch_m", mist.fetch_m.into(), 1.0, 1e4, "1 to 1e4 m")?;
        }
        Ok(self)
    }
}

impl ArtistFog {
    /// These settings, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not finite or outside its domain.
    pub fn validated(self) -> Result<Self, ConfigError> {
        in_range("density_per_m", self.density_per_m.into(), 0.0, 10.0, "0 to 10 per m")?;
        in_range("gain", self.gain.into(), 0.0, 1e3, "0 to 1000")?;
        in_range("desaturation", self.desaturation.into(), 0.0, 1.0, "0 to 1")?;
        in_range("transition_s", self.transition_s.into(), 0.0, 1e6, "0 to 1e6 s")?;
        let colour = self.colour.unwrap_or(LinearRgba::BLACK);
        for value in [colour.red, colour.green, colour.blue] {
            in_range("colour", value.into(), 0.0, 1e4, "0 to 1e4")?;
        }
        Ok(self)
    }
}
