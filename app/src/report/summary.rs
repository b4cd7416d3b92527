//! The charts over all metals.

use burnish_core::surface::fresnel::Form;

use super::axis::{Axis, tick};
use super::chart::{Chart, Plot};
use super::looks::{brief, class, marker, percent};
use super::study::{Entry, Study, Summary, quantile};

/// Forms of the chart of colour differences, the sampled one first.
const COMPARED: [Form; 6] =
    [Form::SampledNk, Form::EffectiveNk, Form::Rescaled, Form::F82, Form::Fitted, Form::Series3];

/// Bins of a histogram in a decade.
const BINS: i32 = 4;
/// Decades of the histograms: 0.01 % to 100 %.
const DECADES: [i32; 2] = [-2, 2];

/// Histograms of the largest relative errors, one for each form but the truth.
pub fn histograms(study: &Study, summaries: &[Summary]) -> String {
    const COLUMNS: usize = 3;
    let shown: Vec<&Summary> = summaries.iter().filter(|s| s.form != Form::Spectral).collect();
    let counts: Vec<Vec<usize>> = shown.iter().map(|s| bins(&s.errors)).collect();
    let most = counts.iter().flatten().copied().max().unwrap_or(1).max(1);
    let step = [1, 2, 5, 10, 20, 50].into_iter().find(|step| most / step <= 4).unwrap_or(100);
    let top = most.div_ceil(step) * step;
    let mut chart = Chart::new(1100.0, 152.0 * shown.len().div_ceil(COLUMNS) as f64);
    for (i, (summary, counts)) in shown.iter().zip(&counts).enumerate() {
        let (column, row) = ((i % COLUMNS) as f64, (i / COLUMNS) as f64);
        let plot = Plot {
            x: Axis::log("largest relative error, %", 10f64.powi(DECADES[0]), 10f64.powi(DECADES[1])),
            y: Axis::linear("metals", 0.0, top as f64, step as f64),
            area: [50.0 + 366.0 * column, 22.0 + 152.0 * row, 300.0, 86.0],
        };
        let [left, top, _, height] = plot.area;
        let limit = plot.at(100.0 * study.tolerance.relative, 0.0).0;
        chart.rect([left, top, limit - left, height], "band");
        chart.axes(&plot);
        for (bin, &count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
            let edge = |bin: usize| 10f64.powf(f64::from(DECADES[0]) + bin as f64 / f64::from(BINS));
            let ((x0, y0), (x1, y1)) = (plot.at(edge(bin), 0.0), plot.at(edge(bin + 1), count as f64));
            chart.rect([x0 + 0.5, y1, x1 - x0 - 1.0, y0 - y1], &format!("bar {}", class(summary.form)));
        }
        let within = summary.errors.iter().filter(|e| **e <= study.tolerance.relative).count();
        let words =
            format!("{} of {} within {} %", within, summary.errors.len(), tick(100.0 * study.tolerance.relative));
        chart.text(left, top - 6.0, "name", summary.form.id());
        chart.text(left + 300.0, top - 6.0, "tick end", &words);
    }
    chart.finish("Histograms of the largest relative error over all metals, one for each form")
}

/// Numbers of errors in each bin; what lies beyond the ends is in the outermost.
fn bins(errors: &[f64]) -> Vec<usize> {
    let count = (DECADES[1] - DECADES[0]) * BINS;
    let mut counts = vec![0; count as usize];
    for error in errors {
        let place = ((100.0 * error).log10() - f64::from(DECADES[0])) * f64::from(BINS);
        if let Some(bin) = counts.get_mut(place.floor().clamp(0.0, f64::from(count - 1)) as usize) {
            *bin += 1;
        }
    }
    counts
}

/// The largest CIEDE2000 of some forms for each metal, those with the largest of the sampled form on top.
pub fn delta_e(study: &Study) -> String {
    let largest = |entry: &Entry, form: Form| entry.studied(form).map_or(0.0, |s| s.fit.delta_e);
    let mut entries: Vec<&Entry> = study.entries.iter().collect();
    entries.sort_by(|a, b| largest(b, Form::SampledNk).total_cmp(&largest(a, Form::SampledNk)));
    let height = 17.0 * entries.len() as f64;
    let mut chart = Chart::new(1100.0, height + 70.0);
    let x = Axis::log("largest CIEDE2000 on a ball, against the spectral curve", 0.01, 50.0);
    let plot = Plot { x, y: Axis::linear("", 0.0, 1.0, 2.0), area: [190.0, 30.0, 880.0, height] };
    let limit = plot.at(study.tolerance.delta_e, 0.0).0;
    chart.rect([190.0, 30.0, limit - 190.0, height], "band");
    chart.axes(&Plot { y: Axis { ticks: Vec::new(), ..plot.y.clone() }, x: plot.x.clone(), area: plot.area });
    for (i, form) in COMPARED.into_iter().enumerate() {
        let at = 200.0 + 145.0 * i as f64;
        chart.marker(marker(form), (at, 14.0), &class(form), "");
        chart.text(at + 10.0, 18.0, "", form.id());
    }
    for (i, entry) in entries.into_iter().enumerate() {
        let y = 30.0 + 17.0 * (i as f64 + 0.5);
        let at = |form: Form| (plot.at(largest(entry, form), 0.0).0, y);
        chart.text(184.0, y + 4.0, "end", &entry.preset.id);
        chart.line([(190.0, y), at(Form::SampledNk)], &format!("range {}", class(Form::SampledNk)));
        for form in COMPARED.into_iter().rev() {
            let words = format!("{} {}: {}", entry.preset.id, form.id(), brief(largest(entry, form)));
            chart.marker(marker(form), at(form), &class(form), &words);
        }
    }
    chart.finish("Largest colour difference of some forms from the spectral curve, for each metal; the section of each metal has the numbers")
}

/// Time of an evaluation against error, both in decades: the median over the metals, with bars from the least to the
/// largest error.
pub fn trade(study: &Study, summaries: &[Summary]) -> String {
    let times = summaries.iter().map(|s| s.nanoseconds).filter(|t| *t > 0.0);
    let (least, most) = times.fold((f64::INFINITY, 0.0f64), |(least, most), t| (least.min(t), most.max(t)));
    let (from, to) =
        (10f64.powf((least.log10() * 4.0 - 0.5).floor() / 4.0), 10f64.powf((most.log10() * 4.0 + 0.6).ceil() / 4.0));
    let mut x = Axis::log("time of one evaluation of R, G and B, ns", from, to);
    x.ticks = steps_125(from, to);
    let y = Axis::log("largest relative error, %", 0.001, 100.0);
    let plot = Plot { x, y, area: [60.0, 14.0, 1010.0, 430.0] };
    let mut chart = Chart::new(1100.0, 490.0);
    let [left, top, width, height] = plot.area;
    let limit = plot.at(from, 100.0 * study.tolerance.relative).1;
    chart.rect([left, limit, width, top + height - limit], "band");
    chart.axes(&plot);
    let points = points(&plot, summaries);
    let mut labels = Labels(points.iter().map(|at| around(*at)).collect());
    for (summary, at) in summaries.iter().zip(points) {
        let (form, errors) = (summary.form, &summary.errors);
        let end = |share: f64| (at.0, plot.at(from, 100.0 * quantile(errors, share)).1);
        chart.line([end(0.0), end(1.0)], &format!("range {}", class(form)));
        let words = format!(
            "{}: {:.1} ns, median {} %, largest {} %",
            form.id(),
            summary.nanoseconds,
            percent(quantile(errors, 0.5)),
            percent(quantile(errors, 1.0))
        );
        chart.marker(marker(form), at, &class(form), &words);
        let (x, y) = labels.place(at, form.id());
        chart.text(x, y, "", form.id());
    }
    chart.finish(
        "Time of one evaluation against the largest relative error, for each form; the table below has the numbers",
    )
}

/// Where the forms lie. Forms of one formula take the same time: they are drawn side by side, a few pixels apart.
fn points(plot: &Plot, summaries: &[Summary]) -> Vec<(f64, f64)> {
    const APART: f64 = 7.0;
    let mut order: Vec<usize> = (0..summaries.len()).collect();
    order.sort_by(|a, b| summaries[*a].nanoseconds.total_cmp(&summaries[*b].nanoseconds));
    let at = |summary: &Summary| plot.at(summary.nanoseconds, 100.0 * quantile(&summary.errors, 0.5));
    let mut points: Vec<(f64, f64)> = summaries.iter().map(at).collect();
    let mut last = f64::NEG_INFINITY;
    for i in order {
        points[i].0 = points[i].0.max(last + APART);
        last = points[i].0;
    }
    points
}

/// 1, 2 and 5 of every decade between two numbers above 0.
fn steps_125(from: f64, to: f64) -> Vec<f64> {
    let decades = from.log10().floor() as i32..=to.log10().ceil() as i32;
    let all = decades.flat_map(|power| [1.0, 2.0, 5.0].map(|step| step * 10f64.powi(power)));
    all.filter(|v| (from..=to).contains(v)).collect()
}

/// Rectangles that are taken: left, top, right, bottom.
#[derive(Default)]
struct Labels(Vec<[f64; 4]>);

impl Labels {
    /// Where a label starts (left end of its baseline) beside a point: the first place of a few that is free.
    fn place(&mut self, (x, y): (f64, f64), text: &str) -> (f64, f64) {
        let width = 6.1 * text.chars().count() as f64;
        let places =
            [(9.0, 4.0), (-9.0 - width, 4.0), (9.0, -7.0), (9.0, 15.0), (-9.0 - width, -7.0), (-9.0 - width, 15.0)];
        let boxed = |(dx, dy): (f64, f64)| [x + dx, y + dy - 10.0, x + dx + width, y + dy + 3.0];
        let free = |place: &&(f64, f64)| self.0.iter().all(|taken| !overlap(*taken, boxed(**place)));
        let place = *places.iter().find(free).unwrap_or(&places[0]);
        self.0.push(boxed(place));
        (x + place.0, y + place.1)
    }
}

fn around((x, y): (f64, f64)) -> [f64; 4] {
    [x - 6.0, y - 6.0, x + 6.0, y + 6.0]
}

fn overlap(a: [f64; 4], b: [f64; 4]) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_error_falls_into_one_bin() {
        let errors = [0.0, 1e-9, 0.0099, 0.0101, 0.5, 1.0, 7.0, f64::INFINITY];
        let counts = bins(&errors);
        assert_eq!((counts.len(), counts.iter().sum::<usize>()), (16, errors.len()));
        // 0.99 % lies below and 1.01 % above the edge of the third decade.
        assert_eq!((counts[7], counts[8]), (1, 1));
        assert_eq!((counts[0], counts[15]), (2, 3));
    }

    #[test]
    fn labels_of_neighbours_do_not_cover_each_other() {
        let mut labels = Labels::default();
        for y in [100.0, 103.0, 106.0] {
            labels.place((50.0, y), "series-3");
        }
        for (i, a) in labels.0.iter().enumerate() {
            assert!(labels.0[..i].iter().all(|b| !overlap(*a, *b)), "{:?}", labels.0);
        }
    }
}
