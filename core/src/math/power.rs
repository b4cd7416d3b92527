//! Logarithm and exponential to base 2 without branches or tables: loops over them become vector code.

use std::f32::consts::LOG2_E;

use super::bounded;

/// log2 of a positive normal number; absolute error below 3e-7 plus the rounding of the result.
///
/// With x = 2^e m, m in [sqrt(1/2), sqrt 2): log2 m = 2/ln 2 (t + t^3/3 + t^5/5 + t^7/7), t = (m - 1)/(m + 1).
#[inline(always)]
pub fn log2(x: f32) -> f32 {
    // Bits of sqrt(1/2): what is left of the bits above it is the exponent.
    const ROOT: i32 = 0x3f35_04f3;
    let bits = x.to_bits() as i32;
    let exponent = (bits - ROOT) >> 23;
    let m = f32::from_bits((bits - (exponent << 23)) as u32);
    let t = (m - 1.0) / (m + 1.0);
    let t2 = t * t;
    let series = t * (1.0 + t2 * (1.0 / 3.0 + t2 * (1.0 / 5.0 + t2 * (1.0 / 7.0))));
    exponent as f32 + 2.0 * LOG2_E * series
}

/// 2^x for x in [-126, 126], held there; relative error below 3e-7.
///
/// The whole part becomes the exponent; the rest, at most 1/2, goes through the Taylor series to the sixth power, whose
/// next term is 1.5e-7 at most.
#[inline(always)]
pub fn exp2(x: f32) -> f32 {
    const LN_2: f32 = std::f32::consts::LN_2;
    // Added and taken off again, 1.5 2^23 leaves the nearest whole number.
    const WHOLE: f32 = 12_582_912.0;
    let x = bounded(x, -126.0, 126.0);
    let whole = (x + WHOLE) - WHOLE;
    let f = (x - whole) * LN_2;
    let powers = f * (1.0 / 24.0 + f * (1.0 / 120.0 + f * (1.0 / 720.0)));
    let series = 1.0 + f * (1.0 + f * (0.5 + f * (1.0 / 6.0 + powers)));
    f32::from_bits((series.to_bits() as i32 + ((whole as i32) << 23)) as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_functions_keep_the_digits_that_they_promise() {
        let (mut log_error, mut exp_error) = (0.0f64, 0.0f64);
        for i in 0..2_000_000 {
            let exponent = -100.0 + 200.0 * f64::from(i) / 2e6;
            let x = exponent.exp2() as f32;
            let rounding = 6e-8 * exponent.abs();
            log_error = log_error.max((f64::from(log2(x)) - f64::from(x).log2()).abs() - rounding);
            let given = exponent as f32;
            exp_error = exp_error.max((f64::from(exp2(given)) / f64::from(given).exp2() - 1.0).abs());
        }
        println!("log2 {log_error:.1e}, exp2 {exp_error:.1e}");
        assert!(log_error < 3e-7 && exp_error < 3e-7, "{log_error:e} {exp_error:e}");
    }

    #[test]
    fn beyond_the_range_the_ends_are_held() {
        assert_eq!(exp2(-1e9), exp2(-126.0));
        assert!(exp2(1e9).is_finite());
        assert_eq!((exp2(0.0), exp2(3.0), log2(1.0), log2(8.0)), (1.0, 8.0, 0.0, 3.0));
    }
}
