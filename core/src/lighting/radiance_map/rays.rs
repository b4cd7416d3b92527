//! Smooth surfaces: rays, which take the map where they end and are guided by it.

use glam::Vec3;

use super::directions::Directions;
use super::map::Map;
use super::method::{Effort, list, numbers, reflected};
use crate::math::sampling::pcg;
use crate::reference::{Reflecting, SurfacePoint};

/// Bounces between smooth surfaces that are traced.
pub const MOST_MIRRORS: u32 = 4;

/// Light that a smooth surface sends to the viewer. Of each kind as many directions are drawn as there are to be of the surface: by how it reflects, by
/// the light that the map knows times that, and by where the sky is bright. They are weighed by the balance heuristic.
pub(super) fn traced(map: &Map<'_>, point: &SurfacePoint<'_>, effort: Effort, random: [f32; 4], mirrors: u32) -> Vec3 {
    let reflecting = point.reflecting();
    let guide = Guide::new(map, point, &reflecting, list(random));
    let world = point.world();
    let found = |direction: Vec3, number: u32| {
        let eye = point.toward(direction, pcg(random[3].to_bits().wrapping_add(number)));
        match eye.point() {
            None => Found { light: map.look.strengths[0] * eye.sky(direction), sky: world.sky_density(direction) },
            Some(met) if met.is_behind() => Found::NOTHING,
            Some(met) => {
                let again = numbers(random, number + 977);
                let random = [again.x, again.y, again.z, random[3]];
                // Lamps light it too; where it is seen from the eye the frame adds them.
                let lamps = met.lamps(random).0;
                let light = map.look.strengths[2] * met.emission()
                    + map.look.strengths[1] * lamps
                    + reflected(map, &met, Effort { lobes: 0, ..effort }, random, mirrors + 1);
                Found { light, sky: 0.0 }
            }
        }
    };
    let rays = effort.lobes.max(1);
    let mut sum = Vec3::ZERO;
    for i in 0..rays {
        if let Some(drawn) = reflecting.drawn(numbers(random, i)) {
            let Found { light, sky } = found(drawn.direction, i);
            let others = sky + guide.pdf(drawn.direction);
            let weight = if drawn.pdf.is_finite() { drawn.pdf / (drawn.pdf + others) } else { 1.0 };
            sum += weight * drawn.weight * light;
        }
        if let Some((direction, pdf)) = guide.draw(numbers(random, i + 251)) {
            let (response, own) = reflecting.response_and_density(direction);
            if response != Vec3::ZERO {
                let Found { light, sky } = found(direction, i + 251);
                sum += response * light / (own + pdf + sky);
            }
        }
        if let Some((direction, radiance)) = world.sky_drawn(numbers(random, i + 499).truncate()) {
            let (response, own) = reflecting.response_and_density(direction);
            let light = map.look.strengths[0] * response * radiance;
            if light != Vec3::ZERO && point.sees(direction, f32::INFINITY) {
                sum += light / (own + guide.pdf(direction) + world.sky_density(direction));
            }
        }
    }
    sum / rays as f32
}

/// What a ray finds.
struct Found {
    light: Vec3,
    /// Density with which the sky is drawn there, 0 where a surface hides it.
    sky: f32,
}

impl Found {
    const NOTHING: Found = Found { light: Vec3::ZERO, sky: 0.0 };
}

/// Draws cells by the light that the map knows there times how the surface reflects it.
struct Guide<'a> {
    directions: &'a Directions,
    /// Of the cells, summed up.
    sums: Vec<f32>,
}

impl<'a> Guide<'a> {
    fn new(map: &'a Map<'_>, point: &SurfacePoint<'_>, reflecting: &Reflecting<'_>, list: u32) -> Guide<'a> {
        let directions = &map.directions;
        let known = map.arriving(point.position(), point.normal());
        let mut sum = 0.0;
        let sums = known.iter().zip(directions.drawn(list)).map(|(light, drawn)| {
            let (response, _) = reflecting.response_and_density(drawn.direction);
            let bright = (response * *light).element_sum() / drawn.pdf;
            sum += if bright.is_finite() { bright.max(0.0) } else { 0.0 };
            sum
        });
        Guide { directions, sums: sums.collect() }
    }

    /// A direction and its density; `None` where nothing is known.
    fn draw(&self, u: Vec3) -> Option<(Vec3, f32)> {
        let all = *self.sums.last().filter(|all| **all > 0.0)?;
        let k = self.sums.partition_point(|sum| *sum <= u.z * all).min(self.sums.len() - 1);
        let drawn = self.directions.draw(k, u.truncate());
        Some((drawn.direction, drawn.pdf * self.share(k) / all))
    }

    fn pdf(&self, direction: Vec3) -> f32 {
        let Some(all) = self.sums.last().filter(|all| **all > 0.0) else { return 0.0 };
        let k = self.directions.nearest(direction);
        self.directions.pdf(k, direction) * self.share(k) / all
    }

    fn share(&self, k: usize) -> f32 {
        self.sums[k] - if k > 0 { self.sums[k - 1] } else { 0.0 }
    }
}
