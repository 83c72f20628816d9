//! Puddles that an artist placed on a part of the scene, with the depth map that they fill.

use std::path::Path;

use bevy::image::{CompressedImageFormats, ImageAddressMode, ImageSampler, ImageSamplerDescriptor, ImageType};
use bevy::prelude::*;
use rain_core::error::ConfigError;
use serde::{Deserialize, Serialize};

use super::file::Scenario;
use super::run::RunError;
use crate::surface::{NoisePuddles, PaintSource, PuddlePaint, WheelRuts};

/// Puddles placed on a part's meshes; they fill by the artists' levels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Puddles {
    /// By vertex colours, or a texture of channels (Lagarde 2013).
    Painted(PaintedPuddles),
    /// By a noise map in world space (Nguyenova 2021).
    Noise(NoiseMap),
}

/// Fields of [`PuddlePaint`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PaintedPuddles {
    /// Linear image of the channels over the first texture coordinates. Default: the meshes' vertex colours.
    pub texture: Option<String>,
    /// Puddles that do not change, by alpha. Default: false.
    pub fixed: bool,
    /// Flood level over which a rim fills. Units: none. Domain: [0.0001, 1]. Default: 0.4.
    pub margin: f64,
    /// Flood level that never dries. Units: none. Domain: [0, 1]. Default: 0.
    pub least_flood: f64,
    /// Depth of a full puddle. Units: m. Domain: [0, 1]. Default: 0.01.
    pub depth_m: f64,
}

impl Default for PaintedPuddles {
    fn default() -> Self {
        Self {
            texture: None,
            fixed: false,
            margin: 0.4,
            least_flood: 0.0,
            depth_m: 0.01,
        }
    }
}

/// Fields of [`NoisePuddles`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct NoiseMap {
    /// Chooses the map. Default: 0.
    pub seed: u32,
    /// Size of the largest puddles. Units: m. Domain: [0.1, 1000]. Default: 4.
    pub size_m: f64,
    /// How much of the noise counts beside the depth map. Units: none. Domain: [0, 1]. Default: 1.
    pub noise: f64,
    /// Stretch along the lanes. Units: none. Domain: [1, 100]. Default: 1.
    pub stretch: f64,
    /// Whether puddles gather in wheel ruts of lanes along the world's z. Default: false.
    pub ruts: bool,
}

impl Default for NoiseMap {
    fn default() -> Self {
        Self {
            seed: 0,
            size_m: 4.0,
            noise: 1.0,
            stretch: 1.0,
            ruts: false,
        }
    }
}

/// The depth map of a part's materials: bump offset (parallax), and holes and cracks that water fills.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DepthMap {
    /// Linear image over the first texture coordinates, relative to the scenario or to `--assets`: 0 high, 1 deep.
    /// Required.
    pub file: String,
    /// Depth of 1, in shares of a texture tile. Units: none. Domain: [0, 1]. Default: 0.01.
    #[serde(default = "relief")]
    pub relief: f64,
}

fn relief() -> f64 {
    0.01
}

impl PaintedPuddles {
    fn component(&self, source: PaintSource, height_map: bool) -> PuddlePaint {
        PuddlePaint {
            source,
            fixed: self.fixed,
            margin: self.margin as f32,
            least_flood: self.least_flood as f32,
            depth_m: self.depth_m as f32,
            height_map,
            ..default()
        }
    }
}

impl NoiseMap {
    fn component(&self, height_map: bool) -> NoisePuddles {
        NoisePuddles {
            seed: self.seed,
            size_m: self.size_m as f32,
            noise: self.noise as f32,
            stretch: self.stretch as f32,
            ruts: self.ruts.then(WheelRuts::default),
            height_map,
            ..default()
        }
    }
}

impl Puddles {
    /// What the components say of these values.
    ///
    /// # Errors
    /// Names the first field outside its domain.
    pub(super) fn check(&self) -> Result<(), ConfigError> {
        match self {
            Self::Painted(paint) => paint.component(PaintSource::default(), false).validated().map(|_| ()),
            Self::Noise(map) => map.component(false).validated().map(|_| ()),
        }
    }
}

/// Which part of the scene a root is.
#[derive(Component)]
pub(super) struct PartRoot(pub usize);

/// Puts puddles and depth maps on the parts that ask for them.
pub(super) fn place(app: &mut App, scenario: &Scenario, folder: &Path) -> Result<(), RunError> {
    let world = app.world_mut();
    let roots: Vec<(Entity, usize)> = world
        .query::<(Entity, &PartRoot)>()
        .iter(world)
        .map(|(entity, root)| (entity, root.0))
        .collect();
    for (root, index) in roots {
        let Some(part) = scenario.scene.get(index) else {
            continue;
        };
        if part.puddles.is_none() && part.depth_map.is_none() {
            continue;
        }
        let image = |world: &mut World, file: &str| -> Result<Handle<Image>, RunError> {
            let loaded = linear_image(folder, file)?;
            Ok(world.resource_mut::<Assets<Image>>().add(loaded))
        };
        let depth_map = match &part.depth_map {
            Some(map) => Some((image(world, &map.file)?, map.relief as f32)),
            None => None,
        };
        let texture = match &part.puddles {
            Some(Puddles::Painted(PaintedPuddles {
                texture: Some(file), ..
            })) => Some(image(world, file)?),
            _ => None,
        };
        for entity in meshes_below(world, root) {
            if let Some((map, relief)) = &depth_map {
                give_depth(world, entity, map, *relief);
            }
            let holes = depth_map.is_some();
            match &part.puddles {
                Some(Puddles::Painted(paint)) if texture.is_some() || has_colors(world, entity) => {
                    let source = texture.clone().map_or(PaintSource::VertexColors, PaintSource::Texture);
                    world.entity_mut(entity).insert(paint.component(source, holes));
                }
                Some(Puddles::Noise(map)) => {
                    world.entity_mut(entity).insert(map.component(holes));
                }
                Some(Puddles::Painted(_)) | None => {}
            }
        }
    }
    Ok(())
}

fn linear_image(folder: &Path, file: &str) -> Result<Image, RunError> {
    let path = folder.join(file);
    let bad = |message: String| RunError::Asset {
        file: path.clone(),
        message,
    };
    let bytes = std::fs::read(&path).map_err(|error| bad(error.to_string()))?;
    let extension = path
        .extension()
        .and_then(|e| e.to_str())
        .unwrap_or_default()
        .to_lowercase();
    let sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
        address_mode_u: ImageAddressMode::Repeat,
        address_mode_v: ImageAddressMode::Repeat,
        ..ImageSamplerDescriptor::linear()
    });
    Image::from_buffer(
        &bytes,
        ImageType::Extension(&extension),
        CompressedImageFormats::NONE,
        false,
        sampler,
        default(),
    )
    .map_err(|error| bad(error.to_string()))
}

fn meshes_below(world: &World, root: Entity) -> Vec<Entity> {
    let mut stack = vec![root];
    let mut found = Vec::new();
    while let Some(entity) = stack.pop() {
        if let Some(children) = world.get::<Children>(entity) {
            stack.extend(children.iter());
        }
        if world.get::<Mesh3d>(entity).is_some() {
            found.push(entity);
        }
    }
    found
}

fn has_colors(world: &World, entity: Entity) -> bool {
    let mesh = world.get::<Mesh3d>(entity).map(|mesh| mesh.0.id());
    mesh.and_then(|id| world.resource::<Assets<Mesh>>().get(id))
        .is_some_and(|mesh| mesh.contains_attribute(Mesh::ATTRIBUTE_COLOR))
}

fn give_depth(world: &mut World, entity: Entity, map: &Handle<Image>, relief: f32) {
    let Some(id) = world.get::<MeshMaterial3d<StandardMaterial>>(entity).map(|m| m.0.id()) else {
        return;
    };
    let has_uv = world
        .get::<Mesh3d>(entity)
        .and_then(|mesh| world.resource::<Assets<Mesh>>().get(&mesh.0))
        .is_some_and(|mesh| mesh.contains_attribute(Mesh::ATTRIBUTE_UV_0));
    if !has_uv {
        return;
    }
    if let Some(mut material) = world.resource_mut::<Assets<StandardMaterial>>().get_mut(id) {
        material.depth_map = Some(map.clone());
        material.parallax_depth_scale = relief;
    }
}
