//! The heights of the wave tile, read back when a snapshot asks for them.

use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::Duration;

use bevy::prelude::*;
use bevy::render::renderer::{RenderDevice, RenderQueue};

use super::prepare::RainGpu;

/// How long a frame that is being drawn is waited for.
const PATIENCE: Duration = Duration::from_secs(5);

/// Where the heights lie, known to both worlds.
#[derive(Resource, Clone, Default)]
pub(crate) struct WaveLevels(Arc<(Mutex<Slot>, Condvar)>);

#[derive(Default)]
struct Slot {
    /// What is shown and the step before; none before the first wave.
    levels: Option<[wgpu::Buffer; 2]>,
    /// Frames handed to the render world, and those whose commands are submitted.
    handed: u64,
    done: u64,
}

impl WaveLevels {
    /// A frame goes to the render world.
    pub(super) fn hand(&self) {
        self.0.0.lock().unwrap_or_else(PoisonError::into_inner).handed += 1;
    }

    /// Heights now and a step before, as they are stored, once the last frame is drawn. `None`: no water has moved yet,
    /// or the device does not answer.
    pub(crate) fn read(&self, world: &World) -> Option<[Vec<f32>; 2]> {
        let device = world.get_resource::<RenderDevice>()?.wgpu_device();
        let queue = world.get_resource::<RenderQueue>()?;
        let (slot, drawn) = &*self.0;
        let slot = slot.lock().unwrap_or_else(PoisonError::into_inner);
        let (slot, waited) = drawn
            .wait_timeout_while(slot, PATIENCE, |slot| slot.done < slot.handed)
            .unwrap_or_else(PoisonError::into_inner);
        let levels = slot.levels.as_ref().filter(|_| !waited.timed_out())?;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let copies = levels.each_ref().map(|level| {
            let copy = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("rain waves saved"),
                size: level.size(),
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            encoder.copy_buffer_to_buffer(level, 0, &copy, 0, level.size());
            copy
        });
        queue.submit([encoder.finish()]);
        let mapped = Arc::new(Mutex::new(0));
        for copy in &copies {
            let mapped = mapped.clone();
            copy.slice(..).map_async(wgpu::MapMode::Read, move |result| {
                *mapped.lock().unwrap_or_else(PoisonError::into_inner) += usize::from(result.is_ok());
            });
        }
        device.poll(wgpu::PollType::wait_indefinitely()).ok()?;
        let mapped = *mapped.lock().unwrap_or_else(PoisonError::into_inner);
        (mapped == copies.len())
            .then(|| copies.map(|copy| bytemuck::pod_collect_to_vec(&copy.slice(..).get_mapped_range())))
    }
}

/// The frame's commands are submitted: its heights may be asked for.
pub(super) fn show_levels(gpu: Res<RainGpu>, levels: Res<WaveLevels>) {
    let (slot, drawn) = &*levels.0;
    let mut slot = slot.lock().unwrap_or_else(PoisonError::into_inner);
    slot.levels = gpu.wave_tile.as_ref().map(|tile| tile.levels().map(Clone::clone));
    slot.done = slot.handed;
    drawn.notify_all();
}
