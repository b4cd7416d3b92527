//! Two files of two columns, one for n and one for k, as renderers keep them: `Au.eta.spd` and `Au.k.spd`,
//! `metal-Au-eta.spd` and `metal-Au-k.spd`, `Au_n.spd` and `Au_k.spd`. Given one, the other is looked for beside it.

use std::path::Path;

use super::Format;
use super::csv::Columns;
use super::curve::Curve;
use super::draft::Draft;
use super::report::Log;

/// Words that end the name of a file of n.
const REAL: [&str; 3] = ["eta", "n", "ior"];

/// Words that end the name of a file of k.
const IMAGINARY: [&str; 2] = ["k", "kappa"];

/// The quantity that a file of two columns holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Side {
    N,
    K,
}

impl Side {
    fn other(self) -> Side {
        match self {
            Side::N => Side::K,
            Side::K => Side::N,
        }
    }

    /// As in messages.
    pub fn symbol(self) -> &'static str {
        match self {
            Side::N => "n",
            Side::K => "k",
        }
    }

    fn words(self) -> &'static [&'static str] {
        match self {
            Side::N => &REAL,
            Side::K => &IMAGINARY,
        }
    }
}

/// A name such as `Au.eta.spd`, divided.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct HalfName {
    /// `Au`; empty for `eta.spd`.
    pub stem: String,
    separator: String,
    pub side: Side,
    capital: bool,
    /// With its point; empty where there is none.
    ending: String,
}

impl HalfName {
    /// `None` when the name does not end in a word for n or k.
    pub fn of(name: &str) -> Option<HalfName> {
        let path = Path::new(name);
        let (stem, ending) = (path.file_stem()?.to_str()?, path.extension().and_then(|e| e.to_str()));
        let at = stem.rfind(['.', '-', '_', ' ']);
        let (before, separator, word) = match at {
            Some(at) => (stem.get(..at)?, stem.get(at..at + 1)?, stem.get(at + 1..)?),
            None => ("", "", stem),
        };
        let lower = word.to_ascii_lowercase();
        let side = [Side::N, Side::K].into_iter().find(|side| side.words().contains(&lower.as_str()))?;
        let ending = ending.map_or(String::new(), |e| format!(".{e}"));
        let capital = word != lower;
        Some(HalfName { stem: before.into(), separator: separator.into(), side, capital, ending })
    }

    /// Names that the other file may have, the likeliest first.
    pub fn siblings(&self) -> Vec<String> {
        let HalfName { stem, separator, side, capital, ending } = self;
        let cased = |word: &str, capital: bool| match capital {
            true => word.chars().take(1).flat_map(char::to_uppercase).chain(word.chars().skip(1)).collect::<String>(),
            false => word.to_string(),
        };
        let words = side.other().words();
        let names = [*capital, !capital].into_iter().flat_map(|capital| words.iter().map(move |word| (word, capital)));
        names.map(|(word, capital)| format!("{stem}{separator}{}{ending}", cased(word, capital))).collect()
    }
}

/// One file of the two.
#[derive(Debug)]
pub(super) struct Half {
    pub file: String,
    /// From the header; else the name of the file tells.
    pub side: Option<Side>,
    pub columns: Columns,
}

impl Half {
    /// A file with columns that hold n or k alone, see [`Half::fits`].
    pub fn new(file: &str, columns: Columns) -> Half {
        let side = match (columns.n.is_empty(), columns.k.is_empty()) {
            (false, _) => Some(Side::N),
            (_, false) => Some(Side::K),
            _ => None,
        };
        Half { file: file.into(), side, columns }
    }

    /// True for columns with n or k alone, not both and not nothing.
    pub fn fits(columns: &Columns) -> bool {
        let Columns { n, k, unnamed, .. } = columns;
        [n, k, unnamed].iter().filter(|samples| !samples.is_empty()).count() == 1
    }

    fn curve(&mut self) -> Curve {
        let Columns { n, k, unnamed, .. } = &mut self.columns;
        let samples = [n, k, unnamed].into_iter().find(|samples| !samples.is_empty()).map(std::mem::take);
        Curve { file: self.file.clone(), samples: samples.unwrap_or_default() }
    }
}

/// Both files together; `None` when they contradict each other.
pub(super) fn paired(mut first: Half, mut second: Half, stem: &str, log: &mut Log) -> Option<Draft> {
    let side_of = |half: &Half| half.side.or_else(|| HalfName::of(&half.file).map(|name| name.side));
    let (Some(side), Some(other)) = (side_of(&first), side_of(&second)) else { return None };
    if side == other {
        let reason = format!("holds {}, as {} does", other.symbol(), first.file);
        log.fault(&second.file, None, reason, "give a file of n and a file of k");
        return None;
    }
    let units = (first.columns.unit.as_ref().map(|u| u.0), second.columns.unit.as_ref().map(|u| u.0));
    if let (Some(a), Some(b)) = units
        && a != b
    {
        let reason = format!("is in {b}, {} in {a}", first.file);
        log.fault(&second.file, None, reason, "give both files in one unit");
        return None;
    }
    log.note(&first.file, None, format!("{} was read from {}", other.symbol(), second.file));
    let (a, b) = (first.curve(), second.curve());
    let (n, k) = if side == Side::N { (a, b) } else { (b, a) };
    let comments = [first.columns.comments, second.columns.comments].concat();
    Some(Draft {
        format: Format::Pair,
        n,
        k,
        unit: first.columns.unit.or(second.columns.unit),
        other: Some(second.file),
        rows: first.columns.rows + second.columns.rows,
        stem: stem.into(),
        source: Default::default(),
        note: super::note_of(&comments),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_other_file_is_named_in_the_same_way() {
        for (name, sibling) in [
            ("Au.eta.spd", "Au.k.spd"),
            ("metal-Au-eta.spd", "metal-Au-k.spd"),
            ("Au_n.spd", "Au_k.spd"),
            ("Au N.txt", "Au K.txt"),
            ("eta.spd", "k.spd"),
        ] {
            assert_eq!(HalfName::of(name).unwrap().siblings()[0], sibling);
        }
        let k = HalfName::of("Au.k.spd").unwrap();
        assert_eq!((k.stem.as_str(), k.side), ("Au", Side::K));
        assert_eq!(k.siblings()[..3], ["Au.eta.spd", "Au.n.spd", "Au.ior.spd"]);
        for name in ["Au.spd", "iron.spd", "", "..", "\u{e9}.\u{e9}"] {
            assert_eq!(HalfName::of(name), None, "{name}");
        }
    }
}
