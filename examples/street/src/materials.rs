//! The street's materials: one per kind of surface, shared by everything made of it.

use crate::error::StreetError;
use crate::glb::{Attributes, Glb};
use crate::mesh::Mesh;
use crate::textures::{Encoded, MapIds, encode, foliage, ground, paint, walls, windows};
use serde_json::{Value, json};

/// A kind of surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mat {
    /// The carriageway.
    Asphalt,
    /// White markings.
    RoadPaint,
    /// Granite setts: gutters, the square.
    Setts,
    /// Concrete slabs: pavements.
    Slabs,
    /// Granite kerb stones.
    Kerb,
    /// Drain grates.
    Grate,
    /// Plaster, cream.
    Cream,
    /// Plaster, ochre.
    Ochre,
    /// Plaster, grey-green.
    Sage,
    /// Plaster, rose.
    Rose,
    /// Red brick.
    Brick,
    /// Pale sandstone.
    Stone,
    /// Red roof tiles.
    Roof,
    /// Dark roof tiles.
    RoofDark,
    /// White paint: window frames, sills, room ceilings.
    White,
    /// Unlit panes.
    Pane,
    /// Lit panes.
    PaneLit,
    /// Lit shop windows.
    Shop,
    /// Varnished wood: doors, benches.
    Wood,
    /// Painted wood: shutters, shop fronts.
    Painted,
    /// Zinc: gutters, pipes, dormers.
    Zinc,
    /// Dark painted iron.
    Iron,
    /// Glowing glass of lamps.
    Glow,
    /// Clear glass of the shelter.
    Glass,
    /// Awning cloth.
    Cloth,
    /// Bark.
    Bark,
    /// Broad leaves.
    LeavesBroad,
    /// Slender leaves.
    LeavesSlender,
}

/// All materials in the order of their indices.
pub const ALL: [Mat; 28] = [
    Mat::Asphalt,
    Mat::RoadPaint,
    Mat::Setts,
    Mat::Slabs,
    Mat::Kerb,
    Mat::Grate,
    Mat::Cream,
    Mat::Ochre,
    Mat::Sage,
    Mat::Rose,
    Mat::Brick,
    Mat::Stone,
    Mat::Roof,
    Mat::RoofDark,
    Mat::White,
    Mat::Pane,
    Mat::PaneLit,
    Mat::Shop,
    Mat::Wood,
    Mat::Painted,
    Mat::Zinc,
    Mat::Iron,
    Mat::Glow,
    Mat::Glass,
    Mat::Cloth,
    Mat::Bark,
    Mat::LeavesBroad,
    Mat::LeavesSlender,
];

impl Mat {
    /// How meshes of this material are written.
    #[must_use]
    pub fn attributes(self) -> Attributes {
        let flat = matches!(
            self,
            Self::White
                | Self::Pane
                | Self::PaneLit
                | Self::Shop
                | Self::Zinc
                | Self::Iron
                | Self::Glow
                | Self::Glass
                | Self::Cloth
                | Self::LeavesBroad
                | Self::LeavesSlender
        );
        let detail_m = (self == Self::Asphalt).then_some(ground::ASPHALT_DETAIL_M);
        Attributes {
            tangents: !flat,
            detail_m,
        }
    }
}

/// One mesh per material.
#[derive(Debug)]
pub struct Parts {
    meshes: Vec<Mesh>,
}

impl Default for Parts {
    fn default() -> Self {
        Self {
            meshes: vec![Mesh::default(); ALL.len()],
        }
    }
}

impl Parts {
    /// The mesh of a material.
    pub fn get(&mut self, mat: Mat) -> &mut Mesh {
        &mut self.meshes[mat as usize]
    }

    /// Materials in use and their meshes.
    pub fn used(&self) -> impl Iterator<Item = (Mat, &Mesh)> {
        ALL.into_iter()
            .map(|m| (m, &self.meshes[m as usize]))
            .filter(|(_, mesh)| !mesh.indices.is_empty())
    }

    /// All of it as one mesh of a glTF, a primitive per material.
    pub fn add_to(&self, glb: &mut Glb, name: &str) -> Option<usize> {
        let list: Vec<(&Mesh, usize, Attributes)> = self
            .used()
            .map(|(m, mesh)| (mesh, m as usize, m.attributes()))
            .collect();
        glb.add_mesh(name, &list)
    }
}

/// All texture sets of the street, in the order in which [`install`] expects them.
///
/// # Errors
/// [`StreetError::Encode`] when a picture cannot be encoded.
pub fn textures(seed: u64) -> Result<Vec<Encoded>, StreetError> {
    let s = seed as u32 ^ (seed >> 32) as u32;
    type Job = Box<dyn Fn() -> Result<Encoded, StreetError> + Send + Sync>;
    let jobs: Vec<Job> = vec![
        Box::new(move || {
            let mut maps = vec![ground::asphalt_colour(s)];
            maps.extend(ground::asphalt_relief(s));
            encode(&maps)
        }),
        Box::new(move || encode(&ground::road_paint(s))),
        Box::new(move || encode(&ground::setts(s))),
        Box::new(move || encode(&ground::slabs(s))),
        Box::new(move || encode(&ground::kerb(s))),
        Box::new(move || encode(&ground::grate(s))),
        Box::new(move || encode(&walls::plaster(s))),
        Box::new(move || encode(&walls::brick(s))),
        Box::new(move || encode(&walls::stone(s))),
        Box::new(move || encode(&walls::roof(s))),
        Box::new(move || encode(&walls::wood(s))),
        Box::new(move || encode(&paint::zinc(s))),
        Box::new(move || encode(&[paint::awning(s)])),
        Box::new(move || encode(&foliage::bark(s))),
        Box::new(move || encode(&[foliage::spray(seed, foliage::Leaf::Broad)])),
        Box::new(move || encode(&[foliage::spray(seed, foliage::Leaf::Slender)])),
        Box::new(move || encode(&windows::windows(s))),
        Box::new(move || encode(&[windows::shops(seed)])),
    ];
    // Which thread makes a texture has no influence on it: each is a function of the seed alone.
    let next = std::sync::atomic::AtomicUsize::new(0);
    let slots: Vec<std::sync::OnceLock<Result<Encoded, StreetError>>> =
        jobs.iter().map(|_| std::sync::OnceLock::new()).collect();
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get().min(8));
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let k = next.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
                    let Some(job) = jobs.get(k) else { break };
                    slots[k].get_or_init(job);
                }
            });
        }
    });
    slots.into_iter().filter_map(std::sync::OnceLock::into_inner).collect()
}

/// A textured surface with relief.
pub(crate) fn surface(name: &str, factor: [f32; 3], m: MapIds) -> Value {
    json!({
        "name": name,
        "pbrMetallicRoughness": {
            "baseColorFactor": [factor[0], factor[1], factor[2], 1.0],
            "baseColorTexture": { "index": m.base },
            "metallicRoughnessTexture": { "index": m.orm },
        },
        "normalTexture": { "index": m.normal },
        "occlusionTexture": { "index": m.orm },
    })
}

/// The carriageway: its colour over its own width, relief and roughness over a small tile in the second coordinates.
pub(crate) fn asphalt(maps: MapIds) -> Value {
    let mut m = surface("asphalt", [1.0; 3], maps);
    m["normalTexture"]["texCoord"] = json!(1);
    m["occlusionTexture"]["texCoord"] = json!(1);
    m["pbrMetallicRoughness"]["metallicRoughnessTexture"]["texCoord"] = json!(1);
    m
}

fn plain(name: &str, color: [f32; 3], roughness: f32, metallic: f32) -> Value {
    json!({
        "name": name,
        "pbrMetallicRoughness": {
            "baseColorFactor": [color[0], color[1], color[2], 1.0],
            "roughnessFactor": roughness,
            "metallicFactor": metallic,
        },
    })
}

/// A colour that glows: `strength` times the emissive texture, on the scale where 1 is white on screen.
fn glowing(mut m: Value, light: Option<usize>, factor: [f32; 3], strength: f32) -> Value {
    m["emissiveFactor"] = json!(factor);
    if let Some(t) = light {
        m["emissiveTexture"] = json!({ "index": t });
    }
    m["extensions"] = json!({ "KHR_materials_emissive_strength": { "emissiveStrength": strength } });
    m
}

/// Dark painted iron.
pub(crate) fn iron() -> Value {
    plain("iron", [0.022, 0.024, 0.026], 0.5, 0.0)
}

/// Glowing glass of lamps.
pub(crate) fn lamp_glass() -> Value {
    glowing(
        plain("lamp-glass", [0.9, 0.85, 0.75], 0.4, 0.0),
        None,
        [1.0, 0.72, 0.42],
        9.0,
    )
}

fn textured(name: &str, texture: usize, roughness: f32) -> Value {
    json!({
        "name": name,
        "pbrMetallicRoughness": {
            "baseColorTexture": { "index": texture },
            "roughnessFactor": roughness,
            "metallicFactor": 0.0,
        },
    })
}

/// Leaves cut out by the alpha of a texture.
pub(crate) fn leaves(name: &str, texture: usize) -> Value {
    let mut m = textured(name, texture, 0.85);
    m["alphaMode"] = json!("MASK");
    m["alphaCutoff"] = json!(0.4);
    m["doubleSided"] = json!(true);
    m
}

/// Adds textures and materials; material indices are those of [`Mat`].
pub fn install(glb: &mut Glb, sets: &[Encoded]) {
    let t: Vec<MapIds> = sets.iter().map(|s| s.install(glb)).collect();
    let [
        asphalt,
        road_paint,
        setts,
        slabs,
        kerb,
        grate,
        plaster,
        brick,
        stone,
        roof,
        wood,
        zinc,
        awning,
        bark,
        broad,
        slender,
        window,
        shop,
    ] = std::array::from_fn(|k| t.get(k).copied().unwrap_or_default());
    let white = [1.0; 3];
    for mat in ALL {
        let m = match mat {
            Mat::Asphalt => self::asphalt(asphalt),
            Mat::RoadPaint => surface("road-paint", white, road_paint),
            Mat::Setts => surface("setts", white, setts),
            Mat::Slabs => surface("slabs", white, slabs),
            Mat::Kerb => surface("kerb", white, kerb),
            Mat::Grate => surface("grate", white, grate),
            Mat::Cream => surface("plaster-cream", [0.88, 0.8, 0.66], plaster),
            Mat::Ochre => surface("plaster-ochre", [0.74, 0.56, 0.35], plaster),
            Mat::Sage => surface("plaster-sage", [0.52, 0.56, 0.5], plaster),
            Mat::Rose => surface("plaster-rose", [0.7, 0.52, 0.43], plaster),
            Mat::Brick => surface("brick", white, brick),
            Mat::Stone => surface("sandstone", white, stone),
            Mat::Roof => surface("roof-tiles", white, roof),
            Mat::RoofDark => surface("roof-tiles-dark", [0.45, 0.62, 0.8], roof),
            Mat::White => plain("white-paint", [0.62, 0.61, 0.57], 0.6, 0.0),
            Mat::Pane => textured("window-dark", window.base, 0.07),
            Mat::PaneLit => glowing(
                textured("window-lit", window.base, 0.07),
                Some(window.normal),
                white,
                2.0,
            ),
            Mat::Shop => {
                let m = plain("shop-window", [0.02, 0.02, 0.02], 0.07, 0.0);
                glowing(m, Some(shop.base), white, 1.8)
            }
            Mat::Wood => surface("wood", [0.27, 0.13, 0.06], wood),
            Mat::Painted => surface("painted-wood", [0.05, 0.13, 0.11], wood),
            Mat::Zinc => json!({
                "name": "zinc",
                "doubleSided": true,
                "pbrMetallicRoughness": {
                    "baseColorTexture": { "index": zinc.base },
                    "metallicRoughnessTexture": { "index": zinc.normal },
                },
            }),
            Mat::Iron => iron(),
            Mat::Glow => lamp_glass(),
            Mat::Glass => {
                let mut m = plain("clear-glass", [0.55, 0.6, 0.6], 0.06, 0.0);
                m["pbrMetallicRoughness"]["baseColorFactor"][3] = json!(0.16);
                m["alphaMode"] = json!("BLEND");
                m["doubleSided"] = json!(true);
                m
            }
            Mat::Cloth => textured("awning-cloth", awning.base, 0.92),
            Mat::Bark => surface("bark", white, bark),
            Mat::LeavesBroad => leaves("leaves-broad", broad.base),
            Mat::LeavesSlender => leaves("leaves-slender", slender.base),
        };
        glb.add_material(m);
    }
}
