//! How much is drawn at a time, so that a software rasteriser keeps up with a hand: measured, then predicted.

use std::time::Duration;

use glam::UVec2;

/// Milliseconds of a frame while something moves. The window takes about 40 more, and an input waits for half of a frame
/// before its own: less than 100 in all.
const MOVING_MS: f64 = 24.0;
/// Milliseconds of refinement between two looks at the input.
const STILL_MS: f64 = 45.0;
/// Time for the cubes of an environment between two looks at the input: on a software rasteriser, where nothing else is
/// drawn meanwhile, and on others, beside the frames.
const PREPARING: [Duration; 2] = [Duration::from_millis(60), Duration::from_millis(6)];
/// Shares of the window's width and height that may be drawn.
const SCALES: [f32; 10] = [1.0, 0.85, 0.7, 0.6, 0.5, 0.4, 0.32, 0.25, 0.2, 0.16];
/// Fewest rows that are lit at a time.
const ROWS_MIN: u32 = 16;
/// Weight of a new measurement: one hiccup of the machine does not count in full.
const WEIGHT: f64 = 0.5;

/// Costs seen so far.
#[derive(Debug)]
pub(crate) struct Pace {
    software: bool,
    scale: usize,
    /// A frame has been drawn: the first compiles shaders in the driver and tells nothing.
    warm: bool,
    /// Milliseconds of the surfaces of a frame: mostly vertices, whatever the resolution.
    surfaces: Option<f64>,
    /// Milliseconds a pixel of what follows while moving, and when still.
    moving_pixel: Option<f64>,
    still_pixel: Option<f64>,
}

impl Pace {
    pub fn new(software: bool) -> Pace {
        Pace { software, scale: 4, warm: false, surfaces: None, moving_pixel: None, still_pixel: None }
    }

    /// Pixels to draw while something moves in a window of so many.
    pub fn moving_size(&self, window: UVec2) -> UVec2 {
        if self.software { scaled(window, SCALES[self.scale]) } else { window }
    }

    /// Samples of a lobe while something moves: a software rasteriser looks each up once, which costs a tenth.
    pub fn moving_samples(&self, samples: u32) -> u32 {
        if self.software { 0 } else { samples }
    }

    /// Learns from a moving frame: milliseconds of its surfaces and of the rest.
    pub fn note_moving(&mut self, window: UVec2, surfaces: f64, rest: f64) {
        if !std::mem::replace(&mut self.warm, true) {
            return;
        }
        let size = self.moving_size(window);
        learn(&mut self.surfaces, surfaces);
        learn(&mut self.moving_pixel, rest / pixels(size));
        let (Some(surfaces), Some(pixel)) = (self.surfaces, self.moving_pixel) else { return };
        let expected = |scale: usize| surfaces + pixel * pixels(scaled(window, SCALES[scale]));
        if expected(self.scale) > MOVING_MS {
            self.scale = (self.scale..SCALES.len() - 1).find(|s| expected(*s) <= MOVING_MS).unwrap_or(SCALES.len() - 1);
        } else if self.scale > 0 && expected(self.scale - 1) < 0.85 * MOVING_MS {
            // One step at a time, and with room to spare: a resolution that flickers is worse than a low one.
            self.scale -= 1;
        }
    }

    /// Time for the cubes of an environment.
    pub fn preparing(&self) -> Duration {
        PREPARING[usize::from(!self.software)]
    }

    /// Rows to light next after so many milliseconds; 0 when the time is up.
    pub fn rows(&self, spent: f64, size: UVec2, left: u32) -> u32 {
        if !self.software {
            return left;
        }
        // The first rows tell what the others cost.
        let Some(pixel) = self.still_pixel else { return ROWS_MIN.min(left) };
        let row = f64::from(size.x) * pixel;
        let rows = ((STILL_MS - spent) / row.max(1e-6)).clamp(0.0, 1e6) as u32;
        if rows >= ROWS_MIN || left <= rows {
            rows.min(left)
        } else if spent == 0.0 {
            ROWS_MIN.min(left)
        } else {
            0
        }
    }

    /// Learns from the surfaces of a still frame.
    pub fn note_surfaces(&mut self, ms: f64) {
        learn(&mut self.surfaces, ms);
    }

    /// Learns from rows that were lit.
    pub fn note_rows(&mut self, size: UVec2, rows: u32, ms: f64) {
        learn(&mut self.still_pixel, ms / pixels(UVec2::new(size.x, rows)));
    }
}

/// Never a power of two across or down: llvmpipe compiles its shaders once more for such textures.
fn scaled(window: UVec2, scale: f32) -> UVec2 {
    let side = |pixels: u32| {
        let pixels = (pixels as f32 * scale).round() as u32;
        if pixels.is_power_of_two() && pixels > 2 { pixels - 1 } else { pixels.max(1) }
    };
    if scale == 1.0 { window } else { UVec2::new(side(window.x), side(window.y)) }
}

fn pixels(size: UVec2) -> f64 {
    f64::from(size.x.max(1)) * f64::from(size.y.max(1))
}

fn learn(known: &mut Option<f64>, seen: f64) {
    *known = Some(known.map_or(seen, |known| known + WEIGHT * (seen - known)));
}

#[cfg(test)]
mod tests {
    use super::*;

    const WINDOW: UVec2 = UVec2::new(800, 600);

    /// Draws frames that cost so much, until the resolution stands.
    fn settled(surfaces: f64, pixel: f64) -> UVec2 {
        let mut pace = Pace::new(true);
        for _ in 0..40 {
            pace.note_moving(WINDOW, surfaces, pixel * pixels(pace.moving_size(WINDOW)));
        }
        pace.moving_size(WINDOW)
    }

    #[test]
    fn moving_frames_keep_their_budget_where_they_can() {
        assert_eq!(settled(1.0, 1e-5), WINDOW);
        for pixel in [1e-4, 3e-4, 8e-4] {
            let size = settled(10.0, pixel);
            assert!(10.0 + pixel * pixels(size) <= MOVING_MS, "{size} at {pixel} ms a pixel");
            assert!(size.x < WINDOW.x && size.x >= 127, "{size} at {pixel} ms a pixel");
        }
        // Vertices alone take longer: as few pixels as there may be.
        assert_eq!(settled(300.0, 1e-4), UVec2::new(127, 96));
    }

    #[test]
    fn no_small_side_is_a_power_of_two() {
        for edge in 1..3000 {
            for scale in SCALES.into_iter().filter(|s| *s < 1.0) {
                let side = scaled(UVec2::splat(edge), scale).x;
                assert!(side > 0 && (side <= 2 || !side.is_power_of_two()), "{edge} times {scale} is {side}");
            }
        }
    }

    #[test]
    fn graphics_cards_draw_every_pixel() {
        let pace = Pace::new(false);
        assert_eq!(pace.moving_size(WINDOW), WINDOW);
        assert_eq!((pace.moving_samples(16), pace.rows(50.0, WINDOW, 600)), (16, 600));
    }

    #[test]
    fn a_still_frame_goes_on_in_every_call() {
        let mut pace = Pace::new(true);
        assert_eq!(pace.rows(0.0, WINDOW, 600), ROWS_MIN);
        // A second for a row.
        pace.note_rows(WINDOW, 1, 1000.0);
        assert_eq!((pace.rows(0.0, WINDOW, 600), pace.rows(1.0, WINDOW, 600)), (ROWS_MIN, 0));
    }
}
