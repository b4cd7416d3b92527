//! `burnish gallery`: the built-in scenes as a list, as pictures and as files.

use std::collections::BTreeSet;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use burnish_core::param::ParamSpec;
use burnish_core::reference::MAX_SAMPLES;
use burnish_core::scene::Scene;
use burnish_core::scene::gallery::{self, GalleryScene};
use glam::UVec2;
use serde_json::{Value, json};

use super::{glb, render, write_json};
use crate::failure::{Exit, Failure};
use crate::value;

#[derive(clap::Args)]
pub struct Args {
    #[command(subcommand)]
    action: Action,
}

#[derive(clap::Subcommand)]
enum Action {
    /// List the scenes with their settings
    List {
        /// Write the list as JSON
        #[arg(long)]
        json: bool,
    },
    /// Render scenes by the reference, one picture NAME.png each
    Render(RenderArgs),
    /// Write scenes as NAME.glb, with their environments as NAME.exr, and tell what glTF cannot hold
    Export(ChosenArgs),
}

/// Which scenes, and where what is made of them goes.
#[derive(clap::Args)]
struct ChosenArgs {
    /// Scenes: NAME[?key=value&...]
    #[arg(value_name = "NAME", required_unless_present = "all", conflicts_with = "all")]
    names: Vec<String>,
    /// Every scene, with its default settings
    #[arg(long)]
    all: bool,
    /// Folder for the files, which are called NAME; made where it is missing
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

#[derive(clap::Args)]
struct RenderArgs {
    #[command(flatten)]
    chosen: ChosenArgs,
    /// Samples of every pixel, 1 to 16777216
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_SAMPLES)))]
    samples: u32,
    /// Pixels of each picture
    #[arg(long, value_name = "WxH", default_value = "640x360", value_parser = value::size)]
    size: UVec2,
}

pub fn run(args: Args, out: &mut dyn Write, err: &mut dyn Write) -> Result<Exit, Failure> {
    match args.action {
        Action::List { json: true } => {
            write_json(out, &gallery::list().iter().map(described).collect::<Vec<_>>())?;
            Ok(Exit::Ok)
        }
        Action::List { json: false } => list(out),
        Action::Render(args) => pictures(&args, out, err),
        Action::Export(args) => models(&args, out),
    }
}

/// The list for people.
fn list(out: &mut dyn Write) -> Result<Exit, Failure> {
    for GalleryScene { name, title, params, .. } in gallery::list() {
        writeln!(out, "gallery:{name}  {title}")?;
        for spec in *params {
            let unit = if spec.unit.is_empty() { String::new() } else { format!(" {}", spec.unit) };
            writeln!(out, "    {}  {} [default: {}{unit}]", spec.key, spec.help, default_text(spec))?;
        }
    }
    Ok(Exit::Ok)
}

/// A scene for a machine.
fn described(scene: &GalleryScene) -> Value {
    let param = |spec: &ParamSpec| {
        json!({
            "key": spec.key,
            "label": spec.label,
            "unit": spec.unit,
            "takes": spec.kind.to_string(),
            "default": spec.json(spec.default()),
            "help": spec.help,
        })
    };
    let params: Vec<Value> = scene.params.iter().map(param).collect();
    json!({ "name": scene.name, "title": scene.title, "params": params })
}

/// The default as it is written on the command line.
fn default_text(spec: &ParamSpec) -> String {
    match spec.json(spec.default()) {
        Value::String(word) => word,
        Value::Array(numbers) => numbers.iter().map(Value::to_string).collect::<Vec<_>>().join(","),
        other => other.to_string(),
    }
}

fn pictures(args: &RenderArgs, out: &mut dyn Write, err: &mut dyn Write) -> Result<Exit, Failure> {
    for (scene, _) in args.chosen.scenes()? {
        let file = args.chosen.out.join(stem(&scene) + ".png");
        let exit = render::reference_picture(&format!("gallery:{scene}"), args.size, args.samples, file, out, err)?;
        if exit != Exit::Ok {
            return Ok(exit);
        }
    }
    Ok(Exit::Ok)
}

fn models(args: &ChosenArgs, out: &mut dyn Write) -> Result<Exit, Failure> {
    for (name, scene) in args.scenes()? {
        let file = args.out.join(stem(&name) + ".glb");
        let report = glb::write(&scene, &file)?;
        glb::write_notes(out, Some(&name), &report.notes)?;
        glb::write_files(out, &file, &report)?;
    }
    Ok(Exit::Ok)
}

impl ChosenArgs {
    /// The scenes that are asked for, without the word before their names. Everything that can be refused is, before the
    /// first is worked on.
    fn scenes(&self) -> Result<Vec<(String, Scene)>, Failure> {
        let ChosenArgs { names, all, out } = self;
        let names: Vec<String> = match all {
            true => gallery::list().iter().map(|scene| scene.name.to_string()).collect(),
            false => names.clone(),
        };
        let mut stems = BTreeSet::new();
        let mut list = Vec::new();
        for name in names {
            let plain = name.strip_prefix("gallery:").unwrap_or(&name).to_string();
            let scene = gallery::open(&plain).map_err(|e| Failure::input(Path::new(&name), e))?;
            if !stems.insert(stem(&plain)) {
                return Err(Failure::usage(format!(
                    "{name}: its file is that of another scene of the list; leave one out"
                )));
            }
            list.push((plain, scene));
        }
        let failure =
            |e: std::io::Error| Failure::resources(format!("{}: cannot be made a folder: {e}", out.display()));
        fs::create_dir_all(out).map_err(failure)?;
        Ok(list)
    }
}

/// Name of a file for a scene: its name, then its settings with hyphens between.
fn stem(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() || c == '.' { c } else { '-' }).collect()
}
