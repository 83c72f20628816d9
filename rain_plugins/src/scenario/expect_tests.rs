use rain_core::weather::SurfaceClass;

use super::super::expectation::{Change, CountCheck, PassCheck};
use super::super::file::{Captures, Outputs};
use super::super::report::Tally;
use super::super::timeline::Series;
use super::*;

const SIZE: [u32; 2] = [8, 4];

fn mask(check: MaskCheck) -> Expectation {
    Expectation {
        text: String::new(),
        check: Check::Mask(check),
        at: At::All,
        equals: None,
        min: None,
        max: None,
        tolerance: 0.0,
    }
}

fn check(mask: Mask, statistic: Statistic) -> MaskCheck {
    MaskCheck {
        mask,
        statistic,
        region: [0.0, 0.0, 1.0, 1.0],
        depth_m: None,
    }
}

/// Three captures whose rain is 0, 0.25 and 0.5 on the left half, nothing on the right; depth 1 m per column.
fn run(expectations: Vec<Expectation>) -> Vec<ExpectationRow> {
    let scenario = Scenario {
        captures: Captures::Times(vec![0.0, 1.0, 2.0]),
        outputs: Outputs {
            masks: vec![Mask::Rain, Mask::Depth],
            ..Outputs::default()
        },
        expectations,
        ..Scenario::default()
    };
    scenario.validate().unwrap();
    let mut evaluator = Evaluator::new(&scenario);
    let depth: Vec<u16> = (0..32).map(|i| (i % 8) * 1000).collect();
    for (index, level) in [0, 16_384, 32_768].into_iter().enumerate() {
        let rain: Vec<u16> = (0..32).map(|i| if i % 8 < 4 { level } else { 0 }).collect();
        evaluator.capture(
            index,
            &CaptureMasks {
                size: SIZE,
                rain: Some(&rain),
                wet: None,
                depth: Some(&depth),
                water: None,
            },
        );
    }
    evaluator.finish(&evidence(&timeline(), &passes()))
}

fn timeline() -> Timeline {
    Timeline {
        times_s: vec![0.0, 300.0, 600.0],
        intensity_mm_h: vec![0.0, 20.0, f64::NAN],
        wetness: vec![
            Series {
                name: "asphalt".into(),
                values: vec![0.0, 0.5, 1.0],
            },
            Series {
                name: "stone".into(),
                values: vec![0.0, 1.0, 1.0],
            },
        ],
        ..Timeline::default()
    }
}

fn passes() -> Vec<PassRow> {
    vec![PassRow {
        name: "cover".into(),
        recorded_frames: 3,
        skipped_frames: 9,
        ..PassRow::default()
    }]
}

fn evidence<'a>(timeline: &'a Timeline, passes: &'a [PassRow]) -> Evidence<'a> {
    const BUDGET: Budget = Budget {
        rain_m3: 10.0,
        film_m3: 0.0,
        pores_m3: 0.0,
        basins_m3: 2.0,
        canopy_m3: 0.0,
        airborne_m3: 0.0,
        evaporated_m3: 0.0,
        infiltrated_m3: 0.0,
        drained_m3: 8.0,
        residual_relative: -2e-9,
    };
    const COUNTS: Counts = Counts {
        drops: Tally {
            median: 100.0,
            maximum: 250,
        },
        billboards: Tally {
            median: 0.0,
            maximum: 0,
        },
        splashes: Tally {
            median: 0.0,
            maximum: 0,
        },
        drips: Tally {
            median: 0.0,
            maximum: 0,
        },
        wheel_particles: Tally {
            median: 0.0,
            maximum: 0,
        },
    };
    Evidence {
        timeline,
        passes,
        budget: &BUDGET,
        counts: &COUNTS,
    }
}

/// Value of the expectation, and whether it passes with `[value − slack, value + slack]` but not with a range beside it.
fn value_of(expectation: Expectation) -> f64 {
    let value = run(vec![Expectation {
        min: Some(0.0),
        ..expectation.clone()
    }])[0]
        .value;
    let at = |equals: f64, tolerance: f64| {
        let row = run(vec![Expectation {
            equals: Some(equals),
            tolerance,
            ..expectation.clone()
        }])
        .remove(0);
        assert_eq!((row.expected, row.tolerance), (equals, Some(tolerance)));
        row.passed
    };
    assert!(at(value, 0.0) && at(value + 1.0, 1.01) && !at(value + 1.0, 0.99) && !at(value - 1.0, 0.99));
    value
}

fn close(a: f64, b: f64) {
    assert!((a - b).abs() < 2e-5, "{a} {b}");
}

#[test]
fn statistics_of_masks() {
    let at = |statistic, index| Expectation {
        at: At::Capture(index),
        ..mask(check(Mask::Rain, statistic))
    };
    close(value_of(at(Statistic::Mean, 2)), 0.25);
    close(value_of(at(Statistic::Max, 2)), 0.5);
    close(value_of(at(Statistic::FractionAbove(0.3), 2)), 0.5);
    close(value_of(at(Statistic::FractionAbove(0.3), 1)), 0.0);
    close(
        value_of(Expectation {
            at: At::Last,
            ..mask(check(Mask::Rain, Statistic::Mean))
        }),
        0.25,
    );
    let depth = Expectation {
        at: At::Last,
        ..mask(check(Mask::Depth, Statistic::Max))
    };
    close(value_of(depth), 7.0);
    // Left quarter: columns 0 and 1. Depth 3 to 4 m: one wet column, one dry.
    let part = |region, depth_m| Expectation {
        at: At::Last,
        ..mask(MaskCheck {
            region,
            depth_m,
            ..check(Mask::Rain, Statistic::Mean)
        })
    };
    close(value_of(part([0.0, 0.0, 0.25, 1.0], None)), 0.5);
    close(value_of(part([0.5, 0.0, 1.0, 0.25], None)), 0.0);
    close(value_of(part([0.0, 0.0, 1.0, 1.0], Some([3.0, 4.0]))), 0.25);
}

#[test]
fn no_pixels_and_no_mask_never_pass() {
    let everything = |check: MaskCheck| Expectation {
        min: Some(-1e30),
        max: Some(1e30),
        ..mask(check)
    };
    let far = MaskCheck {
        depth_m: Some([50.0, 60.0]),
        ..check(Mask::Rain, Statistic::Mean)
    };
    let sliver = MaskCheck {
        region: [0.01, 0.0, 0.02, 1.0],
        ..check(Mask::Rain, Statistic::Max)
    };
    let rows = run(vec![
        everything(far),
        everything(sliver),
        everything(check(Mask::Rain, Statistic::Mean)),
    ]);
    assert_eq!(
        rows.iter().map(|r| (r.value.is_nan(), r.passed)).collect::<Vec<_>>(),
        [(true, false), (true, false), (false, true)]
    );
    // A capture that never came, a mask that is missing, a mask of another size.
    let scenario = Scenario {
        captures: Captures::Times(vec![0.0]),
        expectations: vec![everything(check(Mask::Rain, Statistic::Mean))],
        ..Scenario::default()
    };
    let (timeline, passes) = (timeline(), passes());
    let evidence = evidence(&timeline, &passes);
    let mut evaluator = Evaluator::new(&scenario);
    assert!(!evaluator.finish(&evidence)[0].passed);
    for rain in [None, Some(&[1_u16, 2, 3][..])] {
        evaluator.capture(
            0,
            &CaptureMasks {
                size: [2, 2],
                rain,
                ..CaptureMasks::default()
            },
        );
        assert!(!evaluator.finish(&evidence)[0].passed);
    }
    evaluator.capture(
        0,
        &CaptureMasks {
            size: [2, 2],
            rain: Some(&[0; 4]),
            ..CaptureMasks::default()
        },
    );
    assert!(evaluator.finish(&evidence)[0].passed);
}

#[test]
fn all_captures_report_the_worst() {
    let all = Expectation {
        min: Some(0.1),
        max: Some(0.6),
        ..mask(check(Mask::Rain, Statistic::Mean))
    };
    let row = run(vec![all]).remove(0);
    assert!(
        !row.passed && row.value == 0.0 && row.text.contains("capture 0"),
        "{row:?}"
    );
    close(row.expected, 0.35);
    close(row.tolerance.unwrap(), 0.25);
    let most = Expectation {
        max: Some(0.2),
        ..mask(check(Mask::Rain, Statistic::Mean))
    };
    let row = run(vec![most.clone()]).remove(0);
    assert!(
        !row.passed && row.text.contains("capture 2") && row.tolerance.is_none(),
        "{row:?}"
    );
    let row = run(vec![Expectation {
        tolerance: 0.06,
        ..most
    }])
    .remove(0);
    assert!(row.passed && row.maximum.unwrap() > 0.25, "{row:?}");
}

#[test]
fn changes_between_captures() {
    let change = |from, to, factor| Change {
        mask: Mask::Rain,
        statistic: Statistic::Mean,
        region: [0.0, 0.0, 1.0, 1.0],
        depth_m: None,
        from,
        to,
        factor,
    };
    let rises = |from, to, factor| Expectation {
        check: Check::Rises(change(from, to, factor)),
        ..mask(check(Mask::Rain, Statistic::Mean))
    };
    let falls = |from, to, factor| Expectation {
        check: Check::Falls(change(from, to, factor)),
        ..mask(check(Mask::Rain, Statistic::Mean))
    };
    let rows = run(vec![
        rises(1, 2, 1.9),
        rises(1, 2, 2.1),
        rises(2, 1, 1.0),
        rises(0, 1, 1000.0),
        rises(0, 0, 1.0),
        falls(2, 1, 1.9),
        falls(2, 1, 2.1),
        falls(1, 2, 1.0),
        falls(1, 0, 1000.0),
        falls(0, 0, 1.0),
    ]);
    let passed: Vec<_> = rows.iter().map(|r| r.passed).collect();
    assert_eq!(
        passed,
        [true, false, false, true, false, true, false, false, true, false]
    );
    close(rows[1].expected, 2.1 * 0.125);
    assert!(
        rows[0].text.contains("rises 1.9-fold from capture 1 to 2"),
        "{}",
        rows[0].text
    );
}

#[test]
fn weather_passes_budget_and_counts() {
    let with = |check: Check| Expectation {
        check,
        ..mask(check_rain())
    };
    let weather = |quantity, time_s, surface: SurfaceClass| {
        with(Check::Weather(WeatherCheck {
            quantity,
            time_s,
            surface,
        }))
    };
    assert_eq!(
        value_of(weather(WeatherQuantity::IntensityMmH, 150.0, SurfaceClass::Asphalt)),
        10.0
    );
    assert_eq!(
        value_of(weather(WeatherQuantity::Wetness, 150.0, SurfaceClass::Asphalt)),
        0.25
    );
    assert_eq!(
        value_of(weather(WeatherQuantity::Wetness, 150.0, SurfaceClass::Stone)),
        0.5
    );
    let pass = |name: &str, frames| {
        with(Check::Pass(PassCheck {
            name: name.into(),
            frames,
        }))
    };
    assert_eq!(value_of(pass("cover", PassFrames::Recorded)), 3.0);
    assert_eq!(value_of(pass("cover", PassFrames::Skipped)), 9.0);
    assert_eq!(value_of(pass("lens", PassFrames::Recorded)), 0.0);
    assert_eq!(value_of(with(Check::Budget(BudgetTerm::Basins))), 2.0);
    // The residual's sign does not matter.
    let residual = |max| Expectation {
        max: Some(max),
        ..with(Check::Budget(BudgetTerm::Residual))
    };
    let rows = run(vec![residual(3e-9), residual(1e-9)]);
    assert!(rows[0].passed && !rows[1].passed);
    let count = |over_frames| {
        with(Check::Count(CountCheck {
            of: CountOf::Drops,
            over_frames,
        }))
    };
    assert_eq!(value_of(count(OverFrames::Median)), 100.0);
    assert_eq!(value_of(count(OverFrames::Maximum)), 250.0);
    // Not a number, an unknown class, no such record: none of them passes.
    let any = |e: Expectation| Expectation { min: Some(-1e30), ..e };
    for expectation in [
        weather(WeatherQuantity::IntensityMmH, 600.0, SurfaceClass::Asphalt),
        weather(WeatherQuantity::Wetness, 0.0, SurfaceClass::Grass),
        weather(WeatherQuantity::WaterLevelMm, 0.0, SurfaceClass::Asphalt),
    ] {
        let row = run(vec![any(expectation)]).remove(0);
        assert!(row.value.is_nan() && !row.passed, "{row:?}");
    }
}

fn check_rain() -> MaskCheck {
    check(Mask::Rain, Statistic::Mean)
}
