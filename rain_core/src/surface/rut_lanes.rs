//! Wheel ruts on a flat road, for maps that place puddles: lanes side by side, each with two tracks that wheels have worn.
//! Puddles gather in real ruts and stretch along them (Nguyenova 2021); road tiles that are flat have none to follow.

use crate::error::{ConfigError, clamped, in_range};
use crate::ops;

/// Straight lanes side by side. Units: m, rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RutLanes {
    /// Where the lanes lead, from the world's z towards its x. Units: rad. Domain: [−10, 10].
    pub direction_rad: f64,
    /// Width of a lane. Units: m. Domain: [0.1, 1000].
    pub lane_m: f64,
    /// Middle of a lane: distance from the world's origin across the lanes (along x where they lead along z). Units: m.
    /// Domain: [−1e6, 1e6].
    pub offset_m: f64,
    /// Distance of a lane's two ruts. Units: m. Domain: [0, 1000].
    pub track_m: f64,
    /// Standard deviation of a rut's bell-shaped cross section. Units: m. Domain: [0.01, 100].
    pub half_width_m: f64,
    /// How far the ground between the ruts stands above their bottoms, as a share of the map. Domain: [0, 1].
    pub depth: f64,
}

impl RutLanes {
    /// These lanes, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not finite or outside its domain.
    pub fn validated(self) -> Result<Self, ConfigError> {
        in_range("direction_rad", self.direction_rad, -10.0, 10.0, "-10 to 10")?;
        in_range("lane_m", self.lane_m, 0.1, 1e3, "0.1 to 1000 m")?;
        in_range("offset_m", self.offset_m, -1e6, 1e6, "-1e6 to 1e6 m")?;
        in_range("track_m", self.track_m, 0.0, 1e3, "0 to 1000 m")?;
        in_range("half_width_m", self.half_width_m, 0.01, 100.0, "0.01 to 100 m")?;
        in_range("depth", self.depth, 0.0, 1.0, "0 to 1")?;
        Ok(self)
    }

    /// A world place (x, z) across and along the lanes. Units: m. A rotation about the origin.
    /// Error: 1e-12 relative.
    #[must_use]
    pub fn across_and_along(&self, x_m: f64, z_m: f64) -> [f64; 2] {
        let (sin, cos) = (ops::sin(self.direction_rad), ops::cos(self.direction_rad));
        [cos * x_m - sin * z_m, sin * x_m + cos * z_m]
    }

    /// Height of the ground over the bottoms of the ruts, as a share of the map: `depth`·(1 − e^(−d²/2)), d the distance
    /// to the nearer rut of the lane in standard deviations. `across_m` as from [`RutLanes::across_and_along`]; what is
    /// not finite lies between ruts. In [0, `depth`].
    /// Error: 1e-12; a look.
    #[must_use]
    pub fn height(&self, across_m: f64) -> f64 {
        let depth = clamped(self.depth, 0.0, 1.0);
        let lane = clamped(self.lane_m, 0.1, 1e3);
        let from = across_m - self.offset_m;
        let within = from - lane * (from / lane).round();
        let d = (within.abs() - 0.5 * self.track_m) / clamped(self.half_width_m, 0.01, 100.0);
        if d.is_finite() {
            depth * (1.0 - ops::exp(-0.5 * d * d))
        } else {
            depth
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROAD: RutLanes = RutLanes {
        direction_rad: 0.5,
        lane_m: 3.5,
        offset_m: 1.75,
        track_m: 1.5,
        half_width_m: 0.25,
        depth: 0.6,
    };

    #[test]
    fn ruts_lie_half_a_track_from_the_middle_of_each_lane() {
        for lane in [-3.0, 0.0, 1.0, 40.0] {
            let middle = 1.75 + 3.5 * lane;
            for rut in [middle - 0.75, middle + 0.75] {
                assert!(ROAD.height(rut) < 1e-12, "{rut}");
                // One deviation off the middle of a rut: 1 − e^(−1/2) = 0.393469…
                let beside = 0.6 * 0.393_469_340_287_366_6;
                assert!((ROAD.height(rut + 0.25) - beside).abs() < 1e-12);
                assert!((ROAD.height(rut - 0.25) - beside).abs() < 1e-12);
            }
            let crown = 0.6 * (1.0 - 0.011_108_996_538_242_306);
            assert!((ROAD.height(middle) - crown).abs() < 1e-12, "{}", ROAD.height(middle));
        }
        assert_eq!(ROAD.height(f64::NAN), 0.6);
        assert_eq!(ROAD.height(f64::INFINITY), 0.6);
    }

    #[test]
    fn lanes_lead_where_they_are_told() {
        // cos 0.5 and sin 0.5.
        let (cos, sin) = (0.877_582_561_890_372_8, 0.479_425_538_604_203);
        let [across, along] = ROAD.across_and_along(10.0 * sin, 10.0 * cos);
        assert!(
            across.abs() < 1e-12 * 10.0 && (along - 10.0).abs() < 1e-12 * 10.0,
            "{across} {along}"
        );
        let [across, along] = ROAD.across_and_along(3.0, -4.0);
        assert!((across - (3.0 * cos + 4.0 * sin)).abs() < 1e-12 * 5.0);
        assert!((along - (3.0 * sin - 4.0 * cos)).abs() < 1e-12 * 5.0);
    }

    #[test]
    fn each_field_is_checked_and_named() {
        assert!(ROAD.validated().is_ok());
        for bad in [f64::NAN, f64::INFINITY, -1e9] {
            let all = [
                (
                    "direction_rad",
                    RutLanes {
                        direction_rad: bad,
                        ..ROAD
                    },
                ),
                ("lane_m", RutLanes { lane_m: bad, ..ROAD }),
                ("offset_m", RutLanes { offset_m: bad, ..ROAD }),
                ("track_m", RutLanes { track_m: bad, ..ROAD }),
                (
                    "half_width_m",
                    RutLanes {
                        half_width_m: bad,
                        ..ROAD
                    },
                ),
                ("depth", RutLanes { depth: bad, ..ROAD }),
            ];
            for (name, lanes) in all {
                let message = lanes.validated().expect_err("invalid").to_string();
                assert!(message.starts_with(name), "{message}");
            }
        }
    }
}
