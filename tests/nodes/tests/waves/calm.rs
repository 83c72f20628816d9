//! Tiles move without disturbing the water, and know when it is calm.

use rain_core::hash::{pcg3d, unit_f32};
use rain_core::waves::Push;
use rain_render::waves::{Disturbance, WaveTile, WaveTileSettings, water_depth_m};

use super::{Puddles, bare, largest};
use crate::device::device;
use crate::maps::read_map;

fn foot(x: f64, z: f64) -> Disturbance {
    Disturbance {
        from_m: [x, z],
        to_m: [x + 0.05, z],
        width_m: 0.06,
        push: Push::Impulse(1.5),
    }
}

/// Water everywhere but on a grid of posts.
fn posts(x: f64, z: f64) -> f32 {
    if x.rem_euclid(1.0) < 0.1 && z.rem_euclid(1.0) < 0.1 {
        0.0
    } else {
        (0.05 + 0.03 * (x + 0.5 * z).sin()) as f32
    }
}

#[test]
fn moving_keeps_the_overlap_bit_for_bit_and_stills_what_is_new() {
    let Some(gpu) = device() else { return };
    let mut puddles = Puddles::new(&gpu, &bare());
    puddles.tile.follow([0.0, 0.0], posts);
    puddles.frame(&gpu, 0, &[foot(0.1, 0.2), foot(-0.5, -0.4)]);
    for _ in 0..40 {
        puddles.frame(&gpu, puddles.tile.step_ns(), &[]);
    }
    let n = i64::from(bare().cells);
    for view in [[0.5, 0.0], [0.5, -0.9], [-0.4, 0.0]] {
        let (old, corner) = (puddles.heights(&gpu), puddles.tile.corner_m());
        assert!(puddles.tile.follow(view, posts));
        puddles.frame(&gpu, 0, &[]);
        let new = puddles.heights(&gpu);
        let cells = |axis: usize| ((puddles.tile.corner_m()[axis] - corner[axis]) / 0.025).round() as i64;
        let moved = [cells(0), cells(1)];
        assert!(moved.iter().all(|cells| cells % 16 == 0) && moved != [0, 0]);
        let mut kept = 0;
        for level in 0..2 {
            for j in 0..n {
                for i in 0..n {
                    let (k, l) = (i + moved[0], j + moved[1]);
                    let inside = (0..n).contains(&k) && (0..n).contains(&l);
                    let expected = if inside { old[level][(l * n + k) as usize] } else { 0.0 };
                    let found = new[level][(j * n + i) as usize];
                    assert_eq!(found.to_bits(), expected.to_bits(), "cell {i}, {j} after {moved:?}");
                    kept += u32::from(found != 0.0);
                }
            }
        }
        assert!(kept > 1000, "{kept}");
    }
    // Far away nothing is left; not a number is no place.
    assert!(!puddles.tile.follow([f64::NAN, 0.0], posts));
    assert!(puddles.tile.follow([500.0, 0.0], posts));
    puddles.frame(&gpu, 0, &[]);
    assert_eq!(largest(&puddles.heights(&gpu)[0]), 0.0);
}

#[test]
fn small_moves_of_the_view_move_nothing() {
    let mut tile = WaveTile::new(&WaveTileSettings::default()).unwrap();
    let mut asked = 0;
    let mut depth = |_: f64, _: f64| {
        asked += 1;
        0.05
    };
    assert!(tile.follow([0.0, 0.0], &mut depth));
    // 16 cells of 2.5 cm; a step of the tile at three quarters of that.
    for x in [0.1, 0.29, -0.29, 0.0] {
        assert!(!tile.follow([x, 0.0], &mut depth), "{x}");
    }
    assert!(tile.follow([0.31, 0.0], &mut depth));
    assert!(!tile.follow([0.15, 0.0], &mut depth));
    assert_eq!(asked, 256 * 256 + 16 * 256);
}

#[test]
fn the_bound_is_above_the_water_and_the_tile_falls_asleep() {
    let Some(gpu) = device() else { return };
    for (settings, moves) in [
        (
            WaveTileSettings {
                cells: 64,
                decay_per_s: 1.0,
                rim_cells: 0,
                ..Default::default()
            },
            false,
        ),
        (
            WaveTileSettings {
                cells: 64,
                decay_per_s: 1.0,
                rim_cells: 8,
                damping_per_s: 0.3,
                ..Default::default()
            },
            false,
        ),
        (
            WaveTileSettings {
                cells: 64,
                decay_per_s: 1.0,
                rim_cells: 0,
                snap_cells: 4,
                ..Default::default()
            },
            true,
        ),
    ] {
        let mut puddles = Puddles::new(&gpu, &settings);
        puddles.tile.follow([0.0, 0.0], posts);
        assert!(puddles.tile.is_calm() && !puddles.tile.wants_pass());
        let mut view = [0.0, 0.0];
        let mut frames = 0;
        let mut tightest = f64::INFINITY;
        while frames < 40 || !puddles.tile.is_calm() {
            let [x, z, what] = pcg3d([frames, 8, 1]).map(|h| f64::from(unit_f32(h)) - 0.5);
            if moves {
                view = [view[0] + 0.2 * x, view[1] + 0.2 * z];
                puddles.tile.follow(view, posts);
            }
            let mut push = foot(view[0] + x, view[1] + z);
            if what > 0.0 {
                push.push = Push::Height(0.002);
            }
            let pushes = if frames < 40 { vec![push] } else { Vec::new() };
            puddles.frame(&gpu, 16_666_667, &pushes);
            if frames % 20 == 5 {
                let highest = largest(&puddles.heights(&gpu)[0]);
                let bound = puddles.tile.bound().height_m();
                assert!(highest <= bound, "frame {frames}: {highest} above {bound}");
                tightest = tightest.min(bound / highest.max(1e-12));
            }
            frames += 1;
            assert!(frames < 60 * 120, "awake after two minutes");
        }
        eprintln!(
            "asleep after {:.0} s, bound at least {tightest:.1} times the water",
            f64::from(frames) / 60.0
        );
        // The last frame drew a flat map; from now on there is no pass.
        assert!(
            read_map(&gpu, &puddles.rig.map, 0)
                .iter()
                .all(|texel| *texel == [0.0; 4])
        );
        assert_eq!(largest(&puddles.heights(&gpu)[0]), 0.0);
        let passes = puddles.passes;
        for _ in 0..100 {
            puddles.frame(&gpu, 16_666_667, &[]);
            puddles.frame(&gpu, 16_666_667, &[foot(view[0] + 50.0, view[1])]);
        }
        assert_eq!(puddles.passes, passes);
        puddles.frame(&gpu, 16_666_667, &[foot(view[0] + 0.2, view[1])]);
        assert_eq!(puddles.passes, passes + 1);
    }
}

#[test]
fn a_cut_stills_the_water_with_one_last_pass() {
    let Some(gpu) = device() else { return };
    let mut puddles = Puddles::new(&gpu, &bare());
    puddles.tile.follow([0.0, 0.0], posts);
    for _ in 0..5 {
        puddles.frame(&gpu, 16_666_667, &[foot(0.3, 0.2)]);
    }
    assert!(largest(&puddles.heights(&gpu)[0]) > 1e-4);
    puddles.tile.reset();
    assert!(puddles.tile.is_calm() && puddles.tile.wants_pass());
    puddles.frame(&gpu, 16_666_667, &[]);
    assert_eq!(largest(&puddles.heights(&gpu)[0]), 0.0);
    assert!(
        read_map(&gpu, &puddles.rig.map, 3)
            .iter()
            .all(|texel| *texel == [0.0; 4])
    );
    assert!(!puddles.tile.wants_pass());
}

#[test]
fn ground_without_water_does_nothing() {
    let mut tile = WaveTile::new(&bare()).unwrap();
    assert!(tile.follow([0.0, 0.0], |x, z| water_depth_m(-1e9, x + z)));
    assert!(!tile.has_water());
    assert_eq!(tile.advance(50_000_000, &[foot(0.0, 0.0)]), Ok(0));
    assert!(!tile.wants_pass());
    tile.refill(|_, _| 0.02);
    assert!(tile.has_water());
    assert!(tile.advance(50_000_000, &[foot(0.0, 0.0)]).unwrap() > 0);
    // The puddle dries up under its waves.
    let mut frame = Default::default();
    tile.take(&mut frame);
    tile.refill(|_, _| f32::NAN);
    assert!(!tile.has_water() && tile.is_calm() && tile.wants_pass());
    for (level, ground, depth) in [
        (1.0, 0.9, 0.1),
        (1.0, 1.1, 0.0),
        (1.0, 0.9997, 0.0),
        (f64::NAN, 0.0, 0.0),
        (0.0, f64::NEG_INFINITY, 0.0),
    ] {
        assert!((water_depth_m(level, ground) - depth).abs() < 1e-6);
    }
}

#[test]
fn bad_settings_and_disturbances_are_refused() {
    let with = |change: fn(&mut WaveTileSettings)| {
        let mut settings = WaveTileSettings::default();
        change(&mut settings);
        WaveTile::new(&settings).unwrap_err().to_string()
    };
    for (message, field) in [
        (with(|s| s.cells = 100), "cells"),
        (with(|s| s.cells = 16), "cells"),
        (with(|s| s.cell_m = f64::NAN), "cell_m"),
        (with(|s| s.deepest_m = 0.0), "deepest_m"),
        (with(|s| s.damping_per_s = -1.0), "damping_per_s"),
        (with(|s| s.decay_per_s = f64::INFINITY), "decay_per_s"),
        (with(|s| s.rim_cells = 65), "rim_cells"),
        (with(|s| s.snap_cells = 3), "snap_cells"),
        (with(|s| s.tick_ns = 0), "tick_ns"),
    ] {
        assert!(message.starts_with(field), "{message}");
    }
    let mut tile = WaveTile::new(&WaveTileSettings::default()).unwrap();
    tile.follow([0.0, 0.0], |_, _| 0.05);
    let good = foot(0.0, 0.0);
    for bad in [
        Disturbance {
            from_m: [f64::NAN, 0.0],
            ..good
        },
        Disturbance {
            to_m: [0.0, f64::INFINITY],
            ..good
        },
        Disturbance { width_m: 0.0, ..good },
        Disturbance {
            push: Push::Height(f32::NAN),
            ..good
        },
        Disturbance {
            push: Push::Impulse(1e7),
            ..good
        },
    ] {
        assert!(tile.advance(1_000_000, &[good, bad]).is_err(), "{bad:?}");
    }
    assert!(tile.advance(1_000_000, &[good; 65]).is_err());
    assert!(tile.is_calm());
    assert!(tile.advance(1_000_000, &[good; 64]).is_ok());
    // A long stand-still is not caught up with.
    let mut frame = Default::default();
    tile.take(&mut frame);
    assert_eq!(tile.advance(u64::MAX / 2, &[]), Ok(32));
    assert_eq!(tile.advance(u64::MAX / 2, &[]), Ok(0));
}
