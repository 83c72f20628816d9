//! What the GPU counted, read back; nobody waits for it.

use std::sync::{Arc, Mutex, PoisonError};

/// Counts on their way back from the GPU; while all of them are, frames go uncounted.
const UNDER_WAY: usize = 8;

/// Buffers that counts come back in.
#[derive(Default)]
pub(super) struct Counts {
    made: usize,
    /// Copied to in this frame.
    copied: Vec<wgpu::Buffer>,
    free: Arc<Mutex<Vec<wgpu::Buffer>>>,
}

impl Counts {
    /// Copies the first `bytes` of a buffer, always as many, into one that can be read, if one is free.
    pub(super) fn copy(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        counted: &wgpu::Buffer,
        bytes: u64,
    ) {
        let free = self.free.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let buffer = match free {
            Some(buffer) => buffer,
            None if self.made < UNDER_WAY => {
                self.made += 1;
                device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some("rain counts"),
                    size: bytes,
                    usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                    mapped_at_creation: false,
                })
            }
            None => return,
        };
        encoder.copy_buffer_to_buffer(counted, 0, &buffer, 0, buffer.size());
        self.copied.push(buffer);
    }

    /// The frame's commands are submitted: `note` gets the words of each copy when they come.
    pub(super) fn read(&mut self, note: impl Fn(&[u32]) + Clone + Send + 'static) {
        for buffer in self.copied.drain(..) {
            let (read, note, free) = (buffer.clone(), note.clone(), self.free.clone());
            buffer.slice(..).map_async(wgpu::MapMode::Read, move |result| {
                if result.is_ok() {
                    let words: Vec<u32> = bytemuck::pod_collect_to_vec(&read.slice(..).get_mapped_range());
                    read.unmap();
                    note(&words);
                    free.lock().unwrap_or_else(PoisonError::into_inner).push(read);
                }
            });
        }
    }
}
