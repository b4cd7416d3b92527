//! Lights with a size, as a point sees them: drawn evenly by solid angle, so that only their edges and what they light
//! make noise.

use std::f32::consts::TAU;

use glam::{DVec2, DVec3, Vec2, Vec3};

use crate::math::frame::Frame;
use crate::scene::{Light, LightKind};

/// Solid angle in steradians below which a rectangle is drawn by area: arcs of its edges have lost their digits there.
const SMALL: f64 = 1e-4;
/// Solid angle below which a light is not there.
const NOTHING: f32 = 1e-30;

/// A direction toward a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ShapeSample {
    /// Unit, toward the light.
    pub direction: Vec3,
    /// Metres to it; infinite for a sun.
    pub distance: f32,
    /// Per steradian, finite.
    pub pdf: f32,
}

/// Steradians that the light fills at a point; zero where it shines away from there, or has no size.
pub(super) fn solid_angle(light: &Light, position: Vec3) -> f32 {
    let angle = match light.kind {
        LightKind::Rectangle { across, size } => {
            Seen::new(light, across, size, position).map_or(0.0, |s| s.angle as f32)
        }
        LightKind::Sphere { radius } => Cone::of_sphere(light.position - position, radius).angle(),
        LightKind::Directional { .. } if light.kind.is_sharp() => 0.0,
        LightKind::Directional { angular_radius } => Cone::of_angle(angular_radius).angle(),
        LightKind::Point | LightKind::Spot { .. } => 0.0,
    };
    if angle > NOTHING { angle } else { 0.0 }
}

/// A direction in which the light is seen, all of them alike; `u` in `[0, 1)^2`.
pub(super) fn sample(light: &Light, position: Vec3, u: Vec2) -> Option<ShapeSample> {
    let angle = solid_angle(light, position);
    if angle <= 0.0 {
        return None;
    }
    match light.kind {
        LightKind::Rectangle { across, size } => Seen::new(light, across, size, position)?.sample(u),
        LightKind::Sphere { radius } => {
            let toward = light.position - position;
            let direction = Cone::of_sphere(toward, radius).sample(toward.normalize_or(Vec3::Z), u);
            Some(ShapeSample { direction, distance: to_sphere(toward, radius, direction), pdf: angle.recip() })
        }
        LightKind::Directional { angular_radius } => {
            let direction = Cone::of_angle(angular_radius).sample(-light.direction, u);
            Some(ShapeSample { direction, distance: f32::INFINITY, pdf: angle.recip() })
        }
        LightKind::Point | LightKind::Spot { .. } => None,
    }
}

/// Metres along a ray (unit) at which it meets the light; `None` where it does not, or has no size.
pub(super) fn meet(light: &Light, origin: Vec3, direction: Vec3) -> Option<f32> {
    match light.kind {
        LightKind::Rectangle { across, size } => {
            let facing = -light.direction.dot(direction);
            let toward = light.position - origin;
            let t = -toward.dot(light.direction) / facing;
            // Also false for a ray in the plane, which has no such t.
            let ahead = facing > 0.0 && t > 0.0 && t.is_finite();
            let at = direction * t - toward;
            let up = across.cross(light.direction);
            let inside = at.dot(across).abs() <= 0.5 * size.x && at.dot(up).abs() <= 0.5 * size.y;
            (ahead && inside && size.min_element() > 0.0).then_some(t)
        }
        LightKind::Sphere { radius } => {
            let toward = light.position - origin;
            let along = toward.dot(direction);
            let is_inside = toward.length_squared() < radius * radius;
            let off = (toward - direction * along).length_squared();
            let met = off <= radius * radius && (is_inside || along > 0.0) && radius > 0.0;
            met.then(|| to_sphere(toward, radius, direction))
        }
        LightKind::Directional { angular_radius } if !light.kind.is_sharp() => {
            // The chord keeps its digits for small angles.
            let chord = 2.0 * (0.5 * angular_radius).sin();
            ((direction + light.direction).length_squared() <= chord * chord).then_some(f32::INFINITY)
        }
        _ => None,
    }
}

/// Density per steradian with which [`sample`] draws a direction that meets the light after `distance`.
pub(super) fn pdf(light: &Light, position: Vec3, direction: Vec3, distance: f32) -> f32 {
    if let LightKind::Rectangle { across, size } = light.kind {
        let Some(seen) = Seen::new(light, across, size, position) else { return 0.0 };
        if seen.angle < SMALL {
            return by_area(distance, -light.direction.dot(direction), size);
        }
    }
    let angle = solid_angle(light, position);
    if angle > 0.0 { angle.recip() } else { 0.0 }
}

/// The density of even points of a rectangle.
fn by_area(distance: f32, cos_theta: f32, size: Vec2) -> f32 {
    distance * distance / (cos_theta * size.x * size.y)
}

/// Metres to the first meeting with a sphere whose centre lies at `toward`, from inside to where one leaves it.
fn to_sphere(toward: Vec3, radius: f32, direction: Vec3) -> f32 {
    let along = toward.dot(direction);
    let off = (toward - direction * along).length_squared();
    let half = (radius * radius - off).max(0.0).sqrt();
    if toward.length_squared() < radius * radius { along + half } else { (along - half).max(0.0) }
}

/// Directions about an axis.
#[derive(Clone, Copy)]
struct Cone {
    /// One less the cosine of its half angle, 0 to 2.
    height: f32,
}

impl Cone {
    fn of_angle(half_angle: f32) -> Cone {
        Cone { height: 2.0 * (0.5 * half_angle).sin().powi(2) }
    }

    /// All directions from inside of the sphere.
    fn of_sphere(toward: Vec3, radius: f32) -> Cone {
        let sin2 = radius * radius / toward.length_squared();
        // Also for a point in the middle, where the quotient is none.
        let is_outside = sin2 < 1.0;
        if !is_outside && radius > 0.0 {
            let is_inside = toward.length_squared() < radius * radius;
            return Cone { height: if is_inside { 2.0 } else { 1.0 } };
        }
        Cone { height: if radius > 0.0 { sin2 / (1.0 + (1.0 - sin2).sqrt()) } else { 0.0 } }
    }

    fn angle(self) -> f32 {
        TAU * self.height
    }

    fn sample(self, axis: Vec3, u: Vec2) -> Vec3 {
        let height = self.height * u.x;
        let radius = (height * (2.0 - height)).max(0.0).sqrt();
        let (sin, cos) = (TAU * u.y).sin_cos();
        Frame::new(axis).to_world(Vec3::new(radius * cos, radius * sin, 1.0 - height)).normalize()
    }
}

/// A rectangle from a point before it: local x runs across, z away from the point.
struct Seen {
    axes: [DVec3; 3],
    /// Corners.
    least: DVec2,
    most: DVec2,
    /// Metres to its plane.
    depth: f64,
    /// Steradians.
    angle: f64,
    size: Vec2,
}

impl Seen {
    /// `None` from behind and without an area.
    fn new(light: &Light, across: Vec3, size: Vec2, position: Vec3) -> Option<Seen> {
        let toward = light.position.as_dvec3() - position.as_dvec3();
        let (x, z) = (across.as_dvec3(), -light.direction.as_dvec3());
        let y = z.cross(x);
        let depth = toward.dot(z);
        // Also false for numbers that are none.
        let is_before = depth > 0.0 && size.min_element() > 0.0;
        if !is_before {
            return None;
        }
        let (center, half) = (DVec2::new(toward.dot(x), toward.dot(y)), 0.5 * size.as_dvec2());
        let (least, most) = (center - half, center + half);
        // Solid angle of the rectangle from the point's foot to a corner, with the signs of its sides.
        let to = |x: f64, y: f64| (x * y / (depth * (x * x + y * y + depth * depth).sqrt())).atan();
        let angle = to(most.x, most.y) - to(least.x, most.y) - to(most.x, least.y) + to(least.x, least.y);
        (angle > 0.0).then_some(Seen { axes: [x, y, z], least, most, depth, angle, size })
    }

    fn sample(&self, u: Vec2) -> Option<ShapeSample> {
        let u = u.as_dvec2();
        let is_small = self.angle < SMALL;
        let at = if is_small { self.least + u * (self.most - self.least) } else { self.by_solid_angle(u) };
        let [x, y, z] = self.axes;
        let toward = (x * at.x + y * at.y + z * self.depth).as_vec3();
        let distance = toward.length();
        let direction = toward.try_normalize()?;
        let pdf =
            if is_small { by_area(distance, direction.dot(z.as_vec3()), self.size) } else { self.angle.recip() as f32 };
        (pdf > 0.0 && pdf.is_finite()).then_some(ShapeSample { direction, distance, pdf })
    }

    /// A point of the plane. Urena et al. 2013, An Area-Preserving Parametrization for Spherical Rectangles, section 4:
    /// a cut across the spherical rectangle at a share u of its area, then a point along the cut.
    fn by_solid_angle(&self, u: DVec2) -> DVec2 {
        let (least, most, depth) = (self.least, self.most, self.depth);
        let slope = |edge: f64| edge / (depth * depth + edge * edge).sqrt();
        let (left, low, high) = (slope(least.x), slope(least.y), slope(most.y));
        // The inner angles of the spherical rectangle on its left side.
        let (upper, lower) = ((high * left).acos(), (-left * low).acos());
        let turn = u.x * self.angle + std::f64::consts::TAU - upper - lower;
        let f = -(turn.cos() * low + high) / turn.sin();
        let cos = (f.signum() / (f * f + low * low).sqrt()).clamp(-1.0, 1.0);
        let across = (cos * depth / (1.0 - cos * cos).sqrt()).clamp(least.x, most.x);
        let reach = (across * across + depth * depth).sqrt();
        let sine = |y: f64| y / (reach * reach + y * y).sqrt();
        let (from, to) = (sine(least.y), sine(most.y));
        let h = from + u.y * (to - from);
        let up = h * reach / (1.0 - h * h).max(f64::MIN_POSITIVE).sqrt();
        DVec2::new(across, up.clamp(least.y, most.y))
    }
}

#[cfg(test)]
mod tests {
    use std::f32::consts::PI;

    use super::*;
    use crate::math::sampling::Random;
    use crate::math::statistics::{SphereGrid, sidak, sphere_chi_square};

    fn light(kind: LightKind) -> Light {
        let direction = Vec3::new(0.48, -0.6, 0.64);
        Light { position: Vec3::new(0.2, 1.0, -0.3), direction, kind, ..Light::default() }
    }

    fn rectangle(width: f32, height: f32) -> Light {
        let across = Vec3::new(0.8, 0.0, -0.6);
        light(LightKind::Rectangle { across, size: Vec2::new(width, height) })
    }

    /// A place before the light, along its axes from its centre.
    fn place(light: &Light, at: Vec3) -> Vec3 {
        let across = Vec3::new(0.8, 0.0, -0.6);
        light.position + across * at.x + across.cross(light.direction) * at.y + light.direction * at.z
    }

    fn cases() -> Vec<(&'static str, Light, Vec3)> {
        let panel = rectangle(0.8, 0.5);
        let strip = rectangle(2.0, 0.02);
        let ball = light(LightKind::Sphere { radius: 0.3 });
        let sun = light(LightKind::Directional { angular_radius: 0.2 });
        vec![
            ("panel", panel.clone(), place(&panel, Vec3::new(0.1, 0.2, 0.7))),
            ("near panel", panel.clone(), place(&panel, Vec3::new(0.3, -0.2, 0.01))),
            ("panel from its side", panel.clone(), place(&panel, Vec3::new(2.0, 0.3, 0.2))),
            ("far panel", panel.clone(), place(&panel, Vec3::new(3.0, 20.0, 60.0))),
            ("strip", strip.clone(), place(&strip, Vec3::new(0.4, 0.1, 0.3))),
            ("ball", ball.clone(), place(&ball, Vec3::new(0.5, 0.2, 0.4))),
            ("near ball", ball.clone(), place(&ball, Vec3::new(0.0, 0.0, 0.301))),
            ("far ball", ball.clone(), place(&ball, Vec3::new(0.0, 30.0, 5.0))),
            ("inside of a ball", ball.clone(), place(&ball, Vec3::new(0.1, 0.0, 0.2))),
            ("middle of a ball", ball.clone(), ball.position),
            ("sun", sun.clone(), Vec3::ZERO),
            ("wide sun", light(LightKind::Directional { angular_radius: 1.5 }), Vec3::ZERO),
        ]
    }

    #[test]
    fn directions_follow_their_density() {
        let cases = cases();
        let level = sidak(0.01, cases.len());
        for (name, light, position) in cases {
            let mut random = Random::new(7);
            let draw = || sample(&light, position, random.point2()).map(|s| s.direction);
            let axis = sample(&light, position, Vec2::splat(0.5)).unwrap().direction;
            let width = f64::from(solid_angle(&light, position) / PI).sqrt();
            let density = |w: Vec3| meet(&light, position, w).map_or(0.0, |t| f64::from(pdf(&light, position, w, t)));
            let test = sphere_chi_square(SphereGrid::around(axis, width), 100_000, &density, draw);
            println!("{name}: p {:.4}, mass {:.5}, {} cells", test.p_value, test.mass, test.degrees + 1);
            assert!(test.p_value > level, "{name}: {test:?}");
            assert!((test.mass - 1.0).abs() < 1e-2, "{name}: {test:?}");
        }
    }

    #[test]
    fn a_sample_meets_its_light_at_its_distance_with_its_density() {
        for (name, light, position) in cases() {
            let mut random = Random::new(3);
            let mut missed = 0;
            for _ in 0..2000 {
                let drawn = sample(&light, position, random.point2()).unwrap();
                assert!((drawn.direction.length() - 1.0).abs() < 1e-5, "{name}");
                // Rounding moves some past the edge.
                let Some(t) = meet(&light, position, drawn.direction) else {
                    missed += 1;
                    continue;
                };
                assert!(t == drawn.distance || (t / drawn.distance - 1.0).abs() < 2e-3, "{name}: {t} {drawn:?}");
                let pdf = pdf(&light, position, drawn.direction, t);
                assert!((pdf / drawn.pdf - 1.0).abs() < 5e-3, "{name}: {pdf} {drawn:?}");
            }
            assert!(missed < 20, "{name}: {missed} of 2000");
        }
    }

    #[test]
    fn the_solid_angles_are_those_of_closed_forms() {
        // A face of a cube from its middle; a ball at twice its radius; half of a right angle.
        let face = rectangle(2.0, 2.0);
        let cube = solid_angle(&face, place(&face, Vec3::Z));
        assert!((cube / (4.0 * PI / 6.0) - 1.0).abs() < 1e-6, "{cube}");
        let ball = light(LightKind::Sphere { radius: 1.0 });
        let seen = solid_angle(&ball, place(&ball, 2.0 * Vec3::Z));
        assert!((seen / (TAU * (1.0 - 0.75_f32.sqrt())) - 1.0).abs() < 1e-6, "{seen}");
        let sun = light(LightKind::Directional { angular_radius: 0.00465 });
        assert!((solid_angle(&sun, Vec3::ZERO) / (PI * 0.00465 * 0.00465) - 1.0).abs() < 1e-4);
    }

    #[test]
    fn nothing_comes_from_behind_from_no_size_and_from_the_plane() {
        let panel = rectangle(0.8, 0.5);
        let none = [
            (panel.clone(), place(&panel, Vec3::NEG_Z)),
            (panel.clone(), panel.position),
            (panel.clone(), place(&panel, Vec3::new(2.0, 0.0, -1e-6))),
            (rectangle(0.0, 1.0), place(&panel, Vec3::Z)),
            (light(LightKind::Sphere { radius: 0.0 }), Vec3::ZERO),
            (light(LightKind::Sphere { radius: 0.0 }), light(LightKind::Point).position),
            (light(LightKind::Sphere { radius: 1e-30 }), Vec3::ZERO),
            (light(LightKind::PARALLEL), Vec3::ZERO),
            (light(LightKind::Point), Vec3::ZERO),
        ];
        for (light, position) in none {
            assert_eq!(solid_angle(&light, position), 0.0, "{light:?}");
            assert_eq!(sample(&light, position, Vec2::splat(0.3)), None, "{light:?}");
            let back = (position - light.position).normalize_or(Vec3::X);
            assert_eq!(meet(&light, position, back), None, "{light:?}");
        }
    }
}
