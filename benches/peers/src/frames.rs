//! Frames measured to the end of their work on the GPU.

use std::time::Duration;

use bevy::prelude::*;
use rain_plugins::scenario::headless;
use rain_quads::clock::{Moment, Summary};
use rain_quads::field::{Field, Shown};

use crate::kind::Kind;
use crate::{hanabi, ours, scene, weather};

/// Frames before those that count: pipelines are made, assets uploaded.
const WARM_UP: u32 = 8;

/// Frames of a turn that do not count: after the others' turns memory is cold.
const FIRST: u32 = 1;

/// A step so short that nothing falls out of the picture.
pub const STEP: Duration = Duration::from_millis(1);

/// What `peer_frames` prints first.
#[derive(Debug, Clone, serde::Serialize)]
pub struct Scene {
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

/// The scene with rain of one kind, ready to be drawn.
pub struct Frames {
    app: App,
    /// What is in it.
    pub scene: Scene,
}

impl Frames {
    /// The scene with `count` visible drops of `kind`.
    ///
    /// # Errors
    /// When the renderer fails or so many drops are not to be had.
    pub fn new(kind: Kind, count: u32) -> Result<Self, String> {
        headless::require_adapter().map_err(|error| error.to_string())?;
        let mut app = scene::app();
        match kind {
            Kind::Rain | Kind::RainNearOnly => ours::add(&mut app, kind == Kind::RainNearOnly),
            Kind::Hanabi => hanabi::add(&mut app),
            Kind::Weather | Kind::WeatherOwn => weather::add(&mut app),
            Kind::None | Kind::NoneLit | Kind::Quads => {}
        }
        let camera = scene::build(&mut app, kind.is_lit());
        // The peers' quads are made as large as these.
        let (device, queue) = scene::device(&app);
        let ours_shown = |count| Field::new(&device, &queue, count).map(|field| field.shown);
        let (shown, drops) = match kind {
            Kind::None | Kind::NoneLit | Kind::Quads => (Shown::default(), 0),
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
        let shown = match kind {
            Kind::Weather | Kind::WeatherOwn => weather::shown(&app),
            _ => shown,
        };
        let adapter = headless::adapter_name(&app);
        Ok(Self {
            app,
            scene: Scene { shown, drops, adapter },
        })
    }

    /// Draws one frame that does not count, and `frames` that do.
    ///
    /// # Errors
    /// When the renderer fails.
    pub fn turn(&mut self, frames: u32) -> Result<Summary, String> {
        step(&mut self.app, FIRST, STEP)?;
        let mut times = Vec::new();
        for _ in 0..frames {
            let from = Moment::now();
            step(&mut self.app, 1, STEP)?;
            times.push(from.passed());
        }
        Ok(Summary::of(&times))
    }
}
