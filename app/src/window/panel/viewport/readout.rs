//! The numbers under a pointer that rests on the picture.

use burnish_core::color::rgb;
use eframe::egui::Pos2;
use glam::Vec3;

/// Seconds that the pointer must rest: reading a pixel makes the device wait.
const REST_SECS: f64 = 0.15;

/// What the picture must be for a number to hold.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Key {
    pointer: Pos2,
    picture: (u64, u64),
}

/// A pixel that was read, and since when the pointer rests.
#[derive(Debug, Default)]
pub struct Readout {
    pointer: Option<Pos2>,
    rests_since: f64,
    read: Option<(Key, Vec3)>,
}

impl Readout {
    /// Reads the pixel under a resting pointer; `picture` says which revision of the document and which version of its
    /// picture it is. Returns the radiance, or the seconds after which to ask again.
    pub fn update(
        &mut self,
        pointer: Pos2,
        picture: (u64, u64),
        now_secs: f64,
        read: impl FnOnce() -> Option<Vec3>,
    ) -> Result<Option<Vec3>, f64> {
        if self.pointer != Some(pointer) {
            *self = Readout { pointer: Some(pointer), rests_since: now_secs, read: None };
        }
        let rested = now_secs - self.rests_since;
        if rested < REST_SECS {
            return Err(REST_SECS - rested);
        }
        let key = Key { pointer, picture };
        if self.read.is_none_or(|(known, _)| known != key) {
            self.read = read().map(|radiance| (key, radiance));
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
        let (mut readout, read) = (Readout::default(), || Some(Vec3::X));
        let place = Pos2::new(10.0, 10.0);
        assert!(readout.update(place, (0, 1), 1.0, read).is_err());
        assert_eq!(readout.update(place, (0, 1), 1.2, read), Ok(Some(Vec3::X)));
        let other = || Some(Vec3::Y);
        assert_eq!(readout.update(place, (0, 1), 1.25, other), Ok(Some(Vec3::X)), "the same picture is read once");
        assert_eq!(readout.update(place, (0, 2), 1.25, other), Ok(Some(Vec3::Y)));
        assert!(readout.update(Pos2::new(11.0, 10.0), (0, 2), 1.3, read).is_err());
    }
}
