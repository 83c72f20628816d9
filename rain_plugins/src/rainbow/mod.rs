//! Rainbows in the haze of cameras that ask for them.
//!
//! Off by default: without [`Rainbow`] on a camera nothing is computed. The bow has no pass of its own; where it shows, the
//! haze reads its light from a table.

use std::sync::Arc;

use bevy::light::DirectionalLight;
use bevy::prelude::*;
use rain_core::error::{ConfigError, in_range};
use rain_core::optics::{RainbowPhase, RainbowTables};
use rain_ecs::prelude::*;

use crate::haze::{BowShot, HazeViewFrame, aim_haze, haze_mirrors};
use crate::report::{PassName, RainReport, SkipReason};
use crate::schedule::RainViewSystems;

/// Put on a camera with [`RainView`](crate::rainfall::RainView): where the strongest directional light shines on rain in
/// sight, drops send its light back in both rainbows, and dark between them.
///
/// Its light is that of the lamp at the eye, whatever hides it elsewhere; clouds are the app's. Rain that is drawn as drops
/// has its share, too.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default)]
#[require(RainbowLight)]
pub struct Rainbow {
    /// Gain. Units: none. Domain: [0, 100]; 0 is off. Default: 1, physical.
    pub strength: f32,
    /// Radius of all drops. Units: m. Domain: [2e-6, 0.0048]. Default: none, those of the heaviest rain in reach. Fog of
    /// 1e-5 has a wide white bow.
    pub drop_radius_m: Option<f32>,
}

impl Default for Rainbow {
    fn default() -> Self {
        Self {
            strength: 1.0,
            drop_radius_m: None,
        }
    }
}

impl Rainbow {
    /// These settings, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not finite or outside its domain.
    pub fn validated(self) -> Result<Self, ConfigError> {
        in_range("strength", self.strength.into(), 0.0, 100.0, "0 to 100")?;
        if let Some(radius) = self.drop_radius_m {
            in_range("drop_radius_m", radius.into(), 2e-6, 0.0048, "2e-6 to 0.0048 m")?;
        }
        Ok(self)
    }
}

/// What the bow of a view is made from: the slope of its spectrum (1/mm), or the radius of its drops.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Drops {
    Rain(f64),
    Radius(f32),
}

impl Drops {
    /// Whether the bow of these shows what that of `other` does.
    fn is_near(self, other: Self) -> bool {
        match (self, other) {
            (Self::Rain(a), Self::Rain(b)) => (a / b - 1.0).abs() < 0.01,
            _ => self == other,
        }
    }
}

/// The light of a view's bow, kept as long as it holds.
#[derive(Component, Clone, Debug, Default)]
pub struct RainbowLight {
    settings: Option<Rainbow>,
    known: Option<(Drops, Arc<RainbowPhase>)>,
}

impl RainbowLight {
    /// The light by angle, once a bow has been shown.
    #[must_use]
    pub fn phase(&self) -> Option<&RainbowPhase> {
        self.known.as_ref().map(|(_, phase)| &**phase)
    }
}

/// Rainbows of all cameras with [`Rainbow`].
pub struct RainbowPlugin;

impl Plugin for RainbowPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<Rainbow>().add_systems(
            PostUpdate,
            aim_rainbows
                .in_set(RainViewSystems::Views)
                .after(aim_haze)
                .before(haze_mirrors),
        );
    }
}

fn aim_rainbows(
    report: Res<RainReport>,
    suns: Query<(&DirectionalLight, &InheritedVisibility)>,
    // Made for the first bow.
    mut tables: Local<Option<RainbowTables>>,
    mut errors: MessageWriter<RainConfigError>,
    mut views: Query<(
        Entity,
        Ref<Rainbow>,
        &mut RainbowLight,
        &Camera,
        Option<&mut HazeViewFrame>,
    )>,
) {
    if views.is_empty() {
        report.skipped(PassName::Rainbow, SkipReason::Disabled);
        return;
    }
    let sunny = suns.iter().any(|(sun, seen)| seen.get() && sun.illuminance > 0.0);
    for (entity, rainbow, mut light, camera, haze) in &mut views {
        let light = &mut *light;
        if rainbow.is_changed() || light.settings.is_none() {
            match rainbow.validated() {
                Ok(good) => light.settings = Some(good),
                Err(error) => {
                    errors.write(RainConfigError { entity, error });
                }
            }
        }
        let settings = light.settings.unwrap_or_default();
        let shot = haze.map(Mut::into_inner).and_then(|frame| frame.shot.as_mut());
        let skip = match shot {
            _ if !camera.is_active => Err(SkipReason::NoView),
            _ if settings.strength <= 0.0 => Err(SkipReason::Disabled),
            None => Err(SkipReason::NoHaze),
            Some(shot) if shot.heaviest.intensity_mm_h <= 0.0 => Err(SkipReason::NoRain),
            Some(_) if !sunny => Err(SkipReason::NoSun),
            Some(shot) => Ok(shot),
        };
        let shot = match skip {
            Ok(shot) => shot,
            Err(reason) => {
                report.skipped(PassName::Rainbow, reason);
                continue;
            }
        };
        let drops = settings
            .drop_radius_m
            .map_or(Drops::Rain(shot.heaviest.slope_per_mm), Drops::Radius);
        let phase = match &light.known {
            Some((known, phase)) if known.is_near(drops) => phase.clone(),
            _ => {
                let tables = tables.get_or_insert_with(RainbowTables::new);
                let phase = Arc::new(match drops {
                    Drops::Rain(_) => tables.of_rain(&shot.heaviest),
                    Drops::Radius(radius) => tables.of_radius(radius.into()),
                });
                light.known = Some((drops, phase.clone()));
                phase
            }
        };
        shot.bow = Some(BowShot {
            phase,
            strength: settings.strength,
        });
        report.recorded(PassName::Rainbow);
    }
}
