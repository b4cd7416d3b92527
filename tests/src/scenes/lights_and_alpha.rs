//! Lamps with their shadows; masks, panes, both sides of a surface, normal maps and moved textures.

use burnish_core::{
    material::{AlphaMode, Material, TextureRef},
    scene::{
        LightKind, Scene,
        gallery::shape::{self, Profile},
    },
};
use glam::{Affine3A, Mat3, Quat, Vec2, Vec3};

use super::{
    COPPER, GOLD,
    stage::{Stage, metal, texture},
};

/// One lamp of each kind over a floor: red from the left, green from above, blue from the right, so that each shadow
/// shows which lamp it misses.
pub fn lights_and_alpha() -> Scene {
    let mut stage = Stage::new("lights_and_alpha");
    stage.dim(0.2);
    floor(&mut stage);
    opaque_bodies(&mut stage);
    mask_and_panes(&mut stage);
    stage.light(LightKind::Point, Vec3::new(-0.75, 0.55, 0.5), Vec3::NEG_Y, Vec3::new(1.2, 0.35, 0.3));
    let spot = LightKind::Spot { inner_angle: 0.3, outer_angle: 0.5 };
    stage.light(spot, Vec3::new(0.1, 1.4, 0.3), Vec3::new(-0.05, -1.0, -0.25), Vec3::new(1.2, 3.5, 1.4));
    stage.light(LightKind::PARALLEL, Vec3::ZERO, Vec3::new(-0.8, -0.7, -0.25), Vec3::new(0.5, 0.7, 2.2));
    stage.finish_towards(Vec3::new(0.0, 0.75, 1.6), Vec3::new(0.0, 0.1, 0.0), 0.42)
}

/// A floor whose checker is scaled, turned and moved by the texture's transform.
fn floor(stage: &mut Stage) {
    let checker = stage.image("checker", 64, |x, y| {
        let bright = (x / 32 + y / 32) % 2 == 0;
        if bright { [170, 168, 164, 255] } else { [120, 118, 116, 255] }
    });
    let transform = Mat3::from_scale_angle_translation(Vec2::new(6.0, 4.0), 0.3, Vec2::new(0.2, 0.1));
    let material = Material {
        base_color_texture: Some(TextureRef { transform, ..texture(checker) }),
        roughness: 0.6,
        ..Material::default()
    };
    let material = stage.material(material);
    let lying = Affine3A::from_rotation_x(-std::f32::consts::FRAC_PI_2);
    stage.put(shape::plane(2.4, 1.6), material, lying);
}

/// Casters: a ring, a block with a normal map, a mirror ball, and a bowl that shows both sides.
fn opaque_bodies(stage: &mut Stage) {
    let gold = stage.material(metal(GOLD, 0.25));
    let ring = Affine3A::from_rotation_translation(Quat::from_rotation_x(1.35), Vec3::new(-0.5, 0.15, -0.2));
    stage.put(shape::torus(0.11, 0.04, 40, 20), gold, ring);

    let mirror = stage.material(metal(Vec3::splat(0.95), 0.02));
    stage.put(shape::sphere(0.12, 40), mirror, Affine3A::from_translation(Vec3::new(-0.12, 0.12, -0.25)));

    // Domes on a square grid; the texture's y goes up, its rows go down.
    let domes = stage.image("domes", 64, |x, y| {
        let at = |t: u32| ((t % 32) as f32 + 0.5) / 16.0 - 1.0;
        let slope = Vec2::new(at(x), -at(y));
        let n = if slope.length() < 0.9 { slope.extend(1.0).normalize() } else { Vec3::Z };
        let [r, g, b] = (n * 0.5 + 0.5).to_array().map(|v| (v * 255.0).round() as u8);
        [r, g, b, 255]
    });
    let bumpy = Material { normal_texture: Some(texture(domes)), normal_scale: 0.8, ..metal(COPPER, 0.3) };
    let bumpy = stage.material(bumpy);
    let turned = Affine3A::from_rotation_translation(Quat::from_rotation_y(0.5), Vec3::new(0.18, 0.1, -0.1));
    stage.put(shape::block(Vec3::splat(0.2), 0.02, 3), bumpy, turned);

    let two_sided = Material { double_sided: true, ..metal(Vec3::new(0.7, 0.75, 0.8), 0.35) };
    let two_sided = stage.material(two_sided);
    let half = std::f32::consts::FRAC_PI_2;
    let bowl = Profile::new().arc(Vec2::ZERO, 0.13, 0.0, -half, 12);
    let tilted = Affine3A::from_rotation_translation(Quat::from_rotation_x(0.4), Vec3::new(0.5, 0.14, -0.25));
    stage.put(shape::revolve("bowl", &bowl, 40), two_sided, tilted);
}

/// A standing sheet with holes and two panes, one before the other.
fn mask_and_panes(stage: &mut Stage) {
    let holes = stage.image("holes", 64, |x, y| {
        let solid = (x / 16 + y / 16) % 2 == 0;
        [230, 200, 90, if solid { 255 } else { 0 }]
    });
    let sheet = Material {
        base_color_texture: Some(texture(holes)),
        alpha_mode: AlphaMode::Mask { cutoff: 0.5 },
        double_sided: true,
        roughness: 0.5,
        ..Material::default()
    };
    let sheet = stage.material(sheet);
    let standing = Affine3A::from_rotation_translation(Quat::from_rotation_y(0.7), Vec3::new(-0.4, 0.12, 0.2));
    stage.put(shape::plane(0.24, 0.24), sheet, standing);

    let panes = [
        (Vec3::new(0.9, 0.15, 0.1), 0.45, Vec3::new(0.36, 0.12, 0.2)),
        (Vec3::new(0.1, 0.3, 0.9), 0.6, Vec3::new(0.46, 0.12, 0.12)),
    ];
    for (base_color, opacity, middle) in panes {
        let pane = Material {
            base_color,
            opacity,
            alpha_mode: AlphaMode::Blend,
            double_sided: true,
            roughness: 0.1,
            ..Material::default()
        };
        let pane = stage.material(pane);
        stage.put(shape::plane(0.2, 0.24), pane, Affine3A::from_translation(middle));
    }
}
