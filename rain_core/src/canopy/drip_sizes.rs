//! Sizes of drips by leaf: shares of volume, shares of number, and drops drawn from either.

use serde::{Deserialize, Serialize};

use crate::error::clamped;
use crate::hash;
use crate::ops;

/// Smallest drip of the measured table. Units: mm.
pub const DRIP_MIN_MM: f64 = 1.0;
/// Largest drip of the measured table. Units: mm.
pub const DRIP_MAX_MM: f64 = 8.0;
/// Width of the measured classes. Units: mm.
pub const DRIP_BIN_MM: f64 = 0.5;
/// Number of measured classes, [1.0, 1.5) to [7.5, 8.0) mm.
pub const DRIP_BINS: usize = 14;

/// Leaves, as far as drops go.
#[derive(Default, Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LeafType {
    /// Needles, coated: about 4.45 mm, wide spread.
    NeedleCoated,
    /// Broad leaves without a coat of wax: about 5.4 mm.
    BroadleafMatte,
    /// Broad leaves with a coat of wax: about 4.4 mm, narrow.
    #[default]
    BroadleafCoated,
}

impl LeafType {
    /// All three, in the order of the tables.
    pub const ALL: [Self; 3] = [Self::NeedleCoated, Self::BroadleafMatte, Self::BroadleafCoated];

    /// a, b (mm), c (mm) of the Gaussian fit. Source: Weber et al. 2016, table 3.
    fn gaussian(self) -> [f64; 3] {
        match self {
            Self::NeedleCoated => [0.17, 4.45, 1.19],
            Self::BroadleafMatte => [0.24, 5.40, 0.84],
            Self::BroadleafCoated => [0.37, 4.37, 0.50],
        }
    }
}

/// Share of the drip's volume in each class of 0.5 mm, by leaf in the order of [`LeafType::ALL`]. Each row sums to 1.
///
/// Source: Nanko et al. 2013, in Weber et al. 2016, table 4. Shares of a hundredth, so ±0.005 each.
pub const DRIP_VOLUME_SHARES: [[f64; DRIP_BINS]; 3] = [
    [
        0.0, 0.01, 0.02, 0.05, 0.08, 0.19, 0.15, 0.17, 0.13, 0.10, 0.06, 0.03, 0.01, 0.0,
    ],
    [
        0.0, 0.01, 0.01, 0.02, 0.04, 0.06, 0.08, 0.18, 0.22, 0.23, 0.12, 0.03, 0.0, 0.0,
    ],
    [
        0.0, 0.01, 0.02, 0.04, 0.07, 0.17, 0.37, 0.28, 0.04, 0.0, 0.0, 0.0, 0.0, 0.0,
    ],
];

/// Share of the volume in a class of 0.5 mm about `diameter_mm` by the source's fit, a e^(−(D − b)²/(2c²)).
///
/// Not normalised: over all sizes the classes hold 1.014, 1.011 and 0.927. Units: none. `diameter_mm` in mm; outside
/// [1, 8) mm, and for what is not a number, 0. Source: Weber et al. 2016, eq. 4.
/// Error: 4e-15 relative; off the measured classes by up to 0.047.
#[must_use]
pub fn gaussian_drip_share(leaf: LeafType, diameter_mm: f64) -> f64 {
    if !(DRIP_MIN_MM..DRIP_MAX_MM).contains(&diameter_mm) {
        return 0.0;
    }
    let [a, b, c] = leaf.gaussian();
    let x = (diameter_mm - b) / c;
    a * ops::exp(-0.5 * x * x)
}

/// A distribution of drip diameters with a constant volume density in each of its equal classes over [1, 8] mm.
///
/// Allocates three tables of one number a class at construction, nothing afterwards.
///
/// Error: diameters drawn ≤ 1e-9 mm from the inverse of the exact sums of the table, in f32 ≤ 4e-7 mm for the same u,
/// its shares and moments ≤ 1e-9; of the fit with 140 classes ≤ 0.003 mm from the fit's own inverse (number, all but
/// the outer 1e-4), its moments ≤ 1e-3.
#[derive(Debug, Clone, PartialEq)]
pub struct DripSizes {
    /// Share of the volume in each class.
    volume: Vec<f64>,
    /// Share of the volume below the end of each class.
    volume_below: Vec<f64>,
    /// Share of the number below the end of each class.
    number_below: Vec<f64>,
    /// ∫ (volume density)/D³ dD, mm⁻³.
    per_volume: f64,
}

impl DripSizes {
    /// The measured classes of a leaf (the default).
    #[must_use]
    pub fn measured(leaf: LeafType) -> Self {
        let row = LeafType::ALL.iter().position(|&each| each == leaf).unwrap_or_default();
        Self::from_volumes(DRIP_VOLUME_SHARES[row].to_vec())
    }

    /// The source's Gaussian fit of a leaf, normalised, in `classes` classes (held in [1, 10000]).
    #[must_use]
    pub fn gaussian(leaf: LeafType, classes: usize) -> Self {
        let classes = classes.clamp(1, 10_000);
        let width = (DRIP_MAX_MM - DRIP_MIN_MM) / classes as f64;
        // Simpson's rule with enough panels that a class is narrow against the fit.
        let panels = (140 / classes).max(1);
        let step = width / panels as f64;
        let volumes = (0..classes).map(|class| {
            let start = DRIP_MIN_MM + width * class as f64;
            (0..panels)
                .map(|panel| start + step * panel as f64)
                .map(|from| {
                    let [a, b, c] = leaf.gaussian();
                    let at = |d: f64| a * ops::exp(-0.5 * ((d - b) / c) * ((d - b) / c));
                    step / 6.0 * (at(from) + 4.0 * at(from + 0.5 * step) + at(from + step))
                })
                .sum()
        });
        Self::from_volumes(volumes.collect())
    }

    /// From positive volumes of equal classes.
    fn from_volumes(mut volume: Vec<f64>) -> Self {
        let total: f64 = volume.iter().sum();
        for share in &mut volume {
            *share /= total;
        }
        let width = (DRIP_MAX_MM - DRIP_MIN_MM) / volume.len() as f64;
        // ∫ D⁻³ dD over a class, over its width.
        let numbers: Vec<f64> = volume
            .iter()
            .enumerate()
            .map(|(class, share)| {
                let [from, to] = edges(class, width);
                share / width * 0.5 * (from + to) * (to - from) / (from * from * to * to)
            })
            .collect();
        let per_volume: f64 = numbers.iter().sum();
        Self {
            volume_below: sums(&volume, 1.0),
            number_below: sums(&numbers, per_volume),
            volume,
            per_volume,
        }
    }

    /// Number of classes.
    #[must_use]
    pub fn classes(&self) -> usize {
        self.volume.len()
    }

    /// Width of a class. Units: mm.
    fn width(&self) -> f64 {
        (DRIP_MAX_MM - DRIP_MIN_MM) / self.volume.len() as f64
    }

    /// Share of the volume in class `class`; 0 beyond the last. Units: none.
    #[must_use]
    pub fn volume_share(&self, class: usize) -> f64 {
        self.volume.get(class).copied().unwrap_or_default()
    }

    /// Share of the number of drops in class `class`, ∝ volume/D³; 0 beyond the last. Units: none.
    #[must_use]
    pub fn number_share(&self, class: usize) -> f64 {
        let before = if class == 0 {
            0.0
        } else {
            self.number_below.get(class - 1).copied().unwrap_or(1.0)
        };
        self.number_below.get(class).copied().unwrap_or(1.0) - before
    }

    /// Mean diameter by volume. Units: mm.
    #[must_use]
    pub fn volume_mean_mm(&self) -> f64 {
        let middle = |class: usize| DRIP_MIN_MM + self.width() * (class as f64 + 0.5);
        self.volume
            .iter()
            .enumerate()
            .map(|(class, share)| share * middle(class))
            .sum()
    }

    /// Mean diameter by number. Units: mm.
    #[must_use]
    pub fn number_mean_mm(&self) -> f64 {
        // ∫ D⁻² dD over a class, over its width, is 1/(from·to).
        let sum: f64 = (self.volume.iter().enumerate())
            .map(|(class, share)| {
                let [from, to] = edges(class, self.width());
                share / (from * to)
            })
            .sum();
        sum / self.per_volume
    }

    /// Drops that one litre of drip makes. Units: 1/l.
    #[must_use]
    pub fn drops_per_litre(&self) -> f64 {
        self.per_volume * 6e6 / core::f64::consts::PI
    }

    /// Mean volume of a drop. Units: m³.
    #[must_use]
    pub fn mean_drop_m3(&self) -> f64 {
        1e-3 / self.drops_per_litre()
    }

    /// The diameter below which the share `u` of the volume lies: picks where a unit of water goes. Units: mm.
    ///
    /// `u` in [0, 1]; outside it is held there, and what is not a number counts as 0.
    #[must_use]
    pub fn diameter_by_volume(&self, u: f64) -> f64 {
        let (class, share) = place(&self.volume_below, u);
        let [from, to] = edges(class, self.width());
        (from + share * (to - from)).min(to)
    }

    /// The diameter below which the share `u` of the drops lies: draws a drop. Units: mm.
    ///
    /// `u` as in [`Self::diameter_by_volume`]. Within a class numbers fall by D⁻³.
    #[must_use]
    pub fn diameter_by_number(&self, u: f64) -> f64 {
        let (class, share) = place(&self.number_below, u);
        let [from, to] = edges(class, self.width());
        let squared = (from / to) * (from / to);
        (from / ops::sqrt(1.0 - share * (1.0 - squared))).clamp(from, to)
    }

    /// [`Self::diameter_by_number`] in single precision, for drops drawn in numbers.
    #[must_use]
    pub fn diameter_by_number_f32(&self, u: f32) -> f32 {
        self.diameter_by_number(f64::from(u)) as f32
    }

    /// The diameter of drip number `release` from place `place`: the same for the same integers, on every platform.
    /// Drawn by number. Units: mm.
    #[must_use]
    pub fn drawn_mm(&self, seed: u32, place: u32, release: u32) -> f32 {
        let [bits, _, _] = hash::pcg3d([place, release, seed]);
        self.diameter_by_number_f32(hash::unit_f32(bits))
    }
}

/// Both edges of a class of `width` mm.
fn edges(class: usize, width: f64) -> [f64; 2] {
    [
        DRIP_MIN_MM + width * class as f64,
        DRIP_MIN_MM + width * (class + 1) as f64,
    ]
}

/// Running sums over `total`, ending at exactly 1.
fn sums(parts: &[f64], total: f64) -> Vec<f64> {
    let mut sum = 0.0;
    let mut below: Vec<f64> = (parts.iter())
        .map(|part| {
            sum += part;
            (sum / total).min(1.0)
        })
        .collect();
    // From the last class that holds anything on.
    if let Some(last) = parts.iter().rposition(|&part| part > 0.0) {
        below[last..].fill(1.0);
    }
    below
}

/// The class in which the share `u` lies, and how much of that class lies below it.
fn place(below: &[f64], u: f64) -> (usize, f64) {
    let u = clamped(u, 0.0, 1.0);
    let class = below.partition_point(|&end| end <= u).min(below.len() - 1);
    // The end of the last class that holds anything belongs to it.
    let class = if u >= 1.0 {
        below.partition_point(|&end| end < 1.0)
    } else {
        class
    };
    let from = if class == 0 { 0.0 } else { below[class - 1] };
    (class, ((u - from) / (below[class] - from)).clamp(0.0, 1.0))
}
