//! Pictures by methods that the graphics device draws.

use std::io::Write;
use std::sync::Arc;
use std::time::Instant;

use burnish_core::document::Document;
use burnish_core::file::write_picture;
use burnish_core::job::Handle;
use burnish_core::lighting::{Layers, Method, classical};
use burnish_core::param::Settings;
use burnish_render::{Gpu, Passes, Renderer, View};
use glam::UVec2;

use super::{Output, Sources, assign, tell};
use crate::command::stage::{Forms, StageArgs, Staged};
use crate::failure::{Exit, Failure, printable};
use crate::source::Opened;
use crate::window::lighting_now;

/// Frames that are averaged when nothing is said.
const FRAMES: u32 = 16;

/// What only this method takes.
#[derive(clap::Args, Default)]
pub struct ClassicalArgs {
    /// Jittered frames that are averaged, 1 to 4096 [default: 16]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=4096))]
    spp_jitter: Option<u32>,
}

impl ClassicalArgs {
    /// An option that was given.
    pub fn given(&self) -> Option<&'static str> {
        self.spp_jitter.map(|_| "--spp-jitter")
    }
}

pub fn run(
    method: &'static dyn Method,
    (args, sources): (&ClassicalArgs, Sources<'_>),
    (stage, opened): (&StageArgs, Opened),
    set: &[(String, String)],
    output: &Output,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<Exit, Failure> {
    // Settings of another live method are none of this one.
    let id = method.info().id;
    let is_live = |document: &&Document| document.lighting.live_method().info().id == id;
    let document = opened.document.as_ref().filter(is_live);
    let mut settings = document.map_or_else(|| Settings::new(method.info().params), |d| d.lighting.settings());
    assign(&mut settings, set)?;
    let choice = classical::form_choice(&settings);
    let Staged { scene, camera, size, notices, document, .. } = stage.set(opened, choice, Forms::OfMaterials)?;
    tell(err, &notices)?;

    let start = Instant::now();
    let gpu = Gpu::new().map_err(|e| Failure::resources(format!("{e}; or draw on the processor with --processor")))?;
    let frames = args.spp_jitter.unwrap_or(FRAMES);
    let scene = Arc::new(scene);
    let layers = Layers::of(method, settings.clone());
    let passes = Arc::new(Passes::new(&gpu));
    let store = sources.store(layers.first(), &scene, err)?;
    let lighting = lighting_now(&layers, &scene, (&passes, &store), &Handle::default());
    let lighting = lighting.map_err(Failure::resources)?;
    if let Some(prepared) = lighting.prepared() {
        tell(err, &method.warnings(&scene, prepared, &settings))?;
    }
    let view = View { size, camera, settings, jitter_frames: frames };
    let mut renderer = Renderer::with_passes(&passes, &scene).map_err(Failure::resources)?;
    renderer.light_by(&lighting).map_err(Failure::resources)?;
    for name in renderer.unshadowed_lights() {
        writeln!(err, "burnish: notice: light `{}` casts no shadow: the shadow maps are full", printable(name))?;
    }
    let picture = renderer.render(&view).map_err(Failure::resources)?;
    let (tone, exposure_ev) = output.look(document.as_ref().map(|document| &document.view));
    write_picture(&picture, &output.out, tone, exposure_ev).map_err(Failure::resources)?;
    let UVec2 { x, y } = size;
    let (adapter, secs) = (&gpu.report().name, start.elapsed().as_secs_f32());
    writeln!(out, "wrote {}: {x}x{y}, {frames} frames, {secs:.1} s on {adapter}", output.out.display())?;
    Ok(Exit::Ok)
}
