//! Textures: images with their factors multiplied in, one file for each use.

use glam::{Vec3, Vec4};

use super::xml::Element;
use crate::color::rgb::linear_from_srgb;
use crate::export::{Folder, image, slug};
use crate::file::FileError;
use crate::material::{Filter, TextureRef, Wrap};
use crate::scene::{Image, Scene, Texels};
use crate::surface::ggx::ALPHA_MIN;

/// What a texture is used for. Mitsuba multiplies none by a factor: each is in the texels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Use {
    /// A colour in [0, 1], decoded from sRGB.
    Color { factor: Vec3 },
    /// Radiance, decoded from sRGB.
    Radiance { factor: Vec3 },
    /// One channel, a share in [0, 1].
    Share { channel: usize, factor: f32 },
    /// GGX width: the square of the roughness in G, then `mix(alpha, 1, stretch)`.
    Alpha { factor: f32, stretch: f32 },
    /// 1 where the opacity in A reaches the cutoff, else 0.
    Cut { factor: f32, cutoff: f32 },
    /// A tangent-space normal whose x and y are scaled.
    Normal { scale: f32 },
}

impl Use {
    /// The numbers of a texel, RGBA as stored, in [0, 1].
    fn value(self, texel: Vec4) -> Vec3 {
        let rgb = texel.truncate();
        match self {
            Use::Color { factor } => (linear_from_srgb(rgb) * factor).min(Vec3::ONE),
            Use::Radiance { factor } => linear_from_srgb(rgb) * factor,
            Use::Share { channel, factor } => Vec3::splat((texel[channel.min(3)] * factor).min(1.0)),
            Use::Alpha { factor, stretch } => {
                let alpha = (texel.y * factor).powi(2);
                Vec3::splat((alpha + (1.0 - alpha) * stretch).clamp(ALPHA_MIN, 1.0))
            }
            Use::Cut { factor, cutoff } => Vec3::splat(if texel.w * factor < cutoff { 0.0 } else { 1.0 }),
            Use::Normal { scale } => {
                let n = (2.0 * rgb - 1.0) * Vec3::new(scale, scale, 1.0);
                0.5 * n.normalize_or(Vec3::Z) + 0.5
            }
        }
    }

    fn has_color(self) -> bool {
        matches!(self, Use::Color { .. } | Use::Radiance { .. } | Use::Normal { .. })
    }

    /// True where the stored bytes say the same.
    fn is_plain(self) -> bool {
        self == Use::Color { factor: Vec3::ONE } || self == Use::Normal { scale: 1.0 }
    }
}

/// The textures of an export.
pub struct Textures<'a> {
    scene: &'a Scene,
    written: Vec<(usize, Use, String)>,
}

impl<'a> Textures<'a> {
    pub fn new(scene: &'a Scene) -> Textures<'a> {
        Textures { scene, written: Vec::new() }
    }

    /// The element of a texture, named as the plugin around it asks; writes its file when it is the first of its kind.
    pub fn element(
        &mut self,
        name: &str,
        texture: &TextureRef,
        purpose: Use,
        folder: &mut Folder<'_>,
    ) -> Result<Element, FileError> {
        let file = self.file(texture.image, purpose, folder)?;
        let wrap = match texture.sampler.wrap_u {
            Wrap::Repeat => "repeat",
            Wrap::Mirror => "mirror",
            Wrap::Clamp => "clamp",
        };
        let nearest = texture.sampler.magnify == Filter::Nearest || matches!(purpose, Use::Cut { .. });
        let filter = if nearest { "nearest" } else { "bilinear" };
        let raw = !matches!(purpose, Use::Color { .. } | Use::Radiance { .. });
        let element = Element::plugin("texture", "bitmap").named(name);
        let element = element
            .with(Element::string("filename", &file))
            .with(Element::boolean("raw", raw))
            .with(Element::string("filter_type", filter))
            .with(Element::string("wrap_mode", wrap));
        let moved = texture.transform != glam::Mat3::IDENTITY;
        Ok(element.with_all(moved.then(|| Element::uv_transform("to_uv", &texture.transform))))
    }

    /// The number that a use has in every texel; `None` where texels differ or there are none.
    pub fn constant(&self, texture: &TextureRef, purpose: Use) -> Option<Vec3> {
        let image = self.scene.images.get(texture.image)?;
        let mut values = texels(image).map(|texel| purpose.value(texel));
        let first = values.next()?;
        values.all(|value| value == first).then_some(first)
    }

    /// Mean of a use over all texels; 0 without any.
    pub fn mean(&self, texture: &TextureRef, purpose: Use) -> f32 {
        let Some(image) = self.scene.images.get(texture.image) else { return 0.0 };
        let sum: f64 = texels(image).map(|texel| f64::from(purpose.value(texel).x)).sum();
        (sum / texels(image).count().max(1) as f64) as f32
    }

    fn file(&mut self, index: usize, purpose: Use, folder: &mut Folder<'_>) -> Result<String, FileError> {
        if let Some((.., file)) = self.written.iter().find(|(of, how, _)| *of == index && *how == purpose) {
            return Ok(file.clone());
        }
        let blank = Image { name: String::new(), width: 1, height: 1, texels: Texels::Unorm8(vec![255; 4]) };
        let image = self.scene.images.get(index).map_or(&blank, |image| image);
        let (width, height) = (image.width, image.height);
        let stem = format!("textures/{}", slug(self.written.len(), &image.name));
        let (name, bytes) = match &image.texels {
            Texels::Unorm8(stored) if purpose.is_plain() => {
                let name = format!("{stem}.png");
                let rgb: Vec<u8> = stored.as_chunks::<4>().0.iter().flat_map(|&[r, g, b, _]| [r, g, b]).collect();
                let bytes = image::png(&name, width, height, &rgb)?;
                (name, bytes)
            }
            _ => {
                let name = format!("{stem}.exr");
                let values: Vec<Vec3> = texels(image).map(|texel| purpose.value(texel)).collect();
                let names: &[&str] = if purpose.has_color() { &["R", "G", "B"] } else { &["Y"] };
                let channel = |(i, name): (usize, &&'static str)| (*name, values.iter().map(|v| v[i]).collect());
                let bytes = image::exr(&name, width, height, names.iter().enumerate().map(channel).collect())?;
                (name, bytes)
            }
        };
        folder.write(&name, &bytes)?;
        self.written.push((index, purpose, name.clone()));
        Ok(name)
    }
}

/// The texels of an image, RGBA in [0, 1] as stored.
fn texels(image: &Image) -> Box<dyn Iterator<Item = Vec4> + '_> {
    match &image.texels {
        Texels::Unorm8(stored) => {
            Box::new(stored.as_chunks::<4>().0.iter().map(|t| Vec4::from_array(t.map(f32::from)) / 255.0))
        }
        Texels::Unorm16(stored) => {
            Box::new(stored.as_chunks::<4>().0.iter().map(|t| Vec4::from_array(t.map(f32::from)) / 65535.0))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_in_the_numbers() {
        let texel = Vec4::new(1.0, 0.5, 0.25, 0.6);
        let share = Use::Share { channel: 2, factor: 0.5 }.value(texel);
        assert_eq!(share.x, 0.125);
        assert_eq!(Use::Alpha { factor: 0.8, stretch: 0.0 }.value(texel).x, 0.4 * 0.4);
        assert_eq!(Use::Alpha { factor: 0.0, stretch: 0.25 }.value(texel).x, 0.25);
        assert_eq!(Use::Alpha { factor: 0.0, stretch: 0.0 }.value(texel).x, ALPHA_MIN);
        assert_eq!(Use::Cut { factor: 1.0, cutoff: 0.6 }.value(texel).x, 1.0);
        assert_eq!(Use::Cut { factor: 0.9, cutoff: 0.6 }.value(texel).x, 0.0);
        let color = Use::Color { factor: Vec3::new(0.5, 1.0, 9.0) }.value(texel);
        assert!((color - Vec3::new(0.5, 0.214_041, 0.458_5)).abs().max_element() < 1e-3, "{color}");
        let flat = Use::Normal { scale: 0.0 }.value(Vec4::new(0.9, 0.3, 0.8, 1.0));
        assert!((flat - Vec3::new(0.5, 0.5, 1.0)).length() < 1e-6, "{flat}");
    }
}
