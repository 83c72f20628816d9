//! Inlets that take water out of a basin.

use serde::{Deserialize, Serialize};

use crate::error::{ConfigError, in_range};
use crate::ops;
use crate::surface::Grate;

/// Depth of the first knot at which an inlet's flow is tabulated; knot j lies at j² times it. Units: m.
const KNOT_M: f64 = 1e-6;

/// How much an inlet takes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Inlet {
    /// The same whenever there is water above it.
    Constant {
        /// Units: m³/s. Domain: [0, 1e3].
        capacity_m3_s: f64,
    },
    /// What a grate takes at the depth over it.
    Grate(Grate),
    /// Takes everything: the cell is a hole in the ground, like one that is not a number.
    Hole,
}

impl Inlet {
    /// Flow at a depth over the inlet. Units: m³/s (depth m). Nothing at depth 0 or below or NaN. A hole takes what
    /// comes: 0 here, since no water stands over it. Error: 1e-14 relative; in a running basin 4e-5 above 10 mm, 5e-3 in the
    /// stretch of a few tenths of a mm where a grate's two laws meet.
    #[must_use]
    pub fn flow_m3_s(&self, depth_m: f64) -> f64 {
        match *self {
            Self::Constant { capacity_m3_s } if depth_m > 0.0 => capacity_m3_s,
            Self::Grate(grate) => grate.capacity_m3_s(depth_m),
            Self::Constant { .. } | Self::Hole => 0.0,
        }
    }

    /// The same inlet if its numbers are in their domain.
    ///
    /// # Errors
    /// When a capacity, perimeter or area is negative, above 1000 or not finite.
    pub fn validated(self) -> Result<Self, ConfigError> {
        match self {
            Self::Constant { capacity_m3_s } => {
                in_range("capacity_m3_s", capacity_m3_s, 0.0, 1e3, "0 to 1000 m³/s")?;
            }
            Self::Grate(grate) => {
                grate.validated()?;
            }
            Self::Hole => {}
        }
        Ok(self)
    }
}

/// An inlet at a place on the map.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drain {
    /// Where, in the height field's metres.
    pub x_m: f64,
    /// Where, in the height field's metres.
    pub z_m: f64,
    /// How much it takes.
    pub inlet: Inlet,
}

/// A drain in a basin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BasinDrain {
    /// The leaf basin whose cells it lies among.
    pub leaf: u32,
    /// Height of the ground there: it takes water that stands higher. Units: m.
    pub level_m: f64,
    /// How much it takes.
    pub inlet: Inlet,
}

impl BasinDrain {
    /// Flow when the level (m) is `depth` above its own, tabulated: linear between knots at j² · 1 µm, within 4e-5 of
    /// [`Inlet::flow_m3_s`] above 10 mm (0.4/j² of it at knot j) but in the one stretch where weir and orifice meet,
    /// where the tip is cut off: up to 0.5/j, 5e-3 above 10 mm.
    pub(super) fn flow(&self, depth: f64) -> f64 {
        match self.inlet {
            Inlet::Grate(_) if depth > 0.0 => {
                let knot = knot_below(depth);
                let (low, high) = (knot_depth(knot), knot_depth(knot + 1.0));
                let (from, to) = (self.inlet.flow_m3_s(low), self.inlet.flow_m3_s(high));
                from + (to - from) * ((depth - low) / (high - low))
            }
            ref inlet => inlet.flow_m3_s(depth),
        }
    }

    /// Flow just above the depth: a constant inlet at its own level already takes.
    pub(super) fn flow_above(&self, depth: f64) -> f64 {
        if depth >= 0.0 {
            self.flow(depth.max(f64::MIN_POSITIVE))
        } else {
            0.0
        }
    }

    /// The next depth of a pool above `depth` where the flow bends; the drain lies `base` above the pool's bottom.
    pub(super) fn next_knot(&self, base: f64, depth: f64) -> f64 {
        if depth < base {
            return base;
        }
        if !matches!(self.inlet, Inlet::Grate(_)) {
            return f64::INFINITY;
        }
        let mut knot = knot_below(depth - base);
        while base + knot_depth(knot) <= depth {
            knot += 1.0;
        }
        base + knot_depth(knot)
    }

    /// The next depth of a pool below `depth` where the flow bends.
    pub(super) fn previous_knot(&self, base: f64, depth: f64) -> f64 {
        if depth <= base {
            return f64::NEG_INFINITY;
        }
        if !matches!(self.inlet, Inlet::Grate(_)) {
            return base;
        }
        let mut knot = knot_below(depth - base) + 1.0;
        while knot > 0.0 && base + knot_depth(knot) >= depth {
            knot -= 1.0;
        }
        base + knot_depth(knot)
    }
}

fn knot_depth(knot: f64) -> f64 {
    knot * knot * KNOT_M
}

/// The last knot that is not above a depth ≥ 0.
fn knot_below(depth: f64) -> f64 {
    let mut knot = ops::sqrt(depth / KNOT_M).floor();
    if knot_depth(knot) > depth {
        knot -= 1.0;
    } else if knot_depth(knot + 1.0) <= depth {
        knot += 1.0;
    }
    knot
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tabulated_inlets_stay_near_their_law_and_bend_only_at_their_knots() {
        for (perimeter_m, area_m2) in [(1.2, 0.05), (0.3, 2.0), (40.0, 0.01)] {
            let drain = BasinDrain {
                leaf: 0,
                level_m: 0.0,
                inlet: Inlet::Grate(Grate { perimeter_m, area_m2 }),
            };
            let meeting = Grate { perimeter_m, area_m2 }.transition_depth_m();
            let (mut worst, mut cut, mut bent, mut compared) = (0.0_f64, 0.0_f64, 0.0_f64, 0);
            let mut depth = 0.01;
            while depth < 100.0 {
                let law = drain.inlet.flow_m3_s(depth);
                let off = (drain.flow(depth) / law - 1.0).abs();
                if knot_below(depth) == knot_below(meeting) {
                    assert!(off < 0.5 / knot_below(depth), "{depth}: {off}");
                    cut = cut.max(off);
                } else {
                    worst = worst.max(off);
                }
                bent = bent.max((drain.flow(1.05 * depth) / law - 1.0).abs());
                // At a knot it is the law itself.
                let knot = drain.next_knot(0.0, depth);
                assert!(knot > depth && drain.previous_knot(0.0, knot) <= depth);
                assert!((drain.flow(knot) / drain.inlet.flow_m3_s(knot) - 1.0).abs() < 1e-14);
                depth *= 1.000_7;
                compared += 1;
            }
            assert!(worst < 4e-5 && cut < 5e-3, "{perimeter_m} {area_m2}: {worst} {cut}");
            assert!(compared > 10_000 && bent > 0.02, "a depth 5 % off goes unseen");
            for knot in 2..100_u32 {
                let j = f64::from(knot);
                if j == knot_below(meeting) {
                    continue;
                }
                let middle = 0.5 * (knot_depth(j) + knot_depth(j + 1.0));
                let off = (drain.flow(middle) / drain.inlet.flow_m3_s(middle) - 1.0).abs();
                assert!(off < 0.4 / (j * j), "knot {knot}: {off}");
            }
        }
        for depth in [f64::NAN, f64::NEG_INFINITY, -1.0, 0.0] {
            let hole = BasinDrain {
                leaf: 0,
                level_m: 0.0,
                inlet: Inlet::Hole,
            };
            assert_eq!(hole.flow(depth), 0.0);
        }
    }
}
