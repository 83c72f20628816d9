//! The generated files, read back with the `gltf` crate and measured.

mod car;
mod files;
mod geometry;
mod places;
mod rain;
mod road;
mod scene;
mod walls;
