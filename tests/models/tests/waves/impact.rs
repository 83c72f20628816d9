//! Numbers of an impact, and how long its ring is seen.

use proptest::prelude::*;
use rain_core::waves::{DropImpact, Ring, RingTable};
use rain_reference::splash::crater_radius;
use rain_reference::waves as truth;

use super::super::check::Worst;
use super::cases;

fn drop(diameter_mm: f64, speed_m_s: f64) -> DropImpact {
    DropImpact {
        x_m: 0.0,
        z_m: 0.0,
        diameter_mm,
        speed_m_s,
    }
}

/// Drops of all sizes at all speeds.
fn drops() -> impl Iterator<Item = DropImpact> {
    let diameters = [1e-3, 0.1, 0.5, 1.0, 2.2, 4.7, 10.0];
    diameters
        .into_iter()
        .flat_map(|d| [1e-3, 0.3, 4.0, 9.2, 30.0].map(|v| drop(d, v)))
}

#[test]
fn numbers_of_an_impact_are_those_of_its_sphere_and_its_pulse() {
    let [mut closed, mut peak, mut width, mut wrong] = [(); 4].map(|()| Worst::default());
    for impact in drops() {
        let place = || format!("{impact:?}");
        let radius = 0.5e-3 * impact.diameter_mm;
        let volume = 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
        let momentum = 998.2 * volume * impact.speed_m_s;
        closed.relative(impact.volume_m3(), volume, 0.0, place);
        closed.relative(impact.momentum(), momentum, 0.0, place);
        let crater = 0.5 * crater_radius(0.5 * momentum * impact.speed_m_s);
        for depth in [1e-4, 5e-3, 0.3, 100.0] {
            let place = || format!("{impact:?} on {depth} m");
            for s in [1e-4, 7e-3, 0.5] {
                let exact = truth::peak_velocity(momentum, depth, s);
                peak.relative(impact.peak_velocity(depth, s), exact, 0.0, place);
                wrong.relative(impact.peak_velocity(depth, 1.05 * s), exact, 0.0, String::new);
            }
            // As wide as it takes for the surface to move at 0.3 of the wave speed: halved in its logarithm.
            let limit = 0.3 * truth::shallow_speed(depth);
            let linear = rain_reference::numerics::bisect(-20.0, 20.0, |ln| {
                depth * momentum / (998.2 * std::f64::consts::PI) * (-4.0 * ln).exp() - limit
            })
            .exp();
            for cell in [0.0, 1e-3, 0.02] {
                width.relative(
                    impact.width_m(cell, depth),
                    crater.max(linear).max(2.0 * cell),
                    0.0,
                    place,
                );
            }
        }
    }
    closed.assert_below(1e-15, 70);
    // The differences of the reference.
    peak.assert_below(1e-8, 400);
    // The slices of the reference's crater.
    width.assert_below(1e-6, 400);
    assert!(wrong.error > 0.1, "a width 5 % off goes unseen");
}

#[test]
fn a_ring_lives_as_long_as_it_is_seen() {
    let table = RingTable::new();
    let [mut worst, mut wrong] = [Worst::default(), Worst::default()];
    for (diameter, depth, damping) in [(1.0, 0.005, 0.6), (3.0, 0.02, 5.0), (5.0, 0.002, 0.05), (0.5, 1.0, 0.0)] {
        let ring = Ring::new(&drop(diameter, 8.0), depth, damping).expect("within its domain");
        let [bump, push, s, c, decay] =
            [ring.bump_m, ring.push_m, ring.width_m, ring.speed_m_s, ring.decay_per_s].map(f64::from);
        for slope in [1e-4_f32, 1e-3, 1e-2, 0.1] {
            let exact = truth::ring_lifetime([bump, push], s, c, decay, f64::from(slope));
            let life = table.lifetime_s(&ring, slope);
            worst.relative(f64::from(life), exact, 1e-3, || format!("{diameter} mm, slope {slope}"));
            wrong.relative(
                f64::from(table.lifetime_s(&ring, 1.05 * slope)),
                exact,
                1e-3,
                String::new,
            );
        }
    }
    worst.assert_below(2e-3, 16);
    assert!(wrong.error > 0.02, "a slope 5 % off goes unseen");
}

proptest! {
    #![proptest_config(cases(64))]
    #[test]
    fn nothing_of_a_ring_is_steep_after_its_life(
        diameter in 0.3_f64..6.0, speed in 0.5_f64..9.0, depth in 1e-3_f64..0.1, damping in 0.0_f64..5.0,
        slope in 1e-4_f32..0.1,
    ) {
        let table = RingTable::new();
        let ring = Ring::new(&drop(diameter, speed), depth, damping).expect("within its domain");
        let life = table.lifetime_s(&ring, slope);
        prop_assert!((0.0..=1e3).contains(&life));
        prop_assert!(table.lifetime_s(&ring, 0.5 * slope) >= life);
        for later in [1.0, 1.3, 3.0] {
            let age = life * later;
            let front = ring.speed_m_s * age;
            // From r = 5 s on, where the packet's law holds.
            for i in -300_i16..300 {
                let r = front + 0.02 * f32::from(i) * ring.width_m;
                if r > 5.0 * ring.width_m && front > 5.0 * ring.width_m {
                    let (_, steep) = table.height_and_slope(&ring, r, age);
                    prop_assert!(steep.abs() <= slope, "{life} s, {later}: {steep} at {r} m");
                }
            }
        }
    }
}

#[test]
fn impacts_of_nothing_do_nothing() {
    for impact in [drop(0.0, 9.0), drop(2.0, 0.0), drop(0.0, 0.0)] {
        assert_eq!(impact.momentum(), 0.0);
        assert_eq!(
            (impact.peak_velocity(0.01, 0.02), impact.width_m(0.01, 0.01)),
            (0.0, 0.02)
        );
    }
    for depth in [f64::NAN, f64::NEG_INFINITY, -1.0, 0.0] {
        // Without water to move the crater and the cells alone count.
        let width = drop(2.0, 6.0).width_m(1e-5, depth);
        assert!(width.is_finite() && width > 1e-3, "{depth}: {width}");
    }
    assert!(drop(2.0, 6.0).width_m(1e-5, 1e300).is_finite());
    assert!(drop(10.0, 30.0).width_m(1e-5, 5e-324).is_finite());
}
