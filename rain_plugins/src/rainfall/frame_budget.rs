//! Draws as much rain as a frame has time for.

use std::time::Instant;

use bevy::diagnostic::{DiagnosticMeasurement, DiagnosticsStore};
use bevy::prelude::*;
use rain_core::error::ConfigError;
use rain_core::rainfall::{FrameBudget, FrameBudgetSettings};

use crate::report::{PassName, RainReport};

/// Which time is to be held.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BudgetedTime {
    /// From frame to frame, whatever takes it (`Time<Real>`). Where a display waits for its refresh, choose a target between one
    /// refresh and two, such as 17.5 ms at 60 Hz.
    #[default]
    Frame,
    /// The rain's passes alone, as the GPU times them. Needs Bevy's `RenderDiagnosticsPlugin` and a device with timestamps; without
    /// them nothing changes, and the log says so.
    RainPasses,
}

/// A time for each frame, held by drawing fewer single drops and splashes: of both the same share of their budgets, those with the
/// least contrast left out first. What is not drawn singly is left to cards and haze, where a view has them, which like wet
/// surfaces cost what their settings say.
#[derive(Resource, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Resource, Default)]
pub struct RainFrameBudget {
    /// The time. Units: ms. Domain: [0.1, 10 000]. Default: `None`, budgets are what their settings say.
    pub target_ms: Option<f32>,
    /// The least share of the budgets, however long frames take. Domain: [0.01, 1]. Default: 0.1.
    pub least: f32,
    /// Which time. Default: the whole frame's.
    pub of: BudgetedTime,
}

impl Default for RainFrameBudget {
    fn default() -> Self {
        Self {
            target_ms: None,
            least: 0.1,
            of: BudgetedTime::Frame,
        }
    }
}

impl RainFrameBudget {
    /// Holds this time from frame to frame. Units: ms.
    #[must_use]
    pub fn of_frame(target_ms: f32) -> Self {
        Self {
            target_ms: Some(target_ms),
            ..Self::default()
        }
    }

    /// Holds this time of the rain's passes on the GPU. Units: ms.
    #[must_use]
    pub fn of_rain_passes(target_ms: f32) -> Self {
        Self {
            target_ms: Some(target_ms),
            of: BudgetedTime::RainPasses,
            ..Self::default()
        }
    }

    /// These settings, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not finite or outside its domain.
    pub fn validated(self) -> Result<Self, ConfigError> {
        self.bounds(self.target_ms.unwrap_or(1.0)).validated()?;
        Ok(self)
    }

    fn bounds(&self, target_ms: f32) -> FrameBudgetSettings {
        FrameBudgetSettings {
            target_ms: target_ms.into(),
            // As typed, so that 0.01 is not below itself.
            least: (f64::from(self.least) * 1e6).round() / 1e6,
        }
    }
}

/// The share of their budgets that drops and splashes have this frame.
#[derive(Resource, Clone, Debug, Default)]
pub struct RainShare {
    budget: Option<FrameBudget>,
    of: BudgetedTime,
    /// Of the last times of passes.
    seen: Option<Instant>,
}

impl RainShare {
    /// The share. Units: none. Domain: [0.01, 1]; 1 where no time is to be held.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.budget.as_ref().map_or(1.0, FrameBudget::share)
    }

    /// Median of the times that the last decision looked at; none before the first, and where no time is to be held.
    /// Units: ms.
    #[must_use]
    pub fn median_ms(&self) -> Option<f64> {
        self.budget.as_ref().and_then(FrameBudget::median_ms)
    }

    /// This share of a number, at least 1 of what is not 0.
    pub(crate) fn of(&self, count: u32) -> u32 {
        // No greater than `count`.
        ((f64::from(count) * self.share()).round() as u32).max(count.min(1))
    }

    /// Takes changed settings.
    fn follow(&mut self, settings: &RainFrameBudget) {
        let Some(target_ms) = settings.target_ms else {
            self.budget = None;
            return;
        };
        let bounds = settings.bounds(target_ms);
        let taken = match &mut self.budget {
            Some(budget) if self.of == settings.of => budget.set(bounds),
            other => FrameBudget::new(bounds).map(|new| *other = Some(new)),
        };
        match taken {
            Ok(()) => self.of = settings.of,
            Err(error) => error!("time of a frame: {error}"),
        }
    }

    /// The time that the rain's passes of the newest timed frame took together; none if there is no newer one. Units: ms.
    fn newest_passes_ms(&mut self, store: &DiagnosticsStore) -> Option<f64> {
        let passes = || {
            store.iter().filter(|diagnostic| {
                let path = diagnostic.path().as_str();
                path.starts_with("render/rain_") && path.ends_with("/elapsed_gpu")
            })
        };
        let newest = passes().filter_map(|d| d.measurement()).map(|m| m.time).max()?;
        if self.seen.is_some_and(|seen| seen >= newest) {
            return None;
        }
        self.seen = Some(newest);
        // A pass of several views has as many of one time.
        let of_frame = |m: &&DiagnosticMeasurement| m.time == newest;
        let sum = |d: &bevy::diagnostic::Diagnostic| d.measurements().filter(of_frame).map(|m| m.value).sum::<f64>();
        Some(passes().map(sum).sum())
    }
}

/// Takes the time of the last frame.
pub(super) fn hold_frame_budget(
    settings: Res<RainFrameBudget>,
    real: Res<Time<Real>>,
    store: Option<Res<DiagnosticsStore>>,
    report: Res<RainReport>,
    mut share: ResMut<RainShare>,
) {
    if settings.is_changed() {
        share.follow(&settings);
    }
    if share.budget.is_none() {
        return;
    }
    let share = &mut *share;
    let took_ms = match share.of {
        BudgetedTime::Frame => Some(1e3 * real.delta_secs_f64()).filter(|took| *took > 0.0),
        BudgetedTime::RainPasses => store.and_then(|store| share.newest_passes_ms(&store)),
    };
    match (took_ms, &mut share.budget) {
        (Some(took_ms), Some(budget)) => {
            budget.observe(took_ms);
        }
        (None, _) if share.seen.is_none() && report.recorded_frames(PassName::Rainfall) > 60 => {
            warn_once!(
                "no times of rain passes: is there a `RenderDiagnosticsPlugin`, and does the device have timestamps?"
            );
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_of_a_number_is_never_more_and_none_of_nothing_alone() {
        let mut share = RainShare::default();
        assert_eq!([share.of(0), share.of(1), share.of(30_000)], [0, 1, 30_000]);
        share.follow(&RainFrameBudget {
            least: 0.01,
            ..RainFrameBudget::of_frame(1.0)
        });
        for _ in 0..2_000 {
            if let Some(budget) = &mut share.budget {
                budget.observe(100.0);
            }
        }
        assert_eq!(share.share(), 0.01);
        assert_eq!([share.of(0), share.of(1), share.of(30_000)], [0, 1, 300]);
        assert_eq!(share.median_ms(), Some(100.0));
        // No time to hold any more.
        share.follow(&RainFrameBudget::default());
        assert_eq!((share.share(), share.median_ms()), (1.0, None));
    }

    #[test]
    fn bad_settings_are_named_and_the_good_ones_stay() {
        let bad = [
            (RainFrameBudget::of_frame(0.0), "target_ms"),
            (RainFrameBudget::of_rain_passes(f32::NAN), "target_ms"),
            (
                RainFrameBudget {
                    least: 0.0,
                    ..RainFrameBudget::default()
                },
                "least",
            ),
        ];
        let mut share = RainShare::default();
        share.follow(&RainFrameBudget::of_frame(16.0));
        for (settings, field) in bad {
            let error = settings.validated().expect_err("outside its domain").to_string();
            assert!(error.starts_with(field), "{error}");
            if settings.target_ms.is_some() {
                share.follow(&settings);
                let kept = share.budget.as_ref().expect("still there").settings();
                assert_eq!((kept.target_ms, share.of), (16.0, BudgetedTime::Frame));
            }
        }
        assert!(RainFrameBudget::of_frame(16.0).validated().is_ok());
    }
}
