//! Every formula of a crown and its drips against its twin, over the whole domain.

use proptest::prelude::*;
use rain_core::canopy::{
    CanopyFluxes, CanopyKind, CanopyProperties, CanopyStore, DRIP_VOLUME_SHARES, DripClock, DripPlan, DripSizes,
    LeafType, canopy_shower, constant_rain_drip_fraction, crown_place, drip_crest, drip_distance_m,
    drip_distance_m_f32, drip_fall_time_s, drip_fall_time_s_f32, drip_flow_m3_s, drip_frequency_hz, drip_period_s,
    drop_volume_m3, gaussian_drip_share, nearest_drip, nearest_drip_f32, radial_class, radial_shares,
    saturation_time_s, stored_by_splitting,
};
use rain_reference::canopy as reference;

use crate::check::Worst;

const BAD: [f64; 7] = [f64::NAN, f64::NEG_INFINITY, -1.0, 0.0, 5e-324, 1e300, f64::INFINITY];

#[test]
fn properties_are_their_products_and_exponentials() {
    let (mut capacity, mut shares, mut time, mut bent) =
        (Worst::default(), Worst::default(), Worst::default(), Worst::default());
    for (kind, hundredths) in [(CanopyKind::Broadleaf, 15.0), (CanopyKind::Needle, 20.0)] {
        for i in 0..=200 {
            let lai = 20.0 * (f64::from(i) / 200.0).powi(3);
            for kappa in [0.0, 1e-6, 0.5, 5.0] {
                let crown = CanopyProperties {
                    kind,
                    leaf_area_index: lai,
                    gap_extinction: kappa,
                    ..CanopyProperties::default()
                };
                let place = || format!("{kind:?}, LAI {lai}, κ {kappa}");
                capacity.relative(crown.capacity_mm(), hundredths * lai / 100.0, 1e-30, place);
                shares.relative(crown.free_share(), 1.0 / (kappa * lai).exp(), 1e-30, place);
                // 1 − e^(−x) = 2/(1 + coth(x/2)).
                let half = (0.5 * kappa * lai).tanh();
                shares.relative(crown.intercepted_share(), 2.0 * half / (1.0 + half), 1e-30, place);
                bent.relative(1.05 * crown.free_share(), 1.0 / (kappa * lai).exp(), 1e-30, place);
            }
            for rain in [1e-9, 0.3, 500.0] {
                let stored = 0.01 * f64::from(i);
                let found = saturation_time_s(stored, rain).expect("rain");
                // Twice the store over the rain, hours to seconds.
                time.relative(found, 3600.0 * (2.0 * stored / rain), 1e-30, || {
                    format!("{stored} mm, {rain} mm/h")
                });
            }
        }
    }
    capacity.assert_below(5e-16, 1600);
    shares.assert_below(1e-15, 3200);
    time.assert_below(5e-16, 600);
    assert!(bent.error > 0.04);
    let mut ramp = Worst::default();
    for i in 0..=400 {
        let t = 3.0 * f64::from(i);
        for cap in [0.0, 0.7, 0.9, 1.0] {
            ramp.absolute(
                constant_rain_drip_fraction(t, 432.0, cap),
                f64::min(t / 432.0, cap),
                || format!("{t} s, {cap}"),
            );
        }
    }
    ramp.assert_below(2e-16, 1600);
    for bad in BAD {
        assert!((0.0..=1.0).contains(&constant_rain_drip_fraction(bad, bad, bad)));
        assert!(
            saturation_time_s(bad, bad).is_none_or(|t| t.is_finite() && t >= 0.0),
            "{bad}"
        );
    }
}

#[test]
fn a_shower_is_the_store_under_it() {
    let (mut worst, mut bent) = (Worst::default(), Worst::default());
    for lai in [0.0, 0.5, 4.0, 12.0] {
        for (rain, time, evaporation) in [
            (0.0, 600.0, 0.3),
            (2.0, 1800.0, 0.0),
            (20.0, 200.0, 0.5),
            (500.0, 20.0, 2.0),
        ] {
            let properties = CanopyProperties {
                leaf_area_index: lai,
                ..CanopyProperties::default()
            };
            let shower = canopy_shower(properties, rain, time, evaporation).expect("valid");
            let mut store = CanopyStore::new(properties).expect("valid");
            assert_eq!(shower.fluxes, store.advance(rain, evaporation, time), "the same bits");
            assert_eq!(
                (shower.storage_mm, shower.drip_fraction),
                (store.stored_mm(), store.drip_fraction())
            );
            assert_eq!(shower.capacity_mm, properties.capacity_mm());
            assert_eq!(shower.saturation_time_s, saturation_time_s(shower.capacity_mm, rain));
            // And what the equation gives.
            if lai > 0.0 && rain > 0.0 {
                let caught = rain * properties.intercepted_share() / 3600.0;
                let end = reference::canopy_by_runge_kutta(
                    shower.capacity_mm,
                    0.0,
                    caught,
                    evaporation / 3600.0,
                    time,
                    0.8,
                    20_000,
                );
                let scale = shower.capacity_mm + rain * time / 3600.0;
                for (value, expected) in [
                    (shower.storage_mm, end.stored),
                    (shower.fluxes.drip_mm, end.drip),
                    (shower.fluxes.stemflow_mm, end.stemflow),
                    (shower.fluxes.evaporated_mm, end.evaporated),
                ] {
                    worst.absolute(value / scale, expected / scale, || {
                        format!("LAI {lai}, {rain} mm/h, {time} s")
                    });
                    bent.absolute(1.05 * value / scale, expected / scale, String::new);
                }
            }
            let q = 1.0
                - (1.0 - (store.stored_mm() / shower.capacity_mm.max(1e-30)))
                    .max(0.0)
                    .sqrt();
            assert!(
                lai == 0.0 || (store.drained_fraction() - q).abs() < 2e-8,
                "q = 1 − √(1 − C/S)"
            );
        }
    }
    worst.assert_below(1e-6, 36);
    assert!(bent.error > 0.01);
    let fluxes = CanopyFluxes {
        rain_mm: 7.0,
        free_throughfall_mm: 1.0,
        drip_mm: 2.0,
        stemflow_mm: 0.5,
        evaporated_mm: 0.25,
        storage_change_mm: 3.0,
    };
    assert_eq!(
        (fluxes.throughfall_mm(), fluxes.residual_mm(), fluxes.drip_m3(50.0)),
        (3.0, 0.25, 0.1)
    );
    assert_eq!((fluxes.drip_m3(-1.0), fluxes.drip_m3(f64::NAN)), (0.0, 0.0));
}

#[test]
fn shares_of_the_store_are_roots_also_near_full() {
    let mut worst = Worst::default();
    for i in 0..=600 {
        // y = √(1 − C/S) from 1 down to 1e-6: the share is 1 − y.
        let y = 10_f64.powf(-0.01 * f64::from(i));
        let stored = 0.6 * (1.0 - y) * (1.0 + y);
        let store = CanopyStore::from_measured(0.6, 1.0, 0.8).expect("valid");
        let store = store.with_stored(stored).expect("within");
        worst.absolute(
            store.drained_fraction(),
            1.0 - (1.0 - stored / 0.6).max(0.0).sqrt(),
            || format!("y = {y}"),
        );
        assert_eq!(store.drip_fraction(), store.drained_fraction().min(0.8));
    }
    worst.assert_below(1e-10, 601);
}

#[test]
fn volumes_flows_and_periods_are_the_printed_ones() {
    let (mut volume, mut flow, mut bent) = (Worst::default(), Worst::default(), Worst::default());
    for i in 0..=100 {
        let d = 0.01 * 10_f64.powf(0.04 * f64::from(i));
        let ball = reference::drop_volume(d);
        volume.relative(drop_volume_m3(d), ball, 1e-60, || format!("{d} mm"));
        bent.relative(drop_volume_m3(1.05 * d), ball, 1e-60, String::new);
        for (rain, area, shares) in [
            (10.0, 10.0, [0.8, 0.34, 0.37]),
            (0.01, 1e-6, [1.0; 3]),
            (500.0, 1e4, [0.01, 1.0, 0.9]),
        ] {
            let [t, s, q] = shares;
            let place = || format!("{d} mm, {rain} mm/h, {area} m²");
            let found = drip_flow_m3_s(rain, area, shares);
            // mm/h of m² are litres an hour.
            flow.relative(found, q * s * t * area * rain / 1000.0 / 3600.0, 1e-60, place);
            flow.relative(drip_frequency_hz(found, d), found / ball, 1e-60, place);
            let printed = 6e-4 * std::f64::consts::PI * d.powi(3) / (rain * area * t * s * q);
            flow.relative(
                drip_period_s(d, rain, area, shares).expect("drips"),
                printed,
                1e-60,
                place,
            );
        }
    }
    volume.assert_below(2e-15, 101);
    flow.assert_below(3e-15, 900);
    assert!(bent.error > 0.1);
    for (bad, held) in [
        (f64::NAN, 0.0),
        (f64::NEG_INFINITY, 0.0),
        (-1.0, 0.0),
        (5e-324, 0.0),
        (1e300, 100.0),
        (f64::INFINITY, 100.0),
    ] {
        assert_eq!(drop_volume_m3(bad), drop_volume_m3(held), "{bad}");
    }
}

#[test]
fn places_belong_to_the_nearest_ring() {
    let mut cases = 0;
    for crown in [0.01, 0.5, 2.0, 7.3, 1000.0] {
        for i in 0..=3000 {
            let radius = 1.5 * crown * f64::from(i) / 3000.0;
            // Midway between two rings rounding decides.
            if [0.7, 1.25, 1.75]
                .into_iter()
                .any(|middle| (2.0 * radius / crown - middle).abs() < 1e-12)
            {
                continue;
            }
            assert_eq!(
                radial_class(radius, crown),
                reference::nearest_ring(radius, crown),
                "{radius} of {crown}"
            );
            cases += 1;
        }
    }
    assert!(cases > 14_000);
    // Midway, the outer one.
    assert_eq!([0.7, 1.25, 1.75].map(|radius| radial_class(radius, 2.0)), [1, 2, 3]);
    for (radius, crown, class) in [
        (f64::INFINITY, 2.0, 3),
        (f64::NEG_INFINITY, 2.0, 0),
        (5e-324, 2.0, 0),
        (1.0, 5e-324, 3),
        (1.0, 0.0, 3),
        (1.0, -2.0, 3),
        (1.0, f64::NEG_INFINITY, 3),
        (1.0, f64::NAN, 3),
        (1.0, f64::INFINITY, 0),
        (f64::INFINITY, f64::INFINITY, 3),
        (0.0, 0.0, 0),
    ] {
        assert_eq!(radial_class(radius, crown), class, "{radius} of {crown}");
    }
    let mut shares = Worst::default();
    for i in 0..=300 {
        let thickness = 4.8 + 0.01 * f64::from(i);
        for (value, expected) in radial_shares(thickness)
            .into_iter()
            .zip(reference::ring_shares(thickness))
        {
            shares.absolute(value, expected, || format!("{thickness} m"));
        }
    }
    shares.assert_below(1e-15, 1200);
}

#[test]
fn places_of_a_ring_are_spread_evenly_over_it() {
    let n = 40_000_u32;
    let places: Vec<_> = (0..n).map(|i| crown_place(3, i, 2.0, 6.3)).collect();
    let ends = [0.0, 0.7, 1.25, 1.75, 2.0];
    let even = |chi: f64| (chi - 1.0).abs() < 5.0 * (2.0_f64 / 63.0).sqrt();
    for class in 0..4 {
        let ring = || places.iter().filter(|place| place.class == class);
        let area = ring().map(|place| {
            let square = place.x_m.powi(2) + place.z_m.powi(2);
            let (from, to) = (f64::powi(ends[class], 2), f64::powi(ends[class + 1], 2));
            ((square - from) / (to - from)).clamp(0.0, 1.0 - 1e-12)
        });
        let turns = ring().map(|place| {
            (place.z_m.atan2(place.x_m) / core::f64::consts::TAU)
                .rem_euclid(1.0)
                .min(1.0 - 1e-12)
        });
        let heights = ring().map(|place| place.above_branch_m / (0.2 * 6.3));
        for chi in [
            rain_reference::hash::chi_squared_per_degree(area, 64),
            rain_reference::hash::chi_squared_per_degree(turns, 64),
            rain_reference::hash::chi_squared_per_degree(heights, 64),
        ] {
            assert!(even(chi), "ring {class}: {chi}");
        }
    }
}

#[test]
fn falls_are_the_hyperbolic_ones_over_the_whole_domain() {
    let (mut time, mut way, mut crest) = (Worst::default(), Worst::default(), Worst::default());
    let (mut time_f32, mut way_f32) = (Worst::default(), Worst::default());
    for v in [1e-6, 1e-3, 0.05, 0.5, 2.0, 4.0, 9.2, 40.0, 1e3] {
        for i in -60..=30 {
            let x = 10_f64.powf(0.2 * f64::from(i));
            let place = || format!("{x} at {v} m/s");
            time.relative(drip_fall_time_s(x, v), reference::drip_time(x, v), 1e-300, place);
            way.relative(drip_distance_m(x, v), reference::drip_way(x, v), 1e-300, place);
            let (x32, v32) = (x as f32, v as f32);
            let (wide, terminal) = (f64::from(x32), f64::from(v32));
            time_f32.relative(
                f64::from(drip_fall_time_s_f32(x32, v32)),
                reference::drip_time(wide, terminal),
                1e-30,
                place,
            );
            let expected = reference::drip_way(wide, terminal);
            way_f32.relative(f64::from(drip_distance_m_f32(x32, v32)), expected, 1e-30, place);
        }
    }
    for distance in [0.0, 0.3, 2.0, 15.0] {
        for period in [0.01, 0.5, 20.0] {
            for released in [0.0, 0.3, 77.25, 9_999.9] {
                let turns = released - reference::drip_time(distance, 6.0) / period;
                let expected = (core::f64::consts::TAU * turns).cos();
                crest.absolute(drip_crest(distance, period, released, 6.0), expected, || {
                    format!("{distance} m, {period} s, N = {released}")
                });
            }
        }
    }
    time.assert_below(1e-15, 800);
    way.assert_below(1e-15, 800);
    time_f32.assert_below(4e-7, 800);
    way_f32.assert_below(2e-6, 800);
    crest.assert_below(1e-7, 48);
}

#[test]
fn the_nearest_drop_is_found_among_all() {
    let (mut age, mut fall, mut single) = (Worst::default(), Worst::default(), Worst::default());
    let mut compared = 0;
    for distance in [0.0, 0.05, 0.7, 3.0, 12.0] {
        for period in [0.002, 0.11, 0.5, 4.0] {
            for n in 0..40 {
                let phase = (f64::from(n) + 0.37) / 40.0;
                for v in [3.0, 6.7, 9.2] {
                    let (index, expected) = reference::nearest_drop(distance, period, phase, v);
                    let drip = nearest_drip(distance, period, phase, v).expect("drips");
                    let place = || format!("{distance} m, {period} s, {phase}, {v} m/s");
                    assert_eq!(drip.index, index, "{}", place());
                    age.relative(drip.age_s, expected, 1e-12, place);
                    fall.relative(drip.distance_m, reference::drip_way(expected, v), 1e-12, place);
                    let near = nearest_drip_f32(distance as f32, period as f32, phase as f32, v as f32).expect("drips");
                    if u64::from(near.index) == index {
                        single.absolute(f64::from(near.distance_m), drip.distance_m, place);
                        compared += 1;
                    }
                }
            }
        }
    }
    age.assert_below(1e-15, 2400);
    fall.assert_below(2e-15, 2400);
    single.assert_below(2e-5, 2300);
    assert!(compared > 2390, "both choose the same drop: {compared}");
}

#[test]
fn released_drops_are_counted_to_the_last() {
    let sizes = DripSizes::measured(LeafType::BroadleafMatte);
    let radii: Vec<f64> = (0..40).map(|i| 0.05 * f64::from(i)).collect();
    let plan = DripPlan::new(4, &sizes, &radii, 2.0, 5.8).expect("valid");
    let mut worst = Worst::default();
    // A drop, a shower, a year's rain of 1000 mm on 30 m².
    for water in [1e-8, 3e-3, 30.0] {
        let mut clock = DripClock::default();
        clock.advance(water);
        for place in 0..plan.len() {
            let (whole, fraction) = clock.released(&plan, place);
            let expected = water * plan.frequency_hz(place, 1.0) + plan.phase(place);
            let scale = expected.max(1.0);
            worst.absolute((whole as f64 + fraction) / scale, expected / scale, || {
                format!("{water} m³, {place}")
            });
            assert!((0.0..1.0).contains(&fraction));
        }
    }
    worst.assert_below(1e-15, 120);
    assert_eq!(
        DripClock::default().released(&plan, 999),
        (0, plan.phase(999)),
        "no such place lets nothing go"
    );
}

#[test]
fn sizes_of_drips_are_their_sums() {
    let (mut measured, mut fit, mut classes) = (Worst::default(), Worst::default(), Worst::default());
    let mut apart = 0.0_f64;
    for (leaf, (kind, row)) in LeafType::ALL.into_iter().zip(DRIP_VOLUME_SHARES).enumerate() {
        let sizes = DripSizes::measured(kind);
        assert_eq!(sizes.classes(), row.len());
        let table = |d: f64| reference::drip_volume_density(leaf, d);
        let whole = |n| reference::drip_sum(table, n, 8.0);
        for (value, expected) in [
            (sizes.volume_mean_mm(), whole(-1) / whole(0)),
            (sizes.number_mean_mm(), whole(2) / whole(3)),
            (
                sizes.drops_per_litre(),
                whole(3) / whole(0) * 6e6 / std::f64::consts::PI,
            ),
            (sizes.mean_drop_m3(), std::f64::consts::PI / 6e9 * whole(0) / whole(3)),
        ] {
            measured.relative(value, expected, 1e-30, || format!("{kind:?}"));
        }
        for (class, share) in row.into_iter().enumerate() {
            let (from, to) = (1.0 + 0.5 * class as f64, 1.5 + 0.5 * class as f64);
            let numbers = (reference::drip_sum(table, 3, to) - reference::drip_sum(table, 3, from)) / whole(3);
            classes.absolute(sizes.number_share(class), numbers, || {
                format!("{kind:?}, class {class}")
            });
            let middle = 0.5 * (from + to);
            let printed = reference::drip_gaussian_density(leaf, middle) * 0.5;
            fit.relative(gaussian_drip_share(kind, middle), printed, 1e-30, || {
                format!("{kind:?} at {middle} mm")
            });
            apart = apart.max((gaussian_drip_share(kind, middle) - share).abs());
        }
    }
    measured.assert_below(1e-9, 12);
    classes.assert_below(1e-9, 42);
    fit.assert_below(4e-15, 42);
    assert!((0.046..0.0471).contains(&apart), "off the measured classes: {apart}");
}

#[test]
fn splitting_is_the_exact_step_and_then_the_loss() {
    let mut worst = Worst::default();
    for stored in [0.0, 0.2, 0.55, 0.6] {
        for (rain, evaporation, dt) in [
            (10.0, 0.5, 10.0),
            (0.0, 3.0, 60.0),
            (200.0, 0.0, 300.0),
            (1.0, 9.0, 1000.0),
        ] {
            // y = √(1 − C/S) falls by R dt/(2S).
            let y = ((1.0 - stored / 0.6_f64).sqrt() - rain / 3600.0 * dt / 1.2).max(0.0);
            let expected = (0.6 * (1.0 - y * y) - evaporation / 3600.0 * dt).max(0.0);
            let value = stored_by_splitting(0.6, stored, rain, evaporation, dt);
            worst.absolute(value / 0.6, expected / 0.6, || {
                format!("{stored} mm, {rain} mm/h, {dt} s")
            });
        }
    }
    worst.assert_below(1e-15, 16);
}

proptest! {
    #![proptest_config(super::fixed())]

    #[test]
    fn rings_do_not_depend_on_the_crowns_size(radius in 0.0_f64..5.0, crown in 0.1_f64..5.0, more in 0.0_f64..5.0, scale in 0.1_f64..10.0) {
        let class = radial_class(radius, crown);
        prop_assert!(class < 4 && radial_class(radius + more, crown) >= class, "outwards");
        let middle = [0.35, 0.625, 0.875].into_iter().any(|end| (radius / crown - end).abs() < 1e-12);
        prop_assert!(middle || radial_class(radius * scale, crown * scale) == class);
    }

    #[test]
    fn flows_are_products_and_volumes_cubes(d in 0.02_f64..40.0, rain in 0.0_f64..500.0, area in 0.0_f64..1e3, share in 0.0_f64..1.0) {
        prop_assert!((drop_volume_m3(2.0 * d) / drop_volume_m3(d) - 8.0).abs() < 1e-14);
        let flow = drip_flow_m3_s(rain, area, [share, 1.0, 1.0]);
        prop_assert!(flow <= drip_flow_m3_s(rain, area, [1.0; 3]) && flow >= 0.0);
        // What falls in drops is what flows.
        prop_assert!((drip_frequency_hz(flow, d) * drop_volume_m3(d) - flow).abs() <= 1e-15 * flow);
        let period = drip_period_s(d, rain, area, [share, 1.0, 1.0]);
        prop_assert!(period.is_none_or(|t| (t * drip_frequency_hz(flow, d) - 1.0).abs() < 1e-15));
    }

    #[test]
    fn leaves_catch_what_gaps_do_not(lai in 0.0_f64..20.0, more in 0.0_f64..1.0, kappa in 0.0_f64..5.0) {
        let crown = |leaf_area_index| CanopyProperties { leaf_area_index, gap_extinction: kappa, ..CanopyProperties::default() };
        let (thin, thick) = (crown(lai), crown((lai + more).min(20.0)));
        prop_assert!((thin.free_share() + thin.intercepted_share() - 1.0).abs() < 1e-15);
        prop_assert!(thick.free_share() <= thin.free_share() && thick.capacity_mm() >= thin.capacity_mm());
    }
}
