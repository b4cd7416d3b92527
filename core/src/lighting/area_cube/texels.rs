//! The coarse cube: made of a fine one, and kept as plain numbers.

use std::f32::consts::TAU;

use glam::{Vec2, Vec3};

use crate::math::cube::{self, mirrored};

/// Texels along the edge of a face that there are to choose from.
pub const EDGES: [u32; 4] = [2, 4, 8, 16];
/// Numbers of a texel.
pub const NUMBERS: usize = 12;
/// The cosine under which the middle sees a surface is taken for at least this: a texel that is seen edge on says little about
/// how large its surface is.
pub const COS_MIN: f32 = 0.1;
/// Distances around a place whose ratio is above this belong to different surfaces.
const JUMP: f32 = 1.3;

/// A texel as a light. What does not change with the point that it lights is multiplied in.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Texel {
    /// Its middle, metres from the middle of the cube; of the sky the unit direction.
    pub place: Vec3,
    /// `sin^2` of half the angle under which the middle sees it, times the square of its distance; 0 of the sky.
    pub spread: f32,
    /// Normal of its surface, on the side of the middle, over the cosine under which the middle sees it.
    pub normal: Vec3,
    /// Cosine of half the angle under which the middle sees it: `1 - w / (2 pi)`.
    pub cosine: f32,
    /// Mean radiance.
    pub radiance: Vec3,
}

impl Texel {
    /// That fills `solid_angle` steradians in a unit direction. `distance` 0 is the sky; `normal` is unit, of any side.
    pub fn new(direction: Vec3, solid_angle: f32, distance: f32, normal: Vec3, radiance: Vec3) -> Texel {
        let w = solid_angle / TAU;
        let side = if normal.dot(direction) > 0.0 { -1.0 } else { 1.0 };
        let cos_theta = normal.dot(direction).abs().max(COS_MIN);
        let place = if distance > 0.0 { distance * direction } else { direction };
        let spread = w * (2.0 - w) * distance * distance;
        Texel { place, spread, normal: side * normal / cos_theta, cosine: 1.0 - w, radiance }
    }

    /// Steradians that it fills from the middle.
    pub fn solid_angle(&self) -> f32 {
        TAU * (1.0 - self.cosine)
    }

    /// As it is kept: place, spread, normal, cosine, radiance, nothing.
    pub fn to_array(&self) -> [f32; NUMBERS] {
        let Texel { place: p, spread, normal: n, cosine, radiance: l } = *self;
        [p.x, p.y, p.z, spread, n.x, n.y, n.z, cosine, l.x, l.y, l.z, 0.0]
    }

    /// The inverse of [`Texel::to_array`].
    pub fn of_array(v: &[f32; NUMBERS]) -> Texel {
        let at = |i: usize| Vec3::new(v[i], v[i + 1], v[i + 2]);
        Texel { place: at(0), spread: v[3], normal: at(4), cosine: v[7], radiance: at(8) }
    }
}

/// The texels of a cube, by faces, rows, columns.
#[derive(Clone, Copy, Debug)]
pub struct Texels<'a> {
    edge: u32,
    numbers: &'a [[f32; NUMBERS]],
}

impl<'a> Texels<'a> {
    /// Those with `edge` texels along an edge from the numbers of all [`EDGES`] one after the other; `None` where they are not
    /// there.
    pub fn of(all: &'a [f32], edge: u32) -> Option<Texels<'a>> {
        let (texels, _) = all.as_chunks::<NUMBERS>();
        let first: u32 = EDGES.iter().take_while(|e| **e < edge).map(|e| 6 * e * e).sum();
        let numbers = texels.get(first as usize..(first + 6 * edge * edge) as usize)?;
        Some(Texels { edge, numbers })
    }

    /// Along an edge of a face.
    pub fn edge(&self) -> u32 {
        self.edge
    }

    /// One by its number; black beyond the last.
    pub fn get(&self, index: u32) -> Texel {
        self.numbers.get(index as usize).map_or(Texel::default(), Texel::of_array)
    }

    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = Texel> + use<'a> {
        self.numbers.iter().map(Texel::of_array)
    }
}

/// Solid angle of the rectangle of a face between two of its points, which are in [-1, 1]^2: exact, and 4 pi over a cube.
pub fn solid_angle(low: Vec2, high: Vec2) -> f32 {
    let corner = |x: f32, y: f32| {
        let (x, y) = (f64::from(x), f64::from(y));
        (x * y).atan2((x * x + y * y + 1.0).sqrt())
    };
    (corner(high.x, high.y) - corner(low.x, high.y) - corner(high.x, low.y) + corner(low.x, low.y)) as f32
}

/// The texels of a cube with `edge` texels along an edge, each the mean over `parts` x `parts` of it, weighed by their exact
/// solid angles. `light` is the radiance in a unit direction, `distance` metres to the surface, 0 for the sky. A texel most of
/// which is sky is sky.
pub fn downsample(edge: u32, parts: u32, light: &impl Fn(Vec3) -> Vec3, distance: &impl Fn(Vec3) -> f32) -> Vec<Texel> {
    let places = (0..6 * edge * edge).map(|i| (i / (edge * edge), i % edge, i / edge % edge));
    places.map(|(face, x, y)| texel(edge, (face, x, y), parts, light, distance)).collect()
}

fn texel(
    edge: u32,
    (face, x, y): (u32, u32, u32),
    parts: u32,
    light: &impl Fn(Vec3) -> Vec3,
    distance: &impl Fn(Vec3) -> f32,
) -> Texel {
    let size = 2.0 / edge as f32;
    let low = Vec2::new(x as f32, y as f32) * size - 1.0;
    let part = size / parts.max(1) as f32;
    let direction = |p: Vec2| mirrored(cube::direction(face, p));
    let (mut whole, mut covered, mut far) = (0.0, 0.0, 0.0);
    let (mut radiance, mut normal) = (Vec3::ZERO, Vec3::ZERO);
    for i in 0..parts.max(1).pow(2) {
        let corner = low + Vec2::new((i % parts) as f32, (i / parts) as f32) * part;
        let middle = corner + 0.5 * part;
        let weight = solid_angle(corner, corner + part);
        let d = direction(middle);
        whole += weight;
        radiance += weight * light(d);
        let found = distance(d);
        if found > 0.0 {
            covered += weight;
            far += weight * found;
            let around = [Vec2::X, Vec2::NEG_X, Vec2::Y, Vec2::NEG_Y].map(|to| direction(middle + 0.5 * part * to));
            normal += weight * gradient_normal(around, distance);
        }
    }
    let (toward, exact) = (direction(low + 0.5 * size), solid_angle(low, low + size));
    let far = if covered > 0.5 * whole { far / covered } else { 0.0 };
    Texel::new(toward, exact, far, normal.normalize_or(-toward), radiance / whole)
}

/// Normal, on the side of the middle, of the surface between four directions about a place: right, left, below, above. Zero
/// where they do not meet one surface.
fn gradient_normal(around: [Vec3; 4], distance: &impl Fn(Vec3) -> f32) -> Vec3 {
    let distances = around.map(distance);
    let (least, most) = (distances.into_iter().fold(f32::MAX, f32::min), distances.into_iter().fold(0.0, f32::max));
    if !(least > 0.0 && most <= JUMP * least) {
        return Vec3::ZERO;
    }
    let [right, left, below, above] = std::array::from_fn(|i| distances[i] * around[i]);
    let normal = (right - left).cross(below - above).normalize_or_zero();
    if normal.dot(right) > 0.0 { -normal } else { normal }
}
