//! The plugins inside a Bevy app.

mod auto_paint;
mod device_loss;
mod groups;
mod looks;
mod materials;
mod painted;
mod placed_puddles;
mod puddles;
mod skipping;
mod tiles;
mod two_views;
