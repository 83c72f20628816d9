//! How a camera moves during the exposure.

use bevy::math::{DVec3, Quat, Vec3};
use bevy::prelude::*;

/// Above this speed a camera has been cut, not moved. Units: m/s.
const CUT_SPEED_M_S: f32 = 150.0;

/// Above this turning rate a camera has been cut. Units: rad/s.
const CUT_TURN_RAD_S: f32 = 40.0;

/// Over a longer time than this the mean velocity says nothing about a shutter: the camera may have been cut. Units: s.
const CUT_TIME_S: f32 = 0.5;

/// Velocity and turning of a camera, from its last two poses.
#[derive(Component, Debug, Clone, Copy, PartialEq, Default)]
pub struct ViewMotion {
    last: Option<(Vec3, Quat)>,
    /// Velocity of the eye. Units: m/s.
    pub velocity_m_s: DVec3,
    /// Rotation over one second, as an axis times radians (world frame).
    pub turn_rad_s: Vec3,
}

impl ViewMotion {
    /// Takes the pose of this frame, `seconds` after the last one.
    ///
    /// With no time between (a paused clock) the motion is zero: a photograph of a still world.
    pub fn observe(&mut self, position: Vec3, rotation: Quat, seconds: f32) {
        let (mut velocity, mut turn) = (Vec3::ZERO, Vec3::ZERO);
        if let Some((last_position, last_rotation)) = self.last
            && seconds > 0.0
            && seconds <= CUT_TIME_S
        {
            velocity = (position - last_position) / seconds;
            turn = (rotation * last_rotation.inverse()).to_scaled_axis() / seconds;
        }
        // A cut or a teleport leaves no streak behind.
        if velocity.length() > CUT_SPEED_M_S || turn.length() > CUT_TURN_RAD_S || !velocity.is_finite() {
            (velocity, turn) = (Vec3::ZERO, Vec3::ZERO);
        }
        self.last = Some((position, rotation));
        self.velocity_m_s = velocity.as_dvec3();
        self.turn_rad_s = turn;
    }

    /// The eye-relative view matrix (rotation only) now, and at the start of an exposure of `exposure_s` seconds as
    /// seen from positions relative to the present eye.
    #[must_use]
    pub fn view_matrices(&self, rotation: Quat, exposure_s: f32) -> (Mat4, Mat4) {
        let now = Mat4::from_quat(rotation.inverse());
        let before_rotation = Quat::from_scaled_axis(-self.turn_rad_s * exposure_s) * rotation;
        // The eye was behind by its path: everything then lay further ahead by as much.
        let shift = self.velocity_m_s.as_vec3() * exposure_s;
        let before = Mat4::from_quat(before_rotation.inverse()) * Mat4::from_translation(shift);
        (now, before)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drop_that_moves_with_the_eye_stays_where_it_is() {
        let mut motion = ViewMotion::default();
        motion.observe(Vec3::ZERO, Quat::IDENTITY, 0.1);
        motion.observe(Vec3::new(0.0, 0.0, -3.0), Quat::IDENTITY, 0.1);
        assert_eq!(motion.velocity_m_s, DVec3::new(0.0, 0.0, -30.0));
        let exposure = 1.0 / 60.0;
        let (now, before) = motion.view_matrices(Quat::IDENTITY, exposure);
        let p = Vec3::new(1.0, 2.0, -5.0);
        // One exposure ago it was 30 m/s · T further back.
        let was = p - Vec3::new(0.0, 0.0, -30.0) * exposure;
        assert!((now.transform_point3(p) - before.transform_point3(was)).length() < 1e-5);
    }

    #[test]
    fn a_turning_camera_sees_the_world_turn() {
        let mut motion = ViewMotion::default();
        motion.observe(Vec3::ZERO, Quat::IDENTITY, 0.1);
        let turned = Quat::from_rotation_y(0.1);
        motion.observe(Vec3::ZERO, turned, 0.1);
        let (_, before) = motion.view_matrices(turned, 0.1);
        // 0.1 s ago the camera looked along −Z.
        let p = Vec3::new(0.0, 0.0, -4.0);
        assert!((before.transform_point3(p) - p).length() < 1e-4);
    }

    #[test]
    fn a_cut_leaves_no_motion() {
        let mut motion = ViewMotion::default();
        motion.observe(Vec3::ZERO, Quat::IDENTITY, 0.016);
        motion.observe(Vec3::new(40.0, 0.0, 0.0), Quat::IDENTITY, 0.016);
        assert_eq!(motion.velocity_m_s, DVec3::ZERO);
        motion.observe(Vec3::new(40.0, 0.0, 0.0), Quat::IDENTITY, 0.0);
        assert_eq!(motion.velocity_m_s, DVec3::ZERO);
        // 20 m/s, if it was driven there; over half a second it was.
        motion.observe(Vec3::new(80.0, 0.0, 0.0), Quat::IDENTITY, 2.0);
        assert_eq!(motion.velocity_m_s, DVec3::ZERO);
        motion.observe(Vec3::new(90.0, 0.0, 0.0), Quat::IDENTITY, 0.5);
        assert_eq!(motion.velocity_m_s, DVec3::X * 20.0);
    }
}
