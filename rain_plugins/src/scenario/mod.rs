//! Scenarios: a RON file in, a headless Bevy app with the rain plugins, pictures and a report out.
//!
//! | file | concept |
//! |---|---|
//! | `file.rs`, `captures.rs`, `weather.rs`, `areas.rs`, `expectation.rs` | what the file may say |
//! | `load.rs`, `validate.rs`, `locate.rs`, `error.rs` | reading it, with line and column of what is wrong |
//! | `puddles.rs` | puddles that an artist placed on a part |
//! | `spouts.rs` | edges and pipes that roofs pour from |
//! | `path.rs` | vehicles and cameras as functions of time |
//! | `headless.rs`, `stage.rs`, `session.rs` | the app, its world, its clock |
//! | `sky.rs` | the generated sky environment |
//! | `probe.rs` | the scene mirrored in itself |
//! | `mips.rs` | mip chains for loaded textures |
//! | `measured.rs` | what captured frames took and drew |
//! | `run.rs` | from file to results |
//! | `masks.rs`, `contact.rs`, `plot.rs`, `font.rs`, `report.rs`, `output.rs` | the results |
//! | `expect.rs`, `timeline.rs` | what was expected and what came out |

pub mod above;
pub mod areas;
mod captures;
pub mod contact;
pub mod error;
pub mod expect;
pub mod expectation;
pub mod file;
mod font;
pub mod headless;
mod load;
mod locate;
pub mod masks;
pub mod measured;
mod mips;
pub mod output;
pub mod path;
pub mod plot;
mod probe;
pub mod puddles;
pub mod report;
pub mod run;
pub mod session;
pub mod sky;
pub mod spouts;
mod stage;
pub mod timeline;
pub mod validate;
pub mod weather;

pub use error::ScenarioError;
pub use file::Scenario;
pub use run::{Progress, RunError, RunOptions, run};
pub use session::{Capture, Session};
