//! The particles of a view.

use glam::{DVec2, DVec3, IVec3, Vec3, Vec3Swizzles};

use super::account::{FAR_BEGIN_M, FAR_PITCH, FarAccount, FarEye, cloud_share};
use super::particle::{FAR_HEIGHT, FAR_OPACITY, FarParticle, far_presence};
use super::settings::FarRainSettings;
use crate::error::clamped;
use crate::hash::{pcg3d, unit_f32};
use crate::haze::ramp;
use crate::ops;
use crate::rainfall::areas::{AreaRain, FarFit, FarView};
use crate::rainfall::{FieldMotion, LatticeEye, RainViewVolume};

/// Levels of the lattice: the last serves everything beyond its distance.
const LEVELS: u32 = 9;
/// Distance on the ground of the first level; each further one serves twice the distance. Units: m.
const FIRST_LEVEL_M: f64 = 64.0;
/// Width of a particle over its level's distance: 4 to 11 pixels at a focal length of 620. Units: none.
const WIDTH: f64 = 1.0 / 80.0;
/// Edge of a cell over a particle's width.
const CELL: f64 = 4.0;
/// Most particles of a cell.
const MOST: u32 = 256;
/// The class whose way the lattice goes: drops of 2.5 mm.
const CLASS: usize = 7;
/// Azimuths of the account.
const AZIMUTHS: usize = 49;
/// Least opacity that a particle is drawn with.
const LEAST: f64 = 1.0 / 512.0;

/// A view of far rain.
#[derive(Debug, Clone, Copy)]
pub struct FarRainView<'a> {
    /// The rain around the eye.
    pub eye: FarEye<'a>,
    /// Eye and sides of the picture.
    pub volume: &'a RainViewVolume,
    /// Where it looks, unit.
    pub forward: DVec3,
    /// Half the angle on the ground between the picture's outermost azimuths. Units: rad. Held below π/2.
    pub half_view_rad: f64,
    /// Where the classes of the drop field stand.
    pub motion: &'a FieldMotion,
    /// Seed of the places.
    pub seed: u64,
    /// The cloud's base over the eye. Units: m.
    pub cloud_m: f64,
    /// How far below it the rain thins out; see [`cloud_share`](super::cloud_share). Units: m.
    pub thin_m: f64,
    /// Longest way through the rain. Units: m.
    pub limit_m: f64,
}

/// A cell that may hold particles.
#[derive(Debug, Clone, Copy)]
struct Cell {
    at: IVec3,
    level: u32,
    /// No place in it has more particles to a cell than this.
    most: f64,
    /// Extinction of the rain in it; none: it differs from place to place.
    even: Option<f64>,
}

/// Far rain of a view. Its memory is used again from frame to frame.
#[derive(Debug, Clone, Default)]
pub struct FarRain {
    /// Particles, in no order.
    pub particles: Vec<FarParticle>,
    /// The containers in sight, of the areas in their order.
    pub containers: Vec<FarFit>,
    /// Share q of the visible rain that the particles carry. Units: none. In [0, 0.95].
    pub share: f64,
    /// Particles that the share asked for would need, about.
    pub wanted: f64,
    /// Particles left out because there were twice as many as the budget.
    pub beyond_limit: u32,
    /// Unit direction that particles are drawn out along, downwards.
    pub axis: Vec3,
    /// What haze leaves out, over the share.
    pub account: FarAccount,
    cells: Vec<Cell>,
}

/// A level of the lattice as the eye stands in it.
#[derive(Clone, Copy)]
struct Level {
    number: u32,
    width_m: f64,
    cell_m: DVec3,
    eye: LatticeEye,
    fraction: DVec3,
    stream: [u32; 3],
    /// Particles to a cell for an extinction of 1/m.
    per_extinction: f64,
}

impl Level {
    fn new(view: &FarRainView, number: u32) -> Self {
        let width_m = WIDTH * FIRST_LEVEL_M * f64::from(1_u32 << number);
        let cell_m = DVec3::new(CELL, FAR_HEIGHT, CELL) * width_m;
        // Cells are no cubes: the eye's place is asked in units of them.
        let eye = LatticeEye::new(view.volume.eye_m / cell_m, view.motion.offset_m[CLASS] / cell_m, 1.0);
        let mean_area_m2 = 0.25 * FAR_OPACITY * FAR_HEIGHT * width_m * width_m;
        Self {
            number,
            width_m,
            cell_m,
            fraction: eye.fraction.as_dvec3(),
            eye,
            stream: pcg3d([view.seed as u32, (view.seed >> 32) as u32 ^ 0x6661_7221, number]),
            per_extinction: cell_m.element_product() / mean_area_m2,
        }
    }

    /// Middle of a cell, relative to the eye. Units: m.
    fn middle(&self, cell: IVec3) -> DVec3 {
        (cell.as_dvec3() + 0.5 - self.fraction) * self.cell_m
    }

    /// Distances on the ground that the level serves at all. Units: m.
    fn ring_m(&self) -> [f64; 2] {
        let at = FIRST_LEVEL_M * f64::from(1_u32 << self.number);
        let low = if self.number == 0 {
            FAR_BEGIN_M[0]
        } else {
            at / 2.0_f64.sqrt()
        };
        let high = if self.number + 1 == LEVELS {
            f64::INFINITY
        } else {
            2.0 * at
        };
        [low, high]
    }

    /// Share of the far rain at a distance on the ground that this level's particles are. All levels together have 1.
    fn weight(&self, distance_m: f64) -> f64 {
        let octave = ops::ln(distance_m / FIRST_LEVEL_M) / core::f64::consts::LN_2 - f64::from(self.number);
        let rises = if self.number == 0 { 1.0 } else { ramp(octave, -0.5, 0.0) };
        let falls = if self.number + 1 == LEVELS {
            0.0
        } else {
            ramp(octave, 0.5, 1.0)
        };
        rises - falls
    }

    fn marks(&self, cell: IVec3, slot: u32) -> [[u32; 3]; 2] {
        let at = |a: i32, b: i32| a.wrapping_add(b) as u32;
        let key = pcg3d([
            self.stream[0] ^ at(self.eye.cell.x, cell.x),
            self.stream[1] ^ at(self.eye.cell.y, cell.y),
            self.stream[2] ^ at(self.eye.cell.z, cell.z),
        ]);
        let place = pcg3d([
            key[0] ^ slot.wrapping_mul(0x9E37_79B9),
            key[1].wrapping_add(slot),
            key[2],
        ]);
        let marks = pcg3d([
            key[1] ^ slot.wrapping_mul(0x85EB_CA6B),
            key[2].wrapping_add(slot),
            key[0],
        ]);
        [place, marks]
    }
}

impl FarRain {
    /// No far rain; the memory stays.
    pub fn clear(&mut self) {
        self.particles.clear();
        self.containers.clear();
        self.cells.clear();
        (self.share, self.wanted, self.beyond_limit) = (0.0, 0.0, 0);
    }

    /// Fills in the particles of a view. `share` is 0, and there are none, where no area is in sight from outside.
    ///
    /// Error: optical depth, mean over lines of sight, 0.05 against [`FarAccount::far_depth`] times the share.
    pub fn fill(&mut self, settings: &FarRainSettings, view: &FarRainView) {
        self.clear();
        let velocity = view.motion.velocity_m_s[CLASS];
        self.axis = velocity.as_vec3().try_normalize().unwrap_or(Vec3::NEG_Y);
        let place = view.volume.eye_m.xz();
        let outside = 1.0 - view.eye.areas.near_share_at(place);
        let share = clamped(settings.share, 0.0, 0.95) * outside;
        if share <= 0.0 || settings.budget == 0 || !view.volume.eye_m.is_finite() {
            return;
        }
        let ground = FarView {
            eye_m: place,
            ahead: view.forward.xz(),
            half_view_rad: view.half_view_rad,
        };
        let limit = clamped(view.limit_m, 1.0, 1e6);
        for area in view.eye.areas.areas() {
            if matches!(area.rain, AreaRain::Scale(scale) if scale <= 1.0) {
                continue;
            }
            let Some(fit) = area.far_container(&ground) else {
                continue;
            };
            if fit.distance_m - fit.front_m < limit && furthest(&fit) > FAR_BEGIN_M[0] {
                self.containers.push(fit);
            }
        }
        if self.containers.is_empty() {
            return;
        }
        let reach = self.containers.iter().map(furthest).fold(0.0, f64::max).min(limit);
        self.account
            .look(&view.eye, ground.ahead, view.half_view_rad, AZIMUTHS, reach);
        for number in 0..LEVELS {
            let level = Level::new(view, number);
            if level.ring_m()[0] < reach {
                self.find_cells(view, &level, reach);
            }
        }
        self.wanted *= share;
        if self.wanted <= 0.0 {
            self.containers.clear();
            return;
        }
        self.share = share * (f64::from(settings.budget) / self.wanted).min(1.0);
        self.place(view, 2 * settings.budget as usize);
    }

    /// The cells of a level in sight and in a container.
    fn find_cells(&mut self, view: &FarRainView, level: &Level, reach: f64) {
        let [inner, outer] = level.ring_m();
        let outer = outer.min(reach);
        let half = 0.5 * level.cell_m;
        let margin = half.xz().length();
        let place = view.volume.eye_m.xz();
        // A particle may stick out of its cell.
        let radius = (half + level.width_m * DVec3::new(0.5, 0.5 * FAR_HEIGHT, 0.5)).length();
        for index in 0..self.containers.len() {
            let fit = self.containers[index];
            let [low, high] = corners(&fit, place, outer);
            let cell = |p: DVec2| ((p / level.cell_m.xz()) + level.fraction.xz()).floor().as_ivec2();
            let (low, high) = (cell(low - margin), cell(high + margin));
            for z in low.y..=high.y {
                for x in low.x..=high.x {
                    let middle = level.middle(IVec3::new(x, 0, z)).xz();
                    let distance = middle.length();
                    if distance + margin < inner || distance - margin > outer {
                        continue;
                    }
                    let at = place + middle;
                    // In the container, and in none that has been looked at.
                    let holds = |k: usize| self.containers[k].holds(at, margin);
                    if !holds(index) || (0..index).any(holds) {
                        continue;
                    }
                    let [least, most] = view.eye.areas.rates_within(at, margin, view.eye.weather_mm_h);
                    let extinction = view.eye.rates.per_m(most);
                    if extinction <= self.account.outside_per_m() {
                        continue;
                    }
                    self.find_in_column(view, level, [x, z], middle, radius, (extinction, least == most));
                }
            }
        }
    }

    fn find_in_column(
        &mut self,
        view: &FarRainView,
        level: &Level,
        [x, z]: [i32; 2],
        middle: DVec2,
        radius: f64,
        (extinction, even): (f64, bool),
    ) {
        let distance = middle.length();
        let margin = 0.5 * level.cell_m.xz().length();
        // The rain before it is least at its near end.
        let nearest = middle * ((distance - margin).max(0.0) / distance.max(1e-9));
        let seen = ops::exp(-self.account.depth_to(nearest));
        let most = level.per_extinction * (extinction - self.account.outside_per_m()) * seen;
        let [low, high] = [FAR_PITCH[0][0], FAR_PITCH[1][1]].map(|sine| sine / (1.0 - sine * sine).sqrt());
        let from = low * (distance + margin) - 0.5 * level.cell_m.y;
        let to = (high * (distance + margin)).min(view.cloud_m) + 0.5 * level.cell_m.y;
        let row = |y: f64| (y / level.cell_m.y + level.fraction.y).floor() as i32;
        for y in row(from)..=row(to) {
            let at = IVec3::new(x, y, z);
            let centre = level.middle(at);
            let in_sight = view
                .volume
                .side_planes
                .iter()
                .all(|plane| plane.truncate().as_dvec3().dot(centre) + f64::from(plane.w) >= -radius);
            if !in_sight {
                continue;
            }
            let under = cloud_share(centre.y, view.cloud_m, view.thin_m);
            let own = self.account.per_m(middle, extinction) * level.weight(distance) * level.per_extinction * under;
            self.wanted += own;
            self.cells.push(Cell {
                at,
                level: level.number,
                most,
                even: even.then_some(extinction),
            });
        }
    }

    /// Puts the particles of the cells that have been found, thinned by their ranks.
    fn place(&mut self, view: &FarRainView, limit: usize) {
        let levels: [Level; LEVELS as usize] = core::array::from_fn(|i| Level::new(view, i as u32));
        let place = view.volume.eye_m.xz();
        for cell in &self.cells {
            let level = &levels[cell.level as usize];
            let slots = (cell.most * self.share).ceil().min(f64::from(MOST)) as u32;
            for slot in 0..slots {
                let [at, marks] = level.marks(cell.at, slot);
                let unit = DVec3::new(unit_f32(at[0]).into(), unit_f32(at[1]).into(), unit_f32(at[2]).into());
                let centre = (cell.at.as_dvec3() + unit - level.fraction) * level.cell_m;
                let on_ground = centre.xz();
                let extinction = cell.even.unwrap_or_else(|| {
                    let rate = view.eye.areas.rate_at(place + on_ground, view.eye.weather_mm_h);
                    view.eye.rates.per_m(rate)
                });
                let weight = level.weight(on_ground.length().max(1.0)).max(0.0);
                let density = self.share * weight * level.per_extinction * self.account.per_m(on_ground, extinction);
                let rank = f64::from(unit_f32(marks[0]));
                let presence = far_presence(density - f64::from(slot), rank);
                if presence * FAR_OPACITY < LEAST {
                    continue;
                }
                if self.particles.len() == limit {
                    self.beyond_limit += 1;
                    continue;
                }
                self.particles.push(FarParticle {
                    centre: centre.as_vec3().to_array(),
                    presence: presence as f32,
                    half_width: (0.5 * level.width_m) as f32,
                    phase: unit_f32(marks[1]),
                    rank: rank as f32,
                    level: level.number as f32,
                });
            }
        }
    }
}

/// The furthest point of a container from the eye. Units: m.
fn furthest(fit: &FarFit) -> f64 {
    let across = fit.across_m[1].max(-fit.across_m[0]);
    DVec2::new(fit.distance_m + fit.depth_m, across).length()
}

/// Least and greatest corner, relative to the eye, of the rectangle along the axes about a container, within `reach_m` of the
/// eye. Units: m.
fn corners(fit: &FarFit, eye_m: DVec2, reach_m: f64) -> [DVec2; 2] {
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for depth in [-fit.front_m, fit.depth_m] {
        for across in fit.across_m {
            let p = fit.anchor_m + fit.towards * depth + fit.towards.perp() * across - eye_m;
            (low, high) = (low.min(p), high.max(p));
        }
    }
    let reach = DVec2::splat(reach_m);
    [low.max(-reach), high.min(reach)]
}
