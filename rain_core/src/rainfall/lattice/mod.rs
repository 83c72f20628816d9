//! Rain between the drops that are drawn singly and the haze: cells of air, each shown as a picture of its streaks.
//!
//! Around the view stand cubic cells, small ones nearby and larger ones beyond ([`LatticeSettings`]). Every cell has a
//! [`Card`] for each size class of a set of streak textures ([`crate::rainfall::StreakTextures`]): a square that turns
//! about the vertical to face the eye and holds all the class's drops of its cell. The cells of a class move with its
//! own velocity, wind and fall together ([`crate::rainfall::FieldMotion`]): they sink, leave the region below and come
//! in above, at any time and in either direction of time, without state. Streaks lie along the motion relative to the
//! camera.
//!
//! A card takes out of the light what its class does over the cell, less what is drawn singly there, so the optical
//! depth of single drops, cards and haze together is that of the rain ([`LatticeSharing`]). Source: Yoshida, Dobashi &
//! Yamamoto (digest B); no limit on rain rates or diameters, several cell sizes, light by pixel.
//!
//! # Accuracy
//! Cards of one class add up to their class's optical depth within 1.5 % on average over directions below 45 degrees of
//! pitch; a single line of sight meets none to two cards of a layer of cells. Steeper than 60 degrees there are none,
//! and the haze takes over. A camera that moves stretches streaks and makes as much fewer of them: the depth stays, the
//! number does not.

mod card;
mod fill;
mod lamp;
mod plan;
mod rates;
mod settings;
mod sharing;

pub use card::{Card, CardHit, pitch_weight};
pub use fill::{CardCounts, LatticeView};
pub use lamp::{Lamp, MAX_LAMPS};
pub use plan::LatticePlan;
pub use rates::LatticeRates;
pub use settings::{LatticeLevel, LatticeSettings, MAX_CARD_SAMPLES};
pub use sharing::LatticeSharing;
