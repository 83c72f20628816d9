//! Drop-size distributions: renormalisation, sampling, size classes.

use std::hint::black_box;

use rain_bench::study::{Study, Variant};
use rain_core::rainfall::{
    CLASS_EDGES_MM, ClassErrors, ClassScheme, ClassWeights, DiameterTable, Distribution, DropSizes, RainKind, Spectrum,
    gunn_kinzer, terminal_velocity,
};
use rain_reference::{fall_speed, spectrum as reference};

/// Rain states of one run, 0.5 to 100 mm/h. Units: mm/h.
fn rates() -> Vec<f64> {
    (0..64)
        .map(|i| 0.5 * 200_f64.powf(f64::from(i * 37 % 64) / 63.0))
        .collect()
}

/// A way from the rain rate to a spectrum, with the fall law it was made for.
fn renormalised(name: &str, speed: fn(f64) -> f64, spectrum: impl Fn(f64) -> (f64, f64) + 'static) -> Variant {
    let error = [0.5, 1.0, 2.0, 5.0, 10.0, 25.0, 50.0, 100.0]
        .into_iter()
        .map(|r| {
            let (n0, slope) = spectrum(r);
            let carried = reference::rain_rate(0.0, 50.0 / slope, |d| n0 * (-slope * d).exp(), speed);
            (carried / r - 1.0).abs()
        })
        .fold(0.0, f64::max);
    let rates = rates();
    Variant::new(name, error, rates.len() as u64, move || {
        black_box(&rates).iter().map(|r| spectrum(*r).0).sum()
    })
}

fn parameters(spectrum: Result<Spectrum, rain_core::error::ConfigError>) -> (f64, f64) {
    let spectrum = spectrum.expect("a rate inside the domain");
    (spectrum.n0_per_m3_mm, spectrum.slope_per_mm)
}

fn gauss<const N: usize>() -> Variant {
    renormalised(&format!("Gauss {N}"), fall_speed::fit, |r| {
        parameters(Spectrum::by_gauss::<N>(Distribution::MarshallPalmer, r))
    })
}

fn renormalisation() -> Study {
    Study {
        name: "renormalisation",
        title: "N0 of Marshall & Palmer's spectrum so that it carries its rain rate",
        norm: "largest |R carried/R - 1| with the way's own fall law, 0.5-100 mm/h",
        unit: "rain state",
        variants: vec![
            renormalised("closed form", fall_speed::fit, |r| {
                parameters(Spectrum::new(Distribution::MarshallPalmer, r))
            })
            .default(),
            gauss::<8>(),
            gauss::<16>(),
            gauss::<24>(),
            gauss::<64>(),
            renormalised("quadratic in ln R", fall_speed::measured, |r| {
                parameters(Spectrum::quadratic(r))
            }),
            renormalised("panels, measured speeds", fall_speed::measured, |r| {
                let sizes = DropSizes::carrying(RainKind::MarshallPalmer, r, gunn_kinzer).expect("inside the domain");
                let law = sizes.parts()[0].1;
                (law.n0_per_m3_mm(), law.slope_per_mm())
            }),
            renormalised("as published", fall_speed::measured, |r| {
                parameters(Spectrum::published(Distribution::MarshallPalmer, r))
            }),
        ],
    }
}

/// Looks up 4096 shares; the error is that of the mean D³ over many more.
fn sampled(name: String, diameter: impl Fn(f32) -> f32 + 'static) -> Variant {
    let sizes = ten_mm_h();
    let weight = |d: f64| sizes.concentration(d) * gunn_kinzer(d);
    let exact = reference::sum(0.2, 6.0, |d| weight(d) * d.powi(3)) / reference::sum(0.2, 6.0, weight);
    let many = 1 << 18;
    let cubes: f64 = (0..many)
        .map(|i| f64::from(diameter((i as f32 + 0.5) / many as f32)).powi(3))
        .sum();
    let shares: Vec<f32> = (0..4096_u32)
        .map(|i| rain_core::hash::open_unit_f32(rain_core::hash::pcg(i)))
        .collect();
    Variant::new(name, (cubes / f64::from(many) / exact - 1.0).abs(), 4096, move || {
        f64::from(black_box(&shares).iter().map(|u| diameter(*u)).sum::<f32>())
    })
}

fn ten_mm_h() -> DropSizes {
    DropSizes::carrying(RainKind::MarshallPalmer, 10.0, gunn_kinzer).expect("inside the domain")
}

fn warped<const N: usize>() -> Variant {
    let table = DiameterTable::<N>::on_ground(&ten_mm_h(), 0.2, 6.0, gunn_kinzer).expect("a range with drops");
    sampled(format!("table {N}, warped"), move |u| table.diameter_mm(u))
}

/// A table of equal steps of u, from a very fine warped one.
fn uniform(entries: usize) -> Variant {
    let fine = DiameterTable::<16_384>::on_ground(&ten_mm_h(), 0.2, 6.0, gunn_kinzer).expect("a range with drops");
    let table: Vec<f32> = (0..=entries)
        .map(|i| fine.diameter_mm(i as f32 / entries as f32))
        .collect();
    sampled(format!("table {entries}, uniform in u"), move |u| {
        let place = u * entries as f32;
        let i = (place as usize).min(entries - 1);
        table[i] + (place - i as f32) * (table[i + 1] - table[i])
    })
}

/// Binary search in the cumulative sum over 4096 diameters.
fn searched() -> Variant {
    let sizes = ten_mm_h();
    let mut below = vec![0.0_f64];
    let h = 5.8 / 4096.0;
    for i in 0..4096 {
        let d = 0.2 + h * (f64::from(i) + 0.5);
        below.push(below[i as usize] + sizes.concentration(d) * gunn_kinzer(d));
    }
    sampled("binary search, 4096".to_owned(), move |u| {
        let target = f64::from(u) * below[4096];
        let i = below.partition_point(|sum| *sum < target).clamp(1, 4096);
        let part = (target - below[i - 1]) / (below[i] - below[i - 1]);
        (0.2 + h * ((i - 1) as f64 + part)) as f32
    })
}

fn sampling() -> Study {
    Study {
        name: "diameter-sampling",
        title: "Random diameters of the drops that reach the ground (10 mm/h, 0.2-6 mm)",
        norm: "relative error of the mean D^3",
        unit: "drop",
        variants: vec![
            warped::<32>(),
            warped::<64>(),
            warped::<128>().default(),
            warped::<256>(),
            uniform(128),
            uniform(1024),
            searched(),
        ],
    }
}

/// Number, water and extinction of any classes, in the way of [`ClassWeights`].
struct AnyClasses {
    edges: Vec<f64>,
    /// Distance of the outer points from the middle, and the weights of the three.
    rules: Vec<(f64, [f64; 3])>,
}

impl AnyClasses {
    fn new(edges: &[f64]) -> Self {
        let rule = rain_core::quadrature::GaussLegendre::<3>::RULE;
        let rules = edges
            .windows(2)
            .map(|pair| {
                let (mid, half) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
                let weights = core::array::from_fn(|i| {
                    let d = mid + half * rule.nodes[i];
                    half * rule.weights[i] * 6e-4 * core::f64::consts::PI * d.powi(3) * terminal_velocity(d)
                });
                (half * rule.nodes[2], weights)
            })
            .collect();
        Self {
            edges: edges.to_vec(),
            rules,
        }
    }

    fn weights(&self, spectrum: &Spectrum, out: &mut [[f64; 3]]) {
        let (n0, slope) = (spectrum.n0_per_m3_mm, spectrum.slope_per_mm);
        let beyond = |d: f64| {
            let e = rain_core::ops::exp(-slope * d);
            (e, e * (1.0 + slope * d * (1.0 + 0.5 * slope * d)))
        };
        let mut from = beyond(self.edges[0]);
        for ((edge, (reach, weights)), out) in self.edges[1..].iter().zip(&self.rules).zip(out) {
            let to = beyond(*edge);
            let fall = rain_core::ops::exp(-slope * reach);
            *out = [
                n0 / slope * (from.0 - to.0),
                n0 * (from.0 * to.0).sqrt() * (weights[0] / fall + weights[1] + weights[2] * fall),
                core::f64::consts::FRAC_PI_2 * 1e-6 * n0 / slope.powi(3) * (from.1 - to.1),
            ];
            from = to;
        }
    }
}

/// Which error a study of classes shows.
type ClassNorm = fn(&ClassErrors) -> f64;

fn classes(scheme: ClassScheme, count: usize, norm: ClassNorm) -> Variant {
    let mut edges = vec![0.0; count + 1];
    scheme
        .edges(0.5, 6.0, gunn_kinzer, &mut edges)
        .expect("edges inside the domain");
    let rain = |r: f64| DropSizes::carrying(RainKind::MarshallPalmer, r, gunn_kinzer).expect("inside the domain");
    let held = rain(25.0);
    let error = [1.0, 5.0, 25.0, 100.0]
        .into_iter()
        .map(|r| norm(&ClassErrors::of(&edges, &rain(r), &held, gunn_kinzer).expect("rising edges")))
        .fold(0.0, f64::max);
    let name = match scheme {
        ClassScheme::Logarithmic => format!("{count}, equal ratios"),
        ClassScheme::EqualSpeed => format!("{count}, equal speeds"),
        ClassScheme::EqualDiameter => format!("{count}, equal diameters"),
    };
    let spectra = spectra();
    let any = AnyClasses::new(&edges);
    let mut out = vec![[0.0; 3]; count];
    Variant::new(name, error, spectra.len() as u64, move || {
        let mut sum = 0.0;
        for spectrum in black_box(&spectra) {
            any.weights(spectrum, &mut out);
            sum += black_box(&out)[count / 2][1];
        }
        sum
    })
}

fn spectra() -> Vec<Spectrum> {
    rates()
        .into_iter()
        .map(|r| Spectrum::new(Distribution::MarshallPalmer, r).expect("inside the domain"))
        .collect()
}

fn class_study(name: &'static str, title: &'static str, norm_name: &'static str, norm: ClassNorm) -> Study {
    let mut variants: Vec<Variant> = [6, 8, 12, 16, 24]
        .into_iter()
        .flat_map(|count| ClassScheme::ALL.map(|scheme| (scheme, count)))
        .map(|(scheme, count)| {
            let variant = classes(scheme, count, norm);
            if scheme == ClassScheme::Logarithmic && count == 12 {
                variant.default()
            } else {
                variant
            }
        })
        .collect();
    variants.sort_by_key(|variant| !variant.default);
    Study {
        name,
        title,
        norm: norm_name,
        unit: "rain state",
        variants,
    }
}

/// Largest error of a class's water against brute force, as a share of the rain.
fn weight_error(weights: impl Fn(&Spectrum) -> [f64; 12]) -> f64 {
    [1.0, 25.0, 100.0]
        .into_iter()
        .flat_map(|r| {
            let spectrum = Spectrum::new(Distribution::MarshallPalmer, r).expect("inside the domain");
            let found = weights(&spectrum);
            (0..12).map(move |k| {
                let n = |d: f64| spectrum.concentration(d);
                let exact = reference::rain_rate(CLASS_EDGES_MM[k], CLASS_EDGES_MM[k + 1], n, fall_speed::fit);
                ((found[k] - exact) / r).abs()
            })
        })
        .fold(0.0, f64::max)
}

fn by_quadrature(spectrum: &Spectrum) -> [f64; 12] {
    core::array::from_fn(|k| spectrum.rain_rate_mm_h(CLASS_EDGES_MM[k], CLASS_EDGES_MM[k + 1]))
}

/// A value that depends on all three weights.
fn mixed(spectrum: &Spectrum) -> f64 {
    let weights = ClassWeights::new(spectrum);
    weights.number_per_m3[3] + weights.rain_rate_mm_h[7] + weights.extinction_per_m[11]
}

fn class_weights() -> Study {
    let by_points = |spectrum: &Spectrum| ClassWeights::new(spectrum).rain_rate_mm_h;
    let timed = |name: &str, error: f64, work: fn(f64, &Spectrum) -> f64| {
        let (rates, spectra) = (rates(), spectra());
        Variant::new(name, error, rates.len() as u64, move || {
            black_box(&rates)
                .iter()
                .zip(black_box(&spectra))
                .map(|(r, spectrum)| work(*r, spectrum))
                .sum()
        })
    };
    let error = weight_error(by_points);
    Study {
        name: "class-weights",
        title: "Number, water and extinction of the twelve size classes",
        norm: "largest error of a class's water, share of the rain",
        unit: "rain state",
        variants: vec![
            timed("three points a class", error, |_, spectrum| mixed(spectrum)).default(),
            timed("with renormalisation by Gauss 24", error, |r, _| {
                Spectrum::by_gauss::<24>(Distribution::MarshallPalmer, r).map_or(0.0, |s| mixed(&s))
            }),
            timed("with renormalisation in closed form", error, |r, _| {
                Spectrum::new(Distribution::MarshallPalmer, r).map_or(0.0, |s| mixed(&s))
            }),
            timed("panels a class", weight_error(by_quadrature), |_, spectrum| {
                by_quadrature(spectrum)[7]
            }),
        ],
    }
}

/// Every study of this file.
pub fn studies() -> Vec<Study> {
    vec![
        renormalisation(),
        sampling(),
        class_weights(),
        class_study(
            "size-classes-water",
            "Size classes from 0.5 to 6 mm, one speed each, held at 25 mm/h",
            "largest |error of the water flux|, 1-100 mm/h",
            |errors| errors.water_flux.abs(),
        ),
        class_study(
            "size-classes-number",
            "Size classes from 0.5 to 6 mm, one speed each, held at 25 mm/h",
            "largest |error of the number flux|, 1-100 mm/h",
            |errors| errors.number_flux.abs(),
        ),
        class_study(
            "size-classes-extinction",
            "Size classes from 0.5 to 6 mm, one diameter each, held at 25 mm/h",
            "largest |error of extinction|, 1-100 mm/h",
            |errors| errors.extinction.abs(),
        ),
        class_study(
            "size-classes-speed",
            "Size classes from 0.5 to 6 mm, one speed each, held at 25 mm/h",
            "largest rms of class speed over own speed, less 1, weighted by area, 1-100 mm/h",
            |errors| errors.speed_rms,
        ),
    ]
}
