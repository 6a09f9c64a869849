//! The files that a study ends with: written into its folder, shown by a service, stored.

use crate::diagnosis::diagnostics;
use crate::document::document;
use crate::overview::overview;
use crate::story::Story;
use crate::summary::study::summary;
use crate::terminal;
use result::finished_calibration::FinishedCalibration;
use result::study::Study;
use result::table::prediction::to_csv;

/// A file of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StudyFile {
    /// Summary, as JSON.
    Summary,
    /// Draws of the current model's posterior.
    Posterior,
    /// Every run as the models predict it, as CSV.
    Predictions,
    /// The same as JSON.
    PredictionRows,
    /// Report.
    Report,
    /// Its tables and flags, as text for a terminal.
    Details,
    /// Calibrations, searches and error ledger, as text for a terminal.
    Brief,
    /// The story of the current model, as JSON.
    Story,
    /// Members, error ledger and flags for the page, as JSON.
    Overview,
    /// Diagnostics of a finished calibration, as JSON.
    Diagnostics(i64),
    /// The numbers of a finished calibration's figures, as JSON.
    Figures(i64),
    /// Model against measurement of a finished calibration, as JSON.
    Comparison(i64),
    /// Histories of a finished calibration, as JSON; `null` of a model that knows no time.
    Histories(i64),
}

impl StudyFile {
    /// The files that every study has.
    const OF_ALL: [StudyFile; 8] = [
        StudyFile::Summary,
        StudyFile::Posterior,
        StudyFile::Predictions,
        StudyFile::Report,
        StudyFile::Details,
        StudyFile::Brief,
        StudyFile::Story,
        StudyFile::Overview,
    ];

    /// Its name.
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
            StudyFile::Diagnostics(calibration) => format!("diagnostics-{calibration}.json"),
            StudyFile::Figures(calibration) => format!("figures-{calibration}.json"),
            StudyFile::Comparison(calibration) => format!("comparison-{calibration}.json"),
            StudyFile::Histories(calibration) => format!("histories-{calibration}.json"),
        }
    }
}

/// The files that a study ends with. The others are for who looks at one calibration, and computed when somebody does.
pub fn files(study: &Study) -> impl Iterator<Item = StudyFile> {
    let diagnosed = study.calibrations().map(|c| StudyFile::Diagnostics(c.row.id));
    StudyFile::OF_ALL.into_iter().chain(diagnosed)
}

fn calibration(study: &Study, id: i64) -> Option<&FinishedCalibration> {
    study.calibrations().find(|calibration| calibration.row.id == id)
}

/// The text of a file; `None` where it is that of a calibration that the study has not, or not finished.
pub fn file(study: &Study, file: StudyFile) -> Option<String> {
    Some(match file {
        StudyFile::Summary => json(&summary(study)) + "\n",
        StudyFile::Posterior => study.current().unwrap_or(&study.lead).posterior_table().to_csv(),
        StudyFile::Predictions => to_csv(&study.predictions()),
        StudyFile::PredictionRows => compact(&study.predictions()),
        StudyFile::Report => document(study),
        StudyFile::Details => terminal::study(study),
        StudyFile::Brief => terminal::brief(study),
        StudyFile::Story => json(&Story::current(study)) + "\n",
        StudyFile::Overview => json(&overview(study)),
        StudyFile::Diagnostics(id) => {
            let calibration = calibration(study, id)?;
            compact(&diagnostics(calibration, calibration.comparison()))
        }
        StudyFile::Figures(id) => compact(&study.figures_of(calibration(study, id)?)),
        StudyFile::Comparison(id) => compact(&calibration(study, id)?.comparison()),
        StudyFile::Histories(id) => compact(&calibration(study, id)?.histories()),
    })
}

fn compact(value: &impl serde::Serialize) -> String {
    serde_json::to_string(value).expect("results have a JSON form")
}

fn json(value: &impl serde::Serialize) -> String {
    serde_json::to_string_pretty(value).expect("results have a JSON form")
}
