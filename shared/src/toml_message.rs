//! Messages of the TOML parser and serde, reworded for users: key, value, expected value, and the nearest correction.

use std::ops::Range;

use formula::word::unknown_word;

/// The maximum length of a value shown whole \[characters\].
const LONGEST: usize = 60;

/// Rewords the message of a mistake; `span` is the offending passage of the file.
pub(crate) fn plain(text: &str, span: Option<Range<usize>>, message: &str) -> String {
    let mut lines = message.trim_end().lines();
    let first = lines.next().unwrap_or_default();
    // Without a span, the message has the key on a separate line.
    let named = lines.find_map(|line| line.strip_prefix("in `")?.strip_suffix('`'));
    let place = Place::new(text, span, named);
    let quoted =
        |text: &str| -> Vec<String> { text.split('`').skip(1).step_by(2).map(str::to_owned).collect() };
    let words = quoted(first);
    let expected_words = || words[1..].iter().map(String::as_str);
    if first.starts_with("unknown field") && !words.is_empty() {
        return unknown_word("key", &words[0], expected_words());
    }
    if first.starts_with("unknown variant") && !words.is_empty() {
        return unknown_word(&format!("value of {}", place.key()), &words[0], expected_words());
    }
    if first.starts_with("missing field") && !words.is_empty() {
        return format!("the key \"{}\" is missing", words[0]);
    }
    for kind in ["invalid type: ", "invalid value: ", "invalid length "] {
        if let Some((actual, expected)) = first
            .strip_prefix(kind)
            .and_then(|rest| rest.rsplit_once(", expected "))
        {
            return place.must_be(actual, expected);
        }
    }
    if first.starts_with("data did not match any variant") {
        return format!(
            "{} is no value that is expected here: a number, or a word in quotes",
            place.assignment()
        );
    }
    if let Some(decimal) = place.decimal_comma() {
        return decimal;
    }
    if first.starts_with("string values must be quoted") {
        return "a value is neither a number nor a text in quotes; a number stands without its unit".into();
    }
    match first.starts_with("unexpected key or value") {
        true => "unexpected text behind a value: a new line or a comment with # is expected".into(),
        false => first.replace('`', "\""),
    }
}

/// The place of a mistake: its key, and the value as written.
struct Place<'a> {
    key: Option<&'a str>,
    value: Option<String>,
    /// The whole line.
    line: &'a str,
}

impl<'a> Place<'a> {
    fn new(text: &'a str, span: Option<Range<usize>>, named: Option<&'a str>) -> Place<'a> {
        let start = span.as_ref().map_or(0, |span| span.start.min(text.len()));
        let before = text.get(..start).unwrap_or_default();
        let from = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line = text[from..].lines().next().unwrap_or_default();
        let head = before[from..].rsplit_once('=').map(|(head, _)| head.trim_end());
        let key = head.and_then(|head| head.rsplit([' ', '\t', '{', ',']).next());
        let value = span
            .and_then(|span| text.get(span))
            .and_then(|value| value.lines().next());
        Place {
            key: named.or(key),
            value: value.map(shortened),
            line,
        }
    }

    fn key(&self) -> &str {
        self.key.unwrap_or("the key")
    }

    fn assignment(&self) -> String {
        match &self.value {
            Some(value) => format!("{} = {value}", self.key()),
            None => self.key().to_owned(),
        }
    }

    /// Returns `particles = "60" must be a whole number >= 0: write 60`.
    fn must_be(&self, actual: &str, expected: &str) -> String {
        let what = match expected {
            "u8" | "u16" | "u32" | "u64" | "usize" => "a whole number >= 0".into(),
            "i8" | "i16" | "i32" | "i64" | "isize" => "a whole number".into(),
            "f32" | "f64" => "a number".into(),
            "a string" => "a text in quotes".into(),
            "a boolean" => "true or false".into(),
            "a sequence" => "a list in brackets".into(),
            "a map" => "a table of keys and values".into(),
            _ if expected.starts_with("struct ") => "a table of keys and values".into(),
            _ => match length(expected) {
                Some(length) => format!("a list of {length} values"),
                None => expected.replace('`', "\""),
            },
        };
        let is_number = what.contains("number");
        let unquoted = actual
            .strip_prefix("string \"")
            .and_then(|rest| rest.strip_suffix('"'));
        let quoted = unquoted.and_then(|text| text.parse::<f64>().ok().map(|_| text.to_owned()));
        let pointed = actual
            .strip_prefix("floating point `")
            .and_then(|rest| rest.strip_suffix('`'));
        let whole = pointed
            .and_then(|text| text.strip_suffix(".0"))
            .map(str::to_owned);
        let remedy = match quoted.or(whole) {
            Some(number) if is_number => format!(": write {number}"),
            _ => String::new(),
        };
        let assignment = match (&self.value, self.key) {
            (None, Some(key)) => format!("{key}, which is {},", actual.replace('`', "")),
            _ => self.assignment(),
        };
        format!("{assignment} must be {what}{remedy}")
    }

    /// Returns `width_m = 0,112: a number has a point: write 0.112`.
    fn decimal_comma(&self) -> Option<String> {
        let (key, rest) = self.line.split_once('=')?;
        let value = rest.split('#').next()?.trim();
        let (whole, fraction) = value.split_once(',')?;
        let digits = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
        let is_number = digits(whole.trim_start_matches(['-', '+'])) && digits(fraction);
        let key = key.trim();
        is_number
            .then(|| format!("{key} = {value}: a number has a point, no comma: write {whole}.{fraction}"))
    }
}

/// Returns the number at the end of `an array of length 2` and similar texts.
fn length(expected: &str) -> Option<&str> {
    let last = expected.rsplit(' ').next()?;
    let is_list = expected.starts_with("an array of length") || expected.starts_with("a tuple of size");
    (is_list && last.bytes().all(|b| b.is_ascii_digit())).then_some(last)
}

fn shortened(text: &str) -> String {
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;

    use crate::case_table::cases;
    use crate::file::parse_toml;

    #[derive(Debug, Default, Deserialize)]
    #[serde(deny_unknown_fields, default)]
    struct Toy {
        count: u32,
        order: i32,
        size_m: f64,
        name: String,
        moves: [usize; 2],
        names: Vec<String>,
        is_on: bool,
        kind: Kind,
        inner: Inner,
    }

    #[derive(Debug, Default, Deserialize)]
    #[serde(rename_all = "snake_case")]
    enum Kind {
        #[default]
        Steady,
        Paper,
    }

    #[derive(Debug, Default, Deserialize)]
    #[expect(dead_code, reason = "only the forms matter here")]
    struct Inner {
        width_m: f64,
    }

    #[test]
    fn no_word_of_the_parser_reaches_a_user() {
        for (text, message) in cases(
            r#"
            count = "60" => count = "60" must be a whole number >= 0: write 60
            count = 60.0 => count = 60.0 must be a whole number >= 0: write 60
            count = -1 => count = -1 must be a whole number >= 0
            order = 1.5 => order = 1.5 must be a whole number
            size_m = "wide" => size_m = "wide" must be a number
            size_m = 0,112 # m => size_m = 0,112: a number has a point, no comma: write 0.112
            size_m = 0.112 m => a value is neither a number nor a text in quotes; a number stands without its unit
            name = 5 => name = 5 must be a text in quotes
            moves = 4 => moves = 4 must be a list of 2 values
            names = "a" => names = "a" must be a list in brackets
            names = [1] => names = 1 must be a text in quotes
            is_on = "yes" => is_on = "yes" must be true or false
            kind = "papr" => unknown value of kind "papr"; the nearest known is "paper"
            inner = 5 => inner = 5 must be a table of keys and values
            inner = { width_m = "1" } => width_m = "1" must be a number: write 1
            [inner] => the key "width_m" is missing
            nam = 5 => unknown key "nam"; the nearest known is "name""#,
        ) {
            let error = parse_toml::<Toy>("toy.toml", &format!("# a comment\n{text}\n")).unwrap_err();
            assert_eq!(error.to_string(), format!("toy.toml line 2: {message}"), "{text}");
        }
    }
}
