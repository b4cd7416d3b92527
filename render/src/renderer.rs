//! Draws views of a scene into pictures: every frame in full, then read back.

use std::sync::Arc;
use std::time::Instant;

use burnish_core::lighting::classical::FrameSettings;
use burnish_core::lighting::radiance_map::Part;
use burnish_core::material::Material;
use burnish_core::param::Settings;
use burnish_core::picture::Picture;
use burnish_core::reference::Contribution;
use burnish_core::scene::{Camera, Scene};
use burnish_core::surface::ggx::Masking;
use glam::{UVec2, Vec4};

use crate::clock::DeviceClock;
use crate::device::Gpu;
use crate::error::RenderError;
use crate::frame::{Encoding, Jitter, Targets};
use crate::pass::accumulate::Sums;
use crate::pass::environment::EnvironmentMaps;
use crate::passes::Passes;
use crate::probes::{Lighting, ProbeLook};
use crate::readback::read_texture;
use crate::resident::{Loader, Quality, Resident};

pub use crate::frame::clip_from_world;

/// What to draw.
#[derive(Clone, Debug)]
pub struct View {
    /// Pixels.
    pub size: UVec2,
    /// From where.
    pub camera: Camera,
    /// Settings of the method.
    pub settings: Settings,
    /// Frames that are averaged, each moved by a part of a pixel; 1 samples the centres.
    pub jitter_frames: u32,
}

/// A scene on the device, ready to be drawn.
///
/// Environment cubes and shadow maps are made once and kept while the scene leaves them as they are.
pub struct Renderer {
    loader: Loader,
    resident: Resident,
    contribution: Contribution,
    lighting: Lighting,
    targets: Option<(Targets, Sums)>,
}

impl Renderer {
    /// Compiles the passes and uploads the scene, which must be valid and have an environment.
    pub fn new(gpu: &Gpu, scene: &Scene) -> Result<Renderer, RenderError> {
        Renderer::with_passes(&Arc::new(Passes::new(gpu)), &Arc::new(scene.clone()))
    }

    /// Uploads the scene for passes that are compiled already.
    pub fn with_passes(passes: &Arc<Passes>, scene: &Arc<Scene>) -> Result<Renderer, RenderError> {
        let mut loader = Loader::new(passes, Quality::Full);
        let resident = loader.load(scene, Masking::Correlated, &Lighting::default(), None)?;
        Ok(Renderer { loader, resident, contribution: Contribution::All, lighting: Lighting::default(), targets: None })
    }

    /// Goes over to another valid scene; only what differs is made anew. On an error the old one stays.
    pub fn set_scene(&mut self, scene: &Arc<Scene>) -> Result<(), RenderError> {
        self.resident = self.loader.load(scene, self.resident.masking, &self.lighting, Some(&self.resident))?;
        Ok(())
    }

    /// Lights the scene by a method from now on. On an error it is lit as before.
    pub fn light_by(&mut self, lighting: &Lighting) -> Result<(), RenderError> {
        if !self.lighting.is_like(lighting) {
            let Resident { scene, masking, .. } = &self.resident;
            self.resident = self.loader.load(&scene.clone(), *masking, lighting, Some(&self.resident))?;
            self.lighting = lighting.clone();
        }
        Ok(())
    }

    /// Shows the light of one source from now on, or all of it. Pictures of each source add up to that of all.
    pub fn show(&mut self, contribution: Contribution) {
        self.contribution = contribution;
    }

    fn settings(&self, view: &View) -> FrameSettings {
        FrameSettings { contribution: self.contribution, ..FrameSettings::new(&view.settings) }
    }

    /// Names of lights that cast no shadow because there are more than the shadow maps hold.
    pub fn unshadowed_lights(&self) -> &[String] {
        &self.resident.shadows.unshadowed
    }

    /// The cubes of the environment, for measuring them.
    pub fn environment_maps(&self) -> &EnvironmentMaps {
        &self.resident.maps
    }

    /// Takes over the materials but for their textures, in the order of the scene's; more than it has are ignored.
    pub fn set_materials(&mut self, materials: &[Material]) -> Result<(), RenderError> {
        let mut scene = Scene::clone(&self.resident.scene);
        for (old, new) in scene.materials.iter_mut().zip(materials) {
            *old = new.clone().with_textures_of(old);
        }
        self.set_scene(&Arc::new(scene))
    }

    /// Draws the first frame of a view and returns its seconds: by the time stamps of a card that has them, else from giving
    /// it to the device until that has drawn it.
    pub fn time_frame(&mut self, view: &View) -> Result<f64, RenderError> {
        self.time_part(view, Part::All)
    }

    /// Likewise, of a frame that does a part of the lookups of `radiance-map` only; with other methods the same.
    pub fn time_part(&mut self, view: &View, part: Part) -> Result<f64, RenderError> {
        let passes = self.loader.passes.clone();
        let gpu = &passes.gpu;
        let (targets, sums) = self.begin(&passes, view)?;
        let (settings, mut look) = (self.settings(view), ProbeLook::new(&view.settings));
        look.map.part = part;
        // Stamps of a software rasteriser mean little.
        let clock = if gpu.is_software() { None } else { DeviceClock::new(gpu) };
        let start = Instant::now();
        let jitter = Jitter { frame: 0, frames: 1 };
        let encoding = Encoding::new(&passes, &self.resident, &view.camera, view.size, (&settings, &look), jitter);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        clock.iter().for_each(|clock| clock.start(&mut encoder));
        encoding.whole(&passes, &mut encoder, &self.resident, &targets);
        clock.iter().for_each(|clock| clock.stop(&mut encoder));
        gpu.queue.submit([encoder.finish()]);
        let secs = match clock {
            Some(clock) => clock.secs(gpu)?,
            None => {
                gpu.wait()?;
                start.elapsed().as_secs_f64()
            }
        };
        gpu.check()?;
        self.targets = Some((targets, sums));
        Ok(secs)
    }

    /// Makes the scene and the targets right for a view.
    fn begin(&mut self, passes: &Passes, view: &View) -> Result<(Targets, Sums), RenderError> {
        let gpu = &passes.gpu;
        check_size(gpu, view.size)?;
        let settings = self.settings(view);
        if settings.masking != self.resident.masking {
            let scene = self.resident.scene.clone();
            self.resident = self.loader.load(&scene, settings.masking, &self.lighting, Some(&self.resident))?;
        }
        Ok(match self.targets.take() {
            Some((targets, sums)) if targets.size == view.size => (targets, sums),
            _ => (Targets::new(passes, view.size), Sums::new(gpu, view.size)),
        })
    }

    /// Draws the view and returns scene-linear radiance.
    pub fn render(&mut self, view: &View) -> Result<Picture, RenderError> {
        let picture = self.render_while(view, |_| true)?;
        // Nothing ends it early.
        Ok(picture.unwrap_or_default())
    }

    /// Draws the view frame by frame; `going_on` hears the fraction done before each and ends the work by false. Waits
    /// for each frame, so that others on the device get their turn.
    pub fn render_while(
        &mut self,
        view: &View,
        mut going_on: impl FnMut(f32) -> bool,
    ) -> Result<Option<Picture>, RenderError> {
        let passes = self.loader.passes.clone();
        let gpu = &passes.gpu;
        let (targets, mut sums) = self.begin(&passes, view)?;
        let (settings, look) = (self.settings(view), ProbeLook::new(&view.settings));
        let frames = view.jitter_frames.max(1);
        for frame in 0..frames {
            if !going_on(frame as f32 / frames as f32) {
                return Ok(None);
            }
            let jitter = Jitter { frame, frames };
            let encoding = Encoding::new(&passes, &self.resident, &view.camera, view.size, (&settings, &look), jitter);
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            if frame == 0 {
                sums.clear(&mut encoder);
            }
            encoding.whole(&passes, &mut encoder, &self.resident, &targets);
            passes.accumulate.encode(gpu, &mut encoder, &targets.frame, &mut sums);
            gpu.queue.submit([encoder.finish()]);
            gpu.wait()?;
        }
        let bytes = read_texture(gpu, sums.texture(), 0, 0)?;
        self.targets = Some((targets, sums));
        let (floats, _) = bytes.as_chunks::<16>();
        let scale = 1.0 / frames as f32;
        let texels = floats.iter().map(|texel| bytemuck::pod_read_unaligned::<Vec4>(texel) * scale).collect();
        Ok(Some(Picture { width: view.size.x, height: view.size.y, texels }))
    }
}

/// A size that pictures may have.
pub(crate) fn check_size(gpu: &Gpu, size: UVec2) -> Result<(), RenderError> {
    let allowed = gpu.device.limits().max_texture_dimension_2d;
    if size.min_element() == 0 || size.max_element() > allowed {
        return Err(RenderError::Size { width: size.x, height: size.y, allowed });
    }
    Ok(())
}
