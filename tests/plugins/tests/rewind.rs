//! The picture after a jump back in time is the picture of then.

use bevy::prelude::*;
use rain_plugins::prelude::*;
use rain_plugins::surface::WaterLevels;
use rain_plugins::waves::PuddleWaves;
use test_support::app::FRAME;
use test_support::gpu;

use crate::scenes::{depth, difference, hollow_at, rain};

#[test]
fn a_restored_scene_looks_as_it_did_and_no_later_water_stays() {
    if !gpu::available() {
        return;
    }
    let (mut test, weather) = hollow_at(Vec3::ZERO);
    rain(&mut test, weather, 40.0, 200);
    let saved = RainSnapshot::save(test.world()).expect("can be written");
    let before = test.picture();
    let levels = test.world().resource::<WaterLevels>().levels_m().clone();
    let shallow = depth(&mut test, 0.0, 0.0);

    // Later: more water, a foot in it, another picture.
    rain(&mut test, weather, 150.0, 1200);
    let foot = test
        .world()
        .spawn((
            WaterDisturber {
                radius_m: 0.1,
                ..default()
            },
            Transform::from_xyz(0.0, 0.0, 0.0),
        ))
        .id();
    for step in 0..4_u8 {
        let at = Transform::from_xyz(0.05 * f32::from(step), 0.0, 0.0);
        test.world().entity_mut(foot).insert(at);
        test.frames(1, FRAME);
    }
    test.world().despawn(foot);
    assert!(
        !test.world().resource::<PuddleWaves>().tile().is_calm(),
        "the foot made waves"
    );
    let later = test.picture();
    let deep = depth(&mut test, 0.0, 0.0);
    assert!(shallow > 0.002 && deep > 1.3 * shallow, "{shallow}, {deep}");
    let changed = difference(&before, &later);
    assert!(changed.mean > 0.4 && changed.share > 0.02, "{changed:?}");

    saved.restore(test.world()).expect("fits");
    let after = test.picture();
    // What is shown lags behind what is simulated by less than 0.1 mm; restored, it does not.
    let restored = test.world().resource::<WaterLevels>().levels_m().clone();
    assert_eq!(restored.len(), levels.len());
    let off = levels
        .iter()
        .zip(restored.iter())
        .filter(|(then, now)| (*then - *now).abs() > 1e-4);
    assert_eq!(off.count(), 0, "the levels of then");
    assert!(
        test.world().resource::<PuddleWaves>().tile().is_calm(),
        "no waves of later"
    );
    let found = difference(&before, &after);
    assert!(found.mean < 0.02 && found.share == 0.0, "{found:?}, later {changed:?}");

    // It goes on from there as it did.
    test.frames(4, FRAME);
    assert!((depth(&mut test, 0.0, 0.0) - shallow).abs() < 0.002);
}
