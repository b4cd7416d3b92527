//! OBJ text, line by line: joined, checked and counted before it is parsed.

use std::borrow::Cow;

use super::Cause;
use crate::import::budget::Meter;
use crate::import::report::Report;
use crate::import::resolve::quoted;

/// Text that `tobj` reads without surprise.
pub(super) struct Checked {
    pub text: String,
    /// Every corner of every face names a normal.
    pub normals_complete: bool,
}

/// What has been seen so far.
#[derive(Default)]
struct Seen {
    positions: usize,
    colored: usize,
    coordinates: usize,
    normals: usize,
    corners_with_normal: usize,
    corners_without_normal: usize,
    /// Greatest positive index of each list with its line; faces may come before their vertices.
    greatest: [(usize, usize); 3],
}

const LISTS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// Checks every statement; `None` when a fault was reported.
pub(super) fn check(source: &str, meter: &mut Meter, report: &mut Report) -> Option<Checked> {
    let mut seen = Seen::default();
    let mut text = String::with_capacity(source.len());
    let mut sound = true;
    for (number, line) in joined(source) {
        match seen.statement(line.trim(), number, meter, report) {
            Ok(Some(statement)) => {
                text.push_str(&statement);
                text.push('\n');
            }
            Ok(None) => {}
            Err(cause) => {
                report.fault(format!("line {number} {}", quoted(line.trim())), cause);
                sound = false;
            }
        }
    }
    for ((index, line), (what, count)) in seen.greatest.into_iter().zip(LISTS.into_iter().zip(seen.counts())) {
        if index > count {
            let cause = Cause::Index { what, index: index as u64, count: count as u64 };
            report.fault(format!("line {line}"), cause);
            sound = false;
        }
    }
    if !sound {
        return None;
    }
    let normals_complete = seen.corners_without_normal == 0;
    if seen.corners_with_normal > 0 && !normals_complete {
        report.notice("file", "some face corners have no normal, so all normals were made anew");
    }
    if seen.colored > 0 && seen.colored < seen.positions {
        report.notice("file", "only some vertices have a colour; vertex colours are left out");
        text = without_colors(&text);
    }
    Some(Checked { text, normals_complete })
}

impl Seen {
    fn counts(&self) -> [usize; 3] {
        [self.positions, self.coordinates, self.normals]
    }

    /// Checks one statement; returns it as `tobj` shall see it, or none where it need not.
    fn statement<'a>(
        &mut self,
        line: &'a str,
        number: usize,
        meter: &mut Meter,
        report: &mut Report,
    ) -> Result<Option<Cow<'a, str>>, Cause> {
        let statement = line.split('#').next().unwrap_or("").trim();
        let mut words = statement.split_whitespace();
        match words.next() {
            Some("v") => self.position(words, meter)?,
            Some("vt") => self.coordinate(words)?,
            Some("vn") => {
                numbers(words, &[3])?;
                self.normals += 1;
            }
            Some("f") => self.face(words, number, meter)?,
            // Names may hold '#', so the whole line counts.
            Some("o" | "g" | "usemtl" | "mtllib") => return Ok(Some(spaced(line).into())),
            Some("p" | "l") => {
                report.notice(format!("line {number}"), "points and lines are not shown");
                return Ok(None);
            }
            Some("curv" | "curv2" | "surf") => {
                report.notice(format!("line {number}"), "free-form curves and surfaces are not shown");
                return Ok(None);
            }
            _ => return Ok(None),
        }
        Ok(Some(statement.into()))
    }

    /// `v x y z`, with a weight or a colour after it.
    fn position<'a>(&mut self, words: impl Iterator<Item = &'a str>, meter: &mut Meter) -> Result<(), Cause> {
        let values = numbers(words, &[3, 4, 6])?;
        if values.len() == 4 {
            let weight = values[3];
            if values.iter().any(|v| !(v / weight).is_finite()) {
                return Err(invalid("the weight is 0"));
            }
        }
        meter.take_vertices(1)?;
        self.positions += 1;
        self.colored += usize::from(values.len() == 6);
        Ok(())
    }

    fn coordinate<'a>(&mut self, words: impl Iterator<Item = &'a str>) -> Result<(), Cause> {
        numbers(words, &[2, 3])?;
        self.coordinates += 1;
        Ok(())
    }

    /// `f p p/t p/t/n p//n ...`, three corners or more, counted from 1 or backwards from -1.
    fn face<'a>(&mut self, words: impl Iterator<Item = &'a str>, line: usize, meter: &mut Meter) -> Result<(), Cause> {
        let mut corners = 0_u64;
        for word in words {
            corners += 1;
            let mut parts = word.split('/');
            for list in 0..3 {
                match parts.next() {
                    None | Some("") if list > 0 => {}
                    Some(text) => self.index(text, list, line)?,
                    None => return Err(invalid("a corner without a vertex")),
                }
            }
            if parts.next().is_some() {
                return Err(invalid("a corner with more than three parts"));
            }
            let with_normal = word.split('/').nth(2).is_some_and(|n| !n.is_empty());
            self.corners_with_normal += usize::from(with_normal);
            self.corners_without_normal += usize::from(!with_normal);
        }
        match corners {
            0..3 => Err(invalid("a face needs three corners or more")),
            _ => meter.take_triangles(corners - 2),
        }
    }

    fn index(&mut self, text: &str, list: usize, line: usize) -> Result<(), Cause> {
        let index: i64 = text.parse().map_err(|_| invalid(&format!("{} is not an index", quoted(text))))?;
        let count = self.counts()[list];
        let behind = usize::try_from(index.unsigned_abs()).unwrap_or(usize::MAX);
        match index {
            0 => Err(invalid("index 0: indices count from 1")),
            1.. => {
                if behind > self.greatest[list].0 {
                    self.greatest[list] = (behind, line);
                }
                Ok(())
            }
            _ if behind <= count => Ok(()),
            _ => Err(invalid(&format!("{} {index} counts back past the first of {count}", LISTS[list]))),
        }
    }
}

/// Finite numbers, of which there must be one of the `counts`.
fn numbers<'a>(words: impl Iterator<Item = &'a str>, counts: &[usize]) -> Result<Vec<f32>, Cause> {
    let mut values = Vec::with_capacity(6);
    for word in words {
        let value: f32 = word.parse().map_err(|_| invalid(&format!("{} is not a number", quoted(word))))?;
        if !value.is_finite() {
            return Err(invalid(&format!("{} is not a finite 32-bit number", quoted(word))));
        }
        values.push(value);
        if values.len() > 6 {
            break;
        }
    }
    if counts.contains(&values.len()) { Ok(values) } else { Err(invalid("has too few or too many numbers")) }
}

fn invalid(text: &str) -> Cause {
    Cause::Invalid(text.into())
}

/// Lines with their numbers from 1; a backslash at the end joins a line with the next.
fn joined(source: &str) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let mut lines = source.lines().enumerate();
    std::iter::from_fn(move || {
        let (index, first) = lines.next()?;
        let Some(mut open) = first.trim_end().strip_suffix('\\') else { return Some((index + 1, first.into())) };
        let mut whole = String::new();
        loop {
            whole.push_str(open);
            whole.push(' ');
            let Some((_, next)) = lines.next() else { break };
            match next.trim_end().strip_suffix('\\') {
                Some(more) => open = more,
                None => {
                    whole.push_str(next);
                    break;
                }
            }
        }
        Some((index + 1, whole.into()))
    })
}

/// The keyword and its argument with one space between; `tobj` does not take a tab.
fn spaced(line: &str) -> String {
    match line.split_once(char::is_whitespace) {
        Some((keyword, argument)) => format!("{keyword} {}", argument.trim()),
        None => line.to_string(),
    }
}

fn without_colors(text: &str) -> String {
    let mut kept = String::with_capacity(text.len());
    for line in text.lines() {
        let words: Vec<&str> = line.split(' ').filter(|w| !w.is_empty()).collect();
        match words.as_slice() {
            ["v", x, y, z, _, _, _] => kept.push_str(&format!("v {x} {y} {z}")),
            _ => kept.push_str(line),
        }
        kept.push('\n');
    }
    kept
}
