//! The step of one row: u⁺ = u + (1−a)/(1+a) (u − u⁻) + C²/(1+a) L u, written over u⁻.
//!
//! This is physics' u⁺ = (2u − (1−a)u⁻ + C²Lu)/(1+a) with the differences taken first: in single precision a level
//! surface then stays level, and what is left of the rounding is that of the small terms. With g = (1−a)/(1+a) the
//! other factor is 1/(1+a) = ½(1+g), so one number a cell describes any damping.

use super::bed::Bed;
use super::border::Border;
use super::stencil::Stencil;

/// Heights below this are 0 after the last step of a pass: a quiet pond must not run into denormal numbers, and in the
/// few steps of a pass none falls from here to 1e-38. Units: m.
const TINY: f32 = 1e-20;

#[inline(always)]
fn flushed(u: f32) -> f32 {
    if u.abs() < TINY { 0.0 } else { u }
}

/// Everything that a step needs besides the heights; shared by all threads.
#[derive(Debug, Clone)]
pub(super) struct Rules {
    pub nx: usize,
    pub nz: usize,
    pub stencil: Stencil,
    pub border: Border,
    /// C² of the fastest wave.
    pub c2: f32,
    /// g of the damping without sponge.
    pub g: f32,
    /// With a sponge: its factors along x, and along z with `g` in them. Empty without.
    pub sponge_x: Vec<f32>,
    pub sponge_z: Vec<f32>,
    /// Depths, unless they are the same everywhere.
    pub bed: Option<Bed>,
}

impl Rules {
    /// Writes row `j` of the next level into `out`, which holds the level before; `input` holds the level between, from
    /// row `first` on, with the neighbours of row `j`. `LAST`: tiny heights
    /// become 0.
    pub fn row<const LAST: bool>(&self, j: usize, out: &mut [f32], input: &[f32], first: usize) {
        let nx = self.nx;
        let row = |k: usize| &input[(k - first) * nx..][..nx];
        let wraps = self.border == Border::Periodic;
        let last = self.nz - 1;
        let here = row(j);
        let north = match j {
            0 if wraps => row(last),
            0 => here,
            _ => row(j - 1),
        };
        let south = match j {
            _ if j < last => row(j + 1),
            _ if wraps => row(0),
            _ => here,
        };
        if self.border == Border::Fixed && (j == 0 || j == last) {
            out.fill(0.0);
            return;
        }
        let even = Even([self.g, (0.5 + 0.5 * self.g) * self.c2]);
        let sponge = || Sponge(&self.sponge_x, self.sponge_z[j], self.c2);
        let damped = !self.sponge_x.is_empty();
        if let Some(bed) = &self.bed {
            let above = if j > 0 { j - 1 } else { last };
            let faces = Faces {
                east: &bed.east[j * nx..][..nx],
                north: &bed.south[above * nx..][..nx],
                south: &bed.south[j * nx..][..nx],
            };
            if damped {
                faces_row::<LAST>(out, here, north, south, faces, sponge());
            } else {
                faces_row::<LAST>(out, here, north, south, faces, even);
            }
        } else {
            match (self.stencil, damped) {
                (Stencil::FivePoint, false) => five_row::<LAST>(out, here, north, south, wraps, even),
                (Stencil::FivePoint, true) => five_row::<LAST>(out, here, north, south, wraps, sponge()),
                (Stencil::NinePoint, false) => nine_row::<LAST>(out, here, north, south, wraps, even),
                (Stencil::NinePoint, true) => nine_row::<LAST>(out, here, north, south, wraps, sponge()),
            }
        }
        match self.border {
            Border::Fixed => {
                out[0] = 0.0;
                out[nx - 1] = 0.0;
            }
            Border::Open { .. } => {
                out[0] = self.open_edge(j * nx, here[0], here[1], out[1]);
                out[nx - 1] = self.open_edge(j * nx + nx - 1, here[nx - 1], here[nx - 2], out[nx - 2]);
            }
            Border::Wall | Border::Periodic => {}
        }
    }

    /// Row 0 or the last row of an open field, from the row inside at both levels.
    pub fn open_row(&self, j: usize, out: &mut [f32], edge: &[f32], inner: &[f32], inner_next: &[f32]) {
        for (i, out) in out.iter_mut().enumerate() {
            *out = self.open_edge(j * self.nx + i, edge[i], inner[i], inner_next[i]);
        }
    }

    /// Mur 1981, first order: u₀⁺ = u₁ + (C−1)/(C+1) (u₁⁺ − u₀), with C of the cell's own depth.
    fn open_edge(&self, index: usize, edge: f32, inner: f32, inner_next: f32) -> f32 {
        let relative = self.bed.as_ref().map_or(1.0, |bed| bed.depth[index]);
        if relative == 0.0 {
            return 0.0;
        }
        let c = (self.c2 * relative).sqrt();
        flushed(inner + (c - 1.0) / (c + 1.0) * (inner_next - edge))
    }
}

/// g and C²(1+g)/2 of the columns of a row.
trait Gain: Copy {
    fn at(self, i: usize) -> [f32; 2];
    /// Without the first and the last column.
    fn inner(self, count: usize) -> Self;
}

/// The same everywhere.
#[derive(Clone, Copy)]
struct Even([f32; 2]);

impl Gain for Even {
    #[inline(always)]
    fn at(self, _: usize) -> [f32; 2] {
        self.0
    }
    #[inline(always)]
    fn inner(self, _: usize) -> Self {
        self
    }
}

/// A factor of g for each column and one for the row, and C².
#[derive(Clone, Copy)]
struct Sponge<'a>(&'a [f32], f32, f32);

impl Gain for Sponge<'_> {
    #[inline(always)]
    fn at(self, i: usize) -> [f32; 2] {
        let g = self.0[i] * self.1;
        [g, (0.5 + 0.5 * g) * self.2]
    }
    #[inline(always)]
    fn inner(self, count: usize) -> Self {
        Self(&self.0[1..][..count], self.1, self.2)
    }
}

/// Relative c² of a row's faces.
struct Faces<'a> {
    east: &'a [f32],
    north: &'a [f32],
    south: &'a [f32],
}

/// u⁺ of one cell from u⁻, u and Lu.
#[inline(always)]
fn next<const LAST: bool>(before: f32, u: f32, [g, r]: [f32; 2], sum: f32) -> f32 {
    let next = u + (g * (u - before) + r * sum);
    if LAST { flushed(next) } else { next }
}

#[inline(always)]
fn five(u: f32, [w, e, n, s]: [f32; 4]) -> f32 {
    (w + e) + (n + s) - 4.0 * u
}

#[inline(always)]
fn nine(u: f32, [w, e, n, s]: [f32; 4], [nw, ne, sw, se]: [f32; 4]) -> f32 {
    let corners = (nw + ne) + (sw + se);
    (4.0 * ((w + e) + (n + s)) + corners - 20.0 * u) * (1.0 / 6.0)
}

/// A row without its last two, its first and last, and its first two cells: west, middle and east of the inner cells.
#[inline(always)]
fn inner(row: &[f32], count: usize) -> [&[f32]; 3] {
    [&row[..count], &row[1..][..count], &row[2..][..count]]
}

/// Columns that count as west of the first cell and east of the last.
#[inline(always)]
fn around(m: usize, wraps: bool) -> (usize, usize) {
    if wraps { (m - 1, 0) } else { (0, m - 1) }
}

/// Five-point row over constant depth. `g` gives the gain of a column.
#[inline(always)]
fn five_row<const LAST: bool>(out: &mut [f32], u: &[f32], n: &[f32], s: &[f32], wraps: bool, g: impl Gain) {
    let m = out.len();
    let (west, east) = around(m, wraps);
    for (i, w, e) in [(0, west, 1), (m - 1, m - 2, east)] {
        out[i] = next::<LAST>(out[i], u[i], g.at(i), five(u[i], [u[w], u[e], n[i], s[i]]));
    }
    let k = m - 2;
    let (out, [w, u, e]) = (&mut out[1..][..k], inner(u, k));
    let (n, s, g) = (&n[1..][..k], &s[1..][..k], g.inner(k));
    for i in 0..k {
        out[i] = next::<LAST>(out[i], u[i], g.at(i), five(u[i], [w[i], e[i], n[i], s[i]]));
    }
}

/// Nine-point row over constant depth.
#[inline(always)]
fn nine_row<const LAST: bool>(out: &mut [f32], u: &[f32], n: &[f32], s: &[f32], wraps: bool, g: impl Gain) {
    let m = out.len();
    let (west, east) = around(m, wraps);
    for (i, w, e) in [(0, west, 1), (m - 1, m - 2, east)] {
        let sum = nine(u[i], [u[w], u[e], n[i], s[i]], [n[w], n[e], s[w], s[e]]);
        out[i] = next::<LAST>(out[i], u[i], g.at(i), sum);
    }
    let k = m - 2;
    let (out, [w, u, e], g) = (&mut out[1..][..k], inner(u, k), g.inner(k));
    let ([nw, n, ne], [sw, s, se]) = (inner(n, k), inner(s, k));
    for i in 0..k {
        let sum = nine(u[i], [w[i], e[i], n[i], s[i]], [nw[i], ne[i], sw[i], se[i]]);
        out[i] = next::<LAST>(out[i], u[i], g.at(i), sum);
    }
}

/// Row over depths that differ: fluxes through faces, so what leaves one cell enters its neighbour.
#[inline(always)]
fn faces_row<const LAST: bool>(out: &mut [f32], u: &[f32], n: &[f32], s: &[f32], faces: Faces<'_>, g: impl Gain) {
    let m = out.len();
    let Faces { east, north, south } = faces;
    // The face around the border is 0 unless the field is periodic.
    for (i, w, e) in [(0, m - 1, 1), (m - 1, m - 2, 0)] {
        let along = east[i] * (u[e] - u[i]) - east[w] * (u[i] - u[w]);
        let across = south[i] * (s[i] - u[i]) - north[i] * (u[i] - n[i]);
        out[i] = next::<LAST>(out[i], u[i], g.at(i), along + across);
    }
    let k = m - 2;
    let (out, [w, u, e], g) = (&mut out[1..][..k], inner(u, k), g.inner(k));
    let (n, s, north, south) = (&n[1..][..k], &s[1..][..k], &north[1..][..k], &south[1..][..k]);
    let [west, east, _] = inner(east, k);
    for i in 0..k {
        let along = east[i] * (e[i] - u[i]) - west[i] * (u[i] - w[i]);
        let across = south[i] * (s[i] - u[i]) - north[i] * (u[i] - n[i]);
        out[i] = next::<LAST>(out[i], u[i], g.at(i), along + across);
    }
}
