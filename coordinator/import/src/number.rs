//! Numbers in the notations of users: decimal commas, separators of thousands, typographic signs.

/// The decimal mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Decimal {
    Point,
    Comma,
}

impl Decimal {
    pub(crate) fn mark(self) -> char {
        match self {
            Decimal::Point => '.',
            Decimal::Comma => ',',
        }
    }

    /// Returns the mark that separates thousands, which is the decimal mark of the other convention.
    fn thousands_mark(self) -> char {
        match self {
            Decimal::Point => ',',
            Decimal::Comma => '.',
        }
    }

    pub(crate) fn words(self) -> &'static str {
        match self {
            Decimal::Point => "decimal point",
            Decimal::Comma => "decimal comma",
        }
    }

    pub(crate) fn from_mark(mark: &str) -> Option<Decimal> {
        match mark {
            "." => Some(Decimal::Point),
            "," => Some(Decimal::Comma),
            _ => None,
        }
    }
}

/// The notation of a column's numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Writing {
    pub(crate) decimal: Decimal,
    /// Whether the map states that the other mark separates thousands: `1,234` alone is ambiguous.
    pub(crate) has_thousands: bool,
}

fn is_gap(c: char) -> bool {
    matches!(c, ' ' | '\u{a0}' | '\u{2009}' | '\u{202f}' | '\'' | '\u{2019}')
}

/// The parts of a number: sign, groups of digits, the marks between them, and the rest after the decimal mark.
struct Parts {
    is_negative: bool,
    /// Digits and marks of the mantissa.
    mantissa: String,
    exponent: Option<i32>,
}

/// Returns whether a text is written like a number.
pub(crate) fn is_number(text: &str) -> bool {
    parts(text).is_some()
}

fn parts(text: &str) -> Option<Parts> {
    let text = text.trim();
    let (is_negative, rest) = match text.chars().next()? {
        '-' | '−' | '–' => (true, text.chars().skip(1).collect::<String>()),
        '+' => (false, text.chars().skip(1).collect()),
        _ => (false, text.to_owned()),
    };
    let (mantissa, exponent) = match rest.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (
            mantissa.to_owned(),
            Some(exponent.replace('−', "-").parse().ok()?),
        ),
        None => (rest, None),
    };
    let is_expected = |c: char| c.is_ascii_digit() || c == '.' || c == ',' || is_gap(c);
    let begins = mantissa
        .chars()
        .next()
        .is_some_and(|c| c.is_ascii_digit() || c == '.' || c == ',');
    let ends = mantissa.chars().next_back().is_some_and(|c| !is_gap(c));
    let is_number = begins
        && ends
        && mantissa.chars().all(is_expected)
        && mantissa.contains(|c: char| c.is_ascii_digit());
    is_number.then_some(Parts {
        is_negative,
        mantissa,
        exponent,
    })
}

/// Returns the number, or the expectation and the nearest fix in words.
pub(crate) fn read(text: &str, writing: Writing) -> Result<f64, String> {
    let Writing {
        decimal,
        has_thousands,
    } = writing;
    let Some(Parts {
        is_negative,
        mantissa,
        exponent,
    }) = parts(text)
    else {
        return Err(no_number(text, decimal));
    };
    let (whole, decimals) = match mantissa.split_once(decimal.mark()) {
        Some((whole, decimals)) => (whole, Some(decimals)),
        None => (mantissa.as_str(), None),
    };
    if decimals.is_some_and(|digits| !digits.chars().all(|c| c.is_ascii_digit())) {
        return Err(no_number(text, decimal));
    }
    let (mark, thousands) = (decimal.mark(), decimal.thousands_mark());
    let groups: Vec<&str> = whole.split(|c: char| c == thousands || is_gap(c)).collect();
    let are_thousands = groups.len() == 1
        || (groups[1..].iter().all(|group| group.len() == 3) && (1..=3).contains(&groups[0].len()));
    if !are_thousands {
        let swapped: String = text
            .chars()
            .map(|c| if c == thousands { mark } else { c })
            .collect();
        return Err(format!(
            "\"{text}\" has a \"{thousands}\" where the numbers have a {}: write {swapped}, or state `decimal` of this column in the map",
            decimal.words()
        ));
    }
    if groups.len() == 2 && decimals.is_none() && whole.contains(thousands) && !has_thousands {
        let plain: String = whole.chars().filter(|&c| c != thousands).collect();
        let swapped = whole.replace(thousands, &mark.to_string());
        return Err(format!(
            "\"{text}\" can mean {plain} or {swapped}: write it without \"{thousands}\", or state `thousands = \"{thousands}\"` in the map"
        ));
    }
    let digits = groups.concat();
    let digits = if digits.is_empty() { "0" } else { &digits };
    let plain = format!(
        "{}{digits}.{}e{}",
        if is_negative { "-" } else { "" },
        decimals.filter(|d| !d.is_empty()).unwrap_or("0"),
        exponent.unwrap_or(0)
    );
    match plain.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(format!(
            "\"{text}\" is beyond the numbers that a program can hold"
        )),
    }
}

fn no_number(text: &str, decimal: Decimal) -> String {
    let expected = match decimal {
        Decimal::Point => "1.5",
        Decimal::Comma => "1,5",
    };
    // The text has letters that look like digits, or a unit or remark behind the number.
    let mended: String = text
        .chars()
        .map(|c| match c {
            'O' | 'o' => '0',
            'l' | 'I' => '1',
            c => c,
        })
        .collect();
    let beginning: String = text
        .chars()
        .take_while(|c| c.is_ascii_digit() || ".,-−+".contains(*c))
        .collect();
    let fix = if mended != text && parts(&mended).is_some() {
        format!("; did you mean {mended}")
    } else if !beginning.is_empty() && parts(&beginning).is_some() {
        format!("; did you mean {beginning}")
    } else {
        "; leave the cell blank where nothing was measured, or name the word under `missing` in the map"
            .into()
    };
    format!("\"{text}\" is no number: a number like {expected} is expected{fix}")
}

/// The evidence of a file's texts on their decimal mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Evidence {
    /// No number has either mark.
    None,
    /// Every number with a mark is ambiguous, as `1,234` is.
    Ambiguous,
    /// The mark of the unambiguous numbers; if they differ, of their majority.
    Found(Decimal),
}

/// Returns the decimal mark of texts.
pub(crate) fn decimal_of<'a>(texts: impl Iterator<Item = &'a str>) -> Evidence {
    let (mut points, mut commas, mut unclear) = (0, 0, 0);
    for text in texts {
        let Some(Parts { mantissa, .. }) = parts(text) else {
            continue;
        };
        let last = mantissa.rfind(['.', ',']);
        let Some(at) = last else { continue };
        let mark = &mantissa[at..=at];
        let (before, after) = (&mantissa[..at], &mantissa[at + 1..]);
        let is_comma = mark == ",";
        if before.contains(mark) {
            // In 1.234.567 the mark separates thousands.
            if is_comma { points += 1 } else { commas += 1 }
        } else if before.contains(['.', ','])
            || after.len() != 3
            || before.starts_with('0')
            || !(1..=3).contains(&before.len())
        {
            if is_comma { commas += 1 } else { points += 1 }
        } else {
            unclear += 1;
        }
    }
    match (points, commas, unclear) {
        (0, 0, 0) => Evidence::None,
        (0, 0, _) => Evidence::Ambiguous,
        (points, commas, _) if commas > points => Evidence::Found(Decimal::Comma),
        _ => Evidence::Found(Decimal::Point),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn comma(text: &str) -> Result<f64, String> {
        read(
            text,
            Writing {
                decimal: Decimal::Comma,
                has_thousands: false,
            },
        )
    }

    fn point(text: &str) -> Result<f64, String> {
        read(
            text,
            Writing {
                decimal: Decimal::Point,
                has_thousands: false,
            },
        )
    }

    #[test]
    fn numbers_are_read_as_people_type_them() {
        for (text, value) in [
            ("1,5", 1.5),
            ("−2,25", -2.25),
            ("1.234,5", 1234.5),
            ("1.234.567", 1_234_567.0),
            ("12 000,5", 12000.5),
            (",5", 0.5),
            ("3,2E-3", 0.0032),
            ("+7", 7.0),
        ] {
            assert_eq!(comma(text), Ok(value), "{text}");
        }
        for (text, value) in [
            ("1.5", 1.5),
            ("1,234.5", 1234.5),
            ("1'234.5", 1234.5),
            ("5.", 5.0),
            ("1e3", 1000.0),
        ] {
            assert_eq!(point(text), Ok(value), "{text}");
        }
        let stated = Writing {
            decimal: Decimal::Point,
            has_thousands: true,
        };
        assert_eq!(read("1,234", stated), Ok(1234.0));
    }

    #[test]
    fn what_could_mean_two_things_is_refused() {
        for (error, part) in [
            (point("1,234"), "can mean 1234 or 1.234"),
            (comma("1.234"), "can mean 1234 or 1,234"),
            (comma("2.5"), "write 2,5, or state `decimal`"),
            (point("2,5"), "write 2.5, or state `decimal`"),
            (comma("1O,5"), "did you mean 10,5"),
            (point("12.5 N"), "did you mean 12.5"),
            (point("n/a"), "leave the cell blank"),
            (point("1e999"), "beyond"),
            (point("1 2"), "write"),
        ] {
            let error = error.unwrap_err();
            assert!(error.contains(part), "{error}");
        }
    }

    #[test]
    fn the_decimal_mark_is_found_or_left_open() {
        let evidence = |texts: &[&str]| decimal_of(texts.iter().copied());
        assert_eq!(evidence(&["1,5", "1,234"]), Evidence::Found(Decimal::Comma));
        assert_eq!(evidence(&["0,125"]), Evidence::Found(Decimal::Comma));
        assert_eq!(evidence(&["1.234,5"]), Evidence::Found(Decimal::Comma));
        assert_eq!(evidence(&["1,234,567"]), Evidence::Found(Decimal::Point));
        assert_eq!(evidence(&["1,234", "5,678"]), Evidence::Ambiguous);
        assert_eq!(evidence(&["12", "x"]), Evidence::None);
    }
}
