//! The complete text of a study: all calibrations, searches, and the ledger.

use std::fmt::Write;

use record::{Verdict, effect_of};

use super::brief::cautions;
use super::calibration::{headline, summary};
use super::campaign::campaign;
use super::ledger::ledger;
use super::models::models;
use super::rig::rig_of_study;
use crate::flag::interpolation::interpolation_beats;
use crate::flag::study::missed_modes;
use result::discovery::word;
use result::study::Study;
use result::words::number;

/// Prints the source of the measurements, the tables and flags of each calibration, then the calibrations and searches, a line each, what
/// the rig did, and the error ledger.
pub fn study(study: &Study) -> String {
    let results: Vec<String> = study.calibrations().map(summary).collect();
    let source = study.lead.spec.experiment.campaign.as_ref();
    let mut text = source.map_or_else(String::new, |source| campaign(source) + "\n") + &results.join("\n");
    for flag in missed_modes(study).into_iter().chain(interpolation_beats(study)) {
        let _ = writeln!(text, "\nflag {}: {}", flag.kind.name(), flag.text);
    }
    text.push('\n');
    text += &calibrations(study);
    text += &cautions(study);
    text += &rig_of_study(study);
    text + &models(study) + "\n" + &ledger(study)
}

/// Returns a line for each calibration and each of its searches.
fn calibrations(study: &Study) -> String {
    let mut text = String::new();
    for calibration in study.calibrations() {
        let _ = writeln!(text, "{}", headline(calibration));
        let rounds = study.rounds.iter();
        for round in rounds.filter(|round| round.calibration == calibration.row.id) {
            let found = match (round.record.verdict, &round.record.extension) {
                (Verdict::Named, Some(extension)) => format!("{} named", effect_of(extension)),
                (verdict, _) => word(verdict).replace('_', " "),
            };
            let cost = number::count(round.record.evaluations as usize, "evaluation");
            let _ = writeln!(text, "  search: {found}, {cost}");
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn every_calibration_and_search_has_a_line_with_its_cost() {
        let text = study(&fixture::grown());
        for words in [
            "\n<script>sand: 3 stages, 1000 evaluations",
            "\n  search: slip_sinkage named, 4000 evaluations",
            "\nroot mean sq. error",
            "\nnoise:",
        ] {
            assert!(text.contains(words), "{words} in\n{text}");
        }
    }
}
