//! The forms in which a metal can be rendered: the chosen one, the cheapest, and the errors of all.

use burnish_core::lighting::classical;
use burnish_core::material::preset::{Fit, Fits, FormChoice, Tolerance};
use burnish_core::param::Settings;
use burnish_core::surface::fresnel::Form;
use eframe::egui::{self, RichText};

/// What the errors of a form are.
pub const ERRORS: &str = "Largest relative error over red, green, blue and angle, and largest CIEDE2000 on a ball, against \
                      the spectral curve.";

/// What the lighting settings say about forms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FormSettings {
    /// How the form of a metal is chosen.
    choice: FormChoice,
    /// What the cheapest form may err by, chosen or not.
    pub tolerance: Tolerance,
}

impl FormSettings {
    /// Reads the settings of the lighting method.
    pub fn new(settings: &Settings) -> FormSettings {
        FormSettings { choice: classical::form_choice(settings), tolerance: classical::tolerance(settings) }
    }
}

/// The chosen form, the cheapest one with its reason, and a list of all to open.
pub fn forms_ui(ui: &mut egui::Ui, fits: &Fits, settings: FormSettings) {
    let cheapest = fits.cheapest(settings.tolerance);
    if let FormChoice::Of(form) = settings.choice
        && form != cheapest.form
        && let Some(fit) = fits.forms.get(&form)
    {
        line(ui, format!("Form of the scene: {form}, {}", errors(fit))).on_hover_text(help(form, Some(fit)));
    }
    let fit = fits.forms.get(&cheapest.form);
    let text = format!("Cheapest form: {}{}", cheapest.form, fit.map_or(String::new(), |f| format!(", {}", errors(f))));
    line(ui, text).on_hover_text(help(cheapest.form, fit));
    ui.horizontal_wrapped(|ui| {
        let button = ui.menu_button(RichText::new("All forms").small(), |ui| table_ui(ui, fits, cheapest.form));
        button.response.on_hover_text("Errors of every form of this metal, the cheapest to draw first");
        let Tolerance { relative, delta_e } = settings.tolerance;
        let within = format!("within {} %, ΔE {delta_e}", 100.0 * relative);
        ui.weak(RichText::new(within).small()).on_hover_text(format!(
            "{}.\nTolerances: Fresnel error and Fresnel ΔE of the lighting method, in the environment panel.",
            cheapest.reason
        ));
    });
}

/// A small text that breaks.
pub fn line(ui: &mut egui::Ui, text: impl Into<String>) -> egui::Response {
    ui.add(egui::Label::new(RichText::new(text).small()).wrap())
}

/// The errors of a form in words.
pub fn errors(fit: &Fit) -> String {
    format!("error {:.2} %, ΔE {:.2}", 100.0 * fit.relative, fit.delta_e)
}

fn help(form: Form, fit: Option<&Fit>) -> String {
    let note = fit.and_then(|fit| fit.note.as_ref()).map_or(String::new(), |note| format!("\n{note}"));
    format!("{form}: {}.{note}\n{ERRORS}", form.help())
}

/// A row for each form.
fn table_ui(ui: &mut egui::Ui, fits: &Fits, cheapest: Form) {
    ui.set_min_width(230.0);
    egui::Grid::new("forms").num_columns(3).spacing([12.0, 2.0]).striped(true).show(ui, |ui| {
        ui.weak("Form");
        ui.weak("Error, %").on_hover_text(ERRORS);
        ui.weak("ΔE").on_hover_text(ERRORS);
        ui.end_row();
        for (form, fit) in &fits.forms {
            let name = if *form == cheapest { format!("{form} (cheapest)") } else { form.to_string() };
            let text = if *form == cheapest { RichText::new(name).strong() } else { name.into() };
            ui.label(text).on_hover_text(help(*form, Some(fit)));
            ui.monospace(format!("{:8.3}", 100.0 * fit.relative));
            ui.monospace(format!("{:7.3}", fit.delta_e));
            ui.end_row();
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use burnish_core::material::preset;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    #[test]
    fn the_tolerance_is_that_of_the_settings_whatever_form_is_chosen() {
        let mut settings = Settings::new(classical::PARAMS);
        settings.set("fresnel-error", "5").unwrap();
        settings.set("fresnel", "spectral").unwrap();
        let read = FormSettings::new(&settings);
        assert_eq!(read.choice, FormChoice::Of(Form::Spectral));
        assert_eq!(read.tolerance, Tolerance { relative: 0.05, delta_e: 1.0 });
    }

    #[test]
    fn every_form_is_listed_with_its_errors_and_the_cheapest_beside_the_chosen_one() {
        let gold = preset::find("Au").unwrap();
        let settings = FormSettings { choice: FormChoice::Of(Form::Schlick), tolerance: Tolerance::default() };
        let mut shown = Harness::builder().with_size(egui::vec2(320.0, 500.0)).build_ui(|ui| {
            forms_ui(ui, gold.stored_fits().unwrap(), settings);
        });
        let fits = gold.fits();
        let cheapest = fits.cheapest(Tolerance::default()).form;
        shown.get_by_label_contains("Form of the scene: schlick, error 99.58 %, ΔE 33.90");
        shown.get_by_label_contains(&format!("Cheapest form: {cheapest}, error "));
        shown.get_by_label("All forms").click();
        shown.run();
        for form in Form::ALL.into_iter().filter(|form| *form != cheapest) {
            shown.get_by_label(form.id());
        }
        shown.get_by_label(&format!("{cheapest} (cheapest)"));
    }

    #[test]
    fn fits_of_another_table_are_not_shown() {
        let gold = preset::find("Au").unwrap();
        assert!(gold.stored_fits().is_some());
        let k = gold.k.iter().map(|k| 1.1 * k).collect();
        assert!(preset::Preset { k, ..gold }.stored_fits().is_none());
    }
}
