//! How near drops are whose streaks may have a pattern.

use glam::Vec4Swizzles as _;
use rain_core::rainfall::{CLASS_COUNT, ClassPlacement, SizeClass};

use super::RainfallInput;

/// Width from which streaks have a pattern: `PATTERN_FROM` of `shaders/shared/streak_quads.wgsl`. Units: px.
const PATTERN_FROM_PX: f32 = 1.5;

/// Room for rounding and for what a flat picture stretches, as a share and in m.
const ROOM: (f32, f32) = (1.1, 0.05);

/// How far from the eye cells reach that may hold a drop with a streak wide enough for a pattern, by class; nowhere where no
/// patterns are asked for. Units: m.
pub(super) fn near_reaches(input: &RainfallInput, placements: &[ClassPlacement]) -> [f32; CLASS_COUNT] {
    if !input.shutter.patterned {
        return [-1.0; CLASS_COUNT];
    }
    let half_view = input.viewport_px.zw() / (2.0 * input.focal_px.max(1.0));
    let secant = (1.0 + half_view.length_squared()).sqrt();
    let larger = input.shutter.detail.map_or(1.0, |law| {
        let [even, linear, square] = law.size_terms();
        // A parabola lies below the sum of what is above 0 in it.
        even + linear.max(0.0) + square.max(0.0)
    });
    let mut reaches = [-1.0; CLASS_COUNT];
    for (k, (reach, placement)) in reaches.iter_mut().zip(placements).enumerate() {
        let size_m = 1e-3 * SizeClass::new(k).max_mm as f32 * larger;
        let travelled = (placement.velocity_m_s - input.eye_velocity_m_s).length() * input.shutter.exposure_s;
        *reach = ROOM.0 * secant * size_m * input.focal_px / PATTERN_FROM_PX + travelled + ROOM.1;
    }
    reaches
}
