//! Fog the artists' way: amount by intensity, loss of colour, glow about lights. Source: Lagarde 2013 (digest E).
//!
//! # Accuracy
//! A look, no optics: the physical fog of rain is [`super::HazeSharing`].

use crate::error::{ConfigError, clamped, in_range};

/// Luminance of linear Rec. 709 colours: the default. Units: none.
pub const LUMA_LINEAR: [f64; 3] = [0.2126, 0.7152, 0.0722];
/// Luma of gamma-encoded Rec. 601 colours, as printed in the source (digest E, eq. 13). Units: none.
pub const LUMA_GAMMA: [f64; 3] = [0.299, 0.587, 0.114];

/// Rows Light, Moderate, Heavy of the source's table T3: relative intensity, fog amount.
const FOG_ROWS: [[f64; 2]; 4] = [[0.0, 0.0], [0.33, 0.15], [0.66, 0.4], [1.0, 1.0]];

/// Fog amount of a relative intensity: linear through 0, 0.33, 0.66, 1 → 0, 0.15, 0.4, 1. Units: none.
///
/// `relative_intensity`: clamped to [0, 1], NaN counts as 0 ([`crate::weather::relative_intensity`]). Digest E76, table
/// T3.
///
/// Error: 4e-16; a look.
#[must_use]
pub fn artist_fog_amount(relative_intensity: f64) -> f64 {
    let x = if relative_intensity > 0.0 {
        relative_intensity.min(1.0)
    } else {
        0.0
    };
    let mut amount = 1.0;
    for pair in FOG_ROWS.windows(2) {
        let [[x0, y0], [x1, y1]] = [pair[0], pair[1]];
        if x <= x1 {
            amount = y0 + (y1 - y0) * (x - x0) / (x1 - x0);
            break;
        }
    }
    amount
}

/// Fog density of an area in rain: its own × (1 + gain × amount). Units: those of `area_per_m`. Digest E, N25.
///
/// `area_per_m`: 1/m, in [0, 1e3]; `gain`: none, in [0, 1e3]; `amount`: none, in [0, 1]; clamped, NaN counts as 0.
///
/// Error: 1e-15 relative; a look.
#[must_use]
pub fn fog_density(area_per_m: f64, gain: f64, amount: f64) -> f64 {
    clamped(area_per_m, 0.0, 1e3) * (1.0 + clamped(gain, 0.0, 1e3) * clamped(amount, 0.0, 1.0))
}

/// A colour drawn towards its own luminance: lerp(colour, Y, weight), Y = luma · colour. Digest E, eq. 13.
///
/// `weight`: none, clamped to [0, 1], NaN counts as 0; `luma`: [`LUMA_LINEAR`] for linear colours; colours finite.
///
/// Error: 4e-16. Luminance under the same luma is kept.
#[must_use]
pub fn desaturated(colour: [f64; 3], weight: f64, luma: [f64; 3]) -> [f64; 3] {
    let w = if weight > 0.0 { weight.min(1.0) } else { 0.0 };
    let grey: f64 = colour.iter().zip(luma).map(|(c, l)| c * l).sum();
    colour.map(|c| c + (grey - c) * w)
}

/// How far the fog of an area has taken on its rainy look: up while it rains, down after, no jump on a restart
/// (digest E, N23).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FogFade {
    share: f64,
}

impl FogFade {
    /// Share in [0, 1]. Units: none.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.share
    }

    /// Advances by `dt_s` (s; not positive or NaN: nothing happens). `transition_s`: time from 0 to 1, s; 0 or less, or
    /// NaN: at once. Linear with clamp: cutting an interval changes nothing. Allocates nothing.
    ///
    /// Error: 1e-14 over 200 steps.
    pub fn advance(&mut self, raining: bool, dt_s: f64, transition_s: f64) {
        if dt_s.is_nan() || dt_s <= 0.0 {
            return;
        }
        let change = if transition_s > 0.0 {
            dt_s.min(1e9) / transition_s
        } else {
            1.0
        };
        self.share = (self.share + if raining { change } else { -change }).clamp(0.0, 1.0);
    }
}

/// ToyShop's glow about lights: bright pixels get less fog and more glow (digest E, eq. 14–16, N24).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToyShopGlow {
    bright: f64,
    greatest_fog: f64,
    glow_scale: f64,
}

impl ToyShopGlow {
    /// `bright`: luminance after exposure that gets no fog, in [1e-3, 1e6] (source: 10); `greatest_fog`: P.z, in
    /// [0, 1];
    /// `glow_scale`: P.w, in [0, 1e3].
    ///
    /// # Errors
    /// When a value is not finite or outside its range.
    pub fn new(bright: f64, greatest_fog: f64, glow_scale: f64) -> Result<Self, ConfigError> {
        Ok(Self {
            bright: in_range("bright", bright, 1e-3, 1e6, "1e-3 to 1e6")?,
            greatest_fog: in_range("greatest_fog", greatest_fog, 0.0, 1.0, "0 to 1")?,
            glow_scale: in_range("glow_scale", glow_scale, 0.0, 1e3, "0 to 1000")?,
        })
    }

    /// Fog factor φ = clamp(fog (1 − L/bright), 0, greatest). Units: none. NaN counts as 0.
    ///
    /// Error: 4e-16.
    #[must_use]
    pub fn factor(&self, fog: f64, luminance: f64) -> f64 {
        let phi = fog * (1.0 - luminance / self.bright);
        if phi > 0.0 { phi.min(self.greatest_fog) } else { 0.0 }
    }

    /// Colour lerp(C, fog colour, φ) and glow channel glow + scale · φ² of one pixel.
    ///
    /// Error: 4e-16.
    #[must_use]
    pub fn apply(&self, colour: [f64; 3], fog_colour: [f64; 3], glow: f64, factor: f64) -> ([f64; 3], f64) {
        (
            core::array::from_fn(|i| colour[i] + (fog_colour[i] - colour[i]) * factor),
            glow + self.glow_scale * factor * factor,
        )
    }
}
