//! Settings declared once: whoever shows, reads or checks them goes by the same list.

use std::fmt;

use serde_json::Value;

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
    /// On or off.
    Toggle {
        /// Value when not set.
        default: bool,
    },
    /// A linear Rec.709 colour, each channel in `0..=max`.
    Color {
        /// Greatest value of a channel.
        max: f64,
        /// Value when not set.
        default: [f64; 3],
    },
    /// A point or direction, each coordinate between those of `min` and `max`.
    Vector {
        /// Least coordinates.
        min: [f64; 3],
        /// Greatest coordinates.
        max: [f64; 3],
        /// Value when not set.
        default: [f64; 3],
    },
}

/// What must be done anew when a setting changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Affects {
    /// The preparation of the method.
    Prepare,
    /// The materials, into which it is resolved; with them what is prepared of materials.
    Materials,
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
    /// For [`ParamKind::Toggle`].
    Toggle(bool),
    /// For [`ParamKind::Color`].
    Color([f64; 3]),
    /// For [`ParamKind::Vector`].
    Vector([f64; 3]),
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
            ParamKind::Toggle { .. } => write!(f, "on or off"),
            ParamKind::Color { max, .. } => write!(f, "three numbers from 0 to {max}, with commas between"),
            ParamKind::Vector { min, max, .. } => {
                let [from, to] = [min, max].map(|v| v.map(|c| c.to_string()).join(","));
                write!(f, "three numbers from {from} to {to}, with commas between")
            }
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
            ParamKind::Toggle { default } => ParamValue::Toggle(default),
            ParamKind::Color { default, .. } => ParamValue::Color(default),
            ParamKind::Vector { default, .. } => ParamValue::Vector(default),
        }
    }

    /// True for a value of the right kind and in range.
    pub fn accepts(&self, value: ParamValue) -> bool {
        match (self.kind, value) {
            (ParamKind::Integer { min, max, .. }, ParamValue::Integer(v)) => (min..=max).contains(&v),
            (ParamKind::Number { min, max, .. }, ParamValue::Number(v)) => (min..=max).contains(&v),
            (ParamKind::Choice { options, .. }, ParamValue::Choice(index)) => index < options.len(),
            (ParamKind::Toggle { .. }, ParamValue::Toggle(_)) => true,
            (ParamKind::Color { max, .. }, ParamValue::Color(c)) => c.iter().all(|v| (0.0..=max).contains(v)),
            (ParamKind::Vector { min, max, .. }, ParamValue::Vector(v)) => {
                (0..3).all(|axis| (min[axis]..=max[axis]).contains(&v[axis]))
            }
            _ => false,
        }
    }

    /// A value as files hold it: a number, a word, true or false, or three numbers.
    pub fn json(&self, value: ParamValue) -> Value {
        match (self.kind, value) {
            (ParamKind::Choice { options, .. }, ParamValue::Choice(index)) => {
                options.get(index).map_or(Value::Null, |word| (*word).into())
            }
            (_, ParamValue::Integer(v)) => v.into(),
            (_, ParamValue::Number(v)) => v.into(),
            (_, ParamValue::Choice(index)) => index.into(),
            (_, ParamValue::Toggle(on)) => on.into(),
            (_, ParamValue::Color(c) | ParamValue::Vector(c)) => c.to_vec().into(),
        }
    }

    /// Reads what [`ParamSpec::json`] wrote, refusing what is out of range.
    pub fn from_json(&self, json: &Value) -> Result<ParamValue, ParamError> {
        let value = match (self.kind, json) {
            (ParamKind::Integer { .. }, Value::Number(n)) => n.as_i64().map(ParamValue::Integer),
            (ParamKind::Number { .. }, Value::Number(n)) => n.as_f64().map(ParamValue::Number),
            (ParamKind::Choice { options, .. }, Value::String(word)) => {
                options.iter().position(|o| o == word).map(ParamValue::Choice)
            }
            (ParamKind::Toggle { .. }, Value::Bool(on)) => Some(ParamValue::Toggle(*on)),
            (ParamKind::Color { .. }, Value::Array(parts)) => {
                three(parts.iter().map(Value::as_f64)).map(ParamValue::Color)
            }
            (ParamKind::Vector { .. }, Value::Array(parts)) => {
                three(parts.iter().map(Value::as_f64)).map(ParamValue::Vector)
            }
            _ => None,
        };
        let accepted = value.filter(|value| self.accepts(*value));
        accepted.ok_or_else(|| self.refusal(&json.to_string()))
    }

    fn refusal(&self, text: &str) -> ParamError {
        ParamError::Value { key: self.key, text: text.into(), takes: self.kind.to_string() }
    }

    /// Reads a value from text, refusing what is out of range.
    pub fn parse(&self, text: &str) -> Result<ParamValue, ParamError> {
        let text = text.trim();
        let value = match self.kind {
            ParamKind::Integer { .. } => text.parse().ok().map(ParamValue::Integer),
            ParamKind::Number { .. } => text.parse().ok().map(ParamValue::Number),
            ParamKind::Choice { options, .. } => options.iter().position(|o| *o == text).map(ParamValue::Choice),
            ParamKind::Toggle { .. } => match text {
                "on" | "true" => Some(ParamValue::Toggle(true)),
                "off" | "false" => Some(ParamValue::Toggle(false)),
                _ => None,
            },
            ParamKind::Color { .. } => numbers(text).map(ParamValue::Color),
            ParamKind::Vector { .. } => numbers(text).map(ParamValue::Vector),
        };
        value.filter(|value| self.accepts(*value)).ok_or_else(|| self.refusal(text))
    }
}

/// Three numbers with commas between.
fn numbers(text: &str) -> Option<[f64; 3]> {
    three(text.split(',').map(|part| part.trim().parse().ok()))
}

/// Exactly three numbers.
fn three(parts: impl Iterator<Item = Option<f64>>) -> Option<[f64; 3]> {
    parts.collect::<Option<Vec<f64>>>()?.try_into().ok()
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
        let value = find(self.specs, key)?.parse(text)?;
        self.set_value(key, value)
    }

    /// The settings with their values, in the order of declaration.
    pub fn iter(&self) -> impl Iterator<Item = (&'static ParamSpec, ParamValue)> {
        self.specs.iter().zip(self.values.iter().copied())
    }

    /// Value of a declared setting; `None` for a key that is not in the list.
    pub fn get(&self, key: &str) -> Option<ParamValue> {
        self.iter().find(|(spec, _)| spec.key == key).map(|(_, value)| value)
    }

    /// Value of a setting; its default where it is not in the list.
    pub fn value(&self, spec: &ParamSpec) -> ParamValue {
        self.get(spec.key).unwrap_or(spec.default())
    }

    /// That of a [`ParamKind::Integer`]; 1 where it is none of `u32`.
    pub fn whole(&self, spec: &ParamSpec) -> u32 {
        match self.value(spec) {
            ParamValue::Integer(number) => u32::try_from(number).unwrap_or(1),
            _ => 1,
        }
    }

    /// That of a [`ParamKind::Number`]; 1 for another kind.
    pub fn number(&self, spec: &ParamSpec) -> f32 {
        match self.value(spec) {
            ParamValue::Number(number) => number as f32,
            _ => 1.0,
        }
    }

    /// The place in the options of a [`ParamKind::Choice`]; 0 for another kind.
    pub fn choice(&self, spec: &ParamSpec) -> usize {
        match self.value(spec) {
            ParamValue::Choice(place) => place,
            _ => 0,
        }
    }

    /// That of a [`ParamKind::Color`]; white for another kind.
    pub fn color(&self, spec: &ParamSpec) -> [f32; 3] {
        match self.value(spec) {
            ParamValue::Color(color) => color.map(|channel| channel as f32),
            _ => [1.0; 3],
        }
    }

    /// The word of a [`ParamKind::Choice`], or the number as text.
    pub fn text(&self, key: &str) -> Option<String> {
        let (spec, value) = self.iter().find(|(spec, _)| spec.key == key)?;
        Some(match (spec.kind, value) {
            (ParamKind::Choice { options, .. }, ParamValue::Choice(index)) => options.get(index)?.to_string(),
            (_, ParamValue::Integer(v)) => v.to_string(),
            (_, ParamValue::Number(v)) => v.to_string(),
            (_, ParamValue::Choice(index)) => index.to_string(),
            (_, ParamValue::Toggle(on)) => if on { "on" } else { "off" }.into(),
            (_, ParamValue::Color([x, y, z]) | ParamValue::Vector([x, y, z])) => format!("{x},{y},{z}"),
        })
    }

    /// Sets one to a value; one of the wrong kind or out of range is refused.
    pub fn set_value(&mut self, key: &str, value: ParamValue) -> Result<(), ParamError> {
        let spec = find(self.specs, key)?;
        if !spec.accepts(value) {
            return Err(spec.refusal(&spec.json(value).to_string()));
        }
        let place = self.specs.iter().position(|s| s.key == spec.key);
        if let Some(slot) = place.and_then(|place| self.values.get_mut(place)) {
            *slot = value;
        }
        Ok(())
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

    #[test]
    fn values_of_every_kind_go_through_json_and_text_unchanged() {
        let kinds = [
            (ParamKind::Integer { min: -3, max: 3, default: 0 }, ParamValue::Integer(-2), "-2"),
            (ParamKind::Number { min: 0.0, max: 1.0, default: 0.0 }, ParamValue::Number(0.1), "0.1"),
            (ParamKind::Choice { options: &["a", "b"], default: 0 }, ParamValue::Choice(1), "b"),
            (ParamKind::Toggle { default: false }, ParamValue::Toggle(true), "on"),
            (ParamKind::Color { max: 1.0, default: [0.0; 3] }, ParamValue::Color([0.1, 0.2, 1.0]), "0.1,0.2,1"),
            (
                ParamKind::Vector { min: [-1.0; 3], max: [0.0, 1.0, 2.0], default: [0.0; 3] },
                ParamValue::Vector([-0.5, 0.25, 1.5]),
                "-0.5, 0.25, 1.5",
            ),
        ];
        for (kind, value, text) in kinds {
            let spec = ParamSpec { kind, ..SPECS[0] };
            assert_eq!(spec.from_json(&spec.json(value)), Ok(value));
            assert_eq!(spec.parse(text), Ok(value));
            assert!(spec.from_json(&Value::Null).is_err() && spec.parse("").is_err());
        }
    }

    #[test]
    fn a_value_out_of_range_is_refused_from_json_too() {
        let spec = ParamSpec { kind: ParamKind::Color { max: 1.0, default: [0.0; 3] }, ..SPECS[0] };
        assert!(spec.from_json(&serde_json::json!([0.0, 2.0, 0.0])).is_err());
        assert!(spec.from_json(&serde_json::json!([0.0, 1.0])).is_err());
        assert!(!spec.accepts(ParamValue::Color([f64::NAN, 0.0, 0.0])));
        let kind = ParamKind::Vector { min: [-1.0; 3], max: [0.0, 1.0, 2.0], default: [0.0; 3] };
        let spec = ParamSpec { kind, ..SPECS[0] };
        assert!(spec.parse("0.5,0,0").unwrap_err().to_string().contains("from -1,-1,-1 to 0,1,2"));
        assert!(spec.parse("0,0").is_err() && spec.parse("0,0,0,0").is_err() && spec.parse("0,NaN,0").is_err());
        assert!(!spec.accepts(ParamValue::Color([0.0; 3])), "a colour is no vector");
    }
}
