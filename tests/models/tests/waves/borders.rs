//! Walls, fixed and open borders, shores and obstacles.

use proptest::prelude::*;
use rain_core::waves::{Border, Stencil, WaveField, WaveSettings};

use super::{cases, peak, settings, started, total};

const DEEPEST: f32 = 1.0 / 9.80665;

/// A ridge across the rows, of standard deviation 5 cells.
fn ridge(middle: f64) -> impl Fn(usize, usize) -> f64 {
    move |i, _| (-0.02 * (i as f64 - middle).powi(2)).exp()
}

/// Largest height along the middle row.
fn middle_row(field: &WaveField) -> f64 {
    let settings = field.settings();
    let (nx, nz) = (settings.cells_x as usize, settings.cells_z as usize);
    let row = &field.heights()[nz / 2 * nx..][..nx];
    row.iter().fold(0.0, |max, u| max.max(f64::from(u.abs())))
}

#[test]
fn an_open_border_reflects_a_fifth_of_a_per_cent() {
    for (courant, share) in [(0.5, 0.0017), (0.7, 0.0012)] {
        let base = settings(81, 321, courant);
        let border = Border::Open { sponge_cells: 0 };
        let mut field = started(&WaveSettings { border, ..base }, ridge(40.0));
        // The two halves of the ridge have gone 62 cells: 40 out, 22 back.
        field.step((62.0 / courant) as u32);
        let reflected = middle_row(&field) / 0.5;
        assert!((reflected / share - 1.0).abs() < 0.15, "C {courant}: {reflected}");
        // A wall gives everything back.
        let mut wall = started(&base, ridge(40.0));
        wall.step((62.0 / courant) as u32);
        assert!(middle_row(&wall) > 0.45);
    }
}

#[test]
fn a_sponge_makes_grazing_waves_leave() {
    // A round wave in a channel meets its sides at all angles up to 70°; the same on a field so wide that nothing comes
    // back.
    let bump = |x: f64, z: f64| {
        move |i: usize, j: usize| {
            let r2 = (i as f64 - x).powi(2) + (j as f64 - z).powi(2);
            (r2 / 4.0 - 2.0) * (-r2 / 8.0).exp()
        }
    };
    let steps = 200;
    let mut wide = started(&settings(257, 321, 0.65), bump(128.0, 160.0));
    wide.step(steps);
    let left = |sponge_cells: u32| {
        let border = Border::Open { sponge_cells };
        let base = settings(97, 321, 0.65);
        let mut field = started(&WaveSettings { border, ..base }, bump(48.0, 160.0));
        field.step(steps);
        let (mut error, mut norm) = (0.0, 0.0);
        for j in 24..297 {
            for i in 24..73 {
                let free = f64::from(wide.heights()[j * 257 + i + 80]);
                error += (f64::from(field.heights()[j * 97 + i]) - free).powi(2);
                norm += free * free;
            }
        }
        (error / norm).sqrt()
    };
    let widths = [0, 8, 12, 20].map(left);
    assert!(widths[0] > 0.25, "grazing waves stay without a sponge: {widths:?}");
    assert!(
        widths[1] < 0.85 * widths[0] && widths[2] < 0.45 * widths[0] && widths[3] < 0.25 * widths[0],
        "{widths:?}"
    );
}

#[test]
fn open_fields_never_grow() {
    for (stencil, courant) in [(Stencil::FivePoint, 0.7), (Stencil::NinePoint, 0.86)] {
        for sponge_cells in [0, 6] {
            let border = Border::Open { sponge_cells };
            let base = settings(24, 24, courant);
            let mut field = started(
                &WaveSettings {
                    border,
                    stencil,
                    ..base
                },
                |i, j| ((i * 7 + j * 13) % 5) as f64 - 2.0,
            );
            field.step(100_000);
            assert!(peak(&field) < 0.5, "{stencil:?} {sponge_cells}: {}", peak(&field));
        }
    }
}

#[test]
fn a_fixed_border_turns_waves_over_and_stays() {
    let base = settings(81, 8, 0.5);
    let border = Border::Fixed;
    // Sine modes of the inner cells are exact: sin(πi/80) sin(πj/7).
    let mode = |i: usize, j: usize| {
        (std::f64::consts::PI * i as f64 / 80.0).sin() * (std::f64::consts::PI * j as f64 / 7.0).sin()
    };
    let mut field = started(&WaveSettings { border, ..base }, mode);
    field.step(200);
    let half = |n: f64| (std::f64::consts::PI / (2.0 * n)).sin().powi(2);
    let phase = 2.0 * (0.5 * (half(80.0) + half(7.0)).sqrt() * 1.0).asin();
    for j in 0..8 {
        for i in 0..81 {
            let exact = (200.0 * phase).cos() * mode(i, j);
            assert!((f64::from(field.heights()[j * 81 + i]) - exact).abs() < 1e-5);
        }
    }
    let edge = |k: &usize| [0, 80].contains(&(k % 81)) || [0, 7].contains(&(k / 81));
    assert!((0..648).filter(edge).all(|k| field.heights()[k] == 0.0));
}

#[test]
fn a_tile_goes_around() {
    // A wave that runs along +x, one wavelength a tile, comes back as it was after a whole turn.
    let base = settings(64, 8, 0.5);
    let border = Border::Periodic;
    let k = std::f64::consts::TAU / 64.0;
    let omega = 2.0 * (0.5 * (0.5 * k).sin()).asin() / 0.5;
    let wave = |i: usize| (k * i as f64).sin();
    let mut field = started(&WaveSettings { border, ..base }, |_, _| 0.0);
    let heights: Vec<f32> = (0..512).map(|index| wave(index % 64) as f32).collect();
    let velocity: Vec<f32> = (0..512)
        .map(|index| (-omega * (k * (index % 64) as f64).cos()) as f32)
        .collect();
    field.set_state(&heights, &velocity).expect("finite");
    let steps = 256;
    field.step(steps);
    let phase = omega * 0.5 * f64::from(steps);
    let mut worst = 0.0_f64;
    for (index, height) in field.heights().iter().enumerate() {
        worst = worst.max((f64::from(*height) - (k * (index % 64) as f64 - phase).sin()).abs());
    }
    assert!(worst < 2e-3, "{worst}");
    // Shifted by any number of cells and rows, it does the same.
    let bump = |i: usize, j: usize| (-((i as f64 - 3.0).powi(2) + (j as f64 - 2.0).powi(2))).exp();
    let mut plain = started(&WaveSettings { border, ..base }, bump);
    let mut shifted = started(&WaveSettings { border, ..base }, |i, j| {
        bump((i + 10) % 64, (j + 5) % 8)
    });
    plain.step(100);
    shifted.step(100);
    for index in 0..512 {
        let from = (index / 64 + 5) % 8 * 64 + (index % 64 + 10) % 64;
        assert_eq!(shifted.heights()[index], plain.heights()[from]);
    }
}

#[test]
fn the_same_depth_everywhere_is_no_bed_at_all() {
    for border in [
        Border::Wall,
        Border::Periodic,
        Border::Fixed,
        Border::Open { sponge_cells: 4 },
    ] {
        let base = settings(20, 20, 0.6);
        let settings = WaveSettings {
            border,
            damping_per_s: 0.1,
            ..base
        };
        let bump = |i: usize, j: usize| (-0.1 * ((i as f64 - 5.0).powi(2) + (j as f64 - 9.0).powi(2))).exp();
        let mut plain = started(&settings, bump);
        let mut bed = started(&settings, bump);
        bed.set_depths(&[DEEPEST; 400]).expect("as deep as the speed says");
        plain.step(150);
        bed.step(150);
        for (a, b) in plain.heights().iter().zip(bed.heights()) {
            assert!((a - b).abs() < 1e-5, "{border:?}: {a} and {b}");
        }
    }
}

#[test]
fn waves_run_with_the_depth_and_come_back_from_the_shore() {
    // A ridge on a quarter of the depth runs at half the speed: 20 cells in 40 s.
    let base = settings(101, 4, 0.5);
    let mut field = started(&base, ridge(20.0));
    field.set_depths(&[0.25 * DEEPEST; 404]).expect("shallow");
    let heights = field.heights().to_vec();
    field.set_state(&heights, &[]).expect("again from rest, on this bed");
    field.step(80);
    let row = &field.heights()[..101];
    let crest = (25..101).max_by(|a, b| row[*a].total_cmp(&row[*b])).expect("cells");
    assert!((39..=41).contains(&crest), "crest at {crest}");
    // Land from cell 60 on: nothing beyond, all water stays, and the wave comes back.
    let mut shore = started(&base, |i, j| if i < 60 { ridge(30.0)(i, j) } else { 0.0 });
    let depths: Vec<f32> = (0..404).map(|k| if k % 101 < 60 { DEEPEST } else { 0.0 }).collect();
    assert_eq!(shore.set_depths(&depths).expect("shallow"), 0.0);
    let volume = total(&shore);
    shore.step(80);
    assert!((total(&shore) / volume - 1.0).abs() < 1e-5);
    let row = &shore.heights()[..101];
    assert!(row[60..].iter().all(|u| *u == 0.0));
    let crest = (35..60).max_by(|a, b| row[*a].total_cmp(&row[*b])).expect("cells");
    // 30 cells to the shore's face at 60, 10 back.
    assert!((48..=50).contains(&crest), "crest at {crest}");
}

#[test]
fn water_on_cells_that_fall_dry_is_handed_back() {
    let mut field = started(&settings(10, 10, 0.5), |_, _| 0.5);
    let depths: Vec<f32> = (0..100).map(|k| if k < 30 { 0.0 } else { DEEPEST }).collect();
    let lost = field.set_depths(&depths).expect("shallow");
    assert!((lost - 15.0).abs() < 1e-9 && (field.volume_m3() - 35.0).abs() < 1e-9);
    let error = field
        .set_depths(&[2.0 * DEEPEST; 100])
        .expect_err("too deep")
        .to_string();
    assert!(error.contains("depth_m"), "{error}");
    let base = settings(10, 10, 0.5);
    let mut nine = started(
        &WaveSettings {
            stencil: Stencil::NinePoint,
            ..base
        },
        |_, _| 0.0,
    );
    assert!(
        nine.set_depths(&depths)
            .expect_err("no flux form")
            .to_string()
            .starts_with("stencil_points")
    );
}

proptest! {
    #![proptest_config(cases(48))]
    #[test]
    fn any_bed_conserves_the_water(seed: u32, dry in 0_u32..60, courant in 0.1_f64..0.7, periodic: bool) {
        let border = if periodic { Border::Periodic } else { Border::Wall };
        let random = |k: u32| rain_core::hash::unit_f32(rain_core::hash::pcg(k ^ seed));
        let settings = WaveSettings { border, damping_per_s: 0.05, ..settings(18, 14, courant) };
        let mut field = WaveField::new(&settings).expect("within the bound");
        let depths: Vec<f32> = (0..252)
            .map(|k| if random(k + 1000) * 100.0 < dry as f32 { 0.0 } else { DEEPEST * (0.01 + 0.99 * random(k)) })
            .collect();
        field.set_depths(&depths).expect("shallow enough");
        let heights: Vec<f32> = (0..252).map(|k| random(k + 5000)).collect();
        field.set_state(&heights, &[]).expect("finite");
        let (volume, energy) = (total(&field), field.energy());
        field.step(700);
        prop_assert!((total(&field) - volume).abs() < 1e-5 * (1.0 + volume));
        prop_assert!((field.volume_m3() - volume).abs() < 1e-9 * (1.0 + volume));
        prop_assert!(field.energy() <= energy * 1.0001 + 1e-12);
        prop_assert!(field.heights().iter().zip(&depths).all(|(u, h)| u.is_finite() && (*h > 0.0 || *u == 0.0)));
    }
}

#[test]
fn a_depth_too_small_to_count_is_dry_and_takes_its_water_along() {
    let settings = WaveSettings {
        cells_x: 8,
        cells_z: 8,
        cell_m: 10.0,
        speed_m_s: 100.0,
        ..WaveSettings::default()
    };
    let mut field = WaveField::new(&settings).expect("valid");
    field.set_state(&[0.5; 64], &[]).expect("valid");
    let mut depths = [500.0; 64];
    depths[9] = 1e-45;
    let lost = field.set_depths(&depths).expect("shallow");
    assert!((lost - 50.0).abs() < 1e-9, "{lost}");
    assert_eq!(field.heights()[9], 0.0);
}
