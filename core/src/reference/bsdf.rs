//! Drawing directions from a whole surface, mirrors included.

use glam::{Vec2, Vec3};

use super::point::Point;
use super::world::World;
use crate::math::frame::Frame;
use crate::math::sampling::cosine_hemisphere;
use crate::surface::ggx::albedo::loss_mean;
use crate::surface::layered::{self, Surface};
use crate::surface::{coat, fresnel, ggx, lambert};

/// Least cosine to the viewer in a shading frame: normals that turn away are turned back to the rim.
const COS_MIN: f32 = 1e-3;

/// A surface seen from a direction, with the chances of its lobes.
#[derive(Clone, Debug)]
pub(super) struct Bsdf<'a> {
    surface: Surface<'a>,
    base: Frame,
    coat: Frame,
    /// Normal of the triangle on the viewer's side.
    geometric: Vec3,
    /// To the viewer, in the frames of base and coat.
    wo: Vec3,
    coat_wo: Vec3,
    /// What passes the coat toward the viewer.
    passed_o: f32,
    spread: layered::Spread,
    base_is_mirror: bool,
    coat_is_mirror: bool,
    chances: Chances,
}

/// With which chance a lobe is drawn; they sum to one, or are all zero on black surfaces.
#[derive(Clone, Copy, Debug)]
struct Chances {
    coat: f32,
    glossy: f32,
    spread: f32,
}

/// A direction drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BsdfSample {
    /// World, unit.
    pub wi: Vec3,
    /// The response (with its cosine) over the density: what the radiance from there is multiplied by.
    pub weight: Vec3,
    /// Per steradian; infinite for a mirror.
    pub pdf: f32,
}

impl<'a> Bsdf<'a> {
    /// The surface at a point, seen from `to_viewer` (unit, world).
    pub(super) fn new(world: &World, point: &'a Point, to_viewer: Vec3) -> Bsdf<'a> {
        let surface = point.surface(world);
        let wo = facing(point.base.to_local(to_viewer));
        let coat_wo = facing(point.coat.to_local(to_viewer));
        let s = &surface;
        let passed_o = coat::transmission(coat_wo, s.coat_alpha, s.coat, s.masking);
        let base_is_mirror = ggx::is_mirror(s.alpha);
        let coat_is_mirror = s.coat_alpha < ggx::ALPHA_MIN;
        let spread = layered::Spread::new(s, wo);
        let chances = Chances::new(s, wo, passed_o, base_is_mirror);
        let (base, coat, geometric) = (point.base, point.coat, point.geometric);
        Bsdf { surface, base, coat, geometric, wo, coat_wo, passed_o, spread, base_is_mirror, coat_is_mirror, chances }
    }

    /// True where light from a lamp can be seen other than as its mirror image.
    pub(super) fn has_density(&self) -> bool {
        let Chances { coat, glossy, spread } = self.chances;
        spread > 0.0 || (glossy > 0.0 && !self.base_is_mirror) || (coat > 0.0 && !self.coat_is_mirror)
    }

    /// What passes the coat toward the viewer.
    pub(super) fn passed(&self) -> f32 {
        self.passed_o
    }

    /// About the share of even light that goes back toward the viewer.
    pub(super) fn albedo(&self) -> Vec3 {
        let s = &self.surface;
        let (glossy, spread) = takes(s, self.wo, self.base_is_mirror);
        (self.passed_o * (glossy + spread) + Vec3::splat(1.0 - self.passed_o)).clamp(Vec3::ZERO, Vec3::ONE)
    }

    /// Response with its cosine, and the density of [`Bsdf::sample`]; mirrors have neither.
    pub(super) fn eval(&self, wi: Vec3) -> (Vec3, f32) {
        if wi.dot(self.geometric) <= 0.0 {
            return (Vec3::ZERO, 0.0);
        }
        let (s, chances) = (&self.surface, &self.chances);
        let local = self.base.to_local(wi);
        let (mut value, mut pdf) = (Vec3::ZERO, 0.0);
        if local.z > 0.0 {
            value = self.spread.eval(s, local);
            pdf = chances.spread * lambert::pdf(local);
            if !self.base_is_mirror {
                value += layered::glossy(s, self.wo, local);
                pdf += chances.glossy * s.lobe.pdf(self.wo, local, s.alpha);
            }
            value *= local.z;
        }
        if s.coat > 0.0 {
            let coat_wi = self.coat.to_local(wi);
            value *= self.passed_o * coat::transmission(coat_wi, s.coat_alpha, s.coat, s.masking);
            if !self.coat_is_mirror {
                let reflected = coat::eval(self.coat_wo, coat_wi, s.coat_alpha, s.masking);
                value += s.coat * reflected * coat_wi.z.max(0.0);
                pdf += chances.coat * ggx::pdf(self.coat_wo, coat_wi, Vec2::splat(s.coat_alpha));
            }
        }
        (value, pdf)
    }

    /// Response of the matte base alone with its cosine, through the coat: what is left of light that reflections leave out.
    pub(super) fn eval_matte(&self, wi: Vec3) -> Vec3 {
        let (s, local) = (&self.surface, self.base.to_local(wi));
        if wi.dot(self.geometric) <= 0.0 || local.z <= 0.0 {
            return Vec3::ZERO;
        }
        let mut value = self.spread.eval_matte(s, local) * local.z;
        if s.coat > 0.0 {
            let coat_wi = self.coat.to_local(wi);
            value *= self.passed_o * coat::transmission(coat_wi, s.coat_alpha, s.coat, s.masking);
        }
        value
    }

    /// A direction; `u` in `[0, 1)^3`, its z chooses the lobe. `None` where the light ends.
    pub(super) fn sample(&self, u: Vec3) -> Option<BsdfSample> {
        let (s, Chances { coat, glossy, spread }) = (&self.surface, self.chances);
        if coat + glossy + spread <= 0.0 {
            return None;
        }
        let at = u.truncate();
        let wi = if u.z < glossy {
            if self.base_is_mirror {
                return self.mirrored_base();
            }
            self.base.to_world(s.lobe.sample_wi(self.wo, s.alpha, at)?)
        } else if u.z < glossy + spread {
            self.base.to_world(cosine_hemisphere(at))
        } else {
            if self.coat_is_mirror {
                return self.mirrored_coat();
            }
            self.coat.to_world(ggx::sample_wi(self.coat_wo, Vec2::splat(s.coat_alpha), at)?)
        };
        let wi = wi.normalize();
        let (value, pdf) = self.eval(wi);
        (pdf > 0.0 && pdf.is_finite()).then(|| BsdfSample { wi, weight: value / pdf, pdf })
    }

    /// The mirror image in the base.
    fn mirrored_base(&self) -> Option<BsdfSample> {
        let s = &self.surface;
        let wi = self.mirrored(&self.base, self.wo)?;
        let coat_wi = self.coat.to_local(wi);
        let passed_i = coat::transmission(coat_wi, s.coat_alpha, s.coat, s.masking);
        let value = self.passed_o * passed_i * layered::reflectance(s, self.wo.z);
        Some(BsdfSample { wi, weight: value / self.chances.glossy, pdf: f32::INFINITY })
    }

    /// The mirror image in the coat.
    fn mirrored_coat(&self) -> Option<BsdfSample> {
        let wi = self.mirrored(&self.coat, self.coat_wo)?;
        let value = self.surface.coat * fresnel::schlick(Vec3::splat(coat::F0), 1.0, self.coat_wo.z);
        Some(BsdfSample { wi, weight: value / self.chances.coat, pdf: f32::INFINITY })
    }

    /// World direction; `None` where it goes below the triangle.
    fn mirrored(&self, frame: &Frame, wo: Vec3) -> Option<Vec3> {
        let wi = frame.to_world(Vec3::new(-wo.x, -wo.y, wo.z)).normalize();
        (wi.dot(self.geometric) > 0.0).then_some(wi)
    }
}

impl Chances {
    /// By what each lobe sends of even light toward the viewer.
    fn new(s: &Surface, wo: Vec3, passed: f32, mirror: bool) -> Chances {
        let (glossy, spread) = takes(s, wo, mirror);
        let (glossy, spread) = (passed * glossy.element_sum() / 3.0, passed * spread.element_sum() / 3.0);
        let coat = 1.0 - passed;
        let sum = coat + glossy + spread;
        if sum > 0.0 {
            Chances { coat: coat / sum, glossy: glossy / sum, spread: spread / sum }
        } else {
            Chances { coat: 0.0, glossy: 0.0, spread: 0.0 }
        }
    }
}

/// What the lobes of the base send of even light toward the viewer, about: glossy and spread.
fn takes(s: &Surface, wo: Vec3, mirror: bool) -> (Vec3, Vec3) {
    let kept = if mirror { 1.0 } else { layered::lobe_albedo(s, wo) };
    let glossy = kept * layered::reflectance(s, wo.z);
    let mut spread = Vec3::ZERO;
    if s.metallic > 0.0 && s.scatters_again() {
        spread += s.metallic * (1.0 - kept) * ggx::bounces(s.fresnel_mean, loss_mean(s.alpha, s.masking));
    }
    if s.metallic < 1.0 {
        spread += (1.0 - s.metallic) * layered::matte_albedo(s, wo);
    }
    (glossy, spread)
}

/// A direction to the viewer in a shading frame, at least at its rim.
fn facing(wo: Vec3) -> Vec3 {
    Vec3::new(wo.x, wo.y, wo.z.max(COS_MIN)).normalize()
}
