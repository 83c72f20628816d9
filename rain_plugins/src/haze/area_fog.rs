//! Fog that artists give to areas.

use bevy::ecs::system::SystemParam;
use bevy::math::DVec2;
use bevy::prelude::*;
use rain_core::haze::fog_density;
use rain_core::rainfall::areas::AreaField;
use rain_ecs::prelude::*;
use rain_render::haze::HazeFog;

use super::settings::ArtistFog;

/// Put beside a [`RainArea`]: amount, colour and loss of colour of the fog in it (Lagarde 2013). A view's fog is that of the
/// areas its eye is in, blended over their soft edges, over the view's own or the rain's haze. An area of fog alone
/// leaves the rain as it is with `AreaRain::Scale(1.0)`.
///
/// One that does not validate is reported by [`RainConfigError`] and does not count.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Default)]
pub struct AreaFog(pub ArtistFog);

/// Fogs laid over one another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FogMix {
    pub fog: HazeFog,
    pub transition_s: f64,
}

impl FogMix {
    /// One fog with its share, as it is in rain of this amount.
    fn of(fog: &ArtistFog, share: f32, amount: f64) -> Self {
        let colour = fog.colour.unwrap_or(LinearRgba::BLACK);
        Self {
            fog: HazeFog {
                density_per_m: fog_density(fog.density_per_m.into(), fog.gain.into(), amount) as f32,
                colour: Vec3::new(colour.red, colour.green, colour.blue),
                coloured: f32::from(u8::from(fog.colour.is_some())),
                desaturation: fog.desaturation,
                share,
            },
            transition_s: fog.transition_s.into(),
        }
    }

    /// This, and another over it.
    fn under(self, other: Self) -> Self {
        let (a, b) = (self.fog, other.fog);
        let share = 1.0 - (1.0 - a.share) * (1.0 - b.share);
        let t = if share > 0.0 { b.share / share } else { 0.0 };
        let mix = |a: f32, b: f32| a + (b - a) * t;
        Self {
            fog: HazeFog {
                density_per_m: mix(a.density_per_m, b.density_per_m),
                colour: a.colour.lerp(b.colour, t),
                coloured: mix(a.coloured, b.coloured),
                desaturation: mix(a.desaturation, b.desaturation),
                share,
            },
            transition_s: self.transition_s + (other.transition_s - self.transition_s) * f64::from(t),
        }
    }
}

/// The fogs of all areas.
#[derive(SystemParam)]
pub(crate) struct AreaFogs<'w, 's> {
    fogs: Query<'w, 's, Ref<'static, AreaFog>>,
    local: Local<'s, AreaField>,
}

impl AreaFogs<'_, '_> {
    /// What of them is new and does not validate.
    pub fn faults(&self, areas: Option<&RainAreas>) -> Vec<RainConfigError> {
        let known = areas.into_iter().flat_map(RainAreas::areas);
        known
            .filter_map(|(entity, _)| {
                let fog = self.fogs.get(entity).ok().filter(|fog| fog.is_changed())?;
                let error = fog.0.validated().err()?;
                Some(RainConfigError { entity, error })
            })
            .collect()
    }

    /// The view's own fog and those of the areas at `place` (x, z), `amount` by the rain there; `None`: none.
    pub fn at(
        &mut self,
        own: Option<&ArtistFog>,
        areas: Option<&RainAreas>,
        place: DVec2,
        now_s: f64,
        amount: f64,
    ) -> Option<FogMix> {
        let mut mix = own.map(|fog| FogMix::of(fog, 1.0, amount));
        for (entity, area) in areas.into_iter().flat_map(RainAreas::areas) {
            let Ok(fog) = self.fogs.get(entity) else { continue };
            self.local.clear(1.0);
            self.local.push(area, DVec2::ZERO, now_s);
            let weight = self.local.areas().first().map_or(0.0, |area| area.weight_at(place));
            if weight > 0.0 && fog.0.validated().is_ok() {
                let over = FogMix::of(&fog.0, weight as f32, amount);
                mix = Some(mix.map_or(over, |mix| mix.under(over)));
            }
        }
        mix
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fogs_over_one_another_are_mixed_by_their_shares() {
        let fog = |density_per_m: f32, desaturation: f32| ArtistFog {
            density_per_m,
            desaturation,
            ..default()
        };
        let base = FogMix::of(&fog(0.1, 0.0), 1.0, 0.0);
        let half = FogMix::of(&fog(0.3, 1.0), 0.5, 0.0);
        let mixed = base.under(half).fog;
        assert!((mixed.density_per_m - 0.2).abs() < 1e-6 && (mixed.desaturation - 0.5).abs() < 1e-6);
        assert_eq!(mixed.share, 1.0);
        // Over the rain's haze alone the area's fog is its own, and half of what is seen.
        assert_eq!(half.fog.share, 0.5);
        let more = half.under(half).fog;
        assert!((more.share - 0.75).abs() < 1e-6 && (more.density_per_m - 0.3).abs() < 1e-6);
        assert_eq!(base.under(FogMix::of(&fog(9.0, 1.0), 0.0, 0.0)).fog, base.fog);
    }
}
