//! Work against precision.

use rain_bench::study::Study;

/// Every study of this file.
pub fn studies() -> Vec<Study> {
    Vec::new()
}
