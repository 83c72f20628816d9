//! Commands of the pass.

use super::prepare::{RingLayerGpu, RingLayersGpu};
use crate::slope_mips::{SlopeMipsGpu, encode_slope_mips};

impl RingLayerGpu {
    /// Draws the map of the frame that was prepared, with its mips; nothing before the first.
    pub fn encode(&self, pass: &mut wgpu::ComputePass, gpu: &RingLayersGpu, mips: &SlopeMipsGpu) {
        let Some((group, target)) = self.bound() else { return };
        pass.set_pipeline(&gpu.pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.dispatch_workgroups(self.groups, self.groups, 1);
        encode_slope_mips(pass, mips, target);
    }
}
