//! The host's side of the map: where it lies, and what it has not seen yet.

use glam::DVec3;
use rain_core::error::{ConfigError, in_range};
use rain_core::ops;
use rain_core::weather::{ColumnF32, SurfaceClass};

use super::frame::WaterMapFrame;
use super::params::{GroundCell, GroundPlace, MAX_LEVELS, WaterMapSettings};
use super::press::{MAX_PRESSES, WaterPress};
use crate::gpu_types::{ColumnRules, WaterMapParams, WaterMapPlaces};

/// Presses that wait for a frame; with more the map starts anew from the ground, which knows them.
const MOST_WAITING: usize = 4096;
/// Beyond this from the origin a view is nowhere. Units: m.
const FARTHEST_M: f64 = 1e7;

/// Why there is nothing to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WaterMapRest {
    /// There is no ground, or the view is nowhere.
    NoGround,
    /// Nothing is wet.
    Dry,
    /// Nothing has changed that could be seen.
    Settled,
}

/// Weather that the texels have not seen.
#[derive(Debug, Clone, Copy, Default)]
struct Pending {
    rain_mm: f64,
    evaporation_mm: f64,
    time_s: f64,
}

/// A rectangle of ground cells: first and past the last.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Cells {
    low: [i64; 2],
    high: [i64; 2],
}

impl Cells {
    fn with(self, other: Self) -> Self {
        Self {
            low: [0, 1].map(|i| self.low[i].min(other.low[i])),
            high: [0, 1].map(|i| self.high[i].max(other.high[i])),
        }
    }
}

/// The map as the host knows it; no GPU is needed.
#[derive(Debug, Clone)]
pub struct WaterMap {
    settings: WaterMapSettings,
    ground: Option<GroundPlace>,
    cells: Vec<[u32; 2]>,
    cells_sent: bool,
    /// Classes of the ground.
    present: [bool; SurfaceClass::COUNT],
    /// What each level lies around, amid the eyes or at the leading one (world x, z). Units: m.
    centres: [[f64; 2]; MAX_LEVELS],
    /// World texel of each level's corner: where it should be, and where the texels lie that are filled.
    wanted: Option<[[i64; 2]; MAX_LEVELS]>,
    held: Option<[[i64; 2]; MAX_LEVELS]>,
    pending: Pending,
    /// For each class water of which no texel has more, where nothing was pressed.
    fullest: [ColumnF32; SurfaceClass::COUNT],
    presses: Vec<WaterPress>,
    pools: bool,
}

impl WaterMap {
    /// A map that lies nowhere.
    ///
    /// # Errors
    /// Names the first setting outside its domain.
    pub fn new(settings: &WaterMapSettings) -> Result<Self, ConfigError> {
        Ok(Self {
            settings: *settings.validated()?,
            ground: None,
            cells: Vec::new(),
            cells_sent: false,
            present: [false; SurfaceClass::COUNT],
            centres: [[0.0; 2]; MAX_LEVELS],
            wanted: None,
            held: None,
            pending: Pending::default(),
            fullest: [ColumnF32::default(); SurfaceClass::COUNT],
            presses: Vec::new(),
            pools: false,
        })
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &WaterMapSettings {
        &self.settings
    }

    /// Whether texels are filled and the texture may be shown.
    #[must_use]
    pub fn is_shown(&self) -> bool {
        self.held.is_some()
    }

    /// Forgets all texels: they start anew from the ground's cells. For a jump of the clock, a restored world, a lost
    /// device.
    pub fn forget(&mut self) {
        self.held = None;
        self.pending = Pending::default();
        self.presses.clear();
        self.fullest = [ColumnF32::default(); SurfaceClass::COUNT];
        self.cells_sent = false;
    }

    /// The ground: its place, and its cells row by row. With the build that it has, what is known of its water stays (the
    /// exposure of cells or the window of them has changed); with another one the map starts anew. Allocates when the
    /// ground grows.
    ///
    /// # Errors
    /// When a number is outside its domain or there are not as many cells as the place says; then nothing changes.
    pub fn set_ground(
        &mut self,
        place: &GroundPlace,
        cells: impl ExactSizeIterator<Item = GroundCell>,
    ) -> Result<(), ConfigError> {
        place.check()?;
        let number = place.cells[0] as usize * place.cells[1] as usize;
        in_range(
            "length of cells",
            cells.len() as f64,
            number as f64,
            number as f64,
            "as many as the place says",
        )?;
        let knows = |old: &GroundPlace| {
            // Texels beside the old cells are empty, not dry: where cells come in under them they start anew.
            old.build == place.build && (old.covers_as(place) || self.lies_inside(old))
        };
        if !self.ground.as_ref().is_some_and(knows) {
            self.forget();
        }
        self.ground = Some(*place);
        self.cells.clear();
        self.present = [false; SurfaceClass::COUNT];
        for cell in cells {
            if cell.height_m.is_finite() {
                self.present[usize::from(cell.class).min(SurfaceClass::COUNT - 1)] = true;
            }
            self.cells.push(cell.packed());
        }
        self.cells_sent = false;
        Ok(())
    }

    /// Whether all held texels lie over cells of a place.
    fn lies_inside(&self, ground: &GroundPlace) -> bool {
        let Some(held) = self.held else { return true };
        let n = f64::from(self.settings.texels);
        (0..self.settings.levels as usize).all(|level| {
            let texel = self.settings.level_cell_m(level);
            (0..2).all(|axis| {
                let (low, high) = (held[level][axis] as f64 * texel, (held[level][axis] as f64 + n) * texel);
                let end = ground.corner_m[axis] + f64::from(ground.cells[axis]) * ground.cell_m;
                low >= ground.corner_m[axis] && high <= end
            })
        })
    }

    /// There is no ground any more.
    pub fn take_ground_away(&mut self) {
        self.forget();
        self.ground = None;
        self.wanted = None;
    }

    /// The leading view and the places of all (world x, z; units: m). A level lies amid all of them if they are no
    /// farther apart than [`WaterMapSettings::spread_m`], else around the leading one; it moves in steps of an eighth of
    /// its side. A leading view that is nowhere is not followed, others that are nowhere do not count.
    pub fn follow(&mut self, leading_m: [f64; 2], all_m: &[[f64; 2]]) {
        let is_somewhere = |view: &[f64; 2]| view.iter().all(|at| at.abs() <= FARTHEST_M);
        if !is_somewhere(&leading_m) {
            return;
        }
        let (mut low, mut high) = (leading_m, leading_m);
        for view in all_m.iter().filter(|view| is_somewhere(view)) {
            low = [0, 1].map(|axis| low[axis].min(view[axis]));
            high = [0, 1].map(|axis| high[axis].max(view[axis]));
        }
        let apart_m = (high[0] - low[0]).max(high[1] - low[1]);
        let half = i64::from(self.settings.texels / 2);
        let snap = self.settings.snap();
        let mut corners = self.wanted.unwrap_or_default();
        for (level, corner) in corners.iter_mut().enumerate().take(self.settings.levels as usize) {
            let amid = apart_m > 0.0 && apart_m <= self.settings.spread_m(level);
            let centre = if amid {
                [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]))
            } else {
                leading_m
            };
            self.centres[level] = centre;
            for (corner, at) in corner.iter_mut().zip(centre) {
                let texel = at / self.settings.level_cell_m(level);
                let off = (texel - (*corner + half) as f64).abs();
                if self.wanted.is_none() || off > 0.75 * snap as f64 {
                    *corner = (texel / snap as f64).round() as i64 * snap - half;
                }
            }
        }
        self.wanted = Some(corners);
    }

    /// Weather over open ground since the last call: rain (units: mm), what could evaporate (mm) and time (s). `pools`:
    /// standing water may have filled texels.
    ///
    /// # Errors
    /// When a number is negative, not finite or above 1e6 mm or 1e9 s; then nothing changes.
    pub fn advance(&mut self, rain_mm: f64, evaporation_mm: f64, time_s: f64, pools: bool) -> Result<(), ConfigError> {
        in_range("rain_mm", rain_mm, 0.0, 1e6, "0 to 1e6 mm")?;
        in_range("evaporation_mm", evaporation_mm, 0.0, 1e6, "0 to 1e6 mm")?;
        in_range("time_s", time_s, 0.0, 1e9, "0 to 1e9 s")?;
        self.pools = pools;
        if self.held.is_some() {
            self.pending.rain_mm += rain_mm;
            self.pending.evaporation_mm += evaporation_mm;
            self.pending.time_s += time_s;
        } else {
            // Texels that are not filled yet start from what the ground has seen.
            self.pending.rain_mm = rain_mm;
        }
        Ok(())
    }

    /// A wheel or a foot passes.
    ///
    /// # Errors
    /// When a number is outside its domain; then nothing changes.
    pub fn press(&mut self, press: &WaterPress) -> Result<(), ConfigError> {
        press.check()?;
        if self.held.is_some() && press.share > 0.0 {
            if self.presses.len() == MOST_WAITING {
                self.forget();
            } else {
                self.presses.push(*press);
            }
        }
        Ok(())
    }

    fn present(&self) -> impl Iterator<Item = (usize, &rain_core::weather::ColumnRules)> {
        let rules = self.ground.as_ref().map(|ground| &ground.rules);
        rules
            .into_iter()
            .flat_map(|rules| rules.iter().enumerate())
            .filter(move |(class, _)| self.present[*class])
    }

    /// How much the gathered weather may have changed a texel, as a share of what its texture or its pores hold.
    fn change(&self) -> f64 {
        let Pending {
            rain_mm,
            evaporation_mm,
            time_s,
        } = self.pending;
        let of = |(class, rules): (usize, &rain_core::weather::ColumnRules)| {
            let fullest = self.fullest[class].film_mm;
            let soaks = fullest > 0.0;
            let soil = f64::from(rules.soil_mm_s + rules.dry_soil_mm_s) * time_s;
            let drains = visible_drain_mm(rules, fullest, time_s);
            let moved = rain_mm + evaporation_mm + drains + if soaks { soil } else { 0.0 };
            let texture = if rules.texture_mm > 0.0 {
                rules.texture_mm
            } else {
                rules.capacity_mm
            };
            moved / f64::from(texture.min(rules.capacity_mm))
        };
        self.present().map(of).fold(0.0, f64::max)
    }

    fn is_due(&self) -> bool {
        let change = self.change();
        change > 0.0 && change >= self.settings.seen_share && self.pending.time_s >= self.settings.interval_s
    }

    /// Why nothing has to be done now; `None`: a frame is to be taken. `ground_is_dry`: the ground's cells hold no
    /// water.
    pub fn rest(&mut self, ground_is_dry: bool) -> Option<WaterMapRest> {
        let (Some(_), Some(wanted)) = (self.ground, self.wanted) else {
            return Some(WaterMapRest::NoGround);
        };
        let Some(held) = self.held else {
            let dry = ground_is_dry && self.pending.rain_mm == 0.0;
            return dry.then_some(WaterMapRest::Dry);
        };
        let wet = |(class, _): (usize, &rain_core::weather::ColumnRules)| {
            self.fullest[class].pores_mm > 0.0 || self.fullest[class].film_mm > 0.0
        };
        if self.pending.rain_mm == 0.0 && !self.present().any(wet) {
            if ground_is_dry {
                // Nothing is remembered any more.
                let sent = self.cells_sent;
                self.forget();
                self.cells_sent = sent;
                return Some(WaterMapRest::Dry);
            }
            self.pending = Pending::default();
        }
        let busy = wanted != held || !self.presses.is_empty() || !self.cells_sent || self.is_due();
        (!busy).then_some(WaterMapRest::Settled)
    }

    /// The cells under the texels of a level that are not filled.
    fn missing(&self, ground: &GroundPlace, level: usize, wanted: [i64; 2]) -> Option<Cells> {
        let n = i64::from(self.settings.texels);
        let mut low = wanted;
        let mut high = wanted.map(|at| at + n);
        if let Some(held) = self.held.map(|held| held[level]) {
            let moved = [0, 1].map(|axis| wanted[axis] - held[axis]);
            match moved {
                [0, 0] => return None,
                [x, 0] | [0, x] if x.abs() < n => {
                    let axis = usize::from(moved[0] == 0);
                    if x > 0 {
                        low[axis] = held[axis] + n;
                    } else {
                        high[axis] = held[axis];
                    }
                }
                _ => {}
            }
        }
        let texel = self.settings.level_cell_m(level);
        let cell = |at: i64, axis: usize| ((at as f64 * texel - ground.corner_m[axis]) / ground.cell_m).floor() as i64;
        let clip = |at: i64, axis: usize| at.clamp(0, i64::from(ground.cells[axis]));
        let cells = Cells {
            low: [0, 1].map(|axis| clip(cell(low[axis], axis), axis)),
            high: [0, 1].map(|axis| clip(cell(high[axis], axis) + 1, axis)),
        };
        (0..2).all(|axis| cells.low[axis] < cells.high[axis]).then_some(cells)
    }

    /// Moves the frame's work over. `water` tells what a cell of the ground (column, row) holds; it is asked for cells
    /// under new texels only.
    pub fn take(&mut self, frame: &mut WaterMapFrame, water: impl Fn(u32, u32) -> ColumnF32) {
        frame.clear();
        let (Some(ground), Some(wanted)) = (self.ground, self.wanted) else {
            return;
        };
        let levels = self.settings.levels as usize;
        let moved = self.held != Some(wanted);
        frame.advances = moved || self.is_due();
        let first = self.held.is_none();
        let Pending {
            rain_mm,
            evaporation_mm,
            time_s,
        } = if first {
            Pending::default()
        } else if frame.advances {
            self.pending
        } else {
            Pending::default()
        };
        if frame.advances {
            self.pending = Pending::default();
        }
        if !self.cells_sent {
            frame.ground.extend_from_slice(&self.cells);
            self.cells_sent = true;
        }
        let seeds = (0..levels)
            .filter_map(|level| self.missing(&ground, level, wanted[level]))
            .reduce(Cells::with);
        let seeds = seeds.unwrap_or(Cells {
            low: [0; 2],
            high: [0; 2],
        });
        for z in seeds.low[1]..seeds.high[1] {
            for x in seeds.low[0]..seeds.high[0] {
                let column = water(x as u32, z as u32);
                frame.seeds.push([column.pores_mm, column.film_mm, column.soil_s, 0.0]);
                let class = self.cells[z as usize * ground.cells[0] as usize + x as usize][1] & 255;
                let most = &mut self.fullest[(class as usize).min(SurfaceClass::COUNT - 1)];
                most.pores_mm = most.pores_mm.max(column.pores_mm);
                most.film_mm = most.film_mm.max(column.film_mm);
                most.soil_s = most.soil_s.max(column.soil_s);
            }
        }
        self.pass_time(&ground, [rain_mm, evaporation_mm, time_s]);
        let rate = |mm: f64| if time_s > 0.0 { (mm / time_s) as f32 } else { 0.0 };
        let centre = [0, 1]
            .map(|axis| (wanted[0][axis] + i64::from(self.settings.texels / 2)) as f64 * self.settings.level_cell_m(0));
        frame.origin_m = DVec3::new(centre[0], ground.base_m, centre[1]);
        for (level, corner) in wanted.iter().enumerate().take(levels) {
            let cell_m = self.settings.level_cell_m(level);
            let n = i64::from(self.settings.texels);
            // A level that is new keeps nothing.
            let kept = self.held.map_or([2 * n; 2], |held| {
                [0, 1].map(|axis| (held[level][axis] - corner[axis]).clamp(-2 * n, 2 * n))
            });
            let corner_m = corner.map(|at| at as f64 * cell_m);
            frame.levels.push(WaterMapParams {
                rules: ground.rules.map(|rules| ColumnRules::from(&rules)),
                cover: crate::cover::open_sky(),
                offset: corner.map(|at| at.rem_euclid(n) as u32),
                kept: kept.map(|at| at as i32),
                seed_low: seeds.low.map(|at| at as i32),
                seed_cells: [0, 1].map(|axis| (seeds.high[axis] - seeds.low[axis]) as i32),
                ground_cells: ground.cells.map(|n| n as i32),
                ground_corner: [0, 1].map(|axis| ((corner_m[axis] - ground.corner_m[axis]) / ground.cell_m) as f32),
                corner: [0, 1].map(|axis| (corner_m[axis] - centre[axis]) as f32),
                texels: self.settings.texels,
                level: level as u32,
                cell: cell_m as f32,
                ground_step: (cell_m / ground.cell_m) as f32,
                per_ground_cell: (1.0 / ground.cell_m) as f32,
                base: 0.0,
                rain: rate(rain_mm),
                evaporation: rate(evaporation_mm),
                time: time_s as f32,
                pools: f32::from(u8::from(self.pools)),
            });
        }
        self.take_presses(frame, &wanted);
        self.held = Some(wanted);
    }

    fn pass_time(&mut self, ground: &GroundPlace, [rain_mm, evaporation_mm, time_s]: [f64; 3]) {
        for (class, most) in self.fullest.iter_mut().enumerate() {
            let rules = &ground.rules[class];
            if self.pools {
                most.pores_mm = rules.capacity_mm;
            }
            if time_s > 0.0 {
                let hourly = |mm: f64| (mm / time_s * 3600.0) as f32;
                *most = most.advanced(rules, hourly(rain_mm), hourly(evaporation_mm), time_s as f32);
            }
        }
    }

    fn take_presses(&mut self, frame: &mut WaterMapFrame, wanted: &[[i64; 2]; MAX_LEVELS]) {
        let count = self.presses.len().min(MAX_PRESSES);
        for press in self.presses.drain(..count) {
            for level in 0..self.settings.levels {
                let cell_m = self.settings.level_cell_m(level as usize);
                let corner_m = wanted[level as usize].map(|at| at as f64 * cell_m);
                let slot = frame.stamps.len() as u32;
                let stamp = press.stamp(corner_m, cell_m, self.settings.texels, slot);
                frame.stamps.extend(stamp.map(|stamp| (level, stamp)));
            }
        }
        if count > 0 {
            // Water laid beside a way makes its texels fuller.
            for most in &mut self.fullest {
                most.film_mm = (1.5 * most.film_mm).min(50.0);
            }
        }
    }

    /// Where the filled levels lie.
    #[must_use]
    pub fn place(&self) -> WaterMapPlace {
        WaterMapPlace {
            settings: self.settings,
            centres: self.centres,
            held: self.held,
        }
    }

    /// Index of the texel of a level that holds a place (world x, z; units: m), among all texels of
    /// [`super::WaterMapGpu::water`]; none beside the level or while nothing is filled.
    #[must_use]
    pub fn texel_at(&self, level: usize, place_m: [f64; 2]) -> Option<usize> {
        let corner = self.held.filter(|_| level < self.settings.levels as usize)?[level];
        let n = i64::from(self.settings.texels);
        let texel = place_m.map(|at| (at / self.settings.level_cell_m(level)).floor());
        let inside = (0..2).all(|axis| {
            let at = texel[axis] - corner[axis] as f64;
            (0.0..n as f64).contains(&at)
        });
        let [x, z] = texel.map(|at| (at as i64).rem_euclid(n) as usize);
        inside.then_some((level * n as usize + z) * n as usize + x)
    }
}

/// Where the filled levels of a map lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WaterMapPlace {
    settings: WaterMapSettings,
    centres: [[f64; 2]; MAX_LEVELS],
    held: Option<[[i64; 2]; MAX_LEVELS]>,
}

impl WaterMapPlace {
    /// The map's settings.
    #[must_use]
    pub fn settings(&self) -> &WaterMapSettings {
        &self.settings
    }

    /// The same for an eye (world x, z; units: m).
    #[must_use]
    pub fn seen_from(&self, eye_m: [f64; 2]) -> WaterMapPlaces {
        let place = |level: usize| -> [f32; 4] {
            let Some(held) = self.held.filter(|_| level < self.settings.levels as usize) else {
                return [0.0; 4];
            };
            let cell = self.settings.level_cell_m(level);
            let side = cell * f64::from(self.settings.texels);
            let inside = (0..2)
                .map(|axis| {
                    let at = self.centres[level][axis] - held[level][axis] as f64 * cell;
                    at.min(side - at)
                })
                .fold(f64::INFINITY, f64::min);
            // As far as it holds wherever its centre is between two moves: the border stays at one distance.
            let far = (inside - 2.0 * cell).min(self.settings.holds_m(level)).max(0.0);
            let [x, z] = eye_m.map(|at| (at / side).rem_euclid(1.0) as f32);
            [x, z, (1.0 / side) as f32, far as f32]
        };
        let centre = |level: usize| [0, 1].map(|axis| (self.centres[level][axis] - eye_m[axis]) as f32);
        WaterMapPlaces {
            fine: place(0),
            middle: place(1),
            coarse: place(2),
            fine_centre: centre(0),
            middle_centre: centre(1),
            coarse_centre: centre(2),
            pad: [0.0; 2],
        }
    }
}
/// The most that the drain may take in a time from films up to `fullest_mm` that are not closed: half the texture's depth
/// above it they are, and lose nothing to be seen. Units: mm.
fn visible_drain_mm(rules: &rain_core::weather::ColumnRules, fullest_mm: f32, time_s: f64) -> f64 {
    let above = f64::from((fullest_mm - rules.texture_mm).min(0.5 * rules.texture_mm));
    if !(above > 0.0 && rules.drain > 0.0) {
        return 0.0;
    }
    // w' = −κ w^(5/3).
    let root = 1.0 / ops::cbrt(above * above) + 2.0 / 3.0 * f64::from(rules.drain) * time_s;
    above - 1.0 / (root * ops::sqrt(root))
}
