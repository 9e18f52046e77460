//! Finds the line of a table's text that an error is about.
//!
//! Once RON is parsed, its values no longer know where they stood. Names are unique, so a value is found again by the
//! name of its element and of its field.

/// The line, from 1, of `field` in the element called `name`; of the name if the field is not written there; of the
/// field's first place outside elements if there is no name. 0 if nothing is found.
pub(super) fn line_of(source: &str, name: Option<&str>, field: Option<&str>) -> usize {
    let masked = mask(source);
    let position = match (name, field) {
        (Some(name), field) => find_named(source, &masked, name)
            .map(|(at, scope)| field.and_then(|field| find_field(&masked, scope, field)).unwrap_or(at)),
        (None, Some(field)) => find_field(&masked, (0, masked.len()), field),
        (None, None) => None,
    };
    position.map_or(0, |at| 1 + source.as_bytes()[..at].iter().filter(|&&byte| byte == b'\n').count())
}

/// The text with comments and the insides of strings blanked, byte for byte.
fn mask(source: &str) -> Vec<u8> {
    let mut masked = source.as_bytes().to_vec();
    let mut at = 0;
    while at < masked.len() {
        let end = match (masked[at], masked.get(at + 1)) {
            (b'/', Some(b'/')) => find(&masked, at, b"\n"),
            (b'/', Some(b'*')) => (find(&masked, at + 2, b"*/") + 2).min(masked.len()),
            (b'"', _) => {
                let mut end = at + 1;
                while end < masked.len() && masked[end] != b'"' {
                    end += if masked[end] == b'\\' { 2 } else { 1 };
                }
                let end = end.min(masked.len());
                blank(&mut masked[at + 1..end]);
                at = end + 1;
                continue;
            }
            _ => {
                at += 1;
                continue;
            }
        };
        blank(&mut masked[at..end]);
        at = end;
    }
    masked
}

fn blank(bytes: &mut [u8]) {
    for byte in bytes {
        if *byte != b'\n' {
            *byte = b' ';
        }
    }
}

fn find(bytes: &[u8], from: usize, what: &[u8]) -> usize {
    let rest = bytes.get(from..).unwrap_or_default();
    rest.windows(what.len()).position(|window| window == what).map_or(bytes.len(), |at| from + at)
}

/// Where `name: "NAME"` or the map key `"NAME":` stands, and the extent of the parentheses around or after it.
fn find_named(source: &str, masked: &[u8], name: &str) -> Option<(usize, (usize, usize))> {
    let quoted = format!("\"{}\"", name.escape_default());
    source.match_indices(&quoted).find_map(|(at, _)| {
        let before = masked[..at].trim_ascii_end();
        let after = masked[(at + quoted.len()).min(masked.len())..].trim_ascii_start();
        if before.ends_with(b":") && before[..before.len() - 1].trim_ascii_end().ends_with(b"name") {
            Some((at, (opening(masked, at), closing(masked, at))))
        } else if after.starts_with(b":") {
            let open = find(masked, at, b"(");
            Some((at, (open, closing(masked, open + 1))))
        } else {
            None
        }
    })
}

/// The parenthesis that is open at `at`.
fn opening(masked: &[u8], at: usize) -> usize {
    let mut depth = 0;
    for (place, &byte) in masked[..at].iter().enumerate().rev() {
        match byte {
            b')' => depth += 1,
            b'(' if depth == 0 => return place,
            b'(' => depth -= 1,
            _ => {}
        }
    }
    0
}

/// Where the parenthesis that is open at `at` is closed.
fn closing(masked: &[u8], at: usize) -> usize {
    let mut depth = 0;
    for (place, &byte) in masked.iter().enumerate().skip(at) {
        match byte {
            b'(' => depth += 1,
            b')' if depth == 0 => return place,
            b')' => depth -= 1,
            _ => {}
        }
    }
    masked.len()
}

/// Where `field:` stands within an extent.
fn find_field(masked: &[u8], (from, to): (usize, usize), field: &str) -> Option<usize> {
    let scope = masked.get(from..to)?;
    (0..scope.len())
        .find(|&at| {
            scope[at..].starts_with(field.as_bytes())
                && scope[at + field.len()..].trim_ascii_start().starts_with(b":")
                && !at
                    .checked_sub(1)
                    .is_some_and(|before| scope[before].is_ascii_alphanumeric() || scope[before] == b'_')
        })
        .map(|at| from + at)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#"(
    size: (1.0, 2.0), // name: "post"
    materials: {
        "rubber": (
            restitution: 0.8,
        ),
    },
    elements: [
        Post(name: "a (b)", radius: 1.0),
        Post(
            name: "post",
            /* radius: 3 */
            radius: 2.0,
        ),
    ],
)"#;

    #[test]
    fn finds_fields_by_element() {
        assert_eq!(line_of(TEXT, Some("post"), Some("radius")), 13);
        assert_eq!(line_of(TEXT, Some("a (b)"), Some("radius")), 9);
        assert_eq!(line_of(TEXT, Some("rubber"), Some("restitution")), 5);
    }

    #[test]
    fn falls_back_to_the_name_and_to_the_table() {
        assert_eq!(line_of(TEXT, Some("post"), Some("missing")), 11);
        assert_eq!(line_of(TEXT, None, Some("size")), 2);
        assert_eq!(line_of(TEXT, Some("nobody"), None), 0);
    }

    #[test]
    fn survives_broken_text() {
        for text in ["", "\"", "/*", "(((", "name:\"x", "\"\\"] {
            let _ = line_of(text, Some("x"), Some("y"));
        }
    }
}
