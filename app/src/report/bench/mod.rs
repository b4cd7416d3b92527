//! What the bench measured: a chart of time against error for every scene, and a page with all figures.

mod plot;

use std::fmt::Write as _;

use burnish_core::lighting::Method;
use burnish_core::measure::Errors;
use burnish_core::measure::bench::{Record, Region};

use super::chart::Marker;
use super::html::{cell, escape, head, row, table};
use crate::number::three_digits;
use plot::Panels;

/// Marks of methods in the order in which they appear.
pub const MARKERS: [Marker; 7] =
    [Marker::Circle, Marker::Square, Marker::Diamond, Marker::Up, Marker::Down, Marker::Star, Marker::Plus];

/// Their colours, of Okabe and Ito, sRGB: the classes `m0` to `m5` of the style. One more has the colour of the text.
pub const COLORS: [[u8; 3]; 6] =
    [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [230, 159, 0], [86, 180, 233]];

/// Records of one scene, in their order.
fn by_scene(records: &[Record]) -> Vec<Vec<&Record>> {
    let mut scenes: Vec<Vec<&Record>> = Vec::new();
    for record in records {
        match scenes.iter_mut().find(|scene| scene[0].scene == record.scene) {
            Some(scene) => scene.push(record),
            None => scenes.push(vec![record]),
        }
    }
    scenes
}

/// What errors a drawing tells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Measure {
    /// Mean of squares relative to those of the reference.
    #[default]
    Relmse,
    /// Mean of the FLIP map.
    Flip,
}

impl Measure {
    fn of(self, errors: &Errors) -> f64 {
        match self {
            Measure::Relmse => errors.relmse,
            Measure::Flip => errors.flip,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Measure::Relmse => "relMSE",
            Measure::Flip => "FLIP",
        }
    }

    /// Title of an axis of errors on a region.
    fn title(self, region: Option<Region>) -> &'static str {
        match (self, region) {
            (Measure::Relmse, Some(Region::Frame)) => "relMSE of the frame",
            (Measure::Relmse, _) => "relMSE on the subject",
            (Measure::Flip, Some(Region::Frame)) => "FLIP of the frame",
            (Measure::Flip, _) => "FLIP on the subject",
        }
    }
}

/// What the drawing shows of records.
#[derive(Clone, Debug, Default)]
pub struct Look {
    /// The errors.
    pub measure: Measure,
    /// The setting whose values have a mark each, where a method has it; else methods have one.
    pub series: Option<String>,
}

/// All scenes as one drawing that stands alone, with its style inside.
pub fn drawing(records: &[Record], look: &Look) -> String {
    Panels::new(&by_scene(records), look).standalone(include_str!("../style.css"))
}

/// A page with the drawing, tables of all figures and what each method does; no scripts, nothing to load.
pub fn page(records: &[Record], methods: &[&dyn Method], look: &Look, command: &str) -> String {
    let scenes = by_scene(records);
    let mut html = String::from("<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n");
    html +=
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>Time against error</title>\n";
    let _ = write!(html, "<style>\n{}</style>\n</head>\n<body>\n<main>\n", include_str!("../style.css"));
    let _ = write!(
        html,
        "<h1>Time against error</h1>\n<p class=\"soft\">Burnish {}</p>\n<p>Each mark is a lighting method with settings. Its \
         error is that of the mean of 16 jittered frames, or of a path-traced picture, against the reference; its time is that \
         of one frame. Nothing that lies right of and above another mark is worth choosing: the line joins the others. The \
         shaded part is the noise of the reference itself, where errors tell nothing; marks in it are hollow.</p>\n\
         <p>Made by <code>{}</code></p>\n<figure>{}</figure>\n",
        env!("CARGO_PKG_VERSION"),
        escape(command),
        Panels::new(&scenes, look).svg()
    );
    for scene in &scenes {
        html += &section(scene);
    }
    html += "<h2>Methods</h2>\n";
    let titles = ["method", "lamps", "environment", "indirect diffuse", "indirect glossy", "emission", "what it does"];
    let used = methods.iter().map(|m| m.info()).filter(|info| records.iter().any(|r| r.method == info.id.0));
    let rows: String = used
        .map(|info| {
            let covers = info.coverage.terms().map(|(_, cover, _)| cell(cover.word()));
            let words = format!("<td class=\"words\">{}</td>", escape(info.summary));
            row(&escape(info.title), covers.into_iter().chain([words]))
        })
        .collect();
    html += &table("", "How well each term of the light is done", &head(titles), &rows);
    html + "</main>\n</body>\n</html>\n"
}

/// The figures of a scene.
fn section(scene: &[&Record]) -> String {
    let first = scene[0];
    let mut html = format!(
        "<h2>{}</h2>\n<p>{} x {} pixels; reference of {} paths a pixel{}.</p>\n",
        escape(&first.scene),
        first.width,
        first.height,
        first.truth_samples,
        escape(&first.truth_text())
    );
    let varied = varied(scene);
    let titles =
        ["method and settings", "prepare, s", "memory, MB", "frame, ms", "x calibration", "frames"].into_iter();
    let costs = |r: &Record| {
        let numbers = [r.prepare_secs, r.bytes.map_or(f64::NAN, |b| b as f64 / 1e6), 1e3 * r.frame_secs, r.ratio()];
        numbers.map(|v| cell(&three_digits(v))).into_iter().chain([cell(&r.frames.to_string())])
    };
    let rows: String = scene.iter().map(|r| row(&escape(&label(r, &varied)), costs(r))).collect();
    html += &table("", "What it costs", &head(titles), &rows);
    for region in Region::ALL {
        let Some((_, floor)) = first.of(region) else { continue };
        let titles = ["method and settings", "relMSE", "FLIP", "FLIP, 99 %", "bias, %", "difference, %", "worst 1 %"];
        let measures = |e: &Errors| [e.relmse, e.flip, e.flip_p99, 100.0 * e.bias, 100.0 * e.difference, e.worst];
        let floors = measures(&floor);
        let line = |r: &&Record| {
            let found = r.of(region).map_or([f64::NAN; 6], |(errors, _)| measures(&errors));
            let cells = found.iter().zip(floors).map(|(value, floor)| {
                let under = value.abs() <= floor;
                let mark =
                    if under { " <span title=\"within the noise of the reference\">\u{2248}</span>" } else { "" };
                cell(&(three_digits(*value) + mark))
            });
            row(&escape(&label(r, &varied)), cells.collect::<Vec<_>>())
        };
        let noise = row("noise of the reference", floors.map(|v| cell(&three_digits(v))));
        let rows: String = scene.iter().map(line).chain([noise]).collect();
        let what = match region {
            Region::Frame => "Errors on all pixels",
            Region::Subject => "Errors on the pixels of the subject",
            Region::Interior => "Errors on the subject without its silhouettes",
        };
        html += &table("", what, &head(titles), &rows);
    }
    html
}

/// Settings that differ between records of a method in a scene.
pub fn varied(scene: &[&Record]) -> Vec<(String, String)> {
    let mut keys = Vec::new();
    for record in scene {
        for (key, value) in &record.settings {
            let others = scene.iter().filter(|other| other.method == record.method);
            let differs = others.flat_map(|other| &other.settings).any(|(k, v)| k == key && v != value);
            let pair = (record.method.clone(), key.clone());
            if differs && !keys.contains(&pair) {
                keys.push(pair);
            }
        }
    }
    keys
}

/// A record by its method and what makes it different from the others.
fn label(record: &Record, varied: &[(String, String)]) -> String {
    let told = record.settings.iter().filter(|(key, _)| varied.contains(&(record.method.clone(), key.clone())));
    let told: Vec<String> = told.map(|(key, value)| format!("{key} {value}")).collect();
    if told.is_empty() { record.method.clone() } else { format!("{}, {}", record.method, told.join(", ")) }
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use burnish_core::lighting::METHODS;

    pub fn record(scene: &str, method: &str, samples: u32, ms: f64, relmse: f64) -> Record {
        let errors = Errors { relmse, flip: 0.1, flip_p99: 0.3, bias: -0.02, difference: 0.05, worst: 3.0 * relmse };
        let floor = Errors { relmse: 1e-4, flip: 1e-3, flip_p99: 2e-3, bias: 1e-4, difference: 1e-3, worst: 1e-3 };
        Record {
            scene: scene.into(),
            method: method.into(),
            settings: vec![("samples".into(), samples.to_string()), ("masking".into(), "correlated".into())],
            width: 320,
            height: 180,
            prepare_secs: 0.5,
            bytes: None,
            frame_secs: 1e-3 * ms,
            calibration_secs: 0.01,
            frames: 20,
            compared_frames: 16,
            errors: [Some(errors), Some(errors), None],
            floors: [Some(floor), Some(floor), None],
            truth_samples: 512,
            truth_settings: vec![("clamp".into(), "10".into())],
        }
    }

    #[test]
    fn the_style_has_the_colours_of_methods() {
        let style = include_str!("../style.css");
        for (index, [r, g, b]) in COLORS.into_iter().enumerate() {
            assert!(style.contains(&format!(".m{index}{{color:#{r:02x}{g:02x}{b:02x}}}")), "{index}");
        }
        assert!(style.contains(".m6{color:var(--fg)}") && COLORS.len() + 1 == MARKERS.len());
    }

    #[test]
    fn the_page_has_every_record_and_says_what_is_noise() {
        let records = [
            record("gallery:ring", "classical", 0, 20.0, 0.02),
            record("gallery:ring", "classical", 64, 90.0, 5e-5),
            record("a <b>", "reference", 1, 300.0, 0.4),
        ];
        let html = page(&records, METHODS, &Look::default(), "burnish chart <x>");
        assert_eq!(html.matches("<h2>").count(), 3);
        assert!(html.contains("classical, samples 64") && html.contains("a &lt;b&gt;") && !html.contains("<b>\""));
        assert!(html.contains("reference of 512 paths a pixel, with clamp=10."));
        assert!(html.contains("\u{2248}") && html.contains("burnish chart &lt;x&gt;"));
        assert_eq!(html.matches("Errors on the subject without").count(), 0);
        assert!(html.contains("Unidirectional path tracing"));
    }
}
