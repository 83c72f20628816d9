//! Haze in a Bevy app: when it is drawn and when it is skipped, and that drops and haze share one optical depth.

use bevy::ecs::system::RunSystemOnce;
use bevy::light::EnvironmentMapLight;
use bevy::prelude::*;
use bevy::render::gpu_readback::{Readback, ReadbackComplete};
use image::RgbImage;
use rain_core::haze::{HazeSharing, extinction_per_m, mist_extinction_per_m};
use rain_core::rainfall::areas::{AreaRain, AreaSettings, AreaShape};
use rain_core::rainfall::{CLASS_COUNT, DrawRange, SizeClass};
use rain_plugins::haze::FarRainViewFrame;
use rain_plugins::prelude::*;
use rain_plugins::rainfall::RainViewFrame;
use rain_plugins::render_adapter::{MaskKind, mask_image};
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

/// Rows of a mask of half floats begin at multiples of 256 bytes: these have no gap.
pub(crate) const SIZE: [u32; 2] = [128, 64];

/// An app with haze in its view.
pub(crate) fn hazy() -> TestApp {
    let mut test = TestApp::new(SIZE, true);
    let camera = test.camera;
    test.world().entity_mut(camera).insert(HazeSettings::default());
    test
}

fn scene(intensity_mm_h: f64) -> TestApp {
    let mut test = hazy();
    world::ground(test.world());
    test.world().spawn(Weather::rain(intensity_mm_h));
    test
}

fn set(test: &mut TestApp, edit: impl FnOnce(&mut HazeSettings)) {
    let camera = test.camera;
    edit(&mut test.world().get_mut::<HazeSettings>(camera).expect("settings"));
    test.frames(2, FRAME);
    test.reset();
    test.frames(4, FRAME);
}

#[derive(Resource, Default)]
struct Read(Option<Vec<u8>>);

fn half(bits: u16) -> f64 {
    let (exponent, mantissa) = (i32::from(bits >> 10 & 31), f64::from(bits & 1023));
    if exponent == 0 {
        mantissa * (-24_f64).exp2()
    } else {
        (1024.0 + mantissa) * f64::from(exponent - 25).exp2()
    }
}

/// What a mask holds, row by row.
pub(crate) fn read(test: &mut TestApp, mask: &Handle<Image>) -> Vec<f64> {
    test.app.insert_resource(Read::default());
    let readback = test
        .world()
        .spawn(Readback::texture(mask.clone()))
        .observe(|done: On<ReadbackComplete>, mut out: ResMut<Read>| out.0 = Some(done.data.clone()))
        .id();
    let mut data = None;
    for _ in 0..50 {
        test.frames(1, std::time::Duration::ZERO);
        data = test.world().resource_mut::<Read>().0.take();
        if data.is_some() {
            break;
        }
    }
    test.world().despawn(readback);
    let data = data.expect("a mask");
    let halves = data.chunks_exact(2).map(|b| half(u16::from_le_bytes([b[0], b[1]])));
    halves.take((SIZE[0] * SIZE[1]) as usize).collect()
}

pub(crate) fn with_mask(test: &mut TestApp) -> Handle<Image> {
    let image = mask_image(MaskKind::Rain, SIZE[0], SIZE[1]);
    let mask = test.world().resource_mut::<Assets<Image>>().add(image);
    let camera = test.camera;
    test.world().entity_mut(camera).insert(HazeMask(mask.clone()));
    mask
}

#[test]
fn haze_is_skipped_with_a_reason_and_recorded_otherwise() {
    if !gpu::available() {
        return;
    }
    let mut test = scene(25.0);
    test.frames(10, FRAME);
    test.reset();
    test.frames(5, FRAME);
    assert_eq!(test.recorded(PassName::Haze), 5);
    set(&mut test, |s| s.enabled = false);
    assert_eq!(test.skipped(PassName::Haze, SkipReason::Disabled), 4);
    assert_eq!(test.recorded(PassName::Haze), 0);
    set(&mut test, |s| s.enabled = true);
    assert_eq!(test.recorded(PassName::Haze), 4);
    // A bad value leaves the last good ones in force.
    set(&mut test, |s| s.limit_m = f32::NAN);
    assert_eq!(test.recorded(PassName::Haze), 4);
    set(&mut test, |s| {
        *s = HazeSettings {
            artist: Some(ArtistFog {
                density_per_m: 0.0,
                ..default()
            }),
            ..default()
        }
    });
    assert_eq!(test.skipped(PassName::Haze, SkipReason::Negligible), 4);
    set(&mut test, |s| s.artist = None);
    let camera = test.camera;
    test.world().entity_mut(camera).insert(Msaa::Sample4);
    test.frames(2, FRAME);
    test.reset();
    test.frames(4, FRAME);
    assert_eq!(test.recorded(PassName::Haze), 4, "with several samples");
    test.world()
        .entity_mut(camera)
        .insert(Projection::from(OrthographicProjection::default_3d()));
    test.frames(2, FRAME);
    test.reset();
    test.frames(4, FRAME);
    assert_eq!(test.skipped(PassName::Haze, SkipReason::Unsupported), 4);
    test.world().entity_mut(camera).remove::<RainView>();
    test.frames(2, FRAME);
    test.reset();
    test.frames(4, FRAME);
    assert_eq!(test.skipped(PassName::Haze, SkipReason::NoView), 4);

    let mut dry = scene(0.0);
    dry.frames(10, FRAME);
    assert_eq!(dry.recorded(PassName::Haze), 0);
    assert_eq!(dry.skipped(PassName::Haze, SkipReason::NoRain), 10);

    let mut room = scene(25.0);
    world::room(room.world());
    room.look(Vec3::new(0.0, 1.5, 1.5), Vec3::new(0.0, 1.5, -3.0));
    room.frames(10, FRAME);
    room.reset();
    room.frames(5, FRAME);
    assert_eq!(room.skipped(PassName::Haze, SkipReason::Indoors), 5);
}

#[test]
fn drawn_drops_and_haze_are_the_whole_rain() {
    if !gpu::available() {
        return;
    }
    for rate in [5.0, 25.0, 100.0] {
        let mut test = scene(rate);
        world::block(
            test.world(),
            "wall",
            Vec3::new(-80.0, -10.0, -61.0),
            Vec3::new(80.0, 80.0, -60.0),
            [0.1; 3],
        );
        let mask = with_mask(&mut test);
        test.look(Vec3::new(0.0, 12.0, 0.0), Vec3::new(0.0, 12.0, -10.0));
        test.frames(90, FRAME);
        let obscured = read(&mut test, &mask);
        // The middle of the picture: the wall, straight ahead.
        let at = (SIZE[1] / 2 * SIZE[0] + SIZE[0] / 2) as usize;
        let haze = -(1.0 - obscured[at]).ln();
        let camera = test.camera;
        let frame = test.world().get::<RainViewFrame>(camera).expect("a view");
        let shutter = frame.shutter.expect("it rains");
        let range = DrawRange {
            kappa: shutter.kappa.into(),
            focal_px: frame.focal_px(),
            exposure_s: shutter.exposure_s.into(),
        };
        let field = test.world().resource::<RainfallField>();
        let spectrum = *field.spectrum();
        // Each class by its middle; that drops take out what the account says is measured on their pictures elsewhere.
        let ranges: [f64; CLASS_COUNT] = core::array::from_fn(|k| {
            let class = SizeClass::new(k);
            range.at(0.5 * (class.min_mm + class.max_mm))
        });
        let sharing = HazeSharing::new(&spectrum, 2.0, ranges, false).expect("an account");
        let total = sharing.total_depth(60.0);
        let drawn = sharing.drawn_depth(60.0);
        assert!(drawn > 0.01 * total, "{rate}: {drawn} of {total}");
        // Half a step of a half float in what is obscured.
        let step = 1.0 / 2048.0;
        assert!(
            (haze + drawn - total).abs() < 0.05 * total + step,
            "{rate}: {haze} + {drawn}, not {total}"
        );
    }
}

#[test]
fn a_far_shower_is_a_curtain_of_its_depth_and_nothing_beside_it() {
    if !gpu::available() {
        return;
    }
    let mut test = hazy();
    test.world().spawn(Weather::rain(0.0));
    test.world().spawn(RainArea(AreaSettings {
        centre_m: bevy::math::DVec2::new(0.0, -3000.0),
        shape: AreaShape::Circle { radius_m: 500.0 },
        rain: AreaRain::Rate(40.0),
        transition_m: 200.0,
        ..default()
    }));
    let mask = with_mask(&mut test);
    // The near border's outer edge, 2400 m away, reaches up to 14° under this base; the picture's top is 22°.
    let camera = test.camera;
    test.world()
        .get_mut::<HazeSettings>(camera)
        .expect("settings")
        .cloud_base_m = 600.0;
    test.look(Vec3::new(0.0, 2.0, 0.0), Vec3::new(0.0, 2.0, -10.0));
    test.frames(5, FRAME);
    test.reset();
    test.frames(3, FRAME);
    assert_eq!(test.recorded(PassName::Haze), 3);
    assert_eq!(test.recorded(PassName::Rainfall), 0, "too far for single drops");
    let obscured = read(&mut test, &mask);
    let at = |x: u32, y: u32| obscured[(y * SIZE[0] + x) as usize];
    let field = test.world().resource::<RainfallField>();
    let across = extinction_per_m(&field.spectrum_at(40.0), 2.0) * 1000.0;
    // A border's ramp has its half on the outline: the way through is the diameter, less what is lost because extinction
    // is not even with the rate (σ ~ R^0.63 lies above the chord): at most 13 % of one transition at each side.
    let middle = -(1.0 - at(SIZE[0] / 2, SIZE[1] / 2)).ln();
    assert!(
        middle > 0.98 * across && middle < 1.08 * across,
        "{middle}, not {across}"
    );
    assert!(
        at(2, SIZE[1] / 2) < 1e-3 && at(SIZE[0] - 3, SIZE[1] / 2) < 1e-3,
        "beside the shower"
    );
    assert!(at(SIZE[0] / 2, 4) < 1e-3, "over its cloud's base");
    // Softly from side to side.
    let row: Vec<f64> = (0..SIZE[0]).map(|x| at(x, SIZE[1] / 2)).collect();
    let jump = row.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0.0, f64::max);
    assert!(jump < 0.5, "{jump}");
    // The query agrees.
    let seen = test
        .world()
        .run_system_once(|rain: RainQueries| rain.seen_through(Vec3::new(0.0, 2.0, 0.0), Vec3::new(0.0, 2.0, -6000.0)));
    let seen = seen.expect("queries");
    assert!((seen - (-middle).exp()).abs() < 0.01, "{seen} {}", (-middle).exp());
}

#[test]
fn the_artists_fog_thickens_with_the_rain_and_loses_its_colour_as_it_sets_in() {
    if !gpu::available() {
        return;
    }
    let fog = ArtistFog {
        density_per_m: 0.004,
        gain: 3.0,
        colour: Some(LinearRgba::rgb(0.2, 0.5, 1.0)),
        desaturation: 1.0,
        transition_s: 2.0,
    };
    let scene = |rate: f64| {
        let mut test = scene(rate);
        world::block(
            test.world(),
            "wall",
            Vec3::new(-80.0, -10.0, -61.0),
            Vec3::new(80.0, 80.0, -60.0),
            [0.0; 3],
        );
        let mask = with_mask(&mut test);
        test.look(Vec3::new(0.0, 12.0, 0.0), Vec3::new(0.0, 12.0, -10.0));
        let camera = test.camera;
        test.world().get_mut::<HazeSettings>(camera).expect("settings").artist = Some(fog);
        test.world().get_mut::<RainView>(camera).expect("a view").streak_budget = Some(1);
        (test, mask)
    };
    // Densities of 2, 5 and 10 mm/h: 0.15, 0.4 and 1 of the gain (table T3 of the source).
    for (rate, amount) in [(2.0, 0.15), (5.0, 0.4), (10.0, 1.0)] {
        let (mut test, mask) = scene(rate);
        test.frames(10, FRAME);
        let obscured = read(&mut test, &mask)[(SIZE[1] / 2 * SIZE[0] + SIZE[0] / 2) as usize];
        let expected = 1.0 - (-0.004_f64 * (1.0 + 3.0 * amount) * 60.0).exp();
        // A step of a half float, and half a pixel of the wall's distance.
        assert!((obscured - expected).abs() < 1e-3, "{rate}: {obscured}, not {expected}");
    }
    let (mut test, _) = scene(10.0);
    test.frames(6, FRAME);
    let spread = |picture: &RgbImage| {
        let [r, _, b] = picture.get_pixel(SIZE[0] / 2, SIZE[1] / 2).0.map(i32::from);
        b - r
    };
    let early = spread(&test.picture());
    test.frames(180, FRAME);
    let late = spread(&test.picture());
    assert!(early > 20 && late * 4 < early, "{early} at first, {late} after");
}

fn brightness(picture: &RgbImage, x: std::ops::Range<u32>, y: std::ops::Range<u32>) -> f64 {
    let mut sum = 0.0;
    let mut count = 0.0;
    for px in x {
        for py in y.clone() {
            sum += picture.get_pixel(px, py).0.iter().map(|v| f64::from(*v)).sum::<f64>();
            count += 3.0;
        }
    }
    sum / count
}

#[test]
fn a_lamp_has_a_halo_in_rain_that_fades_outwards_and_none_behind_a_wall() {
    if !gpu::available() {
        return;
    }
    let picture = |rate: f64, wall: bool| {
        let mut test = hazy();
        test.app.insert_resource(GlobalAmbientLight {
            brightness: 0.0,
            ..default()
        });
        let world = test.world();
        let suns: Vec<Entity> = world
            .query_filtered::<Entity, With<DirectionalLight>>()
            .iter(world)
            .collect();
        for sun in suns {
            world.despawn(sun);
        }
        world.spawn(Weather::rain(rate));
        world.spawn((
            PointLight {
                intensity: 40_000_000.0,
                range: 100.0,
                ..default()
            },
            Transform::from_xyz(0.0, 10.0, -30.0),
        ));
        if wall {
            world::block(
                world,
                "wall",
                Vec3::new(-60.0, -20.0, -21.0),
                Vec3::new(60.0, 60.0, -20.0),
                [0.0; 3],
            );
        }
        test.world().insert_resource(ClearColor(Color::BLACK));
        test.look(Vec3::new(0.0, 10.0, 0.0), Vec3::new(0.0, 10.0, -10.0));
        let camera = test.camera;
        test.world().get_mut::<RainView>(camera).expect("a view").streak_budget = Some(1);
        test.frames(6, FRAME);
        test.picture()
    };
    let rings = |picture: &RgbImage| [60..62, 52..54, 36..38, 8..10].map(|x| brightness(picture, x, 30..34));
    let wet = rings(&picture(50.0, false));
    let dry = rings(&picture(0.0, false));
    let hidden = rings(&picture(50.0, true));
    assert!(dry.iter().all(|v| *v < 1.0), "{dry:?}");
    assert!(wet[0] > 20.0 && wet.windows(2).all(|w| w[0] > w[1]), "{wet:?}");
    assert!(hidden.iter().all(|v| *v < 2.0), "{hidden:?}");
}

#[test]
fn far_rain_is_drawn_where_a_shower_is_in_view_from_outside_and_its_curtain_stays_as_dense() {
    if !gpu::available() {
        return;
    }
    let mut test = hazy();
    world::ground(test.world());
    test.world().spawn(Weather::rain(0.0));
    let area = |z: f64| {
        RainArea(AreaSettings {
            centre_m: bevy::math::DVec2::new(0.0, z),
            shape: AreaShape::Circle { radius_m: 400.0 },
            rain: AreaRain::Rate(25.0),
            transition_m: 60.0,
            ..default()
        })
    };
    let shower = test.world().spawn(area(-900.0)).id();
    let mask = with_mask(&mut test);
    let camera = test.camera;
    test.look(Vec3::new(0.0, 2.0, 0.0), Vec3::new(0.0, 2.0, -10.0));
    let draws = |test: &mut TestApp, far: bool| {
        test.world().get_mut::<RainView>(camera).expect("a view").far_rain = Some(far);
        test.frames(3, FRAME);
        test.reset();
        test.frames(3, FRAME);
        test.recorded(PassName::FarRain)
    };
    // Mean over the middle of the picture above the horizon, and several moments: particles are few.
    let mean = |test: &mut TestApp| {
        let mut sum = 0.0;
        for _ in 0..6 {
            test.frames(40, FRAME);
            let obscured = read(test, &mask);
            sum += (4..30_u32)
                .flat_map(|y| (44..84_u32).map(move |x| (y * SIZE[0] + x) as usize))
                .map(|i| obscured[i] / (6.0 * 26.0 * 40.0))
                .sum::<f64>();
        }
        sum
    };
    assert_eq!(draws(&mut test, false), 0);
    assert_eq!(test.skipped(PassName::FarRain, SkipReason::Disabled), 3);
    let curtain = mean(&mut test);
    assert_eq!(draws(&mut test, true), 3);
    let frame = test.world().get::<FarRainViewFrame>(camera).expect("a view");
    let rain = frame.rain().expect("far rain");
    assert!(
        rain.share > 0.2 && rain.particles.len() > 300,
        "{} {}",
        rain.share,
        rain.particles.len()
    );
    let fit = rain.containers[0];
    assert!(
        (fit.distance_m - 500.0).abs() < 1e-3 && (fit.anchor_m.y + 500.0).abs() < 1e-3,
        "{fit:?}"
    );
    let shafts = mean(&mut test);
    assert!(
        curtain > 0.3 && (shafts / curtain - 1.0).abs() < 0.05,
        "{shafts}, not {curtain}"
    );
    // Behind the eye, about it, and gone: no pass.
    for place in [Some(900.0), Some(0.0), None] {
        match place {
            Some(z) => test.world().entity_mut(shower).insert(area(z)),
            None => test.world().entity_mut(shower).remove::<RainArea>(),
        };
        assert_eq!(draws(&mut test, true), 0, "{place:?}");
        assert_eq!(test.skipped(PassName::FarRain, SkipReason::NoRain), 3, "{place:?}");
    }
    // The artists' fog is not the rain's: nothing is taken off it.
    test.world().entity_mut(shower).insert(area(-900.0));
    assert_eq!(draws(&mut test, true), 3);
    set(&mut test, |s| s.artist = Some(ArtistFog::default()));
    assert_eq!(test.recorded(PassName::FarRain), 0);
    set(&mut test, |s| {
        s.artist = None;
        s.far_rain.budget = 0;
    });
    assert_eq!(test.recorded(PassName::FarRain), 0);
}

#[test]
fn humid_air_is_misty_without_rain() {
    if !gpu::available() {
        return;
    }
    let mut before = 0.0;
    for humidity in [0.8, 0.98, 0.999] {
        let mut test = hazy();
        world::block(
            test.world(),
            "wall",
            Vec3::new(-80.0, -10.0, -201.0),
            Vec3::new(80.0, 80.0, -200.0),
            [0.1; 3],
        );
        test.world().spawn(Weather {
            relative_humidity: humidity,
            ..default()
        });
        let mask = with_mask(&mut test);
        test.look(Vec3::new(0.0, 12.0, 0.0), Vec3::new(0.0, 12.0, -10.0));
        test.frames(4, FRAME);
        assert_eq!(test.recorded(PassName::Haze), 0, "off by default");
        let camera = test.camera;
        let mist = Mist {
            dry_per_m: 2e-4,
            ..default()
        };
        test.world().get_mut::<HazeSettings>(camera).expect("settings").mist = Some(mist);
        test.frames(6, FRAME);
        assert!(test.recorded(PassName::Haze) > 0);
        let obscured = read(&mut test, &mask)[(SIZE[1] / 2 * SIZE[0] + SIZE[0] / 2) as usize];
        let extinction = mist_extinction_per_m(humidity, 2e-4, 0.3);
        let expected = -(-extinction * 200.0).exp_m1();
        assert!(
            (obscured - expected).abs() < 2e-3,
            "{humidity}: {obscured}, not {expected}"
        );
        assert!(obscured > before);
        before = obscured;
    }
    assert!(before > 0.5, "fog: {before}");
}

#[test]
fn an_area_has_a_fog_of_its_own_that_comes_in_over_its_soft_edge() {
    if !gpu::available() {
        return;
    }
    let mut test = hazy();
    world::block(
        test.world(),
        "wall",
        Vec3::new(-200.0, -10.0, -61.0),
        Vec3::new(200.0, 80.0, -60.0),
        [0.0; 3],
    );
    test.world().spawn(Weather::rain(0.0));
    let fog = ArtistFog {
        density_per_m: 0.01,
        colour: Some(LinearRgba::rgb(0.2, 0.5, 1.0)),
        ..default()
    };
    let area = test
        .world()
        .spawn((
            RainArea(AreaSettings {
                centre_m: bevy::math::DVec2::new(100.0, 0.0),
                shape: AreaShape::Circle { radius_m: 50.0 },
                rain: AreaRain::Scale(1.0),
                transition_m: 40.0,
                ..default()
            }),
            AreaFog(fog),
        ))
        .id();
    let mask = with_mask(&mut test);
    let at = |test: &mut TestApp, x: f32| {
        test.look(Vec3::new(x, 12.0, 0.0), Vec3::new(x, 12.0, -10.0));
        test.frames(4, FRAME);
        read(test, &mask)[(SIZE[1] / 2 * SIZE[0] + SIZE[0] / 2) as usize]
    };
    let inside = -(-0.01_f64 * 60.0).exp_m1();
    assert!(at(&mut test, 0.0) < 1e-3, "outside");
    assert!((at(&mut test, 50.0) - 0.5 * inside).abs() < 2e-3, "on the outline");
    assert!((at(&mut test, 100.0) - inside).abs() < 2e-3, "inside");
    let picture = test.picture();
    let [r, _, b] = picture.get_pixel(SIZE[0] / 2, SIZE[1] / 2).0.map(i32::from);
    assert!(b > r + 20, "its colour: {r} {b}");
    // One that is refused does not count.
    test.world().get_mut::<AreaFog>(area).expect("a fog").0.density_per_m = f32::NAN;
    assert!(at(&mut test, 100.0) < 1e-3);
}

#[test]
fn the_open_sky_lights_far_rain_where_it_is_given_and_the_cameras_surroundings_do_otherwise() {
    if !gpu::available() {
        return;
    }
    let mut test = hazy();
    test.world().spawn(Weather::rain(60.0));
    let [red, blue] = [[true, false, false], [false, false, true]].map(|c| world::cube_of(test.world(), c));
    let camera = test.camera;
    test.world().entity_mut(camera).insert(EnvironmentMapLight {
        diffuse_map: red.clone(),
        specular_map: red,
        intensity: 800.0,
        ..default()
    });
    // Nothing but air: what is seen above the horizon is haze.
    test.look(Vec3::new(0.0, 12.0, 0.0), Vec3::new(0.0, 14.0, -10.0));
    test.frames(10, FRAME);
    let seen = |test: &mut TestApp| {
        let picture = test.picture();
        picture.get_pixel(SIZE[0] / 2, SIZE[1] / 2).0.map(i32::from)
    };
    let [r, _, b] = seen(&mut test);
    assert!(r > b + 60, "surroundings alone: {r} red, {b} blue");
    test.world().entity_mut(camera).insert(HazeSky {
        specular_map: blue,
        intensity: 800.0,
    });
    test.frames(6, FRAME);
    let [r, _, b] = seen(&mut test);
    assert!(b > r + 60, "under a sky: {r} red, {b} blue");
}
