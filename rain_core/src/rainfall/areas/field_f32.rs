//! The areas around a place in single precision, packed in rows of four as a shader reads them.

use glam::DVec2;

use super::density::{density_at_f32, density_rows};
use super::ellipse::ellipse_distance_f32;
use super::field::{AreaField, PlacedArea, border_weight_f32};
use super::polygon::polygon_distance_f32;
use super::settings::AreaRain;
use super::shape::{MAX_CORNERS, Outline};
use crate::error::clamped_f32;
use crate::rainfall::spectrum::MAX_INTENSITY_MM_H;

/// Most rows: 32 KiB.
pub const MAX_PACKED_ROWS: usize = 2048;
/// Most areas: three rows each, and one for two corners of a polygon.
pub const MAX_PACKED_AREAS: usize = MAX_PACKED_ROWS / 3;

/// What a kind of outline is more where a density is painted.
const PAINTED: f64 = 4.0;

/// Rates held in [0, 500] mm/h.
const MOST: f32 = MAX_INTENSITY_MM_H as f32;

/// [`AreaField`] around a place in single precision.
///
/// Each area has three rows: centre (x, z) and the first axis (cosine, sine); radii, transition, kind of outline (0
/// unbounded, 1 ellipse, 2 polygon); kind of rain (0 rate, 1 of the weather, 2 scale), its value, strength, corners. The
/// corners of a polygon follow, two a row. The kind of outline is 4 more where a density is painted, whose rows come last: half
/// its size and its cells; then twelve values a row, three a number.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AreaFieldF32 {
    /// Units: m and mm/h. Places are relative to the origin that was given.
    pub rows: Vec<[f32; 4]>,
    /// How many areas.
    pub areas: u32,
    /// Share of the weather's rain that falls where no area is.
    pub outside: f32,
}

impl AreaField {
    /// Writes the areas that matter within `reach_m` of an origin (x, z). `false`: there were more than the rows hold, and
    /// the last are left out. The memory of `into` is used again.
    ///
    /// Error: that of [`AreaFieldF32::rate_at`].
    pub fn pack(&self, origin_m: DVec2, reach_m: f64, into: &mut AreaFieldF32) -> bool {
        into.rows.clear();
        into.areas = 0;
        into.outside = self.outside() as f32;
        for area in self.areas() {
            if area.distance_m(origin_m) - reach_m > 0.5 * area.transition_m {
                continue;
            }
            let corners = match &area.outline {
                Outline::Polygon(corners) => corners.as_slice(),
                _ => &[],
            };
            let painted = area.density.as_ref().map_or(0, |map| density_rows(map.values().len()));
            if into.rows.len() + 3 + corners.len().div_ceil(2) + painted > MAX_PACKED_ROWS {
                return false;
            }
            into.rows.extend(head(area, origin_m, corners.len()));
            for pair in corners.chunks(2) {
                let second = pair.get(1).copied().unwrap_or_default();
                into.rows
                    .push([pair[0].x, pair[0].y, second.x, second.y].map(|v| v as f32));
            }
            into.rows.extend(area.density.iter().flat_map(|map| map.rows()));
            into.areas += 1;
        }
        true
    }
}

fn head(area: &PlacedArea, origin_m: DVec2, corners: usize) -> [[f32; 4]; 3] {
    let centre = area.centre_m - origin_m;
    let (radii, axis, kind) = match &area.outline {
        Outline::Unbounded => (DVec2::ONE, DVec2::X, 0.0),
        Outline::Circle(radius) => (DVec2::splat(*radius), DVec2::X, 1.0),
        Outline::Ellipse(radii, axis) => (*radii, *axis, 1.0),
        Outline::Polygon(_) => (DVec2::ONE, DVec2::X, 2.0),
    };
    let painted = if area.density.is_some() { PAINTED } else { 0.0 };
    let (rain, value) = match area.rain {
        AreaRain::Rate(rate) => (0.0, rate),
        AreaRain::OfWeather(share) => (1.0, share),
        AreaRain::Scale(scale) => (2.0, scale),
    };
    [
        [centre.x, centre.y, axis.x, axis.y],
        [radii.x, radii.y, area.transition_m, kind + painted],
        [rain, value, area.strength, corners as f64],
    ]
    .map(|row| row.map(|v| v as f32))
}

impl AreaFieldF32 {
    /// Rain rate at a place (x, z) relative to the origin, under the weather's rate. Units: mm/h. In [0, 500]. Clamps as
    /// [`AreaField::rate_at`]; broken rows end the list. Allocates nothing.
    ///
    /// Error: 2e-6 of the largest authored rate, and of it times distance (of the place, and to the corners or radii) over
    /// transition.
    #[must_use]
    pub fn rate_at(&self, place_m: [f32; 2], weather_mm_h: f32) -> f32 {
        if place_m[0].is_nan() || place_m[1].is_nan() {
            return 0.0;
        }
        let weather = clamped_f32(weather_mm_h, 0.0, MOST);
        let (mut rate, mut factor) = (self.outside * weather, 1.0);
        let mut at = 0;
        for _ in 0..self.areas {
            let Some([place, outline, rain]) = self
                .rows
                .get(at..at + 3)
                .and_then(|rows| <&[_; 3]>::try_from(rows).ok())
            else {
                break;
            };
            let corners = (rain[3] as usize).min(MAX_CORNERS);
            let rows = self.rows.get(at + 3..at + 3 + corners.div_ceil(2)).unwrap_or_default();
            at += 3 + corners.div_ceil(2);
            let kind = outline[3] as u32;
            let painted = if kind >= PAINTED as u32 {
                let sides = self.rows.get(at).map_or([0.0; 2], |head| [head[2], head[3]]);
                let count = density_rows((sides[0] as usize).saturating_mul(sides[1] as usize));
                let rows = self.rows.get(at..at.saturating_add(count)).unwrap_or_default();
                at = at.saturating_add(count);
                Some(rows)
            } else {
                None
            };
            let (x, z) = (place_m[0] - place[0], place_m[1] - place[1]);
            let distance = match kind % PAINTED as u32 {
                0 => f32::MIN,
                1 => ellipse_distance_f32(
                    [place[2] * x + place[3] * z, place[2] * z - place[3] * x],
                    [outline[0], outline[1]],
                ),
                _ => {
                    let mut points = [[0.0; 2]; MAX_CORNERS];
                    for (two, row) in points.chunks_mut(2).zip(rows) {
                        two[0] = [row[0], row[1]];
                        two[1] = [row[2], row[3]];
                    }
                    polygon_distance_f32([x, z], &points[..corners])
                }
            };
            let painted = painted.map_or(1.0, |rows| density_at_f32(rows, [x, z]));
            let weight = rain[2] * border_weight_f32(distance, outline[2]) * painted;
            match rain[0] as u32 {
                0 => rate = f32::max(rate, weight * rain[1]),
                1 => rate = f32::max(rate, weight * rain[1] * weather),
                _ => factor *= 1.0 - weight * (1.0 - rain[1]),
            }
        }
        clamped_f32(rate * factor, 0.0, MOST)
    }
}
