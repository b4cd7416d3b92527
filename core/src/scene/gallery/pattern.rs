//! Images of patterns, painted by code. Colours are linear albedos.

use glam::Vec3;

use crate::color::rgb::srgb_from_linear;
use crate::scene::{Image, Texels};

/// An image from the colour of each pixel; x to the right, y down.
fn painted(name: &str, size: usize, color: impl Fn(usize, usize) -> Vec3) -> Image {
    let texels = (0..size * size).flat_map(|i| {
        let [r, g, b] = (255.0 * srgb_from_linear(color(i % size, i / size))).round().to_array().map(|v| v as u8);
        [r, g, b, 255]
    });
    Image { name: name.into(), width: size as u32, height: size as u32, texels: Texels::Unorm8(texels.collect()) }
}

/// Squares of two colours, `count` (even) to a side.
pub fn checker(count: usize, [a, b]: [Vec3; 2]) -> Image {
    let side = 512 / count.max(1);
    painted("checker", count * side, |x, y| if (x / side + y / side).is_multiple_of(2) { a } else { b })
}

/// Digits of 3 x 5 dots, rows from the top, the left dot in the highest bit.
const DIGITS: [[u8; 5]; 10] = [
    [7, 5, 5, 5, 7],
    [2, 6, 2, 2, 7],
    [7, 1, 7, 4, 7],
    [7, 1, 7, 1, 7],
    [5, 5, 7, 1, 1],
    [7, 4, 7, 1, 7],
    [7, 4, 7, 5, 7],
    [7, 1, 2, 2, 2],
    [7, 5, 7, 5, 7],
    [7, 5, 7, 1, 7],
];

/// Squares to a side of [`numbered`].
pub const NUMBERED: usize = 8;

/// Squares of two colours with their numbers, row by row from 1, each in the other's colour, so that it is known again in
/// a reflection.
pub fn numbered(colors: [Vec3; 2]) -> Image {
    // A square of 64 pixels is 8 dots wide: two digits of 3 with a gap between, centred.
    let (square, dot) = (64, 8);
    painted("numbered", NUMBERED * square, |x, y| {
        let (column, row) = (x / square, y / square);
        let number = row * NUMBERED + column + 1;
        let (x, y) = ((x % square + dot / 2) / dot, (y % square + dot / 2) / dot);
        let digit = match x {
            1..=3 => Some((number / 10, 3 - x)),
            5..=7 => Some((number % 10, 7 - x)),
            _ => None,
        };
        let inked = digit.is_some_and(|(digit, bit)| {
            (2..7).contains(&y) && (digit > 0 || x >= 5) && DIGITS[digit][y - 2] >> bit & 1 == 1
        });
        colors[(column + row + usize::from(inked)) % 2]
    })
}

/// Upright stripes of two colours, `count` of each.
pub fn stripes(count: usize, [a, b]: [Vec3; 2]) -> Image {
    let size = 512;
    painted("stripes", size, |x, _| if (2 * count * x / size).is_multiple_of(2) { a } else { b })
}

/// Boards from left to right, one above the other, each of its own tone, with dark joints and a grain.
pub fn boards(count: usize, wood: Vec3) -> Image {
    let size = 512;
    let height = size / count.max(1);
    painted("boards", count * height, |x, y| {
        let board = y / height;
        let tone = 0.75 + 0.45 * noise(board, 7);
        // Long streaks: the noise of a row changes slowly along it.
        let (block, share) = (x / 64, (x % 64) as f32 / 64.0);
        let streak = |block: usize| noise(3 * y + 131 * (block % (size / 64)), board);
        let grain = 0.86 + 0.28 * (streak(block) * (1.0 - share) + streak(block + 1) * share);
        let joint = if y % height < 3 { 0.25 } else { 1.0 };
        wood * tone * grain * joint
    })
}

/// A number in 0..1 for two others, without a pattern.
fn noise(a: usize, b: usize) -> f32 {
    let mixed = (a as u32).wrapping_mul(0x9e37_79b9) ^ (b as u32).wrapping_mul(0x85eb_ca6b);
    let mixed = (mixed ^ mixed >> 15).wrapping_mul(0x2c1b_3c6d);
    (mixed ^ mixed >> 13) as u16 as f32 / f32::from(u16::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_fill_their_images_and_hold_both_colours() {
        let [dark, light] = [Vec3::splat(0.1), Vec3::splat(0.6)];
        for image in [checker(8, [dark, light]), stripes(4, [dark, light]), numbered([dark, light])] {
            let Texels::Unorm8(texels) = &image.texels else { panic!("8 bits") };
            assert_eq!(texels.len(), 4 * 512 * 512, "{}", image.name);
            for color in [dark, light] {
                let byte = (255.0 * srgb_from_linear(color)).round().x as u8;
                let share = texels.chunks(4).filter(|t| t[0] == byte).count() as f32 / (512.0 * 512.0);
                assert!((0.3..=0.7).contains(&share), "{}: {share}", image.name);
            }
        }
    }

    #[test]
    fn numbers_can_be_read() {
        let image = numbered([Vec3::ONE, Vec3::ZERO]);
        let Texels::Unorm8(texels) = &image.texels else { panic!("8 bits") };
        // The 10th square, the second of the second row: dots of `1` and `0` in their middle rows.
        let row: String = (0..8)
            .map(|dot| if texels[4 * ((64 + 4 * 8 - 1) * 512 + 64 + 8 * dot)] == 0 { '#' } else { '.' })
            .collect();
        assert_eq!(row, "..#..#.#");
    }
}
