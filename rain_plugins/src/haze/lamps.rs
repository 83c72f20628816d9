//! Which lamps glow in a view.

use bevy::light::{PointLight, SpotLight};
use bevy::prelude::*;
use rain_render::haze::GlowingLamp;

/// Light that a lamp of the scene sends.
pub(super) type Lamps<'w, 's> = (
    Query<
        'w,
        's,
        (
            &'static PointLight,
            &'static GlobalTransform,
            &'static InheritedVisibility,
        ),
    >,
    Query<
        'w,
        's,
        (
            &'static SpotLight,
            &'static GlobalTransform,
            &'static InheritedVisibility,
        ),
    >,
);

fn linear(colour: Color, lumen: f32) -> Vec3 {
    let c = colour.to_linear();
    // Bevy spreads the light of point and spot lights over the whole sphere.
    Vec3::new(c.red, c.green, c.blue) * (lumen / (4.0 * std::f32::consts::PI))
}

/// The `most` lamps with the most light at the eye, the strongest first, their light times `gain`. Those that others are about to replace are faded
/// out, so that none vanishes at once.
pub(super) fn strongest(
    points: &Query<(&PointLight, &GlobalTransform, &InheritedVisibility)>,
    spots: &Query<(&SpotLight, &GlobalTransform, &InheritedVisibility)>,
    eye: Vec3,
    most: usize,
    gain: f32,
) -> Vec<GlowingLamp> {
    if most == 0 || gain <= 0.0 {
        return Vec::new();
    }
    let points = points
        .iter()
        .filter(|(_, _, seen)| seen.get())
        .map(|(light, at, _)| GlowingLamp {
            place_m: at.translation() - eye,
            radius_m: light.radius,
            intensity_cd: linear(light.color, light.intensity),
            cone: None,
        });
    let spots = spots
        .iter()
        .filter(|(_, _, seen)| seen.get())
        .map(|(light, at, _)| GlowingLamp {
            place_m: at.translation() - eye,
            radius_m: light.radius,
            intensity_cd: linear(light.color, light.intensity),
            cone: Some((at.forward().into(), [light.outer_angle.cos(), light.inner_angle.cos()])),
        });
    let mut found: Vec<(f32, GlowingLamp)> = points
        .chain(spots)
        .map(|lamp| (lamp.intensity_cd.max_element() / lamp.place_m.length().max(1.0), lamp))
        .filter(|(score, _)| *score > 0.0 && score.is_finite())
        .collect();
    found.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    let next = found.get(most).map_or(0.0, |(score, _)| *score);
    found.truncate(most);
    found
        .into_iter()
        .map(|(score, mut lamp)| {
            lamp.intensity_cd *= gain * (4.0 * (1.0 - next / score)).clamp(0.0, 1.0);
            lamp
        })
        .collect()
}
