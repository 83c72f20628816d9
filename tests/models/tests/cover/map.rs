//! The sheared projection and the tiles: what a drop's mean way meets.

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use rain_core::cover::height_tiles::TILE_CELLS;
use rain_core::cover::lookup::{OPEN_SKY, shift_per_metre, soft_exposure};
use rain_core::cover::{FallSlope, ShearedOrthographic, ShearedOrthographicSettings, project};
use rain_reference::cover as reference;

use super::{MEAN, block, random, scene, shards, slope};
use crate::check::Worst;

#[test]
fn a_cell_holds_the_highest_triangle_on_its_ray() {
    let (mut checked, mut covered, mut wrong, mut bent) = (0, 0, 0, 0);
    for (n, wind) in [(0, [0.0, 0.0]), (1, [6.0, -2.0]), (2, [-17.0, 9.0]), (3, [0.02, 0.3])] {
        let mut triangles = shards(n, 60);
        triangles.extend(block([-3.0, 0.0, -4.0], [5.0, 4.25, 1.0]));
        for cell_m in [0.0625, 0.25, 1.0] {
            let map = scene(&triangles, cell_m, wind);
            let drift = map.drawn_drift();
            // The wind whose mean drop falls along the drawn direction.
            let along = (drift / MEAN).to_array();
            for i in 0..1500 {
                let [x, z, _] = random(n, i, 50).map(|u| ((60.0 * u - 30.0) / cell_m).floor());
                let centre = [(x + 0.5) * cell_m, 0.0, (z + 0.5) * cell_m];
                let found = map.tiles().reader().height(x as i64, z as i64);
                // Corners are rounded to 2⁻¹⁶ m, place and drift apart: rays that far aside.
                let mut near = Vec::new();
                let mut any_open = false;
                for aside in 0..9_i32 {
                    let [a, b] = [f64::from(aside % 3 - 1), f64::from(aside / 3 - 1)];
                    let aside = [centre[0] + a * 2.2e-5, 0.0, centre[2] + b * 2.2e-5];
                    match reference::highest_on_the_way(&triangles, aside, along, 1.0 / MEAN) {
                        Some(height) => near.push(height),
                        None => any_open = true,
                    }
                }
                let (low, high) = near
                    .iter()
                    .fold((f64::MAX, f64::MIN), |(a, b), h| (a.min(*h), b.max(*h)));
                let fits = |height: f64| height >= low - 1e-6 && height <= high + 1e-6;
                checked += 1;
                if found == OPEN_SKY {
                    wrong += u32::from(!any_open);
                } else {
                    covered += 1;
                    wrong += u32::from(!fits(f64::from(found)));
                    bent += u32::from(!fits(1.001 * f64::from(found)));
                    let height = map.occluder_height(DVec3::from(centre)).expect("finite");
                    assert_eq!(height, Some(f64::from(found)));
                }
            }
        }
    }
    assert_eq!(wrong, 0, "of {checked}");
    assert!(covered > 1000 && bent > 500, "{covered} covered, {bent} told apart");
    assert!(checked == 18_000 && TILE_CELLS == 64);
}

#[test]
fn points_are_projected_along_the_mean_drop() {
    let (mut place, mut clip, mut shift) = (Worst::default(), Worst::default(), Worst::default());
    for i in 0..2000_u32 {
        let [a, b, c] = random(i, 0, 0);
        let [x, y, z] = random(i, 0, 1);
        let wind = [40.0 * a - 20.0, 40.0 * b - 20.0];
        let mean = 0.1 + 0.3 * c;
        let slope = FallSlope::new(DVec2::from(wind), mean).expect("inside the domain");
        let point = DVec3::new(200.0 * x - 100.0, 40.0 * y - 10.0, 200.0 * z - 100.0);
        let level = 3.0;
        let met = reference::met_level(point.to_array(), level, wind, 1.0 / mean);
        place.absolute(
            (project(point, level, slope.drift()) - DVec2::from(met)).length(),
            0.0,
            || format!("{point} {wind:?}"),
        );
        // A drop of another speed, at the height of `point` over the ray of its own: where it was 5 m above.
        let speed = 2.0 + 7.0 * c;
        let up = point + DVec3::new(-5.0 * wind[0] / speed, 5.0, -5.0 * wind[1] / speed);
        let way = project(up, level, slope.drift()) - project(point, level, slope.drift());
        let per_metre = shift_per_metre(DVec2::from(wind).as_vec2(), (1.0 / speed) as f32, mean as f32);
        shift.absolute((way / 5.0 + per_metre.as_dvec2()).length(), 0.0, || format!("{wind:?}"));
        // On the map: (0, 0) at the corner, height by depth.
        let map = ShearedOrthographic::new(ShearedOrthographicSettings {
            centre: DVec3::new(point.x, 0.0, point.z),
            drift: slope.drift(),
            reference_height_m: level,
            ..Default::default()
        })
        .expect("valid");
        let uv = (DVec2::from(met) - map.corner()) / map.settings().extent_m;
        let depth = (point.y - map.settings().low_m) / (map.settings().high_m - map.settings().low_m);
        let seen = map.clip_from_world(point) * glam::Vec4::W;
        let expected = DVec3::new(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y, depth);
        clip.absolute((seen.truncate().as_dvec3() - expected).length(), 0.0, || {
            format!("{point} {wind:?}")
        });
        assert!((map.texture_uv(point) - uv).length() < 1e-12);
        if uv.min_element() > 0.0 && uv.max_element() < 1.0 {
            assert!(map.holds(point, 0.0));
        }
    }
    place.assert_below(1e-12, 2000);
    shift.assert_below(4e-6, 2000);
    clip.assert_below(4e-6, 2000);
}

#[test]
fn softened_exposure_is_bilinear() {
    let (mut worst, mut bent) = (Worst::default(), Worst::default());
    for i in 0..3000_u32 {
        let [x, z, texel] = random(i, 1, 1);
        let texel = 0.05 + texel;
        let q = DVec2::new(20.0 * x - 10.0, 20.0 * z - 10.0);
        let is_open = |cell: DVec2| (cell.x.sin() + (1.7 * cell.y).cos()) > 0.2;
        let found = soft_exposure(q.as_vec2(), texel as f32, |at| {
            !is_open((at.as_dvec2() / texel - 0.5).round())
        });
        let (mut exact, mut sharp) = (0.0, 0.0);
        let base = (q / texel - 0.5).floor();
        for corner in [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE] {
            let weight = 1.0 - (q / texel - 0.5 - base - corner).abs();
            let open = f64::from(u8::from(is_open(base + corner)));
            exact += weight.x * weight.y * open;
            sharp += 0.25 * open;
        }
        worst.absolute(f64::from(found), exact, || format!("{q} {texel}"));
        bent.absolute(sharp, exact, String::new);
    }
    worst.assert_below(1e-4, 3000);
    assert!(bent.error > 0.3);
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 512,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(29),
        ..ProptestConfig::default()
    })]

    #[test]
    fn a_lattice_direction_is_near_and_angles_are_those_between_directions(
        x in -40.0_f64..40.0, z in -40.0_f64..40.0, mean in 0.1_f64..0.3, turn in -0.2_f64..0.2,
    ) {
        let falls = |drift: DVec2| [drift.x, -1.0, drift.y];
        let slope = FallSlope::new(DVec2::new(x, z), mean).expect("inside the domain");
        let snapped = slope.snapped_drift();
        prop_assert!(reference::angle(falls(slope.drift()), falls(snapped)).to_degrees() < 0.36);
        // A lattice direction is its own.
        let again = FallSlope::new(snapped / mean, mean).expect("near");
        prop_assert!((again.snapped_drift() - snapped).length() < 1e-9 * (1.0 + snapped.length()));
        let other = FallSlope::new(DVec2::new(x + turn, z - 3.0 * turn), mean).expect("inside the domain");
        let expected = reference::angle(falls(slope.drift()), falls(other.drift()));
        prop_assert!((slope.angle_to(&other) - expected).abs() < 1e-14);
    }

    #[test]
    fn in_calm_air_more_occluders_only_cover_more(seed in any::<u32>(), count in 1_u32..20) {
        let (few, many) = (shards(seed, count), shards(seed, count + 5));
        let (few, many) = (scene(&few, 0.25, [0.0; 2]), scene(&many, 0.25, [0.0; 2]));
        for i in 0..100 {
            let [x, y, z] = random(seed, i, 9);
            let point = DVec3::new(60.0 * x - 30.0, 6.0 * y, 60.0 * z - 30.0);
            let (less, more) = (few.covered(point, MEAN).expect("finite"), many.covered(point, MEAN).expect("finite"));
            prop_assert!(more || !less);
            // Lower on the same ray is no less covered.
            prop_assert!(many.covered(point - DVec3::Y, MEAN).expect("finite") || !more);
            prop_assert_eq!(few.slope(), &slope([0.0; 2]));
        }
    }
}
