//! Our rain.

use std::time::Duration;

use bevy::prelude::*;
use rain_plugins::RainPlugins;
use rain_plugins::prelude::*;
use rain_plugins::rainfall::RainViewFrame;
use rain_quads::field::{self, Shown};
use rain_render::rainfall::{RainfallGpu, RainfallViewGpu};

use crate::frames::{STEP, step};
use crate::scene;

/// Adds the plugins; `alone`: those of streaks.
pub fn add(app: &mut App, alone: bool) {
    if alone {
        app.add_plugins(RainPlugins.build().disable::<WetSurfacePlugin>());
    } else {
        app.add_plugins(RainPlugins);
    }
}

/// Rain with `count` visible streaks; `alone`: nothing but streaks. Returns what is seen and how many drops are drawn.
pub fn rain(app: &mut App, camera: Entity, count: u32, alone: bool) -> Result<(Shown, u32), String> {
    let world = app.world_mut();
    // Nothing here runs in `FixedUpdate`.
    world.insert_resource(Time::<Fixed>::from_seconds(3600.0));
    world.spawn(Weather::rain(field::RATE_MM_H));
    if alone {
        world.resource_mut::<SplashSettings>().enabled = false;
        world.entity_mut(camera).insert(HazeSettings {
            enabled: false,
            ..default()
        });
    }
    let (device, queue) = scene::device(app);
    let gpu = RainfallGpu::new(&device);
    let mut view = RainfallViewGpu::new(&device);
    let mut budget = f64::from(count);
    for _ in 0..8 {
        app.world_mut().entity_mut(camera).insert(RainView {
            streak_budget: Some(budget as u32),
            ..default()
        });
        // After a pause the number of drops is at once what it is to be.
        step(app, 1, Duration::from_secs(2))?;
        step(app, 1, STEP)?;
        let frame = app
            .world()
            .get::<RainViewFrame>(camera)
            .ok_or("the camera has no rain")?;
        // The first updates know no weather or no size of the picture yet.
        let (Some(_), Some(choice)) = (frame.shutter, &frame.choice) else {
            continue;
        };
        let streaks = field::project(&device, &queue, &gpu, &mut view, &field::input(choice, 0.0))?;
        let shown = field::shown(field::quads_of(&streaks));
        let ratio = f64::from(count) / f64::from(shown.visible.max(1));
        if (ratio - 1.0).abs() <= field::TOLERANCE {
            return Ok((shown, streaks.len() as u32));
        }
        budget *= ratio;
    }
    Err(format!("{count} visible streaks are not to be had"))
}
