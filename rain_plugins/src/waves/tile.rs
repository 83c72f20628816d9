//! Waves on puddles near the view.

use bevy::prelude::*;
use rain_ecs::prelude::*;
use rain_render::waves::{Disturbance, MAX_DISTURBANCES, WaveTile};

use super::disturb::{DisturberMotion, WaterContact, WaterDisturber, foot_fall};
use super::rings::{FORGOTTEN_NS, seen_ns};
use super::{Handover, WaveWaterSettings};
use crate::rainfall::{RainView, ViewPlace, leading_view};
use crate::report::{PassName, RainReport, SkipReason};
use crate::surface::WaterLevels;

/// How far ahead of the eye the tile's middle lies. Units: m.
const AHEAD_M: f32 = 2.5;

/// Levels are followed at most this often: they change slowly, and every change is uploaded. Units: ns.
const REFILL_NS: u64 = 2_000_000_000;

/// An eye that moves farther than this in a frame has been cut. Units: m.
const CUT_M: f32 = 3.0;

/// The tile of puddles around the view.
#[derive(Resource, Debug)]
pub struct PuddleWaves {
    tile: WaveTile,
    now_ns: Option<u64>,
    eye: Option<Vec3>,
    /// What moved the water this frame.
    disturbances: Vec<Disturbance>,
    /// Version of the levels whose depths the tile has, and when it took them.
    filled: Option<(u64, u64)>,
    off: bool,
    pub(crate) handover: Handover,
}

impl PuddleWaves {
    pub(super) fn new(tile: WaveTile) -> Self {
        Self {
            tile,
            now_ns: None,
            eye: None,
            disturbances: Vec::new(),
            filled: None,
            off: false,
            handover: Handover::default(),
        }
    }

    /// The tile.
    #[must_use]
    pub fn tile(&self) -> &WaveTile {
        &self.tile
    }

    /// Whether waves are switched off.
    pub(crate) fn is_off(&self) -> bool {
        self.off
    }

    /// What the tile has followed: the time, the eye, and when it took its depths.
    pub(super) fn followed(&self) -> (Option<u64>, Option<Vec3>, Option<u64>) {
        (self.now_ns, self.eye, self.filled.map(|(_, at)| at))
    }

    /// A saved tile in place of this one, with what it had followed.
    pub(super) fn put_back(&mut self, tile: WaveTile, now_ns: Option<u64>, eye: Option<Vec3>, filled_ns: Option<u64>) {
        self.tile = tile;
        (self.now_ns, self.eye) = (now_ns, eye);
        // The levels are numbered anew.
        self.filled = filled_ns.map(|at| (u64::MAX, at));
    }

    /// Stills the water at once.
    pub(super) fn still(&mut self) {
        self.tile.reset();
        self.filled = None;
    }

    /// Forgets all waves: the GPU has lost them.
    pub(crate) fn lose(&mut self) {
        if let Ok(tile) = WaveTile::new(self.tile.settings()) {
            self.tile = tile;
            self.filled = None;
        }
    }
}

/// Follows the view, takes in what disturbs the water, and lets time pass.
pub(super) fn move_water(
    mut waves: ResMut<PuddleWaves>,
    clock: Res<RainClock>,
    levels: Res<WaterLevels>,
    settings: Res<WaveWaterSettings>,
    report: Res<RainReport>,
    views: Query<(Entity, &Camera, ViewPlace), With<RainView>>,
    mut disturbers: Query<(
        &WaterDisturber,
        &GlobalTransform,
        &mut DisturberMotion,
        &mut WaterContact,
    )>,
    mut splashes: MessageReader<FootSplash>,
) {
    let waves = &mut *waves;
    waves.handover.wanted = false;
    let now = seen_ns(&clock);
    if waves.now_ns.is_some_and(|before| now < before) {
        // The clock was set back: nothing has moved the water yet, and what stands in it is another.
        waves.tile.reset();
        waves.filled = None;
    }
    let elapsed = waves.now_ns.map_or(0, |before| now.saturating_sub(before));
    waves.now_ns = Some(now);
    let seconds = elapsed as f32 / 1e9;
    if elapsed > FORGOTTEN_NS {
        waves.tile.reset();
    }
    let found = &mut waves.disturbances;
    found.clear();
    waves.off = settings.no_waves;
    for (disturber, at, mut motion, mut contact) in &mut disturbers {
        let (at, valid) = (at.translation(), disturber.validated().is_ok());
        let look = (valid && !waves.off).then(|| WaterContact::under(disturber, at, &levels));
        contact.set_if_neq(look.unwrap_or_default());
        let disturbance = motion.step(disturber, at, seconds, *contact);
        if found.len() < MAX_DISTURBANCES {
            found.extend(disturbance);
        }
    }
    if waves.off {
        // Not to be made up for when it is switched on.
        splashes.clear();
    }
    found.extend(splashes.read().map(foot_fall).take(MAX_DISTURBANCES - found.len()));
    let view = leading_view(views);
    let reason = match view {
        None => Some(SkipReason::NoView),
        Some(_) if waves.off => Some(SkipReason::Disabled),
        Some(_) if !levels.any_water() => Some(SkipReason::NoWater),
        Some(_) => None,
    };
    if let Some(reason) = reason {
        report.skipped(PassName::Waves, reason);
        // While time stands still the water does too, and goes on when it is seen again.
        if elapsed > 0 {
            waves.tile.reset();
        }
        return;
    }
    let Some(view) = view else { return };
    let eye = view.place();
    if waves.eye.replace(eye).is_none_or(|before| before.distance(eye) > CUT_M) {
        waves.tile.reset();
    }
    let ahead = view.ahead(AHEAD_M);
    let depth = |x: f64, z: f64| levels.depth_at(x, z);
    let place = [f64::from(ahead.x), f64::from(ahead.z)];
    waves.tile.follow(place, depth);
    let stale = waves
        .filled
        .is_none_or(|(version, at)| version != levels.version() && now.saturating_sub(at) >= REFILL_NS);
    if stale {
        waves.tile.refill(depth);
        waves.filled = Some((levels.version(), now));
    }
    // At most as many as are taken, each checked: nothing is refused.
    let _ = waves.tile.advance(elapsed, &waves.disturbances);
    if waves.tile.wants_pass() {
        waves.tile.take(&mut waves.handover.frame);
        waves.handover.wanted = true;
    } else {
        report.skipped(PassName::Waves, SkipReason::Calm);
    }
}
