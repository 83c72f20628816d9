//! Where layers and levels lie in the buffers of the pass.

use rain_core::rainfall::{OVERLAP_STEPS, StreakLayer, StreakTextureSettings, TileDrop};

use crate::gpu_types::{StreakLevel, StreakTile};

/// Format of streak textures: filters everywhere.
pub const STREAK_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;

/// Bytes between parameters that are bound by their offset.
pub(super) const SLOT: usize = 256;

/// All levels of a layer: sides, and places among texels and packed words.
pub(super) fn levels(settings: &StreakTextureSettings) -> Vec<StreakLevel> {
    let mut out: Vec<StreakLevel> = Vec::new();
    for level in 0..settings.level_count() {
        let side = settings.texels >> level;
        let row = row_bytes(side) / 4;
        let (first, above, words) = out.last().map_or((0, 0, 0), |last| {
            (
                last.first + last.side * last.side,
                last.first,
                last.words + last.row * last.side,
            )
        });
        out.push(StreakLevel {
            side,
            first,
            above,
            words,
            row,
            pad_a: 0,
            pad_b: 0,
            pad_c: 0,
        });
    }
    out
}

/// Bytes between rows of a level in a buffer that is copied to or from a texture.
pub(super) fn row_bytes(side: u32) -> u32 {
    (2 * side).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
}

/// Bytes of one layer with all its levels, rows filled up.
pub(super) fn layer_bytes(levels: &[StreakLevel]) -> u64 {
    levels.iter().map(|level| u64::from(4 * level.row * level.side)).sum()
}

/// The drops of all layers, and where those of each are.
pub(super) fn tiles(layers: &[StreakLayer], texels: u32) -> (Vec<TileDrop>, Vec<StreakTile>) {
    let mut drops = Vec::new();
    let tiles = layers
        .iter()
        .map(|layer| {
            let first = drops.len() as u32;
            drops.extend(layer.tile_drops());
            StreakTile {
                texels,
                first,
                drops: layer.drops,
                pad_a: 0,
                path: layer.path_texels() as f32,
                unit: layer.unit as f32,
                steps: OVERLAP_STEPS as f32,
                pad_b: 0,
            }
        })
        .collect();
    (drops, tiles)
}
