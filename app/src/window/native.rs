//! The workbench in a window of the system: adapter, device, and what happens without them.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::process;
use std::sync::{Arc, OnceLock};

use burnish_render::Gpu;
use burnish_render::device::{ACCEPTED, DRIVER_REMEDY, choose, device_descriptor};
use eframe::egui;
use eframe::egui_wgpu::{RenderState, WgpuConfiguration, WgpuError, WgpuSetup, WgpuSetupCreateNew};
use eframe::wgpu;

use super::stage::{Live, LossLog, Stage};
use super::theme;
use super::workbench::{Options, Workbench};
use crate::failure::Failure;

/// Libraries of the X Window System that are opened at run time, in the words of Debian.
const DISPLAY_REMEDY: &str = "run it in a desktop session (DISPLAY or WAYLAND_DISPLAY), and install libx11-6, libxcursor1, \
                              libxi6, libxrandr2, libxkbcommon-x11-0 if they are missing";

struct App {
    workbench: Workbench,
    /// Why the program ends, for [`run`].
    end: Arc<OnceLock<String>>,
    /// The window's surface encodes what is written to it.
    encodes: bool,
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        self.workbench.ui(ui);
        if let Some(losses) = self.workbench.stage().wants_restart() {
            // The window is drawn with the device that is gone: eframe would panic in its next upload. All that must
            // last is in the recovery file.
            if !self.workbench.recovery_kept() {
                let reason = "the graphics device was lost, and the recovery file could not be written";
                _ = self.end.set(reason.into());
            } else {
                match restart(&losses) {
                    Ok(()) => process::exit(0),
                    Err(reason) => _ = self.end.set(reason),
                }
            }
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
        }
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        let encoded = theme::background(visuals);
        if self.encodes { egui::Rgba::from(visuals.panel_fill).to_array() } else { encoded }
    }
}

/// Starts the program again on its recovery file.
fn restart(losses: &LossLog) -> Result<(), String> {
    let started = std::env::current_exe().and_then(|program| {
        process::Command::new(program).arg("--recover").env(LossLog::VARIABLE, losses.to_string()).spawn()
    });
    started.map(drop).map_err(|e| {
        format!("the graphics device was lost and the program cannot start itself again ({e}); start it with --recover")
    })
}

/// Opens the window and returns when it was closed.
pub fn run(options: Options) -> Result<(), Failure> {
    let end = Arc::new(OnceLock::new());
    let gpu = Arc::new(OnceLock::new());
    let losses = LossLog::from_environment();
    let create: eframe::AppCreator<'_> = Box::new({
        let (end, gpu, losses) = (end.clone(), gpu.clone(), losses.clone());
        move |cc| {
            let render = cc.wgpu_render_state.clone().ok_or("the window has no graphics device")?;
            let encodes = render.target_format.is_srgb();
            let stage = live_stage(render, &gpu, losses);
            Ok(Box::new(App { workbench: Workbench::new(&cc.egui_ctx, options, stage), end, encodes }))
        }
    });
    let native = native_options();
    let quiet = silence_library_panics();
    // Loaders of system libraries and eframe's uploads to a lost device panic; both are words to the user.
    let result = catch_unwind(AssertUnwindSafe(|| eframe::run_native("burnish", native, create)));
    drop(quiet);
    match result {
        Ok(Ok(())) => end.get().map_or(Ok(()), |reason| Err(Failure::resources(reason))),
        Ok(Err(error)) => Err(Failure::resources(in_words(&error))),
        Err(panic) if library_missing(&*panic) => {
            Err(Failure::resources(format!("no window: {}; {DISPLAY_REMEDY}", text_of(&*panic))))
        }
        Err(_) if gpu.get().is_some_and(|gpu: &Gpu| gpu.check().is_err()) => {
            let mut losses = losses;
            match losses.note_now() {
                true => restart(&losses).map_err(Failure::resources),
                false => Err(Failure::resources(LossLog::GIVEN_UP)),
            }
        }
        Err(panic) => resume_unwind(panic),
    }
}

fn live_stage(render: RenderState, gpu: &OnceLock<Gpu>, losses: LossLog) -> Stage {
    let opened = Gpu::from_parts(&render.adapter, render.device.clone(), render.queue.clone());
    let _ = gpu.set(opened.clone());
    Stage::Live(Box::new(Live::new(render, &opened, losses)))
}

fn native_options() -> eframe::NativeOptions {
    let mut instance = wgpu::InstanceDescriptor::new_without_display_handle();
    instance.backends = ACCEPTED;
    let setup = WgpuSetupCreateNew {
        instance_descriptor: instance,
        native_adapter_selector: Some(Arc::new(|adapters, surface| {
            let shows = |adapter: &wgpu::Adapter| surface.is_none_or(|surface| adapter.is_surface_supported(surface));
            choose(adapters, shows).cloned().map_err(|e| e.to_string())
        })),
        device_descriptor: Arc::new(device_descriptor),
        ..WgpuSetupCreateNew::without_display_handle()
    };
    eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_inner_size([1280.0, 800.0])
            .with_min_inner_size([640.0, 400.0])
            .with_title("Burnish")
            .with_drag_and_drop(true),
        wgpu_options: WgpuConfiguration { wgpu_setup: WgpuSetup::CreateNew(setup), ..Default::default() },
        ..Default::default()
    }
}

/// What to tell the user about a window that did not open.
fn in_words(error: &eframe::Error) -> String {
    match error {
        eframe::Error::Wgpu(WgpuError::CustomNativeAdapterSelectionError(text)) => text.clone(),
        // Without any driver there is not even a surface to choose an adapter for.
        eframe::Error::Wgpu(error) => format!("no usable graphics adapter ({error}); {DRIVER_REMEDY}"),
        eframe::Error::Winit(_) | eframe::Error::WinitEventLoop(_) => format!("no window: {error}; {DISPLAY_REMEDY}"),
        other => format!("no window: {other}"),
    }
}

fn text_of(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("a library failed")
}

/// True for the panic of a loader whose library is not installed.
fn library_missing(panic: &(dyn Any + Send)) -> bool {
    let text = text_of(panic);
    text.contains("could not be loaded") || text.contains("Failed to load")
}

/// Keeps such a panic from being printed beside the sentence about it, until dropped.
fn silence_library_panics() -> impl Drop {
    type Hook = Box<dyn Fn(&std::panic::PanicHookInfo<'_>) + Sync + Send>;
    struct Restore(Arc<Hook>);
    impl Drop for Restore {
        fn drop(&mut self) {
            let before = self.0.clone();
            // A panicking thread may not change the hook.
            if !std::thread::panicking() {
                std::panic::set_hook(Box::new(move |info| before(info)));
            }
        }
    }
    let before: Arc<Hook> = Arc::new(std::panic::take_hook());
    let hook = before.clone();
    std::panic::set_hook(Box::new(move |info| {
        if !info.payload_as_str().is_some_and(|text| text.contains("could not be loaded")) {
            hook(info);
        }
    }));
    Restore(before)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_machine_without_driver_or_display_is_told_what_to_install() {
        let none = eframe::Error::Wgpu(WgpuError::CustomNativeAdapterSelectionError("x; install y".into()));
        assert_eq!(in_words(&none), "x; install y");
        let surface = eframe::Error::Wgpu(WgpuError::NoSurfaceFormatsAvailable);
        assert!(in_words(&surface).contains("mesa-vulkan-drivers"));
        let panic: Box<dyn Any + Send> = Box::new(String::from("Library libxkbcommon-x11.so could not be loaded."));
        assert!(library_missing(&*panic));
        assert!(!library_missing(&"index out of bounds"));
    }
}
