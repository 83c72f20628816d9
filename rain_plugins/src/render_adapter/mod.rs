//! The only module that names Bevy's render internals: main world → render world → `rain_render`'s passes.
//!
//! | file | job |
//! |---|---|
//! | `extract.rs` | main world → render world, plain data |
//! | `prepare.rs` | uploads and bind groups, once a frame |
//! | `record.rs` | commands, once a view |
//! | `after_blur.rs` | which views draw their rain after anti-aliasing over frames and motion blur |
//! | `haze.rs` | all three for haze |
//! | `far_rain.rs` | all three for far rain |
//! | `lattice.rs` | all three for cards and their streak textures |
//! | `lightning.rs` | the material of lightning |
//! | `counts.rs` | what the GPU counted, read back |
//! | `splash.rs` | all three for splashes |
//! | `wave_levels.rs` | heights of waves, read back for snapshots |
//! | `wet_material.rs` | the extension of `StandardMaterial` that gets wet |

mod after_blur;
mod counts;
mod extract;
mod far_rain;
mod haze;
mod lattice;
mod lens;
mod lightning;
mod prepare;
mod record;
mod splash;
mod wave_levels;
mod wet_material;

use bevy::asset::RenderAssetUsages;
use bevy::camera::{Exposure, Hdr, RenderTarget, SubCameraView};
use bevy::core_pipeline::Core3dSystems;
use bevy::core_pipeline::core_3d::{main_opaque_pass_3d, main_transparent_pass_3d};
use bevy::core_pipeline::oit::resolve::node::oit_resolve;
pub(crate) use bevy::core_pipeline::prepass::{DeferredPrepass, DepthPrepass};
use bevy::core_pipeline::schedule::{Core3d, camera_driver};
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::image::{Image, ImageAddressMode, ImageSampler, ImageSamplerDescriptor};
use bevy::pbr::main_transmissive_pass_3d;
use bevy::post_process::bloom::bloom;
use bevy::post_process::motion_blur::motion_blur;
use bevy::prelude::*;
pub(crate) use bevy::render::RenderApp;
use bevy::render::extract_component::{ExtractComponent, ExtractComponentPlugin};
use bevy::render::render_resource::{
    Extent3d, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages, TextureViewDescriptor,
    TextureViewDimension,
};
use bevy::render::renderer::RenderAdapterInfo;
use bevy::render::renderer::RenderGraph;
use bevy::render::sync_component::SyncComponent;
use bevy::render::{ExtractSchedule, GpuResourceAppExt, Render, RenderSystems};

use rain_core::waves::CAUSTIC_TEXELS;
use rain_render::caustics::CAUSTIC_FORMAT;
use rain_render::masks::KNOWN_FORMAT;
use rain_render::reflection::REFLECTION_FORMAT;
use rain_render::water_map::WaterMapSettings;

pub(crate) use lightning::LightningMaterial;
pub(crate) use wave_levels::WaveLevels;
pub use wet_material::{WetMaterial, WetSurface, WetSurfaceHandles};

use crate::cover::RainCoverView;
use crate::rainfall::SoftwareAdapter;
use crate::report::RainReport;
use crate::surface::{RainMaskView, RainMirrorView};

/// Images that receive measurement masks of a view; put on a camera with [`crate::rainfall::RainView`],
/// `DepthPrepass` and `Msaa::Off`. Made with [`mask_image`].
#[derive(Component, Clone, Debug)]
pub struct RainMasks {
    /// Coverage by streaks (R16Float).
    pub rain: Handle<Image>,
    /// Pore saturation (R32Float): what wet materials show; of other things that of the weather where rain reaches.
    pub wet: Handle<Image>,
    /// Distance from the eye, m (R32Float).
    pub depth: Handle<Image>,
    /// Depth of standing water, m (R32Float): that of [`crate::surface::WaterLevels`] and, on wet materials, what artists
    /// placed.
    pub water: Handle<Image>,
}

/// Markers that cameras carry into the render world as they are.
macro_rules! extract_as_they_are {
    ($($marker:ty),*) => {$(
        impl SyncComponent for $marker {
            type Target = Self;
        }

        impl ExtractComponent for $marker {
            type QueryData = &'static Self;
            type QueryFilter = ();
            type Out = Self;

            fn extract_component(marker: &Self) -> Option<Self> {
                Some(*marker)
            }
        }
    )*};
}

extract_as_they_are!(RainMirrorView, RainMaskView, RainCoverView);

/// What has Bevy draw its own sky in a view, after what is opaque.
pub(crate) type DrawnSky = bevy::pbr::AtmosphereSettings;

/// Lets shaders read the depth of what a camera has drawn.
pub(crate) fn let_depth_be_read(camera: &mut Mut<Camera3d>) {
    let reading = TextureUsages::TEXTURE_BINDING.bits();
    if camera.depth_texture_usages.0 & reading == 0 {
        camera.depth_texture_usages.0 |= reading;
    }
}

/// An image without data for a GPU-only texture.
fn gpu_image(label: &'static str, width: u32, height: u32, format: TextureFormat, usage: TextureUsages) -> Image {
    Image {
        data: None,
        texture_descriptor: TextureDescriptor {
            label: Some(label),
            size: Extent3d {
                width,
                height,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        },
        asset_usage: RenderAssetUsages::RENDER_WORLD,
        ..default()
    }
}

/// The texture that keeps the cover map.
pub(crate) fn cover_image(texels: u32) -> Image {
    gpu_image(
        "rain cover",
        texels,
        texels,
        TextureFormat::Depth32Float,
        TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
    )
}

/// A single-precision texture of the levels of standing water.
pub(crate) fn level_image(texels: u32) -> Image {
    let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
    gpu_image("rain water levels", texels, texels, TextureFormat::R32Float, usage)
}

/// A half-precision texture of the ground's films.
pub(crate) fn film_image(texels: u32) -> Image {
    let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
    gpu_image("rain ground films", texels, texels, TextureFormat::Rgba16Float, usage)
}

/// A half-precision texture of the water map, sampled with repeat; of one texel where there is none.
pub(crate) fn map_image(settings: Option<WaterMapSettings>) -> Image {
    let descriptor = settings.unwrap_or_default().map_texture();
    let texels = if settings.is_some() { descriptor.size.width } else { 1 };
    let mut image = gpu_image("rain water map", texels, texels, descriptor.format, descriptor.usage);
    image.texture_descriptor.size.depth_or_array_layers = descriptor.size.depth_or_array_layers;
    // With one level, too.
    image.texture_view_descriptor = Some(TextureViewDescriptor {
        dimension: Some(TextureViewDimension::D2Array),
        ..default()
    });
    image
}

/// A tiling texture of water slopes with all its mips; see `rain_render::slope_mips`.
pub(crate) fn slope_image(texels: u32) -> Image {
    let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::STORAGE_BINDING | TextureUsages::COPY_DST;
    let mut image = gpu_image("rain water slopes", texels, texels, TextureFormat::Rgba16Float, usage);
    image.texture_descriptor.mip_level_count = texels.ilog2() + 1;
    image.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
        address_mode_u: ImageAddressMode::Repeat,
        address_mode_v: ImageAddressMode::Repeat,
        ..ImageSamplerDescriptor::linear()
    });
    image
}

/// Light that water throws.
pub(crate) fn caustic_image() -> Image {
    let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::STORAGE_BINDING;
    let mut image = gpu_image("rain caustics", CAUSTIC_TEXELS, CAUSTIC_TEXELS, CAUSTIC_FORMAT, usage);
    image.sampler = slope_image(1).sampler;
    image
}

/// What mirrored views are kept in, a layer each.
pub(crate) fn reflection_image(size: UVec2, layers: u32) -> Image {
    let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::STORAGE_BINDING | TextureUsages::COPY_DST;
    let size = size.clamp(UVec2::splat(16), UVec2::splat(4096));
    let mut image = gpu_image("rain reflection", size.x, size.y, REFLECTION_FORMAT, usage);
    image.texture_descriptor.size.depth_or_array_layers = layers.max(1);
    image.texture_descriptor.mip_level_count = size.min_element().ilog2().min(6) + 1;
    image.texture_view_descriptor = Some(TextureViewDescriptor {
        dimension: Some(TextureViewDimension::D2Array),
        ..default()
    });
    image
}

/// What the mirrored camera draws into: its picture is copied, because what it draws reads the copy.
pub(crate) fn reflection_target(size: UVec2) -> Image {
    let size = size.clamp(UVec2::splat(16), UVec2::splat(4096));
    let mut image = Image::new_target_texture(size.x, size.y, TextureFormat::Rgba16Float, None);
    image.asset_usage = RenderAssetUsages::RENDER_WORLD;
    image
}

/// A depth-only camera: no colour target, so every colour pass leaves its view out.
pub(crate) fn cover_camera(texels: u32) -> impl Bundle {
    (
        Name::new("rain cover view"),
        Camera3d::default(),
        Camera {
            order: -100,
            is_active: false,
            ..default()
        },
        RenderTarget::None {
            size: UVec2::splat(texels),
        },
        Tonemapping::None,
        DepthPrepass,
        Msaa::Off,
    )
}

/// A camera that draws the mirrored scene, linear and exposed, before all others.
pub(crate) fn mirror_camera(target: Handle<Image>) -> impl Bundle {
    (
        Name::new("rain mirror view"),
        Camera3d::default(),
        Camera {
            order: -90,
            is_active: false,
            invert_culling: true,
            ..default()
        },
        RenderTarget::from(target),
        Hdr,
        Tonemapping::None,
        Msaa::Off,
    )
}

/// So dark that wet materials draw what they know instead: see `RAIN_MASK_EXPOSURE`.
const MASK_EV100: f32 = 60.0;

/// What a camera of masks draws into.
pub(crate) fn mask_target(size: UVec2) -> Image {
    let mut image = Image::new_target_texture(size.x, size.y, KNOWN_FORMAT, None);
    image.asset_usage = RenderAssetUsages::RENDER_WORLD;
    image
}

/// A camera that draws what wet materials know of their pixels, before all others.
pub(crate) fn mask_camera(target: Handle<Image>, sub_camera_view: Option<SubCameraView>) -> impl Bundle {
    (
        Name::new("rain mask view"),
        Camera3d::default(),
        Camera {
            order: -80,
            clear_color: ClearColorConfig::Custom(Color::NONE),
            sub_camera_view,
            ..default()
        },
        RenderTarget::from(target),
        Hdr,
        Exposure { ev100: MASK_EV100 },
        Tonemapping::None,
        Msaa::Off,
    )
}

/// Which mask an image is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MaskKind {
    /// Coverage by streaks: half floats, 0…1.
    Rain,
    /// Pore saturation (floats, 0…1), distance or depth of water (floats, m).
    Surface,
}

/// An image that a mask can be drawn into and read back from.
#[must_use]
pub fn mask_image(kind: MaskKind, width: u32, height: u32) -> Image {
    let format = match kind {
        MaskKind::Rain => TextureFormat::R16Float,
        MaskKind::Surface => TextureFormat::R32Float,
    };
    gpu_image(
        "rain mask",
        width,
        height,
        format,
        TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC | TextureUsages::TEXTURE_BINDING,
    )
}

/// Whether the rain can be drawn here, for apps and tests to ask.
#[derive(Resource, Clone, Debug, PartialEq, Eq, Default)]
pub enum RainRenderStatus {
    /// No renderer in this app (a server): simulation and queries work, nothing is drawn.
    #[default]
    NoRenderer,
    /// The passes are recorded when needed.
    Ready {
        /// The adapter's name.
        adapter: String,
        /// The adapter is software.
        software: bool,
    },
}

/// Connects the plugins' per-view inputs to Bevy's renderer.
pub struct RainRenderPlugin;

impl Plugin for RainRenderPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<RainReport>().init_resource::<RainRenderStatus>();
        let report = app.world().resource::<RainReport>().clone();
        let levels = WaveLevels::default();
        if app.get_sub_app(RenderApp).is_none() {
            return; // a server: the main-world half still works
        }
        app.insert_resource(levels.clone()).add_plugins((
            ExtractComponentPlugin::<RainCoverView>::default(),
            ExtractComponentPlugin::<RainMirrorView>::default(),
            ExtractComponentPlugin::<RainMaskView>::default(),
            wet_material::WetMaterialPlugin,
            lightning::LightningMaterialPlugin,
        ));
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
            return;
        };
        render_app
            .insert_resource(report)
            .insert_resource(levels)
            .init_gpu_resource::<prepare::RainGpu>()
            .init_gpu_resource::<splash::SplashViews>()
            .init_gpu_resource::<haze::HazeViews>()
            .init_gpu_resource::<far_rain::FarRainViews>()
            .init_gpu_resource::<lattice::LatticeViews>()
            .init_gpu_resource::<record::DropCounts>()
            .init_resource::<lattice::ExtractedStreaks>()
            .init_gpu_resource::<lens::LensViews>()
            .init_resource::<extract::ExtractedWaves>()
            .init_resource::<extract::ExtractedMap>()
            .add_systems(
                ExtractSchedule,
                (
                    extract::extract_rain,
                    extract::extract_waves,
                    extract::extract_map,
                    splash::extract_splashes,
                    haze::extract_haze,
                    far_rain::extract_far_rain,
                    lattice::extract_cards,
                    lens::extract_lenses,
                ),
            )
            .add_systems(
                Render,
                (
                    (
                        haze::prepare_haze,
                        far_rain::prepare_far_rain,
                        splash::prepare_splashes,
                        lattice::prepare_cards,
                        lens::prepare_lenses,
                        prepare::prepare_rain,
                    )
                        .chain()
                        .in_set(RenderSystems::PrepareBindGroups),
                    (wave_levels::show_levels, splash::count_splashes, record::count_drops)
                        .in_set(RenderSystems::Cleanup),
                ),
            )
            .add_systems(
                RenderGraph,
                (record::water_map, record::water, lattice::streak_textures)
                    .chain()
                    .before(camera_driver),
            )
            .add_systems(
                Core3d,
                (
                    record::keep_cover_map
                        .after(Core3dSystems::Prepass)
                        .before(Core3dSystems::MainPass),
                    record::keep_reflection
                        .after(Core3dSystems::MainPass)
                        .before(Core3dSystems::EarlyPostProcess),
                    // Glass and the like hide nothing from masks.
                    record::keep_known
                        .in_set(Core3dSystems::MainPass)
                        .after(main_opaque_pass_3d)
                        .before(main_transmissive_pass_3d)
                        .before(main_transparent_pass_3d),
                    haze::haze_behind_glass
                        .in_set(Core3dSystems::MainPass)
                        .after(main_transmissive_pass_3d)
                        .before(main_transparent_pass_3d),
                    (
                        splash::splash_behind_glass,
                        lattice::lattice_behind_glass,
                        record::rainfall_behind_glass,
                    )
                        .chain()
                        .in_set(Core3dSystems::MainPass)
                        .after(haze::haze_behind_glass)
                        .after(main_transmissive_pass_3d)
                        .before(main_transparent_pass_3d),
                    (
                        haze::haze_over_sky,
                        far_rain::far_rain,
                        splash::splash::<false>,
                        lattice::lattice::<false>,
                        record::rainfall::<false>,
                    )
                        .chain()
                        .in_set(Core3dSystems::MainPass)
                        .after(main_transparent_pass_3d)
                        // Transparent fragments that are sorted by pixel reach the picture here.
                        .after(oit_resolve),
                    lens::lens::<false>
                        .after(Core3dSystems::MainPass)
                        .before(Core3dSystems::EarlyPostProcess),
                    (
                        splash::splash::<true>,
                        lattice::lattice::<true>,
                        record::rainfall::<true>,
                        lens::lens::<true>,
                    )
                        .chain()
                        .in_set(Core3dSystems::PostProcess)
                        .after(motion_blur)
                        .before(bloom),
                ),
            );
    }

    fn finish(&self, app: &mut App) {
        let Some(info) = app.world().get_resource::<RenderAdapterInfo>() else {
            return;
        };
        let software = info.device_type == wgpu::DeviceType::Cpu;
        let status = RainRenderStatus::Ready {
            adapter: info.name.clone(),
            software,
        };
        app.insert_resource(status).insert_resource(SoftwareAdapter(software));
    }
}
