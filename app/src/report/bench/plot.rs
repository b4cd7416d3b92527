//! Panels of time against error, one a scene.

use burnish_core::measure::bench::{Record, pareto};

use super::super::axis::Axis;
use super::super::chart::{Chart, Plot};
use super::{COLORS, Look, MARKERS, label, varied};

/// Width and height of a panel, and of the area between its axes.
const PANEL: [f64; 2] = [500.0, 380.0];
const AREA: [f64; 4] = [64.0, 54.0, 400.0, 270.0];
const COLUMNS: usize = 2;
/// Width and height of an entry of the legend.
const ENTRY: [f64; 2] = [130.0, 18.0];

/// The drawing of all scenes.
pub struct Panels<'a> {
    scenes: &'a [Vec<&'a Record>],
    look: &'a Look,
    /// What has a mark of its own, in order of appearance.
    series: Vec<&'a str>,
}

/// A mark in milliseconds and an error.
struct Mark<'a> {
    record: &'a Record,
    ms: f64,
    error: f64,
}

impl<'a> Panels<'a> {
    pub fn new(scenes: &'a [Vec<&'a Record>], look: &'a Look) -> Panels<'a> {
        let mut panels = Panels { scenes, look, series: Vec::new() };
        for record in scenes.iter().flatten() {
            let name = panels.name(record);
            if !panels.series.contains(&name) {
                panels.series.push(name);
            }
        }
        panels
    }

    /// The series of a record.
    fn name(&self, record: &'a Record) -> &'a str {
        let value = record.settings.iter().find(|(key, _)| Some(key) == self.look.series.as_ref());
        value.map_or(&record.method, |(_, value)| value)
    }

    /// For a page that has the style.
    pub fn svg(&self) -> String {
        self.chart().finish(&self.words())
    }

    /// With a style of its own, for a file.
    pub fn standalone(&self, style: &str) -> String {
        self.chart().standalone(&self.words(), style)
    }

    fn words(&self) -> String {
        let names: Vec<&str> = self.scenes.iter().map(|scene| scene[0].scene.as_str()).collect();
        let measure = self.look.measure.name();
        format!("Time of a frame against {measure} of {} in {}", self.series.join(", "), names.join(", "))
    }

    fn chart(&self) -> Chart {
        let columns = COLUMNS.min(self.scenes.len()).max(1);
        let rows = self.scenes.len().div_ceil(columns).max(1);
        let width = PANEL[0] * columns as f64;
        let in_row = (((width - AREA[0]) / ENTRY[0]) as usize).max(1);
        let head = 12.0 + ENTRY[1] * self.series.len().div_ceil(in_row).max(1) as f64;
        let mut chart = Chart::new(width, head + PANEL[1] * rows as f64);
        for (i, name) in self.series.iter().enumerate() {
            let (x, y) = (AREA[0] + ENTRY[0] * (i % in_row) as f64, 16.0 + ENTRY[1] * (i / in_row) as f64);
            chart.marker(MARKERS[i % MARKERS.len()], (x, y), &class(i, false), "");
            chart.text(x + 9.0, y + 4.0, "", name);
        }
        for (i, scene) in self.scenes.iter().enumerate() {
            let corner = [PANEL[0] * (i % columns) as f64, head + PANEL[1] * (i / columns) as f64];
            self.panel(&mut chart, scene, corner);
        }
        chart
    }

    fn panel(&self, chart: &mut Chart, scene: &[&'a Record], [x, y]: [f64; 2]) {
        let measure = self.look.measure;
        let marks: Vec<Mark<'_>> = scene
            .iter()
            .filter_map(|record| {
                let (errors, _) = record.of(record.region())?;
                Some(Mark { record, ms: 1e3 * record.frame_secs, error: measure.of(&errors) })
            })
            .collect();
        let floor = scene.iter().find_map(|r| r.of(r.region())).map_or(0.0, |(_, floor)| measure.of(&floor));
        let errors = marks.iter().map(|mark| mark.error).chain([floor]).filter(|e| *e > 0.0);
        let area = [x + AREA[0], y + AREA[1], AREA[2], AREA[3]];
        let plot = Plot {
            x: Axis::around("time of a frame, ms", marks.iter().map(|mark| mark.ms)),
            y: Axis::around(measure.title(scene.first().map(|record| record.region())), errors),
            area,
        };
        chart.text(area[0], area[1] - 12.0, "name", &scene[0].scene);
        let [left, top, width, height] = area;
        if floor > 0.0 {
            let (_, line) = plot.at(plot.x.from, floor);
            chart.rect([left, line, width, top + height - line], "band");
        }
        chart.axes(&plot);
        if floor > 0.0 {
            let (_, line) = plot.at(plot.x.from, floor);
            chart.line([(left, line), (left + width, line)], "limit");
            chart.text(left + width - 4.0, line - 4.0, "tick end", "noise of the reference");
        }
        let pairs: Vec<(f64, f64)> = marks.iter().map(|mark| (mark.ms, mark.error.max(floor))).collect();
        let front = pareto(&pairs);
        chart.line(front.iter().map(|i| plot.at(pairs[*i].0, pairs[*i].1)), "front");
        let varied = varied(scene);
        let mut placed: Vec<(f64, f64)> = Vec::new();
        for (mark, pair) in marks.iter().zip(&pairs) {
            let name = self.name(mark.record);
            let series = self.series.iter().position(|known| *known == name).unwrap_or(0);
            let at = plot.at(pair.0, pair.1);
            let words = label(mark.record, &varied);
            let told = format!("{words}: {:.3} ms, {} {:.3e}", mark.ms, measure.name(), mark.error);
            let hollow = mark.error <= floor;
            chart.marker(MARKERS[series % MARKERS.len()], at, &class(series, hollow), &told);
            // The series is told by its mark; words that would lie on others are left to the pointer.
            let short = words.split_once(", ").map_or("", |(_, settings)| settings);
            let of_series = self.look.series.as_ref().map(|key| format!("{key} {name}"));
            let short: Vec<&str> = short.split(", ").filter(|part| Some(*part) != of_series.as_deref()).collect();
            let short = short.join(", ");
            let free = placed.iter().all(|(px, py)| (px - at.0).abs() > 60.0 || (py - at.1).abs() > 11.0);
            if !short.is_empty() && free {
                let right = at.0 > left + 0.8 * width;
                let (dx, style) = if right { (-8.0, "tick end") } else { (8.0, "tick") };
                chart.text(at.0 + dx, at.1 - 5.0, style, &short);
                placed.push(at);
            }
        }
    }
}

/// Colours move on by one when the shapes begin again: no two of the first 49 look the same.
fn class(series: usize, hollow: bool) -> String {
    let colors = COLORS.len() + 1;
    format!("m{}{}", (series + series / MARKERS.len()) % colors, if hollow { " hollow" } else { "" })
}

#[cfg(test)]
mod tests {
    use super::super::tests::record;
    use super::super::{Measure, by_scene};
    use super::*;

    #[test]
    fn every_record_has_a_mark_and_what_is_noise_a_hollow_one() {
        let records = [
            record("ring", "classical", 0, 20.0, 0.02),
            record("ring", "classical", 64, 90.0, 5e-5),
            record("ring", "reference", 1, 300.0, 0.4),
            record("room", "reference", 4, 800.0, 0.1),
        ];
        let svg = Panels::new(&by_scene(&records), &Look::default()).standalone("svg{}");
        // One a record and one a method in the legend.
        assert_eq!(svg.matches("class=\"mark ").count(), 4 + 2);
        assert_eq!(svg.matches("hollow").count(), 1);
        assert!(svg.starts_with("<svg xmlns=") && svg.contains("samples 64"), "{svg}");
        // The front goes over the two lookups; paths are dearer and no better.
        assert_eq!(svg.matches("class=\"front\"").count(), 2);
    }

    #[test]
    fn values_of_a_setting_have_marks_of_their_own_and_errors_are_those_asked_for() {
        let mut records = vec![record("ring", "other", 0, 20.0, 0.02)];
        records[0].settings.clear();
        records.extend((0..20).map(|i| record("ring", "classical", i, 20.0 + f64::from(i), 0.02)));
        let look = Look { measure: Measure::Flip, series: Some("samples".into()) };
        let svg = Panels::new(&by_scene(&records), &look).standalone("svg{}");
        assert_eq!(svg.matches("class=\"mark ").count(), 21 + 21);
        assert!(svg.contains("FLIP on the subject") && svg.contains("FLIP 1.000e-1") && svg.contains(">19</text>"));
        assert!(!svg.contains("relMSE") && !svg.contains(">samples 3</text>"), "{svg}");
        let looks: std::collections::BTreeSet<String> =
            (0..49).map(|i| format!("{} {:?}", class(i, false), MARKERS[i % MARKERS.len()])).collect();
        assert_eq!(looks.len(), 49);
    }
}
