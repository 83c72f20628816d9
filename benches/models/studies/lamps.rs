//! Light of lamps on rain, by how many of a street's lamps a view keeps.

use std::hint::black_box;

use glam::Vec3;
use rain_bench::study::{Study, Variant};
use rain_core::hash::{pcg3d, unit_f32};
use rain_core::rainfall::Lamp;

/// Every study of this file.
pub fn studies() -> Vec<Study> {
    vec![kept()]
}

/// The ball that lamps are chosen for, as the plugins have it. Units: m.
const AHEAD_M: f32 = 15.0;
const REACH_M: f32 = 18.0;
/// A lamp fades in over this share of the score at which it is one of those that count.
const FADE: f32 = 0.25;
/// Drops that are lit in each view.
const DROPS: u32 = 400;

/// A street along −z: lamps on both sides every 25 m, a car with two headlights every 18 m in both directions, lit windows.
fn street() -> Vec<Lamp> {
    let post = |i: u8, side: f32| Lamp {
        direction: Vec3::NEG_Y,
        cos_inner: 0.6,
        cos_outer: 0.2,
        range_m: 40.0,
        ..Lamp::point(
            Vec3::new(6.0 * side, 7.0, -25.0 * f32::from(i)),
            Vec3::new(9.0, 7.0, 4.0) * 250.0,
            0.2,
        )
    };
    let headlight = |i: u8, side: f32, own: f32| Lamp {
        direction: Vec3::new(0.0, -0.05, side).normalize(),
        cos_inner: 0.98,
        cos_outer: 0.85,
        range_m: 80.0,
        ..Lamp::point(
            Vec3::new(2.0 * side + own, 0.7, -18.0 * f32::from(i) - 9.0),
            Vec3::splat(12_000.0),
            0.1,
        )
    };
    let window = |i: u8, side: f32| Lamp {
        range_m: 25.0,
        ..Lamp::point(
            Vec3::new(10.0 * side, 4.0, -7.0 * f32::from(i)),
            Vec3::new(8.0, 6.0, 3.0) * 6.0,
            0.3,
        )
    };
    let mut lamps = Vec::new();
    for side in [-1.0, 1.0] {
        lamps.extend((0..16).map(|i| post(i, side)));
        lamps.extend((0..16).flat_map(|i| [-0.6, 0.6].map(|own| headlight(i, side, own))));
        lamps.extend((0..40).map(|i| window(i, side)));
    }
    lamps
}

/// The lamps relative to an eye, the strongest on the rain ahead of it first, with their scores.
fn ranked(eye: Vec3) -> Vec<(f32, Lamp)> {
    let mut found: Vec<(f32, Lamp)> = street()
        .into_iter()
        .map(|lamp| Lamp {
            position_m: lamp.position_m - eye,
            ..lamp
        })
        .map(|lamp| {
            let own = Lamp {
                radius_m: lamp.radius_m.max(1.0),
                ..lamp
            };
            (own.bound(Vec3::NEG_Z * AHEAD_M, REACH_M), lamp)
        })
        .filter(|(score, _)| *score > 0.0)
        .collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found
}

/// The first `most`, those that only just count dimmed.
fn keep(ranked: &[(f32, Lamp)], most: usize) -> Vec<Lamp> {
    let next = ranked.get(most).map_or(0.0, |(score, _)| *score);
    let kept = ranked.iter().take(most).map(|(score, lamp)| {
        let weight = if next > 0.0 {
            ((score / next - 1.0) / FADE).clamp(0.0, 1.0)
        } else {
            1.0
        };
        Lamp {
            intensity: lamp.intensity * weight,
            ..*lamp
        }
    });
    kept.collect()
}

/// Drops in sight ahead of the eye, evenly in the ball.
fn drops(view: u32) -> Vec<Vec3> {
    let places = (0..u32::MAX).map(|i| {
        let [x, y, z] = pcg3d([i, view, 17]).map(|bits| 2.0 * unit_f32(bits) - 1.0);
        Vec3::new(x, y, z)
    });
    let within = places
        .filter(|p| p.length() < 1.0)
        .map(|p| p * REACH_M + Vec3::NEG_Z * AHEAD_M);
    let in_sight = within.filter(|p| p.z < -0.5 && p.y > -1.7 && p.x.abs() < -0.8 * p.z && p.y < -0.5 * p.z);
    in_sight.take(DROPS as usize).collect()
}

fn light(lamps: &[Lamp], drops: &[Vec3]) -> f64 {
    let of_drop = |place: &Vec3| f64::from(lamps.iter().map(|lamp| lamp.radiance(*place).y).sum::<f32>());
    drops.iter().map(of_drop).sum()
}

fn kept() -> Study {
    // Along the street, in the right lane, at the height of a driver's eyes.
    let eyes: Vec<Vec3> = (0..24_u8)
        .map(|i| Vec3::new(1.8, 1.3, -30.0 - 7.3 * f32::from(i)))
        .collect();
    let views: Vec<(Vec<(f32, Lamp)>, Vec<Vec3>)> = (0..)
        .zip(&eyes)
        .map(|(view, eye)| (ranked(*eye), drops(view)))
        .collect();
    let variant = |name: &str, most: usize| {
        let squares = views.iter().map(|(ranked, drops)| {
            let whole: Vec<Lamp> = ranked.iter().map(|(_, lamp)| *lamp).collect();
            (light(&keep(ranked, most), drops) / light(&whole, drops) - 1.0).powi(2)
        });
        let error = (squares.sum::<f64>() / views.len() as f64).sqrt();
        let (lamps, drops) = (keep(&views[3].0, most), views[3].1.clone());
        Variant::new(name, error.max(1e-6), DROPS.into(), move || {
            light(black_box(&lamps), &drops)
        })
    };
    Study {
        name: "lamp-count",
        title: "Light of a street's lamps on the rain, by how many a view keeps",
        norm: "rms over views of the light of all drops, against all lamps",
        unit: "drop",
        variants: vec![
            variant("1", 1),
            variant("2", 2),
            variant("4", 4),
            variant("8", 8),
            variant("16", 16).default(),
            variant("24", 24),
            variant("32", 32),
            variant("48", 48),
            variant("all", usize::MAX),
        ],
    }
}
