//! A whole surface as four vectors, for the cases of layered and classical.

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
    pub coat: f32,
    pub masking: Masking,
    pub multiple_scattering: bool,
}

/// Every pair of widths with metal and dielectric, with and without coat, and every curve; maskings take turns.
pub fn variants(widths: &[Vec2]) -> Vec<Variant> {
    let mut all = Vec::new();
    for &alpha in widths {
        for metallic in [0.0, 0.5, 1.0] {
            for coat in [0.0, 0.7] {
                for curve in 0..curves::COUNT {
                    let masking = Masking::ALL[all.len() / 3 % 2];
                    let multiple_scattering = curve != 1;
                    all.push(Variant { curve, metallic, alpha, coat, masking, multiple_scattering });
                }
            }
        }
    }
    all
}

/// Colour and metallic; widths, coat and its width; the dielectric; curve, masking and multiple scattering.
pub fn pack(variant: Variant) -> [Vec4; 4] {
    let Variant { curve, metallic, alpha, coat, masking, multiple_scattering } = variant;
    [
        Vec3::new(0.8, 0.5, 0.2).extend(metallic),
        alpha.extend(coat).extend(0.01),
        Vec3::new(0.04, 0.05, 0.03).extend(0.9),
        Vec4::new(curve as f32, masking as u32 as f32, f32::from(u8::from(multiple_scattering)), 0.0),
    ]
}

/// The surface of [`pack`]'s vectors.
pub fn unpack(x: &[Vec4]) -> Surface<'static> {
    let curve = &Curves::get().all[x[3].x as usize];
    Surface {
        base_color: x[0].xyz(),
        metallic: x[0].w,
        alpha: x[1].xy(),
        lobe: Lobe::Ggx,
        fresnel: &curve.fresnel,
        fresnel_mean: curve.mean,
        dielectric_f0: x[2].xyz(),
        dielectric_f90: x[2].w,
        coat: x[1].z,
        coat_alpha: x[1].w,
        masking: Masking::ALL[x[3].y as usize],
        multiple_scattering: x[3].z > 0.0,
    }
}
