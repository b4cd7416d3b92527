//! Where in a picture which levels are: for each column of it how often each level occurs, as on a monitor of a studio.

use crate::color::rgb::luminance;
use crate::color::tone::{ToneMap, exposure_factor, tone_map};
use crate::picture::Picture;

/// Counts by column and level of the display-encoded value.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Waveform {
    /// Columns, at most as many as the picture has.
    pub columns: u32,
    /// Levels from 0 to 1, the darkest first.
    pub levels: u32,
    /// Encoded luma and red, green, blue: `columns * levels` counts each, column by column.
    pub counts: [Vec<u32>; 4],
}

impl Waveform {
    /// How often a level occurs in a column; `kind` 0 is luma, 1 to 3 red, green and blue.
    pub fn count(&self, kind: usize, column: u32, level: u32) -> u32 {
        let at = column as usize * self.levels as usize + level as usize;
        let inside = column < self.columns && level < self.levels;
        self.counts.get(kind).and_then(|counts| counts.get(at)).copied().filter(|_| inside).unwrap_or(0)
    }
}

/// Counts a picture as a screen shows it, in so many columns and levels (2 to 4096). Luma are the weights of luminance on
/// encoded values (ITU-R BT.709-6).
pub fn waveform(picture: &Picture, tone: ToneMap, exposure_ev: f32, columns: u32, levels: u32) -> Waveform {
    let (columns, levels) = (columns.clamp(1, picture.width.max(1)), levels.clamp(2, 4096));
    let size = columns as usize * levels as usize;
    let mut counts = std::array::from_fn(|_| vec![0u32; size]);
    let factor = exposure_factor(exposure_ev);
    for (i, texel) in picture.texels.iter().enumerate() {
        let x = i as u64 % u64::from(picture.width.max(1));
        let column = (x * u64::from(columns) / u64::from(picture.width.max(1))) as usize;
        let shown = tone_map(tone, factor * texel.truncate());
        let values = [luminance(shown), shown.x, shown.y, shown.z];
        for (counts, value) in counts.iter_mut().zip(values) {
            // The cast saturates.
            let level = ((value * levels as f32) as usize).min(levels as usize - 1);
            counts[column * levels as usize + level] += 1;
        }
    }
    Waveform { columns, levels, counts }
}
