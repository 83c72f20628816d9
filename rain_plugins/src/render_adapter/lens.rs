//! Glass in the rain: extraction, uploads and commands of each view.

use std::collections::HashMap;

use bevy::math::Vec4Swizzles as _;
use bevy::prelude::*;
use bevy::render::Extract;
use bevy::render::camera::ExtractedCamera;
use bevy::render::diagnostic::RecordDiagnostics;
use bevy::render::renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery};
use bevy::render::sync_world::RenderEntity;
use bevy::render::view::{ExtractedView, ViewTarget};
use rain_render::lens::{LensGpu, LensInput, LensViewGpu, encode_lens};

use super::after_blur::RainOrder;
use crate::lens::{LensGlass, LensShot};
use crate::report::{PassName, RainReport};

/// One camera whose glass is wet.
#[derive(Component, Clone)]
pub(super) struct ExtractedLensView(LensShot);

/// Everything of the pass on the GPU that lives with the device; made when a glass first gets wet.
#[derive(Resource, Default)]
pub(super) struct LensViews {
    gpu: Option<LensGpu>,
    views: HashMap<Entity, LensViewGpu>,
}

impl LensViews {
    /// GPU memory of all views. Units: bytes.
    pub(super) fn memory_bytes(&self) -> usize {
        self.views.values().map(LensViewGpu::memory_bytes).sum()
    }
}

pub(super) fn extract_lenses(mut commands: Commands, views: Extract<Query<(RenderEntity, &LensGlass, &Camera)>>) {
    for (entity, glass, camera) in &views {
        let mut entity = commands.entity(entity);
        match glass.shot.as_ref().filter(|_| camera.is_active) {
            Some(shot) => entity.insert(ExtractedLensView(shot.clone())),
            None => entity.remove::<ExtractedLensView>(),
        };
    }
}

pub(super) fn prepare_lenses(
    mut lenses: ResMut<LensViews>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    views: Query<(Entity, &ExtractedView, &ExtractedCamera, &ExtractedLensView)>,
) {
    let lenses = &mut *lenses;
    lenses.views.retain(|entity, _| views.contains(*entity));
    let device = device.wgpu_device();
    for (entity, view, camera, ExtractedLensView(shot)) in &views {
        let gpu = lenses.gpu.get_or_insert_with(|| LensGpu::new(device));
        gpu.prepare_pipelines(device, view.target_format);
        let input = LensInput {
            drops: &shot.drops,
            wipers: &shot.wipers,
            viewport_px: view.viewport,
            target_px: camera.physical_target_size.unwrap_or(view.viewport.zw()),
            half_tan: shot.half_tan,
            distance_m: shot.distance_m,
            aperture_m: shot.aperture_m,
            mist: shot.mist,
            mist_per_s: shot.mist_per_s,
        };
        let slot = lenses.views.entry(entity).or_insert_with(|| LensViewGpu::new(device));
        slot.prepare(device, &queue, &input);
    }
}

/// Draws the finished view again, through its glass. Once for views whose rain comes after blur, once for the others.
pub(super) fn lens<const AFTER_BLUR: bool>(
    view: ViewQuery<(Entity, &ExtractedView, &ExtractedLensView, &ViewTarget, RainOrder)>,
    lenses: Res<LensViews>,
    device: Res<RenderDevice>,
    report: Res<RainReport>,
    mut ctx: RenderContext,
) {
    let (entity, view, _, target, order) = view.into_inner();
    if order.is_after_blur() != AFTER_BLUR {
        return;
    }
    let (Some(gpu), Some(view_gpu)) = (&lenses.gpu, lenses.views.get(&entity)) else {
        return;
    };
    let recorder = ctx.diagnostic_recorder();
    let recorder = recorder.as_deref();
    let swap = target.post_process_write();
    let span = recorder.time_span(ctx.command_encoder(), "rain_lens");
    encode_lens(
        device.wgpu_device(),
        ctx.command_encoder(),
        gpu,
        view_gpu,
        swap.source,
        swap.destination,
        view.target_format,
    );
    span.end(ctx.command_encoder());
    report.recorded(PassName::Lens);
}
