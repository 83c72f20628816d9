//! Paints a mesh's puddle masks by itself, from geometry: what lies under something, what is steep, where hollows are.

use bevy::asset::AssetEventSystems;
use bevy::math::{BVec4, DVec3, Vec3A};
use bevy::mesh::{MeshAccessError, PrimitiveTopology, VertexAttributeValues};
use bevy::prelude::*;
use rain_core::cover::{CoverError, RainDirections};
use rain_core::surface::ground::Ground;
use rain_core::surface::{PaintPlace, painted_channels};
use rain_ecs::prelude::*;
use thiserror::Error;

use super::paint::PuddlePaint;
use crate::schedule::RainViewSystems;

/// Has the vertex colours that [`PuddlePaint`] reads worked out once, and anew whenever this component changes
/// ([`AutoPaint::ask_again`]).
///
/// Red (ripples) and blue (wettable) are taken from where under several winds rain reaches a vertex, red from its slope
/// as well; green and alpha from the hollow that it lies in. The mesh becomes the entity's own: others that share it
/// keep theirs. [`AutoPaintDone`] says how it went; [`PuddlePaint::show`] shows the masks. Masks are as fine as the
/// mesh: a road of two triangles has four vertices to paint.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default)]
#[require(PuddlePaint)]
pub struct AutoPaint {
    /// Channels to paint: red, green, blue, alpha. The others keep what is painted there. Default: all.
    pub channels: BVec4,
    /// Wind that drives rain under edges. Units: m/s. Domain: [0, 50]. Default: 4.
    pub wind_m_s: f32,
    /// How many sides it comes from, besides calm air. Domain: [0, 64]. Default: 8.
    pub azimuths: u32,
    /// Counts requests.
    pub request: u32,
}

impl Default for AutoPaint {
    fn default() -> Self {
        Self {
            channels: BVec4::TRUE,
            wind_m_s: 4.0,
            azimuths: 8,
            request: 0,
        }
    }
}

impl AutoPaint {
    /// Has the mesh painted anew, after the scene around it has changed.
    pub fn ask_again(&mut self) {
        self.request = self.request.wrapping_add(1);
    }

    /// Whether this asks for the same, also where a number is none.
    fn is(&self, other: &Self) -> bool {
        let bits = |auto: &Self| (auto.channels, auto.wind_m_s.to_bits(), auto.azimuths, auto.request);
        bits(self) == bits(other)
    }
}

/// What a mesh was last painted by.
#[derive(Component, Clone, Copy, Debug)]
struct AutoPainted(AutoPaint);

/// What was painted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PaintedMesh {
    /// Vertices.
    pub vertices: usize,
    /// Of these in hollows: green below 1.
    pub in_hollows: usize,
    /// Of these out of the rain's reach for the most part: blue below ½.
    pub sheltered: usize,
}

/// Why a mesh was not painted. It stays as it was.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum AutoPaintError {
    /// Its data is on the GPU alone.
    #[error("the mesh's vertices are not on the CPU: its asset_usage must include MAIN_WORLD")]
    NotOnCpu,
    /// It is made of lines or points.
    #[error("the mesh is no list of triangles")]
    NotTriangles,
    /// It has no vertices, or none of three single-precision numbers.
    #[error("the mesh has no vertices")]
    NoVertices,
    /// It has no normals, or not one for each vertex.
    #[error("the mesh has no normal for each vertex: compute_normals() makes them")]
    NoNormals,
    /// Some vertices or normals are not finite, or a normal has no length.
    #[error("{vertices} of the mesh's vertices have a place or a normal that is not finite or zero")]
    NotFinite {
        /// How many.
        vertices: usize,
    },
    /// The rain's directions are outside their domain, or the scene too wide for them.
    #[error(transparent)]
    Cover(#[from] CoverError),
}

/// An [`AutoPaint`] was carried out, or refused.
#[derive(Message, Clone, Debug, PartialEq)]
pub struct AutoPaintDone {
    /// The mesh's entity.
    pub entity: Entity,
    /// What was painted.
    pub result: Result<PaintedMesh, AutoPaintError>,
}

/// Registers the painter.
pub(super) fn build(app: &mut App) {
    app.register_type::<AutoPaint>()
        .add_message::<AutoPaintDone>()
        .add_systems(
            PostUpdate,
            paint_meshes.after(RainViewSystems::Surfaces).before(AssetEventSystems),
        );
}

type Painted = (
    Entity,
    &'static AutoPaint,
    &'static Mesh3d,
    &'static GlobalTransform,
    &'static PuddlePaint,
    Option<&'static AutoPainted>,
);

/// Paints meshes that ask for it, once the ground is there.
fn paint_meshes(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    cover: Option<Res<CoverField>>,
    surface: Option<Res<SurfaceGround>>,
    settings: Option<Res<SurfaceSettings>>,
    mut done: MessageWriter<AutoPaintDone>,
    asked: Query<Painted>,
) {
    let mut due = asked
        .iter()
        .filter(|(_, auto, .., painted)| painted.is_none_or(|p| !p.0.is(auto)))
        .peekable();
    if due.peek().is_none() {
        return;
    }
    let ground = surface.as_ref().and_then(|s| s.ground());
    let coming = settings.is_some_and(|s| s.enabled) && surface.as_ref().is_some_and(|s| s.error().is_none());
    if ground.is_none() && coming {
        return;
    }
    // Meshes that ask for the same winds share the maps.
    let mut maps: Vec<((f32, u32), RainDirections)> = Vec::new();
    for (entity, auto, handle, pose, paint, _) in due {
        let Some(mesh) = meshes.get(&handle.0) else { continue };
        let winds = (auto.wind_m_s, auto.azimuths);
        if let Some(cover) = cover.as_ref().filter(|_| maps.iter().all(|(w, _)| *w != winds)) {
            match RainDirections::new(cover.scene(), f64::from(winds.0), winds.1) {
                Ok(map) => maps.push((winds, map)),
                Err(error) => {
                    error!("{entity} is not painted: {error}");
                    commands.entity(entity).insert(AutoPainted(*auto));
                    done.write(AutoPaintDone {
                        entity,
                        result: Err(error.into()),
                    });
                    continue;
                }
            }
        }
        let map = maps.iter().find(|(w, _)| *w == winds).map(|(_, map)| map);
        let open = |place: DVec3, normal: DVec3| map.map_or(1.0, |map| map.open_share(place, normal));
        let colours = colours(mesh, pose, auto, f64::from(paint.margin), open, ground);
        let result = match colours {
            Ok((colours, painted)) => {
                // A new asset: its vertices have a layout of their own, and others may share the old one.
                let own = mesh.clone().with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colours);
                commands.entity(entity).insert(Mesh3d(meshes.add(own)));
                Ok(painted)
            }
            Err(error) => Err(error),
        };
        if let Err(error) = &result {
            error!("{entity} is not painted: {error}");
        }
        commands.entity(entity).insert(AutoPainted(*auto));
        done.write(AutoPaintDone { entity, result });
    }
}

/// The vertex colours of a mesh.
fn colours(
    mesh: &Mesh,
    pose: &GlobalTransform,
    auto: &AutoPaint,
    margin: f64,
    open: impl Fn(DVec3, DVec3) -> f64,
    ground: Option<&Ground>,
) -> Result<(Vec<[f32; 4]>, PaintedMesh), AutoPaintError> {
    if mesh.primitive_topology() != PrimitiveTopology::TriangleList {
        return Err(AutoPaintError::NotTriangles);
    }
    let positions = match mesh.try_attribute(Mesh::ATTRIBUTE_POSITION) {
        Ok(VertexAttributeValues::Float32x3(positions)) if !positions.is_empty() => positions,
        Err(MeshAccessError::ExtractedToRenderWorld) => return Err(AutoPaintError::NotOnCpu),
        Ok(_) | Err(MeshAccessError::NotFound) => return Err(AutoPaintError::NoVertices),
    };
    let normals = match mesh.try_attribute(Mesh::ATTRIBUTE_NORMAL) {
        Ok(VertexAttributeValues::Float32x3(normals)) if normals.len() == positions.len() => normals,
        _ => return Err(AutoPaintError::NoNormals),
    };
    let mut colours = match mesh.try_attribute(Mesh::ATTRIBUTE_COLOR) {
        Ok(VertexAttributeValues::Float32x4(colours)) if colours.len() == positions.len() => colours.clone(),
        _ => vec![[1.0; 4]; positions.len()],
    };
    let turned = pose.affine().matrix3.inverse().transpose();
    let world: Vec<_> = positions
        .iter()
        .zip(normals)
        .map(|(p, n)| {
            let place = pose.transform_point(Vec3::from_array(*p)).as_dvec3();
            let normal = (turned * Vec3A::from_array(*n)).as_dvec3().try_normalize();
            (place, normal.filter(|_| place.is_finite()))
        })
        .collect();
    let bad = world.iter().filter(|(_, normal)| normal.is_none()).count();
    if bad > 0 {
        return Err(AutoPaintError::NotFinite { vertices: bad });
    }
    let mut painted = PaintedMesh {
        vertices: colours.len(),
        ..default()
    };
    for (colour, (place, normal)) in colours.iter_mut().zip(world) {
        let Some(normal) = normal else { continue };
        let channels = painted_channels(
            &PaintPlace {
                height_m: place.y,
                up: normal.y,
                open: open(place, normal),
                pool: ground.and_then(|ground| ground.pool_room_at(place)),
            },
            margin,
        );
        for (i, channel) in channels.into_iter().enumerate() {
            if auto.channels.test(i) {
                colour[i] = channel as f32;
            }
        }
        painted.in_hollows += usize::from(channels[1] < 1.0);
        painted.sheltered += usize::from(channels[2] < 0.5);
    }
    Ok((colours, painted))
}

#[cfg(test)]
mod tests {
    use bevy::asset::RenderAssetUsages;

    use super::*;

    fn paint(mesh: &Mesh) -> Result<(Vec<[f32; 4]>, PaintedMesh), AutoPaintError> {
        let pose = GlobalTransform::IDENTITY;
        colours(mesh, &pose, &AutoPaint::default(), 0.4, |_, _| 1.0, None)
    }

    fn plane() -> Mesh {
        Plane3d::default().mesh().size(2.0, 2.0).build()
    }

    #[test]
    fn open_level_ground_without_hollows_is_white() {
        let (colours, painted) = paint(&plane()).expect("painted");
        assert!(colours.iter().all(|c| *c == [1.0; 4]), "{colours:?}");
        assert_eq!((painted.in_hollows, painted.sheltered), (0, 0));
        assert_eq!(painted.vertices, colours.len());
    }

    #[test]
    fn channels_that_are_not_asked_for_stay() {
        let mesh = plane();
        let count = mesh.count_vertices();
        let mesh = mesh.with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, vec![[0.1, 0.2, 0.3, 0.4]; count]);
        let auto = AutoPaint {
            channels: BVec4::new(true, false, false, false),
            ..default()
        };
        let pose = GlobalTransform::IDENTITY;
        let (colours, _) = colours(&mesh, &pose, &auto, 0.4, |_, _| 0.5, None).expect("painted");
        assert!(colours.iter().all(|c| *c == [0.5, 0.2, 0.3, 0.4]), "{colours:?}");
    }

    #[test]
    fn normals_turn_with_the_mesh() {
        let upright = GlobalTransform::from(Transform {
            rotation: Quat::from_rotation_x(1.5),
            scale: Vec3::new(3.0, 1.0, 0.2),
            ..default()
        });
        let (colours, _) = colours(&plane(), &upright, &AutoPaint::default(), 0.4, |_, _| 1.0, None).expect("painted");
        assert!(
            colours.iter().all(|c| c[0] == 0.0 && c[2] == 1.0),
            "a wall gets wet and does not ring: {colours:?}"
        );
    }

    #[test]
    fn bad_meshes_are_refused_by_name() {
        let empty = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default());
        assert_eq!(paint(&empty), Err(AutoPaintError::NoVertices));
        let lines = Mesh::new(PrimitiveTopology::LineList, RenderAssetUsages::default());
        assert_eq!(paint(&lines), Err(AutoPaintError::NotTriangles));
        let mut bare = plane();
        bare.remove_attribute(Mesh::ATTRIBUTE_NORMAL);
        assert_eq!(paint(&bare), Err(AutoPaintError::NoNormals));
        for bad in [Vec3::NAN, Vec3::ZERO, Vec3::INFINITY] {
            let mut mesh = plane();
            if let Some(VertexAttributeValues::Float32x3(normals)) = mesh.attribute_mut(Mesh::ATTRIBUTE_NORMAL) {
                normals[1] = bad.to_array();
            }
            let error = paint(&mesh).expect_err("refused");
            assert_eq!(error, AutoPaintError::NotFinite { vertices: 1 });
            assert!(error.to_string().starts_with("1 of the mesh's vertices"), "{error}");
        }
        let mut mesh = plane();
        if let Some(VertexAttributeValues::Float32x3(positions)) = mesh.attribute_mut(Mesh::ATTRIBUTE_POSITION) {
            positions[0][1] = f32::NAN;
            positions[2][0] = f32::INFINITY;
        }
        assert_eq!(paint(&mesh), Err(AutoPaintError::NotFinite { vertices: 2 }));
    }
}
