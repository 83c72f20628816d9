//! What of a lattice depends on its settings alone: classes, their share of the drop field's motion, slices of diameter.

use glam::DVec3;

use super::settings::LatticeSettings;
use crate::error::{ConfigError, clamped};
use crate::rainfall::{
    CLASS_COUNT, CLASS_EDGES_MM, CLASS_SPEEDS_M_S, DrawRange, FieldMotion, Spectrum, StreakLayer, StreakTextureSettings,
};

/// Slices that every class of the drop field is cut into: ranges of single drops differ inside it.
const CUTS: usize = 4;

/// A range of diameters with one range of single drops, and the class of textures that shows it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Cut {
    from_mm: f64,
    to_mm: f64,
    class: Option<usize>,
}

/// What a slice of diameters is in a rain and a view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Slice {
    pub extinction_per_m: f64,
    pub range_m: f64,
    pub class: Option<usize>,
}

/// How a class of textures moves: between two neighbouring classes of the drop field.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Mix {
    lower: usize,
    upper_share: f64,
}

/// A lattice for a set of streak textures.
#[derive(Debug, Clone, PartialEq)]
pub struct LatticePlan {
    settings: LatticeSettings,
    textures: StreakTextureSettings,
    layers: Vec<StreakLayer>,
    cuts: Vec<Cut>,
    mixes: Vec<Mix>,
}

impl LatticePlan {
    /// Checks both settings and sorts diameters into slices.
    ///
    /// # Errors
    /// As [`LatticeSettings::checked`] and [`StreakTextureSettings::layers`].
    pub fn new(settings: LatticeSettings, textures: &StreakTextureSettings) -> Result<Self, ConfigError> {
        let settings = settings.checked()?;
        let layers = textures.layers()?;
        let edges = &textures.diameter_edges_mm;
        let mut borders: Vec<f64> = CLASS_EDGES_MM
            .windows(2)
            .flat_map(|pair| (0..CUTS).map(|i| pair[0] + (pair[1] - pair[0]) * i as f64 / CUTS as f64))
            .chain([CLASS_EDGES_MM[CLASS_COUNT]])
            .collect();
        let (first, last) = (borders[0], borders[borders.len() - 1]);
        // What lies outside the drop field's classes is haze, whatever the textures hold.
        borders.extend(edges.iter().filter(|&&edge| edge > first && edge < last));
        borders.sort_by(f64::total_cmp);
        borders.dedup();
        let cuts = borders
            .windows(2)
            .map(|pair| {
                let middle = 0.5 * (pair[0] + pair[1]);
                let class = edges.windows(2).position(|edge| middle >= edge[0] && middle < edge[1]);
                Cut {
                    from_mm: pair[0],
                    to_mm: pair[1],
                    class,
                }
            })
            .collect();
        let mixes = layers[..textures.class_count()]
            .iter()
            .map(|layer| mix(layer.speed_m_s))
            .collect();
        Ok(Self {
            settings,
            textures: textures.clone(),
            layers,
            cuts,
            mixes,
        })
    }

    /// The lattice's settings.
    #[must_use]
    pub fn settings(&self) -> &LatticeSettings {
        &self.settings
    }

    /// What the textures are made from.
    #[must_use]
    pub fn textures(&self) -> &StreakTextureSettings {
        &self.textures
    }

    /// The layers of the textures, in the array's order.
    #[must_use]
    pub fn layers(&self) -> &[StreakLayer] {
        &self.layers
    }

    /// Where the frame of a texture class stands, ∫ of its velocity. Units: m. Any mean of two classes' ways has the
    /// wind whole and a fall between theirs, so it rewinds as they do.
    ///
    /// `class`: held at the last one.
    #[must_use]
    pub fn offset_m(&self, class: usize, motion: &FieldMotion) -> DVec3 {
        self.between(class, &motion.offset_m)
    }

    /// Velocity of a texture class. Units: m/s. `class`: held at the last one.
    #[must_use]
    pub fn velocity_m_s(&self, class: usize, motion: &FieldMotion) -> DVec3 {
        self.between(class, &motion.velocity_m_s)
    }

    /// The cards of a level: the class that each shows, and the classes that it stands for.
    pub(super) fn sharing_a_card(&self, level: usize) -> Vec<(usize, core::ops::Range<usize>)> {
        let count = self.textures.class_count();
        if level == 0 || !self.settings.pairs {
            return (0..count).map(|class| (class, class..class + 1)).collect();
        }
        let middle = self.textures.intensities_mm_h.len() / 2 * count;
        let sigma = |class: usize| self.layers[middle + class].extinction_per_m;
        (0..count)
            .step_by(2)
            .map(|first| {
                let pair = first..(first + 2).min(count);
                let shown = if pair.len() == 2 && sigma(first + 1) > sigma(first) {
                    first + 1
                } else {
                    first
                };
                (shown, pair)
            })
            .collect()
    }

    fn between(&self, class: usize, of: &[DVec3; CLASS_COUNT]) -> DVec3 {
        let mix = self.mixes[class.min(self.mixes.len() - 1)];
        of[mix.lower] * (1.0 - mix.upper_share) + of[mix.lower + 1] * mix.upper_share
    }

    /// The slices of a rain whose drops are drawn singly as `range` says.
    pub(super) fn slices(&self, spectrum: &Spectrum, range: &DrawRange) -> Vec<Slice> {
        self.cuts
            .iter()
            .map(|cut| Slice {
                extinction_per_m: spectrum.extinction_per_m(cut.from_mm, cut.to_mm),
                range_m: range.at(0.5 * (cut.from_mm + cut.to_mm)),
                class: cut.class,
            })
            .collect()
    }

    /// Textures of a class at a rain rate: the two layers between which it lies, and the share of the upper one, so that
    /// their mean opacity is that of the rain where it lies between two rates.
    pub(super) fn layers_at(&self, class: usize, extinction_per_m: f64) -> ([usize; 2], f64) {
        let classes = self.textures.class_count();
        let rates = self.textures.intensities_mm_h.len();
        let sigma = |rate: usize| self.layers[rate * classes + class].extinction_per_m;
        let upper = (1..rates)
            .find(|&rate| extinction_per_m <= sigma(rate))
            .unwrap_or(rates - 1);
        let lower = upper.saturating_sub(1);
        let opacity = |rate: usize| self.layers[rate * classes + class].mean_opacity();
        let wanted = crate::haze::obscured(extinction_per_m * self.textures.tile_m);
        let span = opacity(upper) - opacity(lower);
        let share = if span > 0.0 {
            clamped((wanted - opacity(lower)) / span, 0.0, 1.0)
        } else {
            0.0
        };
        ([lower * classes + class, upper * classes + class], share)
    }
}

/// The mean of two neighbouring classes of the drop field that falls at a speed; the first or last class beyond them.
fn mix(speed_m_s: f64) -> Mix {
    let upper = (1..CLASS_COUNT - 1)
        .find(|&k| speed_m_s < CLASS_SPEEDS_M_S[k])
        .unwrap_or(CLASS_COUNT - 1);
    let (a, b) = (CLASS_SPEEDS_M_S[upper - 1], CLASS_SPEEDS_M_S[upper]);
    Mix {
        lower: upper - 1,
        upper_share: clamped((speed_m_s - a) / (b - a), 0.0, 1.0),
    }
}
