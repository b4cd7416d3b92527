//! The mean of bakes of different seeds.

use std::collections::HashMap;
use std::path::PathBuf;

use glam::Vec3;
use half::f16;

use super::bake::{GROUPS, Group, ordered};
use super::method::ID;
use super::settings::baked_directions;
use crate::file::FileError;
use crate::lighting::bakes::{About, Bake};

/// Settings in which bakes of a mean differ.
const OF_RUNS: [&str; 2] = ["seed", "paths"];

/// Joins bakes of the same scene and places by different seeds, each weighed by its paths. Places that one of them left out are left out. Every
/// fault is told with its file.
pub fn average(files: &[(PathBuf, Bake)]) -> Result<Bake, Vec<FileError>> {
    let Some((first_path, first)) = files.first() else { return Err(Vec::new()) };
    let mut faults = Vec::new();
    let mut runs: Vec<[u32; 2]> = Vec::new();
    for (path, bake) in files {
        let (own, other) = (&first.about.origin, &bake.about.origin);
        let mut differing = [own.other_parts(other), own.other_settings(other)].concat();
        differing.retain(|name| !OF_RUNS.contains(name));
        let is_map = other.method == ID && other.revision == own.revision && baked_directions(&bake.prepared).is_some();
        if !is_map || !differing.is_empty() {
            let what = if is_map { differing.join(", ") } else { "methods".into() };
            let reason = format!("is of another bake than {}: {what} differ", first_path.display());
            faults.push(FileError::new(
                path,
                reason,
                "leave it out, or bake it of the same scene with the same settings",
            ));
            continue;
        }
        for run in own_runs(&bake.about) {
            if runs.iter().any(|known| known[0] == run[0]) {
                let reason = format!("has the seed {}, which another has too: the same numbers twice", run[0]);
                faults.push(FileError::new(path, reason, "bake it with another --seed, or leave it out"));
            } else {
                runs.push(run);
            }
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    let weights: Vec<f32> =
        files.iter().map(|(_, bake)| own_runs(&bake.about).iter().map(|[_, paths]| *paths as f32).sum()).collect();
    let mean = mean(files, &weights);
    let mean =
        mean.ok_or_else(|| vec![FileError::new(first_path, "has no place that all others have too", "leave it out")])?;
    let total: f32 = weights.iter().sum();
    let squared = |(weight, (_, bake)): (&f32, &(PathBuf, Bake))| {
        bake.about.noise.map(|noise| (f64::from(*weight) * noise / f64::from(total)).powi(2))
    };
    let noise = weights.iter().zip(files).map(squared).sum::<Option<f64>>().map(f64::sqrt);
    let mut origin = first.about.origin.clone();
    let paths: u32 = runs.iter().map(|[_, paths]| *paths).fold(0, u32::saturating_add);
    origin.settings.insert("paths".into(), paths.to_string());
    Ok(Bake { about: About { origin, noise, runs }, prepared: mean })
}

/// Seeds and paths of the runs of a bake.
fn own_runs(about: &About) -> Vec<[u32; 2]> {
    if !about.runs.is_empty() {
        return about.runs.clone();
    }
    let number = |key: &str| about.origin.settings.get(key).and_then(|text| text.parse().ok()).unwrap_or(0);
    vec![[number("seed"), number("paths")]]
}

fn mean(files: &[(PathBuf, Bake)], weights: &[f32]) -> Option<crate::lighting::Prepared> {
    /// Bits of position and normal.
    type Name = [u32; 6];
    let bakes: Vec<_> = files.iter().map(|(_, bake)| &bake.prepared).collect();
    let directions = baked_directions(bakes[0])?;
    let numbers = 3 * directions.len();
    let name = |bake: usize, place: usize| -> Name {
        let of = |array| bakes[bake].vector(array, place).to_array().map(f32::to_bits);
        let ([a, b, c], [d, e, f]) = (of("positions"), of("normals"));
        [a, b, c, d, e, f]
    };
    let count = |bake: usize| bakes[bake].floats("positions").len() / 3;
    let places: Vec<HashMap<Name, usize>> =
        (0..bakes.len()).map(|bake| (0..count(bake)).map(|place| (name(bake, place), place)).collect()).collect();
    let kept: Vec<Vec<usize>> = (0..count(0))
        .filter_map(|place| places.iter().map(|known| known.get(&name(0, place)).copied()).collect())
        .collect();
    if kept.is_empty() {
        return None;
    }
    let total: f32 = weights.iter().sum();
    let mut groups = Vec::new();
    for group in GROUPS {
        let scales = bakes.iter().map(|bake| bake.floats(&format!("{group} scale")).first().copied().unwrap_or(0.0));
        let scales: Vec<f32> = scales.collect();
        let scale = scales.iter().copied().fold(0.0, f32::max);
        if scale <= 0.0 {
            continue;
        }
        let halves: Vec<&[f16]> = bakes.iter().map(|bake| bake.halves(group)).collect();
        let mut light = Vec::with_capacity(kept.len() * numbers);
        for at in &kept {
            for i in 0..numbers {
                let of = |(bake, place): (usize, &usize)| {
                    let half = halves[bake].get(place * numbers + i).copied().unwrap_or_default();
                    weights[bake] / total * (scales[bake] / scale) * half.to_f32()
                };
                light.push(f16::from_f32(at.iter().enumerate().map(of).sum()));
            }
        }
        groups.push(Group { name: group, light, scale });
    }
    let of = |array: &str| -> Vec<Vec3> { kept.iter().map(|at| bakes[0].vector(array, at[0])).collect() };
    let area = bakes[0].floats("grid").get(4).copied().unwrap_or(1.0);
    Some(ordered(&of("positions"), &of("normals"), &groups, &directions, f64::from(area)))
}
