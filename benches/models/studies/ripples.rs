//! Work against precision: the tile of rain's rings by its cells, size and smallest drop, against Campbell's theorem.

use rain_bench::study::{Study, Variant};
use rain_core::rainfall::{Distribution, Spectrum, terminal_velocity};
use rain_core::waves::{DropImpact, WaveField, WaveSettings, impact_slope_variance, slope_variance};
use rain_render::waves::{RippleSettings, RippleTile};
use rayon::prelude::*;

/// Every study of this file.
pub fn studies() -> Vec<Study> {
    vec![tile_sizes(), cells(), drops()]
}

/// Seconds until the rings of the start have faded, and those that are looked at.
const FILL_S: u32 = 6;
const LOOK_S: u32 = 12;

fn spectrum(intensity_mm_h: f64) -> Spectrum {
    Spectrum::new(Distribution::MarshallPalmer, intensity_mm_h).expect("valid")
}

/// The default and others, each once.
fn with_default(others: impl IntoIterator<Item = RippleSettings>) -> Vec<RippleSettings> {
    let default = RippleSettings::default();
    let others = others.into_iter().filter(|other| *other != default);
    std::iter::once(default).chain(others).collect()
}

fn sized(cells: u32, side_m: f64) -> RippleSettings {
    RippleSettings {
        cells,
        side_m,
        ..RippleSettings::default()
    }
}

/// The tile's water on the CPU, with the decay of all heights as the damping that fades alike.
struct Water {
    tile: RippleTile,
    field: WaveField,
    step: u32,
    steps_in_tick: u32,
}

impl Water {
    fn new(settings: &RippleSettings) -> Self {
        let mut tile = RippleTile::new(settings).expect("valid");
        tile.set_rain(&spectrum(25.0).into());
        let twin = WaveSettings {
            damping_per_s: 2.0 * settings.decay_per_s,
            ..settings.twin()
        };
        Self {
            steps_in_tick: (settings.tick_ns / tile.step_ns()) as u32,
            field: WaveField::new(&twin).expect("within the bound"),
            tile,
            step: 0,
        }
    }

    fn tick(&mut self) {
        for _ in 0..self.steps_in_tick {
            let field = &mut self.field;
            self.tile.for_each_drop(self.step, |drop| {
                field.add_drop(&drop).expect("a drop of the rain");
            });
            self.field.step(1);
            self.step += 1;
        }
    }

    /// Mean square of the slopes, by differences of fourth order.
    fn variance(&self) -> f64 {
        let (n, cell_m) = (self.field.settings().cells_x as usize, self.field.settings().cell_m);
        let u = self.field.heights();
        let mut sum = 0.0;
        for j in 0..n {
            for i in 0..n {
                let along = |k: usize| f64::from(u[j * n + (i + k) % n]);
                let across = |k: usize| f64::from(u[(j + k) % n * n + i]);
                let slope =
                    |at: &dyn Fn(usize) -> f64| (8.0 * (at(1) - at(n - 1)) - (at(2) - at(n - 2))) / (12.0 * cell_m);
                sum += slope(&along).powi(2) + slope(&across).powi(2);
            }
        }
        sum / (n * n) as f64
    }
}

/// Mean over time of the variance of the slopes under 25 mm/h, and its standard deviation.
fn roughness(settings: &RippleSettings) -> [f64; 2] {
    let mut water = Water::new(settings);
    let mut seen = Vec::new();
    for second in 0..FILL_S + LOOK_S {
        for tick in 0..60 {
            water.tick();
            if second >= FILL_S && tick % 15 == 14 {
                seen.push(water.variance());
            }
        }
    }
    let count = seen.len() as f64;
    let mean = seen.iter().sum::<f64>() / count;
    let squares: f64 = seen.iter().map(|v| (v - mean) * (v - mean)).sum();
    [mean, (squares / count).sqrt()]
}

/// A variant that runs `ticks` ticks of a tile under 25 mm/h.
fn variant(settings: &RippleSettings, name: String, error: f64, ticks: u32, evaluations: u64) -> Variant {
    let mut water = Water::new(settings);
    for _ in 0..60 {
        water.tick();
    }
    let variant = Variant::new(name, error, evaluations, move || {
        for _ in 0..ticks {
            water.tick();
        }
        f64::from(water.field.heights()[0])
    });
    if *settings == RippleSettings::default() {
        variant.default()
    } else {
        variant
    }
}

fn size_and_cell(settings: &RippleSettings) -> String {
    let cell_mm = 1e3 * settings.cell_m();
    format!("{} m, {}² cells of {cell_mm:.1} mm", settings.side_m, settings.cells)
}

fn tile_sizes() -> Study {
    let cell_m = RippleSettings::default().cell_m();
    let tiles = with_default([64, 128, 256, 512].map(|cells| sized(cells, f64::from(cells) * cell_m)));
    let seen: Vec<[f64; 2]> = tiles.par_iter().map(roughness).collect();
    let variants = tiles
        .iter()
        .zip(seen)
        .map(|(tile, [mean, deviation])| variant(tile, size_and_cell(tile), deviation / mean, 1, 1));
    Study {
        name: "ripple-tile",
        title: "Unsteadiness of rain's rings, by size of the tile",
        norm: "standard deviation over time of the slopes' variance, share",
        unit: "1/60 s of a tile on the CPU",
        variants: variants.collect(),
    }
}

/// Ticks of a timed run: of a tile of half a metre they make a square metre.
const RUN_TICKS: u32 = 4;

fn cells() -> Study {
    let default = RippleSettings::default();
    let tiles = with_default([
        sized(64, 1.0),
        sized(128, 1.0),
        sized(256, 1.0),
        sized(512, 1.0),
        sized(256, 2.0),
        sized(256, 0.5),
    ]);
    let whole = slope_variance(&spectrum(25.0), default.depth_m, 2.0 * default.decay_per_s, 0.0);
    let seen: Vec<[f64; 2]> = tiles.par_iter().map(roughness).collect();
    let variants = tiles.iter().zip(seen).map(|(tile, [mean, _])| {
        let square_metres = (f64::from(RUN_TICKS) * tile.side_m * tile.side_m).round() as u64;
        let error = 1.0 - (mean / whole).sqrt();
        variant(tile, size_and_cell(tile), error, RUN_TICKS, square_metres)
    });
    Study {
        name: "ripple-cells",
        title: "Slopes under 25 mm/h that a tile of rings does not show",
        norm: "1 - rms slope over that of Campbell's theorem, no cells",
        unit: "1/60 s of a square metre on the CPU",
        variants: variants.collect(),
    }
}

/// Variance of the slopes that drops from `least_mm` on make on the default's cells, by Campbell's theorem.
fn variance_from(rain: &Spectrum, least_mm: f64) -> f64 {
    const PANELS: u32 = 400;
    let settings = RippleSettings::default();
    let step = (8.0 - least_mm) / f64::from(PANELS);
    (0..PANELS)
        .map(|panel| {
            let diameter_mm = least_mm + (f64::from(panel) + 0.5) * step;
            let impact = DropImpact {
                x_m: 0.0,
                z_m: 0.0,
                diameter_mm,
                speed_m_s: terminal_velocity(diameter_mm),
            };
            let width_m = impact.width_m(settings.cell_m(), settings.depth_m);
            let damping = 2.0 * settings.decay_per_s;
            rain.concentration(diameter_mm)
                * impact.speed_m_s
                * step
                * impact_slope_variance(&impact, width_m, settings.depth_m, damping)
        })
        .sum()
}

fn drops() -> Study {
    let default = RippleSettings::default();
    let least = [0.2, 0.5, 1.0, 1.5, 2.0, 3.0].map(|least_drop_mm| RippleSettings {
        least_drop_mm,
        ..default
    });
    let variants = with_default(least).into_iter().map(|tile| {
        let missing = |intensity_mm_h: f64| {
            let rain = spectrum(intensity_mm_h);
            1.0 - (variance_from(&rain, tile.least_drop_mm) / variance_from(&rain, 0.0)).sqrt()
        };
        let error = [1.0, 5.0, 25.0, 100.0].map(missing).into_iter().fold(0.0, f64::max);
        variant(&tile, format!("from {} mm", tile.least_drop_mm), error, 1, 1)
    });
    Study {
        name: "ripple-drops",
        title: "Rain's rings without the smallest drops, 1 to 100 mm/h",
        norm: "largest missing share of the rms slope",
        unit: "1/60 s of a tile under 25 mm/h on the CPU",
        variants: variants.collect(),
    }
}
