//! What a cover map refuses.

use crate::error::ConfigError;
use thiserror::Error;

use super::scene::OccluderId;

/// Why a change to a cover map, or a question to it, was refused. The map stays as it was.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CoverError {
    /// A number outside its domain, or not finite.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The occluders touch more tiles than the map may hold: usually a sky dome or a ground plane without end.
    /// Leave such a mesh out, raise `max_tiles` or the cell size.
    #[error("cover map needs {needed} tiles, allowed: {allowed}")]
    TooManyTiles {
        /// Tiles that the change would need.
        needed: usize,
        /// The bound in the settings.
        allowed: usize,
    },
    /// One triangle spans more of the projected plane than exact arithmetic allows.
    #[error("occluder {} spans {extent_m} m of the projected plane, allowed: up to {allowed_m} m", .occluder.0)]
    TooWide {
        /// The occluder.
        occluder: OccluderId,
        /// Its larger side in the projected plane. Units: m.
        extent_m: f64,
        /// The largest side allowed. Units: m.
        allowed_m: f64,
    },
    /// `add` with an id that is in use.
    #[error("occluder {} is already in the cover map", .id.0)]
    DuplicateOccluder {
        /// The id.
        id: OccluderId,
    },
    /// `replace` or `remove` with an id that is not in use.
    #[error("occluder {} is not in the cover map", .id.0)]
    UnknownOccluder {
        /// The id.
        id: OccluderId,
    },
}
