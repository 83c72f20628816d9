//! Streaks where they meet the scene: how they fade before it, and which of them a roof keeps off.

use glam::{DVec2, DVec3, Vec2, Vec4};
use rain_core::rainfall::{Container, Distribution, Spectrum};
use rain_render::gpu_types::Streak;
use rain_render::rainfall::{RainfallGpu, RainfallTextures, RainfallViewGpu, StreakDraws, encode_project};

use crate::cover_parity::{EYE, depth_map, depth_texture, heights, placement};
use crate::device::{Device, device};
use crate::field_parity::{FieldView, half_pair};
use crate::near_streak::{FORMAT, SIDE, red_of_streaks};

const SEED: u64 = 5;
const NEAR_M: f32 = 0.05;
const SOFT_M: f32 = 0.5;
/// The view's corner in its target, and its side. Units: px.
const CORNER: [u32; 2] = [128, 64];
const VIEW: u32 = 256;

fn view() -> FieldView {
    FieldView {
        size: Vec2::splat(VIEW as f32),
        eye_m: DVec3::new(3.0, 1.7, -2.0),
        wind_m_s: DVec3::ZERO,
        kappa: 3.0,
        ..FieldView::default()
    }
}

/// Depth of a pixel of the view, by its middle.
type Depth = dyn Fn(&FieldView, Vec2) -> f32;

/// Level ground, 1.7 m below the eye.
fn ground(view: &FieldView, at: Vec2) -> f32 {
    let down = (at.y - 0.5 * view.size.y) / view.focal_px();
    NEAR_M * down.max(0.0) / 1.7
}

/// Depth of all of the target.
fn depth_of(view: &FieldView, depth: &Depth) -> Vec<f32> {
    (0..SIDE * SIDE)
        .map(|i| {
            let at = Vec2::new((i % SIDE) as f32, (i / SIDE) as f32) + 0.5;
            let inside = at - Vec2::new(CORNER[0] as f32, CORNER[1] as f32);
            // Outside the view lies something that hides everything.
            if inside.cmpge(Vec2::ZERO).all() && inside.cmplt(view.size).all() {
                depth(view, inside)
            } else {
                1.0
            }
        })
        .collect()
}

/// The red of the view, row after row, with even light of 1 before black; `soft_m` of 0 is a hard depth test.
fn draw(
    gpu: &Device,
    pipelines: &mut RainfallGpu,
    view: &FieldView,
    drops: &Container,
    scene: &wgpu::TextureView,
    soft_m: f32,
) -> Vec<f32> {
    let draws = StreakDraws {
        soft: soft_m > 0.0,
        ..StreakDraws::default()
    };
    pipelines.prepare_pipelines(&gpu.device, FORMAT, 1, draws);
    let mut input = view.input(SEED, drops);
    input.shutter.soft_m = soft_m;
    input.viewport_px = Vec4::new(CORNER[0] as f32, CORNER[1] as f32, VIEW as f32, VIEW as f32);
    let textures = RainfallTextures {
        scene_depth: Some(scene),
        ..RainfallTextures::default()
    };
    let all = red_of_streaks(gpu, pipelines, &input, textures, scene);
    let red = |x: u32, y: u32| all[((y + CORNER[1]) * SIDE + x + CORNER[0]) as usize];
    (0..VIEW * VIEW).map(|i| red(i % VIEW, i / VIEW)).collect()
}

/// Depth of a streak where it is nearest to a pixel.
fn own_depth(streak: &Streak, at: Vec2) -> f32 {
    let [ax, ay, bx, by] = streak.ends;
    let (a, b) = (Vec2::new(ax, ay), Vec2::new(bx, by));
    let path = b - a;
    let span = (path.length()
        + if streak.shape[2] > 0.5 {
            2.0 * streak.shape[2]
        } else {
            0.0
        })
    .max(1.0);
    let along = (0.5 + (at - 0.5 * (a + b)).dot(path.normalize_or(Vec2::Y)) / span).clamp(0.0, 1.0);
    streak.shape[0] + (streak.shape[1] - streak.shape[0]) * along
}

/// Drops whose streaks are at least 8 px long in the picture and pass `keep`, each alone.
fn single_drops(
    gpu: &Device,
    pipelines: &RainfallGpu,
    view: &FieldView,
    keep: impl Fn(&Streak) -> bool,
) -> Vec<(Container, Streak)> {
    let spectrum = Spectrum::new(Distribution::MarshallPalmer, 50.0).expect("a spectrum");
    let container = view.container(SEED, &spectrum);
    let streaks = view.streaks(gpu, pipelines, SEED, &container);
    let inside = |x: f32, y: f32| (4.0..252.0).contains(&x) && (4.0..252.0).contains(&y);
    let mut found = Vec::new();
    for (record, streak) in container.records.iter().zip(&streaks) {
        let [ax, ay, bx, by] = streak.ends;
        let seen = streak.shape[2] > 0.0 && inside(ax, ay) && inside(bx, by);
        if seen && (by - ay).abs() > 8.0 && keep(streak) {
            let mut alone = container.clone();
            alone.records = vec![*record];
            found.push((alone, *streak));
        }
    }
    found
}

#[test]
fn streaks_fade_before_the_ground_as_each_of_their_places_would() {
    let Some(gpu) = device() else { return };
    let mut pipelines = RainfallGpu::new(&gpu.device);
    let view = view();
    let scene = depth_texture(&gpu, SIDE, &depth_of(&view, &ground));
    // Their heads are much nearer to the ground, along the line of sight, than the fade is long.
    let near = single_drops(&gpu, &pipelines, &view, |s| {
        let own = NEAR_M / s.shape[0];
        let gap = NEAR_M / ground(&view, Vec2::new(s.ends[0], s.ends[1])).max(1e-7) - own;
        (0.0..0.3 * SOFT_M).contains(&gap)
    });
    assert!(near.len() >= 8, "{} drops near the ground", near.len());
    let (mut off, mut weight, mut faded) = (0.0, 0.0, 0.0);
    for (drop, streak) in &near {
        let hard = draw(&gpu, &mut pipelines, &view, drop, &scene, 0.0);
        let soft = draw(&gpu, &mut pipelines, &view, drop, &scene, SOFT_M);
        for (i, (hard, soft)) in (0_u32..).zip(hard.iter().zip(&soft)) {
            if *hard <= 0.0 {
                assert!(*soft <= 0.0);
                continue;
            }
            let at = Vec2::new((i % VIEW) as f32, (i / VIEW) as f32) + 0.5;
            let gap = NEAR_M / ground(&view, at).max(1e-7) - NEAR_M / own_depth(streak, at);
            let left = (gap / SOFT_M).clamp(0.0, 1.0);
            off += f64::from((soft - hard * left).abs());
            faded += f64::from(hard - soft);
            weight += f64::from(*hard);
        }
    }
    assert!(faded > 0.1 * weight, "{faded} of {weight} faded");
    assert!(off < 0.03 * weight, "{off} of {weight} off");
}

/// What a streak shows of light 1 at a pixel's middle: as `rain_strip` has it, across and along it.
fn strip(streak: &Streak, at: Vec2) -> f32 {
    let [ax, ay, bx, by] = streak.ends;
    let (head, tail) = (Vec2::new(ax, ay), Vec2::new(bx, by));
    let width = 2.0 * streak.shape[2];
    let along = (tail - head).normalize_or(Vec2::Y);
    let span = ((tail - head).length() + if width > 1.0 { width } else { 0.0 }).max(1.0);
    let off = at - 0.5 * (head + tail);
    let inside = |distance: f32, size: f32| (0.5 + 0.5 * size - distance.abs()).clamp(0.0, 1.0);
    inside(off.perp_dot(along), width) * inside(off.dot(along), span)
}

#[test]
fn streaks_of_any_length_cover_each_pixel_as_their_strip_does() {
    let Some(gpu) = device() else { return };
    let mut pipelines = RainfallGpu::new(&gpu.device);
    let view = view();
    let scene = depth_texture(&gpu, SIDE, &depth_of(&view, &|_, _| 0.0));
    // On a software device the short ones are triangles, the others quads.
    for lengths in [8.0..34.0, 38.0..200.0] {
        let drops = single_drops(&gpu, &pipelines, &view, |s| {
            // The target's halves have no digits for the faintest.
            let length = Vec2::new(s.ends[2] - s.ends[0], s.ends[3] - s.ends[1]).length();
            lengths.contains(&length) && half_pair(s.shares)[0] > 2e-3
        });
        assert!(drops.len() >= 6, "{} drops of {lengths:?} px", drops.len());
        for (drop, streak) in drops.iter().take(6) {
            let drawn = draw(&gpu, &mut pipelines, &view, drop, &scene, 0.0);
            let light = streak.light[0] * half_pair(streak.shares)[0];
            let (mut sum, mut off) = (0.0_f32, 0.0_f32);
            for (i, drawn) in (0_u32..).zip(&drawn) {
                let at = Vec2::new((i % VIEW) as f32, (i / VIEW) as f32) + 0.5;
                let expected = light * strip(streak, at);
                sum += expected;
                off = off.max((drawn - expected).abs());
            }
            // Corners lie on 1/256 of a pixel; the target's halves have three digits.
            assert!(off < 0.02 * light, "{off} of {light} off, {:?}", streak.ends);
            let all: f32 = drawn.iter().sum();
            assert!((all - sum).abs() < 2e-3 * sum, "{all} and {sum}");
        }
    }
}

#[test]
fn a_streak_half_behind_a_post_keeps_its_other_half() {
    let Some(gpu) = device() else { return };
    let mut pipelines = RainfallGpu::new(&gpu.device);
    let view = view();
    // Far from the ground and from the sky behind it.
    let drops = single_drops(&gpu, &pipelines, &view, |s| {
        (2.0..8.0).contains(&(NEAR_M / s.shape[0])) && (s.ends[1] - s.ends[3]).abs() > 12.0
    });
    assert!(drops.len() >= 6, "{} drops", drops.len());
    for (drop, streak) in drops.iter().take(6) {
        let middle = 0.5 * (streak.ends[1] + streak.ends[3]);
        // Something half a metre from the eye hides the lower half; what is behind is 1 m away from the streak.
        let behind = NEAR_M / (NEAR_M / streak.shape[0] + 1.0);
        let post = move |_: &FieldView, at: Vec2| if at.y > middle { 0.1 } else { behind };
        let scene = depth_texture(&gpu, SIDE, &depth_of(&view, &post));
        let hard: f32 = draw(&gpu, &mut pipelines, &view, drop, &scene, 0.0).iter().sum();
        let soft: f32 = draw(&gpu, &mut pipelines, &view, drop, &scene, SOFT_M).iter().sum();
        assert!(hard > 0.0 && soft > 0.99 * hard, "{soft} of {hard} left");
    }
}

#[test]
fn rain_that_falls_straight_is_kept_off_as_by_the_look_ups_of_driven_rain() {
    let Some(gpu) = device() else { return };
    let pipelines = RainfallGpu::new(&gpu.device);
    let view = FieldView { eye_m: EYE, ..view() };
    let spectrum = Spectrum::new(Distribution::MarshallPalmer, 50.0).expect("a spectrum");
    let container = view.container(SEED, &spectrum);
    let mut map = placement();
    map.wind_m_s = DVec2::ZERO;
    let cover = depth_map(&gpu, &map, &heights(&map));
    let streaks = |wind_m_s: DVec2| {
        let mut input = view.input(SEED, &container);
        input.cover = rain_render::cover::CoverPlacement { wind_m_s, ..map }.params(EYE);
        let textures = RainfallTextures {
            cover: Some(&cover),
            ..RainfallTextures::default()
        };
        let mut buffers = RainfallViewGpu::new(&gpu.device);
        buffers.prepare(&gpu.device, &gpu.queue, &pipelines, &input, textures);
        let mut encoder = gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encode_project(
            &mut encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default()),
            &pipelines,
            &buffers,
        );
        gpu.queue.submit([encoder.finish()]);
        let bytes = gpu.read(
            buffers.streaks(),
            (container.records.len() * size_of::<Streak>()) as u64,
        );
        bytemuck::pod_collect_to_vec::<u8, Streak>(&bytes)
    };
    let calm = streaks(DVec2::ZERO);
    // So little wind that nothing moves by a texel, and yet the look-ups are those of driven rain.
    let driven = streaks(DVec2::splat(1e-20));
    let hidden = |s: &&Streak| s.shape[2] == 0.0;
    let kept_off = calm.iter().filter(hidden).count();
    assert!(
        kept_off * 20 > calm.len() && kept_off * 2 < calm.len(),
        "{kept_off} of {}",
        calm.len()
    );
    assert!(
        calm == driven,
        "{kept_off} and {}",
        driven.iter().filter(hidden).count()
    );
}
