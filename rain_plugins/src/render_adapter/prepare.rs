//! Uploads and bind groups, once a frame.

use std::collections::HashMap;
use std::sync::atomic::Ordering::Relaxed;

use bevy::core_pipeline::prepass::ViewPrepassTextures;
use bevy::math::{DVec3, Mat4, Vec3, Vec3Swizzles as _};
use bevy::prelude::*;
use bevy::render::camera::ExtractedCamera;
use bevy::render::render_asset::RenderAssets;
use bevy::render::renderer::{RenderDevice, RenderQueue};
use bevy::render::storage::GpuShaderBuffer;
use bevy::render::sync_world::MainEntity;
use bevy::render::texture::GpuImage;
use bevy::render::view::{ExtractedView, Msaa};
use rain_render::caustics::CausticsGpu;
use rain_render::compose;
use rain_render::cover::{CoverPlacement, open_sky};
use rain_render::gpu_types::{CoverParams, LevelMapParams, ReflectionParams, SurfaceParams, WaterMapPlaces};
use rain_render::masks::{GroundMaps, MaskGpu, known_texture};
use rain_render::rainfall::{
    Drops, Lighting, RainfallGpu, RainfallInput, RainfallTextures, RainfallViewGpu, StreakDraws,
};
use rain_render::reflection::{ReflectionMipsGpu, ReflectionMipsTarget};
use rain_render::ring_layers::{RingLayerGpu, RingLayersGpu};
use rain_render::slope_mips::SlopeMipsGpu;
use rain_render::water_map::{WaterMapGpu, WaterMapInput, WaterMapPasses};
use rain_render::waves::{WaveTileGpu, WavesGpu};

use super::extract::{ExtractedMap, ExtractedRainScene, ExtractedRainView, ExtractedSurface, ExtractedWaves};
use super::far_rain::FarRainViews;
use super::haze::HazeViews;
use super::lattice::LatticeViews;
use super::lens::LensViews;
use super::splash::SplashViews;
use crate::report::RainReport;
use crate::surface::RainMaskView;

/// Everything on the GPU that lives with the device; rebuilt after a device loss.
#[derive(Resource)]
pub(super) struct RainGpu {
    pub rainfall: RainfallGpu,
    pub views: HashMap<Entity, RainfallViewGpu>,
    pub masks: MaskGpu,
    pub mask_bind_groups: HashMap<Entity, wgpu::BindGroup>,
    /// What wet materials know of the pixels of views with masks, by the view in the main world.
    pub known: HashMap<Entity, wgpu::Texture>,
    pub reflection: ReflectionMipsGpu,
    /// The layers of the texture that mirrored views are kept in, and that texture.
    pub reflection_layers: Vec<ReflectionMipsTarget>,
    reflection_kept: Option<wgpu::Texture>,
    pub slope_mips: SlopeMipsGpu,
    pub waves: WavesGpu,
    pub ripple_tile: Option<WaveTileGpu>,
    pub wave_tile: Option<WaveTileGpu>,
    /// Light that water throws; made when it first does.
    pub caustics: Option<CausticsGpu>,
    pub ring_layers: RingLayersGpu,
    pub ring_layer_tile: Option<RingLayerGpu>,
    pub map_passes: WaterMapPasses,
    pub water_map: Option<WaterMapGpu>,
    /// Where the cover map was drawn last: what its texture shows before this frame draws it anew.
    cover_drawn: Option<CoverPlacement>,
    /// Which levels of standing water the texture holds.
    levels_version: Option<u64>,
    /// Which films of the ground.
    films_version: Option<u64>,
}

impl FromWorld for RainGpu {
    fn from_world(world: &mut World) -> Self {
        // On a new device the kept map is empty: it has to be drawn again.
        let scene = world.get_resource::<ExtractedRainScene>();
        if let Some(cover) = scene.and_then(|s| s.cover.as_ref()) {
            cover.complete.store(false, Relaxed);
        }
        let lost = scene.is_some();
        if let Some(mut waves) = world.get_resource_mut::<ExtractedWaves>() {
            waves.lost |= lost;
        }
        if let Some(mut map) = world.get_resource_mut::<ExtractedMap>() {
            map.lost |= lost;
        }
        let device = world.resource::<RenderDevice>().wgpu_device();
        Self {
            rainfall: RainfallGpu::new(device),
            views: HashMap::new(),
            masks: MaskGpu::new(device),
            mask_bind_groups: HashMap::new(),
            known: HashMap::new(),
            reflection: ReflectionMipsGpu::new(device),
            reflection_layers: Vec::new(),
            reflection_kept: None,
            slope_mips: SlopeMipsGpu::new(device),
            waves: WavesGpu::new(device),
            ripple_tile: None,
            wave_tile: None,
            caustics: None,
            ring_layers: RingLayersGpu::new(device),
            ring_layer_tile: None,
            map_passes: WaterMapPasses::new(device),
            water_map: None,
            cover_drawn: None,
            levels_version: None,
            films_version: None,
        }
    }
}

/// All levels of a texture. Units: bytes.
fn texture_bytes(texture: &wgpu::Texture) -> usize {
    let texel = texture.format().block_copy_size(None).unwrap_or(4) as usize;
    let level = |i: u32| (texture.width() >> i).max(1) as usize * (texture.height() >> i).max(1) as usize;
    (0..texture.mip_level_count()).map(level).sum::<usize>() * texel * texture.depth_or_array_layers() as usize
}

/// Writes one texel for each cell, row after row, if there are as many.
fn upload_cells<T: bytemuck::Pod>(queue: &RenderQueue, texture: &wgpu::Texture, cells: UVec2, texels: &[T]) {
    if texels.is_empty() || texels.len() != cells.element_product() as usize {
        return;
    }
    queue.write_texture(
        texture.as_image_copy(),
        bytemuck::cast_slice(texels),
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(size_of::<T>() as u32 * cells.x),
            rows_per_image: None,
        },
        wgpu::Extent3d {
            width: cells.x,
            height: cells.y,
            depth_or_array_layers: 1,
        },
    );
}

/// Uploads levels and films that have changed.
fn prepare_ground(gpu: &mut RainGpu, queue: &RenderQueue, images: &RenderAssets<GpuImage>, surface: &ExtractedSurface) {
    let (Some(ids), Some(levels)) = (surface.images, &surface.levels) else {
        return;
    };
    if gpu.levels_version != Some(levels.version())
        && let Some(image) = images.get(ids.levels)
    {
        upload_cells(queue, &image.texture, levels.cells, levels.levels_m());
        gpu.levels_version = Some(levels.version());
    }
    if gpu.films_version != Some(surface.films.version)
        && let Some(image) = images.get(ids.films)
    {
        upload_cells(queue, &image.texture, levels.cells, &surface.films.texels);
        gpu.films_version = Some(surface.films.version);
    }
}

/// Uploads this frame's rings and waves.
fn prepare_waves(
    gpu: &mut RainGpu,
    device: &wgpu::Device,
    queue: &RenderQueue,
    images: &RenderAssets<GpuImage>,
    scene: &ExtractedRainScene,
    waves: &ExtractedWaves,
) {
    let Some(ids) = scene.surface.as_ref().and_then(|s| s.images) else {
        return;
    };
    for (slot, id, work) in [
        (&mut gpu.ripple_tile, ids.ripples, &waves.ripples),
        (&mut gpu.wave_tile, ids.waves, &waves.waves),
    ] {
        let Some(image) = images.get(id).filter(|_| work.wanted) else {
            continue;
        };
        if let Some(frame) = &work.layers {
            let tile = gpu.ring_layer_tile.get_or_insert_with(|| RingLayerGpu::new(device));
            tile.prepare(device, queue, &gpu.ring_layers, &gpu.slope_mips, &image.texture, frame);
            continue;
        }
        let tile = slot.get_or_insert_with(|| WaveTileGpu::new(device, &gpu.waves, &gpu.slope_mips, &image.texture));
        tile.prepare(device, queue, &gpu.waves, &work.frame);
    }
    let thrown = waves.thrown.frame.filter(|_| waves.thrown.wanted);
    if let (Some(frame), Some(slopes), Some(map)) = (
        thrown,
        images.get(ids.ripples),
        ids.caustics.and_then(|id| images.get(id)),
    ) {
        let caustics = gpu.caustics.get_or_insert_with(|| CausticsGpu::new(device));
        caustics.prepare(device, queue, &slopes.texture, &map.texture, &frame);
    }
}

/// Uploads this frame's work on the water map.
fn prepare_map(
    gpu: &mut RainGpu,
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    images: &RenderAssets<GpuImage>,
    scene: &ExtractedRainScene,
    map: &mut ExtractedMap,
) {
    // The pass runs before a map of what covers that this frame draws anew.
    let before = gpu.cover_drawn;
    let cover = scene.cover.as_ref();
    gpu.cover_drawn = cover.and_then(|c| c.placement);
    let placement = cover.and_then(|c| if c.redraw { before } else { c.placement });
    let ids = scene.surface.as_ref().and_then(|s| s.images);
    let (Some(ids), Some(place), true) = (ids, map.place, map.work.wanted) else {
        return;
    };
    let Some(image) = images.get(ids.map) else {
        // Not made yet: the host starts anew.
        (map.lost, map.work.wanted, map.place) = (true, false, None);
        return;
    };
    let tile = gpu
        .water_map
        .get_or_insert_with(|| WaterMapGpu::new(device, &gpu.map_passes, place.settings(), &image.texture));
    let cover_map = cover.and_then(|c| images.get(c.image)).filter(|_| placement.is_some());
    let origin = map.work.frame.origin_m();
    let input = WaterMapInput {
        cover: placement.map_or_else(open_sky, |placement| placement.params(origin)),
        cover_map: cover_map.map(|i| -> &wgpu::TextureView { &i.texture_view }),
        levels: images
            .get(ids.levels)
            .map(|i| -> &wgpu::TextureView { &i.texture_view }),
    };
    tile.prepare(device, queue, &gpu.map_passes, &map.work.frame, &input);
}

/// Where the levels of standing water lie, relative to an eye.
pub(super) fn level_params(surface: &ExtractedSurface, eye: DVec3) -> LevelMapParams {
    surface
        .levels
        .as_ref()
        .map_or_else(LevelMapParams::default, |l| LevelMapParams {
            corner: (l.corner_m - eye.xz()).as_vec2().to_array(),
            inverse_cell: (1.0 / l.cell_m) as f32,
            base: (l.base_m - eye.y) as f32,
            cells: l.cells.as_vec2().to_array(),
            present: f32::from(u8::from(l.any_water())),
            films: f32::from(u8::from(surface.films.texels.len() == l.levels_m().len())),
        })
}

/// The light around a view with this exposure; `environment` is its map and the map's scale.
pub(super) fn view_lighting(
    scene: &ExtractedRainScene,
    environment: Option<(&GpuImage, f32)>,
    exposure: f32,
) -> Lighting {
    Lighting {
        environment_scale: environment.map_or(0.0, |(_, scale)| scale * exposure),
        environment_max_level: environment.map_or(0.0, |(image, _)| {
            image.texture_descriptor.mip_level_count.saturating_sub(1) as f32
        }),
        ambient: scene.ambient * exposure,
        sun_direction: scene.sun_direction,
        sun: scene.sun * exposure,
    }
}

/// What wet materials read, relative to an eye.
fn surface_params(
    surface: Option<&ExtractedSurface>,
    waves: &ExtractedWaves,
    map: &ExtractedMap,
    cover: CoverParams,
    eye: Vec3,
) -> SurfaceParams {
    let Some(surface) = surface else {
        return SurfaceParams {
            cover,
            ..bytemuck::Zeroable::zeroed()
        };
    };
    let origin = eye.as_dvec3();
    let levels = level_params(surface, origin);
    let mirrors = surface.mirrors.views.map(|view| {
        view.map_or_else(ReflectionParams::default, |view| ReflectionParams {
            clip_from_eye: view.clip_from(eye).to_cols_array_2d(),
            eye: view.eye.extend(surface.mirror_strength).to_array(),
            plane: [view.height - eye.y, view.forward.x, view.forward.y, view.forward.z],
        })
    });
    let mut water = surface.water;
    let wind_tile_m = compose::WIND_TILE / f64::from(water.ambient[1]);
    let place = (origin.xz() / wind_tile_m).fract_gl().as_vec2();
    water.place[..2].copy_from_slice(&place.to_array());
    if waves.ripple_side_m > 0.0 {
        let place = (origin.xz() / waves.ripple_side_m).fract_gl().as_vec2();
        water.ripples = [(1.0 / waves.ripple_side_m) as f32, place.x, place.y, 1.0];
    }
    if let Some((corner, side)) = waves.wave_tile_m {
        let corner = (corner - origin.xz()).as_vec2();
        water.waves = [corner.x, corner.y, (1.0 / side) as f32, 1.0];
    }
    if let Some(maps) = &surface.maps {
        for (look, map) in [&mut water.map, &mut water.more_map].into_iter().zip(maps) {
            let place = (origin.xz() * map.per_m + map.at).fract_gl().as_vec2();
            look[..3].copy_from_slice(&[map.per_m as f32, place.x, place.y]);
        }
    }
    let thrown = waves.thrown.frame.map(|frame| frame.towards.extend(waves.thrown.gain));
    SurfaceParams {
        caustics: thrown.unwrap_or_default().to_array(),
        eye: eye.extend(surface.time_s).to_array(),
        state: surface.state.to_array(),
        artist: surface.artist.to_array(),
        cover,
        levels,
        water,
        mirrors,
        map: map
            .place
            .map_or_else(WaterMapPlaces::default, |place| place.seen_from(origin.xz().to_array())),
    }
}

/// The texture that keeps what wet materials know of a view's pixels, if they are asked this frame.
fn known_of(
    known: &mut HashMap<Entity, wgpu::Texture>,
    device: &wgpu::Device,
    view: &ExtractedView,
    main: Entity,
    mask_views: &Query<&RainMaskView, With<ExtractedView>>,
) -> Option<wgpu::TextureView> {
    mask_views.iter().find(|own| own.of == main)?;
    let size = [view.viewport.z, view.viewport.w];
    let texture = known.entry(main).or_insert_with(|| known_texture(device, size));
    if [texture.width(), texture.height()] != size {
        *texture = known_texture(device, size);
    }
    Some(texture.create_view(&wgpu::TextureViewDescriptor::default()))
}

pub(super) fn prepare_rain(
    mut gpu: ResMut<RainGpu>,
    scene: Option<Res<ExtractedRainScene>>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    images: Res<RenderAssets<GpuImage>>,
    buffers: Res<RenderAssets<GpuShaderBuffer>>,
    report: Res<RainReport>,
    (splashes, hazes, far_rain, cards, lenses): (
        Res<SplashViews>,
        Res<HazeViews>,
        Res<FarRainViews>,
        Res<LatticeViews>,
        Res<LensViews>,
    ),
    waves: Res<ExtractedWaves>,
    mut map: ResMut<ExtractedMap>,
    views: Query<(
        (Entity, &MainEntity),
        &ExtractedView,
        &ExtractedCamera,
        &ExtractedRainView,
        Option<&ViewPrepassTextures>,
        &Msaa,
    )>,
    mask_views: Query<&RainMaskView, With<ExtractedView>>,
) {
    let Some(scene) = scene else { return };
    let gpu = &mut *gpu;
    let device = device.wgpu_device();
    let cover = scene.cover.as_ref();
    let cover_image = cover.and_then(|c| images.get(c.image));
    let cover_at = |eye: DVec3| match (cover.and_then(|c| c.placement), cover_image) {
        (Some(placement), Some(_)) => placement.params(eye),
        _ => open_sky(),
    };
    prepare_map(gpu, device, &queue, &images, &scene, &mut map);
    let surface_params =
        |eye: Vec3| surface_params(scene.surface.as_ref(), &waves, &map, cover_at(eye.as_dvec3()), eye);
    if let Some(surface) = scene.surface.as_ref().filter(|s| s.shown) {
        prepare_ground(gpu, &queue, &images, surface);
    }
    if let Some(surface) = scene.surface.as_ref().filter(|s| s.shown)
        && let Some(buffer) = buffers.get(surface.buffer)
    {
        let params = surface_params(surface.anchor);
        queue.write_buffer(&buffer.buffer, 0, bytemuck::bytes_of(&params));
    }
    prepare_waves(gpu, device, &queue, &images, &scene, &waves);
    if let Some(kept) = scene
        .surface
        .as_ref()
        .and_then(|s| images.get(s.images.as_ref()?.reflection))
    {
        // It is made anew when more views ask for a mirror.
        let kept: &wgpu::Texture = &kept.texture;
        if gpu.reflection_kept.as_ref() != Some(kept) {
            gpu.reflection_layers = (0..kept.depth_or_array_layers())
                .map(|layer| gpu.reflection.bind(device, kept, layer))
                .collect();
            gpu.reflection_kept = Some(kept.clone());
        }
    }
    let ground_maps = scene
        .surface
        .as_ref()
        .filter(|s| s.shown)
        .and_then(|s| s.images)
        .map(|ids| [ids.films, ids.levels, ids.map].map(|id| images.get(id)))
        .and_then(|[films, levels, map]| Some((films?, levels?, map?)));
    let ground_maps = ground_maps.map(|(films, levels, map)| GroundMaps {
        films: &films.texture_view,
        levels: &levels.texture_view,
        map: &map.texture_view,
    });
    gpu.mask_bind_groups.clear();
    gpu.views.retain(|entity, _| views.contains(*entity));
    gpu.known.retain(|of, _| mask_views.iter().any(|view| view.of == *of));
    for ((entity, main), view, camera, rain, prepass, msaa) in &views {
        let eye = view.world_from_view.translation();
        let rotation = view.world_from_view.rotation();
        let scene_depth: Option<&wgpu::TextureView> = match (msaa, prepass.and_then(ViewPrepassTextures::depth_view)) {
            (Msaa::Off, Some(depth)) => Some(depth),
            _ => None,
        };
        let near = view.clip_from_view.w_axis.z;
        if let (Some(_), Some(depth), Some(cover)) = (&rain.masks, scene_depth, cover_image) {
            let clip_from_eye = view.clip_from_view * Mat4::from_quat(rotation.inverse());
            let known = known_of(&mut gpu.known, device, view, main.id(), &mask_views);
            let bind_group = gpu.masks.prepare(
                device,
                &queue,
                clip_from_eye.inverse(),
                near,
                view.viewport.as_vec4(),
                surface_params(eye),
                depth,
                &cover.texture_view,
                ground_maps,
                known.as_ref(),
            );
            gpu.mask_bind_groups.insert(entity, bind_group);
        }
        let (Some(shutter), Some(choice)) = (rain.shutter, &rain.choice) else {
            continue;
        };
        // Without perspective drops are placed from amid them, and neither their distance nor a way to the eye is told.
        let parallel = choice.view.parallel;
        let from = choice.view.eye_m.as_vec3();
        let panes = if parallel.is_some() {
            Vec::new()
        } else {
            rain.panes.seen_from(eye)
        };
        let soft_m = if scene_depth.is_some() && parallel.is_none() {
            shutter.soft_m
        } else {
            0.0
        };
        let draws = StreakDraws {
            coverage: rain.masks.is_some(),
            behind: !panes.is_empty(),
            soft: soft_m > 0.0,
            patterned: shutter.patterned,
        };
        gpu.rainfall
            .prepare_pipelines(device, view.target_format, msaa.samples(), draws);
        let environment = rain.environment.and_then(|(id, scale)| Some((images.get(id)?, scale)));
        let (now, before) = rain.motion.view_matrices(rotation, shutter.exposure_s);
        let lamps = rain.lamps.seen_from(from, camera.exposure);
        let moved = Mat4::from_translation(from - eye);
        let input = RainfallInput {
            drops: Drops::Chosen(choice),
            clip_from_eye: view.clip_from_view * now * moved,
            clip_from_eye_before: view.clip_from_view * before * moved,
            eye_height_m: from.y,
            eye_velocity_m_s: rain.motion.velocity_m_s.as_vec3(),
            viewport_px: Vec4::from_array(view.viewport.as_vec4().to_array()),
            focal_px: choice.view.focal_px as f32,
            parallel,
            near_m: if parallel.is_some() { 0.0 } else { near },
            shutter: rain_render::rainfall::Shutter { soft_m, ..shutter },
            lighting: view_lighting(&scene, environment, camera.exposure),
            lamps: &lamps,
            panes: &panes,
            cover: cover_at(choice.view.eye_m),
        };
        let textures = RainfallTextures {
            cover: cover_image.map(|i| -> &wgpu::TextureView { &i.texture_view }),
            scene_depth,
            environment: environment
                .as_ref()
                .map(|(i, _)| -> &wgpu::TextureView { &i.texture_view }),
        };
        let slot = gpu.views.entry(entity).or_insert_with(|| RainfallViewGpu::new(device));
        if !slot.prepare(device, &queue, &gpu.rainfall, &input, textures) {
            warn_once!("more rain areas are about a view than its drops can heed; the last are left out");
        }
    }
    let water = scene.surface.as_ref().and_then(|s| s.images);
    let water = water.iter().flat_map(|i| {
        [i.levels, i.films, i.map, i.ripples, i.waves, i.reflection]
            .into_iter()
            .chain(i.caustics)
    });
    let textures = water.chain(cover.map(|c| c.image)).filter_map(|id| images.get(id));
    let tiles = [&gpu.ripple_tile, &gpu.wave_tile].into_iter().flatten();
    report.gpu_memory(
        textures.map(|image| texture_bytes(&image.texture)).sum::<usize>()
            + tiles.map(|tile| tile.memory_bytes() as usize).sum::<usize>()
            + gpu
                .ring_layer_tile
                .as_ref()
                .map_or(0, |tile| tile.memory_bytes() as usize)
            + gpu
                .caustics
                .as_ref()
                .map_or(0, |caustics| caustics.memory_bytes() as usize)
            + gpu.water_map.as_ref().map_or(0, |map| map.memory_bytes() as usize)
            + gpu.views.values().map(RainfallViewGpu::memory_bytes).sum::<usize>()
            + splashes.memory_bytes()
            + hazes.memory_bytes()
            + far_rain.memory_bytes()
            + cards.memory_bytes()
            + lenses.memory_bytes(),
    );
}
