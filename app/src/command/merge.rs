//! `burnish merge`: parts of a bake, or bakes of different seeds, as one.

use std::io::Write;
use std::path::PathBuf;

use burnish_core::file::FileError;
use burnish_core::lighting::bakes::Bake;
use burnish_core::lighting::radiance_map::{self, Shard};

use super::bake::Report;
use crate::failure::{Exit, Failure};

#[derive(clap::Args)]
pub struct Args {
    /// Parts of one bake, in any order; with --average bakes of different seeds
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// The mean of bakes of different seeds
    #[arg(long)]
    average: bool,
    /// File to write, .bake
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

pub fn run(args: Args, out: &mut dyn Write) -> Result<Exit, Failure> {
    let Args { files, average, out: file, json } = args;
    super::render::check_folder("--out", &file)?;
    let joined = if average {
        radiance_map::average(&all(&files, |path| Bake::read(path))?)
    } else {
        radiance_map::merge(&all(&files, |path| Shard::read(path))?)
    };
    let bake = joined.map_err(faults)?;
    bake.write(&file).map_err(Failure::resources)?;
    Report::of(&bake, &file).write(json, out)?;
    Ok(Exit::Ok)
}

/// Reads all, or tells of every one that cannot be read.
fn all<T>(files: &[PathBuf], read: impl Fn(&PathBuf) -> Result<T, FileError>) -> Result<Vec<(PathBuf, T)>, Failure> {
    let (mut found, mut failed) = (Vec::new(), Vec::new());
    for path in files {
        match read(path) {
            Ok(whole) => found.push((path.clone(), whole)),
            Err(error) => failed.push(error),
        }
    }
    if failed.is_empty() { Ok(found) } else { Err(faults(failed)) }
}

fn faults(faults: Vec<FileError>) -> Failure {
    Failure { exit: Exit::Input, messages: faults.iter().map(ToString::to_string).collect() }
}
