//! Rings that rain makes on water.

use bevy::prelude::*;
use rain_core::rainfall::DropSizes;
use rain_core::waves::RingLayerSettings;
use rain_ecs::prelude::*;
use rain_render::ring_layers::RingLayerTile;
use rain_render::waves::RippleTile;

use super::{Handover, WaveWaterSettings};
use crate::rainfall::RainView;
use crate::render_adapter::{WetMaterial, slope_image};
use crate::report::{PassName, RainReport, SkipReason};
use crate::surface::{SurfaceState, WaterAppearance, WaterImages, WaterLevels};

/// Where rings come from. Both make a tile of slopes that repeats over the world.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum RingSource {
    /// Each drop of the rain's size distribution presses its ring into a tile of water that is simulated.
    #[default]
    Drops,
    /// Procedural: four layers of a texture of circles. Cheaper in heavy rain, and of the same roughness; rings do not
    /// meet each other.
    Layers(RingLayerSettings),
}

/// The tile of water that rain falls into.
#[derive(Resource, Debug)]
pub struct RainRings {
    tile: RippleTile,
    /// The layers, once they have been chosen.
    layers: Option<RingLayerTile>,
    /// The source in force, and the one asked for last.
    source: RingSource,
    asked: RingSource,
    /// What each source draws into.
    drops_map: Option<Handle<Image>>,
    layers_map: Option<Handle<Image>>,
    /// Time up to which it has been advanced. Units: ns.
    now_ns: Option<u64>,
    off: bool,
    pub(crate) handover: Handover,
}

impl RainRings {
    pub(super) fn new(tile: RippleTile) -> Self {
        Self {
            tile,
            layers: None,
            source: RingSource::Drops,
            asked: RingSource::Drops,
            drops_map: None,
            layers_map: None,
            now_ns: None,
            off: false,
            handover: Handover::default(),
        }
    }

    /// The tile of simulated rings.
    #[must_use]
    pub fn tile(&self) -> &RippleTile {
        &self.tile
    }

    /// Whether rings are switched off.
    pub(crate) fn is_off(&self) -> bool {
        self.off
    }

    /// The source in force: the one asked for last that was valid.
    #[must_use]
    pub fn source(&self) -> &RingSource {
        &self.source
    }

    /// The procedural rings, where they are the source in force.
    #[must_use]
    pub fn layers(&self) -> Option<&RingLayerTile> {
        self.layers.as_ref().filter(|_| self.source != RingSource::Drops)
    }

    /// Side of the tile that is shown. Units: m.
    #[must_use]
    pub fn side_m(&self) -> f64 {
        self.layers()
            .map_or(self.tile.settings().side_m, |layers| layers.layers().settings().side_m)
    }

    /// Forgets all rings: the GPU has lost them.
    pub(crate) fn lose(&mut self) {
        if let Ok(tile) = RippleTile::new(self.tile.settings()) {
            self.tile = tile;
        }
        if let Some(layers) = &mut self.layers {
            layers.lose();
        }
    }

    fn is_idle(&self) -> bool {
        match self.layers() {
            Some(layers) => layers.is_calm() && !layers.wants_pass(),
            None => self.tile.is_calm() && !self.tile.wants_pass(),
        }
    }
}

/// Changes the source when another is asked for, and with it the texture that wet materials read.
pub(super) fn choose_rings(
    mut rings: ResMut<RainRings>,
    settings: Res<WaveWaterSettings>,
    shown: Option<ResMut<WaterImages>>,
    mut images: ResMut<Assets<Image>>,
    materials: Option<ResMut<Assets<WetMaterial>>>,
) {
    let Some(mut shown) = shown else { return };
    let rings = &mut *rings;
    // Once for each change: what is not a number never equals itself.
    if settings.is_changed() && rings.asked != settings.ring_source {
        rings.asked = settings.ring_source;
        match &settings.ring_source {
            RingSource::Drops => rings.source = RingSource::Drops,
            RingSource::Layers(layers) => match RingLayerTile::new(layers) {
                Ok(tile) => {
                    rings.layers = Some(tile);
                    rings.layers_map = Some(images.add(slope_image(layers.cells)));
                    rings.source = rings.asked;
                }
                Err(error) => error!("rings stay as they are: {error}"),
            },
        }
        // What stands in the other tile is old.
        rings.tile.reset();
        rings.now_ns = None;
    }
    let cells = rings.tile.settings().cells;
    let wanted = match rings.source {
        RingSource::Drops => {
            let map = rings.drops_map.get_or_insert_with(|| images.add(slope_image(cells)));
            Some(&*map)
        }
        RingSource::Layers(_) => rings.layers_map.as_ref(),
    };
    let Some(wanted) = wanted.filter(|map| shown.ripples != **map) else {
        return;
    };
    shown.ripples = wanted.clone();
    let Some(mut materials) = materials else { return };
    let ids: Vec<_> = materials.ids().collect();
    for id in ids {
        if let Some(mut material) = materials.get_mut(id) {
            material.extension.ripples = wanted.clone();
        }
    }
}

/// The clock of what is seen: ticks and the part of the next one that has passed. Units: ns.
pub(super) fn seen_ns(clock: &RainClock) -> u64 {
    clock.now_ns() + (f64::from(clock.interpolation()) * clock.tick_ns() as f64) as u64
}

/// Water that nobody has looked at for so long, and that nothing has moved meanwhile, is calm: e⁻⁹ is left of its waves.
/// Units: ns.
pub(super) const FORGOTTEN_NS: u64 = 30_000_000_000;

/// Lets the present rain make its rings.
pub(super) fn rain_on_water(
    mut rings: ResMut<RainRings>,
    clock: Res<RainClock>,
    field: Res<RainfallField>,
    areas: Option<Res<RainAreas>>,
    surface: Option<Res<SurfaceState>>,
    levels: Option<Res<WaterLevels>>,
    appearance: Option<Res<WaterAppearance>>,
    settings: Res<WaveWaterSettings>,
    report: Res<RainReport>,
    views: Query<&Camera, With<RainView>>,
) {
    let rings = &mut *rings;
    rings.off = settings.no_rings;
    rings.handover.wanted = false;
    rings.handover.layers = None;
    let now = seen_ns(&clock);
    if rings.now_ns.is_some_and(|before| now < before) {
        // The clock was set back: the drops of what is to come have not fallen yet.
        rings.tile.reset();
        rings.now_ns = None;
    }
    let elapsed = rings.now_ns.map_or(u64::MAX, |before| now.saturating_sub(before));
    if elapsed > FORGOTTEN_NS && !field.is_raining() {
        rings.tile.reset();
    }
    let seen = views.iter().any(|c| c.is_active);
    let reason = if !seen {
        Some(SkipReason::NoView)
    } else if rings.off || appearance.is_some_and(|a| a.ripple_strength <= 0.0) {
        Some(SkipReason::Disabled)
    } else if !surface.as_ref().is_some_and(|s| s.wet) {
        Some(SkipReason::Dry)
    } else if !field.is_raining() && rings.is_idle() {
        Some(SkipReason::NoRain)
    } else if !levels.is_some_and(|l| l.any_water()) && !surface.as_ref().is_some_and(|s| s.placed) {
        Some(SkipReason::NoWater)
    } else {
        None
    };
    if let Some(reason) = reason {
        report.skipped(PassName::Ripples, reason);
        return;
    }
    // A tile is the same everywhere: under areas it has the rain at the eye.
    let local = areas.as_deref().filter(|areas| !areas.is_uniform());
    let spectrum = match (local, surface.as_ref()) {
        (Some(areas), Some(surface)) => field.spectrum_at(areas.rate_at(surface.anchor.as_dvec3())),
        _ => *field.spectrum(),
    };
    let sizes = DropSizes::from(spectrum);
    rings.now_ns = Some(now);
    if rings.source == RingSource::Drops {
        rings.tile.set_rain(&sizes);
        rings.tile.advance(elapsed);
        if rings.tile.wants_pass() {
            rings.tile.take(&mut rings.handover.frame);
            rings.handover.wanted = true;
        }
    } else if let Some(layers) = &mut rings.layers {
        layers.set_rain(&sizes);
        layers.advance(now, elapsed);
        if layers.wants_pass() {
            rings.handover.layers = Some(layers.take());
            rings.handover.wanted = true;
        } else {
            report.skipped(PassName::Ripples, SkipReason::NothingMoved);
        }
    }
}
