//! Near rain for each marked camera: the container that follows the view.

mod lead;
mod motion;
mod view;

pub(crate) use lead::leading_view;
pub use motion::ViewMotion;
pub use rain_core::rainfall::{FollowSettings, FollowShape};
pub use view::{MAX_CONTRAST, MAX_STREAK_BUDGET, RainView, RainViewFrame, RainfallPlugin};
pub(crate) use view::{SoftwareAdapter, fill_containers, view_volume};
