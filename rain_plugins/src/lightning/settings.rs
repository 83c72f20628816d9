//! How lightning looks.

use bevy::prelude::*;
use rain_core::error::{ConfigError, in_range};

/// How flashes are shown. When they come is [`Lightning`](rain_ecs::prelude::Lightning)'s.
#[derive(Resource, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Resource, Default)]
pub struct LightningLook {
    /// Draws channels and lights the scene; off leaves the messages.
    pub enabled: bool,
    /// Whether flashes to the ground cast shadows: a shadow map in each frame of a flash.
    pub shadows: bool,
    /// Gain on all light of flashes. Units: none. Domain: [0, 100]; 1 is physical. Default: 1.
    pub gain: f32,
}

impl Default for LightningLook {
    fn default() -> Self {
        Self {
            enabled: true,
            shadows: true,
            gain: 1.0,
        }
    }
}

impl LightningLook {
    /// These settings, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not finite or outside its domain.
    pub fn validated(self) -> Result<Self, ConfigError> {
        in_range("gain", self.gain.into(), 0.0, 100.0, "0 to 100")?;
        Ok(self)
    }
}
