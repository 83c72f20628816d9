//! Lightning and its thunder: when and where a storm flashes, the path of a flash, its light, and what is heard of it.
//!
//! | file | concept |
//! |---|---|
//! | `settings.rs` | how often, where and how high a storm flashes |
//! | `draws.rs` | random numbers of a flash |
//! | `flash.rs` | flashes as a pure function of seed and time; strokes and their current |
//! | `channel.rs` | the path: tortuous, branched |
//! | `light.rs` | what a flash sends: illuminance of a place, luminance of channel and cloud |
//! | `thunder.rs` | delay, length, loudness and course of the sound at a place |
//!
//! Nothing is stored: flash *i* of a second is a hash of the seed, the second and *i*, as drops are hashes of their cells.

mod channel;
mod draws;
mod flash;
mod light;
mod settings;
mod thunder;

pub use channel::{Channel, mean_turn_rad};
pub use flash::{Flash, FlashKind, LONGEST_FLASH_S, MAX_STROKES, Stroke, for_each_flash};
pub use light::{FlashLight, GLOW_SPREAD_M, LUMENS_PER_M_A};
pub use settings::LightningSettings;
pub use thunder::{THUNDER_STEPS, Thunder, sound_speed_m_s, thunder_reach_m};
