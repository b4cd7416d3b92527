//! A background on a ground: a dome around the place where the map was taken, cut off by a disc under it.
//!
//! For rays from the eye only. Light comes from infinitely far away as before. WGSL twin: `ground.wgsl`.

use glam::{Vec3, Vec4};

use crate::leaf::Leaf;

/// The WGSL twin.
pub static LEAF: Leaf = Leaf { name: "ground", source: include_str!("ground.wgsl"), needs: &[], externs: "" };

/// A dome on a disc, on which the background is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// Middle of the disc, world, metres; its y is the level of the ground.
    pub middle: Vec3,
    /// From the ground to where the map was taken, metres, above 0.
    pub height: f32,
    /// Of the dome about the place where the map was taken, metres, more than the height.
    pub radius: f32,
    /// Shadows of the scene darken the disc.
    pub shadows: bool,
}

impl Ground {
    /// Numbers that a projection can be made with.
    pub fn is_sound(&self) -> bool {
        let Ground { middle, height, radius, shadows: _ } = self;
        middle.is_finite() && *height > 0.0 && radius.is_finite() && radius > height
    }

    /// Where the map was taken, world, metres.
    pub fn center(&self) -> Vec3 {
        self.middle + self.height * Vec3::Y
    }

    /// [`ground_project`] with these numbers.
    pub fn project(&self, origin: Vec3, direction: Vec3) -> Vec4 {
        ground_project(origin, direction, self.center(), self.height, self.radius)
    }
}

/// Direction from the centre of the dome to where a ray leaves it or meets the disc; w is the distance to the disc along the
/// ray, 0 where it is not met. `direction` is a unit vector.
///
/// With `o` the origin from the centre: leaves at `-b + sqrt(b^2 - o.o + radius^2)`, `b = o.direction`; meets the disc at
/// `-(o.y + height) / direction.y`. Rays that miss the dome are seen at their nearest point, those that have it behind them by
/// their direction.
pub fn ground_project(origin: Vec3, direction: Vec3, center: Vec3, height: f32, radius: f32) -> Vec4 {
    let o = origin - center;
    let b = o.dot(direction);
    // Past the rim of the dome the nearest point of the ray, so that nothing jumps there.
    let exit = -b + (b * b - o.dot(o) + radius * radius).max(0.0).sqrt();
    if exit <= 0.0 {
        return direction.extend(0.0);
    }
    let above = o.y + height;
    if above > 0.0 && direction.y < 0.0 {
        let reach = -above / direction.y;
        if reach > 0.0 && reach < exit {
            let p = o + reach * direction;
            if p.length_squared() < radius * radius {
                return p.normalize_or(direction).extend(reach);
            }
        }
    }
    (o + exit * direction).normalize_or(direction).extend(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::sampling::Random;

    const GROUND: Ground = Ground { middle: Vec3::new(1.0, -0.5, 2.0), height: 1.6, radius: 12.0, shadows: false };

    fn unit(random: &mut Random) -> Vec3 {
        let u = random.point2();
        let (sin, cos) = (std::f32::consts::TAU * u.x).sin_cos();
        let level = (4.0 * u.y * (1.0 - u.y)).sqrt();
        Vec3::new(level * cos, 1.0 - 2.0 * u.y, level * sin).normalize()
    }

    #[test]
    fn from_where_the_map_was_taken_everything_is_seen_as_it_is() {
        let mut random = Random::new(1);
        for _ in 0..1000 {
            let d = unit(&mut random);
            let seen = GROUND.project(GROUND.center(), d);
            assert!((seen.truncate() - d).length() < 1e-5, "{d} {seen}");
        }
    }

    #[test]
    fn a_point_of_the_ground_is_seen_alike_from_everywhere() {
        let mut random = Random::new(2);
        let point = GROUND.middle + Vec3::new(3.0, 0.0, -2.0);
        let wanted = (point - GROUND.center()).normalize();
        for _ in 0..1000 {
            let u = random.point2();
            let eye = GROUND.middle + Vec3::new(8.0 * u.x - 4.0, 0.2 + 3.0 * u.y, 2.0);
            let seen = GROUND.project(eye, (point - eye).normalize());
            assert!((seen.truncate() - wanted).length() < 1e-4, "{eye} {seen}");
            assert!((seen.w - (point - eye).length()).abs() < 1e-3, "{eye} {seen}");
        }
    }

    #[test]
    fn a_point_of_the_dome_is_seen_alike_from_everywhere_inside() {
        let mut random = Random::new(3);
        let wanted = Vec3::new(0.6, 0.48, 0.64);
        let point = GROUND.center() + GROUND.radius * wanted;
        for _ in 0..1000 {
            let eye = GROUND.center() + 8.0 * unit(&mut random) * random.point2().x;
            let seen = GROUND.project(eye, (point - eye).normalize());
            assert!((seen.truncate() - wanted).length() < 1e-4 && seen.w == 0.0, "{eye} {seen}");
        }
    }

    #[test]
    fn every_ray_has_a_unit_direction_and_nothing_jumps_at_the_rim() {
        let mut random = Random::new(4);
        for _ in 0..10_000 {
            let eye = 40.0 * unit(&mut random) * random.point2().x;
            let seen = GROUND.project(eye, unit(&mut random));
            assert!(seen.is_finite() && (seen.truncate().length() - 1.0).abs() < 1e-4 && seen.w >= 0.0, "{seen}");
        }
        // Across the edge of the disc ...
        let eye = GROUND.middle + Vec3::new(0.0, 1.0, 0.0);
        let rim = (GROUND.radius * GROUND.radius - GROUND.height * GROUND.height).sqrt();
        let toward = |x: f32| GROUND.project(eye, Vec3::new(x, -1.0, 0.0).normalize()).truncate();
        assert!((toward(rim * 0.9999) - toward(rim * 1.0001)).length() < 1e-3);
        // ... and past the dome from outside.
        let far = GROUND.center() + Vec3::new(0.0, 0.0, 40.0);
        let past = |x: f32| GROUND.project(far, Vec3::new(x, 0.0, -1.0).normalize()).truncate();
        let tangent = GROUND.radius / (40.0f32 * 40.0 - GROUND.radius * GROUND.radius).sqrt();
        assert!((past(tangent * 0.99999) - past(tangent * 1.00001)).length() < 2e-2);
    }
}
