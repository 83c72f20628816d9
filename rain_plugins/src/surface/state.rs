//! What surfaces show of the weather this frame.

use bevy::prelude::*;
use rain_ecs::prelude::*;

use super::materials::SurfaceWetting;
use super::paint::PuddlePaint;
use super::water::WaterLevels;
use crate::rainfall::{RainView, leading_view};
use crate::render_adapter::WetSurfaceHandles;

/// After this time wind waves repeat. Units: s.
pub const WAVE_PERIOD_S: f64 = rain_render::compose::WAVE_PERIOD_S;

/// The class whose wetness every material shows.
const CLASS: SurfaceClass = SurfaceClass::Asphalt;

/// Wetness for the shaders, taken from the weather once a frame.
#[derive(Resource, Clone, Debug)]
pub struct SurfaceState {
    /// x: wetness 0…1, y: water level mm, z: texture depth mm, w: rain mm/h.
    pub state: Vec4,
    /// The artists' wetness, holes and puddles, 0…1; w: 1 when they rule.
    pub artist: Vec4,
    /// What is set by hand.
    pub by_hand: WaterByHand,
    /// Where the air goes, horizontally (x, z). Units: m/s.
    pub wind_m_s: Vec2,
    /// Time of the waves: the rain clock's, from 0 to [`WAVE_PERIOD_S`]. Units: s.
    pub time_s: f32,
    /// The same since the start. Units: s.
    pub seconds: f64,
    /// World height of the ground under the first view, where it is known. Units: m.
    pub ground_m: Option<f32>,
    /// Origin of the eye-relative positions in the buffer. Units: m, world.
    pub anchor: Vec3,
    /// Something is wet, water stands in a puddle, or rain falls.
    pub wet: bool,
    /// Wet materials are in the scene: something is wet, painted, or of a fixed state.
    pub shown: bool,
    /// A mesh shows a fixed state whatever the weather: a puddle, perhaps.
    pub placed: bool,
    /// The buffer that the shaders read.
    pub handles: WetSurfaceHandles,
}

pub(super) fn create_state(mut commands: Commands, handles: Option<Res<WetSurfaceHandles>>) {
    if let Some(handles) = handles {
        commands.insert_resource(SurfaceState {
            state: Vec4::ZERO,
            artist: Vec4::ZERO,
            by_hand: WaterByHand::default(),
            wind_m_s: Vec2::ZERO,
            time_s: 0.0,
            seconds: 0.0,
            ground_m: None,
            anchor: Vec3::ZERO,
            wet: false,
            shown: false,
            placed: false,
            handles: handles.clone(),
        });
    }
}

pub(super) fn follow_weather(
    mut surface: ResMut<SurfaceState>,
    clock: Res<RainClock>,
    active: Res<ActiveWeather>,
    weather: Query<&WeatherState>,
    views: Query<(Entity, &Camera, &GlobalTransform), With<RainView>>,
    painted: Query<(), With<PuddlePaint>>,
    refined: Query<&SurfaceWetting>,
    levels: Res<WaterLevels>,
    areas: Option<Res<RainAreas>>,
    ground: Option<Res<SurfaceGround>>,
    mut after_areas: Local<bool>,
) {
    surface.placed = refined.iter().any(|wetting| wetting.state.is_some());
    surface.shown = !painted.is_empty() || surface.placed || refined.iter().any(SurfaceWetting::is_by_hand);
    let eye = leading_view(views).map(GlobalTransform::translation);
    surface.anchor = eye.unwrap_or(surface.anchor);
    let state = active.entity().and_then(|entity| weather.get(entity).ok());
    let Some(weather) = state else {
        surface.wet = false;
        surface.by_hand = WaterByHand::default();
        return;
    };
    // Under areas the ground may be wet although the weather is dry, and stay so when they are gone.
    let areas = areas.as_deref().filter(|areas| !areas.is_uniform());
    let eye = surface.anchor.as_dvec3();
    let rain_mm_h = areas.map_or(weather.conditions().intensity_mm_h, |areas| areas.rate_at(eye));
    let wet_ground = ground.is_some_and(|ground| ground.ground().is_some_and(|ground| !ground.is_dry()));
    *after_areas = areas.is_some() || (*after_areas && wet_ground);
    // Soils stay damp for days; what is shown is the class below.
    surface.wet = areas.is_some_and(|areas| areas.highest_mm_h() > 0.0)
        || (*after_areas && wet_ground)
        || weather.conditions().intensity_mm_h > 0.0
        || weather.wetness(CLASS) > 0.0
        || weather.water_level_mm(CLASS) > 0.0
        || levels.any_water();
    surface.shown |= surface.wet;
    surface.state = Vec4::new(
        weather.wetness_at(CLASS, clock.interpolation()) as f32,
        weather.water_level_mm_at(CLASS, clock.interpolation()) as f32,
        weather.surfaces().properties(CLASS).texture_depth_mm as f32,
        rain_mm_h as f32,
    );
    let artist = weather.shown_levels();
    surface.by_hand = *weather.by_hand();
    surface.artist = Vec4::new(
        artist.wetness as f32,
        artist.holes as f32,
        artist.puddles as f32,
        f32::from(u8::from(weather.mode() == WeatherMode::Artist)),
    );
    let wind = weather.conditions().wind_m_s;
    surface.wind_m_s = Vec2::new(wind.x as f32, wind.z as f32);
    let seconds = clock.now_s() + f64::from(clock.interpolation()) * clock.tick_ns() as f64 / 1e9;
    surface.time_s = (seconds % WAVE_PERIOD_S) as f32;
    surface.seconds = seconds;
}
