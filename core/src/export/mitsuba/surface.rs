//! Surface models: metals and dielectrics, mixed.

use glam::{Vec2, Vec3};

use super::material::{Share, Writer};
use super::metal::{self, Width};
use super::texture::Use;
use super::xml::Element;
use crate::export::Loss;
use crate::file::FileError;
use crate::material::{Reflectance, ReflectionModel, TextureRef};
use crate::surface::fresnel::Fresnel;
use crate::surface::layered::Lobe;
use crate::surface::{dielectric, ggx};

/// Reflectance at normal incidence below which a dielectric is written as matte.
const LEAST_F0: f32 = 1e-5;
/// And the largest that `roughplastic` is given: an index of about 39.
const MOST_F0: f32 = 0.9;

impl Writer<'_, '_> {
    /// Metal and dielectric, mixed.
    pub(super) fn surface(&mut self) -> Result<Element, FileError> {
        let m = self.material;
        if m.unlit {
            return Ok(Element::plugin("bsdf", "diffuse").with(Element::rgb("reflectance", Vec3::ZERO)));
        }
        if self.is_preset() {
            return self.metal();
        }
        let purpose = Use::Share { channel: 2, factor: m.metallic };
        let weight = match self.share("weight", m.metallic_roughness_texture, purpose, m.metallic)? {
            Share::Number(metallic) if metallic <= 0.0 => return self.dielectric(),
            Share::Number(metallic) if metallic >= 1.0 => return self.metal(),
            Share::Number(metallic) => Element::float("weight", metallic),
            Share::Texture(texture) => texture,
        };
        let (dielectric, metal) = (self.dielectric()?, self.metal()?);
        Ok(Element::plugin("bsdf", "blendbsdf").with(weight).with(dielectric).with(metal))
    }

    /// The distribution of microfacets that stands for the lobe.
    fn distribution(&self) -> &'static str {
        match self.material.reflection_model {
            ReflectionModel::Ggx => "ggx",
            ReflectionModel::BlinnPhong(_) => "beckmann",
        }
    }

    /// Widths by the factors alone. Beckmann's is that of a Blinn-Phong exponent s, `alpha^2 = 2 / (s + 2)`: Walter et al. 2007,
    /// section 5.2.
    fn alpha(&self) -> Vec2 {
        if let Lobe::BlinnPhong { exponent, .. } = self.material.lobe() {
            return Vec2::splat((2.0 / (exponent + 2.0)).sqrt());
        }
        let alpha = self.material.roughness.powi(2);
        Vec2::new(alpha + (1.0 - alpha) * self.stretch(), alpha)
    }

    fn stretch(&self) -> f32 {
        self.material.anisotropy.powi(2)
    }

    /// The roughness texture, where texels differ; else the widths that it and the factors make.
    fn width(&mut self) -> (Vec2, Option<TextureRef>) {
        let m = self.material;
        let texture = m.metallic_roughness_texture.filter(|_| m.reflection_model == ReflectionModel::Ggx);
        let Some(texture) = self.used(texture) else { return (self.alpha(), None) };
        let purpose = |stretch| Use::Alpha { factor: m.roughness, stretch };
        let same = |stretch| self.textures.constant(&texture, purpose(stretch)).map(|value| value.x);
        match (same(self.stretch()), same(0.0)) {
            (Some(along), Some(across)) => (Vec2::new(along, across), None),
            _ => (self.alpha(), Some(texture)),
        }
    }

    fn metal(&mut self) -> Result<Element, FileError> {
        let m = self.material;
        self.tell_of_the_lobe();
        let (alpha, texture) = self.width();
        self.tell_of_scattering(texture.is_some() || !ggx::is_mirror(alpha));
        match &m.reflectance {
            Reflectance::Preset { fresnel, .. } => {
                let index = match &self.measured {
                    Some(metal) => metal::measured_index(metal),
                    None => {
                        let (n, k, error) = metal::index(fresnel);
                        if error > 0.0 {
                            let what = format!("its reflectance by one index per channel, {error:.4} off at most");
                            self.note(Loss::Approximated, what);
                        }
                        metal::effective_index(n, k)
                    }
                };
                let width = self.textured_width(alpha, texture)?;
                Ok(metal::conductor(index, self.distribution(), width))
            }
            Reflectance::BaseColor => self.base_color_metal(alpha, texture),
        }
    }

    fn textured_width(&mut self, alpha: Vec2, texture: Option<TextureRef>) -> Result<Width, FileError> {
        let Some(texture) = texture else { return Ok(Width::Both(alpha)) };
        let factor = self.material.roughness;
        let along = self.texture("alpha_u", &texture, Use::Alpha { factor, stretch: self.stretch() })?;
        let across = self.texture("alpha_v", &texture, Use::Alpha { factor, stretch: 0.0 })?;
        self.note(Loss::Approximated, "between texels the width is interpolated, not the roughness");
        Ok(Width::Textures(Box::new([along, across])))
    }

    /// `principled` has the same rescaled curve and microfacets; an index stands for it where its shape does not fit.
    fn base_color_metal(&mut self, alpha: Vec2, texture: Option<TextureRef>) -> Result<Element, FileError> {
        let m = self.material;
        let flat = m.base_color_texture.is_none() && !self.takes_colors();
        let is_ggx = m.reflection_model == ReflectionModel::Ggx;
        let Some((roughness, anisotropic)) = metal::principled_width(alpha).filter(|_| is_ggx || !flat) else {
            if flat {
                let curve = Fresnel::Rescaled { f0: m.base_color.min(Vec3::ONE) };
                let (n, k, error) = metal::index(&curve);
                let what = format!("its reflectance by one index per channel, {error:.4} off at most");
                self.note(Loss::Approximated, what);
                let width = self.textured_width(alpha, texture)?;
                return Ok(metal::conductor(metal::effective_index(n, k), self.distribution(), width));
            }
            self.note(Loss::Approximated, "its anisotropy is more than principled holds; it is even");
            let round = Vec2::splat((alpha.x * alpha.y).sqrt());
            return self.principled(metal::principled_width(round).unwrap_or((m.roughness, 0.0)), texture);
        };
        if ggx::is_mirror(alpha) && texture.is_none() {
            self.note(Loss::Approximated, "a mirror by a width of 0.001");
        }
        self.principled((roughness, anisotropic), texture)
    }

    fn principled(&mut self, width: (f32, f32), texture: Option<TextureRef>) -> Result<Element, FileError> {
        let (roughness, anisotropic) = width;
        let factor = self.material.roughness;
        let roughness = match texture {
            Some(texture) => self.texture("roughness", &texture, Use::Share { channel: 1, factor })?,
            None => Element::float("roughness", roughness),
        };
        let color = self.base_color("base_color")?;
        let bsdf = Element::plugin("bsdf", "principled").with(color).with(Element::float("metallic", 1.0));
        let brushed = (anisotropic > 0.0).then(|| Element::float("anisotropic", anisotropic));
        Ok(bsdf.with(roughness).with_all(brushed))
    }

    fn tell_of_the_lobe(&mut self) {
        if self.material.reflection_model != ReflectionModel::Ggx {
            self.note(Loss::Approximated, "its Blinn-Phong lobe by microfacets of the same width");
        }
    }

    fn tell_of_scattering(&mut self, rough: bool) {
        if rough {
            let what = "microfacets mask light and view apart (separable), and light scatters once: render with \
                        masking=separable and multiple-scattering=off to compare";
            self.folder.report.note("rough metals", Loss::Approximated, what);
        }
    }

    /// A reflection over a matte base.
    fn dielectric(&mut self) -> Result<Element, FileError> {
        let m = self.material;
        let strongest = dielectric::f0(m.ior, m.specular, m.specular_color);
        let f0 = strongest.max_element().min(MOST_F0);
        if f0 < LEAST_F0 {
            if m.specular > 0.0 {
                self.note(Loss::Dropped, "the reflection at grazing angles of a surface that has none straight on");
            }
            let color = self.base_color("reflectance")?;
            return Ok(Element::plugin("bsdf", "diffuse").with(color));
        }
        self.tell_of_the_lobe();
        self.note(Loss::Approximated, "its reflection by the equations of Fresnel over a base of `roughplastic`");
        let textured = [(m.specular_texture, "strength"), (m.specular_color_texture, "tint")];
        for (texture, what) in textured {
            if texture.is_some() {
                self.note(Loss::Dropped, format!("the texture of the {what} of its reflection"));
            }
        }
        let (alpha, texture) = self.width();
        let mut width = (alpha.x * alpha.y).sqrt();
        if let Some(texture) = texture {
            let purpose = Use::Alpha { factor: m.roughness, stretch: 0.0 };
            width = self.textures.mean(&texture, purpose);
            self.note(Loss::Approximated, "the roughness of its reflection by the mean of the texture");
        }
        let mirror = width < ggx::ALPHA_MIN;
        let kind = if mirror { "plastic" } else { "roughplastic" };
        let color = self.base_color("diffuse_reflectance")?;
        let root = f0.sqrt();
        let mut bsdf = Element::plugin("bsdf", kind)
            .with(color)
            .with(Element::float("int_ior", (1.0 + root) / (1.0 - root)))
            .with(Element::float("ext_ior", 1.0));
        if !mirror {
            bsdf = bsdf
                .with(Element::string("distribution", self.distribution()))
                .with(Element::float("alpha", width.min(1.0)));
        }
        let tint = strongest / strongest.max_element();
        Ok(bsdf.with_all((tint != Vec3::ONE).then(|| Element::rgb("specular_reflectance", tint))))
    }
}
