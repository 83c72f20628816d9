//! Every model of `rain_core` against `rain_reference`: error bounds over the whole domain, invariants as property
//! tests, and the edges of the domain and beyond.

mod allocation;
mod areas;
mod basins;
mod canopy;
mod check;
mod container;
mod cover;
mod drop;
mod drop_field;
mod fall;
mod fall_speed;
mod gusts;
mod hash;
mod height_field;
mod lattice;
mod lead;
mod lens;
mod light;
mod lightning;
mod quadrature;
mod sound;
mod spectrum;
mod splash;
mod spout;
mod streak_texture;
mod surface;
mod waves;
mod weather;
mod wheels;
