//! Every struct that crosses to the GPU: the twins of `shaders/types.wgsl` and `shaders/splash_types.wgsl`, compared member
//! by member by a test.
//!
//! Units and meaning of each member stand in the WGSL file.

#![allow(missing_docs, reason = "the members are documented once, in shaders/types.wgsl")]

use bytemuck::{Pod, Zeroable};
use rain_core::lens::MAX_WIPER_ARMS;
use rain_core::rainfall::{CLASS_COUNT, MAX_LAMPS};
use rain_core::splash::SPLASH_COUNTS;
use rain_core::weather::SurfaceClass;

use crate::glass::MAX_PANES;
use crate::reflection::MAX_MIRRORS;
use crate::splash::MAX_FEET;

/// The depth map along the rain.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct CoverParams {
    pub centre: [f32; 2],
    pub wind: [f32; 2],
    pub inverse_extent: f32,
    pub top: f32,
    pub range: f32,
    pub highest: f32,
    pub plane: f32,
    pub inverse_speed: f32,
    pub texels: f32,
    pub present: f32,
}

/// One size class of the drop field, placed for a view.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct RainfallClass {
    pub cell: [i32; 4],
    pub fraction: [f32; 4],
    pub velocity: [f32; 4],
    pub stream: [u32; 4],
    pub diameter: [f32; 4],
}

/// A box that is seen through.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct GlassPane {
    pub along: [f32; 4],
    pub up: [f32; 4],
    pub across: [f32; 4],
}

/// A view of the rain.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct RainfallView {
    pub clip_from_eye: [[f32; 4]; 4],
    pub clip_from_eye_before: [[f32; 4]; 4],
    pub environment: [f32; 4],
    pub ambient: [f32; 4],
    pub sun_direction: [f32; 4],
    pub sun: [f32; 4],
    pub lead: [f32; 4],
    pub rays: [f32; 4],
    pub size: [f32; 4],
    pub viewport: [f32; 4],
    pub focal: f32,
    pub near: f32,
    pub exposure: f32,
    pub contrast: f32,
    pub kappa: f32,
    pub soft: f32,
    pub lamps: u32,
    pub panes: u32,
    pub patterned: u32,
    pub guard_share: f32,
    pub pad_b: u32,
    pub pad_c: u32,
    pub cover: CoverParams,
    pub classes: [RainfallClass; CLASS_COUNT],
    pub lamp: [LampParams; MAX_LAMPS],
    pub pane: [GlassPane; MAX_PANES],
}

/// Cells of a class's lattice that may hold drops of a view.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
pub struct ChoiceClass {
    pub low: [i32; 4],
    pub side: [u32; 4],
    pub runs: [u32; 4],
    pub ranks: [f32; 4],
    pub reach: [f32; 4],
    pub out: [f32; 4],
}

/// What the drops of a view are chosen from.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
pub struct RainfallChoice {
    pub planes: [[f32; 4]; 4],
    pub region: [f32; 4],
    pub region_place: [f32; 4],
    pub lead: [f32; 4],
    pub along: [f32; 4],
    pub region_turn: [f32; 4],
    pub ladder: [f32; 4],
    pub runs: u32,
    pub groups: u32,
    pub most: u32,
    pub draws: u32,
    pub detail: u32,
    pub kappa: f32,
    pub focal: f32,
    pub exposure: f32,
    pub rows: u32,
    pub parallel: u32,
    pub pad_b: u32,
    pub pad_c: u32,
    pub classes: [ChoiceClass; CLASS_COUNT],
}

/// A projected streak; written and read by the GPU only.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Streak {
    pub ends: [f32; 4],
    pub shape: [f32; 3],
    pub shares: u32,
    pub light: [f32; 3],
    pub gaps: u32,
}

/// Levels of standing water over the ground.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
pub struct LevelMapParams {
    pub corner: [f32; 2],
    pub inverse_cell: f32,
    pub base: f32,
    pub cells: [f32; 2],
    pub present: f32,
    pub films: f32,
}

/// How standing water looks.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
pub struct WaterLook {
    pub absorption: [f32; 4],
    pub mud: [f32; 4],
    pub ambient: [f32; 4],
    pub ripples: [f32; 4],
    pub waves: [f32; 4],
    pub place: [f32; 4],
    pub map: [f32; 4],
    pub more_map: [f32; 4],
}

/// A mirrored view.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
pub struct ReflectionParams {
    pub clip_from_eye: [[f32; 4]; 4],
    pub eye: [f32; 4],
    pub plane: [f32; 4],
}

/// Where the levels of the water map lie.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
pub struct WaterMapPlaces {
    pub fine: [f32; 4],
    pub middle: [f32; 4],
    pub coarse: [f32; 4],
    pub fine_centre: [f32; 2],
    pub middle_centre: [f32; 2],
    pub coarse_centre: [f32; 2],
    pub pad: [f32; 2],
}

/// What the wet look and the wet mask read.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct SurfaceParams {
    pub eye: [f32; 4],
    pub state: [f32; 4],
    pub artist: [f32; 4],
    pub cover: CoverParams,
    pub levels: LevelMapParams,
    pub water: WaterLook,
    pub mirrors: [ReflectionParams; MAX_MIRRORS],
    pub map: WaterMapPlaces,
    pub caustics: [f32; 4],
}

/// The mask pass's view.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct MaskView {
    pub eye_from_clip: [[f32; 4]; 4],
    pub screen: [f32; 4],
    pub corner: [f32; 4],
    pub surface: SurfaceParams,
}

/// A step of a wave tile.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct WaveParams {
    pub cells: u32,
    pub periodic: u32,
    pub offset: [u32; 2],
    pub moved: [i32; 2],
    pub first_source: u32,
    pub first_bin: u32,
    pub courant_squared: f32,
    pub g: f32,
    pub keep: f32,
    pub inverse_keep: f32,
    pub blend: f32,
    pub per_cell: f32,
    pub rim: f32,
    pub rim_damping: f32,
    pub hidden_variance: f32,
    pub pad_a: u32,
    pub pad_b: u32,
    pub pad_c: u32,
}

/// A source of waves on a straight way.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct WaveSource {
    pub low: [i32; 2],
    pub count: [u32; 2],
    pub start: [f32; 2],
    pub along: [f32; 2],
    pub length: f32,
    pub per_width: f32,
    pub height: f32,
    pub back: f32,
}

/// Eight by eight cells that sources reach.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
pub struct WaveBin {
    pub place: u32,
    pub first: u32,
    pub count: u32,
    pub pad: u32,
}

/// Procedural rings at a moment.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct RingLayerParams {
    pub parts: [f32; 4],
    pub weights: [f32; 4],
    pub wholes: [u32; 4],
    pub cycles: [u32; 4],
    pub offset_x: [u32; 4],
    pub offset_z: [u32; 4],
    pub cells: u32,
    pub texels: u32,
    pub repeats: u32,
    pub by_number: u32,
    pub steepness: f32,
    pub hidden_variance: f32,
    pub pad_a: u32,
    pub pad_b: u32,
}

/// Mirrored rays of a frame.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct CausticParams {
    pub towards: [f32; 4],
    pub per_side: f32,
    pub strength: f32,
    pub blur: f32,
    pub pad_a: f32,
}

/// What a surface does with water.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
pub struct ColumnRules {
    pub capacity: f32,
    pub texture: f32,
    pub drain: f32,
    pub soil: f32,
    pub dry_soil: f32,
    pub soil_decay: f32,
    pub recovery: f32,
    pub pad: f32,
}

impl From<&rain_core::weather::ColumnRules> for ColumnRules {
    fn from(rules: &rain_core::weather::ColumnRules) -> Self {
        Self {
            capacity: rules.capacity_mm,
            texture: rules.texture_mm,
            drain: rules.drain,
            soil: rules.soil_mm_s,
            dry_soil: rules.dry_soil_mm_s,
            soil_decay: rules.soil_decay_per_s,
            recovery: rules.recovery_per_s,
            pad: 0.0,
        }
    }
}

/// One level of the water map over an interval.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct WaterMapParams {
    pub rules: [ColumnRules; SurfaceClass::COUNT],
    pub cover: CoverParams,
    pub offset: [u32; 2],
    pub kept: [i32; 2],
    pub seed_low: [i32; 2],
    pub seed_cells: [i32; 2],
    pub ground_cells: [i32; 2],
    pub ground_corner: [f32; 2],
    pub corner: [f32; 2],
    pub texels: u32,
    pub level: u32,
    pub cell: f32,
    pub ground_step: f32,
    pub per_ground_cell: f32,
    pub base: f32,
    pub rain: f32,
    pub evaporation: f32,
    pub time: f32,
    pub pools: f32,
}

/// A wheel or a foot on its straight way.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct WaterStamp {
    pub low: [i32; 2],
    pub count: [i32; 2],
    pub start: [f32; 2],
    pub along: [f32; 2],
    pub length: f32,
    pub half: f32,
    pub share: f32,
    pub aside: f32,
    pub band: f32,
    pub slot: u32,
    pub pad_a: u32,
    pub pad_b: u32,
}

/// A streak texture's layer while it is drawn.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct StreakTile {
    pub texels: u32,
    pub first: u32,
    pub drops: u32,
    pub pad_a: u32,
    pub path: f32,
    pub unit: f32,
    pub steps: f32,
    pub pad_b: u32,
}

/// A level of a layer while it is made.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
pub struct StreakLevel {
    pub side: u32,
    pub first: u32,
    pub above: u32,
    pub words: u32,
    pub row: u32,
    pub pad_a: u32,
    pub pad_b: u32,
    pub pad_c: u32,
}

/// A point or spot light.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct LampParams {
    pub place: [f32; 4],
    pub intensity: [f32; 4],
    pub direction: [f32; 4],
    pub limits: [f32; 4],
}

/// A view of the lattice.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct LatticeParams {
    pub clip_from_eye: [[f32; 4]; 4],
    pub environment: [f32; 4],
    pub ambient: [f32; 4],
    pub sun_direction: [f32; 4],
    pub sun: [f32; 4],
    pub fog: [f32; 4],
    pub near: f32,
    pub contrast: f32,
    pub soft: f32,
    pub cards: u32,
    pub lamps: u32,
    pub panes: u32,
    pub pad_b: u32,
    pub pad_c: u32,
    pub cover: CoverParams,
    pub lamp: [LampParams; MAX_LAMPS],
    pub pane: [GlassPane; MAX_PANES],
}

/// A step in water.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct SplashFoot {
    pub place: [f32; 4],
    pub key: [u32; 4],
}

/// Water that leaves one mouth.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct SpoutMouth {
    pub place: [f32; 4],
    pub velocity: [f32; 4],
    pub form: [f32; 4],
    pub state: [f32; 4],
    pub key: [u32; 4],
}

/// A view of far rain.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct FarRainParams {
    pub clip_from_eye: [[f32; 4]; 4],
    pub environment: [f32; 4],
    pub ambient: [f32; 4],
    pub sun_direction: [f32; 4],
    pub sun: [f32; 4],
    pub axis: [f32; 4],
    pub cloud: f32,
    pub thin: f32,
    pub pad_b: f32,
    pub pad_c: f32,
}

/// A view of splashes.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct SplashView {
    pub clip_from_eye: [[f32; 4]; 4],
    pub clip_from_eye_before: [[f32; 4]; 4],
    pub environment: [f32; 4],
    pub ambient: [f32; 4],
    pub sun_direction: [f32; 4],
    pub sun: [f32; 4],
    pub planes: [[f32; 4]; 4],
    pub rays: [f32; 4],
    pub wind: [f32; 4],
    pub stream: [u32; 4],
    pub viewport: [f32; 2],
    pub fraction: [f32; 2],
    pub cell: [i32; 2],
    pub focal: f32,
    pub near: f32,
    pub exposure: f32,
    pub contrast: f32,
    pub soft: f32,
    pub reach: f32,
    pub near_reach: f32,
    pub film: f32,
    pub since: f32,
    pub span: u32,
    pub capacity: u32,
    pub lamps: u32,
    pub panes: u32,
    pub feet: u32,
    pub mouths: u32,
    pub mouth_reach: f32,
    pub shares: [f32; 2],
    pub cover: CoverParams,
    pub levels: LevelMapParams,
    pub counts: [u32; SPLASH_COUNTS],
    pub limits: [u32; CLASS_COUNT],
    pub classes: [[f32; 4]; CLASS_COUNT],
    pub lamp: [LampParams; MAX_LAMPS],
    pub pane: [GlassPane; MAX_PANES],
    pub foot: [SplashFoot; MAX_FEET],
}

/// A crown or a thrown drop to draw; written and read by the GPU only.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct SplashPart {
    pub ends: [f32; 4],
    pub shape: [f32; 4],
    pub light: [f32; 4],
    pub form: [f32; 4],
}

/// A part as it was found.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct SplashFind {
    pub part: SplashPart,
    pub id: u32,
    pub number: u32,
    pub pad_a: u32,
    pub pad_b: u32,
}

/// Arguments of the draw of splashes, and how many parts there were.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct SplashDraw {
    pub vertices: u32,
    pub instances: u32,
    pub first_vertex: u32,
    pub first_instance: u32,
    pub found: u32,
    pub noted: u32,
}

/// A lamp that glows in the haze.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct HazeLamp {
    pub place: [f32; 4],
    pub light: [f32; 4],
    pub axis: [f32; 4],
}

/// A view of haze.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct HazeView {
    pub eye_from_clip: [[f32; 4]; 4],
    pub clip_from_eye: [[f32; 4]; 4],
    pub environment: [f32; 4],
    pub ambient: [f32; 4],
    pub sun_direction: [f32; 4],
    pub sun: [f32; 4],
    pub forward: [f32; 4],
    pub depth_row: [f32; 4],
    pub air: [f32; 4],
    pub viewport: [f32; 4],
    pub fog: [f32; 4],
    pub extinction: f32,
    pub efficiency: f32,
    pub cloud: f32,
    pub limit: f32,
    pub artist: f32,
    pub coloured: f32,
    pub uneven: f32,
    pub lamps: u32,
    pub grid: [f32; 4],
    pub far: [f32; 4],
    pub splash: [f32; 4],
    pub cover: CoverParams,
    pub drawn: [[f32; 4]; 16],
    pub rates: [[f32; 4]; 16],
    pub lamp: [HazeLamp; 16],
}

/// A view through a glass in the rain.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
pub struct LensView {
    pub viewport: [f32; 4],
    pub arms: [[f32; 4]; MAX_WIPER_ARMS],
    pub turns: [[f32; 4]; MAX_WIPER_ARMS],
    pub cycle: [f32; 4],
    pub size: [f32; 2],
    pub half_tan: [f32; 2],
    pub distance: f32,
    pub aperture: f32,
    pub mist: f32,
    pub mist_per_s: f32,
    pub wiping: f32,
    pub pad_a: f32,
    pub pad_b: f32,
    pub pad_c: f32,
}

/// A drop on the glass.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct LensDrop {
    pub place: [f32; 2],
    pub along: [f32; 2],
    pub radius: f32,
    pub stretch: f32,
    pub key: u32,
    pub pad_a: u32,
}

/// Name and byte offset of every member of a struct: what a layout test compares with WGSL.
pub type Layout = (&'static str, usize, Vec<(&'static str, usize)>);

macro_rules! layout {
    ($type:ident: $($member:ident),*) => {
        (stringify!($type), size_of::<$type>(), vec![$((stringify!($member), core::mem::offset_of!($type, $member))),*])
    };
}

/// The layouts of every struct of this file.
#[must_use]
pub fn layouts() -> Vec<Layout> {
    use rain_core::rainfall::{Card, DropRecord, FarParticle, TileDrop};
    vec![
        layout!(CoverParams: centre, wind, inverse_extent, top, range, highest, plane, inverse_speed, texels, present),
        layout!(RainfallClass: cell, fraction, velocity, stream, diameter),
        layout!(RainfallView: clip_from_eye, clip_from_eye_before, environment, ambient, sun_direction, sun, lead, rays, size,
            viewport, focal, near, exposure, contrast, kappa, soft, lamps, panes, patterned, guard_share, pad_b, pad_c,
            cover, classes, lamp, pane),
        layout!(ChoiceClass: low, side, runs, ranks, reach, out),
        layout!(RainfallChoice: planes, region, region_place, lead, along, region_turn, ladder, runs, groups, most, draws, detail, kappa,
            focal, exposure, rows, parallel, pad_b, pad_c, classes),
        layout!(GlassPane: along, up, across),
        layout!(SplashFoot: place, key),
        layout!(SpoutMouth: place, velocity, form, state, key),
        layout!(DropRecord: cell, drop),
        layout!(Streak: ends, shape, shares, light, gaps),
        layout!(LevelMapParams: corner, inverse_cell, base, cells, present, films),
        layout!(WaterLook: absorption, mud, ambient, ripples, waves, place, map, more_map),
        layout!(ReflectionParams: clip_from_eye, eye, plane),
        layout!(WaterMapPlaces: fine, middle, coarse, fine_centre, middle_centre, coarse_centre, pad),
        layout!(SurfaceParams: eye, state, artist, cover, levels, water, mirrors, map, caustics),
        layout!(MaskView: eye_from_clip, screen, corner, surface),
        layout!(WaveParams: cells, periodic, offset, moved, first_source, first_bin, courant_squared, g, keep, inverse_keep,
            blend, per_cell, rim, rim_damping, hidden_variance, pad_a, pad_b, pad_c),
        layout!(WaveSource: low, count, start, along, length, per_width, height, back),
        layout!(WaveBin: place, first, count, pad),
        layout!(RingLayerParams: parts, weights, wholes, cycles, offset_x, offset_z, cells, texels, repeats, by_number,
            steepness, hidden_variance, pad_a, pad_b),
        layout!(CausticParams: towards, per_side, strength, blur, pad_a),
        layout!(ColumnRules: capacity, texture, drain, soil, dry_soil, soil_decay, recovery, pad),
        layout!(WaterMapParams: rules, cover, offset, kept, seed_low, seed_cells, ground_cells, ground_corner, corner,
            texels, level, cell, ground_step, per_ground_cell, base, rain, evaporation, time, pools),
        layout!(WaterStamp: low, count, start, along, length, half, share, aside, band, slot, pad_a, pad_b),
        layout!(StreakTile: texels, first, drops, pad_a, path, unit, steps, pad_b),
        layout!(StreakLevel: side, first, above, words, row, pad_a, pad_b, pad_c),
        layout!(TileDrop: x, y, diameter, share),
        layout!(LampParams: place, intensity, direction, limits),
        layout!(LatticeParams: clip_from_eye, environment, ambient, sun_direction, sun, fog, near, contrast, soft, cards,
            lamps, panes, pad_b, pad_c, cover, lamp, pane),
        layout!(FarRainParams: clip_from_eye, environment, ambient, sun_direction, sun, axis, cloud, thin, pad_b, pad_c),
        layout!(FarParticle: centre, presence, half_width, phase, rank, level),
        layout!(Card: centre, facing, turn, place, layers),
        layout!(SplashView: clip_from_eye, clip_from_eye_before, environment, ambient, sun_direction, sun, planes, rays, wind,
            stream, viewport, fraction, cell, focal, near, exposure, contrast, soft, reach, near_reach, film, since, span,
            capacity, lamps, panes, feet, mouths, mouth_reach, shares, cover, levels, counts, limits, classes, lamp, pane, foot),
        layout!(SplashPart: ends, shape, light, form),
        layout!(SplashFind: part, id, number, pad_a, pad_b),
        layout!(LensView: viewport, arms, turns, cycle, size, half_tan, distance, aperture, mist, mist_per_s, wiping, pad_a,
            pad_b, pad_c),
        layout!(LensDrop: place, along, radius, stretch, key, pad_a),
        layout!(SplashDraw: vertices, instances, first_vertex, first_instance, found, noted),
        layout!(HazeLamp: place, light, axis),
        layout!(HazeView: eye_from_clip, clip_from_eye, environment, ambient, sun_direction, sun, forward,
            depth_row, air, viewport, fog, extinction, efficiency, cloud, limit, artist, coloured, uneven, lamps, grid, far, splash,
            cover, drawn, rates, lamp),
    ]
}
