//! What one walks and drives on: asphalt, road paint, setts, slabs, kerb stones, grates.

use super::{Picture, Texel, bake, depth, grey, srgb};
use crate::noise::{Rng, cellular, fbm, lattice, smoothstep, value};
use glam::{Vec3, vec3};

/// Width of the large asphalt picture, metres: the whole carriageway.
pub const ASPHALT_WIDTH_M: f32 = 7.0;
/// Length of the large asphalt picture, metres.
pub const ASPHALT_LENGTH_M: f32 = 14.0;
/// Size of the small asphalt tile that holds relief and roughness, metres.
pub const ASPHALT_DETAIL_M: f32 = 2.0;
/// Width and height of a tile of setts, metres.
pub const SETTS_TILE_M: f32 = 1.6;
const SETTS_PX: [u32; 2] = [512, 512];

/// Where a line wanders to about x = `centre` at `v`, metres.
fn wandering(seed: u32, v: f32, centre: f32, sway: f32) -> f32 {
    centre + (fbm(seed, 0.0, v, 1, 9, 3) - 0.5) * sway
}

/// Rubber that braking tyres left on the carriageway.
struct SkidMark {
    /// Middle of the track, metres from the picture's left edge.
    x: f32,
    /// Where it starts, metres, and how long it is.
    z: f32,
    length: f32,
    /// Share of the light that it takes where it is darkest.
    strength: f32,
}

/// The skid marks of a seed: pairs, as a car leaves them, two to five of them.
fn skid_marks(seed: u32) -> Vec<SkidMark> {
    let mut rng = Rng::new(seed.into(), 55);
    let cars = 2 + rng.below(4);
    let mut marks = Vec::with_capacity(2 * cars);
    for _ in 0..cars {
        let lane = if rng.unit() < 0.5 { 1.75 } else { 5.25 };
        let middle = lane + rng.range(-0.35, 0.35);
        let (z, length) = (rng.range(0.0, ASPHALT_LENGTH_M), rng.range(2.0, 5.5));
        let strength = rng.range(0.12, 0.3);
        for side in [-0.75, 0.75] {
            let strength = strength * rng.range(0.6, 1.0);
            marks.push(SkidMark {
                x: middle + side,
                z,
                length,
                strength,
            });
        }
    }
    marks
}

/// Share of the light that rubber takes at (x, z). The picture repeats along z.
fn rubber(marks: &[SkidMark], x: f32, z: f32) -> f32 {
    marks.iter().fold(0.0_f32, |most, mark| {
        let along = (z - mark.z).rem_euclid(ASPHALT_LENGTH_M) / mark.length;
        // Tyres of 18 cm grip harder and harder, then the car stands.
        let across = 1.0 - smoothstep(0.07, 0.1, (x - mark.x).abs());
        let taken = mark.strength * across * smoothstep(0.0, 0.7, along) * (1.0 - smoothstep(0.97, 1.0, along));
        most.max(taken)
    })
}

/// The carriageway's colour across its full width: aggregate, polished tracks, skid marks, oil, patches, tar seams,
/// cracks.
#[must_use]
pub fn asphalt_colour(seed: u32) -> Picture {
    let (w, h) = (768, 1536);
    // Patches of newer asphalt: x and z range in metres within the picture.
    let patches = [
        (0.5, 2.3, 1.2, 3.4),
        (4.4, 5.1, 0.0, 14.0),
        (3.9, 6.2, 8.3, 10.6),
        (1.0, 1.9, 7.4, 11.9),
    ];
    // By row: the joint between the lanes, a crack that someone has sealed, and where that one is hidden.
    let rows: Vec<[f32; 3]> = (0..h)
        .map(|py| {
            let v = (py as f32 + 0.5) / h as f32;
            let hidden = 0.08 * smoothstep(0.3, 0.5, value(seed ^ 52, 0.0, v, 1, 5));
            [
                wandering(seed ^ 50, v, 3.42, 0.04),
                wandering(seed ^ 51, v, 2.5, 1.6),
                hidden,
            ]
        })
        .collect();
    let marks = skid_marks(seed);
    Picture::new("asphalt-color", w, h, 3, move |px, py| {
        let (u, v) = ((px as f32 + 0.5) / w as f32, (py as f32 + 0.5) / h as f32);
        let (x, z) = (u * ASPHALT_WIDTH_M, v * ASPHALT_LENGTH_M);
        let large = fbm(seed, u, v, 4, 8, 4) - 0.5;
        let speck = lattice(seed ^ 7, px as i32, py as i32) - 0.5;
        let stone = value(seed ^ 9, u, v, 384, 768) - 0.5;
        let mut a = 0.118 + 0.05 * large + 0.035 * speck + 0.04 * stone;
        // Tyres polish two tracks in each lane; oil darkens the middle of the lane.
        let wander = fbm(seed ^ 40, u, v, 14, 28, 2) - 0.5;
        for lane in [1.75_f32, 5.25] {
            for track in [lane - 0.75, lane + 0.75] {
                a += 0.012 * (1.0 - smoothstep(0.1, 0.4, (x - track).abs()));
            }
            let off = (x - lane).abs();
            if off < 0.45 {
                a -= 0.018 * (1.0 - smoothstep(0.05, 0.45, off)) * (0.4 + fbm(seed ^ 3, u, v, 2, 12, 3));
            }
        }
        let mut seam = f32::MAX;
        for (k, &(x0, x1, z0, z1)) in patches.iter().enumerate() {
            let inside = (x - x0).min(x1 - x).min(z - z0).min(z1 - z) + 0.04 * wander;
            if inside > 0.0 {
                a += [-0.022, 0.014, -0.016, 0.012][k] + 0.01 * speck;
            }
            seam = seam.min(inside.abs());
        }
        a *= 1.0 - rubber(&marks, x, z) * (0.75 + 0.5 * stone);
        let [joint, crack, hidden] = rows[py as usize];
        let seam = seam.min((x - joint).abs()).min((x - crack).abs() + hidden);
        let tar = 1.0 - smoothstep(0.008, 0.02, seam + 0.016 * wander.abs());
        if tar > 0.0 {
            // Worn off here and there.
            a *= 1.0 - (0.2 + 0.3 * smoothstep(0.35, 0.6, fbm(seed ^ 53, u, v, 9, 18, 3))) * tar;
        }
        // Open cracks: the borders of warped cells, where the ground is worn.
        let worn = smoothstep(0.55, 0.68, fbm(seed ^ 61, u, v, 3, 6, 3));
        if worn > 0.0 {
            let (wu, wv) = (
                fbm(seed ^ 62, u, v, 12, 24, 4) - 0.5,
                fbm(seed ^ 63, u, v, 12, 24, 4) - 0.5,
            );
            let c = cellular(seed ^ 60, u + 0.1 * wu, v * 2.0 + 0.1 * wv, 9);
            a *= 1.0 - 0.42 * worn * (1.0 - smoothstep(0.004, 0.03, c.next - c.near));
        }
        let a = a.clamp(0.03, 0.3);
        // Steps of 4 are lost in the grain and save a third of the file.
        let c = srgb(a) & 0xfc;
        [c.saturating_add(2), c, c.saturating_sub(2), 255]
    })
}

/// Relief and roughness of asphalt: rounded stones of 8 to 12 mm in a dark binder.
#[must_use]
pub fn asphalt_relief(seed: u32) -> Vec<Picture> {
    let mut maps = bake("asphalt-detail", [512, 512], [ASPHALT_DETAIL_M; 2], move |u, v| {
        let c = cellular(seed ^ 70, u, v, 150);
        let stone = (1.0 - c.near * c.near).max(0.0) * (0.4 + 0.6 * c.id);
        let large = fbm(seed ^ 71, u, v, 5, 5, 3) - 0.5;
        let height = 0.0016 * stone + 0.002 * large;
        let mut t = Texel::new(grey(0.1), height, 0.86 + 0.12 * (0.5 - large) - 0.06 * stone);
        t.open = 0.8 + 0.2 * stone;
        t
    });
    maps.remove(0);
    maps
}

/// Worn white road paint on asphalt, a tile of 2 m.
#[must_use]
pub fn road_paint(seed: u32) -> Vec<Picture> {
    bake("road-paint", [512, 512], [2.0; 2], move |u, v| {
        let c = cellular(seed ^ 70, u, v, 150);
        let stone = (1.0 - c.near * c.near).max(0.0) * (0.4 + 0.6 * c.id);
        let wear = fbm(seed ^ 80, u, v, 6, 6, 5) + 0.18 * (stone - 0.4);
        let paint = 1.0 - smoothstep(0.53, 0.63, wear);
        let dirt = fbm(seed ^ 81, u, v, 3, 3, 4);
        let white = vec3(0.56, 0.55, 0.5) * (0.72 + 0.36 * dirt);
        let ground = grey(0.1 + 0.04 * c.id);
        Texel::new(
            ground.lerp(white, paint * 0.94),
            0.0015 * stone * (1.0 - 0.5 * paint),
            0.9 - 0.2 * paint,
        )
    })
}

/// Granite setts of 10 cm in rows, a tile of 1.6 m.
#[must_use]
pub fn setts(seed: u32) -> Vec<Picture> {
    bake("setts", SETTS_PX, [SETTS_TILE_M; 2], sett(seed))
}

/// How deep setts and their joints lie, for bump offset and standing water: 0 the highest stone, 1 the lowest joint.
#[must_use]
pub fn setts_depth(seed: u32) -> Picture {
    depth("setts-depth", SETTS_PX, sett(seed))
}

fn sett(seed: u32) -> impl Fn(f32, f32) -> Texel {
    let n = 16;
    move |u, v| {
        let row = (v * n as f32).floor() as i32;
        let shift = lattice(seed ^ 90, row, 0);
        let x = (u + shift / n as f32) * n as f32;
        let col = (x.floor() as i32).rem_euclid(n);
        let id = lattice(seed ^ 91, col, row);
        let tilt = lattice(seed ^ 92, col, row) - 0.5;
        let wob = 0.1 * (fbm(seed ^ 93, u, v, 32, 32, 2) - 0.5);
        let (fx, fy) = (x - x.floor() - 0.5 + wob, v * n as f32 - row as f32 - 0.5 + wob);
        let r = (fx * fx * fx * fx + fy * fy * fy * fy).sqrt().sqrt();
        let top = 1.0 - smoothstep(0.36, 0.47, r);
        let grain = fbm(seed ^ 94, u, v, 96, 96, 2) - 0.5;
        let tint = vec3(1.03, 1.0, 0.95).lerp(vec3(0.93, 0.98, 1.06), lattice(seed ^ 95, col, row));
        let stone = tint * (0.15 + 0.11 * id + 0.08 * grain);
        let joint = vec3(0.075, 0.07, 0.058) * (0.8 + 0.4 * grain);
        let dome = 0.004 * (1.0 - 3.0 * (fx * fx + fy * fy)) + 0.004 * (tilt * fx + (id - 0.5) * fy);
        let mut t = Texel::new(
            joint.lerp(stone, top),
            top * (0.006 + dome) + 0.0006 * grain,
            0.93 - 0.2 * top,
        );
        t.open = 0.55 + 0.45 * top;
        t
    }
}

/// Concrete slabs of 50 cm, a tile of 2 m.
#[must_use]
pub fn slabs(seed: u32) -> Vec<Picture> {
    bake("slabs", [768, 768], [2.0; 2], move |u, v| {
        let row = (v * 4.0).floor();
        let x = u * 4.0 + 0.5 * (row % 2.0);
        let col = (x.floor() as i32).rem_euclid(4);
        let (fx, fy) = (x - x.floor(), v * 4.0 - row);
        let edge = fx.min(1.0 - fx).min(fy.min(1.0 - fy)) * 0.5;
        let chip = 0.004 * fbm(seed ^ 99, u, v, 40, 40, 2);
        let joint = 1.0 - smoothstep(0.0035, 0.0075, edge + chip - 0.002);
        let id = lattice(seed ^ 100, col, row as i32);
        let stain = fbm(seed ^ 101, u, v, 3, 3, 5) - 0.5;
        let grain = fbm(seed ^ 102, u, v, 160, 160, 2) - 0.5;
        let a = 0.3 + 0.07 * (id - 0.5) + 0.16 * stain + 0.07 * grain;
        let slab = vec3(1.02, 1.0, 0.95) * a.clamp(0.1, 0.45);
        let tilt = 0.004 * ((fx - 0.5) * (id - 0.5) + (fy - 0.5) * (lattice(seed ^ 103, col, row as i32) - 0.5));
        let gum = cellular(seed ^ 104, u, v, 7);
        let spot = if gum.id > 0.55 {
            1.0 - smoothstep(0.05, 0.07, gum.near)
        } else {
            0.0
        };
        let albedo = (slab * (1.0 - 0.35 * spot)).lerp(vec3(0.07, 0.068, 0.058), joint);
        let mut t = Texel::new(albedo, -0.004 * joint + tilt + 0.0007 * grain, 0.88 + 0.08 * stain);
        t.open = 1.0 - 0.4 * joint;
        t
    })
}

/// Kerb stones of granite one metre long, a tile of 1 m.
#[must_use]
pub fn kerb(seed: u32) -> Vec<Picture> {
    bake("kerb", [256, 256], [1.0; 2], move |u, v| {
        let grain = fbm(seed ^ 110, u, v, 128, 128, 2) - 0.5;
        let speck = lattice(seed ^ 111, (u * 256.0) as i32, (v * 256.0) as i32) - 0.5;
        let stain = fbm(seed ^ 112, u, v, 2, 2, 4) - 0.5;
        let joint = 1.0 - smoothstep(0.004, 0.008, v.min(1.0 - v));
        let a = 0.27 + 0.1 * grain + 0.07 * speck + 0.14 * stain;
        Texel::new(
            grey(a).lerp(grey(0.06), joint),
            0.0008 * grain - 0.004 * joint,
            0.85 + 0.1 * stain,
        )
    })
}

/// A cast-iron drain grate, one tile for the whole grate.
#[must_use]
pub fn grate(seed: u32) -> Vec<Picture> {
    bake("grate", [128, 128], [0.5; 2], move |u, v| {
        let slot = ((v * 9.0).fract() - 0.5).abs();
        let rim = u.min(1.0 - u).min(v.min(1.0 - v));
        let middle = (u - 0.5).abs();
        let open = smoothstep(0.2, 0.27, slot)
            .min(smoothstep(0.08, 0.1, rim))
            .min(smoothstep(0.03, 0.045, middle));
        let hole = if slot < 0.22 { 0.0 } else { open };
        let rust = fbm(seed ^ 120, u, v, 6, 6, 4);
        let iron: Vec3 = vec3(0.07, 0.062, 0.055) + vec3(0.05, 0.02, 0.005) * rust;
        let mut t = Texel::new(iron.lerp(grey(0.004), hole), -0.01 * hole, 0.62 + 0.2 * rust);
        t.open = 1.0 - 0.7 * hole;
        t
    })
}
