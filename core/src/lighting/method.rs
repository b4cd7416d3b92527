//! What a lighting method is to those who list, choose, run and compare methods.
//!
//! Callers take the list of methods as an argument, [`super::METHODS`] in the program: a test can append another.

use std::borrow::Cow;
use std::fmt;

use glam::Vec3;

use super::prepared::{Prepared, Reads};
use crate::job::Handle;
use crate::param::{ParamError, ParamSpec, Settings};
use crate::reference::{self, SurfacePoint, World};
use crate::scene::Scene;

/// Name of a method in documents, on the command line and in tables, lower case with hyphens.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MethodId(pub &'static str);

impl fmt::Display for MethodId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0)
    }
}

/// What fills in a term that is left out of the picture.
const NOTHING: &str = "nothing";

/// How well a method does a term of the light that leaves a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cover {
    /// Right but for noise or rounding.
    Exact,
    /// With an error that its page describes.
    Approximate,
    /// Not at all: the frame fills it, see [`Coverage::fills`].
    None,
}

impl Cover {
    /// For people and tables.
    pub fn word(self) -> &'static str {
        match self {
            Cover::Exact => "exact",
            Cover::Approximate => "approximate",
            Cover::None => "none",
        }
    }

    /// The same with what takes the place of what is not done.
    pub fn words(self, filled_by: &str) -> String {
        match self {
            Cover::None if filled_by == NOTHING => "left out".into(),
            Cover::None => format!("filled by {filled_by}"),
            covered => covered.word().into(),
        }
    }
}

/// What a method does of each term.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Coverage {
    /// Direct light of lamps.
    pub lamps: Cover,
    /// Direct light of the environment.
    pub environment: Cover,
    /// Light that comes over other surfaces and leaves diffusely.
    pub indirect_diffuse: Cover,
    /// Light that comes over other surfaces and leaves by a glossy lobe.
    pub indirect_glossy: Cover,
    /// Light that a surface emits.
    pub emission: Cover,
}

impl Coverage {
    /// All is left to the frame.
    pub const NONE: Coverage = Coverage {
        lamps: Cover::None,
        environment: Cover::None,
        indirect_diffuse: Cover::None,
        indirect_glossy: Cover::None,
        emission: Cover::None,
    };

    /// Every term with its name and what takes its place where the method does not do it.
    pub fn terms(&self) -> [(&'static str, Cover, &'static str); 5] {
        [
            ("lamps", self.lamps, "lamps with shadows"),
            ("environment", self.environment, "the environment without shadows"),
            ("indirect diffuse", self.indirect_diffuse, NOTHING),
            ("indirect glossy", self.indirect_glossy, NOTHING),
            ("emission", self.emission, "the surface's own"),
        ]
    }

    /// What the frame fills, in words: `indirect glossy: nothing`.
    pub fn fills(&self) -> Vec<String> {
        let missing = self.terms().into_iter().filter(|(_, cover, _)| *cover == Cover::None);
        missing.map(|(term, _, filled_by)| format!("{term}: {filled_by}")).collect()
    }
}

/// What there is to know about a method without running it.
#[derive(Debug)]
pub struct MethodInfo {
    /// Its name for machines.
    pub id: MethodId,
    /// Its name for people.
    pub title: &'static str,
    /// One line on what it does.
    pub summary: &'static str,
    /// Its settings; all have defaults.
    pub params: &'static [ParamSpec],
    /// What it does of each term.
    pub coverage: Coverage,
    /// Parts of the scene that its preparation depends on: an edit of another leaves it fresh.
    pub reads: Reads,
    /// Raised when the same inputs give another preparation than before.
    pub revision: u32,
}

/// A way to compute the light that a surface reflects.
///
/// What takes longer than a frame is done by [`Method::prepare`], once for what it reads; its result is plain numbers, so
/// that it is kept on disk and handed to a graphics device. Who draws on the processor has a [`ShadePoint`]; a pass on
/// the device is found by the id in the renderer.
pub trait Method: Sync {
    /// What there is to know about it.
    fn info(&self) -> &'static MethodInfo;

    /// Computes what frames look up. The same inputs give the same numbers on any number of threads. Long work asks the
    /// job whether it is cancelled at least every 0.1 s, and then ends with [`MethodError::Cancelled`].
    fn prepare(&self, _world: &World, _settings: &Settings, _job: &Handle) -> Result<Prepared, MethodError> {
        Ok(Prepared::nothing())
    }

    /// There is something to show before the whole is prepared, see [`Method::draft`].
    fn drafts(&self) -> bool {
        false
    }

    /// A coarse stand-in for what [`Method::prepare`] makes, in a part of a second: shown while something is dragged, until the whole
    /// is there.
    fn draft(&self, world: &World, settings: &Settings, job: &Handle) -> Result<Prepared, MethodError> {
        self.prepare(world, settings, job)
    }

    /// Parts of a scene whose edits leave what was prepared in use until another is there: what is edited is lit rightly at once, and only what
    /// it sends to others is old. Edits of other parts begin with a [draft](Method::draft), where there are drafts.
    fn outlives(&self) -> Reads {
        Reads::NOTHING
    }

    /// How wrong what was prepared of a scene is for another that it [outlives](Method::outlives): root mean square of what changes of the light
    /// that arrives at surfaces, over that of all of it. In a part of a second; `None` where nobody can tell.
    fn age(&self, _then: &World, _now: &World, _settings: &Settings) -> Option<f32> {
        None
    }

    /// Where what was prepared fails for a scene, for people: each with what helps.
    fn warnings(&self, _scene: &Scene, _prepared: &Prepared, _settings: &Settings) -> Vec<String> {
        Vec::new()
    }

    /// The scene as [`Method::prepare`] sees it: what is left out here can be edited without another preparation.
    fn seen<'a>(&self, scene: &'a Scene, _settings: &Settings) -> Cow<'a, Scene> {
        Cow::Borrowed(scene)
    }

    /// How it draws on the processor; `None` for those that have another way to do so, or none.
    fn points(&self) -> Option<&dyn ShadePoint> {
        None
    }
}

/// What a method does at one point of a surface, on the processor.
pub trait ShadePoint: Sync {
    /// Scene-linear radiance that the surface sends toward the viewer over the terms that the method covers; the frame
    /// adds what it does not, see [`Coverage::fills`]. Out of its domain a method gives something finite.
    ///
    /// `random` are four even numbers in `[0, 1)`, well spread over the samples of a pixel. Numbers that are not finite
    /// are counted and left out of the picture.
    fn radiance(&self, point: &SurfacePoint<'_>, prepared: &Prepared, settings: &Settings, random: [f32; 4]) -> Vec3;
}

/// Why a method cannot prepare a scene.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MethodError {
    /// The scene has not what the method needs, or too much of it.
    #[error("{0}")]
    Unfit(String),
    /// The user ended it.
    #[error("cancelled")]
    Cancelled,
}

impl dyn Method + '_ {
    /// The processor draws it: point by point, or path by path.
    pub fn is_on_processor(&self) -> bool {
        self.points().is_some() || self.info().id.0 == reference::ID
    }
}

impl fmt::Debug for dyn Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Method({})", self.info().id)
    }
}

/// Methods to choose from.
pub type Methods<'a> = &'a [&'a dyn Method];

/// No method of that name.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("no method `{id}`; there are: {known}")]
pub struct UnknownMethod {
    /// What was asked for.
    pub id: String,
    /// All names.
    pub known: String,
}

/// Finds a method by its name.
pub fn find<'a>(methods: &[&'a dyn Method], id: &str) -> Result<&'a dyn Method, UnknownMethod> {
    let known = || methods.iter().map(|method| method.info().id.0).collect::<Vec<_>>().join(", ");
    let found = methods.iter().find(|method| method.info().id.0 == id).copied();
    found.ok_or_else(|| UnknownMethod { id: id.into(), known: known() })
}

/// A setting and the values that it is to take: `[METHOD.]key=a,b,c`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sweep {
    /// Only for this method; for all that have the setting when absent.
    pub method: Option<String>,
    /// The setting.
    pub key: String,
    /// Its values as text, in order, at least one.
    pub values: Vec<String>,
}

/// Why sweeps cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SweepError {
    /// Not of the form.
    #[error("`{0}` is not [METHOD.]key=a,b,c")]
    Malformed(String),
    /// No chosen method of that name.
    #[error("{0}; name it in --methods")]
    Method(#[from] UnknownMethod),
    /// None of the methods has such a setting, or a value is refused.
    #[error("{sweep}: {error}")]
    Param {
        /// The sweep's setting.
        sweep: String,
        /// What is wrong with it.
        error: ParamError,
    },
    /// Too many combinations.
    #[error("{0} combinations of settings for method {1}; at most {MOST} can be measured in one run")]
    TooMany(usize, MethodId),
}

/// Most combinations of one method.
const MOST: usize = 1024;

impl std::str::FromStr for Sweep {
    type Err = SweepError;

    fn from_str(text: &str) -> Result<Sweep, SweepError> {
        let malformed = || SweepError::Malformed(text.into());
        let (name, values) = text.split_once('=').ok_or_else(malformed)?;
        let (method, key) = match name.split_once('.') {
            Some((method, key)) => (Some(method.to_string()), key),
            None => (None, name),
        };
        let values: Vec<String> = values.split(',').map(|value| value.trim().to_string()).collect();
        if key.is_empty() || values.iter().any(String::is_empty) {
            return Err(malformed());
        }
        Ok(Sweep { method, key: key.into(), values })
    }
}

/// Every combination of the values of the sweeps that are for a method, in their order, the last setting changing
/// fastest; one of defaults where none is for it.
pub fn combinations(method: &dyn Method, sweeps: &[Sweep]) -> Result<Vec<Settings>, SweepError> {
    let MethodInfo { id, params, .. } = method.info();
    let mut list = vec![Settings::new(params)];
    for sweep in sweeps {
        let concerns = match &sweep.method {
            Some(name) => name == id.0,
            None => params.iter().any(|spec| spec.key == sweep.key),
        };
        if !concerns {
            continue;
        }
        if list.len() * sweep.values.len() > MOST {
            return Err(SweepError::TooMany(list.len() * sweep.values.len(), *id));
        }
        let mut next = Vec::new();
        for settings in &list {
            for value in &sweep.values {
                let mut settings = settings.clone();
                let failure = |error| SweepError::Param { sweep: format!("{id}.{}={value}", sweep.key), error };
                settings.set(&sweep.key, value).map_err(failure)?;
                next.push(settings);
            }
        }
        list = next;
    }
    Ok(list)
}

/// Refuses sweeps that no method takes.
pub fn check_sweeps(methods: &[&dyn Method], sweeps: &[Sweep]) -> Result<(), SweepError> {
    for sweep in sweeps {
        if let Some(name) = &sweep.method {
            find(methods, name)?;
        } else if !methods.iter().any(|m| m.info().params.iter().any(|spec| spec.key == sweep.key)) {
            let keys = methods.iter().flat_map(|m| m.info().params.iter().map(|spec| spec.key));
            let mut known: Vec<&str> = keys.collect();
            known.sort_unstable();
            known.dedup();
            let error = ParamError::Unknown { key: sweep.key.clone(), known: known.join(", ") };
            return Err(SweepError::Param { sweep: sweep.key.clone(), error });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::METHODS;
    use super::*;

    #[test]
    fn methods_are_found_by_name_and_unknown_ones_told_what_there_is() {
        assert_eq!(find(METHODS, "classical").unwrap().info().title, "Classical");
        let error = find(METHODS, "radiosity").unwrap_err().to_string();
        assert!(
            error.contains("radiosity") && error.contains("classical, impostor, area-cube, radiance-map, reference"),
            "{error}"
        );
        let mut ids: Vec<MethodId> = METHODS.iter().map(|m| m.info().id).collect();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), METHODS.len());
    }

    #[test]
    fn sweeps_multiply_and_keep_to_their_method() {
        let sweeps: Vec<Sweep> = ["classical.samples=0,16", "masking=correlated,separable", "reference.bounces=1,2,3"]
            .map(|text| text.parse().unwrap())
            .into();
        let of = |id: &str| combinations(find(METHODS, id).unwrap(), &sweeps).unwrap();
        let texts = |id: &str, key: &str| of(id).iter().map(|s| s.text(key).unwrap()).collect::<Vec<_>>();
        assert_eq!(texts("classical", "samples"), ["0", "0", "16", "16"]);
        assert_eq!(texts("classical", "masking"), ["correlated", "separable", "correlated", "separable"]);
        assert_eq!(texts("reference", "bounces"), ["1", "2", "3", "1", "2", "3"]);
        assert_eq!(combinations(METHODS[0], &[]).unwrap(), [Settings::new(METHODS[0].info().params)]);
    }

    #[test]
    fn what_no_method_takes_is_refused_in_words() {
        let check = |text: &str| check_sweeps(METHODS, &[text.parse().unwrap()]).unwrap_err().to_string();
        assert!(check("bouncs=1").contains("bounces"));
        assert!(check("radiosity.samples=1").contains("--methods"));
        for text in ["samples", "samples=", "=1", "samples=1,,2", "classical.=1"] {
            assert!(text.parse::<Sweep>().unwrap_err().to_string().contains("[METHOD.]key"), "{text}");
        }
        let sweep: Sweep = "classical.samples=2000".parse().unwrap();
        let error = combinations(METHODS[0], &[sweep]).unwrap_err().to_string();
        assert!(error.contains("classical.samples=2000") && error.contains("1024"), "{error}");
    }

    #[test]
    fn what_is_not_covered_is_told_with_what_takes_its_place() {
        let coverage = find(METHODS, "classical").unwrap().info().coverage;
        assert!(coverage.fills().contains(&"indirect glossy: nothing".to_string()));
        assert!(find(METHODS, "reference").unwrap().info().coverage.fills().is_empty());
    }
}
