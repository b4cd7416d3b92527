//! Lines of a YAML file, and the texts that stand in them: plain, quoted, or in a block.

/// Lines with their numbers from 1, without blank lines and comments between keys.
pub(super) struct Lines<'a> {
    lines: Vec<&'a str>,
    at: usize,
}

/// Blanks before the first character. A tab counts as a character: YAML forbids it there.
pub(super) fn indent_of(line: &str) -> usize {
    line.len() - line.trim_start_matches(' ').len()
}

impl<'a> Lines<'a> {
    pub fn new(text: &'a str) -> Lines<'a> {
        Lines { lines: text.lines().collect(), at: 0 }
    }

    /// The next line with something on it.
    pub fn peek(&mut self) -> Option<(usize, &'a str)> {
        loop {
            let line = self.lines.get(self.at)?.trim_end();
            if !line.is_empty() && !line.trim_start().starts_with('#') {
                return Some((self.at + 1, line));
            }
            self.at += 1;
        }
    }

    /// Takes the next line with something on it.
    pub fn take(&mut self) -> Option<(usize, &'a str)> {
        let next = self.peek();
        self.at += usize::from(next.is_some());
        next
    }

    /// Takes the lines of a block: blank ones and those further in than `indent`.
    pub fn block(&mut self, indent: usize) -> Vec<(usize, &'a str)> {
        let mut block = Vec::new();
        while let Some(line) = self.lines.get(self.at) {
            if !line.trim().is_empty() && indent_of(line) <= indent {
                break;
            }
            block.push((self.at + 1, line.trim_end()));
            self.at += 1;
        }
        block
    }

    /// The text of a key at `indent`, of which `value` is on its line. Lines are kept apart. `None` when a quote is not
    /// closed.
    pub fn text(&mut self, value: &str, indent: usize) -> Option<String> {
        match value.chars().next() {
            Some('|' | '>') => Some(self.joined(indent, "")),
            Some(quote @ ('"' | '\'')) => {
                let text = self.quoted(quote, value.get(1..).unwrap_or_default())?;
                // A remark or, in a text that is no YAML, more of it.
                self.block(indent);
                Some(text)
            }
            Some('#') | None => {
                // A list may stand at the indent of its key.
                let text = self.joined(indent, "");
                Some(if text.is_empty() { self.list(indent) } else { text })
            }
            Some(_) => Some(self.joined(indent, value.split(" #").next().unwrap_or(value).trim_end())),
        }
    }

    /// What stands on the line of the key, and the block below.
    fn joined(&mut self, indent: usize, first: &str) -> String {
        let block = self.block(indent);
        let lines = std::iter::once(first).chain(block.into_iter().map(|(_, line)| line.trim()));
        lines.filter(|line| !line.is_empty()).collect::<Vec<_>>().join("\n")
    }

    /// Takes the lines of a list whose dashes stand at `indent`.
    fn list(&mut self, indent: usize) -> String {
        let mut text = String::new();
        while let Some((_, line)) = self.peek() {
            let Some(entry) = line.trim_start().strip_prefix("- ").filter(|_| indent_of(line) == indent) else { break };
            self.at += 1;
            text.push_str(&self.joined(indent, entry.trim()));
            text.push('\n');
        }
        text.trim_end().into()
    }

    /// The text up to the closing quote, over as many lines as it takes; a line break is kept.
    fn quoted(&mut self, quote: char, first: &str) -> Option<String> {
        let mut text = String::new();
        let mut line = first;
        loop {
            let mut chars = line.chars().peekable();
            while let Some(c) = chars.next() {
                match c {
                    // In single quotes, two mean one.
                    '\'' if quote == '\'' && chars.peek() == Some(&'\'') => {
                        chars.next();
                        text.push('\'');
                    }
                    '\\' if quote == '"' => text.push(escaped(chars.next())),
                    c if c == quote => return Some(text),
                    c => text.push(c),
                }
            }
            text.push('\n');
            line = self.lines.get(self.at)?.trim();
            self.at += 1;
        }
    }
}

/// The character that a backslash and this one mean.
fn escaped(c: Option<char>) -> char {
    match c {
        Some('n') | None => '\n',
        Some('t') => ' ',
        Some(c) => c,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(source: &str) -> Vec<String> {
        let mut lines = Lines::new(source);
        let mut texts = Vec::new();
        while let Some((_, line)) = lines.take() {
            let (_, value) = line.split_once(':').unwrap();
            texts.push(lines.text(value.trim(), 0).unwrap());
        }
        texts
    }

    #[test]
    fn texts_are_read_in_each_of_the_ways_that_yaml_writes_them() {
        let source = "A: plain # remark\nB: |\n    one\n\n    two\nC: \"quoted \\\"x\\\" over\n  lines\"\nD: 'it''s'\nE:\n  plain\n  below\nF:\n\
                      - a\n- b\nG: >-\n  folded\nH:\n";
        let expected = ["plain", "one\ntwo", "quoted \"x\" over\nlines", "it's", "plain\nbelow", "a\nb", "folded", ""];
        assert_eq!(texts(source), expected);
    }

    #[test]
    fn a_quote_that_is_not_closed_is_told() {
        assert_eq!(Lines::new("").text("\"open", 0), None);
        assert_eq!(Lines::new("more\nlines").text("'open", 0), None);
    }
}
