//! The plugins inside a Bevy app.

mod bad_meshes;
mod by_hand;
mod device_loss;
mod far_scene;
mod groups;
mod large_scene;
mod materials;
mod mirrors;
mod placed_puddles;
mod pond;
mod puddle_look;
mod puddles;
mod rewind;
mod rings;
mod scenes;
mod skipping;
mod two_views;
mod views;
mod water_map;
