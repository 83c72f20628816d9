//! What is heard of a flash at a place: delay, length, loudness and course.
//!
//! Every piece of the channel sends a pulse at the moment of the flash; what arrives when is the channel's shape (Few
//! 1969). Warm air below cold bends sound upwards, so that far away only high pieces are heard (Fleagle 1949).
//!
//! # Accuracy
//! Straight rays at one speed: arrivals within 2 %. No wind, no echo. Levels scatter by 5 to 10 dB in nature.

use core::f64::consts::PI;

use glam::DVec3;

use super::channel::Channel;
use super::flash::Flash;
use crate::constants::{DRY_AIR_GAS_CONSTANT, ZERO_CELSIUS_K};
use crate::error::clamped;
use crate::ops;

/// Steps of a thunder's course.
pub const THUNDER_STEPS: usize = 16;

/// Heat capacity ratio of air.
const GAMMA: f64 = 1.4;
/// Fall of the air's temperature with height. Units: K/m. Source: Fleagle 1949.
const LAPSE_K_M: f64 = 0.0075;
/// Sound of a metre of channel of a 30 kA stroke: some 2·10⁶ J of 8 km (Holmes et al. 1971). Units: J/m.
const SOUND_J_M: f64 = 250.0;
/// What the air takes of sound of 100 Hz. Units: dB/km. Source: ISO 9613-1.
const ABSORBED_DB_KM: f64 = 0.3;
/// Threshold of hearing. Units: W/m².
const THRESHOLD_W_M2: f64 = 1e-12;
/// Shortest time that loudness is averaged over, that of sound level meters ("fast"). Units: s.
const FAST_S: f64 = 0.125;

/// Speed of sound in dry air, √(1.4 R T). Units: m/s.
///
/// `air_temperature_c`: °C, held in [−90, 60]; NaN counts as the lower. Moist air carries sound up to 0.5 % faster.
///
/// Error: 1e-15 relative.
#[must_use]
pub fn sound_speed_m_s(air_temperature_c: f64) -> f64 {
    let kelvin = ZERO_CELSIUS_K + clamped(air_temperature_c, -90.0, 60.0);
    ops::sqrt(GAMMA * DRY_AIR_GAS_CONSTANT * kelvin)
}

/// How far sound from a height is heard before the air has bent it over the listener's head, 2 √(T/Γ) (√z + √z_l): two
/// parabolas that graze the ground. Units: m.
///
/// `height_m`, `listener_m`: over the ground, m, negative counts as 0; `air_temperature_c` as in [`sound_speed_m_s`]. Γ is
/// 7.5 K/km: from 4 km it is heard to 25 km.
///
/// Error: 1e-14 relative; 3 % against rays traced through the air from up to 4 km; the weather's own lapse varies by a factor of two.
#[must_use]
pub fn thunder_reach_m(height_m: f64, listener_m: f64, air_temperature_c: f64) -> f64 {
    let kelvin = ZERO_CELSIUS_K + clamped(air_temperature_c, -90.0, 60.0);
    let root = |z: f64| ops::sqrt(clamped(z, 0.0, 1e5));
    2.0 * ops::sqrt(kelvin / LAPSE_K_M) * (root(height_m) + root(listener_m))
}

/// Thunder at a place.
///
/// Error: delays 1e-4 against the distance over the speed of an ideal gas, the level 1e-4 dB against its loudest step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thunder {
    /// From the flash to the first sound. Units: s.
    pub delay_s: f64,
    /// From the first sound to the last. Units: s.
    pub duration_s: f64,
    /// To the nearest piece of channel that is heard. Units: m.
    pub distance_m: f64,
    /// That piece. World coordinates, m.
    pub from_m: DVec3,
    /// Of its loudest step, as a sound level meter has it. Units: dB re 20 µPa (10⁻¹² W/m²).
    pub level_db: f64,
    /// The sound's energy in each sixteenth of its length, as shares of all. Units: none; they sum to 1.
    pub course: [f32; THUNDER_STEPS],
    /// Energy of all of it. Units: J/m².
    pub exposure_j_m2: f64,
}

impl Thunder {
    /// What a listener (world coordinates, m) hears of a flash; `None` beyond the reach of its highest piece, and for a
    /// place that is not finite. `air_temperature_c` as in [`sound_speed_m_s`].
    #[must_use]
    pub fn heard(flash: &Flash, channel: &Channel, listener: DVec3, air_temperature_c: f64) -> Option<Self> {
        if !listener.is_finite() {
            return None;
        }
        let ground = flash.place_m.y;
        let own = (listener.y - ground).max(0.0);
        let audible = |point: DVec3| {
            let across = (point - listener).with_y(0.0).length();
            across <= thunder_reach_m(point.y - ground, own, air_temperature_c)
        };
        let loud = flash
            .strokes()
            .iter()
            .map(|s| (s.peak_a / 30e3) * (s.peak_a / 30e3))
            .sum::<f64>();
        let pieces = || {
            channel.main().windows(2).filter_map(|p| {
                let middle = 0.5 * (p[0] + p[1]);
                let distance = middle.distance(listener).max(1.0);
                audible(middle).then(|| (middle, distance, p[0].distance(p[1])))
            })
        };
        let (mut nearest, mut farthest) = (None::<(DVec3, f64)>, 0.0_f64);
        for (middle, distance, _) in pieces() {
            if nearest.is_none_or(|(_, least)| distance < least) {
                nearest = Some((middle, distance));
            }
            farthest = farthest.max(distance);
        }
        let (from_m, distance_m) = nearest?;
        let span = (farthest - distance_m).max(1e-6);
        let mut energy = [0.0; THUNDER_STEPS];
        for (_, distance, length) in pieces() {
            let place = (distance - distance_m) / span * THUNDER_STEPS as f64;
            let absorbed = ops::pow(10.0, -ABSORBED_DB_KM * distance * 1e-4);
            energy[(place as usize).min(THUNDER_STEPS - 1)] +=
                SOUND_J_M * loud * length / (4.0 * PI * distance * distance) * absorbed;
        }
        let all: f64 = energy.iter().sum();
        let loudest = energy.iter().fold(0.0_f64, |most, e| most.max(*e));
        let speed = sound_speed_m_s(air_temperature_c);
        let duration_s = span / speed;
        let step_s = (duration_s / THUNDER_STEPS as f64).max(FAST_S);
        Some(Self {
            delay_s: distance_m / speed,
            duration_s,
            distance_m,
            from_m,
            level_db: level_db(loudest / step_s),
            course: energy.map(|e| (e / all) as f32),
            exposure_j_m2: all,
        })
    }

    /// Level at a time after the first sound (s). Units: dB re 20 µPa; `None` before and after.
    #[must_use]
    pub fn level_at(&self, since_s: f64) -> Option<f64> {
        let place = since_s / self.duration_s * THUNDER_STEPS as f64;
        if !(0.0..THUNDER_STEPS as f64).contains(&place) {
            return None;
        }
        let step_s = (self.duration_s / THUNDER_STEPS as f64).max(FAST_S);
        let share = f64::from(self.course[place as usize]);
        Some(level_db(share * self.exposure_j_m2 / step_s)).filter(|level| *level > 0.0)
    }
}

/// Of an intensity in W/m²; 0 below the threshold.
fn level_db(intensity: f64) -> f64 {
    if intensity > THRESHOLD_W_M2 {
        10.0 / core::f64::consts::LN_10 * ops::ln(intensity / THRESHOLD_W_M2)
    } else {
        0.0
    }
}
