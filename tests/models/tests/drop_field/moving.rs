//! What a moving body meets of the drop field.

use glam::{DVec3, IVec3};
use rain_core::rainfall::{CLASS_COUNT, FieldMotion, SizeClass, Threshold, cell_key, for_each_drop};

use super::spectrum;

/// Half the body's width, height and length: a car that faces +z. Units: m.
const HALF: DVec3 = DVec3::new(0.9, 0.7, 2.0);

/// Drops that land on the front, the rear and the roof of the body in a tenth of a second.
fn hits(speed_m_s: f64, wind_m_s: DVec3) -> [u32; 3] {
    const TIME_S: f64 = 0.1;
    let (seed, rain) = (5, spectrum(25.0));
    let mut motion = FieldMotion::default();
    motion.set_velocity(wind_m_s, rain_core::constants::AIR_DENSITY);
    let mut counts = [0; 3];
    for k in 0..CLASS_COUNT {
        let class = SizeClass::new(k);
        let threshold = Threshold::new(&class, &rain);
        // In the body's frame.
        let way = (motion.velocity_m_s[k] - DVec3::Z * speed_m_s) * TIME_S;
        let low = ((-HALF - way.max(DVec3::ZERO)) / class.cell_m).floor().as_ivec3();
        let high = ((HALF - way.min(DVec3::ZERO)) / class.cell_m).floor().as_ivec3();
        let cells = (low.x..=high.x)
            .flat_map(|x| (low.y..=high.y).flat_map(move |y| (low.z..=high.z).map(move |z| IVec3::new(x, y, z))));
        for cell in cells {
            for_each_drop(
                &class,
                cell_key(seed, k as u32, cell),
                threshold.scan_limit(),
                |_, drop| {
                    if threshold.presence(&drop) < 0.5 {
                        return;
                    }
                    let from = (cell.as_dvec3() + drop.position.as_dvec3()) * class.cell_m;
                    // Through the plane of a face from outside, within its edges.
                    let through = |axis: usize, sign: f64| {
                        let (before, moved) = (sign * from[axis] - HALF[axis], sign * way[axis]);
                        let at = from + way * (-before / moved);
                        before > 0.0
                            && before + moved <= 0.0
                            && (0..3).all(|other| other == axis || at[other].abs() <= HALF[other])
                    };
                    for (count, (axis, sign)) in counts.iter_mut().zip([(2, 1.0), (2, -1.0), (1, 1.0)]) {
                        *count += u32::from(through(axis, sign));
                    }
                },
            );
        }
    }
    counts
}

#[test]
fn a_moving_body_is_hit_in_front_and_not_behind() {
    let [front, rear, roof] = hits(0.0, DVec3::ZERO);
    assert!(
        front == 0 && rear == 0 && roof > 1000,
        "standing: {front} {rear} {roof}"
    );
    let [slow, behind, _] = hits(5.0, DVec3::ZERO);
    let [fast, none, top] = hits(15.0, DVec3::ZERO);
    assert!(behind == 0 && none == 0, "{behind} {none}");
    assert!(slow > 200, "{slow}");
    let ratio = f64::from(fast) / f64::from(slow);
    // As many as it sweeps up: three times the way.
    assert!(
        (ratio - 3.0).abs() < 5.0 * ratio * (1.0 / f64::from(slow)).sqrt(),
        "{slow} {fast}"
    );
    assert!(
        (f64::from(top) / f64::from(roof) - 1.0).abs() < 0.15,
        "the roof's share stays: {roof} {top}"
    );
    // Backwards, and with the wind.
    let [front, rear, _] = hits(-5.0, DVec3::ZERO);
    assert!(front == 0 && rear > 200, "{front} {rear}");
    let [front, rear, _] = hits(15.0, DVec3::Z * 15.0);
    assert!(front == 0 && rear == 0, "{front} {rear}");
    let [front, rear, _] = hits(5.0, DVec3::Z * 10.0);
    assert!(front == 0 && rear > 200, "the wind overtakes it: {front} {rear}");
}
