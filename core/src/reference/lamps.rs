//! Lamps: light of sharp ones at a point, and one drawn of all.

use glam::Vec3;

use super::shapes;
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

/// A point that light comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Receiver {
    /// World, metres.
    pub position: Vec3,
    /// Index into `Scene::instances`.
    pub instance: u32,
}

/// Light of one lamp toward a receiver, shadows aside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LampSample {
    /// Index into `Scene::lights`.
    pub lamp: usize,
    /// Unit, toward the lamp.
    pub direction: Vec3,
    /// Metres; infinite for suns.
    pub distance: f32,
    /// Irradiance of a sharp lamp or radiance over density, each over the chance of the lamp.
    pub weight: Vec3,
    /// Per steradian, with the chance of the lamp; infinite for sharp ones.
    pub pdf: f32,
}

/// About the irradiance of a lamp at a receiver, of all channels: never zero where it may shine.
fn guess(light: &Light, receiver: Receiver) -> f32 {
    if !light.lights(receiver.instance as usize) {
        return 0.0;
    }
    if light.kind.is_sharp() {
        return at(light, receiver.position).irradiance.element_sum();
    }
    let angle = shapes::solid_angle(light, receiver.position);
    if angle > 0.0 { angle * light.radiance().element_sum() } else { 0.0 }
}

/// The sum of the guesses, by which lamps are chosen.
pub(super) fn total(lights: &[Light], receiver: Receiver) -> f32 {
    lights.iter().map(|light| guess(light, receiver)).sum()
}

/// Light of one lamp, chosen by its guess; `total` is that of [`total`], `u` in `[0, 1)^3`, its z chooses.
pub(super) fn sample(lights: &[Light], receiver: Receiver, total: f32, u: Vec3) -> Option<LampSample> {
    let mut left = u.z * total;
    let mut last = None;
    for (lamp, light) in lights.iter().enumerate() {
        let weight = guess(light, receiver);
        if weight > 0.0 {
            last = Some((lamp, weight / total));
            if left < weight {
                break;
            }
        }
        left -= weight;
    }
    let (lamp, chance) = last.filter(|(_, chance)| *chance > 0.0 && chance.is_finite())?;
    let light = &lights[lamp];
    if light.kind.is_sharp() {
        let LampLight { direction, distance, irradiance } = at(light, receiver.position);
        return Some(LampSample { lamp, direction, distance, weight: irradiance / chance, pdf: f32::INFINITY });
    }
    let drawn = shapes::sample(light, receiver.position, u.truncate())?;
    let pdf = chance * drawn.pdf;
    // A chance so small that the density vanishes is none.
    let weight = light.radiance() / pdf;
    weight.is_finite().then_some(LampSample { lamp, direction: drawn.direction, distance: drawn.distance, weight, pdf })
}

/// Density with which [`sample`] draws a direction that meets a lamp after `distance`.
pub(super) fn pdf(light: &Light, receiver: Receiver, total: f32, direction: Vec3, distance: f32) -> f32 {
    let guess = guess(light, receiver);
    if guess <= 0.0 {
        return 0.0;
    }
    let pdf = guess / total * shapes::pdf(light, receiver.position, direction, distance);
    if pdf.is_finite() { pdf } else { 0.0 }
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

    fn receiver(position: Vec3) -> Receiver {
        Receiver { position, instance: 0 }
    }

    #[test]
    fn lamps_are_chosen_by_their_light() {
        let lights =
            [lamp(LightKind::Point, 0.0, 1.0), lamp(LightKind::Point, 0.0, 0.0), lamp(LightKind::Point, 4.0, 10.0)];
        let mut random = Random::new(1);
        let (mut sum, n) = (0.0, 20_000);
        let here = receiver(Vec3::ZERO);
        for _ in 0..n {
            let drawn = sample(&lights, here, total(&lights, here), random.point3()).unwrap();
            sum += f64::from(drawn.weight.x);
        }
        let want: f32 = lights.iter().map(|l| at(l, Vec3::ZERO).irradiance.x).sum();
        assert!((sum / f64::from(n) / f64::from(want) - 1.0).abs() < 1e-4);
        assert_eq!(sample(&[], here, 0.0, Vec3::splat(0.5)), None);
        assert_eq!(sample(&lights[1..2], here, 0.0, Vec3::splat(0.5)), None);
    }

    #[test]
    fn a_lamp_is_not_drawn_where_it_does_not_shine() {
        let lights =
            [Light { unlit: vec![0], ..lamp(LightKind::Point, 0.0, 1.0) }, lamp(LightKind::PARALLEL, 0.0, 1.0)];
        let mut random = Random::new(1);
        for (instance, want) in [(0, 1), (1, 2)] {
            let here = Receiver { instance, ..receiver(Vec3::ZERO) };
            let draw = |_| sample(&lights, here, total(&lights, here), random.point3()).map(|drawn| drawn.lamp);
            let drawn: std::collections::BTreeSet<_> = (0..64).map(draw).collect();
            assert_eq!(drawn.len(), want);
        }
    }

    #[test]
    fn lamps_of_all_kinds_are_finite_everywhere() {
        let rectangle = |size| LightKind::Rectangle { across: Vec3::X, size };
        let kinds = [
            LightKind::Point,
            LightKind::Spot { inner_angle: 0.0, outer_angle: 1e-3 },
            LightKind::PARALLEL,
            LightKind::Directional { angular_radius: 2e-4 },
            rectangle(glam::Vec2::ONE),
            rectangle(glam::Vec2::new(1e-20, 1.0)),
            rectangle(glam::Vec2::splat(1e6)),
            LightKind::Sphere { radius: 0.0 },
            LightKind::Sphere { radius: 1e-18 },
            LightKind::Sphere { radius: 1e6 },
        ];
        for kind in kinds {
            for intensity in [0.0, 1.0, 1e9] {
                let light = lamp(kind, 0.0, intensity);
                let steps = [0.0, 1e-30, 1e-7, 1e-3, 1.0, 1e4];
                for at in steps.iter().flat_map(|s| [Vec3::X, Vec3::NEG_Y, Vec3::ONE].map(|d| light.position + d * *s))
                {
                    let here = receiver(at);
                    let lights = std::slice::from_ref(&light);
                    let sum = total(lights, here);
                    assert!(sum.is_finite() && sum >= 0.0, "{kind:?} {at}: {sum}");
                    let Some(drawn) = sample(lights, here, sum, Vec3::new(0.3, 0.6, 0.5)) else { continue };
                    assert!(drawn.direction.is_finite() && drawn.weight.is_finite(), "{kind:?} {at}: {drawn:?}");
                    assert!(drawn.pdf > 0.0 && intensity > 0.0, "{kind:?} {at}: {drawn:?}");
                }
            }
        }
    }
}
