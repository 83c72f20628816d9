//! A lost graphics device is rebuilt and rain goes on.

use std::time::Duration;

use bevy::prelude::*;
use bevy::render::error_handler::{RenderErrorHandler, RenderErrorPolicy};
use bevy::render::renderer::RenderDevice;
use rain_plugins::prelude::*;
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

use crate::scenes::{difference, hollow_at, rain};

/// Destroys the device and waits until Bevy has another.
fn lose_device(test: &mut TestApp) {
    test.app
        .insert_resource(RenderErrorHandler(|_, _, _| RenderErrorPolicy::Recover(default())));
    let lost = test.app.world().resource::<RenderDevice>().clone();
    // Two devices may have the same identity, since each instance counts its own: ask when the resource was replaced.
    let replaced = |test: &TestApp| {
        test.app
            .world()
            .get_resource_change_ticks::<RenderDevice>()
            .map(|t| t.changed)
    };
    let first = replaced(test);
    lost.wgpu_device().destroy();
    // The callback that reports the loss fires from a poll.
    let _ = lost.wgpu_device().poll(wgpu::PollType::Poll);
    let mut rebuilt = false;
    for _ in 0..400 {
        test.app.update();
        std::thread::sleep(Duration::from_millis(5));
        rebuilt = replaced(test) != first;
        if rebuilt {
            break;
        }
    }
    assert!(rebuilt, "no new device");
}

#[test]
fn passes_are_recorded_again_after_the_device_was_lost() {
    if !gpu::available() {
        return;
    }
    let mut test = TestApp::new([96, 54], true);
    world::ground(test.world());
    world::roof(test.world());
    test.world().spawn(Weather::rain(50.0));
    test.look(Vec3::new(0.0, 1.7, 12.0), Vec3::new(0.0, 1.5, 0.0));
    test.frames(20, FRAME);
    assert!(test.recorded(PassName::Rainfall) > 10 && test.recorded(PassName::Cover) > 0);
    let before = test.picture();

    test.reset();
    lose_device(&mut test);
    test.frames(10, FRAME);
    assert!(
        test.recorded(PassName::Rainfall) >= 10,
        "{}",
        test.recorded(PassName::Rainfall)
    );
    // The kept cover map went with the device: without a new one rain would fall through the roof.
    assert!(test.recorded(PassName::Cover) > 0, "the cover map was not drawn again");
    // What is drawn is a picture again, with the scene in it; the camera has not moved.
    let after = test.picture();
    let differing = before
        .pixels()
        .zip(after.pixels())
        .filter(|(a, b)| a.0.iter().zip(b.0).any(|(x, y)| x.abs_diff(y) > 40));
    let (differing, all) = (differing.count(), before.pixels().len());
    assert!(
        differing * 5 < all,
        "{differing} of {all} pixels are others than before the loss"
    );
}

#[test]
fn puddles_films_and_mirrors_are_uploaded_again_after_the_device_was_lost() {
    if !gpu::available() {
        return;
    }
    let (mut test, weather) = hollow_at(Vec3::ZERO);
    let camera = test.camera;
    test.world().entity_mut(camera).insert(PlanarReflection::default());
    let dry = test.picture();
    rain(&mut test, weather, 60.0, 1200);
    // Nothing falls and nothing dries while the device is gone: the same picture is wanted.
    let before = test.picture();
    let changed = difference(&dry, &before);
    assert!(changed.mean > 5.0, "{changed:?}");
    lose_device(&mut test);
    test.frames(6, Duration::ZERO);
    test.reset();
    let after = test.picture();
    assert!(test.recorded(PassName::Reflection) > 0, "the mirror is drawn again");
    let found = difference(&before, &after);
    assert!(found.mean < 0.05 * changed.mean, "{found:?}, rain {changed:?}");
}

#[test]
fn on_a_software_device_parameters_are_in_storage() {
    use rain_render::params_space::{ParamsSpace, STORAGE_BUFFERS};
    if !gpu::available() {
        return;
    }
    let test = TestApp::new([16, 9], true);
    let device = test.app.world().resource::<RenderDevice>().wgpu_device();
    let software = device.adapter_info().device_type == wgpu::DeviceType::Cpu;
    assert!(!software || device.limits().max_storage_buffers_per_shader_stage >= STORAGE_BUFFERS);
    let expected = if software {
        ParamsSpace::Storage
    } else {
        ParamsSpace::Uniform
    };
    assert_eq!(ParamsSpace::of(device), expected);
}
