//! The plugins inside a Bevy app, and the passes against their CPU twins without Bevy.

mod cover_parity;
mod device;
mod device_loss;
mod field_parity;
mod groups;
mod hash_parity;
mod materials;
mod optical_depth;
mod shader_functions;
mod skipping;
mod two_views;
mod wet_albedo;
