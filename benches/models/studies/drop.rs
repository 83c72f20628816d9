//! Work against precision: outline of a drop, volume of a swinging one.

use std::hint::black_box;

use rain_bench::study::{Study, Variant};
use rain_core::rainfall::{DropOutline, Oscillation, Spheroid, oscillating_radius_f32};
use rain_reference::drop as reference;

/// Every study of this file.
pub fn studies() -> Vec<Study> {
    vec![outline(), swing()]
}

const DIAMETERS: [f64; 6] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
const ANGLES: usize = 65;

fn cosines() -> [f64; ANGLES] {
    core::array::from_fn(|i| (core::f64::consts::PI * i as f64 / (ANGLES - 1) as f64).cos())
}

/// First `TERMS` terms in single precision.
fn series<const TERMS: usize>(a: &[f32; TERMS], x: f32) -> f32 {
    let (mut before, mut now) = (1.0, x);
    let mut sum = a[0] + a[1] * x;
    for a in &a[2..] {
        (before, now) = (now, 2.0 * x * now - before);
        sum += a * now;
    }
    sum
}

/// The largest error over all drops and angles of one radius function per drop.
fn variant<S: 'static>(name: &str, shapes: Vec<S>, radius: impl Fn(&S, f64) -> f64 + 'static) -> Variant {
    let mut error = 0.0_f64;
    for (shape, d) in shapes.iter().zip(DIAMETERS) {
        let slow = reference::scaled_radius(d);
        for x in cosines() {
            error = error.max((radius(shape, x) - slow(x.acos())).abs());
        }
    }
    let (angles, count) = (cosines(), (shapes.len() * ANGLES) as u64);
    Variant::new(name, error, count, move || {
        let mut sum = 0.0;
        for shape in &shapes {
            for x in &angles {
                sum += radius(shape, black_box(*x));
            }
        }
        sum
    })
}

fn truncated<const TERMS: usize>(name: &str) -> Variant {
    let shapes = DIAMETERS
        .map(|d| {
            let outline = DropOutline::new(d);
            core::array::from_fn::<f32, TERMS, _>(|n| outline.coefficients()[n] as f32)
        })
        .to_vec();
    variant(name, shapes, |a, x| f64::from(series(a, x as f32)))
}

fn outline() -> Study {
    let outlines = || DIAMETERS.map(DropOutline::new).to_vec();
    Study {
        name: "drop-outline",
        title: "Radius of a falling drop",
        norm: "max |r - r_ref|/(D/2), 1-6 mm",
        unit: "angle",
        variants: vec![
            variant("sphere", vec![(); DIAMETERS.len()], |(), _| 1.0),
            variant(
                "spheroid",
                DIAMETERS.map(|d| (Spheroid::of_drop(d), 2.0 / d)).to_vec(),
                |(s, scale), x| s.radius_mm(x) * scale,
            ),
            truncated::<4>("series, 4 terms, f32"),
            truncated::<6>("series, 6 terms, f32"),
            variant("series, 11 terms, f32", outlines(), |o, x| {
                f64::from(o.radius_f32(x as f32))
            })
            .default(),
            variant("series, 11 terms", outlines(), |o, x| o.radius(x)),
            variant("sum of 11 cosines", outlines(), |o, x| {
                let theta = x.acos();
                o.coefficients()
                    .iter()
                    .enumerate()
                    .map(|(n, a)| a * (n as f64 * theta).cos())
                    .sum()
            }),
        ],
    }
}

/// Volume of a 3 mm drop deflected by 0.15 of its radius.
fn swing() -> Study {
    const DEFLECTION: f64 = 0.15;
    let error = |r: &dyn Fn(f64) -> f64| (reference::volume(|theta| r(theta.cos())) - 1.0).abs();
    let round = DropOutline::new(0.0);
    let bent = round.deformed([DEFLECTION, 0.0]);
    let angles = cosines();
    let cheap = move |x: f64| f64::from(oscillating_radius_f32(DEFLECTION as f32, x as f32));
    let bare = |x: f64| 1.0 + DEFLECTION * (1.5 * x * x - 0.5);
    let mut drop = Oscillation::released(3.0, 0.1, [DEFLECTION, 0.0]);
    let equilibrium = DropOutline::new(3.0);
    Study {
        name: "drop-swing",
        title: "Volume of a swinging drop",
        norm: "|V/V_0 - 1| at a deflection of 0.15",
        unit: "outline of 65 angles",
        variants: vec![
            Variant::new("no correction", error(&bare), 1, move || {
                angles.iter().map(|x| bare(black_box(*x))).sum()
            }),
            Variant::new("- deflection²/5, f32", error(&cheap), 1, move || {
                angles.iter().map(|x| cheap(black_box(*x))).sum()
            }),
            Variant::new("scaled, 11 terms, f32", error(&|x| bent.radius(x)), 1, move || {
                drop.advance(1e-3);
                let now = drop.outline(black_box(&equilibrium));
                angles.iter().map(|x| f64::from(now.radius_f32(*x as f32))).sum()
            })
            .default(),
        ],
    }
}
