//! Water on the scene's surfaces: the ground with its films and puddles, and objects that move.
//!
//! | file | concept |
//! |---|---|
//! | `scene.rs` | [`SurfaceScene`], where the host puts triangles; [`SurfaceSettings`] |
//! | `ground.rs` | [`SurfaceGround`], built from it, with its water |
//! | `material.rs` | [`SurfaceMaterial`], and classes guessed from names |
//! | `dynamic.rs` | [`DynamicWetness`] of objects that move |
//! | `press.rs` | [`FilmPress`]: wheels and feet that leave tracks |
//! | `snapshot.rs` | their parts of a snapshot |

mod dynamic;
mod ground;
mod material;
mod press;
mod scene;
mod snapshot;

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;

pub use dynamic::DynamicWetness;
pub use ground::SurfaceGround;
pub use material::{SurfaceMaterial, surface_class_of_name};
pub use press::{FilmPress, FilmPressed, FilmPresses};
pub use scene::{SurfaceScene, SurfaceSettings};

use crate::schedule::{RainSystems, RainTick};
use crate::snapshot::SnapshotAppExt;
use crate::state_hash::StateHashAppExt;

/// Adds the wet ground and the wetness of moving objects. Needs [`crate::CoverFieldPlugin`] for what keeps rain off.
pub struct SurfaceGroundPlugin;

impl Plugin for SurfaceGroundPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<SurfaceScene>()
            .init_resource::<SurfaceSettings>()
            .init_resource::<SurfaceGround>()
            .register_type::<SurfaceMaterial>()
            .register_type::<DynamicWetness>()
            .register_type::<FilmPress>()
            .init_resource::<FilmPresses>()
            .hash_resource::<SurfaceGround>("surface")
            .hash_with("dynamic_wetness", dynamic::hash_objects)
            .hash_with("film_press", press::hash_presses)
            .snapshot_part::<press::PressPart>("film_press")
            .snapshot_part::<snapshot::SurfacePart>("surface")
            .snapshot_part::<snapshot::ObjectsPart>("dynamic_wetness")
            .add_systems(
                RainTick,
                (
                    ground::rebuild,
                    ground::refresh_exposure,
                    press::press_films,
                    ground::advance,
                    dynamic::wet_objects,
                )
                    .chain()
                    .in_set(RainSystems::Surface),
            );
    }
}
