//! The numbers under a pointer that rests on the picture.

use burnish_core::color::rgb;
use eframe::egui::Pos2;
use glam::{Vec2, Vec3};

use crate::window::stage::Stage;

/// Seconds that the pointer must rest: reading a pixel makes the device wait.
const REST_SECS: f64 = 0.15;

/// What the picture must be for a number to hold.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Key {
    pointer: Pos2,
    revision: u64,
    settled: bool,
}

/// A pixel that was read, and since when the pointer rests.
#[derive(Debug, Default)]
pub struct Readout {
    pointer: Option<Pos2>,
    rests_since: f64,
    read: Option<(Key, Vec3)>,
}

impl Readout {
    /// Reads the pixel under a resting pointer; `at` is its place in the picture, 0 to 1. Returns the radiance, or the
    /// seconds after which to ask again.
    pub fn update(
        &mut self,
        stage: &mut Stage,
        (pointer, at): (Pos2, Vec2),
        (revision, settled): (u64, bool),
        now_secs: f64,
    ) -> Result<Option<Vec3>, f64> {
        if self.pointer != Some(pointer) {
            *self = Readout { pointer: Some(pointer), rests_since: now_secs, read: None };
        }
        let rested = now_secs - self.rests_since;
        if rested < REST_SECS {
            return Err(REST_SECS - rested);
        }
        let key = Key { pointer, revision, settled };
        if self.read.is_none_or(|(known, _)| known != key) {
            self.read = stage.radiance(at).map(|radiance| (key, radiance));
        }
        Ok(self.read.map(|(_, radiance)| radiance))
    }

    /// The pointer left, or drags.
    pub fn clear(&mut self) {
        *self = Readout::default();
    }
}

/// The numbers as text: linear R, G, B and luminance.
pub fn text(radiance: Vec3) -> String {
    let [r, g, b] = radiance.to_array().map(number);
    format!("R {r}  G {g}  B {b}  L {} nit", number(rgb::luminance(radiance)))
}

/// Four digits whatever the size, of the same width where possible.
fn number(value: f32) -> String {
    match value.abs() {
        v if v != 0.0 && !(1e-3..1e5).contains(&v) => format!("{value:.2e}"),
        v if v >= 1000.0 => format!("{value:.0}"),
        v if v >= 10.0 => format!("{value:.2}"),
        _ => format!("{value:.4}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_digits_from_shadow_to_sun() {
        let text = text(Vec3::new(0.25, 12.5, 250_000.0));
        assert!(text.starts_with("R 0.2500  G 12.50  B 2.50e5  L "), "{text}");
        assert_eq!(number(0.0), "0.0000");
        assert_eq!(number(2e-5), "2.00e-5");
    }

    #[test]
    fn a_pointer_is_asked_to_rest_before_a_pixel_is_read() {
        let (mut readout, mut stage) = (Readout::default(), Stage::Flat);
        let place = (Pos2::new(10.0, 10.0), Vec2::splat(0.5));
        assert!(readout.update(&mut stage, place, (0, true), 1.0).is_err());
        assert_eq!(readout.update(&mut stage, place, (0, true), 1.2), Ok(None));
        let moved = (Pos2::new(11.0, 10.0), Vec2::splat(0.5));
        assert!(readout.update(&mut stage, moved, (0, true), 1.3).is_err());
    }
}
