//! Shared fixtures of the cross-crate tests: what a test needs beyond the repository, and a folder to write into.

pub mod scenes;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use libtest_mimic::{Completion, Failed, Trial};

/// Something outside the repository that a test cannot do without. Where it is missing the test prints
/// `ignored: <why>`; `BURNISH_REQUIRE`, a comma list of [`Need::word`]s, turns that into a failure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// A Vulkan, Metal or DX12 adapter; a software one will do.
    Gpu,
    /// The trial models and environments beside the repository, see [`data_folder`].
    Data,
    /// A Python that can render with Mitsuba 3, see [`mitsuba_python`].
    Mitsuba,
    /// A Python with the published FLIP, see [`flip_python`].
    Flip,
}

impl Need {
    /// Name in `BURNISH_REQUIRE`.
    pub fn word(self) -> &'static str {
        match self {
            Need::Gpu => "gpu",
            Need::Data => "data",
            Need::Mitsuba => "mitsuba",
            Need::Flip => "flip",
        }
    }

    /// Why the need is not met here; `None` when it is.
    pub fn missing(self) -> Option<&'static str> {
        match self {
            Need::Gpu => (!has_adapter()).then_some("no adapter"),
            Need::Data => data_folder().is_none().then_some("no trial data"),
            Need::Mitsuba => mitsuba_python().is_none().then_some("no Python with mitsuba"),
            Need::Flip => flip_python().is_none().then_some("no Python with flip-evaluator"),
        }
    }
}

/// A test that fails by panicking, for libtest-mimic, and that is ignored visibly where a need is missing.
pub fn trial(name: &'static str, needs: &'static [Need], body: impl FnOnce() + Send + 'static) -> Trial {
    Trial::ignorable_test(name, move || {
        let list = std::env::var("BURNISH_REQUIRE").unwrap_or_default();
        for need in needs {
            match verdict(*need, need.missing(), &list)? {
                Completion::Completed => {}
                Completion::Ignored { reason } => {
                    eprintln!("ignored: {}: {name}", reason.as_deref().unwrap_or_default());
                    return Ok(Completion::Ignored { reason });
                }
            }
        }
        body();
        Ok(Completion::Completed)
    })
}

/// `Completed` where nothing is missing; else ignored, or failed when `list` asks for the need.
fn verdict(need: Need, missing: Option<&str>, list: &str) -> Result<Completion, Failed> {
    match missing {
        None => Ok(Completion::Completed),
        Some(why) if list.split(',').any(|word| word.trim() == need.word()) => {
            Err(format!("{why}, and BURNISH_REQUIRE asks for `{}`", need.word()).into())
        }
        Some(why) => Ok(Completion::ignored_with(why)),
    }
}

/// True when this machine has an adapter of a backend that Burnish accepts.
///
/// Asks wgpu itself: were this left to `burnish_render`, a fault there would make every GPU test look ignored.
fn has_adapter() -> bool {
    static FOUND: OnceLock<bool> = OnceLock::new();
    *FOUND.get_or_init(|| {
        let backends = wgpu::Backends::VULKAN | wgpu::Backends::METAL | wgpu::Backends::DX12;
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        !pollster::block_on(instance.enumerate_adapters(backends)).is_empty()
    })
}

/// A Python with the packages `mitsuba` and `numpy`: `BURNISH_PYTHON`, else `python3`.
pub fn mitsuba_python() -> Option<&'static Path> {
    static FOUND: OnceLock<Option<PathBuf>> = OnceLock::new();
    FOUND.get_or_init(|| python_with("mitsuba, numpy")).as_deref()
}

/// A Python with the packages `flip-evaluator` and `numpy`, likewise.
pub fn flip_python() -> Option<&'static Path> {
    static FOUND: OnceLock<Option<PathBuf>> = OnceLock::new();
    FOUND.get_or_init(|| python_with("flip_evaluator, numpy")).as_deref()
}

fn python_with(modules: &str) -> Option<PathBuf> {
    let python = PathBuf::from(std::env::var_os("BURNISH_PYTHON").unwrap_or_else(|| "python3".into()));
    let asked = Command::new(&python).args(["-c", &format!("import {modules}")]).output();
    asked.is_ok_and(|output| output.status.success()).then_some(python)
}

/// Folder of the trial data (`models/`, `hdri/`): `BURNISH_DATA`, else `../shared/data` beside the repository.
pub fn data_folder() -> Option<PathBuf> {
    let folder = match std::env::var_os("BURNISH_DATA") {
        Some(folder) => PathBuf::from(folder),
        None => repository().join("../shared/data"),
    };
    folder.is_dir().then_some(folder)
}

/// Root of the repository.
pub fn repository() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("."))
}

/// An empty folder for the files that a test writes; `name` must be unique among all tests.
pub fn scratch_folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("burnish-{}-{name}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    folder
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_need_is_ignored_unless_the_list_asks_for_it() {
        assert!(matches!(verdict(Need::Gpu, Some("no adapter"), "data"), Ok(Completion::Ignored { reason: Some(_) })));
        assert!(verdict(Need::Gpu, Some("no adapter"), "data, gpu").is_err());
        assert!(matches!(verdict(Need::Gpu, None, "gpu"), Ok(Completion::Completed)));
    }
}
