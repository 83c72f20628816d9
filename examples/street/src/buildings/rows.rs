//! Which house stands where.

use super::{Dress, Ground, House, arcade, room};
use crate::layout::{ARCADE_Z, CROSS_HALF_X, CROSS_WALL_Z, FACADE_X, ROW_END_Z, SQUARE_X, SQUARE_Z};
use crate::materials::{Mat, Parts};
use crate::mesh::{ALL, BACK, BOTTOM, FRONT, Frame, LEFT, RIGHT};
use crate::noise::Rng;
use glam::{Vec3, vec3};

/// Highest point of the church tower behind the far end of the street, metres.
pub const TOWER_TOP_Y: f32 = 37.0;
/// Middle of the church tower: x and z.
const TOWER: [f32; 2] = [4.5, 54.0];

const fn house(
    corner: [f32; 2],
    out: Vec3,
    width: f32,
    storeys: u32,
    bays: u32,
    wall: Mat,
    ground: Ground,
    dress: Dress,
) -> House {
    let roof = if storeys % 2 == 1 { Mat::Roof } else { Mat::RoofDark };
    House {
        corner,
        out,
        width,
        depth: 9.0,
        storeys,
        ground_m: 3.6,
        storey_m: 2.95,
        wall,
        roof,
        bays,
        ground,
        dress,
        dormers: 0,
        gables: [false; 2],
    }
}

impl House {
    const fn tall(mut self, ground_m: f32, storey_m: f32) -> Self {
        self.ground_m = ground_m;
        self.storey_m = storey_m;
        self
    }

    const fn dormers(mut self, n: u32) -> Self {
        self.dormers = n;
        self
    }

    const fn gables(mut self, left: bool, right: bool) -> Self {
        self.gables = [left, right];
        self
    }

    const fn roofed(mut self, roof: Mat) -> Self {
        self.roof = roof;
        self
    }
}

/// West side, from its far (high z) end; the façades face +X.
fn west() -> Vec<House> {
    use Dress::{Bare, Framed, Shutters};
    use Ground::{Home, Shop, ShopAwning};
    let at = |z: f32| [-FACADE_X, z];
    let x = Vec3::X;
    vec![
        house(at(ROW_END_Z), x, 7.5, 4, 3, Mat::Cream, Shop, Framed).gables(true, false),
        house(at(26.0), x, 8.0, 3, 3, Mat::Brick, Home, Bare).dormers(2),
        house(at(18.0), x, 8.5, 2, 3, Mat::Sage, Home, Shutters)
            .dormers(2)
            .roofed(Mat::Roof),
        house(at(9.5), x, 8.0, 3, 3, Mat::Rose, ShopAwning, Framed).tall(3.7, 3.05),
        house(at(1.5), x, 8.0, 4, 4, Mat::Brick, ShopAwning, Framed).roofed(Mat::RoofDark),
        house(at(-6.5), x, 9.0, 3, 4, Mat::Ochre, Home, Shutters)
            .dormers(1)
            .tall(3.5, 2.85),
        house(at(-15.5), x, 9.0, 2, 3, Mat::Cream, Shop, Shutters)
            .dormers(2)
            .roofed(Mat::Roof),
        house(at(-24.5), x, 9.0, 3, 4, Mat::Brick, Home, Framed)
            .tall(3.65, 3.1)
            .gables(false, true),
    ]
}

/// East side, from its near (low z) end; the façades face −X.
fn east() -> Vec<House> {
    use Dress::{Bare, Framed, Shutters};
    use Ground::{Arcade, Home, Shop, ShopAwning};
    let at = |z: f32| [FACADE_X, z];
    let x = Vec3::NEG_X;
    let half = 0.5 * (ARCADE_Z[1] - ARCADE_Z[0]);
    vec![
        house(at(-ROW_END_Z), x, 8.0, 4, 3, Mat::Sage, Home, Framed).gables(true, false),
        house(at(-25.5), x, 8.5, 2, 3, Mat::Brick, ShopAwning, Bare).dormers(2),
        house(at(-17.0), x, 7.5, 3, 3, Mat::Rose, Home, Shutters),
        house(at(-9.5), x, 7.5, 4, 3, Mat::Brick, Shop, Framed).tall(3.5, 2.9),
        house(at(ARCADE_Z[0]), x, half, 3, 3, Mat::Ochre, Arcade, Framed)
            .tall(4.0, 3.0)
            .dormers(2),
        house(at(ARCADE_Z[0] + half), x, half, 4, 3, Mat::Cream, Arcade, Framed)
            .tall(4.0, 2.95)
            .gables(false, true),
        house(
            [SQUARE_X, SQUARE_Z[0]],
            x,
            SQUARE_Z[1] - SQUARE_Z[0],
            3,
            4,
            Mat::Sage,
            Shop,
            Shutters,
        )
        .dormers(2),
        house(at(SQUARE_Z[1]), x, 5.5, 4, 2, Mat::Brick, Home, Framed)
            .gables(true, false)
            .tall(3.6, 2.85),
        house(at(27.5), x, 6.0, 3, 2, Mat::Rose, Shop, Shutters).gables(false, true),
    ]
}

/// Rows that close the view: beyond the cross streets, at their ends, and beside the corner houses.
fn around() -> Vec<House> {
    let mut list = Vec::new();
    let walls = [Mat::Cream, Mat::Brick, Mat::Ochre, Mat::Sage, Mat::Rose];
    let storeys = [3, 4, 2, 3, 4];
    for sign in [1.0_f32, -1.0] {
        let width = 2.0 * CROSS_HALF_X / 5.0;
        for k in 0..5 {
            let (i, j) = if sign > 0.0 { (k, k) } else { (4 - k, (k + 2) % 5) };
            let corner = [
                (CROSS_HALF_X - i as f32 * width) * if sign > 0.0 { 1.0 } else { -1.0 },
                CROSS_WALL_Z * sign,
            ];
            let corner = if sign > 0.0 {
                corner
            } else {
                [-CROSS_HALF_X + k as f32 * width, corner[1]]
            };
            let ground = if k == 2 { Ground::Shop } else { Ground::Home };
            let mut h = house(
                corner,
                Vec3::Z * -sign,
                width,
                storeys[j],
                4,
                walls[(j + 1) % 5],
                ground,
                Dress::Bare,
            );
            h.storey_m += 0.07 * k as f32;
            h.dormers = if storeys[j] < 4 { 2 } else { 0 };
            list.push(h);
        }
        for side in [1.0_f32, -1.0] {
            // At the end of the cross street, facing the crossing.
            let reach = CROSS_WALL_Z - ROW_END_Z;
            let z = if side * sign > 0.0 {
                ROW_END_Z * sign
            } else {
                CROSS_WALL_Z * sign
            };
            list.push(house(
                [CROSS_HALF_X * side, z],
                Vec3::X * -side,
                reach,
                3,
                5,
                Mat::Ochre,
                Ground::Home,
                Dress::Bare,
            ));
            // Between that and the corner house, facing away from the street.
            let depth = FACADE_X + 9.0;
            let x = if side * sign > 0.0 { depth } else { CROSS_HALF_X };
            let wall = if side > 0.0 { Mat::Cream } else { Mat::Brick };
            list.push(house(
                [x * side, ROW_END_Z * sign],
                Vec3::Z * sign,
                CROSS_HALF_X - depth,
                2,
                3,
                wall,
                Ground::Home,
                Dress::Bare,
            ));
        }
    }
    list
}

/// All houses.
#[must_use]
pub fn houses() -> Vec<House> {
    let mut list = west();
    list.extend(east());
    list.extend(around());
    list
}

/// Builds every house, the arcade, the room and the tower.
pub fn build(parts: &mut Parts, seed: u64) {
    for (k, h) in houses().iter().enumerate() {
        h.build(parts, &mut Rng::new(seed, 1000 + k as u32));
    }
    arcade::build(parts, &mut Rng::new(seed, 900));
    room::build(parts);
    tower(parts);
}

/// A church tower behind the roofs, so that the street has an end to look at.
fn tower(parts: &mut Parts) {
    let f = Frame::facing(vec3(TOWER[0], 0.0, TOWER[1]), Vec3::NEG_Z);
    let (w, top) = (2.9, 22.5);
    let m = parts.get(Mat::Stone);
    let round = FRONT | BACK | LEFT | RIGHT;
    m.block(&f, [-w, -0.2, -w], [w, top, w], 2.0, round);
    for y in [9.0, 15.5, 21.6] {
        m.block(&f, [-w - 0.18, y, -w - 0.18], [w + 0.18, y + 0.4, w + 0.18], 2.0, ALL);
    }
    for x in [-1.0, 1.0] {
        parts
            .get(Mat::Pane)
            .block(&f, [x - 0.45, 17.0, w], [x + 0.45, 20.2, w + 0.02], 1.0, FRONT);
        parts
            .get(Mat::White)
            .block(&f, [x - 0.6, 16.8, w], [x + 0.6, 17.0, w + 0.12], 4.0, ALL & !BACK);
    }
    parts
        .get(Mat::White)
        .block(&f, [-0.9, 12.2, w], [0.9, 14.0, w + 0.06], 4.0, ALL & !BACK);
    parts
        .get(Mat::Iron)
        .block(&f, [-0.03, 13.0, w + 0.06], [0.03, 13.75, w + 0.08], 1.0, ALL & !BACK);
    parts
        .get(Mat::Iron)
        .block(&f, [0.0, 13.07, w + 0.06], [0.45, 13.13, w + 0.08], 1.0, ALL & !BACK);
    let roof = parts.get(Mat::RoofDark);
    let e = w + 0.35;
    let apex = f.at(0.0, TOWER_TOP_Y - 1.0, 0.0);
    let corner = [(-e, e), (e, e), (e, -e), (-e, -e)].map(|(s, d)| f.at(s, top, d));
    for k in 0..4 {
        roof.tri([corner[k], corner[(k + 1) % 4], apex], 2.4);
    }
    parts.get(Mat::White).block(&f, [-e, top, -e], [e, top, e], 4.0, BOTTOM);
    parts.get(Mat::Iron).tube(
        f.at(0.0, TOWER_TOP_Y - 1.1, 0.0),
        f.at(0.0, TOWER_TOP_Y, 0.0),
        [0.06, 0.03],
        6,
        1.0,
        true,
    );
    // The nave behind it.
    parts.get(Mat::RoofDark).quad(
        [
            f.at(-9.0, 9.0, -3.0),
            f.at(9.0, 9.0, -3.0),
            f.at(9.0, 12.5, -5.9),
            f.at(-9.0, 12.5, -5.9),
        ],
        2.4,
    );
}
