//! What a view that moves holds more, against steps along many directions.

use glam::{DVec3, Vec4};
use rain_core::rainfall::RainViewVolume;

use crate::check::Worst;
use crate::drop_field::view;

/// Volume in a view of these tangents, within `reach` of the segment from the eye to `lead`, over that within reach of the eye.
/// By steps along many directions; the view looks along −Z.
fn lead_growth_by_steps([tx, ty]: [f64; 2], lead: DVec3, reach: f64) -> f64 {
    let (mut moving, mut still) = (0.0, 0.0);
    let side = 60;
    for i in 0..side * side {
        let at = |i: i32| 2.0 * (f64::from(i) + 0.5) / f64::from(side) - 1.0;
        let ray = DVec3::new(tx * at(i % side), ty * at(i / side), -1.0);
        let share = ray.length().powi(-3);
        let ray = ray.normalize();
        let step = (reach + lead.length()) / 600.0;
        for k in 0..600 {
            let t = step * (f64::from(k) + 0.5);
            let p = ray * t;
            let on = lead * (p.dot(lead) / lead.length_squared()).clamp(0.0, 1.0);
            let volume = share * t * t;
            moving += if p.distance(on) <= reach { volume } else { 0.0 };
            still += if t <= reach { volume } else { 0.0 };
        }
    }
    moving / still
}

#[test]
fn a_view_that_moves_holds_the_volume_along_its_lead() {
    let (mut near, mut far, mut bent) = (Worst::default(), Worst::default(), Worst::default());
    let tangents = [0.8, 0.4];
    for velocity in [
        DVec3::new(0.0, 0.0, -5.0),
        DVec3::new(0.0, 0.0, -36.0),
        DVec3::new(4.0, -1.0, -20.0),
        DVec3::new(0.0, 0.0, 20.0),
        DVec3::new(14.0, 0.0, 0.0),
        DVec3::new(-20.0, 3.0, -9.0),
        DVec3::new(0.0, -9.0, 1.0),
    ] {
        let view = RainViewVolume {
            eye_velocity_m_s: velocity,
            ..view(623.5, 1.0 / 60.0)
        };
        let lead = (velocity * 0.15).clamp_length_max(8.0);
        for reach in [0.4, 1.0, 3.0, 8.0, 18.0] {
            let slow = lead_growth_by_steps(tangents, lead, reach);
            let found = view.lead_growth(reach);
            let place = || format!("{velocity} m/s, {reach} m: {found}, {slow}");
            if lead.length() <= 6.0 * reach {
                near.relative(found, slow, 1e-30, place);
                bent.relative(1.1 * found, slow, 1e-30, String::new);
            } else {
                far.absolute(found.ln(), slow.ln(), place);
            }
        }
    }
    near.assert_below(6e-2, 30);
    far.assert_below(3.0_f64.ln(), 3);
    assert!(bent.error > 0.08);
    // What stands still, or has no planes or no velocity, holds what it holds.
    for odd in [
        view(623.5, 1.0 / 60.0),
        RainViewVolume {
            eye_velocity_m_s: DVec3::new(0.0, f64::NAN, 1.0),
            ..view(623.5, 1.0 / 60.0)
        },
        RainViewVolume {
            eye_velocity_m_s: DVec3::X,
            side_planes: [Vec4::ZERO; 4],
            ..view(623.5, 1.0 / 60.0)
        },
    ] {
        assert_eq!(odd.lead_growth(3.0), 1.0);
    }
    let fast = RainViewVolume {
        eye_velocity_m_s: DVec3::new(0.0, 0.0, -9.0),
        ..view(623.5, 1.0 / 60.0)
    };
    for bad in [f64::NAN, f64::NEG_INFINITY, -1.0, 0.0, 5e-324, 1e300, f64::INFINITY] {
        assert!(fast.lead_growth(bad).is_finite(), "{bad}");
    }
}
