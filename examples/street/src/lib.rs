//! A European street in the rain, generated: `street.glb` with its own PBR textures, and `car.glb`; a paved court,
//! `court.glb`; a country road over a plain, `plain.glb`.
//!
//! Everything comes from formulas and one seed; the same seed gives the same bytes. Where things are does not depend on
//! the seed and is documented in [`mod@layout`], so that tests can stand in the arcade, measure hollows and look up at
//! eaves.
//! Metres, Y up, the street along Z, counter-clockwise fronts, physical light units (candela).

pub mod buildings;
pub mod car;
pub mod court;
pub mod error;
pub mod furniture;
pub mod glb;
pub mod ground;
pub mod layout;
pub mod materials;
pub mod mesh;
pub mod noise;
pub mod plain;
pub mod street_lamps;
pub mod textures;
pub mod trees;

pub use error::StreetError;
pub use layout::{Layout, layout};

use buildings::{arcade, room, rows};
use glam::Vec3;
use glb::{Glb, write_atomically};
use layout::{LAMPS, SHELTER_X, SHELTER_Y, SHELTER_Z, TREES, TreeKind};
use materials::{Mat, Parts};
use serde_json::json;
use std::path::Path;

/// Name of the street's file.
pub const STREET_FILE: &str = "street.glb";
/// Name of the car's file.
pub const CAR_FILE: &str = "car.glb";
/// Name of the court's file.
pub const COURT_FILE: &str = "court.glb";
/// Name of the plain's file.
pub const PLAIN_FILE: &str = "plain.glb";
/// Name of the file with the depth of the court's paving.
pub const COURT_DEPTH_FILE: &str = "court_depth.png";
/// Seed of the street in pictures and tests.
pub const DEFAULT_SEED: u64 = 7;
/// Luminous intensity of a street lamp, candela: about 70 lx on the road below.
pub const LAMP_CD: f32 = 1700.0;
/// Warm white (about 3000 K, seen by a camera balanced for dusk), linear RGB.
const WARM: [f32; 3] = [1.0, 0.67, 0.35];

/// Writes `street.glb`, `car.glb`, `court.glb`, `court_depth.png` and `plain.glb` into `dir`, which is made when it does
/// not exist.
///
/// # Errors
/// [`StreetError::Write`] names what could not be written.
pub fn generate(dir: &Path, seed: u64) -> Result<Layout, StreetError> {
    std::fs::create_dir_all(dir).map_err(|source| StreetError::Write {
        path: dir.to_owned(),
        source,
    })?;
    write_atomically(&dir.join(STREET_FILE), &street_glb(seed)?)?;
    write_atomically(&dir.join(CAR_FILE), &car::glb()?)?;
    write_atomically(&dir.join(COURT_FILE), &court::glb(seed)?)?;
    write_atomically(&dir.join(COURT_DEPTH_FILE), &court::depth_png(seed)?)?;
    write_atomically(&dir.join(PLAIN_FILE), &plain::glb(seed)?)?;
    Ok(layout())
}

/// The street as the bytes of a `.glb` file.
///
/// # Errors
/// [`StreetError::Encode`] or [`StreetError::Document`] when a part cannot be encoded.
pub fn street_glb(seed: u64) -> Result<Vec<u8>, StreetError> {
    let mut glb = Glb::default();
    materials::install(&mut glb, &materials::textures(seed)?);
    let mut parts = Parts::default();
    ground::build(&mut parts);
    rows::build(&mut parts, seed);
    furniture::build(&mut parts);
    // One node per material: few draws, and each is named after what it is made of.
    for (mat, mesh) in parts.used() {
        let name = format!("street-{mat:?}").to_lowercase();
        let mesh = glb.add_mesh(&name, &[(mesh, mat as usize, mat.attributes())]);
        glb.add_root(json!({ "name": name, "mesh": mesh }));
    }
    add_trees(&mut glb, seed);
    add_lamps(&mut glb);
    add_shop_lights(&mut glb);
    glb.finish("street", json!({ "seed": seed }))
}

fn add_trees(glb: &mut Glb, seed: u64) {
    let kinds = [
        (TreeKind::Lime, "lime", Mat::LeavesBroad),
        (TreeKind::Ash, "ash", Mat::LeavesSlender),
    ];
    let meshes = kinds.map(|(kind, name, leaves)| {
        let (wood, crown) = trees::tree(kind, seed);
        let wood = glb.add_mesh(
            &format!("{name}-wood"),
            &[(&wood, Mat::Bark as usize, Mat::Bark.attributes())],
        );
        let crown = glb.add_mesh(
            &format!("{name}-crown"),
            &[(&crown, leaves as usize, leaves.attributes())],
        );
        (kind, wood, crown)
    });
    for t in TREES {
        for (kind, wood, crown) in &meshes {
            if *kind != t.kind {
                continue;
            }
            let children = [
                glb.add_child(json!({ "name": format!("{}-wood", t.name), "mesh": wood })),
                glb.add_child(json!({ "name": format!("{}-crown", t.name), "mesh": crown })),
            ];
            let [x, z] = t.foot;
            let (c, s) = mesh::cos_sin(0.5 * t.turn);
            glb.add_root(json!({
                "name": t.name, "translation": [x, ground::ground_height(x, z), z], "rotation": [0.0, s, 0.0, c],
                "scale": [t.scale, t.scale, t.scale], "children": children,
            }));
        }
    }
}

/// A light that shines down from `p`, as a child node.
fn light_node(glb: &mut Glb, name: &str, light: usize, p: Vec3) -> usize {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    glb.add_child(json!({
        "name": name, "translation": p.to_array(), "rotation": [-half, 0.0, 0.0, half],
        "extensions": { "KHR_lights_punctual": { "light": light } },
    }))
}

fn add_lamps(glb: &mut Glb) {
    let mut parts = Parts::default();
    street_lamps::post(&mut parts);
    let mesh = parts.add_to(glb, "lamp");
    let light = glb.add_light(json!({
        "name": "lamp", "type": "spot", "color": WARM, "intensity": LAMP_CD, "range": 28.0,
        "spot": { "innerConeAngle": 0.85, "outerConeAngle": 1.5 },
    }));
    for l in LAMPS {
        let [x, z] = l.foot;
        let y = ground::ground_height(x, z);
        let at = Vec3::new(layout::LAMP_ARM, layout::LAMP_LIGHT_Y - 0.12, 0.0);
        let child = light_node(glb, &format!("{}-light", l.name), light, at);
        // The arm reaches over the road: along +x as built, turned half round on the east side.
        let turn = if x < 0.0 {
            [0.0, 0.0, 0.0, 1.0]
        } else {
            [0.0, 1.0, 0.0, 0.0]
        };
        glb.add_root(
            json!({ "name": l.name, "mesh": mesh, "translation": [x, y, z], "rotation": turn, "children": [child] }),
        );
    }
}

/// Lights of the arcade, the shelter, the shop windows and the room; their ranges keep them where they belong.
fn add_shop_lights(glb: &mut Glb) {
    let mut add = |name: String, kind: &str, cd: f32, range: f32, p: Vec3| {
        let mut light = json!({ "name": name, "type": kind, "color": WARM, "intensity": cd, "range": range });
        if kind == "spot" {
            light["spot"] = json!({ "innerConeAngle": 0.7, "outerConeAngle": 1.2 });
        }
        let light = glb.add_light(light);
        let node = light_node(glb, &name, light, p);
        glb.add_root(json!({ "name": format!("{name}-place"), "children": [node] }));
    };
    for (k, p) in arcade::lanterns().into_iter().enumerate() {
        add(
            format!("arcade-light-{}", k + 1),
            "point",
            45.0,
            5.5,
            p - Vec3::Y * 0.25,
        );
    }
    let middle = |r: [f32; 2]| 0.5 * (r[0] + r[1]);
    let under = Vec3::new(middle(SHELTER_X), SHELTER_Y - 0.08, middle(SHELTER_Z));
    add("shelter-light".to_owned(), "spot", 90.0, 6.0, under);
    add(
        "room-light".to_owned(),
        "point",
        40.0,
        2.4,
        room::lamp() - Vec3::Y * 0.25,
    );
    let mut shops = 0;
    for h in rows::houses()
        .iter()
        .filter(|h| matches!(h.ground, buildings::Ground::Shop | buildings::Ground::ShopAwning))
    {
        let [x, z] = h.corner;
        if z.abs() > layout::ROW_END_Z || x.abs() > layout::SQUARE_X {
            continue;
        }
        shops += 1;
        let [s0, s1] = buildings::facade::shop_span(h);
        add(
            format!("shop-light-{shops}"),
            "point",
            70.0,
            6.5,
            h.frame().at(0.5 * (s0 + s1), 1.75, 0.5),
        );
    }
}
