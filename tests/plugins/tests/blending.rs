//! Every part of the rain under every setting of a view: it shows where it should, not behind what is opaque, and in the
//! right order with what is transparent.

use bevy::camera::visibility::RenderLayers;
use bevy::camera::{Hdr, ScalingMode, Viewport};
use bevy::core_pipeline::oit::OrderIndependentTransparencySettings;
use bevy::core_pipeline::prepass::{DeferredPrepass, DepthPrepass};
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::ecs::world::EntityWorldMut;
use bevy::pbr::DefaultOpaqueRendererMethod;
use bevy::prelude::*;
use image::RgbImage;
use rain_plugins::prelude::*;
use rain_plugins::rainfall::ViewPanes;
use rain_plugins::render_adapter::{MaskKind, RainMasks, mask_image};
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

use crate::scenes::{brightness, part, rain, read_texture, surfaces_only};

const SIZE: [u32; 2] = [96, 64];
const EYE: Vec3 = Vec3::new(0.0, 1.2, 8.0);

/// A part of the rain.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Of {
    Streaks,
    Cards,
    Splashes,
    Haze,
}

/// Draws one part of the rain alone, or nothing of it.
fn show(test: &mut TestApp, of: Of, on: bool) {
    let camera = test.camera;
    let view = RainView {
        enabled: of != Of::Streaks || on,
        // Cards begin where single drops end: with few of these there are many of those.
        streak_budget: Some(if of == Of::Streaks { 8_000 } else { 2 }),
        cards: Some(of == Of::Cards && on),
        contrast: 16.0,
        soft_m: 0.0,
        ..default()
    };
    let haze = HazeSettings {
        enabled: of == Of::Haze && on,
        ..default()
    };
    test.world().entity_mut(camera).insert((view, haze));
    test.world().resource_mut::<SplashSettings>().enabled = of == Of::Splashes && on;
}

/// What a part of the rain changes at a moment: pictures with and without it.
fn with_and_without(test: &mut TestApp, of: Of) -> [RgbImage; 2] {
    show(test, of, true);
    // The number of streaks follows its target at once after a pause.
    test.leap(1);
    [true, false].map(|on| {
        show(test, of, on);
        test.frames(2, std::time::Duration::ZERO);
        test.picture()
    })
}

/// Pixels of a rectangle in which two pictures differ.
pub(crate) fn changed([with, without]: &[RgbImage; 2], [x, y, width, height]: [u32; 4]) -> usize {
    let [a, b] = [with, without].map(|picture| part(picture, x, y, width, height));
    let off = |(a, b): &(&image::Rgb<u8>, &image::Rgb<u8>)| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 2);
    a.pixels().zip(b.pixels()).filter(off).count()
}

/// Sum over all pixels of how much linear light a part of the rain changes.
fn light([with, without]: &[RgbImage; 2]) -> f64 {
    let linear = |v: u8| f64::from(Srgba::gamma_function(f32::from(v) / 255.0));
    let off = |(a, b): (&image::Rgb<u8>, &image::Rgb<u8>)| (linear(a.0[1]) - linear(b.0[1])).abs();
    with.pixels().zip(without.pixels()).map(off).sum()
}

fn scene(deferred: bool) -> (TestApp, Entity) {
    screened(SIZE, deferred)
}

/// Level dark ground in a downpour that nothing gets wet by, and before the left half of the view an opaque screen so near
/// that nothing falls before it.
pub(crate) fn screened(size: [u32; 2], deferred: bool) -> (TestApp, Entity) {
    let mut test = TestApp::new(size, true);
    world::without_ground(test.world());
    // What is added to a picture is then added to its linear light.
    let camera = test.camera;
    test.world().entity_mut(camera).insert(Tonemapping::None);
    if deferred {
        test.world().insert_resource(DefaultOpaqueRendererMethod::deferred());
        test.world().entity_mut(camera).insert((DepthPrepass, DeferredPrepass));
    }
    let dark = [0.02; 3];
    let ground = world::block(
        test.world(),
        "ground",
        Vec3::new(-40.0, -0.5, -40.0),
        Vec3::new(40.0, 0.0, 40.0),
        dark,
    );
    let screen = world::block(
        test.world(),
        "screen",
        EYE + Vec3::new(-0.5, -0.5, -0.13),
        EYE + Vec3::new(0.0, 0.5, -0.11),
        dark,
    );
    for entity in [ground, screen] {
        test.world().entity_mut(entity).insert(KeepDry);
    }
    test.look(EYE, EYE + Vec3::new(0.0, -0.25, -1.0));
    test.world().spawn(Weather::rain(80.0));
    test.frames(3, FRAME);
    test.leap(2);
    (test, screen)
}

/// Whether a part shows in the right half of a rectangle, nowhere in its left half, which the screen covers, and nowhere
/// outside the rectangle.
fn check(test: &mut TestApp, name: &str, of: Of, [x, y, width, height]: [u32; 4]) {
    let pictures = with_and_without(test, of);
    let half = width / 2;
    let open = changed(&pictures, [x + half + 1, y, half - 1, height]);
    let covered = changed(&pictures, [x, y, half - 1, height]);
    let whole = changed(&pictures, [0, 0, SIZE[0], SIZE[1]]);
    let inside = changed(&pictures, [x, y, width, height]);
    let enough = (half * height / 40) as usize;
    assert!(open > enough, "{name}, {of:?}: {open} pixels in the open, not {enough}");
    // A drop may fall between the eye and the screen.
    let allowed = if of == Of::Streaks { open / 10 } else { 2 };
    assert!(
        covered <= allowed,
        "{name}, {of:?}: {covered} of {open} pixels before the screen"
    );
    assert_eq!(whole, inside, "{name}, {of:?}: outside the viewport");
}

const WHOLE: [u32; 4] = [0, 0, SIZE[0], SIZE[1]];

/// A setting of the view, and how the camera gets it and loses it.
struct Row {
    name: &'static str,
    set: fn(&mut EntityWorldMut),
    unset: fn(&mut EntityWorldMut),
    rectangle: [u32; 4],
}

const PART_OF_TARGET: [u32; 4] = [24, 12, 64, 44];

/// A row whose view is the whole target.
fn row(name: &'static str, set: fn(&mut EntityWorldMut), unset: fn(&mut EntityWorldMut)) -> Row {
    Row {
        name,
        set,
        unset,
        rectangle: WHOLE,
    }
}

fn rows() -> Vec<Row> {
    vec![
        row("plain", |_| {}, |_| {}),
        row(
            "4 samples",
            |c| {
                c.insert(Msaa::Sample4);
            },
            |c| {
                c.insert(Msaa::Off);
            },
        ),
        row(
            "high range",
            |c| {
                c.insert(Hdr);
            },
            |c| {
                c.remove::<Hdr>();
            },
        ),
        row(
            "4 samples in high range",
            |c| {
                c.insert((Msaa::Sample4, Hdr));
            },
            |c| {
                c.insert(Msaa::Off).remove::<Hdr>();
            },
        ),
        row(
            "depth prepass",
            |c| {
                c.insert(DepthPrepass);
            },
            |c| {
                c.remove::<DepthPrepass>();
            },
        ),
        row(
            "4 samples with a depth prepass",
            |c| {
                c.insert((Msaa::Sample4, DepthPrepass));
            },
            |c| {
                c.insert(Msaa::Off).remove::<DepthPrepass>();
            },
        ),
        row(
            "transparency sorted by pixel",
            |c| {
                c.insert(OrderIndependentTransparencySettings::default());
            },
            |c| {
                c.remove::<OrderIndependentTransparencySettings>();
            },
        ),
        row(
            "another near plane",
            |c| {
                c.insert(Projection::Perspective(PerspectiveProjection {
                    near: 0.02,
                    ..default()
                }));
            },
            |c| {
                c.insert(Projection::default());
            },
        ),
        Row {
            name: "a part of the target",
            set: |c| set_viewport(c, Some(PART_OF_TARGET)),
            unset: |c| set_viewport(c, None),
            rectangle: PART_OF_TARGET,
        },
        Row {
            name: "a part of the target with a depth prepass in high range",
            set: |c| {
                c.insert((DepthPrepass, Hdr));
                set_viewport(c, Some(PART_OF_TARGET));
            },
            unset: |c| {
                c.remove::<(DepthPrepass, Hdr)>();
                set_viewport(c, None);
            },
            rectangle: PART_OF_TARGET,
        },
    ]
}

pub(crate) fn set_viewport(camera: &mut EntityWorldMut, rectangle: Option<[u32; 4]>) {
    if let Some(mut own) = camera.get_mut::<Camera>() {
        own.viewport = rectangle.map(|[x, y, width, height]| Viewport {
            physical_position: UVec2::new(x, y),
            physical_size: UVec2::new(width, height),
            ..default()
        });
    }
}

#[test]
fn rain_shows_in_the_open_and_not_behind_what_is_opaque_under_every_setting_of_a_view() {
    if !gpu::available() {
        return;
    }
    let (mut test, screen) = scene(false);
    let camera = test.camera;
    for row in rows() {
        (row.set)(&mut test.world().entity_mut(camera));
        for of in [Of::Streaks, Of::Cards, Of::Splashes, Of::Haze] {
            check(&mut test, row.name, of, row.rectangle);
        }
        // Without the screen there is rain in the left half, too: the check above can fail.
        test.world().entity_mut(screen).insert(Visibility::Hidden);
        let pictures = with_and_without(&mut test, Of::Streaks);
        let [x, y, width, height] = row.rectangle;
        let left = changed(&pictures, [x, y, width / 2 - 1, height]);
        assert!(
            left > (width * height / 80) as usize,
            "{}: {left} without the screen",
            row.name
        );
        test.world().entity_mut(screen).insert(Visibility::Inherited);
        (row.unset)(&mut test.world().entity_mut(camera));
    }
    // What the camera does not see hides nothing.
    let layers = [RenderLayers::layer(0), RenderLayers::from_layers(&[0, 1])];
    test.world().entity_mut(screen).insert(RenderLayers::layer(1));
    let [unseen, seen] = layers.map(|own| {
        test.world().entity_mut(camera).insert(own);
        changed(
            &with_and_without(&mut test, Of::Streaks),
            [0, 0, SIZE[0] / 2 - 1, SIZE[1]],
        )
    });
    assert!(
        unseen > 80 && seen * 10 < unseen,
        "{unseen} behind a screen of another layer, {seen} of the same"
    );
}

#[test]
fn deferred_materials_get_wet_are_covered_and_hide_rain_as_forward_ones_do() {
    if !gpu::available() {
        return;
    }
    let (mut test, _) = scene(true);
    for of in [Of::Streaks, Of::Splashes, Of::Haze] {
        check(&mut test, "deferred", of, WHOLE);
    }
    let grounds = [false, true].map(|deferred| {
        let mut test = TestApp::new(SIZE, true);
        let camera = test.camera;
        test.world().resource_mut::<SurfaceSettings>().enabled = false;
        if deferred {
            test.world().insert_resource(DefaultOpaqueRendererMethod::deferred());
            test.world().entity_mut(camera).insert((DepthPrepass, DeferredPrepass));
        }
        world::ground(test.world());
        world::roof(test.world());
        surfaces_only(&mut test, camera);
        let weather = test.world().spawn(Weather::rain(0.0)).id();
        test.look(Vec3::new(0.0, 1.7, 9.0), Vec3::new(0.0, 0.0, 4.9));
        test.frames(3, FRAME);
        let look = |test: &mut TestApp| {
            let picture = test.picture();
            // Under the roof and in the open.
            [12, 44].map(|y| brightness(&part(&picture, 20, y, 56, 12)))
        };
        let dry = look(&mut test);
        rain(&mut test, weather, 50.0, 600);
        let wet = look(&mut test);
        test.world()
            .entity_mut(camera)
            .insert(PlanarReflection { height_m: Some(0.0) });
        test.frames(4, FRAME);
        let mirrors = [
            test.recorded(PassName::Reflection),
            test.skipped(PassName::Reflection, SkipReason::Unsupported),
        ];
        (dry, wet, mirrors.map(|frames| frames > 0))
    });
    for (dry, wet, _) in &grounds {
        assert!(
            (wet[0] - dry[0]).abs() < 3.0,
            "under the roof: {} and {}",
            dry[0],
            wet[0]
        );
        assert!(wet[1] < dry[1] - 10.0, "in the open: {} and {}", dry[1], wet[1]);
    }
    let [(dry, wet, mirrors), (deferred_dry, deferred_wet, deferred_mirrors)] = grounds;
    for (forward, deferred) in [(dry, deferred_dry), (wet, deferred_wet)] {
        // Deferred shading keeps colours in 8 bits.
        let off = [0, 1].map(|i| (forward[i] - deferred[i]).abs());
        assert!(
            off.iter().all(|off| *off < 4.0),
            "{forward:?} forward, {deferred:?} deferred"
        );
    }
    // Deferred materials know no mirror: none is drawn, and the report says so.
    assert_eq!((mirrors, deferred_mirrors), ([true, false], [false, true]));
}

/// A sheet of dark glass, this opaque.
fn glass(test: &mut TestApp, low: Vec3, high: Vec3) -> Entity {
    let material = test
        .world()
        .resource_mut::<Assets<StandardMaterial>>()
        .add(StandardMaterial {
            base_color: Color::linear_rgba(0.0, 0.0, 0.0, 0.9),
            alpha_mode: AlphaMode::Blend,
            unlit: true,
            ..default()
        });
    world::block_of(test.world(), "glass", low, high, material)
}

fn panes(test: &mut TestApp) -> usize {
    let camera = test.camera;
    test.world().get::<ViewPanes>(camera).map_or(0, ViewPanes::count)
}

#[test]
fn glass_tints_the_rain_behind_it_and_not_the_rain_before_it() {
    if !gpu::available() {
        return;
    }
    let (mut test, screen) = scene(false);
    test.world().entity_mut(screen).despawn();
    let camera = test.camera;
    let sorted_by_pixel: fn(&mut EntityWorldMut) = |c| {
        c.insert(OrderIndependentTransparencySettings::default());
    };
    let cases: [(&str, Of, fn(&mut EntityWorldMut)); 6] = [
        ("plain", Of::Streaks, |_| {}),
        ("plain", Of::Cards, |_| {}),
        ("plain", Of::Splashes, |_| {}),
        ("4 samples in high range", Of::Streaks, |c| {
            c.insert((Msaa::Sample4, Hdr));
        }),
        ("sorted by pixel", Of::Streaks, sorted_by_pixel),
        ("sorted by pixel", Of::Splashes, sorted_by_pixel),
    ];
    for (name, of, set) in cases {
        set(&mut test.world().entity_mut(camera));
        let clear = light(&with_and_without(&mut test, of));
        let near = EYE - Vec3::Z * 0.3;
        let pane = glass(
            &mut test,
            near - Vec3::new(2.0, 2.0, 0.005),
            near + Vec3::new(2.0, 2.0, 0.0),
        );
        test.frames(2, std::time::Duration::ZERO);
        assert_eq!(panes(&mut test), 1);
        let behind = light(&with_and_without(&mut test, of));
        // A pane that nobody has told the rain of: all is drawn over it.
        test.world().entity_mut(pane).remove::<SeenThrough>();
        test.frames(2, std::time::Duration::ZERO);
        assert_eq!(panes(&mut test), 0);
        let over = light(&with_and_without(&mut test, of));
        test.world().entity_mut(pane).despawn();
        let far = Vec3::new(0.0, 0.0, -150.0);
        let pane = glass(
            &mut test,
            far - Vec3::new(200.0, 1.0, 0.1),
            far + Vec3::new(200.0, 200.0, 0.0),
        );
        test.frames(2, std::time::Duration::ZERO);
        let before = light(&with_and_without(&mut test, of));
        test.world().entity_mut(pane).despawn();
        let case = format!("{name}, {of:?}: {clear} clear, {behind} behind, {over} over, {before} before");
        assert!(clear > 1.0 && behind < 0.35 * clear, "{case}");
        assert!(over > 0.7 * clear && before > 0.7 * clear, "{case}");
        let mut own = test.world().entity_mut(camera);
        own.insert(Msaa::Off)
            .remove::<(Hdr, OrderIndependentTransparencySettings)>();
    }
}

#[test]
fn rain_falls_before_a_lake_and_what_lies_under_it_is_tinted() {
    if !gpu::available() {
        return;
    }
    let (mut test, screen) = scene(false);
    test.world().entity_mut(screen).despawn();
    let [air, ground] = [Of::Streaks, Of::Splashes].map(|of| light(&with_and_without(&mut test, of)));
    // A sheet of dark water, 20 cm over its bottom and as wide as the ground; its middle lies far behind the nearest rain.
    let lake = glass(&mut test, Vec3::new(-39.0, 0.2, -39.0), Vec3::new(39.0, 0.201, 39.0));
    test.frames(2, std::time::Duration::ZERO);
    let [over, under] = [Of::Streaks, Of::Splashes].map(|of| light(&with_and_without(&mut test, of)));
    assert!(over > 0.7 * air, "{over} of {air}");
    // Splashes are where the cover map has the bottom: glass and water do not cover.
    assert!(ground > 1.0 && under < 0.35 * ground, "{under} of {ground}");
    test.world().entity_mut(lake).insert(Visibility::Hidden);
    test.frames(2, std::time::Duration::ZERO);
    assert_eq!(panes(&mut test), 0);
    // A material that turns opaque hides what it hid, and is no pane.
    test.world().entity_mut(lake).insert(Visibility::Inherited);
    test.frames(2, std::time::Duration::ZERO);
    assert_eq!(panes(&mut test), 1);
    for (_, material) in test.world().resource_mut::<Assets<StandardMaterial>>().iter_mut() {
        material.alpha_mode = AlphaMode::Opaque;
    }
    test.frames(2, std::time::Duration::ZERO);
    assert_eq!(panes(&mut test), 0);
}

#[test]
fn streaks_fade_softly_where_depth_is_read_and_end_hard_where_not() {
    if !gpu::available() {
        return;
    }
    let (mut test, screen) = scene(false);
    test.world().entity_mut(screen).despawn();
    // A wall two metres ahead: all rain is near it.
    let wall = EYE + Vec3::new(0.0, 0.0, -2.0);
    let wall = world::block(
        test.world(),
        "wall",
        wall - Vec3::new(4.0, 1.2, 0.2),
        wall + Vec3::new(4.0, 4.0, 0.0),
        [0.02; 3],
    );
    test.world().entity_mut(wall).insert(KeepDry);
    show(&mut test, Of::Streaks, true);
    test.leap(1);
    let mut seen = |msaa: Msaa, soft_m: f32| {
        let camera = test.camera;
        test.world().entity_mut(camera).insert((msaa, DepthPrepass));
        let pictures = [true, false].map(|enabled| {
            show(&mut test, Of::Streaks, enabled);
            test.world().get_mut::<RainView>(camera).expect("a view").soft_m = soft_m;
            test.frames(2, std::time::Duration::ZERO);
            test.picture()
        });
        light(&pictures)
    };
    let [hard, soft] = [0.0, 2.0].map(|soft_m| seen(Msaa::Off, soft_m));
    let sampled = [0.0, 2.0].map(|soft_m| seen(Msaa::Sample4, soft_m));
    assert!(hard > 1.0 && soft < 0.8 * hard, "{soft} softly, {hard} hard");
    // The depth of several samples is not read.
    assert!((sampled[0] / sampled[1] - 1.0).abs() < 1e-6, "{sampled:?}");
}

#[test]
fn an_orthographic_view_draws_single_drops_and_splashes_and_says_so_for_the_other_passes() {
    if !gpu::available() {
        return;
    }
    let (mut test, _) = scene(false);
    let camera = test.camera;
    test.world().entity_mut(camera).insert((
        Projection::Orthographic(OrthographicProjection {
            scaling_mode: ScalingMode::FixedVertical { viewport_height: 3.0 },
            ..OrthographicProjection::default_3d()
        }),
        LensDrops::default(),
    ));
    for of in [Of::Cards, Of::Haze] {
        test.frames(2, FRAME);
        // A streak or two stand for those that cards begin beyond.
        let pictures = with_and_without(&mut test, of);
        assert_eq!(changed(&pictures, WHOLE), 0, "{of:?}");
    }
    show(&mut test, Of::Cards, true);
    test.world().resource_mut::<SplashSettings>().enabled = true;
    test.world().entity_mut(camera).insert(HazeSettings::default());
    test.frames(1, FRAME);
    test.reset();
    test.frames(3, FRAME);
    for pass in [PassName::Lattice, PassName::Haze, PassName::Lens] {
        assert_eq!(
            (test.recorded(pass), test.skipped(pass, SkipReason::Unsupported)),
            (0, 3),
            "{pass:?}"
        );
    }
    assert_eq!(test.recorded(PassName::Rainfall), 3);
    assert_eq!(test.recorded(PassName::Splash), 3);
    // The same view in perspective draws them.
    test.world().entity_mut(camera).insert(Projection::default());
    test.frames(1, FRAME);
    test.reset();
    test.frames(3, FRAME);
    assert_eq!(test.recorded(PassName::Rainfall), 3);
}

/// What a mask of 32-bit floats holds at a pixel.
fn texel(test: &mut TestApp, mask: &Handle<Image>, [x, y]: [u32; 2]) -> f32 {
    let data = read_texture(test, mask);
    let at = (data.len() as u32 / SIZE[1] * y + 4 * x) as usize;
    f32::from_le_bytes([data[at], data[at + 1], data[at + 2], data[at + 3]])
}

#[test]
fn masks_of_a_part_of_the_target_lie_in_that_part() {
    if !gpu::available() {
        return;
    }
    let (mut test, _) = scene(false);
    let camera = test.camera;
    let images = [MaskKind::Rain, MaskKind::Surface, MaskKind::Surface, MaskKind::Surface].map(|kind| {
        let image = mask_image(kind, SIZE[0], SIZE[1]);
        test.world().resource_mut::<Assets<Image>>().add(image)
    });
    let [rain, wet, depth, water] = images.clone();
    let mut own = test.world().entity_mut(camera);
    own.insert((
        DepthPrepass,
        RainMasks {
            rain,
            wet,
            depth,
            water,
        },
    ));
    set_viewport(&mut own, Some(PART_OF_TARGET));
    test.frames(4, FRAME);
    let [x, y, width, height] = PART_OF_TARGET;
    let depth = &images[2];
    // The screen fills the left half of that part; the ground lies in the right half's lower rim.
    let screen = texel(&mut test, depth, [x + 8, y + height / 2]);
    let ground = texel(&mut test, depth, [x + width - 8, y + height - 2]);
    assert!(
        (0.1..0.3).contains(&screen) && (1.0..5.0).contains(&ground),
        "{screen} {ground}"
    );
    let outside = [
        [x - 4, y + 9],
        [x + 9, y - 4],
        [x + width + 2, y + 9],
        [x + 9, y + height + 2],
    ];
    for pixel in outside {
        assert!(texel(&mut test, depth, pixel) > 1e8, "{pixel:?}");
    }
}
