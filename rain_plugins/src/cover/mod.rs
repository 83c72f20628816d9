//! What stops rain, for the picture: a depth map along the rain's direction around the view.
//!
//! The map is drawn by a depth-only camera of Bevy's own, so everything that is opaque or alpha-masked covers, moving
//! things included. It is drawn again only when something that covers moved, appeared or changed, when the view leaves
//! the map's margin, or when the fall direction turned by more than one degree; otherwise the kept copy is read. A map
//! drawn while pipelines were still being compiled may lack meshes and is drawn again until they are ready.
//!
//! # Accuracy
//! One texel is 59 mm of ground. Drops that slant otherwise than the mean are looked up from three starting heights;
//! the share of points misjudged is measured in `rain_core::cover`. Outside the map the sky is open.

mod air;
mod projection;
mod view;

pub use air::AirAroundView;
pub use projection::ShearedProjection;
pub use view::{CoverMap, CoverPlugin, CoverSettings, RainCoverView};
