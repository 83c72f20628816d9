//! Mouths along an eave: where water lets go, and what each carries.

use crate::hash::{pcg3d, unit_f32};
use crate::ops;

/// Distance of the places at which a film that hangs from an edge lets go, 2π √2 √(σ/(ρ g)). Units: m.
/// Source: Fermigier et al. 1992: the fastest growing wave of a hanging film.
pub const EAVE_SPACING_M: f64 = 0.024_233;
/// Longest eave. Units: m.
const LONGEST_M: f64 = 1000.0;
/// Mouths whose shares sum to their number: water that one lacks its neighbours have.
const GROUP: u32 = 8;

/// One mouth of an eave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EaveMouth {
    /// From the eave's start. Units: m.
    pub along_m: f64,
    /// What it carries, over the mean of all mouths. Units: none.
    pub share: f64,
    /// How much of its first drop hangs there. Units: none, [0, 1).
    pub phase: f64,
}

/// How many mouths an eave of `length_m` has (m, held in [0, 1000]; NaN counts as 0): at least one.
///
/// Error: exact.
#[must_use]
pub fn eave_mouths(length_m: f64) -> u32 {
    (crate::error::clamped(length_m, 0.0, LONGEST_M) / EAVE_SPACING_M)
        .round()
        .max(1.0) as u32
}

/// Weight of a mouth before its group is made to sum up: what runs to it on a roof that is not even.
fn weight(mouth: u32, key: u32) -> f64 {
    let u = f64::from(unit_f32(pcg3d([mouth, key, 0x6561_7665])[0]));
    // Rivulets of an uneven roof: exponential, as gaps between marks at random.
    0.1 - ops::ln(1.0 - 0.999 * u)
}

/// Mouth `index` of an eave with `key` that has `count` of them over `length_m`: the same for the same numbers.
///
/// Mouths stand a spacing apart, up to a third of it off their place. The shares of all mouths sum to their number.
/// Domain: `count` ≥ 1, `index` below it. Source: spacing: [`EAVE_SPACING_M`]; shares: a choice.
///
/// Error: shares sum to 1e-12.
#[must_use]
pub fn eave_mouth(index: u32, count: u32, length_m: f64, key: u32) -> EaveMouth {
    let count = count.max(1);
    let spacing = crate::error::clamped(length_m, 0.0, LONGEST_M) / f64::from(count);
    let [_, place, phase] = pcg3d([index, key, 0x6561_7665]);
    let first = index - index % GROUP;
    let group = first..(first + GROUP).min(count.max(index + 1));
    let members = f64::from(group.end - group.start);
    let sum: f64 = group.map(|mouth| weight(mouth, key)).sum();
    EaveMouth {
        along_m: spacing * (f64::from(index) + 0.5 + (f64::from(unit_f32(place)) - 0.5) * 2.0 / 3.0),
        share: members * weight(index, key) / sum,
        phase: f64::from(unit_f32(phase)),
    }
}
