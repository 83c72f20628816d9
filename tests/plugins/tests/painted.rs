//! What artists paint, on the picture: margins, holes of a height map, dry places, mud, rings.

use bevy::mesh::VertexAttributeValues;
use bevy::prelude::*;
use rain_plugins::prelude::*;
use test_support::app::FRAME;
use test_support::gpu;

use crate::tiles::{PER_M, Tiles, distance, rough, stripes};

#[test]
fn the_parallax_map_holds_water_from_its_holes_up() {
    if !gpu::available() {
        return;
    }
    let mut tiles = Tiles::new([rough(0.5)]);
    // Depth is 1 - height: heights 1, 0.9, 0.8 and 0.
    let relief = stripes(&mut tiles.test, &[0, 26, 51, 255].map(|d| [d; 3]));
    let material = tiles.relief(rough(0.5), relief);
    tiles.put(0, material);
    tiles.put(
        0,
        PuddlePaint {
            show: ShowPaint::Water,
            ..default()
        },
    );
    // Linear shares, from sRGB pixels.
    let shares = |tiles: &mut Tiles| {
        let picture = tiles.test.picture();
        [0, 1, 2, 3].map(|i| {
            let x = 120.0 + PER_M * (i as f32 - 1.5) * 0.5;
            let v = f64::from(picture.get_pixel(x as u32, 30).0[1]) / 255.0;
            if v <= 0.04 {
                v / 12.92
            } else {
                ((v + 0.055) / 1.055).powf(2.4)
            }
        })
    };
    for (level, water) in [
        (0.05, [0.0, 0.05, 0.05, 0.05]),
        (0.5, [0.0, 0.1, 0.2, 0.5]),
        (1.0, [0.0, 0.1, 0.2, 1.0]),
    ] {
        tiles.levels([1.0, level, 0.0]);
        tiles.rain(20.0, 30);
        let found = shares(&mut tiles);
        // White never floods, small holes are drenched at most, a map held to 0.8 has a thin layer everywhere.
        let off = found.iter().zip(water).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 0.02, "level {level}: {found:?}, not {water:?}");
    }
}

#[test]
fn a_painted_margin_passes_smoothly_from_ground_to_water() {
    if !gpu::available() {
        return;
    }
    let mut tiles = Tiles::new([rough(0.5)]);
    // Green rises along x from 0 to 1 over the plate.
    let mesh = {
        let mut mesh = Plane3d::default().mesh().size(2.0, 2.0).subdivisions(20).build();
        let Some(VertexAttributeValues::Float32x3(positions)) = mesh.attribute(Mesh::ATTRIBUTE_POSITION) else {
            panic!("a plane has positions");
        };
        let colours: Vec<[f32; 4]> = positions.iter().map(|p| [1.0, 0.5 + 0.5 * p[0], 1.0, 1.0]).collect();
        mesh.insert_attribute(Mesh::ATTRIBUTE_COLOR, colours);
        tiles.test.world().resource_mut::<Assets<Mesh>>().add(mesh)
    };
    tiles.put(0, Mesh3d(mesh));
    tiles.test.world().insert_resource(WaterAppearance {
        turbidity_per_m: 400.0,
        mud_albedo: Vec3::new(0.05, 0.03, 0.01),
        ripple_strength: 0.0,
        ..default()
    });
    tiles.levels([1.0, 0.0, 0.5]);
    tiles.rain(20.0, 30);
    let mut row = |show: ShowPaint| {
        tiles.put(
            0,
            PuddlePaint {
                show,
                height_map: false,
                ..default()
            },
        );
        tiles.test.frames(4, FRAME);
        let picture = tiles.test.picture();
        (108..133)
            .map(|x| f64::from(picture.get_pixel(x, 30).0[1]))
            .collect::<Vec<_>>()
    };
    // Flood 0.5: water from 0.1 down, none from 0.5 up, linear between (from 1.6 to 11.6 px right of the left edge).
    let water = row(ShowPaint::Water);
    let place = |x: usize| (x as f64 + 0.5 - 12.0) / f64::from(PER_M) * 0.5 + 0.5;
    for (x, v) in water.iter().enumerate() {
        let green = place(x);
        let share = ((0.5 - green) / 0.4).clamp(0.0, 1.0);
        let linear = (v / 255.0).powf(2.2);
        assert!(
            (linear - share).abs() < 0.12,
            "{x}: green {green}, {linear}, not {share}"
        );
    }
    let surface = row(ShowPaint::Off);
    let range = surface[24] - surface[0];
    assert!(range > 20.0, "muddy water is darker than wet ground: {surface:?}");
    let step = surface.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0.0, f64::max);
    assert!(step < 0.45 * range, "no edge: {surface:?}");
}

#[test]
fn the_wet_level_and_two_flood_levels_control_the_surface() {
    if !gpu::available() {
        return;
    }
    let mut tiles = Tiles::new([rough(0.6), rough(0.6)]);
    tiles.test.world().insert_resource(WetLook::Lagarde);
    tiles.test.world().insert_resource(WaterAppearance {
        ripple_strength: 0.0,
        ..default()
    });
    // Left: a hole in the height map. Right: a painted puddle.
    let hole = stripes(&mut tiles.test, &[[255; 3]]);
    let material = tiles.relief(rough(0.6), hole);
    tiles.put(0, material);
    let black = tiles.painted([1.0, 0.0, 1.0, 1.0]);
    tiles.put(0, PuddlePaint::default());
    tiles.put(
        1,
        (
            PuddlePaint {
                height_map: false,
                ..default()
            },
            black,
        ),
    );
    tiles.test.frames(4, FRAME);
    let mut at = |levels: [f64; 3]| {
        tiles.rain(0.0, 60);
        tiles.levels(levels);
        tiles.rain(20.0, 30);
        tiles.seen()
    };
    let (dry, wet) = (at([0.0; 3]), at([1.0, 0.0, 0.0]));
    let (holes, puddles) = (at([0.0, 1.0, 0.0]), at([0.0, 0.0, 1.0]));
    let differs = |a: &[[f64; 3]], b: &[[f64; 3]]| [distance(a[0], b[0]) > 5.0, distance(a[1], b[1]) > 5.0];
    assert_eq!(differs(&dry, &wet), [true, true], "{dry:?} {wet:?}");
    assert_eq!(differs(&dry, &holes), [true, false], "{dry:?} {holes:?}");
    assert_eq!(differs(&dry, &puddles), [false, true], "{dry:?} {puddles:?}");
}

#[test]
fn painted_dry_places_stay_dry() {
    if !gpu::available() {
        return;
    }
    let mut tiles = Tiles::new([rough(0.5), rough(0.5)]);
    for (plate, blue) in [(0, 0.0_f32), (1, 1.0)] {
        let mesh = tiles.painted([1.0, 1.0, blue, 1.0]);
        tiles.put(plate, (mesh, PuddlePaint::default()));
    }
    tiles.test.frames(4, FRAME);
    let before = tiles.seen();
    tiles.rain(50.0, 60);
    let after = tiles.seen();
    assert!(distance(before[0], after[0]) < 1.0, "{before:?} {after:?}");
    assert!(distance(before[1], after[1]) > 15.0, "{before:?} {after:?}");
}

#[test]
fn puddles_break_the_repetition_of_tiles() {
    if !gpu::available() {
        return;
    }
    let mut tiles = Tiles::new([rough(0.5), rough(0.5)]);
    let material = tiles
        .test
        .world()
        .resource_mut::<Assets<StandardMaterial>>()
        .add(rough(0.5));
    for plate in 0..2 {
        tiles.put(plate, MeshMaterial3d(material.clone()));
    }
    tiles.test.world().insert_resource(WaterAppearance {
        turbidity_per_m: 400.0,
        mud_albedo: Vec3::new(0.05, 0.03, 0.01),
        ripple_strength: 0.0,
        ..default()
    });
    // Mean difference of the two tiles' patterns, pixel by pixel, each about its own mean.
    let apart = |tiles: &mut Tiles| {
        let picture = tiles.test.picture();
        let [a, b] = [0, 1].map(|plate| {
            let bright: Vec<f64> = tiles.pixels(&picture, plate).iter().map(|p| p[1]).collect();
            let mean = bright.iter().sum::<f64>() / bright.len() as f64;
            bright.into_iter().map(|v| v - mean).collect::<Vec<_>>()
        });
        a.iter().zip(&b).map(|(a, b)| (a - b).abs()).sum::<f64>() / a.len() as f64
    };
    tiles.rain(50.0, 60);
    let same = apart(&mut tiles);
    for plate in 0..2 {
        tiles.put(
            plate,
            NoisePuddles {
                size_m: 1.0,
                level: Some(0.8),
                height_map: false,
                ..default()
            },
        );
    }
    tiles.test.frames(4, FRAME);
    let broken = apart(&mut tiles);
    assert!(same < 2.0 && broken > 5.0, "{same} {broken}");
}

#[test]
fn muddy_water_shows_its_colour_the_more_the_deeper_it_is() {
    if !gpu::available() {
        return;
    }
    let mut tiles = Tiles::new([rough(0.02)]);
    tiles.test.world().insert_resource(WaterAppearance {
        absorption_per_m: Vec3::ZERO,
        turbidity_per_m: 60.0,
        mud_albedo: Vec3::new(0.5, 0.25, 0.05),
        ..default()
    });
    // Alpha 0: a puddle that is always there.
    let mesh = tiles.painted([1.0, 1.0, 1.0, 0.0]);
    tiles.put(0, mesh);
    let mut seen = Vec::new();
    for depth_m in [0.001, 0.004, 0.015, 0.3] {
        tiles.put(
            0,
            PuddlePaint {
                fixed: true,
                depth_m,
                height_map: false,
                ..default()
            },
        );
        tiles.test.frames(4, FRAME);
        seen.push(tiles.seen()[0]);
    }
    // Dark ground, bright mud: every depth is brighter than the one before, and redder until the mud is all that is seen.
    for (i, pair) in seen.windows(2).enumerate() {
        assert!(pair[1][0] > pair[0][0] + 5.0, "{seen:?}");
        let redder = (pair[1][0] - pair[1][2]) - (pair[0][0] - pair[0][2]);
        assert!(i == 2 || redder > 10.0, "{seen:?}");
    }
    let deep = seen[3];
    assert!(
        deep[0] > deep[1] + 20.0 && deep[1] > deep[2] + 20.0,
        "the mud's own colour: {seen:?}"
    );
}

#[test]
fn rings_show_on_painted_puddles_where_red_lets_them() {
    if !gpu::available() {
        return;
    }
    let mut tiles = Tiles::new([rough(0.1)]);
    // In the mirror image of the light: rings throw glints, which come and go.
    tiles.test.look(Vec3::new(0.3, 1.0, -0.4) * 4.0, Vec3::ZERO);
    let mut moved = Vec::new();
    for red in [0.0_f32, 1.0] {
        let mesh = tiles.painted([red, 1.0, 1.0, 0.0]);
        tiles.put(
            0,
            (
                mesh,
                PuddlePaint {
                    fixed: true,
                    height_map: false,
                    ..default()
                },
            ),
        );
        tiles.rain(50.0, 60);
        assert!(
            tiles.test.recorded(PassName::Ripples) > 0,
            "painted water is water enough for the tile of rings"
        );
        let first = tiles.test.picture();
        tiles.test.frames(8, FRAME);
        let then = tiles.test.picture();
        let places = (16..44).flat_map(|y| (106..134).map(move |x| (x, y)));
        let changes = places.map(|(x, y)| {
            let [a, b] = [&first, &then].map(|picture| f64::from(picture.get_pixel(x, y).0[1]));
            (a - b).abs()
        });
        moved.push(changes.sum::<f64>() / (28.0 * 28.0));
    }
    assert_eq!(moved[0], 0.0, "still water without rings");
    assert!(moved[1] > 1.0, "{moved:?}");
}
