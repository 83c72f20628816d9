//! Drops behind panes are told from others as the CPU does.

use glam::Vec3;
use rain_core::hash::{pcg3d, unit_f32};
use rain_core::rainfall::{Distribution, Spectrum};
use rain_render::glass::Pane;
use rain_render::gpu_types::GlassPane;
use rain_render::rainfall::RainfallGpu;

use crate::device::{device, kernel, library};
use crate::field_parity::FieldView;

#[test]
fn points_behind_panes_are_the_cpus() {
    let Some(gpu) = device() else { return };
    let number = |i: u32, k: u32| 2.0 * unit_f32(pcg3d([i, k, 3])[0]) - 1.0;
    let vector = |i: u32, k: u32| Vec3::new(number(i, k), number(i, k + 1), number(i, k + 2));
    let (mut input, mut known): (Vec<[[f32; 4]; 4]>, Vec<bool>) = (Vec::new(), Vec::new());
    for i in 0..6000 {
        let axes = [
            vector(i, 10),
            vector(i, 20),
            if i % 2 == 0 { Vec3::ZERO } else { vector(i, 30) },
        ];
        let Some(pane) = Pane::new(3.0 * vector(i, 40), axes) else {
            continue;
        };
        let point = 6.0 * vector(i, 50);
        let GlassPane { along, up, across } = GlassPane::from(&pane);
        input.push([along, up, across, point.extend(0.0).to_array()]);
        known.push(pane.hides(point));
    }
    let source = kernel(
        &(library() + "struct In { pane: GlassPane, point: vec4<f32> }\n"),
        "In",
        "u32",
        "output[i] = u32(rain_behind_pane(input[i].pane, input[i].point.xyz));",
    );
    let found: Vec<u32> = gpu.compute(&source, &input, &[]);
    let hidden = known.iter().filter(|hidden| **hidden).count();
    let off = found
        .iter()
        .zip(&known)
        .filter(|(found, known)| (**found == 1) != **known)
        .count();
    assert!(hidden > 200 && hidden * 2 < known.len(), "{hidden} of {}", known.len());
    // Right on an edge rounding decides.
    assert!(off < 4, "{off} of {}", known.len());
}

#[test]
fn streaks_behind_a_pane_are_told_from_others() {
    let Some(gpu) = device() else { return };
    let pipelines = RainfallGpu::new(&gpu.device);
    let spectrum = Spectrum::new(Distribution::MarshallPalmer, 25.0).expect("a spectrum");
    let pane = Pane::new(Vec3::new(0.0, 0.0, -2.0), [Vec3::X, 0.5 * Vec3::Y, Vec3::ZERO]).expect("a pane");
    let view = FieldView {
        panes: vec![pane],
        ..FieldView::default()
    };
    let container = view.container(3, &spectrum);
    let streaks = view.streaks(&gpu, &pipelines, 3, &container);
    let plain = FieldView::default().streaks(&gpu, &pipelines, 3, &container);
    let (mut behind, mut before) = (0, 0);
    for ((record, streak), plain) in container.records.iter().zip(&streaks).zip(&plain) {
        let width = streak.shape[2];
        assert!(width.abs() == plain.shape[2], "as wide as without a pane");
        if width == 0.0 {
            continue;
        }
        let head = record.position(3, &container.classes);
        let class = (record.drop & 15) as usize;
        let middle = head - container.classes[class].velocity_m_s * (0.5 * view.exposure_s);
        // Beside the rim, where places agree within 1e-5 m.
        let at = middle * (2.0 / -middle.z);
        let clear = (at.x.abs() - 1.0).abs() > 1e-3 && (at.y.abs() - 0.5).abs() > 1e-3 && (middle.z + 2.0).abs() > 3e-3;
        assert!(!clear || pane.hides(middle) == (width < 0.0), "{middle}");
        behind += u32::from(width < 0.0);
        before += u32::from(width > 0.0);
    }
    assert!(behind > 500 && before > 500, "{behind} behind, {before} not");
}
