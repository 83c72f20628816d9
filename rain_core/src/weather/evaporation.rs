//! Potential evaporation from a wet surface.

use super::conditions::WeatherConditions;
use crate::error::clamped;
use crate::ops;

/// Saturation vapour pressure over water, 611.2 exp(17.67 T/(T + 243.5)). Units: °C in, Pa out.
/// Domain: T in [−60, 60] °C; for dew points it goes on to lower ones, as far as −200 °C. T is clamped to [−200, 60] °C
/// (NaN: −200): the formula has a pole at −243.5 °C. Source: Bolton 1980. Error: 1e-13 relative to the formula; over
/// water, also below 0 °C.
#[must_use]
pub fn saturation_vapour_pressure_pa(temperature_c: f64) -> f64 {
    let t = clamped(temperature_c, -200.0, 60.0);
    611.2 * ops::exp(17.67 * t / (t + 243.5))
}

/// Temperature at which air of this temperature and humidity is saturated; the inverse of Bolton's formula. Units: °C.
///
/// Temperature is clamped to [−60, 60] °C (NaN: −60), humidity to [1e-6, 1] (NaN: 1e-6).
/// Error: 1e-12 °C against bisection of [`saturation_vapour_pressure_pa`].
#[must_use]
pub fn dew_point_c(temperature_c: f64, relative_humidity: f64) -> f64 {
    let t = clamped(temperature_c, -60.0, 60.0);
    let exponent = ops::ln(clamped(relative_humidity, 1e-6, 1.0)) + 17.67 * t / (t + 243.5);
    243.5 * exponent / (17.67 - exponent)
}

/// Drying power of the air alone, Eₐ = 0.26 (1 + 0.54 u)(e_s − e) mm/day (hPa; u = horizontal wind, taken as that at
/// 2 m). Units: mm/h. Domain: valid conditions; then finite and ≥ 0. Source: Dalton's law with the wind function of
/// Penman 1948. Error: 1e-14 relative (or of 1e-3 mm/h). Right for deep water at the air's temperature;
/// [`penman_evaporation_mm_h`] adds the sun.
#[must_use]
pub fn dalton_evaporation_mm_h(conditions: &WeatherConditions) -> f64 {
    let wind = ops::sqrt(conditions.wind_m_s.x * conditions.wind_m_s.x + conditions.wind_m_s.z * conditions.wind_m_s.z);
    let saturation_pa = saturation_vapour_pressure_pa(conditions.air_temperature_c);
    let deficit_hpa = saturation_pa * (1.0 - conditions.relative_humidity) / 100.0;
    0.26 * (1.0 + 0.54 * wind) * deficit_hpa / 24.0
}

/// How long a film lasts at a constant evaporation. Units: s. `None`: for ever (dew, no evaporation, or NaN).
/// Films below 0 and NaN are gone at once. Error: 1e-15 relative; nights range from hours to never.
#[must_use]
pub fn drying_time_s(film_mm: f64, evaporation_mm_h: f64) -> Option<f64> {
    let film = clamped(film_mm, 0.0, 1e6);
    if film == 0.0 {
        Some(0.0)
    } else {
        (evaporation_mm_h > 0.0).then(|| film / evaporation_mm_h.max(1e-12) * 3600.0)
    }
}

/// Evaporation from a surface that is wet everywhere. Units: mm/h. Source: Penman 1948.
///
/// E = (Δ Rₙ/λ + γ Eₐ)/(Δ + γ) with Eₐ of [`dalton_evaporation_mm_h`], Δ = e_s·17.67·243.5/(T + 243.5)², λ = 2.501e6 −
/// 2361 T J/kg, γ = 1005 p/(0.622 λ).
///
/// **Negative values are dew** and are returned as such. [`super::SurfaceColumn`] wets nothing by dew: its caller
/// clamps at 0, so that a humid night after a dry day leaves a scene dry. Error: 3e-9 relative (or of 1e-3 mm/h)
/// against the paper's units with Δ by differences.
///
/// The conditions must be valid ([`WeatherConditions::validated`]); then the result is finite.
///
/// # Accuracy
/// The drying time that follows is extremely sensitive to Rₙ and to e_s − e. The wind is the weather's, at 2 m, not
/// that of a sheltered street.
#[must_use]
pub fn penman_evaporation_mm_h(conditions: &WeatherConditions) -> f64 {
    let t = conditions.air_temperature_c;
    let saturation_pa = saturation_vapour_pressure_pa(t);
    let slope = saturation_pa * 17.67 * 243.5 / ((t + 243.5) * (t + 243.5));
    let latent_j_kg = 2.501e6 - 2361.0 * t;
    let psychrometric = 1005.0 * conditions.pressure_pa / (0.622 * latent_j_kg);
    let radiation_mm_h = conditions.net_radiation_w_m2 / latent_j_kg * 3600.0;
    let aerodynamic_mm_h = dalton_evaporation_mm_h(conditions);
    (slope * radiation_mm_h + psychrometric * aerodynamic_mm_h) / (slope + psychrometric)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn case(t: f64, rh: f64, wind: f64, radiation: f64) -> WeatherConditions {
        WeatherConditions {
            air_temperature_c: t,
            relative_humidity: rh,
            // Slanted in the plane and with an updraught: only the horizontal length counts.
            wind_m_s: DVec3::new(0.6 * wind, 3.0, -0.8 * wind),
            net_radiation_w_m2: radiation,
            ..WeatherConditions::default()
        }
    }

    #[test]
    fn penman_check_values() {
        let table = [
            (30.0, 0.30, 4.0, 700.0, 1.03273),
            (25.0, 0.40, 3.0, 500.0, 0.68535),
            (15.0, 0.70, 2.0, 250.0, 0.27084),
            (20.0, 0.60, 2.0, 0.0, 0.06644),
            (10.0, 0.85, 1.0, 60.0, 0.06201),
            (12.0, 0.93, 1.0, -10.0, -0.00165),
        ];
        for (t, rh, wind, radiation, expected) in table {
            let e = penman_evaporation_mm_h(&case(t, rh, wind, radiation));
            assert!((e - expected).abs() < 5.1e-6, "T {t}: {e} against {expected}");
        }
    }

    #[test]
    fn evaporation_falls_with_humidity_and_rises_with_radiation() {
        let mut last = f64::INFINITY;
        for i in 0..=20 {
            let e = penman_evaporation_mm_h(&case(20.0, f64::from(i) / 20.0, 3.0, 0.0));
            assert!(e < last);
            last = e;
        }
        assert_eq!(last, 0.0, "saturated air and no radiation: nothing evaporates");
        assert!(
            penman_evaporation_mm_h(&case(20.0, 0.5, 3.0, 300.0))
                > penman_evaporation_mm_h(&case(20.0, 0.5, 3.0, 200.0))
        );
    }

    #[test]
    fn the_corners_of_the_domain_are_finite() {
        for t in [-60.0, 60.0] {
            for rh in [0.0, 1.0] {
                for wind in [0.0, 80.0] {
                    for radiation in [-300.0, 1400.0] {
                        for pressure_pa in [30_000.0, 110_000.0] {
                            let c = WeatherConditions {
                                pressure_pa,
                                ..case(t, rh, wind, radiation)
                            };
                            assert!(penman_evaporation_mm_h(&c).is_finite());
                        }
                    }
                }
            }
        }
    }
}
