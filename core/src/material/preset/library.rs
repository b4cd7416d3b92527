//! The presets that come with the program.

use std::path::Path;
use std::sync::LazyLock;

use super::{Preset, PresetError};

/// Files of `presets/metals`, sorted by id. A test holds the list and the folder together.
pub(super) const FILES: [(&str, &str); 57] = [
    ("Ag.json", include_str!("../../../../presets/metals/Ag.json")),
    ("Al.json", include_str!("../../../../presets/metals/Al.json")),
    ("Au.json", include_str!("../../../../presets/metals/Au.json")),
    ("Au.McPeak.json", include_str!("../../../../presets/metals/Au.McPeak.json")),
    ("Au.Olmon-ev.json", include_str!("../../../../presets/metals/Au.Olmon-ev.json")),
    ("Au50Ag50.json", include_str!("../../../../presets/metals/Au50Ag50.json")),
    ("Au70Ag30.json", include_str!("../../../../presets/metals/Au70Ag30.json")),
    ("Be.json", include_str!("../../../../presets/metals/Be.json")),
    ("Bi.json", include_str!("../../../../presets/metals/Bi.json")),
    ("Ca.json", include_str!("../../../../presets/metals/Ca.json")),
    ("Co.json", include_str!("../../../../presets/metals/Co.json")),
    ("Cr.json", include_str!("../../../../presets/metals/Cr.json")),
    ("Cr.Rakic-BB.json", include_str!("../../../../presets/metals/Cr.Rakic-BB.json")),
    ("Cs.json", include_str!("../../../../presets/metals/Cs.json")),
    ("Cu.json", include_str!("../../../../presets/metals/Cu.json")),
    ("Cu.McPeak.json", include_str!("../../../../presets/metals/Cu.McPeak.json")),
    ("Cu.Querry.json", include_str!("../../../../presets/metals/Cu.Querry.json")),
    ("CuZn.json", include_str!("../../../../presets/metals/CuZn.json")),
    ("CuZn10.json", include_str!("../../../../presets/metals/CuZn10.json")),
    ("CuZn15.json", include_str!("../../../../presets/metals/CuZn15.json")),
    ("Fe.json", include_str!("../../../../presets/metals/Fe.json")),
    ("Fe.Querry.json", include_str!("../../../../presets/metals/Fe.Querry.json")),
    ("Ge.json", include_str!("../../../../presets/metals/Ge.json")),
    ("Hg.json", include_str!("../../../../presets/metals/Hg.json")),
    ("In.json", include_str!("../../../../presets/metals/In.json")),
    ("Ir.json", include_str!("../../../../presets/metals/Ir.json")),
    ("K.json", include_str!("../../../../presets/metals/K.json")),
    ("Li.json", include_str!("../../../../presets/metals/Li.json")),
    ("Mg.json", include_str!("../../../../presets/metals/Mg.json")),
    ("Mn.json", include_str!("../../../../presets/metals/Mn.json")),
    ("Mo.json", include_str!("../../../../presets/metals/Mo.json")),
    ("Na.json", include_str!("../../../../presets/metals/Na.json")),
    ("Nb.json", include_str!("../../../../presets/metals/Nb.json")),
    ("Ni.json", include_str!("../../../../presets/metals/Ni.json")),
    ("NiFe.json", include_str!("../../../../presets/metals/NiFe.json")),
    ("Os.json", include_str!("../../../../presets/metals/Os.json")),
    ("Pb.json", include_str!("../../../../presets/metals/Pb.json")),
    ("Pd.json", include_str!("../../../../presets/metals/Pd.json")),
    ("Pt.json", include_str!("../../../../presets/metals/Pt.json")),
    ("Pt.Rakic-BB.json", include_str!("../../../../presets/metals/Pt.Rakic-BB.json")),
    ("Rb.json", include_str!("../../../../presets/metals/Rb.json")),
    ("Rh.json", include_str!("../../../../presets/metals/Rh.json")),
    ("Si.json", include_str!("../../../../presets/metals/Si.json")),
    ("StainlessSteel-austenitic.json", include_str!("../../../../presets/metals/StainlessSteel-austenitic.json")),
    ("StainlessSteel-ferritic.json", include_str!("../../../../presets/metals/StainlessSteel-ferritic.json")),
    ("Ta.json", include_str!("../../../../presets/metals/Ta.json")),
    ("Ti.json", include_str!("../../../../presets/metals/Ti.json")),
    ("Ti.Palm.json", include_str!("../../../../presets/metals/Ti.Palm.json")),
    ("TiN.json", include_str!("../../../../presets/metals/TiN.json")),
    ("TiN.Schnabel.json", include_str!("../../../../presets/metals/TiN.Schnabel.json")),
    ("V.json", include_str!("../../../../presets/metals/V.json")),
    ("V.Palm.json", include_str!("../../../../presets/metals/V.Palm.json")),
    ("VN.json", include_str!("../../../../presets/metals/VN.json")),
    ("W.json", include_str!("../../../../presets/metals/W.json")),
    ("Zn.json", include_str!("../../../../presets/metals/Zn.json")),
    ("Zr.json", include_str!("../../../../presets/metals/Zr.json")),
    ("Zr.Palm.json", include_str!("../../../../presets/metals/Zr.Palm.json")),
];

/// Ids of the presets, in the order of their files.
pub const IDS: [&str; FILES.len()] = {
    let mut ids = [""; FILES.len()];
    let mut i = 0;
    while i < FILES.len() {
        let file = FILES[i].0;
        ids[i] = file.split_at(file.len() - ".json".len()).0;
        i += 1;
    }
    ids
};

/// Parsed once. A file that does not parse would be left out; a test shows that each does.
static LIBRARY: LazyLock<Vec<Preset>> = LazyLock::new(|| {
    let mut presets: Vec<Preset> = FILES.iter().filter_map(|(_, text)| serde_json::from_str(text).ok()).collect();
    presets.sort_by(|a, b| a.id.cmp(&b.id));
    presets
});

/// The presets that come with the program, sorted by id.
pub fn library() -> &'static [Preset] {
    &LIBRARY
}

/// Finds a preset by id (exactly, else without regard to case), by name, or reads the file if the text ends in `.json`.
pub fn find(id_or_path: &str) -> Result<Preset, PresetError> {
    let wanted = id_or_path.trim();
    if wanted.to_ascii_lowercase().ends_with(".json") {
        return Preset::read(Path::new(wanted));
    }
    let lower = wanted.to_lowercase();
    let by_id = library().iter().find(|p| p.id == wanted);
    let found = by_id
        .or_else(|| library().iter().find(|p| p.id.to_lowercase() == lower))
        .or_else(|| library().iter().find(|p| p.name.to_lowercase() == lower));
    found.cloned().ok_or_else(|| {
        let is_table = [".csv", ".txt", ".yml", ".yaml", ".spd"].iter().any(|ending| lower.ends_with(ending));
        let made = "a table becomes a preset by `burnish fit FILE --out PRESET.json`";
        let hint = if is_table { made.into() } else { hint(&lower, &known()) };
        PresetError::Unknown { wanted: wanted.into(), hint }
    })
}

/// Ids and names of all presets.
fn known() -> Vec<(&'static str, &'static str)> {
    library().iter().map(|p| (p.id.as_str(), p.name.as_str())).collect()
}

/// Of ids and names, the ids where either is like the text: begins as it does, contains it, or is at most two edits
/// away; else all.
pub(in crate::material) fn hint(lower: &str, known: &[(&str, &str)]) -> String {
    let like = |text: &str| {
        let text = text.to_lowercase();
        // One-letter texts are within two edits of every short id.
        let contained = lower.chars().count() > 1 && text.contains(lower);
        contained || (lower.chars().count() > 3 && edits(&text, lower) <= 2)
    };
    let near: Vec<&str> = known.iter().filter(|(id, name)| like(id) || like(name)).map(|(id, _)| *id).collect();
    if near.is_empty() {
        let all: Vec<&str> = known.iter().map(|(id, _)| *id).collect();
        format!("there are {}", all.join(", "))
    } else {
        format!("did you mean {}?", near.join(" or "))
    }
}

/// Insertions, deletions and replacements that turn one text into the other (Levenshtein distance).
fn edits(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    // Distances of the part of `a` read so far to every beginning of `b`.
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.chars().enumerate() {
        let mut next = vec![i + 1];
        for (j, cb) in b.iter().enumerate() {
            let replaced = row[j] + usize::from(ca != *cb);
            next.push(replaced.min(row[j + 1] + 1).min(next[j] + 1));
        }
        row = next;
    }
    row[b.len()]
}
