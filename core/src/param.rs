//! Settings declared once: whoever shows, reads or checks them goes by the same list.

use std::fmt;

/// One setting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParamSpec {
    /// Name in files and on the command line, lower case with hyphens.
    pub key: &'static str,
    /// Name for people.
    pub label: &'static str,
    /// Unit such as `EV`; empty where there is none.
    pub unit: &'static str,
    /// Values that it takes.
    pub kind: ParamKind,
    /// One sentence on what it does.
    pub help: &'static str,
    /// What must be done anew when it changes.
    pub affects: Affects,
}

/// The values that a setting takes, with its default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParamKind {
    /// A whole number in `min..=max`.
    Integer {
        /// Least value.
        min: i64,
        /// Greatest value.
        max: i64,
        /// Value when not set.
        default: i64,
    },
    /// A number in `min..=max`.
    Number {
        /// Least value.
        min: f64,
        /// Greatest value.
        max: f64,
        /// Value when not set.
        default: f64,
    },
    /// One of a list of words.
    Choice {
        /// The words.
        options: &'static [&'static str],
        /// Index of the word when not set.
        default: usize,
    },
}

/// What must be done anew when a setting changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Affects {
    /// The preparation of the method.
    Prepare,
    /// Only the next frame.
    Frame,
}

/// A value of a setting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParamValue {
    /// For [`ParamKind::Integer`].
    Integer(i64),
    /// For [`ParamKind::Number`].
    Number(f64),
    /// For [`ParamKind::Choice`]: index of the word.
    Choice(usize),
}

/// Why a value was refused. Its text names the setting and what it takes.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ParamError {
    /// No setting of that name.
    #[error("no setting `{key}`; there are: {known}")]
    Unknown {
        /// What was asked for.
        key: String,
        /// All keys.
        known: String,
    },
    /// The text is not of the setting's kind or out of its range.
    #[error("`{text}` is not a value of `{key}`; it takes {takes}")]
    Value {
        /// The setting.
        key: &'static str,
        /// What was given.
        text: String,
        /// What would be right.
        takes: String,
    },
}

impl fmt::Display for ParamKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ParamKind::Integer { min, max, .. } => write!(f, "a whole number from {min} to {max}"),
            ParamKind::Number { min, max, .. } => write!(f, "a number from {min} to {max}"),
            ParamKind::Choice { options, .. } => write!(f, "one of {}", options.join(", ")),
        }
    }
}

impl ParamSpec {
    /// The value when nothing is set.
    pub fn default(&self) -> ParamValue {
        match self.kind {
            ParamKind::Integer { default, .. } => ParamValue::Integer(default),
            ParamKind::Number { default, .. } => ParamValue::Number(default),
            ParamKind::Choice { default, .. } => ParamValue::Choice(default),
        }
    }

    /// Reads a value from text, refusing what is out of range.
    pub fn parse(&self, text: &str) -> Result<ParamValue, ParamError> {
        let text = text.trim();
        let value = match self.kind {
            ParamKind::Integer { min, max, .. } => {
                text.parse().ok().filter(|v| (min..=max).contains(v)).map(ParamValue::Integer)
            }
            ParamKind::Number { min, max, .. } => {
                text.parse().ok().filter(|v| (min..=max).contains(v)).map(ParamValue::Number)
            }
            ParamKind::Choice { options, .. } => options.iter().position(|o| *o == text).map(ParamValue::Choice),
        };
        value.ok_or_else(|| ParamError::Value { key: self.key, text: text.into(), takes: self.kind.to_string() })
    }
}

/// Finds a setting by its key.
pub fn find<'a>(specs: &'a [ParamSpec], key: &str) -> Result<&'a ParamSpec, ParamError> {
    specs.iter().find(|spec| spec.key == key).ok_or_else(|| ParamError::Unknown {
        key: key.into(),
        known: specs.iter().map(|spec| spec.key).collect::<Vec<_>>().join(", "),
    })
}

/// Values for a list of settings, defaults where nothing was set.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    specs: &'static [ParamSpec],
    values: Vec<ParamValue>,
}

impl Settings {
    /// All defaults.
    pub fn new(specs: &'static [ParamSpec]) -> Settings {
        Settings { specs, values: specs.iter().map(ParamSpec::default).collect() }
    }

    /// Sets one from text such as a command line's `--set key=value`.
    pub fn set(&mut self, key: &str, text: &str) -> Result<(), ParamError> {
        let spec = find(self.specs, key)?;
        let index = self.specs.iter().position(|s| s.key == spec.key).unwrap_or(0);
        self.values[index] = spec.parse(text)?;
        Ok(())
    }

    /// The settings with their values, in the order of declaration.
    pub fn iter(&self) -> impl Iterator<Item = (&'static ParamSpec, ParamValue)> {
        self.specs.iter().zip(self.values.iter().copied())
    }

    /// Value of a declared setting; `None` for a key that is not in the list.
    pub fn get(&self, key: &str) -> Option<ParamValue> {
        self.iter().find(|(spec, _)| spec.key == key).map(|(_, value)| value)
    }

    /// The word of a [`ParamKind::Choice`], or the number as text.
    pub fn text(&self, key: &str) -> Option<String> {
        let (spec, value) = self.iter().find(|(spec, _)| spec.key == key)?;
        Some(match (spec.kind, value) {
            (ParamKind::Choice { options, .. }, ParamValue::Choice(index)) => options.get(index)?.to_string(),
            (_, ParamValue::Integer(v)) => v.to_string(),
            (_, ParamValue::Number(v)) => v.to_string(),
            (_, ParamValue::Choice(index)) => index.to_string(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPECS: &[ParamSpec] = &[ParamSpec {
        key: "samples",
        label: "Samples",
        unit: "",
        kind: ParamKind::Integer { min: 0, max: 1024, default: 0 },
        help: "",
        affects: Affects::Frame,
    }];

    #[test]
    fn a_value_in_range_is_read_and_one_outside_is_refused_with_the_range() {
        let spec = find(SPECS, "samples").unwrap();
        assert_eq!(spec.parse("64"), Ok(ParamValue::Integer(64)));
        assert!(spec.parse("2000").unwrap_err().to_string().contains("0 to 1024"));
        assert!(find(SPECS, "sample").unwrap_err().to_string().contains("samples"));
    }
}
