//! The rain from above, as data for a plot: a grid of rates and the outlines of the areas.

use glam::DVec2;

use super::field::{AreaField, PlacedArea};
use super::shape::Outline;
use crate::error::ConfigError;
use crate::ops;

/// Most cells of a map.
pub const MAX_MAP_CELLS: usize = 1 << 22;

/// Rain rates over a rectangle of ground.
#[derive(Debug, Clone, PartialEq)]
pub struct AreaMap {
    /// Least corner (x, z). Units: m.
    pub low_m: DVec2,
    /// Greatest corner. Units: m.
    pub high_m: DVec2,
    /// Cells along x and z.
    pub cells: [usize; 2],
    /// Rates in the middle of the cells, row by row (row = z). Units: mm/h.
    pub rates_mm_h: Vec<f32>,
}

impl AreaField {
    /// The map of a rectangle from `low_m` to `high_m` (x, z; finite, the second greater) in so many cells along x and z.
    ///
    /// Error: that of [`AreaField::rate_at`], in single precision.
    ///
    /// # Errors
    /// When the rectangle has no area, or there are no cells or more than 2²².
    pub fn map(
        &self,
        low_m: DVec2,
        high_m: DVec2,
        cells: [usize; 2],
        weather_mm_h: f64,
    ) -> Result<AreaMap, ConfigError> {
        let size = high_m - low_m;
        for value in size.to_array() {
            if !(value.is_finite() && value > 0.0) {
                return Err(ConfigError::OutOfRange {
                    field: "size of the map",
                    value,
                    allowed: "above 0 m",
                });
            }
        }
        let count = cells[0].saturating_mul(cells[1]);
        if count == 0 || count > MAX_MAP_CELLS {
            return Err(ConfigError::OutOfRange {
                field: "cells of the map",
                value: count as f64,
                allowed: "1 to 4194304",
            });
        }
        let step = size / DVec2::new(cells[0] as f64, cells[1] as f64);
        let rates_mm_h = (0..count)
            .map(|i| {
                let at = DVec2::new((i % cells[0]) as f64 + 0.5, (i / cells[0]) as f64 + 0.5);
                self.rate_at(low_m + at * step, weather_mm_h) as f32
            })
            .collect();
        Ok(AreaMap {
            low_m,
            high_m,
            cells,
            rates_mm_h,
        })
    }
}

impl PlacedArea {
    /// The outline as a closed line of points (world x, z), `points` of them (3 at least) for a round one; none where it is
    /// unbounded. Units: m.
    ///
    /// Error: 1e-9 of the radii: on the outline.
    #[must_use]
    pub fn outline_m(&self, points: usize) -> Vec<DVec2> {
        let points = points.clamp(3, 100_000);
        let round = |radii: DVec2, axis: DVec2| {
            (0..points)
                .map(|i| {
                    let angle = i as f64 / points as f64 * 2.0 * core::f64::consts::PI;
                    self.centre_m + axis.rotate(radii * DVec2::new(ops::cos(angle), ops::sin(angle)))
                })
                .collect()
        };
        match &self.outline {
            Outline::Unbounded => Vec::new(),
            Outline::Circle(radius) => round(DVec2::splat(*radius), DVec2::X),
            Outline::Ellipse(radii, axis) => round(*radii, *axis),
            Outline::Polygon(corners) => corners.iter().map(|corner| self.centre_m + *corner).collect(),
        }
    }
}
