//! Wetness and water levels the artists' way: rates per intensity, targets, no material.
//!
//! Three levels in [0, 1] (Lagarde 2013, digest E): the wet level, the water in holes and cracks, the water in
//! puddles. Rain drives them up at a rate that depends on its intensity, dry weather down at a fixed rate. Two laws
//! (digest E: linear with clamp, N8; digest C: exponential, H18), a gate (C13: puddles begin when the surface is
//! half wet) and a delay before drying (C15). Each is a closed form that composes: cutting an interval changes nothing.

use serde::{Deserialize, Serialize};

use crate::error::{ConfigError, clamped, in_range};
use crate::ops;
use crate::rainfall::MAX_INTENSITY_MM_H;

/// Relative intensities of the rows Light, Moderate, Heavy (digest E, table T3).
const ROWS: [f64; 3] = [0.33, 0.66, 1.0];
/// Rain rates of the same rows. Units: mm/h (digest C, table 4.2: light 2, moderate 5, heavy 10).
const ROW_RATES_MM_H: [f64; 3] = [2.0, 5.0, 10.0];
/// A falling level below this is 0: an exponential has to end somewhere.
const GONE: f64 = 1e-4;
/// Below this relative intensity it does not rain (digest E, N10).
const RAINING: f64 = 1e-4;

/// The artists' intensity in [0, 1] of a rain rate: linear through 0, 2, 5, 10 mm/h → 0, 0.33, 0.66, 1, then 1.
/// NaN and negative rates give 0. Error: 3e-16; a look.
#[must_use]
pub fn relative_intensity(intensity_mm_h: f64) -> f64 {
    through_rows(intensity_mm_h, ROW_RATES_MM_H, ROWS)
}

/// Linear through (0, 0) and the three rows, constant after the last.
fn through_rows(x: f64, at: [f64; 3], values: [f64; 3]) -> f64 {
    if x.is_nan() || x <= 0.0 {
        return 0.0;
    }
    let (mut x0, mut v0) = (0.0, 0.0);
    for (x1, v1) in at.into_iter().zip(values) {
        if x <= x1 {
            return v0 + (v1 - v0) * (x - x0) / (x1 - x0);
        }
        (x0, v0) = (x1, v1);
    }
    v0
}

/// How a level moves towards its bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ArtistLaw {
    /// At a constant rate, stopped at the bound (digest E, N8).
    #[default]
    Linear,
    /// By a constant share per second of what is missing (digest C, the form proposed for f(R, t)).
    Exponential,
}

/// Speeds and target of one level.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArtistLevel {
    /// Rise in light, moderate and heavy rain, linear between (digest E, N9). Units: 1/s. Domain: [0, 1000].
    pub rise_per_s: [f64; 3],
    /// Fall in dry weather. Units: 1/s. Domain: [0, 1000].
    pub fall_per_s: f64,
    /// Where rain drives the level. Units: none. Domain: [0, 1]. Default in both presets: 1.
    pub target: f64,
}

/// Settings of the artists' way.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArtistSettings {
    /// The law of all levels.
    pub law: ArtistLaw,
    /// The wet level (E2).
    pub wetness: ArtistLevel,
    /// Water in holes and cracks: flood level x (E25).
    pub holes: ArtistLevel,
    /// Water in puddles: flood level y (E25).
    pub puddles: ArtistLevel,
    /// Wetness from which holes and puddles fill (C13). Units: none. Domain: [0, 1).
    pub flood_gate: f64,
    /// Rain that never floods, however long it lasts (E31: drizzle). Units: mm/h. Domain: [0, 500].
    pub drizzle_mm_h: f64,
    /// Dry time before anything falls (C15). Units: s. Domain: [0, 1e6].
    pub drying_delay_s: f64,
    /// Water depth that level 1 stands for. Units: mm. Domain: [0, 1000]. Default: 3 (chosen by eye).
    pub full_level_mm: f64,
}

impl Default for ArtistSettings {
    fn default() -> Self {
        Self::dynamic_rain()
    }
}

impl ArtistSettings {
    /// Digest E: table T3 with its speeds read as 1/s (N8), linear, no gate, no delay; 0.5 mm/h does not flood (E31).
    #[must_use]
    pub fn dynamic_rain() -> Self {
        let level = |rise_per_s, fall_per_s| ArtistLevel {
            rise_per_s,
            fall_per_s,
            target: 1.0,
        };
        Self {
            law: ArtistLaw::Linear,
            wetness: level([0.6, 0.75, 1.0], 0.2),
            holes: level([0.2, 0.5, 0.85], 0.1),
            puddles: level([0.1, 0.3, 0.7], 0.05),
            flood_gate: 0.0,
            drizzle_mm_h: 0.5,
            drying_delay_s: 0.0,
            full_level_mm: 3.0,
        }
    }

    /// Digest C (C10–C20): exponential, puddles from half wetness on (C13), drying after 5 s (C15; the length is not
    /// given there, 5 s is chosen). The speeds are not given either: those of table T3, which keep its order (wetness
    /// before water level C14, water level last to go C16, slow, rapid, very rapid C20).
    #[must_use]
    pub fn traffic() -> Self {
        Self {
            law: ArtistLaw::Exponential,
            flood_gate: 0.5,
            drying_delay_s: 5.0,
            ..Self::dynamic_rain()
        }
    }

    /// These settings, if every one lies in its domain.
    ///
    /// # Errors
    /// Names the first field that does not.
    pub fn validated(self) -> Result<Self, ConfigError> {
        for level in [self.wetness, self.holes, self.puddles] {
            for rise in level.rise_per_s {
                in_range("rise_per_s", rise, 0.0, 1e3, "0 to 1000 per second")?;
            }
            in_range("fall_per_s", level.fall_per_s, 0.0, 1e3, "0 to 1000 per second")?;
            in_range("target", level.target, 0.0, 1.0, "0 to 1")?;
        }
        in_range("flood_gate", self.flood_gate, 0.0, 1.0 - 1e-6, "0 to below 1")?;
        in_range(
            "drizzle_mm_h",
            self.drizzle_mm_h,
            0.0,
            MAX_INTENSITY_MM_H,
            "0 to 500 mm/h",
        )?;
        in_range("drying_delay_s", self.drying_delay_s, 0.0, 1e6, "0 to 1e6 s")?;
        in_range("full_level_mm", self.full_level_mm, 0.0, 1e3, "0 to 1000 mm")?;
        Ok(self)
    }
}

/// The artists' levels at one moment. Starts dry.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArtistState {
    /// Wet level. Units: none. Domain: [0, 1].
    pub wetness: f64,
    /// Water in holes and cracks. Units: none. Domain: [0, 1].
    pub holes: f64,
    /// Water in puddles. Units: none. Domain: [0, 1].
    pub puddles: f64,
    /// Dry time since the rain, no longer counted beyond the drying delay. Units: s.
    pub dry_for_s: f64,
}

impl ArtistSettings {
    /// How fast the wet level rises. Units: 1/s. `intensity_mm_h` as in [`relative_intensity`].
    #[must_use]
    pub fn wetness_rise_per_s(&self, intensity_mm_h: f64) -> f64 {
        let relative = relative_intensity(intensity_mm_h);
        if relative > RAINING {
            through_rows(relative, ROWS, self.wetness.rise_per_s)
        } else {
            0.0
        }
    }

    /// Wet level of a moving object after `dt_s`: w + (e·rise − (1 − e)·fall) dt within [0, target], without rain
    /// w − fall dt (digest E: E43–E45, N11). Units: none.
    ///
    /// `wetness` and the share `exposure` of the rain that reaches it are held in [0, 1], `dt_s` in [0, 1e9]; what is
    /// not a number counts as 0. An object that comes from a wetter setting keeps what is above the target until it
    /// dries. Error: rounding; constant e over the step.
    #[must_use]
    pub fn object_wetness(&self, wetness: f64, exposure: f64, intensity_mm_h: f64, dt_s: f64) -> f64 {
        let (w, e, dt) = (
            clamped(wetness, 0.0, 1.0),
            clamped(exposure, 0.0, 1.0),
            clamped(dt_s, 0.0, 1e9),
        );
        let rise = self.wetness_rise_per_s(intensity_mm_h);
        let e = if rise > 0.0 { e } else { 0.0 };
        let after = w + (e * rise - (1.0 - e) * self.wetness.fall_per_s) * dt;
        after.clamp(0.0, self.wetness.target.max(w))
    }
}

impl ArtistState {
    /// Whether nothing is wet.
    #[must_use]
    pub fn is_dry(&self) -> bool {
        self.wetness == 0.0 && self.holes == 0.0 && self.puddles == 0.0
    }

    /// Advances by `dt_s` under constant rain. `dt_s` = 0 changes nothing.
    ///
    /// Error: any cut of an interval, from 1 ms to 1 h a step, ends within 1e-9 (levels below 1e-4 count as 0); within
    /// 1.1e-4 of the reference in small steps, one of which is late at the gate.
    ///
    /// # Errors
    /// When the settings are invalid, the rain is outside [0, 500] mm/h, or the time outside [0, 1e9] s or not finite.
    /// Then the state is as before.
    pub fn advance(&mut self, settings: &ArtistSettings, intensity_mm_h: f64, dt_s: f64) -> Result<(), ConfigError> {
        settings.validated()?;
        in_range(
            "intensity_mm_h",
            intensity_mm_h,
            0.0,
            MAX_INTENSITY_MM_H,
            "0 to 500 mm/h",
        )?;
        in_range("dt_s", dt_s, 0.0, 1e9, "0 to 1e9 s")?;
        let relative = relative_intensity(intensity_mm_h);
        if relative > RAINING {
            self.wet(settings, relative, intensity_mm_h > settings.drizzle_mm_h, dt_s);
        } else {
            self.dry(settings, dt_s);
        }
        Ok(())
    }

    fn wet(&mut self, settings: &ArtistSettings, relative: f64, floods: bool, dt: f64) {
        if dt == 0.0 {
            return;
        }
        self.dry_for_s = 0.0;
        let law = settings.law;
        let speed = |level: &ArtistLevel| through_rows(relative, ROWS, level.rise_per_s);
        if floods {
            let gate_s = law.time_to(
                self.wetness,
                settings.flood_gate,
                speed(&settings.wetness),
                &settings.wetness,
            );
            let filling = (dt - gate_s).max(0.0);
            self.holes = law.risen(self.holes, settings.holes.target, speed(&settings.holes), filling);
            self.puddles = law.risen(self.puddles, settings.puddles.target, speed(&settings.puddles), filling);
        }
        self.wetness = law.risen(self.wetness, settings.wetness.target, speed(&settings.wetness), dt);
    }

    fn dry(&mut self, settings: &ArtistSettings, dt: f64) {
        let wait = (settings.drying_delay_s - self.dry_for_s).max(0.0);
        let falling = (dt - wait).max(0.0);
        self.dry_for_s = (self.dry_for_s + dt).min(settings.drying_delay_s);
        if falling > 0.0 {
            for (level, how) in [
                (&mut self.wetness, &settings.wetness),
                (&mut self.holes, &settings.holes),
                (&mut self.puddles, &settings.puddles),
            ] {
                *level = settings.law.fallen(*level, how.fall_per_s, falling);
            }
        }
    }
}

impl ArtistLaw {
    /// A level after rising for `t`. A level above its target stays (rain does not dry).
    fn risen(self, level: f64, target: f64, speed: f64, t: f64) -> f64 {
        if level >= target {
            return level;
        }
        match self {
            Self::Linear => (level + speed * t).min(target),
            Self::Exponential => target - (target - level) * ops::exp(-speed * t),
        }
    }

    fn fallen(self, level: f64, speed: f64, t: f64) -> f64 {
        let level = match self {
            Self::Linear => level - speed * t,
            Self::Exponential => level * ops::exp(-speed * t),
        };
        if level < GONE { 0.0 } else { level }
    }

    /// When a rising level reaches `gate`; infinite when it never does.
    fn time_to(self, level: f64, gate: f64, speed: f64, how: &ArtistLevel) -> f64 {
        if level >= gate {
            return 0.0;
        }
        if gate > how.target || speed == 0.0 {
            return f64::INFINITY;
        }
        match self {
            Self::Linear => (gate - level) / speed,
            Self::Exponential if gate == how.target => f64::INFINITY,
            Self::Exponential => ops::ln((how.target - level) / (how.target - gate)) / speed,
        }
    }
}

#[cfg(test)]
#[allow(
    clippy::disallowed_methods,
    reason = "an independent check uses std, not the maths under test"
)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn both() -> [ArtistSettings; 2] {
        [ArtistSettings::dynamic_rain(), ArtistSettings::traffic()]
    }

    fn after(settings: &ArtistSettings, spells: &[(f64, f64)]) -> ArtistState {
        let mut state = ArtistState::default();
        for &(rate, dt) in spells {
            state.advance(settings, rate, dt).expect("valid");
        }
        state
    }

    #[test]
    fn a_moving_object_rises_in_rain_and_falls_under_cover() {
        let s = ArtistSettings::dynamic_rain();
        let after = |w, e, rain, dt| s.object_wetness(w, e, rain, dt);
        // Half exposed at 10 mm/h: 0.5 · 1 − 0.5 · 0.2 = 0.4 per second.
        assert!((after(0.0, 0.5, 10.0, 1.0) - 0.4).abs() < 1e-12);
        assert!((after(0.0, 1.0, 2.0, 1.0) - 0.6).abs() < 1e-12);
        assert!(
            (after(1.0, 0.0, 10.0, 2.0) - 0.6).abs() < 1e-12,
            "dries under cover while it rains"
        );
        assert!(
            (after(1.0, 1.0, 0.0, 2.0) - 0.6).abs() < 1e-12,
            "and in the open when it does not"
        );
        assert_eq!((after(0.9, 1.0, 10.0, 9.0), after(0.1, 0.0, 10.0, 9.0)), (1.0, 0.0));
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 1e300] {
            for w in [
                after(bad, 0.5, 5.0, 1.0),
                after(0.5, bad, 5.0, 1.0),
                after(0.5, 0.5, bad, 1.0),
                after(0.5, 0.5, 5.0, bad),
            ] {
                assert!((0.0..=1.0).contains(&w), "{bad}: {w}");
            }
        }
        let low = ArtistSettings {
            wetness: ArtistLevel {
                target: 0.4,
                ..s.wetness
            },
            ..s
        };
        assert_eq!(low.object_wetness(0.0, 1.0, 10.0, 9.0), 0.4);
        assert_eq!(
            low.object_wetness(0.9, 1.0, 10.0, 9.0),
            0.9,
            "what is above the target stays"
        );
    }

    #[test]
    fn rows_of_table_t3_take_the_times_of_table_t4() {
        let s = ArtistSettings::dynamic_rain();
        // rain mm/h, seconds from 0 to 1 of puddles, holes, wetness
        for (rate, puddles, holes, wetness) in [
            (2.0, 10.0, 5.0, 1.667),
            (5.0, 3.333, 2.0, 1.333),
            (10.0, 1.4286, 1.1765, 1.0),
        ] {
            let full = |t: f64| after(&s, &[(rate, t)]);
            assert!((full(0.5 * puddles).puddles - 0.5).abs() < 1e-3);
            assert!((full(0.5 * holes).holes - 0.5).abs() < 1e-3);
            assert!((full(0.5 * wetness).wetness - 0.5).abs() < 1e-3);
            assert_eq!(full(1.001 * puddles).puddles, 1.0);
        }
        // Drying: 5 s, 10 s, 20 s, in the order of E29.
        let dry = |t: f64| after(&s, &[(10.0, 60.0), (0.0, t)]);
        let half = dry(2.5);
        assert!((half.wetness - 0.5).abs() < 1e-12 && (half.holes - 0.75).abs() < 1e-12);
        assert_eq!((dry(5.0).wetness, dry(10.0).holes, dry(20.0).puddles), (0.0, 0.0, 0.0));
        assert!(dry(9.9).holes > 0.0 && dry(19.9).puddles > 0.0);
        assert!(dry(20.0).is_dry());
    }

    #[test]
    fn drizzle_wets_but_never_floods() {
        for s in both() {
            let state = after(&s, &[(0.5, 1e5)]);
            assert!(state.wetness > 0.999 && state.puddles == 0.0 && state.holes == 0.0);
            assert!(after(&s, &[(0.6, 1e5)]).puddles > 0.999, "a little more does");
        }
    }

    #[test]
    fn the_traffic_way_gates_delays_and_orders() {
        let s = ArtistSettings::traffic();
        // Half wetness at ln 2/0.75 s in moderate rain: no puddle before, one after (C13).
        let half = std::f64::consts::LN_2 / 0.75;
        assert_eq!(after(&s, &[(5.0, 0.999 * half)]).puddles, 0.0);
        let later = after(&s, &[(5.0, half + 1.0)]);
        assert!((later.puddles - (1.0 - (-0.3_f64).exp())).abs() < 1e-12, "{later:?}");
        assert!(later.wetness > later.puddles, "C14");
        // Nothing falls for 5 s (C15), then wetness before the water level (C16).
        let wet = after(&s, &[(5.0, 60.0)]);
        let waited = after(&s, &[(5.0, 60.0), (0.0, 5.0)]);
        assert_eq!((waited.wetness, waited.puddles), (wet.wetness, wet.puddles));
        let dried = after(&s, &[(5.0, 60.0), (0.0, 15.0)]);
        assert!((dried.wetness / wet.wetness - (-2.0_f64).exp()).abs() < 1e-12);
        assert!(dried.puddles > dried.wetness);
        // Rain resets the delay (H18).
        let again = after(&s, &[(5.0, 60.0), (0.0, 4.0), (5.0, 0.01), (0.0, 4.0)]);
        assert!(again.wetness >= wet.wetness);
        assert!(after(&s, &[(5.0, 60.0), (0.0, 1e4)]).is_dry(), "it ends");
    }

    #[test]
    fn intensity_passes_through_the_rows_and_bad_input_is_refused() {
        for (rate, expected) in [
            (0.0, 0.0),
            (1.0, 0.165),
            (2.0, 0.33),
            (5.0, 0.66),
            (7.5, 0.83),
            (10.0, 1.0),
            (500.0, 1.0),
        ] {
            assert!((relative_intensity(rate) - expected).abs() < 1e-12);
        }
        assert_eq!(relative_intensity(f64::NAN), 0.0);
        let s = ArtistSettings::default();
        let mut state = after(&s, &[(5.0, 0.3)]);
        let before = state;
        for (rate, dt) in [
            (f64::NAN, 1.0),
            (-1.0, 1.0),
            (1.0, f64::INFINITY),
            (1.0, -1.0),
            (501.0, 1.0),
        ] {
            assert!(state.advance(&s, rate, dt).is_err());
        }
        let bad = ArtistSettings { flood_gate: 1.0, ..s };
        assert!(
            state
                .advance(&bad, 1.0, 1.0)
                .expect_err("gate")
                .to_string()
                .starts_with("flood_gate is 1")
        );
        state.advance(&s, 0.0, 0.0).expect("no-op");
        assert_eq!(state, before);
    }

    proptest! {
        #[test]
        fn any_cut_gives_the_same_levels_within_bounds(
            spells in prop::collection::vec((prop_oneof![Just(0.0), 0.0_f64..40.0], 0.0_f64..30.0), 1..8),
            cuts in 1_u32..300,
            traffic: bool,
        ) {
            let s = both()[usize::from(traffic)];
            let whole = after(&s, &spells);
            let mut state = ArtistState::default();
            for &(rate, dt) in &spells {
                for _ in 0..cuts {
                    state.advance(&s, rate, dt / f64::from(cuts)).expect("valid");
                    for level in [state.wetness, state.holes, state.puddles] {
                        prop_assert!((0.0..=1.0).contains(&level));
                    }
                }
            }
            for (a, b) in [(whole.wetness, state.wetness), (whole.holes, state.holes), (whole.puddles, state.puddles)] {
                // Either may have just passed the level that counts as gone.
                prop_assert!((a - b).abs() < 1e-9 || a.max(b) < 1.001 * GONE, "{a} {b}");
            }
        }

        #[test]
        fn more_rain_never_gives_less_water(rate in 0.0_f64..40.0, more in 0.0_f64..10.0, dt in 0.0_f64..20.0, traffic: bool) {
            let s = both()[usize::from(traffic)];
            let (less, more) = (after(&s, &[(rate, dt)]), after(&s, &[(rate + more, dt)]));
            prop_assert!(more.wetness >= less.wetness - 1e-15);
            prop_assert!(more.holes >= less.holes - 1e-15 && more.puddles >= less.puddles - 1e-15);
        }
    }
}
