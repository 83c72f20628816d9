//! Which drops a view holds, the slow way: every cell of a block around the eye, every drop in it.

use crate::field::{cell_key, contrast_range, drops, presence, threshold};

/// A view of the rain.
#[derive(Debug, Clone, Copy)]
pub struct View {
    /// m.
    pub eye: [f64; 3],
    /// The eye's, m/s.
    pub velocity: [f64; 3],
    /// The picture's sides as planes through the eye: inward unit normal, offset in m.
    pub sides: [[f64; 4]; 4],
    /// Focal length, px.
    pub focal: f64,
    /// s.
    pub exposure: f64,
    /// How far the view turns in it, rad.
    pub turn: f64,
    /// κ.
    pub quality: f64,
}

/// A size class.
#[derive(Debug, Clone, Copy)]
pub struct Class {
    /// From 0.
    pub number: u32,
    /// Smallest and largest, mm.
    pub diameters: [f64; 2],
    /// Edge of its cells, m.
    pub cell: f64,
    /// m/s.
    pub velocity: [f64; 3],
    /// How far that has carried it, m.
    pub offset: [f64; 3],
}

/// A drop of the field near a view.
#[derive(Debug, Clone, Copy)]
pub struct Seen {
    /// Its cell, counted from the eye's.
    pub cell: [i64; 3],
    /// Its number in the cell.
    pub index: u32,
    /// From the eye, m.
    pub place: [f64; 3],
    /// In (0, 1].
    pub presence: f64,
    /// How far inside reach and sides it is, m; below 0: outside.
    pub inside: f64,
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// Where the eye will be after 0.15 s, but no further than 8 m away.
pub fn lead(velocity: [f64; 3]) -> [f64; 3] {
    let way = velocity.map(|v| 0.15 * v);
    let share = (8.0 / length(way)).min(1.0);
    way.map(|x| x * share)
}

/// Distance of `p` from the eye's way ahead, from 0 to `lead`.
pub fn from_way(p: [f64; 3], lead: [f64; 3]) -> f64 {
    let to = |share: f64| length([0, 1, 2].map(|i| p[i] - share * lead[i]));
    let square = dot(lead, lead);
    let foot = dot(p, lead) / square;
    let ends = to(0.0).min(to(1.0));
    if foot > 0.0 && foot < 1.0 { to(foot) } else { ends }
}

/// All drops of a class in the cells around the eye that a view could hold, with how far inside it they are.
/// `density`: N(D), m⁻³ mm⁻¹.
pub fn seen(seed: u64, class: &Class, view: &View, density: impl Fn(f64) -> f64) -> Vec<Seen> {
    let [smallest, largest] = class.diameters;
    let range = |d: f64| 1.2 * (view.quality * contrast_range(d, view.focal, view.exposure)).min(15.0);
    let ahead = lead(view.velocity);
    let relative = [0, 1, 2].map(|i| class.velocity[i] - view.velocity[i]);
    let way = relative.map(|v| v * view.exposure);
    let furthest = range(largest) + length(ahead);
    let eye = [0, 1, 2].map(|i| (view.eye[i] - class.offset[i]) / class.cell);
    let home = eye.map(f64::floor);
    // Ranks beyond every threshold of the class.
    let edges = [smallest, largest].map(|d| threshold(class.cell, smallest, largest, d, density(d)));
    let last = 1.06 * edges[0].max(edges[1]);
    let block = [0, 1, 2].map(|i| {
        let most = range(largest).max(range(smallest));
        let low = ((ahead[i].min(0.0) - most) / class.cell).floor() as i64 - 1;
        let high = ((ahead[i].max(0.0) + most) / class.cell).ceil() as i64 + 1;
        (low, high)
    });
    let mut found = Vec::new();
    for x in block[0].0..=block[0].1 {
        for y in block[1].0..=block[1].1 {
            for z in block[2].0..=block[2].1 {
                let cell = [x, y, z];
                let key = cell_key(seed, class.number, [0, 1, 2].map(|i| home[i] as i64 + cell[i]));
                for (index, drop) in drops(key, smallest, largest, last).iter().enumerate() {
                    let n = density(drop.diameter);
                    let there = presence(drop.rank, threshold(class.cell, smallest, largest, drop.diameter, n));
                    if there <= 0.0 {
                        continue;
                    }
                    let place = [0, 1, 2].map(|i| (cell[i] as f64 + drop.place[i] - (eye[i] - home[i])) * class.cell);
                    let mut inside = range(drop.diameter) - from_way(place, ahead);
                    // Where it was when the shutter opened, and by how much the sides may have been elsewhere.
                    let was = [0, 1, 2].map(|i| place[i] - way[i]);
                    let turned = view.turn.clamp(0.0, 0.1) * (furthest + length(way));
                    for [nx, ny, nz, offset] in view.sides {
                        let (now, then) = (dot([nx, ny, nz], place), dot([nx, ny, nz], was) + turned);
                        inside = inside.min(now.max(then) + offset + 0.01);
                    }
                    found.push(Seen {
                        cell,
                        index: index as u32,
                        place,
                        presence: there,
                        inside,
                    });
                }
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_ahead_is_short_and_near() {
        assert_eq!(lead([0.0; 3]), [0.0; 3]);
        assert_eq!(lead([0.0, 0.0, -20.0]), [0.0, 0.0, -3.0]);
        assert!((lead([300.0, 0.0, 0.0])[0] - 8.0).abs() < 1e-14);
        assert_eq!(from_way([3.0, 4.0, 0.0], [0.0; 3]), 5.0);
        assert_eq!(from_way([3.0, 4.0, 0.0], [8.0, 0.0, 0.0]), 4.0);
        assert_eq!(from_way([11.0, 4.0, 0.0], [8.0, 0.0, 0.0]), 5.0);
    }
}
