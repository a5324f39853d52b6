//! An adapter and a device, opened without a window.

use std::fmt::Display;

/// A GPU that is ready to work.
pub struct Gpu {
    /// What makes things.
    pub device: wgpu::Device,
    /// What does things.
    pub queue: wgpu::Queue,
    /// The adapter's name, its kind and its driver.
    pub name: String,
    /// Whether it is a CPU that plays a GPU.
    pub is_software: bool,
}

/// What is used where the adapter has it.
const WANTED: [wgpu::Features; 4] = [
    // Shadow volumes are counted beside depths in floating point.
    wgpu::Features::DEPTH32FLOAT_STENCIL8,
    // Lights are added up in pictures of 32 bits.
    wgpu::Features::FLOAT32_BLENDABLE,
    // Casters above a shadow map are drawn at its top, and volumes reach to infinity.
    wgpu::Features::DEPTH_CLIP_CONTROL,
    // Passes are timed.
    wgpu::Features::TIMESTAMP_QUERY,
];

/// What a GPU could not do.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    /// There is none.
    #[error(
        "no GPU adapter found ({reason}); install a Vulkan driver (Mesa's lavapipe will do), or draw with --renderer cpu"
    )]
    NoAdapter {
        /// What was tried.
        reason: String,
    },
    /// There is one, and it does not open.
    #[error("the GPU {name} does not open: {reason}; draw with --renderer cpu")]
    NoDevice {
        /// Which.
        name: String,
        /// What it says.
        reason: String,
    },
    /// The set does not fit the adapter.
    #[error("{what} is {needed}; this GPU takes {limit}: draw with --renderer cpu, or bake with a smaller --size")]
    Limit {
        /// What does not fit.
        what: String,
        /// Its measure.
        needed: u64,
        /// The adapter's.
        limit: u64,
    },
    /// Shadow maps do not fit.
    #[error("shadow maps of {mebibytes} MiB do not fit this GPU: give a smaller --map-size, or fewer --cascades")]
    MapMemory {
        /// What they would take.
        mebibytes: u64,
    },
    /// It lacks what a technique is made of.
    #[error("this GPU cannot {what} ({feature}): draw another --technique")]
    Lacks {
        /// What it cannot do.
        what: &'static str,
        /// The missing feature's name.
        feature: &'static str,
    },
    /// It failed while working.
    #[error("the GPU failed {doing}: {reason}; draw with --renderer cpu")]
    Failed {
        /// At what.
        doing: &'static str,
        /// What it says.
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
    /// Opens the fastest adapter there is.
    pub fn open() -> Result<Self, GpuError> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&options))
            .map_err(|e| GpuError::NoAdapter { reason: e.to_string() })?;
        let info = adapter.get_info();
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("sunplay"),
            required_features: WANTED.into_iter().fold(wgpu::Features::empty(), |all, one| all | one)
                & adapter.features(),
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|e| GpuError::NoDevice { name: info.name.clone(), reason: e.to_string() })?;
        let is_software = info.device_type == wgpu::DeviceType::Cpu;
        let name = format!("{} ({:?}, {})", info.name, info.device_type, info.driver);
        Ok(Self { device, queue, name, is_software })
    }

    /// Whether the GPU has a feature, or what it cannot do without.
    pub(super) fn check_feature(
        &self,
        feature: wgpu::Features,
        what: &'static str,
        name: &'static str,
    ) -> Result<(), GpuError> {
        if self.device.features().contains(feature) { Ok(()) } else { Err(GpuError::Lacks { what, feature: name }) }
    }

    /// Whether depths outside of the range can be clamped to it.
    pub(super) fn clamps_depth(&self) -> bool {
        self.device.features().contains(wgpu::Features::DEPTH_CLIP_CONTROL)
    }

    /// Runs `work` and turns what the device complains of into an error.
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
