//! Which drops may be so near that their streaks have a pattern.

use glam::{IVec3, Vec3, Vec4Swizzles as _};
use rain_core::rainfall::SizeClass;

use super::RainfallInput;

/// Width from which streaks have a pattern: `PATTERN_FROM` of `shaders/shared/streak_quads.wgsl`. Units: px.
const PATTERN_FROM_PX: f32 = 1.5;

/// Room for rounding and for what a flat picture stretches, as a share and in m.
const ROOM: (f32, f32) = (1.1, 0.05);

/// Which records may have a streak wide enough for a pattern: all that have, and the others of their cells; none where no
/// patterns are asked for. Drops are told by their cell, a few nanoseconds each.
pub(super) fn near_drops(input: &RainfallInput, drops: &mut Vec<u32>) {
    drops.clear();
    if !input.shutter.patterned {
        return;
    }
    let half_view = input.viewport_px.zw() / (2.0 * input.focal_px.max(1.0));
    let secant = (1.0 + half_view.length_squared()).sqrt();
    let larger = input.shutter.detail.map_or(1.0, |law| {
        let [even, linear, square] = law.size_terms();
        // A parabola lies below the sum of what is above 0 in it.
        even + linear.max(0.0) + square.max(0.0)
    });
    // Side of a cell and reach of each class.
    let classes: Vec<(f32, f32)> = input
        .container
        .classes
        .iter()
        .enumerate()
        .map(|(k, class)| {
            let size = SizeClass::new(k);
            let size_m = 1e-3 * size.max_mm as f32 * larger;
            let travelled = (class.velocity_m_s - input.eye_velocity_m_s).length() * input.shutter.exposure_s;
            let reach = ROOM.0 * secant * size_m * input.focal_px / PATTERN_FROM_PX + travelled + ROOM.1;
            (size.cell_m as f32, reach)
        })
        .collect();
    let (mut last, mut near) = (None, false);
    for (i, record) in (0_u32..).zip(&input.container.records) {
        let class = (record.drop & 15) as usize;
        if last != Some((class, record.cell)) {
            last = Some((class, record.cell));
            let cell = IVec3::new(
                (record.cell & 1023) as i32,
                (record.cell >> 10 & 1023) as i32,
                (record.cell >> 20 & 1023) as i32,
            ) - 512;
            near =
                input
                    .container
                    .classes
                    .get(class)
                    .zip(classes.get(class))
                    .is_some_and(|(placement, (side, reach))| {
                        let low = (cell.as_vec3() - placement.eye.fraction) * *side;
                        Vec3::ZERO.clamp(low, low + *side).length() < *reach
                    });
        }
        if near {
            drops.push(i);
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{Mat4, Vec4};
    use rain_core::rainfall::{Container, Distribution, FieldMotion, RainViewVolume, Spectrum};

    use super::*;
    use crate::cover::open_sky;
    use crate::rainfall::{Lighting, Shutter};

    #[test]
    fn every_wide_streak_is_listed_and_few_others() {
        let spectrum = Spectrum::new(Distribution::MarshallPalmer, 50.0).expect("a spectrum");
        let volume = RainViewVolume {
            eye_m: glam::DVec3::new(3.0, 1.7, 5.0),
            eye_velocity_m_s: glam::DVec3::ZERO,
            side_planes: [glam::Vec4::new(0.0, 0.0, -1.0, 0.0); 4],
            focal_px: 700.0,
            solid_angle_sr: 1.0,
            exposure_s: 1.0 / 60.0,
        };
        let mut motion = FieldMotion::default();
        motion.advance(100.0);
        let mut container = Container::default();
        assert!(container.fill(3, &spectrum, &motion, &volume, 1.0, 1 << 20));
        let mut input = RainfallInput {
            container: &container,
            seed: 3,
            clip_from_eye: Mat4::IDENTITY,
            clip_from_eye_before: Mat4::IDENTITY,
            eye_height_m: 1.7,
            eye_velocity_m_s: Vec3::ZERO,
            viewport_px: Vec4::new(0.0, 0.0, 1280.0, 720.0),
            focal_px: 700.0,
            near_m: 0.1,
            shutter: Shutter {
                exposure_s: 1.0 / 60.0,
                contrast: 1.0,
                kappa: 1.0,
                soft_m: 0.0,
                patterned: true,
                detail: None,
            },
            lighting: Lighting {
                environment_scale: 0.0,
                environment_max_level: 0.0,
                ambient: Vec3::ONE,
                sun_direction: Vec3::Y,
                sun: Vec3::ZERO,
            },
            lamps: &[],
            panes: &[],
            cover: open_sky(),
        };
        let mut drops = Vec::new();
        near_drops(&input, &mut drops);
        let held: std::collections::BTreeSet<u32> = drops.iter().copied().collect();
        let mut wide = 0;
        for (i, record) in (0_u32..).zip(&container.records) {
            let class = (record.drop & 15) as usize;
            let head = record.position(3, &container.classes);
            let middle = head - container.classes[class].velocity_m_s * (0.5 / 60.0);
            let width = 1e-3 * SizeClass::new(class).max_mm as f32 * 700.0 / -middle.z;
            let seen = middle.z < -0.05 && (middle.x / middle.z).abs() < 0.92 && (middle.y / middle.z).abs() < 0.52;
            if seen && width > PATTERN_FROM_PX {
                wide += 1;
                assert!(held.contains(&i), "{middle}");
            }
        }
        let all = container.records.len();
        assert!(
            wide > 20 && drops.len() * 10 < all,
            "{wide} wide, {} of {all} listed",
            drops.len()
        );
        input.shutter.patterned = false;
        near_drops(&input, &mut drops);
        assert!(drops.is_empty());
    }
}
