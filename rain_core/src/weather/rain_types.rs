//! The artists' control panel: a table of rain types, one row each, to be changed and added to (Lagarde 2013, table T3).
//!
//! A row says what a rain of its intensity does: how fast it wets and floods, how much it splashes and fogs. Between rows
//! everything is linear in the intensity, so a rain that grows passes from one type to the next without a step.

use serde::{Deserialize, Serialize};

use super::artist::{ArtistSettings, relative_intensity};
use crate::error::{ConfigError, clamped, in_range};
use crate::rainfall::MAX_INTENSITY_MM_H;

/// Relative intensity of the first row of [`ArtistSettings`].
const FIRST_ROW: f64 = 0.33;

/// One row of the table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RainType {
    /// Its name. Domain: not empty, unique in a table.
    pub name: String,
    /// Its rain rate. Units: mm/h. Domain: (0, 500], unique in a table.
    pub intensity_mm_h: f64,
    /// Rise of the wet level. Units: 1/s. Domain: [0, 1000].
    pub wetness_rise_per_s: f64,
    /// Rise of the water in holes. Units: 1/s. Domain: [0, 1000].
    pub holes_rise_per_s: f64,
    /// Rise of the water in puddles. Units: 1/s. Domain: [0, 1000].
    pub puddles_rise_per_s: f64,
    /// Splashes. Units: 1/(m² s). Domain: [0, 1e6].
    pub splashes_per_m2_s: f64,
    /// Fog. Units: none. Domain: [0, 1].
    pub fog_amount: f64,
}

impl RainType {
    /// Its numbers, in the order of the fields.
    fn numbers(&self) -> [f64; 6] {
        [
            self.intensity_mm_h,
            self.wetness_rise_per_s,
            self.holes_rise_per_s,
            self.puddles_rise_per_s,
            self.splashes_per_m2_s,
            self.fog_amount,
        ]
    }

    fn of(name: &str, numbers: [f64; 6]) -> Self {
        let [rate, wetness, holes, puddles, splashes, fog] = numbers;
        Self {
            name: name.to_owned(),
            intensity_mm_h: rate,
            wetness_rise_per_s: wetness,
            holes_rise_per_s: holes,
            puddles_rise_per_s: puddles,
            splashes_per_m2_s: splashes,
            fog_amount: fog,
        }
    }

    /// Between this type (`t` = 0) and another (1), every number linear; t is held in [0, 1], what is not a number counts
    /// as 0. The name is that of the nearer one.
    #[must_use]
    pub fn blend(&self, other: &Self, t: f64) -> Self {
        let t = clamped(t, 0.0, 1.0);
        let (from, to) = (self.numbers(), other.numbers());
        let name = if t < 0.5 { &self.name } else { &other.name };
        Self::of(name, core::array::from_fn(|i| from[i] * (1.0 - t) + to[i] * t))
    }

    /// `settings` with the speeds of this type, at its own intensity.
    #[must_use]
    pub fn settings(&self, settings: &ArtistSettings) -> ArtistSettings {
        // Below the first of their rows the settings' speeds fall with the rain; here they have fallen already.
        let relative = relative_intensity(self.intensity_mm_h);
        let ramp = if relative > 0.0 {
            (FIRST_ROW / relative).max(1.0)
        } else {
            1.0
        };
        let rise = |speed: f64| [(speed * ramp).min(1e3); 3];
        let mut out = *settings;
        out.wetness.rise_per_s = rise(self.wetness_rise_per_s);
        out.holes.rise_per_s = rise(self.holes_rise_per_s);
        out.puddles.rise_per_s = rise(self.puddles_rise_per_s);
        out
    }

    fn validated(&self) -> Result<(), ConfigError> {
        if self.name.is_empty() {
            return Err(ConfigError::Empty { field: "name" });
        }
        let positive = f64::MIN_POSITIVE;
        let rate = self.intensity_mm_h;
        in_range(
            "intensity_mm_h",
            rate,
            positive,
            MAX_INTENSITY_MM_H,
            "above 0, up to 500 mm/h",
        )?;
        for (field, value) in [
            ("wetness_rise_per_s", self.wetness_rise_per_s),
            ("holes_rise_per_s", self.holes_rise_per_s),
            ("puddles_rise_per_s", self.puddles_rise_per_s),
        ] {
            in_range(field, value, 0.0, 1e3, "0 to 1000 per second")?;
        }
        in_range(
            "splashes_per_m2_s",
            self.splashes_per_m2_s,
            0.0,
            1e6,
            "0 to 1e6 per m² and second",
        )?;
        in_range("fog_amount", self.fog_amount, 0.0, 1.0, "0 to 1")?;
        Ok(())
    }
}

/// The table, by rising intensity. Starts with the rows light, moderate and heavy of the source, at the 2, 5 and 10 mm/h of
/// digest C's table 4.2.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Vec<RainType>", into = "Vec<RainType>")]
pub struct RainTypes {
    rows: Vec<RainType>,
}

impl Default for RainTypes {
    fn default() -> Self {
        let rows = [
            ("light", [2.0, 0.6, 0.2, 0.1, 20.0, 0.15]),
            ("moderate", [5.0, 0.75, 0.5, 0.3, 40.0, 0.4]),
            ("heavy", [10.0, 1.0, 0.85, 0.7, 60.0, 1.0]),
        ];
        Self {
            rows: rows.map(|(name, numbers)| RainType::of(name, numbers)).into(),
        }
    }
}

impl TryFrom<Vec<RainType>> for RainTypes {
    type Error = ConfigError;
    fn try_from(rows: Vec<RainType>) -> Result<Self, ConfigError> {
        let mut table = Self { rows: Vec::new() };
        for row in rows {
            table.put(row)?;
        }
        Ok(table)
    }
}

impl From<RainTypes> for Vec<RainType> {
    fn from(table: RainTypes) -> Self {
        table.rows
    }
}

impl RainTypes {
    /// The rows, by rising intensity.
    #[must_use]
    pub fn rows(&self) -> &[RainType] {
        &self.rows
    }

    /// The row of this name.
    #[must_use]
    pub fn named(&self, name: &str) -> Option<&RainType> {
        self.rows.iter().find(|row| row.name == name)
    }

    /// Puts in a row, or replaces the one of its name.
    ///
    /// # Errors
    /// When a number is outside its domain, the name is empty, or another row has this intensity. Then the table stays as
    /// it was.
    pub fn put(&mut self, row: RainType) -> Result<(), ConfigError> {
        row.validated()?;
        let others = self.rows.iter().filter(|old| old.name != row.name);
        if others.clone().any(|old| old.intensity_mm_h == row.intensity_mm_h) {
            return Err(ConfigError::OutOfRange {
                field: "intensity_mm_h",
                value: row.intensity_mm_h,
                allowed: "that of no other row",
            });
        }
        self.rows.retain(|old| old.name != row.name);
        let at = self.rows.partition_point(|old| old.intensity_mm_h < row.intensity_mm_h);
        self.rows.insert(at, row);
        Ok(())
    }

    /// Takes the row of this name out; whether there was one.
    pub fn remove(&mut self, name: &str) -> bool {
        let before = self.rows.len();
        self.rows.retain(|row| row.name != name);
        self.rows.len() < before
    }

    /// What a rain does: linear between the rows around it, from nothing at 0 mm/h up to the first, as the last beyond
    /// it. Without rows, NaN and below 0 nothing. Error: 1e-12 against the source's table.
    #[must_use]
    pub fn at(&self, intensity_mm_h: f64) -> RainType {
        let nothing = RainType::of(self.rows.first().map_or("", |row| &row.name), [0.0; 6]);
        let rate = clamped(intensity_mm_h, 0.0, MAX_INTENSITY_MM_H);
        let above = self.rows.partition_point(|row| row.intensity_mm_h < rate);
        let below = above.checked_sub(1).map_or(&nothing, |i| &self.rows[i]);
        match self.rows.get(above) {
            Some(next) => {
                let t = (rate - below.intensity_mm_h) / (next.intensity_mm_h - below.intensity_mm_h);
                below.blend(next, t)
            }
            None => below.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::haze::artist_fog_amount;
    use crate::splash::artist_splashes_per_m2_s;
    use crate::weather::ArtistState;

    #[test]
    fn the_table_is_that_of_the_source_at_every_intensity() {
        let table = RainTypes::default();
        let names: Vec<_> = table.rows().iter().map(|row| row.name.as_str()).collect();
        assert_eq!(names, ["light", "moderate", "heavy"]);
        let base = ArtistSettings::dynamic_rain();
        for i in 0..=120 {
            let rate = f64::from(i) * 0.1;
            let row = table.at(rate);
            let relative = relative_intensity(rate);
            let splashes = artist_splashes_per_m2_s(relative);
            assert!((row.splashes_per_m2_s - splashes).abs() < 1e-12, "{rate}");
            assert!((row.fog_amount - artist_fog_amount(relative)).abs() < 1e-12, "{rate}");
            // The same levels as by the fixed table of the settings.
            let (mut by_row, mut by_table) = (ArtistState::default(), ArtistState::default());
            by_row.advance(&row.settings(&base), rate, 0.7).expect("valid");
            by_table.advance(&base, rate, 0.7).expect("valid");
            for (a, b) in [
                (by_row.wetness, by_table.wetness),
                (by_row.holes, by_table.holes),
                (by_row.puddles, by_table.puddles),
            ] {
                assert!((a - b).abs() < 1e-12, "{rate}: {a} {b}");
            }
        }
    }

    #[test]
    fn rows_are_changed_added_and_taken_out() {
        let mut table = RainTypes::default();
        let cloudburst = RainType {
            puddles_rise_per_s: 2.0,
            ..RainType::of("cloudburst", [80.0, 2.0, 1.5, 2.0, 200.0, 1.0])
        };
        table.put(cloudburst.clone()).expect("valid");
        let drizzle = RainType::of("drizzle", [0.5, 0.3, 0.0, 0.0, 0.0, 0.3]);
        table.put(drizzle.clone()).expect("valid");
        let names: Vec<_> = table.rows().iter().map(|row| row.name.as_str()).collect();
        assert_eq!(names, ["drizzle", "light", "moderate", "heavy", "cloudburst"]);
        assert_eq!(table.at(80.0), cloudburst);
        assert_eq!(table.at(400.0), cloudburst, "as the last beyond it");
        assert_eq!(table.at(45.0).puddles_rise_per_s, 0.5 * (0.7 + 2.0));
        assert_eq!(table.at(0.5), drizzle);
        let foggier = RainType {
            fog_amount: 0.9,
            ..drizzle
        };
        table.put(foggier).expect("valid");
        assert_eq!((table.rows().len(), table.at(0.5).fog_amount), (5, 0.9));
        assert!(table.remove("light") && !table.remove("light"));
        assert!(table.named("light").is_none() && table.named("heavy").is_some());
        let rows: Vec<RainType> = table.clone().into();
        assert_eq!(RainTypes::try_from(rows), Ok(table));
        let empty = RainTypes::try_from(Vec::new()).expect("no rows");
        assert_eq!(empty.at(20.0).numbers(), [0.0; 6]);
    }

    #[test]
    fn the_way_from_one_type_to_another_has_no_step() {
        let table = RainTypes::default();
        let (light, heavy) = (
            table.named("light").expect("a row"),
            table.named("heavy").expect("a row"),
        );
        assert_eq!(
            (light.blend(heavy, 0.0), light.blend(heavy, 1.0)),
            (light.clone(), heavy.clone())
        );
        assert_eq!(light.blend(heavy, f64::NAN), *light);
        assert_eq!(light.blend(heavy, 0.5).intensity_mm_h, 6.0);
        let along: Vec<RainType> = (0..=1000).map(|i| table.at(f64::from(i) * 0.012)).collect();
        for pair in along.windows(2) {
            for (a, b) in pair[0].numbers().into_iter().zip(pair[1].numbers()) {
                assert!(b >= a && b - a < 0.2, "{pair:?}");
            }
        }
    }

    #[test]
    fn bad_rows_are_refused_by_name() {
        let mut table = RainTypes::default();
        let heavy = table.named("heavy").expect("a row").clone();
        for (i, field) in [
            "intensity_mm_h",
            "wetness_rise_per_s",
            "holes_rise_per_s",
            "puddles_rise_per_s",
            "splashes_per_m2_s",
            "fog_amount",
        ]
        .into_iter()
        .enumerate()
        {
            for bad in [f64::NAN, f64::INFINITY, -1.0, 1e7] {
                let mut numbers = heavy.numbers();
                numbers[i] = bad;
                let message = table
                    .put(RainType::of("new", numbers))
                    .expect_err("refused")
                    .to_string();
                assert!(message.starts_with(field), "{message}");
            }
        }
        let same = RainType::of("new", heavy.numbers());
        assert!(table.put(same).is_err(), "two rows of one intensity");
        assert!(table.put(RainType::of("", heavy.numbers())).is_err());
        assert_eq!(table, RainTypes::default());
        for bad in [f64::NAN, -1.0, f64::NEG_INFINITY] {
            assert_eq!(table.at(bad).numbers(), [0.0; 6]);
        }
        assert_eq!(table.at(f64::INFINITY).name, "heavy");
    }
}
