//! Commands of each view. Every recorded pass is counted here and nowhere else.

use std::sync::atomic::Ordering::Relaxed;

use bevy::prelude::*;
use bevy::render::diagnostic::RecordDiagnostics;
use bevy::render::render_asset::RenderAssets;
use bevy::render::render_resource::{PipelineCache, StoreOp};
use bevy::render::renderer::{RenderContext, RenderDevice, ViewQuery};
use bevy::render::texture::GpuImage;
use bevy::render::view::{ExtractedView, Msaa, ViewDepthTexture, ViewTarget};
use rain_render::masks::MaskTargets;
use rain_render::rainfall::{RainfallViewGpu, encode_behind, encode_coverage, encode_draw, encode_project};
use rain_render::reflection::encode_reflection_mips;

use super::after_blur::RainOrder;
use super::counts::Counts;
use super::extract::{ExtractedMap, ExtractedRainScene, ExtractedRainView, ExtractedWaves};
use super::lattice::LatticeViews;
use super::prepare::RainGpu;
use crate::cover::RainCoverView;
use crate::report::{PassName, RainReport};
use crate::surface::{RainMaskView, RainMirrorView};

/// Copies the cover view's depth into the map that everybody reads: views share and recycle their own textures.
pub(super) fn keep_cover_map(
    view: ViewQuery<&ViewDepthTexture, With<RainCoverView>>,
    scene: Option<Res<ExtractedRainScene>>,
    images: Res<RenderAssets<GpuImage>>,
    pipelines: Res<PipelineCache>,
    report: Res<RainReport>,
    mut ctx: RenderContext,
) {
    let depth = view.into_inner();
    let Some(cover) = scene.as_ref().and_then(|s| s.cover.as_ref()).filter(|c| c.redraw) else {
        return;
    };
    let Some(map) = images.get(cover.image) else {
        return;
    };
    let source: &wgpu::Texture = &depth.texture;
    let target: &wgpu::Texture = &map.texture;
    if source.size() != target.size() {
        return;
    }
    ctx.command_encoder()
        .copy_texture_to_texture(source.as_image_copy(), target.as_image_copy(), source.size());
    // A mesh whose pipeline is still being compiled is missing from this map: it will be drawn again.
    cover
        .complete
        .store(pipelines.waiting_pipelines().next().is_none(), Relaxed);
    report.recorded(PassName::Cover);
}

/// Lets the weather and wheels act on the water map, before any view is drawn.
pub(super) fn water_map(gpu: Res<RainGpu>, map: Res<ExtractedMap>, report: Res<RainReport>, mut ctx: RenderContext) {
    let Some(texels) = gpu.water_map.as_ref().filter(|_| map.work.wanted) else {
        return;
    };
    let recorder = ctx.diagnostic_recorder();
    let recorder = recorder.as_deref();
    let mut pass = ctx.command_encoder().begin_compute_pass(&wgpu::ComputePassDescriptor {
        label: Some("rain_water_map"),
        timestamp_writes: None,
    });
    let span = recorder.pass_span(&mut pass, "rain_water_map");
    texels.encode(&mut pass, &gpu.map_passes);
    span.end(&mut pass);
    drop(pass);
    report.recorded(PassName::WaterMap);
}

/// Moves rings and waves on, before any view is drawn.
pub(super) fn water(gpu: Res<RainGpu>, waves: Res<ExtractedWaves>, report: Res<RainReport>, mut ctx: RenderContext) {
    for (tile, work, pass_name, label) in [
        (&gpu.ripple_tile, &waves.ripples, PassName::Ripples, "rain_ripples"),
        (&gpu.wave_tile, &waves.waves, PassName::Waves, "rain_waves"),
    ] {
        let tile = tile.as_ref().filter(|_| work.layers.is_none());
        let layers = gpu.ring_layer_tile.as_ref().filter(|_| work.layers.is_some());
        if !work.wanted || (tile.is_none() && layers.is_none()) {
            continue;
        }
        let recorder = ctx.diagnostic_recorder();
        let recorder = recorder.as_deref();
        let mut pass = ctx.command_encoder().begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(label),
            timestamp_writes: None,
        });
        let span = recorder.pass_span(&mut pass, label);
        if let Some(tile) = tile {
            tile.encode(&mut pass, &gpu.waves, &gpu.slope_mips);
        }
        if let Some(layers) = layers {
            layers.encode(&mut pass, &gpu.ring_layers, &gpu.slope_mips);
        }
        span.end(&mut pass);
        drop(pass);
        report.recorded(pass_name);
    }
    if let Some(caustics) = gpu.caustics.as_ref().filter(|_| waves.thrown.wanted) {
        caustics.clear(ctx.command_encoder());
        let recorder = ctx.diagnostic_recorder();
        let recorder = recorder.as_deref();
        let mut pass = ctx.command_encoder().begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("rain_caustics"),
            timestamp_writes: None,
        });
        let span = recorder.pass_span(&mut pass, "rain_caustics");
        caustics.encode(&mut pass);
        span.end(&mut pass);
        drop(pass);
        waves.thrown.done.store(true, Relaxed);
        report.recorded(PassName::Caustics);
    }
}

/// Copies a mirrored view into its layer of the texture that wet materials read.
pub(super) fn keep_reflection(
    view: ViewQuery<(&ViewTarget, &RainMirrorView)>,
    scene: Option<Res<ExtractedRainScene>>,
    images: Res<RenderAssets<GpuImage>>,
    gpu: Res<RainGpu>,
    report: Res<RainReport>,
    mut ctx: RenderContext,
) {
    let (target, mirror) = view.into_inner();
    let Some(surface) = scene.as_ref().and_then(|s| s.surface.as_ref()) else {
        return;
    };
    let Some(kept) = surface.images.as_ref().and_then(|i| images.get(i.reflection)) else {
        return;
    };
    let source: &wgpu::Texture = target.main_texture();
    let kept: &wgpu::Texture = &kept.texture;
    let (true, true, Some(mips)) = (
        (source.width(), source.height()) == (kept.width(), kept.height()),
        source.format() == kept.format(),
        gpu.reflection_layers.get(mirror.layer as usize),
    ) else {
        return;
    };
    let mut layer = kept.as_image_copy();
    layer.origin.z = mirror.layer;
    ctx.command_encoder()
        .copy_texture_to_texture(source.as_image_copy(), layer, source.size());
    let mut pass = ctx.command_encoder().begin_compute_pass(&wgpu::ComputePassDescriptor {
        label: Some("rain_reflection_mips"),
        timestamp_writes: None,
    });
    encode_reflection_mips(&mut pass, &gpu.reflection, mips);
    drop(pass);
    report.recorded(PassName::Reflection);
}

/// Copies what wet materials know of a view's pixels for its masks.
pub(super) fn keep_known(view: ViewQuery<(&ViewTarget, &RainMaskView)>, gpu: Res<RainGpu>, mut ctx: RenderContext) {
    let (target, mask) = view.into_inner();
    let source: &wgpu::Texture = target.main_texture();
    let Some(kept) = gpu.known.get(&mask.of) else {
        return;
    };
    if source.size() == kept.size() && source.format() == kept.format() {
        ctx.command_encoder()
            .copy_texture_to_texture(source.as_image_copy(), kept.as_image_copy(), source.size());
    }
}

/// A pass over a finished scene, against its depth.
pub(super) fn over_scene<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    label: &str,
    colour: wgpu::RenderPassColorAttachment,
    depth: &ViewDepthTexture,
) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &[Some(colour)],
        depth_stencil_attachment: Some(depth.get_attachment(StoreOp::Store)),
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    })
}

/// A mask that nothing covers yet.
pub(super) fn cleared(view: &wgpu::TextureView) -> wgpu::RenderPassColorAttachment<'_> {
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations {
            load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
            store: wgpu::StoreOp::Store,
        },
    }
}

/// Draws into the part of the target that the view has; its pixels are counted from that part's corner.
pub(super) fn draw_within(pass: &mut wgpu::RenderPass, viewport: UVec4) {
    let [x, y, width, height] = viewport.as_vec4().to_array();
    pass.set_viewport(x, y, width, height, 0.0, 1.0);
}

/// Chooses and projects this frame's drops.
fn project(ctx: &mut RenderContext, gpu: &RainGpu, view_gpu: &RainfallViewGpu) {
    let recorder = ctx.diagnostic_recorder();
    let recorder = recorder.as_deref();
    let mut pass = ctx.command_encoder().begin_compute_pass(&wgpu::ComputePassDescriptor {
        label: Some("rain_rainfall_project"),
        timestamp_writes: None,
    });
    let span = recorder.pass_span(&mut pass, "rain_rainfall_project");
    encode_project(&mut pass, &gpu.rainfall, view_gpu);
    span.end(&mut pass);
}

/// Chooses and projects a view's streaks and draws those behind glass, before what is transparent; nothing where there is no glass.
pub(super) fn rainfall_behind_glass(
    view: ViewQuery<(
        Entity,
        &ExtractedView,
        &ExtractedRainView,
        &ViewTarget,
        &ViewDepthTexture,
        &Msaa,
    )>,
    gpu: Res<RainGpu>,
    mut ctx: RenderContext,
) {
    let (entity, view, rain, target, depth, msaa) = view.into_inner();
    let of_view = gpu.views.get(&entity).filter(|_| rain.shutter.is_some());
    let Some(view_gpu) = of_view.filter(|v| v.panes() > 0) else {
        return;
    };
    project(&mut ctx, &gpu, view_gpu);
    let colour = target.get_color_attachment();
    let mut pass = over_scene(ctx.command_encoder(), "rain_rainfall_behind_glass", colour, depth);
    draw_within(&mut pass, view.viewport);
    encode_behind(&mut pass, &gpu.rainfall, view_gpu, view.target_format, msaa.samples());
}

/// Counts of drops on their way back.
#[derive(Resource, Default)]
pub(super) struct DropCounts(Counts);

/// How many drops are drawn, how many of them may have a pattern, how many there would be without a limit.
const COUNTED_BYTES: u64 = 12;

/// Hands this frame's counts to the report.
pub(super) fn count_drops(mut counts: ResMut<DropCounts>, report: Res<RainReport>) {
    let report = report.clone();
    counts.0.read(move |words| {
        report.drops(words[0]);
        if words[2] > words[0] {
            warn_once!("a rain view holds more drops than there is room for; the rest is left out");
        }
    });
}

/// Chooses and projects a view's streaks, if that has not been done, and draws them over its colour target, but those behind glass; and
/// its masks where somebody asked for them. Once for views whose rain comes after blur, once for the others.
pub(super) fn rainfall<const AFTER_BLUR: bool>(
    view: ViewQuery<(
        Entity,
        &ExtractedView,
        &ExtractedRainView,
        &ViewTarget,
        &ViewDepthTexture,
        &Msaa,
        RainOrder,
    )>,
    gpu: Res<RainGpu>,
    cards: Res<LatticeViews>,
    images: Res<RenderAssets<GpuImage>>,
    report: Res<RainReport>,
    device: Res<RenderDevice>,
    mut counts: ResMut<DropCounts>,
    mut ctx: RenderContext,
) {
    let (entity, view, rain, target, depth, msaa, order) = view.into_inner();
    if order.is_after_blur() != AFTER_BLUR {
        return;
    }
    let view_gpu = gpu.views.get(&entity).filter(|_| rain.shutter.is_some());

    if let Some(view_gpu) = view_gpu {
        if view_gpu.panes() == 0 {
            project(&mut ctx, &gpu, view_gpu);
        }
        let recorder = ctx.diagnostic_recorder();
        let recorder = recorder.as_deref();
        let mut pass = over_scene(
            ctx.command_encoder(),
            "rain_rainfall",
            target.get_color_attachment(),
            depth,
        );
        let span = recorder.pass_span(&mut pass, "rain_rainfall");
        draw_within(&mut pass, view.viewport);
        encode_draw(&mut pass, &gpu.rainfall, view_gpu, view.target_format, msaa.samples());
        span.end(&mut pass);
        drop(pass);
        report.recorded(PassName::Rainfall);
        let device = device.wgpu_device();
        counts
            .0
            .copy(device, ctx.command_encoder(), view_gpu.arguments(), COUNTED_BYTES);
    }

    let Some(masks) = &rain.masks else { return };
    let (Some(rain_mask), Some(wet_mask), Some(depth_mask), Some(water_mask)) = (
        images.get(&masks.rain),
        images.get(&masks.wet),
        images.get(&masks.depth),
        images.get(&masks.water),
    ) else {
        return;
    };
    if *msaa != Msaa::Off {
        return;
    }
    let mut pass = over_scene(
        ctx.command_encoder(),
        "rain_mask_coverage",
        cleared(&rain_mask.texture_view),
        depth,
    );
    draw_within(&mut pass, view.viewport);
    cards.encode_coverage(&mut pass, entity, msaa.samples());
    if let Some(view_gpu) = view_gpu {
        encode_coverage(&mut pass, &gpu.rainfall, view_gpu, msaa.samples());
    }
    drop(pass);
    if let Some(bind_group) = gpu.mask_bind_groups.get(&entity) {
        gpu.masks.encode(
            ctx.command_encoder(),
            bind_group,
            MaskTargets {
                wet: &wet_mask.texture_view,
                depth: &depth_mask.texture_view,
                water: &water_mask.texture_view,
            },
        );
    }
    report.recorded(PassName::Masks);
}
