//! A drop that falls for ever in a column: drips and other fixed emitters, without state.

/// Where a drop of a column is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColumnDrop {
    /// Height over the column's foot, y = H (1 − fraction), in (0, H]. Units: m.
    pub height_m: f64,
    /// Share of the column already fallen. Domain: [0, 1), also in single precision. Units: none.
    pub fraction: f32,
    /// Number of the fall: hash it together with the column for a new place and size, or the same drop falls for ever.
    /// Wraps at 2³².
    pub cycle: u32,
}

/// The drop of a column at a time: x = φ + v t/H, fraction x − ⌊x⌋, cycle ⌊x⌋.
///
/// `phase_turns`: φ, none, any finite; `speed_m_s` m/s ≥ 0; `time_s` s, any finite, in double precision; `height_m`: H,
/// m > 0. Where x is not finite, or H not positive, the drop stands at the top in cycle 0.
///
/// Error: 4e-9 of H after 24 h against the definition in exact arithmetic, 6.4e-8 in `fraction` (2⁻²⁴ more). Within
/// 1e-9 of a turn of the border of two falls either may be chosen.
#[must_use]
pub fn column_drop(phase_turns: f64, speed_m_s: f64, time_s: f64, height_m: f64) -> ColumnDrop {
    let turns = phase_turns + speed_m_s * time_s / height_m;
    if !turns.is_finite() || !height_m.is_finite() || height_m <= 0.0 {
        return ColumnDrop {
            height_m: if height_m.is_finite() { height_m.max(0.0) } else { 0.0 },
            fraction: 0.0,
            cycle: 0,
        };
    }
    let fraction = fract(turns);
    ColumnDrop {
        height_m: height_m * (1.0 - fraction),
        // Rounding to single precision may give 1.
        fraction: (fraction as f32).min(1.0 - f32::EPSILON / 2.0),
        cycle: turns.floor().rem_euclid(4_294_967_296.0) as u32,
    }
}

/// x − ⌊x⌋ in [0, 1), also for a tiny negative x, where the difference rounds to 1; 0 for what is not finite.
///
/// Units: none.
///
/// Error: 1.2e-16 (half a rounding step, for negative x) against exact arithmetic.
#[must_use]
pub fn fract(x: f64) -> f64 {
    let part = x - x.floor();
    if part >= 1.0 {
        1.0 - f64::EPSILON / 2.0
    } else if part >= 0.0 {
        part
    } else {
        0.0
    }
}
