//! Green & Ampt's front, inlets.

use proptest::prelude::*;
use rain_core::surface::{Grate, GreenAmpt, SoilTexture};
use rain_reference::surface as truth;

use super::{ANY, config, log_spaced};
use crate::check::Worst;

fn loam() -> GreenAmpt {
    SoilTexture::Loam.soil(0.3).expect("valid")
}

#[test]
fn the_front_has_its_check_values() {
    let sandy = SoilTexture::SandyLoam.soil(0.3).expect("valid");
    for (soil, hours, depth, rate) in [
        (sandy, 1.0, 34.542_25, 21.322_80),
        (loam(), 0.5, 10.687_99, 11.884_10),
        (loam(), 2.0, 23.823_72, 7.206_21),
    ] {
        let f = soil.flooded_mm(hours);
        assert!((f - depth).abs() < 5.1e-6, "{f}");
        assert!((soil.capacity_mm_h(f) - rate).abs() < 5.1e-6);
    }
    assert!((loam().ponding_time_h(25.0).expect("ponds") - 0.167_92).abs() < 5.1e-6);
    assert_eq!(loam().ponding_time_h(3.4), None, "at K it never ponds");
    // Rawls et al. 1983.
    let table = [
        (117.8, 49.5),
        (10.9, 110.1),
        (3.4, 88.9),
        (6.5, 166.8),
        (1.0, 208.8),
        (0.3, 316.3),
    ];
    for (texture, (k, psi)) in SoilTexture::ALL.into_iter().zip(table) {
        let soil = texture.soil(0.3).expect("valid");
        assert_eq!((soil.conductivity_mm_h, soil.suction_mm), (k, psi), "{texture:?}");
    }
}

#[test]
fn the_front_is_the_integral_over_its_domain() {
    let (mut flooded, mut rained, mut wrong) = (Worst::default(), Worst::default(), Worst::default());
    for conductivity_mm_h in log_spaced(1e-3, 1e3, 5) {
        for suction_mm in log_spaced(1e-3, 1e3, 5) {
            let soil = GreenAmpt {
                conductivity_mm_h,
                suction_mm,
                moisture_deficit: 0.4,
            };
            for hours in log_spaced(1e-3, 10.0, 5) {
                let reference = truth::green_ampt(conductivity_mm_h, 0.4 * suction_mm, 0.0, hours);
                flooded.relative(soil.flooded_mm(hours), reference, 0.0, || format!("{soil:?} {hours}"));
                wrong.relative(soil.flooded_mm(1.05 * hours), reference, 0.0, String::new);
                // The capacity is the speed of what infiltrates.
                let speed = (soil.flooded_mm(1.0001 * hours) - soil.flooded_mm(0.9999 * hours)) / (2e-4 * hours);
                assert!((soil.capacity_mm_h(reference) / speed - 1.0).abs() < 1e-6);
                for excess in [0.5, 1.5, 20.0] {
                    let rain = excess * conductivity_mm_h;
                    let reference = truth::green_ampt_rain(conductivity_mm_h, 0.4 * suction_mm, rain, hours);
                    rained.relative(soil.infiltrated_mm(0.0, rain, hours), reference, 0.0, || {
                        format!("{soil:?} {rain} {hours}")
                    });
                }
            }
        }
    }
    // The sum is good to this where the front is thin against the water.
    flooded.assert_below(1e-8, 125);
    rained.assert_below(1e-8, 375);
    assert!(wrong.error > 0.02, "a time 5 % off goes unseen");
}

#[test]
fn the_front_solves_its_own_equation() {
    // F − M ln(1 + F/M) by its series where it cancels.
    let left = |m: f64, f: f64| {
        let x = f / m;
        if x < 1e-3 {
            m * x * x * (0.5 - x * (1.0 / 3.0 - x * (0.25 - x * (0.2 - x / 6.0))))
        } else {
            f - m * x.ln_1p()
        }
    };
    let (mut worst, mut further, mut rained) = (Worst::default(), Worst::default(), Worst::default());
    let (mut closed, mut wrong) = (Worst::default(), Worst::default());
    for hours in log_spaced(1e-12, 1e6, 200) {
        for texture in SoilTexture::ALL {
            let soil = texture.soil(0.3).expect("valid");
            let (m, k) = (soil.front_mm(), soil.conductivity_mm_h);
            let place = || format!("{texture:?} {hours}");
            let f = soil.flooded_mm(hours);
            worst.relative(left(m, f), k * hours, 0.0, place);
            wrong.relative(left(m, 1.05 * f), k * hours, 0.0, place);
            closed.relative(soil.capacity_mm_h(f), k + k * m / f, 0.0, place);
            for state in [1e-3 * m, m, 50.0 * m] {
                let gone = left(m, state);
                further.relative(
                    left(m, soil.flooded_from_mm(state, hours)),
                    gone + k * hours,
                    0.0,
                    place,
                );
            }
            for excess in [1.001, 1.5, 20.0, 1e3] {
                let rain = excess * k;
                let ponds = k * m / (rain * (rain - k));
                closed.relative(soil.ponding_time_h(rain).expect("ponds"), ponds, 0.0, place);
                let f = soil.infiltrated_mm(0.0, rain, hours);
                if hours <= ponds {
                    rained.relative(f, rain * hours, 0.0, place);
                } else {
                    rained.relative(left(m, f), left(m, rain * ponds) + k * (hours - ponds), 0.0, place);
                }
            }
        }
    }
    worst.assert_below(1e-12, 1000);
    further.assert_below(1e-12, 3000);
    rained.assert_below(1e-12, 4000);
    closed.assert_below(1e-15, 5000);
    assert!(wrong.error > 0.04, "a depth 5 % off goes unseen");
}

#[test]
fn the_front_clamps_and_refuses() {
    for soil in [
        loam(),
        GreenAmpt {
            moisture_deficit: 0.0,
            ..loam()
        },
        GreenAmpt {
            conductivity_mm_h: 1e-6,
            suction_mm: 1e4,
            moisture_deficit: 0.6,
        },
    ] {
        for a in ANY {
            assert!(soil.flooded_mm(a).is_finite() && soil.flooded_mm(a) >= 0.0, "{a}");
            assert!(soil.capacity_mm_h(a).is_finite() && soil.capacity_mm_h(a) >= soil.conductivity_mm_h);
            assert!(soil.ponding_time_h(a).is_none_or(|t| t.is_finite() && t >= 0.0), "{a}");
            for b in ANY {
                let f = soil.flooded_from_mm(a, b);
                assert!(f.is_finite() && f >= 0.0, "{a} {b}: {f}");
                for c in ANY {
                    let f = soil.infiltrated_mm(a, b, c);
                    assert!(f.is_finite() && f >= 0.0, "{a} {b} {c}: {f}");
                }
            }
        }
    }
    let wet = SoilTexture::Loam.soil(0.0).expect("valid");
    assert_eq!(wet.flooded_mm(2.0), 6.8, "a wet soil takes K t");
    for bad in [f64::NAN, f64::INFINITY, -0.1, 0.61] {
        assert!(
            SoilTexture::Clay
                .soil(bad)
                .expect_err("refused")
                .to_string()
                .starts_with("moisture_deficit")
        );
    }
    for bad in [f64::NAN, f64::INFINITY, -1.0, 1e5] {
        let k = GreenAmpt {
            conductivity_mm_h: bad,
            ..loam()
        };
        assert!(
            k.validated()
                .expect_err("refused")
                .to_string()
                .starts_with("conductivity_mm_h")
        );
        let psi = GreenAmpt {
            suction_mm: bad,
            ..loam()
        };
        assert!(
            psi.validated()
                .expect_err("refused")
                .to_string()
                .starts_with("suction_mm")
        );
    }
}

proptest! {
    #![proptest_config(config(256))]

    #[test]
    fn any_cut_of_the_rain_infiltrates_the_same(
        texture in 0_usize..6,
        deficit in 0.0_f64..0.5,
        rain in 0.0_f64..100.0,
        hours in 0.0_f64..5.0,
        cuts in 1_u32..60,
        more in 0.0_f64..10.0,
    ) {
        let soil = SoilTexture::ALL[texture].soil(deficit).expect("valid");
        let whole = soil.infiltrated_mm(0.0, rain, hours);
        let cut = (0..cuts).fold(0.0, |f, _| soil.infiltrated_mm(f, rain, hours / f64::from(cuts)));
        prop_assert!((whole - cut).abs() <= 1e-12 * whole, "{whole} {cut}");
        prop_assert!(whole <= rain * hours * (1.0 + 1e-15), "no more than fell");
        prop_assert!(whole <= soil.flooded_mm(hours) * (1.0 + 1e-13), "no more than under standing water");
        prop_assert!(soil.infiltrated_mm(0.0, rain + more, hours) >= whole * (1.0 - 1e-13), "more rain");
        prop_assert!(soil.infiltrated_mm(0.0, rain, hours + 0.1) >= whole, "more time");
        let paused = soil.infiltrated_mm(soil.infiltrated_mm(whole, 0.0, 9.0), rain, 1.0);
        prop_assert_eq!(paused, soil.infiltrated_mm(whole, rain, 1.0), "a pause uses nothing up");
        let flooded = soil.flooded_from_mm(soil.flooded_mm(0.3 * hours), 0.7 * hours);
        prop_assert!((flooded - soil.flooded_mm(hours)).abs() <= 1e-12 * flooded);
    }
}

const GULLY: Grate = Grate {
    perimeter_m: 1.2,
    area_m2: 0.05,
};

#[test]
fn inlets_have_their_check_values_and_the_smaller_law_counts() {
    assert!((GULLY.weir_m3_s(0.02) - 5.6342e-3).abs() < 5e-8);
    assert!((GULLY.orifice_m3_s(0.1) - 4.6916e-2).abs() < 5.1e-7);
    assert_eq!(GULLY.capacity_m3_s(0.02), GULLY.weir_m3_s(0.02));
    assert_eq!(GULLY.capacity_m3_s(0.1), GULLY.orifice_m3_s(0.1));
    let turn = GULLY.transition_depth_m();
    assert!((GULLY.weir_m3_s(turn) / GULLY.orifice_m3_s(turn) - 1.0).abs() < 1e-14);
    let (mut worst, mut wrong) = (Worst::default(), Worst::default());
    for (perimeter_m, area_m2) in [
        (1.2, 0.05),
        (1e-6, 1e3),
        (1e3, 1e-6),
        (37.0, 900.0),
        (0.0, 0.1),
        (0.1, 0.0),
    ] {
        let grate = Grate { perimeter_m, area_m2 };
        let place = || format!("{grate:?}");
        for depth in log_spaced(1e-12, 100.0, 100) {
            let q = truth::inlet(perimeter_m, area_m2, depth);
            worst.relative(grate.capacity_m3_s(depth), q, 1e-300, place);
            // Either law alone: the other one has no say over a width or an area without end.
            let [weir, orifice] = [
                truth::inlet(perimeter_m, 1e30, depth),
                truth::inlet(1e30, area_m2, depth),
            ];
            worst.relative(grate.weir_m3_s(depth), weir, 1e-300, place);
            worst.relative(grate.orifice_m3_s(depth), orifice, 1e-300, place);
            wrong.relative(grate.capacity_m3_s(1.05 * depth), q, 1e-300, place);
        }
        if perimeter_m > 0.0 {
            let turn = 0.67 / 1.66 * area_m2 / perimeter_m * (2.0 * 9.806_65_f64).sqrt();
            worst.relative(grate.transition_depth_m(), turn, 1e-300, place);
        } else {
            assert_eq!(grate.transition_depth_m(), f64::INFINITY);
        }
    }
    worst.assert_below(1e-15, 1800);
    assert!(wrong.error > 0.02, "a depth 5 % off goes unseen");
}

#[test]
fn a_pond_over_an_inlet_falls_as_stepped() {
    let (mut worst, mut wrong) = (Worst::default(), Worst::default());
    for depth in [0.001, 0.05, GULLY.transition_depth_m(), 0.5, 3.0] {
        for pond in [5.0, 100.0] {
            for time in [1.0, 30.0, 400.0] {
                let reference = truth::inlet_drained(1.2, 0.05, depth, pond, time, 20_000);
                let d = GULLY.drained_depth_m(depth, pond, time);
                worst.relative(d, reference, 0.0, || format!("{depth} {pond} {time}"));
                wrong.relative(
                    GULLY.drained_depth_m(depth, 1.05 * pond, time),
                    reference,
                    0.0,
                    String::new,
                );
            }
        }
    }
    // The step across the kink between the laws errs by this.
    worst.assert_below(3e-8, 30);
    assert!(wrong.error > 0.02, "a pond 5 % off goes unseen");
}

#[test]
fn inlets_clamp_and_refuse() {
    for a in ANY {
        for d in [GULLY.weir_m3_s(a), GULLY.orifice_m3_s(a), GULLY.capacity_m3_s(a)] {
            assert!(d.is_finite() && d >= 0.0, "{a}");
        }
        for b in ANY {
            for c in ANY {
                for inlet in [
                    GULLY,
                    Grate {
                        perimeter_m: 0.0,
                        ..GULLY
                    },
                ] {
                    let d = inlet.drained_depth_m(a, b, c);
                    assert!((0.0..=100.0 * (1.0 + 1e-15)).contains(&d), "{a} {b} {c}: {d}");
                }
            }
        }
        if a.is_nan() || !(0.0..=1e3).contains(&a) {
            assert!(
                Grate {
                    perimeter_m: a,
                    ..GULLY
                }
                .validated()
                .is_err()
            );
            assert!(Grate { area_m2: a, ..GULLY }.validated().is_err());
        }
    }
    let shut = Grate {
        perimeter_m: 0.0,
        area_m2: 0.0,
    };
    assert_eq!(
        (shut.capacity_m3_s(1.0), shut.drained_depth_m(0.25, 9.0, 1e6)),
        (0.0, 0.25)
    );
}

proptest! {
    #![proptest_config(config(256))]

    #[test]
    fn a_pond_falls_alike_in_any_cut_and_never_below_nothing(
        depth in 0.0_f64..2.0,
        pond in 0.5_f64..500.0,
        time in 0.0_f64..2000.0,
        part in 0.0_f64..1.0,
    ) {
        let whole = GULLY.drained_depth_m(depth, pond, time);
        let cut = GULLY.drained_depth_m(GULLY.drained_depth_m(depth, pond, part * time), pond, (1.0 - part) * time);
        prop_assert!(whole >= 0.0 && whole <= depth * (1.0 + 1e-15));
        prop_assert!((whole - cut).abs() <= 1e-13 * depth.max(1e-9), "{whole} {cut}");
        prop_assert!(GULLY.capacity_m3_s(1.01 * depth) >= GULLY.capacity_m3_s(depth));
    }
}

#[test]
fn soils_of_hardly_any_suction_take_what_gravity_takes() {
    for suction_mm in [0.0, 1e-310, 1e-300, 1e-200, 1e-20] {
        let soil = GreenAmpt {
            conductivity_mm_h: 10.0,
            suction_mm,
            moisture_deficit: 0.3,
        };
        for state in [0.0, 1e-3, 1.0, 1e12] {
            for hours in [0.0, 1e-300, 1.0, 1e9] {
                let (value, truth) = (soil.flooded_from_mm(state, hours), state + 10.0 * hours);
                assert!(
                    (value - truth).abs() <= 1e-12 * truth + 1e-18,
                    "{suction_mm} {state} {hours}: {value}"
                );
            }
        }
    }
}
