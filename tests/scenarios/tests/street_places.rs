//! The generated street: arcade, bus shelter, closed room, driving car.

use rain_plugins::report::PassName;
use rain_plugins::scenario::Session;
use rain_plugins::scenario::file::{Attached, PathKey, ScenePart, Vehicle};
use street::layout::{ARCADE_CEILING_Y, ARCADE_DEPTH, ARCADE_Z, CAR_START, FACADE_X, SHELTER_X, SHELTER_Y, SHELTER_Z};
use test_support::shots::{Pixel, Plan, View, mean, raining, steady};
use test_support::{assets, gpu, world};

use crate::border::{COVER_TEXEL_M, MEDIAN_INVERSE_SPEED_25_MM_H, crossings, profile};

/// The street, seen from `views`.
fn plan(wind_m_s: [f64; 3], start_s: f64, views: &[View]) -> Plan {
    let mut plan = Plan::new(steady(25.0, wind_m_s), start_s, views);
    plan.scenario.scene = vec![ScenePart::from_file(street::STREET_FILE)];
    plan
}

fn session(plan: &Plan) -> Session {
    plan.session(assets::street_folder().0, |_| {})
}

/// Wet where the rain reaches at the moment, without the ground's memory.
fn session_of_the_moment(plan: &Plan) -> Session {
    plan.session(assets::street_folder().0, world::without_ground)
}

fn recorded(session: &Session) -> u64 {
    session
        .passes()
        .passes
        .get(&PassName::Rainfall)
        .map_or(0, |p| p.recorded)
}

/// From an eye in the arcade, every line of sight to such a surface stays in it. Arches and their rings stand at its
/// street side.
fn in_the_arcade(p: bevy::math::DVec3) -> bool {
    p.x > f64::from(FACADE_X) + 0.15
        && p.x < f64::from(FACADE_X + ARCADE_DEPTH) + 0.5
        && p.y < f64::from(ARCADE_CEILING_Y) + 0.02
        && p.z > f64::from(ARCADE_Z[0]) - 0.05
        && p.z < f64::from(ARCADE_Z[1]) + 0.05
}

#[test]
fn wind_drives_no_rain_through_the_walls_above_the_arcade() {
    if !gpu::available() {
        return;
    }
    // 2.4 m behind the façade: what blows in under the arches, 3.6 m high, stays in front of the eye.
    let eye = [f64::from(FACADE_X) + 2.4, 1.7, 5.25];
    let views = [
        View::new(eye, [eye[0] + 2.0, 1.5, 5.25]),
        View::new(eye, [-6.0, 1.5, 5.25]),
    ];
    let plan = plan([0.8, 0.0, 1.6], 60.0, &views);
    let mut session = session(&plan);
    let wall = plan.shot(&mut session, 0).where_surface(in_the_arcade);
    assert!(wall.len() > 8000, "{} pixels", wall.len());
    assert_eq!(raining(&wall), 0, "of {} pixels", wall.len());
    let street = plan
        .shot(&mut session, 1)
        .where_surface(|p| p.x < f64::from(FACADE_X) - 1.0);
    assert!(raining(&street) * 20 > street.len() && street.len() > 1000);
}

#[test]
fn no_streak_in_the_arcade_streaks_over_the_street_and_no_pass_in_the_closed_room() {
    if !gpu::available() {
        return;
    }
    let eye = [7.6, 1.7, 5.25];
    let room = assets::street_folder().1.view("room").expect("a camera in the room");
    let views = [
        View::new(eye, [11.0, 1.5, 5.25]),
        View::new(eye, [8.0, 1.5, 12.0]).fov(40.0),
        View::new(eye, [-6.0, 1.5, 5.25]),
        View::new(room.eye.map(f64::from), room.target.map(f64::from)),
    ];
    let plan = plan([0.0; 3], 60.0, &views);
    let mut session = session(&plan);
    let inside = in_the_arcade;
    for (view, share) in [(0, 0.9), (1, 0.5)] {
        let shot = plan.shot(&mut session, view);
        let pixels = shot.where_surface(inside);
        assert!(
            pixels.len() as f64 > share * 160.0 * 90.0,
            "view {view}: {} pixels",
            pixels.len()
        );
        assert_eq!(
            raining(&pixels),
            0,
            "view {view}: of {} pixels in the arcade",
            pixels.len()
        );
    }
    let street = plan
        .shot(&mut session, 2)
        .where_surface(|p| p.x < f64::from(FACADE_X) - 1.0);
    assert!(street.len() > 2000, "{} pixels show the street", street.len());
    assert!(
        raining(&street) * 20 > street.len(),
        "{} of {}",
        raining(&street),
        street.len()
    );

    // The closed room: what was recorded for the street's views does not grow.
    let before = recorded(&session);
    assert!(before > 0);
    let shot = plan.shot(&mut session, 3);
    assert_eq!(recorded(&session), before, "rain was drawn for an eye in a closed room");
    assert_eq!(raining(&shot.pixels()), 0);
    assert!(mean(&shot.pixels(), |p| p.wet) == 0.0, "the closed room is wet");
}

#[test]
fn wind_drives_rain_under_the_bus_shelter_by_height_times_wind_over_fall_speed() {
    if !gpu::available() {
        return;
    }
    let layout = assets::street_folder().1;
    let ground = |p: bevy::math::DVec3| f64::from(layout.ground_height(p.x as f32, p.z as f32));
    let edge = f64::from(SHELTER_X[1]);
    let mut found = Vec::new();
    // A breeze that leaves the shelter clear of the rain shadow of the houses across the street.
    for wind in [0.0, -1.2] {
        let view = View::new([-4.9, 2.4, -10.0], [-4.9, 0.0, -10.0]).fov(80.0);
        let plan = plan([wind, 0.0, 0.0], 180.0, &[view]);
        let mut session = session_of_the_moment(&plan);
        let shot = plan.shot(&mut session, 0);
        // The pavement, away from the posts and the roof's ends.
        let pavement = shot.where_surface(|p| {
            (p.y - ground(p)).abs() < 0.03
                && p.z > f64::from(SHELTER_Z[0]) + 0.5
                && p.z < f64::from(SHELTER_Z[1]) - 0.5
                && p.x > f64::from(SHELTER_X[0]) + 0.3
        });
        assert!(pavement.len() > 1500, "{} pixels of pavement", pavement.len());
        let height = f64::from(SHELTER_Y) - mean(&pavement, |p| p.surface.map_or(0.0, ground));
        let expected = edge + height * wind * MEDIAN_INVERSE_SPEED_25_MM_H;
        let x = |p: &Pixel| p.surface.map_or(f64::NAN, |s| s.x);
        let borders = crossings(&profile(&pavement, x), 0.5);
        let nearest = borders
            .iter()
            .copied()
            .min_by(|a, b| (a - expected).abs().total_cmp(&(b - expected).abs()))
            .expect("a border");
        // The pavement falls by 2 cm a metre: h differs by as much over the strip.
        assert!(
            (nearest - expected).abs() < 2.0 * COVER_TEXEL_M,
            "wind {wind}: borders at {borders:?}, geometry says {expected}"
        );
        // Further in, without wind, nothing arrives.
        let deep: Vec<Pixel> = pavement.iter().copied().filter(|p| x(p) < edge - 0.4).collect();
        assert!(
            wind < 0.0 || deep.len() > 100 && deep.iter().all(|p| p.wet == 0.0),
            "wet deep in the shelter without wind"
        );
        let out: Vec<Pixel> = pavement.iter().copied().filter(|p| x(p) > expected + 0.4).collect();
        assert!(
            out.len() > 100 && mean(&out, |p| p.wet) > 0.9,
            "wind {wind}: {}",
            mean(&out, |p| p.wet)
        );
        found.push(nearest);
    }
    assert!(
        found[0] - found[1] > 0.3,
        "wind moved the border by {} m",
        found[0] - found[1]
    );
}

#[test]
fn no_streak_and_no_wet_under_the_driving_car_in_any_capture_and_both_beside_it() {
    if !gpu::available() {
        return;
    }
    let (speed, start) = (9.0, 90.0);
    let place = |time_s: f64| {
        let z = f64::from(CAR_START[2]) + speed * (time_s - start + 1.0);
        [f64::from(CAR_START[0]), f64::from(CAR_START[1]), z]
    };
    // The camera lies under the car and looks along the road; its frame is the car's.
    let (eye, target) = ([0.0, 0.11, -1.0], [0.0, 0.06, 2.0]);
    let view = |time_s: f64| {
        let at = bevy::math::DVec3::from_array(place(time_s));
        View::new(
            (at + bevy::math::DVec3::from_array(eye)).to_array(),
            (at + bevy::math::DVec3::from_array(target)).to_array(),
        )
        .fov(70.0)
    };
    let mut plan = plan([0.0; 3], start, &[view(start); 3]);
    plan.scenario.vehicles = vec![Vehicle {
        name: "car".into(),
        file: street::CAR_FILE.into(),
        path: [start - 1.0, start + 3.0]
            .into_iter()
            .map(|time_s| PathKey {
                time_s,
                position: place(time_s),
            })
            .collect(),
        wheel_radius_m: f64::from(street::car::WHEEL_RADIUS),
        ..Vehicle::default()
    }];
    plan.scenario.camera.keys.clear();
    plan.scenario.camera.attached = Some(Attached {
        vehicle: "car".into(),
        eye_offset: eye,
        target_offset: target,
        fov_y_deg: 70.0,
    });
    let mut session = session_of_the_moment(&plan);
    let layout = assets::street_folder().1;
    for i in 0..3 {
        let mut shot = plan.shot(&mut session, i);
        shot.view = view(plan.time_s(i));
        let [x, _, z] = place(plan.time_s(i));
        let road = |p: bevy::math::DVec3| (p.y - f64::from(layout.ground_height(p.x as f32, p.z as f32))).abs() < 0.03;
        let under = shot.where_surface(|p| road(p) && (p.x - x).abs() < 0.55 && p.z - z < 1.6);
        let beside = shot.where_surface(|p| road(p) && (p.z - z > 2.6 || (p.x - x).abs() > 1.4) && p.x.abs() < 3.1);
        assert!(
            under.len() > 500 && beside.len() > 100,
            "{} under, {} beside",
            under.len(),
            beside.len()
        );
        assert_eq!(raining(&under), 0, "capture {i}: streaks under the car");
        assert_eq!(
            under.iter().filter(|p| p.wet > 0.0).count(),
            0,
            "capture {i}: wet under the car"
        );
        assert!(raining(&beside) > 0, "capture {i}: no streak before the car");
        assert!(
            mean(&beside, |p| p.wet) > 0.8,
            "capture {i}: {}",
            mean(&beside, |p| p.wet)
        );
    }
}

#[test]
fn rain_changes_the_depth_of_no_surface() {
    if !gpu::available() {
        return;
    }
    // Lamps, façades and, near and far, crowns of alpha-masked leaves.
    let place = assets::street_folder().1.view("street").expect("a place on the street");
    let view = View::new(place.eye.map(f64::from), place.target.map(f64::from));
    let depths = [0.0, 25.0].map(|intensity| {
        let mut plan = plan([0.0; 3], 60.0, &[view]);
        plan.scenario.weather = steady(intensity, [0.0; 3]);
        let shot = plan.shot(&mut session(&plan), 0);
        shot.pixels()
            .iter()
            .map(|p| p.surface.map(|s| s.distance(view.eye)))
            .collect::<Vec<_>>()
    });
    let seen = depths[0].iter().filter(|d| d.is_some()).count();
    assert!(seen > 5000, "{seen} pixels show a surface");
    let same = |a: &Option<f64>, b: &Option<f64>| match (a, b) {
        (Some(a), Some(b)) => (a / b - 1.0).abs() < 0.01,
        (a, b) => a.is_none() && b.is_none(),
    };
    let changed = depths[0].iter().zip(&depths[1]).filter(|(a, b)| !same(a, b)).count();
    // A texel of a leaf may fall to the other side of its threshold.
    assert!(
        changed * 200 < depths[0].len(),
        "{changed} pixels show another surface when wet"
    );
}
