//! Lights of a scene as shapes, and how much of one a point sees.

use std::f32::consts::TAU;

use glam::{Vec2, Vec3};

use super::Shape;
use crate::math::frame::Frame;
use crate::scene::{Light, LightKind};

/// Rays from a point to a light.
pub const RAYS: u32 = 4;

/// The shape of a light as seen from a point of the world, and its radiance; `None` for lights without an area, from
/// behind one and for sharp lights.
pub fn shape(light: &Light, position: Vec3) -> Option<(Shape, Vec3)> {
    let toward = light.position - position;
    let shape = match light.kind {
        LightKind::Rectangle { across, size } => Shape::rectangle(toward, light.direction, across, size),
        LightKind::Sphere { radius } => Shape::sphere(toward, radius),
        LightKind::Directional { angular_radius } if !light.kind.is_sharp() => {
            Some(Shape::Cap { axis: -light.direction, sine: angular_radius.sin() })
        }
        LightKind::Directional { .. } | LightKind::Point | LightKind::Spot { .. } => None,
    };
    Some((shape?, light.radiance()))
}

/// Share of a light above the plane of a surface that nothing hides, by [`RAYS`] rays; `sees` casts one in a direction
/// (unit) over so many metres. `u` in `[0, 1)^2` moves the places on the light.
pub fn visible(
    light: &Light,
    shape: &Shape,
    position: Vec3,
    normal: Vec3,
    u: Vec2,
    sees: impl Fn(Vec3, f32) -> bool,
) -> f32 {
    let (mut lit, mut count) = (0, 0);
    for i in 1..=RAYS {
        // Roberts 2018, the R2 sequence.
        let u = (u + i as f32 * Vec2::new(0.754_877_7, 0.569_840_3)).fract();
        let Some((direction, distance)) = place(light, shape, position, u) else { return 1.0 };
        if direction.dot(normal) > 0.0 {
            count += 1;
            lit += u32::from(sees(direction, distance));
        }
    }
    if count == 0 { 1.0 } else { lit as f32 / count as f32 }
}

/// A place on a light: unit direction and metres. `None` inside of it.
fn place(light: &Light, shape: &Shape, position: Vec3, u: Vec2) -> Option<(Vec3, f32)> {
    let (toward, radius) = match *shape {
        Shape::Rectangle { center, across, up } => {
            let at = center + across * (2.0 * u.x - 1.0) + up * (2.0 * u.y - 1.0);
            return Some((at.try_normalize()?, at.length()));
        }
        Shape::Cap { axis, sine } => (axis, sine),
        Shape::Everywhere => return None,
    };
    // The disk that the rim bounds; a ray that ends there is as good as one to the surface before it.
    let around = u.x.sqrt() * radius * Vec2::from_angle(TAU * u.y);
    let cosine = ((1.0 - radius) * (1.0 + radius)).max(0.0).sqrt();
    let direction = Frame::new(toward).to_world(around.extend(cosine)).try_normalize()?;
    let is_sun = matches!(light.kind, LightKind::Directional { .. });
    let distance = if is_sun { f32::INFINITY } else { (light.position - position).length() * cosine };
    Some((direction, distance))
}
