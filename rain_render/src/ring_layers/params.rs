//! What a frame brings.

use std::sync::Arc;

use rain_core::waves::{CircleMap, RING_CYCLES, RingGrowth, RingLayerState, RingLayers};

use crate::gpu_types::RingLayerParams;

/// A moment of the layers on its way to the GPU.
#[derive(Debug, Clone)]
pub struct RingLayerFrame {
    pub(super) params: RingLayerParams,
    pub(super) circles: Arc<CircleMap>,
}

impl RingLayerFrame {
    /// Of layers in a state, with the variance of rings that are not drawn.
    #[must_use]
    pub fn new(layers: &RingLayers, state: &RingLayerState, hidden_variance: f32) -> Self {
        let settings = layers.settings();
        let offsets = layers.offsets();
        Self {
            params: RingLayerParams {
                parts: state.parts,
                weights: state.weights,
                wholes: state.wholes,
                cycles: RING_CYCLES,
                offset_x: offsets.map(|[x, _]| x),
                offset_z: offsets.map(|[_, z]| z),
                cells: settings.cells,
                texels: settings.circles.texels,
                repeats: settings.repeats,
                by_number: u32::from(settings.growth == RingGrowth::Number),
                steepness: state.steepness,
                hidden_variance,
                pad_a: 0,
                pad_b: 0,
            },
            circles: layers.circles().clone(),
        }
    }
}
