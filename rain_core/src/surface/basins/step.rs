//! One step of the basins: inflows, predictions, events, and what is booked.

use std::sync::Arc;

use super::march::{March, Pool, Stop};
use super::run::{BasinRun, Rates};

/// Rates that differ by less than this share of what they are made of are equal.
const EQUAL: f64 = 1e-13;

/// Bends that a prediction looks ahead. Inflows change before most far events come true, and then all would have been
/// in vain.
const AHEAD: usize = 64;

impl BasinRun {
    /// All pools at the start of a step, those that are full spilling.
    pub(super) fn begin(&mut self, time: f64) {
        self.end = time;
        self.received.fill(0.0);
        self.donors.fill(0);
        self.spill.fill(0.0);
        self.clock.fill(0.0);
        self.events.clear();
        self.predicting = false;
        let pools = 0..self.clock.len() as u32;
        for pool in pools.clone().rev() {
            if self.state.full[pool as usize] && self.state.is_pool(&self.basins, pool) {
                self.balance(pool, 0.0);
            }
        }
        self.predicting = true;
        for pool in pools {
            if self.state.is_pool(&self.basins, pool) {
                self.predict(pool, 0.0);
            }
        }
    }

    /// All pools to the end of the step.
    pub(super) fn finish(&mut self, quiet: bool) {
        self.still = quiet;
        self.rates = Rates::default();
        for pool in (0..self.clock.len() as u32).rev() {
            if !self.state.is_pool(&self.basins, pool) {
                continue;
            }
            self.follow(pool, self.end);
            let at = pool as usize;
            if self.state.full[at] && self.spill[at] > 0.0 {
                // What rounding left above the brim goes where the spill went.
                let basin = &self.basins.basins()[at];
                let excess = self.state.volumes[at].cut_to(basin.volume_m3.unwrap_or(f64::INFINITY));
                match basin.overflows_to {
                    Some(leaf) => {
                        let target = self.state.pool_of(&self.basins, leaf);
                        self.state.volumes[target as usize].add_store(excess);
                    }
                    None => self.state.totals.left.add_store(excess),
                }
            }
        }
    }

    /// A step in which nothing changes.
    pub(super) fn pass(&mut self, time: f64) {
        let totals = &mut self.state.totals;
        totals.rain.add(self.rates.rain * time);
        totals.evaporated.add(self.rates.evaporated * time);
        totals.infiltrated.add(self.rates.infiltrated * time);
        totals.drained.add(self.rates.drained * time);
        totals.left.add(self.rates.left * time);
    }

    /// Rain on a wet area in excess of its runoff, whatever its size (m³/s) and for each square metre (m/s).
    fn direct(&self, pool: u32) -> (f64, f64) {
        let excess = self.forcing.rain_m_s - self.forcing.runoff_m_s;
        if excess == 0.0 {
            return (0.0, 0.0);
        }
        (
            excess * self.exposed_water(pool as usize, 0.0),
            excess * self.exposure[pool as usize],
        )
    }

    fn pool(&self, pool: u32) -> Pool<'_> {
        let at = pool as usize;
        let (fixed, direct) = self.direct(pool);
        Pool {
            curve: self.basins.curve(pool),
            bottom: self.basins.basins()[at].bottom_m,
            drains: self.basins.drains(),
            own_drains: &self.drains_of[self.drain_starts[at] as usize..self.drain_starts[at + 1] as usize],
            inflow: self.forcing.runoff_m_s * self.exposed[at] + fixed + self.received[at],
            per_area: direct - self.forcing.evaporation_m_s - self.forcing.seepage_m_s,
            area_matters: self.forcing.needs_area(),
        }
    }

    /// Follows a pool to a moment at which its inflow changes, and books what happened.
    pub(super) fn follow(&mut self, pool: u32, now: f64) {
        let at = pool as usize;
        let time = now - self.clock[at];
        if time <= 0.0 {
            return;
        }
        self.clock[at] = now;
        let march = if self.state.full[at] {
            let (_, area, flow) = self.pool(pool).full();
            March {
                stop: Stop::Still,
                time,
                area_time: area * time,
                drained: flow * time,
                area,
                flow,
                rests_at: (self.spill[at] == 0.0).then_some(self.basins.curve(pool).capacity),
            }
        } else {
            let mut march = self.pool(pool).march(self.state.volumes[at].total(), time, usize::MAX);
            // An event that rounding puts just before the moment it was predicted for.
            let left = time - march.time;
            march.area_time += march.area * left;
            march.drained += march.flow * left;
            march
        };
        if march.stop != Stop::Still {
            self.still = false;
        }
        self.book(pool, time, &march);
    }

    fn book(&mut self, pool: u32, time: f64, march: &March) {
        let at = pool as usize;
        let (fixed, direct) = self.direct(pool);
        let runoff = self.forcing.runoff_m_s * self.exposed[at] + fixed;
        let (evaporation, seepage) = (self.forcing.evaporation_m_s, self.forcing.seepage_m_s);
        let leaves = self.basins.basins()[at].overflows_to.is_none();
        let rain = runoff * time + direct * march.area_time;
        let evaporated = evaporation * march.area_time;
        let infiltrated = seepage * march.area_time;
        let spilled = self.spill[at] * time;
        let volume = &mut self.state.volumes[at];
        for amount in [
            rain,
            self.received[at] * time,
            -evaporated,
            -infiltrated,
            -march.drained,
            -spilled,
        ] {
            if amount != 0.0 {
                volume.add(amount);
            }
        }
        let totals = &mut self.state.totals;
        totals.rain.add(rain);
        totals.evaporated.add(evaporated);
        totals.infiltrated.add(infiltrated);
        totals.drained.add(march.drained);
        let target = march.rests_at.or((volume.total() < 0.0).then_some(0.0));
        if let Some(target) = target {
            // What rounding put off the bend, or took more than there was.
            let mut excess = volume.cut_to(target);
            let taker = if evaporation > 0.0 {
                &mut totals.evaporated
            } else if seepage > 0.0 {
                &mut totals.infiltrated
            } else if march.drained > 0.0 {
                &mut totals.drained
            } else {
                excess = excess.negated();
                &mut totals.rain
            };
            taker.add_store(excess);
        }
        let rates = &mut self.rates;
        rates.rain += runoff + direct * march.area;
        rates.evaporated += evaporation * march.area;
        rates.infiltrated += seepage * march.area;
        rates.drained += march.flow;
        if leaves {
            totals.left.add(spilled);
            rates.left += self.spill[at];
        }
    }

    /// Finds when a pool that is not full will be, or will part, or has to be looked at again, if within the step.
    pub(super) fn predict(&mut self, pool: u32, now: f64) {
        let at = pool as usize;
        if !self.predicting || self.state.full[at] {
            return;
        }
        let volume = self.state.volumes[at].total();
        let left = self.end - now;
        let model = self.pool(pool);
        // Bounds of the rate over all levels: most steps end far from both brim and sill.
        let rates =
            [model.curve.area_in(0), model.curve.full_area_m2()].map(|area| model.inflow + model.per_area * area);
        let may_fill = volume + rates[0].max(rates[1]) * left >= model.curve.capacity_m3();
        let may_part = self.basins.basins()[at].children.is_some()
            && (!model.own_drains.is_empty() || volume + rates[0].min(rates[1]) * left <= model.curve.base_volume);
        let mut time = f64::INFINITY;
        if may_fill || may_part {
            let march = model.march(volume, left, AHEAD);
            if matches!(march.stop, Stop::Full | Stop::Split) || march.time < left {
                time = now + march.time;
                self.due[at] = march.stop;
            }
        }
        self.events.set(pool, time);
    }

    /// Decides what a full pool does: spills what it gains, meets its sibling, or falls; and so on downstream.
    pub(super) fn balance(&mut self, pool: u32, now: f64) {
        let basins = Arc::clone(&self.basins);
        let mut pool = pool;
        while self.state.full[pool as usize] && self.state.is_pool(&basins, pool) {
            let at = pool as usize;
            let (mut net, gross) = self.net_when_full(pool);
            if let Some((sibling, parent)) = self.full_sibling(pool) {
                let (other, other_gross) = self.net_when_full(sibling);
                // What they spill into each other stays in the pair.
                let joint = net + other - self.spill[at] - self.spill[sibling as usize];
                let level = EQUAL * (gross + other_gross);
                if joint > level && (net > 0.0 || other > 0.0) {
                    self.meet(pool, sibling, parent, now);
                    pool = parent;
                    if basins.basins()[parent as usize].volume_m3 <= Some(basins.curve(parent).base_volume)
                        && basins.basins()[parent as usize].volume_m3.is_some()
                    {
                        self.state.full[parent as usize] = true;
                        continue;
                    }
                    self.predict(parent, now);
                    return;
                }
                if self.spill[sibling as usize] > 0.0 && net > 0.0 {
                    net = 0.0;
                }
            }
            let spill = net.max(0.0);
            let change = spill - self.spill[at];
            let starts = i32::from(spill > 0.0) - i32::from(self.spill[at] > 0.0);
            self.spill[at] = spill;
            self.events.set(pool, f64::INFINITY);
            if net < 0.0 {
                self.state.full[at] = false;
                self.predict(pool, now);
            }
            let (Some(leaf), true) = (basins.basins()[at].overflows_to, change != 0.0) else {
                return;
            };
            pool = self.state.pool_of(&basins, leaf);
            self.follow(pool, now);
            self.receive(leaf, change, starts);
            self.predict(pool, now);
        }
    }

    /// Rate at which a full pool gains (0 within rounding), and the size of what it is made of. Units: m³/s.
    fn net_when_full(&self, pool: u32) -> (f64, f64) {
        let model = self.pool(pool);
        let (net, area, flow) = model.full();
        let forcing = &self.forcing;
        let rain = (forcing.rain_m_s + forcing.runoff_m_s) * self.exposed[pool as usize];
        let losses = (forcing.evaporation_m_s + forcing.seepage_m_s) * area + flow;
        let gross = rain + self.received[pool as usize] + losses;
        (if net.abs() <= EQUAL * gross { 0.0 } else { net }, gross)
    }

    /// The sibling and the parent, if the sibling is a full pool.
    pub(super) fn full_sibling(&self, pool: u32) -> Option<(u32, u32)> {
        let parent = self.basins.basins()[pool as usize].parent?;
        let children = self.basins.basins()[parent as usize].children?;
        let sibling = if children[0] == pool { children[1] } else { children[0] };
        (self.state.full[sibling as usize] && self.state.is_pool(&self.basins, sibling)).then_some((sibling, parent))
    }

    /// Makes two full pools one.
    fn meet(&mut self, pool: u32, sibling: u32, parent: u32, now: f64) {
        for child in [pool, sibling] {
            self.follow(child, now);
        }
        for child in [pool, sibling] {
            let spill = core::mem::take(&mut self.spill[child as usize]);
            if let (Some(leaf), true) = (self.basins.basins()[child as usize].overflows_to, spill > 0.0) {
                self.receive(leaf, -spill, -1);
            }
            self.events.set(child, f64::INFINITY);
        }
        self.unite(pool, sibling, parent);
        self.received[parent as usize] = self.received[pool as usize] + self.received[sibling as usize];
        self.donors[parent as usize] = self.donors[pool as usize] + self.donors[sibling as usize];
        self.clock[parent as usize] = now;
    }

    /// Changes what a leaf, and the pool of which it is part, gets from others.
    fn receive(&mut self, leaf: u32, change: f64, starts: i32) {
        let pool = self.state.pool_of(&self.basins, leaf);
        self.receive_at(leaf, change, starts);
        if pool != leaf {
            self.receive_at(pool, change, starts);
        }
    }

    fn receive_at(&mut self, basin: u32, change: f64, starts: i32) {
        let donors = &mut self.donors[basin as usize];
        *donors = donors.saturating_add_signed(starts);
        let received = &mut self.received[basin as usize];
        // Without donors exactly nothing, so that rounding does not run on.
        *received = if *donors == 0 {
            0.0
        } else {
            (*received + change).max(0.0)
        };
    }

    /// Shares what a pool gets from others between its children: counts the smaller one's leaves.
    pub(super) fn share_received(&mut self, pool: u32, children: [u32; 2]) {
        let basins = Arc::clone(&self.basins);
        let leaves = |basin: u32| basins.basins()[basin as usize].leaves;
        let [a, b] = children;
        let (small, large) = if leaves(a) < leaves(b) { (a, b) } else { (b, a) };
        let (mut received, mut donors) = (0.0, 0);
        self.open.push(small);
        while let Some(basin) = self.open.pop() {
            match basins.basins()[basin as usize].children {
                Some(inner) => self.open.extend(inner),
                None => {
                    received += self.received[basin as usize];
                    donors += self.donors[basin as usize];
                }
            }
        }
        let rest = self.donors[pool as usize].saturating_sub(donors);
        self.received[large as usize] = if rest == 0 {
            0.0
        } else {
            (self.received[pool as usize] - received).max(0.0)
        };
        self.donors[large as usize] = rest;
        self.received[small as usize] = received;
        self.donors[small as usize] = donors;
    }
}
