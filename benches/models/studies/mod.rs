//! Every study, one file for each phenomenon.

mod basins;
mod canopy;
mod cover;
mod drop;
mod drop_count;
mod fall;
mod fall_speed;
mod ground;
mod hash;
mod lamps;
mod light;
mod ripples;
mod spectrum;
mod splash;
mod streaks;
mod surface;
mod wave_grid;
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
        lamps::studies(),
        streaks::studies(),
        drop_count::studies(),
        hash::studies(),
        canopy::studies(),
        weather::studies(),
        surface::studies(),
        basins::studies(),
        waves::studies(),
        splash::studies(),
        wheels::studies(),
        grids(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Those of maps and tiles: what a cell costs and what it errs.
pub fn grids() -> Vec<Study> {
    [
        cover::studies(),
        ground::studies(),
        wave_grid::studies(),
        ripples::studies(),
    ]
    .into_iter()
    .flatten()
    .collect()
}
