//! Panels of time against error, one a scene.

use burnish_core::measure::bench::{Record, Region, pareto};

use super::super::axis::Axis;
use super::super::chart::{Chart, Plot};
use super::{MARKERS, label, varied};

/// Width and height of a panel, and of the area between its axes.
const PANEL: [f64; 2] = [500.0, 380.0];
const AREA: [f64; 4] = [64.0, 54.0, 400.0, 270.0];
const COLUMNS: usize = 2;

/// The drawing of all scenes.
pub struct Panels<'a> {
    scenes: &'a [Vec<&'a Record>],
    /// All methods, in order of appearance.
    methods: Vec<&'a str>,
}

/// A mark in milliseconds and relMSE.
struct Mark<'a> {
    record: &'a Record,
    ms: f64,
    error: f64,
}

impl<'a> Panels<'a> {
    pub fn new(scenes: &'a [Vec<&'a Record>]) -> Panels<'a> {
        let mut methods: Vec<&str> = Vec::new();
        for record in scenes.iter().flatten() {
            if !methods.contains(&record.method.as_str()) {
                methods.push(&record.method);
            }
        }
        Panels { scenes, methods }
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
        format!("Time of a frame against relMSE of {} in {}", self.methods.join(", "), names.join(", "))
    }

    fn chart(&self) -> Chart {
        let columns = COLUMNS.min(self.scenes.len()).max(1);
        let rows = self.scenes.len().div_ceil(columns).max(1);
        let mut chart = Chart::new(PANEL[0] * columns as f64, 30.0 + PANEL[1] * rows as f64);
        for (i, method) in self.methods.iter().enumerate() {
            let x = AREA[0] + 130.0 * i as f64;
            chart.marker(MARKERS[i % MARKERS.len()], (x, 16.0), &class(i, false), "");
            chart.text(x + 9.0, 20.0, "", method);
        }
        for (i, scene) in self.scenes.iter().enumerate() {
            let corner = [PANEL[0] * (i % columns) as f64, 30.0 + PANEL[1] * (i / columns) as f64];
            self.panel(&mut chart, scene, corner);
        }
        chart
    }

    fn panel(&self, chart: &mut Chart, scene: &[&Record], [x, y]: [f64; 2]) {
        let marks: Vec<Mark<'_>> = scene
            .iter()
            .filter_map(|record| {
                let (errors, _) = record.of(record.region())?;
                Some(Mark { record, ms: 1e3 * record.frame_secs, error: errors.relmse })
            })
            .collect();
        let floor = scene.iter().find_map(|r| r.of(r.region())).map_or(0.0, |(_, floor)| floor.relmse);
        let errors = marks.iter().map(|mark| mark.error).chain([floor]).filter(|e| *e > 0.0);
        let area = [x + AREA[0], y + AREA[1], AREA[2], AREA[3]];
        let plot = Plot {
            x: Axis::decades("time of a frame, ms", marks.iter().map(|mark| mark.ms)),
            y: Axis::decades(on_what(scene), errors),
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
            let method = self.methods.iter().position(|method| *method == mark.record.method).unwrap_or(0);
            let at = plot.at(pair.0, pair.1);
            let words = label(mark.record, &varied);
            let told = format!("{words}: {:.3} ms, relMSE {:.3e}", mark.ms, mark.error);
            chart.marker(MARKERS[method % MARKERS.len()], at, &class(method, mark.record.is_under_floor()), &told);
            // The method is told by its mark; words that would lie on others are left to the pointer.
            let short = words.split_once(", ").map_or("", |(_, settings)| settings);
            let free = placed.iter().all(|(px, py)| (px - at.0).abs() > 60.0 || (py - at.1).abs() > 11.0);
            if !short.is_empty() && free {
                let right = at.0 > left + 0.8 * width;
                let (dx, style) = if right { (-8.0, "tick end") } else { (8.0, "tick") };
                chart.text(at.0 + dx, at.1 - 5.0, style, short);
                placed.push(at);
            }
        }
    }
}

fn class(method: usize, under_floor: bool) -> String {
    format!("m{}{}", method % MARKERS.len(), if under_floor { " hollow" } else { "" })
}

fn on_what(scene: &[&Record]) -> &'static str {
    match scene.first().map(|record| record.region()) {
        Some(Region::Frame) => "relMSE of the frame",
        _ => "relMSE on the subject",
    }
}

#[cfg(test)]
mod tests {
    use super::super::by_scene;
    use super::super::tests::record;
    use super::*;

    #[test]
    fn every_record_has_a_mark_and_what_is_noise_a_hollow_one() {
        let records = [
            record("ring", "classical", 0, 20.0, 0.02),
            record("ring", "classical", 64, 90.0, 5e-5),
            record("ring", "reference", 1, 300.0, 0.4),
            record("room", "reference", 4, 800.0, 0.1),
        ];
        let svg = Panels::new(&by_scene(&records)).standalone("svg{}");
        // One a record and one a method in the legend.
        assert_eq!(svg.matches("class=\"mark ").count(), 4 + 2);
        assert_eq!(svg.matches("hollow").count(), 1);
        assert!(svg.starts_with("<svg xmlns=") && svg.contains("samples 64"), "{svg}");
        // The front goes over the two lookups; paths are dearer and no better.
        assert_eq!(svg.matches("class=\"front\"").count(), 2);
    }
}
