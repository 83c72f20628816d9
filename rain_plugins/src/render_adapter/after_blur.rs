//! Which views draw their rain after temporal anti-aliasing and motion blur.

use bevy::camera::MainPassResolutionOverride;
use bevy::core_pipeline::prepass::MotionVectorPrepass;
use bevy::ecs::query::{Has, QueryData};
use bevy::render::view::Msaa;

/// What decides when a view's rain is drawn.
///
/// Streaks are exposed already and show too thin a veil to have a motion of their own in a pixel: blur along the motion of
/// what lies behind would smear them a second time, and an average over frames would take some of them for noise. So where a
/// view has motion vectors they come after both. With several samples a pixel, or at a resolution of its own, the main
/// pass's depth does not fit the picture by then: rain is drawn at the end of the main pass there, as in views without
/// motion vectors.
#[derive(QueryData)]
pub(super) struct RainOrder {
    msaa: &'static Msaa,
    motion_vectors: Has<MotionVectorPrepass>,
    scaled: Has<MainPassResolutionOverride>,
}

impl RainOrderItem<'_, '_> {
    /// Whether this view's rain is drawn after both (`true`), or in the main pass (`false`).
    pub(super) fn is_after_blur(&self) -> bool {
        self.motion_vectors && *self.msaa == Msaa::Off && !self.scaled
    }
}
