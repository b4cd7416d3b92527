//! The window without a window: drawn into a texture and read back, with a clock that only this file moves.
//!
//! Every pass is painted by the renderer that eframe uses, on the device that draws the picture. Two runs with the same
//! document give the same bytes.

use std::sync::Arc;
use std::time::{Duration, Instant};

use burnish_core::color::rgb::linear_from_srgb;
use burnish_core::picture::Picture;
use burnish_render::device::{ACCEPTED, choose, device_descriptor};
use burnish_render::readback::read_texture;
use burnish_render::{Gpu, GpuError};
use eframe::egui::mutex::RwLock;
use eframe::egui::{self, FullOutput, RawInput, TexturesDelta, ViewportId, pos2};
use eframe::egui_wgpu::{RenderState, Renderer, RendererOptions, ScreenDescriptor};
use eframe::wgpu;
use glam::{UVec2, Vec3, Vec4};

use super::stage::{Live, LossLog, Stage};
use super::theme;
use super::workbench::Workbench;

/// Bytes are sRGB-encoded as egui makes them: the format must not encode again.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Seconds of the clock between two passes.
const STEP_SECS: f64 = 1.0 / 60.0;
/// A wish to be drawn again later than this is none to wait for, such as a message that will leave.
const SOON_SECS: f64 = 1.0;
/// Longest wait for jobs and for the picture to become sharp.
const PATIENCE: Duration = Duration::from_secs(300);

/// Why there is no picture of the window.
#[derive(Clone, Debug, PartialEq)]
pub enum OffscreenError {
    /// The device.
    Gpu(GpuError),
    /// The picture of the viewport, in words.
    Picture(String),
    /// It never came to rest.
    Restless,
}

impl std::fmt::Display for OffscreenError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            OffscreenError::Gpu(error) => error.fmt(f),
            OffscreenError::Picture(reason) => f.write_str(reason),
            OffscreenError::Restless => {
                write!(f, "the window did not come to rest within {} s; try a smaller --size", PATIENCE.as_secs())
            }
        }
    }
}

impl std::error::Error for OffscreenError {}

impl From<GpuError> for OffscreenError {
    fn from(error: GpuError) -> Self {
        OffscreenError::Gpu(error)
    }
}

/// A place to draw windows.
pub struct Offscreen {
    ctx: egui::Context,
    render: RenderState,
    gpu: Gpu,
    size: UVec2,
    time_secs: f64,
}

impl Offscreen {
    /// Opens the best adapter for windows of so many pixels.
    pub fn new(size: UVec2) -> Result<Offscreen, GpuError> {
        Offscreen::with(size, RendererOptions::PREDICTABLE)
    }

    /// The same, drawn as windows of the system are: faster, and not the same on every machine.
    pub fn like_native(size: UVec2) -> Result<Offscreen, GpuError> {
        Offscreen::with(size, RendererOptions::default())
    }

    fn with(size: UVec2, options: RendererOptions) -> Result<Offscreen, GpuError> {
        let (render, gpu) = pollster::block_on(render_state(options))?;
        Ok(Offscreen { ctx: egui::Context::default(), render, gpu, size, time_secs: 0.0 })
    }

    /// What windows are drawn with.
    pub fn context(&self) -> &egui::Context {
        &self.ctx
    }

    /// A live picture on this device that tells no times.
    pub fn stage(&self) -> Stage {
        Stage::Live(Box::new(Live::new(self.render.clone(), &self.gpu, LossLog::default()).with_fixed_clock()))
    }

    /// Draws the window until nothing moves any more, and reads it.
    pub fn picture(&mut self, workbench: &mut Workbench) -> Result<Picture, OffscreenError> {
        let start = Instant::now();
        let mut quiet = 0;
        loop {
            let output = self.pass(workbench, Vec::new());
            self.gpu.check()?;
            if start.elapsed() > PATIENCE {
                return Err(OffscreenError::Restless);
            }
            let wait = output.viewport_output.get(&ViewportId::ROOT).map_or(Duration::MAX, |v| v.repaint_delay);
            if workbench.is_busy() {
                // Another thread is at work: the clock stands still, the machine does not.
                std::thread::sleep(Duration::from_millis(2));
                quiet = 0;
            } else if wait.as_secs_f64() <= SOON_SECS {
                self.time_secs += wait.as_secs_f64().max(STEP_SECS);
                quiet = 0;
            } else if quiet < 2 {
                // Widths that a pass learns are used by the next.
                self.time_secs += STEP_SECS;
                quiet += 1;
            } else {
                // A window with words where the picture belongs is no picture of the document.
                let fault = workbench.stage().status().and_then(|status| status.message.clone());
                return fault.map_or_else(|| self.read(output), |reason| Err(OffscreenError::Picture(reason)));
            }
        }
    }

    /// One frame as a window draws it, at a time of the window's clock and with input that came before it. Returns when
    /// it is on the screen, with the wait until the next one is wished for.
    pub fn frame(
        &mut self,
        workbench: &mut Workbench,
        events: Vec<egui::Event>,
        time_secs: f64,
    ) -> Result<Duration, OffscreenError> {
        self.time_secs = time_secs;
        let output = self.pass(workbench, events);
        let wait = output.viewport_output.get(&ViewportId::ROOT).map_or(Duration::MAX, |v| v.repaint_delay);
        self.paint(output);
        self.gpu.wait()?;
        self.gpu.check()?;
        Ok(wait)
    }

    /// One pass of the window, textures included.
    fn pass(&mut self, workbench: &mut Workbench, events: Vec<egui::Event>) -> FullOutput {
        let size = egui::vec2(self.size.x as f32, self.size.y as f32);
        let mut input = RawInput {
            screen_rect: Some(egui::Rect::from_min_size(pos2(0.0, 0.0), size)),
            time: Some(self.time_secs),
            events,
            predicted_dt: STEP_SECS as f32,
            focused: true,
            system_theme: Some(egui::Theme::Dark),
            max_texture_side: Some(self.render.device.limits().max_texture_dimension_2d as usize),
            ..RawInput::default()
        };
        input.viewports.entry(ViewportId::ROOT).or_default().native_pixels_per_point = Some(1.0);
        let mut output = self.ctx.run_ui(input, |ui| workbench.ui(ui));
        self.update_textures(std::mem::take(&mut output.textures_delta));
        output
    }

    fn update_textures(&self, mut delta: TexturesDelta) {
        let mut renderer = self.render.renderer.write();
        for (id, images) in delta.set.drain() {
            for image in images {
                renderer.update_texture(&self.render.device, &self.render.queue, id, &image);
            }
        }
        for id in delta.free.drain() {
            renderer.free_texture(&id);
        }
    }

    /// Paints a pass and reads its pixels, linear as pictures are.
    fn read(&self, output: FullOutput) -> Result<Picture, OffscreenError> {
        let target = self.paint(output);
        let bytes = read_texture(&self.gpu, &target, 0, 0)?;
        Ok(picture(self.size, &bytes))
    }

    fn paint(&self, output: FullOutput) -> wgpu::Texture {
        let RenderState { device, queue, renderer, .. } = &self.render;
        let pixels_per_point = output.pixels_per_point;
        let shapes = self.ctx.tessellate(output.shapes, pixels_per_point);
        let screen = ScreenDescriptor { size_in_pixels: self.size.to_array(), pixels_per_point };
        let target = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("window"),
            size: wgpu::Extent3d { width: self.size.x, height: self.size.y, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let view = target.create_view(&Default::default());
        let mut encoder = device.create_command_encoder(&Default::default());
        let mut renderer = renderer.write();
        let before = renderer.update_buffers(device, queue, &mut encoder, &shapes, &screen);
        let mut pass = encoder
            .begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("window"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    resolve_target: None,
                    depth_slice: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(background(&self.ctx)),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                ..Default::default()
            })
            .forget_lifetime();
        renderer.render(&mut pass, &shapes, &screen);
        drop(pass);
        queue.submit(before.into_iter().chain([encoder.finish()]));
        target
    }
}

/// What no panel covers: the fill of panels, as encoded bytes.
fn background(ctx: &egui::Context) -> wgpu::Color {
    let [r, g, b, a] = theme::background(&ctx.global_style().visuals).map(f64::from);
    wgpu::Color { r, g, b, a }
}

/// Encoded bytes of opaque pixels as linear values; writing them as a PNG gives the same bytes again.
fn picture(size: UVec2, bytes: &[u8]) -> Picture {
    Picture::from_fn(size.x, size.y, |x, y| {
        let at = 4 * (y as usize * size.x as usize + x as usize);
        let byte = |i: usize| bytes.get(at + i).map_or(0.0, |byte| f32::from(*byte) / 255.0);
        let rgb: Vec3 = linear_from_srgb(Vec3::new(byte(0), byte(1), byte(2)));
        Vec4::from((rgb, 1.0))
    })
}

/// The best adapter that is accepted, with egui's renderer on it.
async fn render_state(options: RendererOptions) -> Result<(RenderState, Gpu), GpuError> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = ACCEPTED;
    let instance = wgpu::Instance::new(descriptor);
    let available_adapters = instance.enumerate_adapters(wgpu::Backends::all()).await;
    let adapter = choose(&available_adapters, |_| true)?.clone();
    let opened = adapter.request_device(&device_descriptor(&adapter)).await;
    let (device, queue) =
        opened.map_err(|e| GpuError::Open { adapter: adapter.get_info().name, reason: e.to_string() })?;
    let gpu = Gpu::from_parts(&adapter, device.clone(), queue.clone());
    let renderer = Renderer::new(&device, FORMAT, options);
    let renderer = Arc::new(RwLock::new(renderer));
    Ok((RenderState { adapter, available_adapters, instance, device, queue, target_format: FORMAT, renderer }, gpu))
}
