//! What the table and the report are made of: every form of every metal with its errors and its time.

use burnish_core::color::gamut::{Clip, clip};
use burnish_core::material::preset::{Cheapest, Fit, Preset, Tolerance};
use burnish_core::measure::evaluation_times;
use burnish_core::surface::fresnel::{Form, Fresnel};
use rayon::prelude::*;

/// Rounds of timing for a metal. Few, for the medians over the metals are what counts.
const ROUNDS: usize = 3;

/// Forms of several metals, compared.
pub struct Study {
    pub tolerance: Tolerance,
    pub entries: Vec<Entry>,
}

/// Forms of one metal.
pub struct Entry {
    pub preset: Preset,
    /// What clamping its colour at normal incidence changes.
    pub clip: Option<Clip>,
    /// The cheapest form within the tolerance.
    pub cheapest: Cheapest,
    /// In the order of [`Form::ALL`].
    pub forms: Vec<Studied>,
}

/// One form of one metal.
pub struct Studied {
    pub form: Form,
    pub fit: Fit,
    pub fresnel: Fresnel,
    /// Time of one evaluation of R, G and B in a batch on this machine, ns.
    pub nanoseconds: f64,
    /// That time over the one of the exact formula with one n and k per channel.
    pub ratio: f64,
}

/// One form over all metals.
pub struct Summary {
    pub form: Form,
    /// Medians over the metals.
    pub nanoseconds: f64,
    pub ratio: f64,
    /// Largest relative error of each metal, ascending.
    pub errors: Vec<f64>,
    /// Largest CIEDE2000 of each metal, ascending.
    pub delta_e: Vec<f64>,
    /// Metals within the tolerance.
    pub within: usize,
    /// Metals that it was chosen for.
    pub chosen: usize,
}

impl Study {
    /// Fits where fits are not stored, and measures times: a hundredth of a second a metal, a tenth more where fits
    /// must be made.
    pub fn new(presets: Vec<Preset>, tolerance: Tolerance) -> Study {
        let mut entries: Vec<Entry> = presets.into_par_iter().map(|preset| Entry::new(preset, tolerance)).collect();
        // One after another: what runs beside it would be in the time.
        for entry in &mut entries {
            entry.measure();
        }
        Study { tolerance, entries }
    }

    /// Each form over all metals, in the order of [`Form::ALL`].
    pub fn summaries(&self) -> Vec<Summary> {
        Form::ALL.into_iter().map(|form| self.summary(form)).collect()
    }

    fn summary(&self, form: Form) -> Summary {
        let studied: Vec<&Studied> = self.entries.iter().filter_map(|entry| entry.studied(form)).collect();
        let sorted = |figure: fn(&Studied) -> f64| {
            let mut figures: Vec<f64> = studied.iter().map(|s| figure(s)).collect();
            figures.sort_by(f64::total_cmp);
            figures
        };
        Summary {
            form,
            nanoseconds: quantile(&sorted(|s| s.nanoseconds), 0.5),
            ratio: quantile(&sorted(|s| s.ratio), 0.5),
            errors: sorted(|s| s.fit.relative),
            delta_e: sorted(|s| s.fit.delta_e),
            within: studied.iter().filter(|s| self.tolerance.allows(&s.fit)).count(),
            chosen: self.entries.iter().filter(|entry| entry.cheapest.form == form).count(),
        }
    }
}

impl Entry {
    fn new(preset: Preset, tolerance: Tolerance) -> Entry {
        let fits = preset.fits();
        let cheapest = fits.cheapest(tolerance);
        let studied = |form: Form| {
            let fit = fits.forms.get(&form)?.clone();
            Some(Studied { form, fit, fresnel: preset.fresnel(form), nanoseconds: 0.0, ratio: 1.0 })
        };
        let forms = Form::ALL.into_iter().filter_map(studied).collect();
        let clip = clip(preset.unclamped_f0());
        Entry { clip, cheapest, forms, preset }
    }

    /// The form of that name.
    pub fn studied(&self, form: Form) -> Option<&Studied> {
        self.forms.iter().find(|studied| studied.form == form)
    }

    /// True for the cheapest form within the tolerance.
    pub fn is_chosen(&self, form: Form) -> bool {
        self.cheapest.form == form
    }

    fn measure(&mut self) {
        let curves: Vec<Fresnel> = self.forms.iter().map(|studied| studied.fresnel.clone()).collect();
        for (studied, seconds) in self.forms.iter_mut().zip(evaluation_times(&curves, ROUNDS)) {
            studied.nanoseconds = 1e9 * seconds;
        }
        let exact = self.studied(Form::EffectiveNk).map_or(1.0, |studied| studied.nanoseconds);
        for studied in &mut self.forms {
            studied.ratio = studied.nanoseconds / exact;
        }
    }
}

/// The value a share of the way through ascending values, 0 of none.
pub fn quantile(ascending: &[f64], share: f64) -> f64 {
    let last = ascending.len().saturating_sub(1);
    let place = (share.clamp(0.0, 1.0) * last as f64).round() as usize;
    ascending.get(place).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use burnish_core::material::preset;

    #[test]
    fn every_form_of_a_metal_has_its_errors_and_a_time() {
        let study = Study::new(vec![preset::find("Au").unwrap()], Tolerance::default());
        let [gold] = study.entries.as_slice() else { panic!("one metal") };
        assert_eq!(gold.forms.iter().map(|s| s.form).collect::<Vec<_>>(), Form::ALL);
        assert!(gold.forms.iter().all(|s| s.nanoseconds > 0.0 && s.ratio > 0.0 && s.ratio.is_finite()));
        assert!(gold.clip.is_some_and(|clip| clip.delta_e > 0.5), "the red of gold lies outside");
        let summaries = study.summaries();
        assert_eq!(summaries.iter().map(|s| s.chosen).sum::<usize>(), 1);
        let spectral = summaries.iter().find(|s| s.form == Form::Spectral).unwrap();
        assert!(spectral.within == 1 && spectral.errors[0] < 1e-3, "the truth is near itself: {:?}", spectral.errors);
    }

    #[test]
    fn quantiles_of_nothing_are_0() {
        assert_eq!(quantile(&[], 0.5), 0.0);
        assert_eq!([0.0, 0.5, 1.0].map(|share| quantile(&[1.0, 2.0, 9.0], share)), [1.0, 2.0, 9.0]);
    }
}
