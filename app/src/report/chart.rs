//! Charts as SVG, written as text. Lengths are pixels of the drawing, y down; colours come from the page's style.

use std::fmt::Write as _;

use super::axis::{Axis, tick};
use super::html::escape;

/// A drawing under construction.
pub struct Chart {
    width: f64,
    height: f64,
    body: String,
}

/// A pair of axes in a drawing.
pub struct Plot {
    pub x: Axis,
    pub y: Axis,
    /// Left, top, width and height of the area between the axes.
    pub area: [f64; 4],
}

impl Plot {
    /// Where a pair of values lies in the drawing.
    pub fn at(&self, x: f64, y: f64) -> (f64, f64) {
        let [left, top, width, height] = self.area;
        (left + width * self.x.at(x), top + height * (1.0 - self.y.at(y)))
    }
}

/// Shapes of points, told apart without colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    Circle,
    Square,
    Diamond,
    Up,
    Down,
    Cross,
    Plus,
    Star,
}

impl Marker {
    /// Path around (0, 0), about 9 pixels across.
    fn path(self) -> &'static str {
        match self {
            Marker::Circle => "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0z",
            Marker::Square => "M-3.6 -3.6h7.2v7.2h-7.2z",
            Marker::Diamond => "M0 -5l5 5l-5 5l-5 -5z",
            Marker::Up => "M0 -4.8l4.6 8h-9.2z",
            Marker::Down => "M0 4.8l4.6 -8h-9.2z",
            Marker::Cross => "M-3.6 -3.6l7.2 7.2M-3.6 3.6l7.2 -7.2",
            Marker::Plus => "M-4.6 0h9.2M0 -4.6v9.2",
            Marker::Star => "M-4.6 0h9.2M-2.3 -4l4.6 8M-2.3 4l4.6 -8",
        }
    }
}

impl Chart {
    pub fn new(width: f64, height: f64) -> Chart {
        Chart { width, height, body: String::new() }
    }

    /// The drawing; `label` says in words what it shows.
    pub fn finish(self, label: &str) -> String {
        let Chart { width, height, body } = self;
        let label = escape(label);
        format!(
            "<svg role=\"img\" aria-label=\"{label}\" viewBox=\"0 0 {width} {height}\" style=\"max-width:{width}px\">\n{body}</svg>\n"
        )
    }

    /// The drawing as a file of its own, on a ground that `style` colours.
    pub fn standalone(mut self, label: &str, style: &str) -> String {
        let ground = format!("<style>{style}</style><rect class=\"ground\" width=\"100%\" height=\"100%\"/>\n");
        self.body.insert_str(0, &ground);
        let (width, height) = (self.width, self.height);
        let size = format!("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\"");
        self.finish(label).replacen("<svg", &size, 1)
    }

    /// Frame, grid, ticks and titles. Ticks of y stand left of the area, those of x below it.
    pub fn axes(&mut self, plot: &Plot) {
        let [left, top, width, height] = plot.area;
        let mut grid = String::new();
        for &value in &plot.x.ticks {
            let x = left + width * plot.x.at(value);
            let _ = write!(grid, "M{} {}v{}", short(x), short(top), short(height));
            self.text(x, top + height + 13.0, "tick mid", &tick(value));
        }
        for &value in &plot.y.ticks {
            let y = top + height * (1.0 - plot.y.at(value));
            let _ = write!(grid, "M{} {}h{}", short(left), short(y), short(width));
            self.text(left - 5.0, y + 3.5, "tick end", &tick(value));
        }
        self.stroke(&grid, "grid");
        self.stroke(
            &format!("M{} {}h{}v{}h{}z", short(left), short(top), short(width), short(height), -width),
            "frame",
        );
        self.text(left + width / 2.0, top + height + 27.0, "title mid", plot.x.title);
        if !plot.y.title.is_empty() {
            let (x, y) = (left - 38.0, top + height / 2.0);
            let _ = writeln!(
                self.body,
                "<text class=\"title mid\" transform=\"translate({} {})rotate(-90)\">{}</text>",
                short(x),
                short(y),
                escape(plot.y.title)
            );
        }
    }

    pub fn text(&mut self, x: f64, y: f64, class: &str, text: &str) {
        let (x, y, text) = (short(x), short(y), escape(text));
        let _ = writeln!(self.body, "<text class=\"{class}\" x=\"{x}\" y=\"{y}\">{text}</text>");
    }

    /// A line through points of the drawing.
    pub fn line(&mut self, points: impl IntoIterator<Item = (f64, f64)>, class: &str) {
        let path = path(points);
        self.stroke(&path, class);
    }

    pub fn rect(&mut self, [left, top, width, height]: [f64; 4], class: &str) {
        let [x, y, w, h] = [left, top, width, height].map(short);
        let _ = writeln!(self.body, "<rect class=\"{class}\" x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\"/>");
    }

    /// A point with words that appear under the pointer.
    pub fn marker(&mut self, marker: Marker, (x, y): (f64, f64), class: &str, words: &str) {
        let (x, y, path) = (short(x), short(y), marker.path());
        let words = if words.is_empty() { String::new() } else { format!("<title>{}</title>", escape(words)) };
        let _ = writeln!(
            self.body,
            "<path class=\"mark {class}\" transform=\"translate({x} {y})\" d=\"{path}\">{words}</path>"
        );
    }

    fn stroke(&mut self, path: &str, class: &str) {
        let _ = writeln!(self.body, "<path class=\"{class}\" d=\"{path}\"/>");
    }
}

/// Path of a line, in tenths of a pixel, each point relative to the one before: a third of the length of absolute
/// numbers, and since the rounded points are subtracted, without drift.
fn path(points: impl IntoIterator<Item = (f64, f64)>) -> String {
    let tenths = |v: f64| (v * 10.0).round() as i64;
    let mut points = points.into_iter().map(|(x, y)| (tenths(x), tenths(y)));
    let Some((mut x, mut y)) = points.next() else { return String::new() };
    let mut path = format!("M{} {}l", decimal(x), decimal(y));
    for (next_x, next_y) in points {
        for step in [next_x - x, next_y - y] {
            // A minus sign separates as well as a space does.
            if step >= 0 && !path.ends_with('l') {
                path.push(' ');
            }
            path.push_str(&decimal(step));
        }
        (x, y) = (next_x, next_y);
    }
    path
}

/// Tenths as a number, as short as SVG reads it: `-.3`, `12`.
fn decimal(tenths: i64) -> String {
    let (whole, rest) = (tenths.abs() / 10, tenths.abs() % 10);
    let sign = if tenths < 0 { "-" } else { "" };
    match (whole, rest) {
        (whole, 0) => format!("{sign}{whole}"),
        (0, rest) => format!("{sign}.{rest}"),
        (whole, rest) => format!("{sign}{whole}.{rest}"),
    }
}

/// A length with at most one decimal.
fn short(length: f64) -> String {
    decimal((length * 10.0).round() as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_ends_where_its_last_point_is_however_many_there_are() {
        assert_eq!(path([(0.0, 10.0), (2.0, 9.74), (4.04, 9.52)]), "M0 10l2-.3 2-.2");
        assert_eq!(path([]), "");
        let drawn = path((0..1000).map(|i| (f64::from(i) * 0.33, 0.0)));
        let steps: Vec<f64> = drawn.split('l').nth(1).unwrap().split(' ').map(|n| n.parse().unwrap()).collect();
        let width: f64 = steps.iter().step_by(2).sum();
        assert!((width - 999.0 * 0.33).abs() < 0.06, "{width}");
    }

    #[test]
    fn numbers_are_as_short_as_they_can_be() {
        assert_eq!([0, -3, 120, -125, 7].map(decimal), ["0", "-.3", "12", "-12.5", ".7"]);
    }

    #[test]
    fn a_chart_says_what_it_shows_and_foreign_text_stays_text() {
        let mut chart = Chart::new(100.0, 50.0);
        chart.text(1.0, 2.0, "tick", "<Au>");
        chart.marker(Marker::Up, (3.0, 4.0), "x", "a & b");
        let svg = chart.finish("errors of \"Au\"");
        assert!(svg.contains("aria-label=\"errors of &quot;Au&quot;\"") && svg.contains("role=\"img\""), "{svg}");
        assert!(svg.contains("&lt;Au&gt;") && svg.contains("<title>a &amp; b</title>"), "{svg}");
    }
}
