//! The plugins inside a Bevy app.

mod auto_paint;
mod bad_meshes;
mod by_hand;
mod device_loss;
mod far_scene;
mod groups;
mod large_scene;
mod looks;
mod materials;
mod mirrors;
mod painted;
mod placed_puddles;
mod pond;
mod puddle_look;
mod puddles;
mod rewind;
mod rings;
mod scenes;
mod skipping;
mod splashes;
mod tiles;
mod two_views;
mod views;
mod water_map;
