//! The fixed ticks in which all state advances.

use std::time::Duration;

use bevy_app::{App, Plugin, PreUpdate};
use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_time::{Time, Virtual};
use rain_core::error::{ConfigError, in_range};
use serde::{Deserialize, Serialize};

use crate::schedule::{RainTick, add_tick_schedule};
use crate::seed::RainSeed;
use crate::snapshot::{ClockPart, SeedPart, SnapshotAppExt};
use crate::state_hash::{HashState, StateHashAppExt, StateHasher};

/// Default tick: 1/32 s. Units: ns.
pub const DEFAULT_TICK_NS: u64 = 31_250_000;
/// Default of [`RainClock::set_max_ticks_per_frame`]: 8 s of default ticks.
pub const DEFAULT_MAX_TICKS_PER_FRAME: u32 = 256;

/// The clock of all rain state: integer nanoseconds, advanced in whole ticks.
///
/// State depends on the number of ticks done and on nothing else about frames: after the same elapsed virtual time,
/// 30 Hz, 144 Hz and irregular frames have done the same ticks. When more ticks are due in one frame than
/// `max_ticks_per_frame`, longer ones (whole multiples) are run instead; the state then agrees to 1e-6, not bit for
/// bit.
///
/// Pausing and slow motion are those of `Time<Virtual>`; [`RainClock::paused`] stops the rain alone. Note that
/// `Time<Virtual>` itself drops what a frame takes beyond its `max_delta` (Bevy's default: 0.25 s).
#[derive(Resource, Reflect, Debug, Clone, PartialEq)]
#[reflect(Resource, Debug, Clone, PartialEq, Default)]
pub struct RainClock {
    /// Stops the rain while the rest of the application goes on. Default: false.
    pub paused: bool,
    tick_ns: u64,
    max_ticks_per_frame: u32,
    now_ns: u64,
    due_ns: u64,
    seen_ns: u64,
    current_tick_ns: u64,
    runs: u64,
}

impl Default for RainClock {
    fn default() -> Self {
        Self {
            paused: false,
            tick_ns: DEFAULT_TICK_NS,
            max_ticks_per_frame: DEFAULT_MAX_TICKS_PER_FRAME,
            now_ns: 0,
            due_ns: 0,
            seen_ns: 0,
            current_tick_ns: DEFAULT_TICK_NS,
            runs: 0,
        }
    }
}

impl RainClock {
    /// A clock at zero with this tick length.
    ///
    /// # Errors
    /// When the tick is outside 1 ms to 60 s.
    pub fn with_tick(tick: Duration) -> Result<Self, ConfigError> {
        in_range("tick_s", tick.as_secs_f64(), 1e-3, 60.0, "0.001 to 60 s")?;
        // At most 6e10 ns.
        let tick_ns = u64::try_from(tick.as_nanos()).unwrap_or(DEFAULT_TICK_NS);
        Ok(Self {
            tick_ns,
            current_tick_ns: tick_ns,
            ..Self::default()
        })
    }

    /// Sets how many ticks a frame runs before it takes longer ones instead. Domain: ≥ 1. Default: 256.
    ///
    /// # Errors
    /// When `ticks` is 0.
    pub fn set_max_ticks_per_frame(&mut self, ticks: u32) -> Result<(), ConfigError> {
        in_range(
            "max_ticks_per_frame",
            f64::from(ticks),
            1.0,
            f64::from(u32::MAX),
            "at least 1",
        )?;
        self.max_ticks_per_frame = ticks;
        Ok(())
    }

    /// Length of a normal tick. Units: ns. Default: 31 250 000.
    #[must_use]
    pub fn tick_ns(&self) -> u64 {
        self.tick_ns
    }

    /// Time up to which state has advanced; inside [`RainTick`] the end of the running tick. Units: ns.
    #[must_use]
    pub fn now_ns(&self) -> u64 {
        self.now_ns
    }

    /// [`RainClock::now_ns`] in seconds.
    #[must_use]
    pub fn now_s(&self) -> f64 {
        seconds(self.now_ns)
    }

    /// Length of the running (or last) tick: `tick_ns`, or a multiple of it in fast-forward. Units: ns.
    #[must_use]
    pub fn current_tick_ns(&self) -> u64 {
        self.current_tick_ns
    }

    /// [`RainClock::current_tick_ns`] in seconds.
    #[must_use]
    pub fn current_tick_s(&self) -> f64 {
        seconds(self.current_tick_ns)
    }

    /// Start of the running (or last) tick. Units: s.
    #[must_use]
    pub fn tick_start_s(&self) -> f64 {
        seconds(self.now_ns.saturating_sub(self.current_tick_ns))
    }

    /// Normal ticks done; a longer tick counts as many as it replaces.
    #[must_use]
    pub fn ticks(&self) -> u64 {
        self.now_ns / self.tick_ns
    }

    /// How often [`RainTick`] has run; less than [`RainClock::ticks`] after a fast-forward.
    #[must_use]
    pub fn runs(&self) -> u64 {
        self.runs
    }

    /// How much of the next tick has passed: what frames interpolate with. Units: none. Domain: [0, 1).
    #[must_use]
    pub fn interpolation(&self) -> f32 {
        let fraction = seconds(self.due_ns.saturating_sub(self.now_ns)) / seconds(self.tick_ns);
        // Just below 1 in f64 may round to 1 in f32.
        (fraction as f32).min(1.0 - f32::EPSILON)
    }

    /// Takes note of the virtual time; what passed while paused is not owed.
    fn observe(&mut self, elapsed: Duration) {
        let elapsed_ns = u64::try_from(elapsed.as_nanos()).unwrap_or(u64::MAX);
        if !self.paused {
            self.due_ns = self.due_ns.saturating_add(elapsed_ns.saturating_sub(self.seen_ns));
        }
        self.seen_ns = elapsed_ns;
    }

    /// Length of the next tick in normal ticks, when `pending` are due and a frame's ticks should be `multiple` long.
    fn next_tick(&mut self, multiple: u64) -> bool {
        let pending = (self.due_ns - self.now_ns) / self.tick_ns;
        if pending == 0 {
            return false;
        }
        self.current_tick_ns = multiple.min(pending) * self.tick_ns;
        self.now_ns += self.current_tick_ns;
        self.runs += 1;
        true
    }

    /// How many normal ticks each tick of this frame replaces.
    fn multiple(&self) -> u64 {
        let pending = (self.due_ns - self.now_ns) / self.tick_ns;
        pending.div_ceil(u64::from(self.max_ticks_per_frame)).max(1)
    }
}

/// The clock's own numbers, for snapshots. Units: ns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ClockState {
    tick: u64,
    max_ticks_per_frame: u32,
    now: u64,
    /// Of the next tick.
    begun: u64,
    current_tick: u64,
    runs: u64,
}

impl RainClock {
    pub(crate) fn state(&self) -> ClockState {
        ClockState {
            tick: self.tick_ns,
            max_ticks_per_frame: self.max_ticks_per_frame,
            now: self.now_ns,
            begun: self.due_ns.saturating_sub(self.now_ns),
            current_tick: self.current_tick_ns,
            runs: self.runs,
        }
    }

    /// This clock with a saved state; none if no clock can have written it. The virtual time goes on from where it is.
    pub(crate) fn with_state(&self, state: &ClockState) -> Option<Self> {
        let sound = (1_000_000..=60_000_000_000).contains(&state.tick)
            && state.max_ticks_per_frame >= 1
            && state.now.is_multiple_of(state.tick)
            && state.now < u64::MAX / 2
            && state.begun < u64::MAX / 4
            && state.current_tick.is_multiple_of(state.tick);
        sound.then_some(Self {
            tick_ns: state.tick,
            max_ticks_per_frame: state.max_ticks_per_frame,
            now_ns: state.now,
            due_ns: state.now + state.begun,
            current_tick_ns: state.current_tick,
            runs: state.runs,
            ..self.clone()
        })
    }
}

fn seconds(ns: u64) -> f64 {
    // Exact below 2^53 ns (104 days); the quotient is rounded once.
    ns as f64 / 1e9
}

impl HashState for RainClock {
    fn hash_state(&self, hasher: &mut StateHasher) {
        // Not the run count, nor what is due: these depend on frames, and no state depends on them.
        hasher.u64(self.tick_ns);
        hasher.u64(self.now_ns);
    }
}

/// Adds the [`RainClock`], the [`RainSeed`], the [`RainTick`] schedule and the system that runs it in `PreUpdate`
/// (after `First` has advanced the time, before the application's own systems).
#[derive(Debug, Clone, Default)]
pub struct RainClockPlugin {
    /// The clock to start with.
    pub clock: RainClock,
}

impl Plugin for RainClockPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(self.clock.clone())
            .init_resource::<RainSeed>()
            .register_type::<RainClock>()
            .register_type::<RainSeed>()
            .add_message::<crate::RainConfigError>()
            .hash_resource::<RainClock>("clock")
            .hash_resource::<RainSeed>("seed")
            .snapshot_part::<ClockPart>("clock")
            .snapshot_part::<SeedPart>("seed")
            .add_systems(PreUpdate, run_rain_ticks);
        add_tick_schedule(app);
    }
}

/// Runs [`RainTick`] for every tick that the virtual time has completed.
pub fn run_rain_ticks(world: &mut World) {
    let Some(elapsed) = world.get_resource::<Time<Virtual>>().map(Time::elapsed) else {
        return;
    };
    let mut clock = world.resource_mut::<RainClock>();
    clock.observe(elapsed);
    let multiple = clock.multiple();
    while world.resource_mut::<RainClock>().next_tick(multiple) {
        world.run_schedule(RainTick);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run_to(clock: &mut RainClock, ns: u64) -> Vec<u64> {
        clock.observe(Duration::from_nanos(ns));
        let multiple = clock.multiple();
        let mut lengths = Vec::new();
        while clock.next_tick(multiple) {
            lengths.push(clock.current_tick_ns() / clock.tick_ns());
        }
        lengths
    }

    #[test]
    fn whole_ticks_only_and_the_rest_is_the_fraction() {
        let mut clock = RainClock::default();
        assert!(run_to(&mut clock, 31_249_999).is_empty());
        assert!(clock.interpolation() < 1.0 && clock.interpolation() > 0.999);
        assert_eq!(run_to(&mut clock, 31_250_000), [1]);
        assert_eq!(
            (clock.interpolation(), clock.now_s(), clock.current_tick_s()),
            (0.0, 0.031_25, 0.031_25)
        );
        assert_eq!(run_to(&mut clock, 1_000_000_000), [1; 31]);
        assert_eq!((clock.ticks(), clock.runs(), clock.now_s()), (32, 32, 1.0));
    }

    #[test]
    fn a_long_wait_takes_longer_ticks() {
        let mut clock = RainClock::default();
        clock.set_max_ticks_per_frame(10).expect("positive");
        assert_eq!(run_to(&mut clock, 31_250_000 * 10), [1; 10]);
        assert_eq!(run_to(&mut clock, 31_250_000 * 35), [3, 3, 3, 3, 3, 3, 3, 3, 1]);
        assert_eq!((clock.ticks(), clock.runs()), (35, 19));
        assert_eq!(run_to(&mut clock, 31_250_000 * 36), [1], "and then normal ones again");
    }

    #[test]
    fn a_pause_is_not_made_up_for() {
        let mut clock = RainClock::default();
        run_to(&mut clock, 31_250_000);
        clock.paused = true;
        assert!(run_to(&mut clock, 1_000_000_000).is_empty());
        clock.paused = false;
        assert_eq!(run_to(&mut clock, 1_031_250_000), [1]);
    }

    #[test]
    fn bad_settings_are_refused() {
        for bad in [
            Duration::ZERO,
            Duration::from_nanos(999_999),
            Duration::from_secs(61),
            Duration::MAX,
        ] {
            assert!(
                RainClock::with_tick(bad)
                    .expect_err("refused")
                    .to_string()
                    .starts_with("tick_s is")
            );
        }
        assert!(RainClock::with_tick(Duration::from_millis(1)).is_ok());
        assert!(RainClock::default().set_max_ticks_per_frame(0).is_err());
    }
}
