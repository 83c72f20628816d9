//! Streak textures and the lattice that shows them: classes, resolution, size of cells.

use glam::{DVec3, Vec3};
use rain_bench::study::{Study, Variant};
use rain_core::hash::{pcg3d, unit_f32};
use rain_core::rainfall::{
    CLASS_EDGES_MM, Card, ClassErrors, Distribution, DrawRange, DropSizes, FieldMotion, LatticeLevel, LatticePlan,
    LatticeSettings, LatticeSharing, LatticeView, RainKind, RainViewVolume, Spectrum, StreakTexture,
    StreakTextureSettings, StreakTextures, terminal_velocity,
};

/// Every study of this file.
pub fn studies() -> Vec<Study> {
    vec![classes(), texels(), cells()]
}

/// Every `step`-th border of the drop field's classes.
fn edges(step: usize) -> Vec<f64> {
    CLASS_EDGES_MM.iter().copied().step_by(step).collect()
}

/// A set of 25 mm/h.
fn set(edges: Vec<f64>, texels: u32) -> StreakTextureSettings {
    StreakTextureSettings {
        intensities_mm_h: vec![25.0],
        diameter_edges_mm: edges,
        texels,
        ..StreakTextureSettings::default()
    }
}

fn bake(settings: StreakTextureSettings) -> impl FnMut() -> f64 {
    move || StreakTextures::bake(&settings).map_or(f64::NAN, |set| set.textures.iter().map(|t| t.mean_opacity(0)).sum())
}

fn classes() -> Study {
    let sizes = DropSizes::new(RainKind::MarshallPalmer, 25.0).expect("a rate");
    let error = |edges: &[f64]| {
        ClassErrors::of(edges, &sizes, &sizes, terminal_velocity)
            .expect("rising borders")
            .speed_rms
    };
    let variants = [
        (6, "2 classes"),
        (4, "3 classes"),
        (3, "4 classes"),
        (2, "6 classes"),
        (1, "12 classes"),
    ]
    .map(|(step, name)| {
        let edges = edges(step);
        let variant = Variant::new(name, error(&edges), 1, bake(set(edges, 256)));
        if step == 2 { variant.default() } else { variant }
    });
    Study {
        name: "streak-texture-classes",
        title: "Size classes of streak textures, 256 texels",
        norm: "rms of class speed over own speed, less 1, by cross-section",
        unit: "set of one rate",
        variants: variants.into(),
    }
}

/// Root mean square contrast of a texture about its mean.
fn contrast(texture: &StreakTexture) -> f64 {
    let texels = &texture.levels[0];
    let mean = texture.mean_opacity(0) / texture.layer.unit;
    let sum: f64 = texels.iter().map(|&t| (f64::from(t) - mean).powi(2)).sum();
    (sum / texels.len() as f64).sqrt() * texture.layer.unit
}

fn texels() -> Study {
    let baked = |texels: u32| StreakTextures::bake(&set(edges(2), texels)).expect("a set");
    // Drops of 1 mm are twice as wide as these texels.
    let finest: Vec<f64> = baked(2048).textures.iter().map(contrast).collect();
    let error = |texels: u32| {
        let set = baked(texels);
        let lost = set
            .textures
            .iter()
            .zip(&finest)
            .map(|(texture, finest)| 1.0 - contrast(texture) / finest);
        lost.fold(0.0, f64::max)
    };
    let variants = [64, 128, 256, 512, 1024]
        .map(|texels| {
            let variant = Variant::new(
                format!("{texels} texels"),
                error(texels),
                1,
                bake(set(edges(2), texels)),
            );
            if texels == 512 { variant.default() } else { variant }
        })
        .into();
    Study {
        name: "streak-texture-texels",
        title: "Resolution of streak textures of 1 m",
        norm: "contrast lost against 2048 texels, largest of six classes",
        unit: "set of one rate",
        variants,
    }
}

/// A still view of 1280 × 720 px at the height of a person's eyes, looking along −Z, 60° high; or this share of it each way.
pub(super) fn volume(share: f32) -> RainViewVolume {
    let plane = |n: Vec3| n.normalize().extend(0.0);
    let [tx, ty] = [1.03 * share, 0.58 * share];
    RainViewVolume {
        eye_m: DVec3::new(12.3, 1.7, -4.5),
        eye_velocity_m_s: DVec3::ZERO,
        side_planes: [
            plane(Vec3::new(1.0, 0.0, -tx)),
            plane(Vec3::new(-1.0, 0.0, -tx)),
            plane(Vec3::new(0.0, 1.0, -ty)),
            plane(Vec3::new(0.0, -1.0, -ty)),
        ],
        focal_px: 623.5,
        solid_angle_sr: 1.7,
        exposure_s: 1.0 / 60.0,
        turn_rad: 0.0,
        parallel: None,
    }
}

fn fill(plan: &LatticePlan, volume: &RainViewVolume, spectrum: &Spectrum, seconds: f64, cards: &mut Vec<Card>) {
    plan.fill(
        &LatticeView {
            local: None,
            volume,
            spectrum,
            motion: &FieldMotion::default().after(seconds),
            kappa: 1.1,
            lamps: &[],
            ambient: Vec3::ONE,
            seed: 1,
            haze: None,
        },
        cards,
    );
}

/// Root mean square over lines of sight of what the cards of one moment take out, over the account, less 1: pictures
/// count as their means, so that only the lattice is left.
fn unevenness(plan: &LatticePlan, spectrum: &Spectrum) -> f64 {
    const RAYS: u32 = 2000;
    let volume = volume(1.0);
    let range = DrawRange {
        kappa: 1.1,
        focal_px: volume.focal_px,
        exposure_s: volume.exposure_s,
    };
    let account = LatticeSharing::new(plan, spectrum, &range, 1.0).expect("Q is 1");
    let mut cards = Vec::new();
    fill(plan, &volume, spectrum, 17.0, &mut cards);
    let sum: f64 = (0..RAYS)
        .map(|i| {
            let [x, y, _] = pcg3d([i, 5, 6]).map(|h| unit_f32(h) - 0.5);
            let sight = Vec3::new(0.9 * x, 0.5 * y, -0.5).normalize();
            let depth: f64 = cards
                .iter()
                .filter_map(|card| {
                    let slant = f64::from(card.meet(sight)?.slant);
                    let mean = |layer: u32| plan.layers()[layer as usize].mean_opacity();
                    let picture =
                        mean(card.layers[0]) + (mean(card.layers[1]) - mean(card.layers[0])) * f64::from(card.place[2]);
                    Some(picture * f64::from(card.facing[2]) * f64::from(card.layers[2]) * slant)
                })
                .sum();
            let expected = account.card_depth(100.0, f64::from((1.0 - sight.y * sight.y).sqrt()));
            (depth / expected - 1.0).powi(2)
        })
        .sum();
    (sum / f64::from(RAYS)).sqrt()
}

fn cells() -> Study {
    let spectrum = Spectrum::new(Distribution::MarshallPalmer, 25.0).expect("a rate");
    let level = |cell_m, to_m| LatticeLevel { cell_m, to_m };
    let variants = [
        ("8 m", vec![level(8.0, 36.0)]),
        ("4 m", vec![level(4.0, 36.0)]),
        ("3 m to 12 m, 6 m", vec![level(3.0, 12.0), level(6.0, 36.0)]),
        ("2 m to 12 m, 4 m", vec![level(2.0, 12.0), level(4.0, 36.0)]),
        (
            "1 m to 6 m, 2 m to 12 m, 4 m",
            vec![level(1.0, 6.0), level(2.0, 12.0), level(4.0, 36.0)],
        ),
        ("2 m", vec![level(2.0, 36.0)]),
    ]
    .map(|(name, levels)| {
        let settings = LatticeSettings {
            max_cards: 1 << 18,
            levels,
            ..LatticeSettings::default()
        };
        let default = settings.levels == LatticeSettings::default().levels;
        let plan = LatticePlan::new(settings, &StreakTextureSettings::default()).expect("a lattice");
        let error = unevenness(&plan, &spectrum);
        let mut cards = Vec::new();
        let mut seconds = 0.0;
        let volume = volume(1.0);
        let variant = Variant::new(name, error, 1, move || {
            seconds += 0.01;
            fill(&plan, &volume, &spectrum, seconds, &mut cards);
            cards.len() as f64
        });
        if default { variant.default() } else { variant }
    });
    Study {
        name: "lattice-cells",
        title: "Cells of the lattice, to 36 m, six classes, 25 mm/h",
        norm: "rms over lines of sight of the cards' depth over the account, less 1",
        unit: "view",
        variants: variants.into(),
    }
}
