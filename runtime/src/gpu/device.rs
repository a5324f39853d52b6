//! The GPU that everything is drawn with: opened here without a window, or the caller's own.

use std::fmt::Display;

/// A GPU that is ready to work.
pub struct Gpu {
    /// Makes resources.
    pub device: wgpu::Device,
    /// Runs commands.
    pub queue: wgpu::Queue,
    /// The adapter's name, its kind and its driver.
    pub name: String,
    /// Whether it is a software GPU, such as llvmpipe.
    pub is_software: bool,
}

/// Why the GPU could not draw.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    /// No adapter was found.
    #[error("no GPU adapter found ({reason})")]
    NoAdapter {
        /// wgpu's reason.
        reason: String,
    },
    /// An adapter was found, but gave no device.
    #[error("the GPU {name} does not open: {reason}")]
    NoDevice {
        /// The adapter's name.
        name: String,
        /// wgpu's reason.
        reason: String,
    },
    /// Something exceeds a limit of the device.
    #[error("{what} is {needed}; this GPU takes {limit}")]
    Limit {
        /// What exceeds it, with its unit.
        what: String,
        /// How much is needed.
        needed: u64,
        /// The device's limit.
        limit: u64,
    },
    /// Shadow maps exceed the device's limits or memory.
    #[error("shadow maps of {mebibytes} MiB do not fit this GPU")]
    MapMemory {
        /// Their size, MiB.
        mebibytes: u64,
    },
    /// A picture of this size could not be made.
    #[error("the GPU failed making a picture of this size: {reason}")]
    Picture {
        /// wgpu's reason.
        reason: String,
    },
    /// The device lacks a feature that the technique needs.
    #[error("this GPU cannot {what} ({feature})")]
    Lacks {
        /// What cannot be done without it.
        what: &'static str,
        /// The feature's name in wgpu.
        feature: &'static str,
    },
    /// A validation error, or no memory left.
    #[error("the GPU failed {doing}: {reason}")]
    Failed {
        /// During what.
        doing: &'static str,
        /// wgpu's reason.
        reason: String,
    },
}

impl GpuError {
    pub(super) fn failed(doing: &'static str, reason: impl Display) -> Self {
        Self::Failed { doing, reason: reason.to_string() }
    }

    pub(super) fn check_limit(what: impl Into<String>, needed: u64, limit: u64) -> Result<(), Self> {
        if needed <= limit { Ok(()) } else { Err(Self::Limit { what: what.into(), needed, limit }) }
    }
}

impl Gpu {
    /// Optional features, used where the device has them. Baked maps need none.
    ///
    /// | feature | without it |
    /// |---|---|
    /// | `DEPTH32FLOAT_STENCIL8` | no shadow volumes |
    /// | `FLOAT32_BLENDABLE` | no lit pictures under shadow volumes in 32-bit formats, which reading back uses |
    /// | `DEPTH_CLIP_CONTROL` | casters above a shadow map are cut off, and volumes may be near infinity |
    /// | `TIMESTAMP_QUERY` | passes are not timed |
    pub const WANTED_FEATURES: wgpu::Features = wgpu::Features::DEPTH32FLOAT_STENCIL8
        .union(wgpu::Features::FLOAT32_BLENDABLE)
        .union(wgpu::Features::DEPTH_CLIP_CONTROL)
        .union(wgpu::Features::TIMESTAMP_QUERY);

    /// Opens the fastest adapter there is, with all of its limits.
    pub fn open() -> Result<Self, GpuError> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&options))
            .map_err(|e| GpuError::NoAdapter { reason: e.to_string() })?;
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("sunplay"),
            required_features: Self::WANTED_FEATURES & adapter.features(),
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|e| GpuError::NoDevice { name: adapter.get_info().name, reason: e.to_string() })?;
        Ok(Self::from_device(device, queue))
    }

    /// Uses the caller's device and queue.
    ///
    /// No feature is required; request [`Gpu::WANTED_FEATURES`] as far as the adapter has them.
    /// `wgpu::Limits::default()` serves pages of up to 8192 texels and 256 layers. Larger sets need larger
    /// `max_texture_dimension_2d`, `max_texture_array_layers` and `max_buffer_size`: what does not fit is
    /// [`GpuError::Limit`].
    ///
    /// Device and queue are handles: clone them, and keep on using yours.
    pub fn from_device(device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let info = device.adapter_info();
        let is_software = info.device_type == wgpu::DeviceType::Cpu;
        let name = format!("{} ({:?}, {})", info.name, info.device_type, info.driver);
        Self { device, queue, name, is_software }
    }

    /// An error where the device lacks a feature: what it cannot do, and the feature's name.
    pub(super) fn check_feature(
        &self,
        feature: wgpu::Features,
        what: &'static str,
        name: &'static str,
    ) -> Result<(), GpuError> {
        if self.device.features().contains(feature) { Ok(()) } else { Err(GpuError::Lacks { what, feature: name }) }
    }

    /// An error where a picture of this format cannot be added to. Only 32-bit formats need a feature for that.
    pub(super) fn check_blendable(&self, format: wgpu::TextureFormat, what: &'static str) -> Result<(), GpuError> {
        use wgpu::TextureFormat::{R32Float, Rg32Float, Rgba32Float};
        match format {
            R32Float | Rg32Float | Rgba32Float => {
                self.check_feature(wgpu::Features::FLOAT32_BLENDABLE, what, "FLOAT32_BLENDABLE")
            }
            _ => Ok(()),
        }
    }

    /// A new command encoder.
    pub(super) fn encoder(&self) -> wgpu::CommandEncoder {
        self.device.create_command_encoder(&Default::default())
    }

    /// Whether depths outside of [0, 1] can be clamped, where others would be cut off.
    pub(super) fn clamps_depth(&self) -> bool {
        self.device.features().contains(wgpu::Features::DEPTH_CLIP_CONTROL)
    }

    /// Runs `work`. A validation or out-of-memory error of the device becomes an error.
    pub(super) fn checked<T>(&self, doing: &'static str, work: impl FnOnce() -> T) -> Result<T, GpuError> {
        let memory = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let validity = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let made = work();
        let complaints = [pollster::block_on(validity.pop()), pollster::block_on(memory.pop())];
        match complaints.into_iter().flatten().next() {
            Some(complaint) => Err(GpuError::failed(doing, complaint)),
            None => Ok(made),
        }
    }
}
