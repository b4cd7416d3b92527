//! Lights as the shaders read them, and from where their maps are seen.

use burnish_core::scene::{Bounds, Light, LightKind, Scene};
use bytemuck::Zeroable;
use glam::camera::rh::{proj::directx as proj, view};
use glam::{Mat4, Vec2, Vec3};

use crate::layout::types::{
    LIGHT_CAMERA, LIGHT_DIRECTIONAL, LIGHT_POINT, LIGHT_RECTANGLE, LIGHT_REFLECTIONS, LIGHT_SPHERE, LIGHT_SPOT,
    LIGHT_SUN, LightData,
};

/// Widest cone that one map can hold.
const SPOT_ANGLE_MAX: f32 = 1.4;
/// Angular radius below which a sun is a directional light: an eighth of the real one's. Its polygon would lose its
/// digits.
const SUN_MIN: f32 = 6e-4;

/// The axis of an upright camera that looks along `direction`.
fn up_for(direction: Vec3) -> Vec3 {
    if direction.y.abs() > 0.99 { Vec3::Z } else { Vec3::Y }
}

/// Radius of the scene.
fn radius(bounds: Bounds) -> f32 {
    bounds.radius().max(1e-6)
}

/// Metres before which nothing is drawn into a map: nearer casters are inside the lamp.
fn near(bounds: Bounds) -> f32 {
    radius(bounds) * 1e-3
}

/// One clip-from-world matrix a layer, depth reversed; none for a light without a size that should have one.
pub fn views(light: &Light, bounds: Bounds) -> Vec<Mat4> {
    let radius = radius(bounds);
    let perspective = |angle: f32, direction: Vec3| {
        let view = view::look_to_mat4(light.position, direction, up_for(direction));
        proj::perspective_infinite_reverse(angle, 1.0, near(bounds)) * view
    };
    let face = |direction| perspective(std::f32::consts::FRAC_PI_2, direction);
    let axes = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
    match light.kind {
        LightKind::Point => axes.map(face).to_vec(),
        LightKind::Sphere { radius } if radius > 0.0 => axes.map(face).to_vec(),
        LightKind::Rectangle { across, size } if size.min_element() > 0.0 => {
            let up = across.cross(light.direction);
            [across, -across, up, -up, light.direction].map(face).to_vec()
        }
        LightKind::Sphere { .. } | LightKind::Rectangle { .. } => Vec::new(),
        LightKind::Spot { outer_angle, .. } => {
            vec![perspective(2.0 * outer_angle.clamp(1e-3, SPOT_ANGLE_MAX), light.direction)]
        }
        LightKind::Directional { .. } => {
            let eye = bounds.center() - light.direction * (2.0 * radius);
            let view = view::look_to_mat4(eye, light.direction, up_for(light.direction));
            // Far and near are exchanged: depth is reversed.
            vec![proj::orthographic(-radius, radius, -radius, radius, 4.0 * radius, 0.0) * view]
        }
    }
}

/// A light whose maps start at a layer and are `edge` texels wide.
pub fn data(light: &Light, bounds: Bounds, shadow_layer: u32, edge: u32) -> LightData {
    // Size of a map at distance 1, or everywhere.
    let mut extent = 2.0;
    let mut data = LightData {
        position: light.position,
        direction: light.direction,
        range: if light.range.is_finite() { light.range } else { 0.0 },
        intensity: light.intensity,
        spot_offset: 1.0,
        shadow_layer,
        flags: if light.camera { LIGHT_CAMERA } else { 0 } | if light.reflections { LIGHT_REFLECTIONS } else { 0 },
        shadow_depth: near(bounds),
        ..LightData::zeroed()
    };
    match light.kind {
        LightKind::Point => data.kind = LIGHT_POINT,
        LightKind::Spot { inner_angle, outer_angle } => {
            // KHR_lights_punctual, "Inner and Outer Cone Angles".
            data.kind = LIGHT_SPOT;
            data.spot_scale = 1.0 / (inner_angle.cos() - outer_angle.cos()).max(1e-3);
            data.spot_offset = -outer_angle.cos() * data.spot_scale;
            extent = 2.0 * outer_angle.clamp(1e-3, SPOT_ANGLE_MAX).tan();
        }
        LightKind::Directional { angular_radius } => {
            data.kind = if angular_radius < SUN_MIN { LIGHT_DIRECTIONAL } else { LIGHT_SUN };
            data.size.x = angular_radius.sin();
            data.shadow_depth = 4.0 * radius(bounds);
            extent = 2.0 * bounds.radius();
        }
        LightKind::Rectangle { across, size } => {
            data.kind = LIGHT_RECTANGLE;
            (data.across, data.size) = (across, size);
        }
        LightKind::Sphere { radius } => {
            data.kind = LIGHT_SPHERE;
            // The axes of the world.
            (data.across, data.direction, data.size) = (Vec3::X, Vec3::NEG_Z, Vec2::new(radius, 0.0));
        }
    }
    data.shadow_texel = extent / edge as f32;
    data
}

/// A bit for each light and instance that it leaves out, and the words of a light: 0 where all light everything.
pub fn unlit(scene: &Scene) -> (Vec<u32>, u32) {
    if scene.lights.iter().all(|light| light.unlit.is_empty()) {
        return (vec![0], 0);
    }
    let words = scene.instances.len().div_ceil(32).max(1);
    let mut bits = vec![0; words * scene.lights.len()];
    for (row, light) in bits.chunks_mut(words).zip(&scene.lights) {
        for &instance in &light.unlit {
            if let Some(word) = row.get_mut(instance / 32) {
                *word |= 1 << (instance % 32);
            }
        }
    }
    (bits, words as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instances_that_a_light_leaves_out_have_their_bit() {
        let mut scene = burnish_core::scene::gallery::open("ball").unwrap();
        let instance = scene.instances[0].clone();
        scene.instances.resize(40, instance);
        scene.lights = vec![Light::default(); 2];
        assert_eq!(unlit(&scene), (vec![0], 0));
        scene.lights[1].unlit = vec![1, 33];
        assert_eq!(unlit(&scene), (vec![0, 0, 2, 2], 2));
    }

    #[test]
    fn a_rectangle_is_seen_to_its_front_and_sides_in_the_order_of_the_faces() {
        let kind = LightKind::Rectangle { across: Vec3::X, size: Vec2::ONE };
        let light = Light { kind, direction: Vec3::NEG_Y, position: Vec3::Y, ..Light::default() };
        let bounds = Bounds { min: Vec3::NEG_ONE, max: Vec3::ONE };
        let views = views(&light, bounds);
        // Up is across x direction: -z.
        let middles = [Vec3::X, Vec3::NEG_X, Vec3::NEG_Z, Vec3::Z, Vec3::NEG_Y];
        assert_eq!(views.len(), 5);
        for (view, direction) in views.iter().zip(middles) {
            let clip = *view * (light.position + 2.0 * direction).extend(1.0);
            assert!((clip.w - 2.0).abs() < 1e-5 && clip.truncate().truncate().length() < 1e-5, "{direction} {clip}");
        }
    }
}
