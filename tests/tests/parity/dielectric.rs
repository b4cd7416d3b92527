//! Reflection over a matte base.

use burnish_core::surface::dielectric;
use burnish_core::surface::ggx::Masking;
use glam::{Vec2, Vec3, Vec4};

use crate::grid::{self, ALPHAS, MASKINGS, v4};
use crate::harness::Case;

pub fn cases() -> Vec<Case> {
    let leaf = &dielectric::WGSL;
    vec![
        Case::new(
            "dielectric: reflectance of an index",
            leaf,
            "y[0] = vec4f(dielectric_f0(x[0].w, x[1].x, x[0].xyz), 0.0);",
            indices,
            |x| [v4(dielectric::f0(x[0].w, x[1].x, x[0].truncate()), 0.0)],
        ),
        Case::new("dielectric: share of the reflection", leaf, SHARE, shares, share),
        Case::new("dielectric: base and whole", leaf, EVAL, surfaces, eval),
    ]
}

fn indices() -> Vec<[Vec4; 2]> {
    let tint = Vec3::new(1.0, 0.5, 30.0);
    let all = [0.0, 1.0, 1.0003, 1.33, 1.5, 2.42, 100.0];
    all.iter().flat_map(|&ior| [0.0, 0.4, 1.0].map(|specular| [v4(tint, ior), crate::grid::one(specular)])).collect()
}

const SHARE: &str = "
    let masking = u32(x[1].z);
    let of_direction = dielectric_albedo(x[0].xyz, x[1].xy, x[0].w, x[1].w, masking);
    y[0] = vec4f(of_direction, dielectric_albedo_mean(x[1].xy, x[0].w, x[1].w, masking), 0.0, 0.0);
";

/// f0 and f90 of no reflection, of glass, of a mirror.
const REFLECTANCES: [(f32, f32); 4] = [(0.0, 0.0), (0.04, 1.0), (0.3, 0.6), (1.0, 1.0)];

fn shares() -> Vec<[Vec4; 2]> {
    let mut inputs = Vec::new();
    for w in grid::directions() {
        for alpha in ALPHAS {
            for m in MASKINGS {
                inputs.extend(REFLECTANCES.map(|(f0, f90)| [v4(w, f0), alpha.extend(m).extend(f90)]));
            }
        }
    }
    inputs
}

fn share(x: &[Vec4; 2]) -> [Vec4; 1] {
    let (alpha, masking) = (x[1].truncate().truncate(), Masking::ALL[x[1].z as usize]);
    let of_direction = dielectric::albedo(x[0].truncate(), alpha, x[0].w, x[1].w, masking);
    [Vec2::new(of_direction, dielectric::albedo_mean(alpha, x[0].w, x[1].w, masking)).extend(0.0).extend(0.0)]
}

const EVAL: &str = "
    let color = vec3f(0.8, 0.5, 0.2);
    let masking = u32(x[2].z);
    y[0] = vec4f(dielectric_base(x[0].xyz, x[1].xyz, x[2].xy, x[3].xyz, x[3].w, color, masking), 0.0);
    y[1] = vec4f(dielectric_eval(x[0].xyz, x[1].xyz, x[2].xy, x[3].xyz, x[3].w, color, masking), 0.0);
";

fn surfaces() -> Vec<[Vec4; 4]> {
    let mut inputs = Vec::new();
    for (i, (wo, wi)) in grid::pairs().into_iter().enumerate() {
        for (j, alpha) in ALPHAS.into_iter().enumerate() {
            let (f0, f90) = REFLECTANCES[(i + j / 2) % REFLECTANCES.len()];
            let tinted = v4(f0 * Vec3::new(0.7, 1.0, 0.9), f90);
            let masking = MASKINGS[(i + j) % 2];
            inputs.push([v4(wo, 0.0), v4(wi, 0.0), alpha.extend(masking).extend(0.0), tinted]);
        }
    }
    inputs
}

fn eval(x: &[Vec4; 4]) -> [Vec4; 2] {
    let color = Vec3::new(0.8, 0.5, 0.2);
    let (wo, wi, alpha) = (x[0].truncate(), x[1].truncate(), x[2].truncate().truncate());
    let (masking, f0, f90) = (Masking::ALL[x[2].z as usize], x[3].truncate(), x[3].w);
    let base = dielectric::base(wo, wi, alpha, f0, f90, color, masking);
    [v4(base, 0.0), v4(dielectric::eval(wo, wi, alpha, f0, f90, color, masking), 0.0)]
}
