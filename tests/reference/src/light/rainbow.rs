//! Rainbows from what their theories start with: rays through a sphere, Mie's series.

use super::sphere;

/// Shares of the light on a sphere's disc that leave after one or two inner reflections between neighbouring `edges`
/// (angles from the point opposite the sun, rad, rising), by `rays` rings of equal area; the sun is a disc of half width
/// `sun_rad`.
pub fn bow_shares(index: f64, edges: &[f64], sun_rad: f64, rays: u32) -> Vec<f64> {
    let mut shares = vec![0.0; edges.len() - 1];
    for i in 0..rays {
        let s = ((f64::from(i) + 0.5) / f64::from(rays)).sqrt();
        // A point of the sun's disc, by the golden angle; what counts is how far it lies along the bow's radius.
        let off = sun_rad * ((f64::from(i) * 0.754_877_67).fract()).sqrt() * (2.399_963_2 * f64::from(i)).cos();
        for ray in &sphere::at_impact(s, index, 4)[2..4] {
            let d = ray.direction;
            // Light comes along −z: straight back is +z.
            let angle = d[0].hypot(d[1]).atan2(d[2]) + off;
            if let Some(ring) = edges.windows(2).position(|e| angle >= e[0] && angle < e[1]) {
                shares[ring] += 0.5 * (ray.power[0] + ray.power[1]) / f64::from(rays);
            }
        }
    }
    shares
}

type Complex = [f64; 2];

fn times(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

fn over(a: Complex, b: Complex) -> Complex {
    let square = b[0] * b[0] + b[1] * b[1];
    let [re, im] = times(a, [b[0], -b[1]]);
    [re / square, im / square]
}

/// Light that a sphere of circumference `size` wavelengths scatters at each angle from straight on (rad), of that on its
/// disc, per steradian: Mie's series (Bohren & Huffman 1983, appendix A), unpolarised.
pub fn mie_phase_per_sr(size: f64, index: f64, angles: &[f64]) -> Vec<f64> {
    let terms = (size + 4.0 * size.cbrt() + 2.0).ceil() as usize;
    let inner = size * index;
    // Logarithmic derivative of ψ inside, downwards.
    let top = terms.max(inner.ceil() as usize) + 16;
    let mut derivative = vec![0.0; top + 1];
    for n in (1..=top).rev() {
        let ratio = n as f64 / inner;
        derivative[n - 1] = ratio - 1.0 / (derivative[n] + ratio);
    }
    let mut sums = vec![[[0.0_f64; 2]; 2]; angles.len()];
    let mut angular = vec![[0.0_f64, 1.0]; angles.len()];
    let (mut psi, mut chi) = ([size.cos(), size.sin()], [-size.sin(), size.cos()]);
    for (i, slope) in derivative[1..=terms].iter().enumerate() {
        let order = (i + 1) as f64;
        let next_psi = (2.0 * order - 1.0) * psi[1] / size - psi[0];
        let next_chi = (2.0 * order - 1.0) * chi[1] / size - chi[0];
        let [xi, xi_before] = [[next_psi, -next_chi], [psi[1], -chi[1]]];
        let coefficient = |factor: f64| {
            let factor = factor + order / size;
            let below = [factor * xi[0] - xi_before[0], factor * xi[1] - xi_before[1]];
            over([factor * next_psi - psi[1], 0.0], below)
        };
        let a = coefficient(slope / index);
        let b = coefficient(slope * index);
        let weight = (2.0 * order + 1.0) / (order * (order + 1.0));
        for ((angle, [before, now]), sum) in angles.iter().zip(&mut angular).zip(&mut sums) {
            let cosine = angle.cos();
            let pi = *now;
            let tau = order * cosine * pi - (order + 1.0) * *before;
            for k in 0..2 {
                sum[0][k] += weight * (a[k] * pi + b[k] * tau);
                sum[1][k] += weight * (a[k] * tau + b[k] * pi);
            }
            let next = ((2.0 * order + 1.0) * cosine * pi - (order + 1.0) * *before) / order;
            [*before, *now] = [pi, next];
        }
        psi = [psi[1], next_psi];
        chi = [chi[1], next_chi];
    }
    let square = |c: Complex| c[0] * c[0] + c[1] * c[1];
    sums.iter()
        .map(|[one, two]| (square(*one) + square(*two)) / (2.0 * core::f64::consts::PI * size * size))
        .collect()
}

/// The CIE 1931 standard observer from 400 to 700 nm in steps of 10: x̄, ȳ, z̄ as published.
const OBSERVER: [[f64; 3]; 31] = [
    [0.0143, 0.0004, 0.0679],
    [0.0435, 0.0012, 0.2074],
    [0.1344, 0.0040, 0.6456],
    [0.2839, 0.0116, 1.3856],
    [0.3483, 0.0230, 1.7471],
    [0.3362, 0.0380, 1.7721],
    [0.2908, 0.0600, 1.6692],
    [0.1954, 0.0910, 1.2876],
    [0.0956, 0.1390, 0.8130],
    [0.0320, 0.2080, 0.4652],
    [0.0049, 0.3230, 0.2720],
    [0.0093, 0.5030, 0.1582],
    [0.0633, 0.7100, 0.0782],
    [0.1655, 0.8620, 0.0422],
    [0.2904, 0.9540, 0.0203],
    [0.4334, 0.9950, 0.0087],
    [0.5945, 0.9950, 0.0039],
    [0.7621, 0.9520, 0.0021],
    [0.9163, 0.8700, 0.0017],
    [1.0263, 0.7570, 0.0011],
    [1.0622, 0.6310, 0.0008],
    [1.0026, 0.5030, 0.0003],
    [0.8544, 0.3810, 0.0002],
    [0.6424, 0.2650, 0.0],
    [0.4479, 0.1750, 0.0],
    [0.2835, 0.1070, 0.0],
    [0.1649, 0.0610, 0.0],
    [0.0874, 0.0320, 0.0],
    [0.0468, 0.0170, 0.0],
    [0.0227, 0.0082, 0.0],
    [0.0114, 0.0041, 0.0],
];

/// Linear Rec. 709 of a spectrum sampled at 400, 410, … 700 nm; an even one of 1 is (1, 1, 1).
pub fn rec709(spectrum: &[f64; 31]) -> [f64; 3] {
    let matrix = [
        [3.2406, -1.5372, -0.4986],
        [-0.9689, 1.8758, 0.0415],
        [0.0557, -0.2040, 1.0570],
    ];
    matrix.map(|row: [f64; 3]| {
        let response = OBSERVER.map(|xyz| row.iter().zip(xyz).map(|(m, c)| m * c).sum::<f64>());
        let lit: f64 = response.iter().zip(spectrum).map(|(r, s)| r * s).sum();
        lit / response.iter().sum::<f64>()
    })
}
