//! Wind waves and noise puddles far from the world's origin, against double precision in world coordinates.

use std::f64::consts::TAU;

use rain_core::hash;
use rain_render::compose::{WAVE_PERIOD_S, WIND_DIRECTIONS, WIND_TILE};

use crate::device::{device, kernel, library};

/// `expression` over `v = input[i]`, or `None` where there is no device.
fn evaluate(expression: &str, input: &[[f32; 4]]) -> Option<Vec<[f32; 4]>> {
    let gpu = device()?;
    let body = format!("let v = input[i]; output[i] = {expression};");
    Some(gpu.compute(&kernel(&library(), "vec4<f32>", "vec4<f32>", &body), input, &[]))
}

/// Eyes near the origin, at 100 km and at 1000 km; all exact in single precision.
const EYES: [[f64; 2]; 5] = [
    [0.0, 0.0],
    [-17.25, 130.5],
    [100_000.5, -73_000.25],
    [99_999.75, 100_000.0],
    [-1.0e6, 999_999.5],
];

/// Wind waves of the tests. Units: none, m, m/s.
#[derive(Clone, Copy)]
struct Wind {
    square: f64,
    length_m: f64,
    velocity: [f64; 2],
}

const WIND: Wind = Wind {
    square: 0.01,
    length_m: 0.25,
    velocity: [0.24, -0.18],
};

impl Wind {
    fn turned(self, by: f64) -> Self {
        let [x, z] = self.velocity;
        let velocity = [x * by.cos() - z * by.sin(), x * by.sin() + z * by.cos()];
        Self { velocity, ..self }
    }

    /// Slopes at a world place: the sum of the trains, phases in world coordinates.
    fn slopes(self, world: [f64; 2], time: f64) -> [f64; 2] {
        let side = WIND_TILE * self.length_m;
        let speed = self.velocity[0].hypot(self.velocity[1]);
        let along = self.velocity[1].atan2(self.velocity[0]);
        let mut slopes = [0.0; 2];
        let (mut cycles, mut square) = (WIND_TILE, 0.4428 * self.square);
        for (i, angle) in (0..).zip([0.1, -0.52, 0.44, -0.23, 0.68]) {
            let direction = (along + angle) * WIND_DIRECTIONS / TAU;
            let t = direction - direction.floor();
            let share = t * t * (3.0 - 2.0 * t);
            for (k, share) in [(0.0, 1.0 - share), (1.0, share)] {
                let number = (direction.floor() + k).rem_euclid(WIND_DIRECTIONS);
                let turn = number * TAU / WIND_DIRECTIONS;
                let wave = [(cycles * turn.cos()).round(), (cycles * turn.sin()).round()];
                let waves = wave[0].hypot(wave[1]);
                let turns = (speed * waves / side * WAVE_PERIOD_S).round();
                let phase = (wave[0] * world[0] + wave[1] * world[1]) / side - turns * time / WAVE_PERIOD_S
                    + 0.271 * f64::from(i)
                    + 0.618 * number;
                let height = (2.0 * square * share).sqrt() * (TAU * phase.fract()).cos();
                slopes = [
                    slopes[0] + wave[0] / waves * height,
                    slopes[1] + wave[1] / waves * height,
                ];
            }
            cycles *= 2.13;
            square /= 1.7;
        }
        slopes
    }

    /// What the GPU says at `offset` from an eye. v.xy is the offset, v.z the time.
    fn gpu(self, eye: [f64; 2], input: &[[f32; 4]]) -> Option<Vec<[f32; 4]>> {
        let zero = "vec4<f32>(0.0)";
        let place = eye.map(|e| (e / (WIND_TILE * self.length_m)).rem_euclid(1.0) as f32);
        let look = format!(
            "WaterLook({zero}, {zero}, vec4<f32>({:?}, {:?}, {:?}, {:?}), {zero}, {zero}, vec4<f32>({:?}, {:?}, 0.0, 0.0), {zero}, {zero})",
            self.square as f32,
            (1.0 / self.length_m) as f32,
            self.velocity[0] as f32,
            self.velocity[1] as f32,
            place[0],
            place[1]
        );
        evaluate(
            &format!("vec4<f32>(rain_wind_slopes({look}, v.xy, v.z), 0.0, 0.0)"),
            input,
        )
    }
}

/// Places up to 40 m from the eye at times from 0 to 4096 s.
fn places() -> Vec<[f32; 4]> {
    let part = |i: u32, k: u32| hash::unit_f32(hash::pcg3d([i, k, 9])[0]);
    (0..2000)
        .map(|i| {
            let offset = |k| ((part(i, k) - 0.5) * 80.0 * 256.0).round() / 256.0;
            [offset(0), offset(1), (part(i, 2) * 4096.0 * 64.0).floor() / 64.0, 0.0]
        })
        .collect()
}

fn worst(wanted: impl Fn(&[f32; 4]) -> [f64; 2], input: &[[f32; 4]], found: &[[f32; 4]]) -> f64 {
    let off = |(i, f): (&[f32; 4], &[f32; 4])| {
        let w = wanted(i);
        (f64::from(f[0]) - w[0]).hypot(f64::from(f[1]) - w[1])
    };
    input.iter().zip(found).map(off).fold(0.0, f64::max)
}

#[test]
fn wind_waves_are_the_worlds_wherever_the_eye_is() {
    let input = places();
    for eye in EYES {
        let Some(found) = WIND.gpu(eye, &input) else { return };
        let at = |i: &[f32; 4]| [eye[0] + f64::from(i[0]), eye[1] + f64::from(i[1])];
        let off = worst(|i| WIND.slopes(at(i), i[2].into()), &input, &found);
        // Mean square slope 0.01: the rms is 0.1.
        assert!(off < 2e-3, "{eye:?}: {off}");
        let single = worst(
            |i| WIND.slopes(at(i).map(|v| f64::from(v as f32)), i[2].into()),
            &input,
            &found,
        );
        let far = eye[0].abs() > 1e4;
        assert_eq!(single > 0.1, far, "{eye:?}: single precision is off by {single}");
    }
}

#[test]
fn wind_waves_have_the_slopes_they_are_given() {
    let input: Vec<[f32; 4]> = (0..60_000_u32)
        .map(|i| {
            [
                (i % 300) as f32 * 0.137,
                (i / 300) as f32 * 0.211,
                (i % 7) as f32 * 0.9,
                0.0,
            ]
        })
        .collect();
    for turn in [0.0, 0.4, 1.1, 2.9, -2.2] {
        let calm = Wind { square: 0.0, ..WIND };
        let (Some(found), Some(calm)) = (WIND.turned(turn).gpu([0.0; 2], &input), calm.gpu([0.0; 2], &input)) else {
            return;
        };
        let square: f32 = found.iter().map(|f| f[0] * f[0] + f[1] * f[1]).sum::<f32>() / found.len() as f32;
        assert!((square / 0.01 - 1.0).abs() < 0.03, "{turn}: {square}");
        assert!(calm.iter().all(|f| f == &[0.0; 4]), "no wind, no waves");
        // They run with the wind: slopes along it are the larger ones.
        let [x, z] = WIND.turned(turn).velocity.map(|v| v as f32 / 0.3);
        let along: f32 = found.iter().map(|f| (f[0] * x + f[1] * z).powi(2)).sum();
        let across: f32 = found.iter().map(|f| (f[1] * x - f[0] * z).powi(2)).sum();
        assert!(along > 1.8 * across, "{turn}: {along} along, {across} across");
    }
}

#[test]
fn a_turning_wind_does_not_make_waves_race_and_time_goes_on_over_its_period() {
    let still: Vec<[f32; 4]> = places().into_iter().map(|[x, z, ..]| [x, z, 12.0, 0.0]).collect();
    let change = |a: &[[f32; 4]], b: &[[f32; 4]]| {
        let off = a.iter().zip(b).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]));
        off.fold(0.0, f32::max)
    };
    let eye = EYES[2];
    let (Some(before), Some(after)) = (WIND.gpu(eye, &still), WIND.turned(1e-3).gpu(eye, &still)) else {
        return;
    };
    // A train that turned would be 100 m, hundreds of waves, elsewhere.
    assert!(change(&before, &after) < 0.02, "{}", change(&before, &after));
    let Some(turned) = WIND.turned(0.5).gpu(eye, &still) else {
        return;
    };
    assert!(change(&before, &turned) > 0.1, "they do follow the wind");
    let at = |time: f32| -> Vec<[f32; 4]> { still.iter().map(|[x, z, ..]| [*x, *z, time, 0.0]).collect() };
    let (Some(end), Some(start)) = (WIND.gpu(eye, &at(4096.0)), WIND.gpu(eye, &at(0.0))) else {
        return;
    };
    assert!(change(&end, &start) < 1e-4, "{}", change(&end, &start));
}

/// Noise at a world place in double precision.
fn noise(world: [f64; 2], scale: [f32; 2], seed: u32) -> f64 {
    let octave = |factor: f32, shift: f64, seed: u32| {
        let place = [0, 1].map(|k| world[k] * f64::from(factor * scale[k]) + shift);
        let corner = place.map(f64::floor);
        let t = [0, 1].map(|k| {
            let f: f64 = place[k] - corner[k];
            f * f * f * (f * (f * 6.0 - 15.0) + 10.0)
        });
        let value = |dx: i64, dz: i64| {
            let cell = [(corner[0] as i64 + dx) & 4095, (corner[1] as i64 + dz) & 4095].map(|c| c as u32);
            f64::from(hash::unit_f32(hash::pcg3d([cell[0], cell[1], seed])[0]))
        };
        let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
        mix(
            mix(value(0, 0), value(1, 0), t[0]),
            mix(value(0, 1), value(1, 1), t[0]),
            t[1],
        )
    };
    let sum = octave(1.0, 0.0, seed) + 0.5 * octave(2.0, 7.31, seed + 1) + 0.25 * octave(4.0, -3.77, seed + 2);
    let t = ((sum / 1.75 - 0.25) / 0.5).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[test]
fn noise_puddles_are_the_worlds_wherever_the_eye_is() {
    let input = places();
    for scale in [[0.25_f32, 0.25], [2.0, 0.7], [10.0, 3.3]] {
        for eye in EYES {
            let call = format!(
                "vec4<f32>(rain_puddle_noise(vec2<f32>({:?}, {:?}), v.xy, vec2<f32>({:?}, {:?}), 7u))",
                eye[0] as f32, eye[1] as f32, scale[0], scale[1]
            );
            let Some(found) = evaluate(&call, &input) else { return };
            let off = |shift: f64| {
                let wanted =
                    |i: &[f32; 4]| noise([eye[0] + f64::from(i[0]) + shift, eye[1] + f64::from(i[1])], scale, 7);
                let worst = input
                    .iter()
                    .zip(&found)
                    .map(|(i, f)| (f64::from(f[0]) - wanted(i)).abs());
                worst.fold(0.0, f64::max)
            };
            assert!(off(0.0) < 4e-3, "{eye:?}, {scale:?}: {}", off(0.0));
            let shifted = off(0.1 / f64::from(scale[0]));
            assert!(shifted > 0.05, "a tenth of a puddle is found: {shifted}");
        }
    }
}

#[test]
fn the_same_place_is_the_same_from_every_eye() {
    // An eye that walks over the rim of a block of noise and of a tile of waves; the place stays.
    let place = [100_352.0_f64, 96_000.0];
    let (mut waves, mut puddles) = (Vec::new(), Vec::new());
    for step in 0..9_u8 {
        let eye = [
            place[0] + 0.5 * (f64::from(step) - 4.0),
            place[1] + 0.25 * (f64::from(step) - 4.0),
        ];
        let offset = [0, 1].map(|k| (place[k] + 0.375 - eye[k]) as f32);
        let input = [[offset[0], offset[1], 77.25, 0.0]];
        let Some(slopes) = WIND.gpu(eye, &input) else { return };
        let call = format!(
            "vec4<f32>(rain_puddle_noise(vec2<f32>({:?}, {:?}), v.xy, vec2<f32>(1.5), 3u))",
            eye[0] as f32, eye[1] as f32
        );
        let Some(noise) = evaluate(&call, &input) else { return };
        waves.push(slopes[0]);
        puddles.push(noise[0][0]);
    }
    for (w, p) in waves.iter().zip(&puddles) {
        assert!((w[0] - waves[0][0]).hypot(w[1] - waves[0][1]) < 2e-3, "{waves:?}");
        assert!((p - puddles[0]).abs() < 2e-3, "{puddles:?}");
    }
}
