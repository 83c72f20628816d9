//! Wet surfaces: every `StandardMaterial` in the scene gets wet by itself where rain reaches it.
//!
//! While the scene is dry and settled, meshes keep their own material and cost nothing more. At first wetness each is
//! given an extended copy that reads the cover map and the weather's wetness; when all has dried the originals return.
//! Changes that the app makes to the originals meanwhile are followed.

mod auto_paint;
mod dynamic;
mod geometry;
mod ground;
mod look;
mod materials;
mod paint;
mod reflection;
mod state;
mod water;

pub use auto_paint::{AutoPaint, AutoPaintDone, AutoPaintError, PaintedMesh};
pub use dynamic::OwnWetness;
pub use geometry::MovesInRain;
pub(crate) use geometry::triangles_of;
pub use ground::{GroundFilms, LevelsFromGround};
pub use look::WetLook;
pub use materials::{DryMaterial, KeepDry, OriginalMaterial, SurfaceWetting, WetSurfacePlugin};
pub use paint::{NoisePuddles, PaintSource, PuddlePaint, ShowPaint};
pub use reflection::{MirrorFrame, PlanarReflection, RainMirrorView, ReflectionSize};
pub use state::{SurfaceState, WAVE_PERIOD_S};
pub use water::{LEVEL_TEXELS, NO_WATER_M, WaterAppearance, WaterImages, WaterLevels, wind_slope_variance};
