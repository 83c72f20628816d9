//! Houses: walls with recessed openings, tiled roofs with eaves and gutters, shops, the arcade, the closed room.

pub mod arcade;
pub mod facade;
pub mod openings;
pub mod roof;
pub mod room;
pub mod rows;

use crate::layout::{Awning, EAVES_OVERHANG, Eaves};
use crate::materials::{Mat, Parts};
use crate::mesh::Frame;
use crate::noise::Rng;
use glam::{Vec3, vec3};

/// What a house has at street level.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ground {
    /// A door and windows.
    Home,
    /// A lit shop window and its door.
    Shop,
    /// A shop with an awning.
    ShopAwning,
    /// Nothing: it stands on the arcade.
    Arcade,
}

/// How a façade is dressed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dress {
    /// Sills only.
    Bare,
    /// Stone frames around the windows.
    Framed,
    /// Wooden shutters.
    Shutters,
}

/// A house in a row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct House {
    /// Left end of the façade seen from its front: x and z.
    pub corner: [f32; 2],
    /// Where the façade faces.
    pub out: Vec3,
    /// Length of the façade, metres.
    pub width: f32,
    /// From the façade to the back wall, metres.
    pub depth: f32,
    /// Storeys under the roof.
    pub storeys: u32,
    /// Height of the first storey, metres.
    pub ground_m: f32,
    /// Height of each other storey, metres.
    pub storey_m: f32,
    /// Walls.
    pub wall: Mat,
    /// Roof.
    pub roof: Mat,
    /// Columns of windows.
    pub bays: u32,
    /// Street level.
    pub ground: Ground,
    /// Windows.
    pub dress: Dress,
    /// Dormers on the street side of the roof.
    pub dormers: u32,
    /// Windows in the left and the right gable.
    pub gables: [bool; 2],
}

impl House {
    /// The façade's frame: s from its left end, y from 0, d out of the wall.
    #[must_use]
    pub fn frame(&self) -> Frame {
        Frame::facing(vec3(self.corner[0], 0.0, self.corner[1]), self.out)
    }

    /// Top of the walls, metres.
    #[must_use]
    pub fn wall_top(&self) -> f32 {
        self.ground_m + (self.storeys - 1) as f32 * self.storey_m + 0.35
    }

    /// The lower edge of the roof over the façade.
    #[must_use]
    pub fn eaves(&self) -> Eaves {
        let f = self.frame();
        let y = roof::top(self, EAVES_OVERHANG) - roof::THICKNESS;
        Eaves {
            from: f.at(0.0, y, EAVES_OVERHANG).to_array(),
            to: f.at(self.width, y, EAVES_OVERHANG).to_array(),
        }
    }

    /// Awnings over its shop windows.
    #[must_use]
    pub fn awnings(&self) -> Vec<Awning> {
        if self.ground != Ground::ShopAwning {
            return Vec::new();
        }
        let [s0, s1] = facade::shop_span(self);
        let f = self.frame();
        let a = f.at(s0 - 0.15, openings::AWNING_LOW_Y, 0.0);
        let b = f.at(s1 + 0.15, openings::AWNING_HIGH_Y, openings::AWNING_REACH);
        vec![Awning {
            min: a.min(b).to_array(),
            max: a.max(b).to_array(),
        }]
    }

    /// Builds the house.
    pub fn build(&self, parts: &mut Parts, rng: &mut Rng) {
        facade::front(self, parts, rng);
        facade::sides_and_back(self, parts, rng);
        roof::build(self, parts, rng);
    }
}

/// Size of a wall material's texture tile, metres.
#[must_use]
pub fn tile(mat: Mat) -> f32 {
    use crate::textures::walls;
    match mat {
        Mat::Brick => walls::BRICK_M,
        Mat::Stone => walls::STONE_M,
        Mat::Roof | Mat::RoofDark => walls::ROOF_M,
        Mat::Wood | Mat::Painted => walls::WOOD_M,
        Mat::Zinc | Mat::Cloth => 1.0,
        _ => walls::PLASTER_M,
    }
}
