//! The masks that artists paint on meshes, worked out from geometry: where rain wets, where it rings, where puddles
//! stand (Lagarde 2013: E16, E40, E71, E72).
//!
//! Channels are those of Lagarde's table T2: red 1 where ripples may be; green the depth at which a puddle floods, 0
//! first, 1 never; blue 1 where rain wets; alpha 0 under a puddle that is always there.
//!
//! # Accuracy
//! Masks are as fine as the mesh that carries them. A puddle's depths are those below the level at which its hollow
//! overflows, as shares of that hollow's depth, so that all puddles have the lowest value 0 whatever their depth (E16):
//! the look of a level that rises by the weather, no water balance.

use super::artist_look::painted_puddle_water;
use super::ground::PoolRoom;
use crate::error::clamped;

/// Cosine from level below which nothing rings, and above which all may (kerbs, walls: E66).
const RIPPLES: [f64; 2] = [0.85, 0.95];

/// A place on a mesh, as the painter sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaintPlace {
    /// World height. Units: m.
    pub height_m: f64,
    /// y of its unit normal. Units: none. Domain: [−1, 1].
    pub up: f64,
    /// Share of the rain that reaches it ([`RainDirections::open_share`](crate::cover::RainDirections::open_share)).
    /// Units: none. Domain: [0, 1].
    pub open: f64,
    /// The hollow that it lies in.
    pub pool: Option<PoolRoom>,
}

/// Depth at which a place in a hollow floods: (height − bottom)/(spill − bottom) in [0, 1]. Units: none; heights in m.
/// What is not a number, and a hollow without depth, never flood: 1.
/// Error: 4e-16; a look.
#[must_use]
pub fn painted_depth(height_m: f64, room: &PoolRoom) -> f64 {
    let depth = room.spill_m - room.bottom_m;
    let share = (height_m - room.bottom_m) / depth;
    if depth > 0.0 && !share.is_nan() {
        share.clamp(0.0, 1.0)
    } else {
        1.0
    }
}

/// A depth that an artist painted, of a puddle whose lowest value is `lowest`: spread so that it floods first there
/// (E16): (g − lowest)/(1 − lowest) in [0, 1]. Both are held in [0, 1]; what is not a number counts as 0.
/// A puddle of nothing but 1 is none. Error: 4e-16; a look.
#[must_use]
pub fn normalised_painted_depth(depth: f64, lowest: f64) -> f64 {
    let (g, low) = (clamped(depth, 0.0, 1.0), clamped(lowest, 0.0, 1.0));
    if low >= 1.0 {
        return 1.0;
    }
    ((g - low) / (1.0 - low)).clamp(0.0, 1.0)
}

/// Red, green, blue and alpha of a place. `margin` is the flood level over which a puddle's rim fills (0.4 in the
/// source; what is below 1e-4 or not a number counts as 1e-4).
///
/// Ripples and wetting need rain that reaches the place, ripples a level face as well. Puddles need level ground, too;
/// one under cover stays, as it may be flooded from beside. Numbers outside their domain are held in it, what is not a
/// number counts as 0. Error: 5e-16; a look.
#[must_use]
pub fn painted_channels(place: &PaintPlace, margin: f64) -> [f64; 4] {
    let level = {
        let t = clamped(
            (clamped(place.up, -1.0, 1.0) - RIPPLES[0]) / (RIPPLES[1] - RIPPLES[0]),
            0.0,
            1.0,
        );
        t * t * (3.0 - 2.0 * t)
    };
    let open = clamped(place.open, 0.0, 1.0);
    let deep = place.pool.map_or(1.0, |room| painted_depth(place.height_m, &room));
    // A wall in a hollow holds no water.
    let depth = 1.0 - (1.0 - deep) * level;
    [
        open * level,
        depth,
        open,
        1.0 - painted_puddle_water(1.0, depth, margin),
    ]
}
