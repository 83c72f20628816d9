//! The far rain that a marked camera draws this frame: the part of its haze that is shown as particles.

use std::sync::Arc;

use bevy::math::DVec2;
use bevy::prelude::*;
use rain_core::rainfall::{FarRain, FarRainSettings, FarRainView};

use crate::report::SkipReason;

/// A view's far rain at a moment.
#[derive(Clone, Debug)]
pub(crate) struct FarRainShot {
    /// Particles; never without any.
    pub rain: Arc<FarRain>,
    /// Base of the cloud over the eye. Units: m.
    pub cloud_m: f32,
    /// How far below it rain thins out. Units: m.
    pub thin_m: f32,
}

/// What a view draws of far rain this frame; extracted to the render world.
#[derive(Component, Clone, Debug, Default)]
pub struct FarRainViewFrame {
    /// `None`: nothing.
    pub(crate) shot: Option<FarRainShot>,
    /// Kept from frame to frame so that nothing is allocated.
    spare: Vec<Arc<FarRain>>,
}

impl FarRainViewFrame {
    /// The far rain of this frame with its containers; none where no area is in view from outside.
    #[must_use]
    pub fn rain(&self) -> Option<&FarRain> {
        self.shot.as_ref().map(|shot| &*shot.rain)
    }

    /// No far rain in this frame.
    pub(super) fn clear(&mut self) {
        if let Some(old) = self.shot.take() {
            self.keep(old.rain);
        }
    }

    /// Fills in the particles of a view.
    ///
    /// # Errors
    /// Why there are none.
    pub(super) fn fill(&mut self, settings: &FarRainSettings, view: &FarRainView) -> Result<&FarRain, SkipReason> {
        if settings.budget == 0 || settings.share == 0.0 {
            return Err(SkipReason::Disabled);
        }
        let free = self.spare.iter().position(|rain| Arc::strong_count(rain) == 1);
        let mut rain = free.map(|i| self.spare.swap_remove(i)).unwrap_or_default();
        if let Some(rain) = Arc::get_mut(&mut rain) {
            rain.fill(settings, view);
        }
        if rain.beyond_limit > 0 {
            warn_once!("a rain view has more than twice its budget of far rain; the rest is left out");
        }
        if rain.particles.is_empty() {
            self.keep(rain);
            return Err(SkipReason::NoRain);
        }
        let shot = FarRainShot {
            rain,
            cloud_m: view.cloud_m as f32,
            thin_m: view.thin_m as f32,
        };
        Ok(&self.shot.insert(shot).rain)
    }

    fn keep(&mut self, rain: Arc<FarRain>) {
        self.spare.push(rain);
        self.spare.truncate(3);
    }
}

/// Half the angle on the ground between the outermost azimuths of a picture and where it looks. Units: rad.
pub(super) fn half_view_rad(clip_from_view: Mat4, rotation: Quat) -> f64 {
    let (tx, ty) = (1.0 / clip_from_view.x_axis.x, 1.0 / clip_from_view.y_axis.y);
    let flat = |v: Vec3| {
        let v = rotation * v;
        DVec2::new(v.x.into(), v.z.into())
    };
    let ahead = flat(Vec3::NEG_Z);
    [(-tx, -ty), (tx, -ty), (-tx, ty), (tx, ty)]
        .into_iter()
        .map(|(x, y)| ahead.angle_to(flat(Vec3::new(x, y, -1.0))).abs())
        .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_view_is_as_wide_as_its_picture_and_a_tilted_one_wider() {
        let clip = Mat4::perspective_infinite_reverse_rh(0.8, 2.0, 0.1);
        let level = half_view_rad(clip, Quat::from_rotation_y(1.3));
        let exact = (2.0 * 0.4_f64.tan()).atan();
        assert!((level - exact).abs() < 1e-5, "{level} {exact}");
        let up = half_view_rad(clip, Quat::from_rotation_y(1.3) * Quat::from_rotation_x(0.5));
        assert!(up > level + 0.05, "{up}");
        let steep = half_view_rad(clip, Quat::from_rotation_x(1.4));
        assert!(steep > 1.5, "{steep}");
    }
}
