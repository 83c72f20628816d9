//! Time of every variant, by criterion.

use std::path::Path;
use std::time::Duration;

use criterion::Criterion;
use serde::Deserialize;

use crate::study::Study;

/// Time of one evaluation: median over samples with its 95 % confidence interval. Units: ns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Time {
    /// Median.
    pub median_ns: f64,
    /// Lower end of the interval.
    pub low_ns: f64,
    /// Upper end of the interval.
    pub high_ns: f64,
}

#[derive(Deserialize)]
struct Interval {
    lower_bound: f64,
    upper_bound: f64,
}

#[derive(Deserialize)]
struct Estimate {
    point_estimate: f64,
    confidence_interval: Interval,
}

#[derive(Deserialize)]
struct Estimates {
    median: Estimate,
}

/// How long each variant is run.
#[derive(Debug, Clone, Copy)]
pub struct Effort {
    /// Before measuring.
    pub warm_up: Duration,
    /// While measuring.
    pub measure: Duration,
    /// Samples, at least 10.
    pub samples: usize,
}

impl Effort {
    /// Enough for a figure.
    pub const FULL: Self = Self {
        warm_up: Duration::from_millis(300),
        measure: Duration::from_millis(1500),
        samples: 30,
    };
    /// Enough to see that everything runs.
    pub const QUICK: Self = Self {
        warm_up: Duration::from_millis(20),
        measure: Duration::from_millis(100),
        samples: 10,
    };
}

/// Times every variant of `study`, in order. Criterion keeps its own records in `folder`.
///
/// # Errors
/// When criterion's record of a variant cannot be read; the message names the file.
pub fn time(study: &mut Study, folder: &Path, effort: Effort) -> Result<Vec<Time>, String> {
    let mut criterion = Criterion::default()
        .output_directory(folder)
        .warm_up_time(effort.warm_up)
        .measurement_time(effort.measure)
        .sample_size(effort.samples)
        .without_plots();
    let mut group = criterion.benchmark_group(study.name);
    for (index, variant) in study.variants.iter_mut().enumerate() {
        // Numbers for names: criterion turns other letters into file names of its own making.
        group.bench_function(index.to_string(), |bencher| bencher.iter(|| (variant.run)()));
    }
    group.finish();
    study
        .variants
        .iter()
        .enumerate()
        .map(|(index, variant)| {
            let path = folder
                .join(study.name)
                .join(index.to_string())
                .join("new/estimates.json");
            let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
            let estimates: Estimates =
                serde_json::from_str(&text).map_err(|error| format!("{}: {error}", path.display()))?;
            let each = 1.0 / variant.evaluations as f64;
            Ok(Time {
                median_ns: estimates.median.point_estimate * each,
                low_ns: estimates.median.confidence_interval.lower_bound * each,
                high_ns: estimates.median.confidence_interval.upper_bound * each,
            })
        })
        .collect()
}
