//! A drop that sits on glass: a cap of a sphere, what holds it, what moves it, how it dries.
//!
//! # Accuracy
//! Caps of spheres: right below the capillary length of 2.7 mm; larger drops are flatter and wider. The contact angles
//! are those of glass in use (not clean, not waxed); a waxed windscreen holds a third.

use core::f64::consts::PI;

use crate::constants::{AIR_DENSITY, WATER_DENSITY, WATER_SURFACE_TENSION, WATER_VISCOSITY};
use crate::error::clamped;
use crate::ops;

/// Mean contact angle of water on glass in use, 45°. Units: rad. Source: choice between the angles below.
pub const CONTACT_ANGLE_RAD: f64 = core::f64::consts::FRAC_PI_4;
/// cos θ_r − cos θ_a of glass in use: it recedes at 30° and advances at 60°. Units: none. Source: choice, ElSherbini &
/// Jacobi 2006 measure such angles on used surfaces.
const HYSTERESIS: f64 = 0.366_025_403_784_438_6;
/// Logarithm of a drop's size over the slip length at its edge. Units: none. Source: de Gennes 1985.
const WEDGE_LOG: f64 = 10.0;
/// Speed of the air at a drop's height over that of the free stream: drops lie in the boundary layer. Units: none.
/// Chosen: drops of 2 to 3 mm then climb a windscreen of 30° slope from 95 to 110 km/h on.
const LAYER_SHARE: f64 = 0.4;
/// Diffusivity of vapour in air. Units: m²/s. Source: Pruppacher & Klett 1997, at 15 °C.
const VAPOUR_DIFFUSIVITY: f64 = 2.46e-5;
/// Kinematic viscosity of air. Units: m²/s.
const AIR_VISCOSITY: f64 = 1.5e-5;

/// Volume over r³ of a cap with the mean contact angle: π(2 − 3 cos θ + cos³θ)/(3 sin³θ).
fn cap_factor() -> f64 {
    let cos = core::f64::consts::FRAC_1_SQRT_2;
    PI * (2.0 - 3.0 * cos + cos * cos * cos) / (3.0 * cos * cos * cos)
}

/// Volume of a cap whose footprint has the radius r: π r³ (2 − 3 cos θ + cos³θ)/(3 sin³θ), θ = 45°. Units: m³.
///
/// `radius_m`: m, held in [0, 1]; NaN counts as 0.
///
/// Error: 1e-12 relative against the sum of its slices.
#[must_use]
pub fn cap_volume_m3(radius_m: f64) -> f64 {
    let r = clamped(radius_m, 0.0, 1.0);
    cap_factor() * r * r * r
}

/// Footprint radius of a volume of water on glass, the inverse of [`cap_volume_m3`]. Units: m.
///
/// `volume_m3`: m³, held in [0, 1]; NaN counts as 0.
///
/// Error: 1e-14 relative, there and back.
#[must_use]
pub fn cap_radius_m(volume_m3: f64) -> f64 {
    ops::cbrt(clamped(volume_m3, 0.0, 1.0) / cap_factor())
}

/// Force that holds a drop by the hysteresis of its contact angle: γ 2r (cos θ_r − cos θ_a). Units: N. Source: Furmidge
/// 1962.
///
/// `radius_m`: m, held in [0, 1]; NaN counts as 0.
///
/// Error: 1e-14 relative to the formula; angles of real glass scatter by 10°, the force by a third.
#[must_use]
pub fn retention_n(radius_m: f64) -> f64 {
    WATER_SURFACE_TENSION * 2.0 * clamped(radius_m, 0.0, 1.0) * HYSTERESIS
}

/// Drag of air that streams along the glass on a drop: ½ρ(0.4 U)² on its upright section, 4/3 r h, h = r tan(θ/2).
/// Units: N.
///
/// `radius_m`: m, held in [0, 1]; `speed_m_s`: of the free stream, m/s, held in [0, 100]; NaN counts as 0.
///
/// Error: 1e-14 relative to the formula; drag coefficient 1 and the boundary layer's share are choices.
#[must_use]
pub fn air_push_n(radius_m: f64, speed_m_s: f64) -> f64 {
    let (r, u) = (clamped(radius_m, 0.0, 1.0), clamped(speed_m_s, 0.0, 100.0));
    let near = LAYER_SHARE * u;
    let section = 4.0 / 3.0 * r * r * (core::f64::consts::SQRT_2 - 1.0);
    0.5 * AIR_DENSITY * near * near * section
}

/// Speed of a drop under a net force: the wedges at its edge resist, F = 3πµ r Γ U/θ, Γ = 10. Units: m/s. Source: de
/// Gennes 1985, integrated around the edge.
///
/// `net_n`: what is left of the force above the hold, N, held in [0, 1]; `radius_m`: m, held in [1e-5, 1]; NaN counts as
/// the lower end.
///
/// Error: 1e-14 relative to the formula, held at 2 m/s; measured drops of 3 to 4 mm run at 0.1 to 0.3 m/s.
#[must_use]
pub fn running_speed_m_s(net_n: f64, radius_m: f64) -> f64 {
    let resist = 3.0 * PI * WATER_VISCOSITY * WEDGE_LOG * clamped(radius_m, 1e-5, 1.0) / CONTACT_ANGLE_RAD;
    (clamped(net_n, 0.0, 1.0) / resist).min(2.0)
}

/// What pulls at a drop along the glass.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RunningForce {
    /// Along the glass, x and y. Units: N.
    pub along_n: [f64; 2],
}

impl RunningForce {
    /// On a drop with footprint radius `radius_m` (m): weight by the part of gravity along the glass (m/s²) and the push
    /// of the air along it (m/s).
    ///
    /// Error: 1e-14 relative to the two formulas.
    #[must_use]
    pub fn new(radius_m: f64, gravity_m_s2: [f64; 2], air_m_s: [f64; 2]) -> Self {
        let mass = WATER_DENSITY * cap_volume_m3(radius_m);
        let speed = ops::sqrt(air_m_s[0] * air_m_s[0] + air_m_s[1] * air_m_s[1]);
        let push = air_push_n(radius_m, speed);
        let part = |i: usize| mass * gravity_m_s2[i] + if speed > 0.0 { push * air_m_s[i] / speed } else { 0.0 };
        Self {
            along_n: [part(0), part(1)],
        }
    }

    /// Velocity of the drop: none while the force is below the hold. Units: m/s.
    ///
    /// Error: that of [`running_speed_m_s`].
    #[must_use]
    pub fn velocity_m_s(&self, radius_m: f64) -> [f64; 2] {
        let [x, y] = self.along_n;
        let force = ops::sqrt(x * x + y * y);
        let net = force - retention_n(radius_m);
        if net.is_nan() || net <= 0.0 {
            return [0.0; 2];
        }
        let speed = running_speed_m_s(net, radius_m);
        [speed * x / force, speed * y / force]
    }
}

/// Footprint radius after drying for `dt_s`. Units: m.
///
/// A cap in still air loses π r D (c_s − c)(0.27 θ² + 1.30) (Hu & Larson 2002), a factor 1 + 0.276 √Re Sc^⅓ more in a
/// stream (Frössling 1938; Re of the footprint's diameter), held at that of the present radius: r² falls linearly.
///
/// `radius_m`: m, held in [0, 1]; `deficit_kg_m3`: vapour that the air lacks, kg/m³, held in [0, 1]; `speed_m_s` as in
/// [`air_push_n`]; `dt_s`: s ≥ 0. NaN counts as 0.
///
/// Error: 1e-6 relative in still air against small steps of the law, 1e-2 in a stream for steps that take off less
/// than a tenth of r.
#[must_use]
pub fn radius_after_drying_m(radius_m: f64, deficit_kg_m3: f64, speed_m_s: f64, dt_s: f64) -> f64 {
    let r = clamped(radius_m, 0.0, 1.0);
    let near = LAYER_SHARE * clamped(speed_m_s, 0.0, 100.0);
    let schmidt = AIR_VISCOSITY / VAPOUR_DIFFUSIVITY;
    let stream = 1.0 + 0.276 * ops::sqrt(near * 2.0 * r / AIR_VISCOSITY) * ops::cbrt(schmidt);
    let shape = 0.27 * CONTACT_ANGLE_RAD * CONTACT_ANGLE_RAD + 1.3;
    // m³/s per m of radius.
    let rate = PI * VAPOUR_DIFFUSIVITY * clamped(deficit_kg_m3, 0.0, 1.0) * shape * stream / WATER_DENSITY;
    let lost = 2.0 * rate * clamped(dt_s, 0.0, 1e9) / (3.0 * cap_factor());
    ops::sqrt((r * r - lost).max(0.0))
}
