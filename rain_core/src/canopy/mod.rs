//! Trees: interception, storage, free throughfall, drip and stemflow, and the drops that drip.
//!
//! Rain over a crown goes through gaps ([`CanopyProperties::free_share`]) or is intercepted. [`CanopyStore`] holds what
//! the leaves hold and says how much drips, runs down the trunk and evaporates over an interval. [`DripSizes`] and
//! [`radial_shares`] say in which drops and where under the crown it drips, [`DripPlan`] hands it to single drip
//! places without losing water, and [`nearest_drip`] finds the drop of one place that is nearest to a point below it.
//!
//! | file | concept |
//! |---|---|
//! | `properties.rs` | species, leaf area, capacity, gaps, saturation time |
//! | `state_form.rs` | the storage equation, solved exactly |
//! | `store.rs` | the water of one crown, its fluxes over an interval, the calculator |
//! | `alternatives.rs` | other ways to solve the storage equation, for comparison |
//! | `drip_sizes.rs` | drop sizes by leaf, by volume and by number |
//! | `drip_places.rs` | where under the crown it drips |
//! | `drip_rate.rs` | flow, frequency, period |
//! | `drip_plan.rs` | drip places with their drops, rates and counters |
//! | `drip_stream.rs` | the drops under one place, in closed form |
//!
//! # Accuracy
//! Storage, saturation and sizes are regressions over few trees, measured indoors and without wind. Splash droplets
//! from leaves are left out (Weber et al. 2016), and the crown is one store: nothing drips from leaf to leaf. Drip
//! stops with the rain, real crowns go on for a while. Without rain the store dries by Rutter's law, at a rate that
//! falls with the store; with rain, however light, wet leaves lose the potential rate.

mod alternatives;
mod drip_places;
mod drip_plan;
mod drip_rate;
mod drip_sizes;
mod drip_stream;
mod properties;
mod state_form;
mod store;

pub use alternatives::{lambert_w0, stored_by_lambert_w, stored_by_splitting};
pub use drip_places::{
    CrownPlace, RADIAL_DISTANCES_M, RADIAL_SHARES, RADIAL_THICKNESSES_M, crown_place, radial_class, radial_shares,
};
pub use drip_plan::{DripClock, DripPlan};
pub use drip_rate::{drip_flow_m3_s, drip_frequency_hz, drip_period_s, drop_volume_m3};
pub use drip_sizes::{
    DRIP_BIN_MM, DRIP_BINS, DRIP_MAX_MM, DRIP_MIN_MM, DRIP_VOLUME_SHARES, DripSizes, LeafType, gaussian_drip_share,
};
pub use drip_stream::{
    Drip, DripF32, drip_crest, drip_distance_m, drip_distance_m_f32, drip_fall_time_s, drip_fall_time_s_f32,
    nearest_drip, nearest_drip_f32,
};
pub use properties::{CanopyKind, CanopyProperties, constant_rain_drip_fraction, saturation_time_s};
pub use store::{CanopyFluxes, CanopyShower, CanopyStore, canopy_shower};
