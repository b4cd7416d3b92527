//! A scene on a screen, kept up to date: quick frames while something changes, a sharp picture when it rests.

mod pace;
mod still;

use std::sync::Arc;
use std::time::Instant;

use burnish_core::color::tone::ToneMap;
use burnish_core::lighting::classical::FrameSettings;
use burnish_core::measure::view::DisplayMode;
use burnish_core::param::Settings;
use burnish_core::picture::Picture;
use burnish_core::reference::Contribution;
use burnish_core::scene::{Camera, Projection, Scene};
use burnish_core::surface::ggx::Masking;
use glam::{Affine3A, UVec2, Vec2, Vec3, Vec4};

use crate::device::Gpu;
use crate::error::RenderError;
use crate::frame::{Encoding, Jitter, Targets};
use crate::pass::display::{self, Display};
use crate::pass::environment::{Progress, Refinement};
use crate::pass::target;
use crate::passes::Passes;
use crate::probes::{Lighting, ProbeLook};
use crate::readback::{Reading, read_texel};
use crate::renderer::check_size;
use crate::resident::{Loader, Quality, Resident};
use pace::Pace;
use still::Still;

pub use burnish_core::scene::Picked;

/// What to show.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Physical pixels of the panel.
    pub size: UVec2,
    /// From where.
    pub camera: Camera,
    /// Settings of the method.
    pub settings: Settings,
    /// The method, with what it prepared.
    pub lighting: Lighting,
    /// Display transform.
    pub tone: ToneMap,
    /// Exposure in stops.
    pub exposure_ev: f32,
    /// The picture, or what judges its exposure.
    pub mode: DisplayMode,
    /// Whose light is shown.
    pub contribution: Contribution,
    /// Something is being dragged: quick frames only.
    pub moving: bool,
}

impl Frame {
    /// How the picture is shown.
    pub fn display(&self) -> Display {
        Display { tone: self.tone, exposure_ev: self.exposure_ev, mode: self.mode }
    }
}

/// What was shown.
#[derive(Clone, Debug, Default)]
pub struct Drawn {
    /// Pixels that were drawn, at most the panel's; zero before there is a scene.
    pub size: UVec2,
    /// Whole frames in the picture: 1 for a quick one.
    pub frames: u32,
    /// Nothing is left to refine: no need to draw until something changes.
    pub settled: bool,
    /// How much of a finer environment is prepared, 0 to 1, while one is.
    pub preparing: Option<f32>,
    /// Time of this call, including the device's where it is a software one.
    pub milliseconds: f64,
    /// What the person should know about the picture.
    pub notices: Vec<String>,
}

/// Targets with the picture that a screen shows.
struct Canvas {
    targets: Targets,
    output: wgpu::TextureView,
}

/// Which picture the screen shows.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shown {
    Nothing,
    /// The last quick frame, of the quick canvas or, where it has the panel's size, of the still one.
    Quick {
        full: bool,
    },
    /// The sums.
    Still,
}

/// What a picture depends on besides the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Key {
    size: UVec2,
    world_from_view: Affine3A,
    projection: Projection,
    settings: FrameSettings,
    look: ProbeLook,
}

/// A scene on a screen.
///
/// Every change is shown by the next [`Viewport::draw`]. On a software rasteriser that frame has fewer pixels; the calls
/// after it sharpen the picture, each in a short time, until it is [`Drawn::settled`].
pub struct Viewport {
    loader: Loader,
    resident: Option<Resident>,
    pace: Pace,
    quick: Option<Canvas>,
    full: Option<(Canvas, Still)>,
    shown: Shown,
    /// The scene changed since the last frame.
    stale: bool,
    /// The finer cubes of the resident's environment, and the share that is done.
    preparing: Option<(Refinement, f32)>,
    last: Option<(Key, Camera)>,
    display: Option<Display>,
    lighting: Lighting,
}

impl Viewport {
    /// Compiles the passes.
    pub fn new(gpu: &Gpu) -> Viewport {
        Viewport::with_passes(&Arc::new(Passes::new(gpu)))
    }

    /// A viewport with passes that are compiled already.
    pub fn with_passes(passes: &Arc<Passes>) -> Viewport {
        passes.warm_up();
        Viewport {
            loader: Loader::new(passes, Quality::Coarse),
            resident: None,
            pace: Pace::new(passes.gpu.is_software()),
            quick: None,
            full: None,
            shown: Shown::Nothing,
            stale: false,
            preparing: None,
            last: None,
            display: None,
            lighting: Lighting::default(),
        }
    }

    /// The compiled passes, for other renderers on the same device.
    pub fn passes(&self) -> &Arc<Passes> {
        &self.loader.passes
    }

    /// Goes over to another valid scene; only what differs is made anew. On an error the old one stays.
    pub fn set_scene(&mut self, scene: &Arc<Scene>) -> Result<(), RenderError> {
        let masking = self.resident.as_ref().map_or(Masking::Correlated, |resident| resident.masking);
        self.load(scene, masking)
    }

    fn load(&mut self, scene: &Arc<Scene>, masking: Masking) -> Result<(), RenderError> {
        if self.resident.as_ref().is_some_and(|old| old.is_of(scene, masking, &self.lighting)) {
            return Ok(());
        }
        let old = self.resident.as_ref();
        let resident = self.loader.load(scene, masking, &self.lighting, old)?;
        if old.is_none_or(|old| !Arc::ptr_eq(&old.maps, &resident.maps)) {
            let coarse = resident.scene.environment.as_ref().filter(|_| resident.quality == Quality::Coarse);
            self.preparing = coarse.map(|environment| (Refinement::new(environment), 0.0));
        }
        self.resident = Some(resident);
        self.stale = true;
        Ok(())
    }

    /// Draws what is due: a quick frame after a change, else a part of the sharp picture.
    pub fn draw(&mut self, frame: &Frame) -> Result<Drawn, RenderError> {
        let start = Instant::now();
        let passes = self.loader.passes.clone();
        let gpu = &passes.gpu;
        gpu.check()?;
        check_size(gpu, frame.size)?;
        let settings = FrameSettings { contribution: frame.contribution, ..FrameSettings::new(&frame.settings) };
        let Some(resident) = &self.resident else {
            return Ok(Drawn { settled: true, ..Drawn::default() });
        };
        if resident.masking != settings.masking || !self.lighting.is_like(&frame.lighting) {
            let scene = resident.scene.clone();
            let (before, was_stale) = (std::mem::replace(&mut self.lighting, frame.lighting.clone()), self.stale);
            if let Err(error) = self.load(&scene, settings.masking) {
                self.lighting = before;
                return Err(error);
            }
            if let (Shown::Still, Some((_, still))) = (self.shown, &mut self.full) {
                // Something was prepared anew: the picture stays until there is a better one as large, and fades into it.
                still.replace(&passes);
                self.stale = was_stale;
            }
        }
        let look = ProbeLook::new(&frame.settings);
        let key = Key {
            size: frame.size,
            world_from_view: frame.camera.world_from_view,
            projection: frame.camera.projection,
            settings,
            look,
        };
        let before = (self.shown, self.frames());
        let changed = self.stale || self.last.as_ref().is_none_or(|(last, _)| *last != key);
        if changed {
            self.draw_quick(&passes, frame, (&settings, &look))?;
            self.last = Some((key, frame.camera.clone()));
            self.stale = false;
        } else if !frame.moving {
            self.refine(&passes, &frame.camera, (&settings, &look))?;
        }
        if !gpu.is_software() {
            self.prepare(&passes)?;
        }
        let display = frame.display();
        if changed || before != (self.shown, self.frames()) || self.display != Some(display) {
            self.show(&passes, display);
            self.display = Some(display);
        }
        gpu.check()?;
        Ok(self.drawn(frame, start))
    }

    fn drawn(&self, frame: &Frame, start: Instant) -> Drawn {
        let settled =
            !frame.moving && self.preparing.is_none() && self.full.as_ref().is_some_and(|(_, still)| still.settled());
        let unshadowed = self.resident.iter().flat_map(|resident| &resident.shadows.unshadowed);
        Drawn {
            size: self.canvas().map_or(UVec2::ZERO, |canvas| canvas.targets.size),
            frames: self.frames(),
            settled,
            preparing: self.preparing.as_ref().map(|(_, share)| *share),
            milliseconds: start.elapsed().as_secs_f64() * 1e3,
            notices: unshadowed
                .map(|name| format!("light `{name}` casts no shadow: the shadow maps are full"))
                .collect(),
        }
    }

    /// Whole frames in the picture.
    fn frames(&self) -> u32 {
        match self.shown {
            Shown::Nothing => 0,
            Shown::Quick { .. } => 1,
            Shown::Still => self.full.as_ref().map_or(0, |(_, still)| still.frames),
        }
    }

    fn canvas(&self) -> Option<&Canvas> {
        match self.shown {
            Shown::Nothing => None,
            Shown::Quick { full: false } => self.quick.as_ref(),
            Shown::Quick { full: true } | Shown::Still => self.full.as_ref().map(|(canvas, _)| canvas),
        }
    }

    /// One frame as large as there is time for.
    fn draw_quick(
        &mut self,
        passes: &Passes,
        frame: &Frame,
        (settings, look): (&FrameSettings, &ProbeLook),
    ) -> Result<(), RenderError> {
        let Some(resident) = &self.resident else { return Ok(()) };
        if self.full.as_ref().is_some_and(|(canvas, _)| canvas.targets.size != frame.size) {
            self.full = None;
        }
        let size = self.pace.moving_size(frame.size);
        let full = size == frame.size;
        let canvas = if full {
            &self.full.get_or_insert_with(|| full_canvas(passes, size)).0
        } else {
            if self.quick.as_ref().is_some_and(|canvas| canvas.targets.size != size) {
                self.quick = None;
            }
            self.quick.get_or_insert_with(|| Canvas::new(passes, size))
        };
        let settings = FrameSettings { samples: self.pace.moving_samples(settings.samples), ..*settings };
        let jitter = Jitter { frame: 0, frames: 1 };
        let encoding = Encoding::new(passes, resident, &frame.camera, size, (&settings, look), jitter);
        let targets = &canvas.targets;
        let surfaces = timed(&passes.gpu, |encoder| encoding.surfaces(passes, encoder, resident, targets))?;
        let rest = timed(&passes.gpu, |encoder| {
            encoding.light(passes, encoder, resident, targets, 0..size.y);
            encoding.blend(passes, encoder, resident, targets);
        })?;
        self.pace.note_moving(frame.size, surfaces, rest);
        self.shown = Shown::Quick { full };
        if let Some((_, still)) = &mut self.full {
            still.restart();
        }
        Ok(())
    }

    /// A part of the sharp picture, or of what it needs. One whole frame comes first: it is sharp, if not yet right.
    fn refine(
        &mut self,
        passes: &Passes,
        camera: &Camera,
        settings: (&FrameSettings, &ProbeLook),
    ) -> Result<(), RenderError> {
        let Some((key, _)) = &self.last else { return Ok(()) };
        let size = key.size;
        let begun = self.full.get_or_insert_with(|| full_canvas(passes, size)).1.begun();
        if begun && passes.gpu.is_software() && self.prepare(passes)? {
            return Ok(());
        }
        let (Some(resident), Some((canvas, still))) = (&self.resident, &mut self.full) else { return Ok(()) };
        if !still.settled() {
            still.advance(passes, resident, canvas, (camera, settings), &mut self.pace)?;
        }
        if still.begun() {
            self.shown = Shown::Still;
        }
        Ok(())
    }

    /// A part of the finer cubes of the environment. True when the device was kept busy by it.
    fn prepare(&mut self, passes: &Passes) -> Result<bool, RenderError> {
        let Some((refinement, share)) = &mut self.preparing else { return Ok(false) };
        let before = *share;
        let budget = self.pace.preparing();
        match refinement.advance(&passes.gpu, &passes.environment, budget)? {
            Progress::Working(now) => {
                *share = now;
                if passes.gpu.is_software() {
                    passes.gpu.wait()?;
                }
                Ok(now > before)
            }
            Progress::Finished(maps) => {
                self.preparing = None;
                let Some(old) = &self.resident else { return Ok(true) };
                if let Some(environment) = &old.scene.environment {
                    self.loader.refined(environment, *maps);
                }
                self.resident = Some(self.loader.load(&old.scene, old.masking, &self.lighting, Some(old))?);
                // The picture on the screen stays until there is a better one as large, and fades into it.
                if let Some((_, still)) = &mut self.full {
                    if self.shown == Shown::Still { still.replace(passes) } else { still.restart() }
                }
                Ok(true)
            }
        }
    }

    /// Puts the picture through the display transform.
    fn show(&self, passes: &Passes, display: Display) {
        let Some(canvas) = self.canvas() else { return };
        let mut encoder = passes.gpu.device.create_command_encoder(&Default::default());
        let still = self.full.as_ref().map(|(_, still)| still).filter(|_| self.shown == Shown::Still);
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let sum = still.map(|still| (view(still.sum().0), still.sum().1));
        let fading = still.and_then(Still::fading).map(|(sum, frames, weight)| (view(sum), frames, weight));
        let (sum, frames) = sum.as_ref().map_or((&canvas.targets.frame, 1), |(sum, frames)| (sum, *frames));
        let before = fading.as_ref().map(|(sum, frames, weight)| (sum, *frames, *weight));
        let shown = display::Shown { sum, frames, before };
        passes.display.encode(&passes.gpu, &mut encoder, shown, &canvas.output, display);
        passes.gpu.queue.submit([encoder.finish()]);
    }

    /// The picture: sRGB-encoded bytes, to be shown as they are. It is another texture when [`Drawn::size`] changes.
    pub fn output(&self) -> Option<&wgpu::TextureView> {
        self.canvas().map(|canvas| &canvas.output)
    }

    /// The visible surface under a point of the picture, 0 to 1 from its top left. Holes of masked materials count as
    /// surface.
    pub fn pick(&mut self, at: Vec2) -> Result<Option<Picked>, RenderError> {
        self.passes().gpu.check()?;
        let (Some(resident), Some((key, camera))) = (&self.resident, &self.last) else { return Ok(None) };
        let size = key.size.as_vec2();
        Ok(resident.scene.pick(camera.ray(at, size.x / size.y)))
    }

    /// Starts to read the picture; `None` unless it is at rest.
    pub fn read(&self) -> Option<PendingPicture> {
        let (canvas, still) = self.full.as_ref().filter(|(_, still)| still.settled())?;
        let (sum, frames) = still.sum();
        let reading = Reading::start(&self.passes().gpu, sum);
        Some(PendingPicture { reading, size: canvas.targets.size, frames })
    }

    /// Scene-linear radiance of the picture under a point, 0 to 1 from its top left: the mean of its frames.
    pub fn radiance(&mut self, at: Vec2) -> Result<Option<Vec3>, RenderError> {
        let gpu = &self.loader.passes.gpu;
        gpu.check()?;
        let Some(canvas) = self.canvas() else { return Ok(None) };
        if !(at.cmpge(Vec2::ZERO) & at.cmple(Vec2::ONE)).all() {
            return Ok(None);
        }
        let size = canvas.targets.size;
        let pixel = (at * size.as_vec2()).as_uvec2().min(size - 1);
        let texel = match (self.shown, &self.full) {
            (Shown::Still, Some((_, still))) => {
                let (sum, frames) = still.sum();
                read_texel(gpu, sum, pixel)? / frames.max(1) as f32
            }
            _ => read_texel(gpu, canvas.targets.frame.texture(), pixel)?,
        };
        Ok(Some(texel.truncate()))
    }
}

/// The picture at rest on its way to the CPU.
pub struct PendingPicture {
    reading: Reading,
    size: UVec2,
    frames: u32,
}

impl PendingPicture {
    /// Scene-linear radiance, the mean of the frames; `None` while it is on its way. It is given out once.
    pub fn poll(&mut self) -> Result<Option<Picture>, RenderError> {
        let Some(bytes) = self.reading.poll()? else { return Ok(None) };
        let (floats, _) = bytes.as_chunks::<16>();
        let scale = 1.0 / self.frames.max(1) as f32;
        let texels = floats.iter().map(|texel| bytemuck::pod_read_unaligned::<Vec4>(texel) * scale).collect();
        Ok(Some(Picture { width: self.size.x, height: self.size.y, texels }))
    }
}

fn full_canvas(passes: &Passes, size: UVec2) -> (Canvas, Still) {
    let canvas = Canvas::new(passes, size);
    let still = Still::new(passes, &canvas);
    (canvas, still)
}

impl Canvas {
    fn new(passes: &Passes, size: UVec2) -> Canvas {
        let output = target(&passes.gpu, "viewport", size, display::FORMAT);
        Canvas { targets: Targets::new(passes, size), output: output.create_view(&Default::default()) }
    }
}

/// Submits what `encode` records. On a software rasteriser, which shares the processor with the window anyway, waits for
/// it and returns its milliseconds; else 0.
fn timed(gpu: &Gpu, encode: impl FnOnce(&mut wgpu::CommandEncoder)) -> Result<f64, RenderError> {
    let start = Instant::now();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encode(&mut encoder);
    gpu.queue.submit([encoder.finish()]);
    if gpu.is_software() {
        gpu.wait()?;
        return Ok(start.elapsed().as_secs_f64() * 1e3);
    }
    gpu.check()?;
    Ok(0.0)
}
