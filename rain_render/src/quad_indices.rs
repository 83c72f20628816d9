//! Indices of quads whose two triangles share corners: four vertices a quad instead of six.

/// Quads of one draw at most: as many as 16-bit indices reach.
const MOST_QUADS: u32 = 1 << 14;

/// Quads of one draw: fewer on a software device, where small draws of as many quads together take less time than large ones.
pub(crate) fn quads_of_a_draw(device: &wgpu::Device) -> u32 {
    if device.adapter_info().device_type == wgpu::DeviceType::Cpu {
        1 << 10
    } else {
        MOST_QUADS
    }
}

/// Indices of the first quads, for any number of them: draws after the first begin at later vertices.
#[derive(Debug)]
pub(crate) struct QuadIndices(wgpu::Buffer);

impl QuadIndices {
    /// Up to 192 KiB that live with the device.
    pub fn new(device: &wgpu::Device) -> Self {
        let corners =
            (0..quads_of_a_draw(device)).flat_map(|quad| [0, 1, 2, 2, 1, 3].map(|corner| (4 * quad + corner) as u16));
        let bytes: Vec<u8> = corners.flat_map(u16::to_le_bytes).collect();
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("rain quad indices"),
            size: bytes.len() as u64,
            usage: wgpu::BufferUsages::INDEX,
            mapped_at_creation: true,
        });
        buffer.slice(..).get_mapped_range_mut().copy_from_slice(&bytes);
        buffer.unmap();
        Self(buffer)
    }

    /// Draws quads with the pipeline and the bindings that are set; corner c of quad q is vertex 4q + c. How many there are
    /// stands in `draws` draws' arguments, from byte `offset` of `arguments` on.
    pub fn draw(&self, pass: &mut wgpu::RenderPass, arguments: &wgpu::Buffer, offset: u64, draws: u32) {
        pass.set_index_buffer(self.0.slice(..), wgpu::IndexFormat::Uint16);
        for draw in 0..u64::from(draws) {
            pass.draw_indexed_indirect(arguments, offset + DRAW_BYTES * draw);
        }
    }
}

/// Arguments of one indexed draw.
pub(crate) const DRAW_BYTES: u64 = 20;

/// Arguments of `draws` draws of `most` quads each for `quads` quads, as the shader that counts drops writes them.
pub(crate) fn draw_words(quads: u32, draws: u32, most: u32) -> impl Iterator<Item = u32> {
    (0..draws).flat_map(move |draw| {
        let first = most * draw;
        let some = (quads - first.min(quads)).min(most);
        [6 * some, 1, 0, 4 * first, 0]
    })
}
