//! The cover view's projection: orthographic from above, sheared along the mean fall.

use bevy::camera::{CameraProjection, SubCameraView};
use bevy::math::{Mat4, Vec2, Vec3A, Vec4};

/// Looks down from a horizontal plane; a point `d` metres below it is seen displaced against the drift, so that each
/// texel is one ray of rain. Depth is reverse-Z and linear in height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShearedProjection {
    /// Half the side of the map. Units: m.
    pub half_extent: f32,
    /// Depth of the view below its plane. Units: m.
    pub range: f32,
    /// Depth of the reference plane below the view's plane: points on it are not displaced. Units: m.
    pub reference: f32,
    /// Drift in view axes (x right, y up of the image) per metre of fall. Units: none.
    pub drift: Vec2,
}

impl CameraProjection for ShearedProjection {
    fn get_clip_from_view(&self) -> Mat4 {
        // View space: x right, y up of the image, z towards the viewer; a point d below the plane has z = −d.
        // A ray that falls to the reference plane moves drift·(reference − d) on the way.
        let s = 1.0 / self.half_extent;
        Mat4::from_cols(
            Vec4::new(s, 0.0, 0.0, 0.0),
            Vec4::new(0.0, s, 0.0, 0.0),
            Vec4::new(self.drift.x * s, self.drift.y * s, 1.0 / self.range, 0.0),
            Vec4::new(
                self.drift.x * self.reference * s,
                self.drift.y * self.reference * s,
                1.0,
                1.0,
            ),
        )
    }

    fn get_clip_from_view_for_sub(&self, _sub_view: &SubCameraView) -> Mat4 {
        self.get_clip_from_view()
    }

    fn update(&mut self, _width: f32, _height: f32) {}

    fn far(&self) -> f32 {
        self.range
    }

    fn get_frustum_corners(&self, z_near: f32, z_far: f32) -> [Vec3A; 8] {
        let corner = |x: f32, y: f32, z: f32| {
            let shift = self.drift * (self.reference + z);
            Vec3A::new(x * self.half_extent - shift.x, y * self.half_extent - shift.y, z)
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
    use bevy::math::Vec3;

    #[test]
    fn a_falling_drop_stays_on_its_texel() {
        let p = ShearedProjection {
            half_extent: 30.0,
            range: 40.0,
            reference: 25.0,
            drift: Vec2::new(0.8, -0.3),
        };
        let clip = p.get_clip_from_view();
        let at = |d: f32| {
            // Falls one metre, drifts by (0.8, −0.3).
            let q = Vec3::new(3.0, 4.0, 0.0) + Vec3::new(0.8, -0.3, -1.0) * d;
            clip.project_point3(q)
        };
        let reference = at(25.0);
        assert!((reference.x - (3.0 + 0.8 * 25.0) / 30.0).abs() < 1e-5);
        for d in [0.0, 10.0, 40.0] {
            let c = at(d);
            assert!((c - reference).truncate().length() < 1e-5, "{c}");
            assert!((c.z - (1.0 - d / 40.0)).abs() < 1e-6, "depth at {d}: {}", c.z);
        }
    }

    #[test]
    fn corners_project_to_the_clip_cube() {
        let p = ShearedProjection {
            half_extent: 30.0,
            range: 40.0,
            reference: 25.0,
            drift: Vec2::new(0.8, -0.3),
        };
        for corner in p.get_frustum_corners(0.0, -40.0) {
            let c = p.get_clip_from_view().project_point3a(corner);
            assert!((c.x.abs() - 1.0).abs() < 1e-4 && (c.y.abs() - 1.0).abs() < 1e-4, "{c}");
        }
    }
}
