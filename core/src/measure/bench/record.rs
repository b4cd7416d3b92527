//! What was measured of one candidate, and tables of it.

use serde::{Deserialize, Serialize};

use crate::measure::Errors;

/// Part of a picture on which errors are told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Region {
    /// All pixels.
    Frame,
    /// Pixels that show what the picture is about.
    Subject,
    /// Those of them whose neighbours all do: without silhouettes.
    Interior,
}

impl Region {
    /// In the order of [`Record::errors`].
    pub const ALL: [Region; 3] = [Region::Frame, Region::Subject, Region::Interior];

    /// Name in tables.
    pub fn word(self) -> &'static str {
        match self {
            Region::Frame => "frame",
            Region::Subject => "subject",
            Region::Interior => "interior",
        }
    }
}

/// The measured cost and errors of a method with settings on one scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Name of the scene.
    pub scene: String,
    /// Id of the method.
    pub method: String,
    /// Every setting with its value as text.
    pub settings: Vec<(String, String)>,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Seconds before the first frame.
    pub prepare_secs: f64,
    /// Memory that the method keeps, where known.
    pub bytes: Option<u64>,
    /// Median seconds of a frame.
    pub frame_secs: f64,
    /// Median seconds of the calibration pass between its frames.
    pub calibration_secs: f64,
    /// Frames that were timed.
    pub frames: usize,
    /// Jittered frames whose mean was compared.
    pub compared_frames: u32,
    /// Errors in each of [`Region::ALL`]; absent where it has no pixels.
    pub errors: [Option<Errors>; 3],
    /// What the noise of the truth adds to each.
    pub floors: [Option<Errors>; 3],
    /// Paths a pixel of the truth.
    pub truth_samples: u32,
    /// Settings of the truth that are not default.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub truth_settings: Vec<(String, String)>,
}

/// Measures of [`Errors`] with their names in tables.
type Measure = (&'static str, fn(&Errors) -> f64);
const MEASURES: [Measure; 6] = [
    ("relmse", |e| e.relmse),
    ("flip", |e| e.flip),
    ("flip_p99", |e| e.flip_p99),
    ("bias", |e| e.bias),
    ("difference", |e| e.difference),
    ("worst", |e| e.worst),
];

/// Columns of [`csv`] before those of errors.
pub const COLUMNS: [&str; 14] = [
    "scene",
    "method",
    "settings",
    "width",
    "height",
    "prepare_s",
    "memory_bytes",
    "frame_ms",
    "frame_ratio",
    "frames",
    "compared_frames",
    "truth_samples",
    "truth_settings",
    "under_floor",
];

impl Record {
    /// Time of a frame as a multiple of the calibration pass of the same run.
    pub fn ratio(&self) -> f64 {
        self.frame_secs / self.calibration_secs
    }

    /// The region that a chart is about: the subject, or the frame where no subject is seen.
    pub fn region(&self) -> Region {
        if self.errors[Region::Subject as usize].is_some() { Region::Subject } else { Region::Frame }
    }

    /// Errors and their floor in a region.
    pub fn of(&self, region: Region) -> Option<(Errors, Errors)> {
        self.errors[region as usize].zip(self.floors[region as usize])
    }

    /// True when the relMSE of the charted region is not above what the truth's own noise makes.
    pub fn is_under_floor(&self) -> bool {
        self.of(self.region()).is_some_and(|(errors, floor)| errors.relmse <= floor.relmse)
    }

    /// All settings as `key=value` with spaces between.
    pub fn settings_text(&self) -> String {
        words(&self.settings)
    }

    /// `, with key=value` for what is not default of the settings of the truth; empty where all is.
    pub fn truth_text(&self) -> String {
        if self.truth_settings.is_empty() { String::new() } else { format!(", with {}", words(&self.truth_settings)) }
    }
}

fn words(settings: &[(String, String)]) -> String {
    settings.iter().map(|(key, value)| format!("{key}={value}")).collect::<Vec<_>>().join(" ")
}

/// A table of comma-separated values with a line of column names: [`COLUMNS`], then `region_measure` and
/// `region_measure_floor` for every region and measure. Numbers have all their digits; what is not known is empty.
pub fn csv(records: &[Record]) -> String {
    let mut head: Vec<String> = COLUMNS.map(String::from).into();
    for region in Region::ALL {
        for (measure, _) in MEASURES {
            head.push(format!("{}_{measure}", region.word()));
            head.push(format!("{}_{measure}_floor", region.word()));
        }
    }
    let mut text = head.join(",") + "\n";
    for record in records {
        let number = |value: f64| if value.is_finite() { value.to_string() } else { String::new() };
        let mut cells = vec![
            quoted(&record.scene),
            quoted(&record.method),
            quoted(&record.settings_text()),
            record.width.to_string(),
            record.height.to_string(),
            number(record.prepare_secs),
            record.bytes.map_or(String::new(), |bytes| bytes.to_string()),
            number(1e3 * record.frame_secs),
            number(record.ratio()),
            record.frames.to_string(),
            record.compared_frames.to_string(),
            record.truth_samples.to_string(),
            quoted(&words(&record.truth_settings)),
            if record.is_under_floor() { "yes" } else { "no" }.to_string(),
        ];
        for region in Region::ALL {
            let found = record.of(region);
            for (_, measure) in MEASURES {
                cells.push(found.map_or(String::new(), |(errors, _)| number(measure(&errors))));
                cells.push(found.map_or(String::new(), |(_, floor)| number(measure(&floor))));
            }
        }
        text += &(cells.join(",") + "\n");
    }
    text
}

/// A text as a cell: in quotes, where commas, quotes or line breaks ask for them.
fn quoted(text: &str) -> String {
    let plain = !text.contains([',', '"', '\n', '\r']);
    if plain { text.into() } else { format!("\"{}\"", text.replace('"', "\"\"")) }
}
