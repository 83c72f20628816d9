//! What the wet ground costs: a tick, a question, a snapshot, of a street of 120 × 60 m in cells of 0.25 m.
//!
//! `cargo run --release -p rain_ecs --example ground_cost`

#![allow(clippy::print_stdout, reason = "a programme that prints a table")]

use std::hint::black_box;
use std::time::{Duration, Instant};

use bevy_app::App;
use bevy_ecs::system::RunSystemOnce;
use bevy_math::{DVec3, Vec3};
use bevy_time::{Fixed, Time, TimePlugin, TimeUpdateStrategy, Virtual};
use bevy_transform::TransformPlugin;
use rain_ecs::prelude::*;

const TICK: Duration = Duration::from_nanos(31_250_000);

/// Height of a street with a crown, gutters and shallow hollows of all sizes.
fn height(x: f64, z: f64) -> f64 {
    let mut y = 0.005 * x + 0.02 * (z - 30.0).abs();
    for (i, size) in [7.0, 2.3, 0.9].into_iter().enumerate() {
        let (u, v) = (x / size + i as f64, z / size);
        // Triangle waves: no need for sines.
        let wave = |t: f64| (t - t.floor() - 0.5).abs();
        y += 0.03 * size.min(2.0) * wave(u) * wave(v);
    }
    y
}

fn quad(x: f64, z: f64, side: [f64; 2], y: &dyn Fn(f64, f64) -> f64) -> [[DVec3; 3]; 2] {
    let p = |x: f64, z: f64| DVec3::new(x, y(x, z), z);
    let (a, b) = (p(x, z), p(x + side[0], z));
    let (c, d) = (p(x + side[0], z + side[1]), p(x, z + side[1]));
    [[a, d, c], [a, c, b]]
}

fn street(app: &mut App) {
    let classes = [SurfaceClass::Asphalt, SurfaceClass::Stone, SurfaceClass::Grass];
    let mut strips: [Vec<[DVec3; 3]>; 3] = Default::default();
    for i in 0..240 {
        for j in 0..120 {
            let (x, z) = (f64::from(i) * 0.5, f64::from(j) * 0.5);
            let strip = if (z - 30.0).abs() < 6.0 {
                0
            } else {
                1 + usize::from((z - 30.0).abs() > 15.0)
            };
            strips[strip].extend(quad(x, z, [0.5, 0.5], &height));
        }
    }
    let mut roofs = Vec::new();
    for i in 0..10 {
        for z in [8.0, 46.0] {
            roofs.extend(quad(f64::from(i) * 12.0 + 1.0, z, [8.0, 6.0], &|_, _| 6.0));
        }
    }
    for (owner, triangles, class) in strips
        .iter()
        .zip(classes)
        .enumerate()
        .map(|(i, (t, c))| (i as u64, t, c))
        .chain([(9, &roofs, SurfaceClass::Roof)])
    {
        app.world_mut()
            .resource_mut::<SurfaceScene>()
            .set(owner, triangles, class, true);
        let covered = app.world_mut().resource_mut::<CoverField>().set(owner, triangles, true);
        assert!(covered.is_ok(), "{covered:?}");
    }
}

/// Mean and greatest time of a frame of one tick. Units: ms.
fn ticks(app: &mut App, count: u32) -> [f64; 2] {
    app.insert_resource(TimeUpdateStrategy::ManualDuration(TICK));
    let (mut sum, mut most) = (0.0, 0.0_f64);
    for _ in 0..count {
        let start = Instant::now();
        app.update();
        let ms = start.elapsed().as_secs_f64() * 1e3;
        sum += ms;
        most = most.max(ms);
    }
    [sum / f64::from(count), most]
}

fn main() {
    let mut app = App::new();
    app.add_plugins((TimePlugin, TransformPlugin, RainEcsPlugin::default()));
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    app.insert_resource(Time::<Fixed>::from_seconds(1e6));
    app.world_mut()
        .resource_mut::<Time<Virtual>>()
        .set_max_delta(Duration::MAX);
    app.update();
    let weather = app.world_mut().spawn(Weather::default()).id();
    let show = |what: &str, [mean, most]: [f64; 2]| println!("{what:44} {mean:9.4} ms  at most {most:8.3} ms");
    show("frame, no ground", ticks(&mut app, 2000));
    street(&mut app);
    app.world_mut().resource_mut::<SurfaceScene>().request_rebuild();
    show("frame that builds the ground", ticks(&mut app, 1));
    show("frame while exposure is asked for", ticks(&mut app, 50));
    ticks(&mut app, 50);
    show("frame, dry ground", ticks(&mut app, 2000));
    for rain in [2.0, 20.0, 100.0] {
        app.world_mut().entity_mut(weather).insert(Weather::rain(rain));
        show(&format!("frame, first minute of {rain} mm/h"), ticks(&mut app, 1920));
        show(&format!("frame, second minute of {rain} mm/h"), ticks(&mut app, 1920));
    }
    for m_s in [4.0, 8.0] {
        let windy = Weather {
            wind_m_s: Vec3::new(m_s, 0.0, 1.0),
            ..Weather::rain(20.0)
        };
        app.world_mut().entity_mut(weather).insert(windy);
        show(
            &format!("frame, a minute of 20 mm/h, wind of {m_s} m/s"),
            ticks(&mut app, 1920),
        );
    }
    app.world_mut().entity_mut(weather).insert(Weather::rain(0.0));
    show("frame, the minute after the rain", ticks(&mut app, 1920));
    let surface = app.world().resource::<SurfaceGround>();
    if let Some(ground) = surface.ground() {
        println!(
            "{} cells, {} basins",
            ground.exposure().len(),
            ground.basins().basins().len()
        );
        let mut levels = vec![0.0; ground.exposure().len()];
        let start = Instant::now();
        for _ in 0..20 {
            ground.levels(black_box(&mut levels));
        }
        let ms = start.elapsed().as_secs_f64() * 1e3 / 20.0;
        println!(
            "level map {ms:.3} ms, {} cells",
            levels.iter().filter(|l| **l > -1e6).count()
        );
    }
    let start = Instant::now();
    let ledger = surface.ledger();
    println!(
        "ledger {:.3} ms, residual {:e}",
        start.elapsed().as_secs_f64() * 1e3,
        ledger.residual_relative
    );
    println!("{ledger:?}");
    let places: Vec<DVec3> = (0..10_000_u32)
        .map(|i| {
            let at = |salt| f64::from(rain_core::hash::pcg(i.wrapping_mul(3).wrapping_add(salt))) / f64::from(u32::MAX);
            let (x, z) = (at(0) * 120.0, at(1) * 60.0);
            DVec3::new(x, height(x, z) + at(2) * 0.3, z)
        })
        .collect();
    type Question = (&'static str, fn(&RainQueries, DVec3) -> f64);
    let questions: [Question; 6] = [
        ("wetness_at", |q, p| q.wetness_at(p)),
        ("water_depth_at", |q, p| q.water_depth_at(p)),
        ("exposed_at", |q, p| f64::from(q.exposed_at(p))),
        ("friction_at", |q, p| q.friction_at(p, 20.0)),
        ("surface_sound_at", |q, p| {
            f64::from(q.surface_sound_at(p).wetness as u8)
        }),
        ("visibility_m", |q, _| q.visibility_m()),
    ];
    for (name, question) in questions {
        let places = places.clone();
        let ran = app.world_mut().run_system_once(move |queries: RainQueries| {
            let start = Instant::now();
            let sum: f64 = places.iter().map(|&p| question(&queries, black_box(p))).sum();
            (start.elapsed().as_secs_f64() * 1e3, sum)
        });
        if let Ok((ms, sum)) = ran {
            println!("10 000 × {name:20} {ms:8.3} ms (sum {sum:.3})");
        }
    }
    let start = Instant::now();
    let saved = RainSnapshot::save(app.world());
    println!("snapshot saved in {:.1} ms", start.elapsed().as_secs_f64() * 1e3);
    if let Ok(saved) = saved {
        let start = Instant::now();
        let done = saved.restore(app.world_mut());
        println!(
            "{} bytes, restored in {:.1} ms: {done:?}",
            saved.size_bytes(),
            start.elapsed().as_secs_f64() * 1e3
        );
    }
    let start = Instant::now();
    let hash = state_hash(app.world());
    println!("hash {hash:016x} in {:.2} ms", start.elapsed().as_secs_f64() * 1e3);
}
