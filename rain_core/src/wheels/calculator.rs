//! Everything about one wheel at once.

use super::hydroplaning::{horne_speed_km_h, hydroplanes, wet_grip};
use super::tyre::Tyre;
use super::water::{WheelTrail, WheelWater};
use crate::error::{ConfigError, in_range};

/// One wheel on a film.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WheelReport {
    /// Water met and its split.
    pub water: WheelWater,
    /// What becomes of it.
    pub trail: WheelTrail,
    /// Whether the tyre floats.
    pub hydroplaning: bool,
    /// The speed at which it would on deep water. Units: km/h.
    pub hydroplaning_speed_km_h: f64,
    /// Share of the wet road's grip that is left. Units: none.
    pub grip: f64,
}

/// A tyre at `speed_km_h` (negative: backwards) on a film of `film_mm`. The calculator behind `rain model wheel`.
///
/// Error: exact, the same bits as the functions that it gathers.
///
/// # Errors
/// When the tyre is not valid, `speed_km_h` is outside [−720, 720] or `film_mm` outside [0, 1000], or not finite.
pub fn wheel_on_film(tyre: Tyre, speed_km_h: f64, film_mm: f64) -> Result<WheelReport, ConfigError> {
    let tyre = tyre.validated()?;
    let speed = in_range("speed_km_h", speed_km_h, -720.0, 720.0, "-720 to 720 km/h")? / 3.6;
    let film = in_range("film_mm", film_mm, 0.0, 1000.0, "0 to 1000 mm")?;
    Ok(WheelReport {
        water: WheelWater::new(&tyre, speed, film),
        trail: WheelTrail::new(&tyre, speed, film),
        hydroplaning: hydroplanes(&tyre, speed, film),
        hydroplaning_speed_km_h: horne_speed_km_h(tyre.pressure_kpa),
        grip: wet_grip(&tyre, speed, film),
    })
}

/// [`horne_speed_km_h`] for input that must be refused when it is wrong. The calculator behind `rain model
/// hydroplaning`. Units: km/h.
///
/// Error: that of [`horne_speed_km_h`], the same bits.
///
/// # Errors
/// When `pressure_kpa` is outside [10, 2000] kPa or not finite.
pub fn hydroplaning_speed_km_h(pressure_kpa: f64) -> Result<f64, ConfigError> {
    in_range("pressure_kpa", pressure_kpa, 10.0, 2000.0, "10 to 2000 kPa").map(horne_speed_km_h)
}
