//! Splashes are lit by lamps and told from behind panes as the CPU has it.

use glam::{Vec2, Vec3};
use rain_core::rainfall::Lamp;
use rain_render::glass::Pane;
use rain_render::gpu_types::SplashPart;
use rain_render::splash::SplashGpu;

use super::scene::{Extra, Living, Scene};
use crate::device::device;

fn foot(part: &SplashPart) -> Vec2 {
    Vec2::new(part.ends[0], part.ends[1])
}

/// Crowns of which `holds` is true of none of the CPU's splashes in the same place, and how many there are.
fn strangers(scene: &Scene, parts: &[SplashPart], holds: impl Fn(&SplashPart, &Living) -> bool) -> [usize; 2] {
    let living: Vec<(Vec2, Living)> = scene.living().into_iter().map(|l| (scene.pixel(l.p), l)).collect();
    let crowns: Vec<&SplashPart> = parts.iter().filter(|part| part.form[0] == 1.0).collect();
    let strange = crowns.iter().filter(|part| {
        let mut near = living.iter().filter(|(at, _)| (*at - foot(part)).length() < 0.5);
        !near.any(|(_, l)| holds(part, l))
    });
    [strange.count(), crowns.len()]
}

#[test]
fn splashes_show_lamps_as_the_cpu_has_them() {
    let Some(gpu) = device() else { return };
    let pipelines = SplashGpu::new(&gpu.device);
    let scene = Scene::default();
    let street_lamp = Lamp {
        range_m: 9.0,
        ..Lamp::point(Vec3::new(2.5, -4.0, 0.5), Vec3::new(30.0, 20.0, 10.0), 0.1)
    };
    let beam = Lamp {
        direction: Vec3::NEG_Y,
        cos_inner: 0.97,
        cos_outer: 0.9,
        ..Lamp::point(Vec3::new(1.0, -2.0, -2.0), Vec3::splat(200.0), 0.1)
    };
    let lamps = [street_lamp, beam];
    let extra = Extra {
        lamps: &lamps,
        ..Extra::default()
    };
    let (parts, _) = scene.parts_with(&gpu, &pipelines, 1 << 18, extra);
    let as_lit_by = |lamps: &[Lamp], part: &SplashPart, l: &Living| {
        // Under an even light of 1 a drop shows 0.884 + 0.066 of it.
        let light: Vec3 = Vec3::splat(0.95) + lamps.iter().map(|lamp| lamp.radiance(l.p)).sum::<Vec3>();
        (0..3).all(|i| (part.light[i] - light[i]).abs() <= 3e-3 * light[i])
    };
    let [strange, count] = strangers(&scene, &parts, |part, l| as_lit_by(&lamps, part, l));
    assert!(count > 1000 && strange * 200 <= count, "{strange} of {count}");
    // The comparison sees a lamp that is missing, and without lamps all show the even light alone.
    let [strange, _] = strangers(&scene, &parts, |part, l| as_lit_by(&lamps[1..], part, l));
    assert!(strange * 2 > count, "{strange} of {count}");
    let (dark, _) = scene.parts(&gpu, &pipelines, 1 << 18);
    assert!(dark.len() == parts.len() && dark.iter().all(|part| (part.light[0] - 0.95).abs() < 1e-6));
    // Lamps change nothing but the light.
    let same =
        |a: &SplashPart, b: &SplashPart| (a.ends, a.shape, a.light[3], a.form) == (b.ends, b.shape, b.light[3], b.form);
    assert!(parts.iter().zip(&dark).all(|(a, b)| same(a, b)));
}

#[test]
fn splashes_behind_a_pane_are_told_from_others() {
    let Some(gpu) = device() else { return };
    let pipelines = SplashGpu::new(&gpu.device);
    let scene = Scene::default();
    // A skylight a metre under the eye, aslant, over a part of the view.
    let axes = [0.4 * Vec3::X, 0.3 * Vec3::new(0.0, 0.5, 1.0), Vec3::ZERO];
    let pane = Pane::new(Vec3::new(0.2, -1.0, 0.1), axes).expect("a pane");
    let panes = [pane];
    let extra = Extra {
        panes: &panes,
        ..Extra::default()
    };
    let (parts, _) = scene.parts_with(&gpu, &pipelines, 1 << 18, extra);
    let [strange, count] = strangers(&scene, &parts, |part, l| (part.form[3] < 0.0) == pane.hides(l.p));
    assert!(strange * 200 <= count, "{strange} of {count}");
    let behind = parts.iter().filter(|part| part.form[3] < 0.0).count();
    assert!(behind > 100 && behind * 2 < count, "{behind} of {count}");
    let (all, _) = scene.parts(&gpu, &pipelines, 1 << 18);
    assert!(all.len() == parts.len() && all.iter().all(|part| part.form[3] > 0.0));
}
