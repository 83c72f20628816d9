//! Lamps near a view, as passes read them.

use rain_core::rainfall::{Lamp, MAX_LAMPS};

use crate::gpu_types::LampParams;

/// The first [`MAX_LAMPS`] of a list, and how many they are.
pub(crate) fn slots(lamps: &[Lamp]) -> ([LampParams; MAX_LAMPS], u32) {
    let mut slots = [bytemuck::Zeroable::zeroed(); MAX_LAMPS];
    for (slot, lamp) in slots.iter_mut().zip(lamps) {
        *slot = LampParams::from(lamp);
    }
    (slots, lamps.len().min(MAX_LAMPS) as u32)
}

impl From<&Lamp> for LampParams {
    fn from(lamp: &Lamp) -> Self {
        Self {
            place: lamp.position_m.extend(lamp.radius_m).to_array(),
            intensity: lamp.intensity.extend(lamp.cos_inner).to_array(),
            direction: lamp.direction.extend(lamp.cos_outer).to_array(),
            limits: [lamp.range_m.powi(2).recip(), 0.0, 0.0, 0.0],
        }
    }
}
