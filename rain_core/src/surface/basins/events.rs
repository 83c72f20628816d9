//! The next event among many pools.

/// A time for each pool and the earliest of them, by a tree of minima.
#[derive(Debug, Clone)]
pub(super) struct Events {
    times: Vec<f64>,
    leaves: usize,
    pending: bool,
}

impl Events {
    pub(super) fn new(pools: usize) -> Self {
        let leaves = pools.next_power_of_two();
        Self {
            times: vec![f64::INFINITY; 2 * leaves],
            leaves,
            pending: false,
        }
    }

    /// No pool has an event.
    pub(super) fn clear(&mut self) {
        if core::mem::take(&mut self.pending) {
            self.times.fill(f64::INFINITY);
        }
    }

    /// Sets a pool's time; infinite: none.
    pub(super) fn set(&mut self, pool: u32, time: f64) {
        if time.is_finite() {
            self.pending = true;
        } else if !self.pending {
            return;
        }
        let mut at = self.leaves + pool as usize;
        self.times[at] = time;
        while at > 1 {
            at /= 2;
            let earliest = self.times[2 * at].min(self.times[2 * at + 1]);
            if self.times[at] == earliest {
                break;
            }
            self.times[at] = earliest;
        }
    }

    /// The earliest time and its pool, the first of several.
    pub(super) fn next(&self) -> Option<(f64, u32)> {
        let time = self.times[1];
        if !self.pending || time == f64::INFINITY {
            return None;
        }
        let mut at = 1;
        while at < self.leaves {
            at = if self.times[2 * at] == time { 2 * at } else { 2 * at + 1 };
        }
        Some((time, (at - self.leaves) as u32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_earliest_comes_first() {
        let mut events = Events::new(5);
        assert_eq!(events.next(), None);
        events.set(3, 2.0);
        events.set(4, 1.0);
        events.set(0, 2.0);
        assert_eq!(events.next(), Some((1.0, 4)));
        events.set(4, f64::INFINITY);
        assert_eq!(events.next(), Some((2.0, 0)));
        events.set(0, f64::INFINITY);
        events.set(3, f64::INFINITY);
        assert_eq!(events.next(), None);
        let mut one = Events::new(1);
        one.set(0, 7.0);
        assert_eq!(one.next(), Some((7.0, 0)));
        one.clear();
        assert_eq!(one.next(), None);
    }
}
