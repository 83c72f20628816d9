//! Which lamps glow in a view.

use bevy::prelude::*;
use rain_core::rainfall::Lamp;

use crate::rainfall::{SceneLamps, keep_strongest, shining};

/// The `most` lamps with the most light at the eye, the strongest first: positions relative to the eye (m), intensities in cd
/// times `gain`.
pub(super) fn glowing(lamps: &SceneLamps, eye: Vec3, most: usize, gain: f32) -> Vec<Lamp> {
    let mut out = Vec::new();
    if most == 0 || gain <= 0.0 {
        return out;
    }
    let scored = |lamp: Lamp| {
        let lamp = Lamp {
            position_m: lamp.position_m - eye,
            intensity: lamp.intensity * gain,
            ..lamp
        };
        (lamp.intensity.max_element() / lamp.position_m.length().max(1.0), lamp)
    };
    let mut found: Vec<(f32, Lamp)> = shining(lamps)
        .map(scored)
        .filter(|(score, _)| *score > 0.0 && score.is_finite())
        .collect();
    keep_strongest(&mut found, most, &mut out);
    out
}
