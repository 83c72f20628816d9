//! Plain inputs of the pass and how they become its parameters.

use glam::{Mat4, Vec2, Vec3, Vec4};
use rain_core::rainfall::Lamp;
use rain_core::splash::{FOOT_DROPS, SPLASH_CELL_M, SPLASH_SLOTS, SplashAnchor, SplashField};

use crate::glass::{self, Pane};
use crate::gpu_types::{CoverParams, LevelMapParams, SplashFoot, SplashView, SpoutMouth};
use crate::lamps;
use crate::rainfall::{Lighting, SEEN_FROM_M};

/// Furthest reach of splashes. Units: m.
pub(super) const LARGEST_REACH_M: f32 = 50.0;
/// Shortest shutter time. Units: s.
const LEAST_EXPOSURE_S: f32 = 1e-4;

/// Steps whose splashes a view draws; more are left out. Units: none.
pub const MAX_FEET: usize = 8;
/// Invocations that look for the parts of a step: its sheet and its drops.
const FOOT_PARTS: u32 = FOOT_DROPS + 1;

/// A step in water.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepSplash {
    /// Where, on the water, relative to the eye. Units: m.
    pub place_m: Vec3,
    /// Since it came down. Units: s.
    pub age_s: f32,
    /// How strong. Units: none. Domain: [0, 1].
    pub strength: f32,
    /// Tells it from all others.
    pub key: [u32; 3],
}

/// Mouths that water pours from which a view draws; more are left out. Units: none.
pub const MAX_MOUTHS: usize = 16_384;

/// Water that leaves one mouth of an eave or a pipe, as parcels that are let go one after the other: drops, or pieces of a
/// jet that become drops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpoutStream {
    /// Where, relative to the eye. Units: m.
    pub place_m: Vec3,
    /// At which it leaves, level or downward. Units: m/s.
    pub velocity_m_s: Vec3,
    /// Units: m/s. Held in [0.1, 1000].
    pub terminal_m_s: f32,
    /// Between parcels. Units: s. Held in [0.001, 1e6].
    pub period_s: f32,
    /// Number of the newest parcel, whole and fraction. Units: none.
    pub released: f64,
    /// Until it has fallen as far as ground is looked for. Units: s. Held in [0.001, 10].
    pub limit_s: f32,
    /// Away from the roof (x, z), a unit vector.
    pub outward: Vec2,
    /// Diameter of the jet as it leaves. Units: m.
    pub jet_m: f32,
    /// Until it has broken into drops; 0: it drips. Units: s.
    pub breakup_s: f32,
    /// Diameter of drops. Units: mm. Held in [0.1, 10].
    pub drop_mm: f32,
    /// Drops that one of a parcel shows. Units: none.
    pub weight: f32,
    /// Tells it from all others.
    pub key: [u32; 2],
}

impl SpoutStream {
    /// The record of this mouth.
    #[must_use]
    pub fn record(&self) -> SpoutMouth {
        let whole = self.released.floor();
        let finite = |v: Vec3| if v.is_finite() { v } else { Vec3::ZERO };
        let velocity = finite(self.velocity_m_s);
        SpoutMouth {
            place: finite(self.place_m).extend(held(self.period_s, 1e-3, 1e6)).to_array(),
            velocity: velocity
                .with_y(velocity.y.min(0.0))
                .extend(held(self.terminal_m_s, 0.1, 1e3))
                .to_array(),
            form: [
                held(self.jet_m, 0.0, 10.0),
                held(self.breakup_s, 0.0, 1e6),
                held(self.drop_mm, 0.1, 10.0),
                held(self.weight, 0.0, 1e6),
            ],
            state: [
                held((self.released - whole) as f32, 0.0, 0.999_999),
                held(self.limit_s, 1e-3, 10.0),
                self.outward.x,
                self.outward.y,
            ],
            // The lowest bits tell neighbours apart.
            key: [self.key[0], self.key[1], whole.rem_euclid(4_294_967_296.0) as u32, 0],
        }
    }
}

/// One view of splashes.
#[derive(Debug, Clone, Copy)]
pub struct SplashInput<'a> {
    /// What falls on a cell in a slot.
    pub field: &'a SplashField,
    /// The eye and the moment on the grid.
    pub anchor: SplashAnchor,
    /// Clip from eye-relative world (rotation and projection, no translation) at the end of the exposure.
    pub clip_from_eye: Mat4,
    /// The same at the start of the exposure, from positions relative to the *present* eye.
    pub clip_from_eye_before: Mat4,
    /// Four side planes through the eye, unit normals inward; w: offset. Units: m.
    pub side_planes: [Vec4; 4],
    /// Along the rays of a view without perspective, unit. "Eye" then is a place in the middle of the picture, and all of it is as
    /// near.
    pub parallel: Option<Vec3>,
    /// Where the air goes. Units: m/s.
    pub wind_m_s: Vec3,
    /// Size of the target. Units: px.
    pub viewport_px: Vec2,
    /// Focal length; without perspective the scale. Units: px, px/m.
    pub focal_px: f32,
    /// Near plane of the projection; 0 without perspective. Units: m.
    pub near_m: f32,
    /// Shutter time. Units: s. Domain: (0, 1].
    pub exposure_s: f32,
    /// Gain on contrast. Domain: [1, 32]; 1 = physical.
    pub contrast: f32,
    /// Fade against the scene over at most this distance, m; 0 = hard depth test.
    pub soft_m: f32,
    /// How far crowns are drawn. Units: m. Held in [0, 50].
    pub reach_m: f32,
    /// How far thrown drops are drawn. Units: m. Held in [0, reach].
    pub near_reach_m: f32,
    /// What is drawn of crowns and of thrown drops at any distance. Units: none. Held in [0, 1].
    pub shares: [f32; 2],
    /// Film on what stands under no water. Units: mm.
    pub film_mm: f32,
    /// Crowns and drops for which there is room; more are left out, any of them.
    pub capacity: u32,
    /// Surroundings.
    pub lighting: Lighting,
    /// Lamps near the view; the first [`rain_core::rainfall::MAX_LAMPS`] count.
    pub lamps: &'a [Lamp],
    /// What is transparent before the view; the first [`crate::glass::MAX_PANES`] count.
    pub panes: &'a [Pane],
    /// Steps in water; the first [`MAX_FEET`] count.
    pub feet: &'a [StepSplash],
    /// Mouths that water pours from; the first [`MAX_MOUTHS`] count.
    pub mouths: &'a [SpoutStream],
    /// How far they are seen. Units: m.
    pub mouth_reach_m: f32,
    /// Cover map relative to the eye.
    pub cover: CoverParams,
    /// Standing water relative to the eye.
    pub levels: LevelMapParams,
}

impl SplashInput<'_> {
    fn reach_m(&self) -> f32 {
        // What is not a number reaches nowhere.
        held(self.reach_m, 0.0, LARGEST_REACH_M)
    }

    /// Cells on each side of the eye's.
    pub(super) fn span(&self) -> u32 {
        (self.reach_m() / SPLASH_CELL_M as f32).ceil() as u32 + 1
    }

    /// Cells and slots that are looked through, parts of steps, and mouths.
    pub(super) fn invocations(&self) -> u32 {
        let side = 2 * self.span() + 1;
        side * side * SPLASH_SLOTS + self.feet.len().min(MAX_FEET) as u32 * FOOT_PARTS + self.mouths()
    }

    fn mouths(&self) -> u32 {
        self.mouths.len().min(MAX_MOUTHS) as u32
    }

    /// The parameters of this view.
    #[must_use]
    pub fn params(&self) -> SplashView {
        let [a, b, c] = self.field.stream;
        let mut classes = [[0.0; 4]; rain_core::rainfall::CLASS_COUNT];
        for ((slot, [start, span, bend]), weight) in
            classes.iter_mut().zip(self.field.diameters).zip(self.field.weights)
        {
            *slot = [start, span, bend, weight];
        }
        let (lamp, lamps) = lamps::slots(self.lamps);
        let (pane, panes) = glass::slots(self.panes);
        let mut foot = [bytemuck::Zeroable::zeroed(); MAX_FEET];
        for (slot, step) in foot.iter_mut().zip(self.feet) {
            let [a, b, c] = step.key;
            *slot = SplashFoot {
                place: step.place_m.extend(step.age_s).to_array(),
                key: [a, b, c, held(step.strength, 0.0, 1.0).to_bits()],
            };
        }
        SplashView {
            clip_from_eye: self.clip_from_eye.to_cols_array_2d(),
            clip_from_eye_before: self.clip_from_eye_before.to_cols_array_2d(),
            environment: Vec3::splat(self.lighting.environment_scale)
                .extend(self.lighting.environment_max_level)
                .to_array(),
            ambient: self.lighting.ambient.extend(0.0).to_array(),
            sun_direction: self.lighting.sun_direction.extend(0.0).to_array(),
            sun: self.lighting.sun.extend(0.0).to_array(),
            planes: self.side_planes.map(|plane| plane.to_array()),
            rays: self
                .parallel
                .map_or(Vec4::ZERO, |ahead| (ahead * SEEN_FROM_M).extend(1.0))
                .to_array(),
            wind: self.wind_m_s.extend(0.0).to_array(),
            stream: [a, b, c, self.anchor.slot],
            viewport: self.viewport_px.to_array(),
            fraction: self.anchor.fraction.to_array(),
            cell: self.anchor.cell.to_array(),
            focal: self.focal_px,
            near: self.near_m,
            exposure: held(self.exposure_s, LEAST_EXPOSURE_S, 1.0),
            contrast: self.contrast,
            soft: self.soft_m,
            reach: self.reach_m(),
            near_reach: self.near_reach_m.max(0.0).min(self.reach_m()),
            film: held(self.film_mm, 0.0, 1e6),
            since: self.anchor.since_s,
            span: self.span(),
            capacity: self.capacity,
            lamps,
            panes,
            feet: self.feet.len().min(MAX_FEET) as u32,
            mouths: self.mouths(),
            mouth_reach: held(self.mouth_reach_m, 0.0, 1e4),
            shares: self.shares.map(|share| held(share, 0.0, 1.0)),
            cover: self.cover,
            levels: self.levels,
            counts: self.field.count_limits,
            limits: self.field.class_limits,
            classes,
            lamp,
            pane,
            foot,
        }
    }
}

/// Within bounds; NaN counts as the lower one.
fn held(x: f32, low: f32, high: f32) -> f32 {
    if x > low { x.min(high) } else { low }
}
