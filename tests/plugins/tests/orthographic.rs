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
    let mut test = TestApp::new(SIZE, true);
    world::without_ground(test.world());
    world::block(
        test.world(),
        "ground",
        Vec3::new(-80.0, -0.5, -80.0),
        Vec3::new(80.0, 0.0, 80.0),
        [0.02; 3],
    );
    test.world().spawn(Weather::rain(40.0));
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
    let back = Vec3::new(20.0, 20.0, 30.0) * 0.9;
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
