//! What a step in water throws: the same words in double precision, and what it may not do.

use glam::DVec3;
use rain_core::splash::{FOOT_DROPS, FOOT_SPLASH_S, foot_drop, foot_drop_count, foot_sheet};
use rain_reference::splash as reference;

use crate::check::Worst;

const BAD: [f32; 6] = [f32::NAN, f32::NEG_INFINITY, -1.0, 0.0, 1e30, f32::INFINITY];

#[test]
fn a_steps_drops_are_those_of_the_words() {
    let (mut size, mut way, mut bent) = (Worst::default(), Worst::default(), Worst::default());
    for seed in 0..80_u32 {
        let strength = (f64::from(seed) + 1.0) / 80.0;
        let key = [seed, 3, seed.wrapping_mul(77_777)];
        let count = foot_drop_count(strength as f32);
        // Rounded as the strength is.
        let strength = f64::from(strength as f32);
        assert_eq!(count, (8.0 + 55.0 * strength).floor() as u32, "{strength}");
        for index in 0..count {
            let (drop, from) = foot_drop(strength as f32, key, index);
            let known = reference::from_step(strength, key, index, count);
            let place = || format!("{index} of {strength}");
            size.relative(f64::from(drop.diameter_mm), known.diameter_mm, 1e-30, place);
            let turn = core::f64::consts::TAU * known.around;
            let outward = DVec3::new(turn.cos(), 0.0, turn.sin());
            let velocity = known.speed_m_s * (outward * known.rise.cos() + DVec3::Y * known.rise.sin());
            way.absolute((drop.velocity_m_s.as_dvec3() - velocity).length(), 0.0, place);
            way.absolute((from.as_dvec3() - 0.05 * outward).length(), 0.0, place);
            bent.absolute((1.05 * drop.velocity_m_s.as_dvec3() - velocity).length(), 0.0, place);
        }
    }
    size.assert_below(2e-7, 2000);
    way.assert_below(1e-6, 4000);
    assert!(bent.error > 0.02, "the comparison sees 5 %");
}

#[test]
fn a_steps_sheet_is_that_of_the_words_and_falls() {
    let mut worst = Worst::default();
    for i in 0..=40_u8 {
        for j in 0..60_u8 {
            let (strength, age) = (f32::from(i) / 40.0, (f32::from(j) + 0.5) / 400.0);
            let known = reference::sheet_of_step(strength.into(), age.into());
            for (own, known) in foot_sheet(strength, age).into_iter().zip(known) {
                worst.relative(own.into(), known, 0.1, || format!("{strength} {age}"));
            }
        }
    }
    worst.assert_below(1e-6, 6000);
    let height = |age: f32| foot_sheet(1.0, age)[1];
    assert!(height(0.06) > 0.039 && height(0.03) < height(0.06) && height(0.09) < height(0.06));
    assert_eq!(
        (foot_sheet(1.0, 0.13), foot_sheet(1.0, -0.01), foot_sheet(0.0, 0.05)),
        ([0.0; 3], [0.0; 3], [0.0; 3])
    );
}

#[test]
fn stronger_steps_throw_more_and_farther_and_all_land_in_time() {
    assert_eq!(
        (foot_drop_count(0.0), foot_drop_count(1e-6), foot_drop_count(1.0)),
        (0, 8, FOOT_DROPS)
    );
    let mut farthest = [0.0_f32; 2];
    for (own, strength) in farthest.iter_mut().zip([0.3, 1.0]) {
        for seed in 0..50 {
            for index in 0..foot_drop_count(strength) {
                let (drop, from) = foot_drop(strength, [seed, 1, 2], index);
                assert!((1.5..=6.5).contains(&drop.diameter_mm) && drop.velocity_m_s.y > 0.0);
                assert!(drop.place_m(FOOT_SPLASH_S).y < 0.0, "it has landed: {drop:?}");
                let flown = (0..50_u8)
                    .map(|i| drop.place_m(f32::from(i) * 0.01))
                    .filter(|place| place.y >= 0.0);
                let reach = flown
                    .map(|place| (from + place).with_y(0.0).length())
                    .fold(0.0, f32::max);
                *own = own.max(reach);
            }
        }
    }
    assert!(
        farthest[1] > 1.5 * farthest[0] && farthest[1] < 1.0 && farthest[0] > 0.1,
        "{farthest:?}"
    );
    for bad in BAD {
        assert!(foot_drop_count(bad) <= FOOT_DROPS);
        let (drop, from) = foot_drop(bad, [1, 2, 3], 7);
        assert!(drop.velocity_m_s.is_finite() && drop.diameter_mm.is_finite() && from.is_finite());
        assert!(foot_sheet(bad, 0.05).into_iter().all(|v| (0.0..1.0).contains(&v)));
        assert!(foot_sheet(1.0, bad).into_iter().all(|v| (0.0..1.0).contains(&v)));
    }
    assert_eq!(foot_drop(0.5, [4, 5, 6], 2), foot_drop(0.5, [4, 5, 6], 2));
    assert!(foot_drop(0.5, [4, 5, 6], 2).0.velocity_m_s != foot_drop(0.5, [5, 5, 6], 2).0.velocity_m_s);
}
