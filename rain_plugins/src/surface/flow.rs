//! Flow of the film over sloping ground: what a mesh adds to the flow that its slopes make.

use bevy::prelude::*;
use rain_core::error::{ConfigError, in_range};

/// How water runs over a mesh. Without it, a film above the texture runs down the mesh's slopes, with wavelets that move
/// as fast as it does ([`rain_core::surface::film_wave_velocity`]); level ground and standing water are calm. An artist
/// may add a flow of the mesh's own, which also moves films on level ground: gutters painted in a flow map, a stream
/// along a kerb. [`WaterAppearance::flow_strength`](super::WaterAppearance) switches all flow off.
#[derive(Component, Reflect, Clone, Debug, PartialEq)]
#[reflect(Component, Default)]
pub struct FilmFlow {
    /// Multiple of the wavelets' slope; 0: none. Domain: [0, 4]. Default: 1.
    pub strength: f32,
    /// Velocity along the world's x and z that is added. Units: m/s. Domain: each [−10, 10]. Default: 0.
    pub velocity_m_s: Vec2,
    /// Flow map: a linear image over the mesh's first texture coordinates. Red and green are the velocity along the
    /// world's x and z, 0 at 0.5, `map_speed_m_s` at 1 and against the axis at 0. Default: none.
    pub map: Option<Handle<Image>>,
    /// What 1 in the flow map means. Units: m/s. Domain: [0.001, 10]. Default: 0.5.
    pub map_speed_m_s: f32,
}

impl Default for FilmFlow {
    fn default() -> Self {
        Self {
            strength: 1.0,
            velocity_m_s: Vec2::ZERO,
            map: None,
            map_speed_m_s: 0.5,
        }
    }
}

/// What the shader of a mesh without the component reads: the flow of its slopes.
pub(super) const OWN_FLOW: Vec4 = Vec4::W;

impl FilmFlow {
    /// This flow, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not finite or outside its domain.
    pub fn validated(&self) -> Result<&Self, ConfigError> {
        const SPEED: &str = "-10 to 10 m/s";
        in_range("strength", f64::from(self.strength), 0.0, 4.0, "0 to 4")?;
        in_range("velocity_m_s", f64::from(self.velocity_m_s.x), -10.0, 10.0, SPEED)?;
        in_range("velocity_m_s", f64::from(self.velocity_m_s.y), -10.0, 10.0, SPEED)?;
        in_range(
            "map_speed_m_s",
            f64::from(self.map_speed_m_s),
            1e-3,
            10.0,
            "0.001 to 10 m/s",
        )?;
        Ok(self)
    }

    /// See `flow` in the wet material's shader.
    pub(super) fn uniform(&self) -> Vec4 {
        let map_speed = if self.map.is_some() { self.map_speed_m_s } else { 0.0 };
        self.velocity_m_s.extend(map_speed).extend(self.strength)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_field_is_checked_and_named() {
        assert!(FilmFlow::default().validated().is_ok());
        assert_eq!(FilmFlow::default().uniform(), OWN_FLOW);
        for bad in [f32::NAN, f32::INFINITY, -11.0] {
            let all = [
                (
                    "strength",
                    FilmFlow {
                        strength: bad,
                        ..default()
                    },
                ),
                (
                    "velocity_m_s",
                    FilmFlow {
                        velocity_m_s: Vec2::new(0.0, bad),
                        ..default()
                    },
                ),
                (
                    "map_speed_m_s",
                    FilmFlow {
                        map_speed_m_s: bad,
                        ..default()
                    },
                ),
            ];
            for (name, flow) in all {
                let message = flow.validated().expect_err("invalid").to_string();
                assert!(message.starts_with(name), "{message}");
            }
        }
    }
}
