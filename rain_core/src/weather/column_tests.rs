//! Tests of the column against closed forms and an independent slow integration.

use proptest::prelude::*;

use super::super::horton::Infiltration;
use super::super::surface_class::SurfaceClass;
use super::*;

const RAIN: f64 = 36.0;

fn forcing(rain_mm_h: f64, evaporation_mm_h: f64) -> ColumnForcing {
    ColumnForcing {
        rain_mm_h,
        evaporation_mm_h,
    }
}

fn advanced(properties: &SurfaceProperties, spells: &[(f64, f64, f64)]) -> SurfaceColumn {
    let mut column = SurfaceColumn::default();
    for &(rain, evaporation, dt) in spells {
        column
            .advance(properties, forcing(rain, evaporation), dt)
            .expect("valid");
    }
    column
}

fn cut(properties: &SurfaceProperties, spells: &[(f64, f64, f64)], step_s: f64) -> SurfaceColumn {
    let mut column = SurfaceColumn::default();
    for &(rain, evaporation, dt) in spells {
        let n = (dt / step_s).ceil().max(1.0);
        let mut i = 0.0;
        while i < n {
            column
                .advance(properties, forcing(rain, evaporation), dt / n)
                .expect("valid");
            i += 1.0;
        }
    }
    column
}

fn amounts(column: &SurfaceColumn) -> [f64; 6] {
    let l = column.ledger();
    [
        l.pores_mm,
        l.film_mm,
        l.rain_mm,
        l.evaporated_mm,
        l.infiltrated_mm,
        l.drained_mm,
    ]
}

/// Relative to the amount, or to 1 µm where it is smaller.
fn assert_same(a: &SurfaceColumn, b: &SurfaceColumn, tolerance: f64, what: &str) {
    for (x, y) in amounts(a).into_iter().zip(amounts(b)) {
        assert!(
            (x - y).abs() <= tolerance * x.abs().max(1e-3),
            "{what}: {:?} {:?}",
            a.ledger(),
            b.ledger()
        );
    }
}

/// The same physics written a second time: one right-hand side with every limit as a branch, fourth-order Runge–Kutta
/// with a fixed step, no events. A step that ends in another branch than it began is done again in a thousand parts.
struct Slow<'a> {
    p: &'a SurfaceProperties,
    rain: f64,
    evaporation: f64,
}

/// Amounts in mm, in the order of [`amounts`], with Horton's τ at the end.
type Amounts = [f64; 7];

impl Slow<'_> {
    fn capacity(&self, tau: f64) -> f64 {
        let i = self.p.infiltration;
        if i.initial_mm_h == 0.0 {
            return 0.0;
        }
        (i.final_mm_h + (i.initial_mm_h - i.final_mm_h) * (-i.decay_per_h * tau / 3600.0).exp()) / 3600.0
    }

    fn branch(&self, y: &Amounts) -> u32 {
        let [pores, film, .., tau] = *y;
        let (r, e) = (self.rain, self.evaporation);
        let full = pores >= self.p.pore_capacity_mm - 1e-12;
        if film > self.p.texture_depth_mm {
            4
        } else if film > 1e-12 || (full && r - e > self.capacity(tau)) {
            3
        } else if full && r > e {
            2
        } else {
            u32::from(pores > 0.0 || r > e)
        }
    }

    fn rates(&self, branch: u32, y: &Amounts) -> Amounts {
        let (r, e) = (self.rain, self.evaporation);
        let tau = y[6];
        let i = self.p.infiltration;
        let decay = i.decay_per_h / 3600.0;
        let used = 1.0 - (-decay * tau).exp();
        // dτ/dt while nothing infiltrates: d(used)/dt = −recovery·used.
        let recovering = -i.recovery_per_s * used / (decay * (1.0 - used));
        match branch {
            0 => [0.0, 0.0, r, r, 0.0, 0.0, recovering],
            1 => [r - e, 0.0, r, e, 0.0, 0.0, recovering],
            2 => [0.0, 0.0, r, e, r - e, 0.0, (r - e) / self.capacity(tau)],
            _ => {
                let k_si = self.p.slope.sqrt() / (self.p.manning_n * self.p.flow_length_m);
                let above = ((y[1] - self.p.texture_depth_mm) * 1e-3).max(0.0);
                let drained = k_si * above.powf(5.0 / 3.0) * 1e3;
                let soaked = self.capacity(tau);
                [
                    0.0,
                    r - e - soaked - drained,
                    r,
                    e,
                    soaked,
                    drained,
                    f64::from(soaked > 0.0),
                ]
            }
        }
    }

    fn step(&self, y: &Amounts, h: f64) -> Amounts {
        let branch = self.branch(y);
        let shift = |k: &Amounts, h: f64| -> Amounts { std::array::from_fn(|i| y[i] + h * k[i]) };
        let k1 = self.rates(branch, y);
        let k2 = self.rates(branch, &shift(&k1, 0.5 * h));
        let k3 = self.rates(branch, &shift(&k2, 0.5 * h));
        let k4 = self.rates(branch, &shift(&k3, h));
        std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
    }

    /// What a step overshot goes where it belongs.
    fn settled(&self, mut y: Amounts) -> Amounts {
        if y[0] > self.p.pore_capacity_mm {
            y[1] += y[0] - self.p.pore_capacity_mm;
            y[0] = self.p.pore_capacity_mm;
        }
        if y[1] < 0.0 {
            y[0] += y[1];
            y[1] = 0.0;
        }
        if y[0] < 0.0 {
            y[3] += y[0];
            y[0] = 0.0;
        }
        y
    }

    fn run(&self, mut y: Amounts, dt: f64, steps: u32) -> Amounts {
        let h = dt / f64::from(steps);
        for _ in 0..steps {
            let next = self.settled(self.step(&y, h));
            if self.branch(&next) == self.branch(&y) {
                y = next;
            } else {
                for _ in 0..1000 {
                    y = self.settled(self.step(&y, h / 1000.0));
                }
            }
        }
        y
    }
}

fn slow(p: &SurfaceProperties, rain_mm_h: f64, evaporation_mm_h: f64, start: Amounts, dt: f64, h: f64) -> Amounts {
    let slow = Slow {
        p,
        rain: rain_mm_h / 3600.0,
        evaporation: evaporation_mm_h / 3600.0,
    };
    slow.run(start, dt, (dt / h).round() as u32)
}

#[test]
fn the_film_check_values_of_a_bare_plane() {
    // No pores to speak of, no texture: dh/dt = P − k h^(5/3) with k = 1.8856 s⁻¹m^(−2/3), P = 1e-5 m/s.
    let p = SurfaceProperties {
        pore_capacity_mm: 1e-6,
        texture_depth_mm: 0.0,
        manning_n: 0.015,
        slope: 0.02,
        flow_length_m: 5.0,
        infiltration: Infiltration::NONE,
    };
    let t = 60.0 + 1e-6 / (RAIN / 3600.0);
    let film = advanced(&p, &[(RAIN, 0.0, t)]).water_level_mm();
    // k is 1.885618 here and 1.8856 there.
    assert!((film - 0.462_084_741_8).abs() < 3e-6, "{film}");
    // Steady sheet flow at 50 mm/h on 5 m: .83239 mm; 25 mm/h with n = .011, S = .025 on 7.5 m: .54384 mm.
    assert!((advanced(&p, &[(50.0, 0.0, 1e4)]).water_level_mm() - 0.832_39).abs() < 5e-6);
    let q = SurfaceProperties {
        manning_n: 0.011,
        slope: 0.025,
        flow_length_m: 7.5,
        ..p
    };
    assert!((advanced(&q, &[(25.0, 0.0, 1e4)]).water_level_mm() - 0.543_84).abs() < 5e-6);
}

#[test]
fn pores_then_texture_then_film_and_back() {
    let p = SurfaceClass::Asphalt.properties();
    // 36 mm/h = 0.01 mm/s: pores (0.5 mm) full at 50 s, texture (0.8 mm) at 130 s.
    let at = |t: f64| advanced(&p, &[(RAIN, 0.0, t)]);
    assert!((at(25.0).wetness(&p) - 0.5).abs() < 1e-14 && at(25.0).water_level_mm() == 0.0);
    assert!((at(50.0).wetness(&p) - 1.0).abs() < 1e-14);
    assert!((at(90.0).water_level_mm() - 0.4).abs() < 1e-13 && at(90.0).film_above_texture_mm(&p) == 0.0);
    assert_eq!(at(129.0).ledger().drained_mm, 0.0);
    assert!(at(140.0).ledger().drained_mm > 0.0 && at(140.0).film_above_texture_mm(&p) > 0.0);
    // Drying at 3.6 mm/h = 0.001 mm/s: film 0.4 mm gone after 400 s, pores after 500 s more.
    let dry = |t: f64| advanced(&p, &[(RAIN, 0.0, 90.0), (0.0, 3.6, t)]);
    assert!((dry(100.0).water_level_mm() - 0.3).abs() < 1e-13 && dry(100.0).wetness(&p) == 1.0);
    assert!((dry(650.0).wetness(&p) - 0.5).abs() < 1e-12 && dry(650.0).water_level_mm() == 0.0);
    assert!(dry(900.1).is_dry() && dry(1e6).is_dry() && !dry(899.9).is_dry());
    assert!((dry(1e6).ledger().evaporated_mm - 0.9).abs() < 1e-14);
}

#[test]
fn rain_below_evaporation_leaves_the_ground_dry() {
    let c = advanced(&SurfaceClass::Stone.properties(), &[(1.0, 2.0, 7200.0)]);
    assert!(c.is_dry());
    assert!((c.ledger().evaporated_mm - 2.0).abs() < 1e-12, "only what fell");
}

#[test]
fn soil_takes_hortons_share() {
    // Bare of pores and texture, flat: the film is rain − F, F = 27.97509 mm after an hour at capacity.
    let soil = SurfaceProperties {
        pore_capacity_mm: 1e-6,
        slope: 0.0,
        ..SurfaceClass::Soil.properties()
    };
    let flooded = advanced(&soil, &[(100.0, 0.0, 3600.0)]).ledger();
    assert!((flooded.infiltrated_mm - 27.975_09).abs() < 1e-5, "{flooded:?}");
    assert!((flooded.film_mm - (100.0 - 1e-6 - flooded.infiltrated_mm)).abs() < 1e-9);
    // 10 mm/h is below f_c: all of it goes in, for ever.
    let light = advanced(&soil, &[(10.0, 0.0, 86_400.0)]).ledger();
    assert!((light.infiltrated_mm - (240.0 - 1e-6)).abs() < 1e-9 && light.film_mm == 0.0);
    // A pause uses nothing up: capacity advances with what infiltrated, and recovers slowly.
    let paused = advanced(&soil, &[(100.0, 0.0, 900.0), (0.0, 0.0, 3600.0), (100.0, 0.0, 60.0)]);
    assert!(paused.ledger().infiltrated_mm < advanced(&soil, &[(100.0, 0.0, 4560.0)]).ledger().infiltrated_mm);
}

#[test]
fn every_class_agrees_with_the_slow_integration() {
    let spells = [
        (70.0, 0.1, 200.0),
        (0.0, 2.0, 120.0),
        (300.0, 0.0, 60.0),
        (5.0, 30.0, 90.0),
        (20.0, 0.5, 64.0),
    ];
    for class in SurfaceClass::ALL {
        let p = class.properties();
        let mut column = SurfaceColumn::default();
        let mut y = [0.0; 7];
        for (rain, evaporation, dt) in spells {
            column.advance(&p, forcing(rain, evaporation), dt).expect("valid");
            y = slow(&p, rain, evaporation, y, dt, 1e-3);
            for (a, b) in amounts(&column).into_iter().zip(y) {
                // A kink inside a slow step costs it up to rate·step: 300 mm/h · 1e-4 s = 8e-6 mm, seen as 1e-6 of 1
                // mm.
                assert!(
                    (a - b).abs() <= 1e-6 * b.abs() + 1e-6,
                    "{class:?}: {:?} {y:?}",
                    column.ledger()
                );
            }
        }
    }
}

#[test]
fn the_slow_integration_notices_a_wrong_drain() {
    let p = SurfaceClass::Asphalt.properties();
    let wrong = SurfaceProperties {
        manning_n: 1.05 * p.manning_n,
        ..p
    };
    let right = advanced(&p, &[(70.0, 0.1, 300.0)]);
    let off = slow(&wrong, 70.0, 0.1, [0.0; 7], 300.0, 1e-3);
    assert!((right.water_level_mm() - off[1]).abs() > 1e-3 * off[1]);
}

#[test]
fn any_tick_from_a_millisecond_to_a_minute_ends_the_same() {
    let spells = [
        (40.0, 0.05, 240.0),
        (0.0, 1.0, 180.0),
        (500.0, 0.0, 60.0),
        (0.0, 0.3, 600.0),
        (13.5, 0.4, 240.0),
    ];
    for class in SurfaceClass::ALL {
        let p = class.properties();
        let whole = advanced(&p, &spells);
        let finest = if class == SurfaceClass::Grass {
            1e-3
        } else {
            1.0 / 144.0
        };
        for step in [finest, 1.0 / 60.0, 1.0 / 32.0, 1.0, 10.0, 60.0] {
            assert_same(&whole, &cut(&p, &spells, step), 1e-6, &format!("{class:?} at {step} s"));
        }
    }
}

#[test]
fn a_day_at_60_hz_does_not_drift() {
    // Showers and sun in turn, 5.2 million steps, against one step per spell.
    let spells: Vec<_> = (0..24)
        .map(|hour| {
            if hour % 3 == 0 {
                (8.0 + f64::from(hour), 0.05, 3600.0)
            } else {
                (0.0, 0.25, 3600.0)
            }
        })
        .collect();
    let p = SurfaceClass::Asphalt.properties();
    let whole = advanced(&p, &spells);
    let fine = cut(&p, &spells, 1.0 / 60.0);
    assert_same(&whole, &fine, 1e-6, "asphalt");
    assert!(fine.ledger().residual_relative() < 1e-12, "{:?}", fine.ledger());
    assert!((fine.ledger().rain_mm - spells.iter().map(|s| s.0).sum::<f64>()).abs() < 1e-9);
}

#[test]
fn refused_input_changes_nothing() {
    let p = SurfaceClass::Grass.properties();
    let start = advanced(&p, &[(70.0, 0.1, 200.0)]);
    let mut column = start;
    for (rain, evaporation, dt, field) in [
        (f64::NAN, 0.0, 1.0, "rain_mm_h"),
        (-1.0, 0.0, 1.0, "rain_mm_h"),
        (1e9, 0.0, 1.0, "rain_mm_h"),
        (1.0, -0.1, 1.0, "evaporation_mm_h"),
        (1.0, f64::INFINITY, 1.0, "evaporation_mm_h"),
        (1.0, 0.0, f64::NAN, "dt_s"),
        (1.0, 0.0, -1e-9, "dt_s"),
        (1.0, 0.0, 2e9, "dt_s"),
    ] {
        let message = column
            .advance(&p, forcing(rain, evaporation), dt)
            .expect_err("refused")
            .to_string();
        assert!(message.starts_with(field), "{message}");
    }
    let bad = SurfaceProperties {
        manning_n: f64::NAN,
        ..p
    };
    assert!(column.advance(&bad, forcing(1.0, 0.0), 1.0).is_err());
    column.advance(&p, forcing(99.0, 1.0), 0.0).expect("no-op");
    assert_eq!(column, start);
}

#[test]
fn a_restored_column_goes_on_alike_and_bad_ledgers_are_refused() {
    let p = SurfaceClass::Soil.properties();
    let mut a = advanced(&p, &[(90.0, 0.1, 700.0)]);
    let mut b = SurfaceColumn::restore(a.ledger(), &p).expect("closes");
    for column in [&mut a, &mut b] {
        column.advance(&p, forcing(20.0, 0.3), 500.0).expect("valid");
    }
    assert_same(&a, &b, 1e-12, "restored");
    let ledger = a.ledger();
    for bad in [
        ColumnLedger {
            pores_mm: 3.1,
            ..ledger
        },
        ColumnLedger {
            film_mm: -1.0,
            ..ledger
        },
        ColumnLedger {
            rain_mm: ledger.rain_mm + 0.1,
            ..ledger
        },
        ColumnLedger {
            drained_mm: f64::NAN,
            ..ledger
        },
    ] {
        assert!(SurfaceColumn::restore(bad, &p).is_err(), "{bad:?}");
    }
}

#[test]
fn a_changed_material_keeps_the_water() {
    let wet = advanced(&SurfaceClass::Stone.properties(), &[(50.0, 0.0, 60.0)]);
    let soil = SurfaceClass::Soil.properties();
    let mut column = wet;
    column.advance(&soil, forcing(0.0, 0.0), 1.0).expect("valid");
    assert_eq!(column.water_level_mm(), 0.0, "thirsty pores take the film");
    assert!((column.pores_mm() - wet.pores_mm() - wet.water_level_mm()).abs() < 1e-15);
    let roof = SurfaceClass::Roof.properties();
    column.advance(&roof, forcing(0.0, 0.0), 1.0).expect("valid");
    assert!(column.pores_mm() == roof.pore_capacity_mm && column.water_level_mm() > 0.0);
    assert!(column.ledger().residual_relative() < 1e-14);
}

fn any_properties() -> impl Strategy<Value = SurfaceProperties> {
    (
        0..SurfaceClass::COUNT,
        0.01_f64..3.0,
        0.0_f64..2.0,
        0.0_f64..0.5,
        0.0_f64..60.0,
        0.0_f64..120.0,
    )
        .prop_map(|(class, pores, texture, slope, low, extra)| {
            let p = SurfaceClass::ALL[class].properties();
            let infiltration = if p.infiltration.is_permeable() {
                Infiltration {
                    final_mm_h: low,
                    initial_mm_h: low + extra,
                    ..p.infiltration
                }
            } else {
                Infiltration::NONE
            };
            SurfaceProperties {
                pore_capacity_mm: pores,
                texture_depth_mm: texture,
                slope,
                infiltration,
                ..p
            }
        })
}

fn any_spells() -> impl Strategy<Value = Vec<(f64, f64, f64)>> {
    let rain = prop_oneof![2 => Just(0.0), 1 => Just(500.0), 1 => Just(1e-9), 4 => 0.0_f64..150.0];
    let evaporation = prop_oneof![1 => Just(0.0), 1 => 0.0_f64..200.0, 3 => 0.0_f64..2.0];
    let time = prop_oneof![1 => Just(0.0), 1 => Just(1e-3), 4 => 0.0_f64..600.0, 1 => 1e3_f64..1e6];
    prop::collection::vec((rain, evaporation, time), 1..8)
}

proptest! {
    #[test]
    fn bounded_and_conserving(p in any_properties(), spells in any_spells()) {
        let mut column = SurfaceColumn::default();
        let mut fallen = 0.0;
        for (rain, evaporation, dt) in spells {
            let before = column.ledger();
            column.advance(&p, forcing(rain, evaporation), dt).expect("valid");
            fallen += rain * dt / 3600.0;
            let l = column.ledger();
            prop_assert!(l.pores_mm >= 0.0 && l.pores_mm <= p.pore_capacity_mm, "{l:?}");
            prop_assert!(l.film_mm >= 0.0 && l.film_mm.is_finite(), "{l:?}");
            prop_assert!((0.0..=1.0).contains(&column.wetness(&p)));
            for (now, then) in [
                (l.evaporated_mm, before.evaporated_mm),
                (l.infiltrated_mm, before.infiltrated_mm),
                (l.drained_mm, before.drained_mm),
            ] {
                prop_assert!(now >= then - 1e-15 * (1.0 + then), "{l:?} {before:?}");
            }
            prop_assert!(l.residual_relative() <= 1e-12, "{l:?}");
            prop_assert!((l.rain_mm - fallen).abs() <= 1e-12 * fallen.max(1e-3), "{l:?} {fallen}");
            prop_assert!(SurfaceColumn::restore(l, &p).is_ok());
        }
    }

    #[test]
    fn cutting_changes_nothing(p in any_properties(), spells in any_spells(), cuts in 2_u32..200) {
        let whole = advanced(&p, &spells);
        let mut parts = SurfaceColumn::default();
        for &(rain, evaporation, dt) in &spells {
            for _ in 0..cuts {
                parts.advance(&p, forcing(rain, evaporation), dt / f64::from(cuts)).expect("valid");
            }
        }
        let scale = whole.ledger().rain_mm;
        for (a, b) in amounts(&whole).into_iter().zip(amounts(&parts)) {
            // Stored water to 1e-6 of itself; sums to 1e-6 of the rain.
            prop_assert!((a - b).abs() <= 1e-6 * a.abs().max(1e-3) || (a - b).abs() <= 1e-9 * scale,
                "{:?} {:?}", whole.ledger(), parts.ledger());
        }
    }

    #[test]
    fn more_rain_never_leaves_less_water(
        p in any_properties(), spells in any_spells(), factor in 1.0_f64..3.0,
    ) {
        let more: Vec<_> = spells.iter().map(|&(r, e, dt)| (r * factor, e, dt)).collect();
        let (a, b) = (advanced(&p, &spells).ledger(), advanced(&p, &more).ledger());
        let slack = 1e-9 * (1.0 + b.rain_mm);
        prop_assert!(b.evaporated_mm >= a.evaporated_mm - slack);
        if !p.infiltration.is_permeable() {
            prop_assert!(b.pores_mm >= a.pores_mm - slack && b.film_mm >= a.film_mm - slack);
            prop_assert!(b.drained_mm >= a.drained_mm - slack);
        }
    }
}
