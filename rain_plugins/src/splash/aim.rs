//! What a view sees of splashes: from where they are looked for, how far, and at which scale.

use bevy::math::Vec4;
use bevy::prelude::*;
use rain_core::haze::ramp;

use super::view::{MAX_SPLASH_DISTANCE_M, SplashSettings};
use crate::rainfall::Picture;

/// Height of what Bevy's own lens (45°) shows a metre away. Units: m.
const LENS_HEIGHT: f32 = 0.828_427_1;

/// Splashes fade over the last part of their reach.
const CLEAR: f32 = 0.7;

/// How a view sees splashes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SplashAim {
    /// They are looked for around this. World metres.
    pub from_m: Vec3,
    /// Side planes from there, unit normals inward; w: offset, m.
    pub side_planes: [Vec4; 4],
    /// Units: px; without perspective px/m.
    pub focal_px: f32,
    /// How far crowns and thrown drops are drawn. Units: m.
    pub reach_m: [f32; 2],
    /// What is drawn of them. Units: none, [0, 1].
    pub shares: [f32; 2],
    /// Angle of the part of the reach that the view sees. Units: rad.
    pub angle_rad: f64,
    /// Along the rays of a view without perspective, unit.
    pub parallel: Option<Vec3>,
}

impl SplashAim {
    /// That of a view with perspective.
    pub fn perspective(
        eye_m: Vec3,
        side_planes: [Vec4; 4],
        focal_px: f32,
        clip_from_view: Mat4,
        settings: &SplashSettings,
    ) -> Self {
        Self {
            from_m: eye_m,
            side_planes,
            focal_px,
            reach_m: [settings.distance_m, settings.drops_distance_m.min(settings.distance_m)],
            shares: [1.0; 2],
            angle_rad: 2.0 * libm::atan(1.0 / f64::from(clip_from_view.x_axis.x).abs().max(1e-3)),
            parallel: None,
        }
    }

    /// That of a view without perspective, whose middle sees `from_m`. All of its ground is as near: as far away as Bevy's own lens
    /// would stand for a picture as high.
    pub fn parallel(
        from_m: Vec3,
        clip_from_view: Mat4,
        height_px: u32,
        transform: &GlobalTransform,
        settings: &SplashSettings,
    ) -> Self {
        let (_, rotation, position) = transform.to_scale_rotation_translation();
        let Picture { half, .. } = Picture::new(clip_from_view, position, rotation);
        let [right, up, ahead] = [Vec3::X, Vec3::Y, Vec3::NEG_Z].map(|axis| rotation * axis);
        let away = f64::from(2.0 * half.y / LENS_HEIGHT);
        let share = |distance: f32| {
            let end = f64::from(distance);
            (1.0 - ramp(away, f64::from(CLEAR) * end, end)) as f32
        };
        let shares = [
            share(settings.distance_m),
            share(settings.drops_distance_m.min(settings.distance_m)),
        ];
        // Level ground in the picture, a rectangle.
        let depth = half.y / ahead.y.abs().max(1e-3);
        let reach = (half.x.hypot(depth) / CLEAR).min(MAX_SPLASH_DISTANCE_M);
        let ground = f64::from(4.0 * half.x * depth);
        Self {
            from_m,
            side_planes: [
                right.extend(half.x),
                (-right).extend(half.x),
                up.extend(half.y),
                (-up).extend(half.y),
            ],
            focal_px: 0.5 * height_px as f32 / half.y,
            reach_m: shares.map(|share| if share > 0.0 { reach } else { 0.0 }),
            shares,
            angle_rad: (2.0 * ground / f64::from(reach * reach)).min(core::f64::consts::TAU),
            parallel: Some(ahead),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a picture so high, looking down at the angle whose sine is `down`.
    fn picture(height_m: f32, down: f32) -> SplashAim {
        let clip = Mat4::orthographic_rh(-height_m, height_m, -0.5 * height_m, 0.5 * height_m, 0.0, 100.0);
        let level = (1.0 - down * down).sqrt();
        let at = Transform::default().looking_to(Vec3::new(0.0, -down, -level), Vec3::Y);
        let from = Vec3::new(5.0, 0.0, -3.0);
        SplashAim::parallel(from, clip, 720, &GlobalTransform::from(at), &SplashSettings::default())
    }

    #[test]
    fn all_of_a_picture_is_clear_of_the_fade_and_no_more_is_looked_for() {
        let aim = picture(6.0, 0.5);
        // The ground in it is 12 × 12 m.
        assert!((aim.reach_m[0] - 72.0_f32.sqrt() / CLEAR).abs() < 1e-3, "{aim:?}");
        let seen_m2 = 0.5 * aim.angle_rad * f64::from(aim.reach_m[0]).powi(2);
        assert!((seen_m2 - 144.0).abs() < 1e-3, "{seen_m2}");
        assert!((aim.focal_px - 120.0).abs() < 1e-3);
        for (corner, inside) in [(Vec3::new(5.9, 0.0, 0.0), true), (Vec3::new(6.1, 0.0, 0.0), false)] {
            let least = aim
                .side_planes
                .iter()
                .map(|p| p.truncate().dot(corner) + p.w)
                .fold(f32::MAX, f32::min);
            assert_eq!(least > 0.0, inside, "{least}");
        }
        // Nearly level it ends where splashes end.
        assert_eq!(picture(6.0, 0.01).reach_m[0], MAX_SPLASH_DISTANCE_M);
    }

    #[test]
    fn a_wide_picture_shows_none_and_none_comes_at_once() {
        assert_eq!(picture(2.0, 1.0).shares, [1.0, 1.0]);
        // As 14 m away, and beyond 3.5 m.
        assert_eq!(picture(11.7, 1.0).shares, [0.0, 0.0]);
        let middle = picture(10.0, 1.0);
        assert!(
            (0.1..0.9).contains(&middle.shares[0]) && middle.shares[1] == 0.0,
            "{middle:?}"
        );
        assert_eq!(middle.reach_m[1], 0.0);
        let shares: Vec<f32> = (0..200)
            .map(|i| picture(7.0 + 0.025 * i as f32, 1.0).shares[0])
            .collect();
        assert!(shares.windows(2).all(|pair| (0.0..0.02).contains(&(pair[0] - pair[1]))));
    }
}
