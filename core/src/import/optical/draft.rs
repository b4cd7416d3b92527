//! From the curves that a reader found to a preset: unit, order, values, one grid, range.

use serde_json::Map;

use super::curve::{Curve, Table, check_signs, check_values, joined, ordered};
use super::report::Log;
use super::{Format, ImportReport, Imported, Options, Unit, UnitOrigin, unit};
use crate::material::preset::{self, Preset, PresetError, REQUIRED_RANGE_NM, Source, reaches_required};

/// Light that is seen, nm.
const VISIBLE_NM: std::ops::RangeInclusive<f64> = 380.0..=780.0;

/// What is kept of a table, nm, with one entry more beyond each end.
const KEPT_NM: std::ops::RangeInclusive<f64> = 300.0..=1000.0;

/// Entries of a preset: with 20 characters a number its file stays below the limit for preset files.
const MAX_POINTS: usize = 50_000;

/// Wider steps in the visible range than this many nm are warned of.
const WIDE_GAP_NM: f64 = 100.0;

/// What to do when the unit is not known.
const SAY_THE_UNIT: &str = "say the unit: --unit nm|um|A|eV";

const NOT_A_METAL: &str = "k is 0 everywhere: a dielectric, not a metal";

/// What a reader found.
#[derive(Debug)]
pub(super) struct Draft {
    pub format: Format,
    pub n: Curve,
    /// Empty for a dielectric.
    pub k: Curve,
    /// What the file says about the unit.
    pub unit: Option<(Unit, UnitOrigin)>,
    /// Name of the second file, of a pair.
    pub other: Option<String>,
    /// Rows of numbers.
    pub rows: usize,
    /// Name without ending; the id is made from it.
    pub stem: String,
    pub source: Source,
    pub note: Option<String>,
}

impl Draft {
    /// Checks and converts. `None` when there is a fault in the log.
    pub fn finish(mut self, options: &Options, log: &mut Log) -> Option<Imported> {
        if options.flip_k {
            self.k.samples.iter_mut().for_each(|s| s.value = 0.0 - s.value);
            log.note(&self.k.file, None, "the sign of k was flipped, as asked for");
        }
        let (table, unit, unit_origin) = self.table(options, log)?;
        let range_nm = self.check_range(&table, log)?;
        let table = self.trimmed(table, log)?;
        warn_of_gaps(&self.n.file, &table.nm, log);
        let report = ImportReport {
            format: self.format,
            unit,
            unit_origin,
            other: self.other.take(),
            rows: self.rows,
            range_nm,
            points: table.nm.len(),
            visible_points: visible_points(&table.nm),
            warnings: std::mem::take(&mut log.warnings),
            notes: std::mem::take(&mut log.notes),
        };
        let file = self.n.file.clone();
        let preset = self.preset(table, &report, options);
        match preset.check(&file) {
            Ok(()) => Some(Imported { preset, report }),
            // An id or a name that was asked for; the table is checked above, and this is the net below.
            Err(error) => {
                refuse(error, &file, log);
                None
            }
        }
    }

    /// Sound values of n and k at the same wavelengths, the unit that they were in, and how it is known.
    fn table(&self, options: &Options, log: &mut Log) -> Option<(Table, Unit, UnitOrigin)> {
        if self.n.samples.is_empty() && !log.failed() {
            log.fault(&self.n.file, None, "holds no rows of numbers", "give rows of wavelength, n and k");
        }
        check_values(&self.n, log);
        check_signs(&self.k, options.flip_k, log);
        let (unit, origin) = self.unit(options, log)?;
        let n = ordered(&self.n, unit, log);
        // What is wrong with the first column of a row is said once.
        let mut said = Log::default();
        let k = ordered(&self.k, unit, if self.n.shares_rows(&self.k) { &mut said } else { log });
        if log.failed() {
            return None;
        }
        if self.k.samples.is_empty() {
            log.warn(&self.n.file, None, "gives n alone; k is 0: a dielectric, not a metal");
        } else if self.k.samples.iter().all(|s| s.value == 0.0) {
            log.warn(&self.k.file, None, NOT_A_METAL);
        }
        Some((joined(n, k), unit, origin))
    }

    /// True when the values alone would be taken for nm.
    pub fn looks_like_nanometres(&self) -> bool {
        self.values_range().and_then(unit::guess).is_some_and(|(unit, _)| unit == Unit::Nanometre)
    }

    /// Asked for, else stated, else guessed.
    fn unit(&self, options: &Options, log: &mut Log) -> Option<(Unit, UnitOrigin)> {
        let file = &self.n.file;
        if let Some(asked) = options.unit {
            if let Some((stated, origin)) = self.unit.as_ref().filter(|(stated, _)| *stated != asked) {
                log.warn(file, None, format!("is in {stated} {origin}, but was read in {asked} as asked for"));
            }
            return Some((asked, UnitOrigin::Asked));
        }
        if let Some(stated) = &self.unit {
            return Some(stated.clone());
        }
        let range = self.values_range()?;
        match unit::guess(range) {
            Some((unit, reason)) => {
                // A table of 0.2 to 20 makes sense in both.
                if unit == Unit::Micrometre && unit.covers(range) && Unit::ElectronVolt.covers(range) {
                    log.warn(file, None, "was read in um, but its values would do in eV too; --unit says which");
                }
                Some((unit, UnitOrigin::Guessed(reason)))
            }
            None => {
                let (least, greatest) = range;
                let reason = format!("names no unit, and the values, {least} to {greatest}, could be of any");
                log.fault(file, None, reason, SAY_THE_UNIT);
                None
            }
        }
    }

    /// Least and greatest value of the first column.
    fn values_range(&self) -> Option<(f64, f64)> {
        let at = || self.n.samples.iter().chain(&self.k.samples).map(|s| s.at);
        let range = (at().fold(f64::INFINITY, f64::min), at().fold(f64::NEG_INFINITY, f64::max));
        range.0.is_finite().then_some(range)
    }

    /// First and last wavelength of a table, nm, that leaves no part of the visible range out.
    fn check_range(&self, table: &Table, log: &mut Log) -> Option<(f64, f64)> {
        let (file, count) = (&self.n.file, table.nm.len());
        let (need_from, need_to) = REQUIRED_RANGE_NM;
        let visible = visible_points(&table.nm);
        let (Some(&from), Some(&to)) = (table.nm.first(), table.nm.last()) else {
            log.fault(file, None, "n and k have no wavelength in common", "give both over the same range");
            return None;
        };
        if count < 2 {
            log.fault(file, None, format!("holds n and k at {count} wavelength"), "a curve needs two points or more");
        } else if !reaches_required(from, to) {
            let seen = if visible == 0 { ", nothing of the visible range" } else { "" };
            let reason = format!("covers {from} to {to} nm{seen}; {need_from} to {need_to} nm are needed");
            log.fault(file, None, reason, &self.other_units());
        } else if visible < 2 {
            let points = if visible == 1 { "1 point" } else { "no point" };
            let reason = format!("has {points} from 380 to 780 nm");
            log.fault(file, None, reason, "take a table with more points in the visible range");
        }
        (!log.failed()).then_some((from, to))
    }

    /// The remedy for a range that does not fit: units in which the values would fit.
    fn other_units(&self) -> String {
        let range = self.values_range().unwrap_or((1.0, 1.0));
        let fitting = Unit::ALL.iter().filter(|unit| unit.covers(range));
        let fitting: Vec<String> = fitting.map(|unit| format!("--unit {unit}")).collect();
        match fitting.is_empty() {
            true => "take a table that reaches further".into(),
            false => format!("if the unit is wrong, say {}", fitting.join(" or ")),
        }
    }

    /// Entries from 300 to 1000 nm and one beyond each end, if they are not too many.
    fn trimmed(&self, table: Table, log: &mut Log) -> Option<Table> {
        let Table { nm, n, k } = table;
        let first = nm.partition_point(|w| w < KEPT_NM.start()).saturating_sub(1);
        let end = (nm.partition_point(|w| w <= KEPT_NM.end()) + 1).min(nm.len());
        let kept = |values: Vec<f64>| values.get(first..end).unwrap_or_default().to_vec();
        let dropped = nm.len() - (end - first);
        let table = Table { nm: kept(nm), n: kept(n), k: kept(k) };
        if let (true, [from, .., to]) = (dropped > 0, table.nm.as_slice()) {
            let text = format!("{dropped} entries outside of {from} to {to} nm were left out; no light is seen there");
            log.note(&self.n.file, None, text);
        }
        if table.nm.len() > MAX_POINTS {
            let reason = format!("has {} entries from 300 to 1000 nm, over the limit of {MAX_POINTS}", table.nm.len());
            log.fault(&self.n.file, None, reason, "thin the table out");
            return None;
        }
        Some(table)
    }

    fn preset(self, table: Table, report: &ImportReport, options: &Options) -> Preset {
        let warnings: Vec<&str> = report.warnings.iter().map(|w| w.text.as_str()).collect();
        let mut source = self.source;
        source.table.get_or_insert(format!("imported from {}", self.n.file));
        Preset {
            format: preset::FORMAT.into(),
            version: preset::VERSION,
            id: options.id.clone().unwrap_or_else(|| id_of(&self.stem)),
            name: options.name.clone().unwrap_or_else(|| name_of(&self.stem)),
            symbol: None,
            tags: Vec::new(),
            source,
            note: self.note,
            warning: (!warnings.is_empty()).then(|| warnings.join("; ")),
            wavelength_nm: table.nm,
            n: table.n,
            k: table.k,
            fits: None,
            other: Map::new(),
        }
    }
}

/// What a preset says against itself, as a fault of the file that it was made from.
pub(super) fn refuse(error: PresetError, file: &str, log: &mut Log) {
    match error {
        PresetError::Field { field, reason, remedy, .. } => {
            log.fault(file, None, format!("field `{field}` {reason}"), remedy);
        }
        other => log.fault(file, None, other.to_string(), "write it as presets/README.md shows"),
    }
}

/// The report about a preset that was read as it is.
pub(super) fn report_of(preset: &Preset, file: &str, mut log: Log) -> ImportReport {
    let nm = &preset.wavelength_nm;
    if preset.k.iter().all(|k| *k == 0.0) {
        log.warn(file, None, NOT_A_METAL);
    }
    warn_of_gaps(file, nm, &mut log);
    ImportReport {
        format: Format::Preset,
        unit: Unit::Nanometre,
        unit_origin: UnitOrigin::Definition,
        other: None,
        rows: nm.len(),
        range_nm: (nm.first().copied().unwrap_or(0.0), nm.last().copied().unwrap_or(0.0)),
        points: nm.len(),
        visible_points: visible_points(nm),
        warnings: log.warnings,
        notes: log.notes,
    }
}

fn visible_points(nm: &[f64]) -> usize {
    nm.iter().filter(|nm| VISIBLE_NM.contains(nm)).count()
}

/// Between two entries n and k are taken to be straight, which no metal is over so wide a gap.
fn warn_of_gaps(file: &str, nm: &[f64], log: &mut Log) {
    for pair in nm.windows(2) {
        let &[from, to] = pair else { continue };
        let seen = from < *VISIBLE_NM.end() && to > *VISIBLE_NM.start();
        if seen && to - from > WIDE_GAP_NM {
            let text = format!("there is nothing between {from} and {to} nm; n and k are straight lines there");
            log.warn(file, None, text);
        }
    }
}

/// Longest id that a preset may have.
const MAX_ID: usize = 64;

/// An id that a preset may have: what is not allowed becomes `-`.
fn id_of(stem: &str) -> String {
    let mut id = String::new();
    for c in stem.trim().chars().take(MAX_ID) {
        let allowed = c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '_');
        match if allowed { c } else { '-' } {
            // One for several.
            '-' if id.ends_with('-') || id.is_empty() => {}
            '.' if id.is_empty() => {}
            c => id.push(c),
        }
    }
    let id = id.trim_end_matches(['-', '.']);
    if id.is_empty() { "metal".into() } else { id.into() }
}

fn name_of(stem: &str) -> String {
    let name: String = stem.trim().chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    if name.trim().is_empty() { "Metal".into() } else { name }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_id_holds_only_what_a_preset_allows() {
        for (stem, id) in [
            ("Au", "Au"),
            ("metal-Au", "metal-Au"),
            ("Johnson & Christy (1972)", "Johnson-Christy-1972"),
            ("../x", "x"),
            (".hidden", "hidden"),
            ("\u{91d1}", "metal"),
            ("", "metal"),
            ("a.", "a"),
        ] {
            assert_eq!(id_of(stem), id, "{stem}");
        }
        assert_eq!(id_of(&"x".repeat(99)).len(), MAX_ID);
    }
}
