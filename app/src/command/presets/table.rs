//! `burnish presets --table`: errors and times of every Fresnel form of every metal.

use std::io::Write;
use std::path::Path;

use burnish_core::file::write_atomic;
use burnish_core::material::preset::{self, Tolerance};
use burnish_core::surface::fresnel::Form;
use serde::Serialize;

use super::{csv, write_json};
use crate::failure::{Exit, Failure};
use crate::report::study::{Entry, Studied, Study};

/// One form of one metal.
#[derive(Serialize)]
struct Row<'a> {
    preset: &'a str,
    form: Form,
    /// Largest relative error over R, G, B and angle.
    relative: f64,
    /// Largest absolute error over R, G, B and angle.
    absolute: f64,
    /// Largest CIEDE2000 on a ball.
    delta_e: f64,
    /// Mean CIEDE2000 on the ball.
    delta_e_mean: f64,
    /// Time of one evaluation of R, G and B, ns.
    nanoseconds: f64,
    /// Over that of the exact formula with one n and k per channel.
    time_ratio: f64,
    chosen: bool,
    /// Why it was chosen.
    reason: Option<&'a str>,
    /// Where the form does not hold.
    note: Option<&'a str>,
}

/// Columns of the file, those of [`Row`].
const COLUMNS: [&str; 11] = [
    "preset",
    "form",
    "relative",
    "absolute",
    "delta_e",
    "delta_e_mean",
    "nanoseconds",
    "time_ratio",
    "chosen",
    "reason",
    "note",
];

impl<'a> Row<'a> {
    fn of(entry: &'a Entry, studied: &'a Studied) -> Row<'a> {
        let Studied { form, fit, nanoseconds, ratio, .. } = studied;
        let chosen = entry.is_chosen(*form);
        Row {
            preset: &entry.preset.id,
            form: *form,
            relative: fit.relative,
            absolute: fit.absolute,
            delta_e: fit.delta_e,
            delta_e_mean: fit.delta_e_mean,
            nanoseconds: rounded(*nanoseconds),
            time_ratio: rounded(*ratio),
            chosen,
            reason: chosen.then_some(&entry.cheapest.reason),
            note: fit.note.as_deref(),
        }
    }

    fn csv(&self) -> String {
        let Row { preset, form, relative, absolute, delta_e, delta_e_mean, nanoseconds, time_ratio, .. } = self;
        let numbers = [relative, absolute, delta_e, delta_e_mean, nanoseconds, time_ratio].map(f64::to_string);
        let chosen = if self.chosen { "true" } else { "false" };
        let before = [*preset, form.id()].into_iter().chain(numbers.iter().map(String::as_str));
        csv::line(before.chain([chosen, self.reason.unwrap_or(""), self.note.unwrap_or("")]))
    }
}

/// Times are not known to more than three decimals.
fn rounded(value: f64) -> f64 {
    (value * 1e3).round() / 1e3
}

pub fn run(json: bool, file: Option<&Path>, tolerance: Tolerance, out: &mut dyn Write) -> Result<Exit, Failure> {
    let study = Study::new(preset::library().to_vec(), tolerance);
    let rows = || study.entries.iter().flat_map(|entry| entry.forms.iter().map(|studied| Row::of(entry, studied)));
    if let Some(file) = file {
        let lines: String = rows().map(|row| row.csv()).collect();
        let text = csv::line(COLUMNS) + &lines;
        write_atomic(file, text.as_bytes()).map_err(Failure::resources)?;
    }
    if json {
        write_json(out, &rows().collect::<Vec<_>>())?;
    } else {
        write_table(&study, out)?;
        write_forms(&study, out)?;
    }
    Ok(Exit::Ok)
}

/// One line a metal.
fn write_table(study: &Study, out: &mut dyn Write) -> Result<(), Failure> {
    let id_width = study.entries.iter().map(|e| e.preset.id.chars().count()).max().unwrap_or(0).max(6);
    let titles: String = Form::ALL.iter().map(|form| format!(" {:>w$}", form.id(), w = width(*form))).collect();
    writeln!(
        out,
        "Largest relative error of every form in %, over R, G, B and all angles, against the spectral curve:"
    )?;
    writeln!(out)?;
    writeln!(out, "{:id_width$}  {:12} {titles}  reason", "preset", "chosen")?;
    for entry in &study.entries {
        let error = |form: &Form| {
            let error = entry.studied(*form).map_or("-".into(), |s| format!("{:.2}", 100.0 * s.fit.relative));
            format!(" {error:>w$}", w = width(*form))
        };
        let errors: String = Form::ALL.iter().map(error).collect();
        let (id, cheapest) = (&entry.preset.id, &entry.cheapest);
        writeln!(out, "{id:id_width$}  {:12} {errors}  {}", cheapest.form.id(), cheapest.reason)?;
    }
    Ok(())
}

fn width(form: Form) -> usize {
    form.id().len().max(6)
}

/// One line a form, with its times.
fn write_forms(study: &Study, out: &mut dyn Write) -> Result<(), Failure> {
    let Tolerance { relative, delta_e } = study.tolerance;
    writeln!(out)?;
    writeln!(
        out,
        "Time of one evaluation of R, G and B here, and over that of the exact formula; metals that a form fits"
    )?;
    writeln!(
        out,
        "within {} % and CIEDE2000 {delta_e}; metals that it was chosen for, being the cheapest:",
        100.0 * relative
    )?;
    writeln!(out)?;
    writeln!(out, "{:12}  {:>6}  {:>5}  {:>6}  {:>6}", "form", "ns", "ratio", "within", "chosen")?;
    for s in study.summaries() {
        writeln!(out, "{:12}  {:6.1}  {:5.2}  {:6}  {:6}", s.form.id(), s.nanoseconds, s.ratio, s.within, s.chosen)?;
    }
    writeln!(
        out,
        "\nCheap is what comes first here. The table of `spectral` comes last: two reads of memory, but 768 numbers."
    )?;
    Ok(())
}
