//! The ground and its water, built from the scene and advanced with the weather.

use bevy_ecs::prelude::*;
use rain_core::surface::ground::{Ground, GroundError, GroundLedger, UnevenRain};
use rain_core::weather::ColumnForcing;

use super::scene::{SurfaceScene, SurfaceSettings};
use crate::clock::RainClock;
use crate::cover::CoverField;
use crate::rainfall::areas::RainAreas;
use crate::state_hash::{HashState, StateHasher};
use crate::weather::{ActiveWeather, WeatherState};

/// The wet ground of the world, once it is built.
#[derive(Resource, Debug, Default)]
pub struct SurfaceGround {
    pub(super) ground: Option<Ground>,
    error: Option<GroundError>,
    /// What it was built from.
    built: Option<(u64, SurfaceSettings)>,
    /// Version of the scene seen last, and for how many ticks.
    seen: (u64, u64),
    rebuilds: u64,
    /// Next cell whose exposure is to be asked for; none when all are known.
    pub(super) cursor: Option<usize>,
    cover_version: Option<u64>,
    /// The cover has changed since the cursor started.
    pub(super) again: bool,
}

impl SurfaceGround {
    /// The ground.
    #[must_use]
    pub fn ground(&self) -> Option<&Ground> {
        self.ground.as_ref()
    }

    /// The ground, for wheels, feet and water from elsewhere.
    #[must_use]
    pub fn ground_mut(&mut self) -> Option<&mut Ground> {
        self.ground.as_mut()
    }

    /// Why the ground was not built when it was last tried. The old one goes on.
    #[must_use]
    pub fn error(&self) -> Option<&GroundError> {
        self.error.as_ref()
    }

    /// Where all water came from and went to; nothing without a ground. Sums over all cells: not for every tick.
    #[must_use]
    pub fn ledger(&self) -> GroundLedger {
        self.ground.as_ref().map_or_else(GroundLedger::default, Ground::ledger)
    }

    /// Counts builds.
    #[must_use]
    pub fn rebuilds(&self) -> u64 {
        self.rebuilds
    }

    /// Whether the exposure of every cell is that of the present cover.
    #[must_use]
    pub fn is_exposure_known(&self) -> bool {
        self.cursor.is_none() && !self.again
    }

    /// Puts in a ground that was built from this scene with these settings.
    pub(super) fn put(&mut self, ground: Ground, scene: u64, settings: SurfaceSettings) {
        self.ground = Some(ground);
        self.error = None;
        self.built = Some((scene, settings));
        self.rebuilds += 1;
        self.cursor = Some(0);
    }

    /// The exposure that it has belongs to this version of the cover.
    pub(super) fn sees_cover(&mut self, version: Option<u64>) {
        self.cover_version = version;
    }

    /// Whether it was built from this scene with these settings.
    pub(super) fn is_built_from(&self, scene: &SurfaceScene, settings: &SurfaceSettings) -> bool {
        self.ground.is_some()
            && self
                .built
                .as_ref()
                .is_some_and(|(version, old)| *version == scene.scene().version() && old == settings)
    }
}

impl HashState for SurfaceGround {
    fn hash_state(&self, hasher: &mut StateHasher) {
        if let Some(ground) = &self.ground {
            ground.for_each_state_bits(|bits| hasher.u64(bits));
        }
        hasher.u64(self.cursor.map_or(u64::MAX, |cell| cell as u64));
        hasher.u64(u64::from(self.again));
    }
}

/// Builds the ground when the static scene has settled, or when asked to; water is taken over by position.
pub(super) fn rebuild(
    clock: Res<RainClock>,
    settings: Res<SurfaceSettings>,
    mut scene: ResMut<SurfaceScene>,
    mut surface: ResMut<SurfaceGround>,
) {
    let surface = surface.bypass_change_detection();
    let scene = scene.bypass_change_detection();
    if !settings.enabled {
        if surface.ground.take().is_some() {
            (surface.built, surface.cursor, surface.again) = (None, None, false);
        }
        return;
    }
    let version = scene.scene().version();
    let ticks = clock.current_tick_ns() / clock.tick_ns();
    let waited = if surface.seen.0 == version {
        surface.seen.1 + ticks
    } else {
        0
    };
    surface.seen = (version, waited);
    let asked = std::mem::take(&mut scene.requested);
    let known = surface
        .built
        .as_ref()
        .is_some_and(|(v, s)| *v == version && s == &*settings);
    let settled = waited >= u64::from(settings.settle_ticks) && !scene.scene().is_empty();
    if !asked && (known || !settled) {
        return;
    }
    let tick_s = clock.tick_ns() as f64 / 1e9;
    let built = Ground::build(scene.scene(), &settings.ground(tick_s)).and_then(|mut new| {
        if let Some(old) = &surface.ground {
            new.take_over(old)?;
        }
        Ok(new)
    });
    match built {
        Ok(ground) => surface.put(ground, version, settings.clone()),
        Err(error) => {
            // Not tried again before something changes.
            surface.built = Some((version, settings.clone()));
            surface.error = Some(error);
        }
    }
}

/// Asks the cover for the exposure of some cells, until all are known.
pub(super) fn refresh_exposure(
    settings: Res<SurfaceSettings>,
    cover: Option<Res<CoverField>>,
    mut surface: ResMut<SurfaceGround>,
) {
    let Some(cover) = cover else { return };
    let surface = surface.bypass_change_detection();
    if surface.cover_version != Some(cover.version()) {
        surface.again |= surface.cover_version.is_some() || cover.version() > 0;
        surface.cover_version = Some(cover.version());
    }
    let Some(ground) = &mut surface.ground else { return };
    if surface.again && surface.cursor.is_none() {
        (surface.cursor, surface.again) = (Some(0), false);
    }
    let Some(first) = surface.cursor else { return };
    if first == 0 {
        // This pass starts with the present cover.
        surface.again = false;
    }
    let count = settings.exposure_cells_per_tick.max(1);
    // Shares of the cover field are in their domain.
    let _ = ground.refresh_exposure(cover.scene(), cover.shares(), first, count);
    let next = first.saturating_add(count);
    surface.cursor = (next < ground.exposure().len()).then_some(next);
}

/// Lets the weather act on the ground.
pub(super) fn advance(
    clock: Res<RainClock>,
    active: Res<ActiveWeather>,
    weather: Query<&WeatherState>,
    areas: Option<Res<RainAreas>>,
    mut surface: ResMut<SurfaceGround>,
) {
    let Some(state) = active.entity().and_then(|entity| weather.get(entity).ok()) else {
        return;
    };
    let surface = surface.bypass_change_detection();
    let Some(ground) = &mut surface.ground else { return };
    let areas = areas.as_deref().filter(|areas| !areas.is_uniform());
    let forcing = ColumnForcing {
        rain_mm_h: areas.map_or(state.conditions().intensity_mm_h, RainAreas::highest_mm_h),
        evaporation_mm_h: state.evaporation_mm_h().max(0.0),
    };
    let steps = u32::try_from(clock.current_tick_ns() / clock.tick_ns()).unwrap_or(u32::MAX);
    let mut local = areas.and_then(RainAreas::under);
    let local = local.as_mut().map(|local| local as &mut dyn UnevenRain);
    let done = ground.advance_under(&forcing, clock.current_tick_s(), steps, local);
    // The weather has been validated before it became state.
    debug_assert!(done.is_ok(), "{done:?}");
}
