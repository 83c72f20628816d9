//! Sky cover: what stops rain before it reaches a point.
//!
//! The scene is seen along the mean fall direction by a sheared projection onto a horizontal plane
//! ([`projection`]). [`CoverScene`] keeps the highest occluder along each of those rays in world-anchored
//! tiles ([`height_tiles`]) and answers for single points. Slow drops slant more in the wind than fast ones;
//! the look-up ([`lookup`]) allows for it with three starts and is written so that a shader can hold the same
//! formula line for line.
//!
//! Tree crowns let a share of the rain through and do not belong in the same map as roofs: give them a
//! `CoverScene` of their own and blend by its exposure.
//!
//! # Accuracy
//! A map holds one height per ray: where one roof stands above another only the upper one is known, and not how thick
//! it is, so a drop that passes close below it may be taken as stopped. Share of points in free air at 0–3 m that are
//! misclassified, % (wrongly dry / wrongly wet), drops weighted as those drawn singly at 25 mm/h, wind
//! 0 · 5 · 10 · 20 m/s, measured by `street_test` against exact ray casts:
//!
//! | scene, cell | look-up | look-up, one height bound of 8 m | mean direction only |
//! |---|---|---|---|
//! | roofs at 4 m, 0.0625 m | 0.2/0.1 · 0.1/0.1 · 0.2/0.1 · 0.2/0.2 | 0.2/0.1 · 0.2/0.1 · 0.3/0.2 · 0.5/0.4 | 0.2/0.1 · 2.4/2.4 · 4.3/4.3 · 7.4/7.1 |
//! | roofs at 4 m, 0.25 m | 0.5/0.4 · 0.5/0.5 · 0.5/0.5 · 0.5/0.4 | 0.5/0.4 · 0.5/0.5 · 0.6/0.5 · 0.8/0.6 | 0.5/0.4 · 2.5/2.4 · 4.3/4.4 · 7.5/7.1 |
//! | mixed roofs at 2.5–8 m and buildings, 0.0625 m | 0.2/0.0 · 0.3/0.1 · 0.5/0.2 · 1.0/0.4 | 0.2/0.0 · 0.3/0.2 · 0.7/0.3 · 1.2/0.6 | 0.2/0.0 · 3.1/2.8 · 4.8/4.5 · 6.7/5.7 |
//! | mixed roofs at 2.5–8 m and buildings, 0.25 m | 0.6/0.3 · 0.7/0.5 · 1.0/0.4 · 1.3/0.8 | 0.6/0.3 · 0.7/0.5 · 1.0/0.4 · 1.4/0.9 | 0.6/0.3 · 3.3/2.9 · 5.0/4.5 · 6.8/5.8 |
//!
//! [`CoverScene`] bounds the occluders' height along each drop's own way; one bound for the whole map is what a shader
//! without a pyramid of maxima has. The slowest singles (0.5 mm) are worst: in 20 m/s 2–8 % of the points let them
//! through under a roof, 7–10 % with one bound. An edge is known to half a cell; what is narrower than a cell in the
//! projected plane may be missed.

pub mod air;
mod directions;
mod error;
pub mod height_tiles;
pub mod lookup;
pub mod projection;
mod query;
pub(crate) mod raster;
mod scene;
#[cfg(test)]
mod scene_test;
#[cfg(test)]
mod street_test;

pub use directions::RainDirections;
pub use error::CoverError;
pub use projection::{FallSlope, ShearedOrthographic, ShearedOrthographicSettings, project};
pub use query::ClassShare;
pub use scene::{CoverScene, CoverSettings, OccluderId, SkippedTriangles};
