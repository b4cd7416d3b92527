//! Numbers for people, three digits whatever the size.

/// Three digits with the zeros that they end in, for columns; a dash for what is not known.
pub fn three_digits(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        v if v < 1e-3 => format!("{value:.1e}"),
        v if v < 1e4 => format!("{value:.*}", (2.0 - v.log10().floor()).max(0.0) as usize),
        v if v.is_finite() => format!("{value:.0}"),
        _ => "\u{2013}".into(),
    }
}

/// The same without the zeros, for sentences and legends.
pub fn short(value: f64) -> String {
    let text = three_digits(value);
    match text.contains('.') && !text.contains('e') {
        true => text.trim_end_matches('0').trim_end_matches('.').into(),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_three_digits() {
        let values = [0.0, 2.5e-4, 0.0123, 0.5, -2.0, 12.34, 1234.0, 123_456.0];
        let expected = ["0", "2.5e-4", "0.0123", "0.500", "-2.00", "12.3", "1234", "123456"];
        assert_eq!(values.map(three_digits), expected);
        assert_eq!(values.map(short), ["0", "2.5e-4", "0.0123", "0.5", "-2", "12.3", "1234", "123456"]);
        assert_eq!(short(f64::NAN), "\u{2013}");
        assert_eq!(short(100.0), "100");
    }
}
