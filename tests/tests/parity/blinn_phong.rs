//! Powers of the cosine: lobe, density, sampling.

use burnish_core::surface::blinn_phong::{self, Variant};
use glam::{Vec2, Vec3, Vec4};

use crate::curves::{self, Curves};
use crate::grid::{self, v4};
use crate::harness::{Case, Tolerance};

/// Exponents within and outside of the domain.
const EXPONENTS: [f32; 9] = [-1.0, 0.0, 0.5, 5.0, 32.0, 512.0, 1e4, 1e5, 1e7];

/// The exponent magnifies the rounding of a direction: 17 in the logarithm where a value is e^-17 of its peak.
const MAGNIFIED: Tolerance = Tolerance { relative: 3e-4, ..Tolerance::DEFAULT };

pub fn cases() -> Vec<Case> {
    let leaf = &blinn_phong::WGSL;
    vec![
        Case::new("blinn-phong: numbers of an exponent", leaf, NUMBERS, numbers_inputs, numbers),
        Case::new("blinn-phong: logarithm and exponential near their limits", leaf, RESTS, rests_inputs, rests),
        Case::new("blinn-phong: two directions", leaf, TWO, double, two).with(curves::WGSL).within(MAGNIFIED),
        Case::new("blinn-phong: sampling", leaf, SAMPLE, sampled, sample),
    ]
}

fn variant(x: f32) -> Variant {
    Variant::ALL[x as usize - 1]
}

const NUMBERS: &str = "
    let s = x[0].x;
    let variant = u32(x[0].y);
    y[0].x = blinn_phong_clamp_exponent(s);
    y[0].y = blinn_phong_alpha(s);
    y[0].z = blinn_phong_exponent(x[0].z);
    y[0].w = blinn_phong_normalizer(s, variant);
    y[1].x = blinn_phong_cosine_share(s, variant);
    y[1].y = blinn_phong_albedo(x[0].w, s, variant);
    y[1].z = blinn_phong_albedo_mean(s, variant);
";

fn numbers_inputs() -> Vec<[Vec4; 1]> {
    let mut inputs = Vec::new();
    for exponent in EXPONENTS {
        for variant in Variant::ALL {
            for (i, mu) in grid::COSINES.into_iter().enumerate() {
                let width = [0.0, 1e-3, 0.05, 0.3, 1.0, 2.0][i % 6];
                inputs.push([Vec4::new(exponent, variant as u32 as f32, width, mu)]);
            }
        }
    }
    inputs
}

fn numbers(x: &[Vec4; 1]) -> [Vec4; 2] {
    let (s, variant) = (x[0].x, variant(x[0].y));
    let clamped = blinn_phong::clamp_exponent(s);
    let widths = Vec2::new(blinn_phong::alpha(s), blinn_phong::exponent(x[0].z));
    let normalizer = blinn_phong::normalizer(s, variant);
    let (albedo, mean) = (blinn_phong::albedo(x[0].w, s, variant), blinn_phong::albedo_mean(s, variant));
    let shares = Vec3::new(blinn_phong::cosine_share(s, variant), albedo, mean);
    [Vec4::new(clamped, widths.x, widths.y, normalizer), v4(shares, 0.0)]
}

const RESTS: &str = "
    y[0].x = blinn_phong_log_rest(x[0].x);
    y[0].y = blinn_phong_exp_rest(x[0].y);
";

/// In WGSL alone: Rust has `ln_1p` and `exp_m1`.
fn rests_inputs() -> Vec<[Vec4; 1]> {
    let small = (0..40).map(|i| 10.0f32.powf(-6.0 + 0.15 * i as f32));
    small.map(|x| [Vec4::new(x.min(1.0 - f32::EPSILON / 2.0), 3.0 * x, 0.0, 0.0)]).collect()
}

fn rests(x: &[Vec4; 1]) -> [Vec4; 1] {
    [Vec4::new((-x[0].x).ln_1p(), -(-x[0].y).exp_m1(), 0.0, 0.0)]
}

const TWO: &str = "
    let wo = x[0].xyz;
    let wi = x[1].xyz;
    let s = x[0].w;
    let variant = u32(x[1].w);
    y[0] = vec4f(blinn_phong_facet(wo, wi, s, variant), blinn_phong_pdf(wo, wi, s, variant), 0.0);
    y[0].w = blinn_phong_power(normalize(wo + vec3f(0.0, 0.0, 2.0)), s);
    y[1] = vec4f(blinn_phong_eval(wo, wi, s, variant, parity_curve(u32(x[2].x))), 0.0);
";

/// A share of the pairs for every exponent and variant.
fn double() -> Vec<[Vec4; 3]> {
    let mut inputs = Vec::new();
    for exponent in EXPONENTS {
        for variant in Variant::ALL {
            let first = inputs.len() % 5;
            for (wo, wi) in grid::pairs().into_iter().skip(first).step_by(5) {
                let curve = (inputs.len() % curves::COUNT) as f32;
                inputs.push([v4(wo, exponent), v4(wi, variant as u32 as f32), grid::one(curve)]);
            }
        }
    }
    inputs
}

fn two(x: &[Vec4; 3]) -> [Vec4; 2] {
    let (wo, wi, s, variant) = (x[0].truncate(), x[1].truncate(), x[0].w, variant(x[1].w));
    let fresnel = &Curves::get().all[x[2].x as usize].fresnel;
    let facet = blinn_phong::facet(wo, wi, s, variant);
    let power = blinn_phong::power((wo + 2.0 * Vec3::Z).normalize(), s);
    let first = facet.extend(blinn_phong::pdf(wo, wi, s, variant)).extend(power);
    [first, v4(blinn_phong::eval(wo, wi, s, variant, fresnel), 0.0)]
}

const SAMPLE: &str = "
    let s = x[0].w;
    let variant = u32(x[1].z);
    y[0] = vec4f(blinn_phong_sample_wm(s, x[1].xy), 0.0);
    let wi = blinn_phong_sample_wi(x[0].xyz, s, variant, x[1].xy);
    y[1] = select(vec4f(0.0), vec4f(wi, 1.0), wi.z > 0.0);
    y[2].x = blinn_phong_half_vector(x[0].xyz, vec3f(0.0, 0.0, 1.0)).w;
";

/// Where a direction ends near the horizon or a number of the square near the share, rounding decides: left out.
fn sampled() -> Vec<[Vec4; 2]> {
    let mut inputs = Vec::new();
    for wo in grid::directions() {
        for exponent in EXPONENTS {
            for variant in Variant::ALL {
                let share = blinn_phong::cosine_share(exponent, variant);
                for u in grid::square().into_iter().skip(inputs.len() % 7).step_by(7) {
                    let wm = blinn_phong::sample_wm(exponent, u);
                    let z = 2.0 * wo.dot(wm) * wm.z - wo.z;
                    if z.abs() > 1e-4 && wo.dot(wm).abs() > 1e-4 && (u.y - share).abs() > 1e-4 {
                        inputs.push([v4(wo, exponent), u.extend(variant as u32 as f32).extend(0.0)]);
                    }
                }
            }
        }
    }
    inputs
}

fn sample(x: &[Vec4; 2]) -> [Vec4; 3] {
    let (wo, s, u, variant) = (x[0].truncate(), x[0].w, Vec2::new(x[1].x, x[1].y), variant(x[1].z));
    let wi = blinn_phong::sample_wi(wo, s, variant, u);
    let cosine = if wo.z > 0.0 { 0.5 * (wo + Vec3::Z).length() } else { 0.0 };
    [v4(blinn_phong::sample_wm(s, u), 0.0), wi.map_or(Vec4::ZERO, |wi| v4(wi, 1.0)), grid::one(cosine)]
}
