//! Rings that rain makes on water.

use bevy::prelude::*;
use rain_core::rainfall::DropSizes;
use rain_ecs::prelude::*;
use rain_render::waves::RippleTile;

use super::Handover;
use crate::rainfall::RainView;
use crate::report::{PassName, RainReport, SkipReason};
use crate::surface::{SurfaceState, WaterAppearance, WaterLevels};

/// The tile of water that rain falls into.
#[derive(Resource, Debug)]
pub struct RainRings {
    tile: RippleTile,
    /// Time up to which it has been advanced. Units: ns.
    now_ns: Option<u64>,
    pub(crate) handover: Handover,
}

impl RainRings {
    pub(super) fn new(tile: RippleTile) -> Self {
        Self {
            tile,
            now_ns: None,
            handover: Handover::default(),
        }
    }

    /// The tile.
    #[must_use]
    pub fn tile(&self) -> &RippleTile {
        &self.tile
    }

    /// Forgets all rings: the GPU has lost them.
    pub(crate) fn lose(&mut self) {
        if let Ok(tile) = RippleTile::new(self.tile.settings()) {
            self.tile = tile;
        }
    }
}

/// The clock of what is seen: ticks and the part of the next one that has passed. Units: ns.
pub(super) fn seen_ns(clock: &RainClock) -> u64 {
    clock.now_ns() + (f64::from(clock.interpolation()) * clock.tick_ns() as f64) as u64
}

/// Lets the drops of the present rain fall onto the tile.
pub(super) fn rain_on_water(
    mut rings: ResMut<RainRings>,
    clock: Res<RainClock>,
    field: Res<RainfallField>,
    surface: Option<Res<SurfaceState>>,
    levels: Option<Res<WaterLevels>>,
    appearance: Option<Res<WaterAppearance>>,
    report: Res<RainReport>,
    views: Query<&Camera, With<RainView>>,
) {
    let rings = &mut *rings;
    rings.handover.wanted = false;
    let now = seen_ns(&clock);
    let seen = views.iter().any(|c| c.is_active);
    let reason = if !seen {
        Some(SkipReason::NoView)
    } else if appearance.is_some_and(|a| a.ripple_strength <= 0.0) {
        Some(SkipReason::Disabled)
    } else if !surface.as_ref().is_some_and(|s| s.wet) {
        Some(SkipReason::Dry)
    } else if !field.is_raining() && rings.tile.is_calm() && !rings.tile.wants_pass() {
        Some(SkipReason::NoRain)
    } else if !levels.is_some_and(|l| l.any_water()) && !surface.is_some_and(|s| s.placed) {
        Some(SkipReason::NoWater)
    } else {
        None
    };
    if let Some(reason) = reason {
        report.skipped(PassName::Ripples, reason);
        return;
    }
    let sizes = DropSizes::from(*field.spectrum());
    rings.tile.set_rain(&sizes);
    let elapsed = rings.now_ns.map_or(u64::MAX, |before| now.saturating_sub(before));
    rings.now_ns = Some(now);
    rings.tile.advance(elapsed);
    if rings.tile.wants_pass() {
        rings.tile.take(&mut rings.handover.frame);
        rings.handover.wanted = true;
    }
}
