//! States of calibrations as text.

use std::fmt::Write;

use shared::api::CalibrationStatus;
use shared::sentence::one_line;

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
            one_line(&s.name),
            s.state.name(),
            cell(p, |p| p.stage.to_string()),
            cell(p, |p| format!("{:.3e}", p.tempering_exponent)),
            cell(p, |p| p.evaluations.to_string()),
            cell(p, |p| format!("{:.0}", p.evaluations_per_s)),
            cell(p.and_then(|p| p.remaining_s), |s| format!("{s:.0}"))
        );
        if let Some(message) = &s.message {
            let _ = writeln!(text, "     {}", one_line(message));
        }
    }
    text
}
