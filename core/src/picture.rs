//! A finished picture on its way to a file or a comparison.

use glam::Vec4;

/// Pixels in linear Rec.709. Row 0 is the top.
///
/// RGB is premultiplied by alpha, as light adds up: radiance times coverage in a rendered picture. Most pictures are
/// opaque (alpha 1 everywhere). Radiance is unbounded; negative values are allowed (differences), non-finite ones are
/// what measuring refuses.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// `width * height` pixels, row by row.
    pub texels: Vec<Vec4>,
}

impl Picture {
    /// A picture of one colour.
    pub fn filled(width: u32, height: u32, texel: Vec4) -> Picture {
        Picture { width, height, texels: vec![texel; width as usize * height as usize] }
    }

    /// A picture whose pixels are computed from `(column, row)`.
    pub fn from_fn(width: u32, height: u32, mut texel: impl FnMut(u32, u32) -> Vec4) -> Picture {
        let mut texels = Vec::with_capacity(width as usize * height as usize);
        for y in 0..height {
            texels.extend((0..width).map(|x| texel(x, y)));
        }
        Picture { width, height, texels }
    }

    /// True when there are as many pixels as width and height say.
    pub fn is_whole(&self) -> bool {
        self.texels.len() as u64 == u64::from(self.width) * u64::from(self.height)
    }

    /// True when every pixel is fully covered.
    pub fn is_opaque(&self) -> bool {
        self.texels.iter().all(|t| t.w >= 1.0)
    }
}
