//! Noise puddles on a flat road gather in the wheel ruts they are told of, and stretch along them.

use bevy::prelude::*;
use image::RgbImage;
use rain_plugins::prelude::*;
use test_support::app::{FRAME, TestApp};
use test_support::gpu;

/// Side of the picture. Units: px.
const SIZE: u32 = 160;
/// Direction of the lanes, from z towards x. Units: rad.
const LANES: f64 = 0.5;

/// A puddle of the picture: its pixels, root second moments along its axes, and the longer one's angle from the picture's
/// down towards its right.
struct Seen {
    pixels: f64,
    elongation: f64,
    angle: f64,
}

/// Every connected region of water of more than 40 pixels that does not touch the picture's rim.
fn puddles(picture: &RgbImage) -> Vec<Seen> {
    let wet = |x: u32, y: u32| picture.get_pixel(x, y)[1] > 127;
    let mut seen = vec![false; (SIZE * SIZE) as usize];
    let mut found = Vec::new();
    for start in 0..SIZE * SIZE {
        let (mut open, mut region) = (vec![start], Vec::new());
        while let Some(at) = open.pop() {
            let (x, y) = (at % SIZE, at / SIZE);
            if seen[at as usize] || !wet(x, y) {
                continue;
            }
            seen[at as usize] = true;
            region.push([f64::from(x), f64::from(y)]);
            for (dx, dy) in [(0, 1), (1, 0), (2, 1), (1, 2)] {
                let (x, y) = (x + dx, y + dy);
                if (1..=SIZE).contains(&x) && (1..=SIZE).contains(&y) {
                    open.push((y - 1) * SIZE + x - 1);
                }
            }
        }
        let rim = f64::from(SIZE - 1);
        if region.len() < 40 || region.iter().flatten().any(|at| *at == 0.0 || *at == rim) {
            continue;
        }
        let count = region.len() as f64;
        let mean = [0, 1].map(|i| region.iter().map(|p| p[i]).sum::<f64>() / count);
        let moment = |i: usize, j: usize| {
            let sum: f64 = region.iter().map(|p| (p[i] - mean[i]) * (p[j] - mean[j])).sum();
            sum / count
        };
        let (xx, yy, xy) = (moment(0, 0) + 1.0 / 12.0, moment(1, 1) + 1.0 / 12.0, moment(0, 1));
        let (half, root) = (0.5 * (xx + yy), (0.25 * (xx - yy) * (xx - yy) + xy * xy).sqrt());
        found.push(Seen {
            pixels: count,
            elongation: ((half + root) / (half - root)).sqrt(),
            angle: 0.5 * (2.0 * xy).atan2(yy - xx),
        });
    }
    found
}

#[test]
fn noise_puddles_gather_in_ruts_and_stretch_along_them() {
    if !gpu::available() {
        return;
    }
    let mut test = TestApp::new([SIZE, SIZE], true);
    test.world().insert_resource(SurfaceSettings {
        enabled: false,
        ..default()
    });
    let plane = Plane3d::default().mesh().size(40.0, 40.0).build();
    let mesh = test.world().resource_mut::<Assets<Mesh>>().add(plane);
    let material = test
        .world()
        .resource_mut::<Assets<StandardMaterial>>()
        .add(StandardMaterial::default());
    let paint = PuddlePaint {
        show: ShowPaint::Water,
        height_map: false,
        ..default()
    };
    let road = test
        .world()
        .spawn((Mesh3d(mesh), MeshMaterial3d(material), Transform::default(), paint))
        .id();
    test.world().spawn((Weather::rain(10.0), WeatherMode::Artist));
    let camera = test.camera;
    test.world().entity_mut(camera).insert(RainView {
        streak_budget: Some(0),
        ..default()
    });
    // 24 m of road from straight above.
    test.look(Vec3::new(0.0, 28.97, 0.01), Vec3::ZERO);
    let mut show = |ruts: Option<WheelRuts>| {
        test.world().entity_mut(road).insert(NoisePuddles {
            seed: 12,
            size_m: 1.5,
            level: Some(0.4),
            ruts,
            height_map: false,
            drenched: 0.0,
            ..default()
        });
        test.frames(4, FRAME);
        test.picture()
    };
    let ruts = WheelRuts {
        direction_rad: LANES as f32,
        depth: 0.8,
        ..default()
    };
    let (with, without) = (show(Some(ruts)), show(None));
    let mean = |seen: &[Seen], value: &dyn Fn(&Seen) -> f64| {
        let pixels: f64 = seen.iter().map(|s| s.pixels).sum();
        seen.iter().map(|s| s.pixels * value(s)).sum::<f64>() / pixels
    };
    let (in_ruts, round) = (puddles(&with), puddles(&without));
    assert!(
        in_ruts.len() > 8 && round.len() > 4,
        "{} {}",
        in_ruts.len(),
        round.len()
    );
    let elongations = [&in_ruts, &round].map(|seen| mean(seen, &|s| s.elongation));
    // 1 along the lanes, −1 across them.
    let along = [&in_ruts, &round].map(|seen| mean(seen, &|s| (2.0 * (s.angle - LANES)).cos()));
    eprintln!("{} puddles, elongation {elongations:?}, along {along:?}", in_ruts.len());
    assert!(elongations[0] > 4.0 && elongations[1] < 2.5, "{elongations:?}");
    assert!(along[0] > 0.95 && along[1] < 0.5, "{along:?}");
    // Water lies within a rut's flanks, where the ground without ruts would have been flooded anywhere.
    let lanes = |x: u32, y: u32| {
        let [x, z] = [x, y].map(|at| (f64::from(at) + 0.5 - 0.5 * f64::from(SIZE)) * 24.0 / f64::from(SIZE));
        let across = x * LANES.cos() - z * LANES.sin() - 1.75;
        let within = across - 3.5 * (across / 3.5).round();
        (within.abs() - 0.75).abs() < 0.45
    };
    let share = |picture: &RgbImage| {
        let wet = picture.enumerate_pixels().filter(|(_, _, p)| p[1] > 127);
        let (inside, all) = wet.fold((0, 0), |(i, n), (x, y, _)| (i + u32::from(lanes(x, y)), n + 1));
        f64::from(inside) / f64::from(all)
    };
    let shares = [share(&with), share(&without)];
    assert!(shares[0] > 0.97 && shares[1] < 0.65, "{shares:?}");
}
