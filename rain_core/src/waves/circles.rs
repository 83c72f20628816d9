//! The circle texture of procedural rings: circles of random size that do not touch, on a square that repeats.
//!
//! Each texel knows how near it is to the middle of its circle, which way the circle's slope points there, and when
//! the circle's ring starts; that is all that a ring needs ([`super::ring_profile_f32`]). Source: Lagarde 2013 (the
//! texture is Antoine Zanuttini's); how the circles are placed, their distortion and the 16 bits are choices.

use crate::error::{ConfigError, in_range};
use crate::hash;
use crate::ops;

/// Darts thrown at the square.
const DARTS: u32 = 6000;

/// Waves around a distorted circle: two to five of them, by falling shares that sum to 1.
const BENDS: [(f64, f64); 4] = [(2.0, 0.4), (3.0, 0.3), (4.0, 0.2), (5.0, 0.1)];

/// Settings of a [`CircleMap`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CircleSettings {
    /// Texels on a side. Domain: a power of two in [32, 1024]. Default: 256.
    pub texels: u32,
    /// Least radius. Units: sides of the square. Domain: [3 texels, `largest_radius`]. Default: 0.03.
    pub least_radius: f64,
    /// Largest radius. Units: sides of the square. Domain: up to 0.24. Default: 0.09.
    pub largest_radius: f64,
    /// How far outlines bend in from a circle: a rim lies between 1 − distortion and 1 of the radius. 0 makes perfect
    /// circles, as in the source. Units: none. Domain: [0, 0.5]. Default: 0.12, by eye.
    pub distortion: f64,
    /// Which circles.
    pub seed: u32,
}

impl Default for CircleSettings {
    fn default() -> Self {
        Self {
            texels: 256,
            least_radius: 0.03,
            largest_radius: 0.09,
            distortion: 0.12,
            seed: 0,
        }
    }
}

impl CircleSettings {
    fn check(&self) -> Result<(), ConfigError> {
        if !(self.texels.is_power_of_two() && (32..=1024).contains(&self.texels)) {
            return Err(ConfigError::OutOfRange {
                field: "texels",
                value: f64::from(self.texels),
                allowed: "a power of two in 32 to 1024",
            });
        }
        in_range(
            "largest_radius",
            self.largest_radius,
            0.0,
            0.24,
            "up to 0.24 of the side",
        )?;
        let least = 3.0 / f64::from(self.texels);
        let allowed = "three texels up to the largest radius, of the side";
        in_range("least_radius", self.least_radius, least, self.largest_radius, allowed)?;
        in_range("distortion", self.distortion, 0.0, 0.5, "0 to 0.5").map(|_| ())
    }
}

/// A circle of the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circle {
    /// Its middle. Units: sides of the square, [0, 1).
    pub x: f64,
    /// As `x`.
    pub z: f64,
    /// Its radius. Units: sides of the square.
    pub radius: f64,
    /// Part of a cycle by which its ring is ahead of the clock, over 65536.
    pub offset: u16,
}

/// A texel as it is stored, for the GPU too: nearness to the middle in the lower half of the first word (65535 in the
/// middle, 0 on the rim and outside) and the circle's offset in its upper half; slope direction, signed over 32767, in
/// the second.
pub type CircleTexel = [u32; 2];

/// What a texel says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CirclePoint {
    /// 1 − distance over the radius; 0 outside. Units: none, [0, 1].
    pub nearness: f32,
    /// Unit vector that points the way in which the circle's outlines widen (x, z); 0 in the very middle.
    pub outward: [f32; 2],
    /// The circle's offset, over 65536.
    pub offset: u32,
}

impl CirclePoint {
    /// Reads a texel. Error: nearness 1e-5, direction 4e-5 beside those of the circle, by rounding to 16 bits.
    #[must_use]
    pub fn of(texel: CircleTexel) -> Self {
        let signed = |half: u32| f32::from(half as u16 as i16) * (1.0 / 32767.0);
        Self {
            nearness: (texel[0] & 0xffff) as f32 * (1.0 / 65535.0),
            outward: [signed(texel[1] & 0xffff), signed(texel[1] >> 16)],
            offset: texel[0] >> 16,
        }
    }
}

/// Circles that do not touch, and their texels, row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct CircleMap {
    settings: CircleSettings,
    circles: Vec<Circle>,
    texels: Vec<CircleTexel>,
}

impl CircleMap {
    /// Throws darts at the square; each that hits free ground becomes the largest circle up to a random size that
    /// leaves a texel between it and its neighbours. Takes tens of milliseconds.
    ///
    /// Error: nearness 1e-5, directions 4e-5, by the integers that hold them.
    ///
    /// # Errors
    /// [`ConfigError::OutOfRange`] for a setting outside its domain.
    pub fn new(settings: &CircleSettings) -> Result<Self, ConfigError> {
        settings.check()?;
        let circles = place(settings);
        let n = settings.texels as usize;
        let mut texels = vec![[0; 2]; n * n];
        for (index, circle) in (0..).zip(&circles) {
            draw(settings, circle, index, &mut texels);
        }
        Ok(Self {
            settings: *settings,
            circles,
            texels,
        })
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &CircleSettings {
        &self.settings
    }

    /// The circles.
    #[must_use]
    pub fn circles(&self) -> &[Circle] {
        &self.circles
    }

    /// The texels, row by row.
    #[must_use]
    pub fn texels(&self) -> &[CircleTexel] {
        &self.texels
    }

    /// The texel in a column and row; beyond the sides the map repeats.
    #[must_use]
    pub fn at(&self, column: u32, row: u32) -> CirclePoint {
        let mask = self.settings.texels - 1;
        let index = (row & mask) * self.settings.texels + (column & mask);
        CirclePoint::of(self.texels[index as usize])
    }
}

/// The shorter way from `a` to `b` around the square.
fn around(a: f64, b: f64) -> f64 {
    let way = b - a;
    way - (way + 0.5).floor()
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    let [x, z] = [around(a[0], b[0]), around(a[1], b[1])];
    ops::sqrt(x * x + z * z)
}

fn place(settings: &CircleSettings) -> Vec<Circle> {
    let gap = 1.5 / f64::from(settings.texels);
    let mut circles: Vec<Circle> = Vec::new();
    for dart in 0..DARTS {
        let [x, z, size] = hash::pcg3d([dart, settings.seed, 0x5249_4e47]);
        let [x, z, size] = [x, z, size].map(|word| f64::from(hash::unit_f32(word)));
        let wanted = settings.least_radius + (settings.largest_radius - settings.least_radius) * size;
        let free = circles
            .iter()
            .map(|c| distance([x, z], [c.x, c.z]) - c.radius - gap)
            .fold(wanted, f64::min);
        // Large ones first: later darts fill what is left between them.
        let early = dart < DARTS / 8;
        if free >= settings.least_radius && !(early && free < 0.999 * wanted) {
            circles.push(Circle {
                x,
                z,
                radius: free,
                offset: (hash::pcg(dart ^ hash::pcg(settings.seed)) >> 16) as u16,
            });
        }
    }
    circles
}

/// The rim of a distorted circle over its radius in a direction, and its change with the angle.
fn outline(distortion: f64, phases: [f64; 4], angle: f64) -> (f64, f64) {
    let (mut sum, mut change) = (0.0, 0.0);
    for ((waves, share), phase) in BENDS.into_iter().zip(phases) {
        sum += share * ops::cos(waves * angle + phase);
        change -= share * waves * ops::sin(waves * angle + phase);
    }
    (1.0 - 0.5 * distortion * (1.0 + sum), -0.5 * distortion * change)
}

fn draw(settings: &CircleSettings, circle: &Circle, index: u32, texels: &mut [CircleTexel]) {
    let n = i64::from(settings.texels);
    let per_texel = 1.0 / n as f64;
    let [a, b, c] = hash::pcg3d([index, settings.seed, 0x4245_4e44]);
    let phases = [a, b, c, hash::pcg(a ^ b)].map(|word| core::f64::consts::TAU * f64::from(hash::unit_f32(word)));
    let reach = (circle.radius * n as f64) as i64 + 1;
    let [column, row] = [circle.x, circle.z].map(|at| (at * n as f64) as i64);
    for j in row - reach..=row + reach {
        for i in column - reach..=column + reach {
            let x = (i as f64 + 0.5) * per_texel - circle.x;
            let z = (j as f64 + 0.5) * per_texel - circle.z;
            let far = ops::sqrt(x * x + z * z);
            let (rim, change) = if settings.distortion > 0.0 {
                outline(settings.distortion, phases, ops::atan2(z, x))
            } else {
                (1.0, 0.0)
            };
            let nearness = 1.0 - far / (circle.radius * rim);
            if nearness <= 0.0 {
                continue;
            }
            // The gradient of distance over rim, by its parts along and across the radius.
            let across = -change / rim;
            let length = ops::sqrt(1.0 + across * across) * far;
            let outward = if length > 0.0 {
                [(x - across * z) / length, (z + across * x) / length]
            } else {
                [0.0; 2]
            };
            let [u, v] = outward.map(|part| u32::from((part * 32767.0).round() as i16 as u16));
            let near = (nearness * 65535.0 + 0.5) as u32;
            let at = j.rem_euclid(n) * n + i.rem_euclid(n);
            texels[at as usize] = [near | u32::from(circle.offset) << 16, u | v << 16];
        }
    }
}

#[cfg(test)]
#[allow(
    clippy::disallowed_methods,
    reason = "an independent check uses std, not the maths under test"
)]
mod tests {
    use super::*;

    fn map(change: fn(&mut CircleSettings)) -> CircleMap {
        let mut settings = CircleSettings::default();
        change(&mut settings);
        CircleMap::new(&settings).expect("valid")
    }

    #[test]
    fn circles_are_many_of_all_sizes_and_do_not_touch() {
        for seed in [0, 1, 99] {
            let settings = CircleSettings {
                seed,
                ..CircleSettings::default()
            };
            let map = CircleMap::new(&settings).expect("valid");
            let circles = map.circles();
            let area: f64 = circles.iter().map(|c| std::f64::consts::PI * c.radius * c.radius).sum();
            eprintln!("seed {seed}: {} circles cover {area:.3}", circles.len());
            assert!(circles.len() > 40 && area > 0.5, "{} circles, {area}", circles.len());
            for (i, a) in circles.iter().enumerate() {
                assert!((0.03..=0.09).contains(&a.radius) && (0.0..1.0).contains(&a.x) && (0.0..1.0).contains(&a.z));
                for b in &circles[..i] {
                    // Over all images of the repeating square.
                    for (dx, dz) in (-1..=1).flat_map(|x| (-1..=1).map(move |z| (f64::from(x), f64::from(z)))) {
                        let apart = (b.x + dx - a.x).hypot(b.z + dz - a.z) - a.radius - b.radius;
                        assert!(apart > 1.0 / 256.0, "{a:?} {b:?}");
                    }
                }
            }
            let small = circles.iter().filter(|c| c.radius < 0.05).count();
            let large = circles.iter().filter(|c| c.radius > 0.07).count();
            assert!(small > 5 && large > 5, "{small} small, {large} large");
        }
    }

    #[test]
    fn channels_hold_distance_direction_and_one_offset_a_circle() {
        let map = map(|s| s.distortion = 0.0);
        let n = 256;
        let (mut inside, mut wrong) = (0_u32, 0_u32);
        for (j, i) in (0..n).flat_map(|j| (0..n).map(move |i| (j, i))) {
            let point = map.at(i, j);
            let at = [i, j].map(|k| (f64::from(k) + 0.5) / 256.0);
            let nearest = map.circles().iter().map(|c| (distance([c.x, c.z], at), c));
            let (far, circle) = nearest
                .min_by(|a, b| (a.0 / a.1.radius).total_cmp(&(b.0 / b.1.radius)))
                .expect("one");
            let expected = (1.0 - far / circle.radius).max(0.0);
            assert!((f64::from(point.nearness) - expected).abs() < 1e-5, "{i}, {j}");
            if point.nearness == 0.0 {
                continue;
            }
            inside += 1;
            assert_eq!(point.offset, u32::from(circle.offset));
            let [x, z] = [around(circle.x, at[0]) / far, around(circle.z, at[1]) / far];
            let [u, v] = point.outward.map(f64::from);
            assert!((u - x).abs() < 4e-5 && (v - z).abs() < 4e-5, "{u} {v}, not {x} {z}");
            wrong += u32::from((u + x).abs() < 4e-5);
        }
        assert!(inside > 30_000 && wrong < inside / 20, "{inside} {wrong}");
        let offsets: Vec<u16> = map.circles().iter().map(|c| c.offset).collect();
        let mean = offsets.iter().map(|o| f64::from(*o)).sum::<f64>() / offsets.len() as f64 / 65536.0;
        assert!((mean - 0.5).abs() < 0.15, "{mean}");
    }

    #[test]
    fn distorted_outlines_stay_inside_their_circles_and_slope_across_them() {
        let (plain, bent) = (map(|s| s.distortion = 0.0), map(|s| s.distortion = 0.3));
        assert_eq!(plain.circles(), bent.circles());
        let (mut turned, mut rims) = (0.0_f64, Vec::new());
        for (j, i) in (0..256).flat_map(|j| (0..256).map(move |i| (j, i))) {
            let (circle, outline) = (plain.at(i, j), bent.at(i, j));
            assert!(outline.nearness <= circle.nearness);
            if outline.nearness <= 0.0 {
                continue;
            }
            let along: f32 = circle.outward.iter().zip(outline.outward).map(|(a, b)| a * b).sum();
            assert!((outline.outward[0].hypot(outline.outward[1]) - 1.0).abs() < 1e-4 || circle.nearness > 0.99);
            turned = turned.max(f64::from(along.clamp(-1.0, 1.0)).acos());
            rims.push((1.0 - circle.nearness) / (1.0 - outline.nearness));
            // The slope is that of the outlines themselves.
            let near = |i: u32, j: u32| bent.at(i, j).nearness;
            let (east, west) = (near(i + 1, j), near(i.wrapping_sub(1), j));
            let (south, north) = (near(i, j + 1), near(i, j.wrapping_sub(1)));
            if outline.nearness < 0.7 && [east, west, south, north].iter().all(|n| *n > 0.0) {
                let (gx, gz) = (west - east, north - south);
                let length = gx.hypot(gz);
                let cosine = (gx * outline.outward[0] + gz * outline.outward[1]) / length;
                assert!(cosine > 0.97, "{i}, {j}: {cosine}");
            }
        }
        let (low, high) = rims.iter().fold((9.0_f32, 0.0_f32), |(l, h), r| (l.min(*r), h.max(*r)));
        assert!(low >= 0.699 && high <= 1.001 && high - low > 0.15, "{low} {high}");
        assert!(turned > 0.1, "{turned}");
    }

    #[test]
    fn the_same_seed_makes_the_same_map_and_bad_settings_are_refused() {
        assert_eq!(map(|_| ()), map(|_| ()));
        assert_ne!(map(|_| ()).circles(), map(|s| s.seed = 1).circles());
        type Change = fn(&mut CircleSettings);
        let bad: [(Change, &str); 8] = [
            (|s| s.texels = 0, "texels"),
            (|s| s.texels = 100, "texels"),
            (|s| s.largest_radius = 0.3, "largest_radius"),
            (|s| s.largest_radius = f64::NAN, "largest_radius"),
            (|s| s.least_radius = 0.2, "least_radius"),
            (|s| s.least_radius = 0.01, "least_radius"),
            (|s| s.distortion = -0.1, "distortion"),
            (|s| s.distortion = f64::INFINITY, "distortion"),
        ];
        for (change, field) in bad {
            let mut settings = CircleSettings::default();
            change(&mut settings);
            let message = CircleMap::new(&settings).expect_err(field).to_string();
            assert!(message.starts_with(field), "{message}");
        }
    }
}
