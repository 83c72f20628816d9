//! Wheels on wet roads: water met and thrown, spray, grip and hydroplaning, tracks.
//! What a wheel does to a field of waves is in [`waves`](crate::waves).
//!
//! [`WheelWater`] splits the water that a tyre meets among four mechanisms, [`WheelTrail`] says what of it is thrown,
//! pushed aside and left, [`spray_droplet`] how each mechanism throws, [`SprayEmitter`] turns mass into particles
//! within a budget. [`wheel_on_film`] is the calculator.
//!
//! | file | concept |
//! |---|---|
//! | `tyre.rs` | a tyre's parameters |
//! | `water.rs` | water met, its split, what is left behind |
//! | `friction.rs` | friction of a tyre on wet ground of any class |
//! | `hydroplaning.rs` | the speed at which a tyre floats, grip below it |
//! | `spray.rs` | where each mechanism throws which drops |
//! | `emitter.rs` | particles within a budget that keep the mass |
//! | `air.rs` | spray slowed by air |
//! | `track.rs` | the wet road's tracks closing behind |
//! | `calculator.rs` | everything about one wheel at once |
//!
//! # Accuracy
//! The split is by geometry: what clings, what the grooves carry, and the rest. Which of the rest goes ahead and which
//! aside, from which speed water flies, sizes, angles and speeds of spray are choices. Hydroplaning formulas are fits
//! to tests of tyres of the 1960s and 1970s; new tyres float some 10 % later.

mod air;
mod calculator;
mod emitter;
mod friction;
mod hydroplaning;
mod spray;
mod track;
mod tyre;
mod water;

pub use air::{spray_reach_m, spray_relative_speed_m_s, spray_relaxation_s};
pub use calculator::{WheelReport, hydroplaning_speed_km_h, wheel_on_film};
pub use emitter::{SprayEmitter, spray_parcel_kg};
pub use friction::{GroundWater, ground_friction};
pub use hydroplaning::{GallawayCase, gallaway_speed_km_h, grip_share, horne_speed_km_h, hydroplanes, wet_grip};
pub use spray::{SprayDroplet, SprayMechanism, drops_per_kg, spray_droplet};
pub use track::track_film_mm;
pub use tyre::Tyre;
pub use water::{WheelTrail, WheelWater};
