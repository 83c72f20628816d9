//! Captures of a scenario whose pixels know where in the world they lie.

use std::path::Path;

use bevy::math::{DVec2, DVec3};
use bevy::prelude::*;
use rain_plugins::prelude::*;
use rain_plugins::scenario::file::{CameraKey, Mask, Outputs, RainSettings};
use rain_plugins::scenario::{Capture, Scenario, Session, weather};

/// Time between two views of a [`Plan`]. Units: s.
pub const VIEW_STEP_S: f64 = 0.25;

/// A camera pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// The eye. Units: m.
    pub eye: DVec3,
    /// What it looks at. Units: m.
    pub target: DVec3,
    /// Vertical field of view. Units: degrees.
    pub fov_y_deg: f64,
}

impl View {
    /// A view with a vertical field of 60°.
    #[must_use]
    pub fn new(eye: [f64; 3], target: [f64; 3]) -> Self {
        Self {
            eye: DVec3::from_array(eye),
            target: DVec3::from_array(target),
            fov_y_deg: 60.0,
        }
    }

    /// The same view with another field. Units: degrees.
    #[must_use]
    pub fn fov(self, fov_y_deg: f64) -> Self {
        Self { fov_y_deg, ..self }
    }
}

/// Steady weather from the start. Units: mm/h, m/s (where the air goes).
#[must_use]
pub fn steady(intensity_mm_h: f64, wind_m_s: [f64; 3]) -> weather::Weather {
    weather::Weather {
        base: WeatherConditions {
            intensity_mm_h,
            wind_m_s: DVec3::from_array(wind_m_s),
            ..WeatherConditions::default()
        },
        ..weather::Weather::default()
    }
}

/// A scenario that looks from several places, one after the other.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The scenario; tests change what they need.
    pub scenario: Scenario,
    views: Vec<View>,
    start_s: f64,
}

impl Plan {
    /// Steady `weather`, seen from `views`, the first at `start_s`, 160 × 90 pixels, with all masks, 20 000 streaks.
    #[must_use]
    pub fn new(weather: weather::Weather, start_s: f64, views: &[View]) -> Self {
        let keys = views.iter().enumerate().map(|(i, view)| CameraKey {
            time_s: if i == 0 {
                0.0
            } else {
                start_s + (i as f64 - 0.5) * VIEW_STEP_S
            },
            eye: view.eye.to_array(),
            target: view.target.to_array(),
            fov_y_deg: view.fov_y_deg,
            cut: i > 0,
        });
        let mut scenario = Scenario {
            duration_s: start_s + views.len() as f64 * VIEW_STEP_S + 1.0,
            weather,
            rain: RainSettings {
                streak_budget: 20_000,
                // Surfaces and streaks are measured in clear air.
                haze: false,
                ..RainSettings::default()
            },
            outputs: Outputs {
                size: [160, 90],
                masks: vec![Mask::Rain, Mask::Wet, Mask::Depth, Mask::Water],
                ..Outputs::default()
            },
            ..Scenario::default()
        };
        scenario.camera.keys = keys.collect();
        scenario.environment.bloom = false;
        // Masks do not show what surfaces mirror.
        scenario.environment.probe = false;
        Self {
            scenario,
            views: views.to_vec(),
            start_s,
        }
    }

    /// When view `index` is taken. Units: s.
    #[must_use]
    pub fn time_s(&self, index: usize) -> f64 {
        self.start_s + index as f64 * VIEW_STEP_S
    }

    /// Starts the scenario; files are looked up in `folder`, and `build` adds what the test puts into the world.
    ///
    /// # Panics
    /// When the scenario does not start.
    #[must_use]
    pub fn session(&self, folder: &Path, build: impl FnOnce(&mut World)) -> Session {
        let mut session = Session::new(&self.scenario, folder).expect("the scenario starts");
        build(session.app().world_mut());
        session
    }

    /// Takes every view.
    ///
    /// # Panics
    /// When a picture does not come back.
    pub fn shoot(&self, session: &mut Session) -> Vec<Shot> {
        (0..self.views.len()).map(|i| self.shot(session, i)).collect()
    }

    /// Takes view `index`; indices must rise.
    ///
    /// # Panics
    /// When the picture does not come back.
    pub fn shot(&self, session: &mut Session, index: usize) -> Shot {
        let capture = session.capture(self.time_s(index)).expect("a capture");
        Shot {
            view: self.views[index],
            size: self.scenario.outputs.size,
            capture,
        }
    }
}

/// One view with its masks.
#[derive(Debug, Clone)]
pub struct Shot {
    /// From where.
    pub view: View,
    /// Width and height. Units: px.
    pub size: [u32; 2],
    /// Picture and masks.
    pub capture: Capture,
}

/// One pixel of a [`Shot`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pixel {
    /// Column and row.
    pub at: [u32; 2],
    /// Coverage by streaks, [0, 1].
    pub rain: f64,
    /// Pore saturation, [0, 1].
    pub wet: f64,
    /// Depth of standing water. Units: m.
    pub water: f64,
    /// The surface that it shows; `None` for the sky and beyond 65 m.
    pub surface: Option<DVec3>,
    /// Mean of the three 8-bit channels.
    pub brightness: f64,
}

impl Shot {
    /// Every pixel, row by row.
    #[must_use]
    pub fn pixels(&self) -> Vec<Pixel> {
        let [width, height] = self.size;
        let forward = (self.view.target - self.view.eye).normalize();
        let up = if forward.y.abs() > 0.999 {
            DVec3::NEG_Z
        } else {
            DVec3::Y
        };
        let right = forward.cross(up).normalize();
        let up = right.cross(forward);
        let tan = (0.5 * self.view.fov_y_deg.to_radians()).tan();
        let aspect = f64::from(width) / f64::from(height);
        let texel = |mask: Mask, i: usize| self.capture.mask(mask).map_or(0, |m| m[i]);
        let mut pixels = Vec::with_capacity((width * height) as usize);
        for y in 0..height {
            for x in 0..width {
                let i = (y * width + x) as usize;
                let ndc = DVec2::new(
                    (f64::from(x) + 0.5) / f64::from(width) * 2.0 - 1.0,
                    1.0 - (f64::from(y) + 0.5) / f64::from(height) * 2.0,
                );
                let ray = (forward + right * (ndc.x * tan * aspect) + up * (ndc.y * tan)).normalize();
                let depth = texel(Mask::Depth, i);
                let [r, g, b] = self.capture.frame.get_pixel(x, y).0.map(f64::from);
                pixels.push(Pixel {
                    at: [x, y],
                    rain: f64::from(texel(Mask::Rain, i)) / 65_535.0,
                    wet: f64::from(texel(Mask::Wet, i)) / 65_535.0,
                    water: f64::from(texel(Mask::Water, i)) * 1e-5,
                    surface: (depth < u16::MAX).then(|| self.view.eye + ray * (f64::from(depth) * 1e-3)),
                    brightness: (r + g + b) / 3.0,
                });
            }
        }
        pixels
    }

    /// The pixels whose surface `holds` accepts.
    #[must_use]
    pub fn where_surface(&self, holds: impl Fn(DVec3) -> bool) -> Vec<Pixel> {
        let mut pixels = self.pixels();
        pixels.retain(|p| p.surface.is_some_and(&holds));
        pixels
    }
}

/// How many of these pixels streaks cover at all.
#[must_use]
pub fn raining(pixels: &[Pixel]) -> usize {
    pixels.iter().filter(|p| p.rain > 0.0).count()
}

/// Mean of `value` over these pixels; not a number when there are none, which fails every comparison.
#[must_use]
pub fn mean(pixels: &[Pixel], value: impl Fn(&Pixel) -> f64) -> f64 {
    pixels.iter().map(value).sum::<f64>() / pixels.len() as f64
}
