//! Mist of splashes: the finest drops that impacts throw, as thin layers of extinction over what rain hits.
//!
//! # Accuracy
//! Numbers of secondary drops scatter by a factor of two between measurements, and theirs are of single drops on level
//! water; all of the mist of one impact has one size and one speed. In wind the layer is that of a long, open, even
//! ground: between houses both wind and mist differ by factors. Measured extinction near the ground in rain was not
//! found in the literature: the layers as a whole are a model, not a fit.

use super::numbers::ImpactNumbers;
use super::secondary::{mean_count, mist_rise};
use super::threshold::{splash_excess, splash_threshold_diameter_mm};
use crate::constants::{GRAVITY, VON_KARMAN};
use crate::error::{ConfigError, clamped, clamped_or, in_range};
use crate::ops;
use crate::quadrature::GaussLegendre;
use crate::rainfall::{Spectrum, terminal_velocity};

/// Diameter of a mist droplet in diameters of the drop that fell: the smallest of the drops that are drawn singly.
pub const MIST_SIZE: f64 = 0.05;
/// Most of a drop's water that becomes mist. Units: none.
const MOST_WATER: f64 = 0.25;
/// Film over diameter that secondary drops are counted for.
const FILM_RANGE: (f64, f64) = (0.5, 100.0);
/// Largest drops of rain that count: larger ones break up before they land. Units: mm.
const LARGEST_RAIN_MM: f64 = 6.0;
/// Shortest time in which air stops a droplet, as [`SecondaryDrop::place_m`](super::SecondaryDrop::place_m) has it.
/// Units: s.
const LEAST_TIME_S: f64 = 1e-3;
/// Height that winds are given for. Units: m.
const WIND_HEIGHT_M: f64 = 10.0;
/// Smoothest and roughest ground. Units: m.
const ROUGHNESS_M: (f64, f64) = (1e-4, 2.0);
/// Widest panels of sums over diameters. Units: mm.
const PANEL_MM: f64 = 0.25;

/// Secondary drops of an impact, of all sizes: 7.84e-6 K^1.8 δ^(−0.3), K = We Oh^(−0.4), δ = film over diameter. Units: none.
///
/// 0 where the drop does not splash. Arguments as [`splash_excess`]; δ held in [0.5, 100]. Source: Okawa, Shiraishi &
/// Mori 2006.
///
/// Error: 1e-13 relative; measured numbers scatter by a factor of two; thin films are held at δ = 0.5, a choice.
#[must_use]
pub fn secondary_drop_number(diameter_mm: f64, speed_m_s: f64, film_mm: f64) -> f64 {
    if splash_excess(diameter_mm, speed_m_s, film_mm) <= 1.0 {
        return 0.0;
    }
    let (d, film) = (diameter_mm.min(100.0), clamped(film_mm, 0.0, 1e6));
    let delta = (film / d).clamp(FILM_RANGE.0, FILM_RANGE.1);
    // K of the source is our K^1.6.
    let k = ImpactNumbers::new(diameter_mm, speed_m_s).k;
    7.84e-6 * ops::pow(k, 1.6 * 1.8) * ops::pow(delta, -0.3)
}

/// Droplets of mist of an impact: its [`secondary_drop_number`] less those that [`Splash`](super::Splash) throws singly.
/// Units: none.
///
/// Each is [`MIST_SIZE`] of the drop's diameter; together they hold a quarter of its water at most (2000 of them). Arguments
/// as [`splash_excess`]. Source: as there; size and bound a choice.
///
/// Error: 1e-13 of the number of secondary drops; a choice.
#[must_use]
pub fn mist_droplets(diameter_mm: f64, speed_m_s: f64, film_mm: f64) -> f64 {
    let all = secondary_drop_number(diameter_mm, speed_m_s, film_mm);
    if all <= 0.0 {
        return 0.0;
    }
    let drawn = mean_count(splash_excess(diameter_mm, speed_m_s, film_mm));
    (all - drawn).clamp(0.0, MOST_WATER / (MIST_SIZE * MIST_SIZE * MIST_SIZE))
}

/// The flight of a droplet that is thrown up in still air and falls back.
///
/// Error: 1e-10 relative against steps along the way; linear drag, as
/// [`SecondaryDrop::place_m`](super::SecondaryDrop::place_m): fast droplets are stopped too late.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MistFlight {
    /// How long it is in the air. Units: s.
    pub time_s: f64,
    /// Its mean height in that time. Units: m.
    pub mean_height_m: f64,
    /// Its greatest height. Units: m.
    pub peak_m: f64,
}

impl MistFlight {
    /// Of a droplet of `diameter_mm` (held in [0, 100] mm) thrown up at `rise_m_s` (held in [0, 1000] m/s); what is not a number
    /// counts as 0, and no droplet does not fly.
    ///
    /// With τ = v_t/g and a = 1 + w/v_t it lands after x τ, x = a(1 − e^(−x)); its mean height is w τ − v_t x τ/2, its
    /// greatest τ (w − v_t ln a).
    #[must_use]
    pub fn new(diameter_mm: f64, rise_m_s: f64) -> Self {
        let fall = terminal_velocity(clamped(diameter_mm, 0.0, 100.0));
        let rise = clamped(rise_m_s, 0.0, 1000.0);
        if fall < 1e-9 || rise <= 0.0 {
            return Self::default();
        }
        let tau = (fall / GRAVITY).max(LEAST_TIME_S);
        let ratio = rise / fall;
        let a = 1.0 + ratio;
        // Slow throws: x ≈ 2 w/v_t. The function is convex and falls towards its root from the right.
        let mut x = a.min(2.0 * ratio);
        for _ in 0..60 {
            let value = x + a * ops::exp_m1(-x);
            let slope = 1.0 - a * ops::exp(-x);
            if slope <= 0.0 || value <= 0.0 {
                break;
            }
            let step = value / slope;
            x -= step;
            if step < 1e-15 * x {
                break;
            }
        }
        let time_s = x * tau;
        // Both heights cancel for slow throws: v² / 3g and v² / 2g there.
        let (mean_height_m, peak_m) = if ratio < 1e-4 {
            (rise * rise / (3.0 * fall) * tau, rise * rise / (2.0 * fall) * tau)
        } else {
            (
                rise * tau - 0.5 * fall * time_s,
                tau * (rise - fall * ops::ln_1p(ratio)),
            )
        };
        Self {
            time_s,
            mean_height_m,
            peak_m,
        }
    }
}

/// Friction velocity of a neutral boundary layer, κ U/ln(10 m/z₀). Units: m/s.
///
/// `wind_m_s`: U at 10 m, held in [0, 100]; `roughness_m`: z₀, held in [1e-4, 2] m, NaN counts as 0.03; 0.03 grass, 0.5 to 2
/// suburb and town. Source: log law (Stull 1988).
///
/// Error: 1e-15 relative; neutral air.
#[must_use]
pub fn friction_velocity_m_s(wind_m_s: f64, roughness_m: f64) -> f64 {
    let z0 = clamped_or(roughness_m, ROUGHNESS_M.0, ROUGHNESS_M.1, 0.03);
    VON_KARMAN * clamped(wind_m_s, 0.0, 100.0) / ops::ln(WIND_HEIGHT_M / z0)
}

/// Rouse number w/(κ u*): above 2.5 nothing is carried up, below 1 all of it. Units: none.
///
/// `settling_m_s`: w, held in [0, 100]; `friction_m_s`: u*, held in [1e-6, 100]; what is not a number counts as the least. Source:
/// Rouse 1937.
///
/// Error: 1e-15 relative.
#[must_use]
pub fn rouse_number(settling_m_s: f64, friction_m_s: f64) -> f64 {
    clamped(settling_m_s, 0.0, 100.0) / (VON_KARMAN * clamped(friction_m_s, 1e-6, 100.0))
}

/// ∫ (z/a)^(−P) zⁿ dz from a to b over aⁿ⁺¹, for 1 ≤ r = b/a.
fn rouse_moment(ratio: f64, rouse: f64, n: f64) -> f64 {
    let log = ops::ln(ratio);
    let s = (n + 1.0 - rouse) * log;
    let mean = if s.abs() < 1e-9 { 1.0 } else { ops::exp_m1(s) / s };
    log * mean
}

/// How far mist rises over the ground and how the wind finds it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MistGround {
    /// Thinnest film on the ground. Units: mm. Domain: [0, 1e6].
    pub film_mm: f64,
    /// Wind at 10 m. Units: m/s. Domain: [0, 100].
    pub wind_m_s: f64,
    /// Roughness length z₀. Units: m. Domain: [1e-4, 2].
    pub roughness_m: f64,
    /// Length of ground in the rain upwind: mist has risen to κ u* over the time that the wind needs for it. Units: m. Domain:
    /// [1, 1e4].
    pub fetch_m: f64,
}

impl Default for MistGround {
    /// A film of 0.1 mm in still air, short grass, 200 m of it.
    fn default() -> Self {
        Self {
            film_mm: 0.1,
            wind_m_s: 0.0,
            roughness_m: 0.03,
            fetch_m: 200.0,
        }
    }
}

/// A layer of extinction σ e^(−h/H) over a surface.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MistLayer {
    /// σ at the surface. Units: 1/m.
    pub extinction_per_m: f64,
    /// H: that of the droplets' mean height. Units: m.
    pub height_m: f64,
}

impl MistLayer {
    /// Optical depth of a straight way of `way_m` (held in [0, 1e9] m) between two heights over the surface (held in [0, 1e9] m;
    /// below it counts as on it); what is not a number counts as 0. Units: none.
    ///
    /// σ × way × mean of e^(−h/H) along it. Source: closed form.
    ///
    /// Error: 1e-12 relative.
    #[must_use]
    pub fn depth(&self, from_m: f64, to_m: f64, way_m: f64) -> f64 {
        if self.height_m <= 0.0 {
            return 0.0;
        }
        let (a, b) = (clamped(from_m, 0.0, 1e9), clamped(to_m, 0.0, 1e9));
        let low = a.min(b) / self.height_m;
        let mean = crate::haze::mean_decay((a - b).abs() / self.height_m);
        self.extinction_per_m * clamped(way_m, 0.0, 1e9) * ops::exp(-low) * mean
    }

    /// A layer that holds `column` (optical depth straight up) at a mean height.
    fn of(column: f64, moment_m: f64) -> Self {
        if column <= 0.0 || moment_m <= 0.0 {
            return Self::default();
        }
        let height_m = moment_m / column;
        Self {
            extinction_per_m: column / height_m,
            height_m,
        }
    }
}

/// Mist of the splashes of rain on a wide ground: what is thrown and falls back, and what wind carries up.
///
/// Thrown: the droplets in the air at a time are those of an impact times their time of flight; the layer has their optical
/// depth straight up and their mean height. Carried: eddies hold up a Rouse profile, C(z) = (S/w)(z/a)^(−P), from the
/// peak a of the flight to κ u* X/U, the height over a fetch X; S the droplets of an area and time, w their terminal speed.
/// Their water, less than a quarter of the rain's, falls back where it came from or nearby: no ledger counts it.
///
/// Error: 5e-5 relative against fine sums; the model as a whole a factor of a few.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MistLayers {
    /// What is thrown and falls back.
    pub thrown: MistLayer,
    /// What wind carries up; none in still air.
    pub carried: MistLayer,
}

impl MistLayers {
    /// Of the rain of `spectrum`, with extinction `efficiency` cross-sections (held in [0, 4], NaN counts as 2).
    ///
    /// # Errors
    /// When a value of `ground` is not finite or outside its domain.
    pub fn new(spectrum: &Spectrum, ground: &MistGround, efficiency: f64) -> Result<Self, ConfigError> {
        let film = in_range("film_mm", ground.film_mm, 0.0, 1e6, "0 to 1e6 mm")?;
        let wind = in_range("wind_m_s", ground.wind_m_s, 0.0, 100.0, "0 to 100 m/s")?;
        let (smooth, rough) = ROUGHNESS_M;
        let z0 = in_range("roughness_m", ground.roughness_m, smooth, rough, "1e-4 to 2 m")?;
        let fetch = in_range("fetch_m", ground.fetch_m, 1.0, 1e4, "1 to 1e4 m")?;
        let q = clamped_or(efficiency, 0.0, 4.0, crate::haze::EXTINCTION_EFFICIENCY);
        let friction = friction_velocity_m_s(wind, z0);
        // κ u* X/U, whatever the wind.
        let top = VON_KARMAN * friction_velocity_m_s(1.0, z0) * fetch;
        let mut sums = [0.0; 4];
        let from = splash_threshold_diameter_mm(film);
        let rule = GaussLegendre::<8>::RULE;
        let panels = ((LARGEST_RAIN_MM - from) / PANEL_MM).ceil().max(0.0);
        let half = 0.5 * (LARGEST_RAIN_MM - from) / panels;
        for panel in 0..panels as u32 {
            let mid = from + half * f64::from(2 * panel + 1);
            for (node, weight) in rule.nodes.iter().zip(rule.weights) {
                let d = mid + half * node;
                let speed = terminal_velocity(d);
                let droplets = mist_droplets(d, speed, film);
                let source = half * weight * spectrum.concentration(d) * speed * droplets;
                let droplet_mm = MIST_SIZE * d;
                let radius = 0.5e-3 * droplet_mm;
                let section = source * q * core::f64::consts::PI * radius * radius;
                let flight = MistFlight::new(droplet_mm, mist_rise(speed));
                sums[0] += section * flight.time_s;
                sums[1] += section * flight.time_s * flight.mean_height_m;
                let settling = terminal_velocity(droplet_mm);
                if friction > 0.0 && settling > 0.0 && top > flight.peak_m && flight.peak_m > 0.0 {
                    let p = rouse_number(settling, friction);
                    let (a, ratio) = (flight.peak_m, top / flight.peak_m);
                    let held = section / settling * a;
                    sums[2] += held * rouse_moment(ratio, p, 0.0);
                    sums[3] += held * a * rouse_moment(ratio, p, 1.0);
                }
            }
        }
        Ok(Self {
            thrown: MistLayer::of(sums[0], sums[1]),
            carried: MistLayer::of(sums[2], sums[3]),
        })
    }
}
