//! `burnish snapshot`: a picture of a document or of the window with it, to look at and to compare in CI.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use burnish_core::color::tone::ToneMap;
use burnish_core::document::{self, Document};
use burnish_core::file::{PictureFormat, read_picture, write_picture};
use burnish_core::job::Handle;
use burnish_core::lighting::Store;
use burnish_core::measure::view::{DisplayMode, displayed};
use burnish_core::measure::{PIXELS_PER_DEGREE, flip};
use burnish_core::picture::Picture;
use burnish_render::{Gpu, Passes, Renderer, View};
use clap::ValueEnum;
use glam::UVec2;

use crate::failure::{Exit, Failure, printable};
use crate::value::{self, Pick};
use crate::window::offscreen::Offscreen;
use crate::window::{Folders, Options, Pane, Session, Workbench, lighting_now};

/// Jittered frames of the picture, as many as the window draws at rest.
const FRAMES: u32 = 16;

#[derive(clap::Args)]
pub struct Args {
    /// Document (.burnish), model (.gltf, .glb, .obj) or gallery:NAME[?key=value&...]
    #[arg(value_name = "DOC", required_unless_present = "start")]
    document: Option<String>,
    /// Picture to write: .png (what a screen shows) or, without --ui, .exr (linear radiance)
    #[arg(long, value_name = "FILE", value_parser = value::picture_path)]
    out: PathBuf,
    /// Draw the whole window instead of the viewport alone
    #[arg(long)]
    ui: bool,
    /// Pixels of the picture
    #[arg(long, value_name = "WxH", default_value = "1280x800", value_parser = value::size)]
    size: UVec2,
    /// Picture to compare with; the difference is written beside --out as NAME.diff.png
    #[arg(long, value_name = "REF")]
    compare: Option<PathBuf>,
    /// Exit with 1 when the mean FLIP error is larger, 0 to 1
    #[arg(long, value_name = "T", default_value_t = 0.01, value_parser = value::number(0.0, 1.0), requires = "compare")]
    threshold: f32,
    /// What is shown of the picture: picture, false-color (stops about middle grey) or clipping (marks of it)
    #[arg(long, value_name = "MODE", default_value = "picture", value_parser = str::parse::<DisplayMode>)]
    display: DisplayMode,
    /// Bring a panel of the window to the front; repeatable
    #[arg(long, value_name = "NAME", requires = "ui", value_parser = panel)]
    panel: Vec<Pane>,
    /// Material that the window shows, a name or #index
    #[arg(long, value_name = "MATERIAL", requires = "ui")]
    select: Option<String>,
    /// Theme of the window
    #[arg(long, value_enum, default_value_t = Theme::Dark, requires = "ui")]
    theme: Theme,
    /// Show the start page of the window
    #[arg(long, requires = "ui", conflicts_with_all = ["document", "panel", "select"])]
    start: bool,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Theme {
    Dark,
    Light,
}

pub fn run(args: Args, out: &mut dyn Write, err: &mut dyn Write) -> Result<Exit, Failure> {
    check(&args)?;
    let session = args.document.as_deref().map(|scene| open(scene, err)).transpose()?;
    let (picture, tone, exposure) = match session {
        Some(session) if !args.ui => shown(args.display, viewport(&session, args.size, err)?),
        session => (window(&args, session)?, ToneMap::None, 0.0),
    };
    write_picture(&picture, &args.out, tone, exposure).map_err(Failure::resources)?;
    writeln!(out, "wrote {}: {}x{}", args.out.display(), args.size.x, args.size.y)?;
    match &args.compare {
        Some(reference) => compare(&args, reference, out, err),
        None => Ok(Exit::Ok),
    }
}

/// The picture in a mode of the display, with the display transform that is still to be done.
fn shown(mode: DisplayMode, (picture, tone, exposure_ev): (Picture, ToneMap, f32)) -> (Picture, ToneMap, f32) {
    match mode {
        DisplayMode::Picture => (picture, tone, exposure_ev),
        _ => (displayed(&picture, mode, tone, exposure_ev), ToneMap::None, 0.0),
    }
}

/// Refuses what would only fail after the work.
fn check(args: &Args) -> Result<(), Failure> {
    let is_png = PictureFormat::of(&args.out) == Ok(PictureFormat::Png);
    if args.ui && !is_png {
        return Err(Failure::usage("--ui writes a .png; name --out so"));
    }
    if args.display != DisplayMode::Picture && !is_png {
        return Err(Failure::usage(format!("--display {} is for a screen; name --out .png", args.display.id())));
    }
    if let Some(folder) = args.out.parent().filter(|f| !f.as_os_str().is_empty() && !f.is_dir()) {
        let (file, folder) = (args.out.display(), folder.display());
        let reason = format!("{file}: there is no folder {folder}; create it or choose another --out");
        return Err(Failure::resources(reason));
    }
    let Some(reference) = &args.compare else { return Ok(()) };
    if same_file(reference, &args.out) {
        return Err(Failure::usage("--out would overwrite the picture of --compare; name another file"));
    }
    let difference = difference_path(&args.out);
    if same_file(reference, &difference) {
        let difference = difference.display();
        let reason = format!("the difference, {difference}, would overwrite the picture of --compare; rename --out");
        return Err(Failure::usage(reason));
    }
    Ok(())
}

/// Where the difference to the reference goes.
fn difference_path(out: &Path) -> PathBuf {
    out.with_extension("diff.png")
}

/// True where both paths lead to one file, through links too; names decide where there is none yet.
fn same_file(a: &Path, b: &Path) -> bool {
    match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => std::path::absolute(a).ok() == std::path::absolute(b).ok(),
    }
}

fn panel(name: &str) -> Result<Pane, String> {
    let found = Pane::ALL.into_iter().find(|pane| pane.title().eq_ignore_ascii_case(name));
    found.ok_or_else(|| {
        let names: Vec<String> = Pane::ALL.iter().map(|pane| pane.title().to_lowercase()).collect();
        format!("there are {}", names.join(", "))
    })
}

/// Reads the document; one with missing files is refused, since what stands in for them is no picture of it.
fn open(scene: &str, err: &mut dyn Write) -> Result<Session, Failure> {
    let opened = document::open(scene).map_err(|e| Failure::input(Path::new(scene), e))?;
    if !opened.missing.is_empty() {
        let line =
            |missing: &document::Missing| format!("{}: {}; relink it in the window", missing.path, missing.reason);
        return Err(Failure { exit: Exit::Input, messages: opened.missing.iter().map(line).collect() });
    }
    for notice in &opened.notices {
        writeln!(err, "burnish: notice: {}", printable(notice))?;
    }
    let path = document::is_document(Path::new(scene)).then(|| PathBuf::from(scene));
    let session = Session::new(opened, path);
    for notice in &session.resolved().notices {
        writeln!(err, "burnish: notice: {}", printable(notice))?;
    }
    Ok(session)
}

/// The picture alone, as the document says.
fn viewport(session: &Session, size: UVec2, err: &mut dyn Write) -> Result<(Picture, ToneMap, f32), Failure> {
    let Document { view, lighting, .. } = &**session.document();
    let gpu = Gpu::new().map_err(Failure::resources)?;
    let passes = Arc::new(Passes::new(&gpu));
    let mut renderer = Renderer::with_passes(&passes, session.scene()).map_err(Failure::resources)?;
    for name in renderer.unshadowed_lights() {
        writeln!(err, "burnish: notice: light `{}` casts no shadow: the shadow maps are full", printable(name))?;
    }
    let store = Folders::of_user().map_or_else(Store::none, |folders| Store::within(&folders.prepared()));
    let prepared = lighting_now(session.layers(), session.scene(), (&passes, &store), &Handle::default());
    renderer.light_by(&prepared.map_err(Failure::resources)?).map_err(Failure::resources)?;
    let camera = view.camera.camera();
    let of_document = View { size, camera, settings: lighting.settings(), jitter_frames: FRAMES };
    let picture = renderer.render(&of_document).map_err(Failure::resources)?;
    Ok((picture, view.tone.parse().unwrap_or_default(), view.exposure_ev as f32))
}

/// The whole window. Nothing of the user's own gets into it: its data folder is empty.
fn window(args: &Args, session: Option<Session>) -> Result<Picture, Failure> {
    let folder = EmptyFolder::new().map_err(Failure::resources)?;
    let mut offscreen = Offscreen::new(args.size).map_err(Failure::resources)?;
    let options = Options { data_folder: Some(folder.0.clone()), ..Options::default() };
    let ctx = offscreen.context().clone();
    let mut workbench = Workbench::new(&ctx, options, offscreen.stage());
    workbench.preferences_mut().dark = Some(args.theme == Theme::Dark);
    if let Some(session) = session {
        workbench.set_session(session);
    }
    if let Some(name) = &args.select {
        let names = workbench.session().document().materials.iter().map(|entry| entry.name.as_str());
        let found = Pick::parse(name).among("material", names);
        let found = found.map_err(|e| Failure::usage(format!("--select: {e}")))?;
        workbench.session_mut().selection.material = found.first().copied().unwrap_or_default();
    }
    workbench.aids_mut().mode = args.display;
    for pane in &args.panel {
        workbench.show_panel(*pane);
    }
    offscreen.picture(&mut workbench).map_err(Failure::resources)
}

/// A folder of this run, removed at its end.
struct EmptyFolder(PathBuf);

impl EmptyFolder {
    fn new() -> Result<EmptyFolder, String> {
        static COUNT: std::sync::atomic::AtomicU32 = std::sync::atomic::AtomicU32::new(0);
        let number = COUNT.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("burnish-snapshot-{}-{number}", std::process::id()));
        std::fs::create_dir_all(&path).map_err(|e| {
            format!("{}: cannot be created ({e}); set TMPDIR to a folder that can be written", path.display())
        })?;
        Ok(EmptyFolder(path))
    }
}

impl Drop for EmptyFolder {
    fn drop(&mut self) {
        // A leftover in the folder for temporary files harms nobody.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn compare(args: &Args, reference: &Path, out: &mut dyn Write, err: &mut dyn Write) -> Result<Exit, Failure> {
    let file = args.out.display();
    if !reference.exists() {
        let reason = format!("there is no such file; look at {file} and copy it there if it is right");
        return Err(Failure::input(reference, reason));
    }
    let (expected, expected_kind) = read_picture(reference).map_err(|e| Failure::input(reference, e))?;
    // As it was written: 8 bits against 8 bits.
    let (actual, kind) = read_picture(&args.out).map_err(|e| Failure::input(&args.out, e))?;
    if kind != expected_kind {
        return Err(Failure::input(reference, format!("is of another kind than {file}; compare .png with .png")));
    }
    let seen = flip(&expected, &actual, 0.0, PIXELS_PER_DEGREE)
        .map_err(|e| Failure::input(reference, format!("cannot be compared with {file}: {e}")))?;
    let difference = difference_path(&args.out);
    write_picture(&seen.picture(), &difference, ToneMap::None, 0.0).map_err(Failure::resources)?;
    writeln!(out, "flip {:.6}, threshold {}", seen.mean, args.threshold)?;
    if seen.mean <= f64::from(args.threshold) {
        return Ok(Exit::Ok);
    }
    writeln!(
        err,
        "burnish: {file} differs from {}: mean FLIP {:.6} is over {}; see {}; copy {file} over the reference if it is right",
        reference.display(),
        seen.mean,
        args.threshold,
        difference.display()
    )?;
    Ok(Exit::Difference)
}
