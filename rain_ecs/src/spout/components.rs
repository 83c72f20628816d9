//! Where a roof's water leaves it, and that water.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_transform::components::Transform;
use rain_core::error::{ConfigError, in_range};
use rain_core::spout::{Outflow, eave_mouths};
use rain_core::weather::{SurfaceColumn, SurfaceProperties};

/// What the water leaves by.
#[derive(Reflect, Debug, Clone, Copy, PartialEq)]
pub enum SpoutForm {
    /// The edge of a roof, along the entity's X axis, its middle at the origin: water lets go from mouths 24 mm apart.
    Eave {
        /// Units: m. Domain: [0.01, 1000].
        length_m: f32,
    },
    /// The open end of a gutter's pipe or of a gargoyle, along the entity's forward axis (−Z).
    Pipe {
        /// Units: m. Domain: [0.001, 2].
        diameter_m: f32,
    },
}

/// Water of a roof that pours from here: it drips, and in heavy rain runs in streams that break into drops, splash and
/// feed the ground below. It starts late, when pores and texture are full, and goes on after the rain.
///
/// The roof is a surface of the entity's [`SurfaceMaterial`](crate::surface::SurfaceMaterial) (else tiles and metal) in
/// the open, with the slope and length given here. What falls on the roof *itself* is counted by the ground, which lets
/// it run off by gutters; this is where they end. A value outside its domain is reported by [`crate::RainConfigError`],
/// and the last good ones stay in force.
#[derive(Component, Reflect, Debug, Clone, Copy, PartialEq)]
#[reflect(Component, Debug, Clone, PartialEq, Default)]
#[require(Transform, SpoutWater)]
pub struct Spout {
    /// Edge or pipe. Default: an eave of 1 m.
    pub form: SpoutForm,
    /// Area of roof, seen from above, that drains here. Units: m². Domain: [0, 10⁶]. Default: 4.
    pub catchment_m2: f32,
    /// Fall of the roof per length. Units: none. Domain: [0.001, 10]. Default: 0.5.
    pub slope: f32,
    /// Way of the water over the roof to here. Units: m. Domain: [0.01, 1000]. Default: 4.
    pub flow_length_m: f32,
    /// Whether the water lands on the ground below, where it counts as added. Default: true.
    pub feeds_ground: bool,
}

impl Default for Spout {
    fn default() -> Self {
        Self::eave(1.0, 4.0)
    }
}

impl Spout {
    /// The edge of a roof that is `depth_m` deep behind it, seen from above. Units: m.
    #[must_use]
    pub fn eave(length_m: f32, depth_m: f32) -> Self {
        Self {
            form: SpoutForm::Eave { length_m },
            catchment_m2: length_m * depth_m,
            slope: 0.5,
            flow_length_m: depth_m,
            feeds_ground: true,
        }
    }

    /// The end of a pipe of `diameter_m` (m) that a roof of `catchment_m2` (m²) drains to.
    #[must_use]
    pub fn pipe(diameter_m: f32, catchment_m2: f32) -> Self {
        Self {
            form: SpoutForm::Pipe { diameter_m },
            catchment_m2,
            slope: 0.5,
            flow_length_m: 6.0,
            feeds_ground: true,
        }
    }

    /// This spout, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not finite or outside its domain.
    pub fn validated(self) -> Result<Self, ConfigError> {
        match self.form {
            SpoutForm::Eave { length_m } => in_range("length_m", length_m.into(), 0.01, 1000.0, "0.01 to 1000 m")?,
            SpoutForm::Pipe { diameter_m } => in_range("diameter_m", diameter_m.into(), 0.001, 2.0, "0.001 to 2 m")?,
        };
        in_range("catchment_m2", self.catchment_m2.into(), 0.0, 1e6, "0 to 1e6 m²")?;
        in_range("slope", self.slope.into(), 0.001, 10.0, "0.001 to 10")?;
        in_range(
            "flow_length_m",
            self.flow_length_m.into(),
            0.01,
            1000.0,
            "0.01 to 1000 m",
        )?;
        Ok(self)
    }

    /// Its roof as a surface.
    pub(super) fn roof(&self, of_class: &SurfaceProperties) -> SurfaceProperties {
        SurfaceProperties {
            slope: self.slope.into(),
            flow_length_m: self.flow_length_m.into(),
            ..*of_class
        }
    }
}

/// The water of a [`Spout`]'s roof.
#[derive(Component, Debug, Clone, Default, PartialEq)]
pub struct SpoutWater {
    /// The last good settings.
    pub(super) spout: Option<Spout>,
    pub(super) column: SurfaceColumn,
    /// Mean of the last tick. Units: m³/s.
    pub(super) flow_m3_s: f64,
}

impl SpoutWater {
    /// The settings in force, once a tick has seen them.
    #[must_use]
    pub fn spout(&self) -> Option<&Spout> {
        self.spout.as_ref()
    }

    /// What pours, mean of the last tick. Units: m³/s.
    #[must_use]
    pub fn flow_m3_s(&self) -> f64 {
        self.flow_m3_s
    }

    /// What has poured since the start, over the present catchment. Units: m³.
    #[must_use]
    pub fn poured_m3(&self) -> f64 {
        self.column.ledger().drained_mm * 1e-3 * self.catchment_m2()
    }

    /// What is on the roof: in pores and as film. Units: m³.
    #[must_use]
    pub fn stored_m3(&self) -> f64 {
        (self.column.pores_mm() + self.column.water_level_mm()) * 1e-3 * self.catchment_m2()
    }

    /// The roof's own account per area. Units: mm.
    #[must_use]
    pub fn column(&self) -> &SurfaceColumn {
        &self.column
    }

    fn catchment_m2(&self) -> f64 {
        self.spout.map_or(0.0, |spout| spout.catchment_m2.into())
    }

    /// How the water leaves; of an eave, from a mouth with the mean share. None while nothing pours.
    #[must_use]
    pub fn outflow(&self) -> Option<Outflow> {
        match self.spout?.form {
            SpoutForm::Eave { length_m } => Outflow::of_eave(self.flow_m3_s / f64::from(eave_mouths(length_m.into()))),
            SpoutForm::Pipe { diameter_m } => Outflow::of_pipe(self.flow_m3_s, diameter_m.into()),
        }
    }
}
