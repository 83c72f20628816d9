//! `StandardMaterial` extended by wetness.

use bevy::asset::{Assets, embedded_asset};
use bevy::mesh::MeshVertexBufferLayoutRef;
use bevy::pbr::{ExtendedMaterial, MaterialExtension, MaterialExtensionKey, MaterialExtensionPipeline, MaterialPlugin};
use bevy::prelude::*;
use bevy::render::render_resource::{AsBindGroup, RenderPipelineDescriptor, SpecializedMeshPipelineError};
use bevy::render::storage::ShaderBuffer;
use bevy::shader::{Shader, ShaderRef};
use rain_render::compose;
use rain_render::gpu_types::SurfaceParams;

/// A material that gets wet.
pub type WetMaterial = ExtendedMaterial<StandardMaterial, WetSurface>;

/// The extension: how strongly a material takes water, and where the shader finds the state of the world.
#[derive(Asset, AsBindGroup, Reflect, Clone, Debug)]
#[bind_group_data(WetSurfaceKey)]
pub struct WetSurface {
    /// x: strength 0…1; y: porosity 0…1, below 0: guessed from roughness and metalness; z: 1 when the mesh's tag holds
    /// a wetness of its own; w: wetness set by hand, below 0: none.
    #[uniform(100)]
    pub wetting: Vec4,
    /// Painted puddles: source (0 none, 1 vertex colours, 2 texture), margin, least flood level, depth m.
    #[uniform(100)]
    pub paint: Vec4,
    /// Painted puddles: fixed, height map, what to show; w unused.
    #[uniform(100)]
    pub paint_flags: Vec4,
    /// Noise puddles: 1 / size along x and z, seed, level (below 0: the weather's).
    #[uniform(100)]
    pub noise: Vec4,
    /// Noise puddles: present, height map, width of the drenched ground, share of the noise.
    #[uniform(100)]
    pub noise_flags: Vec4,
    /// Look (0 physical, else a source's rules), fixed state (0 none, 1 dry … 4 puddle), ground only; w unused.
    #[uniform(100)]
    pub look: Vec4,
    /// Wheel ruts of noise puddles: cosine and sine of the lanes' direction, offset m, depth.
    #[uniform(100)]
    pub ruts: Vec4,
    /// Their lane m, half track m, standard deviation m; w: 1 where there are any.
    #[uniform(100)]
    pub rut_shape: Vec4,
    /// Flow of the mesh's own: velocity m/s, speed of the flow map m/s (0: none), strength.
    #[uniform(100)]
    pub flow: Vec4,
    /// The cover map.
    #[texture(101, sample_type = "depth")]
    pub cover: Handle<Image>,
    /// [`SurfaceParams`].
    #[storage(102, read_only)]
    pub params: Handle<ShaderBuffer>,
    /// Levels of standing water.
    #[texture(103, sample_type = "float", filterable = false)]
    pub levels: Handle<Image>,
    /// Slopes of the rings that drops make.
    #[texture(104)]
    #[sampler(105)]
    pub ripples: Handle<Image>,
    /// Slopes of interactive waves.
    #[texture(106)]
    pub waves: Handle<Image>,
    /// The mirrored views.
    #[texture(107, dimension = "2d_array")]
    pub reflection: Handle<Image>,
    /// Painted channels; without it white, which is unpainted ground.
    #[texture(108)]
    pub painted: Option<Handle<Image>>,
    /// Films and pores of the ground.
    #[texture(109)]
    pub films: Handle<Image>,
    /// The same around the view, finer.
    #[texture(110, dimension = "2d_array")]
    pub map: Handle<Image>,
    /// Normal maps of waves, where there are any.
    #[texture(114)]
    pub wave_normals: Option<Handle<Image>>,
    /// The second of them.
    #[texture(115)]
    pub more_wave_normals: Option<Handle<Image>>,
    /// Flow map of the mesh, where there is one.
    #[texture(116)]
    pub flow_map: Option<Handle<Image>>,
    /// Light that water throws, once it does.
    #[texture(117)]
    pub caustics: Option<Handle<Image>>,
}

/// What pipelines of wet materials differ by.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[repr(C)]
pub struct WetSurfaceKey {
    /// Water throws light onto walls: what that takes would slow down all that is wet where branches are not skipped.
    caustics: bool,
}

impl From<&WetSurface> for WetSurfaceKey {
    fn from(surface: &WetSurface) -> Self {
        Self {
            caustics: surface.caustics.is_some(),
        }
    }
}

impl MaterialExtension for WetSurface {
    fn specialize(
        _: &MaterialExtensionPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        _: &MeshVertexBufferLayoutRef,
        key: MaterialExtensionKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        if key.bind_group_data.caustics
            && let Some(fragment) = &mut descriptor.fragment
        {
            fragment.shader_defs.push("RAIN_CAUSTICS".into());
        }
        Ok(())
    }

    fn fragment_shader() -> ShaderRef {
        "embedded://rain_plugins/render_adapter/shaders/wet_surface.wgsl".into()
    }

    fn deferred_fragment_shader() -> ShaderRef {
        "embedded://rain_plugins/render_adapter/shaders/wet_surface.wgsl".into()
    }
}

/// Keeps the shader library and the parameter buffer alive.
#[derive(Resource, Clone, Debug)]
pub struct WetSurfaceHandles {
    _library: Handle<Shader>,
    /// The buffer behind [`WetSurface::params`].
    pub params: Handle<ShaderBuffer>,
}

pub(super) struct WetMaterialPlugin;

impl Plugin for WetMaterialPlugin {
    fn build(&self, app: &mut App) {
        embedded_asset!(app, "shaders/wet_surface.wgsl");
        let mut source = String::from("#define_import_path rain::surface\n");
        source.push_str(&compose::constants());
        source.push_str(compose::TYPES);
        for library in compose::LIBRARIES {
            if [
                "hash",
                "cover",
                "wetness",
                "standing_water",
                "wind_waves",
                "rut_lanes",
                "placed_water",
                "film_waves",
                "caustics",
                "beads",
                "artist_look",
                "ground_memory",
                "water_map",
                "surface_mask",
            ]
            .contains(&library.name)
            {
                source.push_str(library.source);
            }
        }
        let library = app
            .world_mut()
            .resource_mut::<Assets<Shader>>()
            .add(Shader::from_wgsl(source, "rain/surface.wgsl"));
        let zero = vec![0; size_of::<SurfaceParams>()];
        let params = app
            .world_mut()
            .resource_mut::<Assets<ShaderBuffer>>()
            .add(ShaderBuffer::new(&zero, bevy::asset::RenderAssetUsages::default()));
        app.insert_resource(WetSurfaceHandles {
            _library: library,
            params,
        });
        app.add_plugins(MaterialPlugin::<WetMaterial>::default());
    }
}
