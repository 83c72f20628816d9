//! A source that moves: the wheel, foot or paw that goes from A to B within a frame.

use super::border::Border;
use super::erf::erf_f32;
use super::field::WaveField;
use super::patch::REACH;
use crate::constants::WATER_DENSITY;
use crate::error::{ConfigError, in_range};
use crate::ops;

/// Where a point lies along and across a segment, and the segment's length, all over the width.
fn frame(point: [f64; 2], from: [f64; 2], to: [f64; 2], width: f64) -> (f64, f64, f64) {
    let [px, pz] = [0, 1].map(|axis| (point[axis] - from[axis]) / width);
    let [ax, az] = [0, 1].map(|axis| (to[axis] - from[axis]) / width);
    let length = ops::sqrt(ax * ax + az * az);
    if length > 0.0 {
        ((px * ax + pz * az) / length, (px * az - pz * ax) / length, length)
    } else {
        (px, pz, 0.0)
    }
}

/// Sum of an impulse's force over that of its weight, below which the force is as good as whole.
const SMALL_BALANCE: f64 = 1e-3;

/// Longest way over a tile, in its shorter sides.
const LONGEST_ON_TILE: f64 = 64.0;

/// Segments shorter than this, over the width, are done by the series in double precision.
const SHORT: f64 = 0.05;

/// Mean over the segment from A to B of e^(−r²/2s²): √(π/2)(s/ℓ) e^(−d²/2s²) [erf(ξ/(s√2)) − erf((ξ−ℓ)/(s√2))], with ξ
/// along and d across. Units: none; all lengths in m.
///
/// Additive: ℓ·w of a way is the sum of its parts'. ℓ = 0 is the Gaussian; up to 0.05 s the mean is taken by the series
/// in ℓ, since the difference of two nearly equal erf cancels. A width that is not positive or a coordinate that is not
/// finite gives 0.
///
/// Error: absolute 1e-13.
#[must_use]
pub fn swept_weight(point_m: [f64; 2], from_m: [f64; 2], to_m: [f64; 2], width_m: f64) -> f64 {
    let (along, across, length) = frame(point_m, from_m, to_m, width_m);
    if !(width_m > 0.0 && along.is_finite() && across.is_finite() && length.is_finite()) {
        return 0.0;
    }
    let side = ops::exp(-0.5 * across * across);
    if length < SHORT {
        let m = along - 0.5 * length;
        let (m2, q) = (m * m, length * length);
        // Hermite polynomials of the mean's Taylor series.
        let h2 = m2 - 1.0;
        let h4 = (m2 - 6.0) * m2 + 3.0;
        let h6 = ((m2 - 15.0) * m2 + 45.0) * m2 - 15.0;
        // Far away the polynomials overflow before the exponential is 0: there is nothing there.
        if m2 > 1500.0 {
            return 0.0;
        }
        return side * ops::exp(-0.5 * m2) * (1.0 + q * (h2 / 24.0 + q * (h4 / 1920.0 + q * h6 / 322_560.0)));
    }
    let root = core::f64::consts::FRAC_1_SQRT_2;
    let difference = ops::erf(along * root) - ops::erf((along - length) * root);
    (core::f64::consts::PI / 2.0).sqrt() / length * side * difference
}

/// A segment in single precision, ready for many points.
#[derive(Debug, Clone, Copy)]
struct Segment {
    from: [f32; 2],
    /// Unit vector along it; any for a point.
    along: [f32; 2],
    /// Length over the width.
    length: f32,
    per_width: f32,
}

impl Segment {
    fn new(from: [f32; 2], to: [f32; 2], width: f32) -> Self {
        let per_width = 1.0 / width;
        let [x, z] = [to[0] - from[0], to[1] - from[1]];
        let length = (x * x + z * z).sqrt();
        let along = if length > 0.0 {
            [x / length, z / length]
        } else {
            [1.0, 0.0]
        };
        Self {
            from,
            along,
            length: length * per_width,
            per_width,
        }
    }

    /// Place along and across, over the width.
    fn place(&self, point: [f32; 2]) -> (f32, f32) {
        let x = (point[0] - self.from[0]) * self.per_width;
        let z = (point[1] - self.from[1]) * self.per_width;
        let [ax, az] = self.along;
        (x * ax + z * az, x * az - z * ax)
    }

    /// Across² and the place from the middle, where anything is left of the source: e^(−50) is nothing in single
    /// precision, and no polynomial below overflows inside.
    #[inline]
    fn near(&self, point: [f32; 2]) -> Option<(f32, f32)> {
        let (along, across) = self.place(point);
        let (a2, m) = (across * across, along - 0.5 * self.length);
        (a2 < 100.0 && m.abs() - 0.5 * self.length < 10.0).then_some((a2, m))
    }

    /// Sum of the mean's Taylor series over the way, f the shape and its even derivatives.
    #[inline]
    fn series(&self, f: [f32; 5]) -> f32 {
        let q = self.length * self.length;
        f[0] + q * (f[1] / 24.0 + q * (f[2] / 1920.0 + q * (f[3] / 322_560.0 + q * (f[4] / 92_897_280.0))))
    }

    /// The mean of e^(−ξ²/2) over the way, without the factor across.
    #[inline]
    fn mean(&self, m: f32) -> f32 {
        let half = 0.5 * self.length;
        let root = core::f32::consts::FRAC_1_SQRT_2;
        1.253_314_1 / self.length * (erf_f32((m + half) * root) - erf_f32((m - half) * root))
    }

    /// See [`swept_weight_f32`].
    #[inline]
    fn weight(&self, point: [f32; 2]) -> f32 {
        let Some((a2, m)) = self.near(point) else { return 0.0 };
        if self.length < 1.0 {
            let [f0, f1, f2, f3, f4, _] = hermite(m);
            // Both factors in one exponential.
            ops::expf(-0.5 * (a2 + m * m)) * self.series([f0, f1, f2, f3, f4])
        } else {
            ops::expf(-0.5 * a2) * self.mean(m)
        }
    }

    /// See [`swept_laplacian_f32`].
    #[inline]
    fn weight_and_laplacian(&self, point: [f32; 2]) -> (f32, f32) {
        let Some((a2, m)) = self.near(point) else {
            return (0.0, 0.0);
        };
        let (side, mean, curve) = if self.length < 1.0 {
            let [f0, f1, f2, f3, f4, f5] = hermite(m);
            let gauss = ops::expf(-0.5 * (a2 + m * m));
            (
                gauss,
                self.series([f0, f1, f2, f3, f4]),
                self.series([f1, f2, f3, f4, f5]),
            )
        } else {
            let (a, b) = (m + 0.5 * self.length, m - 0.5 * self.length);
            let ends = b * ops::expf(-0.5 * b * b) - a * ops::expf(-0.5 * a * a);
            (ops::expf(-0.5 * a2), self.mean(m), ends / self.length)
        };
        (side * mean, side * (mean * (a2 - 1.0) + curve))
    }
}

/// He₀, He₂, He₄, … He₁₀: the Gaussian's even derivatives over it.
#[inline]
fn hermite(m: f32) -> [f32; 6] {
    let x = m * m;
    [
        1.0,
        x - 1.0,
        (x - 6.0) * x + 3.0,
        ((x - 15.0) * x + 45.0) * x - 15.0,
        (((x - 28.0) * x + 210.0) * x - 420.0) * x + 105.0,
        ((((x - 45.0) * x + 630.0) * x - 3150.0) * x + 4725.0) * x - 945.0,
    ]
}

/// [`swept_weight`] in single precision. Error: absolute 2e-6; up to ℓ = s by the series, beyond by [`erf_f32`].
#[must_use]
pub fn swept_weight_f32(point_m: [f32; 2], from_m: [f32; 2], to_m: [f32; 2], width_m: f32) -> f32 {
    segment(from_m, to_m, width_m).map_or(0.0, |segment| segment.weight(point_m))
}

/// s²∇² of [`swept_weight`] with respect to the point. Units: none; all lengths in m.
///
/// Error: absolute 5e-6, against values within [−2, 1].
#[must_use]
pub fn swept_laplacian_f32(point_m: [f32; 2], from_m: [f32; 2], to_m: [f32; 2], width_m: f32) -> f32 {
    segment(from_m, to_m, width_m).map_or(0.0, |segment| segment.weight_and_laplacian(point_m).1)
}

/// The segment, unless a number in it is not finite or the width is not positive.
fn segment(from: [f32; 2], to: [f32; 2], width: f32) -> Option<Segment> {
    let segment = Segment::new(from, to, width);
    let finite = from.iter().all(|x| x.is_finite()) && segment.length.is_finite() && segment.per_width.is_finite();
    (finite && width > 0.0).then_some(segment)
}

/// What a moving source does to the water, in sum over its way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Push {
    /// Raises the surface by this much where it stands still; on a way of length ℓ by amplitude per metre · ℓ · w.
    /// Units: m. Changes the volume.
    Height(f32),
    /// Presses with a force over a time, as weight or tyre pressure does: Δu_t = (h/ρ)∇²J with J = impulse · w/(2πs²).
    /// A load F at speed v leaves F/v on each metre. Units: N s. Moves water, but makes none.
    Impulse(f32),
}

/// A disturbance that moves in a straight line within a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SweptSource {
    /// Where it was, (x, z). Units: m from the field's corner. Domain: [−1e5, 1e5].
    pub from_m: [f32; 2],
    /// Where it is. Units: m. On a tile at most 64 of its shorter sides from where it was.
    pub to_m: [f32; 2],
    /// Standard deviation of its footprint; a tyre of width b has b/√12. Units: m. Domain: [1e-4, 100]; widened to two
    /// cells.
    pub width_m: f32,
    /// How it acts.
    pub push: Push,
}

impl SweptSource {
    fn check(&self) -> Result<(), ConfigError> {
        for (name, point) in [("from_m", self.from_m), ("to_m", self.to_m)] {
            for at in point {
                in_range(name, f64::from(at), -1e5, 1e5, "-1e5 to 1e5 m")?;
            }
        }
        in_range("width_m", f64::from(self.width_m), 1e-4, 100.0, "1e-4 to 100 m")?;
        let (name, value) = match self.push {
            Push::Height(height) => ("height_m", height),
            Push::Impulse(impulse) => ("impulse_n_s", impulse),
        };
        in_range(name, f64::from(value), -1e6, 1e6, "-1e6 to 1e6").map(|_| ())
    }
}

impl WaveField {
    /// Adds the source of one frame. Two halves of the way with half the push each do the same as the whole.
    ///
    /// Dry cells, fixed borders and what lies outside are left out; an impulse still moves no water in sum. Costs some
    /// ten ns for each cell within 5 s of the way, twice that by shores and borders. On a tile ([`Border::Periodic`]) a
    /// way goes around as often as it has to; of a footprint whose 10 s are more than 7/8 of a side the farthest tail is
    /// left out.
    ///
    /// # Errors
    /// [`ConfigError::OutOfRange`] for a field of `source` outside its domain or not finite; then nothing has changed.
    pub fn add_swept(&mut self, source: &SweptSource) -> Result<(), ConfigError> {
        source.check()?;
        let width = f64::from(source.width_m).max(2.0 * self.settings.cell_m);
        let parts = self.parts(source, width)?;
        if parts == 1 {
            self.add_part(source, width);
            return Ok(());
        }
        let [from, to] = [source.from_m, source.to_m].map(|point| point.map(f64::from));
        let share = 1.0 / parts as f32;
        let place = |part: u32| {
            let t = f64::from(part) / f64::from(parts);
            [0, 1].map(|axis| (from[axis] + t * (to[axis] - from[axis])) as f32)
        };
        for part in 0..parts {
            self.add_part(
                &SweptSource {
                    from_m: place(part),
                    to_m: place(part + 1),
                    push: match source.push {
                        Push::Height(height) => Push::Height(height * share),
                        Push::Impulse(impulse) => Push::Impulse(impulse * share),
                    },
                    ..*source
                },
                width,
            );
        }
        Ok(())
    }

    /// Into how many parts a way must be cut so that none reaches around a tile into itself.
    fn parts(&self, source: &SweptSource, width: f64) -> Result<u32, ConfigError> {
        if self.settings.border != Border::Periodic {
            return Ok(1);
        }
        let cells = [self.rules.nx, self.rules.nz];
        let sides = cells.map(|cells| cells as f64 * self.settings.cell_m);
        let ways = [0, 1].map(|axis| (f64::from(source.to_m[axis]) - f64::from(source.from_m[axis])).abs());
        let tiles = ways[0].max(ways[1]) / sides[0].min(sides[1]);
        let allowed = "a way of at most 64 tiles";
        in_range("to_m, tiles from from_m", tiles, 0.0, LONGEST_ON_TILE, allowed)?;
        let parts = [0, 1].map(|axis| {
            let room = (sides[axis] - 2.0 * REACH * width).max(0.125 * sides[axis]);
            (ways[axis] / room).ceil()
        });
        Ok(parts[0].max(parts[1]).max(1.0) as u32)
    }

    /// A source whose parts do not overlap around a tile. Its width is two cells or more.
    fn add_part(&mut self, source: &SweptSource, width: f64) {
        let cell = self.settings.cell_m;
        let segment = Segment::new(source.from_m, source.to_m, width as f32);
        let [from, to] = [source.from_m, source.to_m].map(|point| point.map(f64::from));
        let low = [from[0].min(to[0]), from[1].min(to[1])];
        let high = [from[0].max(to[0]), from[1].max(to[1])];
        let spans = self.reach(low, high, width);
        let centre = |start: i64, k: usize| (((start + k as i64) as f64 + 0.5) * cell) as f32;
        let cells = || (0..spans[1].len).flat_map(|l| (0..spans[0].len).map(move |k| (k, l)));
        let shape =
            |k: usize, l: usize| segment.weight_and_laplacian([centre(spans[0].start, k), centre(spans[1].start, l)]);
        // ½C²L of a height, and the change of u⁻ by an impulse, both over s²∇²w.
        let scale = self.courant() * cell / width;
        let (height, back) = match source.push {
            Push::Height(height) => (f64::from(height), 0.5 * scale * scale * f64::from(height)),
            Push::Impulse(impulse) => {
                let s2 = width * width;
                let force = self.deepest_m() * f64::from(impulse) / (WATER_DENSITY * core::f64::consts::TAU * s2 * s2);
                (0.0, -(1.0 + self.half_damping()) * self.step_s() * force)
            }
        };
        let (mut weight_sum, mut force_sum, mut count) = (0.0, 0.0, 0.0);
        for (k, l) in cells() {
            if let Some(index) = self.reached(spans, k, l) {
                let (weight, laplacian) = shape(k, l);
                let force = self.relative_depth(index) * laplacian;
                weight_sum += f64::from(weight);
                force_sum += f64::from(force);
                count += 1.0;
                let raised = height as f32 * weight;
                self.now[index] += raised;
                self.before[index] += raised + back as f32 * force;
            }
        }
        if weight_sum <= 0.0 {
            return;
        }
        // What the force moves in sum is taken back: where no border or shore cuts it that is the little beyond its
        // reach, the same for all cells; else it is much, and follows the weight so that no step is left around the
        // source.
        let balance = force_sum / weight_sum;
        let (even, shaped) = if balance.abs() < SMALL_BALANCE {
            ((back * force_sum / count) as f32, None)
        } else {
            (0.0, Some((back * balance) as f32))
        };
        for (k, l) in cells() {
            if let Some(index) = self.reached(spans, k, l) {
                self.before[index] -= match shaped {
                    None => even,
                    Some(share) => share * segment.weight([centre(spans[0].start, k), centre(spans[1].start, l)]),
                };
            }
        }
        self.sum_now += height * weight_sum;
        self.sum_before += height * weight_sum;
        self.still = false;
    }
}
