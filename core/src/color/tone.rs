//! Display transforms: from unbounded scene-linear light to what a screen shows.
//!
//! All take linear Rec.709 with exposure already applied, are defined for every input (negative and NaN count as 0,
//! infinity as [`MAX_LINEAR`]), and clamp to what the screen can show. WGSL twin: `tone.wgsl`.

use glam::{Mat3, Vec3};

use crate::color::rgb::srgb_from_linear;
use crate::leaf::Leaf;

/// The WGSL twin, which also holds the sRGB transfer.
pub static LEAF: Leaf = Leaf { name: "tone", source: include_str!("tone.wgsl"), needs: &[], externs: "" };

/// WGSL number of [`ToneMap::None`].
pub const TONE_NONE: u32 = 0;
/// WGSL number of [`ToneMap::Neutral`].
pub const TONE_NEUTRAL: u32 = 1;
/// WGSL number of [`ToneMap::AgX`].
pub const TONE_AGX: u32 = 2;
/// WGSL number of [`ToneMap::Aces`].
pub const TONE_ACES: u32 = 3;

/// Larger values are taken for this one, so that no intermediate result overflows; far above the white of every view.
pub const MAX_LINEAR: f32 = 1e9;

/// A display transform.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum ToneMap {
    /// Clamps to [0, 1]: the measuring view.
    None = TONE_NONE,
    /// Khronos PBR Neutral: base colours under grey light keep hue and saturation, highlights roll off.
    #[default]
    Neutral = TONE_NEUTRAL,
    /// AgX: filmic, bright colours go to white.
    AgX = TONE_AGX,
    /// A fit of the ACES 1.0 output transform for sRGB: contrasty; shifts hues of bright colours.
    Aces = TONE_ACES,
}

/// No view of that name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no display transform `{0}`; there are none, neutral, agx, aces")]
pub struct UnknownToneMap(pub String);

impl ToneMap {
    /// Every transform, in the order of their numbers.
    pub const ALL: [ToneMap; 4] = [ToneMap::None, ToneMap::Neutral, ToneMap::AgX, ToneMap::Aces];

    /// Name in files and on the command line.
    pub fn id(self) -> &'static str {
        match self {
            ToneMap::None => "none",
            ToneMap::Neutral => "neutral",
            ToneMap::AgX => "agx",
            ToneMap::Aces => "aces",
        }
    }

    /// Name for people.
    pub fn title(self) -> &'static str {
        match self {
            ToneMap::None => "None (clamp)",
            ToneMap::Neutral => "Khronos PBR Neutral",
            ToneMap::AgX => "AgX",
            ToneMap::Aces => "ACES fit",
        }
    }

    /// Number in shaders: one of the `TONE_` constants.
    pub fn number(self) -> u32 {
        self as u32
    }
}

impl std::str::FromStr for ToneMap {
    type Err = UnknownToneMap;

    fn from_str(text: &str) -> Result<ToneMap, UnknownToneMap> {
        let wanted = text.trim().to_ascii_lowercase();
        ToneMap::ALL.into_iter().find(|tone| tone.id() == wanted).ok_or_else(|| UnknownToneMap(text.into()))
    }
}

/// Factor on scene-linear light for an exposure in EV: `2^ev`.
pub fn exposure_factor(exposure_ev: f32) -> f32 {
    exposure_ev.exp2()
}

/// Display-encoded sRGB in [0, 1] of exposed scene-linear Rec.709.
pub fn tone_map(kind: ToneMap, linear: Vec3) -> Vec3 {
    srgb_from_linear(tone_display_linear(kind, linear))
}

/// The light that the screen gives off, linear Rec.709 in [0, 1], before encoding.
pub fn tone_display_linear(kind: ToneMap, linear: Vec3) -> Vec3 {
    // Not `clamp`, which would let NaN pass.
    let admit = |v: f32| if v > 0.0 { v.min(MAX_LINEAR) } else { 0.0 };
    let x = Vec3::new(admit(linear.x), admit(linear.y), admit(linear.z));
    let shown = match kind {
        ToneMap::None => x,
        ToneMap::Neutral => tone_neutral(x),
        ToneMap::AgX => tone_agx(x),
        ToneMap::Aces => tone_aces(x),
    };
    shown.clamp(Vec3::ZERO, Vec3::ONE)
}

/// Khronos 2024, PBR Neutral Tone Mapper Specification. Domain: x >= 0.
///
/// Takes off the Fresnel reflection of a dielectric (0.04), keeps what lies below 0.8, and compresses the largest
/// channel above by a hyperbola, mixing in white as it brightens.
fn tone_neutral(x: Vec3) -> Vec3 {
    const F90: f32 = 0.04;
    const START: f32 = 0.8 - F90;
    const DESATURATION: f32 = 0.15;
    let least = x.min_element();
    // A parabola through 0 that meets the constant offset smoothly at 2 F90; 6.25 = 1 / (4 F90).
    let offset = if least < 2.0 * F90 { least - 6.25 * least * least } else { F90 };
    let color = x - offset;
    let peak = color.max_element();
    if peak < START {
        return color;
    }
    let room = 1.0 - START;
    let new_peak = 1.0 - room * room / (peak + room - START);
    let white = 1.0 - 1.0 / (DESATURATION * (peak - new_peak) + 1.0);
    (color * (new_peak / peak)).lerp(Vec3::splat(new_peak), white)
}

/// Stops below and above middle grey that AgX spreads over its curve.
const AGX_STOPS: (f32, f32) = (-10.0, 6.5);
/// log2 of middle grey, 0.18.
const AGX_LOG2_GREY: f32 = -2.473_931_2;
/// Where middle grey lies on the curve: 10 / 16.5.
const AGX_PIVOT: f32 = 0.606_060_6;
/// Makes the lower piece of the curve pass through (0, 0): `((4p)^3 - 1) / p^3`, p the pivot.
const AGX_TOE: f32 = 59.507_877;
/// Makes the upper piece pass through (1, 1): `((4q)^3.25 - 1) / q^3.25`, q = 1 - p.
const AGX_SHOULDER: f32 = 69.862_79;
/// Moves the primaries inwards. The published rows sum to 1 within 1.4e-4; here they are divided by their sums, so that
/// grey stays grey.
const AGX_INSET: Mat3 = Mat3::from_cols(
    Vec3::new(0.842_364_16, 0.042_329_81, 0.042_377_68),
    Vec3::new(0.078_422_9, 0.878_501_1, 0.078_437_35),
    Vec3::new(0.079_212_94, 0.079_169_06, 0.879_184_97),
);
/// The inverse of the inset.
const AGX_OUTSET: Mat3 = Mat3::from_cols(
    Vec3::new(1.197_042_3, -0.052_904_07, -0.052_978_86),
    Vec3::new(-0.098_017_25, 1.151_860_5, -0.098_039_82),
    Vec3::new(-0.099_025_01, -0.098_956_45, 1.151_018_7),
);

/// Sobotka, AgX, with its own sigmoid rather than a polynomial fit of it. Domain: x >= 0.
///
/// The curve gives code values for a screen of exponent 2.2; they are turned into light here.
fn tone_agx(x: Vec3) -> Vec3 {
    let inset = AGX_INSET * x;
    let curve = Vec3::new(agx_curve(inset.x), agx_curve(inset.y), agx_curve(inset.z));
    (AGX_OUTSET * curve).clamp(Vec3::ZERO, Vec3::ONE).powf(2.2)
}

/// Sigmoid over log2 of light, slope 2 through (pivot, 1/2): `1/2 + 2d (1 + s |d|^p)^(-1/p)`, d the distance to the
/// pivot.
fn agx_curve(x: f32) -> f32 {
    let (low, high) = AGX_STOPS;
    let stops = x.max(1e-10).log2() - AGX_LOG2_GREY;
    let d = ((stops - low) / (high - low)).clamp(0.0, 1.0) - AGX_PIVOT;
    let (scale, power) = if d < 0.0 { (AGX_TOE, 3.0) } else { (AGX_SHOULDER, 3.25) };
    0.5 + 2.0 * d * (1.0 + scale * d.abs().powf(power)).powf(-1.0 / power)
}

/// Rec.709 to the fit's space, with the saturation step of the reference rendering transform.
const ACES_INPUT: Mat3 = Mat3::from_cols(
    Vec3::new(0.597_19, 0.076, 0.028_4),
    Vec3::new(0.354_58, 0.908_34, 0.133_83),
    Vec3::new(0.048_23, 0.015_66, 0.837_77),
);
/// Back, with the saturation step of the output transform.
const ACES_OUTPUT: Mat3 = Mat3::from_cols(
    Vec3::new(1.604_75, -0.102_08, -0.003_27),
    Vec3::new(-0.531_08, 1.108_13, -0.072_76),
    Vec3::new(-0.073_67, -0.006_05, 1.076_02),
);

/// Hill (BakingLab), a fit of the ACES 1.0 reference rendering and sRGB output transforms. Domain: x >= 0.
///
/// As published, without the factor 1/0.6 that some programs put before it: middle grey 0.18 becomes 0.106.
fn tone_aces(x: Vec3) -> Vec3 {
    let v = ACES_INPUT * x;
    let fit = (v * (v + 0.024_578_6) - 0.000_090_537) / (v * (0.983_729 * v + 0.432_951) + 0.238_081);
    ACES_OUTPUT * fit
}

#[cfg(test)]
#[path = "tone_tests.rs"]
mod tests;
