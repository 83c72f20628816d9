//! A scenario on its way: an app whose clock goes from capture to capture.

use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use bevy::camera::Viewport;
use bevy::prelude::*;
use bevy::render::diagnostic::RenderDiagnosticsPlugin;
use bevy::render::gpu_readback::{Readback, ReadbackComplete};
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use image::RgbImage;
use rain_core::surface::ground::GroundError;
use rain_ecs::prelude::*;

use super::above::Above;
use super::file::{Mask, Rings, Scenario};
use super::masks::{texel_from_coverage, texel_from_depth, texel_from_water};
use super::measured::Measured;
use super::run::RunError;
use super::stage::{self, Stage};
use super::{headless, probe};
use crate::RainPlugins;
use crate::report::{RainReport, Report as PassReport};
use crate::splash::SplashSettings;
use crate::waves::{RingLayerSettings, RingSource, WaveWaterSettings};

/// Time between the frames that warm a view up. Units: ns.
const FRAME_NS: u64 = 16_666_667;

/// Frames a second in the run-up to a capture.
const RUN_UP_FPS: f64 = 30.0;

/// Size of frames that nobody sees, of the shape of pictures of `size`. Units: px.
fn unseen_px(size: [u32; 2]) -> UVec2 {
    let size = UVec2::from_array(size);
    let times = (size.min_element() / 32).clamp(1, 8);
    size / times
}

/// Updates after which a picture must have come back from the GPU.
const PATIENCE_UPDATES: u32 = 50;

/// The times of a frame's passes come back from the GPU in this update after it.
const TIMES_AFTER_UPDATES: u32 = 2;

/// One capture: the picture and the masks asked for.
#[derive(Debug, Clone)]
pub struct Capture {
    /// When. Units: s.
    pub time_s: f64,
    /// The picture.
    pub frame: RgbImage,
    /// 16-bit texels, row by row, of each mask asked for.
    pub masks: Vec<(Mask, Vec<u16>)>,
    /// The rain from above, if it was asked for.
    pub above: Option<RgbImage>,
    /// Wall time of the captured frame, GPU included. Units: ms.
    pub frame_ms: f64,
}

impl Capture {
    /// The texels of a mask, if it was asked for.
    #[must_use]
    pub fn mask(&self, mask: Mask) -> Option<&[u16]> {
        self.masks.iter().find(|(m, _)| *m == mask).map(|(_, t)| t.as_slice())
    }
}

fn ring_source(rings: Rings) -> RingSource {
    match rings {
        Rings::Drops => RingSource::Drops,
        Rings::Layers => RingSource::Layers(RingLayerSettings::default()),
        Rings::Lagarde => RingSource::Layers(RingLayerSettings::lagarde()),
    }
}

/// A running scenario.
pub struct Session {
    app: App,
    scenario: Scenario,
    now_ns: u64,
    measured: Measured,
}

/// Bytes that came back from the GPU, by what they are.
#[derive(Resource, Clone, Default)]
struct Returned(Arc<Mutex<Vec<(usize, Vec<u8>)>>>);

/// The captured picture.
#[derive(Resource, Default)]
struct Pictured(Option<Image>);

fn nanoseconds(time_s: f64) -> u64 {
    (time_s * 1e9).round().max(0.0) as u64
}

impl Session {
    /// Builds the app and loads every file. Relative scene files start at `assets`.
    ///
    /// # Errors
    /// Without a graphics adapter, or when a scene file is missing or broken.
    pub fn new(scenario: &Scenario, assets: &Path) -> Result<Self, RunError> {
        headless::require_adapter()?;
        let mut app = App::new();
        app.add_plugins((headless::plugins(), RenderDiagnosticsPlugin));
        app.insert_resource(RainSeed(scenario.seed));
        app.insert_resource(scenario.rain.look);
        app.init_resource::<Pictured>().init_resource::<Returned>();
        if scenario.rain.enabled {
            app.add_plugins(RainPlugins)
                .insert_resource(WaveWaterSettings {
                    ring_source: ring_source(scenario.rain.rings),
                    ..default()
                })
                .insert_resource(SplashSettings {
                    budget: Some(scenario.rain.splash_budget),
                    ..default()
                });
        }
        headless::finish(&mut app);
        stage::build(&mut app, scenario, assets)?;
        stage::wait_until_loaded(&mut app, |app| headless::step(app, Duration::ZERO))?;
        stage::dress(&mut app, scenario);
        if scenario.rain.enabled {
            super::puddles::place(&mut app, scenario, assets)?;
        }
        super::mips::add_mips(&mut app);
        if scenario.rain.enabled {
            stage::weather(&mut app, scenario)?;
            stage::move_in_ticks(&mut app);
        }
        stage::pose(&mut app, 0.0);
        // One still update: the app's own systems see the dressed scene before time runs.
        headless::step(&mut app, Duration::ZERO)?;
        if let Some(report) = app.world().get_resource::<RainReport>() {
            report.reset();
        }
        Ok(Self {
            app,
            scenario: scenario.clone(),
            now_ns: 0,
            measured: Measured::default(),
        })
    }

    /// The app, for tests that look inside.
    pub fn app(&mut self) -> &mut App {
        &mut self.app
    }

    /// The time reached. Units: s.
    #[must_use]
    pub fn now_s(&self) -> f64 {
        self.now_ns as f64 * 1e-9
    }

    /// One update that ends at `to_ns`.
    fn update_to(&mut self, to_ns: u64) -> Result<(), RunError> {
        stage::pose(&mut self.app, to_ns as f64 * 1e-9);
        let step = to_ns.saturating_sub(self.now_ns);
        self.now_ns = to_ns.max(self.now_ns);
        headless::step(&mut self.app, Duration::from_nanos(step))?;
        match self
            .app
            .world()
            .get_resource::<SurfaceGround>()
            .and_then(SurfaceGround::error)
        {
            // A scene of houses alone is one, too.
            None | Some(GroundError::NoGround) => Ok(()),
            Some(error) => Err(RunError::Ground(error.to_string())),
        }
    }

    fn set_active(&mut self, active: bool) {
        let camera = self.app.world().resource::<Stage>().camera;
        if let Some(mut camera) = self.app.world_mut().get_mut::<Camera>(camera)
            && camera.is_active != active
        {
            camera.is_active = active;
        }
    }

    /// Whether frames are drawn small: those that nobody sees are there for what they leave behind, such as maps and waves.
    fn draw_small(&mut self, small: bool) {
        let camera = self.app.world().resource::<Stage>().camera;
        let viewport = small.then(|| Viewport {
            physical_size: unseen_px(self.scenario.outputs.size),
            ..default()
        });
        if let Some(mut camera) = self.app.world_mut().get_mut::<Camera>(camera) {
            camera.viewport = viewport;
        }
    }

    /// Lets time run to `time_s` without drawing.
    ///
    /// # Errors
    /// When the renderer stops.
    pub fn advance(&mut self, time_s: f64) -> Result<(), RunError> {
        self.set_active(false);
        let to = nanoseconds(time_s);
        if to > self.now_ns { self.update_to(to) } else { Ok(()) }
    }

    /// Lets time run to `time_s` in frames of `fps` per second, drawing every one.
    ///
    /// # Errors
    /// When the renderer stops.
    pub fn play(&mut self, time_s: f64, fps: f64) -> Result<(), RunError> {
        self.set_active(true);
        let (start, end) = (self.now_ns, nanoseconds(time_s));
        let frames = ((end.saturating_sub(start)) as f64 * 1e-9 * fps).round().max(1.0) as u64;
        for i in 1..=frames {
            // Whole nanoseconds without drift: the last frame ends exactly at the end.
            let to = start + (u128::from(end - start) * u128::from(i) / u128::from(frames)) as u64;
            self.update_to(to)?;
        }
        Ok(())
    }

    /// Draws the view for `seconds` up to the frames that a capture at `time_s` itself draws.
    ///
    /// # Errors
    /// When the renderer stops.
    pub fn run_up(&mut self, time_s: f64, seconds: f64) -> Result<(), RunError> {
        let end_s = time_s - f64::from(self.scenario.warm_up_frames.max(1)) * FRAME_NS as f64 * 1e-9;
        let start_s = end_s - seconds;
        if start_s > self.now_s() {
            self.advance(start_s)?;
        }
        if end_s > self.now_s() {
            self.draw_small(true);
            self.play(end_s, RUN_UP_FPS)?;
            self.draw_small(false);
        }
        Ok(())
    }

    /// Goes to `time_s`, warms the view up and takes the picture and the masks of exactly that moment.
    ///
    /// # Errors
    /// When the renderer stops or a picture does not come back.
    pub fn capture(&mut self, time_s: f64) -> Result<Capture, RunError> {
        let at = nanoseconds(time_s);
        // At least one frame of motion before the picture: a camera's velocity needs two poses.
        let warm = u64::from(self.scenario.warm_up_frames.max(1));
        let first = at.saturating_sub(warm * FRAME_NS);
        if first > self.now_ns {
            self.advance(first as f64 * 1e-9)?;
        }
        self.set_active(true);
        self.draw_small(true);
        for i in (1..=warm).rev() {
            if i == 1 {
                // A new map is in use one frame after it has been made.
                self.set_active(false);
                probe::refresh(&mut self.app)?;
                self.set_active(true);
            }
            let to = at.saturating_sub(i * FRAME_NS).max(self.now_ns);
            self.update_to(to)?;
        }
        self.draw_small(false);
        let stage = self.app.world().resource::<Stage>().clone();
        let returned = Returned::default();
        self.app.insert_resource(Pictured::default());
        let world = self.app.world_mut();
        world
            .spawn(Screenshot::image(stage.target.clone()))
            .observe(|done: On<ScreenshotCaptured>, mut out: ResMut<Pictured>| out.0 = Some(done.image.clone()));
        let mut readers = Vec::new();
        if let Some(masks) = &stage.masks {
            for (i, image) in [&masks.rain, &masks.wet, &masks.depth, &masks.water]
                .into_iter()
                .enumerate()
            {
                let sink = returned.clone();
                let reader = world
                    .spawn(Readback::texture(image.clone()))
                    .observe(move |done: On<ReadbackComplete>| {
                        let mut sink = sink.0.lock().unwrap_or_else(PoisonError::into_inner);
                        // A reader reports every frame: the first is the one asked for.
                        if !sink.iter().any(|(k, _)| *k == i) {
                            sink.push((i, done.data.clone()));
                        }
                    })
                    .id();
                readers.push(reader);
            }
        }
        Measured::begin(self.app.world());
        let clock = Instant::now();
        self.update_to(at.max(self.now_ns))?;
        let frame_ms = clock.elapsed().as_secs_f64() * 1e3;
        self.measured.drawn(self.app.world());
        // An inactive view forgets what it drew.
        let above = self.scenario.outputs.above && self.scenario.rain.enabled;
        let above = above.then(|| Above::of(self.app.world(), stage.camera)).flatten();
        self.set_active(false);
        for _ in 0..TIMES_AFTER_UPDATES {
            Measured::forget_times(self.app.world_mut());
            headless::step(&mut self.app, Duration::ZERO)?;
        }
        self.measured.timed(self.app.world());
        for _ in TIMES_AFTER_UPDATES..PATIENCE_UPDATES {
            let complete = returned.0.lock().unwrap_or_else(PoisonError::into_inner).len() == readers.len();
            if complete && self.app.world().resource::<Pictured>().0.is_some() {
                break;
            }
            headless::step(&mut self.app, Duration::ZERO)?;
        }
        for reader in readers {
            self.app.world_mut().despawn(reader);
        }
        let picture = self.app.world_mut().resource_mut::<Pictured>().0.take();
        let lost = || RunError::Renderer("a picture did not come back from the GPU".into());
        let frame = picture
            .and_then(|p| p.try_into_dynamic().ok())
            .ok_or_else(lost)?
            .to_rgb8();
        let bytes = returned.0.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let mut masks = Vec::new();
        if stage.masks.is_some() {
            for mask in &self.scenario.outputs.masks {
                let kind = match mask {
                    Mask::Rain => 0,
                    Mask::Wet => 1,
                    Mask::Depth => 2,
                    Mask::Water => 3,
                };
                let (_, data) = bytes.iter().find(|(k, _)| *k == kind).ok_or_else(lost)?;
                masks.push((*mask, texels(*mask, data, self.scenario.outputs.size)));
            }
        }
        Ok(Capture {
            time_s,
            frame,
            masks,
            above: above.map(|above| above.picture()),
            frame_ms,
        })
    }

    /// Hash of the CPU state.
    pub fn state_hash(&mut self) -> u64 {
        if self.scenario.rain.enabled {
            rain_ecs::state_hash::state_hash(self.app.world())
        } else {
            0
        }
    }

    /// The weather's state, where it rains at all.
    #[must_use]
    pub fn weather(&mut self) -> Option<WeatherState> {
        let world = self.app.world_mut();
        world.query::<&WeatherState>().iter(world).next().cloned()
    }

    /// What the passes did since the start.
    #[must_use]
    pub fn passes(&self) -> PassReport {
        self.app
            .world()
            .get_resource::<RainReport>()
            .map(RainReport::snapshot)
            .unwrap_or_default()
    }

    /// What captured frames took and drew.
    #[must_use]
    pub fn measured(&self) -> &Measured {
        &self.measured
    }

    /// Horizontal bounds of everything in the scene: min x, min z, max x, max z. Units: m.
    pub fn scene_bounds(&mut self) -> Option<[f64; 4]> {
        stage::bounds(self.app.world_mut())
    }
}

/// Rows of a read-back are padded to 256 bytes.
fn texels(mask: Mask, data: &[u8], [width, height]: [u32; 2]) -> Vec<u16> {
    let bytes = if mask == Mask::Rain { 2 } else { 4 };
    let row = width as usize * bytes;
    let padded = row.div_ceil(256) * 256;
    let stride = if data.len() >= padded * height as usize {
        padded
    } else {
        row
    };
    let mut out = Vec::with_capacity((width * height) as usize);
    for y in 0..height as usize {
        for texel in data[y * stride..y * stride + row].chunks_exact(bytes) {
            out.push(match (mask, texel) {
                (Mask::Rain, &[a, b]) => texel_from_coverage(half::f16::from_le_bytes([a, b]).to_f32()),
                (Mask::Wet, &[a, b, c, d]) => texel_from_coverage(f32::from_le_bytes([a, b, c, d])),
                (Mask::Depth, &[a, b, c, d]) => texel_from_depth(f32::from_le_bytes([a, b, c, d])),
                (Mask::Water, &[a, b, c, d]) => texel_from_water(f32::from_le_bytes([a, b, c, d])),
                _ => 0,
            });
        }
    }
    out
}
