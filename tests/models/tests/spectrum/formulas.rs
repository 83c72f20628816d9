//! The smaller functions of drop sizes against their twins: printed counts, surfaces, classes, samplers.

use glam::DVec3;
use proptest::prelude::*;
use rain_core::rainfall::source_forms::{
    NGUYENOVA_DIAMETERS_MM, YOSHIDA_DIAMETERS_MM, nguyenova_counts_per_m3, printed_concentration, yoshida_counts_per_m3,
};
use rain_core::rainfall::{
    AirSampler, CLASS_COUNT, CLASS_EDGES_MM, ClassErrors, ClassScheme, ClassWeights, DiameterTable, Distribution,
    DropSizes, GammaClimate, GammaSpectrum, RainKind, SizeLaw, Spectrum, gunn_kinzer, measured_energy_j_m2_mm,
    terminal_velocity,
};
use rain_reference::fall_speed::{fit, measured};
use rain_reference::numerics::{bisect, simpson};
use rain_reference::spectrum as reference;
use rain_reference::splash::impact_sums;

use super::{ODD, RATES, config};
use crate::check::Worst;

#[test]
fn printed_counts_are_integrals_of_the_printed_density() {
    let (mut density, mut counts, mut energy, mut bent) =
        (Worst::default(), Worst::default(), Worst::default(), Worst::default());
    for r in RATES {
        let slope = reference::slope("marshall-palmer", r);
        let n = |d: f64| 8000.0 / (slope * d).exp();
        for i in 0..=60 {
            let d = 0.1 * f64::from(i);
            let expected = n(d);
            if expected > 1e-290 {
                density.relative(printed_concentration(r, d), expected, 1e-300, || {
                    format!("{r} mm/h, {d} mm")
                });
                bent.relative(printed_concentration(1.05 * r, d), expected, 1e-300, String::new);
            }
        }
        for (found, middles, half) in [
            (yoshida_counts_per_m3(r), YOSHIDA_DIAMETERS_MM, 0.1),
            (nguyenova_counts_per_m3(r), NGUYENOVA_DIAMETERS_MM, 0.25),
        ] {
            for (count, d) in found.into_iter().zip(middles) {
                let expected = simpson(d - half, d + half, 8000, n);
                counts.relative(count, expected, 1e-300, || format!("{r} mm/h about {d} mm"));
            }
        }
        let expected = 28.3 - 28.3 * 0.52 / (0.042 * r).exp();
        energy.relative(measured_energy_j_m2_mm(r), expected, 1e-30, || format!("{r} mm/h"));
    }
    density.assert_below(1e-15, 500);
    counts.assert_below(1e-13, 100);
    energy.assert_below(1e-15, 9);
    assert!(bent.error > 0.04);
    for (bad, held) in [(f64::NAN, 0.0), (-1.0, 0.0), (f64::NEG_INFINITY, 0.0)] {
        assert_eq!(measured_energy_j_m2_mm(bad), measured_energy_j_m2_mm(held));
        assert_eq!(nguyenova_counts_per_m3(bad), [0.0; 6]);
    }
    assert_eq!(measured_energy_j_m2_mm(f64::INFINITY), 28.3);
    assert_eq!(
        printed_concentration(f64::INFINITY, 1.0),
        printed_concentration(500.0, 1.0)
    );
}

#[test]
fn spectra_carry_their_rate_to_twelve_digits() {
    let mut worst = Worst::default();
    for distribution in Distribution::ALL {
        for r in RATES {
            let spectrum = Spectrum::new(distribution, r).unwrap();
            let n = |d: f64| spectrum.concentration(d);
            let end = 50.0 / spectrum.slope_per_mm;
            // Simpson's rule in pieces of two decay lengths that end where the fit has its corner.
            let water = |from: f64, to: f64| {
                let pieces = ((to - from) * spectrum.slope_per_mm / 2.0).ceil().max(20.0) as u32;
                let at = |i: u32| from + (to - from) * f64::from(i) / f64::from(pieces);
                (0..pieces)
                    .map(|i| simpson(at(i), at(i + 1), 200, |d| n(d) * d.powi(3) * fit(d)))
                    .sum::<f64>()
            };
            let carried = 6e-4
                * core::f64::consts::PI
                * (water(0.0, end.min(5.8)) + if end > 5.8 { water(5.8, end) } else { 0.0 });
            worst.relative(carried, r, 1e-30, || format!("{distribution:?} at {r} mm/h"));
        }
    }
    worst.assert_below(1e-12, 36);
    // The quadratic, with the measured speeds.
    let off = |r: f64| {
        let published = DropSizes::published(RainKind::MarshallPalmer, r).unwrap();
        let carried = published.rain_rate_mm_h(0.0, f64::INFINITY, gunn_kinzer);
        Spectrum::quadratic(r).unwrap().n0_per_m3_mm / 8000.0 * carried / r - 1.0
    };
    let (mut ordinary, mut all) = (Worst::default(), Worst::default());
    for i in 0..=134 {
        let r = (1e-4 * 10_f64.powf(0.05 * f64::from(i))).min(500.0);
        all.absolute(off(r), 0.0, || format!("{r} mm/h"));
        if (0.5..=100.0).contains(&r) {
            ordinary.absolute(off(r), 0.0, || format!("{r} mm/h"));
        }
    }
    ordinary.assert_below(0.0018, 40);
    all.assert_below(0.027, 134);
    assert!(
        (Distribution::ALL.map(Distribution::published_n0_per_m3_mm))
            .iter()
            .zip(["marshall-palmer", "drizzle", "widespread", "thunderstorm"])
            .all(|(n, name)| *n == reference::published(name).0)
    );
}

#[test]
fn gamma_distributions_are_testuds() {
    let (mut factor, mut density, mut slope, mut bent) =
        (Worst::default(), Worst::default(), Worst::default(), Worst::default());
    for i in 0..=40 {
        let mu = 0.5 * f64::from(i);
        for dm in [0.01, 0.3, 1.5, 3.0, 10.0] {
            let spectrum = GammaSpectrum::new(5000.0, dm, mu).unwrap();
            let place = || format!("µ = {mu}, D_m = {dm}");
            factor.relative(spectrum.factor(), reference::gamma_factor(mu), 1e-30, place);
            slope.relative(spectrum.slope_per_mm(), (4.0 + mu) / dm, 1e-30, place);
            for x in [0.01, 0.3, 1.0, 2.7, 6.0] {
                let expected = reference::gamma(5000.0, dm, mu, x * dm);
                if expected > 1e-200 {
                    density.relative(spectrum.concentration(x * dm), expected, 1e-300, place);
                    bent.relative(spectrum.concentration(1.05 * x * dm), expected, 1e-300, place);
                    let law = SizeLaw::Gamma(spectrum);
                    assert_eq!(law.concentration(x * dm), spectrum.concentration(x * dm));
                }
            }
            assert_eq!(
                (spectrum.mean_diameter_mm(), spectrum.shape(), spectrum.nw_per_m3_mm()),
                (dm, mu, 5000.0)
            );
        }
    }
    factor.assert_below(1e-12, 200);
    density.assert_below(1e-12, 900);
    slope.assert_below(1e-15, 200);
    assert!(bent.error > 0.04);
    let mut climate = Worst::default();
    for (kind, exponent) in [
        (GammaClimate::Stratiform, 8000_f64.log10()),
        (GammaClimate::Maritime, 4.25),
        (GammaClimate::Continental, 3.25),
    ] {
        climate.relative(kind.nw_per_m3_mm(), 10_f64.powf(exponent), 1e-30, || {
            format!("{kind:?}")
        });
    }
    climate.assert_below(1e-9, 3);
    let mut sides = [0_u32; 2];
    for i in 1..=400 {
        let dm = 0.01 * f64::from(i);
        for exponent in [2.0, 3.1, 4.7, 6.0] {
            let border = 6.3 - 1.6 * dm;
            if f64::abs(exponent - border) > 1e-12 {
                let spectrum = GammaSpectrum::new(10_f64.powf(exponent), dm, 2.0).unwrap();
                assert_eq!(spectrum.is_convective(), exponent > border, "{dm} mm, 10^{exponent}");
                sides[usize::from(exponent > border)] += 1;
            }
        }
    }
    assert!(sides[0] > 300 && sides[1] > 300, "{sides:?}");
    let mut carried = Worst::default();
    for kind in GammaClimate::ALL {
        for r in [0.5, 25.0, 300.0] {
            let spectrum = GammaSpectrum::carrying(kind, 3.0, r, gunn_kinzer).unwrap();
            let rate = reference::rain_rate(0.0, 40.0, |d| spectrum.concentration(d), measured);
            carried.relative(rate, r, 1e-30, || format!("{kind:?} {r} mm/h"));
        }
    }
    carried.assert_below(2e-6, 9);
}

#[test]
fn closed_bulk_quantities_hold_to_nine_digits() {
    let (mut closed, mut ratio) = (Worst::default(), Worst::default());
    for kind in RainKind::ALL {
        for r in [0.2, 20.0, 200.0] {
            let sizes = DropSizes::new(kind, r).unwrap();
            let n = |d: f64| sizes.concentration(d);
            for (a, b) in [(0.0, sizes.end_mm().min(40.0)), (0.5, 6.0)] {
                let place = || format!("{kind}, {r} mm/h, from {a}");
                // Short against the decay.
                let pieces = 40 + ((b - a) * sizes.parts()[0].1.slope_per_mm()) as usize;
                let at = |i: usize| a + (b - a) * i as f64 / pieces as f64;
                let fine =
                    |f: &dyn Fn(f64) -> f64| -> f64 { (0..pieces).map(|i| simpson(at(i), at(i + 1), 100, f)).sum() };
                for (found, slow) in [
                    (sizes.number_per_m3(a, b), fine(&n)),
                    (
                        sizes.liquid_water_g_m3(a, b),
                        fine(&|d| core::f64::consts::PI / 6.0 * 1e-3 * d.powi(3) * n(d)),
                    ),
                    (
                        sizes.extinction_per_m(a, b),
                        fine(&|d| core::f64::consts::FRAC_PI_4 * (d * 1e-3).powi(2) * n(d)),
                    ),
                    (sizes.moment(6, a, b), fine(&|d| d.powi(6) * n(d))),
                ] {
                    closed.relative(found, slow, 1e-300, place);
                }
                let rate = reference::rain_rate(a, b, n, measured);
                let mass = |d: f64| core::f64::consts::PI / 6.0 * 998.2 * (d * 1e-3).powi(3);
                let energy = reference::sum(a, b, |d| 0.5 * mass(d) * n(d) * measured(d).powi(3));
                for (found, slow) in [
                    (sizes.kinetic_energy_j_m2_mm(a, b, gunn_kinzer), 3600.0 * energy / rate),
                    (
                        sizes.mean_inverse_velocity_s_m(a, b, gunn_kinzer),
                        reference::sum(a, b, |d| d.powi(3) * n(d))
                            / reference::sum(a, b, |d| d.powi(3) * n(d) * measured(d)),
                    ),
                    (
                        sizes.flux_moment(2, a, b, gunn_kinzer),
                        reference::sum(a, b, |d| d * d * n(d) * measured(d)),
                    ),
                ] {
                    ratio.relative(found, slow, 1e-300, place);
                }
            }
        }
    }
    closed.assert_below(1e-9, 120);
    ratio.assert_below(2e-6, 90);
}

#[test]
fn surfaces_of_any_slant_catch_what_fine_sums_say() {
    let (mut worst, mut bent) = (Worst::default(), Worst::default());
    for kind in [RainKind::MarshallPalmer, RainKind::Gamma] {
        for r in [0.5, 25.0, 200.0] {
            let sizes = DropSizes::new(kind, r).unwrap();
            for (normal, wind) in [
                ([0.0, 1.0, 0.0], [0.0, 0.0, 0.0]),
                ([-1.0, 0.0, 0.0], [6.0, 0.0, 2.0]),
                ([0.8, 0.6, 0.0], [6.0, 0.0, 2.0]),
                ([0.6, 0.8, 0.0], [5.0, 0.0, 0.0]),
                ([-0.6, 0.0, 0.8], [3.0, -0.5, -2.0]),
                ([0.0, -1.0, 0.0], [0.0, 4.0, 0.0]),
            ] {
                for (a, b) in [(0.2, 8.0), (0.5, 3.0)] {
                    let n = |d: f64| sizes.concentration(d);
                    let sums = impact_sums(n, fit, a, b, normal, wind);
                    let level = impact_sums(n, fit, a, b, [0.0, 1.0, 0.0], [0.0; 3]);
                    let (up, air) = (DVec3::from(normal), DVec3::from(wind));
                    let place = || format!("{kind} {r} mm/h on {up} in {air}");
                    let impacts = sizes.impacts_on_surface_per_m2_s(up, air, a, b, terminal_velocity);
                    let water = sizes.rain_on_surface_mm_h(up, air, a, b, terminal_velocity);
                    worst.relative(impacts, sums[0], 0.01 * level[0], place);
                    worst.relative(water, 3.6e6 * sums[1], 3.6e4 * level[1], place);
                    bent.relative(1.05 * impacts, sums[0], 0.01 * level[0], place);
                }
            }
        }
    }
    worst.assert_below(1e-4, 140);
    assert!(bent.error > 0.04);
}

#[test]
fn edges_of_classes_are_where_their_scheme_says() {
    let (mut ratio, mut speed) = (Worst::default(), Worst::default());
    for (a, b) in [(0.5, 6.0), (0.01, 20.0), (0.2, 5.8)] {
        for count in [1_usize, 5, 12, 40] {
            let mut edges = vec![0.0; count + 1];
            let share = |i: usize| i as f64 / count as f64;
            ClassScheme::Logarithmic.edges(a, b, gunn_kinzer, &mut edges).unwrap();
            for (i, edge) in edges.iter().enumerate() {
                let expected = (a.ln() * (1.0 - share(i)) + b.ln() * share(i)).exp();
                ratio.relative(*edge, expected, 1e-30, || format!("ratio {i} of {count}"));
            }
            ClassScheme::EqualDiameter.edges(a, b, gunn_kinzer, &mut edges).unwrap();
            for (i, edge) in edges.iter().enumerate() {
                ratio.relative(*edge, a * (1.0 - share(i)) + b * share(i), 1e-30, || {
                    format!("step {i} of {count}")
                });
            }
            if b <= 5.8 {
                ClassScheme::EqualSpeed.edges(a, b, gunn_kinzer, &mut edges).unwrap();
                for (i, edge) in edges.iter().enumerate() {
                    let target = measured(a) * (1.0 - share(i)) + measured(b) * share(i);
                    speed.absolute(measured(*edge), target, || format!("speed {i} of {count}"));
                }
            }
        }
    }
    ratio.assert_below(2e-15, 300);
    speed.assert_below(1e-13, 60);
}

#[test]
fn class_errors_are_those_of_fine_sums() {
    let mut worst = Worst::default();
    let held = DropSizes::carrying(RainKind::MarshallPalmer, 25.0, gunn_kinzer).unwrap();
    for kind in [RainKind::MarshallPalmer, RainKind::Thunderstorm, RainKind::Gamma] {
        for r in [1.0, 100.0] {
            let sizes = DropSizes::carrying(kind, r, gunn_kinzer).unwrap();
            for count in [4_usize, 12] {
                let mut edges = vec![0.0; count + 1];
                ClassScheme::Logarithmic
                    .edges(0.5, 6.0, gunn_kinzer, &mut edges)
                    .unwrap();
                let found = ClassErrors::of(&edges, &sizes, &held, gunn_kinzer).unwrap();
                let mut sums = [0.0; 7];
                let mut largest = 0.0_f64;
                for pair in edges.windows(2) {
                    let over = |f: &dyn Fn(f64) -> f64| reference::sum(pair[0], pair[1], f);
                    let (old, new) = (|d: f64| held.concentration(d), |d: f64| sizes.concentration(d));
                    let u = over(&|d| old(d) * measured(d)) / over(&old);
                    let square = over(&|d| old(d) * d * d) / over(&old);
                    let off = |d: f64| (u - measured(d)) / measured(d);
                    largest = largest.max(off(pair[0]).abs()).max(off(pair[1]).abs());
                    for (sum, part) in sums.iter_mut().zip([
                        u * over(&new),
                        over(&|d| new(d) * measured(d)),
                        u * over(&|d| new(d) * d.powi(3)),
                        over(&|d| new(d) * d.powi(3) * measured(d)),
                        square * over(&new),
                        over(&|d| new(d) * d * d),
                        over(&|d| new(d) * d * d * off(d).powi(2)),
                    ]) {
                        *sum += part;
                    }
                }
                for (value, expected) in [
                    (found.number_flux, sums[0] / sums[1] - 1.0),
                    (found.water_flux, sums[2] / sums[3] - 1.0),
                    (found.extinction, sums[4] / sums[5] - 1.0),
                    (found.speed_rms, (sums[6] / sums[5]).sqrt()),
                    (found.speed_max, largest),
                ] {
                    worst.absolute(value, expected, || format!("{kind} {r} mm/h, {count} classes"));
                }
            }
        }
    }
    worst.assert_below(1e-6, 60);
}

#[test]
fn samplers_find_their_diameter_to_thirteen_digits() {
    let (mut worst, mut bent) = (Worst::default(), Worst::default());
    for r in [1e-3, 1.0, 500.0] {
        let spectrum = Spectrum::new(Distribution::MarshallPalmer, r).unwrap();
        let slope = spectrum.slope_per_mm;
        for (a, b) in [(0.2, 6.0), (0.01, 0.011), (1.0, 1.1), (0.5, f64::INFINITY)] {
            let sampler = AirSampler::new(&spectrum, a, b).unwrap();
            let end = slope * (b.min(a + 45.0 / slope) - a);
            for u in [
                0.0,
                1e-15,
                1e-6,
                0.01,
                0.3,
                0.49,
                0.51,
                0.9,
                0.999,
                1.0 - 1e-9,
                1.0 - 1e-15,
            ] {
                // By the share of the smaller ones, or of the larger.
                let x = bisect(0.0, end, |x| {
                    if u < 0.5 {
                        -(-x).exp_m1() + u * (-end).exp_m1()
                    } else {
                        (-(1.0 - u) * (-end).exp_m1()) - (-end).exp() * (end - x).exp_m1()
                    }
                });
                let expected = a + x / slope;
                worst.relative(sampler.diameter_mm(u), expected, 1e-30, || {
                    format!("{r} mm/h [{a}, {b}] {u}")
                });
                bent.relative(sampler.diameter_mm(0.95 * u), expected, 1e-30, String::new);
            }
        }
    }
    worst.assert_below(1e-13, 130);
    assert!(bent.error > 0.04);
}

#[test]
fn weights_of_classes_hold_to_twelve_digits() {
    let (mut exact, mut rms) = (Worst::default(), Worst::default());
    for distribution in Distribution::ALL {
        for r in RATES {
            let spectrum = Spectrum::new(distribution, r).unwrap();
            let weights = ClassWeights::new(&spectrum);
            for k in 0..CLASS_COUNT {
                let (a, b) = (CLASS_EDGES_MM[k], CLASS_EDGES_MM[k + 1]);
                // Scaled to the density at the lower edge, which else may be below all numbers.
                let n = |d: f64| (-spectrum.slope_per_mm * (d - a)).exp();
                let scale = spectrum.concentration(a);
                if scale < 1e-290 {
                    continue;
                }
                let pieces = 8 + (spectrum.slope_per_mm * (b - a)) as usize;
                let over = |f: &dyn Fn(f64) -> f64| {
                    let at = |i: usize| a + (b - a) * i as f64 / pieces as f64;
                    (0..pieces).map(|i| simpson(at(i), at(i + 1), 200, f)).sum::<f64>()
                };
                let (number, square) = (over(&n), over(&|d| d * d * n(d)));
                let place = || format!("{distribution:?} {r} mm/h, class {k}");
                exact.relative(weights.number_per_m3[k], scale * number, 1e-300, place);
                let area = core::f64::consts::FRAC_PI_4 * 1e-6 * square;
                exact.relative(weights.extinction_per_m[k], scale * area, 1e-300, place);
                rms.relative(
                    ClassWeights::rms_diameter_mm(&spectrum, k),
                    (square / number).sqrt(),
                    1e-30,
                    place,
                );
            }
        }
    }
    exact.assert_below(1e-12, 700);
    rms.assert_below(1e-9, 300);
}

#[test]
fn tables_of_diameters_are_as_near_as_they_say() {
    fn errors<const N: usize>(sizes: &DropSizes) -> [f64; 3] {
        let table = DiameterTable::<N>::on_ground(sizes, 0.2, 6.0, gunn_kinzer).unwrap();
        let weight = |d: f64| sizes.concentration(d) * measured(d);
        let whole = reference::sum(0.2, 6.0, weight);
        let exact = reference::sum(0.2, 6.0, |d| weight(d) * d.powi(3)) / whole;
        let n = 1 << 18;
        let cubes = (0..n)
            .map(|i| f64::from(table.diameter_mm((i as f32 + 0.5) / n as f32)).powi(3))
            .sum::<f64>()
            / f64::from(n);
        let (steps, mut below, mut most, mut all) = (20_000, 0.0, 0.0_f64, 0.0_f64);
        let h = 5.8 / f64::from(steps);
        for i in 0..steps {
            let d = 0.2 + h * f64::from(i);
            let u = below / whole;
            let off = (f64::from(table.diameter_mm(u as f32)) - d).abs();
            all = all.max(off);
            if u < 0.999_99 {
                most = most.max(off);
            }
            below += h * weight(d + 0.5 * h);
        }
        [(cubes / exact - 1.0).abs(), most, all]
    }
    let sizes = DropSizes::carrying(RainKind::MarshallPalmer, 10.0, gunn_kinzer).unwrap();
    let mut worst = Worst::default();
    for (found, stated) in [errors::<64>(&sizes), errors::<128>(&sizes), errors::<256>(&sizes)]
        .into_iter()
        .zip([[5.1e-4, 0.038, 0.145], [1.3e-4, 0.010, 0.040], [3.3e-5, 0.004, 0.017]])
    {
        for (value, bound) in found.into_iter().zip(stated) {
            worst.absolute(value / bound, 0.0, || format!("{value:e} of {bound:e}"));
            // Not stated far too wide either.
            assert!(value > 0.6 * bound, "{value:e} of {bound:e}");
        }
    }
    worst.assert_below(1.0, 9);
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn slants_catch_no_more_than_square_on(r in 0.5_f64..100.0, wind in 0.0_f64..15.0, tilt in 0.0_f64..3.1) {
        let sizes = DropSizes::new(RainKind::MarshallPalmer, r).unwrap();
        let air = DVec3::new(wind, 0.0, 0.0);
        let caught = |angle: f64| sizes.rain_on_surface_mm_h(DVec3::new(-angle.sin(), angle.cos(), 0.0), air, 0.2, 8.0, terminal_velocity);
        // Flat and upright part add up to more than any slant between.
        prop_assert!(caught(tilt) <= caught(0.0) + caught(core::f64::consts::FRAC_PI_2) + 1e-6 * r);
        prop_assert!(caught(tilt) >= 0.0 && caught(0.0) <= r * (1.0 + 2e-6));
        let count = sizes.impacts_on_surface_per_m2_s(DVec3::Y, air, 0.2, 8.0, terminal_velocity);
        prop_assert!((count / sizes.impacts_per_m2_s(0.2, 8.0, terminal_velocity) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn heavier_rain_prints_more_drops_of_every_size(r in 1e-3_f64..400.0, more in 1.01_f64..1.2, d in 0.05_f64..6.0) {
        prop_assert!(printed_concentration(r * more, d) >= printed_concentration(r, d));
        let (light, heavy) = (yoshida_counts_per_m3(r), yoshida_counts_per_m3(r * more));
        prop_assert!(light.iter().zip(heavy).all(|(a, b)| *a <= b));
        prop_assert!(measured_energy_j_m2_mm(r * more) >= measured_energy_j_m2_mm(r));
        prop_assert!((13.5..=28.3).contains(&measured_energy_j_m2_mm(r)));
    }
}

#[test]
fn odd_diameters_of_a_law_hold_no_drops() {
    for law in DropSizes::new(RainKind::Gamma, 5.0)
        .unwrap()
        .parts()
        .iter()
        .map(|(_, law)| *law)
    {
        for x in ODD {
            assert!(law.concentration(x).is_finite() && law.concentration(x) >= 0.0, "{x}");
        }
        assert!(law.n0_per_m3_mm() > 0.0 && law.slope_per_mm() > 0.0);
    }
}
