//! Several steps in one pass over memory, by several threads, in place.
//!
//! Two levels are stored; a step writes the next one over the older. Step s of a row may run as soon as step s − 1 of
//! the next row has: a front of [`FUSED`] steps moves down the field, a row apart, while its rows are still in the
//! cache. For threads the rows are cut into bands. Within its band every thread runs a trapezoid, each step a row
//! shorter at an inner edge than the one before, so that nothing of the neighbour is needed; then the wedges around the
//! inner edges are filled. Every cell is computed once, by the same operations, whatever the cut: results do not depend
//! on it.

use rayon::prelude::*;

use super::border::Border;
use super::rows::Rules;

/// Steps in one pass.
pub(super) const FUSED: usize = 8;

/// Fields smaller than this are stepped by one thread. Units: cells.
const PARALLEL_CELLS: usize = 512 * 512;

/// Runs `steps` ≤ [`FUSED`] steps. The newest level ends in `now` when `steps` is even, else in `before`.
pub(super) fn run(rules: &Rules, before: &mut [f32], now: &mut [f32], steps: usize) {
    let (nx, nz) = (rules.nx, rules.nz);
    let threads = if nx * nz < PARALLEL_CELLS {
        1
    } else {
        rayon::current_num_threads()
    };
    if rules.border == Border::Periodic {
        return around(rules, before, now, steps, threads);
    }
    // Bands in which the trapezoids do not vanish, the last one included.
    let least = 2 * steps + 2;
    let mut count = threads.min(nz / least).max(1);
    while count > 1 && nz - nz.div_ceil(count) * (count - 1) < least {
        count -= 1;
    }
    let band = nz.div_ceil(count);
    if count == 1 {
        trapezoid(rules, before, now, 0, steps);
        return;
    }
    before
        .par_chunks_mut(band * nx)
        .zip(now.par_chunks_mut(band * nx))
        .enumerate()
        .for_each(|(index, (a, b))| trapezoid(rules, a, b, index * band, steps));
    // Chunks moved up by half a band have the inner edges in their middles.
    let half = band / 2;
    before[half * nx..]
        .par_chunks_mut(band * nx)
        .zip(now[half * nx..].par_chunks_mut(band * nx))
        .enumerate()
        .for_each(|(index, (a, b))| {
            let edge = (index + 1) * band;
            if edge < nz {
                wedge(rules, a, b, half + index * band, edge, steps);
            }
        });
}

/// The level that step `s`, from 1 on, writes, and the one it reads.
fn levels<'a>(a: &'a mut [f32], b: &'a mut [f32], s: usize) -> (&'a mut [f32], &'a [f32]) {
    if s % 2 == 1 { (a, b) } else { (b, a) }
}

/// All steps that need nothing from outside the band of rows from `first` on.
fn trapezoid(rules: &Rules, a: &mut [f32], b: &mut [f32], first: usize, steps: usize) {
    let rows = a.len() / rules.nx;
    let end = first + rows;
    for front in first..end + steps {
        for s in 1..=steps {
            let low = if first == 0 { 0 } else { first + s };
            let high = if end == rules.nz { end } else { end - s };
            let Some(j) = (front + 1).checked_sub(s) else { break };
            if low <= j && j < high {
                let (out, input) = levels(a, b, s);
                step_row(rules, j, out, input, first, s == steps);
            }
        }
    }
}

/// What [`trapezoid`] left open around the row `edge`; the slices hold the rows from `first` on.
fn wedge(rules: &Rules, a: &mut [f32], b: &mut [f32], first: usize, edge: usize, steps: usize) {
    for s in 1..=steps {
        for j in edge - s..edge + s {
            let (out, input) = levels(a, b, s);
            step_row(rules, j, out, input, first, s == steps);
        }
    }
}

/// Row `j` of a step, the last of a pass or not.
fn row(rules: &Rules, j: usize, out: &mut [f32], input: &[f32], first: usize, last: bool) {
    if last {
        rules.row::<true>(j, out, input, first);
    } else {
        rules.row::<false>(j, out, input, first);
    }
}

/// Row `j` of a step. The outer rows of an open field follow the rows inside them.
fn step_row(rules: &Rules, j: usize, out: &mut [f32], input: &[f32], first: usize, last: bool) {
    let nx = rules.nx;
    let at = (j - first) * nx;
    let open = matches!(rules.border, Border::Open { .. });
    if open && j == rules.nz - 1 {
        let (inner_next, edge_next) = out[at - nx..at + nx].split_at_mut(nx);
        rules.open_row(j, edge_next, &input[at..at + nx], &input[at - nx..at], inner_next);
    } else if !open || j > 0 {
        row(rules, j, &mut out[at..at + nx], input, first, last);
        if open && j == 1 {
            let (edge_next, inner_next) = out[..2 * nx].split_at_mut(nx);
            rules.open_row(0, edge_next, &input[..nx], &input[nx..2 * nx], inner_next);
        }
    }
}

/// Steps of a field whose rows go around: one at a time, since the first row needs the last.
fn around(rules: &Rules, before: &mut [f32], now: &mut [f32], steps: usize, threads: usize) {
    let (nx, band) = (rules.nx, rules.nz.div_ceil(threads));
    for s in 1..=steps {
        let (out, input) = levels(before, now, s);
        let rows = |first: usize, out: &mut [f32]| {
            for (k, out) in out.chunks_exact_mut(nx).enumerate() {
                row(rules, first + k, out, input, 0, s == steps);
            }
        };
        if threads == 1 {
            rows(0, out);
        } else {
            out.par_chunks_mut(band * nx)
                .enumerate()
                .for_each(|(index, out)| rows(index * band, out));
        }
    }
}
