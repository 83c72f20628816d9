//! Depressions of a height field, the slow way.

/// A height field: row after row, NaN = hole.
#[derive(Debug, Clone)]
pub struct Field {
    /// Columns.
    pub nx: usize,
    /// Rows.
    pub nz: usize,
    /// Cell edge, m.
    pub cell: f64,
    /// Heights, m.
    pub z: Vec<f64>,
    /// Whether the border is a wall.
    pub closed: bool,
}

impl Field {
    /// The up to eight neighbours of a cell.
    pub fn neighbours(&self, cell: usize) -> Vec<usize> {
        let (x, z) = ((cell % self.nx) as i64, (cell / self.nx) as i64);
        let mut list = Vec::new();
        for dz in -1..=1 {
            for dx in -1..=1 {
                let (x, z) = (x + dx, z + dz);
                let inside = x >= 0 && z >= 0 && x < self.nx as i64 && z < self.nz as i64;
                if inside && (dx, dz) != (0, 0) {
                    list.push(z as usize * self.nx + x as usize);
                }
            }
        }
        list
    }

    /// Whether water on the cell can leave there at the cell's own height.
    pub fn is_outlet(&self, cell: usize) -> bool {
        let around = self.neighbours(cell);
        let (x, z) = (cell % self.nx, cell / self.nx);
        let border = x == 0 || z == 0 || x + 1 == self.nx || z + 1 == self.nz;
        (border && !self.closed) || around.iter().any(|&other| self.z[other].is_nan())
    }

    /// Filled surface: sweeps filled(i) = max(z(i), min over neighbours) until nothing changes.
    pub fn filled(&self) -> Vec<f64> {
        let mut filled: Vec<f64> = (0..self.z.len())
            .map(|cell| {
                if self.z[cell].is_nan() || self.is_outlet(cell) {
                    self.z[cell]
                } else {
                    f64::INFINITY
                }
            })
            .collect();
        loop {
            let mut changed = false;
            for cell in 0..filled.len() {
                if self.z[cell].is_nan() || filled[cell] == self.z[cell] {
                    continue;
                }
                let lowest = self
                    .neighbours(cell)
                    .iter()
                    .map(|&other| filled[other])
                    .fold(f64::INFINITY, f64::min);
                let level = self.z[cell].max(lowest);
                if level < filled[cell] {
                    filled[cell] = level;
                    changed = true;
                }
            }
            if !changed {
                return filled;
            }
        }
    }

    /// Cells connected to `start` (if `inside` holds there) through cells where `inside` holds.
    pub fn connected(&self, start: usize, inside: impl Fn(usize) -> bool) -> Vec<usize> {
        let mut seen = vec![false; self.z.len()];
        let mut list = Vec::new();
        if inside(start) {
            seen[start] = true;
            list.push(start);
        }
        let mut next = 0;
        while next < list.len() {
            for other in self.neighbours(list[next]) {
                if !seen[other] && inside(other) {
                    seen[other] = true;
                    list.push(other);
                }
            }
            next += 1;
        }
        list
    }

    /// Connected sets of cells whose filled height exceeds the ground.
    pub fn wet_sets(&self) -> Vec<Vec<usize>> {
        let filled = self.filled();
        let wet = |cell: usize| filled[cell] > self.z[cell];
        let mut seen = vec![false; self.z.len()];
        let mut sets = Vec::new();
        for start in 0..self.z.len() {
            if wet(start) && !seen[start] {
                let set = self.connected(start, wet);
                for &cell in &set {
                    seen[cell] = true;
                }
                sets.push(set);
            }
        }
        sets
    }

    /// Water over a set of cells up to a level, m³.
    pub fn volume(&self, cells: &[usize], level: f64) -> f64 {
        cells.iter().map(|&cell| (level - self.z[cell]).max(0.0)).sum::<f64>() * self.cell * self.cell
    }

    /// Pits: connected cells of one height, none an outlet, all around higher.
    pub fn pits(&self) -> Vec<Vec<usize>> {
        let mut seen = vec![false; self.z.len()];
        let mut pits = Vec::new();
        for start in 0..self.z.len() {
            if seen[start] || self.z[start].is_nan() {
                continue;
            }
            let flat = self.connected(start, |cell| self.z[cell] == self.z[start]);
            let mut shut = true;
            for &cell in &flat {
                seen[cell] = true;
                shut &= !self.is_outlet(cell);
                shut &= self
                    .neighbours(cell)
                    .iter()
                    .all(|&other| self.z[other] >= self.z[start]);
            }
            if shut {
                pits.push(flat);
            }
        }
        pits
    }

    /// The neighbour down the steepest descent, the first of several; none in flats and pits.
    pub fn downhill(&self, cell: usize) -> Option<usize> {
        let mut best = None;
        let mut steepest = 0.0;
        for other in self.neighbours(cell) {
            let diagonal = other % self.nx != cell % self.nx && other / self.nx != cell / self.nx;
            let distance = if diagonal { core::f64::consts::SQRT_2 } else { 1.0 };
            let slope = (self.z[cell] - self.z[other]) / distance;
            if slope > steepest {
                steepest = slope;
                best = Some(other);
            }
        }
        best
    }
}

/// Water on a height field, cell by cell.
#[derive(Debug, Clone)]
pub struct Flooded {
    /// The ground.
    pub field: Field,
    /// Height of the water's surface, the ground's where it is dry.
    pub surface: Vec<f64>,
    /// What has run off, m³.
    pub left: f64,
}

impl Flooded {
    /// Dry ground.
    pub fn new(field: Field) -> Self {
        Self {
            surface: field.z.clone(),
            field,
            left: 0.0,
        }
    }

    /// Pours water at a cell: it runs down the ground to a pit or pool, raises it to its lowest neighbour, runs on.
    pub fn pour(&mut self, cell: usize, mut volume: f64) {
        let mut at = cell;
        while volume > 0.0 {
            if self.surface[at] == self.field.z[at] {
                if self
                    .field
                    .neighbours(at)
                    .iter()
                    .any(|&other| self.field.z[other].is_nan())
                {
                    self.left += volume;
                    return;
                }
                if let Some(next) = self.field.downhill(at) {
                    at = next;
                    continue;
                }
            }
            let level = self.surface[at];
            let pool = self.field.connected(at, |other| self.surface[other] == level);
            if pool.iter().any(|&cell| self.field.is_outlet(cell)) {
                self.left += volume;
                return;
            }
            let lower = pool.iter().filter_map(|&cell| self.way_out(cell, level)).next();
            if let Some(next) = lower {
                at = next;
                continue;
            }
            let rim = pool
                .iter()
                .flat_map(|&cell| self.field.neighbours(cell))
                .map(|other| self.surface[other])
                .filter(|&surface| surface > level)
                .fold(f64::INFINITY, f64::min);
            let area = pool.len() as f64 * self.field.cell * self.field.cell;
            let room = area * (rim - level);
            let next = if volume <= room { level + volume / area } else { rim };
            for &cell in &pool {
                self.surface[cell] = next;
            }
            volume -= room;
        }
    }

    /// The steepest way from a cell of a pool to water or ground below its level.
    fn way_out(&self, cell: usize, level: f64) -> Option<usize> {
        let mut best = None;
        let mut steepest = 0.0;
        for other in self.field.neighbours(cell) {
            let diagonal =
                other % self.field.nx != cell % self.field.nx && other / self.field.nx != cell / self.field.nx;
            let slope = (level - self.field.z[other]) / if diagonal { core::f64::consts::SQRT_2 } else { 1.0 };
            if self.surface[other] < level && slope > steepest {
                steepest = slope;
                best = Some(other);
            }
        }
        best
    }

    /// Water on the cells, m³.
    pub fn stored(&self) -> f64 {
        let depth = |cell: usize| self.surface[cell] - self.field.z[cell];
        let cells = (0..self.surface.len()).filter(|&cell| !self.field.z[cell].is_nan());
        cells.map(depth).sum::<f64>() * self.field.cell * self.field.cell
    }
}

/// A basin of a cascade.
#[derive(Debug, Clone, Copy)]
pub struct Tank {
    /// m³ when full.
    pub capacity: f64,
    /// m² that drain into it.
    pub catchment: f64,
    /// Index of the tank it spills into, later in the list; none: away.
    pub next: Option<usize>,
}

/// Volumes and what has left after `time` seconds of constant rain (m/s), from the list of all filling times.
pub fn cascade(tanks: &[Tank], rain: f64, time: f64) -> (Vec<f64>, f64) {
    let mut volumes = vec![0.0; tanks.len()];
    let mut left = 0.0;
    let mut now = 0.0;
    while now < time {
        let mut inflow: Vec<f64> = tanks.iter().map(|tank| tank.catchment * rain).collect();
        let mut away = 0.0;
        for index in 0..tanks.len() {
            if volumes[index] >= tanks[index].capacity {
                let spill = inflow[index];
                inflow[index] = 0.0;
                match tanks[index].next {
                    Some(next) => inflow[next] += spill,
                    None => away += spill,
                }
            }
        }
        let mut step = time - now;
        let mut first = None;
        for index in 0..tanks.len() {
            let needed = (tanks[index].capacity - volumes[index]) / inflow[index];
            if inflow[index] > 0.0 && needed < step {
                step = needed;
                first = Some(index);
            }
        }
        for index in 0..tanks.len() {
            volumes[index] += inflow[index] * step;
        }
        if let Some(index) = first {
            volumes[index] = tanks[index].capacity;
        }
        left += away * step;
        now = if first.is_some() { now + step } else { time };
    }
    (volumes, left)
}

/// Depth of water in a paraboloid z = r²/(2 R) after `time` under a constant inflow (m³/s) and loss (m/s), from dry.
/// Implicit closed form, by bisection: t = (h_e/e)(−h/h_e − ln(1 − h/h_e)), h_e = Q/(2πRe).
pub fn paraboloid_depth(radius: f64, inflow: f64, loss: f64, time: f64) -> f64 {
    let balance = inflow / (2.0 * core::f64::consts::PI * radius * loss);
    balance * crate::numerics::bisect(0.0, 1.0, |x| balance / loss * (-x - (-x).ln_1p()) - time)
}

/// Inlet, smaller of weir 1.66 P d^1.5 and orifice .67 A √(2 g d), m³/s.
pub fn inlet(perimeter: f64, area: f64, depth: f64) -> f64 {
    let depth = depth.max(0.0);
    (1.66 * perimeter * depth.powf(1.5)).min(0.67 * area * (2.0 * 9.80665 * depth).sqrt())
}

/// Volume in one basin whose cells have these heights, under a constant inflow (m³/s) and loss (m/s), from dry: the
/// list of all moments at which the rising level wets another cell. It stops rising where another cell would lose more
/// than comes in.
pub fn lossy_volume(heights: &[f64], cell: f64, inflow: f64, loss: f64, time: f64) -> f64 {
    let area = cell * cell;
    let mut sorted = heights.to_vec();
    sorted.sort_by(f64::total_cmp);
    let mut level = sorted[0];
    let mut left = time;
    for wet in 1..=sorted.len() {
        let next = sorted.get(wet).copied().unwrap_or(f64::INFINITY);
        let rise = inflow / (wet as f64 * area) - loss;
        if rise <= 0.0 {
            break;
        }
        let needed = (next - level) / rise;
        if needed > left {
            level += rise * left;
            break;
        }
        level = next;
        left -= needed;
    }
    heights.iter().map(|&z| (level - z).max(0.0)).sum::<f64>() * area
}
