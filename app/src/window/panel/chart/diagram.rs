//! Where the marks of a chart lie: pure numbers, painted by [`super::plot`].

use burnish_core::measure::bench::{Record, Region, pareto};
use eframe::egui::{Pos2, Rect, pos2};

use crate::number::short;
use crate::report::axis::{Axis, tick};
use crate::report::bench::varied;
use crate::window::chart::ErrorMeasure;

/// Points around a mark in which it is hit.
const REACH: f32 = 12.0;

/// A record as a mark.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Place among the records.
    pub record: usize,
    /// Place among the methods of the diagram.
    pub method: usize,
    /// Milliseconds of a frame.
    pub ms: f64,
    /// Error, 0 or more.
    pub error: f64,
    /// The error is within the noise of the reference and tells nothing.
    pub hollow: bool,
    /// What varies, `samples=16`.
    pub settings: String,
    /// Method, settings, time and error in words.
    pub label: String,
}

/// Marks between two axes.
#[derive(Clone, Debug)]
pub struct Diagram {
    /// Milliseconds.
    pub x: Axis,
    /// Errors.
    pub y: Axis,
    /// In the order of the records.
    pub marks: Vec<Mark>,
    /// Marks that no other beats in both, by ascending time.
    pub front: Vec<usize>,
    /// What the noise of the reference adds to errors, 0 where it is not known.
    pub floor: f64,
    /// Ids of the methods, in order of appearance.
    pub methods: Vec<String>,
    /// What y is.
    pub title: String,
}

impl Diagram {
    /// The chart of records in a region; the frame where it has no pixels.
    pub fn new(records: &[Record], measure: ErrorMeasure, region: Region) -> Diagram {
        let has_pixels = records.iter().all(|record| record.of(region).is_some());
        let region = if has_pixels { region } else { Region::Frame };
        let mut methods: Vec<String> = Vec::new();
        for record in records {
            if !methods.contains(&record.method) {
                methods.push(record.method.clone());
            }
        }
        let all: Vec<&Record> = records.iter().collect();
        let varied = varied(&all);
        let mark = |(index, record): (usize, &Record)| {
            let (errors, floor) = record.of(region)?;
            let [error, floor] = [&errors, &floor].map(|errors| measure.of(errors));
            let method = methods.iter().position(|id| *id == record.method)?;
            let told = record.settings.iter().filter(|(key, _)| varied.contains(&(record.method.clone(), key.clone())));
            let settings = told.map(|(key, value)| format!("{key}={value}")).collect::<Vec<_>>().join(" ");
            let ms = 1e3 * record.frame_secs;
            let name = [record.method.as_str(), &settings].join(" ");
            let label = format!("{}: {} ms, {} {}", name.trim_end(), short(ms), measure.title(), short(error));
            Some(Mark { record: index, method, ms, error, hollow: error <= floor, settings, label })
        };
        let marks: Vec<Mark> = records.iter().enumerate().filter_map(mark).collect();
        let floor = records.iter().find_map(|r| r.of(region)).map_or(0.0, |(_, floor)| measure.of(&floor));
        let pairs: Vec<(f64, f64)> = marks.iter().map(|mark| (mark.ms, mark.error.max(floor))).collect();
        let title = match region {
            Region::Frame => format!("{} of the frame", measure.title()),
            Region::Subject => format!("{} on the subject", measure.title()),
            Region::Interior => format!("{} on the subject without its silhouettes", measure.title()),
        };
        Diagram {
            x: Axis::decades("ms per frame", pairs.iter().map(|pair| pair.0)),
            y: Axis::decades("", pairs.iter().map(|pair| pair.1).chain([floor])),
            front: pareto(&pairs),
            marks,
            floor,
            methods,
            title,
        }
    }

    /// Where a pair of values lies in an area.
    pub fn at(&self, area: Rect, ms: f64, error: f64) -> Pos2 {
        let (x, y) = (self.x.at(ms) as f32, self.y.at(error) as f32);
        pos2(area.left() + x * area.width(), area.bottom() - y * area.height())
    }

    /// Where a mark lies; one within the noise stands on its line.
    pub fn place(&self, area: Rect, mark: &Mark) -> Pos2 {
        self.at(area, mark.ms, mark.error.max(self.floor))
    }

    /// The mark that is nearest to a point, where it is near enough.
    pub fn hit(&self, area: Rect, point: Pos2) -> Option<usize> {
        let distances = self.marks.iter().map(|mark| self.place(area, mark).distance(point));
        let nearest = distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
        nearest.filter(|(_, distance)| *distance <= REACH).map(|(index, _)| index)
    }
}

/// A power of ten as it stands at an axis.
pub fn power(value: f64) -> String {
    match value {
        v if (1e-3..1e6).contains(&(v * 1.000_001)) => tick(v),
        v => format!("1e{:.0}", v.log10()).replace('-', "\u{2212}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::bench::tests::record;
    use eframe::egui::vec2;

    fn diagram() -> Diagram {
        let records = [
            record("ring", "classical", 0, 20.0, 0.02),
            record("ring", "classical", 64, 90.0, 5e-5),
            record("ring", "reference", 1, 300.0, 0.4),
        ];
        Diagram::new(&records, ErrorMeasure::RelMse, Region::Subject)
    }

    fn area() -> Rect {
        Rect::from_min_size(pos2(100.0, 50.0), vec2(200.0, 300.0))
    }

    #[test]
    fn marks_lie_on_decades_and_noise_on_its_line() {
        let diagram = diagram();
        assert_eq!(diagram.methods, ["classical", "reference"]);
        assert_eq!((diagram.x.from, diagram.x.to), (10.0, 1000.0));
        assert_eq!(diagram.floor, 1e-4);
        assert_eq!(diagram.at(area(), 100.0, diagram.y.to), pos2(200.0, 50.0));
        assert_eq!(diagram.at(area(), 10.0, diagram.y.from), pos2(100.0, 350.0));
        let hollow: Vec<bool> = diagram.marks.iter().map(|mark| mark.hollow).collect();
        assert_eq!(hollow, [false, true, false]);
        let line = diagram.at(area(), 90.0, diagram.floor);
        assert_eq!(diagram.place(area(), &diagram.marks[1]), line);
        assert_eq!(diagram.front, [0, 1], "paths are dearer and no better");
    }

    #[test]
    fn labels_tell_what_varies_with_time_and_error() {
        let labels: Vec<String> = diagram().marks.into_iter().map(|mark| mark.label).collect();
        assert_eq!(labels[0], "classical samples=0: 20 ms, relMSE 0.02");
        assert_eq!(labels[2], "reference: 300 ms, relMSE 0.4");
    }

    #[test]
    fn the_nearest_mark_is_hit_and_none_from_afar() {
        let diagram = diagram();
        let places: Vec<Pos2> = diagram.marks.iter().map(|mark| diagram.place(area(), mark)).collect();
        for (index, place) in places.iter().enumerate() {
            assert_eq!(diagram.hit(area(), *place + vec2(4.0, -3.0)), Some(index));
        }
        assert_eq!(diagram.hit(area(), places[0] + vec2(-30.0, -30.0)), None);
    }

    #[test]
    fn a_region_without_pixels_gives_way_to_the_frame_and_nothing_is_no_chart() {
        let records = [record("ring", "classical", 0, 20.0, 0.02)];
        assert!(Diagram::new(&records, ErrorMeasure::Flip, Region::Interior).title.contains("frame"));
        let empty = Diagram::new(&[], ErrorMeasure::Flip, Region::Subject);
        assert!(empty.marks.is_empty() && empty.hit(area(), pos2(150.0, 100.0)).is_none());
    }

    #[test]
    fn powers_are_short() {
        let values = [1e-7, 1e-4, 1e-3, 0.1, 1.0, 1000.0, 1e6];
        assert_eq!(values.map(power), ["1e\u{2212}7", "1e\u{2212}4", "0.001", "0.1", "1", "1000", "1e6"]);
    }
}
