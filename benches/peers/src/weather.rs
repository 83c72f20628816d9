//! Rain of `bevy_weather`: its precipitation, without its sky, clouds and fog.

use bevy::mesh::VertexAttributeValues;
use bevy::prelude::*;
use bevy_weather::CorePlugin;
use bevy_weather::precipitation::{PrecipitationConfig, PrecipitationPlugin, build_precipitation_mesh};
use bevy_weather::prelude::{Weather, WeatherConditions};
use bevy_weather::wind::Wind;
use rain_quads::field::{EYE_M, SIZE, Shown, clip_from_eye, shown as add_up};

/// The package makes no more particles than this.
const MOST: u32 = 1_000_000;

/// As many tell how large they are.
const SAMPLE: u32 = 60_000;

/// Adds the plugins.
pub fn add(app: &mut App) {
    let rain = WeatherConditions {
        rain: 1.0,
        snow: 0.0,
        wind_speed: 0.0,
        turbulence: 0.0,
        ..default()
    };
    app.insert_resource(Weather::new(rain))
        .add_plugins((CorePlugin, PrecipitationPlugin));
}

/// The package's own particles: their seeds and their randoms.
#[derive(Resource)]
struct Particles(Vec<([f32; 3], [f32; 4])>);

/// So many particles that `count` are visible, or as many as there can be; quads as long and wide in the mean as
/// `like`'s. Returns what is seen and how many particles there are.
pub fn rain(app: &mut App, count: u32, like: Option<Shown>) -> Result<(Shown, u32), String> {
    let seed = app.world().resource::<PrecipitationConfig>().seed;
    let mesh = build_precipitation_mesh(MOST, seed);
    let (Some(VertexAttributeValues::Float32x3(seeds)), Some(VertexAttributeValues::Float32x4(randoms))) = (
        mesh.attribute(Mesh::ATTRIBUTE_POSITION),
        mesh.attribute(Mesh::ATTRIBUTE_COLOR),
    ) else {
        return Err("bevy_weather's mesh is another than that of 0.2.0".into());
    };
    let particles = seeds.iter().copied().zip(randoms.iter().copied()).step_by(4).collect();
    app.insert_resource(Particles(particles));
    for _ in 0..if like.is_some() { 5 } else { 0 } {
        let seen = first(app, SAMPLE);
        let like = like.unwrap_or(seen);
        let mut config = app.world_mut().resource_mut::<PrecipitationConfig>();
        config.rain_length *= (like.length_px / seen.length_px) as f32;
        config.rain_width *= (like.width_px / seen.width_px) as f32;
    }
    let share = f64::from(first(app, MOST).visible) / f64::from(MOST);
    let wanted = (f64::from(count) / share).min(f64::from(MOST)) as u32;
    app.world_mut().resource_mut::<PrecipitationConfig>().particle_count = Some(wanted);
    Ok((shown(app), wanted))
}

/// What is seen of its particles now.
pub fn shown(app: &App) -> Shown {
    let config = app.world().resource::<PrecipitationConfig>();
    first(app, config.particle_count.unwrap_or_default())
}

/// What is seen of its first `count` particles: the arithmetic of its vertex shader over its own mesh.
fn first(app: &App, count: u32) -> Shown {
    let world = app.world();
    let config = world.resource::<PrecipitationConfig>();
    let wind = world.resource::<Wind>().velocity3();
    let time = world.resource::<Time>().elapsed_secs_wrapped();
    let particles = &world.resource::<Particles>().0;
    let size = Vec2::new(SIZE[0] as f32, SIZE[1] as f32);
    let edge = config.box_size;
    let smooth = |a: f32, b: f32, x: f32| {
        let t = ((x - a) / (b - a)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    };
    let pixels = |p: Vec3| -> Option<Vec2> {
        let clip = clip_from_eye() * p.extend(1.0);
        (clip.w > 0.01).then(|| (clip.truncate().truncate() / clip.w * Vec2::new(0.5, -0.5) + 0.5) * size)
    };
    let quads = particles.iter().take(count as usize).filter_map(|(seed, random)| {
        let speed = config.rain_fall_speed.max(0.01) * (0.7 + random[1] * 0.6);
        let mut base = Vec3::from(*seed) * edge;
        base += (wind - Vec3::Y * speed) * time;
        let relative = base - EYE_M;
        let offset = relative - edge * (relative / edge + 0.5).floor();
        let distance = offset.length();
        let fade = (1.0 - smooth(0.75, 1.0, distance / (edge * 0.5)))
            * smooth(0.0, 1.0, distance / f32::max(config.rain_length * 3.0, 0.3));
        if fade <= 0.0 {
            return None;
        }
        let scale = 0.6 + random[0] * 0.8;
        let velocity = wind - Vec3::Y * speed;
        let length = config.rain_length * scale * (velocity.length() / 12.0).clamp(0.35, 1.6);
        let up = velocity.normalize();
        let right = up.cross(-offset.normalize_or_zero()).normalize_or_zero();
        let half = 0.5 * config.rain_width * scale * right;
        let (head, tail) = (pixels(offset + 0.5 * length * up)?, pixels(offset - 0.5 * length * up)?);
        let width = (pixels(offset + half)? - pixels(offset - half)?).length();
        Some((head, tail, width))
    });
    add_up(quads)
}
