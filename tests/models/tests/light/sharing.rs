//! One optical depth, shared between drawn drops and fog.

use proptest::prelude::*;
use rain_core::haze::{
    FogTable, HazeSharing, card_coverage, card_weight, mid_depth_m, mid_start_m, mid_weight, near_depth_m, near_weight,
    ramp, ramp_integral_m, single_range_fog_depth, transmittance,
};
use rain_core::rainfall::{CLASS_COUNT, CLASS_EDGES_MM, Distribution, Spectrum, visible_range_m};
use rain_reference::light::haze as reference;

use super::haze::published;
use super::{NOT_NUMBERS, config};
use crate::check::Worst;

fn rain(r: f64) -> Spectrum {
    Spectrum::new(Distribution::MarshallPalmer, r).expect("valid")
}

/// Where the weights of a range change their form.
fn corners(z: f64) -> Vec<f64> {
    let b = mid_start_m(z);
    vec![0.1, 0.2, 0.8 * z, 1.2 * z, b, 1.5 * b, 24.0, 36.0]
}

#[test]
fn the_single_range_matches_the_published_values() {
    let s = published(25.0);
    let exact = s.extinction_per_m(0.0, f64::INFINITY);
    assert!((exact - 1.385_353e-3).abs() < 6e-10, "{exact}");
    // The published rows were computed from this rounded value.
    let sigma = 1.38536e-3;
    let table = [
        (10.0, 0.013758, 0.013854, 0.972673),
        (30.0, 0.040709, 0.041561, 0.920239),
        (100.0, 0.040709, 0.235511, 0.758000),
        (500.0, 0.040709, 1.343799, 0.250234),
    ];
    for (way, cover, fog, total) in table {
        let ours = single_range_fog_depth(sigma, 2.0, way, 30.0, 1.0);
        assert!((ours - fog).abs() < 6e-7, "{way}: {ours}");
        let drops = transmittance(sigma * way.min(30.0));
        assert!((1.0 - drops - cover).abs() < 6e-7, "{way}");
        assert!((drops * transmittance(ours) - total).abs() < 6e-7, "{way}");
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn moving_the_range_changes_no_mean(way in 0.0_f64..1e3, range in 0.0_f64..100.0, q in 0.0_f64..1.0, efficiency in 1.0_f64..3.0) {
        let sigma = 1.4e-3;
        let fog = single_range_fog_depth(sigma, efficiency, way, range, q);
        let drops = sigma * q * way.min(range);
        prop_assert!((transmittance(fog) * transmittance(drops) / transmittance(efficiency * sigma * way) - 1.0).abs() < 1e-13);
    }

    #[test]
    fn weights_are_shares_and_their_depths_grow(r in 0.0_f64..60.0, more in 0.001_f64..5.0, z in 0.0_f64..15.0) {
        let (near, mid) = (near_weight(r, z), mid_weight(r, z));
        prop_assert!((0.0..=1.0).contains(&near) && (0.0..=1.0).contains(&mid));
        prop_assert!(near + mid <= 1.0 + 1e-15);
        prop_assert!(near_depth_m(r + more, z) >= near_depth_m(r, z) - 1e-13);
        prop_assert!(mid_depth_m(r + more, z) >= mid_depth_m(r, z) - 1e-13);
        // Where singles hand over to cards their sum does not depend on the range.
        if (4.0..15.0).contains(&z) && r > 0.2 && r < 24.0 {
            prop_assert!((near + mid - 1.0).abs() < 1e-14);
        }
        let cell = 2.0;
        prop_assert!((0.0..=1.0).contains(&card_weight(r, cell, z)));
    }

    #[test]
    fn drops_times_fog_is_the_whole_rain(
        r in 0.1_f64..150.0, scale in 0.0_f64..40.0, way in 0.0_f64..2e3, efficiency in 1.0_f64..3.0, mid_tier in any::<bool>()
    ) {
        let spectrum = rain(r);
        let ranges: [f64; CLASS_COUNT] = core::array::from_fn(|k| (scale * (k as f64 + 0.3) / 6.0).min(15.0));
        let sharing = HazeSharing::new(&spectrum, efficiency, ranges, mid_tier).expect("valid");
        // The drops' mean transmittance by summing what is drawn along the way.
        let all = spectrum.moment(2, 0.0, f64::INFINITY);
        let mut drawn = 0.0;
        for (k, z) in ranges.into_iter().enumerate() {
            let share = spectrum.moment(2, CLASS_EDGES_MM[k], CLASS_EDGES_MM[k + 1]) / all;
            let shown = |s: f64| {
                let near = if z >= 0.25 { reference::near_weight(s, z) } else { 0.0 };
                near + if mid_tier { reference::mid_weight(s, z) } else { 0.0 }
            };
            drawn += share * reference::along(way, &corners(z), shown);
        }
        let sigma = spectrum.extinction_per_m(0.0, f64::INFINITY);
        let whole = transmittance(efficiency * sigma * way);
        let product = transmittance(sigma * drawn) * sharing.fog_transmittance(way);
        prop_assert!((product - whole).abs() < 1e-13, "{product} {whole}");
        prop_assert!(sharing.fog_depth(way) >= 0.0 && sharing.fog_depth(way + 1.0) >= sharing.fog_depth(way) - 1e-15);
    }
}

#[test]
fn ramps_are_integrated_exactly() {
    let (mut sum, mut near, mut mid) = (Worst::default(), Worst::default(), Worst::default());
    for s in [
        0.0, 0.05, 0.13, 0.2, 1.0, 3.1, 3.9, 4.7, 5.0, 12.0, 17.0, 25.0, 33.0, 36.0, 400.0,
    ] {
        let slow = reference::along(s, &[2.0, 5.0], |x| reference::smooth(x, 2.0, 5.0));
        sum.absolute(ramp_integral_m(s, 2.0, 5.0), slow, || format!("{s}"));
        for z in [0.25, 0.7, 3.0, 4.0, 9.0, 15.0] {
            let slow = reference::along(s, &corners(z), |x| reference::near_weight(x, z));
            near.absolute(near_depth_m(s, z), slow, || format!("{s} {z}"));
            let slow = reference::along(s, &corners(z), |x| reference::mid_weight(x, z));
            mid.absolute(mid_depth_m(s, z), slow, || format!("{s} {z}"));
        }
    }
    sum.assert_below(1e-13, 15);
    near.assert_below(1e-13, 90);
    mid.assert_below(1e-13, 90);
    assert!((ramp(3.0, 2.0, 5.0) - reference::smooth(3.0, 2.0, 5.0)).abs() < 1e-15);
    let wrong =
        near_depth_m(20.0, 9.0 * 1.05) - reference::along(20.0, &corners(9.0), |x| reference::near_weight(x, 9.0));
    assert!(wrong.abs() > 0.1, "5 % of the range goes unseen");
}

#[test]
fn cards_add_up_to_the_middle_tier() {
    for z in [2.0, 6.0, 15.0] {
        for cell in [2.0, 4.0] {
            let sum: f64 = (0..30)
                .map(|i| cell * card_weight((f64::from(i) + 0.5) * cell, cell, z))
                .sum();
            assert!((sum - mid_depth_m(30.0 * cell, z)).abs() < 1e-12, "{z} {cell}: {sum}");
        }
    }
    // Optical depth of a texture is that of its cell.
    assert!((-(1.0 - card_coverage(3e-4, 4.0)).ln() - 1.2e-3).abs() < 1e-15);
}

#[test]
fn the_table_is_the_integral_over_diameters() {
    for r in [5.0, 25.0, 100.0] {
        let spectrum = rain(r);
        let range = |d: f64| visible_range_m(d, 623.5, 1.0 / 60.0).min(15.0);
        for mid_tier in [false, true] {
            let table = FogTable::new(&spectrum, 2.0, mid_tier, range).expect("valid");
            let sigma = spectrum.extinction_per_m(0.0, f64::INFINITY);
            let mut worst = Worst::default();
            for i in 0..=120 {
                let s = 0.5 * f64::from(i) + 0.01;
                // Drops between 0.5 and 6 mm, each with its own range.
                let drawn = rain_reference::numerics::simpson(0.5, 6.0, 1500, |d| {
                    let z = range(d);
                    let metres = near_depth_m(s, z) + if mid_tier { mid_depth_m(s, z) } else { 0.0 };
                    core::f64::consts::FRAC_PI_4 * 1e-6 * d * d * spectrum.concentration(d) * metres
                });
                let exact = 2.0 * sigma * s - drawn;
                worst.absolute(f64::from(table.depth_f32(s as f32)) / sigma, exact / sigma, || {
                    format!("{r} mm/h at {s}")
                });
            }
            // In metres of rain.
            worst.assert_below(if mid_tier { 0.02 } else { 0.003 }, 121);
        }
    }
}

#[test]
fn a_table_holds_ranges_that_end_within_it() {
    let spectrum = rain(25.0);
    let table = |range: f64| FogTable::new(&spectrum, 2.0, false, |_| range).expect("valid");
    let sharing = HazeSharing::new(&spectrum, 2.0, [30.0; CLASS_COUNT], false).expect("valid");
    for s in [20.0, 36.0, 60.0, 500.0] {
        let (held, exact) = (f64::from(table(1e3).depth_f32(s as f32)), sharing.fog_depth(s));
        assert_eq!(table(30.0).depth_f32(s as f32), table(1e3).depth_f32(s as f32));
        // Within 0.02 m of rain.
        assert!(
            (held - exact).abs() < 0.02 * spectrum.extinction_per_m(0.0, f64::INFINITY),
            "{s}: {held} {exact}"
        );
    }
}

#[test]
fn sharing_refuses_bad_parameters_and_answers_every_way() {
    let spectrum = rain(10.0);
    let ranges = [5.0; CLASS_COUNT];
    for bad in [f64::NAN, f64::INFINITY, 0.99, 4.1] {
        assert!(
            HazeSharing::new(&spectrum, bad, ranges, true).is_err_and(|e| e.to_string().starts_with("efficiency is "))
        );
        assert!(FogTable::new(&spectrum, bad, true, |_| 5.0).is_err());
    }
    for bad in [f64::NAN, f64::INFINITY, -1.0] {
        let mut broken = ranges;
        broken[3] = bad;
        assert!(
            HazeSharing::new(&spectrum, 2.0, broken, true).is_err_and(|e| e.to_string().starts_with("ranges_m is "))
        );
    }
    let sharing = HazeSharing::new(&spectrum, 2.0, ranges, true).expect("valid");
    let table = FogTable::new(&spectrum, 2.0, true, |_| f64::NAN).expect("valid");
    for bad in NOT_NUMBERS {
        for depth in [
            sharing.fog_depth(bad),
            sharing.drawn_depth(bad),
            sharing.total_depth(bad),
            f64::from(table.depth_f32(bad as f32)),
            single_range_fog_depth(bad, bad, bad, bad, bad),
            near_depth_m(bad, bad),
            mid_depth_m(bad, bad),
            near_weight(bad, bad),
            mid_weight(bad, bad),
            ramp(bad, 0.0, 1.0),
            ramp_integral_m(bad, 0.0, 1.0),
            mid_start_m(bad),
            card_weight(bad, bad, bad),
            card_coverage(bad, bad),
        ] {
            assert!(depth.is_finite() && depth >= 0.0, "{bad}: {depth}");
        }
    }
    let dry = HazeSharing::new(&rain(0.0), 2.0, ranges, true).expect("valid");
    assert_eq!(dry.fog_transmittance(1e6), 1.0);
    assert!(sharing.classes().iter().map(|c| c.share).sum::<f64>() < 1.0);
    assert_eq!(near_weight(0.15, 0.2), 0.0);
}
