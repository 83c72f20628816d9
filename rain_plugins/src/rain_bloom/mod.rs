//! Glow of bright lights in rain by the engine's own bloom, made wider.
//!
//! Off by default: without [`RainBloom`] on a camera nothing is changed.

use bevy::post_process::bloom::{Bloom, BloomCompositeMode};
use bevy::prelude::*;
use rain_core::error::{ConfigError, in_range};
use rain_core::haze::{
    EXTINCTION_EFFICIENCY, KOSCHMIEDER_CONTRAST, MAX_VISIBILITY_M, bloom_in_rain, extinction_for_visibility_per_m,
};
use rain_ecs::prelude::*;

use crate::held::{Held, keep_good};

/// Put on a camera with a [`Bloom`]: the more it rains at the camera, the more light the bloom spreads, and the farther.
///
/// It costs nothing beyond the bloom itself, knows no distances and takes in all that is bright: lamps, windows, signs, sky.
/// The lamps' glow of [`HazeSettings`](crate::haze::HazeSettings) is the physical one; where both are on, lamps glow
/// twice: set [`HazeSettings::lamps`](crate::haze::HazeSettings::lamps) to 0. What the app sets in `Bloom` stays the bloom without rain: it
/// may go on changing it. (Lagarde 2013: a larger blur in rain as a cheaper glow.)
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default)]
#[require(RainBloomState)]
pub struct RainBloom {
    /// Way through the rain that stands for that of every pixel. Units: m. Domain: [0, 10⁴]. Default: 100, a street.
    pub way_m: f32,
    /// Gain on its optical depth. Units: none. Domain: [0, 100]. Default: 1.
    pub gain: f32,
}

impl Default for RainBloom {
    fn default() -> Self {
        Self {
            way_m: 100.0,
            gain: 1.0,
        }
    }
}

impl RainBloom {
    /// These settings, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not finite or outside its domain.
    pub fn validated(self) -> Result<Self, ConfigError> {
        in_range("way_m", self.way_m.into(), 0.0, 1e4, "0 to 1e4 m")?;
        in_range("gain", self.gain.into(), 0.0, 100.0, "0 to 100")?;
        Ok(self)
    }

    /// Optical depth of the way in rain of this visibility (m). Drops' diffraction stays within a pixel: half of what they
    /// take out.
    fn depth(&self, visibility_m: f64) -> f64 {
        if visibility_m >= MAX_VISIBILITY_M {
            return 0.0;
        }
        let extinction = extinction_for_visibility_per_m(visibility_m, KOSCHMIEDER_CONTRAST) / EXTINCTION_EFFICIENCY;
        f64::from(self.gain) * f64::from(self.way_m) * extinction
    }
}

/// The bloom without rain of what carries [`RainBloom`], which comes back when that is removed.
#[derive(Component, Clone, Debug, Default)]
pub struct RainBloomState {
    /// The last settings that validated.
    settings: RainBloom,
    intensity: Held<f32>,
    boost: Held<f32>,
}

/// Bloom that grows with the rain on cameras with [`RainBloom`].
pub struct RainBloomPlugin;

impl Plugin for RainBloomPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<RainBloom>()
            .add_systems(PostUpdate, widen)
            .add_observer(restore);
    }
}

/// Gives the bloom back that rain has changed.
fn restore(removed: On<Remove, RainBloom>, mut views: Query<(&mut RainBloomState, &mut Bloom)>) {
    let Ok((mut state, mut bloom)) = views.get_mut(removed.entity) else {
        return;
    };
    if let Some(own) = state.intensity.take_back(bloom.intensity) {
        bloom.intensity = own;
    }
    if let Some(own) = state.boost.take_back(bloom.low_frequency_boost) {
        bloom.low_frequency_boost = own;
    }
}

fn widen(
    rain: RainQueries,
    mut errors: MessageWriter<RainConfigError>,
    mut views: Query<(
        Entity,
        Ref<RainBloom>,
        &mut RainBloomState,
        &GlobalTransform,
        &mut Bloom,
    )>,
) {
    for (entity, settings, mut state, place, mut bloom) in &mut views {
        let state = &mut *state;
        if settings.is_changed() {
            keep_good(settings.validated(), &mut state.settings, entity, &mut errors);
        }
        let depth = state.settings.depth(rain.visibility_at(place.translation().as_dvec3()));
        let own_boost = state.boost.own(bloom.low_frequency_boost);
        let added = bloom.composite_mode == BloomCompositeMode::Additive;
        let intensity = state.intensity.own(bloom.intensity);
        let [scatter, wide] = bloom_in_rain(intensity.into(), own_boost.into(), depth);
        // An additive bloom takes nothing out of the picture, and may be stronger than all of it.
        let scatter = if depth <= 0.0 {
            intensity
        } else if added {
            intensity + bloom_in_rain(0.0, 1.0, depth)[0] as f32
        } else {
            scatter as f32
        };
        if let Some(value) = state.intensity.write(bloom.intensity, |_| scatter) {
            bloom.intensity = value;
        }
        let wide = if depth > 0.0 { wide as f32 } else { own_boost };
        if let Some(value) = state.boost.write(bloom.low_frequency_boost, |_| wide) {
            bloom.low_frequency_boost = value;
        }
    }
}
