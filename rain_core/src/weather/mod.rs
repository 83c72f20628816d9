//! Weather and what it does to a surface: conditions, their course in time, evaporation, and the water on the ground.
//!
//! | file | concept |
//! |---|---|
//! | `conditions.rs` | the state of the air and the rain at one moment |
//! | `preset.rs` | named conditions and the intensity classes |
//! | `timeline.rs` | conditions as a piecewise linear function of time, with exact means |
//! | `hyetograph.rs` | a timeline read from a CSV table |
//! | `gusts.rs` | how the wind swings about its mean |
//! | `evaporation.rs` | Dalton's and Penman's evaporation, dew, drying time |
//! | `surface_class.rs` | what asphalt, stone, grass … do with water |
//! | `store.rs` | an account of water that loses nothing to rounding |
//! | `horton.rs` | infiltration into soil |
//! | `film_course.rs` | the film under constant supply and drain in closed form |
//! | `film_flow.rs` | the film above the texture: supply against drain |
//! | `column.rs` | pores and film of one surface, the physical way |
//! | `column_f32.rs` | the same in single precision, for grids |
//! | `artist.rs` | wetness and water levels, the artists' way |
//! | `rain_types.rs` | the artists' table of rain types |
//! | `surfaces.rs` | all of these together, advanced over conditions or a timeline |

mod artist;
mod column;
mod column_f32;
mod conditions;
mod evaporation;
mod film_course;
mod film_flow;
mod gusts;
pub(crate) mod horton;
mod hyetograph;
mod preset;
mod rain_types;
pub(crate) mod store;
mod surface_class;
mod surfaces;
mod timeline;

pub use artist::{ArtistLaw, ArtistLevel, ArtistSettings, ArtistState, relative_intensity};
pub use column::{ColumnForcing, ColumnLedger, MAX_INTERVAL_S, MAX_SURFACE_RATE_MM_H, SurfaceColumn};
pub use column_f32::{ColumnF32, ColumnRules};
pub use conditions::WeatherConditions;
pub use evaporation::{
    dalton_evaporation_mm_h, dew_point_c, drying_time_s, penman_evaporation_mm_h, saturation_vapour_pressure_pa,
};
pub use gusts::{GustModel, GustSettings, kaimal_share};
pub use horton::Infiltration;
pub use hyetograph::{HyetographError, HyetographProblem, MAX_HYETOGRAPH_ROWS, read_hyetograph};
pub use preset::{IntensityClass, UnknownPreset, WeatherPreset};
pub use rain_types::{RainType, RainTypes};
pub use surface_class::{SurfaceClass, SurfaceProperties};
pub use surfaces::{VARYING_STEP_S, WeatherSurfaces};
pub use timeline::{Keyframe, Timeline, Transition};
