//! N(D): exponentials, gamma distributions, blends, and what each carries.

use proptest::prelude::*;
use rain_core::rainfall::source_forms::{
    NGUYENOVA_DIAMETERS_MM, YOSHIDA_DIAMETERS_MM, nguyenova_counts_per_m3, printed_concentration, yoshida_counts_per_m3,
};
use rain_core::rainfall::{
    Distribution, DropSizes, GammaClimate, GammaSpectrum, RainKind, SizeLaw, Spectrum, gunn_kinzer, terminal_velocity,
};
use rain_reference::fall_speed::measured;
use rain_reference::spectrum as reference;

use super::{ODD, RATES, config};
use crate::check::Worst;

#[test]
fn exponentials_are_the_published_ones() {
    let mut worst = Worst::default();
    let mut single = Worst::default();
    for distribution in Distribution::ALL {
        let name = RainKind::from(distribution).name();
        for r in RATES {
            let spectrum = Spectrum::published(distribution, r).unwrap();
            let (n0, slope) = (reference::published(name).0, reference::slope(name, r));
            worst.relative(spectrum.slope_per_mm, slope, 1e-9, || format!("Λ {name} {r}"));
            for d in [0.0, 0.1, 1.0, 3.0, 6.0] {
                let expected = n0 * (-slope * d).exp();
                worst.relative(spectrum.concentration(d), expected, 1e-300, || {
                    format!("{name} {r} {d}")
                });
                let found = f64::from(spectrum.concentration_f32(d as f32));
                single.relative(found, expected, 1e-6, || format!("{name} {r} {d}"));
            }
        }
    }
    worst.assert_below(1e-13, 200);
    single.assert_below(1e-5, 150);
}

#[test]
fn moments_equal_brute_force_and_narrow_bins_do_not_cancel() {
    let mut worst = Worst::default();
    let mut single = Worst::default();
    let ranges = [
        (0.0, 40.0),
        (0.5, 6.0),
        (0.0, 0.01),
        (1.0, 1.001),
        (2.0, 2.3),
        (5.0, 5.000_1),
        (0.0, 1e-5),
        (0.2, 0.5),
    ];
    for r in [0.01, 1.0, 25.0, 500.0] {
        let spectrum = Spectrum::new(Distribution::MarshallPalmer, r).unwrap();
        let sizes = DropSizes::from(spectrum);
        for (a, b) in ranges {
            for n in 0..=8 {
                let slope = reference::slope("marshall-palmer", r);
                // The integrand scaled to its largest value keeps Simpson's sum from rounding to nothing.
                let end = f64::min(b, a + 60.0 / slope);
                let expected = spectrum.n0_per_m3_mm
                    * rain_reference::numerics::simpson(a, end, 4000, |d| d.powi(n as i32) * (-slope * d).exp());
                let place = || format!("M{n} {r} mm/h [{a}, {b}]");
                worst.relative(spectrum.moment(n, a, b), expected, 1e-300, place);
                assert_eq!(sizes.moment(n, a, b), spectrum.moment(n, a, b));
                // Single precision cannot hold a bin of 0.1 µm at 5 mm.
                if b - a > 5e-4 && expected > 1e-6 * spectrum.moment(n, 0.0, f64::INFINITY) {
                    single.relative(
                        f64::from(spectrum.moment_f32(n, a as f32, b as f32)),
                        {
                            let (a, b) = (f64::from(a as f32), f64::from(b as f32));
                            spectrum.moment(n, a, b)
                        },
                        1e-300,
                        place,
                    );
                }
            }
        }
    }
    worst.assert_below(1e-10, 280);
    single.assert_below(1e-5, 150);
}

#[test]
fn moment_check_values() {
    let spectrum = Spectrum::published(Distribution::MarshallPalmer, 25.0).unwrap();
    let mut worst = Worst::default();
    for (n, truncated, whole) in [
        (0, 1352.078, 3835.955),
        (2, 1607.481, 1763.886),
        (3, 2478.298, 2537.321),
    ] {
        worst.absolute(spectrum.moment(n, 0.5, 6.0), truncated, || format!("M{n} truncated"));
        worst.absolute(spectrum.moment(n, 0.0, f64::INFINITY), whole, || format!("M{n}"));
        let single = f64::from(spectrum.moment_f32(n, 0.5, 6.0)) / truncated;
        assert!((single - 1.0).abs() < 2e-6, "M{n}: {single}");
        let single = f64::from(spectrum.moment_f32(n, 0.0, f32::INFINITY)) / whole;
        assert!((single - 1.0).abs() < 2e-6, "M{n}: {single}");
    }
    worst.assert_below(5.1e-4, 6);
}

#[test]
fn fluxes_of_a_spectrum_are_sums_over_its_drops() {
    let mut worst = Worst::default();
    for distribution in Distribution::ALL {
        for r in RATES.into_iter().filter(|&r| r > 0.0) {
            let spectrum = Spectrum::new(distribution, r).unwrap();
            let slope = spectrum.slope_per_mm;
            let sum = |n: i32, a: f64, b: f64, speed: fn(f64) -> f64| {
                let f = |d: f64| spectrum.n0_per_m3_mm * (-slope * d).exp() * d.powi(n) * speed(d);
                // The fit has its corner at 5.8 mm.
                [(a, b.min(5.8)), (a.max(5.8), b.min(a + 60.0 / slope))]
                    .into_iter()
                    .filter(|(from, to)| to > from)
                    .map(|(from, to)| rain_reference::numerics::simpson(from, to, 4000, f))
                    .sum::<f64>()
            };
            for (a, b) in [
                (0.0, f64::INFINITY),
                (0.0, 0.5),
                (0.5, 6.0),
                (1.0, 1.1),
                (3.0, f64::INFINITY),
            ] {
                for n in [0, 2, 3, 6] {
                    let found = spectrum.flux_moment(n, a, b);
                    let exact = sum(n as i32, a, b, terminal_velocity);
                    worst.relative(found, exact, 1e-200, || {
                        format!("{distribution:?} {r}: {n} over {a} to {b}")
                    });
                }
            }
            let drift = sum(3, 0.2, 6.0, |_| 1.0) / sum(3, 0.2, 6.0, terminal_velocity);
            worst.relative(spectrum.mean_inverse_velocity(), drift, 1e-9, || {
                format!("{distribution:?} {r}: drift")
            });
        }
    }
    worst.assert_below(1e-7, 21 * 4 * 7);
}

#[test]
fn published_spectra_miss_their_rate_by_no_more_than_is_said() {
    let carried = |distribution, r: f64| {
        DropSizes::from(Spectrum::published(distribution, r).unwrap()).rain_rate_mm_h(0.0, f64::INFINITY, gunn_kinzer)
            / r
    };
    for distribution in Distribution::ALL {
        for i in 0..=40 {
            let ratio = carried(distribution, 100_f64.powf(f64::from(i) / 40.0));
            assert!((0.72..1.19).contains(&ratio), "{distribution:?}: {ratio}");
        }
    }
    assert!((carried(Distribution::Thunderstorm, 500.0) - 0.61).abs() < 0.01);
    assert!(carried(Distribution::Drizzle, 1e-4) < 0.5);
    // Marshall & Palmer's, as the sources print it.
    for i in 0..=40 {
        let ratio = carried(Distribution::MarshallPalmer, 0.1 * 1500_f64.powf(f64::from(i) / 40.0));
        assert!((1.02..1.19).contains(&ratio), "{ratio}");
    }
    assert!((carried(Distribution::MarshallPalmer, 500.0) - 0.92).abs() < 0.01);
}

#[test]
fn published_spectra_miss_their_rate_as_tabulated() {
    let carried = |kind, r, v: fn(f64) -> f64| {
        DropSizes::published(kind, r)
            .unwrap()
            .rain_rate_mm_h(0.0, f64::INFINITY, v)
            / r
    };
    let mut worst = Worst::default();
    for (r, ratio) in [
        (0.5, 1.1723),
        (1.0, 1.1842),
        (2.0, 1.1881),
        (5.0, 1.1806),
        (10.0, 1.1652),
        (25.0, 1.1319),
        (50.0, 1.0968),
        (100.0, 1.0535),
        (150.0, 1.0246),
    ] {
        worst.absolute(carried(RainKind::MarshallPalmer, r, gunn_kinzer), ratio, || {
            format!("{r} mm/h")
        });
    }
    for (kind, ratios) in [
        (RainKind::Drizzle, [0.8952, 0.9252, 0.9215, 0.8901]),
        (RainKind::Widespread, [1.0362, 1.0330, 0.9904, 0.9218]),
        (RainKind::Thunderstorm, [0.9158, 0.8808, 0.8106, 0.7255]),
    ] {
        for (r, ratio) in [1.0, 5.0, 25.0, 100.0].into_iter().zip(ratios) {
            worst.absolute(carried(kind, r, gunn_kinzer), ratio, || format!("{kind} {r} mm/h"));
        }
    }
    // The closed form with Atlas' law, which is negative for the smallest drops.
    let atlas = |d: f64| 9.65 - 10.3 * (-0.6 * d).exp();
    for (r, ratio) in [
        (1.0, 1.1800),
        (5.0, 1.1800),
        (10.0, 1.1642),
        (25.0, 1.1295),
        (50.0, 1.0934),
        (100.0, 1.0498),
    ] {
        worst.absolute(carried(RainKind::MarshallPalmer, r, atlas), ratio, || {
            format!("Atlas {r} mm/h")
        });
        let slope = reference::slope("marshall-palmer", r);
        let closed =
            6.0 * core::f64::consts::PI * 1e-4 * 8000.0 * (57.9 / slope.powi(4) - 61.8 / (slope + 0.6).powi(4)) / r;
        worst.absolute(closed, ratio, || format!("closed form {r} mm/h"));
    }
    worst.assert_below(5.1e-5, 33);
}

#[test]
fn every_kind_carries_its_rate_with_the_law_it_was_made_for() {
    let mut worst = Worst::default();
    let mut reference_sum = Worst::default();
    for kind in RainKind::ALL {
        for r in RATES {
            let sizes = DropSizes::new(kind, r).unwrap();
            let rate = sizes.rain_rate_mm_h(0.0, f64::INFINITY, terminal_velocity);
            worst.relative(rate, r, 1e-12, || format!("{kind} {r} mm/h"));
            let sizes = DropSizes::carrying(kind, r, gunn_kinzer).unwrap();
            worst.relative(sizes.rain_rate_mm_h(0.0, f64::INFINITY, gunn_kinzer), r, 1e-12, || {
                format!("{kind} {r}")
            });
            if [0.5, 25.0, 500.0].contains(&r) {
                let end = sizes.end_mm().min(60.0);
                let slow = reference::rain_rate(0.0, end, |d| sizes.concentration(d), measured);
                reference_sum.relative(slow, r, 1e-12, || format!("{kind} {r} mm/h"));
            }
        }
        let dry = DropSizes::new(kind, 0.0).unwrap();
        assert_eq!(dry.concentration(1.0), 0.0);
        assert_eq!(dry.moment(3, 0.0, f64::INFINITY), 0.0);
    }
    worst.assert_below(1e-6, 90);
    reference_sum.assert_below(2e-6, 15);
}

#[test]
fn cheaper_renormalisations_stay_within_their_bounds() {
    let factor = |r: f64| Spectrum::quadratic(r).unwrap().n0_per_m3_mm / 8000.0;
    let mut quadratic = Worst::default();
    for i in 0..=60 {
        let r = 0.5 * 200.0_f64.powf(f64::from(i) / 60.0);
        let published = DropSizes::published(RainKind::MarshallPalmer, r).unwrap();
        let carried = published.rain_rate_mm_h(0.0, f64::INFINITY, gunn_kinzer);
        quadratic.absolute(factor(r), r / carried, || format!("{r} mm/h"));
    }
    quadratic.assert_below(0.0016, 61);
    fn gauss<const N: usize>() -> f64 {
        let mut worst = Worst::default();
        for distribution in Distribution::ALL {
            for r in RATES {
                let exact = Spectrum::new(distribution, r).unwrap().n0_per_m3_mm;
                let found = Spectrum::by_gauss::<N>(distribution, r).unwrap().n0_per_m3_mm;
                worst.relative(found, exact, 1e-12, || format!("{distribution:?} {r}"));
            }
        }
        assert_eq!(worst.count, 36);
        worst.error
    }
    let found = [gauss::<8>(), gauss::<16>(), gauss::<24>(), gauss::<64>()];
    for (found, bound) in found.into_iter().zip([3e-3, 1e-4, 5e-5, 5e-5]) {
        assert!(found < bound, "{found:e} {bound:e}");
    }
}

#[test]
fn gamma_check_values() {
    let mut worst = Worst::default();
    let mut water = Worst::default();
    let mut rate = Worst::default();
    for (mu, factor, flux, median) in [
        (0.0, 1.0, 9.0876, 3.6721),
        (1.0, 3.051_758, 9.2058, 4.6709),
        (3.0, 26.808_040, 9.3447, 6.6696),
        (5.0, 225.202_572, 9.4232, 8.6690),
        (2.0, f64::NAN, f64::NAN, 5.6702),
    ] {
        let spectrum = GammaSpectrum::new(8000.0, 1.5, mu).unwrap();
        let sizes = DropSizes::from(spectrum);
        if factor.is_finite() {
            worst.relative(spectrum.factor(), factor, 1e-9, || format!("f({mu})"));
            rate.absolute(sizes.rain_rate_mm_h(0.0, f64::INFINITY, gunn_kinzer), flux, || {
                format!("R, µ = {mu}")
            });
        }
        water.absolute(sizes.liquid_water_g_m3(0.0, f64::INFINITY), 0.497_010, || {
            format!("W, µ = {mu}")
        });
        let closed = core::f64::consts::PI * 1e-3 * 8000.0 * 0.375_f64.powi(4);
        assert!((sizes.liquid_water_g_m3(0.0, f64::INFINITY) / closed - 1.0).abs() < 1e-12);
        let d0 = sizes.volume_median_air_mm(0.0, f64::INFINITY);
        worst.absolute(d0, median * 1.5 / (4.0 + mu), || format!("D0, µ = {mu}"));
        assert!((d0 / (1.5 * (3.67 + mu) / (4.0 + mu)) - 1.0).abs() < 6.1e-4);
        // M₄/M₃ is the mass-weighted mean diameter.
        let mean = sizes.moment(4, 0.0, f64::INFINITY) / sizes.moment(3, 0.0, f64::INFINITY);
        assert!((mean - 1.5).abs() < 1e-12);
    }
    worst.assert_below(3e-5, 9);
    water.assert_below(5.1e-7, 5);
    rate.assert_below(5.1e-5, 4);
}

#[test]
fn gamma_moments_equal_brute_force() {
    let mut worst = Worst::default();
    for mu in [0.0, 0.5, 1.0, 3.0, 8.0, 20.0] {
        for dm in [0.3, 1.5, 3.0] {
            let spectrum = GammaSpectrum::new(5000.0, dm, mu).unwrap();
            for (a, b) in [
                (0.0, f64::INFINITY),
                (0.5, 6.0),
                (0.2, 0.21),
                (1.0, 3.0),
                (2.0, 2.001),
                (4.0, f64::INFINITY),
            ] {
                let end = f64::min(b, a + (60.0 + 4.0 * mu) * dm / (4.0 + mu));
                for n in [0, 2, 3, 6] {
                    let density = |d: f64| reference::gamma(5000.0, dm, mu, d) * d.powi(n as i32);
                    // √D is not smooth at 0: x² for D there.
                    let slow =
                        rain_reference::numerics::simpson(a.sqrt(), end.sqrt(), 20_000, |x| 2.0 * x * density(x * x));
                    let whole = spectrum.moment(n, 0.0, f64::INFINITY);
                    if slow > 1e-9 * whole {
                        let place = || format!("M{n}, µ = {mu}, D_m = {dm}, [{a}, {b}]");
                        worst.relative(spectrum.moment(n, a, b), slow, 1e-300, place);
                    }
                }
            }
        }
    }
    worst.assert_below(1e-9, 250);
    for (x, gamma) in [(4.0, 6.0), (0.5, core::f64::consts::PI.sqrt()), (7.0, 720.0)] {
        assert!((reference::gamma_function(x) / gamma - 1.0_f64).abs() < 1e-13);
    }
}

#[test]
fn gamma_of_shape_0_is_the_exponential() {
    let exponential = Spectrum {
        intensity_mm_h: 10.0,
        n0_per_m3_mm: 6000.0,
        slope_per_mm: 2.5,
    };
    let gamma = GammaSpectrum::new(6000.0, 4.0 / 2.5, 0.0).unwrap();
    let mut worst = Worst::default();
    for d in (0..100).map(|i| 0.1 * f64::from(i)) {
        worst.relative(gamma.concentration(d), exponential.concentration(d), 1e-300, || {
            format!("{d} mm")
        });
        worst.relative(
            gamma.moment(3, d, d + 0.5),
            exponential.moment(3, d, d + 0.5),
            1e-300,
            || format!("M3 {d}"),
        );
    }
    worst.assert_below(1e-11, 200);
}

#[test]
fn gamma_from_a_rate_alone_grows_its_drops_and_knows_its_climate() {
    for climate in GammaClimate::ALL {
        let mut last = 0.0;
        for r in RATES {
            let spectrum = GammaSpectrum::carrying(climate, 3.0, r, gunn_kinzer).unwrap();
            assert!(spectrum.mean_diameter_mm() > last, "{climate:?} {r}");
            last = spectrum.mean_diameter_mm();
            assert!((spectrum.nw_per_m3_mm() / climate.nw_per_m3_mm() - 1.0).abs() < 1e-6);
        }
    }
    let at = |climate, r| GammaSpectrum::carrying(climate, 3.0, r, gunn_kinzer).unwrap();
    // The published clusters: maritime D_m 1.5–1.75 mm, continental 2–2.75 mm, both at tens of mm/h.
    assert!((1.5..1.75).contains(&at(GammaClimate::Maritime, 30.0).mean_diameter_mm()));
    assert!((2.0..2.75).contains(&at(GammaClimate::Continental, 30.0).mean_diameter_mm()));
    assert!(at(GammaClimate::Maritime, 30.0).is_convective());
    assert!(at(GammaClimate::Continental, 60.0).is_convective());
    assert!(!at(GammaClimate::Stratiform, 2.0).is_convective());
    assert!(
        !GammaSpectrum::new(10_f64.powf(6.3 - 1.6 * 1.5) * 0.99, 1.5, 0.0)
            .unwrap()
            .is_convective()
    );
    assert!(
        GammaSpectrum::new(10_f64.powf(6.3 - 1.6 * 1.5) * 1.01, 1.5, 0.0)
            .unwrap()
            .is_convective()
    );
    assert!(!at(GammaClimate::Maritime, 0.0).is_convective());
}

#[test]
fn the_stratiform_line_cannot_carry_more_than_ten_mm_an_hour() {
    let most = (1..300)
        .map(|i| 0.02 * f64::from(i))
        .map(|dm| {
            let spectrum = GammaSpectrum::new(10_f64.powf(6.3 - 1.6 * dm), dm, 3.0).unwrap();
            spectrum.rain_rate_mm_h(0.0, f64::INFINITY, gunn_kinzer)
        })
        .fold(0.0, f64::max);
    assert!((8.0..11.0).contains(&most), "{most}");
}

#[test]
fn blends_mix_numbers_and_carry_the_rate() {
    let shares = [(RainKind::Drizzle, 1.0), (RainKind::Thunderstorm, 3.0)];
    let blend = DropSizes::blend(&shares, 20.0).unwrap();
    let (drizzle, storm) = (
        DropSizes::new(RainKind::Drizzle, 20.0).unwrap(),
        DropSizes::new(RainKind::Thunderstorm, 20.0).unwrap(),
    );
    for d in [0.1, 0.5, 1.0, 2.0, 5.0] {
        let expected = 0.25 * drizzle.concentration(d) + 0.75 * storm.concentration(d);
        assert!((blend.concentration(d) / expected - 1.0).abs() < 1e-12);
    }
    assert!((blend.rain_rate_mm_h(0.0, f64::INFINITY, terminal_velocity) / 20.0 - 1.0).abs() < 1e-6);
    assert_eq!(blend.parts().len(), 2);
    // Blending Λ instead would be another rain: it would hold 20 % fewer of the smallest drops.
    let SizeLaw::Exponential(a) = drizzle.parts()[0].1 else {
        panic!("drizzle is exponential")
    };
    let SizeLaw::Exponential(b) = storm.parts()[0].1 else {
        panic!("a thunderstorm is exponential")
    };
    let slope = 0.25 * a.slope_per_mm + 0.75 * b.slope_per_mm;
    assert!(
        (blend.moment(0, 0.0, 0.5) / blend.moment(0, 0.0, f64::INFINITY) - (1.0 - (-0.5 * slope).exp())).abs() > 0.05
    );
    let all: Vec<(RainKind, f64)> = RainKind::ALL.into_iter().map(|kind| (kind, 0.2)).collect();
    let all = DropSizes::blend(&all, 3.0).unwrap();
    assert!((all.rain_rate_mm_h(0.0, f64::INFINITY, terminal_velocity) / 3.0 - 1.0).abs() < 1e-6);
    for bad in [
        &[][..],
        &[(RainKind::Drizzle, 0.0)],
        &[(RainKind::Drizzle, -1.0), (RainKind::Gamma, 2.0)],
        &[(RainKind::Drizzle, f64::NAN)],
        &[(RainKind::Drizzle, 1.0); 6],
    ] {
        assert!(DropSizes::blend(bad, 3.0).is_err(), "{bad:?}");
    }
}

#[test]
fn constructors_refuse_what_is_outside() {
    for r in [-1e-9, 500.1, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for kind in RainKind::ALL {
            assert!(DropSizes::new(kind, r).is_err());
            assert!(DropSizes::published(kind, r).is_err());
        }
        let message = Spectrum::quadratic(r).unwrap_err().to_string();
        assert!(
            message.starts_with("intensity_mm_h is ") && message.ends_with("0 to 500 mm/h"),
            "{message}"
        );
        assert!(Spectrum::by_gauss::<8>(Distribution::Drizzle, r).is_err());
        assert!(GammaSpectrum::carrying(GammaClimate::Maritime, 3.0, r, terminal_velocity).is_err());
    }
    for (nw, dm, mu) in [
        (-1.0, 1.0, 0.0),
        (1e9, 1.0, 0.0),
        (1.0, 0.0, 0.0),
        (1.0, 11.0, 0.0),
        (1.0, 1.0, -0.1),
        (1.0, 1.0, 21.0),
        (f64::NAN, 1.0, 0.0),
        (1.0, f64::NAN, 0.0),
        (1.0, 1.0, f64::NAN),
    ] {
        assert!(GammaSpectrum::new(nw, dm, mu).is_err(), "{nw} {dm} {mu}");
    }
    for name in ["", "mp", "Drizzle", "marshall_palmer"] {
        let message = name.parse::<RainKind>().unwrap_err().to_string();
        assert!(
            message.contains(&format!("`{name}`")) && message.contains("thunderstorm"),
            "{message}"
        );
    }
    for kind in RainKind::ALL {
        assert_eq!(kind.to_string().parse(), Ok(kind));
        assert_eq!(kind.exponential().map(RainKind::from).unwrap_or(RainKind::Gamma), kind);
    }
}

#[test]
fn no_evaluator_returns_what_is_not_a_number() {
    for kind in RainKind::ALL {
        for r in [0.0, 1e-12, 1.0, 500.0] {
            let sizes = DropSizes::new(kind, r).unwrap();
            for x in ODD {
                let value = sizes.concentration(x);
                assert!(value.is_finite() && value >= 0.0, "{kind} {r} N({x}) = {value}");
                for y in ODD {
                    for value in [
                        sizes.moment(3, x, y),
                        sizes.moment(0, x, y),
                        sizes.flux_moment(3, x, y, terminal_velocity),
                        sizes.rain_rate_mm_h(x, y, gunn_kinzer),
                    ] {
                        assert!(value.is_finite() && value >= 0.0, "{kind} {r} [{x}, {y}] = {value}");
                    }
                }
            }
        }
    }
    for x in ODD {
        for y in ODD {
            let spectrum = Spectrum::new(Distribution::Drizzle, 1e-4).unwrap();
            for value in [
                spectrum.moment(6, x, y),
                spectrum.flux_moment(2, x, y),
                f64::from(spectrum.moment_f32(8, x as f32, y as f32)),
                f64::from(spectrum.concentration_f32(x as f32)),
                spectrum.concentration(x),
            ] {
                assert!(value.is_finite() && value >= 0.0, "[{x}, {y}] = {value}");
            }
            let slope = Distribution::Thunderstorm.slope_per_mm(x);
            assert!((0.8..21.0).contains(&slope), "{x}: {slope}");
        }
    }
}

#[test]
fn the_sources_counts_are_theirs_and_a_density_is_not_a_count() {
    // Yoshida's classes: the printed density, and the exact integral over 0.9–2.1 mm.
    let table = [
        (1.0, [132.6, 58.4, 25.7, 11.3, 5.0, 2.2], 48.4),
        (5.0, [429.7, 239.4, 133.4, 74.3, 41.4, 23.1], 191.0),
        (10.0, [638.5, 385.1, 232.3, 140.1, 84.5, 51.0], 309.6),
        (20.0, [899.3, 580.9, 375.2, 242.3, 156.5, 101.1], 474.8),
    ];
    for (r, densities, count) in table {
        for (d, density) in YOSHIDA_DIAMETERS_MM.into_iter().zip(densities) {
            assert!((printed_concentration(r, d) - density).abs() < 0.051, "{r} {d}");
        }
        let total: f64 = yoshida_counts_per_m3(r).iter().sum();
        assert!((total - count).abs() < 0.051, "{r}: {total}");
        assert!(densities.iter().sum::<f64>() > 4.5 * total);
    }
    // Nguyenova's table 4.2 as printed, rounded or cut, and the counts in bins of 0.5 mm.
    let table = [
        (
            2.0,
            [1360.0, 231.0, 40.0, 7.0, 1.0, 0.0],
            [772.3, 131.2, 22.3, 3.8, 0.6, 0.1],
        ),
        (
            5.0,
            [1854.0, 429.0, 99.0, 23.0, 5.0, 1.0],
            [1011.8, 234.5, 54.3, 12.6, 2.9, 0.7],
        ),
        (
            10.0,
            [2260.0, 638.0, 180.0, 50.0, 14.0, 4.0],
            [1206.8, 340.9, 96.3, 27.2, 7.7, 2.2],
        ),
    ];
    for (r, printed, bins) in table {
        for (i, d) in NGUYENOVA_DIAMETERS_MM.into_iter().enumerate() {
            assert!((printed_concentration(r, d) - printed[i]).abs() < 1.0, "{r} {d}");
            assert!((nguyenova_counts_per_m3(r)[i] - bins[i]).abs() < 0.051, "{r} {d}");
        }
        // Read as a radius, a 1 mm drop would be counted several times too often.
        assert!(printed_concentration(r, 0.5) > 3.0 * printed_concentration(r, 1.0));
    }
    for x in ODD {
        for value in [
            printed_concentration(x, 1.0),
            printed_concentration(1.0, x),
            yoshida_counts_per_m3(x)[0],
        ] {
            assert!(value.is_finite() && value >= 0.0, "{x}: {value}");
        }
    }
    assert_eq!(yoshida_counts_per_m3(0.0), [0.0; 6]);
}

#[test]
fn rates_sizes_and_moments_are_ordered() {
    proptest!(config(), |(r in 0.01..400.0_f64, more in 1.01..1.2_f64, cut in 0.1..6.0_f64, n in 0_u32..7)| {
        for kind in RainKind::ALL {
            let (less, heavy) = (DropSizes::new(kind, r).unwrap(), DropSizes::new(kind, r * more).unwrap());
            // More rain, more water in the air; the parts of a range add up to the whole.
            prop_assert!(heavy.liquid_water_g_m3(0.0, f64::INFINITY) > less.liquid_water_g_m3(0.0, f64::INFINITY));
            let whole = less.moment(n, 0.0, f64::INFINITY);
            let parts = less.moment(n, 0.0, cut) + less.moment(n, cut, f64::INFINITY);
            prop_assert!((parts / whole - 1.0).abs() < 1e-10, "{} M{}: {} {}", kind, n, parts, whole);
            let below = less.rain_rate_mm_h(0.0, cut, terminal_velocity);
            let flux = below + less.rain_rate_mm_h(cut, f64::INFINITY, terminal_velocity);
            prop_assert!((flux / r - 1.0).abs() < 2e-6, "{}: {} {}", kind, flux, r);
        }
    });
}
