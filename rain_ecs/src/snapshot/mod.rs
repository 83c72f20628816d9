//! The whole simulated state as plain data: saved, sent, restored.
//!
//! | file | concept |
//! |---|---|
//! | `mod.rs` | [`RainSnapshot`], the parts of it |
//! | `clock.rs` | clock and seed |
//! | `weather.rs` | the weather and the open ground |
//! | `rainfall.rs` | the drop field's motion |
//!
//! Each phenomenon adds its part with [`SnapshotAppExt::snapshot_part`], as it adds its state to the hash. What the
//! host puts into the world (occluders, the scene's triangles) is not in a snapshot: restore it into a world of the same
//! scene. Restored, the world goes on bit for bit as the saved one did.

mod clock;
mod rainfall;
mod weather;

use std::collections::BTreeMap;
use std::hash::Hasher;

use bevy_app::App;
use bevy_ecs::prelude::*;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use thiserror::Error;
use twox_hash::XxHash64;

pub(crate) use clock::{ClockPart, SeedPart};
pub(crate) use rainfall::RainfallPart;
pub(crate) use weather::WeatherPart;

/// Version of [`RainSnapshot`] that this library writes and reads.
pub const SNAPSHOT_VERSION: u32 = 1;

/// Names of parts that are seen only start so: a world without a renderer neither has nor needs them, so they may be
/// missing in a snapshot and unknown to a world.
pub const SEEN_ONLY: &str = "seen_";

/// Puts a checked part into the world.
pub type Apply = Box<dyn FnOnce(&mut World) + Send>;

/// Why a snapshot was not made or not restored. The world is as it was.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SnapshotError {
    /// Written by another version of this library.
    #[error("the snapshot has version {found}, supported: {supported}")]
    Version {
        /// The snapshot's.
        found: u32,
        /// This library's.
        supported: u32,
    },
    /// Changed or cut off since it was written.
    #[error("the snapshot is damaged: its checksum does not fit")]
    Checksum,
    /// The world has a part that the snapshot lacks.
    #[error("the snapshot has no part '{part}'")]
    MissingPart {
        /// The part's name.
        part: &'static str,
    },
    /// The snapshot has a part that nothing in the world knows.
    #[error("the snapshot's part '{part}' is unknown: is its plugin missing?")]
    UnknownPart {
        /// The part's name.
        part: String,
    },
    /// A part needs a plugin that is not there.
    #[error("the snapshot's part '{part}' needs a plugin that this world does not have")]
    NoPlugin {
        /// The part's name.
        part: &'static str,
    },
    /// A part cannot be read.
    #[error("the snapshot's part '{part}' cannot be read: {message}")]
    Unreadable {
        /// The part's name.
        part: &'static str,
        /// What the reader says, with the place.
        message: String,
    },
    /// A part does not fit this world, or nothing can have written it.
    #[error("the snapshot's part '{part}' is refused: {what}")]
    Refused {
        /// The part's name.
        part: &'static str,
        /// What is wrong.
        what: String,
    },
}

/// The whole simulated state as plain data. Its parts are RON text, so any format keeps every bit of them.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RainSnapshot {
    version: u32,
    checksum: u64,
    parts: BTreeMap<String, String>,
}

impl RainSnapshot {
    /// Saves the state of a world between two frames.
    ///
    /// # Errors
    /// When a part cannot be written.
    pub fn save(world: &World) -> Result<Self, SnapshotError> {
        let mut parts = BTreeMap::new();
        if let Some(sources) = world.get_resource::<SnapshotSources>() {
            for (&name, source) in &sources.0 {
                if let Some(text) = (source.save)(name, world)? {
                    parts.insert(name.to_owned(), text);
                }
            }
        }
        Ok(Self {
            version: SNAPSHOT_VERSION,
            checksum: checksum(&parts),
            parts,
        })
    }

    /// Puts the state into a world of the same scene and the same plugins. All parts are checked before any is applied.
    ///
    /// # Errors
    /// When the version is another one, something was damaged, or a part does not fit the world. Then nothing changes.
    pub fn restore(&self, world: &mut World) -> Result<(), SnapshotError> {
        if self.version != SNAPSHOT_VERSION {
            return Err(SnapshotError::Version {
                found: self.version,
                supported: SNAPSHOT_VERSION,
            });
        }
        if self.checksum != checksum(&self.parts) {
            return Err(SnapshotError::Checksum);
        }
        let none = SnapshotSources::default();
        let sources = world.get_resource::<SnapshotSources>().unwrap_or(&none);
        let unknown = |name: &&String| !sources.0.contains_key(name.as_str()) && !name.starts_with(SEEN_ONLY);
        if let Some(part) = self.parts.keys().find(unknown) {
            return Err(SnapshotError::UnknownPart { part: part.clone() });
        }
        let mut applied: Vec<Apply> = Vec::with_capacity(sources.0.len());
        for (&part, source) in &sources.0 {
            match self.parts.get(part) {
                Some(text) => applied.push((source.prepare)(part, text, world)?),
                None if part.starts_with(SEEN_ONLY) => applied.push(Box::new(source.absent)),
                None if (source.exists)(world) => return Err(SnapshotError::MissingPart { part }),
                None => {}
            }
        }
        for apply in applied {
            apply(world);
        }
        Ok(())
    }

    /// The version it was written with.
    #[must_use]
    pub fn version(&self) -> u32 {
        self.version
    }

    /// The parts' names in order.
    pub fn parts(&self) -> impl Iterator<Item = &str> {
        self.parts.keys().map(String::as_str)
    }

    /// The same with a part's text changed and the checksum made anew: what was written by an older version may be
    /// brought up to date so before it is restored. A part that is not there stays so.
    #[must_use]
    pub fn with_part(&self, name: &str, change: impl FnOnce(&str) -> String) -> Self {
        let mut changed = self.clone();
        if let Some(text) = changed.parts.get_mut(name) {
            *text = change(text);
        }
        changed.checksum = checksum(&changed.parts);
        changed
    }

    /// Size of all parts. Units: bytes.
    #[must_use]
    pub fn size_bytes(&self) -> usize {
        self.parts.values().map(String::len).sum()
    }
}

fn checksum(parts: &BTreeMap<String, String>) -> u64 {
    let mut hasher = XxHash64::with_seed(0);
    for (name, text) in parts {
        for word in [name, text] {
            hasher.write(&(word.len() as u64).to_le_bytes());
            hasher.write(word.as_bytes());
        }
    }
    hasher.finish()
}

/// One phenomenon's share of a [`RainSnapshot`].
pub trait SnapshotPart: Serialize + DeserializeOwned + 'static {
    /// The state now; none where the world has none of it.
    fn save(world: &World) -> Option<Self>;

    /// Checks the state against the world and says how to put it in. Changes nothing.
    ///
    /// # Errors
    /// When it does not fit, or nothing can have written it.
    fn prepare(self, world: &World) -> Result<Apply, SnapshotError>;

    /// What a part that is seen only ([`SEEN_ONLY`]) does when a snapshot without it is restored.
    fn absent(_world: &mut World) {}
}

#[derive(Clone, Copy)]
struct Source {
    save: fn(&'static str, &World) -> Result<Option<String>, SnapshotError>,
    prepare: fn(&'static str, &str, &World) -> Result<Apply, SnapshotError>,
    exists: fn(&World) -> bool,
    absent: fn(&mut World),
}

/// The parts of snapshots, by name; they are applied in alphabetical order.
#[derive(Resource, Default)]
struct SnapshotSources(BTreeMap<&'static str, Source>);

/// Lets each phenomenon add its part to snapshots.
pub trait SnapshotAppExt {
    /// Adds a part. A second one of the same name replaces the first.
    fn snapshot_part<P: SnapshotPart>(&mut self, name: &'static str) -> &mut Self;
}

impl SnapshotAppExt for App {
    fn snapshot_part<P: SnapshotPart>(&mut self, name: &'static str) -> &mut Self {
        let source = Source {
            save: |part, world| {
                let unwritable = |error: ron::Error| SnapshotError::Unreadable {
                    part,
                    message: error.to_string(),
                };
                P::save(world)
                    .map(|p| ron::to_string(&p).map_err(unwritable))
                    .transpose()
            },
            prepare: |part, text, world| {
                let read: P = ron::from_str(text).map_err(|error| SnapshotError::Unreadable {
                    part,
                    message: error.to_string(),
                })?;
                read.prepare(world)
            },
            exists: |world| P::save(world).is_some(),
            absent: P::absent,
        };
        self.world_mut()
            .get_resource_or_init::<SnapshotSources>()
            .0
            .insert(name, source);
        self
    }
}
