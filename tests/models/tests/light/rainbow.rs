//! Rainbows against rays, Mie's series and what one sees.

use core::f64::consts::PI;
use std::sync::OnceLock;

use rain_core::haze::LUMA_LINEAR;
use rain_core::optics::{
    BOW_KNOTS, BowRays, RainbowPhase, RainbowTables, bow_place, fresnel, rainbow, sphere_order_share, water_index,
};
use rain_core::rainfall::{Distribution, Spectrum};
use rain_reference::light::rainbow as reference;

use super::NOT_NUMBERS;

const N: f64 = 1.333;
const SUN_RAD: f64 = 0.2666 * PI / 180.0;

fn tables() -> &'static RainbowTables {
    static TABLES: OnceLock<RainbowTables> = OnceLock::new();
    TABLES.get_or_init(RainbowTables::new)
}

fn luminance(colour: [f64; 3]) -> f64 {
    colour.iter().zip(LUMA_LINEAR).map(|(c, l)| c * l).sum()
}

/// ∫ 2π sin γ P dγ between two angles.
fn share(from: f64, to: f64, phase: impl Fn(f64) -> f64) -> f64 {
    let steps = ((to - from) / 2e-4).ceil();
    let step = (to - from) / steps;
    (0..steps as u32)
        .map(|i| from + (f64::from(i) + 0.5) * step)
        .map(|angle| 2.0 * PI * angle.sin() * phase(angle) * step)
        .sum()
}

#[test]
fn bows_of_large_drops_are_those_of_traced_rays() {
    let edges: Vec<f64> = (0..=180).map(|d| f64::from(d).to_radians()).collect();
    let traced = reference::bow_shares(N, &edges, 0.0, 400_000);
    let rays = BowRays::new(N);
    // Two millimetres of radius in green light.
    let size = 2.0 * PI * 2e-3 / 0.55e-6;
    let bows = [1, 2].map(|k| rainbow(k, N).expect("a bow").angle_rad);
    let mut compared = 0;
    for (edge, traced) in edges.windows(2).zip(&traced) {
        if bows
            .iter()
            .any(|bow| edge[0] - 0.0175 < *bow && edge[1] + 0.0175 > *bow)
        {
            continue;
        }
        let ours = share(edge[0], edge[1], |angle| rays.phase_per_sr(angle, size));
        // What rings of equal area make of a ring of a degree.
        let allowed = 0.02 * traced + 2e-6;
        assert!((ours - traced).abs() < allowed, "{edge:?}: {ours} {traced}");
        compared += 1;
    }
    assert!(compared > 170, "{compared}");
    // Nothing is lost at the bows.
    for (span, order) in [([0.0, 46.5], 2), ([46.5, 180.0], 3)] {
        let [from, to] = span.map(f64::to_radians);
        let ours = share(from, to, |angle| rays.phase_per_sr(angle, size));
        let expected = sphere_order_share(order, N);
        assert!((ours / expected - 1.0).abs() < 0.02, "{order}: {ours} {expected}");
    }
}

#[test]
fn bows_of_small_drops_are_those_of_mies_series() {
    let rays = BowRays::new(N);
    for radius_um in [25.0, 60.0] {
        let size = 2.0 * PI * radius_um / 0.55;
        // From inside the bow out to the dark.
        let angles: Vec<f64> = (26..=90).map(|i| f64::from(i) * 0.5).map(f64::to_radians).collect();
        let scattered: Vec<f64> = angles.iter().map(|angle| PI - angle).collect();
        // The same mixture about this size, in weights that fall straight to 0 at e^(±0.3).
        let mut mie = vec![0.0; angles.len()];
        let sizes = 240;
        for i in 0..sizes {
            let t = (f64::from(i) + 0.5) / f64::from(sizes) * 2.0 - 1.0;
            let weight = 2.0 / f64::from(sizes) * (1.0 - t.abs());
            let one = reference::mie_phase_per_sr(size * (0.3 * t).exp(), N, &scattered);
            for (sum, one) in mie.iter_mut().zip(one) {
                *sum += weight * one;
            }
        }
        let ours: Vec<f64> = angles.iter().map(|angle| rays.phase_per_sr(*angle, size)).collect();
        let greatest = ours.iter().fold(0.0, |a: f64, b| a.max(*b));
        let mut worst: f64 = 0.0;
        for ((angle, mie), ours) in angles.iter().zip(&mie).zip(&ours) {
            // What is reflected outside leaves everywhere: F at half the angle.
            let outside = fresnel((0.5 * angle).cos(), N) / (4.0 * PI);
            worst = worst.max((ours + outside - mie).abs() / greatest);
        }
        assert!(worst < 0.12, "{radius_um} µm: {worst}");
    }
}

#[test]
fn colours_of_the_bow_of_large_drops_are_those_of_rays_of_each_wavelength() {
    let edges: Vec<f64> = (0..=40).map(|i| (36.0 + f64::from(i) * 0.5).to_radians()).collect();
    let spectra: Vec<Vec<f64>> = (0..31)
        .map(|i| {
            let index = water_index(0.4 + 0.01 * f64::from(i));
            reference::bow_shares(index, &edges, SUN_RAD, 150_000)
        })
        .collect();
    let bow = tables().of_radius(4e-3);
    let mut rings = Vec::new();
    for (ring, edge) in edges.windows(2).enumerate() {
        let traced = reference::rec709(&core::array::from_fn(|i| spectra[i][ring]));
        let ours: [f64; 3] = core::array::from_fn(|c| share(edge[0], edge[1], |angle| bow.per_sr(angle)[c]));
        rings.push((edge[0].to_degrees(), ours, traced));
    }
    let greatest = rings.iter().map(|(_, _, t)| luminance(*t)).fold(0.0, f64::max);
    for (from, ours, traced) in rings {
        let off = (luminance(ours) - luminance(traced)).abs() / greatest;
        assert!(off < 0.1, "{from}: {ours:?} {traced:?}");
    }
}

#[test]
fn the_bow_of_rain_is_the_mean_over_its_drops() {
    let spectrum = Spectrum::new(Distribution::MarshallPalmer, 10.0).expect("a rate");
    let bow = tables().of_rain(&spectrum);
    let greatest = bow
        .rgb_per_sr
        .iter()
        .map(|e| luminance([e[0], e[1], e[2]].map(f64::from)))
        .fold(0.0, f64::max);
    // Luminance by the eye's own curve, each size and wavelength by itself, in a disc of nine strips.
    let wavelengths: Vec<(f64, BowRays)> = (0..31)
        .map(|i| 0.4 + 0.01 * f64::from(i))
        .map(|um| (um, BowRays::new(water_index(um))))
        .collect();
    let even = reference::rec709(&[1.0; 31]);
    assert!((even[1] - 1.0).abs() < 1e-12);
    let sizes: Vec<(f64, f64)> = (0..300)
        .map(|i| (f64::from(i) + 0.5) / 300.0)
        .map(|t| {
            let d = 0.02 * (t * 400.0_f64.ln()).exp();
            (d, spectrum.concentration(d) * d * d * d)
        })
        .collect();
    let total: f64 = sizes.iter().map(|(_, w)| w).sum();
    for degrees in [
        20.0, 36.0, 40.0, 41.0, 41.75, 42.5, 43.5, 47.0, 50.5, 52.0, 55.0, 80.0_f64,
    ] {
        let spectrum: [f64; 31] = core::array::from_fn(|i| {
            let (um, rays) = &wavelengths[i];
            let mut sum = 0.0;
            for strip in 0..9 {
                let u = (f64::from(strip) + 0.5) / 4.5 - 1.0;
                let weight = (1.0 - u * u).sqrt();
                let angle = degrees.to_radians() + SUN_RAD * u;
                for (d, w) in &sizes {
                    sum += weight * w * rays.phase_per_sr(angle, PI * d * 1e-3 / (um * 1e-6));
                }
            }
            sum / (total
                * (0..9)
                    .map(|s| (1.0 - ((f64::from(s) + 0.5) / 4.5 - 1.0_f64).powi(2)).sqrt())
                    .sum::<f64>())
        });
        let expected = luminance(reference::rec709(&spectrum));
        let ours = luminance(bow.per_sr(degrees.to_radians()));
        assert!(
            (ours - expected).abs() < 0.02 * greatest,
            "{degrees}: {ours} {expected}"
        );
    }
}

fn brightest(bow: &RainbowPhase, from: f64, to: f64, value: impl Fn([f64; 3]) -> f64) -> f64 {
    let mut best = (f64::MIN, 0.0);
    let mut degrees = from;
    while degrees <= to {
        let here = value(bow.per_sr(f64::to_radians(degrees)));
        if here > best.0 {
            best = (here, degrees);
        }
        degrees += 0.02;
    }
    best.1
}

#[test]
fn red_is_outside_and_violet_inside_and_the_second_bow_is_reversed_beyond_a_dark_band() {
    for rate in [1.0, 10.0, 50.0] {
        let bow = tables().of_rain(&Spectrum::new(Distribution::MarshallPalmer, rate).expect("a rate"));
        let at = |from, to| [0, 1, 2].map(|c| brightest(&bow, from, to, |colour| colour[c] - luminance(colour)));
        let [red, _, blue] = at(38.0, 45.0);
        assert!(red > 41.4 && red < 42.6, "{rate}: red at {red}");
        assert!(blue > 38.5 && blue < red - 0.8, "{rate}: blue at {blue}");
        let [red, _, blue] = at(48.0, 57.0);
        assert!(red > 49.5 && red < 52.0 && blue > red + 1.0, "{rate}: {red} {blue}");
        let bright = |degrees: f64| luminance(bow.per_sr(degrees.to_radians()));
        let first = bright(brightest(&bow, 38.0, 45.0, luminance));
        let second = bright(brightest(&bow, 48.0, 57.0, luminance));
        // The second bow has two fifths of the first's light, over twice the width.
        assert!(second > 0.1 * first && second < 0.5 * first, "{rate}: {first} {second}");
        assert!(bright(46.5) < 0.03 * first, "{rate}: {}", bright(46.5));
        assert!(
            bright(35.0) > 10.0 * bright(46.5) && bright(35.0) < 0.6 * first,
            "{rate}"
        );
    }
}

#[test]
fn small_drops_make_a_wide_white_bow() {
    let width = |bow: &RainbowPhase| {
        let top = brightest(bow, 30.0, 45.0, luminance);
        let half = 0.5 * luminance(bow.per_sr(top.to_radians()));
        let reach = |step: f64| {
            let mut at = top;
            while luminance(bow.per_sr(at.to_radians())) > half && (20.0..60.0).contains(&at) {
                at += step;
            }
            at
        };
        reach(0.02) - reach(-0.02)
    };
    let colourfulness = |bow: &RainbowPhase| {
        let top = luminance(bow.per_sr(brightest(bow, 30.0, 45.0, luminance).to_radians()));
        let mut most: f64 = 0.0;
        for i in 0..=60 {
            let [r, g, b] = bow.per_sr((30.0 + 0.25 * f64::from(i)).to_radians());
            let bright = r.max(g).max(b);
            if luminance([r, g, b]) > 0.6 * top {
                most = most.max((bright - r.min(g).min(b)) / bright);
            }
        }
        most
    };
    let [fog, drizzle, rain] = [10e-6, 100e-6, 1e-3].map(|radius| tables().of_radius(radius));
    let widths = [&fog, &drizzle, &rain].map(width);
    let colours = [&fog, &drizzle, &rain].map(colourfulness);
    assert!(widths[0] > 5.0 && widths[0] > 2.0 * widths[2], "{widths:?}");
    assert!(colours[0] < 0.35 && colours[2] > 0.9, "{colours:?}");
    // It stands further in, too.
    let top = |bow: &RainbowPhase| brightest(bow, 25.0, 45.0, luminance);
    assert!(top(&fog) < top(&drizzle) && top(&drizzle) < top(&rain) + 0.3);
}

#[test]
fn bows_answer_every_number() {
    let rays = BowRays::new(N);
    for bad in NOT_NUMBERS {
        assert!(rays.phase_per_sr(bad, 1e4).is_finite());
        assert!(rays.phase_per_sr(0.7, bad).is_finite());
        assert!(BowRays::new(bad).phase_per_sr(0.7, 1e4).is_finite());
        assert!(
            tables()
                .of_radius(bad)
                .rgb_per_sr
                .iter()
                .flatten()
                .all(|v| v.is_finite() && *v >= 0.0)
        );
        assert!((0.0..=(BOW_KNOTS - 1) as f64).contains(&bow_place(bad)));
        assert!((1.3..1.45).contains(&water_index(bad)), "{}", water_index(bad));
    }
    let dry = Spectrum::new(Distribution::MarshallPalmer, 0.0).expect("no rain");
    assert!(tables().of_rain(&dry).rgb_per_sr.iter().flatten().all(|v| *v == 0.0));
    // Places rise evenly from the first entry to the last.
    let mut before = -1.0;
    for i in 0..=1800 {
        let place = bow_place(f64::from(i) * PI / 1800.0);
        assert!(place > before);
        before = place;
    }
    assert!((before - (BOW_KNOTS - 1) as f64).abs() < 1e-12 && bow_place(0.0) == 0.0);
    // At an entry: that entry.
    let bow = tables().of_radius(1e-4);
    let greatest = bow.rgb_per_sr.iter().flatten().fold(0.0_f32, |a, b| a.max(*b));
    for (degrees, entry) in [(0.0_f64, 0), (30.0, 30), (41.0, 118), (180.0, 375)] {
        for (found, own) in bow.per_sr(degrees.to_radians()).into_iter().zip(bow.rgb_per_sr[entry]) {
            assert!((found - f64::from(own)).abs() < 1e-6 * f64::from(greatest), "{degrees}");
        }
    }
    assert!((bow_place(30.0_f64.to_radians()) - 30.0).abs() < 1e-12);
}
