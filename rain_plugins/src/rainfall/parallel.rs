//! Views without perspective: what they look at, and where their rain is.

use bevy::ecs::query::QueryData;
use bevy::prelude::*;
use rain_core::rainfall::{ParallelView, RANGE_CAP_M, RainViewVolume};

use super::motion::ViewMotion;
use super::view::RainView;

/// How far ahead things are looked for where there is no ground. Units: m.
const NO_GROUND_M: f32 = 10.0;

/// How far ahead the ground at height 0 is. Units: m.
fn to_ground(height_m: f32, ahead: Vec3) -> Option<f32> {
    let way = -height_m / ahead.y;
    (0.0..1e4).contains(&way).then_some(way)
}

/// The picture of an orthographic camera, in its own plane.
pub(crate) struct Picture {
    /// Half of its width and height. Units: m.
    pub half: Vec2,
    /// Its middle, which need not be before the camera. World metres.
    pub middle: Vec3,
}

impl Picture {
    pub fn new(clip_from_view: Mat4, position: Vec3, rotation: Quat) -> Self {
        let scale = Vec2::new(clip_from_view.x_axis.x, clip_from_view.y_axis.y);
        let middle = -clip_from_view.w_axis.truncate().truncate() / scale;
        Self {
            half: scale.recip().abs(),
            middle: position + rotation * middle.extend(0.0),
        }
    }
}

/// Where the surroundings of a view lie that are kept for it: around its eye, or without perspective, where the camera may be
/// anywhere along its rays, around what its middle sees.
#[derive(QueryData)]
pub(crate) struct ViewPlace {
    at: &'static GlobalTransform,
    projection: &'static Projection,
    view: &'static RainView,
}

impl ViewPlaceItem<'_, '_> {
    /// World metres.
    pub fn place(&self) -> Vec3 {
        seen_place(self.projection, self.at, self.view.focus_m)
    }

    /// `metres` further into the view; what the middle of a picture sees is far enough.
    pub fn inward(&self, metres: f32) -> Vec3 {
        self.further(self.at.forward().into(), metres)
    }

    /// The same on the level.
    pub fn ahead(&self, metres: f32) -> Vec3 {
        self.further(self.at.forward().with_y(0.0).normalize_or_zero(), metres)
    }

    fn further(&self, way: Vec3, metres: f32) -> Vec3 {
        match self.projection {
            Projection::Orthographic(_) => self.place(),
            _ => self.place() + way * metres,
        }
    }
}

/// The eye; without perspective what the middle of the picture sees at `focus_m`, or of the ground at height 0, or 10 m ahead.
pub(crate) fn seen_place(projection: &Projection, at: &GlobalTransform, focus_m: Option<f32>) -> Vec3 {
    let (_, rotation, position) = at.to_scale_rotation_translation();
    if !matches!(projection, Projection::Orthographic(_)) {
        return position;
    }
    let Picture { middle, .. } = Picture::new(projection.get_clip_from_view(), position, rotation);
    let ahead = rotation * Vec3::NEG_Z;
    let way = focus_m.filter(|metres| metres.is_finite());
    middle + ahead * way.or_else(|| to_ground(middle.y, ahead)).unwrap_or(NO_GROUND_M)
}

/// How far ahead of an orthographic camera the middle of the drawn rain lies, so that all of the picture has as much of it before the
/// ground at height 0: before what the lower rim sees. Units: m.
fn focus_m(height_m: f32, ahead: Vec3, half_height_m: f32) -> f32 {
    let Some(to_ground) = to_ground(height_m, ahead) else {
        return NO_GROUND_M;
    };
    let nearest = to_ground - half_height_m * (1.0 - ahead.y * ahead.y).max(0.0).sqrt() / ahead.y.abs();
    // From here on drops fade.
    let clear = 0.8 * RANGE_CAP_M as f32;
    (nearest - clear).max(0.5 * nearest.max(0.0))
}

/// An orthographic view as the container needs it.
pub(super) fn parallel_volume(
    clip_from_view: Mat4,
    size: UVec2,
    transform: &GlobalTransform,
    motion: &ViewMotion,
    settings: &RainView,
) -> RainViewVolume {
    let (_, rotation, position) = transform.to_scale_rotation_translation();
    let Picture { half, middle } = Picture::new(clip_from_view, position, rotation);
    let [right, up, ahead] = [Vec3::X, Vec3::Y, Vec3::NEG_Z].map(|axis| rotation * axis);
    let focus = settings.focus_m.unwrap_or_else(|| focus_m(middle.y, ahead, half.y));
    let eye = middle + ahead * focus - right * half.x;
    RainViewVolume {
        eye_m: eye.as_dvec3(),
        eye_velocity_m_s: motion.velocity_m_s,
        side_planes: [
            right.extend(0.0),
            (-right).extend(2.0 * half.x),
            up.extend(half.y),
            (-up).extend(half.y),
        ],
        focal_px: f64::from(0.5 * size.y as f32 / half.y) * RANGE_CAP_M,
        solid_angle_sr: 0.0,
        exposure_s: f64::from(settings.exposure_s),
        turn_rad: f64::from(motion.turn_rad_s.length() * settings.exposure_s),
        parallel: Some(ParallelView {
            across_m: (right * 2.0 * half.x).as_dvec3(),
            height_m: f64::from(2.0 * half.y),
            ahead: ahead.as_dvec3(),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_orthographic_view_is_focused_before_the_ground() {
        // Straight down from 50 m; from the side at 30 degrees, where the lower rim sees the ground 8.7 m nearer; from near; level.
        let slope = Vec3::new(0.0, -0.5, -0.75_f32.sqrt());
        for (height, ahead, expected) in [
            (50.0, Vec3::NEG_Y, 38.0),
            (30.0, slope, 60.0 - 8.66 - 12.0),
            (6.0, Vec3::NEG_Y, 3.0),
            (2.0, Vec3::NEG_Z, 10.0),
            (2.0, Vec3::Y, 10.0),
        ] {
            let found = focus_m(height, ahead, 5.0);
            assert!((found - expected).abs() < 0.01, "{height} {ahead}: {found}");
        }
    }

    #[test]
    fn what_a_view_looks_at_is_around_its_eye_or_where_its_middle_sees_the_ground() {
        let at =
            GlobalTransform::from(Transform::from_xyz(3.0, 20.0, 40.0).looking_at(Vec3::new(3.0, 0.0, 0.0), Vec3::Y));
        let seen = |projection: &Projection, focus_m| seen_place(projection, &at, focus_m);
        assert_eq!(seen(&Projection::default(), None), Vec3::new(3.0, 20.0, 40.0));
        let flat = |left: f32| {
            let mut flat = OrthographicProjection::default_3d();
            flat.area = Rect::new(left, -5.0, left + 20.0, 5.0);
            Projection::Orthographic(flat)
        };
        assert!(seen(&flat(-10.0), None).distance(Vec3::new(3.0, 0.0, 0.0)) < 1e-3);
        // A picture beside the camera; one that says how far away what it shows is; one that says nonsense.
        assert!(seen(&flat(0.0), None).distance(Vec3::new(13.0, 0.0, 0.0)) < 1e-3);
        let near = seen(&flat(-10.0), Some(44.72136 - 10.0));
        assert!(near.distance(Vec3::new(3.0, 4.472, 8.944)) < 1e-2, "{near}");
        assert!(seen(&flat(-10.0), Some(f32::NAN)).distance(Vec3::new(3.0, 0.0, 0.0)) < 1e-3);
    }
}
