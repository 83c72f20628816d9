//! The cards of a view.

use glam::{DVec2, DVec3, IVec3, Vec3};

use super::card::Card;
use super::lamp::{Lamp, MAX_LAMPS, luminance};
use super::plan::{LatticePlan, Slice};
use super::rates::{ClassLadder, LatticeRates};
use super::sharing::LatticeSharing;
use crate::error::clamped;
use crate::hash::{pcg3d, unit_f32};
use crate::haze::{obscured, ramp_integral_m};
use crate::rainfall::{DrawRange, FieldMotion, LatticeEye, RainViewVolume, Spectrum, fract};

/// Opacity below which a card shows nothing in any picture. Units: none.
const MIN_OPACITY: f64 = 1e-9;

/// Shortest and longest streaks over those of the picture.
const STRETCH: [f32; 2] = [0.25, 8.0];

/// A view of the lattice.
#[derive(Debug, Clone, Copy)]
pub struct LatticeView<'a> {
    /// Eye, velocity, frustum, focal length, shutter.
    pub volume: &'a RainViewVolume,
    /// The rain; with `local`, the heaviest.
    pub spectrum: &'a Spectrum,
    /// The rate from place to place, taken at the middle of each cell. `None`: that of `spectrum` everywhere.
    pub local: Option<LatticeRates<'a>>,
    /// Where the classes of the drop field stand.
    pub motion: &'a FieldMotion,
    /// Quality κ with which single drops are drawn, none; 0 when they are not.
    pub kappa: f64,
    /// Lamps; the first [`MAX_LAMPS`] count.
    pub lamps: &'a [Lamp],
    /// Radiance of drops without lamps: sky, sun. Exposed.
    pub ambient: Vec3,
    /// Seed of the pictures' places.
    pub seed: u64,
    /// The account that haze is drawn by: cards are dimmed by the haze before them. `None`: they are not.
    pub haze: Option<&'a LatticeSharing>,
}

/// What was looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct CardCounts {
    /// Cells of classes inside the range.
    pub cells: u32,
    /// Cards left out because no light reaches them.
    pub unlit: u32,
    /// Cards left out because there were too many.
    pub beyond_limit: u32,
}

impl LatticePlan {
    /// Fills `cards` with those of a view, from far to near. Allocates only where `cards` must grow, and some hundred
    /// bytes a call.
    ///
    /// Error: optical depth of the cards, mean over lines of sight around a direction, 0.015 relative against the account
    /// below 30° of pitch and 0.05 up to where they end.
    pub fn fill(&self, view: &LatticeView, cards: &mut Vec<Card>) -> CardCounts {
        cards.clear();
        let mut counts = CardCounts::default();
        if view.spectrum.n0_per_m3_mm <= 0.0 {
            return counts;
        }
        let range = DrawRange {
            kappa: view.kappa,
            focal_px: view.volume.focal_px,
            exposure_s: view.volume.exposure_s,
        };
        let slices = self.slices(view.spectrum, &range);
        let ladder = view.local.map(|_| ClassLadder::new(self, view.spectrum.intensity_mm_h));
        for level in 0..self.settings().levels.len() {
            for (shown, classes) in self.sharing_a_card(level) {
                let own: Vec<&Slice> = slices
                    .iter()
                    .filter(|slice| slice.class.is_some_and(|class| classes.contains(&class)))
                    .collect();
                if own.iter().any(|slice| slice.extinction_per_m > 0.0) {
                    self.fill_level(view, shown, level, &own, ladder.as_ref(), cards, &mut counts);
                }
            }
        }
        let distance = |card: &Card| card.centre[0] * card.centre[0] + card.centre[2] * card.centre[2];
        let limit = self.settings().max_cards as usize;
        cards.sort_unstable_by(|a, b| distance(b).total_cmp(&distance(a)));
        if cards.len() > limit {
            counts.beyond_limit = (cards.len() - limit) as u32;
            cards.drain(..cards.len() - limit);
        }
        counts
    }

    fn fill_level(
        &self,
        view: &LatticeView,
        class: usize,
        level: usize,
        slices: &[&Slice],
        ladder: Option<&ClassLadder>,
        cards: &mut Vec<Card>,
        counts: &mut CardCounts,
    ) {
        let settings = self.settings();
        let cell_m = settings.levels[level].cell_m;
        // Begin and end of the level for every slice: between two levels the ends of one are the begin of the next.
        let ramps: Vec<(f64, [f64; 2], [f64; 2])> = slices
            .iter()
            .map(|slice| {
                (
                    slice.extinction_per_m,
                    settings.ramp_m(level, slice.range_m),
                    settings.ramp_m(level + 1, slice.range_m),
                )
            })
            .collect();
        let inner = ramps.iter().map(|(_, begin, _)| begin[0]).fold(f64::INFINITY, f64::min);
        let outer = ramps.iter().map(|(_, _, end)| end[1]).fold(0.0, f64::max);
        let half = 0.5 * cell_m;
        let reach = outer + half;
        let eye = LatticeEye::new(view.volume.eye_m, self.offset_m(class, view.motion), cell_m);
        let velocity = self.velocity_m_s(class, view.motion);
        let streaks = Streaks::new(self, view, class, velocity);
        let extinction: f64 = slices
            .iter()
            .filter(|slice| slice.class == Some(class))
            .map(|slice| slice.extinction_per_m)
            .sum();
        let everywhere = Pictures::new(self, class, extinction);
        let tile_m = self.textures().tile_m;
        let samples = ((cell_m / tile_m).round() as u32).clamp(1, settings.samples);
        let metres = Metres::new(&ramps, half, inner, outer);
        let origin = view.volume.eye_m;
        let stream = pcg3d([
            view.seed as u32,
            (view.seed >> 32) as u32 ^ 0x6c61_7474,
            (class * 8 + level) as u32,
        ]);
        let low = (eye.fraction.as_dvec3() - reach / cell_m).floor().as_ivec3();
        let high = (eye.fraction.as_dvec3() + reach / cell_m).floor().as_ivec3();
        let radius = (half * 3.0_f64.sqrt()) as f32;
        for z in low.z..=high.z {
            for x in low.x..=high.x {
                let column = pcg3d([
                    stream[0] ^ eye.cell.x.wrapping_add(x) as u32,
                    stream[1] ^ eye.cell.z.wrapping_add(z) as u32,
                    stream[2],
                ]);
                for y in low.y..=high.y {
                    let cell = IVec3::new(x, y, z);
                    let centre = ((cell.as_dvec3() - eye.fraction.as_dvec3() + 0.5) * cell_m).as_vec3();
                    let distance = f64::from(centre.length());
                    if distance + half <= inner || distance - half >= outer || !visible(view.volume, centre, radius) {
                        continue;
                    }
                    counts.cells += 1;
                    let (share, pictures) = match (&view.local, ladder) {
                        (Some(local), Some(ladder)) => {
                            let place = DVec2::new(origin.x + f64::from(centre.x), origin.z + f64::from(centre.z));
                            let share = ladder.share(class, local.at(place));
                            (share, Pictures::new(self, class, extinction * share))
                        }
                        _ => (1.0, everywhere),
                    };
                    let depth = share * metres.depth(distance);
                    let opacity = obscured(depth / f64::from(samples));
                    let level_m = (centre.x * centre.x + centre.z * centre.z).sqrt();
                    // Cards end at a pitch of 60°, and the picture's corners are within the cell.
                    let steep = level_m + radius <= 0.5 * (distance as f32 - radius).max(0.0);
                    if opacity < MIN_OPACITY || steep || level_m < 1e-3 {
                        continue;
                    }
                    let (heavier, picture) = pictures.of_column(unit_f32(column[2]));
                    let gain = (opacity / picture) as f32;
                    if !self.is_lit(
                        view,
                        centre,
                        radius,
                        gain * self.layers()[pictures.layers[1]].unit as f32,
                    ) {
                        counts.unlit += 1;
                        continue;
                    }
                    let normal = Vec3::new(-centre.x, 0.0, -centre.z) / level_m;
                    let through = view.haze.map_or(1.0, |haze| {
                        haze.fog_transmittance(distance, f64::from(level_m) / distance)
                    });
                    let turn = streaks.turn(centre, normal);
                    let up = f64::from(eye.cell.y.wrapping_add(y)) * cell_m / tile_m;
                    cards.push(Card {
                        centre: centre.extend(half as f32).to_array(),
                        facing: [normal.x, normal.z, gain, (1.0 / (-velocity.y).max(0.1)) as f32],
                        turn,
                        place: [
                            unit_f32(column[0]),
                            // A column of cells is one picture after the other: its rows go on upwards.
                            fract(f64::from(unit_f32(column[1])) - up) as f32,
                            heavier as f32,
                            through as f32,
                        ],
                        layers: [pictures.layers[0] as u32, pictures.layers[1] as u32, samples, column[2]],
                    });
                }
            }
        }
    }

    /// Whether the light of a card may matter: its brightest drop times the opacity of a streak.
    fn is_lit(&self, view: &LatticeView, centre: Vec3, radius: f32, streak: f32) -> bool {
        let min = self.settings().min_light as f32;
        if min <= 0.0 {
            return true;
        }
        let lamps: f32 = view
            .lamps
            .iter()
            .take(MAX_LAMPS)
            .map(|lamp| lamp.bound(centre, radius))
            .sum();
        (luminance(view.ambient) + lamps) * streak.min(1.0) >= min
    }
}

/// The pictures of a class at a rain rate.
#[derive(Clone, Copy)]
struct Pictures {
    layers: [usize; 2],
    heavier: f64,
    /// Mean opacity of each.
    opacities: [f64; 2],
}

/// Columns of cells change from the lighter rain's picture to the heavier's one after the other, each over this share of
/// the way: the others look up one picture, not two.
const CROSS_FADE: f64 = 0.125;

impl Pictures {
    fn new(plan: &LatticePlan, class: usize, extinction: f64) -> Self {
        let (layers, heavier) = plan.layers_at(class, extinction);
        Self {
            layers,
            heavier,
            opacities: layers.map(|layer| plan.layers()[layer].mean_opacity()),
        }
    }

    /// Share of the heavier picture in a column whose turn comes at `turn`, in [0, 1], and the mean opacity of both.
    fn of_column(&self, turn: f32) -> (f64, f64) {
        let begin = f64::from(turn) * (1.0 - CROSS_FADE);
        let heavier = clamped((self.heavier - begin) / CROSS_FADE, 0.0, 1.0);
        let [a, b] = self.opacities;
        (heavier, a + (b - a) * heavier)
    }
}

/// Optical depth of a level's cells by their distance: metres of rain that a card stands for, times extinction. The
/// ramps of neighbours add up to the whole.
struct Metres {
    from_m: f64,
    per_m: f64,
    depths: Vec<f64>,
}

/// Places of the table, a decimetre or two apart: ramps are smooth over metres.
const PLACES: usize = 192;

impl Metres {
    fn new(ramps: &[(f64, [f64; 2], [f64; 2])], half: f64, inner: f64, outer: f64) -> Self {
        let from_m = (inner - half).max(0.0);
        let step = (outer + half - from_m) / (PLACES - 1) as f64;
        let depth = |distance: f64| -> f64 {
            let metres = |[from, to]: [f64; 2]| {
                ramp_integral_m(distance + half, from, to) - ramp_integral_m(distance - half, from, to)
            };
            ramps
                .iter()
                .map(|(sigma, begin, end)| sigma * (metres(*begin) - metres(*end)).max(0.0))
                .sum()
        };
        Self {
            from_m,
            per_m: 1.0 / step,
            depths: (0..PLACES).map(|i| depth(from_m + i as f64 * step)).collect(),
        }
    }

    /// Between the table's places, held at its ends. Units: none.
    fn depth(&self, distance_m: f64) -> f64 {
        let place = clamped((distance_m - self.from_m) * self.per_m, 0.0, (PLACES - 1) as f64);
        let index = (place as usize).min(PLACES - 2);
        let (a, b) = (self.depths[index], self.depths[index + 1]);
        a + (b - a) * (place - index as f64)
    }
}

/// How the streaks of a class lie in its cards.
struct Streaks {
    relative_m_s: Vec3,
    /// Length of a streak for a m/s over that in the picture.
    per_m_s: f32,
    per_tile: f32,
}

impl Streaks {
    fn new(plan: &LatticePlan, view: &LatticeView, class: usize, velocity: DVec3) -> Self {
        let baked = plan.layers()[class].path_m;
        Self {
            relative_m_s: (velocity - view.volume.eye_velocity_m_s).as_vec3(),
            per_m_s: (view.volume.exposure_s / baked) as f32,
            per_tile: (1.0 / plan.textures().tile_m) as f32,
        }
    }

    /// Place in the picture for a metre across and a metre up. The picture's v runs along the streaks, which are drawn
    /// out to the length of the relative motion as the eye sees it: moved along the line of sight onto the card.
    fn turn(&self, centre: Vec3, normal: Vec3) -> [f32; 4] {
        let sight = centre.normalize_or(Vec3::NEG_Z);
        let head_on = sight.dot(normal);
        let on_card = self.relative_m_s - sight * (self.relative_m_s.dot(normal) / head_on.min(-1e-3));
        let right = Vec3::new(normal.z, 0.0, -normal.x);
        let (across, up) = (on_card.dot(right), on_card.y);
        let speed = (across * across + up * up).sqrt();
        let (across, up) = if speed > 1e-6 {
            (across / speed, up / speed)
        } else {
            (0.0, -1.0)
        };
        let along = self.per_tile / (speed * self.per_m_s).clamp(STRETCH[0], STRETCH[1]);
        // u grows to the right of one who looks along the streak; with a fall straight down: right, and v down.
        [-up * self.per_tile, across * along, across * self.per_tile, up * along]
    }
}

/// Whether a ball may be seen.
fn visible(volume: &RainViewVolume, centre: Vec3, radius: f32) -> bool {
    volume
        .side_planes
        .iter()
        .all(|plane| plane.truncate().dot(centre) + plane.w >= -radius)
}
