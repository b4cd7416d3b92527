//! `burnish environment`: maps made by numbers, and the sun taken out of one.

use std::io::Write;
use std::path::PathBuf;

use burnish_core::document::{MadeEntry, SkyEntry, StudioEntry};
use burnish_core::file::{read_bounded, write_environment};
use burnish_core::scene::Environment;
use burnish_core::scene::environment::{Sun, split_sun};
use serde::Serialize;

use super::{spaced, write_json};
use crate::failure::{Exit, Failure};
use crate::source;

/// Largest description of a studio.
const MAX_BYTES: u64 = 1 << 20;

#[derive(clap::Args)]
pub struct Args {
    #[command(subcommand)]
    made: Made,
}

#[derive(clap::Subcommand)]
enum Made {
    /// Write a sky by day (Preetham, Shirley, Smits 1999), in nit, and say what its sun is
    Sky(SkyArgs),
    /// Write a studio of softboxes, in nit
    Studio(StudioArgs),
    /// Take the sun out of a map: write the rest, and say what the sun is as a light
    Split(SplitArgs),
}

#[derive(clap::Args)]
struct Output {
    /// File to write, .hdr or .exr
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

#[derive(clap::Args)]
struct SkyArgs {
    /// Haze, 1.7 to 10
    #[arg(long, value_name = "N", default_value_t = 3.0, value_parser = within::<17, 100, 10>)]
    turbidity: f64,
    /// Of the sun above the horizon, 0 to 90 degrees
    #[arg(long, value_name = "DEGREES", default_value_t = 40.0, value_parser = within::<0, 90, 1>)]
    elevation: f64,
    /// Of the sun from the front (+z) toward +x, degrees
    #[arg(long, value_name = "DEGREES", default_value_t = 45.0, allow_hyphen_values = true, value_parser = within::<-360, 360, 1>)]
    azimuth: f64,
    /// Rows of the map, 16 to 2048; twice as many columns
    #[arg(long, value_name = "N", default_value_t = 512, value_parser = clap::value_parser!(u32).range(16..=2048))]
    rows: u32,
    #[command(flatten)]
    output: Output,
}

#[derive(clap::Args)]
struct StudioArgs {
    /// Description in JSON, as documents have it under `made.studio` [default: a grey room with two lamps]
    #[arg(value_name = "DESCRIPTION")]
    description: Option<PathBuf>,
    /// Rows of the map, 16 to 2048, instead of those of the description
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(16..=2048))]
    rows: Option<u32>,
    #[command(flatten)]
    output: Output,
}

#[derive(clap::Args)]
struct SplitArgs {
    /// Environment map, .hdr or .exr
    #[arg(value_name = "MAP")]
    map: PathBuf,
    #[command(flatten)]
    output: Output,
}

/// A number from `LOW / UNIT` to `HIGH / UNIT`.
fn within<const LOW: i32, const HIGH: i32, const UNIT: i32>(text: &str) -> Result<f64, String> {
    let (low, high) = (f64::from(LOW) / f64::from(UNIT), f64::from(HIGH) / f64::from(UNIT));
    match text.parse::<f64>() {
        Ok(value) if (low..=high).contains(&value) => Ok(value),
        _ => Err(format!("it takes a number from {low} to {high}")),
    }
}

/// What was written.
#[derive(Serialize)]
struct Written {
    file: String,
    width: u32,
    height: u32,
    /// Largest radiance of a channel, nit.
    peak: f32,
    /// On a plane that faces up, without the sun, lx.
    irradiance_up: [f32; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    sun: Option<SunInfo>,
}

/// A sun as a light.
#[derive(Serialize)]
struct SunInfo {
    /// Unit, toward it.
    direction: [f32; 3],
    /// On a surface that faces it, lx.
    irradiance: [f32; 3],
    angular_radius_deg: f32,
}

pub fn run(args: Args, out: &mut dyn Write) -> Result<Exit, Failure> {
    match args.made {
        Made::Sky(SkyArgs { turbidity, elevation, azimuth, rows, output }) => {
            let sky =
                SkyEntry { turbidity, elevation_deg: elevation, azimuth_deg: azimuth, rows, ..SkyEntry::default() };
            let model = sky.model();
            write(&model.map(2 * rows, rows), Some(model.sun()), &output, out)
        }
        Made::Studio(StudioArgs { description, rows, output }) => {
            let mut studio = match &description {
                None => StudioEntry::default(),
                Some(path) => {
                    let bytes = read_bounded(path, MAX_BYTES).map_err(|e| Failure::input(path, e))?;
                    serde_json::from_slice(&bytes).map_err(|e| Failure::input(path, e))?
                }
            };
            studio.rows = rows.unwrap_or(studio.rows);
            let made = MadeEntry::Studio(studio);
            if let (Some(path), Err(error)) = (&description, made.check()) {
                return Err(Failure::input(path, error));
            }
            // Studios are always known.
            let map = made.map().unwrap_or_else(|| Environment::new("studio", 1, 1, vec![glam::Vec3::ZERO]));
            write(&map, None, &output, out)
        }
        Made::Split(SplitArgs { map: path, output }) => {
            let map = source::environment(&path)?.environment;
            let split = split_sun(&map).map_err(|e| Failure::input(&path, e))?;
            write(&split.rest, Some(split.sun), &output, out)
        }
    }
}

fn write(map: &Environment, sun: Option<Sun>, output: &Output, out: &mut dyn Write) -> Result<Exit, Failure> {
    write_environment(map, &output.out).map_err(Failure::resources)?;
    let written = Written {
        file: output.out.display().to_string(),
        width: map.width,
        height: map.height,
        peak: map.texels.iter().map(|t| t.max_element()).fold(0.0, f32::max),
        irradiance_up: map.irradiance_up().to_array(),
        sun: sun.map(|sun| SunInfo {
            direction: sun.direction.to_array(),
            irradiance: sun.irradiance.to_array(),
            angular_radius_deg: sun.angular_radius.to_degrees(),
        }),
    };
    if output.json {
        write_json(out, &written)?;
        return Ok(Exit::Ok);
    }
    let Written { file, width, height, peak, irradiance_up, sun } = written;
    writeln!(out, "{}: {width}x{height}, up to {} nit", crate::failure::printable(&file), spaced([peak]))?;
    writeln!(out, "irradiance on level ground  {} lx", spaced(irradiance_up))?;
    if let Some(SunInfo { direction, irradiance, angular_radius_deg }) = sun {
        writeln!(out, "sun toward                  {}", spaced(direction))?;
        writeln!(out, "sun on a facing surface     {} lx", spaced(irradiance))?;
        writeln!(out, "sun, half its angle         {} deg", spaced([angular_radius_deg]))?;
    }
    Ok(Exit::Ok)
}
