//! The plugins inside a Bevy app.

mod device_loss;
mod groups;
mod materials;
mod placed_puddles;
mod puddles;
mod skipping;
mod two_views;
mod water_map;
