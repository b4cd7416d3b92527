//! Chromatic adaptation: what a colour under one white looks like under another.

use glam::{DMat3, DVec3};

/// XYZ under the white `to` that look as XYZ do under the white `from`; both whites in XYZ, Y = 1. Bradford, linear
/// (Lam 1985).
pub fn bradford(from: DVec3, to: DVec3) -> DMat3 {
    let cone_from_xyz =
        DMat3::from_cols_array(&[0.8951, -0.7502, 0.0389, 0.2664, 1.7135, -0.0685, -0.1614, 0.0367, 1.0296]);
    let gain = (cone_from_xyz * to) / (cone_from_xyz * from);
    cone_from_xyz.inverse() * DMat3::from_diagonal(gain) * cone_from_xyz
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::illuminant::{A, D65, xyz};

    #[test]
    fn white_becomes_white_and_the_way_back_undoes_it() {
        let (a, d65) = (xyz(&A), xyz(&D65));
        assert!((bradford(a, d65) * a - d65).abs().max_element() < 1e-14);
        let identity = bradford(d65, a) * bradford(a, d65);
        for c in 0..3 {
            assert!((identity.col(c) - DMat3::IDENTITY.col(c)).abs().max_element() < 1e-14, "{identity}");
        }
    }
}
