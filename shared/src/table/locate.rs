//! Finds the line of a text in RON, a table's or a replay's, that an error is about.
//!
//! Once RON is parsed, its values no longer know where they stood. They are found again by the way that leads to them:
//! through fields, keys of maps and items of lists. Names are not searched for: they may be missing, double or escaped.

use core::ops::Range;

/// One step on the way to a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Step<'a> {
    /// A field of a struct.
    Field(&'a str),
    /// A key of a map.
    Key(&'a str),
    /// An item of a list, a tuple or a variant, from 0.
    Item(usize),
}

/// The line, from 1, on which the value at the end of the way begins; of the last step that is there, if the whole way
/// is not. 0 if not even the first is.
pub(crate) fn line_of(source: &str, way: &[Step<'_>]) -> usize {
    let masked = mask(source);
    let mut value = table(&masked)..masked.len();
    let mut found = None;
    for &step in way {
        let Some((at, next)) = descend(source, &masked, value, step) else { break };
        (found, value) = (Some(at), next);
    }
    found.map_or(0, |at| line_at(&masked, at))
}

/// Where a field of the table stands, from its name to the end of its value.
pub(super) fn field_range(source: &str, field: &str) -> Option<Range<usize>> {
    let masked = mask(source);
    let (start, value) = descend(source, &masked, table(&masked)..masked.len(), Step::Field(field))?;
    let end = value.start + masked[value].trim_ascii_end().len();
    Some(start..end)
}

/// The name of the innermost element around a place in the text: what a complaint of the parser is about.
pub(super) fn element_at(source: &str, line: usize, column: usize) -> Option<String> {
    let masked = mask(source);
    let before_line: usize = masked.split_inclusive(|&byte| byte == b'\n').take(line.max(1) - 1).map(<[u8]>::len).sum();
    let line_text = source.get(before_line..)?;
    let at = before_line + line_text.chars().take(column.max(1) - 1).map(char::len_utf8).sum::<usize>();
    let mut inner = at;
    while let Some(open) = opening(&masked, inner) {
        // The outermost parenthesis is the table's own, and its name no element's.
        opening(&masked, open)?;
        if let Some((_, value)) = descend(source, &masked, open..masked.len(), Step::Field("name")) {
            return ron::from_str(source.get(value)?.trim()).ok();
        }
        inner = open;
    }
    None
}

/// The word before the table's first bracket, such as `Scene` in `Scene(...)`; `None` if there is none.
pub(super) fn first_word(source: &str) -> Option<&str> {
    let masked = mask(source);
    let from = table(&masked);
    let open = masked[from..].iter().position(|&byte| byte == b'(')?;
    let word = masked[from..from + open].trim_ascii();
    let end = from + open - (masked[from..from + open].len() - masked[from..from + open].trim_ascii_end().len());
    source.get(end - word.len()..end).filter(|word| !word.is_empty())
}

fn line_at(masked: &[u8], at: usize) -> usize {
    1 + masked[..at].iter().filter(|&&byte| byte == b'\n').count()
}

/// Where the table begins: behind lines such as `#![enable(...)]`.
fn table(masked: &[u8]) -> usize {
    let mut at = 0;
    while masked[at..].trim_ascii_start().starts_with(b"#") {
        at += masked[at..].iter().position(|&byte| byte == b']').map_or(masked.len() - at, |end| end + 1);
    }
    at
}

/// From a value one step further: where that begins, and the extent of its value.
fn descend(source: &str, masked: &[u8], value: Range<usize>, step: Step<'_>) -> Option<(usize, Range<usize>)> {
    items(masked, value).enumerate().find_map(|(place, item)| {
        let start = item.end - masked[item.clone()].trim_ascii_start().len();
        let label = masked[item.clone()].iter().position(|&byte| byte == b':').map(|colon| item.start + colon);
        let labelled = |colon: usize| (start, colon + 1..item.end);
        match step {
            Step::Item(wanted) => (place == wanted).then_some((start, start..item.end)),
            Step::Field(wanted) => {
                label.filter(|&colon| masked[start..colon].trim_ascii() == wanted.as_bytes()).map(labelled)
            }
            Step::Key(wanted) => label
                .filter(|&colon| {
                    let key = source.get(start..colon).map(str::trim);
                    key.and_then(|key| ron::from_str::<String>(key).ok()).is_some_and(|key| key == wanted)
                })
                .map(labelled),
        }
    })
}

/// The items between the first bracket of a value and the one that closes it.
fn items(masked: &[u8], value: Range<usize>) -> impl Iterator<Item = Range<usize>> {
    let open = masked[value.clone()].iter().position(|byte| b"([{".contains(byte)).map(|at| value.start + at);
    let mut next = open.map(|open| open + 1);
    core::iter::from_fn(move || {
        let start = next?;
        let mut depth = 0;
        for at in start..masked.len() {
            match masked[at] {
                b'(' | b'[' | b'{' => depth += 1,
                b')' | b']' | b'}' if depth == 0 => {
                    next = None;
                    return (!masked[start..at].trim_ascii().is_empty()).then_some(start..at);
                }
                b')' | b']' | b'}' => depth -= 1,
                b',' if depth == 0 => {
                    next = Some(at + 1);
                    return Some(start..at);
                }
                _ => {}
            }
        }
        next = None;
        Some(start..masked.len())
    })
}

/// The parenthesis that is open at `at`.
fn opening(masked: &[u8], at: usize) -> Option<usize> {
    let mut depth = 0;
    for (place, &byte) in masked[..at.min(masked.len())].iter().enumerate().rev() {
        match byte {
            b')' => depth += 1,
            b'(' if depth == 0 => return Some(place),
            b'(' => depth -= 1,
            _ => {}
        }
    }
    None
}

/// The text with comments and the insides of strings blanked, byte for byte.
fn mask(source: &str) -> Vec<u8> {
    let mut masked = source.as_bytes().to_vec();
    let mut at = 0;
    while at < masked.len() {
        let rest = &masked[at..];
        let (hidden, end) = if rest.starts_with(b"//") {
            let end = after(&masked, at, b"\n");
            (at..end, end)
        } else if rest.starts_with(b"/*") {
            let end = end_of_comment(&masked, at);
            (at..end, end)
        } else if rest.starts_with(b"r\"") || rest.starts_with(b"r#") {
            let fence = rest[1..].iter().take_while(|&&byte| byte == b'#').count();
            let close = [&b"\""[..], &b"#".repeat(fence)].concat();
            let end = after(&masked, at + fence + 2, &close);
            (at + fence + 2..end.saturating_sub(close.len()), end)
        } else if rest.starts_with(b"\"") {
            let mut end = at + 1;
            while end < masked.len() && masked[end] != b'"' {
                end += if masked[end] == b'\\' { 2 } else { 1 };
            }
            let end = end.min(masked.len());
            (at + 1..end, end + 1)
        } else {
            at += 1;
            continue;
        };
        for byte in masked.get_mut(hidden).unwrap_or_default() {
            if *byte != b'\n' {
                *byte = b' ';
            }
        }
        at = end;
    }
    masked
}

/// Behind the next `what`, from `from` on.
fn after(bytes: &[u8], from: usize, what: &[u8]) -> usize {
    let rest = bytes.get(from..).unwrap_or_default();
    let found = rest.windows(what.len()).position(|window| window == what);
    found.map_or(bytes.len(), |at| from + at + what.len())
}

/// Block comments nest.
fn end_of_comment(bytes: &[u8], from: usize) -> usize {
    let mut depth = 0;
    let mut at = from;
    while at < bytes.len() {
        let step = match &bytes[at..] {
            [b'/', b'*', ..] => {
                depth += 1;
                2
            }
            [b'*', b'/', ..] => {
                depth -= 1;
                2
            }
            _ => 1,
        };
        at += step;
        if depth == 0 {
            break;
        }
    }
    at
}

#[cfg(test)]
mod tests {
    use super::Step::{Field, Item, Key};
    use super::*;

    const TEXT: &str = r##"#![enable(implicit_some)]
(
    size: (1.0, 2.0), // name: "post", elements: [
    materials: {
        "rubber": (
            restitution: 0.8,
        ),
        "R\u{f6}hre": (restitution: 0.1),
    },
    elements: [
        Post(name: "a (b", radius: 1.0),
        Post(
            name: r#"a "post"#,
            /* radius: 3 /* nested */ , */
            radius: 2.0,
        ),
        Wall(points: [
            (0.0, 1.0), (1.0, 1.0),
            (2.0, 2.0),
        ], name: "last"),
    ],
)"##;

    #[test]
    fn a_way_leads_to_its_line() {
        let element = |place| [Field("elements"), Item(place)];
        let way = |place, field| line_of(TEXT, &[&element(place)[..], &[Field(field)]].concat());
        assert_eq!(line_of(TEXT, &[Field("size")]), 3);
        assert_eq!(way(0, "radius"), 11);
        assert_eq!(way(1, "radius"), 15);
        assert_eq!(way(1, "name"), 13);
        assert_eq!(way(2, "name"), 20);
        assert_eq!(line_of(TEXT, &[Field("elements"), Item(2), Field("points"), Item(2)]), 19);
        assert_eq!(line_of(TEXT, &[Field("materials"), Key("rubber"), Field("restitution")]), 6);
        assert_eq!(line_of(TEXT, &[Field("materials"), Key("Röhre"), Field("restitution")]), 8);
    }

    #[test]
    fn a_way_that_breaks_off_leads_as_far_as_it_goes() {
        assert_eq!(line_of(TEXT, &[Field("elements"), Item(1), Field("missing")]), 12);
        assert_eq!(line_of(TEXT, &[Field("elements"), Item(9)]), 10);
        assert_eq!(line_of(TEXT, &[Field("nothing"), Item(0)]), 0);
    }

    #[test]
    fn the_element_around_a_place_is_the_innermost() {
        assert_eq!(element_at(TEXT, 15, 13).as_deref(), Some("a \"post"));
        assert_eq!(element_at(TEXT, 19, 14).as_deref(), Some("last"));
        assert_eq!(element_at(TEXT, 3, 12), None);
        assert_eq!(element_at(TEXT, 99, 99), None);
    }

    #[test]
    fn broken_text_has_no_lines_but_does_no_harm() {
        for text in ["", "\"", "/*", "(((", "(name:\"x", "\"\\", "r#\"", "#![", "(a: [}", "ö(ö:ö"] {
            let line = line_of(text, &[Field("x"), Item(0), Key("y")]);
            assert!(line <= 1, "{text:?} has one line, not {line}");
            assert_eq!(element_at(text, 1, 3), None, "{text:?}");
        }
    }
}
