//! The places near a point, by a grid and by sets of neighbours that each place keeps.

use glam::{UVec3, Vec3};
use rayon::prelude::*;

use crate::lighting::Prepared;

/// Places in a set of neighbours, the place itself among them.
pub const SET: usize = 8;
/// Least cosine between the normals of places that light the same surface.
pub const AGREEMENT: f32 = 0.5;
/// Cells of a grid along an axis, at most.
const MOST_CELLS: u32 = 256;
/// Rings of cells around a point that are searched.
pub const RINGS: i32 = 6;

/// A grid over places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Its corner, metres.
    pub low: Vec3,
    /// Edge of a cell, metres.
    pub edge: f32,
    /// Cells along each axis.
    pub size: UVec3,
}

impl Grid {
    /// With cells of about four places, which lie on surfaces of so many square metres.
    pub fn around(positions: &[Vec3], area: f64) -> Grid {
        let low = positions.iter().copied().fold(Vec3::splat(f32::MAX), Vec3::min);
        let high = positions.iter().copied().fold(Vec3::splat(f32::MIN), Vec3::max);
        let wide = (high - low).max_element().max(1e-6);
        let spacing = (area / positions.len().max(1) as f64).sqrt() as f32;
        let edge = (2.0 * spacing).clamp(1.001 * wide / MOST_CELLS as f32, wide.max(1e-6));
        let size = ((high - low) / edge).ceil().as_uvec3().clamp(UVec3::ONE, UVec3::splat(MOST_CELLS));
        Grid { low, edge, size }
    }

    /// That of a map with its starts, as they are stored; `None` where there is none, or numbers do not belong together.
    pub fn of(prepared: &Prepared) -> Option<(Grid, &[u32])> {
        let (size, starts) = (prepared.whole("cells"), prepared.whole("starts"));
        let size = UVec3::from_array(size.try_into().ok()?);
        let grid = Grid { low: prepared.vector("grid", 0), edge: prepared.vector("grid", 1).x, size };
        let is_sound = grid.edge > 0.0 && size.min_element() > 0 && size.max_element() <= MOST_CELLS;
        (is_sound && starts.len() == grid.cells() + 1).then_some((grid, starts))
    }

    /// Cells in all.
    fn cells(&self) -> usize {
        self.size.element_product() as usize
    }

    /// The cell of a point, the nearest where it is outside.
    fn cell(&self, position: Vec3) -> UVec3 {
        let at = ((position - self.low) / self.edge).floor().max(Vec3::ZERO);
        at.as_uvec3().min(self.size - 1)
    }

    fn index(&self, cell: UVec3) -> usize {
        ((cell.z * self.size.y + cell.y) * self.size.x + cell.x) as usize
    }

    /// Places in the order of their cells.
    pub fn order(&self, positions: &[Vec3]) -> Vec<u32> {
        let mut order: Vec<u32> = (0..positions.len() as u32).collect();
        order.sort_by_key(|i| (self.index(self.cell(positions[*i as usize])), *i));
        order
    }

    /// Where the places of each cell start, and where the last end.
    pub fn starts(&self, ordered: &[f32]) -> Vec<u32> {
        let cells = self.cells();
        let mut starts = vec![0u32; cells + 1];
        for position in ordered.chunks_exact(3) {
            starts[self.index(self.cell(Vec3::from_slice(position))) + 1] += 1;
        }
        for i in 0..cells {
            starts[i + 1] += starts[i];
        }
        starts
    }
}

/// Which places light a point, and how much each counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Filter {
    /// All of a set count the same; else by a hat over the distance.
    pub box_shaped: bool,
    /// Places count whose surface faces elsewhere or lies off the plane of the point, as they would without a guard against leaks. The places are
    /// searched anew for each point, since sets hold none of these.
    pub unguarded: bool,
}

/// Places in the order of a grid.
#[derive(Clone, Copy, Debug)]
pub struct Near<'a> {
    positions: &'a [f32],
    normals: &'a [f32],
    grid: Grid,
    starts: &'a [u32],
    neighbours: &'a [u32],
}

impl<'a> Near<'a> {
    /// Arrays as they are stored; without sets of neighbours only [`Near::nearest`] finds something.
    pub fn new(
        positions: &'a [f32],
        normals: &'a [f32],
        grid: Grid,
        starts: &'a [u32],
        neighbours: &'a [u32],
    ) -> Near<'a> {
        Near { positions, normals, grid, starts, neighbours }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.positions.len() / 3
    }

    /// There are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Metres.
    pub fn position(&self, place: u32) -> Vec3 {
        vector(self.positions, place)
    }

    /// Unit.
    pub fn normal(&self, place: u32) -> Vec3 {
        vector(self.normals, place)
    }

    /// The `count` nearest places whose normal agrees, the nearest first; fewer where there are not so many nearby.
    pub fn nearest(&self, position: Vec3, normal: Vec3, count: usize) -> Vec<u32> {
        self.found(position, normal, AGREEMENT, count)
    }

    /// Likewise, whatever their normal.
    pub fn nearest_of_all(&self, position: Vec3, count: usize) -> Vec<u32> {
        self.found(position, Vec3::Z, f32::NEG_INFINITY, count)
    }

    fn found(&self, position: Vec3, normal: Vec3, agreement: f32, count: usize) -> Vec<u32> {
        let mut found: Vec<(f32, u32)> = Vec::with_capacity(count + 1);
        if self.is_empty() {
            return Vec::new();
        }
        let middle = self.grid.cell(position).as_ivec3();
        let size = self.grid.size.as_ivec3();
        for ring in 0..=RINGS {
            // All within this are in the rings so far.
            let covered = self.grid.edge * (ring - 1) as f32;
            if found.len() == count && found.last().is_some_and(|last| last.0.sqrt() <= covered) {
                break;
            }
            let (low, high) = ((middle - ring).max(glam::IVec3::ZERO), (middle + ring).min(size - 1));
            for z in low.z..=high.z {
                for y in low.y..=high.y {
                    let is_face = (z - middle.z).abs() == ring || (y - middle.y).abs() == ring;
                    let step = if is_face || ring == 0 { 1 } else { 2 * ring };
                    let mut x = if is_face { low.x } else { middle.x - ring };
                    while x <= high.x {
                        if x >= low.x {
                            let cell = glam::IVec3::new(x, y, z).as_uvec3();
                            self.gather(cell, (position, normal, agreement), count, &mut found);
                        }
                        x += step;
                    }
                }
            }
        }
        found.into_iter().map(|(_, place)| place).collect()
    }

    fn gather(
        &self,
        cell: UVec3,
        (position, normal, agreement): (Vec3, Vec3, f32),
        count: usize,
        found: &mut Vec<(f32, u32)>,
    ) {
        let cell = self.grid.index(cell);
        for place in self.starts[cell]..self.starts[cell + 1].min(self.len() as u32) {
            if self.normal(place).dot(normal) < agreement {
                continue;
            }
            let distance = self.position(place).distance_squared(position);
            if found.len() == count && found.last().is_some_and(|last| distance >= last.0) {
                continue;
            }
            let at = found.partition_point(|known| *known <= (distance, place));
            found.insert(at, (distance, place));
            found.truncate(count);
        }
    }

    /// The sets of all places, [`SET`] numbers each; a place that has fewer neighbours repeats itself.
    pub fn neighbours(&self) -> Vec<u32> {
        let of = |place: u32| {
            let mut set = self.nearest(self.position(place), self.normal(place), SET);
            set.resize(SET, place);
            set
        };
        (0..self.len() as u32).into_par_iter().flat_map_iter(of).collect()
    }

    /// The set of the place that is nearest to a point; of one with another normal where none agrees, and none where there are no places.
    pub fn set(&self, position: Vec3, normal: Vec3) -> Option<&'a [u32]> {
        let nearest = self.nearest(position, normal, 1);
        let place = *nearest.first().or(self.any(position).as_ref())?;
        Some(self.neighbours_of(place)).filter(|set| !set.is_empty())
    }

    /// The set of a place; empty where none is kept.
    pub fn neighbours_of(&self, place: u32) -> &'a [u32] {
        let first = SET * place as usize;
        self.neighbours.get(first..first + SET).unwrap_or_default()
    }

    /// A place in the cell of a point, or in the next one that has some.
    fn any(&self, position: Vec3) -> Option<u32> {
        let cell = self.grid.index(self.grid.cell(position));
        let first = *self.starts.get(cell)?;
        (!self.is_empty()).then(|| first.min(self.len() as u32 - 1))
    }
}

/// Zero where a file names a place that is not there.
fn vector(of: &[f32], place: u32) -> Vec3 {
    let first = 3 * place as usize;
    of.get(first..first + 3).map_or(Vec3::ZERO, Vec3::from_slice)
}

/// Weights of the places of a set at a point: a hat over the distance that ends a little beyond the farthest, times how far the normals agree, times how
/// near the place is to the plane of the surface. They sum to 1.
pub fn weights(near: &Near<'_>, set: &[u32], position: Vec3, normal: Vec3, filter: Filter) -> [f32; SET] {
    /// So that the farthest place counts a little.
    const BEYOND: f32 = 1.0001;
    let mut distances = [0.0; SET];
    for (distance, place) in distances.iter_mut().zip(set) {
        *distance = near.position(*place).distance(position);
    }
    let reach = BEYOND * distances.into_iter().fold(0.0, f32::max);
    let mut weights = [0.0; SET];
    for (i, place) in set.iter().enumerate().take(SET) {
        let agreement = ((near.normal(*place).dot(normal) - AGREEMENT) / (1.0 - AGREEMENT)).max(0.0);
        let off_plane = (near.position(*place) - position).dot(normal).abs();
        let flat = (1.0 - 2.0 * off_plane / reach.max(1e-20)).max(0.0);
        let shape = if filter.box_shaped { 1.0 } else { (1.0 - distances[i] / reach.max(1e-20)).max(0.0) };
        weights[i] = shape * if filter.unguarded { 1.0 } else { agreement * flat };
    }
    let sum: f32 = weights.iter().sum();
    if sum > 1e-12 {
        return weights.map(|weight| weight / sum);
    }
    // None counts: the nearest.
    let nearest = (0..set.len().min(SET)).min_by(|a, b| distances[*a].total_cmp(&distances[*b])).unwrap_or(0);
    std::array::from_fn(|i| if i == nearest { 1.0 } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::sampling::Random;

    fn places(count: usize) -> (Vec<Vec3>, Vec<Vec3>) {
        let mut random = Random::new(3);
        let next = |_| {
            let (u, v) = (random.point2(), random.unit());
            // Two walls of a corner.
            if v < 0.5 { (Vec3::new(2.0 * u.x, u.y, 0.0), Vec3::Z) } else { (Vec3::new(0.0, u.y, 2.0 * u.x), Vec3::X) }
        };
        (0..count).map(next).unzip()
    }

    #[test]
    fn the_nearest_are_those_that_a_search_of_all_finds() {
        let (positions, normals) = places(3000);
        let grid = Grid::around(&positions, 4.0);
        let order = grid.order(&positions);
        let flat = |all: &[Vec3]| -> Vec<f32> { order.iter().flat_map(|i| all[*i as usize].to_array()).collect() };
        let (positions, normals) = (flat(&positions), flat(&normals));
        let starts = grid.starts(&positions);
        let near = Near::new(&positions, &normals, grid, &starts, &[]);
        let mut random = Random::new(8);
        for _ in 0..2000 {
            let u = random.point3();
            let (at, normal) = if u.z < 0.5 {
                (Vec3::new(2.0 * u.x, u.y, 0.0), Vec3::Z)
            } else {
                (Vec3::new(0.0, u.y, 2.0 * u.x), Vec3::X)
            };
            let found = near.nearest(at, normal, SET);
            let mut all: Vec<(f32, u32)> = (0..near.len() as u32)
                .filter(|i| near.normal(*i).dot(normal) >= AGREEMENT)
                .map(|i| (near.position(i).distance_squared(at), i))
                .collect();
            all.sort_by(|a, b| a.partial_cmp(b).unwrap());
            let wanted: Vec<u32> = all.iter().take(SET).map(|(_, i)| *i).collect();
            assert_eq!(found, wanted, "{at}");
        }
        let sets = near.neighbours();
        let near = Near::new(&positions, &normals, grid, &starts, &sets);
        let set = near.set(Vec3::new(0.7, 0.5, 0.0), Vec3::Z).unwrap();
        assert_eq!(set.len(), SET);
        let at = |filter| weights(&near, set, Vec3::new(0.7, 0.5, 0.0), Vec3::Z, filter);
        for (box_shaped, unguarded) in [(false, false), (false, true), (true, false), (true, true)] {
            let weights = at(Filter { box_shaped, unguarded });
            assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-5 && weights.iter().all(|w| *w >= 0.0));
        }
        // On a plane all of a box count the same, whose hats do not.
        assert_eq!(at(Filter { box_shaped: true, unguarded: false }), [0.125; SET]);
        assert!(at(Filter::default()).iter().any(|w| (w - 0.125).abs() > 0.01));
        // Close to the edge, where the other wall is nearer than what is on the own.
        let edge = Vec3::new(0.01, 0.5, 0.0);
        let normals = |places: &[u32]| places.iter().filter(|place| near.normal(**place) == Vec3::X).count();
        assert!(normals(&near.nearest(edge, Vec3::Z, 8)) == 0 && normals(&near.nearest_of_all(edge, 8)) > 0);
        // Far outside, and beside no normal: something that is there.
        assert!(near.set(Vec3::splat(100.0), Vec3::NEG_Y).is_some());
        assert!(Near::new(&[], &[], grid, &starts, &[]).set(Vec3::ZERO, Vec3::Z).is_none());
    }
}
