//! What a marked camera draws of splashes this frame.

use std::sync::Arc;

use bevy::prelude::*;
use rain_core::error::{ConfigError, in_range};
use rain_core::rainfall::Spectrum;
use rain_core::splash::{SplashAnchor, SplashExtent, SplashField, SplashShares};
use rain_ecs::prelude::*;
use rain_ecs::splash::FootSystems;
use rain_render::splash::{SpoutStream, StepSplash};

use super::aim::SplashAim;
use super::feet::{RecentSteps, frame_time_s, keep_steps};
use super::spouts::{Pouring, SPOUT_REACH_M, in_air};
use crate::cover::{AirAroundView, CoverMap};
use crate::rainfall::{RainShare, RainView, SoftwareAdapter, ViewMotion, choose_drops, seen_place, view_volume};
use crate::report::{PassName, RainReport, SkipReason};
use crate::schedule::RainViewSystems;
use crate::surface::SurfaceState;

/// Largest accepted number of crowns and drops in a view.
pub const MAX_SPLASH_BUDGET: u32 = 1_000_000;

/// Furthest accepted reach of splashes. Units: m.
pub const MAX_SPLASH_DISTANCE_M: f32 = 50.0;

/// Tables are made anew when the film has grown or shrunk by this. Units: mm.
const FILM_STEP_MM: f64 = 0.02;

/// How splashes of rain are drawn, in every view. Contrast, shutter and soft fade are those of each view's [`RainView`].
#[derive(Resource, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Resource, Default)]
pub struct SplashSettings {
    /// Draws splashes. Views whose [`RainView`] is off or has a streak budget of 0 draw none in any case.
    pub enabled: bool,
    /// How many crowns and thrown drops a view draws, about; twice as many is the hard bound. `None`: 4,000 on a software
    /// adapter, 40,000 on a GPU. Domain: [0, 10⁶]. The number is spent on the largest splashes; those that are drawn
    /// show the light of those that are not.
    pub budget: Option<u32>,
    /// Crowns are drawn to here, fading over the last third. Units: m. Domain: [0, 50]. Default: 14. An orthographic picture counts as
    /// far away as a lens of 45° would stand: 1.2 times its height.
    pub distance_m: f32,
    /// Thrown drops are drawn to here; further away they are less than a step of contrast. Units: m. Domain: [0, 50].
    /// Default: 3.5.
    pub drops_distance_m: f32,
}

impl Default for SplashSettings {
    fn default() -> Self {
        Self {
            enabled: true,
            budget: None,
            distance_m: 14.0,
            drops_distance_m: 3.5,
        }
    }
}

impl SplashSettings {
    /// These settings, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not finite or outside its domain.
    pub fn validated(self) -> Result<Self, ConfigError> {
        let furthest = f64::from(MAX_SPLASH_DISTANCE_M);
        in_range("distance_m", self.distance_m.into(), 0.0, furthest, "0 to 50 m")?;
        in_range(
            "drops_distance_m",
            self.drops_distance_m.into(),
            0.0,
            furthest,
            "0 to 50 m",
        )?;
        let budget = f64::from(self.budget.unwrap_or_default());
        in_range("budget", budget, 0.0, f64::from(MAX_SPLASH_BUDGET), "0 to 1000000")?;
        Ok(self)
    }
}

/// An image that receives how much of each pixel splashes cover (R16Float, made with
/// [`mask_image`](crate::render_adapter::mask_image)). Put it on a camera with [`RainView`] and `Msaa::Off`. The mask of
/// streaks, `RainMasks::rain`, holds no splashes: it measures the optical depth of the rain in the air.
#[derive(Component, Clone, Debug)]
pub struct SplashMask(pub Handle<Image>);

/// A view's splashes at a moment.
#[derive(Clone, Debug)]
pub(crate) struct SplashShot {
    pub field: Arc<SplashField>,
    pub anchor: SplashAnchor,
    pub aim: SplashAim,
    pub wind_m_s: Vec3,
    pub exposure_s: f32,
    pub contrast: f32,
    pub soft_m: f32,
    pub capacity: u32,
    /// Steps in water; places in the world.
    pub steps: Vec<StepSplash>,
    /// Mouths that water pours from; places in the world.
    pub mouths: Vec<SpoutStream>,
    pub mouth_reach_m: f32,
    pub motion: ViewMotion,
}

/// Crowns and drops for which there is room for each mouth of a spout: what falls of it, and splashes of what has landed.
const MOUTH_PARTS: u32 = 64;

/// What tables of splashes are made from.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Source {
    seed: u64,
    spectrum: Spectrum,
    extent: SplashExtent,
    budget: u32,
}

/// What a view draws of splashes this frame; extracted to the render world.
#[derive(Component, Clone, Debug, Default)]
pub struct SplashViewFrame {
    /// `None`: nothing.
    pub(crate) shot: Option<SplashShot>,
    /// Kept as long as they hold.
    tables: Option<(Source, Arc<SplashField>)>,
}

impl SplashViewFrame {
    /// Whether this frame draws splashes.
    #[must_use]
    pub fn draws(&self) -> bool {
        self.shot.is_some()
    }

    /// Tables of the rain.
    fn field(&mut self, source: &Source) -> Arc<SplashField> {
        match &self.tables {
            Some((known, field)) if known == source => field.clone(),
            _ => {
                let shares = SplashShares::for_budget(&source.spectrum, &source.extent, f64::from(source.budget));
                let field = Arc::new(SplashField::new(source.seed, &source.spectrum, &shares));
                self.tables = Some((*source, field.clone()));
                field
            }
        }
    }
}

/// Splashes of rain in all [`RainView`]s, of whoever steps in water ([`FootSplash`]), and water that pours from roofs
/// ([`Spout`]).
pub struct SplashPlugin;

impl Plugin for SplashPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<SplashSettings>()
            .init_resource::<SplashSettings>()
            .init_resource::<SoftwareAdapter>()
            .init_resource::<RainShare>()
            .init_resource::<AirAroundView>()
            .init_resource::<RecentSteps>()
            .add_message::<FootSplash>()
            .add_systems(
                PostUpdate,
                (keep_steps.after(FootSystems), aim_splashes.after(choose_drops))
                    .chain()
                    .in_set(RainViewSystems::Views),
            );
        app.register_required_components::<RainView, SplashViewFrame>();
    }
}

/// The last good settings; what is wrong is named in the log once.
fn good_settings(settings: &Res<SplashSettings>, kept: &mut Option<SplashSettings>) -> SplashSettings {
    if kept.is_none() || settings.is_changed() {
        match settings.validated() {
            Ok(good) => *kept = Some(good),
            Err(error) => error!("splashes: {error}"),
        }
    }
    kept.unwrap_or_default()
}

fn aim_splashes(
    clock: Res<RainClock>,
    field: Res<RainfallField>,
    seed: Res<RainSeed>,
    settings: Res<SplashSettings>,
    mut kept: Local<Option<SplashSettings>>,
    (software, share): (Res<SoftwareAdapter>, Res<RainShare>),
    report: Res<RainReport>,
    air: Res<AirAroundView>,
    cover: Option<Res<CoverMap>>,
    surface: Option<Res<SurfaceState>>,
    areas: Option<Res<RainAreas>>,
    recent: Res<RecentSteps>,
    ground: Option<Res<SurfaceGround>>,
    spouts: Query<(Entity, &SpoutWater, &GlobalTransform), Without<RainView>>,
    mut views: Query<(
        Entity,
        &RainView,
        &Camera,
        &Projection,
        &GlobalTransform,
        &ViewMotion,
        &mut SplashViewFrame,
    )>,
) {
    let settings = good_settings(&settings, &mut kept);
    let now = frame_time_s(&clock);
    let steps = recent.shown(now);
    // In steps, so that tables last while the film grows; downwards, so that nothing that splashes is left out.
    let film_mm = surface.map_or(0.0, |s| (f64::from(s.state.y) / FILM_STEP_MM).floor() * FILM_STEP_MM);
    let areas = areas.as_deref().filter(|areas| !areas.is_uniform());
    let pouring = Pouring {
        since_tick_s: f64::from(clock.interpolation()) * clock.tick_ns() as f64 * 1e-9,
        wind_m_s: field.wind_m_s(),
        ground: ground.as_ref().and_then(|ground| ground.ground()),
        seed: seed.0,
    };
    let mut flowing: Vec<_> = spouts.iter().filter(|(_, water, _)| water.flow_m3_s() > 0.0).collect();
    flowing.sort_unstable_by_key(|(entity, ..)| *entity);
    let mut any = false;
    for (entity, view, camera, projection, transform, motion, mut frame) in &mut views {
        any = true;
        frame.shot = None;
        // A bad `RainView` has been named; the defaults stand in for it.
        let view = view.validated().unwrap_or_default();
        let size = camera.physical_viewport_size().unwrap_or_default();
        let from = seen_place(projection, transform, view.focus_m);
        // Under areas the rain at the eye, in steps of 2 %: splashes are drawn near it.
        let spectrum = areas.map_or(*field.spectrum(), |areas| {
            let rate = areas.rate_at(from.as_dvec3());
            field.spectrum_at(if rate > 0.0 {
                libm::exp(libm::round(50.0 * libm::log(rate)) / 50.0)
            } else {
                0.0
            })
        });
        let mut mouths = Vec::new();
        if settings.enabled && settings.budget != Some(0) {
            for spout in &flowing {
                pouring.add(from, *spout, &mut mouths);
            }
        }
        let alone = steps.is_empty() && mouths.is_empty();
        let mapped = cover.as_ref().is_some_and(|cover| cover.placement.is_some());
        let skip = if !camera.is_active || size.x == 0 || size.y == 0 {
            Some(SkipReason::NoView)
        } else if !view.enabled
            || view.streak_budget == Some(0)
            || !settings.enabled
            || settings.budget == Some(0)
            || settings.distance_m <= 0.0
        {
            Some(SkipReason::Disabled)
        } else if spectrum.intensity_mm_h <= 0.0 && alone {
            Some(SkipReason::NoRain)
        } else if !matches!(projection, Projection::Perspective(_) | Projection::Orthographic(_)) {
            Some(SkipReason::Unsupported)
        } else if air.closed_in == Some(entity) {
            Some(SkipReason::Indoors)
        } else if alone && !mapped {
            Some(SkipReason::NoGround)
        } else {
            None
        };
        if let Some(reason) = skip {
            report.skipped(PassName::Splash, reason);
            continue;
        }
        let clip_from_view = projection.get_clip_from_view();
        let aim = if matches!(projection, Projection::Orthographic(_)) {
            SplashAim::parallel(from, clip_from_view, size.y, transform, &settings)
        } else {
            let volume = view_volume(clip_from_view, size, transform, motion, view.exposure_s);
            SplashAim::perspective(
                from,
                volume.side_planes,
                volume.focal_px as f32,
                clip_from_view,
                &settings,
            )
        };
        if alone && aim.shares[0] <= 0.0 {
            report.skipped(PassName::Splash, SkipReason::Negligible);
            continue;
        }
        let budget = share.of(settings.budget.unwrap_or(if software.0 { 4_000 } else { 40_000 }));
        // Where there are steps and spouts alone, no ground is looked through for impacts.
        let impacts = mapped && spectrum.intensity_mm_h > 0.0;
        let aim = SplashAim {
            reach_m: if impacts { aim.reach_m } else { [0.0; 2] },
            ..aim
        };
        let [reach_m, near_m] = aim.reach_m;
        let source = Source {
            seed: seed.0,
            spectrum,
            extent: SplashExtent {
                reach_m: reach_m.into(),
                near_m: near_m.into(),
                angle_rad: aim.angle_rad,
                exposure_s: view.exposure_s.into(),
                film_mm,
            },
            budget,
        };
        let tables = frame.field(&source);
        if !mouths.is_empty() {
            report.drips(in_air(&mouths));
        }
        frame.shot = Some(SplashShot {
            field: tables,
            anchor: SplashAnchor::new(from.as_dvec3(), now),
            aim,
            wind_m_s: field.wind_m_s().as_vec3(),
            exposure_s: view.exposure_s,
            contrast: view.contrast,
            soft_m: view.soft_m,
            // The budget is a mean.
            capacity: 2 * budget + 1024 + MOUTH_PARTS * mouths.len() as u32,
            steps: steps.clone(),
            mouths,
            mouth_reach_m: SPOUT_REACH_M,
            motion: *motion,
        });
    }
    if !any {
        report.skipped(PassName::Splash, SkipReason::NoView);
    }
}
