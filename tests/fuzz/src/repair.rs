//! Makes lengths and checksums right again after damage, so that it reaches what lies behind them.

use crate::target::Target;

/// Puts the outer shell of the format in order, where it has one.
pub fn repair(target: Target, bytes: &mut [u8]) {
    match target {
        Target::Png => png(bytes),
        Target::Gltf => glb(bytes),
        Target::Hyetograph | Target::Csv | Target::Model => {}
    }
}

/// The checksum of every chunk whose length fits.
fn png(bytes: &mut [u8]) {
    let mut at = 8;
    while let Some(head) = bytes.get(at..at + 8) {
        let length = u32::from_be_bytes([head[0], head[1], head[2], head[3]]) as usize;
        let Some(end) = at.checked_add(8 + length).filter(|end| end + 4 <= bytes.len()) else {
            return;
        };
        let sum = crc(&bytes[at + 4..end]);
        bytes[end..end + 4].copy_from_slice(&sum.to_be_bytes());
        at = end + 4;
    }
}

/// The checksum of PNG chunks.
#[must_use]
pub fn crc(bytes: &[u8]) -> u32 {
    let mut crc = u32::MAX;
    for byte in bytes {
        crc ^= u32::from(*byte);
        for _ in 0..8 {
            crc = crc >> 1 ^ if crc & 1 == 1 { 0xedb8_8320 } else { 0 };
        }
    }
    !crc
}

/// The file's length and the JSON chunk's: up to where the binary chunk starts, or the end.
fn glb(bytes: &mut [u8]) {
    if !bytes.starts_with(b"glTF") || bytes.len() < 20 {
        return;
    }
    let length = bytes.len() as u32;
    bytes[8..12].copy_from_slice(&length.to_le_bytes());
    let binary = bytes.windows(4).position(|w| w == b"BIN\0").filter(|at| *at >= 24);
    let json = binary.map_or(bytes.len(), |at| at - 4) - 20;
    bytes[12..16].copy_from_slice(&(json as u32).to_le_bytes());
    if let Some(at) = binary {
        let rest = (bytes.len() - at - 4) as u32;
        bytes[at - 4..at].copy_from_slice(&rest.to_le_bytes());
    }
}
