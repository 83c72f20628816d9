//! What one sees behind glass: rooms, dark and lit, and shops. Atlases of cells, one window each.

use super::{Picture, srgb};
use crate::noise::{Rng, fbm, lattice, smoothstep};
use glam::{Vec3, vec3};

/// Cells across and down in the window atlas.
pub const WINDOW_CELLS: [u32; 2] = [4, 2];
/// Cells across and down in the shop atlas.
pub const SHOP_CELLS: [u32; 2] = [2, 2];

/// Curtains at the sides and, in some rooms, a blind or a net: how much of the pane is cloth, and its folds.
fn cloth(seed: u32, cell: u32, x: f32, y: f32) -> (f32, f32) {
    let open = 0.1 + 0.22 * lattice(seed, cell as i32, 1);
    let sway = 0.03 * fbm(seed ^ 5, x * 0.1, y, 1, 3, 2);
    let side = 1.0 - smoothstep(open - 0.01, open + 0.01, x.min(1.0 - x) + sway);
    let blind = if lattice(seed, cell as i32, 2) > 0.6 {
        1.0 - smoothstep(0.0, 0.01, y - 0.42)
    } else {
        0.0
    };
    let net = if lattice(seed, cell as i32, 3) > 0.55 {
        0.45
    } else {
        0.0
    };
    let folds = 0.75 + 0.25 * fbm(seed ^ 6, x, 0.0, 26, 1, 1);
    (side.max(blind).max(net), folds)
}

/// The light of a room at one point of its window, linear RGB, 1 = as bright as the lamp's wall.
fn room(seed: u32, cell: u32, x: f32, y: f32) -> Vec3 {
    let lamp_x = 0.3 + 0.4 * lattice(seed, cell as i32, 4);
    let (dx, dy) = (x - lamp_x, y - 0.28);
    let glow = 1.0 / (1.0 + 9.0 * (dx * dx + 0.7 * dy * dy));
    let shelf = if y > 0.66 && (x * 3.0 + lattice(seed, cell as i32, 5)).fract() < 0.55 {
        0.35
    } else {
        1.0
    };
    let picture = if (x - 0.62).abs() < 0.1 && (y - 0.42).abs() < 0.09 {
        0.5
    } else {
        1.0
    };
    let bulb = if dx * dx + dy * dy < 0.0028 { 2.2 } else { 1.0 };
    let tint = [
        vec3(1.0, 0.62, 0.27),
        vec3(1.0, 0.7, 0.38),
        vec3(1.0, 0.55, 0.2),
        vec3(0.95, 0.78, 0.52),
    ];
    tint[(lattice(seed, cell as i32, 6) * 4.0) as usize % 4] * (0.75 * glow * shelf * picture * bulb)
}

fn cell_of(px: u32, py: u32, size: [u32; 2], cells: [u32; 2]) -> (u32, f32, f32) {
    let x = (px as f32 + 0.5) / size[0] as f32 * cells[0] as f32;
    let y = (py as f32 + 0.5) / size[1] as f32 * cells[1] as f32;
    (y as u32 * cells[0] + x as u32, x.fract(), y.fract())
}

/// Window atlas: reflectance behind the pane, then light when lit.
#[must_use]
pub fn windows(seed: u32) -> Vec<Picture> {
    let size = [512, 512];
    let base = Picture::new("window-color", size[0], size[1], 3, move |px, py| {
        let (cell, x, y) = cell_of(px, py, size, WINDOW_CELLS);
        let (cover, folds) = cloth(seed ^ 500, cell, x, y);
        let c = vec3(0.016, 0.018, 0.02).lerp(vec3(0.16, 0.155, 0.14) * folds * folds, cover);
        [srgb(c.x), srgb(c.y), srgb(c.z), 255]
    });
    let lit = Picture::new("window-light", size[0], size[1], 3, move |px, py| {
        let (cell, x, y) = cell_of(px, py, size, WINDOW_CELLS);
        let (cover, folds) = cloth(seed ^ 500, cell, x, y);
        let inside = room(seed ^ 501, cell, x, y);
        // Cloth glows with the room's mean light.
        let glow = room(seed ^ 501, cell, 0.5, 0.3).lerp(inside, 0.4) * (0.5 * folds);
        let c = inside.lerp(glow, cover);
        [srgb(c.x), srgb(c.y), srgb(c.z), 255]
    });
    vec![base, lit]
}

/// Shop atlas: light of shelves with goods behind the pane.
#[must_use]
pub fn shops(seed: u64) -> Picture {
    let size = [512_u32, 512];
    let mut canvas = vec![Vec3::ZERO; (size[0] * size[1]) as usize];
    for cell in 0..SHOP_CELLS[0] * SHOP_CELLS[1] {
        let mut rng = Rng::new(seed, 520 + cell);
        let origin = [(cell % 2) * 256, (cell / 2) * 256];
        let wall = [
            vec3(0.95, 0.72, 0.42),
            vec3(1.0, 0.64, 0.33),
            vec3(0.85, 0.78, 0.62),
            vec3(1.0, 0.68, 0.36),
        ][cell as usize];
        let mut fill = |x0: f32, y0: f32, x1: f32, y1: f32, c: Vec3, keep: f32| {
            for y in (y0.max(0.0) as u32)..(y1.clamp(0.0, 256.0) as u32) {
                for x in (x0.max(0.0) as u32)..(x1.clamp(0.0, 256.0) as u32) {
                    let p = &mut canvas[((origin[1] + y) * size[0] + origin[0] + x) as usize];
                    *p = *p * keep + c;
                }
            }
        };
        // The back wall, lit from above; the floor.
        for k in 0..64 {
            let y = k as f32 * 4.0;
            let fall = 0.62 - 0.42 * (k as f32 / 63.0);
            fill(0.0, y, 256.0, y + 4.0, wall * fall, 0.0);
        }
        fill(0.0, 0.0, 256.0, 24.0, wall * 0.35, 0.0);
        fill(0.0, 218.0, 256.0, 256.0, vec3(0.11, 0.06, 0.03), 0.0);
        if cell % 2 == 0 {
            shelves(&mut fill, &mut rng);
        } else {
            tavern(&mut fill, &mut rng);
        }
    }
    Picture::new("shop-light", size[0], size[1], 3, |x, y| {
        let c = canvas[(y * size[0] + x) as usize].min(Vec3::ONE);
        [srgb(c.x), srgb(c.y), srgb(c.z), 255]
    })
}

type Fill<'a> = dyn FnMut(f32, f32, f32, f32, Vec3, f32) + 'a;

/// Shelves with goods, and spotlights above them.
fn shelves(fill: &mut Fill, rng: &mut Rng) {
    for k in 0..5 {
        let x = 28.0 + 50.0 * k as f32;
        fill(x - 5.0, 14.0, x + 5.0, 20.0, vec3(2.0, 1.7, 1.2), 0.0);
    }
    for shelf in 0..5 {
        let y = 76.0 + 34.0 * shelf as f32;
        let mut x = 12.0 + rng.range(0.0, 8.0);
        while x < 240.0 {
            let (w, h) = (rng.range(3.0, 10.0), rng.range(8.0, 24.0));
            let hue = rng.unit();
            let colour = vec3(0.5, 0.3, 0.14).lerp(vec3(rng.unit(), rng.unit() * 0.7, rng.unit() * 0.5), 0.45)
                * (0.5 + 0.5 * hue);
            if rng.unit() < 0.85 {
                fill(x, y - h, x + w, y, colour * (0.62 - 0.07 * shelf as f32), 0.0);
            }
            x += w + rng.range(0.5, 3.0);
        }
        fill(8.0, y, 248.0, y + 3.0, vec3(0.16, 0.09, 0.045), 0.0);
    }
}

/// Panelling, framed pictures, hanging lamps, tables and chairs.
fn tavern(fill: &mut Fill, rng: &mut Rng) {
    fill(0.0, 140.0, 256.0, 218.0, vec3(0.17, 0.085, 0.035), 0.25);
    for k in 0..9 {
        let x = 28.0 * k as f32;
        fill(x, 140.0, x + 2.0, 218.0, Vec3::ZERO, 0.5);
    }
    for k in 0..3 {
        let x = 22.0 + 80.0 * k as f32 + rng.range(0.0, 20.0);
        let (w, h) = (rng.range(24.0, 44.0), rng.range(20.0, 36.0));
        fill(x, 80.0, x + w, 80.0 + h, vec3(0.1, 0.06, 0.03), 0.0);
        fill(
            x + 3.0,
            83.0,
            x + w - 3.0,
            77.0 + h,
            vec3(rng.range(0.2, 0.5), 0.26, rng.range(0.1, 0.25)),
            0.0,
        );
        let lamp = 44.0 + 84.0 * k as f32;
        fill(lamp - 0.8, 0.0, lamp + 0.8, 42.0, Vec3::ZERO, 0.2);
        for ring in 0..7 {
            let r = 7.0 + 7.0 * ring as f32;
            fill(
                lamp - r,
                50.0 - 0.7 * r,
                lamp + r,
                50.0 + r,
                vec3(0.05, 0.032, 0.014),
                1.0,
            );
        }
        fill(lamp - 9.0, 42.0, lamp + 9.0, 54.0, vec3(2.0, 1.5, 0.85), 0.0);
        let table = 12.0 + 84.0 * k as f32;
        fill(table, 184.0, table + 58.0, 188.0, vec3(0.3, 0.17, 0.08), 0.0);
        fill(table + 26.0, 188.0, table + 31.0, 240.0, vec3(0.02, 0.012, 0.008), 0.0);
        for seat in [table - 6.0, table + 54.0] {
            fill(seat, 166.0, seat + 8.0, 244.0, vec3(0.035, 0.02, 0.012), 0.1);
        }
        fill(table + 18.0, 174.0, table + 22.0, 184.0, vec3(1.2, 0.85, 0.4), 0.0);
    }
}
