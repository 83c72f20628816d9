//! Streaks carry exactly the optical depth of their drops, whatever the shutter, the speed of the camera and the
//! quality.

use glam::{DVec3, Vec2};
use rain_core::haze::near_weight;
use rain_core::rainfall::{CLASS_EDGES_MM, DetailLaw, Distribution, DrawRange, RANGE_CAP_M, Spectrum};
use rain_render::gpu_types::Streak;
use rain_render::rainfall::RainfallGpu;

use crate::device::{Device, device};
use crate::field_parity::{FieldView, half_pair};

/// Σ opacity · width · length of the streaks whose middles are in the picture, per pixel: the picture's mean optical
/// depth, as long as opacities are small. The lengths follow the draw shader: at least 1 px, the drop's own size added.
fn optical_depth(view: &FieldView, streaks: &[Streak]) -> f64 {
    let mut sum = 0.0;
    for s in streaks.iter().filter(|s| s.shape[2] > 0.0) {
        let (head, tail) = (Vec2::new(s.ends[0], s.ends[1]), Vec2::new(s.ends[2], s.ends[3]));
        let middle = 0.5 * (head + tail);
        if middle.cmpge(Vec2::ZERO).all() && middle.cmplt(view.size).all() {
            // Half the width is stored.
            let width = f64::from(2.0 * s.shape[2]);
            let size = if width > 1.0 { width } else { 0.0 };
            let length = (f64::from((head - tail).length()) + size).max(1.0);
            sum += f64::from(half_pair(s.shares)[0]) * width * length;
        }
    }
    sum / f64::from(view.size.x * view.size.y)
}

/// A narrow view: the projected size of a drop is that on the axis within 2 %.
fn narrow() -> FieldView {
    FieldView {
        size: Vec2::new(800.0, 800.0),
        fov_y: 0.35,
        kappa: 4.0,
        wind_m_s: DVec3::ZERO,
        ..FieldView::default()
    }
}

/// The mean over several instants far enough apart to show other drops.
fn mean_depth(gpu: &Device, pipelines: &RainfallGpu, spectrum: &Spectrum, of: impl Fn(f64) -> FieldView) -> f64 {
    const INSTANTS: u32 = 24;
    let sum: f64 = (0..INSTANTS)
        .map(|i| {
            let view = of(100.0 + 7.0 * f64::from(i));
            let container = view.container(9, spectrum);
            optical_depth(&view, &view.streaks(gpu, pipelines, 9, &container))
        })
        .sum();
    sum / f64::from(INSTANTS)
}

/// ∫ N(D) (π/4) D² (z_s(D) − 0.15 m) dD over the drawn diameters: the weights fade in between 0.1 and 0.2 m and out
/// between 0.8 and 1.2 z_s, both symmetric. Simpson, 4000 steps.
fn expected(spectrum: &Spectrum, view: &FieldView) -> f64 {
    let range = DrawRange {
        kappa: view.kappa,
        focal_px: f64::from(view.focal_px()),
        exposure_s: f64::from(view.exposure_s),
    };
    let (a, b, n) = (CLASS_EDGES_MM[0], CLASS_EDGES_MM[12], 4000);
    let h = (b - a) / f64::from(n);
    let f =
        |d: f64| spectrum.concentration(d) * std::f64::consts::FRAC_PI_4 * d * d * 1e-6 * (range.at(d) - 0.15).max(0.0);
    let inner: f64 = (1..n)
        .map(|i| f(a + h * f64::from(i)) * if i % 2 == 1 { 4.0 } else { 2.0 })
        .sum();
    (f(a) + f(b) + inner) * h / 3.0
}

#[test]
fn optical_depth_of_the_drawn_drops_is_extinction_times_path_within_5_percent() {
    let Some(gpu) = device() else { return };
    let pipelines = RainfallGpu::new(&gpu.device);
    for intensity in [5.0, 25.0, 100.0] {
        let spectrum = Spectrum::new(Distribution::MarshallPalmer, intensity).expect("a spectrum");
        let found = mean_depth(&gpu, &pipelines, &spectrum, |seconds| FieldView { seconds, ..narrow() });
        let expected = expected(&spectrum, &narrow());
        assert!(expected > 0.001, "{expected}");
        let error = found / expected - 1.0;
        assert!(
            error.abs() < 0.05,
            "{intensity} mm/h: {found}, extinction times path {expected} ({error:+.3})"
        );
    }
}

#[test]
fn optical_depth_does_not_change_with_the_shutter_or_the_speed_of_the_camera() {
    let Some(gpu) = device() else { return };
    let pipelines = RainfallGpu::new(&gpu.device);
    let spectrum = Spectrum::new(Distribution::MarshallPalmer, 25.0).expect("a spectrum");
    let depth = |kappa: f64, exposure_s: f32, speed: f64| {
        mean_depth(&gpu, &pipelines, &spectrum, |seconds| FieldView {
            seconds,
            exposure_s,
            kappa,
            eye_velocity_m_s: DVec3::new(speed, 0.0, 0.0),
            ..narrow()
        })
    };
    let still = depth(0.8, 1.0 / 60.0, 0.0);
    // The range of single drops is κ times one that goes with 1/shutter: doubling both draws the same drops.
    let slow_shutter = depth(1.6, 1.0 / 30.0, 0.0);
    let other_quality = depth(0.8, 1.0 / 30.0, 0.0);
    let moving = depth(0.8, 1.0 / 60.0, 8.0);
    assert!(
        (slow_shutter / still - 1.0).abs() < 0.02,
        "{still} at 1/60 s, {slow_shutter} at 1/30 s"
    );
    // A moving camera looks a metre further to its side: a few drops differ.
    assert!(
        (moving / still - 1.0).abs() < 0.08,
        "{still} standing, {moving} at 8 m/s"
    );
    // Other drops are another depth: the comparison can fail.
    assert!((other_quality / still - 1.0).abs() > 0.2, "{still}, {other_quality}");
}

#[test]
fn a_law_of_detail_changes_the_optical_depth_by_its_error_and_the_default_does_not() {
    let Some(gpu) = device() else { return };
    let pipelines = RainfallGpu::new(&gpu.device);
    let spectrum = Spectrum::new(Distribution::MarshallPalmer, 100.0).expect("a spectrum");
    // Everything is drawn up to the cap: its distance is the law's.
    let of = |detail: Option<DetailLaw>| {
        mean_depth(&gpu, &pipelines, &spectrum, |seconds| FieldView {
            seconds,
            detail,
            ..narrow()
        })
    };
    // Drops lie evenly along a line of sight, each over a way of its range less the fades.
    let view = narrow();
    let range = DrawRange {
        kappa: view.kappa,
        focal_px: f64::from(view.focal_px()),
        exposure_s: f64::from(view.exposure_s),
    };
    let predicted = |law: DetailLaw| {
        let (mut with, mut without) = (0.0, 0.0);
        for i in 0..200 {
            let (low, high) = (CLASS_EDGES_MM[0], CLASS_EDGES_MM[12]);
            let d = low + (high - low) * (f64::from(i) + 0.5) / 200.0;
            let area = spectrum.concentration(d) * d * d;
            for k in 0..400 {
                let z = range.at(d) * 1.2 * (f64::from(k) + 0.5) / 400.0;
                let weight = area * range.at(d) * near_weight(z, range.at(d));
                with += weight * law.coverage(z / RANGE_CAP_M);
                without += weight;
            }
        }
        with / without
    };
    let plain = of(None);
    for law in [DetailLaw::OpticalDepth, DetailLaw::QUADRATIC, DetailLaw::GAUSSIAN] {
        let (found, expected) = (of(Some(law)) / plain, predicted(law));
        // Both are means over the same moments; the 5 % of the undiminished drops' own test.
        assert!(
            (found / expected - 1.0).abs() < 0.05,
            "{law:?}: {found}, its law {expected}"
        );
    }
    assert!((predicted(DetailLaw::OpticalDepth) - 1.0).abs() < 1e-9 && predicted(DetailLaw::GAUSSIAN) < 0.93);
}
