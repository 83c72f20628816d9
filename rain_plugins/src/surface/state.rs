//! What surfaces show of the weather this frame.

use bevy::prelude::*;
use rain_core::surface::film_wave_speed_of_mm;
use rain_ecs::prelude::*;

use super::materials::SurfaceWetting;
use super::paint::{NoisePuddles, PuddlePaint};
use super::water::WaterLevels;
use crate::rainfall::{RainView, ViewPlace, leading_view};
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
    /// Speed of wavelets on a film of 1 mm down a slope of sine 1. Units: m/s.
    pub flow_m_s: f32,
    /// Where the air goes, horizontally (x, z). Units: m/s.
    pub wind_m_s: Vec2,
    /// Its speed, gusts included. Units: m/s.
    pub gusty_m_s: f32,
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
    /// Water that artists placed shows: fixed or painted puddles, or those of noise, that their levels fill.
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
            flow_m_s: 0.0,
            wind_m_s: Vec2::ZERO,
            gusty_m_s: 0.0,
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
    views: Query<(Entity, &Camera, ViewPlace), With<RainView>>,
    painted: Query<&PuddlePaint>,
    noises: Query<&NoisePuddles>,
    refined: Query<&SurfaceWetting>,
    levels: Res<WaterLevels>,
    areas: Option<Res<RainAreas>>,
    field: Option<Res<RainfallField>>,
    ground: Option<Res<SurfaceGround>>,
    mut after_areas: Local<bool>,
) {
    let fixed = refined.iter().any(|wetting| wetting.state.is_some());
    surface.shown = !painted.is_empty() || fixed || refined.iter().any(SurfaceWetting::is_by_hand);
    let eye = leading_view(views).map(|view| view.place());
    surface.anchor = eye.unwrap_or(surface.anchor);
    let state = active.entity().and_then(|entity| weather.get(entity).ok());
    let puddles = refined.iter().any(|w| {
        matches!(
            w.state,
            Some(rain_core::surface::SurfaceState::Drenched | rain_core::surface::SurfaceState::Puddle)
        )
    });
    let Some(weather) = state else {
        surface.wet = false;
        surface.by_hand = WaterByHand::default();
        (surface.state, surface.artist) = (Vec4::ZERO, Vec4::ZERO);
        surface.placed = puddles || placed_water(Vec4::ZERO, painted.iter(), noises.iter());
        surface.shown |= surface.placed;
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
    let manning_n = weather.surfaces().properties(CLASS).manning_n;
    surface.flow_m_s = film_wave_speed_of_mm(manning_n) as f32;
    let artist = weather.shown_levels();
    surface.by_hand = *weather.by_hand();
    surface.artist = Vec4::new(
        artist.wetness as f32,
        artist.holes as f32,
        artist.puddles as f32,
        f32::from(u8::from(weather.mode() == WeatherMode::Artist)),
    );
    surface.placed = puddles || placed_water(surface.artist, painted.iter(), noises.iter());
    surface.shown |= surface.placed;
    let wind = weather.conditions().wind_m_s;
    surface.wind_m_s = Vec2::new(wind.x as f32, wind.z as f32);
    surface.gusty_m_s = field.map_or(surface.wind_m_s.length(), |field| {
        field.wind_m_s().with_y(0.0).length() as f32
    });
    let seconds = clock.now_s() + f64::from(clock.interpolation()) * clock.tick_ns() as f64 / 1e9;
    surface.time_s = (seconds % WAVE_PERIOD_S) as f32;
    surface.seconds = seconds;
}

/// Whether any puddle that an artist has placed may hold water.
fn placed_water<'a>(
    artist: Vec4,
    paints: impl Iterator<Item = &'a PuddlePaint>,
    mut noises: impl Iterator<Item = &'a NoisePuddles>,
) -> bool {
    let (holes, puddles) = (artist.y, artist.z);
    let mut painted = paints
        .filter(|p| p.validated().is_ok())
        .map(|p| p.fixed || puddles.max(p.least_flood) > 0.0 || (p.height_map && holes > 0.0));
    painted.any(|water| water) || noises.any(|noise| noise.validated().is_ok() && noise.level.unwrap_or(puddles) > 0.0)
}

#[cfg(test)]
mod tests {
    use std::slice::from_ref;

    use super::*;

    #[test]
    fn placed_puddles_hold_water_by_their_levels() {
        let water = |artist: Vec4, paint: &[PuddlePaint], noise: &[NoisePuddles]| {
            placed_water(artist, paint.iter(), noise.iter())
        };
        let (dry, wet) = (Vec4::ZERO, Vec4::new(1.0, 0.0, 0.2, 1.0));
        let paint = PuddlePaint::default();
        assert!(!water(wet, &[], &[]), "none placed");
        assert!(!water(dry, from_ref(&paint), &[NoisePuddles::default()]));
        assert!(water(wet, from_ref(&paint), &[]) && water(wet, &[], &[NoisePuddles::default()]));
        let holes = Vec4::new(1.0, 0.1, 0.0, 1.0);
        assert!(water(holes, from_ref(&paint), &[]));
        let plain = PuddlePaint {
            height_map: false,
            ..paint.clone()
        };
        assert!(!water(holes, from_ref(&plain), &[]));
        for paint in [
            PuddlePaint {
                fixed: true,
                ..plain.clone()
            },
            PuddlePaint {
                least_flood: 0.1,
                ..plain
            },
        ] {
            assert!(water(dry, &[paint], &[]));
        }
        let level = |level: f32| NoisePuddles {
            level: Some(level),
            ..default()
        };
        assert!(water(dry, &[], &[level(0.3)]) && !water(wet, &[], &[level(0.0)]));
    }
}
