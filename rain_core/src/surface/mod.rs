//! Water on the ground: film, road film, infiltration, basins, and how wet surfaces look.
//!
//! | file | concept |
//! |---|---|
//! | `sheet_flow.rs` | kinematic sheet flow on a plane: rise, steady state, recession |
//! | `film_step.rs` | one time step of a texel's film: rain against drain |
//! | `beads.rs` | drops that sit on paint and glass and trickle down |
//! | `film_waves.rs` | wavelets on a film that runs down a slope |
//! | `road_film.rs` | water above the texture of a road, by Gallaway |
//! | `green_ampt.rs` | infiltration by a wetting front |
//! | `grate.rs` | what a gully takes |
//! | `puddle.rs` | one paraboloid puddle: volume, level, filling and drying |
//! | `puddle_map.rs` | noise that places puddles at random |
//! | `rut_lanes.rs` | wheel ruts of a flat road, for that noise |
//! | `surface_state.rs` | dry, wet, drenched, puddle |
//! | `wet_albedo.rs` | how much darker a soaked body is |
//! | `wet_roughness.rs` | how smooth a film makes it |
//! | `wet_texel.rs` | all of that for a texel of a material, baked ahead |
//! | `water_colour.rs` | what clear and muddy water leave of the light |
//! | `basins/` | hollows that fill, spill and merge |
//! | `ground/` | all of it on a grid over a scene |
//! | `artist_look.rs` | the source systems' own rules for wet looks |
//! | `auto_paint.rs` | the masks that artists paint, worked out from geometry |

pub mod artist_look;
pub mod basins;
pub mod ground;
pub mod height_field;

mod auto_paint;
mod beads;
mod film_step;
mod film_waves;
mod grate;
mod green_ampt;
mod puddle;
mod puddle_map;
mod road_film;
mod rut_lanes;
mod sheet_flow;
mod surface_state;
mod water_colour;
mod wet_albedo;
mod wet_roughness;
mod wet_texel;

pub use auto_paint::{PaintPlace, normalised_painted_depth, painted_channels, painted_depth};
pub use beads::{BEAD_CELLS_M, BEAD_CONTACT_RAD, Beads, TRICKLE_WIDTH_M, bead_at, bead_growth, bead_slope, trickle_at};
pub use film_step::{drained_film, drained_film_f32, fast_film_step_f32, film_step, film_step_f32};
pub use film_waves::{
    FLOW_NOISE, FLOW_PERIOD_S, film_wave_slope, film_wave_speed_of_mm, film_wave_velocity, film_wavelets,
};
pub use grate::Grate;
pub use green_ampt::{GreenAmpt, SoilTexture};
pub use puddle::ParaboloidPuddle;
pub use puddle_map::puddle_map;
pub use road_film::{RoadFilmFit, RoadSurface};
pub use rut_lanes::RutLanes;
pub use sheet_flow::{FlowLaw, SheetFlow, recession_share};
pub use surface_state::{SurfaceState, SurfaceWeights};
pub use water_colour::{Water, mud_phase, under_water};
pub use wet_albedo::{WetBody, saturated_albedo, saturated_albedo_f32, wet_albedo, wet_albedo_f32, wet_albedo_rgb};
pub use wet_roughness::{
    WATER_F0, closed_film_share, closed_film_share_f32, film_roughness, film_roughness_f32, widened_roughness,
};
pub use wet_texel::{FixedWetness, MaterialTexel, wet_texel};
