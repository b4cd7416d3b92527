//! Scenes as GLB on the disk, with their environments beside them: what `export` and `gallery export` write.

use std::ffi::OsStr;
use std::io::Write;
use std::path::{Path, PathBuf};

use burnish_core::color::tone::ToneMap;
use burnish_core::export::gltf::{self, Encoded};
use burnish_core::export::{Note, Report};
use burnish_core::file::{write_atomic, write_picture};
use burnish_core::picture::Picture;
use burnish_core::scene::{Environment, Scene};

use crate::failure::{Failure, printable};

/// Writes the scene as `file` and its environment as an OpenEXR map of the same name; the report names both.
pub fn write(scene: &Scene, file: &Path) -> Result<Report, Failure> {
    let Encoded { glb, mut report } = gltf::encode(scene).map_err(Failure::resources)?;
    // The file itself comes last: where it is, all is.
    if let Some(map) = &scene.environment {
        write_map(map, &map_beside(file))?;
    }
    write_atomic(file, &glb).map_err(Failure::resources)?;
    let maps = scene.environment.iter().map(|_| map_beside(file));
    report.files = std::iter::once(file.to_path_buf()).chain(maps).map(|path| name(&path)).collect();
    Ok(report)
}

/// Where the environment of a scene is written.
pub fn map_beside(file: &Path) -> PathBuf {
    file.with_extension("exr")
}

/// The radiance as it lights the scene, but not turned.
fn write_map(map: &Environment, file: &Path) -> Result<(), Failure> {
    let texels = map.texels.iter().map(|radiance| (map.scale() * *radiance).extend(1.0)).collect();
    let picture = Picture { width: map.width, height: map.height, texels };
    write_picture(&picture, file, ToneMap::None, 0.0).map_err(Failure::resources)
}

fn name(file: &Path) -> String {
    file.file_name().map(OsStr::to_string_lossy).unwrap_or_default().into_owned()
}

/// A line for each loss, after `scene` where there are several.
pub fn write_notes(out: &mut dyn Write, scene: Option<&str>, notes: &[Note]) -> Result<(), Failure> {
    let before = scene.map(|scene| format!("{scene}: ")).unwrap_or_default();
    for note in notes {
        let line = format!("{before}{}: {}: {}", note.element, note.loss.word(), note.what);
        writeln!(out, "{}", printable(&line))?;
    }
    Ok(())
}

/// A line for each file beside `file`, and for that itself.
pub fn write_files(out: &mut dyn Write, file: &Path, report: &Report) -> Result<(), Failure> {
    for name in &report.files {
        writeln!(out, "wrote {}", file.with_file_name(name).display())?;
    }
    Ok(())
}
