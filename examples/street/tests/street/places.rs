//! What the layout promises is there: hollows that hold water, roofs that cover, open sky where it is open.

use crate::scene::{first_hit, street_scene};
use glam::Vec3;
use std::collections::BinaryHeap;
use street::layout::{
    ARCADE_CEILING_Y, ARCADE_COLUMN, ARCADE_DEPTH, ARCADE_FLOOR_Y, ARCADE_Z, FACADE_X, KERB_HEIGHT, KERB_WIDTH,
    ROAD_HALF_WIDTH, ROOM_MAX, ROOM_MIN, SHELTER_X, SHELTER_Y, SHELTER_Z,
};

/// Height of the mesh under (x, z), looking down from 1 m.
fn height(near: &[&crate::scene::Triangle], x: f32, z: f32) -> f32 {
    let (d, _) = first_hit(near.iter().copied(), Vec3::new(x, 1.0, z), Vec3::NEG_Y, 3.0).expect("ground");
    1.0 - d
}

/// Depth of the water that stands at the middle of a square of ground before it runs over the square's border: the lowest
/// of all highest points on the ways out (Dijkstra 1959 with the maximum in place of the sum).
fn ponding(heights: &[f32], n: usize) -> f32 {
    let key = |h: f32| (h * 1e6).round() as i64;
    let start = (n / 2) * n + n / 2;
    let mut level = vec![i64::MAX; n * n];
    let mut heap = BinaryHeap::new();
    level[start] = key(heights[start]);
    heap.push((-level[start], start));
    while let Some((minus, k)) = heap.pop() {
        let (i, j) = (k % n, k / n);
        if i == 0 || j == 0 || i == n - 1 || j == n - 1 {
            return (-minus - key(heights[start])) as f32 * 1e-6;
        }
        for m in [k - 1, k + 1, k - n, k + n, k - n - 1, k - n + 1, k + n - 1, k + n + 1] {
            let over = (-minus).max(key(heights[m]));
            if over < level[m] {
                level[m] = over;
                heap.push((-over, m));
            }
        }
    }
    unreachable!("a square has a border")
}

fn pond_at(x: f32, z: f32, half: f32) -> f32 {
    let near = street_scene().near(x, z, half + 0.2);
    let n = 2 * (half / 0.06).ceil() as usize + 1;
    let step = 2.0 * half / (n - 1) as f32;
    let at = |k: usize| -half + step * k as f32;
    let heights: Vec<f32> = (0..n * n)
        .map(|k| height(&near, x + at(k % n), z + at(k / n)))
        .collect();
    // The lowest point need not be the middle: on a slope it moves downhill. Start where it is deepest.
    let lowest = (0..n * n)
        .filter(|k| {
            let (dx, dz) = (at(k % n), at(k / n));
            dx * dx + dz * dz < 0.3 * half * half
        })
        .min_by(|a, b| heights[*a].total_cmp(&heights[*b]))
        .expect("points");
    let (ci, cj) = (lowest % n, lowest / n);
    let m = 2 * ci.min(cj).min(n - 1 - ci).min(n - 1 - cj) + 1;
    let cut: Vec<f32> = (0..m * m)
        .map(|k| heights[(cj - m / 2 + k / m) * n + ci - m / 2 + k % m])
        .collect();
    ponding(&cut, m)
}

#[test]
fn hollows_hold_water() {
    for h in street::layout().hollows {
        let [x, z] = h.centre;
        let pond = pond_at(x, z, h.radius + 0.35);
        // The fall of the ground takes a part of the nominal depth; at least 4 mm of water stay in each.
        assert!(
            pond > 0.004 && pond < h.depth + 0.012,
            "hollow at {x}, {z}: {} mm",
            pond * 1e3
        );
    }
    // Between the hollows, beside the ruts, water runs off.
    for (x, z) in [(1.75, -24.0), (-1.75, 12.5), (0.5, -19.0)] {
        let pond = pond_at(x, z, 0.4);
        assert!(
            pond < 0.002,
            "{} mm of water stand on the open road at {x}, {z}",
            pond * 1e3
        );
    }
}

#[test]
fn the_mesh_is_the_ground_that_the_layout_gives() {
    let layout = street::layout();
    for k in 0..400_u32 {
        let u = |c: u32| street::noise::lattice(k, c as i32, 3);
        let (x, z) = (-3.45 + 6.9 * u(0), -34.0 + 68.0 * u(1));
        let near = street_scene().near(x, z, 0.05);
        let (mesh, formula) = (height(&near, x, z), layout.ground_height(x, z));
        // Cells of 25 cm cut the corners of the hollows' bell by at most 3 mm.
        assert!((mesh - formula).abs() < 0.003, "at {x}, {z}: {mesh} {formula}");
    }
}

#[test]
fn road_falls_to_the_gutters_and_kerbs_stand_above_them() {
    let layout = street::layout();
    for z in [-20.5_f32, -12.0, 0.0, 8.0, 16.0, 24.0] {
        for side in [1.0_f32, -1.0] {
            let at = |x: f32| layout.ground_height(x * side, z);
            assert!(at(0.0) - at(3.1) > 0.045, "cross fall at z = {z}");
            let near = street_scene().near(ROAD_HALF_WIDTH * side, z, 0.3);
            let kerb =
                height(&near, (ROAD_HALF_WIDTH + 0.1) * side, z) - height(&near, (ROAD_HALF_WIDTH - 0.01) * side, z);
            assert!((kerb - KERB_HEIGHT).abs() < 0.006, "kerb of {kerb} m at z = {z}");
            assert!(
                at(FACADE_X - 0.05) > at(ROAD_HALF_WIDTH + 0.2),
                "the pavement falls to the kerb"
            );
        }
    }
}

#[test]
fn no_ray_slips_through_the_seam_of_kerb_and_pavement() {
    let layout = street::layout();
    let x = ROAD_HALF_WIDTH + KERB_WIDTH;
    for k in 0..1500_u32 {
        let z = -34.0 + 68.0 * street::noise::lattice(k, 0, 3);
        let side = if k % 2 == 0 { 1.0 } else { -1.0 };
        let near = street_scene().near(x * side, z, 0.3);
        let edge = layout.ground_height((x + 1e-4) * side, z);
        for millimetres in -3_i8..4 {
            let seam = Vec3::new(x * side, edge + 1e-3 * f32::from(millimetres), z);
            let eye = seam + Vec3::new(-0.2 * side, 0.05, 0.0);
            let hit = first_hit(near.iter().copied(), eye, (seam - eye).normalize(), 1.0);
            let distance = hit.map_or(f32::INFINITY, |(d, _)| d);
            assert!(distance < 0.24, "at {seam}: {distance} m");
        }
    }
}

#[test]
fn drains_are_grates_at_the_gutters() {
    let scene = street_scene();
    let grate = scene.material_named("grate");
    for [x, y, z] in street::layout().drains {
        let near = scene.near(x, z, 0.1);
        let (d, t) = first_hit(near.into_iter(), Vec3::new(x, 1.0, z), Vec3::NEG_Y, 2.0).expect("ground");
        assert_eq!(t.material, grate);
        assert!((1.0 - d - y).abs() < 0.003);
    }
}

#[test]
fn the_arcade_is_covered_and_the_road_is_not() {
    let scene = street_scene();
    const { assert!(ARCADE_DEPTH >= 3.0 && ARCADE_Z[1] - ARCADE_Z[0] >= 12.0) };
    for i in 0..12 {
        for j in 0..6 {
            // Clear of the shop windows' sills, which stand before the back wall.
            let x = FACADE_X + ARCADE_COLUMN + 0.1 + (ARCADE_DEPTH - ARCADE_COLUMN - 0.6) * (i as f32 / 11.0);
            let z = ARCADE_Z[0] + 0.5 + (ARCADE_Z[1] - ARCADE_Z[0] - 1.1) * (j as f32 / 5.0);
            let near = scene.near(x, z, 0.2);
            let floor = height(&near, x, z);
            assert!((floor - ARCADE_FLOOR_Y).abs() < 0.001, "floor at {x}, {z}: {floor}");
            let up = Vec3::new(x, floor + 0.05, z);
            let (d, _) = first_hit(near.iter().copied(), up, Vec3::Y, 10.0).expect("a ceiling");
            assert!(up.y + d <= ARCADE_CEILING_Y + 0.001, "ceiling at {}", up.y + d);
        }
    }
    for (x, z) in [(0.0, 0.0), (-1.0, 15.0), (2.0, -25.0), (1.0, 30.0)] {
        assert!(
            scene.hit(Vec3::new(x, 0.1, z), Vec3::Y, 100.0).is_none(),
            "the road is covered at {x}, {z}"
        );
    }
}

#[test]
fn the_room_is_closed() {
    let scene = street_scene();
    let (low, high) = (Vec3::from(ROOM_MIN), Vec3::from(ROOM_MAX));
    let eye = street::layout().view("room").expect("a camera").eye;
    assert!(Vec3::from(eye).cmpgt(low).all() && Vec3::from(eye).cmplt(high).all());
    for start in [Vec3::from(eye), 0.5 * (low + high)] {
        for k in 0..200 {
            let y = 1.0 - 2.0 * (k as f32 + 0.5) / 200.0;
            let (r, a) = ((1.0 - y * y).sqrt(), 2.399_963 * k as f32);
            let (d, t) = scene
                .hit(start, Vec3::new(r * a.cos(), y, r * a.sin()), 20.0)
                .expect("a wall");
            assert!(d < low.distance(high));
            let hit = t.corners.iter().sum::<Vec3>() / 3.0;
            assert!(
                hit.cmpgt(low - 0.01).all() && hit.cmplt(high + 0.01).all(),
                "a ray left the room: {hit}"
            );
        }
    }
}

#[test]
fn the_shelter_has_a_roof_and_open_sides() {
    let scene = street_scene();
    for (i, j) in [(0.25, 0.1), (0.5, 0.5), (0.95, 0.97), (0.3, 0.8), (0.02, 0.02)] {
        let x = SHELTER_X[0] + (SHELTER_X[1] - SHELTER_X[0]) * i;
        let z = SHELTER_Z[0] + (SHELTER_Z[1] - SHELTER_Z[0]) * j;
        let (d, _) = scene.hit(Vec3::new(x, 1.9, z), Vec3::Y, 10.0).expect("a roof");
        assert!((1.9 + d - SHELTER_Y).abs() < 0.04, "roof at {}", 1.9 + d);
    }
    let inside = Vec3::new(-5.0, 1.6, -9.0);
    assert!(
        scene.hit(inside, Vec3::X, 4.0).is_none(),
        "the side to the road is open"
    );
    assert!(scene.hit(inside, Vec3::NEG_X, 4.0).is_some(), "the back is glass");
}

#[test]
fn eaves_are_where_the_layout_says() {
    let scene = street_scene();
    let eaves = street::layout().eaves;
    assert!(eaves.len() > 20);
    for e in eaves {
        let (from, to) = (Vec3::from(e.from), Vec3::from(e.to));
        let out = (to - from).normalize().cross(Vec3::Y);
        let middle = from.lerp(to, 0.47);
        let under = middle - out * 0.12 - Vec3::Y * 0.12;
        let near = scene.near(under.x, under.z, 0.05);
        let (d, _) = first_hit(near.iter().copied(), under, Vec3::Y, 1.0).expect("a soffit");
        assert!(
            (under.y + d - from.y).abs() < 0.002,
            "eaves at {} instead of {}",
            under.y + d,
            from.y
        );
        // A metre further out the sky is open or far above.
        let free = middle + out * 1.0;
        assert!(first_hit(scene.near(free.x, free.z, 0.05).into_iter(), free, Vec3::Y, 1.0).is_none());
    }
}

#[test]
fn awnings_cover_the_pavement() {
    let awnings = street::layout().awnings;
    assert!(awnings.len() >= 3);
    for a in awnings {
        let (low, high) = (Vec3::from(a.min), Vec3::from(a.max));
        let p = 0.5 * (low + high);
        let (d, _) = street_scene()
            .hit(Vec3::new(p.x, 1.5, p.z), Vec3::Y, 3.0)
            .expect("cloth");
        assert!(
            (low.y - 0.001..=high.y + 0.001).contains(&(1.5 + d)),
            "cloth at {}",
            1.5 + d
        );
    }
}

#[test]
fn crowns_fill_the_ellipsoids_of_the_layout() {
    let scene = street_scene();
    for tree in street::layout().trees {
        scene.node(&format!("{}-crown", tree.name));
        scene.node(&format!("{}-wood", tree.name));
        let [across, up] = tree.crown_half_axes();
        let centre = Vec3::from(tree.crown_centre());
        assert!((1.8..=3.6).contains(&across), "crown of {} m", 2.0 * across);
        let half = Vec3::new(across, up, across);
        let leaves = scene
            .triangles
            .iter()
            .filter(|t| scene.masked[t.material])
            .map(|t| t.corners.iter().sum::<Vec3>() / 3.0);
        let near: Vec<f32> = leaves
            .map(|p| ((p - centre) / half).length())
            .filter(|r| *r < 1.6)
            .collect();
        let inside = near.iter().filter(|r| **r < 1.12).count();
        assert!(near.len() > 900, "{}: {} leaf triangles", tree.name, near.len());
        assert!(
            inside as f32 > 0.93 * near.len() as f32,
            "{}: {inside} of {} within the crown",
            tree.name,
            near.len()
        );
    }
}
