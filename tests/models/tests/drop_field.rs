//! The drop field: its words, its statistics, and what a view draws of it.

mod moving;

use glam::{DVec3, IVec3, Vec3, Vec4};
use proptest::prelude::*;
use rain_core::rainfall::{
    CLASS_COUNT, Container, Distribution, DrawRange, Drop, FADE_END, FieldMotion, LatticeEye, RANGE_CAP_M,
    RainViewVolume, SOFT_EDGE, SizeClass, Spectrum, Threshold, cell_key, drop_marks, drop_place, expected_drops,
    for_each_drop, quality_for_budget, visible_range_m,
};
use rain_reference::field as reference;
use rain_reference::hash::chi_squared_per_degree;
use rain_reference::numerics::bisect;
use rain_reference::splash::poisson;

use crate::check::Worst;

const BAD: [f64; 7] = [f64::NAN, f64::NEG_INFINITY, -1.0, 0.0, 5e-324, 1e300, f64::INFINITY];

pub(crate) fn spectrum(rain: f64) -> Spectrum {
    Spectrum::new(Distribution::MarshallPalmer, rain).expect("valid")
}

/// Looking along −z, half as high as wide.
pub(crate) fn view(focal_px: f64, exposure_s: f64) -> RainViewVolume {
    let plane = |x: f32, y: f32, z: f32| Vec3::new(x, y, z).normalize().extend(0.0);
    RainViewVolume {
        eye_m: DVec3::new(7.3, 1.7, -104.5),
        eye_velocity_m_s: DVec3::ZERO,
        side_planes: [
            plane(1.0, 0.0, -0.8),
            plane(-1.0, 0.0, -0.8),
            plane(0.0, 1.0, -0.4),
            plane(0.0, -1.0, -0.4),
        ],
        focal_px,
        // 4 asin(sin of the product of both half widths).
        solid_angle_sr: 4.0 * f64::asin(0.8 * 0.4 / (1.64_f64 * 1.16).sqrt()),
        exposure_s,
        turn_rad: 0.0,
        parallel: None,
    }
}

#[test]
fn keys_and_words_are_the_published_hash() {
    let mut cases = 0;
    for seed in [0, 1, 0xdead_beef_0123_4567, u64::MAX] {
        for class in [0, 7, 11, u32::MAX] {
            for cell in [
                IVec3::ZERO,
                IVec3::new(-1, 2, -3),
                IVec3::MIN,
                IVec3::MAX,
                IVec3::new(i32::MIN, 0, i32::MAX),
            ] {
                let key = cell_key(seed, class, cell);
                assert_eq!(key, reference::cell_key(seed, class, cell.to_array().map(i64::from)));
                for index in [0, 1, 2, 4095, 1 << 31, u32::MAX] {
                    assert_eq!(
                        (drop_marks(key, index), drop_place(key, index)),
                        reference::words(key, index)
                    );
                    cases += 1;
                }
            }
        }
    }
    assert_eq!(cases, 480);
    assert_ne!(
        cell_key(1, 0, IVec3::X),
        cell_key(1, 0, IVec3::Y),
        "a cell is told from its neighbour"
    );
}

#[test]
fn drops_are_those_of_the_words() {
    let (mut rank, mut diameter, mut bent) = (Worst::default(), Worst::default(), Worst::default());
    for k in 0..CLASS_COUNT {
        let class = SizeClass::new(k);
        for i in 0..200 {
            let key = cell_key(9, k as u32, IVec3::new(i, -3 * i, 7));
            let known = reference::drops(key, class.min_mm, class.max_mm, 40.0);
            let mut found = 0;
            for_each_drop(&class, key, 40.0, |index, drop| {
                // Rounding decides about a drop at the very end.
                let Some(truth) = known.get(index as usize) else {
                    assert!(drop.rank > 40.0 - 1e-4);
                    return;
                };
                let place = || format!("drop {index} of class {k}");
                assert_eq!(drop.position.as_dvec3().to_array(), truth.place, "{}", place());
                rank.relative(f64::from(drop.rank), truth.rank, 1e-30, place);
                diameter.relative(f64::from(drop.diameter_mm), truth.diameter, 1e-30, place);
                bent.relative(1.05 * f64::from(drop.diameter_mm), truth.diameter, 1e-30, place);
                found += 1;
            });
            assert!(known.len() - found <= 1 && (found == known.len() || known[found].rank > 40.0 - 1e-4));
        }
    }
    rank.assert_below(1e-6, 90_000);
    diameter.assert_below(1e-6, 90_000);
    assert!(bent.error > 0.04);
    // Nothing is found below no rank, and the search ends whatever is asked.
    let (class, key) = (SizeClass::new(3), [1, 2, 3]);
    for none in [f32::NAN, f32::NEG_INFINITY, -1.0, 0.0] {
        for_each_drop(&class, key, none, |_, drop| panic!("{none}: {drop:?}"));
    }
    for all in [1e30, f32::INFINITY] {
        let mut count = 0_u32;
        for_each_drop(&class, key, all, |_, _| count += 1);
        assert!(count.abs_diff(65_536) < 5 * 256, "held at 65 536: {count}");
    }
    let info = allocation_counter::measure(|| for_each_drop(&class, key, 50.0, |_, _| {}));
    assert_eq!(info.count_total, 0);
}

#[test]
fn counts_are_poissons_and_places_and_diameters_even() {
    let class = SizeClass::new(4);
    let (cells, mean) = (200_000, 3.0);
    let mut chances = [0.0; 12];
    let mut values: [Vec<f64>; 4] = Default::default();
    for i in 0..cells {
        let key = cell_key(3, 4, IVec3::new(i % 64, (i / 64) % 64, i / 4096));
        let mut count = 0;
        for_each_drop(&class, key, mean, |_, drop| {
            count += 1;
            for (values, place) in values.iter_mut().zip(drop.position.to_array()) {
                values.push(f64::from(place));
            }
            let share = reference::share_below(class.min_mm, class.max_mm, f64::from(drop.diameter_mm));
            values[3].push(share.clamp(0.0, 1.0 - 1e-12));
        });
        chances[count.min(11)] += 1.0;
    }
    for (count, found) in chances.iter().enumerate().take(11) {
        let expected = poisson(f64::from(mean), count as u32) * f64::from(cells);
        assert!(
            (found - expected).abs() < 5.0 * expected.sqrt(),
            "{count}: {found} {expected}"
        );
    }
    let bound = 5.0 * (2.0_f64 / 255.0).sqrt();
    for (which, values) in values.iter().enumerate() {
        let chi = chi_squared_per_degree(values.iter().copied(), 256);
        assert!((chi - 1.0).abs() < bound, "{which}: {chi}");
    }
    // Another distribution is noticed: diameters even in D instead of by number.
    let flat = values[3].iter().map(|share| share.powf(1.05));
    assert!((chi_squared_per_degree(flat, 256) - 1.0).abs() > bound);
}

#[test]
fn thresholds_are_the_ratio_of_two_spectra() {
    let (mut at, mut presence, mut mean, mut bent) =
        (Worst::default(), Worst::default(), Worst::default(), Worst::default());
    for k in 0..CLASS_COUNT {
        let class = SizeClass::new(k);
        let (a, b, cell) = (class.min_mm, class.max_mm, class.cell_m);
        for rain in [1e-4, 0.1, 5.0, 25.0, 150.0, 500.0] {
            let spectrum = spectrum(rain);
            let threshold = Threshold::new(&class, &spectrum);
            let mut largest = 0.0_f64;
            for i in 0..=20 {
                let d = (a + (b - a) * f64::from(i) / 20.0) as f32;
                let n = spectrum.concentration(f64::from(d));
                let expected = reference::threshold(cell, a, b, f64::from(d), n);
                let place = || format!("class {k}, {rain} mm/h, {d} mm");
                // Below the smallest ordinary number of single precision there are no drops.
                at.relative(f64::from(threshold.at(d)), expected, 1e-37, place);
                bent.relative(1.05 * f64::from(threshold.at(d)), expected, 1e-37, place);
                largest = largest.max(expected);
                if expected < 1e-30 {
                    continue;
                }
                let seen = |rank: f64| {
                    let drop = Drop {
                        position: Vec3::ZERO,
                        diameter_mm: d,
                        rank: rank as f32,
                    };
                    f64::from(threshold.presence(&drop))
                };
                for share in [0.0, 0.5, 0.949, 0.96, 1.0, 1.03, 1.051, 4.0] {
                    let rank = f64::from((share * expected) as f32);
                    presence.absolute(seen(rank), reference::presence(rank, expected), place);
                }
                // Over evenly spread ranks.
                let steps = 2000;
                let h = 1.2 * expected / f64::from(steps);
                let sum: f64 = (0..steps).map(|j| seen((f64::from(j) + 0.5) * h) * h).sum();
                mean.relative(sum, expected, 1e-300, place);
            }
            let limit = f64::from(threshold.scan_limit());
            at.relative(limit, 1.05 * largest, 1e-37, || {
                format!("limit of class {k}, {rain} mm/h")
            });
        }
    }
    at.assert_below(6e-6, 1500);
    presence.assert_below(6e-5, 9000);
    mean.assert_below(6e-6, 1000);
    assert!(bent.error > 0.04);
    let threshold = Threshold::new(&SizeClass::new(6), &spectrum(25.0));
    for bad in BAD.map(|x| x as f32) {
        assert!(threshold.at(bad).is_finite() && threshold.at(bad) >= 0.0, "{bad}");
        for rank in BAD.map(|x| x as f32) {
            let drop = Drop {
                position: Vec3::ZERO,
                diameter_mm: bad,
                rank,
            };
            assert!((0.0..=1.0).contains(&threshold.presence(&drop)), "{bad} {rank}");
        }
    }
    assert_eq!(threshold.at(f32::NAN), threshold.at(0.0));
    assert_eq!(threshold.at(f32::INFINITY), threshold.at(10.0));
    assert_eq!(Threshold::new(&SizeClass::new(6), &spectrum(0.0)).scan_limit(), 0.0);
}

#[test]
fn classes_are_cut_out_of_the_reference_spectrum() {
    let (mut count, mut diameter, mut speed) = (Worst::default(), Worst::default(), Worst::default());
    for (k, class) in SizeClass::all().into_iter().enumerate() {
        let (a, b) = (class.min_mm, class.max_mm);
        count.relative(
            class.reference_count,
            reference::reference_count(class.cell_m, a, b),
            1e-30,
            || format!("{k}"),
        );
        for i in 0..=1000 {
            let u = i as f32 / 1000.0;
            let expected = a - 0.5 * (f64::from(u) * (-2.0 * (b - a)).exp_m1()).ln_1p();
            diameter.relative(f64::from(class.diameter_mm(u)), expected, 1e-30, || {
                format!("{k} at {u}")
            });
        }
        for density in [0.3, 0.9, 1.2041, 2.0] {
            let power = 0.375 + 0.025 * 0.5 * (a + b);
            let expected = class.speed_m_s * (power * (1.2041_f64 / density).ln()).exp();
            speed.relative(class.speed_in(density), expected, 1e-30, || format!("{k} at {density}"));
        }
        for (bad, held) in [
            (f32::NAN, 0.0),
            (-1.0, 0.0),
            (5e-45, 0.0),
            (7.0, 1.0),
            (f32::INFINITY, 1.0),
        ] {
            assert_eq!(class.diameter_mm(bad), class.diameter_mm(held), "{bad}");
        }
        for (bad, held) in [(f64::NAN, 1.2041), (0.0, 0.3), (-1.0, 0.3), (f64::INFINITY, 2.0)] {
            assert_eq!(class.speed_in(bad), class.speed_in(held), "{bad}");
        }
    }
    count.assert_below(1e-11, 12);
    diameter.assert_below(1e-6, 12_000);
    speed.assert_below(1e-15, 48);
}

#[test]
fn frames_are_the_integral_of_their_velocity() {
    let mut motion = FieldMotion::default();
    let (wind, gust) = (DVec3::new(4.0, 0.0, -1.5), DVec3::new(-2.0, 0.5, 9.0));
    let steps = 86_400 * 60 / 2;
    motion.set_velocity(wind, 1.1);
    for _ in 0..steps {
        motion.advance(1.0 / 60.0);
    }
    motion.set_velocity(gust, 1.1);
    for _ in 0..steps {
        motion.advance(1.0 / 60.0);
    }
    let (mut day, mut step) = (Worst::default(), Worst::default());
    for (k, class) in SizeClass::all().into_iter().enumerate() {
        let fall = DVec3::Y * class.speed_in(1.1);
        let exact = 43_200.0 * (wind + gust - 2.0 * fall);
        day.absolute((motion.offset_m[k] - exact).length(), 0.0, || format!("class {k}"));
        let one = FieldMotion {
            velocity_m_s: motion.velocity_m_s,
            ..FieldMotion::default()
        }
        .after(3.7);
        let way = 3.7 * (gust - fall);
        step.absolute((one.offset_m[k] - way).length() / way.length(), 0.0, || {
            format!("class {k}")
        });
    }
    day.assert_below(1e-4, 12);
    step.assert_below(1e-15, 12);
    let before = motion;
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        motion.advance(bad);
        assert_eq!(motion, before, "{bad}");
        let mut calm = before;
        calm.set_velocity(DVec3::new(1.0, bad, 0.0), 1.1);
        let mut still = before;
        still.set_velocity(DVec3::ZERO, 1.1);
        assert_eq!(calm, still);
    }
    assert_eq!(motion.after(0.0), motion);
}

#[test]
fn eyes_stand_in_their_cell() {
    let mut worst = Worst::default();
    for far in [0.0, 3.3, -7.9, 1e5, -1e6] {
        for cell in [0.25, 1.0, 2.0] {
            for i in 0..50 {
                let eye = DVec3::new(far + 0.173 * f64::from(i), 1.7, -far - 0.031 * f64::from(i));
                let offset = DVec3::new(0.5 * far, -8e5, 3.0);
                let lattice = LatticeEye::new(eye, offset, cell);
                let exact = (eye - offset) / cell;
                assert_eq!(lattice.cell.as_dvec3(), exact.floor());
                let off = (lattice.fraction.as_dvec3() - (exact - exact.floor()))
                    .abs()
                    .max_element();
                worst.absolute(off, 0.0, || format!("{eye} in cells of {cell}"));
                assert!(lattice.fraction.min_element() >= 0.0 && lattice.fraction.max_element() < 1.0);
            }
        }
    }
    worst.assert_below(6e-8, 700);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let lattice = LatticeEye::new(DVec3::new(0.0, bad, 1.0), DVec3::ZERO, 1.0);
        assert_eq!((lattice.cell, lattice.fraction), (IVec3::ZERO, Vec3::ZERO));
    }
    for huge in [1e18, -1e300] {
        let lattice = LatticeEye::new(DVec3::splat(huge), DVec3::ZERO, 0.25);
        assert!(lattice.fraction.is_finite() && lattice.fraction.max_element() < 1.0);
    }
}

#[test]
fn ranges_are_where_contrast_is_one_step() {
    let (mut worst, mut held) = (Worst::default(), Worst::default());
    for i in 0..=120 {
        let d = 0.05 * 1.05_f64.powi(i);
        for (focal, exposure) in [(623.5, 1.0 / 60.0), (50.0, 1.0), (1e4, 1e-4)] {
            let expected = reference::contrast_range(d, focal, exposure).min(1e9);
            let place = || format!("{d} mm, {focal} px, {exposure} s");
            worst.relative(visible_range_m(d, focal, exposure), expected, 1e-30, place);
            for kappa in [0.01, 1.0, 64.0] {
                let range = DrawRange {
                    kappa,
                    focal_px: focal,
                    exposure_s: exposure,
                };
                held.relative(range.at(d), (kappa * expected).min(15.0), 1e-30, place);
            }
        }
    }
    worst.assert_below(1e-13, 360);
    held.assert_below(1e-13, 1000);
    for bad in BAD {
        for other in [1.0, bad] {
            let range = DrawRange {
                kappa: bad,
                focal_px: other,
                exposure_s: other,
            };
            assert!((0.0..=RANGE_CAP_M).contains(&range.at(other)), "{bad} {other}");
        }
    }
    let drawn = |kappa| {
        DrawRange {
            kappa,
            focal_px: 600.0,
            exposure_s: 0.01,
        }
        .at(2.0)
    };
    assert_eq!(
        [drawn(f64::NAN), drawn(-1.0), drawn(0.0), drawn(f64::INFINITY)],
        [0.0, 0.0, 0.0, RANGE_CAP_M]
    );
}

#[test]
fn expected_drops_are_the_integral_over_diameters() {
    let (mut worst, mut bent) = (Worst::default(), Worst::default());
    for rain in [0.1, 1.0, 5.0, 25.0, 100.0, 500.0] {
        let spectrum = spectrum(rain);
        for (focal, exposure) in [(623.5, 1.0 / 60.0), (200.0, 1.0 / 500.0), (2000.0, 1.0 / 30.0)] {
            let view = view(focal, exposure);
            for kappa in [0.05, 0.3, 1.0, 3.0, 20.0, 64.0] {
                let found = expected_drops(&spectrum, &view, kappa);
                let slow = reference::drawn(
                    |d| spectrum.concentration(d),
                    view.solid_angle_sr,
                    focal,
                    exposure,
                    kappa,
                );
                worst.relative(found, slow, 1e-30, || {
                    format!("{rain} mm/h, {focal} px, {exposure} s, κ {kappa}")
                });
                bent.relative(1.05 * found, slow, 1e-30, String::new);
            }
        }
    }
    worst.assert_below(0.016, 100);
    assert!(bent.error > 0.05);
}

#[test]
fn quality_gives_the_budget_back() {
    let (mut worst, mut root, mut bent) = (Worst::default(), Worst::default(), Worst::default());
    for rain in [0.01, 1.0, 25.0, 500.0] {
        let spectrum = spectrum(rain);
        for (focal, exposure) in [(623.5, 1.0 / 60.0), (2000.0, 1.0 / 500.0)] {
            let view = view(focal, exposure);
            let most = expected_drops(&spectrum, &view, 64.0);
            for share in [1e-9, 1e-4, 0.1, 0.7, 0.999] {
                let budget = share * most;
                let kappa = quality_for_budget(&spectrum, &view, budget);
                if budget > 1e-6 && kappa < 64.0 {
                    let found = expected_drops(&spectrum, &view, kappa);
                    let place = || format!("{rain} mm/h, {share} of {most}");
                    worst.relative(found, budget, 1e-30, place);
                    let exact = bisect(0.0, 64.0, |kappa| expected_drops(&spectrum, &view, kappa) - budget);
                    root.absolute(kappa, exact, place);
                    bent.relative(
                        expected_drops(&spectrum, &view, 1.05 * kappa),
                        budget,
                        1e-30,
                        String::new,
                    );
                }
            }
            for enough in [most, 2.0 * most + 1.0, f64::INFINITY] {
                assert_eq!(quality_for_budget(&spectrum, &view, enough), 64.0);
            }
            for none in [f64::NAN, f64::NEG_INFINITY, -1.0, 0.0] {
                assert!(quality_for_budget(&spectrum, &view, none) < 1e-9, "{none}");
            }
        }
    }
    worst.assert_below(1e-8, 30);
    root.assert_below(1e-13, 30);
    assert!(bent.error > 0.04);
    // Where it is dry, or the view sees nothing, every budget is enough.
    assert_eq!(quality_for_budget(&spectrum(0.0), &view(600.0, 0.01), 1.0), 64.0);
    assert_eq!(expected_drops(&spectrum(0.0), &view(600.0, 0.01), 1.0), 0.0);
    for bad in BAD {
        let odd = RainViewVolume {
            focal_px: bad,
            solid_angle_sr: bad,
            exposure_s: bad,
            ..view(600.0, 0.01)
        };
        for view in [
            odd,
            RainViewVolume {
                solid_angle_sr: 1.0,
                ..odd
            },
        ] {
            for kappa in [1.0, bad] {
                let drops = expected_drops(&spectrum(25.0), &view, kappa);
                assert!(drops.is_finite() && drops >= 0.0, "{bad} {kappa}: {drops}");
            }
            assert!(
                (0.0..=64.0).contains(&quality_for_budget(&spectrum(25.0), &view, 1e4)),
                "{bad}"
            );
        }
        assert!(expected_drops(&spectrum(25.0), &view(600.0, 0.01), bad).is_finite());
    }
}

#[test]
fn a_view_draws_the_drops_within_reach_and_no_others() {
    let (seed, kappa, rain) = (77, 0.45, spectrum(20.0));
    let view = view(623.5, 1.0 / 60.0);
    let motion = FieldMotion::default().after(4321.9);
    let mut container = Container::default();
    assert!(container.fill(seed, &rain, &motion, &view, kappa, 1 << 20));
    let range = DrawRange {
        kappa,
        focal_px: view.focal_px,
        exposure_s: view.exposure_s,
    };
    let (mut position, mut presence) = (Worst::default(), Worst::default());
    let (mut due, mut known) = (0, 0);
    let mut records = container.records.iter();
    for k in 0..CLASS_COUNT {
        let class = SizeClass::new(k);
        let mine: Vec<_> = (records.clone())
            .take_while(|record| record.drop & 15 == k as u32)
            .copied()
            .collect();
        records.by_ref().take(mine.len()).for_each(drop);
        let way = motion.velocity_m_s[k] * view.exposure_s;
        let reach = FADE_END * range.at(class.max_mm);
        let eye = (view.eye_m - motion.offset_m[k]) / class.cell_m;
        let cells = (reach / class.cell_m).ceil() as i64 + 1;
        let last = f64::from(Threshold::new(&class, &rain).scan_limit()) * 1.01;
        let mut taken = 0;
        for z in -cells..=cells {
            for y in -cells..=cells {
                for x in -cells..=cells {
                    let cell = [x, y, z];
                    let at = [0, 1, 2].map(|i| eye[i].floor() as i64 + cell[i]);
                    let key = reference::cell_key(seed, k as u32, at);
                    for (index, drop) in reference::drops(key, class.min_mm, class.max_mm, last)
                        .iter()
                        .enumerate()
                    {
                        let n = rain.concentration(drop.diameter);
                        let threshold =
                            reference::threshold(class.cell_m, class.min_mm, class.max_mm, drop.diameter, n);
                        let there = reference::presence(drop.rank, threshold);
                        if there <= 0.0 {
                            continue;
                        }
                        let p = DVec3::from([0, 1, 2].map(|i| (at[i] as f64 + drop.place[i] - eye[i]) * class.cell_m));
                        // How far inside every border.
                        let mut inside = FADE_END * range.at(drop.diameter) - p.length();
                        for plane in view.side_planes {
                            let side: Vec4 = plane;
                            let normal = side.truncate().as_dvec3();
                            inside = inside.min(normal.dot(p).max(normal.dot(p - way)) + 0.01);
                        }
                        let biased = cell.map(|c| (c + 512) as u32);
                        let packed = biased[0] | biased[1] << 10 | biased[2] << 20;
                        let record = mine
                            .iter()
                            .find(|r| r.cell == packed && r.drop >> 4 & 0xFFF == index as u32);
                        let place = || format!("class {k}, {p}");
                        if let Some(record) = record {
                            assert!(inside > -1e-4, "{}: {inside} m outside", place());
                            let found = record.position(seed, &container.classes).as_dvec3();
                            position.absolute((found - p).length(), 0.0, place);
                            presence.absolute(f64::from(record.drop >> 16) / 65_535.0, there, place);
                            taken += 1;
                        } else {
                            assert!(inside < 1e-4 || there < 1e-4, "{}: missed {inside} m inside", place());
                        }
                        due += u32::from(inside > 0.0);
                    }
                }
            }
        }
        assert_eq!(taken, mine.len(), "class {k}: all of them are drops of the field");
        known += taken;
    }
    assert!(known > 1000 && known.abs_diff(due as usize) < 5, "{known} of {due}");
    position.assert_below(1e-5, 1000);
    presence.assert_below(1e-4, 1000);
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 128,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(19),
        ..ProptestConfig::default()
    })]

    #[test]
    fn ranks_rise_and_a_longer_search_only_adds(key in any::<[u32; 3]>(), k in 0_usize..CLASS_COUNT, limit in 0.0_f32..60.0, more in 0.0_f32..20.0) {
        let class = SizeClass::new(k);
        let list = |limit: f32| {
            let mut drops = Vec::new();
            for_each_drop(&class, key, limit, |index, drop| drops.push((index, drop)));
            drops
        };
        let (short, long) = (list(limit), list(limit + more));
        prop_assert_eq!(&long[..short.len()], &short[..]);
        for (i, (index, drop)) in long.iter().enumerate() {
            prop_assert!(*index == i as u32 && drop.rank < limit + more && drop.rank > 0.0);
            prop_assert!(drop.position.min_element() >= 0.0 && drop.position.max_element() < 1.0);
            prop_assert!((class.min_mm * 0.999_999..=class.max_mm * 1.000_1).contains(&f64::from(drop.diameter_mm)));
            prop_assert!(i == 0 || drop.rank >= long[i - 1].1.rank);
        }
    }

    #[test]
    fn heavier_rain_and_lower_ranks_are_more_present(rain in 0.01_f64..250.0, more in 1.0_f64..2.0, u in 0.0_f32..1.0, share in 0.0_f32..2.0, k in 0_usize..CLASS_COUNT) {
        let class = SizeClass::new(k);
        let (light, heavy) = (Threshold::new(&class, &spectrum(rain)), Threshold::new(&class, &spectrum(rain * more)));
        let diameter_mm = class.diameter_mm(u);
        let drop = Drop { position: Vec3::ZERO, diameter_mm, rank: share * light.at(diameter_mm) };
        let rarer = Drop { rank: drop.rank * more as f32, ..drop };
        prop_assert!(heavy.presence(&drop) >= light.presence(&drop) - 1e-4);
        prop_assert!(light.presence(&rarer) <= light.presence(&drop));
        prop_assert!(light.at(diameter_mm) * (1.0 + SOFT_EDGE) <= light.scan_limit() * (1.0 + 1e-6));
    }

    #[test]
    fn budgets_and_qualities_rise_together(rain in 0.1_f64..300.0, kappa in 0.0_f64..60.0, more in 1.0_f64..2.0, focal in 50.0_f64..4000.0, exposure in 1e-4_f64..0.1, budget in 1.0_f64..1e6) {
        let (view, spectrum) = (view(focal, exposure), spectrum(rain));
        prop_assert!(expected_drops(&spectrum, &view, kappa * more) >= expected_drops(&spectrum, &view, kappa));
        let (low, high) = (quality_for_budget(&spectrum, &view, budget), quality_for_budget(&spectrum, &view, budget * more));
        prop_assert!(low <= high && (0.0..=64.0).contains(&low));
        prop_assert!(expected_drops(&spectrum, &view, low) <= budget * (1.0 + 1e-9), "within the budget");
    }
}
