//! Every form of the reflectance curve.

use burnish_core::surface::fresnel::{self, compensated, conductor, dielectric, exact, schlick, spectral};
use glam::{Vec3, Vec4};

use crate::curves::{self, Curves};
use crate::grid::{one, v4};
use crate::harness::{Case, Tolerance};

/// Against f64: what f32 makes of the sums and differences of squares of n and k.
const TRUTH: Tolerance = Tolerance { relative: 0.0, absolute: 4e-6 };

pub fn cases() -> Vec<Case> {
    let leaf = &fresnel::WGSL;
    vec![
        Case::new(
            "fresnel: Schlick's curve",
            leaf,
            "y[0] = vec4f(fresnel_schlick(x[0].xyz, x[1].x, x[1].y), 0.0);",
            schlick_inputs,
            |x| [v4(schlick(x[0].truncate(), x[1].x, x[1].y), 0.0)],
        ),
        Case::new(
            "fresnel: a dip of any exponent",
            leaf,
            "y[0] = vec4f(fresnel_compensated(vec3f(0.5), x[0].xyz, x[1].xyz, x[0].w), 0.0);",
            dips,
            |x| [v4(compensated(Vec3::splat(0.5), x[0].truncate(), x[1].truncate(), x[0].w), 0.0)],
        ),
        Case::new("fresnel: a conductor", leaf, CONDUCTOR, indices, |x| [one(conductor(x[0].x, x[0].y, x[0].z))]),
        Case::new("fresnel: a conductor is within 4e-6 of the truth in f64", leaf, CONDUCTOR, metals, |x| {
            [one(exact(x[0].x.into(), x[0].y.into(), x[0].z.into()) as f32)]
        })
        .within(TRUTH),
        Case::new("fresnel: a conductor is within 4e-6 of the reference values", leaf, CONDUCTOR, reference, |x| {
            [one(x[0].w)]
        })
        .within(TRUTH),
        Case::new(
            "fresnel: a dielectric from both sides",
            leaf,
            "y[0].x = fresnel_dielectric(x[0].x, x[0].y);",
            etas,
            |x| [one(dielectric(x[0].x, x[0].y))],
        ),
        Case::new("fresnel: a spectral table", leaf, SPECTRAL, || cosines(3), table).with(curves::WGSL),
        Case::new(
            "fresnel: every form",
            leaf,
            EVAL,
            || (0..curves::COUNT).flat_map(cosines).collect(),
            |x| {
                let curve = &Curves::get().all[x[0].x as usize];
                [v4(curve.fresnel.eval(x[0].y), 0.0)]
            },
        )
        .with(curves::WGSL),
    ]
}

/// 90 degrees, grazing, everything to normal incidence.
fn angles() -> impl Iterator<Item = f32> {
    [0.0, 1e-7, 1e-5, 1e-3, 0.01].into_iter().chain((1..=40).map(|i| i as f32 / 40.0))
}

fn schlick_inputs() -> Vec<[Vec4; 2]> {
    let colors = [Vec3::ZERO, Vec3::splat(0.04), Vec3::new(0.95, 0.64, 0.54), Vec3::ONE];
    let mut inputs = Vec::new();
    for f0 in colors {
        for f90 in [0.0, 0.5, 1.0] {
            inputs.extend(angles().chain([-0.5, 1.5]).map(|c| [v4(f0, 0.0), Vec4::new(f90, c, 0.0, 0.0)]));
        }
    }
    inputs
}

/// Strengths and exponents, small and large ones.
fn dips() -> Vec<[Vec4; 2]> {
    let mut inputs = Vec::new();
    for a in [Vec3::ZERO, Vec3::new(-1.0, 0.05, 5.0)] {
        for alpha in [Vec3::new(0.02, 0.5, 1.0), Vec3::new(2.0, 5.3, 6.0), Vec3::new(12.0, 40.0, 120.0)] {
            inputs.extend(angles().chain([-0.5, 1.5]).map(|c| [v4(a, c), v4(alpha, 0.0)]));
        }
    }
    inputs
}

const CONDUCTOR: &str = "y[0].x = fresnel_conductor(x[0].x, x[0].y, x[0].z);";

fn all_indices(ns: &[f32], ks: &[f32]) -> Vec<[Vec4; 1]> {
    let mut inputs = Vec::new();
    for &n in ns {
        for &k in ks {
            inputs.extend(angles().map(|c| [Vec4::new(n, k, c, 0.0)]));
        }
    }
    inputs
}

/// The domain, its limits, and beyond them.
fn indices() -> Vec<[Vec4; 1]> {
    let ns = [-1.0, 0.0, 1e-4, 0.03, 0.2, 0.7, 1.0, 1.5, 3.1, 9.0, 100.0, 1e3, 1e6];
    all_indices(&ns, &[-1.0, 0.0, 1e-3, 0.2, 1.0, 2.4, 3.6, 8.0, 20.0, 1e3, 1e6])
}

/// What metals have, 90 degrees included.
fn metals() -> Vec<[Vec4; 1]> {
    all_indices(
        &[0.03, 0.06, 0.13, 0.2, 0.5, 0.7, 1.0, 1.5, 2.9, 3.5, 6.0],
        &[0.1, 0.5, 1.0, 1.9, 2.4, 3.6, 5.0, 8.0, 20.0],
    )
}

/// Rows of `name, n, k, cos_theta, reflectance`.
fn reference() -> Vec<[Vec4; 1]> {
    let rows = include_str!("../../data/reference/fresnel_exact.csv").lines().skip(1);
    rows.map(|row| {
        let fields: Vec<f32> = row.split(',').skip(1).map(|field| field.parse().unwrap()).collect();
        [Vec4::from_slice(&fields)]
    })
    .collect()
}

/// Out of glass and water and into them, total reflection among it.
fn etas() -> Vec<[Vec4; 1]> {
    let etas = [1.0 / 2.4, 1.0 / 1.5, 0.75, 1.0, 1.33, 1.5, 2.4];
    etas.iter().flat_map(|&eta| angles().chain([-0.5, 1.5]).map(move |c| [Vec4::new(eta, c, 0.0, 0.0)])).collect()
}

const SPECTRAL: &str = "y[0] = vec4f(fresnel_spectral(parity_curve(u32(x[0].x)).table, x[0].y), 0.0);";

const EVAL: &str = "y[0] = vec4f(fresnel_eval(parity_curve(u32(x[0].x)), x[0].y), 0.0);";

/// A curve at its nodes, between them and outside.
fn cosines(curve: usize) -> Vec<[Vec4; 1]> {
    let cosines = (-51..=1071).map(|i| i as f32 / 1020.0).chain(angles());
    cosines.map(|c| [Vec4::new(curve as f32, c, 0.0, 0.0)]).collect()
}

fn table(x: &[Vec4; 1]) -> [Vec4; 1] {
    match &Curves::get().all[x[0].x as usize].fresnel {
        fresnel::Fresnel::Spectral { table } => [v4(spectral(table, x[0].y), 0.0)],
        other => panic!("{other:?} has no table"),
    }
}
