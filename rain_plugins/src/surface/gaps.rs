//! What of the scene the simulation cannot take, said where a program and a person can see it.

use bevy::prelude::*;
use rain_core::cover::CoverError;
use rain_ecs::prelude::*;
use thiserror::Error;

/// Triangles of a mesh that neither cover nor are ground.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct LeftOut {
    /// With a corner that is NaN or infinite.
    pub not_finite: u32,
    /// Without area: two corners alike, or three on a line.
    pub no_area: u32,
    /// With an index beyond the vertices.
    pub no_vertex: u32,
}

impl LeftOut {
    /// Whether there is any.
    #[must_use]
    pub fn any(&self) -> bool {
        *self != Self::default()
    }
}

/// What is missing in the simulation, and why. The picture is not concerned.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Gap {
    /// Lines or points.
    #[error("a mesh of lines or points keeps no rain off and is no ground")]
    NotTriangles,
    /// Missing, not three floats each, or on the GPU only (`RenderAssetUsages` without `MAIN_WORLD`).
    #[error("a mesh without positions on the CPU keeps no rain off and is no ground")]
    NoPositions,
    /// Some triangles.
    #[error(
        "{} triangles are not finite, {} have no area, {} have an index beyond the vertices: left out",
        .0.not_finite, .0.no_area, .0.no_vertex
    )]
    LeftOut(LeftOut),
    /// The cover map refused the mesh.
    #[error("it does not keep rain off in the simulation: {0}")]
    NoCover(CoverError),
    /// The ground could not be built; what there was goes on.
    #[error("the ground was not built: {0}")]
    NoGround(String),
}

/// Written once for each mesh that is taken in with a [`Gap`], and once for each ground that could not be built; logged
/// as a warning too.
#[derive(Message, Debug, Clone, PartialEq)]
pub struct SceneGap {
    /// The mesh; none for the ground.
    pub entity: Option<Entity>,
    /// What is missing.
    pub gap: Gap,
}

/// Says when the ground could not be built, once for each reason.
pub(super) fn report_ground(
    ground: Option<Res<SurfaceGround>>,
    mut said: Local<Option<String>>,
    mut gaps: MessageWriter<SceneGap>,
) {
    let error = ground.and_then(|ground| ground.error().map(ToString::to_string));
    if *said == error {
        return;
    }
    said.clone_from(&error);
    if let Some(error) = error {
        let gap = Gap::NoGround(error);
        warn!("{gap}");
        gaps.write(SceneGap { entity: None, gap });
    }
}
