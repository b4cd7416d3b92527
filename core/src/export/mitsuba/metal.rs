//! Metals: a conductor of effective or measured n and k, or for a mere base colour the metal of `principled`.

use glam::{Vec2, Vec3};

use super::xml::Element;
use crate::material::preset::Preset;
use crate::surface::fresnel::fit::{self, Target};
use crate::surface::fresnel::{Fresnel, exact};
use crate::surface::ggx;

/// Largest ratio of both widths that `principled` holds: 1 over the square of its least aspect.
const PRINCIPLED_RATIO: f32 = 10.0;

/// Wavelengths that Mitsuba samples, nm. Outside of a table it takes n and k as 0.
const SAMPLED_NM: [f64; 2] = [360.0, 830.0];

/// One complex index per channel, and the largest absolute error of its reflectance.
pub fn index(fresnel: &Fresnel) -> (Vec3, Vec3, f64) {
    if let Fresnel::Conductor { n, k } = fresnel {
        return (*n, *k, 0.0);
    }
    let (mut n, mut k, mut error) = (Vec3::ONE, Vec3::ONE, 0.0_f64);
    for channel in 0..3 {
        // The slope at grazing is for other forms.
        let target = Target::new(0.0, |x| f64::from(fresnel.eval(x as f32)[channel]));
        let found = fit::effective(&target);
        (n[channel], k[channel]) = (found.0 as f32, found.1 as f32);
        error = error.max(target.absolute_error(|x| exact(found.0, found.1, x)));
    }
    (n, k, error)
}

/// n and k as colours.
pub fn effective_index(n: Vec3, k: Vec3) -> [Element; 2] {
    [Element::rgb("eta", n), Element::rgb("k", k)]
}

/// n and k as they were measured; the values at both ends go on to the ends of what Mitsuba samples.
pub fn measured_index(metal: &Preset) -> [Element; 2] {
    let nm = &metal.wavelength_nm;
    let (first, last) = (nm.first().copied().unwrap_or(400.0), nm.last().copied().unwrap_or(700.0));
    let before = (first > SAMPLED_NM[0]).then_some(SAMPLED_NM[0]);
    let after = (last < SAMPLED_NM[1]).then_some(SAMPLED_NM[1]);
    let places: Vec<f64> = before.into_iter().chain(nm.iter().copied()).chain(after).collect();
    let of = |part: fn((f64, f64)) -> f64| places.iter().map(move |nm| (*nm, part(metal.index_at(*nm))));
    [Element::spectrum("eta", of(|v| v.0)), Element::spectrum("k", of(|v| v.1))]
}

/// The width of a metal: numbers or textures.
pub enum Width {
    /// Along the tangent and the bitangent.
    Both(Vec2),
    /// A texture for each, named `alpha_u` and `alpha_v`.
    Textures(Box<[Element; 2]>),
}

/// A conductor of the named distribution: a mirror where it is smoother than rough ones are drawn.
pub fn conductor(index: [Element; 2], distribution: &str, width: Width) -> Element {
    let rough = |widths: [Element; 2]| {
        Element::plugin("bsdf", "roughconductor").with(Element::string("distribution", distribution)).with_all(widths)
    };
    let bsdf = match width {
        Width::Both(alpha) if ggx::is_mirror(alpha) => Element::plugin("bsdf", "conductor"),
        Width::Both(alpha) => {
            let alpha = ggx::clamp_alpha(alpha);
            rough([Element::float("alpha_u", alpha.x), Element::float("alpha_v", alpha.y)])
        }
        Width::Textures(textures) => rough(*textures),
    };
    bsdf.with_all(index)
}

/// Roughness and anisotropy of `principled`: widths `r^2 / aspect` and `r^2 aspect`, aspect = sqrt(1 - 0.9 anisotropic).
/// `None` for a ratio that it cannot hold.
pub fn principled_width(alpha: Vec2) -> Option<(f32, f32)> {
    let alpha = ggx::clamp_alpha(alpha);
    let ratio = alpha.x / alpha.y;
    if !(1.0..=PRINCIPLED_RATIO).contains(&ratio) {
        return None;
    }
    let anisotropic = if ratio > 1.0 { (1.0 - ratio.recip()) / 0.9 } else { 0.0 };
    Some(((alpha.x * alpha.y).sqrt().sqrt(), anisotropic.min(1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::preset;
    use crate::surface::fresnel::Form;

    #[test]
    fn an_index_is_taken_as_it_is_and_else_found_with_its_error() {
        let gold = preset::find("Au").unwrap();
        let Fresnel::Conductor { n, k } = gold.fresnel(Form::EffectiveNk) else { panic!() };
        assert_eq!(index(&Fresnel::Conductor { n, k }), (n, k, 0.0));
        for (id, most) in [("Al", 2e-3), ("Cr", 2e-3), ("Cu", 6e-3), ("Au", 0.05)] {
            let truth = preset::find(id).unwrap().fresnel(Form::Spectral);
            let (n, k, error) = index(&truth);
            assert!(error < most, "{id}: {error}");
            let found = Fresnel::Conductor { n, k };
            for i in 0..=50 {
                let x = i as f32 / 50.0;
                let off = (found.eval(x) - truth.eval(x)).abs().max_element();
                assert!(f64::from(off) < error + 1e-4, "{id} at {x}: {off}");
            }
        }
    }

    #[test]
    fn widths_of_principled_come_back() {
        for alpha in [Vec2::new(0.25, 0.25), Vec2::new(0.5, 0.1), Vec2::new(0.9, 0.09)] {
            let (roughness, anisotropic) = principled_width(alpha).unwrap();
            let aspect = (1.0 - 0.9 * anisotropic).sqrt();
            let back = roughness * roughness * Vec2::new(aspect.recip(), aspect);
            assert!((back - alpha).abs().max_element() < 1e-4, "{alpha} {back}");
        }
        assert_eq!(principled_width(Vec2::new(1.0, 0.01)), None);
    }

    #[test]
    fn a_measured_index_reaches_the_ends_of_what_is_sampled() {
        let metal = preset::find("Cu").unwrap();
        let text = measured_index(&metal)[0].to_string();
        assert!(text.contains("value=\"360:") && text.contains(", 830:"), "{text}");
    }
}
