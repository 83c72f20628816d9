//! Closed forms of the weather over their whole domains.

use proptest::prelude::*;
use rain_core::weather::{
    Infiltration, SurfaceClass, SurfaceProperties, drying_time_s, relative_intensity, saturation_vapour_pressure_pa,
};
use rain_reference::weather as truth;

use super::{config, ground};
use crate::check::Worst;

/// `n` values from `low` to `high`, evenly spaced in their logarithm.
fn log_spaced(low: f64, high: f64, n: i32) -> impl Iterator<Item = f64> + Clone {
    (0..n).map(move |i| low * (high / low).powf(f64::from(i) / f64::from(n - 1)))
}

/// Soils at the ends of the domain and between.
fn soils() -> Vec<Infiltration> {
    let mut soils = Vec::new();
    for initial_mm_h in [1e-3, 76.0, 1e4] {
        for share in [0.0, 1e-6, 0.17, 0.999, 1.0] {
            for decay_per_h in [1e-6, 4.14, 1e3] {
                soils.push(Infiltration {
                    initial_mm_h,
                    final_mm_h: share * initial_mm_h,
                    decay_per_h,
                    recovery_per_s: 0.0,
                });
            }
        }
    }
    soils
}

#[test]
fn hortons_curve_is_its_sum_and_ponds_when_it_is_down_to_the_rain() {
    let [mut capacity, mut depth, mut ponding, mut wrong] = [(); 4].map(|()| Worst::default());
    for soil in soils() {
        let slow = ground(&SurfaceProperties {
            infiltration: soil,
            ..SurfaceClass::Soil.properties()
        });
        for t in log_spaced(1e-3, 1e6, 19) {
            let place = || format!("{soil:?} {t}");
            capacity.relative(
                soil.capacity_mm_h(t),
                3600.0 * slow.capacity_mm_s(t),
                soil.initial_mm_h,
                place,
            );
            // As long as the slow sum can be had.
            if soil.decay_per_h * t < 3.6e5 {
                depth.relative(soil.flooded_mm(t), slow.flooded_mm(t), 0.0, place);
                wrong.relative(soil.flooded_mm(1.05 * t), slow.flooded_mm(t), 0.0, String::new);
            }
        }
        for share in [1e-6, 0.02, 0.3, 0.9, 0.999] {
            let rain = soil.final_mm_h + share * (soil.initial_mm_h - soil.final_mm_h);
            // Where first and last capacity are nearly one, the place between is known to few digits only.
            if soil.final_mm_h < 0.5 * soil.initial_mm_h {
                let found = soil.ponding_time_s(rain).expect("ponds");
                ponding.relative(found, slow.ponded_after_s(rain), 0.0, || format!("{soil:?} {share}"));
            }
        }
    }
    capacity.assert_below(1e-15, 800);
    depth.assert_below(1e-13, 600);
    ponding.assert_below(1e-11, 100);
    assert!(wrong.error > 0.04, "a time 5 % off goes unseen");
}

#[test]
fn vapour_drains_drying_and_levels_are_their_formulas() {
    let [mut vapour, mut drain, mut drying, mut level, mut wrong] = [(); 5].map(|()| Worst::default());
    for i in 0..=2600 {
        let t = -200.0 + 0.1 * f64::from(i);
        let exact = 100.0 * truth::saturation_hpa(t);
        vapour.relative(saturation_vapour_pressure_pa(t), exact, 0.0, || format!("{t} °C"));
        wrong.relative(saturation_vapour_pressure_pa(t + 0.5), exact, 0.0, String::new);
    }
    vapour.assert_below(1e-13, 2000);
    assert!(wrong.error > 0.02, "half a degree goes unseen");
    for slope in log_spaced(1e-6, 10.0, 8).chain([0.0]) {
        for manning_n in log_spaced(1e-3, 10.0, 5) {
            for flow_length_m in log_spaced(0.01, 1e4, 7) {
                let p = SurfaceProperties {
                    slope,
                    manning_n,
                    flow_length_m,
                    ..SurfaceClass::Asphalt.properties()
                };
                drain.relative(p.drain_coefficient(), ground(&p).drain(), 1e-300, || format!("{p:?}"));
            }
        }
    }
    drain.assert_below(2e-15, 300);
    for film in log_spaced(1e-9, 1e6, 30) {
        for evaporation in log_spaced(1e-12, 1e4, 30) {
            let exact = film * 3600.0 / evaporation;
            let found = drying_time_s(film, evaporation).expect("dries");
            drying.relative(found, exact, 0.0, || format!("{film} {evaporation}"));
        }
    }
    drying.assert_below(1e-15, 900);
    for i in 0..=20_000 {
        let rate = 1e-3 * f64::from(i);
        level.absolute(relative_intensity(rate), truth::relative_intensity(rate), || {
            format!("{rate} mm/h")
        });
    }
    level.assert_below(3e-16, 20_000);
    for (rate, edge) in [
        (f64::NAN, 0.0),
        (f64::NEG_INFINITY, 0.0),
        (-1.0, 0.0),
        (-0.0, 0.0),
        (5e-324, 0.0),
        (500.0, 1.0),
        (f64::INFINITY, 1.0),
    ] {
        assert_eq!(relative_intensity(rate), edge, "{rate}");
    }
    for (t, held) in [
        (f64::NAN, -200.0),
        (f64::NEG_INFINITY, -200.0),
        (-300.0, -200.0),
        (61.0, 60.0),
        (f64::INFINITY, 60.0),
    ] {
        assert_eq!(
            saturation_vapour_pressure_pa(t),
            saturation_vapour_pressure_pa(held),
            "{t}"
        );
    }
}

proptest! {
    #![proptest_config(config(256))]

    #[test]
    fn warmer_wetter_steeper_and_later_are_more(
        a in 0.0_f64..1.0, b in 0.0_f64..1.0, soil in 0_usize..45, film in 1e-6_f64..10.0,
    ) {
        let (low, high) = (a.min(b), a.max(b));
        let vapour = |share: f64| saturation_vapour_pressure_pa(260.0 * share - 200.0);
        prop_assert!(vapour(high) >= vapour(low));
        prop_assert!(relative_intensity(12.0 * high) >= relative_intensity(12.0 * low));
        let p = |slope| SurfaceProperties { slope, ..SurfaceClass::Asphalt.properties() };
        prop_assert!(p(high).drain_coefficient() >= p(low).drain_coefficient());
        let soil = soils()[soil];
        prop_assert!(soil.flooded_mm(1e5 * high) >= soil.flooded_mm(1e5 * low));
        prop_assert!(soil.capacity_mm_h(1e5 * high) <= soil.capacity_mm_h(1e5 * low));
        prop_assert!((soil.final_mm_h..=soil.initial_mm_h * (1.0 + 1e-15)).contains(&soil.capacity_mm_h(1e5 * a)));
        if low > 0.0 {
            prop_assert!(drying_time_s(film, low) >= drying_time_s(film, high));
        }
    }
}
