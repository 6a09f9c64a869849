//! Days of the calendar.

/// Number of days in 400 years of the Gregorian calendar.
const CYCLE: i64 = 146_097;
/// Milliseconds in a day.
const DAY_MS: i64 = 86_400_000;

/// Formats the day (UTC) of a time since the beginning of 1970 `[ms]`: `2026-11-27`.
pub fn day(ms: i64) -> String {
    // Days are counted from the first of March of the year 0, so that a leap day ends its year.
    let days = ms.div_euclid(DAY_MS) + 719_468;
    let (cycle, day) = (days.div_euclid(CYCLE), days.rem_euclid(CYCLE));
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let of_year = day - (365 * year + year / 4 - year / 100);
    let month = (5 * of_year + 2) / 153;
    let of_month = of_year - (153 * month + 2) / 5 + 1;
    let (year, month) = match month {
        0..10 => (400 * cycle + year, month + 3),
        _ => (400 * cycle + year + 1, month - 9),
    };
    format!("{year:04}-{month:02}-{of_month:02}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_around_leap_days_and_ends_of_years_have_their_dates() {
        for (days, date) in [
            (0, "1970-01-01"),
            (-1, "1969-12-31"),
            (11_016, "2000-02-29"),
            (11_017, "2000-03-01"),
            (20_784, "2026-11-27"),
            (20_818, "2026-12-31"),
            (47_540, "2100-02-28"),
            (47_541, "2100-03-01"),
        ] {
            assert_eq!(day(days * DAY_MS + DAY_MS - 1), date);
            assert_eq!(day(days * DAY_MS), date);
        }
    }
}
