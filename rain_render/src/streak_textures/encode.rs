//! Commands of the pass.

use super::params::{SLOT, row_bytes};
use super::prepare::{StreakArray, StreakTextureGpu};

/// Workgroups of a dispatch along its first axis, as the shader counts them.
const GROUPS: u32 = 32_768;

/// Draws the textures if they are still to be drawn, and lets go of what that takes. Returns whether it recorded
/// anything.
pub fn encode_streak_textures(
    encoder: &mut wgpu::CommandEncoder,
    gpu: &StreakTextureGpu,
    array: &mut StreakArray,
) -> bool {
    let Some(bake) = array.bake.take() else { return false };
    for (layer, tile) in bake.tiles.iter().enumerate() {
        encoder.clear_buffer(&bake.overlap, 0, None);
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("rain streak textures"),
                timestamp_writes: None,
            });
            let mut run = |pipeline: &wgpu::ComputePipeline, level: usize, groups: u32| {
                pass.set_pipeline(pipeline);
                let slot = |index: usize| (SLOT * index) as u32;
                pass.set_bind_group(0, &bake.group, &[slot(layer), slot(bake.tiles.len() + level)]);
                pass.dispatch_workgroups(groups.min(GROUPS), groups.div_ceil(GROUPS), 1);
            };
            run(&gpu.add, 0, tile.drops);
            for (index, level) in bake.levels.iter().enumerate() {
                let pipeline = if index == 0 { &gpu.resolve } else { &gpu.halve };
                run(pipeline, index, (level.side * level.side).div_ceil(64));
            }
            for (index, level) in bake.levels.iter().enumerate() {
                run(&gpu.pack, index, ((level.side / 2).max(1) * level.side).div_ceil(64));
            }
        }
        for (index, level) in bake.levels.iter().enumerate() {
            encoder.copy_buffer_to_texture(
                wgpu::TexelCopyBufferInfo {
                    buffer: &bake.packed,
                    layout: wgpu::TexelCopyBufferLayout {
                        offset: u64::from(4 * level.words),
                        bytes_per_row: Some(row_bytes(level.side)),
                        rows_per_image: Some(level.side),
                    },
                },
                wgpu::TexelCopyTextureInfo {
                    texture: &array.texture,
                    mip_level: index as u32,
                    origin: wgpu::Origin3d {
                        x: 0,
                        y: 0,
                        z: layer as u32,
                    },
                    aspect: wgpu::TextureAspect::All,
                },
                wgpu::Extent3d {
                    width: level.side,
                    height: level.side,
                    depth_or_array_layers: 1,
                },
            );
        }
    }
    true
}
