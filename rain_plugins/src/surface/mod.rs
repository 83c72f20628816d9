//! Wet surfaces: every `StandardMaterial` in the scene gets wet by itself where rain reaches it.
//!
//! While the scene is dry and settled, meshes keep their own material and cost nothing more. At first wetness each is
//! given an extended copy that reads the cover map and the weather's wetness; when all has dried the originals return.
//! Changes that the app makes to the originals meanwhile are followed.

mod auto_paint;
mod dynamic;
mod flow;
mod gaps;
mod geometry;
mod ground;
mod look;
mod map;
mod mask_view;
mod materials;
mod paint;
mod reflection;
mod state;
mod triangles;
mod water;

pub use auto_paint::{AutoPaint, AutoPaintDone, AutoPaintError, PaintedMesh};
pub use dynamic::OwnWetness;
pub use flow::FilmFlow;
pub use gaps::{Gap, LeftOut, SceneGap};
pub use geometry::MovesInRain;
pub(crate) use geometry::SceneGeometryPlugin;
pub use ground::{GroundFilms, LevelsFromGround};
pub use look::WetLook;
pub(crate) use map::MapHandover;
pub use map::{GroundMap, GroundMapSettings};
pub use mask_view::RainMaskView;
pub use materials::{DryMaterial, KeepDry, OriginalMaterial, SurfaceWetting, WetSurfacePlugin};
pub use paint::{NoisePuddles, PaintSource, PuddlePaint, ShowPaint, WheelRuts};
pub use reflection::{MirrorFrame, MirrorView, PlanarReflection, RainMirrorView, ReflectionSize};
pub use state::{SurfaceState, WAVE_PERIOD_S};
pub(crate) use triangles::{MeshTriangles, triangles_of};
pub(crate) use water::MapPlace;
pub use water::{
    LEVEL_TEXELS, NO_WATER_M, WaterAppearance, WaterImages, WaterLevels, WaveNormalMaps, wind_slope_variance,
};
