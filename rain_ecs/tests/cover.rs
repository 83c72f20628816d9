//! The cover map follows the rain and the host.

use bevy_math::{DVec3, Vec3};
use rain_ecs::prelude::*;

use crate::common::{app, quad, run};

#[test]
fn the_map_slants_with_the_wind_and_tolerates_a_degree() {
    let mut app = app(RainClock::default());
    let weather = app.world_mut().spawn(Weather::rain(25.0)).id();
    let roof = quad([0.0, 0.0], [10.0, 10.0], |_, _| 5.0);
    app.world_mut()
        .resource_mut::<CoverField>()
        .set(1, &roof, true)
        .expect("fits");
    run(&mut app, 1);
    let exposed =
        |app: &bevy_app::App, x: f64| app.world().resource::<CoverField>().exposed_at(DVec3::new(x, 0.0, 5.0));
    assert_eq!(
        (exposed(&app, 1.0), exposed(&app, 11.0), exposed(&app, 5.0)),
        (0.0, 1.0, 0.0)
    );
    let version = app.world().resource::<CoverField>().version();
    let wind = |app: &mut bevy_app::App, m_s: f32| {
        app.world_mut().get_mut::<Weather>(weather).expect("there").wind_m_s = Vec3::X * m_s;
        run(app, 1);
        app.world().resource::<CoverField>().version()
    };
    assert_eq!(wind(&mut app, 0.05), version, "half a degree is no reason");
    assert!(wind(&mut app, 4.0) > version);
    // 0.17 s/m times 4 m/s times 5 m of fall: the shadow moves by 3.4 m.
    assert_eq!(
        (exposed(&app, 2.0), exposed(&app, 11.0), exposed(&app, 5.0)),
        (1.0, 0.0, 0.0)
    );
    let steady = app.world().resource::<CoverField>().version();
    run(&mut app, 5);
    assert_eq!(
        app.world().resource::<CoverField>().version(),
        steady,
        "nothing moved, nothing drawn"
    );
}

#[test]
fn what_lets_rain_through_does_not_cover_and_bad_triangles_do_nothing() {
    let mut app = app(RainClock::default());
    let roof = quad([0.0, 0.0], [10.0, 10.0], |_, _| 5.0);
    let mut cover = app.world_mut().resource_mut::<CoverField>();
    cover.set(1, &roof, false).expect("fits");
    let bad = [[DVec3::NAN, DVec3::X, DVec3::Z], [DVec3::ZERO; 3]];
    cover.set(2, &bad, true).expect("skipped");
    let far = quad([0.0, 0.0], [1e8, 1.0], |_, _| 0.0);
    assert!(
        cover
            .set(3, &far, true)
            .expect_err("too far")
            .to_string()
            .contains("1e7")
    );
    run(&mut app, 1);
    let cover = app.world().resource::<CoverField>();
    assert_eq!(cover.exposed_at(DVec3::new(5.0, 0.0, 5.0)), 1.0);
    assert_eq!((cover.skipped().non_finite, cover.skipped().degenerate), (1, 1));
    assert_eq!(cover.exposed_at(DVec3::NAN), 1.0);
}
