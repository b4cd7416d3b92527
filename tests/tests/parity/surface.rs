//! A whole surface as four vectors, for the cases of layered and classical.

use burnish_core::surface::blinn_phong;
use burnish_core::surface::ggx::Masking;
use burnish_core::surface::layered::{Lobe, Surface};
use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};

use crate::curves::{self, Curves};

/// WGSL that makes a surface of [`pack`]'s vectors: `parity_surface`. Comes after the curves.
pub const WGSL: &str = concat!(include_str!("curves.wgsl"), include_str!("surface.wgsl"));

/// What varies in a grid; the colours are always the same.
#[derive(Clone, Copy)]
pub struct Variant {
    /// Index in [`Curves::all`].
    pub curve: usize,
    pub metallic: f32,
    pub alpha: Vec2,
    pub lobe: Lobe,
    pub coat: f32,
    pub masking: Masking,
    pub multiple_scattering: bool,
}

/// Three times GGX, whose grid is the larger one; seven, which is no part of the number of other combinations.
const LOBES: [Lobe; 7] = {
    const fn power(exponent: f32, variant: blinn_phong::Variant) -> Lobe {
        Lobe::BlinnPhong { exponent, variant }
    }
    [
        Lobe::Ggx,
        power(32.0, blinn_phong::Variant::Exact),
        Lobe::Ggx,
        power(5.0, blinn_phong::Variant::Approximate),
        power(10.0, blinn_phong::Variant::Unnormalized),
        Lobe::Ggx,
        power(600.0, blinn_phong::Variant::Microfacet),
    ]
};

/// Every pair of widths with metal and dielectric, with and without coat, and every curve; maskings and lobes take turns.
pub fn variants(widths: &[Vec2]) -> Vec<Variant> {
    let mut all = Vec::new();
    for &alpha in widths {
        for metallic in [0.0, 0.5, 1.0] {
            for coat in [0.0, 0.7] {
                for curve in 0..curves::COUNT {
                    let masking = Masking::ALL[all.len() / 3 % 2];
                    let multiple_scattering = curve != 1;
                    let lobe = LOBES[all.len() % LOBES.len()];
                    let alpha = lobe.alpha(alpha);
                    all.push(Variant { curve, metallic, alpha, lobe, coat, masking, multiple_scattering });
                }
            }
        }
    }
    all
}

/// Colour and metallic; widths, coat and its width; the dielectric; curve, switches, lobe and its exponent.
pub fn pack(variant: Variant) -> [Vec4; 4] {
    let Variant { curve, metallic, alpha, lobe, coat, masking, multiple_scattering } = variant;
    // Maskings and multiple scattering in one number, so that the lobe has room.
    let switches = 2 * masking as u32 + u32::from(multiple_scattering);
    let (lobe, exponent) = lobe.numbers();
    [
        Vec3::new(0.8, 0.5, 0.2).extend(metallic),
        alpha.extend(coat).extend(0.01),
        Vec3::new(0.04, 0.05, 0.03).extend(0.9),
        Vec4::new(curve as f32, switches as f32, lobe as f32, exponent),
    ]
}

/// The surface of [`pack`]'s vectors.
pub fn unpack(x: &[Vec4]) -> Surface<'static> {
    let curve = &Curves::get().all[x[3].x as usize];
    let variant = blinn_phong::Variant::ALL.into_iter().find(|v| *v as u32 == x[3].z as u32);
    Surface {
        base_color: x[0].xyz(),
        metallic: x[0].w,
        alpha: x[1].xy(),
        lobe: variant.map_or(Lobe::Ggx, |variant| Lobe::BlinnPhong { exponent: x[3].w, variant }),
        fresnel: &curve.fresnel,
        fresnel_mean: curve.mean,
        dielectric_f0: x[2].xyz(),
        dielectric_f90: x[2].w,
        coat: x[1].z,
        coat_alpha: x[1].w,
        masking: Masking::ALL[x[3].y as usize / 2],
        multiple_scattering: x[3].y as usize % 2 == 1,
    }
}
