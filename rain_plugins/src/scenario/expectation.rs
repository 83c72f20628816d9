//! Expectations as they are written in a scenario. `expect` evaluates them.

use rain_core::weather::SurfaceClass;
use serde::{Deserialize, Serialize};

use super::file::Mask;

/// A statement about the run that must hold. A value that is not a number never passes.
///
/// `Rises` and `Falls` carry their own bound; every other check needs `equals` (with `tolerance`), or `min`, `max` or
/// both.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expectation {
    /// What it means in words. Default: made from the check.
    #[serde(default)]
    pub text: String,
    /// What is looked at. Required.
    pub check: Check,
    /// At which captures, for `Mask`. Default: `All`.
    #[serde(default)]
    pub at: At,
    /// The value must be this, give or take `tolerance`. Unit: the check's. Default: none.
    #[serde(default)]
    pub equals: Option<f64>,
    /// Least allowed value. Unit: the check's. Default: none.
    #[serde(default)]
    pub min: Option<f64>,
    /// Greatest allowed value. Unit: the check's. Default: none.
    #[serde(default)]
    pub max: Option<f64>,
    /// How far past `equals`, `min` or `max` the value may be. Unit: the check's. Domain: ≥ 0. Default: 0.
    #[serde(default)]
    pub tolerance: f64,
}

/// Captures that a mask check holds at.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum At {
    /// Every capture; the reported value is the worst one's. The default.
    #[default]
    All,
    /// The last capture.
    Last,
    /// The capture of this index. Domain: 0 to the number of captures − 1.
    Capture(usize),
}

/// What an expectation looks at.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Check {
    /// A statistic of a mask. Unit: the mask's (1 for `Rain` and `Wet`, m for `Depth` and `Water`), or a fraction.
    Mask(MaskCheck),
    /// The statistic at capture `to` is more than at `from`, by this factor or more.
    Rises(Change),
    /// The statistic at capture `to` is less than at `from`, by this factor or more.
    Falls(Change),
    /// A state of the weather at a time. Unit: the quantity's.
    Weather(WeatherCheck),
    /// How many frames a pass was recorded in (or skipped in). Unit: frames.
    Pass(PassCheck),
    /// A term of the water budget. Unit: m³; `residual_relative`, whose absolute value counts, none.
    Budget(BudgetTerm),
    /// Things drawn per frame. Unit: none.
    Count(CountCheck),
}

/// A statistic of a mask over a region.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaskCheck {
    /// Which mask. Domain: one of `outputs.masks`. Required.
    pub mask: Mask,
    /// Which statistic. Required.
    pub statistic: Statistic,
    /// Screen rectangle (left, top, right, bottom) as fractions of width and height. Domain: [0, 1], left < right,
    /// top < bottom. Default: the whole picture.
    #[serde(default = "whole")]
    pub region: [f64; 4],
    /// Only pixels whose distance from the eye is in this range (least, greatest); needs the `Depth` mask. Units: m.
    /// Domain: 0 ≤ least < greatest. Default: all.
    #[serde(default)]
    pub depth_m: Option<[f64; 2]>,
}

/// The region that is the whole picture.
#[must_use]
pub fn whole() -> [f64; 4] {
    [0.0, 0.0, 1.0, 1.0]
}

/// One number from the pixels of a region. Of no pixels it is not a number.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Statistic {
    /// Arithmetic mean. Unit: the mask's.
    Mean,
    /// Share of pixels above this level (unit: the mask's). Units: none.
    FractionAbove(f64),
    /// Greatest value. Unit: the mask's.
    Max,
}

/// A statistic compared between two captures.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Change {
    /// Which mask. Domain: one of `outputs.masks`. Required.
    pub mask: Mask,
    /// Which statistic. Required.
    pub statistic: Statistic,
    /// As in [`MaskCheck::region`].
    #[serde(default = "whole")]
    pub region: [f64; 4],
    /// As in [`MaskCheck::depth_m`].
    #[serde(default)]
    pub depth_m: Option<[f64; 2]>,
    /// Index of the capture that is compared with. Required.
    pub from: usize,
    /// Index of the capture that must differ. Required.
    pub to: usize,
    /// By how much. Units: none. Domain: [1, 1 000 000]. Default: 1, any change in that direction.
    #[serde(default = "one")]
    pub factor: f64,
}

fn one() -> f64 {
    1.0
}

impl Change {
    /// The statistic that is compared.
    #[must_use]
    pub fn mask_check(&self) -> MaskCheck {
        MaskCheck {
            mask: self.mask,
            statistic: self.statistic,
            region: self.region,
            depth_m: self.depth_m,
        }
    }
}

/// A state of the weather at a time, interpolated between the recorded ones.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WeatherCheck {
    /// Which state. Required.
    pub quantity: WeatherQuantity,
    /// When. Units: s. Domain: [0, `duration_s`]. Required.
    pub time_s: f64,
    /// Surface class of the wetness or water level: `asphalt`, `concrete`, `stone`, `gravel`, `soil`, `grass`, `roof`.
    /// Default: `asphalt`.
    #[serde(default)]
    pub surface: SurfaceClass,
}

/// A state of the weather.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum WeatherQuantity {
    /// Rain rate. Unit: mm/h.
    IntensityMmH,
    /// Pore water over capacity. Unit: none, [0, 1].
    Wetness,
    /// Mean film outside basins. Unit: mm.
    WaterLevelMm,
}

/// Frames of a pass.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PassCheck {
    /// Name, one of [`super::report::PASS_NAMES`]. A pass that the report does not list was recorded in 0 frames.
    pub name: String,
    /// Recorded or skipped frames. Default: `Recorded`.
    #[serde(default)]
    pub frames: PassFrames,
}

/// Which frames of a pass are counted.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum PassFrames {
    /// Those it was recorded in. The default.
    #[default]
    Recorded,
    /// Those it was skipped in.
    Skipped,
}

/// A term of the water budget, named as in `report.json`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum BudgetTerm {
    /// Rain that fell on the domain.
    Rain,
    /// Film outside basins.
    Film,
    /// Water in pores.
    Pores,
    /// Water in basins.
    Basins,
    /// Water on leaves.
    Canopy,
    /// Drips and spray in flight.
    Airborne,
    /// Evaporated.
    Evaporated,
    /// Infiltrated.
    Infiltrated,
    /// Left through drains and over the border.
    Drained,
    /// Absolute value of what the ledger does not account for, over the rain.
    Residual,
}

/// Things drawn per frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CountCheck {
    /// What is counted. Required.
    pub of: CountOf,
    /// Median or maximum over the frames. Default: `Median`.
    #[serde(default)]
    pub over_frames: OverFrames,
}

/// What is counted, named as in `report.json`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum CountOf {
    /// Single drops drawn.
    Drops,
    /// Billboards of many drops.
    Billboards,
    /// Splashes.
    Splashes,
    /// Drips from eaves and leaves.
    Drips,
    /// Particles thrown up by wheels.
    WheelParticles,
}

/// A number from all frames.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum OverFrames {
    /// The middle one. The default.
    #[default]
    Median,
    /// The greatest.
    Maximum,
}
