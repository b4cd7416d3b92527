//! Columns of numbers: divided by commas, semicolons, tabs or blanks; with or without a header; in one block or two.
//!
//! What a line means is decided by what it holds: a line that begins like a number is a row, one that begins with `#`,
//! `//` or `%` is a comment, all else is a header or, before the first row, a remark. Where that is not certain the
//! file is refused: a column taken for another gives a metal that looks right and is wrong.

use super::curve::Sample;
use super::fields::{Decimal, Separator, begins_as_number, number};
use super::header::{self, Column, Role};
use super::report::Log;
use super::{MAX_ROWS, Unit, UnitOrigin};
use crate::import::resolve::quoted;

/// Comment lines that are kept.
const COMMENTS_KEPT: usize = 20;

/// What to do when a header is not understood.
const NAME_COLUMNS: &str = "name the columns `wavelength_nm,n,k` and begin remarks with #";

/// What columns hold.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Columns {
    pub n: Vec<Sample>,
    pub k: Vec<Sample>,
    /// Of two columns without a name for the second.
    pub unnamed: Vec<Sample>,
    pub unit: Option<(Unit, UnitOrigin)>,
    pub rows: usize,
    /// Comments, without their marks.
    pub comments: Vec<String>,
    /// A block of `wl,n` and a block of `wl,k`: the export of refractiveindex.info, which is in micrometres.
    pub exported: bool,
}

/// Where the columns of a block are.
#[derive(Clone, Copy, Debug)]
struct Plan {
    at: usize,
    n: Option<usize>,
    k: Option<usize>,
    unnamed: Option<usize>,
    /// Columns in all.
    width: usize,
}

/// Reads a text; what is wrong with it goes to the log.
pub(super) fn read(text: &str, file: &str, log: &mut Log) -> Columns {
    let separator = Separator::of(text);
    let mut reader = Reader {
        file,
        log,
        separator,
        decimal: Decimal::default(),
        plan: None,
        headers: Vec::new(),
        above: None,
        comment: None,
        found: Columns::default(),
    };
    for (index, line) in text.lines().enumerate() {
        if reader.line(index + 1, line).is_none() {
            break;
        }
    }
    reader.found.exported = reader.headers == ["wl,n", "wl,k"];
    reader.found
}

struct Reader<'a> {
    file: &'a str,
    log: &'a mut Log,
    separator: Separator,
    decimal: Decimal,
    plan: Option<Plan>,
    /// Headers so far, lower case, with commas.
    headers: Vec<String>,
    /// The last line that was no row, before there is a plan.
    above: Option<(usize, Vec<String>)>,
    /// The last comment before there is a plan.
    comment: Option<(usize, String)>,
    found: Columns,
}

impl Reader<'_> {
    /// Takes one line; `None` when going on makes no sense.
    fn line(&mut self, number: usize, line: &str) -> Option<()> {
        let line = line.trim();
        if line.is_empty() {
            return Some(());
        }
        if let Some(comment) = ["#", "//", "%"].iter().find_map(|mark| line.strip_prefix(mark)) {
            self.comment(number, comment.trim());
            return Some(());
        }
        let is_row = begins_as_number(line);
        let line = if is_row { without_comment(line) } else { without_remark(line) };
        let fields = self.separator.split(line);
        match self.plan {
            None if is_row => self.first_row(number, &fields),
            None => self.header_or_remark(number, line, fields),
            Some(plan) if is_row || plan.holds_number(&fields) => self.row(number, plan, &fields),
            Some(_) => self.next_header(number, line, &fields),
        }
    }

    fn comment(&mut self, number: usize, comment: &str) {
        if self.plan.is_none() {
            self.comment = Some((number, comment.into()));
        }
        if !comment.is_empty() && self.found.comments.len() < COMMENTS_KEPT {
            self.found.comments.push(comment.into());
        }
    }

    /// A row while it is not known what the columns are: a comment above may say so, else their number does.
    fn first_row(&mut self, number: usize, fields: &[String]) -> Option<()> {
        if let Some((line, above)) = self.above.take() {
            if fields.len() > 1 && above.len() == fields.len() {
                let reason = format!("the header {} is not understood", quoted(&above.join(" ")));
                self.fault(line, reason, NAME_COLUMNS);
                return None;
            }
            self.log.note(self.file, line, "is no row and no header; it was skipped");
        }
        if let Some((line, columns)) = self.header_in_comment(fields.len()) {
            self.log.note(self.file, line, "the comment above the rows was taken for their header");
            self.begin_block(line, columns)?;
        } else {
            let unnamed = |n, k, unnamed| Plan { at: 0, n, k, unnamed, width: fields.len() };
            self.plan = match fields.len() {
                2 => Some(unnamed(None, None, Some(1))),
                3 => Some(unnamed(Some(1), Some(2), None)),
                count => {
                    let reason = format!("has {count} column{} and no header above", if count == 1 { "" } else { "s" });
                    self.fault(number, reason, NAME_COLUMNS);
                    None
                }
            };
        }
        let plan = self.plan?;
        self.row(number, plan, fields)
    }

    /// The last comment, if it names exactly the columns that the rows have.
    fn header_in_comment(&mut self, width: usize) -> Option<(usize, Vec<Column>)> {
        let (line, text) = self.comment.take()?;
        let columns = self.columns_of(&text, &self.separator.split(&text));
        let named = |c: &Column| matches!(c.role, Role::At(_) | Role::N | Role::K);
        (columns.len() == width && columns.iter().all(named)).then_some((line, columns))
    }

    fn columns_of(&self, line: &str, fields: &[String]) -> Vec<Column> {
        match self.separator == Separator::Blank || fields.len() < 2 {
            true => header::columns_of_words(line),
            false => header::columns(fields),
        }
    }

    /// A line above the rows.
    fn header_or_remark(&mut self, number: usize, line: &str, fields: Vec<String>) -> Option<()> {
        let columns = self.columns_of(line, &fields);
        if columns.len() > 1 && columns.iter().any(|c| matches!(c.role, Role::At(_) | Role::Foreign(_))) {
            return self.begin_block(number, columns);
        }
        if let Some((line, _)) = self.above.replace((number, fields)) {
            self.log.note(self.file, line, "is no row and no header; it was skipped");
        }
        Some(())
    }

    /// A line below rows or a header that is no row: the header of another block.
    fn next_header(&mut self, number: usize, line: &str, fields: &[String]) -> Option<()> {
        let columns = self.columns_of(line, fields);
        if columns.iter().any(|c| matches!(c.role, Role::At(_))) {
            return self.begin_block(number, columns);
        }
        self.fault(number, format!("{} is no row of numbers", quoted(line)), "correct it, or begin remarks with #");
        Some(())
    }

    /// Takes a header for the rows below.
    fn begin_block(&mut self, line: usize, columns: Vec<Column>) -> Option<()> {
        let place = |wanted: fn(&Role) -> bool| -> Vec<usize> {
            columns.iter().enumerate().filter(|(_, c)| wanted(&c.role)).map(|(i, _)| i).collect()
        };
        let at = place(|role| matches!(role, Role::At(_)));
        let (n, k) = (place(|role| *role == Role::N), place(|role| *role == Role::K));
        let mut other = place(|role| matches!(role, Role::Other | Role::Foreign(_)));
        let Some(&first) = at.first() else {
            let text: Vec<&str> = columns.iter().map(|c| c.text.as_str()).collect();
            let reason = format!("the first column is in a unit that is not read: {}", quoted(&text.join(", ")));
            self.fault(line, reason, "convert it to nm, um or eV and name it so");
            return None;
        };
        if n.len() > 1 || k.len() > 1 {
            let reason = format!("names {} columns for n and {} for k", n.len(), k.len());
            self.fault(line, reason, "keep one of each");
            return None;
        }
        let unnamed = (n.is_empty() && k.is_empty() && columns.len() == 2).then(|| other.pop()).flatten();
        if n.is_empty() && k.is_empty() && unnamed.is_none() {
            self.fault(line, "names no column for n or k", NAME_COLUMNS);
            return None;
        }
        other.extend(at.iter().skip(1));
        let unused: Vec<String> = other.iter().filter_map(|i| columns.get(*i)).map(|c| quoted(&c.text)).collect();
        if !unused.is_empty() {
            self.log.note(self.file, line, format!("not used: {}", unused.join(", ")));
        }
        if let Some(Column { role: Role::At(Some(unit)), text }) = columns.get(first) {
            self.unit(*unit, line, text)?;
        }
        let words: Vec<String> = columns.iter().map(|c| c.text.to_lowercase()).collect();
        self.headers.push(words.join(","));
        let (n, k) = (n.first().copied(), k.first().copied());
        self.plan = Some(Plan { at: first, n, k, unnamed, width: columns.len() });
        Some(())
    }

    /// One unit for all blocks.
    fn unit(&mut self, unit: Unit, line: usize, text: &str) -> Option<()> {
        if let Some((before, _)) = self.found.unit.as_ref().filter(|(before, _)| *before != unit) {
            let reason = format!("{} is in {unit}, the block above in {before}", quoted(text));
            self.fault(line, reason, "give both blocks in one unit");
            return None;
        }
        let origin = UnitOrigin::Header { line, text: text.trim_matches('"').into() };
        self.found.unit.get_or_insert((unit, origin));
        Some(())
    }

    fn row(&mut self, line: usize, plan: Plan, fields: &[String]) -> Option<()> {
        self.found.rows += 1;
        if self.found.rows > MAX_ROWS {
            self.fault(line, format!("there are more than {MAX_ROWS} rows"), "thin the table out");
            return None;
        }
        // A remark in the last column may be left empty; blanks cannot show that.
        let least = if self.separator == Separator::Blank { plan.width } else { plan.needed() };
        if !(least..=plan.width).contains(&fields.len()) {
            let reason = format!("has {} columns where {} are expected", fields.len(), plan.width);
            let remedy = "correct the row; decimal commas need a semicolon or a tab between columns";
            self.fault(line, reason, remedy);
            return Some(());
        }
        let Some(at) = self.number(line, fields, plan.at) else { return Some(()) };
        let mut sample = |column: Option<usize>| {
            let value = self.number(line, fields, column?)?;
            Some(Sample { line, at, value })
        };
        let (n, k, unnamed) = (sample(plan.n), sample(plan.k), sample(plan.unnamed));
        self.found.n.extend(n);
        self.found.k.extend(k);
        self.found.unnamed.extend(unnamed);
        Some(())
    }

    /// The number of a field, or a fault.
    fn number(&mut self, line: usize, fields: &[String], column: usize) -> Option<f64> {
        let field = fields.get(column)?;
        match number(field, Some(&mut self.decimal)) {
            Ok(value) => Some(value),
            Err(reason) => {
                self.fault(line, format!("column {}: {reason}", column + 1), "correct the row or leave it out");
                None
            }
        }
    }

    fn fault(&mut self, line: usize, reason: impl Into<String>, remedy: &str) {
        self.log.fault(self.file, line, reason, remedy);
    }
}

impl Plan {
    /// Columns that a row must have.
    fn needed(&self) -> usize {
        let columns = [Some(self.at), self.n, self.k, self.unnamed];
        columns.into_iter().flatten().max().map_or(0, |last| last + 1)
    }

    /// True where a number stands in the first column: the line is a row even if it begins with words.
    fn holds_number(&self, fields: &[String]) -> bool {
        fields.get(self.at).is_some_and(|field| number(field, Some(&mut Decimal::default())).is_ok())
    }
}

/// A row up to a comment behind it.
fn without_comment(line: &str) -> &str {
    let end = ["#", "//", "%"].iter().filter_map(|mark| line.find(mark)).min();
    line.get(..end.unwrap_or(line.len())).unwrap_or(line).trim_end()
}

/// A header up to a comment behind it, which a blank divides: `R%` and `1/cm` are names.
fn without_remark(line: &str) -> &str {
    line.split(" #").next().and_then(|line| line.split(" //").next()).unwrap_or(line).trim_end()
}
