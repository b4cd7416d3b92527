//! Things for a table: goblet, bowl, teapot. Their feet stand on y = 0.

use glam::{Affine3A, Quat, Vec2, Vec3};

use super::{Corner, Curve, Profile, bent, combined, revolve, transformed};
use crate::scene::Mesh;

/// A goblet `height` metres high on a stem with a knob, its cup hollow.
pub fn goblet(height: f32, segments: usize) -> Mesh {
    let h = height;
    let corner = |x: f32, y: f32, radius: f32| Corner::round(x * h, y * h, radius * h);
    let outline = [
        corner(0.0, 0.47, 0.0),
        corner(0.2, 0.47, 0.16),
        corner(0.232, 1.0, 0.004),
        corner(0.245, 1.0, 0.004),
        corner(0.22, 0.43, 0.17),
        corner(0.035, 0.42, 0.03),
        corner(0.026, 0.31, 0.02),
        corner(0.07, 0.27, 0.022),
        corner(0.028, 0.22, 0.02),
        corner(0.03, 0.055, 0.07),
        corner(0.2, 0.03, 0.008),
        corner(0.205, 0.0, 0.0),
        corner(0.0, 0.0, 0.0),
    ];
    revolve("goblet", &Profile::rounded(&outline, 9), segments)
}

/// A bowl of `radius` metres on a foot, hollow.
pub fn bowl(radius: f32, segments: usize) -> Mesh {
    let r = radius;
    let corner = |x: f32, y: f32, radius: f32| Corner::round(x * r, y * r, radius * r);
    let outline = [
        corner(0.0, 0.16, 0.0),
        corner(0.62, 0.16, 0.45),
        corner(0.94, 0.72, 0.02),
        corner(1.0, 0.735, 0.025),
        corner(0.68, 0.1, 0.5),
        corner(0.36, 0.09, 0.02),
        corner(0.4, 0.0, 0.0),
        corner(0.0, 0.0, 0.0),
    ];
    revolve("bowl", &Profile::rounded(&outline, 14), segments)
}

/// The body of a teapot with its lid, without spout and handle: `radius` metres at its belly.
fn pot(radius: f32, segments: usize) -> Mesh {
    let r = radius;
    let corner = |x: f32, y: f32, radius: f32| Corner::round(x * r, y * r, radius * r);
    // A round belly between a flat top under the lid and a low foot.
    let belly = Vec2::new(0.38, 0.61) * r;
    let body = Profile::new()
        .to(Vec2::new(0.0, 1.15 * r))
        .to(Vec2::new(0.6 * r, 1.15 * r))
        .arc(Vec2::new(0.62, 1.15) * r, 0.022 * r, std::f32::consts::PI, -0.2, 8)
        .arc(belly, 0.6 * r, 1.06, -1.2, 28)
        .to(Vec2::new(0.62, 0.0) * r)
        .to(Vec2::ZERO);
    let lid = [
        corner(0.0, 1.62, 0.0),
        corner(0.13, 1.62, 0.1),
        corner(0.13, 1.44, 0.08),
        corner(0.05, 1.39, 0.04),
        corner(0.5, 1.3, 0.2),
        corner(0.585, 1.16, 0.03),
        corner(0.585, 1.1, 0.0),
        corner(0.0, 1.1, 0.0),
    ];
    let lid = revolve("lid", &Profile::rounded(&lid, 10), segments);
    combined("pot", [revolve("body", &body, segments), lid])
}

/// A teapot of `radius` metres at its belly, its spout towards +x.
pub fn teapot(radius: f32, segments: usize) -> Mesh {
    let around = segments / 3;
    let point = |x: f32, y: f32| Vec2::new(x, y) * radius;
    let spout = Curve([point(0.8, 0.42), point(1.45, 0.4), point(1.2, 1.05), point(1.66, 1.18)]);
    let handle = Curve([point(-0.7, 1.03), point(-1.85, 1.35), point(-1.75, 0.3), point(-0.85, 0.36)]);
    combined(
        "teapot",
        [pot(radius, segments), spout_tube(radius, &spout, around), rod(0.085 * radius, &handle, around)],
    )
}

/// A tube that is wide at its root, open and thin at its end.
fn spout_tube(radius: f32, curve: &Curve, around: usize) -> Mesh {
    let length = curve.length();
    let (root, tip, wall) = (0.27 * radius, 0.12 * radius, 0.022 * radius);
    let lip = Vec2::new(tip, length - wall);
    // From the inside of the open end over the lip down the outside to the root.
    let profile = Profile::new()
        .to(Vec2::new(0.0, 0.6 * length))
        .to(Vec2::new(tip - wall, 0.6 * length))
        .line(Vec2::new(tip - wall, lip.y), 10)
        .arc(lip, wall, std::f32::consts::PI, 0.0, 8)
        .line(Vec2::new(root, 0.0), 32)
        .to(Vec2::ZERO);
    bent(revolve("spout", &profile, around), length, curve)
}

/// A round rod along a curve, `radius` metres thick, with round ends.
pub fn rod(radius: f32, curve: &Curve, around: usize) -> Mesh {
    let length = curve.length();
    let quarter = std::f32::consts::FRAC_PI_2;
    let profile = Profile::new()
        .arc(Vec2::new(0.0, length - radius), radius, quarter, 0.0, 6)
        .line(Vec2::new(radius, radius), 40)
        .arc(Vec2::new(0.0, radius), radius, 0.0, -quarter, 6);
    bent(revolve("rod", &profile, around), length, curve)
}

/// An abstract standing figure of `height` metres, which turns on its hips and raises one arm.
pub fn figure(height: f32, segments: usize) -> Mesh {
    let h = height;
    let corner = |x: f32, y: f32, radius: f32| Corner::round(x * h, y * h, radius * h);
    let body = [
        corner(0.0, 0.87, 0.0),
        corner(0.038, 0.87, 0.01),
        corner(0.036, 0.8, 0.04),
        corner(0.165, 0.775, 0.05),
        corner(0.15, 0.66, 0.1),
        corner(0.082, 0.56, 0.14),
        corner(0.17, 0.42, 0.14),
        corner(0.105, 0.14, 0.3),
        corner(0.17, 0.0, 0.02),
        corner(0.0, 0.0, 0.0),
    ];
    let body = revolve("body", &Profile::rounded(&body, 16), segments);
    let flat = transformed(body, &Affine3A::from_scale(Vec3::new(1.0, 1.0, 0.62)));
    let head = transformed(
        super::sphere(0.5, segments / 2),
        &Affine3A::from_scale_rotation_translation(
            Vec3::new(0.13, 0.175, 0.15) * h,
            Quat::from_rotation_z(-0.18) * Quat::from_rotation_y(0.5),
            Vec3::new(0.012, 0.925, 0.01) * h,
        ),
    );
    let point = |x: f32, y: f32| Vec2::new(x, y) * h;
    // The shoulders stand about 1 radian further than the feet.
    let raised = Curve([point(0.1, 0.74), point(0.26, 0.72), point(0.3, 0.86), point(0.13, 1.1)]);
    let resting = Curve([point(-0.11, 0.745), point(-0.27, 0.68), point(-0.26, 0.5), point(-0.07, 0.47)]);
    let turn = Affine3A::from_rotation_y(TWIST * 0.75);
    let arms = [raised, resting].map(|curve| transformed(rod(0.036 * h, &curve, segments / 3), &turn));
    let [raised, resting] = arms;
    combined("figure", [super::twisted(flat, TWIST / h), head, raised, resting])
}

/// Radians by which a figure turns from its feet to its head.
const TWIST: f32 = 1.1;
