//! The whole surface under one light.

use burnish_core::surface::layered;
use glam::{Quat, Vec2, Vec3, Vec4};

use crate::grid::{self, v4};
use crate::harness::Case;
use crate::surface::{self, Variant};

pub fn cases() -> Vec<Case> {
    vec![
        Case::new(
            "layered: metal, dielectric and a coat with a normal of its own",
            &layered::WGSL,
            RESPONSE,
            inputs,
            |x| {
                let s = surface::unpack(x);
                let [wo, wi, coat_wo, coat_wi] = [x[4], x[5], x[6], x[7]].map(Vec4::truncate);
                let response = layered::response(&s, wo, wi, coat_wo, coat_wi);
                let share = layered::lobe_albedo(&s, wo);
                [v4(response, 0.0), v4(layered::base(&s, wo, wi), 0.0), v4(layered::matte_albedo(&s, wo), share)]
            },
        )
        .with(surface::WGSL),
    ]
}

const RESPONSE: &str = "
    let s = parity_surface(x[0], x[1], x[2], x[3]);
    y[0] = vec4f(layered_response(s, x[4].xyz, x[5].xyz, x[6].xyz, x[7].xyz), 0.0);
    y[1] = vec4f(layered_base(s, x[4].xyz, x[5].xyz), 0.0);
    y[2] = vec4f(layered_matte_albedo(s, x[4].xyz), layered_lobe_albedo(s, x[4].xyz));
";

fn variants() -> Vec<Variant> {
    let widths = [Vec2::splat(1e-3), Vec2::new(0.3, 0.3), Vec2::new(0.05, 0.5), Vec2::ONE];
    surface::variants(&widths)
}

/// Every surface under a share of the pairs, each pair with a share of the surfaces.
fn inputs() -> Vec<[Vec4; 8]> {
    let coat_from_base = Quat::from_axis_angle(Vec3::new(0.6, -0.8, 0.0), 0.2);
    let pairs = grid::pairs();
    let mut inputs = Vec::new();
    for (i, variant) in variants().into_iter().enumerate() {
        let [a, b, c, d] = surface::pack(variant);
        for (wo, wi) in pairs.iter().skip(i % 7).step_by(7) {
            let turned = [*wo, *wi, coat_from_base * *wo, coat_from_base * *wi];
            let [wo, wi, coat_wo, coat_wi] = turned.map(|w| v4(w, 0.0));
            inputs.push([a, b, c, d, wo, wi, coat_wo, coat_wi]);
        }
    }
    inputs
}
