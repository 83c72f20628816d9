//! Films that run down slopes: their wavelets move downhill as fast as the water, and none move where none runs.

use std::time::Duration;

use bevy::asset::RenderAssetUsages;
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use image::RgbImage;
use rain_plugins::prelude::*;
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

/// Side of the picture. Units: px.
const SIZE: u32 = 128;
/// Distance of the eye, and what that makes of a pixel (45° high). Units: m.
const EYE_M: f32 = 1.5;
const PX_M: f64 = 2.0 * 1.5 * 0.414_213_56 / 128.0;
/// Between two pictures. Units: s.
const STEP_S: f64 = 0.125;

/// A plate in heavy rain that falls towards +x, seen along its normal with the sun behind the eye.
struct Slope {
    test: TestApp,
    plate: Entity,
    weather: Entity,
}

impl Slope {
    fn new(fall: f32) -> Self {
        let mut test = TestApp::new([SIZE, SIZE], true);
        world::without_ground(test.world());
        let low = Vec3::new(-3.0, -0.1, -3.0);
        let plate = world::block(test.world(), "plate", low, Vec3::new(3.0, 0.0, 3.0), world::STONE);
        let turn = Quat::from_rotation_z(-fall.atan());
        test.world()
            .entity_mut(plate)
            .insert(Transform::from_translation(turn * Vec3::new(0.0, -0.05, 0.0)).with_rotation(turn));
        let weather = test.world().spawn(Weather::rain(0.0)).id();
        let camera = test.camera;
        test.world().entity_mut(camera).insert(RainView {
            streak_budget: Some(0),
            ..default()
        });
        let normal = turn * Vec3::Y;
        // The picture's right is downhill.
        let eye = Transform::from_translation(EYE_M * normal).looking_at(Vec3::ZERO, Vec3::NEG_Z);
        test.world().entity_mut(camera).insert(eye);
        let sun = Transform::default().looking_to(-normal, Vec3::Z);
        let mut lights = test.world().query_filtered::<&mut Transform, With<DirectionalLight>>();
        lights.iter_mut(test.world()).for_each(|mut light| *light = sun);
        test.frames(3, FRAME);
        Self { test, plate, weather }
    }

    fn rain(&mut self, intensity_mm_h: f64) {
        let weather = self.weather;
        self.test
            .world()
            .entity_mut(weather)
            .insert(Weather::rain(intensity_mm_h));
        self.test.leap(600);
        self.test.frames(3, FRAME);
    }

    /// Pictures of two seconds.
    fn film(&mut self) -> Vec<RgbImage> {
        (0..16)
            .map(|_| {
                self.test.frames(1, Duration::from_secs_f64(STEP_S));
                self.test.picture()
            })
            .collect()
    }

    /// Film above the texture, mm, and Manning's n.
    fn film_mm(&mut self) -> (f64, f64) {
        let state = self.test.world().get::<WeatherState>(self.weather).expect("weather");
        let class = SurfaceClass::Asphalt;
        let properties = *state.surfaces().properties(class);
        (
            state.water_level_mm(class) - properties.texture_depth_mm,
            properties.manning_n,
        )
    }
}

fn bright(picture: &RgbImage, x: u32, y: u32) -> f64 {
    picture.get_pixel(x, y).0.iter().map(|c| f64::from(*c)).sum::<f64>() / 3.0
}

/// Root mean square change from each picture to the next.
fn change(pictures: &[RgbImage]) -> f64 {
    let pairs = pictures.windows(2).flat_map(|pair| {
        let [a, b] = [&pair[0], &pair[1]];
        (32..96).flat_map(move |y| (32..96).map(move |x| bright(b, x, y) - bright(a, x, y)))
    });
    let (sum, count) = pairs.fold((0.0, 0_u32), |(sum, n), d| (sum + d * d, n + 1));
    (sum / f64::from(count)).sqrt()
}

/// Velocity with which what differs from the mean picture moves, right and down: the shift from each picture to the next
/// under which they agree best. Units: m/s.
fn velocity(pictures: &[RgbImage]) -> [f64; 2] {
    let mean = |x: u32, y: u32| pictures.iter().map(|p| bright(p, x, y)).sum::<f64>() / pictures.len() as f64;
    let means: Vec<f64> = (0..SIZE * SIZE).map(|i| mean(i % SIZE, i / SIZE)).collect();
    let moving: Vec<Vec<f64>> = pictures
        .iter()
        .map(|p| {
            (0..SIZE * SIZE)
                .map(|i| bright(p, i % SIZE, i / SIZE) - means[i as usize])
                .collect()
        })
        .collect();
    let agreement = |dx: i32, dy: i32| -> f64 {
        let at = |x: i32, y: i32| (y * SIZE as i32 + x) as usize;
        let (mut both, mut a2, mut b2) = (0.0, 0.0, 0.0);
        for pair in moving.windows(2) {
            for y in 40..88 {
                for x in 40..88 {
                    let (a, b) = (pair[0][at(x, y)], pair[1][at(x + dx, y + dy)]);
                    both += a * b;
                    a2 += a * a;
                    b2 += b * b;
                }
            }
        }
        both / (a2 * b2).sqrt()
    };
    let shifts = (-12..=12).flat_map(|dy| (-12..=12).map(move |dx| (dx, dy)));
    let (best, dx, dy) = shifts
        .map(|(dx, dy)| (agreement(dx, dy), dx, dy))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .expect("shifts");
    assert!(
        best > 0.3 && dx.abs() < 12 && dy.abs() < 12,
        "no shift fits: {best} at {dx} {dy}"
    );
    // Between pixels: the top of the parabola through the best and its neighbours.
    let top = |before: f64, after: f64| 0.5 * (after - before) / (2.0 * best - before - after);
    let right = f64::from(dx) + top(agreement(dx - 1, dy), agreement(dx + 1, dy));
    let down = f64::from(dy) + top(agreement(dx, dy - 1), agreement(dx, dy + 1));
    [right, down].map(|px| px * PX_M / STEP_S)
}

#[test]
fn water_runs_down_a_slope_at_its_speed_and_stands_on_level_ground() {
    if !gpu::available() {
        return;
    }
    let mut slope = Slope::new(0.05);
    let dry = slope.film();
    assert_eq!(change(&dry), 0.0, "nothing runs while it is dry");
    slope.rain(50.0);
    let (film_mm, n) = slope.film_mm();
    assert!(film_mm > 0.2, "{film_mm}");
    let sine = 0.05 / (1.0_f64 + 0.05 * 0.05).sqrt();
    let speed = 5.0 / 3.0 * (1e-3 * film_mm).powf(2.0 / 3.0) * sine.sqrt() / n;
    let pictures = slope.film();
    let moves = change(&pictures);
    let [right, down] = velocity(&pictures);
    eprintln!("change {moves}, velocity {right} {down}, water {speed} m/s");
    assert!(moves > 3.0, "{moves}");
    // A pixel is 0.08 m/s.
    assert!(
        (right - speed).abs() < 0.08 && down.abs() < 0.08,
        "{right} {down}, not {speed} m/s"
    );

    // Steeper is faster: the root of the slope.
    let mut steep = Slope::new(0.2);
    steep.rain(50.0);
    let [fast, _] = velocity(&steep.film());
    assert!((fast / (2.0 * speed) - 1.0).abs() < 0.15, "{fast}, not {}", 2.0 * speed);

    // Too little rain to rise above the texture: no flow. Then it is switched off.
    slope.rain(0.0);
    slope.test.leap(7200);
    let state_mm = slope.film_mm().0;
    assert!(state_mm <= 0.0, "{state_mm}");
    // As it dries, single pixels change by a step.
    let drained = change(&slope.film());
    assert!(drained < 0.01 * moves, "no film above the texture: {drained}");
    slope.rain(50.0);
    slope.test.world().resource_mut::<WaterAppearance>().flow_strength = 0.0;
    slope.test.frames(3, FRAME);
    let off = change(&slope.film());
    assert!(off < 0.01 * moves, "switched off: {off}");

    let mut level = Slope::new(0.0);
    level.rain(50.0);
    let on_level = change(&level.film());
    assert!(on_level < 0.01 * moves, "level ground: {on_level}");
}

#[test]
fn artists_move_films_by_a_vector_and_by_a_flow_map() {
    if !gpu::available() {
        return;
    }
    let mut level = Slope::new(0.0);
    level.rain(50.0);
    let plate = level.plate;
    let flow = FilmFlow {
        velocity_m_s: Vec2::new(-0.3, 0.0),
        ..default()
    };
    level.test.world().entity_mut(plate).insert(flow.clone());
    level.test.frames(4, FRAME);
    let [right, down] = velocity(&level.film());
    assert!((right + 0.3).abs() < 0.04 && down.abs() < 0.04, "{right} {down}");

    // Red at its middle, green at its end: along +z, which is down in the picture.
    let size = Extent3d {
        width: 1,
        height: 1,
        depth_or_array_layers: 1,
    };
    let texel = [128, 255, 0, 255];
    let map = level.test.world().resource_mut::<Assets<Image>>().add(Image::new_fill(
        size,
        TextureDimension::D2,
        &texel,
        TextureFormat::Rgba8Unorm,
        RenderAssetUsages::RENDER_WORLD,
    ));
    level.test.world().entity_mut(plate).insert(FilmFlow {
        map: Some(map),
        map_speed_m_s: 0.4,
        ..default()
    });
    level.test.frames(4, FRAME);
    let [right, down] = velocity(&level.film());
    assert!(right.abs() < 0.05 && (down - 0.4).abs() < 0.05, "{right} {down}");

    // What is out of its domain counts as absent; so does a strength of 0.
    for still in [
        FilmFlow {
            map_speed_m_s: f32::NAN,
            ..flow.clone()
        },
        FilmFlow { strength: 0.0, ..flow },
    ] {
        level.test.world().entity_mut(plate).insert(still);
        level.test.frames(4, FRAME);
        assert_eq!(change(&level.film()), 0.0);
    }
}
