//! What a marked camera shows of haze this frame.

use std::sync::Arc;

use bevy::ecs::system::SystemParam;
use bevy::math::DVec2;
use bevy::prelude::*;
use rain_core::haze::{
    FOG_TABLE_KNOTS, FogFade, FogTable, RateExtinction, artist_fog_amount, extinction_per_m, mist_extinction_per_m,
};
use rain_core::optics::RainbowPhase;
use rain_core::rainfall::areas::{AreaField, AreaFieldF32};
use rain_core::rainfall::{DrawRange, FarEye, FarRainSettings, FarRainView, Lamp, Spectrum};
use rain_core::splash::MistLayers;
use rain_core::weather::relative_intensity;
use rain_ecs::prelude::*;
use rain_render::haze::{HazeFar, HazeFog};

use super::area_fog::{AreaFog, AreaFogs};
use super::far_rain::{FarRainViewFrame, half_view_rad};
use super::lamps::glowing;
use super::mirror::haze_mirrors;
use super::settings::{HazeSettings, HazeSky};
use super::splash_mist::KnownMist;
use crate::cover::AirAroundView;
use crate::held::keep_good;
use crate::rainfall::{
    CardViewFrame, RainView, RainViewFrame, SceneLamps, SoftwareAdapter, ViewMotion, fill_cards, view_volume,
};
use crate::render_adapter::let_depth_be_read;
use crate::report::{PassName, RainReport, SkipReason};
use crate::schedule::RainViewSystems;
use crate::surface::SurfaceState;

/// Less optical depth than this on the longest way is not seen: a quarter of an 8-bit step.
const NEGLIGIBLE_DEPTH: f64 = 1.0 / 1024.0;

/// Tables of what is drawn are made anew when the extinction or the quality has changed by this share.
const TABLE_STEP: f64 = 0.01;

/// An image that receives how much of each pixel haze obscures (R16Float, made with
/// [`mask_image`](crate::render_adapter::mask_image)). Put it on a camera with `RainView` and `Msaa::Off`.
#[derive(Component, Clone, Debug)]
pub struct HazeMask(pub Handle<Image>);

/// A view's haze at a moment.
#[derive(Clone, Debug)]
pub(crate) struct HazeShot {
    pub forward: Vec3,
    pub extinction_per_m: f32,
    pub efficiency: f32,
    pub drawn_m: [f32; FOG_TABLE_KNOTS],
    pub rates: Arc<RateExtinction>,
    /// Areas packed about the eye, and the weather's rate.
    pub areas: Option<(Arc<AreaFieldF32>, f32)>,
    /// What is drawn of it as far rain.
    pub far: Option<HazeFar>,
    pub cloud_m: f32,
    pub thin_m: f32,
    pub limit_m: f32,
    pub fog: Option<HazeFog>,
    pub lamps: Vec<Lamp>,
    /// The heaviest rain that counts.
    pub heaviest: Spectrum,
    pub mist_per_m: f32,
    /// Of a mirrored view: the mirror over its eye.
    pub mirror_m: Option<f32>,
    pub bow: Option<BowShot>,
    pub splash: Option<MistLayers>,
}

/// A view's rainbow.
#[derive(Clone, Debug)]
pub(crate) struct BowShot {
    pub phase: Arc<RainbowPhase>,
    pub strength: f32,
}

/// What a table of drawn rain is made from.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Source {
    spectrum: Spectrum,
    efficiency: f32,
    range: DrawRange,
    cards: bool,
}

impl Source {
    fn is_near(&self, other: &Self) -> bool {
        let near = |a: f64, b: f64| a == b || (a / b - 1.0).abs() < TABLE_STEP;
        near(self.spectrum.intensity_mm_h, other.spectrum.intensity_mm_h)
            && near(self.spectrum.slope_per_mm, other.spectrum.slope_per_mm)
            && near(self.range.kappa, other.range.kappa)
            && near(self.range.focal_px, other.range.focal_px)
            && near(self.range.exposure_s, other.range.exposure_s)
            && self.efficiency == other.efficiency
            && self.cards == other.cards
    }
}

/// What a view shows of haze this frame; extracted to the render world.
#[derive(Component, Clone, Debug, Default)]
pub struct HazeViewFrame {
    /// `None`: nothing.
    pub(crate) shot: Option<HazeShot>,
    /// Kept as long as they hold.
    table: Option<(Source, [f32; FOG_TABLE_KNOTS])>,
    rates: Option<(rain_core::rainfall::Distribution, f32, Arc<RateExtinction>)>,
    splash_mist: KnownMist,
    settings: HazeSettings,
    fade: FogFade,
    before_s: f64,
}

impl HazeViewFrame {
    /// Whether this frame draws haze.
    #[must_use]
    pub fn draws(&self) -> bool {
        self.shot.is_some()
    }

    fn drawn_m(&mut self, source: Option<Source>) -> [f32; FOG_TABLE_KNOTS] {
        let Some(source) = source else {
            return [0.0; FOG_TABLE_KNOTS];
        };
        if let Some((known, metres)) = &self.table
            && known.is_near(&source)
        {
            return *metres;
        }
        let table = FogTable::new(&source.spectrum, source.efficiency.into(), source.cards, |d| {
            source.range.at(d)
        });
        let metres = table.map_or([0.0; FOG_TABLE_KNOTS], |table| table.drawn_m());
        self.table = Some((source, metres));
        metres
    }

    fn rates(&mut self, field: &RainfallField, efficiency: f32) -> Arc<RateExtinction> {
        match &self.rates {
            Some((distribution, q, rates)) if *distribution == field.distribution() && *q == efficiency => {
                rates.clone()
            }
            _ => {
                let rates = Arc::new(RateExtinction::new(field.distribution(), efficiency.into()));
                self.rates = Some((field.distribution(), efficiency, rates.clone()));
                rates
            }
        }
    }
}

/// The weather's humidity.
#[derive(SystemParam)]
pub(crate) struct Humidity<'w, 's> {
    active: Res<'w, ActiveWeather>,
    weather: Query<'w, 's, &'static WeatherState>,
}

impl Humidity<'_, '_> {
    /// Units: none. 0 without a weather.
    fn now(&self) -> f64 {
        let state = self.active.entity().and_then(|entity| self.weather.get(entity).ok());
        state.map_or(0.0, |state| state.conditions().relative_humidity)
    }
}

/// Haze of rain in all [`RainView`]s.
pub struct HazePlugin;

impl Plugin for HazePlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<HazeSettings>()
            .register_type::<HazeSky>()
            .register_type::<AreaFog>()
            .init_resource::<AirAroundView>()
            .add_systems(
                PostUpdate,
                // After the containers, too: cards come after them.
                (aim_haze, haze_mirrors)
                    .chain()
                    .in_set(RainViewSystems::Views)
                    .after(fill_cards),
            );
        app.register_required_components::<RainView, HazeSettings>();
        app.register_required_components::<RainView, HazeViewFrame>();
        app.register_required_components::<RainView, FarRainViewFrame>();
    }
}

pub(crate) fn aim_haze(
    clock: Res<RainClock>,
    field: Res<RainfallField>,
    report: Res<RainReport>,
    air: Res<AirAroundView>,
    (seed, software): (Res<RainSeed>, Res<SoftwareAdapter>),
    areas: Option<Res<RainAreas>>,
    mut local: Local<AreaField>,
    mut errors: MessageWriter<RainConfigError>,
    mut fogs: AreaFogs,
    humidity: Humidity,
    surface: Option<Res<SurfaceState>>,
    lights: SceneLamps,
    mut views: Query<(
        (Entity, &RainView, Ref<HazeSettings>, Option<&CardViewFrame>),
        &Camera,
        &mut Camera3d,
        &Projection,
        &GlobalTransform,
        (&RainViewFrame, &ViewMotion),
        &mut HazeViewFrame,
        &mut FarRainViewFrame,
    )>,
) {
    errors.write_batch(fogs.faults(areas.as_deref()));
    let since_tick = f64::from(clock.interpolation()) * clock.tick_ns() as f64 * 1e-9;
    let now = clock.now_s() + since_tick;
    let areas = areas.as_deref().filter(|areas| !areas.is_uniform());
    if let Some(areas) = areas {
        areas.field_after(since_tick, &mut local);
    }
    let mut any = false;
    for (
        (entity, view, settings, cards),
        camera,
        mut camera_3d,
        projection,
        transform,
        (rain, motion),
        mut frame,
        mut far_frame,
    ) in &mut views
    {
        any = true;
        let frame = &mut *frame;
        frame.shot = None;
        far_frame.clear();
        if settings.is_changed() {
            keep_good(settings.validated(), &mut frame.settings, entity, &mut errors);
        }
        let settings = frame.settings;
        let eye = transform.translation();
        let limit = f64::from(settings.limit_m);
        let place = DVec2::new(eye.x.into(), eye.z.into());
        // The heaviest rain on any way that counts, and that at the eye.
        let (heaviest, here) = areas.map_or((*field.spectrum(), *field.spectrum()), |areas| {
            let weather = areas.weather_mm_h();
            (
                field.spectrum_at(local.rates_within(place, limit, weather)[1]),
                field.spectrum_at(local.rate_at(place, weather)),
            )
        });
        let q = f64::from(settings.efficiency);
        let size = camera.physical_viewport_size().unwrap_or_default();
        let dt = now - std::mem::replace(&mut frame.before_s, now);
        let amount = artist_fog_amount(relative_intensity(here.intensity_mm_h));
        let fog = fogs.at(settings.artist.as_ref(), areas, place, now, amount);
        if let Some(fog) = &fog {
            frame.fade.advance(here.intensity_mm_h > 0.0, dt, fog.transition_s);
        }
        let mist = settings.mist.map_or(0.0, |mist| {
            mist_extinction_per_m(humidity.now(), mist.dry_per_m.into(), mist.hygroscopicity.into())
        });
        // The haze of the heaviest rain, and what is in its place.
        let own = extinction_per_m(&heaviest, q) + mist;
        let densest = fog.as_ref().map_or(own, |mix| {
            let own = if mix.fog.share < 1.0 { own } else { 0.0 };
            own.max(mix.fog.density_per_m.into())
        });
        let skip = if !camera.is_active || size.x == 0 || size.y == 0 {
            Some(SkipReason::NoView)
        } else if !view.enabled || !settings.enabled {
            Some(SkipReason::Disabled)
        } else if heaviest.intensity_mm_h <= 0.0 && mist <= 0.0 && fog.is_none() {
            Some(SkipReason::NoRain)
        } else if !matches!(projection, Projection::Perspective(_)) {
            Some(SkipReason::Unsupported)
        } else if air.closed_in == Some(entity) {
            Some(SkipReason::Indoors)
        } else if densest * limit < NEGLIGIBLE_DEPTH {
            Some(SkipReason::Negligible)
        } else {
            None
        };
        if let Some(reason) = skip {
            report.skipped(PassName::Haze, reason);
            report.skipped(PassName::FarRain, reason);
            continue;
        }
        let_depth_be_read(&mut camera_3d);
        // Shares of what is drawn are those of the heaviest rain that the drops may be in, as their quality is.
        let source = rain.shutter.filter(|_| rain.draws()).map(|shutter| Source {
            spectrum: areas.map_or(here, |areas| {
                let reach = f64::from(rain_core::haze::FOG_TABLE_END_M as f32);
                field.spectrum_at(local.rates_within(place, reach, areas.weather_mm_h())[1])
            }),
            efficiency: settings.efficiency,
            range: DrawRange {
                kappa: shutter.kappa.into(),
                focal_px: rain.focal_px(),
                exposure_s: shutter.exposure_s.into(),
            },
            cards: cards.is_some_and(|frame| frame.cards() > 0),
        });
        let packed = areas.map(|areas| {
            let mut packed = AreaFieldF32::default();
            if !local.pack(place, limit, &mut packed) {
                warn_once!("more rain areas than the haze holds; the last are left out");
            }
            (Arc::new(packed), areas.weather_mm_h() as f32)
        });
        let rates = frame.rates(&field, settings.efficiency);
        let cloud_m = settings.cloud_base_m - eye.y;
        let thin_m = settings.cloud_softness * cloud_m.max(0.0);
        // What particles show is taken off the physical haze alone.
        let physical = 1.0 - fog.as_ref().map_or(0.0, |mix| f64::from(mix.fog.share));
        let far_rain = FarRainSettings {
            share: settings.far_rain.share * physical.max(0.0),
            ..settings.far_rain
        };
        let far = if !view.draws_far_rain(*software) {
            Err(SkipReason::Disabled)
        } else if let Some(areas) = areas {
            let clip_from_view = projection.get_clip_from_view();
            far_frame.fill(
                &far_rain,
                &FarRainView {
                    eye: FarEye {
                        eye_m: eye.as_dvec3(),
                        areas: &local,
                        weather_mm_h: areas.weather_mm_h(),
                        rates: &rates,
                    },
                    volume: &view_volume(clip_from_view, size, transform, motion, view.exposure_s),
                    forward: transform.forward().as_dvec3(),
                    half_view_rad: half_view_rad(clip_from_view, transform.rotation()),
                    motion: &field.motion_after(since_tick),
                    seed: seed.0,
                    cloud_m: cloud_m.into(),
                    thin_m: thin_m.into(),
                    limit_m: limit,
                },
            )
        } else {
            Err(SkipReason::NoRain)
        };
        let far = match far {
            Ok(rain) => Some(HazeFar {
                share: rain.share as f32,
                outside_per_m: rain.account.outside_per_m() as f32,
            }),
            Err(reason) => {
                report.skipped(PassName::FarRain, reason);
                None
            }
        };
        let film_mm = surface.as_ref().map_or(0.0, |surface| f64::from(surface.state.y));
        let splash = settings.splash_mist.and_then(|mist| {
            let rate = here.intensity_mm_h;
            frame
                .splash_mist
                .layers(&mist, &field, rate, film_mm, settings.efficiency)
        });
        frame.shot = Some(HazeShot {
            forward: transform.forward().into(),
            extinction_per_m: extinction_per_m(&here, q) as f32,
            efficiency: settings.efficiency,
            drawn_m: frame.drawn_m(source),
            rates,
            areas: packed,
            far,
            cloud_m,
            thin_m,
            limit_m: settings.limit_m,
            fog: fog.map(|mix| HazeFog {
                desaturation: mix.fog.desaturation * frame.fade.share() as f32,
                ..mix.fog
            }),
            lamps: glowing(&lights, eye, settings.lamps as usize, settings.glow),
            heaviest,
            mist_per_m: mist as f32,
            mirror_m: None,
            bow: None,
            splash,
        });
    }
    if !any {
        report.skipped(PassName::Haze, SkipReason::NoView);
        report.skipped(PassName::FarRain, SkipReason::NoView);
    }
}
