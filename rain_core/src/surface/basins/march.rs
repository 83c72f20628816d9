//! One pool under constant inflow and losses: closed forms between the bends of its curve.
//!
//! Between two heights of cells the wet area is constant, and between two knots of its inlets their flow is linear in
//! the level, so the volume grows at a constant or exponentially changing rate. At a bend the rate may jump from
//! gaining to losing; then the level stays there and a share of the ground just above it counts as wet.

use super::curve::Curve;
use super::drains::BasinDrain;
use crate::ops;

/// Volumes that differ by less than this share are equal.
const ON_BEND: f64 = 1e-14;

/// A pool and what acts on it.
pub(super) struct Pool<'a> {
    pub(super) curve: Curve<'a>,
    pub(super) bottom: f64,
    /// All drains of the map, and which of them lie in this basin.
    pub(super) drains: &'a [BasinDrain],
    pub(super) own_drains: &'a [u32],
    /// Water that arrives whatever the level. Units: m³/s.
    pub(super) inflow: f64,
    /// What each wet square metre adds: losses are negative. Units: m/s.
    pub(super) per_area: f64,
    /// Whether anything depends on the wet area.
    pub(super) area_matters: bool,
}

/// Why a march ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Stop {
    /// The time was over, or so were the stretches.
    Time,
    /// As before, and the volume does not change any more.
    Still,
    /// It is full and gains.
    Full,
    /// Its children part.
    Split,
}

/// What happened.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct March {
    pub(super) stop: Stop,
    /// Units: s.
    pub(super) time: f64,
    /// ∫ wet area dt. Units: m² s.
    pub(super) area_time: f64,
    /// Units: m³.
    pub(super) drained: f64,
    /// Wet area and drains' flow at the end. Units: m², m³/s.
    pub(super) area: f64,
    pub(super) flow: f64,
    /// Volume at the bend where it came to rest, free of what the amounts' rounding would add. Units: m³.
    pub(super) rests_at: Option<f64>,
}

/// Wet area and drains' flow on one side of a level.
#[derive(Clone, Copy)]
struct Side {
    area: f64,
    flow: f64,
    rate: f64,
}

impl Pool<'_> {
    fn own(&self) -> impl Iterator<Item = &BasinDrain> {
        self.own_drains.iter().map(|&drain| &self.drains[drain as usize])
    }

    /// Height of a drain above the pool's bottom.
    fn base(&self, drain: &BasinDrain) -> f64 {
        drain.level_m - self.bottom
    }

    fn side(&self, area: f64, flow: f64) -> Side {
        Side {
            area,
            flow,
            rate: self.inflow + self.per_area * area - flow,
        }
    }

    fn above(&self, stretch: usize, depth: f64) -> Side {
        let flow = self.own().map(|drain| drain.flow_above(depth - self.base(drain))).sum();
        self.side(self.curve.area_in(stretch), flow)
    }

    fn below(&self, stretch: usize, depth: f64) -> Side {
        let flow = self.own().map(|drain| drain.flow(depth - self.base(drain))).sum();
        self.side(self.curve.area_in(stretch), flow)
    }

    /// What is lost and gained when full: the rate that overflows, the wet area and the drains' flow.
    pub(super) fn full(&self) -> (f64, f64, f64) {
        let side = self.below(self.curve.last_stretch(), self.curve.spill_depth);
        (side.rate, side.area, side.flow)
    }

    /// Follows the pool from `volume` for at most `time_limit` seconds and `stretches` bends.
    pub(super) fn march(&self, volume: f64, time_limit: f64, mut stretches: usize) -> March {
        let curve = &self.curve;
        let mut done = March {
            stop: Stop::Time,
            time: 0.0,
            area_time: 0.0,
            drained: 0.0,
            area: 0.0,
            flow: 0.0,
            rests_at: None,
        };
        let volume = volume.max(curve.base_volume).min(curve.capacity);
        if !self.area_matters && self.own_drains.is_empty() {
            return self.fill(volume, time_limit, done);
        }
        // `up` is the stretch just above the level, `down` the one just below; they differ at a bend.
        // A volume that only rounding keeps below a bend is on it, or an unstable balance there would tip.
        let mut up = curve.stretch_at(volume * (1.0 + ON_BEND));
        let mut depth = curve.depth_in(up, volume);
        loop {
            let down = curve.depths[..up].partition_point(|&knot| knot < depth);
            let at_base = curve.start_of(down).0 >= depth;
            let lower = self.below(down, depth);
            if depth >= curve.spill_depth {
                if lower.rate > 0.0 {
                    return stopped(done, Stop::Full, lower);
                }
                if lower.rate == 0.0 {
                    return rest(done, lower, time_limit);
                }
            }
            let upper = self.above(up, depth);
            let rises = depth < curve.spill_depth && upper.rate > 0.0;
            if !rises && at_base && lower.rate < 0.0 {
                return stopped(done, Stop::Split, lower);
            }
            if !rises && lower.rate >= 0.0 {
                let jump = lower.rate - upper.rate;
                let share = if jump > 0.0 { lower.rate / jump } else { 0.0 };
                let mix = |low: f64, high: f64| low + share * (high - low);
                let held = self.side(mix(lower.area, upper.area), mix(lower.flow, upper.flow));
                done.rests_at = (jump > 0.0).then(|| curve.volume_m3(depth));
                return rest(done, held, time_limit);
            }
            if stretches == 0 {
                return stopped(done, Stop::Time, lower);
            }
            stretches -= 1;
            let (from, knot, area) = if rises {
                let knots = self.own().map(|drain| drain.next_knot(self.base(drain), depth));
                (upper, knots.fold(curve.end_of(up).0, f64::min), upper.area)
            } else {
                let knots = self.own().map(|drain| drain.previous_knot(self.base(drain), depth));
                (lower, knots.fold(curve.start_of(down).0, f64::max), lower.area)
            };
            let to = if rises {
                self.below(up, knot)
            } else {
                self.above(down, knot)
            };
            let change = area * (knot - depth);
            // What the drains took is what is missing; below their level nothing, whatever rounding says.
            let drains = from.flow > 0.0 || to.flow > 0.0;
            let taken = |missing: f64| if drains && missing > 0.0 { missing } else { 0.0 };
            let left = time_limit - done.time;
            let needed = time_to(change, from.rate, to.rate);
            let supply = self.inflow + self.per_area * area;
            if needed > left || needed.is_nan() {
                let moved = moved(change, from.rate, to.rate, left);
                done.area_time += area * left;
                done.drained += taken(supply * left - moved);
                done.time = time_limit;
                (done.area, done.flow) = (area, from.flow);
                return done;
            }
            done.time += needed;
            done.area_time += area * needed;
            done.drained += taken(supply * needed - change);
            depth = knot;
            up = curve.depths.partition_point(|&knot| knot <= depth);
        }
    }

    /// Nothing depends on the level: straight to the brim.
    fn fill(&self, volume: f64, time_limit: f64, done: March) -> March {
        let stretch = self.curve.stretch_at(volume);
        let start = March {
            area: self.curve.area_in(stretch),
            ..done
        };
        if self.inflow <= 0.0 {
            return March {
                stop: Stop::Still,
                time: time_limit,
                area_time: start.area * time_limit,
                ..start
            };
        }
        let needed = (self.curve.capacity - volume) / self.inflow;
        let (stop, time) = if needed <= time_limit {
            (Stop::Full, needed)
        } else {
            (Stop::Time, time_limit)
        };
        March { stop, time, ..start }
    }
}

/// Ends at an event, with what acts just below the level.
fn stopped(done: March, stop: Stop, lower: Side) -> March {
    March {
        stop,
        area: lower.area,
        flow: lower.flow,
        ..done
    }
}

/// Stays as it is to the end.
fn rest(done: March, held: Side, time_limit: f64) -> March {
    let left = time_limit - done.time;
    March {
        stop: Stop::Still,
        time: time_limit,
        area_time: done.area_time + held.area * left,
        drained: done.drained + held.flow * left,
        area: held.area,
        flow: held.flow,
        ..done
    }
}

/// Time in which the volume changes by `change` while its rate goes linearly from `from` to `to`.
fn time_to(change: f64, from: f64, to: f64) -> f64 {
    if change == 0.0 {
        return 0.0;
    }
    let ratio = (to - from) / from;
    if ratio <= -1.0 {
        return f64::INFINITY;
    }
    let straight = change / from;
    if ratio.abs() < 1e-9 {
        straight * (1.0 - 0.5 * ratio)
    } else {
        straight * ops::ln_1p(ratio) / ratio
    }
}

/// Change of volume after a time in the same motion.
fn moved(change: f64, from: f64, to: f64, time: f64) -> f64 {
    let bend = (to - from) / change;
    let x = bend * time;
    if x.abs() < 1e-9 {
        from * time * (1.0 + 0.5 * x)
    } else {
        from * ops::exp_m1(x) / bend
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A stair of a thousand cells of 1 m², a millimetre apart, drying at a millimetre in ten seconds.
    fn drying<R>(pool: impl Fn(&Pool) -> R) -> R {
        let depths: Vec<f64> = (0..1000).map(|cell| 1e-3 * f64::from(cell)).collect();
        let volumes: Vec<f64> = (0..1000)
            .map(|cell| 5e-4 * f64::from(cell) * f64::from(cell + 1))
            .collect();
        pool(&Pool {
            curve: Curve {
                depths: &depths,
                volumes: &volumes,
                base_cells: 0,
                base_depth: 0.0,
                base_volume: 0.0,
                spill_depth: 1.0,
                capacity: 500.5,
                cell_area: 1.0,
            },
            bottom: 0.0,
            drains: &[],
            own_drains: &[],
            inflow: 0.0,
            per_area: -1e-4,
            area_matters: true,
        })
    }

    #[test]
    fn a_look_ahead_ends_after_its_stretches() {
        let [near, far] = [64, usize::MAX].map(|stretches| drying(|pool| pool.march(500.5, 1e5, stretches)));
        assert_eq!((near.stop, far.stop), (Stop::Time, Stop::Still));
        assert!((near.time - 640.0).abs() < 1e-9, "{near:?}");
        // Σ of the wet areas, 10 s each.
        assert!((far.area_time - 10.0 * 500_500.0).abs() < 1e-6, "{far:?}");
    }

    #[test]
    fn a_volume_that_rounding_keeps_below_a_bend_is_on_it() {
        let knot = 5e-4 * 500.0 * 501.0;
        let times = [knot, knot * (1.0 - 4e-16)].map(|volume| drying(|pool| pool.march(volume, 1e5, 1).time));
        assert_eq!(times[0], times[1]);
    }

    #[test]
    fn time_and_way_are_inverse() {
        for (change, from, to) in [
            (2.0, 0.5, 0.5),
            (2.0, 0.5, 0.1),
            (-3.0, -1.0, -0.2),
            (1.0, 1e-9, 2e-9),
            (1.0, 1.0, 1.0 + 1e-10),
        ] {
            let time = time_to(change, from, to);
            let way = moved(change, from, to, time);
            assert!(
                (way - change).abs() < 1e-9 * change.abs(),
                "{change} {from} {to}: {way}"
            );
        }
        assert_eq!(time_to(1.0, 0.5, -0.1), f64::INFINITY);
    }
}
