//! The plugins inside a Bevy app.

mod device_loss;
mod groups;
mod materials;
mod puddles;
mod skipping;
mod two_views;
