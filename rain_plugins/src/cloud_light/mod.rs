//! Clouds of the rain, which dim and colour the scene's light.
//!
//! Off by default: without [`CloudLight`] on a light or a camera nothing is changed.

use bevy::light::{DirectionalLight, EnvironmentMapLight, Skybox};
use bevy::prelude::*;
use rain_core::error::{ConfigError, in_range};
use rain_core::optics::{
    CLOUD_ASYMMETRY, CLOUD_DROP_RADIUS_M, RAIN_COLUMN_M, cloud_optical_depth, cloud_transmittance, cloud_water_kg_m2,
};
use rain_ecs::prelude::*;

use crate::held::{Held, keep_good};
use crate::rainfall::{RainView, ViewPlace, leading_view};

/// Put on a [`DirectionalLight`], or on a camera with an [`EnvironmentMapLight`] or a [`Skybox`]: the water of the cloud over
/// the leading view's rain takes its light out.
///
/// The sun loses what does not come straight through; the sky is taken for that of the lightest rain and gets as much
/// darker as the cloud over this rain is. What the app sets stays the light without rain: it may go on changing it.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default)]
#[require(CloudLightState)]
pub struct CloudLight {
    /// How much of the dimming is shown. Units: none. Domain: [0, 1]. Default: 1.
    pub strength: f32,
    /// How much of the sun and the sky the cloud covers. Units: none. Domain: [0, 1]. Default: 1.
    pub cover: f32,
    /// Depth of the rain column. Units: m. Domain: [0, 20 000]. Default: 3000.
    pub column_m: f32,
    /// What a directional light's colour is multiplied by where none of its light came through; less where more did.
    /// Linear, each in [0, 10]. Default: white: clouds of water are grey.
    pub tint: LinearRgba,
    /// How long clouds take to gather or to break. Units: s. Domain: [0, 10⁶]. Default: 60.
    pub transition_s: f32,
}

impl Default for CloudLight {
    fn default() -> Self {
        Self {
            strength: 1.0,
            cover: 1.0,
            column_m: RAIN_COLUMN_M as f32,
            tint: LinearRgba::WHITE,
            transition_s: 60.0,
        }
    }
}

impl CloudLight {
    /// These settings, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not finite or outside its domain.
    pub fn validated(self) -> Result<Self, ConfigError> {
        in_range("strength", self.strength.into(), 0.0, 1.0, "0 to 1")?;
        in_range("cover", self.cover.into(), 0.0, 1.0, "0 to 1")?;
        in_range("column_m", self.column_m.into(), 0.0, 2e4, "0 to 20000 m")?;
        in_range("transition_s", self.transition_s.into(), 0.0, 1e6, "0 to 1e6 s")?;
        for value in [self.tint.red, self.tint.green, self.tint.blue] {
            in_range("tint", value.into(), 0.0, 10.0, "0 to 10")?;
        }
        Ok(self)
    }

    /// Optical depth of the cloud over rain of this rate (mm/h).
    fn depth(&self, rate_mm_h: f64) -> f64 {
        cloud_optical_depth(cloud_water_kg_m2(rate_mm_h, self.column_m.into()), CLOUD_DROP_RADIUS_M)
    }

    /// What the sun keeps under a cloud of this depth, towards the vertical by this cosine.
    fn sun(&self, depth: f64, cosine: f64) -> f64 {
        let lost = 1.0 - (-depth / cosine.max(0.01)).exp();
        1.0 - f64::from(self.strength * self.cover) * lost
    }

    /// What the sky keeps under a cloud of this depth.
    fn sky(&self, depth: f64) -> f64 {
        let light = |depth| cloud_transmittance(depth, CLOUD_ASYMMETRY);
        let kept = light(depth) / light(self.depth(0.0));
        1.0 - f64::from(self.strength * self.cover) * (1.0 - kept)
    }
}

/// How far the clouds have gathered about what carries [`CloudLight`], and the light without them, which comes back when
/// that is removed.
#[derive(Component, Clone, Debug, Default)]
pub struct CloudLightState {
    settings: CloudLight,
    /// Whether the settings were ever looked at.
    known: bool,
    share: f64,
    rate_mm_h: f64,
    illuminance: Held<f32>,
    colour: Held<Vec3>,
    environment: Held<f32>,
    sky: Held<f32>,
}

impl CloudLightState {
    /// How far they have gathered. Units: none. In [0, 1].
    #[must_use]
    pub fn share(&self) -> f64 {
        self.share
    }

    /// Follows the rain; a first look takes it as it is, once time goes on: before that there is no weather yet.
    fn advance(&mut self, rate_mm_h: f64, dt_s: f64) {
        let raining = rate_mm_h > 0.0;
        if !self.known {
            (self.known, self.share, self.rate_mm_h) = (dt_s > 0.0, f64::from(u8::from(raining)), rate_mm_h);
            return;
        }
        let time = f64::from(self.settings.transition_s);
        let step = if time > 0.0 { (dt_s / time).clamp(0.0, 1.0) } else { 1.0 };
        self.share = (self.share + if raining { step } else { -step }).clamp(0.0, 1.0);
        // Clouds that break keep their depth.
        if raining {
            self.rate_mm_h += (rate_mm_h - self.rate_mm_h) * step;
        }
    }
}

/// Clouds that dim the light of all that carry [`CloudLight`].
pub struct CloudLightPlugin;

impl Plugin for CloudLightPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<CloudLight>()
            .add_systems(PostUpdate, dim)
            .add_observer(restore);
    }
}

type Dimmed = (
    Entity,
    Ref<'static, CloudLight>,
    &'static mut CloudLightState,
    Option<(&'static mut DirectionalLight, &'static Transform)>,
    Option<&'static mut EnvironmentMapLight>,
    Option<&'static mut Skybox>,
);

/// Gives the light back that clouds have taken.
fn restore(
    removed: On<Remove, CloudLight>,
    mut lights: Query<(
        &mut CloudLightState,
        Option<&mut DirectionalLight>,
        Option<&mut EnvironmentMapLight>,
        Option<&mut Skybox>,
    )>,
) {
    let Ok((mut state, sun, environment, sky)) = lights.get_mut(removed.entity) else {
        return;
    };
    let mut held = std::mem::take(&mut *state);
    if let Some(mut sun) = sun {
        let linear = sun.color.to_linear();
        let colour = Vec3::new(linear.red, linear.green, linear.blue);
        if let Some(own) = held.illuminance.take_back(sun.illuminance) {
            sun.illuminance = own;
        }
        if let Some(own) = held.colour.take_back(colour) {
            sun.color = Color::linear_rgb(own.x, own.y, own.z);
        }
    }
    if let Some(mut environment) = environment
        && let Some(own) = held.environment.take_back(environment.intensity)
    {
        environment.intensity = own;
    }
    if let Some(mut sky) = sky
        && let Some(own) = held.sky.take_back(sky.brightness)
    {
        sky.brightness = own;
    }
}

pub(crate) fn dim(
    clock: Res<RainClock>,
    rain: RainQueries,
    views: Query<(Entity, &Camera, ViewPlace), With<RainView>>,
    mut errors: MessageWriter<RainConfigError>,
    mut before_s: Local<Option<f64>>,
    mut lights: Query<Dimmed>,
) {
    let now = clock.now_s();
    let dt = (now - before_s.replace(now).unwrap_or(now)).max(0.0);
    if lights.is_empty() {
        return;
    }
    let rate = leading_view(views).map_or(0.0, |view| rain.rain_at(view.place().as_dvec3()));
    for (entity, settings, mut state, sun, environment, sky) in &mut lights {
        let state = &mut *state;
        if settings.is_changed() {
            keep_good(settings.validated(), &mut state.settings, entity, &mut errors);
        }
        state.advance(rate, dt);
        let settings = state.settings;
        let depth = settings.depth(state.rate_mm_h);
        let share = state.share;
        let gathered = |kept: f64| (1.0 - share * (1.0 - kept)) as f32;
        if let Some((mut sun, place)) = sun {
            let kept = gathered(settings.sun(depth, f64::from(place.back().y)));
            if let Some(lux) = state.illuminance.write(sun.illuminance, |own| own * kept) {
                sun.illuminance = lux;
            }
            let linear = sun.color.to_linear();
            let LinearRgba { red, green, blue, .. } = settings.tint;
            let tint = Vec3::ONE.lerp(Vec3::new(red, green, blue), 1.0 - kept);
            let colour = Vec3::new(linear.red, linear.green, linear.blue);
            if let Some(colour) = state.colour.write(colour, |own| own * tint) {
                sun.color = Color::linear_rgb(colour.x, colour.y, colour.z);
            }
        }
        let kept = gathered(settings.sky(depth));
        if let Some(mut environment) = environment
            && let Some(value) = state.environment.write(environment.intensity, |own| own * kept)
        {
            environment.intensity = value;
        }
        if let Some(mut sky) = sky
            && let Some(value) = state.sky.write(sky.brightness, |own| own * kept)
        {
            sky.brightness = value;
        }
    }
}
