//! What is wrong with a table, and where.

use core::fmt;

/// Most characters of a problem and of a field's name that are shown: either may quote the text.
const MOST_PROBLEM: usize = 400;
const MOST_FIELD: usize = 60;
/// The same of an element's name, which is escaped when it is shown. Names that are right are shorter.
const MOST_ELEMENT: usize = 50;

/// What is wrong with a table: where, and what would be right.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub struct TableError {
    /// The file's name, as given by the caller.
    pub file: String,
    /// From 1; 0 where no line is to blame.
    pub line: usize,
    /// The element, material, group or rule, if it is about one.
    pub element: Option<String>,
    /// The field, if it is about one.
    pub field: Option<String>,
    /// What is wrong, and what would be right.
    pub problem: String,
}

impl TableError {
    /// The same, fit for a line of a log: whoever wrote the table has written some of it.
    pub(super) fn readable(mut self) -> Self {
        self.problem = readable(&self.problem, MOST_PROBLEM);
        self.field = self.field.map(|field| readable(&field, MOST_FIELD));
        if let Some(element) = &mut self.element
            && let Some((end, _)) = element.char_indices().nth(MOST_ELEMENT)
        {
            element.truncate(end);
            element.push_str("...");
        }
        self
    }
}

/// A complaint, or about `most` characters of it, with those escaped that a terminal would obey.
pub(crate) fn readable(complaint: &str, most: usize) -> String {
    let mut text = String::new();
    let mut length = 0;
    for c in complaint.chars() {
        if length >= most {
            text.push_str("...");
            break;
        }
        if matches!(c, '"' | '\'' | '\\') {
            // A complaint's own signs.
            text.push(c);
            length += 1;
        } else {
            text.extend(c.escape_debug());
            length += c.escape_debug().count();
        }
    }
    text
}

impl fmt::Display for TableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file)?;
        if self.line > 0 {
            write!(f, ":{}", self.line)?;
        }
        write!(f, ": ")?;
        if let Some(element) = &self.element {
            // Quoted and escaped: a name that is wrong may hold anything.
            write!(f, "{element:?}: ")?;
        }
        if let Some(field) = &self.field {
            write!(f, "field `{field}`: ")?;
        }
        write!(f, "{}", self.problem)
    }
}

#[cfg(test)]
mod tests {
    use crate::table::{SHIPPED, Table};

    /// Broke: a complaint quoted whatever the text said in full, as it was.
    #[test]
    fn a_complaint_is_short_and_plain_whatever_it_quotes() {
        let good = SHIPPED[0].source;
        let long = "restitution".repeat(5000);
        let texts = [
            good.replacen("restitution", &long, 1),
            good.replacen("name: \"", &format!("name: \"{long}"), 2),
            good.replacen("Wall(", &format!("{long}("), 1),
            good.replacen("name: \"", "name: \"\u{1b}[2J\u{202e}\", \u{202e}: 1", 1),
            good.replacen("name: \"", &format!("name: \"{}", "\u{1b}".repeat(9000)), 2),
        ];
        for text in texts {
            let error = Table::parse("bad.ron", &text).expect_err("it is wrong").to_string();
            assert!(error.chars().count() < 1000, "{} characters: {error:.300}", error.chars().count());
            assert!(!error.chars().any(|c| c.is_control() || c == '\u{202e}'), "{error:?}");
        }
    }
}
