//! The fields of a line and the numbers in them.

use crate::import::resolve::quoted;

/// What stands between two columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Separator {
    Semicolon,
    Tab,
    Comma,
    Blank,
}

impl Separator {
    /// Of the first line that begins with a digit, else of the first that is no comment. A comma divides columns only
    /// where no semicolon or tab does: it is then a decimal comma.
    pub fn of(text: &str) -> Separator {
        let lines = || text.lines().map(str::trim).filter(|line| !line.is_empty());
        let row = lines().find(|line| begins_as_number(line));
        let line = row.or_else(|| lines().find(|line| !line.starts_with(['#', '%', '/']))).unwrap_or_default();
        if line.contains(';') {
            Separator::Semicolon
        } else if line.contains(", ") || line.contains(",\t") {
            // A decimal comma is followed by a digit.
            Separator::Comma
        } else if line.contains('\t') && !aligned(line) {
            Separator::Tab
        } else if line.contains(',') && !line.contains('\t') {
            Separator::Comma
        } else {
            Separator::Blank
        }
    }

    /// The fields of a line, trimmed, without quotes around them and without empty ones at the end.
    pub fn split(self, line: &str) -> Vec<String> {
        let divides = |c: char| match self {
            Separator::Semicolon => c == ';',
            Separator::Tab => c == '\t',
            Separator::Comma => c == ',',
            Separator::Blank => c.is_whitespace(),
        };
        let mut fields = vec![String::new()];
        let mut quote = false;
        for c in line.chars() {
            match fields.last_mut() {
                // Two quotes in a quoted field mean one; a wavelength has none, so that both may go.
                _ if c == '"' => quote = !quote,
                _ if divides(c) && !quote => fields.push(String::new()),
                Some(field) => field.push(c),
                None => {}
            }
        }
        fields.iter_mut().for_each(|field| *field = field.trim().into());
        if self == Separator::Blank {
            fields.retain(|field| !field.is_empty());
        }
        while fields.last().is_some_and(String::is_empty) {
            fields.pop();
        }
        fields
    }
}

/// True when the line begins with a digit, after quotes, signs or a point.
pub(super) fn begins_as_number(line: &str) -> bool {
    line.trim_start_matches(['"', '+', '-', '.']).starts_with(|c: char| c.is_ascii_digit())
}

/// True when tabs only align columns that blanks divide as well.
fn aligned(line: &str) -> bool {
    line.split('\t').any(|field| field.trim().is_empty() || field.trim().contains(char::is_whitespace))
}

/// Which decimal sign a text uses; both in one are a contradiction.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Decimal {
    comma: bool,
    point: bool,
}

/// A finite number; with `decimal` its sign may be a comma, if it is everywhere. The error says what is wrong.
pub(super) fn number(field: &str, decimal: Option<&mut Decimal>) -> Result<f64, String> {
    let is_none = || match field.is_empty() {
        true => "is empty".to_string(),
        false => format!("{} is not a number", quoted(field)),
    };
    let parsed = match decimal {
        Some(_) if field.ends_with(',') => return Err(is_none()),
        Some(decimal) => {
            decimal.comma |= field.contains(',');
            decimal.point |= field.contains('.');
            if decimal.comma && decimal.point {
                return Err(format!("{} follows another decimal sign than the rows above", quoted(field)));
            }
            field.replacen(',', ".", 1).parse::<f64>()
        }
        None => field.parse::<f64>(),
    };
    match parsed {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(format!("{} is not a finite number", quoted(field))),
        Err(_) => Err(is_none()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_separator_is_told_by_the_first_row() {
        for (text, separator) in [
            ("# a;b\nwl,n,k\n400,1,2", Separator::Comma),
            ("wl;n;k\n0,4;1,46;1,95", Separator::Semicolon),
            ("wl\tn\tk\n0,4\t1,46\t1,95", Separator::Tab),
            ("400 \t 1.46 1.95", Separator::Blank),
            ("400\t\t1.46", Separator::Blank),
            ("  400   1.46 1.95", Separator::Blank),
            ("400, 1.46, 1.95", Separator::Comma),
            ("400,\t1.46,\t1.95", Separator::Comma),
        ] {
            assert_eq!(Separator::of(text), separator, "{text}");
        }
    }

    #[test]
    fn quotes_keep_a_separator_inside_a_field() {
        assert_eq!(Separator::Comma.split("\"Wavelength, nm\",\"n\", k ,,"), ["Wavelength, nm", "n", "k"]);
        assert_eq!(Separator::Blank.split("  1.0\t 2  "), ["1.0", "2"]);
        assert_eq!(Separator::Semicolon.split("1;;2"), ["1", "", "2"]);
    }

    #[test]
    fn a_number_is_finite_and_has_one_decimal_sign() {
        let mut decimal = Decimal::default();
        assert_eq!(number("0,5", Some(&mut decimal)), Ok(0.5));
        assert_eq!(number("7", Some(&mut decimal)), Ok(7.0));
        assert!(number("0.5", Some(&mut decimal)).unwrap_err().contains("another decimal sign"));
        assert_eq!(number("5.6E-07", None), Ok(5.6e-7));
        for (text, reason) in
            [("nan", "finite"), ("1e999", "finite"), ("-inf", "finite"), ("1,5", "number"), ("", "empty")]
        {
            assert!(number(text, None).unwrap_err().contains(reason), "{text}");
        }
    }
}
