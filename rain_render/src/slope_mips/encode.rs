//! Commands of the pass.

use super::prepare::{SlopeMipsGpu, SlopeMipsTarget};

/// Fills all levels below the finest.
pub fn encode_slope_mips(pass: &mut wgpu::ComputePass, gpu: &SlopeMipsGpu, target: &SlopeMipsTarget) {
    pass.set_pipeline(&gpu.pipeline);
    for dispatch in &target.dispatches {
        pass.set_bind_group(0, &dispatch.group, &[]);
        pass.dispatch_workgroups(dispatch.size[0], dispatch.size[1], 1);
    }
}
