//! From rain and shares to drops per second.

use crate::error::clamped;
use crate::rainfall::drop_volume_mm3;

/// Largest product of shares, areas and rates that counts; keeps frequencies finite.
const MOST: f64 = 1e12;

/// Volume of a drop of `diameter_mm`. Units: m³. A diameter that is not above 0 has none; held at 100 mm.
///
/// Error: 2e-15 relative.
#[must_use]
pub fn drop_volume_m3(diameter_mm: f64) -> f64 {
    1e-9 * drop_volume_mm3(clamped(diameter_mm, 0.0, 100.0))
}

/// Volume that drips per second, Q = R A q_t q_s q_d/3.6e6.
///
/// `rain_mm_h`: intercepted rain, mm/h; `area_m2`: interception area, m²; `shares`: drip fraction, share of the radial
/// class and share of the size class, none. Units: m³/s. Negative factors and what is not a number count as 0; the
/// product is held at 1e12/3.6e6. Source: Weber et al. 2016, eq. 11.
///
/// Error: 3e-15 relative.
#[must_use]
pub fn drip_flow_m3_s(rain_mm_h: f64, area_m2: f64, shares: [f64; 3]) -> f64 {
    let share: f64 = shares.iter().map(|&share| clamped(share, 0.0, 1.0)).product();
    let product = clamped(rain_mm_h, 0.0, MOST) * clamped(area_m2, 0.0, MOST) * share;
    product.min(MOST) / 3.6e6
}

/// Drops per second, f = Q/(π D³/6). Units: 1/s.
///
/// `flow_m3_s` in m³/s, `diameter_mm` in mm, held in [0.01, 100]. A flow that is not above 0 makes no drops.
/// Source: Weber et al. 2016, eq. 12.
///
/// Error: 3e-15 relative.
#[must_use]
pub fn drip_frequency_hz(flow_m3_s: f64, diameter_mm: f64) -> f64 {
    clamped(flow_m3_s, 0.0, MOST) / drop_volume_m3(clamped(diameter_mm, 0.01, 100.0))
}

/// Seconds between drops, T = 1/f = 6e-4 π D³/(R A q_t q_s q_d). Units: s. None where nothing drips.
///
/// Arguments as [`drip_flow_m3_s`] and [`drip_frequency_hz`]. Source: Weber et al. 2016, eqs. 5 and 13.
/// Error: 3e-15 relative.
#[must_use]
pub fn drip_period_s(diameter_mm: f64, rain_mm_h: f64, area_m2: f64, shares: [f64; 3]) -> Option<f64> {
    let period = 1.0 / drip_frequency_hz(drip_flow_m3_s(rain_mm_h, area_m2, shares), diameter_mm);
    period.is_finite().then_some(period)
}
