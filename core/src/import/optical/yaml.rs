//! Files of the refractiveindex.info database.
//!
//! They are YAML, of which the database uses little: keys at the margin, text in blocks or quotes, and under `DATA` a list
//! of tables and formulas. That little is read here line by line and anything else under `DATA` is refused. A general
//! reader would accept what the database never means (anchors, tags, tables folded into one line), would say less well
//! where a number is wrong, and would be one more thing to trust with foreign text.

use super::curve::{Curve, Sample};
use super::draft::Draft;
use super::fields::number;
use super::formula::Formula;
use super::report::Log;
use super::scalar::{Lines, indent_of};
use super::{Format, MAX_NOTE_CHARS, MAX_ROWS, Unit, UnitOrigin, citation, note_of};
use crate::import::resolve::quoted;

/// What to do about a layout that is not read.
const LAYOUT: &str = "write it as the files of the refractiveindex.info database are";

/// Entries of `DATA`; two, of n and of k, are all that make sense.
const MAX_ENTRIES: usize = 16;

/// Keys of an entry; the database uses a few.
const MAX_KEYS: usize = 32;

/// True for text that has the key `DATA` at the margin.
pub(super) fn is_database_file(text: &str) -> bool {
    text.lines().any(|line| line.trim_end() == "DATA:")
}

/// Reads a text; what is wrong with it goes to the log.
pub(super) fn read(text: &str, file: &str, stem: &str, log: &mut Log) -> Draft {
    let mut reader = Reader { file, log, items: Vec::new(), rows: 0, references: None, comments: None, seen: false };
    let mut lines = Lines::new(text);
    while let Some((number, line)) = lines.take() {
        if reader.top(number, line, &mut lines).is_none() {
            break;
        }
    }
    if !reader.seen {
        reader.log.fault(file, None, "has no DATA", LAYOUT);
    }
    let Reader { items, references, comments, .. } = reader;
    let mut source = references.map(|text| citation::source(&text)).unwrap_or_default();
    source.table = Some(format!("refractiveindex.info database file {file}"));
    source.licence = text.contains("CC0").then(|| "CC0-1.0".into());
    let note = comments.and_then(|text| note_of(&[citation::plain(&text)]));
    let rows = items.iter().map(Item::rows).sum();
    let (n, k) = curves(items, file, log);
    let unit = Some((Unit::Micrometre, UnitOrigin::Definition));
    Draft { format: Format::RefractiveIndexInfo, n, k, unit, other: None, rows, stem: stem.into(), source, note }
}

/// One entry of `DATA`.
#[derive(Debug, Default)]
struct Item {
    line: usize,
    /// Those that were read.
    keys: Vec<String>,
    kind: String,
    rows: Vec<(usize, Vec<f64>)>,
    coefficients: Vec<f64>,
    range: Vec<f64>,
}

impl Item {
    /// Rows of numbers; a formula counts as one.
    fn rows(&self) -> usize {
        self.rows.len() + usize::from(!self.coefficients.is_empty())
    }
}

struct Reader<'a> {
    file: &'a str,
    log: &'a mut Log,
    items: Vec<Item>,
    /// Rows of all tables so far.
    rows: usize,
    references: Option<String>,
    comments: Option<String>,
    seen: bool,
}

impl<'a> Reader<'a> {
    fn fault(&mut self, line: usize, reason: impl Into<String>, remedy: &str) -> Option<()> {
        self.log.fault(self.file, line, reason, remedy);
        None
    }

    /// A line at the margin; `None` when going on makes no sense.
    fn top(&mut self, number: usize, line: &str, lines: &mut Lines<'a>) -> Option<()> {
        if line.starts_with("---") || line.starts_with('%') {
            return Some(());
        }
        let Some((key, value)) = key_and_value(line).filter(|_| indent_of(line) == 0) else {
            return self.fault(number, format!("{} is no key at the margin", quoted(line)), LAYOUT);
        };
        match key {
            "DATA" if self.seen => self.fault(number, "is a second DATA", "keep one"),
            "DATA" if value.is_empty() => {
                self.seen = true;
                self.data(lines)
            }
            "DATA" => self.fault(number, "DATA is not followed by a list below it", LAYOUT),
            _ => {
                let Some(text) = lines.text(value, 0) else {
                    return self.fault(number, format!("the quote after {key} is not closed"), "close it");
                };
                match key {
                    "REFERENCES" => self.references = Some(self.shortened(number, key, text)),
                    "COMMENTS" => self.comments = Some(self.shortened(number, key, text)),
                    // Conditions, properties and what later versions add.
                    _ => {}
                }
                Some(())
            }
        }
    }

    /// As much of a text as a preset takes.
    fn shortened(&mut self, line: usize, key: &str, mut text: String) -> String {
        if let Some((end, _)) = text.char_indices().nth(MAX_NOTE_CHARS) {
            text.truncate(end);
            let note = format!("{key} has more than {MAX_NOTE_CHARS} characters; the rest was left out");
            self.log.note(self.file, line, note);
        }
        text
    }

    /// The list under `DATA`.
    fn data(&mut self, lines: &mut Lines<'a>) -> Option<()> {
        let mut list_indent = None;
        let mut key_indent = 0;
        while let Some((number, line)) = lines.peek() {
            let indent = indent_of(line);
            let dash = line.trim_start().strip_prefix("- ");
            if indent == 0 && dash.is_none() {
                break;
            }
            lines.take();
            let entry = match dash {
                Some(entry) if *list_indent.get_or_insert(indent) == indent => {
                    if self.items.len() == MAX_ENTRIES {
                        let reason = format!("DATA has more than {MAX_ENTRIES} entries");
                        return self.fault(number, reason, "keep one of n and one of k");
                    }
                    let blanks = entry.len() - entry.trim_start().len();
                    key_indent = indent + 2 + blanks;
                    self.items.push(Item { line: number, ..Item::default() });
                    entry
                }
                None if indent == key_indent && !self.items.is_empty() => line,
                _ => return self.fault(number, format!("{} is not expected under DATA", quoted(line.trim())), LAYOUT),
            };
            self.entry(number, entry.trim(), key_indent, lines)?;
        }
        Some(())
    }

    /// One key of an entry.
    fn entry(&mut self, number: usize, entry: &str, indent: usize, lines: &mut Lines<'a>) -> Option<()> {
        let Some((key, value)) = key_and_value(entry) else {
            return self.fault(number, format!("{} is no key with a value", quoted(entry)), LAYOUT);
        };
        let keys = &mut self.items.last_mut()?.keys;
        if keys.iter().any(|known| known == key) {
            return self.fault(number, format!("`{key}` stands there twice"), "keep one of the two");
        }
        if keys.len() == MAX_KEYS {
            return self.fault(number, format!("the entry has more than {MAX_KEYS} keys"), LAYOUT);
        }
        keys.push(key.into());
        if key == "data" {
            if !matches!(value.split_whitespace().next(), Some("|" | "|-" | "|+")) {
                return self.fault(number, "`data` is not followed by `|` and a row in each line below", LAYOUT);
            }
            let block = lines.block(indent);
            return self.rows(block);
        }
        let Some(text) = lines.text(value, indent) else {
            return self.fault(number, format!("the quote after {key} is not closed"), "close it");
        };
        match key {
            "type" => {
                let item = self.items.last_mut()?;
                item.kind = text.split_whitespace().collect::<Vec<_>>().join(" ");
            }
            "coefficients" => {
                let numbers = self.numbers(number, &text)?;
                self.items.last_mut()?.coefficients = numbers;
            }
            "wavelength_range" | "range" => {
                let numbers = self.numbers(number, &text)?;
                self.items.last_mut()?.range = numbers;
            }
            _ => {}
        }
        Some(())
    }

    /// Numbers with blanks between.
    fn numbers(&mut self, line: usize, text: &str) -> Option<Vec<f64>> {
        let mut numbers = Vec::new();
        for word in text.split_whitespace() {
            match number(word, None) {
                Ok(value) => numbers.push(value),
                Err(reason) => {
                    self.fault(line, reason, "give numbers with blanks between");
                    return None;
                }
            }
        }
        Some(numbers)
    }

    /// The lines of a table.
    fn rows(&mut self, block: Vec<(usize, &str)>) -> Option<()> {
        self.rows += block.len();
        if self.rows > MAX_ROWS {
            let line = block.first().map_or(0, |(line, _)| *line);
            return self.fault(line, format!("there are more than {MAX_ROWS} rows"), "thin the table out");
        }
        for (line, text) in block {
            if text.trim().is_empty() {
                continue;
            }
            let mut values = Vec::with_capacity(3);
            let mut sound = true;
            for word in text.split_whitespace() {
                match number(word, None) {
                    Ok(value) => values.push(value),
                    Err(reason) => {
                        sound = false;
                        self.fault(line, reason, "correct the row or leave it out");
                    }
                }
            }
            if sound {
                self.items.last_mut()?.rows.push((line, values));
            }
        }
        Some(())
    }
}

/// `key: value`; a comment behind the value stays, it ends nothing in a text.
fn key_and_value(line: &str) -> Option<(&str, &str)> {
    let (key, value) = line.split_once(':')?;
    let plain = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '.');
    let spaced = value.is_empty() || value.starts_with(' ');
    (spaced && !key.is_empty() && key.chars().all(plain)).then_some((key, value.trim()))
}

/// n and k of the entries. What contradicts goes to the log.
fn curves(items: Vec<Item>, file: &str, log: &mut Log) -> (Curve, Curve) {
    let empty = || Curve { file: file.into(), samples: Vec::new() };
    let (mut n, mut k) = (None, None);
    for item in items {
        let line = item.line;
        let (found_n, found_k) = match item.kind.as_str() {
            "tabulated nk" => (column(&item, 1, 3, file, log), column(&item, 2, 3, file, log)),
            "tabulated n" => (column(&item, 1, 2, file, log), None),
            "tabulated k" => (None, column(&item, 1, 2, file, log)),
            kind => (formula(kind, &item, file, log), None),
        };
        for (symbol, known, found) in [("n", &mut n, found_n), ("k", &mut k, found_k)] {
            match found {
                Some(_) if known.is_some() => {
                    log.fault(file, line, format!("gives {symbol} a second time"), "keep one of the two");
                }
                Some(samples) => *known = Some(Curve { file: file.into(), samples }),
                None => {}
            }
        }
    }
    if n.is_none() && !log.failed() {
        log.fault(file, None, "gives no n", "take a file with `tabulated nk`, `tabulated n` or a formula");
    }
    (n.unwrap_or_else(empty), k.unwrap_or_else(empty))
}

/// One column of a table of so many.
fn column(item: &Item, column: usize, width: usize, file: &str, log: &mut Log) -> Option<Vec<Sample>> {
    let mut samples = Vec::with_capacity(item.rows.len());
    for (line, values) in &item.rows {
        match (values.first(), values.get(column)) {
            (Some(&at), Some(&value)) if values.len() == width => samples.push(Sample { line: *line, at, value }),
            // Said once for both columns.
            _ if column == 1 => {
                let reason = format!("has {} numbers; `{}` has {width} in a row", values.len(), item.kind);
                log.fault(file, *line, reason, "correct the row or leave it out");
            }
            _ => {}
        }
    }
    if item.rows.is_empty() && column == 1 && !log.failed() {
        log.fault(file, item.line, format!("`{}` has no rows", item.kind), LAYOUT);
    }
    Some(samples)
}

/// A formula on a grid.
fn formula(kind: &str, item: &Item, file: &str, log: &mut Log) -> Option<Vec<Sample>> {
    let number: Option<u8> = kind.strip_prefix("formula ").and_then(|number| number.parse().ok());
    let Some(number) = number else {
        let reason = format!("the type {} is not read", quoted(kind));
        let remedy = "there are `tabulated nk`, `tabulated n`, `tabulated k` and `formula 1` to `formula 9`";
        log.fault(file, item.line, reason, remedy);
        return None;
    };
    let &[from, to] = item.range.as_slice() else {
        log.fault(file, item.line, format!("`{kind}` has no wavelength_range of two numbers"), "give it in um");
        return None;
    };
    let samples = Formula::new(number, &item.coefficients).and_then(|formula| formula.samples(from, to));
    match samples {
        Ok(samples) => Some(samples),
        Err(reason) => {
            log.fault(file, item.line, format!("`{kind}` {reason}"), "correct its coefficients or its range");
            None
        }
    }
}
