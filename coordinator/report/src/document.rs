//! Document: the HTML report of a study, which opens offline and draws the same figures as the page.
//!
//! It contains the answers of the REST interface by path, so that the modules of the page work without a service. Without scripts it
//! shows the text of the terminal.

use std::collections::BTreeMap;

use serde_json::value::{RawValue, to_raw_value};

use page::report::{Report, report};
use shared::api::CalibrationState;

use crate::diagnosis::diagnostics;
use crate::overview::overview;
use crate::provenance::provenance;
use crate::terminal;
use prediction::{DecisionAnswer, PredictionGrid};
use result::finished_calibration::FinishedCalibration;
use result::response_surface::{MAX_BYTES, ResponseSurface};
use result::study::Study;

/// What a report carries of conditions that nobody measured; the caller simulates it.
#[derive(Debug, Clone, Default)]
pub struct ReportPredictions {
    /// Predictions over grids.
    pub grids: Vec<PredictionGrid>,
    /// Decisions, at most one by each calibration.
    pub decisions: Vec<DecisionAnswer>,
}

/// Returns the report, which shows the current model first.
pub fn document(study: &Study, predictions: &ReportPredictions) -> String {
    let shown = study.current().unwrap_or(&study.lead);
    report(&Report {
        title: &format!("Calibration report: {}", study.lead.experiment),
        text: &terminal::study(study),
        study: shown.row.study,
        calibration: shown.row.id,
        answers: &answers(study, predictions),
    })
}

/// Returns the answers of a service about a study, keyed by path.
pub fn answers(study: &Study, predictions: &ReportPredictions) -> BTreeMap<String, Box<RawValue>> {
    let overview = overview(study);
    let mut answers = BTreeMap::new();
    let mut add = |path: String, answer: Box<RawValue>| {
        answers.insert(format!("/v1/{path}"), answer);
    };
    add(format!("studies/{}", overview.id), json(&overview));
    for calibration in study.calibrations() {
        let path = |what: &str| format!("calibrations/{}/{what}", calibration.row.id);
        let comparison = calibration.comparison();
        let diagnostics = diagnostics(calibration, comparison);
        add(path("comparison"), json(comparison));
        add(path("diagnostics"), json(&diagnostics));
        add(path("figures"), json(&study.figures_of(calibration)));
        add(path("histories"), json(&calibration.histories()));
        add(path("provenance"), json(&provenance(calibration)));
        add(path("stages"), json(&calibration.stages()));
    }
    for grid in &predictions.grids {
        add(
            format!("calibrations/{}/prediction-grid", grid.calibration),
            json(grid),
        );
    }
    for decision in &predictions.decisions {
        add(
            format!("calibrations/{}/decision", decision.calibration),
            json(decision),
        );
    }
    for (calibration, surface) in surfaces(study) {
        add(
            format!("calibrations/{calibration}/response-surface"),
            json(&surface),
        );
    }
    for round in &study.rounds {
        // Searches that were cancelled or failed have no record.
        let search = study
            .members
            .iter()
            .rfind(|m| m.searches == Some(round.calibration) && m.state == CalibrationState::Finished);
        if let Some(search) = search {
            add(
                format!("calibrations/{}/discovery", search.id),
                json(&round.record),
            );
        }
    }
    answers
}

/// Returns the response surfaces by calibration: that of the current model, then the others as far as [`MAX_BYTES`] allows.
fn surfaces(study: &Study) -> Vec<(i64, Option<ResponseSurface>)> {
    let current = study.current().map(|calibration| calibration.row.id);
    let mut calibrations: Vec<&FinishedCalibration> = study.calibrations().collect();
    calibrations.sort_by_key(|calibration| Some(calibration.row.id) != current);
    let mut left = MAX_BYTES;
    let mut found = Vec::new();
    for calibration in calibrations {
        let surface = calibration.response_surface();
        let size = surface.as_ref().map_or(0, ResponseSurface::size_bytes);
        if size <= left {
            left -= size;
            found.push((calibration.row.id, surface));
        }
    }
    found
}

/// Returns an answer as its text, which takes a fraction of the memory of its values.
fn json(answer: &impl serde::Serialize) -> Box<RawValue> {
    to_raw_value(answer).expect("results have a JSON form")
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::*;
    use crate::fixture;

    #[test]
    fn every_calibration_and_every_search_is_in_the_report() {
        let study = fixture::grown();
        let answers = answers(&study, &ReportPredictions::default());
        let count = |what: &str| answers.keys().filter(|path| path.ends_with(what)).count();
        assert_eq!(count("/discovery"), study.rounds.len());
        assert_eq!(count("/comparison"), study.calibrations().count());
        assert_eq!(count("/response-surface"), study.calibrations().count());
    }

    #[test]
    fn the_models_that_a_job_compares_are_in_the_report() {
        let mut other = fixture::calibration();
        other.row.id = 2;
        let study = Study {
            models: 2,
            other_models: vec![other],
            ..Study::from(fixture::calibration())
        };
        let answers = answers(&study, &ReportPredictions::default());
        let overview = &answers[&format!("/v1/studies/{}", study.lead.row.study)];
        let overview: Value = serde_json::from_str(overview.get()).unwrap();
        let models = &overview["models"];
        assert_eq!(models["best"], study.lead.row.id);
        assert_eq!(models["models"].as_array().map(Vec::len), Some(2));
        assert_eq!(
            answers
                .keys()
                .filter(|path| path.ends_with("/comparison"))
                .count(),
            2
        );
    }

    #[test]
    fn names_of_users_are_escaped() {
        let document = document(&fixture::study(), &ReportPredictions::default());
        assert!(document.contains("\\u003cscript>") && document.contains("&lt;script&gt;"));
        assert!(!document.contains("<script>alert"));
    }

    #[test]
    fn equal_studies_give_equal_reports() {
        assert_eq!(
            document(&fixture::study(), &ReportPredictions::default()),
            document(&fixture::study(), &ReportPredictions::default())
        );
    }

    #[test]
    fn every_study_has_a_report() {
        for calibration in [
            fixture::without_holdout(),
            fixture::all_rejected(),
            fixture::fit(),
            fixture::search(),
        ] {
            let document = document(&Study::from(calibration), &ReportPredictions::default());
            assert!(document.ends_with("</html>\n"));
        }
    }
}
