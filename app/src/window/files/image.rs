//! The picture as a file: its settings, and the job that renders it or writes the reference.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use burnish_core::color::tone::ToneMap;
use burnish_core::file::{write_environment, write_picture};
use burnish_core::job::{Handle, Job};
use burnish_core::lighting::probe::Raster;
use burnish_core::lighting::{Layers, MethodError, Store};
use burnish_core::picture::Picture;
use burnish_core::reference::{self, Contribution, Film, Options, Pass, World};
use burnish_core::scene::Environment;
use burnish_render::{DeviceRaster, Gpu, Passes, Renderer, View};
use eframe::egui;
use glam::UVec2;

use super::load::name_of;
use crate::window::preparations::{drawn_on_device, lighting_now};
use crate::window::reference::Look;
use crate::window::session::Session;

/// Most pixels on a side, as on the command line.
const MAX_SIDE: u32 = 8192;
/// Most pixels.
const MAX_PIXELS: u32 = 1 << 24;
/// Where there is no viewport to take the size of.
const DEFAULT_SIZE: UVec2 = UVec2::new(1920, 1080);

/// How a picture is rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImageSettings {
    size: UVec2,
    /// Jittered frames that are averaged.
    frames: u32,
    /// Size of the viewport.
    natural: UVec2,
    /// Size of what the processor refines where the viewport shows it.
    traced: Option<UVec2>,
    /// That is the reference, not the live picture.
    is_reference: bool,
    /// It is what is written.
    as_shown: bool,
}

impl ImageSettings {
    /// A picture of the viewport's size, or what the processor refines where it is shown: the reference, or the live
    /// picture.
    pub fn new(viewport: Option<UVec2>, traced: Option<UVec2>, is_reference: bool) -> ImageSettings {
        let natural = viewport.filter(|size| size.min_element() > 0).unwrap_or(DEFAULT_SIZE);
        ImageSettings { size: natural, frames: 16, natural, traced, is_reference, as_shown: traced.is_some() }
    }

    /// Shows the settings.
    pub fn ui(&mut self, ui: &mut egui::Ui) {
        if let Some(size) = self.traced {
            ui.horizontal(|ui| {
                let hover = "The picture that the processor refines, with the samples that it has now.";
                let [shown, anew] = match self.is_reference {
                    true => ["Reference, as shown", "Live picture"],
                    false => ["As shown", "Rendered anew"],
                };
                ui.radio_value(&mut self.as_shown, true, shown).on_hover_text(hover);
                let hover = "Rendered anew by the lighting method, in any size.";
                ui.radio_value(&mut self.as_shown, false, anew).on_hover_text(hover);
            });
            if self.as_shown {
                let command = if self.is_reference { "burnish render --method reference" } else { "burnish render" };
                ui.weak(format!("{} x {} pixels. In any size: {command}.", size.x, size.y));
            } else {
                self.live_ui(ui);
            }
        } else {
            self.live_ui(ui);
        }
        ui.weak(".png: through exposure and tone map, which are noted.  .exr: linear radiance.");
    }

    /// Size and quality of a picture that is rendered.
    fn live_ui(&mut self, ui: &mut egui::Ui) {
        ui.horizontal(|ui| {
            let mut side = |label: &str, value: &mut u32| {
                let label = ui.label(label);
                let drag = egui::DragValue::new(value).range(1..=MAX_SIDE).speed(4.0).suffix(" px");
                ui.add(drag).labelled_by(label.id).on_hover_text("Pixels of the picture");
            };
            side("Width", &mut self.size.x);
            side("Height", &mut self.size.y);
            for (name, factor) in [("1x", 1), ("2x", 2), ("4x", 4)] {
                let size = self.natural * factor;
                let possible = size.max_element() <= MAX_SIDE && size.x * size.y <= MAX_PIXELS;
                let hover = format!("{} x {} pixels, from the viewport", size.x, size.y);
                if ui.add_enabled(possible, egui::Button::new(name).small()).on_hover_text(hover).clicked() {
                    self.size = size;
                }
            }
        });
        ui.horizontal(|ui| {
            let label = ui.label("Frames");
            let drag = egui::DragValue::new(&mut self.frames).range(1..=1024).speed(0.5);
            ui.add(drag)
                .labelled_by(label.id)
                .on_hover_text("Frames, each moved by a part of a pixel, that are averaged");
        });
        // Kept within what an adapter takes, at the same width.
        self.size.y = self.size.y.min(MAX_PIXELS / self.size.x.max(1)).max(1);
    }
}

/// Work that ends with what to tell.
pub type Writing = Job<Result<String, String>>;

/// Starts to write the picture that was asked for. Refuses where there is no whole one.
pub fn start(
    session: &Session,
    (passes, look, store): (Option<&Arc<Passes>>, Option<&Look>, Store),
    contribution: Contribution,
    settings: ImageSettings,
    path: PathBuf,
    ctx: &egui::Context,
) -> Result<Writing, String> {
    if !settings.as_shown {
        return Ok(render(session, (passes, store, contribution), settings, path, ctx));
    }
    let look = look.filter(|look| look.whole_size().is_some());
    let picture = look.ok_or("there is no whole picture yet; wait for its first sample, then save")?.picture.clone();
    let view = &session.document().view;
    let (tone, exposure_ev) = (view.tone.parse().unwrap_or_default(), view.exposure_ev as f32);
    let waker = ctx.clone();
    let label = format!("Writing {}", name_of(&path.to_string_lossy()));
    let work = move |_: &Handle| write(&picture, &path, tone, exposure_ev);
    Ok(Job::spawn(label, move || waker.request_repaint(), work))
}

/// Starts to write an environment: strength and tint are in its texels, its turn is not, nor a sun that is a light.
pub fn write_map(map: Arc<Environment>, path: PathBuf, without_sun: bool, ctx: &egui::Context) -> Writing {
    let waker = ctx.clone();
    let label = format!("Writing {}", name_of(&path.to_string_lossy()));
    let work = move |handle: &Handle| {
        if handle.is_cancelled() {
            return Ok(String::new());
        }
        write_environment(&map, &path).map_err(|e| e.to_string())?;
        let sun = if without_sun { "; its sun is a light and not in it" } else { "" };
        Ok(format!("Wrote {} ({} x {} pixels){sun}", path.display(), map.width, map.height))
    };
    Job::spawn(label, move || waker.request_repaint(), work)
}

/// Starts to render the document's view into a file, on the window's device where there is one.
fn render(
    session: &Session,
    (passes, store, contribution): (Option<&Arc<Passes>>, Store, Contribution),
    settings: ImageSettings,
    path: PathBuf,
    ctx: &egui::Context,
) -> Writing {
    let (document, scene) = (session.document(), session.scene().clone());
    let view = View {
        size: settings.size,
        camera: document.view.camera.camera(),
        settings: document.lighting.settings(),
        jitter_frames: settings.frames,
    };
    let (tone, exposure_ev) = (document.view.tone.parse().unwrap_or_default(), document.view.exposure_ev as f32);
    let (passes, waker, layers) = (passes.cloned(), ctx.clone(), session.layers().clone());
    let on_processor = (!drawn_on_device(&layers)).then(|| Options::new(&document.lighting.world_settings()));
    let label = format!("Rendering {}", name_of(&path.to_string_lossy()));
    let progress = ctx.clone();
    let work = move |handle: &Handle| {
        if let Some(options) = on_processor {
            let raster = passes.map(|passes| Arc::new(DeviceRaster::new(&passes)) as Arc<dyn Raster>);
            let world = World::new(&scene, options).with_raster(raster);
            let drawn = draw(&layers, &world, (&store, &view), handle)?;
            return drawn.map_or(Ok(String::new()), |picture| write(&picture, &path, tone, exposure_ev));
        }
        let passes = match passes {
            Some(passes) => passes,
            None => Arc::new(Passes::new(&Gpu::new().map_err(|e| e.to_string())?)),
        };
        let mut renderer = Renderer::with_passes(&passes, &scene).map_err(|e| e.to_string())?;
        let lighting = lighting_now(&layers, &scene, (&passes, &store), handle).map_err(|e| e.to_string())?;
        renderer.light_by(&lighting).map_err(|e| e.to_string())?;
        renderer.show(contribution);
        let going_on = |fraction: f32| {
            handle.set_progress(fraction);
            progress.request_repaint();
            !handle.is_cancelled()
        };
        let Some(picture) = renderer.render_while(&view, going_on).map_err(|e| e.to_string())? else {
            return Ok(String::new());
        };
        write(&picture, &path, tone, exposure_ev)
    };
    Job::spawn(label, move || waker.request_repaint(), work)
}

/// Draws on the processor, with as many samples of a pixel as frames are asked for; `None` when it is cancelled.
fn draw(
    layers: &Layers,
    world: &World,
    (store, view): (&Store, &View),
    job: &Handle,
) -> Result<Option<Picture>, String> {
    let mut film = Film::new(view.size);
    let view_of_film = reference::View { camera: view.camera.clone(), size: view.size, seed: 0 };
    match layers.draw(world, store, &view_of_film, (&mut film, view.jitter_frames), job) {
        Ok(Some(Pass::Whole)) => Ok(Some(film.picture())),
        Ok(Some(Pass::Cancelled)) | Err(MethodError::Cancelled) => Ok(None),
        Ok(None) => Err("the method cannot draw on the processor".into()),
        Err(error) => Err(error.to_string()),
    }
}

fn write(picture: &Picture, path: &Path, tone: ToneMap, exposure_ev: f32) -> Result<String, String> {
    write_picture(picture, path, tone, exposure_ev).map_err(|e| e.to_string())?;
    Ok(format!("Wrote {} ({} x {} pixels)", path.display(), picture.width, picture.height))
}
