//! A study in a few lines: cautions, compared models, error ledger.

use super::calibration::headline;
use super::campaign::digitised;
use super::ledger::brief_ledger;
use super::models::brief_models;
use crate::diagnosis::diagnostics;
use crate::flag::study::missed_modes;
use result::flag::FlagKind;
use result::study::Study;

/// Returns the cautions, the most probable of compared models, the error ledger, and a line for each calibration that is not in the ledger.
///
/// Where the table of models has the errors already, the ledger follows only if something was added to the chosen model.
pub fn brief(study: &Study) -> String {
    let is_in_ledger = |id: i64| study.ledger().any(|line| line.row.id == id);
    let beside = study
        .line()
        .filter(|calibration| !is_in_ledger(calibration.row.id));
    let mut text: String = beside.map(|calibration| headline(calibration) + "\n").collect();
    text += &cautions(study);
    let models = brief_models(study);
    text += &models;
    match models.is_empty() || study.ledger().count() > 1 {
        true => text + &brief_ledger(study),
        false => text,
    }
}

/// Says that the measurements were read off figures, and why the numbers of the study and of its current model may be wrong.
pub(super) fn cautions(study: &Study) -> String {
    let campaign = study.lead.spec.experiment.campaign.as_ref();
    let digitised = campaign.map_or_else(String::new, digitised);
    let current = study.current().unwrap_or(&study.lead);
    let flags = diagnostics(current, current.comparison()).flags;
    let of_numbers = flags
        .into_iter()
        .filter(|flag| matches!(flag.kind, FlagKind::NotEquilibrated | FlagKind::Worker));
    let doubts = missed_modes(study).into_iter().chain(of_numbers);
    let doubts = doubts.map(|flag| format!("caution: {}\n", flag.text));
    digitised + &doubts.collect::<String>()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::{fixture, terminal};

    #[test]
    fn a_study_is_its_ledger_without_the_cost_of_its_calibrations_and_without_tables() {
        let text = brief(&fixture::grown());
        let ledger = text.find("root mean sq. error").expect("a ledger");
        for (words, is_there) in [
            ("base ", true),
            ("<script>sand: 3 stages", false),
            ("search:", false),
            ("noise:", false),
            ("90 % interval", false),
        ] {
            assert_eq!(text[ledger..].contains(words), is_there, "{words} in\n{text}");
        }
    }

    #[test]
    fn what_has_no_line_in_the_ledger_has_one_before_it() {
        let text = brief(&fixture::study());
        assert!(
            text.starts_with("<script>sand: ga stopped by generations"),
            "{text}"
        );
        let text = brief(&fixture::fit().into());
        assert!(text.starts_with("<script>sand: lm stopped by"), "{text}");
    }

    #[test]
    fn digitised_rows_are_called_so() {
        let mut calibration = fixture::calibration();
        Arc::make_mut(&mut calibration.spec.experiment).campaign = Some(fixture::campaign());
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
        assert!(text.contains("caution: "), "{text}");
        assert!(!brief(&fixture::calibration().into()).contains("caution"));
    }
}
