//! Roofs of a scenario that pour.

use bevy::prelude::*;
use rain_core::error::ConfigError;
use serde::{Deserialize, Serialize};

use super::file::{Scenario, Vector};
use rain_ecs::prelude::{Spout, SpoutForm};

/// Water of a roof that leaves it here: fields of [`Spout`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RoofSpout {
    /// Middle of the edge, or the mouth of the pipe. Units: m. Domain: each within ±1 000 000. Required.
    pub position: Vector,
    /// Away from the roof, from +Z towards +X; an edge runs across. Units: degrees. Domain: ±36 000. Default: 0.
    #[serde(default)]
    pub yaw_deg: f64,
    /// `Eave(length_m: …)` or `Pipe(diameter_m: …)`. Required.
    pub form: RoofSpoutForm,
    /// Area of roof that drains here. Units: m². Domain: [0, 10⁶]. Default: of an eave its length by `flow_length_m`, of
    /// a pipe 40.
    #[serde(default)]
    pub catchment_m2: Option<f64>,
    /// Way of the water over the roof. Units: m. Domain: [0.01, 1000]. Default: 4.
    #[serde(default = "flow_length")]
    pub flow_length_m: f64,
    /// Fall of the roof per length. Units: none. Domain: [0.001, 10]. Default: 0.5.
    #[serde(default = "slope")]
    pub slope: f64,
}

/// What the water leaves by.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum RoofSpoutForm {
    /// The edge of a roof.
    Eave {
        /// Units: m. Domain: [0.01, 1000].
        length_m: f64,
    },
    /// The open end of a pipe.
    Pipe {
        /// Units: m. Domain: [0.001, 2].
        diameter_m: f64,
    },
}

fn flow_length() -> f64 {
    4.0
}

fn slope() -> f64 {
    0.5
}

impl RoofSpout {
    fn spout(&self) -> Spout {
        let (form, catchment_m2) = match self.form {
            RoofSpoutForm::Eave { length_m } => (
                SpoutForm::Eave {
                    length_m: length_m as f32,
                },
                length_m * self.flow_length_m,
            ),
            RoofSpoutForm::Pipe { diameter_m } => (
                SpoutForm::Pipe {
                    diameter_m: diameter_m as f32,
                },
                40.0,
            ),
        };
        Spout {
            form,
            catchment_m2: self.catchment_m2.unwrap_or(catchment_m2) as f32,
            slope: self.slope as f32,
            flow_length_m: self.flow_length_m as f32,
            feeds_ground: true,
        }
    }

    /// # Errors
    /// The first field outside its domain and where it stands, but for the position, which is for the caller to check.
    pub(super) fn check(&self) -> Result<(), (&'static str, ConfigError)> {
        let of_form = |field: &str| matches!(field, "length_m" | "diameter_m");
        self.spout().validated().map(|_| ()).map_err(|error| match error {
            ConfigError::OutOfRange { field, .. } if of_form(field) => (".form", error),
            _ => ("", error),
        })
    }

    fn pose(&self) -> Transform {
        let [x, y, z] = self.position.map(|v| v as f32);
        let (sin, cos) = (self.yaw_deg as f32).to_radians().sin_cos();
        Transform::from_xyz(x, y, z).looking_to(Vec3::new(sin, 0.0, cos), Vec3::Y)
    }
}

/// Puts the scenario's spouts into the world.
pub(super) fn spawn(app: &mut App, scenario: &Scenario) {
    for (number, spout) in scenario.spouts.iter().enumerate() {
        app.world_mut()
            .spawn((Name::new(format!("spout {number}")), spout.pose(), spout.spout()));
    }
}
