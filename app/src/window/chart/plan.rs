//! What is to be measured, as it is typed: methods, the values that their settings take, paths of the reference.

use burnish_core::lighting::method::{self, Method, MethodInfo, Sweep};
use burnish_core::measure::bench::Candidate;
use burnish_core::param::{self, ParamKind, Settings};
use glam::UVec2;

/// Paths through a pixel of the reference at first: less than on the command line, somebody waits.
const SAMPLES: u32 = 256;
/// Pixels of the pictures at first, those of the command line.
const SIZE: UVec2 = UVec2::new(320, 180);

/// The choices of the panel.
#[derive(Debug)]
pub struct Plan {
    /// All methods that there are.
    pub methods: Vec<Chosen>,
    /// Paths through a pixel of the reference.
    pub samples: u32,
    /// Pixels of the pictures.
    pub size: UVec2,
    /// Nothing that was kept is read.
    pub fresh: bool,
}

/// A method with the settings that vary.
#[derive(Debug)]
pub struct Chosen {
    method: &'static dyn Method,
    /// It is measured.
    pub on: bool,
    /// Sweeps as they are typed, `samples=0,4,16`; an empty one counts for nothing.
    pub sweeps: Vec<String>,
}

impl Plan {
    /// All methods of a list, with more and more samples where they take any.
    pub fn new(methods: &[&'static dyn Method]) -> Plan {
        let chosen = |method: &&'static dyn Method| Chosen {
            method: *method,
            on: true,
            sweeps: vec![first_sweep(method.info())],
        };
        Plan { methods: methods.iter().map(chosen).collect(), samples: SAMPLES, size: SIZE, fresh: false }
    }

    /// What is measured; `None` where something typed is wrong or nothing is chosen.
    pub fn candidates(&self) -> Option<Vec<Candidate>> {
        let mut list = Vec::new();
        for chosen in self.methods.iter().filter(|chosen| chosen.on) {
            let all = chosen.settings().ok()?;
            list.extend(all.into_iter().map(|settings| Candidate { method: chosen.info().id, settings }));
        }
        Some(list).filter(|list| !list.is_empty())
    }
}

/// A sweep that says something about a method before anyone has typed.
fn first_sweep(info: &MethodInfo) -> String {
    match param::find(info.params, "samples").map(|spec| spec.kind) {
        Ok(ParamKind::Integer { min: 0, .. }) => "samples=0,4,16,64,256".into(),
        Ok(ParamKind::Integer { .. }) => "samples=1,4,16".into(),
        _ => String::new(),
    }
}

impl Chosen {
    /// What there is to know about the method.
    pub fn info(&self) -> &'static MethodInfo {
        self.method.info()
    }

    /// What is wrong with a sweep, in words.
    pub fn fault(&self, index: usize) -> Option<String> {
        let sweep = match self.sweep(self.sweeps.get(index)?) {
            Ok(sweep) => sweep?,
            Err(fault) => return Some(fault),
        };
        let before = self.sweeps.iter().take(index).filter_map(|text| self.sweep(text).ok().flatten());
        if before.into_iter().any(|other| other.key == sweep.key) {
            return Some(format!("`{}` varies already", sweep.key));
        }
        method::combinations(self.method, &[sweep]).err().map(|error| error.to_string())
    }

    /// All combinations of the values, or what is wrong.
    pub fn settings(&self) -> Result<Vec<Settings>, String> {
        if let Some(fault) = (0..self.sweeps.len()).find_map(|index| self.fault(index)) {
            return Err(fault);
        }
        let sweeps: Result<Vec<Option<Sweep>>, String> = self.sweeps.iter().map(|text| self.sweep(text)).collect();
        let sweeps: Vec<Sweep> = sweeps?.into_iter().flatten().collect();
        method::combinations(self.method, &sweeps).map_err(|error| error.to_string())
    }

    /// A sweep of this method; `None` for an empty text.
    fn sweep(&self, text: &str) -> Result<Option<Sweep>, String> {
        if text.trim().is_empty() {
            return Ok(None);
        }
        let sweep: Sweep = text.trim().parse().map_err(|error: method::SweepError| error.to_string())?;
        let id = self.info().id;
        match &sweep.method {
            Some(other) if other != id.0 => Err(format!("this field is for `{id}`, not for `{other}`")),
            _ => Ok(Some(Sweep { method: Some(id.0.into()), ..sweep })),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use burnish_core::lighting::METHODS;

    #[test]
    fn the_first_plan_measures_every_method_with_few_and_many_samples() {
        let plan = Plan::new(METHODS);
        assert_eq!(plan.methods.len(), METHODS.len());
        let labels: Vec<String> = plan.candidates().unwrap().iter().map(Candidate::label).collect();
        assert!(labels.contains(&"classical samples=4".into()) && labels.contains(&"reference samples=16".into()));
        // Few and many for each: 5 of those that sample lobes, 3 of paths; one of those without samples.
        assert_eq!(labels.len(), 15);
    }

    #[test]
    fn sweeps_multiply_and_empty_ones_and_methods_that_are_off_count_for_nothing() {
        let mut plan = Plan::new(METHODS);
        for other in &mut plan.methods[1..] {
            other.on = false;
            other.sweeps = vec!["nonsense".into()];
        }
        plan.methods[0].sweeps =
            vec!["classical.samples=0, 4".into(), " ".into(), "masking=correlated,separable".into()];
        assert_eq!(plan.candidates().unwrap().len(), 4);
        plan.methods[0].on = false;
        assert!(plan.candidates().is_none());
    }

    #[test]
    fn what_is_wrong_is_told_at_its_field() {
        let mut plan = Plan::new(METHODS);
        let mut fault = |texts: &[&str]| {
            plan.methods[0].sweeps = texts.iter().map(ToString::to_string).collect();
            let last = plan.methods[0].fault(texts.len() - 1).unwrap_or_default();
            assert!(plan.candidates().is_none(), "{texts:?}");
            last
        };
        assert!(fault(&["samples"]).contains("[METHOD.]key"));
        assert!(fault(&["samples=0,2000"]).contains("0 to 1024"));
        assert!(fault(&["smples=1"]).contains("samples"));
        assert!(fault(&["reference.samples=1"]).contains("`classical`"));
        assert!(fault(&["samples=1", "samples=2"]).contains("already"));
    }
}
