//! `burnish doctor`: what the program finds on this machine, and what to install.

use std::io::Write;
use std::path::PathBuf;

use burnish_render::{AdapterReport, adapters};

use crate::failure::{Exit, Failure};

/// Debian's name for the drivers, the software rasteriser among them.
const DRIVER_PACKAGE: &str = "mesa-vulkan-drivers";

pub fn run(out: &mut dyn Write) -> Result<Exit, Failure> {
    let adapters = adapters();
    writeln!(out, "burnish {}", env!("CARGO_PKG_VERSION"))?;
    writeln!(out, "\nadapters")?;
    if adapters.is_empty() {
        writeln!(out, "  none")?;
    }
    for adapter in &adapters {
        write_adapter(out, adapter)?;
    }
    if cfg!(target_os = "linux") {
        writeln!(out, "\nlibraries")?;
        write_found(out, "Vulkan loader", &libraries("libvulkan.so.1"))?;
        write_found(out, "Vulkan driver", &vulkan_drivers())?;
    }
    if adapters.iter().any(|a| a.accepted.is_ok()) {
        return Ok(Exit::Ok);
    }
    Err(Failure::resources(if cfg!(target_os = "linux") {
        format!("no usable graphics adapter; run: sudo apt-get install -y --no-install-recommends {DRIVER_PACKAGE}")
    } else {
        "no usable graphics adapter; install the driver of your graphics card".into()
    }))
}

fn write_adapter(out: &mut dyn Write, adapter: &AdapterReport) -> Result<(), Failure> {
    let AdapterReport { name, backend, device_type, driver, accepted, limits, features } = adapter;
    writeln!(out, "  {name}")?;
    writeln!(out, "    {backend}, {device_type}, {driver}")?;
    match accepted {
        Ok(()) => writeln!(out, "    accepted")?,
        Err(reason) => writeln!(out, "    refused: {reason}")?,
    }
    for (limit, value) in limits {
        writeln!(out, "    {limit}: {value}")?;
    }
    writeln!(out, "    features: {}", if features.is_empty() { "none".into() } else { features.join(", ") })?;
    Ok(())
}

fn write_found(out: &mut dyn Write, what: &str, files: &[PathBuf]) -> Result<(), Failure> {
    if files.is_empty() {
        writeln!(out, "  {what}: missing; run: sudo apt-get install -y --no-install-recommends {DRIVER_PACKAGE}")?;
    }
    for file in files {
        writeln!(out, "  {what}: {}", file.display())?;
    }
    Ok(())
}

/// Places of a shared library, in the folders that the linker of Linux systems searches.
fn libraries(name: &str) -> Vec<PathBuf> {
    let arch = std::env::consts::ARCH;
    let mut folders: Vec<PathBuf> =
        std::env::var_os("LD_LIBRARY_PATH").map(|list| std::env::split_paths(&list).collect()).unwrap_or_default();
    folders.extend(["/usr/local/lib", "/usr/lib64", "/usr/lib"].map(PathBuf::from));
    folders.push(format!("/usr/lib/{arch}-linux-gnu").into());
    folders.into_iter().map(|folder| folder.join(name)).filter(|file| file.exists()).collect()
}

/// The manifests by which the Vulkan loader finds its drivers.
fn vulkan_drivers() -> Vec<PathBuf> {
    for variable in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        if let Some(list) = std::env::var_os(variable) {
            return std::env::split_paths(&list).filter(|file| file.exists()).collect();
        }
    }
    let folders = ["/etc/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/usr/share/vulkan/icd.d"];
    let entries = folders.iter().filter_map(|folder| std::fs::read_dir(folder).ok()).flatten().flatten();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    files.retain(|file| file.extension().is_some_and(|ending| ending == "json"));
    files.sort();
    files
}
