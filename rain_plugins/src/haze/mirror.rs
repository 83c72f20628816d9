//! Haze in the pictures that level water mirrors.

use bevy::prelude::*;
use rain_core::haze::FOG_TABLE_KNOTS;
use rain_core::rainfall::Lamp;

use super::view::{HazeShot, HazeViewFrame};
use crate::render_adapter::let_depth_be_read;
use crate::surface::{MirrorFrame, RainMirrorView};

/// The haze of a view as it is in its mirror: from the eye's image, beyond the mirror, and without drops that are drawn.
fn mirrored(shot: &HazeShot, height_m: f32, eye: Vec3, image: Vec3) -> HazeShot {
    let seen = |lamp: &Lamp| Lamp {
        position_m: lamp.position_m + eye - image,
        ..*lamp
    };
    HazeShot {
        forward: shot.forward * Vec3::new(1.0, -1.0, 1.0),
        drawn_m: [0.0; FOG_TABLE_KNOTS],
        // No mirror shows particles: all of it is haze.
        far: None,
        cloud_m: shot.cloud_m + eye.y - image.y,
        lamps: shot.lamps.iter().map(seen).collect(),
        mirror_m: Some(height_m - image.y),
        ..shot.clone()
    }
}

/// Gives each mirrored view the haze of the view that it belongs to.
pub(crate) fn haze_mirrors(
    frame: Option<Res<MirrorFrame>>,
    views: Query<&HazeViewFrame, Without<RainMirrorView>>,
    mut mirrors: Query<(&RainMirrorView, &mut HazeViewFrame, &mut Camera3d)>,
) {
    let Some(frame) = frame else { return };
    for (mirror, mut own, mut camera) in &mut mirrors {
        let aimed = frame.views.get(mirror.layer as usize).copied().flatten();
        let shot = aimed.and_then(|aimed| {
            let shot = views.get(aimed.of).ok()?.shot.as_ref()?;
            Some(mirrored(shot, aimed.height, aimed.eye, aimed.mirrored_eye))
        });
        if shot.is_some() {
            let_depth_be_read(&mut camera);
        }
        if own.shot.is_some() || shot.is_some() {
            own.shot = shot;
        }
    }
}
