//! `burnish fresnel-balls`: metals beside one another, one row for each Fresnel form.

use std::io::Write;
use std::path::PathBuf;
use std::sync::Arc;

use burnish_core::color::tone::ToneMap;
use burnish_core::file::write_picture;
use burnish_core::lighting::classical;
use burnish_core::material::preset::{self, Preset};
use burnish_core::material::{Material, Reflectance};
use burnish_core::param::Settings;
use burnish_core::scene::{Camera, Environment, Instance, Scene, gallery};
use burnish_core::surface::fresnel::Form;
use burnish_render::{Gpu, Renderer, View};
use glam::{Affine3A, UVec2, Vec3};

use super::stage::metal_failure;
use crate::failure::{Exit, Failure};
use crate::source;
use crate::value;

/// Distance between the centres of balls of radius 1.
const SPACING: f32 = 2.1;

/// Full vertical angle of the lens, radians: long, so that all balls are seen from the front.
const YFOV: f32 = 0.04;

#[derive(clap::Args)]
pub struct Args {
    /// Picture to write: .png or .exr
    #[arg(long, value_name = "FILE", value_parser = value::picture_path)]
    out: PathBuf,
    /// Metals from left to right; repeatable
    #[arg(long, value_name = "PRESET", default_values = ["Ag", "Au", "Cr", "Fe", "W", "Ti"])]
    metal: Vec<String>,
    /// Fresnel forms from top to bottom; repeatable
    #[arg(long, value_name = "FORM", default_values = ["rescaled", "fitted", "spectral"])]
    form: Vec<Form>,
    /// Environment map, .hdr or .exr [default: a studio]
    #[arg(long, value_name = "FILE", conflicts_with = "even")]
    env: Option<PathBuf>,
    /// Even white light instead: what is seen is the reflectance itself, normal incidence in the middle, grazing at the rim
    #[arg(long)]
    even: bool,
    /// Roughness of the balls, 0 to 1
    #[arg(long, value_name = "R", default_value_t = 0.1, value_parser = value::number(0.0, 1.0))]
    roughness: f32,
    /// Pixels that a ball gets across, 16 to 1024
    #[arg(long, value_name = "N", default_value_t = 200, value_parser = clap::value_parser!(u32).range(16..=1024))]
    ball: u32,
}

pub fn run(args: Args, out: &mut dyn Write) -> Result<Exit, Failure> {
    let find = |id: &String| preset::find(id).map_err(|e| metal_failure(id, e));
    let metals: Vec<Preset> = args.metal.iter().map(find).collect::<Result<_, _>>()?;
    let (columns, rows) = (metals.len() as u32, args.form.len() as u32);
    let size = args.ball * UVec2::new(columns, rows);
    let gpu = Gpu::new().map_err(Failure::resources)?;
    let largest = gpu.device.limits().max_texture_dimension_2d;
    if size.max_element() > largest {
        let text = format!("{columns} x {rows} balls make {} x {} pixels, over {largest}", size.x, size.y);
        return Err(Failure::usage(format!("{text}; take a smaller --ball or fewer metals")));
    }
    let environment = match &args.env {
        Some(file) => source::environment(file)?.environment,
        None if args.even => Arc::new(Environment::new("even", 4, 2, vec![Vec3::ONE; 8])),
        None => Arc::new(gallery::studio()),
    };
    let scene = scene(&metals, &args.form, args.roughness, environment);
    // The picture is as high as the rows of balls.
    let distance = 0.5 * SPACING * rows as f32 / (0.5 * YFOV).tan();
    let camera = Camera::look_at("front", Vec3::new(0.0, 0.0, distance), Vec3::ZERO, YFOV);
    let settings = Settings::new(classical::PARAMS);
    let mut renderer = Renderer::new(&gpu, &scene).map_err(Failure::resources)?;
    let view = View { size, camera, settings, jitter_frames: 16 };
    let picture = renderer.render(&view).map_err(Failure::resources)?;
    write_picture(&picture, &args.out, ToneMap::None, 0.0).map_err(Failure::resources)?;
    let names: Vec<&str> = metals.iter().map(|metal| metal.name.as_str()).collect();
    let forms: Vec<&str> = args.form.iter().map(|form| form.id()).collect();
    writeln!(out, "wrote {}: {}x{} pixels", args.out.display(), size.x, size.y)?;
    writeln!(out, "left to right: {}; top to bottom: {}", names.join(", "), forms.join(", "))?;
    Ok(Exit::Ok)
}

/// A grid of balls of radius 1 in the plane z = 0, about the origin.
fn scene(metals: &[Preset], forms: &[Form], roughness: f32, environment: Arc<Environment>) -> Scene {
    let (mut materials, mut instances) = (Vec::new(), Vec::new());
    let place = |i: usize, count: usize| SPACING * (i as f32 - 0.5 * (count as f32 - 1.0));
    for (row, form) in forms.iter().enumerate() {
        for (column, metal) in metals.iter().enumerate() {
            let fresnel = Arc::new(metal.fresnel(*form));
            let reflectance = Reflectance::Preset { id: metal.id.clone(), fresnel };
            let at = Vec3::new(place(column, metals.len()), -place(row, forms.len()), 0.0);
            instances.push(Instance {
                name: format!("{} {form}", metal.id),
                mesh: 0,
                material: materials.len(),
                world_from_local: Affine3A::from_translation(at),
                visible: true,
            });
            materials.push(Material {
                name: format!("{} {form}", metal.id),
                roughness,
                reflectance,
                ..Material::default()
            });
        }
    }
    Scene {
        name: "fresnel balls".into(),
        meshes: vec![Arc::new(gallery::shape::sphere(1.0, 192))],
        materials,
        instances,
        environment: Some(environment),
        ..Scene::default()
    }
}
