//! The map shows the heights' slopes, and the rim takes up waves.

use rain_core::waves::Push;
use rain_render::waves::{Disturbance, WaveTileSettings};

use super::{Puddles, bare, largest};
use crate::device::{Device, device};
use crate::maps::read_map;

/// A round hump of water.
fn hump(at: [f64; 2], height: f32) -> Disturbance {
    Disturbance {
        from_m: at,
        to_m: at,
        width_m: 0.1,
        push: Push::Height(height),
    }
}

#[test]
fn the_map_holds_slopes_and_heights_with_mips() {
    let Some(gpu) = device() else { return };
    let settings = bare();
    let mut puddles = Puddles::new(&gpu, &settings);
    // A shore on the left.
    puddles.tile.follow([0.8, 0.8], |x, _| if x < 0.4 { 0.0 } else { 0.1 });
    let step = puddles.tile.step_ns();
    puddles.frame(&gpu, step, &[hump([0.6, 0.7], 0.01)]);
    for _ in 0..19 {
        puddles.frame(&gpu, step, &[]);
    }
    // A quarter of a step on: three quarters of the way back from the last.
    puddles.frame(&gpu, step / 4, &[]);
    let [now, before] = puddles.heights(&gpu);
    let n = settings.cells as i32;
    let corner = puddles.tile.corner_m();
    let wet = |i: i32| corner[0] + (f64::from(i) + 0.5) * settings.cell_m >= 0.4;
    let u = |i: i32, j: i32| {
        let inside = (0..n).contains(&i) && (0..n).contains(&j) && wet(i);
        let at = (j * n + i) as usize;
        inside.then(|| f64::from(before[at]) + 0.25 * f64::from(now[at] - before[at]))
    };
    let slope = |i: i32, j: i32, [x, z]: [i32; 2]| {
        let here = u(i, j)?;
        let at = |k: i32| u(i + k * x, j + k * z);
        let difference = match [at(-2), at(-1), at(1), at(2)] {
            [Some(a), Some(b), Some(c), Some(d)] => (8.0 * (c - b) - (d - a)) / 12.0,
            [_, Some(b), Some(c), _] => 0.5 * (c - b),
            [_, b, c, _] => c.map_or(0.0, |c| c - here) + b.map_or(0.0, |b| here - b),
        };
        Some(difference / settings.cell_m)
    };
    let map = read_map(&gpu, &puddles.rig.map, 0);
    let mut steepest = 0.0_f64;
    for j in 0..n {
        for i in 0..n {
            let texel = map[(j * n + i) as usize].map(f64::from);
            let expected = [
                slope(i, j, [1, 0]).unwrap_or(0.0),
                slope(i, j, [0, 1]).unwrap_or(0.0),
                0.0,
                1e3 * u(i, j).unwrap_or(0.0),
            ];
            for (found, expected) in texel.iter().zip(expected) {
                let error = (found - expected).abs();
                assert!(
                    error < 2e-6 + 1e-3 * expected.abs(),
                    "{i}, {j}: {texel:?}, not {expected:?}"
                );
            }
            steepest = steepest.max(expected[0].abs());
        }
    }
    assert!(steepest > 0.01, "{steepest}");
    // ⟨s²⟩ is the same in every level.
    let square = |level: u32| {
        let texels = read_map(&gpu, &puddles.rig.map, level);
        let sum: f64 = texels.iter().map(|t| f64::from(t[0] * t[0] + t[1] * t[1] + t[2])).sum();
        sum / texels.len() as f64
    };
    let finest = square(0);
    assert_eq!(puddles.rig.map.mip_level_count(), 7);
    for level in 1..7 {
        let change = square(level) / finest - 1.0;
        assert!(change.abs() < 0.01, "level {level}: {change:.4}");
    }
}

/// √Σu² after two seconds and after the ring has left, over that of the start.
fn left_over(gpu: &Device, rim_cells: u32) -> f64 {
    let settings = WaveTileSettings {
        cells: 128,
        rim_cells,
        decay_per_s: 0.0,
        ..Default::default()
    };
    let mut puddles = Puddles::new(gpu, &settings);
    puddles.tile.follow([1.6, 1.6], |_, _| 0.1);
    let push = Disturbance {
        push: Push::Impulse(2.0),
        ..hump([1.6, 1.6], 0.0)
    };
    puddles.frame(gpu, 16_666_667, &[push]);
    // The ring moves 1 m in a second, and the edge is 1.6 m away.
    let norm = |puddles: &Puddles| {
        let [now, _] = puddles.heights(gpu);
        now.iter().map(|u| f64::from(*u) * f64::from(*u)).sum::<f64>().sqrt()
    };
    for _ in 0..40 {
        puddles.frame(gpu, 16_666_667, &[]);
    }
    let start = norm(&puddles);
    for _ in 0..170 {
        puddles.frame(gpu, 16_666_667, &[]);
    }
    norm(&puddles) / start
}

#[test]
fn the_rim_takes_up_waves_that_a_wall_sends_back() {
    let Some(gpu) = device() else { return };
    let (wall, rim) = (left_over(&gpu, 0), left_over(&gpu, 16));
    eprintln!("left of a ring: {wall:.2} with a wall, {rim:.3} with a rim");
    assert!(wall > 0.5 && rim < 0.15, "{wall} {rim}");
}

#[test]
fn rings_are_round_and_wakes_are_wedges() {
    let Some(gpu) = device() else { return };
    let settings = WaveTileSettings::default();
    let mut puddles = Puddles::new(&gpu, &settings);
    puddles.tile.follow([0.0, 0.0], |_, _| 0.03);
    puddles.frame(&gpu, 16_666_667, &[hump([0.0, 0.0], 0.01)]);
    for _ in 0..120 {
        puddles.frame(&gpu, 16_666_667, &[]);
    }
    // Where the crest is along the axis and the diagonal.
    let n = settings.cells as i32;
    let [now, _] = puddles.heights(&gpu);
    let crest = |x: i32, z: i32| {
        let height = |k: &i32| now[((n / 2 + k * z) * n + n / 2 + k * x) as usize];
        let best = (10..100).max_by(|a, b| height(a).total_cmp(&height(b))).unwrap();
        f64::from(best) * f64::from(x * x + z * z).sqrt() * settings.cell_m
    };
    // c = √(0.03 g) = 0.542 m/s; the crest is at the front, less than s behind it.
    let expected = 0.542 * 2.0;
    for (x, z) in [(1, 0), (0, -1), (1, 1), (-1, 1)] {
        let found = crest(x, z);
        assert!((found - expected).abs() < 0.1, "{x}, {z}: {found} m, not {expected} m");
    }
    let (axis, diagonal) = (crest(1, 0), crest(1, 1));
    assert!((axis - diagonal).abs() < 0.05, "{axis} m along, {diagonal} m across");
    // A wheel at twice the speed of waves: the wedge opens by 30° to either side.
    puddles.tile.reset();
    let speed = 2.0 * 0.5424;
    for index in 0..120 {
        let at = |index: i32| [-1.5 + speed / 60.0 * f64::from(index), 0.0];
        let wheel = Disturbance {
            from_m: at(index),
            to_m: at(index + 1),
            width_m: 0.06,
            push: Push::Impulse(0.3),
        };
        puddles.frame(&gpu, 16_666_667, &[wheel]);
    }
    let [wake, _] = puddles.heights(&gpu);
    // The wheel is at 0.67 m. At x = −0.4 m it was 0.98 s ago: r = 1.07 m · tan 30° to either side.
    let column = (f64::from(n / 2) - 0.4 / settings.cell_m) as i32;
    let edge = |side: i32| {
        let height = |k: &i32| wake[((n / 2 + side * k) * n + column) as usize].abs();
        let most = (8..80).map(|k| height(&k)).fold(0.0, f32::max);
        // The outermost place with a fifth of the highest wave.
        let outer = (8..80).rev().find(|k| height(k) > 0.2 * most).unwrap();
        f64::from(outer) * settings.cell_m
    };
    let expected = 1.07 * (30.0_f64).to_radians().tan();
    for side in [1, -1] {
        let found = edge(side);
        eprintln!("the wake's arm is {found:.3} m aside, {expected:.3} m expected");
        assert!((found - expected).abs() < 0.17, "{found} m, not {expected} m");
    }
    assert!(largest(&wake) > 1e-4);
    if let Ok(folder) = std::env::var("RAIN_PICTURES") {
        picture(&gpu, &puddles.rig.map, &format!("{folder}/wake.pgm"), 40.0);
    }
}

/// The finest level as a height field lit from the upper left, for looking at. `gain`: on slopes.
pub fn picture(gpu: &Device, map: &wgpu::Texture, path: &str, gain: f32) {
    let mut out = format!("P5 {} {} 255\n", map.width(), map.height()).into_bytes();
    out.extend(read_map(gpu, map, 0).iter().map(|t| {
        let shade = 0.5 + 0.35 * gain * (t[0] + t[1]);
        (shade.clamp(0.0, 1.0) * 255.0) as u8
    }));
    std::fs::write(path, out).expect("a picture");
}
