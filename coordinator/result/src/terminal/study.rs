//! The results of a study as text.

use std::fmt::Write;

use super::calibration::summary;
use crate::study::Study;

/// The tables and flags of a study, one calibration after the other.
pub fn study(study: &Study) -> String {
    let results: Vec<String> = study.calibrations().map(summary).collect();
    let mut text = results.join("\n");
    for flag in study
        .missed_modes()
        .into_iter()
        .chain(study.interpolation_beats())
    {
        let _ = writeln!(text, "\nflag {}: {}", flag.kind.name(), flag.text);
    }
    text
}
