//! The cards that a marked camera draws this frame.

use std::sync::Arc;

use bevy::camera::Exposure;
use bevy::light::{EnvironmentMapLight, GlobalAmbientLight};
use bevy::math::DVec2;
use bevy::prelude::*;
use rain_core::rainfall::areas::AreaField;
use rain_core::rainfall::{
    CacheOutcome, Card, CardCounts, Distribution, LatticePlan, LatticeRates, LatticeView, PackedStreaks, StreakCache,
    StreakTextureSettings, quality_for_budget,
};
use rain_ecs::prelude::*;

use super::frame_budget::RainShare;
use super::lamps::ViewLamps;
use super::motion::ViewMotion;
use super::settings::CardSettings;
use super::view::{RainViewFrame, SoftwareAdapter, not_drawn, view_volume};
use crate::cover::AirAroundView;
use crate::report::{PassName, RainReport, SkipReason};

/// A view's cards at a moment.
#[derive(Clone, Debug)]
pub(crate) struct CardShot {
    /// From far to near; never empty.
    pub cards: Arc<Vec<Card>>,
    pub contrast: f32,
}

/// What a view draws of cards this frame; extracted to the render world.
#[derive(Component, Clone, Debug, Default)]
pub struct CardViewFrame {
    /// `None`: nothing.
    pub(crate) shot: Option<CardShot>,
    /// Kept from frame to frame so that nothing is allocated.
    spare: Vec<Arc<Vec<Card>>>,
}

impl CardViewFrame {
    /// Number of cards in this frame.
    #[must_use]
    pub fn cards(&self) -> usize {
        self.shot.as_ref().map_or(0, |shot| shot.cards.len())
    }

    /// Cards that nobody else holds.
    fn take_spare(&mut self) -> Arc<Vec<Card>> {
        let free = self.spare.iter().position(|cards| Arc::strong_count(cards) == 1);
        free.map(|i| self.spare.swap_remove(i)).unwrap_or_default()
    }

    fn keep(&mut self, cards: Arc<Vec<Card>>) {
        self.spare.push(cards);
        self.spare.truncate(3);
    }
}

/// The lattice in force, and pictures that came from a folder.
#[derive(Resource, Default)]
pub(crate) struct LatticeState {
    /// What it was made for.
    source: Option<(CardSettings, Distribution)>,
    plan: Option<LatticePlan>,
    /// Settings of the pictures; `None`: no cards.
    pub textures: Option<Arc<StreakTextureSettings>>,
    /// Pictures from a folder, for the GPU to take.
    pub pictures: Option<Arc<PackedStreaks>>,
}

impl LatticeState {
    /// Follows the settings. What does not validate is named in the log, and there are no cards.
    fn follow(&mut self, settings: &CardSettings, distribution: Distribution) {
        if let Some((known, of)) = &self.source
            && known == settings
            && *of == distribution
        {
            return;
        }
        let textures = StreakTextureSettings {
            distribution,
            ..settings.textures.clone()
        };
        let plan = LatticePlan::new(settings.lattice.clone(), &textures);
        (self.textures, self.pictures) = (None, None);
        match plan {
            Ok(plan) => {
                if let Some(folder) = &settings.cache {
                    self.pictures = from_folder(&StreakCache::new(folder), &textures);
                }
                self.textures = Some(Arc::new(textures));
                self.plan = Some(plan);
            }
            Err(error) => {
                error!("cards of rain: {error}");
                self.plan = None;
            }
        }
        self.source = Some((settings.clone(), distribution));
    }
}

/// The pictures of a folder, made and stored where it lacks them. The settings have been checked.
fn from_folder(cache: &StreakCache, settings: &StreakTextureSettings) -> Option<Arc<PackedStreaks>> {
    match cache.get(settings, PackedStreaks::bake) {
        Ok(got) => {
            if let CacheOutcome::Remade(why) = &got.outcome {
                warn!("{}: {why}; made anew", got.path.display());
            }
            if let Some(why) = &got.not_stored {
                warn!("{}: {why}", got.path.display());
            }
            Some(Arc::new(got.textures))
        }
        Err(error) => {
            error!("streak textures: {error}");
            None
        }
    }
}

pub(crate) fn fill_cards(
    clock: Res<RainClock>,
    field: Res<RainfallField>,
    seed: Res<RainSeed>,
    settings: Res<CardSettings>,
    mut lattice: ResMut<LatticeState>,
    (software, share): (Res<SoftwareAdapter>, Res<RainShare>),
    report: Res<RainReport>,
    air: Res<AirAroundView>,
    areas: Option<Res<RainAreas>>,
    ambient: Option<Res<GlobalAmbientLight>>,
    suns: Query<(), With<DirectionalLight>>,
    mut rates: Local<AreaField>,
    mut views: Query<(
        Entity,
        &Camera,
        &Projection,
        &GlobalTransform,
        &ViewMotion,
        &RainViewFrame,
        &ViewLamps,
        &mut CardViewFrame,
        Option<&Exposure>,
        Has<EnvironmentMapLight>,
    )>,
) {
    let since_tick = f64::from(clock.interpolation()) * clock.tick_ns() as f64 * 1e-9;
    let areas = areas.as_deref().filter(|areas| !areas.is_uniform());
    let local = areas.map(|areas| {
        areas.field_after(since_tick, &mut rates);
        areas.weather_mm_h()
    });
    let local = local.map(|weather_mm_h| LatticeRates {
        areas: &rates,
        weather_mm_h,
    });
    let mut any = false;
    for (entity, camera, projection, transform, motion, near, lamps, mut frame, exposure, mapped) in &mut views {
        any = true;
        if let Some(old) = frame.shot.take() {
            frame.keep(old.cards);
        }
        let view = near.settings();
        // The heaviest rain that the view's cards may be in.
        let spectrum = local.map_or(*field.spectrum(), |local| {
            let eye = transform.translation().as_dvec3();
            let reach = settings.lattice.far_m * 1.5;
            let place = DVec2::new(eye.x, eye.z);
            let rates = local.areas.rates_within(place, reach, local.weather_mm_h);
            field.spectrum_at(rates[1])
        });
        let raining = spectrum.intensity_mm_h > 0.0;
        let closed_in = air.closed_in == Some(entity);
        let supported = matches!(projection, Projection::Perspective(_));
        let mut skip = not_drawn(&view, camera, supported, raining, closed_in);
        if skip.is_none_or(|reason| reason == SkipReason::NoRain)
            && (!view.draws_cards(*software) || settings.lattice.max_cards == 0)
        {
            skip = Some(SkipReason::Disabled);
        }
        if skip.is_none() {
            lattice.follow(&settings, field.distribution());
        }
        let Some(plan) = lattice.plan.as_ref().filter(|_| skip.is_none()) else {
            // Settings that no lattice can be made of have been named.
            report.skipped(PassName::Lattice, skip.unwrap_or(SkipReason::Disabled));
            continue;
        };
        let size = camera.physical_viewport_size().unwrap_or_default();
        let clip_from_view = projection.get_clip_from_view();
        let volume = view_volume(clip_from_view, size, transform, motion, view.exposure_s);
        // Where no rain is near enough for single drops, their range is that of the rain ahead.
        let kappa = near.shutter.map_or_else(
            || quality_for_budget(&spectrum, &volume, f64::from(view.budget(*software, &share))),
            |shutter| f64::from(shutter.kappa),
        );
        let mut cards = frame.take_spare();
        // Which cards are dark is asked only where settings leave such out; under a sky none is.
        let skips = settings.lattice.min_light > 0.0;
        let exposure = exposure.copied().unwrap_or_default().exposure();
        let (lamps, lit) = if skips && !mapped && suns.is_empty() {
            let even = ambient.as_ref().map_or(0.0, |light| light.brightness * exposure);
            (lamps.seen_from(transform.translation(), exposure), even)
        } else {
            (Vec::new(), 1.0)
        };
        let seen = LatticeView {
            volume: &volume,
            spectrum: &spectrum,
            local,
            motion: &field.motion_after(since_tick),
            kappa,
            lamps: &lamps,
            ambient: Vec3::splat(lit),
            seed: seed.0,
            haze: None,
        };
        let counts = Arc::get_mut(&mut cards).map_or_else(CardCounts::default, |cards| plan.fill(&seen, cards));
        if counts.beyond_limit > 0 {
            warn_once!("a rain view has more cards than its lattice allows; the farthest are left out");
        }
        if cards.is_empty() {
            frame.keep(cards);
            report.skipped(PassName::Lattice, SkipReason::NoRain);
            continue;
        }
        frame.shot = Some(CardShot {
            cards,
            contrast: view.contrast,
        });
    }
    if !any {
        report.skipped(PassName::Lattice, SkipReason::NoView);
    }
}
