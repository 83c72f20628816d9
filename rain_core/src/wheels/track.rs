//! The track of a tyre in a film, closing behind it.

use crate::error::clamped;
use crate::ops;

/// Film in the track `elapsed_s` after the wheel, between `after_mm` and the film beside it: e-folds in `closing_s`.
/// Units: mm.
///
/// Depths held in [0, 1000] mm, times in [0, 1e9] s (a closing time of 0 closes at once); what is not a number counts
/// as 0. For a look without a flowing film: where the film flows, take the wheel's water from it instead and the track
/// closes by itself. Source: choice; 5 s on a level road.
///
/// Error: 2e-13 of the deeper film against integration; composes over any cut of the time to 1e-13 mm.
#[must_use]
pub fn track_film_mm(after_mm: f64, beside_mm: f64, elapsed_s: f64, closing_s: f64) -> f64 {
    let (after, beside) = (clamped(after_mm, 0.0, 1000.0), clamped(beside_mm, 0.0, 1000.0));
    let (elapsed, closing) = (clamped(elapsed_s, 0.0, 1e9), clamped(closing_s, 0.0, 1e9));
    if elapsed == 0.0 {
        return after;
    }
    let open = if closing > 0.0 {
        ops::exp(-elapsed / closing)
    } else {
        0.0
    };
    beside + (after - beside) * open
}
