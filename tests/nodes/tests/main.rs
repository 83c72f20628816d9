//! The passes against their CPU twins, on a bare device.

mod artist_look;
mod beads;
mod cover_parity;
mod device;
mod far;
mod far_rain;
mod field_parity;
mod film_waves;
mod glass;
mod hash_parity;
mod haze;
mod lattice;
mod lens;
mod maps;
mod optical_depth;
mod rain_areas;
mod reflection;
mod ring_layers;
mod shader_functions;
mod slope_mips;
mod splash;
mod streak_textures;
mod water;
mod water_map;
mod waves;
mod wet_albedo;
