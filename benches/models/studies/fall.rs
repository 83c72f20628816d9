//! Work against precision: fall from rest, response to wind.

use std::hint::black_box;

use glam::DVec3;
use rain_bench::study::{Study, Variant};
use rain_core::rainfall::{Fall, WindResponse, drag_stiffness, fall_f32, quadratic_speed_after_f32, relax_f32};
use rain_reference::fall as reference;
use rain_reference::fall_speed::measured;

/// Every study of this file.
pub fn studies() -> Vec<Study> {
    vec![over_height(), over_time(), wind()]
}

const DIAMETERS: [f64; 8] = [0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0];
const HEIGHTS: [f64; 8] = [0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 30.0];

/// Terminal speeds, diameters and heights, all pairs.
fn falls() -> Vec<[f64; 3]> {
    DIAMETERS
        .iter()
        .flat_map(|&d| HEIGHTS.map(|z| [measured(d), d, z]))
        .collect()
}

/// Largest |v − v_ref|/v_t of `speed` over `falls`, and a variant that evaluates it.
fn fall_variant(name: impl Into<String>, truth: &[f64], speed: impl Fn([f64; 3]) -> f64 + 'static) -> Variant {
    let falls = falls();
    let error = falls
        .iter()
        .zip(truth)
        .map(|(fall, v)| (speed(*fall) - v).abs() / fall[0])
        .fold(0.0, f64::max);
    Variant::new(name, error, falls.len() as u64, move || {
        falls.iter().map(|fall| speed(black_box(*fall))).sum()
    })
}

/// Speed after a height by Runge–Kutta steps of `dt` with the reference's drag.
fn integrated(dt: f64) -> impl Fn([f64; 3]) -> f64 {
    move |[terminal, d, z]| reference::speeds_at(d, terminal, &[z], dt)[0]
}

fn over_height() -> Study {
    let truth: Vec<f64> = DIAMETERS
        .iter()
        .flat_map(|&d| reference::speeds_at(d, measured(d), &HEIGHTS, 1e-3))
        .collect();
    let mut variants = vec![
        fall_variant("c(D), Halley on z(t)", &truth, |[terminal, d, z]| {
            Fall::new(terminal, drag_stiffness(d)).map_or(f64::NAN, |fall| fall.speed_after_m_s(z, 0.0))
        })
        .default(),
        fall_variant("c = 1, v(z)", &truth, |[terminal, _, z]| {
            Fall::quadratic(terminal).map_or(f64::NAN, |fall| fall.speed_after_m_s(z, 0.0))
        }),
        fall_variant("c = 1, v(z), f32", &truth, |[terminal, _, z]| {
            f64::from(quadratic_speed_after_f32(terminal as f32, z as f32))
        }),
    ];
    variants.extend(
        [0.2, 0.1, 0.05, 0.01]
            .iter()
            .map(|&dt| fall_variant(format!("drag of Clift & Gauvin, RK4 {dt} s"), &truth, integrated(dt))),
    );
    Study {
        name: "fall-over-height",
        title: "Speed after a fall from rest",
        norm: "max |v - v_ref|/v_t, 0.5-5 mm, 0.25-30 m",
        unit: "drop",
        variants,
    }
}

/// Terminal speed, stiffness and time.
fn moments() -> Vec<[f64; 3]> {
    [(2.06, 0.5), (4.03, 0.6), (6.49, 0.775), (8.83, 1.05)]
        .iter()
        .flat_map(|&(v, c)| [1e-4, 1e-3, 1e-2, 0.05, 0.1, 0.3, 1.0, 3.0].map(|t| [v, c, t]))
        .collect()
}

/// The printed form of z(t), which cancels for short times.
fn printed_way(terminal: f64, c: f64, time: f64) -> f64 {
    let tau = time * 9.80665 / terminal;
    let b = 1.0 + c;
    let e = (-b * tau).exp();
    terminal * terminal / 9.80665 * (tau - (c * -(-b * tau).exp_m1() / (1.0 + c * e)).ln_1p() / c)
}

/// The same in single precision.
fn printed_way_f32(terminal: f32, c: f32, time: f32) -> f32 {
    let tau = time * 9.80665 / terminal;
    let b = 1.0 + c;
    let e = (-b * tau).exp();
    terminal * terminal / 9.80665 * (tau - (c * -(-b * tau).exp_m1() / (1.0 + c * e)).ln_1p() / c)
}

/// Steps of at most `dt`.
fn stepped(dt: f64) -> impl Fn([f64; 3]) -> f64 {
    move |[terminal, c, time]| {
        let steps = (time / dt).ceil().max(1.0);
        let h = time / steps;
        let (mut v, mut z) = (0.0, 0.0);
        for _ in 0..steps as u32 {
            let before = v;
            v += h * 9.80665 * (1.0 - v / terminal) * (1.0 + c * v / terminal);
            z += 0.5 * (before + v) * h;
        }
        z
    }
}

fn over_time() -> Study {
    let truth: Vec<f64> = moments()
        .iter()
        .map(|&[v, c, t]| reference::stiffened_fall(v, c, t, 0.0, 4000)[1])
        .collect();
    let variant = |name: String, way: Box<dyn Fn([f64; 3]) -> f64>| {
        let moments = moments();
        let error = moments
            .iter()
            .zip(&truth)
            .map(|(m, z)| (way(*m) / z - 1.0).abs())
            .fold(0.0, f64::max);
        Variant::new(name, error, moments.len() as u64, move || {
            moments.iter().map(|m| way(black_box(*m))).sum()
        })
    };
    let mut variants = vec![
        variant(
            "closed form".into(),
            Box::new(|[v, c, t]| Fall::new(v, c).map_or(f64::NAN, |fall| fall.distance_m(t, 0.0))),
        ),
        variant(
            "closed form, f32".into(),
            Box::new(|[v, c, t]| f64::from(fall_f32(v as f32, c as f32, t as f32, 0.0)[1])),
        )
        .default(),
        variant("printed form".into(), Box::new(|[v, c, t]| printed_way(v, c, t))),
        variant(
            "printed form, f32".into(),
            Box::new(|[v, c, t]| f64::from(printed_way_f32(v as f32, c as f32, t as f32))),
        ),
        variant("free fall".into(), Box::new(|[_, _, t]| 0.5 * 9.80665 * t * t)),
    ];
    variants.extend(
        [60.0, 240.0, 1000.0]
            .iter()
            .map(|rate| variant(format!("explicit Euler, {rate} Hz"), Box::new(stepped(1.0 / rate)))),
    );
    Study {
        name: "fall-over-time",
        title: "Way of a drop falling from rest",
        norm: "max |z/z_ref - 1|, 0.1 ms to 3 s",
        unit: "drop",
        variants,
    }
}

/// Drops that start at rest in a wind that grows from 2 to 8 m/s in half a second, seen after it.
fn wind() -> Study {
    const SPEEDS: [f64; 5] = [0.72, 2.06, 4.03, 6.49, 8.83];
    let truth = SPEEDS.map(|v| reference::lagging_drop(v, 0.0, 2.0, 8.0, 0.5, 4000)[0]);
    let variant = |name: String, answer: Box<dyn Fn(f64) -> f64>| {
        let error = SPEEDS
            .iter()
            .zip(truth)
            .map(|(v, u)| (answer(*v) - u).abs() / 8.0)
            .fold(0.0, f64::max);
        Variant::new(name, error, SPEEDS.len() as u64, move || {
            SPEEDS.iter().map(|v| answer(black_box(*v))).sum()
        })
    };
    let stepped = |rate: f64, implicit: bool| -> Box<dyn Fn(f64) -> f64> {
        Box::new(move |terminal| {
            let steps = (0.5 * rate).ceil();
            let h = 0.5 / steps;
            let k = 9.80665 / terminal * h;
            let mut u = 0.0;
            for i in 0..steps as u32 {
                let at = |n: f64| 2.0 + 6.0 * n / steps;
                u = if implicit {
                    (u + k * at(f64::from(i) + 1.0)) / (1.0 + k)
                } else {
                    u + k * (at(f64::from(i)) - u)
                };
            }
            u
        })
    };
    Study {
        name: "wind-response",
        title: "Horizontal speed of a drop in a rising wind",
        norm: "max |u - u_ref|/U after 0.5 s",
        unit: "drop",
        variants: vec![
            variant(
                "closed form, linear wind".into(),
                Box::new(|v| {
                    let mut drop = WindResponse::default();
                    drop.advance(v, DVec3::X * 2.0, DVec3::X * 8.0, 0.5);
                    drop.velocity_m_s.x
                }),
            )
            .default(),
            variant(
                "exact for the mean wind, f32".into(),
                Box::new(|v| f64::from(relax_f32(0.0, 5.0, (v / 9.80665) as f32, 0.5))),
            ),
            variant("explicit Euler, 10 Hz".into(), stepped(10.0, false)),
            variant("explicit Euler, 60 Hz".into(), stepped(60.0, false)),
            variant("implicit Euler, 60 Hz".into(), stepped(60.0, true)),
        ],
    }
}
