//! Commands of the pass.

use rain_core::waves::{CAUSTIC_RAYS, CAUSTIC_TEXELS};

use super::prepare::CausticsGpu;

impl CausticsGpu {
    /// Forgets what was thrown before; ahead of [`Self::encode`], outside all passes.
    pub fn clear(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.thrown, 0, None);
    }

    /// Throws and gathers the light of the frame that was prepared; nothing before the first. Needs the rings of the frame
    /// in their map.
    pub fn encode(&self, pass: &mut wgpu::ComputePass) {
        let Some(group) = self.group() else { return };
        pass.set_bind_group(0, group, &[]);
        for (pipeline, side) in [(&self.send, CAUSTIC_RAYS), (&self.gather, CAUSTIC_TEXELS)] {
            pass.set_pipeline(pipeline);
            pass.dispatch_workgroups(side / 8, side / 8, 1);
        }
    }
}
