//! Haze: extraction, uploads and commands of each view.

use std::collections::HashMap;

use bevy::light::EnvironmentMapLight;
use bevy::math::{Mat3, Mat4, Vec4};
use bevy::pbr::AtmosphereSettings;
use bevy::prelude::*;
use bevy::render::Extract;
use bevy::render::camera::ExtractedCamera;
use bevy::render::diagnostic::RecordDiagnostics;
use bevy::render::render_asset::RenderAssets;
use bevy::render::renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery};
use bevy::render::sync_world::RenderEntity;
use bevy::render::texture::GpuImage;
use bevy::render::view::{ExtractedView, Msaa, ViewDepthTexture, ViewTarget};
use rain_core::rainfall::Lamp;
use rain_render::haze::{
    HazeAreas, HazeBow, HazeGpu, HazeInput, HazeSplash, HazeTextures, HazeViewGpu, encode_haze, encode_haze_areas,
    encode_haze_coverage,
};

use super::extract::ExtractedRainScene;
use super::prepare::view_lighting;
use super::record::{cleared, draw_within};
use crate::haze::{HazeMask, HazeShot, HazeSky, HazeViewFrame};
use crate::report::{PassName, RainReport};

/// A lamp whose intensity times extinction (exposed) is less glows by less than the darkest 8-bit step (3e-4) half a metre
/// from it, at most half of that over the distance and Q.
const LEAST_GLOW: f32 = 6e-4;

/// One camera that sees haze.
#[derive(Component, Clone)]
pub(super) struct ExtractedHazeView {
    shot: Option<HazeShot>,
    mask: Option<Handle<Image>>,
    /// Prefiltered cube map and its scale to cd/m².
    pub(super) environment: Option<(AssetId<Image>, f32)>,
    /// Bevy's atmosphere draws its sky at a moment that nobody else can name: haze then comes after what is transparent.
    over_sky: bool,
}

/// Everything of haze on the GPU that lives with the device.
#[derive(Resource)]
pub(super) struct HazeViews {
    gpu: HazeGpu,
    views: HashMap<Entity, HazeViewGpu>,
}

impl FromWorld for HazeViews {
    fn from_world(world: &mut World) -> Self {
        Self {
            gpu: HazeGpu::new(world.resource::<RenderDevice>().wgpu_device()),
            views: HashMap::new(),
        }
    }
}

impl HazeViews {
    /// GPU memory of all views. Units: bytes.
    pub(super) fn memory_bytes(&self) -> usize {
        self.views.values().map(HazeViewGpu::memory_bytes).sum()
    }
}

pub(super) fn extract_haze(
    mut commands: Commands,
    views: Extract<
        Query<(
            RenderEntity,
            &HazeViewFrame,
            &Camera,
            Option<&HazeMask>,
            Option<&EnvironmentMapLight>,
            Option<&HazeSky>,
            Has<AtmosphereSettings>,
        )>,
    >,
) {
    for (entity, frame, camera, mask, environment, sky, over_sky) in &views {
        let mut entity = commands.entity(entity);
        if !camera.is_active {
            entity.remove::<ExtractedHazeView>();
            continue;
        }
        entity.insert(ExtractedHazeView {
            shot: frame.shot.clone(),
            mask: mask.map(|mask| mask.0.clone()),
            environment: sky
                .map(|s| (s.specular_map.id(), s.intensity))
                .or(environment.map(|e| (e.specular_map.id(), e.intensity))),
            over_sky,
        });
    }
}

pub(super) fn prepare_haze(
    mut hazes: ResMut<HazeViews>,
    scene: Option<Res<ExtractedRainScene>>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    images: Res<RenderAssets<GpuImage>>,
    views: Query<(
        Entity,
        &ExtractedView,
        &ExtractedCamera,
        &ExtractedHazeView,
        &ViewDepthTexture,
        &Msaa,
    )>,
) {
    let Some(scene) = scene else { return };
    let hazes = &mut *hazes;
    let device = device.wgpu_device();
    let cover = scene.cover.as_ref();
    let cover_image = cover.and_then(|c| images.get(c.image));
    hazes.views.retain(|entity, _| views.contains(*entity));
    for (entity, view, camera, haze, depth, msaa) in &views {
        let Some(shot) = &haze.shot else { continue };
        let samples = msaa.samples();
        hazes.gpu.prepare_pipelines(
            device,
            view.target_format,
            samples,
            haze.mask.is_some(),
            shot.splash.is_some(),
        );
        let environment = haze.environment.and_then(|(id, scale)| Some((images.get(id)?, scale)));
        // In the heaviest rain of the view; what does not show there shows nowhere.
        let densest = shot.rates.ln_per_m.last().map_or(0.0, |ln| ln.exp());
        let extinction = if shot.areas.is_some() {
            densest
        } else {
            shot.extinction_per_m
        } + shot.mist_per_m;
        let exposed = |lamp: &Lamp| Lamp {
            intensity: lamp.intensity * camera.exposure,
            ..*lamp
        };
        let lamps: Vec<Lamp> = shot
            .lamps
            .iter()
            .map(exposed)
            .filter(|lamp| lamp.intensity.max_element() * extinction > LEAST_GLOW)
            .collect();
        // With the mirror, if it is one.
        let turned = Mat3::from(view.world_from_view.affine().matrix3);
        let input = HazeInput {
            clip_from_eye: view.clip_from_view * Mat4::from_mat3(turned.inverse()),
            forward: shot.forward,
            viewport_px: Vec4::from_array(view.viewport.as_vec4().to_array()),
            lighting: view_lighting(&scene, environment, camera.exposure),
            extinction_per_m: shot.extinction_per_m,
            efficiency: shot.efficiency,
            drawn_m: shot.drawn_m,
            rates: &shot.rates,
            areas: shot.areas.as_ref().map(|(packed, weather)| HazeAreas {
                packed,
                weather_mm_h: *weather,
            }),
            far: shot.far,
            cloud_m: shot.cloud_m,
            thin_m: shot.thin_m,
            limit_m: shot.limit_m,
            fog: shot.fog,
            mist_per_m: shot.mist_per_m,
            mirror_m: shot.mirror_m,
            bow: shot.bow.as_ref().map(|bow| HazeBow {
                phase: &bow.phase,
                strength: bow.strength,
            }),
            splash: shot.splash.and_then(|layers| {
                // Without a map what rain hits is not known.
                let placement = cover.and_then(|c| c.placement).filter(|_| cover_image.is_some())?;
                let eye = view.world_from_view.translation().as_dvec3();
                Some(HazeSplash {
                    mist: layers,
                    cover: placement.params(eye),
                })
            }),
            lamps: &lamps,
        };
        let textures = HazeTextures {
            scene_depth: depth.view(),
            environment: environment.map(|(i, _)| -> &wgpu::TextureView { &i.texture_view }),
            cover: cover_image
                .filter(|_| shot.splash.is_some())
                .map(|i| -> &wgpu::TextureView { &i.texture_view }),
        };
        let slot = hazes.views.entry(entity).or_insert_with(|| HazeViewGpu::new(device));
        slot.prepare(device, &queue, &hazes.gpu, &input, textures, samples);
    }
}

type HazeView = (
    Entity,
    &'static ExtractedView,
    &'static ExtractedHazeView,
    &'static ViewTarget,
    &'static Msaa,
);

/// Haze behind what is transparent: a pane near the eye is not veiled by the rain behind it.
pub(super) fn haze_behind_glass(
    view: ViewQuery<HazeView>,
    hazes: Res<HazeViews>,
    images: Res<RenderAssets<GpuImage>>,
    report: Res<RainReport>,
    mut ctx: RenderContext,
) {
    let view = view.into_inner();
    if !view.2.over_sky {
        draw(view, &hazes, &images, &report, &mut ctx);
    }
}

/// Haze over everything, in views of Bevy's atmosphere.
pub(super) fn haze_over_sky(
    view: ViewQuery<HazeView>,
    hazes: Res<HazeViews>,
    images: Res<RenderAssets<GpuImage>>,
    report: Res<RainReport>,
    mut ctx: RenderContext,
) {
    let view = view.into_inner();
    if view.2.over_sky {
        draw(view, &hazes, &images, &report, &mut ctx);
    }
}

fn draw(
    (entity, view, haze, target, msaa): (Entity, &ExtractedView, &ExtractedHazeView, &ViewTarget, &Msaa),
    hazes: &HazeViews,
    images: &RenderAssets<GpuImage>,
    report: &RainReport,
    ctx: &mut RenderContext,
) {
    let view_gpu = hazes.views.get(&entity).filter(|_| haze.shot.is_some());
    let recorder = ctx.diagnostic_recorder();
    let recorder = recorder.as_deref();
    if let Some(view_gpu) = view_gpu {
        if view_gpu.uneven() {
            let mut pass = ctx.command_encoder().begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("rain_haze_areas"),
                timestamp_writes: None,
            });
            let span = recorder.pass_span(&mut pass, "rain_haze_areas");
            encode_haze_areas(&mut pass, &hazes.gpu, view_gpu);
            span.end(&mut pass);
        }
        let mut pass = over_colour(ctx.command_encoder(), "rain_haze", target.get_color_attachment());
        let span = recorder.pass_span(&mut pass, "rain_haze");
        draw_within(&mut pass, view.viewport);
        encode_haze(&mut pass, &hazes.gpu, view_gpu, view.target_format, msaa.samples());
        span.end(&mut pass);
        drop(pass);
        report.recorded(PassName::Haze);
    }
    let mask = haze.mask.as_ref().and_then(|mask| images.get(mask));
    let Some(mask) = mask.filter(|_| *msaa == Msaa::Off) else {
        return;
    };
    let mut pass = over_colour(ctx.command_encoder(), "rain_mask_haze", cleared(&mask.texture_view));
    if let Some(view_gpu) = view_gpu {
        draw_within(&mut pass, view.viewport);
        encode_haze_coverage(&mut pass, &hazes.gpu, view_gpu);
    }
}

/// A pass without depth: the shader reads it.
fn over_colour<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    label: &str,
    colour: wgpu::RenderPassColorAttachment,
) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &[Some(colour)],
        depth_stencil_attachment: None,
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    })
}
