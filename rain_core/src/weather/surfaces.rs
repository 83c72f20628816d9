//! Every surface class and the artists' levels, advanced over conditions or a timeline.

use serde::{Deserialize, Serialize};

use super::artist::{ArtistSettings, ArtistState};
use super::column::{ColumnForcing, SurfaceColumn};
use super::conditions::WeatherConditions;
use super::evaporation::penman_evaporation_mm_h;
use super::store::Store;
use super::surface_class::{SurfaceClass, SurfaceProperties};
use super::timeline::Timeline;
use crate::error::{ConfigError, in_range};
use crate::ops;

/// Longest piece over which varying weather counts as constant (at its mean). Units: s.
///
/// A rate that rises by R' (mm/s²) errs over a piece dt by at most R' dt²/8 of water at a kink (pores full, soil
/// slower than the rain) and by R' dt²/12 in the film. Steeper slopes are cut so that this stays below 3e-8 mm; at
/// 1/32 s that is a rise of 50 mm/h in one minute. Constant spells are taken whole, however long.
pub const VARYING_STEP_S: f64 = 1.0 / 32.0;

/// Water that a piece may err by. Units: mm.
const PIECE_ERROR_MM: f64 = 3e-8;

/// The open ground under one weather: one [`SurfaceColumn`] per [`SurfaceClass`], and the artists' levels.
///
/// As plain data it can be saved and sent; what comes back goes through [`WeatherSurfaces::validated`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WeatherSurfaces {
    properties: [SurfaceProperties; SurfaceClass::COUNT],
    columns: [SurfaceColumn; SurfaceClass::COUNT],
    artist_settings: ArtistSettings,
    artist: ArtistState,
    rain: Store,
    evaporation_mm_h: f64,
}

impl Default for WeatherSurfaces {
    fn default() -> Self {
        Self {
            properties: SurfaceClass::ALL.map(SurfaceClass::properties),
            columns: [SurfaceColumn::default(); SurfaceClass::COUNT],
            artist_settings: ArtistSettings::default(),
            artist: ArtistState::default(),
            rain: Store::default(),
            evaporation_mm_h: 0.0,
        }
    }
}

impl WeatherSurfaces {
    /// Dry ground with these settings of the artists' levels.
    ///
    /// # Errors
    /// When the settings are invalid.
    pub fn new(artist_settings: ArtistSettings) -> Result<Self, ConfigError> {
        Ok(Self {
            artist_settings: artist_settings.validated()?,
            ..Self::default()
        })
    }

    /// This state, if it can have come about: after it was read from outside.
    ///
    /// # Errors
    /// When an amount is negative, not finite or beyond its capacity, a ledger is open by more than 1e-9, a level is
    /// outside [0, 1], or a property or setting outside its domain.
    pub fn validated(self) -> Result<Self, ConfigError> {
        for (column, properties) in self.columns.iter().zip(&self.properties) {
            SurfaceColumn::restore(column.ledger(), properties)?;
        }
        self.artist_settings.validated()?;
        let a = &self.artist;
        for level in [a.wetness, a.holes, a.puddles] {
            in_range("artist level", level, 0.0, 1.0, "0 to 1")?;
        }
        in_range("dry_for_s", a.dry_for_s, 0.0, 1e6, "0 to 1e6 s")?;
        in_range("rain_mm", self.rain.total(), 0.0, 1e12, "0 to 1e12 mm")?;
        in_range(
            "evaporation_mm_h",
            self.evaporation_mm_h,
            -1e4,
            1e4,
            "-10000 to 10000 mm/h",
        )?;
        Ok(self)
    }

    /// Replaces the properties of a class; its water stays.
    ///
    /// # Errors
    /// When the properties are invalid. Then nothing changes.
    pub fn set_properties(&mut self, class: SurfaceClass, properties: SurfaceProperties) -> Result<(), ConfigError> {
        self.properties[class.index()] = properties.validated()?;
        Ok(())
    }

    /// Replaces the settings of the artists' levels; the levels stay.
    ///
    /// # Errors
    /// When the settings are invalid. Then nothing changes.
    pub fn set_artist_settings(&mut self, settings: ArtistSettings) -> Result<(), ConfigError> {
        self.artist_settings = settings.validated()?;
        Ok(())
    }

    /// The settings of the artists' levels.
    #[must_use]
    pub fn artist_settings(&self) -> &ArtistSettings {
        &self.artist_settings
    }

    /// The properties of a class.
    #[must_use]
    pub fn properties(&self, class: SurfaceClass) -> &SurfaceProperties {
        &self.properties[class.index()]
    }

    /// The water of a class.
    #[must_use]
    pub fn column(&self, class: SurfaceClass) -> &SurfaceColumn {
        &self.columns[class.index()]
    }

    /// The artists' levels.
    #[must_use]
    pub fn artist(&self) -> &ArtistState {
        &self.artist
    }

    /// Pore water / pore capacity of a class. Units: none. Domain: [0, 1].
    #[must_use]
    pub fn wetness(&self, class: SurfaceClass) -> f64 {
        self.column(class).wetness(self.properties(class))
    }

    /// Mean film of a class outside basins. Units: mm.
    #[must_use]
    pub fn water_level_mm(&self, class: SurfaceClass) -> f64 {
        self.column(class).water_level_mm()
    }

    /// Rain since the start. Units: mm.
    #[must_use]
    pub fn rain_mm(&self) -> f64 {
        self.rain.total()
    }

    /// Penman's potential evaporation at the end of the last step, negative for dew. Units: mm/h. Default: 0.
    #[must_use]
    pub fn evaporation_mm_h(&self) -> f64 {
        self.evaporation_mm_h
    }

    /// Whether no class holds water (the physical way).
    #[must_use]
    pub fn ground_is_dry(&self) -> bool {
        self.columns.iter().all(SurfaceColumn::is_dry)
    }

    /// Whether no class and no artists' level holds water.
    #[must_use]
    pub fn is_dry(&self) -> bool {
        self.ground_is_dry() && self.artist.is_dry()
    }

    /// Every bit of the state in a fixed order, for hashes.
    pub fn for_each_state_bits(&self, mut put: impl FnMut(u64)) {
        for column in &self.columns {
            column.state_bits().into_iter().for_each(&mut put);
        }
        let a = &self.artist;
        let [rain_high, rain_low] = self.rain.parts();
        for value in [
            a.wetness,
            a.holes,
            a.puddles,
            a.dry_for_s,
            rain_high,
            rain_low,
            self.evaporation_mm_h,
        ] {
            put(value.to_bits());
        }
    }

    /// Advances by `dt_s` under constant conditions. Dew wets nothing. Error: that of [`SurfaceColumn::advance`].
    ///
    /// # Errors
    /// When the conditions are invalid, or the time not finite or outside [0, 1e9] s. Then nothing changes.
    pub fn advance(&mut self, conditions: &WeatherConditions, dt_s: f64) -> Result<(), ConfigError> {
        conditions.validated()?;
        // Checks the time before anything else moves.
        self.artist
            .advance(&self.artist_settings, conditions.intensity_mm_h, dt_s)?;
        self.evaporation_mm_h = penman_evaporation_mm_h(conditions);
        let forcing = ColumnForcing {
            rain_mm_h: conditions.intensity_mm_h,
            evaporation_mm_h: self.evaporation_mm_h.max(0.0),
        };
        for (column, properties) in self.columns.iter_mut().zip(&self.properties) {
            column.advance(properties, forcing, dt_s)?;
        }
        self.rain.add(conditions.intensity_mm_h * dt_s / 3600.0);
        Ok(())
    }

    /// Advances from t0_s to t1_s of a timeline: constant spells whole, the rest in pieces of [`VARYING_STEP_S`] at
    /// most, each with its exact mean. Returns the mean conditions over [t0_s, t1_s].
    ///
    /// Error: any ticks from 1/128 s to 12 s end within 1e-6 of each amount (or of 1e-3 mm); a piece is made short enough
    /// to err by less than 3e-8 mm by estimate.
    ///
    /// # Errors
    /// When a time is not finite, beyond ±1e9 s, or t1_s < t0_s. Then nothing changes.
    pub fn advance_along(
        &mut self,
        timeline: &Timeline,
        t0_s: f64,
        t1_s: f64,
    ) -> Result<WeatherConditions, ConfigError> {
        let mean = timeline.mean_conditions(t0_s, t1_s)?;
        let mut from_s = t0_s;
        while from_s < t1_s {
            let to_s = timeline.next_key_after(from_s).map_or(t1_s, |key_s| key_s.min(t1_s));
            let length_s = to_s - from_s;
            if timeline.is_constant(from_s, to_s) {
                self.advance(&timeline.mean_conditions(from_s, to_s)?, length_s)?;
            } else {
                let start = timeline.at(from_s)?.intensity_mm_h;
                let rise = 2.0 * (timeline.mean_intensity_mm_h(from_s, to_s)? - start).abs() / 3600.0 / length_s;
                let longest_s = VARYING_STEP_S.min(ops::sqrt(8.0 * PIECE_ERROR_MM / rise));
                // The millionth keeps a tick of 1/32 s one piece, whatever its ends' last bits are.
                let pieces = (length_s / longest_s - 1e-6).ceil().max(1.0);
                let mut piece = 0.0;
                while piece < pieces {
                    let a = from_s + length_s * (piece / pieces);
                    piece += 1.0;
                    let b = if piece == pieces {
                        to_s
                    } else {
                        from_s + length_s * (piece / pieces)
                    };
                    self.advance_varying(timeline, a, b)?;
                }
            }
            from_s = to_s;
        }
        Ok(mean)
    }

    /// One short piece of a slope. Dry ground answers differently to rain below and above the evaporation, so the
    /// piece is cut where the two are equal.
    fn advance_varying(&mut self, timeline: &Timeline, a: f64, b: f64) -> Result<(), ConfigError> {
        let mean = timeline.mean_conditions(a, b)?;
        let evaporation = penman_evaporation_mm_h(&mean).max(0.0);
        let start = timeline.at(a)?.intensity_mm_h;
        let end = 2.0 * mean.intensity_mm_h - start;
        let cut = a + (b - a) * (evaporation - start) / (end - start);
        if (start - evaporation) * (end - evaporation) < 0.0 && a < cut && cut < b {
            self.advance(&timeline.mean_conditions(a, cut)?, cut - a)?;
            return self.advance(&timeline.mean_conditions(cut, b)?, b - cut);
        }
        self.advance(&mean, b - a)
    }
}

#[cfg(test)]
mod tests {
    use super::super::timeline::{Keyframe, Transition};
    use super::*;

    /// A shower of an hour: up, hold, down, then drying sun.
    fn shower() -> Timeline {
        let key = |time_s, intensity_mm_h, net_radiation_w_m2, transition| Keyframe {
            time_s,
            conditions: WeatherConditions {
                intensity_mm_h,
                net_radiation_w_m2,
                ..WeatherConditions::default()
            },
            transition,
        };
        Timeline::new(vec![
            key(0.0, 0.0, 20.0, Transition::Linear),
            key(120.0, 60.0, 0.0, Transition::Hold),
            key(600.0, 60.0, 0.0, Transition::Linear),
            key(700.0, 0.0, 100.0, Transition::Linear),
            key(2000.0, 0.0, 700.0, Transition::Linear),
        ])
        .expect("valid")
    }

    fn run(step_s: f64, end_s: f64) -> WeatherSurfaces {
        let mut s = WeatherSurfaces::default();
        let n = (end_s / step_s).round();
        let mut i = 0.0;
        while i < n {
            s.advance_along(&shower(), i * step_s, (i + 1.0) * step_s)
                .expect("valid");
            i += 1.0;
        }
        s
    }

    fn assert_close(a: &WeatherSurfaces, b: &WeatherSurfaces, tolerance: f64) {
        for class in SurfaceClass::ALL {
            let (la, lb) = (a.column(class).ledger(), b.column(class).ledger());
            for (x, y) in [
                (la.pores_mm, lb.pores_mm),
                (la.film_mm, lb.film_mm),
                (la.rain_mm, lb.rain_mm),
                (la.evaporated_mm, lb.evaporated_mm),
                (la.infiltrated_mm, lb.infiltrated_mm),
                (la.drained_mm, lb.drained_mm),
            ] {
                assert!(
                    (x - y).abs() <= tolerance * x.abs().max(1e-3),
                    "{class:?}: {la:?} {lb:?}"
                );
            }
            assert!(la.residual_relative() < 1e-12, "{class:?}: {la:?}");
        }
    }

    #[test]
    fn any_tick_gives_the_same_ground() {
        for end_s in [96.0, 480.0, 660.0, 1920.0] {
            let reference = run(1.0 / 32.0, end_s);
            for step_s in [1.0 / 128.0, 0.1, 1.0, 12.0] {
                assert_close(&reference, &run(step_s, end_s), 1e-6);
            }
        }
        let wet = run(1.0, 660.0);
        assert!(wet.water_level_mm(SurfaceClass::Asphalt) > 1.0 && wet.wetness(SurfaceClass::Asphalt) == 1.0);
        assert!((wet.rain_mm() - (60.0 * 60.0 + 480.0 * 60.0 + 60.0 * 0.5 * (60.0 + 24.0)) / 3600.0).abs() < 1e-9);
    }

    #[test]
    fn a_stormy_hour_ends_dry_and_the_dry_state_is_exact() {
        let mut s = run(1.0, 2000.0);
        assert!(!s.is_dry());
        s.advance(
            &WeatherConditions {
                net_radiation_w_m2: 600.0,
                ..WeatherConditions::default()
            },
            1e5,
        )
        .expect("valid");
        assert!(s.is_dry(), "{s:?}");
        for class in SurfaceClass::ALL {
            assert!(s.column(class).ledger().residual_relative() < 1e-12);
            assert!((s.column(class).ledger().rain_mm - s.rain_mm()).abs() < 1e-9);
        }
    }

    #[test]
    fn invalid_input_changes_nothing() {
        let mut s = run(1.0, 300.0);
        let before = s.clone();
        let bad = WeatherConditions {
            relative_humidity: f64::NAN,
            ..WeatherConditions::default()
        };
        assert!(s.advance(&bad, 1.0).is_err());
        assert!(s.advance(&WeatherConditions::default(), f64::NAN).is_err());
        assert!(s.advance(&WeatherConditions::default(), -1.0).is_err());
        assert!(s.advance_along(&shower(), 5.0, 4.0).is_err());
        assert!(s.advance_along(&shower(), 5.0, f64::INFINITY).is_err());
        assert_eq!(s, before);
    }

    #[test]
    fn dew_wets_nothing() {
        let mut s = WeatherSurfaces::default();
        let night = WeatherConditions {
            air_temperature_c: 12.0,
            relative_humidity: 0.98,
            net_radiation_w_m2: -40.0,
            ..WeatherConditions::default()
        };
        s.advance(&night, 36_000.0).expect("valid");
        assert!(s.evaporation_mm_h() < 0.0 && s.is_dry());
    }
}
