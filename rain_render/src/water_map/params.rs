//! Settings of the water map, and the ground that it lies on.

use rain_core::error::{ConfigError, in_range};
use rain_core::weather::{ColumnRules, SurfaceClass};

/// Most levels.
pub const MAX_LEVELS: usize = 3;

/// Format of the texture that shows the map.
pub const WATER_MAP_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// Share of the distance to which a level holds from which it fades, as in `rain_water_map_level`.
const UNFADED: f64 = 0.75;

/// Settings of a [`super::WaterMap`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WaterMapSettings {
    /// Texels on a side of a level. Domain: a power of two in [64, 2048]. Default: 512.
    pub texels: u32,
    /// Edge of a texel of the finest level. Units: m. Domain: [0.005, 1]. Default: 0.0625: a tyre is three texels wide.
    pub cell_m: f64,
    /// Levels, each twice as coarse as the one before. Domain: [1, 3]. Default: 2, 32 m and 64 m wide.
    pub levels: u32,
    /// Shortest time between two steps. Units: s. Domain: [0, 60]. Default: 0.25.
    pub interval_s: f64,
    /// A step is taken once the weather may have changed the film or the pores of a texel by this share of what texture
    /// or pores hold. Units: none. Domain: [0, 0.1]. Default: 0.002, half a step of an 8-bit picture.
    pub seen_share: f64,
}

impl Default for WaterMapSettings {
    fn default() -> Self {
        Self {
            texels: 512,
            cell_m: 0.0625,
            levels: 2,
            interval_s: 0.25,
            seen_share: 0.002,
        }
    }
}

impl WaterMapSettings {
    /// These settings, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not finite or outside its domain.
    pub fn validated(&self) -> Result<&Self, ConfigError> {
        const ALLOWED: &str = "a power of two in 64 to 2048";
        in_range("texels", f64::from(self.texels), 64.0, 2048.0, ALLOWED)?;
        if !self.texels.is_power_of_two() {
            return Err(ConfigError::OutOfRange {
                field: "texels",
                value: f64::from(self.texels),
                allowed: ALLOWED,
            });
        }
        in_range("cell_m", self.cell_m, 0.005, 1.0, "0.005 to 1 m")?;
        in_range("levels", f64::from(self.levels), 1.0, MAX_LEVELS as f64, "1 to 3")?;
        in_range("interval_s", self.interval_s, 0.0, 60.0, "0 to 60 s")?;
        in_range("seen_share", self.seen_share, 0.0, 0.1, "0 to 0.1")?;
        Ok(self)
    }

    /// Edge of a level's texel. Units: m.
    #[must_use]
    pub fn level_cell_m(&self, level: usize) -> f64 {
        self.cell_m * f64::from(1_u32 << level.min(MAX_LEVELS))
    }

    /// How far from its centre a level holds wherever that is between two moves. Units: m.
    #[must_use]
    pub fn holds_m(&self, level: usize) -> f64 {
        let texels = f64::from(self.texels / 2) - 0.75 * self.snap() as f64 - 2.0;
        texels * self.level_cell_m(level)
    }

    /// How far apart views may be for a level to lie amid them: each then has at least half of the ground around it that
    /// the level shows unfaded to one view alone. By default 9.7 m and 19.3 m. Units: m.
    #[must_use]
    pub fn spread_m(&self, level: usize) -> f64 {
        UNFADED * self.holds_m(level)
    }

    /// Texels by which a level moves at once.
    pub(super) fn snap(&self) -> i64 {
        i64::from(self.texels / 8)
    }

    /// The map's texture, for the host to make. It is sampled with repeat.
    #[must_use]
    pub fn map_texture(&self) -> wgpu::TextureDescriptor<'static> {
        wgpu::TextureDescriptor {
            label: Some("rain water map"),
            size: wgpu::Extent3d {
                width: self.texels,
                height: self.texels,
                depth_or_array_layers: self.levels,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: WATER_MAP_FORMAT,
            usage: wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::STORAGE_BINDING
                | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        }
    }
}

/// Where the ground's cells lie, or the window of them that the picture knows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundPlace {
    /// Tells grounds apart: another number, and the map starts anew.
    pub build: u64,
    /// World position (x, z) of the first cell's corner. Units: m.
    pub corner_m: [f64; 2],
    /// Edge of a cell. Units: m.
    pub cell_m: f64,
    /// Cells along x and z.
    pub cells: [u32; 2],
    /// World height that the cells' heights count from. Units: m.
    pub base_m: f64,
    /// What each class does with water, by [`SurfaceClass::index`].
    pub rules: [ColumnRules; SurfaceClass::COUNT],
}

impl GroundPlace {
    /// Whether another place has its cells where this one has them.
    pub(super) fn covers_as(&self, other: &Self) -> bool {
        (self.corner_m, self.cell_m, self.cells) == (other.corner_m, other.cell_m, other.cells)
    }

    /// # Errors
    /// For numbers that are not finite or too large, and for no cells.
    pub(super) fn check(&self) -> Result<(), ConfigError> {
        for at in self.corner_m {
            in_range("corner_m", at, -1e7, 1e7, "-1e7 to 1e7 m")?;
        }
        in_range("cell_m", self.cell_m, 0.01, 100.0, "0.01 to 100 m")?;
        in_range("base_m", self.base_m, -1e7, 1e7, "-1e7 to 1e7 m")?;
        for cells in self.cells {
            in_range("cells", f64::from(cells), 1.0, 65_536.0, "1 to 65536")?;
        }
        let number = f64::from(self.cells[0]) * f64::from(self.cells[1]);
        in_range("number of cells", number, 1.0, f64::from(1 << 24), "1 to 16777216")?;
        for rules in &self.rules {
            in_range(
                "capacity_mm",
                f64::from(rules.capacity_mm),
                1e-6,
                1e3,
                "1e-6 to 1000 mm",
            )?;
            in_range("texture_mm", f64::from(rules.texture_mm), 0.0, 1e3, "0 to 1000 mm")?;
            for value in [rules.drain, rules.soil_mm_s, rules.dry_soil_mm_s, rules.recovery_per_s] {
                in_range("rules", f64::from(value), 0.0, 1e6, "0 to 1e6")?;
            }
            in_range(
                "soil_decay_per_s",
                f64::from(rules.soil_decay_per_s),
                1e-10,
                1.0,
                "1e-10 to 1 per s",
            )?;
        }
        Ok(())
    }
}

/// A cell of the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundCell {
    /// Height over the base; NaN: a hole. Units: m.
    pub height_m: f32,
    /// Class, as [`SurfaceClass::index`].
    pub class: u8,
    /// Share of the rain that reaches it, in 255ths, where the map of what covers does not reach.
    pub exposure: u8,
}

impl GroundCell {
    /// As the pass reads it.
    pub(super) fn packed(self) -> [u32; 2] {
        let height = if self.height_m.is_finite() { self.height_m } else { -1e9 };
        [height.to_bits(), u32::from(self.class) | u32::from(self.exposure) << 8]
    }
}
