//! Drops and moving sources.

use proptest::prelude::*;
use rain_core::splash::impact_energy_j;
use rain_core::waves::{
    Border, DropImpact, Push, SweptSource, WaveField, WaveSettings, erf_f32, swept_laplacian_f32, swept_weight,
    swept_weight_f32,
};
use rain_reference::waves as truth;

use super::super::check::Worst;
use super::{cases, settings, started, total};

/// Terminal speeds behind the published momenta and energies, by 2E/(m v).
fn drop(diameter_mm: f64) -> DropImpact {
    let speeds = [(1.0, 4.03), (2.0, 6.49), (3.0, 8.06), (4.0, 8.83), (5.0, 9.09)];
    let (_, speed_m_s) = speeds
        .into_iter()
        .find(|(d, _)| *d == diameter_mm)
        .expect("in the table");
    DropImpact {
        x_m: 0.0,
        z_m: 0.0,
        diameter_mm,
        speed_m_s,
    }
}

#[test]
fn drops_carry_the_published_momentum_and_energy() {
    for (diameter, momentum, energy) in [
        (1.0, 2.1063e-6, 4.2442e-6),
        (2.0, 2.7136e-5, 8.8057e-5),
        (3.0, 1.1374e-4, 4.5837e-4),
        (4.0, 2.9536e-4, 1.3040e-3),
        (5.0, 5.9387e-4, 2.6991e-3),
    ] {
        let drop = drop(diameter);
        assert!(
            (drop.momentum() / momentum - 1.0).abs() < 3e-5,
            "{diameter}: {}",
            drop.momentum()
        );
        assert!(
            (impact_energy_j(drop.diameter_mm, drop.speed_m_s) / energy - 1.0).abs() < 5e-5,
            "{diameter}: {}",
            impact_energy_j(drop.diameter_mm, drop.speed_m_s)
        );
    }
    for (diameter, kick, bump) in [
        (1.0, 5.3733e-3, 3.33e-6),
        (2.0, 6.9227e-2, 2.67e-5),
        (3.0, 0.29016, 9.0e-5),
    ] {
        let drop = drop(diameter);
        assert!((drop.peak_velocity(0.005, 0.005) / kick - 1.0).abs() < 5e-5);
        assert!((drop.volume_m3() / (std::f64::consts::TAU * 2.5e-5) / bump - 1.0).abs() < 3e-3);
    }
}

#[test]
fn a_source_is_two_cells_half_a_crater_and_linear() {
    // 1 mm: 2.42 mm by the crater, more by the cell.
    assert!((drop(1.0).width_m(0.01, 0.005) - 0.02).abs() < 1e-12);
    let fine = drop(1.0).width_m(1e-5, 0.005);
    assert!(fine >= 0.5 * 4.849e-3);
    for diameter in [1.0, 2.0, 3.0, 4.0, 5.0] {
        for depth in [0.001, 0.005, 0.05] {
            let width = drop(diameter).width_m(1e-4, depth);
            let limit = 0.3 * (9.80665 * depth).sqrt();
            assert!(drop(diameter).peak_velocity(depth, width) <= limit * (1.0 + 1e-12));
        }
    }
    assert!(drop(3.0).width_m(1e-4, 0.0).is_finite());
}

/// Still water of 5 mm on cells of 4 mm.
fn pond(border: Border) -> WaveField {
    WaveField::new(&WaveSettings {
        cells_x: 64,
        cells_z: 48,
        cell_m: 0.004,
        speed_m_s: 0.221_431_3,
        damping_per_s: 0.0,
        border,
        ..WaveSettings::default()
    })
    .expect("within the domains")
}

#[test]
fn an_impact_makes_its_volume_and_its_impulse_none() {
    for (border, x, z) in [
        (Border::Wall, 0.131, 0.093),
        (Border::Wall, 0.003, 0.190),
        (Border::Periodic, 0.001, 0.001),
        (Border::Periodic, -0.3, 7.1),
        (Border::Fixed, 0.131, 0.093),
    ] {
        let mut field = pond(border);
        let impact = DropImpact {
            x_m: x,
            z_m: z,
            ..drop(2.0)
        };
        assert!(field.add_drop(&impact).expect("finite"));
        let volume = impact.volume_m3();
        let sum = total(&field) * 0.004 * 0.004;
        assert!((sum / volume - 1.0).abs() < 1e-6, "{border:?}: {sum} of {volume}");
        if border != Border::Fixed {
            // Without an impulse in sum the mean stays: u⁻ has the same sum.
            field.step(200);
            let later = total(&field) * 0.004 * 0.004;
            assert!((later / volume - 1.0).abs() < 1e-3, "{border:?}: {later} of {volume}");
            assert!((field.volume_m3() / volume - 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn an_impact_moves_the_water_as_the_integral_says() {
    // Half the step is taken from the source's own first step, so the error is that of the grid.
    let cells = 280;
    let cell = 0.000_6;
    let mut field = WaveField::new(&WaveSettings {
        cells_x: cells,
        cells_z: cells,
        cell_m: cell,
        speed_m_s: 0.221_431_3,
        damping_per_s: 0.0,
        step_ns: Some(1_600_000),
        ..WaveSettings::default()
    })
    .expect("within the bound");
    let middle = (f64::from(cells) / 2.0 + 0.5) * cell;
    let impact = DropImpact {
        x_m: middle,
        z_m: middle,
        ..drop(2.0)
    };
    let (h, c) = (0.221_431_3_f64.powi(2) / 9.80665, 0.221_431_3);
    let s = impact.width_m(cell, h);
    assert!(field.add_drop(&impact).expect("finite"));
    let steps = 125;
    field.step(steps);
    let t = 0.0016 * f64::from(steps);
    let around = std::f64::consts::TAU * s * s;
    let (bump, push) = (impact.volume_m3() / around, h * impact.momentum() / (998.2 * around));
    let mut worst = Worst::default();
    let mut crest = 0.0_f64;
    for k in 0..120_u32 {
        let exact = truth::hankel(f64::from(k) * cell, s, 300, |k| {
            bump * (c * k * t).cos() - push * k / c * (c * k * t).sin()
        });
        let at = (cells / 2 * cells + cells / 2 + k) as usize;
        crest = crest.max(exact.abs());
        worst.absolute(f64::from(field.heights()[at]), exact, || format!("cell {k}"));
    }
    worst.assert_below(0.02 * crest, 100);
    assert!(crest > 1e-5);
    assert!(worst.error < 0.5 * 0.05 * crest, "a push 5 % stronger would be seen");
}

#[test]
fn drops_outside_on_land_and_not_finite() {
    let mut field = pond(Border::Wall);
    for (x, z) in [(-0.001, 0.1), (0.257, 0.1), (0.1, 0.193), (1e6, -1e6)] {
        assert!(
            !field
                .add_drop(&DropImpact {
                    x_m: x,
                    z_m: z,
                    ..drop(1.0)
                })
                .expect("finite")
        );
    }
    assert!(field.is_still());
    let depths: Vec<f32> = (0..64 * 48).map(|k| if k % 64 < 32 { 0.004_99 } else { 0.0 }).collect();
    field.set_depths(&depths).expect("shallow enough");
    assert!(
        !field
            .add_drop(&DropImpact {
                x_m: 0.2,
                z_m: 0.1,
                ..drop(1.0)
            })
            .expect("finite")
    );
    // By the shore all of the volume stays in the water.
    let impact = DropImpact {
        x_m: 0.126,
        z_m: 0.1,
        ..drop(3.0)
    };
    assert!(field.add_drop(&impact).expect("finite"));
    assert!((total(&field) * 1.6e-5 / impact.volume_m3() - 1.0).abs() < 1e-6);
    assert!((0..64 * 48).all(|k| k % 64 < 32 || field.heights()[k] == 0.0));
    let before = field.heights().to_vec();
    let good = drop(1.0);
    for (name, bad) in [
        ("x_m", DropImpact { x_m: f64::NAN, ..good }),
        (
            "z_m",
            DropImpact {
                z_m: f64::INFINITY,
                ..good
            },
        ),
        (
            "diameter_mm",
            DropImpact {
                diameter_mm: -1.0,
                ..good
            },
        ),
        (
            "diameter_mm",
            DropImpact {
                diameter_mm: f64::NAN,
                ..good
            },
        ),
        (
            "speed_m_s",
            DropImpact {
                speed_m_s: 31.0,
                ..good
            },
        ),
    ] {
        let error = field.add_drop(&bad).expect_err(name).to_string();
        assert!(error.starts_with(name), "{error}");
    }
    assert_eq!(field.heights(), before);
    // No drop is no change.
    let nothing = DropImpact {
        diameter_mm: 0.0,
        x_m: 0.1,
        z_m: 0.1,
        ..good
    };
    assert!(field.add_drop(&nothing).expect("finite"));
    assert_eq!(field.heights(), before);
}

#[test]
fn the_error_function_is_right_to_half_a_millionth() {
    let (mut worst, mut relative) = (Worst::default(), Worst::default());
    for i in -1200..=1200 {
        let x = i as f32 * 0.005;
        let exact = truth::erf(f64::from(x));
        worst.absolute(f64::from(erf_f32(x)), exact, || format!("x {x}"));
        relative.relative(f64::from(erf_f32(x)), exact, 1e-300, || format!("x {x}"));
        assert_eq!(erf_f32(-x), -erf_f32(x));
    }
    worst.assert_below(5e-7, 2000);
    relative.assert_below(1e-6, 2000);
    for tiny in [1e-30_f32, 1e-10, 1e-3] {
        let exact = 2.0 / std::f64::consts::PI.sqrt() * f64::from(tiny);
        assert!((f64::from(erf_f32(tiny)) / exact - 1.0).abs() < 1e-6);
    }
    assert!((1.0 - 1e-7..=1.0).contains(&erf_f32(f32::INFINITY)));
    assert_eq!(erf_f32(f32::NAN), 0.0);
}

#[test]
fn swept_weights_are_the_mean_over_the_way() {
    let (a, b, s) = ([0.0, 0.0], [0.1, 0.0], 0.03);
    assert!((swept_weight([0.02, 0.01], a, b, s) - 0.529_015_157_3).abs() < 5.1e-11);
    assert!((swept_weight([0.2, 0.0], a, b, s) - 0.000_322_648_4).abs() < 5.1e-11);
    let [mut double, mut single, mut curve] = [(); 3].map(|()| Worst::default());
    // From no way at all through both series to a long way, in an odd direction.
    for length in [0.0, 1e-6, 1e-3, 0.04, 0.0499, 0.0501, 0.3, 0.99, 1.01, 3.0, 20.0] {
        let way = [0.03 * length * 0.8, 0.03 * length * -0.6];
        for i in -12..=12 {
            for j in -6..=6 {
                let p = [0.013 * f64::from(i) + 0.5 * way[0], 0.019 * f64::from(j) + 0.5 * way[1]];
                let exact = truth::swept_weight(p, a, way, s);
                let place = || format!("length {length}, point {p:?}");
                double.absolute(swept_weight(p, a, way, s), exact, place);
                let [p32, way32] = [p, way].map(|v| v.map(|x| x as f32));
                single.absolute(f64::from(swept_weight_f32(p32, [0.0; 2], way32, 0.03)), exact, place);
                let laplacian = truth::swept_laplacian(p, a, way, s);
                curve.absolute(
                    f64::from(swept_laplacian_f32(p32, [0.0; 2], way32, 0.03)),
                    laplacian,
                    place,
                );
            }
        }
    }
    double.assert_below(1e-13, 3000);
    single.assert_below(2e-6, 3000);
    curve.assert_below(5e-6, 3000);
    let wrong = swept_weight([0.02, 0.01], a, b, s * 1.05) - 0.529_015_157_3;
    assert!(wrong.abs() > 1e-3);
}

#[test]
fn swept_weights_of_nonsense_are_nothing() {
    let bad = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        1e300,
        -1e300,
        0.0,
        -0.0,
        1e-300,
    ];
    for x in bad {
        for width in bad {
            for point in [[x, 0.0], [0.0, x]] {
                for (p, a, b) in [
                    (point, [0.0; 2], [0.1, 0.0]),
                    ([0.0; 2], point, [0.1, 0.0]),
                    ([0.0; 2], [0.1, 0.0], point),
                ] {
                    let w = swept_weight(p, a, b, width);
                    assert!((0.0..=1.0 + 1e-12).contains(&w), "{p:?} {a:?} {b:?} {width}: {w}");
                    let [p, a, b] = [p, a, b].map(|v| v.map(|x| x as f32));
                    let w = swept_weight_f32(p, a, b, width as f32);
                    assert!((0.0..=1.0 + 1e-6).contains(&w), "{p:?} {a:?} {b:?} {width}: {w}");
                    assert!(swept_laplacian_f32(p, a, b, width as f32).is_finite());
                }
            }
        }
    }
    let mut field = pond(Border::Wall);
    let good = SweptSource {
        from_m: [0.1, 0.1],
        to_m: [0.15, 0.1],
        width_m: 0.01,
        push: Push::Height(1e-3),
    };
    for (name, bad) in [
        (
            "from_m",
            SweptSource {
                from_m: [f32::NAN, 0.0],
                ..good
            },
        ),
        (
            "to_m",
            SweptSource {
                to_m: [0.0, f32::INFINITY],
                ..good
            },
        ),
        ("width_m", SweptSource { width_m: 0.0, ..good }),
        (
            "height_m",
            SweptSource {
                push: Push::Height(f32::NAN),
                ..good
            },
        ),
        (
            "impulse_n_s",
            SweptSource {
                push: Push::Impulse(f32::NEG_INFINITY),
                ..good
            },
        ),
    ] {
        let error = field.add_swept(&bad).expect_err(name).to_string();
        assert!(error.starts_with(name), "{error}");
    }
    assert!(field.is_still());
    // Far away it reaches nothing.
    field
        .add_swept(&SweptSource {
            from_m: [50.0, 50.0],
            to_m: [60.0, 50.0],
            ..good
        })
        .expect("finite");
    assert!(field.is_still());
}

#[test]
fn two_half_ways_are_one() {
    for push in [Push::Height(2e-3), Push::Impulse(4e-4)] {
        let half = match push {
            Push::Height(height) => Push::Height(0.5 * height),
            Push::Impulse(impulse) => Push::Impulse(0.5 * impulse),
        };
        let (from, middle, to) = ([0.05, 0.06], [0.11, 0.09], [0.17, 0.12]);
        let mut whole = pond(Border::Wall);
        let source = |from_m, to_m, push| SweptSource {
            from_m,
            to_m,
            width_m: 0.012,
            push,
        };
        whole.add_swept(&source(from, to, push)).expect("finite");
        let mut halves = pond(Border::Wall);
        halves.add_swept(&source(from, middle, half)).expect("finite");
        halves.add_swept(&source(middle, to, half)).expect("finite");
        let volume = whole.volume_m3();
        assert!((halves.volume_m3() - volume).abs() < 1e-5 * volume.abs() + 1e-15);
        match push {
            // Away from the borders the height's volume is that of the Gaussian's swept integral.
            Push::Height(height) => {
                let exact = f64::from(height) * std::f64::consts::TAU * 0.012 * 0.012;
                assert!((volume / exact - 1.0).abs() < 1e-4, "{volume} of {exact}");
            }
            Push::Impulse(_) => assert!(volume == 0.0),
        }
        whole.step(30);
        halves.step(30);
        let crest = super::peak(&whole);
        for (a, b) in whole.heights().iter().zip(halves.heights()) {
            assert!(
                f64::from((a - b).abs()) < 5e-5 * crest,
                "{push:?}: {a} and {b}, crest {crest}"
            );
        }
        assert!(total(&whole).abs() * 1.6e-5 - volume.abs() < 1e-5 * crest);
    }
}

#[test]
fn a_way_goes_around_a_tile_as_often_as_it_has_to() {
    let (nx, nz, cell) = (64_usize, 48_usize, 0.004);
    let sides = [nx as f64 * cell, nz as f64 * cell];
    let swept = |from_m: [f32; 2], to_m: [f32; 2], width_m: f32| {
        let mut field = pond(Border::Periodic);
        let push = Push::Height(1e-3);
        let source = SweptSource {
            from_m,
            to_m,
            width_m,
            push,
        };
        field.add_swept(&source).map(|()| field)
    };
    let mut worst = Worst::default();
    let mut cut = Worst::default();
    for (from, to, width) in [
        ([0.1_f32, 0.1_f32], [0.16_f32, 0.11_f32], 0.008_f32),
        ([0.1, 0.1], [0.5, 0.1], 0.008),
        ([0.02, 0.19], [0.02, -0.4], 0.015),
        ([-0.3, 0.05], [1.1, 0.9], 0.008),
        ([0.1, 0.1], [0.11, 0.1], 0.019),
        ([0.1, 0.1], [0.4, 0.3], 0.017),
    ] {
        let field = swept(from, to, width).expect("not far");
        let [from, to] = [from, to].map(|at| at.map(f64::from));
        let weight = |x: f64, z: f64| swept_weight([x, z], from, to, f64::from(width));
        for (index, height) in field.heights().iter().enumerate() {
            let [x, z] = [index % nx, index / nx].map(|i| (i as f64 + 0.5) * cell);
            let mut sum = 0.0;
            for (i, j) in (-8..=8).flat_map(|i| (-8..=8).map(move |j| (i, j))) {
                sum += weight(x + f64::from(i) * sides[0], z + f64::from(j) * sides[1]);
            }
            let place = || format!("{from:?} {to:?} {width}, cell {index}");
            worst.absolute(1e3 * f64::from(*height), sum, place);
            cut.absolute(1e3 * f64::from(*height), weight(x, z), place);
        }
        let volume = 1e-3 * std::f64::consts::TAU * f64::from(width * width);
        assert!(
            (field.volume_m3() / volume - 1.0).abs() < 2e-4,
            "{}",
            field.volume_m3() / volume
        );
    }
    worst.assert_below(2e-4, 6 * nx * nz);
    assert!(cut.error > 0.1, "one time around would be seen: {}", cut.error);
    assert!(swept([0.0, 0.0], [0.0, 12.28], 0.008).is_ok(), "64 tiles");
    let error = swept([0.0, 0.0], [0.0, 12.3], 0.008).expect_err("more").to_string();
    assert!(error.starts_with("to_m") && error.contains("64 tiles"), "{error}");
}

#[test]
fn an_impulse_moves_no_water_in_sum_by_walls_and_shores_either() {
    for (from_m, to_m) in [
        ([0.10, 0.09], [0.14, 0.10]),
        ([0.002, 0.09], [0.03, 0.001]),
        ([0.10, 0.09], [0.10, 0.09]),
        ([0.125, 0.09], [0.20, 0.10]),
    ] {
        let mut field = pond(Border::Wall);
        let depths: Vec<f32> = (0..64 * 48).map(|k| if k % 64 < 32 { 0.004_99 } else { 0.0 }).collect();
        if from_m[0] > 0.12 {
            field.set_depths(&depths).expect("shallow enough");
        }
        field
            .add_swept(&SweptSource {
                from_m,
                to_m,
                width_m: 0.012,
                push: Push::Impulse(4e-4),
            })
            .expect("finite");
        // Less than the steps after which the mean is set right.
        field.step(40);
        let moved: f64 = field.heights().iter().map(|u| f64::from(u.abs())).sum();
        assert!(
            moved > 1e-4 && total(&field).abs() < 1e-3 * moved,
            "{from_m:?}: {} of {moved}",
            total(&field)
        );
    }
}

#[test]
fn a_fast_wheel_leaves_an_unbroken_trail() {
    // 12.5 m/s, 60 frames a second, a tyre 0.2 m wide: swept, the trail's ridge is even; points leave beads.
    let mut swept = started(&settings(200, 40, 0.5), |_, _| 0.0);
    let mut beads = swept.clone();
    for frame in 0..5 {
        let [from, to] = [20.0 + 30.0 * frame as f32, 50.0 + 30.0 * frame as f32];
        let source = SweptSource {
            from_m: [from, 20.0],
            to_m: [to, 20.0],
            width_m: 3.0,
            push: Push::Height(1.0),
        };
        swept.add_swept(&source).expect("finite");
        let point = SweptSource {
            from_m: source.to_m,
            ..source
        };
        beads.add_swept(&point).expect("finite");
    }
    let ripple = |field: &WaveField| {
        let row = &field.heights()[20 * 200 + 55..20 * 200 + 135];
        let (low, high) = row
            .iter()
            .fold((f32::INFINITY, 0.0_f32), |(low, high), u| (low.min(*u), high.max(*u)));
        low / high
    };
    assert!(
        ripple(&swept) > 0.999 && ripple(&beads) < 0.01,
        "{} and {}",
        ripple(&swept),
        ripple(&beads)
    );
}

#[test]
fn the_wake_of_a_source_faster_than_its_waves_is_a_wedge() {
    // asin(c/v): 26.28° at 0.5 m/s on 5 mm.
    let c = 0.2214_f64;
    for (speed, angle) in [(0.5, 26.28), (1.0, 12.79), (5.0, 2.54), (10.0, 1.27)] {
        assert!(((c / speed).asin().to_degrees() - angle).abs() < 5.1e-3);
    }
    // In cells: v = 2.26 c for 90 cells of way, ridge on the Mach line.
    let mut field = started(&settings(160, 121, 0.5), |_, _| 0.0);
    let speed = 0.5 / c;
    for frame in 0..200 {
        let [from, to] = [frame, frame + 1].map(|k| (20.0 + 0.25 * speed * f64::from(k)) as f32);
        let source = SweptSource {
            from_m: [from, 60.5],
            to_m: [to, 60.5],
            width_m: 2.0,
            push: Push::Height(0.1),
        };
        field.add_swept(&source).expect("finite");
        // Steps of 0.5 s, frames of a quarter: two frames a step.
        if frame % 2 == 1 {
            field.step(1);
        }
    }
    let front = 20.0 + 0.25 * speed * 200.0;
    let across = |i: usize| {
        let column = |j: usize| field.heights()[j * 160 + i];
        (61..121)
            .max_by(|a, b| column(*a).total_cmp(&column(*b)))
            .expect("cells") as f64
            - 60.0
    };
    let behind = |i: usize| front - (i as f64 + 0.5);
    let angle = ((across(60) - across(90)) / (behind(60) - behind(90)))
        .atan()
        .to_degrees();
    assert!((angle - 26.28).abs() < 3.0, "{angle}");
}

proptest! {
    #![proptest_config(cases(128))]
    #[test]
    fn swept_weights_add_up_along_the_way(
        x in -0.2_f64..0.3, z in -0.2_f64..0.2, bx in -0.2_f64..0.2, bz in -0.2_f64..0.2, t in 0.0_f64..1.0,
    ) {
        let (a, b, p, s) = ([0.0, 0.0], [bx, bz], [x, z], 0.03);
        let cut = [t * bx, t * bz];
        let whole = swept_weight(p, a, b, s);
        let parts = t * swept_weight(p, a, cut, s) + (1.0 - t) * swept_weight(p, cut, b, s);
        prop_assert!((whole - parts).abs() < 1e-13, "{whole} and {parts}");
        prop_assert!((0.0..=1.0 + 1e-14).contains(&whole));
        // Back and forth is the same.
        prop_assert!((swept_weight(p, b, a, s) - whole).abs() < 1e-13);
    }
}
