//! What a kind of ground does with water.

use serde::{Deserialize, Serialize};

use super::horton::Infiltration;
use crate::error::{ConfigError, in_range};
use crate::ops;

/// Kinds of ground with ready-made [`SurfaceProperties`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SurfaceClass {
    /// Dense asphalt road, the reference surface.
    #[default]
    Asphalt,
    /// Brushed concrete.
    Concrete,
    /// Paving stones and setts.
    Stone,
    /// Gravel and loose stone.
    Gravel,
    /// Bare loam.
    Soil,
    /// Short grass on loam.
    Grass,
    /// Tiles and sheet metal, steep and smooth.
    Roof,
}

impl SurfaceClass {
    /// Number of classes.
    pub const COUNT: usize = 7;

    /// All classes; `ALL[class.index()] == class`.
    pub const ALL: [Self; Self::COUNT] = [
        Self::Asphalt,
        Self::Concrete,
        Self::Stone,
        Self::Gravel,
        Self::Soil,
        Self::Grass,
        Self::Roof,
    ];

    /// Position in [`SurfaceClass::ALL`].
    #[must_use]
    pub fn index(self) -> usize {
        self as usize
    }

    /// The properties of the class.
    ///
    /// Manning n: Engman 1986, Brown et al. 2009. Texture depth: sand-patch values of roads, depression storage of
    /// soil and lawn (ASCE 1992). Infiltration: dry loam with 76 mm/h, doubled under grass, sand under gravel (SWMM
    /// manual, Rossman & Huber 2016; Rawls et al. 1983). Pore capacity, slope and flow length are choices for a street.
    #[must_use]
    pub fn properties(self) -> SurfaceProperties {
        // pores mm, texture mm, Manning n, slope, flow length m
        let (pore_capacity_mm, texture_depth_mm, manning_n, slope, flow_length_m) = match self {
            Self::Asphalt => (0.5, 0.8, 0.015, 0.02, 5.0),
            Self::Concrete => (0.4, 0.5, 0.012, 0.015, 5.0),
            Self::Stone => (0.25, 1.0, 0.015, 0.015, 3.0),
            Self::Gravel => (1.5, 2.0, 0.025, 0.02, 4.0),
            Self::Soil => (3.0, 1.5, 0.03, 0.03, 10.0),
            Self::Grass => (2.5, 2.5, 0.15, 0.04, 10.0),
            Self::Roof => (0.1, 0.05, 0.012, 0.5, 6.0),
        };
        let loam = Infiltration {
            initial_mm_h: 76.0,
            final_mm_h: 13.0,
            decay_per_h: 4.14,
            recovery_per_s: Infiltration::WEEK_RECOVERY_PER_S,
        };
        let infiltration = match self {
            Self::Asphalt | Self::Concrete | Self::Stone | Self::Roof => Infiltration::NONE,
            Self::Gravel => Infiltration {
                initial_mm_h: 254.0,
                final_mm_h: 117.8,
                ..loam
            },
            Self::Soil => loam,
            Self::Grass => Infiltration {
                initial_mm_h: 152.0,
                ..loam
            },
        };
        SurfaceProperties {
            pore_capacity_mm,
            texture_depth_mm,
            manning_n,
            slope,
            flow_length_m,
            infiltration,
        }
    }
}

/// Water-related properties of a surface. A depth in mm is volume per plan area.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SurfaceProperties {
    /// Water that the material's pores and interception hold; full = wetness 1. Units: mm. Domain: [1e-6, 1000].
    pub pore_capacity_mm: f64,
    /// Water that the texture holds before any runs off (the sand-patch mean texture depth is a volume per area).
    /// Units: mm. Domain: [0, 1000].
    pub texture_depth_mm: f64,
    /// Manning roughness. Units: s/m^(1/3). Domain: [0.001, 10].
    pub manning_n: f64,
    /// Fall per length along the flow. Units: none. Domain: [0, 10]; 0 = no drain.
    pub slope: f64,
    /// Length of the flow path to an edge or gully. Units: m. Domain: [0.01, 10000].
    pub flow_length_m: f64,
    /// Infiltration into the ground below.
    pub infiltration: Infiltration,
}

impl SurfaceProperties {
    /// These properties, if every one lies in its domain.
    ///
    /// # Errors
    /// Names the first field that does not.
    pub fn validated(self) -> Result<Self, ConfigError> {
        in_range("pore_capacity_mm", self.pore_capacity_mm, 1e-6, 1e3, "1e-6 to 1000 mm")?;
        in_range("texture_depth_mm", self.texture_depth_mm, 0.0, 1e3, "0 to 1000 mm")?;
        in_range("manning_n", self.manning_n, 1e-3, 10.0, "0.001 to 10 s/m^(1/3)")?;
        in_range("slope", self.slope, 0.0, 10.0, "0 to 10")?;
        in_range("flow_length_m", self.flow_length_m, 0.01, 1e4, "0.01 to 10000 m")?;
        self.infiltration.validated()?;
        Ok(self)
    }

    /// κ in the drain κ w^(5/3), w = film above the texture in mm. Units: mm^(−2/3)/s.
    ///
    /// In SI the drain is k w^(5/3) with k = √S/(n ℓ) (kinematic sheet flow with Manning's law over a plane, w = depth
    /// at its foot); with w in mm, κ = k·1000^(−2/3) = k/100. Error: 2e-15 relative.
    #[must_use]
    pub fn drain_coefficient(&self) -> f64 {
        ops::sqrt(self.slope) / (self.manning_n * self.flow_length_m) / 100.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_are_valid_and_indexed() {
        for (i, class) in SurfaceClass::ALL.into_iter().enumerate() {
            assert_eq!(class.index(), i);
            assert!(class.properties().validated().is_ok(), "{class:?}");
        }
    }

    #[test]
    fn the_drain_coefficient_is_mannings() {
        let p = SurfaceProperties {
            slope: 0.02,
            manning_n: 0.015,
            flow_length_m: 5.0,
            ..SurfaceClass::Asphalt.properties()
        };
        // α = √S/n = 9.428; k = α/ℓ = 1.8856 (the value of the film check in docs/physics.md).
        assert!((p.drain_coefficient() * 100.0 - 1.885_618).abs() < 1e-6);
    }

    #[test]
    fn each_property_is_checked_and_named() {
        type Set = fn(&mut SurfaceProperties, f64);
        let fields: [(&str, Set, f64, f64); 5] = [
            ("pore_capacity_mm", |p, v| p.pore_capacity_mm = v, 0.0, 1001.0),
            ("texture_depth_mm", |p, v| p.texture_depth_mm = v, -0.1, 1001.0),
            ("manning_n", |p, v| p.manning_n = v, 0.0, 11.0),
            ("slope", |p, v| p.slope = v, -0.1, 10.1),
            ("flow_length_m", |p, v| p.flow_length_m = v, 0.0, 1.1e4),
        ];
        for (name, set, low, high) in fields {
            for bad in [low, high, f64::NAN, f64::INFINITY] {
                let mut p = SurfaceClass::Grass.properties();
                set(&mut p, bad);
                let message = p.validated().expect_err("invalid").to_string();
                assert!(message.starts_with(name), "{message}");
            }
        }
    }
}
