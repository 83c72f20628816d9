//! Splashes: extraction, uploads and commands of each view.

use std::collections::HashMap;

use bevy::core_pipeline::prepass::ViewPrepassTextures;
use bevy::math::Vec2;
use bevy::prelude::*;
use bevy::render::Extract;
use bevy::render::camera::ExtractedCamera;
use bevy::render::diagnostic::RecordDiagnostics;
use bevy::render::render_asset::RenderAssets;
use bevy::render::renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery};
use bevy::render::sync_world::RenderEntity;
use bevy::render::texture::GpuImage;
use bevy::render::view::{ExtractedView, Msaa, ViewDepthTexture, ViewTarget};
use rain_render::cover::open_sky;
use rain_render::gpu_types::LevelMapParams;
use rain_render::splash::{
    SplashGpu, SplashInput, SplashTextures, SplashViewGpu, SpoutStream, StepSplash, encode_splash_behind,
    encode_splash_coverage, encode_splash_draw, encode_splash_make,
};

use super::after_blur::RainOrder;
use super::counts::Counts;
use super::extract::{ExtractedRainScene, ExtractedRainView};
use super::prepare::{level_params, view_lighting};
use super::record::{cleared, draw_within, over_scene};
use crate::report::{PassName, RainReport};
use crate::splash::{SplashMask, SplashShot, SplashViewFrame};

/// One camera that sees splashes.
#[derive(Component, Clone)]
pub(super) struct ExtractedSplashView {
    shot: Option<SplashShot>,
    mask: Option<Handle<Image>>,
}

/// Everything of splashes on the GPU that lives with the device.
#[derive(Resource)]
pub(super) struct SplashViews {
    gpu: SplashGpu,
    views: HashMap<Entity, SplashViewGpu>,
    counts: Counts,
}

/// The first of them: vertices of the parts.
const COUNTED_BYTES: u64 = 4;

/// Hands this frame's counts to the report.
pub(super) fn count_splashes(mut splashes: ResMut<SplashViews>, report: Res<RainReport>) {
    let report = report.clone();
    // Six vertices a part.
    splashes.counts.read(move |words| report.splashes(words[0] / 6));
}

impl FromWorld for SplashViews {
    fn from_world(world: &mut World) -> Self {
        Self {
            gpu: SplashGpu::new(world.resource::<RenderDevice>().wgpu_device()),
            views: HashMap::new(),
            counts: Counts::default(),
        }
    }
}

impl SplashViews {
    /// GPU memory of all views. Units: bytes.
    pub(super) fn memory_bytes(&self) -> usize {
        self.views.values().map(SplashViewGpu::memory_bytes).sum()
    }
}

pub(super) fn extract_splashes(
    mut commands: Commands,
    views: Extract<Query<(RenderEntity, &SplashViewFrame, &Camera, Option<&SplashMask>)>>,
) {
    for (entity, frame, camera, mask) in &views {
        let mut entity = commands.entity(entity);
        if !camera.is_active {
            entity.remove::<ExtractedSplashView>();
            continue;
        }
        entity.insert(ExtractedSplashView {
            shot: frame.shot.clone(),
            mask: mask.map(|mask| mask.0.clone()),
        });
    }
}

pub(super) fn prepare_splashes(
    mut splashes: ResMut<SplashViews>,
    scene: Option<Res<ExtractedRainScene>>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    images: Res<RenderAssets<GpuImage>>,
    views: Query<(
        Entity,
        &ExtractedView,
        &ExtractedCamera,
        &ExtractedSplashView,
        &ExtractedRainView,
        Option<&ViewPrepassTextures>,
        &Msaa,
    )>,
) {
    let Some(scene) = scene else { return };
    let splashes = &mut *splashes;
    let device = device.wgpu_device();
    let cover = scene.cover.as_ref();
    let cover_image = cover.and_then(|c| images.get(c.image));
    // What is not shown is not kept up to date.
    let surface = scene.surface.as_ref();
    let water = surface.filter(|s| s.shown && s.levels.is_some());
    let level_image = water.and_then(|s| images.get(s.images?.levels));
    splashes.views.retain(|entity, _| views.contains(*entity));
    for (entity, view, camera, splash, rain, prepass, msaa) in &views {
        let Some(shot) = &splash.shot else { continue };
        let aim = &shot.aim;
        let origin = aim.from_m;
        let eye = origin.as_dvec3();
        let rotation = view.world_from_view.rotation();
        let (now, before) = shot.motion.view_matrices(rotation, shot.exposure_s);
        let scene_depth: Option<&wgpu::TextureView> = match (msaa, prepass.and_then(ViewPrepassTextures::depth_view)) {
            (Msaa::Off, Some(depth)) => Some(depth),
            _ => None,
        };
        let environment = rain.environment.and_then(|(id, scale)| Some((images.get(id)?, scale)));
        // Without perspective splashes are seen from what they are around.
        let moved = Mat4::from_translation(origin - view.world_from_view.translation());
        let lamps = rain.lamps.seen_from(origin, camera.exposure);
        let panes = match aim.parallel {
            Some(_) => Vec::new(),
            None => rain.panes.seen_from(origin),
        };
        let from_eye = |step: &StepSplash| StepSplash {
            place_m: step.place_m - origin,
            ..*step
        };
        let feet: Vec<StepSplash> = shot.steps.iter().map(from_eye).collect();
        let mouth = |stream: &SpoutStream| SpoutStream {
            place_m: stream.place_m - origin,
            ..*stream
        };
        let mouths: Vec<SpoutStream> = shot.mouths.iter().map(mouth).collect();
        splashes.gpu.prepare_pipelines(
            device,
            view.target_format,
            msaa.samples(),
            splash.mask.is_some(),
            !panes.is_empty(),
        );
        let input = SplashInput {
            field: &shot.field,
            anchor: shot.anchor,
            clip_from_eye: view.clip_from_view * now * moved,
            clip_from_eye_before: view.clip_from_view * before * moved,
            side_planes: aim.side_planes,
            parallel: aim.parallel,
            wind_m_s: shot.wind_m_s,
            viewport_px: Vec2::new(view.viewport.z as f32, view.viewport.w as f32),
            focal_px: aim.focal_px,
            near_m: if aim.parallel.is_some() {
                0.0
            } else {
                view.clip_from_view.w_axis.z
            },
            exposure_s: shot.exposure_s,
            contrast: shot.contrast,
            soft_m: if scene_depth.is_some() && aim.parallel.is_none() {
                shot.soft_m
            } else {
                0.0
            },
            reach_m: aim.reach_m[0],
            near_reach_m: aim.reach_m[1],
            shares: aim.shares,
            film_mm: surface.map_or(0.0, |s| s.state.y),
            capacity: shot.capacity,
            lighting: view_lighting(&scene, environment, camera.exposure),
            lamps: &lamps,
            panes: &panes,
            feet: &feet,
            mouths: &mouths,
            mouth_reach_m: shot.mouth_reach_m,
            cover: match (cover.and_then(|c| c.placement), cover_image) {
                (Some(placement), Some(_)) => placement.params(eye),
                _ => open_sky(),
            },
            levels: match (water, level_image) {
                (Some(water), Some(_)) => level_params(water, eye),
                _ => LevelMapParams::default(),
            },
        };
        let textures = SplashTextures {
            cover: cover_image.map(|i| -> &wgpu::TextureView { &i.texture_view }),
            scene_depth,
            environment: environment.map(|(i, _)| -> &wgpu::TextureView { &i.texture_view }),
            levels: level_image.map(|i| -> &wgpu::TextureView { &i.texture_view }),
        };
        let slot = splashes
            .views
            .entry(entity)
            .or_insert_with(|| SplashViewGpu::new(device));
        slot.prepare(device, &queue, &splashes.gpu, &input, textures);
    }
}

/// Finds this frame's splashes.
fn make(ctx: &mut RenderContext, gpu: &SplashGpu, view_gpu: &SplashViewGpu) {
    let recorder = ctx.diagnostic_recorder();
    let recorder = recorder.as_deref();
    let mut pass = ctx.command_encoder().begin_compute_pass(&wgpu::ComputePassDescriptor {
        label: Some("rain_splash_make"),
        timestamp_writes: None,
    });
    let span = recorder.pass_span(&mut pass, "rain_splash_make");
    encode_splash_make(&mut pass, gpu, view_gpu);
    span.end(&mut pass);
}

/// Makes a view's splashes and draws those behind glass, before what is transparent; nothing where there is no glass.
pub(super) fn splash_behind_glass(
    view: ViewQuery<(
        Entity,
        &ExtractedView,
        &ExtractedSplashView,
        &ViewTarget,
        &ViewDepthTexture,
        &Msaa,
    )>,
    splashes: Res<SplashViews>,
    mut ctx: RenderContext,
) {
    let (entity, view, splash, target, depth, msaa) = view.into_inner();
    let of_view = splashes.views.get(&entity).filter(|_| splash.shot.is_some());
    let Some(view_gpu) = of_view.filter(|v| v.panes() > 0) else {
        return;
    };
    make(&mut ctx, &splashes.gpu, view_gpu);
    let colour = target.get_color_attachment();
    let mut pass = over_scene(ctx.command_encoder(), "rain_splash_behind_glass", colour, depth);
    draw_within(&mut pass, view.viewport);
    encode_splash_behind(&mut pass, &splashes.gpu, view_gpu, view.target_format, msaa.samples());
}

/// Makes a view's splashes, if that has not been done, and draws them over its colour target, but those behind glass; and
/// their mask where somebody asked for it. Once for views whose rain comes after blur, once for the others.
pub(super) fn splash<const AFTER_BLUR: bool>(
    view: ViewQuery<(
        Entity,
        &ExtractedView,
        &ExtractedSplashView,
        &ViewTarget,
        &ViewDepthTexture,
        &Msaa,
        RainOrder,
    )>,
    mut splashes: ResMut<SplashViews>,
    device: Res<RenderDevice>,
    images: Res<RenderAssets<GpuImage>>,
    report: Res<RainReport>,
    mut ctx: RenderContext,
) {
    let (entity, view, splash, target, depth, msaa, order) = view.into_inner();
    if order.is_after_blur() != AFTER_BLUR {
        return;
    }
    let splashes = &mut *splashes;
    let view_gpu = splashes.views.get(&entity).filter(|_| splash.shot.is_some());
    if let Some(view_gpu) = view_gpu {
        if view_gpu.panes() == 0 {
            make(&mut ctx, &splashes.gpu, view_gpu);
        }
        splashes.counts.copy(
            device.wgpu_device(),
            ctx.command_encoder(),
            view_gpu.arguments(),
            COUNTED_BYTES,
        );
        let recorder = ctx.diagnostic_recorder();
        let recorder = recorder.as_deref();
        let mut pass = over_scene(
            ctx.command_encoder(),
            "rain_splash",
            target.get_color_attachment(),
            depth,
        );
        let span = recorder.pass_span(&mut pass, "rain_splash");
        draw_within(&mut pass, view.viewport);
        encode_splash_draw(&mut pass, &splashes.gpu, view_gpu, view.target_format, msaa.samples());
        span.end(&mut pass);
        drop(pass);
        report.recorded(PassName::Splash);
    }
    let mask = splash.mask.as_ref().and_then(|mask| images.get(mask));
    let Some(mask) = mask.filter(|_| *msaa == Msaa::Off) else {
        return;
    };
    let mut pass = over_scene(
        ctx.command_encoder(),
        "rain_mask_splash",
        cleared(&mask.texture_view),
        depth,
    );
    if let Some(view_gpu) = view_gpu {
        draw_within(&mut pass, view.viewport);
        encode_splash_coverage(&mut pass, &splashes.gpu, view_gpu, msaa.samples());
    }
}
