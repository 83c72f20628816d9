//! The passes against their CPU twins, on a bare device.

mod artist_look;
mod cover_parity;
mod device;
mod field_parity;
mod hash_parity;
mod maps;
mod optical_depth;
mod reflection;
mod shader_functions;
mod slope_mips;
mod water;
mod waves;
mod wet_albedo;
