//! Procedural rings: one circle texture in four layers with clocks of their own.
//!
//! Each circle of a [`CircleMap`] carries a ring that runs from its middle to its rim and fades; the cycle starts anew
//! at once. Four layers of the same texture lie over each other, moved, and run at slightly different rates, which
//! repeat together after 100 cycles of the first. The intensity brings the layers in one after the other. Source:
//! Lagarde 2013. Choices: [`RingGrowth::Number`], the intensity from the drops of the rain, and the share of small rings.
//!
//! # Accuracy
//! A look, held to the rain in two numbers. Rings are as many as drops above [`RingLayerSettings::least_drop_mm`] fall,
//! until all circles are in use; steeper rings stand for more up to twice the steepness. The mean square slope of the
//! map, with what it keeps as variance, is that of [`rain_slope_variance`]. A ring's speed is a radius in a cycle, 0.05
//! to 0.16 m/s by default, where water of 5 mm has 0.22 m/s; rings do not cross the rims of their circles.

use std::sync::Arc;

use super::circles::{CircleMap, CirclePoint, CircleSettings};
use super::slope_variance::rain_slope_variance;
use crate::error::{ConfigError, clamped, in_range};
use crate::hash;
use crate::ops;
use crate::rainfall::{DropSizes, terminal_velocity};
use crate::weather::relative_intensity;

/// Number of layers.
pub const RING_LAYERS: usize = 4;

/// Rate of each layer's clock over that of the first. Source: Lagarde 2013.
const RATES: [f64; RING_LAYERS] = [1.0, 0.85, 0.93, 1.13];
/// By how much each clock is ahead. Units: cycles. Source: Lagarde 2013, its shifts of 0, 0.2, 0.45, 0.7 s at 1.6 Hz.
const PHASES: [f64; RING_LAYERS] = [0.0, 0.32, 0.72, 1.12];
/// How far each layer is moved. Units: sides of the circle texture. Source: Lagarde 2013.
const OFFSETS: [[f64; 2]; RING_LAYERS] = [[0.25, 0.0], [-0.55, 0.3], [0.6, 0.85], [0.5, -0.75]];
/// Cycles of the first clock, and of each, after which all are as they were.
const PERIOD: f64 = 100.0;
/// Cycles after which each layer starts anew.
pub const RING_CYCLES: [u32; RING_LAYERS] = [100, 85, 93, 113];
/// Share of a layer's circles over which their rings fade in as it grows.
pub const RING_FADE: f32 = 0.1;
/// Largest multiple of the steepness.
const LARGEST_GAIN: f64 = 2.0;
/// Largest drop. Units: mm.
const LARGEST_MM: f64 = 8.0;
/// Steps of weight, nearness and phase for the mean square of a ring.
const WEIGHTS: usize = 32;
const NEAR_BINS: usize = 64;
const PHASE_STEPS: usize = 128;

/// What brings layers in.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum RingIntensity {
    /// As many rings as drops above [`RingLayerSettings::least_drop_mm`] fall on the same water.
    #[default]
    Drops,
    /// The artists' rows: 2, 5 and 10 mm/h are 0.33, 0.66 and 1 ([`relative_intensity`]).
    Rows,
    /// This, while it rains. Units: none. Domain: [0, 1].
    Fixed(f64),
}

/// What a layer that is coming in has more of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum RingGrowth {
    /// Rings: in each cycle, chance decides anew which of its circles have one.
    #[default]
    Number,
    /// Strength: all of its circles have one, weak and short-lived at first. The source's way.
    Strength,
}

/// Settings of [`RingLayers`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RingLayerSettings {
    /// The circles.
    pub circles: CircleSettings,
    /// Texels of the map on a side. Domain: a power of two in [32, 1024]. Default: 256.
    pub cells: u32,
    /// Side of the map, after which it repeats. Units: m. Domain: [0.1, 20]. Default: 1.
    pub side_m: f64,
    /// How often the circle texture lies along a side: a whole number, so that the map tiles. Domain: [1, 16].
    /// Default: 1.
    pub repeats: u32,
    /// Rate of the first layer's clock. Units: 1/s. Domain: [0.1, 10]. Default: 1.6, the source's.
    pub frequency_hz: f64,
    /// Slope of a ring for a profile of 1. Units: none. Domain: [0, 1]. Default: 0.35, the source's.
    pub steepness: f64,
    /// What brings layers in.
    pub intensity: RingIntensity,
    /// What a growing layer has more of.
    pub growth: RingGrowth,
    /// Smaller drops make no ring that is drawn. Units: mm. Domain: [0.5, 5]. Default: 2.
    pub least_drop_mm: f64,
    /// Whether the map also holds, as variance, the slopes of all rings that are not drawn, so that in sum it is as
    /// rough as the rain makes the water. Default: true; the source has none.
    pub small_rings: bool,
    /// Depth and damping k_d of the water, for `small_rings`. Units: m. Domain: [1e-3, 1]. Default: 0.005.
    pub depth_m: f64,
    /// See `depth_m`. Units: 1/s. Domain: [0.01, 100]. Default: 0.6, that of the solver's tile.
    pub damping_per_s: f64,
}

impl Default for RingLayerSettings {
    fn default() -> Self {
        Self {
            circles: CircleSettings::default(),
            cells: 256,
            side_m: 1.0,
            repeats: 1,
            frequency_hz: 1.6,
            steepness: 0.35,
            intensity: RingIntensity::default(),
            growth: RingGrowth::default(),
            least_drop_mm: 2.0,
            small_rings: true,
            depth_m: 0.005,
            damping_per_s: 0.6,
        }
    }
}

impl RingLayerSettings {
    /// As the source has them: perfect circles, layers that grow in strength by the artists' rows, nothing but rings.
    #[must_use]
    pub fn lagarde() -> Self {
        Self {
            circles: CircleSettings {
                distortion: 0.0,
                ..CircleSettings::default()
            },
            intensity: RingIntensity::Rows,
            growth: RingGrowth::Strength,
            small_rings: false,
            ..Self::default()
        }
    }

    fn check(&self) -> Result<(), ConfigError> {
        if !(self.cells.is_power_of_two() && (32..=1024).contains(&self.cells)) {
            return Err(ConfigError::OutOfRange {
                field: "cells",
                value: f64::from(self.cells),
                allowed: "a power of two in 32 to 1024",
            });
        }
        in_range("side_m", self.side_m, 0.1, 20.0, "0.1 to 20 m")?;
        in_range("repeats", f64::from(self.repeats), 1.0, 16.0, "1 to 16")?;
        in_range("frequency_hz", self.frequency_hz, 0.1, 10.0, "0.1 to 10 1/s")?;
        in_range("steepness", self.steepness, 0.0, 1.0, "0 to 1")?;
        if let RingIntensity::Fixed(intensity) = self.intensity {
            in_range("intensity", intensity, 0.0, 1.0, "0 to 1")?;
        }
        in_range("least_drop_mm", self.least_drop_mm, 0.5, 5.0, "0.5 to 5 mm")?;
        in_range("depth_m", self.depth_m, 1e-3, 1.0, "0.001 to 1 m")?;
        in_range("damping_per_s", self.damping_per_s, 0.01, 100.0, "0.01 to 100 1/s").map(|_| ())
    }
}

/// Weights of the layers: one for each quarter of the intensity, ω_k = 4 (I − k/4) held in [0, 1].
///
/// `intensity` in [0, 1], held there; what is not a number counts as 0. Source: Lagarde 2013.
///
/// Error: exact up to one rounding.
#[must_use]
pub fn ring_layer_weights(intensity: f64) -> [f64; RING_LAYERS] {
    let intensity = clamped(intensity, 0.0, 1.0);
    [0.0, 0.25, 0.5, 0.75].map(|start| clamped(4.0 * (intensity - start), 0.0, 1.0))
}

/// Clocks of the layers `time_s` after the start: the part of the present cycle in [0, 1), and the number of whole
/// cycles before it, modulo [`RING_CYCLES`].
///
/// `time_s` in s, below 0 and what is not a number count as 0; `frequency_hz` in 1/s, held in [0, 1e3]. Seamless for
/// ever: all clocks repeat after 100 cycles of the first. Source: Lagarde 2013.
///
/// Error: 1e-12 of a cycle in the first hour, 1e-6 after thirty years.
#[must_use]
pub fn ring_clocks(time_s: f64, frequency_hz: f64) -> ([f64; RING_LAYERS], [u32; RING_LAYERS]) {
    let cycles = clamped(time_s, 0.0, f64::MAX) * clamped(frequency_hz, 0.0, 1e3);
    let cycles = if cycles.is_finite() { cycles % PERIOD } else { 0.0 };
    let (mut parts, mut wholes) = ([0.0; RING_LAYERS], [0; RING_LAYERS]);
    for layer in 0..RING_LAYERS {
        let turns = cycles * RATES[layer] + PHASES[layer];
        let whole = turns.floor();
        parts[layer] = turns - whole;
        wholes[layer] = whole as u32 % RING_CYCLES[layer];
    }
    (parts, wholes)
}

/// Slope of a ring outwards, over the steepness: E R sin(π clamp(9q, 0, 3)), q = p − 1 + R, E = 0.2 + 0.8 ω − p held
/// in [0, 1].
///
/// `nearness` R is 1 in the middle of the circle and 0 on its rim, `phase` p the part of its cycle that has passed,
/// `weight` ω that of its layer, each in [0, 1]. The wave lies between p − ⅓ and p radii from the middle, and its front
/// runs a radius in a cycle. Source: Lagarde 2013.
///
/// Error: absolute 3e-6 against the formula in double precision.
#[must_use]
pub fn ring_profile_f32(nearness: f32, phase: f32, weight: f32) -> f32 {
    let fade = (0.2 + 0.8 * weight - phase).clamp(0.0, 1.0);
    let along = (9.0 * (phase - 1.0 + nearness)).clamp(0.0, 3.0);
    fade * nearness * ops::sin(f64::from(core::f32::consts::PI * along)) as f32
}

/// Strength of the ring of a circle whose chance is `chance` when a layer has the weight `weight`: 1 for that share of
/// the circles, with a soft edge of [`RING_FADE`].
///
/// Both in [0, 1]. Source: choice.
///
/// Error: absolute 3e-6 against the formula in double precision.
#[must_use]
pub fn ring_presence_f32(chance: f32, weight: f32) -> f32 {
    ((weight * (1.0 + RING_FADE) - chance) * (1.0 / RING_FADE)).clamp(0.0, 1.0)
}

/// Mean of the square of [`ring_presence_f32`] over all chances.
fn mean_square_presence(weight: f64) -> f64 {
    let fade = f64::from(RING_FADE);
    let reach = weight * (1.0 + fade);
    if reach >= fade {
        reach - fade + fade / 3.0
    } else {
        reach * reach * reach / (3.0 * fade * fade)
    }
}

/// What the rain does to the layers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RingForcing {
    /// How much of the layers is there. Units: none, [0, 1].
    pub intensity: f64,
    /// Multiple of the steepness, [0, 2].
    pub gain: f64,
    /// Variance of the slopes of rings that are not drawn, the sum of both directions. Units: none.
    pub hidden_variance: f64,
}

/// The layers at a moment.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RingLayerState {
    /// Part of the present cycle, in [0, 1).
    pub parts: [f32; RING_LAYERS],
    /// Whole cycles.
    pub wholes: [u32; RING_LAYERS],
    /// Weights.
    pub weights: [f32; RING_LAYERS],
    /// Slope of a ring for a profile of 1.
    pub steepness: f32,
}

/// Procedural rings of four layers.
#[derive(Debug, Clone, PartialEq)]
pub struct RingLayers {
    settings: RingLayerSettings,
    circles: Arc<CircleMap>,
    /// Mean square of the profile over the map and a cycle, for even steps of the weight from 0 to 1.
    mean_squares: [f64; WEIGHTS + 1],
}

impl RingLayers {
    /// Makes the circles. Takes tens of milliseconds.
    ///
    /// # Errors
    /// [`ConfigError::OutOfRange`] for a setting outside its domain.
    pub fn new(settings: &RingLayerSettings) -> Result<Self, ConfigError> {
        settings.check()?;
        let circles = CircleMap::new(&settings.circles)?;
        let mean_squares = mean_squares(&circles);
        Ok(Self {
            settings: *settings,
            circles: Arc::new(circles),
            mean_squares,
        })
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &RingLayerSettings {
        &self.settings
    }

    /// The circles.
    #[must_use]
    pub fn circles(&self) -> &Arc<CircleMap> {
        &self.circles
    }

    /// Rings that each layer starts when it is full. Units: 1/(m² s).
    fn capacities_per_m2_s(&self) -> [f64; RING_LAYERS] {
        let per_side = f64::from(self.settings.repeats) / self.settings.side_m;
        let circles = self.circles.circles().len() as f64 * per_side * per_side;
        RATES.map(|rate| circles * self.settings.frequency_hz * rate)
    }

    /// Rings that start on a square metre in a second. Units: 1/(m² s).
    #[must_use]
    pub fn rings_per_m2_s(&self, intensity: f64) -> f64 {
        let weights = ring_layer_weights(intensity);
        self.capacities_per_m2_s().iter().zip(weights).map(|(c, w)| c * w).sum()
    }

    /// The least intensity at which so many rings start, 1 where they never do. Inverse of [`Self::rings_per_m2_s`].
    /// Error: of the number of rings, relative 1e-9.
    #[must_use]
    pub fn intensity_of(&self, rings_per_m2_s: f64) -> f64 {
        let mut left = clamped(rings_per_m2_s, 0.0, f64::MAX);
        let mut intensity = 0.0;
        for capacity in self.capacities_per_m2_s() {
            intensity += 0.25 * (left / capacity).min(1.0);
            left = (left - capacity).max(0.0);
        }
        intensity
    }

    /// Mean square slope of the rings that are drawn, the sum of both directions, over map and time. Units: none.
    ///
    /// Error: relative 5e-2 against the mean over 40 moments of a map; layers that overlap are independent of each other.
    #[must_use]
    pub fn drawn_slope_variance(&self, intensity: f64, gain: f64) -> f64 {
        let steepness = self.settings.steepness * gain;
        let layer = |weight: f64| match self.settings.growth {
            RingGrowth::Number => mean_square_presence(weight) * self.mean_squares[WEIGHTS],
            RingGrowth::Strength => {
                let at = weight * WEIGHTS as f64;
                let low = (at as usize).min(WEIGHTS - 1);
                let [a, b] = [self.mean_squares[low], self.mean_squares[low + 1]];
                weight * weight * (a + (b - a) * (at - low as f64))
            }
        };
        steepness * steepness * ring_layer_weights(intensity).map(layer).iter().sum::<f64>()
    }

    /// What this rain does: nothing without rain.
    ///
    /// Error: as many rings as drops to 1e-9 until all circles are in use; a map with what it hides is as rough as the
    /// rain makes the water within 0.12.
    #[must_use]
    pub fn forcing(&self, rain: &DropSizes) -> RingForcing {
        let rate_mm_h = rain.rain_rate_mm_h(0.0, LARGEST_MM, terminal_velocity);
        if rate_mm_h <= 0.0 {
            return RingForcing::default();
        }
        let (intensity, gain) = match self.settings.intensity {
            RingIntensity::Drops => {
                let drops = rain.flux_moment(0, self.settings.least_drop_mm, LARGEST_MM, terminal_velocity);
                let most = self.rings_per_m2_s(1.0);
                (
                    self.intensity_of(drops),
                    ops::sqrt((drops / most).max(1.0)).min(LARGEST_GAIN),
                )
            }
            RingIntensity::Rows => (relative_intensity(rate_mm_h), 1.0),
            RingIntensity::Fixed(intensity) => (intensity, 1.0),
        };
        let hidden_variance = if self.settings.small_rings {
            let all = rain_slope_variance(rain, self.settings.depth_m, self.settings.damping_per_s, 0.0);
            (all - self.drawn_slope_variance(intensity, gain)).max(0.0)
        } else {
            0.0
        };
        RingForcing {
            intensity,
            gain,
            hidden_variance,
        }
    }

    /// The layers `time_s` after the start.
    #[must_use]
    pub fn state(&self, time_s: f64, intensity: f64, gain: f64) -> RingLayerState {
        let (parts, wholes) = ring_clocks(time_s, self.settings.frequency_hz);
        RingLayerState {
            parts: parts.map(|part| part as f32),
            wholes,
            weights: ring_layer_weights(intensity).map(|weight| weight as f32),
            steepness: (self.settings.steepness * gain) as f32,
        }
    }

    /// By how many texels of the circle texture each layer is moved (x, z).
    #[must_use]
    pub fn offsets(&self) -> [[u32; 2]; RING_LAYERS] {
        let texels = i64::from(self.settings.circles.texels);
        OFFSETS.map(|offset| offset.map(|part| ((part * texels as f64).round() as i64).rem_euclid(texels) as u32))
    }

    /// Slope of the water in a cell of the map (∂h/∂x, ∂h/∂z): the layers summed by their weights. With the upward
    /// part of 1 and normalised it is the composed normal.
    ///
    /// Error: absolute 5e-6 of the steepness against the formula in double precision; the texel below the cell's
    /// middle is taken, none between two.
    #[must_use]
    pub fn slope(&self, state: &RingLayerState, column: u32, row: u32) -> [f32; 2] {
        let mut sum = [0.0_f32; 2];
        for (layer, offset) in (0..).zip(self.offsets()) {
            let [x, z] = [column, row].map(|cell| self.texel_of(cell));
            let point = self.circles.at(x.wrapping_add(offset[0]), z.wrapping_add(offset[1]));
            let strength = layer_strength(&point, state, layer, self.settings.growth);
            sum[0] += strength * point.outward[0];
            sum[1] += strength * point.outward[1];
        }
        sum.map(|part| -state.steepness * part)
    }

    /// Texel of the circle texture below the middle of a cell, before it is moved.
    fn texel_of(&self, cell: u32) -> u32 {
        (2 * cell + 1) * self.settings.repeats * self.settings.circles.texels / (2 * self.settings.cells)
    }
}

/// Slope of a layer outwards, over the steepness.
fn layer_strength(point: &CirclePoint, state: &RingLayerState, layer: u32, growth: RingGrowth) -> f32 {
    let index = layer as usize;
    let turns = point.offset as f32 * (1.0 / 65536.0) + state.parts[index];
    let begun = turns.floor();
    let phase = turns - begun;
    let weight = state.weights[index];
    match growth {
        RingGrowth::Number => {
            let cycle = (state.wholes[index] + begun as u32) % RING_CYCLES[index];
            let [chance, _, _] = hash::pcg3d([point.offset, layer, cycle]);
            let presence = ring_presence_f32(hash::unit_f32(chance), weight);
            presence * ring_profile_f32(point.nearness, phase, 1.0)
        }
        RingGrowth::Strength => weight * ring_profile_f32(point.nearness, phase, weight),
    }
}

fn mean_squares(circles: &CircleMap) -> [f64; WEIGHTS + 1] {
    let mut bins = [0_u32; NEAR_BINS];
    for texel in circles.texels() {
        let nearness = CirclePoint::of(*texel).nearness;
        if nearness > 0.0 {
            bins[((nearness * NEAR_BINS as f32) as usize).min(NEAR_BINS - 1)] += 1;
        }
    }
    let count = (circles.texels().len() * PHASE_STEPS) as f64;
    core::array::from_fn(|index| {
        let weight = index as f32 / WEIGHTS as f32;
        let mut sum = 0.0;
        for (bin, texels) in bins.iter().enumerate() {
            let nearness = (bin as f32 + 0.5) / NEAR_BINS as f32;
            for step in 0..PHASE_STEPS {
                let phase = (step as f32 + 0.5) / PHASE_STEPS as f32;
                let profile = f64::from(ring_profile_f32(nearness, phase, weight));
                sum += profile * profile * f64::from(*texels);
            }
        }
        sum / count
    })
}
