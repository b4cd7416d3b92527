//! MTL materials.
//!
//! MTL is older than physical materials; what is read, and as what:
//!
//! | MTL | material |
//! |---|---|
//! | `Kd`, `map_Kd` | base colour |
//! | `Pr`, `map_Pr` | roughness |
//! | `Ns` | exponent; without `Pr` the roughness too, by `alpha = sqrt(2 / (Ns + 2))`, the GGX width of the same peak |
//! | `Pm`, `map_Pm` | metallic, otherwise 0 |
//! | `Ks`, `map_Ks` | tint and weight of the dielectric reflection (its F0 stays that of the index) |
//! | `Ni` | index of refraction, when 1 or more |
//! | `Ke`, `map_Ke` | emission |
//! | `d`, `Tr`, `map_d` equal to `map_Kd` | opacity |
//! | `norm` | normal texture; `map_Bump` and `bump` are heights and are left out |
//! | `Pc`, `Pcr` | clear coat |

use std::collections::HashMap;
use std::sync::Arc;

use glam::{Mat3, Vec3};

use crate::import::budget::Meter;
use crate::import::picture::Encoded;
use crate::import::report::Report;
use crate::import::resolve::quoted;
use crate::import::{Resolver, SharedImage};
use crate::material::{AlphaMode, Filter, Material, Sampler, TextureRef, Wrap};
use crate::scene::{Image, Texels};
use crate::surface::blinn_phong;

/// Name of the material of faces without one.
pub(super) const DEFAULT_NAME: &str = "default";

/// A grey, half rough dielectric for faces without a material.
pub(super) fn default() -> Material {
    Material {
        name: DEFAULT_NAME.into(),
        base_color: Vec3::splat(0.8),
        roughness: 0.5,
        double_sided: true,
        ..Material::default()
    }
}

type Library = (Vec<tobj::Material>, HashMap<String, usize>);

/// Reads a material library; one that cannot be had is a notice and empty.
pub(super) fn library(name: &str, resolver: &dyn Resolver, meter: &mut Meter, report: &mut Report) -> Library {
    let at = format!("mtllib {}", quoted(name));
    let bytes = match read(name, resolver, meter) {
        Ok(bytes) => bytes,
        Err(cause) => {
            report.notice(at, format!("the materials are left out: {cause}"));
            return Library::default();
        }
    };
    let text = checked(&String::from_utf8_lossy(&bytes), &at, report);
    tobj::load_mtl_buf(&mut text.as_bytes()).unwrap_or_else(|error| {
        report.notice(at, format!("the materials are left out: {error}"));
        Library::default()
    })
}

/// Paths of OBJ and MTL are plain text, those of the resolver percent-encoded.
fn read(path: &str, resolver: &dyn Resolver, meter: &mut Meter) -> Result<Vec<u8>, crate::import::Cause> {
    let bytes = resolver.read(&path.replace('%', "%25"), meter.bytes_left())?;
    meter.take_bytes(bytes.len() as u64)?;
    Ok(bytes)
}

/// The statements whose numbers are sound; others are left out with a notice.
fn checked(source: &str, at: &str, report: &mut Report) -> String {
    let mut text = String::with_capacity(source.len());
    for (number, line) in source.lines().enumerate() {
        let line = line.trim();
        let mut words = line.split_whitespace();
        let keyword = words.next().unwrap_or("");
        let needed = match keyword {
            "Ka" | "Kd" | "Ks" | "Ke" => 3,
            "Ns" | "Ni" | "d" | "illum" => 1,
            _ => 0,
        };
        let values: Vec<&str> = words.take(needed).collect();
        let number_of = |word: &&str| match keyword {
            "illum" => word.parse::<u8>().is_ok(),
            _ => word.parse::<f32>().is_ok_and(f32::is_finite),
        };
        let sound = match keyword {
            "newmtl" => line.len() > "newmtl".len(),
            _ if keyword.starts_with("map_") || keyword == "bump" => line.len() > keyword.len(),
            // A colour may be one number for all three channels.
            _ if needed == 3 && values.len() == 1 && values.iter().all(number_of) => {
                text.push_str(&format!("{keyword} {0} {0} {0}\n", values[0]));
                continue;
            }
            _ => values.len() == needed && values.iter().all(number_of),
        };
        if sound {
            text.push_str(line);
            text.push('\n');
        } else {
            report.notice(at, format!("line {} {} was left out: its values are not sound", number + 1, quoted(line)));
        }
    }
    text
}

/// The materials of the scene with their images.
pub(super) struct Read {
    pub materials: Vec<Material>,
    pub images: Vec<SharedImage>,
}

/// Turns MTL materials into ours, with their textures.
pub(super) fn read_all(
    list: &[tobj::Material],
    resolver: &dyn Resolver,
    meter: &mut Meter,
    report: &mut Report,
) -> Read {
    let mut textures = Textures { resolver, meter, images: Vec::new(), places: HashMap::new() };
    let materials = list.iter().map(|mtl| convert(mtl, &mut textures, report)).collect();
    Read { materials, images: textures.images }
}

fn convert(mtl: &tobj::Material, textures: &mut Textures<'_>, report: &mut Report) -> Material {
    let at = format!("material {}", quoted(&mtl.name));
    let extra = |key: &str| mtl.unknown_param.get(key).map(String::as_str);
    let number = |key: &str| extra(key)?.split_whitespace().next()?.parse::<f32>().ok().filter(|v| v.is_finite());
    let color = |c: [f32; 3]| Vec3::from(c).max(Vec3::ZERO);

    let specular = color(mtl.specular.unwrap_or([1.0; 3]));
    let weight = specular.max_element();
    let exponent = mtl.shininess.unwrap_or(0.0).max(0.0);
    let opacity = mtl.dissolve.or(number("Tr").map(|t| 1.0 - t)).unwrap_or(1.0).clamp(0.0, 1.0);
    let mut m = Material {
        name: mtl.name.clone(),
        base_color: color(mtl.diffuse.unwrap_or([1.0; 3])).min(Vec3::ONE),
        opacity,
        metallic: number("Pm").unwrap_or(0.0).clamp(0.0, 1.0),
        // roughness = sqrt(alpha)
        roughness: number("Pr").unwrap_or(blinn_phong::alpha(exponent).sqrt()).clamp(0.0, 1.0),
        exponent: blinn_phong::clamp_exponent(exponent),
        emission: mtl.emissive.map_or(Vec3::ZERO, color),
        ior: mtl.optical_density.filter(|n| *n >= 1.0).unwrap_or(1.5),
        specular: weight.min(1.0),
        specular_color: if weight > 0.0 { specular / weight } else { Vec3::ONE },
        coat: number("Pc").unwrap_or(0.0).clamp(0.0, 1.0),
        coat_roughness: number("Pcr").unwrap_or(0.0).clamp(0.0, 1.0),
        double_sided: true,
        ..Material::default()
    };
    textured(mtl, &mut m, &at, textures, report);
    m
}

/// Adds the textures and what follows from them.
fn textured(mtl: &tobj::Material, m: &mut Material, at: &str, textures: &mut Textures<'_>, report: &mut Report) {
    let extra = |key: &str| mtl.unknown_param.get(key).map(String::as_str);
    m.base_color_texture = mtl.diffuse_texture.as_deref().and_then(|t| textures.get(t, at, report));
    m.specular_color_texture = mtl.specular_texture.as_deref().and_then(|t| textures.get(t, at, report));
    m.emission_texture = extra("map_Ke").and_then(|t| textures.get(t, at, report));
    if m.emission_texture.is_some() && mtl.emissive.is_none() {
        m.emission = Vec3::ONE;
    }
    m.normal_texture = extra("norm").and_then(|t| textures.get(t, at, report));
    m.metallic_roughness_texture = textures.packed(extra("map_Pr"), extra("map_Pm"), at, report);
    if m.metallic_roughness_texture.is_some() {
        // A texture replaces its number, of which exporters leave the default.
        m.roughness = if extra("map_Pr").is_some() { 1.0 } else { m.roughness };
        m.metallic = if extra("map_Pm").is_some() { 1.0 } else { m.metallic };
    }
    let cutout = mtl.dissolve_texture.is_some() && mtl.dissolve_texture == mtl.diffuse_texture;
    if cutout || m.opacity < 1.0 {
        m.alpha_mode = AlphaMode::Blend;
    }
    if mtl.dissolve_texture.is_some() && !cutout {
        report.notice(at, "map_d is read only where it is the picture of map_Kd; it is left out");
    }
    if mtl.normal_texture.is_some() {
        report.notice(at, "bump (height) textures are left out; `norm` names a normal texture");
    }
    if mtl.shininess_texture.is_some() {
        report.notice(at, "map_Ns is left out; `map_Pr` names a roughness texture");
    }
}

/// Images by the path that names them, each read once.
struct Textures<'a> {
    resolver: &'a dyn Resolver,
    meter: &'a mut Meter,
    images: Vec<SharedImage>,
    places: HashMap<String, Option<usize>>,
}

impl Textures<'_> {
    fn get(&mut self, statement: &str, at: &str, report: &mut Report) -> Option<TextureRef> {
        Some(reference(self.image(statement, at, report)?))
    }

    /// Index of the image that a map statement names after its options; a notice when it cannot be read.
    fn image(&mut self, statement: &str, at: &str, report: &mut Report) -> Option<usize> {
        let path = path(statement);
        if let Some(place) = self.places.get(path) {
            return *place;
        }
        let name = quoted(path);
        let decoded = read(path, self.resolver, self.meter)
            .and_then(|bytes| Encoded::open(bytes, name.clone(), self.meter))
            .and_then(|encoded| encoded.decode());
        let place = match decoded {
            Ok(image) => {
                self.images.push(image.into());
                Some(self.images.len() - 1)
            }
            Err(cause) => {
                report.notice(at, format!("texture {name} is left out: {cause}"));
                None
            }
        };
        self.places.insert(path.to_string(), place);
        place
    }

    /// Roughness and metallic pictures as one: roughness in green, metallic in blue.
    fn packed(
        &mut self,
        roughness: Option<&str>,
        metallic: Option<&str>,
        at: &str,
        report: &mut Report,
    ) -> Option<TextureRef> {
        let roughness = roughness.and_then(|t| self.image(t, at, report));
        let mut metallic = metallic.and_then(|t| self.image(t, at, report));
        let get = |i: Option<usize>| i.map(|i| Arc::clone(&self.images[i]));
        if let (Some(r), Some(m)) = (get(roughness), get(metallic))
            && (r.width, r.height) != (m.width, m.height)
        {
            report.notice(at, "map_Pm is left out: its size differs from that of map_Pr");
            metallic = None;
        }
        let size = get(roughness.or(metallic))?;
        if let Err(cause) = self.meter.take_pixels(size.width.into(), size.height.into()) {
            report.notice(at, format!("map_Pr and map_Pm are left out: {cause}"));
            return None;
        }
        let (r, m) = (get(roughness), get(metallic));
        let count = size.width as usize * size.height as usize;
        let texels = (0..count).flat_map(|i| [255, red(r.as_deref(), i), red(m.as_deref(), i), 255]).collect();
        let name = format!("{at}: roughness and metallic");
        let (width, height) = (size.width, size.height);
        self.images.push(Image { name, width, height, texels: Texels::Unorm8(texels) }.into());
        Some(reference(self.images.len() - 1))
    }
}

/// First channel of a texel in 8 bits; full where there is no image.
fn red(image: Option<&Image>, texel: usize) -> u8 {
    match image.map(|i| &i.texels) {
        Some(Texels::Unorm8(texels)) => texels.get(4 * texel).copied().unwrap_or(255),
        Some(Texels::Unorm16(texels)) => texels.get(4 * texel).map_or(255, |t| (t >> 8) as u8),
        None => 255,
    }
}

fn reference(image: usize) -> TextureRef {
    let sampler = Sampler {
        wrap_u: Wrap::Repeat,
        wrap_v: Wrap::Repeat,
        magnify: Filter::Linear,
        minify: Filter::Linear,
        mip: Some(Filter::Linear),
    };
    TextureRef { image, sampler, uv_set: 0, transform: Mat3::IDENTITY }
}

/// The path of a map statement such as `-bm 0.3 -o 0 0 0 folder/a b.png`. Options have numbers or a word as arguments;
/// the path is the rest and may contain spaces.
fn path(statement: &str) -> &str {
    let mut rest = statement.trim();
    while let Some(option) = rest.split_whitespace().next().filter(|word| word.starts_with('-')) {
        rest = rest[option.len()..].trim_start();
        let words = matches!(option, "-blendu" | "-blendv" | "-cc" | "-clamp" | "-imfchan" | "-type");
        let mut arguments = if words { 1 } else { 3 };
        while arguments > 0 {
            let Some(word) = rest.split_whitespace().next() else { break };
            if !words && word.parse::<f32>().is_err() {
                break;
            }
            rest = rest[word.len()..].trim_start();
            arguments -= 1;
        }
    }
    rest
}
