//! States of calibrations as text.

use std::fmt::Write;

use shared::api::{CalibrationStatus, Position};
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
            cell(p, |p| count(p.position).to_string()),
            cell(p.and_then(|p| exponent(p.position)), |x| format!("{x:.3e}")),
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

/// Stages, steps, generations or rounds so far.
fn count(position: Position) -> u32 {
    match position {
        Position::Sampler { stage, .. } => stage,
        Position::Fit { steps } => steps,
        Position::Evolution { generations } => generations,
        Position::Search { rounds } => rounds,
    }
}

fn exponent(position: Position) -> Option<f64> {
    match position {
        Position::Sampler {
            tempering_exponent, ..
        } => Some(tempering_exponent),
        Position::Fit { .. } | Position::Evolution { .. } | Position::Search { .. } => None,
    }
}
