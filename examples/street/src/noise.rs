//! Seeded randomness and periodic noise, all from integer hashes, so that equal seeds give equal bytes.

use rain_core::hash::{pcg, pcg3d, unit_f32};

/// A stream of numbers from one seed.
#[derive(Debug, Clone)]
pub struct Rng {
    state: u32,
}

impl Rng {
    /// A stream for this `seed` and `purpose`: streams of different purposes are independent.
    #[must_use]
    pub fn new(seed: u64, purpose: u32) -> Self {
        Self {
            state: pcg3d([seed as u32, (seed >> 32) as u32, purpose])[0],
        }
    }

    /// The next number, uniform in [0, 1).
    pub fn unit(&mut self) -> f32 {
        self.state = self.state.wrapping_add(0x9e37_79b9);
        unit_f32(pcg(self.state))
    }

    /// The next number, uniform in [low, high).
    pub fn range(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    /// The next integer, uniform in 0..n. `n` must be above zero.
    pub fn below(&mut self, n: usize) -> usize {
        ((self.unit() * n as f32) as usize).min(n - 1)
    }
}

/// Hash of a lattice point, uniform in [0, 1).
#[must_use]
pub fn lattice(seed: u32, x: i32, y: i32) -> f32 {
    unit_f32(pcg3d([x as u32, y as u32, seed])[0])
}

/// 3x² − 2x³ between two edges, 0 below and 1 above.
#[must_use]
pub fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Value noise in [0, 1], periodic: `u`, `v` in tiles, `nx` by `ny` lattice cells in a tile.
#[must_use]
pub fn value(seed: u32, u: f32, v: f32, nx: i32, ny: i32) -> f32 {
    let (x, y) = (u * nx as f32, v * ny as f32);
    let (fx, fy) = (x.floor(), y.floor());
    let (i, j) = (fx as i32, fy as i32);
    let (sx, sy) = (smoothstep(0.0, 1.0, x - fx), smoothstep(0.0, 1.0, y - fy));
    let (i0, i1) = (i.rem_euclid(nx), (i + 1).rem_euclid(nx));
    let (j0, j1) = (j.rem_euclid(ny), (j + 1).rem_euclid(ny));
    let a = lattice(seed, i0, j0);
    let b = lattice(seed, i1, j0);
    let c = lattice(seed, i0, j1);
    let d = lattice(seed, i1, j1);
    (a + (b - a) * sx) * (1.0 - sy) + (c + (d - c) * sx) * sy
}

/// Sum of `octaves` value noises, each twice as fine and half as strong; mean 0.5, in [0, 1].
#[must_use]
pub fn fbm(seed: u32, u: f32, v: f32, nx: i32, ny: i32, octaves: u32) -> f32 {
    let (mut sum, mut weight, mut total) = (0.0, 1.0, 0.0);
    for o in 0..octaves {
        sum += weight * value(seed.wrapping_add(o * 101), u, v, nx << o, ny << o);
        total += weight;
        weight *= 0.5;
    }
    sum / total
}

/// What a point sees of a periodic jittered grid of points.
#[derive(Debug, Clone, Copy)]
pub struct Cell {
    /// Distance to the nearest point, in cells.
    pub near: f32,
    /// Distance to the second nearest point, in cells.
    pub next: f32,
    /// Hash of the nearest point, uniform in [0, 1).
    pub id: f32,
}

/// Cellular noise with `n` by `n` points in a tile.
#[must_use]
pub fn cellular(seed: u32, u: f32, v: f32, n: i32) -> Cell {
    let (x, y) = (u * n as f32, v * n as f32);
    let (i, j) = (x.floor() as i32, y.floor() as i32);
    let mut cell = Cell {
        near: f32::MAX,
        next: f32::MAX,
        id: 0.0,
    };
    for dj in -1..=1 {
        for di in -1..=1 {
            let h = pcg3d([(i + di).rem_euclid(n) as u32, (j + dj).rem_euclid(n) as u32, seed]);
            let dx = (i + di) as f32 + unit_f32(h[0]) - x;
            let dy = (j + dj) as f32 + unit_f32(h[1]) - y;
            let d = (dx * dx + dy * dy).sqrt();
            if d < cell.near {
                cell.next = cell.near;
                cell.near = d;
                cell.id = unit_f32(h[2]);
            } else if d < cell.next {
                cell.next = d;
            }
        }
    }
    cell
}
