//! Near rain for each marked camera: the container that follows the view.

mod lead;
mod motion;
mod view;

pub(crate) use lead::leading_view;
pub use motion::ViewMotion;
pub use rain_core::rainfall::{FollowSettings, FollowShape};
pub(crate) use view::SoftwareAdapter;
pub use view::{MAX_CONTRAST, MAX_STREAK_BUDGET, RainView, RainViewFrame, RainfallPlugin};
