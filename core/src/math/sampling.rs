//! Random numbers, point sets and maps from the unit square.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

use glam::{Vec2, Vec3};

/// 2^-24, the spacing of the numbers in [0, 1) that these functions return.
const UNIT: f32 = 1.0 / 16_777_216.0;

/// The square `[0, 1)^2` to the unit disk, keeping areas and neighbours.
///
/// Shirley and Chiu 1997, A Low Distortion Map between Disk and Square.
pub fn disk(u: Vec2) -> Vec2 {
    let p = 2.0 * u - 1.0;
    if p == Vec2::ZERO {
        return Vec2::ZERO;
    }
    if p.x.abs() > p.y.abs() {
        p.x * Vec2::from_angle(FRAC_PI_4 * (p.y / p.x))
    } else {
        p.y * Vec2::from_angle(FRAC_PI_2 - FRAC_PI_4 * (p.x / p.y))
    }
}

/// Direction with density `cos(theta) / pi` about z.
pub fn cosine_hemisphere(u: Vec2) -> Vec3 {
    // Radius on the disk, from which the cosine keeps its digits at the rim.
    let r = (2.0 * u - 1.0).abs().max_element();
    disk(u).extend(((1.0 - r) * (1.0 + r)).sqrt())
}

/// Bits of `i` mirrored at the binary point, in [0, 1).
pub fn radical_inverse(i: u32) -> f32 {
    // Only 24 bits fit an f32 below one.
    unit(i.reverse_bits())
}

/// Point `i` of `n` of the Hammersley set in `[0, 1)^2`.
pub fn hammersley(i: u32, n: u32) -> Vec2 {
    Vec2::new(i as f32 / n as f32, radical_inverse(i))
}

/// Point `i` of `n` for maps that take x around and y outward: a spiral whose cells are as wide as they are long.
/// `offset` in [0, 1)^2 turns it and moves it outward within a step.
///
/// Vogel 1979, A better way to construct the sunflower head.
pub fn spiral(i: u32, n: u32, offset: Vec2) -> Vec2 {
    // Steps of the golden angle, in integers so that no digit is lost: 2^32 over the golden ratio, wrapping.
    let turn = (i.wrapping_mul(2_654_435_769) >> 8) as f32 / 16_777_216.0;
    Vec2::new((turn + offset.x).fract(), (i as f32 + offset.y) / n as f32)
}

/// Hash of 32 bits. Jarzynski and Olano 2020, Hash Functions for GPU Rendering.
pub fn pcg(v: u32) -> u32 {
    let state = v.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// The upper 24 bits of a hash as a number in [0, 1).
pub fn unit(hash: u32) -> f32 {
    (hash >> 8) as f32 * UNIT
}

/// A stream of random numbers; the same seed gives the same stream everywhere.
///
/// SplitMix64, Steele et al. 2014, Fast Splittable Pseudorandom Number Generators.
#[derive(Clone, Debug)]
pub struct Random {
    state: u64,
}

impl Random {
    /// The stream of `seed`.
    pub fn new(seed: u64) -> Random {
        Random { state: seed }
    }

    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// The next number in [0, 1).
    pub fn unit(&mut self) -> f32 {
        unit((self.bits() >> 32) as u32)
    }

    /// The next point in `[0, 1)^2`.
    pub fn point2(&mut self) -> Vec2 {
        let bits = self.bits();
        Vec2::new(unit((bits >> 32) as u32), unit(bits as u32))
    }

    /// The next point in `[0, 1)^3`.
    pub fn point3(&mut self) -> Vec3 {
        self.point2().extend(self.unit())
    }
}
