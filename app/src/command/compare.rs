//! `burnish compare`: how different two pictures are.

use std::io::Write;
use std::path::{Path, PathBuf};

use burnish_core::file::read_picture;
use burnish_core::measure::{flip, relmse};
use burnish_core::picture::Picture;
use clap::ValueEnum;
use serde::Serialize;

use super::write_json;
use crate::failure::{Exit, Failure};
