//! Light that puddles throw onto walls and ceilings, broken up by the rain's rings.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use bevy::prelude::*;
use rain_core::waves::LEAST_ELEVATION;
use rain_render::caustics::CausticFrame;

use super::RainRings;
use crate::rainfall::RainView;
use crate::render_adapter::{WetMaterial, caustic_image};
use crate::report::{PassName, RainReport, SkipReason};
use crate::surface::{SurfaceState, WaterAppearance, WaterImages, WaterLevels};

/// What puddles throw in a frame.
#[derive(Resource, Clone, Debug, Default)]
pub struct ThrownLight {
    /// The light, and the water that throws it; none: nothing is thrown.
    pub(crate) frame: Option<CausticFrame>,
    /// Gain on what is thrown.
    pub(crate) gain: f32,
    /// The map has to be made anew.
    pub(crate) wanted: bool,
    /// The map shows what was wanted last: the GPU may not have had it yet.
    pub(crate) done: Arc<AtomicBool>,
    /// What was wanted last.
    asked: Option<CausticFrame>,
}

/// Aims the strongest directional light at the water, after the rings of the frame.
pub(super) fn throw_light(
    mut thrown: ResMut<ThrownLight>,
    rings: Option<Res<RainRings>>,
    appearance: Option<Res<WaterAppearance>>,
    surface: Option<Res<SurfaceState>>,
    levels: Option<Res<WaterLevels>>,
    suns: Query<(&DirectionalLight, &GlobalTransform, &InheritedVisibility)>,
    views: Query<&Camera, With<RainView>>,
    report: Res<RainReport>,
    water: Option<ResMut<WaterImages>>,
    mut images: ResMut<Assets<Image>>,
    materials: Option<ResMut<Assets<WetMaterial>>>,
) {
    let appearance = appearance.and_then(|a| a.validated().ok()).unwrap_or_default();
    let thrown = &mut *thrown;
    (thrown.frame, thrown.wanted, thrown.gain) = (None, false, appearance.caustics);
    let sun = suns
        .iter()
        .filter(|(sun, place, seen)| seen.get() && sun.illuminance > 0.0 && f64::from(place.back().y) > LEAST_ELEVATION)
        .max_by(|(a, ..), (b, ..)| a.illuminance.total_cmp(&b.illuminance));
    let (Some(mut water), Some(materials)) = (water, materials) else {
        return;
    };
    let reason = if appearance.caustics <= 0.0 {
        if water.caustics.take().is_some() {
            show(None, materials);
        }
        SkipReason::Disabled
    } else if !views.iter().any(|camera| camera.is_active) {
        SkipReason::NoView
    } else if !surface.is_some_and(|surface| surface.wet) {
        SkipReason::Dry
    } else if !levels.is_some_and(|levels| levels.any_water()) {
        SkipReason::NoWater
    } else if let Some((_, place, _)) = sun {
        if water.caustics.is_none() {
            let map = images.add(caustic_image());
            water.caustics = Some(map.clone());
            thrown.asked = None;
            show(Some(map), materials);
        }
        let rings = rings.filter(|rings| !rings.is_off());
        let frame = CausticFrame {
            towards: place.back().into(),
            side_m: rings.as_ref().map_or(1.0, |rings| rings.side_m()),
            strength: rings.as_ref().map_or(0.0, |_| appearance.ripple_strength),
        };
        thrown.frame = Some(frame);
        let moved = rings.is_some_and(|rings| rings.handover.wanted);
        if moved || thrown.asked.replace(frame) != Some(frame) {
            thrown.done.store(false, Relaxed);
        }
        thrown.wanted = !thrown.done.load(Relaxed);
        if thrown.wanted {
            return;
        }
        SkipReason::Settled
    } else {
        SkipReason::NoSun
    };
    report.skipped(PassName::Caustics, reason);
}

/// Wet materials read this map from now on, or none.
fn show(map: Option<Handle<Image>>, mut materials: ResMut<Assets<WetMaterial>>) {
    for (_, material) in materials.iter_mut() {
        material.extension.caustics.clone_from(&map);
    }
}
