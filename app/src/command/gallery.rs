//! `burnish gallery`: the built-in scenes as a list, as pictures and as files.

use std::collections::BTreeSet;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use burnish_core::param::ParamSpec;
use burnish_core::reference::MAX_SAMPLES;
use burnish_core::scene::gallery::{self, GalleryScene};
use glam::UVec2;
use serde_json::{Value, json};

use super::{render, write_json};
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
    /// Render scenes by the reference, one picture each
    Render(RenderArgs),
}

#[derive(clap::Args)]
struct RenderArgs {
    /// Scenes: NAME[?key=value&...]
    #[arg(value_name = "NAME", required_unless_present = "all", conflicts_with = "all")]
    names: Vec<String>,
    /// Every scene, with its default settings
    #[arg(long)]
    all: bool,
    /// Folder for the pictures, NAME.png each; made where it is missing
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
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
    let names: Vec<String> = match args.all {
        true => gallery::list().iter().map(|scene| scene.name.to_string()).collect(),
        false => args.names.clone(),
    };
    // Everything that can be refused is, before the first picture is traced.
    let mut stems = BTreeSet::new();
    for name in &names {
        gallery::open(name).map_err(|e| Failure::input(Path::new(name), e))?;
        if !stems.insert(stem(name)) {
            return Err(Failure::usage(format!(
                "{name}: its picture is that of another scene of the list; leave one out"
            )));
        }
    }
    let folder =
        |e: std::io::Error| Failure::resources(format!("{}: cannot be made a folder: {e}", args.out.display()));
    fs::create_dir_all(&args.out).map_err(folder)?;
    for name in &names {
        let plain = name.strip_prefix("gallery:").unwrap_or(name);
        let file = args.out.join(stem(name) + ".png");
        let exit = render::reference_picture(&format!("gallery:{plain}"), args.size, args.samples, file, out, err)?;
        if exit != Exit::Ok {
            return Ok(exit);
        }
    }
    Ok(Exit::Ok)
}

/// Name of a file for a scene: its name, then its settings with hyphens between.
fn stem(name: &str) -> String {
    let plain = name.strip_prefix("gallery:").unwrap_or(name);
    plain.chars().map(|c| if c.is_ascii_alphanumeric() || c == '.' { c } else { '-' }).collect()
}
