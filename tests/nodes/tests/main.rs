//! The passes against their CPU twins, on a bare device.

mod artist_look;
mod cover_parity;
mod device;
mod far;
mod field_parity;
mod hash_parity;
mod maps;
mod optical_depth;
mod reflection;
mod ring_layers;
mod shader_functions;
mod slope_mips;
mod splash;
mod water;
mod water_map;
mod waves;
mod wet_albedo;
