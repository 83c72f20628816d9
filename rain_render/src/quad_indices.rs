//! Indices of quads whose two triangles share corners: four vertices a quad instead of six.

/// Quads of one draw: as many as 16-bit indices reach.
const MOST: u32 = 1 << 14;

/// Indices of the first quads, for any number of them: draws after the first begin at later vertices.
#[derive(Debug)]
pub(crate) struct QuadIndices(wgpu::Buffer);

impl QuadIndices {
    /// 192 KiB that live with the device.
    pub fn new(device: &wgpu::Device) -> Self {
        let corners = (0..MOST).flat_map(|quad| [0, 1, 2, 2, 1, 3].map(|corner| (4 * quad + corner) as u16));
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

    /// Draws `quads` quads with the pipeline and the bindings that are set; corner c of quad q is vertex 4q + c.
    pub fn draw(&self, pass: &mut wgpu::RenderPass, quads: u32) {
        pass.set_index_buffer(self.0.slice(..), wgpu::IndexFormat::Uint16);
        for from in (0..quads).step_by(MOST as usize) {
            let some = (quads - from).min(MOST);
            pass.draw_indexed(0..6 * some, 4 * from as i32, 0..1);
        }
    }
}
