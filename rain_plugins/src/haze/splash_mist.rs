//! Mist of splashes in a view: the layers of its rain, film and wind, made anew when one of them changes.

use rain_core::rainfall::Spectrum;
use rain_core::splash::{MistGround, MistLayer, MistLayers};
use rain_ecs::prelude::*;

use super::settings::SplashMist;

/// Steps of the film and the wind, so that layers last. Units: mm, m/s.
const FILM_STEP_MM: f64 = 0.02;
const WIND_STEP_M_S: f64 = 0.25;
/// Steps of the rate: one 50th of e.
const RATE_STEPS: f64 = 50.0;

/// What layers are made from.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Source {
    spectrum: Spectrum,
    ground: MistGround,
    efficiency: f32,
}

/// Layers, as long as they hold.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct KnownMist(Option<(Source, MistLayers)>);

impl KnownMist {
    /// The mist of rain of `rate_mm_h` at the eye; `None`: none.
    pub fn layers(
        &mut self,
        settings: &SplashMist,
        field: &RainfallField,
        rate_mm_h: f64,
        film_mm: f64,
        efficiency: f32,
    ) -> Option<MistLayers> {
        if settings.gain <= 0.0 || rate_mm_h <= 0.0 {
            return None;
        }
        let step = |value: f64, step: f64| libm::round(value / step) * step;
        // The mean wind: what gusts carry up takes longer to rise than they last.
        let wind = field.mean_wind_m_s();
        let source = Source {
            spectrum: field.spectrum_at(libm::exp(step(libm::log(rate_mm_h), 1.0 / RATE_STEPS))),
            ground: MistGround {
                film_mm: step(film_mm, FILM_STEP_MM).max(0.0),
                wind_m_s: step(libm::hypot(wind.x, wind.z), WIND_STEP_M_S).min(100.0),
                roughness_m: f64::from(settings.roughness_m).max(1e-4),
                fetch_m: settings.fetch_m.into(),
            },
            efficiency,
        };
        let known = match self.0 {
            Some((known, layers)) if known == source => layers,
            _ => {
                // The settings have been checked; weather keeps to its domains.
                let layers = MistLayers::new(&source.spectrum, &source.ground, efficiency.into()).ok()?;
                self.0 = Some((source, layers));
                layers
            }
        };
        let gained = |layer: MistLayer| MistLayer {
            extinction_per_m: layer.extinction_per_m * f64::from(settings.gain),
            ..layer
        };
        Some(MistLayers {
            thrown: gained(known.thrown),
            carried: gained(known.carried),
        })
    }
}
