//! Feet that come down in water (Lagarde 2013: E47, E48).

use bevy_ecs::prelude::*;
use bevy_math::{DVec3, Vec3};
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_time::Time;
use bevy_transform::components::{GlobalTransform, Transform};
use rain_core::splash::foot_splash_strength;
use rain_core::surface::artist_look::painted_puddle_water;

use crate::queries::{RainQueries, SurfaceSound};
use crate::weather::{ActiveWeather, WeatherState};

/// A foot comes down. Written by the app, or by a [`Foot`].
#[derive(Message, Debug, Clone, Copy, PartialEq)]
pub struct FootStep {
    /// The foot's entity, if it has one.
    pub foot: Option<Entity>,
    /// Where it meets the ground. Units: m, world.
    pub place: Vec3,
    /// How fast it comes down. Units: m/s. Default: 1, a walker's.
    pub speed_m_s: f32,
    /// What is painted where it steps, if it is a painted mesh.
    pub painted: Option<PaintedStep>,
}

/// A step on a mesh whose puddles are painted: it floods by the artists' level of the weather.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaintedStep {
    /// The green channel there: 0 floods first, 1 never. Domain: [0, 1].
    pub depth: f32,
    /// Flood level over which the rim fills. Domain: (0, 1]. Default: 0.4.
    pub margin: f32,
    /// Depth of a full puddle. Units: m. Domain: [0, 1]. Default: 0.01.
    pub full_depth_m: f32,
}

impl Default for PaintedStep {
    fn default() -> Self {
        Self {
            depth: 1.0,
            margin: 0.4,
            full_depth_m: 0.01,
        }
    }
}

impl FootStep {
    /// A walker's step on ground that is not painted.
    #[must_use]
    pub fn at(place: Vec3) -> Self {
        Self {
            foot: None,
            place,
            speed_m_s: 1.0,
            painted: None,
        }
    }
}

/// A foot splashes: for sounds, effects and waves.
#[derive(Message, Debug, Clone, Copy, PartialEq)]
pub struct FootSplash {
    /// The foot's entity, if it has one.
    pub foot: Option<Entity>,
    /// Where. Units: m, world.
    pub place: Vec3,
    /// Depth of the water there. Units: m.
    pub depth_m: f32,
    /// How strong ([`foot_splash_strength`]). Units: none. In (0, 1].
    pub strength: f32,
    /// What the step sounds like.
    pub sound: SurfaceSound,
}

/// When a step splashes.
#[derive(Resource, Reflect, Debug, Clone, Copy, PartialEq)]
#[reflect(Resource, Default)]
pub struct FootSplashSettings {
    /// Water must be this deep. Units: m. Default: 0.003. What is not a number: nothing splashes.
    pub least_depth_m: f32,
    /// This share of the rain must reach the place: under cover nothing splashes. Units: none. Default: 0.5.
    pub least_exposure: f32,
}

impl Default for FootSplashSettings {
    fn default() -> Self {
        Self {
            least_depth_m: 0.003,
            least_exposure: 0.5,
        }
    }
}

/// Put on a foot: it steps where it comes down and stops. Where it does so beside the ground, in the air, nothing
/// splashes.
#[derive(Component, Reflect, Debug, Clone, Copy, PartialEq)]
#[reflect(Component, Default)]
#[require(Transform)]
pub struct Foot {
    /// Height of the origin above the sole. Units: m. Default: 0.
    pub above_sole_m: f32,
    #[reflect(ignore)]
    before: Option<Vec3>,
    /// Speed with which it was last seen to come down; 0 while it stands or rises. Units: m/s.
    #[reflect(ignore)]
    falling_m_s: f32,
}

impl Default for Foot {
    fn default() -> Self {
        Self::with_origin_above(0.0)
    }
}

/// A foot that comes down slower is set down, not stepped with. Units: m/s.
const LEAST_SPEED_M_S: f32 = 0.1;
/// A way longer than this in one frame is a leap, not a step. Units: m.
const LEAP_M: f32 = 5.0;

impl Foot {
    /// A foot whose origin is so far above its sole. Units: m.
    #[must_use]
    pub fn with_origin_above(above_sole_m: f32) -> Self {
        Self {
            above_sole_m,
            before: None,
            falling_m_s: 0.0,
        }
    }

    /// The speed with which it came down, if it does so no more. Units: m/s.
    fn moved(&mut self, sole: Vec3, seconds: f32) -> Option<f32> {
        if !sole.is_finite() {
            self.before = None;
            return None;
        }
        let way = sole - self.before.replace(sole)?;
        if way.length() > LEAP_M {
            self.falling_m_s = 0.0;
            return None;
        }
        let down = -way.y / seconds;
        if down >= LEAST_SPEED_M_S {
            self.falling_m_s = self.falling_m_s.max(down);
            return None;
        }
        let speed = std::mem::take(&mut self.falling_m_s);
        (speed > 0.0).then_some(speed)
    }
}

/// Writes a step for every foot that has come down.
pub(super) fn find_steps(
    time: Option<Res<Time>>,
    mut feet: Query<(Entity, &GlobalTransform, &mut Foot)>,
    mut steps: MessageWriter<FootStep>,
) {
    let seconds = time.map_or(0.0, |time| time.delta_secs());
    // Nothing moves while no time passes.
    if seconds <= 0.0 {
        return;
    }
    for (entity, pose, mut foot) in &mut feet {
        let foot = foot.bypass_change_detection();
        let place = pose.translation() - foot.above_sole_m * Vec3::Y;
        if let Some(speed_m_s) = foot.moved(place, seconds) {
            steps.write(FootStep {
                foot: Some(entity),
                speed_m_s,
                ..FootStep::at(place)
            });
        }
    }
}

/// Answers every step in enough water that rain can reach.
pub(super) fn splash(
    settings: Res<FootSplashSettings>,
    queries: RainQueries,
    active: Option<Res<ActiveWeather>>,
    weather: Query<&WeatherState>,
    mut steps: MessageReader<FootStep>,
    mut splashes: MessageWriter<FootSplash>,
) {
    if steps.is_empty() {
        return;
    }
    let weather = active.and_then(|active| weather.get(active.entity()?).ok());
    for step in steps.read() {
        let painted = step.painted.zip(weather).map_or(0.0, |(paint, weather)| {
            let level = weather.shown_levels().puddles;
            let water = painted_puddle_water(level, f64::from(paint.depth), f64::from(paint.margin));
            water * f64::from(paint.full_depth_m.clamp(0.0, 1.0))
        });
        let depth = queries.water_depth_at(DVec3::from(step.place)).max(painted);
        let strength = foot_splash_strength(f64::from(step.speed_m_s), depth);
        let deep = depth >= f64::from(settings.least_depth_m);
        if deep && strength > 0.0 && queries.exposed_at(step.place) >= settings.least_exposure {
            splashes.write(FootSplash {
                foot: step.foot,
                place: step.place,
                depth_m: depth as f32,
                strength: strength as f32,
                sound: queries.surface_sound_at(step.place),
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_foot_steps_where_it_comes_down_and_stops() {
        let mut foot = Foot::default();
        let mut at = |y: f32| foot.moved(Vec3::new(0.0, y, 0.0), 0.1);
        assert_eq!(at(0.3), None, "nothing is known of its way yet");
        assert_eq!((at(0.3), at(0.2), at(0.05)), (None, None, None));
        let speed = at(0.045).expect("it has come down");
        assert!((speed - 1.5).abs() < 1e-5, "{speed}");
        assert_eq!((at(0.045), at(0.1), at(0.3)), (None, None, None), "it rises");
        assert_eq!((at(0.2), at(60.0)), (None, None), "a leap");
        assert_eq!((at(60.0), at(f32::NAN), at(0.0), at(0.0)), (None, None, None, None));
    }
}
