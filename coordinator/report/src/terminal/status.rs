//! States of calibrations as text.

use shared::api::{CalibrationStatus, Position, Progress};
use shared::sentence::one_line;

use super::column::cell;
use super::table::Table;

/// Tabulates the states of calibrations, one line each.
pub fn status_table(statuses: &[CalibrationStatus]) -> String {
    let progress = |s: &CalibrationStatus, words: fn(&Progress) -> String| cell(s.progress.as_ref(), words);
    let table = Table::<&CalibrationStatus>::new()
        .right(4, "id", |s| s.id)
        .right(5, "study", |s| s.study)
        .left(24, "name", |s| one_line(&s.name))
        .left(10, "state", |s| s.state.name())
        .right(5, "stage", |s| progress(s, |p| count(p.position).to_string()))
        .right(10, "exponent", |s| {
            progress(s, |p| cell(exponent(p.position), |x| format!("{x:.3e}")))
        })
        .right(11, "evaluations", |s| progress(s, |p| p.evaluations.to_string()))
        .right(8, "per s", |s| {
            progress(s, |p| format!("{:.0}", p.evaluations_per_s))
        })
        .right(8, "to go s", |s| {
            progress(s, |p| cell(p.remaining_s, |s| format!("{s:.0}")))
        });
    let mut text = table.header();
    for status in statuses {
        text += &table.line(status);
        if let Some(message) = &status.message {
            text += &format!("     {}\n", one_line(message));
        }
    }
    text
}

/// Returns the number of stages, steps, generations or rounds so far.
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
