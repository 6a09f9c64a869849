//! The results of a study as text.

use std::fmt::Write;

use super::calibration::{brief, summary};
use super::ledger::ledger;
use crate::study::Study;

/// The results of a study, one calibration after the other; of one that has grown without the tables of their runs.
pub fn study(study: &Study) -> String {
    let results: Vec<String> = match study.rounds.as_slice() {
        [] => study.calibrations().map(summary).collect(),
        _ => study.calibrations().map(brief).collect(),
    };
    let mut text = results.join("\n");
    for flag in study
        .missed_modes()
        .into_iter()
        .chain(study.interpolation_beats())
    {
        let _ = writeln!(text, "\nflag {}: {}", flag.kind.name(), flag.text);
    }
    if study.rounds.is_empty() && study.ledger().count() > 1 {
        text.push_str(&ledger(study));
    }
    text
}
