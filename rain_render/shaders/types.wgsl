// Structs that cross from the CPU; one for each struct in gpu_types.rs, compared member by member by a test.

// The depth map along the rain. Positions are relative to the eye, in metres.
struct CoverParams {
    // Map centre on the reference plane, relative to the eye (x, z).
    centre: vec2<f32>,
    // Horizontal wind (x, z), m/s.
    wind: vec2<f32>,
    // 1 / side of the map, 1/m.
    inverse_extent: f32,
    // Height of depth 1 above the eye, m.
    top: f32,
    // Height between depth 0 and depth 1, m.
    range: f32,
    // Height of the highest occluder above the eye, m.
    highest: f32,
    // Height of the reference plane above the eye, m.
    plane: f32,
    // Flux mean of 1/v, s/m.
    inverse_speed: f32,
    // Texels per side.
    texels: f32,
    // 1 when there is a map, 0 for open sky.
    present: f32,
}

struct RainfallClass {
    // Lattice cell of the eye; w unused.
    cell: vec4<i32>,
    // The eye inside its cell, in cells; w: cell edge, m.
    fraction: vec4<f32>,
    // Velocity, m/s; w: 1 / fall speed, s/m.
    velocity: vec4<f32>,
    // Random stream of the class; w unused.
    stream: vec4<u32>,
    // x: e^(-2 Dmin), y: e^(-2 Dmin) - e^(-2 Dmax), z, w unused.
    diameter: vec4<f32>,
}

// A point or spot light.
struct LampParams {
    // Relative to the eye, m; w: radius, m.
    place: vec4<f32>,
    // Illuminance at a metre, exposed; w: cosine of the angle up to which it is whole, -1 for a point light.
    intensity: vec4<f32>,
    // Where a spot looks; w: cosine of the angle at which it ends, -2 for a point light.
    direction: vec4<f32>,
    // x: 1 / square of the range, 1/m2.
    limits: vec4<f32>,
}

// A box that is seen through. Its axes over their half lengths, 1/m; w: the eye in its own frame, where it reaches from
// -1 to 1.
struct GlassPane {
    along: vec4<f32>,
    up: vec4<f32>,
    across: vec4<f32>,
}

struct RainfallView {
    // Eye-relative world to clip, at the end of the exposure.
    clip_from_eye: mat4x4<f32>,
    // The same at its start, the eye's motion included.
    clip_from_eye_before: mat4x4<f32>,
    // Radiance scale of the environment map; w: its highest mip level.
    environment: vec4<f32>,
    // Uniform surrounding radiance.
    ambient: vec4<f32>,
    // Direction towards the sun; w unused.
    sun_direction: vec4<f32>,
    // Illuminance of the sun, exposed; w unused.
    sun: vec4<f32>,
    // How far the container reaches ahead of the eye, or across a view without perspective, m; w: height of the eye, m.
    lead: vec4<f32>,
    // From where light is seen to the eye, m: 0, or far back along the rays of a view without perspective; w: 1 in such a view.
    rays: vec4<f32>,
    // A drop's size over its own by distance d: x + y d + z d2; w: d for a metre.
    size: vec4<f32>,
    // Corner and size of the view in the target, px.
    viewport: vec4<f32>,
    // Focal length, px.
    focal: f32,
    // Near plane, m.
    near: f32,
    // Shutter time, s.
    exposure: f32,
    // Contrast gain, 1 = physical.
    contrast: f32,
    // Quality: multiple of the range at which a streak is one 8-bit step.
    kappa: f32,
    // Fade against the scene over this distance, m; 0 = hard depth test only.
    soft: f32,
    lamps: u32,
    panes: u32,
    // 1: near streaks have a pattern.
    patterned: u32,
    // Share of the viewport that the view takes, each way.
    guard_share: f32,
    pad_b: u32,
    pad_c: u32,
    cover: CoverParams,
    classes: array<RainfallClass, 12>,
    lamp: array<LampParams, 64>,
    pane: array<GlassPane, 8>,
}

// Cells of a class's lattice that may hold drops of a view.
struct ChoiceClass {
    // Lowest cell, from the eye's; w: how many rows of cells along the first axis all classes before have.
    low: vec4<i32>,
    // Cells along each axis; w: neighbours along the first that are looked through together, a run, at most 16.
    side: vec4<u32>,
    // How many runs of all classes come before, and how many this class has; drops of a run that there is room for on the
    // stage, and where its part begins.
    runs: vec4<u32>,
    // No drop has a rank above x, all up to y are there wholly; z: threshold at a diameter of 0, w: slope of its ln, 1/mm.
    ranks: vec4<f32>,
    // Reach of the largest drops, of the smallest, and of what may have a pattern, m; w unused.
    reach: vec4<f32>,
    // Offsets of the side planes, moved out for streaks that reach in over them, m.
    out: vec4<f32>,
}

// What the drops of a view are chosen from.
struct RainfallChoice {
    // Inward normals of the view's side planes; w unused: their offsets are the classes'.
    planes: array<vec4<f32>, 4>,
    // Container that follows the view. Half its width, half its height, how far ahead, and 0 none, 1 half a cylinder, 2 a block.
    region: vec4<f32>,
    // Its middle from the eye, m; w: its slack, m.
    region_place: vec4<f32>,
    // How far the choice reaches ahead of the eye, m; w unused.
    lead: vec4<f32>,
    // The same over the square of its length, 1/m; w: 1 where it is not 0.
    along: vec4<f32>,
    // Sine and cosine of its heading; z: its rim, m; w unused.
    region_turn: vec4<f32>,
    // Ladder of rates: ln of the first, knots a factor of e, knots; w unused.
    ladder: vec4<f32>,
    // Runs of cells of all classes, and groups of them.
    runs: u32,
    groups: u32,
    // No more drops are drawn.
    most: u32,
    // Draws that drops are divided into.
    draws: u32,
    // Law of detail: 0 none, 1 optical depth, 2 quadratic, 3 Gaussian.
    detail: u32,
    // Quality, focal length in px, shutter time in s, of the choice.
    kappa: f32,
    focal: f32,
    exposure: f32,
    // Rows of cells of all classes.
    rows: u32,
    // 1: a view without perspective.
    parallel: u32,
    pad_b: u32,
    pad_c: u32,
    classes: array<ChoiceClass, 12>,
}

// See `DropRecord` in rain_core.
struct DropRecord {
    cell: u32,
    drop: u32,
}

// A projected streak.
struct Streak {
    // Head and tail, px from the upper left corner.
    ends: vec4<f32>,
    // Depth of head and tail, half width px (0: not drawn, below 0: behind what is transparent).
    shape: vec3<f32>,
    // Opacity, and coverage of a pixel by the swept drop, as halves.
    shares: u32,
    // Radiance.
    light: vec3<f32>,
    // Distance from head and tail to the scene behind them in lengths of the fade, as halves.
    gaps: u32,
}

// Levels of standing water over the ground, one texel a cell. Positions are relative to the eye, in metres.
struct LevelMapParams {
    // Corner of the first cell (x, z).
    corner: vec2<f32>,
    // 1 / edge of a cell, 1/m.
    inverse_cell: f32,
    // Height of level 0 above the eye.
    base: f32,
    // Cells along x and z.
    cells: vec2<f32>,
    // 1 when there is a map, 0 for none.
    present: f32,
    // 1 when there is a map of films in the same cells.
    films: f32,
}

// How standing water looks.
struct WaterLook {
    // Absorption of the water, 1/m; w: strength of the ripples, 0 for none.
    absorption: vec4<f32>,
    // Albedo of its mud; w: turbidity, 1/m.
    mud: vec4<f32>,
    // Wind waves. x: mean square slope on open water, y: 1 / length of the longest, 1/m, z, w: direction times speed,
    // m/s.
    ambient: vec4<f32>,
    // Ripple tile. x: 1 / side, 1/m, y, z: the eye's place in the tile in sides, w: 1 when there is one.
    ripples: vec4<f32>,
    // Wave tile. x, y: its corner (x, z), z: 1 / side, 1/m, w: 1 when there is one.
    waves: vec4<f32>,
    // x, y: the eye's place in the tile of the wind's waves, in sides; z, w unused.
    place: vec4<f32>,
    // Normal maps of waves. x: 1 / side, 1/m, y, z: the eye's place in the map in sides, w: strength, 0 without maps.
    map: vec4<f32>,
    // The second map, likewise; w: share of the light that standing water mirrors, 0..1.
    more_map: vec4<f32>,
}

// A mirrored view, in the layer of the same number.
struct ReflectionParams {
    // Eye-relative world to the mirrored view's clip space.
    clip_from_eye: mat4x4<f32>,
    // World position of the eye it belongs to, m; w: strength, 0 when there is none.
    eye: vec4<f32>,
    // x: height of the mirror above the eye, m; y, z, w: where the eye it belongs to looks.
    plane: vec4<f32>,
}

// Where the levels of the water map lie. Of each: x, y: the eye's place in the map in sides, z: 1 / side, 1/m, w: how far
// from its centre it holds, m; 0: not at all. Centres: x, z from the eye, m.
struct WaterMapPlaces {
    fine: vec4<f32>,
    middle: vec4<f32>,
    coarse: vec4<f32>,
    fine_centre: vec2<f32>,
    middle_centre: vec2<f32>,
    coarse_centre: vec2<f32>,
    pad: vec2<f32>,
}

// What the wet look and the wet mask read.
struct SurfaceParams {
    // World position of the eye, m; w: time in s, from 0 to 4096.
    eye: vec4<f32>,
    // x: wetness 0..1, y: water level mm, z: texture depth mm, w: rain mm/h.
    state: vec4<f32>,
    // Artists' levels, 0..1. x: wetness, y: holes, z: puddles, w: 1 when they rule, 0 when the physical state does.
    artist: vec4<f32>,
    cover: CoverParams,
    levels: LevelMapParams,
    water: WaterLook,
    mirrors: array<ReflectionParams, 4>,
    map: WaterMapPlaces,
    // Light that water throws onto walls. x, y, z: towards the light, w: gain, 0 for none.
    caustics: vec4<f32>,
}

struct MaskView {
    // Clip to eye-relative world.
    eye_from_clip: mat4x4<f32>,
    // x: near plane m, y: width px, z: height px, w: 1 where the view of masks shows what wet materials know.
    screen: vec4<f32>,
    // x, y: upper left corner of the view in its target, px.
    corner: vec4<f32>,
    surface: SurfaceParams,
}

// A step of a wave tile.
struct WaveParams {
    // Cells on a side, a power of two.
    cells: u32,
    // 1 where what leaves on one side enters on the other.
    periodic: u32,
    // Where cell (0, 0) is stored; what passes the end goes on at the start.
    offset: vec2<u32>,
    // Cells by which the tile has moved since its levels were written.
    moved: vec2<i32>,
    // First source and first bin of this step.
    first_source: u32,
    first_bin: u32,
    // (c dt/dx)² of the fastest wave.
    courant_squared: f32,
    // Share of u - u⁻ that damping leaves in a step.
    g: f32,
    // Share of the height that is left after a step, and 1 over it.
    keep: f32,
    inverse_keep: f32,
    // Part of the last step that is shown, 0..1.
    blend: f32,
    // 1 / cell, 1/m.
    per_cell: f32,
    // Width of the absorbing rim, cells; 0: none.
    rim: f32,
    // a = k dt/2 at its outer edge.
    rim_damping: f32,
    // Variance of the slopes that the cells cannot show.
    hidden_variance: f32,
    pad_a: u32,
    pad_b: u32,
    pad_c: u32,
}

// A source of waves on a straight way; see SweptSource in rain_core.
struct WaveSource {
    // Lowest cell of its box, and number of cells.
    low: vec2<i32>,
    count: vec2<u32>,
    // Start of the way from the corner of the lowest cell, cells.
    start: vec2<f32>,
    // Unit vector along the way.
    along: vec2<f32>,
    // Length of the way over the width.
    length: f32,
    // Cell over the width.
    per_width: f32,
    // Rise for each weight, m.
    height: f32,
    // Change of the level before for each Laplacian, m.
    back: f32,
}

// Eight by eight cells that sources reach.
struct WaveBin {
    // x in the lower, z in the upper half.
    place: u32,
    // Its first entry in the list of sources, and how many.
    first: u32,
    count: u32,
    pad: u32,
}

// Procedural rings of four layers at a moment; see RingLayers in rain_core. A component for each layer.
struct RingLayerParams {
    // Part of the present cycle, 0..1.
    parts: vec4<f32>,
    // Weight, 0..1.
    weights: vec4<f32>,
    // Whole cycles before it, and their number after which they start anew.
    wholes: vec4<u32>,
    cycles: vec4<u32>,
    // How far the layer is moved, texels of the circle texture.
    offset_x: vec4<u32>,
    offset_z: vec4<u32>,
    // Texels of the map and of the circle texture on a side, powers of two.
    cells: u32,
    texels: u32,
    // How often the circle texture lies along a side.
    repeats: u32,
    // 1 where layers grow by the number of their rings, 0 by strength.
    by_number: u32,
    // Slope of a ring for a profile of 1.
    steepness: f32,
    // Variance of the slopes of rings that are not drawn.
    hidden_variance: f32,
    pad_a: u32,
    pad_b: u32,
}

// Mirrored rays of a frame.
struct CausticParams {
    // Unit vector towards the light; w unused.
    towards: vec4<f32>,
    // 1 / side of the tile, 1/m.
    per_side: f32,
    // Multiple of the slopes.
    strength: f32,
    // Radius of the sun's disc for each metre of way, texels.
    blur: f32,
    pad_a: f32,
}

// What a surface does with water, in mm and s; see ColumnRules in rain_core.
struct ColumnRules {
    // What the pores hold, mm.
    capacity: f32,
    // What the texture holds, mm.
    texture: f32,
    // Drain, mm^(-2/3)/s.
    drain: f32,
    // Infiltration in the long run, mm/s, and what dry soil takes beyond that.
    soil: f32,
    dry_soil: f32,
    // Its decay, 1/s.
    soil_decay: f32,
    // Recovery in dry spells, 1/s.
    recovery: f32,
    pad: f32,
}

// One level of the water map over an interval. Texels count from the lowest corner of the level.
struct WaterMapParams {
    rules: array<ColumnRules, 7>,
    cover: CoverParams,
    // Where texel (0, 0) is stored; what passes the end goes on at the start.
    offset: vec2<u32>,
    // Texel (0, 0) of the level as it was: what lies outside it is new.
    kept: vec2<i32>,
    // First ground cell that seeds are given for, and how many.
    seed_low: vec2<i32>,
    seed_cells: vec2<i32>,
    // Cells of the ground, and the level's corner among them, in cells.
    ground_cells: vec2<i32>,
    ground_corner: vec2<f32>,
    // The level's corner (x, z) from the origin of the cover map's positions, m.
    corner: vec2<f32>,
    // Texels on a side, a power of two.
    texels: u32,
    level: u32,
    // Edge of a texel, m, and in ground cells.
    cell: f32,
    ground_step: f32,
    // 1 / edge of a ground cell, 1/m.
    per_ground_cell: f32,
    // Height of the ground's base over the origin, m.
    base: f32,
    // Over open ground, mm/s.
    rain: f32,
    evaporation: f32,
    // Length of the interval, s; 0: only new texels are filled.
    time: f32,
    // 1 when the map of levels of standing water holds the same cells.
    pools: f32,
}

// A wheel or a foot on its straight way; see Ground::press in rain_core.
struct WaterStamp {
    // Lowest texel of its box, and number of texels.
    low: vec2<i32>,
    count: vec2<i32>,
    // Start of the way from the corner of the level, m, and unit vector along it.
    start: vec2<f32>,
    along: vec2<f32>,
    // Length and half width, m.
    length: f32,
    half: f32,
    // Share of the film that goes, and share of this that is laid beside.
    share: f32,
    aside: f32,
    // Width of the bands beside, m.
    band: f32,
    // Where its sums are.
    slot: u32,
    pad_a: u32,
    pad_b: u32,
}

// A streak texture's layer while it is drawn.
struct StreakTile {
    // Texels a side of the finest level.
    texels: u32,
    // First drop and number of drops.
    first: u32,
    drops: u32,
    pad_a: u32,
    // Length of every streak without its ends, texels.
    path: f32,
    // Opacity of a texel of value 1.
    unit: f32,
    // Steps of the overlap sum in one unit.
    steps: f32,
    pad_b: u32,
}

// A level of a layer while it is made.
struct StreakLevel {
    // Texels a side.
    side: u32,
    // Where its texels begin, and those of the level above it.
    first: u32,
    above: u32,
    // Where its rows begin among the packed words, and words a row.
    words: u32,
    row: u32,
    pad_a: u32,
    pad_b: u32,
    pad_c: u32,
}

// A drop of a streak texture, in texels.
struct TileDrop {
    // Where its streak begins; y runs along the fall.
    x: f32,
    y: f32,
    diameter: f32,
    // Opacity over that of a whole drop.
    share: f32,
}

// A view of the lattice.
struct LatticeParams {
    // Eye-relative world to clip.
    clip_from_eye: mat4x4<f32>,
    // Radiance scale of the environment map; w: its highest mip level.
    environment: vec4<f32>,
    // Uniform surrounding radiance; w unused.
    ambient: vec4<f32>,
    // Direction towards the sun; w unused.
    sun_direction: vec4<f32>,
    // Illuminance of the sun, exposed; w unused.
    sun: vec4<f32>,
    // Radiance of haze before a card; w unused.
    fog: vec4<f32>,
    // Near plane, m.
    near: f32,
    // Contrast gain, 1 = physical.
    contrast: f32,
    // 1 when the scene's depth fades cards, 0 when it only hides them.
    soft: f32,
    cards: u32,
    lamps: u32,
    panes: u32,
    pad_b: u32,
    pad_c: u32,
    cover: CoverParams,
    lamp: array<LampParams, 64>,
    pane: array<GlassPane, 8>,
}

// A cell's picture of one class; see `Card` in rain_core.
struct Card {
    centre: vec4<f32>,
    facing: vec4<f32>,
    turn: vec4<f32>,
    place: vec4<f32>,
    layers: vec4<u32>,
}

// A view of far rain.
struct FarRainParams {
    // Eye-relative world to clip.
    clip_from_eye: mat4x4<f32>,
    // Radiance scale of the environment map; w: its highest mip level.
    environment: vec4<f32>,
    // Uniform surrounding radiance; w unused.
    ambient: vec4<f32>,
    // Direction towards the sun; w unused.
    sun_direction: vec4<f32>,
    // Illuminance of the sun, exposed; w unused.
    sun: vec4<f32>,
    // Unit direction that particles are drawn out along; w unused.
    axis: vec4<f32>,
    // Base of the cloud over the eye, and how far below it rain thins out, m.
    cloud: f32,
    thin: f32,
    pad_b: f32,
    pad_c: f32,
}

// A particle of far rain; see `FarParticle` in rain_core. Relative to the eye.
struct FarParticle {
    centre: vec3<f32>,
    presence: f32,
    half_width: f32,
    phase: f32,
    rank: f32,
    level: f32,
}

// A lamp that glows in the haze.
struct HazeLamp {
    // From the eye, m; w: radius, m.
    place: vec4<f32>,
    // Luminous intensity, exposed, cd; w: cosine of the outer half angle, -1 where it shines all around.
    light: vec4<f32>,
    // Where it shines; w: cosine of the inner half angle.
    axis: vec4<f32>,
}

// A view of haze. Positions are relative to the eye.
struct HazeView {
    eye_from_clip: mat4x4<f32>,
    clip_from_eye: mat4x4<f32>,
    // Scale of the environment map, w: its highest level; even light around, exposed.
    environment: vec4<f32>,
    ambient: vec4<f32>,
    // w: how much of the haze is the artists' fog.
    sun_direction: vec4<f32>,
    sun: vec4<f32>,
    // Where the view looks; w: 0.
    forward: vec4<f32>,
    // Row of the projection that makes depth, for places about the eye.
    depth_row: vec4<f32>,
    // Mist, 1/m; height of a mirror over the eye, m, 0: none; gain of the rainbow, 0: none; what of the sun's light the
    // haze shows.
    air: vec4<f32>,
    // Corner and size of the view in the target, px.
    viewport: vec4<f32>,
    // The artists' fog: colour, times the luminance around; w: how much of its colour it has lost.
    fog: vec4<f32>,
    // Extinction of the rain at the eye, or everywhere, 1/m, and over cross-section, Q.
    extinction: f32,
    efficiency: f32,
    // Base of the cloud over the eye, and the longest way, m.
    cloud: f32,
    limit: f32,
    // The artists' fog, 1/m, and how much of it has a colour of its own.
    artist: f32,
    coloured: f32,
    // 1: areas divide the rain.
    uneven: f32,
    lamps: u32,
    // Areas' grid: first azimuth and step, rad; scale of its knots; knots of rates for each unit of ln.
    grid: vec4<f32>,
    // Far rain, which is drawn as particles: its share of what may be; extinction of the rain outside areas, 1/m. z: how far
    // below the cloud's base rain thins out, m.
    far: vec4<f32>,
    // Mist of splashes: extinction at its foot, 1/m, and height, m, of what is thrown, of what wind carries; what rain hits.
    splash: vec4<f32>,
    cover: CoverParams,
    // Metres of rain that what is drawn stands for, by distance.
    drawn: array<vec4<f32>, 16>,
    // ln of the extinction, 1/m, by rate.
    rates: array<vec4<f32>, 16>,
    lamp: array<HazeLamp, 16>,
}

// A view through a glass in the rain. Places on the glass: m from where the view's axis meets it, x right, y up.
struct LensView {
    // Corner and size of the view in its target, px.
    viewport: vec4<f32>,
    // Arms: pivot (m), begin and end of the blade (m from it).
    arms: array<vec4<f32>, 2>,
    // Their angle at rest, at the far end and (w) now, rad; z: 1 where there is an arm.
    turns: array<vec4<f32>, 2>,
    // Wipers: period, moving part of it, time in it, time since they were started, s.
    cycle: vec4<f32>,
    // Size of the target, px.
    size: vec2<f32>,
    // Tangents of half the view's angles.
    half_tan: vec2<f32>,
    // From the eye to the glass, m.
    distance: f32,
    // Width of what sees through the glass, m.
    aperture: f32,
    // Share of glass that was not wiped that the mist covers.
    mist: f32,
    // How fast clear glass is covered, 1/s.
    mist_per_s: f32,
    // 1 while the wipers go.
    wiping: f32,
    pad_a: f32,
    pad_b: f32,
    pad_c: f32,
}

// A drop on the glass.
struct LensDrop {
    // m.
    place: vec2<f32>,
    // Unit vector of its longer axis.
    along: vec2<f32>,
    // Across, m.
    radius: f32,
    // Length over width.
    stretch: f32,
    // For its outline.
    key: u32,
    pad_a: u32,
}
