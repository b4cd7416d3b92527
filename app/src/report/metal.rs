//! The part of the report about one metal.

use std::fmt::Write as _;

use burnish_core::surface::fresnel::{Form, Fresnel};
use glam::Vec3;

use super::axis::{Axis, tick};
use super::chart::{Chart, Plot};
use super::html::{cell, escape, head, row, table};
use super::looks::{brief, class, hex, percent, triple};
use super::study::{Entry, Studied, Study};

/// Error that is drawn linearly around 0, %.
const LINEAR_PERCENT: f64 = 0.1;

/// What the parts about metals have in common.
pub fn words(study: &Study) -> String {
    format!(
        "The thick line is the spectral curve. The axis of relative errors is linear up to {LINEAR_PERCENT} % and logarithmic \
         beyond, on both sides; the shaded part is within {} %. <code>schlick</code> is cut off where it lies below the others. \
         The balls are mirrors in even white light: the centre shows normal incidence, the rim grazing. A tick in the legend \
         marks the chosen form.",
        tick(100.0 * study.tolerance.relative)
    )
}

/// Everything about one metal.
pub fn section(study: &Study, entry: &Entry) -> String {
    let preset = &entry.preset;
    let id = escape(&preset.id);
    let mut html = format!(
        "<article id=\"preset-{id}\" aria-labelledby=\"title-{id}\">\n<header><div><h3 id=\"title-{id}\">{id}: {}</h3>\n",
        escape(&preset.name)
    );
    let _ = writeln!(html, "<p class=\"soft\">{}</p>", escape(&preset.source.citation()));
    let _ = writeln!(html, "<p>{}</p></div>\n{}</header>", f0_words(entry), balls(entry));
    if let Some(warning) = &preset.warning {
        let _ = writeln!(html, "<p class=\"warning\"><strong>Warning.</strong> {}</p>", escape(warning));
    }
    let _ = writeln!(
        html,
        "<p><strong>Chosen: {}.</strong> {}.</p>",
        entry.cheapest.form,
        escape(entry.cheapest.reason.trim_end_matches('.'))
    );
    let _ = writeln!(html, "<figure>{}{}</figure>", curves(study, entry), legend(entry));
    html + &parameters(entry) + "</article>\n"
}

/// F0 in words, with what the clamp to Rec.709 changes.
fn f0_words(entry: &Entry) -> String {
    let f0 = entry.preset.unclamped_f0().to_array();
    match &entry.clip {
        None => format!("F0 (linear Rec.709, D65) {}.", triple(f0)),
        Some(clip) => format!(
            "F0 (linear Rec.709, D65) {}, clamped to {}: \u{394}E2000 {}.",
            triple(f0),
            triple(clip.clamped.to_array()),
            brief(clip.delta_e)
        ),
    }
}

/// Mirror balls in even white light: the truth, the chosen form, and the sampled index.
fn balls(entry: &Entry) -> String {
    let shown = [Form::Spectral, entry.cheapest.form, Form::SampledNk];
    let mut balls = String::from("<div class=\"balls\">");
    for (i, form) in shown.into_iter().enumerate().filter(|(i, form)| !shown[..*i].contains(form)) {
        let Some(studied) = entry.studied(form) else { continue };
        let id = format!("ball-{}-{i}", escape(&entry.preset.id));
        let label =
            format!("Ball of {} by {form}, {} at its centre", escape(&entry.preset.id), hex(studied.fresnel.f0()));
        let _ = write!(
            balls,
            "<figure><svg role=\"img\" aria-label=\"{label}\" viewBox=\"0 0 64 64\"><defs><radialGradient id=\"{id}\">{}\
             </radialGradient></defs><circle cx=\"32\" cy=\"32\" r=\"31\" fill=\"url(#{id})\"/></svg>\
             <figcaption>{form}</figcaption></figure>",
            stops(&studied.fresnel)
        );
    }
    balls + "</div>\n"
}

/// Colours of a ball from its centre to its rim: at the radius r the cosine is sqrt(1 - r^2).
fn stops(fresnel: &Fresnel) -> String {
    let radii = [0.0f32, 0.4, 0.6, 0.75, 0.85, 0.92, 0.96, 0.985, 1.0];
    let stop = |r: f32| {
        let color = hex(fresnel.eval((1.0 - r * r).max(0.0).sqrt()));
        format!("<stop offset=\"{r}\" stop-color=\"{color}\"/>")
    };
    radii.into_iter().map(stop).collect()
}

/// Angles of the curves, degrees: closer toward grazing, where they bend.
fn angles() -> impl Iterator<Item = f64> + Clone {
    let coarse = (0..10).map(|i| 4.0 * f64::from(i));
    coarse.chain((0..=33).map(|i| 40.0 + 1.5 * f64::from(i))).chain([90.0])
}

/// R, G and B against the angle in every form, with the errors of each below.
fn curves(study: &Study, entry: &Entry) -> String {
    let mut chart = Chart::new(1100.0, 452.0);
    let truth = sampled(entry.studied(Form::Spectral));
    // The last form is the truth; drawn first, it hides none.
    let curves: Vec<(Form, Vec<Vec3>)> = entry.forms.iter().rev().map(|s| (s.form, sampled(Some(s)))).collect();
    let (floor, step) = floor(&curves);
    for (channel, name) in ["R", "G", "B"].into_iter().enumerate() {
        let left = 50.0 + 368.0 * channel as f64;
        let angle = || Axis::linear("angle from the normal, degrees", 0.0, 90.0, 15.0);
        let y = if channel == 0 { "reflectance" } else { "" };
        let values = Plot { x: angle(), y: Axis::linear(y, floor, 1.0, step), area: [left, 18.0, 308.0, 160.0] };
        let y = if channel == 0 { "relative error, %" } else { "" };
        let errors =
            Plot { x: angle(), y: Axis::signed_log(y, LINEAR_PERCENT, 100.0), area: [left, 240.0, 308.0, 176.0] };
        chart.text(left, 12.0, "name", name);
        chart.text(left, 234.0, "name", &format!("{name}: error of each form"));
        let limit = 100.0 * study.tolerance.relative;
        let ((_, top), (_, bottom)) = (errors.at(0.0, limit), errors.at(0.0, -limit));
        chart.rect([left, top, 308.0, bottom - top], "band");
        chart.axes(&values);
        chart.axes(&errors);
        for (form, curve) in &curves {
            let class = format!("c {}", class(*form));
            let of_channel = angles().zip(curve.iter().map(|v| f64::from(v[channel])));
            let shown = of_channel.filter(|(_, v)| *v >= floor);
            chart.line(shown.map(|(angle, v)| values.at(angle, v)), &class);
            if *form != Form::Spectral {
                let error =
                    |(v, truth): (&Vec3, &Vec3)| f64::from((v[channel] - truth[channel]) / truth[channel].max(1e-6));
                let errors_of = curve.iter().zip(&truth).map(error);
                chart.line(angles().zip(errors_of).map(|(angle, e)| errors.at(angle, 100.0 * e)), &class);
            }
        }
    }
    chart.finish(&format!(
        "Reflectance of {} against angle in R, G and B for every form, and below the relative error of each against the \
         spectral curve, on an axis that is linear up to 0.1 % and logarithmic beyond; the table below has the largest",
        entry.preset.id
    ))
}

/// Where the axis of reflectance begins, and the step of its ticks: below all curves but `schlick`, which is so far off
/// for metals that it would flatten the others; it is cut off where it lies below.
fn floor(curves: &[(Form, Vec<Vec3>)]) -> (f64, f64) {
    let shown = curves.iter().filter(|(form, _)| *form != Form::Schlick);
    let least = shown.flat_map(|(_, curve)| curve).fold(1.0, |least: f32, v| least.min(v.min_element()));
    let floor = ((f64::from(least) - 0.02) * 10.0).floor().clamp(0.0, 8.0) / 10.0;
    let step = [0.05, 0.1, 0.2, 0.25].into_iter().find(|step| {
        let count = (1.0 - floor) / step;
        count < 5.5 && (count - count.round()).abs() < 1e-6
    });
    (floor, step.unwrap_or(0.1))
}

fn sampled(studied: Option<&Studied>) -> Vec<Vec3> {
    let eval = |angle: f64| studied.map_or(Vec3::ONE, |s| s.fresnel.eval(angle.to_radians().cos().max(0.0) as f32));
    angles().map(eval).collect()
}

/// The forms with their lines and largest errors.
fn legend(entry: &Entry) -> String {
    let item = |studied: &Studied| {
        let class = class(studied.form);
        let chosen = if entry.is_chosen(studied.form) { " class=\"chosen\"" } else { "" };
        let error = match studied.form {
            Form::Spectral => "exact".to_string(),
            _ => format!("{} %", percent(studied.fit.relative)),
        };
        format!(
            "<li{chosen}><svg aria-hidden=\"true\" viewBox=\"0 0 26 10\"><path class=\"c {class}\" d=\"M0 5h26\"/></svg>{} {error}</li>\n",
            studied.form
        )
    };
    format!("<ul class=\"legend\">\n{}</ul>", entry.forms.iter().map(item).collect::<String>())
}

/// Errors, time and numbers of every form.
fn parameters(entry: &Entry) -> String {
    let titles = [
        "form",
        "largest relative error, %",
        "absolute",
        "\u{394}E2000",
        "mean \u{394}E2000",
        "ns",
        "of exact",
        "parameters R, G, B",
    ];
    let line = |studied: &Studied| {
        let fit = &studied.fit;
        let numbers =
            fit.parameters.iter().map(|(name, values)| format!("{} = {}", escape(name), values.map(plain).join(", ")));
        let mut words: Vec<String> = numbers.collect();
        words.extend(fit.note.as_deref().map(escape));
        let chosen = if entry.is_chosen(studied.form) { " (chosen)" } else { "" };
        let figures = [
            percent(fit.relative),
            brief(fit.absolute),
            brief(fit.delta_e),
            brief(fit.delta_e_mean),
            format!("{:.1}", studied.nanoseconds),
            format!("{:.2}", studied.ratio),
        ];
        let cells = figures.iter().map(|figure| cell(&escape(figure)));
        row(
            &format!("{}{chosen}", studied.form),
            cells.chain([format!("<td class=\"words\">{}</td>", words.join("<br>"))]),
        )
    };
    let rows: String = entry.forms.iter().map(line).collect();
    let caption = format!("Errors, times and numbers of every form of {}", escape(&entry.preset.id));
    format!(
        "<details><summary>Numbers of every form</summary>{}</details>\n",
        table("", &caption, &head(titles), &rows)
    )
}

/// Six significant digits without trailing zeros.
fn plain(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    format!("{rounded}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use burnish_core::material::preset::{self, Tolerance};

    #[test]
    fn the_angles_run_from_normal_to_grazing() {
        let angles: Vec<f64> = angles().collect();
        assert_eq!((angles[0], angles[angles.len() - 1]), (0.0, 90.0));
        assert!(angles.windows(2).all(|pair| pair[0] < pair[1]), "{angles:?}");
    }

    #[test]
    fn numbers_keep_six_digits() {
        assert_eq!([1.234_567_89, -0.000_012_345_678, 300.0].map(plain), ["1.23457", "-0.0000123457", "300"]);
    }

    #[test]
    fn words_of_a_preset_stay_words() {
        let mut gold = preset::find("Au").unwrap();
        gold.warning = Some("<script>alert(1)</script>".into());
        gold.name = "Gold & \"silver\"".into();
        let study = Study::new(vec![gold], Tolerance::default());
        let html = section(&study, &study.entries[0]);
        assert!(!html.contains("<script") && html.contains("&lt;script&gt;"));
        assert!(html.contains("Gold &amp; &quot;silver&quot;"));
    }
}
