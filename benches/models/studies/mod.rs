//! Every study, one file for each phenomenon.

mod basins;
mod canopy;
mod drop;
mod fall;
mod fall_speed;
mod hash;
mod light;
mod spectrum;
mod splash;
mod surface;
mod waves;
mod weather;
mod wheels;

use rain_bench::study::Study;

/// All of them.
pub fn all() -> Vec<Study> {
    [
        fall_speed::studies(),
        fall::studies(),
        spectrum::studies(),
        drop::studies(),
        light::studies(),
        hash::studies(),
        canopy::studies(),
        weather::studies(),
        surface::studies(),
        basins::studies(),
        waves::studies(),
        splash::studies(),
        wheels::studies(),
    ]
    .into_iter()
    .flatten()
    .collect()
}
