//! What surfaces show of the weather this frame.

use bevy::prelude::*;
use rain_ecs::prelude::*;

use crate::rainfall::RainView;
use crate::render_adapter::WetSurfaceHandles;

/// The class whose wetness every material shows.
const CLASS: SurfaceClass = SurfaceClass::Asphalt;

/// Wetness for the shaders, taken from the weather once a frame.
#[derive(Resource, Clone, Debug)]
pub struct SurfaceState {
    /// x: wetness 0…1, y: water level mm, z: texture depth mm, w: unused.
    pub state: Vec4,
    /// Origin of the eye-relative positions in the buffer. Units: m, world.
    pub anchor: Vec3,
    /// Something is wet, or rain falls.
    pub wet: bool,
    /// The buffer that the shaders read.
    pub handles: WetSurfaceHandles,
}

pub(super) fn create_state(mut commands: Commands, handles: Option<Res<WetSurfaceHandles>>) {
    if let Some(handles) = handles {
        commands.insert_resource(SurfaceState {
            state: Vec4::ZERO,
            anchor: Vec3::ZERO,
            wet: false,
            handles: handles.clone(),
        });
    }
}

pub(super) fn follow_weather(
    mut surface: ResMut<SurfaceState>,
    clock: Res<RainClock>,
    active: Res<ActiveWeather>,
    weather: Query<&WeatherState>,
    views: Query<(&GlobalTransform, &Camera), With<RainView>>,
) {
    let eye = views.iter().find(|(_, c)| c.is_active).map(|(t, _)| t.translation());
    surface.anchor = eye.unwrap_or(surface.anchor);
    let state = active.entity().and_then(|entity| weather.get(entity).ok());
    let Some(weather) = state else {
        surface.wet = false;
        return;
    };
    // Soils stay damp for days; what is shown is the class below.
    surface.wet = weather.conditions().intensity_mm_h > 0.0
        || weather.wetness(CLASS) > 0.0
        || weather.water_level_mm(CLASS) > 0.0;
    surface.state = Vec4::new(
        weather.wetness_at(CLASS, clock.interpolation()) as f32,
        weather.water_level_mm_at(CLASS, clock.interpolation()) as f32,
        weather.surfaces().properties(CLASS).texture_depth_mm as f32,
        0.0,
    );
}
