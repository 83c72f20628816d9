// Structs of splashes and spouts that cross from the CPU: the rest of types.wgsl.

// A step in water.
struct SplashFoot {
    // Where, on the water; w: seconds since.
    place: vec4<f32>,
    // Tells it from all others; w: bits of its strength, 0..1.
    key: vec4<u32>,
}

// Water that leaves one mouth of an eave or a pipe: parcels that are let go one after the other.
struct SpoutMouth {
    // Where, relative to the eye; w: seconds between parcels.
    place: vec4<f32>,
    // At which it leaves; w: terminal speed, m/s.
    velocity: vec4<f32>,
    // Diameter of the jet, m; seconds until it has broken up, 0: it drips; diameter of drops, mm; drops that a parcel shows.
    form: vec4<f32>,
    // Share of the next parcel that has gathered; seconds until it has fallen as far as is looked for ground; away from
    // the roof (x, z).
    state: vec4<f32>,
    // Tells it from all others; z: number of the newest parcel; w unused.
    key: vec4<u32>,
}

// A view of splashes. Positions are relative to the eye.
struct SplashView {
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
    // Four side planes through the eye, unit normals inward; w: their offset, m.
    planes: array<vec4<f32>, 4>,
    // From where light is seen to the eye, m: 0, or far back along the rays of a view without perspective; w: 1 in such a view.
    rays: vec4<f32>,
    // Where the air goes, m/s; w unused.
    wind: vec4<f32>,
    // Random stream; w: the present time slot.
    stream: vec4<u32>,
    // Width and height, px.
    viewport: vec2<f32>,
    // The eye in its cell, in cells.
    fraction: vec2<f32>,
    // Cell under the eye (x, z).
    cell: vec2<i32>,
    // Focal length, px; px/m without perspective.
    focal: f32,
    // Near plane, m.
    near: f32,
    // Shutter time, s.
    exposure: f32,
    // Contrast gain, 1 = physical.
    contrast: f32,
    // Fade against the scene over at most this distance, m; 0 = hard depth test only.
    soft: f32,
    // How far crowns and thrown drops are drawn, m.
    reach: f32,
    near_reach: f32,
    // Film outside puddles, mm.
    film: f32,
    // Since the slot began, s.
    since: f32,
    // Cells on each side of the eye's.
    span: u32,
    // Room in the list of parts.
    capacity: u32,
    lamps: u32,
    panes: u32,
    // Steps whose splashes are drawn.
    feet: u32,
    // Mouths that water pours from, and how far they are seen, m.
    mouths: u32,
    mouth_reach: f32,
    // What is drawn of crowns and of thrown drops at any distance.
    shares: vec2<f32>,
    cover: CoverParams,
    levels: LevelMapParams,
    // Tables of SplashField in rain_core: of counts and of classes, a hash each.
    counts: array<vec4<u32>, 32>,
    limits: array<vec4<u32>, 3>,
    // Start, span and bend of the diameters of a class; w: weight.
    classes: array<vec4<f32>, 12>,
    lamp: array<LampParams, 64>,
    pane: array<GlassPane, 8>,
    foot: array<SplashFoot, 8>,
}

// A crown or a thrown drop to draw.
struct SplashPart {
    // Drops: head and tail, px. Crowns: foot, px, and the direction of the normal on the screen.
    ends: vec4<f32>,
    // Drops: depth of head and tail, half width px, opacity. Crowns: depth, radius and height px, opacity.
    shape: vec4<f32>,
    // Radiance; w: coverage.
    light: vec4<f32>,
    // x: 1 for a crown; y: half the depth of its foot's ellipse, px, z: its jets, 0..1, above for many; w: softness, m,
    // below 0 behind what is transparent.
    form: vec4<f32>,
}

// A part as it was found.
struct SplashFind {
    part: SplashPart,
    // Its cell and slot, and its number there.
    id: u32,
    number: u32,
    pad_a: u32,
    pad_b: u32,
}

// Arguments of the draw, and how many parts there were.
struct SplashDraw {
    vertices: u32,
    instances: u32,
    first_vertex: u32,
    first_instance: u32,
    found: u32,
    // Parts noted so far in this frame; 0 between frames.
    noted: atomic<u32>,
}
