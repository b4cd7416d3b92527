//! The nine dispersion formulas of the refractiveindex.info database: n over wavelength in micrometres.
//!
//! Their definition is `doc/Dispersion formulas.pdf` of the database (Polyanskiy 2024, Data Records), with coefficients
//! C1, C2 ... and wavelength l:
//!
//! | number | name | formula |
//! |---|---|---|
//! | 1 | Sellmeier | `n^2 - 1 = C1 + sum C2 l^2 / (l^2 - C3^2)` |
//! | 2 | Sellmeier-2 | `n^2 - 1 = C1 + sum C2 l^2 / (l^2 - C3)` |
//! | 3 | Polynomial | `n^2 = C1 + sum C2 l^C3` |
//! | 4 | RefractiveIndex.INFO | `n^2 = C1 + C2 l^C3 / (l^2 - C4^C5) + C6 l^C7 / (l^2 - C8^C9) + sum C10 l^C11` |
//! | 5 | Cauchy | `n = C1 + sum C2 l^C3` |
//! | 6 | Gases | `n - 1 = C1 + sum C2 / (C3 - l^-2)` |
//! | 7 | Herzberger | `n = C1 + C2 / (l^2 - 0.028) + C3 / (l^2 - 0.028)^2 + C4 l^2 + C5 l^4 + C6 l^6` |
//! | 8 | Retro | `(n^2 - 1) / (n^2 + 2) = C1 + C2 l^2 / (l^2 - C3) + C4 l^2` |
//! | 9 | Exotic | `n^2 = C1 + C2 / (l^2 - C3) + C4 (l - C5) / ((l - C5)^2 + C6)` |
//!
//! Sums run over pairs of coefficients.

use super::curve::Sample;

/// Step of the grid on which a formula is evaluated, nm; also its first and last wavelength are taken.
const STEP_NM: u32 = 5;

/// The grid, nm: what an import keeps, and one step beyond.
const GRID_NM: (u32, u32) = (295, 1005);

/// A formula with as many coefficients as it takes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Formula<'a> {
    number: u8,
    c: &'a [f64],
}

impl Formula<'_> {
    /// Checks the number of the formula and of its coefficients. The error says what is wrong.
    pub fn new(number: u8, c: &[f64]) -> Result<Formula<'_>, String> {
        let count = c.len();
        let fits = match number {
            1..=3 | 5 | 6 => count % 2 == 1,
            4 => matches!(count, 1 | 5) || (count >= 9 && count % 2 == 1),
            7 | 9 => (1..=6).contains(&count),
            8 => (1..=4).contains(&count),
            _ => return Err("is not known; there are 1 to 9".into()),
        };
        if fits { Ok(Formula { number, c }) } else { Err(format!("cannot have {count} coefficients")) }
    }

    /// n at a wavelength in micrometres; NaN where the formula gives none.
    pub fn n(&self, l: f64) -> f64 {
        // Coefficients left out are 0.
        let c = |i: usize| self.c.get(i - 1).copied().unwrap_or(0.0);
        let pairs = |from: usize, term: fn(f64, f64, f64) -> f64| -> f64 {
            let pairs = self.c.get(from - 1..).unwrap_or_default().chunks_exact(2);
            pairs.map(|pair| if let [a, b] = pair { term(*a, *b, l) } else { 0.0 }).sum()
        };
        let l2 = l * l;
        let power: fn(f64, f64, f64) -> f64 = |a, b, l| a * l.powf(b);
        // A term that is left out must not divide 0 by 0.
        let pole = |a: f64, b: f64, place: f64| if a == 0.0 { 0.0 } else { a * l.powf(b) / (l2 - place) };
        match self.number {
            1 => (1.0 + c(1) + pairs(2, |a, b, l| a * l * l / (l * l - b * b))).sqrt(),
            2 => (1.0 + c(1) + pairs(2, |a, b, l| a * l * l / (l * l - b))).sqrt(),
            3 => (c(1) + pairs(2, power)).sqrt(),
            4 => {
                let poles = pole(c(2), c(3), c(4).powf(c(5))) + pole(c(6), c(7), c(8).powf(c(9)));
                (c(1) + poles + pairs(10, power)).sqrt()
            }
            5 => c(1) + pairs(2, power),
            6 => 1.0 + c(1) + pairs(2, |a, b, l| a / (b - 1.0 / (l * l))),
            7 => {
                let pole = 1.0 / (l2 - 0.028);
                c(1) + c(2) * pole + c(3) * pole * pole + c(4) * l2 + c(5) * l2 * l2 + c(6) * l2 * l2 * l2
            }
            8 => {
                let r = c(1) + pole(c(2), 2.0, c(3)) + c(4) * l2;
                ((1.0 + 2.0 * r) / (1.0 - r)).sqrt()
            }
            _ => {
                let off = l - c(5);
                let shoulder = if c(4) == 0.0 { 0.0 } else { c(4) * off / (off * off + c(6)) };
                (c(1) + pole(c(2), 0.0, c(3)) + shoulder).sqrt()
            }
        }
    }

    /// n on the grid over the range in micrometres where the formula holds. The error says what is wrong.
    pub fn samples(&self, from: f64, to: f64) -> Result<Vec<Sample>, String> {
        if !(from > 0.0 && to > from) {
            return Err(format!("holds from {from} to {to} um, which is no range"));
        }
        let (first, last) = GRID_NM;
        let grid = (first..=last).step_by(STEP_NM as usize).map(|nm| f64::from(nm) / 1e3);
        let inner = grid.filter(|l| (from..to).contains(l) && *l != from);
        let wavelengths = std::iter::once(from).chain(inner).chain([to]);
        let samples = wavelengths.map(|at| match self.n(at) {
            value if value.is_finite() => Ok(Sample { line: 0, at, value }),
            _ => Err(format!("gives no refractive index at {at} um")),
        });
        samples.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Constants of N-BK7 from the data sheet of SCHOTT, 2017.
    const N_BK7: [f64; 7] = [0.0, 1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653];

    /// Constants of fused silica: I. H. Malitson, J. Opt. Soc. Am. 55, 1205 (1965).
    const SILICA: [f64; 7] = [0.0, 0.6961663, 0.0684043, 0.4079426, 0.1162414, 0.8974794, 9.896161];

    fn n(number: u8, c: &[f64], l: f64) -> f64 {
        Formula::new(number, c).unwrap().n(l)
    }

    #[test]
    fn glasses_have_the_indices_of_their_data_sheets() {
        for (line_um, expected) in [(0.5875618, 1.5168), (0.6562725, 1.51432), (0.4861327, 1.52238)] {
            assert!((n(2, &N_BK7, line_um) - expected).abs() < 5e-6, "{line_um}");
        }
        // Malitson's table 1.
        for (line_um, expected) in [(0.587561, 1.45846), (1.01398, 1.45024), (0.302150, 1.48719)] {
            assert!((n(1, &SILICA, line_um) - expected).abs() < 2e-5, "{line_um}");
        }
    }

    #[test]
    fn each_formula_is_its_definition() {
        let l: f64 = 0.6;
        let l2 = l * l;
        let expected = [
            (3, vec![2.0, 0.1, 2.0, 0.2, -2.0], (2.0 + 0.1 * l2 + 0.2 / l2).sqrt()),
            (5, vec![1.5, 0.01, -2.0], 1.5 + 0.01 / l2),
            (6, vec![1e-5, 0.05, 238.0], 1.0 + 1e-5 + 0.05 / (238.0 - 1.0 / l2)),
            (
                4,
                vec![2.0, 0.3, 1.0, 0.2, 2.0, 0.4, 0.0, 5.0, 1.0, 0.1, 3.0],
                (2.0 + 0.3 * l / (l2 - 0.04) + 0.4 / (l2 - 5.0) + 0.1 * l2 * l).sqrt(),
            ),
            (
                7,
                vec![1.5, 0.01, 0.001, 0.02, 0.03, 0.04],
                1.5 + 0.01 / (l2 - 0.028)
                    + 0.001 / (l2 - 0.028).powi(2)
                    + 0.02 * l2
                    + 0.03 * l2 * l2
                    + 0.04 * l.powi(6),
            ),
            (9, vec![2.0, 0.1, 0.05, 0.3, 0.4, 0.01], (2.0 + 0.1 / (l2 - 0.05) + 0.3 * 0.2 / (0.04 + 0.01)).sqrt()),
        ];
        for (number, c, expected) in expected {
            assert!((n(number, &c, l) - expected).abs() < 1e-12, "{number}");
        }
        let retro = n(8, &[0.2, 0.1, 0.01, 0.02], l);
        let ratio = (retro * retro - 1.0) / (retro * retro + 2.0);
        assert!((ratio - (0.2 + 0.1 * l2 / (l2 - 0.01) + 0.02 * l2)).abs() < 1e-12);
    }

    #[test]
    fn terms_that_are_left_out_do_not_divide_zero_by_zero() {
        // 0^0 is 1, where the pole would be at 1 um.
        assert_eq!(n(4, &[2.25], 1.0), 1.5);
        assert_eq!(n(9, &[2.25], 1.0), 1.5);
        assert_eq!(n(7, &[1.5], 1.0), 1.5);
        assert_eq!(n(8, &[0.0], 1.0), 1.0);
    }

    #[test]
    fn a_formula_with_other_coefficients_or_without_a_range_is_refused() {
        assert!(Formula::new(1, &[0.0, 1.0]).is_err() && Formula::new(4, &[1.0; 7]).is_err());
        assert!(
            Formula::new(8, &[0.1; 5]).is_err() && Formula::new(10, &[1.0]).is_err() && Formula::new(2, &[]).is_err()
        );
        let flat = Formula::new(5, &[1.5]).unwrap();
        assert!(flat.samples(0.7, 0.4).is_err() && flat.samples(f64::NAN, 1.0).is_err());
        assert!(Formula::new(3, &[-1.0]).unwrap().samples(0.4, 0.7).unwrap_err().contains("0.4 um"));
    }

    #[test]
    fn the_grid_has_steps_of_5_nm_and_both_ends() {
        let samples = Formula::new(5, &[1.5]).unwrap().samples(0.398, 0.72).unwrap();
        let at: Vec<f64> = samples.iter().map(|s| s.at).collect();
        assert_eq!((at[0], at[1], at[2], at[at.len() - 1]), (0.398, 0.4, 0.405, 0.72));
        assert_eq!(at.len(), 2 + 64);
        assert!(at.windows(2).all(|w| w[0] < w[1]));
    }
}
