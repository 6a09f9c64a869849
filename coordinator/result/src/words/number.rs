//! Formats of numbers, counts, lists and durations for people.

/// Shown in place of a missing number.
pub const NONE: &str = "\u{2013}";

/// From this absolute value on, a number is written with an exponent.
const LARGE: f64 = 1e7;
const DECIMALS: i32 = 7;

/// Formats a number with the given number of significant digits.
pub fn significant(x: f64, digits: i32) -> String {
    if !x.is_finite() {
        return NONE.into();
    }
    if x.abs() < f64::MIN_POSITIVE {
        return "0".into();
    }
    let decimals = digits - 1 - magnitude(x);
    if x.abs() >= LARGE || decimals > DECIMALS + digits {
        let digits = (digits - 1).max(0) as usize;
        return format!("{x:.digits$e}");
    }
    fixed(x, decimals)
}

/// Formats a number to the decimal place of the second significant digit of its spread.
pub fn to_spread(x: f64, spread: f64) -> String {
    if !x.is_finite() {
        return NONE.into();
    }
    if !spread.is_finite() || spread <= 0.0 {
        return significant(x, 4);
    }
    let decimals = 1 - rounded_magnitude(spread);
    let size = x.abs().max(spread);
    if size >= LARGE || decimals > DECIMALS {
        let digits = (magnitude(size) + decimals).max(0) as usize;
        return format!("{x:.digits$e}");
    }
    fixed(x, decimals)
}

/// Formats a number, or returns a dash if it is missing.
pub fn or_none<T>(value: Option<T>, words: impl FnOnce(T) -> String) -> String {
    value.map_or_else(|| NONE.into(), words)
}

/// Formats a number with at most six decimals and without trailing zeros.
pub fn plain(x: f64) -> String {
    if x.abs() < f64::MIN_POSITIVE || (1e-3..1e6).contains(&x.abs()) {
        let rounded = format!("{x:.6}");
        rounded.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        format!("{x:e}")
    }
}

/// Formats a number with four significant digits, for a column.
pub fn four_digits(x: f64) -> String {
    if x.abs() < f64::MIN_POSITIVE {
        "0".into()
    } else if (1e-3..1e5).contains(&x.abs()) {
        let digits = (3 - x.abs().log10().floor() as i32).max(0) as usize;
        format!("{x:.digits$}")
    } else {
        format!("{x:.3e}")
    }
}

/// Formats a number with its spread: `2.76 ± 0.40`.
pub fn with_spread(x: f64, spread: f64) -> String {
    format!(
        "{}\u{a0}\u{b1}\u{a0}{}",
        to_spread(x, spread),
        to_spread(spread, spread)
    )
}

/// Formats a number with a fixed number of decimals (negative: whole tens, hundreds), without a negative zero.
pub fn fixed(x: f64, decimals: i32) -> String {
    let x = match decimals {
        0.. => x,
        _ => (x / 10f64.powi(-decimals)).round() * 10f64.powi(-decimals),
    };
    let decimals = decimals.max(0) as usize;
    let text = format!("{x:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| c == '0' || c == '.') => rest.into(),
        _ => text,
    }
}

/// Formats a number in the shortest form that reads back as the same number.
pub fn as_written(x: f64) -> String {
    let size = x.abs();
    if size < f64::MIN_POSITIVE {
        "0".into()
    } else if (1e-4..LARGE).contains(&size) {
        x.to_string()
    } else {
        format!("{x:e}")
    }
}

/// Formats a count with its noun: `1 run`, `2 runs`.
pub fn count(n: usize, noun: &str) -> String {
    format!("{n} {noun}{}", if n == 1 { "" } else { "s" })
}

/// Joins words as in a sentence: `a, b and c`.
pub fn list(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [one] => one.clone(),
        [head @ .., last] => format!("{} and {last}", head.join(", ")),
    }
}

/// Formats a duration in seconds, minutes or hours.
pub fn duration(seconds: f64) -> String {
    if seconds < 120.0 {
        format!("{seconds:.1} s")
    } else if seconds < 7200.0 {
        format!("{:.1} min", seconds / 60.0)
    } else {
        format!("{:.1} h", seconds / 3600.0)
    }
}

/// Returns the power of ten of the first digit.
pub fn magnitude(x: f64) -> i32 {
    x.abs().log10().floor() as i32
}

/// Returns the magnitude after rounding to two digits: 0.0996 becomes 0.10.
fn rounded_magnitude(x: f64) -> i32 {
    format!("{x:.1e}")
        .split_once('e')
        .and_then(|(_, k)| k.parse().ok())
        .unwrap_or_else(|| magnitude(x))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_stops_at_the_second_figure_of_its_spread() {
        for (x, spread, expected) in [
            (3.816, 0.156, "3.82 ± 0.16"),
            (0.062_05, 4.647e-4, "0.06205 ± 0.00046"),
            (1_234_567.0, 45_678.0, "1235000 ± 46000"),
            (0.976, 0.0996, "0.98 ± 0.10"),
            (280_063.0, 578_767.0, "280000 ± 580000"),
        ] {
            assert_eq!(with_spread(x, spread), expected.replace(' ', "\u{a0}"));
        }
        assert_eq!(to_spread(26.0, 1.1), "26.0");
        assert_eq!(to_spread(812.3, 150.0), "810");
    }

    #[test]
    fn zero_has_no_sign_and_nonsense_no_digits() {
        assert_eq!(to_spread(-0.001, 0.2), "0.00");
        assert_eq!(significant(0.0, 3), "0");
        assert_eq!(significant(f64::NAN, 3), NONE);
        assert_eq!(to_spread(f64::INFINITY, 1.0), NONE);
    }

    #[test]
    fn significant_digits() {
        assert_eq!(significant(2.756, 2), "2.8");
        assert_eq!(significant(-23.95, 3), "-23.9");
        assert_eq!(significant(12_345.0, 3), "12300");
        assert_eq!(significant(2.5e8, 3), "2.50e8");
    }

    #[test]
    fn words_join_as_in_a_sentence() {
        let words = |n: usize| list(&["a", "b", "c"].map(String::from)[..n]);
        assert_eq!(
            (words(0), words(1), words(3)),
            (String::new(), "a".into(), "a, b and c".into())
        );
        assert_eq!(
            (count(1, "run"), count(3, "run")),
            ("1 run".into(), "3 runs".into())
        );
    }
}
