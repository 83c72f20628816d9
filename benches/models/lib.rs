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

    use crate::studies;

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
}
