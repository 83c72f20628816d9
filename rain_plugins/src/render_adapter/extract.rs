//! Main world → render world: plain data only.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use bevy::asset::AssetId;
use bevy::image::Image;
use bevy::light::{DirectionalLight, EnvironmentMapLight, GlobalAmbientLight};
use bevy::math::{DVec2, Vec2, Vec3, Vec4};
use bevy::prelude::*;
use bevy::render::storage::ShaderBuffer;
use bevy::render::sync_world::RenderEntity;
use bevy::render::{Extract, MainWorld};
use rain_core::rainfall::DropChoice;
use rain_render::cover::CoverPlacement;
use rain_render::gpu_types::WaterLook;
use rain_render::rainfall::Shutter;
use rain_render::water_map::WaterMapPlace;

use super::{RainMasks, WaveLevels};
use crate::cover::CoverMap;
use crate::rainfall::{RainViewFrame, ViewLamps, ViewMotion, ViewPanes};
use crate::surface::{
    GroundFilms, GroundMap, MapHandover, MapPlace, MirrorFrame, SurfaceState, WaterAppearance, WaterImages,
    WaterLevels, WaveNormalMaps, wind_slope_variance,
};
use crate::waves::{Handover, PuddleWaves, RainRings, ThrownLight};

/// One camera that sees rain.
#[derive(Component, Clone)]
pub(super) struct ExtractedRainView {
    pub choice: Option<DropChoice>,
    pub shutter: Option<Shutter>,
    pub motion: ViewMotion,
    /// Prefiltered cube map and its scale to cd/m².
    pub environment: Option<(AssetId<Image>, f32)>,
    pub masks: Option<RainMasks>,
    pub lamps: ViewLamps,
    pub panes: ViewPanes,
}

/// What all views share.
#[derive(Resource, Clone)]
pub(super) struct ExtractedRainScene {
    /// Without it the sky is open.
    pub cover: Option<ExtractedCover>,
    /// Without it nothing gets wet.
    pub surface: Option<ExtractedSurface>,
    /// Uniform surroundings, cd/m².
    pub ambient: Vec3,
    pub sun_direction: Vec3,
    /// Illuminance, lux.
    pub sun: Vec3,
}

/// The kept cover map.
#[derive(Clone)]
pub(super) struct ExtractedCover {
    pub image: AssetId<Image>,
    pub placement: Option<CoverPlacement>,
    pub redraw: bool,
    pub complete: Arc<AtomicBool>,
}

/// What surfaces show of the weather.
#[derive(Clone)]
pub(super) struct ExtractedSurface {
    /// See `SurfaceParams`.
    pub state: Vec4,
    pub artist: Vec4,
    pub time_s: f32,
    pub water: WaterLook,
    /// Where the normal maps of waves lie.
    pub maps: Option<[MapPlace; 2]>,
    pub images: Option<ExtractedWaterImages>,
    pub levels: Option<WaterLevels>,
    pub films: GroundFilms,
    pub mirrors: MirrorFrame,
    pub mirror_strength: f32,
    pub buffer: AssetId<ShaderBuffer>,
    pub anchor: Vec3,
    /// Wet materials are in the scene.
    pub shown: bool,
}

/// The textures that wet materials read.
#[derive(Clone, Copy)]
pub(super) struct ExtractedWaterImages {
    pub levels: AssetId<Image>,
    pub films: AssetId<Image>,
    pub map: AssetId<Image>,
    pub reflection: AssetId<Image>,
    pub ripples: AssetId<Image>,
    pub waves: AssetId<Image>,
    pub caustics: Option<AssetId<Image>>,
}

/// Rings and waves: this frame's work and where the tiles lie.
#[derive(Resource, Default)]
pub(super) struct ExtractedWaves {
    /// Frames to be done; what is not wanted is stale.
    pub ripples: Handover,
    pub waves: Handover,
    /// Side of the ripple tile. Units: m. 0: none.
    pub ripple_side_m: f64,
    /// Corner and side of the wave tile. Units: m.
    pub wave_tile_m: Option<(DVec2, f64)>,
    /// What water throws onto walls.
    pub thrown: ThrownLight,
    /// Set when the device was lost, and with it all that waved.
    pub lost: bool,
}

/// Takes this frame's rings and waves out of the main world; the lists go back and forth.
pub(super) fn extract_waves(
    mut main: ResMut<MainWorld>,
    mut extracted: ResMut<ExtractedWaves>,
    levels: Res<WaveLevels>,
) {
    levels.hand();
    let lost = std::mem::take(&mut extracted.lost);
    extracted.ripple_side_m = 0.0;
    extracted.wave_tile_m = None;
    extracted.ripples.wanted = false;
    extracted.waves.wanted = false;
    if let Some(mut rings) = main.get_resource_mut::<RainRings>() {
        let rings = rings.bypass_change_detection();
        if lost {
            rings.lose();
        } else {
            std::mem::swap(&mut rings.handover, &mut extracted.ripples);
            extracted.ripple_side_m = if rings.is_off() { 0.0 } else { rings.side_m() };
        }
    }
    if let Some(thrown) = main.get_resource::<ThrownLight>() {
        if lost {
            thrown.done.store(false, Relaxed);
        }
        extracted.thrown = thrown.clone();
    }
    if let Some(mut waves) = main.get_resource_mut::<PuddleWaves>() {
        let waves = waves.bypass_change_detection();
        if lost {
            waves.lose();
        } else {
            std::mem::swap(&mut waves.handover, &mut extracted.waves);
            let tile = waves.tile();
            let shown = tile.has_water() && !waves.is_off();
            extracted.wave_tile_m = shown.then(|| (DVec2::from(tile.corner_m()), tile.side_m()));
        }
    }
}

/// The water map: this frame's work and where it lies.
#[derive(Resource, Default)]
pub(super) struct ExtractedMap {
    pub work: MapHandover,
    /// `None`: there is no map.
    pub place: Option<WaterMapPlace>,
    /// Set when the device was lost.
    pub lost: bool,
}

/// Takes this frame's work on the water map out of the main world; its lists go back and forth.
pub(super) fn extract_map(mut main: ResMut<MainWorld>, mut extracted: ResMut<ExtractedMap>) {
    let lost = std::mem::take(&mut extracted.lost);
    extracted.place = None;
    extracted.work.wanted = false;
    if let Some(mut map) = main.get_resource_mut::<GroundMap>() {
        let map = map.bypass_change_detection();
        if lost {
            map.lose();
        } else {
            std::mem::swap(&mut map.handover, &mut extracted.work);
        }
        extracted.place = Some(map.map().place());
    }
}

/// Velocity of the waves: the app's, or with the wind, or somewhere in calm air. Units: m/s.
fn wave_velocity(appearance: &WaterAppearance, wind: Vec2) -> Vec2 {
    appearance
        .wave_velocity_m_s
        .unwrap_or_else(|| wind.normalize_or(Vec2::X) * 0.3)
}

/// The material's view of the appearance and of the wind.
fn water_look(appearance: &WaterAppearance, surface: &SurfaceState, maps: bool) -> WaterLook {
    let wind = surface.wind_m_s;
    let velocity = wave_velocity(appearance, wind);
    let variance = match appearance.wave_slope {
        Some(slope) => slope * slope,
        None => wind_slope_variance(f64::from(surface.gusty_m_s)) as f32,
    };
    let square = appearance.wave_strength * appearance.wave_strength;
    WaterLook {
        absorption: appearance
            .absorption_per_m
            .extend(appearance.ripple_strength)
            .to_array(),
        mud: appearance.mud_albedo.extend(appearance.turbidity_per_m).to_array(),
        ambient: [
            if maps { 0.0 } else { variance * square },
            1.0 / appearance.wave_length_m,
            velocity.x,
            velocity.y,
        ],
        ripples: [0.0; 4],
        waves: [0.0; 4],
        place: [0.0, 0.0, appearance.flow_strength, surface.flow_m_s],
        map: [0.0, 0.0, 0.0, if maps { appearance.wave_strength } else { 0.0 }],
        more_map: [0.0, 0.0, 0.0, appearance.puddle_reflection],
    }
}

pub(super) fn extract_rain(
    mut commands: Commands,
    map: Extract<Option<Res<CoverMap>>>,
    surface: Extract<Option<Res<SurfaceState>>>,
    water: Extract<(
        Option<Res<WaterImages>>,
        Option<Res<WaterLevels>>,
        Option<Res<GroundFilms>>,
        Option<Res<WaterAppearance>>,
        Option<Res<MirrorFrame>>,
        Option<Res<WaveNormalMaps>>,
    )>,
    ambient: Extract<Option<Res<GlobalAmbientLight>>>,
    suns: Extract<Query<(&DirectionalLight, &GlobalTransform, &InheritedVisibility)>>,
    views: Extract<
        Query<(
            RenderEntity,
            &RainViewFrame,
            &Camera,
            Option<&EnvironmentMapLight>,
            Option<&RainMasks>,
            &ViewLamps,
            &ViewPanes,
        )>,
    >,
) {
    let sun = suns
        .iter()
        .filter(|(_, _, seen)| seen.get())
        .max_by(|(a, ..), (b, ..)| a.illuminance.total_cmp(&b.illuminance));
    let (images, levels, films, appearance, mirrors, maps) = &*water;
    let maps = maps.as_ref().filter(|maps| maps.images().is_some());
    // What does not validate has been named in the log.
    let appearance = appearance.as_ref().and_then(|a| a.validated().ok()).unwrap_or_default();
    commands.insert_resource(ExtractedRainScene {
        cover: map.as_ref().map(|map| ExtractedCover {
            image: map.image.id(),
            placement: map.placement,
            redraw: map.redraw,
            complete: map.complete.clone(),
        }),
        ambient: ambient.as_ref().map_or(Vec3::ZERO, |a| linear(a.color) * a.brightness),
        sun_direction: sun.map_or(Vec3::Y, |(_, t, _)| t.back().into()),
        sun: sun.map_or(Vec3::ZERO, |(l, ..)| linear(l.color) * l.illuminance),
        surface: surface.as_ref().map(|surface| ExtractedSurface {
            state: surface.state,
            artist: surface.artist,
            time_s: surface.time_s,
            water: water_look(&appearance, surface, maps.is_some()),
            maps: maps.map(|maps| maps.places(wave_velocity(&appearance, surface.wind_m_s), surface.seconds)),
            images: images.as_ref().map(|i| ExtractedWaterImages {
                levels: i.levels.id(),
                films: i.films.id(),
                map: i.map.id(),
                reflection: i.reflection.id(),
                ripples: i.ripples.id(),
                waves: i.waves.id(),
                caustics: i.caustics.as_ref().map(Handle::id),
            }),
            levels: levels
                .as_ref()
                .filter(|l| l.is_valid() && !l.levels_m().is_empty())
                .map(|l| (**l).clone()),
            films: films.as_ref().map(|f| (**f).clone()).unwrap_or_default(),
            mirrors: mirrors.as_ref().map(|m| **m).unwrap_or_default(),
            mirror_strength: appearance.reflection_strength,
            buffer: surface.handles.params.id(),
            anchor: surface.anchor,
            shown: surface.shown,
        }),
    });
    for (entity, frame, camera, environment, masks, lamps, panes) in &views {
        let mut entity = commands.entity(entity);
        if !camera.is_active {
            entity.remove::<ExtractedRainView>();
            continue;
        }
        entity.insert(ExtractedRainView {
            choice: frame.choice.clone(),
            shutter: frame.shutter,
            motion: frame.motion,
            environment: environment.map(|e| (e.specular_map.id(), e.intensity)),
            masks: masks.cloned(),
            lamps: lamps.clone(),
            panes: panes.clone(),
        });
    }
}

fn linear(color: Color) -> Vec3 {
    let c = color.to_linear();
    Vec3::new(c.red, c.green, c.blue)
}
