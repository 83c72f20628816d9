//! Main world → render world: plain data only.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use bevy::asset::AssetId;
use bevy::image::Image;
use bevy::light::{DirectionalLight, EnvironmentMapLight, GlobalAmbientLight};
use bevy::math::{Vec3, Vec4};
use bevy::prelude::*;
use bevy::render::Extract;
use bevy::render::storage::ShaderBuffer;
use bevy::render::sync_world::RenderEntity;
use rain_core::rainfall::Container;
use rain_render::cover::CoverPlacement;
use rain_render::rainfall::Shutter;

use super::RainMasks;
use crate::cover::CoverMap;
use crate::rainfall::{RainViewFrame, ViewMotion};
use crate::surface::SurfaceState;

/// One camera that sees rain.
#[derive(Component, Clone)]
pub(super) struct ExtractedRainView {
    pub container: Arc<Container>,
    pub seed: u64,
    pub shutter: Option<Shutter>,
    pub motion: ViewMotion,
    pub focal_px: f32,
    /// Prefiltered cube map and its scale to cd/m².
    pub environment: Option<(AssetId<Image>, f32)>,
    pub masks: Option<RainMasks>,
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
    /// See `SurfaceParams::state`.
    pub state: Vec4,
    pub buffer: AssetId<ShaderBuffer>,
    pub anchor: Vec3,
    pub wet: bool,
}

pub(super) fn extract_rain(
    mut commands: Commands,
    map: Extract<Option<Res<CoverMap>>>,
    surface: Extract<Option<Res<SurfaceState>>>,
    ambient: Extract<Option<Res<GlobalAmbientLight>>>,
    suns: Extract<Query<(&DirectionalLight, &GlobalTransform)>>,
    views: Extract<
        Query<(
            RenderEntity,
            &RainViewFrame,
            &Camera,
            Option<&EnvironmentMapLight>,
            Option<&RainMasks>,
        )>,
    >,
) {
    let sun = suns
        .iter()
        .max_by(|(a, _), (b, _)| a.illuminance.total_cmp(&b.illuminance));
    commands.insert_resource(ExtractedRainScene {
        cover: map.as_ref().map(|map| ExtractedCover {
            image: map.image.id(),
            placement: map.placement,
            redraw: map.redraw,
            complete: map.complete.clone(),
        }),
        ambient: ambient.as_ref().map_or(Vec3::ZERO, |a| linear(a.color) * a.brightness),
        sun_direction: sun.map_or(Vec3::Y, |(_, t)| t.back().into()),
        sun: sun.map_or(Vec3::ZERO, |(l, _)| linear(l.color) * l.illuminance),
        surface: surface.as_ref().map(|surface| ExtractedSurface {
            state: surface.state,
            buffer: surface.handles.params.id(),
            anchor: surface.anchor,
            wet: surface.wet,
        }),
    });
    for (entity, frame, camera, environment, masks) in &views {
        let mut entity = commands.entity(entity);
        if !camera.is_active {
            entity.remove::<ExtractedRainView>();
            continue;
        }
        entity.insert(ExtractedRainView {
            container: frame.container.clone(),
            seed: frame.seed,
            shutter: frame.shutter,
            motion: frame.motion,
            focal_px: frame.focal_px,
            environment: environment.map(|e| (e.specular_map.id(), e.intensity)),
            masks: masks.cloned(),
        });
    }
}

fn linear(color: Color) -> Vec3 {
    let c = color.to_linear();
    Vec3::new(c.red, c.green, c.blue)
}
