//! A rough metal as a whole.

use glam::{Vec2, Vec3};

use super::albedo::{loss, loss_mean};
use super::{Masking, bounces, eval, multiple, pdf, sample_wi, usable};
use crate::math::sampling;
use crate::surface::fresnel::Fresnel;
use crate::surface::{Sample, lambert};

/// Single and multiple scattering of a rough metal.
#[derive(Clone, Copy, Debug)]
pub struct Conductor<'a> {
    /// Widths along local x and y.
    pub alpha: Vec2,
    /// Reflectance curve.
    pub fresnel: &'a Fresnel,
    /// Its cosine-weighted mean, [`Fresnel::mean`].
    pub fresnel_mean: Vec3,
    /// Kind of masking.
    pub masking: Masking,
    /// False leaves out light that scattered more than once.
    pub multiple_scattering: bool,
}

impl Conductor<'_> {
    /// BRDF without the cosine.
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        let Conductor { alpha, fresnel, fresnel_mean, masking, multiple_scattering } = *self;
        let single = eval(wo, wi, alpha, fresnel, masking);
        if multiple_scattering { single + multiple(wo, wi, alpha, fresnel_mean, masking) } else { single }
    }

    /// A direction from visible normals or, for multiple scattering, by the cosine; `u` in `[0, 1)^3`, its z chooses.
    pub fn sample(&self, wo: Vec3, u: Vec3) -> Option<Sample> {
        if wo.z <= 0.0 {
            return None;
        }
        let wi = if u.z < self.multiple_share(wo) {
            sampling::cosine_hemisphere(u.truncate())
        } else {
            sample_wi(wo, self.alpha, u.truncate())?
        };
        let pdf = self.pdf(wo, wi);
        usable(pdf).then(|| Sample { wi, value: self.eval(wo, wi), pdf })
    }

    /// Density of [`Conductor::sample`] per steradian.
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return 0.0;
        }
        let share = self.multiple_share(wo);
        (1.0 - share) * pdf(wo, wi, self.alpha) + share * lambert::pdf(wi)
    }

    /// Chance of choosing the cosine lobe: the part of multiple scattering in the light toward `wo`.
    fn multiple_share(&self, wo: Vec3) -> f32 {
        if !self.multiple_scattering {
            return 0.0;
        }
        let lost = loss(wo, self.alpha, self.masking);
        let mean = loss_mean(self.alpha, self.masking);
        let twice = lost * bounces(self.fresnel_mean, mean).element_sum();
        let once = (1.0 - lost) * self.fresnel_mean.element_sum();
        // Black metal scatters nothing either way.
        if once + twice > 0.0 { twice / (once + twice) } else { 0.0 }
    }
}
