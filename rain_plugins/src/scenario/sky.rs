//! A generated overcast sky: what is seen behind the scene, what wet ground mirrors, and what lights it.
//!
//! Luminance follows the CIE overcast sky (Moon & Spencer 1942), L(e) = L_z (1 + 2 sin e)/3, tinted, with faint clouds.
//! Below the horizon lies ground lit by that sky. The two maps for lighting also have house fronts around the horizon.
//!
//! # Texels
//! Values are linear RGB relative to the zenith's luminance: multiply by
//! [`OvercastSky::zenith_luminance_cd_m2`] (Bevy: `Skybox::brightness`, `EnvironmentMapLight::intensity`), so they fit
//! half floats. Faces are +X, −X, +Y, −Y, +Z, −Z; each is stored row by row from the top; with s, t in (−1, 1) from the
//! left and the top, the centre of a texel is looked up by the direction (Vulkan, D3D and WebGPU agree)
//!
//! | +X | −X | +Y | −Y | +Z | −Z |
//! |---|---|---|---|---|---|
//! | (1, −t, −s) | (−1, −t, s) | (s, 1, t) | (s, −1, −t) | (s, −t, 1) | (−s, −t, −1) |
//!
//! Cube maps are left-handed. Bevy turns a world direction (x, y, z) into the look-up (x, y, −z);
//! [`Handedness::FlippedZ`] stores for that, [`Handedness::Plain`] for engines that look up the world direction itself.
//!
//! # Accuracy
//! The diffuse map is a sum over a 32-pixel cube weighted by solid angle, exact for that cube. The specular levels are
//! importance sampled with 96 Hammersley points from levels chosen by their density (Křivánek & Colbert 2008), with
//! V = N = R (Karis 2013), as every split-sum renderer assumes. The chain ends at 4 pixels, because a 1-pixel face cannot
//! hold a horizon.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use rain_core::hash::{pcg3d, unit_f32};

use super::file::OvercastSky;

/// Size of the sky's faces. Units: pixels.
pub const SKY_PX: u32 = 256;
/// Size of the specular map's largest level. Units: pixels.
pub const SPECULAR_PX: u32 = 128;
/// Size of its smallest level. Units: pixels.
pub const SPECULAR_LAST_PX: u32 = 4;
/// Size of the diffuse map's faces. Units: pixels.
pub const DIFFUSE_PX: u32 = 16;
const SAMPLES: u32 = 96;

type Rgb = [f32; 3];

/// Which way a renderer looks directions up.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Handedness {
    /// (x, y, −z) of the world direction, as Bevy does.
    #[default]
    FlippedZ,
    /// The world direction itself.
    Plain,
}

/// One level of a cube map.
#[derive(Debug, Clone, PartialEq)]
pub struct Cube {
    /// Width and height of a face. Units: pixels.
    pub size: u32,
    /// Linear RGB, face after face.
    pub texels: Vec<[f32; 3]>,
    handedness: Handedness,
}

/// The generated maps.
#[derive(Debug, Clone, PartialEq)]
pub struct SkyMaps {
    /// Behind the scene, without house fronts: [`SKY_PX`] faces.
    pub sky: Cube,
    /// For mirroring: level k of n is filtered for perceptual roughness k/(n − 1), α = its square.
    pub specular: Vec<Cube>,
    /// For diffuse light: irradiance over π, so that a uniform sky has its own value in it. [`DIFFUSE_PX`] faces.
    pub diffuse: Cube,
}

/// The sky as a function of direction. Build it once: it normalises colours and draws the houses.
#[derive(Debug, Clone)]
pub struct SkyModel {
    zenith: Rgb,
    ratio: f32,
    clouds: f32,
    skyline_rad: f32,
    skyline: Rgb,
    ground: Rgb,
    seed: u32,
}

/// Luminance of linear Rec. 709 (ITU-R BT.709).
fn luminance(c: Rgb) -> f32 {
    0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]
}

impl SkyModel {
    /// From validated settings.
    #[must_use]
    pub fn new(settings: &OvercastSky, seed: u64) -> Self {
        let rgb = |c: [f64; 3]| c.map(|v| v as f32);
        let tint = rgb(settings.tint);
        let zenith = tint.map(|c| c / luminance(tint).max(1e-6));
        let ratio = settings.zenith_to_horizon as f32;
        // With a = 1/ratio and b = 1 − a: L = a + b sin e. Over the hemisphere ∫L cos dω / π = a + 2b/3 on level ground,
        // a/2 + 2b/(3π) on an upright wall.
        let (a, b) = (1.0 / ratio, 1.0 - 1.0 / ratio);
        let on_ground = a + 2.0 * b / 3.0;
        let ground_tint = rgb(settings.ground_tint);
        let ground: Rgb = std::array::from_fn(|i| ground_tint[i] * zenith[i] * on_ground);
        let wall_tint = rgb(settings.skyline_tint);
        // A wall also sees ground over half of its hemisphere.
        let on_wall: Rgb = std::array::from_fn(|i| zenith[i] * (0.5 * a + 2.0 * b / (3.0 * PI)) + 0.5 * ground[i]);
        let skyline = std::array::from_fn(|i| wall_tint[i] * on_wall[i]);
        Self {
            zenith,
            ratio,
            clouds: settings.cloud_contrast as f32,
            skyline_rad: (settings.skyline_deg as f32).to_radians(),
            skyline,
            ground,
            seed: (seed ^ (seed >> 32)) as u32,
        }
    }

    /// Radiance from a direction of the world (unit length, Y up), relative to the zenith's luminance; with the house
    /// fronts or without.
    #[must_use]
    pub fn radiance(&self, direction: [f32; 3], with_skyline: bool) -> [f32; 3] {
        let sin = direction[1].clamp(-1.0, 1.0);
        let up = sin.max(0.0);
        let mut level = (1.0 + (self.ratio - 1.0) * up) / self.ratio;
        if self.clouds > 0.0 && sin > -0.02 {
            level *= 1.0 + self.clouds * self.cloud(direction);
        }
        let mut colour = self.zenith.map(|c| c * level);
        if with_skyline && self.skyline_rad > 0.0 {
            let azimuth = libm::atan2f(direction[0], direction[2]);
            let elevation = libm::asinf(sin);
            // Roof edges are as soft as one texel of the largest level.
            let edge = FRAC_PI_2 / SPECULAR_PX as f32;
            let share = 1.0 - smoothstep(-0.5 * edge, 0.5 * edge, elevation - self.roof(azimuth));
            colour = mix(colour, self.wall(azimuth, elevation), share);
        }
        mix(self.ground, colour, smoothstep(-0.012, 0.004, sin))
    }

    /// Elevation of the roofs at an azimuth, rad: blocks of 4 to 12 degrees, some of them gaps.
    fn roof(&self, azimuth: f32) -> f32 {
        let [height, _, gap] = self.block(azimuth);
        if gap < 0.12 {
            0.25 * self.skyline_rad
        } else {
            self.skyline_rad * (0.5 + 0.5 * height)
        }
    }

    /// A front: each block its own shade, rows of darker windows.
    fn wall(&self, azimuth: f32, elevation: f32) -> Rgb {
        let [_, shade, _] = self.block(azimuth);
        let windows = 0.5 + 0.5 * libm::sinf(elevation * 180.0) * libm::sinf(azimuth * 90.0);
        let level = (0.75 + 0.5 * shade) * (1.0 - 0.25 * windows * windows);
        self.skyline.map(|c| c * level)
    }

    /// Three hashes of the block at an azimuth. The circle is divided into 45 slots, the last equal to the first's left.
    fn block(&self, azimuth: f32) -> [f32; 3] {
        const SLOTS: u32 = 45;
        let turn = (azimuth / TAU).rem_euclid(1.0);
        let slot = ((turn * SLOTS as f32) as u32).min(SLOTS - 1);
        // Two of three slots may join the one before, which makes blocks of different widths.
        let joins = |s: u32| s > 0 && unit_f32(pcg3d([s, 17, self.seed])[0]) < 0.4;
        let mut first = slot;
        while slot - first < 2 && joins(first) {
            first -= 1;
        }
        pcg3d([first, 29, self.seed]).map(unit_f32)
    }

    /// Cloud structure of about unit amplitude: three octaves of smooth noise on a layer overhead, flattened towards the
    /// horizon as a layer is.
    fn cloud(&self, direction: Rgb) -> f32 {
        // A flat layer would put infinitely many clouds on the horizon; the offset stops that.
        let scale = 2.2 / (direction[1].max(0.0) + 0.35);
        let (x, z) = (direction[0] * scale, direction[2] * scale);
        let noise =
            0.6 * self.noise(x, z, 0) + 0.3 * self.noise(2.1 * x, 2.1 * z, 1) + 0.15 * self.noise(4.3 * x, 4.3 * z, 2);
        noise * smoothstep(-0.02, 0.15, direction[1])
    }

    /// Value noise in [−1, 1] with continuous slope.
    fn noise(&self, x: f32, z: f32, octave: u32) -> f32 {
        let (cell_x, cell_z) = (x.floor(), z.floor());
        let (u, v) = (fade(x - cell_x), fade(z - cell_z));
        let corner = |dx: i32, dz: i32| {
            let h = pcg3d([
                (cell_x as i32 + dx) as u32,
                (cell_z as i32 + dz) as u32,
                self.seed ^ (octave << 28),
            ]);
            2.0 * unit_f32(h[0]) - 1.0
        };
        let (near, far) = (lerp(corner(0, 0), corner(1, 0), u), lerp(corner(0, 1), corner(1, 1), u));
        lerp(near, far, v)
    }
}

/// Generates the maps.
#[must_use]
pub fn generate(model: &SkyModel, handedness: Handedness) -> SkyMaps {
    // Seen below the horizon is mist, not the ground that only lights and is mirrored.
    let sky = Cube::from_fn(SKY_PX, handedness, |d| {
        model.radiance([d[0], d[1].max(0.0), d[2]], false)
    });
    let source = Cube::from_fn(SPECULAR_PX, handedness, |d| model.radiance(d, true));
    let specular = prefilter(source.clone());
    // 32 pixels: level 2 of the source.
    let diffuse = irradiance(&source.with_smaller()[2]);
    SkyMaps { sky, specular, diffuse }
}

/// The GGX-filtered levels of a cube map of [`SPECULAR_PX`] faces, see [`SkyMaps::specular`].
#[must_use]
pub fn prefilter(source: Cube) -> Vec<Cube> {
    let source = source.with_smaller();
    let levels = (SPECULAR_PX / SPECULAR_LAST_PX).ilog2();
    (0..=levels)
        .map(|level| {
            if level == 0 {
                source[0].clone()
            } else {
                filtered(&source, level, levels)
            }
        })
        .collect()
}

/// Illuminance on level ground divided by π and the zenith's luminance, from the closed form without clouds and houses:
/// 7/9 for the CIE sky. Units: none.
#[must_use]
pub fn ground_light(settings: &OvercastSky) -> f64 {
    let a = 1.0 / settings.zenith_to_horizon;
    a + 2.0 * (1.0 - a) / 3.0
}

impl Cube {
    /// A level from a function of the world direction (unit length).
    #[must_use]
    pub fn from_fn(size: u32, handedness: Handedness, f: impl Fn(Rgb) -> Rgb) -> Self {
        let mut texels = Vec::with_capacity((6 * size * size) as usize);
        for face in 0..6 {
            for y in 0..size {
                for x in 0..size {
                    texels.push(f(texel_direction(size, handedness, face, x, y)));
                }
            }
        }
        Self {
            size,
            texels,
            handedness,
        }
    }

    /// Direction of the world that a texel's centre is for, of unit length.
    #[must_use]
    pub fn direction(&self, face: u32, x: u32, y: u32) -> [f32; 3] {
        texel_direction(self.size, self.handedness, face, x, y)
    }

    /// The value towards a direction of the world (any length above 0), linear between texels of a face.
    #[must_use]
    pub fn sample(&self, direction: [f32; 3]) -> [f32; 3] {
        let [x, y, z] = self.handedness.apply(direction);
        let (ax, ay, az) = (x.abs(), y.abs(), z.abs());
        let (face, major, s, t) = if ax >= ay && ax >= az {
            if x > 0.0 { (0, ax, -z, -y) } else { (1, ax, z, -y) }
        } else if ay >= az {
            if y > 0.0 { (2, ay, x, z) } else { (3, ay, x, -z) }
        } else if z > 0.0 {
            (4, az, x, -y)
        } else {
            (5, az, -x, -y)
        };
        let last = (self.size - 1) as f32;
        let at = |v: f32| (0.5 * (v / major + 1.0) * self.size as f32 - 0.5).clamp(0.0, last);
        let (px, py) = (at(s), at(t));
        let (x0, y0) = (px as u32, py as u32);
        let (x1, y1) = ((x0 + 1).min(self.size - 1), (y0 + 1).min(self.size - 1));
        let texel = |x: u32, y: u32| self.texels[((face * self.size + y) * self.size + x) as usize];
        let (u, v) = (px - x0 as f32, py - y0 as f32);
        mix(
            mix(texel(x0, y0), texel(x1, y0), u),
            mix(texel(x0, y1), texel(x1, y1), u),
            v,
        )
    }

    /// The texels as 32-bit RGBA with alpha 1, little endian: the bytes of an `Rgba32Float` texture level.
    #[must_use]
    pub fn rgba32_bytes(&self) -> Vec<u8> {
        self.texels
            .iter()
            .flat_map(|t| [t[0], t[1], t[2], 1.0].map(f32::to_le_bytes))
            .flatten()
            .collect()
    }

    /// The texels as half-precision RGBA with alpha 1, little endian: the bytes of an `Rgba16Float` texture level.
    #[must_use]
    pub fn rgba16_bytes(&self) -> Vec<u8> {
        let half = |v: f32| half::f16::from_f32(v).to_le_bytes();
        self.texels
            .iter()
            .flat_map(|t| [t[0], t[1], t[2], 1.0].map(half))
            .flatten()
            .collect()
    }

    /// This level and all smaller ones down to 1 pixel, each the mean of four texels.
    pub(super) fn with_smaller(self) -> Vec<Self> {
        let handedness = self.handedness;
        let mut levels = vec![self];
        while let Some(large) = levels.last().filter(|l| l.size > 1) {
            let (size, wide) = (large.size / 2, large.size);
            let mut texels = Vec::with_capacity((6 * size * size) as usize);
            for face in 0..6 {
                for y in 0..size {
                    for x in 0..size {
                        let at = |dx, dy| large.texels[((face * wide + 2 * y + dy) * wide + 2 * x + dx) as usize];
                        let four = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
                        texels.push(std::array::from_fn(|c| 0.25 * four.iter().map(|t| t[c]).sum::<f32>()));
                    }
                }
            }
            levels.push(Self {
                size,
                texels,
                handedness,
            });
        }
        levels
    }
}

impl Handedness {
    fn apply(self, [x, y, z]: Rgb) -> Rgb {
        match self {
            Self::FlippedZ => [x, y, -z],
            Self::Plain => [x, y, z],
        }
    }
}

fn texel_direction(size: u32, handedness: Handedness, face: u32, x: u32, y: u32) -> Rgb {
    let at = |i: u32| 2.0 * (i as f32 + 0.5) / size as f32 - 1.0;
    let (s, t) = (at(x), at(y));
    let look_up = match face {
        0 => [1.0, -t, -s],
        1 => [-1.0, -t, s],
        2 => [s, 1.0, t],
        3 => [s, -1.0, -t],
        4 => [s, -t, 1.0],
        _ => [-s, -t, -1.0],
    };
    normalised(handedness.apply(look_up))
}

/// GGX-filtered level of the source (Walter et al. 2007; weights N·L as in Karis 2013).
fn filtered(source: &[Cube], level: u32, levels: u32) -> Cube {
    let roughness = level as f32 / levels as f32;
    let alpha2 = (roughness * roughness).powi(2);
    let size = source[0].size >> level;
    // Directions around +Z with weight and source level; the same for every texel.
    let texel_angle = 4.0 * PI / (6.0 * (source[0].size as f32).powi(2));
    let lobe: Vec<(Rgb, f32, usize)> = (0..SAMPLES)
        .filter_map(|i| {
            let (u, v) = (
                (i as f32 + 0.5) / SAMPLES as f32,
                i.reverse_bits() as f32 / 4_294_967_296.0,
            );
            let cos2 = (1.0 - u) / (1.0 + (alpha2 - 1.0) * u);
            let (cos, sin) = (cos2.sqrt(), (1.0 - cos2).max(0.0).sqrt());
            // L mirrors N about the half vector: twice the angle.
            let toward = 2.0 * cos2 - 1.0;
            if toward <= 0.0 {
                return None;
            }
            let density = alpha2 / (PI * (cos2 * (alpha2 - 1.0) + 1.0).powi(2)) * 0.25;
            let mip = 0.5 * (1.0 / (SAMPLES as f32 * density * texel_angle)).log2() + 0.5;
            let (phi_sin, phi_cos) = (libm::sinf(TAU * v), libm::cosf(TAU * v));
            let across = 2.0 * cos * sin;
            // Beyond 4 pixels a level has lost its horizon.
            let mip = (mip.max(0.0) as usize).min(source.len() - 3);
            Some(([across * phi_cos, across * phi_sin, toward], toward, mip))
        })
        .collect();
    let weight: f32 = lobe.iter().map(|l| l.1).sum();
    Cube::from_fn(size, source[0].handedness, |n| {
        let (tangent, bitangent) = frame(n);
        let mut sum = [0.0; 3];
        for (l, w, mip) in &lobe {
            let direction = std::array::from_fn(|i| tangent[i] * l[0] + bitangent[i] * l[1] + n[i] * l[2]);
            let value = source[*mip].sample(direction);
            for (s, v) in sum.iter_mut().zip(value) {
                *s += w * v;
            }
        }
        sum.map(|s| s / weight)
    })
}

/// Irradiance over π, towards [`DIFFUSE_PX`] faces.
pub(super) fn irradiance(source: &Cube) -> Cube {
    let size = source.size;
    let weighted: Vec<(Rgb, f32, Rgb)> = (0..6 * size * size)
        .map(|i| {
            let (face, y, x) = (i / (size * size), i / size % size, i % size);
            (
                source.direction(face, x, y),
                solid_angle(size, x, y),
                source.texels[i as usize],
            )
        })
        .collect();
    Cube::from_fn(DIFFUSE_PX, source.handedness, |n| {
        let (mut sum, mut weight) = ([0.0; 3], 0.0);
        for (d, angle, value) in &weighted {
            let cos = n[0] * d[0] + n[1] * d[1] + n[2] * d[2];
            if cos > 0.0 {
                let w = cos * angle;
                weight += w;
                for (s, v) in sum.iter_mut().zip(value) {
                    *s += w * v;
                }
            }
        }
        // By the weights rather than π: a uniform sky then keeps its value to the last bits.
        sum.map(|s| s / weight)
    })
}

/// Solid angle of a texel, sr.
fn solid_angle(size: u32, x: u32, y: u32) -> f32 {
    let edge = |i: u32| 2.0 * f64::from(i) / f64::from(size) - 1.0;
    let corner = |x: f64, y: f64| libm::atan2(x * y, (x * x + y * y + 1.0).sqrt());
    let (x0, x1, y0, y1) = (edge(x), edge(x + 1), edge(y), edge(y + 1));
    (corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0)) as f32
}

/// Two directions across `n` (Duff et al. 2017).
fn frame(n: Rgb) -> (Rgb, Rgb) {
    let sign = 1.0_f32.copysign(n[2]);
    let a = -1.0 / (sign + n[2]);
    let b = n[0] * n[1] * a;
    (
        [1.0 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]],
        [b, sign + n[1] * n[1] * a, -n[1]],
    )
}

fn normalised(v: Rgb) -> Rgb {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    v.map(|c| c / length)
}

fn lerp(a: f32, b: f32, s: f32) -> f32 {
    a + (b - a) * s
}

fn mix(a: Rgb, b: Rgb, s: f32) -> Rgb {
    std::array::from_fn(|i| lerp(a[i], b[i], s))
}

fn fade(x: f32) -> f32 {
    x * x * (3.0 - 2.0 * x)
}

fn smoothstep(from: f32, to: f32, x: f32) -> f32 {
    fade(((x - from) / (to - from)).clamp(0.0, 1.0))
}

#[cfg(test)]
#[path = "sky_tests.rs"]
mod tests;
