//! How much of the rain is far rain: one rule for the particles and for the haze that leaves it out.

use glam::{DVec2, DVec3, Vec3Swizzles};

use crate::error::clamped;
use crate::haze::{RateExtinction, ramp};
use crate::ops;
use crate::rainfall::areas::AreaField;

/// Distances on the ground between which far rain begins; before it are single drops, cards and haze. Units: m.
pub const FAR_BEGIN_M: [f64; 2] = [36.0, 108.0];

/// Sines of the elevations between which far rain begins below the horizon and ends above it. Units: none.
pub const FAR_PITCH: [[f64; 2]; 2] = [[-0.1, -0.02], [0.5, 0.75]];

/// Share of the rain at a distance on the ground (m) that may be far rain. Units: none.
///
/// Error: 1e-15.
#[must_use]
pub fn far_begin(distance_m: f64) -> f64 {
    ramp(distance_m, FAR_BEGIN_M[0], FAR_BEGIN_M[1])
}

/// Share by the sine of a line's elevation. Units: none.
///
/// Error: 1e-15.
#[must_use]
pub fn far_pitch_weight(sine: f64) -> f64 {
    let [[a, b], [c, d]] = FAR_PITCH;
    ramp(sine, a, b) * (1.0 - ramp(sine, c, d))
}

/// Share of the rain at a height over the eye under a cloud whose base is `base_m` over the eye, m: 1 up to `thin_m` below the
/// base, straight down to 0 at it. A `thin_m` of 0 is a sharp base. Units: none.
///
/// Error: 1e-15.
#[must_use]
pub fn cloud_share(height_m: f64, base_m: f64, thin_m: f64) -> f64 {
    if thin_m > 0.0 {
        clamped((base_m - height_m) / thin_m, 0.0, 1.0)
    } else {
        f64::from(u8::from(height_m < base_m))
    }
}

/// The rain around an eye.
#[derive(Debug, Clone, Copy)]
pub struct FarEye<'a> {
    /// The eye (world). Units: m.
    pub eye_m: DVec3,
    /// Areas at the time of the picture.
    pub areas: &'a AreaField,
    /// The weather's rate. Units: mm/h.
    pub weather_mm_h: f64,
    /// Extinction by rate.
    pub rates: &'a RateExtinction,
}

/// Intervals of a line whose depth is looked up.
const INTERVALS: usize = 48;
/// Distance at which they begin to grow. Units: m.
const FIRST_M: f64 = 16.0;
/// Points in each.
const POINTS: usize = 6;
/// Deepest rain that is looked through. Units: none.
const DEEPEST: f64 = 12.0;

/// Optical depth along the ground, by azimuth and distance, and with it how much of the rain is far rain.
///
/// Of the rain in excess of what falls outside areas, at distance ρ on the ground, a share
/// q · S(36 → 108 m) · e^(−τ(ρ)) is far rain: τ is the optical depth of all rain before it along the ground, so that far rain is
/// where it is seen. A line of sight takes it times [`far_pitch_weight`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FarAccount {
    from_rad: f64,
    step_rad: f64,
    scale: f64,
    outside_per_m: f64,
    /// Row by row: τ at the knots of each azimuth.
    depths: Vec<f32>,
}

fn knot(i: f64, scale: f64) -> f64 {
    FIRST_M * ops::exp_m1(i * scale)
}

impl FarAccount {
    /// Looks along `azimuths` directions of the wedge of `half_rad` (held in (0, π]) on either side of `ahead` (x, z), up to
    /// `reach_m`. The memory is used again.
    pub fn look(&mut self, eye: &FarEye, ahead: DVec2, half_rad: f64, azimuths: usize, reach_m: f64) {
        let azimuths = azimuths.max(2);
        let half = clamped(half_rad, 1e-3, core::f64::consts::PI);
        self.from_rad = ops::atan2(ahead.y, ahead.x) - half;
        self.step_rad = 2.0 * half / (azimuths - 1) as f64;
        self.scale = ops::ln_1p(clamped(reach_m, 1.0, 1e6) / FIRST_M) / INTERVALS as f64;
        let outside = AreaField::new(eye.areas.outside()).rate_at(DVec2::ZERO, eye.weather_mm_h);
        self.outside_per_m = eye.rates.per_m(outside);
        self.depths.clear();
        let origin = eye.eye_m.xz();
        for i in 0..azimuths {
            let angle = self.from_rad + self.step_rad * i as f64;
            let direction = DVec2::new(ops::cos(angle), ops::sin(angle));
            let mut depth = 0.0;
            self.depths.push(0.0);
            for k in 0..INTERVALS {
                let (low, high) = (knot(k as f64, self.scale), knot((k + 1) as f64, self.scale));
                if depth < DEEPEST {
                    let step = (high - low) / POINTS as f64;
                    let rate = |j: usize| {
                        let at = low + step * (j as f64 + 0.5);
                        eye.areas.rate_at(origin + direction * at, eye.weather_mm_h)
                    };
                    depth += (0..POINTS).map(|j| eye.rates.per_m(rate(j)) * step).sum::<f64>();
                }
                self.depths.push(depth as f32);
            }
        }
    }

    /// Extinction of the rain outside areas. Units: 1/m.
    #[must_use]
    pub fn outside_per_m(&self) -> f64 {
        self.outside_per_m
    }

    /// Optical depth along the ground from the eye to a place relative to it (x, z, m). Directions outside the wedge count as its
    /// sides. Units: none.
    ///
    /// Error: 0.02 where rain is even; under an edge a sixth of an interval (7 % of the distance or 3 m) of its rain.
    #[must_use]
    pub fn depth_to(&self, from_eye_m: DVec2) -> f64 {
        let row = INTERVALS + 1;
        let rows = self.depths.len() / row;
        if rows < 2 {
            return 0.0;
        }
        let turn = 2.0 * core::f64::consts::PI;
        let middle = self.from_rad + 0.5 * self.step_rad * (rows - 1) as f64;
        let off = ops::atan2(from_eye_m.y, from_eye_m.x) - middle;
        let off = off - turn * (off / turn).round() + 0.5 * self.step_rad * (rows - 1) as f64;
        let azimuth = clamped(off / self.step_rad, 0.0, (rows - 1) as f64);
        let a = (azimuth as usize).min(rows - 2);
        let distance = from_eye_m.length();
        let place = clamped(ops::ln_1p(distance / FIRST_M) / self.scale, 0.0, INTERVALS as f64);
        let k = (place as usize).min(INTERVALS - 1);
        let (low, high) = (knot(k as f64, self.scale), knot((k + 1) as f64, self.scale));
        let t = clamped((distance - low) / (high - low), 0.0, 1.0);
        let along = |a: usize| {
            let at = a * row + k;
            let (x, y) = (f64::from(self.depths[at]), f64::from(self.depths[at + 1]));
            x + (y - x) * t
        };
        let (near, next) = (along(a), along(a + 1));
        near + (next - near) * (azimuth - a as f64)
    }

    /// Extinction of far rain over its share q at a place relative to the eye, where the rain's extinction is
    /// `extinction_per_m`. Units: 1/m.
    ///
    /// Error: that of [`FarAccount::depth_to`] in e^(−τ).
    #[must_use]
    pub fn per_m(&self, from_eye_m: DVec2, extinction_per_m: f64) -> f64 {
        let excess = extinction_per_m - self.outside_per_m;
        let begin = far_begin(from_eye_m.length());
        if excess > 0.0 && begin > 0.0 {
            excess * begin * ops::exp(-self.depth_to(from_eye_m))
        } else {
            0.0
        }
    }

    /// Optical depth of far rain over its share q along a unit line of sight for `way_m` (m): what haze leaves out, in double
    /// precision. `cloud_m` and `thin_m`: the cloud's base over the eye (m, held from 0 on), as in [`cloud_share`]. Units: none.
    ///
    /// Error: that of [`FarAccount::per_m`]; 512 points, closer together nearby.
    #[must_use]
    pub fn far_depth(&self, eye: &FarEye, towards: DVec3, way_m: f64, cloud_m: f64, thin_m: f64) -> f64 {
        const STEPS: usize = 512;
        let flat = towards.xz().length();
        let weight = far_pitch_weight(towards.y);
        if flat <= 0.0 || weight <= 0.0 {
            return 0.0;
        }
        let under = if towards.y > 0.0 {
            clamped(cloud_m, 0.0, f64::MAX) / towards.y
        } else {
            f64::INFINITY
        };
        let reach = clamped(way_m.min(under), 0.0, 1e6) * flat;
        let direction = towards.xz() / flat;
        let scale = ops::ln_1p(reach / FIRST_M) / STEPS as f64;
        let sum: f64 = (0..STEPS)
            .map(|i| {
                let (low, high) = (knot(i as f64, scale), knot((i + 1) as f64, scale));
                let at = direction * (0.5 * (low + high));
                let rate = eye.areas.rate_at(eye.eye_m.xz() + at, eye.weather_mm_h);
                let height = towards.y / flat * 0.5 * (low + high);
                self.per_m(at, eye.rates.per_m(rate)) * cloud_share(height, cloud_m, thin_m) * (high - low)
            })
            .sum();
        weight * sum / flat
    }
}
