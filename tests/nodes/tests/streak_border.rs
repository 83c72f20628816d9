//! Streaks that cross the border of their view: they are cut there, and nowhere else.

use glam::{Vec2, Vec4};
use rain_core::rainfall::{Container, Distribution, Spectrum};
use rain_render::rainfall::{RainfallGpu, RainfallTextures, StreakDraws};

use crate::cover_parity::depth_texture;
use crate::device::{Device, device};
use crate::field_parity::FieldView;
use crate::near_streak::{FORMAT, SIDE, red_of_streaks};

const SEED: u64 = 11;

/// A view of so many pixels each way that all see the same drops alike in their middle.
fn view(side: u32) -> FieldView {
    let focal_px = 230.0;
    FieldView {
        size: Vec2::splat(side as f32),
        fov_y: 2.0 * (0.5 * side as f32 / focal_px).atan(),
        kappa: 2.0,
        ..FieldView::default()
    }
}

/// The red of the target, row after row, with a view whose corner is at `corner`.
fn draw(gpu: &Device, pipelines: &RainfallGpu, view: &FieldView, drops: &Container, corner: [u32; 2]) -> Vec<f32> {
    let far = depth_texture(gpu, SIDE, &vec![0.0; (SIDE * SIDE) as usize]);
    let mut input = view.input(SEED, drops);
    let [x, y] = corner.map(|v| v as f32);
    input.viewport_px = Vec4::new(x, y, view.size.x, view.size.y);
    red_of_streaks(gpu, pipelines, &input, RainfallTextures::default(), &far)
}

#[test]
fn streaks_over_the_border_are_cut_there_and_whole_inside() {
    let Some(gpu) = device() else { return };
    let mut pipelines = RainfallGpu::new(&gpu.device);
    pipelines.prepare_pipelines(&gpu.device, FORMAT, 1, StreakDraws::default());
    let (side, around, corner) = (200, 48, [150, 70]);
    let spectrum = Spectrum::new(Distribution::MarshallPalmer, 50.0).expect("a spectrum");
    let drops = view(side + 2 * around).container(SEED, &spectrum);
    let cut = draw(&gpu, &pipelines, &view(side), &drops, corner);
    let wide = draw(
        &gpu,
        &pipelines,
        &view(side + 2 * around),
        &drops,
        corner.map(|v| v - around),
    );
    let (mut lit_at_border, mut lit_around, mut off) = (0, 0, 0.0_f32);
    for y in 0..SIDE {
        for x in 0..SIDE {
            let (cut, wide) = (cut[(y * SIDE + x) as usize], wide[(y * SIDE + x) as usize]);
            let inside = |v: u32, low: u32| (low..low + side).contains(&v);
            if !inside(x, corner[0]) || !inside(y, corner[1]) {
                assert!(cut == 0.0, "drawn outside, at {x}, {y}");
                lit_around += u32::from(wide > 0.0);
                continue;
            }
            off = off.max((cut - wide).abs());
            let edge = |v: u32, low: u32| v == low || v + 1 == low + side;
            lit_at_border += u32::from(cut > 0.0 && (edge(x, corner[0]) || edge(y, corner[1])));
        }
    }
    assert!(
        lit_at_border > 100 && lit_around > 5000,
        "{lit_at_border}, {lit_around}"
    );
    assert!(off < 0.01, "{off}");
}
