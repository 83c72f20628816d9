//! The sheared projection along the mean fall direction, and the matrices of a GPU depth map that has it.
//!
//! In plan a drop moves `wind / u` metres per metre of fall. Rays of the mean drop meet the plane y = y₀ in
//! `q = p.xz + (p.y − y₀) · wind · t`, t = flux-mean of 1/u: every point of one ray has the same q.
//! `DVec2`s of this module are horizontal: `x` is world x, `y` is world z.

use crate::error::{ConfigError, in_range};
use crate::ops;
use glam::{DMat4, DQuat, DVec2, DVec3, DVec4, Mat4};

/// Strongest wind accepted. Units: m/s.
const MAX_WIND_M_S: f64 = 100.0;
/// Largest drift of the mean drop. Units: m/m. 100 m/s at 1 mm/h.
const MAX_DRIFT: f64 = 27.0;
/// Lattice of fall directions that a map is drawn for. Units: rad. Half a degree: the nearest lattice direction is
/// at most 0.36° away, inside the one degree by which a map may be off.
const DIRECTION_STEP_RAD: f64 = 0.5 * core::f64::consts::PI / 180.0;

/// How the mean drop of a rain falls in a wind that is uniform in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FallSlope {
    wind_m_s: DVec2,
    mean_inverse_speed_s_per_m: f64,
}

impl FallSlope {
    /// `wind_m_s`: horizontal velocity of the air (x, z). Domain: up to 100 m/s. `mean_inverse_speed_s_per_m`:
    /// flux-mean of 1/u over the drops. Domain: [0.05, 5] s/m; 0.169 at 25 mm/h.
    ///
    /// # Errors
    /// When a value is not finite or outside its domain, or the drift exceeds 27 m per metre of fall.
    pub fn new(wind_m_s: DVec2, mean_inverse_speed_s_per_m: f64) -> Result<Self, ConfigError> {
        in_range(
            "wind_m_s",
            wind_m_s.length(),
            0.0,
            MAX_WIND_M_S,
            "finite, up to 100 m/s",
        )?;
        let t = in_range(
            "mean_inverse_speed_s_per_m",
            mean_inverse_speed_s_per_m,
            0.05,
            5.0,
            "0.05 to 5 s/m",
        )?;
        in_range(
            "drift_m_per_m",
            wind_m_s.length() * t,
            0.0,
            MAX_DRIFT,
            "up to 27 m per metre of fall",
        )?;
        Ok(Self {
            wind_m_s,
            mean_inverse_speed_s_per_m: t,
        })
    }

    /// The slope of a rain given by classes: `speeds_m_s` (fall speed of each, m/s) and `flux` (any unit, ≥ 0).
    ///
    /// # Errors
    /// When the slices are empty or differ in length, a value is not finite, no flux is above 0, or as in
    /// [`Self::new`].
    pub fn from_classes(wind_m_s: DVec2, speeds_m_s: &[f64], flux: &[f64]) -> Result<Self, ConfigError> {
        if flux.is_empty() {
            return Err(ConfigError::Empty { field: "flux" });
        }
        in_range(
            "number of class speeds",
            speeds_m_s.len() as f64,
            flux.len() as f64,
            flux.len() as f64,
            "one for each flux",
        )?;
        let (mut sum, mut sum_inverse) = (0.0, 0.0);
        for (&u, &f) in speeds_m_s.iter().zip(flux) {
            in_range("speeds_m_s", u, 0.01, 100.0, "0.01 to 100 m/s")?;
            in_range("flux", f, 0.0, f64::MAX, "finite, not negative")?;
            sum += f;
            sum_inverse += f / u;
        }
        in_range("sum of flux", sum, f64::MIN_POSITIVE, f64::MAX, "above 0")?;
        Self::new(wind_m_s, sum_inverse / sum)
    }

    /// Horizontal velocity of the air. Units: m/s.
    #[must_use]
    pub fn wind_m_s(&self) -> DVec2 {
        self.wind_m_s
    }

    /// Flux-mean of 1/u. Units: s/m.
    #[must_use]
    pub fn mean_inverse_speed_s_per_m(&self) -> f64 {
        self.mean_inverse_speed_s_per_m
    }

    /// Horizontal way of the mean drop per metre of fall. Units: m/m.
    #[must_use]
    pub fn drift(&self) -> DVec2 {
        self.wind_m_s * self.mean_inverse_speed_s_per_m
    }

    /// The drift of the nearest direction on a lattice of half a degree (azimuthal equidistant about the vertical).
    ///
    /// Maps are drawn for this one, so that a wandering wind redraws them seldom, and a map depends on the wind alone
    /// and not on the way the wind took. Calm air stays exactly vertical. Look-ups use the true wind all the same.
    /// Units: m/m. Error: up to 0.36°, by choice.
    #[must_use]
    pub fn snapped_drift(&self) -> DVec2 {
        let drift = self.drift();
        let size = drift.length();
        if size == 0.0 {
            return DVec2::ZERO;
        }
        let from_vertical = drift * (ops::atan2(size, 1.0) / size);
        let snapped = (from_vertical / DIRECTION_STEP_RAD).round() * DIRECTION_STEP_RAD;
        let angle = snapped.length();
        // Rounding up from the steepest drift must not pass the horizon.
        if angle == 0.0 || angle > ops::atan2(MAX_DRIFT, 1.0) {
            return if angle == 0.0 { DVec2::ZERO } else { drift };
        }
        snapped * (ops::tan(angle) / angle)
    }

    /// Angle between the mean fall directions of two rains. Units: rad.
    #[must_use]
    pub fn angle_to(&self, other: &Self) -> f64 {
        let (a, b) = (self.drift().extend(-1.0), other.drift().extend(-1.0));
        ops::atan2(a.cross(b).length(), a.dot(b))
    }
}

/// Where the mean drop through `point` meets the plane y = `reference_height_m`: `p.xz + (p.y − y₀) · drift`.
/// Units: m; `drift` m/m. Error: 1e-12 m within 100 m.
#[must_use]
pub fn project(point: DVec3, reference_height_m: f64, drift: DVec2) -> DVec2 {
    DVec2::new(point.x, point.z) + (point.y - reference_height_m) * drift
}

/// What a [`ShearedOrthographic`] is made from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShearedOrthographicSettings {
    /// Point that the map is centred on (to half a texel). Units: m.
    pub centre: DVec3,
    /// Side of the square map in the projected plane. Units: m. Domain: [1, 4096]. Default: 60.
    pub extent_m: f64,
    /// Texels along a side. Domain: [16, 16384]. Default: 1024.
    pub texels: u32,
    /// Height of depth 0. Units: m. Default: −20.
    pub low_m: f64,
    /// Height of depth 1, above `low_m`; what stands higher is clipped. Units: m. Default: 80.
    pub high_m: f64,
    /// Height y₀ of the reference plane. Keep it when the centre moves: texels are anchored in that plane.
    /// Units: m. Default: 0.
    pub reference_height_m: f64,
    /// Horizontal way per metre of fall, [`FallSlope::drift`] or [`FallSlope::snapped_drift`]. Units: m/m. Default: 0.
    pub drift: DVec2,
}

impl Default for ShearedOrthographicSettings {
    fn default() -> Self {
        Self {
            centre: DVec3::ZERO,
            extent_m: 60.0,
            texels: 1024,
            low_m: -20.0,
            high_m: 80.0,
            reference_height_m: 0.0,
            drift: DVec2::ZERO,
        }
    }
}

/// A square depth map looking straight down with the shear of the falling rain.
///
/// View: right +X, up −Z, looking along −Y. Clip space is wgpu's, reverse-Z: depth 1 at `high_m`, 0 at `low_m`, linear
/// in y. Texture u grows with x, v with z. A cleared texel (depth 0) is open sky.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShearedOrthographic {
    corner: DVec2,
    texel_m: f64,
    settings: ShearedOrthographicSettings,
}

impl ShearedOrthographic {
    /// A map around `settings.centre`, its corner on a whole texel of the projected plane: texels keep their place in
    /// the world when the centre moves, so edges do not crawl.
    ///
    /// # Errors
    /// When a value is not finite or outside its domain.
    pub fn new(settings: ShearedOrthographicSettings) -> Result<Self, ConfigError> {
        const FAR: f64 = 1.0e7;
        let s = &settings;
        for (field, value) in [
            ("centre.x", s.centre.x),
            ("centre.y", s.centre.y),
            ("centre.z", s.centre.z),
        ] {
            in_range(field, value, -FAR, FAR, "-1e7 to 1e7 m")?;
        }
        in_range("extent_m", s.extent_m, 1.0, 4096.0, "1 to 4096 m")?;
        in_range("texels", f64::from(s.texels), 16.0, 16384.0, "16 to 16384")?;
        in_range("low_m", s.low_m, -FAR, FAR, "-1e7 to 1e7 m")?;
        in_range(
            "high_m",
            s.high_m,
            s.low_m + 1.0e-3,
            s.low_m + 1.0e5,
            "0.001 to 1e5 m above low_m",
        )?;
        in_range("reference_height_m", s.reference_height_m, -FAR, FAR, "-1e7 to 1e7 m")?;
        in_range(
            "drift",
            s.drift.length(),
            0.0,
            MAX_DRIFT,
            "up to 27 m per metre of fall",
        )?;
        let texel_m = s.extent_m / f64::from(s.texels);
        let centre = project(s.centre, s.reference_height_m, s.drift);
        let corner = ((centre - 0.5 * s.extent_m) / texel_m).round() * texel_m;
        Ok(Self {
            corner,
            texel_m,
            settings,
        })
    }

    /// What the map was made from.
    #[must_use]
    pub fn settings(&self) -> &ShearedOrthographicSettings {
        &self.settings
    }

    /// Corner of texel (0, 0) in the projected plane: the origin of look-ups. Units: m.
    #[must_use]
    pub fn corner(&self) -> DVec2 {
        self.corner
    }

    /// Side of a texel. Units: m.
    #[must_use]
    pub fn texel_m(&self) -> f64 {
        self.texel_m
    }

    /// Where a camera with this projection stands: on the mean ray through the map's centre, at `high_m`. Units: m.
    #[must_use]
    pub fn camera_position(&self) -> DVec3 {
        let s = &self.settings;
        let at = self.corner + 0.5 * s.extent_m - (s.high_m - s.reference_height_m) * s.drift;
        DVec3::new(at.x, s.high_m, at.y)
    }

    /// Its rotation: a quarter turn about X, from looking along −Z to looking along −Y.
    #[must_use]
    pub fn camera_rotation(&self) -> DQuat {
        // sin and cos of 45°, exact to the last bit, instead of a call that differs per platform.
        let half = core::f64::consts::FRAC_1_SQRT_2;
        DQuat::from_xyzw(-half, 0.0, 0.0, half)
    }

    /// World to view, for positions given relative to `world_origin` (0 where the world is not re-based).
    ///
    /// Columns: x → (1, 0, 0), y → (0, 0, 1), z → (0, −1, 0), translation −(rotated camera position).
    #[must_use]
    pub fn view_from_world(&self, world_origin: DVec3) -> Mat4 {
        self.view_from_world_f64(world_origin).as_mat4()
    }

    fn view_from_world_f64(&self, world_origin: DVec3) -> DMat4 {
        let c = self.camera_position() - world_origin;
        DMat4::from_cols(DVec4::X, DVec4::Z, -DVec4::Y, DVec4::new(-c.x, c.z, -c.y, 1.0))
    }

    /// View to clip, the shear included.
    ///
    /// With a = 2/extent, b = 1/(high − low): column 0 (a, 0, 0, 0), column 1 (0, a, 0, 0),
    /// column 2 (a·drift.x, −a·drift.z, b, 0), column 3 (0, 0, 1, 1).
    #[must_use]
    pub fn clip_from_view(&self) -> Mat4 {
        self.clip_from_view_f64().as_mat4()
    }

    fn clip_from_view_f64(&self) -> DMat4 {
        let s = &self.settings;
        let (a, b) = (2.0 / s.extent_m, 1.0 / (s.high_m - s.low_m));
        DMat4::from_cols(
            DVec4::new(a, 0.0, 0.0, 0.0),
            DVec4::new(0.0, a, 0.0, 0.0),
            DVec4::new(a * s.drift.x, -a * s.drift.y, b, 0.0),
            DVec4::new(0.0, 0.0, 1.0, 1.0),
        )
    }

    /// World to clip, for positions given relative to `world_origin`; composed in double precision.
    ///
    /// Error: 4e-6 of the map at the origin.
    #[must_use]
    pub fn clip_from_world(&self, world_origin: DVec3) -> Mat4 {
        (self.clip_from_view_f64() * self.view_from_world_f64(world_origin)).as_mat4()
    }

    /// Height of a depth value. Units: m.
    #[must_use]
    pub fn height_from_depth(&self, depth: f32) -> f64 {
        let s = &self.settings;
        s.low_m + f64::from(depth) * (s.high_m - s.low_m)
    }

    /// Texture coordinate of a world point: (0, 0) at the corner, (1, 1) at the far end.
    #[must_use]
    pub fn texture_uv(&self, point: DVec3) -> DVec2 {
        let s = &self.settings;
        (project(point, s.reference_height_m, s.drift) - self.corner) / s.extent_m
    }

    /// Whether a point and everything within `reach_m` of it in the projected plane lies inside the map.
    #[must_use]
    pub fn holds(&self, point: DVec3, reach_m: f64) -> bool {
        let s = &self.settings;
        let q = project(point, s.reference_height_m, s.drift) - self.corner;
        q.min_element() >= reach_m && q.max_element() <= s.extent_m - reach_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hash::{pcg3d, unit_f32};
    use glam::Vec4;

    fn map(centre: DVec3, drift: DVec2) -> ShearedOrthographic {
        let settings = ShearedOrthographicSettings {
            centre,
            extent_m: 64.0,
            texels: 512,
            low_m: -4.0,
            high_m: 28.0,
            drift,
            ..Default::default()
        };
        ShearedOrthographic::new(settings).unwrap()
    }

    /// The documented formula, typed from the text.
    fn expected_clip(m: &ShearedOrthographic, p: DVec3) -> DVec3 {
        let s = m.settings();
        let qx = p.x + (p.y - s.reference_height_m) * s.drift.x;
        let qz = p.z + (p.y - s.reference_height_m) * s.drift.y;
        let u = (qx - m.corner().x) / s.extent_m;
        let v = (qz - m.corner().y) / s.extent_m;
        DVec3::new(2.0 * u - 1.0, 1.0 - 2.0 * v, (p.y - s.low_m) / (s.high_m - s.low_m))
    }

    #[test]
    fn matrix_is_the_sheared_projection() {
        for (drift, centre, tolerance) in [
            (DVec2::ZERO, DVec3::new(3.0, 1.0, -7.0), 4.0e-6),
            (DVec2::new(1.69, -0.8), DVec3::new(3.0, 1.0, -7.0), 4.0e-6),
            (DVec2::new(-3.38, 0.4), DVec3::new(-200.0, 9.0, 50.0), 4.0e-5),
        ] {
            let m = map(centre, drift);
            for i in 0..200 {
                let h = pcg3d([i, 1, 2]).map(|v| f64::from(unit_f32(v)) - 0.5);
                let p = centre + DVec3::new(40.0 * h[0], 20.0 * h[1], 40.0 * h[2]);
                let clip = m.clip_from_world(DVec3::ZERO) * p.as_vec3().extend(1.0);
                let split = m.clip_from_view() * (m.view_from_world(DVec3::ZERO) * p.as_vec3().extend(1.0));
                let expected = expected_clip(&m, p);
                assert_eq!(clip.w, 1.0);
                assert!(
                    (clip.truncate().as_dvec3() - expected).length() < tolerance,
                    "{clip} {expected}"
                );
                assert!((split - clip).length() < 2.0 * tolerance as f32, "{split} {clip}");
                let back = m.height_from_depth(clip.z);
                assert!((back - p.y).abs() < 32.0 * tolerance, "{back} {}", p.y);
                // A wrong sign of the shear is seen.
                if drift != DVec2::ZERO && (p.y - 28.0).abs() > 1.0 {
                    let wrong = map(centre, -drift).clip_from_world(DVec3::ZERO) * p.as_vec3().extend(1.0);
                    assert!((wrong.truncate().as_dvec3() - expected).length() > 100.0 * tolerance);
                }
            }
        }
    }

    #[test]
    fn view_is_the_cameras_inverse_pose() {
        let m = map(DVec3::new(10.0, 2.0, 5.0), DVec2::new(1.0, 0.5));
        let pose = DMat4::from_rotation_translation(m.camera_rotation(), m.camera_position());
        let identity = m.view_from_world(DVec3::ZERO).as_dmat4() * pose;
        assert!(identity.abs_diff_eq(DMat4::IDENTITY, 1.0e-6), "{identity}");
        let forward = m.camera_rotation() * DVec3::NEG_Z;
        assert!((forward - DVec3::NEG_Y).length() < 1.0e-12);
        // One ray of rain falls into one texel, and depth 1 is the top.
        let top = m.clip_from_world(DVec3::ZERO) * m.camera_position().as_vec3().extend(1.0);
        assert!((top - Vec4::new(0.0, 0.0, 1.0, 1.0)).length() < 1.0e-5, "{top}");
    }

    #[test]
    fn texels_stay_in_the_world_when_the_centre_moves() {
        let drift = DVec2::new(0.845, -0.3);
        let a = map(DVec3::new(1.0, 0.0, 2.0), drift);
        for i in 1..50 {
            let b = map(
                DVec3::new(1.0 + 0.037 * f64::from(i), 0.1, 2.0 - 0.11 * f64::from(i)),
                drift,
            );
            let texels = (b.corner() - a.corner()) / a.texel_m();
            assert!((texels - texels.round()).length() < 1.0e-9, "{texels}");
            let centre_uv = b.texture_uv(b.settings().centre);
            assert!((centre_uv - 0.5).length() * 512.0 < 0.75, "{centre_uv}");
        }
    }

    #[test]
    fn relative_matrix_keeps_precision_far_away() {
        let far = DVec3::new(100_000.0, 0.0, -100_000.0);
        let near = map(DVec3::ZERO, DVec2::new(1.0, 0.0));
        let m = map(far, DVec2::new(1.0, 0.0));
        assert!(
            m.clip_from_world(far)
                .abs_diff_eq(near.clip_from_world(DVec3::ZERO), 1.0e-6)
        );
        assert!(m.holds(far, 30.0) && !m.holds(far, 33.0) && !m.holds(DVec3::ZERO, 0.0));
    }

    #[test]
    fn snapped_direction_is_near_and_rarely_changes() {
        assert_eq!(FallSlope::new(DVec2::ZERO, 0.169).unwrap().snapped_drift(), DVec2::ZERO);
        let mut distinct = std::collections::BTreeSet::new();
        for i in 0..2000 {
            let speed = 0.02 * f64::from(i);
            let wind = DVec2::new(ops::cos(f64::from(i)), ops::sin(f64::from(i))) * speed;
            let slope = FallSlope::new(wind, 0.169).unwrap();
            let snapped = FallSlope::new(slope.snapped_drift() / 0.169, 0.169).unwrap();
            assert!(slope.angle_to(&snapped).to_degrees() < 0.36, "{wind}");
            let straight = FallSlope::new(DVec2::new(0.005 * f64::from(i), 0.0), 0.169).unwrap();
            distinct.insert(straight.snapped_drift().x.to_bits());
        }
        // 0 to 10 m/s is 59.4°: 119 lattice directions.
        assert_eq!(distinct.len(), 120);
        let storm = FallSlope::new(DVec2::new(60.0, 60.0), 0.268).unwrap().snapped_drift();
        assert!(storm.is_finite());
    }

    #[test]
    fn class_mean_is_flux_weighted() {
        let slope = FallSlope::from_classes(DVec2::X, &[2.0, 8.0], &[1.0, 3.0]).unwrap();
        assert!((slope.mean_inverse_speed_s_per_m() - (0.5 + 0.375) / 4.0).abs() < 1.0e-15);
        assert!(FallSlope::from_classes(DVec2::X, &[2.0], &[1.0, 3.0]).is_err());
        assert!(FallSlope::from_classes(DVec2::X, &[], &[]).is_err());
        assert!(FallSlope::from_classes(DVec2::X, &[2.0], &[0.0]).is_err());
    }

    #[test]
    fn non_finite_input_is_refused() {
        assert!(FallSlope::new(DVec2::new(f64::NAN, 0.0), 0.169).is_err());
        assert!(FallSlope::new(DVec2::new(1.0e3, 0.0), 0.169).is_err());
        let error = FallSlope::new(DVec2::X, f64::INFINITY).unwrap_err();
        assert_eq!(
            error.to_string(),
            "mean_inverse_speed_s_per_m is inf, allowed: 0.05 to 5 s/m"
        );
        let bad = |change: fn(&mut ShearedOrthographicSettings)| {
            let mut settings = ShearedOrthographicSettings::default();
            change(&mut settings);
            ShearedOrthographic::new(settings).is_err()
        };
        assert!(!bad(|_| ()));
        assert!(bad(|s| s.centre.z = f64::NAN));
        assert!(bad(|s| s.extent_m = 0.0));
        assert!(bad(|s| s.texels = 0));
        assert!(bad(|s| s.high_m = s.low_m));
        assert!(bad(|s| s.drift = DVec2::NAN));
    }
}
