//! Rain as a GPU effect of `bevy_hanabi`.

use bevy::prelude::*;
use bevy_hanabi::prelude::*;
use rain_quads::field::{EYE_M, FOV_Y, SIZE, Shown, focal_px};

/// Distance of the particles from the eye, in the middle of a slab. Units: m.
const DISTANCE_M: f32 = 6.0;

/// Half its thickness. Units: m.
const HALF_M: f32 = 0.5;

/// Speed of the particles: so slow that none leaves the picture, however many frames are drawn. Units: m/s.
const SPEED_M_S: f32 = 6e-3;

/// Adds the plugin.
pub fn add(app: &mut App) {
    app.add_plugins(HanabiPlugin);
}

/// `count` falling particles, all in the picture, as quads of `like`'s mean size along their fall.
pub fn rain(app: &mut App, count: u32, like: Shown) {
    let high = 2.0 * (DISTANCE_M - HALF_M) * (0.5 * FOV_Y).tan();
    let wide = high * SIZE[0] as f32 / SIZE[1] as f32;
    let size = Vec3::new(wide, high, 2.0 * HALF_M);
    let centre = EYE_M - Vec3::Z * DISTANCE_M;
    let metres = DISTANCE_M / focal_px();
    let quad = Vec3::new(like.length_px as f32 * metres, like.width_px as f32 * metres, 1.0);
    let writer = ExprWriter::new();
    let place = writer.lit(centre - 0.5 * size) + writer.rand(VectorType::VEC3F) * writer.lit(size);
    let init_place = SetAttributeModifier::new(Attribute::POSITION, place.expr());
    let init_velocity = SetAttributeModifier::new(Attribute::VELOCITY, writer.lit(Vec3::NEG_Y * SPEED_M_S).expr());
    let init_age = SetAttributeModifier::new(Attribute::AGE, writer.lit(0.0_f32).expr());
    let init_lifetime = SetAttributeModifier::new(Attribute::LIFETIME, writer.lit(1.0e4_f32).expr());
    let spawner = SpawnerSettings::once((count as f32).into());
    let asset = EffectAsset::new(count, spawner, writer.finish())
        .with_name("rain")
        .with_simulation_condition(SimulationCondition::Always)
        .init(init_place)
        .init(init_velocity)
        .init(init_age)
        .init(init_lifetime)
        .render(SetColorModifier::new(Vec4::new(0.5, 0.5, 0.5, 0.1)))
        .render(SetSizeModifier { size: quad.into() })
        .render(OrientModifier::new(OrientMode::AlongVelocity));
    let world = app.world_mut();
    let asset = world.resource_mut::<Assets<EffectAsset>>().add(asset);
    world.spawn(ParticleEffect::new(asset));
}
