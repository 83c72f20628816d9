//! Far rain: extraction, uploads and commands of each view.

use std::collections::HashMap;

use bevy::prelude::*;
use bevy::render::Extract;
use bevy::render::camera::ExtractedCamera;
use bevy::render::diagnostic::RecordDiagnostics;
use bevy::render::render_asset::RenderAssets;
use bevy::render::renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery};
use bevy::render::sync_world::RenderEntity;
use bevy::render::texture::GpuImage;
use bevy::render::view::{ExtractedView, Msaa, ViewDepthTexture, ViewTarget};
use rain_render::far_rain::{FarRainGpu, FarRainInput, FarRainViewGpu, encode_far_rain, encode_far_rain_coverage};

use super::extract::ExtractedRainScene;
use super::haze::ExtractedHazeView;
use super::prepare::view_lighting;
use super::record::{draw_within, over_scene};
use crate::haze::{FarRainShot, FarRainViewFrame, HazeMask};
use crate::report::{PassName, RainReport};

/// One camera that sees far rain.
#[derive(Component, Clone)]
pub(super) struct ExtractedFarView {
    shot: FarRainShot,
    /// Far rain is haze drawn otherwise: it goes into the haze's mask.
    mask: Option<Handle<Image>>,
}

/// Everything of far rain on the GPU that lives with the device.
#[derive(Resource)]
pub(super) struct FarRainViews {
    gpu: FarRainGpu,
    views: HashMap<Entity, FarRainViewGpu>,
}

impl FromWorld for FarRainViews {
    fn from_world(world: &mut World) -> Self {
        Self {
            gpu: FarRainGpu::new(world.resource::<RenderDevice>().wgpu_device()),
            views: HashMap::new(),
        }
    }
}

impl FarRainViews {
    /// GPU memory of all views. Units: bytes.
    pub(super) fn memory_bytes(&self) -> usize {
        self.views.values().map(FarRainViewGpu::memory_bytes).sum()
    }
}

pub(super) fn extract_far_rain(
    mut commands: Commands,
    views: Extract<Query<(RenderEntity, &FarRainViewFrame, &Camera, Option<&HazeMask>)>>,
) {
    for (entity, frame, camera, mask) in &views {
        let mut entity = commands.entity(entity);
        match frame.shot.as_ref().filter(|_| camera.is_active) {
            Some(shot) => entity.insert(ExtractedFarView {
                shot: shot.clone(),
                mask: mask.map(|mask| mask.0.clone()),
            }),
            None => entity.remove::<ExtractedFarView>(),
        };
    }
}

pub(super) fn prepare_far_rain(
    mut far: ResMut<FarRainViews>,
    scene: Option<Res<ExtractedRainScene>>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    images: Res<RenderAssets<GpuImage>>,
    views: Query<(
        Entity,
        &ExtractedView,
        &ExtractedCamera,
        &ExtractedFarView,
        &ExtractedHazeView,
        &Msaa,
    )>,
) {
    let Some(scene) = scene else { return };
    let far = &mut *far;
    let device = device.wgpu_device();
    far.views.retain(|entity, _| views.contains(*entity));
    for (entity, view, camera, seen, haze, msaa) in &views {
        let environment = haze.environment.and_then(|(id, scale)| Some((images.get(id)?, scale)));
        far.gpu
            .prepare_pipelines(device, view.target_format, msaa.samples(), seen.mask.is_some());
        let rotation = view.world_from_view.rotation();
        let input = FarRainInput {
            particles: &seen.shot.rain.particles,
            axis: seen.shot.rain.axis,
            clip_from_eye: view.clip_from_view * Mat4::from_quat(rotation.inverse()),
            lighting: view_lighting(&scene, environment, camera.exposure),
            cloud_m: seen.shot.cloud_m,
            thin_m: seen.shot.thin_m,
        };
        let environment = environment.map(|(i, _)| -> &wgpu::TextureView { &i.texture_view });
        let slot = far.views.entry(entity).or_insert_with(|| FarRainViewGpu::new(device));
        slot.prepare(device, &queue, &far.gpu, &input, environment);
    }
}

/// Draws a view's far rain over its haze, and into the haze's mask where somebody asked for that.
pub(super) fn far_rain(
    view: ViewQuery<(
        Entity,
        &ExtractedView,
        &ExtractedFarView,
        &ViewTarget,
        &ViewDepthTexture,
        &Msaa,
    )>,
    far: Res<FarRainViews>,
    images: Res<RenderAssets<GpuImage>>,
    report: Res<RainReport>,
    mut ctx: RenderContext,
) {
    let (entity, view, seen, target, depth, msaa) = view.into_inner();
    let Some(view_gpu) = far.views.get(&entity).filter(|view| view.particles() > 0) else {
        return;
    };
    let recorder = ctx.diagnostic_recorder();
    let recorder = recorder.as_deref();
    let mut pass = over_scene(
        ctx.command_encoder(),
        "rain_far_rain",
        target.get_color_attachment(),
        depth,
    );
    let span = recorder.pass_span(&mut pass, "rain_far_rain");
    draw_within(&mut pass, view.viewport);
    encode_far_rain(&mut pass, &far.gpu, view_gpu, view.target_format, msaa.samples());
    span.end(&mut pass);
    drop(pass);
    report.recorded(PassName::FarRain);
    report.far_rain(view_gpu.particles());
    let mask = seen.mask.as_ref().and_then(|mask| images.get(mask));
    let Some(mask) = mask.filter(|_| *msaa == Msaa::Off) else {
        return;
    };
    // Over what the haze has obscured.
    let over = wgpu::RenderPassColorAttachment {
        view: &mask.texture_view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations {
            load: wgpu::LoadOp::Load,
            store: wgpu::StoreOp::Store,
        },
    };
    let mut pass = over_scene(ctx.command_encoder(), "rain_mask_far_rain", over, depth);
    draw_within(&mut pass, view.viewport);
    encode_far_rain_coverage(&mut pass, &far.gpu, view_gpu, 1);
}
