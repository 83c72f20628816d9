//! What was recorded, what was skipped, and why.

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use bevy::prelude::*;

/// The passes of a frame, in order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Reflect)]
pub enum PassName {
    /// Depth along the rain.
    Cover,
    /// Films and pores of the ground around the view.
    WaterMap,
    /// Rings of rain on water.
    Ripples,
    /// Interactive water in puddles.
    Waves,
    /// Light that puddles throw onto walls.
    Caustics,
    /// The mirrored view.
    Reflection,
    /// Haze of rain.
    Haze,
    /// Far showers as particles.
    FarRain,
    /// Rainbows, in the haze's pass.
    Rainbow,
    /// Streak textures, made once.
    StreakTextures,
    /// Splashes of rain.
    Splash,
    /// Cards of many drops, beyond the single streaks.
    Lattice,
    /// Streaks near the eye.
    Rainfall,
    /// Measurement masks (only when asked for).
    Masks,
    /// Drops on the camera's glass.
    Lens,
}

impl PassName {
    /// The name in reports.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Cover => "cover",
            Self::WaterMap => "water_map",
            Self::Ripples => "ripples",
            Self::Waves => "waves",
            Self::Caustics => "caustics",
            Self::Reflection => "reflection",
            Self::Haze => "haze",
            Self::FarRain => "far_rain",
            Self::Rainbow => "rainbow",
            Self::StreakTextures => "streak_textures",
            Self::Splash => "splash",
            Self::Lattice => "lattice",
            Self::Rainfall => "rainfall",
            Self::Masks => "masks",
            Self::Lens => "lens",
        }
    }
}

/// Why a pass was not recorded in a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Reflect)]
pub enum SkipReason {
    /// Nothing falls and nothing is wet.
    Dry,
    /// Nothing falls.
    NoRain,
    /// No standing water; for a mirror, none ahead, or the eye is under it.
    NoWater,
    /// There is no ground of the simulation; for splashes, none that is known to the cover map.
    NoGround,
    /// Nothing has changed that could be seen.
    Settled,
    /// Nothing moves the water, and what did has died out.
    Calm,
    /// The view's air is closed in: no rain can be in sight.
    Indoors,
    /// Nothing has moved; the kept map is used.
    NothingMoved,
    /// No camera carries a `RainView`, or it is inactive.
    NoView,
    /// Too little to be seen.
    Negligible,
    /// There is no sun, or its light is 0.
    NoSun,
    /// The view shows no haze.
    NoHaze,
    /// Turned off by a setting.
    Disabled,
    /// The view's projection or sample count is not supported by the pass.
    Unsupported,
}

impl SkipReason {
    /// The reason in reports.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Dry => "dry",
            Self::NoRain => "no rain",
            Self::NoWater => "no water",
            Self::NoGround => "no ground",
            Self::Settled => "settled",
            Self::Calm => "calm",
            Self::Indoors => "indoors",
            Self::NothingMoved => "nothing moved",
            Self::NoView => "no view",
            Self::Negligible => "negligible",
            Self::NoSun => "no sun",
            Self::NoHaze => "no haze",
            Self::Disabled => "disabled",
            Self::Unsupported => "unsupported view",
        }
    }
}

/// One pass over the frames so far.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct PassRecord {
    /// Frames in which its commands were recorded.
    pub recorded: u64,
    /// Frames in which they were not, by reason.
    pub skipped: BTreeMap<SkipReason, u64>,
}

/// Frames whose counts of drops, cards and splashes are kept.
pub const KEPT_FRAMES: usize = 16_384;

/// What the rain passes did: shared by the main and the render world.
///
/// `recorded` is counted where the commands are recorded, so a test that reads it counts passes, not flags.
#[derive(Resource, Clone, Default, Debug)]
pub struct RainReport(Arc<Mutex<Report>>);

/// The report's content.
#[derive(Debug, Clone, Default)]
pub struct Report {
    /// One entry for each pass that has been considered.
    pub passes: BTreeMap<PassName, PassRecord>,
    /// Drops that the GPU drew singly in the latest frames that drew rain, at most [`KEPT_FRAMES`] of them. A frame's count
    /// comes back a frame or two later.
    pub drops: VecDeque<u32>,
    /// Cards handed to the GPU in the latest frames that drew any, at most [`KEPT_FRAMES`] of them.
    pub cards: VecDeque<u32>,
    /// Crowns and thrown drops that the GPU drew in the latest frames that drew splashes, at most [`KEPT_FRAMES`] of them. A
    /// frame's count comes back a frame or two later.
    pub splashes: VecDeque<u32>,
    /// Drops and pieces of jets in the air under eaves and pipes in the latest frames that drew any, at most
    /// [`KEPT_FRAMES`] of them, also those beside the picture.
    pub drips: VecDeque<u32>,
    /// Particles of far rain in the latest frames that drew any, at most [`KEPT_FRAMES`] of them.
    pub far_rain: VecDeque<u32>,
    /// GPU memory of the rain's own buffers and textures. Units: bytes.
    pub gpu_memory_bytes: usize,
}

impl RainReport {
    fn lock(&self) -> MutexGuard<'_, Report> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Counts a recorded pass.
    pub fn recorded(&self, pass: PassName) {
        self.lock().passes.entry(pass).or_default().recorded += 1;
    }

    /// Counts a skipped pass.
    pub fn skipped(&self, pass: PassName, reason: SkipReason) {
        *self
            .lock()
            .passes
            .entry(pass)
            .or_default()
            .skipped
            .entry(reason)
            .or_default() += 1;
    }

    /// Notes how many drops a frame drew.
    pub fn drops(&self, count: u32) {
        keep(&mut self.lock().drops, count);
    }

    /// Notes how many cards a frame drew.
    pub fn cards(&self, count: u32) {
        keep(&mut self.lock().cards, count);
    }

    /// Notes how many crowns and thrown drops a frame drew.
    pub fn splashes(&self, count: u32) {
        keep(&mut self.lock().splashes, count);
    }

    /// Notes how many drops and pieces of jets were in the air under eaves and pipes near a view.
    pub fn drips(&self, count: u32) {
        keep(&mut self.lock().drips, count);
    }

    /// Notes how many particles of far rain a frame drew.
    pub fn far_rain(&self, count: u32) {
        keep(&mut self.lock().far_rain, count);
    }

    /// Leaves out what the frames so far have drawn.
    pub(crate) fn forget_counts(&self) {
        let mut report = self.lock();
        let report = &mut *report;
        for counts in [
            &mut report.drops,
            &mut report.cards,
            &mut report.splashes,
            &mut report.drips,
            &mut report.far_rain,
        ] {
            counts.clear();
        }
    }

    /// Notes the GPU memory in use.
    pub fn gpu_memory(&self, bytes: usize) {
        self.lock().gpu_memory_bytes = bytes;
    }

    /// A copy of the counters.
    #[must_use]
    pub fn snapshot(&self) -> Report {
        self.lock().clone()
    }

    /// Frames in which `pass` was recorded.
    #[must_use]
    pub fn recorded_frames(&self, pass: PassName) -> u64 {
        self.lock().passes.get(&pass).map_or(0, |p| p.recorded)
    }

    /// Sets every counter to zero.
    pub fn reset(&self) {
        *self.lock() = Report::default();
    }
}

/// The latest counts.
fn keep(counts: &mut VecDeque<u32>, count: u32) {
    if counts.len() == KEPT_FRAMES {
        counts.pop_front();
    }
    counts.push_back(count);
}
