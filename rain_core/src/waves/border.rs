//! What happens to a wave at the edge of the field.

/// The same on all four sides.
#[derive(Default, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Border {
    /// Mirror: waves come back with their sign, no water passes.
    #[default]
    Wall,
    /// The outermost cells stay at 0: waves come back upside down.
    Fixed,
    /// What leaves on one side enters on the other: a tile.
    Periodic,
    /// Waves leave: first-order Mur 1981 on the outermost cells, and a sponge of that many cells in front of it (0:
    /// none), whose damping rises quadratically.
    ///
    /// Mur alone sends back 0.2 % at normal incidence, (1 − cos θ)/(1 + cos θ) at the angle θ. A sponge of 12 cells
    /// takes what a drop of two cells' width leaves of that in a channel to 0.4, one of 20 cells to 0.2. It has to be
    /// as wide as the waves are long: of waves longer than that a sponge sends back more than Mur alone.
    Open {
        /// Width of the sponge on each side. Units: cells. Domain: [0, 64], below half the field.
        sponge_cells: u32,
    },
}

impl Border {
    /// Whether the sum over the field changes only by sources.
    pub(super) fn keeps_volume(self) -> bool {
        matches!(self, Self::Wall | Self::Periodic)
    }

    /// Width of the sponge, in cells.
    pub(super) fn sponge_cells(self) -> usize {
        match self {
            Self::Open { sponge_cells } => sponge_cells as usize,
            _ => 0,
        }
    }
}

/// Strongest damping of the sponge times its width over the speed: both ways through it leave e^(−k w/(3c)) of a wave.
/// Stronger reflects at the rise, weaker lets through; 3 to 6 is best for waves of the sponge's width (by trial).
const SPONGE_STRENGTH: f64 = 5.0;

/// Share of u − u⁻ kept in a step, (1 − a)/(1 + a) with a = k_d dt/2, by the sponge at each of `cells` places along one
/// axis, times `base`.
pub(super) fn sponge_profile(cells: usize, width: usize, courant: f64, base: f64) -> Vec<f32> {
    (0..cells)
        .map(|i| {
            let from_edge = i.min(cells - 1 - i) as f64 + 0.5;
            let depth = (1.0 - from_edge / width.max(1) as f64).max(0.0);
            // k dt/2 with k = strength·c/(width·dx)·depth².
            let a = 0.5 * SPONGE_STRENGTH / width.max(1) as f64 * courant * depth * depth;
            let inside = if width == 0 { 1.0 } else { (1.0 - a) / (1.0 + a) };
            (base * inside) as f32
        })
        .collect()
}
