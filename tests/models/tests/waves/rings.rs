//! Rings without a grid and the roughness of far water.

use proptest::prelude::*;
use rain_core::rainfall::{Distribution, DropSizes, Spectrum, terminal_velocity};
use rain_core::waves::{
    DropImpact, Ring, RingTable, WaveField, WaveSettings, impact_slope_variance, rain_slope_variance, slope_variance,
};
use rain_reference::waves as truth;

use super::super::check::Worst;
use super::cases;

const TWO_MM: DropImpact = DropImpact {
    x_m: 0.0,
    z_m: 0.0,
    diameter_mm: 2.0,
    speed_m_s: 6.5,
};

#[test]
fn the_packet_is_its_integral() {
    let table = RingTable::new();
    let mut worst = Worst::default();
    for i in -400..=100 {
        // Off the table's points, and far behind it.
        let x = 0.07 * f64::from(i) + 0.013;
        let exact = truth::packet(f64::from(x as f32));
        for (column, (value, exact)) in table.packet(x as f32).into_iter().zip(exact).enumerate() {
            worst.absolute(f64::from(value), exact, || format!("x {x}, column {column}"));
        }
    }
    worst.assert_below(3e-6, 2000);
    assert!(
        truth::packet(1.05)[1] - truth::packet(1.0)[1] < -1e-3,
        "a shift by 5 % would be seen"
    );
    for x in [f32::NAN, f32::INFINITY, 1e30] {
        assert_eq!(table.packet(x), [0.0; 4]);
    }
    for x in [f32::NEG_INFINITY, -1e30, -16.0, -16.000_1, 6.999_9, 7.0] {
        assert!(table.packet(x).iter().all(|value| value.is_finite()));
    }
}

/// The exact height of a ring at r and t.
fn exact(ring: &Ring, r: f64, t: f64, panels: usize) -> f64 {
    let [s, c, bump, push] = [ring.width_m, ring.speed_m_s, ring.bump_m, ring.push_m].map(f64::from);
    truth::hankel(r, s, panels, |k| {
        bump * (c * k * t).cos() - push * s * k * (c * k * t).sin()
    }) * (-f64::from(ring.decay_per_s) * t).exp()
}

#[test]
fn rings_follow_the_integral() {
    let table = RingTable::new();
    let ring = Ring::new(&TWO_MM, 0.005, 0.6).expect("within its domain");
    let (s, c) = (f64::from(ring.width_m), f64::from(ring.speed_m_s));
    for ring in [ring, Ring { push_m: 0.0, ..ring }, Ring { bump_m: 0.0, ..ring }] {
        for age in [5.0, 10.0, 40.0] {
            let t = age * s / c;
            let radii: Vec<f64> = (0..40)
                .map(|i| s * (age + 0.2 * f64::from(i - 15)))
                .filter(|r| *r >= 5.0 * s)
                .collect();
            let heights: Vec<f64> = radii.iter().map(|r| exact(&ring, *r, t, 400)).collect();
            let crest = heights.iter().fold(0.0_f64, |max, u| max.max(u.abs()));
            let [mut height, mut slope] = [Worst::default(), Worst::default()];
            let d = 1e-3 * s;
            for (r, u) in radii.iter().zip(&heights) {
                let (value, steep) = table.height_and_slope(&ring, *r as f32, t as f32);
                height.absolute(f64::from(value) / crest, u / crest, || {
                    format!("age {age}, r {}", r / s)
                });
                let rise = (exact(&ring, r + d, t, 400) - exact(&ring, r - d, t, 400)) / (2.0 * d);
                slope.absolute(f64::from(steep) * s / crest, rise * s / crest, || {
                    format!("age {age}, r {}", r / s)
                });
            }
            // A drop's ring is made by its push; a bump alone leaves a longer tail.
            let late = ring.push_m > 0.0 && age >= 10.0;
            height.assert_below(if late { 2e-3 } else { 1e-2 }, 20);
            slope.assert_below(if late { 1e-3 } else { 7e-3 }, 20);
        }
    }
    // Published height at 0.11 m after half a second of a bump of 1 m, s = 10 mm.
    let bump = Ring {
        bump_m: 1.0,
        push_m: 0.0,
        width_m: 0.01,
        speed_m_s: 0.221_431_3,
        decay_per_s: 0.0,
    };
    for (r, height) in [(0.10, -0.032_562), (0.11, 0.078_712), (0.13, 0.030_704)] {
        let value = f64::from(table.height_and_slope(&bump, r, 0.5).0);
        assert!((value - height).abs() < 4e-3 * 0.0924, "{value} is not {height}");
    }
}

#[test]
fn crests_fall_with_the_root_of_the_distance_and_with_damping() {
    let table = RingTable::new();
    let ring = Ring::new(&TWO_MM, 0.005, 0.0).expect("within its domain");
    let crest = |ring: &Ring, age: f32| {
        let r = |i: u16| ring.speed_m_s * age + ring.width_m * 0.01 * (f32::from(i) - 400.0);
        (0..800).fold(0.0_f32, |max, i| {
            max.max(table.height_and_slope(ring, r(i), age).0.abs())
        })
    };
    let ratio = crest(&ring, 4.0) / crest(&ring, 1.0);
    assert!((ratio - 0.5).abs() < 0.01, "{ratio}");
    let damped = Ring {
        decay_per_s: 0.3,
        ..ring
    };
    let ratio = crest(&damped, 2.0) / crest(&ring, 2.0);
    assert!((ratio - (-0.6_f32).exp()).abs() < 1e-4, "{ratio}");
    // A ring lives until nothing of it is steeper than what can be seen.
    let life = table.lifetime_s(&damped, 1e-3);
    let steepest = |age: f32| {
        let r = |i: u16| damped.speed_m_s * age + damped.width_m * 0.01 * (f32::from(i) - 400.0);
        (0..800).fold(0.0_f32, |max, i| {
            max.max(table.height_and_slope(&damped, r(i), age).1.abs())
        })
    };
    assert!(
        life > 0.1 && life < 1e3 && steepest(life) <= 1e-3 && steepest(0.5 * life) > 1e-3,
        "{life}"
    );
    assert_eq!(table.lifetime_s(&damped, f32::INFINITY), 0.0);
    for none in [0.0, -1.0, f32::NAN] {
        assert!(table.lifetime_s(&damped, none) == 1e3);
    }
}

#[test]
fn rings_of_nonsense_are_refused_or_flat() {
    let table = RingTable::new();
    let ring = Ring::new(&TWO_MM, 0.005, 0.6).expect("within its domain");
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert_eq!(table.height_and_slope(&ring, bad, 0.1), (0.0, 0.0));
        assert_eq!(table.height_and_slope(&ring, 0.1, bad), (0.0, 0.0));
    }
    for r in [-1.0, 0.0, 1e-30, 1e30] {
        for age in [-1.0, 0.0, 1e-30, 1e30] {
            let (height, slope) = table.height_and_slope(&ring, r, age);
            assert!(height.is_finite() && slope.is_finite(), "{r} {age}");
        }
    }
    for (name, result) in [
        ("depth_m", Ring::new(&TWO_MM, 0.0, 0.6)),
        ("depth_m", Ring::new(&TWO_MM, f64::NAN, 0.6)),
        ("damping_per_s", Ring::new(&TWO_MM, 0.005, -1.0)),
        (
            "diameter_mm",
            Ring::new(
                &DropImpact {
                    diameter_mm: f64::NAN,
                    ..TWO_MM
                },
                0.005,
                0.6,
            ),
        ),
    ] {
        assert!(result.expect_err(name).to_string().starts_with(name));
    }
    let nothing = Ring::new(
        &DropImpact {
            diameter_mm: 0.0,
            speed_m_s: 0.0,
            ..TWO_MM
        },
        0.005,
        0.6,
    )
    .expect("no drop");
    assert_eq!(table.height_and_slope(&nothing, 0.1, 0.1), (0.0, 0.0));
}

#[test]
fn one_impact_roughens_as_the_double_integral_says() {
    let mut worst = Worst::default();
    for (diameter, depth, damping) in [
        (1.0, 0.005, 0.6),
        (2.0, 0.005, 5.0),
        (3.0, 0.02, 2.0),
        (5.0, 0.002, 3.0),
    ] {
        let impact = DropImpact {
            diameter_mm: diameter,
            speed_m_s: terminal_velocity(diameter),
            ..TWO_MM
        };
        let s = impact.width_m(0.0, depth);
        let exact = truth::slope_integral(impact.momentum(), impact.volume_m3(), s, depth, damping);
        worst.relative(impact_slope_variance(&impact, s, depth, damping), exact, 0.0, || {
            format!("{diameter} mm")
        });
        let wrong = impact_slope_variance(&impact, 1.1 * s, depth, damping);
        assert!(
            (wrong / exact - 1.0).abs() > 0.04,
            "{diameter} mm, s {s}: {wrong}, exact {exact}, {worst:?}"
        );
    }
    worst.assert_below(1e-6, 4);
}

#[test]
fn far_water_is_as_rough_as_the_field_would_be() {
    // One drop in a field: Σ|∇u|² dx² dt until it has died down.
    let (cells, cell) = (96_u32, 0.002);
    let mut field = WaveField::new(&WaveSettings {
        cells_x: cells,
        cells_z: cells,
        cell_m: cell,
        speed_m_s: 0.221_431_3,
        damping_per_s: 12.0,
        ..WaveSettings::default()
    })
    .expect("within the domains");
    let middle = 0.5 * f64::from(cells) * cell;
    let impact = DropImpact {
        x_m: middle,
        z_m: middle,
        diameter_mm: 4.0,
        speed_m_s: 8.83,
    };
    let depth = 0.221_431_3_f64.powi(2) / 9.80665;
    let s = impact.width_m(cell, depth);
    assert!(s > 4.0 * cell);
    field.add_drop(&impact).expect("finite");
    field.take_volume_m3();
    let mut slopes = vec![[0.0_f32; 2]; (cells * cells) as usize];
    let mut sum = 0.0;
    for _ in 0..200 {
        field.step(1);
        field.write_slopes(&mut slopes);
        let squares: f64 = slopes.iter().map(|[x, z]| f64::from(x * x + z * z)).sum();
        sum += squares * cell * cell * field.step_s();
    }
    let expected = impact_slope_variance(&impact, s, depth, 12.0);
    assert!((sum / expected - 1.0).abs() < 0.05, "{sum} is not {expected}");
}

#[test]
fn roughness_of_a_rain_is_the_sum_over_its_drops() {
    for (rate, cell) in [(1.0, 0.0), (25.0, 0.0), (25.0, 0.01), (100.0, 0.004)] {
        let rain = Spectrum::new(Distribution::MarshallPalmer, rate).expect("a rain");
        let step = 8.0 / 100_000.0;
        let sum: f64 = (0..100_000)
            .map(|i| {
                let d = (f64::from(i) + 0.5) * step;
                let impact = DropImpact {
                    diameter_mm: d,
                    speed_m_s: terminal_velocity(d),
                    ..TWO_MM
                };
                let width = impact.width_m(cell, 0.005);
                rain.concentration(d) * impact.speed_m_s * step * impact_slope_variance(&impact, width, 0.005, 0.6)
            })
            .sum();
        let value = slope_variance(&rain, 0.005, 0.6, cell);
        assert!(
            (value / sum - 1.0).abs() < 5e-4,
            "{rate} mm/h, cell {cell}: {value} is not {sum}"
        );
        let by_sizes = rain_slope_variance(&DropSizes::from(rain), 0.005, 0.6, cell);
        assert!(
            (by_sizes / value - 1.0).abs() < 2e-3,
            "{rate} mm/h, cell {cell}: {by_sizes} is not {value}"
        );
    }
    let dry = Spectrum::new(Distribution::MarshallPalmer, 0.0).expect("dry");
    assert_eq!(slope_variance(&dry, 0.005, 0.6, 0.0), 0.0);
    let rain = Spectrum::new(Distribution::MarshallPalmer, 25.0).expect("a rain");
    for bad in [f64::NAN, f64::INFINITY, -1.0, 0.0, 1e300] {
        for value in [
            slope_variance(&rain, bad, 0.6, 0.0),
            slope_variance(&rain, 0.005, bad, 0.0),
            slope_variance(&rain, 0.005, 0.6, bad),
            impact_slope_variance(&TWO_MM, bad, 0.005, 0.6),
            impact_slope_variance(
                &DropImpact {
                    speed_m_s: bad,
                    ..TWO_MM
                },
                0.01,
                0.005,
                0.6,
            ),
        ] {
            assert!(value.is_finite() && value >= 0.0, "{bad}: {value}");
        }
    }
}

proptest! {
    #![proptest_config(cases(128))]
    #[test]
    fn heavier_rain_and_less_damping_are_rougher(
        rate in 0.1_f64..200.0, depth in 1e-3_f64..0.05, damping in 0.1_f64..3.0, more in 1.05_f64..2.0,
    ) {
        let rain = |rate: f64| Spectrum::new(Distribution::MarshallPalmer, rate).expect("a rain");
        let base = slope_variance(&rain(rate), depth, damping, 0.0);
        prop_assert!(base > 0.0);
        prop_assert!(slope_variance(&rain(rate * more), depth, damping, 0.0) > base);
        prop_assert!(slope_variance(&rain(rate), depth, damping * more, 0.0) < base);
        prop_assert!(slope_variance(&rain(rate), depth, damping, 0.02) <= base);
    }
}
