//! `burnish [SCENE]`: the window.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::CommandFactory;

use crate::failure::{Exit, Failure};
use crate::source::gallery_name;
use crate::window;

#[derive(clap::Args)]
pub struct Args {
    /// Model (.gltf, .glb, .obj), document (.burnish) or gallery:NAME[?key=value&...] to open in the window [default:
    /// the start page]
    scene: Option<OsString>,
    /// Environment map, .hdr or .exr, instead of the scene's
    #[arg(long, value_name = "FILE")]
    env: Option<PathBuf>,
    /// Take up what was not saved when the program ended last
    #[arg(long)]
    recover: bool,
}

pub fn run(args: Args) -> Result<Exit, Failure> {
    let Args { scene, env, recover } = args;
    if let Some(scene) = scene.as_ref().filter(|scene| gallery_name(scene).is_none()) {
        check_file(Path::new(scene), true)?;
    }
    if let Some(file) = &env {
        check_file(file, false)?;
    }
    check_display(|name| std::env::var_os(name).is_some_and(|value| !value.is_empty()))?;
    let scene = scene.map(|scene| scene.to_string_lossy().into_owned());
    window::run(window::Options { scene, environment: env, recover, data_folder: None })?;
    Ok(Exit::Ok)
}

/// Refuses a file that is not there before a window opens; `may_be_command` is for the first argument.
fn check_file(path: &Path, may_be_command: bool) -> Result<(), Failure> {
    if path.exists() {
        return Ok(());
    }
    // A word alone is a command with a slip of the finger rather than a file.
    let word = path.to_str().filter(|word| word.chars().all(|c| c.is_ascii_alphanumeric() || c == '-'));
    match word.filter(|_| may_be_command) {
        Some(word) => {
            let program = crate::Cli::command();
            let names: Vec<&str> = program.get_subcommands().map(|command| command.get_name()).collect();
            let commands = names.join(", ");
            Err(Failure::usage(format!("there is no command and no file `{word}`; the commands are {commands}")))
        }
        None => Err(Failure::input(path, "there is no such file; check the name and the folder")),
    }
}

/// A window needs a display; asked before, since the libraries that would open one say it in riddles.
fn check_display(is_set: impl Fn(&str) -> bool) -> Result<(), Failure> {
    let needed = cfg!(all(unix, not(target_os = "macos")));
    if needed && !["WAYLAND_DISPLAY", "WAYLAND_SOCKET", "DISPLAY"].into_iter().any(is_set) {
        return Err(Failure::resources(
            "there is no display for a window (neither WAYLAND_DISPLAY nor DISPLAY is set); start it on a desktop, or \
             use a command that needs none, such as `burnish render`",
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(all(unix, not(target_os = "macos")))]
    #[test]
    fn without_a_display_it_says_what_to_do() {
        let failure = check_display(|_| false).unwrap_err();
        assert_eq!((failure.exit, failure.messages.len()), (Exit::Resources, 1));
        assert!(failure.messages[0].contains("burnish render"));
        assert_eq!(check_display(|name| name == "DISPLAY"), Ok(()));
    }

    #[test]
    fn a_word_that_is_no_file_is_a_slip_and_a_path_a_missing_file() {
        let slip = check_file(Path::new("rendr"), true).unwrap_err();
        assert_eq!(slip.exit, Exit::Usage);
        assert!(slip.messages[0].contains("render"));
        assert_eq!(check_file(Path::new("none/chair.glb"), true).unwrap_err().exit, Exit::Input);
        assert_eq!(check_file(Path::new("none"), false).unwrap_err().exit, Exit::Input);
    }
}
