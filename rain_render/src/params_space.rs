//! Where passes read their parameters from.

use std::borrow::Cow;
use std::sync::OnceLock;

/// What a buffer of parameters is made for: it serves in either space.
pub(crate) const PARAMS: wgpu::BufferUsages = wgpu::BufferUsages::UNIFORM.union(wgpu::BufferUsages::STORAGE);

/// Storage buffers that the pass with most of them then has in a stage.
pub const STORAGE_BUFFERS: u32 = 10;

/// Address space of what a pass's invocations only read and all read alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParamsSpace {
    /// GPUs have caches for these, and more bindings in all.
    Uniform,
    /// Mesa's software Vulkan builds shaders anew, with the numbers that branches test written into them, whenever a pass is bound
    /// with uniform buffers, and keeps all of them: 7 MB and 50 ms a frame of heavy rain. It leaves storage buffers alone. Passes
    /// none of whose branches and loops test parameters alone are faster with uniform buffers there too.
    Storage,
}

impl ParamsSpace {
    /// The space for a device: storage for one that is software and allows all of [`STORAGE_BUFFERS`] in a stage, which is more
    /// than every WebGPU does.
    #[must_use]
    pub fn of(device: &wgpu::Device) -> Self {
        let software = device.adapter_info().device_type == wgpu::DeviceType::Cpu;
        if software && device.limits().max_storage_buffers_per_shader_stage >= STORAGE_BUFFERS {
            Self::Storage
        } else {
            Self::Uniform
        }
    }

    /// WGSL that declares its parameters uniform, for this space.
    #[must_use]
    pub fn source(self, module: &str) -> Cow<'_, str> {
        match self {
            Self::Uniform => module.into(),
            Self::Storage => module.replace("var<uniform>", "var<storage, read>").into(),
        }
    }

    /// How a layout has a buffer of parameters.
    pub(crate) fn binding(self) -> wgpu::BufferBindingType {
        match self {
            Self::Uniform => wgpu::BufferBindingType::Uniform,
            Self::Storage => wgpu::BufferBindingType::Storage { read_only: true },
        }
    }
}

/// What a pass has once for each space, made when it is first needed.
#[derive(Debug)]
pub(crate) struct BySpace<T> {
    of_device: ParamsSpace,
    uniform: OnceLock<T>,
    storage: OnceLock<T>,
}

impl<T> BySpace<T> {
    pub fn new(device: &wgpu::Device) -> Self {
        Self {
            of_device: ParamsSpace::of(device),
            uniform: OnceLock::new(),
            storage: OnceLock::new(),
        }
    }

    /// The space of a pass; `branching`: branches or loops of it test parameters alone.
    pub fn space(&self, branching: bool) -> ParamsSpace {
        if branching {
            self.of_device
        } else {
            ParamsSpace::Uniform
        }
    }

    /// That of a space.
    pub fn get(&self, space: ParamsSpace, make: impl FnOnce(ParamsSpace) -> T) -> &T {
        let slot = match space {
            ParamsSpace::Uniform => &self.uniform,
            ParamsSpace::Storage => &self.storage,
        };
        slot.get_or_init(|| make(space))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_are_declared_in_the_space_they_are_read_from() {
        let module = "var<uniform> a: A; var<storage, read_write> b: B;";
        assert_eq!(ParamsSpace::Uniform.source(module), module);
        let stored = "var<storage, read> a: A; var<storage, read_write> b: B;";
        assert_eq!(ParamsSpace::Storage.source(module), stored);
    }
}
