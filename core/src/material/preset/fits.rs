//! The numbers of every run-time form for a metal, with their errors, and the cheapest form that is good enough.

use std::collections::BTreeMap;

use glam::{DVec3, Vec3};
use serde::{Deserialize, Deserializer, Serialize};

use super::{Preset, clamped};
use crate::color::difference::ciede2000;
use crate::color::lab::lab_from_rgb;
use crate::surface::fresnel::fit::{self, F0_MAX, NODES, Target, node};
use crate::surface::fresnel::{Form, Fresnel, TABLE_SIZE, UnknownForm, exponents, grazing_slope, gulbrandsen};

/// Wavelengths whose n and k stand for red, green and blue in [`Form::SampledNk`], nm.
pub const SAMPLED_NM: [f64; 3] = [610.0, 550.0, 465.0];

/// Counts up when fits of the same table come out differently.
const REVISION: u32 = 1;

/// How large errors may be for a form to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Largest relative error over red, green, blue and all angles.
    pub relative: f64,
    /// Largest CIEDE2000 on a ball.
    pub delta_e: f64,
}

impl Default for Tolerance {
    /// 1 %, and a difference of 1, which is about to be seen.
    fn default() -> Tolerance {
        Tolerance { relative: 0.01, delta_e: 1.0 }
    }
}

impl Tolerance {
    /// True for a form that errs by no more.
    pub fn allows(self, fit: &Fit) -> bool {
        fit.relative <= self.relative && fit.delta_e <= self.delta_e
    }
}

/// A form of a metal: its numbers and how far it is from the truth.
///
/// Errors are those of what is rendered, both sides within [0, 1]: reflectance under D65 as linear Rec.709 at
/// [`NODES`] cosines. The ball is a mirror in even white light, seen from afar: its centre shows normal incidence, its
/// rim grazing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    /// Red, green and blue of each number of the form, by the symbol of `core/src/surface/fresnel/README.md`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub parameters: BTreeMap<String, [f64; 3]>,
    /// Largest relative error of the curve before it is clamped: what was made least.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fit_error: Option<[f64; 3]>,
    /// Largest relative error over red, green, blue and angle.
    pub relative: f64,
    /// Largest absolute error over red, green, blue and angle.
    pub absolute: f64,
    /// Largest CIEDE2000 on the ball.
    pub delta_e: f64,
    /// Mean CIEDE2000 over the ball's disc.
    pub delta_e_mean: f64,
    /// Where the form does not hold for a channel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
}

/// Which form of a metal is rendered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FormChoice {
    /// The cheapest within a tolerance.
    Cheapest(Tolerance),
    /// This one.
    Of(Form),
}

impl FormChoice {
    /// Name of [`FormChoice::Cheapest`] in files, settings and on the command line.
    pub const CHEAPEST: &'static str = "cheapest";

    /// What can be chosen: `cheapest` and the id of every form.
    pub const IDS: [&'static str; Form::ALL.len() + 1] = {
        let mut ids = [FormChoice::CHEAPEST; Form::ALL.len() + 1];
        let mut i = 0;
        while i < Form::ALL.len() {
            ids[i + 1] = Form::ALL[i].id();
            i += 1;
        }
        ids
    };

    /// Reads a name; `cheapest` takes the tolerance.
    pub fn read(text: &str, tolerance: Tolerance) -> Result<FormChoice, UnknownForm> {
        if text == FormChoice::CHEAPEST {
            return Ok(FormChoice::Cheapest(tolerance));
        }
        text.parse().map(FormChoice::Of)
    }

    /// The form of a metal.
    pub fn form(self, metal: &Preset) -> Form {
        match self {
            FormChoice::Of(form) => form,
            FormChoice::Cheapest(tolerance) => metal.fits().cheapest(tolerance).form,
        }
    }
}

/// The cheapest form within a tolerance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cheapest {
    /// The form.
    pub form: Form,
    /// Its errors, and those of the best cheaper form, which does not do.
    pub reason: String,
}

/// Every form of a metal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fits {
    /// Fingerprint of the table that was fitted.
    pub of: String,
    /// Reflectance at normal incidence, linear Rec.709, not clamped.
    pub f0: [f64; 3],
    /// Of each form.
    pub forms: BTreeMap<Form, Fit>,
    /// Within the default [`Tolerance`].
    pub cheapest: Cheapest,
}

impl Fits {
    /// Fits every form. Takes a tenth of a second.
    pub fn new(preset: &Preset) -> Fits {
        let fitter = Fitter::new(preset);
        let forms: BTreeMap<Form, Fit> = Form::ALL.into_iter().map(|form| (form, fitter.fit(form))).collect();
        let cheapest = cheapest(&forms, Tolerance::default());
        Fits { of: fingerprint(preset), f0: fitter.f0.to_array().map(|v| rounded(v, 9)), forms, cheapest }
    }

    /// True if these were made of the preset's table by this version.
    pub fn belong_to(&self, preset: &Preset) -> bool {
        self.of == fingerprint(preset) && Form::ALL.iter().all(|form| self.forms.contains_key(form))
    }

    /// The cheapest form within a tolerance: the first of [`Form::ALL`], the spectral table if no other.
    pub fn cheapest(&self, tolerance: Tolerance) -> Cheapest {
        cheapest(&self.forms, tolerance)
    }
}

/// Stored fits; what cannot be read is left out, for they can be made again.
pub(super) fn lenient<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Fits>, D::Error> {
    let value = serde_json::Value::deserialize(deserializer)?;
    Ok(serde_json::from_value(value).ok())
}

fn cheapest(forms: &BTreeMap<Form, Fit>, tolerance: Tolerance) -> Cheapest {
    let percent = |fit: &Fit| format!("{:.2} %", 100.0 * fit.relative);
    let found = forms.iter().find(|(form, fit)| tolerance.allows(fit) || **form == Form::Spectral);
    let Some((&form, fit)) = found else {
        return Cheapest { form: Form::Spectral, reason: "no form was fitted".into() };
    };
    let mut reason = format!("{form} errs by {} at most, ΔE2000 {:.2}", percent(fit), fit.delta_e);
    // The best of the cheaper ones tells most.
    let cheaper = forms.range(..form).min_by(|a, b| a.1.relative.total_cmp(&b.1.relative));
    if let Some((other, fit)) = cheaper {
        reason += &format!("; the best cheaper form, {other}, by {}, ΔE2000 {:.2}", percent(fit), fit.delta_e);
    }
    Cheapest { form, reason }
}

/// What fits of one metal share.
struct Fitter<'a> {
    preset: &'a Preset,
    f0: DVec3,
    targets: [Target; 3],
    /// As rendered, at the nodes.
    truth: Vec<Vec3>,
    /// L*a*b* of it.
    lab: Vec<DVec3>,
}

type Parameters = Vec<(String, [f64; 3])>;

impl<'a> Fitter<'a> {
    fn new(preset: &'a Preset) -> Fitter<'a> {
        let curve: Vec<DVec3> = (0..NODES).map(|i| preset.unclamped(node(i))).collect();
        let slope = crate::color::rgb::integrate(|nm| {
            let (n, k) = preset.index_at(nm);
            grazing_slope(n, k)
        });
        let (at_recipe, at_f82) = (preset.unclamped(fit::RECIPE_COSINE), preset.unclamped(fit::F82_COSINE));
        let target = |c: usize| Target {
            values: curve.iter().map(|f| f[c]).collect(),
            slope: slope[c],
            at_recipe: at_recipe[c],
            at_f82: at_f82[c],
        };
        let truth: Vec<Vec3> = curve.iter().map(|f| clamped(*f)).collect();
        let lab = truth.iter().map(|f| lab_from_rgb(f.as_dvec3())).collect();
        let f0 = curve.last().copied().unwrap_or(DVec3::ONE);
        Fitter { preset, f0, targets: [0, 1, 2].map(target), truth, lab }
    }

    /// A form with its errors.
    fn fit(&self, form: Form) -> Fit {
        let (parameters, note) = self.parameters(form);
        let parameters: BTreeMap<String, [f64; 3]> =
            parameters.into_iter().map(|(name, values)| (name, values.map(|v| rounded(v, 9)))).collect();
        let fresnel = self.fresnel(form, &parameters);
        let errors: Vec<[f64; 3]> = (self.truth.iter().zip(&self.lab).enumerate())
            .map(|(i, (truth, lab))| {
                let value = fresnel.eval(node(i) as f32);
                let error = (value - *truth).abs();
                let relative = error / truth.max(Vec3::splat(fit::LEAST as f32));
                let difference = ciede2000(lab_from_rgb(value.as_dvec3()), *lab);
                [f64::from(relative.max_element()), error.max_element().into(), difference]
            })
            .collect();
        let [relative, absolute, delta_e] = [0, 1, 2].map(|kind| fit::largest(errors.iter().map(|e| e[kind])));
        // Of the disc 2 x dx, where dx goes with the root of x on these nodes.
        let weights = (0..NODES).map(|i| node(i).powf(1.5));
        let delta_e_mean =
            errors.iter().zip(weights.clone()).map(|(e, w)| w * e[2]).sum::<f64>() / weights.sum::<f64>();
        let [relative, absolute, delta_e, delta_e_mean] =
            [relative, absolute, delta_e, delta_e_mean].map(|v| rounded(v, 5));
        Fit {
            fit_error: self.fit_error(form, &parameters),
            parameters,
            relative,
            absolute,
            delta_e,
            delta_e_mean,
            note,
        }
    }

    /// The numbers of a form, and where it does not hold.
    fn parameters(&self, form: Form) -> (Parameters, Option<String>) {
        let all = |f: &dyn Fn(&Target) -> f64| [f(&self.targets[0]), f(&self.targets[1]), f(&self.targets[2])];
        let pair = |names: [&str; 2], f: &dyn Fn(&Target) -> (f64, f64)| {
            let values = self.targets.each_ref().map(f);
            vec![(names[0].to_string(), values.map(|v| v.0)), (names[1].to_string(), values.map(|v| v.1))]
        };
        let unreachable = || {
            let above = self.channels(|target| target.f0() >= F0_MAX);
            (!above.is_empty()).then(|| format!("F0 of {above} is {F0_MAX} or more: no index reaches it"))
        };
        match form {
            Form::Spectral => (Vec::new(), None),
            Form::Rescaled => (vec![("f0".into(), self.f0.to_array())], None),
            Form::Schlick => (vec![("f0".into(), self.preset.schlick_f0().to_array())], None),
            Form::F82 => (pair(["b", "t"], &fit::f82), None),
            Form::F82Fitted => (pair(["b", "t"], &fit::f82_fitted), None),
            Form::Series2 => (self.series::<2>(), None),
            Form::Series3 => (self.series::<3>(), None),
            Form::Series4 => (self.series::<4>(), None),
            Form::Fitted => (pair(["a", "alpha"], &|target| dip(fit::fitted(target))), None),
            Form::Recipe => {
                let without = self.channels(|target| fit::recipe(target).is_none());
                let note = format!("not valid for {without}: without a dip there");
                let valid = |target: &Target| dip(fit::recipe(target).unwrap_or(fit::Dip::NONE));
                (pair(["a", "alpha"], &valid), Some(note).filter(|_| !without.is_empty()))
            }
            Form::EffectiveNk => (pair(["n", "k"], &fit::effective), unreachable()),
            Form::SampledNk => {
                let values = SAMPLED_NM.map(|nm| self.preset.index_at(nm));
                (vec![("n".into(), values.map(|v| v.0)), ("k".into(), values.map(|v| v.1))], None)
            }
            Form::Gulbrandsen => {
                let r = all(&|target| target.f0().clamp(0.0, F0_MAX));
                (vec![("r".into(), r), ("g".into(), all(&fit::tint))], unreachable())
            }
        }
    }

    fn series<const TERMS: usize>(&self) -> Parameters {
        let values = self.targets.each_ref().map(fit::series::<TERMS>);
        let name = |(i, e): (usize, &u32)| (format!("c{e}"), values.map(|v| v[i]));
        exponents(TERMS).iter().enumerate().map(name).collect()
    }

    /// Letters of the channels for which something holds.
    fn channels(&self, holds: impl Fn(&Target) -> bool) -> String {
        let held: Vec<&str> =
            ["R", "G", "B"].into_iter().zip(&self.targets).filter(|(_, t)| holds(t)).map(|p| p.0).collect();
        held.join(", ")
    }

    fn fresnel(&self, form: Form, parameters: &BTreeMap<String, [f64; 3]>) -> Fresnel {
        curve(form, self.f0, parameters).unwrap_or_else(|| table(self.preset))
    }

    /// Largest relative error of each channel before anything is clamped, for the forms with a dip.
    fn fit_error(&self, form: Form, parameters: &BTreeMap<String, [f64; 3]>) -> Option<[f64; 3]> {
        let term = |name: &str, c: usize| parameters.get(name).map_or(0.0, |values| values[c]);
        let dip = |c: usize, x: f64| {
            let y = 1.0 - x;
            let series = |terms: usize| {
                x * exponents(terms).iter().map(|&e| term(&format!("c{e}"), c) * y.powi(e as i32)).sum::<f64>()
            };
            match form {
                Form::Rescaled => Some(0.0),
                Form::Fitted | Form::Recipe => Some(fit::Dip { a: term("a", c), alpha: term("alpha", c) }.at(x)),
                Form::F82 | Form::F82Fitted => Some(term("b", c) * x * y.powi(6)),
                Form::Series2 => Some(series(2)),
                Form::Series3 => Some(series(3)),
                Form::Series4 => Some(series(4)),
                _ => None,
            }
        };
        dip(0, 0.5)?;
        let error = |c: usize| {
            let target = &self.targets[c];
            target.relative_error(|x| target.rescaled(x) - dip(c, x).unwrap_or(0.0))
        };
        Some([0, 1, 2].map(|c| rounded(error(c), 5)))
    }
}

fn dip(dip: fit::Dip) -> (f64, f64) {
    (dip.a, dip.alpha)
}

/// The curve of a form, made from the table alone.
pub(super) fn made(preset: &Preset, form: Form) -> Fresnel {
    match form {
        Form::Spectral => table(preset),
        _ => {
            let fitter = Fitter::new(preset);
            fitter.fresnel(form, &fitter.parameters(form).0.into_iter().collect())
        }
    }
}

/// The integrated curves.
fn table(preset: &Preset) -> Fresnel {
    let entry = |i: usize| clamped(preset.unclamped(i as f64 / (TABLE_SIZE - 1) as f64));
    Fresnel::Spectral { table: Box::new(std::array::from_fn(entry)) }
}

/// The curve of a form from its numbers; `None` for the table or where a number is missing or none.
pub(super) fn curve(form: Form, f0: DVec3, parameters: &BTreeMap<String, [f64; 3]>) -> Option<Fresnel> {
    let number = |name: &str| {
        let value = DVec3::from_array(*parameters.get(name)?).as_vec3();
        value.is_finite().then_some(value)
    };
    let f0 = Some(f0.as_vec3()).filter(|f0| f0.is_finite())?;
    Some(match form {
        Form::Spectral => return None,
        Form::Rescaled => Fresnel::Rescaled { f0: number("f0")?.clamp(Vec3::ZERO, Vec3::ONE) },
        Form::Schlick => Fresnel::Schlick { f0: number("f0")?.clamp(Vec3::ZERO, Vec3::ONE) },
        Form::F82 | Form::F82Fitted => Fresnel::F82 { f0, b: number("b")? },
        Form::Series2 => Fresnel::Series2 { f0, c: [number("c3")?, number("c8")?] },
        Form::Series3 => Fresnel::Series3 { f0, c: [number("c2")?, number("c6")?, number("c12")?] },
        Form::Series4 => Fresnel::Series4 { f0, c: [number("c2")?, number("c4")?, number("c8")?, number("c16")?] },
        Form::Fitted | Form::Recipe => {
            let alpha = number("alpha").filter(|alpha| alpha.min_element() > 0.0)?;
            Fresnel::Compensated { f0, a: number("a")?, alpha }
        }
        Form::EffectiveNk | Form::SampledNk => Fresnel::Conductor { n: number("n")?, k: number("k")? },
        Form::Gulbrandsen => {
            let (r, g) = (parameters.get("r")?, parameters.get("g")?);
            let index = [0, 1, 2].map(|c| gulbrandsen(r[c], g[c]));
            let part = |f: fn((f64, f64)) -> f64| Vec3::from_array(index.map(|v| f(v) as f32));
            Fresnel::Conductor { n: part(|v| v.0), k: part(|v| v.1) }
        }
    })
}

/// Names the table of a preset: FNV-1a over its numbers, with the revision of the fits.
fn fingerprint(preset: &Preset) -> String {
    let numbers = preset.wavelength_nm.iter().chain(&preset.n).chain(&preset.k);
    let step = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
    let hash = numbers.flat_map(|v| v.to_bits().to_le_bytes()).fold(0xcbf2_9ce4_8422_2325, step);
    format!("{REVISION}-{hash:016x}")
}

/// To some significant digits: the last bits differ between machines.
fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().unwrap_or(value)
}

#[cfg(test)]
#[path = "fits_tests.rs"]
mod tests;
