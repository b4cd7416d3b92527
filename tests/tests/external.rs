//! Foreign models, environments and optical constants: every one loads, or is refused for the reason that it should be.
//! Foreign renderers and measures: they agree with ours.
//!
//! The data are not part of the repository. They are looked for as `shared/data` beside it; without them the tests are
//! ignored, and fail when `BURNISH_REQUIRE` names `data`.

#[path = "external/metrics.rs"]
mod metrics;
#[path = "external/oracle/mod.rs"]
mod oracle;
#[path = "external/rays.rs"]
mod rays;

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use burnish_core::import::optical::{self, Unit};
use burnish_core::import::{FolderResolver, ImportOptions, load_environment, load_scene, scene_from_bytes};
use burnish_tests::{Need, data_folder, trial};
use libtest_mimic::{Arguments, Completion, Failed, Trial};

/// Radiance HDR keeps 8 bits of mantissa and readers differ in half a step of it.
const MAX_TOLERANCE: f32 = 0.01;

/// Models that must be refused, and the word that the message must hold.
const REFUSED: &[(&str, &str)] = &[("gltf/Box_Draco.glb", "KHR_draco_mesh_compression")];

/// Models that bring tangents, made by other tools from the texture coordinates that they bring too.
const TANGENTS: &[&str] = &["gltf/FlightHelmet/FlightHelmet.gltf", "gltf/suzanne/02_suzanne.gltf"];

fn main() {
    let mut arguments = Arguments::from_args();
    let mut trials = match data_folder() {
        Some(data) => trials(&data),
        None => vec![trial("models and environments", &[Need::Data], || ())],
    };
    trials.push(metrics::trial_of_metrics());
    trials.extend(oracle::trials());
    // Decoding is parallel within each trial.
    arguments.test_threads.get_or_insert(1);
    libtest_mimic::run(&arguments, trials).exit();
}

fn trials(data: &Path) -> Vec<Trial> {
    let models = data.join("models");
    let counts = table(&models.join("README.md"), 2);
    let maxima = table(&data.join("hdri/README.md"), 5);
    let mut trials = Vec::new();
    trials.push(rays::trial(files(&models, &["gltf", "glb", "obj"])));
    for path in files(&models, &["gltf", "glb", "obj"]) {
        let key = key(&path, &models);
        let triangles = counts.get(&key).cloned();
        trials.push(Trial::test(format!("model {key}"), move || model(&path, &key, triangles.as_deref())));
    }
    for path in files(&data.join("hdri"), &["hdr", "exr"]) {
        let key = key(&path, &data.join("hdri"));
        let max = maxima.get(&key).cloned();
        trials.push(Trial::test(format!("environment {key}"), move || environment(&path, max.as_deref())));
    }
    for name in TANGENTS {
        let path = models.join(name);
        trials.push(Trial::test(format!("tangents {name}"), move || tangents(&path)));
    }
    let found = trials.len();
    trials.extend(optical_constants(&data.join("optical-constants")));
    let listed = counts.len() + maxima.len();
    trials.push(Trial::test("every file of the tables is there", move || {
        if listed > 0 && found >= listed { Ok(()) } else { Err(format!("{found} files, {listed} listed").into()) }
    }));
    trials
}

/// A trial for each table of n and k.
fn optical_constants(folder: &Path) -> Vec<Trial> {
    let tables = files(folder, &["csv"]);
    // The index lists the others.
    let tables = tables.into_iter().filter(|path| !path.ends_with("index.csv"));
    let trials: Vec<Trial> = tables
        .map(|path| {
            let name = format!("optical constants {}", key(&path, folder));
            Trial::test(name, move || same_constants(&path))
        })
        .collect();
    if !trials.is_empty() {
        return trials;
    }
    vec![Trial::ignorable_test("optical constants", || Ok(Completion::ignored_with("no optical constants")))]
}

/// The import holds the numbers of the file, read here in the plainest way.
fn same_constants(path: &Path) -> Result<(), Failed> {
    let imported = optical::read(path, &optical::Options::default())?;
    let text = std::fs::read_to_string(path)?;
    let mut rows = Vec::new();
    for line in text.lines().skip_while(|line| !line.starts_with("wavelength_nm,n,k")).skip(1) {
        let numbers: Result<Vec<f64>, _> = line.split(',').map(str::parse).collect();
        rows.push(numbers?);
    }
    let column = |i: usize| rows.iter().map(|row| row[i]).collect::<Vec<f64>>();
    let (preset, report) = (&imported.preset, &imported.report);
    if (&preset.wavelength_nm, &preset.n, &preset.k) != (&column(0), &column(1), &column(2)) {
        return Err(format!("{:?} {:?} {:?}", preset.wavelength_nm, preset.n, preset.k).into());
    }
    let stem = path.file_stem().unwrap_or_default();
    if preset.id.as_str() != stem || report.unit != Unit::Nanometre || report.points != rows.len() {
        return Err(format!("{} {report:?}", preset.id).into());
    }
    if report.warnings.is_empty() { Ok(()) } else { Err(format!("{:?}", report.warnings).into()) }
}

fn model(path: &Path, key: &str, triangles: Option<&str>) -> Result<(), Failed> {
    let result = load_scene(path, &ImportOptions::default());
    if let Some((_, word)) = REFUSED.iter().find(|(name, _)| *name == key) {
        return match result {
            Err(error) if error.to_string().contains(word) => Ok(()),
            Err(error) => Err(format!("refused for another reason: {error}").into()),
            Ok(_) => Err(format!("was read, but {word} is not supported").into()),
        };
    }
    let imported = result?;
    for notice in &imported.notices {
        println!("{notice}");
    }
    let scene = &imported.scene;
    scene.validate().map_err(|faults| format!("{faults:?}"))?;
    let found: usize = scene.meshes.iter().map(|m| m.indices.len() / 3).sum();
    match triangles {
        // Files without a row in the table have no count to hold them to.
        Some(stated) if stated != found.to_string() => Err(format!("{found} triangles, {stated} expected").into()),
        _ if scene.bounds().radius() > 0.0 => Ok(()),
        _ => Err("the model has no extent".into()),
    }
}

/// Tangents made by us agree with those of the file, corner by corner: the same sign and nearly the same direction.
fn tangents(path: &Path) -> Result<(), Failed> {
    let options = ImportOptions::default();
    let theirs = load_scene(path, &options)?.scene;
    let mut json: serde_json::Value = serde_json::from_slice(&std::fs::read(path)?)?;
    for primitive in json["meshes"].as_array_mut().ok_or("no meshes")?.iter_mut() {
        for primitive in primitive["primitives"].as_array_mut().ok_or("no primitives")? {
            let attributes = primitive["attributes"].as_object_mut().ok_or("no attributes")?;
            attributes.remove("TANGENT").ok_or("no tangents")?;
        }
    }
    let folder = FolderResolver::beside(path)?;
    let ours = scene_from_bytes(json.to_string().as_bytes(), "x.gltf", &folder, &options)?.scene;
    let (mut corners, mut signs, mut near) = (0, 0, 0);
    for (a, b) in theirs.meshes.iter().zip(&ours.meshes) {
        for (i, j) in a.indices.iter().zip(&b.indices) {
            let (a, b) = (a.tangents[*i as usize], b.tangents[*j as usize]);
            corners += 1;
            signs += usize::from(a.w == b.w);
            near += usize::from(a.truncate().dot(b.truncate()) > 0.9);
        }
    }
    println!("{corners} corners, {signs} of the same sign, {near} within 26 degrees");
    // Tools differ in how they weight and split; a wrong convention would leave few.
    if corners > 0 && signs * 100 >= corners * 99 && near * 100 >= corners * 97 {
        return Ok(());
    }
    Err(format!("{corners} corners, {signs} of the same sign, {near} within 26 degrees").into())
}

fn environment(path: &Path, max: Option<&str>) -> Result<(), Failed> {
    let (environment, notices) = load_environment(path)?;
    for notice in &notices {
        println!("{notice}");
    }
    let found = environment.texels.iter().map(|t| t.max_element()).fold(0.0, f32::max);
    if environment.width != 2 * environment.height {
        return Err(format!("{}x{}", environment.width, environment.height).into());
    }
    let max: f32 = max.ok_or("not in the table")?.parse()?;
    if (found - max).abs() <= MAX_TOLERANCE * max {
        return Ok(());
    }
    Err(format!("maximum {found}, expected {max}").into())
}

/// Files with one of the endings, in all subfolders, sorted.
fn files(folder: &Path, endings: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            let ending = path.extension().and_then(|e| e.to_str()).unwrap_or("").to_string();
            match path.is_dir() {
                true => folders.push(path),
                false if endings.contains(&ending.as_str()) => found.push(path),
                false => {}
            }
        }
    }
    found.sort();
    found
}

/// The name by which the tables call a file.
fn key(path: &Path, root: &Path) -> String {
    path.strip_prefix(root).unwrap_or(path).to_string_lossy().replace('\\', "/")
}

/// First column of a Markdown table to the given one, of the rows about files.
fn table(readme: &Path, column: usize) -> HashMap<String, String> {
    let text = std::fs::read_to_string(readme).unwrap_or_default();
    let rows = text.lines().filter_map(|line| {
        let cells: Vec<&str> = line.trim().trim_matches('|').split('|').map(str::trim).collect();
        let name = Path::new(cells.first()?);
        let is_file = ["gltf", "glb", "obj", "hdr", "exr"].contains(&name.extension()?.to_str()?);
        Some((cells[0].to_string(), cells.get(column).filter(|_| is_file)?.to_string()))
    });
    rows.collect()
}
