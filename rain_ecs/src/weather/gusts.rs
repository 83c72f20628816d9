//! Gusts in the weather's wind.

use bevy_ecs::change_detection::DetectChanges;
use bevy_ecs::prelude::*;
use bevy_math::DVec2;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use rain_core::weather::{GustModel, GustSettings};

use super::components::Weather;
use super::systems::ActiveWeather;
use crate::error::RainConfigError;
use crate::seed::RainSeed;

/// Has the wind of its [`Weather`] swing about its mean: rain sways, glass is hit unevenly, waves come and go. Without it
/// the wind is steady and nothing is computed.
///
/// A closed form of the seed and the time. Checked like [`Weather`].
#[derive(Component, Reflect, Debug, Clone, Copy, PartialEq, Default)]
#[reflect(opaque)]
#[reflect(Component, Debug, Clone, PartialEq, Default)]
#[require(Weather)]
pub struct Gusts(pub GustSettings);

/// The gusts in force; there is none while no [`Gusts`] count.
#[derive(Resource, Debug, Clone, Default, PartialEq)]
pub struct GustState {
    model: Option<GustModel>,
    seed: u64,
    of: Option<Entity>,
    /// Of the last settings that were valid.
    pub(crate) settings: GustSettings,
}

impl GustState {
    /// Gusts as a function of the rain clock's time, as shares of the mean wind.
    #[must_use]
    pub fn model(&self) -> Option<&GustModel> {
        self.model.as_ref()
    }

    /// The air's mean gust over an interval of the rain clock (s), as shares of the mean wind; 0 without gusts.
    #[must_use]
    pub fn mean(&self, from_s: f64, to_s: f64) -> DVec2 {
        self.model
            .as_ref()
            .map_or(DVec2::ZERO, |model| model.mean(from_s, to_s, 0.0))
    }
}

/// Whether there are gusts, or were.
pub(super) fn gusts_are_used(gusts: Query<(), With<Gusts>>, state: Res<GustState>) -> bool {
    state.model.is_some() || !gusts.is_empty()
}

/// Takes over what the user changed, if it is valid.
pub(super) fn follow_gusts(
    active: Res<ActiveWeather>,
    seed: Res<RainSeed>,
    gusts: Query<Ref<Gusts>>,
    mut state: ResMut<GustState>,
    mut errors: MessageWriter<RainConfigError>,
) {
    let Some((entity, gusts)) = active.entity().and_then(|e| Some((e, gusts.get(e).ok()?))) else {
        *state = GustState::default();
        return;
    };
    let fresh = state.of != Some(entity);
    if !fresh && !gusts.is_changed() && state.seed == seed.0 {
        return;
    }
    if fresh {
        *state = GustState::default();
    }
    match GustModel::new(&gusts.0, seed.0) {
        Ok(model) => {
            state.model = Some(model);
            state.settings = gusts.0;
        }
        Err(error) => {
            if fresh || gusts.is_changed() {
                errors.write(RainConfigError { entity, error });
            }
            // The last good ones under the present seed.
            if state.model.is_some() {
                state.model = GustModel::new(&state.settings, seed.0).ok();
            }
        }
    }
    state.of = Some(entity);
    state.seed = seed.0;
}
