use std::f32::consts::{FRAC_1_PI, PI};

use glam::Vec2;

use super::tables::Normals;
use super::*;
use crate::math::frame::Frame;
use crate::math::quadrature::GaussLegendre;
use crate::math::sampling::Random;
use crate::surface::blinn_phong::Variant;
use crate::surface::ggx::Masking;
use crate::surface::layered;

const SOLID_ANGLES: &str = include_str!("../../../../tests/data/reference/cube_texel_solid_angle.csv");
const LOCALISED: &str = include_str!("../../../../tests/data/reference/localised_solid_angle.csv");

fn rows(text: &str) -> impl Iterator<Item = Vec<f32>> + '_ {
    text.lines().skip(1).map(|line| line.split(',').map(|number| number.parse().unwrap()).collect())
}

fn near(found: f32, wanted: f32, what: &str) {
    assert!((found - wanted).abs() <= 1e-5 * wanted.abs(), "{what}: {found} {wanted}");
}

fn unit(random: &mut Random) -> Vec3 {
    let u = random.point2();
    let z = 1.0 - 2.0 * u.y;
    let level = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
    (Vec2::from_angle(TAU * u.x) * level).extend(z).normalize()
}

#[test]
fn solid_angles_of_texels_are_those_of_the_reference_values_and_fill_the_sphere() {
    let mut count = 0;
    for row in rows(SOLID_ANGLES) {
        let (size, place) = (2.0 / row[0], Vec2::new(row[1], row[2]));
        let low = place * size - 1.0;
        near(solid_angle(low, low + size), row[3], &format!("{row:?}"));
        count += 1;
    }
    assert_eq!(count, 20);
    for edge in EDGES {
        let cube = downsample(edge, 1, &|_| Vec3::ONE, &|_| 1.0);
        let whole: f64 = cube.iter().map(|texel| f64::from(texel.solid_angle())).sum();
        assert!((whole / (4.0 * std::f64::consts::PI) - 1.0).abs() < 1e-5, "{edge}: {whole}");
    }
}

#[test]
fn localised_solid_angles_are_those_of_the_reference_values() {
    let mut count = 0;
    for row in rows(LOCALISED) {
        near(localised_solid_angle(row[0], row[1], row[2]), row[3], &format!("{row:?}"));
        count += 1;
    }
    assert_eq!(count, 60);
}

#[test]
fn localised_solid_angles_are_finite_and_at_most_a_hemisphere() {
    for w in [0.0, 1e-12, 0.1, 3.0, TAU, 10.0, f32::INFINITY] {
        for r in [0.0, 1e-30, 1.0, 1e30, f32::INFINITY] {
            for to in [0.0, 1e-30, 0.5, 1e30, f32::INFINITY] {
                let found = localised_solid_angle(w, r, to);
                assert!((0.0..=TAU).contains(&found), "{w} {r} {to}: {found}");
            }
        }
    }
    // As the point comes to it a texel fills a hemisphere; from the middle nothing changes.
    assert!((localised_solid_angle(0.1, 1.0, 1e-6) - TAU).abs() < 1e-4);
    near(localised_solid_angle(0.1, 2.0, 2.0), 0.1, "from as far");
    let mut random = Random::new(2);
    for i in 0..100_000 {
        let texel = Texel::new(unit(&mut random), 0.5 * random.unit(), random.unit(), unit(&mut random), Vec3::ONE);
        let x = match i % 4 {
            0 => texel.place,
            1 => texel.place + 1e-12 * unit(&mut random),
            _ => 3.0 * random.unit() * unit(&mut random),
        };
        for corrected in [false, true] {
            let cap = localised(&texel, x, corrected);
            assert!((0.0..=1.0).contains(&cap.share), "{texel:?} {x}: {cap:?}");
            assert!((cap.direction.length() - 1.0).abs() < 1e-4, "{texel:?} {x}: {cap:?}");
        }
    }
}

#[test]
fn light_of_the_sky_comes_from_the_same_direction_everywhere() {
    let sky = downsample(4, 2, &|d| d.abs(), &|d| if d.y > 0.0 { 0.0 } else { 2.0 });
    let x = Vec3::new(0.3, 0.5, -0.9);
    let mut count = 0;
    for texel in sky.iter().filter(|texel| texel.spread == 0.0) {
        let cap = localised(texel, x, true);
        assert!(cap.direction == texel.place && texel.place.y > 0.0);
        near(cap.solid_angle(), texel.solid_angle(), "sky");
        count += 1;
    }
    assert_eq!(count, 48, "half of the texels");
}

/// The cubic room from -1 to 1, seen from its middle.
fn wall(d: Vec3) -> f32 {
    d.abs().max_element().recip()
}

/// Its texels as `edge` x `edge` a face, of radiance 1, with the distances of their middles: what the figures were made of.
fn white_room(edge: u32) -> Vec<[f32; NUMBERS]> {
    // One part a texel: its middle.
    downsample(edge, 1, &|_| Vec3::ONE, &wall).iter().map(Texel::to_array).collect()
}

/// Share of the sphere that the texels of a white room fill, and the irradiance about a normal over pi: with the horizon through
/// caps, and with the cosine of their middles.
fn furnace(edge: u32, x: Vec3, normal: Vec3, corrected: bool) -> [f32; 3] {
    let numbers = white_room(edge);
    let caps = || numbers.iter().map(|texel| localised(&Texel::of_array(texel), x, corrected));
    let whole: f32 = caps().map(|cap| cap.share).sum::<f32>() / 2.0;
    let cut: f32 = caps().map(|cap| tables::lambert(cap.share, cap.direction.dot(normal))).sum();
    let middles: f32 = caps().map(|cap| cap.solid_angle() * cap.direction.dot(normal).max(0.0) * FRAC_1_PI).sum();
    [whole, cut, middles]
}

/// Computed apart from this code with 16 x 16 texels, their middles and the cosines there.
#[test]
fn a_white_room_shows_how_wrong_it_is_near_walls_and_what_the_correction_makes_of_it() {
    for (place, whole) in [(0.5, 1.08), (0.8, 1.35), (0.95, 1.75)] {
        let found = furnace(16, place * Vec3::X, Vec3::X, false)[0];
        println!("{place}: {found}");
        assert!((found - whole).abs() <= 0.005, "{place}: {found}");
    }
    let corner = Vec3::splat(0.8);
    for (what, x, normal, corrected, wanted, cut) in [
        ("before a wall", 0.8 * Vec3::X, Vec3::X, false, 1.50, 1.48),
        ("the same, corrected", 0.8 * Vec3::X, Vec3::X, true, 0.96, 0.95),
        ("in a corner, looking out", corner, Vec3::NEG_X, false, 1.67, 1.69),
        ("the same, corrected", corner, Vec3::NEG_X, true, 0.97, 0.99),
        ("close to a wall, corrected", 0.95 * Vec3::X, Vec3::X, true, 0.49, 0.47),
    ] {
        let found = furnace(16, x, normal, corrected);
        println!("{what}: {found:?}");
        // The figures have two digits.
        assert!((found[2] - wanted).abs() <= 0.01, "{what}: {found:?}");
        assert!((found[1] - cut).abs() <= 0.01, "{what}: {found:?}");
    }
}

#[test]
fn normals_of_a_room_are_those_of_its_walls() {
    for texel in downsample(8, 4, &|_| Vec3::ONE, &wall) {
        let axis = texel.place.abs();
        let expected = if axis.x > axis.y.max(axis.z) {
            Vec3::X * -texel.place.x.signum()
        } else if axis.y > axis.z {
            Vec3::Y * -texel.place.y.signum()
        } else {
            Vec3::Z * -texel.place.z.signum()
        };
        let normal = texel.normal.normalize();
        assert!(normal.abs_diff_eq(expected, 1e-4), "{texel:?}");
        // Over the cosine toward the middle.
        assert!((texel.normal.dot(-texel.place.normalize()) - 1.0).abs() < 1e-4);
    }
}

#[test]
fn every_texel_has_four_neighbours_that_have_it_too() {
    for edge in EDGES {
        for index in 0..6 * edge * edge {
            let beside = [0, 1, 2, 3].map(|side| neighbour(index, side, edge));
            for (side, other) in beside.into_iter().enumerate() {
                assert!(
                    other != index && beside.iter().filter(|i| **i == other).count() == 1,
                    "{edge} {index} {beside:?}"
                );
                let back = (0..NEIGHBOURS).any(|side| neighbour(other, side, edge) == index);
                assert!(back && other < 6 * edge * edge, "{edge}: {other} beyond side {side} of {index}");
            }
        }
        for (index, texel) in downsample(edge, 1, &|_| Vec3::ONE, &|_| 1.0).iter().enumerate() {
            assert_eq!(texel_at(texel.place, edge), index as u32);
        }
    }
}

/// Directions that fill a cap evenly.
fn in_cap(cap: &Cap, n: u32) -> impl Iterator<Item = Vec3> {
    let (frame, share) = (Frame::new(cap.direction), cap.share);
    (0..n * n).map(move |i| {
        let (u, v) = ((i % n) as f32 + 0.5, (i / n) as f32 + 0.5);
        let below = share * v / n as f32;
        let level = (below * (2.0 - below)).sqrt();
        frame.to_world((Vec2::from_angle(TAU * u / n as f32) * level).extend(1.0 - below))
    })
}

/// Caps from a thousandth of a steradian to a hemisphere, from below the horizon to above.
fn caps() -> Vec<Cap> {
    let shares = [1e-4, 3e-3, 0.01, 0.04, 0.1, 0.35, 0.7, 1.0];
    let heights = (0..=20).map(|i| -1.0 + 0.1 * i as f32);
    let directions = heights.map(|z: f32| Vec3::new((1.0 - z * z).max(0.0).sqrt(), 0.0, z));
    directions.flat_map(|direction| shares.map(|share| Cap { direction, share })).collect()
}

#[test]
fn the_table_of_lambert_is_within_its_error_of_the_integral() {
    let mut worst = 0.0f32;
    for cap in caps() {
        let n = 256;
        let sum: f64 = in_cap(&cap, n).map(|w| f64::from(w.z.max(0.0))).sum();
        let exact = (sum / f64::from(n * n)) as f32 * cap.solid_angle() * FRAC_1_PI;
        let found = tables::lambert(cap.share, cap.direction.z);
        worst = worst.max((found - exact).abs() / (2.0 * cap.share));
        assert!((0.0..=1.0 + 1e-6).contains(&found), "{cap:?}: {found}");
    }
    println!("mean cosine over a cap: {worst:.5}");
    assert!(worst < 1.5e-3, "{worst}");
}

#[test]
fn the_tables_of_normals_are_within_their_error_of_the_integral() {
    let quadrature = GaussLegendre::new(96);
    // Shares of the peak: the largest and the mean error between the nodes. The worst is that of powers below 1, which reach
    // around the sphere.
    for (of, widths, most, mean) in [
        (Normals::Ggx, [1.3e-3f32, 6e-3, 0.02, 0.07, 0.3, 0.95], 0.012, 2e-3),
        (Normals::BlinnPhong, [6e-3, 0.02, 0.07, 0.17, 0.3, 0.55], 0.02, 2.5e-3),
        (Normals::BlinnPhong, [0.7, 0.75, 0.8, 0.85, 0.9, 0.95], 0.09, 6e-3),
    ] {
        let mut errors = Vec::new();
        for alpha in widths {
            for i in 0..24 * 16 {
                let chord = |k: u32, n: u32| {
                    let t = (k as f32 + 0.4) / n as f32 / (1.0 + alpha / tables::CHORD_MAX);
                    alpha * t / (1.0 - t)
                };
                let (offset, cap) = (chord(i % 24, 24), chord(i / 24, 16));
                let args = [alpha, offset, cap].map(f64::from);
                let exact = tables::mean(of, args[0], args[1], args[2], &quadrature) as f32;
                errors.push((tables::normals(of, alpha, offset, cap) - exact).abs());
            }
        }
        let worst = errors.iter().copied().fold(0.0, f32::max);
        let average = errors.iter().sum::<f32>() / errors.len() as f32;
        println!("{of:?} {widths:?}: worst {worst:.4}, mean {average:.5}");
        assert!(worst < most && average < mean, "{of:?} {widths:?}: {worst} {average}");
    }
}

#[test]
fn what_is_tabulated_is_the_mean_over_a_cap_of_half_vectors() {
    let quadrature = GaussLegendre::new(48);
    for (of, alpha) in [(Normals::Ggx, 0.3f32), (Normals::Ggx, 1.0), (Normals::BlinnPhong, 0.5)] {
        for (theta, beta) in [(0.0f32, 0.3f32), (0.2, 0.1), (0.4, 0.6), (1.3, 0.5)] {
            let cap = Cap { direction: Vec3::new(theta.sin(), 0.0, theta.cos()), share: 1.0 - beta.cos() };
            let value = |h: Vec3| match of {
                Normals::Ggx => PI * alpha * alpha * crate::surface::ggx::distribution(h, Vec2::splat(alpha)),
                Normals::BlinnPhong => crate::surface::blinn_phong::power(h, 2.0 / (alpha * alpha) - 2.0),
            };
            let summed: f32 = in_cap(&cap, 400).map(|h| value(h.truncate().extend(h.z.abs()))).sum::<f32>() / 160_000.0;
            let chord = |angle: f32| f64::from(2.0 * (0.5 * angle).sin());
            let found = tables::mean(of, alpha.into(), chord(theta), chord(beta), &quadrature) as f32;
            assert!(
                (found - summed).abs() < 2e-3 * summed.max(0.01),
                "{of:?} {alpha} {theta} {beta}: {found} {summed}"
            );
        }
    }
}

/// Mean error of what a lobe reflects of caps against the integral of its BRDF over them, over the mean of the integral: caps
/// all around, of the solid angle of a texel.
fn lobe_error(lobe: &Lobe, theta: f32, solid_angle: f32) -> [f32; 2] {
    let wo = Vec3::new(theta.sin(), 0.0, theta.cos());
    let alpha = Vec2::splat(lobe.alpha);
    let mut random = Random::new(9);
    let (mut apart, mut found, mut whole) = (0.0, 0.0, 0.0);
    for _ in 0..400 {
        let cap = Cap { direction: unit(&mut random), share: solid_angle / TAU };
        let value = glossy(lobe, wo, &cap, tables::lambert(cap.share, cap.direction.z), false).x;
        let lit = |wi: Vec3| lobe.kind.facet(wo, wi, alpha, lobe.masking).y * wi.z.max(0.0);
        let exact = in_cap(&cap, 48).map(lit).sum::<f32>() / 2304.0 * solid_angle;
        assert!(value.is_finite() && value >= 0.0);
        (apart, found, whole) = (apart + (value - exact).abs(), found + value, whole + exact);
    }
    [apart / whole, found / whole]
}

#[test]
fn lobes_over_caps_are_within_their_error_of_the_integral() {
    // Texels of 8 x 8, 4 x 4 and 2 x 2.
    let sizes = [0.0327, 0.131, 0.524];
    let ggx = |alpha| Lobe { kind: layered::Lobe::Ggx, alpha, masking: Masking::Correlated };
    let power = |exponent| {
        let kind = layered::Lobe::BlinnPhong { exponent, variant: Variant::Exact };
        Lobe { kind, alpha: kind.alpha(Vec2::ONE).x, masking: Masking::Correlated }
    };
    let lobes = [("GGX 0.1", ggx(0.1)), ("GGX 0.3", ggx(0.3)), ("GGX 0.6", ggx(0.6)), ("GGX 1", ggx(1.0))];
    let powers = [("Blinn-Phong 5", power(5.0)), ("Blinn-Phong 10", power(10.0)), ("Blinn-Phong 100", power(100.0))];
    for (name, lobe) in lobes.into_iter().chain(powers) {
        for theta in [0.0f32, 0.8, 1.2] {
            let errors = sizes.map(|size| lobe_error(&lobe, theta, size));
            println!("{name} {theta}: {errors:.3?}");
            for (i, [apart, _]) in errors.into_iter().enumerate() {
                // Wide lobes are smooth over a texel; narrow ones are seen askew at grazing angles.
                let most = if lobe.alpha > 0.25 { [0.06, 0.16, 0.4][i] } else { [0.4, 0.6, 0.9][i] };
                assert!(apart < most, "{name} {theta} {}: {apart}", sizes[i]);
            }
        }
    }
}

#[test]
fn what_few_texels_leave_out_is_told() {
    let numbers = white_room(8);
    assert!(Texels::of(numbers.as_flattened(), 16).is_none(), "fewer than all cubes");
    let all: Vec<f32> = EDGES.iter().flat_map(|edge| white_room(*edge).as_flattened().to_vec()).collect();
    let texels = Texels::of(&all, 8).unwrap();
    let frame = Frame::new(Vec3::Y);
    let at = Looked { x: Vec3::ZERO, base: Vec3::Y, coat: Vec3::Y };
    let share = |alpha: f32| {
        let lobe = Lobe { kind: layered::Lobe::Ggx, alpha, masking: Masking::Correlated };
        let [few, all] = sums(&texels, lobe, &frame, Vec3::Y, &at, true);
        few.light.x / all.light.x
    };
    let (narrow, wide) = (share(0.05), share(0.8));
    println!("few of all: narrow {narrow}, wide {wide}");
    assert!(narrow > 0.5 && wide < 0.3 && wide < narrow, "{narrow} {wide}");
}
