//! Mitsuba's XML: elements with a type, a name and a value.

use std::fmt::{self, Display, Formatter};

use glam::{Affine3A, Mat3, Vec3};

/// An element with its attributes and children.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    tag: &'static str,
    attributes: Vec<(&'static str, String)>,
    children: Vec<Element>,
}

impl Element {
    /// An element without attributes.
    pub fn new(tag: &'static str) -> Element {
        Element { tag, attributes: Vec::new(), children: Vec::new() }
    }

    /// An instance of one of Mitsuba's plugins.
    pub fn plugin(tag: &'static str, kind: &str) -> Element {
        Element::new(tag).attribute("type", kind)
    }

    /// A value of a plugin.
    fn value(tag: &'static str, name: &str, value: impl Display) -> Element {
        Element::new(tag).attribute("name", name).attribute("value", value)
    }

    /// A number.
    pub fn float(name: &str, value: f32) -> Element {
        Element::value("float", name, value)
    }

    /// A whole number.
    pub fn integer(name: &str, value: u64) -> Element {
        Element::value("integer", name, value)
    }

    /// A word.
    pub fn string(name: &str, value: &str) -> Element {
        Element::value("string", name, value)
    }

    /// Yes or no.
    pub fn boolean(name: &str, value: bool) -> Element {
        Element::value("boolean", name, value)
    }

    /// Linear Rec.709.
    pub fn rgb(name: &str, value: Vec3) -> Element {
        Element::value("rgb", name, format!("{} {} {}", value.x, value.y, value.z))
    }

    /// Values at wavelengths in nm.
    pub fn spectrum(name: &str, values: impl Iterator<Item = (f64, f64)>) -> Element {
        let pairs: Vec<String> = values.map(|(nm, value)| format!("{nm}:{value}")).collect();
        Element::value("spectrum", name, pairs.join(", "))
    }

    /// Three numbers: a `point` or a `vector`.
    pub fn triple(tag: &'static str, name: &str, value: Vec3) -> Element {
        let element = Element::new(tag).attribute("name", name);
        element.attribute("x", value.x).attribute("y", value.y).attribute("z", value.z)
    }

    /// A transform, result-from-input.
    pub fn transform(name: &str, matrix: &Affine3A) -> Element {
        let (m, t) = (matrix.matrix3, matrix.translation);
        // Adding 0 takes the sign from a zero.
        let row = |i: usize| [m.x_axis[i], m.y_axis[i], m.z_axis[i], t[i]].map(|v| (v + 0.0).to_string()).join(" ");
        let rows = format!("{} {} {} 0 0 0 1", row(0), row(1), row(2));
        Element::new("transform").attribute("name", name).with(Element::new("matrix").attribute("value", rows))
    }

    /// A transform of texture coordinates: Mitsuba takes the upper left 2 x 2 numbers and the last column.
    pub fn uv_transform(name: &str, matrix: &Mat3) -> Element {
        let [x, y, t] = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|axis| axis.truncate().extend(0.0));
        Element::transform(name, &Affine3A::from_cols(x.into(), y.into(), Vec3::Z.into(), t.into()))
    }

    /// Refers to an element by its id.
    pub fn reference(id: &str) -> Element {
        Element::new("ref").attribute("id", id)
    }

    /// With another attribute.
    pub fn attribute(mut self, key: &'static str, value: impl Display) -> Element {
        self.attributes.push((key, value.to_string()));
        self
    }

    /// With the name by which the plugin around it knows it.
    pub fn named(self, name: &str) -> Element {
        self.attribute("name", name)
    }

    /// With a child.
    pub fn with(mut self, child: Element) -> Element {
        self.children.push(child);
        self
    }

    /// With children.
    pub fn with_all(mut self, children: impl IntoIterator<Item = Element>) -> Element {
        self.children.extend(children);
        self
    }

    fn write(&self, f: &mut Formatter<'_>, depth: usize) -> fmt::Result {
        let Element { tag, attributes, children } = self;
        write!(f, "{:1$}<{tag}", "", 4 * depth)?;
        for (key, value) in attributes {
            write!(f, " {key}=\"{}\"", escaped(value))?;
        }
        if children.is_empty() {
            return writeln!(f, "/>");
        }
        writeln!(f, ">")?;
        for child in children {
            child.write(f, depth + 1)?;
        }
        writeln!(f, "{:1$}</{tag}>", "", 4 * depth)
    }
}

impl Display for Element {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.write(f, 0)
    }
}

/// Text inside double quotes. XML knows no control characters, and Mitsuba replaces what follows a `$`.
fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe += "&amp;",
            '<' => safe += "&lt;",
            '>' => safe += "&gt;",
            '"' => safe += "&quot;",
            '\'' => safe += "&apos;",
            '$' => safe.push('_'),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => safe.push(' '),
            c => safe.push(c),
        }
    }
    safe
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;

    #[test]
    fn nothing_breaks_out_of_an_attribute() {
        let text = Element::string("filename", "a\"/><x y='$spp' & \u{0}\n").to_string();
        assert_eq!(text, "<string name=\"filename\" value=\"a&quot;/&gt;&lt;x y=&apos;_spp&apos; &amp;   \"/>\n");
    }

    #[test]
    fn matrices_are_written_row_by_row() {
        let matrix = Affine3A::from_translation(Vec3::new(1.0, 2.0, 3.0));
        let text = Element::transform("to_world", &matrix).to_string();
        assert!(text.contains("value=\"1 0 0 1 0 1 0 2 0 0 1 3 0 0 0 1\""), "{text}");
        let uv = Mat3::from_scale_angle_translation(Vec2::new(2.0, 3.0), 0.0, Vec2::new(0.5, 0.25));
        let text = Element::uv_transform("to_uv", &uv).to_string();
        assert!(text.contains("value=\"2 0 0 0.5 0 3 0 0.25 0 0 1 0 0 0 0 1\""), "{text}");
    }
}
