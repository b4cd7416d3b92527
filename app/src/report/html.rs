//! Text for HTML and SVG.

/// Text that is safe between tags and inside quoted attributes. Control characters, which HTML has no place for, become
/// U+FFFD.
pub fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            '\n' | '\t' => escaped.push(' '),
            c if c.is_control() => escaped.push(char::REPLACEMENT_CHARACTER),
            c => escaped.push(c),
        }
    }
    escaped
}

/// A table cell.
pub fn cell(content: &str) -> String {
    format!("<td>{content}</td>")
}

/// A row of a table with a heading on its left.
pub fn row(heading: &str, cells: impl IntoIterator<Item = String>) -> String {
    let cells: String = cells.into_iter().collect();
    format!("<tr><th scope=\"row\">{heading}</th>{cells}</tr>\n")
}

/// The first row of a table.
pub fn head<'a>(titles: impl IntoIterator<Item = &'a str>) -> String {
    let titles: String = titles.into_iter().map(|title| format!("<th scope=\"col\">{title}</th>")).collect();
    format!("<thead><tr>{titles}</tr></thead>\n")
}

/// A table that scrolls sideways where the page is narrow.
pub fn table(class: &str, caption: &str, head: &str, rows: &str) -> String {
    format!(
        "<div class=\"wide\" role=\"region\" aria-label=\"{caption}\" tabindex=\"0\"><table class=\"{class}\">\
         <caption>{caption}</caption>{head}<tbody>\n{rows}</tbody></table></div>\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn foreign_text_cannot_leave_its_place() {
        let escaped = escape("<b a=\"1\" c='2'>&\u{1b}[0m\nx");
        assert_eq!(escaped, "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;&amp;\u{fffd}[0m x");
    }
}
