//! Wall time, and what all threads of this process ran: on a software adapter the GPU's work is among it, and other
//! processes' is not.

use std::time::Instant;

/// A moment.
pub struct Moment {
    wall: Instant,
    ran_ns: Option<u64>,
}

/// What has passed since a moment. Units: ms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passed {
    /// On the wall.
    pub wall_ms: f64,
    /// On all cores together; `None` where the system does not tell.
    pub cpu_ms: Option<f64>,
}

impl Moment {
    /// Now.
    #[must_use]
    pub fn now() -> Self {
        Self {
            ran_ns: ran_ns(),
            wall: Instant::now(),
        }
    }

    /// Since this moment. A running thread's time may be a scheduler's tick old: add up many.
    #[must_use]
    pub fn passed(&self) -> Passed {
        let wall_ms = self.wall.elapsed().as_secs_f64() * 1e3;
        let ran = self.ran_ns.zip(ran_ns());
        Passed {
            wall_ms,
            cpu_ms: ran.map(|(then, now)| now.saturating_sub(then) as f64 * 1e-6),
        }
    }
}

/// Time that this process's threads have run. Units: ns.
fn ran_ns() -> Option<u64> {
    let tasks = std::fs::read_dir("/proc/self/task").ok()?;
    let ran = tasks.flatten().filter_map(|task| {
        let text = std::fs::read_to_string(task.path().join("schedstat")).ok()?;
        text.split_whitespace().next()?.parse::<u64>().ok()
    });
    Some(ran.sum())
}

/// The middle of the wall times, and the mean of what ran.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize)]
pub struct Summary {
    /// Units: ms.
    pub wall_ms: f64,
    /// Units: ms.
    pub cpu_ms: Option<f64>,
}

impl Summary {
    /// Of these.
    #[must_use]
    pub fn of(all: &[Passed]) -> Self {
        let mut walls: Vec<f64> = all.iter().map(|p| p.wall_ms).collect();
        walls.sort_by(f64::total_cmp);
        let ran: Option<Vec<f64>> = all.iter().map(|p| p.cpu_ms).collect();
        Self {
            wall_ms: walls.get(walls.len() / 2).copied().unwrap_or_default(),
            cpu_ms: ran
                .filter(|r| !r.is_empty())
                .map(|r| r.iter().sum::<f64>() / r.len() as f64),
        }
    }

    /// Less `other`.
    #[must_use]
    pub fn over(self, other: Self) -> Self {
        Self {
            wall_ms: self.wall_ms - other.wall_ms,
            cpu_ms: self.cpu_ms.zip(other.cpu_ms).map(|(a, b)| a - b),
        }
    }
}
