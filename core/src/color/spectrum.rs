//! Functions of wavelength given by a table.

/// Values at increasing wavelengths, linear in between, constant beyond the ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    wavelength_nm: Vec<f64>,
    values: Vec<f64>,
}

/// Why a table is no [`Spectrum`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SpectrumError {
    /// Nothing in it.
    #[error("the table is empty")]
    Empty,
    /// One list is longer.
    #[error("{wavelengths} wavelengths but {values} values")]
    Lengths {
        /// Number of wavelengths.
        wavelengths: usize,
        /// Number of values.
        values: usize,
    },
    /// A wavelength does not exceed the one before, or is not a finite positive number.
    #[error("wavelength {index} is {wavelength_nm} nm; wavelengths must be positive and strictly increasing")]
    Order {
        /// Place in the list, from 0.
        index: usize,
        /// What stands there.
        wavelength_nm: f64,
    },
    /// A value is infinite or not a number.
    #[error("value {index} is {value}; values must be finite")]
    Value {
        /// Place in the list, from 0.
        index: usize,
        /// What stands there.
        value: f64,
    },
}

impl Spectrum {
    /// Checks and keeps a table; wavelengths in nm, any spacing.
    pub fn new(wavelength_nm: Vec<f64>, values: Vec<f64>) -> Result<Spectrum, SpectrumError> {
        if wavelength_nm.len() != values.len() {
            return Err(SpectrumError::Lengths { wavelengths: wavelength_nm.len(), values: values.len() });
        }
        if wavelength_nm.is_empty() {
            return Err(SpectrumError::Empty);
        }
        let mut last = 0.0;
        for (index, &w) in wavelength_nm.iter().enumerate() {
            if !(w > last && w.is_finite()) {
                return Err(SpectrumError::Order { index, wavelength_nm: w });
            }
            last = w;
        }
        if let Some((index, &value)) = values.iter().enumerate().find(|(_, v)| !v.is_finite()) {
            return Err(SpectrumError::Value { index, value });
        }
        Ok(Spectrum { wavelength_nm, values })
    }

    /// Value at a wavelength in nm.
    pub fn at(&self, wavelength_nm: f64) -> f64 {
        interpolate(&self.wavelength_nm, &self.values, wavelength_nm)
    }

    /// First and last wavelength, nm.
    pub fn range_nm(&self) -> (f64, f64) {
        match (self.wavelength_nm.first(), self.wavelength_nm.last()) {
            (Some(&first), Some(&last)) => (first, last),
            _ => (0.0, 0.0),
        }
    }

    /// The wavelengths, nm.
    pub fn wavelengths_nm(&self) -> &[f64] {
        &self.wavelength_nm
    }

    /// The values at [`Spectrum::wavelengths_nm`].
    pub fn values(&self) -> &[f64] {
        &self.values
    }
}

/// Value at `x` of a table with increasing `xs`: linear in between, constant beyond the ends, 0 where there is no
/// table.
pub fn interpolate(xs: &[f64], values: &[f64], x: f64) -> f64 {
    let after = xs.partition_point(|&entry| entry <= x);
    let before = after.saturating_sub(1);
    let (Some(&x0), Some(&v0)) = (xs.get(before), values.get(before)) else { return 0.0 };
    match (xs.get(after), values.get(after)) {
        (Some(&x1), Some(&v1)) if x > x0 => v0 + (v1 - v0) * (x - x0) / (x1 - x0),
        _ => v0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_met_at_its_entries_linear_between_and_constant_beyond() {
        let s = Spectrum::new(vec![400.0, 450.0, 650.0], vec![1.0, 2.0, 0.0]).unwrap();
        for (nm, value) in [(400.0, 1.0), (425.0, 1.5), (450.0, 2.0), (550.0, 1.0), (650.0, 0.0)] {
            assert!((s.at(nm) - value).abs() < 1e-15, "{nm}");
        }
        assert_eq!((s.at(0.0), s.at(900.0)), (1.0, 0.0));
        assert_eq!(s.range_nm(), (400.0, 650.0));
    }

    #[test]
    fn a_table_that_is_no_function_of_wavelength_is_refused_with_the_place() {
        assert_eq!(Spectrum::new(vec![], vec![]), Err(SpectrumError::Empty));
        assert!(matches!(Spectrum::new(vec![400.0], vec![]), Err(SpectrumError::Lengths { .. })));
        let twice = Spectrum::new(vec![400.0, 400.0], vec![1.0, 1.0]).unwrap_err();
        assert!(twice.to_string().contains("wavelength 1 is 400 nm"));
        let nan = Spectrum::new(vec![400.0, 410.0], vec![1.0, f64::NAN]).unwrap_err();
        assert!(nan.to_string().contains("value 1 is NaN"));
        assert!(Spectrum::new(vec![f64::NAN], vec![1.0]).is_err());
    }
}
