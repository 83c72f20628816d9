//! The recent past as numbers: what a panel plots and a report tabulates.

use std::collections::VecDeque;

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use rain_core::error::{ConfigError, in_range};
use rain_core::haze::{EXTINCTION_EFFICIENCY, KOSCHMIEDER_CONTRAST, extinction_per_m, visibility_m};
use rain_core::surface::ground::GroundLedger;
use rain_core::weather::SurfaceClass;

use crate::clock::RainClock;
use crate::rainfall::RainfallField;
use crate::rainfall::areas::RainAreas;
use crate::schedule::{RainSystems, RainTick};
use crate::surface::SurfaceGround;
use crate::weather::{ActiveWeather, WeatherState};

/// Rain and water at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HistorySample {
    /// End of the tick. Units: s.
    pub time_s: f64,
    /// Rain rate, mean of the tick. Units: mm/h.
    pub rain_mm_h: f64,
    /// How far something dark can be told from the horizon through the rain outside all areas (Koschmieder). Units: m.
    pub visibility_m: f64,
    /// By class, in the order of [`SurfaceClass::ALL`]: see [`WeatherState::wetness`]. Units: none. Domain: [0, 1].
    pub wetness: [f64; SurfaceClass::COUNT],
    /// By class: see [`WeatherState::water_level_mm`]. Units: mm.
    pub water_level_mm: [f64; SurfaceClass::COUNT],
    /// All water of the ground; `None` without one.
    pub ledger: Option<GroundLedger>,
    /// What 1 mm over the cells of that ground is. Units: m³. 0 without one.
    pub m3_per_mm: f64,
}

/// Samples of the past, the oldest first. Reads the state and is no part of it: neither hashed nor saved.
///
/// Memory is taken once; a sample allocates nothing. Samples later than the clock (it was set back) are dropped.
#[derive(Resource, Debug, Clone)]
pub struct RainHistory {
    samples: VecDeque<HistorySample>,
    capacity: usize,
    interval_s: f64,
}

impl RainHistory {
    /// Fewest and most samples.
    pub const CAPACITY: core::ops::RangeInclusive<usize> = 2..=1_000_000;

    /// An empty history of at most `capacity` samples ([`RainHistory::CAPACITY`]), one every `interval_s`
    /// (units: s; domain: [0, 1e6]; 0 = every tick).
    ///
    /// # Errors
    /// When a value is outside its domain.
    pub fn new(interval_s: f64, capacity: usize) -> Result<Self, ConfigError> {
        in_range("interval_s", interval_s, 0.0, 1e6, "0 to 1e6 s")?;
        let (low, high) = (*Self::CAPACITY.start() as f64, *Self::CAPACITY.end() as f64);
        in_range("capacity", capacity as f64, low, high, "2 to 1,000,000")?;
        Ok(Self {
            samples: VecDeque::with_capacity(capacity),
            capacity,
            interval_s,
        })
    }

    /// The samples, the oldest first, times rising.
    pub fn samples(&self) -> impl ExactSizeIterator<Item = &HistorySample> + DoubleEndedIterator + '_ {
        self.samples.iter()
    }

    /// The newest sample.
    #[must_use]
    pub fn latest(&self) -> Option<&HistorySample> {
        self.samples.back()
    }

    /// Time between samples; a longer tick makes it longer. Units: s.
    #[must_use]
    pub fn interval_s(&self) -> f64 {
        self.interval_s
    }

    /// Most samples.
    #[must_use]
    pub fn capacity(&self) -> usize {
        self.capacity
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.samples.clear();
    }

    /// Whether a sample is due at `now_s`; drops what lies after it.
    fn is_due(&mut self, now_s: f64) -> bool {
        while self.samples.back().is_some_and(|last| last.time_s > now_s) {
            self.samples.pop_back();
        }
        // Ticks are whole nanoseconds: half of one keeps rounding out of the comparison.
        self.samples
            .back()
            .is_none_or(|last| now_s > last.time_s && now_s - last.time_s >= self.interval_s - 0.5e-9)
    }

    fn push(&mut self, sample: HistorySample) {
        if self.samples.len() == self.capacity {
            self.samples.pop_front();
        }
        self.samples.push_back(sample);
    }
}

/// Keeps a [`RainHistory`] where there is weather. Not part of [`crate::RainEcsPlugin`]: without it nothing is kept and
/// nothing is computed. An application that wants another interval inserts its own [`RainHistory`] first.
#[derive(Debug, Clone, Copy, Default)]
pub struct RainHistoryPlugin;

/// Of the plugin's own history. Units: s.
const INTERVAL_S: f64 = 1.0;
/// Of the plugin's own history: ten minutes.
const SAMPLES: usize = 600;

impl Plugin for RainHistoryPlugin {
    fn build(&self, app: &mut App) {
        if !app.world().contains_resource::<RainHistory>() {
            app.insert_resource(RainHistory {
                samples: VecDeque::with_capacity(SAMPLES),
                capacity: SAMPLES,
                interval_s: INTERVAL_S,
            });
        }
        app.add_systems(RainTick, sample.in_set(RainSystems::Report));
    }
}

fn sample(
    mut history: ResMut<RainHistory>,
    clock: Res<RainClock>,
    active: Option<Res<ActiveWeather>>,
    weather: Query<&WeatherState>,
    field: Option<Res<RainfallField>>,
    areas: Option<Res<RainAreas>>,
    ground: Option<Res<SurfaceGround>>,
) {
    let now_s = clock.now_s();
    // Asked first, so that a change is seen only when there is one.
    if !history.bypass_change_detection().is_due(now_s) {
        return;
    }
    let Some(weather) = active.and_then(|active| weather.get(active.entity()?).ok()) else {
        return;
    };
    let ground = ground.as_ref().and_then(|ground| ground.ground());
    history.push(HistorySample {
        time_s: now_s,
        rain_mm_h: weather.conditions().intensity_mm_h,
        visibility_m: field.map_or(f64::NAN, |field| {
            let spectrum = areas.map_or(*field.spectrum(), |areas| field.spectrum_at(areas.outside_mm_h()));
            visibility_m(extinction_per_m(&spectrum, EXTINCTION_EFFICIENCY), KOSCHMIEDER_CONTRAST)
        }),
        wetness: SurfaceClass::ALL.map(|class| weather.wetness(class)),
        water_level_mm: SurfaceClass::ALL.map(|class| weather.water_level_mm(class)),
        ledger: ground.map(|ground| ground.ledger()),
        m3_per_mm: ground.map_or(0.0, |ground| ground.area_m2() * 1e-3),
    });
}
