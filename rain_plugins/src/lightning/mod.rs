//! Lightning in the picture: the channel, the glow of the cloud, and the light on everything.
//!
//! Off by default: without [`Lightning`](rain_ecs::prelude::Lightning) on the weather nothing is spawned and nothing is
//! computed. What flashes, and when, is `rain_ecs`'s.
//!
//! | file | job |
//! |---|---|
//! | `settings.rs` | [`LightningLook`] |
//! | `show.rs` | light on the scene while a flash lasts |
//! | `shapes.rs` | meshes of channels and glow |

mod settings;
mod shapes;
mod show;

use bevy::camera::visibility::VisibilitySystems;
use bevy::prelude::*;
use bevy::transform::TransformSystems;

pub use settings::LightningLook;
pub use show::LightningLight;

/// Draws the flashes of weathers with [`Lightning`](rain_ecs::prelude::Lightning) and lights the scene by them.
pub struct LightningPlugin;

impl Plugin for LightningPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<LightningLook>()
            .init_resource::<LightningLook>()
            .init_resource::<show::Shown>()
            .add_systems(PreUpdate, show::take_back.run_if(show::was_lit))
            .add_systems(
                PostUpdate,
                show::show_lightning
                    .run_if(show::something_flashes)
                    .after(crate::cloud_light::dim)
                    .before(TransformSystems::Propagate)
                    .before(VisibilitySystems::VisibilityPropagate),
            );
    }
}
