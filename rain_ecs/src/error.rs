//! How a wrong value reaches the user while the application goes on.

use bevy_ecs::prelude::*;
use rain_core::error::ConfigError;

/// A component holds a value outside its domain; the last good value stays in force.
///
/// Written once per change of the component, by the first tick that sees it.
#[derive(Message, Debug, Clone, PartialEq)]
pub struct RainConfigError {
    /// The entity that carries the value.
    pub entity: Entity,
    /// What is wrong: field, value, allowed range.
    pub error: ConfigError,
}
