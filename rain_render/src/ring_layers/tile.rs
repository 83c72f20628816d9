//! The host's side: rain, clock, and whether there is anything to draw.

use rain_core::error::ConfigError;
use rain_core::ops;
use rain_core::rainfall::DropSizes;
use rain_core::waves::{RingForcing, RingLayerSettings, RingLayerState, RingLayers};

use super::params::RingLayerFrame;

/// Time in which the layers follow a change of the rain, to a third. About as long as a ring is seen. Units: s.
const FOLLOW_S: f64 = 0.3;

/// Below this intensity nothing is left.
const GONE: f64 = 1e-3;

/// Procedural rings under rain. The map is that of a moment: any step of time leads to the same.
#[derive(Debug, Clone)]
pub struct RingLayerTile {
    layers: RingLayers,
    rain: Option<DropSizes>,
    /// Where the rain leads to, and how far it has.
    target: RingForcing,
    now: RingForcing,
    time_s: f64,
    /// What the map shows.
    drawn: Option<(RingLayerState, f32)>,
}

impl RingLayerTile {
    /// Flat water without rain.
    ///
    /// # Errors
    /// [`ConfigError::OutOfRange`] for a setting outside its domain.
    pub fn new(settings: &RingLayerSettings) -> Result<Self, ConfigError> {
        Ok(Self {
            layers: RingLayers::new(settings)?,
            rain: None,
            target: RingForcing::default(),
            now: RingForcing::default(),
            time_s: 0.0,
            // A new texture is zero, which is flat.
            drawn: Some((RingLayerState::default(), 0.0)),
        })
    }

    /// The layers.
    #[must_use]
    pub fn layers(&self) -> &RingLayers {
        &self.layers
    }

    /// The map's texture, for the host to make. It is sampled with repeat.
    #[must_use]
    pub fn map_texture(&self) -> wgpu::TextureDescriptor<'static> {
        let cells = self.layers.settings().cells;
        crate::slope_mips::slope_texture("rain ring layers", cells, cells)
    }

    /// What falls from now on. Takes about a tenth of a millisecond when it has changed.
    pub fn set_rain(&mut self, rain: &DropSizes) {
        if self.rain == Some(*rain) {
            return;
        }
        self.rain = Some(*rain);
        let target = self.layers.forcing(rain);
        // Rings that end keep their steepness.
        let gain = if target.intensity > 0.0 {
            target.gain
        } else {
            self.now.gain
        };
        self.target = RingForcing { gain, ..target };
    }

    /// Goes to a moment: `now_ns` on the clock of the rings, `elapsed_ns` after the last one. Units: ns.
    pub fn advance(&mut self, now_ns: u64, elapsed_ns: u64) {
        self.time_s = now_ns as f64 * 1e-9;
        let left = ops::exp(-(elapsed_ns as f64 * 1e-9) / FOLLOW_S);
        let to = |now: f64, target: f64| target + (now - target) * left;
        if self.now.intensity == 0.0 {
            // From flat water rings of the right steepness come in.
            self.now.gain = self.target.gain;
        }
        self.now = RingForcing {
            intensity: to(self.now.intensity, self.target.intensity),
            gain: to(self.now.gain, self.target.gain),
            hidden_variance: to(self.now.hidden_variance, self.target.hidden_variance),
        };
        if self.target.intensity == 0.0 && self.now.intensity < GONE {
            self.now = RingForcing {
                gain: self.now.gain,
                ..RingForcing::default()
            };
        }
    }

    /// What the rain does to the layers now.
    #[must_use]
    pub fn forcing(&self) -> RingForcing {
        self.now
    }

    /// Whether nothing is left of the rain.
    #[must_use]
    pub fn is_calm(&self) -> bool {
        self.target.intensity == 0.0 && self.now.intensity == 0.0
    }

    fn state(&self) -> (RingLayerState, f32) {
        if self.now.intensity == 0.0 {
            // All flat maps are alike.
            return (RingLayerState::default(), 0.0);
        }
        let state = self.layers.state(self.time_s, self.now.intensity, self.now.gain);
        (state, self.now.hidden_variance as f32)
    }

    /// Whether the map would change.
    #[must_use]
    pub fn wants_pass(&self) -> bool {
        self.drawn != Some(self.state())
    }

    /// Hands the moment over.
    #[must_use]
    pub fn take(&mut self) -> RingLayerFrame {
        let (state, hidden_variance) = self.state();
        self.drawn = Some((state, hidden_variance));
        RingLayerFrame::new(&self.layers, &state, hidden_variance)
    }

    /// The map is not what was drawn last: another device, or another texture.
    pub fn lose(&mut self) {
        self.drawn = None;
    }
}
