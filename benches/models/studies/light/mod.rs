//! Work against precision: light at a surface, in a drop and through rain.

mod drop;
mod haze;
mod surface;

use rain_bench::study::Study;

/// Every study of this folder.
pub fn studies() -> Vec<Study> {
    [surface::studies(), drop::studies(), haze::studies()]
        .into_iter()
        .flatten()
        .collect()
}
