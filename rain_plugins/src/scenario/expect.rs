//! Evaluates expectations: numbers from masks as captures come in, the rest at the end.
//!
//! Masks are looked at one capture at a time and not kept, so a run of thousands of captures needs no memory for them.

use super::expectation::{
    At, BudgetTerm, Check, CountOf, Expectation, MaskCheck, OverFrames, PassFrames, Statistic, WeatherCheck,
    WeatherQuantity,
};
use super::file::{Mask, Scenario};
use super::masks::{coverage_from_texel, depth_from_texel, water_from_texel};
use super::report::{Budget, Counts, ExpectationRow, PassRow, brief};
use super::timeline::{Timeline, surface_name};

/// The masks of one capture, row by row from the top left, as in their files.
#[derive(Debug, Clone, Copy, Default)]
pub struct CaptureMasks<'a> {
    /// Width and height. Units: pixels.
    pub size: [u32; 2],
    /// Coverage, 65535 = 1.
    pub rain: Option<&'a [u16]>,
    /// Pore saturation, 65535 = 1.
    pub wet: Option<&'a [u16]>,
    /// View distance in mm, 65535 = farther.
    pub depth: Option<&'a [u16]>,
    /// Depth of standing water in 0.01 mm.
    pub water: Option<&'a [u16]>,
}

impl<'a> CaptureMasks<'a> {
    fn get(&self, mask: Mask) -> Option<&'a [u16]> {
        let texels = match mask {
            Mask::Rain => self.rain,
            Mask::Wet => self.wet,
            Mask::Depth => self.depth,
            Mask::Water => self.water,
        }?;
        (texels.len() == self.size[0] as usize * self.size[1] as usize).then_some(texels)
    }
}

/// What is known at the end of a run.
#[derive(Debug, Clone, Copy)]
pub struct Evidence<'a> {
    /// The record over time.
    pub timeline: &'a Timeline,
    /// The passes.
    pub passes: &'a [PassRow],
    /// The water.
    pub budget: &'a Budget,
    /// Things drawn.
    pub counts: &'a Counts,
}

/// Collects what a scenario's expectations need.
#[derive(Debug, Clone)]
pub struct Evaluator {
    expectations: Vec<Expectation>,
    captures: usize,
    /// Per expectation, the value at each capture it wants; not a number until that capture has come.
    seen: Vec<Vec<f64>>,
}

impl Evaluator {
    /// For a validated scenario.
    #[must_use]
    pub fn new(scenario: &Scenario) -> Self {
        let captures = scenario.captures.len();
        let seen = scenario
            .expectations
            .iter()
            .map(|e| {
                let wants_masks = matches!(e.check, Check::Mask(_) | Check::Rises(_) | Check::Falls(_));
                vec![f64::NAN; if wants_masks { captures } else { 0 }]
            })
            .collect();
        Self {
            expectations: scenario.expectations.clone(),
            captures,
            seen,
        }
    }

    /// Takes the numbers it needs from the masks of capture `index`. A mask that is missing, or not of the stated size,
    /// leaves its numbers undefined, and what rests on them fails.
    pub fn capture(&mut self, index: usize, masks: &CaptureMasks) {
        let captures = self.captures;
        for (expectation, seen) in self.expectations.iter().zip(&mut self.seen) {
            let check = match &expectation.check {
                Check::Mask(mask) if wanted(expectation.at, index, captures) => mask.clone(),
                Check::Rises(change) | Check::Falls(change) if [change.from, change.to].contains(&index) => {
                    change.mask_check()
                }
                _ => continue,
            };
            if let Some(slot) = seen.get_mut(index) {
                *slot = statistic(&check, masks);
            }
        }
    }

    /// One row per expectation, in the scenario's order.
    #[must_use]
    pub fn finish(&self, evidence: &Evidence) -> Vec<ExpectationRow> {
        self.expectations
            .iter()
            .zip(&self.seen)
            .map(|(e, seen)| self.row(e, seen, evidence))
            .collect()
    }

    fn row(&self, expectation: &Expectation, seen: &[f64], evidence: &Evidence) -> ExpectationRow {
        let bounds = Bounds::of(expectation);
        match &expectation.check {
            Check::Mask(_) => {
                let (index, value) = (0..self.captures)
                    .filter(|i| wanted(expectation.at, *i, self.captures))
                    .map(|i| (i, seen[i]))
                    // Worst first; a value that is not a number is worse than any.
                    .min_by(|a, b| bounds.margin(a.1).total_cmp(&bounds.margin(b.1)))
                    .unwrap_or((0, f64::NAN));
                let mut row = bounds.row(expectation, value);
                if expectation.at == At::All && self.captures > 1 {
                    row.text = format!("{} (worst: capture {index})", row.text);
                }
                row
            }
            Check::Rises(change) => {
                let (from, to) = (seen[change.from], seen[change.to]);
                let bounds = Bounds {
                    min: Some(from * change.factor),
                    max: None,
                    equals: None,
                    tolerance: 0.0,
                };
                let mut row = bounds.row(expectation, to);
                row.passed &= to > from;
                row
            }
            Check::Falls(change) => {
                let (from, to) = (seen[change.from], seen[change.to]);
                let bounds = Bounds {
                    min: None,
                    max: Some(from / change.factor),
                    equals: None,
                    tolerance: 0.0,
                };
                let mut row = bounds.row(expectation, to);
                row.passed &= to < from;
                row
            }
            Check::Weather(check) => bounds.row(expectation, weather(check, evidence.timeline)),
            Check::Pass(check) => {
                let frames = evidence
                    .passes
                    .iter()
                    .find(|p| p.name == check.name)
                    .map_or(0, |p| match check.frames {
                        PassFrames::Recorded => p.recorded_frames,
                        PassFrames::Skipped => p.skipped_frames,
                    });
                bounds.row(expectation, frames as f64)
            }
            Check::Budget(term) => bounds.row(expectation, budget(*term, evidence.budget)),
            Check::Count(check) => {
                let c = evidence.counts;
                let tally = match check.of {
                    CountOf::Drops => c.drops,
                    CountOf::Billboards => c.billboards,
                    CountOf::Splashes => c.splashes,
                    CountOf::Drips => c.drips,
                    CountOf::WheelParticles => c.wheel_particles,
                };
                let value = match check.over_frames {
                    OverFrames::Median => tally.median,
                    OverFrames::Maximum => tally.maximum as f64,
                };
                bounds.row(expectation, value)
            }
        }
    }
}

fn wanted(at: At, index: usize, captures: usize) -> bool {
    match at {
        At::All => true,
        At::Last => index + 1 == captures,
        At::Capture(i) => i == index,
    }
}

/// What passes.
struct Bounds {
    equals: Option<f64>,
    min: Option<f64>,
    max: Option<f64>,
    tolerance: f64,
}

impl Bounds {
    fn of(expectation: &Expectation) -> Self {
        let Expectation {
            equals,
            min,
            max,
            tolerance,
            ..
        } = *expectation;
        Self {
            equals,
            min,
            max,
            tolerance,
        }
    }

    fn least(&self) -> Option<f64> {
        self.equals.or(self.min).map(|v| v - self.tolerance)
    }

    fn greatest(&self) -> Option<f64> {
        self.equals.or(self.max).map(|v| v + self.tolerance)
    }

    /// Distance inside the bounds; negative outside, −∞ for what is not a number (or has no number to compare with).
    fn margin(&self, value: f64) -> f64 {
        let below = self.least().map_or(f64::INFINITY, |least| value - least);
        let above = self.greatest().map_or(f64::INFINITY, |greatest| greatest - value);
        if value.is_finite() && !below.is_nan() && !above.is_nan() {
            below.min(above)
        } else {
            f64::NEG_INFINITY
        }
    }

    fn row(&self, expectation: &Expectation, value: f64) -> ExpectationRow {
        let (minimum, maximum) = (self.least(), self.greatest());
        let (expected, tolerance) = match (self.equals, minimum, maximum) {
            (Some(equals), ..) => (equals, Some(self.tolerance)),
            (None, Some(min), Some(max)) => (0.5 * (min + max), Some(0.5 * (max - min))),
            (None, Some(bound), None) | (None, None, Some(bound)) => (bound, None),
            (None, None, None) => (f64::NAN, None),
        };
        let text = if expectation.text.is_empty() {
            describe(expectation)
        } else {
            expectation.text.clone()
        };
        // Without any bound there is nothing that could hold.
        let passed = self.margin(value) >= 0.0 && (minimum.is_some() || maximum.is_some());
        ExpectationRow {
            text,
            value,
            expected,
            tolerance,
            passed,
            minimum,
            maximum,
        }
    }
}

fn weather(check: &WeatherCheck, timeline: &Timeline) -> f64 {
    let series = match check.quantity {
        WeatherQuantity::IntensityMmH => return timeline.value_at(&timeline.intensity_mm_h, check.time_s),
        WeatherQuantity::Wetness => &timeline.wetness,
        WeatherQuantity::WaterLevelMm => &timeline.water_level_mm,
    };
    let name = surface_name(check.surface);
    let found = series.iter().find(|s| s.name == name);
    found.map_or(f64::NAN, |s| timeline.value_at(&s.values, check.time_s))
}

fn budget(term: BudgetTerm, budget: &Budget) -> f64 {
    match term {
        BudgetTerm::Rain => budget.rain_m3,
        BudgetTerm::Film => budget.film_m3,
        BudgetTerm::Pores => budget.pores_m3,
        BudgetTerm::Basins => budget.basins_m3,
        BudgetTerm::Canopy => budget.canopy_m3,
        BudgetTerm::Airborne => budget.airborne_m3,
        BudgetTerm::Evaporated => budget.evaporated_m3,
        BudgetTerm::Infiltrated => budget.infiltrated_m3,
        BudgetTerm::Drained => budget.drained_m3,
        BudgetTerm::Residual => budget.residual_relative.abs(),
    }
}

/// The statistic over the pixels whose centres are in the region and whose distance is in the range.
fn statistic(check: &MaskCheck, masks: &CaptureMasks) -> f64 {
    let Some(texels) = masks.get(check.mask) else {
        return f64::NAN;
    };
    let depth = match check.depth_m {
        None => None,
        Some(range) => match masks.get(Mask::Depth) {
            Some(depth) => Some((depth, range)),
            None => return f64::NAN,
        },
    };
    let value_of = |texel: u16| match check.mask {
        Mask::Rain | Mask::Wet => coverage_from_texel(texel),
        Mask::Depth => depth_from_texel(texel),
        Mask::Water => water_from_texel(texel),
    };
    let [width, height] = masks.size.map(|s| s as usize);
    let range = |from: f64, to: f64, size: usize| {
        let at = |fraction: f64| (fraction * size as f64 - 0.5).ceil().max(0.0) as usize;
        at(from)..at(to).min(size)
    };
    let [left, top, right, bottom] = check.region;
    let (mut pixels, mut sum, mut above, mut greatest) = (0_u64, 0.0, 0_u64, f64::NEG_INFINITY);
    for y in range(top, bottom, height) {
        for x in range(left, right, width) {
            let i = y * width + x;
            if let Some((depth, [near, far])) = depth
                && !(near..=far).contains(&depth_from_texel(depth[i]))
            {
                continue;
            }
            let value = value_of(texels[i]);
            pixels += 1;
            sum += value;
            greatest = greatest.max(value);
            if let Statistic::FractionAbove(level) = check.statistic
                && value > level
            {
                above += 1;
            }
        }
    }
    if pixels == 0 {
        return f64::NAN;
    }
    match check.statistic {
        Statistic::Mean => sum / pixels as f64,
        Statistic::FractionAbove(_) => above as f64 / pixels as f64,
        Statistic::Max => greatest,
    }
}

/// The check in words, for expectations without a text.
fn describe(expectation: &Expectation) -> String {
    let mask = |check: &MaskCheck| {
        let name = check.mask.suffix();
        match check.statistic {
            Statistic::Mean => format!("mean of {name}"),
            Statistic::Max => format!("maximum of {name}"),
            Statistic::FractionAbove(level) => format!("share of {name} above {}", brief(level)),
        }
    };
    match &expectation.check {
        Check::Mask(check) => match expectation.at {
            At::All => mask(check),
            At::Last => format!("{} at the last capture", mask(check)),
            At::Capture(i) => format!("{} at capture {i}", mask(check)),
        },
        Check::Rises(c) | Check::Falls(c) => {
            let verb = if matches!(expectation.check, Check::Rises(_)) {
                "rises"
            } else {
                "falls"
            };
            let factor = if c.factor > 1.0 {
                format!(" {}-fold", brief(c.factor))
            } else {
                String::new()
            };
            format!(
                "{} {verb}{factor} from capture {} to {}",
                mask(&c.mask_check()),
                c.from,
                c.to
            )
        }
        Check::Weather(check) => {
            let name = match check.quantity {
                WeatherQuantity::IntensityMmH => "intensity (mm/h)",
                WeatherQuantity::Wetness => "wetness",
                WeatherQuantity::WaterLevelMm => "water level (mm)",
            };
            let surface = match check.quantity {
                WeatherQuantity::IntensityMmH => String::new(),
                _ => format!(" of {}", surface_name(check.surface)),
            };
            format!("{name}{surface} at {} s", brief(check.time_s))
        }
        Check::Pass(check) => {
            let what = if check.frames == PassFrames::Recorded {
                "recorded"
            } else {
                "skipped"
            };
            format!("frames with {} {what}", check.name)
        }
        Check::Budget(BudgetTerm::Residual) => "residual of the water budget".into(),
        Check::Budget(term) => format!("{term:?} water (m³)").to_lowercase(),
        Check::Count(check) => format!("{:?} of {:?} per frame", check.over_frames, check.of).to_lowercase(),
    }
}

#[cfg(test)]
#[path = "expect_tests.rs"]
mod tests;
