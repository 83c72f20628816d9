//! Settings of a camera's glass, and what advances and shows it.

use bevy::math::DVec3;
use bevy::prelude::*;
use rain_core::constants::GRAVITY;
use rain_core::error::{ConfigError, in_range};
use rain_core::lens::{Glass, GlassForcing, GlassImpacts, GlassShape, MAX_WIPER_ARMS, WiperArm, WiperMode};
use rain_core::weather::{WeatherConditions, saturation_vapour_pressure_pa};
use rain_ecs::prelude::*;

use super::glass::{LensGlass, LensShot, Source};
use crate::cover::AirAroundView;
use crate::report::{PassName, RainReport, SkipReason};
use crate::schedule::RainViewSystems;

/// Gas constant of water vapour. Units: J/(kg K).
const VAPOUR_GAS_CONSTANT: f64 = 461.5;

/// Put on a 3D camera whose glass the rain wets. What is on the glass is that of this camera alone.
///
/// The glass stands `distance_m` before the eye, across its axis, and fills the view. Rain hits it by its own and the
/// camera's velocity and by its lean; where the cover map says that no rain falls, none does.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default)]
#[require(LensGlass)]
pub struct LensDrops {
    /// Wets and draws the glass; off takes the water away.
    pub enabled: bool,
    /// From the eye to the glass. Units: m. Domain: [0.01, 5]. Default: 0.04, a lens; a windscreen has 0.7.
    pub distance_m: f32,
    /// How far the glass leans back from upright. Units: degrees. Domain: [-90, 90]. Default: 0.
    pub lean_deg: f32,
    /// Width of the aperture that looks through it, to which drops are blurred at their edges. Units: m. Domain:
    /// [0, 0.05]. Default: 0.0006. An eye has 0.003, through which drops on a windscreen are soft spots.
    pub aperture_m: f32,
    /// Deviation of the gusts that carry drops against upright glass. Units: m/s. Domain: [0, 20]. Default: 1.
    pub gust_m_s: f32,
    /// Velocity of the glass in the world. Units: m/s. Default: none, that of the camera.
    pub velocity_m_s: Option<Vec3>,
    /// Share of the rain that reaches the glass. Domain: [0, 1]. Default: none, that of the cover map at the glass.
    pub exposure: Option<f32>,
}

impl Default for LensDrops {
    fn default() -> Self {
        Self {
            enabled: true,
            distance_m: 0.04,
            lean_deg: 0.0,
            aperture_m: 0.0006,
            gust_m_s: 1.0,
            velocity_m_s: None,
            exposure: None,
        }
    }
}

impl LensDrops {
    /// The windscreen of a car: 0.7 m before the eye, leaning back by 60°, drops sharper than an eye sees them.
    #[must_use]
    pub fn windscreen() -> Self {
        Self {
            distance_m: 0.7,
            lean_deg: 60.0,
            aperture_m: 0.001,
            ..Self::default()
        }
    }

    /// These settings, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not finite or outside its domain.
    pub fn validated(self) -> Result<Self, ConfigError> {
        in_range("distance_m", self.distance_m.into(), 0.01, 5.0, "0.01 to 5 m")?;
        in_range("lean_deg", self.lean_deg.into(), -90.0, 90.0, "-90 to 90 degrees")?;
        in_range("aperture_m", self.aperture_m.into(), 0.0, 0.05, "0 to 0.05 m")?;
        in_range("gust_m_s", self.gust_m_s.into(), 0.0, 20.0, "0 to 20 m/s")?;
        let speed = self.velocity_m_s.map_or(0.0, |v| f64::from(v.length()));
        in_range("velocity_m_s", speed, 0.0, 200.0, "a length of 0 to 200 m/s")?;
        in_range("exposure", self.exposure.unwrap_or_default().into(), 0.0, 1.0, "0 to 1")?;
        Ok(self)
    }
}

/// Wipers of a camera with [`LensDrops`], which clear their arcs.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct WindscreenWipers {
    /// How often they go; a change waits until they are at rest.
    pub mode: WiperMode,
    /// The arms, on the glass: metres from its centre. Default: two that swing together, for a windscreen at 0.7 m and
    /// a view of 50° upwards.
    pub arms: [Option<WiperArm>; MAX_WIPER_ARMS],
}

impl Default for WindscreenWipers {
    fn default() -> Self {
        let arm = |x| {
            Some(WiperArm {
                pivot_m: [x, -0.42],
                blade_m: [0.1, 0.68],
                turn_rad: [0.14, 1.75],
            })
        };
        Self {
            mode: WiperMode::Off,
            arms: [arm(-0.45), arm(0.05)],
        }
    }
}

/// Water on glass for all cameras with [`LensDrops`].
pub struct LensPlugin;

impl Plugin for LensPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<LensDrops>()
            .init_resource::<AirAroundView>()
            .add_systems(RainTick, wet_glass.in_set(RainSystems::Lens))
            .add_systems(PostUpdate, aim_lens.in_set(RainViewSystems::Views));
    }
}

/// Half of the view's width and height at a distance of 1.
fn half_tan(projection: &Projection) -> Option<Vec2> {
    let Projection::Perspective(_) = projection else {
        return None;
    };
    let clip = projection.get_clip_from_view();
    Some(Vec2::new(1.0 / clip.x_axis.x, 1.0 / clip.y_axis.y))
}

/// Vapour that the air lacks. Units: kg/m³.
fn deficit_kg_m3(conditions: &WeatherConditions) -> f64 {
    let kelvin = conditions.air_temperature_c + 273.15;
    let saturated = saturation_vapour_pressure_pa(conditions.air_temperature_c) / (VAPOUR_GAS_CONSTANT * kelvin);
    (1.0 - conditions.relative_humidity) * saturated
}

type Glazed = (
    Entity,
    &'static LensDrops,
    Option<&'static WindscreenWipers>,
    &'static Projection,
    &'static GlobalTransform,
    &'static mut LensGlass,
);

fn wet_glass(
    clock: Res<RainClock>,
    field: Res<RainfallField>,
    seed: Res<RainSeed>,
    rain: RainQueries,
    air: Res<AirAroundView>,
    active: Res<ActiveWeather>,
    weather: Query<&WeatherState>,
    mut views: Query<Glazed>,
) {
    for (entity, drops, wipers, projection, transform, mut glass) in &mut views {
        let now = clock.now_s();
        let glass = &mut *glass;
        let drops = glass.last_good(drops);
        if now < glass.now_s || !drops.enabled {
            glass.glass = Glass::new(seed.0 as u32 ^ (seed.0 >> 32) as u32);
        }
        glass.now_s = now;
        let Some(half_tan) = half_tan(projection).filter(|_| drops.enabled) else {
            continue;
        };
        let (_, rotation, eye) = transform.to_scale_rotation_translation();
        let (right, up, ahead) = (rotation * Vec3::X, rotation * Vec3::Y, rotation * Vec3::NEG_Z);
        let (sin, cos) = drops.lean_deg.to_radians().sin_cos();
        let normal = (ahead * cos + up * sin).as_dvec3();
        let axes = [right.as_dvec3(), (up * cos - ahead * sin).as_dvec3()];
        let velocity = drops.velocity_m_s.map_or(glass.motion.velocity_m_s, |v| v.as_dvec3());
        let wind = field.wind_m_s() - velocity;
        let place = (eye + ahead * drops.distance_m).as_dvec3();
        let exposure = if air.closed_in == Some(entity) {
            0.0
        } else {
            drops.exposure.unwrap_or_else(|| rain.exposed_at(place))
        };
        let rate = rain.rain_at(place);
        let source = Source {
            spectrum: field.spectrum_at(rate),
            normal,
            air_m_s: wind,
            gust_m_s: drops.gust_m_s.into(),
        };
        if glass.impacts.as_ref().is_none_or(|(known, _)| *known != source) {
            let impacts = if rate > 0.0 {
                GlassImpacts::new(&source.spectrum, normal, wind, source.gust_m_s)
            } else {
                GlassImpacts::default()
            };
            glass.impacts = Some((source, impacts));
        }
        let Some((_, impacts)) = &glass.impacts else { continue };
        // Shut-in air stands still.
        let wind = if exposure > 0.0 { wind } else { DVec3::ZERO };
        let state = active.entity().and_then(|entity| weather.get(entity).ok());
        let conditions = state.map_or_else(WeatherConditions::default, |state| *state.conditions());
        glass.glass.wipers.arms = wipers.map_or([None; MAX_WIPER_ARMS], |w| {
            w.arms.map(|arm| arm.and_then(|arm| arm.validated().ok()))
        });
        let forcing = GlassForcing {
            impacts,
            exposure: exposure.into(),
            gravity_m_s2: axes.map(|axis| -GRAVITY * axis.y),
            air_m_s: axes.map(|axis| wind.dot(axis)),
            stagnation_m_s: (-wind.dot(normal)).max(0.0),
            deficit_kg_m3: deficit_kg_m3(&conditions),
            mode: wipers.map_or(WiperMode::Off, |w| w.mode),
        };
        let shape = GlassShape {
            half_m: (half_tan * drops.distance_m).as_dvec2().to_array(),
        };
        glass.glass.advance(&shape, &forcing, clock.current_tick_s());
    }
}

fn aim_lens(
    time: Res<Time>,
    clock: Res<RainClock>,
    air: Res<AirAroundView>,
    rain: RainQueries,
    report: Res<RainReport>,
    mut errors: MessageWriter<RainConfigError>,
    mut views: Query<(
        Entity,
        Ref<LensDrops>,
        Option<Ref<WindscreenWipers>>,
        &Camera,
        &Projection,
        &GlobalTransform,
        &mut LensGlass,
    )>,
) {
    let since_tick = f64::from(clock.interpolation()) * clock.tick_ns() as f64 * 1e-9;
    let mut any = false;
    for (entity, drops, wipers, camera, projection, transform, mut glass) in &mut views {
        any = true;
        if drops.is_changed()
            && let Err(error) = drops.validated()
        {
            errors.write(RainConfigError { entity, error });
        }
        if let Some(wipers) = wipers.filter(|wipers| wipers.is_changed()) {
            for error in wipers.arms.iter().flatten().filter_map(|arm| arm.validated().err()) {
                errors.write(RainConfigError { entity, error });
            }
        }
        let drops = glass.last_good(&drops);
        let (_, rotation, eye) = transform.to_scale_rotation_translation();
        glass.motion.observe(eye, rotation, time.delta_secs());
        let handed = glass.drops_after(since_tick);
        let size = camera.physical_viewport_size().unwrap_or_default();
        let dry = glass.glass.is_dry() && glass.glass.wipers.rests();
        let skip = match half_tan(projection) {
            _ if !camera.is_active || size.x == 0 || size.y == 0 => Err(SkipReason::NoView),
            _ if !drops.enabled => Err(SkipReason::Disabled),
            None => Err(SkipReason::Unsupported),
            Some(_) if dry && air.closed_in == Some(entity) => Err(SkipReason::Indoors),
            Some(_) if dry && rain.rain_at(eye) <= 0.0 => Err(SkipReason::NoRain),
            Some(_) if dry => Err(SkipReason::Dry),
            Some(half_tan) => Ok(half_tan),
        };
        match skip {
            Err(reason) => report.skipped(PassName::Lens, reason),
            Ok(half_tan) => {
                let mut wipers = glass.glass.wipers;
                if wipers.mode != WiperMode::Off {
                    wipers.time_s += since_tick;
                }
                glass.shot = Some(LensShot {
                    drops: handed,
                    wipers,
                    half_tan,
                    distance_m: drops.distance_m,
                    aperture_m: drops.aperture_m,
                    mist: glass.glass.mist() as f32,
                    mist_per_s: glass.glass.mist_per_s() as f32,
                });
            }
        }
    }
    if !any {
        report.skipped(PassName::Lens, SkipReason::Disabled);
    }
}
