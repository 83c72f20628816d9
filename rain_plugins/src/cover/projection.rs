//! The cover view's projection for Bevy's cameras.

use bevy::camera::{CameraProjection, SubCameraView};
use bevy::math::{Mat4, Vec3A};
use rain_core::cover::ShearedOrthographic;

/// A [`ShearedOrthographic`] map as a camera's projection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShearedProjection(pub ShearedOrthographic);

impl CameraProjection for ShearedProjection {
    fn get_clip_from_view(&self) -> Mat4 {
        self.0.clip_from_view()
    }

    fn get_clip_from_view_for_sub(&self, _sub_view: &SubCameraView) -> Mat4 {
        self.get_clip_from_view()
    }

    fn update(&mut self, _width: f32, _height: f32) {}

    fn far(&self) -> f32 {
        let s = self.0.settings();
        (s.high_m - s.low_m) as f32
    }

    fn get_frustum_corners(&self, z_near: f32, z_far: f32) -> [Vec3A; 8] {
        let s = self.0.settings();
        let half = 0.5 * s.extent_m as f32;
        let corner = |x: f32, y: f32, z: f32| {
            // View z is minus the depth below the camera, image y is world −z.
            let shift = s.drift.as_vec2() * z;
            Vec3A::new(x * half - shift.x, y * half + shift.y, z)
        };
        [
            corner(1.0, -1.0, z_near),
            corner(1.0, 1.0, z_near),
            corner(-1.0, 1.0, z_near),
            corner(-1.0, -1.0, z_near),
            corner(1.0, -1.0, z_far),
            corner(1.0, 1.0, z_far),
            corner(-1.0, 1.0, z_far),
            corner(-1.0, -1.0, z_far),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::math::{DVec2, DVec3};
    use rain_core::cover::ShearedOrthographicSettings;

    #[test]
    fn corners_project_to_the_clip_cube() {
        let map = ShearedOrthographic::new(ShearedOrthographicSettings {
            centre: DVec3::new(3.0, 1.0, -7.0),
            drift: DVec2::new(0.8, -0.3),
            ..ShearedOrthographicSettings::default()
        })
        .unwrap();
        let p = ShearedProjection(map);
        for corner in p.get_frustum_corners(0.0, -p.far()) {
            let c = p.get_clip_from_view().project_point3a(corner);
            assert!((c.x.abs() - 1.0).abs() < 1e-4 && (c.y.abs() - 1.0).abs() < 1e-4, "{c}");
        }
    }
}
