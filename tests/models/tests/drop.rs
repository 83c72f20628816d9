//! Shape and oscillation of a drop.

mod formulas;

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rain_core::rainfall::{
    DropOutline, Oscillation, Spheroid, axis_ratio, axis_ratio_f32, drop_mass_kg, drop_volume_mm3, mode_decay_s,
    mode_frequency_hz, oscillating_radius_f32, phase_turns, sustained_amplitude,
};
use rain_reference::drop as reference;

use crate::check::Worst;

const NOT_NUMBERS: [f64; 3] = [f64::NAN, f64::NEG_INFINITY, -1.0];

fn config() -> ProptestConfig {
    ProptestConfig {
        cases: 128,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(6),
        ..ProptestConfig::default()
    }
}

fn angles(count: u32) -> impl Iterator<Item = f64> {
    (0..=count).map(move |i| core::f64::consts::PI * f64::from(i) / f64::from(count))
}

#[test]
fn axis_ratios_match_the_published_values() {
    for (d, ratio) in [
        (0.5, 0.9990),
        (1.0, 0.9826),
        (2.0, 0.9276),
        (3.0, 0.8558),
        (4.0, 0.7793),
        (5.0, 0.7061),
        (6.0, 0.6401),
    ] {
        assert!((axis_ratio(d) - ratio).abs() < 6e-5, "{d} mm: {}", axis_ratio(d));
    }
    assert_eq!(axis_ratio(0.4529), 1.0);
    assert!(axis_ratio(0.4531) < 1.0);
}

#[test]
fn axis_ratio_falls_and_stays_a_ratio() {
    let mut worst = Worst::default();
    let mut last = 1.0;
    for i in 0..=8000 {
        let d = f64::from(i) * 1e-3;
        let ratio = axis_ratio(d);
        assert!(ratio <= last && ratio > 0.5, "{d}");
        last = ratio;
        let clamped = d.min(7.0);
        let printed = 1.0048 + 5.7e-4 * clamped - 0.02628 * clamped.powi(2) + 0.003682 * clamped.powi(3)
            - 1.677e-4 * clamped.powi(4);
        worst.absolute(ratio, printed.min(1.0), || format!("{d} mm"));
        assert!(
            (f64::from(axis_ratio_f32(d as f32)) - axis_ratio(f64::from(d as f32))).abs() < 3e-7,
            "{d}"
        );
    }
    worst.assert_below(1e-15, 8000);
    for bad in NOT_NUMBERS {
        assert_eq!(axis_ratio(bad), 1.0);
        assert_eq!(axis_ratio_f32(bad as f32), 1.0);
    }
    assert_eq!(axis_ratio(f64::INFINITY), axis_ratio(7.0));
}

#[test]
fn spheroids_keep_volume_and_axis_ratio() {
    let mut worst = Worst::default();
    for d in [1e-3, 0.3, 1.0, 2.5, 4.0, 6.0, 9.0, 1e3] {
        let s = Spheroid::of_drop(d);
        let volume = 4.0 / 3.0 * core::f64::consts::PI * s.horizontal_mm.powi(2) * s.vertical_mm;
        worst.relative(volume, drop_volume_mm3(d), 1e-30, || format!("{d} mm"));
        worst.relative(s.vertical_mm / s.horizontal_mm, axis_ratio(d), 1e-30, || {
            format!("ratio, {d} mm")
        });
        for theta in angles(40) {
            // On the surface (x/a)² + (y/b)² = 1.
            let r = s.radius_mm(theta.cos());
            let on = (r * theta.sin() / s.horizontal_mm).powi(2) + (r * theta.cos() / s.vertical_mm).powi(2);
            worst.absolute(on, 1.0, || format!("{d} mm at {theta}"));
        }
    }
    worst.assert_below(2e-15, 300);
    assert!((drop_volume_mm3(2.0) - 4.188_790_204_786_39).abs() < 1e-14);
    assert!((drop_mass_kg(2.0) - 4.181_250_382e-6).abs() < 1e-14);
    for bad in NOT_NUMBERS {
        assert_eq!(drop_volume_mm3(bad), 0.0);
        assert_eq!(drop_mass_kg(bad), 0.0);
        let none = Spheroid::of_drop(bad);
        assert!(none.horizontal_mm == 0.0 && none.vertical_mm == 0.0 && none.radius_mm(bad) == 0.0);
    }
    assert!(drop_volume_mm3(f64::INFINITY).is_finite());
    assert!(Spheroid::of_drop(f64::INFINITY).radius_mm(f64::NAN).is_finite());
}

#[test]
fn the_table_is_self_consistent_and_has_the_published_axis_ratios() {
    let published = [
        (0.99999, 0.92745),
        (1.00007, 0.89167),
        (1.00005, 0.85324),
        (1.00014, 0.81436),
        (1.00004, 0.77742),
        (1.00012, 0.74178),
        (0.99999, 0.70696),
        (1.00028, 0.67345),
        (1.00031, 0.64190),
    ];
    for ((d, _), (volume, ratio)) in reference::CHUANG.iter().zip(published) {
        let terms = reference::cosine_terms(*d);
        let raw = |theta: f64| reference::printed_radius(&terms, theta);
        assert!(
            (reference::volume(raw) - volume).abs() < 6e-6,
            "{d} mm: {}",
            reference::volume(raw)
        );
        let outline = DropOutline::new(*d);
        let ours = reference::axis_ratio(|theta| outline.radius(theta.cos()));
        assert!((ours - ratio).abs() < 6e-6, "{d} mm: {ours}");
        assert!((ours - axis_ratio(*d)).abs() < 3.5e-3, "{d} mm: table and fit");
    }
    for (d, ratio) in [(1.0, 0.98159), (1.5, 0.95883)] {
        let outline = DropOutline::new(d);
        let ours = reference::axis_ratio(|theta| outline.radius(theta.cos()));
        assert!((ours - ratio).abs() < 6e-6, "{d} mm: {ours}");
    }
}

#[test]
fn outlines_are_the_slow_sum_at_the_exact_volume() {
    let (mut double, mut single, mut volume) = (Worst::default(), Worst::default(), Worst::default());
    for d in [0.0, 0.2, 1.0, 1.9, 2.0, 2.2, 3.0, 3.77, 4.5, 5.9, 6.0, 8.0] {
        let outline = DropOutline::new(d);
        let slow = reference::scaled_radius(d);
        for theta in angles(60) {
            let place = || format!("{d} mm at {theta}");
            double.absolute(outline.radius(theta.cos()), slow(theta), place);
            single.absolute(f64::from(outline.radius_f32(theta.cos() as f32)), slow(theta), place);
        }
        volume.absolute(reference::volume(|theta| outline.radius(theta.cos())), 1.0, || {
            format!("{d} mm")
        });
    }
    // The reference's volume is a sum over 800 angles, good to 1e-12.
    double.assert_below(1e-12, 700);
    single.assert_below(6e-7, 700);
    volume.assert_below(1e-11, 12);

    // Against the definition with the outline's own coefficients only rounding is left.
    let outline = DropOutline::new(4.3);
    let mut exact = Worst::default();
    for theta in angles(100) {
        let sum: f64 = outline
            .coefficients()
            .iter()
            .enumerate()
            .map(|(n, a)| a * (n as f64 * theta).cos())
            .sum();
        exact.absolute(outline.radius(theta.cos()), sum, || format!("{theta}"));
    }
    exact.assert_below(1e-14, 101);

    let wrong = DropOutline::new(4.3 * 1.05);
    assert!(
        (wrong.radius(1.0) - reference::scaled_radius(4.3)(0.0)).abs() > 1e-3,
        "5 % of the size goes unseen"
    );
}

#[test]
fn a_drop_is_flat_below() {
    let outline = DropOutline::new(5.0);
    // Nearer to the origin below than above, and less curved there.
    assert!(outline.radius(1.0) < outline.radius(-1.0));
    let bend = |sign: f64| {
        let theta: f64 = 0.1;
        (outline.point_mm(sign).y - outline.point_mm(sign * theta.cos()).y).abs()
    };
    assert!(bend(1.0) < 0.6 * bend(-1.0), "{} {}", bend(1.0), bend(-1.0));
}

#[test]
fn normals_are_the_slopes_of_the_outline() {
    let (mut double, mut single) = (Worst::default(), Worst::default());
    for d in [0.5, 1.5, 3.0, 4.4, 6.0] {
        let outline = DropOutline::new(d);
        let slow = reference::scaled_radius(d);
        for theta in angles(50).filter(|t| *t > 0.0 && *t < 3.1) {
            let [x, y] = reference::normal(&slow, theta);
            let normal = outline.normal(theta.cos());
            let place = || format!("{d} mm at {theta}");
            double.absolute(normal.x, x, place);
            double.absolute(normal.y, y, place);
            let fast = outline.normal_f32(theta.cos() as f32);
            single.absolute(f64::from(fast.x), normal.x, place);
            single.absolute(f64::from(fast.y), normal.y, place);
        }
        assert!(outline.normal(1.0).y < -1.0 + 1e-12 && outline.normal(-1.0).y > 1.0 - 1e-12);
    }
    double.assert_below(1e-10, 400);
    single.assert_below(1e-6, 400);
}

#[test]
fn outlines_answer_every_number() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 1e300] {
        let outline = DropOutline::new(bad);
        assert!(outline.radius(bad).is_finite() && outline.radius_f32(bad as f32).is_finite());
        assert!(outline.normal(bad).is_finite() && outline.normal_f32(bad as f32).is_finite());
        assert!(outline.point_mm(bad).is_finite());
        assert!(outline.deformed([bad, bad]).radius(0.3).is_finite());
    }
    assert_eq!(DropOutline::new(f64::NAN).radius(0.5), 1.0);
    assert_eq!(DropOutline::new(3.0).diameter_mm(), 3.0);
}

#[test]
fn modes_match_the_published_values() {
    let table = [
        (0.5, 972.55, 1883.3, 0.0125),
        (1.0, 343.85, 665.86, 0.0498),
        (1.5, 187.17, 362.45, 0.1121),
        (2.0, 121.57, 235.42, 0.1992),
        (3.0, 66.17, 128.14, 0.4482),
        (4.0, 42.98, 83.23, 0.7968),
        (5.0, 30.75, 59.56, 1.245),
    ];
    for (d, second, third, decay) in table {
        assert!(
            (mode_frequency_hz(2, d) - second).abs() < 6e-3,
            "{d}: {}",
            mode_frequency_hz(2, d)
        );
        assert!(
            (mode_frequency_hz(3, d) - third).abs() < 6e-2,
            "{d}: {}",
            mode_frequency_hz(3, d)
        );
        assert!(
            (mode_decay_s(2, d) - decay).abs() < 6e-5 * decay.max(1.0) + 5e-5,
            "{d}: {}",
            mode_decay_s(2, d)
        );
    }
    let mut worst = Worst::default();
    for d in [0.05, 0.5, 2.0, 7.0] {
        for n in 2..12 {
            let nf = f64::from(n);
            worst.relative(
                mode_frequency_hz(n, d),
                reference::mode_frequency(nf, d * 1e-3),
                1e-30,
                || format!("{d} {n}"),
            );
            worst.relative(mode_decay_s(n, d), reference::mode_decay(nf, d * 1e-3), 1e-30, || {
                format!("{d} {n}")
            });
            assert!(
                mode_frequency_hz(n + 1, d) > mode_frequency_hz(n, d) && mode_decay_s(n + 1, d) < mode_decay_s(n, d)
            );
        }
    }
    worst.assert_below(1e-14, 80);
    assert_eq!(mode_frequency_hz(0, 2.0), 0.0);
    assert_eq!(mode_frequency_hz(1, 2.0), 0.0);
    for bad in [f64::NAN, f64::INFINITY, -1.0, 0.0] {
        assert!(mode_frequency_hz(u32::MAX, bad).is_finite() && mode_decay_s(0, bad).is_finite());
        assert!((0.0..=0.15).contains(&sustained_amplitude(bad)));
    }
}

#[test]
fn phases_outlive_a_day_where_single_precision_does_not() {
    let f = mode_frequency_hz(2, 1.0);
    // The published loss of an f32 clock: 0.26 rad after 1 h, 8.4 rad after 24 h, from half its spacing.
    let single_loss = |time: f32| core::f64::consts::TAU * f * 0.5 * f64::from(time.next_up() - time);
    assert!((single_loss(3600.0) - 0.26).abs() < 0.01 && (single_loss(86_400.0) - 8.4).abs() < 0.1);
    // Ticks of a day against one step.
    let mut drop = Oscillation::sustained(1.0, 0.25);
    for _ in 0..86_400 {
        drop.advance(1.0);
    }
    let at_once = phase_turns(f, 86_400.0, 0.25);
    let off = (drop.turns()[0] - at_once).abs();
    assert!(off.min(1.0 - off) < 1e-7, "{off}");
    for bad in [f64::NAN, f64::INFINITY] {
        assert_eq!(phase_turns(bad, 1.0, 0.0), 0.0);
        let mut other = drop;
        other.advance(bad);
        assert_eq!(other, drop);
    }
}

#[test]
fn released_drops_calm_down_and_big_ones_keep_swinging() {
    let mut drop = Oscillation::released(2.0, 0.0, [0.3, 0.2]);
    let decay = mode_decay_s(3, 2.0);
    drop.advance(decay);
    assert!((drop.amplitudes()[1] - 0.2 / core::f64::consts::E).abs() < 1e-14);
    drop.advance(100.0);
    assert!((drop.amplitudes()[0] - sustained_amplitude(2.0)).abs() < 1e-14 && drop.amplitudes()[1] < 1e-14);
    assert_eq!(sustained_amplitude(1.0), 0.0);
    assert_eq!(sustained_amplitude(5.0), 0.15);
    let odd = Oscillation::released(f64::NAN, f64::NAN, [f64::NAN, 9.0]);
    assert_eq!(odd.amplitudes(), [0.0, 0.4]);
    assert!(odd.deflections().iter().all(|d| d.is_finite()));
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn swinging_keeps_the_volume(d in 0.1_f64..8.0, second in -0.4_f64..0.4, third in -0.4_f64..0.4) {
        let base = DropOutline::new(d);
        let bent = base.deformed([second, third]);
        prop_assert!((reference::volume(|theta| bent.radius(theta.cos())) - 1.0).abs() < 1e-9);
        // The shape is the sum of both up to one factor.
        let sum = |x: f64| base.radius(x) + second * reference::legendre(2, x) + third * reference::legendre(3, x);
        let scale = bent.radius(0.3) / sum(0.3);
        for x in [-1.0, -0.4, 0.0, 0.7, 1.0] {
            prop_assert!((bent.radius(x) - scale * sum(x)).abs() < 1e-14);
        }
    }

    #[test]
    fn advancing_in_pieces_changes_nothing(d in 0.2_f64..7.0, start in 0.0_f64..1.0, dt in 1e-4_f64..1.0, share in 0.0_f64..1.0) {
        let mut whole = Oscillation::released(d, start, [0.1, 0.05]);
        let mut cut = whole;
        whole.advance(dt);
        cut.advance(dt * share);
        cut.advance(dt * (1.0 - share));
        for i in 0..2 {
            let off = (whole.turns()[i] - cut.turns()[i]).abs();
            prop_assert!(off.min(1.0 - off) < 1e-9 && (0.0..1.0).contains(&cut.turns()[i]));
            prop_assert!((whole.amplitudes()[i] - cut.amplitudes()[i]).abs() < 1e-14);
        }
        let outline = whole.outline(&DropOutline::new(d));
        prop_assert!((reference::volume(|theta| outline.radius(theta.cos())) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn the_cheap_swing_keeps_volume_to_second_order(delta in -0.4_f32..0.4, x in -1.0_f32..1.0) {
        let d = f64::from(delta);
        let exact = 1.0 - 0.2 * d * d + d * reference::legendre(2, f64::from(x));
        prop_assert!((f64::from(oscillating_radius_f32(delta, x)) - exact).abs() < 3e-7);
        let volume = reference::volume(|theta| 1.0 - 0.2 * d * d + d * reference::legendre(2, theta.cos()));
        prop_assert!((volume - 1.0).abs() < 0.06 * d.abs().powi(3) + 0.12 * d.powi(4) + 1e-9, "{} {}", volume - 1.0, d);
    }
}

#[test]
fn the_cheap_swing_answers_every_number() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert!(oscillating_radius_f32(bad, bad).is_finite());
    }
    for (delta, bound) in [(0.4, 6.5e-3), (0.2, 7e-4), (0.1, 7e-5)] {
        let volume = reference::volume(|theta| 1.0 - 0.2 * delta * delta + delta * reference::legendre(2, theta.cos()));
        assert!((volume - 1.0).abs() < bound, "{delta}: {}", volume - 1.0);
    }
}

#[test]
fn the_spheroid_misses_the_flat_base_by_what_is_published() {
    let d = 4.0;
    let (outline, spheroid) = (DropOutline::new(d), Spheroid::of_drop(d));
    let (mut worst, mut square, mut count) = (0.0_f64, 0.0, 0.0);
    for theta in angles(400) {
        let off = outline.radius(theta.cos()) - spheroid.radius_mm(theta.cos()) / (0.5 * d);
        worst = worst.max(off.abs());
        square += off * off;
        count += 1.0;
    }
    assert!(worst < 0.055 && worst > 0.03, "{worst}");
    assert!((square / count).sqrt() < 0.03, "{}", (square / count).sqrt());
}
