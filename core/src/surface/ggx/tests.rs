use std::f64::consts::PI;

use glam::{Vec2, Vec3};

use super::*;
use crate::math::quadrature::GaussLegendre;

/// Widths from the floor to 1, steady in roughness.
fn alphas() -> Vec<f32> {
    let floor = ALPHA_MIN.sqrt();
    (0..20).map(|i| (floor + (1.0 - floor) * i as f32 / 19.0).powi(2)).collect()
}

/// Twenty directions from normal to 89.99 degrees at azimuth `phi`.
fn views(phi: f32) -> Vec<Vec3> {
    (0..20)
        .map(|i| {
            let theta = (89.99f32 * i as f32 / 19.0).to_radians();
            (theta.sin() * Vec2::from_angle(phi)).extend(theta.cos())
        })
        .collect()
}

/// White metal.
const WHITE: Fresnel = Fresnel::Rescaled { f0: Vec3::ONE };

/// Share of light that single scattering returns toward `wo`, by `n^2` points of its sampler.
fn single(wo: Vec3, alpha: Vec2, masking: Masking, n: u32) -> f64 {
    let mut sum = 0.0;
    for i in 0..n * n {
        let u = Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32;
        if let Some(s) = sample(wo, alpha, &WHITE, masking, u) {
            sum += f64::from(s.value.x * s.wi.z / s.pdf);
        }
    }
    sum / f64::from(n * n)
}

/// Share of light that multiple scattering returns toward `wo`.
fn more(wo: Vec3, alpha: Vec2, masking: Masking, polar: &GaussLegendre, around: u32) -> f64 {
    let mut sum = 0.0;
    for &(t, weight) in polar.nodes() {
        let mu = t.powi(4);
        let r = ((1.0 - mu) * (1.0 + mu)).sqrt() as f32;
        for j in 0..around {
            let phi = std::f32::consts::TAU * (j as f32 + 0.5) / around as f32;
            let wi = (r * Vec2::from_angle(phi)).extend(mu as f32);
            let value = f64::from(multiple(wo, wi, alpha, Vec3::ONE, masking).x);
            sum += weight * 8.0 * PI * mu * t.powi(3) * value / f64::from(around);
        }
    }
    sum
}

#[test]
fn explore() {
    let start = std::time::Instant::now();
    let flat = albedo::AlbedoTable::get().flat();
    println!("table {} entries {:?}", flat.len(), start.elapsed());
    let rule = GaussLegendre::new(48);
    for masking in Masking::ALL {
        for alpha in alphas() {
            let (mut l, mut h) = (9.0f64, 0.0f64);
            for wo in views(0.0) {
                let m = more(wo, Vec2::splat(alpha), masking, &rule, 1);
                let s = single(wo, Vec2::splat(alpha), masking, 64);
                l = l.min(s + m);
                h = h.max(s + m);
            }
            println!("{masking:?} {alpha:.4} {l:.4} {h:.4}");
        }
        for alpha in [Vec2::new(0.1, 0.001), Vec2::new(0.3, 0.05), Vec2::new(0.5, 0.1), Vec2::new(1.0, 0.01), Vec2::new(1.0, 0.1), Vec2::new(1.0, 0.3), Vec2::new(1.0, 0.6), Vec2::new(0.6, 0.3)] {
            let mut text = String::new();
            for phi in [0.0f32, 0.4, 0.785, 1.2, 1.5708] {
                let (mut lo, mut hi) = (9.0f64, -9.0f64);
                for wo in views(phi) {
                    let s = single(wo, alpha, masking, 64);
                    let e = s + more(wo, alpha, masking, &rule, 32);
                    lo = lo.min(e); hi = hi.max(e);
                }
                text += &format!("  {phi:.1} {lo:.4} {hi:.4}");
            }
            println!("{masking:?} {alpha} {text}");
        }
    }
}
