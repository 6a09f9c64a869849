//! States of calibrations as text.

use std::fmt::Write;

use shared::api::CalibrationStatus;

use super::column::cell;

/// The states of calibrations, a line each.
pub fn status_table(statuses: &[CalibrationStatus]) -> String {
    let mut text = format!(
        "{:>4} {:>5} {:<24} {:<10} {:>5} {:>10} {:>11} {:>8} {:>8}\n",
        "id", "study", "name", "state", "stage", "exponent", "evaluations", "per s", "to go s"
    );
    for s in statuses {
        let p = s.progress.as_ref();
        let _ = writeln!(
            text,
            "{:>4} {:>5} {:<24} {:<10} {:>5} {:>10} {:>11} {:>8} {:>8}",
            s.id,
            s.study,
            printable(&s.name),
            s.state.name(),
            cell(p, |p| p.stage.to_string()),
            cell(p, |p| format!("{:.3e}", p.tempering_exponent)),
            cell(p, |p| p.evaluations.to_string()),
            cell(p, |p| format!("{:.0}", p.evaluations_per_s)),
            cell(p.and_then(|p| p.remaining_s), |s| format!("{s:.0}"))
        );
        if let Some(message) = &s.message {
            let _ = writeln!(text, "     {}", printable(message));
        }
    }
    text
}

/// A stranger's text with its control characters as escapes: it moves no cursor and sets no colour.
fn printable(text: &str) -> String {
    let shown = |c: char| match c.is_control() {
        true => c.escape_default().to_string(),
        false => c.to_string(),
    };
    text.chars().map(shown).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_escaped_and_letters_are_not() {
        assert_eq!(printable("süß \u{1b}[2J\n\u{9b}"), "süß \\u{1b}[2J\\n\\u{9b}");
    }
}
