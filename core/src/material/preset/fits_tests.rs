use std::sync::LazyLock;

use super::*;
use crate::material::preset::{find, library};
use crate::math::minimize::nelder_mead;
use crate::surface::fresnel::fit::Dip;

const SERIES: &str = include_str!("../../../../tests/data/reference/fresnel_series.csv");

/// Made now, not read from the files.
static MADE: LazyLock<Vec<(&'static Preset, Fits)>> = LazyLock::new(|| {
    use rayon::prelude::*;
    library().par_iter().map(|preset| (preset, Fits::new(preset))).collect()
});

fn made(id: &str) -> &'static Fits {
    &MADE.iter().find(|(preset, _)| preset.id == id).expect("a preset").1
}

/// Presets that are not an alternative to another.
fn primaries() -> impl Iterator<Item = &'static (&'static Preset, Fits)> {
    MADE.iter().filter(|(preset, _)| !preset.id.contains('.'))
}

fn fit_error(fits: &Fits, form: Form) -> f64 {
    fits.forms[&form].fit_error.expect("a dip").into_iter().fold(0.0, f64::max)
}

fn share(errors: &[f64], limit: f64) -> f64 {
    errors.iter().filter(|error| **error <= limit).count() as f64 / errors.len() as f64
}

#[test]
fn the_stored_fits_of_every_preset_are_those_that_are_made_now() {
    for (preset, made) in MADE.iter() {
        let stored = preset.fits.as_ref().unwrap_or_else(|| panic!("{} has no fits: burnish fit it", preset.id));
        assert!(stored.belong_to(preset), "{} was fitted with another table: burnish fit it", preset.id);
        assert_eq!(stored.cheapest.form, made.cheapest.form, "{}", preset.id);
        for c in 0..3 {
            assert!((stored.f0[c] - made.f0[c]).abs() <= 1e-8, "{}", preset.id);
        }
        let fitter = Fitter::new(preset);
        for form in Form::ALL {
            let (a, b) = (&stored.forms[&form], &made.forms[&form]);
            // What is rendered of the stored numbers errs by what is stored, to its five digits.
            let curve = preset.fresnel(form);
            let error = |(i, truth): (usize, &Vec3)| {
                f64::from(((curve.eval(node(i) as f32) - *truth).abs() / truth.max(Vec3::splat(1e-6))).max_element())
            };
            let found = fit::largest(fitter.truth.iter().enumerate().map(error));
            assert!((found - a.relative).abs() <= 1e-6 + 1e-4 * a.relative, "{} {form}: {found} {a:?}", preset.id);
            // Flat optima: the numbers may differ between machines where the error does not.
            assert!((a.relative - b.relative).abs() <= 1e-4 + 0.01 * b.relative, "{} {form}", preset.id);
            assert!((a.delta_e - b.delta_e).abs() <= 0.02, "{} {form}", preset.id);
        }
    }
}

#[test]
fn rescaled_and_series_reach_the_reference_for_every_material_and_channel() {
    let mut worst = 0.0f64;
    let mut seen = 0;
    for line in SERIES.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let channel = "RGB".find(cells[1]).unwrap();
        let number = |i: usize| cells[i].parse::<f64>().unwrap();
        let fits = made(cells[0]);
        let error = |form: Form| fits.forms[&form].fit_error.unwrap()[channel];
        assert!((fits.f0[channel] - number(2)).abs() < 6e-6, "{line}");
        assert!((error(Form::Rescaled) / number(3) - 1.0).abs() < 5e-3, "{line}: {}", error(Form::Rescaled));
        for (form, expected) in [(Form::Series2, number(4)), (Form::Series4, number(5))] {
            let ratio = error(form) / expected;
            worst = worst.max(ratio);
            assert!(ratio <= 1.05, "{form} {line}: {}", error(form));
        }
        seen += 1;
    }
    assert_eq!(seen, 138);
    println!("largest ratio to the reference: {worst:.4}");
}

/// What methods of this kind can reach on measured metals: the bars of the project, with the histogram.
#[test]
fn most_presets_are_met_within_a_per_cent_and_nearly_all_by_four_terms() {
    let forms = [Form::Rescaled, Form::Fitted, Form::Series2, Form::Series3, Form::Series4];
    let limits = [0.001, 0.003, 0.01, 0.02, 0.03, 0.06];
    println!("largest relative error of {} presets, share up to {limits:?}", MADE.len());
    let mut errors = BTreeMap::new();
    for form in forms {
        let list: Vec<f64> = MADE.iter().map(|(_, fits)| fit_error(fits, form)).collect();
        let shares = limits.map(|limit| format!("{:3.0} %", 100.0 * share(&list, limit)));
        let worst = list.iter().copied().fold(0.0, f64::max);
        println!("{form:10} {} worst {:.2} %", shares.join(" "), 100.0 * worst);
        errors.insert(form, list);
    }
    // The eleven alternatives are harder: 28 % of all are within 1 %, 32 % of the 46 (below). No a and alpha do better,
    // as the other optimiser shows.
    let rendered: Vec<f64> = MADE.iter().map(|(_, fits)| fits.forms[&Form::Fitted].relative).collect();
    println!("fitted as rendered, within [0, 1]: {:.1} % within 1 %", 100.0 * share(&rendered, 0.01));
    assert!(share(&errors[&Form::Fitted], 0.03) >= 0.85);
    assert!(share(&errors[&Form::Series4], 0.01) >= 0.95);
    // Of the 46 without alternatives, as methods of the field count them.
    let of = |form| primaries().map(|(_, fits)| fit_error(fits, form)).collect::<Vec<f64>>();
    let counted = |form, limit| of(form).iter().filter(|error| **error <= limit).count();
    assert_eq!(primaries().count(), 46);
    assert!(counted(Form::Fitted, 0.01) >= 15 && counted(Form::Fitted, 0.03) >= 41);
    assert!(share(&of(Form::Series2), 0.01) >= 0.80 && share(&of(Form::Series3), 0.01) >= 0.91);
    assert!(share(&of(Form::Series4), 0.003) >= 0.91);
}

#[test]
fn the_fitted_dip_is_never_worse_than_none_a_valid_recipe_or_another_optimiser() {
    let mut worst = 0.0f64;
    for (preset, fits) in MADE.iter() {
        let error = |form: Form, c: usize| fits.forms[&form].fit_error.expect("a dip")[c];
        let fitter = Fitter::new(preset);
        for c in 0..3 {
            let fitted = error(Form::Fitted, c);
            // Errors are stored with five digits.
            let least = error(Form::Rescaled, c).min(error(Form::Recipe, c)) * (1.0 + 2e-5);
            assert!(fitted <= least, "{} {c}: {fitted} {least}", preset.id);
            let searched = multi_start(&fitter.targets[c]);
            worst = worst.max(fitted / searched);
            // Both stop at their own resolution.
            assert!(fitted <= 1.002 * searched, "{} {c}: {fitted} {searched}", preset.id);
        }
    }
    println!("largest ratio to the other optimiser: {worst:.4}");
}

/// Simplex searches in (a, log alpha) from sixteen starts.
fn multi_start(target: &Target) -> f64 {
    let error = |p: &[f64; 2]| Dip { a: p[0], alpha: p[1].clamp(-4.0, 4.8).exp() }.error(target);
    let starts = [-1.0, -0.1, 0.4, 2.0].into_iter().flat_map(|a| [0.0, 1.2, 1.9, 3.0].map(|alpha| [a, alpha]));
    starts.map(|start| nelder_mead(start, 0.3, 70, error).1).fold(f64::INFINITY, f64::min)
}

#[test]
fn an_effective_index_meets_every_channel_that_lies_inside_the_gamut() {
    let mut worst = (0.0, String::new());
    for (preset, fits) in MADE.iter() {
        let fitter = Fitter::new(preset);
        let numbers = &fits.forms[&Form::EffectiveNk].parameters;
        for c in (0..3).filter(|&c| fits.f0[c] < F0_MAX) {
            let (n, k) = (numbers["n"][c], numbers["k"][c]);
            let error = fitter.targets[c].absolute_error(|x| crate::surface::fresnel::exact(n, k, x));
            if error > worst.0 {
                worst = (error, format!("{} {c}", preset.id));
            }
        }
        let outside = fits.f0.iter().any(|&f0| f0 >= F0_MAX);
        assert_eq!(fits.forms[&Form::EffectiveNk].note.is_some(), outside, "{}", preset.id);
    }
    println!("largest absolute error {worst:?}");
    assert!(worst.0 <= 0.012, "{worst:?}");
}

#[test]
fn published_figures_of_the_effective_and_the_sampled_index_are_met() {
    // Silver, aluminium and six more: 0.001; copper 0.004; brass 0.005; titanium nitride 0.006; gilding metal 0.011.
    let within = [("Ag", 0.001), ("Al", 0.001), ("Fe", 0.001), ("Ti", 0.001), ("Cr", 0.001), ("Ni", 0.001)];
    let more = [("Pt", 0.001), ("W", 0.001), ("Cu", 0.004), ("CuZn", 0.005), ("TiN", 0.006), ("CuZn10", 0.011)];
    for (id, limit) in within.into_iter().chain(more) {
        let error = made(id).forms[&Form::EffectiveNk].absolute;
        // The figures are rounded.
        assert!(error <= limit + 0.0005, "{id}: {error}");
    }
    let gold = &made("Au").forms;
    assert!(gold[&Form::SampledNk].absolute > 2.0 * gold[&Form::Rescaled].absolute);
    let t = &gold[&Form::F82].parameters["t"];
    assert!((t[1] - 1.004).abs() < 5e-4, "{t:?}");
}

#[test]
fn the_cheapest_form_is_the_first_within_the_tolerance_and_says_what_the_others_miss() {
    for (preset, fits) in MADE.iter() {
        let tolerance = Tolerance::default();
        let Cheapest { form, reason } = fits.cheapest(tolerance);
        assert_eq!(form, fits.cheapest.form);
        let does = |form: Form| {
            let fit = &fits.forms[&form];
            fit.relative <= tolerance.relative && fit.delta_e <= tolerance.delta_e
        };
        assert!(does(form), "{} {form}", preset.id);
        assert!(Form::ALL.into_iter().filter(|other| *other < form).all(|other| !does(other)), "{}", preset.id);
        assert!(reason.starts_with(form.id()), "{reason}");
    }
    let iron = made("Fe");
    assert!(iron.cheapest(Tolerance { relative: 1.0, delta_e: 100.0 }).form == Form::Rescaled);
    assert_eq!(iron.cheapest(Tolerance { relative: 0.0, delta_e: 0.0 }).form, Form::Spectral);
}

#[test]
fn what_is_rendered_from_stored_numbers_is_what_was_measured() {
    let iron = find("Fe").unwrap();
    let fits = Fits::new(&iron);
    let stored = Preset { fits: Some(fits.clone()), ..iron.clone() };
    let changed = Preset { n: iron.n.iter().map(|n| n + 0.5).collect(), ..stored.clone() };
    assert!(!fits.belong_to(&changed));
    for form in Form::ALL {
        let curve = stored.fresnel(form);
        let plain = Preset { fits: None, ..iron.clone() }.fresnel(form);
        for i in 0..=50 {
            let x = i as f32 / 50.0;
            assert!(curve.eval(x).distance(plain.eval(x)) < 2e-6, "{form} {x}");
        }
        // Numbers of another table are not used.
        assert!(changed.fresnel(form).eval(0.8).distance(curve.eval(0.8)) > 1e-3, "{form}");
    }
}

#[test]
fn fits_that_cannot_be_read_are_left_out() {
    let mut json = serde_json::to_value(find("Au").unwrap()).unwrap();
    for fits in [serde_json::json!({"of": 1}), serde_json::json!(null), serde_json::json!([3])] {
        json["fits"] = fits;
        let preset: Preset = serde_json::from_value(json.clone()).unwrap();
        assert_eq!(preset.fits, None);
    }
}
