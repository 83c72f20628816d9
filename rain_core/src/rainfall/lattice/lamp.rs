//! Lamps: what drops, single or on cards, show of a point or spot light.

use glam::Vec3;

use crate::ops;
use crate::rainfall::lamp_falloff_per_m2;

/// Most lamps that a view's rain is lit by. In a street of 176 lamps 48 give all of their light on the rain but 0.04 %.
pub const MAX_LAMPS: usize = 64;

/// Shares of light that go straight through a sphere of water, and that it reflects outside.
const TRANSMITTED: f32 = 0.884;
const REFLECTED: f32 = 0.066;
/// Largest phase: straight towards the eye.
const MAX_PHASE: f32 = 1.2;

/// A point or spot light near a view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lamp {
    /// Place relative to the eye. Units: m.
    pub position_m: Vec3,
    /// Luminous intensity times exposure: illuminance at a metre, exposed.
    pub intensity: Vec3,
    /// Where a spot light looks, unit; of a point light it does not count.
    pub direction: Vec3,
    /// Cosine of the angle up to which a spot is at its full intensity. −1 for a point light.
    pub cos_inner: f32,
    /// Cosine of the angle at which it ends, below `cos_inner`. −2 for a point light.
    pub cos_outer: f32,
    /// Radius of the lamp, which keeps its light finite. Units: m.
    pub radius_m: f32,
    /// Where its light has been made to end, by (1 − (d/range)⁴)² (Karis 2013). Units: m. Infinite: nowhere.
    pub range_m: f32,
}

impl Lamp {
    /// A lamp that shines in all directions.
    #[must_use]
    pub fn point(position_m: Vec3, intensity: Vec3, radius_m: f32) -> Self {
        Self {
            position_m,
            intensity,
            direction: Vec3::NEG_Y,
            cos_inner: -1.0,
            cos_outer: -2.0,
            radius_m,
            range_m: f32::INFINITY,
        }
    }

    /// Share of a spot's light in a direction that has `cosine` to its own.
    fn cone(&self, cosine: f32) -> f32 {
        let t = (cosine - self.cos_outer) / (self.cos_inner - self.cos_outer).max(1e-4);
        let t = t.clamp(0.0, 1.0);
        t * t
    }

    fn falloff_per_m2(&self, distance_m: f32) -> f32 {
        lamp_falloff_per_m2(f64::from(distance_m), f64::from(self.radius_m)) as f32 * self.window(distance_m)
    }

    /// Share of the light that is left of the inverse square at a distance. Units: none.
    fn window(&self, distance_m: f32) -> f32 {
        let share = distance_m / self.range_m;
        let left = (1.0 - share * share * share * share).clamp(0.0, 1.0);
        left * left
    }

    /// Radiance that a drop at `place` (relative to the eye, m) sends to the eye. Units: exposed radiance.
    ///
    /// Light falls with 1/(d² + r²) up to the lamp's range, a spot's with the square of its share of the cone; the drop scatters it by its
    /// refraction (fitted to the share of a disc that leaves within an angle) and reflects 0.066 of it evenly.
    ///
    /// Error: 8 % of the refracted share, the fit's; against its twin in WGSL 1e-3 relative.
    #[must_use]
    pub fn radiance(&self, place: Vec3) -> Vec3 {
        let way = place - self.position_m;
        let distance = way.length();
        let towards = if distance > 0.0 { way / distance } else { Vec3::Y };
        let from_eye = place.normalize_or(Vec3::NEG_Z);
        // A drop between the eye and the lamp refracts it straight on.
        let theta = ops::acosf((-towards.dot(from_eye)).clamp(-1.0, 1.0));
        let phase = ops::expf(0.745 - 3.44 * theta).min(MAX_PHASE);
        let falloff = self.falloff_per_m2(distance);
        self.intensity
            * (falloff * self.cone(towards.dot(self.direction)) * (TRANSMITTED * phase + REFLECTED * 0.079_577_5))
    }

    /// A bound on the luminance that any drop within `reach_m` of `place` (relative to the eye, m) sends to the eye.
    /// Units: exposed radiance.
    ///
    /// Error: never below the luminance of [`Lamp::radiance`] there; 0 only where the lamp's cone or range ends.
    #[must_use]
    pub fn bound(&self, place: Vec3, reach_m: f32) -> f32 {
        let way = place - self.position_m;
        let distance = way.length();
        let nearest = (distance - reach_m).max(0.0);
        if nearest > 0.0 {
            // The cell seen from the lamp is a cone of this half angle.
            let half = ops::asinf((reach_m / distance).min(1.0));
            let off = ops::acosf((way.dot(self.direction) / distance).clamp(-1.0, 1.0));
            let outer = ops::acosf(self.cos_outer.clamp(-1.0, 1.0));
            if self.cos_outer > -1.0 && off - half > outer {
                return 0.0;
            }
        }
        let falloff = self.falloff_per_m2(nearest);
        luminance(self.intensity) * falloff * (TRANSMITTED * MAX_PHASE + REFLECTED * 0.079_577_5)
    }
}

/// Luminance of a linear Rec. 709 colour.
pub(super) fn luminance(colour: Vec3) -> f32 {
    colour.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}
