//! Rain in the air for each marked camera: single drops in a container that follows the view, cards of many beyond.

mod cards;
mod frame_budget;
mod lamps;
mod lead;
mod motion;
mod panes;
mod parallel;
mod settings;
mod view;

pub use cards::CardViewFrame;
pub(crate) use cards::{CardShot, LatticeState, fill_cards};
pub use frame_budget::{BudgetedTime, RainFrameBudget, RainShare};
pub use lamps::ViewLamps;
pub(crate) use lamps::{SceneLamps, keep_strongest, shining};
pub(crate) use lead::leading_view;
pub use motion::ViewMotion;
pub use panes::{SeenThrough, ViewPanes};
pub(crate) use parallel::{Picture, ViewPlace, ViewPlaceItem, seen_place};
pub use rain_core::rainfall::{
    DetailLaw, FollowSettings, FollowShape, LatticeLevel, LatticeSettings, StreakTextureSettings,
};
pub use settings::CardSettings;
pub use view::{MAX_CONTRAST, MAX_STREAK_BUDGET, RainView, RainViewFrame, RainfallPlugin};
pub(crate) use view::{SoftwareAdapter, choose_drops, view_volume};
