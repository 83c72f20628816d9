//! Cards of many drops: extraction, streak textures, uploads and commands of each view.

use std::collections::HashMap;
use std::sync::Arc;

use bevy::core_pipeline::prepass::ViewPrepassTextures;
use bevy::prelude::*;
use bevy::render::Extract;
use bevy::render::camera::ExtractedCamera;
use bevy::render::diagnostic::RecordDiagnostics;
use bevy::render::render_asset::RenderAssets;
use bevy::render::renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery};
use bevy::render::sync_world::RenderEntity;
use bevy::render::texture::GpuImage;
use bevy::render::view::{ExtractedView, Msaa, ViewDepthTexture, ViewTarget};
use rain_core::rainfall::{PackedStreaks, StreakTextureSettings};
use rain_render::cover::open_sky;
use rain_render::lattice::{
    LatticeGpu, LatticeInput, LatticeViewGpu, encode_lattice, encode_lattice_behind, encode_lattice_coverage,
};
use rain_render::rainfall::RainfallTextures;
use rain_render::streak_textures::{StreakArray, StreakTextureGpu, encode_streak_textures};

use super::after_blur::RainOrder;
use super::extract::{ExtractedRainScene, ExtractedRainView};
use super::prepare::view_lighting;
use super::record::{draw_within, over_scene};
use crate::rainfall::{CardShot, CardViewFrame, LatticeState};
use crate::report::{PassName, RainReport};

/// One camera that sees cards.
#[derive(Component, Clone)]
pub(super) struct ExtractedCardView(CardShot);

/// The pictures on the cards.
#[derive(Resource, Default)]
pub(super) struct ExtractedStreaks {
    settings: Option<Arc<StreakTextureSettings>>,
    /// From a folder.
    pictures: Option<Arc<PackedStreaks>>,
}

/// Everything of cards on the GPU that lives with the device.
#[derive(Resource)]
pub(super) struct LatticeViews {
    gpu: LatticeGpu,
    /// Made when pictures are.
    bake: Option<StreakTextureGpu>,
    streaks: Option<StreakArray>,
    views: HashMap<Entity, LatticeViewGpu>,
}

impl FromWorld for LatticeViews {
    fn from_world(world: &mut World) -> Self {
        let device = world.resource::<RenderDevice>().wgpu_device();
        Self {
            gpu: LatticeGpu::new(device),
            bake: None,
            streaks: None,
            views: HashMap::new(),
        }
    }
}

impl LatticeViews {
    /// GPU memory of the textures and of all views. Units: bytes.
    pub(super) fn memory_bytes(&self) -> usize {
        self.views.values().map(LatticeViewGpu::memory_bytes).sum::<usize>()
            + self.streaks.as_ref().map_or(0, StreakArray::memory_bytes)
    }

    /// What a view's cards cover, into its mask; nothing where it has none.
    pub(super) fn encode_coverage(&self, pass: &mut wgpu::RenderPass, view: Entity, samples: u32) {
        if let Some(view) = self.views.get(&view) {
            encode_lattice_coverage(pass, &self.gpu, view, samples);
        }
    }

    /// Follows the settings of the pictures.
    fn follow(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, wanted: &ExtractedStreaks) {
        let Some(settings) = &wanted.settings else { return };
        if self
            .streaks
            .as_ref()
            .is_some_and(|streaks| streaks.key() == settings.key())
        {
            return;
        }
        let made = match &wanted.pictures {
            Some(pictures) => StreakArray::upload(device, queue, pictures),
            None => {
                let bake = self.bake.get_or_insert_with(|| StreakTextureGpu::new(device));
                StreakArray::new(device, queue, bake, settings)
            }
        };
        match made {
            Ok(array) => self.streaks = Some(array),
            // The plan of the same settings has been made: they are good.
            Err(error) => error!("streak textures: {error}"),
        }
    }
}

pub(super) fn extract_cards(
    mut commands: Commands,
    lattice: Extract<Option<Res<LatticeState>>>,
    mut streaks: ResMut<ExtractedStreaks>,
    views: Extract<Query<(RenderEntity, &CardViewFrame, &Camera)>>,
) {
    if let Some(lattice) = lattice.as_ref() {
        streaks.settings.clone_from(&lattice.textures);
        streaks.pictures.clone_from(&lattice.pictures);
    }
    for (entity, frame, camera) in &views {
        let mut entity = commands.entity(entity);
        match frame.shot.as_ref().filter(|_| camera.is_active) {
            Some(shot) => entity.insert(ExtractedCardView(shot.clone())),
            None => entity.remove::<ExtractedCardView>(),
        };
    }
}

pub(super) fn prepare_cards(
    mut lattice: ResMut<LatticeViews>,
    wanted: Res<ExtractedStreaks>,
    scene: Option<Res<ExtractedRainScene>>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    images: Res<RenderAssets<GpuImage>>,
    views: Query<(
        Entity,
        &ExtractedView,
        &ExtractedCamera,
        &ExtractedCardView,
        &ExtractedRainView,
        Option<&ViewPrepassTextures>,
        &Msaa,
    )>,
) {
    let Some(scene) = scene else { return };
    let lattice = &mut *lattice;
    let device = device.wgpu_device();
    lattice.views.retain(|entity, _| views.contains(*entity));
    if views.is_empty() {
        return;
    }
    lattice.follow(device, &queue, &wanted);
    let Some(streaks) = &lattice.streaks else { return };
    let cover = scene.cover.as_ref();
    let cover_image = cover.and_then(|c| images.get(c.image));
    for (entity, view, camera, ExtractedCardView(shot), rain, prepass, msaa) in &views {
        let eye = view.world_from_view.translation().as_dvec3();
        let rotation = view.world_from_view.rotation();
        let scene_depth: Option<&wgpu::TextureView> = match (msaa, prepass.and_then(ViewPrepassTextures::depth_view)) {
            (Msaa::Off, Some(depth)) => Some(depth),
            _ => None,
        };
        let environment = rain.environment.and_then(|(id, scale)| Some((images.get(id)?, scale)));
        let panes = rain.panes.seen_from(view.world_from_view.translation());
        lattice.gpu.prepare_pipelines(
            device,
            view.target_format,
            msaa.samples(),
            rain.masks.is_some(),
            !panes.is_empty(),
        );
        let lamps = rain
            .lamps
            .seen_from(view.world_from_view.translation(), camera.exposure);
        let input = LatticeInput {
            cards: &shot.cards,
            clip_from_eye: view.clip_from_view * Mat4::from_quat(rotation.inverse()),
            near_m: view.clip_from_view.w_axis.z,
            contrast: shot.contrast,
            lighting: view_lighting(&scene, environment, camera.exposure),
            fog: Vec3::ZERO,
            lamps: &lamps,
            panes: &panes,
            cover: match (cover.and_then(|c| c.placement), cover_image) {
                (Some(placement), Some(_)) => placement.params(eye),
                _ => open_sky(),
            },
        };
        let textures = RainfallTextures {
            cover: cover_image.map(|i| -> &wgpu::TextureView { &i.texture_view }),
            scene_depth,
            environment: environment.map(|(i, _)| -> &wgpu::TextureView { &i.texture_view }),
        };
        let slot = lattice
            .views
            .entry(entity)
            .or_insert_with(|| LatticeViewGpu::new(device));
        slot.prepare(device, &queue, &lattice.gpu, &input, streaks, textures);
    }
}

/// Makes the pictures on the cards, before any view is drawn: once.
pub(super) fn streak_textures(mut lattice: ResMut<LatticeViews>, report: Res<RainReport>, mut ctx: RenderContext) {
    let lattice = &mut *lattice;
    let streaks = lattice.streaks.as_mut().filter(|streaks| streaks.wants_pass());
    let (Some(streaks), Some(bake)) = (streaks, &lattice.bake) else {
        return;
    };
    if encode_streak_textures(ctx.command_encoder(), bake, streaks) {
        report.recorded(PassName::StreakTextures);
    }
}

/// Draws a view's cards behind glass, before what is transparent.
pub(super) fn lattice_behind_glass(
    view: ViewQuery<(
        Entity,
        &ExtractedView,
        &ExtractedCardView,
        &ViewTarget,
        &ViewDepthTexture,
        &Msaa,
    )>,
    lattice: Res<LatticeViews>,
    mut ctx: RenderContext,
) {
    let (entity, view, _, target, depth, msaa) = view.into_inner();
    let of_view = lattice.views.get(&entity);
    let Some(view_gpu) = of_view.filter(|view| view.cards() > 0 && view.panes() > 0) else {
        return;
    };
    let colour = target.get_color_attachment();
    let mut pass = over_scene(ctx.command_encoder(), "rain_lattice_behind_glass", colour, depth);
    draw_within(&mut pass, view.viewport);
    encode_lattice_behind(&mut pass, &lattice.gpu, view_gpu, view.target_format, msaa.samples());
}

/// Draws a view's cards over its colour target, but those behind glass. What single streaks cover comes after. Once for views
/// whose rain comes after blur, once for the others.
pub(super) fn lattice<const AFTER_BLUR: bool>(
    view: ViewQuery<(
        Entity,
        &ExtractedView,
        &ExtractedCardView,
        &ViewTarget,
        &ViewDepthTexture,
        &Msaa,
        RainOrder,
    )>,
    lattice: Res<LatticeViews>,
    report: Res<RainReport>,
    mut ctx: RenderContext,
) {
    let (entity, view, _, target, depth, msaa, order) = view.into_inner();
    let in_order = order.is_after_blur() == AFTER_BLUR;
    let of_view = lattice.views.get(&entity);
    let Some(view_gpu) = of_view.filter(|view| in_order && view.cards() > 0) else {
        return;
    };
    let recorder = ctx.diagnostic_recorder();
    let recorder = recorder.as_deref();
    let mut pass = over_scene(
        ctx.command_encoder(),
        "rain_lattice",
        target.get_color_attachment(),
        depth,
    );
    let span = recorder.pass_span(&mut pass, "rain_lattice");
    draw_within(&mut pass, view.viewport);
    encode_lattice(&mut pass, &lattice.gpu, view_gpu, view.target_format, msaa.samples());
    span.end(&mut pass);
    drop(pass);
    report.recorded(PassName::Lattice);
    report.cards(view_gpu.cards());
}
