//! Weather state: pores and film, Horton, Penman, artists' levels, timelines.

mod closed_forms;

use glam::DVec3;
use proptest::prelude::*;
use rain_core::rainfall::Distribution;
use rain_core::weather::{
    ArtistLaw, ArtistLevel, ArtistSettings, ArtistState, ColumnForcing, Infiltration, Keyframe, MAX_INTERVAL_S,
    SurfaceClass, SurfaceColumn, SurfaceProperties, Timeline, Transition, WeatherConditions, WeatherSurfaces,
    dalton_evaporation_mm_h, dew_point_c, drying_time_s, penman_evaporation_mm_h, relative_intensity,
    saturation_vapour_pressure_pa,
};
use rain_reference::weather as truth;

use crate::check::Worst;

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(13),
        ..ProptestConfig::with_cases(cases)
    }
}

fn ground(p: &SurfaceProperties) -> truth::Ground {
    truth::Ground {
        pores_mm: p.pore_capacity_mm,
        texture_mm: p.texture_depth_mm,
        manning_n: p.manning_n,
        slope: p.slope,
        length_m: p.flow_length_m,
        initial_mm_h: p.infiltration.initial_mm_h,
        final_mm_h: p.infiltration.final_mm_h,
        decay_per_h: p.infiltration.decay_per_h,
        recovery_per_s: p.infiltration.recovery_per_s,
    }
}

/// Rain mm/h, evaporation mm/h, seconds.
type Spell = (f64, f64, f64);

fn amounts(column: &SurfaceColumn) -> [f64; 7] {
    let l = column.ledger();
    [
        l.pores_mm,
        l.film_mm,
        l.rain_mm,
        l.evaporated_mm,
        l.infiltrated_mm,
        l.drained_mm,
        l.horton_time_s,
    ]
}

fn advanced(p: &SurfaceProperties, spells: &[Spell], cuts: u32) -> SurfaceColumn {
    let mut column = SurfaceColumn::default();
    for &(rain_mm_h, evaporation_mm_h, seconds) in spells {
        let forcing = ColumnForcing {
            rain_mm_h,
            evaporation_mm_h,
        };
        for _ in 0..cuts {
            column.advance(p, forcing, seconds / f64::from(cuts)).expect("valid");
        }
    }
    column
}

/// A spread of surfaces: every class, and each property at the ends of what ground has.
fn surfaces() -> Vec<SurfaceProperties> {
    let mut all: Vec<_> = SurfaceClass::ALL.map(SurfaceClass::properties).to_vec();
    for base in [SurfaceClass::Asphalt, SurfaceClass::Grass] {
        let p = base.properties();
        all.extend([
            SurfaceProperties {
                pore_capacity_mm: 1e-6,
                texture_depth_mm: 0.0,
                ..p
            },
            SurfaceProperties { slope: 0.0, ..p },
            SurfaceProperties {
                slope: 2.0,
                flow_length_m: 0.1,
                manning_n: 0.005,
                ..p
            },
            SurfaceProperties {
                pore_capacity_mm: 20.0,
                texture_depth_mm: 6.0,
                manning_n: 0.4,
                flow_length_m: 80.0,
                ..p
            },
        ]);
    }
    all
}

const STORMS: [&[Spell]; 3] = [
    &[
        (70.0, 0.1, 200.0),
        (0.0, 2.0, 120.0),
        (300.0, 0.0, 60.0),
        (5.0, 30.0, 90.0),
        (20.0, 0.5, 64.0),
    ],
    &[(12.0, 0.05, 600.0), (0.0, 0.4, 900.0), (3.0, 0.1, 300.0)],
    &[
        (2000.0, 0.0, 40.0),
        (0.0, 9000.0, 3.0),
        (0.5, 1.0, 100.0),
        (160.0, 0.0, 200.0),
        (0.0, 0.0, 300.0),
    ],
];

#[test]
fn the_column_is_the_stepped_one_on_every_surface_in_every_storm() {
    let (mut worst, mut wrong) = (Worst::default(), Worst::default());
    for p in surfaces() {
        // Steps short against the time in which a film drains.
        let step = if p.flow_length_m < 1.0 { 0.005 } else { 0.05 };
        for storm in STORMS {
            let mut slow: truth::Water = [0.0; 7];
            for (n, &(rain, evaporation, seconds)) in storm.iter().enumerate() {
                slow = ground(&p).advanced(slow, rain, evaporation, seconds, step);
                let fast = amounts(&advanced(&p, &storm[..=n], 1));
                let off = amounts(&advanced(
                    &SurfaceProperties {
                        manning_n: 1.05 * p.manning_n,
                        ..p
                    },
                    &storm[..=n],
                    1,
                ));
                for i in 0..7 {
                    worst.relative(fast[i], slow[i], 1e-2, || format!("{i} of {p:?}, {storm:?} {n}"));
                    wrong.relative(off[i], slow[i], 1e-2, String::new);
                }
            }
        }
    }
    // Relative, or 1e-8 mm.
    worst.assert_below(1e-6, 1300);
    assert!(wrong.error > 1e-2, "a Manning's n 5 % off goes unseen");
}

#[test]
fn a_column_ends_the_same_for_any_step_from_a_millisecond_to_an_hour() {
    let all = [(8.0, 0.05, 3600.0), (0.0, 0.3, 3600.0), (45.0, 0.0, 3600.0)];
    for class in SurfaceClass::ALL {
        let p = class.properties();
        // A millisecond for the soil, from dry to a flowing film.
        let spells = if class == SurfaceClass::Soil { &all[2..] } else { &all };
        let hourly = amounts(&advanced(&p, spells, 1));
        let steps: &[u32] = match class {
            SurfaceClass::Soil => &[3_600_000, 216_000, 60],
            SurfaceClass::Asphalt => &[216_000, 60],
            _ => &[3600, 60],
        };
        for &cuts in steps {
            let mut worst = Worst::default();
            for (a, b) in amounts(&advanced(&p, spells, cuts)).into_iter().zip(hourly) {
                worst.relative(a, b, 1e-2, || format!("{class:?}, {cuts} steps an hour"));
            }
            worst.assert_below(1e-10, 7);
        }
    }
}

proptest! {
    #![proptest_config(config(64))]

    #[test]
    fn a_column_keeps_its_water_and_its_bounds(
        class in 0..SurfaceClass::COUNT,
        slope in 0.0_f64..1.0,
        pores in 1e-4_f64..5.0,
        texture in 0.0_f64..3.0,
        spells in prop::collection::vec((0.0_f64..300.0, 0.0_f64..5.0, 0.0_f64..5000.0), 1..8),
        cuts in 1_u32..5,
    ) {
        let p = SurfaceProperties {
            slope,
            pore_capacity_mm: pores,
            texture_depth_mm: texture,
            ..SurfaceClass::ALL[class].properties()
        };
        let column = advanced(&p, &spells, cuts);
        prop_assert!(column.ledger().residual_relative() < 1e-14, "{:?}", column.ledger());
        prop_assert!((0.0..=1.0).contains(&column.wetness(&p)));
        prop_assert!(amounts(&column).iter().all(|a| a.is_finite() && *a >= 0.0));
        let fell: f64 = spells.iter().map(|s| s.0 * s.2 / 3600.0).sum();
        prop_assert!((column.ledger().rain_mm - fell).abs() <= 1e-12 * fell);
        let film = advanced(&p, &spells, 1).water_level_mm();
        prop_assert!((film - column.water_level_mm()).abs() <= 1e-10 * film.max(1e-2));
    }
}

#[test]
fn an_update_of_the_weather_allocates_nothing() {
    let mut surfaces = WeatherSurfaces::default();
    let mut conditions = WeatherConditions::with_intensity(30.0).expect("valid");
    let timeline = Timeline::new(vec![
        Keyframe {
            time_s: 0.0,
            conditions,
            transition: Transition::Linear,
        },
        Keyframe {
            time_s: 100.0,
            conditions: WeatherConditions::default(),
            transition: Transition::Hold,
        },
    ])
    .expect("valid");
    let info = allocation_counter::measure(|| {
        for i in 0..200 {
            conditions.intensity_mm_h = f64::from(i % 3) * 20.0;
            surfaces.advance(&conditions, 0.5).expect("valid");
            let t = f64::from(i);
            surfaces.advance_along(&timeline, t, t + 1.0).expect("valid");
        }
    });
    assert_eq!(info.count_total, 0);
    assert!(surfaces.rain_mm() > 0.5);
    let seen = allocation_counter::measure(|| drop(std::hint::black_box(vec![1_u8; 9])));
    assert_eq!(seen.count_total, 1, "the counter counts");
}

fn soils() -> [Infiltration; 3] {
    let soil = |initial_mm_h, final_mm_h, decay_per_h| Infiltration {
        initial_mm_h,
        final_mm_h,
        decay_per_h,
        recovery_per_s: 0.0,
    };
    [soil(76.0, 13.0, 4.14), soil(254.0, 0.5, 1.0), soil(9000.0, 1.0, 100.0)]
}

#[test]
fn horton_has_its_check_values_and_is_the_stepped_curve() {
    let [loam, ..] = soils();
    for (hours, rate, depth) in [(0.25, 35.379_26, 13.061_77), (1.0, 14.003_14, 27.975_09)] {
        assert!((loam.capacity_mm_h(3600.0 * hours) - rate).abs() < 5.1e-6);
        assert!((loam.flooded_mm(3600.0 * hours) - depth).abs() < 5.1e-6);
    }
    let (mut depth, mut ponding, mut wrong) = (Worst::default(), Worst::default(), Worst::default());
    for soil in soils() {
        let bare = SurfaceProperties {
            infiltration: soil,
            ..SurfaceClass::Soil.properties()
        };
        let slow = ground(&bare);
        for t in [1.0, 60.0, 900.0, 20_000.0] {
            let sum = rain_reference::numerics::simpson(0.0, t, 20_000, |tau| slow.capacity_mm_s(tau));
            depth.relative(soil.flooded_mm(t), sum, 0.0, || format!("{soil:?} {t}"));
            wrong.relative(soil.flooded_mm(1.05 * t), sum, 0.0, String::new);
        }
        for share in [0.02, 0.3, 0.9] {
            let rain = soil.final_mm_h + share * (soil.initial_mm_h - soil.final_mm_h);
            let found = soil.ponding_time_s(rain).expect("ponds");
            ponding.relative(found, slow.ponding_time_s(rain, found / 20_000.5), 0.0, || {
                format!("{soil:?} {share}")
            });
        }
        assert_eq!(soil.ponding_time_s(soil.final_mm_h), None);
        assert_eq!(soil.ponding_time_s(2.0 * soil.initial_mm_h), Some(0.0));
        for any in [f64::NAN, f64::NEG_INFINITY, -1.0, 0.0] {
            assert_eq!((soil.flooded_mm(any), soil.ponding_time_s(any)), (0.0, None));
            assert_eq!(soil.capacity_mm_h(any), soil.initial_mm_h);
        }
        assert!(soil.flooded_mm(f64::INFINITY).is_finite() && soil.capacity_mm_h(f64::INFINITY) == soil.final_mm_h);
        assert_eq!(soil.ponding_time_s(f64::INFINITY), Some(0.0));
    }
    // Simpson's rule over a curve that is gone after a hundredth of the span.
    depth.assert_below(1e-9, 12);
    ponding.assert_below(1e-7, 9);
    assert!(wrong.error > 0.02, "a time 5 % off goes unseen");
}

fn air(t: f64, humidity: f64, wind: f64, net: f64, pressure_pa: f64) -> WeatherConditions {
    WeatherConditions {
        air_temperature_c: t,
        relative_humidity: humidity,
        wind_m_s: DVec3::new(0.6 * wind, 0.0, 0.8 * wind),
        net_radiation_w_m2: net,
        pressure_pa,
        ..WeatherConditions::default()
    }
}

#[test]
fn evaporation_has_its_check_values() {
    for (t, humidity, wind, net, rate, minutes) in [
        (30.0, 0.30, 4.0, 700.0, 1.032_73, Some(5.8)),
        (25.0, 0.40, 3.0, 500.0, 0.685_35, Some(8.8)),
        (15.0, 0.70, 2.0, 250.0, 0.270_84, Some(22.0)),
        (20.0, 0.60, 2.0, 0.0, 0.066_44, Some(90.0)),
        (10.0, 0.85, 1.0, 60.0, 0.062_01, Some(97.0)),
        (12.0, 0.93, 1.0, -10.0, -0.001_65, None),
    ] {
        let e = penman_evaporation_mm_h(&air(t, humidity, wind, net, 101_325.0));
        assert!((e - rate).abs() < 5.1e-6, "{t}: {e}");
        match (drying_time_s(0.1, e), minutes) {
            (None, None) => {}
            (Some(s), Some(expected)) => assert!((s / 60.0 - expected).abs() < 0.5, "{t}: {s}"),
            other => panic!("{t}: {other:?}"),
        }
    }
}

#[test]
fn evaporation_is_penmans_and_daltons_over_the_domain() {
    let (mut penman, mut dalton, mut dew, mut wrong) =
        (Worst::default(), Worst::default(), Worst::default(), Worst::default());
    for t in [-60.0, -20.0, 0.0, 13.0, 35.0, 60.0] {
        for humidity in [0.0, 0.2, 0.6, 0.95, 1.0] {
            for wind in [0.0, 2.0, 80.0] {
                for net in [-300.0, 0.0, 400.0, 1400.0] {
                    for pressure in [30_000.0, 101_325.0, 110_000.0] {
                        let c = air(t, humidity, wind, net, pressure);
                        let place = || format!("{t} {humidity} {wind} {net} {pressure}");
                        let exact = truth::penman_mm_h(t, humidity, wind, net, pressure);
                        penman.relative(penman_evaporation_mm_h(&c), exact, 1e-3, place);
                        wrong.relative(
                            penman_evaporation_mm_h(&air(t, humidity, 1.05 * wind.min(70.0), net, pressure)),
                            exact,
                            1e-3,
                            place,
                        );
                        let exact = truth::dalton_mm_day(t, humidity, wind) / 24.0;
                        dalton.relative(dalton_evaporation_mm_h(&c), exact, 1e-3, place);
                    }
                }
            }
            if humidity > 0.0 {
                dew.absolute(dew_point_c(t, humidity), truth::dew_point_c(t, humidity), || {
                    format!("{t} {humidity}")
                });
                let back = saturation_vapour_pressure_pa(dew_point_c(t, humidity));
                assert!((back / (humidity * saturation_vapour_pressure_pa(t)) - 1.0).abs() < 1e-12);
            }
        }
    }
    penman.assert_below(3e-9, 1000); // the reference's slope by differences
    dalton.assert_below(1e-14, 1000);
    dew.assert_below(1e-12, 24);
    assert!(wrong.error > 0.02, "a wind 5 % off goes unseen");
    for any in [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        -243.5,
        -244.0,
        -1.0,
        0.0,
        1e300,
    ] {
        let pressure = saturation_vapour_pressure_pa(any);
        assert!((0.0..2.1e4).contains(&pressure), "{any} °C: {pressure}");
        assert!(
            dew_point_c(any, 0.5).is_finite() && dew_point_c(15.0, any).is_finite(),
            "{any}"
        );
        assert!(drying_time_s(any, 0.1).is_some_and(|s| s.is_finite() && s >= 0.0));
        assert!(drying_time_s(0.1, any).is_none_or(|s| s.is_finite() && s >= 0.0));
    }
    assert_eq!(
        (
            drying_time_s(0.1, 0.0),
            drying_time_s(0.1, f64::NAN),
            drying_time_s(0.0, -1.0)
        ),
        (None, None, Some(0.0))
    );
}

/// Level settings as the reference takes them.
fn slow_artist(settings: &ArtistSettings) -> truth::Artist {
    let level = |l: ArtistLevel| truth::Level {
        rise: l.rise_per_s,
        fall: l.fall_per_s,
        target: l.target,
    };
    truth::Artist {
        exponential: settings.law == ArtistLaw::Exponential,
        levels: [level(settings.wetness), level(settings.holes), level(settings.puddles)],
        gate: settings.flood_gate,
        drizzle_mm_h: settings.drizzle_mm_h,
        delay_s: settings.drying_delay_s,
    }
}

fn levels(state: &ArtistState) -> [f64; 3] {
    [state.wetness, state.holes, state.puddles]
}

fn after(settings: &ArtistSettings, spells: &[(f64, f64)], step_s: f64) -> ArtistState {
    let mut state = ArtistState::default();
    for &(rain, seconds) in spells {
        for _ in 0..(seconds / step_s).round().max(1.0) as u32 {
            state.advance(settings, rain, step_s.min(seconds)).expect("valid");
        }
    }
    state
}

/// Both sources' ways, and both laws with a low target and their speeds a thousandth, so that an hour is short.
fn ways() -> [ArtistSettings; 4] {
    let slowed = |s: ArtistSettings| {
        let slow = |l: ArtistLevel| ArtistLevel {
            rise_per_s: l.rise_per_s.map(|v| v * 1e-3),
            fall_per_s: l.fall_per_s * 1e-3,
            target: 0.9 * l.target,
        };
        ArtistSettings {
            wetness: slow(s.wetness),
            holes: slow(s.holes),
            puddles: slow(s.puddles),
            drying_delay_s: 1000.0 * s.drying_delay_s.min(0.5),
            ..s
        }
    };
    let (e, c) = (ArtistSettings::dynamic_rain(), ArtistSettings::traffic());
    [e, c, slowed(e), slowed(c)]
}

#[test]
fn the_artists_levels_are_the_stepped_ones() {
    let (mut worst, mut wrong) = (Worst::default(), Worst::default());
    for (settings, scale) in ways().into_iter().zip([1.0, 1.0, 1000.0, 1000.0]) {
        for spells in [
            &[(2.0, 0.6), (0.0, 2.0), (7.0, 0.7), (0.0, 9.0)][..],
            &[(0.4, 1.0), (5.0, 0.9), (0.0, 5.5), (12.0, 0.3)],
            &[(3.3, 4.0), (0.0, 8.0)],
        ] {
            let spells: Vec<_> = spells.iter().map(|&(rain, t)| (rain, t * scale)).collect();
            let mut slow = [0.0; 4];
            for n in 0..spells.len() {
                let (rain, seconds) = spells[n];
                slow = slow_artist(&settings).advanced(slow, rain, seconds, 1e-4 * scale);
                let state = after(&settings, &spells[..=n], f64::INFINITY);
                let off: Vec<_> = spells[..=n].iter().map(|&(rain, t)| (1.05 * rain, t)).collect();
                let shifted = levels(&after(&settings, &off, f64::INFINITY));
                for (i, &exact) in slow[..3].iter().enumerate() {
                    worst.absolute(levels(&state)[i], exact, || {
                        format!("{i} of {settings:?} {spells:?} {n}")
                    });
                    wrong.absolute(shifted[i], exact, String::new);
                }
            }
        }
    }
    // One of the reference's steps late at the gate and at the delay; levels below 1e-4 count as 0.
    worst.assert_below(1.1e-4, 120);
    assert!(wrong.error > 3e-3, "a rain 5 % off goes unseen");
}

#[test]
fn the_artists_levels_end_the_same_for_any_step_from_a_millisecond_to_an_hour() {
    let hours = [
        (4.0, 3600.0),
        (0.0, 3600.0),
        (9.0, 3600.0),
        (0.0, 3600.0),
        (1.0, 3600.0),
    ];
    for settings in ways() {
        for n in 1..=hours.len() {
            let whole = levels(&after(&settings, &hours[..n], 3600.0));
            // A millisecond once for each law, through rise and fall.
            let steps: &[f64] = match n {
                2 if settings.wetness.target < 1.0 => &[1e-3, 60.0],
                5 => &[1.0 / 60.0, 1.0],
                _ => &[1.0, 60.0],
            };
            for &step in steps {
                let mut worst = Worst::default();
                for (a, b) in levels(&after(&settings, &hours[..n], step)).into_iter().zip(whole) {
                    // Either may just have passed 1e-4, below which a level counts as gone.
                    if a.max(b) > 1.001e-4 {
                        worst.absolute(a, b, || format!("{settings:?}, {n} hours, step {step}"));
                    }
                }
                // 3.6 million roundings an hour.
                worst.assert_below(1e-9, 0);
            }
        }
    }
    assert!(
        levels(&after(&ways()[2], &hours[..3], 60.0))
            .iter()
            .all(|l| *l > 0.01 && *l <= 0.9),
        "a test of nothing"
    );
    // The rows of table T3, and its intensities.
    assert_eq!([2.0, 5.0, 10.0].map(relative_intensity), [0.33, 0.66, 1.0]);
}

proptest! {
    #![proptest_config(config(128))]

    #[test]
    fn the_artists_levels_stay_in_bounds_and_rise_with_rain(
        way in 0_usize..4,
        spells in prop::collection::vec((prop_oneof![Just(0.0), 0.0_f64..500.0], 0.0_f64..1e5), 1..6),
        more in 0.0_f64..100.0,
    ) {
        let settings = ways()[way];
        let state = after(&settings, &spells, f64::INFINITY);
        for (level, how) in levels(&state).into_iter().zip([settings.wetness, settings.holes, settings.puddles]) {
            prop_assert!((0.0..=how.target).contains(&level), "{state:?}");
        }
        let (mut wetter, mut drier) = (state, state);
        wetter.advance(&settings, 10.0 + more, 3.0).expect("valid");
        drier.advance(&settings, 10.0, 3.0).expect("valid");
        for (a, b) in levels(&wetter).into_iter().zip(levels(&drier)) {
            prop_assert!(a >= b - 1e-15);
        }
    }

    #[test]
    fn timeline_means_are_sums_of_trapezia(
        steps in prop::collection::vec((0.01_f64..500.0, 0.0_f64..500.0, -30.0_f64..40.0, any::<bool>()), 1..10),
        start in -100.0_f64..1000.0,
        length in 1e-3_f64..2000.0,
    ) {
        let mut time_s = 0.0;
        let (mut keys, mut rain, mut heat) = (Vec::new(), Vec::new(), Vec::new());
        for (gap, intensity_mm_h, air_temperature_c, hold) in steps {
            time_s += gap;
            rain.push((time_s, intensity_mm_h, hold));
            heat.push((time_s, air_temperature_c, hold));
            keys.push(Keyframe {
                time_s,
                conditions: WeatherConditions {
                    intensity_mm_h,
                    air_temperature_c,
                    wind_m_s: DVec3::new(0.1 * air_temperature_c, 0.0, 1.0),
                    distribution: Distribution::MarshallPalmer,
                    ..WeatherConditions::default()
                },
                transition: if hold { Transition::Hold } else { Transition::Linear },
            });
        }
        let timeline = Timeline::new(keys).expect("valid");
        let end = start + length;
        let mean = timeline.mean_conditions(start, end).expect("valid");
        let (wet, warm) = (truth::mean_along(&rain, start, end), truth::mean_along(&heat, start, end));
        prop_assert!((mean.intensity_mm_h - wet).abs() <= 1e-9 * wet.max(1.0), "{mean:?} {wet}");
        prop_assert!((timeline.mean_intensity_mm_h(start, end).expect("valid") - wet).abs() <= 1e-9 * wet.max(1.0));
        prop_assert!((mean.air_temperature_c - warm).abs() <= 1e-9 * 40.0, "{mean:?} {warm}");
        for t in [start, 0.5 * (start + end), end] {
            let now = timeline.at(t).expect("valid");
            let (wet, warm) = (truth::value_along(&rain, t), truth::value_along(&heat, t));
            prop_assert!((now.intensity_mm_h - wet).abs() <= 1e-12 * 500.0, "{now:?} {wet}");
            prop_assert!((now.air_temperature_c - warm).abs() <= 1e-12 * 40.0, "{now:?} {warm}");
        }
        let path = timeline.wind_path_m(start, end).expect("valid");
        prop_assert!((path.x - 0.1 * warm * length).abs() <= 1e-8 * length && (path.z - length).abs() <= 1e-9 * length.max(1.0));
    }
}

#[test]
fn the_longest_interval_is_taken_and_a_longer_one_refused() {
    for class in SurfaceClass::ALL {
        let p = class.properties();
        let forcing = ColumnForcing {
            rain_mm_h: 10.0,
            evaporation_mm_h: 0.2,
        };
        let mut column = SurfaceColumn::default();
        column.advance(&p, forcing, MAX_INTERVAL_S).expect("valid");
        assert!(
            column.ledger().residual_relative() < 1e-12 && column.water_level_mm().is_finite(),
            "{class:?}"
        );
        assert!(column.advance(&p, forcing, 1.001 * MAX_INTERVAL_S).is_err());
    }
}
