//! The finished part of a study, from which summary, report and figures are made.

use std::sync::OnceLock;

use shared::api::CalibrationState;

use crate::discovery::DiscoveryRound;
use crate::finished_calibration::FinishedCalibration;
use crate::study_member::StudyMember;
use crate::table::combined_row::CombinedRow;

/// The finished calibrations of a study, oldest first. There is at least one.
#[derive(Debug)]
pub struct Study {
    /// State of the study: finished where no further step follows, else the state of its first unfinished calibration.
    pub state: CalibrationState,
    /// How many models the job compares; 1 where it has one.
    pub models: usize,
    /// The job as it was submitted; of the models that it compares, the one with the most evidence.
    pub lead: FinishedCalibration,
    /// The others of these models, oldest first.
    pub other_models: Vec<FinishedCalibration>,
    /// The point estimates that the job asks for, of the same model and measurements.
    pub point_estimates: Vec<FinishedCalibration>,
    /// Those of other models or measurements: extended by effects, or by runs.
    pub extensions: Vec<FinishedCalibration>,
    /// The searches for missing effects.
    pub rounds: Vec<DiscoveryRound>,
    /// Every member, finished or not, oldest first.
    pub members: Vec<StudyMember>,
    /// What the models of the ledger predict together, once somebody asks.
    pub combined: OnceLock<Vec<CombinedRow>>,
}

impl Study {
    /// Every finished calibration of the submitted model and measurements, oldest first.
    pub fn submitted(&self) -> impl Iterator<Item = &FinishedCalibration> {
        std::iter::once(&self.lead).chain(&self.point_estimates)
    }

    /// Every finished calibration of the line that the study goes on with: the submitted one, its point estimates, then the extensions.
    pub fn line(&self) -> impl Iterator<Item = &FinishedCalibration> {
        self.submitted().chain(&self.extensions)
    }

    /// Every finished calibration: that line, after the other models that the job compares.
    pub fn calibrations(&self) -> impl Iterator<Item = &FinishedCalibration> {
        self.other_models.iter().chain(self.line())
    }

    /// The plain parameters of the model that the study freed since the submitted job.
    pub fn freed(&self, calibration: &FinishedCalibration) -> Vec<String> {
        let had = self.lead.spec.freed();
        let freed = calibration.spec.freed().into_iter();
        freed.filter(|part| !had.contains(part)).collect()
    }

    /// What a calibration has: its effects, and what the study freed.
    pub fn parts(&self, calibration: &FinishedCalibration) -> Vec<String> {
        [calibration.effects(), self.freed(calibration)].concat()
    }

    /// The lines of the error ledger: the calibrations that have a posterior. A fit beside a sample is a point estimate, even
    /// with draws, which those of earlier versions are given when they go on.
    pub fn ledger(&self) -> impl Iterator<Item = &FinishedCalibration> {
        let approximates = self.lead.approximated().is_some();
        self.line().filter(move |calibration| {
            calibration.estimate().is_none() && (approximates || calibration.approximated().is_none())
        })
    }

    /// The current model: the line of the ledger with the most evidence on the newest measurements; the first of equals.
    pub fn current(&self) -> Option<&FinishedCalibration> {
        let newest = self.ledger().map(|o| o.row.experiment).max();
        let of_newest = self.ledger().filter(|o| Some(o.row.experiment) == newest);
        let evidence = |o: &FinishedCalibration| o.row.log_evidence.unwrap_or(f64::NEG_INFINITY);
        of_newest.reduce(|a, b| if evidence(b) > evidence(a) { b } else { a })
    }
}

/// A study with one calibration and no search.
impl From<FinishedCalibration> for Study {
    fn from(lead: FinishedCalibration) -> Self {
        Study {
            state: lead.row.state,
            models: 1,
            lead,
            other_models: Vec::new(),
            point_estimates: Vec::new(),
            extensions: Vec::new(),
            rounds: Vec::new(),
            members: Vec::new(),
            combined: OnceLock::new(),
        }
    }
}
