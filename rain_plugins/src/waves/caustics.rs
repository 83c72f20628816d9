//! Light that puddles throw onto walls and ceilings, broken up by the rain's rings.

use bevy::prelude::*;
use rain_core::waves::LEAST_ELEVATION;
use rain_render::caustics::CausticFrame;

use super::RainRings;
use crate::rainfall::RainView;
use crate::render_adapter::{WetMaterial, caustic_image};
use crate::report::{PassName, RainReport, SkipReason};
use crate::surface::{SurfaceState, WaterAppearance, WaterImages, WaterLevels};

/// What puddles throw in a frame.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub struct ThrownLight {
    /// The light, and the water that throws it; none: nothing is thrown.
    pub(crate) frame: Option<CausticFrame>,
    /// Gain on what is thrown.
    pub(crate) gain: f32,
    /// The map has to be made anew.
    pub(crate) wanted: bool,
    /// What the map shows.
    drawn: Option<CausticFrame>,
}

impl ThrownLight {
    /// The map is gone: the GPU has lost it.
    pub(crate) fn lose(&mut self) {
        self.drawn = None;
    }
}

/// Aims the strongest directional light at the water, after the rings of the frame.
pub(super) fn throw_light(
    mut thrown: ResMut<ThrownLight>,
    rings: Res<RainRings>,
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
            show(&map, materials);
        }
        let strength = if rings.is_off() {
            0.0
        } else {
            appearance.ripple_strength
        };
        let frame = CausticFrame {
            towards: place.back().into(),
            side_m: rings.side_m(),
            strength,
        };
        thrown.frame = Some(frame);
        thrown.wanted = thrown.drawn != Some(frame) || rings.handover.wanted;
        thrown.drawn = Some(frame);
        if thrown.wanted {
            return;
        }
        SkipReason::Settled
    } else {
        SkipReason::NoSun
    };
    report.skipped(PassName::Caustics, reason);
}

/// Wet materials read the map from now on.
fn show(map: &Handle<Image>, mut materials: ResMut<Assets<WetMaterial>>) {
    for (_, material) in materials.iter_mut() {
        material.extension.caustics = Some(map.clone());
    }
}
