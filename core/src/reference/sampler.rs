//! Random numbers of a path: Owen-scrambled Sobol points.
//!
//! Sets of four dimensions are well spread over the samples of a pixel, and independent of each other and of those of
//! other pixels. Burley 2020, Practical Hash-based Owen Scrambling, section 4 (padding).

use glam::UVec2;

use crate::math::sampling::{pcg, unit};

/// Samples of one sequence; longer ones go on with the next.
const LENGTH: u32 = 1 << 16;

/// The numbers of one path. The same seed, pixel and index give the same numbers everywhere.
#[derive(Clone, Debug)]
pub struct PathSampler {
    /// Place in the sequence.
    index: u32,
    /// Of the pixel's sequence.
    seed: u32,
    /// Sets taken so far.
    set: u32,
    /// State of the independent numbers.
    state: u32,
}

impl PathSampler {
    /// The numbers of sample `index` of a pixel.
    pub fn new(seed: u32, pixel: UVec2, index: u32) -> PathSampler {
        let of_sequence = pcg(pcg(seed).wrapping_add(index / LENGTH));
        let of_pixel = pcg(pcg(of_sequence.wrapping_add(pixel.x)).wrapping_add(pixel.y));
        PathSampler { index: index % LENGTH, seed: of_pixel, set: 0, state: pcg(of_pixel ^ pcg(index)) }
    }

    /// The next four numbers in [0, 1).
    pub fn next4(&mut self) -> [f32; 4] {
        self.set += 1;
        sobol_burley::sample_4d(self.index, 0, pcg(self.seed.wrapping_add(self.set)))
    }

    /// A number in [0, 1) that is not spread over samples: for choices of which a path needs unknown many.
    pub fn independent(&mut self) -> f32 {
        self.state = pcg(self.state);
        unit(self.state)
    }

    /// A number to mix into hashes, another one for each sample.
    pub fn salt(&self) -> u32 {
        self.state
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_numbers_at_a_time_fill_every_stratum_of_their_square() {
        // The first 256 points of a (0, 2)-sequence have one in each cell of 16 x 16.
        for set in 0..3 {
            let mut cells = [[0u32; 256]; 2];
            for index in 0..256 {
                let mut sampler = PathSampler::new(7, UVec2::new(3, 5), index);
                let mut u = [0.0; 4];
                (0..=set).for_each(|_| u = sampler.next4());
                let cell = |a: f32, b: f32| (a * 16.0) as usize * 16 + (b * 16.0) as usize;
                cells[0][cell(u[0], u[1])] += 1;
                cells[1][(u[2] * 256.0) as usize] += 1;
            }
            assert!(cells.iter().flatten().all(|&n| n == 1), "set {set}");
        }
    }

    #[test]
    fn pixels_seeds_and_sequences_have_other_numbers() {
        let first = |seed, x, y, index| PathSampler::new(seed, UVec2::new(x, y), index).next4();
        let numbers =
            [first(0, 0, 0, 0), first(1, 0, 0, 0), first(0, 1, 0, 0), first(0, 0, 1, 0), first(0, 0, 0, LENGTH)];
        for (i, a) in numbers.iter().enumerate() {
            assert!(numbers[..i].iter().all(|b| a != b));
        }
        assert_eq!(first(4, 5, 6, 7), first(4, 5, 6, 7));
    }

    #[test]
    fn independent_numbers_are_even_and_in_range() {
        let mut sampler = PathSampler::new(1, UVec2::ZERO, 0);
        let numbers: Vec<f32> = (0..10_000).map(|_| sampler.independent()).collect();
        assert!(numbers.iter().all(|u| (0.0..1.0).contains(u)));
        let mean = numbers.iter().map(|u| f64::from(*u)).sum::<f64>() / 10_000.0;
        assert!((mean - 0.5).abs() < 0.015, "{mean}");
    }
}
