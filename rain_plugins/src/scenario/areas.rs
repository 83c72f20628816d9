//! Rain areas of a scenario.

use rain_core::error::{ConfigError, shown};
use rain_core::rainfall::areas::{
    AreaError, AreaFade, AreaKey, AreaMotion, AreaRain, AreaSettings, AreaShape, DensityMap,
};
use serde::{Deserialize, Serialize};

/// Most areas of a scenario.
pub const MAX_AREAS: usize = rain_core::rainfall::areas::MAX_AREAS;

/// Where it rains, and how much.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RainAreas {
    /// Share of the weather's rain that falls where no area is. Units: none. Domain: [0, 1]. Default: 1; 0: it rains in
    /// areas alone.
    pub outside: f64,
    /// The areas. Domain: at most 256. Default: none.
    pub list: Vec<Area>,
}

impl Default for RainAreas {
    fn default() -> Self {
        Self {
            outside: 1.0,
            list: Vec::new(),
        }
    }
}

/// The outline of an area about its centre.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Shape {
    /// The whole plane. The default.
    #[default]
    Unbounded,
    /// A disc.
    Circle {
        /// Units: m. Domain: [0.1, 1 000 000]. Required.
        radius_m: f64,
    },
    /// An ellipse.
    Ellipse {
        /// Half its axes. Units: m. Domain: each [0.1, 1 000 000]. Required.
        radii_m: [f64; 2],
        /// Turn of the first axis from +X towards +Z. Units: degrees. Domain: ±5000. Default: 0.
        #[serde(default)]
        heading_deg: f64,
    },
    /// A polygon that does not cross itself.
    Polygon {
        /// Corners (x, z) from the centre, 3 to 64. Units: m. Domain: each within ±1 000 000. Required.
        corners_m: Vec<[f64; 2]>,
    },
}

/// What an area does to the rain.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Rain {
    /// A shower of its own. Units: mm/h. Domain: [0, 500].
    Rate(f64),
    /// A multiple of the weather's rain. Units: none. Domain: [0, 100].
    OfWeather(f64),
    /// A factor on all rain in it. Units: none. Domain: [0, 100].
    Scale(f64),
}

/// How far an area's centre has moved at a time.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct AreaPathKey {
    /// Units: s. Default: 0.
    pub time_s: f64,
    /// (x, z). Units: m. Default: (0, 0).
    pub moved: [f64; 2],
}

/// What is painted in an area: a digit for each cell, from `0`, no rain, to `9`, all of it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Painted {
    /// Size of the rectangle about the centre (x, z). Units: m. Domain: each [0.1, 1 000 000]. Required.
    pub size_m: [f64; 2],
    /// Rows of digits from −z on, 2 to 128, each of as many digits from −x on. Required.
    pub rows: Vec<String>,
}

impl Painted {
    fn map(&self) -> Result<DensityMap, String> {
        let width = self.rows.first().map_or(0, |row| row.chars().count());
        let mut values = Vec::with_capacity(width * self.rows.len());
        for row in &self.rows {
            if row.chars().count() != width {
                return Err(format!("rows of {width} and {} digits", row.chars().count()));
            }
            for digit in row.chars() {
                let share = digit.to_digit(10).ok_or_else(|| format!("{digit:?} in a row"))?;
                values.push((share * 255 / 9) as u8);
            }
        }
        DensityMap::new(self.size_m.into(), [width, self.rows.len()], values).map_err(|error| error.to_string())
    }
}

/// A rain area.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Area {
    /// Name for people. Default: empty.
    pub name: String,
    /// Centre (x, z) at time 0. Units: m. Domain: each within ±10 000 000. Default: (0, 0).
    pub centre: [f64; 2],
    /// Outline about it. Default: `Unbounded`.
    pub shape: Shape,
    /// What it does to the rain. Default: `OfWeather(1)`.
    pub rain: Rain,
    /// Width of the soft edge, half of it on each side of the outline. Units: m. Domain: [0, 100 000]. Default: 20.
    pub transition_m: f64,
    /// Where it drifts (x, z). Units: m/s. Domain: length ≤ 200. Default: (0, 0).
    pub velocity_m_s: [f64; 2],
    /// It moves along this path instead. Times rise strictly. Default: none.
    pub path: Vec<AreaPathKey>,
    /// How much of its rain falls where. Default: all of it everywhere.
    pub density: Option<Painted>,
    /// Its rain begins. Units: s. Default: it is there from the start.
    pub start_s: Option<f64>,
    /// It is at full strength so long after that. Units: s. Default: 0.
    pub fade_in_s: f64,
    /// Its rain has ended. Units: s. Default: it stays.
    pub end_s: Option<f64>,
    /// It begins to weaken so long before that. Units: s. Default: 0.
    pub fade_out_s: f64,
}

impl Default for Area {
    fn default() -> Self {
        Self {
            name: String::new(),
            centre: [0.0; 2],
            shape: Shape::default(),
            rain: Rain::OfWeather(1.0),
            transition_m: 20.0,
            density: None,
            velocity_m_s: [0.0; 2],
            path: Vec::new(),
            start_s: None,
            fade_in_s: 0.0,
            end_s: None,
            fade_out_s: 0.0,
        }
    }
}

impl Area {
    /// The area as the simulation takes it, not yet checked.
    #[must_use]
    pub fn settings(&self) -> AreaSettings {
        AreaSettings {
            centre_m: self.centre.into(),
            shape: match &self.shape {
                Shape::Unbounded => AreaShape::Unbounded,
                Shape::Circle { radius_m } => AreaShape::Circle { radius_m: *radius_m },
                Shape::Ellipse { radii_m, heading_deg } => AreaShape::Ellipse {
                    radii_m: (*radii_m).into(),
                    heading_rad: heading_deg.to_radians(),
                },
                Shape::Polygon { corners_m } => AreaShape::Polygon {
                    corners_m: corners_m.iter().map(|c| (*c).into()).collect(),
                },
            },
            rain: match self.rain {
                Rain::Rate(rate) => AreaRain::Rate(rate),
                Rain::OfWeather(share) => AreaRain::OfWeather(share),
                Rain::Scale(factor) => AreaRain::Scale(factor),
            },
            transition_m: self.transition_m,
            // What cannot be painted is refused by the check.
            density: self.density.as_ref().and_then(|painted| painted.map().ok()),
            motion: if self.path.is_empty() {
                AreaMotion::Drift {
                    velocity_m_s: self.velocity_m_s.into(),
                    start_s: 0.0,
                }
            } else {
                AreaMotion::Path {
                    keys: self
                        .path
                        .iter()
                        .map(|key| AreaKey {
                            time_s: key.time_s,
                            moved_m: key.moved.into(),
                        })
                        .collect(),
                }
            },
            fade: AreaFade {
                start_s: self.start_s,
                fade_in_s: self.fade_in_s,
                end_s: self.end_s,
                fade_out_s: self.fade_out_s,
            },
        }
    }

    /// # Errors
    /// Field, value and what is allowed, of the first thing wrong.
    pub(super) fn check(&self) -> Result<(), (String, String, String)> {
        let wrong = |field: &str, value: String, allowed: &str| Err((field.to_owned(), value, allowed.to_owned()));
        if !self.path.is_empty() && self.velocity_m_s != [0.0; 2] {
            return wrong("path", "given beside velocity_m_s".into(), "one of them");
        }
        if let Some(Err(error)) = self.density.as_ref().map(Painted::map) {
            return wrong(
                "density",
                error,
                "2 to 128 rows of as many digits on 0.1 to 1 000 000 m",
            );
        }
        match self.settings().check() {
            Ok(()) => Ok(()),
            Err(AreaError::Config(ConfigError::OutOfRange { field, value, allowed })) => {
                // The file has its own names for these.
                let (field, value, allowed) = match field {
                    "radius_m" | "radii_m" | "corners_m" => ("shape", value, allowed),
                    "heading_rad" => ("shape", value.to_degrees(), "±5000 degrees"),
                    "rate" | "of_weather" | "scale" => ("rain", value, allowed),
                    "centre_m" => ("centre", value, allowed),
                    "time_s" | "moved_m" | "number of keys" => ("path", value, allowed),
                    other => (other, value, allowed),
                };
                wrong(field, shown(value), allowed)
            }
            Err(AreaError::Config(error)) => wrong("path", error.to_string(), "times that rise"),
            Err(error) => wrong(
                "shape",
                error.to_string(),
                "a polygon of 3 to 64 corners that does not cross itself",
            ),
        }
    }
}
