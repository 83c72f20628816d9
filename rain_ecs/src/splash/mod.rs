//! Splashes that gameplay hears of.
//!
//! | file | concept |
//! |---|---|
//! | `foot.rs` | [`FootStep`] and [`Foot`] in, [`FootSplash`] out |

mod foot;

use bevy_app::{App, Plugin, PostUpdate};
use bevy_ecs::prelude::*;
use bevy_transform::TransformSystems;

pub use foot::{Foot, FootSplash, FootSplashSettings, FootStep, PaintedStep};

/// Systems of feet, in `PostUpdate`, after transforms are propagated.
#[derive(SystemSet, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct FootSystems;

/// Turns steps into splashes. Needs no renderer; nothing of it is state.
pub struct FootSplashPlugin;

impl Plugin for FootSplashPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<FootSplashSettings>()
            .register_type::<Foot>()
            .register_type::<FootSplashSettings>()
            .add_message::<FootStep>()
            .add_message::<FootSplash>()
            .add_systems(
                PostUpdate,
                (foot::find_steps, foot::splash)
                    .chain()
                    .in_set(FootSystems)
                    .after(TransformSystems::Propagate),
            );
    }
}
