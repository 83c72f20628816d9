//! How water leaves a mouth: as drops or as a jet.

use core::f64::consts::PI;

use crate::constants::{GRAVITY, WATER_DENSITY, WATER_SURFACE_TENSION, WATER_VISCOSITY};
use crate::ops;

/// Width of what hangs from an eave before it lets go, and the widest that hangs from any lip. Units: m. A choice; drops
/// of it have 4.9 mm, drips from roofs 4 to 6.
pub const EAVE_ROOT_M: f64 = 0.004;
/// At which the film of a roof leaves an eave that pours: faster flow makes thicker jets. Units: m/s. A choice.
const EAVE_SPEED_M_S: f64 = 0.5;
/// Share of Tate's weight of a hanging drop that falls. Source: Harkins & Brown 1919: 0.60 to 0.72 for the roots here.
const FALLING_SHARE: f64 = 0.65;
/// Source: Clanet & Lasheras 1999, K for water in air.
const CLANET_K: f64 = 0.37;
/// Source: Grant & Middleman 1966, growth until break-up.
const GRANT_GROWTH: f64 = 19.5;
/// Most flow of a mouth; more counts as this. Units: m³/s.
const MOST_M3_S: f64 = 10.0;
/// Least flow of a mouth: a drop in ten minutes. Units: m³/s.
const LEAST_M3_S: f64 = 1e-10;
/// Widest and narrowest pipe. Units: m.
const PIPES_M: [f64; 2] = [0.001, 2.0];

/// Volume of the drop that falls from a root of this width, V = 0.65 π d σ/(ρ g). Units: m³.
///
/// `root_m` in m, held in [1e-6, 0.01]; NaN counts as the lower end. Source: Tate 1864; share: Harkins & Brown 1919.
///
/// Error: 1e-12 relative to the formula; the share that falls is known to 8 %, the diameter to 3 %.
#[must_use]
pub fn hanging_drop_m3(root_m: f64) -> f64 {
    let root = crate::error::clamped(root_m, 1e-6, 0.01);
    FALLING_SHARE * PI * root * WATER_SURFACE_TENSION / (WATER_DENSITY * GRAVITY)
}

/// Weber number ρ v² d/σ above which water that leaves a round mouth downwards is a jet, below which it drips. Units: none.
///
/// 4 (1 + K Bo² − √((1 + K Bo²)² − 1))², Bo² = ρ g d²/(2σ), K = 0.37, for a wall that is thin against the mouth.
/// `diameter_m` in m, held in [1e-5, 2]; NaN counts as the lower end. Source: Clanet & Lasheras 1999.
///
/// Error: 1e-9 relative to the printed formula, which cancels; hysteresis is left out.
#[must_use]
pub fn jetting_weber(diameter_m: f64) -> f64 {
    let d = crate::error::clamped(diameter_m, 1e-5, PIPES_M[1]);
    let x = CLANET_K * WATER_DENSITY * GRAVITY * d * d / (2.0 * WATER_SURFACE_TENSION);
    // 1 + x − √(x² + 2x) without cancellation.
    let root = 1.0 / (1.0 + x + ops::sqrt(x * (x + 2.0)));
    4.0 * root * root
}

/// Time from the mouth until a falling jet has broken into drops. Units: s.
///
/// Growth of Rayleigh's waves at the time scale √(ρ d³/σ) of the jet as it thins, d = d₀ √(v₀/(v₀ + g t)), over Grant &
/// Middleman's 19.5 (1 + 3 Oh)^0.85: (v₀/g) ((1 + (7/4) (g/v₀) T)^(4/7) − 1), T that of a jet which does not thin.
/// `diameter_m` held in [1e-5, 2] m, `speed_m_s` in [1e-3, 100] m/s; NaN counts as the lower end.
///
/// Source: Grant & Middleman 1966; thinning: own, of steady fall.
///
/// Error: 1e-9 of the growth's integral; the law is that of laminar jets from smooth nozzles.
#[must_use]
pub fn jet_breakup_s(diameter_m: f64, speed_m_s: f64) -> f64 {
    let d = crate::error::clamped(diameter_m, 1e-5, PIPES_M[1]);
    let v = crate::error::clamped(speed_m_s, 1e-3, 100.0);
    let ohnesorge = WATER_VISCOSITY / ops::sqrt(WATER_DENSITY * WATER_SURFACE_TENSION * d);
    let scale = ops::sqrt(WATER_DENSITY * d * d * d / WATER_SURFACE_TENSION);
    let even = GRANT_GROWTH * ops::pow(1.0 + 3.0 * ohnesorge, 0.85) * scale;
    // By ln(1 + x), so that nothing is lost for fast jets that hardly thin.
    let thinned = ops::ln_1p(1.75 * GRAVITY / v * even);
    v / GRAVITY * ops::exp_m1(thinned * (4.0 / 7.0))
}

/// Diameter of a jet of `diameter_m` at `speed_m_s` where it has come to `now_m_s`: d √(v₀/v). Units: m.
///
/// What is not above 0 counts as 1e-6. Source: continuity.
///
/// Error: 1e-12 relative; nothing has left the jet.
#[must_use]
pub fn jet_diameter_m(diameter_m: f64, speed_m_s: f64, now_m_s: f64) -> f64 {
    let positive = |x: f64| if x > 1e-6 { x } else { 1e-6 };
    positive(diameter_m) * ops::sqrt(positive(speed_m_s) / positive(now_m_s))
}

/// Water at the end of a pipe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PipeFlow {
    /// Depth of the water in the mouth. Units: m.
    pub depth_m: f64,
    /// Area that it fills. Units: m².
    pub area_m2: f64,
    /// Units: m/s.
    pub speed_m_s: f64,
}

/// A flow that pours, held; None below the least, and of what is not a number.
fn pouring(flow_m3_s: f64) -> Option<f64> {
    (flow_m3_s >= LEAST_M3_S).then(|| flow_m3_s.min(MOST_M3_S))
}

/// Area and width at the surface of water of depth `share` · diameter in a pipe, over diameter² and diameter.
fn segment(share: f64) -> [f64; 2] {
    let angle = 2.0 * ops::acos(1.0 - 2.0 * share);
    [
        0.125 * (angle - ops::sin(angle)),
        2.0 * ops::sqrt((share * (1.0 - share)).max(0.0)),
    ]
}

/// Critical flow Q² T = g A³ at the open end of a pipe, T the width of the surface; from 98 % of the depth on the pipe
/// runs full.
///
/// `flow_m3_s` in m³/s, held at 10; `diameter_m` in m, held in [0.001, 2]. None where nothing flows: 1e-10 m³/s at least.
/// Source: Chow 1959, eq. 4-3.
///
/// Error: 1e-6 of the Froude number's square, 1e-12 of the flow; the depth at the very brink is 0.7 to 0.75 of it.
#[must_use]
pub fn critical_pipe_flow(flow_m3_s: f64, diameter_m: f64) -> Option<PipeFlow> {
    let flow = pouring(flow_m3_s)?;
    let d = crate::error::clamped(diameter_m, PIPES_M[0], PIPES_M[1]);
    // Rises with the depth.
    let carried = |share: f64| {
        let [area, width] = segment(share);
        ops::sqrt(GRAVITY * area * area * area / width) * ops::sqrt(d * d * d * d * d)
    };
    let (mut low, mut high) = (0.0, 0.98);
    let full = flow >= carried(high);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if carried(middle) < flow {
            low = middle;
        } else {
            high = middle;
        }
    }
    let (share, area) = if full {
        (1.0, 0.25 * PI)
    } else {
        (high, segment(high)[0])
    };
    let area_m2 = area * d * d;
    Some(PipeFlow {
        depth_m: share * d,
        area_m2,
        speed_m_s: flow / area_m2,
    })
}

/// Water as it leaves one mouth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outflow {
    /// Units: m³/s.
    pub flow_m3_s: f64,
    /// Along the mouth; 0 where it drips. Units: m/s.
    pub speed_m_s: f64,
    /// Of the jet as it leaves, or of the root of a drip. Units: m.
    pub diameter_m: f64,
    /// When the jet has broken into drops; 0 where it drips. Units: s.
    pub breakup_s: f64,
    /// Volume of a drop. Units: m³.
    pub drop_m3: f64,
}

impl Outflow {
    /// From one of an eave's mouths: as wide as what hangs there, wider where it would leave faster than 0.5 m/s.
    ///
    /// Domain: as [`critical_pipe_flow`]. Source: [`jetting_weber`], [`hanging_drop_m3`].
    #[must_use]
    pub fn of_eave(flow_m3_s: f64) -> Option<Self> {
        let flow = pouring(flow_m3_s)?;
        let through = |speed: f64| ops::sqrt(4.0 * flow / (PI * speed));
        let diameter = EAVE_ROOT_M.max(through(EAVE_SPEED_M_S));
        let speed = flow / (0.25 * PI * diameter * diameter);
        Some(Self::new(flow, speed, diameter, EAVE_ROOT_M))
    }

    /// From the open end of a pipe of `diameter_m`: critical flow, gathered to a round jet of the same area.
    ///
    /// Domain and source: as [`critical_pipe_flow`], [`jetting_weber`], [`hanging_drop_m3`].
    #[must_use]
    pub fn of_pipe(flow_m3_s: f64, diameter_m: f64) -> Option<Self> {
        let pipe = critical_pipe_flow(flow_m3_s, diameter_m)?;
        let diameter = ops::sqrt(4.0 * pipe.area_m2 / PI);
        let root = EAVE_ROOT_M.min(crate::error::clamped(diameter_m, PIPES_M[0], PIPES_M[1]));
        Some(Self::new(pipe.area_m2 * pipe.speed_m_s, pipe.speed_m_s, diameter, root))
    }

    fn new(flow_m3_s: f64, speed_m_s: f64, diameter_m: f64, root_m: f64) -> Self {
        let weber = WATER_DENSITY * speed_m_s * speed_m_s * diameter_m / WATER_SURFACE_TENSION;
        let jets = weber >= jetting_weber(diameter_m);
        Self {
            flow_m3_s,
            speed_m_s: if jets { speed_m_s } else { 0.0 },
            diameter_m: if jets { diameter_m } else { root_m },
            breakup_s: if jets {
                jet_breakup_s(diameter_m, speed_m_s)
            } else {
                0.0
            },
            drop_m3: hanging_drop_m3(root_m),
        }
    }

    /// Whether it is a jet.
    #[must_use]
    pub fn jets(&self) -> bool {
        self.breakup_s > 0.0
    }

    /// Diameter of its drops. Units: mm.
    #[must_use]
    pub fn drop_mm(&self) -> f64 {
        1e3 * ops::cbrt(6.0 * self.drop_m3 / PI)
    }

    /// Drops in a second. Units: 1/s.
    #[must_use]
    pub fn drops_per_s(&self) -> f64 {
        self.flow_m3_s / self.drop_m3
    }
}
