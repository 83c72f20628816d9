//! What a view shows: which splashes, where, how long, and how bright all together.

use glam::{DVec2, DVec3, Vec2};
use rain_core::splash::{crown_life_s, crown_radius_m_f32, crown_seen_s, secondary_drop};
use rain_render::gpu_types::SplashPart;
use rain_render::splash::SplashGpu;

use super::scene::{END_X, Living, ROOF, SIZE, Scene};
use crate::device::{Device, device};

fn in_picture(pixel: Vec2) -> bool {
    pixel.cmpge(Vec2::splat(2.0)).all() && pixel.cmplt(SIZE - 2.0).all()
}

/// Feet and half widths of the crowns in the picture, px.
fn crowns(parts: &[SplashPart]) -> Vec<(Vec2, f32)> {
    let crowns = parts.iter().filter(|part| part.form[0] == 1.0);
    crowns
        .map(|part| (Vec2::new(part.ends[0], part.ends[1]), part.shape[1]))
        .filter(|(foot, _)| in_picture(*foot))
        .collect()
}

/// Feet and half widths of the CPU's crowns in the picture, and the share of the exposure that they were seen.
fn known_crowns(scene: &Scene) -> Vec<(Vec2, f32, f64, DVec2)> {
    let crown = |l: &Living| {
        let (d, age, exposure) = (l.mark.diameter_mm, l.age_s, scene.exposure_s);
        let life = crown_life_s(d.into()) as f32;
        let seen = crown_seen_s(d.into(), age.into(), exposure.into()) / f64::from(exposure);
        let time = 0.5 * ((age - exposure).max(0.0) + age.min(life));
        let speed = -l.impact.velocity_m_s.dot(l.impact.normal);
        let radius = (0.8 + 0.4 * l.vary[1]) * crown_radius_m_f32(d, speed, l.impact.film_mm, time);
        let half = (radius * scene.px_per_m(l.p)).max(0.5);
        (age - exposure < life).then(|| (scene.pixel(l.p), half, seen, l.place))
    };
    let crowns = scene.living().iter().filter_map(crown).collect::<Vec<_>>();
    crowns.into_iter().filter(|(foot, ..)| in_picture(*foot)).collect()
}

/// Every crown of the GPU is one of the CPU's, in place and size, and every plain one of the CPU's is drawn.
fn compare(gpu: &Device, pipelines: &SplashGpu, scene: &Scene) -> usize {
    let (parts, _) = scene.parts(gpu, pipelines, 1 << 18);
    let (found, known) = (crowns(&parts), known_crowns(scene));
    let near = |a: Vec2, b: Vec2| (a - b).length() < 0.5;
    let strangers = found
        .iter()
        .filter(|(foot, half)| {
            !known
                .iter()
                .any(|(p, h, ..)| near(*p, *foot) && (half / h - 1.0).abs() < 0.03)
        })
        .count();
    assert!(
        strangers * 500 <= found.len(),
        "{strangers} of {} are none of the CPU's",
        found.len()
    );
    let plain: Vec<_> = known
        .iter()
        .filter(|(_, _, seen, at)| *seen > 0.1 && !Scene::near_an_edge(*at, 0.2))
        .collect();
    let missed = plain
        .iter()
        .filter(|(p, ..)| !found.iter().any(|(foot, _)| near(*p, *foot)))
        .count();
    assert!(missed * 500 <= plain.len(), "{missed} of {} are not drawn", plain.len());
    found.len()
}

#[test]
fn crowns_stand_where_the_cpu_has_them_on_ground_roof_and_ramp_and_nowhere_else() {
    let Some(gpu) = device() else { return };
    let pipelines = SplashGpu::new(&gpu.device);
    let scene = Scene::default();
    let count = compare(&gpu, &pipelines, &scene);
    assert!(count > 1000, "{count}");
    // The comparison sees a tenth of a second and another seed.
    let (parts, _) = Scene {
        now_s: scene.now_s + 0.1,
        ..scene
    }
    .parts(&gpu, &pipelines, 1 << 18);
    let other = crowns(&parts);
    let same = known_crowns(&scene)
        .iter()
        .filter(|(p, ..)| other.iter().any(|(f, _)| (*f - *p).length() < 0.5))
        .count();
    assert!(same * 20 < count, "{same} of {count}");
    // Each kind of ground has some; where nothing is known there are none.
    let at = |x: f64, z: f64, y: f64| scene.pixel((DVec3::new(x, y, z) - scene.eye_m).as_vec3());
    let (parts, _) = scene.parts(&gpu, &pipelines, 1 << 18);
    let feet = crowns(&parts);
    let within = |a: Vec2, b: Vec2| {
        feet.iter()
            .filter(|(f, _)| f.cmpge(a.min(b)).all() && f.cmplt(a.max(b)).all())
            .count()
    };
    assert!(within(at(ROOF[0], ROOF[1], ROOF[4]), at(ROOF[2], ROOF[3], ROOF[4])) > 50);
    assert!(within(at(0.0, -2.0, 0.0), at(3.0, 2.0, 0.0)) > 50);
    assert_eq!(within(at(END_X, -4.0, 0.0), at(END_X + 3.0, 4.0, 0.0)), 0);
}

#[test]
fn another_eye_far_away_after_days_sees_the_same_splashes() {
    let Some(gpu) = device() else { return };
    let pipelines = SplashGpu::new(&gpu.device);
    let scene = Scene {
        origin_m: DVec3::new(100_000.25, 40.0, -50_000.5),
        eye_m: DVec3::new(0.4, 5.5, -0.7),
        now_s: 604_800.057,
        ..Scene::default()
    };
    assert!(compare(&gpu, &pipelines, &scene) > 500);
}

#[test]
fn without_perspective_crowns_stand_where_the_cpu_has_them_too() {
    let Some(gpu) = device() else { return };
    let pipelines = SplashGpu::new(&gpu.device);
    let scene = Scene {
        eye_m: DVec3::new(-1.0, 0.0, 0.3),
        parallel_m: 6.0,
        ..Scene::default()
    };
    assert!(compare(&gpu, &pipelines, &scene) > 300);
    // Those in the middle of the picture, around which all are looked for, are as plain as those at its rim.
    let (parts, _) = scene.parts(&gpu, &pipelines, 1 << 18);
    let number = |low: f32, high: f32| {
        let feet = crowns(&parts).into_iter();
        feet.filter(|(p, _)| (low..high).contains(&(p.distance(0.5 * SIZE) / (0.5 * SIZE.y))))
            .count() as f32
            / (high * high - low * low)
    };
    let (inner, outer) = (number(0.0, 0.5), number(0.5, 1.0));
    assert!((inner / outer - 1.0).abs() < 0.25, "{inner} and {outer} an area");
}

#[test]
fn lighter_rain_and_deep_water_have_fewer_and_dry_air_none() {
    let Some(gpu) = device() else { return };
    let pipelines = SplashGpu::new(&gpu.device);
    let base = Scene {
        film_mm: 0.0,
        ..Scene::default()
    };
    let count = |scene: &Scene| {
        let moments = 0..6;
        moments
            .map(|i| {
                crowns(
                    &Scene {
                        now_s: 9.0 + 0.31 * f64::from(i),
                        ..*scene
                    }
                    .parts(&gpu, &pipelines, 1 << 18)
                    .0,
                )
                .len()
            })
            .sum::<usize>()
    };
    let heavy = count(&base);
    let light = count(&Scene { rain_mm_h: 5.0, ..base });
    let puddle = Scene { water_m: 0.03, ..base };
    let flooded = count(&puddle);
    assert!(heavy > 2 * light && light > 100, "{heavy} {light}");
    assert!(2 * heavy > 5 * flooded && flooded > 100, "{heavy} {flooded}");
    // On the water, not under it.
    assert!(compare(&gpu, &pipelines, &puddle) > 30);
    let (parts, found) = Scene { rain_mm_h: 0.0, ..base }.parts(&gpu, &pipelines, 64);
    assert_eq!((parts.len(), found), (0, 0));
}

#[test]
fn ground_in_the_lee_of_a_roof_stays_dry() {
    let Some(gpu) = device() else { return };
    let pipelines = SplashGpu::new(&gpu.device);
    let still = Scene {
        wind_m_s: DVec2::new(0.01, 0.0),
        ..Scene::default()
    };
    let windy = Scene {
        wind_m_s: DVec2::new(2.0, 0.0),
        ..still
    };
    let feet = |scene: &Scene| -> Vec<Vec2> {
        let moments = (0..8).map(|i| Scene {
            now_s: 3.0 + 0.37 * f64::from(i),
            ..*scene
        });
        moments
            .flat_map(|scene| crowns(&scene.parts(&gpu, &pipelines, 1 << 18).0))
            .map(|crown| crown.0)
            .collect()
    };
    let within = |feet: &[Vec2], x: [f64; 2]| {
        let corner = |x: f64, z: f64| windy.pixel((DVec3::new(x, 0.0, z) - windy.eye_m).as_vec3());
        let (a, b) = (corner(x[0], 1.5), corner(x[1], -1.5));
        feet.iter()
            .filter(|f| f.cmpge(a.min(b)).all() && f.cmplt(a.max(b)).all())
            .count()
    };
    let (still, windy) = (feet(&still), feet(&windy));
    // On its way from the roof's edge a drop drifts by 0.65 (at 9.2 m/s) to 2.1 m (at 2.85 m/s): this strip beside the
    // roof no drop reaches.
    let lee = [ROOF[0] + 2.15, ROOF[2] + 0.6];
    assert!(within(&still, lee) > 50, "{}", within(&still, lee));
    assert_eq!(within(&windy, lee), 0);
    let open = [2.8, 3.2];
    assert!(within(&windy, open) > 50 && within(&still, open) > 50);
}

#[test]
fn thrown_drops_fly_from_their_splashes_and_end_within_their_life() {
    let Some(gpu) = device() else { return };
    let pipelines = SplashGpu::new(&gpu.device);
    let scene = Scene {
        eye_m: DVec3::new(1.5, 1.2, 0.0),
        near_reach_m: 4.0,
        reach_m: 4.0,
        ..Scene::default()
    };
    let (parts, _) = scene.parts(&gpu, &pipelines, 1 << 18);
    let found: Vec<(Vec2, Vec2)> = parts
        .iter()
        .filter(|part| part.form[0] == 0.0)
        .map(|part| {
            (
                Vec2::new(part.ends[0], part.ends[1]),
                Vec2::new(part.ends[2], part.ends[3]),
            )
        })
        .filter(|(head, _)| in_picture(*head))
        .collect();
    let mut known = Vec::new();
    for l in scene.living() {
        for index in 0..l.splash.count {
            let drop = secondary_drop(&l.impact, &l.splash, l.mark.key, index);
            let now = drop.place_m(l.age_s);
            if now.dot(l.impact.normal) > 0.0 {
                let before = drop.place_m((l.age_s - scene.exposure_s).max(0.0));
                let size = drop.diameter_mm * 1e-3 * Scene::focal_px() / -(l.p + now).y;
                known.push((
                    scene.pixel(l.p + now),
                    scene.pixel(l.p + before),
                    size,
                    l.age_s / l.mark.life_s,
                ));
            }
        }
    }
    known.retain(|(head, ..)| in_picture(*head));
    let same = |k: &(Vec2, Vec2, f32, f32), f: &(Vec2, Vec2)| (k.0 - f.0).length() < 0.5 && (k.1 - f.1).length() < 0.5;
    let strangers = found.iter().filter(|f| !known.iter().any(|k| same(k, f))).count();
    assert!(
        found.len() > 1000 && strangers * 200 <= found.len(),
        "{strangers} of {}",
        found.len()
    );
    let plain: Vec<_> = known.iter().filter(|k| k.2 > 0.2 && k.3 < 0.7 && k.3 > 0.1).collect();
    let missed = plain.iter().filter(|k| !found.iter().any(|f| same(k, f))).count();
    assert!(
        plain.len() > 300 && missed * 100 <= plain.len(),
        "{missed} of {}",
        plain.len()
    );
}

#[test]
fn a_smaller_budget_draws_fewer_parts_of_the_same_light() {
    let Some(gpu) = device() else { return };
    let pipelines = SplashGpu::new(&gpu.device);
    // From near, so that crowns are larger than pixels; physical contrast.
    let scene = Scene {
        eye_m: DVec3::new(1.5, 2.5, 0.0),
        reach_m: 5.0,
        contrast: 1.0,
        ..Scene::default()
    };
    let light = |budget: f64| {
        let (mut sum, mut count) = (0.0, 0);
        for i in 0..60 {
            let (parts, _) = Scene {
                budget,
                now_s: 1.0 + 0.41 * f64::from(i),
                ..scene
            }
            .parts(&gpu, &pipelines, 1 << 18);
            count += parts.len();
            for part in parts {
                let (width, tall) = (2.0 * part.shape[1], part.shape[2] + 1.6 * part.form[1]);
                sum += f64::from(part.light[3] * width * tall.max(1.0));
            }
        }
        (sum, count)
    };
    let (all, many) = light(1e9);
    let (thinned, few) = light(0.12 * scene.field().mean * 16.0 * 10.0 * 78.5 * 0.03);
    assert!(few * 2 < many && few > 500, "{few} of {many}");
    assert!((thinned / all - 1.0).abs() < 0.1, "{thinned} for {all}");
}

#[test]
fn what_finds_no_room_is_left_out_and_told() {
    let Some(gpu) = device() else { return };
    let pipelines = SplashGpu::new(&gpu.device);
    let (all, found) = Scene::default().parts(&gpu, &pipelines, 1 << 18);
    let (few, told) = Scene::default().parts(&gpu, &pipelines, 100);
    assert_eq!((few.len(), told, all.len()), (100, found, found as usize));
    assert!(few.iter().all(|part| all.contains(part)));
    // The order does not change from run to run.
    let (again, _) = Scene::default().parts(&gpu, &pipelines, 1 << 18);
    assert!(again == all);
}
