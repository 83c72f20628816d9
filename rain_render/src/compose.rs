//! Joins types, library and pass into plain WGSL; there is no preprocessor.

use std::fmt::Write as _;

use rain_core::haze::{FIRST_RATE_MM_H, FOG_TABLE_END_M, FOG_TABLE_KNOTS, RATE_KNOTS};
use rain_core::optics::{BOW_KNOTS, BOW_SPAN_DEG, BOW_STEP_DEG};
use rain_core::rainfall::{
    FADE_END, FAR_BEGIN_M, FAR_HEIGHT, FAR_OPACITY, FAR_PITCH, FAR_SHADE, LEAD_TIME_S, RANGE_CAP_M, SOFT_EDGE,
};
use rain_core::splash::{SPLASH_CELL_M, SPLASH_SLOT_S, SPLASH_SLOTS};
use rain_core::surface::{FLOW_NOISE, FLOW_PERIOD_S};
use rain_core::waves::{CAUSTIC_END_M, CAUSTIC_RAYS, CAUSTIC_TEXELS, CAUSTIC_WAYS_M, LEAST_ELEVATION, RING_FADE};

use crate::params_space::ParamsSpace;
use crate::rainfall::NO_DROP;

/// Structs that cross from the CPU.
pub const TYPES: &str = concat!(
    include_str!("../shaders/types.wgsl"),
    include_str!("../shaders/splash_types.wgsl")
);

/// A library file: pure functions, no bindings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Library {
    /// Name without extension.
    pub name: &'static str,
    /// WGSL source.
    pub source: &'static str,
}

macro_rules! library {
    ($($name:literal),* $(,)?) => {
        &[$(Library { name: $name, source: include_str!(concat!("../shaders/lib/", $name, ".wgsl")) }),*]
    };
}

/// Every library file, each after those it calls.
pub const LIBRARIES: &[Library] = library![
    "hash",
    "drop_field",
    "cover",
    "streak",
    "far_rain",
    "drop_light",
    "drop_body",
    "near_streak",
    "lamp_light",
    "surroundings",
    "glass",
    "haze",
    "splash_mist",
    "rainbow",
    "wetness",
    "standing_water",
    "ground_memory",
    "wind_waves",
    "rut_lanes",
    "placed_water",
    "film_waves",
    "beads",
    "artist_look",
    "slopes",
    "waves",
    "ring_layers",
    "caustics",
    "water_column",
    "water_map",
    "rain_areas",
    "streak_texture",
    "lattice",
    "landing",
    "splash",
    "spout",
    "lens",
    "surface_mask"
];

/// A pass's own source.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pass {
    /// Name without extension.
    pub name: &'static str,
    /// WGSL source: bindings and entry points.
    pub source: &'static str,
}

macro_rules! passes {
    ($($name:literal),* $(,)?) => {
        &[$(Pass { name: $name, source: include_str!(concat!("../shaders/passes/", $name, ".wgsl")) }),*]
    };
}

/// Every pass.
pub const PASSES: &[Pass] = passes![
    "rainfall_choose",
    "rainfall_project",
    "rainfall_draw",
    "rainfall_near",
    "mask",
    "slope_mips",
    "reflection_mips",
    "waves",
    "ring_layers",
    "caustics",
    "water_map",
    "streak_texture",
    "lattice_draw",
    "splash_make",
    "splash_draw",
    "haze_areas",
    "haze",
    "far_rain",
    "lens"
];

/// Functions over bindings that some passes share, and those passes.
const SHARED: [(&str, &[&str]); 3] = [
    (
        include_str!("../shaders/shared/area_rows.wgsl"),
        &["water_map", "haze_areas", "rainfall_choose"],
    ),
    (
        include_str!("../shaders/shared/streak_quads.wgsl"),
        &["rainfall_draw", "rainfall_near"],
    ),
    (
        include_str!("../shaders/shared/scene_gap.wgsl"),
        &["rainfall_project", "rainfall_near"],
    ),
];

/// What covers from more than this above a drop is taken for a building with walls, not for an open roof. Chosen:
/// shelters, awnings and canopies of filling stations are lower. Units: m.
pub const BUILDING_HEIGHT_M: f64 = 5.0;

/// What lies deeper than this under a puddle's level is another floor, not its bottom. Units: m.
pub const DEEPEST_PUDDLE_M: f64 = 0.6;

/// Side of the tile that the wind's waves repeat in. Units: lengths of the longest wave.
pub const WIND_TILE: f64 = 256.0;

/// Directions in a full turn that trains of the wind's waves may have.
pub const WIND_DIRECTIONS: f64 = 24.0;

/// After this time the wind's waves repeat. Units: s, a whole number.
pub const WAVE_PERIOD_S: f64 = 4096.0;

/// Directions on the ground of the grid of areas' haze.
pub const HAZE_AZIMUTHS: u32 = 512;

/// Intervals of distance of that grid, each a constant factor longer than the one before but for the first ones.
pub const HAZE_INTERVALS: u32 = 128;

/// Distance at which those intervals begin to grow. Units: m.
pub const HAZE_FIRST_M: f64 = 4.0;

/// Constants that shaders share with `rain_core`.
#[must_use]
pub fn constants() -> String {
    let mut out = String::new();
    for (name, value) in [
        ("RAIN_RANGE_CAP_M", RANGE_CAP_M),
        ("RAIN_FADE_END", FADE_END),
        ("RAIN_LEAD_TIME_S", LEAD_TIME_S),
        ("RAIN_SOFT_EDGE", f64::from(SOFT_EDGE)),
        ("RAIN_BUILDING_HEIGHT_M", BUILDING_HEIGHT_M),
        ("RAIN_DEEPEST_PUDDLE_M", DEEPEST_PUDDLE_M),
        ("RAIN_WIND_TILE", WIND_TILE),
        ("RAIN_WIND_DIRECTIONS", WIND_DIRECTIONS),
        ("RAIN_WAVE_PERIOD_S", WAVE_PERIOD_S),
        ("RAIN_RING_FADE", f64::from(RING_FADE)),
        ("RAIN_CAUSTIC_FIRST_M", CAUSTIC_WAYS_M[0]),
        ("RAIN_CAUSTIC_END_M", CAUSTIC_END_M),
        ("RAIN_LEAST_ELEVATION", LEAST_ELEVATION),
        ("RAIN_FLOW_PERIOD_S", FLOW_PERIOD_S),
        ("RAIN_FLOW_NOISE", FLOW_NOISE),
        ("RAIN_SPLASH_CELL_M", SPLASH_CELL_M),
        ("RAIN_SPLASH_SLOT_S", SPLASH_SLOT_S),
        ("RAIN_SPLASH_SLOTS", f64::from(SPLASH_SLOTS)),
        ("RAIN_FOG_END_M", FOG_TABLE_END_M),
        ("RAIN_FOG_KNOTS", FOG_TABLE_KNOTS as f64),
        ("RAIN_FIRST_RATE_MM_H", FIRST_RATE_MM_H),
        ("RAIN_HAZE_FIRST_M", HAZE_FIRST_M),
        ("RAIN_FAR_BEGIN_M", FAR_BEGIN_M[0]),
        ("RAIN_FAR_WHOLE_M", FAR_BEGIN_M[1]),
        ("RAIN_FAR_LOW_FROM", FAR_PITCH[0][0]),
        ("RAIN_FAR_LOW_TO", FAR_PITCH[0][1]),
        ("RAIN_FAR_HIGH_FROM", FAR_PITCH[1][0]),
        ("RAIN_FAR_HIGH_TO", FAR_PITCH[1][1]),
        ("RAIN_FAR_HEIGHT", FAR_HEIGHT),
        ("RAIN_FAR_OPACITY", FAR_OPACITY),
        ("RAIN_FAR_SHADE", FAR_SHADE),
        ("RAIN_BOW_LOW", BOW_SPAN_DEG[0]),
        ("RAIN_BOW_HIGH", BOW_SPAN_DEG[1]),
        ("RAIN_BOW_BELOW", BOW_STEP_DEG[0]),
        ("RAIN_BOW_WITHIN", BOW_STEP_DEG[1]),
        ("RAIN_BOW_ABOVE", BOW_STEP_DEG[2]),
    ] {
        let _ = writeln!(out, "const {name}: f32 = {value:?};");
    }
    for (name, value) in [
        ("RAIN_NO_DROP", NO_DROP),
        ("RAIN_RATE_KNOTS", RATE_KNOTS as u32),
        ("RAIN_BOW_KNOTS", BOW_KNOTS as u32),
        ("RAIN_CAUSTIC_TEXELS", CAUSTIC_TEXELS),
        ("RAIN_CAUSTIC_RAYS", CAUSTIC_RAYS),
        ("RAIN_HAZE_AZIMUTHS", HAZE_AZIMUTHS),
        ("RAIN_HAZE_INTERVALS", HAZE_INTERVALS),
    ] {
        let _ = writeln!(out, "const {name}: u32 = {value}u;");
    }
    out
}

/// The complete module of a pass.
///
/// # Panics
/// When no pass has this name.
#[must_use]
pub fn module(pass: &str) -> String {
    let pass = PASSES.iter().find(|p| p.name == pass).expect("a pass of this crate");
    let mut out = constants();
    out.push_str(TYPES);
    for library in LIBRARIES {
        out.push_str(library.source);
    }
    for (source, _) in SHARED.iter().filter(|(_, readers)| readers.contains(&pass.name)) {
        out.push_str(source);
    }
    out.push_str(pass.source);
    out
}

pub(crate) fn shader(device: &wgpu::Device, pass: &str) -> wgpu::ShaderModule {
    create(device, pass, &module(pass))
}

/// A module whose parameters lie where the device has them.
pub(crate) fn create(device: &wgpu::Device, label: &str, source: &str) -> wgpu::ShaderModule {
    create_in(ParamsSpace::of(device), device, label, source)
}

/// The module of a pass whose parameters lie in a space.
pub(crate) fn shader_in(space: ParamsSpace, device: &wgpu::Device, pass: &str) -> wgpu::ShaderModule {
    create_in(space, device, pass, &module(pass))
}

fn create_in(space: ParamsSpace, device: &wgpu::Device, label: &str, source: &str) -> wgpu::ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(space.source(source)),
    })
}

/// The module of the pass `haze` for a scene's depth with several samples: every sample is shaded.
///
/// # Panics
/// When the pass no longer says what is replaced.
#[must_use]
pub fn haze_of_samples() -> String {
    let mut source = module("haze");
    for (single, several) in [
        (
            "var scene_depth: texture_depth_2d;",
            "var scene_depth: texture_depth_multisampled_2d;",
        ),
        (
            "fn colour(in: HazeVertex)",
            "fn colour(in: HazeVertex, @builtin(sample_index) which: u32)",
        ),
        ("    let which = 0u;\n", ""),
    ] {
        assert!(source.contains(single), "haze has `{single}`");
        source = source.replace(single, several);
    }
    source
}
