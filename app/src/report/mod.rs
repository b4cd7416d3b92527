//! The report on Fresnel forms: one HTML file with its style and drawings inside, no scripts, nothing to load.
//!
//! `study` has the numbers, `summary` the charts over all metals, `metal` the part about each; `chart` and `axis` draw.

pub mod axis;
pub mod bench;
pub mod chart;
mod html;
mod looks;
mod metal;
pub mod study;
mod summary;

use std::fmt::Write as _;

use burnish_core::surface::fresnel::Form;

use axis::tick;
use html::{cell, escape, head, row, table};
use looks::{brief, percent};
use study::{Entry, Study, Summary, quantile};

/// Upper bounds of the classes `e0` to `e5` of a cell's colour, relative error; `e6` lies beyond.
const CLASSES: [f64; 6] = [0.001, 0.003, 0.01, 0.03, 0.1, 0.3];

/// The whole page.
pub fn page(study: &Study) -> String {
    let summaries = study.summaries();
    let mut html = String::from("<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n");
    html += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>Fresnel forms of metals</title>\n";
    let _ = write!(html, "<style>\n{}</style>\n</head>\n<body>\n<main>\n", include_str!("style.css"));
    html += &opening(study, &summaries);
    html += &overview(study);
    let relative = tick(100.0 * study.tolerance.relative);
    let _ = write!(
        html,
        "<h2 id=\"histograms\">How large the errors are</h2>\n<figure>{}<figcaption>Number of metals by the largest \
         relative error of a form, over R, G, B and all angles. The shaded part is within {relative} %.</figcaption></figure>\n",
        summary::histograms(study, &summaries)
    );
    let _ = write!(
        html,
        "<h2 id=\"colour\">Sampled RGB against spectral</h2>\n<p>{}</p>\n<figure>{}<figcaption>Largest CIEDE2000 on a mirror \
         ball in even white light between a form and the spectral curve. <code>sampled-nk</code>, the exact formula at one \
         wavelength per channel, is what a renderer does that looks up n and k three times. The shaded part is within \
         {}.</figcaption></figure>\n",
        sampled_words(study),
        summary::delta_e(study),
        tick(study.tolerance.delta_e)
    );
    let _ = write!(
        html,
        "<h2 id=\"trade\">Time against error</h2>\n<figure>{}<figcaption>Median over the metals; bars run from the metal \
         that suits a form best to the one that suits it least. Forms of \
         equal time are drawn side by side. Times were measured on one core of the machine that wrote \
         this report, for a form alone, without the memory that a table costs. The shaded part is within {relative} %.\
         </figcaption></figure>\n{}",
        summary::trade(study, &summaries),
        forms(&summaries)
    );
    let _ = write!(html, "<h2 id=\"metals\">Metal by metal</h2>\n<p>{}</p>\n", metal::words(study));
    html.extend(study.entries.iter().map(|entry| metal::section(study, entry)));
    html + "</main>\n</body>\n</html>\n"
}

/// Heading, what the report is about, and its main figures.
fn opening(study: &Study, summaries: &[Summary]) -> String {
    let metals = study.entries.len();
    let clipped: Vec<f64> = study.entries.iter().filter_map(|e| e.clip.map(|clip| clip.delta_e)).collect();
    let mut figures = vec![(metals.to_string(), "metals".to_string())];
    for form in [Form::Fitted, Form::Series3, Form::Series4] {
        let Some(Summary { errors, .. }) = summaries.iter().find(|s| s.form == form) else { continue };
        let within = errors.iter().filter(|e| **e <= 0.01).count();
        let (median, worst) = (percent(quantile(errors, 0.5)), percent(quantile(errors, 1.0)));
        figures.push((
            format!("{within} of {metals}"),
            format!("within 1 % by <code>{form}</code>; median {median} %, worst {worst} %"),
        ));
    }
    if let Some(Summary { delta_e, .. }) = summaries.iter().find(|s| s.form == Form::SampledNk) {
        let visible = delta_e.iter().filter(|delta_e| **delta_e > 1.0).count();
        figures.push((
            format!("{visible} of {metals}"),
            format!("off by more than \u{394}E2000 1 with <code>{}</code>", Form::SampledNk),
        ));
    }
    let worst = brief(clipped.iter().copied().fold(0.0, f64::max));
    figures.push((
        clipped.len().to_string(),
        format!("outside of Rec.709 at normal incidence; clamping changes them by \u{394}E2000 {worst} at most"),
    ));
    let figure = |(number, words): &(String, String)| format!("<li><b>{}</b>{words}</li>\n", escape(number));
    let figures: String = figures.iter().map(figure).collect();
    let links = |entry: &Entry| {
        let id = escape(&entry.preset.id);
        format!("<li><a href=\"#preset-{id}\">{id}</a></li>\n")
    };
    let links: String = study.entries.iter().map(links).collect();
    format!(
        "<h1>Fresnel forms of metals</h1>\n\
         <p class=\"soft\">Burnish {}</p>\n\
         <p>How well the curves that renderers evaluate stand for the reflectance of measured metals. The truth, \
         <code>spectral</code>, is the exact reflectance from n and k at each wavelength, integrated under D65 with the CIE 1931 \
         2\u{b0} observer to linear Rec.709 at each angle, and clamped to 0 to 1. Errors are against it, over R, G, B and all \
         angles.</p>\n<ul class=\"figures\">\n{figures}</ul>\n\
         <nav aria-label=\"Metals\"><ul>\n{links}</ul></nav>\n",
        env!("CARGO_PKG_VERSION")
    )
}

/// Largest relative error of every form for every metal.
fn overview(study: &Study) -> String {
    let titles = std::iter::once("metal").chain(Form::ALL.iter().map(|form| form.id()));
    let line = |entry: &Entry| {
        let id = escape(&entry.preset.id);
        let cells = entry.forms.iter().map(|studied| {
            let error = studied.fit.relative;
            let class = CLASSES.iter().position(|bound| error <= *bound).unwrap_or(CLASSES.len());
            let (chosen, mark) = match entry.is_chosen(studied.form) {
                true => (" chosen", "<span aria-label=\"chosen\">\u{2713}\u{a0}</span>"),
                false => ("", ""),
            };
            format!("<td class=\"e{class}{chosen}\">{mark}{}</td>", escape(&percent(error)))
        });
        row(&format!("<a href=\"#preset-{id}\">{id}</a>"), cells)
    };
    let rows: String = study.entries.iter().map(line).collect();
    let caption = format!(
        "Largest relative error in %, darker is larger (steps at 0.1, 0.3, 1, 3, 10, 30 %). A tick marks the chosen form: the \
         cheapest, from left to right, within {} % and \u{394}E2000 {}",
        tick(100.0 * study.tolerance.relative),
        tick(study.tolerance.delta_e)
    );
    format!("<h2 id=\"overview\">Every metal in every form</h2>\n{}", table("heat", &caption, &head(titles), &rows))
}

fn sampled_words(study: &Study) -> String {
    let sampled = study.entries.iter().filter_map(|entry| Some((entry, entry.studied(Form::SampledNk)?.fit.delta_e)));
    let visible = sampled.clone().filter(|(_, delta_e)| *delta_e > 1.0).count();
    match sampled.max_by(|a, b| a.1.total_cmp(&b.1)) {
        Some((entry, delta_e)) => format!(
            "{visible} of {} metals differ by more than 1, which can be seen side by side; {} the most, by {}.",
            study.entries.len(),
            escape(&entry.preset.id),
            brief(delta_e)
        ),
        None => String::new(),
    }
}

/// What each form is, with its figures over all metals.
fn forms(summaries: &[Summary]) -> String {
    let titles = [
        "form",
        "ns",
        "of exact",
        "median error, %",
        "largest error, %",
        "median \u{394}E2000",
        "largest \u{394}E2000",
        "within both bounds",
        "chosen",
        "what it is",
    ];
    let line = |summary: &Summary| {
        let Summary { form, nanoseconds, ratio, errors, delta_e, within, chosen } = summary;
        let figures = [
            format!("{nanoseconds:.1}"),
            format!("{ratio:.2}"),
            percent(quantile(errors, 0.5)),
            percent(quantile(errors, 1.0)),
            brief(quantile(delta_e, 0.5)),
            brief(quantile(delta_e, 1.0)),
            within.to_string(),
            chosen.to_string(),
        ];
        let cells = figures.iter().map(|figure| cell(&escape(figure)));
        row(form.id(), cells.chain([format!("<td class=\"words\">{}</td>", escape(form.help()))]))
    };
    let rows: String = summaries.iter().map(line).collect();
    table("", "The forms over all metals, the cheapest first", &head(titles), &rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use burnish_core::material::preset::{self, Tolerance};

    #[test]
    fn a_page_of_two_metals_loads_nothing_and_has_every_part() {
        let presets = ["Au", "Cr"].map(|id| preset::find(id).unwrap()).to_vec();
        let page = page(&Study::new(presets, Tolerance::default()));
        for part in ["id=\"overview\"", "id=\"histograms\"", "id=\"colour\"", "id=\"trade\"", "id=\"preset-Cr\""] {
            assert!(page.contains(part), "{part}");
        }
        for outside in ["http:", "https:", "src=", "<script", "<link", "@import", "NaN", "inf"] {
            assert!(!page.contains(outside), "{outside}");
        }
    }

    #[test]
    fn a_page_of_no_metals_is_still_a_page() {
        let page = page(&Study::new(Vec::new(), Tolerance::default()));
        assert!(page.ends_with("</html>\n") && !page.contains("NaN"));
    }
}
