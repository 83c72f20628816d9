//! Rain's rings: as rough as the theory says, seamless, repeatable.

use rain_core::rainfall::{Distribution, Spectrum};
use rain_core::waves::{DropImpact, WaveField, slope_variance};
use rain_render::waves::{RippleSettings, RippleTile};

use super::map::picture;
use super::{Rings, farthest, largest};
use crate::device::{Device, device};
use crate::maps::read_map;

fn spectrum(intensity_mm_h: f64) -> Spectrum {
    Spectrum::new(Distribution::MarshallPalmer, intensity_mm_h).unwrap()
}

/// ⟨sx²⟩ + ⟨sz²⟩ over the map.
fn variance(gpu: &Device, rings: &Rings) -> f64 {
    let map = read_map(gpu, &rings.rig.map, 0);
    let sum: f64 = map.iter().map(|t| f64::from(t[0] * t[0] + t[1] * t[1])).sum();
    sum / map.len() as f64
}

#[test]
fn slopes_are_as_rough_as_campbells_theorem_says() {
    let Some(gpu) = device() else { return };
    // Cells twice as long as the default's: half of the steps.
    let settings = RippleSettings {
        cells: 128,
        side_m: 1.0,
        ..Default::default()
    };
    let mut last = 0.0;
    for intensity in [5.0, 25.0, 100.0] {
        let rain = spectrum(intensity);
        let mut rings = Rings::new(&gpu, &settings);
        rings.tile.set_rain(&rain.into());
        // 6 s to fill the tile (waves last 1/0.3 s), then one look each second.
        let (mut sum, mut count) = (0.0, 0.0);
        for second in 0..13 {
            for _ in 0..4 {
                rings.frame(&gpu, 250_000_000);
            }
            if second >= 6 {
                sum += variance(&gpu, &rings);
                count += 1.0;
            }
        }
        let k_d = 2.0 * settings.decay_per_s;
        let expected = slope_variance(&rain, settings.depth_m, k_d, settings.cell_m());
        let ratio = sum / count / expected;
        eprintln!("{intensity} mm/h: ⟨s²⟩ {:.2e}, {ratio:.3} of the theory", sum / count);
        assert!(
            (ratio - 1.0).abs() < 0.15,
            "{intensity} mm/h: {ratio:.3} of {expected:.2e}"
        );
        // Light, moderate and heavy rain differ.
        assert!(sum / count > 2.0 * last);
        last = sum / count;
        if let Ok(folder) = std::env::var("RAIN_PICTURES") {
            picture(&gpu, &rings.rig.map, &format!("{folder}/rain{intensity}.pgm"), 10.0);
        }
    }
}

#[test]
fn drops_are_those_of_the_field() {
    let Some(gpu) = device() else { return };
    let settings = RippleSettings {
        cells: 64,
        side_m: 0.5,
        decay_per_s: 0.0,
        least_drop_mm: 1.5,
        ..Default::default()
    };
    let mut rings = Rings::new(&gpu, &settings);
    let mut twin = WaveField::new(&settings.twin()).unwrap();
    rings.tile.set_rain(&spectrum(25.0).into());
    let step = rings.tile.step_ns();
    let mut drops = 0;
    for _ in 0..60 {
        rings.tile.for_each_drop(rings.tile.steps(), |impact| {
            drops += 1;
            assert!(twin.add_drop(&impact).unwrap());
        });
        assert_eq!(rings.tile.advance(step), 1);
        rings.tile.take(&mut rings.rig.frame);
        rings.rig.record(&gpu);
        twin.step(1);
    }
    assert!(drops > 50, "{drops}");
    let [now, _] = rings.rig.levels(&gpu);
    // The field takes out what the edge of a drop's reach moves in sum, 1e-4 of it; decay does so here.
    let error = farthest(&now, twin.heights()) / largest(twin.heights());
    eprintln!("{drops} drops: {error:.2e} of the amplitude");
    assert!(error < 3e-4, "{error:.2e}");
    // One more drop is told apart.
    let extra = DropImpact {
        x_m: 0.2,
        z_m: 0.3,
        diameter_mm: 3.0,
        speed_m_s: 8.0,
    };
    assert!(twin.add_drop(&extra).unwrap());
    assert!(farthest(&now, twin.heights()) / largest(twin.heights()) > 1e-2);
}

#[test]
fn the_tile_has_no_seam() {
    let Some(gpu) = device() else { return };
    let settings = RippleSettings {
        cells: 128,
        side_m: 1.0,
        ..Default::default()
    };
    let mut rings = Rings::new(&gpu, &settings);
    rings.tile.set_rain(&spectrum(50.0).into());
    for _ in 0..12 {
        rings.frame(&gpu, 250_000_000);
    }
    let [now, _] = rings.rig.levels(&gpu);
    let n = 128;
    // Bends along rows and columns, by the column (row) at which they are: those across the seam are like the others.
    let bend = |at: usize, turned: bool| {
        let u = |k: usize, l: usize| {
            f64::from(if turned {
                now[(k % n) * n + l]
            } else {
                now[l * n + k % n]
            })
        };
        let sum: f64 = (0..n)
            .map(|l| (u(at + n - 1, l) - 2.0 * u(at, l) + u(at + 1, l)).powi(2))
            .sum();
        (sum / n as f64).sqrt()
    };
    for turned in [false, true] {
        let all: Vec<f64> = (0..n).map(|at| bend(at, turned)).collect();
        let mean = all.iter().sum::<f64>() / n as f64;
        let most = all.iter().copied().fold(0.0, f64::max);
        assert!(
            all[0] < 2.0 * mean && all[n - 1] < 2.0 * mean,
            "{} {} {mean}",
            all[0],
            all[n - 1]
        );
        assert!(most < 2.0 * mean, "{most} {mean}");
    }
    // The mean level does not rise: what falls goes to the puddle's own level.
    let mean: f64 = now.iter().map(|u| f64::from(*u)).sum::<f64>() / now.len() as f64;
    assert!(mean.abs() < 0.2 * largest(&now), "{mean}");
}

#[test]
fn the_same_seed_makes_the_same_water_bit_for_bit_and_another_does_not() {
    let Some(gpu) = device() else { return };
    let run = |seed: u32, frames: &[u64]| {
        let settings = RippleSettings {
            cells: 64,
            side_m: 0.5,
            seed,
            ..Default::default()
        };
        let mut rings = Rings::new(&gpu, &settings);
        rings.tile.set_rain(&spectrum(30.0).into());
        let step = rings.tile.step_ns();
        for parts in frames {
            rings.frame(&gpu, parts * step);
        }
        rings.rig.levels(&gpu)
    };
    let once = run(7, &[1; 60]);
    assert_eq!(once, run(7, &[1; 60]));
    assert_eq!(once, run(7, &[4; 15]));
    assert_ne!(once, run(8, &[1; 60]));
}

#[test]
fn without_rain_the_tile_calms_and_asks_for_nothing() {
    let Some(gpu) = device() else { return };
    let settings = RippleSettings {
        cells: 64,
        side_m: 0.5,
        ..Default::default()
    };
    let mut rings = Rings::new(&gpu, &settings);
    let dry = spectrum(0.0).into();
    rings.tile.set_rain(&dry);
    assert_eq!(rings.tile.advance(1_000_000_000), 0);
    assert!(rings.tile.is_calm() && !rings.tile.wants_pass());
    rings.tile.set_rain(&spectrum(20.0).into());
    for _ in 0..8 {
        rings.frame(&gpu, 250_000_000);
        let [now, _] = rings.rig.levels(&gpu);
        assert!(largest(&now) > 1e-5 && largest(&now) <= rings.tile.bound().height_m());
    }
    rings.tile.set_rain(&dry);
    assert!(!rings.tile.is_calm());
    let mut quarters = 0;
    while !rings.tile.is_calm() {
        rings.frame(&gpu, 250_000_000);
        let [now, _] = rings.rig.levels(&gpu);
        assert!(largest(&now) <= rings.tile.bound().height_m());
        quarters += 1;
        assert!(quarters < 480, "awake after two minutes");
    }
    eprintln!("calm {} s after the rain", quarters / 4);
    assert!(!rings.tile.wants_pass());
    assert!(read_map(&gpu, &rings.rig.map, 0).iter().all(|t| *t == [0.0; 4]));
}

#[test]
fn bad_ripple_settings_are_refused() {
    let with = |change: fn(&mut RippleSettings)| {
        let mut settings = RippleSettings::default();
        change(&mut settings);
        RippleTile::new(&settings).unwrap_err().to_string()
    };
    for (message, field) in [
        (with(|s| s.cells = 0), "cells"),
        (with(|s| s.side_m = f64::NAN), "side_m"),
        (with(|s| s.depth_m = 0.0), "depth_m"),
        (with(|s| s.decay_per_s = -1.0), "decay_per_s"),
        (with(|s| s.least_drop_mm = 0.0), "least_drop_mm"),
        (with(|s| s.tick_ns = 0), "tick_ns"),
    ] {
        assert!(message.starts_with(field), "{message}");
    }
}
