//! `burnish info`: what a scene consists of.

use std::io::Write;

use burnish_core::document::Missing;
use burnish_core::material::{AlphaMode, Material, Reflectance, TextureRole};
use burnish_core::scene::{Camera, Light, Projection, Scene, Texels};
use burnish_core::surface::micro_normal;
use serde::Serialize;

use super::{spaced, write_json};
use crate::failure::{Exit, Failure, printable};
use crate::source::{Opened, SceneArg};

#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArg,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

pub fn run(args: Args, out: &mut dyn Write) -> Result<Exit, Failure> {
    let info = Info::of(&args.scene.open()?);
    if args.json {
        write_json(out, &info)?;
    } else {
        info.write(out)?;
    }
    Ok(Exit::Ok)
}

/// Lengths in metres, angles in degrees, colours linear Rec.709.
#[derive(Serialize)]
struct Info {
    name: String,
    /// Least and greatest corner; absent for an empty scene.
    bounds: Option<[[f32; 3]; 2]>,
    meshes: usize,
    instances: usize,
    triangles: usize,
    materials: Vec<MaterialInfo>,
    lights: Vec<LightInfo>,
    cameras: Vec<CameraInfo>,
    images: Vec<ImageInfo>,
    environment: Option<EnvironmentInfo>,
    notices: Vec<String>,
}

#[derive(Serialize)]
struct MaterialInfo {
    name: String,
    base_color: [f32; 3],
    opacity: f32,
    metallic: f32,
    roughness: f32,
    reflection_model: &'static str,
    /// Of Blinn-Phong.
    exponent: f32,
    emission: [f32; 3],
    ior: f32,
    specular: f32,
    specular_color: [f32; 3],
    coat: f32,
    coat_roughness: f32,
    anisotropy: f32,
    /// Degrees counter-clockwise from the tangent.
    anisotropy_rotation: f32,
    /// Bumps of the finish: their kind, their size in millimetres, their slope.
    micro_normal: &'static str,
    micro_size_mm: f32,
    micro_depth: f32,
    /// Preset of the metal, where one is set.
    preset: Option<String>,
    alpha_mode: &'static str,
    double_sided: bool,
    unlit: bool,
    textures: Vec<TextureInfo>,
}

#[derive(Serialize)]
struct TextureInfo {
    role: &'static str,
    image: usize,
    uv_set: u8,
}

#[derive(Serialize)]
struct LightInfo {
    name: String,
    kind: &'static str,
    /// cd, or lx for a directional light, times colour.
    intensity: [f32; 3],
}

#[derive(Serialize)]
struct CameraInfo {
    name: String,
    eye: [f32; 3],
    /// Unit direction of view.
    direction: [f32; 3],
    /// Full vertical angle; absent for an orthographic camera.
    vertical_angle: Option<f32>,
}

#[derive(Serialize)]
struct ImageInfo {
    name: String,
    width: u32,
    height: u32,
    bits: u32,
}

#[derive(Serialize)]
struct EnvironmentInfo {
    name: String,
    width: u32,
    height: u32,
}

impl Info {
    fn of(opened: &Opened) -> Info {
        let Scene {
            name,
            meshes,
            instances,
            materials,
            images,
            lights,
            cameras,
            environment,
            background: _,
            subject: _,
            probes: _,
        } = &opened.scene;
        let bounds = opened.scene.bounds();
        Info {
            name: name.clone(),
            bounds: (!bounds.is_empty()).then(|| [bounds.min.to_array(), bounds.max.to_array()]),
            meshes: meshes.len(),
            instances: instances.len(),
            triangles: opened.scene.triangle_count(),
            materials: materials.iter().map(MaterialInfo::of).collect(),
            lights: lights.iter().map(LightInfo::of).collect(),
            cameras: cameras.iter().map(CameraInfo::of).collect(),
            images: images
                .iter()
                .map(|image| ImageInfo {
                    name: image.name.clone(),
                    width: image.width,
                    height: image.height,
                    bits: match image.texels {
                        Texels::Unorm8(_) => 8,
                        Texels::Unorm16(_) => 16,
                    },
                })
                .collect(),
            environment: environment.as_ref().map(|e| EnvironmentInfo {
                name: e.name.clone(),
                width: e.width,
                height: e.height,
            }),
            notices: opened.notices.iter().cloned().chain(opened.missing.iter().map(missing)).collect(),
        }
    }

    fn write(&self, out: &mut dyn Write) -> Result<(), Failure> {
        writeln!(out, "name         {}", printable(&self.name))?;
        match self.bounds {
            Some([min, max]) => writeln!(out, "bounds       {} to {} m", spaced(min), spaced(max))?,
            None => writeln!(out, "bounds       empty")?,
        }
        writeln!(out, "meshes       {}", self.meshes)?;
        writeln!(out, "instances    {}", self.instances)?;
        writeln!(out, "triangles    {}", self.triangles)?;
        writeln!(out, "materials    {}", self.materials.len())?;
        for (i, material) in self.materials.iter().enumerate() {
            writeln!(out, "  #{i} {}", printable(&material.line()))?;
        }
        writeln!(out, "lights       {}", self.lights.len())?;
        for (i, light) in self.lights.iter().enumerate() {
            writeln!(out, "  #{i} {}: {}, intensity {}", printable(&light.name), light.kind, spaced(light.intensity))?;
        }
        writeln!(out, "cameras      {}", self.cameras.len())?;
        for (i, camera) in self.cameras.iter().enumerate() {
            let angle = camera.vertical_angle.map_or("orthographic".into(), |a| format!("{} degrees", spaced([a])));
            writeln!(
                out,
                "  #{i} {}: at {} m, looks along {}, {angle}",
                printable(&camera.name),
                spaced(camera.eye),
                spaced(camera.direction)
            )?;
        }
        writeln!(out, "images       {}", self.images.len())?;
        for (i, image) in self.images.iter().enumerate() {
            writeln!(out, "  #{i} {}: {}x{}, {} bits", printable(&image.name), image.width, image.height, image.bits)?;
        }
        match &self.environment {
            Some(e) => writeln!(out, "environment  {}, {}x{}", printable(&e.name), e.width, e.height)?,
            None => writeln!(out, "environment  none")?,
        }
        for notice in &self.notices {
            writeln!(out, "notice       {}", printable(notice))?;
        }
        Ok(())
    }
}

fn missing(file: &Missing) -> String {
    format!("{} is missing and something stands in for it: {}", file.path, file.reason)
}

impl MaterialInfo {
    fn of(material: &Material) -> MaterialInfo {
        MaterialInfo {
            name: material.name.clone(),
            base_color: material.base_color.to_array(),
            opacity: material.opacity,
            metallic: material.metallic,
            roughness: material.roughness,
            reflection_model: material.reflection_model.id(),
            exponent: material.exponent,
            emission: material.emission.to_array(),
            ior: material.ior,
            specular: material.specular,
            specular_color: material.specular_color.to_array(),
            coat: material.coat,
            coat_roughness: material.coat_roughness,
            anisotropy: material.anisotropy,
            anisotropy_rotation: material.anisotropy_rotation.to_degrees(),
            micro_normal: micro_normal::Kind::IDS[material.micro_normal as usize],
            micro_size_mm: material.micro_size_mm,
            micro_depth: material.micro_depth,
            preset: match &material.reflectance {
                Reflectance::BaseColor => None,
                Reflectance::Preset { id, .. } => Some(id.clone()),
            },
            alpha_mode: match material.alpha_mode {
                AlphaMode::Opaque => "opaque",
                AlphaMode::Mask { .. } => "mask",
                AlphaMode::Blend => "blend",
            },
            double_sided: material.double_sided,
            unlit: material.unlit,
            textures: TextureRole::ALL
                .into_iter()
                .zip(material.textures())
                .filter_map(|(role, texture)| {
                    texture.map(|t| TextureInfo { role: role.name(), image: t.image, uv_set: t.uv_set })
                })
                .collect(),
        }
    }

    /// Main factors, then what differs from a plain opaque material, then textures.
    fn line(&self) -> String {
        let mut parts = vec![match &self.preset {
            Some(id) => format!("preset {id}"),
            None => format!("base color {}, metallic {}", spaced(self.base_color), self.metallic),
        }];
        parts.push(match self.reflection_model {
            "ggx" => format!("roughness {}", self.roughness),
            model => format!("{model} with exponent {}", self.exponent),
        });
        let numbers = [
            ("opacity", self.opacity, 1.0),
            ("ior", self.ior, 1.5),
            ("specular", self.specular, 1.0),
            ("coat", self.coat, 0.0),
            ("coat roughness", self.coat_roughness, 0.0),
            ("anisotropy", self.anisotropy, 0.0),
            ("anisotropy rotation in degrees", self.anisotropy_rotation, 0.0),
        ];
        parts.extend(numbers.iter().filter(|(_, v, plain)| v != plain).map(|(key, v, _)| format!("{key} {v}")));
        if self.micro_normal != "none" && self.micro_depth > 0.0 {
            parts.push(format!("{} bumps of {} mm, depth {}", self.micro_normal, self.micro_size_mm, self.micro_depth));
        }
        if self.specular_color != [1.0; 3] {
            parts.push(format!("specular color {}", spaced(self.specular_color)));
        }
        if self.emission != [0.0; 3] {
            parts.push(format!("emission {}", spaced(self.emission)));
        }
        let words = [(self.alpha_mode, self.alpha_mode != "opaque"), ("double-sided", self.double_sided)];
        let words = words.into_iter().chain([("unlit", self.unlit)]);
        parts.extend(words.filter(|(_, is)| *is).map(|(word, _)| word.into()));
        parts.extend(self.textures.iter().map(|t| format!("{} image #{}", t.role, t.image)));
        format!("{}: {}", self.name, parts.join(", "))
    }
}

impl LightInfo {
    fn of(light: &Light) -> LightInfo {
        LightInfo { name: light.name.clone(), kind: light.kind.label(), intensity: light.intensity.to_array() }
    }
}

impl CameraInfo {
    fn of(camera: &Camera) -> CameraInfo {
        CameraInfo {
            name: camera.name.clone(),
            eye: camera.world_from_view.translation.to_array(),
            direction: camera.world_from_view.matrix3.z_axis.to_array().map(|v| -v),
            vertical_angle: match camera.projection {
                Projection::Perspective { yfov, .. } => Some(yfov.to_degrees()),
                Projection::Orthographic { .. } => None,
            },
        }
    }
}
