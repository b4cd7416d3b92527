//! The references of the refractiveindex.info database: text for people with HTML or Markdown in it.

use serde_json::Value;

use crate::material::preset::Source;

/// Author, title, journal, year and DOI, where the text has the layout that the database uses: authors, title, then the
/// journal as a link to its DOI. The whole text is kept as `reference` where it says more, and is all there is where it
/// is laid out in another way.
pub(super) fn source(reference: &str) -> Source {
    let whole = plain(reference);
    let mut source = Source::default();
    if whole.is_empty() {
        return source;
    }
    let split = (!numbered(&whole)).then(|| split(reference)).flatten();
    let Some(Parts { author, title, journal, year, doi, rest }) = split else {
        source.year = year_of(&whole).map(|(year, _)| year);
        source.other.insert("reference".into(), Value::String(whole));
        return source;
    };
    source.author = Some(author).filter(|text| !text.is_empty());
    source.journal = Some(journal).filter(|text| !text.is_empty());
    source.title = Some(title).filter(|text| !text.is_empty());
    (source.year, source.doi) = (year, Some(doi));
    if !rest.is_empty() {
        source.other.insert("reference".into(), Value::String(whole));
    }
    source
}

struct Parts {
    author: String,
    title: String,
    journal: String,
    year: Option<u32>,
    doi: String,
    /// What follows the link.
    rest: String,
}

/// True when the text lists several works.
fn numbered(text: &str) -> bool {
    text.starts_with("1)")
}

fn split(reference: &str) -> Option<Parts> {
    let (before, label, target, after) = html_link(reference).or_else(|| markdown_link(reference))?;
    let doi = target.split_once("doi.org/")?.1.trim().to_string();
    let label = plain(label);
    let (journal, year) = match year_of(&label) {
        Some((year, at)) => (label.get(..at).unwrap_or_default().trim_end_matches([' ', '(']).to_string(), Some(year)),
        None => (label, None),
    };
    let (author, title) = author_and_title(before);
    Some(Parts { author, title, journal, year, doi, rest: plain(after) })
}

/// What is before the first HTML link to a DOI, its label, its target, and what is after.
fn html_link(text: &str) -> Option<(&str, &str, &str, &str)> {
    let (before, rest) = text.split_once("<a ")?;
    let (attributes, rest) = rest.split_once('>')?;
    let (label, after) = rest.split_once("</a>")?;
    let target = attributes.split_once("href=\"")?.1.split('"').next()?;
    Some((before, label, target, after))
}

/// The same of a Markdown link.
fn markdown_link(text: &str) -> Option<(&str, &str, &str, &str)> {
    let (head, rest) = text.split_once("](")?;
    let (before, label) = head.rsplit_once('[')?;
    // An old DOI may hold parentheses.
    let mut open = 1;
    let end = rest.find(|c| {
        open += i32::from(c == '(') - i32::from(c == ')');
        open == 0
    })?;
    let (target, after) = rest.split_at_checked(end)?;
    Some((before, label, target, after.get(1..).unwrap_or_default()))
}

/// Authors are on the first line; in a text of one line they end with the first point behind a word that is no initial.
fn author_and_title(before: &str) -> (String, String) {
    let tidy = |text: &str| plain(text).trim_end_matches([',', ' ']).to_string();
    if let Some((author, title)) = before.trim().split_once('\n') {
        return (without_point(&tidy(author)), without_point(&tidy(title)));
    }
    let text = tidy(before);
    let mut from = 0;
    while let Some(point) = text.get(from..).and_then(|rest| rest.find(". ")).map(|at| at + from) {
        let author = text.get(..point).unwrap_or_default();
        let last = author.rsplit([' ', '-', '.']).next().unwrap_or_default();
        if last.chars().count() > 2 {
            let title = text.get(point + 2..).unwrap_or_default();
            return (author.into(), without_point(title));
        }
        from = point + 2;
    }
    (without_point(&text), String::new())
}

/// Without the point at the end, unless it belongs to an initial.
fn without_point(text: &str) -> String {
    let bare = text.trim_end_matches('.');
    let initial = bare.rsplit([' ', '-', '.']).next().is_some_and(|word| word.chars().count() == 1);
    if initial { text.into() } else { bare.into() }
}

/// The last year in parentheses, and where its parenthesis opens.
fn year_of(text: &str) -> Option<(u32, usize)> {
    let places = text.match_indices('(').rev();
    let mut years = places.filter_map(|(at, _)| {
        let digits = text.get(at + 1..at + 5)?;
        let closed = text.get(at + 5..)?.starts_with(')');
        let year: u32 = digits.parse().ok().filter(|_| digits.bytes().all(|b| b.is_ascii_digit()))?;
        (closed && (1500..2200).contains(&year)).then_some((year, at))
    });
    years.next()
}

/// Text without tags, Markdown and entities, in one line.
pub(super) fn plain(text: &str) -> String {
    let mut bare = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(open) = rest.find('<') {
        let (before, tag) = rest.split_at(open);
        bare.push_str(before);
        rest = tag;
        let named = tag.get(1..).is_some_and(|t| t.starts_with(|c: char| c.is_ascii_alphabetic() || c == '/'));
        if !named {
            bare.push('<');
            rest = tag.get(1..).unwrap_or_default();
            continue;
        }
        // Where this tag has no end, none behind it has one.
        let Some(close) = tag.find('>') else { break };
        // A new line divides words, a subscript does not.
        if tag.get(..3).is_some_and(|t| t.eq_ignore_ascii_case("<br")) {
            bare.push(' ');
        }
        rest = tag.get(close + 1..).unwrap_or_default();
    }
    bare.push_str(rest);
    for (entity, character) in
        [("&nbsp;", " "), ("&ndash;", "-"), ("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&amp;", "&")]
    {
        bare = bare.replace(entity, character);
    }
    let bare = bare.replace("**", "").replace('*', "");
    let visible: String = bare.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    visible.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn other<'a>(source: &'a Source, key: &str) -> &'a str {
        source.other.get(key).and_then(Value::as_str).unwrap_or_default()
    }

    #[test]
    fn a_reference_in_markdown_is_divided() {
        let s = source(
            "P. B. Johnson and R. W. Christy.\nOptical constants of the noble metals.\n\
             [*Phys. Rev. B* **6**, 4370-4379 (1972)](https://doi.org/10.1103/PhysRevB.6.4370)\n",
        );
        assert_eq!(s.author.as_deref(), Some("P. B. Johnson and R. W. Christy"));
        assert_eq!(s.title.as_deref(), Some("Optical constants of the noble metals"));
        assert_eq!(s.journal.as_deref(), Some("Phys. Rev. B 6, 4370-4379"));
        assert_eq!((s.year, s.doi.as_deref()), (Some(1972), Some("10.1103/PhysRevB.6.4370")));
        assert_eq!(other(&s, "reference"), "");
    }

    #[test]
    fn a_reference_in_one_line_of_html_is_divided_behind_the_initials() {
        let s = source(
            "W. S. M. Werner, K. Glantschnig, C. Ambrosch-Draxl. Optical constants and data for 17 metals, \
             <a href=\"https://doi.org/10.1063/1.3243762\"><i>J. Phys Chem Ref. Data</i> <b>38</b>, 1013-1092 (2009)</a>\
             <br>(Data &amp; more)",
        );
        assert_eq!(s.author.as_deref(), Some("W. S. M. Werner, K. Glantschnig, C. Ambrosch-Draxl"));
        assert_eq!(s.title.as_deref(), Some("Optical constants and data for 17 metals"));
        assert_eq!(s.journal.as_deref(), Some("J. Phys Chem Ref. Data 38, 1013-1092"));
        assert_eq!((s.year, s.doi.as_deref()), (Some(2009), Some("10.1063/1.3243762")));
        assert!(other(&s, "reference").ends_with("(2009) (Data & more)"), "{}", other(&s, "reference"));
    }

    #[test]
    fn a_reference_of_another_layout_is_kept_whole() {
        for text in ["SCHOTT Zemax catalog", "1) A. [B (1975)](https://doi.org/10.1/x)<br>\n2) C.", "x </a> <b", "]("] {
            let s = source(text);
            assert_eq!((&s.author, &s.doi), (&None, &None), "{text}");
            assert_eq!(other(&s, "reference"), plain(text));
        }
        assert_eq!(source(" \n"), Source::default());
    }

    #[test]
    fn a_doi_keeps_its_parentheses_and_an_initial_its_point() {
        let s = source("Bee, A.\nT.\n[*J.* **1** (1970)](https://doi.org/10.1016/0022-3093(70)90123-X)");
        assert_eq!(s.doi.as_deref(), Some("10.1016/0022-3093(70)90123-X"));
        assert_eq!(s.author.as_deref(), Some("Bee, A."));
    }

    #[test]
    fn tags_go_and_comparisons_stay() {
        assert_eq!(plain("Al<sub>2</sub>O<sub>3</sub>,<br>k < 1 and n > 2"), "Al2O3, k < 1 and n > 2");
        assert_eq!(plain("<i>a</i> <b c <d e"), "a <b c <d e");
        // In a time that grows with the length, not with its square.
        let open = "<a".repeat(1 << 20);
        assert_eq!(plain(&open), open);
    }
}
