//! The rain of a view from above, for people: single drops near the eye, and the areas with their far rain.
//!
//! The eye stands at the bottom, in the middle, and looks up the picture. Left: 20 m of single drops, from blue at the eye to
//! red; the larger the drop, the larger the dot. Right: rates of the areas in blue, the containers of far rain as boxes, its
//! particles in red, each as wide as it is, at least a pixel.

use bevy::math::DVec2;
use bevy::prelude::*;
use image::{Rgb, RgbImage};
use rain_core::rainfall::areas::{AreaField, FarFit};
use rain_ecs::prelude::RainAreas;

use crate::haze::FarRainViewFrame;
use crate::rainfall::RainViewFrame;

/// Height of the left panel's ground. Units: m.
const NEAR_M: f64 = 20.0;
/// Least height of the right panel's ground. Units: m.
const LEAST_FAR_M: f64 = 200.0;
/// Side of a panel. Units: px.
pub const PANEL_PX: u32 = 512;

/// A rate that is shown in full blue. Units: mm/h.
const FULL_MM_H: f64 = 60.0;

const PAPER: Rgb<u8> = Rgb([246, 247, 249]);
const BOX: Rgb<u8> = Rgb([45, 52, 61]);
const FAR: Rgb<u8> = Rgb([205, 40, 35]);

/// What is drawn.
#[derive(Debug, Clone, Default)]
pub struct Above {
    /// The eye on the ground (x, z). Units: m.
    pub eye_m: DVec2,
    /// Where it looks (x, z); its length does not count.
    pub ahead: DVec2,
    /// Single drops: place from the eye (x, z; m), size from 0 to 1.
    pub drops: Vec<(DVec2, f64)>,
    /// Particles of far rain: place from the eye (x, z; m), width (m).
    pub far: Vec<(DVec2, f64)>,
    /// Containers of far rain.
    pub containers: Vec<FarFit>,
    /// The areas.
    pub areas: AreaField,
    /// The weather's rate. Units: mm/h.
    pub weather_mm_h: f64,
}

impl Above {
    /// What a view draws in its latest frame.
    #[must_use]
    pub fn of(world: &World, camera: Entity) -> Option<Self> {
        let transform = world.get::<GlobalTransform>(camera)?;
        let flat = |v: Vec3| DVec2::new(v.x.into(), v.z.into());
        let mut above = Self {
            eye_m: flat(transform.translation()),
            ahead: flat(transform.forward().into()),
            ..Self::default()
        };
        if let Some(frame) = world.get::<RainViewFrame>(camera).filter(|frame| frame.draws()) {
            let drops = frame.drops();
            let seed = frame.choice.as_ref().map_or(0, |choice| choice.seed);
            let last = (drops.classes.len().max(2) - 1) as f64;
            above.drops = drops
                .records
                .iter()
                .map(|record| {
                    let class = f64::from(record.drop & 15);
                    (flat(record.position(seed, &drops.classes)), class / last)
                })
                .collect();
        }
        if let Some(rain) = world.get::<FarRainViewFrame>(camera).and_then(FarRainViewFrame::rain) {
            above.containers.clone_from(&rain.containers);
            above.far = rain
                .particles
                .iter()
                .map(|p| (flat(Vec3::from(p.centre)), 2.0 * f64::from(p.half_width)))
                .collect();
        }
        if let Some(areas) = world.get_resource::<RainAreas>() {
            above.areas = areas.field().clone();
            above.weather_mm_h = areas.weather_mm_h();
        }
        Some(above)
    }

    /// Height of the right panel's ground. Units: m.
    fn reach_m(&self) -> f64 {
        let furthest = |fit: &FarFit| fit.distance_m + fit.depth_m;
        self.containers.iter().map(furthest).fold(LEAST_FAR_M, f64::max) * 1.05
    }

    /// Both panels, side by side.
    #[must_use]
    pub fn picture(&self) -> RgbImage {
        let mut picture = RgbImage::from_pixel(2 * PANEL_PX, PANEL_PX, PAPER);
        let ahead = self.ahead.try_normalize().unwrap_or(DVec2::NEG_Y);
        for (place, size) in &self.drops {
            let share = (place.length() / NEAR_M).min(1.0);
            let mix = |a: f64, b: f64| (a + (b - a) * share) as u8;
            let colour = Rgb([mix(30.0, 215.0), mix(80.0, 45.0), mix(200.0, 30.0)]);
            dot(
                &mut picture,
                0,
                in_panel(*place, ahead, NEAR_M),
                0.5 + 1.5 * size,
                colour,
            );
        }
        let reach = self.reach_m();
        for y in 0..PANEL_PX {
            for x in 0..PANEL_PX {
                let local = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) / f64::from(PANEL_PX);
                let place = (ahead * (1.0 - local.y) + ahead.perp() * (local.x - 0.5)) * reach;
                let rate = self.areas.rate_at(self.eye_m + place, self.weather_mm_h);
                let share = (rate / FULL_MM_H).min(1.0);
                let mix = |from: u8, to: f64| (f64::from(from) + (to - f64::from(from)) * share) as u8;
                let colour = Rgb([mix(PAPER.0[0], 60.0), mix(PAPER.0[1], 120.0), mix(PAPER.0[2], 205.0)]);
                picture.put_pixel(PANEL_PX + x, y, colour);
            }
        }
        for (place, width) in &self.far {
            let radius = 0.5 * width / reach * f64::from(PANEL_PX);
            dot(
                &mut picture,
                PANEL_PX,
                in_panel(*place, ahead, reach),
                radius.max(0.5),
                FAR,
            );
        }
        for fit in &self.containers {
            let corner = |depth: f64, across: f64| {
                let place = fit.anchor_m + fit.towards * depth + fit.towards.perp() * across - self.eye_m;
                in_panel(place, ahead, reach)
            };
            let [left, right] = fit.across_m;
            let corners = [
                corner(-fit.front_m, left),
                corner(-fit.front_m, right),
                corner(fit.depth_m, right),
                corner(fit.depth_m, left),
            ];
            for (i, from) in corners.iter().enumerate() {
                let to = corners[(i + 1) % 4];
                let steps = (to - *from).length().ceil().clamp(1.0, 4096.0);
                for k in 0..=steps as u32 {
                    let at = *from + (to - *from) * (f64::from(k) / steps);
                    dot(&mut picture, PANEL_PX, at, 0.5, BOX);
                }
            }
        }
        picture
    }
}

/// A place from the eye in a panel whose height is `reach_m` of ground. Units: px.
fn in_panel(place: DVec2, ahead: DVec2, reach_m: f64) -> DVec2 {
    let (across, along) = (ahead.perp().dot(place), ahead.dot(place));
    DVec2::new(0.5 + across / reach_m, 1.0 - along / reach_m) * f64::from(PANEL_PX)
}

/// A dot in the panel that begins at column `left`; what is beside the panel is left out.
fn dot(picture: &mut RgbImage, left: u32, at: DVec2, radius: f64, colour: Rgb<u8>) {
    let side = f64::from(PANEL_PX);
    let (low, high) = (at - radius, at + radius);
    if !(low.is_finite() && high.is_finite()) {
        return;
    }
    let range = |low: f64, high: f64| (low.floor().clamp(0.0, side) as u32)..(high.ceil().clamp(0.0, side) as u32);
    for y in range(low.y, high.y) {
        for x in range(low.x, high.x) {
            let off = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) - at;
            if off.length() <= radius.max(0.71) {
                picture.put_pixel(left + x, y, colour);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drops_turn_from_blue_to_red_and_far_rain_is_red_in_its_box() {
        let fit = FarFit {
            anchor_m: DVec2::new(100.0, 500.0),
            towards: DVec2::X,
            distance_m: 100.0,
            bearings_rad: [-0.3, 0.3],
            across_m: [-60.0, 60.0],
            front_m: 0.0,
            depth_m: 300.0,
            seen: rain_core::rainfall::areas::Seen::Whole,
        };
        let above = Above {
            eye_m: DVec2::new(0.0, 500.0),
            ahead: DVec2::X,
            drops: vec![
                (DVec2::new(1.0, 0.0), 1.0),
                (DVec2::new(19.0, 0.0), 1.0),
                (DVec2::splat(-5.0), 1.0),
            ],
            far: vec![(DVec2::new(250.0, 0.0), 8.0), (DVec2::new(f64::NAN, 0.0), 8.0)],
            containers: vec![fit],
            areas: AreaField::new(0.0),
            weather_mm_h: 0.0,
        };
        let picture = above.picture();
        let half = PANEL_PX / 2;
        let at = |left: u32, metres: f64, reach: f64| {
            let y = ((1.0 - metres / reach) * f64::from(PANEL_PX)) as u32;
            picture.get_pixel(left + half, y).0
        };
        let (near, away) = (at(0, 1.0, NEAR_M), at(0, 19.0, NEAR_M));
        assert!(near[2] > 180 && away[0] > 180 && away[2] < 60, "{near:?} {away:?}");
        let reach = above.reach_m();
        assert!((reach - 420.0).abs() < 1e-9, "{reach}");
        assert_eq!(at(PANEL_PX, 250.0, reach), FAR.0);
        assert_eq!(at(PANEL_PX, 100.0, reach), BOX.0);
        assert_eq!(at(PANEL_PX, 50.0, reach), PAPER.0);
        // Behind the eye is not on the paper.
        let red = picture.pixels().filter(|p| p.0[0] > 180 && p.0[2] < 60).count();
        assert!(red < 120, "{red}");
        assert_eq!(Above::default().picture().dimensions(), (2 * PANEL_PX, PANEL_PX));
    }
}
