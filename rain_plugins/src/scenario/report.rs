//! `report.json` of a run, and the same as a table for people.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde::{Deserialize, Deserializer, Serialize};

/// Names of passes, in the order of a frame.
pub const PASS_NAMES: [&str; 16] = [
    "cover",
    "surface",
    "ripples",
    "waves",
    "caustics",
    "streak_textures",
    "reflection",
    "lattice",
    "rainfall",
    "splash",
    "canopy",
    "wheels",
    "haze",
    "far_rain",
    "rainbow",
    "lens",
];

/// The report of a run. A number that is not finite is written as `null`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Report {
    /// Name of the scenario.
    pub scenario: String,
    /// Seed of every random choice.
    pub seed: u64,
    /// Length of the run. Units: s.
    pub duration_s: f64,
    /// Captures taken.
    pub frames: u64,
    /// Width and height of the pictures. Units: pixels.
    pub size: [u32; 2],
    /// Name of the graphics device.
    pub adapter: String,
    /// Hash of the CPU state at the end, in hexadecimal.
    pub state_hash: String,
    /// Where the water went.
    pub budget: Budget,
    /// What was recorded and skipped; the passes that exist, named as in [`PASS_NAMES`].
    pub passes: Vec<PassRow>,
    /// Things drawn per frame.
    pub counts: Counts,
    /// What was expected and what came out.
    pub expectations: Vec<ExpectationRow>,
    /// Frame times with and without rain, where they were measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub timings: Option<Timings>,
    /// Memory in use at the end, where it is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub memory: Option<Memory>,
}

/// Water over the domain. Units: m³ unless named otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Budget {
    /// Rain that fell: ∫R·A dt.
    pub rain_m3: f64,
    /// Film outside basins.
    pub film_m3: f64,
    /// Water in pores.
    pub pores_m3: f64,
    /// Water in basins.
    pub basins_m3: f64,
    /// Water on leaves.
    pub canopy_m3: f64,
    /// Drips and spray in flight.
    pub airborne_m3: f64,
    /// Evaporated.
    pub evaporated_m3: f64,
    /// Infiltrated.
    pub infiltrated_m3: f64,
    /// Left through drains and over the border.
    pub drained_m3: f64,
    /// Rain minus all of the others, over the rain. Units: none.
    #[serde(deserialize_with = "nan_if_null")]
    pub residual_relative: f64,
}

/// One pass over the run.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct PassRow {
    /// One of [`PASS_NAMES`].
    pub name: String,
    /// Frames it was recorded in.
    pub recorded_frames: u64,
    /// Frames it was skipped in.
    pub skipped_frames: u64,
    /// Frames per reason to skip it.
    pub skip_reasons: BTreeMap<String, u64>,
    /// Median time on the GPU over recorded frames. Units: ms. `null` where the device has no timestamps.
    pub gpu_ms_median: Option<f64>,
    /// Median time to record it on the CPU. Units: ms.
    pub cpu_ms_median: Option<f64>,
}

/// Things drawn per frame.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Counts {
    /// Single drops.
    pub drops: Tally,
    /// Billboards of many drops.
    pub billboards: Tally,
    /// Crowns and thrown drops of splashes, counted by the GPU that draws them.
    pub splashes: Tally,
    /// Drips from eaves and leaves.
    pub drips: Tally,
    /// Particles thrown up by wheels.
    pub wheel_particles: Tally,
}

/// A count over frames.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Tally {
    /// The middle one, or the mean of the two middle ones.
    pub median: f64,
    /// The greatest.
    pub maximum: u64,
}

impl Tally {
    /// Over these frames; 0 of none.
    #[must_use]
    pub fn of(frames: &[u64]) -> Self {
        let values: Vec<f64> = frames.iter().map(|n| *n as f64).collect();
        Self {
            median: median(&values).unwrap_or(0.0),
            maximum: frames.iter().copied().max().unwrap_or(0),
        }
    }
}

/// The middle value, or the mean of the two middle ones; none of nothing or when one is not a number.
#[must_use]
pub fn median(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    if sorted.is_empty() || sorted.iter().any(|v| v.is_nan()) {
        return None;
    }
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    Some(if sorted.len() % 2 == 1 {
        sorted[middle]
    } else {
        0.5 * (sorted[middle - 1] + sorted[middle])
    })
}

/// An expectation's outcome.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ExpectationRow {
    /// In words.
    pub text: String,
    /// What came out; `null` if it was not a number.
    #[serde(deserialize_with = "nan_if_null")]
    pub value: f64,
    /// What was expected: the value, the middle of a range, or the one bound.
    #[serde(deserialize_with = "nan_if_null")]
    pub expected: f64,
    /// How far `value` may be from `expected`; `null` where only one side is bounded.
    pub tolerance: Option<f64>,
    /// Whether it held.
    pub passed: bool,
    /// Least value that passes, if one is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub minimum: Option<f64>,
    /// Greatest value that passes, if one is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub maximum: Option<f64>,
}

fn nan_if_null<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::<f64>::deserialize(deserializer)?.unwrap_or(f64::NAN))
}

/// Frame times. Units: ms.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Timings {
    /// Median of the captured frames of a run without the rain plugins.
    pub dry_frame_ms_median: Option<f64>,
    /// Median of the captured frames of a run with the rain plugins, dry moments included.
    pub wet_frame_ms_median: Option<f64>,
}

/// Memory. Units: bytes.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Memory {
    /// Largest resident size of the whole process so far.
    pub cpu_bytes: Option<u64>,
    /// Rain's buffers and textures.
    pub gpu_bytes: Option<u64>,
}

impl Report {
    /// Whether every expectation held.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.expectations.iter().all(|e| e.passed)
    }

    /// The JSON text of `report.json`, with a final line break.
    ///
    /// # Errors
    /// Never for these types; the serialiser's signature has it.
    pub fn to_json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string_pretty(self).map(|json| json + "\n")
    }

    /// The report as a table for people.
    #[must_use]
    pub fn table(&self) -> String {
        let mut out = String::new();
        let [width, height] = self.size;
        let name = if self.scenario.is_empty() {
            "scenario"
        } else {
            &self.scenario
        };
        line(
            &mut out,
            format_args!(
                "{name}: {} s, {} frames of {width}x{height}",
                self.duration_s, self.frames
            ),
        );
        line(
            &mut out,
            format_args!("seed {}, state {}, on {}", self.seed, self.state_hash, self.adapter),
        );
        line(&mut out, format_args!("\nWater, m3"));
        let b = &self.budget;
        for (name, value) in [
            ("rain", b.rain_m3),
            ("film", b.film_m3),
            ("pores", b.pores_m3),
            ("basins", b.basins_m3),
            ("canopy", b.canopy_m3),
            ("airborne", b.airborne_m3),
            ("evaporated", b.evaporated_m3),
            ("infiltrated", b.infiltrated_m3),
            ("drained", b.drained_m3),
        ] {
            line(&mut out, format_args!("  {name:<16}{value:>14.6}"));
        }
        line(
            &mut out,
            format_args!("  {:<16}{:>14.3e} of the rain", "residual", b.residual_relative),
        );
        if !self.passes.is_empty() {
            line(
                &mut out,
                format_args!(
                    "\n{:<18}{:>9}{:>9}{:>9}{:>9}  skipped because",
                    "Pass", "recorded", "skipped", "GPU ms", "CPU ms"
                ),
            );
            for pass in &self.passes {
                let ms = |v: Option<f64>| v.map_or("-".to_owned(), |v| format!("{v:.3}"));
                let reasons: Vec<_> = pass
                    .skip_reasons
                    .iter()
                    .map(|(reason, n)| format!("{reason} ({n})"))
                    .collect();
                let row = format!(
                    "  {:<16}{:>9}{:>9}{:>9}{:>9}  {}",
                    pass.name,
                    pass.recorded_frames,
                    pass.skipped_frames,
                    ms(pass.gpu_ms_median),
                    ms(pass.cpu_ms_median),
                    reasons.join(", ")
                );
                line(&mut out, format_args!("{}", row.trim_end()));
            }
        }
        line(
            &mut out,
            format_args!("\n{:<18}{:>12}{:>12}", "Drawn per frame", "median", "maximum"),
        );
        let c = &self.counts;
        for (name, tally) in [
            ("drops", c.drops),
            ("billboards", c.billboards),
            ("splashes", c.splashes),
            ("drips", c.drips),
            ("wheel particles", c.wheel_particles),
        ] {
            line(
                &mut out,
                format_args!("  {name:<16}{:>12}{:>12}", tally.median, tally.maximum),
            );
        }
        if let Some(timings) = &self.timings {
            let ms = |v: Option<f64>| v.map_or("-".to_owned(), |v| format!("{v:.2} ms"));
            let (dry, wet) = (ms(timings.dry_frame_ms_median), ms(timings.wet_frame_ms_median));
            line(&mut out, format_args!("\nFrame time: dry {dry}, wet {wet}"));
        }
        if let Some(memory) = &self.memory {
            let mib = |v: Option<u64>| v.map_or("-".to_owned(), |v| format!("{:.1} MiB", v as f64 / 1_048_576.0));
            line(
                &mut out,
                format_args!("\nMemory: CPU {}, GPU {}", mib(memory.cpu_bytes), mib(memory.gpu_bytes)),
            );
        }
        if !self.expectations.is_empty() {
            line(&mut out, format_args!("\nExpectations"));
            for row in &self.expectations {
                let mark = if row.passed { "ok  " } else { "FAIL" };
                line(
                    &mut out,
                    format_args!("  {mark} {}: {}, {}", row.text, brief(row.value), row.wanted()),
                );
            }
            let failed = self.expectations.iter().filter(|e| !e.passed).count();
            line(
                &mut out,
                format_args!("{} passed, {failed} failed", self.expectations.len() - failed),
            );
        }
        out
    }
}

impl ExpectationRow {
    /// What was wanted, in words: `at least 0.1`, `2 ± 0.5`.
    #[must_use]
    pub fn wanted(&self) -> String {
        match (self.tolerance, self.minimum, self.maximum) {
            (None, Some(min), _) => format!("at least {}", brief(min)),
            (None, None, Some(max)) => format!("at most {}", brief(max)),
            (Some(_), Some(min), Some(max)) if min < max => format!("{} to {}", brief(min), brief(max)),
            _ => brief(self.expected),
        }
    }
}

/// Six significant digits, without trailing zeros.
pub(super) fn brief(value: f64) -> String {
    if !value.is_finite() {
        return "not a number".into();
    }
    let magnitude = value.abs();
    if magnitude != 0.0 && !(1e-4..1e9).contains(&magnitude) {
        return format!("{value:.5e}");
    }
    let decimals = if magnitude >= 1.0 {
        5_usize.saturating_sub(magnitude.log10() as usize)
    } else {
        7
    };
    let text = format!("{value:.decimals$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

fn line(out: &mut String, text: std::fmt::Arguments) {
    // Writing to a string does not fail.
    let _ = writeln!(out, "{text}");
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report() -> Report {
        Report {
            scenario: "storm".into(),
            seed: 7,
            duration_s: 60.0,
            frames: 2,
            size: [64, 32],
            adapter: "llvmpipe".into(),
            state_hash: "00ff".into(),
            budget: Budget {
                rain_m3: 1.5,
                residual_relative: 1e-12,
                ..Budget::default()
            },
            passes: vec![PassRow {
                name: "cover".into(),
                recorded_frames: 1,
                skipped_frames: 5,
                skip_reasons: BTreeMap::from([("nothing moved".into(), 5)]),
                gpu_ms_median: Some(0.25),
                cpu_ms_median: None,
            }],
            counts: Counts {
                drops: Tally::of(&[5, 1, 9, 4]),
                ..Counts::default()
            },
            expectations: vec![
                ExpectationRow {
                    text: "a".into(),
                    value: 1.0,
                    expected: 1.0,
                    tolerance: Some(0.0),
                    passed: true,
                    minimum: Some(1.0),
                    maximum: Some(1.0),
                },
                ExpectationRow {
                    text: "b".into(),
                    value: f64::NAN,
                    expected: 2.0,
                    minimum: Some(2.0),
                    ..ExpectationRow::default()
                },
            ],
            timings: None,
            memory: None,
        }
    }

    #[test]
    fn json_has_the_interface_keys() {
        let value: serde_json::Value = serde_json::from_str(&report().to_json().unwrap()).unwrap();
        for key in [
            "seed",
            "duration_s",
            "frames",
            "size",
            "adapter",
            "state_hash",
            "budget",
            "passes",
            "counts",
            "expectations",
        ] {
            assert!(value.get(key).is_some(), "{key}");
        }
        for key in [
            "rain_m3",
            "film_m3",
            "pores_m3",
            "basins_m3",
            "canopy_m3",
            "airborne_m3",
            "evaporated_m3",
            "infiltrated_m3",
            "drained_m3",
            "residual_relative",
        ] {
            assert!(value["budget"][key].is_number(), "{key}");
        }
        for key in [
            "name",
            "recorded_frames",
            "skipped_frames",
            "skip_reasons",
            "gpu_ms_median",
            "cpu_ms_median",
        ] {
            assert!(value["passes"][0].get(key).is_some(), "{key}");
        }
        for key in ["drops", "billboards", "splashes", "drips", "wheel_particles"] {
            assert!(
                value["counts"][key]["median"].is_number() && value["counts"][key]["maximum"].is_number(),
                "{key}"
            );
        }
        for key in ["text", "value", "expected", "tolerance", "passed"] {
            assert!(value["expectations"][0].get(key).is_some(), "{key}");
        }
        assert_eq!(value["passes"][0]["skip_reasons"]["nothing moved"], 5);
        assert_eq!(value["counts"]["drops"]["median"], 4.5);
        assert!(value["expectations"][1]["value"].is_null() && value["expectations"][1]["passed"] == false);
    }

    #[test]
    fn json_reads_back() {
        let mut before = report();
        let after: Report = serde_json::from_str(&before.to_json().unwrap()).unwrap();
        assert!(after.expectations[1].value.is_nan());
        before.expectations.truncate(1);
        let after: Report = serde_json::from_str(&before.to_json().unwrap()).unwrap();
        assert_eq!(after, before);
        assert!(before.passed() && !report().passed());
    }

    #[test]
    fn table_says_what_failed() {
        let table = report().table();
        for part in [
            "storm: 60 s, 2 frames of 64x32",
            "nothing moved (5)",
            "0.250",
            "ok   a: 1, 1",
            "FAIL b: not a number, at least 2",
            "1 passed, 1 failed",
        ] {
            assert!(table.contains(part), "{part}\n{table}");
        }
    }

    #[test]
    fn numbers_in_brief() {
        for (value, text) in [
            (0.0, "0"),
            (0.25, "0.25"),
            (1234.5678, "1234.57"),
            (1e-9, "1.00000e-9"),
            (123_456.0, "123456"),
            (-2.5, "-2.5"),
        ] {
            assert_eq!(brief(value), text);
        }
        assert_eq!(median(&[3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(&[]), None);
    }
}
