//! RGB spaces other than the working space, for numbers that go to other programs.

use glam::{DMat3, DVec3};

use crate::color::adaptation::bradford;
use crate::color::rgb::{self, xyz_from_primaries, xyz_from_xy};

/// A linear RGB space. Its white (1, 1, 1) is the perfect reflector under D65, as in the working space: a grey metal is
/// grey in each of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Space {
    /// ITU-R BT.709, the working space; white D65.
    #[default]
    Rec709,
    /// ITU-R BT.2020, white D65.
    Rec2020,
    /// ACEScg, the primaries AP1. Its white is near D60, so colours are adapted from D65 by Bradford, as is usual where
    /// the ACES meet Rec.709.
    AcesCg,
}

/// The name of a space that does not exist.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("no RGB space `{0}`; there are rec709, rec2020, acescg")]
pub struct UnknownSpace(pub String);

impl Space {
    /// All of them.
    pub const ALL: [Space; 3] = [Space::Rec709, Space::Rec2020, Space::AcesCg];

    /// Name on the command line.
    pub fn id(self) -> &'static str {
        match self {
            Space::Rec709 => "rec709",
            Space::Rec2020 => "rec2020",
            Space::AcesCg => "acescg",
        }
    }

    /// Name for people.
    pub fn title(self) -> &'static str {
        match self {
            Space::Rec709 => "Rec.709",
            Space::Rec2020 => "Rec.2020",
            Space::AcesCg => "ACEScg",
        }
    }

    /// Chromaticities `(x, y)` of red, green, blue (ITU-R BT.709-6; ITU-R BT.2020-2; S-2014-004).
    pub fn primaries(self) -> [(f64, f64); 3] {
        match self {
            Space::Rec709 => rgb::PRIMARIES,
            Space::Rec2020 => [(0.708, 0.292), (0.170, 0.797), (0.131, 0.046)],
            Space::AcesCg => [(0.713, 0.293), (0.165, 0.830), (0.128, 0.044)],
        }
    }

    /// XYZ of white, Y = 1: [`rgb::white_xyz`], or the white of the ACES, x = 0.32168, y = 0.33767 (S-2014-004).
    pub fn white_xyz(self) -> DVec3 {
        match self {
            Space::Rec709 | Space::Rec2020 => rgb::white_xyz(),
            Space::AcesCg => xyz_from_xy(0.32168, 0.33767),
        }
    }

    /// Linear RGB of this space from linear Rec.709, white to white. Not clamped.
    pub fn space_from_rgb(self) -> DMat3 {
        let xyz_from_space = xyz_from_primaries(self.primaries(), self.white_xyz());
        xyz_from_space.inverse() * bradford(rgb::white_xyz(), self.white_xyz()) * rgb::xyz_from_rgb()
    }

    /// Linear Rec.709 from linear RGB of this space, the inverse of [`Space::space_from_rgb`].
    pub fn rgb_from_space(self) -> DMat3 {
        self.space_from_rgb().inverse()
    }

    /// Linear RGB in this space of a reflectance under D65; see [`rgb::integrate`]. Not clamped.
    pub fn integrate(self, reflectance: impl Fn(f64) -> f64) -> DVec3 {
        self.space_from_rgb() * rgb::integrate(reflectance)
    }
}

impl std::str::FromStr for Space {
    type Err = UnknownSpace;

    fn from_str(text: &str) -> Result<Space, UnknownSpace> {
        let wanted = text.trim().to_ascii_lowercase();
        Space::ALL.into_iter().find(|space| space.id() == wanted).ok_or_else(|| UnknownSpace(text.into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::preset;

    fn is_near(matrix: DMat3, rows: [[f64; 3]; 3], tolerance: f64) -> bool {
        let published = DMat3::from_cols_array_2d(&rows).transpose();
        (0..3).all(|c| (matrix.col(c) - published.col(c)).abs().max_element() < tolerance)
    }

    #[test]
    fn ids_are_read_back_and_an_unknown_one_is_named() {
        for space in Space::ALL {
            assert_eq!(space.id().parse(), Ok(space));
        }
        let error = "p3".parse::<Space>().unwrap_err().to_string();
        assert!(error.contains("`p3`") && Space::ALL.iter().all(|s| error.contains(s.id())), "{error}");
    }

    #[test]
    fn white_stays_white_and_the_way_back_undoes_the_way_there() {
        for space in Space::ALL {
            // A few products in f64.
            assert!((space.space_from_rgb() * DVec3::ONE - DVec3::ONE).abs().max_element() < 1e-14, "{space:?}");
            assert!((space.integrate(|_| 0.18) - 0.18).abs().max_element() < 1e-14, "{space:?}");
            let color = DVec3::new(0.9, 0.4, 0.1);
            let back = space.rgb_from_space() * space.space_from_rgb() * color;
            assert!((back - color).abs().max_element() < 1e-14, "{space:?}: {back}");
        }
        assert!((Space::Rec709.space_from_rgb() * DVec3::X - DVec3::X).abs().max_element() < 1e-15);
    }

    #[test]
    fn the_matrices_are_the_published_ones() {
        // ITU-R BT.2087-0; four decimals, and its white is rounded.
        let rec2020 = [[0.6274, 0.3293, 0.0433], [0.0691, 0.9195, 0.0114], [0.0164, 0.0880, 0.8956]];
        assert!(is_near(Space::Rec2020.space_from_rgb(), rec2020, 1e-4), "{}", Space::Rec2020.space_from_rgb());
        // sRGB to ACEScg with Bradford, as the OpenColorIO configurations for the ACES have it; four decimals.
        let acescg = [[0.6131, 0.3395, 0.0474], [0.0702, 0.9164, 0.0135], [0.0206, 0.1096, 0.8698]];
        assert!(is_near(Space::AcesCg.space_from_rgb(), acescg, 1e-4), "{}", Space::AcesCg.space_from_rgb());
    }

    #[test]
    fn gold_lies_within_the_wide_spaces_but_not_in_rec709() {
        let gold = preset::find("Au").unwrap();
        let f0 = |space: Space| space.integrate(|nm| gold.reflectance(nm, 1.0));
        assert!(f0(Space::Rec709).x > 1.0);
        // Computed apart from this program, with slightly other tables of the observer.
        for (space, known) in
            [(Space::Rec2020, DVec3::new(0.906, 0.747, 0.408)), (Space::AcesCg, DVec3::new(0.900, 0.747, 0.417))]
        {
            assert!((f0(space) - known).abs().max_element() < 0.003, "{space:?}: {}", f0(space));
        }
    }
}
