//! A small copy of an environment, for a first picture.

use std::thread;

use burnish_core::scene::Environment;
use glam::Vec3;

/// Most columns of the copy; half as many rows.
const COLUMNS: u32 = 256;

/// The map at no more than 256 by 128 texels, each the mean radiance of the solid angle it covers. A map that small is
/// returned as it is. Reads every texel: half a second for the largest maps in a debug build, so call it where the map
/// was loaded; [`super::EnvironmentPass::coarse`] then has less to do.
pub fn downsampled(environment: &Environment) -> Environment {
    let (width, height) = (environment.width.min(COLUMNS), environment.height.min(COLUMNS / 2));
    if (width, height) == (environment.width, environment.height) {
        return environment.clone();
    }
    let mut texels = vec![Vec3::ZERO; (width * height) as usize];
    let threads = thread::available_parallelism().map_or(1, |n| n.get());
    let rows_each = (height as usize).div_ceil(threads);
    let columns = Overlaps::new(environment.width, width);
    let rows = Overlaps::new(environment.height, height);
    thread::scope(|scope| {
        for (i, part) in texels.chunks_mut(rows_each * width as usize).enumerate() {
            let (rows, columns) = (&rows, &columns);
            scope.spawn(move || {
                for (y, line) in part.chunks_mut(width as usize).enumerate() {
                    fill_row(environment, line, rows.of(i * rows_each + y), columns);
                }
            });
        }
    });
    Environment { width, height, texels: texels.into(), ..environment.clone() }
}

/// One row of the copy from the rows that it covers, with their shares.
fn fill_row(map: &Environment, line: &mut [Vec3], rows: impl Iterator<Item = (usize, f32)>, columns: &Overlaps) {
    let width = map.width as usize;
    let mut total = 0.0;
    for (y, share) in rows {
        let Some(source) = map.texels.get(y * width..(y + 1) * width) else { continue };
        let weight = share * map.texel_solid_angle(y as u32) as f32;
        total += weight;
        for (x, texel) in line.iter_mut().enumerate() {
            *texel += columns.of(x).map(|(x, share)| source[x] * share).sum::<Vec3>() * weight / columns.step;
        }
    }
    line.iter_mut().for_each(|texel| *texel /= f32::max(total, f32::MIN_POSITIVE));
}

/// Which of `from` cells lie how far in each of fewer cells over the same length.
struct Overlaps {
    from: u32,
    /// Old cells to a new one.
    step: f32,
}

impl Overlaps {
    fn new(from: u32, to: u32) -> Overlaps {
        Overlaps { from, step: from as f32 / to as f32 }
    }

    fn of(&self, cell: usize) -> impl Iterator<Item = (usize, f32)> + use<> {
        let (start, end) = (cell as f32 * self.step, (cell + 1) as f32 * self.step);
        let last = (end.ceil() as usize).min(self.from as usize);
        (start as usize..last).map(move |i| (i, (end.min(i as f32 + 1.0) - start.max(i as f32)).max(0.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn power(map: &Environment) -> Vec3 {
        let texel = |i: usize| map.texels[i] * map.texel_solid_angle(i as u32 / map.width) as f32;
        (0..map.texels.len()).map(texel).sum()
    }

    #[test]
    fn the_copy_keeps_the_power_of_the_map() {
        for (width, height) in [(1024, 512), (1000, 499), (300, 2), (257, 129)] {
            let texel = |i: u32| {
                Vec3::new((i % 97) as f32, (i / 7 % 13) as f32, if i.is_multiple_of(5003) { 1e4 } else { 0.0 })
            };
            let map = Environment::new("test", width, height, (0..width * height).map(texel).collect());
            let copy = downsampled(&map);
            assert!(copy.width <= 256 && copy.height <= 128);
            assert_eq!(copy.texels.len(), (copy.width * copy.height) as usize);
            let (before, after) = (power(&map), power(&copy));
            assert!(
                ((after - before) / before).abs().max_element() < 2e-2,
                "{before} became {after} at {width}x{height}"
            );
        }
    }

    #[test]
    fn a_small_map_is_its_own_copy() {
        let map = Environment::new("test", 256, 128, vec![Vec3::ONE; 256 * 128]);
        assert!(std::sync::Arc::ptr_eq(&map.texels, &downsampled(&map).texels));
    }
}
