//! The lone paraboloid puddle.

use proptest::prelude::*;
use rain_core::surface::ParaboloidPuddle;
use rain_reference::surface as truth;

use super::{ANY, config, log_spaced};
use crate::check::Worst;

const MM_H: f64 = 1.0 / 3.6e6;

fn hollow(radius: f64) -> ParaboloidPuddle {
    ParaboloidPuddle::new(radius).expect("valid")
}

#[test]
fn a_lone_puddle_has_its_check_values() {
    let p = hollow(200.0);
    let (q, e) = (30e-3 / 3600.0, 3.0 * MM_H);
    assert!((p.balance_level_m(q, e).expect("loses") * 1e3 - 7.957_747).abs() < 5.1e-7);
    for (time, level_mm) in [
        (600.0, 2.497_936),
        (3600.0, 5.071_979),
        (7200.0, 6.250_890),
        (36_000.0, 7.889_677),
    ] {
        let h = p.level_after_m(0.0, q, e, time) * 1e3;
        assert!((h - level_mm).abs() < 5.1e-7, "{time}: {h}");
    }
    let h = p.level_after_m(0.0, q, e, 3600.0);
    assert!((p.volume_m3(h) * 1e3 - 16.163_48).abs() < 5.1e-6);
    assert!((p.area_m2(h) - 6.373_64).abs() < 5.1e-6);
    // 5 mm at 3 mm/h: 6000 s.
    assert!((ParaboloidPuddle::drying_time_s(5e-3, e).expect("dries") - 6000.0).abs() < 1e-9);
    assert!((p.level_after_m(5e-3, 0.0, e, 3000.0) - 2.5e-3).abs() < 1e-16);
    assert_eq!(p.level_after_m(5e-3, 0.0, e, 6001.0), 0.0);
}

#[test]
fn a_lone_puddle_is_a_paraboloid() {
    let (mut worst, mut wrong) = (Worst::default(), Worst::default());
    for radius in log_spaced(1e-3, 1e9, 25) {
        let p = hollow(radius);
        for level in log_spaced(1e-9, 1e3, 25) {
            let place = || format!("{radius} {level}");
            // Of a circle whose edge lies at r² = 2 R h the paraboloid holds half the cylinder.
            let area = std::f64::consts::PI * (2.0 * radius * level);
            let volume = 0.5 * area * level;
            worst.relative(p.area_m2(level), area, 0.0, place);
            worst.relative(p.volume_m3(level), volume, 0.0, place);
            if volume <= 1e15 {
                worst.relative(p.level_m(volume), level, 0.0, place);
            }
            wrong.relative(p.volume_m3(1.05 * level), volume, 0.0, String::new);
            for loss in log_spaced(1e-12, 1.0, 7) {
                // A loss that takes from this area what flows in.
                let inflow = loss * area;
                if inflow <= 1e6 {
                    let balance = p.balance_level_m(inflow, loss).expect("loses");
                    worst.relative(balance, level, 0.0, || format!("{radius} {level} {loss}"));
                }
                let dry = ParaboloidPuddle::drying_time_s(level, loss).expect("dries");
                worst.relative(dry, level / loss, 0.0, place);
            }
        }
    }
    worst.assert_below(1e-15, 5000);
    assert!(wrong.error > 0.05, "a level 5 % off goes unseen");
}

#[test]
fn a_lone_puddle_fills_in_the_time_of_the_integral() {
    let mut worst = Worst::default();
    for radius in [1.0, 200.0, 1e5] {
        for (q, e) in [(1e-5, 3.0 * MM_H), (1e-3, 0.1 * MM_H), (1e-8, 50.0 * MM_H)] {
            let p = hollow(radius);
            let balance = p.balance_level_m(q, e).expect("loses");
            for share in [1e-4, 0.01, 0.3, 0.9, 0.99] {
                let level = share * balance;
                let time = truth::puddle_rise_time(radius, level, q, e);
                if time < 1e10 && level < 1e3 {
                    worst.relative(p.level_after_m(0.0, q, e, time), level, 0.0, || {
                        format!("{radius} {q} {e} {share}")
                    });
                }
            }
        }
    }
    worst.assert_below(1e-13, 30);
}

#[test]
fn a_lone_puddle_moves_as_its_volume_is_stepped() {
    let (mut worst, mut wrong) = (Worst::default(), Worst::default());
    let p = hollow(200.0);
    let e = 3.0 * MM_H;
    for start in [1e-3, 7e-3, 7.957_747e-3, 9e-3, 0.05] {
        for q in [1e-7, 8e-6, 5e-5] {
            for time in [60.0, 3600.0, 20_000.0] {
                let reference = truth::puddle(200.0, start, q, e, time, 50_000);
                worst.relative(p.level_after_m(start, q, e, time), reference, 1e-5, || {
                    format!("{start} {q} {time}")
                });
                wrong.relative(p.level_after_m(start, 1.05 * q, e, time), reference, 1e-5, String::new);
            }
        }
    }
    worst.assert_below(1e-13, 45);
    assert!(wrong.error > 0.01, "an inflow 5 % off goes unseen");
}

#[test]
fn a_lone_puddle_clamps_and_refuses() {
    for p in [hollow(1e-3), hollow(200.0), hollow(1e9)] {
        for a in ANY {
            for x in [p.volume_m3(a), p.area_m2(a), p.level_m(a)] {
                assert!(x.is_finite() && x >= 0.0, "{a}");
            }
            for b in ANY {
                assert!(ParaboloidPuddle::drying_time_s(a, b).is_none_or(|t| t >= 0.0));
                assert!(p.balance_level_m(a, b).is_none_or(|t| t >= 0.0));
                for c in ANY {
                    for d in ANY {
                        let h = p.level_after_m(a, b, c, d);
                        assert!(h.is_finite() && h >= 0.0, "{a} {b} {c} {d}: {h}");
                    }
                }
            }
        }
    }
    for bad in [f64::NAN, f64::INFINITY, 0.0, -1.0, 1e10] {
        let error = ParaboloidPuddle::new(bad).expect_err("refused").to_string();
        assert!(error.starts_with("curvature_radius_m"), "{error}");
    }
    assert_eq!(ParaboloidPuddle::drying_time_s(1.0, 0.0), None);
    assert_eq!(ParaboloidPuddle::drying_time_s(0.0, 0.0), Some(0.0));
}

proptest! {
    #![proptest_config(config(256))]

    #[test]
    fn a_lone_puddle_composes_and_goes_to_its_balance(
        radius in 0.1_f64..1e4,
        start in 0.0_f64..0.1,
        inflow in prop_oneof![Just(0.0), 1e-9_f64..1e-2],
        loss in prop_oneof![Just(0.0), 1e-9_f64..1e-4],
        time in 0.0_f64..1e6,
        part in 0.0_f64..1.0,
    ) {
        let p = hollow(radius);
        let whole = p.level_after_m(start, inflow, loss, time);
        let cut = p.level_after_m(p.level_after_m(start, inflow, loss, part * time), inflow, loss, (1.0 - part) * time);
        let scale = whole.max(start);
        prop_assert!((whole - cut).abs() <= 1e-12 * scale, "{whole} {cut}");
        // Between the start and the balance, and no more water than came.
        if let Some(balance) = p.balance_level_m(inflow, loss) {
            let slack = 1e-13 * scale;
            prop_assert!(whole >= start.min(balance) - slack && whole <= start.max(balance) + slack);
        }
        prop_assert!(p.volume_m3(whole) <= (p.volume_m3(start) + inflow * time) * (1.0 + 1e-12));
        prop_assert!(p.level_after_m(start, 1.1 * inflow, loss, time) >= whole * (1.0 - 1e-12));
        prop_assert!((p.level_m(p.volume_m3(whole)) - whole).abs() <= 1e-15 * whole);
    }
}
