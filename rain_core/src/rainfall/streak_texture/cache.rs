//! A folder of streak textures, one file for each set of settings.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::file::StreakFileError;
use super::packed::PackedStreaks;
use super::settings::StreakTextureSettings;
use crate::error::ConfigError;

/// A folder in which textures are kept.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StreakCache {
    folder: PathBuf,
}

/// Where textures came from.
#[derive(Debug)]
pub enum CacheOutcome {
    /// The file had them.
    Read,
    /// There was no file: they were made.
    Made,
    /// The file could not be used: they were made anew.
    Remade(StreakFileError),
}

/// Textures, with what had to be done for them.
#[derive(Debug)]
pub struct CachedStreaks {
    /// The textures.
    pub textures: PackedStreaks,
    /// Where they came from.
    pub outcome: CacheOutcome,
    /// Their file.
    pub path: PathBuf,
    /// Why what was made could not be stored: the textures are right all the same.
    pub not_stored: Option<StreakFileError>,
}

impl StreakCache {
    /// The cache in `folder`, which is made when something is stored.
    #[must_use]
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into() }
    }

    /// The file of some settings: `streaks-` and their key.
    #[must_use]
    pub fn path(&self, settings: &StreakTextureSettings) -> PathBuf {
        self.folder.join(format!("streaks-{:016x}.ktx2", settings.key()))
    }

    /// Reads the textures of `settings`; `None` where there is no file.
    ///
    /// # Errors
    /// When the file cannot be read, or is not theirs: foreign, damaged, cut off, of another version.
    pub fn read(&self, settings: &StreakTextureSettings) -> Result<Option<PackedStreaks>, StreakFileError> {
        let path = self.path(settings);
        let failed = |error| io_error(&path, error);
        let length = match fs::metadata(&path) {
            Ok(metadata) => metadata.len(),
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(failed(error)),
        };
        // Some kilobytes of header come on top; a file far larger is not read to see that it is wrong.
        if length > settings.bytes() as u64 + 65_536 {
            return Err(StreakFileError::Foreign("larger than its settings make it"));
        }
        let bytes = fs::read(&path).map_err(failed)?;
        PackedStreaks::from_ktx2(&bytes, settings).map(Some)
    }

    /// Stores textures and returns their file. Whoever reads meanwhile finds the old file or the new one whole.
    ///
    /// # Errors
    /// When the folder or the file cannot be written.
    pub fn store(&self, textures: &PackedStreaks) -> Result<PathBuf, StreakFileError> {
        let path = self.path(textures.settings());
        fs::create_dir_all(&self.folder).map_err(|error| io_error(&self.folder, error))?;
        let part = path.with_extension(format!("part-{}", std::process::id()));
        fs::write(&part, textures.to_ktx2()).map_err(|error| io_error(&part, error))?;
        fs::rename(&part, &path).map_err(|error| io_error(&path, error))?;
        Ok(path)
    }

    /// Reads the textures of `settings`, or makes them with `bake` and stores them. A file that cannot be used is
    /// replaced.
    ///
    /// # Errors
    /// As `bake`.
    pub fn get(
        &self,
        settings: &StreakTextureSettings,
        bake: impl FnOnce(&StreakTextureSettings) -> Result<PackedStreaks, ConfigError>,
    ) -> Result<CachedStreaks, ConfigError> {
        // Settings that nothing can be made from have no file.
        settings.layers()?;
        let path = self.path(settings);
        let outcome = match self.read(settings) {
            Ok(Some(textures)) => {
                return Ok(CachedStreaks {
                    textures,
                    outcome: CacheOutcome::Read,
                    path,
                    not_stored: None,
                });
            }
            Ok(None) => CacheOutcome::Made,
            Err(error) => CacheOutcome::Remade(error),
        };
        let textures = bake(settings)?;
        let not_stored = self.store(&textures).err();
        Ok(CachedStreaks {
            textures,
            outcome,
            path,
            not_stored,
        })
    }
}

fn io_error(path: &Path, error: std::io::Error) -> StreakFileError {
    StreakFileError::Io {
        path: path.display().to_string(),
        error,
    }
}
