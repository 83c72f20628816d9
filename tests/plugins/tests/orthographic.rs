//! Rain in a view without perspective.

use std::time::Duration;

use bevy::camera::ScalingMode;
use bevy::core_pipeline::prepass::DepthPrepass;
use bevy::prelude::*;
use rain_plugins::prelude::*;
use rain_plugins::render_adapter::{MaskKind, RainMasks, mask_image};
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

use crate::haze::{SIZE, read};

/// A view down onto level ground from the side, as in a game of buildings, in rain that falls straight down; the picture is
/// `height_m` high.
fn scene(height_m: f32) -> (TestApp, Handle<Image>) {
    scene_in(height_m, 40.0)
}

fn scene_in(height_m: f32, rain_mm_h: f64) -> (TestApp, Handle<Image>) {
    let mut test = TestApp::new(SIZE, true);
    world::without_ground(test.world());
    world::block(
        test.world(),
        "ground",
        Vec3::new(-80.0, -0.5, -80.0),
        Vec3::new(80.0, 0.0, 80.0),
        [0.02; 3],
    );
    test.world().spawn(Weather::rain(rain_mm_h));
    let masks = [MaskKind::Rain, MaskKind::Surface, MaskKind::Surface, MaskKind::Surface].map(|kind| {
        let image = mask_image(kind, SIZE[0], SIZE[1]);
        test.world().resource_mut::<Assets<Image>>().add(image)
    });
    let [rain, wet, depth, water] = masks;
    let camera = test.camera;
    test.world().entity_mut(camera).insert((
        DepthPrepass,
        Projection::Orthographic(OrthographicProjection {
            scaling_mode: ScalingMode::FixedVertical {
                viewport_height: height_m,
            },
            ..OrthographicProjection::default_3d()
        }),
        RainMasks {
            rain: rain.clone(),
            wet,
            depth,
            water,
        },
        RainView {
            streak_budget: Some(8_000),
            contrast: 8.0,
            ..default()
        },
    ));
    test.look(Vec3::new(20.0, 20.0, 30.0), Vec3::ZERO);
    test.frames(3, FRAME);
    test.leap(2);
    (test, rain)
}

/// Means of a mask over each of nine parts of the picture.
fn ninths(mask: &[f64]) -> [f64; 9] {
    let [width, height] = SIZE.map(|side| side as usize);
    let mut sums = [[0.0; 2]; 9];
    for (i, value) in mask.iter().enumerate() {
        let part = 3 * (3 * (i / width) / height) + 3 * (i % width) / width;
        sums[part] = [sums[part][0] + value, sums[part][1] + 1.0];
    }
    sums.map(|[sum, count]| sum / count)
}

#[test]
fn rain_is_as_dense_in_all_of_an_orthographic_picture_and_falls_in_parallels() {
    if !gpu::available() {
        return;
    }
    let (mut test, mask) = scene(9.0);
    let mut means = [0.0; 9];
    for _ in 0..12 {
        // Another field of drops each time.
        test.frames(1, Duration::from_millis(700));
        test.frames(1, Duration::ZERO);
        let found = read(&mut test, &mask);
        for (mean, now) in means.iter_mut().zip(ninths(&found)) {
            *mean += now / 12.0;
        }
    }
    let middle = means.iter().sum::<f64>() / 9.0;
    assert!(middle > 0.01, "{means:?}");
    for mean in means {
        assert!((mean / middle - 1.0).abs() < 0.3, "{means:?}");
    }
    // Upright in the world, so upright in the picture, at both sides: it changes more from side to side than upwards.
    let (mut close, mask) = scene(1.2);
    let found = read(&mut close, &mask);
    let (width, half) = (SIZE[0] as usize, SIZE[0] as usize / 2);
    for side in [0, half] {
        let rows = || (0..SIZE[1] as usize - 1).map(|y| y * width + side);
        let off = |step: usize| {
            let pixels = rows().flat_map(|row| row..row + half - 1);
            pixels.map(|i| (found[i] - found[i + step]).abs()).sum::<f64>()
        };
        let (across, along) = (off(1), off(width));
        assert!(across > 1.5 * along && along > 0.0, "{across} across, {along} along");
    }
    assert_eq!(test.skipped(PassName::Rainfall, SkipReason::Unsupported), 0);
}

#[test]
fn rain_lies_where_the_view_is_focused_and_behind_what_hides_it_there_is_none() {
    if !gpu::available() {
        return;
    }
    let (mut test, mask) = scene(9.0);
    let camera = test.camera;
    let rain = |test: &mut TestApp| {
        test.leap(1);
        let found = read(test, &mask);
        found.iter().sum::<f64>() / found.len() as f64
    };
    let shown = rain(&mut test);
    // The middle of the picture meets the ground after 41.2 m, its lower rim 8.1 m before that: the same depth by hand.
    let focus = |test: &mut TestApp, focus_m: f32| {
        test.world().get_mut::<RainView>(camera).expect("a rain view").focus_m = Some(focus_m);
    };
    focus(&mut test, 41.23 - 8.11 - 12.0);
    let by_hand = rain(&mut test);
    assert!(
        shown > 0.01 && (by_hand / shown - 1.0).abs() < 0.1,
        "{shown}, {by_hand}"
    );
    // All of it below the ground.
    focus(&mut test, 80.0);
    let below = rain(&mut test);
    assert!(below == 0.0, "{below} of {shown}");
    // A wall right before the camera, and all of the rain behind it.
    focus(&mut test, 30.0);
    let open = rain(&mut test);
    let back = Vec3::new(20.0, 20.0, 30.0) * 0.62;
    let wall = world::block(
        test.world(),
        "wall",
        back - Vec3::splat(9.0),
        back + Vec3::splat(9.0),
        [0.02; 3],
    );
    let hidden = rain(&mut test);
    assert!(
        hidden < 0.02 * open && open > 0.5 * shown,
        "{hidden} of {open}, {shown}"
    );
    test.world().despawn(wall);
    let again = rain(&mut test);
    assert!(again > 0.8 * open, "{again} of {open}");
}

/// Asks for the mask of a view's splashes.
fn with_splash_mask(test: &mut TestApp) -> Handle<Image> {
    let image = mask_image(MaskKind::Rain, SIZE[0], SIZE[1]);
    let mask = test.world().resource_mut::<Assets<Image>>().add(image);
    let camera = test.camera;
    test.world().entity_mut(camera).insert(SplashMask(mask.clone()));
    mask
}

/// The mean of a mask over moments that share no splash.
fn mean_of(test: &mut TestApp, mask: &Handle<Image>, moments: u32) -> Vec<f64> {
    let mut sum = vec![0.0; (SIZE[0] * SIZE[1]) as usize];
    for _ in 0..moments {
        test.frames(1, Duration::from_millis(700));
        test.frames(1, Duration::ZERO);
        for (sum, now) in sum.iter_mut().zip(read(test, mask)) {
            *sum += now / f64::from(moments);
        }
    }
    sum
}

#[test]
fn splashes_stand_all_over_a_near_picture_and_none_in_a_wide_one() {
    if !gpu::available() {
        return;
    }
    let (mut test, _) = scene(4.0);
    let mask = with_splash_mask(&mut test);
    let means = ninths(&mean_of(&mut test, &mask, 20));
    let middle = means.iter().sum::<f64>() / 9.0;
    assert!(middle > 1e-4, "{means:?}");
    for mean in means {
        assert!((mean / middle - 1.0).abs() < 0.4, "{means:?}");
    }
    assert_eq!(test.skipped(PassName::Splash, SkipReason::Unsupported), 0);
    test.reset();
    // As from further away than splashes are seen.
    let camera = test.camera;
    let mut projection = test.world().get_mut::<Projection>(camera).expect("a projection");
    if let Projection::Orthographic(flat) = &mut *projection {
        flat.scaling_mode = ScalingMode::FixedVertical { viewport_height: 20.0 };
    }
    test.frames(3, FRAME);
    assert!(test.skipped(PassName::Splash, SkipReason::Negligible) > 0);
    assert_eq!(test.recorded(PassName::Splash), 0);
    assert!(read(&mut test, &mask).iter().all(|covered| *covered == 0.0));
}

#[test]
fn a_roof_in_the_picture_keeps_off_splashes_however_far_away_the_camera_is() {
    if !gpu::available() {
        return;
    }
    for away in [30.0, 300.0] {
        let (mut test, _) = scene(4.0);
        world::roof(test.world());
        let (sin, cos) = 10.0_f32.to_radians().sin_cos();
        test.look(away * Vec3::new(0.0, sin, cos), Vec3::ZERO);
        test.frames(3, FRAME);
        let mask = with_splash_mask(&mut test);
        let found = mean_of(&mut test, &mask, 8);
        // Mean over a rectangle of the picture, metres right and up from its middle.
        let px = f64::from(SIZE[1]) / 4.0;
        let mean = |x: [f64; 2], y: [f64; 2]| {
            let [columns, rows] = [x, y].map(|[a, b]| (b - a) * px);
            let left = f64::from(SIZE[0]) / 2.0 + x[0] * px;
            let top = f64::from(SIZE[1]) / 2.0 - y[1] * px;
            let row = |j: usize| (top as usize + j) * SIZE[0] as usize + left as usize;
            let sum: f64 = (0..rows as usize)
                .map(|j| found[row(j)..row(j) + columns as usize].iter().sum::<f64>())
                .sum();
            sum / (rows.floor() * columns.floor())
        };
        let half = f64::from(world::ROOF_HALF);
        // Ground a metre further away is a sixth of a metre higher.
        let under = mean([-3.0, 3.0], [-0.12 * half, 0.12 * half]);
        let before = mean([-3.0, 3.0], [-1.7, -0.25 * half]);
        assert!(before > 1e-4, "{before} from {away} m");
        assert!(
            under < 0.02 * before,
            "{under} under the roof, {before} before it, from {away} m"
        );
    }
}

#[test]
fn a_shower_in_the_picture_is_drawn_however_far_away_the_camera_is() {
    if !gpu::available() {
        return;
    }
    let (mut test, mask) = scene_in(9.0, 0.0);
    let eye = 10.0 * Vec3::new(20.0, 20.0, 30.0);
    test.look(eye, Vec3::ZERO);
    let camera = test.camera;
    // By default rain is drawn before the ground, and this shower is smaller.
    test.world().get_mut::<RainView>(camera).expect("a rain view").focus_m = Some(eye.length());
    test.leap(1);
    assert_eq!(test.recorded(PassName::Rainfall), 0, "a dry sky");
    let shower = AreaSettings {
        shape: AreaShape::Circle { radius_m: 2.5 },
        rain: AreaRain::Rate(40.0),
        transition_m: 0.5,
        ..AreaSettings::default()
    };
    test.world().spawn(RainArea(shower));
    test.leap(2);
    let found = mean_of(&mut test, &mask, 6);
    let means = ninths(&found);
    assert!(means[4] > 8e-4, "{means:?}");
    // The picture is 16 m wide: the shower is as wide as its middle third.
    for side in [0, 2, 3, 5, 6, 8] {
        assert!(means[side] < 0.35 * means[4], "{means:?}");
    }
}
