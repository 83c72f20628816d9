//! Where the per-view systems run.

use bevy::prelude::*;

/// Per-view work in `PostUpdate`, after transforms are propagated.
#[derive(SystemSet, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RainViewSystems {
    /// Points the cover camera; before cameras and frusta are updated.
    Cover,
    /// Fills each view's rain container; after cameras are updated.
    Views,
    /// What surfaces show, and the mirrored view; before cameras and frusta are updated.
    Surfaces,
}
