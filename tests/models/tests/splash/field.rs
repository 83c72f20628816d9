//! The field of splashes that are drawn: counts, sizes, shares and anchors.

use glam::{DVec3, IVec2, Vec3};
use rain_core::rainfall::{CLASS_COUNT, SizeClass, terminal_velocity, terminal_velocity_f32};
use rain_core::splash::{
    ImpactFlux, SPLASH_CELL_M, SPLASH_SLOT_S, SPLASH_SLOTS, SecondaryDrop, SplashAnchor, SplashExtent, SplashField,
    SplashMark, SplashShares, crown_life_s, crown_opacity, crown_seen_s, splash_excess,
};
use rain_reference::hash as words;
use rain_reference::hash::{chi_squared_of_pairs, correlation};
use rain_reference::numerics::simpson;
use rain_reference::splash as reference;

use super::spectrum;
use crate::check::Worst;

const EXTENT: SplashExtent = SplashExtent {
    reach_m: 12.0,
    near_m: 3.0,
    angle_rad: 1.6,
    exposure_s: 1.0 / 60.0,
    film_mm: 0.0,
};

/// Every impact in `cells` × `cells` cells during `slots` slots.
fn marks(field: &SplashField, cells: i32, slots: u32) -> Vec<SplashMark> {
    let mut all = Vec::new();
    for slot in 0..slots {
        for x in 0..cells {
            for z in 0..cells {
                field.for_each(IVec2::new(x - 7, z - 900), slot, |mark| all.push(mark));
            }
        }
    }
    all
}

/// Area and time of them. Units: m² s.
fn area_time(cells: i32, slots: u32) -> f64 {
    (f64::from(cells) * SPLASH_CELL_M).powi(2) * f64::from(slots) * SPLASH_SLOT_S
}

#[test]
fn impacts_per_area_are_those_of_the_distribution() {
    for rain in [5.0, 25.0, 100.0] {
        let spectrum = spectrum(rain);
        let field = SplashField::new(7, &spectrum, &SplashShares::all(&spectrum));
        let expected = ImpactFlux::level(&spectrum, 0.5, 6.0).number_per_m2_s;
        let mean = field.mean / (SPLASH_CELL_M.powi(2) * SPLASH_SLOT_S);
        assert!(
            (mean / expected - 1.0).abs() < 1e-6,
            "{rain} mm/h: {mean}, not {expected}"
        );
        let all = marks(&field, 40, 60);
        let found = all.len() as f64 / area_time(40, 60);
        assert!(
            (found / expected - 1.0).abs() < 0.02,
            "{rain} mm/h: {found}, not {expected}"
        );
        for (k, class) in SizeClass::all().iter().enumerate() {
            let flux = ImpactFlux::level(&spectrum, class.min_mm, class.max_mm);
            let of_class: Vec<&SplashMark> = all.iter().filter(|mark| mark.class == k as u32).collect();
            let expected = flux.number_per_m2_s * area_time(40, 60);
            let spread = 5.0 * expected.sqrt();
            assert!(
                (of_class.len() as f64 - expected).abs() < spread,
                "{rain} mm/h, class {k}"
            );
            let range = class.min_mm as f32 - 1e-5..=class.max_mm as f32 + 1e-5;
            assert!(of_class.iter().all(|mark| range.contains(&mark.diameter_mm)));
            if expected > 10_000.0 {
                // Water that arrives, with the numbers that arrived: the mean cube of the diameters.
                let cube = |d: f64| d.powi(3);
                let mean = of_class.iter().map(|m| cube(f64::from(m.diameter_mm))).sum::<f64>() / of_class.len() as f64;
                let known = flux.water_mm_h / 3.6e6 / flux.number_per_m2_s / (std::f64::consts::PI / 6.0) * 1e9;
                assert!(
                    (mean / known - 1.0).abs() < 0.01,
                    "{rain} mm/h, class {k}: {mean}, not {known}"
                );
            }
        }
    }
}

#[test]
fn impacts_of_the_field_are_those_of_the_words() {
    let spectrum = spectrum(25.0);
    let shares = SplashShares::for_budget(&spectrum, &EXTENT, 3000.0);
    let mut compared = 0;
    for seed in [0_u64, 7, u64::MAX] {
        let field = SplashField::new(seed, &spectrum, &shares);
        let stream = words::pcg3d([seed as u32, (seed >> 32) as u32, 0x7370_6c73]);
        for cell in [IVec2::ZERO, IVec2::new(-1, 5), IVec2::new(i32::MIN, i32::MAX)] {
            for slot in [0, 5, u32::MAX] {
                let key = words::pcg3d([stream[0] ^ cell.x as u32, stream[1] ^ cell.y as u32, stream[2] ^ slot]);
                let chance = f64::from(key[0]) / 4_294_967_296.0;
                let mut below = 0.0;
                let known = (0..).take_while(|&n| {
                    below += reference::poisson(field.mean, n);
                    below <= chance
                });
                let known = known.count();
                let mut found = Vec::new();
                field.for_each(cell, slot, |mark| found.push(mark));
                assert_eq!(found.len(), known, "{seed} {cell} {slot}");
                for mark in found {
                    let share = shares.share(mark.class as usize);
                    assert!((f64::from(mark.weight) * share - 1.0).abs() < 1e-6);
                    assert!((0.1..=0.3).contains(&mark.life_s));
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 20, "{compared}");
}

#[test]
fn impacts_of_the_field_are_poisson_and_even() {
    let spectrum = spectrum(25.0);
    let field = SplashField::new(3, &spectrum, &SplashShares::all(&spectrum));
    let (mut sum, mut square, mut cells) = (0.0, 0.0, 0.0);
    let mut found: Vec<SplashMark> = Vec::new();
    for n in 0..20_000_u32 {
        let mut count = 0.0;
        field.for_each(IVec2::new((n % 141) as i32, (n / 141) as i32), n % 11, |mark| {
            count += 1.0;
            found.push(mark);
        });
        sum += count;
        square += count * count;
        cells += 1.0;
    }
    let mean: f64 = sum / cells;
    let ratio = (square / cells - mean * mean) / mean;
    // The ratio's own spread over 20 000 cells is 1 %.
    assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
    assert!((mean - field.mean).abs() < 5.0 * (field.mean / cells).sqrt(), "{mean}");
    let number = |of: &dyn Fn(&SplashMark) -> f32| found.iter().map(|m| f64::from(of(m))).collect::<Vec<_>>();
    let (x, z) = (number(&|m| m.place[0]), number(&|m| m.place[1]));
    let (t, d) = (number(&|m| m.moment), number(&|m| m.diameter_mm));
    let life = number(&|m| (m.life_s - 0.1) * 4.999);
    let pair = |a: &[f64], b: &[f64]| a.iter().copied().zip(b.iter().copied()).collect::<Vec<_>>();
    let even = 5.0 * (2.0_f64 / 255.0).sqrt();
    for (a, b) in [(&x, &z), (&t, &life)] {
        let chi = chi_squared_of_pairs(pair(a, b), 16);
        assert!((chi - 1.0).abs() < even, "{chi}");
    }
    let most = 5.0 / (x.len() as f64).sqrt();
    for (a, b) in [(&x, &t), (&x, &d), (&t, &d)] {
        assert!(correlation(&pair(a, b)).abs() < most);
    }
}

#[test]
fn heavier_rain_keeps_the_splashes_of_lighter_rain() {
    let (light, heavy) = (spectrum(5.0), spectrum(25.0));
    let field = |spectrum| SplashField::new(3, spectrum, &SplashShares::all(spectrum));
    let (light, heavy) = (field(&light), field(&heavy));
    for n in 0..500_u32 {
        let places = |field: &SplashField| {
            let mut places = Vec::new();
            field.for_each(IVec2::new(n as i32, 3), n, |mark| {
                places.push((mark.place, mark.moment))
            });
            places
        };
        let (few, many) = (places(&light), places(&heavy));
        assert_eq!(many[..few.len()], few[..], "{n}");
    }
}

#[test]
fn a_budget_is_met_and_the_light_is_kept() {
    let spectrum = spectrum(25.0);
    let all = SplashShares::for_budget(&spectrum, &EXTENT, 1e9);
    let whole = all.expected_parts(&EXTENT);
    assert!((1..CLASS_COUNT).all(|k| (all.share(k) - 1.0).abs() < 1e-12));
    // None below 0.689 mm splashes, on dry ground either.
    assert_eq!(all.share(0), 0.0);
    for budget in [100.0, 1000.0, 5000.0] {
        assert!(budget < whole, "{whole}");
        let shares = SplashShares::for_budget(&spectrum, &EXTENT, budget);
        assert!((shares.expected_parts(&EXTENT) / budget - 1.0).abs() < 1e-6);
        // Large drops give way last.
        assert!((1..CLASS_COUNT).all(|k| shares.share(k - 1) <= shares.share(k) && shares.share(k) > 0.0));
        let few = SplashField::new(1, &spectrum, &shares);
        let many = SplashField::new(1, &spectrum, &all);
        // What splashes show goes by the square of their drops.
        let light = |field: &SplashField| {
            let all = marks(field, 40, 60);
            let weighed = |power: i32| {
                all.iter()
                    .map(|m| (f64::from(m.weight) * f64::from(m.diameter_mm).powi(2)).powi(power))
                    .sum::<f64>()
            };
            (weighed(1), weighed(2).sqrt())
        };
        let ((few, few_spread), (many, many_spread)) = (light(&few), light(&many));
        let spread = 5.0 * few_spread.hypot(many_spread);
        assert!((few - many).abs() < spread, "{budget}: {few} for {many}, {spread}");
        assert!(spread < 0.4 * many, "{budget}: the comparison sees something");
    }
    for bad in [0.0, -1.0, f64::NAN] {
        let none = SplashShares::for_budget(&spectrum, &EXTENT, bad);
        let field = SplashField::new(1, &spectrum, &none);
        assert_eq!((field.mean, marks(&field, 10, 10).len()), (0.0, 0));
    }
}

#[test]
fn any_rain_and_any_eye_give_sound_splashes() {
    for rain in [0.0, 1e-6, 0.1, 500.0] {
        let spectrum = spectrum(rain);
        for shares in [
            SplashShares::all(&spectrum),
            SplashShares::for_budget(&spectrum, &EXTENT, 1e4),
        ] {
            let field = SplashField::new(9, &spectrum, &shares);
            assert!(field.mean <= 64.0 && field.mean.is_finite());
            let all = marks(&field, 8, 8);
            assert!(rain > 0.0 || all.is_empty());
            for mark in all {
                assert!(
                    mark.diameter_mm >= 0.5
                        && mark.diameter_mm < 6.001
                        && mark.weight >= 1.0
                        && mark.weight.is_finite()
                );
            }
        }
    }
    let none = SplashExtent {
        reach_m: f64::NAN,
        near_m: -1.0,
        angle_rad: f64::INFINITY,
        exposure_s: f64::NAN,
        film_mm: f64::NAN,
    };
    let shares = SplashShares::for_budget(&spectrum(25.0), &none, 100.0);
    assert!((0..CLASS_COUNT).all(|k| (0.0..=1.0).contains(&shares.share(k))));
    for bad in [f64::NAN, f64::INFINITY, -1.0, 0.0] {
        let anchor = SplashAnchor::new(DVec3::splat(bad), bad);
        assert!(anchor.fraction.cmpge(glam::Vec2::ZERO).all() && anchor.fraction.cmplt(glam::Vec2::ONE).all());
        assert!((0.0..=0.1).contains(&anchor.since_s), "{bad}: {anchor:?}");
    }
}

#[test]
fn eyes_and_moments_are_exact_far_away_and_after_a_week() {
    for eye in [DVec3::new(0.3, 2.0, -0.1), DVec3::new(100_000.123, 1.7, -100_000.456)] {
        for now in [0.0, 0.05, 0.1, 604_799.973] {
            let anchor = SplashAnchor::new(eye, now);
            let back = (anchor.cell.as_dvec2() + anchor.fraction.as_dvec2()) * SPLASH_CELL_M;
            assert!((back - glam::DVec2::new(eye.x, eye.z)).length() < 1e-6, "{back}");
            let moment = f64::from(anchor.slot) * SPLASH_SLOT_S + f64::from(anchor.since_s);
            assert!((moment - now).abs() < 4e-9, "{now}: {moment}");
        }
    }
    // A splash of the start of the oldest slot has ended by then.
    let anchor = SplashAnchor::new(DVec3::ZERO, 1.0);
    assert!(anchor.age_s(SPLASH_SLOTS - 1, 0.0) >= 0.3 - 1e-6);
    assert!((anchor.age_s(1, 0.25) - 0.075).abs() < 1e-6 && anchor.age_s(0, 0.5) < 0.0);
}

#[test]
fn exposures_see_all_of_a_crown() {
    let mut worst = Worst::default();
    for d in [0.7, 1.5, 3.0, 6.0] {
        for age in [0.001, 0.004, 0.009, 0.014, 0.019, 0.03] {
            for exposure in [0.002, 1.0 / 60.0, 0.1] {
                let seen = simpson(age - exposure, age, 20_000, |t| crown_opacity(d, t));
                worst.absolute(crown_seen_s(d, age, exposure), seen, || format!("{d} {age} {exposure}"));
            }
        }
        let halves = crown_seen_s(d, 0.01, 0.01) + crown_seen_s(d, 0.02, 0.01);
        assert!((halves - crown_seen_s(d, 0.02, 0.02)).abs() < 1e-16);
        assert!((crown_seen_s(d, 1.0, 1.0) / (0.75 * crown_life_s(d)) - 1.0).abs() < 2e-15);
    }
    // Simpson's rule across the impact.
    worst.assert_below(1e-6, 72);
    for bad in [f64::NAN, -1.0, f64::NEG_INFINITY] {
        assert_eq!(crown_seen_s(2.0, bad, 0.1), 0.0);
        assert_eq!(crown_seen_s(2.0, 0.01, bad), 0.0);
    }
}

#[test]
fn thrown_drops_fly_as_air_and_weight_let_them() {
    let mut worst = Worst::default();
    for d in [0.05_f32, 0.2, 0.6, 1.5] {
        let drop = SecondaryDrop {
            diameter_mm: d,
            velocity_m_s: Vec3::new(1.1, 2.0, -0.4),
        };
        let fall = f64::from(terminal_velocity_f32(d));
        let time = (fall / 9.80665).max(1e-3);
        for age in [0.0_f32, 0.01, 0.1, 0.3] {
            // dv/dt = (v_t - v)/τ, by small steps.
            let (mut at, mut v) = (DVec3::ZERO, drop.velocity_m_s.as_dvec3());
            let steps = 200_000;
            let h = f64::from(age) / f64::from(steps);
            for _ in 0..steps {
                let pull = |v: DVec3| (DVec3::new(0.0, -fall, 0.0) - v) / time;
                let middle = v + 0.5 * h * pull(v);
                at += h * (v + 0.5 * h * pull(v));
                v += h * pull(middle);
            }
            for (ours, known) in drop.place_m(age).to_array().into_iter().zip(at.to_array()) {
                worst.relative(f64::from(ours), known, 1e-3, || format!("{d} mm, {age} s"));
            }
        }
    }
    worst.assert_below(2e-6, 48);
    let lost = SecondaryDrop {
        diameter_mm: f32::NAN,
        velocity_m_s: Vec3::splat(f32::NAN),
    };
    for age in [f32::NAN, -1.0, f32::INFINITY] {
        assert!(lost.place_m(age).is_finite());
    }
}

#[test]
fn water_lets_fewer_drops_splash() {
    let spectrum = spectrum(25.0);
    let field = SplashField::new(5, &spectrum, &SplashShares::all(&spectrum));
    let all = marks(&field, 20, 20);
    let splashing = |film: f64| {
        let splashes = |mark: &&SplashMark| {
            let d = f64::from(mark.diameter_mm);
            splash_excess(d, terminal_velocity(d), film) > 1.0
        };
        all.iter().filter(splashes).count()
    };
    let (dry, film, puddle) = (splashing(0.0), splashing(0.3), splashing(30.0));
    assert!(dry > film && film > 2 * puddle && puddle > 0, "{dry} {film} {puddle}");
}
