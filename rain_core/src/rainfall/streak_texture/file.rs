//! Streak textures as a KTX2 file, the standard container of the Khronos Group for textures.
//!
//! An array of `VK_FORMAT_R16_SFLOAT` with all mip levels, uncompressed. Key/value data: `rain.streaks` holds
//! [`StreakTextureSettings::key_text`], `rain.checksum` a hash of all texels.

use ktx2::dfd::{Basic, Block};
use ktx2::{Format, Header, Index, LevelIndex, Reader};
use thiserror::Error;

use super::packed::PackedStreaks;
use super::settings::{StreakTextureSettings, fnv1a};

const SETTINGS_KEY: &str = "rain.streaks";
const CHECKSUM_KEY: &str = "rain.checksum";
const WRITER: &str = concat!("rain_core ", env!("CARGO_PKG_VERSION"));

/// Why a file does not give the textures that are wanted.
#[derive(Debug, Error)]
pub enum StreakFileError {
    /// It cannot be read or written.
    #[error("{path}: {error}")]
    Io {
        /// The file.
        path: String,
        /// What the system says.
        error: std::io::Error,
    },
    /// It is no KTX2 file, or ends too early.
    #[error("no whole KTX2 file: {0}")]
    NotKtx2(String),
    /// It is a KTX2 file of something else.
    #[error("no streak textures: {0}")]
    Foreign(&'static str),
    /// It holds textures of other settings or another version.
    #[error("made from other settings: {found}")]
    OtherSettings {
        /// What it was made from.
        found: String,
    },
    /// Its texels are not those that were written.
    #[error("damaged: {0}")]
    Damaged(&'static str),
}

impl PackedStreaks {
    /// The KTX2 file of these textures.
    #[must_use]
    pub fn to_ktx2(&self) -> Vec<u8> {
        let settings = self.settings();
        let (dfd, type_size) = match Basic::from_format(Format::R16_SFLOAT) {
            Ok((basic, size)) => (Block::Basic(basic).to_vec(), size),
            // The format is in the crate's own table.
            Err(_) => (Vec::new(), 2),
        };
        let levels: Vec<Vec<u8>> = self
            .levels()
            .iter()
            .map(|texels| texels.iter().flat_map(|t| t.to_le_bytes()).collect())
            .collect();
        // Keys in the order of their bytes, as the format asks.
        let mut pairs = Vec::new();
        for (key, value) in [
            ("KTXwriter", WRITER.to_owned()),
            (CHECKSUM_KEY, checksum(&levels)),
            (SETTINGS_KEY, settings.key_text()),
        ] {
            push_pair(&mut pairs, key, &value);
        }
        let dfd_offset = Header::LENGTH + levels.len() * LevelIndex::LENGTH;
        let pairs_offset = dfd_offset + 4 + dfd.len();
        let header = Header {
            format: Some(Format::R16_SFLOAT),
            type_size,
            pixel_width: settings.texels,
            pixel_height: settings.texels,
            pixel_depth: 0,
            layer_count: settings.layer_count() as u32,
            face_count: 1,
            level_count: settings.level_count(),
            supercompression_scheme: None,
            index: Index {
                dfd_byte_offset: dfd_offset as u32,
                dfd_byte_length: 4 + dfd.len() as u32,
                kvd_byte_offset: pairs_offset as u32,
                kvd_byte_length: pairs.len() as u32,
                sgd_byte_offset: 0,
                sgd_byte_length: 0,
            },
        };
        // The smallest level comes first in the file, each at a multiple of four bytes.
        let mut places = vec![0_usize; levels.len()];
        let mut end = pairs_offset + pairs.len();
        for (place, level) in places.iter_mut().zip(&levels).rev() {
            *place = end.next_multiple_of(4);
            end = *place + level.len();
        }
        let mut out = Vec::with_capacity(end);
        out.extend_from_slice(&header.as_bytes());
        for (&place, level) in places.iter().zip(&levels) {
            let index = LevelIndex {
                byte_offset: place as u64,
                byte_length: level.len() as u64,
                uncompressed_byte_length: level.len() as u64,
            };
            out.extend_from_slice(&index.as_bytes());
        }
        out.extend_from_slice(&(4 + dfd.len() as u32).to_le_bytes());
        out.extend_from_slice(&dfd);
        out.extend_from_slice(&pairs);
        for (&place, level) in places.iter().zip(&levels).rev() {
            out.resize(place, 0);
            out.extend_from_slice(level);
        }
        out
    }

    /// The textures of `settings` from a file's bytes.
    ///
    /// # Errors
    /// When it is no KTX2 file, cut off, of something else, of other settings, or its texels are damaged.
    pub fn from_ktx2(bytes: &[u8], settings: &StreakTextureSettings) -> Result<Self, StreakFileError> {
        let reader = Reader::new(bytes).map_err(|error| StreakFileError::NotKtx2(error.to_string()))?;
        let header = reader.header();
        let value = |wanted: &str| {
            reader
                .key_value_data()
                .find(|(key, _)| *key == wanted)
                .map(|(_, value)| String::from_utf8_lossy(value.strip_suffix(&[0]).unwrap_or(value)).into_owned())
        };
        let found = value(SETTINGS_KEY).ok_or(StreakFileError::Foreign("no settings of streak textures in it"))?;
        if found != settings.key_text() {
            return Err(StreakFileError::OtherSettings { found });
        }
        let shape = (
            header.pixel_width,
            header.pixel_height,
            header.pixel_depth,
            header.face_count,
        );
        let fits = header.format == Some(Format::R16_SFLOAT)
            && header.supercompression_scheme.is_none()
            && shape == (settings.texels, settings.texels, 0, 1)
            && header.layer_count as usize == settings.layer_count()
            && header.level_count == settings.level_count();
        if !fits {
            return Err(StreakFileError::Foreign(
                "its shape or format is not that of its settings",
            ));
        }
        let raw: Vec<&[u8]> = reader.levels().map(|level| level.data).collect();
        if value(CHECKSUM_KEY) != Some(checksum(&raw)) {
            return Err(StreakFileError::Damaged(
                "the checksum of its texels is not the one stored",
            ));
        }
        let levels = raw
            .iter()
            .map(|level| {
                level
                    .chunks_exact(2)
                    .map(|t| u16::from_le_bytes([t[0], t[1]]))
                    .collect()
            })
            .collect();
        Self::new(settings, levels).ok_or(StreakFileError::Damaged("texels are missing, negative or not finite"))
    }
}

/// Hash of all levels, the finest first.
fn checksum(levels: &[impl AsRef<[u8]>]) -> String {
    let each: Vec<u8> = levels
        .iter()
        .flat_map(|level| fnv1a(level.as_ref()).to_le_bytes())
        .collect();
    format!("{:016x}", fnv1a(&each))
}

/// One pair of the key/value data: length, key, value, each ended by a zero, filled up to four bytes.
fn push_pair(out: &mut Vec<u8>, key: &str, value: &str) {
    let length = key.len() + value.len() + 2;
    out.extend_from_slice(&(length as u32).to_le_bytes());
    out.extend_from_slice(key.as_bytes());
    out.push(0);
    out.extend_from_slice(value.as_bytes());
    out.push(0);
    out.resize(out.len().next_multiple_of(4), 0);
}
