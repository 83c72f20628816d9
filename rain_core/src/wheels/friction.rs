//! Friction of a tyre on ground of any class, dry to flooded.

use super::hydroplaning::wet_grip;
use super::tyre::Tyre;
use crate::error::clamped;
use crate::weather::SurfaceClass;

/// Water between a tyre and the ground.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct GroundWater {
    /// Pore water / pore capacity. Units: none. Domain: [0, 1].
    pub saturation: f64,
    /// Film, texture included, or depth of the pool. Units: mm. Domain: [0, 1e6].
    pub film_mm: f64,
    /// Depth of the texture. Units: mm. Domain: [0, 1000].
    pub texture_mm: f64,
}

/// Share of the way from dry to wet friction that damp pores make without a film.
const DAMP: f64 = 0.3;

/// Coefficient of friction of a tyre at `speed_m_s` (either way). Units: none. In [0.01, 1].
///
/// Dry and wet values by class; damp pores go a part of the way, a film within the texture the rest, and what stands
/// above the texture takes grip by [`wet_grip`]. Values outside their domains are held there, what is not a number
/// counts as 0. Falls with every kind of water and, on standing water, with speed. Source: dry and wet values are
/// choices within published ranges (Wong 2008: asphalt and concrete 0.8–0.9 dry, 0.5–0.8 wet; gravel 0.6; earth road
/// 0.68 dry, 0.55 wet).
///
/// Error: exact where dry or flooded, a choice between; measured friction scatters by a third with stone, polish and
/// tyre.
#[must_use]
pub fn ground_friction(class: SurfaceClass, water: &GroundWater, tyre: &Tyre, speed_m_s: f64) -> f64 {
    let (dry, wet) = match class {
        SurfaceClass::Asphalt => (0.85, 0.65),
        SurfaceClass::Concrete => (0.85, 0.7),
        SurfaceClass::Stone => (0.75, 0.5),
        SurfaceClass::Gravel => (0.6, 0.55),
        SurfaceClass::Soil => (0.68, 0.5),
        SurfaceClass::Grass => (0.45, 0.3),
        SurfaceClass::Roof => (0.6, 0.3),
    };
    let saturation = clamped(water.saturation, 0.0, 1.0);
    let film = clamped(water.film_mm, 0.0, 1e6);
    let texture = clamped(water.texture_mm, 0.0, 1e3);
    let filled = (film / texture.max(0.05)).min(1.0);
    let wetness = DAMP * saturation.max(filled) + (1.0 - DAMP) * filled;
    let speed = if speed_m_s.is_finite() { speed_m_s } else { 0.0 };
    (dry + (wet - dry) * wetness) * wet_grip(tyre, speed, (film - texture).max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn friction(class: SurfaceClass, saturation: f64, film_mm: f64, speed_m_s: f64) -> f64 {
        let texture_mm = class.properties().texture_depth_mm;
        let water = GroundWater {
            saturation,
            film_mm,
            texture_mm,
        };
        ground_friction(class, &water, &Tyre::default(), speed_m_s)
    }

    #[test]
    fn friction_falls_with_water_and_on_standing_water_with_speed() {
        for class in SurfaceClass::ALL {
            let dry = friction(class, 0.0, 0.0, 30.0);
            let mut last = dry;
            for i in 0..=400 {
                let x = f64::from(i) * 0.05;
                let now = friction(class, (x * 4.0).min(1.0), (x - 0.25).max(0.0), 30.0);
                assert!(now <= last + 1e-12 && (0.01..=1.0).contains(&now), "{class:?} {x}");
                last = now;
            }
            assert!(last < 0.5 * dry, "20 mm at 108 km/h carry the tyre: {class:?} {last}");
            assert_eq!(friction(class, 1.0, 0.0, 10.0), friction(class, 1.0, 0.0, 40.0));
            assert!(friction(class, 1.0, 10.0, 40.0) < friction(class, 1.0, 10.0, 10.0));
        }
        assert_eq!(friction(SurfaceClass::Asphalt, 0.0, 0.0, 0.0), 0.85);
        assert!((friction(SurfaceClass::Asphalt, 1.0, 0.8, 20.0) - 0.65).abs() < 1e-12);
    }

    #[test]
    fn anything_gets_a_number() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 1e300] {
            for value in [
                friction(SurfaceClass::Soil, bad, 1.0, 10.0),
                friction(SurfaceClass::Soil, 1.0, bad, 10.0),
                friction(SurfaceClass::Soil, 1.0, 1.0, bad),
            ] {
                assert!((0.01..=1.0).contains(&value), "{bad}: {value}");
            }
        }
    }
}
