//! What moves the water of puddles.

use bevy::prelude::*;
use rain_core::error::{ConfigError, in_range};
use rain_core::waves::Push;
use rain_ecs::prelude::*;
use rain_render::waves::Disturbance;
use serde::{Deserialize, Serialize};

use crate::surface::WaterLevels;

/// Put on a wheel, a foot, a ball: where it moves through a puddle it makes waves along its way.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default)]
#[require(DisturberMotion, WaterContact)]
pub struct WaterDisturber {
    /// Width of what touches the water. Units: m. Domain: [0.01, 10]. Default: 0.2, a tyre.
    pub width_m: f32,
    /// Height of the origin above the lowest point. Units: m. Domain: [0, 100]. Default: 0.3, a wheel's radius.
    pub radius_m: f32,
    /// Force on the water while it is in it. Units: N. Domain: [0, 1e5]. Default: 15.
    pub force_n: f32,
}

impl Default for WaterDisturber {
    fn default() -> Self {
        Self {
            width_m: 0.2,
            radius_m: 0.3,
            force_n: 15.0,
        }
    }
}

impl WaterDisturber {
    /// This disturber, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not finite or outside its domain.
    pub fn validated(&self) -> Result<&Self, ConfigError> {
        in_range("width_m", f64::from(self.width_m), 0.01, 10.0, "0.01 to 10 m")?;
        in_range("radius_m", f64::from(self.radius_m), 0.0, 100.0, "0 to 100 m")?;
        in_range("force_n", f64::from(self.force_n), 0.0, 1e5, "0 to 100000 N")?;
        Ok(self)
    }
}

/// The water that a [`WaterDisturber`] stands in, looked up once a frame at its lowest point: what decides about waves,
/// and is to decide about splashes. Written by the plugin alone. A disturber that does not validate touches no water, nor
/// does any while [`super::WaveWaterSettings::no_waves`] is set.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Default)]
pub struct WaterContact {
    /// World height of the water's surface; `None`: the point touches no water. Units: m.
    pub surface_m: Option<f32>,
    /// Depth of the water over the ground, the same as the picture shows; 0 where it is not known. Units: m.
    pub depth_m: f32,
}

impl WaterContact {
    /// The one look-up.
    pub(super) fn under(disturber: &WaterDisturber, at: Vec3, levels: &WaterLevels) -> Self {
        let (x, z) = (f64::from(at.x), f64::from(at.z));
        let surface_m = levels.surface_at(x, z).filter(|s| at.y - disturber.radius_m <= *s);
        Self {
            surface_m,
            depth_m: surface_m.map_or(0.0, |_| levels.depth_at(x, z)),
        }
    }
}

/// Impulse of the strongest step: 100 ml of water thrown aside at 3 m/s. Units: N s.
const STEP_N_S: f32 = 0.3;
/// Width of a sole. Units: m.
const SOLE_M: f64 = 0.1;

/// What a foot does to the water that it comes down in.
pub(super) fn foot_fall(splash: &FootSplash) -> Disturbance {
    let at = [splash.place.x, splash.place.z].map(f64::from);
    Disturbance {
        from_m: at,
        to_m: at,
        width_m: SOLE_M / 12.0_f64.sqrt(),
        push: Push::Impulse(STEP_N_S * splash.strength),
    }
}

/// Where a disturber was in the frame before.
#[derive(Component, Clone, Copy, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DisturberMotion {
    pub(super) before: Option<Vec3>,
    /// Whether it touched water there.
    wet: bool,
}

/// A way longer than this in one frame is a leap, not a motion. Units: m.
const LEAP_M: f32 = 5.0;

impl DisturberMotion {
    /// What the disturber did on its way to `at` in `seconds`, if it touched water at either end of it.
    pub(super) fn step(
        &mut self,
        disturber: &WaterDisturber,
        at: Vec3,
        seconds: f32,
        contact: WaterContact,
    ) -> Option<Disturbance> {
        let touched = std::mem::replace(&mut self.wet, contact.surface_m.is_some());
        let before = self.before.replace(at)?;
        let way = at.distance(before);
        if !(1e-4..LEAP_M).contains(&way) || seconds <= 0.0 || !(touched || self.wet) {
            return None;
        }
        Some(Disturbance {
            from_m: [before.x, before.z].map(f64::from),
            to_m: [at.x, at.z].map(f64::from),
            // A uniform footprint of this width has this standard deviation.
            width_m: f64::from(disturber.width_m) / 12.0_f64.sqrt(),
            push: Push::Impulse(disturber.force_n * seconds.min(1.0)),
        })
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use bevy::math::DVec2;

    use super::*;
    use crate::surface::NO_WATER_M;

    /// A pond of 2 cm over level ground for x > 0.
    fn pond() -> WaterLevels {
        let mut levels = WaterLevels::default();
        levels.corner_m = DVec2::splat(-100.0);
        levels.cell_m = 100.0;
        levels.cells = UVec2::splat(2);
        levels.ground_m = Arc::new(vec![0.0; 4]);
        levels.set_levels(vec![NO_WATER_M, 0.02, NO_WATER_M, 0.02]);
        levels
    }

    #[test]
    fn only_what_moves_in_water_disturbs_it() {
        let wheel = WaterDisturber::default();
        let mut motion = DisturberMotion::default();
        let pond = pond();
        let mut step = |x: f32, y: f32| {
            let at = Vec3::new(x, y, 0.0);
            motion.step(&wheel, at, 0.02, WaterContact::under(&wheel, at, &pond))
        };
        assert!(step(1.0, 0.3).is_none(), "nothing is known of its way yet");
        assert!(step(1.0, 0.3).is_none(), "it stands still");
        let moved = step(1.2, 0.3).expect("it moves in the pond");
        assert!(
            matches!(moved.push, Push::Impulse(j) if (j - 0.3).abs() < 1e-6),
            "{moved:?}"
        );
        assert!((moved.to_m[0] - 1.2).abs() < 1e-6 && (moved.width_m - 0.2 / 12.0_f64.sqrt()).abs() < 1e-7);
        assert!(step(1.3, 0.5).is_some(), "it lifts off");
        assert!(step(1.4, 0.5).is_none(), "it flies over the water");
        assert!(step(1.2, 0.3).is_some(), "it comes down");
        assert!(step(-1.0, 0.3).is_some(), "it came out of the water");
        assert!(step(-1.2, 0.3).is_none(), "dry road");
        assert!(step(50.0, 0.3).is_none(), "a leap is no motion");
    }

    #[test]
    fn one_look_up_knows_surface_and_depth() {
        let (wheel, pond) = (WaterDisturber::default(), pond());
        let look = |x: f32, y: f32| WaterContact::under(&wheel, Vec3::new(x, y, 1.0), &pond);
        let wet = look(3.0, 0.3);
        assert!(
            wet.surface_m == Some(0.02) && (wet.depth_m - 0.02).abs() < 1e-6,
            "{wet:?}"
        );
        for (x, y) in [(3.0, 0.4), (-3.0, 0.3), (300.0, 0.3), (f32::NAN, 0.3)] {
            assert_eq!(look(x, y), WaterContact::default(), "{x} {y}");
        }
    }

    #[test]
    fn bad_settings_are_refused_by_name() {
        for bad in [f32::NAN, f32::INFINITY, -1.0, 2e5] {
            for (name, disturber) in [
                (
                    "width_m",
                    WaterDisturber {
                        width_m: bad,
                        ..default()
                    },
                ),
                (
                    "radius_m",
                    WaterDisturber {
                        radius_m: bad,
                        ..default()
                    },
                ),
                (
                    "force_n",
                    WaterDisturber {
                        force_n: bad,
                        ..default()
                    },
                ),
            ] {
                let message = disturber.validated().expect_err("refused").to_string();
                assert!(message.starts_with(name), "{message}");
            }
        }
    }
}
