//! How often, where and how high a storm flashes.

use core::f64::consts::PI;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::error::{ConfigError, in_range};

/// A storm's lightning: flashes evenly over a disc that may move with the storm.
///
/// Defaults: 0.01 flashes per km² and minute over a radius of 12 km are 4.5 a minute; large storms have 5 to 10
/// (Livingston & Krider 1978). A quarter to a third of all flashes reach the ground (Boccippio et al. 2001).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LightningSettings {
    /// Flashes of both kinds. Units: 1/(km² min). Domain: [0, 1]. Default: 0.01. More flashes keep those of fewer.
    pub flashes_per_km2_min: f64,
    /// Middle of the disc at time 0: x and z. Units: m. Domain: each ±1 000 000. Default: (0, 0).
    pub centre_m: DVec2,
    /// How the disc moves. Units: m/s. Domain: length up to 60. Default: (0, 0).
    pub velocity_m_s: DVec2,
    /// Radius of the disc. Units: m. Domain: [500, 30 000]. Default: 12 000.
    pub radius_m: f64,
    /// No flash strikes the ground nearer to the middle than this. Units: m. Domain: [0, 0.9 radius]. Default: 400.
    pub nearest_m: f64,
    /// Share of the flashes that reach the ground. Units: none. Domain: [0, 1]. Default: 0.27.
    pub ground_share: f64,
    /// Height of the ground that is struck (Y). Units: m. Domain: ±10 000. Default: 0.
    pub ground_m: f64,
    /// Height of the cloud's base over that ground. Units: m. Domain: [200, 4000]. Default: 1200.
    pub cloud_base_m: f64,
}

impl Default for LightningSettings {
    fn default() -> Self {
        Self {
            flashes_per_km2_min: 0.01,
            centre_m: DVec2::ZERO,
            velocity_m_s: DVec2::ZERO,
            radius_m: 12_000.0,
            nearest_m: 400.0,
            ground_share: 0.27,
            ground_m: 0.0,
            cloud_base_m: 1200.0,
        }
    }
}

impl LightningSettings {
    /// These settings, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not finite or outside its domain.
    pub fn validated(self) -> Result<Self, ConfigError> {
        in_range(
            "flashes_per_km2_min",
            self.flashes_per_km2_min,
            0.0,
            1.0,
            "0 to 1 per km² and minute",
        )?;
        for value in self.centre_m.to_array() {
            in_range("centre_m", value, -1e6, 1e6, "each within ±1000000 m")?;
        }
        in_range(
            "velocity_m_s",
            self.velocity_m_s.length(),
            0.0,
            60.0,
            "a length of 0 to 60 m/s",
        )?;
        in_range("radius_m", self.radius_m, 500.0, 30_000.0, "500 to 30000 m")?;
        in_range(
            "nearest_m",
            self.nearest_m,
            0.0,
            0.9 * self.radius_m,
            "0 to 0.9 of radius_m",
        )?;
        in_range("ground_share", self.ground_share, 0.0, 1.0, "0 to 1")?;
        in_range("ground_m", self.ground_m, -1e4, 1e4, "-10000 to 10000 m")?;
        in_range("cloud_base_m", self.cloud_base_m, 200.0, 4000.0, "200 to 4000 m")?;
        Ok(self)
    }

    /// Mean number of flashes a second.
    #[must_use]
    pub fn flashes_per_s(&self) -> f64 {
        let radius_km = self.radius_m * 1e-3;
        self.flashes_per_km2_min * PI * (radius_km * radius_km) / 60.0
    }

    /// Middle of the disc at a time. Units: m.
    #[must_use]
    pub fn centre_at(&self, time_s: f64) -> DVec2 {
        self.centre_m + self.velocity_m_s * time_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_field_of_lightning_is_checked_and_named() {
        type Set = fn(&mut LightningSettings, f64);
        let fields: [(&str, Set, f64, f64); 8] = [
            ("flashes_per_km2_min", |s, v| s.flashes_per_km2_min = v, 0.0, 1.0),
            ("centre_m", |s, v| s.centre_m.y = v, -1e6, 1e6),
            ("velocity_m_s", |s, v| s.velocity_m_s.x = v, -60.0, 60.0),
            ("radius_m", |s, v| s.radius_m = v, 500.0, 30_000.0),
            ("nearest_m", |s, v| s.nearest_m = v, 0.0, 10_800.0),
            ("ground_share", |s, v| s.ground_share = v, 0.0, 1.0),
            ("ground_m", |s, v| s.ground_m = v, -1e4, 1e4),
            ("cloud_base_m", |s, v| s.cloud_base_m = v, 200.0, 4000.0),
        ];
        for (name, set, min, max) in fields {
            for good in [min, 0.5 * (min + max), max] {
                let mut settings = LightningSettings {
                    nearest_m: 0.0,
                    ..LightningSettings::default()
                };
                set(&mut settings, good);
                assert!(settings.validated().is_ok(), "{name} = {good}");
            }
            let margin = 1e-6 * (max - min);
            for bad in [min - margin, max + margin, f64::NAN, f64::INFINITY] {
                let mut settings = LightningSettings::default();
                set(&mut settings, bad);
                let message = settings.validated().expect_err("out of the domain").to_string();
                assert!(message.starts_with(name), "{message}");
            }
        }
    }
}
