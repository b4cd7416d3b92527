//! Backgrounds on a ground.

use burnish_core::scene::environment::ground::{self, ground_project};
use glam::{Vec3, Vec4};

use crate::harness::{Case, Tolerance};

pub fn cases() -> Vec<Case> {
    vec![
        Case::new("ground: where rays leave the dome or meet the disc", &ground::LEAF, PROJECT, rays, |x| {
            [ground_project(x[0].truncate(), x[1].truncate(), x[2].truncate(), x[0].w, x[1].w)]
        })
        // Differences of squares of distances far outside of the dome.
        .within(Tolerance { relative: 1e-3, absolute: 2e-4 }),
    ]
}

const PROJECT: &str = "
    y[0] = ground_project(x[0].xyz, x[1].xyz, x[2].xyz, x[0].w, x[1].w);
";

/// Eyes within the dome, outside of it, under the ground and in the centre, in directions all around.
fn rays() -> Vec<[Vec4; 3]> {
    let center = Vec3::new(0.5, 1.1, -0.25);
    let eyes = [
        center,
        Vec3::new(3.0, 0.4, 2.0),
        Vec3::new(-6.0, 5.0, 1.0),
        Vec3::new(0.0, -3.0, 0.0),
        Vec3::new(40.0, 2.0, 7.0),
        Vec3::new(0.0, 60.0, 0.0),
    ];
    let mut inputs = Vec::new();
    for eye in eyes {
        for i in 0..500 {
            let y = 1.0 - (i as f32 + 0.5) / 250.0;
            let (sin, cos) = (2.399_963 * i as f32).sin_cos();
            let level = (1.0 - y * y).sqrt();
            let direction = Vec3::new(level * cos, y, level * sin).normalize();
            inputs.push([eye.extend(1.6), direction.extend(15.0), center.extend(0.0)]);
        }
    }
    inputs
}
