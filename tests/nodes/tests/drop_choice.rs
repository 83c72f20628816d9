//! The drops that the GPU chooses for a view are those that the CPU chooses, in the same order.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use rain_core::rainfall::areas::{AreaField, AreaRain, AreaSettings, AreaShape, DensityMap};
use rain_core::rainfall::{
    Container, DetailLaw, Distribution, DropChoice, DropRecord, Follow, FollowSettings, FollowShape, RateLadder,
    SizeClass, Spectrum, Threshold, UnevenRain, quality_for_budget,
};
use rain_render::rainfall::{Drops, RainfallGpu, RainfallTextures, RainfallViewGpu, encode_project};

use crate::device::{Device, device};
use crate::field_parity::FieldView;

/// What came back from the GPU.
#[derive(Debug, PartialEq)]
struct Chosen {
    records: Vec<DropRecord>,
    /// Which of them may have a pattern.
    near: Vec<u32>,
    /// How many there would be without a limit.
    wanted: u32,
    /// Workgroups of the projection, then index counts of the draws.
    work: Vec<u32>,
}

fn chosen(
    gpu: &Device,
    pipelines: &RainfallGpu,
    view_gpu: &mut RainfallViewGpu,
    view: &FieldView,
    choice: &DropChoice,
    patterned: bool,
) -> Chosen {
    let mut input = view.input_of(Drops::Chosen(choice));
    input.shutter.patterned = patterned;
    assert!(view_gpu.prepare(&gpu.device, &gpu.queue, pipelines, &input, RainfallTextures::default()));
    let mut encoder = gpu
        .device
        .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        encode_project(&mut pass, pipelines, view_gpu);
    }
    gpu.queue.submit([encoder.finish()]);
    let words = |buffer: &wgpu::Buffer, count: u64| -> Vec<u32> {
        if count == 0 {
            return Vec::new();
        }
        bytemuck::pod_collect_to_vec(&gpu.read(buffer, 4 * count))
    };
    let draws = u64::from(view_gpu.most_drops().div_ceil(1 << 14));
    let arguments = words(view_gpu.arguments(), 12 + 10 * draws);
    let records = words(view_gpu.records(), 2 * u64::from(arguments[0]));
    let mut work = arguments[4..7].to_vec();
    work.extend(arguments[12..].chunks(5).map(|draw| draw[0]));
    Chosen {
        records: records
            .chunks(2)
            .map(|w| DropRecord { cell: w[0], drop: w[1] })
            .collect(),
        near: words(view_gpu.near_drops(), u64::from(arguments[1])),
        wanted: arguments[2],
        work,
    }
}

/// A drop's name: without its presence.
fn name(record: &DropRecord) -> (u32, u32) {
    (record.cell, record.drop & 0xFFFF)
}

/// That both are the same drops in the same order, but for the share `off` of them, with presences within `bound`.
fn assert_same(found: &[DropRecord], expected: &Container, off: f64, bound: f64, of: &str) {
    let places: BTreeMap<(u32, u32), (usize, u32)> = (0..)
        .zip(&expected.records)
        .map(|(i, record)| (name(record), (i, record.drop >> 16)))
        .collect();
    assert_eq!(places.len(), expected.records.len());
    let mut last = None;
    let (mut same, mut worst) = (0, 0.0_f64);
    for record in found {
        if let Some((place, presence)) = places.get(&name(record)) {
            assert!(last < Some(*place), "{of}: out of order");
            last = Some(*place);
            same += 1;
            worst = worst.max((f64::from(record.drop >> 16) - f64::from(*presence)).abs() / 65_535.0);
        }
    }
    let most = found.len().max(expected.records.len());
    assert!(
        (most - same) as f64 <= off * most as f64,
        "{of}: {same} of {} and {} are the same",
        found.len(),
        expected.records.len()
    );
    assert!(worst <= bound, "{of}: presence {worst}");
}

fn filled(choice: &DropChoice) -> Container {
    let mut container = Container::default();
    assert!(choice.fill(&mut container));
    container
}

fn rain(rate: f64) -> Spectrum {
    Spectrum::new(Distribution::MarshallPalmer, rate).expect("a spectrum")
}

#[test]
fn without_perspective_the_gpu_lists_the_drops_of_the_cpu_too() {
    let Some(gpu) = device() else { return };
    let pipelines = RainfallGpu::new(&gpu.device);
    let mut view_gpu = RainfallViewGpu::new(&gpu.device);
    for (rate, width_m) in [(5.0, 30.0), (25.0, 12.0), (100.0, 4.0)] {
        let mut view = FieldView {
            width_m: Some(width_m),
            ..FieldView::default()
        };
        let shown = view.choice(0, &rain(rate)).view;
        view.kappa = quality_for_budget(&rain(rate), &shown, 8_000.0);
        let choice = view.choice(0xFEDC_BA98_7654_3210, &rain(rate));
        let expected = filled(&choice);
        let found = chosen(&gpu, &pipelines, &mut view_gpu, &view, &choice, false);
        let drawn = found.records.len();
        assert!((6_000..12_000).contains(&drawn), "{width_m} m: {drawn} drops");
        assert_same(&found.records, &expected, 1e-3, 1e-3, &format!("{width_m} m"));
    }
}

#[test]
fn the_gpu_lists_the_drops_of_the_cpu_in_its_order() {
    let Some(gpu) = device() else { return };
    let pipelines = RainfallGpu::new(&gpu.device);
    let mut view_gpu = RainfallViewGpu::new(&gpu.device);
    for (rate, kappa, speed) in [(0.3, 4.0, 0.0), (5.0, 2.0, 0.0), (25.0, 1.1, 36.0), (100.0, 0.62, 0.0)] {
        let view = FieldView {
            kappa,
            eye_velocity_m_s: DVec3::new(0.3 * speed, 0.0, -speed),
            ..FieldView::default()
        };
        let choice = view.choice(0xFEDC_BA98_7654_3210, &rain(rate));
        let expected = filled(&choice);
        let found = chosen(&gpu, &pipelines, &mut view_gpu, &view, &choice, false);
        assert!(found.records.len() > 2000, "{rate} mm/h: {} drops", found.records.len());
        // Drops within 1e-4 m of a border may be on either side of it.
        assert_same(&found.records, &expected, 1e-3, 1e-3, &format!("{rate} mm/h"));
        // What is dispatched and drawn is all of them, and no more.
        let count = found.records.len() as u32;
        assert_eq!(found.wanted, count);
        assert_eq!(found.work[..3], [count.div_ceil(64), 1, 1]);
        assert_eq!(found.work[3..].iter().sum::<u32>(), 6 * count);
        // The same bytes the second time, beside other buffers too.
        let again = chosen(&gpu, &pipelines, &mut view_gpu, &view, &choice, false);
        assert_eq!(again, found);
        let other = chosen(
            &gpu,
            &pipelines,
            &mut RainfallViewGpu::new(&gpu.device),
            &view,
            &choice,
            false,
        );
        assert_eq!(other, found);
    }
}

#[test]
fn cells_with_more_drops_than_are_staged_lose_none() {
    let Some(gpu) = device() else { return };
    let pipelines = RainfallGpu::new(&gpu.device);
    let mut view_gpu = RainfallViewGpu::new(&gpu.device);
    let view = FieldView {
        kappa: 2.5,
        ..FieldView::default()
    };
    let choice = view.choice(11, &rain(25.0));
    let expected = filled(&choice);
    let mut of_cells: BTreeMap<(u32, u32), u32> = BTreeMap::new();
    for record in &expected.records {
        *of_cells.entry((record.drop & 15, record.cell)).or_default() += 1;
    }
    let limits: Vec<f32> = SizeClass::all()
        .iter()
        .map(|class| Threshold::new(class, &choice.spectrum).scan_limit())
        .collect();
    // Cells that are looked through one by one have room for three standard deviations above the mean, and two drops.
    let more = of_cells.iter().filter(|((class, _), count)| {
        let limit = limits[*class as usize];
        limit >= 4.0 && **count as f32 > (limit + 3.0 * limit.sqrt()).ceil() + 2.0
    });
    let more = more.count();
    assert!(more > 3 && more * 200 < of_cells.len(), "{more} of {}", of_cells.len());
    let found = chosen(&gpu, &pipelines, &mut view_gpu, &view, &choice, true);
    assert_same(&found.records, &expected, 1e-3, 1e-3, "full cells");
}

#[test]
fn uneven_rain_is_chosen_as_the_cpu_does() {
    let Some(gpu) = device() else { return };
    let pipelines = RainfallGpu::new(&gpu.device);
    let mut view_gpu = RainfallViewGpu::new(&gpu.device);
    let ladder = Arc::new(RateLadder::new(Distribution::MarshallPalmer));
    let view = FieldView::default();
    let eye = DVec2::new(view.eye_m.x, view.eye_m.z);
    let area = |at: [f64; 2], shape: AreaShape, rain: AreaRain, transition_m: f64| AreaSettings {
        centre_m: eye + DVec2::from(at),
        shape,
        rain,
        transition_m,
        ..AreaSettings::default()
    };
    let disc = area(
        [6.0, -5.0],
        AreaShape::Circle { radius_m: 8.0 },
        AreaRain::Rate(60.0),
        4.0,
    );
    let ellipse = area(
        [-5.0, -7.0],
        AreaShape::Ellipse {
            radii_m: DVec2::new(6.0, 2.0),
            heading_rad: 0.4,
        },
        AreaRain::OfWeather(3.0),
        0.0,
    );
    let triangle = area(
        [0.0, -3.0],
        AreaShape::Polygon {
            corners_m: [[-3.0, 2.0], [4.0, 1.0], [0.0, -6.0]].map(DVec2::from).to_vec(),
        },
        AreaRain::Scale(0.25),
        1.0,
    );
    let painted = AreaSettings {
        density: Some(
            DensityMap::new(DVec2::splat(16.0), [4, 4], (0..16).map(|i| (i * 17) as u8).collect()).expect("a painting"),
        ),
        ..disc.clone()
    };
    for (of, areas, outside, weather) in [
        ("a shower", vec![&disc], 0.0, 0.0),
        ("several", vec![&disc, &ellipse, &triangle], 1.0, 12.0),
        ("a painting", vec![&painted], 0.05, 10.0),
        ("no rain", vec![&ellipse], 0.0, 0.0),
    ] {
        let mut field = AreaField::new(outside);
        for area in areas {
            field.push(area, DVec2::ZERO, 0.0);
        }
        let highest = field.highest_mm_h(weather);
        let choice = DropChoice {
            uneven: Some(Arc::new(UnevenRain {
                areas: field,
                ladder: ladder.clone(),
                weather_mm_h: weather,
            })),
            ..view.choice(5, &rain(highest))
        };
        let expected = filled(&choice);
        let found = chosen(&gpu, &pipelines, &mut view_gpu, &view, &choice, false);
        assert_eq!(
            found.records.len() > 1500,
            of != "no rain",
            "{of}: {}",
            found.records.len()
        );
        // Single precision moves a sharp edge by 1e-5 m, and a rank across its soft threshold by 1e-2 of it.
        assert_same(&found.records, &expected, 2e-3, 2e-2, of);
    }
}

#[test]
fn containers_and_laws_of_detail_leave_out_the_same_drops() {
    let Some(gpu) = device() else { return };
    let pipelines = RainfallGpu::new(&gpu.device);
    let mut view_gpu = RainfallViewGpu::new(&gpu.device);
    let view = FieldView::default();
    let all = filled(&view.choice(7, &rain(25.0))).records.len();
    let follow = Follow {
        centre_m: view.eye_m + DVec3::new(0.5, -0.2, 0.3),
        heading_rad: 0.3,
    };
    let settings = |shape, rim_m| FollowSettings {
        shape,
        slack_m: 1.0,
        rim_m,
    };
    let half_cylinder = FollowShape::SemiCylinder {
        across_m: 3.0,
        ahead_m: 6.0,
        height_m: 3.0,
    };
    let block = FollowShape::Block {
        width_m: 4.0,
        height_m: 2.5,
        depth_m: 6.0,
    };
    for (of, region, detail) in [
        ("half a cylinder", Some((follow, settings(half_cylinder, 0.8))), None),
        ("a block", Some((follow, settings(block, 0.5))), None),
        ("a block with a sharp rim", Some((follow, settings(block, 0.0))), None),
        ("optical depth", None, Some(DetailLaw::OpticalDepth)),
        ("quadratic", None, Some(DetailLaw::QUADRATIC)),
        ("Gaussian", None, Some(DetailLaw::GAUSSIAN)),
        ("both", Some((follow, settings(block, 0.5))), Some(DetailLaw::GAUSSIAN)),
    ] {
        let choice = DropChoice {
            region,
            detail,
            ..view.choice(7, &rain(25.0))
        };
        let expected = filled(&choice);
        let found = chosen(&gpu, &pipelines, &mut view_gpu, &view, &choice, false);
        let count = found.records.len();
        assert!(count > 300 && count * 20 < all * 19, "{of}: {count} of {all}");
        assert_same(&found.records, &expected, 2e-3, 2e-3, of);
    }
}

#[test]
fn no_more_are_drawn_than_asked_for_and_how_many_there_are_is_known() {
    let Some(gpu) = device() else { return };
    let pipelines = RainfallGpu::new(&gpu.device);
    let mut view_gpu = RainfallViewGpu::new(&gpu.device);
    let view = FieldView::default();
    let choice = view.choice(3, &rain(25.0));
    let whole = chosen(&gpu, &pipelines, &mut view_gpu, &view, &choice, true);
    let most = whole.records.len() as u32 / 2;
    let cut = DropChoice {
        most_drops: most,
        ..choice
    };
    let found = chosen(&gpu, &pipelines, &mut view_gpu, &view, &cut, true);
    assert_eq!(found.records, whole.records[..most as usize]);
    assert_eq!(found.wanted, whole.records.len() as u32);
    // Near drops beyond the limit are named as none.
    let near: Vec<u32> = found.near.iter().copied().filter(|i| *i != u32::MAX).collect();
    let expected: Vec<u32> = whole.near.iter().copied().filter(|i| *i < most).collect();
    assert!(!near.is_empty() && near == expected);
    // More than any buffer holds is as many as one holds.
    let endless = DropChoice {
        most_drops: u32::MAX,
        ..cut
    };
    let found = chosen(&gpu, &pipelines, &mut view_gpu, &view, &endless, true);
    assert!(view_gpu.most_drops() > most && view_gpu.most_drops() < u32::MAX);
    assert_eq!(found.records, whole.records);
}

#[test]
fn every_wide_streak_is_near_and_few_others_are() {
    let Some(gpu) = device() else { return };
    let pipelines = RainfallGpu::new(&gpu.device);
    let mut view_gpu = RainfallViewGpu::new(&gpu.device);
    let view = FieldView::default();
    let choice = view.choice(3, &rain(50.0));
    let found = chosen(&gpu, &pipelines, &mut view_gpu, &view, &choice, true);
    assert!(found.near.is_sorted() && found.near.iter().all(|i| (*i as usize) < found.records.len()));
    let cells = choice.cells();
    let placements = cells.placements();
    let mut wide = 0;
    for (i, record) in (0_u32..).zip(&found.records) {
        let class = (record.drop & 15) as usize;
        let head = record.position(3, &placements);
        let middle = view.project(head - placements[class].velocity_m_s * (0.5 * view.exposure_s));
        let seen = middle.z > 0.05
            && middle.truncate().cmpge(glam::Vec2::ZERO).all()
            && middle.truncate().cmple(view.size).all();
        if seen && 1e-3 * SizeClass::new(class).max_mm as f32 * view.focal_px() / middle.z > 1.5 {
            wide += 1;
            assert!(found.near.contains(&i), "{middle}");
        }
    }
    let (near, all) = (found.near.len(), found.records.len());
    assert!(wide > 20 && near * 10 < all, "{wide} wide, {near} of {all} listed");
    assert!(
        chosen(&gpu, &pipelines, &mut view_gpu, &view, &choice, false)
            .near
            .is_empty()
    );
}

#[test]
fn dry_air_and_broken_views_draw_nothing() {
    let Some(gpu) = device() else { return };
    let pipelines = RainfallGpu::new(&gpu.device);
    let mut view_gpu = RainfallViewGpu::new(&gpu.device);
    let view = FieldView::default();
    let rainy = view.choice(3, &rain(25.0));
    let some = chosen(&gpu, &pipelines, &mut view_gpu, &view, &rainy, true);
    assert!(some.records.len() > 5000 && !some.near.is_empty());
    let mut blind = rainy.clone();
    blind.view.side_planes[2].x = f32::NAN;
    let mut dark = rainy.clone();
    dark.view.exposure_s = f64::NAN;
    for (of, choice) in [
        ("dry", view.choice(3, &rain(0.0))),
        (
            "no quality",
            DropChoice {
                kappa: 0.0,
                ..rainy.clone()
            },
        ),
        (
            "quality that is no number",
            DropChoice {
                kappa: f64::NAN,
                ..rainy.clone()
            },
        ),
        ("a side that is no number", blind),
        ("a shutter that is no number", dark),
    ] {
        let found = chosen(&gpu, &pipelines, &mut view_gpu, &view, &choice, true);
        assert_eq!(filled(&choice).records.len(), 0, "{of}");
        assert_eq!((found.records.len(), found.near.len(), found.wanted), (0, 0, 0), "{of}");
        assert_eq!(
            found.work,
            vec![0; found.work.len()]
                .iter()
                .enumerate()
                .map(|(i, _)| u32::from(i == 1 || i == 2))
                .collect::<Vec<_>>(),
            "{of}"
        );
    }
    // An eye that is nowhere stands at the origin, one that moves by no number stands still.
    let mut lost = rainy.clone();
    lost.view.eye_m = DVec3::NAN;
    lost.view.eye_velocity_m_s = DVec3::NAN;
    let found = chosen(&gpu, &pipelines, &mut view_gpu, &view, &lost, false);
    assert_same(&found.records, &filled(&lost), 1e-3, 1e-3, "an eye that is nowhere");
}
