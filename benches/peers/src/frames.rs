//! Frames measured to the end of their work on the GPU.

use std::time::Duration;

use bevy::prelude::*;
use rain_plugins::scenario::headless;
use rain_quads::clock::{Moment, Summary};
use rain_quads::field::{Field, Shown};

use crate::kind::Kind;
use crate::{hanabi, ours, scene, weather};

/// Frames before those that count: pipelines are made, assets uploaded.
const WARM_UP: u32 = 4;

/// Frames that count.
const FRAMES: u32 = 12;

/// A step so short that nothing falls out of the picture.
pub const STEP: Duration = Duration::from_millis(1);

/// What `peer_frames` prints.
#[derive(Debug, Clone, serde::Serialize)]
pub struct Measured {
    /// A frame.
    pub frame: Summary,
    /// What is seen of the rain.
    pub shown: Shown,
    /// Drops that are drawn or simulated, seen or not.
    pub drops: u32,
    /// The adapter.
    pub adapter: String,
}

/// `frames` updates.
pub fn step(app: &mut App, frames: u32, each: Duration) -> Result<(), String> {
    for _ in 0..frames {
        headless::step(app, each).map_err(|error| error.to_string())?;
    }
    Ok(())
}

/// Frames of the scene with `count` visible drops of `kind`.
///
/// # Errors
/// When the renderer fails or so many drops are not to be had.
pub fn measured(kind: Kind, count: u32) -> Result<Measured, String> {
    headless::require_adapter().map_err(|error| error.to_string())?;
    let mut app = scene::app();
    match kind {
        Kind::Rain | Kind::RainNearOnly => ours::add(&mut app, kind == Kind::RainNearOnly),
        Kind::Hanabi => hanabi::add(&mut app),
        Kind::Weather | Kind::WeatherOwn => weather::add(&mut app),
        Kind::None | Kind::Quads => {}
    }
    let camera = scene::build(&mut app);
    // The peers' quads are made as large as these.
    let (device, queue) = scene::device(&app);
    let ours_shown = |count| Field::new(&device, &queue, count).map(|field| field.shown);
    let (shown, drops) = match kind {
        Kind::None | Kind::Quads => (Shown::default(), 0),
        Kind::Rain | Kind::RainNearOnly => ours::rain(&mut app, camera, count, kind == Kind::RainNearOnly)?,
        Kind::Hanabi => {
            let shown = ours_shown(count)?;
            hanabi::rain(&mut app, count, shown);
            (
                Shown {
                    visible: count,
                    ..shown
                },
                count,
            )
        }
        Kind::Weather | Kind::WeatherOwn => {
            let like = if kind == Kind::Weather {
                Some(ours_shown(count)?)
            } else {
                None
            };
            weather::rain(&mut app, count, like)?
        }
    };
    step(&mut app, WARM_UP, STEP)?;
    let mut times = Vec::new();
    for _ in 0..FRAMES {
        let from = Moment::now();
        step(&mut app, 1, STEP)?;
        times.push(from.passed());
    }
    let shown = match kind {
        Kind::Weather | Kind::WeatherOwn => weather::shown(&app),
        _ => shown,
    };
    Ok(Measured {
        frame: Summary::of(&times),
        shown,
        drops,
        adapter: headless::adapter_name(&app),
    })
}
