//! Rectangles and spheres that shine.

use burnish_core::lighting::area::{self, Cosines, Shape};
use burnish_core::math::frame::Frame;
use burnish_core::surface::ggx::Masking;
use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};

use crate::grid::v4;
use crate::harness::{Case, Tolerance};
use crate::surface;

pub fn cases() -> Vec<Case> {
    // Sums of edges cancel where a light is small or far from the lobe, and the ratio of two densities doubles that.
    let tolerance = Tolerance { relative: 2e-3, absolute: 2e-5 };
    vec![
        Case::new("area: a surface under rectangles and spheres", &area::WGSL, RESPONSE, inputs, |x| {
            let s = surface::unpack(x);
            let [wo, coat_wo] = [x[4], x[5]].map(Vec4::xyz);
            let frame = Frame::new(Vec3::Z);
            let (base, coat) = (shape(x[6], x[7]), shape(coat_turned(x[6]), x[7]));
            let (Some(base), Some(coat)) = (base, coat) else { return [Vec4::ZERO; 2] };
            let respond =
                |reflections| area::response(&s, wo, &base.local(&frame), coat_wo, &coat.local(&frame), reflections);
            [v4(respond(true), 0.0), v4(respond(false), 0.0)]
        })
        .with(HELPERS)
        .within(tolerance),
        Case::new("area: the lobe of cosines", &area::WGSL, COSINES, lobes, |x| {
            let masking = Masking::ALL[x[0].w as usize];
            let lobe = Cosines::new(x[0].xyz(), x[2].xy(), masking);
            [v4(lobe.shape(x[1].xyz()), lobe.density(x[1].xyz())), v4(Vec3::ZERO, lobe.above())]
        })
        // A lobe a thousandth wide raises roundings of directions a thousandfold.
        .within(Tolerance { relative: 2e-2, absolute: 1e-5 }),
    ]
}

/// The surface, and a light of two vectors.
const HELPERS: &str = concat!(
    include_str!("curves.wgsl"),
    include_str!("surface.wgsl"),
    "
fn parity_shape(center: vec4f, sizes: vec4f) -> AreaShape {
    if center.w >= 0.0 { return area_sphere(center.xyz, center.w); }
    let direction = -center.xyz / length(center.xyz);
    return area_rectangle(center.xyz, direction, frame_new(direction).t, sizes.xy);
}
"
);

const RESPONSE: &str = "
    let s = parity_surface(x[0], x[1], x[2], x[3]);
    let frame = frame_new(vec3f(0.0, 0.0, 1.0));
    let turned = vec4f(x[6].x, 0.98 * x[6].y - 0.19899749 * x[6].z, 0.19899749 * x[6].y + 0.98 * x[6].z, x[6].w);
    let base = parity_shape(x[6], x[7]);
    let coat = parity_shape(turned, x[7]);
    if base.kind != AREA_NOTHING && coat.kind != AREA_NOTHING {
        let b = area_local(base, frame);
        let c = area_local(coat, frame);
        y[0] = vec4f(area_response(s, x[4].xyz, b, x[5].xyz, c, true), 0.0);
        y[1] = vec4f(area_response(s, x[4].xyz, b, x[5].xyz, c, false), 0.0);
    }
";

const COSINES: &str = "
    let lobe = area_cosines(x[0].xyz, x[2].xy, u32(x[0].w));
    y[0] = vec4f(area_shape(lobe, x[1].xyz), area_density(lobe, x[1].xyz));
    y[1] = vec4f(0.0, 0.0, 0.0, area_above_horizon(lobe));
";

/// The middle of a light, turned a little as a coat with a normal of its own has it.
fn coat_turned(center: Vec4) -> Vec4 {
    let (sin, cos) = (0.198_997_49, 0.98);
    Vec4::new(center.x, cos * center.y - sin * center.z, sin * center.y + cos * center.z, center.w)
}

/// Middle and radius; a radius below zero stands for a rectangle of the sizes of `sizes` that looks at the point.
fn shape(center: Vec4, sizes: Vec4) -> Option<Shape> {
    if center.w >= 0.0 {
        return Shape::sphere(center.xyz(), center.w);
    }
    let direction = -center.xyz() / center.xyz().length();
    Shape::rectangle(center.xyz(), direction, Frame::new(direction).t, sizes.xy())
}

fn sizes() -> [(f32, Vec2); 7] {
    let rectangle = |x, y| (-1.0, Vec2::new(x, y));
    let sphere = |radius| (radius, Vec2::ZERO);
    [
        rectangle(1.0, 0.6),
        rectangle(0.2, 3.0),
        rectangle(20.0, 20.0),
        sphere(0.3),
        sphere(0.97),
        sphere(2.0),
        sphere(0.0),
    ]
}

/// Every surface under lights about its mirrored direction and elsewhere.
fn inputs() -> Vec<[Vec4; 8]> {
    let widths = [Vec2::splat(0.01), Vec2::splat(0.25), Vec2::new(0.1, 0.4), Vec2::ONE];
    let mut inputs = Vec::new();
    for (i, variant) in surface::variants(&widths).into_iter().enumerate() {
        let [a, b, c, d] = surface::pack(variant);
        for (j, theta) in [0.1_f32, 0.7, 1.3].into_iter().enumerate() {
            let wo = Vec3::new(theta.sin(), 0.0, theta.cos());
            let coat_wo = Vec3::new(theta.sin(), 0.1, theta.cos()).normalize();
            for (k, off) in [0.0_f32, 0.25, 0.8].into_iter().enumerate() {
                let to = theta + off;
                let (radius, size) = sizes()[(i + 2 * j + k) % 7];
                let center = Vec3::new(-to.sin(), 0.05 + 0.3 * off, to.cos());
                inputs.push([
                    a,
                    b,
                    c,
                    d,
                    v4(wo, 0.0),
                    v4(coat_wo, 0.0),
                    v4(center, radius),
                    size.extend(0.0).extend(0.0),
                ]);
            }
        }
    }
    inputs
}

fn lobes() -> Vec<[Vec4; 3]> {
    let mut inputs = Vec::new();
    for alpha in crate::grid::ALPHAS {
        for wo in crate::grid::directions().into_iter().filter(|wo| wo.z > 1e-3) {
            for off in [Vec3::ZERO, Vec3::new(0.1, 0.2, 0.1), Vec3::new(0.7, -0.4, 0.8)] {
                let w = (Vec3::new(-wo.x, -wo.y, wo.z) + off).normalize();
                for masking in crate::grid::MASKINGS {
                    inputs.push([v4(wo, masking), v4(w, 0.0), alpha.extend(0.0).extend(0.0)]);
                }
            }
        }
    }
    inputs
}
