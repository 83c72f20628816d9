//! Commands of the pass.

use super::prepare::{STRIDE, WaveTileGpu, WavesGpu};
use crate::slope_mips::{SlopeMipsGpu, encode_slope_mips};

impl WaveTileGpu {
    /// Does the frame that was prepared, then draws the map with its mips.
    pub fn encode(&self, pass: &mut wgpu::ComputePass, gpu: &WavesGpu, mips: &SlopeMipsGpu) {
        let around = self.cells / 8;
        let mut now = self.first;
        let bind = |pass: &mut wgpu::ComputePass, now: usize, index: usize| {
            pass.set_bind_group(0, &self.groups[now], &[(index * STRIDE) as u32]);
        };
        bind(pass, now, 0);
        if self.settle {
            pass.set_pipeline(&gpu.settle);
            pass.dispatch_workgroups(around, around, 1);
        }
        for (index, step) in self.frame.iter().enumerate() {
            bind(pass, now, index);
            if step.sources > 0 {
                if self.balance {
                    pass.set_pipeline(&gpu.gather);
                    pass.dispatch_workgroups(step.sources, 1, 1);
                }
                pass.set_pipeline(&gpu.add);
                pass.dispatch_workgroups(step.bins, 1, 1);
            }
            if step.steps {
                pass.set_pipeline(&gpu.step);
                pass.dispatch_workgroups(around, around, 1);
                now = 1 - now;
            }
        }
        bind(pass, now, self.frame.len());
        pass.set_bind_group(1, &self.map, &[]);
        pass.set_pipeline(&gpu.slopes);
        pass.dispatch_workgroups(around, around, 1);
        encode_slope_mips(pass, mips, &self.mips);
    }
}
