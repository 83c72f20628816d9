//! The plugins inside a Bevy app.

mod by_hand;
mod device_loss;
mod groups;
mod materials;
mod placed_puddles;
mod pond;
mod puddle_look;
mod puddles;
mod skipping;
mod two_views;
