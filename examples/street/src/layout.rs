//! Where everything on the street is, in metres: Y up, the street along Z, the middle of the road at x = 0.
//!
//! Nothing here depends on the seed, which only varies tints, textures, leaves and which windows are lit.

use crate::buildings::rows;
use crate::ground;

/// Half the width of the carriageway between the kerbs' faces.
pub const ROAD_HALF_WIDTH: f32 = 3.5;
/// The street runs from −this to +this along z; beyond lie cross streets.
pub const ROAD_HALF_LENGTH: f32 = 35.0;
/// Where the gutters of setts begin, distance from the middle of the road.
pub const GUTTER_X: f32 = 3.2;
/// How much deeper than the cross fall the gutters lie.
pub const GUTTER_DEPTH: f32 = 0.015;
/// Height of the kerb above the gutter at its foot.
pub const KERB_HEIGHT: f32 = 0.12;
/// Width of the kerb stones; their faces stand at x = ±[`ROAD_HALF_WIDTH`].
pub const KERB_WIDTH: f32 = 0.15;
/// The façades stand at x = ±this; the pavements reach from the kerbs to here.
pub const FACADE_X: f32 = 6.5;
/// The rows of houses end at z = ±this.
pub const ROW_END_Z: f32 = 33.5;
/// Far kerb of the cross streets, distance from z = 0.
pub const CROSS_FAR_Z: f32 = 43.0;
/// Façades that close the view beyond the cross streets, distance from z = 0.
pub const CROSS_WALL_Z: f32 = 46.0;
/// The cross streets end at x = ±this.
pub const CROSS_HALF_X: f32 = 24.0;
/// Distance of the wheel ruts' middles from the middle of the road.
pub const RUT_X: [f32; 2] = [1.0, 2.5];
/// Depth of the ruts at their middle.
pub const RUT_DEPTH: f32 = 0.011;
/// Standard deviation of the ruts' bell-shaped cross section.
pub const RUT_HALF_WIDTH: f32 = 0.22;
/// The façade at the back of the small square stands at this x.
pub const SQUARE_X: f32 = 14.0;
/// Range of z of the small square on the east side.
pub const SQUARE_Z: [f32; 2] = [12.0, 22.0];
/// Range of z of the arcade on the east side.
pub const ARCADE_Z: [f32; 2] = [-2.0, 12.0];
/// Depth of the arcade from the façade's face to its back wall.
pub const ARCADE_DEPTH: f32 = 3.4;
/// Height of the arcade's floor.
pub const ARCADE_FLOOR_Y: f32 = 0.14;
/// Height of the arcade's ceiling.
pub const ARCADE_CEILING_Y: f32 = 3.6;
/// Thickness of the arcade's columns and arches, measured from the façade inwards.
pub const ARCADE_COLUMN: f32 = 0.5;
/// Inner size of the closed room: low corner.
pub const ROOM_MIN: [f32; 3] = [-11.6, 0.16, 11.0];
/// Inner size of the closed room: high corner.
pub const ROOM_MAX: [f32; 3] = [-7.0, 2.86, 16.5];
/// Bus shelter roof: range of x.
pub const SHELTER_X: [f32; 2] = [-6.05, -4.35];
/// Bus shelter roof: range of z.
pub const SHELTER_Z: [f32; 2] = [-12.0, -7.8];
/// Underside of the bus shelter's roof.
pub const SHELTER_Y: f32 = 2.5;
/// How far roofs overhang the façades.
pub const EAVES_OVERHANG: f32 = 0.4;
/// Where the car's origin starts: on the road, in its right-hand lane, facing +Z.
pub const CAR_START: [f32; 3] = [-1.75, -0.04, -26.0];

/// A hollow in the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hollow {
    /// Middle: x and z.
    pub centre: [f32; 2],
    /// Where the hollow ends, distance from its middle.
    pub radius: f32,
    /// Depth of the middle below the surface as it would be without the hollow; the profile is depth·(1 − r²/radius²)².
    pub depth: f32,
}

const fn hollow(x: f32, z: f32, radius: f32, depth: f32) -> Hollow {
    Hollow {
        centre: [x, z],
        radius,
        depth,
    }
}

/// The hollows: eight in the carriageway, then two in the pavements.
pub const HOLLOWS: [Hollow; 10] = [
    hollow(-2.2, -20.0, 1.0, 0.034),
    hollow(1.4, -15.5, 0.8, 0.028),
    hollow(-1.0, -8.5, 1.3, 0.04),
    hollow(2.3, -4.0, 1.5, 0.04),
    hollow(-2.4, 1.5, 1.2, 0.035),
    hollow(0.6, 6.5, 0.6, 0.018),
    hollow(1.7, 13.0, 1.4, 0.04),
    hollow(-1.4, 20.5, 1.1, 0.034),
    hollow(-5.2, 5.0, 0.9, 0.025),
    hollow(5.2, -18.0, 1.0, 0.028),
];

/// Middles of the drain grates in the gutters: x and z. Each is 0.3 m wide and 0.5 m long.
pub const DRAINS: [[f32; 2]; 8] = [
    [-3.35, -32.0],
    [3.35, -32.0],
    [-3.35, -10.0],
    [3.35, -10.0],
    [-3.35, 18.0],
    [3.35, 18.0],
    [-3.35, 31.0],
    [3.35, 31.0],
];

/// Kinds of trees.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TreeKind {
    /// A lime tree: a round, dense crown of broad leaves.
    Lime,
    /// An ash: a taller, looser crown of narrow leaflets.
    Ash,
}

/// A tree.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tree {
    /// Node in the glTF; its children end in `-wood` and `-crown`.
    pub name: &'static str,
    /// Foot of the trunk: x and z.
    pub foot: [f32; 2],
    /// Kind.
    pub kind: TreeKind,
    /// Scale of the kind's mesh: a lime's crown is 4.6 m wide at 1, an ash's 4.2 m.
    pub scale: f32,
    /// Turn about the trunk, radians.
    pub turn: f32,
}

const fn tree(name: &'static str, x: f32, z: f32, kind: TreeKind, scale: f32, turn: f32) -> Tree {
    Tree {
        name,
        foot: [x, z],
        kind,
        scale,
        turn,
    }
}

/// The trees.
pub const TREES: [Tree; 6] = [
    tree("tree-01", -4.55, -22.0, TreeKind::Lime, 0.94, 0.3),
    tree("tree-02", -4.55, 9.0, TreeKind::Lime, 0.92, 2.1),
    tree("tree-03", -4.55, 27.5, TreeKind::Ash, 0.98, 4.0),
    tree("tree-04", 4.55, -28.5, TreeKind::Ash, 0.96, 1.2),
    tree("tree-05", 4.55, -13.5, TreeKind::Lime, 0.9, 5.2),
    tree("tree-06", 10.2, 17.2, TreeKind::Lime, 1.5, 3.3),
];

impl Tree {
    /// Middle of the crown.
    #[must_use]
    pub fn crown_centre(&self) -> [f32; 3] {
        let [x, z] = self.foot;
        let y = match self.kind {
            TreeKind::Lime => 4.55,
            TreeKind::Ash => 5.3,
        };
        [x, ground::ground_height(x, z) + y * self.scale, z]
    }

    /// Half axes of the crown: across, up.
    #[must_use]
    pub fn crown_half_axes(&self) -> [f32; 2] {
        match self.kind {
            TreeKind::Lime => [2.3 * self.scale, 2.3 * self.scale],
            TreeKind::Ash => [2.1 * self.scale, 2.9 * self.scale],
        }
    }
}

/// A lamp post.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lamp {
    /// Node in the glTF; its child `…-light` carries the light.
    pub name: &'static str,
    /// Foot of the post: x and z.
    pub foot: [f32; 2],
}

/// Height of the lamps' light above the foot of their post.
pub const LAMP_LIGHT_Y: f32 = 5.02;
/// How far the lamps' light stands out from their post, towards the middle of the road.
pub const LAMP_ARM: f32 = 1.15;

/// The lamp posts.
pub const LAMPS: [Lamp; 8] = [
    Lamp {
        name: "lamp-01",
        foot: [-4.0, -29.0],
    },
    Lamp {
        name: "lamp-02",
        foot: [4.0, -22.0],
    },
    Lamp {
        name: "lamp-03",
        foot: [-4.0, -14.0],
    },
    Lamp {
        name: "lamp-04",
        foot: [4.0, -6.0],
    },
    Lamp {
        name: "lamp-05",
        foot: [-4.0, 3.0],
    },
    Lamp {
        name: "lamp-06",
        foot: [4.0, 11.0],
    },
    Lamp {
        name: "lamp-07",
        foot: [-4.0, 19.0],
    },
    Lamp {
        name: "lamp-08",
        foot: [4.0, 26.5],
    },
];

impl Lamp {
    /// Where the light is.
    #[must_use]
    pub fn head(&self) -> [f32; 3] {
        let [x, z] = self.foot;
        [x - LAMP_ARM * x.signum(), ground::ground_height(x, z) + LAMP_LIGHT_Y, z]
    }
}

/// The lower edge of a roof, from which water falls where there is no gutter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Eaves {
    /// One end.
    pub from: [f32; 3],
    /// The other end.
    pub to: [f32; 3],
}

/// An awning over a shop window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Awning {
    /// Low corner of its bounds.
    pub min: [f32; 3],
    /// High corner of its bounds.
    pub max: [f32; 3],
}

/// A place for a camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// What it is good for.
    pub name: &'static str,
    /// The eye.
    pub eye: [f32; 3],
    /// What it looks at.
    pub target: [f32; 3],
}

/// Cameras that show what the street is for.
pub const VIEWS: [View; 6] = [
    View {
        name: "street",
        eye: [0.9, 1.25, -22.5],
        target: [-0.4, 1.75, 0.0],
    },
    View {
        name: "arcade",
        eye: [8.4, 1.75, 0.2],
        target: [-2.0, 1.5, 9.0],
    },
    View {
        name: "room",
        eye: [-9.3, 1.7, 12.2],
        target: [-9.0, 1.4, 16.0],
    },
    View {
        name: "shelter",
        eye: [-5.0, 1.65, -11.2],
        target: [-1.5, 0.6, -1.0],
    },
    View {
        name: "puddle",
        eye: [0.4, 0.85, -8.5],
        target: [2.4, 0.0, -3.2],
    },
    View {
        name: "square",
        eye: [-3.0, 1.7, 9.5],
        target: [10.0, 2.8, 18.0],
    },
];

/// The whole layout, as [`layout`] returns it.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// Hollows in the ground.
    pub hollows: Vec<Hollow>,
    /// Drain grates: x, y, z of their middles.
    pub drains: Vec<[f32; 3]>,
    /// Trees.
    pub trees: Vec<Tree>,
    /// Lamp posts.
    pub lamps: Vec<Lamp>,
    /// Eaves over the street, the square and the cross streets.
    pub eaves: Vec<Eaves>,
    /// Awnings.
    pub awnings: Vec<Awning>,
    /// Cameras.
    pub views: Vec<View>,
    /// Low corner of everything in the street's file.
    pub min: [f32; 3],
    /// High corner of everything in the street's file.
    pub max: [f32; 3],
}

impl Layout {
    /// Height of the open ground (carriageway, pavement, square) at (x, z).
    #[must_use]
    pub fn ground_height(&self, x: f32, z: f32) -> f32 {
        ground::ground_height(x, z)
    }

    /// The camera of this name.
    #[must_use]
    pub fn view(&self, name: &str) -> Option<&View> {
        self.views.iter().find(|v| v.name == name)
    }
}

/// Where everything is.
#[must_use]
pub fn layout() -> Layout {
    let houses = rows::houses();
    Layout {
        hollows: HOLLOWS.to_vec(),
        drains: DRAINS
            .iter()
            .map(|&[x, z]| [x, ground::ground_height(x, z), z])
            .collect(),
        trees: TREES.to_vec(),
        lamps: LAMPS.to_vec(),
        eaves: houses.iter().map(|h| h.eaves()).collect(),
        awnings: houses.iter().flat_map(|h| h.awnings()).collect(),
        views: VIEWS.to_vec(),
        min: [-CROSS_HALF_X - 14.0, -0.3, -CROSS_WALL_Z - 14.0],
        max: [CROSS_HALF_X + 14.0, rows::TOWER_TOP_Y, CROSS_WALL_Z + 14.0],
    }
}
