//! A study in a few lines: its calibrations and searches, what casts doubt on them, its error ledger.

use std::fmt::Write;

use record::{Verdict, effect_of};

use super::calibration::headline;
use super::campaign::digitised;
use super::ledger::ledger;
use super::models::models;
use crate::discovery::word;
use crate::flag::kind::FlagKind;
use crate::study::Study;
use crate::words::number;

/// The calibrations with their searches, a line each, and the error ledger.
pub fn brief(study: &Study) -> String {
    let mut text = String::new();
    for calibration in study.calibrations() {
        let _ = writeln!(text, "{}", headline(calibration));
        let own = |id| id == calibration.row.id;
        for round in study.rounds.iter().filter(|round| own(round.calibration)) {
            let found = match (round.record.verdict, &round.record.extension) {
                (Verdict::Named, Some(extension)) => format!("{} named", effect_of(extension)),
                (verdict, _) => word(verdict).replace('_', " "),
            };
            let cost = number::count(round.record.evaluations as usize, "evaluation");
            let _ = writeln!(text, "  search: {found}, {cost}");
        }
    }
    if let Some(campaign) = &study.lead.spec.experiment.campaign {
        text += &digitised(campaign);
    }
    for doubt in doubts(study) {
        let _ = writeln!(text, "caution: {doubt}");
    }
    text + &models(study) + &ledger(study)
}

/// Why the numbers themselves may be wrong: of the study and of its current model.
fn doubts(study: &Study) -> Vec<String> {
    let current = study.current().unwrap_or(&study.lead);
    let flags = current.diagnostics(current.comparison()).flags;
    let of_numbers = flags
        .into_iter()
        .filter(|flag| matches!(flag.kind, FlagKind::NotEquilibrated | FlagKind::Worker));
    let texts = study.missed_modes().into_iter().chain(of_numbers);
    texts.map(|flag| flag.text).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{fixture, terminal};

    #[test]
    fn a_study_has_a_line_for_each_calibration_and_search_and_no_table_of_runs() {
        let text = brief(&fixture::grown());
        let lines: Vec<&str> = text.lines().collect();
        assert!(
            lines[0].starts_with("<script>sand: 3 stages, 1000 evaluations"),
            "{text}"
        );
        assert_eq!(lines[1], "  search: slip_sinkage named, 4000 evaluations");
        assert!(
            !text.contains("90 % interval") && !text.contains("prior"),
            "{text}"
        );
    }

    #[test]
    fn digitised_rows_are_called_so() {
        let mut calibration = fixture::calibration();
        calibration.spec.experiment.campaign = Some(fixture::campaign());
        let study = calibration.into();
        for text in [brief(&study), terminal::study(&study)] {
            assert!(
                text.contains("digitised, not as recorded by the rig: figure 5"),
                "{text}"
            );
        }
        assert!(!brief(&fixture::calibration().into()).contains("digitised"));
    }

    #[test]
    fn a_sampler_that_drifted_is_a_caution() {
        let text = brief(&fixture::all_rejected().into());
        assert!(text.contains("\ncaution: "), "{text}");
        assert!(!brief(&fixture::calibration().into()).contains("caution"));
    }
}
