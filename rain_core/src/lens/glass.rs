//! All drops of a glass over time.

use super::impacts::{GlassImpacts, LEAST_DROP_MM};
use super::sessile::{RunningForce, cap_radius_m, cap_volume_m3, radius_after_drying_m};
use super::wipers::{WiperMode, Wipers};
use crate::error::clamped;
use crate::hash::{pcg3d, unit_f32};
use crate::ops;

/// Most drops of a glass.
pub const MAX_GLASS_DROPS: usize = 1500;
/// Impacts that are followed singly, at most: the largest. Units: 1/s.
const SINGLE_PER_S: f64 = 300.0;
/// Longest piece of an interval. Units: s.
const PIECE_S: f64 = 0.25;
/// Most pieces of an interval.
const MOST_PIECES: f64 = 40.0;
/// Radius of the drops that a running one leaves behind, over its own. Chosen by eye: trails of glass in use.
const TRAIL_RADIUS: f64 = 0.3;
/// Way between them, in radii of the running drop.
const TRAIL_SPACING: f64 = 2.2;
/// A running drop turns aside by up to this share of its speed, anew every [`WANDER_M`]. Chosen by eye.
const WANDER: f64 = 0.35;
/// Units: m.
const WANDER_M: f64 = 4e-3;
/// What is smaller has dried. Units: m.
const LEAST_RADIUS_M: f64 = 5e-5;
/// Radius of a drop of the mist, for its drying. Units: m.
const MIST_RADIUS_M: f64 = 3e-4;

/// Half of the glass's width and height. Units: m. Domain: (0, 10].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GlassShape {
    /// Along x and y.
    pub half_m: [f64; 2],
}

impl GlassShape {
    fn held(self) -> [f64; 2] {
        self.half_m.map(|half| clamped(half, 1e-3, 10.0))
    }
}

/// What acts on a glass over an interval.
#[derive(Debug, Clone, Copy)]
pub struct GlassForcing<'a> {
    /// What the open sky brings.
    pub impacts: &'a GlassImpacts,
    /// Share of it that reaches the glass. Domain: [0, 1].
    pub exposure: f64,
    /// Gravity along the glass, x and y. Units: m/s².
    pub gravity_m_s2: [f64; 2],
    /// Velocity of the air along the glass. Units: m/s.
    pub air_m_s: [f64; 2],
    /// Velocity of the air into the glass, which spreads it from the centre: at the edge it streams outwards as fast.
    /// Units: m/s, ≥ 0.
    pub stagnation_m_s: f64,
    /// Vapour that the air lacks. Units: kg/m³.
    pub deficit_kg_m3: f64,
    /// The mode that is asked for: it comes into force when the arms are at rest.
    pub mode: WiperMode,
}

/// A drop on the glass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GlassDrop {
    /// Units: m.
    pub place_m: [f64; 2],
    /// Of its footprint. Units: m.
    pub radius_m: f64,
    /// Units: m/s.
    pub velocity_m_s: [f64; 2],
    /// Way since it last left a drop behind, and in all. Units: m.
    way_m: [f64; 2],
    /// For its outline and its way.
    pub key: u32,
}

/// Where the water of a glass came from and went. Units: m³.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GlassLedger {
    /// Of impacts that were followed singly.
    pub arrived_m3: f64,
    /// Ran or was blown over the edge.
    pub left_m3: f64,
    /// Taken by wipers.
    pub wiped_m3: f64,
    /// Dried.
    pub dried_m3: f64,
}

/// The water on a glass: single drops, and a mist of what is too small or too much to be followed.
///
/// A pure function of the seed and of all that acted on it, interval by interval.
///
/// Error: the ledger closes to 1e-12 of what arrived.
#[derive(Debug, Clone, PartialEq)]
pub struct Glass {
    seed: u32,
    step: u32,
    drops: Vec<GlassDrop>,
    /// What runs in a piece; kept for its memory.
    running: Vec<GlassDrop>,
    mist: f64,
    mist_per_s: f64,
    ledger: GlassLedger,
    /// Arms, the mode in force, its time.
    pub wipers: Wipers,
}

impl Glass {
    /// A dry glass without wipers.
    #[must_use]
    pub fn new(seed: u32) -> Self {
        Self {
            seed,
            step: 0,
            drops: Vec::new(),
            running: Vec::new(),
            mist: 0.0,
            mist_per_s: 0.0,
            ledger: GlassLedger::default(),
            wipers: Wipers::default(),
        }
    }

    /// The drops.
    #[must_use]
    pub fn drops(&self) -> &[GlassDrop] {
        &self.drops
    }

    /// Share of the glass, where it was not wiped, that the mist covers. Units: none.
    #[must_use]
    pub fn mist(&self) -> f64 {
        self.mist
    }

    /// How fast clear glass is covered by the mist. Units: 1/s.
    #[must_use]
    pub fn mist_per_s(&self) -> f64 {
        self.mist_per_s
    }

    /// Where the water came from and went.
    #[must_use]
    pub fn ledger(&self) -> &GlassLedger {
        &self.ledger
    }

    /// Water of the single drops. Units: m³.
    #[must_use]
    pub fn water_m3(&self) -> f64 {
        self.drops.iter().map(|drop| cap_volume_m3(drop.radius_m)).sum()
    }

    /// Whether nothing is on the glass that could be seen.
    #[must_use]
    pub fn is_dry(&self) -> bool {
        self.drops.is_empty() && self.mist < 1e-3
    }

    /// Takes everything off.
    pub fn clear(&mut self) {
        self.drops.clear();
        self.mist = 0.0;
    }

    /// Advances by `dt_s`, in pieces of at most 0.25 s (40 pieces of any interval). What is not positive and finite
    /// changes nothing.
    pub fn advance(&mut self, shape: &GlassShape, forcing: &GlassForcing, dt_s: f64) {
        if !(dt_s > 0.0 && dt_s.is_finite()) {
            return;
        }
        let pieces = (dt_s / PIECE_S).ceil().clamp(1.0, MOST_PIECES);
        for _ in 0..pieces as u32 {
            self.piece(shape.held(), forcing, dt_s / pieces);
            self.step = self.step.wrapping_add(1);
        }
    }

    fn piece(&mut self, half: [f64; 2], forcing: &GlassForcing, dt: f64) {
        self.arrive(half, forcing, dt);
        self.run(half, forcing, dt);
        self.dry(forcing, dt);
        self.wipe(forcing.mode, dt);
    }

    /// What falls on the glass.
    fn arrive(&mut self, half: [f64; 2], forcing: &GlassForcing, dt: f64) {
        let area = 4.0 * half[0] * half[1];
        let exposure = clamped(forcing.exposure, 0.0, 1.0);
        let rate = forcing.impacts.number_per_m2_s * area * exposure;
        // The largest are followed; the rest is mist.
        let single = if rate > 0.0 {
            (SINGLE_PER_S / rate).min(1.0)
        } else {
            0.0
        };
        self.mist_per_s = exposure * forcing.impacts.covered_below_per_s(1.0 - single);
        let keep = 1.0 - ops::exp(-self.mist_per_s * dt);
        self.mist += (1.0 - self.mist) * keep;
        let mut hashes = Hashes::new(self.seed, self.step);
        for _ in 0..hashes.poisson(rate * single * dt) {
            let [a, b, c] = hashes.next();
            // Of the largest share `single`.
            let share = 1.0 - single * (1.0 - f64::from(unit_f32(c)));
            let diameter = forcing.impacts.diameter_at(share).max(LEAST_DROP_MM);
            let diameter_m = diameter * 1e-3;
            let volume = core::f64::consts::PI / 6.0 * (diameter_m * diameter_m * diameter_m);
            let place = [
                (2.0 * f64::from(unit_f32(a)) - 1.0) * half[0],
                (2.0 * f64::from(unit_f32(b)) - 1.0) * half[1],
            ];
            self.ledger.arrived_m3 += volume;
            self.put(place, volume, c ^ a);
        }
    }

    /// A drop comes down: it joins what it touches.
    fn put(&mut self, place: [f64; 2], volume: f64, key: u32) {
        let mut drop = GlassDrop {
            place_m: place,
            radius_m: cap_radius_m(volume),
            velocity_m_s: [0.0; 2],
            way_m: [0.0; 2],
            key,
        };
        let mut water = volume;
        while let Some(other) = self.touching(&drop) {
            let met = self.drops.swap_remove(other);
            water += cap_volume_m3(met.radius_m);
            drop = joined(&drop, &met, cap_radius_m(water));
        }
        if self.drops.len() < MAX_GLASS_DROPS {
            self.drops.push(drop);
        } else {
            // No room: it is part of the mist, and gone.
            self.ledger.left_m3 += water;
        }
    }

    /// A drop whose footprint meets that of `drop`.
    fn touching(&self, drop: &GlassDrop) -> Option<usize> {
        self.drops.iter().position(|other| {
            let reach = drop.radius_m + other.radius_m;
            square(drop.place_m, other.place_m) < reach * reach
        })
    }

    /// What is too heavy runs, takes in what it meets, leaves a trail.
    fn run(&mut self, half: [f64; 2], forcing: &GlassForcing, dt: f64) {
        let mut running = std::mem::take(&mut self.running);
        let out_to = half[0].max(half[1]);
        self.drops.retain_mut(|drop| {
            let air: [f64; 2] = core::array::from_fn(|i| {
                forcing.air_m_s[i] + forcing.stagnation_m_s.max(0.0) * drop.place_m[i] / out_to
            });
            let force = RunningForce::new(drop.radius_m, forcing.gravity_m_s2, air);
            drop.velocity_m_s = wandering(drop, force.velocity_m_s(drop.radius_m));
            let runs = drop.velocity_m_s != [0.0; 2];
            if runs {
                running.push(*drop);
            }
            !runs
        });
        let mut waiting = running.len();
        for drop in running.drain(..) {
            waiting -= 1;
            self.move_on(drop, half, dt, MAX_GLASS_DROPS - 1 - waiting);
        }
        self.running = running;
    }

    /// `room`: for drops that it leaves behind.
    fn move_on(&mut self, mut drop: GlassDrop, half: [f64; 2], dt: f64, room: usize) {
        let start = drop.place_m;
        let step: [f64; 2] = drop.velocity_m_s.map(|v| v * dt);
        let length = ops::sqrt(step[0] * step[0] + step[1] * step[1]);
        let mut water = cap_volume_m3(drop.radius_m);
        self.drops.retain(|met| {
            let reach = drop.radius_m + met.radius_m;
            let meets = from_way(start, step, met.place_m) < reach * reach;
            if meets {
                water += cap_volume_m3(met.radius_m);
            }
            !meets
        });
        drop.radius_m = cap_radius_m(water);
        let spacing = TRAIL_SPACING * drop.radius_m;
        let mut at = spacing - drop.way_m[0];
        while at < length && self.drops.len() < room {
            let left = cap_volume_m3(TRAIL_RADIUS * drop.radius_m);
            water -= left;
            let along = at / length;
            self.drops.push(GlassDrop {
                place_m: [start[0] + along * step[0], start[1] + along * step[1]],
                radius_m: cap_radius_m(left),
                velocity_m_s: [0.0; 2],
                way_m: [0.0; 2],
                key: pcg3d([drop.key, self.step, at.to_bits() as u32])[0],
            });
            at += spacing;
        }
        drop.way_m = [(length - at + spacing).clamp(0.0, spacing), drop.way_m[1] + length];
        drop.place_m = [start[0] + step[0], start[1] + step[1]];
        drop.radius_m = cap_radius_m(water);
        if (0..2).any(|i| drop.place_m[i].abs() > half[i] + drop.radius_m) {
            self.ledger.left_m3 += water;
        } else {
            self.drops.push(drop);
        }
    }

    fn dry(&mut self, forcing: &GlassForcing, dt: f64) {
        let [x, y] = forcing.air_m_s;
        let speed = ops::sqrt(x * x + y * y) + forcing.stagnation_m_s.max(0.0);
        let dried = &mut self.ledger.dried_m3;
        self.drops.retain_mut(|drop| {
            let before = cap_volume_m3(drop.radius_m);
            let radius = radius_after_drying_m(drop.radius_m, forcing.deficit_kg_m3, speed, dt);
            drop.radius_m = if radius < LEAST_RADIUS_M { 0.0 } else { radius };
            *dried += before - cap_volume_m3(drop.radius_m);
            drop.radius_m > 0.0
        });
        // Drops of the mist shrink alike: their covered share falls as r².
        let kept = radius_after_drying_m(MIST_RADIUS_M, forcing.deficit_kg_m3, speed, dt) / MIST_RADIUS_M;
        self.mist = (self.mist - (1.0 - kept * kept)).max(0.0);
    }

    fn wipe(&mut self, mode: WiperMode, dt: f64) {
        let wipers = &mut self.wipers;
        if wipers.mode != mode {
            let ends = wipers.mode.cycle_s().is_none_or(|[period, _]| {
                wipers.rests() || (wipers.time_s / period).floor() < ((wipers.time_s + dt) / period).floor()
            });
            if ends {
                (wipers.mode, wipers.time_s) = (mode, 0.0);
            }
        }
        if wipers.mode == WiperMode::Off {
            return;
        }
        wipers.time_s += dt;
        let (wipers, wiped) = (*wipers, &mut self.ledger.wiped_m3);
        self.drops.retain(|drop| {
            let passed = wipers.since_s(drop.place_m).is_some_and(|since| since < dt);
            if passed {
                *wiped += cap_volume_m3(drop.radius_m);
            }
            !passed
        });
    }
}

/// The two as one: where their water was, moving as the larger.
fn joined(a: &GlassDrop, b: &GlassDrop, radius_m: f64) -> GlassDrop {
    let (va, vb) = (cap_volume_m3(a.radius_m), cap_volume_m3(b.radius_m));
    let larger = if va >= vb { a } else { b };
    GlassDrop {
        place_m: core::array::from_fn(|i| (va * a.place_m[i] + vb * b.place_m[i]) / (va + vb)),
        radius_m,
        ..*larger
    }
}

/// The velocity turned aside, as the drop's way has it.
fn wandering(drop: &GlassDrop, velocity: [f64; 2]) -> [f64; 2] {
    let stretch = (drop.way_m[1] / WANDER_M) as u32;
    let aside = WANDER * (2.0 * f64::from(unit_f32(pcg3d([drop.key, stretch, 0x6c65_6e73])[0])) - 1.0);
    [velocity[0] - aside * velocity[1], velocity[1] + aside * velocity[0]]
}

fn square(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1])
}

/// Square of the distance of `place` from the way `step` from `start`.
fn from_way(start: [f64; 2], step: [f64; 2], place: [f64; 2]) -> f64 {
    let length = step[0] * step[0] + step[1] * step[1];
    let along = (place[0] - start[0]) * step[0] + (place[1] - start[1]) * step[1];
    let share = if length > 0.0 {
        (along / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    square([start[0] + share * step[0], start[1] + share * step[1]], place)
}

/// Hashes of one piece.
struct Hashes {
    key: [u32; 2],
    count: u32,
}

impl Hashes {
    fn new(seed: u32, step: u32) -> Self {
        Self {
            key: [seed, step],
            count: 0,
        }
    }

    fn next(&mut self) -> [u32; 3] {
        self.count += 1;
        pcg3d([self.key[0] ^ 0x676c_6173, self.key[1], self.count])
    }

    /// A Poisson number, in parts of a mean of at most 16.
    fn poisson(&mut self, mean: f64) -> u32 {
        let mean = clamped(mean, 0.0, 2.0 * MAX_GLASS_DROPS as f64);
        let parts = (mean / 16.0).ceil();
        let mut count = 0;
        for _ in 0..parts as u32 {
            let part = mean / parts;
            let share = f64::from(unit_f32(self.next()[0]));
            let mut chance = ops::exp(-part);
            let mut below = chance;
            let mut number = 0;
            while below <= share && number < 100 {
                number += 1;
                chance *= part / f64::from(number);
                below += chance;
            }
            count += number;
        }
        count
    }
}
