//! A bare wgpu device and small compute kernels over `rain_render`'s shader library.

use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use pollster::block_on;
use rain_render::compose;

/// A device without Bevy.
pub struct Device {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
}

/// The device that all tests share, one at a time; `None`, with the reason on stderr, where there is no adapter.
///
/// # Panics
/// Without an adapter, where `RAIN_GPU=required` is set (`cargo xtask test` sets it): then a skip would hide a broken
/// set-up.
pub fn device() -> Option<MutexGuard<'static, Device>> {
    static SHARED: OnceLock<Option<Mutex<Device>>> = OnceLock::new();
    let shared = SHARED.get_or_init(|| open().map(Mutex::new)).as_ref();
    if shared.is_none() {
        let required = std::env::var("RAIN_GPU").is_ok_and(|v| v == "required");
        assert!(!required, "RAIN_GPU=required, but there is no graphics adapter");
        eprintln!("skipped: no graphics adapter");
    }
    Some(shared?.lock().unwrap_or_else(PoisonError::into_inner))
}

fn open() -> Option<Device> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    // Finding the line of every expression of the library takes longer than compiling it.
    descriptor.flags.remove(wgpu::InstanceFlags::DEBUG);
    let instance = wgpu::Instance::new(descriptor);
    let adapter = block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default())).ok()?;
    let (device, queue) = block_on(adapter.request_device(&wgpu::DeviceDescriptor::default())).expect("a device");
    Some(Device { device, queue })
}

/// The complete library as one WGSL text.
pub fn library() -> String {
    let mut source = compose::constants();
    source.push_str(compose::TYPES);
    for library in compose::LIBRARIES {
        source.push_str(library.source);
    }
    source
}

impl Device {
    /// A buffer with these bytes.
    pub fn buffer(&self, bytes: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: bytes.len() as u64,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.queue.write_buffer(&buffer, 0, bytes);
        buffer
    }

    /// What a buffer holds, after everything submitted so far.
    pub fn read(&self, buffer: &wgpu::Buffer, bytes: u64) -> Vec<u8> {
        let copy = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: bytes,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder = self
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &copy, 0, bytes);
        self.queue.submit([encoder.finish()]);
        copy.slice(..)
            .map_async(wgpu::MapMode::Read, |mapped| mapped.expect("the buffer is mapped"));
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .expect("the device answers");
        copy.slice(..).get_mapped_range().to_vec()
    }

    /// Runs `source` (entry `main`, workgroups of 64; binding 0 input, 1 output, then `more`) once for each input.
    pub fn compute<I: bytemuck::Pod, O: bytemuck::Pod>(
        &self,
        source: &str,
        input: &[I],
        more: &[wgpu::BindingResource],
    ) -> Vec<O> {
        let bytes = (input.len() * size_of::<O>()) as u64;
        let input_buffer = self.buffer(bytemuck::cast_slice(input), wgpu::BufferUsages::STORAGE);
        let output = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: bytes,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let module = self.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(source.into()),
        });
        let pipeline = self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: None,
            module: &module,
            entry_point: Some("main"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        let mut entries = vec![input_buffer.as_entire_binding(), output.as_entire_binding()];
        entries.extend(more.iter().cloned());
        let entries: Vec<wgpu::BindGroupEntry> = (0..)
            .zip(entries)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        let mut encoder = self
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups((input.len() as u32).div_ceil(64), 1, 1);
        }
        self.queue.submit([encoder.finish()]);
        let bytes = self.read(&output, bytes);
        bytemuck::pod_collect_to_vec(&bytes)
    }
}

/// A kernel over the library: `body` gets `i` and `input[i]` and writes `output[i]`.
pub fn kernel(library: &str, input: &str, output: &str, body: &str) -> String {
    format!(
        "{library}
@group(0) @binding(0) var<storage, read> input: array<{input}>;
@group(0) @binding(1) var<storage, read_write> output: array<{output}>;
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
    let i = id.x;
    if (i >= arrayLength(&input)) {{ return; }}
    {body}
}}
"
    )
}

#[test]
fn a_device_with_the_limits_of_every_webgpu_has_its_parameters_uniform() {
    use rain_render::params_space::{ParamsSpace, STORAGE_BUFFERS};
    let Some(device) = device() else { return };
    assert!(device.device.limits().max_storage_buffers_per_shader_stage < STORAGE_BUFFERS);
    assert_eq!(ParamsSpace::of(&device.device), ParamsSpace::Uniform);
}
