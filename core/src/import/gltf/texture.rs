//! Images, samplers and references to them.

use ::gltf::json::Root;
use ::gltf::json::extensions::texture::TextureTransform;
use ::gltf::json::texture::{MagFilter, MinFilter, WrappingMode};
use ::gltf::json::validation::Checked;
use glam::{Mat3, Vec2};

use super::accessor::Data;
use super::element;
use crate::import::budget::Meter;
use crate::import::numbers::pick;
use crate::import::picture::{self, Encoded};
use crate::import::report::Report;
use crate::import::resolve::fetch;
use crate::import::{Cause, Resolver, SharedImage};
use crate::material::{Filter, Sampler, TextureRef, Wrap};

/// Media types of inline pictures; their content decides.
const IMAGE_MEDIA: &[&str] = &["image/png", "image/jpeg", "image/jpg", "application/octet-stream"];

/// The sampler of a texture that names none: repeat, and all filters linear.
const DEFAULT_SAMPLER: Sampler = Sampler {
    wrap_u: Wrap::Repeat,
    wrap_v: Wrap::Repeat,
    magnify: Filter::Linear,
    minify: Filter::Linear,
    mip: Some(Filter::Linear),
};

/// The decoded images of the scene.
pub(super) struct Images {
    pub list: Vec<SharedImage>,
    /// Image index of the file to index in `list`; `None` when it could not be read.
    places: Vec<Option<usize>>,
}

/// Decodes every image that a texture uses. One that cannot be read is a notice: the picture still comes out.
pub(super) fn read_images(data: &Data<'_>, resolver: &dyn Resolver, meter: &mut Meter, report: &mut Report) -> Images {
    let root = data.root;
    let mut used = vec![false; root.images.len()];
    for texture in &root.textures {
        if let Some(flag) = used.get_mut(texture.source.value()) {
            *flag = true;
        }
    }
    let mut encoded = Vec::new();
    for (i, json) in root.images.iter().enumerate().filter(|(i, _)| used[*i]) {
        let at = element("image", i, json.name.as_deref().or(json.uri.as_deref().filter(|u| !u.starts_with("data:"))));
        let bytes = match (&json.uri, &json.buffer_view) {
            (Some(uri), _) => fetch(resolver, uri, IMAGE_MEDIA, meter),
            (None, Some(view)) => data.view(view.value()).map(<[u8]>::to_vec),
            (None, None) => Err(Cause::Invalid("has neither a URI nor a buffer view".into())),
        };
        match bytes.and_then(|bytes| Encoded::open(bytes, at.clone(), meter)) {
            Ok(picture) => encoded.push((i, picture)),
            Err(cause) => report.notice(at, format!("the texture is left out: {cause}")),
        }
    }
    let mut images = Images { list: Vec::new(), places: vec![None; root.images.len()] };
    let (indices, encoded): (Vec<_>, Vec<_>) = encoded.into_iter().unzip();
    for (i, (at, decoded)) in indices.into_iter().zip(picture::decode_all(encoded)) {
        match decoded {
            Ok(image) => {
                images.places[i] = Some(images.list.len());
                images.list.push(image.into());
            }
            Err(cause) => report.notice(at, format!("the texture is left out: {cause}")),
        }
    }
    images
}

/// A reference as the material writes it.
pub(super) struct Asked<'a> {
    pub texture: usize,
    pub uv_set: u32,
    pub transform: Option<&'a TextureTransform>,
}

impl Images {
    /// What a material gets for a texture that it asks for; `None` when there is none to show. `what` names the slot.
    pub fn texture(
        &self,
        root: &Root,
        asked: &Asked<'_>,
        at: &str,
        what: &str,
        report: &mut Report,
    ) -> Option<TextureRef> {
        let at = format!("{at}, {what} texture");
        let texture = match pick(&root.textures, asked.texture, "texture") {
            Ok(texture) => texture,
            Err(cause) => {
                report.notice(at, format!("the texture is left out: {cause}"));
                return None;
            }
        };
        let source = texture.source.value();
        let Some(place) = self.places.get(source) else {
            // The crate stores the greatest index for a texture without a source.
            let why = if source == u32::MAX as usize {
                "it names no PNG or JPEG image".into()
            } else {
                format!("image {source} does not exist")
            };
            report.notice(at, format!("the texture is left out: {why}"));
            return None;
        };
        // An image that could not be read was noticed by itself.
        let image = (*place)?;
        let sampler = match &texture.sampler {
            None => DEFAULT_SAMPLER,
            Some(index) => sampler(root, index.value(), &at, report),
        };
        let mut uv_set = asked.transform.and_then(|t| t.tex_coord).unwrap_or(asked.uv_set);
        if uv_set > 1 {
            report.notice(&at, format!("TEXCOORD_{uv_set} is not read; TEXCOORD_0 is used instead"));
            uv_set = 0;
        }
        let mut transform = asked.transform.map_or(Mat3::IDENTITY, matrix);
        if !transform.is_finite() {
            report.notice(&at, "a texture transform that is not finite was left out");
            transform = Mat3::IDENTITY;
        }
        Some(TextureRef { image, sampler, uv_set: uv_set as u8, transform })
    }
}

/// KHR_texture_transform as a matrix on (u, v, 1): translation * rotation * scale. The rotation is counter-clockwise
/// as seen in the picture, whose v axis points down, so its matrix is that of the negative angle.
fn matrix(t: &TextureTransform) -> Mat3 {
    Mat3::from_translation(Vec2::from(t.offset.0))
        * Mat3::from_angle(-t.rotation.0)
        * Mat3::from_scale(Vec2::from(t.scale.0))
}

fn sampler(root: &Root, index: usize, at: &str, report: &mut Report) -> Sampler {
    let Some(json) = root.samplers.get(index) else {
        report.notice(at, format!("sampler {index} does not exist; the default is used"));
        return DEFAULT_SAMPLER;
    };
    let mut invalid = false;
    let mut wrap = |mode: &Checked<WrappingMode>| match mode {
        Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
        Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
        Checked::Valid(WrappingMode::Repeat) => Wrap::Repeat,
        Checked::Invalid => {
            invalid = true;
            Wrap::Repeat
        }
    };
    let (wrap_u, wrap_v) = (wrap(&json.wrap_s), wrap(&json.wrap_t));
    let magnify = match json.mag_filter {
        Some(Checked::Valid(MagFilter::Nearest)) => Filter::Nearest,
        Some(Checked::Valid(MagFilter::Linear)) | None => Filter::Linear,
        Some(Checked::Invalid) => {
            invalid = true;
            Filter::Linear
        }
    };
    use MinFilter as M;
    let (minify, mip) = match json.min_filter {
        Some(Checked::Valid(M::Nearest)) => (Filter::Nearest, None),
        Some(Checked::Valid(M::Linear)) => (Filter::Linear, None),
        Some(Checked::Valid(M::NearestMipmapNearest)) => (Filter::Nearest, Some(Filter::Nearest)),
        Some(Checked::Valid(M::LinearMipmapNearest)) => (Filter::Linear, Some(Filter::Nearest)),
        Some(Checked::Valid(M::NearestMipmapLinear)) => (Filter::Nearest, Some(Filter::Linear)),
        Some(Checked::Valid(M::LinearMipmapLinear)) | None => (Filter::Linear, Some(Filter::Linear)),
        Some(Checked::Invalid) => {
            invalid = true;
            (Filter::Linear, Some(Filter::Linear))
        }
    };
    if invalid {
        report.notice(at, format!("sampler {index} has an unknown filter or wrap mode; the default is used for it"));
    }
    Sampler { wrap_u, wrap_v, magnify, minify, mip }
}
