//! A hatchback: origin on the ground under its middle, facing +Z, wheels as nodes of their own.

pub mod body;
pub mod cabin;
pub mod shell;
pub mod wheel;

use crate::error::StreetError;
use crate::glb::{Attributes, Glb};
use crate::mesh::{Mesh, cos_sin};
use glam::Vec3;
use serde_json::{Value, json};

/// Distance of the front axle before the origin, metres.
pub const FRONT_AXLE_Z: f32 = 1.27;
/// Distance of the rear axle from the origin along z, metres.
pub const REAR_AXLE_Z: f32 = -1.24;
/// Distance of the wheels' middles from the car's middle plane, metres: the street's ruts are as far apart.
pub const HALF_TRACK: f32 = 0.75;
/// Radius of the wheels, metres.
pub const WHEEL_RADIUS: f32 = 0.305;
/// Width of the tyres, metres.
pub const TYRE_WIDTH: f32 = 0.185;
/// Height of the flat underside, metres.
pub const UNDERSIDE_Y: f32 = 0.19;
/// Where the left headlight's spot is; the right one is mirrored in x.
pub const HEADLIGHT: [f32; 3] = [0.6, 0.62, 2.02];
/// How far the headlights point below the horizontal, radians.
pub const HEADLIGHT_DOWN: f32 = 0.035;
/// Names of the wheels' nodes with their middles: x and z.
pub const WHEELS: [(&str, f32, f32); 4] = [
    ("wheel-front-left", HALF_TRACK, FRONT_AXLE_Z),
    ("wheel-front-right", -HALF_TRACK, FRONT_AXLE_Z),
    ("wheel-rear-left", HALF_TRACK, REAR_AXLE_Z),
    ("wheel-rear-right", -HALF_TRACK, REAR_AXLE_Z),
];

/// Materials of the car.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CarMat {
    /// Body paint.
    Paint,
    /// Dark panes.
    Glass,
    /// Bumpers, sills, underside, grille.
    Plastic,
    /// Tyres.
    Rubber,
    /// Rims.
    Alloy,
    /// Headlamps, lit.
    Headlamp,
    /// Tail lamps, lit.
    Taillamp,
    /// Number plates, indicators.
    Plate,
}

const ALL: [CarMat; 8] = [
    CarMat::Paint,
    CarMat::Glass,
    CarMat::Plastic,
    CarMat::Rubber,
    CarMat::Alloy,
    CarMat::Headlamp,
    CarMat::Taillamp,
    CarMat::Plate,
];

/// One mesh per material of the car.
#[derive(Debug)]
pub struct CarParts {
    meshes: Vec<Mesh>,
}

impl Default for CarParts {
    fn default() -> Self {
        Self {
            meshes: vec![Mesh::default(); ALL.len()],
        }
    }
}

impl CarParts {
    /// The mesh of a material.
    pub fn get(&mut self, mat: CarMat) -> &mut Mesh {
        &mut self.meshes[mat as usize]
    }

    fn add_to(&self, glb: &mut Glb, name: &str) -> Option<usize> {
        let plain = Attributes {
            tangents: false,
            detail_m: None,
        };
        let list: Vec<(&Mesh, usize, Attributes)> =
            self.meshes.iter().enumerate().map(|(k, m)| (m, k, plain)).collect();
        glb.add_mesh(name, &list)
    }
}

fn material(mat: CarMat) -> Value {
    let (name, color, rough, metal, glow) = match mat {
        CarMat::Paint => ("car-paint", [0.16, 0.012, 0.014], 0.28, 0.0, None),
        CarMat::Glass => ("car-glass", [0.012, 0.014, 0.016], 0.04, 0.0, None),
        CarMat::Plastic => ("car-plastic", [0.018, 0.018, 0.019], 0.65, 0.0, None),
        CarMat::Rubber => ("car-rubber", [0.022, 0.022, 0.022], 0.9, 0.0, None),
        CarMat::Alloy => ("car-alloy", [0.5, 0.51, 0.53], 0.32, 1.0, None),
        CarMat::Headlamp => (
            "car-headlamp",
            [0.8, 0.8, 0.8],
            0.08,
            0.0,
            Some(([1.0, 0.9, 0.72], 8.0)),
        ),
        CarMat::Taillamp => (
            "car-taillamp",
            [0.3, 0.01, 0.01],
            0.12,
            0.0,
            Some(([1.0, 0.035, 0.02], 4.0)),
        ),
        CarMat::Plate => ("car-plate", [0.62, 0.62, 0.58], 0.4, 0.0, None),
    };
    let mut m = json!({
        "name": name,
        "pbrMetallicRoughness": {
            "baseColorFactor": [color[0], color[1], color[2], 1.0],
            "roughnessFactor": rough,
            "metallicFactor": metal,
        },
    });
    if let Some((factor, strength)) = glow {
        m["emissiveFactor"] = json!(factor);
        m["extensions"] = json!({ "KHR_materials_emissive_strength": { "emissiveStrength": strength } });
    }
    m
}

/// The car as the bytes of a `.glb` file.
///
/// # Errors
/// [`StreetError::Document`] when it cannot be written as JSON.
pub fn glb() -> Result<Vec<u8>, StreetError> {
    let mut glb = Glb::default();
    for mat in ALL {
        glb.add_material(material(mat));
    }
    let mut parts = CarParts::default();
    body::build(&mut parts);
    cabin::build(&mut parts);
    let mut children = Vec::new();
    if let Some(mesh) = parts.add_to(&mut glb, "body") {
        children.push(glb.add_child(json!({ "name": "body", "mesh": mesh })));
    }
    let mut wheels = Vec::new();
    for (name, side) in [("wheel-left", 1.0_f32), ("wheel-right", -1.0)] {
        let mut parts = CarParts::default();
        wheel::build(&mut parts, side);
        wheels.push(parts.add_to(&mut glb, name));
    }
    for (name, x, z) in WHEELS {
        let mesh = wheels[usize::from(x < 0.0)];
        children.push(glb.add_child(json!({ "name": name, "mesh": mesh, "translation": [x, WHEEL_RADIUS, z] })));
    }
    // Low beams: a wide cone of about 9,000 cd, as bright as the lamps of an ordinary car in its middle.
    let light = glb.add_light(json!({
        "name": "headlight", "type": "spot", "color": [1.0, 0.86, 0.68], "intensity": 9000.0, "range": 45.0,
        "spot": { "innerConeAngle": 0.12, "outerConeAngle": 0.42 },
    }));
    let (c, s) = cos_sin(0.5 * HEADLIGHT_DOWN);
    let [x, y, z] = HEADLIGHT;
    for (name, x) in [("headlight-left", x), ("headlight-right", -x)] {
        // A glTF spot shines along −Z: half a turn about Y, then down.
        children.push(glb.add_child(json!({
            "name": name, "translation": [x, y, z + 0.08], "rotation": [0.0, c, s, 0.0],
            "extensions": { "KHR_lights_punctual": { "light": light } },
        })));
    }
    glb.add_root(json!({ "name": "car", "children": children }));
    glb.finish(
        "car",
        json!({ "length_m": 2.0 * body::HALF_LENGTH, "facing": Vec3::Z.to_array() }),
    )
}
