//! What a drop does when it hits: splash threshold, crown, crater, secondary drops, and how often it happens.
//!
//! [`splash_excess`] tells whether a drop splashes, [`Splash`] what comes of it, [`secondary_drop`] gives each thrown
//! drop from a hash. [`ImpactFlux`] counts impacts and their momentum and energy on any slope in wind,
//! [`for_each_impact`] places them in cells and time slots, the same at any frame rate. [`SplashField`] is what is drawn:
//! impacts by size class around any view, [`SplashShares`] how many of them.
//!
//! | file | concept |
//! |---|---|
//! | `numbers.rs` | Weber, Reynolds, Ohnesorge number and K; mass, momentum, energy |
//! | `threshold.rs` | splash or not, on dry ground and on a film |
//! | `crown.rs` | crown and crater |
//! | `secondary.rs` | drops thrown out |
//! | `impacts.rs` | impacts per area and time |
//! | `events.rs` | single impacts from hashes |
//! | `field.rs` | what is drawn: impacts by class in cells and slots |
//! | `budget.rs` | how many of each class |
//! | `flight.rs` | the way of drops thrown out |
//! | `mist.rs` | the finest drops thrown out, as layers of extinction |
//! | `artist.rs` | the sources' own tables of splash rates |
//! | `foot.rs` | splashes of feet |
//!
//! # Accuracy
//! Thresholds are measured on smooth walls and thin films of water; rough ground splashes earlier. Crown height and
//! lifetime, numbers, sizes, speeds and angles of secondary drops are choices within measured ranges. A secondary drop
//! does not splash again.

mod artist;
mod budget;
mod crown;
mod events;
mod field;
mod flight;
mod foot;
mod impacts;
mod mist;
mod numbers;
mod secondary;
mod threshold;

pub use artist::{TrafficSplashes, artist_splashes_per_m2_s, splash_image_life_s};
pub use budget::{SplashExtent, SplashShares};
pub use crown::{
    crater_radius_m, crown_height_m, crown_life_s, crown_opacity, crown_radius_m, crown_radius_m_f32, crown_seen_s,
};
pub use events::{ImpactEvent, for_each_impact, hashed_poisson};
pub use field::{SPLASH_CELL_M, SPLASH_COUNTS, SPLASH_SLOT_S, SPLASH_SLOTS, SplashAnchor, SplashField, SplashMark};
pub use foot::{FOOT_DROPS, FOOT_SPLASH_S, foot_drop, foot_drop_count, foot_sheet, foot_splash_strength};
pub use impacts::{ImpactFlux, splashes_per_m2_s};
pub use mist::{
    MIST_SIZE, MistFlight, MistGround, MistLayer, MistLayers, friction_velocity_m_s, mist_droplets, rouse_number,
    secondary_drop_number,
};
pub use numbers::{ImpactNumbers, impact_energy_j, impact_momentum_kg_m_s, splash_k, splash_k_f32, water_drop_kg};
pub use secondary::{Impact, SecondaryDrop, Splash, SplashKind, secondary_drop};
pub use threshold::{splash_excess, splash_excess_f32, splash_threshold_diameter_mm, splash_threshold_k};
