//! When water is calm, without asking the GPU.

/// Upper bounds on what moves in a tile, as sums of squares over its cells: √Σu² and the root of twice the energy,
/// √(Σ(u−u⁻)² + C²Σuλu). Units: m.
///
/// No height exceeds the first. Without decay the energy of the scheme never grows, whatever depths, shores, damping
/// and rim; its motion per step is within `motion`/√(1 − 2C²), and a step adds no more than that to √Σu². Decay shrinks
/// both. Each source adds its own norms. So the bound holds for a tile that rests. A move or a change of depths cuts
/// the water anew; that is not counted, and the bound is far enough above the water (a ring spreads, its norm does not)
/// that a test over random moves finds it held.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CalmBound {
    displacement: f64,
    motion: f64,
}

impl CalmBound {
    /// Adds a source.
    pub(super) fn add(&mut self, displacement: f64, motion: f64) {
        self.displacement += displacement;
        self.motion += motion;
    }

    /// One step with Courant number `courant` that leaves the share `keep` of all heights.
    pub(super) fn step(&mut self, courant: f64, keep: f64) {
        self.displacement = keep * (self.displacement + self.growth(courant));
        self.motion *= keep;
    }

    /// What a step may add to the displacement.
    fn growth(&self, courant: f64) -> f64 {
        self.motion / (1.0 - 2.0 * courant * courant).sqrt()
    }

    /// The bounds of displacement and motion. Units: m.
    pub(super) fn parts(&self) -> [f64; 2] {
        [self.displacement, self.motion]
    }

    /// Of what [`CalmBound::parts`] gave.
    pub(super) fn of_parts([displacement, motion]: [f64; 2]) -> Self {
        Self { displacement, motion }
    }

    /// No height is above this now. Units: m.
    #[must_use]
    pub fn height_m(&self) -> f64 {
        self.displacement
    }

    /// No height is above this now and at any later step. Units: m. Infinite when something moves and nothing decays.
    pub(super) fn ever_m(&self, courant: f64, keep: f64) -> f64 {
        if self.motion == 0.0 {
            return self.displacement;
        }
        // n keepⁿ ≤ 1/(e |ln keep|), and −ln keep ≥ 1 − keep.
        self.displacement + self.growth(courant) / (core::f64::consts::E * (1.0 - keep))
    }
}
