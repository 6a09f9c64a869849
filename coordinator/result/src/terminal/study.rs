//! The results of a study as text.

use std::fmt::Write;

use super::calibration::summary;
use super::campaign::campaign;
use crate::study::Study;

/// Where the measurements of a study come from, and its tables and flags, one calibration after the other.
pub fn study(study: &Study) -> String {
    let results: Vec<String> = study.calibrations().map(summary).collect();
    let of_lead = study.lead.spec.experiment.campaign.as_ref();
    let mut text = of_lead.map_or_else(String::new, |own| campaign(own) + "\n") + &results.join("\n");
    for flag in study
        .missed_modes()
        .into_iter()
        .chain(study.interpolation_beats())
    {
        let _ = writeln!(text, "\nflag {}: {}", flag.kind.name(), flag.text);
    }
    text
}
