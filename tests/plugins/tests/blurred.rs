//! Rain beside temporal anti-aliasing and motion blur: streaks stay as they are exposed.

use std::time::Duration;

use bevy::camera::Hdr;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::post_process::motion_blur::MotionBlur;
use bevy::prelude::*;
use bevy_anti_alias::taa::{TemporalAntiAliasPlugin, TemporalAntiAliasing};
use image::RgbImage;
use rain_plugins::prelude::*;
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

const SIZE: [u32; 2] = [160, 90];

/// A downpour with streaks, cards and splashes, over level ground or before a wall that looks the same however it is blurred.
fn scene(ground: bool) -> TestApp {
    let mut test = TestApp::with(SIZE, true, |app| {
        app.add_plugins(TemporalAntiAliasPlugin)
            .insert_resource(ClearColor(Color::linear_rgb(0.02, 0.02, 0.02)));
    });
    world::without_ground(test.world());
    let camera = test.camera;
    // What is averaged is rounded once, at the end.
    test.world().entity_mut(camera).insert((Tonemapping::None, Hdr));
    let even = StandardMaterial {
        base_color: Color::linear_rgb(0.02, 0.02, 0.02),
        unlit: true,
        ..default()
    };
    let even = test.world().resource_mut::<Assets<StandardMaterial>>().add(even);
    let (low, high) = if ground {
        (Vec3::new(-40.0, -0.5, -40.0), Vec3::new(40.0, 0.0, 40.0))
    } else {
        (Vec3::new(-300.0, -200.0, -31.0), Vec3::new(300.0, 200.0, -30.0))
    };
    let block = world::block_of(test.world(), "background", low, high, even);
    test.world().entity_mut(block).insert(KeepDry);
    // Against the lens.
    let weather = Weather {
        wind_m_s: Vec3::Z * 4.0,
        ..Weather::rain(60.0)
    };
    test.world().spawn(weather);
    test.look(Vec3::new(0.0, 1.2, 8.0), Vec3::new(0.0, 0.9, 6.0));
    show(&mut test, true);
    test.frames(3, FRAME);
    test.leap(2);
    test
}

fn show(test: &mut TestApp, on: bool) {
    let view = RainView {
        enabled: on,
        streak_budget: Some(3_000),
        cards: Some(true),
        contrast: 16.0,
        soft_m: 0.0,
        ..default()
    };
    let camera = test.camera;
    test.world().entity_mut(camera).insert(view);
}

/// What the rain adds to each channel, of a picture that was taken in motion.
struct Added(Vec<i16>);

impl Added {
    fn of(with: &RgbImage, without: &RgbImage) -> Self {
        let pairs = with.as_raw().iter().zip(without.as_raw());
        Self(pairs.map(|(a, b)| i16::from(*a) - i16::from(*b)).collect())
    }

    fn sum(&self) -> f64 {
        self.0.iter().map(|v| f64::from(v.abs())).sum()
    }

    /// The part of what is added that another picture shows elsewhere or not at all.
    fn misplaced(&self, other: &Self) -> f64 {
        let off = |(a, b): (&i16, &i16)| f64::from((a - b).abs());
        0.5 * self.0.iter().zip(&other.0).map(off).sum::<f64>() / other.sum()
    }
}

/// That the rain's light is the same beside an effect as without it, but for these shares: in all, and of it elsewhere.
fn assert_same(beside: &str, plain: &Added, found: &Added, [off, elsewhere]: [f64; 2]) {
    assert!(plain.sum() > 2e5, "{}", plain.sum());
    let (share, misplaced) = (found.sum() / plain.sum(), found.misplaced(plain));
    eprintln!("beside {beside}: {share} of the rain's light, {misplaced} of it elsewhere");
    assert!(
        (share - 1.0).abs() < off,
        "beside {beside}: {share} of the rain's light"
    );
    assert!(
        misplaced < elsewhere,
        "beside {beside}: {misplaced} of the rain's light elsewhere"
    );
}

#[test]
fn temporal_anti_aliasing_takes_nothing_from_moving_rain() {
    if !gpu::available() {
        return;
    }
    let [plain, averaged] = [false, true].map(|averaged| {
        let mut test = scene(true);
        let (camera, target) = (test.camera, test.target.clone());
        if averaged {
            test.world().entity_mut(camera).insert(TemporalAntiAliasing::default());
        }
        test.frames(12, FRAME);
        let with = test.picture_after(&target, FRAME);
        show(&mut test, false);
        test.world().resource_mut::<SplashSettings>().enabled = false;
        test.frames(16, Duration::ZERO);
        Added::of(&with, &test.picture())
    });
    assert_same("temporal anti-aliasing", &plain, &averaged, [0.03, 0.03]);
}

#[test]
fn motion_blur_does_not_smear_streaks_that_are_exposed_already() {
    if !gpu::available() {
        return;
    }
    let [plain, blurred] = [false, true].map(|blurred| {
        let mut test = scene(false);
        let (camera, target) = (test.camera, test.target.clone());
        if blurred {
            test.world().entity_mut(camera).insert(MotionBlur {
                shutter_angle: 1.0,
                samples: 8,
            });
        }
        let turn = |test: &mut TestApp, frame: u8| {
            let angle = 2.0 * FRAME.as_secs_f32() * f32::from(frame);
            let (sin, cos) = angle.sin_cos();
            let eye = Vec3::new(0.0, 1.2, 8.0);
            test.look(eye, eye + Vec3::new(sin, -0.1, -cos));
        };
        for frame in 0..6 {
            turn(&mut test, frame);
            test.frames(1, FRAME);
        }
        turn(&mut test, 6);
        let with = test.picture_after(&target, FRAME);
        show(&mut test, false);
        test.frames(4, Duration::ZERO);
        Added::of(&with, &test.picture())
    });
    assert_same("motion blur", &plain, &blurred, [0.01, 0.01]);
}

#[test]
fn each_pass_is_recorded_once_a_frame_before_blur_or_after_it() {
    if !gpu::available() {
        return;
    }
    let mut test = scene(true);
    let camera = test.camera;
    test.world().entity_mut(camera).insert(LensDrops::default());
    test.leap(4);
    let blur = || MotionBlur {
        shutter_angle: 1.0,
        samples: 2,
    };
    let settings: [(&str, &dyn Fn(&mut EntityWorldMut)); 4] = [
        ("neither", &|_| {}),
        ("temporal anti-aliasing", &|c| {
            c.insert(TemporalAntiAliasing::default());
        }),
        ("both", &|c| {
            c.insert(blur());
        }),
        ("motion blur with 4 samples", &|c| {
            c.remove::<TemporalAntiAliasing>().insert((blur(), Msaa::Sample4));
        }),
    ];
    for (name, set) in settings {
        set(&mut test.world().entity_mut(camera));
        test.frames(3, FRAME);
        test.reset();
        test.frames(4, FRAME);
        for pass in [PassName::Rainfall, PassName::Lattice, PassName::Splash, PassName::Lens] {
            assert_eq!(test.recorded(pass), 4, "{name}: {}", pass.as_str());
        }
    }
}
