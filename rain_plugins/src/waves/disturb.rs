//! What moves the water of puddles.

use bevy::prelude::*;
use rain_core::error::{ConfigError, in_range};
use rain_core::waves::Push;
use rain_ecs::prelude::*;
use rain_render::waves::Disturbance;

/// Put on a wheel, a foot, a ball: where it moves through a puddle it makes waves along its way.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default)]
#[require(DisturberMotion)]
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
#[derive(Component, Clone, Copy, Debug, Default)]
pub struct DisturberMotion {
    before: Option<Vec3>,
}

/// A way longer than this in one frame is a leap, not a motion. Units: m.
const LEAP_M: f32 = 5.0;

impl DisturberMotion {
    /// What the disturber did on its way to `at` in `seconds`, if it touched water: `depth_m` tells how deep it is at a
    /// place (x, z), and how high its surface lies.
    pub(super) fn step(
        &mut self,
        disturber: &WaterDisturber,
        at: Vec3,
        seconds: f32,
        water: impl Fn(f64, f64) -> Option<f32>,
    ) -> Option<Disturbance> {
        let before = self.before.replace(at)?;
        let way = at.distance(before);
        if !(1e-4..LEAP_M).contains(&way) || seconds <= 0.0 {
            return None;
        }
        let surface =
            water(f64::from(at.x), f64::from(at.z)).or_else(|| water(f64::from(before.x), f64::from(before.z)))?;
        if at.y - disturber.radius_m > surface {
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
    use super::*;

    fn pond(x: f64, _z: f64) -> Option<f32> {
        (x > 0.0).then_some(0.02)
    }

    #[test]
    fn only_what_moves_in_water_disturbs_it() {
        let wheel = WaterDisturber::default();
        let mut motion = DisturberMotion::default();
        let mut step = |x: f32, y: f32| motion.step(&wheel, Vec3::new(x, y, 0.0), 0.02, pond);
        assert!(step(1.0, 0.3).is_none(), "nothing is known of its way yet");
        assert!(step(1.0, 0.3).is_none(), "it stands still");
        let moved = step(1.2, 0.3).expect("it moves in the pond");
        assert!(
            matches!(moved.push, Push::Impulse(j) if (j - 0.3).abs() < 1e-6),
            "{moved:?}"
        );
        assert!((moved.to_m[0] - 1.2).abs() < 1e-6 && (moved.width_m - 0.2 / 12.0_f64.sqrt()).abs() < 1e-7);
        assert!(step(1.3, 0.5).is_none(), "it flies over the water");
        assert!(step(-1.0, 0.3).is_some(), "it came out of the water");
        assert!(step(-1.2, 0.3).is_none(), "dry road");
        assert!(step(50.0, 0.3).is_none(), "a leap is no motion");
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
