//! The step of one row: u⁺ = u + (1−a)/(1+a) (u − u⁻) + C²/(1+a) L u, written over u⁻.
//!
//! This is physics' u⁺ = (2u − (1−a)u⁻ + C²Lu)/(1+a) with the differences taken first: in single precision a level
//! surface then stays level, and what is left of the rounding is that of the small terms. With g = (1−a)/(1+a) the other
//! factor is 1/(1+a) = ½(1+g), so one number a cell describes any damping.

#![allow(
    clippy::needless_range_loop,
    reason = "a cell and its neighbours by one index; slices of one length, so no check is left in the loops"
)]

use super::bed::Bed;
use super::border::Border;
use super::stencil::Stencil;

/// Heights below this are 0: a quiet pond must not run into denormal numbers. Units: m.
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
    /// row `first` on, with the neighbours of row `j`.
    pub fn row(&self, j: usize, out: &mut [f32], input: &[f32], first: usize) {
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
        if let Some(bed) = &self.bed {
            let above = if j > 0 { j - 1 } else { last };
            let faces = Faces {
                east: &bed.east[j * nx..][..nx],
                north: &bed.south[above * nx..][..nx],
                south: &bed.south[j * nx..][..nx],
            };
            if self.sponge_x.is_empty() {
                faces_row(out, here, north, south, faces, self.c2, |_| self.g);
            } else {
                let (gx, gz) = (&self.sponge_x[..nx], self.sponge_z[j]);
                faces_row(out, here, north, south, faces, self.c2, |i| gx[i] * gz);
            }
        } else {
            match (self.stencil, self.sponge_x.is_empty()) {
                (Stencil::FivePoint, true) => five_row(out, here, north, south, wraps, self.c2, |_| self.g),
                (Stencil::NinePoint, true) => nine_row(out, here, north, south, wraps, self.c2, |_| self.g),
                (Stencil::FivePoint, false) => {
                    let (gx, gz) = (&self.sponge_x[..nx], self.sponge_z[j]);
                    five_row(out, here, north, south, wraps, self.c2, |i| gx[i] * gz);
                }
                (Stencil::NinePoint, false) => {
                    let (gx, gz) = (&self.sponge_x[..nx], self.sponge_z[j]);
                    nine_row(out, here, north, south, wraps, self.c2, |i| gx[i] * gz);
                }
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

/// Relative c² of a row's faces.
struct Faces<'a> {
    east: &'a [f32],
    north: &'a [f32],
    south: &'a [f32],
}

/// Five-point row over constant depth.
#[inline(always)]
fn five_row(out: &mut [f32], here: &[f32], n: &[f32], s: &[f32], wraps: bool, c2: f32, g: impl Fn(usize) -> f32) {
    let m = out.len();
    let (u, n, s) = (&here[..m], &n[..m], &s[..m]);
    let cell = |before: f32, i: usize, west: f32, east: f32| {
        let g = g(i);
        let sum = (west + east) + (n[i] + s[i]) - 4.0 * u[i];
        flushed(u[i] + (g * (u[i] - before) + (0.5 + 0.5 * g) * c2 * sum))
    };
    let (west, east) = if wraps { (m - 1, 0) } else { (0, m - 1) };
    out[0] = cell(out[0], 0, u[west], u[1]);
    for i in 1..m - 1 {
        out[i] = cell(out[i], i, u[i - 1], u[i + 1]);
    }
    out[m - 1] = cell(out[m - 1], m - 1, u[m - 2], u[east]);
}

/// Nine-point row over constant depth.
#[inline(always)]
fn nine_row(out: &mut [f32], here: &[f32], n: &[f32], s: &[f32], wraps: bool, c2: f32, g: impl Fn(usize) -> f32) {
    let m = out.len();
    let (u, n, s) = (&here[..m], &n[..m], &s[..m]);
    let c2 = c2 / 6.0;
    let cell = |before: f32, i: usize, w: usize, e: usize| {
        let g = g(i);
        let edges = (u[w] + u[e]) + (n[i] + s[i]);
        let corners = (n[w] + n[e]) + (s[w] + s[e]);
        let sum = 4.0 * edges + corners - 20.0 * u[i];
        flushed(u[i] + (g * (u[i] - before) + (0.5 + 0.5 * g) * c2 * sum))
    };
    let (west, east) = if wraps { (m - 1, 0) } else { (0, m - 1) };
    out[0] = cell(out[0], 0, west, 1);
    for i in 1..m - 1 {
        out[i] = cell(out[i], i, i - 1, i + 1);
    }
    out[m - 1] = cell(out[m - 1], m - 1, m - 2, east);
}

/// Row over depths that differ: fluxes through faces, so what leaves one cell enters its neighbour.
#[inline(always)]
fn faces_row(out: &mut [f32], here: &[f32], n: &[f32], s: &[f32], faces: Faces<'_>, c2: f32, g: impl Fn(usize) -> f32) {
    let m = out.len();
    let (u, n, s) = (&here[..m], &n[..m], &s[..m]);
    let (east, north, south) = (&faces.east[..m], &faces.north[..m], &faces.south[..m]);
    let cell = |before: f32, i: usize, w: usize, e: usize| {
        let g = g(i);
        let along = east[i] * (u[e] - u[i]) - east[w] * (u[i] - u[w]);
        let across = south[i] * (s[i] - u[i]) - north[i] * (u[i] - n[i]);
        flushed(u[i] + (g * (u[i] - before) + (0.5 + 0.5 * g) * c2 * (along + across)))
    };
    // The face around the border is 0 unless the field is periodic.
    out[0] = cell(out[0], 0, m - 1, 1);
    for i in 1..m - 1 {
        out[i] = cell(out[i], i, i - 1, i + 1);
    }
    out[m - 1] = cell(out[m - 1], m - 1, m - 2, 0);
}
