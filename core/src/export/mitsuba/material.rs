//! Materials as shapes refer to them: opacity, normals and light around a surface model, with what is lost on the way.

use glam::Vec3;

use super::mesh::{Coordinates, Wanted};
use super::texture::{Textures, Use};
use super::xml::Element;
use super::{Options, element_name};
use crate::export::{Folder, Loss};
use crate::file::FileError;
use crate::material::preset::Preset;
use crate::material::{AlphaMode, Filter, Material, Reflectance, TextureRef};
use crate::scene::Scene;
use crate::surface::micro_normal;

/// A material as shapes refer to it.
pub struct Written {
    /// The surface model, with its id.
    pub bsdf: Element,
    /// What makes a shape of it shine.
    pub emitter: Option<Element>,
    /// What it asks of meshes.
    pub wanted: Wanted,
    /// Lets light through somewhere.
    pub transparent: bool,
    /// Nothing is left of it.
    pub hidden: bool,
}

/// One material on its way.
pub(super) struct Writer<'a, 'f> {
    pub(super) material: &'a Material,
    /// For notes.
    element: String,
    pub(super) textures: &'a mut Textures<'f>,
    pub(super) folder: &'a mut Folder<'f>,
    /// The measured metal, where spectra are asked for.
    pub(super) measured: Option<Preset>,
    /// Shapes of it have colours at their vertices.
    colored: bool,
}

/// Writes one material.
pub fn write<'f>(
    scene: &Scene,
    index: usize,
    options: &Options<'_>,
    textures: &mut Textures<'f>,
    folder: &mut Folder<'f>,
) -> Result<Option<Written>, FileError> {
    let Some(material) = scene.materials.get(index) else { return Ok(None) };
    let element = element_name("material", index, &material.name);
    let colored = scene
        .instances
        .iter()
        .filter(|i| i.visible && i.material == index)
        .any(|i| scene.meshes.get(i.mesh).is_some_and(|mesh| !mesh.colors.is_empty()));
    let measured = match &material.reflectance {
        Reflectance::Preset { id, .. } if options.spectral => (options.metal)(id),
        _ => None,
    };
    let mut writer = Writer { material, element, textures, folder, measured, colored };
    writer.tell_what_is_dropped(options);
    let mut bsdf = writer.surface()?;
    if let Some(normal) = writer.used(material.normal_texture) {
        let texture = writer.texture("normalmap", &normal, Use::Normal { scale: material.normal_scale })?;
        bsdf = Element::plugin("bsdf", "normalmap").with(texture).with(bsdf);
    }
    if material.double_sided {
        bsdf = Element::plugin("bsdf", "twosided").with(bsdf);
    }
    let opacity = writer.opacity()?;
    let transparent = matches!(opacity, Opacity::Part(_));
    let hidden = matches!(opacity, Opacity::None);
    if let Opacity::Part(opacity) = opacity {
        bsdf = Element::plugin("bsdf", "mask").with(opacity).with(bsdf);
    }
    let emitter = writer.emitter()?;
    let wanted = writer.wanted();
    Ok(Some(Written { bsdf, emitter, wanted, transparent, hidden }))
}

/// How much of a surface is there.
enum Opacity {
    All,
    None,
    Part(Element),
}

impl Writer<'_, '_> {
    pub(super) fn note(&mut self, loss: Loss, what: impl Into<String>) {
        self.folder.report.note(&self.element, loss, what);
    }

    pub(super) fn texture(&mut self, name: &str, texture: &TextureRef, purpose: Use) -> Result<Element, FileError> {
        let sampler = texture.sampler;
        if sampler.wrap_u != sampler.wrap_v {
            self.note(Loss::Approximated, "a texture wraps down as it does across");
        }
        self.textures.element(name, texture, purpose, self.folder)
    }

    /// Which texture coordinates count: those of the first texture that is written.
    fn set(&self) -> Option<u8> {
        let m = self.material;
        let written = [m.base_color_texture, m.metallic_roughness_texture, m.normal_texture, m.emission_texture];
        written.iter().flatten().map(|texture| texture.uv_set).next()
    }

    /// A texture, unless it needs other coordinates than the rest.
    pub(super) fn used(&mut self, texture: Option<TextureRef>) -> Option<TextureRef> {
        let texture = texture?;
        if self.set() == Some(texture.uv_set) {
            return Some(texture);
        }
        self.note(Loss::Dropped, "a texture on another set of coordinates: a shape of Mitsuba has one");
        None
    }

    /// Coordinates that meshes must have. Without textures they are free to carry the direction of the brushing.
    fn wanted(&mut self) -> Wanted {
        let m = self.material;
        let brushed = m.anisotropy > 0.0 && !m.unlit;
        let coordinates = match self.set() {
            Some(set) => {
                if brushed && m.anisotropy_rotation != 0.0 {
                    self.note(Loss::Approximated, "brushing runs along the texture coordinates, not turned");
                }
                Coordinates::Set(set)
            }
            None if brushed => Coordinates::Brushing(m.anisotropy_rotation),
            None => Coordinates::Set(0),
        };
        Wanted { coordinates, colors: self.takes_colors().then_some(m.base_color) }
    }

    /// True where colours of vertices are the base colour: a texture leaves no room for them.
    pub(super) fn takes_colors(&self) -> bool {
        self.colored && self.material.base_color_texture.is_none() && !self.is_preset()
    }

    pub(super) fn is_preset(&self) -> bool {
        matches!(self.material.reflectance, Reflectance::Preset { .. })
    }

    fn tell_what_is_dropped(&mut self, options: &Options<'_>) {
        let m = self.material;
        if m.unlit {
            if self.colored {
                self.note(Loss::Dropped, "the colours of vertices of an unlit surface");
            }
            return;
        }
        if m.coat > 0.0 {
            self.note(Loss::Dropped, "the clear coat");
        }
        if m.micro_normal != micro_normal::Kind::None && m.micro_depth > 0.0 {
            self.note(Loss::Dropped, "the bumps");
        }
        if m.anisotropy > 0.0 && m.anisotropy_texture.is_some() {
            self.note(Loss::Dropped, "the anisotropy texture; the factors count everywhere");
        }
        if self.colored && m.base_color_texture.is_some() && !self.is_preset() {
            self.note(Loss::Dropped, "the colours of vertices under a base colour texture");
        }
        if options.spectral && self.is_preset() && self.measured.is_none() {
            self.note(
                Loss::Approximated,
                "its metal has no measured table at hand; one index per channel stands for it",
            );
        }
    }

    /// The base colour as a number or texture.
    pub(super) fn base_color(&mut self, name: &str) -> Result<Element, FileError> {
        let factor = self.material.base_color;
        if let Some(texture) = self.used(self.material.base_color_texture) {
            return self.texture(name, &texture, Use::Color { factor });
        }
        if self.takes_colors() {
            let texture = Element::plugin("texture", "mesh_attribute").named(name);
            return Ok(texture.with(Element::string("name", "vertex_color")));
        }
        Ok(Element::rgb(name, factor.min(Vec3::ONE)))
    }

    /// The factor of a texture's channel: one number where the texture has the same everywhere.
    pub(super) fn share(
        &mut self,
        name: &str,
        texture: Option<TextureRef>,
        purpose: Use,
        factor: f32,
    ) -> Result<Share, FileError> {
        let Some(texture) = self.used(texture).filter(|_| factor > 0.0) else { return Ok(Share::Number(factor)) };
        match self.textures.constant(&texture, purpose) {
            Some(value) => Ok(Share::Number(value.x)),
            None => Ok(Share::Texture(self.texture(name, &texture, purpose)?)),
        }
    }

    fn opacity(&mut self) -> Result<Opacity, FileError> {
        let m = self.material;
        let (purpose, cutoff) = match m.alpha_mode {
            AlphaMode::Opaque => return Ok(Opacity::All),
            AlphaMode::Mask { cutoff } => (Use::Cut { factor: m.opacity, cutoff }, Some(cutoff)),
            AlphaMode::Blend => (Use::Share { channel: 3, factor: m.opacity }, None),
        };
        if self.colored {
            self.note(Loss::Dropped, "the opacity of vertices");
        }
        let plain = match cutoff {
            Some(cutoff) if m.opacity < cutoff => 0.0,
            Some(_) => 1.0,
            None => m.opacity,
        };
        match self.share("opacity", m.base_color_texture, purpose, plain)? {
            Share::Number(opacity) if opacity <= 0.0 => Ok(Opacity::None),
            Share::Number(opacity) if opacity >= 1.0 => Ok(Opacity::All),
            Share::Number(opacity) => Ok(Opacity::Part(Element::float("opacity", opacity))),
            Share::Texture(texture) => {
                let smooth = m.base_color_texture.is_some_and(|texture| texture.sampler.magnify == Filter::Linear);
                if cutoff.is_some() && smooth {
                    self.note(Loss::Approximated, "its mask is cut at texels, not between them");
                }
                Ok(Opacity::Part(texture))
            }
        }
    }

    fn emitter(&mut self) -> Result<Option<Element>, FileError> {
        let m = self.material;
        let (factor, texture) = match m.unlit {
            true => (m.base_color, m.base_color_texture),
            false => (m.emission, m.emission_texture),
        };
        if factor.max_element() <= 0.0 {
            return Ok(None);
        }
        let purpose = Use::Radiance { factor };
        let radiance = match self.used(texture) {
            Some(texture) => match self.textures.constant(&texture, purpose) {
                Some(value) if value.max_element() <= 0.0 => return Ok(None),
                Some(value) => Element::rgb("radiance", value),
                None => self.texture("radiance", &texture, purpose)?,
            },
            None => Element::rgb("radiance", factor),
        };
        if m.double_sided {
            self.note(Loss::Approximated, "it shines from its front only");
        }
        Ok(Some(Element::plugin("emitter", "area").with(radiance)))
    }
}

/// A number or a texture.
pub(super) enum Share {
    Number(f32),
    Texture(Element),
}
