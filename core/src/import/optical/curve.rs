//! n or k as a reader found it, row by row; from there to both over the same increasing wavelengths in nm.

use super::Unit;
use super::report::Log;
use crate::color::spectrum::interpolate;

/// One row about one quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    /// From 1; 0 for what was computed.
    pub line: usize,
    /// Wavelength or energy, in the unit of the file.
    pub at: f64,
    /// n or k.
    pub value: f64,
}

impl Sample {
    fn line(&self) -> Option<usize> {
        (self.line > 0).then_some(self.line)
    }
}

/// One quantity with the file that it comes from.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Curve {
    /// Name of the file or text.
    pub file: String,
    /// As in the file.
    pub samples: Vec<Sample>,
}

impl Curve {
    /// True when both are columns of the same rows.
    pub fn shares_rows(&self, other: &Curve) -> bool {
        let rows = |curve: &Curve| curve.samples.iter().map(|s| (s.line, s.at)).collect::<Vec<_>>();
        self.file == other.file && rows(self) == rows(other)
    }
}

/// One quantity over increasing wavelengths in nm.
pub(super) struct Spectrum {
    pub nm: Vec<f64>,
    pub values: Vec<f64>,
}

/// n is above 0.
pub(super) fn check_values(n: &Curve, log: &mut Log) {
    for sample in n.samples.iter().filter(|s| s.value <= 0.0) {
        let reason = format!("n is {}", sample.value);
        log.fault(&n.file, sample.line(), reason, "n of a metal is above 0; correct the row or leave it out");
    }
}

/// k is 0 or more; a file of n - ik has all of them below, one whose sign was flipped without need too.
pub(super) fn check_signs(k: &Curve, flipped: bool, log: &mut Log) {
    let negative = || k.samples.iter().filter(|s| s.value < 0.0);
    let Some(first) = negative().next() else { return };
    if k.samples.iter().all(|s| s.value <= 0.0) {
        let (reason, remedy) = match flipped {
            true => ("all k are positive in the file, and its sign was to be flipped", "leave --flip-k away"),
            false => (
                "all k are negative: the file gives n - ik, Burnish reads n + ik",
                "if that is meant, ask for the other sign: --flip-k",
            ),
        };
        log.fault(&k.file, first.line(), reason, remedy);
        return;
    }
    for sample in negative() {
        let remedy = "the index is n + ik with k of 0 or more; correct the row or leave it out";
        log.fault(&k.file, sample.line(), format!("k is {}", sample.value), remedy);
    }
}

/// Over increasing wavelength. A table that decreases from row to row is turned round; one that goes forth and back is
/// a fault.
pub(super) fn ordered(curve: &Curve, unit: Unit, log: &mut Log) -> Spectrum {
    let Curve { file, samples } = curve;
    let mut positive = true;
    for sample in samples.iter().filter(|s| s.at <= 0.0) {
        positive = false;
        log.fault(file, sample.line(), format!("the first column is {}", sample.at), "it must be above 0");
    }
    let falls = samples.windows(2).filter(|w| matches!(w, [a, b] if b.at < a.at)).count();
    let falling = 2 * falls > samples.len().saturating_sub(1);
    for pair in samples.windows(2) {
        let [before, here] = pair else { continue };
        if here.at == before.at {
            let reason = format!("repeats {}, the wavelength of the row before", here.at);
            log.fault(file, here.line(), reason, "keep one of the two");
        } else if (here.at < before.at) != falling {
            let way = if falling { "forward" } else { "back" };
            let reason = format!("steps {way} from {} to {}", before.at, here.at);
            log.fault(file, here.line(), reason, "sort the rows by wavelength");
        }
    }
    let nm: Vec<f64> = if positive { samples.iter().map(|s| unit.nm(s.at)).collect() } else { Vec::new() };
    let mut spectrum = Spectrum { nm, values: samples.iter().map(|s| s.value).collect() };
    if matches!(spectrum.nm.as_slice(), [a, b, ..] if b < a) {
        spectrum.nm.reverse();
        spectrum.values.reverse();
        log.note(file, None, "lists long wavelengths first; the order was turned round");
    }
    spectrum
}

/// n and k at the same increasing wavelengths, nm.
pub(super) struct Table {
    pub nm: Vec<f64>,
    pub n: Vec<f64>,
    pub k: Vec<f64>,
}

/// As they are where both have the same wavelengths; else at those of both, each linear in between, where both reach.
pub(super) fn joined(n: Spectrum, k: Spectrum) -> Table {
    if k.nm.is_empty() {
        let zeros = vec![0.0; n.nm.len()];
        return Table { nm: n.nm, n: n.values, k: zeros };
    }
    if n.nm == k.nm {
        return Table { nm: n.nm, n: n.values, k: k.values };
    }
    let first = |s: &Spectrum| s.nm.first().copied().unwrap_or(f64::INFINITY);
    let last = |s: &Spectrum| s.nm.last().copied().unwrap_or(f64::NEG_INFINITY);
    let (from, to) = (first(&n).max(first(&k)), last(&n).min(last(&k)));
    let both = n.nm.iter().chain(&k.nm).copied();
    let mut nm: Vec<f64> = both.filter(|w| (from..=to).contains(w)).collect();
    nm.sort_by(f64::total_cmp);
    nm.dedup();
    let at = |s: &Spectrum| nm.iter().map(|w| interpolate(&s.nm, &s.values, *w)).collect();
    let (n, k) = (at(&n), at(&k));
    Table { nm, n, k }
}
