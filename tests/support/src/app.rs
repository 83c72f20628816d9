//! A headless Bevy app with the rain plugins, as a game would put it together.

use std::time::Duration;

use bevy::camera::RenderTarget;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::prelude::*;
use bevy::render::render_resource::{TextureFormat, TextureUsages};
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use image::RgbImage;
use rain_plugins::RainPlugins;
use rain_plugins::prelude::*;
use rain_plugins::scenario::headless;

/// One frame at 60 Hz.
pub const FRAME: Duration = Duration::from_nanos(16_666_667);

/// Updates after which a picture must have come back from the GPU.
const PATIENCE: u32 = 50;

/// The app with one camera that draws into an image.
pub struct TestApp {
    /// The app.
    pub app: App,
    /// Its camera, at (0, 1.7, 8), looking along −Z.
    pub camera: Entity,
    /// What the camera draws into.
    pub target: Handle<Image>,
}

#[derive(Resource, Default)]
struct Pictured(Option<Image>);

/// An image that a camera can draw into and that can be read back.
pub fn target_image(app: &mut App, size: [u32; 2]) -> Handle<Image> {
    let mut target = Image::new_target_texture(size[0], size[1], TextureFormat::Rgba8UnormSrgb, None);
    target.texture_descriptor.usage |= TextureUsages::COPY_SRC;
    app.world_mut().resource_mut::<Assets<Image>>().add(target)
}

impl TestApp {
    /// An app with the rain plugins (`rain`) or without, a camera (marked by [`RainView`] with `rain`), a light, and no
    /// weather yet.
    #[must_use]
    pub fn new(size: [u32; 2], rain: bool) -> Self {
        Self::with(size, rain, |_| {})
    }

    /// As [`new`](Self::new), with plugins of the host's own.
    #[must_use]
    pub fn with(size: [u32; 2], rain: bool, add: impl FnOnce(&mut App)) -> Self {
        let mut app = App::new();
        app.add_plugins(headless::plugins());
        add(&mut app);
        if rain {
            app.add_plugins(RainPlugins);
            // Half of the default's side: these scenes are small, and each step works on every texel.
            let mut ground_map = GroundMapSettings::default();
            ground_map.map.texels = 256;
            app.insert_resource(ground_map);
        }
        headless::finish(&mut app);
        app.init_resource::<Pictured>();
        // Nothing here runs in `FixedUpdate`; at its default step a leap of an hour is 230 000 empty runs.
        app.insert_resource(Time::<Fixed>::from_seconds(3600.0));
        app.insert_resource(GlobalAmbientLight {
            brightness: 400.0,
            ..default()
        });
        let target = target_image(&mut app, size);
        app.world_mut().spawn((
            DirectionalLight {
                illuminance: 8_000.0,
                ..default()
            },
            Transform::default().looking_to(Vec3::new(0.3, -1.0, -0.4), Vec3::Y),
        ));
        let camera = spawn_camera(&mut app, &target, rain);
        Self { app, camera, target }
    }

    /// The world.
    pub fn world(&mut self) -> &mut World {
        self.app.world_mut()
    }

    /// `frames` updates of `each`.
    ///
    /// # Panics
    /// When the renderer stops.
    pub fn frames(&mut self, frames: u32, each: Duration) {
        for _ in 0..frames {
            headless::step(&mut self.app, each).expect("the renderer goes on");
        }
    }

    /// Lets `seconds` pass in one leap, then draws three frames so that everything has settled.
    pub fn leap(&mut self, seconds: u64) {
        self.frames(1, Duration::from_secs(seconds));
        self.frames(3, FRAME);
    }

    /// What `target` shows now; no time passes.
    ///
    /// # Panics
    /// When the picture does not come back.
    pub fn picture_of(&mut self, target: &Handle<Image>) -> RgbImage {
        self.picture_after(target, Duration::ZERO)
    }

    /// What `target` shows in one more frame that is this long.
    ///
    /// # Panics
    /// When the picture does not come back.
    pub fn picture_after(&mut self, target: &Handle<Image>, frame: Duration) -> RgbImage {
        self.app.insert_resource(Pictured::default());
        self.world()
            .spawn(Screenshot::image(target.clone()))
            .observe(|done: On<ScreenshotCaptured>, mut out: ResMut<Pictured>| out.0 = Some(done.image.clone()));
        for tries in 0..PATIENCE {
            self.frames(1, if tries == 0 { frame } else { Duration::ZERO });
            if let Some(image) = self.world().resource_mut::<Pictured>().0.take() {
                return image.try_into_dynamic().expect("an 8-bit picture").to_rgb8();
            }
        }
        panic!("no picture came back");
    }

    /// What the camera shows now; no time passes.
    pub fn picture(&mut self) -> RgbImage {
        let target = self.target.clone();
        self.picture_of(&target)
    }

    /// Moves the camera.
    pub fn look(&mut self, eye: Vec3, target: Vec3) {
        let camera = self.camera;
        let up = if (target - eye).normalize_or_zero().y.abs() > 0.99 {
            Vec3::NEG_Z
        } else {
            Vec3::Y
        };
        self.world()
            .entity_mut(camera)
            .insert(Transform::from_translation(eye).looking_at(target, up));
    }

    /// What the passes did since the last [`reset`](Self::reset).
    #[must_use]
    pub fn recorded(&self, pass: PassName) -> u64 {
        self.app.world().resource::<RainReport>().recorded_frames(pass)
    }

    /// Frames in which `pass` was skipped for this reason.
    #[must_use]
    pub fn skipped(&self, pass: PassName, reason: SkipReason) -> u64 {
        let report = self.app.world().resource::<RainReport>().snapshot();
        let record = report.passes.get(&pass);
        record.and_then(|r| r.skipped.get(&reason)).copied().unwrap_or(0)
    }

    /// Sets the pass counters to zero.
    pub fn reset(&self) {
        self.app.world().resource::<RainReport>().reset();
    }
}

/// A camera of the test apps: no multisampling, at (0, 1.7, 8), looking along −Z.
pub fn spawn_camera(app: &mut App, target: &Handle<Image>, rain: bool) -> Entity {
    let mut camera = app.world_mut().spawn((
        Camera3d::default(),
        RenderTarget::from(target.clone()),
        Msaa::Off,
        // Bevy's default needs look-up tables that the workspace's feature set leaves out.
        Tonemapping::AcesFitted,
        Transform::from_xyz(0.0, 1.7, 8.0),
    ));
    if rain {
        // Surfaces and streaks are measured in clear air; what looks at haze turns it on.
        let clear = HazeSettings {
            enabled: false,
            ..default()
        };
        let view = RainView {
            streak_budget: Some(20_000),
            contrast: 16.0,
            ..default()
        };
        camera.insert((view, clear));
    }
    camera.id()
}
