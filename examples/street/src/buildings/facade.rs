//! Walls of a house: the holes of its windows and doors, plinth, bands, pipes.

use super::openings::{self, Kind, Opening};
use super::{Dress, Ground, House, tile};
use crate::materials::{Mat, Parts};
use crate::mesh::{ALL, BACK, FRONT, Frame, LEFT, RIGHT, TOP};
use crate::noise::Rng;

/// Walls start below the pavement, metres.
const BASE_Y: f32 = -0.25;
/// Floor of the first storey, metres.
const FLOOR_Y: f32 = 0.17;
/// Top of the plinth, metres.
const PLINTH_Y: f32 = 0.62;

/// The show window of a house with a shop, along its façade.
#[must_use]
pub fn shop_span(h: &House) -> [f32; 2] {
    [0.55, h.width - 2.05]
}

/// A wall `width` wide from `low` to `high` with holes in it.
pub fn wall(parts: &mut Parts, f: &Frame, width: f32, y: [f32; 2], mat: Mat, holes: &[Opening]) {
    let edges = |ends: [f32; 2], of: fn(&Opening) -> [f32; 2]| {
        let mut e: Vec<f32> = ends
            .into_iter()
            .chain(holes.iter().flat_map(of))
            .filter(|x| *x >= ends[0] && *x <= ends[1])
            .collect();
        e.sort_by(f32::total_cmp);
        e.dedup_by(|a, b| (*a - *b).abs() < 1e-4);
        e
    };
    let (ss, ys) = (edges([0.0, width], |o| o.s), edges(y, |o| o.y));
    for b in ys.windows(2) {
        for a in ss.windows(2) {
            let (s, y) = (0.5 * (a[0] + a[1]), 0.5 * (b[0] + b[1]));
            if holes
                .iter()
                .any(|o| s > o.s[0] && s < o.s[1] && y > o.y[0] && y < o.y[1])
            {
                continue;
            }
            parts
                .get(mat)
                .block(f, [a[0], b[0], 0.0], [a[1], b[1], 0.0], tile(mat), FRONT);
        }
    }
}

fn upper_windows(h: &House, width: f32, bays: u32, from: u32, rng: &mut Rng) -> Vec<Opening> {
    let mut list = Vec::new();
    let bay = width / bays as f32;
    let half = (0.5 * bay - 0.28).min(if h.dress == Dress::Shutters { 0.46 } else { 0.55 });
    for storey in from..h.storeys {
        let floor = h.ground_m + (storey - 1) as f32 * h.storey_m;
        // Storeys get lower windows towards the roof.
        let top = floor + 2.35 - 0.12 * storey as f32 + (h.storey_m - 2.9) * 0.6;
        for k in 0..bays {
            let mid = (k as f32 + 0.5) * bay;
            let kind = Kind::Window { lit: rng.unit() < 0.34 };
            list.push(Opening {
                s: [mid - half, mid + half],
                y: [floor + 0.78, top],
                kind,
            });
        }
    }
    list
}

fn ground_openings(h: &House, rng: &mut Rng) -> Vec<Opening> {
    match h.ground {
        Ground::Arcade => Vec::new(),
        Ground::Home => {
            let bay = h.width / h.bays as f32;
            let door = if h.bays % 2 == 1 {
                h.bays / 2
            } else {
                rng.below(h.bays as usize) as u32
            };
            (0..h.bays)
                .map(|k| {
                    let mid = (k as f32 + 0.5) * bay;
                    let half = (0.5 * bay - 0.3).min(0.55);
                    if k == door {
                        Opening {
                            s: [mid - 0.6, mid + 0.6],
                            y: [FLOOR_Y, FLOOR_Y + 2.5],
                            kind: Kind::Door,
                        }
                    } else {
                        let kind = Kind::Window { lit: rng.unit() < 0.4 };
                        Opening {
                            s: [mid - half, mid + half],
                            y: [1.0, 2.6],
                            kind,
                        }
                    }
                })
                .collect()
        }
        Ground::Shop | Ground::ShopAwning => {
            let s = shop_span(h);
            let show = Opening {
                s,
                y: [0.75, 2.72],
                kind: Kind::Show,
            };
            let door = Opening {
                s: [s[1] + 0.3, s[1] + 1.35],
                y: [FLOOR_Y, 2.72],
                kind: Kind::ShopDoor,
            };
            vec![show, door]
        }
    }
}

/// The front: wall, openings, plinth, bands, shop sign, awning, rain pipe.
pub fn front(h: &House, parts: &mut Parts, rng: &mut Rng) {
    let f = h.frame();
    let top = h.wall_top() + 0.1;
    let holes: Vec<Opening> = ground_openings(h, rng)
        .into_iter()
        .chain(upper_windows(h, h.width, h.bays, 1, rng))
        .collect();
    let low = if h.ground == Ground::Arcade {
        h.ground_m - 0.3
    } else {
        BASE_Y
    };
    wall(parts, &f, h.width, [low, top], h.wall, &holes);
    for o in &holes {
        openings::fill(
            parts,
            &f,
            o,
            h.wall,
            if o.y[0] > 1.5 || h.ground == Ground::Home {
                h.dress
            } else {
                Dress::Bare
            },
            rng,
        );
    }
    let trim = if h.wall == Mat::Stone { Mat::White } else { Mat::Stone };
    let t = tile(trim);
    if h.ground != Ground::Arcade {
        // The plinth stands before the wall, interrupted by whatever reaches below its top.
        let mut from = 0.0;
        let mut cuts: Vec<[f32; 2]> = holes
            .iter()
            .filter(|o| o.y[0] < PLINTH_Y + 0.2)
            .map(|o| {
                if o.kind == Kind::Door {
                    [o.s[0] - 0.17, o.s[1] + 0.17]
                } else {
                    o.s
                }
            })
            .collect();
        cuts.sort_by(|a, b| a[0].total_cmp(&b[0]));
        cuts.push([h.width, h.width]);
        for [a, b] in cuts {
            if a - from > 0.02 {
                parts.get(Mat::Stone).block(
                    &f,
                    [from, BASE_Y, 0.0],
                    [a, PLINTH_Y, 0.04],
                    tile(Mat::Stone),
                    FRONT | LEFT | RIGHT | TOP,
                );
            }
            from = b;
        }
    }
    if matches!(h.ground, Ground::Shop | Ground::ShopAwning) {
        let s = [0.35, h.width - 0.45];
        openings::sign(parts, &f, s, [3.0, 3.42]);
        for (a, b) in [(0.35, 0.55), (s[1] - 0.25, s[1])] {
            parts
                .get(Mat::Painted)
                .block(&f, [a, 0.0, 0.0], [b, 3.0, 0.05], tile(Mat::Painted), ALL & !BACK);
        }
    }
    if h.ground == Ground::ShopAwning {
        openings::awning(parts, &f, shop_span(h));
    }
    if h.storeys > 1 {
        let y = h.ground_m + 0.12;
        parts
            .get(trim)
            .block(&f, [0.0, y, 0.0], [h.width, y + 0.16, 0.055], t, ALL & !BACK);
    }
    let y = h.wall_top() - 0.42;
    parts
        .get(trim)
        .block(&f, [0.0, y - 0.16, 0.0], [h.width, y, 0.07], t, ALL & !BACK);
    parts
        .get(trim)
        .block(&f, [0.0, y, 0.0], [h.width, y + 0.14, 0.15], t, ALL & !BACK);
}

/// Gables and back wall; a gable has windows where its house says so.
pub fn sides_and_back(h: &House, parts: &mut Parts, rng: &mut Rng) {
    let f = h.frame();
    let (top, t) = (h.wall_top() + 0.1, tile(h.wall));
    let arcade = h.ground == Ground::Arcade;
    let left = Frame::facing(f.at(0.0, 0.0, -h.depth), -f.right);
    let right = Frame::facing(f.at(h.width, 0.0, 0.0), f.right);
    for (k, g) in [left, right].into_iter().enumerate() {
        let low = if arcade {
            crate::layout::ARCADE_CEILING_Y
        } else {
            BASE_Y
        };
        let holes = if h.gables[k] {
            upper_windows(h, h.depth, 3, 1, rng)
        } else {
            Vec::new()
        };
        wall(parts, &g, h.depth, [low, top], h.wall, &holes);
        for o in &holes {
            openings::fill(parts, &g, o, h.wall, h.dress, rng);
        }
        if arcade {
            // Under the arcade's ceiling the walkway itself stays open.
            let open = crate::layout::ARCADE_DEPTH;
            let s = if k == 0 { [0.0, h.depth - open] } else { [open, h.depth] };
            parts
                .get(h.wall)
                .block(&g, [s[0], BASE_Y, 0.0], [s[1], low, 0.0], t, FRONT);
        }
        let apex = top + super::roof::PITCH * 0.5 * h.depth;
        parts.get(h.wall).tri(
            [
                g.at(0.0, top, 0.0),
                g.at(h.depth, top, 0.0),
                g.at(0.5 * h.depth, apex, 0.0),
            ],
            t,
        );
    }
    let back = Frame::facing(f.at(h.width, 0.0, -h.depth), -f.out);
    parts
        .get(h.wall)
        .block(&back, [0.0, BASE_Y, 0.0], [h.width, top, 0.0], t, FRONT);
}
