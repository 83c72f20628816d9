//! The tiles of waves against the CPU's field.

mod calm;
mod map;
mod parity;
mod rain;
mod saved;

use rain_render::slope_mips::SlopeMipsGpu;
use rain_render::waves::{
    Disturbance, RippleSettings, RippleTile, WaveFrame, WaveTile, WaveTileGpu, WaveTileSettings, WavesGpu,
};

use crate::device::Device;

pub use map::picture;

/// The GPU's side of a tile.
struct Rig {
    waves: WavesGpu,
    mips: SlopeMipsGpu,
    map: wgpu::Texture,
    gpu: WaveTileGpu,
    frame: WaveFrame,
}

impl Rig {
    fn new(gpu: &Device, map: &wgpu::TextureDescriptor) -> Self {
        let waves = WavesGpu::new(&gpu.device);
        let mips = SlopeMipsGpu::new(&gpu.device);
        let map = gpu.device.create_texture(map);
        Self {
            gpu: WaveTileGpu::new(&gpu.device, &waves, &mips, &map),
            waves,
            mips,
            map,
            frame: WaveFrame::default(),
        }
    }

    /// Uploads and records what `frame` holds.
    fn record(&mut self, gpu: &Device) {
        self.gpu.prepare(&gpu.device, &gpu.queue, &self.waves, &self.frame);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        self.gpu.encode(&mut pass, &self.waves, &self.mips);
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
    }

    /// Both levels as they are stored.
    fn levels(&self, gpu: &Device) -> [Vec<f32>; 2] {
        self.gpu
            .levels()
            .map(|level| bytemuck::pod_collect_to_vec(&gpu.read(level, level.size())))
    }
}

/// A tile with both its sides.
struct Puddles {
    tile: WaveTile,
    rig: Rig,
    passes: u32,
}

impl Puddles {
    fn new(gpu: &Device, settings: &WaveTileSettings) -> Self {
        Self {
            tile: WaveTile::new(settings).unwrap(),
            rig: Rig::new(gpu, &settings.map_texture()),
            passes: 0,
        }
    }

    /// A frame as a host does it.
    fn frame(&mut self, gpu: &Device, elapsed_ns: u64, disturbances: &[Disturbance]) {
        self.tile.advance(elapsed_ns, disturbances).unwrap();
        if self.tile.wants_pass() {
            self.tile.take(&mut self.rig.frame);
            self.rig.record(gpu);
            self.passes += 1;
        }
    }

    /// Heights that are shown and those before, row by row.
    fn heights(&self, gpu: &Device) -> [Vec<f32>; 2] {
        let n = self.tile.settings().cells;
        let cells = || (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
        self.rig
            .levels(gpu)
            .map(|level| cells().map(|(i, j)| level[self.tile.stored(i, j)]).collect())
    }
}

/// Small, without decay and rim: the CPU's field exactly.
fn bare() -> WaveTileSettings {
    WaveTileSettings {
        cells: 64,
        damping_per_s: 0.6,
        decay_per_s: 0.0,
        rim_cells: 0,
        ..Default::default()
    }
}

/// A pond of changing depth with two shores, an island and a pier, 64 cells wide; `x`, `z` in m from its corner.
fn pond(x: f64, z: f64) -> f32 {
    let island = (x - 1.1).hypot(z - 0.9) < 0.15;
    let pier = (0.5..0.55).contains(&z) && x < 0.6;
    let depth = 0.11 - 0.07 * x + 0.02 * (3.0 * z).sin();
    if island || pier || x + z < 0.31 {
        0.0
    } else {
        depth.max(0.0) as f32
    }
}

fn largest(values: &[f32]) -> f64 {
    values
        .iter()
        .fold(0.0, |most: f64, value| most.max(f64::from(value.abs())))
}

fn farthest(a: &[f32], b: &[f32]) -> f64 {
    let apart = a.iter().zip(b).map(|(a, b)| f64::from(a - b).abs());
    apart.fold(0.0, f64::max)
}

/// A tile of rings with both its sides.
struct Rings {
    tile: RippleTile,
    rig: Rig,
}

impl Rings {
    fn new(gpu: &Device, settings: &RippleSettings) -> Self {
        Self {
            tile: RippleTile::new(settings).unwrap(),
            rig: Rig::new(gpu, &settings.map_texture()),
        }
    }

    fn frame(&mut self, gpu: &Device, elapsed_ns: u64) {
        self.tile.advance(elapsed_ns);
        if self.tile.wants_pass() {
            self.tile.take(&mut self.rig.frame);
            self.rig.record(gpu);
        }
    }
}
