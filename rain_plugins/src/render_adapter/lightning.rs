//! The material of lightning: light that does not depend on other light.

use bevy::asset::embedded_asset;
use bevy::mesh::MeshVertexBufferLayoutRef;
use bevy::pbr::{Material, MaterialPipeline, MaterialPipelineKey, MaterialPlugin};
use bevy::prelude::*;
use bevy::render::render_resource::{AsBindGroup, RenderPipelineDescriptor, SpecializedMeshPipelineError};
use bevy::shader::ShaderRef;

/// A channel, or the glow of a cloud.
#[derive(Asset, AsBindGroup, Reflect, Clone, Debug, Default)]
pub struct LightningMaterial {
    /// Luminance as red, green and blue, cd/m²; w: what the air takes of it, 1/m.
    #[uniform(0)]
    pub light: Vec4,
    /// x: 1 for a glow, which falls off about its middle; y: its pattern.
    #[uniform(0)]
    pub glow: Vec4,
    /// Added to what is behind, in place of hiding it.
    pub added: bool,
}

impl Material for LightningMaterial {
    fn fragment_shader() -> ShaderRef {
        "embedded://rain_plugins/render_adapter/shaders/lightning.wgsl".into()
    }

    fn alpha_mode(&self) -> AlphaMode {
        if self.added { AlphaMode::Add } else { AlphaMode::Opaque }
    }

    // Maps of what stops rain and light are drawn in these passes.
    fn enable_prepass() -> bool {
        false
    }

    fn enable_shadows() -> bool {
        false
    }

    fn specialize(
        _: &MaterialPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        _: &MeshVertexBufferLayoutRef,
        _: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        descriptor.primitive.cull_mode = None;
        Ok(())
    }
}

pub(super) struct LightningMaterialPlugin;

impl Plugin for LightningMaterialPlugin {
    fn build(&self, app: &mut App) {
        embedded_asset!(app, "shaders/lightning.wgsl");
        app.add_plugins(MaterialPlugin::<LightningMaterial>::default());
    }
}
