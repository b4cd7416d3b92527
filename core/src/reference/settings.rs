//! What the path tracer can be told.

use super::lights::Source;
use crate::lighting::classical;
use crate::material::preset::FormChoice;
use crate::param::{Affects, ParamKind, ParamSpec, ParamValue, Settings};
use crate::surface::fresnel::Form;
use crate::surface::ggx::Masking;

const BOUNCES: ParamSpec = ParamSpec {
    key: "bounces",
    label: "Bounces",
    unit: "",
    kind: ParamKind::Integer { min: 0, max: 1024, default: 64 },
    help: "Most surfaces that light touches on its way to the eye, 1 for direct light only; 0 shows what glows by itself.",
    affects: Affects::Frame,
};

const CLAMP: ParamSpec = ParamSpec {
    key: "clamp",
    label: "Clamp",
    unit: "nit",
    kind: ParamKind::Number { min: 0.0, max: 1e9, default: 0.0 },
    help: "Largest radiance that a path brings back after its first surface, 0 for no limit. A clamped picture is \
           not a reference; the light that was taken away is reported.",
    affects: Affects::Frame,
};

const FRESNEL: ParamSpec = ParamSpec {
    key: "fresnel",
    label: "Fresnel form",
    unit: "",
    kind: ParamKind::Choice { options: &FormChoice::IDS, default: SPECTRAL },
    help: "Form in which all metal presets are traced; spectral is the truth.",
    affects: Affects::Prepare,
};

const WAVELENGTHS: ParamSpec = ParamSpec {
    key: "spectral",
    label: "Wavelengths",
    unit: "",
    kind: ParamKind::Toggle { default: false },
    help: "Traces wavelengths instead of red, green and blue: metals by their n and k, colours as smooth spectra, \
           light as that of D65 times its colour. Noisier; what several bounces do to a spectrum is kept.",
    affects: Affects::Prepare,
};

/// Samples of every pixel: in a comparison the reference is a method among others, and these are its cost.
const SAMPLES: ParamSpec = ParamSpec {
    key: "samples",
    label: "Samples",
    unit: "per pixel",
    kind: ParamKind::Integer { min: 1, max: super::MAX_SAMPLES as i64, default: 64 },
    help: "Paths through a pixel.",
    affects: Affects::Frame,
};

/// Settings of this method.
pub const PARAMS: &[ParamSpec] =
    &[BOUNCES, CLAMP, classical::MASKING, classical::MULTIPLE_SCATTERING, FRESNEL, WAVELENGTHS];

/// The same with the number of samples, which elsewhere is a question of how long one waits.
pub const COMPARED_PARAMS: &[ParamSpec] =
    &[SAMPLES, BOUNCES, CLAMP, classical::MASKING, classical::MULTIPLE_SCATTERING, FRESNEL, WAVELENGTHS];

/// Place of `spectral` among [`FormChoice::IDS`].
const SPECTRAL: usize = {
    let mut i = 0;
    while !matches!(Form::ALL[i], Form::Spectral) {
        i += 1;
    }
    i + 1
};

/// The settings as a path reads them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Most surfaces on the way.
    pub bounces: u32,
    /// Largest radiance of indirect light; infinite for no limit.
    pub clamp: f32,
    /// Smith masking.
    pub masking: Masking,
    /// Light that bounces between microfacets.
    pub multiple_scattering: bool,
    /// Whose light the picture shows.
    pub contribution: Contribution,
}

/// The light that a picture shows. Paths are the same for each: pictures of one seed that show each source by itself add up
/// to the one that shows all, to rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Contribution {
    /// All of it.
    #[default]
    All,
    /// The environment's.
    Environment,
    /// That of materials that glow, unlit ones too.
    Emission,
    /// That of one light, an index into `Scene::lights`.
    Light(usize),
}

impl Contribution {
    /// Each source of a scene with `lights` lights.
    pub fn each(lights: usize) -> impl Iterator<Item = Contribution> {
        [Contribution::Environment, Contribution::Emission].into_iter().chain((0..lights).map(Contribution::Light))
    }

    /// True where a picture shows light from there.
    pub(super) fn shows(self, source: Source) -> bool {
        match self {
            Contribution::All => true,
            Contribution::Environment => source == Source::Environment,
            Contribution::Emission => source == Source::Emission,
            Contribution::Light(light) => source == Source::Lamp(light),
        }
    }

    /// A word for files.
    pub(super) fn word(self) -> String {
        match self {
            Contribution::All => "all".into(),
            Contribution::Environment => "environment".into(),
            Contribution::Emission => "emission".into(),
            Contribution::Light(light) => format!("light {light}"),
        }
    }
}

impl Default for Options {
    fn default() -> Options {
        Options::new(&Settings::new(PARAMS))
    }
}

/// True where settings made of [`PARAMS`] ask for wavelengths: see [`World::by_wavelength`](super::World::by_wavelength).
pub fn is_spectral(settings: &Settings) -> bool {
    settings.get("spectral") == Some(ParamValue::Toggle(true))
}

impl Options {
    /// Reads settings made of [`PARAMS`]; what is not there keeps its default.
    pub fn new(settings: &Settings) -> Options {
        let bounces = match settings.get("bounces") {
            Some(ParamValue::Integer(n)) => u32::try_from(n).unwrap_or(0),
            _ => 64,
        };
        let clamp = match settings.get("clamp") {
            Some(ParamValue::Number(v)) if v > 0.0 => v as f32,
            _ => f32::INFINITY,
        };
        let classical::FrameSettings { masking, multiple_scattering, .. } = classical::FrameSettings::new(settings);
        Options { bounces, clamp, masking, multiple_scattering, contribution: Contribution::All }
    }
}
