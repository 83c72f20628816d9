//! A pond in a hollow whose pixels know how deep the water is, before a red wall.

use bevy::prelude::*;
use image::RgbImage;
use rain_plugins::prelude::*;
use rain_plugins::surface::{ReflectionSize, WaterLevels};
use test_support::app::{FRAME, TestApp};
use test_support::world;

use crate::puddles::hollow;

/// The picture's size. Units: px.
pub const SIZE: [u32; 2] = [160, 90];

/// Height of the pond's surface, about. Units: m.
const SURFACE_M: f32 = -0.02;

/// A pixel.
pub type At = [u32; 2];

/// The ground with a hollow, seen from a place.
pub struct Pond {
    pub test: TestApp,
    pub weather: Entity,
    eye: Vec3,
    target: Vec3,
}

impl Pond {
    /// Dry ground without rain or wind.
    pub fn new(eye: Vec3, target: Vec3) -> Self {
        let (mut test, weather) = hollow();
        test.world().insert_resource(ReflectionSize(UVec2::new(160, 90)));
        let mut pond = Self {
            test,
            weather,
            eye,
            target,
        };
        pond.look(eye, target);
        pond.test.frames(3, FRAME);
        pond.test.leap(2);
        pond.test.frames(3, FRAME);
        pond
    }

    /// The pond after a storm, when the ground around has dried.
    pub fn after_rain(eye: Vec3, target: Vec3) -> Self {
        let mut pond = Self::new(eye, target);
        pond.weather(Weather::rain(60.0));
        pond.test.leap(1200);
        pond.weather(Weather {
            net_radiation_w_m2: 900.0,
            relative_humidity: 0.2,
            ..Weather::rain(0.0)
        });
        pond.test.leap(10_800);
        pond.test.frames(3, FRAME);
        let state = pond
            .test
            .world()
            .get::<WeatherState>(pond.weather)
            .expect("the weather");
        assert_eq!(state.wetness(SurfaceClass::Asphalt), 0.0, "the ground is dry");
        pond
    }

    pub fn look(&mut self, eye: Vec3, target: Vec3) {
        (self.eye, self.target) = (eye, target);
        self.test.look(eye, target);
    }

    pub fn weather(&mut self, weather: Weather) {
        let entity = self.weather;
        self.test.world().entity_mut(entity).insert(weather);
    }

    /// Wetness and level by hand.
    pub fn by_hand(&mut self, wetness: Option<f64>, water_level: Option<f64>) {
        let entity = self.weather;
        let by_hand = WaterByHand {
            wetness,
            water_level,
            hole_level: None,
        };
        self.test.world().entity_mut(entity).insert(by_hand);
        self.test.frames(8, FRAME);
    }

    /// Edits how water looks.
    pub fn appearance(&mut self, edit: impl FnOnce(&mut WaterAppearance)) {
        edit(&mut self.test.world().resource_mut::<WaterAppearance>());
        self.test.frames(3, FRAME);
    }

    /// A wall behind the hollow that shines in this colour, from x to x and from y to y.
    pub fn wall(&mut self, colour: Color, x: [f32; 2], y: [f32; 2]) {
        self.shining(colour, Vec3::new(x[0], y[0], -3.4), Vec3::new(x[1], y[1], -3.0));
    }

    /// A bar along the wall, before it.
    pub fn bar(&mut self, colour: Color, y: [f32; 2]) {
        self.shining(colour, Vec3::new(-12.0, y[0], -3.0), Vec3::new(12.0, y[1], -2.9));
    }

    fn shining(&mut self, colour: Color, low: Vec3, high: Vec3) {
        let world = self.test.world();
        let material = world.resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial {
            base_color: colour,
            unlit: true,
            ..default()
        });
        let wall = world::block_of(world, "wall", low, high, material);
        world.entity_mut(wall).insert(MovesInRain);
        self.test.frames(3, FRAME);
    }

    /// Where the ground is that a pixel shows (x, z). Units: m.
    pub fn place(&self, [x, y]: At) -> Option<Vec2> {
        let [w, h] = SIZE.map(|n| n as f32);
        let camera = Transform::from_translation(self.eye).looking_at(self.target, Vec3::Y);
        // Bevy's default camera is 45 degrees high.
        let tan = std::f32::consts::FRAC_PI_8.tan();
        let right = ((x as f32 + 0.5) / w * 2.0 - 1.0) * tan * w / h;
        let up = (1.0 - (y as f32 + 0.5) / h * 2.0) * tan;
        let ray = camera.rotation * Vec3::new(right, up, -1.0);
        let way = (SURFACE_M - self.eye.y) / ray.y;
        let at = self.eye + way * ray;
        (way > 0.0 && at.x.abs() < 5.5 && (-2.8..5.5).contains(&at.z)).then_some(at.xz())
    }

    /// The pixels of ground whose water has a depth (m) that `holds`.
    pub fn pixels(&mut self, holds: impl Fn(f32) -> bool) -> Vec<At> {
        let levels = self.test.world().resource::<WaterLevels>().clone();
        let all = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]));
        let found: Vec<At> = all
            .filter(|&at| {
                let depth = |p: Vec2| levels.depth_at(f64::from(p.x), f64::from(p.y));
                self.place(at).is_some_and(|p| holds(depth(p)))
            })
            .collect();
        assert!(found.len() > 20, "{} pixels", found.len());
        found
    }
}

/// Mean of `value` over pixels.
pub fn mean(picture: &RgbImage, pixels: &[At], value: impl Fn([f64; 3]) -> f64) -> f64 {
    let sum: f64 = pixels
        .iter()
        .map(|[x, y]| value(picture.get_pixel(*x, *y).0.map(f64::from)))
        .sum();
    sum / pixels.len() as f64
}

/// How much redder than grey.
pub fn redness([r, g, b]: [f64; 3]) -> f64 {
    r - 0.5 * (g + b)
}

/// Mean difference of two pictures over pixels.
pub fn difference(a: &RgbImage, b: &RgbImage, pixels: &[At]) -> f64 {
    let sum: f64 = pixels
        .iter()
        .map(|[x, y]| {
            let (a, b) = (a.get_pixel(*x, *y).0, b.get_pixel(*x, *y).0);
            a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(b))).sum::<f64>() / 3.0
        })
        .sum();
    sum / pixels.len() as f64
}
