//! How standing water looks, and where it stands.

use std::sync::Arc;

use bevy::math::DVec2;
use bevy::prelude::*;
use rain_core::error::{ConfigError, in_range};
use rain_core::surface::Water;
use rain_render::waves::water_depth_m;

/// How water on the ground looks. Edit it at any time.
#[derive(Resource, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Resource, Default)]
pub struct WaterAppearance {
    /// Absorption of red, green and blue. Units: 1/m. Domain: [0, 1e4]. Default: that of [`Water::CLEAR`].
    pub absorption_per_m: Vec3,
    /// Albedo of mud too thick to see through. Domain: [0, 1]. Default: loam (0.30, 0.22, 0.13).
    pub mud_albedo: Vec3,
    /// Light lost to scattering by mud: 0 clear, 5 a street's puddle, 40 a muddy road ([`Water::MUDDY`]). Units: 1/m.
    /// Domain: [0, 1e4]. Default: 5.
    pub turbidity_per_m: f32,
    /// Multiple of the waves that wind or [`WaveNormalMaps`] make. Domain: [0, 4]. Default: 1.
    pub wave_strength: f32,
    /// Root mean square slope of the waves; `None`: by the wind, none below 1 m/s. Domain: [0, 0.5].
    pub wave_slope: Option<f32>,
    /// Length of the longest wind waves on puddles. Units: m. Domain: [0.02, 10]. Default: 0.25.
    pub wave_length_m: f32,
    /// Velocity of the wind waves; `None`: with the wind, at 0.3 m/s. Units: m/s. Domain: [−10, 10].
    pub wave_velocity_m_s: Option<Vec2>,
    /// Multiple of the rings that drops make. Domain: [0, 4]. Default: 1.
    pub ripple_strength: f32,
    /// Multiple of the slope of wavelets on films that run down slopes; 0: none. Domain: [0, 4]. Default: 1.
    pub flow_strength: f32,
    /// Share of the mirrored view in reflections (where a view has one). Domain: [0, 1]. Default: 1.
    pub reflection_strength: f32,
    /// Share of the light that standing water mirrors of all that it would, sky, lamps and scene: 1 is Fresnel's.
    /// Domain: [0, 1]. Default: 1.
    pub puddle_reflection: f32,
    /// Multiple of the light of the strongest directional light that puddles throw onto walls and ceilings of forward
    /// materials, broken up by the rain's rings: 1 is Fresnel's; 0: none, and no pass. What stands between the water and the
    /// wall takes nothing away. Domain: [0, 10]. Default: 0.
    pub caustics: f32,
}

impl Default for WaterAppearance {
    fn default() -> Self {
        Self {
            absorption_per_m: Water::CLEAR.absorption_per_m.map(|a| a as f32).into(),
            mud_albedo: Vec3::new(0.30, 0.22, 0.13),
            turbidity_per_m: 5.0,
            wave_strength: 1.0,
            wave_slope: None,
            wave_length_m: 0.25,
            wave_velocity_m_s: None,
            ripple_strength: 1.0,
            flow_strength: 1.0,
            reflection_strength: 1.0,
            puddle_reflection: 1.0,
            caustics: 0.0,
        }
    }
}

impl WaterAppearance {
    /// These settings, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not finite or outside its domain.
    pub fn validated(self) -> Result<Self, ConfigError> {
        Water {
            absorption_per_m: self.absorption_per_m.to_array().map(f64::from),
            turbidity_per_m: f64::from(self.turbidity_per_m),
            mud_albedo: self.mud_albedo.to_array().map(f64::from),
        }
        .validated()?;
        let velocity = self.wave_velocity_m_s.unwrap_or_default();
        for (name, value, low, high, allowed) in [
            ("wave_strength", self.wave_strength, 0.0, 4.0, "0 to 4"),
            ("wave_slope", self.wave_slope.unwrap_or(0.0), 0.0, 0.5, "0 to 0.5"),
            ("wave_length_m", self.wave_length_m, 0.02, 10.0, "0.02 to 10 m"),
            ("wave_velocity_m_s", velocity.x, -10.0, 10.0, "-10 to 10 m/s"),
            ("wave_velocity_m_s", velocity.y, -10.0, 10.0, "-10 to 10 m/s"),
            ("ripple_strength", self.ripple_strength, 0.0, 4.0, "0 to 4"),
            ("flow_strength", self.flow_strength, 0.0, 4.0, "0 to 4"),
            ("reflection_strength", self.reflection_strength, 0.0, 1.0, "0 to 1"),
            ("puddle_reflection", self.puddle_reflection, 0.0, 1.0, "0 to 1"),
            ("caustics", self.caustics, 0.0, 10.0, "0 to 10"),
        ] {
            in_range(name, f64::from(value), low, high, allowed)?;
        }
        Ok(self)
    }
}

/// Two normal maps of waves that run over all standing water, in place of the trains of wind waves: drawn by an artist, or
/// taken from a photograph. Their strength and velocity are [`WaterAppearance`]'s.
///
/// Linear (not sRGB) images that tile; red is the slope along the world's x, green against its z (the picture's up), as in
/// glTF. The second runs aslant of the first and slower, and is smaller, so that the two together do not repeat in sight.
/// They are blended with rings and simulated waves by adding up what is aslant in each normal (UDN).
#[derive(Resource, Reflect, Clone, Debug, PartialEq)]
#[reflect(Resource, Default)]
pub struct WaveNormalMaps {
    /// The first; without it there are none.
    pub first: Option<Handle<Image>>,
    /// The second; `None`: the first once more.
    pub second: Option<Handle<Image>>,
    /// Side of the first map on the ground. Units: m. Domain: [0.02, 100]. Default: 1.
    pub size_m: f32,
}

impl Default for WaveNormalMaps {
    fn default() -> Self {
        Self {
            first: None,
            second: None,
            size_m: 1.0,
        }
    }
}

/// Where a map lies on the ground: 1 / side in 1/m, and its place at the world's origin in sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MapPlace {
    pub per_m: f64,
    pub at: DVec2,
}

impl WaveNormalMaps {
    /// Side of the second map over that of the first: no simple ratio.
    const SECOND_SIDE: f64 = 0.618_034;
    /// Its speed over that of the first.
    const SECOND_SPEED: f64 = 0.71;
    /// Its direction from that of the first. Units: rad.
    const SECOND_TURN: f64 = 0.7;

    /// These maps, if their size lies in its domain.
    ///
    /// # Errors
    /// Names the field.
    pub fn validated(&self) -> Result<&Self, ConfigError> {
        in_range("size_m", f64::from(self.size_m), 0.02, 100.0, "0.02 to 100 m")?;
        Ok(self)
    }

    /// Both images, where there are maps and they validate.
    pub(crate) fn images(&self) -> Option<[&Handle<Image>; 2]> {
        let first = self.first.as_ref().filter(|_| self.validated().is_ok())?;
        Some([first, self.second.as_ref().unwrap_or(first)])
    }

    /// Where both maps lie at a time, moved with this velocity of the waves.
    pub(crate) fn places(&self, velocity_m_s: Vec2, time_s: f64) -> [MapPlace; 2] {
        let first = f64::from(self.size_m);
        let velocity = velocity_m_s.as_dvec2();
        let slower = DVec2::from_angle(Self::SECOND_TURN).rotate(velocity) * Self::SECOND_SPEED;
        [(first, velocity), (first * Self::SECOND_SIDE, slower)].map(|(side, velocity)| MapPlace {
            per_m: 1.0 / side,
            at: (-velocity * time_s / side).rem_euclid(DVec2::ONE),
        })
    }
}

/// Mean square slope of wind waves on a puddle. Units: none.
///
/// Cox & Munk 1954's clean surface, 0.003 + 0.00512 U, is that of the open sea; a puddle is short of fetch, so one
/// tenth of it is taken (chosen by eye), and nothing below 1 m/s, where no ripple forms.
#[must_use]
pub fn wind_slope_variance(wind_m_s: f64) -> f64 {
    if wind_m_s.is_nan() || wind_m_s <= 1.0 {
        return 0.0;
    }
    0.1 * (0.003 + 0.00512 * wind_m_s.min(40.0)) * ((wind_m_s - 1.0) / 2.0).min(1.0)
}

/// Side of the texture that holds the levels. Units: texels.
pub const LEVEL_TEXELS: u32 = 1024;

/// A level where no water stands. Units: m.
pub const NO_WATER_M: f32 = -1e9;

/// Levels of standing water, for the picture: filled from the ground's basins, or by the app itself.
#[derive(Resource, Clone, Debug)]
pub struct WaterLevels {
    /// World position (x, z) of the first cell's corner. Units: m.
    pub corner_m: DVec2,
    /// Edge of a cell. Units: m.
    pub cell_m: f64,
    /// Cells along x and z, at most [`LEVEL_TEXELS`] each.
    pub cells: UVec2,
    /// World height of level 0. Units: m.
    pub base_m: f64,
    levels_m: Arc<Vec<f32>>,
    /// Cells with water, in order.
    wet: Arc<Vec<u32>>,
    /// Height of the ground in each cell above `base_m`, for the depth of waves; may be empty. Units: m.
    pub ground_m: Arc<Vec<f32>>,
    /// Counts changes: a new number is uploaded.
    version: u64,
}

impl Default for WaterLevels {
    fn default() -> Self {
        Self {
            corner_m: DVec2::ZERO,
            cell_m: 1.0,
            cells: UVec2::ZERO,
            base_m: 0.0,
            levels_m: Arc::default(),
            wet: Arc::default(),
            ground_m: Arc::default(),
            version: 0,
        }
    }
}

impl WaterLevels {
    /// Counts changes.
    #[must_use]
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Whether the cells fit the texture and the levels fit the cells.
    #[must_use]
    pub fn is_valid(&self) -> bool {
        self.cells.max_element() <= LEVEL_TEXELS
            && self.cells.element_product() as usize == self.levels_m.len()
            && (self.ground_m.is_empty() || self.ground_m.len() == self.levels_m.len())
            && self.cell_m > 0.0
            && self.cell_m.is_finite()
            && self.corner_m.is_finite()
            && self.base_m.is_finite()
    }

    /// Index of the cell that holds a world position.
    fn cell_at(&self, x_m: f64, z_m: f64) -> Option<usize> {
        let at = ((DVec2::new(x_m, z_m) - self.corner_m) / self.cell_m).floor();
        let inside = at.x >= 0.0 && at.y >= 0.0 && at.x < f64::from(self.cells.x) && at.y < f64::from(self.cells.y);
        let cell = inside.then(|| at.y as usize * self.cells.x as usize + at.x as usize)?;
        (cell < self.levels_m.len()).then_some(cell)
    }

    /// World height of the water's surface at a place, where water stands or is a cell away. Units: m.
    #[must_use]
    pub fn surface_at(&self, x_m: f64, z_m: f64) -> Option<f32> {
        let level = self.levels_m[self.cell_at(x_m, z_m)?];
        (level > NO_WATER_M).then(|| (self.base_m + f64::from(level)) as f32)
    }

    /// Depth of the standing water over the ground between the cells' middles; 0 is dry. Units: m.
    #[must_use]
    pub fn depth_at(&self, x_m: f64, z_m: f64) -> f32 {
        let Some(cell) = self.cell_at(x_m, z_m).filter(|_| !self.ground_m.is_empty()) else {
            return 0.0;
        };
        let level = self.levels_m[cell];
        if level <= NO_WATER_M {
            return 0.0;
        }
        water_depth_m(f64::from(level), self.ground_between_cells_m(x_m, z_m))
    }

    /// World height of the ground between the cells' middles, where there is any. Units: m.
    #[must_use]
    pub fn ground_at(&self, x_m: f64, z_m: f64) -> Option<f32> {
        self.cell_at(x_m, z_m).filter(|_| !self.ground_m.is_empty())?;
        let height = self.ground_between_cells_m(x_m, z_m);
        height.is_finite().then_some((self.base_m + height) as f32)
    }

    /// Above `base_m`; of a place in the cells, with heights.
    fn ground_between_cells_m(&self, x_m: f64, z_m: f64) -> f64 {
        let at = (DVec2::new(x_m, z_m) - self.corner_m) / self.cell_m - 0.5;
        let (corner, t) = (at.floor(), at - at.floor());
        let ground = |dx: f64, dz: f64| {
            let column = (corner.x + dx).clamp(0.0, f64::from(self.cells.x - 1)) as usize;
            let row = (corner.y + dz).clamp(0.0, f64::from(self.cells.y - 1)) as usize;
            f64::from(self.ground_m[row * self.cells.x as usize + column])
        };
        let near = ground(0.0, 0.0) * (1.0 - t.x) + ground(1.0, 0.0) * t.x;
        let far = ground(0.0, 1.0) * (1.0 - t.x) + ground(1.0, 1.0) * t.x;
        near * (1.0 - t.y) + far * t.y
    }

    /// Level of each cell above `base_m`. Units: m.
    #[must_use]
    pub fn levels_m(&self) -> &Arc<Vec<f32>> {
        &self.levels_m
    }

    /// Replaces all levels: one for each cell, row after row (z), above `base_m`, or [`NO_WATER_M`]. Units: m. A pool's
    /// level should reach one cell beyond its shore.
    pub fn set_levels(&mut self, levels_m: Vec<f32>) {
        let cells = (0..).zip(&levels_m).filter(|(_, level)| **level > NO_WATER_M);
        self.wet = Arc::new(cells.map(|(cell, _)| cell).collect());
        self.levels_m = Arc::new(levels_m);
        self.version += 1;
    }

    /// Whether any cell holds water.
    #[must_use]
    pub fn any_water(&self) -> bool {
        !self.wet.is_empty()
    }

    /// World place (x, z) and level of every cell with water. Units: m.
    pub fn pools(&self) -> impl Iterator<Item = (DVec2, f64)> {
        self.wet.iter().map(|&cell| {
            let (column, row) = (cell % self.cells.x.max(1), cell / self.cells.x.max(1));
            let place = self.corner_m + (UVec2::new(column, row).as_dvec2() + 0.5) * self.cell_m;
            (place, self.base_m + f64::from(self.levels_m[cell as usize]))
        })
    }
}

/// The textures that wet materials read.
#[derive(Resource, Clone, Debug)]
pub struct WaterImages {
    /// Levels (R32Float).
    pub levels: Handle<Image>,
    /// Films, pores and heights of the ground (Rgba16Float), see [`super::GroundFilms`].
    pub films: Handle<Image>,
    /// The same around the view, finer (Rgba16Float, a layer for each level), see [`super::GroundMap`].
    pub map: Handle<Image>,
    /// Slopes of the rings that drops make, tiling the world (Rgba16Float).
    pub ripples: Handle<Image>,
    /// Slopes of interactive waves near the view (Rgba16Float).
    pub waves: Handle<Image>,
    /// The mirrored views (Rgba16Float), a layer each.
    pub reflection: Handle<Image>,
    /// Light that water throws (Rgba16Float), tiling the world as the rings do; from when it is first thrown.
    pub caustics: Option<Handle<Image>>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_setting_is_checked_and_named() {
        type Set = fn(&mut WaterAppearance, f32);
        let fields: [(&str, Set, [f32; 2]); 11] = [
            ("absorption_per_m", |w, v| w.absorption_per_m.y = v, [-0.1, 2e4]),
            ("mud_albedo", |w, v| w.mud_albedo.z = v, [-0.1, 1.1]),
            ("turbidity_per_m", |w, v| w.turbidity_per_m = v, [-1.0, 2e4]),
            ("wave_strength", |w, v| w.wave_strength = v, [-0.1, 5.0]),
            ("wave_length_m", |w, v| w.wave_length_m = v, [0.0, 11.0]),
            (
                "wave_velocity_m_s",
                |w, v| w.wave_velocity_m_s = Some(Vec2::splat(v)),
                [-11.0, 11.0],
            ),
            ("ripple_strength", |w, v| w.ripple_strength = v, [-0.1, 5.0]),
            ("reflection_strength", |w, v| w.reflection_strength = v, [-0.1, 1.1]),
            ("wave_slope", |w, v| w.wave_slope = Some(v), [-0.1, 0.6]),
            ("puddle_reflection", |w, v| w.puddle_reflection = v, [-0.1, 1.1]),
            ("caustics", |w, v| w.caustics = v, [-0.1, 10.1]),
        ];
        assert!(WaterAppearance::default().validated().is_ok());
        for (name, set, [low, high]) in fields {
            for bad in [low, high, f32::NAN, f32::INFINITY] {
                let mut water = WaterAppearance::default();
                set(&mut water, bad);
                let message = water.validated().expect_err("invalid").to_string();
                assert!(message.starts_with(name), "{message}");
            }
        }
    }

    #[test]
    fn normal_maps_run_with_the_waves_for_days_and_a_bad_size_is_none() {
        let maps = WaveNormalMaps {
            first: Some(Handle::default()),
            ..Default::default()
        };
        let way = |velocity: Vec2, from: f64, to: f64| {
            let [a, b] = [from, to].map(|t| maps.places(velocity, t));
            [0, 1].map(|i| {
                let moved = b[i].at - a[i].at;
                (moved - moved.round()) / a[i].per_m
            })
        };
        // A tenth of a second, at the start and after a year.
        for start in [0.0, 3.2e7] {
            let [first, second] = way(Vec2::new(0.3, -0.4), start, start + 0.1);
            assert!((first - DVec2::new(-0.03, 0.04)).length() < 1e-6, "{first}");
            assert!(
                (second.length() - 0.0355).abs() < 1e-6 && second.perp_dot(first).abs() > 1e-4,
                "{second}"
            );
        }
        assert_eq!(way(Vec2::ZERO, 0.0, 9.0), [DVec2::ZERO; 2]);
        assert!(maps.images().is_some() && WaveNormalMaps::default().images().is_none());
        for bad in [f32::NAN, f32::INFINITY, 0.0, 101.0] {
            let maps = WaveNormalMaps {
                size_m: bad,
                ..maps.clone()
            };
            assert!(maps.validated().expect_err("invalid").to_string().starts_with("size_m"));
            assert!(maps.images().is_none());
        }
    }

    #[test]
    fn wind_ruffles_puddles_from_a_breeze_on() {
        assert_eq!(wind_slope_variance(0.0), 0.0);
        assert_eq!(wind_slope_variance(1.0), 0.0);
        assert_eq!(wind_slope_variance(f64::NAN), 0.0);
        assert!(wind_slope_variance(10.0) > wind_slope_variance(3.0));
        assert!(wind_slope_variance(1e9) < 0.03);
    }
}
