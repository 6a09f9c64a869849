//! Results of a sampler: stages, draws, predictions.

use std::collections::BTreeMap;

use shared::outcome::Observables;

/// A stored stage, without its population.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct StageRow {
    /// Index of the stage; 0 is the prior.
    pub stage: u32,
    /// Tempering exponent.
    pub tempering_exponent: f64,
    /// Acceptance rate of the moves; in a stage of draws, effective sample size over number of draws (ESS/N).
    pub acceptance: f64,
    /// z-score of the drift of the mean log-likelihood during the moves, or from the last stage's draws to these.
    pub drift_z: f64,
    /// Rank correlation of the log-likelihood between start and end of the moves; 0 in a stage of draws.
    pub correlation: f64,
    /// Moves per particle; in a stage of draws, rounds.
    pub steps: u32,
    /// Share of the log-evidence.
    pub log_evidence_increment: f64,
    /// Coefficient of variation of the weights.
    pub weight_cov: f64,
    /// Effective sample size of the weights.
    pub ess: f64,
    /// Scale of the proposals at the end; 0 in a stage of draws.
    pub scale: f64,
    /// Number of evaluations.
    pub evaluations: u64,
    /// Whether the moves reached equilibrium; after draws, whether they agree with those before.
    pub equilibrated: bool,
}

/// A rejection of parameters by the model: its kind, a colon, the details.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct RejectionReason(pub String);

impl RejectionReason {
    /// Returns the part before the colon.
    pub fn kind(&self) -> &str {
        self.0.split_once(':').map_or(&self.0, |(kind, _)| kind)
    }
}

/// A draw from the prior that a sampler began with.
#[derive(Debug, Clone, PartialEq)]
pub struct PriorDraw {
    /// Parameter vector, noise parameters included.
    pub theta: Vec<f64>,
    /// The predicted values that the likelihood takes, or the rejection by the model.
    pub result: Result<Vec<f64>, RejectionReason>,
    /// Number of leases of this evaluation that failed before one succeeded.
    pub faults: u64,
}

/// A final draw.
#[derive(Debug, Clone, PartialEq)]
pub struct Prediction {
    /// Parameter vector, noise parameters included.
    pub theta: Vec<f64>,
    /// Observables of the fitted runs, or the rejection by the model.
    pub fit: Result<Observables, RejectionReason>,
    /// Observables of the holdout runs, if there are any.
    pub holdout: Option<HoldoutPrediction>,
}

/// The model's observables of the holdout runs at a final draw.
#[derive(Debug, Clone, PartialEq)]
pub struct HoldoutPrediction {
    /// Observables of all holdout runs together, or the rejection of one of them.
    pub together: Result<Observables, RejectionReason>,
    /// If it rejected one of several: observables or rejection of each run by its index.
    pub alone: BTreeMap<usize, Result<Observables, RejectionReason>>,
}

impl HoldoutPrediction {
    /// Returns the observables that contain a run with its index in them, or the rejection of the run.
    ///
    /// # Arguments
    /// - `position`: index of the run among the holdout runs.
    ///
    /// # Errors
    /// The rejection of this run or, if it was not evaluated alone, that of all.
    pub fn run(&self, position: usize) -> Result<(&Observables, usize), &RejectionReason> {
        match (&self.together, self.alone.get(&position)) {
            (Ok(observables), _) => Ok((observables, position)),
            (Err(_), Some(Ok(observables))) => Ok((observables, 0)),
            (Err(_), Some(Err(reason))) | (Err(reason), None) => Err(reason),
        }
    }
}

impl From<Result<Observables, RejectionReason>> for HoldoutPrediction {
    fn from(together: Result<Observables, RejectionReason>) -> Self {
        HoldoutPrediction {
            together,
            alone: BTreeMap::new(),
        }
    }
}
