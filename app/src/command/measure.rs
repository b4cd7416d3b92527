//! `burnish measure`: how far the classical method is from the integrals it stands for.

use std::io::Write;
use std::path::PathBuf;
use std::sync::Arc;

use burnish_core::lighting::classical::exact::Texels;
use burnish_core::lighting::classical::{self, PARAMS};
use burnish_core::material::Material;
use burnish_core::math::cube;
use burnish_core::math::sampling::Random;
use burnish_core::param::Settings;
use burnish_core::scene::gallery::{self, shape};
use burnish_core::scene::{Camera, Environment, Instance, Projection, Scene};
use burnish_core::surface::ggx::Masking;
use burnish_render::readback::read_texture;
use burnish_render::{Gpu, Renderer, View};
use glam::{Affine3A, DVec3, UVec2, Vec2, Vec3};
use half::f16;
use rayon::prelude::*;
use serde::Serialize;

use super::write_json;
use crate::failure::{Exit, Failure};
use crate::source;

/// Pixels whose normal is nearly perpendicular to the view are left out: there the tessellated ball is not round.
const COS_MIN: f32 = 0.05;

#[derive(clap::Args)]
pub struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(clap::Subcommand)]
enum What {
    /// Each level of the prefiltered map against the integral it stands for, N = V = R
    Prefilter(Levels),
    /// The method on a ball with F = 1 against the exact GGX integral
    Classical(Ball),
}

#[derive(clap::Args)]
struct Maps {
    /// Environment map, .hdr or .exr; repeatable [default: the studio]
    #[arg(long, value_name = "FILE")]
    env: Vec<PathBuf>,
    /// Write JSON
    #[arg(long)]
    json: bool,
}

#[derive(clap::Args)]
struct Levels {
    #[command(flatten)]
    maps: Maps,
    /// Texels of each level that are compared, drawn with a fixed seed; all where a level has fewer
    #[arg(long, default_value_t = 400, value_parser = clap::value_parser!(u32).range(1..))]
    texels: u32,
}

#[derive(clap::Args)]
struct Ball {
    #[command(flatten)]
    maps: Maps,
    /// Values of the setting `samples`
    #[arg(long, value_delimiter = ',', default_values_t = [0, 16, 64, 256], value_parser = clap::value_parser!(u32).range(0..=1024))]
    samples: Vec<u32>,
    /// Roughnesses, above 0 to 1
    #[arg(long, value_delimiter = ',', default_values_t = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0])]
    roughness: Vec<f32>,
    /// Pixels across the picture of the ball
    #[arg(long, default_value_t = 32, value_parser = clap::value_parser!(u32).range(8..=256))]
    pixels: u32,
}

/// A figure of the tables.
#[derive(Serialize)]
struct Row {
    environment: String,
    roughness: f32,
    /// Absent for prefiltered levels.
    #[serde(skip_serializing_if = "Option::is_none")]
    samples: Option<u32>,
    /// Mean of |a - b| over mean of b.
    error: f64,
}

pub fn run(args: Args, out: &mut dyn Write) -> Result<Exit, Failure> {
    let (maps, rows) = match &args.what {
        What::Prefilter(levels) => {
            (&levels.maps, measure(&levels.maps, |gpu, environment| prefilter(gpu, environment, levels.texels))?)
        }
        What::Classical(ball) => {
            (&ball.maps, measure(&ball.maps, |gpu, environment| classical_ball(gpu, environment, ball))?)
        }
    };
    if maps.json {
        write_json(out, &rows)?;
    } else {
        write_table(out, &rows)?;
    }
    Ok(Exit::Ok)
}

fn measure(
    maps: &Maps,
    mut of_one: impl FnMut(&Gpu, &Arc<Environment>) -> Result<Vec<Row>, Failure>,
) -> Result<Vec<Row>, Failure> {
    let mut environments = Vec::new();
    for file in &maps.env {
        environments.push(source::environment(file)?.environment);
    }
    if environments.is_empty() {
        environments.push(Arc::new(gallery::studio()));
    }
    let gpu = Gpu::new().map_err(Failure::resources)?;
    let mut rows = Vec::new();
    for environment in &environments {
        rows.extend(of_one(&gpu, environment)?);
    }
    Ok(rows)
}

/// A roughness a line, the settings across.
fn write_table(out: &mut dyn Write, rows: &[Row]) -> Result<(), Failure> {
    let mut environment = "";
    for line in rows.chunk_by(|a, b| a.environment == b.environment && a.roughness == b.roughness) {
        if line[0].environment != environment {
            environment = &line[0].environment;
            writeln!(out, "{environment}: mean |a - b| / mean b")?;
            let heads = line.iter().map(|row| row.samples.map_or("error".into(), |n| format!("{n} samples")));
            writeln!(out, "roughness{}", heads.map(|h| format!("{h:>14}")).collect::<String>())?;
        }
        let figures = line.iter().map(|row| format!("{:>12.2} %", 100.0 * row.error));
        writeln!(out, "{:>9.3}{}", line[0].roughness, figures.collect::<String>())?;
    }
    Ok(())
}

/// Mean of |a - b| over mean of b, over all channels.
fn relative_error(pairs: &[(DVec3, DVec3)]) -> f64 {
    let difference: f64 = pairs.iter().map(|(a, b)| (*a - *b).abs().element_sum()).sum();
    let total: f64 = pairs.iter().map(|(_, b)| b.element_sum()).sum();
    difference / total.max(1e-300)
}

/// A metal with F = 1.
fn white(roughness: f32) -> Material {
    Material { name: "white".into(), metallic: 1.0, roughness, base_color: Vec3::ONE, ..Material::default() }
}

/// A white ball of radius 1 at the origin, alone, with every setting that the exact integral leaves out turned off.
fn ball(environment: &Arc<Environment>, roughness: f32) -> Scene {
    Scene {
        name: "ball".into(),
        meshes: vec![shape::sphere(1.0, 256).into()],
        instances: vec![Instance {
            name: "ball".into(),
            mesh: 0,
            material: 0,
            world_from_local: Affine3A::IDENTITY,
            visible: true,
        }],
        materials: vec![white(roughness)],
        environment: Some(environment.clone()),
        ..Scene::default()
    }
}

fn prefilter(gpu: &Gpu, environment: &Arc<Environment>, compared_texels: u32) -> Result<Vec<Row>, Failure> {
    let renderer = Renderer::new(gpu, &ball(environment, 1.0)).map_err(Failure::resources)?;
    let maps = renderer.environment_maps();
    let texels = Texels::new(environment);
    let levels = maps.prefiltered.mip_level_count();
    let mut rows = Vec::new();
    for level in 1..levels {
        let roughness = classical::roughness(level as f32, levels as f32);
        let size = maps.prefiltered.width() >> level;
        let mut faces = Vec::new();
        for face in 0..6 {
            faces.push(read_texture(gpu, &maps.prefiltered, level, face).map_err(Failure::resources)?);
        }
        let pairs: Vec<_> = compared(size, compared_texels)
            .into_par_iter()
            .map(|(face, x, y)| {
                let direction = texel_direction(face, x, y, size);
                let exact = texels.prefiltered(direction, roughness * roughness);
                (half_texel(&faces[face], (y * size + x) as usize) * f64::from(maps.scale), exact)
            })
            .collect();
        let error = relative_error(&pairs);
        rows.push(Row { environment: environment.name.clone(), roughness, samples: None, error });
    }
    Ok(rows)
}

/// Face, column and row of the texels that are compared: all of a small level, some of a large one.
fn compared(size: u32, limit: u32) -> Vec<(usize, u32, u32)> {
    let (all, limit) = (6 * (size * size) as usize, limit as usize);
    let mut random = Random::new(1);
    let mut pick = |index: usize| match all <= limit {
        true => index,
        false => (random.unit() * all as f32) as usize,
    };
    (0..all.min(limit))
        .map(|index| {
            let texel = pick(index).min(all - 1) as u32;
            ((texel / (size * size)) as usize, texel % size, texel / size % size)
        })
        .collect()
}

fn half_texel(bytes: &[u8], index: usize) -> DVec3 {
    let channel = |c: usize| {
        let at = 8 * index + 2 * c;
        f64::from(f16::from_le_bytes([bytes[at], bytes[at + 1]]))
    };
    DVec3::new(channel(0), channel(1), channel(2))
}

/// Direction of a texel's centre in the environment's own frame: cube maps are left-handed, z is mirrored.
fn texel_direction(face: usize, x: u32, y: u32, size: u32) -> Vec3 {
    let p = (Vec2::new(x as f32, y as f32) + 0.5) / size as f32 * 2.0 - 1.0;
    cube::direction(face as u32, p) * Vec3::new(1.0, 1.0, -1.0)
}

fn classical_ball(gpu: &Gpu, environment: &Arc<Environment>, args: &Ball) -> Result<Vec<Row>, Failure> {
    if let Some(bad) = args.roughness.iter().find(|r| !(**r > 0.0 && **r <= 1.0)) {
        return Err(Failure::usage(format!("--roughness {bad}: it must be above 0 and at most 1")));
    }
    let camera = Camera::look_at("ball", Vec3::new(0.0, 0.5, 4.0), Vec3::ZERO, 0.55);
    let hits = ball_hits(&camera, args.pixels);
    let texels = Texels::new(environment);
    let mut renderer = Renderer::new(gpu, &ball(environment, 1.0)).map_err(Failure::resources)?;
    let mut rows = Vec::new();
    for &roughness in &args.roughness {
        renderer.set_materials(&[white(roughness)]).map_err(Failure::resources)?;
        let alpha = roughness * roughness;
        let exact: Vec<_> = hits
            .par_iter()
            .map(|hit| texels.reflected(hit.normal, hit.to_viewer, alpha, Masking::Correlated))
            .collect();
        for &samples in &args.samples {
            let view = View {
                size: UVec2::splat(args.pixels),
                camera: camera.clone(),
                settings: single_scattering(samples)?,
                jitter_frames: 1,
            };
            let picture = renderer.render(&view).map_err(Failure::resources)?;
            let shown = hits.iter().map(|hit| picture.texels[hit.pixel].truncate().as_dvec3());
            let error = relative_error(&shown.zip(exact.iter().copied()).collect::<Vec<_>>());
            rows.push(Row { environment: environment.name.clone(), roughness, samples: Some(samples), error });
        }
    }
    Ok(rows)
}

fn single_scattering(samples: u32) -> Result<Settings, Failure> {
    let mut settings = Settings::new(PARAMS);
    settings.set("samples", &samples.to_string()).map_err(Failure::usage)?;
    settings.set("multiple-scattering", "off").map_err(Failure::usage)?;
    Ok(settings)
}

/// A pixel whose centre sees the ball.
struct Hit {
    pixel: usize,
    normal: Vec3,
    to_viewer: Vec3,
}

/// Pixel centres of a square picture against the unit ball at the origin.
fn ball_hits(camera: &Camera, pixels: u32) -> Vec<Hit> {
    let Projection::Perspective { yfov, .. } = camera.projection else { return Vec::new() };
    let eye = Vec3::from(camera.world_from_view.translation);
    let half = (0.5 * yfov).tan();
    let mut hits = Vec::new();
    for y in 0..pixels {
        for x in 0..pixels {
            let at = |i: u32| ((i as f32 + 0.5) / pixels as f32 * 2.0 - 1.0) * half;
            let ray = camera.world_from_view.transform_vector3(Vec3::new(at(x), -at(y), -1.0)).normalize();
            let toward = eye.dot(ray);
            let discriminant = toward * toward - eye.length_squared() + 1.0;
            if discriminant <= 0.0 {
                continue;
            }
            let normal = (eye + ray * (-toward - discriminant.sqrt())).normalize();
            if -ray.dot(normal) > COS_MIN {
                hits.push(Hit { pixel: (y * pixels + x) as usize, normal, to_viewer: -ray });
            }
        }
    }
    hits
}
