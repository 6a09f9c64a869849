//! Random damages of texts and bytes.

use statistics::rng::Stream;

/// The replacements of a number, separated by blanks; the last one is empty.
const NUMBERS: &str = "0 -0.0 -1 1 2 1e308 -1e308 1e-320 nan inf -inf 99999 100001 4294967296 9223372036854775807 -9223372036854775808 \
                       18446744073709551616 0.1e1e1 0,5 ";
/// The fragments that are inserted, separated by blanks.
const FRAGMENTS: &str = "\" ' \"\"\" # = , . .. \n \r\n \t \0 \u{7} \u{1b}[31m \u{85} \u{202e} \u{feff} é \u{1f6de} \u{e000} [[ }} \\u0000 ={";
/// The deepest nesting that is inserted.
const MAX_DEPTH: usize = 4000;
/// One more than the largest number of repeats of a part.
const REPEATS: usize = 300;
/// The largest length of a damaged text `[bytes]`. A longer text would be refused for its length alone, and is slow to make.
const MAX_LENGTH: usize = 200_000;

/// Returns a text with one to four damages.
pub fn damaged(text: &str, dice: &mut Stream) -> String {
    let mut text = text.to_owned();
    for _ in 0..=dice.below(6).saturating_sub(2) {
        text = once(&text, dice);
        if text.len() > MAX_LENGTH {
            text.truncate(text.floor_char_boundary(MAX_LENGTH));
        }
    }
    text
}

/// Bytes with one to four damages, after which they may not be UTF-8.
pub fn damaged_bytes(bytes: &[u8], dice: &mut Stream) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..=dice.below(6).saturating_sub(2) {
        let (from, to) = part(bytes.len(), dice);
        match dice.below(5) {
            0 => bytes.truncate(from),
            1 => drop(bytes.drain(from..to)),
            2 => {
                let again = bytes[from..to].repeat(dice.below(8));
                bytes.splice(from..from, again);
            }
            _ if bytes.is_empty() => bytes.push(dice.below(256) as u8),
            _ => {
                let place = dice.below(bytes.len());
                bytes[place] = dice.below(256) as u8;
            }
        }
    }
    bytes
}

fn once(text: &str, dice: &mut Stream) -> String {
    match dice.below(9) {
        0 => lines(text, dice),
        1..=3 => number(text, dice),
        4 => word(text, dice),
        5 => nested(text, dice),
        6 => {
            let (from, to) = boundaries(text, dice);
            let times = dice.below(REPEATS);
            let part = &text[from..to];
            let times = times.min(MAX_LENGTH / part.len().max(1));
            [&text[..from], &part.repeat(times), &text[from..]].concat()
        }
        7 => {
            let (from, to) = boundaries(text, dice);
            let end = if dice.below(4) == 0 { "" } else { &text[to..] };
            [&text[..from], end].concat()
        }
        _ => {
            let (place, _) = boundaries(text, dice);
            [&text[..place], choice(FRAGMENTS, dice), &text[place..]].concat()
        }
    }
}

/// Returns a text with a line removed, repeated or moved.
fn lines(text: &str, dice: &mut Stream) -> String {
    let mut lines: Vec<&str> = text.split_inclusive('\n').collect();
    if lines.is_empty() {
        return text.to_owned();
    }
    let (from, to) = (dice.below(lines.len()), dice.below(lines.len()));
    match dice.below(3) {
        0 => drop(lines.remove(from)),
        1 => lines.insert(to, lines[from]),
        _ => lines.swap(from, to),
    }
    lines.concat()
}

/// Returns a text with a number replaced by another number.
fn number(text: &str, dice: &mut Stream) -> String {
    let is_inside = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+' | 'e');
    let tokens = tokens(text, is_inside, |token| {
        token.contains(|c: char| c.is_ascii_digit())
    });
    replaced(text, &tokens, choice(NUMBERS, dice), dice)
}

/// Returns a text with a word replaced by another word of it.
fn word(text: &str, dice: &mut Stream) -> String {
    let tokens = tokens(text, |c| c.is_alphanumeric() || c == '_', |_| true);
    let Some(&(from, to)) = tokens.get(dice.below(tokens.len())) else {
        return text.to_owned();
    };
    replaced(text, &tokens, &text[from..to], dice)
}

/// Returns a text with inserted nested brackets.
fn nested(text: &str, dice: &mut Stream) -> String {
    let (place, _) = boundaries(text, dice);
    let brackets = [
        ("[", "]"),
        ("{a=", "}"),
        ("(", ")"),
        ("-", ""),
        ("{\"a\":", "}"),
        ("a.", ""),
    ];
    let (open, close) = brackets[dice.below(6)];
    let depth = [1, 2, 15, 17, 120, MAX_DEPTH][dice.below(6)];
    let inserted = open.repeat(depth) + "1" + &close.repeat(depth);
    [&text[..place], &inserted, &text[place..]].concat()
}

/// One of several words that are separated by blanks.
fn choice<'a>(words: &'a str, dice: &mut Stream) -> &'a str {
    let words: Vec<&str> = words.split(' ').collect();
    words[dice.below(words.len())]
}

fn replaced(text: &str, tokens: &[(usize, usize)], by: &str, dice: &mut Stream) -> String {
    match tokens.get(dice.below(tokens.len())) {
        Some(&(from, to)) => [&text[..from], by, &text[to..]].concat(),
        None => text.to_owned(),
    }
}

/// Returns the ends of the longest parts of a text whose characters are all `is_inside` and that are `is_wanted`.
fn tokens(
    text: &str,
    is_inside: impl Fn(char) -> bool,
    is_wanted: impl Fn(&str) -> bool,
) -> Vec<(usize, usize)> {
    let mut tokens = Vec::new();
    let mut start = None;
    for (place, character) in text.char_indices().chain([(text.len(), '\n')]) {
        match (start, is_inside(character)) {
            (None, true) => start = Some(place),
            (Some(from), false) => {
                start = None;
                if is_wanted(&text[from..place]) {
                    tokens.push((from, place));
                }
            }
            _ => {}
        }
    }
    tokens
}

/// Returns the ends of a random part of a text, which is usually short.
fn boundaries(text: &str, dice: &mut Stream) -> (usize, usize) {
    let (from, to) = part(text.len(), dice);
    (text.floor_char_boundary(from), text.floor_char_boundary(to))
}

fn part(length: usize, dice: &mut Stream) -> (usize, usize) {
    let from = dice.below(length + 1);
    let max = if dice.below(3) == 0 { length } else { 40 };
    (from, (from + dice.below(max + 1)).min(length))
}
