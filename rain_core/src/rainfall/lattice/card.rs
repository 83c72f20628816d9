//! One card: a cell's picture of one size class, and what a line of sight meets of it.

use glam::{Vec2, Vec3};

use crate::hash::{pcg3d, unit_f32};
use crate::haze::ramp;
use crate::rainfall::StreakTextures;

/// Cosines of the pitch at which cards are gone and whole: 60 and 45 degrees.
const PITCH_RAMP: [f64; 2] = [0.5, core::f64::consts::FRAC_1_SQRT_2];

/// Weight of cards by the pitch of a line of sight: whole to 45°, none from 60° on, where upright cards are seen edge-on.
/// Units: none, in [0, 1].
///
/// `cos_pitch`: length of the direction's horizontal part, none; NaN counts as 0.
///
/// Error: 1e-14.
#[must_use]
pub fn pitch_weight(cos_pitch: f64) -> f64 {
    ramp(cos_pitch, PITCH_RAMP[0], PITCH_RAMP[1])
}

/// A cell's picture of one class: 80 bytes, uploaded as it is.
///
/// Error: where a line of sight meets it, and the place in the picture there, 1e-5 m.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Card {
    /// Middle relative to the eye, m; w: half its side, m.
    pub centre: [f32; 4],
    /// x and z of its normal, which is level and looks to the eye; opacity over that of one picture; 1 / fall speed, s/m.
    pub facing: [f32; 4],
    /// Place in the picture for a metre across (to the right) and a metre up: u, v, u, v. Units: turns/m.
    pub turn: [f32; 4],
    /// Place in the picture of the middle, in turns; share of the heavier rain's picture; share of the light behind that
    /// haze lets through on the way to the card.
    pub place: [f32; 4],
    /// Layers of the lighter and the heavier rain, pictures laid over each other, hash of the cell's column.
    pub layers: [u32; 4],
}

/// Where a line of sight meets a card.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CardHit {
    /// Distance from the eye. Units: m.
    pub distance_m: f32,
    /// Place in the picture, in turns.
    pub place: Vec2,
    /// Opacity over that of a card that is seen square on: more where the line passes it at a slant, less where cards
    /// end.
    pub slant: f32,
}

impl Card {
    /// Where a line of sight from the eye, along a unit vector, meets the card; `None` beside it.
    #[must_use]
    pub fn meet(&self, direction: Vec3) -> Option<CardHit> {
        let centre = Vec3::new(self.centre[0], self.centre[1], self.centre[2]);
        let normal = Vec3::new(self.facing[0], 0.0, self.facing[1]);
        let head_on = -direction.dot(normal);
        if head_on < 1e-3 {
            return None;
        }
        let distance_m = -centre.dot(normal) / head_on;
        let from_middle = direction * distance_m - centre;
        // To the right of one who looks at the card.
        let right = Vec3::new(normal.z, 0.0, -normal.x);
        let local = Vec2::new(from_middle.dot(right), from_middle.y);
        if distance_m <= 0.0 || local.abs().max_element() >= self.centre[3] {
            return None;
        }
        let level = (1.0 - direction.y * direction.y).max(0.0).sqrt();
        let [ua, va, ub, vb] = self.turn;
        Some(CardHit {
            distance_m,
            place: Vec2::new(
                self.place[0] + local.x * ua + local.y * ub,
                self.place[1] + local.x * va + local.y * vb,
            ),
            slant: pitch_weight(f64::from(level)) as f32 / head_on,
        })
    }

    /// Offset of one of the card's pictures, in turns: the first has none.
    #[must_use]
    pub fn sample_offset(&self, sample: u32) -> Vec2 {
        if sample == 0 {
            return Vec2::ZERO;
        }
        let h = pcg3d([self.layers[3], sample, self.layers[0]]);
        Vec2::new(unit_f32(h[0]), unit_f32(h[1]))
    }

    /// Opacity where a line of sight meets the card, from the textures on the CPU, nearest texels of a level.
    #[must_use]
    pub fn opacity(&self, hit: &CardHit, set: &StreakTextures, level: usize) -> f32 {
        let side = (set.settings.texels >> level).max(1) as usize;
        let texel = |layer: u32, at: Vec2| {
            let texture = &set.textures[layer as usize];
            let [x, y] = [at.x, at.y].map(|turns| ((turns - turns.floor()) * side as f32) as usize % side);
            texture.levels[level][y * side + x] * texture.layer.unit as f32
        };
        let mut through = 1.0;
        for sample in 0..self.layers[2] {
            let at = hit.place + self.sample_offset(sample);
            let (lighter, heavier) = (texel(self.layers[0], at), texel(self.layers[1], at));
            let opacity = lighter + (heavier - lighter) * self.place[2];
            through *= 1.0 - (opacity * self.facing[2] * hit.slant).clamp(0.0, 1.0);
        }
        1.0 - through
    }
}
