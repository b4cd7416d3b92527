//! RGB primaries other than Rec.709.

use glam::{DMat3, DVec2, DVec3};

use crate::color::adaptation::bradford;
use crate::import::report::Report;

/// CIE xy chromaticities of the primaries and of white (R = G = B = 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Primaries {
    pub red: DVec2,
    pub green: DVec2,
    pub blue: DVec2,
    pub white: DVec2,
}

/// ITU-R BT.709-6, table 1.
const REC709: Primaries = Primaries {
    red: DVec2::new(0.64, 0.33),
    green: DVec2::new(0.30, 0.60),
    blue: DVec2::new(0.15, 0.06),
    white: DVec2::new(0.3127, 0.3290),
};

/// Files round chromaticities to three or four digits.
const SAME: f64 = 2e-3;

impl Primaries {
    /// Linear Rec.709 from linear RGB of these primaries, white to white; none when they are Rec.709 already, or when
    /// they span no colours (a notice).
    pub fn to_rec709(self, report: &mut Report) -> Option<DMat3> {
        let near = |a: DVec2, b: DVec2| (a - b).abs().max_element() <= SAME;
        let same_primaries =
            near(self.red, REC709.red) && near(self.green, REC709.green) && near(self.blue, REC709.blue);
        if same_primaries && near(self.white, REC709.white) {
            return None;
        }
        let matrix = self.xyz_from_rgb().zip(REC709.xyz_from_rgb()).map(|(xyz_from_rgb, xyz_from_rec709)| {
            xyz_from_rec709.inverse() * bradford(xyz(self.white), xyz(REC709.white)) * xyz_from_rgb
        });
        if !matrix.is_some_and(|m| m.is_finite()) {
            report.notice("primaries", "the primaries of the file are not sound; Rec.709 is taken");
            return None;
        }
        matrix
    }

    /// XYZ from linear RGB with Y = 1 for white; none for primaries on a line.
    fn xyz_from_rgb(self) -> Option<DMat3> {
        let columns = DMat3::from_cols(xyz(self.red), xyz(self.green), xyz(self.blue));
        let weights = columns.inverse() * xyz(self.white);
        let matrix = columns * DMat3::from_diagonal(weights);
        (columns.determinant().abs() > 1e-9 && matrix.is_finite()).then_some(matrix)
    }
}

/// XYZ of a chromaticity with Y = 1.
fn xyz(xy: DVec2) -> DVec3 {
    DVec3::new(xy.x / xy.y, 1.0, (1.0 - xy.x - xy.y) / xy.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rec709_needs_no_conversion_and_its_luminance_row_is_that_of_the_standard() {
        assert_eq!(REC709.to_rec709(&mut Report::new("x")), None);
        let y = REC709.xyz_from_rgb().unwrap().row(1);
        // ITU-R BT.709-6, item 3.2: 0.2126, 0.7152, 0.0722, to four digits.
        assert!((y - DVec3::new(0.2126, 0.7152, 0.0722)).abs().max_element() < 5e-5, "{y}");
    }

    #[test]
    fn white_stays_white_between_primaries_of_different_white() {
        // ACEScg (AP1) with its white near D60.
        let ap1 = Primaries {
            red: DVec2::new(0.713, 0.293),
            green: DVec2::new(0.165, 0.830),
            blue: DVec2::new(0.128, 0.044),
            white: DVec2::new(0.32168, 0.33767),
        };
        let matrix = ap1.to_rec709(&mut Report::new("x")).unwrap();
        assert!((matrix * DVec3::ONE - DVec3::ONE).abs().max_element() < 1e-9);
        // The familiar first entry of the AP1 to Rec.709 matrix.
        assert!((matrix.x_axis.x - 1.705).abs() < 2e-3, "{matrix}");
    }

    #[test]
    fn primaries_on_a_line_are_left_out_with_a_notice() {
        let mut report = Report::new("x");
        let flat = Primaries { red: DVec2::new(0.2, 0.2), green: DVec2::new(0.3, 0.3), ..REC709 };
        let flat = Primaries { blue: DVec2::new(0.4, 0.4), ..flat };
        assert_eq!(flat.to_rec709(&mut report), None);
        assert_eq!(report.finish(Some(())).unwrap().1.len(), 1);
    }
}
