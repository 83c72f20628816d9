//! Procedural rings on the GPU against their twin, and both sources of rings against the rain.

use std::time::Instant;

use rain_core::rainfall::{Distribution, DropSizes, Spectrum};
use rain_core::waves::{CircleSettings, RingGrowth, RingIntensity, RingLayerSettings, rain_slope_variance};
use rain_render::ring_layers::{RingLayerGpu, RingLayerTile, RingLayersGpu};
use rain_render::slope_mips::SlopeMipsGpu;
use rain_render::waves::{RippleSettings, RippleTile, WaveFrame, WaveTileGpu, WavesGpu};

use crate::device::{Device, device};
use crate::maps::read_map;
use crate::waves::picture;

fn rain(intensity_mm_h: f64) -> DropSizes {
    Spectrum::new(Distribution::MarshallPalmer, intensity_mm_h)
        .unwrap()
        .into()
}

/// A tile with both its sides.
struct Layers {
    tile: RingLayerTile,
    pass: RingLayersGpu,
    mips: SlopeMipsGpu,
    gpu: RingLayerGpu,
    map: wgpu::Texture,
    passes: u32,
    now_ns: u64,
}

impl Layers {
    fn new(gpu: &Device, settings: &RingLayerSettings) -> Self {
        let tile = RingLayerTile::new(settings).unwrap();
        Self {
            map: gpu.device.create_texture(&tile.map_texture()),
            pass: RingLayersGpu::new(&gpu.device),
            mips: SlopeMipsGpu::new(&gpu.device),
            gpu: RingLayerGpu::new(&gpu.device),
            tile,
            passes: 0,
            now_ns: 0,
        }
    }

    /// A frame as a host does it.
    fn frame(&mut self, gpu: &Device, elapsed_ns: u64) {
        self.now_ns += elapsed_ns;
        self.tile.advance(self.now_ns, elapsed_ns);
        if self.tile.wants_pass() {
            let frame = self.tile.take();
            self.gpu
                .prepare(&gpu.device, &gpu.queue, &self.pass, &self.mips, &self.map, &frame);
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            self.gpu.encode(
                &mut encoder.begin_compute_pass(&Default::default()),
                &self.pass,
                &self.mips,
            );
            gpu.queue.submit([encoder.finish()]);
            self.passes += 1;
        }
    }
}

/// Largest distance of the finest level from the twin `late_s` later, and the steepest slope.
fn off(gpu: &Device, layers: &Layers, late_s: f64) -> (f64, f64) {
    let forcing = layers.tile.forcing();
    let time_s = layers.now_ns as f64 * 1e-9 + late_s;
    let twin = layers.tile.layers();
    let state = twin.state(time_s, forcing.intensity, forcing.gain);
    let cells = layers.map.width();
    let (mut worst, mut steepest) = (0.0_f64, 0.0_f64);
    for (index, texel) in (0..).zip(read_map(gpu, &layers.map, 0)) {
        let expected = twin.slope(&state, index % cells, index / cells);
        for (found, expected) in texel.into_iter().zip(expected) {
            worst = worst.max(f64::from(found - expected).abs());
            steepest = steepest.max(f64::from(expected.abs()));
        }
        assert!((f64::from(texel[2]) - forcing.hidden_variance).abs() < 1e-3 * forcing.hidden_variance + 1e-7);
        assert_eq!(texel[3], 0.0);
    }
    (worst, steepest)
}

#[test]
fn layers_equal_their_twin_and_another_moment_is_told_apart() {
    let Some(gpu) = device() else { return };
    let base = RingLayerSettings {
        intensity: RingIntensity::Fixed(0.8),
        ..Default::default()
    };
    let settings = [
        base,
        RingLayerSettings::lagarde(),
        RingLayerSettings {
            growth: RingGrowth::Strength,
            repeats: 3,
            ..base
        },
        RingLayerSettings {
            circles: CircleSettings {
                texels: 512,
                distortion: 0.4,
                seed: 9,
                ..Default::default()
            },
            cells: 128,
            repeats: 2,
            ..base
        },
    ];
    for settings in settings {
        let mut layers = Layers::new(&gpu, &settings);
        layers.tile.set_rain(&rain(8.0));
        // Late in the clock, too.
        layers.frame(&gpu, 5_000_000_000_123_456_789);
        for _ in 0..3 {
            layers.frame(&gpu, 217_000_000);
            let (worst, steepest) = off(&gpu, &layers, 0.0);
            eprintln!("{worst:.1e} of {steepest:.2}");
            // Half a place of a half float at the steepest slope, and a sine in single precision.
            assert!(steepest > 0.1 && worst < 6e-4, "{worst} {steepest}");
            assert!(off(&gpu, &layers, 0.02).0 > 0.02);
        }
    }
}

#[test]
fn smaller_levels_keep_the_roughness_of_rings() {
    let Some(gpu) = device() else { return };
    let mut layers = Layers::new(&gpu, &RingLayerSettings::default());
    layers.tile.set_rain(&rain(25.0));
    layers.frame(&gpu, 9_000_000_000);
    let square = |level: u32| {
        let texels = read_map(&gpu, &layers.map, level);
        let sum: f64 = texels.iter().map(|t| f64::from(t[0] * t[0] + t[1] * t[1] + t[2])).sum();
        sum / texels.len() as f64
    };
    let finest = square(0);
    assert!(finest > 1e-3 && layers.map.mip_level_count() == 9);
    for level in 1..9 {
        let change = square(level) / finest - 1.0;
        assert!(change.abs() < 0.01, "level {level}: {change:.4}");
    }
    // The last level is one texel: its slope is all but gone, and the roughness stands beside it.
    let [x, z, variance, _] = read_map(&gpu, &layers.map, 8)[0].map(f64::from);
    assert!(x * x + z * z < 0.02 * variance, "{x} {z} {variance}");
}

#[test]
fn layers_are_drawn_while_it_rains_and_the_clock_runs_and_are_flat_after() {
    let Some(gpu) = device() else { return };
    let frame = 16_666_667;
    let mut layers = Layers::new(&gpu, &RingLayerSettings::default());
    layers.tile.set_rain(&rain(0.0));
    (0..20).for_each(|_| layers.frame(&gpu, frame));
    assert!(layers.passes == 0 && layers.tile.is_calm());
    layers.tile.set_rain(&rain(10.0));
    (0..20).for_each(|_| layers.frame(&gpu, frame));
    assert_eq!(layers.passes, 20, "one in each frame under rain");
    (0..5).for_each(|_| layers.frame(&gpu, 0));
    assert_eq!(layers.passes, 20, "none while the clock stands");
    assert!(read_map(&gpu, &layers.map, 0).iter().any(|t| t[0].abs() > 0.01));
    layers.tile.set_rain(&rain(0.0));
    let mut frames = 0;
    while !layers.tile.is_calm() {
        layers.frame(&gpu, frame);
        frames += 1;
        assert!(frames < 180, "rings three seconds after the rain");
    }
    assert!(frames > 30, "they fade: {frames}");
    let passes = layers.passes;
    assert!(read_map(&gpu, &layers.map, 0).iter().all(|t| *t == [0.0; 4]));
    (0..20).for_each(|_| layers.frame(&gpu, frame));
    assert_eq!(layers.passes, passes, "none afterwards");
    layers.tile.lose();
    (0..3).for_each(|_| layers.frame(&gpu, frame));
    assert_eq!(layers.passes, passes + 1, "a lost map is drawn once");
}

#[test]
fn frames_of_any_length_lead_to_the_same_rings() {
    let run = |parts: &[u64]| {
        let mut tile = RingLayerTile::new(&RingLayerSettings::default()).unwrap();
        let mut now = 0;
        let mut go = |tile: &mut RingLayerTile, total: u64| {
            let end = now + total;
            for part in parts.iter().cycle() {
                let elapsed = (*part).min(end - now);
                now += elapsed;
                tile.advance(now, elapsed);
                if now == end {
                    break;
                }
            }
        };
        tile.set_rain(&rain(40.0));
        go(&mut tile, 500_000_000);
        tile.set_rain(&rain(3.0));
        go(&mut tile, 700_000_000);
        tile.forcing()
    };
    let even = run(&[16_666_667]);
    assert!(even.intensity > 0.1 && even.intensity < 0.9, "{even:?}");
    for parts in [
        &[6_944_444][..],
        &[33_333_333],
        &[1_000_000_000],
        &[1, 99_000_000, 5_000_000],
    ] {
        let found = run(parts);
        for (a, b) in [
            (found.intensity, even.intensity),
            (found.gain, even.gain),
            (found.hidden_variance, even.hidden_variance),
        ] {
            assert!((a / b - 1.0).abs() < 1e-9, "{found:?} {even:?}");
        }
    }
}

/// ⟨s²⟩ that the finest level shows, and that together with what it holds as variance.
fn shown(gpu: &Device, map: &wgpu::Texture) -> [f64; 2] {
    let texels = read_map(gpu, map, 0);
    let count = texels.len() as f64;
    let slopes: f64 = texels.iter().map(|t| f64::from(t[0] * t[0] + t[1] * t[1])).sum();
    let hidden: f64 = texels.iter().map(|t| f64::from(t[2])).sum();
    [slopes / count, (slopes + hidden) / count]
}

/// Seconds of a frame over `frames` of them.
fn timed(gpu: &Device, frames: u32, mut frame: impl FnMut()) -> f64 {
    let wait = || {
        gpu.device
            .poll(wgpu::PollType::wait_indefinitely())
            .expect("the device answers")
    };
    wait();
    let start = Instant::now();
    (0..frames).for_each(|_| frame());
    wait();
    start.elapsed().as_secs_f64() / f64::from(frames)
}

/// Prints what each source costs at each size. What it shows is asserted, time is not.
#[test]
fn each_source_is_as_rough_as_it_says() {
    let Some(gpu) = device() else { return };
    let frame_ns = 16_666_667;
    let folder = std::env::var("RAIN_PICTURES").ok();
    for rate in [3.0, 15.0, 50.0] {
        let truth = rain_slope_variance(&rain(rate), 0.005, 0.6, 0.0);
        let sizes: &[u32] = if rate == 15.0 { &[128, 256, 512] } else { &[256] };
        for &cells in sizes {
            let mut layers = Layers::new(
                &gpu,
                &RingLayerSettings {
                    cells,
                    circles: CircleSettings {
                        texels: cells,
                        ..Default::default()
                    },
                    ..Default::default()
                },
            );
            layers.tile.set_rain(&rain(rate));
            layers.frame(&gpu, 7_000_000_000);
            let (mut sums, looks) = ([0.0; 2], 12);
            for _ in 0..looks {
                layers.frame(&gpu, 730_000_000);
                let [drawn, all] = shown(&gpu, &layers.map);
                sums[0] += drawn / f64::from(looks);
                sums[1] += all / f64::from(looks);
            }
            let seconds = timed(&gpu, 40, || layers.frame(&gpu, frame_ns));
            eprintln!(
                "layers, {cells}², {rate} mm/h: drawn {:.4}, all {:.4} of {truth:.2e}; {:.2} ms a frame, {} kB",
                sums[0] / truth,
                sums[1] / truth,
                seconds * 1e3,
                layers.gpu.memory_bytes() / 1000,
            );
            assert!((sums[1] / truth - 1.0).abs() < 0.12, "{rate} mm/h: {sums:?} of {truth}");
            assert!(sums[0] < sums[1] && sums[0] > 0.0);
            if let Some(folder) = folder.as_ref().filter(|_| cells == 256) {
                picture(&gpu, &layers.map, &format!("{folder}/layers{rate}.pgm"), 4.0);
            }
        }
        for &cells in sizes {
            let settings = RippleSettings {
                cells,
                ..Default::default()
            };
            let mut tile = RippleTile::new(&settings).unwrap();
            let (waves, mips) = (WavesGpu::new(&gpu.device), SlopeMipsGpu::new(&gpu.device));
            let map = gpu.device.create_texture(&settings.map_texture());
            let mut target = WaveTileGpu::new(&gpu.device, &waves, &mips, &map);
            let mut work = WaveFrame::default();
            tile.set_rain(&rain(rate));
            let mut frame = |elapsed_ns: u64| {
                tile.advance(elapsed_ns);
                tile.take(&mut work);
                target.prepare(&gpu.device, &gpu.queue, &waves, &work);
                let mut encoder = gpu.device.create_command_encoder(&Default::default());
                target.encode(&mut encoder.begin_compute_pass(&Default::default()), &waves, &mips);
                gpu.queue.submit([encoder.finish()]);
            };
            (0..300).for_each(|_| frame(frame_ns));
            let (mut sums, looks) = ([0.0; 2], 4);
            for _ in 0..looks {
                (0..30).for_each(|_| frame(frame_ns));
                let [drawn, all] = shown(&gpu, &map);
                sums[0] += drawn / f64::from(looks);
                sums[1] += all / f64::from(looks);
            }
            let seconds = timed(&gpu, 40, || frame(frame_ns));
            let cell = settings.cell_m();
            let expected = rain_slope_variance(&rain(rate), 0.005, 0.6, cell);
            eprintln!(
                "drops, {cells}², {rate} mm/h: drawn {:.4}, all {:.4} of {truth:.2e} (theory of the cell {:.4}); {:.2} ms a frame",
                sums[0] / truth,
                sums[1] / truth,
                expected / truth,
                seconds * 1e3,
            );
            assert!(
                (sums[0] / expected - 1.0).abs() < 0.3,
                "{rate} mm/h: {sums:?} of {expected}"
            );
            assert!((sums[1] / truth - 1.0).abs() < 0.12, "{rate} mm/h: {sums:?} of {truth}");
            if let Some(folder) = folder.as_ref().filter(|_| cells == 256) {
                picture(&gpu, &map, &format!("{folder}/drops{rate}.pgm"), 4.0);
            }
        }
    }
}
