//! How much of the rain of several winds reaches a place on a surface: what a mask that is painted once has to hold for.

use glam::{DVec2, DVec3};

use super::error::CoverError;
use super::projection::FallSlope;
use super::scene::CoverScene;
use crate::error::in_range;
use crate::ops;

/// A face turned away from the rain by this cosine and more catches none.
const LEAST_FACING: f64 = 0.02;
/// Most winds.
const MOST: u32 = 64;
/// How far off an upright face the map is asked: its own top covers what is nearer. Units: cells.
const OFF_WALL_CELLS: f64 = 1.5;

/// The cover of a scene in calm and in one wind from all around.
#[derive(Debug, Clone)]
pub struct RainDirections {
    /// Each with the unit vector towards the rain.
    scenes: Vec<(CoverScene, DVec3)>,
}

impl RainDirections {
    /// Maps of the same scene: one of calm air and one for each of `azimuths` winds of `wind_m_s`, evenly around.
    /// `wind_m_s` domain: [0, 50]; `azimuths`: [0, 64]. Draws each map: some 10 ms for a street.
    ///
    /// # Errors
    /// When a number is outside its domain, or the slanted scene would need more tiles than allowed.
    pub fn new(scene: &CoverScene, wind_m_s: f64, azimuths: u32) -> Result<Self, CoverError> {
        in_range("wind_m_s", wind_m_s, 0.0, 50.0, "0 to 50 m/s")?;
        in_range("azimuths", f64::from(azimuths), 0.0, f64::from(MOST), "0 to 64")?;
        let inverse = scene.slope().mean_inverse_speed_s_per_m();
        let winds = (0..azimuths).map(|i| {
            let angle = core::f64::consts::TAU * f64::from(i) / f64::from(azimuths);
            wind_m_s * DVec2::new(ops::cos(angle), ops::sin(angle))
        });
        let mut scenes = Vec::new();
        for wind in std::iter::once(DVec2::ZERO).chain(winds) {
            let slope = FallSlope::new(wind, inverse)?;
            let mut turned = scene.clone();
            turned.set_slope(slope)?;
            turned.update();
            let drift = slope.drift();
            scenes.push((turned, DVec3::new(-drift.x, 1.0, -drift.y).normalize()));
        }
        Ok(Self { scenes })
    }

    /// Of the directions that a face looks towards, the share from which rain reaches it: 1 in the open, 0 under cover
    /// or facing down, between near the edge of a cover. `normal` is a unit vector. What is not finite is open to none.
    #[must_use]
    pub fn open_share(&self, place: DVec3, normal: DVec3) -> f64 {
        let (mut towards, mut open) = (0.0, 0.0);
        for (scene, to_rain) in &self.scenes {
            if normal.dot(*to_rain).is_nan() || normal.dot(*to_rain) < LEAST_FACING {
                continue;
            }
            towards += 1.0;
            let off = OFF_WALL_CELLS * scene.settings().cell_m * normal.with_y(0.0);
            let inverse = scene.slope().mean_inverse_speed_s_per_m();
            open += scene.exposure(place + off, inverse).map_or(0.0, f64::from);
        }
        if towards > 0.0 { open / towards } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cover::{CoverSettings, OccluderId};

    fn quad(low: [f64; 2], high: [f64; 2], y: f64) -> [[DVec3; 3]; 2] {
        let p = |x: f64, z: f64| DVec3::new(x, y, z);
        let [a, b] = [p(low[0], low[1]), p(high[0], low[1])];
        let [c, d] = [p(high[0], high[1]), p(low[0], high[1])];
        [[a, d, c], [a, c, b]]
    }

    /// Ground with a roof 3 m above −5 < x, z < 5.
    fn shelter() -> CoverScene {
        let slope = FallSlope::new(DVec2::ZERO, 0.169).expect("valid");
        let mut scene = CoverScene::new(CoverSettings::default(), slope).expect("valid");
        let ground = quad([-30.0; 2], [30.0; 2], 0.0);
        let roof = quad([-5.0; 2], [5.0; 2], 3.0);
        scene.add(OccluderId(1), &ground).expect("fits");
        scene.add(OccluderId(2), &roof).expect("fits");
        scene.update();
        scene
    }

    #[test]
    fn what_lies_under_something_is_open_to_none_and_its_edge_to_some() {
        // 5 m/s over 3 m at 0.169 s/m: 2.5 m.
        let directions = RainDirections::new(&shelter(), 5.0, 8).expect("valid");
        let up = |x: f64| directions.open_share(DVec3::new(x, 0.0, 0.0), DVec3::Y);
        assert_eq!((up(0.0), up(2.0)), (0.0, 0.0));
        assert_eq!(up(12.0), 1.0);
        let (inside, outside) = (up(4.0), up(6.0));
        assert!(inside > 0.05 && inside < 0.5, "{inside}");
        assert!(outside > 0.5 && outside < 0.95, "{outside}");
        let calm = RainDirections::new(&shelter(), 5.0, 0).expect("valid");
        let at = |x: f64| calm.open_share(DVec3::new(x, 0.0, 0.0), DVec3::Y);
        assert_eq!((at(4.0), at(6.0)), (0.0, 1.0));
    }

    #[test]
    fn a_wall_is_open_to_the_winds_it_faces_and_a_ceiling_to_none() {
        let directions = RainDirections::new(&shelter(), 5.0, 8).expect("valid");
        let far = DVec3::new(20.0, 1.0, 0.0);
        assert_eq!(directions.open_share(far, DVec3::X), 1.0);
        assert_eq!(directions.open_share(far, DVec3::NEG_Y), 0.0);
        assert_eq!(directions.open_share(DVec3::new(0.0, 1.0, 0.0), DVec3::X), 0.0);
        let calm = RainDirections::new(&shelter(), 0.0, 0).expect("valid");
        assert_eq!(calm.open_share(far, DVec3::X), 0.0, "rain runs along it");
        for bad in [DVec3::NAN, DVec3::INFINITY, DVec3::new(0.0, f64::NAN, 0.0)] {
            assert_eq!(directions.open_share(bad, DVec3::Y), 0.0);
            assert_eq!(directions.open_share(far, bad.min(DVec3::NAN)), 0.0);
        }
        for (wind, count) in [(f64::NAN, 8), (-1.0, 8), (51.0, 8), (5.0, 65)] {
            assert!(RainDirections::new(&shelter(), wind, count).is_err(), "{wind} {count}");
        }
    }
}
