//! Triangles: the drawn field against a search over all triangles for each cell.

use glam::DVec3;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rain_core::hash::{pcg3d, unit_f32};
use rain_core::surface::height_field::{GridFrame, HeightField, ImportLimits, TriangleRaster};
use rain_reference::height_field::highest;

use super::{LIMITS, refused};
use crate::check::Worst;

type Triangle = [DVec3; 3];

/// `count` triangles of about `size` m in a box of `extent` m from `corner`.
fn soup(seed: u32, count: u32, corner: DVec3, extent: f64, size: f64) -> Vec<Triangle> {
    let r = |n: u32, k: u32| DVec3::from_array(pcg3d([seed, n, k]).map(|v| f64::from(unit_f32(v))));
    (0..count)
        .map(|n| {
            let middle = corner + r(n, 0) * DVec3::new(extent, 0.2 * extent, extent);
            [1, 2, 3].map(|k| middle + (r(n, k) - 0.5) * DVec3::new(size, 0.3 * size, size))
        })
        .collect()
}

fn plain(triangles: &[Triangle]) -> Vec<rain_reference::height_field::Triangle> {
    triangles.iter().map(|t| t.map(|p| p.to_array())).collect()
}

/// Compares every cell; centres within 2⁻¹³ of a cell of an edge may fall on either side of it.
fn compare(field: &HeightField, triangles: &[Triangle], scale: f64) -> Worst {
    let plain = plain(triangles);
    let mut worst = Worst::default();
    let mut doubtful = 0;
    let [nx, nz] = field.cells();
    let grow = field.cell_m() / 8192.0;
    for row in 0..nz {
        for column in 0..nx {
            let [x, z] = field.frame().centre_m(column, row);
            let [inner, outer] = [-grow, grow].map(|grow| highest(&plain, x, z, grow));
            let found = field.heights()[row * nx + column];
            if inner.to_bits() != outer.to_bits() {
                doubtful += 1;
                continue;
            }
            if inner.is_nan() {
                worst.absolute(f64::from(u8::from(!found.is_nan())), 0.0, || {
                    format!("hole at {column}, {row}")
                });
            } else {
                worst.absolute(found * scale, inner, || format!("{column}, {row}: {found} for {inner}"));
            }
        }
    }
    assert!(doubtful * 50 < nx * nz, "{doubtful} cells lie on edges");
    worst
}

#[test]
fn heights_match_a_search_over_all_triangles() {
    for (seed, count, extent, size, cell) in [
        (1, 400, 20.0, 3.0, 0.25),
        (2, 60, 20.0, 30.0, 0.1),
        (3, 3000, 20.0, 0.5, 0.3),
        (4, 50, 4000.0, 2000.0, 37.0),
        (5, 200, 0.02, 0.01, 0.0003),
    ] {
        let triangles = soup(seed, count, DVec3::ZERO, extent, size);
        let (field, left_out) = HeightField::from_triangles(&triangles, cell, &LIMITS).expect("a field");
        assert!(
            left_out.not_up > count as usize / 3 && left_out.not_finite == 0,
            "{left_out}"
        );
        compare(&field, &triangles, 1.0).assert_below(1e-9, 1000);
        let wrong = compare(&field, &triangles, 1.05);
        assert!(
            std::panic::catch_unwind(|| wrong.assert_below(1e-9, 1000)).is_err(),
            "a wrong field would be seen"
        );
    }
}

#[test]
fn far_from_the_origin_nothing_is_lost() {
    let corner = DVec3::new(1e6, 300.0, -2e6);
    let triangles = soup(6, 300, corner, 20.0, 3.0);
    let (field, _) = HeightField::from_triangles(&triangles, 0.25, &LIMITS).expect("a field");
    // A coordinate of 2e6 m is known to 2e-10 m, slopes go up to ten and more.
    compare(&field, &triangles, 1.0).assert_below(1e-7, 1000);
}

/// Ground over the knots of a grid of `n` × `n` squares with the side `step`, two triangles each.
fn terrain(n: u32, step: f64, height: impl Fn(f64, f64) -> f64) -> Vec<Triangle> {
    let p = |i: u32, j: u32| {
        let (x, z) = (f64::from(i) * step, f64::from(j) * step);
        DVec3::new(x, height(x, z), z)
    };
    let mut triangles = Vec::new();
    for j in 0..n {
        for i in 0..n {
            let [a, b, c, d] = [p(i, j), p(i, j + 1), p(i + 1, j), p(i + 1, j + 1)];
            triangles.extend([[a, b, c], [c, b, d]]);
        }
    }
    triangles
}

#[test]
fn closed_ground_has_no_gaps_at_shared_edges() {
    // Knots, edges and diagonals through cell centres, and a turned copy where nothing is aligned.
    for (cell, turn) in [(0.5, 0.0), (1.0 / 3.0, 0.0), (0.1, 0.0), (0.1, 0.3), (0.7, 1.1)] {
        let (sin, cos) = f64::sin_cos(turn);
        let triangles: Vec<Triangle> = terrain(20, 0.5, |x, z| 0.1 * x + 0.05 * z)
            .into_iter()
            .map(|t| t.map(|p| DVec3::new(p.x * cos + p.z * sin, p.y, p.z * cos - p.x * sin)))
            .collect();
        let (field, left_out) = HeightField::from_triangles(&triangles, cell, &LIMITS).expect("a field");
        assert_eq!(left_out.not_up, 0);
        let mut inside = 0;
        let [nx, nz] = field.cells();
        for row in 0..nz {
            for column in 0..nx {
                let [x, z] = field.frame().centre_m(column, row);
                // Back in the square's own axes.
                let (u, v) = (x * cos - z * sin, x * sin + z * cos);
                let deep = |v: f64| v > 0.001 && v < 9.999;
                if deep(u) && deep(v) {
                    let h = field.heights()[row * nx + column];
                    assert!((h - 0.1 * u - 0.05 * v).abs() < 1e-9, "{u} {v}: {h}");
                    inside += 1;
                }
            }
        }
        let expected = 100.0 / (cell * cell);
        assert!(f64::from(inside) > 0.8 * expected, "{inside} of {expected}");
    }
}

#[test]
fn corners_at_cell_centres_give_their_own_heights() {
    let bumps = |x: f64, z: f64| (7.0 * x).sin() + (3.0 * z).cos();
    let triangles = terrain(30, 0.1, bumps);
    let frame = GridFrame::new([29, 29], 0.1, [0.05, 0.05], &LIMITS).expect("a frame");
    let mut raster = TriangleRaster::new(frame);
    triangles.into_iter().for_each(|t| raster.add(t).expect("drawn"));
    let field = raster.finish().expect("a field");
    for row in 0..29 {
        for column in 0..29 {
            let [x, z] = field.frame().centre_m(column, row);
            let h = field.height(column, row).expect("inside");
            assert!((h - bumps(x, z)).abs() < 1e-12, "{column}, {row}");
        }
    }
}

#[test]
fn only_what_faces_up_counts_and_the_highest_wins() {
    let square = |y: f64| {
        let p = |x: f64, z: f64| DVec3::new(x, y, z);
        [
            [p(0.0, 0.0), p(0.0, 2.0), p(2.0, 0.0)],
            [p(2.0, 0.0), p(0.0, 2.0), p(2.0, 2.0)],
        ]
    };
    let down = |t: Triangle| [t[0], t[2], t[1]];
    let upright = [DVec3::ZERO, DVec3::new(2.0, 0.0, 0.0), DVec3::new(2.0, 9.0, 0.0)];
    let point = [DVec3::ONE; 3];
    let mut triangles = vec![upright, point];
    triangles.extend(square(1.0));
    triangles.extend(square(3.0).map(down));
    triangles.extend(square(2.0));
    let (field, left_out) = HeightField::from_triangles(&triangles, 0.5, &LIMITS).expect("a field");
    assert!(field.heights().iter().all(|h| *h == 2.0));
    assert_eq!((left_out.not_up, left_out.not_finite, left_out.outside), (4, 0, 0));
    refused(
        HeightField::from_triangles(&square(1.0).map(down), 0.5, &LIMITS),
        &["no triangle faces up", "2 triangles face down"],
    );
    refused(
        HeightField::from_triangles(&[], 0.5, &LIMITS),
        &["no triangle faces up"],
    );
}

#[test]
fn broken_triangles_are_left_out_and_counted() {
    let mut triangles = terrain(4, 1.0, |_, _| 1.0);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e8] {
        for axis in 0..3 {
            let mut t = triangles[0];
            t[1][axis] = bad;
            triangles.push(t);
        }
    }
    let (field, left_out) = HeightField::from_triangles(&triangles, 0.5, &LIMITS).expect("a field");
    assert_eq!(left_out.not_finite, 12);
    assert!(field.cells() == [8, 8] && field.heights().iter().all(|h| *h == 1.0));
}

#[test]
fn too_much_is_refused() {
    let triangles = terrain(4, 1.0, |_, _| 1.0);
    let few = ImportLimits {
        triangles: 31,
        ..LIMITS
    };
    refused(
        HeightField::from_triangles(&triangles, 0.5, &few),
        &["more than 31 triangles"],
    );
    refused(
        HeightField::from_triangles(&triangles, 0.0003, &LIMITS),
        &["13334 × 13334", "67108864"],
    );
    // A plane without end over a small grid.
    let frame = GridFrame::new([8, 8], 0.01, [0.0; 2], &LIMITS).expect("a frame");
    let mut raster = TriangleRaster::new(frame);
    let far = 1e6;
    let plane = [
        DVec3::new(-far, 0.0, -far),
        DVec3::new(-far, 0.0, far),
        DVec3::new(far, 0.0, -far),
    ];
    refused(raster.add(plane), &["cells from the grid's corner", "65536"]);
    let beside = plane.map(|p| p + DVec3::new(3.0 * far, 0.0, 0.0));
    raster.add(beside).expect("it lies outside");
    assert_eq!(raster.left_out().outside, 1);
    assert_eq!(raster.finish().expect("a field").holes(), 64);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, rng_seed: RngSeed::Fixed(5), ..ProptestConfig::default() })]

    /// Order does not matter, more triangles never lower the ground, and a height lies between its corners'.
    #[test]
    fn drawing_is_a_maximum(seed in 0_u32..10_000, count in 2_u32..60, cell in 0.05..2.0_f64) {
        let triangles = soup(seed, count, DVec3::new(-3.0, 1.0, 2.0), 8.0, 4.0);
        prop_assume!(triangles.iter().any(|t| (t[1] - t[0]).cross(t[2] - t[0]).y > 1e-6));
        let (field, _) = HeightField::from_triangles(&triangles, cell, &LIMITS).expect("a field");
        let mut raster = TriangleRaster::new(*field.frame());
        for t in triangles.iter().rev() {
            // Starting at another corner changes nothing but the last bits.
            raster.add([t[1], t[2], t[0]]).expect("drawn");
        }
        let turned = raster.finish().expect("a field");
        let mut part = TriangleRaster::new(*field.frame());
        triangles.iter().step_by(2).for_each(|t| part.add(*t).expect("drawn"));
        let part = part.finish().expect("a field");
        let top = triangles.iter().flatten().map(|p| p.y).fold(f64::MIN, f64::max);
        for ((a, b), c) in field.heights().iter().zip(turned.heights()).zip(part.heights()) {
            prop_assert_eq!(a.is_nan(), b.is_nan());
            prop_assert!(a.is_nan() || (a - b).abs() < 1e-9);
            prop_assert!(c.is_nan() || c <= a);
            prop_assert!(a.is_nan() || *a <= top);
        }
    }

    /// A scene moved by a power of two is drawn the same.
    #[test]
    fn a_moved_scene_gives_the_same_heights(seed in 0_u32..10_000, shift in -64_i32..64) {
        let triangles: Vec<Triangle> = soup(seed, 40, DVec3::ZERO, 8.0, 4.0)
            .into_iter()
            .map(|t| t.map(|p| (p * 1024.0).round() / 1024.0))
            .collect();
        let by = DVec3::new(f64::from(shift), 0.0, 2.0 * f64::from(shift));
        let moved: Vec<Triangle> = triangles.iter().map(|t| t.map(|p| p + by)).collect();
        let (a, _) = HeightField::from_triangles(&triangles, 0.25, &LIMITS).expect("a field");
        let (b, _) = HeightField::from_triangles(&moved, 0.25, &LIMITS).expect("a field");
        prop_assert_eq!(a.cells(), b.cells());
        for (x, y) in a.heights().iter().zip(b.heights()) {
            prop_assert!(x.is_nan() == y.is_nan() && (x.is_nan() || (x - y).abs() < 1e-9));
        }
    }
}
