//! The directions in which all points keep light, and the cells of the sphere that belong to them.

use std::f64::consts::{PI, TAU};
use std::sync::OnceLock;

use glam::{DVec2, DVec3, UVec3, Vec2, Vec3, Vec4};

use crate::math::sampling::spiral;

/// How directions are spread over the sphere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Spread {
    /// A spiral with cells of nearly one size.
    #[default]
    Fibonacci,
    /// Halton points of bases 2 and 3, as in the source.
    Halton,
}

impl Spread {
    /// All of them.
    pub const ALL: [Spread; 2] = [Spread::Fibonacci, Spread::Halton];
    /// Their names in files and on the command line.
    pub const IDS: [&'static str; 2] = ["fibonacci", "halton"];
}

/// Fewest directions: with fewer a cell may reach around half of the sphere.
pub const FEWEST: u32 = 12;

/// Lists of directions that are drawn in the cells: pixels and frames take turns, so that errors of few do not add up over a picture.
pub const LISTS: u32 = TURNS[0] * TURNS[1] * TURNS[2];

/// Turns of a list, along the three numbers that decide it.
const TURNS: [u32; 3] = [8, 8, 4];

/// A cell: the directions that are nearer to its own than to any other.
#[derive(Clone, Debug)]
struct Cell {
    /// Axes of the plane that touches the sphere at the direction.
    x: DVec3,
    y: DVec3,
    /// Corners in that plane, counter-clockwise: great circles are lines there.
    corners: Vec<DVec2>,
    /// Areas of the triangles from the middle to the edges, summed up; the last is that of all.
    areas: Vec<f64>,
}

/// Directions with their Voronoi cells.
#[derive(Clone, Debug)]
pub struct Directions {
    spread: Spread,
    list: Vec<Vec3>,
    solid_angles: Vec<f32>,
    cells: Vec<Cell>,
    /// See [`Directions::reach`].
    reach: f32,
    /// See [`Directions::drawn`].
    drawn: OnceLock<Vec<Drawn>>,
}

/// A direction drawn in a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drawn {
    /// Unit.
    pub direction: Vec3,
    /// Density, per steradian, given the cell.
    pub pdf: f32,
}

impl Directions {
    /// `count` directions, at least [`FEWEST`].
    pub fn new(spread: Spread, count: u32) -> Directions {
        let count = count.max(FEWEST);
        let list: Vec<DVec3> = (0..count).map(|k| direction(spread, k, count)).collect();
        let cells: Vec<Cell> = (0..list.len()).map(|k| Cell::new(&list, k)).collect();
        let solid_angles = list.iter().zip(&cells).map(|(own, cell)| cell.solid_angle(*own) as f32).collect();
        // Twice the radius of the widest cell.
        let widest = cells.iter().flat_map(|cell| &cell.corners).map(|p| p.length().atan()).fold(0.0, f64::max);
        let reach = (2.0 * widest).min(PI).cos() as f32;
        Directions {
            spread,
            list: list.iter().map(|d| d.as_vec3()).collect(),
            solid_angles,
            cells,
            reach,
            drawn: OnceLock::new(),
        }
    }

    /// How they are spread.
    pub fn spread(&self) -> Spread {
        self.spread
    }

    /// How many.
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Never.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// One of them, unit.
    pub fn get(&self, k: usize) -> Vec3 {
        self.list[k]
    }

    /// Solid angle of its cell; all together `4 pi`.
    pub fn solid_angle(&self, k: usize) -> f32 {
        self.solid_angles[k]
    }

    /// Irradiance of a surface by the light in each cell, red, green and blue together.
    pub fn irradiance(&self, light: &[Vec3], normal: Vec3) -> f32 {
        let cells = light.iter().zip(&self.list).zip(&self.solid_angles);
        cells.map(|((light, own), solid_angle)| solid_angle * own.dot(normal).max(0.0) * light.element_sum()).sum()
    }

    /// Cosine of the angle beyond which a direction says nothing of another.
    pub fn reach(&self) -> f32 {
        self.reach
    }

    /// One of them, and the area of its cell in the plane that touches the sphere there: what [`Directions::pdf`] is made of.
    pub fn with_area(&self, k: usize) -> Vec4 {
        self.list[k].extend(self.cells[k].areas.last().copied().unwrap_or(0.0) as f32)
    }

    /// A direction in each cell with its density: one of [`LISTS`] lists, which together fill the cells evenly.
    pub fn drawn(&self, list: u32) -> &[Drawn] {
        let [x, y, z] = TURNS;
        let turn = |list: u32| {
            let at = UVec3::new(list / (y * z), list / z % y, list % z);
            (at.as_vec3() + 0.5) / UVec3::new(x, y, z).as_vec3()
        };
        let drawn = self.drawn.get_or_init(|| (0..LISTS).flat_map(|list| self.draw_all(turn(list))).collect());
        let first = self.len() * (list % LISTS) as usize;
        &drawn[first..first + self.len()]
    }

    /// The list for numbers in `[0, 1)^3`: where these are well spread, so is what the lists draw.
    pub fn list_of(random: Vec3) -> u32 {
        let [x, y, z] = TURNS;
        let at = (random * UVec3::new(x, y, z).as_vec3()).as_uvec3().min(UVec3::new(x, y, z) - 1);
        (at.x * y + at.y) * z + at.z
    }

    fn draw_all(&self, turn: Vec3) -> impl Iterator<Item = Drawn> + '_ {
        let count = self.len() as u32;
        (0..count).map(move |k| {
            let u = spiral(k, count, turn.truncate());
            self.draw(k as usize, Vec2::new(u.x, (u.y * 7.0 + turn.z).fract()))
        })
    }

    /// The direction in whose cell another one is.
    pub fn nearest(&self, direction: Vec3) -> usize {
        let cosines = self.list.iter().map(|own| own.dot(direction));
        let best = cosines.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        best.map_or(0, |(k, _)| k)
    }

    /// The other directions by the angle to one of them, the nearest first, itself at the start.
    pub fn around(&self, k: usize) -> Vec<usize> {
        let mut all: Vec<usize> = (0..self.len()).collect();
        let cosine = |i: usize| self.list[i].dot(self.list[k]);
        all.sort_by(|a, b| cosine(*b).total_cmp(&cosine(*a)).then(a.cmp(b)));
        all
    }

    /// A direction in a cell, even in the plane that touches the sphere at its middle; `u` in `[0, 1)^2`.
    pub fn draw(&self, k: usize, u: Vec2) -> Drawn {
        let (own, cell) = (self.list[k].as_dvec3(), &self.cells[k]);
        let whole = cell.areas.last().copied().unwrap_or(0.0);
        let wanted = f64::from(u.x) * whole;
        let edge = cell.areas.partition_point(|area| *area <= wanted).min(cell.areas.len() - 1);
        let before = if edge == 0 { 0.0 } else { cell.areas[edge - 1] };
        let share = ((wanted - before) / (cell.areas[edge] - before).max(1e-300)).clamp(0.0, 1.0);
        let (a, b) = (cell.corners[edge], cell.corners[(edge + 1) % cell.corners.len()]);
        // Even in the triangle from the middle: the root of the way out, the rest along the edge.
        let out = f64::from(u.y).sqrt();
        let at = out * (a + (b - a) * share);
        let toward = own + at.x * cell.x + at.y * cell.y;
        let length = toward.length();
        Drawn { direction: (toward / length).as_vec3(), pdf: (length * length * length / whole) as f32 }
    }

    /// Density of [`Directions::draw`] in a direction of the cell `k`.
    pub fn pdf(&self, k: usize, direction: Vec3) -> f32 {
        let whole = self.cells[k].areas.last().copied().unwrap_or(0.0);
        // The point of the plane is 1 / cosine away.
        let length = 1.0 / f64::from(self.list[k].dot(direction)).max(1e-3);
        (length * length * length / whole) as f32
    }
}

fn direction(spread: Spread, k: u32, count: u32) -> DVec3 {
    let (height, turn) = match spread {
        Spread::Fibonacci => ((f64::from(k) + 0.5) / f64::from(count), f64::from(k) * 0.618_033_988_749_894_9),
        Spread::Halton => (radical_inverse(k + 1, 2), radical_inverse(k + 1, 3)),
    };
    let z = 1.0 - 2.0 * height;
    let level = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
    let (sin, cos) = (TAU * turn).sin_cos();
    DVec3::new(level * cos, level * sin, z)
}

/// Digits of `i` in a base, mirrored at the point.
fn radical_inverse(mut i: u32, base: u32) -> f64 {
    let (mut value, mut place) = (0.0, 1.0 / f64::from(base));
    while i > 0 {
        value += f64::from(i % base) * place;
        place /= f64::from(base);
        i /= base;
    }
    value
}

impl Cell {
    /// Cuts all that is nearer to others off a square around the direction.
    fn new(all: &[DVec3], k: usize) -> Cell {
        /// Half the square: the tangent of nearly a right angle.
        const WIDE: f64 = 1e3;
        let own = all[k];
        let x = own.any_orthonormal_vector();
        let y = own.cross(x);
        let mut corners =
            vec![DVec2::new(-WIDE, -WIDE), DVec2::new(WIDE, -WIDE), DVec2::new(WIDE, WIDE), DVec2::new(-WIDE, WIDE)];
        for (j, other) in all.iter().enumerate() {
            if j == k {
                continue;
            }
            // Nearer to the own: (own - other) . d >= 0, a line in the plane.
            let apart = own - *other;
            let (normal, at_middle) = (DVec2::new(apart.dot(x), apart.dot(y)), apart.dot(own));
            corners = clipped(&corners, |p| normal.dot(p) + at_middle);
        }
        let mut sum = 0.0;
        let edges = (0..corners.len()).map(|i| (corners[i], corners[(i + 1) % corners.len()]));
        let areas = edges
            .map(|(a, b)| {
                sum += 0.5 * a.perp_dot(b);
                sum
            })
            .collect();
        Cell { x, y, corners, areas }
    }

    /// Of triangles from the middle: Van Oosterom and Strackee 1983.
    fn solid_angle(&self, own: DVec3) -> f64 {
        let on_sphere = |p: DVec2| (own + p.x * self.x + p.y * self.y).normalize();
        let edges = (0..self.corners.len()).map(|i| (self.corners[i], self.corners[(i + 1) % self.corners.len()]));
        let triangle = |(a, b): (DVec2, DVec2)| {
            let (a, b) = (on_sphere(a), on_sphere(b));
            let below = 1.0 + own.dot(a) + a.dot(b) + b.dot(own);
            2.0 * own.dot(a.cross(b)).atan2(below)
        };
        edges.map(triangle).sum::<f64>().clamp(0.0, 4.0 * PI)
    }
}

/// The part of a convex polygon where a linear function is not below 0.
fn clipped(corners: &[DVec2], side: impl Fn(DVec2) -> f64) -> Vec<DVec2> {
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for (i, a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let (at_a, at_b) = (side(*a), side(b));
        if at_a >= 0.0 {
            kept.push(*a);
        }
        if (at_a >= 0.0) != (at_b >= 0.0) {
            kept.push(*a + (b - *a) * (at_a / (at_a - at_b)));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::sampling::Random;

    const BOTH: [(Spread, u32); 6] = [
        (Spread::Fibonacci, 18),
        (Spread::Fibonacci, 64),
        (Spread::Fibonacci, 256),
        (Spread::Halton, 18),
        (Spread::Halton, 64),
        (Spread::Halton, 12),
    ];

    #[test]
    fn cells_cover_the_sphere_once_and_hold_what_is_nearest() {
        for (spread, count) in BOTH {
            let all = Directions::new(spread, count);
            let sum: f32 = (0..all.len()).map(|k| all.solid_angle(k)).sum();
            assert!((sum - 4.0 * std::f32::consts::PI).abs() < 1e-4, "{spread:?} {count}: {sum}");
            let mut random = Random::new(5);
            let mut hits = vec![0u32; all.len()];
            const RAYS: u32 = 200_000;
            for _ in 0..RAYS {
                let u = random.point2();
                let z = 1.0 - 2.0 * u.x;
                let (sin, cos) = (std::f32::consts::TAU * u.y).sin_cos();
                let level = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
                hits[all.nearest(Vec3::new(level * cos, level * sin, z))] += 1;
            }
            for (k, hits) in hits.iter().enumerate() {
                let expected = all.solid_angle(k) / (4.0 * std::f32::consts::PI) * RAYS as f32;
                assert!(
                    (*hits as f32 - expected).abs() < 5.0 * expected.sqrt() + 1.0,
                    "{spread:?} {k}: {hits} {expected}"
                );
            }
        }
    }

    #[test]
    fn what_is_drawn_is_in_its_cell_and_its_density_is_that_of_the_cell() {
        for (spread, count) in BOTH {
            let all = Directions::new(spread, count);
            let mut random = Random::new(9);
            for k in 0..all.len() {
                let own = all.get(k);
                let (mut area, mut mean) = (0.0, Vec3::ZERO);
                const DRAWN: u32 = 2000;
                for _ in 0..DRAWN {
                    let Drawn { direction, pdf } = all.draw(k, random.point2());
                    let best = all.get(all.nearest(direction));
                    assert!(direction.dot(own) >= direction.dot(best) - 1e-5, "{spread:?} {k}");
                    assert!((pdf / all.pdf(k, direction) - 1.0).abs() < 1e-3);
                    area += 1.0 / pdf / DRAWN as f32;
                    mean += direction / pdf / DRAWN as f32;
                }
                // The mean of 1 / density is the solid angle.
                let solid = all.solid_angle(k);
                assert!((area / solid - 1.0).abs() < 0.06, "{spread:?} {k}: {area} {solid}");
                assert!(mean.length() <= 1.06 * solid);
            }
        }
    }

    /// Least and greatest irradiance of a field of radiance `1 / pi` over normals, with the cells' solid angles or equal ones.
    fn irradiance(spread: Spread, count: u32, equal: bool) -> [f32; 2] {
        let all = Directions::new(spread, count);
        let normals = Directions::new(Spread::Fibonacci, 4000);
        let of = |n: Vec3| {
            let weight = |k| if equal { 4.0 * std::f32::consts::PI / count as f32 } else { all.solid_angle(k) };
            (0..all.len()).map(|k| weight(k) * n.dot(all.get(k)).max(0.0)).sum::<f32>() / std::f32::consts::PI
        };
        let values: Vec<f32> = (0..normals.len()).map(|i| of(normals.get(i))).collect();
        [values.iter().copied().fold(f32::MAX, f32::min), values.iter().copied().fold(0.0, f32::max)]
    }

    #[test]
    fn irradiance_of_an_even_field_is_as_computed_elsewhere() {
        // Computed apart from this code, in the notes on the source.
        let expected = [
            (Spread::Halton, 18, false, [0.86, 1.09]),
            (Spread::Halton, 18, true, [0.76, 1.24]),
            (Spread::Fibonacci, 18, false, [0.93, 1.04]),
            (Spread::Fibonacci, 64, false, [0.986, 1.014]),
        ];
        for (spread, count, equal, [least, most]) in expected {
            let found = irradiance(spread, count, equal);
            println!("{spread:?} {count} equal {equal}: {found:?}");
            assert!(
                (found[0] - least).abs() < 0.012 && (found[1] - most).abs() < 0.012,
                "{spread:?} {count}: {found:?}"
            );
        }
    }
}
