//! The schedule of a tick and the order of the phenomena in it.

use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::ScheduleLabel;

/// Runs once per fixed tick of the [`crate::RainClock`]: zero, one or many times a frame.
///
/// Systems here read the tick from the clock (`now_ns`, `current_tick_ns`), never the frame's time.
#[derive(ScheduleLabel, Debug, Clone, PartialEq, Eq, Hash)]
pub struct RainTick;

/// The sets of a [`RainTick`], in the order in which they run.
///
/// Water and information flow one way: the weather feeds the areas, these what falls, that what it reaches.
#[derive(SystemSet, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RainSystems {
    /// Users' components are checked; bad values are reported and replaced by the last good ones.
    Input,
    /// Conditions of the tick, and the open ground under them.
    Weather,
    /// Local intensity.
    Areas,
    /// How far each size class of drops has moved.
    Rainfall,
    /// What keeps the rain off.
    Cover,
    /// Storage, drip and stemflow of trees.
    Canopy,
    /// Water that wheels pick up and throw.
    Wheels,
    /// Water that pours from roofs.
    Spouts,
    /// Pores, film and basins of the ground.
    Surface,
    /// Interactive water.
    Waves,
    /// Drops thrown up by drops.
    Splash,
    /// Extinction and fog.
    Haze,
    /// Water on cameras and windscreens.
    Lens,
    /// Flashes, and thunder that arrives.
    Lightning,
    /// What is heard.
    Sound,
    /// Ledgers and reports.
    Report,
}

impl RainSystems {
    /// All sets in running order.
    pub const ORDER: [Self; 16] = [
        Self::Input,
        Self::Weather,
        Self::Areas,
        Self::Rainfall,
        Self::Cover,
        Self::Canopy,
        Self::Wheels,
        Self::Spouts,
        Self::Surface,
        Self::Waves,
        Self::Splash,
        Self::Haze,
        Self::Lens,
        Self::Lightning,
        Self::Sound,
        Self::Report,
    ];
}

/// Makes [`RainTick`] and chains its sets.
pub(crate) fn add_tick_schedule(app: &mut App) {
    app.init_schedule(RainTick);
    for pair in RainSystems::ORDER.windows(2) {
        app.configure_sets(RainTick, pair[0].before(pair[1]));
    }
}
