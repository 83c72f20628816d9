//! Commands of the pass.

use super::prepare::{LEVEL_STRIDE, STAMP_STRIDE, WaterMapGpu, WaterMapPasses};

impl WaterMapGpu {
    /// Does the frame that was prepared.
    pub fn encode(&self, pass: &mut wgpu::ComputePass, passes: &WaterMapPasses) {
        let Some(group) = &self.group else { return };
        if self.advances {
            pass.set_pipeline(&passes.advance);
            for level in 0..self.levels {
                pass.set_bind_group(0, group, &[level * LEVEL_STRIDE as u32]);
                pass.dispatch_workgroups(self.texels / 8, self.texels / 8, 1);
            }
        }
        for (index, (level, count)) in (0_u32..).zip(&self.boxes) {
            pass.set_bind_group(0, group, &[level * LEVEL_STRIDE as u32]);
            pass.set_bind_group(1, &self.stamp_group, &[index * STAMP_STRIDE as u32]);
            for pipeline in [&passes.press, &passes.lay] {
                pass.set_pipeline(pipeline);
                pass.dispatch_workgroups(count[0].div_ceil(8), count[1].div_ceil(8), 1);
            }
        }
    }
}
