//! One optical depth, shared between drops that are drawn and haze.
//!
//! For a Poisson field the mean transmittance of drawn drops is exactly exp(−∫ weight · extinction ds), whether the
//! weight fades opacity or thins drops. What the drawn drops do not take out, the fog does, so that
//! E[T_drops] · T_fog = exp(−Q σ_geo s) for every way, every range and every fade: no setting of the drawn range may
//! change the mean of a picture. Weights go by distance from the eye, so turning the camera changes nothing.
//!
//! # Accuracy
//! Exact for uniform rain. Contrast gain on drawn streaks is outside this account.

use super::extinction::{obscured, transmittance};
use crate::error::{ConfigError, clamped, in_range};
use crate::rainfall::{CLASS_COUNT, CLASS_EDGES_MM, Spectrum};

/// Ramp in which drops appear in front of the eye. Units: m.
const EYE_RAMP_M: [f64; 2] = [0.1, 0.2];
/// Ramp in which the middle tier of cards ends. Units: m.
const MID_END_M: [f64; 2] = [24.0, 36.0];
/// Nearest start of the middle tier: closer cards swim and clip. Units: m.
const MID_NEAREST_M: f64 = 3.2;
/// Smallest range that draws anything: below it the two ramps in front of the eye would cross. Units: m.
const MIN_RANGE_M: f64 = 0.25;
/// Longest way that is looked at. Units: m.
const MAX_WAY_M: f64 = 1e9;
/// Longest range of a [`FogTable`]: single drops have then ended where its entries do. Units: m.
const MAX_TABLE_RANGE_M: f64 = MID_END_M[1] / 1.2;

/// t²(3 − 2t) between `from` and `to` (`from` < `to`), 0 before, 1 after. NaN gives 0. Units: none.
///
/// Error: 1e-15.
#[must_use]
pub fn ramp(x: f64, from: f64, to: f64) -> f64 {
    let t = (x - from) / (to - from);
    if t > 0.0 {
        let t = t.min(1.0);
        t * t * (3.0 - 2.0 * t)
    } else {
        0.0
    }
}

/// ∫₀ˣ [`ramp`]: (b−a)(t³ − t⁴/2) inside, (b−a)/2 + x − b beyond. Units: m.
///
/// `x`: m, clamped to [0, 1e9], NaN counts as 0; 0 ≤ `from` < `to`.
///
/// Error: 1e-13 m against the integral, up to 400 m.
#[must_use]
pub fn ramp_integral_m(x: f64, from: f64, to: f64) -> f64 {
    let x = way(x);
    if x <= from {
        0.0
    } else if x < to {
        let t = (x - from) / (to - from);
        (to - from) * t * t * t * (1.0 - 0.5 * t)
    } else {
        0.5 * (to - from) + (x - to)
    }
}

fn way(s: f64) -> f64 {
    if s > 0.0 { s.min(MAX_WAY_M) } else { 0.0 }
}

/// Weight with which single drops are drawn at a distance: S(0.1 → 0.2 m) − S(0.8 z → 1.2 z). Units: none, in [0, 1].
///
/// `distance_m`: from the eye, m; `range_m`: z of the drop or class, m; below 0.25 m, or NaN, nothing is drawn.
///
/// Error: 1e-15.
#[must_use]
pub fn near_weight(distance_m: f64, range_m: f64) -> f64 {
    if range_m.is_nan() || range_m < MIN_RANGE_M {
        return 0.0;
    }
    ramp(distance_m, EYE_RAMP_M[0], EYE_RAMP_M[1]) - ramp(distance_m, 0.8 * range_m, 1.2 * range_m)
}

/// ∫₀ˢ [`near_weight`], the G_n of the account: metres of rain that single drops stand for. Units: m.
///
/// `way_m`: s, m, clamped to [0, 1e9]; `range_m` as there.
///
/// Error: 1e-13 m against the integral, up to 400 m.
#[must_use]
pub fn near_depth_m(way_m: f64, range_m: f64) -> f64 {
    if range_m.is_nan() || range_m < MIN_RANGE_M {
        return 0.0;
    }
    let range = range_m.min(MAX_WAY_M);
    ramp_integral_m(way_m, EYE_RAMP_M[0], EYE_RAMP_M[1]) - ramp_integral_m(way_m, 0.8 * range, 1.2 * range)
}

/// Where the middle tier of a class starts, b = 0.8 z in [3.2, 24]. Units: m. `range_m`: m; NaN counts as 0.
///
/// Error: exact, one product held between its ends.
#[must_use]
pub fn mid_start_m(range_m: f64) -> f64 {
    let start = 0.8 * range_m;
    // Also where the range is not a number.
    if start > MID_NEAREST_M {
        start.min(MID_END_M[0])
    } else {
        MID_NEAREST_M
    }
}

/// Weight of the middle tier (cards) at a distance: S(b → 1.5 b) − S(24 → 36 m). Units: none, in [0, 1].
///
/// Arguments as in [`near_weight`].
///
/// Error: 1e-15.
#[must_use]
pub fn mid_weight(distance_m: f64, range_m: f64) -> f64 {
    let b = mid_start_m(range_m);
    ramp(distance_m, b, 1.5 * b) - ramp(distance_m, MID_END_M[0], MID_END_M[1])
}

/// ∫₀ˢ [`mid_weight`], the G_m of the account. Units: m. Arguments as in [`near_depth_m`].
///
/// Error: 1e-13 m against the integral, up to 400 m.
#[must_use]
pub fn mid_depth_m(way_m: f64, range_m: f64) -> f64 {
    let b = mid_start_m(range_m);
    ramp_integral_m(way_m, b, 1.5 * b) - ramp_integral_m(way_m, MID_END_M[0], MID_END_M[1])
}

/// Mean weight of one card that stands for `cell_m` of depth around `distance_m`: [G_m(r + a/2) − G_m(r − a/2)]/a.
///
/// Adjacent cards add up to G_m. `cell_m`: a, m, clamped to [1e-3, 1e3], NaN counts as 1e-3; others as in
/// [`mid_weight`].
/// Units: none, in [0, 1].
///
/// Error: 1e-13 m over the card's depth: 1e-13 from cells of 0.5 m on, 1e-10 at 1 mm.
#[must_use]
pub fn card_weight(distance_m: f64, cell_m: f64, range_m: f64) -> f64 {
    let a = if cell_m > 1e-3 { cell_m.min(1e3) } else { 1e-3 };
    let mean = (mid_depth_m(distance_m + 0.5 * a, range_m) - mid_depth_m(distance_m - 0.5 * a, range_m)) / a;
    mean.clamp(0.0, 1.0)
}

/// Coverage that a card's texture must have on average, 1 − e^(−σ a). Units: none.
///
/// `extinction_per_m`: geometric extinction of its class, 1/m; `cell_m`: a, m; negative or NaN products count as 0.
///
/// Error: 1e-15 relative.
#[must_use]
pub fn card_coverage(extinction_per_m: f64, cell_m: f64) -> f64 {
    obscured(extinction_per_m * cell_m)
}

/// Optical depth left to fog when drops are drawn with one share up to one range: σ_geo (Q s − q min(s, s_n)).
///
/// `extinction_per_m`: σ_geo, 1/m ≥ 0; `efficiency`: Q, at least `drawn_share`; `way_m`: s, m; `range_m`: s_n, m;
/// `drawn_share`: q, clamped to [0, 1]; NaN counts as 0. Units: none, ≥ 0.
///
/// Error: 1e-15 of Q σ s.
#[must_use]
pub fn single_range_fog_depth(
    extinction_per_m: f64,
    efficiency: f64,
    way_m: f64,
    range_m: f64,
    drawn_share: f64,
) -> f64 {
    let s = way(way_m);
    let q = if drawn_share > 0.0 { drawn_share.min(1.0) } else { 0.0 };
    let depth = way(extinction_per_m) * (way(efficiency).min(4.0) * s - q * s.min(way(range_m)));
    depth.max(0.0)
}

/// What is drawn of one size class.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DrawnClass {
    /// Share of the class in ∫D²N over all diameters, q_k. Units: none.
    pub share: f64,
    /// Range z_k up to which its drops are drawn singly. Units: m; 0: none.
    pub range_m: f64,
}

/// The account of one rain state and one view. 208 bytes; nothing is allocated.
///
/// Error: e^(−τ_fog) times the drops' mean transmittance is e^(−Qσs) within 1e-13 against the drops' integral;
/// the whole depth and its sum of parts 1e-10 relative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HazeSharing {
    geometric_per_m: f64,
    efficiency: f64,
    classes: [DrawnClass; CLASS_COUNT],
    mid_tier: bool,
}

impl HazeSharing {
    /// `spectrum`: the rain; `efficiency`: Q, in [1, 4] (below 1 the fog would have to shine); `ranges_m`: z_k of each
    /// class, m, in [0, 1e6]; `mid_tier`: whether cards are drawn.
    ///
    /// # Errors
    /// When Q or a range is not finite or outside its range.
    pub fn new(
        spectrum: &Spectrum,
        efficiency: f64,
        ranges_m: [f64; CLASS_COUNT],
        mid_tier: bool,
    ) -> Result<Self, ConfigError> {
        let efficiency = in_range("efficiency", efficiency, 1.0, 4.0, "1 to 4")?;
        let all = spectrum.moment(2, 0.0, f64::INFINITY);
        let mut classes = [DrawnClass::default(); CLASS_COUNT];
        for (k, (class, range)) in classes.iter_mut().zip(ranges_m).enumerate() {
            let range_m = in_range("ranges_m", range, 0.0, 1e6, "0 to 1e6 m")?;
            let own = spectrum.moment(2, CLASS_EDGES_MM[k], CLASS_EDGES_MM[k + 1]);
            *class = DrawnClass {
                share: if all > 0.0 { own / all } else { 0.0 },
                range_m,
            };
        }
        Ok(Self {
            geometric_per_m: spectrum.extinction_per_m(0.0, f64::INFINITY),
            efficiency,
            classes,
            mid_tier,
        })
    }

    /// The classes' shares and ranges.
    #[must_use]
    pub fn classes(&self) -> &[DrawnClass; CLASS_COUNT] {
        &self.classes
    }

    /// Optical depth of drawn drops on a way s (m, clamped to [0, 1e9], NaN counts as 0). Units: none.
    #[must_use]
    pub fn drawn_depth(&self, way_m: f64) -> f64 {
        let metres: f64 = self
            .classes
            .iter()
            .map(|class| {
                let mid = if self.mid_tier {
                    mid_depth_m(way_m, class.range_m)
                } else {
                    0.0
                };
                class.share * (near_depth_m(way_m, class.range_m) + mid)
            })
            .sum();
        self.geometric_per_m * metres
    }

    /// Optical depth of the whole rain, Q σ_geo s. Units: none.
    #[must_use]
    pub fn total_depth(&self, way_m: f64) -> f64 {
        self.efficiency * self.geometric_per_m * way(way_m)
    }

    /// Optical depth left to the fog, never negative and never falling with s. Units: none.
    #[must_use]
    pub fn fog_depth(&self, way_m: f64) -> f64 {
        (self.total_depth(way_m) - self.drawn_depth(way_m)).max(0.0)
    }

    /// Transmittance of the fog alone. Units: none.
    #[must_use]
    pub fn fog_transmittance(&self, way_m: f64) -> f64 {
        transmittance(self.fog_depth(way_m))
    }
}

/// Entries of a [`FogTable`].
pub const FOG_TABLE_KNOTS: usize = 64;
const TABLE: usize = FOG_TABLE_KNOTS;
/// Distance from which on nothing is drawn any more, the last entry of a [`FogTable`]. Units: m.
pub const FOG_TABLE_END_M: f64 = MID_END_M[1];

/// Optical depth of the fog as a table over distance in single precision, for drops whose range depends on their own
/// diameter. 264 bytes; nothing is allocated.
///
/// Entries stand at s = 36 t² m, t even in [0, 1]; beyond 36 m all weights have ended, and the depth is a straight
/// line.
///
/// Error: optical depth within σ_geo · 0.02 m of the integral over diameters (2e-5 at 25 mm/h); 0.003 m without cards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FogTable {
    depth: [f32; TABLE],
    slope_per_m: f32,
}

impl FogTable {
    /// `range_m`: z_s(D), from mm to m, at most 30 m, longer ones count as that; others as in [`HazeSharing::new`].
    /// About 100 µs: rebuild when rain or quality changes.
    ///
    /// # Errors
    /// When Q is not finite or outside [1, 4].
    pub fn new(
        spectrum: &Spectrum,
        efficiency: f64,
        mid_tier: bool,
        range_m: impl Fn(f64) -> f64,
    ) -> Result<Self, ConfigError> {
        const CUTS: usize = 4;
        let q = in_range("efficiency", efficiency, 1.0, 4.0, "1 to 4")?;
        // Each class in a few slices of diameter, each with its own share of D²N.
        let mut slices = [(0.0, 0.0); CUTS * CLASS_COUNT];
        for (i, slice) in slices.iter_mut().enumerate() {
            let (from, to) = (CLASS_EDGES_MM[i / CUTS], CLASS_EDGES_MM[i / CUTS + 1]);
            let at = |j: usize| from + (to - from) * j as f64 / CUTS as f64;
            let (low, high) = (at(i % CUTS), at(i % CUTS + 1));
            *slice = (
                spectrum.extinction_per_m(low, high),
                clamped(range_m(0.5 * (low + high)), 0.0, MAX_TABLE_RANGE_M),
            );
        }
        let total = q * spectrum.extinction_per_m(0.0, f64::INFINITY);
        let depth = core::array::from_fn(|i| {
            let s = distance_at(i);
            let drawn: f64 = slices
                .iter()
                .map(|&(extinction, range)| {
                    let mid = if mid_tier { mid_depth_m(s, range) } else { 0.0 };
                    extinction * (near_depth_m(s, range) + mid)
                })
                .sum();
            (total * s - drawn).max(0.0) as f32
        });
        Ok(Self {
            depth,
            slope_per_m: total as f32,
        })
    }

    /// Metres of the whole rain that what is drawn stands for, at s = 36 t² m, t even in [0, 1]: the whole depth less the
    /// fog's, over the extinction. Units: m. 0 where it is dry.
    #[must_use]
    pub fn drawn_m(&self) -> [f32; FOG_TABLE_KNOTS] {
        core::array::from_fn(|i| {
            if self.slope_per_m > 0.0 {
                (distance_at(i) as f32 - self.depth[i] / self.slope_per_m).max(0.0)
            } else {
                0.0
            }
        })
    }

    /// Optical depth of the fog at a distance (m, clamped to [0, 1e9], NaN counts as 0). Units: none.
    #[must_use]
    #[inline]
    pub fn depth_f32(&self, way_m: f32) -> f32 {
        let s = if way_m > 0.0 { way_m.min(1e9) } else { 0.0 };
        let end = MID_END_M[1] as f32;
        let last = (TABLE - 1) as f32;
        if s >= end {
            return self.depth[TABLE - 1] + self.slope_per_m * (s - end);
        }
        let i = ((s / end).sqrt() * last) as usize;
        let i = i.min(TABLE - 2);
        let (from, to) = (
            end * (i as f32 / last) * (i as f32 / last),
            end * ((i + 1) as f32 / last) * ((i + 1) as f32 / last),
        );
        self.depth[i] + (self.depth[i + 1] - self.depth[i]) * ((s - from) / (to - from)).clamp(0.0, 1.0)
    }
}

/// Distance of entry i. Units: m.
fn distance_at(i: usize) -> f64 {
    let t = i as f64 / (TABLE - 1) as f64;
    MID_END_M[1] * t * t
}
