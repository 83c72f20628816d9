//! Where cards are, how they turn, and what they show.

use glam::{DVec3, Vec2, Vec3};
use rain_core::rainfall::{
    CLASS_SPEEDS_M_S, Card, FieldMotion, LatticeLevel, LatticePlan, LatticeSettings, StreakTextureSettings,
};

use super::{Case, centre, frustum};

/// Cards of one texture class: those whose layers are its.
fn of_class(cards: &[Card], class: u32) -> Vec<Card> {
    cards
        .iter()
        .copied()
        .filter(|card| card.layers[0] % 6 == class)
        .collect()
}

/// A card's column and picture by their hash, and where its middle is in the world.
fn world(cards: &[Card], eye: DVec3) -> Vec<(u32, DVec3)> {
    cards
        .iter()
        .map(|card| (card.layers[3], centre(card).as_dvec3() + eye))
        .collect()
}

#[test]
fn cards_stand_upright_and_face_the_eye_in_order_from_far_to_near() {
    let cards = Case::default().cards();
    let level = |card: &Card| card.centre[0].hypot(card.centre[2]);
    assert!(cards.windows(2).all(|pair| level(&pair[0]) >= level(&pair[1])));
    for card in &cards {
        let normal = Vec3::new(card.facing[0], 0.0, card.facing[1]);
        assert!((normal.length() - 1.0).abs() < 1e-5);
        let towards_eye = -Vec3::new(card.centre[0], 0.0, card.centre[2]) / level(card);
        assert!(normal.dot(towards_eye) > 0.999_99);
        // Seen at its middle, in the middle of its picture.
        let hit = card.meet(centre(card).normalize()).expect("met");
        assert!((hit.distance_m - centre(card).length()).abs() < 1e-3);
        assert!((hit.place - Vec2::new(card.place[0], card.place[1])).length() < 1e-3);
        // Not beside it, not behind the eye.
        let right = Vec3::new(normal.z, 0.0, -normal.x);
        let beside = centre(card) + right * (1.01 * card.centre[3]);
        assert!(card.meet(beside.normalize()).is_none());
        assert!(card.meet(-centre(card).normalize()).is_none());
    }
}

#[test]
fn cards_sink_with_their_class_and_come_in_again_above() {
    let plan = Case::default().plan();
    let dt = 0.05;
    for class in 0..6 {
        let speed = plan.layers()[class as usize].speed_m_s;
        let at = |seconds: f64| {
            let case = Case {
                motion: FieldMotion::default().after(100.0 + seconds),
                ..Case::default()
            };
            of_class(&case.cards_with(&plan, None).0, class)
        };
        let eye = Case::default().volume.eye_m;
        let (before, after) = (world(&at(0.0), eye), world(&at(dt), eye));
        // Every card that stays in the view has sunk by its class's way, and no other way.
        let mut followed = 0;
        for (hash, place) in &before {
            let sunk = *place - DVec3::Y * (speed * dt);
            followed += usize::from(after.iter().any(|(h, p)| h == hash && (*p - sunk).length() < 2e-4));
            let wrong = *place - DVec3::Y * (1.1 * speed * dt);
            assert!(!after.iter().any(|(h, p)| h == hash && (*p - wrong).length() < 2e-3));
        }
        assert!(
            followed * 10 > before.len() * 8,
            "{class}: {followed} of {}",
            before.len()
        );
        // A column that has sunk by a whole cell looks as before: nothing ever runs out below.
        let again = at(4.0 / speed);
        let now = at(0.0);
        let near = |a: &Card, b: &Card| {
            (centre(a) - centre(b)).length() < 2e-3
                && Vec2::new(a.place[0] - b.place[0], a.place[1] - b.place[1])
                    .fract_gl()
                    .min(Vec2::ONE - Vec2::new(a.place[0] - b.place[0], a.place[1] - b.place[1]).fract_gl())
                    .max_element()
                    < 2e-3
        };
        let same = now.iter().filter(|a| again.iter().any(|b| near(a, b))).count();
        assert!(same * 10 > now.len() * 9, "{class}: {same} of {}", now.len());
    }
}

#[test]
fn time_may_run_backwards_and_leaves_no_trace() {
    let case = Case::default();
    let mut motion = case.motion;
    for step in [0.4, -1.7, 3.0, -1.7] {
        motion.advance(step);
    }
    let there_and_back = Case { motion, ..case.clone() };
    let (a, b) = (case.cards(), there_and_back.cards());
    assert_eq!(a.len(), b.len());
    // The sums of the ways differ in the last digit.
    for card in &a {
        assert!(
            b.iter()
                .any(|other| other.layers == card.layers && (centre(other) - centre(card)).length() < 1e-4)
        );
    }
    assert_eq!(case.cards(), case.cards());
}

#[test]
fn two_views_see_the_same_cells() {
    let plan = Case::default().plan();
    let one = Case::default();
    let mut other = Case::default();
    other.volume.eye_m += DVec3::new(0.7, 0.2, -0.4);
    let [a, b] = [&one, &other].map(|case| world(&case.cards_with(&plan, None).0, case.volume.eye_m));
    let shared = a
        .iter()
        .filter(|(hash, place)| b.iter().any(|(h, p)| h == hash && (*p - *place).length() < 1e-4))
        .count();
    assert!(shared * 10 > a.len() * 8, "{shared} of {}", a.len());
}

#[test]
fn a_class_moves_between_its_neighbours_of_the_drop_field() {
    let plan = Case::default().plan();
    let mut motion = FieldMotion::default();
    motion.set_velocity(DVec3::new(3.0, 0.5, -2.0), 1.2041);
    motion.advance(1000.0);
    for class in 0..6 {
        let layer = &plan.layers()[class];
        let velocity = plan.velocity_m_s(class, &motion);
        assert!(
            (velocity - DVec3::new(3.0, 0.5 - layer.speed_m_s, -2.0)).length() < 1e-3,
            "{velocity}"
        );
        let way = plan.offset_m(class, &motion);
        assert!((way - velocity * 1000.0).length() < 1e-6);
        // The default's classes are pairs, so their speed lies between both.
        let pair = [CLASS_SPEEDS_M_S[2 * class], CLASS_SPEEDS_M_S[2 * class + 1]];
        assert!(
            layer.speed_m_s > 0.98 * pair[0] && layer.speed_m_s < 1.02 * pair[1],
            "{layer:?}"
        );
    }
}

/// Direction of the streaks on a card, in its plane: across and up, for which only v changes.
fn along(card: &Card) -> Vec2 {
    let [_, va, _, vb] = card.turn;
    Vec2::new(va, vb).normalize()
}

#[test]
fn streaks_lie_along_the_motion_relative_to_the_camera() {
    // Calm air, standing: straight down, as long as in the picture.
    for card in Case::default().cards() {
        assert!((along(&card) - Vec2::NEG_Y).length() < 0.35, "{}", along(&card));
        if centre(&card).y.abs() < 0.2 {
            assert!((along(&card) - Vec2::NEG_Y).length() < 1e-3);
            // One picture of a metre to a metre, in both directions.
            assert!(
                (card.turn[0] - 1.0).abs() < 1e-5 && (card.turn[3] + 1.0).abs() < 0.02,
                "{:?}",
                card.turn
            );
        }
    }
    // Wind from the left: down and to the right, by wind over fall speed.
    let ahead = |case: Case| {
        let mut cards = case.cards();
        cards.retain(|card| centre(card).normalize().dot(Vec3::NEG_Z) > 0.995);
        assert!(cards.len() > 20);
        (case.plan(), cards)
    };
    let view = || frustum(DVec3::new(5.0, 1.7, 9.0), Vec3::NEG_Z, 0.6);
    let mut motion = FieldMotion::default();
    motion.set_velocity(DVec3::new(5.0, 0.0, 0.0), 1.2041);
    let (plan, cards) = ahead(Case {
        volume: view(),
        motion,
        ..Case::default()
    });
    for card in &cards {
        let speed = plan.layers()[(card.layers[0] % 6) as usize].speed_m_s as f32;
        let expected = Vec2::new(5.0, -speed).normalize();
        assert!((along(card) - expected).length() < 0.12, "{} {expected}", along(card));
        // Longer by the same: √(5² + v²)/v.
        let stretch = 1.0 / Vec2::new(card.turn[1], card.turn[3]).length();
        assert!((stretch * speed / 5.0_f32.hypot(speed) - 1.0).abs() < 0.1, "{stretch}");
    }
    // Driving ahead: streaks point away from where the drive leads, more the farther from it.
    let mut volume = view();
    volume.eye_velocity_m_s = DVec3::new(0.0, 0.0, -36.0);
    let cards = Case {
        volume,
        ..Case::default()
    }
    .cards();
    let mut checked = 0;
    for card in cards
        .iter()
        .filter(|card| centre(card).x.abs() > 0.3 * -centre(card).z && centre(card).y.abs() < 1.0)
    {
        // The right of a card that faces the eye is the eye's right.
        let outwards = along(card).x * centre(card).x.signum();
        assert!(outwards > 0.5, "{} at {}", along(card), centre(card));
        checked += 1;
    }
    assert!(checked > 50, "{checked}");
}

#[test]
fn pictures_follow_the_rain_rate_without_a_jump() {
    let plan = Case::default().plan();
    let mean = |intensity: f64| {
        let case = Case {
            intensity,
            ..Case::default()
        };
        let cards = case.cards_with(&plan, None).0;
        // The mean opacity that each card's pictures give.
        let sums: f64 = cards
            .iter()
            .map(|card| {
                let [a, b] = [card.layers[0], card.layers[1]].map(|l| plan.layers()[l as usize].mean_opacity());
                (a + (b - a) * f64::from(card.place[2])) * f64::from(card.facing[2]) * f64::from(card.layers[2])
            })
            .sum();
        (sums, cards)
    };
    // Just under and over every rate of the set: the same sums, and the same picture nearly alone.
    for rate in [5.0, 25.0, 100.0] {
        let ((under, below), (over, above)) = (mean(rate * 0.9999), mean(rate * 1.0001));
        assert!((under / over - 1.0).abs() < 1e-3, "{under} {over}");
        let shown = |cards: &[Card]| {
            let card = of_class(cards, 2)[0];
            card.layers[usize::from(card.place[2] > 0.5)]
        };
        assert_eq!(shown(&below), shown(&above));
    }
    // Between two rates some columns of cells show the lighter picture, some the heavier one, few both; at a slightly
    // greater rate the same and hardly more.
    let share = |intensity: f64| {
        let cards = mean(intensity).1;
        let own = of_class(&cards, 2);
        assert!(own.iter().all(|card| card.layers[1] - card.layers[0] == 6));
        let sum: f32 = own.iter().map(|card| card.place[2]).sum();
        let both = own
            .iter()
            .filter(|card| card.place[2] > 0.0 && card.place[2] < 1.0)
            .count();
        (sum / own.len() as f32, both as f32 / own.len() as f32)
    };
    let ((lower, both), (upper, _)) = (share(12.0), share(12.4));
    assert!((0.2..0.8).contains(&lower) && both < 0.3, "{lower} {both}");
    assert!(upper >= lower && upper - lower < 0.1, "{lower} {upper}");
    // Below and above all rates the nearest picture, fainter or stronger.
    let strongest = |intensity: f64| {
        let cards = of_class(&mean(intensity).1, 2);
        cards
            .into_iter()
            .max_by(|a, b| a.facing[2].total_cmp(&b.facing[2]))
            .expect("cards")
    };
    let (light, heavy) = (strongest(0.2), strongest(300.0));
    assert!(light.layers[0] / 6 == 0 && light.place[2] == 0.0 && light.facing[2] < 0.5);
    assert!(heavy.layers[1] / 6 == 3 && heavy.place[2] == 1.0 && heavy.facing[2] > 1.5);
}

#[test]
fn too_many_cards_lose_the_farthest() {
    let all = Case::default().cards();
    let limited = Case {
        lattice: LatticeSettings {
            max_cards: 500,
            ..LatticeSettings::default()
        },
        ..Case::default()
    };
    let (cards, counts) = limited.cards_with(&limited.plan(), None);
    assert_eq!(cards.len(), 500);
    assert_eq!(counts.beyond_limit as usize, all.len() - 500);
    assert_eq!(cards, all[all.len() - 500..]);
    assert!(counts.cells as usize >= all.len());
}

#[test]
fn odd_lattices_are_refused_by_name() {
    let level = |cell_m, to_m| LatticeLevel { cell_m, to_m };
    let base = LatticeSettings::default;
    for (settings, start) in [
        (
            LatticeSettings {
                levels: vec![],
                ..base()
            },
            "levels is empty",
        ),
        (
            LatticeSettings {
                levels: vec![level(0.1, 5.0)],
                ..base()
            },
            "levels.cell_m is 0.1, allowed: 0.5 to 8 m",
        ),
        (
            LatticeSettings {
                levels: vec![level(2.0, f64::NAN)],
                ..base()
            },
            "levels.to_m is NaN",
        ),
        (
            LatticeSettings {
                levels: vec![level(2.0, 9.0), level(2.0, 12.0)],
                ..base()
            },
            "levels.cell_m: entry 1 (2) does not come after",
        ),
        (
            LatticeSettings {
                levels: vec![level(2.0, 9.0), level(4.0, 8.0)],
                ..base()
            },
            "levels.to_m: entry 1 (8) does not come after",
        ),
        (
            LatticeSettings {
                levels: vec![level(1.0, 1.0); 5],
                ..base()
            },
            "levels is 5, allowed: 1 to 4 levels",
        ),
        (
            LatticeSettings { far_m: 1.0, ..base() },
            "far_m is 1, allowed: 5 to 100 m",
        ),
        (
            LatticeSettings {
                min_light: -0.1,
                ..base()
            },
            "min_light is -0.1",
        ),
        (
            LatticeSettings {
                max_cards: 1 << 20,
                ..base()
            },
            "max_cards is 1048576",
        ),
    ] {
        let error = LatticePlan::new(settings, &StreakTextureSettings::default()).expect_err("refused");
        assert!(error.to_string().starts_with(start), "{error}");
    }
    assert!(
        LatticePlan::new(
            base(),
            &StreakTextureSettings {
                texels: 3,
                ..Default::default()
            }
        )
        .is_err()
    );
}
