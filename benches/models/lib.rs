//! Error against time: what is measured, how it is timed, written and drawn.

// The studies name this library as programs do.
extern crate self as rain_bench;

pub mod page;
pub mod plot;
pub mod studies;
pub mod study;
pub mod table;
pub mod timing;

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::path::PathBuf;

    use crate::{studies, table};

    #[test]
    fn every_study_has_one_default_finite_errors_and_variants_that_run() {
        let mut names = BTreeSet::new();
        for mut study in studies::all() {
            assert_eq!(study.fault(), None);
            assert!(names.insert(study.name), "two studies named {}", study.name);
            for variant in &mut study.variants {
                let value = (variant.run)();
                assert!(value.is_finite(), "{}: {} returns {value}", study.name, variant.name);
            }
        }
        assert!(!names.is_empty());
    }

    /// Studies of grids: the bound that the documentation states for the default's error.
    const BOUNDS: [(&str, f64); 15] = [
        ("cover-look-up", 3.0),
        ("cover-build", 3.0),
        ("cover-exposure", 8.0),
        ("ground-puddle-level", 2.0),
        ("ground-puddle-volume", 0.15),
        ("ground-depth", 0.1),
        ("ground-pores", 0.02),
        ("ground-build", 0.15),
        ("ground-queries", 0.1),
        ("ground-interval", 0.02),
        ("wave-dispersion", 0.01),
        ("wave-shore", 0.1),
        ("ripple-tile", 0.15),
        ("ripple-cells", 0.7),
        ("ripple-drops", 0.01),
    ];

    fn published(name: &str) -> Vec<table::Line> {
        let folder = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/benchmarks"));
        table::read(&folder.join(format!("{name}.csv"))).expect("a table")
    }

    #[test]
    fn defaults_of_grids_keep_their_bounds_and_the_tables_hold_what_is_measured() {
        let studies = studies::grids();
        assert_eq!(studies.len(), BOUNDS.len());
        let mut off_the_table = Vec::new();
        for (study, (name, bound)) in studies.iter().zip(BOUNDS) {
            assert_eq!(study.name, name);
            let lines = published(name);
            assert_eq!(lines.len(), study.variants.len(), "{name}");
            for (variant, line) in study.variants.iter().zip(&lines) {
                assert_eq!(
                    (&variant.name, variant.default),
                    (&line.variant, line.default),
                    "{name}"
                );
                if (variant.error - line.error).abs() > 0.01 * line.error {
                    let (now, published) = (variant.error, line.error);
                    off_the_table.push(format!("{name}, {}: {now} now, {published} published", line.variant));
                }
                assert!(!variant.default || variant.error <= bound, "{name}: {}", variant.error);
            }
        }
        assert!(off_the_table.is_empty(), "{off_the_table:#?}");
    }

    #[test]
    fn defaults_of_grids_lie_near_the_front_of_error_and_time() {
        for (name, _) in BOUNDS {
            let lines = published(name);
            let default = lines.iter().find(|line| line.default).expect("one default");
            for line in &lines {
                // Times are of a machine that may have been busy.
                let faster = line.ns_per_evaluation < 0.5 * default.ns_per_evaluation;
                let better = faster && line.error < 0.8 * default.error;
                assert!(!better, "{name}: {} is better than the default in both", line.variant);
            }
        }
    }
}
