//! The forms in which a metal's reflectance curve can be rendered.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// How a reflectance curve is stood in for at run time.
///
/// The order is that of cost: what stands before is cheaper to evaluate. A table of 256 colours comes last: it is read
/// in two accesses, but it is 768 numbers where the others are 3 to 15.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Form {
    /// `F* = F0 + (1 - F0)(1 - x)^5` with the true F0.
    Rescaled,
    /// The same with F0 = ((n - 1)/(n + 1))^2.
    Schlick,
    /// `F* - b x (1 - x)^6` through the true F(1/7).
    F82,
    /// The same with b by least squares.
    F82Fitted,
    /// `F* - x (c3 y^3 + c8 y^8)`, y = 1 - x.
    Series2,
    /// `F* - x (c2 y^2 + c6 y^6 + c12 y^12)`.
    Series3,
    /// `F* - x (c2 y^2 + c4 y^4 + c8 y^8 + c16 y^16)`.
    Series4,
    /// `F* - a x (1 - x)^alpha`, a and alpha of the least largest error.
    Fitted,
    /// The same with the published closed form of a and alpha.
    Recipe,
    /// Exact for one n and k per channel, found from the integrated curve.
    EffectiveNk,
    /// Exact for the measured n and k at one wavelength per channel.
    SampledNk,
    /// Exact for n and k of a reflectance r and an edge tint g.
    Gulbrandsen,
    /// The integrated curves in 256 entries: the truth.
    Spectral,
}

impl Form {
    /// Every form, the cheapest first.
    pub const ALL: [Form; 13] = [
        Form::Rescaled,
        Form::Schlick,
        Form::F82,
        Form::F82Fitted,
        Form::Series2,
        Form::Series3,
        Form::Series4,
        Form::Fitted,
        Form::Recipe,
        Form::EffectiveNk,
        Form::SampledNk,
        Form::Gulbrandsen,
        Form::Spectral,
    ];

    /// As files and the command line name it.
    pub const fn id(self) -> &'static str {
        match self {
            Form::Rescaled => "rescaled",
            Form::Schlick => "schlick",
            Form::F82 => "f82",
            Form::F82Fitted => "f82-fitted",
            Form::Series2 => "series-2",
            Form::Series3 => "series-3",
            Form::Series4 => "series-4",
            Form::Fitted => "fitted",
            Form::Recipe => "recipe",
            Form::EffectiveNk => "effective-nk",
            Form::SampledNk => "sampled-nk",
            Form::Gulbrandsen => "gulbrandsen",
            Form::Spectral => "spectral",
        }
    }

    /// What it is, in a line.
    pub const fn help(self) -> &'static str {
        match self {
            Form::Rescaled => "Schlick's curve with the true reflectance at normal incidence",
            Form::Schlick => "Schlick's curve without extinction: wrong for metals, for comparison",
            Form::F82 => "Schlick's curve with a dip through the true value at 82 degrees, as OpenPBR and Blender do",
            Form::F82Fitted => "the same dip, by least squares over all angles",
            Form::Series2 => "Schlick's curve with a dip of two fitted powers",
            Form::Series3 => "Schlick's curve with a dip of three fitted powers",
            Form::Series4 => "Schlick's curve with a dip of four fitted powers",
            Form::Fitted => "Schlick's curve with a dip of one power, strength and exponent fitted",
            Form::Recipe => "the same dip by the published recipe; without a dip where the recipe is not valid",
            Form::EffectiveNk => "the exact formula with one n and k per channel that meet the integrated curve",
            Form::SampledNk => "the exact formula with the n and k of 610, 550 and 465 nm",
            Form::Gulbrandsen => {
                "the exact formula with n and k from reflectance and edge tint, as standard_surface does"
            }
            Form::Spectral => "the measured spectrum, integrated at 256 angles: the truth",
        }
    }
}

impl fmt::Display for Form {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.id())
    }
}

/// No form of that name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no Fresnel form `{0}`; there are {list}", list = Form::ALL.map(Form::id).join(", "))]
pub struct UnknownForm(pub String);

impl FromStr for Form {
    type Err = UnknownForm;

    /// By its id; `series` is the series of four terms.
    fn from_str(text: &str) -> Result<Form, UnknownForm> {
        let id = if text == "series" { "series-4" } else { text };
        Form::ALL.into_iter().find(|form| form.id() == id).ok_or_else(|| UnknownForm(text.into()))
    }
}

impl Serialize for Form {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.id())
    }
}

impl<'de> Deserialize<'de> for Form {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Form, D::Error> {
        let text = String::deserialize(deserializer)?;
        text.parse().map_err(serde::de::Error::custom)
    }
}
