//! Plain inputs of the pass and how they become its parameters.

use glam::{Mat4, Vec3, Vec4};
use rain_core::haze::{FOG_TABLE_KNOTS, LEAST_LAMP_M, RATE_KNOTS, RateExtinction};
use rain_core::optics::{CHEAP_REFLECTED, CHEAP_REFRACTED, RainbowPhase};
use rain_core::rainfall::Lamp;
use rain_core::rainfall::areas::AreaFieldF32;
use rain_core::splash::{MistLayer, MistLayers};

use crate::compose::{HAZE_AZIMUTHS, HAZE_FIRST_M, HAZE_INTERVALS};
use crate::cover::open_sky;
use crate::gpu_types::{CoverParams, HazeLamp, HazeView};
use crate::rainfall::Lighting;

/// Most lamps that glow in a view.
pub const MAX_HAZE_LAMPS: usize = 16;

/// Areas that divide the rain.
#[derive(Debug, Clone, Copy)]
pub struct HazeAreas<'a> {
    /// Packed about the eye.
    pub packed: &'a AreaFieldF32,
    /// The weather's rate. Units: mm/h.
    pub weather_mm_h: f32,
}

/// Far rain that is drawn as particles, for haze to leave out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HazeFar {
    /// [`rain_core::rainfall::FarRain::share`]. Domain: [0, 0.95].
    pub share: f32,
    /// Extinction of the rain outside areas. Units: 1/m.
    pub outside_per_m: f32,
}

/// Fog as an artist sets it, in place of the rain's or of a share of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HazeFog {
    /// Units: 1/m.
    pub density_per_m: f32,
    /// Times the luminance of what surrounds the view.
    pub colour: Vec3,
    /// How much of it has that colour; the rest that of what surrounds the view. Domain: [0, 1].
    pub coloured: f32,
    /// How much of its colour it has lost. Domain: [0, 1].
    pub desaturation: f32,
    /// How much of the rain's haze it takes the place of. Domain: [0, 1].
    pub share: f32,
}

/// Mist of splashes in the haze.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HazeSplash {
    /// Its layers.
    pub mist: MistLayers,
    /// What rain hits; without it there is no mist.
    pub cover: CoverParams,
}

/// A rainbow in the haze.
#[derive(Debug, Clone, Copy)]
pub struct HazeBow<'a> {
    /// Its light by angle.
    pub phase: &'a RainbowPhase,
    /// Gain; 1 is physical.
    pub strength: f32,
}

/// One view of haze.
#[derive(Debug, Clone, Copy)]
pub struct HazeInput<'a> {
    /// Clip from eye-relative world (rotation, mirror and projection, no translation); infinite reverse-Z, the near plane
    /// anywhere.
    pub clip_from_eye: Mat4,
    /// Where the view looks, unit.
    pub forward: Vec3,
    /// Corner and size of the view in its target. Units: px.
    pub viewport_px: Vec4,
    /// Surroundings.
    pub lighting: Lighting,
    /// Extinction of the rain at the eye, that of all rain where there are no areas. Units: 1/m.
    pub extinction_per_m: f32,
    /// Extinction over cross-section Q. Domain: [1, 4].
    pub efficiency: f32,
    /// Metres of rain that what is drawn stands for: [`rain_core::haze::FogTable::drawn_m`].
    pub drawn_m: [f32; FOG_TABLE_KNOTS],
    /// Extinction by rate.
    pub rates: &'a RateExtinction,
    /// `None`: the rain is the same everywhere.
    pub areas: Option<HazeAreas<'a>>,
    /// `None`: no far rain is drawn.
    pub far: Option<HazeFar>,
    /// Base of the cloud over the eye's height. Units: m.
    pub cloud_m: f32,
    /// How far below it rain thins out, straight; 0: a sharp base. Units: m.
    pub thin_m: f32,
    /// Longest way through the rain. Units: m. Domain: [10, 1e6].
    pub limit_m: f32,
    /// `None`: the haze of the rain.
    pub fog: Option<HazeFog>,
    /// Extinction of mist, the same everywhere under the cloud. Units: 1/m.
    pub mist_per_m: f32,
    /// Height of the mirror over the eye, of a mirrored view: what lies under it has no haze. Units: m.
    pub mirror_m: Option<f32>,
    /// `None`: no rainbow.
    pub bow: Option<HazeBow<'a>>,
    /// `None`: no mist of splashes.
    pub splash: Option<HazeSplash>,
    /// Relative to the eye, intensities exposed; the first [`MAX_HAZE_LAMPS`] glow, no smaller than 5 cm.
    pub lamps: &'a [Lamp],
}

/// First azimuth and step of the grid so that it holds every direction in sight, from +X towards +Z. Units: rad.
fn azimuths(eye_from_clip: Mat4, forward: Vec3) -> [f32; 2] {
    let whole = [
        -std::f32::consts::PI,
        std::f32::consts::TAU / (HAZE_AZIMUTHS - 1) as f32,
    ];
    let towards = |x: f32, y: f32| {
        let p = eye_from_clip * Vec4::new(x, y, 1.0, 1.0);
        (p.truncate() / p.w).normalize_or_zero()
    };
    let clip_from_eye = eye_from_clip.inverse();
    let sees = |direction: Vec3| {
        let clip = clip_from_eye * direction.extend(0.0);
        clip.w > 0.0 && clip.x.abs() <= 1.02 * clip.w && clip.y.abs() <= 1.02 * clip.w
    };
    let middle = forward.z.atan2(forward.x);
    if sees(Vec3::Y) || sees(Vec3::NEG_Y) {
        return whole;
    }
    let (mut low, mut high) = (0.0_f32, 0.0_f32);
    for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
        let corner = towards(x, y);
        let turn = std::f32::consts::TAU;
        let off = corner.z.atan2(corner.x) - middle;
        let off = off - turn * (off / turn).round();
        (low, high) = (low.min(off), high.max(off));
    }
    // A margin for rounding, and for lamps at the border.
    let margin = 0.02 * (high - low) + 1e-3;
    if high - low > 3.0 {
        return whole;
    }
    [
        middle + low - margin,
        (high - low + 2.0 * margin) / (HAZE_AZIMUTHS - 2) as f32,
    ]
}

impl HazeInput<'_> {
    /// Scale of the grid's knots.
    fn scale(&self) -> f32 {
        (self.limit_m / HAZE_FIRST_M as f32).ln_1p() / HAZE_INTERVALS as f32
    }

    fn fog_share(&self) -> f32 {
        self.fog.map_or(0.0, |fog| fog.share.clamp(0.0, 1.0))
    }

    /// Extinction and height of both layers of mist.
    fn splash_layers(&self) -> [f32; 4] {
        let known = self.splash.filter(|splash| splash.cover.present > 0.5);
        known.map_or([0.0; 4], |HazeSplash { mist, .. }| {
            // A layer of no height has no extinction.
            let of = |layer: MistLayer| [layer.extinction_per_m, layer.height_m.max(1e-3)];
            let ([a, b], [c, d]) = (of(mist.thrown), of(mist.carried));
            [a, b, c, d].map(|value| value as f32)
        })
    }

    /// What of the sun's light the haze shows: what drops turn away, not what they diffract; with a rainbow, what they send
    /// after inner reflections is in that.
    fn sunlight(&self) -> f32 {
        let kept = match self.bow {
            Some(_) => CHEAP_REFRACTED + CHEAP_REFLECTED,
            None => 1.0,
        };
        let own = kept / self.efficiency;
        own + (1.0 - own) * self.fog_share()
    }

    /// The parameters of this view.
    #[must_use]
    pub fn params(&self) -> HazeView {
        let depth_row = self.clip_from_eye.row(2);
        // Directions do not depend on the near plane: here it lies a metre ahead.
        let mut plain = self.clip_from_eye;
        plain.x_axis.z = 0.0;
        plain.y_axis.z = 0.0;
        plain.z_axis.z = 0.0;
        plain.w_axis.z = 1.0;
        let eye_from_clip = plain.inverse();
        let [start, step] = azimuths(eye_from_clip, self.forward);
        let mut lamp: [HazeLamp; MAX_HAZE_LAMPS] = bytemuck::Zeroable::zeroed();
        for (slot, lamp) in lamp.iter_mut().zip(self.lamps) {
            let radius = lamp.radius_m.max(LEAST_LAMP_M as f32);
            *slot = HazeLamp {
                place: lamp.position_m.extend(radius).to_array(),
                light: lamp.intensity.extend(lamp.cos_outer).to_array(),
                axis: lamp.direction.extend(lamp.cos_inner).to_array(),
            };
        }
        let fours = |values: &[f32; 64]| core::array::from_fn(|i| core::array::from_fn(|k| values[4 * i + k]));
        HazeView {
            eye_from_clip: eye_from_clip.to_cols_array_2d(),
            clip_from_eye: self.clip_from_eye.to_cols_array_2d(),
            environment: Vec3::splat(self.lighting.environment_scale)
                .extend(self.lighting.environment_max_level)
                .to_array(),
            ambient: self.lighting.ambient.extend(0.0).to_array(),
            sun_direction: self.lighting.sun_direction.extend(self.fog_share()).to_array(),
            sun: self.lighting.sun.extend(0.0).to_array(),
            forward: self.forward.extend(0.0).to_array(),
            depth_row: depth_row.to_array(),
            air: [
                self.mist_per_m,
                self.mirror_m.unwrap_or_default().max(0.0),
                self.bow.map_or(0.0, |bow| bow.strength),
                self.sunlight(),
            ],
            viewport: self.viewport_px.to_array(),
            fog: self
                .fog
                .map_or(Vec4::ZERO, |fog| fog.colour.extend(fog.desaturation.clamp(0.0, 1.0)))
                .to_array(),
            extinction: self.extinction_per_m,
            efficiency: self.efficiency,
            cloud: self.cloud_m,
            limit: self.limit_m,
            artist: self.fog.map_or(0.0, |fog| fog.density_per_m.max(0.0)),
            coloured: self.fog.map_or(0.0, |fog| fog.coloured.clamp(0.0, 1.0)),
            uneven: f32::from(u8::from(self.areas.is_some())),
            lamps: self.lamps.len().min(MAX_HAZE_LAMPS) as u32,
            grid: [start, step, self.scale(), RateExtinction::knots_per_ln() as f32],
            far: [
                self.far.map_or(0.0, |far| far.share),
                self.far.map_or(0.0, |far| far.outside_per_m),
                self.thin_m.clamp(0.0, self.cloud_m.max(0.0)),
                0.0,
            ],
            splash: self.splash_layers(),
            cover: self.splash.map_or_else(open_sky, |splash| splash.cover),
            drawn: fours(&self.drawn_m),
            rates: fours(&self.rates.ln_per_m),
            lamp,
        }
    }
}

const _: () = assert!(FOG_TABLE_KNOTS == 64 && RATE_KNOTS == 64);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_grid_holds_every_direction_in_sight() {
        let f = 1.2;
        let projection = Mat4::from_cols(
            Vec4::new(f / 1.8, 0.0, 0.0, 0.0),
            Vec4::new(0.0, f, 0.0, 0.0),
            Vec4::new(0.0, 0.0, 0.0, -1.0),
            Vec4::new(0.0, 0.0, 0.1, 0.0),
        );
        for yaw in 0..24 {
            for pitch in -6..=6 {
                let rotation =
                    glam::Quat::from_rotation_y(yaw as f32 * 0.26) * glam::Quat::from_rotation_x(pitch as f32 * 0.25);
                let clip_from_eye = projection * Mat4::from_quat(rotation.inverse());
                let inverse = clip_from_eye.inverse();
                let [start, step] = azimuths(inverse, rotation * Vec3::NEG_Z);
                let span = step * (HAZE_AZIMUTHS - 1) as f32;
                assert!(span > 0.0 && span < 6.29, "{span}");
                for i in 0..=20 {
                    for k in 0..=20 {
                        let p = inverse * Vec4::new(i as f32 / 10.0 - 1.0, k as f32 / 10.0 - 1.0, 1.0, 1.0);
                        let d = p.truncate() / p.w;
                        let off = (d.z.atan2(d.x) - start).rem_euclid(std::f32::consts::TAU);
                        assert!(off <= span + 1e-3, "{yaw} {pitch}: {off} of {span}");
                    }
                }
            }
        }
    }
}
