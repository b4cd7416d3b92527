//! Localised glossy and diffuse lighting.

use burnish_core::lighting::area_cube::tables::{self, Normals};
use burnish_core::lighting::area_cube::{
    self, Asked, Cap, Lobe, Looked, NUMBERS, Texel, Texels, glossy, localised, localised_solid_angle, neighbour,
    reflected, texel_at,
};
use burnish_core::math::frame::Frame;
use burnish_core::surface::ggx::Masking;
use burnish_core::surface::layered;
use glam::{Quat, Vec2, Vec3, Vec4, Vec4Swizzles};

use crate::grid::{self, one, v4};
use crate::harness::{Case, Tolerance};
use crate::surface;

/// Solid angle, distance from the middle and from the point, localised solid angle.
const REFERENCE: &str = include_str!("../../data/reference/localised_solid_angle.csv");

pub fn cases() -> Vec<Case> {
    let leaf = &area_cube::WGSL;
    vec![
        Case::new("area cube: localised solid angles", leaf, SOLID_ANGLE, solid_angles, |x| {
            [one(localised_solid_angle(x[0].x, x[0].y, x[0].z))]
        }),
        Case::new("area cube: localised solid angles of the reference values", leaf, SOLID_ANGLE, references, |x| {
            // What the file says.
            [one(x[0].w)]
        })
        .within(Tolerance { relative: 1e-5, absolute: 0.0 }),
        Case::new("area cube: texels as points see them", leaf, LOCALISED, points, |x| {
            let texel = Texel::new(x[0].xyz(), x[0].w, x[1].w, x[2].xyz(), Vec3::ZERO);
            [true, false].map(|corrected| {
                let cap = localised(&texel, x[1].xyz(), corrected);
                v4(cap.direction, cap.share)
            })
        })
        .with(HELPERS),
        Case::new("area cube: tables of lobes over caps", leaf, TABLES, tables_inputs, |x| {
            let kinds = [Normals::Ggx, Normals::BlinnPhong];
            let [ggx, power] = kinds.map(|kind| tables::normals(kind, x[0].z, x[0].w, x[0].x));
            [Vec4::new(tables::lambert(x[0].x, x[0].y), ggx, power, 0.0)]
        }),
        Case::new("area cube: lobes over caps", leaf, GLOSSY, lobes, |x| {
            let s = surface::unpack(x);
            let lobe = Lobe { kind: s.lobe, alpha: s.alpha.x, masking: s.masking };
            let cap = Cap { direction: x[5].xyz(), share: x[5].w };
            let found = glossy(&lobe, x[4].xyz(), &cap, tables::lambert(cap.share, cap.direction.z), false);
            let middle = glossy(&lobe, x[4].xyz(), &cap, tables::lambert(cap.share, cap.direction.z), true);
            [found.extend(middle.x).extend(middle.y)]
        })
        .with(surface::WGSL)
        // A lobe a thousandth wide raises roundings of directions a thousandfold.
        .within(Tolerance { relative: 2e-2, absolute: 1e-4 }),
        Case::new("area cube: numbers of texels", leaf, NUMBERS_WGSL, directions, |x| {
            let edge = x[0].w as u32;
            let index = texel_at(x[0].xyz(), edge);
            let beside = [0, 1, 2, 3].map(|side| neighbour(index, side, edge) as f32);
            [one(index as f32), Vec4::from_array(beside)]
        })
        .within(Tolerance::EXACT),
        Case::new("area cube: the light of whole surfaces", leaf, REFLECTED, surfaces, |x| {
            let s = surface::unpack(x);
            let frame = |i: usize| Frame { t: x[i].xyz(), b: x[i + 1].xyz(), n: x[i + 2].xyz() };
            let flags = x[11].w as u32;
            let asked = Asked {
                few: flags & 1 != 0,
                corrected: flags & 2 != 0,
                normalized: flags & 4 != 0,
                middles: flags & 8 != 0,
            };
            let at = Looked { x: x[11].xyz(), base: x[12].xyz(), coat: x[13].xyz() };
            let numbers: Vec<f32> = (0..24).flat_map(texel).chain((0..96).flat_map(texel)).collect();
            let texels = Texels::of(&numbers, x[12].w as u32).expect("two cubes are there");
            [v4(reflected(&texels, &s, &frame(5), &frame(8), x[4].xyz(), x[4].w, &at, asked), 0.0)]
        })
        .with(surface::WGSL)
        .within(Tolerance { relative: 2e-3, absolute: 1e-5 }),
    ]
}

/// The twin of `area_cube_texel` in externs.wgsl: numbers of a texel, some of the sky.
fn texel(index: u32) -> [f32; NUMBERS] {
    let i = index as f32;
    let place = Vec3::new((1.3 * i).sin(), (2.1 * i).cos(), (0.7 * i + 1.0).sin()) + Vec3::splat(0.05);
    let radiance = Vec3::new(1.2 + (0.9 * i).sin(), 0.8, 1.5 + (0.4 * i).cos());
    let texel = if index.is_multiple_of(7) {
        Texel { place: place.normalize(), spread: 0.0, normal: Vec3::ZERO, cosine: 0.97, radiance }
    } else {
        Texel { place, spread: 0.05 + 0.04 * (0.3 * i).sin(), normal: -1.2 * place.normalize(), cosine: 0.95, radiance }
    };
    texel.to_array()
}

/// What the middle knows of a texel: direction and solid angle; distance; normal.
const HELPERS: &str = "
fn parity_texel(direction: vec3f, solid_angle: f32, distance: f32, normal: vec3f) -> AreaCubeTexel {
    let w = solid_angle * 0.5 * INV_PI;
    let towards = dot(normal, direction);
    let turned = select(normal, -normal, towards > 0.0) / max(abs(towards), 0.1);
    let place = direction * select(1.0, distance, distance > 0.0);
    return AreaCubeTexel(place, w * (2.0 - w) * distance * distance, turned, 1.0 - w, vec3f(0.0));
}
";

const SOLID_ANGLE: &str = "
    y[0].x = area_cube_localised_solid_angle(x[0].x, x[0].y, x[0].z);
";

const LOCALISED: &str = "
    let texel = parity_texel(x[0].xyz, x[0].w, x[1].w, x[2].xyz);
    let on = area_cube_localised(texel, x[1].xyz, true);
    let off = area_cube_localised(texel, x[1].xyz, false);
    y[0] = vec4f(on.direction, on.share);
    y[1] = vec4f(off.direction, off.share);
";

const TABLES: &str = "
    y[0].x = area_cube_lambert(x[0].x, x[0].y);
    y[0].y = area_cube_normals(0u, x[0].z, x[0].w, x[0].x);
    y[0].z = area_cube_normals(1u, x[0].z, x[0].w, x[0].x);
";

const GLOSSY: &str = "
    let s = parity_surface(x[0], x[1], x[2], x[3]);
    let lit = area_cube_lambert(x[5].w, x[5].z);
    let found = area_cube_glossy(s.lobe, s.exponent, s.alpha.x, s.masking, x[4].xyz, x[5].xyz, x[5].w, lit, false);
    let middle = area_cube_glossy(s.lobe, s.exponent, s.alpha.x, s.masking, x[4].xyz, x[5].xyz, x[5].w, lit, true);
    y[0] = vec4f(found, middle);
";

const NUMBERS_WGSL: &str = "
    let edge = u32(x[0].w);
    let index = area_cube_texel_at(x[0].xyz, edge);
    y[0].x = f32(index);
    for (var side = 0u; side < 4u; side++) { y[1][side] = f32(area_cube_neighbour(index, side, edge)); }
";

const REFLECTED: &str = "
    let s = parity_surface(x[0], x[1], x[2], x[3]);
    let base = Frame(x[5].xyz, x[6].xyz, x[7].xyz);
    let coat = Frame(x[8].xyz, x[9].xyz, x[10].xyz);
    let flags = u32(x[11].w);
    let asked = AreaCubeAsked(u32(x[12].w), (flags & 1u) != 0u, (flags & 2u) != 0u, (flags & 4u) != 0u, (flags & 8u) != 0u);
    let looked = AreaCubeLooked(x[11].xyz, x[12].xyz, x[13].xyz);
    y[0] = vec4f(area_cube_reflected(s, base, coat, x[4].xyz, x[4].w, looked, asked), 0.0);
";

fn solid_angles() -> Vec<[Vec4; 1]> {
    let lengths = [0.0, 1e-6, 0.3, 1.0, 2.5, 1e6];
    let pairs = lengths.iter().flat_map(|from| lengths.map(|to| (*from, to)));
    pairs.flat_map(|(from, to)| [0.0, 1e-5, 0.02, 0.5, 6.0, 7.0].map(|w| [Vec4::new(w, from, to, 0.0)])).collect()
}

fn references() -> Vec<[Vec4; 1]> {
    let number = |text: &str| text.parse::<f32>().expect("a number");
    let rows = REFERENCE.lines().skip(1).map(|line| line.split(',').map(number).collect::<Vec<_>>());
    rows.map(|row| [Vec4::from_slice(&row)]).collect()
}

/// Texels of several sizes and distances, the sky among them, from the middle, beside it, and near a texel.
fn points() -> Vec<[Vec4; 3]> {
    let mut inputs = Vec::new();
    for (i, direction) in grid::sphere().into_iter().step_by(3).enumerate() {
        for (j, distance) in [0.0, 0.4, 1.0, 30.0].into_iter().enumerate() {
            let normal = grid::sphere()[(7 * i + 3 * j) % 50];
            let beside = [Vec3::ZERO, Vec3::new(0.3, -0.2, 0.1), 0.99 * distance * direction, distance * direction];
            let w = [0.001, 0.02, 0.13, 0.52][(i + j) % 4];
            inputs.extend(beside.map(|x| [v4(direction, w), v4(x, distance), v4(normal, 0.0)]));
        }
    }
    inputs
}

/// Share or cap, cosine, width, offset.
fn tables_inputs() -> Vec<[Vec4; 1]> {
    let mut inputs = Vec::new();
    for share in [0.0, 1e-6, 0.004, 0.08, 0.5, 1.0] {
        for cosine in [-1.0, -0.6, -0.1, 0.0, 0.05, 0.3, 0.9, 1.0] {
            for (alpha, offset) in [(1e-4, 0.01), (1e-3, 0.002), (0.09, 0.0), (0.3, 0.7), (1.0, 1.5)] {
                inputs.push([Vec4::new(share, cosine, alpha, offset)]);
            }
        }
    }
    inputs
}

fn lobes() -> Vec<[Vec4; 6]> {
    let widths = [1e-3, 0.03, 0.3, 1.0].map(Vec2::splat);
    let caps = grid::directions().into_iter().step_by(4);
    let caps: Vec<Vec4> = caps.zip([1e-3, 0.02, 0.1, 0.9].into_iter().cycle()).map(|(d, share)| v4(d, share)).collect();
    let mut inputs = Vec::new();
    for variant in surface::variants(&widths).into_iter().step_by(5) {
        let [a, b, c, d] = surface::pack(variant);
        for theta in [0.0f32, 0.8, 1.4] {
            let wo = Vec3::new(theta.sin(), 0.0, theta.cos());
            let mirrored = Vec3::new(-wo.x, 0.02, wo.z).normalize();
            inputs.extend(caps.iter().chain([&v4(mirrored, 0.03)]).map(|cap| [a, b, c, d, v4(wo, 0.0), *cap]));
        }
    }
    inputs
}

/// Between the edges of texels, which both languages would round as they like.
fn directions() -> Vec<[Vec4; 1]> {
    let inside = grid::sphere().into_iter().map(|d| (d + Vec3::new(0.0123, 0.0271, -0.0189)).normalize());
    inside.flat_map(|d| [2.0, 4.0, 8.0, 16.0].map(|edge| [v4(d, edge)])).collect()
}

/// Every surface, by all and by few texels, corrected and normalised or not.
fn surfaces() -> Vec<[Vec4; 14]> {
    let base = Frame::with_tangent(Vec3::new(0.36, 0.48, 0.8), Vec3::X);
    let turn = Quat::from_axis_angle(Vec3::new(0.6, -0.8, 0.0), 0.2);
    let coat = Frame { t: turn * base.t, b: turn * base.b, n: turn * base.n };
    let frames = [base.t, base.b, base.n, coat.t, coat.b, coat.n].map(|v| v4(v, 0.0));
    let widths = [Vec2::splat(0.05), Vec2::new(0.1, 0.6), Vec2::ONE];
    let mut inputs = Vec::new();
    for (i, variant) in surface::variants(&widths).into_iter().enumerate() {
        for (j, view) in grid::directions().into_iter().step_by(9).enumerate() {
            let flags = ((i + 3 * j) % 8) as f32;
            let x = Vec3::new(0.2, -0.1, 0.3) * (j as f32);
            let seen = [Vec3::new(-0.3, 0.4, 0.7), Vec3::new(0.5, 0.1, 0.6)].map(Vec3::normalize);
            let edge = if (i + j) % 3 == 0 { 2.0 } else { 4.0 };
            let head = [&surface::pack(variant)[..], &[v4(base.to_world(view), [1.0, 0.4][j % 2])]].concat();
            let tail = [v4(x, flags), v4(seen[0], edge), v4(seen[1], 0.0)];
            inputs.extend(<[Vec4; 14]>::try_from([&head[..], &frames, &tail].concat()));
        }
    }
    inputs
}

/// GGX has the number of [`layered::GGX`] in tables too.
const _: () = assert!(layered::GGX == Normals::Ggx as u32 && Masking::Correlated as u32 == 0);
