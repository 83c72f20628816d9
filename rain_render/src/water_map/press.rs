//! Wheels and feet that press the film.

use rain_core::error::{ConfigError, in_range};

use crate::gpu_types::WaterStamp;

/// Most presses in a frame; the others wait.
pub const MAX_PRESSES: usize = 512;

/// Water goes to bands of this width beside the way, or of a texel. Units: m.
const BAND_M: f64 = 0.25;

/// A wheel or a foot on its straight way, as [`rain_core::surface::ground::Ground::press`] takes it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WaterPress {
    /// Where it was, world (x, z). Units: m. Domain: [−1e7, 1e7].
    pub from_m: [f64; 2],
    /// Where it is. Units: m.
    pub to_m: [f64; 2],
    /// Half of its width. Units: m. Domain: [0, 10].
    pub half_width_m: f64,
    /// Share of the film under it that goes. Units: none. Domain: [0, 1].
    pub share: f64,
    /// Share of this that does not come down beside the way. Units: none. Domain: [0, 1].
    pub thrown: f64,
}

impl WaterPress {
    pub(super) fn check(&self) -> Result<(), ConfigError> {
        for at in self.from_m.into_iter().chain(self.to_m) {
            in_range("place", at, -1e7, 1e7, "-1e7 to 1e7 m")?;
        }
        in_range("half_width_m", self.half_width_m, 0.0, 10.0, "0 to 10 m")?;
        in_range("share", self.share, 0.0, 1.0, "0 to 1")?;
        in_range("thrown", self.thrown, 0.0, 1.0, "0 to 1")?;
        in_range("length of the way", self.length_m(), 0.0, 100.0, "0 to 100 m").map(|_| ())
    }

    fn length_m(&self) -> f64 {
        let [x, z] = [0, 1].map(|axis| self.to_m[axis] - self.from_m[axis]);
        (x * x + z * z).sqrt()
    }

    /// What a level with this corner (m), texel (m) and number of texels does; nothing where the way does not reach it.
    pub(super) fn stamp(&self, corner_m: [f64; 2], cell_m: f64, texels: u32, slot: u32) -> Option<WaterStamp> {
        let length = self.length_m();
        let half = self.half_width_m;
        // A press on one place is a square.
        let (start, along, length) = if length > 1e-9 {
            let along = [0, 1].map(|axis| (self.to_m[axis] - self.from_m[axis]) / length);
            (self.from_m, along, length)
        } else {
            ([self.from_m[0] - half, self.from_m[1]], [1.0, 0.0], 2.0 * half)
        };
        let band = BAND_M.max(cell_m);
        let reach = half + band + cell_m;
        let range = |axis: usize| {
            let (a, b) = (start[axis], start[axis] + along[axis] * length);
            let texel = |at: f64| ((at - corner_m[axis]) / cell_m).floor().clamp(-1.0, f64::from(texels));
            let low = texel(a.min(b) - reach).max(0.0);
            let high = (texel(a.max(b) + reach) + 1.0).min(f64::from(texels));
            (low as i32, (high - low).max(0.0) as i32)
        };
        let [(x, columns), (z, rows)] = [range(0), range(1)];
        (columns > 0 && rows > 0).then(|| WaterStamp {
            low: [x, z],
            count: [columns, rows],
            start: [0, 1].map(|axis| (start[axis] - corner_m[axis]) as f32),
            along: along.map(|a| a as f32),
            length: length as f32,
            half: half as f32,
            share: self.share as f32,
            aside: (1.0 - self.thrown) as f32,
            band: band as f32,
            slot,
            pad_a: 0,
            pad_b: 0,
        })
    }
}
