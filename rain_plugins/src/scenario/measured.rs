//! What captured frames took and drew. The frames before them are drawn small, and do not count.

use std::collections::BTreeMap;

use bevy::diagnostic::DiagnosticsStore;
use bevy::prelude::*;

use super::report::{Counts, Tally, median};
use crate::report::RainReport;

/// Times and counts of captured frames.
#[derive(Debug, Clone, Default)]
pub struct Measured {
    /// Values of each render diagnostic, by its path.
    diagnostics: BTreeMap<String, Vec<f64>>,
    drops: Vec<u64>,
    cards: Vec<u64>,
    splashes: Vec<u64>,
    drips: Vec<u64>,
}

impl Measured {
    /// The next frame is one that counts.
    pub(super) fn begin(world: &World) {
        if let Some(report) = world.get_resource::<RainReport>() {
            report.forget_counts();
        }
    }

    /// That frame has been drawn.
    pub(super) fn drawn(&mut self, world: &World) {
        if let Some(report) = world.get_resource::<RainReport>() {
            let drawn = report.snapshot();
            for (counts, frame) in [
                (&mut self.drops, &drawn.drops),
                (&mut self.cards, &drawn.cards),
                (&mut self.splashes, &drawn.splashes),
                (&mut self.drips, &drawn.drips),
            ] {
                counts.extend(frame.iter().map(|count| u64::from(*count)));
            }
        }
    }

    /// Leaves out the times that have come so far.
    pub(super) fn forget_times(world: &mut World) {
        if let Some(mut store) = world.get_resource_mut::<DiagnosticsStore>() {
            store.iter_mut().for_each(|diagnostic| diagnostic.clear_history());
        }
    }

    /// The times of that frame have come.
    pub(super) fn timed(&mut self, world: &World) {
        let Some(store) = world.get_resource::<DiagnosticsStore>() else {
            return;
        };
        for diagnostic in store.iter() {
            if diagnostic.history_len() > 0 {
                let path = diagnostic.path().as_str();
                if !self.diagnostics.contains_key(path) {
                    self.diagnostics.insert(path.to_owned(), Vec::new());
                }
                if let Some(values) = self.diagnostics.get_mut(path) {
                    values.extend(diagnostic.values());
                }
            }
        }
    }

    /// Median of a render diagnostic, such as `render/rain_rainfall/elapsed_gpu`, over the captured frames that have it.
    #[must_use]
    pub fn median_of(&self, path: &str) -> Option<f64> {
        median(self.diagnostics.get(path)?)
    }

    /// Things drawn.
    #[must_use]
    pub fn counts(&self) -> Counts {
        Counts {
            drops: Tally::of(&self.drops),
            billboards: Tally::of(&self.cards),
            splashes: Tally::of(&self.splashes),
            drips: Tally::of(&self.drips),
            ..Counts::default()
        }
    }
}
