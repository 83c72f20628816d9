//! Where, how large and how often it drips.

use proptest::prelude::*;
use rain_core::canopy::{
    DRIP_BIN_MM, DRIP_BINS, DRIP_MAX_MM, DRIP_MIN_MM, DRIP_VOLUME_SHARES, DripClock, DripPlan, DripSizes, LeafType,
    RADIAL_DISTANCES_M, RADIAL_SHARES, RADIAL_THICKNESSES_M, crown_place, drip_crest, drip_distance_m,
    drip_distance_m_f32, drip_fall_time_s, drip_fall_time_s_f32, drip_flow_m3_s, drip_frequency_hz, drip_period_s,
    drop_volume_m3, gaussian_drip_share, nearest_drip, nearest_drip_f32, radial_class, radial_shares,
};
use rain_reference::canopy as reference;

use crate::check::Worst;

const BAD: [f64; 6] = [f64::NAN, f64::NEG_INFINITY, -1.0, 0.0, 1e300, f64::INFINITY];

#[test]
fn tables_are_the_published_ones_and_sum_to_one() {
    for (bin, (middle, shares)) in reference::DRIP_HUNDREDTHS.iter().enumerate() {
        assert!((middle - (DRIP_MIN_MM + DRIP_BIN_MM * (bin as f64 + 0.5))).abs() < 1e-12);
        for leaf in 0..3 {
            assert_eq!(DRIP_VOLUME_SHARES[leaf][bin], f64::from(shares[leaf]) / 100.0);
        }
    }
    for row in DRIP_VOLUME_SHARES {
        assert!((row.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    }
    for (thickness, shares) in reference::RADIAL_HUNDREDTHS {
        let row = RADIAL_THICKNESSES_M
            .iter()
            .position(|&t| t == thickness)
            .expect("a row");
        for class in 0..4 {
            assert_eq!(RADIAL_SHARES[row][class], f64::from(shares[class]) / 100.0);
            assert!((radial_shares(thickness)[class] - f64::from(shares[class]) / 100.0).abs() < 1e-12);
        }
        // More towards the edge, save close to the trunk.
        assert!(shares[0] > shares[1] && shares[2] > shares[1]);
    }
}

#[test]
fn gaussian_fits_have_the_published_values_and_do_not_sum_to_one() {
    for (leaf, values) in LeafType::ALL.into_iter().zip([
        [0.10224, 0.16762, 0.13562],
        [0.00907, 0.09402, 0.23620],
        [0.03011, 0.35950, 0.07863],
    ]) {
        for (diameter, value) in [3.25, 4.25, 5.25].into_iter().zip(values) {
            assert!((gaussian_drip_share(leaf, diameter) - value).abs() < 6e-6);
        }
    }
    // Over the 14 class middles, and the numbers that the normalised fit makes.
    for (leaf, (sum, mean, litre)) in [
        (1.0111, 3.133, 40_843.0),
        (1.0098, 4.957, 14_322.0),
        (0.9274, 4.188, 24_885.0),
    ]
    .into_iter()
    .enumerate()
    {
        let kind = LeafType::ALL[leaf];
        let total: f64 = (0..DRIP_BINS)
            .map(|bin| gaussian_drip_share(kind, 1.25 + 0.5 * bin as f64))
            .sum();
        assert!((total - sum).abs() < 6e-5, "{total}");
        let sizes = DripSizes::gaussian(kind, 10_000);
        assert!(
            (sizes.number_mean_mm() - mean).abs() < 6e-4,
            "{}",
            sizes.number_mean_mm()
        );
        assert!(
            (sizes.drops_per_litre() / litre - 1.0).abs() < 3e-5,
            "{}",
            sizes.drops_per_litre()
        );
    }
    for bad in [f64::NAN, f64::INFINITY, -1.0, 0.99, 8.0] {
        assert_eq!(gaussian_drip_share(LeafType::NeedleCoated, bad), 0.0);
    }
}

#[test]
fn measured_sizes_have_the_published_means() {
    // Volume mean, number mean of the class middles, Σ q/D³.
    for (leaf, (volume, number)) in [(4.53, 3.52), (5.08, 3.90), (4.15, 3.54)].into_iter().enumerate() {
        let sizes = DripSizes::measured(LeafType::ALL[leaf]);
        assert_eq!(sizes.classes(), DRIP_BINS);
        assert!(
            (sizes.volume_mean_mm() - volume).abs() < 6e-3,
            "{}",
            sizes.volume_mean_mm()
        );
        // The published one puts each class at its middle; numbers within a class fall by D⁻³.
        assert!(
            (sizes.number_mean_mm() / number - 1.0).abs() < 0.015,
            "{}",
            sizes.number_mean_mm()
        );
    }
}

#[test]
fn drawn_diameters_are_the_quantiles_of_volume_and_number() {
    let (mut volume, mut number, mut single, mut fit) =
        (Worst::default(), Worst::default(), Worst::default(), Worst::default());
    let mut moments = Worst::default();
    for leaf in 0..3 {
        let measured = DripSizes::measured(LeafType::ALL[leaf]);
        let gaussian = DripSizes::gaussian(LeafType::ALL[leaf], 140);
        let table = |d: f64| reference::drip_volume_density(leaf, d);
        let bell = |d: f64| reference::drip_gaussian_density(leaf, d);
        let tails = [1e-4, 1e-3, 0.999, 0.9999];
        for u in (1..60).map(|i| f64::from(i) / 60.0).chain(tails) {
            let place = || format!("leaf {leaf}, u = {u}");
            let expected = reference::drip_quantile(table, 3, u);
            volume.absolute(
                measured.diameter_by_volume(u),
                reference::drip_quantile(table, 0, u),
                place,
            );
            number.absolute(measured.diameter_by_number(u), expected, place);
            let near = u as f32;
            let expected = reference::drip_quantile(table, 3, f64::from(near));
            single.absolute(f64::from(measured.diameter_by_number_f32(near)), expected, place);
            fit.absolute(
                gaussian.diameter_by_number(u),
                reference::drip_quantile(bell, 3, u),
                place,
            );
        }
        let whole = |n| reference::drip_sum(bell, n, 8.0);
        for (value, expected) in [
            (gaussian.volume_mean_mm(), whole(-1) / whole(0)),
            (gaussian.number_mean_mm(), whole(2) / whole(3)),
            (
                gaussian.drops_per_litre(),
                whole(3) / whole(0) * 6e6 / std::f64::consts::PI,
            ),
        ] {
            moments.relative(value, expected, 1e-9, || format!("leaf {leaf}"));
        }
        let measured_whole = |n| reference::drip_sum(table, n, 8.0);
        number.relative(
            measured.number_mean_mm(),
            measured_whole(2) / measured_whole(3),
            1e-9,
            || format!("mean, leaf {leaf}"),
        );
    }
    volume.assert_below(1e-9, 170);
    number.assert_below(1e-9, 170);
    single.assert_below(4e-7, 170);
    fit.assert_below(3e-3, 170);
    moments.assert_below(1e-3, 9);
}

#[test]
fn drops_drawn_by_hash_are_the_distribution() {
    let sizes = DripSizes::measured(LeafType::BroadleafCoated);
    let n = 40_000;
    let drops: Vec<f32> = (0..n).map(|i| sizes.drawn_mm(3, i, 0)).collect();
    let mean = drops.iter().map(|&d| f64::from(d)).sum::<f64>() / f64::from(n);
    assert!((mean - sizes.number_mean_mm()).abs() < 0.02, "{mean}");
    let volume = drops.iter().map(|&d| drop_volume_m3(f64::from(d))).sum::<f64>() / f64::from(n);
    assert!((volume / sizes.mean_drop_m3() - 1.0).abs() < 0.02);
    assert_eq!(sizes.drawn_mm(3, 77, 5), sizes.drawn_mm(3, 77, 5), "no hidden state");
    assert_ne!(sizes.drawn_mm(3, 77, 5), sizes.drawn_mm(3, 77, 6));
    // Drawn by volume instead, drops would be far too large.
    let by_volume = (0..1000)
        .map(|i| sizes.diameter_by_volume(f64::from(i) / 1000.0))
        .sum::<f64>()
        / 1000.0;
    assert!(by_volume - mean > 0.5);
}

#[test]
fn size_tables_hold_at_their_edges() {
    for sizes in [
        DripSizes::measured(LeafType::NeedleCoated),
        DripSizes::gaussian(LeafType::BroadleafMatte, 0),
    ] {
        for u in BAD.into_iter().chain([1.0, 1.0 - 1e-16, 5e-324]) {
            for d in [sizes.diameter_by_volume(u), sizes.diameter_by_number(u)] {
                assert!((DRIP_MIN_MM..=DRIP_MAX_MM).contains(&d), "{u}: {d}");
            }
        }
        let shares: f64 = (0..sizes.classes()).map(|class| sizes.number_share(class)).sum();
        assert!((shares - 1.0).abs() < 1e-12);
        let shares: f64 = (0..sizes.classes()).map(|class| sizes.volume_share(class)).sum();
        assert!((shares - 1.0).abs() < 1e-12);
        assert_eq!((sizes.number_share(99_999), sizes.volume_share(99_999)), (0.0, 0.0));
    }
    let measured = DripSizes::measured(LeafType::NeedleCoated);
    assert_eq!(measured.diameter_by_number(0.0), 1.5, "the first class is empty");
    assert_eq!(measured.diameter_by_number(1.0), 7.5, "and so is the last");
}

#[test]
fn flow_frequency_and_period_have_the_published_values() {
    let flow = drip_flow_m3_s(10.0, 10.0, [0.8, 0.34, 0.37]);
    assert!((flow - 2.79556e-6).abs() < 6e-12);
    let frequency = drip_frequency_hz(flow, 4.25);
    assert!((frequency - 69.551).abs() < 6e-4, "{frequency}");
    assert!(
        (frequency * drop_volume_m3(4.25) / flow - 1.0).abs() < 1e-15,
        "the flow comes back"
    );
    let period = drip_period_s(4.25, 10.0, 10.0, [0.8, 0.34, 0.37]).expect("drips");
    assert!((period - 0.014378).abs() < 6e-7);
    let point = drip_period_s(4.4, 10.0, 1e-3, [0.8, 1.0, 1.0]).expect("drips");
    assert!((point - 20.0710).abs() < 6e-5, "{point}");
    // The printed form, 6e-4 π D³/(R A q).
    let printed = 6e-4 * std::f64::consts::PI * 4.4_f64.powi(3) / (10.0 * 1e-3 * 0.8);
    assert!((point / printed - 1.0).abs() < 1e-14);
    for (leaf, drops) in LeafType::ALL.into_iter().zip([734.0, 511.0, 786.0]) {
        // 10 m² at 10 mm/h, q = 0.8: each class at its middle.
        let row = LeafType::ALL.iter().position(|&l| l == leaf).expect("listed");
        let sum: f64 = (0..DRIP_BINS)
            .map(|bin| {
                let flow = drip_flow_m3_s(10.0, 10.0, [0.8, 1.0, DRIP_VOLUME_SHARES[row][bin]]);
                drip_frequency_hz(flow, 1.25 + 0.5 * bin as f64)
            })
            .sum();
        assert!((sum - drops).abs() < 0.6, "{leaf:?}: {sum}");
    }
    for bad in BAD {
        assert!(drip_flow_m3_s(bad, bad, [bad; 3]).is_finite());
        assert!(drip_frequency_hz(bad, bad).is_finite() && drip_frequency_hz(bad, bad) >= 0.0);
        assert!(drop_volume_m3(bad).is_finite());
        assert!(drip_period_s(bad, bad, bad, [bad; 3]).is_none_or(f64::is_finite));
    }
    assert_eq!(drip_period_s(4.0, 0.0, 10.0, [1.0; 3]), None);
}

#[test]
fn places_carry_the_crowns_water_between_them() {
    let sizes = DripSizes::measured(LeafType::BroadleafMatte);
    let mut worst = Worst::default();
    for places in [1_usize, 2, 7, 300] {
        let radii: Vec<f64> = (0..places)
            .map(|i| {
                let place = crown_place(5, i as u32, 3.0, 6.0);
                place.x_m.hypot(place.z_m)
            })
            .collect();
        let plan = DripPlan::new(9, &sizes, &radii, 3.0, 6.0).expect("valid");
        assert_eq!(plan.len(), places);
        let flow = 2e-6;
        let carried: f64 = (0..places)
            .map(|i| plan.frequency_hz(i, flow) * drop_volume_m3(f64::from(plan.diameter_mm(i))))
            .sum();
        worst.relative(carried, flow, 1e-30, || format!("{places} places"));
        for i in 0..places {
            assert!((0.0..1.0).contains(&plan.phase(i)));
            assert!(plan.frequency_hz(i, f64::NAN) == 0.0 && plan.frequency_hz(i, -1.0) == 0.0);
        }
        assert_eq!((plan.diameter_mm(places), plan.frequency_hz(places, 1.0)), (0.0, 0.0));
    }
    worst.assert_below(1e-12, 4);
    assert!(DripPlan::new(1, &sizes, &[], 3.0, 6.0).is_err());
    assert!(DripPlan::new(1, &sizes, &[f64::NAN], 3.0, 6.0).is_err());
    assert!(DripPlan::new(1, &sizes, &[1.0], 0.0, 6.0).is_err());
    assert!(DripPlan::new(1, &sizes, &[1.0], 3.0, f64::INFINITY).is_err());
}

#[test]
fn counted_drops_are_the_water_at_any_step() {
    let sizes = DripSizes::measured(LeafType::BroadleafCoated);
    let radii: Vec<f64> = (0..500).map(|i| f64::from(i) * 0.004).collect();
    let plan = DripPlan::new(2, &sizes, &radii, 2.0, 5.0).expect("valid");
    let (mut coarse, mut fine) = (DripClock::default(), DripClock::default());
    coarse.advance(2e-3);
    for _ in 0..1000 {
        fine.advance(2e-6);
    }
    fine.advance(f64::NAN);
    fine.advance(-1.0);
    let (mut water, mut drops, mut differing) = (0.0, 0, 0);
    for place in 0..plan.len() {
        let start = DripClock::default().released(&plan, place);
        let (whole, fraction) = coarse.released(&plan, place);
        let gathered = (whole - start.0) as f64 + fraction - start.1;
        water += gathered * drop_volume_m3(f64::from(plan.diameter_mm(place)));
        drops += whole;
        differing += u32::from(fine.released(&plan, place).0 != whole);
        assert!((0.0..1.0).contains(&fraction));
    }
    assert!((water / 2e-3 - 1.0).abs() < 1e-9, "{water}");
    assert!(drops > 40_000 && differing <= 1, "{drops} {differing}");
    assert!((fine.dripped_m3() / coarse.dripped_m3() - 1.0).abs() < 1e-13);
}

#[test]
fn radial_shares_interpolate_and_places_follow_them() {
    let middle = radial_shares(5.3);
    for class in 0..4 {
        let mean = 0.5 * (RADIAL_SHARES[0][class] + RADIAL_SHARES[1][class]);
        assert!((middle[class] - mean).abs() < 1e-12);
    }
    for thickness in BAD.into_iter().chain([4.8, 7.8, 100.0]) {
        assert!((radial_shares(thickness).iter().sum::<f64>() - 1.0).abs() < 1e-12);
    }
    assert_eq!(radial_shares(100.0), RADIAL_SHARES[3]);
    assert_eq!(radial_shares(f64::NAN), RADIAL_SHARES[0]);
    for (class, distance) in RADIAL_DISTANCES_M.into_iter().enumerate() {
        assert_eq!(radial_class(distance, 2.0), class);
        assert_eq!(radial_class(3.0 * distance, 6.0), class);
    }
    for (radius, crown, class) in [
        (9.0, 2.0, 3),
        (1.0, 0.0, 3),
        (f64::NAN, 2.0, 0),
        (-1.0, 2.0, 0),
        (1.0, f64::NAN, 3),
    ] {
        assert_eq!(radial_class(radius, crown), class);
    }
    let n = 2000;
    let mut counts = [0_u32; 4];
    let mut centre = [0.0, 0.0];
    for index in 0..n {
        let place = crown_place(11, index, 4.0, 7.0);
        let radius = place.x_m.hypot(place.z_m);
        assert!(radius <= 4.0 + 1e-12 && (0.0..=0.2 * 7.0).contains(&place.above_branch_m));
        assert_eq!(radial_class(radius * (1.0 - 1e-9), 4.0), place.class, "{place:?}");
        counts[place.class] += 1;
        centre = [centre[0] + place.x_m, centre[1] + place.z_m];
    }
    for class in 0..4 {
        let share = f64::from(counts[class]) / f64::from(n);
        assert!(
            (share - radial_shares(7.0)[class]).abs() < 3.0 / f64::from(n),
            "{counts:?}"
        );
    }
    assert!(centre[0].hypot(centre[1]) / f64::from(n) < 0.15, "no side is preferred");
    for bad in BAD {
        let place = crown_place(1, 1, bad, bad);
        assert!(place.x_m.is_finite() && place.z_m.is_finite() && place.above_branch_m.is_finite());
    }
}

#[test]
fn fall_under_a_leaf_has_the_published_values_and_follows_runge_kutta() {
    // The published times use 9.81 m/s²: 3e-4 from ours.
    for (v, values) in [
        (
            9.21954,
            vec![
                (0.1, 0.14306),
                (1.0, 0.46026),
                (5.0, 1.10896),
                (10.0, 1.71179),
                (20.0, 2.81840),
            ],
        ),
        (6.70820, vec![(1.0, 0.46809), (5.0, 1.19914), (10.0, 1.96250)]),
    ] {
        for (d, t) in values {
            assert!((drip_fall_time_s(d, v) / t - 1.0).abs() < 4e-4, "{d}");
        }
    }
    let (mut far, mut back, mut single, mut single_time) =
        (Worst::default(), Worst::default(), Worst::default(), Worst::default());
    for v in [0.5_f64, 2.0, 4.0, 9.2] {
        for t in [1e-4_f64, 1e-2, 0.05, 0.3, 1.0, 4.0] {
            let [d, _] = reference::drip_fall(t, v, 9.80665);
            far.relative(drip_distance_m(t, v), d, 1e-12, || format!("{v} m/s, {t} s"));
        }
        for i in 0..200 {
            let d = 1e-6 * 1.13_f64.powi(i);
            let t = drip_fall_time_s(d, v);
            if d < 1e4 {
                back.relative(drip_distance_m(t, v), d, 1e-12, || format!("{d} m at {v} m/s"));
                let (d32, v32) = (d as f32, v as f32);
                let exact = drip_fall_time_s(f64::from(d32), f64::from(v32));
                single_time.relative(f64::from(drip_fall_time_s_f32(d32, v32)), exact, 1e-12, || {
                    format!("{d} {v}")
                });
                let t32 = t as f32;
                let exact = drip_distance_m(f64::from(t32), f64::from(v32));
                single.relative(f64::from(drip_distance_m_f32(t32, v32)), exact, 1e-12, || {
                    format!("{d} {v}")
                });
            }
        }
    }
    far.assert_below(1e-10, 24);
    back.assert_below(1e-13, 600);
    single_time.assert_below(4e-7, 600);
    single.assert_below(2e-6, 600);
    for bad in BAD {
        for other in BAD {
            assert!(drip_fall_time_s(bad, other).is_finite() && drip_distance_m(bad, other).is_finite());
            let (a, b) = (bad as f32, other as f32);
            assert!(drip_fall_time_s_f32(a, b).is_finite() && drip_distance_m_f32(a, b).is_finite());
        }
    }
}

#[test]
fn the_nearest_drop_falls_as_published() {
    // D = 4.25 mm at the source's 9.21954 m/s, T = 0.5 s, d = 5 m: n = 2 at t = 10.2, 10.25, 10.3 s (9.81 m/s²).
    for (t, distance) in [(10.2, 5.70670), (10.25, 6.10432), (10.3, 6.50794)] {
        let drip = nearest_drip(5.0, 0.5, t / 0.5, 9.21954).expect("drips");
        assert_eq!(drip.index, 2);
        assert!((drip.distance_m / distance - 1.0).abs() < 4e-4, "{drip:?}");
        let [exact, _] = reference::drip_fall(drip.age_s, 9.21954, 9.81);
        assert!(
            (exact - distance).abs() < 6e-6,
            "the published value is that of 9.81 m/s²"
        );
        let single = nearest_drip_f32(5.0, 0.5, (t / 0.5 % 1.0) as f32, 9.21954).expect("drips");
        assert!(single.index == 2 && (f64::from(single.distance_m) - drip.distance_m).abs() < 2e-5);
    }
    for bad in [f64::NAN, 0.0, -1.0, f64::INFINITY] {
        assert_eq!(nearest_drip(1.0, bad, 0.0, 9.0), None);
        assert_eq!(nearest_drip_f32(1.0, bad as f32, 0.0, 9.0), None);
        assert_eq!(drip_crest(1.0, bad.min(0.0), 0.3, 9.0), -1.0);
    }
    assert_eq!(nearest_drip(1.0, 1.0, f64::NAN, 9.0), None);
    for period in [5e-324, 1e-300, 1e-30, 1e-6] {
        let drip = nearest_drip(f64::INFINITY, period, 0.5, f64::NAN).expect("drips");
        assert!(drip.age_s.is_finite() && drip.distance_m.is_finite(), "{drip:?}");
        assert_eq!(drip, nearest_drip(f64::INFINITY, 1e-6, 0.5, f64::NAN).expect("drips"));
    }
    let single = nearest_drip_f32(f32::INFINITY, 1e-30, 0.5, 1e-3).expect("drips");
    assert!(single.age_s.is_finite() && single.distance_m.is_finite(), "{single:?}");
}

proptest! {
    #![proptest_config(super::fixed())]

    #[test]
    fn drops_are_the_crests_and_are_never_farther_than_half_a_period(
        distance in 0.0_f64..30.0,
        period in 0.01_f64..20.0,
        released in 0.0_f64..1e4,
        v in 4.0_f64..9.2,
    ) {
        let drip = nearest_drip(distance, period, released, v).expect("drips");
        prop_assert!((drip_crest(drip.distance_m, period, released, v) - 1.0).abs() < 1e-7);
        let away = (drip_fall_time_s(distance, v) - drip.age_s).abs();
        prop_assert!(away <= 0.5 * period * (1.0 + 1e-9) || drip.index == 0);
        // A moment later the same drop is farther down.
        let fraction = released.fract();
        if fraction < 0.98 {
            let later = nearest_drip(drip.distance_m, period, fraction + 0.01, v).expect("drips");
            prop_assert!(later.index == drip.index && later.distance_m > drip.distance_m);
        }
    }

    #[test]
    fn quantiles_rise_and_stay_in_the_table(u in 0.0_f64..1.0, step in 1e-6_f64..0.1, leaf in 0_usize..3) {
        let sizes = DripSizes::measured(LeafType::ALL[leaf]);
        prop_assert!(sizes.diameter_by_number(u + step) >= sizes.diameter_by_number(u));
        prop_assert!(sizes.diameter_by_volume(u + step) >= sizes.diameter_by_volume(u));
        prop_assert!(sizes.diameter_by_volume(u) >= sizes.diameter_by_number(u) - 1e-12, "large drops hold more water");
    }

    #[test]
    fn shares_sum_to_one_at_any_thickness(thickness in 0.0_f64..20.0) {
        let shares = radial_shares(thickness);
        prop_assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        prop_assert!(shares.iter().all(|share| (0.15..0.4).contains(share)));
    }
}
