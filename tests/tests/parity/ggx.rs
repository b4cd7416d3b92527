//! Microfacets: distribution, masking, sampling, tables.

use burnish_core::surface::ggx::albedo::{albedo, albedo_mean, loss, loss_mean, schlick_mean, schlick_ratio, toward};
use burnish_core::surface::ggx::{self, Masking, bounces, multiple};
use glam::{Vec2, Vec3, Vec4};

use crate::curves::{self, Curves};
use crate::grid::{self, ALPHAS, MASKINGS, v4};
use crate::harness::{Case, Tolerance};

/// Where the half vector is the short sum of nearly opposite ones, its direction magnifies the rounding of sine and
/// cosine; ten numbers of the grid, 3e-6 apart at most.
const SHORT: Tolerance = Tolerance { absolute: 5e-6, ..Tolerance::DEFAULT };

pub fn cases() -> Vec<Case> {
    let leaf = &ggx::WGSL;
    vec![
        Case::new("ggx: normals and masking of one direction", leaf, ONE, single, one),
        Case::new("ggx: two directions", leaf, TWO, double, two),
        Case::new("ggx: single and multiple scattering of every curve", leaf, EVAL, colored, eval).with(curves::WGSL),
        Case::new("ggx: sampling of visible normals", leaf, SAMPLE, sampled, sample).within(SHORT),
        Case::new("ggx: normals at the end of the lobe are unit vectors above the horizon", leaf, END, last, |_| {
            [Vec4::new(1.0, 1.0, 0.0, 0.0)]
        }),
        Case::new("ggx: tables of the albedo", leaf, ALBEDO, tabled, tables),
        Case::new("ggx: isotropic and mean albedos", leaf, MEANS, means_inputs, means),
    ]
}

fn alpha(x: &Vec4) -> Vec2 {
    x.truncate().truncate()
}

fn masking(x: &Vec4) -> Masking {
    Masking::ALL[x.z as usize]
}

const ONE: &str = "
    let alpha = x[1].xy;
    y[0] = vec4f(ggx_distribution(x[0].xyz, alpha), ggx_stretched(x[0].xyz, alpha), ggx_masking(x[0].xyz, alpha), 0.0);
    y[1] = vec4f(ggx_clamp_alpha(alpha), ggx_lambda(x[0].xyz, alpha), 0.0);
";

/// Directions, those around the normal where a narrow lobe is among them.
fn single() -> Vec<[Vec4; 2]> {
    let mut inputs = Vec::new();
    for alpha in ALPHAS.into_iter().chain([Vec2::new(-1.0, 7.0)]) {
        let near = [3e-4, 1e-3, 4e-3].map(|t| Vec3::new(0.8 * t, -0.6 * t, 1.0).normalize());
        let all = grid::directions().into_iter().chain(near);
        inputs.extend(all.map(|w| [v4(w, 0.0), alpha.extend(0.0).extend(0.0)]));
    }
    inputs
}

fn one(x: &[Vec4; 2]) -> [Vec4; 2] {
    let (w, alpha) = (x[0].truncate(), alpha(&x[1]));
    let first = Vec3::new(ggx::distribution(w, alpha), ggx::stretched(w, alpha), ggx::masking(w, alpha));
    [v4(first, 0.0), v4(ggx::clamp_alpha(alpha).extend(ggx::lambda(w, alpha)), 0.0)]
}

const TWO: &str = "
    let wo = x[0].xyz;
    let wi = x[1].xyz;
    let alpha = x[2].xy;
    let masking = u32(x[2].z);
    y[0] = vec4f(ggx_microfacet(wo, wi, alpha, masking), ggx_pdf(wo, wi, alpha), 0.0);
    y[1].x = ggx_visibility(wo, wi, alpha, masking);
    y[1].y = ggx_shadowing_masking(wo, wi, alpha, masking);
";

fn double() -> Vec<[Vec4; 3]> {
    let mut inputs = Vec::new();
    for (wo, wi) in grid::pairs() {
        for alpha in ALPHAS {
            inputs.extend(MASKINGS.map(|m| [v4(wo, 0.0), v4(wi, 0.0), alpha.extend(m).extend(0.0)]));
        }
    }
    inputs
}

fn two(x: &[Vec4; 3]) -> [Vec4; 2] {
    let (wo, wi, alpha, masking) = (x[0].truncate(), x[1].truncate(), alpha(&x[2]), masking(&x[2]));
    let facet = ggx::microfacet(wo, wi, alpha, masking);
    let (v, g) = (ggx::visibility(wo, wi, alpha, masking), ggx::shadowing_masking(wo, wi, alpha, masking));
    [v4(facet.extend(ggx::pdf(wo, wi, alpha)), 0.0), Vec4::new(v, g, 0.0, 0.0)]
}

const EVAL: &str = "
    let wo = x[0].xyz;
    let wi = x[1].xyz;
    let masking = u32(x[2].z);
    let curve = u32(x[2].w);
    y[0] = vec4f(ggx_eval(wo, wi, x[2].xy, parity_curve(curve), masking), 0.0);
    y[1] = vec4f(ggx_multiple(wo, wi, x[2].xy, parity_curve_mean(curve), masking), 0.0);
";

fn colored() -> Vec<[Vec4; 3]> {
    let curved = |i: usize, mut x: [Vec4; 3]| {
        x[2].w = (i % curves::COUNT) as f32;
        x
    };
    // A step without common divisor with the grid's own.
    double().into_iter().enumerate().flat_map(|(i, x)| (i % 3 == 0).then(|| curved(i / 3, x))).collect()
}

fn eval(x: &[Vec4; 3]) -> [Vec4; 2] {
    let (wo, wi, alpha, masking) = (x[0].truncate(), x[1].truncate(), alpha(&x[2]), masking(&x[2]));
    let curve = &Curves::get().all[x[2].w as usize];
    let single = ggx::eval(wo, wi, alpha, &curve.fresnel, masking);
    [v4(single, 0.0), v4(multiple(wo, wi, alpha, curve.mean, masking), 0.0)]
}

const SAMPLE: &str = "
    let wm = ggx_sample_wm(x[0].xyz, x[1].xy, x[1].zw);
    y[0] = vec4f(wm, 0.0);
    y[1].x = ggx_pdf_wm(x[0].xyz, x[2].xyz, x[1].xy);
";

/// The normal whose density is asked for is Rust's, so that narrow lobes do not enlarge a difference of samples.
fn sampled() -> Vec<[Vec4; 3]> {
    let mut inputs = Vec::new();
    for wo in grid::directions().into_iter().filter(|w| w.z >= 0.0) {
        for alpha in ALPHAS {
            // Toward u.y = 1 the slopes grow without bound, and a rounding of u turns the normal.
            inputs.extend(grid::square().into_iter().filter(|u| u.y < 0.99).map(|u| {
                let wm = ggx::sample_wm(wo, alpha, u);
                [v4(wo, 0.0), alpha.extend(u.x).extend(u.y), v4(wm, 0.0)]
            }));
        }
    }
    inputs
}

fn sample(x: &[Vec4; 3]) -> [Vec4; 2] {
    let (wo, alpha) = (x[0].truncate(), alpha(&x[1]));
    let wm = ggx::sample_wm(wo, alpha, Vec2::new(x[1].z, x[1].w));
    [v4(wm, 0.0), crate::grid::one(ggx::pdf_wm(wo, x[2].truncate(), alpha))]
}

const END: &str = "
    let wm = ggx_sample_wm(x[0].xyz, x[1].xy, x[1].zw);
    y[0].x = length(wm);
    y[0].y = select(0.0, 1.0, wm.z >= 0.0);
";

/// The largest u.y, which [`sampled`] leaves out.
fn last() -> Vec<[Vec4; 2]> {
    let mut inputs = Vec::new();
    for wo in grid::directions().into_iter().filter(|w| w.z >= 0.0) {
        for alpha in ALPHAS {
            let ends = grid::square().into_iter().filter(|u| u.y > 0.99);
            inputs.extend(ends.map(|u| [v4(wo, 0.0), alpha.extend(u.x).extend(u.y)]));
        }
    }
    inputs
}

const ALBEDO: &str = "
    let masking = u32(x[1].z);
    let widths = ggx_toward(x[0].xyz, x[1].xy, vec2f(0.3, 0.8));
    y[0] = vec4f(ggx_loss(x[0].xyz, x[1].xy, masking), ggx_schlick_ratio(x[0].xyz, x[1].xy, masking), widths);
";

fn tabled() -> Vec<[Vec4; 2]> {
    let mut inputs = Vec::new();
    for w in grid::directions() {
        for alpha in widths() {
            inputs.extend(MASKINGS.map(|m| [v4(w, 0.0), alpha.extend(m).extend(0.0)]));
        }
    }
    inputs
}

/// [`ALPHAS`] and a fine grid through the cells of the tables.
fn widths() -> Vec<Vec2> {
    let steps = (0..12).map(|i| (0.17 + 0.0761 * i as f32).powi(4));
    let squares = steps.flat_map(|x| [Vec2::new(x, x), Vec2::new(x, 0.07), Vec2::new(0.4, x)]);
    ALPHAS.into_iter().chain(squares).collect()
}

fn tables(x: &[Vec4; 2]) -> [Vec4; 1] {
    let (w, alpha, masking) = (x[0].truncate(), alpha(&x[1]), masking(&x[1]));
    let both = Vec2::new(loss(w, alpha, masking), schlick_ratio(w, alpha, masking));
    let widths = toward(w, alpha, Vec2::new(0.3, 0.8));
    [both.extend(widths.x).extend(widths.y)]
}

const MEANS: &str = "
    let alpha = x[0].xy;
    let masking = u32(x[0].z);
    let mean = ggx_loss_mean(alpha, masking);
    let isotropic = vec2f(ggx_albedo(x[0].w, alpha.x, masking), ggx_albedo_mean(alpha.y, masking));
    y[0] = vec4f(mean, ggx_schlick_mean(alpha, masking), isotropic);
    y[1] = vec4f(ggx_bounces(x[1].xyz, x[1].w), 0.0);
";

fn means_inputs() -> Vec<[Vec4; 2]> {
    let mut inputs = Vec::new();
    for alpha in widths() {
        for m in MASKINGS {
            for (i, mu) in grid::COSINES.into_iter().enumerate() {
                let f = [Vec3::new(-0.1, 0.0, 0.5), Vec3::new(0.9, 1.0, 1.2)][i % 2];
                inputs.push([alpha.extend(m).extend(mu), v4(f, [0.0, 1e-3, 0.3, 0.6][i % 4])]);
            }
        }
    }
    inputs
}

fn means(x: &[Vec4; 2]) -> [Vec4; 2] {
    let (alpha, m) = (alpha(&x[0]), masking(&x[0]));
    let means = Vec2::new(loss_mean(alpha, m), schlick_mean(alpha, m));
    let isotropic = (albedo(x[0].w, alpha.x, m), albedo_mean(alpha.y, m));
    [means.extend(isotropic.0).extend(isotropic.1), v4(bounces(x[1].truncate(), x[1].w), 0.0)]
}
