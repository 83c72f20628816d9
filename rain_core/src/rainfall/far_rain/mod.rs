//! Far rain: a shower seen from outside, as particles that each stand for many drops (Puig-Centelles, Ripolles & Chover 2009).
//!
//! From afar a drop is far thinner than a pixel and a shower is a curtain of haze. What the eye still sees in it are shafts:
//! packets of denser rain, drawn out along the fall, that sink and drift. A [`FarParticle`] is such a packet. It takes its light
//! out of the haze's optical depth ([`FarAccount`]), so the curtain is as dense with particles as without.
//!
//! Particles stand in lattices of the rain's own frame, each level twice as coarse as the one before and used at twice its
//! distance: they are larger and fewer the further away the rain is, and of about one size in the picture. Each has a place
//! and a rank in [0, 1) for ever, and is there where the density of its place reaches its rank; what moves is the lattice.
//! Nothing is stored, nothing is put back: what leaves a container below has come in above.
//!
//! | file | concept |
//! |---|---|
//! | `settings.rs` | [`FarRainSettings`] |
//! | `account.rs` | [`FarAccount`]: how much of the rain is far rain, by distance and direction |
//! | `particle.rs` | [`FarParticle`]: its size and what it obscures |
//! | `fill.rs` | [`FarRain`]: the particles of a view, in its containers |
//!
//! # Accuracy
//! The mean over lines of sight is the curtain's within 5 %; a line by itself meets no particle or several, which is what
//! makes shafts. Particles are flat, face the eye and have one speed, that of drops of 2.5 mm. Those that look steeper than
//! 49° up or more than 6° down are left to the haze.

mod account;
mod fill;
mod particle;
mod settings;

pub use account::{FAR_BEGIN_M, FAR_PITCH, FarAccount, FarEye, cloud_share, far_begin, far_pitch_weight};
pub use fill::{FarRain, FarRainView};
pub use particle::{FAR_HEIGHT, FAR_OPACITY, FAR_SHADE, FarParticle, far_presence, far_profile};
pub use settings::{FarRainSettings, MAX_FAR_PARTICLES};
