//! Directions, widths and combinations that the cases share: ordinary ones, and the limits.

use glam::{Vec2, Vec3, Vec4};

/// Normal incidence, ordinary angles, grazing ones, the horizon and below.
pub const COSINES: [f32; 10] = [1.0, 0.999, 0.9, 0.6, 0.2, 0.03, 1e-3, 1e-5, 0.0, -0.3];

/// Widths within and outside of the domain: mirror, floor, grooves both ways, the largest.
pub const ALPHAS: [Vec2; 8] = [
    Vec2::new(0.0, 0.0),
    Vec2::new(1e-3, 1e-3),
    Vec2::new(0.02, 0.02),
    Vec2::new(0.3, 0.3),
    Vec2::new(0.05, 0.6),
    Vec2::new(0.6, 0.05),
    Vec2::new(1e-3, 1.0),
    Vec2::new(1.0, 1.0),
];

/// Numbers of both maskings.
pub const MASKINGS: [f32; 2] = [0.0, 1.0];

/// Local unit vectors: every cosine, on the axes and between them.
pub fn directions() -> Vec<Vec3> {
    let around = [0.0_f32, 0.7, std::f32::consts::FRAC_PI_2, 2.9, 4.4];
    let mut all = Vec::new();
    for z in COSINES {
        let sin_theta = ((1.0 - z) * (1.0 + z)).sqrt();
        let azimuths = if z == 1.0 { &around[..1] } else { &around };
        all.extend(azimuths.iter().map(|&phi| (sin_theta * Vec2::from_angle(phi)).extend(z)));
    }
    all
}

/// Unit vectors all over the sphere, axes and poles among them.
pub fn sphere() -> Vec<Vec3> {
    let mut all: Vec<Vec3> = directions().into_iter().flat_map(|d| [d, -d]).collect();
    all.extend([Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z]);
    all
}

/// `(wo, wi)`: every pair of [`directions`], and mirrored ones a little apart, where narrow lobes are.
pub fn pairs() -> Vec<(Vec3, Vec3)> {
    let mut all = Vec::new();
    for wo in directions() {
        all.extend(directions().into_iter().map(|wi| (wo, wi)));
        let mirrored = Vec3::new(-wo.x, -wo.y, wo.z);
        for apart in [0.0, 5e-4, 3e-3, 0.04] {
            all.push((wo, (mirrored + apart * Vec3::new(0.6, -0.7, 0.4)).normalize()));
        }
    }
    all
}

/// Points of the unit square, its limits and middle among them.
pub fn square() -> Vec<Vec2> {
    // The largest is the largest number below one.
    let u = [0.0, 1e-6, 0.1, 0.25, 0.37, 0.5, 0.62, 0.75, 0.9, 0.98, 1.0 - f32::EPSILON / 2.0];
    u.iter().flat_map(|&x| u.map(|y| Vec2::new(x, y))).collect()
}

/// A vector with a last number.
pub fn v4(v: Vec3, w: f32) -> Vec4 {
    v.extend(w)
}

/// A number in all places but the first zero: for cases with one result.
pub fn one(x: f32) -> Vec4 {
    Vec4::new(x, 0.0, 0.0, 0.0)
}
