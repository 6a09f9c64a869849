//! The files that a study ends with: written into its folder, shown by a service, stored.

use crate::report;
use crate::story::Story;
use crate::study::Study;
use crate::terminal;

/// A file of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StudyFile {
    /// Summary, as JSON.
    Summary,
    /// Draws of the current model's posterior.
    Posterior,
    /// Report.
    Report,
    /// Its tables and flags, as text for a terminal.
    Details,
    /// Calibrations, searches and error ledger, as text for a terminal.
    Brief,
    /// The story of the current model, as JSON.
    Story,
    /// Diagnostics of a finished calibration, as JSON.
    Diagnostics(i64),
}

impl StudyFile {
    /// The files that every study has.
    const OF_ALL: [StudyFile; 6] = [
        StudyFile::Summary,
        StudyFile::Posterior,
        StudyFile::Report,
        StudyFile::Details,
        StudyFile::Brief,
        StudyFile::Story,
    ];

    /// Its name.
    pub fn name(self) -> String {
        match self {
            StudyFile::Summary => "summary.json".into(),
            StudyFile::Posterior => "posterior.csv".into(),
            StudyFile::Report => "report.html".into(),
            StudyFile::Details => "details.txt".into(),
            StudyFile::Brief => "brief.txt".into(),
            StudyFile::Story => "story.json".into(),
            StudyFile::Diagnostics(calibration) => format!("diagnostics-{calibration}.json"),
        }
    }
}

impl Study {
    /// Every file of the study.
    pub fn files(&self) -> impl Iterator<Item = StudyFile> {
        let diagnosed = self.calibrations().map(|c| StudyFile::Diagnostics(c.row.id));
        StudyFile::OF_ALL.into_iter().chain(diagnosed)
    }

    /// The text of a file; `None` of diagnostics where the study has no such finished calibration.
    pub fn file(&self, file: StudyFile) -> Option<String> {
        Some(match file {
            StudyFile::Summary => json(&self.summary()) + "\n",
            StudyFile::Posterior => self.current().unwrap_or(&self.lead).posterior_table().to_csv(),
            StudyFile::Report => report::page(self),
            StudyFile::Details => terminal::study(self),
            StudyFile::Brief => terminal::brief(self),
            StudyFile::Story => json(&Story::current(self)) + "\n",
            StudyFile::Diagnostics(id) => {
                let calibration = self.calibrations().find(|c| c.row.id == id)?;
                json(&calibration.diagnostics(&calibration.comparison()))
            }
        })
    }
}

fn json(value: &impl serde::Serialize) -> String {
    serde_json::to_string_pretty(value).expect("results have a JSON form")
}
