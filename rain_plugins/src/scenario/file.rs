//! The scenario file: what RON text may say, with units, domains and defaults.
//!
//! Every struct refuses unknown fields and fills missing ones with the stated default. Optional values are written
//! without `Some(…)`, and a variant that holds a struct is written without the inner pair of parentheses:
//!
//! ```ron
//! (
//!     name: "storm",
//!     duration_s: 600,
//!     scene: "street.glb",
//!     environment: (sky: Overcast(zenith_luminance_cd_m2: 3000, skyline_deg: 12)),
//!     weather: (keys: [(time_s: 0, intensity_mm_h: 0), (time_s: 60, intensity_mm_h: 25)]),
//!     camera: (keys: [(time_s: 0, eye: (0, 1.7, 8), target: (0, 1.5, 0))]),
//!     captures: Even(start_s: 60, end_s: 600, count: 12),
//!     outputs: (masks: [Rain, Wet, Depth]),
//!     expectations: [(text: "it rains", check: Mask(mask: Rain, statistic: Mean), at: Last, min: 0.001)],
//! )
//! ```
//!
//! World coordinates are metres, Y up. Times are seconds from the scenario's start.

use std::path::PathBuf;

use rain_core::lens::WiperMode;
use serde::{Deserialize, Deserializer, Serialize, de};

use super::areas::RainAreas;
pub use super::captures::{Captures, RunUp};
use super::expectation::Expectation;
use super::puddles::{DepthMap, Puddles};
use super::spouts::RoofSpout;
use super::weather::Weather;
use crate::surface::{WaterAppearance, WetLook};

/// A point or vector: x, y (up), z. Units: metres, or m/s for velocities.
pub type Vector = [f64; 3];

/// A colour as linear Rec. 709 red, green, blue. Units: none.
pub type Tint = [f64; 3];

/// One scenario. Load it with [`Scenario::load`](Scenario::load), which also validates it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Scenario {
    /// Name for reports and titles. Default: empty, which loading replaces by the file's stem.
    pub name: String,
    /// Seed of every random choice. Domain: any. Default: 1.
    pub seed: u64,
    /// Length of the run. Units: s. Domain: (0, 2 592 000] (30 days). Default: 600.
    pub duration_s: f64,
    /// What stands in the world: a single file name, or a list of parts. Domain: at most 4096 parts. Default: none.
    #[serde(deserialize_with = "file_or_parts")]
    pub scene: Vec<ScenePart>,
    /// Grates that take water off the ground. Domain: at most 4096. Default: none.
    pub drains: Vec<DrainGrate>,
    /// Edges and pipes that roofs pour from. Domain: at most 4096. Default: none.
    pub spouts: Vec<RoofSpout>,
    /// Sky, sun, lamps, fog and exposure.
    pub environment: Environment,
    /// Rain, wind and air over time.
    pub weather: Weather,
    /// Where it rains otherwise than everywhere.
    pub areas: RainAreas,
    /// What drives through the scene. Domain: at most 256. Default: none.
    pub vehicles: Vec<Vehicle>,
    /// Where the camera is and what it looks at.
    pub camera: Camera,
    /// How rain is drawn.
    pub rain: RainSettings,
    /// How standing water looks and moves.
    pub water: WaterSettings,
    /// When pictures are taken. Default: none.
    pub captures: Captures,
    /// Captures before which the view is drawn for a while. Domain: each capture at most once. Default: none.
    pub run_ups: Vec<RunUp>,
    /// What is written.
    pub outputs: Outputs,
    /// Horizontal bounds of the water ledger. Default: those of the scene.
    pub domain: Option<Domain>,
    /// Frames rendered before each capture, so that pipelines, shadows and maps have settled. Domain: 0…1000.
    /// Default: 3.
    pub warm_up_frames: u32,
    /// What must hold, or `rain run` exits with 1. Domain: at most 10 000. Default: none.
    pub expectations: Vec<Expectation>,
    /// Folder of the scenario file: where relative file names start. Not part of the file.
    #[serde(skip)]
    pub folder: PathBuf,
}

impl Default for Scenario {
    fn default() -> Self {
        Self {
            name: String::new(),
            seed: 1,
            duration_s: 600.0,
            scene: Vec::new(),
            drains: Vec::new(),
            spouts: Vec::new(),
            environment: Environment::default(),
            weather: Weather::default(),
            areas: RainAreas::default(),
            vehicles: Vec::new(),
            camera: Camera::default(),
            rain: RainSettings::default(),
            water: WaterSettings::default(),
            captures: Captures::default(),
            run_ups: Vec::new(),
            outputs: Outputs::default(),
            domain: None,
            warm_up_frames: 3,
            expectations: Vec::new(),
            folder: PathBuf::new(),
        }
    }
}

/// A glTF file at a place in the world.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ScenePart {
    /// glTF or GLB file, relative to the scenario (or to `--assets`). Required.
    pub file: String,
    /// Name of the part. Default: empty (the file's stem).
    pub name: String,
    /// Where its origin goes. Units: m. Domain: each within ±1 000 000. Default: (0, 0, 0).
    pub translation: Vector,
    /// Turn about the vertical, from +Z towards +X. Units: degrees. Domain: ±36 000. Default: 0.
    pub yaw_deg: f64,
    /// Uniform scale. Units: none. Domain: [0.0001, 10 000]. Default: 1.
    pub scale: f64,
    /// Puddles placed on its meshes: by vertex colours only on those that have any. Default: none.
    pub puddles: Option<Puddles>,
    /// Depth map given to its materials. Default: none.
    pub depth_map: Option<DepthMap>,
}

impl Default for ScenePart {
    fn default() -> Self {
        Self {
            file: String::new(),
            name: String::new(),
            translation: [0.0; 3],
            yaw_deg: 0.0,
            scale: 1.0,
            puddles: None,
            depth_map: None,
        }
    }
}

impl ScenePart {
    /// The file at the origin, unturned, at its own scale.
    #[must_use]
    pub fn from_file(file: impl Into<String>) -> Self {
        Self {
            file: file.into(),
            ..Self::default()
        }
    }
}

fn file_or_parts<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<ScenePart>, D::Error> {
    struct FileOrParts;
    impl<'de> de::Visitor<'de> for FileOrParts {
        type Value = Vec<ScenePart>;
        fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
            f.write_str("a file name in quotes or a list of parts [(file: …), …]")
        }
        fn visit_str<E: de::Error>(self, file: &str) -> Result<Self::Value, E> {
            Ok(vec![ScenePart::from_file(file)])
        }
        fn visit_seq<A: de::SeqAccess<'de>>(self, mut parts: A) -> Result<Self::Value, A::Error> {
            let mut all = Vec::new();
            while let Some(part) = parts.next_element()? {
                all.push(part);
            }
            Ok(all)
        }
    }
    deserializer.deserialize_any(FileOrParts)
}

/// A grate in the ground, against a kerb: a weir along its edge, and an orifice once it is under water.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DrainGrate {
    /// Where: x and z. Units: m. Domain: each within ±1 000 000. Required.
    pub position: [f64; 2],
    /// Length of its edge that water reaches. Units: m. Domain: [0, 1000]. Default: 1.1, of 0.3 by 0.5 m at a kerb.
    #[serde(default = "grate_edge")]
    pub perimeter_m: f64,
    /// Area of its openings. Units: m². Domain: [0, 1000]. Default: 0.06.
    #[serde(default = "grate_openings")]
    pub area_m2: f64,
}

fn grate_edge() -> f64 {
    1.1
}

fn grate_openings() -> f64 {
    0.06
}

/// Light and air that are not rain.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Environment {
    /// The generated sky. Default: overcast.
    pub sky: Sky,
    /// Camera exposure for ISO 100. Units: EV. Domain: [-10, 25]. Default: 12 (overcast day).
    pub exposure_ev100: f64,
    /// The sun, where it shines through. Default: none, as befits rain.
    pub sun: Option<Sun>,
    /// Factor on the punctual lights that glTF files carry. Units: none. Domain: [0, 1000]. Default: 1.
    pub lamps: f64,
    /// Distance at which contrast falls to 2 % in fog alone, without rain. Units: m. Domain: [1, 1 000 000].
    /// Default: no fog.
    pub fog_visibility_m: Option<f64>,
    /// Whether bright lights bleed in the camera. Default: true.
    pub bloom: bool,
    /// Whether wet surfaces mirror the scene itself, drawn from the eye before each capture; else the sky alone.
    /// Default: true.
    pub probe: bool,
    /// Whether wet level ground mirrors the scene in a second view. Default: true.
    pub reflection: bool,
}

impl Default for Environment {
    fn default() -> Self {
        Self {
            sky: Sky::default(),
            exposure_ev100: 12.0,
            sun: None,
            lamps: 1.0,
            fog_visibility_m: None,
            bloom: true,
            probe: true,
            reflection: true,
        }
    }
}

/// The kind of sky.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Sky {
    /// Closed cloud, brighter towards the zenith.
    Overcast(OvercastSky),
}

impl Default for Sky {
    fn default() -> Self {
        Self::Overcast(OvercastSky::default())
    }
}

/// CIE overcast sky (Moon & Spencer 1942): L(e) = L_z (1 + 2 sin e)/3 at elevation e.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct OvercastSky {
    /// Luminance at the zenith. Units: cd/m². Domain: [0, 100 000]. Default: 3000 (7330 lx on open ground).
    pub zenith_luminance_cd_m2: f64,
    /// Colour of the cloud; only its ratios count, the luminance is the one above. Units: linear RGB. Domain: each
    /// [0, 10], not all 0. Default: (0.93, 0.98, 1.08), slightly blue-grey.
    pub tint: Tint,
    /// Luminance at the zenith divided by that at the horizon. Units: none. Domain: [0.1, 100]. Default: 3 (CIE);
    /// 1 is a uniform sky.
    pub zenith_to_horizon: f64,
    /// Relative amplitude of brighter and darker clouds, from the scenario's seed. Units: none. Domain: [0, 0.5].
    /// Default: 0.04. Chosen by eye: at 0 puddles look like flat grey paint, above 0.15 the sky looks broken.
    pub cloud_contrast: f64,
    /// Height of the tallest house fronts that stand around the horizon of the *reflection* environment, so that wet
    /// ground has something to mirror at grazing angles. Units: degrees. Domain: [0, 60]. Default: 0 (none).
    pub skyline_deg: f64,
    /// Reflectance of those fronts. Units: linear RGB. Domain: each [0, 1]. Default: (0.24, 0.22, 0.20).
    pub skyline_tint: Tint,
    /// Reflectance of the ground below the horizon, lit by this sky. Units: linear RGB. Domain: each [0, 1]. Default:
    /// (0.10, 0.10, 0.10), wet road and grass.
    pub ground_tint: Tint,
}

impl Default for OvercastSky {
    fn default() -> Self {
        Self {
            zenith_luminance_cd_m2: 3000.0,
            tint: [0.93, 0.98, 1.08],
            zenith_to_horizon: 3.0,
            cloud_contrast: 0.04,
            skyline_deg: 0.0,
            skyline_tint: [0.24, 0.22, 0.20],
            ground_tint: [0.10, 0.10, 0.10],
        }
    }
}

/// A directional light.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Sun {
    /// Where the light goes (from the sun to the ground); its length does not count. Domain: not zero. Default:
    /// (0.4, -1, 0.3).
    pub direction: Vector,
    /// Illuminance on a plane across the light. Units: lx. Domain: [0, 200 000]. Default: 10 000.
    pub illuminance_lux: f64,
}

impl Default for Sun {
    fn default() -> Self {
        Self {
            direction: [0.4, -1.0, 0.3],
            illuminance_lux: 10_000.0,
        }
    }
}

/// How the way between two keys is walked.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Interpolation {
    /// Straight pieces at constant velocity. The default.
    #[default]
    Linear,
    /// A cubic through the keys with continuous velocity (Catmull & Rom 1974, tangents for uneven times).
    CatmullRom,
}

/// Something on wheels that follows a path. Its model faces +Z; the path turns it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Vehicle {
    /// Name that the camera and reports use. Domain: not empty, unique. Required.
    pub name: String,
    /// glTF or GLB file, relative to the scenario (or to `--assets`). Required.
    pub file: String,
    /// Uniform scale. Units: none. Domain: [0.0001, 10 000]. Default: 1.
    pub scale: f64,
    /// Where it is when. Times rise strictly; it stands before the first and after the last. Domain: 1…100 000 keys.
    pub path: Vec<PathKey>,
    /// How it gets from key to key. Default: `Linear`.
    pub interpolation: Interpolation,
    /// How the names of wheel nodes begin. Default: `"wheel"`.
    pub wheel_prefix: String,
    /// Radius of the wheels after scaling: what turns distance into rotation. Units: m. Domain: [0.01, 10].
    /// Default: 0.33.
    pub wheel_radius_m: f64,
    /// Whether its headlights are on. Default: false.
    pub headlights: bool,
}

impl Default for Vehicle {
    fn default() -> Self {
        Self {
            name: String::new(),
            file: String::new(),
            scale: 1.0,
            path: Vec::new(),
            interpolation: Interpolation::Linear,
            wheel_prefix: "wheel".into(),
            wheel_radius_m: 0.33,
            headlights: false,
        }
    }
}

/// A vehicle's place at a time.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PathKey {
    /// When. Units: s. Domain: [-2 592 000, 2 592 000]. Default: 0.
    pub time_s: f64,
    /// Where the model's origin is. Units: m. Domain: each within ±1 000 000. Default: (0, 0, 0).
    pub position: Vector,
}

/// The camera: on its own path (`keys`) or on a vehicle (`attached`), not both. With neither it stands at
/// (8, 3, 8) and looks at (0, 1, 0).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Camera {
    /// The camera's own path; it stands before the first key and after the last. Times rise strictly. Domain: at most
    /// 100 000 keys. Default: none.
    pub keys: Vec<CameraKey>,
    /// How it gets from key to key. Default: `Linear`.
    pub interpolation: Interpolation,
    /// Rides on a vehicle instead. Default: none.
    pub attached: Option<Attached>,
    /// Height of the picture of a view without perspective, whatever the keys' fields of view. Units: m. Domain: [0.1, 1000].
    /// Default: none, a view with perspective.
    pub orthographic_m: Option<f64>,
}

/// A camera pose at a time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CameraKey {
    /// When. Units: s. Domain: [-2 592 000, 2 592 000]. Default: 0.
    pub time_s: f64,
    /// Where the camera is. Units: m. Domain: each within ±1 000 000. Default: (8, 3, 8).
    pub eye: Vector,
    /// What it looks at; not the eye itself. Units: m. Domain: each within ±1 000 000. Default: (0, 1, 0).
    pub target: Vector,
    /// Vertical field of view. Units: degrees. Domain: [1, 170]. Default: 50.
    pub fov_y_deg: f64,
    /// Whether the camera jumps here: until this key's time it stays at the one before. Default: false.
    pub cut: bool,
}

impl Default for CameraKey {
    fn default() -> Self {
        Self {
            time_s: 0.0,
            eye: [8.0, 3.0, 8.0],
            target: [0.0, 1.0, 0.0],
            fov_y_deg: 50.0,
            cut: false,
        }
    }
}

/// A camera that rides on a vehicle. Offsets are in the vehicle's frame: +Z ahead, +Y up, +X to its left.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Attached {
    /// Name of the vehicle. Domain: one in the list. Required.
    pub vehicle: String,
    /// The eye, from the vehicle's origin. Units: m. Domain: each within ±1000. Default: (0, 2.5, -7).
    pub eye_offset: Vector,
    /// What it looks at, from the vehicle's origin. Units: m. Domain: each within ±1000. Default: (0, 1, 4).
    pub target_offset: Vector,
    /// Vertical field of view. Units: degrees. Domain: [1, 170]. Default: 50.
    pub fov_y_deg: f64,
}

impl Default for Attached {
    fn default() -> Self {
        Self {
            vehicle: String::new(),
            eye_offset: [0.0, 2.5, -7.0],
            target_offset: [0.0, 1.0, 4.0],
            fov_y_deg: 50.0,
        }
    }
}

/// How rain is drawn. Nothing here changes where drops are, masks, haze, wetness or the water ledger.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RainSettings {
    /// Whether the rain plugins are in the scene at all; `false` is the scene without them. Default: true.
    pub enabled: bool,
    /// Streaks drawn singly, on average; twice as many is the hard bound. Domain: 0…4 000 000. Default: 30 000.
    pub streak_budget: u32,
    /// Gain on streak contrast, α′ = 1 − (1 − α)^contrast. Units: none. Domain: [1, 32]; 1 is physical. Default: 4.
    pub contrast: f64,
    /// Exposure time that streaks are drawn for, whatever the frame rate. Units: s. Domain: [0.0001, 0.25].
    /// Default: 1/60.
    pub exposure_s: f64,
    /// Whose rules wet surfaces look by: `Physical`, `Lagarde`, `LagardePorous`, `Nguyenova`. Default: `Physical`.
    pub look: WetLook,
    /// Where rings on water come from. Default: `Drops`.
    pub rings: Rings,
    /// Crowns and thrown drops of splashes drawn, about; twice as many is the hard bound, 0 draws none. Domain:
    /// 0…1 000 000. Default: 8000.
    pub splash_budget: u32,
    /// Haze of the rain, with far showers and the glow of lamps. Default: true.
    pub haze: bool,
    /// Height (Y) of the cloud that rain falls from; there is no haze above. Units: m. Domain: ±100 000. Default: 1000.
    pub cloud_base_m: f64,
    /// Gain on the glow of lamps in the haze. Units: none. Domain: [0, 100]; 1 is physical. Default: 1.
    pub glow: f64,
    /// Gain on the light of rainbows, which a sun behind the eye makes in the haze. Units: none. Domain: [0, 100]; 1 is
    /// physical, 0 none. Default: 0.
    pub rainbow: f64,
    /// Gain on the mist that splashes throw up and strong wind carries. Units: none. Domain: [0, 100]; 1 is the model's, 0
    /// none. Default: 0.
    pub splash_mist: f64,
    /// Gain on the light that the camera's bloom spreads because it rains, where `environment.bloom` is on. Units: none. Domain:
    /// [0, 100]; 0 leaves the bloom alone. Default: 0.
    pub bloom: f64,
    /// Whether rain beyond the single drops is drawn, as cards of many. Default: on a GPU, not on a software adapter.
    pub cards: Option<bool>,
    /// Whether showers seen from outside are drawn as particles over their haze. Default: on a GPU, not on a software adapter.
    pub far_rain: Option<bool>,
    /// Whether near streaks show what their drops do. Default: on a GPU, not on a software adapter.
    pub near_patterns: Option<bool>,
    /// How many of the scene's lamps light the rain. Domain: [0, 64]. Default: 64 on a GPU, 16 on a software adapter.
    pub lamps: Option<u32>,
    /// Glass before the camera that the rain wets. Default: `Off`.
    pub lens: Lens,
}

/// What glass a scenario's camera looks through.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Lens {
    /// None that is wetted.
    #[default]
    Off,
    /// The camera's own.
    Camera,
    /// A windscreen with wipers.
    Windscreen(WiperMode),
}

/// Where rings on water come from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Rings {
    /// Simulated from the drops of the rain.
    #[default]
    Drops,
    /// Procedural, as many and as rough as the rain makes them.
    Layers,
    /// Procedural, as their source has them (Lagarde 2013).
    Lagarde,
}

impl Default for RainSettings {
    fn default() -> Self {
        Self {
            enabled: true,
            streak_budget: 30_000,
            contrast: 4.0,
            exposure_s: 1.0 / 60.0,
            rings: Rings::default(),
            splash_budget: 8_000,
            haze: true,
            cloud_base_m: 1000.0,
            glow: 1.0,
            rainbow: 0.0,
            splash_mist: 0.0,
            bloom: 0.0,
            cards: None,
            far_rain: None,
            near_patterns: None,
            lamps: None,
            lens: Lens::Off,
            look: WetLook::Physical,
        }
    }
}

/// How standing water looks and moves. Nothing here changes wetness or the water ledger. Units, domains and defaults: those
/// of [`WaterAppearance`] unless stated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct WaterSettings {
    /// Absorption of red, green and blue. Units: 1/m.
    pub absorption_per_m: [f32; 3],
    /// Albedo of its mud.
    pub mud_albedo: [f32; 3],
    /// Light lost to scattering by mud. Units: 1/m.
    pub turbidity_per_m: f32,
    /// Multiple of the wind's waves.
    pub wave_strength: f32,
    /// Root mean square slope of the waves. Default: by the wind.
    pub wave_slope: Option<f32>,
    /// Length of the longest waves. Units: m.
    pub wave_length_m: f32,
    /// Velocity of the waves along x and z. Units: m/s. Default: with the wind, at 0.3 m/s.
    pub wave_velocity_m_s: Option<[f32; 2]>,
    /// Multiple of the rings that drops make.
    pub ripple_strength: f32,
    /// Multiple of the slope of wavelets on films that run down slopes; 0: none. Domain: [0, 4]. Default: 1.
    pub flow_strength: f32,
    /// Share of the mirrored view in reflections.
    pub reflection_strength: f32,
    /// Share of the light that standing water mirrors.
    pub puddle_reflection: f32,
    /// Multiple of the sunlight that puddles throw onto walls.
    pub caustics: f32,
    /// Whether wheels make waves in puddles. Default: true.
    pub simulation: bool,
}

impl Default for WaterSettings {
    fn default() -> Self {
        let look = WaterAppearance::default();
        Self {
            absorption_per_m: look.absorption_per_m.to_array(),
            mud_albedo: look.mud_albedo.to_array(),
            turbidity_per_m: look.turbidity_per_m,
            wave_strength: look.wave_strength,
            wave_slope: look.wave_slope,
            wave_length_m: look.wave_length_m,
            wave_velocity_m_s: look.wave_velocity_m_s.map(|v| v.to_array()),
            ripple_strength: look.ripple_strength,
            flow_strength: look.flow_strength,
            reflection_strength: look.reflection_strength,
            puddle_reflection: look.puddle_reflection,
            caustics: look.caustics,
            simulation: true,
        }
    }
}

impl WaterSettings {
    /// The plugin's settings of the same values, not yet checked.
    #[must_use]
    pub fn appearance(&self) -> WaterAppearance {
        WaterAppearance {
            absorption_per_m: self.absorption_per_m.into(),
            mud_albedo: self.mud_albedo.into(),
            turbidity_per_m: self.turbidity_per_m,
            wave_strength: self.wave_strength,
            wave_slope: self.wave_slope,
            wave_length_m: self.wave_length_m,
            wave_velocity_m_s: self.wave_velocity_m_s.map(Into::into),
            ripple_strength: self.ripple_strength,
            flow_strength: self.flow_strength,
            reflection_strength: self.reflection_strength,
            puddle_reflection: self.puddle_reflection,
            caustics: self.caustics,
        }
    }
}

/// A picture of numbers, one per pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Mask {
    /// Share of the pixel covered by streaks and billboards (no time fraction, no contrast). Units: none, [0, 1].
    Rain,
    /// Pore saturation: of the ground what it remembers, elsewhere the weather's where rain reaches. Units: none, [0, 1].
    Wet,
    /// Distance from the eye. Units: m, saturating at 65.535.
    Depth,
    /// Depth of the water that stands in the ground's hollows. Units: m, saturating at 0.65535.
    Water,
}

impl Mask {
    /// The word in file names: `frame_0000_rain.png`.
    #[must_use]
    pub fn suffix(self) -> &'static str {
        match self {
            Self::Rain => "rain",
            Self::Wet => "wet",
            Self::Depth => "depth",
            Self::Water => "water",
        }
    }
}

/// What is written beside `report.json`, which always is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Outputs {
    /// Width and height of the pictures. Units: pixels. Domain: each 1…8192. Default: (1280, 720).
    pub size: [u32; 2],
    /// Whether `frame_0000.png` … are written. Default: true.
    pub frames: bool,
    /// Masks written for each capture. Domain: each at most once. Default: none.
    pub masks: Vec<Mask>,
    /// Whether `contact.png` is written: all captures small, with captions. Default: true.
    pub contact_sheet: bool,
    /// Whether `frame_0000_above.png` … are written: each capture's drops and far rain from above. Default: false.
    pub above: bool,
    /// Whether `timeline.png` is written: intensity, wetness, level and budget over time. Default: true.
    pub timeline: bool,
}

impl Default for Outputs {
    fn default() -> Self {
        Self {
            size: [1280, 720],
            frames: true,
            masks: Vec::new(),
            contact_sheet: true,
            above: false,
            timeline: true,
        }
    }
}

/// A horizontal rectangle, as (x, z). Units: m.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Domain {
    /// Least x and z. Domain: each within ±1 000 000.
    pub min: [f64; 2],
    /// Greatest x and z. Domain: each above `min`, and at most 100 000 m from it.
    pub max: [f64; 2],
}
