//! The graphics device: which adapters are good enough, what is asked of them, and what happens when one fails.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

use wgpu::{Backends, DeviceType, Features};

/// Bytes of colour attachments that the G-buffer writes per sample: four targets of four words.
pub const GBUFFER_BYTES_PER_SAMPLE: u32 = 64;

/// What to do on a machine without a driver; ends every message about a missing adapter.
pub const DRIVER_REMEDY: &str =
    "install a Vulkan driver for the graphics card, or `mesa-vulkan-drivers` for the software rasteriser";

/// Why there is no device, or no longer one.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GpuError {
    /// No adapter at all, or none that is accepted.
    #[error("no usable graphics adapter for Vulkan, Metal or DX12 ({found}; OpenGL alone is refused); {DRIVER_REMEDY}")]
    NoAdapter {
        /// What was found and why each was refused.
        found: String,
    },
    /// The driver refused to open the adapter.
    #[error("adapter `{adapter}` cannot be opened: {reason}; update its driver")]
    Open {
        /// Name of the adapter.
        adapter: String,
        /// The driver's words.
        reason: String,
    },
    /// The device was lost or reported an error; nothing is drawn with it any more.
    #[error("the graphics device failed: {0}; start again, and update the driver if it happens twice")]
    Failed(String),
}

/// What an adapter is and whether Burnish runs on it.
#[derive(Debug, Clone)]
pub struct AdapterReport {
    /// Name the driver gives.
    pub name: String,
    /// Vulkan, Metal, Dx12 or Gl.
    pub backend: String,
    /// Discrete, integrated, virtual or CPU.
    pub device_type: String,
    /// Driver and its version.
    pub driver: String,
    /// Why it is refused.
    pub accepted: Result<(), String>,
    /// Limits that matter here, with the adapter's values.
    pub limits: Vec<(&'static str, String)>,
    /// Optional features that it has and Burnish uses.
    pub features: Vec<String>,
}

/// An open device with its queue.
///
/// Errors that no scope catches and the loss of the device are kept here and returned by [`Gpu::check`]; after one of
/// them the renderer stops instead of drawing on. Clones share the device.
#[derive(Clone)]
pub struct Gpu {
    /// The wgpu device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    report: AdapterReport,
    software: bool,
    failure: Arc<Failure>,
}

#[derive(Default)]
struct Failure {
    happened: AtomicBool,
    message: Mutex<String>,
}

impl Failure {
    /// Keeps the first message: later ones follow from it.
    fn set(&self, text: String) {
        if let Ok(mut message) = self.message.lock()
            && !self.happened.swap(true, Ordering::AcqRel)
        {
            *message = text;
        }
    }
}

/// Features that are used where they exist.
fn optional_features() -> Features {
    Features::FLOAT32_FILTERABLE
        | Features::FLOAT32_BLENDABLE
        | Features::TIMESTAMP_QUERY
        | Features::TIMESTAMP_QUERY_INSIDE_ENCODERS
}

/// Backends that Burnish runs on. OpenGL is left out: its cube faces cannot be rendered to reliably, and lights and
/// environments are cubes.
pub const ACCEPTED: Backends = Backends::VULKAN.union(Backends::METAL).union(Backends::DX12);

fn instance() -> wgpu::Instance {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = ACCEPTED;
    wgpu::Instance::new(descriptor)
}

/// All adapters of the machine, the unusable ones with the reason.
pub fn adapters() -> Vec<AdapterReport> {
    pollster::block_on(instance().enumerate_adapters(Backends::all())).iter().map(report).collect()
}

fn report(adapter: &wgpu::Adapter) -> AdapterReport {
    let info = adapter.get_info();
    let limits = adapter.limits();
    let features = optional_features() & adapter.features();
    AdapterReport {
        name: info.name.clone(),
        backend: format!("{:?}", info.backend),
        device_type: format!("{:?}", info.device_type),
        driver: format!("{} {}", info.driver, info.driver_info).trim().to_string(),
        accepted: accept(info.backend, &limits),
        limits: vec![
            ("largest 2D texture", limits.max_texture_dimension_2d.to_string()),
            ("storage binding, bytes", limits.max_storage_buffer_binding_size.to_string()),
            ("buffer, bytes", limits.max_buffer_size.to_string()),
            ("colour bytes per sample", limits.max_color_attachment_bytes_per_sample.to_string()),
        ],
        features: features.iter_names().map(|(name, _)| name.to_string()).collect(),
    }
}

/// The rule by which an adapter is taken or refused, the reason in words.
pub fn accept(backend: wgpu::Backend, limits: &wgpu::Limits) -> Result<(), String> {
    if !ACCEPTED.contains(backend.into()) {
        return Err(format!("its backend {backend:?} is not one of Vulkan, Metal and DX12"));
    }
    let needed = required_limits();
    let mut lacks = Vec::new();
    needed.check_limits_with_fail_fn(limits, false, |name, wanted, allowed| {
        lacks.push(format!("{name} is {allowed}, {wanted} is needed"));
    });
    if lacks.is_empty() { Ok(()) } else { Err(lacks.join("; ")) }
}

fn required_limits() -> wgpu::Limits {
    wgpu::Limits { max_color_attachment_bytes_per_sample: GBUFFER_BYTES_PER_SAMPLE, ..wgpu::Limits::default() }
}

/// Hardware before software.
fn preference(device_type: DeviceType) -> u32 {
    match device_type {
        DeviceType::DiscreteGpu => 0,
        DeviceType::IntegratedGpu => 1,
        DeviceType::VirtualGpu => 2,
        DeviceType::Other => 3,
        DeviceType::Cpu => 4,
    }
}

/// The best adapter that is accepted, among those that `usable` lets through (such as by a window's surface).
pub fn choose(adapters: &[wgpu::Adapter], usable: impl Fn(&wgpu::Adapter) -> bool) -> Result<&wgpu::Adapter, GpuError> {
    let accepted = |a: &&wgpu::Adapter| accept(a.get_info().backend, &a.limits()).is_ok() && usable(a);
    let best = adapters.iter().filter(accepted).min_by_key(|a| preference(a.get_info().device_type));
    best.ok_or_else(|| {
        let found: Vec<_> = adapters.iter().map(report).map(|r| refusal(&r)).collect();
        let found = if found.is_empty() { "none found".to_string() } else { found.join("; ") };
        GpuError::NoAdapter { found }
    })
}

/// What a device must be opened with: buffers and textures as large as the adapter allows, everything else as every
/// adapter allows.
pub fn device_descriptor(adapter: &wgpu::Adapter) -> wgpu::DeviceDescriptor<'static> {
    let allowed = adapter.limits();
    wgpu::DeviceDescriptor {
        label: Some("burnish"),
        required_features: optional_features() & adapter.features(),
        required_limits: wgpu::Limits {
            max_texture_dimension_2d: allowed.max_texture_dimension_2d,
            max_buffer_size: allowed.max_buffer_size,
            max_storage_buffer_binding_size: allowed.max_storage_buffer_binding_size,
            ..required_limits()
        },
        ..Default::default()
    }
}

impl Gpu {
    /// Opens the best adapter that is accepted.
    pub fn new() -> Result<Gpu, GpuError> {
        pollster::block_on(Gpu::open())
    }

    async fn open() -> Result<Gpu, GpuError> {
        let adapters = instance().enumerate_adapters(Backends::all()).await;
        let adapter = choose(&adapters, |_| true)?;
        let (device, queue) = adapter
            .request_device(&device_descriptor(adapter))
            .await
            .map_err(|e| GpuError::Open { adapter: adapter.get_info().name, reason: e.to_string() })?;
        Ok(Gpu::from_parts(adapter, device, queue))
    }

    /// A device that a window has opened, with what [`device_descriptor`] asks for. Takes over its callbacks for errors
    /// and loss: call it once per device and clone the result.
    pub fn from_parts(adapter: &wgpu::Adapter, device: wgpu::Device, queue: wgpu::Queue) -> Gpu {
        let failure = Arc::new(Failure::default());
        let uncaptured = failure.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            let text = error.to_string();
            if !is_surface_race(&text) {
                uncaptured.set(text);
            }
        }));
        let lost = failure.clone();
        device.set_device_lost_callback(move |reason, message| {
            if reason != wgpu::DeviceLostReason::Destroyed {
                lost.set(format!("device lost: {message}"));
            }
        });
        let software = adapter.get_info().device_type == DeviceType::Cpu;
        Gpu { device, queue, report: report(adapter), software, failure }
    }

    /// What the device runs on.
    pub fn report(&self) -> &AdapterReport {
        &self.report
    }

    /// True on a software rasteriser, where shading is dear and time stamps mean little.
    pub fn is_software(&self) -> bool {
        self.software
    }

    /// True when the device was opened with the feature.
    pub fn has(&self, feature: Features) -> bool {
        self.device.features().contains(feature)
    }

    /// The first error that no scope caught, if there was one.
    pub fn check(&self) -> Result<(), GpuError> {
        if !self.failure.happened.load(Ordering::Acquire) {
            return Ok(());
        }
        let message = self.failure.message.lock().map(|m| m.clone()).unwrap_or_default();
        Err(GpuError::Failed(message))
    }

    /// A buffer with contents. Unlike wgpu's own helper it does not map the buffer, which panics once the device is lost.
    pub fn buffer(&self, label: &str, contents: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: (contents.len() as u64).next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT),
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.queue.write_buffer(&buffer, 0, contents);
        buffer
    }

    /// Waits until all submitted work is done.
    pub fn wait(&self) -> Result<(), GpuError> {
        self.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|e| GpuError::Failed(e.to_string()))?;
        self.check()
    }
}

/// A window that changes its size while another thread draws: its surface is refused once and configured again by the
/// next frame. Nothing is wrong with the device. wgpu has no type for it, only these words.
fn is_surface_race(text: &str) -> bool {
    text.contains("come idle before reconfiguring the Surface")
}

fn refusal(report: &AdapterReport) -> String {
    let reason = report.accepted.as_ref().err().map_or("cannot show a window", |r| r.as_str());
    format!("{} ({}): {reason}", report.name, report.backend)
}
