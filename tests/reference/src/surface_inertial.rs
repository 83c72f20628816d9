//! Runoff over a grid with pressure and inertia: the local inertial equations of Bates et al. 2010 in two dimensions.
//!
//! q ← (q − g h_f dt ∂η/∂x)/(1 + g dt n² |q|/h_f^(7/3)) on every edge between cells, h_f the depth over the higher bed,
//! |q| the length of the discharge vector (with one component alone a slope askew to the grid would drain along
//! √S_x : √S_y); then each cell gains what crosses its edges and the rain. SI units.

/// Gravity. Units: m/s².
const G: f64 = 9.806_65;

/// A tilted plane of square cells. Uphill it ends in walls; downhill (towards greater x and y) its edges are open and
/// the water surface goes on with the slope of the bed.
#[derive(Debug, Clone)]
pub struct Runoff {
    /// Cells along x and y.
    pub cells: [usize; 2],
    /// Width of a cell.
    pub width: f64,
    /// Fall along x and y, each ≥ 0.
    pub slopes: [f64; 2],
    /// Manning's n.
    pub manning: f64,
    /// Depth of each cell, x fastest.
    pub depth: Vec<f64>,
    /// Discharge per width over the edge of each cell towards greater x, and towards greater y.
    pub discharge: [Vec<f64>; 2],
    /// Volume that has fallen, and that has left.
    pub fallen: f64,
    /// See there.
    pub left: f64,
}

impl Runoff {
    /// A dry plane.
    pub fn dry(cells: [usize; 2], width: f64, slopes: [f64; 2], manning: f64) -> Self {
        let dry = vec![0.0; cells[0] * cells[1]];
        Self {
            cells,
            width,
            slopes,
            manning,
            depth: dry.clone(),
            discharge: [dry.clone(), dry],
            fallen: 0.0,
            left: 0.0,
        }
    }

    /// The cell at (x, y).
    pub fn cell(&self, x: usize, y: usize) -> usize {
        y * self.cells[0] + x
    }

    /// The neighbour of cell `i` towards smaller (−1) or greater (1) values along `axis`.
    fn neighbour(&self, i: usize, axis: usize, step: isize) -> Option<usize> {
        let place = [i % self.cells[0], i / self.cells[0]];
        let moved = place[axis].checked_add_signed(step).filter(|p| *p < self.cells[axis])?;
        Some(if axis == 0 {
            self.cell(moved, place[1])
        } else {
            self.cell(place[0], moved)
        })
    }

    /// Water on the plane.
    pub fn stored(&self) -> f64 {
        self.depth.iter().sum::<f64>() * self.width * self.width
    }

    /// The discharge along the other axis at the edge of `i` along `axis`: the mean of the four edges around it.
    fn discharge_across(&self, i: usize, axis: usize) -> f64 {
        let other = &self.discharge[1 - axis];
        let of = |j: Option<usize>| j.map_or(0.0, |j| other[j]);
        let next = self.neighbour(i, axis, 1).unwrap_or(i);
        let before = |j: usize| of(self.neighbour(j, 1 - axis, -1));
        0.25 * (of(Some(i)) + of(Some(next)) + before(i) + before(next))
    }

    /// The discharge over the edge of `i` along `axis` after `dt`.
    fn pushed(&self, i: usize, axis: usize, dt: f64) -> f64 {
        // Heights over the bed of cell i.
        let drop = self.slopes[axis] * self.width;
        let here = self.depth[i];
        let there = self.neighbour(i, axis, 1).map_or(here, |j| self.depth[j]) - drop;
        // The bed falls, so that of cell i is the higher one.
        let over = here.max(there);
        if over < 1e-9 {
            return 0.0;
        }
        let q = self.discharge[axis][i];
        let speed = q.hypot(self.discharge_across(i, axis));
        (q - G * over * dt * (there - here) / self.width)
            / (1.0 + G * dt * self.manning * self.manning * speed / over.powf(7.0 / 3.0))
    }

    /// One step of at most `limit` under `rain` (m/s), as long as 0.7 of what the fastest wave takes over a cell; how
    /// long it was.
    pub fn step(&mut self, rain: f64, limit: f64) -> f64 {
        let fastest = (0..self.depth.len())
            .map(|i| {
                let h = self.depth[i].max(1e-5);
                (G * h).sqrt() + self.discharge[0][i].hypot(self.discharge[1][i]) / h
            })
            .fold(0.0, f64::max);
        let dt = (0.7 * self.width / fastest).min(limit);
        self.discharge = [0, 1].map(|axis| (0..self.depth.len()).map(|i| self.pushed(i, axis, dt)).collect());

        // No cell gives more than it has.
        let share: Vec<f64> = (0..self.depth.len())
            .map(|i| {
                let outward: f64 = [0, 1]
                    .map(|axis| {
                        let back = self.neighbour(i, axis, -1).map_or(0.0, |j| -self.discharge[axis][j]);
                        self.discharge[axis][i].max(0.0) + back.max(0.0)
                    })
                    .iter()
                    .sum();
                let asked = outward * dt / self.width;
                if asked > self.depth[i] {
                    self.depth[i] / asked
                } else {
                    1.0
                }
            })
            .collect();
        let mut gained = vec![rain * dt; self.depth.len()];
        for axis in [0, 1] {
            for i in 0..self.depth.len() {
                let next = self.neighbour(i, axis, 1);
                let q = &mut self.discharge[axis][i];
                // Through an open edge nothing comes back.
                *q = if *q > 0.0 {
                    *q * share[i]
                } else {
                    next.map_or(0.0, |j| *q * share[j])
                };
                let moved = *q * dt / self.width;
                gained[i] -= moved;
                match next {
                    Some(j) => gained[j] += moved,
                    None => self.left += moved * self.width * self.width,
                }
            }
        }
        for (depth, gained) in self.depth.iter_mut().zip(&gained) {
            *depth += gained;
        }
        self.fallen += rain * dt * self.width * self.width * self.depth.len() as f64;
        dt
    }

    /// `time` of `rain` (m/s); how many steps it took.
    pub fn run(&mut self, rain: f64, time: f64) -> usize {
        let (mut now, mut steps) = (0.0, 0);
        while now < time {
            now += self.step(rain, time - now);
            steps += 1;
        }
        steps
    }
}
