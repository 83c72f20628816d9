//! The artists' ways to place puddles on their own meshes: painted channels (Lagarde 2013) and a noise map over a
//! height map (Nguyenova 2021).

use bevy::math::{DVec2, ops};
use bevy::prelude::*;
use rain_core::error::{ConfigError, in_range};
use rain_core::surface::artist_look::{nguyenova_puddle_amount, nguyenova_puddle_depth_mm, screen_blend};
use rain_core::surface::{RutLanes, puddle_map};

/// Where the channels of a [`PuddlePaint`] come from.
///
/// Red: ripples allowed. Green: depth at which a puddle floods, 0 first, 1 never. Blue: 0 always dry, 1 wettable.
/// Alpha: 0 puddle, 1 none, for the form that does not change. White is ground without paint.
#[derive(Reflect, Clone, Debug, Default, PartialEq)]
pub enum PaintSource {
    /// The mesh's vertex colours; they no longer tint it.
    #[default]
    VertexColors,
    /// A linear texture over the mesh's first texture coordinates.
    Texture(Handle<Image>),
}

/// What the picture shows of the paint instead of the surface.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ShowPaint {
    /// Nothing: the surface itself.
    #[default]
    Off,
    /// Red, green and blue as they are.
    Channels,
    /// Red alone: where ripples may be.
    Ripples,
    /// The water gathered now, white.
    Water,
}

/// Puddles painted on an instance of a mesh. They fill by the artists' levels of the weather
/// ([`ArtistState`](rain_core::weather::ArtistState)), in either weather mode, beside those that the ground's
/// basins hold.
#[derive(Component, Reflect, Clone, Debug, PartialEq)]
#[reflect(Component, Default)]
pub struct PuddlePaint {
    /// Where the channels come from.
    pub source: PaintSource,
    /// Puddles that are always there, placed by alpha, instead of such that grow and shrink by green.
    pub fixed: bool,
    /// Flood level over which a puddle's rim fills. Domain: (0, 1]. Default: 0.4.
    pub margin: f32,
    /// Flood level that never dries. Domain: [0, 1]. Default: 0.
    pub least_flood: f32,
    /// Depth of a full puddle, for its colour and waves. Units: m. Domain: [0, 1]. Default: 0.01.
    pub depth_m: f32,
    /// Whether the material's depth map (its parallax height) also holds water in its holes.
    pub height_map: bool,
    /// What to show for checking.
    pub show: ShowPaint,
}

impl Default for PuddlePaint {
    fn default() -> Self {
        Self {
            source: PaintSource::default(),
            fixed: false,
            margin: 0.4,
            least_flood: 0.0,
            depth_m: 0.01,
            height_map: true,
            show: ShowPaint::Off,
        }
    }
}

/// Wheel ruts that [`NoisePuddles`] gather in and stretch along, on roads whose mesh is flat: straight lanes side by side,
/// two ruts to each.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
pub struct WheelRuts {
    /// Where the lanes lead, from the world's z towards its x. Units: rad. Domain: [−10, 10]. Default: 0.
    pub direction_rad: f32,
    /// Width of a lane. Units: m. Domain: [0.1, 1000]. Default: 3.5.
    pub lane_m: f32,
    /// Middle of a lane: distance from the world's origin across the lanes. Units: m. Domain: [−1e6, 1e6]. Default: 1.75,
    /// with the road's middle at the origin.
    pub offset_m: f32,
    /// Distance of a lane's two ruts. Units: m. Domain: [0, 1000]. Default: 1.5.
    pub track_m: f32,
    /// Standard deviation of a rut's bell-shaped cross section. Units: m. Domain: [0.01, 100]. Default: 0.25.
    pub half_width_m: f32,
    /// How far the ground between the ruts stands above their bottoms, as a share of the map: 1 keeps puddles to the ruts
    /// at any level below 1. Domain: [0, 1]. Default: 0.6.
    pub depth: f32,
}

impl Default for WheelRuts {
    fn default() -> Self {
        Self {
            direction_rad: 0.0,
            lane_m: 3.5,
            offset_m: 1.75,
            track_m: 1.5,
            half_width_m: 0.25,
            depth: 0.6,
        }
    }
}

impl WheelRuts {
    fn lanes(self) -> RutLanes {
        RutLanes {
            direction_rad: f64::from(self.direction_rad),
            lane_m: f64::from(self.lane_m),
            offset_m: f64::from(self.offset_m),
            track_m: f64::from(self.track_m),
            half_width_m: f64::from(self.half_width_m),
            depth: f64::from(self.depth),
        }
    }

    /// See `ruts` in the wet material's shader.
    fn uniform(self) -> [Vec4; 2] {
        let (sin, cos) = ops::sin_cos(self.direction_rad);
        [
            Vec4::new(cos, sin, self.offset_m, self.depth),
            Vec4::new(self.lane_m, 0.5 * self.track_m, self.half_width_m, 1.0),
        ]
    }
}

/// Puddles from a noise map in world space, screen-blended with the material's depth map, filled to the artists'
/// puddle level: amount = max(0, level − blended), at most 10 mm deep. Around a puddle the ground is drenched: under a
/// film, without standing water. By its height ground is so wet, drenched or puddle (Nakamae et al. 1990).
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default)]
pub struct NoisePuddles {
    /// Chooses the map.
    pub seed: u32,
    /// Size of the largest puddles. Units: m. Domain: [0.1, 1000]. Default: 4.
    pub size_m: f32,
    /// Level in place of the weather's. Domain: [0, 1]. `None`: the artists' puddle level.
    pub level: Option<f32>,
    /// Stretch along the lanes of `ruts`, without them along the world's z: 1 round. Domain: [1, 100]. Default: 1.
    pub stretch: f32,
    /// Wheel ruts that puddles gather in. Default: none.
    pub ruts: Option<WheelRuts>,
    /// Whether the material's depth map leans puddles into its lower parts.
    pub height_map: bool,
    /// How much of the noise counts: 0 leaves the material's depth map alone, which fills joints and cracks.
    /// Domain: [0, 1]. Default: 1.
    pub noise: f32,
    /// Height over the level, in shares of the map, up to which the ground around a puddle is drenched; 0: wet ground
    /// passes straight into puddle. Domain: [0, 1]. Default: 0.1.
    pub drenched: f32,
}

impl Default for NoisePuddles {
    fn default() -> Self {
        Self {
            seed: 0,
            size_m: 4.0,
            level: None,
            stretch: 1.0,
            ruts: None,
            height_map: true,
            noise: 1.0,
            drenched: 0.1,
        }
    }
}

impl PuddlePaint {
    /// This paint, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not finite or outside its domain.
    pub fn validated(&self) -> Result<&Self, ConfigError> {
        in_range(
            "margin",
            f64::from(self.margin),
            f64::from(1e-4_f32),
            1.0,
            "0.0001 to 1",
        )?;
        in_range("least_flood", f64::from(self.least_flood), 0.0, 1.0, "0 to 1")?;
        in_range("depth_m", f64::from(self.depth_m), 0.0, 1.0, "0 to 1 m")?;
        Ok(self)
    }

    /// See `Paint` in the wet material's shader.
    pub(super) fn uniform(&self) -> [Vec4; 2] {
        let source = match self.source {
            PaintSource::VertexColors => 1.0,
            PaintSource::Texture(_) => 2.0,
        };
        let flag = |b: bool| f32::from(u8::from(b));
        [
            Vec4::new(source, self.margin, self.least_flood, self.depth_m),
            Vec4::new(flag(self.fixed), flag(self.height_map), f32::from(self.show as u8), 0.0),
        ]
    }

    pub(super) fn texture(&self) -> Option<Handle<Image>> {
        match &self.source {
            PaintSource::VertexColors => None,
            PaintSource::Texture(image) => Some(image.clone()),
        }
    }
}

impl NoisePuddles {
    /// Depth of the puddle at a world place (x, z) where the artists' puddle level is `puddles` and the material's relief
    /// has this `height` (0 lowest, 1 highest, 0 without a depth map): what the picture shows. Units: m. In [0, 0.01].
    #[must_use]
    pub fn depth_m(&self, place: DVec2, puddles: f64, height: f64) -> f64 {
        let [x, z] = [f64::from(self.size_m), f64::from(self.size_m * self.stretch)];
        let lanes = self.ruts.map(WheelRuts::lanes);
        let [across, along] = lanes.map_or(place.to_array(), |lanes| lanes.across_and_along(place.x, place.y));
        let rut = lanes.map_or(0.0, |lanes| lanes.height(across));
        let map = screen_blend(
            f64::from(self.noise) * puddle_map(across / x, along / z, self.seed),
            rut,
        );
        let height = if self.height_map { height } else { 0.0 };
        let level = self.level.map_or(puddles, f64::from);
        1e-3 * nguyenova_puddle_depth_mm(nguyenova_puddle_amount(level, screen_blend(map, height)))
    }

    /// These puddles, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not finite or outside its domain.
    pub fn validated(&self) -> Result<&Self, ConfigError> {
        in_range("size_m", f64::from(self.size_m), 0.1, 1000.0, "0.1 to 1000 m")?;
        in_range("level", f64::from(self.level.unwrap_or(0.0)), 0.0, 1.0, "0 to 1")?;
        in_range("stretch", f64::from(self.stretch), 1.0, 100.0, "1 to 100")?;
        in_range("noise", f64::from(self.noise), 0.0, 1.0, "0 to 1")?;
        in_range("drenched", f64::from(self.drenched), 0.0, 1.0, "0 to 1")?;
        self.ruts.map(|ruts| ruts.lanes().validated()).transpose()?;
        Ok(self)
    }

    /// See `Noise` in the wet material's shader.
    pub(super) fn uniform(&self) -> [Vec4; 4] {
        let [ruts, rut_shape] = self.ruts.map_or([Vec4::ZERO; 2], WheelRuts::uniform);
        [
            Vec4::new(
                1.0 / self.size_m,
                1.0 / (self.size_m * self.stretch),
                // Exact in single precision.
                (self.seed & 0xff_ffff) as f32,
                self.level.unwrap_or(-1.0),
            ),
            Vec4::new(1.0, f32::from(u8::from(self.height_map)), self.drenched, self.noise),
            ruts,
            rut_shape,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_grows_with_the_level_and_leans_to_the_low() {
        let noise = NoisePuddles::default();
        let places = || (0..400_u16).map(|i| DVec2::new(f64::from(i % 20) * 0.9, f64::from(i / 20) * 1.1 - 7.0));
        let volume = |noise: NoisePuddles, level: f64, height: f64| -> f64 {
            let depths: Vec<f64> = places().map(|at| noise.depth_m(at, level, height)).collect();
            assert!(depths.iter().all(|d| (0.0..=0.01).contains(d)));
            depths.iter().sum()
        };
        assert_eq!(volume(noise, 0.0, 0.0), 0.0);
        assert!(volume(noise, 0.9, 0.0) > volume(noise, 0.5, 0.0) && volume(noise, 0.5, 0.0) > 0.1);
        assert!(volume(noise, 0.5, 0.2) < 0.7 * volume(noise, 0.5, 0.0));
        let alone = NoisePuddles { noise: 0.0, ..noise };
        let at = |height: f64| alone.depth_m(DVec2::new(3.0, 4.0), 0.7, height);
        assert!(
            (at(0.4) - 0.003).abs() < 1e-12 && at(0.8) == 0.0,
            "{} {}",
            at(0.4),
            at(0.8)
        );
        let own = NoisePuddles {
            level: Some(0.9),
            height_map: false,
            ..noise
        };
        assert!((volume(own, 0.0, 0.7) - volume(noise, f64::from(0.9_f32), 0.0)).abs() < 1e-12);
    }

    #[test]
    fn depth_gathers_in_ruts_and_stretches_along_them() {
        let plain = NoisePuddles {
            size_m: 1.0,
            stretch: 5.0,
            height_map: false,
            ..default()
        };
        let road = NoisePuddles {
            ruts: Some(WheelRuts {
                direction_rad: 0.6,
                depth: 0.8,
                ..default()
            }),
            ..plain
        };
        // Mean depth along the rut of a lane and along the lane's middle.
        let (sin, cos) = (0.6_f32.sin(), 0.6_f32.cos());
        let mean = |noise: NoisePuddles, across: f64| -> f64 {
            let along = (0..2000_u16).map(|i| f64::from(i) * 0.05 - 50.0);
            let (sin, cos) = (f64::from(sin), f64::from(cos));
            along
                .map(|along| {
                    noise.depth_m(
                        DVec2::new(cos * across + sin * along, cos * along - sin * across),
                        0.6,
                        0.0,
                    )
                })
                .sum::<f64>()
                / 2000.0
        };
        let (rut, middle) = (mean(road, 1.0), mean(road, 1.75));
        assert!(rut > 1e-3 && middle < 0.05 * rut, "{rut} {middle}");
        // At a rut's bottom the map is that of the noise alone, turned.
        assert!(mean(plain, 1.75) > 0.5 * rut);
    }

    #[test]
    fn each_field_is_checked_and_named() {
        for bad in [f32::NAN, f32::INFINITY, -0.1, 1001.0] {
            let paints = [
                (
                    "margin",
                    PuddlePaint {
                        margin: bad,
                        ..default()
                    },
                ),
                (
                    "least_flood",
                    PuddlePaint {
                        least_flood: bad,
                        ..default()
                    },
                ),
                (
                    "depth_m",
                    PuddlePaint {
                        depth_m: bad,
                        ..default()
                    },
                ),
            ];
            for (name, paint) in paints {
                let message = paint.validated().expect_err("invalid").to_string();
                assert!(message.starts_with(name), "{message}");
            }
            let noises = [
                (
                    "size_m",
                    NoisePuddles {
                        size_m: bad,
                        ..default()
                    },
                ),
                (
                    "level",
                    NoisePuddles {
                        level: Some(bad),
                        ..default()
                    },
                ),
                (
                    "stretch",
                    NoisePuddles {
                        stretch: bad,
                        ..default()
                    },
                ),
                (
                    "noise",
                    NoisePuddles {
                        noise: bad,
                        ..default()
                    },
                ),
                (
                    "drenched",
                    NoisePuddles {
                        drenched: bad,
                        ..default()
                    },
                ),
            ];
            let ruts = |ruts: WheelRuts| NoisePuddles {
                ruts: Some(ruts),
                ..default()
            };
            let bad_ruts = [
                (
                    "lane_m",
                    ruts(WheelRuts {
                        lane_m: bad,
                        ..default()
                    }),
                ),
                (
                    "depth",
                    ruts(WheelRuts {
                        depth: bad,
                        ..default()
                    }),
                ),
            ];
            for (name, noise) in noises.into_iter().chain(bad_ruts) {
                let message = noise.validated().expect_err("invalid").to_string();
                assert!(message.starts_with(name), "{message}");
            }
        }
        assert!(PuddlePaint::default().validated().is_ok() && NoisePuddles::default().validated().is_ok());
    }
}
