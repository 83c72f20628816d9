//! Wet materials: who gets wet, by how much, and that everything is given back.

use bevy::prelude::*;
use image::RgbImage;
use rain_plugins::prelude::*;
use rain_plugins::render_adapter::WetMaterial;
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

/// A row of grey blocks under the open sky, looked at from in front; no streaks, so that only surfaces change.
struct Row {
    test: TestApp,
    weather: Entity,
    blocks: Vec<Entity>,
}

const SIZE: [u32; 2] = [160, 60];

impl Row {
    fn new(blocks: usize) -> Self {
        let mut test = TestApp::new(SIZE, true);
        world::ground(test.world());
        let blocks = (0..blocks)
            .map(|i| {
                let x = Self::x(i, blocks);
                world::block(
                    test.world(),
                    &format!("block {i}"),
                    Vec3::new(x - 0.8, 0.0, -0.8),
                    Vec3::new(x + 0.8, 1.0, 0.8),
                    world::STONE,
                )
            })
            .collect();
        let weather = test.world().spawn(Weather::rain(0.0)).id();
        let camera = test.camera;
        test.world().entity_mut(camera).insert(RainView {
            streak_budget: Some(0),
            ..default()
        });
        test.look(Vec3::new(0.0, 7.0, 3.0), Vec3::new(0.0, 1.0, 0.0));
        test.frames(3, FRAME);
        Self { test, weather, blocks }
    }

    fn x(i: usize, blocks: usize) -> f32 {
        2.0 * i as f32 - (blocks as f32 - 1.0)
    }

    fn rain(&mut self, intensity_mm_h: f64, seconds: u64) {
        let weather = self.weather;
        self.test.world().entity_mut(weather).insert(Weather {
            // What falls soaks; what is dry dries fast.
            net_radiation_w_m2: 900.0,
            relative_humidity: 0.2,
            ..Weather::rain(intensity_mm_h)
        });
        self.test.leap(seconds);
    }

    /// Mean brightness of the top of block `i`.
    fn top(&mut self, i: usize) -> f64 {
        let picture = self.test.picture();
        let mut pixels = Self::top_pixels(&picture, i, self.blocks.len());
        let n = pixels.len() as f64;
        pixels
            .drain(..)
            .map(|p| f64::from(p[0]) + f64::from(p[1]) + f64::from(p[2]))
            .sum::<f64>()
            / n
            / 3.0
    }

    /// The middle of the block's top in the picture: 45° downwards, 60° high.
    fn top_pixels(picture: &RgbImage, i: usize, blocks: usize) -> Vec<[u8; 3]> {
        let at = Transform::from_xyz(0.0, 7.0, 3.0).looking_at(Vec3::new(0.0, 1.0, 0.0), Vec3::Y);
        let top = Vec3::new(Self::x(i, blocks), 1.0, 0.0);
        let local = at.rotation.inverse() * (top - at.translation);
        // Bevy's default camera is 45° high.
        let tan = (std::f32::consts::FRAC_PI_8).tan();
        let (w, h) = (SIZE[0] as f32, SIZE[1] as f32);
        let x = (local.x / -local.z / (tan * w / h) * 0.5 + 0.5) * w;
        let y = (0.5 - local.y / -local.z / tan * 0.5) * h;
        let mut pixels = Vec::new();
        for dy in -2..=2 {
            for dx in -2..=2 {
                let (px, py) = ((x as i32 + dx) as u32, (y as i32 + dy) as u32);
                pixels.push(picture.get_pixel(px, py).0);
            }
        }
        pixels
    }

    fn handle(&mut self, i: usize) -> Option<Handle<StandardMaterial>> {
        let entity = self.blocks[i];
        self.test
            .world()
            .get::<MeshMaterial3d<StandardMaterial>>(entity)
            .map(|m| m.0.clone())
    }

    fn is_wet(&mut self, i: usize) -> bool {
        let entity = self.blocks[i];
        self.test.world().get::<MeshMaterial3d<WetMaterial>>(entity).is_some()
    }
}

#[test]
fn meshes_darken_when_wet_but_keep_dry_ones_stay_as_they_are_and_strength_grades_between() {
    if !gpu::available() {
        return;
    }
    let mut row = Row::new(4);
    let (keep, half, none) = (row.blocks[1], row.blocks[2], row.blocks[3]);
    row.test.world().entity_mut(keep).insert(KeepDry);
    let strength = |strength: f32| SurfaceWetting { strength, ..default() };
    row.test.world().entity_mut(half).insert(strength(0.5));
    row.test.world().entity_mut(none).insert(strength(0.0));
    let before: Vec<f64> = (0..4).map(|i| row.top(i)).collect();
    let dry_picture = row.test.picture();
    row.rain(50.0, 300);
    let after: Vec<f64> = (0..4).map(|i| row.top(i)).collect();
    let wet_picture = row.test.picture();
    // sRGB values of a reflectance that falls to 60 %: about four fifths.
    assert!(after[0] < 0.88 * before[0], "wet: {before:?} {after:?}");
    assert!(
        after[2] < before[2] - 3.0 && after[2] > after[0] + 3.0,
        "half strength lies between: {before:?} {after:?}"
    );
    assert_eq!(
        Row::top_pixels(&dry_picture, 1, 4),
        Row::top_pixels(&wet_picture, 1, 4),
        "KeepDry changed"
    );
    assert!((after[3] - before[3]).abs() < 1.5, "strength 0: {before:?} {after:?}");
    assert!(row.is_wet(0) && row.handle(0).is_none());
    assert!(!row.is_wet(1) && row.handle(1).is_some());
}

#[test]
fn originals_come_back_with_the_same_handle_when_everything_has_dried() {
    if !gpu::available() {
        return;
    }
    let mut row = Row::new(3);
    let before: Vec<_> = (0..3).map(|i| row.handle(i).expect("a material").id()).collect();
    let picture = row.test.picture();
    row.rain(20.0, 60);
    assert!((0..3).all(|i| row.is_wet(i) && row.handle(i).is_none()), "soaked");
    assert!(row.test.picture() != picture);
    row.rain(0.0, 6 * 3600);
    row.test.frames(3, FRAME);
    let after: Vec<_> = (0..3).map(|i| row.handle(i).map(|h| h.id())).collect();
    assert_eq!(after, before.iter().copied().map(Some).collect::<Vec<_>>());
    assert!((0..3).all(|i| !row.is_wet(i)));
    assert!(row.test.picture() == picture, "the dry picture is what it was");
}

#[test]
fn a_change_of_the_original_material_shows_while_wet() {
    if !gpu::available() {
        return;
    }
    let mut row = Row::new(2);
    let original = row.handle(0).expect("a material");
    row.rain(50.0, 300);
    let grey = row.top(0);
    row.test
        .world()
        .resource_mut::<Assets<StandardMaterial>>()
        .get_mut(&original)
        .expect("the original")
        .base_color = Color::linear_rgb(0.9, 0.0, 0.0);
    row.test.frames(3, FRAME);
    assert!(row.is_wet(0));
    let picture = row.test.picture();
    let [changed, other] = [0, 1].map(|i| Row::top_pixels(&picture, i, 2));
    assert!(changed.iter().all(|p| p[0] > p[1].saturating_add(40)), "{changed:?}");
    assert!(other.iter().all(|p| p[0].abs_diff(p[1]) < 30), "{other:?}");
    assert!((row.top(1) - grey).abs() < 3.0, "the other block");
}

#[test]
fn a_mesh_that_appears_while_it_is_wet_gets_wet() {
    if !gpu::available() {
        return;
    }
    let mut row = Row::new(1);
    row.rain(50.0, 300);
    let late = world::block(row.test.world(), "late", Vec3::ZERO, Vec3::ONE, world::STONE);
    assert!(row.test.world().get::<MeshMaterial3d<WetMaterial>>(late).is_none());
    row.test.frames(2, FRAME);
    assert!(row.test.world().get::<MeshMaterial3d<WetMaterial>>(late).is_some());
    // Its removal from the rain's reach: KeepDry put on later gives the original back.
    row.test.world().entity_mut(late).insert(KeepDry);
    row.test.frames(2, FRAME);
    assert!(row.test.world().get::<MeshMaterial3d<WetMaterial>>(late).is_none());
    assert!(row.test.world().get::<MeshMaterial3d<StandardMaterial>>(late).is_some());
}
