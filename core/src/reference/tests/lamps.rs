//! Lights of all kinds against closed forms, within 0.5 %, and their switches.

use std::f64::consts::PI;

use glam::{DVec3, Vec2, Vec3};

use super::*;
use crate::reference::Contribution;
use crate::scene::gallery::shape;
use crate::scene::{Light, LightKind};

const ALBEDO: f32 = 0.8;

/// A small patch at the origin that faces up, matte.
fn patch(material: Material) -> Scene {
    let up = Affine3A::from_rotation_x(-std::f32::consts::FRAC_PI_2);
    scene([(shape::transformed(shape::plane(0.004, 0.004), &up), material)])
}

fn direct() -> Options {
    Options { bounces: 1, ..Options::default() }
}

/// Mean radiance of the patch, seen from close by.
fn seen(scene: Scene, samples: u32) -> DVec3 {
    let camera = Camera::look_at("patch", Vec3::new(0.02, 0.05, 0.01), Vec3::ZERO, 0.02);
    let film = film(scene, direct(), &View { camera, size: UVec2::splat(8), seed: 5 }, samples);
    assert_eq!(film.rejected(), 0);
    mean(&film)
}

fn assert_irradiance(name: &str, light: Light, want: f64) {
    let mut scene = patch(matte(Vec3::splat(ALBEDO)));
    scene.lights.push(light);
    assert_eq!(scene.validate(), Ok(()), "{name}");
    let got = seen(scene, 8192).x * PI / f64::from(ALBEDO);
    println!("{name}: {got:.6} lx for {want:.6}, off {:.3} %", 100.0 * (got / want - 1.0));
    assert!((got / want - 1.0).abs() < 5e-3, "{name}: {got} instead of {want}");
}

/// Irradiance of even light L from a polygon on a surface at the origin (Lambert 1760, Photometria): L / 2 times the sum over
/// edges of their angle times the cosine of the surface to the plane of origin and edge.
fn polygon(radiance: f64, normal: DVec3, corners: &[DVec3]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    let edges = corners.iter().zip(next).map(|(a, b)| a.angle_between(*b) * a.cross(*b).normalize().dot(normal));
    0.5 * radiance * edges.sum::<f64>().abs()
}

fn corners(light: &Light) -> [DVec3; 4] {
    let LightKind::Rectangle { across, size } = light.kind else { panic!() };
    let up = across.cross(light.direction);
    [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]
        .map(|(x, y)| (light.position + across * (x * size.x) + up * (y * size.y)).as_dvec3())
}

/// Form factor of a sphere, of a surface whose normal is `theta` off the way to its centre, `h` radii away, where the
/// horizon cuts it (Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-44).
fn cut_sphere(h: f64, theta: f64) -> f64 {
    let (s, cos) = ((h * h - 1.0).sqrt(), theta.cos());
    let inner = cos * (-s / theta.tan()).acos() - s * (1.0 - h * h * cos * cos).sqrt();
    0.5 - (s / (h * theta.sin())).asin() / PI + inner / (PI * h * h)
}

#[test]
fn sharp_lights_give_their_irradiance() {
    let toward = Vec3::new(0.3, 0.8, -0.4);
    let light = |kind| Light {
        position: toward,
        direction: Vec3::new(-0.1, -0.9, 0.2).normalize(),
        intensity: Vec3::splat(7.0),
        kind,
        ..Light::default()
    };
    let (distance, cos) = (f64::from(toward.length()), f64::from(toward.normalize().y));
    assert_irradiance("point", light(LightKind::Point), 7.0 * cos / (distance * distance));
    let spot = light(LightKind::Spot { inner_angle: 0.1, outer_angle: 0.9 });
    let on_axis = f64::from(spot.direction.dot(-toward.normalize()));
    let ramp = (on_axis - 0.9_f64.cos()) / (0.1_f64.cos() - 0.9_f64.cos());
    assert!(ramp > 0.1 && ramp < 0.9, "between the cones: {ramp}");
    assert_irradiance("spot", spot, 7.0 * ramp * ramp * cos / (distance * distance));
    let sun = light(LightKind::PARALLEL);
    let facing = -f64::from(sun.direction.y);
    assert_irradiance("sun", sun, 7.0 * facing);
}

#[test]
fn suns_with_an_angle_give_the_irradiance_of_parallel_ones() {
    let direction = Vec3::new(0.5, -0.8, 0.1).normalize();
    for angular_radius in [0.00465, 0.1, 0.8] {
        let kind = LightKind::Directional { angular_radius };
        let light = Light { direction, intensity: Vec3::splat(5.0), kind, ..Light::default() };
        assert_irradiance(&format!("sun of {angular_radius}"), light, -5.0 * f64::from(direction.y));
    }
}

#[test]
fn rectangles_give_the_irradiance_of_their_form_factors() {
    let light = |position, direction: Vec3, across: Vec3, size| {
        let kind = LightKind::Rectangle { across, size };
        Light { position, direction, intensity: Vec3::splat(3.0), kind, ..Light::default() }
    };
    let parallel = light(Vec3::new(0.0, 0.9, 0.0), Vec3::NEG_Y, Vec3::X, Vec2::splat(1.4));
    // The same as four times a quarter (Howell, B-3).
    let quarter = {
        let x: f64 = 0.7 / 0.9;
        let s = (1.0 + x * x).sqrt();
        x / s * (x / s).atan() / PI
    };
    assert!((polygon(3.0, DVec3::Y, &corners(&parallel)) / (3.0 * PI * 4.0 * quarter) - 1.0).abs() < 1e-6);
    let tilted = Vec3::new(-0.3, -0.8, 0.2).normalize();
    let cases = [
        ("parallel rectangle", parallel),
        ("perpendicular rectangle", light(Vec3::new(0.0, 0.51, -0.6), Vec3::Z, Vec3::X, Vec2::new(1.2, 1.0))),
        ("near rectangle", light(Vec3::new(0.05, 0.06, 0.0), Vec3::NEG_Y, Vec3::Z, Vec2::new(0.7, 0.5))),
        ("strip", light(Vec3::new(0.2, 0.6, 0.1), Vec3::NEG_Y, Vec3::X, Vec2::new(2.0, 0.01))),
        ("far rectangle", light(Vec3::new(6.0, 16.0, -4.0), tilted, tilted.any_orthonormal_vector(), Vec2::splat(0.1))),
    ];
    for (name, light) in cases {
        let want = polygon(3.0, DVec3::Y, &corners(&light));
        assert_irradiance(name, light, want);
    }
}

#[test]
fn spheres_give_the_irradiance_of_their_form_factors() {
    let sphere = |position, radius| {
        let kind = LightKind::Sphere { radius };
        Light { position, intensity: Vec3::splat(2.0), kind, ..Light::default() }
    };
    for (h, cos) in [(1.5, 0.9), (4.0, 0.3), (200.0, 0.7)] {
        let toward = Vec3::new((1.0_f32 - cos * cos).sqrt(), cos, 0.0) * (0.2 * h);
        let want = 2.0 * PI * f64::from(cos) / f64::from(h * h);
        assert_irradiance(&format!("sphere at {h} radii"), sphere(toward, 0.2), want);
    }
    for (h, theta) in [(2.0_f64, 1.4_f64), (1.2, 1.7), (3.0, 1.75)] {
        let toward = DVec3::new(theta.sin(), theta.cos(), 0.0).as_vec3() * (0.2 * h as f32);
        let want = 2.0 * PI * cut_sphere(h, theta);
        assert_irradiance(&format!("sphere cut by the horizon at {h} radii"), sphere(toward, 0.2), want);
    }
    assert_irradiance("inside of a sphere", sphere(Vec3::new(0.05, -0.02, 0.1), 0.3), 2.0 * PI);
}

/// The same panel as a light and as glowing triangles, which are drawn and weighed by other code.
#[test]
fn a_rectangle_lights_as_a_glowing_panel_does() {
    let down = Affine3A::from_translation(Vec3::new(0.3, 0.5, 0.0)) * Affine3A::from_rotation_x(0.5 * PI as f32);
    let panel = shape::transformed(shape::plane(0.6, 0.4), &down);
    let glowing = Material { emission: Vec3::splat(4.0), double_sided: false, ..matte(Vec3::ZERO) };
    let light = Light {
        position: Vec3::new(0.3, 0.5, 0.0),
        direction: Vec3::NEG_Y,
        intensity: Vec3::splat(4.0),
        kind: LightKind::Rectangle { across: Vec3::X, size: Vec2::new(0.6, 0.4) },
        ..Light::default()
    };
    let metal = |roughness| even_metal(Vec3::new(0.9, 0.7, 0.4), roughness);
    let coated = Material { coat: 1.0, coat_roughness: 0.0, ..matte(Vec3::splat(0.5)) };
    let cases =
        [("matte", matte(Vec3::splat(0.5))), ("polished", metal(0.05)), ("mirror", metal(0.0)), ("rough", metal(0.4))];
    for (name, material) in cases.into_iter().chain([("coated", coated)]) {
        let floor = shape::transformed(shape::plane(0.8, 0.8), &Affine3A::from_rotation_x(-0.5 * PI as f32));
        let mut lit = scene([(floor.clone(), material.clone())]);
        lit.lights.push(light.clone());
        let glow = scene([(floor, material), (panel.clone(), glowing.clone())]);
        let view = view(Vec3::new(-0.4, 0.4, 0.1), Vec3::ZERO, 16, 3);
        let [a, b] = [lit, glow].map(|scene| film(scene, direct(), &view, 512));
        let (got, want) = (mean(&a).x, mean(&b).x);
        println!("{name}: {got:.5} for {want:.5}, off {:.3} %", 100.0 * (got / want - 1.0));
        assert!((got / want - 1.0).abs() < 5e-3, "{name}: {got} instead of {want}");
    }
}

/// A ball on a floor with three lights of different kinds, a sky and a glowing plate.
fn stage() -> Scene {
    let floor = shape::transformed(shape::plane(4.0, 4.0), &Affine3A::from_rotation_x(-0.5 * PI as f32));
    let ball = shape::transformed(shape::sphere(0.5, 32), &Affine3A::from_translation(Vec3::new(0.0, 0.5, 0.0)));
    let plate = shape::transformed(shape::plane(0.5, 0.5), &Affine3A::from_translation(Vec3::new(-0.2, 0.4, -1.0)));
    let glow = Material { emission: Vec3::new(1.0, 2.0, 3.0), ..matte(Vec3::splat(0.2)) };
    let metal = even_metal(Vec3::new(0.9, 0.6, 0.3), 0.2);
    let mut scene = scene([(floor, matte(Vec3::splat(0.5))), (ball, metal), (plate, glow)]);
    scene.environment = even_sky(Vec3::splat(0.3));
    let light =
        |position, kind| Light { position, intensity: Vec3::splat(2.0), kind, camera: true, ..Light::default() };
    scene.lights = vec![
        light(Vec3::new(1.0, 1.0, 1.0), LightKind::Point),
        light(Vec3::new(-1.0, 0.6, 0.5), LightKind::Sphere { radius: 0.2 }),
        Light {
            direction: Vec3::NEG_Y,
            ..light(Vec3::new(0.4, 1.6, 0.0), LightKind::Rectangle { across: Vec3::X, size: Vec2::new(0.8, 0.4) })
        },
    ];
    scene
}

fn stage_view() -> View {
    view(Vec3::new(-0.5, 1.0, 2.5), Vec3::new(0.0, 0.5, 0.0), 24, 1)
}

#[test]
fn contributions_add_up_to_the_picture() {
    let of =
        |contribution| film(stage(), Options { contribution, clamp: 5.0, ..Options::default() }, &stage_view(), 16);
    let whole = of(Contribution::All);
    let parts: Vec<Film> = Contribution::each(3).map(of).collect();
    assert_eq!(parts.len(), 5);
    let means: Vec<DVec3> = parts.iter().map(mean).collect();
    assert!(means.iter().all(|mean| mean.min_element() > 5e-4), "each shows light: {means:?}");
    for (i, pixel) in whole.pixels().iter().enumerate() {
        let sum: DVec3 = parts.iter().map(|part| part.pixels()[i].mean).sum();
        assert!(
            (sum - pixel.mean).abs().max_element() <= 1e-4 * pixel.mean.max_element(),
            "pixel {i}: {sum} {pixel:?}"
        );
    }
}

#[test]
fn switches_of_a_light_do_what_they_say() {
    let only = |edit: &dyn Fn(&mut Light)| {
        let mut scene = stage();
        scene.environment = None;
        scene.materials[2].emission = Vec3::ZERO;
        scene.lights.drain(..2);
        scene.lights[0].camera = false;
        edit(&mut scene.lights[0]);
        film(scene, direct(), &stage_view(), 32)
    };
    let usual = only(&|_| ());
    // Mean over the pixels of an instance, or over those that show none.
    let part = |film: &Film, instance: Option<u32>| {
        let wanted = instance.unwrap_or(crate::reference::NOTHING);
        let pixels: Vec<f64> = film.pixels().iter().filter(|p| p.instance == wanted).map(|p| p.mean.x).collect();
        assert!(!pixels.is_empty());
        pixels.iter().sum::<f64>() / pixels.len() as f64
    };
    let (floor, ball) = (Some(0), Some(1));
    assert!(part(&usual, floor) > 0.01 && part(&usual, ball) > 0.01 && part(&usual, None) == 0.0);
    let visible = only(&|l| l.camera = true);
    assert!(mean(&visible).x > 1.02 * mean(&usual).x);
    let matte_only = only(&|l| l.reflections = false);
    // Edges of the ball show the floor too.
    assert!(part(&matte_only, ball) < 0.2 * part(&usual, ball), "a metal has no matte base");
    assert!((part(&matte_only, floor) / part(&usual, floor) - 1.0).abs() < 0.05);
    let unlit = only(&|l| l.unlit = vec![0]);
    assert!(part(&unlit, floor) < 0.1 * part(&usual, floor));
    assert!((part(&unlit, ball) / part(&usual, ball) - 1.0).abs() < 0.1);
    let open = only(&|l| l.shadows = false);
    assert!(part(&open, floor) > 1.05 * part(&usual, floor), "the ball's shadow is gone");
    let dark = only(&|l| l.intensity = Vec3::ZERO);
    assert_eq!(mean(&dark), DVec3::ZERO);
}

#[test]
fn lights_in_odd_places_make_no_numbers_that_are_none() {
    let rectangle = |across, width, height| LightKind::Rectangle { across, size: Vec2::new(width, height) };
    let kinds = [
        LightKind::Point,
        LightKind::Spot { inner_angle: 0.0, outer_angle: 0.5 },
        rectangle(Vec3::X, 0.3, 0.2),
        rectangle(Vec3::X, 0.3, 0.0),
        rectangle(Vec3::X, 1e-12, 1e-12),
        LightKind::Sphere { radius: 0.0 },
        LightKind::Sphere { radius: 1e-12 },
        LightKind::Sphere { radius: 0.5 },
        LightKind::Directional { angular_radius: 1e-3 },
    ];
    // In the floor, on the ball, inside of it, at the eye.
    let places = [
        Vec3::ZERO,
        Vec3::new(0.0, 1.0, 0.0),
        Vec3::new(0.0, 0.5, 0.0),
        stage_view().camera.world_from_view.translation.into(),
    ];
    for kind in kinds {
        for position in places {
            for intensity in [0.0, 1.0, 1e12] {
                let light = Light {
                    position,
                    direction: Vec3::NEG_Y,
                    intensity: Vec3::splat(intensity),
                    kind,
                    camera: true,
                    ..Light::default()
                };
                let lit = Scene { lights: vec![light], ..stage() };
                assert_eq!(lit.validate(), Ok(()));
                let film = film(
                    lit,
                    Options { bounces: 4, ..Options::default() },
                    &View { size: UVec2::splat(12), ..stage_view() },
                    4,
                );
                assert_eq!(film.rejected(), 0, "{kind:?} at {position}, {intensity}");
                assert!(mean(&film).is_finite());
            }
        }
    }
}
