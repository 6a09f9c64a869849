//! The finished calibrations and searches of a study: the input of summary, report and figures.

use std::sync::OnceLock;

use shared::api::CalibrationState;

use crate::discovery::DiscoveryRound;
use crate::finished_calibration::FinishedCalibration;
use crate::study_member::StudyMember;
use crate::table::combined_row::CombinedRow;

/// The finished calibrations of a study, oldest first. There is at least one.
#[derive(Debug, Clone)]
pub struct Study {
    /// State of the study: finished if no further step follows, else the state of its first unfinished calibration.
    pub state: CalibrationState,
    /// Number of models that the job compares.
    pub models: usize,
    /// The calibration of the submitted job; if the job compares models, the one with the most evidence.
    pub lead: FinishedCalibration,
    /// The other compared models, oldest first.
    pub other_models: Vec<FinishedCalibration>,
    /// The point estimates that the job asks for, of the same model and measurements.
    pub point_estimates: Vec<FinishedCalibration>,
    /// The calibrations of extended models or measurements: with added effects, freed parameters or added runs.
    pub extensions: Vec<FinishedCalibration>,
    /// The searches for missing effects.
    pub rounds: Vec<DiscoveryRound>,
    /// Every member, finished or not, oldest first.
    pub members: Vec<StudyMember>,
    /// The combined predictions of the models and the measurements alone, computed on demand.
    pub combined: OnceLock<Vec<CombinedRow>>,
}

impl Study {
    /// Returns the finished calibrations of the submitted model and measurements, oldest first.
    pub fn submitted(&self) -> impl Iterator<Item = &FinishedCalibration> {
        std::iter::once(&self.lead).chain(&self.point_estimates)
    }

    /// Returns the finished calibrations that the study continues with: the submitted one, its point estimates, then the extensions.
    pub fn line(&self) -> impl Iterator<Item = &FinishedCalibration> {
        self.submitted().chain(&self.extensions)
    }

    /// Returns every finished calibration: the other compared models first, then those that the study continues with.
    pub fn calibrations(&self) -> impl Iterator<Item = &FinishedCalibration> {
        self.other_models.iter().chain(self.line())
    }

    /// Returns the parameters that the study freed since the submitted job and that belong to no effect.
    pub fn freed(&self, calibration: &FinishedCalibration) -> Vec<String> {
        let had = self.lead.spec.freed();
        let freed = calibration.spec.freed().into_iter();
        freed.filter(|part| !had.contains(part)).collect()
    }

    /// Returns the names of what a calibration's model includes: its effects, and the parameters that the study freed.
    pub fn parts(&self, calibration: &FinishedCalibration) -> Vec<String> {
        [calibration.effects(), self.freed(calibration)].concat()
    }

    /// Returns the calibrations in the error ledger: those with a posterior. A fit beside a sample counts as a point estimate even if it
    /// has draws, as stores of earlier versions may contain.
    pub fn ledger(&self) -> impl Iterator<Item = &FinishedCalibration> {
        let approximates = self.lead.approximated().is_some();
        self.line().filter(move |calibration| {
            calibration.estimate().is_none() && (approximates || calibration.approximated().is_none())
        })
    }

    /// Returns the current model: the calibration in the ledger with the most evidence on the newest measurements; the first of equal
    /// ones.
    pub fn current(&self) -> Option<&FinishedCalibration> {
        let newest = self.ledger().map(|o| o.row.experiment).max();
        let of_newest = self.ledger().filter(|o| Some(o.row.experiment) == newest);
        let evidence = |o: &FinishedCalibration| o.row.log_evidence.unwrap_or(f64::NEG_INFINITY);
        of_newest.reduce(|a, b| if evidence(b) > evidence(a) { b } else { a })
    }
}

/// Makes a study with one calibration and no search.
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
