//! The result files of a study: their names and their texts.

use std::collections::BTreeMap;

use crate::diagnosis::diagnostics;
use crate::document::{ReportPredictions, document};
use crate::overview::{StudyOverview, overview};
use crate::provenance::provenance;
use crate::story::Story;
use crate::summary::study::summary;
use crate::terminal;
use result::finished_calibration::FinishedCalibration;
use result::study::Study;
use result::table::prediction::to_csv;

/// The beginning of the names of decisions.
const DECISION: &str = "decision-";

/// A file of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StudyFile {
    /// Summary, as JSON.
    Summary,
    /// Draws of the current model's posterior.
    Posterior,
    /// Predictions of every run, as CSV.
    Predictions,
    /// Predictions of every run, as JSON.
    PredictionRows,
    /// The report, as HTML.
    Report,
    /// Tables and flags, as text for a terminal.
    Details,
    /// Calibrations, searches and error ledger, as text for a terminal.
    Brief,
    /// The story of the current model, as JSON.
    Story,
    /// Members, error ledger and flags for the page, as JSON.
    Overview,
    /// The study's entry in a list of studies, as JSON.
    ListItem,
    /// The numbers of a finished calibration's figures, as JSON.
    Figures(i64),
}

impl StudyFile {
    /// Returns the name of the file.
    pub fn name(self) -> String {
        match self {
            StudyFile::Summary => "summary.json".into(),
            StudyFile::Posterior => "posterior.csv".into(),
            StudyFile::Predictions => "predictions.csv".into(),
            StudyFile::PredictionRows => "predictions.json".into(),
            StudyFile::Report => "report.html".into(),
            StudyFile::Details => "details.txt".into(),
            StudyFile::Brief => "brief.txt".into(),
            StudyFile::Story => "story.json".into(),
            StudyFile::Overview => "overview.json".into(),
            StudyFile::ListItem => "list_item.json".into(),
            StudyFile::Figures(calibration) => format!("figures-{calibration}.json"),
        }
    }

    /// Returns whether every study ends with the file. The others are computed on request.
    pub fn is_of_every_study(self) -> bool {
        !matches!(
            self,
            StudyFile::PredictionRows | StudyFile::Report | StudyFile::Figures(_)
        )
    }
}

/// A JSON file of a finished calibration that does not depend on the rest of its study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CalibrationFile {
    /// The diagnostics of a calibration, as JSON.
    Diagnostics,
    /// The comparison of a model with the measurements.
    Comparison,
    /// Histories; `null` for a model without time.
    Histories,
    /// How the result came about.
    Provenance,
    /// The response surface; `null` without draws that determine one.
    ResponseSurface,
}

impl CalibrationFile {
    /// Returns the name of the file of a calibration.
    pub fn name(self, calibration: i64) -> String {
        let kind = match self {
            CalibrationFile::Diagnostics => "diagnostics",
            CalibrationFile::Comparison => "comparison",
            CalibrationFile::Histories => "histories",
            CalibrationFile::Provenance => "provenance",
            CalibrationFile::ResponseSurface => "response-surface",
        };
        format!("{kind}-{calibration}.json")
    }

    /// Returns the text of the file.
    pub fn text(self, calibration: &FinishedCalibration) -> String {
        match self {
            CalibrationFile::Diagnostics => compact(&diagnostics(calibration, calibration.comparison())),
            CalibrationFile::Comparison => compact(&calibration.comparison()),
            CalibrationFile::Histories => compact(&calibration.histories()),
            CalibrationFile::Provenance => compact(&provenance(calibration)),
            CalibrationFile::ResponseSurface => compact(&calibration.response_surface()),
        }
    }
}

/// Returns the files that every study ends with, by name, and diagnostics and provenance of its calibrations.
pub fn files(study: &Study) -> BTreeMap<String, String> {
    use StudyFile::{Brief, Details, Posterior, Predictions, Story, Summary};
    let mut files = overview_files(&overview(study));
    let of_study = [Summary, Posterior, Predictions, Details, Brief, Story];
    files.extend(
        of_study
            .into_iter()
            .filter_map(|kind| Some((kind.name(), file(study, &ReportPredictions::default(), kind)?))),
    );
    let of_calibrations = [CalibrationFile::Diagnostics, CalibrationFile::Provenance];
    files.extend(study.calibrations().flat_map(|calibration| {
        of_calibrations.map(|file| (file.name(calibration.row.id), file.text(calibration)))
    }));
    files
}

/// Returns an overview and its line in a list of studies, by name.
pub fn overview_files(overview: &StudyOverview) -> BTreeMap<String, String> {
    [
        (StudyFile::Overview.name(), json(overview)),
        (StudyFile::ListItem.name(), compact(&overview.list_item(None))),
    ]
    .into()
}

/// Returns the name of the file with the predictions of a calibration over a grid.
pub fn grid_name(calibration: i64) -> String {
    format!("prediction-grid-{calibration}.json")
}

/// Returns the name of the file with the last decision by a calibration.
pub fn decision_name(calibration: i64) -> String {
    format!("{DECISION}{calibration}.json")
}

/// Returns whether a file is a decision.
pub fn is_decision(name: &str) -> bool {
    name.starts_with(DECISION)
}

/// Returns the text of a file; `None` for figures of a calibration that is not a finished one of the study.
///
/// # Arguments
/// - `predictions`: what a report carries.
pub fn file(study: &Study, predictions: &ReportPredictions, file: StudyFile) -> Option<String> {
    Some(match file {
        StudyFile::Summary => json(&summary(study)) + "\n",
        StudyFile::Posterior => study.current().unwrap_or(&study.lead).posterior_table().to_csv(),
        StudyFile::Predictions => to_csv(&study.predictions()),
        StudyFile::PredictionRows => compact(&study.predictions()),
        StudyFile::Report => document(study, predictions),
        StudyFile::Details => terminal::study(study),
        StudyFile::Brief => terminal::brief(study),
        StudyFile::Story => json(&Story::current(study)) + "\n",
        StudyFile::Overview => json(&overview(study)),
        StudyFile::ListItem => compact(&overview(study).list_item(None)),
        StudyFile::Figures(id) => {
            let calibration = study
                .calibrations()
                .find(|calibration| calibration.row.id == id)?;
            compact(&study.figures_of(calibration))
        }
    })
}

fn compact(value: &impl serde::Serialize) -> String {
    serde_json::to_string(value).expect("results have a JSON form")
}

fn json(value: &impl serde::Serialize) -> String {
    serde_json::to_string_pretty(value).expect("results have a JSON form")
}
