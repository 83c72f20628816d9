//! Film steps, recession of sheet flow, wet albedo.

use std::hint::black_box;

use rain_bench::study::{Study, Variant};
use rain_core::surface::artist_look::{ArtistLook, lagarde_wet};
use rain_core::surface::{WetBody, fast_film_step_f32, film_step, film_step_f32, recession_share, wet_albedo_f32};
use rain_reference::surface as truth;

/// Every study of this file.
pub fn studies() -> Vec<Study> {
    vec![film(), recession(), albedo()]
}

/// Rain (m/s) and drain (m^(−2/3)/s) of texel i.
fn texel(i: u32) -> (f64, f64) {
    let share = f64::from(i % 64) / 63.0;
    (1e-6 * 30_f64.powf(share), 0.2 * 50_f64.powf(f64::from(i % 7) / 6.0))
}

/// Largest relative deviation of `minute` (rain, drain → film after 60 s on dry ground) over the texels.
fn off(exact: &[f64], minute: impl Fn(f64, f64) -> f64) -> f64 {
    exact
        .iter()
        .enumerate()
        .map(|(i, exact)| {
            let (rain, drain) = texel(i as u32);
            (minute(rain, drain) / exact - 1.0).abs()
        })
        .fold(0.0, f64::max)
}

fn film() -> Study {
    let exact: Vec<f64> = (0..64)
        .map(|i| {
            let (rain, drain) = texel(i);
            truth::film(0.0, rain, drain, 60.0, 4000)
        })
        .collect();
    let texels: Vec<(f64, f64)> = (0..448).map(texel).collect();
    let singles: Vec<(f32, f32)> = texels.iter().map(|&(p, k)| (p as f32, k as f32)).collect();
    let steps = |dt: f64| (60.0 / dt).round() as u32;
    let mut variants = Vec::new();
    for dt in [20.0, 5.0, 1.0, 0.25] {
        let texels = texels.clone();
        let minute = move |p: f64, k: f64| (0..steps(dt)).fold(0.0, |h, _| film_step(h, p, k, dt));
        variants.push(Variant::new(
            format!("Strang, f64, dt {dt} s"),
            off(&exact, minute),
            448,
            move || texels.iter().map(|&(p, k)| minute(black_box(p), k)).sum(),
        ));
    }
    for dt in [1.0, 1.0 / 60.0] {
        let singles = singles.clone();
        let minute = move |p: f32, k: f32| (0..steps(dt)).fold(0.0, |h, _| film_step_f32(h, p, k, dt as f32));
        let error = off(&exact, |p, k| f64::from(minute(p as f32, k as f32)));
        variants.push(Variant::new(
            format!("Strang, f32, dt {dt:.3} s"),
            error,
            448,
            move || singles.iter().map(|&(p, k)| f64::from(minute(black_box(p), k))).sum(),
        ));
    }
    for dt in [5.0, 1.0, 1.0 / 60.0] {
        let singles = singles.clone();
        let dt32 = dt as f32;
        let minute = move |p: f32, k: f32| (0..steps(dt)).fold(0.0, |h, _| fast_film_step_f32(h, p, k, dt32));
        let error = off(&exact, |p, k| f64::from(minute(p as f32, k as f32)));
        // Texel by texel in every step, as a grid is: the compiler may take several at once.
        let mut films = vec![0.0_f32; singles.len()];
        let variant = Variant::new(
            format!("Strang, f32, own cube root, dt {dt:.3} s"),
            error,
            448,
            move || {
                films.fill(0.0);
                for _ in 0..steps(dt) {
                    for (h, &(p, k)) in films.iter_mut().zip(black_box(&singles)) {
                        *h = fast_film_step_f32(*h, p, k, dt32);
                    }
                }
                films.iter().map(|h| f64::from(*h)).sum()
            },
        );
        variants.push(if dt == 1.0 { variant.default() } else { variant });
    }
    for dt in [5.0, 1.0, 0.1] {
        let texels = texels.clone();
        let minute =
            move |p: f64, k: f64| (0..steps(dt)).fold(0.0_f64, |h, _| (h + dt * (p - k * h.powf(5.0 / 3.0))).max(0.0));
        variants.push(Variant::new(
            format!("Euler, f64, dt {dt} s"),
            off(&exact, minute),
            448,
            move || texels.iter().map(|&(p, k)| minute(black_box(p), k)).sum(),
        ));
    }
    Study {
        name: "film-step",
        title: "Film of a texel in a minute of rain",
        norm: "max |h/h_ref - 1|",
        unit: "texel minute",
        variants,
    }
}

fn recession() -> Study {
    let ratios: Vec<f64> = (0..256).map(|i| 1e-6 * 1e12_f64.powf(f64::from(i) / 255.0)).collect();
    let halved = |c: f64, halvings: u32| {
        let (mut a, mut b) = (0.0, 1.0);
        for _ in 0..halvings {
            let mid: f64 = 0.5 * (a + b);
            if mid.powi(5) + c * mid * mid > 1.0 {
                b = mid
            } else {
                a = mid
            }
        }
        0.5 * (a + b)
    };
    let worst = |f: &dyn Fn(f64) -> f64| {
        let off =
            |c: f64| (f(c) / rain_reference::numerics::bisect(0.0, 1.0, |u| u.powi(5) + c * u * u - 1.0) - 1.0).abs();
        ratios.iter().map(|&c| off(c)).fold(0.0, f64::max)
    };
    let mut variants = Vec::new();
    for steps in 1..=6 {
        let ratios = ratios.clone();
        let variant = Variant::new(
            format!("Newton, {steps} steps"),
            worst(&|c| recession_share(5, c, steps)),
            256,
            move || ratios.iter().map(|&c| recession_share(5, black_box(c), steps)).sum(),
        );
        variants.push(if steps == 5 { variant.default() } else { variant });
    }
    for halvings in [20, 52] {
        let ratios = ratios.clone();
        variants.push(Variant::new(
            format!("bisection, {halvings} halvings"),
            worst(&|c| halved(c, halvings)),
            256,
            move || ratios.iter().map(|&c| halved(black_box(c), halvings)).sum(),
        ));
    }
    Study {
        name: "sheet-flow-recession",
        title: "Recession of sheet flow: root of u^5 + c u^2 = 1",
        norm: "max |u/u_ref - 1|",
        unit: "evaluation",
        variants,
    }
}

/// Least-squares cubic ρ (c₁ + c₂ ρ + c₃ ρ²) through the wet albedo, by normal equations over 257 points.
fn cubic() -> [f32; 3] {
    let (mut m, mut v) = ([[0.0; 3]; 3], [0.0; 3]);
    for i in 0..=256 {
        let dry = f64::from(i) / 256.0;
        let powers = [dry, dry * dry, dry * dry * dry];
        for (row, p) in powers.into_iter().enumerate() {
            v[row] += p * WetBody::LEKNER_DORF.albedo(dry);
            for (column, q) in powers.into_iter().enumerate() {
                m[row][column] += p * q;
            }
        }
    }
    let determinant = |m: &[[f64; 3]; 3]| {
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    };
    let whole = determinant(&m);
    core::array::from_fn(|column| {
        let mut replaced = m;
        for row in 0..3 {
            replaced[row][column] = v[row];
        }
        (determinant(&replaced) / whole) as f32
    })
}

/// A variant of the wet albedo: the function is a type of its own, so that it is compiled into the loop.
fn channels(name: &str, error: f64, dry: &[f32], f: impl Fn(f32) -> f32 + 'static) -> Variant {
    let dry = dry.to_vec();
    Variant::new(name, error, dry.len() as u64, move || {
        black_box(&dry).iter().map(|&d| f64::from(f(d))).sum()
    })
}

fn albedo() -> Study {
    let dry: Vec<f32> = (0..1024).map(|i| ((i * 389) % 1024) as f32 / 1023.0).collect();
    let exact: Vec<f64> = (0..=32)
        .map(|i| truth::lekner_dorf(f64::from(i) / 32.0, [1.333, 1.55], rain_core::surface::WATER_F0))
        .collect();
    let worst = |f: &dyn Fn(f32) -> f64| {
        let off = |(i, e): (usize, &f64)| (f(i as f32 / 32.0) - e).abs();
        exact.iter().enumerate().map(off).fold(0.0, f64::max)
    };
    // Tables are worst between their entries.
    let between = |f: &dyn Fn(f32) -> f64| {
        let off = |i: u32| {
            let dry = f64::from(i) / 9973.0;
            (f(dry as f32) - WetBody::LEKNER_DORF.albedo(dry)).abs()
        };
        (0..=9973).map(off).fold(worst(f), f64::max)
    };
    let wide = |d: f32| WetBody::LEKNER_DORF.albedo(f64::from(d));
    let mut variants = vec![
        channels("Lekner-Dorf, f64", worst(&wide), &dry, move |d| wide(d) as f32),
        channels(
            "Lekner-Dorf, f32",
            worst(&|d| f64::from(wet_albedo_f32(d))),
            &dry,
            wet_albedo_f32,
        )
        .default(),
    ];
    for entries in [8_u16, 16, 64, 256] {
        let last = f32::from(entries - 1);
        let table: Vec<f32> = (0..entries).map(|i| wet_albedo_f32(f32::from(i) / last)).collect();
        let read = move |d: f32| {
            let x = d * last;
            let i = (x as usize).min(table.len() - 2);
            table[i] + (table[i + 1] - table[i]) * (x - i as f32)
        };
        let error = between(&|d| f64::from(read(d)));
        variants.push(channels(&format!("table of {entries}"), error, &dry, read));
    }
    let [c1, c2, c3] = cubic();
    let polynomial = move |d: f32| d * (c1 + d * (c2 + d * c3));
    variants.push(channels(
        "cubic",
        between(&|d| f64::from(polynomial(d))),
        &dry,
        polynomial,
    ));
    let angstrom = |d: f32| WetBody::ANGSTROM.albedo_f32(d);
    variants.push(channels(
        "Angstrom, f32",
        worst(&|d| f64::from(angstrom(d))),
        &dry,
        angstrom,
    ));
    let source = |d: f32| {
        let look = ArtistLook {
            albedo: f64::from(d),
            gloss: 0.3,
            f0: 0.04,
        };
        lagarde_wet(look, 1.0).albedo as f32
    };
    variants.push(channels(
        "factor 0.3 of both sources",
        worst(&|d| f64::from(source(d))),
        &dry,
        source,
    ));
    Study {
        name: "wet-albedo",
        title: "Albedo of a soaked surface",
        norm: "max |albedo - Lekner-Dorf|",
        unit: "channel",
        variants,
    }
}
