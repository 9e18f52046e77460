//! One input from others: small damage of every sort, and for texts also whole words in each other's place.

use shared::math::Rng;

/// Longest input, bytes: above what the readers take at most, where it is reached.
const MOST_BYTES: usize = 300_000;
/// Most changes of one input.
const MOST_CHANGES: u64 = 6;

/// What may be done to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Bytes,
    /// Words, too.
    Text,
}

/// Numbers at which something ends, as bytes in messages.
const EXTREME_BYTES: &[&[u8]] = &[
    &[0],
    &[0xff],
    &[0x7f],
    &[250],
    // bincode's marks of numbers of 2, 4, 8 and 16 bytes, with the largest behind.
    &[251, 0xff, 0xff],
    &[252, 0xff, 0xff, 0xff, 0xff],
    &[253, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff],
    &[253, 0, 0, 0, 0, 0, 0, 0, 0x40],
    &[254],
    // Floats: zero and -0, infinity, NaN, the largest, the smallest, one.
    &[0, 0, 0, 0, 0, 0, 0, 0],
    &[0, 0, 0, 0, 0, 0, 0, 0x80],
    &[0, 0, 0, 0, 0, 0, 0xf0, 0x7f],
    &[1, 0, 0, 0, 0, 0, 0xf0, 0xff],
    &[0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xef, 0x7f],
    &[1, 0, 0, 0, 0, 0, 0, 0],
    &[0, 0, 0, 0, 0, 0, 0xf0, 0x3f],
    &[0, 0, 0, 0, 0, 0, 0xf0, 0xbf],
];

/// The same in texts, and what has a meaning there.
const EXTREME_WORDS: &[&str] = &[
    "0",
    "-0.0",
    "1",
    "-1",
    "255",
    "256",
    "65535",
    "65536",
    "4294967295",
    "4294967296",
    "18446744073709551615",
    "18446744073709551616",
    "-9223372036854775809",
    "1e308",
    "-1e308",
    "1e-308",
    "5e-324",
    "1e999",
    "inf",
    "-inf",
    "NaN",
    "0x7fffffffffffffff",
    "1e12",
    "1e13",
    "1e-12",
    "0.1",
    "1000000",
    "()",
    "[]",
    "{}",
    "\"\"",
    "None",
    "Some",
    "true",
    "false",
    "\"\\u{202e}\"",
    "\"\\u{1b}[2J\"",
    "\"名前\"",
    "//",
    "/*",
    "*/",
    "r#\"",
    "'",
    "\"",
    "(",
    ")",
    "[",
    "]",
    ",",
    ":",
    "Exact",
    "Pixel",
    "Discrete",
    "Swept",
    "#![enable(unwrap_newtypes)]",
];

/// An input made of some of the corpus.
pub(crate) fn input(rng: &mut Rng, kind: Kind, corpus: &[Vec<u8>]) -> Vec<u8> {
    let mut input = corpus[below(rng, corpus.len())].clone();
    for _ in 0..=rng.bits() % MOST_CHANGES {
        let other = &corpus[below(rng, corpus.len())];
        if kind == Kind::Text && !rng.bits().is_multiple_of(4) {
            change_words(rng, &mut input, other);
        } else {
            change_bytes(rng, &mut input, other);
        }
    }
    input.truncate(MOST_BYTES);
    input
}

/// Uniform in 0..length; 0 for nothing.
fn below(rng: &mut Rng, length: usize) -> usize {
    (rng.bits() % length.max(1) as u64) as usize
}

/// A short part of it, mostly; now and then a long one.
fn part<'a>(rng: &mut Rng, of: &'a [u8]) -> &'a [u8] {
    let begin = below(rng, of.len());
    let most = if rng.bits().is_multiple_of(8) { of.len() } else { 16 };
    let length = below(rng, most + 1).min(of.len() - begin);
    &of[begin..begin + length]
}

fn change_bytes(rng: &mut Rng, input: &mut Vec<u8>, other: &[u8]) {
    let at = below(rng, input.len());
    match rng.bits() % 9 {
        0 if !input.is_empty() => input[at] ^= 1 << (rng.bits() % 8),
        1 if !input.is_empty() => input[at] = rng.bits() as u8,
        2 => input.truncate(at),
        3 => {
            let length = part(rng, input).len();
            input.drain(at..(at + length).min(input.len()));
        }
        4 => {
            let bytes: Vec<u8> = (0..=rng.bits() % 8).map(|_| rng.bits() as u8).collect();
            input.splice(at..at, bytes);
        }
        // A number in the place of others, and between them.
        5 => {
            let number = EXTREME_BYTES[below(rng, EXTREME_BYTES.len())];
            let end = (at + number.len()).min(input.len());
            input.splice(at..end, number.iter().copied());
        }
        6 => {
            let number = EXTREME_BYTES[below(rng, EXTREME_BYTES.len())];
            let end = (at + 1).min(input.len());
            input.splice(at..end, number.iter().copied());
        }
        // The begin of one and the end of another, or a part of it in between.
        7 => {
            input.truncate(at);
            input.extend_from_slice(&other[below(rng, other.len())..]);
        }
        _ => {
            let part = part(rng, other).to_vec();
            input.splice(at..at, part);
        }
    }
}

fn change_words(rng: &mut Rng, input: &mut Vec<u8>, other: &[u8]) {
    let (own, others) = (words(input), words(other));
    if own.is_empty() || others.is_empty() {
        return change_bytes(rng, input, other);
    }
    let at = own[below(rng, own.len())].clone();
    let with: Vec<u8> = match rng.bits() % 7 {
        0 => {
            let word = own[below(rng, own.len())].clone();
            input[word].to_vec()
        }
        1 => other[others[below(rng, others.len())].clone()].to_vec(),
        2 | 3 => EXTREME_WORDS[below(rng, EXTREME_WORDS.len())].as_bytes().to_vec(),
        // A number of the same sort of size.
        4 => format!("{}e{}", rng.gaussian(), below(rng, 9) as i32 - 4).into_bytes(),
        // The word again and again, which is a list or a depth.
        5 => {
            let most = if rng.bits().is_multiple_of(16) { 5000 } else { 20 };
            input[at.clone()].repeat(1 + below(rng, most))
        }
        _ => Vec::new(),
    };
    input.splice(at, with);
}

/// Names, numbers and signs.
fn words(text: &[u8]) -> Vec<std::ops::Range<usize>> {
    let is_of_word =
        |byte: u8| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'.' | b'-' | b'+') || byte >= 0x80;
    let mut words = Vec::new();
    let mut begin = 0;
    while begin < text.len() {
        let mut end = begin + 1;
        if is_of_word(text[begin]) {
            while end < text.len() && is_of_word(text[end]) {
                end += 1;
            }
        }
        if !text[begin].is_ascii_whitespace() {
            words.push(begin..end);
        }
        begin = end;
    }
    words
}
