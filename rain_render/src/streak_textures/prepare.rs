//! The pipelines, the texture array, and what it takes to make it.

use rain_core::error::ConfigError;
use rain_core::rainfall::{PackedStreaks, StreakLayer, StreakTextureSettings};

use super::params::{SLOT, STREAK_FORMAT, layer_bytes, levels, row_bytes, tiles};
use crate::bindings::{compute_pipeline, storage_entry};
use crate::compose;
use crate::gpu_types::{StreakLevel, StreakTile};
use crate::params_space::{PARAMS, ParamsSpace};

/// Everything of the pass that lives as long as the device.
#[derive(Debug)]
pub struct StreakTextureGpu {
    layout: wgpu::BindGroupLayout,
    pub(super) add: wgpu::ComputePipeline,
    pub(super) resolve: wgpu::ComputePipeline,
    pub(super) halve: wgpu::ComputePipeline,
    pub(super) pack: wgpu::ComputePipeline,
}

impl StreakTextureGpu {
    /// Builds the pipelines.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let compute = wgpu::ShaderStages::COMPUTE;
        let slot = |binding, size: usize| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: compute,
            ty: wgpu::BindingType::Buffer {
                ty: ParamsSpace::of(device).binding(),
                has_dynamic_offset: true,
                min_binding_size: wgpu::BufferSize::new(size as u64),
            },
            count: None,
        };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("rain streak textures"),
            entries: &[
                slot(0, size_of::<StreakTile>()),
                slot(1, size_of::<StreakLevel>()),
                storage_entry(2, compute, true),
                storage_entry(3, compute, false),
                storage_entry(4, compute, false),
                storage_entry(5, compute, false),
            ],
        });
        let module = compose::shader(device, "streak_texture");
        let pipeline = |entry| compute_pipeline(device, "rain streak textures", &module, entry, &[&layout]);
        Self {
            add: pipeline("add"),
            resolve: pipeline("resolve"),
            halve: pipeline("halve"),
            pack: pipeline("pack"),
            layout,
        }
    }
}

/// What is needed until the textures are made.
#[derive(Debug)]
pub(super) struct Bake {
    pub group: wgpu::BindGroup,
    pub overlap: wgpu::Buffer,
    pub packed: wgpu::Buffer,
    pub tiles: Vec<StreakTile>,
    pub levels: Vec<StreakLevel>,
}

/// The textures of some settings.
#[derive(Debug)]
pub struct StreakArray {
    key: u64,
    settings: StreakTextureSettings,
    layers: Vec<StreakLayer>,
    pub(super) texture: wgpu::Texture,
    view: wgpu::TextureView,
    pub(super) bake: Option<Bake>,
}

impl StreakArray {
    /// Makes room for the textures of `settings` and uploads their drops; [`super::encode_streak_textures`] draws them.
    ///
    /// # Errors
    /// As [`StreakTextureSettings::layers`].
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        gpu: &StreakTextureGpu,
        settings: &StreakTextureSettings,
    ) -> Result<Self, ConfigError> {
        let mut array = Self::empty(device, settings)?;
        array.bake = Some(array.begin(device, queue, gpu));
        Ok(array)
    }

    /// Uploads textures that were made before.
    ///
    /// # Errors
    /// As [`StreakTextureSettings::layers`].
    pub fn upload(device: &wgpu::Device, queue: &wgpu::Queue, textures: &PackedStreaks) -> Result<Self, ConfigError> {
        let array = Self::empty(device, textures.settings())?;
        for (level, texels) in textures.levels().iter().enumerate() {
            let side = array.settings.texels >> level;
            queue.write_texture(
                wgpu::TexelCopyTextureInfo {
                    texture: &array.texture,
                    mip_level: level as u32,
                    origin: wgpu::Origin3d::ZERO,
                    aspect: wgpu::TextureAspect::All,
                },
                bytemuck::cast_slice(texels),
                wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(2 * side),
                    rows_per_image: Some(side),
                },
                wgpu::Extent3d {
                    width: side,
                    height: side,
                    depth_or_array_layers: array.layers.len() as u32,
                },
            );
        }
        Ok(array)
    }

    /// Follows the settings: nothing happens while their key is the same; else the textures are to be made anew.
    ///
    /// # Errors
    /// As [`StreakTextureSettings::layers`]; the textures stay as they were.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        gpu: &StreakTextureGpu,
        settings: &StreakTextureSettings,
    ) -> Result<(), ConfigError> {
        if settings.key() != self.key {
            *self = Self::new(device, queue, gpu, settings)?;
        }
        Ok(())
    }

    fn empty(device: &wgpu::Device, settings: &StreakTextureSettings) -> Result<Self, ConfigError> {
        let layers = settings.layers()?;
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("rain streak textures"),
            size: wgpu::Extent3d {
                width: settings.texels,
                height: settings.texels,
                depth_or_array_layers: layers.len() as u32,
            },
            mip_level_count: settings.level_count(),
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: STREAK_FORMAT,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        Ok(Self {
            key: settings.key(),
            settings: settings.clone(),
            layers,
            texture,
            view,
            bake: None,
        })
    }

    fn begin(&self, device: &wgpu::Device, queue: &wgpu::Queue, gpu: &StreakTextureGpu) -> Bake {
        let levels = levels(&self.settings);
        let (drops, tiles) = tiles(&self.layers, self.settings.texels);
        let buffer = |label, bytes: u64, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: bytes,
                usage,
                mapped_at_creation: false,
            })
        };
        let (storage, to) = (wgpu::BufferUsages::STORAGE, wgpu::BufferUsages::COPY_DST);
        let mut slots = vec![0_u8; SLOT * (tiles.len() + levels.len())];
        let all = tiles
            .iter()
            .map(bytemuck::bytes_of)
            .chain(levels.iter().map(bytemuck::bytes_of));
        for (slot, bytes) in slots.chunks_exact_mut(SLOT).zip(all) {
            slot[..bytes.len()].copy_from_slice(bytes);
        }
        let parameters = buffer("rain streak texture parameters", slots.len() as u64, PARAMS | to);
        queue.write_buffer(&parameters, 0, &slots);
        let drop_bytes: &[u8] = bytemuck::cast_slice(&drops);
        let drop_buffer = buffer("rain streak texture drops", drop_bytes.len() as u64, storage | to);
        queue.write_buffer(&drop_buffer, 0, drop_bytes);
        let side = u64::from(self.settings.texels);
        let overlap = buffer("rain streak texture overlap", 4 * side * side, storage | to);
        let texels: u64 = levels.iter().map(|level| u64::from(level.side).pow(2)).sum();
        let texel_buffer = buffer("rain streak texture levels", 4 * texels, storage);
        let packed = buffer(
            "rain streak texture packed",
            layer_bytes(&levels),
            storage | wgpu::BufferUsages::COPY_SRC,
        );
        let slot = |size: usize| {
            wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer: &parameters,
                offset: 0,
                size: wgpu::BufferSize::new(size as u64),
            })
        };
        let resources = [
            slot(size_of::<StreakTile>()),
            slot(size_of::<StreakLevel>()),
            drop_buffer.as_entire_binding(),
            overlap.as_entire_binding(),
            texel_buffer.as_entire_binding(),
            packed.as_entire_binding(),
        ];
        let entries: Vec<wgpu::BindGroupEntry> = (0..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("rain streak textures"),
            layout: &gpu.layout,
            entries: &entries,
        });
        Bake {
            group,
            overlap,
            packed,
            tiles,
            levels,
        }
    }

    /// Whether the textures are still to be drawn.
    #[must_use]
    pub fn wants_pass(&self) -> bool {
        self.bake.is_some()
    }

    /// The key of what they are made from.
    #[must_use]
    pub fn key(&self) -> u64 {
        self.key
    }

    /// What they are made from.
    #[must_use]
    pub fn settings(&self) -> &StreakTextureSettings {
        &self.settings
    }

    /// The layers, in the array's order.
    #[must_use]
    pub fn layers(&self) -> &[StreakLayer] {
        &self.layers
    }

    /// The whole array.
    #[must_use]
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }

    /// GPU memory that stays. Units: bytes.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        self.settings.bytes()
    }

    /// Size of the buffer that [`StreakArray::encode_copy`] fills. Units: bytes.
    #[must_use]
    pub fn copy_bytes(&self) -> u64 {
        layer_bytes(&levels(&self.settings)) * self.layers.len() as u64
    }

    /// Copies all texels to a buffer (usage `COPY_DST`), for [`StreakArray::unpack`] and a cache on disk.
    pub fn encode_copy(&self, encoder: &mut wgpu::CommandEncoder, buffer: &wgpu::Buffer) {
        let mut offset = 0;
        for (index, level) in levels(&self.settings).iter().enumerate() {
            let layers = self.layers.len() as u32;
            encoder.copy_texture_to_buffer(
                wgpu::TexelCopyTextureInfo {
                    texture: &self.texture,
                    mip_level: index as u32,
                    origin: wgpu::Origin3d::ZERO,
                    aspect: wgpu::TextureAspect::All,
                },
                wgpu::TexelCopyBufferInfo {
                    buffer,
                    layout: wgpu::TexelCopyBufferLayout {
                        offset,
                        bytes_per_row: Some(row_bytes(level.side)),
                        rows_per_image: Some(level.side),
                    },
                },
                wgpu::Extent3d {
                    width: level.side,
                    height: level.side,
                    depth_or_array_layers: layers,
                },
            );
            offset += u64::from(row_bytes(level.side) * level.side * layers);
        }
    }

    /// The textures from the bytes that [`StreakArray::encode_copy`] left in a buffer. `None` when they are too few, or
    /// no textures.
    #[must_use]
    pub fn unpack(&self, bytes: &[u8]) -> Option<PackedStreaks> {
        let mut rest = bytes;
        let mut out = Vec::new();
        for level in levels(&self.settings) {
            let (row, side) = (row_bytes(level.side) as usize, level.side as usize);
            let (own, after) = rest.split_at_checked(row * side * self.layers.len())?;
            rest = after;
            out.push(
                own.chunks_exact(row)
                    .flat_map(|row| row[..2 * side].chunks_exact(2))
                    .map(|texel| u16::from_le_bytes([texel[0], texel[1]]))
                    .collect(),
            );
        }
        PackedStreaks::new(&self.settings, out)
    }
}
