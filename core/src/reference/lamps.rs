//! Punctual lights: no size, so only drawing them on purpose meets them.

use glam::Vec3;

use crate::scene::{Light, LightKind};

/// Least distance to a lamp in metres: one that lies on a surface must not divide by zero.
const NEAREST: f32 = 1e-3;

/// Light of a lamp at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LampLight {
    /// Unit, toward the lamp.
    pub direction: Vec3,
    /// Metres; infinite for directional lights.
    pub distance: f32,
    /// On a surface that faces the lamp, lx.
    pub irradiance: Vec3,
}

/// What a lamp sends to a point, shadows aside. KHR_lights_punctual, "Range property" and "Inner and outer cone angles".
pub(super) fn at(light: &Light, position: Vec3) -> LampLight {
    if let LightKind::Directional { .. } = light.kind {
        return LampLight { direction: -light.direction, distance: f32::INFINITY, irradiance: light.intensity };
    }
    let toward = light.position - position;
    let distance = toward.length().max(NEAREST);
    let direction = toward / distance;
    let mut factor = 1.0 / (distance * distance);
    if light.range > 0.0 && light.range.is_finite() {
        factor *= (1.0 - (distance / light.range).powi(4)).clamp(0.0, 1.0);
    }
    if let LightKind::Spot { inner_angle, outer_angle } = light.kind {
        let scale = 1.0 / (inner_angle.cos() - outer_angle.cos()).max(1e-3);
        let cone = ((light.direction.dot(-direction) - outer_angle.cos()) * scale).clamp(0.0, 1.0);
        factor *= cone * cone;
    }
    LampLight { direction, distance, irradiance: light.intensity * factor }
}

/// One lamp, chosen by its light at the point before shadows, with the chance of that choice; `u` in [0, 1).
pub(super) fn choose(lights: &[Light], position: Vec3, u: f32) -> Option<(LampLight, f32)> {
    let brightness = |light: &Light| at(light, position).irradiance.element_sum();
    let total: f32 = lights.iter().map(brightness).sum();
    let mut left = u * total;
    let mut last = None;
    for light in lights {
        let weight = brightness(light);
        if weight > 0.0 {
            last = Some((at(light, position), weight / total));
            if left < weight {
                break;
            }
        }
        left -= weight;
    }
    last.filter(|(_, chance)| *chance > 0.0 && chance.is_finite())
}

/// About the irradiance at a point, for choosing among kinds of light.
pub(super) fn weight(lights: &[Light], position: Vec3) -> f32 {
    lights.iter().map(|light| at(light, position).irradiance.element_sum() / 3.0).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::sampling::Random;

    fn lamp(kind: LightKind, x: f32, intensity: f32) -> Light {
        Light {
            name: "lamp".into(),
            position: Vec3::new(x, 2.0, 0.0),
            direction: Vec3::NEG_Y,
            intensity: Vec3::splat(intensity),
            kind,
            ..Light::default()
        }
    }

    #[test]
    fn light_falls_with_the_square_and_ends_at_the_range_and_outside_the_cone() {
        let point = lamp(LightKind::Point, 0.0, 8.0);
        assert!((at(&point, Vec3::ZERO).irradiance.x - 2.0).abs() < 1e-6);
        assert_eq!(at(&Light { range: 2.0, ..point.clone() }, Vec3::ZERO).irradiance.x, 0.0);
        assert!(at(&point, point.position).irradiance.is_finite());
        let spot = lamp(LightKind::Spot { inner_angle: 0.2, outer_angle: 0.4 }, 0.0, 8.0);
        assert!((at(&spot, Vec3::ZERO).irradiance.x - 2.0).abs() < 1e-6);
        assert_eq!(at(&spot, Vec3::new(2.0, 0.0, 0.0)).irradiance.x, 0.0);
        let sun = lamp(LightKind::PARALLEL, 0.0, 3.0);
        let light = at(&sun, Vec3::splat(9.0));
        assert_eq!((light.direction, light.irradiance.x, light.distance), (Vec3::Y, 3.0, f32::INFINITY));
    }

    #[test]
    fn lamps_are_chosen_by_their_light() {
        let lights =
            [lamp(LightKind::Point, 0.0, 1.0), lamp(LightKind::Point, 0.0, 0.0), lamp(LightKind::Point, 4.0, 10.0)];
        let mut random = Random::new(1);
        let (mut sum, n) = (0.0, 20_000);
        for _ in 0..n {
            let (light, chance) = choose(&lights, Vec3::ZERO, random.unit()).unwrap();
            sum += f64::from(light.irradiance.x / chance);
        }
        let want: f32 = lights.iter().map(|l| at(l, Vec3::ZERO).irradiance.x).sum();
        assert!((sum / f64::from(n) / f64::from(want) - 1.0).abs() < 1e-4);
        assert_eq!(choose(&[], Vec3::ZERO, 0.5), None);
        assert_eq!(choose(&lights[1..2], Vec3::ZERO, 0.5), None);
    }
}
