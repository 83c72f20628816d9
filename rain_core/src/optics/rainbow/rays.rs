//! The two rays that meet at each angle beside a bow, and the light of both together.

use core::f64::consts::{FRAC_PI_2, PI};

use super::airy::AiryBand;
use crate::error::clamped_or;
use crate::ops;
use crate::optics::rainbow;

/// Entries of a table of rays, even in the root of the angle from the bow.
const ENTRIES: usize = 257;
/// Angle from the bow within which amplitudes are those at its end. Units: rad.
const NEAR_RAD: f64 = 1e-3;
/// Directions nearer than this to the sun's or to the point opposite count as at this angle. Units: rad.
const AXIS_RAD: f64 = 1e-3;

/// What does not depend on the drop's size at one angle: the argument of Airy's function over the size parameter's power
/// 2/3, and what its square and that of its slope are multiplied by, over the powers 1/3 and −1/3.
pub(super) type Light = [f64; 3];

/// One order of inner reflections at one wavelength.
#[derive(Debug, Clone, PartialEq)]
struct Order {
    reflections: u32,
    /// Where the bow stands, from the point opposite the sun. Units: rad.
    bow_rad: f64,
    /// Angle from the bow to the last ray on the lit side. Units: rad.
    end_rad: f64,
    /// Argument of Airy's function per angle. Units: 1/rad.
    slope: f64,
    /// By the root of the angle; the factors times the sine of the angle from the sun's axis.
    lit: Vec<Light>,
}

/// The way of a ray of one order: p chords in a sphere of index n.
#[derive(Debug, Clone, Copy)]
struct Way {
    n: f64,
    chords: f64,
    /// Incidence and refraction of the ray of the bow.
    bow: [f64; 2],
}

impl Way {
    fn refraction(&self, incidence: f64) -> f64 {
        ops::asin((ops::sin(incidence) / self.n).clamp(-1.0, 1.0))
    }

    /// Angle from the bow towards the lit side, and its slope by the angle of incidence.
    fn off_bow(&self, incidence: f64) -> [f64; 2] {
        let r = self.refraction(incidence);
        let rate = ops::cos(incidence) / (self.n * ops::cos(r));
        [
            2.0 * (incidence - self.bow[0]) - 2.0 * self.chords * (r - self.bow[1]),
            2.0 - 2.0 * self.chords * rate,
        ]
    }

    /// Length of the way over the drop's radius, against that through its middle.
    fn length(&self, incidence: f64) -> f64 {
        2.0 * (self.chords * self.n * ops::cos(self.refraction(incidence)) - ops::cos(incidence))
    }

    /// The angle of incidence on one side of the bow's ray whose light leaves at `angle`; from `start` on.
    fn incidence(&self, angle: f64, [mut low, mut high]: [f64; 2], rising: bool, start: f64) -> f64 {
        let mut at = start.clamp(low, high);
        for _ in 0..60 {
            let [value, slope] = self.off_bow(at);
            let miss = value - angle;
            if (miss > 0.0) == rising {
                high = at;
            } else {
                low = at;
            }
            let newton = at - miss / slope;
            let next = if newton > low && newton < high {
                newton
            } else {
                0.5 * (low + high)
            };
            let step = (next - at).abs();
            at = next;
            if step < 1e-14 {
                break;
            }
        }
        at
    }

    /// Signed roots of the light per steradian of each polarisation, times the root of the sine of the angle from the axis.
    fn amplitudes(&self, incidence: f64) -> [f64; 2] {
        let (ci, cr) = (ops::cos(incidence), ops::cos(self.refraction(incidence)));
        let [_, slope] = self.off_bow(incidence);
        let spread = ops::sqrt((ops::sin(incidence) * ci / (PI * slope.abs())).max(0.0));
        let n = self.n;
        [(ci - n * cr) / (ci + n * cr), (n * ci - cr) / (n * ci + cr)].map(|reflected| {
            let inner: f64 = (1..self.chords as u32).map(|_| reflected).product();
            (1.0 - reflected) * (1.0 + reflected) * inner * spread
        })
    }
}

impl Order {
    fn new(reflections: u32, n: f64) -> Option<Self> {
        let bow = rainbow(reflections, n)?;
        let incidence = ops::asin(bow.impact);
        let refraction = ops::asin(bow.impact / n);
        let chords = f64::from(reflections) + 1.0;
        let way = Way {
            n,
            chords,
            bow: [incidence, refraction],
        };
        // At the bow dr/di = 1/p.
        let (si, ci) = (ops::sin(incidence), ops::cos(incidence));
        let (sr, cr) = (ops::sin(refraction), ops::cos(refraction));
        let curve = 2.0 * chords * (si * cr - ci * sr / chords) / (n * cr * cr);
        let slope = ops::cbrt(2.0 * ci * ci / curve);
        let end_rad = way.off_bow(0.0)[0];
        let last_rad = way.off_bow(FRAC_PI_2)[0];
        let last_length = way.length(FRAC_PI_2);
        let mut rays = [NEAR_RAD, NEAR_RAD];
        let off = ops::sqrt(2.0 * NEAR_RAD / curve);
        rays[0] = incidence - off;
        rays[1] = incidence + off;
        let mut light_at = |angle: f64| -> Light {
            rays[0] = way.incidence(angle, [0.0, incidence], false, rays[0]);
            let one = way.amplitudes(rays[0]);
            let (other, length) = if angle < last_rad {
                rays[1] = way.incidence(angle, [incidence, FRAC_PI_2], true, rays[1]);
                (way.amplitudes(rays[1]), way.length(rays[1]))
            } else {
                ([0.0; 2], last_length + angle - last_rad)
            };
            let phase = (length - way.length(rays[0])).abs();
            let argument = ops::pow(0.75 * phase, 2.0 / 3.0);
            let root = ops::sqrt(argument);
            let mean = |of: &dyn Fn(f64, f64) -> f64| 0.5 * (of(one[0], other[0]) + of(one[1], other[1]));
            [
                argument,
                mean(&|a, b| (a + b) * (a + b)) * root,
                mean(&|a, b| (a - b) * (a - b)) / root,
            ]
        };
        let near = light_at(NEAR_RAD);
        let lit = (0..ENTRIES)
            .map(|i| {
                let root = i as f64 / (ENTRIES - 1) as f64;
                let angle = end_rad * root * root;
                if angle <= NEAR_RAD {
                    [slope * angle, near[1], near[2]]
                } else {
                    light_at(angle)
                }
            })
            .collect();
        Some(Self {
            reflections,
            bow_rad: bow.angle_rad,
            end_rad,
            slope,
            lit,
        })
    }

    /// At an angle from the point opposite the sun, in [AXIS_RAD, π − AXIS_RAD].
    fn at(&self, angle: f64) -> Light {
        // After one inner reflection light falls inside the bow, after two outside.
        let off = if self.reflections == 1 {
            self.bow_rad - angle
        } else {
            angle - self.bow_rad
        };
        let by = 1.0 / ops::sin(angle);
        if off <= 0.0 {
            return [self.slope * off, self.lit[0][1] * by, self.lit[0][2] * by];
        }
        let place = ops::sqrt((off / self.end_rad).min(1.0)) * (ENTRIES - 1) as f64;
        let index = (place as usize).min(ENTRIES - 2);
        let t = place - index as f64;
        let [a, b] = [self.lit[index], self.lit[index + 1]];
        let mix = |k: usize| a[k] + (b[k] - a[k]) * t;
        [mix(0), mix(1) * by, mix(2) * by]
    }
}

/// Light of one size parameter, from its cube root.
#[inline]
pub(super) fn light_of(band: &AiryBand, [argument, value, slope]: Light, root: f64) -> f64 {
    let [square, slope_square] = band.at(argument * root * root);
    PI * (value * root * square + slope * slope_square / root)
}

/// Both bows of one refractive index.
///
/// Error: of large drops 2 % of the light of traced rays in rings of 1° that lie a degree or more from the bows; of drops of
/// 25 and 60 µm, 12 % of the first bow's greatest against Mie's series.
#[derive(Debug, Clone, PartialEq)]
pub struct BowRays {
    orders: Vec<Order>,
}

impl BowRays {
    /// Tables for `index` n (clamped to [1.2, 1.9], NaN counts as 1.333). About 1 ms.
    #[must_use]
    pub fn new(index: f64) -> Self {
        let n = clamped_or(index, 1.2, 1.9, 1.333);
        Self {
            orders: (1..=2).filter_map(|k| Order::new(k, n)).collect(),
        }
    }

    pub(super) fn light(&self, angle_rad: f64) -> impl Iterator<Item = Light> + '_ {
        let angle = clamped_or(angle_rad, AXIS_RAD, PI - AXIS_RAD, AXIS_RAD);
        self.orders.iter().map(move |order| order.at(angle))
    }

    /// Share of the light on a drop's disc that leaves after one or two inner reflections, per steradian. Units: 1/sr.
    ///
    /// `angle_rad`: from the point opposite the sun, rad, clamped to [0.001, π − 0.001]; `size`: circumference of the
    /// drop over the wavelength, clamped to [10, 1e6]; NaN counts as the least. Unpolarised; the mean over drops about
    /// this size (standard deviation 12 %), without the sun's disc.
    #[must_use]
    pub fn phase_per_sr(&self, angle_rad: f64, size: f64) -> f64 {
        let band = AiryBand::get();
        let root = ops::cbrt(clamped_or(size, 10.0, 1e6, 10.0));
        self.light(angle_rad).map(|light| light_of(band, light, root)).sum()
    }
}
