//! Single drops, cards and haze take out of the light what the rain does: lines of sight are cast through all of them.

use glam::{DVec3, Vec3};
use rain_core::hash::{pcg3d, unit_f32};
use rain_core::haze::near_weight;
use rain_core::rainfall::{
    Card, Container, Distribution, DrawRange, FieldMotion, LatticeLevel, LatticeSettings, LatticeSharing, SizeClass,
    StreakTextureSettings, StreakTextures, cell_key, drop_marks, pitch_weight, streak_opacity,
};

use super::{Case, EXPOSURE_S, centre, frustum, spectrum};

/// Lines of sight inside a cone of tangent 0.45 about an axis.
fn rays(axis: Vec3, count: u32, seed: u32) -> Vec<Vec3> {
    let (right, up) = axis.any_orthonormal_pair();
    (0..count)
        .map(|i| {
            let [a, b, _] = pcg3d([i, seed, 77]).map(|h| unit_f32(h) * 0.9 - 0.45);
            (axis + right * a + up * b).normalize()
        })
        .collect()
}

/// What cards let through on a line of sight.
fn through_cards(cards: &[Card], set: &StreakTextures, ray: Vec3) -> f64 {
    cards
        .iter()
        .filter_map(|card| Some(1.0 - f64::from(card.opacity(&card.meet(ray)?, set, 0))))
        .product()
}

/// A drop that is drawn singly: head, way during the exposure, diameter (m), weight.
#[derive(Debug, Clone, Copy)]
struct Single {
    head: Vec3,
    way: Vec3,
    diameter: f64,
    weight: f64,
}

fn singles(case: &Case, seed: u64) -> Vec<Single> {
    let mut container = Container::default();
    let s = spectrum(case.intensity);
    assert!(container.fill(seed, &s, &case.motion, &case.volume, case.kappa, 1 << 22));
    let range = DrawRange {
        kappa: case.kappa,
        focal_px: case.volume.focal_px,
        exposure_s: EXPOSURE_S,
    };
    let bias = glam::IVec3::splat(512);
    container
        .records
        .iter()
        .map(|record| {
            let k = (record.drop & 15) as usize;
            let placement = &container.classes[k];
            let unpack = |shift: u32| (record.cell >> shift & 1023) as i32;
            let cell = glam::IVec3::new(unpack(0), unpack(10), unpack(20)) - bias;
            let key = cell_key(seed, k as u32, placement.eye.cell.wrapping_add(cell));
            let marks = drop_marks(key, record.drop >> 4 & 0xFFF);
            let diameter_mm = f64::from(SizeClass::new(k).diameter_mm(unit_f32(marks[1])));
            let head = record.position(seed, &container.classes);
            let presence = f64::from(record.drop >> 16) / 65_535.0;
            Single {
                head,
                way: placement.velocity_m_s * EXPOSURE_S as f32,
                diameter: diameter_mm * 1e-3,
                weight: presence * near_weight(f64::from(head.length()), range.at(diameter_mm)),
            }
        })
        .collect()
}

/// Tangents to the right and up of an axis, ±0.5 in this many bins each way.
const BINS: i32 = 40;

/// Single drops by where they are seen.
struct Sky {
    axis: Vec3,
    right: Vec3,
    up: Vec3,
    bins: Vec<Vec<Single>>,
}

impl Sky {
    fn new(axis: Vec3, singles: Vec<Single>) -> Self {
        let (right, up) = axis.any_orthonormal_pair();
        let bins = (0..BINS * BINS).map(|_| Vec::new()).collect();
        let mut sky = Self { axis, right, up, bins };
        for s in singles {
            // A drop beside the eye is seen everywhere, or nowhere.
            let ends = [s.head, s.head - s.way].map(|p| sky.bin(p).unwrap_or([-1, -1]));
            let spread = (s.diameter as f32 / s.head.dot(axis).max(0.05) * BINS as f32) as i32 + 1;
            let everywhere = ends.contains(&[-1, -1]);
            let span = |k: usize| {
                let (a, b) = (ends[0][k].min(ends[1][k]) - spread, ends[0][k].max(ends[1][k]) + spread);
                if everywhere {
                    0..=BINS - 1
                } else {
                    a.max(0)..=b.min(BINS - 1)
                }
            };
            for y in span(1) {
                for x in span(0) {
                    sky.bins[(y * BINS + x) as usize].push(s);
                }
            }
        }
        sky
    }

    fn bin(&self, p: Vec3) -> Option<[i32; 2]> {
        let depth = p.dot(self.axis);
        (depth > 0.05)
            .then(|| [self.right, self.up].map(|side| ((p.dot(side) / depth + 0.5) * BINS as f32).floor() as i32))
    }
}

/// What single drops let through on a line of sight.
fn through_singles(sky: &Sky, ray: Vec3) -> f64 {
    let [x, y] = sky.bin(ray).expect("ahead");
    let mut through = 1.0;
    for s in &sky.bins[(y * BINS + x) as usize] {
        if s.head.dot(ray) < 0.0 {
            continue;
        }
        // In the plane across the ray: where the streak begins, and its way.
        let flat = |v: Vec3| v - ray * v.dot(ray);
        let way = flat(s.way);
        let from_start = flat(s.way - s.head);
        let along = from_start.dot(way) / way.length();
        let across = (from_start.length_squared() - along * along).max(0.0).sqrt();
        let alpha = streak_opacity(f64::from(across), f64::from(along), s.diameter, f64::from(way.length()));
        through *= 1.0 - s.weight * alpha;
    }
    through
}

/// Mean of what is let through over rays and moments.
fn mean_through(case: &Case, set: &StreakTextures, axis: Vec3, moments: u32, near: bool) -> [f64; 2] {
    const RAYS: u32 = 3000;
    let plan = case.plan();
    let mut sums = [0.0; 2];
    for moment in 0..moments {
        let case = Case {
            motion: case.motion.after(3.7 * f64::from(moment)),
            ..case.clone()
        };
        let cards = case.cards_with(&plan, None).0;
        let singles = Sky::new(
            axis,
            if near {
                singles(&case, 40 + u64::from(moment))
            } else {
                Vec::new()
            },
        );
        for ray in rays(axis, RAYS, moment) {
            let mid = through_cards(&cards, set, ray);
            sums[0] += mid;
            sums[1] += mid * through_singles(&singles, ray);
        }
    }
    sums.map(|sum| sum / f64::from(RAYS * moments))
}

/// Mean over the rays of an account's prediction.
fn predicted(axis: Vec3, depth: impl Fn(f64) -> f64) -> f64 {
    let all = rays(axis, 3000, 0);
    let sum: f64 = all
        .iter()
        .map(|ray| (-depth(f64::from((1.0 - ray.y * ray.y).sqrt()))).exp())
        .sum();
    sum / all.len() as f64
}

fn sharing(case: &Case) -> LatticeSharing {
    let range = DrawRange {
        kappa: case.kappa,
        focal_px: case.volume.focal_px,
        exposure_s: EXPOSURE_S,
    };
    LatticeSharing::new(&case.plan(), &spectrum(case.intensity), &range, 1.0).expect("an account")
}

#[test]
fn coverage_along_rays_is_that_of_the_rain_across_single_drops_cards_and_haze() {
    let axis = Vec3::new(0.3, 0.1, -1.0).normalize();
    let base = Case::default();
    let set = StreakTextures::bake(&base.textures).expect("a set");
    for (intensity, kappa) in [(5.0, 2.0), (25.0, 1.1), (100.0, 0.62)] {
        let case = Case {
            intensity,
            kappa,
            ..base.clone()
        };
        let account = sharing(&case);
        // All drops of 0.5 to 6 mm and a way past every hand-over.
        let way = 40.0;
        let [mid, drawn] = mean_through(&case, &set, axis, 16, true);
        let near = 1.0 - drawn / mid;
        let expected_mid = 1.0 - predicted(axis, |c| account.card_depth(way, c));
        let expected_near = 1.0 - (-account.near_depth(way)).exp();
        let place = format!("{intensity} mm/h");
        assert!(
            expected_mid > 0.5 * expected_near && expected_near > 1e-3,
            "{expected_near} {expected_mid}"
        );
        // Each tier by itself, and all of them with the haze that the account leaves (Q = 1: cross-sections).
        let errors = [
            (1.0 - mid) / expected_mid - 1.0,
            near / expected_near - 1.0,
            (1.0 - drawn * predicted(axis, |c| account.fog_depth(way, c))) / (1.0 - (-account.total_depth(way)).exp())
                - 1.0,
        ];
        for (error, tier) in errors.iter().zip(["cards", "single drops", "together"]) {
            assert!(error.abs() < 0.05, "{place}, {tier}: off by {error:.4}");
        }
        // Without the hand-over (cards from the eye on) the same sum would be off.
        let twice = drawn * (-account.near_depth(way)).exp();
        let wrong =
            (1.0 - twice * predicted(axis, |c| account.fog_depth(way, c))) / (1.0 - (-account.total_depth(way)).exp());
        assert!(wrong > 1.05, "{place}: {wrong}");
    }
}

#[test]
fn cards_of_every_lattice_take_out_their_share_in_every_direction() {
    let level = |cell_m, to_m| LatticeLevel { cell_m, to_m };
    let lattices = [
        LatticeSettings::default(),
        LatticeSettings {
            levels: vec![level(4.0, 36.0)],
            ..LatticeSettings::default()
        },
        LatticeSettings {
            levels: vec![level(1.0, 6.0), level(2.0, 12.0), level(5.0, 30.0)],
            far_m: 50.0,
            max_cards: 1 << 18,
            ..LatticeSettings::default()
        },
        LatticeSettings {
            min_light: 0.0,
            ..LatticeSettings::yoshida()
        },
    ];
    let base = Case::default();
    let sets = [
        base.textures.clone(),
        StreakTextureSettings {
            texels: 128,
            ..StreakTextureSettings::yoshida()
        },
    ];
    let mut checked = 0;
    for (index, lattice) in lattices.into_iter().enumerate() {
        // The source's classes leave most of the rain to haze.
        let textures = sets[usize::from(index == 3)].clone();
        let set = StreakTextures::bake(&textures).expect("a set");
        for (axis, wind) in [
            (Vec3::new(0.0, 0.0, -1.0), DVec3::ZERO),
            (Vec3::new(1.0, 0.0, 1.0), DVec3::new(6.0, 0.0, 2.0)),
            (Vec3::new(0.5, 0.5, -0.6), DVec3::ZERO),
            (Vec3::new(-0.9, -0.8, 0.2), DVec3::new(0.0, 0.0, -10.0)),
        ] {
            let axis = axis.normalize();
            let mut motion = FieldMotion::default();
            motion.set_velocity(wind, 1.2041);
            motion.advance(20.0);
            let case = Case {
                lattice: lattice.clone(),
                textures: textures.clone(),
                volume: frustum(DVec3::new(-3.3, 12.7, 81.2), axis, 0.6),
                motion,
                ..base.clone()
            };
            let account = sharing(&case);
            // One picture for a cell of two or four cubes has streaks two or four times as strong, and their noise; few
            // cells of few classes are met by few streaks.
            let moments = if index == 3 { 16 } else { 12 };
            let [mid, _] = mean_through(&case, &set, axis, moments, false);
            let expected = 1.0 - predicted(axis, |c| account.card_depth(100.0, c));
            let error = (1.0 - mid) / expected - 1.0;
            assert!(expected > 3e-4, "{expected}");
            // Lines near 60° cross few cards, which all are about to end.
            let bound = match (axis.y.abs() > 0.3, index) {
                (true, _) => 0.05,
                (false, 3) => 0.025,
                (false, _) => 0.015,
            };
            assert!(error.abs() < bound, "lattice {index}, {axis}: off by {error:.4}");
            checked += 1;
        }
    }
    assert_eq!(checked, 16);
}

#[test]
fn the_account_holds_the_whole_rain_for_every_range_and_set() {
    for case in [
        Case::default(),
        Case {
            textures: StreakTextureSettings::yoshida(),
            lattice: LatticeSettings::yoshida(),
            ..Case::default()
        },
    ] {
        let mut last = f64::NAN;
        for kappa in [0.0, 0.3, 1.0, 5.0, 60.0] {
            let case = Case { kappa, ..case.clone() };
            let account = sharing(&case);
            for (way, cos_pitch) in [(1.0, 1.0), (6.0, 0.9), (14.0, 0.6), (30.0, 1.0), (300.0, 0.2)] {
                let parts =
                    account.near_depth(way) + account.card_depth(way, cos_pitch) + account.fog_depth(way, cos_pitch);
                let whole = spectrum(25.0).extinction_per_m(0.0, f64::INFINITY) * way;
                assert!((parts / whole - 1.0).abs() < 1e-12, "{kappa} {way}: {parts} of {whole}");
                // Light that haze lets through falls with distance: far rain dims what lies beyond.
                assert!(account.fog_transmittance(way + 1.0, cos_pitch) <= account.fog_transmittance(way, cos_pitch));
            }
            // More single drops are fewer cards.
            let cards = account.card_depth(20.0, 1.0);
            assert!(last.is_nan() || cards <= last, "{cards} {last}");
            last = cards;
            assert!(account.card_depth(20.0, 0.4) == 0.0);
        }
    }
    assert_eq!(pitch_weight(f64::NAN), 0.0);
    assert!(
        LatticeSharing::new(
            &Case::default().plan(),
            &spectrum(5.0),
            &DrawRange {
                kappa: 1.0,
                focal_px: 600.0,
                exposure_s: 0.01,
            },
            0.5
        )
        .is_err()
    );
}

#[test]
fn cards_fade_between_45_and_60_degrees_of_pitch() {
    let mut worst = 0.0_f64;
    for i in 0..=1000 {
        let cos_pitch = f64::from(i) / 1000.0;
        let (from, to) = (60_f64.to_radians().cos(), 45_f64.to_radians().cos());
        let t = ((cos_pitch - from) / (to - from)).clamp(0.0, 1.0);
        worst = worst.max((pitch_weight(cos_pitch) - t * t * (3.0 - 2.0 * t)).abs());
    }
    let bound = 1e-14;
    assert!(worst < bound, "{worst}");
    assert_eq!((pitch_weight(0.49), pitch_weight(0.71)), (0.0, 1.0));
}

#[test]
fn cards_are_found_where_the_account_has_them() {
    let cards = Case::default().cards();
    let nearest = cards.iter().map(|c| centre(c).length()).fold(f32::INFINITY, f32::min);
    let farthest = cards.iter().map(|c| centre(c).length()).fold(0.0, f32::max);
    assert!((2.2..4.5).contains(&nearest), "{nearest}");
    assert!((34.0..38.1).contains(&farthest), "{farthest}");
    // Small cells nearby, large ones beyond.
    assert!(
        cards
            .iter()
            .all(|c| (c.centre[3] - 1.0).abs() < 1e-6 || (c.centre[3] - 2.0).abs() < 1e-6)
    );
    assert!(cards.iter().all(|c| centre(c).length() < 19.1 || c.centre[3] > 1.5));
    assert!(cards.len() > 1500 && cards.len() < 16_000, "{}", cards.len());
    let dry = Case {
        intensity: 0.0,
        ..Case::default()
    };
    assert!(dry.cards().is_empty());
    assert_eq!(
        spectrum(0.0),
        rain_core::rainfall::Spectrum::new(Distribution::MarshallPalmer, 0.0).expect("dry")
    );
}
