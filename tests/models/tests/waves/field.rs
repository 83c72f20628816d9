//! What a field promises whatever is in it: time, threads, symmetry, volume, sleep.

use proptest::prelude::*;
use rain_core::waves::{Border, Push, Stencil, SweptSource, WaveField, WaveSettings};

use super::{cases, peak, settings, started, total};

/// A bump off every symmetry.
fn bump(i: usize, j: usize) -> f64 {
    (-((i as f64 - 7.3).powi(2) + (j as f64 - 11.1).powi(2)) / 8.0).exp()
}

#[test]
fn settings_outside_their_domains_are_refused() {
    let good = WaveSettings::default();
    for (field, settings) in [
        ("cells_x", WaveSettings { cells_x: 3, ..good }),
        (
            "cells_z",
            WaveSettings {
                cells_z: 20_000,
                ..good
            },
        ),
        ("cell_m", WaveSettings { cell_m: 0.0, ..good }),
        (
            "cell_m",
            WaveSettings {
                cell_m: f64::NAN,
                ..good
            },
        ),
        (
            "speed_m_s",
            WaveSettings {
                speed_m_s: f64::INFINITY,
                ..good
            },
        ),
        (
            "damping_per_s",
            WaveSettings {
                damping_per_s: -1.0,
                ..good
            },
        ),
        ("tick_ns", WaveSettings { tick_ns: 0, ..good }),
        (
            "sponge_cells",
            WaveSettings {
                border: Border::Open { sponge_cells: 65 },
                ..good
            },
        ),
        (
            "sponge_cells",
            WaveSettings {
                border: Border::Open { sponge_cells: 8 },
                cells_x: 16,
                ..good
            },
        ),
        (
            "courant",
            WaveSettings {
                step_ns: Some(0),
                ..good
            },
        ),
        (
            "courant",
            WaveSettings {
                step_ns: Some(1_000_000_000),
                ..good
            },
        ),
    ] {
        let error = WaveField::new(&settings).expect_err(field).to_string();
        assert!(error.starts_with(&format!("{field} is ")), "{error}");
    }
}

#[test]
fn states_that_are_not_numbers_are_refused_and_change_nothing() {
    let mut field = started(&settings(16, 16, 0.5), bump);
    let before = field.heights().to_vec();
    let mut bad = vec![0.0; 256];
    for value in [f32::NAN, f32::INFINITY, -2e6] {
        bad[200] = value;
        assert!(
            field
                .set_state(&bad, &[])
                .expect_err("heights")
                .to_string()
                .starts_with("height_m is ")
        );
        assert!(
            field
                .set_state(&[], &bad)
                .expect_err("velocities")
                .to_string()
                .starts_with("velocity_m_s is ")
        );
        assert!(
            field
                .set_depths(&bad)
                .expect_err("depths")
                .to_string()
                .starts_with("depth_m is ")
        );
    }
    assert!(field.set_state(&[0.0; 3], &[]).is_err() && field.set_depths(&[0.0; 3]).is_err());
    assert_eq!(field.heights(), before);
}

#[test]
fn frames_of_any_length_end_alike() {
    let settings = WaveSettings {
        cells_x: 32,
        cells_z: 24,
        ..WaveSettings::default()
    };
    let total_ns = 700_000_000_u64;
    let after = |frames: &[u64]| {
        let mut field = started(&settings, bump);
        let mut steps = 0;
        let mut left = total_ns;
        for frame in frames.iter().cycle() {
            let elapsed = (*frame).min(left);
            steps += field.advance(elapsed);
            left -= elapsed;
            if left == 0 {
                break;
            }
        }
        (field.heights().to_vec(), steps)
    };
    let whole = after(&[total_ns]);
    assert!(whole.1 > 40);
    for frames in [
        &[16_666_667][..],
        &[33_333_333],
        &[6_944_444, 0, 100_000_000],
        &[2_000_000, 41_000_000],
    ] {
        assert_eq!(after(frames), whole);
    }
    let mut field = started(&settings, bump);
    assert_eq!(field.advance(0), 0);
    // Of a long pause a second is made up for.
    let most = (1.0 / field.step_s()) as u32;
    assert_eq!(field.advance(u64::MAX), most);
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let borders = [
        Border::Wall,
        Border::Fixed,
        Border::Periodic,
        Border::Open { sponge_cells: 10 },
    ];
    let size = 512 + 8;
    for (index, border) in borders.into_iter().enumerate() {
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .expect("threads");
            pool.install(|| {
                let base = settings(size, size, 0.65);
                let stencil = if index % 2 == 1 {
                    Stencil::NinePoint
                } else {
                    Stencil::FivePoint
                };
                let mut field = started(
                    &WaveSettings {
                        border,
                        stencil,
                        ..base
                    },
                    |i, j| ((i * i + 3 * j) % 17) as f64 * 0.1,
                );
                if index == 2 {
                    let depths: Vec<f32> = (0..size * size)
                        .map(|k| if k % 37 == 0 { 0.0 } else { 0.05 + (k % 5) as f32 * 0.01 })
                        .collect();
                    field.set_depths(&depths).expect("shallow enough");
                }
                field.step(11);
                field.heights().to_vec()
            })
        };
        let one = run(1);
        for threads in [2, 3, 7] {
            assert!(run(threads) == one, "{border:?} with {threads} threads");
        }
    }
}

#[test]
fn steps_and_sources_allocate_nothing() {
    let mut field = started(&settings(64, 64, 0.6), bump);
    let source = SweptSource {
        from_m: [20.0, 20.0],
        to_m: [26.0, 23.0],
        width_m: 2.0,
        push: Push::Impulse(1.0),
    };
    let drop = rain_core::waves::DropImpact {
        x_m: 30.0,
        z_m: 30.0,
        diameter_mm: 3.0,
        speed_m_s: 8.0,
    };
    let count = allocation_counter::measure(|| {
        field.add_drop(&drop).expect("finite");
        field.add_swept(&source).expect("finite");
        field.advance(900_000_000);
        field.step(600);
        field.set_step_ns(500_000_000).expect("below the bound");
        let _ = (field.energy(), field.is_calm(1e-9), field.take_volume_m3());
    });
    assert_eq!(count.count_total, 0);
}

#[test]
fn mirrored_and_turned_fields_stay_so() {
    let n = 24;
    let mut fields = [0, 1, 2].map(|kind| {
        started(&settings(n, n, 0.7), |i, j| match kind {
            0 => bump(i, j),
            1 => bump(n as usize - 1 - i, j),
            _ => bump(j, i),
        })
    });
    for field in &mut fields {
        field.step(300);
    }
    let n = n as usize;
    let [plain, mirrored, turned] = fields;
    for j in 0..n {
        for i in 0..n {
            let here = plain.heights()[j * n + i];
            assert_eq!(here, mirrored.heights()[j * n + n - 1 - i]);
            assert_eq!(here, turned.heights()[i * n + j]);
        }
    }
}

#[test]
fn a_shorter_step_keeps_the_velocity() {
    // Half the way with a long step, half with a short one: the same as the short one alone, to second order.
    let wave = |i: usize, _: usize| super::standing(64, 2, i);
    let mut changed = started(&settings(64, 4, 0.6), wave);
    changed.step(50);
    changed.set_step_ns(300_000_000).expect("below the bound");
    changed.step(100);
    let mut short = started(&settings(64, 4, 0.3), wave);
    short.step(200);
    let error = (f64::from(changed.heights()[0]) - f64::from(short.heights()[0])).abs();
    assert!(error < 2e-2, "{error}");
    // Kept by mistake, u⁻ doubles the velocity: that would be seen.
    let true_amplitude = (std::f64::consts::PI * 2.0 * 60.0 / 64.0).cos();
    assert!((f64::from(short.heights()[0]) / super::standing(64, 2, 0) - true_amplitude).abs() < 1e-2);
}

#[test]
fn a_quiet_pond_becomes_still_and_wakes() {
    let mut field = started(
        &WaveSettings {
            damping_per_s: 0.5,
            ..settings(32, 32, 0.7)
        },
        |i, j| 1e-3 * bump(i, j),
    );
    assert!(!field.is_calm(1e-6) && field.settle(1e-6).is_none());
    let volume = field.volume_m3();
    field.step(400);
    // The mean stays, so it is taken before the water can lie still.
    let taken = field.take_volume_m3();
    assert!((taken / volume - 1.0).abs() < 1e-9, "{taken} of {volume}");
    assert!(total(&field).abs() < 1e-6);
    field.step(400);
    assert!(field.is_calm(1e-6));
    let left = field.settle(1e-6).expect("calm");
    assert!(left.abs() < 1e-12 && field.is_still() && peak(&field) == 0.0);
    field.step(1_000_000_000);
    let source = SweptSource {
        from_m: [10.0, 10.0],
        to_m: [10.0, 10.0],
        width_m: 2.0,
        push: Push::Height(1e-3),
    };
    field.add_swept(&source).expect("finite");
    assert!(!field.is_still() && !field.is_calm(1e-6));
}

#[test]
fn tiny_heights_become_zero_instead_of_denormal() {
    let mut field = started(
        &WaveSettings {
            damping_per_s: 0.15,
            ..settings(32, 32, 0.7)
        },
        |i, j| 1e-15 * (bump(i, j) - bump(31 - i, j)),
    );
    for _ in 0..200 {
        field.step(1);
        assert!(field.heights().iter().all(|u| *u == 0.0 || u.abs() >= 1e-20));
    }
    field.step(400);
    // What is left is the mean, by the rounding of the start.
    field.take_volume_m3();
    field.step(400);
    assert!(peak(&field) < 1e-19, "{}", peak(&field));
}

#[test]
fn slopes_are_those_of_a_plane_and_one_sided_at_the_edge() {
    let field = started(&settings(8, 6, 0.5), |i, j| 0.25 * i as f64 - 0.5 * j as f64);
    let mut slopes = vec![[0.0; 2]; 48];
    field.write_slopes(&mut slopes);
    assert!(slopes.iter().all(|slope| *slope == [0.25, -0.5]), "{slopes:?}");
    // On a tile the plane has a cliff.
    let base = settings(8, 6, 0.5);
    let tile = started(
        &WaveSettings {
            border: Border::Periodic,
            ..base
        },
        |i, _| 0.25 * i as f64,
    );
    tile.write_slopes(&mut slopes);
    assert_eq!(slopes[0][0], (0.25 - 1.75) / 2.0);
    // Waves of 8, 16 and 32 cells around a tile: a tenth of the slope, then a quarter of that for each halving.
    let errors = [8_u32, 16, 32].map(|cells| {
        let k = std::f64::consts::TAU / f64::from(cells);
        let tile = WaveSettings {
            border: Border::Periodic,
            ..settings(cells, cells, 0.5)
        };
        let field = started(&tile, |i, j| (k * i as f64).sin() + (k * j as f64).cos());
        let mut slopes = vec![[0.0; 2]; (cells * cells) as usize];
        field.write_slopes(&mut slopes);
        (0..slopes.len()).fold(0.0_f64, |worst, index| {
            let [x, z] = [index % cells as usize, index / cells as usize].map(|i| k * i as f64);
            let [along, across] = slopes[index].map(f64::from);
            worst.max((along / k - x.cos()).abs()).max((across / k + z.sin()).abs())
        })
    });
    assert!(errors[0] < 0.1, "{errors:?}");
    for pair in errors.windows(2) {
        assert!((1.9..2.1).contains(&(pair[0] / pair[1]).log2()), "{errors:?}");
    }
}

proptest! {
    #![proptest_config(cases(48))]

    #[test]
    fn waves_add_up(a in -1.0_f64..1.0, b in -1.0_f64..1.0, courant in 0.1_f64..0.7, border in 0_usize..4) {
        let border = [Border::Wall, Border::Fixed, Border::Periodic, Border::Open { sponge_cells: 5 }][border];
        let settings = WaveSettings { border, damping_per_s: 0.02, ..settings(24, 20, courant) };
        let other = |i: usize, j: usize| (i as f64 * 0.9).sin() * (j as f64 * 0.7).cos();
        let end = |height: &dyn Fn(usize, usize) -> f64| {
            let mut field = started(&settings, height);
            field.step(120);
            field.heights().to_vec()
        };
        let both = end(&|i, j| a * bump(i, j) + b * other(i, j));
        let (one, two) = (end(&bump), end(&other));
        for ((both, one), two) in both.iter().zip(&one).zip(&two) {
            prop_assert!((f64::from(*both) - a * f64::from(*one) - b * f64::from(*two)).abs() < 2e-5);
        }
    }

    #[test]
    fn damping_never_adds_energy(
        damping in 0.0_f64..3.0, courant in 0.1_f64..0.7, seed: u32, nine: bool, dry in 0_u32..4,
    ) {
        let stencil = if nine { Stencil::NinePoint } else { Stencil::FivePoint };
        let settings = WaveSettings { damping_per_s: damping, stencil, ..settings(20, 20, courant) };
        let noise = |i: usize, j: usize| {
            f64::from(rain_core::hash::unit_f32(rain_core::hash::pcg(seed.wrapping_add((j * 20 + i) as u32)))) - 0.5
        };
        let mut field = started(&settings, noise);
        if !nine {
            let deepest = 1.0 / 9.80665;
            let depths: Vec<f32> = (0..400_u32)
                .map(|k| if k % 7 < dry { 0.0 } else { deepest * (0.1 + 0.9 * rain_core::hash::unit_f32(k * 31 + seed % 97)) })
                .collect();
            field.set_depths(&depths).expect("shallow enough");
        }
        let mut last = field.energy();
        for _ in 0..40 {
            field.step(3);
            let energy = field.energy();
            prop_assert!(energy <= last * (1.0 + 1e-5), "{energy} after {last}");
            last = energy;
        }
    }
}
