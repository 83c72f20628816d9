//! The point and spot lights that light a view's rain.

use std::sync::Arc;

use bevy::light::{PointLight, SpotLight};
use bevy::prelude::*;
use rain_core::rainfall::Lamp;

use super::parallel::ViewPlace;
use super::view::{RainViewFrame, SoftwareAdapter};

/// Rain that lamps are chosen for: a ball ahead of the eye, or around what a view without perspective looks at. Units: m.
const AHEAD_M: f32 = 15.0;
/// Its radius; it holds the eye. Units: m.
const REACH_M: f32 = 18.0;
/// A lamp fades in over this share of the score at which it is one of those that count.
const FADE: f32 = 0.25;
/// Nothing is smaller: Bevy's lights have no radius by default, and their light is infinite. Units: m.
const MIN_RADIUS_M: f32 = 0.02;

/// The lamps near a view's rain; follows the scene's [`PointLight`]s and [`SpotLight`]s. At most as many as
/// [`RainView::lamps`](super::RainView::lamps) says.
#[derive(Component, Clone, Debug, Default)]
pub struct ViewLamps(Arc<Vec<Lamp>>);

impl ViewLamps {
    /// The lamps in force: positions in the world (m), intensities in cd.
    #[must_use]
    pub fn lamps(&self) -> &[Lamp] {
        &self.0
    }

    /// The same relative to an eye, exposed.
    #[must_use]
    pub fn seen_from(&self, eye: Vec3, exposure: f32) -> Vec<Lamp> {
        let relative = |lamp: &Lamp| Lamp {
            position_m: lamp.position_m - eye,
            intensity: lamp.intensity * exposure,
            ..*lamp
        };
        self.0.iter().map(relative).collect()
    }
}

/// Candelas of a lamp of this luminous power, as Bevy counts them for spot lights too: lm over 4π sr.
fn candela(color: Color, lumens: f32) -> Vec3 {
    let linear = color.to_linear();
    Vec3::new(linear.red, linear.green, linear.blue) * (lumens / (4.0 * core::f32::consts::PI))
}

fn point(light: &PointLight, place: &GlobalTransform) -> Lamp {
    Lamp {
        range_m: light.range,
        ..Lamp::point(
            place.translation(),
            candela(light.color, light.intensity),
            light.radius.max(MIN_RADIUS_M),
        )
    }
}

fn spot(light: &SpotLight, place: &GlobalTransform) -> Lamp {
    Lamp {
        position_m: place.translation(),
        intensity: candela(light.color, light.intensity),
        direction: place.forward().into(),
        cos_inner: light.inner_angle.cos(),
        cos_outer: light.outer_angle.cos(),
        radius_m: light.radius.max(MIN_RADIUS_M),
        range_m: light.range,
    }
}

/// The point and spot lights of the scene.
pub(crate) type SceneLamps<'w, 's> = (
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

/// Those that shine: positions in the world (m), intensities in cd.
pub(crate) fn shining(lamps: &SceneLamps) -> impl Iterator<Item = Lamp> {
    let (points, spots) = lamps;
    let points = points.iter().filter(|(_, _, seen)| seen.get());
    let spots = spots.iter().filter(|(_, _, seen)| seen.get());
    points
        .map(|(light, place, _)| point(light, place))
        .chain(spots.map(|(light, place, _)| spot(light, place)))
}

/// The `most` lamps of the highest score (above 0), the highest first; those that only just count are dimmed, so that none
/// appears at once. `found` is left empty.
pub(crate) fn keep_strongest(found: &mut Vec<(f32, Lamp)>, most: usize, out: &mut Vec<Lamp>) {
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let next = found.get(most).map_or(0.0, |(score, _)| *score);
    out.clear();
    out.extend(found.drain(..).take(most).map(|(score, lamp)| {
        let weight = if next > 0.0 {
            ((score / next - 1.0) / FADE).clamp(0.0, 1.0)
        } else {
            1.0
        };
        Lamp {
            intensity: lamp.intensity * weight,
            ..lamp
        }
    }));
}

/// The `most` strongest lamps on the rain about a place.
fn strongest(
    lamps: impl Iterator<Item = Lamp>,
    amid: Vec3,
    most: usize,
    found: &mut Vec<(f32, Lamp)>,
    out: &mut Vec<Lamp>,
) {
    found.clear();
    found.extend(lamps.filter_map(|lamp| {
        let own = Lamp {
            position_m: lamp.position_m - amid,
            // Where a lamp stands amid the rain, a metre of distance is enough to tell it from others.
            radius_m: lamp.radius_m.max(1.0),
            ..lamp
        };
        let share = own.bound(Vec3::ZERO, REACH_M);
        (share > 0.0 && lamp.position_m.is_finite()).then_some((share, lamp))
    }));
    keep_strongest(found, most, out);
}

pub(crate) fn choose_lamps(
    lamps: SceneLamps,
    software: Res<SoftwareAdapter>,
    mut found: Local<Vec<(f32, Lamp)>>,
    mut views: Query<(&Camera, ViewPlace, &RainViewFrame, &mut ViewLamps)>,
) {
    for (camera, view, frame, mut chosen) in &mut views {
        if !camera.is_active {
            continue;
        }
        let mut out = Arc::try_unwrap(std::mem::take(&mut chosen.0)).unwrap_or_default();
        let most = frame.settings().most_lamps(*software);
        strongest(shining(&lamps), view.inward(AHEAD_M), most, &mut found, &mut out);
        chosen.0 = Arc::new(out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEPT: usize = 16;

    fn chosen(lamps: &[Lamp]) -> Vec<Lamp> {
        let mut out = Vec::new();
        strongest(
            lamps.iter().copied(),
            Vec3::NEG_Z * AHEAD_M,
            KEPT,
            &mut Vec::new(),
            &mut out,
        );
        out
    }

    #[test]
    fn the_strongest_lamps_count_and_none_comes_at_once() {
        let row = |from: f32| -> Vec<Lamp> {
            (0..40)
                .map(|i| Lamp::point(Vec3::new(3.0, 2.0, from - 20.0 * i as f32), Vec3::ONE, 0.1))
                .collect()
        };
        let near = chosen(&row(0.0));
        assert_eq!(near.len(), KEPT);
        assert!(
            near.iter().all(|lamp| lamp.position_m.z >= -320.0),
            "the nearest are kept"
        );
        // Along a street of lamps the sum of what is chosen never leaps.
        let sum = |from: f32| -> f32 {
            chosen(&row(from))
                .iter()
                .map(|lamp| lamp.intensity.x / (lamp.position_m.length_squared() + 1.0))
                .sum()
        };
        let sums: Vec<f32> = (0..400).map(|i| sum(0.05 * i as f32)).collect();
        let leap = sums
            .windows(2)
            .map(|pair| (pair[1] / pair[0] - 1.0).abs())
            .fold(0.0, f32::max);
        assert!(leap < 0.02, "{leap}");
        // Few lamps are whole.
        let two = chosen(&row(0.0)[..2]);
        assert!(two.len() == 2 && two.iter().all(|lamp| lamp.intensity == Vec3::ONE));
    }

    #[test]
    fn lamps_whose_cone_or_range_misses_the_rain_ahead_do_not_count() {
        let behind = Lamp {
            direction: Vec3::Z,
            cos_inner: 0.95,
            cos_outer: 0.9,
            ..Lamp::point(Vec3::new(0.0, 1.0, 30.0), Vec3::splat(1e4), 0.1)
        };
        let short = Lamp {
            range_m: 20.0,
            ..Lamp::point(Vec3::new(60.0, 0.0, 0.0), Vec3::splat(1e4), 0.1)
        };
        assert!(chosen(&[behind, short]).is_empty());
        assert_eq!(
            chosen(&[Lamp {
                direction: Vec3::NEG_Z,
                ..behind
            }])
            .len(),
            1
        );
    }

    #[test]
    fn lumens_are_candelas_as_the_renderer_has_them() {
        let light = PointLight {
            color: Color::WHITE,
            intensity: 4000.0 * core::f32::consts::PI,
            ..default()
        };
        let lamp = point(&light, &GlobalTransform::from_xyz(1.0, 2.0, 3.0));
        assert!((lamp.intensity.x - 1000.0).abs() < 1e-2 && lamp.range_m == light.range);
        let place = GlobalTransform::from(Transform::default().looking_to(Vec3::X, Vec3::Y));
        let beam = spot(
            &SpotLight {
                outer_angle: 0.5,
                inner_angle: 0.4,
                ..default()
            },
            &place,
        );
        assert!((beam.direction - Vec3::X).length() < 1e-6 && beam.cos_inner > beam.cos_outer);
    }
}
