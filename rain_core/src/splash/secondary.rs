//! Drops that a splash throws out: how many, how large, where to, from integers alone.

use glam::Vec3;

use super::threshold::splash_excess_f32;
use crate::hash;
use crate::ops;

/// Fewest and most secondary drops.
const COUNTS: (f32, f32) = (5.0, 30.0);
/// Excess over the threshold at which most are thrown.
const FULL_EXCESS: f32 = 19.0;
/// Smallest and largest, in diameters of the drop that fell.
const SIZES: (f32, f32) = (0.05, 0.3);
/// Slowest and fastest, in normal speeds of the impact.
const SPEEDS: (f32, f32) = (0.1, 0.5);
/// Flattest and steepest, from the ground. Units: rad.
const ANGLES: (f32, f32) = (
    40.0 * core::f32::consts::PI / 180.0,
    70.0 * core::f32::consts::PI / 180.0,
);
/// Share of the speed along the ground that secondary drops keep.
const ALONG: f32 = 0.3;
/// A film thinner than this share of the diameter throws drops from the base, not from a crown.
const CROWN_FILM: f32 = 0.08;

/// A drop that meets the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact {
    /// Diameter. Units: mm. Domain: [0, 100].
    pub diameter_mm: f32,
    /// Velocity. Units: m/s.
    pub velocity_m_s: Vec3,
    /// The ground's normal, a unit vector out of the ground.
    pub normal: Vec3,
    /// Film on the ground. Units: mm. Domain: [0, 1e6].
    pub film_mm: f32,
}

/// What a drop does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SplashKind {
    /// Stays where it hits.
    Deposition,
    /// Drops from the base, on dry ground.
    Prompt,
    /// A crown that sheds drops, on a film.
    Crown,
}

/// What comes of an impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Splash {
    /// Deposition or splash.
    pub kind: SplashKind,
    /// K over its threshold; above 1 the drop splashes. Units: none.
    pub excess: f32,
    /// Secondary drops.
    pub count: u32,
    /// Their volume together, at most that of the drop. Units: mm³.
    pub thrown_mm3: f32,
    /// What stays of the drop on the ground: its volume less what is thrown. Units: mm³.
    pub retained_mm3: f32,
}

/// A drop thrown out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SecondaryDrop {
    /// Diameter. Units: mm.
    pub diameter_mm: f32,
    /// Velocity at the ground. Units: m/s.
    pub velocity_m_s: Vec3,
}

impl Impact {
    /// The same with what is not finite put to 0; a normal that is none points up.
    fn sound(&self) -> Self {
        let finite = |v: Vec3| {
            if v.is_finite() {
                v.clamp_length_max(1000.0)
            } else {
                Vec3::ZERO
            }
        };
        Self {
            diameter_mm: if self.diameter_mm.is_finite() {
                self.diameter_mm.clamp(0.0, 100.0)
            } else {
                0.0
            },
            velocity_m_s: finite(self.velocity_m_s),
            normal: self.normal.try_normalize().unwrap_or(Vec3::Y),
            film_mm: if self.film_mm.is_finite() {
                self.film_mm.clamp(0.0, 1e6)
            } else {
                0.0
            },
        }
    }

    /// Speed towards the ground. Units: m/s.
    fn normal_speed(&self) -> f32 {
        (-self.velocity_m_s.dot(self.normal)).max(0.0)
    }
}

impl Splash {
    /// What `impact` does; `key` tells one impact from the other: the same key, the same drops.
    ///
    /// Deposition up to the threshold (see [`splash_threshold_k`](super::splash_threshold_k)); above it 5 to 30
    /// secondary drops, linear in K/K_threshold up to 19, the fraction decided by hash. Only the speed along the normal
    /// counts. What is not finite in `impact` counts as 0. Water: thrown + retained = the drop. Source: thresholds as
    /// there; numbers a choice.
    ///
    /// Error: thrown volume is the sum over [`secondary_drop`], and thrown + retained the drop, to 1e-6 of it; the mean
    /// count within five standard deviations over 20 000 impacts.
    #[must_use]
    pub fn new(impact: &Impact, key: [u32; 3]) -> Self {
        let impact = impact.sound();
        let d = impact.diameter_mm;
        let excess = splash_excess_f32(d, impact.normal_speed(), impact.film_mm);
        let volume = core::f32::consts::PI / 6.0 * d * d * d;
        if excess <= 1.0 || d == 0.0 {
            return Self {
                kind: SplashKind::Deposition,
                excess,
                count: 0,
                thrown_mm3: 0.0,
                retained_mm3: volume,
            };
        }
        let grown = ((excess - 1.0) / (FULL_EXCESS - 1.0)).min(1.0);
        let mean = COUNTS.0 + (COUNTS.1 - COUNTS.0) * grown;
        let [bits, _, _] = hash::pcg3d(key);
        let count = ((mean + hash::unit_f32(bits)).floor() as u32).min(COUNTS.1 as u32);
        let cubes: f32 = (0..count)
            .map(|index| size(key, index))
            .map(|size| size * size * size)
            .sum();
        Self {
            kind: if impact.film_mm < CROWN_FILM * d {
                SplashKind::Prompt
            } else {
                SplashKind::Crown
            },
            excess,
            count,
            thrown_mm3: volume * cubes,
            retained_mm3: volume * (1.0 - cubes),
        }
    }
}

/// Mean number of drops that are thrown singly at an excess over the threshold above 1.
pub(super) fn mean_count(excess: f64) -> f64 {
    let [least, most] = [COUNTS.0, COUNTS.1].map(f64::from);
    least + (most - least) * ((excess - 1.0) / (f64::from(FULL_EXCESS) - 1.0)).min(1.0)
}

/// Upward speed of the smallest of them on level ground, in the mean of speeds and angles, at an impact's speed. Units: m/s.
pub(super) fn mist_rise(speed_m_s: f64) -> f64 {
    let [slow, fast] = [SPEEDS.0, SPEEDS.1].map(f64::from);
    let angle = 0.5 * f64::from(ANGLES.0 + ANGLES.1);
    speed_m_s * (slow + 0.75 * (fast - slow)) * ops::sin(angle)
}

/// Hash of one secondary drop.
fn drop_key(key: [u32; 3], index: u32) -> [u32; 3] {
    hash::pcg3d([key[0] ^ hash::pcg(index), key[1], key[2].wrapping_add(index)])
}

/// Size of secondary drop `index` in diameters of the drop: small ones are more common.
fn size(key: [u32; 3], index: u32) -> f32 {
    let u = hash::unit_f32(drop_key(key, index)[0]);
    SIZES.0 + (SIZES.1 - SIZES.0) * u * u
}

/// Secondary drop `index` of an impact, below the count of its [`Splash`].
///
/// Diameter 0.05 to 0.3 D, most of them small; speed 0.1 to 0.5 of the impact's normal speed, small ones faster;
/// 40° to 70° from the ground; directions evenly about the normal; of the speed along the ground 0.3 is kept. At most
/// half the impact's speed. Source: choice within measured ranges.
///
/// Error: diameter 2e-7 relative, velocity 1e-6 of the impact's speed against the same words in double precision.
#[must_use]
pub fn secondary_drop(impact: &Impact, splash: &Splash, key: [u32; 3], index: u32) -> SecondaryDrop {
    let impact = impact.sound();
    let [_, b, c] = drop_key(key, index);
    let share = size(key, index);
    let (u, w) = (hash::unit_f32(b), hash::unit_f32(c));
    // Fast where small: half of the range follows the size, half is hashed.
    let small = (SIZES.1 - share) / (SIZES.1 - SIZES.0);
    let speed = impact.normal_speed() * (SPEEDS.0 + (SPEEDS.1 - SPEEDS.0) * 0.5 * (u + small));
    let angle = ANGLES.0 + (ANGLES.1 - ANGLES.0) * w;
    // One drop in each of `count` sectors, anywhere within it.
    let [spin, _, _] = hash::pcg3d([key[2], key[0], key[1] ^ 0x7370_6c61]);
    let sector = index as f32 + hash::unit_f32(b.rotate_left(13));
    let around = core::f32::consts::TAU * (sector / splash.count.max(1) as f32 + hash::unit_f32(spin));
    let (tangent, bitangent) = impact.normal.any_orthonormal_pair();
    let (sin, cos) = (ops::sin(f64::from(around)) as f32, ops::cos(f64::from(around)) as f32);
    let (rise, run) = (ops::sin(f64::from(angle)) as f32, ops::cos(f64::from(angle)) as f32);
    let along = impact.velocity_m_s - impact.normal * impact.velocity_m_s.dot(impact.normal);
    let thrown = speed * (impact.normal * rise + (tangent * cos + bitangent * sin) * run) + along * ALONG;
    SecondaryDrop {
        diameter_mm: share * impact.diameter_mm,
        velocity_m_s: thrown.clamp_length_max(0.5 * impact.velocity_m_s.length()),
    }
}
