//! Water moved by wheels and feet, and water from elsewhere.

use glam::DVec2;

use super::run::Ground;
use crate::error::{ConfigError, clamped, in_range};
use crate::weather::store::Store;

/// Longest way of one press. Units: m.
const LONGEST_M: f64 = 1e3;
/// Most water added at once. Units: m³.
const MOST_M3: f64 = 1e9;

/// What a press took from films.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Pressed {
    /// Laid beside the way. Units: m³.
    pub aside_m3: f64,
    /// Thrown up: airborne until [`Ground::land`]. Units: m³.
    pub thrown_m3: f64,
}

/// A strip of the plane: a way with a width, in the plane's own frame.
struct Strip {
    from: DVec2,
    along: DVec2,
    length: f64,
    half: f64,
    cell: f64,
}

impl Strip {
    /// Share of a cell at `p` that lies in the strip: exact for strips along the grid.
    fn share(&self, p: DVec2) -> f64 {
        let (along, across) = self.place(p);
        let within = |middle: f64, low: f64, high: f64| {
            let part = (middle + 0.5 * self.cell).min(high) - (middle - 0.5 * self.cell).max(low);
            (part / self.cell).clamp(0.0, 1.0)
        };
        within(along, 0.0, self.length) * within(across, -self.half, self.half)
    }

    /// Whether a cell lies beside the strip: outside, less than two cells away.
    fn is_beside(&self, p: DVec2) -> bool {
        let (along, across) = self.place(p);
        let off = across.abs() - self.half;
        along > -0.5 * self.cell
            && along < self.length + 0.5 * self.cell
            && off >= 0.5 * self.cell
            && off < 1.5 * self.cell
    }

    fn place(&self, p: DVec2) -> (f64, f64) {
        let d = p - self.from;
        (d.dot(self.along), self.along.perp_dot(d))
    }
}

impl Ground {
    /// A wheel or a foot passes from `from` to `to` (x, z; units: m; at most 1 km): of the film under its width a
    /// `share` (units: none; domain: [0, 1]) goes, of this `thrown` (domain: [0, 1]) into the air and the rest to the
    /// cells beside. A press on one place is a square. Pools are not pressed: they close at once.
    ///
    /// Ways that follow each other press each place once. Where nothing lies beside, all is thrown.
    ///
    /// Error: exact along the grid, 1 % where ways meet.
    ///
    /// # Errors
    /// When a number is outside its domain or not finite; then nothing changes.
    pub fn press(
        &mut self,
        from: DVec2,
        to: DVec2,
        half_width_m: f64,
        share: f64,
        thrown: f64,
    ) -> Result<Pressed, ConfigError> {
        for value in [from.x, from.y, to.x, to.y] {
            in_range("place", value, -1e7, 1e7, "-1e7 to 1e7 m")?;
        }
        in_range("half_width_m", half_width_m, 0.0, 10.0, "0 to 10 m")?;
        in_range("share", share, 0.0, 1.0, "0 to 1")?;
        in_range("thrown", thrown, 0.0, 1.0, "0 to 1")?;
        let way = to - from;
        in_range("length of the way", way.length(), 0.0, LONGEST_M, "0 to 1000 m")?;
        let strip = if way.length() > 1e-9 {
            Strip {
                from,
                along: way.normalize(),
                length: way.length(),
                half: half_width_m,
                cell: self.frame.cell_m(),
            }
        } else {
            Strip {
                from: from - DVec2::new(half_width_m, 0.0),
                along: DVec2::X,
                length: 2.0 * half_width_m,
                half: half_width_m,
                cell: self.frame.cell_m(),
            }
        };
        let reach = half_width_m + 2.0 * strip.cell;
        let (low, high) = (from.min(to) - reach, from.max(to) + reach);
        let mut taken = Store::default();
        let mut beside = 0_u32;
        self.for_each_cell_in(low, high, |ground, cell, centre| {
            let film = ground.cells.film[cell];
            if film > 0.0 && ground.pool_over(cell).is_none() {
                let rest = film - film * (strip.share(centre) * share);
                taken.add(film);
                taken.add(-rest);
                ground.cells.film[cell] = rest;
            }
            beside += u32::from(strip.is_beside(centre));
        });
        if taken.total() <= 0.0 {
            return Ok(Pressed::default());
        }
        let k = self.m3_per_mm();
        let mut aside = Store::default();
        if beside > 0 && thrown < 1.0 {
            let part = taken.total() * (1.0 - thrown) / f64::from(beside);
            self.for_each_cell_in(low, high, |ground, cell, centre| {
                if strip.is_beside(centre) {
                    aside.add(ground.put_on(cell, part));
                }
            });
        }
        let mut up = taken;
        up.add_store(aside.negated());
        self.totals.airborne.add_store(up.scaled(k));
        self.film_version += 1;
        Ok(Pressed {
            aside_m3: aside.total() * k,
            thrown_m3: up.total() * k,
        })
    }

    /// Puts water (mm) on a cell: on its film, or into the pool over it. Returns what arrived: the film's last bit is
    /// not always there.
    fn put_on(&mut self, cell: usize, amount_mm: f64) -> f64 {
        let [nx, _] = self.frame.cells();
        if let Some(leaf) = self.pool_over(cell) {
            self.inflow.gathered[leaf as usize].add(amount_mm);
            return amount_mm;
        }
        let slice = cell / nx % self.interval_steps as usize;
        self.pending[slice].wet = true;
        let film = self.cells.film[cell];
        self.cells.film[cell] = film + amount_mm;
        self.cells.film[cell] - film
    }

    /// Visits the ground cells whose centre lies in a rectangle, row by row.
    fn for_each_cell_in(&mut self, low: DVec2, high: DVec2, mut visit: impl FnMut(&mut Self, usize, DVec2)) {
        let [nx, nz] = self.frame.cells();
        let [ox, oz] = self.frame.origin();
        let cell_m = self.frame.cell_m();
        let range = |low: f64, high: f64, origin: f64, count: usize| {
            let to_cell = |v: f64| clamped(((v - origin) / cell_m).floor(), 0.0, count as f64) as usize;
            to_cell(low)..(to_cell(high) + 1).min(count)
        };
        for row in range(low.y, high.y, oz, nz) {
            for column in range(low.x, high.x, ox, nx) {
                let cell = row * nx + column;
                if !self.heights[cell].is_nan() {
                    let [x, z] = self.frame.centre_m(column, row);
                    visit(self, cell, DVec2::new(x, z));
                }
            }
        }
    }

    /// Adds water to the ground at (x, z): a burst pipe, drips of a crown that the scene does not know. Units: m³.
    /// Domain: [0, 1e9]. Beside the map and over holes it runs off the map.
    ///
    /// # Errors
    /// When the amount is outside its domain or the place is not finite; then nothing changes.
    pub fn add_water(&mut self, place: DVec2, volume_m3: f64) -> Result<(), ConfigError> {
        in_range("volume_m3", volume_m3, 0.0, MOST_M3, "0 to 1e9 m³")?;
        let water = self.put_at(place, volume_m3)?;
        self.totals.added.add_store(water);
        Ok(())
    }

    /// Lets airborne water land at (x, z), at most what is in the air; returns what landed. Units: m³.
    /// Domain: [0, 1e9].
    ///
    /// # Errors
    /// When the amount is outside its domain or the place is not finite; then nothing changes.
    pub fn land(&mut self, place: DVec2, volume_m3: f64) -> Result<f64, ConfigError> {
        in_range("volume_m3", volume_m3, 0.0, MOST_M3, "0 to 1e9 m³")?;
        let water = self.put_at(place, volume_m3.min(self.totals.airborne.total().max(0.0)))?;
        self.totals.airborne.add_store(water.negated());
        Ok(water.total())
    }

    /// Water thrown up and not landed. Units: m³.
    #[must_use]
    pub fn airborne_m3(&self) -> f64 {
        self.totals.airborne.total().max(0.0)
    }

    fn put_at(&mut self, place: DVec2, volume_m3: f64) -> Result<Store, ConfigError> {
        for value in [place.x, place.y] {
            in_range("place", value, -1e9, 1e9, "-1e9 to 1e9 m")?;
        }
        if volume_m3 <= 0.0 {
            return Ok(Store::default());
        }
        let k = self.m3_per_mm();
        let cell = self
            .cell_at(place.x, place.y)
            .filter(|&cell| !self.heights[cell].is_nan());
        let Some(cell) = cell else {
            self.totals.off_map.add(volume_m3);
            return Ok(Store::new(volume_m3));
        };
        self.film_version += 1;
        let arrived = self.put_on(cell, volume_m3 / k);
        Ok(Store::new(arrived).scaled(k))
    }
}
