//! Water on glass in the rain: on the lens of a camera, on a windscreen.
//!
//! A [`Glass`] holds single drops. Rain brings them ([`GlassImpacts`]), the hysteresis of the contact angle holds them
//! ([`retention_n`]), weight and the air along the glass move the large ones ([`GlassForcing`]), which leave a trail and
//! take in what they meet; air dries them ([`radius_after_drying_m`]), wipers take them off ([`Wipers`]).
//!
//! Places on the glass are metres from its centre: x to the right, y up along it, as the eye behind it sees them. The
//! normal points away from the eye.
//!
//! | file | concept |
//! |---|---|
//! | `impacts.rs` | what hits the glass |
//! | `sessile.rs` | a drop that sits on glass: shape, hold, run, drying |
//! | `cap_view.rs` | what a drop on glass shows |
//! | `glass.rs` | all drops of a glass over time |
//! | `wipers.rs` | arms, modes, when a place was wiped |

mod cap_view;
mod glass;
mod impacts;
mod sessile;
mod wipers;

pub use cap_view::{CapView, cap_view};
pub use glass::{Glass, GlassDrop, GlassForcing, GlassLedger, GlassShape, MAX_GLASS_DROPS};
pub use impacts::{GlassImpacts, LEAST_DROP_MM};
pub use sessile::{
    CONTACT_ANGLE_RAD, RunningForce, air_push_n, cap_radius_m, cap_volume_m3, radius_after_drying_m, retention_n,
    running_speed_m_s,
};
pub use wipers::{MAX_WIPER_ARMS, WiperArm, WiperMode, Wipers};
