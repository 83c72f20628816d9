//! Rain areas: where on the ground it rains, and how much.
//!
//! Without an area the weather's rain falls everywhere. Areas (Puig-Centelles, Ripolles & Chover 2009) change the rain
//! rate in a part of the ground plane; they move and fade in closed form of the time, so they have no state of their own.
//!
//! | file | concept |
//! |---|---|
//! | `ellipse.rs` | nearest point, signed distance, tangents, ray |
//! | `polygon.rs` | simple polygons: checks and signed distance |
//! | `shape.rs` | [`AreaShape`], and how far a point is from its border |
//! | `density.rs` | [`DensityMap`]: painted shares of an area's rain |
//! | `motion.rs` | [`AreaMotion`] and [`AreaFade`]: closed forms of the time |
//! | `settings.rs` | [`AreaSettings`]: one area as it is authored |
//! | `field.rs` | [`AreaField`]: all areas at one time, and the rate at a point |
//! | `integral.rs` | water on a rectangle and rain along a ray, with bounds |
//! | `field_f32.rs` | the same for what runs per drop or texel, and its packed form |
//! | `map.rs` | the rain from above, for plots |
//! | `far.rs` | an area seen from outside: where its container stands and how large it is |
//! | `in_sight.rs` | the same for every outline, soft edge included, and how near the rain is |
//!
//! # How areas combine
//! At a point with weights w (1 well inside, 0 well outside, half at the border; times what is painted there) and the
//! weather's rate W:
//!
//! ```text
//! rate = max(outside·W, max over showers of w·R) × product over scales of (1 − w(1 − f))
//! ```
//!
//! Showers do not add: where two areas of 40 mm/h overlap it rains 40 mm/h, so a region may be built of several shapes and
//! every authored number is found again on the ground. Scales multiply what falls, whoever sent it: a factor of 0 is a dry
//! hole in any rain. The rule knows no order, is continuous in place and time, and never exceeds the largest rate that was
//! authored.

mod density;
mod ellipse;
mod far;
mod field;
mod field_f32;
mod in_sight;
mod integral;
mod map;
mod motion;
mod polygon;
mod settings;
mod shape;

pub use density::{DensityMap, MAX_DENSITY_SIDE};
pub use ellipse::{ellipse_distance, ellipse_distance_f32, ellipse_nearest, ellipse_ray, ellipse_tangents};
pub use far::{FarFit, FarView, Seen, far_fit, near_share};
pub use field::{AreaField, PlacedArea, border_weight, border_weight_f32};
pub use field_f32::{AreaFieldF32, MAX_PACKED_AREAS, MAX_PACKED_ROWS};
pub use integral::GroundIntegral;
pub use map::{AreaMap, MAX_MAP_CELLS};
pub use motion::{AreaFade, AreaKey, AreaMotion};
pub use polygon::{polygon_distance, polygon_distance_f32};
pub use settings::{AreaError, AreaRain, AreaSettings, MAX_AREAS, MAX_TRANSITION_M};
pub use shape::{AreaShape, MAX_CORNERS, MAX_EXTENT_M, MIN_RADIUS_M};
