//! How much rain to draw so that frames take no longer than they may.

use crate::error::{ConfigError, in_range};

/// Times of one decision. The median of eight does not see three hitches among them.
const LEAST_FRAMES: usize = 8;

/// And no more than these, which is less than a window of frames far shorter than a display's.
const MOST_FRAMES: usize = 64;

/// A decision looks at no less than this. Units: ms.
const WINDOW_MS: f64 = 250.0;

/// After a change, frames are not looked at for this long: the rain follows slowly. Units: ms.
const SETTLE_MS: f64 = 1_000.0;

/// What a change aims at, as a share of the target: the target itself is a bound.
const AIM: f64 = 0.96;

/// Smallest change upwards, and the largest.
const RAISE: [f64; 2] = [1.05, 1.25];

/// Largest and smallest change downwards.
const LOWER: [f64; 2] = [0.5, 0.95];

/// A share that was too much is kept away from for this long the first time, and up to the second if it is too much each time.
/// Units: ms.
const AVOID_MS: [f64; 2] = [8_000.0, 120_000.0];

/// Closer than this to a share that was too much counts as the same.
const SAME: f64 = 0.9;

/// What frames may take, and the least that is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameBudgetSettings {
    /// No frame should take longer. Units: ms. Domain: [0.1, 10 000].
    pub target_ms: f64,
    /// The least share of the full number of drops that is drawn, however long frames take. Domain: [0.01, 1].
    pub least: f64,
}

impl FrameBudgetSettings {
    /// These settings, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not finite or outside its domain.
    pub fn validated(self) -> Result<Self, ConfigError> {
        in_range("target_ms", self.target_ms, 0.1, 10_000.0, "0.1 to 10000 ms")?;
        in_range("least", self.least, 0.01, 1.0, "0.01 to 1")?;
        Ok(self)
    }
}

/// A share that made frames too long.
#[derive(Debug, Clone, Copy, PartialEq)]
struct TooMuch {
    share: f64,
    /// How long it is kept away from, in all and still. Units: ms.
    avoid_ms: f64,
    left_ms: f64,
}

/// Finds the share of the full number of drops with which frames hold a time.
///
/// - Every quarter of a second (and at least eight frames) the median of the frames' times is compared with the target.
///   Over it, the share falls by the square of what is over, at most to a half at a time; a second passes before the next look.
/// - Under it, the share rises by at most a quarter, and never by more than would still hold the target if all of the
///   frame were rain: while time grows no faster than the share, a rise does not make frames too long, and the share does not
///   swing.
/// - A display that waits for its next refresh shows a step of time instead of a slope. So a share that was too much is not
///   tried again for 8 s, and for twice as long each time it is still too much, up to 2 min.
///
/// It knows nothing of clocks: the same times give the same shares.
#[derive(Debug, Clone)]
pub struct FrameBudget {
    settings: FrameBudgetSettings,
    share: f64,
    /// Of the frames that the next decision looks at. Units: ms.
    times_ms: Vec<f64>,
    /// Until frames are looked at again. Units: ms.
    settle_ms: f64,
    too_much: Option<TooMuch>,
    median_ms: Option<f64>,
}

impl FrameBudget {
    /// All of the rain, until frames have been seen.
    ///
    /// # Errors
    /// As [`FrameBudgetSettings::validated`].
    pub fn new(settings: FrameBudgetSettings) -> Result<Self, ConfigError> {
        Ok(Self {
            settings: settings.validated()?,
            share: 1.0,
            times_ms: Vec::with_capacity(MOST_FRAMES),
            settle_ms: 0.0,
            too_much: None,
            median_ms: None,
        })
    }

    /// Takes other settings; the share stays, but for the new least.
    ///
    /// # Errors
    /// As [`FrameBudgetSettings::validated`]; the old ones then stay.
    pub fn set(&mut self, settings: FrameBudgetSettings) -> Result<(), ConfigError> {
        self.settings = settings.validated()?;
        self.share = self.share.max(settings.least);
        // What was too much for another time says nothing.
        self.too_much = None;
        self.times_ms.clear();
        Ok(())
    }

    /// What frames may take, and the least that is drawn.
    #[must_use]
    pub fn settings(&self) -> FrameBudgetSettings {
        self.settings
    }

    /// The share in force. Domain: [least, 1].
    #[must_use]
    pub fn share(&self) -> f64 {
        self.share
    }

    /// Median time of the frames that the last decision looked at; none before the first. Units: ms.
    #[must_use]
    pub fn median_ms(&self) -> Option<f64> {
        self.median_ms
    }

    /// Takes the time that a frame took (units: ms), and gives the share for the next one. A time that is negative or not
    /// finite is left out.
    pub fn observe(&mut self, frame_ms: f64) -> f64 {
        if !(frame_ms.is_finite() && frame_ms >= 0.0) {
            return self.share;
        }
        if let Some(too_much) = &mut self.too_much {
            too_much.left_ms = (too_much.left_ms - frame_ms).max(0.0);
        }
        if self.settle_ms > 0.0 {
            self.settle_ms -= frame_ms;
            return self.share;
        }
        self.times_ms.push(frame_ms);
        let seen_ms: f64 = self.times_ms.iter().sum();
        let frames = self.times_ms.len();
        if frames >= MOST_FRAMES || frames >= LEAST_FRAMES && seen_ms >= WINDOW_MS {
            self.decide();
        }
        self.share
    }

    fn decide(&mut self) {
        self.times_ms.sort_unstable_by(f64::total_cmp);
        let median = self.times_ms[self.times_ms.len() / 2];
        self.times_ms.clear();
        self.median_ms = Some(median);
        let target = self.settings.target_ms;
        let before = self.share;
        if median > target {
            let over = AIM * target / median;
            self.share = (before * (over * over).clamp(LOWER[0], LOWER[1])).max(self.settings.least);
            if self.share < before {
                self.note_too_much(before);
            }
        } else {
            let rise = (AIM * target / median.max(1e-6)).min(RAISE[1]);
            let limit = match &self.too_much {
                Some(too_much) if too_much.left_ms > 0.0 => SAME * too_much.share,
                _ => 1.0,
            };
            let share = (before * rise).min(limit);
            // The last step, up to all of the rain, may be a small one.
            if share > before && (rise >= RAISE[0] || share == 1.0) {
                self.share = share;
            }
        }
        if self.share != before {
            self.settle_ms = SETTLE_MS;
        }
    }

    fn note_too_much(&mut self, share: f64) {
        let avoid_ms = match self.too_much {
            // Still falling under the same load: the first share of the fall is not what is too much.
            Some(known) if known.left_ms > 0.0 => known.avoid_ms,
            Some(known) if (SAME..=1.0 / SAME).contains(&(share / known.share)) => {
                (2.0 * known.avoid_ms).min(AVOID_MS[1])
            }
            _ => AVOID_MS[0],
        };
        self.too_much = Some(TooMuch {
            share,
            avoid_ms,
            left_ms: avoid_ms,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn budget(target_ms: f64) -> FrameBudget {
        FrameBudget::new(FrameBudgetSettings { target_ms, least: 0.1 }).expect("in its domain")
    }

    /// Plays `seconds` of frames whose times follow from the share; gives the share at the end of each second.
    fn play(budget: &mut FrameBudget, seconds: usize, frame_ms: impl Fn(f64, u32) -> f64) -> Vec<f64> {
        let mut shares = Vec::new();
        let (mut passed_ms, mut frame) = (0.0, 0);
        for second in 1..=seconds {
            while passed_ms < 1000.0 * second as f64 {
                let took = frame_ms(budget.share(), frame);
                budget.observe(took);
                passed_ms += took;
                frame += 1;
            }
            shares.push(budget.share());
        }
        shares
    }

    /// How often a series turns from up to down or back.
    fn turns(shares: &[f64]) -> usize {
        let steps: Vec<f64> = shares.windows(2).map(|w| w[1] - w[0]).filter(|d| *d != 0.0).collect();
        steps.windows(2).filter(|w| w[0] * w[1] < 0.0).count()
    }

    #[test]
    fn frames_that_are_short_enough_get_all_of_the_rain() {
        let mut budget = budget(16.0);
        let shares = play(&mut budget, 10, |share, _| 8.0 + 4.0 * share);
        assert!(shares.iter().all(|share| *share == 1.0), "{shares:?}");
        assert_eq!(budget.median_ms(), Some(12.0));
    }

    #[test]
    fn it_settles_below_the_target_without_swinging() {
        for (base, rain) in [(0.0, 40.0), (8.0, 16.0), (12.0, 10.0), (13.5, 20.0)] {
            let mut budget = budget(16.0);
            let took = |share: f64| base + rain * share;
            let shares = play(&mut budget, 60, |share, _| took(share));
            let end = &shares[20..];
            assert!(turns(&shares) <= 1, "{base} + {rain}: {shares:?}");
            assert!(
                end.iter().all(|share| took(*share) <= 16.0),
                "{base} + {rain}: {shares:?}"
            );
            // It gives away no more than a tenth of the time that rain may take, or 9 % of the frame.
            let (last, room) = (took(*end.last().expect("some")), 16.0 - base);
            assert!(
                last >= 16.0 - (0.1 * room).max(0.09 * 16.0),
                "{base} + {rain}: {last} ms"
            );
            assert_eq!(end.first(), end.last(), "{base} + {rain}");
        }
    }

    #[test]
    fn noise_and_hitches_do_not_move_it() {
        let mut budget = budget(16.0);
        // Within ±15 %, and every 20th frame takes ten times as long.
        let noise = |frame: u32| {
            let mark = f64::from(frame.wrapping_mul(2_654_435_761) >> 8) / f64::from(1 << 24);
            if frame % 20 == 7 { 10.0 } else { 0.85 + 0.3 * mark }
        };
        let shares = play(&mut budget, 90, |share, frame| (6.0 + 12.0 * share) * noise(frame));
        let end = &shares[15..];
        let [low, high] = [f64::min, f64::max].map(|pick| end.iter().copied().fold(end[0], pick));
        assert!(high / low < 1.35 && low > 0.55 && high < 0.95, "{low} to {high}");
        assert!(turns(end) < 20, "{} turns in 75 s", turns(end));
    }

    #[test]
    fn it_gives_way_to_a_load_within_seconds_and_comes_back_after_it() {
        let mut budget = budget(16.0);
        assert_eq!(play(&mut budget, 5, |share, _| 9.0 + 6.0 * share).last(), Some(&1.0));
        let loaded = play(&mut budget, 8, |share, _| 14.0 + 6.0 * share);
        assert!(14.0 + 6.0 * loaded[7] <= 16.0, "{loaded:?}");
        let after = play(&mut budget, 30, |share, _| 9.0 + 6.0 * share);
        assert_eq!(after.last(), Some(&1.0), "{after:?}");
        assert!(after.windows(2).all(|w| w[1] >= w[0]), "{after:?}");
    }

    #[test]
    fn a_display_that_waits_for_its_refresh_is_not_driven_over_it_again_and_again() {
        let mut budget = budget(17.5);
        // 60 Hz: what takes longer than a refresh takes two.
        let refresh = 1000.0 / 60.0;
        let took = |share: f64| ((10.0 + 10.0 * share) / refresh).ceil() * refresh;
        let shares = play(&mut budget, 600, |share, _| took(share));
        let late = |part: &[f64]| part.iter().filter(|share| took(**share) > 17.5).count();
        assert!(late(&shares[10..]) <= 12, "{} of 590 s", late(&shares[10..]));
        assert!(shares[300..].iter().all(|share| *share > 0.3), "{shares:?}");
    }

    #[test]
    fn where_the_rest_is_too_long_the_least_is_drawn_and_no_less() {
        let mut budget = budget(16.0);
        let shares = play(&mut budget, 30, |share, _| 30.0 + share);
        assert_eq!(shares.last(), Some(&0.1));
        budget
            .set(FrameBudgetSettings {
                target_ms: 16.0,
                least: 0.4,
            })
            .expect("in its domain");
        assert_eq!(budget.share(), 0.4);
    }

    #[test]
    fn the_same_times_give_the_same_shares_and_bad_ones_none() {
        let [mut a, mut b] = [budget(10.0), budget(10.0)];
        for frame in 0..2_000_u32 {
            let took = 6.0 + f64::from(frame % 17);
            b.observe([f64::NAN, f64::INFINITY, -1.0][frame as usize % 3]);
            assert_eq!(a.observe(took), b.observe(took));
        }
        for (target_ms, least) in [(0.0, 0.5), (f64::NAN, 0.5), (1e5, 0.5), (16.0, 0.0), (16.0, 1.5)] {
            let settings = FrameBudgetSettings { target_ms, least };
            let error = FrameBudget::new(settings).expect_err("outside its domain").to_string();
            assert!(
                error.contains(if least == 0.5 { "target_ms" } else { "least" }),
                "{error}"
            );
            assert!(a.set(settings).is_err());
        }
        assert_eq!(a.share(), b.share(), "bad settings change nothing");
    }

    #[test]
    fn very_short_frames_are_looked_at_too_and_nothing_grows() {
        let mut budget = budget(0.5);
        let shares = play(&mut budget, 6, |share, _| 0.2 + 0.6 * share);
        assert!(0.2 + 0.6 * shares[5] <= 0.5, "{shares:?}");
        assert_eq!(budget.times_ms.capacity(), MOST_FRAMES);
    }
}
