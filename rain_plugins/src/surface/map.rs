//! The water map around the view: the ground's films and pores, finer, with tracks and the edges of what covers now.

use bevy::math::DVec2;
use bevy::prelude::*;
use rain_core::rainfall::areas::{AreaField, AreaFieldF32};
use rain_core::surface::ground::Ground;
use rain_core::weather::ColumnRules;
use rain_ecs::prelude::*;
use rain_render::water_map::{
    GroundCell, GroundPlace, WaterMap, WaterMapFrame, WaterMapRest, WaterMapSettings, WaterPress,
};

use super::ground::LevelsFromGround;
use super::state::SurfaceState;
use super::water::WaterLevels;
use crate::rainfall::{RainView, ViewPlace, ViewPlaceItem, leading_view};
use crate::report::{PassName, RainReport, SkipReason};

/// Unseen for longer than this while it rained: what happened meanwhile is the ground's to tell. Units: ns.
const UNSEEN_NS: u64 = 10_000_000_000;

/// Settings of the water map. Changes take effect when the app starts.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub struct GroundMapSettings {
    /// Whether there is a map; else the picture shows the ground's own cells. Default: true.
    pub enabled: bool,
    /// Its size and steps.
    pub map: WaterMapSettings,
}

impl Default for GroundMapSettings {
    fn default() -> Self {
        Self {
            enabled: true,
            map: WaterMapSettings::default(),
        }
    }
}

/// A frame's work for the GPU, taken by the render world.
#[derive(Debug, Default)]
pub(crate) struct MapHandover {
    pub frame: WaterMapFrame,
    pub wanted: bool,
}

/// The water map amid all active views if they fit, else around the leading one. It shows what the simulation's ground
/// knows and adds what is only seen: it is no state, starts anew from the ground where the view comes to, and after a
/// rewind or a restored snapshot.
#[derive(Resource, Debug)]
pub struct GroundMap {
    map: WaterMap,
    settings: WaterMapSettings,
    /// Build, first cell and number of cells that it knows, and whether all their exposure was known.
    ground: Option<(u64, UVec2, UVec2, bool)>,
    /// Time and fallen rain (mm) that it has seen, and whose rain that is.
    seen: Option<(u64, f64, Entity)>,
    pub(crate) handover: MapHandover,
    /// The rain areas around the view; their memory is used again.
    areas: (AreaField, AreaFieldF32),
}

impl GroundMap {
    /// The map.
    #[must_use]
    pub fn map(&self) -> &WaterMap {
        &self.map
    }

    /// The GPU has lost all.
    pub(crate) fn lose(&mut self) {
        self.map.forget();
        self.handover.wanted = false;
    }
}

pub(super) fn create_map(mut commands: Commands, settings: Res<GroundMapSettings>) {
    if !settings.enabled {
        return;
    }
    match WaterMap::new(&settings.map) {
        Ok(map) => commands.insert_resource(GroundMap {
            map,
            settings: settings.map,
            ground: None,
            seen: None,
            handover: MapHandover::default(),
            areas: Default::default(),
        }),
        Err(error) => error!("no water map: {error}"),
    }
}

/// The ground's cells as the map takes them, of the window that the levels show.
fn cells(ground: &Ground, first: UVec2, levels: &WaterLevels) -> impl ExactSizeIterator<Item = GroundCell> {
    let columns = ground.frame().cells()[0];
    let (width, count) = (levels.cells.x as usize, levels.cells.element_product() as usize);
    (0..count).map(move |i| {
        let cell = (first.y as usize + i / width) * columns + first.x as usize + i % width;
        GroundCell {
            height_m: ground.ground_heights()[cell],
            class: ground.classes()[cell],
            exposure: ground.exposure()[cell],
        }
    })
}

/// Follows the view, the weather, the ground and what presses its films.
pub(super) fn follow_map(
    mut map: ResMut<GroundMap>,
    clock: Res<RainClock>,
    levels: Res<WaterLevels>,
    shown: Res<LevelsFromGround>,
    surface: Res<SurfaceState>,
    report: Res<RainReport>,
    ground: Option<Res<SurfaceGround>>,
    active: Res<ActiveWeather>,
    weather: Query<&WeatherState>,
    areas: Option<Res<RainAreas>>,
    mut presses: Option<ResMut<FilmPresses>>,
    views: Query<(Entity, &Camera, ViewPlace), With<RainView>>,
    mut eyes: Local<Vec<[f64; 2]>>,
) {
    let this = map.bypass_change_detection();
    this.handover.wanted = false;
    // Unseen or not: what has been pressed since the texels were filled is theirs, too.
    for pressed in presses.iter_mut().flat_map(|p| p.bypass_change_detection().take()) {
        let press = WaterPress {
            from_m: pressed.way_m[0].to_array(),
            to_m: pressed.way_m[1].to_array(),
            half_width_m: pressed.half_width_m,
            share: pressed.share,
            thrown: 0.0,
        };
        // What the ground took the map takes.
        let _ = this.map.press(&press);
    }
    let skip = |reason| report.skipped(PassName::WaterMap, reason);
    let place = |view: ViewPlaceItem| [view.place().x, view.place().z].map(f64::from);
    let Some(leading) = leading_view(views).map(place) else {
        skip(SkipReason::NoView);
        return;
    };
    let state = active
        .entity()
        .and_then(|entity| Some((entity, weather.get(entity).ok()?)));
    let known = ground.as_ref().and_then(|g| Some((g, g.ground()?, shown.window()?)));
    let (Some((entity, state)), Some((source, ground, (builds, first)))) = (state, known) else {
        this.map.take_ground_away();
        (this.ground, this.seen) = (None, None);
        skip(SkipReason::NoGround);
        return;
    };
    if surface.artist.w > 0.5 || surface.by_hand.is_set() {
        // The artists' way has levels of its own, and what is set by hand leaves no trace.
        this.map.forget();
        this.seen = None;
        skip(SkipReason::Disabled);
        return;
    }
    let now = (clock.now_ns(), state.rain_mm(), entity);
    let (before_ns, before_mm, before) = this.seen.replace(now).unwrap_or(now);
    let time_s = now.0.saturating_sub(before_ns) as f64 * 1e-9;
    let areas = areas.as_deref().filter(|areas| !areas.is_uniform());
    // Half a diagonal of the coarsest level, and what it may lie off the eye.
    let settings = &this.settings;
    let reach = f64::from(settings.texels) * settings.level_cell_m(settings.levels as usize - 1);
    // The heaviest rain on the map, in the middle of the time that has passed.
    let heaviest = areas.map(|areas| {
        areas.field_after(-0.5 * time_s, &mut this.areas.0);
        this.areas.0.rates_within(leading.into(), reach, areas.weather_mm_h())[1]
    });
    let rain_mm = match heaviest {
        Some(rate) => rate * time_s / 3600.0,
        None if entity == before => now.1 - before_mm,
        // Each weather counts its own rain.
        None => 0.0,
    };
    let unseen = now.0.saturating_sub(before_ns) > UNSEEN_NS && rain_mm > 0.0;
    if now.0 < before_ns || rain_mm < 0.0 || unseen || entity != before {
        this.map.forget();
    }
    let ground_now = (builds, first, levels.cells, source.is_exposure_known());
    // While the exposure is being asked for anew, the old one holds.
    let cells_hold = this
        .ground
        .is_some_and(|(b, f, c, known)| (b, f, c) == (builds, first, levels.cells) && (known || !ground_now.3));
    if !cells_hold {
        let place = GroundPlace {
            build: builds,
            corner_m: levels.corner_m.to_array(),
            cell_m: levels.cell_m,
            cells: levels.cells.to_array(),
            base_m: levels.base_m,
            rules: SurfaceClass::ALL.map(|class| ColumnRules::from(ground.properties(class))),
        };
        if let Err(error) = this.map.set_ground(&place, cells(ground, first, &levels)) {
            error!("no water map: {error}");
            this.map.take_ground_away();
        }
    }
    this.ground = Some(ground_now);
    eyes.clear();
    let active = views.iter().filter(|(_, camera, _)| camera.is_active);
    eyes.extend(active.map(|(_, _, view)| place(view)));
    this.map.follow(leading, &eyes);
    let evaporation_mm = state.evaporation_mm_h().max(0.0) * time_s / 3600.0;
    // The weather has been validated before it became state.
    let _ = this
        .map
        .advance(rain_mm.max(0.0), evaporation_mm, time_s, levels.any_water());
    match this.map.rest(ground.is_dry()) {
        Some(WaterMapRest::NoGround) => skip(SkipReason::NoGround),
        Some(WaterMapRest::Dry) => skip(SkipReason::Dry),
        Some(WaterMapRest::Settled) => skip(SkipReason::Settled),
        None => {
            let columns = ground.frame().cells()[0];
            this.map.take(&mut this.handover.frame, |x, z| {
                ground.cell_water((first.y + z) as usize * columns + (first.x + x) as usize)
            });
            if let (Some(areas), Some(heaviest)) = (areas, heaviest) {
                let origin = this.handover.frame.origin_m();
                let (field, packed) = &mut this.areas;
                if !field.pack(DVec2::new(origin.x, origin.z), reach, packed) {
                    warn_once!(
                        "more rain areas are near the view than the water map shows; the last are left out of it"
                    );
                }
                this.handover.frame.set_areas(packed, areas.weather_mm_h(), heaviest);
            }
            this.handover.wanted = true;
        }
    }
}
